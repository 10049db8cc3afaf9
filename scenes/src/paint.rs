//! Procedural pictures for the built-in scenes: tileable surfaces with normal maps, facades, leaves, voxel blocks,
//! signs, screens and faces. Everything is determined by the arguments, seeds included.
//!
//! Colours are display-referred (sRGB), 0 to 1. Texture coordinates run from (0, 0) at the lower left corner to (1, 1).
//! Every surface repeats without a seam.

use glam::{UVec2, Vec2, Vec3, Vec4, vec2, vec3};
use rayon::prelude::*;

use yoro_assets::TextureImage;

/// A surface's colour and the normal map of its relief.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Diffuse map, sRGB.
    pub color: TextureImage,
    /// Tangent-space normal map, OpenGL convention; its name is the colour's with `-normal` added.
    pub normal: TextureImage,
}

/// The pictures of a wall with windows.
#[derive(Clone, Debug)]
pub struct Facade {
    /// Diffuse map, sRGB.
    pub color: TextureImage,
    /// Light of the lit windows, sRGB; its name is the colour's with `-emissive` added.
    pub emissive: TextureImage,
    /// Tangent-space normal map; its name is the colour's with `-normal` added.
    pub normal: TextureImage,
}

// Pseudo-random numbers, determined by the arguments alone.

/// Returns a well mixed hash (the output permutation of PCG on a linear congruential step).
pub fn hash(x: u32) -> u32 {
    let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// Returns the hash of a grid cell.
pub fn hash_cell(seed: u32, x: u32, y: u32) -> u32 {
    hash(x.wrapping_add(hash(y.wrapping_add(hash(seed)))))
}

/// Converts a hash to a number from 0 up to, but not including, 1.
pub fn unit(hash: u32) -> f32 {
    (hash >> 8) as f32 / 16_777_216.0
}

/// Returns 0 below `a`, 1 above `b`, and smooth values between.
pub fn smoothstep(a: f32, b: f32, x: f32) -> f32 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Returns value noise, 0 to 1, that repeats over the unit square with `cells` cells along each axis.
pub fn value_noise(seed: u32, cells: UVec2, uv: Vec2) -> f32 {
    let p = (uv - uv.floor()) * cells.as_vec2();
    let cell = p.floor().as_uvec2().min(cells - 1);
    let f = p - cell.as_vec2();
    let f = f * f * (3.0 - 2.0 * f);
    let [x0, y0] = cell.into();
    let [x1, y1] = [(x0 + 1) % cells.x, (y0 + 1) % cells.y];
    let value = |x, y| unit(hash_cell(seed, x, y));
    let lower = value(x0, y0) + (value(x1, y0) - value(x0, y0)) * f.x;
    let upper = value(x0, y1) + (value(x1, y1) - value(x0, y1)) * f.x;
    lower + (upper - lower) * f.y
}

/// Returns the sum of `octaves` octaves of [`value_noise`], each with half the amplitude; about 0 to 1, mean 0.5.
pub fn fbm(seed: u32, cells: UVec2, octaves: u32, uv: Vec2) -> f32 {
    let mut sum = 0.0;
    let mut amplitude = 0.5;
    for octave in 0..octaves {
        sum += amplitude * value_noise(seed.wrapping_add(octave), cells << octave, uv);
        amplitude *= 0.5;
    }
    sum / (1.0 - 0.5f32.powi(octaves as i32))
}

/// A sample of Worley noise: the cells around scattered points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worley {
    /// Distance to the nearest point, in cells.
    pub nearest: f32,
    /// Distance to the second nearest point, in cells.
    pub second: f32,
    /// Hash of the nearest point.
    pub id: u32,
}

/// Returns Worley noise that repeats over the unit square, one point per cell. A `jitter` of 0 gives a grid.
pub fn worley(seed: u32, cells: UVec2, jitter: f32, uv: Vec2) -> Worley {
    let p = (uv - uv.floor()) * cells.as_vec2();
    let cell = p.floor().as_ivec2();
    let mut found = Worley { nearest: f32::MAX, second: f32::MAX, id: 0 };
    for dy in -1..=1 {
        for dx in -1..=1 {
            let [cx, cy] = [cell.x + dx, cell.y + dy];
            let id =
                hash_cell(seed, cx.rem_euclid(cells.x as i32) as u32, cy.rem_euclid(cells.y as i32) as u32);
            let offset = vec2(unit(id), unit(hash(id))) - 0.5;
            let point = vec2(cx as f32 + 0.5, cy as f32 + 0.5) + offset * jitter;
            let distance = point.distance(p);
            if distance < found.nearest {
                found = Worley { nearest: distance, second: found.nearest, id };
            } else if distance < found.second {
                found.second = distance;
            }
        }
    }
    found
}

// Pictures made from functions.

fn to_bytes(color: Vec4) -> [u8; 4] {
    (color.clamp(Vec4::ZERO, Vec4::ONE) * 255.0 + 0.5).as_u8vec4().into()
}

/// Returns the texture coordinates of the centre of the pixel with this index, row 0 at the top.
fn pixel_uv(size: [u32; 2], index: usize) -> Vec2 {
    let [x, y] = [index as u32 % size[0], index as u32 / size[0]];
    vec2((x as f32 + 0.5) / size[0] as f32, 1.0 - (y as f32 + 0.5) / size[1] as f32)
}

/// Makes a picture from a function of the texture coordinates that returns colour and alpha.
pub fn picture(name: &str, size: [u32; 2], color: impl Fn(Vec2) -> Vec4 + Sync) -> TextureImage {
    let mut rgba = vec![0; (size[0] * size[1] * 4) as usize];
    rgba.par_chunks_exact_mut(4).with_min_len(1024).enumerate().for_each(|(i, pixel)| {
        pixel.copy_from_slice(&to_bytes(color(pixel_uv(size, i))));
    });
    TextureImage { name: name.into(), size, rgba, srgb: true, nearest: false }
}

/// Makes a tangent-space normal map (OpenGL convention, linear) from repeating heights, row 0 at the top. `relief` is
/// the height of the value 1 in picture widths.
pub fn normal_map(name: &str, size: [u32; 2], relief: f32, heights: &[f32]) -> TextureImage {
    let [width, height] = size.map(|n| n as usize);
    let mut rgba = vec![0; width * height * 4];
    rgba.par_chunks_exact_mut(width * 4).enumerate().for_each(|(y, row)| {
        let above = (y + height - 1) % height * width;
        let below = (y + 1) % height * width;
        for (x, pixel) in row.chunks_exact_mut(4).enumerate() {
            let left = heights[y * width + (x + width - 1) % width];
            let right = heights[y * width + (x + 1) % width];
            // Pixels are square, so both slopes are per pixel width.
            let slope = vec2(right - left, heights[above + x] - heights[below + x]);
            let slope = slope * (0.5 * relief * width as f32);
            let normal = vec3(-slope.x, -slope.y, 1.0).normalize();
            pixel.copy_from_slice(&to_bytes((normal * 0.5 + 0.5).extend(1.0)));
        }
    });
    TextureImage { name: name.into(), size, rgba, srgb: false, nearest: false }
}

/// Makes a surface from a function of the texture coordinates to colour and height; for `relief` see [`normal_map`].
pub fn surface(
    name: &str,
    size: [u32; 2],
    relief: f32,
    color_and_height: impl Fn(Vec2) -> (Vec3, f32) + Sync,
) -> Surface {
    let count = (size[0] * size[1]) as usize;
    let mut rgba = vec![0; count * 4];
    let mut heights = vec![0.0; count];
    rgba.par_chunks_exact_mut(4).zip(heights.par_iter_mut()).with_min_len(1024).enumerate().for_each(
        |(i, (pixel, height))| {
            let (color, h) = color_and_height(pixel_uv(size, i));
            *height = h;
            pixel.copy_from_slice(&to_bytes(color.extend(1.0)));
        },
    );
    Surface {
        color: TextureImage { name: name.into(), size, rgba, srgb: true, nearest: false },
        normal: normal_map(&format!("{name}-normal"), size, relief, &heights),
    }
}

