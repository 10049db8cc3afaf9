//! A scene of flat layers that is known exactly from every eye, as colour and depth pictures.

use std::path::Path;

use image::{GrayImage, ImageBuffer, Luma, Rgb, RgbImage};
use yoro::eyes::{DepthConvention, DepthRange};
use yoro_lab::picture::{self, DepthImage};

pub const WIDTH: u32 = 160;
pub const HEIGHT: u32 = 120;
pub const FOV_Y_DEGREES: f32 = 60.0;
pub const IPD: f32 = 0.063;
pub const RANGE: DepthRange = DepthRange { near: 0.3, far: 1000.0, convention: DepthConvention::Reversed };
/// Disparity in pixels that white stands for.
pub const DISPARITY_AT_WHITE: f32 = 12.0;

/// Layers from near to far: disparity in 255ths of [`DISPARITY_AT_WHITE`], so that every depth encoding can store
/// it, and the rectangle it covers in pixels of the middle eye.
const LAYERS: [(u8, [f32; 4]); 3] =
    [(170, [60.0, 40.0, 90.0, 100.0]), (100, [20.0, 10.0, 130.0, 60.0]), (40, [-1e6, -1e6, 1e6, 1e6])];

/// Focal length in pixels times IPD: disparity = reach / distance.
fn reach() -> f32 {
    0.5 * HEIGHT as f32 / (0.5 * FOV_Y_DEGREES.to_radians()).tan() * IPD
}

/// The layer seen at a pixel, and the pixel's place on it in pixels of the middle eye. `eye`: -0.5 left, 0 middle,
/// 0.5 right, in IPDs.
fn look(x: u32, y: u32, eye: f32) -> (usize, [f32; 2]) {
    let seen = LAYERS.iter().enumerate().find_map(|(i, &(level, [left, top, right, bottom]))| {
        let disparity = f32::from(level) / 255.0 * DISPARITY_AT_WHITE;
        let at = [x as f32 + 0.5 + disparity * eye, y as f32 + 0.5];
        let inside = (left..right).contains(&at[0]) && (top..bottom).contains(&at[1]);
        inside.then_some((i, at))
    });
    seen.expect("the last layer is everywhere")
}

/// The picture of an eye. It is smooth on each layer, so that a shift by part of a pixel is well defined.
pub fn color(eye: f32) -> RgbImage {
    RgbImage::from_fn(WIDTH, HEIGHT, |x, y| {
        let (layer, [u, v]) = look(x, y, eye);
        let wave = |frequency: f32, phase: f32| 40.0 * (u * frequency + v * 0.13 + phase).sin();
        let base = [[200.0, 90.0, 60.0], [60.0, 150.0, 90.0], [90.0, 110.0, 190.0]][layer];
        Rgb([0, 1, 2].map(|c| (base[c] + wave(0.2, c as f32 + layer as f32)).round() as u8))
    })
}

/// Disparity level of each pixel, in 255ths.
fn levels(eye: f32) -> GrayImage {
    GrayImage::from_fn(WIDTH, HEIGHT, |x, y| Luma([LAYERS[look(x, y, eye).0].0]))
}

/// Distance of each pixel in metres.
pub fn metres(eye: f32) -> DepthImage {
    let levels = levels(eye);
    DepthImage::from_fn(WIDTH, HEIGHT, |x, y| {
        Luma([reach() / (f32::from(levels.get_pixel(x, y).0[0]) / 255.0 * DISPARITY_AT_WHITE)])
    })
}

fn map(image: &DepthImage, value: impl Fn(f32) -> f32) -> DepthImage {
    DepthImage::from_fn(WIDTH, HEIGHT, |x, y| Luma([value(image.get_pixel(x, y).0[0])]))
}

/// Reversed depth raised to 1 / gamma, or standard depth without.
pub fn buffer(eye: f32, convention: DepthConvention, gamma: f32) -> DepthImage {
    let range = DepthRange { convention, ..RANGE };
    map(&metres(eye), |z| range.depth(z).powf(1.0 / gamma))
}

/// Writes 8-bit grey PNG of disparity.
pub fn save_disparity_8(path: &Path, eye: f32) {
    picture::save_gray(path, &levels(eye)).unwrap();
}

/// Writes the same with three equal channels of 16 bits.
pub fn save_disparity_rgb_16(path: &Path, eye: f32) {
    let levels = levels(eye);
    let image: ImageBuffer<Rgb<u16>, Vec<u16>> =
        ImageBuffer::from_fn(WIDTH, HEIGHT, |x, y| Rgb([u16::from(levels.get_pixel(x, y).0[0]) * 257; 3]));
    image.save(path).unwrap();
}

/// Writes metres as 16 bits, white at 20 m.
pub fn save_metres_16(path: &Path, eye: f32) {
    picture::save_depth(path, &map(&metres(eye), |z| z / 20.0)).unwrap();
}
