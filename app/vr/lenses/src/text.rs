//! Text for HUD, questions and menu: one font, rasterized once into cells of equal size.

use ab_glyph::{Font, FontRef, PxScale, point};

/// Size in pixels of a character's cell.
pub(crate) const CELL: [usize; 2] = [14, 28];
/// Height in pixels between the font's lowest and highest points at which a character is as wide as its cell.
const HEIGHT: f32 = CELL[0] as f32 / 1300.0 * 2430.0;
/// The characters in addition to ASCII.
const BEYOND_ASCII: &str = "°±·×–…";
const FONT: &[u8] = include_bytes!("../fonts/B612Mono-Latin.otf");

/// The ink coverage of the font's characters, rows from the top, 0 to 255.
pub(crate) struct Letters(Vec<[u8; CELL[0] * CELL[1]]>);

impl Letters {
    /// Rasterizes all characters.
    pub fn new() -> Letters {
        let font = FontRef::try_from_slice(FONT).expect("the font is part of the program");
        let scale = PxScale::from(HEIGHT);
        let ascent = font.ascent_unscaled() / font.height_unscaled() * HEIGHT;
        let baseline = ((CELL[1] as f32 - HEIGHT) / 2.0 + ascent).floor();
        let characters = (' '..='~').chain(BEYOND_ASCII.chars());
        Letters(
            characters
                .map(|c| {
                    let mut cell = [0; CELL[0] * CELL[1]];
                    let glyph = font.glyph_id(c).with_scale_and_position(scale, point(0.0, baseline));
                    if let Some(outline) = font.outline_glyph(glyph) {
                        let corner = outline.px_bounds().min;
                        outline.draw(|x, y, coverage| {
                            let (x, y) = (x as i32 + corner.x as i32, y as i32 + corner.y as i32);
                            if (0..CELL[0] as i32).contains(&x) && (0..CELL[1] as i32).contains(&y) {
                                cell[y as usize * CELL[0] + x as usize] =
                                    (coverage.clamp(0.0, 1.0) * 255.0) as u8;
                            }
                        });
                    }
                    cell
                })
                .collect(),
        )
    }

    /// Returns a character's coverage, or a question mark's if the font lacks it.
    fn cell(&self, c: char) -> &[u8; CELL[0] * CELL[1]] {
        let ascii = ('~' as usize) - (' ' as usize) + 1;
        let beyond = || Some(ascii + BEYOND_ASCII.chars().position(|other| other == c)?);
        let at = if (' '..='~').contains(&c) { Some(c as usize - ' ' as usize) } else { beyond() };
        &self.0[at.unwrap_or('?' as usize - ' ' as usize)]
    }

    /// Draws at most `columns` characters of a line in white. The image has rows from the top that are `width` pixels
    /// wide; `origin` is the text's upper left corner.
    pub fn draw(&self, line: &str, columns: usize, image: &mut [u8], width: usize, origin: [usize; 2]) {
        for (i, c) in line.chars().take(columns).enumerate() {
            for (y, row) in self.cell(c).chunks_exact(CELL[0]).enumerate() {
                let at = (origin[1] + y) * width + origin[0] + i * CELL[0];
                for (pixel, &ink) in image[at..at + CELL[0]].iter_mut().zip(row) {
                    *pixel += ((255 - u32::from(*pixel)) * u32::from(ink) / 255) as u8;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn characters_stay_in_their_cells_and_differ() {
        let letters = Letters::new();
        let ink = |c| letters.cell(c).iter().map(|&p| u32::from(p)).sum::<u32>();
        assert_eq!(ink(' '), 0);
        for (i, c) in ('!'..='~').chain(BEYOND_ASCII.chars()).enumerate() {
            assert!(ink(c) > 255, "{c}");
            assert!(('!'..='~').take(i).all(|other| letters.cell(other) != letters.cell(c)), "{c}");
        }
        assert_eq!(letters.cell('漢'), letters.cell('?'));
        // Nothing is cut off: capitals and descenders stay inside the cell.
        for c in ['M', 'g', '|'] {
            let rows: Vec<_> = letters.cell(c).chunks_exact(CELL[0]).collect();
            assert!(rows[0].iter().chain(rows[CELL[1] - 1]).all(|&p| p == 0), "{c}");
        }
    }
}
