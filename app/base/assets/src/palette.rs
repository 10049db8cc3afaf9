//! Vertex colours for a renderer that has only materials: a texture of all colours, of which each triangle uses one
//! texel.

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use super::model::{TextureImage, Vertex};

/// Levels per channel.
const LEVELS: u32 = 64;

/// Returns all colours with [`LEVELS`] levels per channel: a block of red and green for each blue, in 8 x 8 blocks.
pub(super) fn palette() -> TextureImage {
    let edge = LEVELS * 8;
    let level = |i: u32| (i * 255 / (LEVELS - 1)) as u8;
    let rgba = (0..edge * edge).flat_map(|i| {
        let (x, y) = (i % edge, i / edge);
        [level(x % LEVELS), level(y % LEVELS), level(y / LEVELS * 8 + x / LEVELS), 255]
    });
    TextureImage {
        name: "vertex-colours".into(),
        size: [edge; 2],
        rgba: rgba.collect(),
        srgb: true,
        nearest: true,
    }
}

/// Gives every triangle the texture coordinates of its colour in the [`palette`]: display-referred (sRGB), 0 to 1. A
/// triangle has one colour, since neighbours in the palette are not neighbours in colour. Vertices shared by triangles
/// of different colours are split. Returns each vertex's previous index.
pub(super) fn paint(
    vertices: &mut Vec<Vertex>,
    indices: &mut [u32],
    color: impl Fn([u32; 3]) -> Vec3,
) -> Vec<u32> {
    let mut known = HashMap::new();
    let mut split = Vec::with_capacity(vertices.len());
    let mut previous = Vec::with_capacity(vertices.len());
    for triangle in indices.chunks_exact_mut(3) {
        let uv = palette_uv(color([triangle[0], triangle[1], triangle[2]]));
        for i in triangle {
            *i = *known.entry((*i, uv.x.to_bits(), uv.y.to_bits())).or_insert_with(|| {
                split.push(Vertex { uv, ..vertices[*i as usize] });
                previous.push(*i);
                split.len() as u32 - 1
            });
        }
    }
    *vertices = split;
    previous
}

/// Returns the centre of a colour's texel in the palette.
fn palette_uv(color: Vec3) -> Vec2 {
    let c = if color.is_finite() { color.clamp(Vec3::ZERO, Vec3::ONE) } else { Vec3::ONE };
    let [r, g, b] = (c * (LEVELS - 1) as f32).round().to_array().map(|l| l as u32);
    let (x, y) = (b % 8 * LEVELS + r, b / 8 * LEVELS + g);
    let edge = (LEVELS * 8) as f32;
    // Rows are stored from the top, while texture coordinates count from the bottom.
    Vec2::new((x as f32 + 0.5) / edge, 1.0 - (y as f32 + 0.5) / edge)
}
