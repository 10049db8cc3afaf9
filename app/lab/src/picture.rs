//! Image files in and out, the pictures made of two eyes, and those of finished frames.

use image::RgbImage;
use yoro::eyes::Eye;
use yoro_render::stereo::StereoFrame;

pub use yoro_pictures::*;

/// Returns one eye of a finished frame.
pub fn eye_image(frame: &StereoFrame, eye: Eye) -> RgbImage {
    let target = frame.eye(eye);
    rgb_image(&target.read_rgba8(0, [0, 0], target.size()), target.size())
}
