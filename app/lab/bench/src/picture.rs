//! Reading and writing image files, composing pictures of two eyes, and taking pictures of finished frames.

use image::RgbImage;
use yoro::eyes::Eye;
use yoro_render::stereo::StereoFrame;

pub use yoro_media::*;

/// Returns the image of one eye of a finished frame.
pub fn eye_image(frame: &StereoFrame, eye: Eye) -> RgbImage {
    let target = frame.eye(eye);
    rgb_image(&target.read_rgba8(0, [0, 0], target.size()), target.size())
}
