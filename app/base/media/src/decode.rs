//! Reading image files.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{ReadChannels, ReadLayers};
use image::{DynamicImage, GrayImage, ImageFormat, ImageReader, Rgb, RgbImage};

use yoro_files::{self as files, decoder};

use crate::{DepthImage, MAX_SIZE, PictureError, srgb};

/// Reads a colour image. Samples of 16 bits are rounded to 8, and grey is repeated. EXR is linear and is encoded as
/// sRGB. Alpha is dropped without blending, because engines seldom store coverage in it.
pub fn load_color(path: &Path) -> Result<RgbImage, PictureError> {
    Ok(match decode(path)? {
        DynamicImage::ImageRgb8(image) => image,
        image @ (DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_)) => {
            let linear = image.into_rgb32f();
            RgbImage::from_fn(linear.width(), linear.height(), |x, y| {
                Rgb(linear.get_pixel(x, y).0.map(srgb::from_linear))
            })
        }
        image => image.into_rgb8(),
    })
}

/// A depth file as it was read.
#[derive(Clone, Debug)]
pub struct DepthFile {
    /// The values; row 0 is the top.
    pub image: DepthImage,
    /// The kind of values.
    pub samples: DepthSamples,
}

/// The kind of values in a [`DepthFile`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthSamples {
    /// Integers divided by their maximum: 0 to 1.
    Normalized {
        /// Bits per sample: 8 or 16.
        bits: u8,
    },
    /// Floating point, unchanged.
    Float,
}

/// Reads a depth image: grey (or red = green = blue) with 8 or 16 bits as 0 to 1, or one channel of an EXR file
/// unchanged. In an EXR file this is the channel Z, depth, Y or R of the first layer that has one (a prefix such as
/// `ViewLayer.` is ignored), or else the only channel of the first layer.
pub fn load_depth(path: &Path) -> Result<DepthFile, PictureError> {
    let bytes = files::read(path)?;
    if image::guess_format(&bytes).is_ok_and(|format| format == ImageFormat::OpenExr) {
        return Ok(DepthFile { image: decode_exr_channel(path, &bytes)?, samples: DepthSamples::Float });
    }
    let image = decode_bytes(path, bytes)?;
    let bits = if image.color().bytes_per_pixel() / image.color().channel_count() == 1 { 8 } else { 16 };
    let (width, height) = (image.width(), image.height());
    let wide = image.color().has_color().then(|| image.to_rgb16());
    if let Some(wide) = &wide
        && wide.pixels().any(|p| p.0[0] != p.0[1] || p.0[0] != p.0[2])
    {
        let what = "is a colour image: depth must be grey (one channel, or red = green = blue)";
        return Err(PictureError::unusable(path, what));
    }
    // The conversions between 8 and 16 bits are exact (times 257). Of equal channels, the first is the grey.
    let values: Vec<f32> = match wide {
        Some(wide) => wide.pixels().map(|p| f32::from(p.0[0]) / 65535.0).collect(),
        None => image.into_luma16().pixels().map(|p| f32::from(p.0[0]) / 65535.0).collect(),
    };
    let image = DepthImage::from_raw(width, height, values).expect("one value for each pixel");
    Ok(DepthFile { image, samples: DepthSamples::Normalized { bits } })
}

/// Reads a mask as grey, 8 bits.
pub fn load_mask(path: &Path) -> Result<GrayImage, PictureError> {
    Ok(decode(path)?.into_luma8())
}

fn decode(path: &Path) -> Result<DynamicImage, PictureError> {
    decode_bytes(path, files::read(path)?)
}

fn decode_bytes(path: &Path, bytes: Vec<u8>) -> Result<DynamicImage, PictureError> {
    let damaged = |reason| PictureError::damaged(path, reason);
    let format = image::guess_format(&bytes)
        .ok()
        // TGA has no signature. Any other file without a signature is not what its name says.
        .or_else(|| ImageFormat::from_path(path).ok().filter(|format| *format == ImageFormat::Tga))
        .filter(ImageFormat::reading_enabled)
        .ok_or_else(|| {
            let what = "is not a picture that can be read: give a PNG, JPEG, EXR, TGA or BMP file";
            PictureError::unusable(path, what)
        })?;
    if format == ImageFormat::OpenExr {
        check_exr_has_color(path, &bytes)?;
    }
    // Decoders are compiled once for each type of reader; this is the type that `image` itself uses.
    let reader = || ImageReader::with_format(Cursor::new(bytes.as_slice()), format);
    let of_image = |error: image::ImageError| damaged(error.to_string());
    let (width, height) = decoder::run(|| reader().into_dimensions().map_err(of_image), damaged)?;
    check_size(path, width as usize, height as usize)?;
    let mut reader = reader();
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(4 << 30);
    reader.limits(limits);
    decoder::run(|| reader.decode().map_err(of_image), damaged)
}