/// The brick of a running bond that contains a point, and the point's place in it.
struct Brick {
    /// Hash of the brick.
    id: u32,
    /// Position in the brick, 0 to 1.
    local: Vec2,
    /// Distance to the nearest edge, in brick heights.
    edge: f32,
}

fn brick(seed: u32, columns: u32, rows: u32, shift: f32, uv: Vec2) -> Brick {
    let row = (uv.y * rows as f32).floor();
    let x = uv.x * columns as f32 + if row as i32 % 2 == 0 { 0.0 } else { shift };
    let column = x.floor();
    let local = vec2(x - column, uv.y * rows as f32 - row);
    let aspect = rows as f32 / columns as f32;
    let edge = (0.5 - (local.x - 0.5).abs()) * aspect;
    Brick {
        id: hash_cell(seed, column.rem_euclid(columns as f32) as u32, row.rem_euclid(rows as f32) as u32),
        local,
        edge: edge.min(0.5 - (local.y - 0.5).abs()),
    }
}

fn shade(color: Vec3, amount: f32) -> Vec3 {
    color * (1.0 + amount)
}

/// Paints a brick wall in running bond, with `columns` by `rows` bricks (`rows` even).
pub fn bricks(
    name: &str,
    size: u32,
    seed: u32,
    color: Vec3,
    mortar: Vec3,
    [columns, rows]: [u32; 2],
) -> Surface {
    surface(name, [size; 2], 0.3 / rows as f32, |uv| {
        let grain = fbm(seed, UVec2::splat(16), 5, uv);
        let wobble = (fbm(seed + 40, UVec2::splat(24), 2, uv) - 0.5) * 0.06;
        let brick = brick(seed, columns, rows, 0.5, uv);
        let body = smoothstep(0.05, 0.12, brick.edge + wobble);
        let tint = (unit(brick.id) - 0.5) * 0.45 + (grain - 0.5) * 0.5;
        let warm = vec3(1.0, 0.94, 0.9).lerp(vec3(0.95, 1.0, 1.02), unit(hash(brick.id)));
        let fired = shade(color * warm, tint);
        (shade(mortar, (grain - 0.5) * 0.5).lerp(fired, body), body * (0.75 + 0.25 * grain) + 0.1 * grain)
    })
}

/// Paints large hewn blocks, `columns` by `rows` (`rows` even).
pub fn stone_blocks(name: &str, size: u32, seed: u32, color: Vec3, [columns, rows]: [u32; 2]) -> Surface {
    surface(name, [size; 2], 0.12 / rows as f32, |uv| {
        let grain = fbm(seed, UVec2::splat(8), 6, uv);
        let stain = fbm(seed + 9, UVec2::splat(3), 4, uv);
        let block = brick(seed, columns, rows, 0.4, uv);
        let body = smoothstep(0.01, 0.05, block.edge + (grain - 0.5) * 0.02);
        let tint = (unit(block.id) - 0.5) * 0.22 + (grain - 0.5) * 0.4 + (stain - 0.5) * 0.3;
        (shade(color, tint) * (0.45 + 0.55 * body), body + 0.5 * grain)
    })
}

/// Paints rough plaster with faint stains.
pub fn plaster(name: &str, size: u32, seed: u32, color: Vec3) -> Surface {
    surface(name, [size; 2], 0.004, |uv| {
        let stain = fbm(seed, UVec2::splat(3), 5, uv);
        let grain = fbm(seed + 7, UVec2::splat(48), 3, uv);
        (shade(color, (stain - 0.5) * 0.22 + (grain - 0.5) * 0.12), grain + 0.6 * stain)
    })
}

/// Paints poured concrete: stains, pores, four formwork panels with tie holes.
pub fn concrete(name: &str, size: u32, seed: u32, color: Vec3) -> Surface {
    surface(name, [size; 2], 0.012, |uv| {
        let stain = fbm(seed, UVec2::splat(4), 6, uv);
        let pore = worley(seed, UVec2::splat(48), 1.0, uv);
        let pit = smoothstep(0.2, 0.1, pore.nearest) * (unit(pore.id) > 0.75) as u32 as f32;
        let panel = (uv * 2.0).fract();
        let edge = panel.min(1.0 - panel).min_element();
        let seam = smoothstep(0.012, 0.004, edge);
        let corner = (panel.min(1.0 - panel) - 0.15).length();
        let hole = smoothstep(0.022, 0.016, corner);
        let dark = 0.35 * pit + 0.3 * seam + 0.5 * hole;
        (
            shade(color, (stain - 0.5) * 0.4) * (1.0 - dark),
            stain * 0.5 - 0.4 * pit - 0.5 * seam - hole.min(0.8),
        )
    })
}

/// Paints `count` wooden boards that run along u, with butt joints.
pub fn planks(name: &str, size: u32, seed: u32, color: Vec3, count: u32) -> Surface {
    surface(name, [size; 2], 0.06 / count as f32, |uv| {
        let row = (uv.y * count as f32).floor().min(count as f32 - 1.0) as u32;
        let id = hash_cell(seed, row, 3);
        let x = (uv.x + unit(id)).fract();
        // Each board has its own section of the grain.
        let along = vec2(x, (uv.y + unit(hash(id))).fract());
        let wave = fbm(seed, UVec2::new(3, 4 * count), 3, along);
        let fibre = fbm(seed + 5, UVec2::new(8, 32 * count), 3, along);
        let ring = ((wave * 9.0 + along.y * count as f32 * 0.7).fract() - 0.5).abs() * 2.0;
        let across = (uv.y * count as f32).fract();
        let edge = (0.5 - (across - 0.5).abs()).min((0.5 - (x - 0.5).abs()) * count as f32);
        let body = smoothstep(0.01, 0.05, edge);
        let tint = (unit(hash(id + 1)) - 0.5) * 0.3 + (ring - 0.5) * 0.16 + (fibre - 0.5) * 0.4;
        (shade(color, tint) * (0.35 + 0.65 * body), body + 0.25 * fibre)
    })
}

/// Paints square tiles of two colours in a checkerboard, `count` per side (even), with joints.
pub fn tiles(name: &str, size: u32, seed: u32, colors: [Vec3; 2], count: u32) -> Surface {
    surface(name, [size; 2], 0.03 / count as f32, |uv| {
        let p = uv * count as f32;
        let cell = p.floor();
        let local = p - cell;
        let id = hash_cell(seed, cell.x as u32, cell.y as u32);
        let edge = local.min(1.0 - local).min_element();
        let body = smoothstep(0.012, 0.035, edge);
        let grain = fbm(seed, UVec2::splat(12), 5, (uv + vec2(unit(id), unit(hash(id)))).fract());
        let color = colors[(cell.x as usize + cell.y as usize) % 2];
        let tint = (unit(id) - 0.5) * 0.1 + (grain - 0.5) * 0.25;
        (vec3(0.32, 0.3, 0.28).lerp(shade(color, tint), body), body)
    })
}

/// Paints polished marble with veins, without joints.
pub fn marble(name: &str, size: u32, seed: u32, color: Vec3, vein: Vec3) -> Surface {
    surface(name, [size; 2], 0.002, |uv| {
        let warp = vec2(fbm(seed, UVec2::splat(3), 4, uv), fbm(seed + 11, UVec2::splat(3), 4, uv)) - 0.5;
        let thin = (fbm(seed + 23, UVec2::splat(3), 6, uv + warp * 0.35) - 0.5).abs();
        let wide = (fbm(seed + 31, UVec2::splat(2), 5, uv + warp * 0.5) - 0.5).abs();
        let amount = 0.75 * smoothstep(0.045, 0.0, thin) + 0.3 * smoothstep(0.16, 0.0, wide);
        let cloud = fbm(seed + 3, UVec2::splat(4), 5, uv);
        (shade(color, (cloud - 0.5) * 0.16).lerp(vein, amount.min(0.9)), cloud)
    })
}

