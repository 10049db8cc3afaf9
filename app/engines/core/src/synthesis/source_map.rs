//! The source map: the source column of each pixel of the synthesized eye.

use crate::eyes::{Eye, Warp};

/// The bit of a source map entry that marks a hole.
pub const SOURCE_MAP_HOLE: u32 = 1 << 31;
/// Units per pixel of a source map entry's column.
pub const SOURCE_MAP_FIXED: f32 = 65536.0;

/// A decoded entry of a source map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SourceMapEntry {
    /// True if the pixel shows nothing of the source: its colour was filled in.
    pub hole: bool,
    /// Column in the source image, from the left. 0 is the centre of the first pixel.
    pub column: f32,
    /// Displacement in pixels, `target column - source column`, both from the left.
    pub displacement: f32,
}

impl SourceMapEntry {
    /// Decodes the entry at target column `x`, from the left.
    pub fn decode(entry: u32, x: u32, warp: &Warp) -> SourceMapEntry {
        let forward = (entry & !SOURCE_MAP_HOLE) as f32 / SOURCE_MAP_FIXED;
        let column = match warp.target_eye {
            Eye::Left => forward,
            Eye::Right => (warp.source_size[0] - 1) as f32 - forward,
        };
        SourceMapEntry { hole: entry & SOURCE_MAP_HOLE != 0, column, displacement: x as f32 - column }
    }
}
