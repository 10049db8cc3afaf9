//! Image files in and out, and the pictures made of two eyes.
//!
//! In memory as in files, row 0 is the top. Colours are display-referred (sRGB) 8-bit RGB.
//!
//! This crate must never know where a picture comes from: a renderer, a headset, a measurement.

mod stored_depth;

use std::io::{self, Cursor};
use std::path::{Path, PathBuf};

use exr::prelude::{ReadChannels, ReadLayers, Text, WritableImage};
use image::{DynamicImage, GrayImage, ImageBuffer, ImageFormat, ImageReader, Luma, Rgb, RgbImage};

use yoro_files::{self as files, FileError};

pub use stored_depth::{Nearness, StoredDepth, StoredDepthError};

/// One `f32` a pixel.
pub type DepthImage = ImageBuffer<Luma<f32>, Vec<f32>>;

/// Wider or higher pictures are refused: no eye of a headset comes near, and a damaged header often says so. A browser
/// has 4 GB for all of them.
pub const MAX_SIZE: u32 = if cfg!(target_arch = "wasm32") { 8192 } else { 16384 };

/// What [`difference`] multiplies by.
pub const DIFFERENCE_GAIN: u8 = 4;

/// Extensions of the files that [`load_color`] and [`load_depth`] read.
pub const EXTENSIONS: [&str; 6] = ["png", "jpg", "jpeg", "exr", "tga", "bmp"];

/// Why a picture could not be read, written or put together.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// The file itself could not be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The content has a format that is not read here.
    #[error("{} is not a picture that can be read: give a PNG, JPEG, EXR, TGA or BMP file", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The content ends early or contradicts itself.
    #[error("{} is damaged ({reason}): write or copy it again", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What the decoder said.
        reason: String,
    },
    /// The size is beyond [`MAX_SIZE`].
    #[error("{} says it is {width}x{height} pixels: up to {MAX_SIZE}x{MAX_SIZE} are read", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// In pixels.
        width: usize,
        /// In pixels.
        height: usize,
    },
    /// A colour image where depth is needed.
    #[error("{} is a colour image: depth must be grey (one channel, or red = green = blue)", path.display())]
    NotGrey {
        /// The file.
        path: PathBuf,
    },
    /// An EXR file without a depth channel.
    #[error("{} has no depth channel (Z, depth, Y or R; it has {found}): name the channel Z", path.display())]
    NoDepthChannel {
        /// The file.
        path: PathBuf,
        /// The channels it has.
        found: String,
    },
    /// An EXR file that covers only a part of its picture.
    #[error("{} covers only a part of its picture: save it without cropping (data window = display window)", path.display())]
    Cropped {
        /// The file.
        path: PathBuf,
    },
    /// A depth value is not a number.
    #[error("{} has a depth that is not a number at column {x}, row {y}: render it again", path.display())]
    NotANumber {
        /// The file.
        path: PathBuf,
        /// Column of the first one.
        x: u32,
        /// Row of the first one.
        y: u32,
    },
    /// There is no encoder for the extension.
    #[error("cannot write {}: use the extension {allowed}", path.display())]
    Extension {
        /// The file to be written.
        path: PathBuf,
        /// What is possible.
        allowed: &'static str,
    },
    /// Two eyes of different sizes.
    #[error("the two images differ in size ({}x{} and {}x{}): give two of one size", a.0, a.1, b.0, b.1)]
    SizesDiffer {
        /// Size of the first in pixels.
        a: (u32, u32),
        /// Size of the second in pixels.
        b: (u32, u32),
    },
}

/// Reads a colour image. 16-bit samples are rounded to 8, grey is repeated, alpha is dropped without blending
/// (what engines leave there is seldom coverage), and EXR, which is linear, is encoded as sRGB.
pub fn load_color(path: &Path) -> Result<RgbImage, PictureError> {
    Ok(match decode(path)? {
        DynamicImage::ImageRgb8(image) => image,
        image @ (DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_)) => {
            let linear = image.into_rgb32f();
            RgbImage::from_fn(linear.width(), linear.height(), |x, y| {
                Rgb(linear.get_pixel(x, y).0.map(srgb_from_linear))
            })
        }
        image => image.into_rgb8(),
    })
}

