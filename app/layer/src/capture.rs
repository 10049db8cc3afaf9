//! Pictures of what the runtime gets, for tests.

use crate::geometry::Rectangle;
use crate::graphics::{Image, Synthesizer};
use crate::say;
use crate::session::Session;

/// The frame of a session that pictures are taken of.
pub const FRAME: u64 = 20;

/// Writes a part of an image to a PNG of this name in the folder that the settings name, if they do.
///
/// # Safety
/// As [`Synthesizer::read`].
pub unsafe fn write(
    session: &Session,
    synthesizer: &mut dyn Synthesizer,
    name: &str,
    image: Image,
    part: Rectangle,
) {
    let Some(folder) = &session.instance.settings.capture else { return };
    let path = folder.join(format!("{name}.png"));
    // SAFETY: promised by the caller.
    let written = unsafe { synthesizer.read(image, part) }.and_then(|bytes| encode(part.size, bytes));
    let written = written.and_then(|png| yoro_files::write(&path, &png).map_err(|error| error.to_string()));
    if let Err(error) = written {
        say(format_args!("no picture {name}.png: {error}"));
    }
}

fn encode(size: [u32; 2], bytes: Vec<u8>) -> Result<Vec<u8>, String> {
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_raw(size[0], size[1], bytes)
        .ok_or_else(|| "it has too few bytes".to_owned())?
        .write_to(&mut png, image::ImageFormat::Png)
        .map_err(|error| error.to_string())?;
    Ok(png.into_inner())
}
