//! Reading and writing image files, composing pictures of two eyes, and [`video`].
//!
//! Images in memory are like those in files: row 0 is the top, and colours are display-referred (sRGB) 8-bit RGB. This
//! crate must never know where a picture comes from: a renderer, a headset or a measurement.
//!
//! The feature `codec` adds an encoder and a decoder of H.264, which are C++, and so files of pictures. Without it there
//! is only what needs no C.

mod compose;
mod decode;
mod encode;
mod error;
mod srgb;
mod stored_depth;
#[cfg(test)]
mod tests;
pub mod video;

use image::{ImageBuffer, Luma};

pub use compose::{DIFFERENCE_GAIN, anaglyph, cross_eyed, depth_image, difference, rgb_image, side_by_side};
pub use decode::{DepthFile, DepthSamples, load_color, load_depth, load_mask};
pub use encode::{encode_jpeg, save_color, save_depth, save_gray};
pub use error::PictureError;
pub use stored_depth::{Nearness, StoredDepth, StoredDepthError};

/// One `f32` for each pixel.
pub type DepthImage = ImageBuffer<Luma<f32>, Vec<f32>>;

/// The largest width or height of a picture that is read. No eye of a headset comes near it, while a damaged header
/// often exceeds it. A browser has 4 GB for all pictures.
pub const MAX_SIZE: u32 = if cfg!(target_arch = "wasm32") { 8192 } else { 16384 };

/// Extensions of the files that [`load_color`] and [`load_depth`] read.
pub const EXTENSIONS: [&str; 6] = ["png", "jpg", "jpeg", "exr", "tga", "bmp"];