/// A depth file as read.
#[derive(Clone, Debug)]
pub struct DepthFile {
    /// The values; row 0 is the top.
    pub image: DepthImage,
    /// What the values are.
    pub samples: DepthSamples,
}

/// What the values of a [`DepthFile`] are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthSamples {
    /// Integers divided by their maximum: 0 to 1.
    Normalized {
        /// 8 or 16.
        bits: u8,
    },
    /// Floating point, unchanged.
    Float,
}

/// Reads a depth image: grey (or red = green = blue) with 8 or 16 bits as 0 to 1, or one channel of an EXR file
/// unchanged. Of an EXR file the first layer with a channel named Z, depth, Y or R is taken (a prefix like
/// `ViewLayer.` does not count), or the only channel of the first layer.
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
        return Err(PictureError::NotGrey { path: path.into() });
    }
    // The conversions between 8 and 16 bits are exact (times 257), and of equal channels the first is the grey.
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
    let damaged =
        |error: image::ImageError| PictureError::Damaged { path: path.into(), reason: error.to_string() };
    let format = image::guess_format(&bytes)
        .ok()
        // TGA has no signature; anything else without one is not what its name says.
        .or_else(|| ImageFormat::from_path(path).ok().filter(|format| *format == ImageFormat::Tga))
        .filter(ImageFormat::reading_enabled)
        .ok_or_else(|| PictureError::UnknownFormat { path: path.into() })?;
    // The decoders are compiled once for each type of reader: this is the one that `image` itself uses.
    let reader = || ImageReader::with_format(Cursor::new(bytes.as_slice()), format);
    let (width, height) = reader().into_dimensions().map_err(damaged)?;
    check_size(path, width as usize, height as usize)?;
    let mut reader = reader();
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(4 << 30);
    reader.limits(limits);
    reader.decode().map_err(damaged)
}

fn check_size(path: &Path, width: usize, height: usize) -> Result<(), PictureError> {
    if width.max(height) > MAX_SIZE as usize {
        return Err(PictureError::TooLarge { path: path.into(), width, height });
    }
    Ok(())
}