/// Paints plain weave with `threads` threads per side (even).
pub fn fabric(name: &str, size: u32, seed: u32, color: Vec3, threads: u32) -> Surface {
    surface(name, [size; 2], 0.25 / threads as f32, |uv| {
        let p = uv * threads as f32;
        let cell = p.floor();
        let local = (p - cell - 0.5).abs();
        let over = ((cell.x + cell.y) as u32).is_multiple_of(2);
        let (across, along) = if over { (local.x, local.y) } else { (local.y, local.x) };
        let height = (1.0 - 3.0 * across * across) * (1.0 - along * along);
        let worn = fbm(seed, UVec2::splat(5), 4, uv);
        let thread = unit(hash_cell(seed, if over { cell.x } else { cell.y } as u32, over as u32));
        (shade(color, (height - 0.7) * 0.4 + (worn - 0.5) * 0.2 + (thread - 0.5) * 0.12), height)
    })
}

/// Paints damask, a two-tone ornament on a fine weave, for curtains, carpets and upholstery; `count` motifs per side.
pub fn damask(name: &str, size: u32, seed: u32, color: Vec3, ornament: Vec3, count: u32) -> Surface {
    surface(name, [size; 2], 0.02 / count as f32, |uv| {
        let motif = |offset: f32| {
            let p = ((uv * count as f32 + offset).fract() - 0.5) * 2.0;
            let angle = p.y.atan2(p.x);
            let petals = 0.42 + 0.16 * (angle * 4.0).cos() + 0.07 * (angle * 12.0).cos();
            let ring = (p.length() - 0.2).abs() - 0.04;
            smoothstep(0.03, -0.03, p.length() - petals) - smoothstep(0.03, -0.03, ring)
        };
        let mask = motif(0.0).max(motif(0.5)).clamp(0.0, 1.0);
        let weave = fbm(seed, UVec2::splat(64), 2, uv) - 0.5;
        (shade(color.lerp(ornament, mask), weave * 0.3), mask + 0.4 * weave)
    })
}

/// Paints riveted metal panels, `columns` by `rows`, scratched and worn at the edges.
pub fn metal_panels(name: &str, size: u32, seed: u32, color: Vec3, [columns, rows]: [u32; 2]) -> Surface {
    surface(name, [size; 2], 0.03 / rows.max(columns) as f32, |uv| {
        let p = uv * vec2(columns as f32, rows as f32);
        let cell = p.floor();
        let local = p - cell;
        let id = hash_cell(seed, cell.x as u32, cell.y as u32);
        let near = local.min(1.0 - local);
        let edge = near.min_element();
        let body = smoothstep(0.012, 0.03, edge);
        let rivet = smoothstep(0.02, 0.012, (near - 0.08).length());
        let scratch = fbm(seed, UVec2::new(4, 96), 4, uv);
        let stain = fbm(seed + 5, UVec2::splat(5), 5, uv);
        let worn = smoothstep(0.62, 0.7, stain) * smoothstep(0.2, 0.02, edge);
        let tint = (unit(id) - 0.5) * 0.22 + (scratch - 0.5) * 0.2 + (stain - 0.5) * 0.25 - 0.15 * rivet;
        let metal = shade(color, tint).lerp(vec3(0.35, 0.24, 0.17), worn * 0.6);
        (metal * (0.25 + 0.75 * body), body + 0.5 * rivet + 0.05 * scratch)
    })
}

/// Paints grass seen from above.
pub fn grass(name: &str, size: u32, seed: u32, color: Vec3) -> Surface {
    surface(name, [size; 2], 0.02, |uv| {
        let patch = fbm(seed, UVec2::splat(4), 4, uv);
        let blades = fbm(seed + 3, UVec2::new(96, 40), 3, uv).max(fbm(seed + 8, UVec2::new(40, 96), 3, uv));
        let dry = vec3(1.25, 1.05, 0.75);
        let tint = (blades - 0.6) * 1.5;
        (shade(color * Vec3::ONE.lerp(dry, smoothstep(0.5, 0.75, patch)), tint), blades)
    })
}

/// Paints soil with pebbles.
pub fn soil(name: &str, size: u32, seed: u32, color: Vec3) -> Surface {
    surface(name, [size; 2], 0.03, |uv| {
        let clod = fbm(seed, UVec2::splat(8), 6, uv);
        let stone = worley(seed, UVec2::splat(24), 1.0, uv);
        let pebble = smoothstep(0.3, 0.2, stone.nearest) * (unit(stone.id) > 0.7) as u32 as f32;
        let gray = Vec3::splat(0.45 + 0.2 * unit(hash(stone.id)));
        (shade(color, (clod - 0.5) * 1.1).lerp(gray, pebble * 0.8), clod + 0.4 * pebble)
    })
}

/// Paints bark that runs along v.
pub fn bark(name: &str, size: u32, seed: u32, color: Vec3) -> Surface {
    surface(name, [size; 2], 0.05, |uv| {
        let warp = (fbm(seed, UVec2::new(6, 3), 4, uv) - 0.5) * 0.2;
        let ridge = fbm(seed + 4, UVec2::new(14, 4), 4, uv + vec2(warp, 0.0));
        let height = 1.0 - (ridge - 0.5).abs() * 4.0;
        (shade(color, (height - 0.5) * 0.8), height)
    })
}

/// Paints asphalt: dark grit with worn patches.
pub fn asphalt(name: &str, size: u32, seed: u32, color: Vec3) -> Surface {
    surface(name, [size; 2], 0.008, |uv| {
        let worn = fbm(seed, UVec2::splat(4), 4, uv);
        let grit = worley(seed, UVec2::splat(size / 6), 1.0, uv);
        let grain = (unit(grit.id) - 0.5) * 0.9;
        (shade(color, grain + (worn - 0.5) * 0.5), 1.0 - grit.nearest)
    })
}

/// Paints overlapping rounded roof tiles, `columns` by `rows` (`rows` even); down is -v.
pub fn roof_tiles(name: &str, size: u32, seed: u32, color: Vec3, [columns, rows]: [u32; 2]) -> Surface {
    surface(name, [size; 2], 0.25 / rows as f32, |uv| {
        let tile = brick(seed, columns, rows, 0.5, uv);
        let x = (tile.local.x - 0.5).abs() * 2.0;
        let lip = smoothstep(0.0, 0.12, tile.local.y - 0.12 * (1.0 - (1.0 - x * x).max(0.0).sqrt()));
        let grain = fbm(seed, UVec2::splat(12), 5, uv);
        let height = (1.0 - tile.local.y) * lip + 0.3 * (1.0 - x * x);
        let gap = smoothstep(1.0, 0.9, x);
        let tint = (unit(tile.id) - 0.5) * 0.35 + (grain - 0.5) * 0.5;
        (shade(color, tint) * (0.4 + 0.6 * lip * (0.5 + 0.5 * gap)), height)
    })
}

