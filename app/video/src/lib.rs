//! H.264 video in MP4 files, and RGBD videos: one eye with its depth, from which the other eye is synthesized.
//!
//! [`Planes`] is a picture as the encoder and the decoder take it; `write` and `Reader` are the files, and [`Rgbd`]
//! says what the depth in one means. [`Indexer`] finds the pictures of a file for those who have a decoder of their own. This
//! crate must never know who renders or shows a picture.

#[cfg(feature = "coder")]
mod coder;
mod error;
#[cfg(feature = "coder")]
mod file;
mod index;
mod planes;
#[cfg(feature = "coder")]
mod record3d;
mod rgbd;

#[cfg(feature = "coder")]
pub use coder::{Decoder, Encoder, LiveEncoder};
pub use error::VideoError;
#[cfg(feature = "coder")]
pub use file::{Format, Reader, write};
pub use index::{Coded, Index, Indexer};
pub use planes::Planes;
pub use rgbd::{DEPTH_BOX, Rgbd, depth_luma};