fn decode_exr_channel(path: &Path, bytes: &[u8]) -> Result<DepthImage, PictureError> {
    let damaged =
        |error: exr::error::Error| PictureError::Damaged { path: path.into(), reason: error.to_string() };
    let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(damaged)?;
    for header in &meta.headers {
        check_size(path, header.layer_size.width(), header.layer_size.height())?;
    }
    let file = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(damaged)?;
    let window = file.attributes.display_window;
    let found = || -> String {
        let names = file.layer_data.iter().flat_map(|layer| &layer.channel_data.list);
        names.map(|channel| channel.name.to_string()).collect::<Vec<_>>().join(", ")
    };
    let (layer, channel) = file
        .layer_data
        .iter()
        .find_map(|layer| depth_channel(&layer.channel_data.list).map(|channel| (layer, channel)))
        .ok_or_else(|| PictureError::NoDepthChannel { path: path.into(), found: found() })?;
    if layer.size != window.size || layer.attributes.layer_position != window.position {
        return Err(PictureError::Cropped { path: path.into() });
    }
    let (width, height) = (layer.size.width() as u32, layer.size.height() as u32);
    let values: Vec<f32> = channel.sample_data.values_as_f32().collect();
    if let Some(at) = values.iter().position(|value| value.is_nan()) {
        let (x, y) = (at as u32 % width, at as u32 / width);
        return Err(PictureError::NotANumber { path: path.into(), x, y });
    }
    DepthImage::from_raw(width, height, values).ok_or_else(|| PictureError::Damaged {
        path: path.into(),
        reason: "a channel has fewer samples than pixels".into(),
    })
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

/// Writes a colour image; the extension says the format: `.png` (lossless) or `.jpg` (quality 92).
pub fn save_color(path: &Path, image: &RgbImage) -> Result<(), PictureError> {
    if files::has_extension(path, &["png"]) {
        write_encoded(path, encode_png(image))
    } else if files::has_extension(path, &["jpg", "jpeg"]) {
        write_encoded(path, encode_jpeg(image, 92))
    } else {
        Err(PictureError::Extension { path: path.into(), allowed: ".png or .jpg" })
    }
}

/// Writes an 8-bit grey image, such as a mask, as PNG.
pub fn save_gray(path: &Path, image: &GrayImage) -> Result<(), PictureError> {
    only_extension(path, "png", ".png")?;
    write_encoded(path, encode_png(image))
}

/// Writes depth. `.png`: 16 bits, 0 to 1 onto 0 to 65535, clamped. `.exr`: one 32-bit channel `Z`, unchanged.
pub fn save_depth(path: &Path, image: &DepthImage) -> Result<(), PictureError> {
    if files::has_extension(path, &["png"]) {
        let wide = ImageBuffer::<Luma<u16>, Vec<u16>>::from_fn(image.width(), image.height(), |x, y| {
            Luma([(image.get_pixel(x, y).0[0].clamp(0.0, 1.0) * 65535.0).round() as u16])
        });
        return write_encoded(path, encode_png(&wide));
    }
    only_extension(path, "exr", ".png or .exr")?;
    use exr::image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer};
    let channel = AnyChannel::new("Z", FlatSamples::F32(image.as_raw().clone()));
    let layer = Layer::new(
        (image.width() as usize, image.height() as usize),
        exr::meta::header::LayerAttributes::named(Text::from("depth")),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(std::iter::once(channel).collect()),
    );
    let mut bytes = Vec::new();
    let written = Image::from_layer(layer).write().to_buffered(Cursor::new(&mut bytes));
    write_encoded(path, written.map(|()| bytes))
}

fn only_extension(path: &Path, extension: &str, allowed: &'static str) -> Result<(), PictureError> {
    if files::has_extension(path, &[extension]) {
        return Ok(());
    }
    Err(PictureError::Extension { path: path.into(), allowed })
}

/// The image as a PNG file in memory; an image without pixels cannot be encoded.
fn encode_png<P>(image: &ImageBuffer<P, Vec<P::Subpixel>>) -> image::ImageResult<Vec<u8>>
where
    P: image::PixelWithColorType,
    [P::Subpixel]: image::EncodableLayout,
{
    let mut out = Cursor::new(Vec::new());
    image.write_to(&mut out, ImageFormat::Png)?;
    Ok(out.into_inner())
}

/// The image as a JPEG file in memory, `quality` from 1 to 100; an image without pixels, or with more than 65535
/// in a row or column, cannot be encoded.
pub fn encode_jpeg(image: &RgbImage, quality: u8) -> image::ImageResult<Vec<u8>> {
    let mut out = Vec::new();
    image.write_with_encoder(image::codecs::jpeg::JpegEncoder::new_with_quality(&mut out, quality))?;
    Ok(out)
}

fn write_encoded<E>(path: &Path, bytes: Result<Vec<u8>, E>) -> Result<(), PictureError>
where
    E: std::error::Error + Send + Sync + 'static,
{
    let bytes =
        bytes.map_err(|error| FileError::Write { path: path.into(), source: io::Error::other(error) })?;
    Ok(files::write(path, &bytes)?)
}

/// RGBA as GL reads it back, rows from the bottom, as an image; alpha is dropped.
pub fn rgb_image(rgba: &[u8], size: [u32; 2]) -> RgbImage {
    let row = size[0] as usize * 4;
    RgbImage::from_fn(size[0], size[1], |x, y| {
        let i = (size[1] - 1 - y) as usize * row + x as usize * 4;
        Rgb([rgba[i], rgba[i + 1], rgba[i + 2]])
    })
}