/// Paints the grid of a prototype level: one metre per picture, a strong line around it, fine lines every
/// `1 / divisions`, a cross in the middle and a small label; unfiltered colours, two tones.
pub fn prototype_grid(
    name: &str,
    size: u32,
    color: Vec3,
    line: Vec3,
    divisions: u32,
    label: &str,
) -> TextureImage {
    let s = size as f32;
    let mut canvas = Canvas::new([size; 2], color.extend(1.0));
    let half = s * 0.5;
    let lighter = (color * 1.12).extend(1.0);
    canvas.rect(vec2(0.0, 0.0), Vec2::splat(half), lighter);
    canvas.rect(Vec2::splat(half), Vec2::splat(s), lighter);
    for i in 0..divisions {
        let at = s * i as f32 / divisions as f32;
        let fine = line.extend(0.45);
        canvas.rect(vec2(at - s * 0.002, 0.0), vec2(at + s * 0.002, s), fine);
        canvas.rect(vec2(0.0, at - s * 0.002), vec2(s, at + s * 0.002), fine);
    }
    for (min, max) in [
        (vec2(0.0, 0.0), vec2(s, s * 0.01)),
        (vec2(0.0, s * 0.99), vec2(s, s)),
        (vec2(0.0, 0.0), vec2(s * 0.01, s)),
        (vec2(s * 0.99, 0.0), vec2(s, s)),
    ] {
        canvas.rect(min, max, line.extend(1.0));
    }
    canvas.rect(
        vec2(half - s * 0.05, half - s * 0.006),
        vec2(half + s * 0.05, half + s * 0.006),
        line.extend(1.0),
    );
    canvas.rect(
        vec2(half - s * 0.006, half - s * 0.05),
        vec2(half + s * 0.006, half + s * 0.05),
        line.extend(1.0),
    );
    canvas.text(vec2(s * 0.06, s * 0.06), s * 0.07, label, line.extend(1.0));
    canvas.into_texture(name)
}

/// Paints a wall with `columns` by `floors` windows, of which a share (0 to 1) is lit. The picture repeats.
pub fn facade(
    name: &str,
    size: u32,
    seed: u32,
    wall: Vec3,
    glass: Vec3,
    [columns, floors]: [u32; 2],
    lit_share: f32,
) -> Facade {
    let window = |uv: Vec2| {
        let p = uv * vec2(columns as f32, floors as f32);
        let cell = p.floor();
        let local = p - cell;
        let inside = (local - vec2(0.5, 0.52)).abs() - vec2(0.31, 0.33);
        let edge = inside.max_element();
        (hash_cell(seed, cell.x as u32, cell.y as u32), local, edge)
    };
    let lit = |id: u32| unit(hash(id ^ 0x5bd1)) < lit_share;
    let lamp =
        |id: u32| vec3(1.0, 0.82, 0.52).lerp(vec3(0.75, 0.88, 1.0), smoothstep(0.6, 0.9, unit(hash(id + 1))));
    // Blinds, and furniture against the light: enough to make lit rooms differ.
    let room = |id: u32, local: Vec2| {
        let blind = local.y > 0.85 - 0.6 * unit(hash(id + 2)) * (unit(hash(id + 3)) > 0.5) as u32 as f32;
        let shelf = local.y < 0.3 + 0.15 * unit(hash_cell(id, (local.x * 9.0) as u32, 1));
        if blind {
            0.55
        } else if shelf {
            0.35
        } else {
            0.8 + 0.2 * local.y
        }
    };
    let painted = surface(name, [size; 2], 0.05 / floors as f32, |uv| {
        let (id, local, edge) = window(uv);
        let grain = fbm(seed, UVec2::splat(8), 5, uv);
        let mullion = (local.x - 0.5).abs() < 0.012 || (local.y - 0.62).abs() < 0.012;
        if edge < -0.03 && !mullion {
            let sky = 0.75 + 0.5 * local.y + 0.25 * (unit(id) - 0.5);
            let pane = if lit(id) { lamp(id) * room(id, local) * 0.6 } else { glass * sky };
            (pane, 0.0)
        } else if edge < 0.0 {
            (wall * 0.45 + 0.2, 0.6)
        } else {
            let sill = (local.y - 0.165).abs() < 0.025 && (local.x - 0.5).abs() < 0.36;
            let band = local.y < 0.05;
            let streak = fbm(seed + 2, UVec2::new(32, 3), 4, uv);
            let base = shade(wall, (grain - 0.5) * 0.3 + (streak - 0.5) * 0.2);
            let color = if sill {
                base * 1.2 + 0.04
            } else if band {
                base * 0.85
            } else {
                base
            };
            (color, if sill { 1.4 } else { 1.0 + 0.05 * grain })
        }
    });
    let emissive = picture(&format!("{name}-emissive"), [size; 2], |uv| {
        let (id, local, edge) = window(uv);
        let mullion = (local.x - 0.5).abs() < 0.012 || (local.y - 0.62).abs() < 0.012;
        let on = edge < -0.03 && !mullion && lit(id);
        if on { (lamp(id) * room(id, local)).extend(1.0) } else { Vec4::W }
    });
    Facade { color: painted.color, emissive, normal: painted.normal }
}

/// Paints a twig with leaves on a transparent ground, stem at the bottom centre, for alpha-tested foliage cards.
pub fn leaf_card(name: &str, size: u32, seed: u32, color: Vec3) -> TextureImage {
    let s = size as f32;
    // The ground has the leaf's colour, so that filtered edges do not darken.
    let mut canvas = Canvas::new([size; 2], (color * 0.8).extend(0.0));
    let twig = vec3(0.33, 0.25, 0.16).extend(1.0);
    canvas.line(vec2(0.5, 1.0) * s, vec2(0.5, 0.12) * s, s * 0.018, twig);
    let count = 15;
    for i in 0..count {
        let h = hash_cell(seed, i, 1);
        let along = 0.95 - 0.85 * i as f32 / (count - 1) as f32;
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let spread = if i == count - 1 { 0.0 } else { 0.75 + 0.5 * unit(hash(h)) };
        let direction = vec2(side * spread.sin(), -spread.cos());
        let length = s * (0.2 + 0.12 * unit(h)) * (0.75 + 0.5 * along);
        let root = vec2(0.5, along) * s;
        let tip = root + direction * length;
        let tint = shade(color, (unit(hash(h + 1)) - 0.5) * 0.5);
        canvas.leaf(root, tip, length * 0.24, tint.extend(1.0));
        canvas.line(root, root + direction * length * 0.85, s * 0.006, (tint * 0.72).extend(0.8));
    }
    canvas.into_texture(name)
}

/// The kinds of voxel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Block {
    /// Grass from above.
    GrassTop,
    /// Earth with a fringe of grass.
    GrassSide,
    /// Earth.
    Dirt,
    /// Natural rock.
    Stone,
    /// Rock of another layer.
    DarkStone,
    /// Boulders in mortar.
    Cobble,
    /// Hewn blocks.
    StoneBrick,
    /// Hewn blocks with moss.
    MossyBrick,
    /// Sand.
    Sand,
    /// Hewn sandstone.
    Sandstone,
    /// Loose stones.
    Gravel,
    /// Trunk from the side.
    LogSide,
    /// Trunk cut across.
    LogTop,
    /// Boards.
    Planks,
    /// Dense leaves.
    Leaves,
    /// Leaves in bloom.
    Blossom,
    /// Water's surface.
    Water,
    /// Snow.
    Snow,
    /// Burnt clay roof.
    Roof,
    /// Gilded block.
    Gold,
    /// A lamp behind a grille.
    Lantern,
}

