//! H.264 video in MP4 files, and RGBD videos: one eye with its depth, from which the other eye is synthesized.
//!
//! [`Planes`] is a picture as the encoder and the decoder take it; `write` and `Reader` are the files, and [`Rgbd`]
//! says what the depth in one means. [`Index`] finds the pictures of a file for those who have a decoder of their own.
//! This crate must never know who renders or shows a picture.

#[cfg(feature = "codec")]
mod codec;
mod error;
#[cfg(feature = "codec")]
mod ffmpeg;
#[cfg(feature = "codec")]
mod file;
mod index;
mod planes;
mod record3d;
mod rgbd;

#[cfg(feature = "codec")]
pub use codec::{Decoder, Encoder, LiveEncoder, LiveEncoderKind, LivePicture};
pub use error::VideoError;
#[cfg(feature = "codec")]
pub use ffmpeg::FfmpegEncoder;
#[cfg(feature = "codec")]
pub use file::{Format, Reader, write};
pub use index::{EncodedPicture, Index};
pub use planes::Planes;
pub use rgbd::{DEPTH_BOX, Rgbd, depth_luma};