/// Left and right eye beside each other, left eye left: for parallel viewing.
pub fn side_by_side(left: &RgbImage, right: &RgbImage) -> Result<RgbImage, PictureError> {
    check_sizes(left, right)?;
    let mut both = RgbImage::new(left.width() * 2, left.height());
    image::imageops::replace(&mut both, left, 0, 0);
    image::imageops::replace(&mut both, right, i64::from(left.width()), 0);
    Ok(both)
}

/// Left and right eye beside each other, right eye left: for viewing with crossed eyes, without any device.
pub fn cross_eyed(left: &RgbImage, right: &RgbImage) -> Result<RgbImage, PictureError> {
    side_by_side(right, left)
}

/// For red (left) and cyan (right) glasses, after E. Dubois, "A projection method to generate anaglyph stereo
/// images", ICASSP 2001: the least-squares projection, on linear light.
pub fn anaglyph(left: &RgbImage, right: &RgbImage) -> Result<RgbImage, PictureError> {
    const LEFT: [[f32; 3]; 3] = [[0.456, 0.500, 0.176], [-0.040, -0.038, -0.016], [-0.015, -0.021, -0.005]];
    const RIGHT: [[f32; 3]; 3] = [[-0.043, -0.088, -0.002], [0.378, 0.734, -0.018], [-0.072, -0.113, 1.226]];
    check_sizes(left, right)?;
    let linear: [f32; 256] = std::array::from_fn(|v| linear_from_srgb(v as u8));
    Ok(RgbImage::from_fn(left.width(), left.height(), |x, y| {
        let l = left.get_pixel(x, y).0.map(|v| linear[usize::from(v)]);
        let r = right.get_pixel(x, y).0.map(|v| linear[usize::from(v)]);
        let dot = |row: [f32; 3], v: [f32; 3]| row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
        Rgb(std::array::from_fn(|c| srgb_from_linear(dot(LEFT[c], l) + dot(RIGHT[c], r))))
    }))
}

/// |a - b| in each channel, times [`DIFFERENCE_GAIN`].
pub fn difference(a: &RgbImage, b: &RgbImage) -> Result<RgbImage, PictureError> {
    check_sizes(a, b)?;
    let samples = a.as_raw().iter().zip(b.as_raw());
    let samples = samples.map(|(a, b)| a.abs_diff(*b).saturating_mul(DIFFERENCE_GAIN)).collect();
    Ok(RgbImage::from_raw(a.width(), a.height(), samples).expect("as many samples as the inputs have"))
}

fn check_sizes(a: &RgbImage, b: &RgbImage) -> Result<(), PictureError> {
    if a.dimensions() != b.dimensions() {
        return Err(PictureError::SizesDiffer { a: a.dimensions(), b: b.dimensions() });
    }
    Ok(())
}