/// Paints a voxel's face, 16 by 16 texels, unfiltered. Each block has its own picture, so that mip levels do not bleed.
pub fn voxel(name: &str, seed: u32, block: Block) -> TextureImage {
    const N: u32 = 16;
    let noise = |x: u32, y: u32| unit(hash_cell(seed, x, y)) - 0.5;
    let blotch = |uv: Vec2| fbm(seed + 17, UVec2::splat(4), 2, uv) - 0.5;
    let mut image = picture(name, [N; 2], |uv| {
        let [x, y] = (uv * N as f32).as_uvec2().into();
        let n = noise(x, y);
        let b = blotch(uv);
        let grass = vec3(0.4, 0.55, 0.27);
        let dirt = vec3(0.46, 0.33, 0.22);
        let seam = |columns: u32, rows: u32| {
            let row = y / (N / rows);
            let shifted = x + if row % 2 == 1 { N / columns / 2 } else { 0 };
            y % (N / rows) == 0 || shifted % (N / columns) == 0
        };
        let color = match block {
            Block::GrassTop => shade(grass, n * 0.35 + b * 0.3),
            Block::GrassSide => {
                let fringe = 11 + (hash_cell(seed, x, 99) % 3);
                if y > fringe { shade(grass, n * 0.35) } else { shade(dirt, n * 0.35) }
            }
            Block::Dirt => shade(dirt, n * 0.35 + b * 0.4),
            Block::Stone => shade(Vec3::splat(0.52), n * 0.14 + b * 0.45),
            Block::DarkStone => shade(vec3(0.36, 0.35, 0.39), n * 0.16 + b * 0.5),
            Block::Cobble => {
                let stone = worley(seed, UVec2::splat(4), 0.8, uv);
                let gap = stone.second - stone.nearest < 0.12;
                let c = shade(Vec3::splat(0.55), n * 0.12 + (unit(stone.id) - 0.5) * 0.4);
                if gap { c * 0.62 } else { c }
            }
            Block::StoneBrick | Block::MossyBrick => {
                let c =
                    shade(vec3(0.58, 0.57, 0.54), n * 0.12 + b * 0.25) * if seam(2, 2) { 0.6 } else { 1.0 };
                let moss = block == Block::MossyBrick && b + n * 0.25 > 0.05;
                if moss { shade(vec3(0.32, 0.45, 0.2), n * 0.4) } else { c }
            }
            Block::Sand => shade(vec3(0.86, 0.79, 0.58), n * 0.12 + b * 0.1),
            Block::Sandstone => {
                let layer = unit(hash_cell(seed, 5, y / 2)) - 0.5;
                shade(vec3(0.82, 0.71, 0.5), n * 0.08 + layer * 0.2) * if seam(1, 2) { 0.75 } else { 1.0 }
            }
            Block::Gravel => shade(vec3(0.5, 0.47, 0.45), n * 0.5),
            Block::LogSide => {
                let groove = unit(hash_cell(seed, x, 7)) - 0.5;
                shade(vec3(0.36, 0.26, 0.16), n * 0.2 + groove * 0.6)
            }
            Block::LogTop => {
                let ring = (x as i32 - 8).abs().max((y as i32 - 8).abs());
                let c = if ring % 2 == 0 { vec3(0.66, 0.52, 0.32) } else { vec3(0.54, 0.41, 0.25) };
                if ring >= 7 { vec3(0.36, 0.26, 0.16) } else { shade(c, n * 0.1) }
            }
            Block::Planks => {
                let fibre = unit(hash_cell(seed, x / 3, y)) - 0.5;
                let joint = y % 4 == 0 || (x + (y / 4) * 5) % N == 0;
                shade(vec3(0.64, 0.48, 0.29), n * 0.08 + fibre * 0.2) * if joint { 0.6 } else { 1.0 }
            }
            Block::Leaves => shade(vec3(0.2, 0.42, 0.14), n * 0.8 + b * 0.4),
            Block::Blossom => shade(vec3(0.86, 0.55, 0.66), n * 0.45 + b * 0.3),
            Block::Water => shade(vec3(0.16, 0.36, 0.6), b * 0.5 + n * 0.1),
            Block::Snow => shade(vec3(0.92, 0.94, 0.97), n * 0.05),
            Block::Roof => {
                let lip = y % 4 == 0;
                shade(vec3(0.62, 0.27, 0.2), n * 0.2)
                    * if lip || (x + (y / 4) * 2) % 4 == 0 { 0.7 } else { 1.0 }
            }
            Block::Gold => {
                let rim = x == 0 || y == 0 || x == N - 1 || y == N - 1;
                shade(vec3(0.95, 0.78, 0.28), n * 0.12 + (y as f32 / 16.0 - 0.5) * 0.3)
                    * if rim { 0.7 } else { 1.0 }
            }
            Block::Lantern => {
                let bar = x % 5 == 0 || y % 5 == 0;
                if bar { vec3(0.2, 0.16, 0.12) } else { vec3(1.0, 0.8, 0.42) }
            }
        };
        color.extend(1.0)
    });
    image.nearest = true;
    image
}

/// Plants on voxels, made of crossed cards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Plant {
    /// Blades of grass.
    Grass,
    /// A poppy.
    Poppy,
    /// A yellow flower.
    Buttercup,
    /// Fern.
    Fern,
    /// Leaves that hang down a wall; the picture repeats upwards.
    Vine,
}

/// Paints a voxel plant, 16 by 16 texels, unfiltered, alpha 0 or 1.
pub fn voxel_plant(name: &str, seed: u32, plant: Plant) -> TextureImage {
    const N: u32 = 16;
    let green = match plant {
        Plant::Grass | Plant::Poppy | Plant::Buttercup => vec3(0.48, 0.68, 0.34),
        Plant::Fern => vec3(0.34, 0.56, 0.28),
        Plant::Vine => vec3(0.22, 0.42, 0.15),
    };
    let mut image = picture(name, [N; 2], |uv| {
        let [x, y] = (uv * N as f32).as_uvec2().into();
        let n = unit(hash_cell(seed, x, y)) - 0.5;
        let leaf = Some(shade(green, n * 0.5 + (y as f32 / 16.0 - 0.5) * 0.4));
        let from_middle = x.abs_diff(8);
        let petal = |center: [u32; 2], radius: u32, color: Vec3, heart: Vec3| {
            let d = x.abs_diff(center[0]).max(y.abs_diff(center[1]));
            let corner = x.abs_diff(center[0]) + y.abs_diff(center[1]) == 2 * radius;
            if d == 0 { Some(heart) } else { (d <= radius && !corner).then(|| shade(color, n * 0.3)) }
        };
        let stalk = (from_middle == 0 || (y < 5 && from_middle == 4 - y.min(4))).then_some(()).and(leaf);
        let color = match plant {
            Plant::Grass => {
                let blade = hash_cell(seed, x, 1);
                let lean = y / 6 * (blade & 1);
                let root = hash_cell(seed, (x + lean) % N, 2);
                (!root.is_multiple_of(3) && y < 5 + root % 10).then_some(()).and(leaf)
            }
            Plant::Poppy => petal([8, 11], 2, vec3(0.85, 0.16, 0.12), vec3(0.15, 0.1, 0.1))
                .or((y < 10).then_some(()).and(stalk)),
            Plant::Buttercup => petal([8, 9], 1, vec3(0.95, 0.82, 0.2), vec3(0.8, 0.55, 0.1))
                .or((y < 9).then_some(()).and(stalk)),
            Plant::Fern => {
                let frond = y.abs_diff(from_middle * 3 / 2) < 2 || y.abs_diff(3 + from_middle / 2) < 2;
                (from_middle < 8 && frond && (x + y) % 3 != 0 || (from_middle == 0 && y < 12))
                    .then_some(())
                    .and(leaf)
            }
            Plant::Vine => {
                let run = !hash_cell(seed, x / 2, 3).is_multiple_of(3);
                (run && !hash_cell(seed, x, y + 50).is_multiple_of(4)).then_some(()).and(leaf)
            }
        };
        color.map_or(green.extend(0.0), |c| c.extend(1.0))
    });
    image.nearest = true;
    image
}

/// Paints text in the middle of a board with a frame.
pub fn sign(name: &str, size: [u32; 2], text: &str, ink: Vec3, ground: Vec3) -> TextureImage {
    let extent = vec2(size[0] as f32, size[1] as f32);
    let mut canvas = Canvas::new(size, ground.extend(1.0));
    let frame = extent.min_element() * 0.05;
    canvas.rounded(Vec2::splat(frame), extent - frame, frame, ink.extend(1.0));
    canvas.rounded(Vec2::splat(frame * 1.7), extent - frame * 1.7, frame * 0.8, ground.extend(1.0));
    let height = (extent.y * 0.55).min((extent.x - frame * 6.0) / text_width(1.0, text).max(0.1));
    let corner = (extent - vec2(text_width(height, text), height)) * 0.5;
    canvas.text(corner, height, text, ink.extend(1.0));
    canvas.into_texture(name)
}

