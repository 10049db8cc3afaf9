//! Pictures in the form that encoders take: luma and chroma planes.

use image::{GrayImage, Luma, Rgb, RgbImage};

/// A picture in the form that video codecs take: 4:2:0, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Planes {
    /// Width and height in pixels, both even.
    pub size: [usize; 2],
    /// Luma, and two chroma planes of half the width and height.
    pub planes: [Vec<u8>; 3],
}

impl Planes {
    /// Converts to BT.601, full range, as in JPEG; chroma is the mean over 2x2 pixels. An odd last column or row is
    /// repeated.
    pub fn of_rgb(image: &RgbImage) -> Planes {
        let size = even(image.dimensions());
        let at = |x: usize, y: usize| {
            let (x, y) = ((x as u32).min(image.width() - 1), (y as u32).min(image.height() - 1));
            image.get_pixel(x, y).0.map(f32::from)
        };
        let byte = |value: f32| value.round().clamp(0.0, 255.0) as u8;
        let luma = |[r, g, b]: [f32; 3]| 0.299 * r + 0.587 * g + 0.114 * b;
        let [w, h] = size;
        let mut planes =
            [Vec::with_capacity(w * h), Vec::with_capacity(w * h / 4), Vec::with_capacity(w * h / 4)];
        for y in 0..h {
            planes[0].extend((0..w).map(|x| byte(luma(at(x, y)))));
        }
        for y in (0..h).step_by(2) {
            for x in (0..w).step_by(2) {
                let four = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
                let [r, g, b] = std::array::from_fn(|c| four.iter().map(|pixel| pixel[c]).sum::<f32>() / 4.0);
                let y = luma([r, g, b]);
                planes[1].push(byte(128.0 + (b - y) / 1.772));
                planes[2].push(byte(128.0 + (r - y) / 1.402));
            }
        }
        Planes { size, planes }
    }

    /// Creates a picture with the samples as luma, without colour.
    pub fn of_gray(image: &GrayImage) -> Planes {
        let [w, h] = even(image.dimensions());
        let at = |x: usize, y: usize| {
            image.get_pixel((x as u32).min(image.width() - 1), (y as u32).min(image.height() - 1)).0[0]
        };
        let luma = (0..h).flat_map(|y| (0..w).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect();
        Planes { size: [w, h], planes: [luma, vec![128; w * h / 4], vec![128; w * h / 4]] }
    }

    /// Returns a picture with both pictures, of the same height, side by side.
    pub fn beside(&self, right: &Planes) -> Planes {
        let planes = std::array::from_fn(|i| {
            let [row, right_row] = [self.size[0], right.size[0]].map(|w| if i == 0 { w } else { w / 2 });
            let rows = self.planes[i].chunks(row).zip(right.planes[i].chunks(right_row));
            rows.flat_map(|(left, right)| left.iter().chain(right)).copied().collect()
        });
        Planes { size: [self.size[0] + right.size[0], self.size[1]], planes }
    }

    /// Splits a picture that [`Planes::beside`] has put together.
    pub fn halves(&self) -> [Planes; 2] {
        let [w, h] = self.size;
        [0, 1].map(|side| {
            let planes = std::array::from_fn(|i| {
                let row = if i == 0 { w } else { w / 2 };
                let half = side * row / 2..(side + 1) * row / 2;
                self.planes[i].chunks(row).flat_map(|line| &line[half.clone()]).copied().collect()
            });
            Planes { size: [w / 2, h], planes }
        })
    }

    /// Converts to red, green and blue, without the padding that made the size even.
    pub fn rgb(&self, (width, height): (u32, u32)) -> RgbImage {
        let [w, _] = self.size;
        let byte = |value: f32| value.round().clamp(0.0, 255.0) as u8;
        RgbImage::from_fn(width, height, |x, y| {
            let (x, y) = (x as usize, y as usize);
            let chroma = y / 2 * (w / 2) + x / 2;
            let luma = f32::from(self.planes[0][y * w + x]);
            let blue = f32::from(self.planes[1][chroma]) - 128.0;
            let red = f32::from(self.planes[2][chroma]) - 128.0;
            Rgb([
                byte(luma + 1.402 * red),
                byte(luma - 0.344_136 * blue - 0.714_136 * red),
                byte(luma + 1.772 * blue),
            ])
        })
    }

    /// Returns only luma, also without the padding.
    pub fn gray(&self, (width, height): (u32, u32)) -> GrayImage {
        GrayImage::from_fn(width, height, |x, y| {
            Luma([self.planes[0][y as usize * self.size[0] + x as usize]])
        })
    }
}

fn even((width, height): (u32, u32)) -> [usize; 2] {
    [width, height].map(|n| (n as usize).next_multiple_of(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a picture of noise.
    fn image(width: u32, height: u32, seed: u32) -> RgbImage {
        let hash = |x: u32| x.wrapping_mul(0x9e37_79b9).rotate_left(13).wrapping_mul(0x85eb_ca6b) >> 24;
        RgbImage::from_fn(width, height, |x, y| {
            Rgb([0, 1, 2].map(|c| hash(x + width * y + seed * 7919 + c * 104_729) as u8))
        })
    }

    fn near(a: &RgbImage, b: &RgbImage, within: u8) -> bool {
        a.iter().zip(b.iter()).all(|(a, b)| a.abs_diff(*b) <= within)
    }

    #[test]
    fn colours_of_2x2_blocks_survive_420() {
        let colors = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255], [0, 0, 0], [200, 120, 40]];
        let picture = RgbImage::from_fn(13, 7, |x, y| Rgb(colors[(x / 2 + y / 2 * 5) as usize % 6]));
        let planes = Planes::of_rgb(&picture);
        assert_eq!((planes.size, planes.planes[0].len(), planes.planes[1].len()), ([14, 8], 112, 28));
        assert!(near(&planes.rgb((13, 7)), &picture, 2));
    }

    #[test]
    fn halves_are_what_was_put_beside() {
        let (a, b) = (image(20, 12, 1), image(20, 12, 2));
        let (a, b) = (Planes::of_rgb(&a), Planes::of_rgb(&b));
        assert_eq!(a.beside(&b).halves(), [a, b]);
    }
}
