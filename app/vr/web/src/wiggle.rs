//! Both eyes alternately, as an animated GIF.

use gif::{Encoder, EncodingError, Frame, Repeat};
use image::{RgbaImage, imageops};
use yoro::eyes::Eye;

/// How long each eye is shown, in hundredths of a second.
const DELAY: u16 = 15;
/// The quantizer samples one in this many pixels, the encoder's own compromise between quality and time.
const SPEED: i32 = 10;

/// Encodes a GIF that shows both eyes alternately forever, at most `width` pixels wide. `eyes` are RGBA, left and
/// right, rows from the bottom.
///
/// # Errors
/// Those of the encoder, for images that are empty or too large for a GIF.
pub fn wiggle(eyes: [Vec<u8>; 2], size: [u32; 2], width: u32) -> Result<Vec<u8>, EncodingError> {
    let small = size.map(|n| (n * width.min(size[0]) / size[0].max(1)).max(1));
    let sides = small.map(|n| u16::try_from(n).unwrap_or(u16::MAX));
    let mut out = Vec::new();
    let mut encoder = Encoder::new(&mut out, sides[0], sides[1], &[])?;
    encoder.set_repeat(Repeat::Infinite)?;
    for eye in Eye::BOTH {
        let image = RgbaImage::from_raw(size[0], size[1], eyes[eye.index()].clone()).unwrap_or_default();
        let image = imageops::flip_vertical(&image);
        let mut image = if small == size { image } else { imageops::thumbnail(&image, small[0], small[1]) };
        // The images' alpha is luma, which GIF would treat as transparency.
        image.pixels_mut().for_each(|pixel| pixel.0[3] = 255);
        let mut frame = Frame::from_rgba_speed(sides[0], sides[1], &mut image, SPEED);
        frame.delay = DELAY;
        encoder.write_frame(&frame)?;
    }
    drop(encoder);
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_eyes_take_turns() {
        // Upper half red or green, lower half black; luma in alpha.
        let eye = |top: [u8; 4]| [[[0, 0, 0, 0]; 64].concat(), [top; 64].concat()].concat();
        let bytes = wiggle([eye([255, 0, 0, 76]), eye([0, 255, 0, 150])], [16, 8], 8).unwrap();
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(&bytes[..]).unwrap();
        assert_eq!((decoder.width(), decoder.height(), decoder.repeat()), (8, 4, Repeat::Infinite));
        for top in [[255, 0, 0, 255], [0, 255, 0, 255]] {
            let frame = decoder.read_next_frame().unwrap().unwrap();
            assert_eq!(frame.delay, DELAY);
            assert_eq!(
                (&frame.buffer[..4], &frame.buffer[frame.buffer.len() - 4..]),
                (&top[..], &[0, 0, 0, 255][..])
            );
        }
        assert!(decoder.read_next_frame().unwrap().is_none());
    }
}