/// Paints the screen of a computer or stage: a title bar, a chart, lines of text, bars. Meant as an emissive map too.
pub fn screen(name: &str, size: [u32; 2], seed: u32, accent: Vec3, title: &str) -> TextureImage {
    let e = vec2(size[0] as f32, size[1] as f32);
    let mut canvas = Canvas::new(size, (accent * 0.06 + vec3(0.02, 0.03, 0.05)).extend(1.0));
    let at = |x: f32, y: f32| vec2(x, y) * e;
    canvas.rect(at(0.0, 0.0), at(1.0, 0.13), (accent * 0.5).extend(1.0));
    canvas.text(at(0.03, 0.03), e.y * 0.07, title, Vec4::ONE);
    for i in 0..5 {
        let y = 0.2 + 0.09 * i as f32;
        canvas.rect(at(0.04, y), at(0.52, y + 0.004), (accent * 0.3).extend(1.0));
    }
    let value = |i: u32| 0.22 + 0.32 * unit(hash_cell(seed, i, 1));
    for i in 0..12 {
        let [a, b] = [i, i + 1].map(|i| at(0.04 + 0.04 * i as f32, value(i)));
        canvas.line(a, b, e.y * 0.012, accent.extend(1.0));
    }
    for i in 0..10 {
        let x = 0.04 + 0.048 * i as f32;
        let top = 0.92 - 0.26 * unit(hash_cell(seed, i, 2));
        let color = accent.lerp(vec3(1.0, 0.6, 0.25), unit(hash_cell(seed, i, 3)));
        canvas.rect(at(x, top), at(x + 0.032, 0.92), color.extend(1.0));
    }
    for i in 0..11 {
        let y = 0.2 + 0.067 * i as f32;
        let length = 0.15 + 0.22 * unit(hash_cell(seed, i, 4));
        let ink = if i % 4 == 0 { accent } else { Vec3::splat(0.75) };
        canvas.rounded(at(0.57, y), at(0.57 + length, y + 0.025), e.y * 0.01, ink.extend(1.0));
    }
    canvas.into_texture(name)
}

/// The features of a painted face.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Skin.
    pub skin: Vec3,
    /// Iris.
    pub iris: Vec3,
    /// Brows and lashes.
    pub brow: Vec3,
    /// Lips.
    pub lips: Vec3,
    /// Centre of the right eye, in the picture's left half, 0 to 1 from the lower left; the other eye mirrors it.
    pub eye: Vec2,
    /// Half extents of an eye in widths of the picture.
    pub eye_radii: Vec2,
    /// Height of the mouth, 0 to 1 from below.
    pub mouth_y: f32,
    /// Half the width of the mouth in widths of the picture.
    pub mouth_width: f32,
    /// Opening of the mouth, 0 to 1.
    pub mouth_open: f32,
    /// Strength of the blush on the cheeks, 0 to 1.
    pub blush: f32,
}

/// Paints a face from the front, for a head mapped by projection along its axis. Skin reaches the borders.
pub fn face(name: &str, size: u32, face: &Face) -> TextureImage {
    let s = size as f32;
    let mut canvas = Canvas::new([size; 2], face.skin.extend(1.0));
    let ink = face.brow.extend(1.0);
    let [rx, ry] = [face.eye_radii.x * s, face.eye_radii.y * s];
    for side in [-1.0, 1.0] {
        let at = |x: f32, y: f32| vec2(0.5 + side * (0.5 - x), 1.0 - y) * s;
        let eye = at(face.eye.x, face.eye.y);
        let out = |x: f32, y: f32| eye + vec2(side * x * rx, -y * ry);
        let cheek = at(face.eye.x - 0.03, face.eye.y - face.eye_radii.y * 1.7);
        for i in 0..8 {
            let r = 1.0 - i as f32 / 8.0;
            canvas.ellipse(
                cheek,
                vec2(rx * 0.95, rx * 0.6) * r,
                vec3(0.95, 0.45, 0.42).extend(face.blush * 0.09),
            );
        }
        canvas.ellipse(eye, vec2(rx, ry), vec3(0.97, 0.97, 0.98).extend(1.0));
        canvas.ellipse_within(
            eye + vec2(0.0, -ry * 0.75),
            vec2(rx, ry * 0.6),
            vec3(0.62, 0.62, 0.72).extend(0.5),
            (eye, vec2(rx, ry)),
        );
        let iris = vec2((rx * 0.72).min(ry * 0.86), ry * 0.86);
        let clip = (eye, vec2(rx, ry));
        canvas.ellipse_within(eye, iris, (face.iris * 0.35).extend(1.0), clip);
        canvas.ellipse_within(eye, iris * 0.9, face.iris.extend(1.0), clip);
        canvas.ellipse_within(
            eye + vec2(0.0, iris.y * 0.4),
            iris * vec2(0.7, 0.5),
            (face.iris * 1.4 + 0.08).extend(0.8),
            clip,
        );
        canvas.ellipse_within(
            eye + vec2(0.0, -iris.y * 0.35),
            iris * vec2(0.88, 0.55),
            (face.iris * 0.3).extend(0.55),
            clip,
        );
        canvas.ellipse(eye, iris * 0.42, vec3(0.04, 0.03, 0.06).extend(1.0));
        canvas.ellipse(eye + vec2(-0.35 * iris.x, -0.42 * iris.y), iris * 0.28, Vec4::ONE);
        canvas.ellipse(eye + vec2(0.36 * iris.x, 0.42 * iris.y), iris * 0.14, Vec4::ONE);
        // The upper lid is a thick arc that ends in a lash; the lower one is thin.
        let steps = 20;
        for i in 0..steps {
            let [a, b] = [i, i + 1].map(|i| {
                let t = i as f32 / steps as f32;
                let angle = (-0.05 + t * 1.1) * std::f32::consts::PI;
                out(-angle.cos() * 1.03, angle.sin() * 1.0)
            });
            let t = i as f32 / steps as f32;
            canvas.line(a, b, rx * (0.13 + 0.2 * t), ink);
            let [a, b] = [i, i + 1].map(|i| {
                let angle = (0.25 + i as f32 / steps as f32 * 0.6) * std::f32::consts::PI;
                out(-angle.cos() * 1.0, -angle.sin() * 1.0)
            });
            canvas.line(a, b, rx * 0.06, (face.skin * 0.6).extend(0.8));
        }
        canvas.line(out(0.96, 0.2), out(1.32, 0.42), rx * 0.17, ink);
        canvas.line(out(0.8, 0.7), out(1.15, 0.95), rx * 0.1, ink);
        for i in 0..10 {
            let [a, b] = [i, i + 1].map(|i| {
                let t = i as f32 / 10.0 * 2.0 - 1.0;
                out(t * 1.05, 1.62 - 0.28 * t * t)
            });
            canvas.line(a, b, rx * 0.17 * (1.0 - (i as f32 / 9.0 - 0.35).abs() * 0.7), ink);
        }
    }
    let nose = vec2(0.5, 1.0 - (face.eye.y * 0.45 + face.mouth_y * 0.55)) * s;
    canvas.line(
        nose + vec2(-0.006, 0.0) * s,
        nose + vec2(0.008, 0.004) * s,
        s * 0.007,
        (face.skin * 0.68).extend(0.9),
    );
    let mouth = vec2(0.5, 1.0 - face.mouth_y) * s;
    let w = face.mouth_width * s;
    let curve = |t: f32| mouth + vec2(t * w, -w * 0.28 * t * t);
    if face.mouth_open > 0.0 {
        let depth = w * 1.1 * face.mouth_open;
        canvas.ellipse(
            mouth + vec2(0.0, depth * 0.35),
            vec2(w * 0.72, depth),
            (face.lips * 0.55).extend(1.0),
        );
        canvas.ellipse_within(
            mouth + vec2(0.0, depth * 0.95),
            vec2(w * 0.5, depth * 0.5),
            vec3(0.9, 0.45, 0.45).extend(1.0),
            (mouth + vec2(0.0, depth * 0.35), vec2(w * 0.66, depth * 0.92)),
        );
        canvas.ellipse_within(
            mouth - vec2(0.0, depth * 0.5),
            vec2(w * 0.6, depth * 0.42),
            vec3(0.98, 0.97, 0.95).extend(1.0),
            (mouth + vec2(0.0, depth * 0.35), vec2(w * 0.66, depth * 0.92)),
        );
    } else {
        canvas.ellipse(mouth + vec2(0.0, w * 0.12), vec2(w * 0.45, w * 0.16), face.lips.extend(0.7));
        for i in 0..16 {
            let [a, b] = [i, i + 1].map(|i| curve(i as f32 / 8.0 - 1.0));
            canvas.line(a, b, s * 0.007, (face.lips * 0.6).extend(1.0));
        }
    }
    canvas.into_texture(name)
}

