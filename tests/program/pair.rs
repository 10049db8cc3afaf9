//! A scene of flat layers whose exact view from any eye is known, as colour and depth pictures.

use std::path::Path;

use image::{GrayImage, Luma, Rgb, RgbImage};
use yoro::eyes::{DepthConvention, DepthRange};
use yoro_media::DepthImage;

pub const WIDTH: u32 = 160;
pub const HEIGHT: u32 = 120;
pub const FOV_Y_DEGREES: f32 = 60.0;
pub const IPD: f32 = 0.063;
pub const RANGE: DepthRange = DepthRange { near: 0.3, far: 1000.0, convention: DepthConvention::Reversed };
/// The disparity in pixels that is stored as white.
pub const DISPARITY_AT_WHITE: f32 = 12.0;

/// Layers from near to far: disparity in 255ths of [`DISPARITY_AT_WHITE`], which every depth encoding can store, and
/// the covered rectangle (left, top, right, bottom) in pixels of the middle eye.
const LAYERS: [(u8, [f32; 4]); 3] =
    [(170, [60.0, 40.0, 90.0, 100.0]), (100, [20.0, 10.0, 130.0, 60.0]), (40, [-1e6, -1e6, 1e6, 1e6])];

/// Returns the focal length in pixels times the IPD in metres. Disparity is this divided by distance.
fn reach() -> f32 {
    0.5 * HEIGHT as f32 / (0.5 * FOV_Y_DEGREES.to_radians()).tan() * IPD
}

/// Returns the index of the layer that is visible at a pixel, and the position on it in pixels of the middle eye. `eye`
/// is in IPDs: -0.5 for the left eye, 0 for the middle, 0.5 for the right eye.
fn look(x: u32, y: u32, eye: f32) -> (usize, [f32; 2]) {
    let seen = LAYERS.iter().enumerate().find_map(|(i, &(level, [left, top, right, bottom]))| {
        let disparity = f32::from(level) / 255.0 * DISPARITY_AT_WHITE;
        let at = [x as f32 + 0.5 + disparity * eye, y as f32 + 0.5];
        let inside = (left..right).contains(&at[0]) && (top..bottom).contains(&at[1]);
        inside.then_some((i, at))
    });
    seen.expect("the last layer is everywhere")
}

/// Returns the colour picture of an eye. Layers are smooth, so that shifts by fractions of a pixel are well defined.
pub fn color(eye: f32) -> RgbImage {
    RgbImage::from_fn(WIDTH, HEIGHT, |x, y| {
        let (layer, [u, v]) = look(x, y, eye);
        let wave = |frequency: f32, phase: f32| 40.0 * (u * frequency + v * 0.13 + phase).sin();
        let base = [[200.0, 90.0, 60.0], [60.0, 150.0, 90.0], [90.0, 110.0, 190.0]][layer];
        Rgb([0, 1, 2].map(|c| (base[c] + wave(0.2, c as f32 + layer as f32)).round() as u8))
    })
}

/// Returns the disparity of each pixel in 255ths of [`DISPARITY_AT_WHITE`].
fn levels(eye: f32) -> GrayImage {
    GrayImage::from_fn(WIDTH, HEIGHT, |x, y| Luma([LAYERS[look(x, y, eye).0].0]))
}

/// Returns the distance of each pixel in metres.
pub fn metres(eye: f32) -> DepthImage {
    let levels = levels(eye);
    DepthImage::from_fn(WIDTH, HEIGHT, |x, y| {
        Luma([reach() / (f32::from(levels.get_pixel(x, y).0[0]) / 255.0 * DISPARITY_AT_WHITE)])
    })
}

fn map(image: &DepthImage, value: impl Fn(f32) -> f32) -> DepthImage {
    DepthImage::from_fn(WIDTH, HEIGHT, |x, y| Luma([value(image.get_pixel(x, y).0[0])]))
}

/// Returns window depth in [`RANGE`], which is reversed, raised to the power of 1 / gamma.
pub fn reversed(eye: f32, gamma: f32) -> DepthImage {
    map(&metres(eye), |z| RANGE.depth(z).powf(1.0 / gamma))
}

/// Writes disparity as an 8-bit grey PNG.
pub fn save_disparity_8(path: &Path, eye: f32) {
    yoro_media::save_gray(path, &levels(eye)).unwrap();
}

/// Writes the distance as a 16-bit PNG in which white is 20 m.
pub fn save_metres_16(path: &Path, eye: f32) {
    yoro_media::save_depth(path, &map(&metres(eye), |z| z / 20.0)).unwrap();
}
