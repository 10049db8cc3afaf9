//! H.264 video in MP4 files, and RGBD videos: one eye with its depth, from which the other eye is synthesized.
//!
//! [`Planes`] is a picture as [`Encoder`] and [`Decoder`] take it; [`write()`] and [`Reader`] are the files, and [`Rgbd`]
//! says what the depth in one means. This crate must never know who renders or shows a picture.

mod coder;
mod error;
mod file;
mod planes;
mod record3d;
mod rgbd;

pub use coder::{Decoder, Encoder, LiveEncoder};
pub use error::VideoError;
pub use file::{Format, Reader, write};
pub use planes::Planes;
pub use rgbd::{DEPTH_BOX, Rgbd, depth_luma};