/// Paints the spines of books on one board, without gaps, all around the unit square in u. Titles are bars.
pub fn book_spines(name: &str, size: [u32; 2], seed: u32, count: u32) -> TextureImage {
    let palette = [
        vec3(0.55, 0.16, 0.14),
        vec3(0.16, 0.28, 0.45),
        vec3(0.2, 0.38, 0.24),
        vec3(0.8, 0.72, 0.55),
        vec3(0.3, 0.2, 0.32),
        vec3(0.75, 0.5, 0.2),
        vec3(0.2, 0.2, 0.22),
    ];
    picture(name, size, |uv| {
        let x = uv.x * count as f32;
        let book = x.floor() as u32;
        let id = hash_cell(seed, book, 0);
        let local = vec2(x - book as f32, uv.y);
        let base = shade(palette[id as usize % palette.len()], (unit(hash(id)) - 0.5) * 0.4);
        let round = 1.0 - 1.6 * (local.x - 0.5) * (local.x - 0.5);
        let band = (local.y - 0.85).abs() < 0.015 || (local.y - 0.15).abs() < 0.015;
        let title = (local.x - 0.5).abs() < 0.16
            && (0.35..0.7).contains(&local.y)
            && unit(hash_cell(id, (local.y * 60.0) as u32, 1)) > 0.3;
        let ink = vec3(0.88, 0.78, 0.5);
        let gap = smoothstep(0.0, 0.06, local.x.min(1.0 - local.x));
        ((if band || title { ink } else { base }) * round * (0.3 + 0.7 * gap)).extend(1.0)
    })
}

// A canvas for pictures that are drawn shape by shape.

/// A picture that is drawn shape by shape. Positions are in pixels from the upper left corner, y down; colours have
/// their opacity in w.
pub struct Canvas {
    size: [u32; 2],
    pixels: Vec<Vec4>,
}

impl Canvas {
    /// Creates a canvas of one colour.
    pub fn new(size: [u32; 2], color: Vec4) -> Canvas {
        Canvas { size, pixels: vec![color; (size[0] * size[1]) as usize] }
    }

    /// Paints where the signed distance in pixels is negative, with an anti-aliased edge, within a box.
    fn fill(&mut self, min: Vec2, max: Vec2, color: Vec4, distance: impl Fn(Vec2) -> f32) {
        let limit = vec2(self.size[0] as f32, self.size[1] as f32);
        let [min, max] = [(min - 1.0).clamp(Vec2::ZERO, limit), (max + 1.0).clamp(Vec2::ZERO, limit)];
        for y in min.y as u32..max.y.ceil() as u32 {
            for x in min.x as u32..max.x.ceil() as u32 {
                let cover = (0.5 - distance(vec2(x as f32 + 0.5, y as f32 + 0.5))).clamp(0.0, 1.0) * color.w;
                if cover > 0.0 {
                    let pixel = &mut self.pixels[(y * self.size[0] + x) as usize];
                    let rgb = pixel.truncate().lerp(color.truncate(), cover);
                    *pixel = rgb.extend(pixel.w + (1.0 - pixel.w) * cover);
                }
            }
        }
    }

    /// Draws a rectangle.
    pub fn rect(&mut self, min: Vec2, max: Vec2, color: Vec4) {
        self.rounded(min, max, 0.0, color);
    }

    /// Draws a rectangle with rounded corners.
    pub fn rounded(&mut self, min: Vec2, max: Vec2, radius: f32, color: Vec4) {
        let center = (min + max) * 0.5;
        let half = (max - min) * 0.5 - radius;
        self.fill(min, max, color, |p| {
            let q = (p - center).abs() - half;
            q.max(Vec2::ZERO).length() + q.max_element().min(0.0) - radius
        });
    }

    /// Draws an axis-aligned ellipse.
    pub fn ellipse(&mut self, center: Vec2, radii: Vec2, color: Vec4) {
        self.fill(center - radii, center + radii, color, |p| ellipse_distance(p - center, radii));
    }

    /// Draws the part of an ellipse inside another one, given by centre and radii.
    fn ellipse_within(&mut self, center: Vec2, radii: Vec2, color: Vec4, clip: (Vec2, Vec2)) {
        self.fill(center - radii, center + radii, color, |p| {
            ellipse_distance(p - center, radii).max(ellipse_distance(p - clip.0, clip.1))
        });
    }

    /// Draws a straight line with round ends.
    pub fn line(&mut self, a: Vec2, b: Vec2, width: f32, color: Vec4) {
        let r = Vec2::splat(width * 0.5);
        self.fill(a.min(b) - r, a.max(b) + r, color, |p| {
            let t = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-6)).clamp(0.0, 1.0);
            p.distance(a + (b - a) * t) - r.x
        });
    }

    /// Draws a pointed leaf from root to tip.
    pub fn leaf(&mut self, root: Vec2, tip: Vec2, half_width: f32, color: Vec4) {
        let length = root.distance(tip);
        let axis = (tip - root) / length.max(1e-3);
        let [min, max] = [root.min(tip) - half_width, root.max(tip) + half_width];
        self.fill(min, max, color, |p| {
            let along = (p - root).dot(axis) / length;
            let across = (p - root).perp_dot(axis).abs();
            let t = along.clamp(0.0, 1.0);
            let outside = (along - t).abs() * length;
            across - half_width * (std::f32::consts::PI * t.powf(0.8)).sin() + outside
        });
    }

    /// Draws one line of text, `height` pixels tall, with its upper left corner at `corner`. Letters without a glyph
    /// are left blank; lower case is drawn as upper case.
    pub fn text(&mut self, corner: Vec2, height: f32, text: &str, color: Vec4) {
        let unit = height / 7.0;
        for (i, letter) in text.chars().enumerate() {
            let origin = corner + vec2((i as f32 * 6.0 + 0.5) * unit, height - 0.5 * unit);
            let point = |pair: &[u8]| {
                origin + vec2(f32::from(pair[0] - b'0') * unit, -f32::from(pair[1] - b'0') * unit)
            };
            for stroke in glyph(letter.to_ascii_uppercase()).split(' ') {
                let points: Vec<Vec2> = stroke.as_bytes().chunks_exact(2).map(point).collect();
                for pair in points.windows(2) {
                    self.line(pair[0], pair[1], unit * 0.9, color);
                }
            }
        }
    }

    /// Returns the finished picture, sRGB.
    pub fn into_texture(self, name: &str) -> TextureImage {
        let rgba = self.pixels.into_iter().flat_map(to_bytes).collect();
        TextureImage { name: name.into(), size: self.size, rgba, srgb: true, nearest: false }
    }
}

/// Returns the signed distance to an ellipse about the origin. It is exact only on the outline, where it matters.
fn ellipse_distance(p: Vec2, radii: Vec2) -> f32 {
    let scaled = (p / radii).length();
    let gradient = (p / (radii * radii)).length() / scaled.max(1e-4);
    (scaled - 1.0) / gradient.max(1e-4)
}

/// Returns the width in pixels of a line of text `height` pixels tall.
pub fn text_width(height: f32, text: &str) -> f32 {
    (text.chars().count() as f32 * 6.0 - 1.0).max(0.0) * height / 7.0
}

