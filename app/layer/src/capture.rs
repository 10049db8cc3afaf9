//! Pictures of what the runtime gets, for tests.

use ash::vk;

use crate::geometry::Rectangle;
use crate::say;
use crate::session::Session;
use crate::vulkan::{Image, Synthesizer};

/// The frame of a session that pictures are taken of.
pub const FRAME: u64 = 20;

/// Writes a part of an image to a PNG of this name in the folder that the settings name, if they do.
///
/// # Safety
/// As [`Synthesizer::read`].
pub unsafe fn write(
    session: &Session,
    synthesizer: &mut Synthesizer,
    name: &str,
    image: Image,
    part: Rectangle,
) {
    let Some(folder) = &session.instance.settings.capture else { return };
    let path = folder.join(format!("{name}.png"));
    // SAFETY: promised by the caller.
    let written = match unsafe { synthesizer.read(image, part) } {
        Ok(bytes) => encode(image.format, part.size, bytes),
        Err(reason) => Err(reason.to_string()),
    };
    let written = written.and_then(|png| yoro_files::write(&path, &png).map_err(|error| error.to_string()));
    if let Err(error) = written {
        say(format_args!("no picture {name}.png: {error}"));
    }
}

fn encode(format: vk::Format, size: [u32; 2], mut bytes: Vec<u8>) -> Result<Vec<u8>, String> {
    match format {
        vk::Format::R8G8B8A8_SRGB | vk::Format::R8G8B8A8_UNORM => {}
        vk::Format::B8G8R8A8_SRGB | vk::Format::B8G8R8A8_UNORM => {
            bytes.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
        }
        format => return Err(format!("{format:?} is no format of four bytes")),
    }
    // What is behind an application's image does not matter here.
    let opaque: Vec<u8> = bytes.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_raw(size[0], size[1], opaque)
        .ok_or_else(|| "it has too few bytes".to_owned())?
        .write_to(&mut png, image::ImageFormat::Png)
        .map_err(|error| error.to_string())?;
    Ok(png.into_inner())
}