fn linear_from_srgb(value: u8) -> f32 {
    let v = f32::from(value) / 255.0;
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

fn srgb_from_linear(value: f32) -> u8 {
    let v = value.clamp(0.0, 1.0);
    let v = if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    (v * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{LumaA, Rgba};

    fn folder() -> tempfile::TempDir {
        tempfile::tempdir().unwrap()
    }

    fn gradient(width: u32, height: u32) -> RgbImage {
        RgbImage::from_fn(width, height, |x, y| Rgb([(x * 7) as u8, (y * 11) as u8, (x * y) as u8]))
    }

    #[test]
    fn colour_comes_back_and_other_layouts_are_converted() {
        let dir = folder();
        let path = dir.path().join("a.png");
        let image = gradient(31, 17);
        save_color(&path, &image).unwrap();
        assert_eq!(load_color(&path).unwrap(), image);

        let wide = ImageBuffer::from_pixel(3, 2, Rgba([65535u16, 257 * 100, 128, 0]));
        files::write(&path, &encode_png(&wide).unwrap()).unwrap();
        assert_eq!(load_color(&path).unwrap().get_pixel(2, 1).0, [255, 100, 0], "alpha 0 hides nothing");

        files::write(&path, &encode_png(&ImageBuffer::from_pixel(3, 2, LumaA([77u8, 10]))).unwrap()).unwrap();
        assert_eq!(load_color(&path).unwrap().get_pixel(0, 0).0, [77; 3]);
    }

    #[test]
    fn linear_exr_colour_is_encoded() {
        let dir = folder();
        let path = dir.path().join("a.exr");
        image::Rgb32FImage::from_pixel(4, 4, Rgb([0.5, 0.0, 2.0])).save(&path).unwrap();
        assert_eq!(load_color(&path).unwrap().get_pixel(1, 1).0, [188, 0, 255]);
    }

    #[test]
    fn depth_of_every_kind() {
        let dir = folder();
        let path = dir.path().join("d.png");
        let grey8 = GrayImage::from_fn(5, 3, |x, y| Luma([(x * 50 + y) as u8]));
        save_gray(&path, &grey8).unwrap();
        let depth = load_depth(&path).unwrap();
        assert_eq!(depth.samples, DepthSamples::Normalized { bits: 8 });
        assert_eq!(depth.image.get_pixel(4, 2).0[0], 202.0 / 255.0);

        let rgb = RgbImage::from_fn(5, 3, |x, y| Rgb([grey8.get_pixel(x, y).0[0]; 3]));
        save_color(&path, &rgb).unwrap();
        assert_eq!(load_depth(&path).unwrap().image, depth.image);

        save_color(&path, &gradient(5, 3)).unwrap();
        assert!(matches!(load_depth(&path), Err(PictureError::NotGrey { .. })));

        let ramp = DepthImage::from_fn(7, 2, |x, y| Luma([(x + 7 * y) as f32 / 13.0]));
        save_depth(&path, &ramp).unwrap();
        let back = load_depth(&path).unwrap();
        assert_eq!(back.samples, DepthSamples::Normalized { bits: 16 });
        for (a, b) in ramp.pixels().zip(back.image.pixels()) {
            assert!((a.0[0] - b.0[0]).abs() <= 0.5 / 65535.0 + f32::EPSILON);
        }
    }

    fn write_exr(path: &Path, names: &[&str], value: f32) {
        use exr::image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer};
        let list = names.iter().enumerate().map(|(i, name)| {
            AnyChannel::new(
                *name,
                FlatSamples::F32((0..6).map(|v| v as f32 * value + i as f32 * 100.0).collect()),
            )
        });
        let layer = Layer::new(
            (3, 2),
            exr::meta::header::LayerAttributes::named("layer"),
            Encoding::UNCOMPRESSED,
            AnyChannels::sort(list.collect()),
        );
        Image::from_layer(layer).write().to_file(path).unwrap();
    }

    #[test]
    fn exr_depth_is_unchanged_and_the_channel_is_found() {
        let dir = folder();
        let path = dir.path().join("d.exr");
        let metres = DepthImage::from_fn(9, 4, |x, y| Luma([x as f32 * 123.456 + y as f32]));
        save_depth(&path, &metres).unwrap();
        let back = load_depth(&path).unwrap();
        assert_eq!((back.image, back.samples), (metres, DepthSamples::Float));

        for (names, first) in [
            (&["R", "G", "B", "Z"][..], 300.0),
            (&["ViewLayer.Depth.Z", "ViewLayer.Combined.R"], 0.0),
            (&["Depth"], 0.0),
            (&["Y"], 0.0),
            (&["R"], 0.0),
            (&["anything"], 0.0),
        ] {
            write_exr(&path, names, 2.0);
            let depth = load_depth(&path).unwrap().image;
            assert_eq!(
                (depth.get_pixel(0, 0).0[0], depth.get_pixel(2, 1).0[0]),
                (first, first + 10.0),
                "{names:?}"
            );
        }
        write_exr(&path, &["R", "G", "B"], 1.0);
        let error = load_depth(&path).unwrap_err().to_string();
        assert!(error.contains("d.exr has no depth channel") && error.contains("B, G, R"), "{error}");
        write_exr(&path, &["Z"], f32::NAN);
        assert!(matches!(load_depth(&path), Err(PictureError::NotANumber { x: 0, y: 0, .. })));
    }

    #[test]
    fn bad_files_get_a_sentence() {
        let dir = folder();
        let path = dir.path().join("a.png");
        assert!(matches!(load_color(&path), Err(PictureError::File(FileError::Missing { .. }))));
        assert!(matches!(load_color(dir.path()), Err(PictureError::File(FileError::IsFolder { .. }))));

        let whole = encode_png(&gradient(40, 40)).unwrap();
        for cut in [20, whole.len() / 2, whole.len() - 20] {
            files::write(&path, &whole[..cut]).unwrap();
            assert!(matches!(load_color(&path), Err(PictureError::Damaged { .. })), "cut at {cut}");
            assert!(matches!(load_depth(&path), Err(PictureError::Damaged { .. })), "cut at {cut}");
        }
        files::write(&dir.path().join("a.txt"), b"no picture").unwrap();
        let error = load_color(&dir.path().join("a.txt")).unwrap_err();
        assert!(matches!(error, PictureError::UnknownFormat { .. }));

        let mut huge = whole.clone();
        huge[16..20].copy_from_slice(&100_000u32.to_be_bytes());
        let crc = crc32(&huge[12..29]);
        huge[29..33].copy_from_slice(&crc.to_be_bytes());
        files::write(&path, &huge).unwrap();
        let error = load_color(&path).unwrap_err();
        assert!(matches!(error, PictureError::TooLarge { width: 100_000, height: 40, .. }), "{error}");

        let exr = dir.path().join("d.exr");
        write_exr(&exr, &["Z"], 1.0);
        let bytes = files::read(&exr).unwrap();
        files::write(&exr, &bytes[..bytes.len() - 9]).unwrap();
        assert!(matches!(load_depth(&exr), Err(PictureError::Damaged { .. })));
        let error = save_color(&dir.path().join("a.gif"), &gradient(2, 2)).unwrap_err();
        assert!(matches!(error, PictureError::Extension { .. }));
    }

    fn crc32(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(!0u32, |crc, byte| {
            (0..8).fold(crc ^ u32::from(*byte), |c, _| (c >> 1) ^ (0xEDB8_8320 & (c & 1).wrapping_neg()))
        })
    }

    #[test]
    fn composites() {
        let (left, right) = (gradient(8, 5), RgbImage::from_pixel(8, 5, Rgb([10, 20, 30])));
        let both = side_by_side(&left, &right).unwrap();
        assert_eq!(
            (both.dimensions(), both.get_pixel(3, 2), both.get_pixel(8, 2)),
            ((16, 5), left.get_pixel(3, 2), right.get_pixel(0, 2))
        );
        assert_eq!(cross_eyed(&left, &right).unwrap(), side_by_side(&right, &left).unwrap());
        assert_eq!(
            difference(
                &RgbImage::from_pixel(1, 1, Rgb([10, 200, 90])),
                &RgbImage::from_pixel(1, 1, Rgb([15, 100, 90]))
            )
            .unwrap()
            .get_pixel(0, 0)
            .0,
            [20, 255, 0]
        );
        assert!(matches!(difference(&left, &gradient(9, 5)), Err(PictureError::SizesDiffer { .. })));

        // The rows of both matrices together sum to 1 within the rounding of the published coefficients (green
        // and blue keep white, red loses .001), so grey in both eyes stays grey; and each eye has its own colours.
        let grey = RgbImage::from_pixel(1, 1, Rgb([128; 3]));
        let black = RgbImage::new(1, 1);
        let neutral = anaglyph(&grey, &grey).unwrap().get_pixel(0, 0).0;
        assert!(neutral.iter().all(|v| v.abs_diff(128) <= 1), "{neutral:?}");
        let [r, g, b] = anaglyph(&grey, &black).unwrap().get_pixel(0, 0).0;
        assert!(r > 120 && g == 0 && b == 0);
        let [r, g, b] = anaglyph(&black, &grey).unwrap().get_pixel(0, 0).0;
        assert!(r == 0 && g > 120 && b > 120);
    }
}
