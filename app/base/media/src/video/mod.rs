//! H.264 video in MP4 files, and RGBD videos: one eye with its depth, from which the other eye is synthesized.
//!
//! [`Planes`] is a picture in the form that encoder and decoder use; `write` and `Reader` handle files, and [`Rgbd`]
//! describes the depth in one. [`Index`] finds the pictures of a file for callers with a decoder of their own.

mod error;
#[cfg(feature = "codec")]
mod file;
mod index;
#[cfg(feature = "codec")]
mod openh264;
mod planes;
mod rgbd;

pub use error::VideoError;
#[cfg(feature = "codec")]
pub use file::{Format, Reader, write};
pub use index::{EncodedPicture, Index};
#[cfg(feature = "codec")]
pub use openh264::{Decoder, Encoder, FINEST_QUANTIZER, LiveEncoder, LivePicture, fits};
pub use planes::Planes;
pub use rgbd::{DEPTH_BOX, Rgbd, depth_luma};
