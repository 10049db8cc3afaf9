//! The processing of a camera's picture, without Android: what is shown of it, and the code in it.

use yoro_lenses::{Board, read_qr_in_luma};

/// A camera's picture: luma in rows from the top, with strides.
pub struct Luma<'a> {
    /// The bytes from the first pixel to the last.
    pub bytes: &'a [u8],
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// Bytes from one row to the next, and from one pixel to the next.
    pub strides: [usize; 2],
}

impl Luma<'_> {
    fn pixel(&self, x: usize, y: usize) -> u8 {
        self.bytes.get(y * self.strides[0] + x * self.strides[1]).copied().unwrap_or_default()
    }

    /// Returns the text of a QR code in the picture, if there is one.
    pub fn read_qr(&self) -> Option<String> {
        let [width, height] = self.size;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| self.pixel(x, y)));
        read_qr_in_luma(&pixels.collect::<Vec<u8>>(), width)
    }

    /// Returns the picture's centre scaled to [`Board::PICTURE`], rows from the bottom, rotated by half a turn if the
    /// phone is.
    pub fn shown(&self, is_upside_down: bool) -> Vec<u8> {
        let [columns, rows] = Board::PICTURE.map(|n| n as usize);
        let [width, height] = self.size;
        // The largest part with the panel's proportions.
        let [part, tall] = if width * rows > height * columns {
            [height * columns / rows, height]
        } else {
            [width, width * rows / columns]
        };
        let [left, top] = [(width - part) / 2, (height - tall) / 2];
        let pixel = |i: usize| {
            let (column, row) = (i % columns, i / columns);
            // Rows are from the bottom, so half a turn only mirrors left and right.
            let (x, y) = if is_upside_down { (columns - 1 - column, row) } else { (column, rows - 1 - row) };
            self.pixel(left + x * part / columns, top + y * tall / rows)
        };
        (0..columns * rows).map(pixel).collect()
    }
}

/// Returns the picture size to request from a camera: of those that it offers, the largest of at most 1280 x 960
/// pixels, at which a code that spans a hand's width has several pixels per module, or else the smallest.
pub fn best_size(offered: impl Iterator<Item = [i32; 2]>) -> Option<[i32; 2]> {
    const MOST: i64 = 1280 * 960;
    let area = |[width, height]: [i32; 2]| i64::from(width) * i64::from(height);
    offered
        .filter(|size| size.iter().all(|n| *n > 0))
        .max_by_key(|size| if area(*size) <= MOST { area(*size) } else { -area(*size) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use qrcode::{Color, QrCode};

    #[test]
    fn a_code_is_read_whatever_the_strides() {
        let code = QrCode::new("https://a.example/cardboard").unwrap();
        let (modules, colors) = (code.width(), code.to_colors());
        let side = 4 * (modules + 8);
        let strides = [2 * side + 11, 2];
        let mut bytes = vec![99; strides[0] * (side - 1) + strides[1] * (side - 1) + 1];
        for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
            let [column, row] = [x, y].map(|n| (n / 4).wrapping_sub(4));
            let is_dark = column < modules && row < modules && colors[row * modules + column] == Color::Dark;
            bytes[y * strides[0] + x * strides[1]] = if is_dark { 20 } else { 230 };
        }
        let picture = Luma { bytes: &bytes, size: [side; 2], strides };
        assert_eq!(picture.read_qr().as_deref(), Some("https://a.example/cardboard"));
        // A buffer that is shorter than its size says.
        let cut = Luma { bytes: &bytes[..bytes.len() / 2], ..picture };
        assert_eq!(cut.read_qr(), None);
    }

    #[test]
    fn the_middle_is_shown_the_right_way_up() {
        let [columns, rows] = Board::PICTURE.map(|n| n as usize);
        // Twice as wide as the panel's, so the left and right quarters are cut off. The upper left of the centre is
        // bright.
        let size = [2 * columns, rows];
        let bytes: Vec<u8> = (0..size[0] * size[1])
            .map(|i| {
                let (x, y) = (i % size[0], i / size[0]);
                u8::from(x >= columns / 2 && x < columns && y < rows / 2) * 255
            })
            .collect();
        let picture = Luma { bytes: &bytes, size, strides: [size[0], 1] };
        let [straight, turned] = [false, true].map(|turn| picture.shown(turn));
        let at = |picture: &[u8], x: usize, from_bottom: usize| picture[from_bottom * columns + x];
        assert_eq!((at(&straight, 9, rows - 9), at(&straight, columns - 9, rows - 9)), (255, 0));
        assert_eq!((at(&turned, columns - 9, 9), at(&turned, 9, 9), at(&turned, 9, rows - 9)), (255, 0, 0));
    }

    #[test]
    fn the_size_is_large_but_not_huge() {
        let best = |sizes: &[[i32; 2]]| best_size(sizes.iter().copied());
        assert_eq!(best(&[[4000, 3000], [640, 480], [1280, 960], [1280, 720]]), Some([1280, 960]));
        assert_eq!(best(&[[4000, 3000], [1920, 1080], [0, 5]]), Some([1920, 1080]));
        assert_eq!(best(&[]), None);
    }
}