/// Returns the strokes of a letter: pairs of digits are points on a grid 4 wide and 6 high from its lower left corner,
/// and a blank lifts the pen.
pub fn glyph(letter: char) -> &'static str {
    match letter {
        'A' => "0004264440 0242",
        'B' => "00063645443303 3342413000",
        'C' => "4536160501103041",
        'D' => "00062644422000",
        'E' => "46060040 0333",
        'F' => "460600 0333",
        'G' => "45361605011030414323",
        'H' => "0006 4046 0343",
        'I' => "2026 1636 1030",
        'J' => "4641301001",
        'K' => "0006 460340",
        'L' => "060040",
        'M' => "0006234640",
        'N' => "00064046",
        'O' => "100105163645413010",
        'P' => "00063645443303",
        'Q' => "100105163645413010 2240",
        'R' => "00063645443303 2340",
        'S' => "453616050413334241301001",
        'T' => "0646 2620",
        'U' => "060110304146",
        'V' => "062046",
        'W' => "0610243046",
        'X' => "0046 0640",
        'Y' => "062346 2320",
        'Z' => "06460040",
        '0' => "100105163645413010 0145",
        '1' => "152620 1030",
        '2' => "05163645440040",
        '3' => "0516364544334241301001 1333",
        '4' => "30360242",
        '5' => "460603334241301001",
        '6' => "36160501103041423303",
        '7' => "064610",
        '8' => "13334445361605041302011030414233",
        '9' => "10304145361605041343",
        '.' => "2020",
        ',' => "2110",
        ':' => "2121 2424",
        '-' => "1333",
        '+' => "1333 2224",
        '/' => "0046",
        '!' => "2622 2020",
        '?' => "05163645442322 2020",
        '\'' => "2625",
        '%' => "0046 0606 4040",
        '&' => "4015053605 00204200",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: Vec3 = Vec3::new(0.6, 0.4, 0.3);
    const B: Vec3 = Vec3::new(0.8, 0.8, 0.7);

    fn surfaces() -> Vec<Surface> {
        let s = 128;
        vec![
            bricks("bricks", s, 1, A, B, [4, 8]),
            stone_blocks("blocks", s, 2, A, [3, 6]),
            plaster("plaster", s, 4, A),
            concrete("concrete", s, 5, B),
            planks("planks", s, 6, A, 4),
            tiles("tiles", s, 7, [A, B], 4),
            marble("marble", s, 8, B, A),
            fabric("fabric", s, 9, A, 16),
            damask("damask", s, 10, A, B, 2),
            metal_panels("metal", s, 11, B, [2, 2]),
            grass("grass", s, 12, A),
            soil("soil", s, 13, A),
            bark("bark", s, 15, A),
            asphalt("asphalt", s, 16, A),
            roof_tiles("roof", s, 17, A, [4, 8]),
        ]
    }

    fn column_difference(image: &TextureImage, a: u32, b: u32) -> f32 {
        let [width, height] = image.size;
        let at = |x: u32, y: u32, c: u32| f32::from(image.rgba[((y * width + x) * 4 + c) as usize]);
        let sum: f32 = (0..height).flat_map(|y| (0..3).map(move |c| (at(a, y, c) - at(b, y, c)).abs())).sum();
        sum / (height * 3) as f32
    }

    fn row_difference(image: &TextureImage, a: u32, b: u32) -> f32 {
        let width = image.size[0] as usize * 4;
        let row = |y: u32| &image.rgba[y as usize * width..][..width];
        row(a).iter().zip(row(b)).map(|(&p, &q)| f32::from(p.abs_diff(q))).sum::<f32>() / width as f32
    }

    #[test]
    fn noise_repeats_and_stays_in_range() {
        let cells = UVec2::new(5, 7);
        for i in 0..200 {
            let p = vec2(unit(hash(i)), unit(hash(i + 1000)));
            let n = fbm(3, cells, 4, p);
            assert!((0.0..=1.0).contains(&n), "{n}");
            assert!((n - fbm(3, cells, 4, p + vec2(1.0, -2.0))).abs() < 1e-3);
            let [w, v] = [worley(3, cells, 1.0, p), worley(3, cells, 1.0, p - vec2(1.0, 1.0))];
            assert!((w.nearest - v.nearest).abs() < 1e-3 && w.nearest <= w.second);
        }
    }

    /// The step across the border must be no larger than the largest step inside.
    #[test]
    fn surfaces_have_no_seam() {
        for surface in surfaces() {
            for image in [&surface.color, &surface.normal] {
                let n = image.size[0];
                let inside = (0..n - 1).map(|x| column_difference(image, x, x + 1)).fold(0.0, f32::max);
                let border = column_difference(image, n - 1, 0);
                assert!(border <= inside * 1.25 + 1.0, "{}: u {border} > {inside}", image.name);
                let inside = (0..n - 1).map(|y| row_difference(image, y, y + 1)).fold(0.0, f32::max);
                let border = row_difference(image, n - 1, 0);
                assert!(border <= inside * 1.25 + 1.0, "{}: v {border} > {inside}", image.name);
            }
        }
    }

    #[test]
    fn pictures_repeat_bit_for_bit_and_follow_their_seed() {
        for (a, b) in surfaces().iter().zip(surfaces()) {
            assert_eq!(a.color, b.color);
            assert_eq!(a.normal, b.normal);
        }
        assert_ne!(plaster("p", 64, 1, A).color.rgba, plaster("p", 64, 2, A).color.rgba);
    }

    #[test]
    fn normals_are_unit_vectors_that_lean_away_from_a_ridge() {
        // A ridge along u: the height rises with v up to the middle, then falls.
        let size = [32, 32];
        let heights: Vec<f32> =
            (0..32 * 32).map(|i| (pixel_uv(size, i).y * std::f32::consts::PI).sin()).collect();
        let map = normal_map("ridge", size, 0.1, &heights);
        assert!(!map.srgb);
        let at = |x: usize, y: usize| {
            let p = &map.rgba[(y * 32 + x) * 4..][..3];
            vec3(p[0].into(), p[1].into(), p[2].into()) / 255.0 * 2.0 - 1.0
        };
        for y in 0..32 {
            assert!((at(3, y).length() - 1.0).abs() < 0.02);
        }
        // Row 0 is the top, where the ridge falls with increasing v, so the normal leans up.
        assert!(at(3, 4).y > 0.1, "{}", at(3, 4));
        assert!(at(3, 27).y < -0.1, "{}", at(3, 27));
        assert!(at(3, 16).x.abs() < 0.01);
    }

    #[test]
    fn leaves_are_cut_out_and_voxels_are_unfiltered() {
        let leaf = leaf_card("leaf", 128, 1, A);
        let solid = leaf.rgba.chunks_exact(4).filter(|p| p[3] > 127).count() as f32 / (128.0 * 128.0);
        assert!((0.2..0.8).contains(&solid), "{solid}");
        assert!(voxel("v", 1, Block::Stone).nearest);
    }

    #[test]
    fn lit_windows_glow_and_walls_do_not() {
        let share = |lit| {
            let facade = facade("f", 128, 1, A, B, [4, 4], lit);
            facade.emissive.rgba.chunks_exact(4).filter(|p| p[0] > 20).count() as f32 / (128.0 * 128.0)
        };
        assert_eq!(share(0.0), 0.0);
        assert!((0.2..0.6).contains(&share(1.0)), "{}", share(1.0));
    }

    #[test]
    fn every_letter_leaves_ink() {
        for letter in "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,:-+/!?'%&".chars() {
            let mut canvas = Canvas::new([24, 32], Vec4::ZERO);
            canvas.text(vec2(1.0, 1.0), 28.0, &letter.to_string(), Vec4::ONE);
            let ink = canvas.into_texture("t").rgba.chunks_exact(4).filter(|p| p[3] > 127).count();
            assert!(ink > 4, "{letter}");
        }
    }
}
