//! Writing image files.

use std::io::{self, Cursor};
use std::path::Path;

use exr::prelude::{Text, WritableImage};
use image::{GrayImage, ImageBuffer, ImageFormat, Luma, RgbImage};

use yoro_files::{self as files, FileError};

use crate::{DepthImage, PictureError};

/// Writes a colour image in the format of the extension: `.png` (lossless) or `.jpg` (quality 92).
pub fn save_color(path: &Path, image: &RgbImage) -> Result<(), PictureError> {
    if files::has_extension(path, &["png"]) {
        write_encoded(path, encode_png(image))
    } else if files::has_extension(path, &["jpg", "jpeg"]) {
        write_encoded(path, encode_jpeg(image, 92))
    } else {
        Err(PictureError::extension(path, ".png or .jpg"))
    }
}

/// Writes an 8-bit grey image, such as a mask, as PNG.
pub fn save_gray(path: &Path, image: &GrayImage) -> Result<(), PictureError> {
    only_extension(path, "png", ".png")?;
    write_encoded(path, encode_png(image))
}

/// Writes depth. `.png`: 16 bits, 0 to 1 mapped to 0 to 65535, clamped. `.exr`: one 32-bit channel `Z`, unchanged.
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

fn only_extension(path: &Path, extension: &str, allowed: &str) -> Result<(), PictureError> {
    if files::has_extension(path, &[extension]) {
        return Ok(());
    }
    Err(PictureError::extension(path, allowed))
}

/// Returns the image encoded as PNG. An image without pixels cannot be encoded.
pub(crate) fn encode_png<P>(image: &ImageBuffer<P, Vec<P::Subpixel>>) -> image::ImageResult<Vec<u8>>
where
    P: image::PixelWithColorType,
    [P::Subpixel]: image::EncodableLayout,
{
    let mut out = Cursor::new(Vec::new());
    image.write_to(&mut out, ImageFormat::Png)?;
    Ok(out.into_inner())
}

/// Returns the image encoded as JPEG, with a `quality` from 1 to 100. An image without pixels, or with more than 65535
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
