//! Reads QR codes in pictures.

use rqrr::PreparedImage;

/// Returns the text of the first readable QR code in a picture, RGBA with rows from the top; `None` if there is none.
pub fn read_qr(rgba: &[u8], width: usize) -> Option<String> {
    let (pixels, _) = rgba.as_chunks::<4>();
    let luma = |&[r, g, b, _]: &[u8; 4]| ((2 * u16::from(r) + 5 * u16::from(g) + u16::from(b)) / 8) as u8;
    read_qr_in_luma(&pixels.iter().map(luma).collect::<Vec<u8>>(), width)
}

/// Returns the text of the first readable QR code in a picture, one byte per pixel with rows from the top; `None` if
/// there is none.
pub fn read_qr_in_luma(luma: &[u8], width: usize) -> Option<String> {
    let height = luma.len().checked_div(width)?;
    let mut image = PreparedImage::prepare_from_greyscale(width, height, |x, y| luma[y * width + x]);
    image.detect_grids().iter().find_map(|grid| Some(grid.decode().ok()?.1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use qrcode::{Color, QrCode};

    #[test]
    fn a_code_is_read_and_nothing_else() {
        let text = "https://google.com/cardboard/cfg?p=CgZHb29nbGUSEkNhcmRib2FyZCBJL08gMjAxNR0rGBU9JQHegj0qEAAASEIAAEhCAABIQgAASEJYADUpXA89OgiCPtw9";
        let code = QrCode::new(text).unwrap();
        let (modules, colors) = (code.width(), code.to_colors());
        // Modules of five pixels, in a picture taken at a slant and with a shadow.
        let side = 5 * (modules + 16);
        let pixel = |i: usize| {
            let (x, y) = ((i % side) as f32, (i / side) as f32);
            let (x, y) = (0.98 * x + 0.05 * y - 40.0, 0.98 * y - 0.05 * x - 20.0);
            let inside = |n: f32| n >= 0.0 && (n as usize) < 5 * modules;
            let is_dark =
                inside(x) && inside(y) && colors[(y as usize / 5) * modules + x as usize / 5] == Color::Dark;
            let light = 150 + (100 * (i % side) / side) as u8;
            let value = if is_dark { light / 5 } else { light };
            [value, value, value, 255]
        };
        let picture: Vec<u8> = (0..side * side).flat_map(pixel).collect();
        assert_eq!(read_qr(&picture, side).as_deref(), Some(text));
        assert_eq!(read_qr(&vec![128; picture.len()], side), None);
        assert_eq!((read_qr(&[], 0), read_qr(&[1, 2, 3], 8)), (None, None));
    }
}