/// Refuses a valid EXR file that `image` cannot read because it has no colour.
fn check_exr_has_color(path: &Path, bytes: &[u8]) -> Result<(), PictureError> {
    let meta = exr_meta(path, bytes)?;
    let channels = |header: &exr::meta::header::Header| -> Vec<String> {
        header.channels.list.iter().map(|channel| channel.name.to_string()).collect()
    };
    let has_color = |names: &[String]| ["R", "G", "B"].iter().all(|name| names.iter().any(|n| n == name));
    let headers: Vec<Vec<String>> = meta.headers.iter().map(channels).collect();
    if headers.iter().any(|names| has_color(names)) {
        return Ok(());
    }
    let found = headers.concat().join(", ");
    let what =
        format!("is no colour picture (its channels are {found}): give one with the channels R, G and B");
    Err(PictureError::unusable(path, what))
}

fn exr_meta(path: &Path, bytes: &[u8]) -> Result<exr::meta::MetaData, PictureError> {
    let damaged = |reason| PictureError::damaged(path, reason);
    let read = || exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false);
    decoder::run(|| read().map_err(|error| damaged(error.to_string())), damaged)
}

fn check_size(path: &Path, width: usize, height: usize) -> Result<(), PictureError> {
    if width.max(height) > MAX_SIZE as usize {
        let what = format!("says it is {width}x{height} pixels: up to {MAX_SIZE}x{MAX_SIZE} are read");
        return Err(PictureError::unusable(path, what));
    }
    Ok(())
}

fn decode_exr_channel(path: &Path, bytes: &[u8]) -> Result<DepthImage, PictureError> {
    for header in &exr_meta(path, bytes)?.headers {
        check_size(path, header.layer_size.width(), header.layer_size.height())?;
    }
    let damaged = |reason| PictureError::damaged(path, reason);
    let read = || {
        exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .all_layers()
            .all_attributes()
            .from_buffered(Cursor::new(bytes))
            .map_err(|error| damaged(error.to_string()))
    };
    let file = decoder::run(read, damaged)?;
    let window = file.attributes.display_window;
    let found = || -> String {
        let names = file.layer_data.iter().flat_map(|layer| &layer.channel_data.list);
        names.map(|channel| channel.name.to_string()).collect::<Vec<_>>().join(", ")
    };
    let (layer, channel) = file
        .layer_data
        .iter()
        .find_map(|layer| depth_channel(&layer.channel_data.list).map(|channel| (layer, channel)))
        .ok_or_else(|| {
            let found = found();
            let what = format!("has no depth channel (Z, depth, Y or R; it has {found}): name the channel Z");
            PictureError::unusable(path, what)
        })?;
    if layer.size != window.size || layer.attributes.layer_position != window.position {
        let what =
            "covers only a part of its picture: save it without cropping (data window = display window)";
        return Err(PictureError::unusable(path, what));
    }
    let (width, height) = (layer.size.width() as u32, layer.size.height() as u32);
    let values: Vec<f32> = channel.sample_data.values_as_f32().collect();
    if let Some(at) = values.iter().position(|value| value.is_nan()) {
        let (x, y) = (at as u32 % width, at as u32 / width);
        let what = format!("has a depth that is not a number at column {x}, row {y}: render it again");
        return Err(PictureError::unusable(path, what));
    }
    DepthImage::from_raw(width, height, values)
        .ok_or_else(|| PictureError::damaged(path, "a channel has fewer samples than pixels"))
}

type ExrChannel = exr::image::AnyChannel<exr::image::FlatSamples>;

fn depth_channel(channels: &[ExrChannel]) -> Option<&ExrChannel> {
    let called = |wanted: &str| {
        channels.iter().find(|channel| {
            let name = channel.name.to_string();
            name.rsplit('.').next().is_some_and(|last| last.eq_ignore_ascii_case(wanted))
        })
    };
    // The red of a colour picture is not depth.
    let red = || called("R").filter(|_| called("G").is_none() && called("B").is_none());
    let only = match channels {
        [only] => Some(only),
        _ => None,
    };
    called("Z").or_else(|| called("depth")).or_else(|| called("Y")).or_else(red).or(only)
}
