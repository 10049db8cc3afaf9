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
    let written = unsafe { synthesizer.read(image, part) }
        .and_then(|bytes| encode(part.size, &bytes).map_err(|error| error.to_string()))
        .and_then(|png| yoro_files::write(&path, &png).map_err(|error| error.to_string()));
    if let Err(error) = written {
        say(format_args!("no picture {name}.png: {error}"));
    }
}

/// Of red, green and blue.
fn encode([width, height]: [u32; 2], bytes: &[u8]) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(bytes)?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_what_was_read() {
        let bytes: Vec<u8> = (0..3 * 4 * 5).collect();
        let picture = image::load_from_memory(&encode([4, 5], &bytes).unwrap()).unwrap();
        assert_eq!(picture.into_rgb8().into_raw(), bytes);
        assert!(encode([4, 5], &bytes[1..]).is_err());
    }
}
