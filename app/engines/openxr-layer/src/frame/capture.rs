//! Pictures of what the runtime receives in one frame. For tests.

use std::path::Path;
use std::sync::Arc;
use std::{fs, io};

use yoro::eyes::{Eye, Warp};

use super::chain::{Layers, held, projection, rectangle};
use crate::geometry::Rectangle;
use crate::say;
use crate::session::Session;
use crate::swapchain::Swapchain;
use crate::synthesizer::{Image, Synthesizer};

/// The number of the frame, counted in each session, of which pictures are taken.
pub const FRAME: u64 = 20;

/// Writes a part of an image to a PNG file of this name, if the settings name a folder for pictures.
///
/// # Safety
/// As for [`Synthesizer::read`].
pub unsafe fn write(
    session: &Session,
    synthesizer: &mut dyn Synthesizer<Warp>,
    name: &str,
    image: Image,
    part: Rectangle,
) {
    let Some(folder) = &session.instance.settings.capture else { return };
    let path = folder.join(format!("{name}.png"));
    // SAFETY: same contract.
    let written = unsafe { synthesizer.read(image, part) }
        .and_then(|bytes| encode(part.size, &bytes).map_err(|error| error.to_string()))
        .and_then(|png| save(&path, &png).map_err(|error| error.to_string()));
    if let Err(error) = written {
        say(format_args!("no picture {name}.png: {error}"));
    }
}

/// Writes a file that appears under its name only when it is complete, since a test waits for it.
fn save(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    let unfinished = path.with_added_extension("part");
    fs::write(&unfinished, bytes)?;
    fs::rename(&unfinished, path)
}

/// Writes both views of an application that renders both.
///
/// # Safety
/// The layers are those of a call of xrEndFrame.
pub unsafe fn write_stereo(session: &Session, swapchains: &[Arc<Swapchain>], layers: Layers) {
    let Some(binding) = session.binding else { return };
    // SAFETY: the application's layers.
    let layer = layers.iter().find_map(|&layer| unsafe { projection(layer, 2) });
    let Some(layer) = layer else { return };
    // SAFETY: a layer of two views.
    let views = unsafe { std::slice::from_raw_parts(layer.views, 2) };
    // SAFETY: dropped at the end of this function, during which the session is live.
    let Ok(mut synthesizer) = (unsafe { binding.synthesizer::<Warp>() }) else { return };
    for (eye, view) in Eye::BOTH.into_iter().zip(views) {
        let Ok((content, image)) = held(swapchains, view.sub_image.swapchain, "colour") else { continue };
        let Ok(part) = rectangle(&view.sub_image, content) else { continue };
        let image = content.image(image, view.sub_image.image_array_index);
        // SAFETY: the release of the image is held back. During xrEndFrame nobody else uses the queue or the context.
        unsafe { write(session, synthesizer.as_mut(), eye.name(), image, part) };
    }
}

/// Encodes pixels of red, green and blue, with rows from the top.
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
    fn a_picture_has_the_bytes_that_were_read() {
        let bytes: Vec<u8> = (0..3 * 4 * 5).collect();
        let picture = image::load_from_memory(&encode([4, 5], &bytes).unwrap()).unwrap();
        assert_eq!(picture.into_rgb8().into_raw(), bytes);
        assert!(encode([4, 5], &bytes[1..]).is_err());
    }
}
