//! A voxel landscape with a ruined temple, a river with a bridge, a castle, woods and mountains. In place of the
//! paper's largest scene.
//!
//! Lengths are in voxels unless stated in metres. The voxel (0, 0, 0) starts at the origin, at sea level.

use std::f32::consts::TAU;

use glam::{IVec2, IVec3, Vec2, Vec3, ivec2, ivec3, vec2, vec3};
use rand::Rng;
use rand_pcg::Pcg32;
use rayon::prelude::*;

use super::build::{SceneBuilder, moved, random};
use super::paint::{self, Block, Plant, hash_cell, smoothstep, unit};
use yoro_assets::{Alpha, Material, Model, Part, PointLight, Scene, Sky, Vertex, Viewpoint};

/// Edge length of a voxel in metres.
const EDGE: f32 = 0.5;
/// Number of voxels along x and along z.
const SPAN: i32 = 640;
/// Number of voxels along y.
const HEIGHT: i32 = 128;
/// Number of voxels below sea level.
const DEPTH: i32 = 32;
/// Number of voxels along the side of a chunk, which is one object.
const CHUNK: i32 = 64;
const HALF: i32 = SPAN / 2;

const BLOCKS: [Block; 20] = [
    Block::GrassTop,
    Block::GrassSide,
    Block::Dirt,
    Block::Stone,
    Block::DarkStone,
    Block::Cobble,
    Block::StoneBrick,
    Block::MossyBrick,
    Block::Sand,
    Block::Sandstone,
    Block::Gravel,
    Block::LogSide,
    Block::LogTop,
    Block::Planks,
    Block::Leaves,
    Block::Blossom,
    Block::Snow,
    Block::Roof,
    Block::Gold,
    Block::Lantern,
];
/// The code of water; every other block's code is 1 + its index in [`BLOCKS`].
const WATER: u8 = BLOCKS.len() as u8 + 1;
const AIR: u8 = 0;

fn code(block: Block) -> u8 {
    BLOCKS.iter().position(|&b| b == block).map_or(WATER, |i| i as u8 + 1)
}

/// Returns the block shown on the top (+1), a side (0) or the bottom (-1) of a voxel.
fn face_of(voxel: u8, up: i32) -> u8 {
    match (BLOCKS[voxel as usize - 1], up) {
        (Block::GrassTop, 0) => code(Block::GrassSide),
        (Block::GrassTop, -1) => code(Block::Dirt),
        (Block::LogSide, 1 | -1) => code(Block::LogTop),
        _ => voxel,
    }
}

struct World {
    /// Column by column (x, then z), each from the bottom up.
    voxels: Vec<u8>,
    seed: u32,
}

impl World {
    fn index(p: IVec3) -> Option<usize> {
        let q = p + ivec3(HALF, DEPTH, HALF);
        let inside = q.cmpge(IVec3::ZERO).all() && q.cmplt(ivec3(SPAN, HEIGHT, SPAN)).all();
        inside.then(|| ((q.x * SPAN + q.z) * HEIGHT + q.y) as usize)
    }

    fn get(&self, p: IVec3) -> u8 {
        World::index(p).map_or(AIR, |i| self.voxels[i])
    }

    fn put(&mut self, p: IVec3, voxel: u8) {
        if let Some(i) = World::index(p) {
            self.voxels[i] = voxel;
        }
    }

    fn set(&mut self, p: IVec3, block: Block) {
        self.put(p, code(block));
    }

    /// Fills a box, both corners included, with the blocks that the closure returns; `None` leaves a voxel as it is.
    fn fill_with(&mut self, min: IVec3, max: IVec3, mut block: impl FnMut(IVec3) -> Option<Block>) {
        for x in min.x..=max.x {
            for z in min.z..=max.z {
                for y in min.y..=max.y {
                    if let Some(block) = block(ivec3(x, y, z)) {
                        self.set(ivec3(x, y, z), block);
                    }
                }
            }
        }
    }

    fn fill(&mut self, min: IVec3, max: IVec3, block: Block) {
        self.fill_with(min, max, |_| Some(block));
    }

    fn clear(&mut self, min: IVec3, max: IVec3) {
        for x in min.x..=max.x {
            for z in min.z..=max.z {
                for y in min.y..=max.y {
                    self.put(ivec3(x, y, z), AIR);
                }
            }
        }
    }

    /// Returns the highest solid voxel of a column.
    fn top(&self, x: i32, z: i32) -> i32 {
        (-DEPTH..HEIGHT - DEPTH)
            .rev()
            .find(|&y| !matches!(self.get(ivec3(x, y, z)), AIR | WATER))
            .unwrap_or(-DEPTH)
    }

    /// Returns the highest voxel of a column to stand on, ignoring trees.
    fn walkable_top(&self, x: i32, z: i32) -> i32 {
        let tree = [Block::Leaves, Block::Blossom, Block::LogSide].map(code);
        (-DEPTH..self.top(x, z) + 1)
            .rev()
            .find(|&y| {
                let voxel = self.get(ivec3(x, y, z));
                !matches!(voxel, AIR | WATER) && !tree.contains(&voxel)
            })
            .unwrap_or(-DEPTH)
    }

    fn chance(&self, p: IVec3, purpose: u32) -> f32 {
        unit(hash_cell(hash_cell(self.seed, purpose, p.y as u32), p.x as u32, p.z as u32))
    }

    /// Returns smooth noise in space, 0 to 1, with features of `scale` voxels.
    fn noise(&self, p: IVec3, scale: f32, purpose: u32) -> f32 {
        let q = p.as_vec3() / scale;
        let cell = q.floor();
        let f = q - cell;
        let f = f * f * (3.0 - 2.0 * f);
        let at = |dx: f32, dy: f32, dz: f32| self.chance((cell + vec3(dx, dy, dz)).as_ivec3(), purpose);
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let plane = |dz: f32| {
            let low = mix(at(0.0, 0.0, dz), at(1.0, 0.0, dz), f.x);
            mix(low, mix(at(0.0, 1.0, dz), at(1.0, 1.0, dz), f.x), f.y)
        };
        mix(plane(0.0), plane(1.0), f.z)
    }

    /// Returns hewn stone, weathered by centuries.
    fn old_brick(&self, p: IVec3) -> Block {
        let n = self.noise(p, 5.0, 3) + 0.25 * (self.chance(p, 4) - 0.5);
        if n > 0.62 {
            Block::MossyBrick
        } else if n < 0.28 {
            Block::Cobble
        } else {
            Block::StoneBrick
        }
    }
}

/// Returns the middle of the river at this x.
fn river_z(x: f32) -> f32 {
    28.0 + 12.0 * (x * 0.02).sin() + 5.0 * (x * 0.051).sin()
}

/// Returns the distance to a rectangle, 0 inside.
fn outside(p: Vec2, min: Vec2, max: Vec2) -> f32 {
    (min - p).max(p - max).max(Vec2::ZERO).length()
}

const CASTLE: IVec2 = ivec2(-118, -128);
const CASTLE_GROUND: i32 = 30;
const TERRACE: i32 = 8;

/// Returns the height of the ground: the first voxel of air above it.
fn ground(seed: u32, x: i32, z: i32) -> f32 {
    let p = vec2(x as f32, z as f32);
    let uv = p / SPAN as f32 + 0.5;
    let cells = |n| glam::UVec2::splat(n);
    let hills = paint::fbm(seed, cells(9), 4, uv);
    let detail = paint::fbm(seed + 20, cells(28), 2, uv);
    let mut h = 5.0 + 16.0 * (hills - 0.42) + 2.0 * (detail - 0.5);
    // Mountains close the view on all sides, with terraced cliffs.
    let rim = p.length() / HALF as f32;
    let ridge = 1.0 - (paint::fbm(seed + 40, cells(7), 5, uv) - 0.5).abs() * 3.2;
    let rise = smoothstep(0.42, 1.05, rim) * (26.0 + 62.0 * ridge.clamp(0.0, 1.0));
    let step = (rise / 9.0).floor() * 9.0 + smoothstep(0.55, 1.0, (rise / 9.0).fract()) * 9.0;
    h += rise * 0.35 + step * 0.65;
    let blend = |h: f32, level: f32, distance: f32, width: f32| {
        level + (h - level) * smoothstep(0.0, width, distance)
    };
    h = blend(h, CASTLE_GROUND as f32 + 0.5, ((p - CASTLE.as_vec2()).length() - 46.0).max(0.0), 34.0);
    h = blend(h, TERRACE as f32 + 0.5, outside(p, vec2(-44.0, -130.0), vec2(44.0, 8.0)), 16.0);
    h = blend(h, 7.5, outside(p, vec2(-26.0, 46.0), vec2(58.0, 96.0)), 22.0);
    let bank = (p.y - river_z(p.x)).abs();
    let bed = -5.0 + 2.0 * detail;
    bed + (h - bed) * smoothstep(9.0, 17.0, bank + 4.0 * (detail - 0.5))
}

fn terrain(seed: u32) -> World {
    let mut voxels = vec![AIR; (SPAN * SPAN * HEIGHT) as usize];
    let [water, stone, dark] = [WATER, code(Block::Stone), code(Block::DarkStone)];
    voxels.par_chunks_exact_mut(HEIGHT as usize).enumerate().for_each(|(i, column)| {
        let (x, z) = (i as i32 / SPAN - HALF, i as i32 % SPAN - HALF);
        let h = ground(seed, x, z);
        let slope = (ground(seed, x + 2, z) - h).abs().max((ground(seed, x, z + 2) - h).abs());
        let top = (h.floor() as i32).min(HEIGHT - DEPTH - 2);
        let speck = unit(hash_cell(seed, x as u32, z as u32));
        for (j, voxel) in column.iter_mut().enumerate() {
            let y = j as i32 - DEPTH;
            let below = top - 1 - y;
            *voxel = if below < 0 {
                if y < 0 { water } else { AIR }
            } else if top <= 2 && below < 3 {
                code(if speck < 0.2 { Block::Gravel } else { Block::Sand })
            } else if slope > 2.6 || below > 4 {
                let layer = (y as f32 + 3.0 * speck + 0.08 * x as f32).rem_euclid(17.0);
                if layer < 5.0 { dark } else { stone }
            } else if h + 6.0 * speck > 74.0 {
                code(Block::Snow)
            } else if below == 0 {
                code(if speck < 0.01 { Block::Cobble } else { Block::GrassTop })
            } else {
                code(Block::Dirt)
            };
        }
    });
    World { voxels, seed }
}

fn column(w: &mut World, base: IVec3, height: i32, whole: bool) {
    w.fill_with(base - ivec3(2, 0, 2), base + ivec3(2, 1, 2), |_| Some(Block::Sandstone));
    for y in 2..height {
        let wear = w.chance(base + IVec3::Y * y, 9);
        if !whole && y > height - 3 && wear < 0.4 {
            continue;
        }
        for (dx, dz) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dz| (dx, dz))) {
            let p = base + ivec3(dx, y, dz);
            let chipped = dx * dz != 0 && w.chance(p, 10) < if whole { 0.1 } else { 0.35 };
            if !chipped {
                let block = if w.noise(p, 4.0, 11) > 0.68 { Block::MossyBrick } else { Block::Sandstone };
                w.set(p, block);
            }
        }
    }
    if whole {
        w.fill(base + ivec3(-2, height, -2), base + ivec3(2, height + 1, 2), Block::Sandstone);
    }
}

fn temple(w: &mut World, rng: &mut Pcg32) {
    // The platform has four steps.
    for step in 0..4 {
        let grow = 4 - step;
        let y = TERRACE + step;
        let (min, max) = (ivec3(-30 - grow, y, -96 - grow), ivec3(30 + grow, y, -14 + grow));
        let bricks: Vec<_> = (min.x..=max.x).flat_map(|x| (min.z..=max.z).map(move |z| (x, z))).collect();
        for (x, z) in bricks {
            let p = ivec3(x, y, z);
            let lost = w.noise(p, 6.0, 5) > 0.8 && (x.abs() > 8 || z < -20) && z < -12;
            let block = if step == 3 && (x / 4 + z / 4) % 2 == 0 { Block::Sandstone } else { w.old_brick(p) };
            if !lost || step < 3 {
                w.set(p, block);
            }
        }
    }
    let floor = TERRACE + 4;
    let height = 17;
    let mut standing = Vec::new();
    for z in (0..10).map(|i| -20 - 8 * i) {
        for x in [-26, -18, 18, 26] {
            let whole = rng.random::<f32>() < 0.68;
            let h = if whole { height } else { rng.random_range(4..height - 3) };
            column(w, ivec3(x, floor, z), h, whole);
            if whole {
                standing.push(ivec2(x, z));
            } else {
                rubble(w, rng, ivec3(x, floor, z), 5);
            }
        }
    }
    for x in [-10, 10] {
        column(w, ivec3(x, floor, -20), height, true);
        standing.push(ivec2(x, -20));
    }
    // The entablature is left only where columns still carry it.
    let top = floor + height + 2;
    for &p in &standing {
        for (step, reach) in [(ivec2(0, -8), 8), (ivec2(8, 0), 8)] {
            if standing.contains(&(p + step)) {
                for i in -2..=reach + 2 {
                    let at = p + step / 8 * i;
                    let across = ivec2(step.y / 8, step.x / 8);
                    for k in -2..=2 {
                        let q = at + across * k;
                        for y in 0..4 {
                            let cell = ivec3(q.x, top + y, q.y);
                            if w.noise(cell, 5.0, 12) < 0.74 && (y < 3 || (q.x + q.y) % 4 < 2) {
                                w.set(cell, if y == 1 { Block::Sandstone } else { Block::StoneBrick });
                            }
                        }
                    }
                }
            }
        }
    }
    // The sanctum, with half of its roof fallen in.
    let (min, max) = (ivec3(-12, floor, -86), ivec3(12, floor + 20, -42));
    let w_read = World { voxels: Vec::new(), seed: w.seed };
    w.fill_with(min, max, |p| {
        let shell = p.x <= min.x + 1 || p.x >= max.x - 1 || p.z <= min.z + 1 || p.z >= max.z - 1;
        let roof = p.y >= max.y - 1;
        let door = p.z >= max.z - 1 && p.x.abs() <= 3 && p.y < floor + 11;
        let window = p.x.abs() >= 11 && (p.z.rem_euclid(10)) < 2 && (floor + 8..floor + 13).contains(&p.y);
        let eroded = w_read.noise(p, 9.0, 13) + (p.y - floor) as f32 * 0.012 > 0.82;
        let hole = roof && w_read.noise(p, 12.0, 14) > 0.48;
        ((shell || roof) && !door && !window && !eroded && !hole)
            .then(|| if p.y == floor + 14 || p.y == floor { Block::Sandstone } else { w_read.old_brick(p) })
    });
    w.fill(ivec3(-4, floor, -80), ivec3(4, floor, -74), Block::Sandstone);
    w.fill(ivec3(-2, floor + 1, -78), ivec3(2, floor + 2, -76), Block::Gold);
    for x in [-4, 4] {
        w.fill(ivec3(x, floor + 1, -80), ivec3(x, floor + 4, -80), Block::StoneBrick);
        w.set(ivec3(x, floor + 5, -80), Block::Lantern);
    }
    // The door's lintel and two guardian stones.
    w.fill(ivec3(-5, floor + 11, -41), ivec3(5, floor + 12, -41), Block::Sandstone);
    for x in [-9, 9] {
        w.fill(ivec3(x - 2, floor, -34), ivec3(x + 2, floor + 1, -30), Block::StoneBrick);
        w.fill(ivec3(x - 1, floor + 2, -33), ivec3(x + 1, floor + 6, -31), Block::DarkStone);
        w.fill(ivec3(x - 1, floor + 7, -33), ivec3(x + 1, floor + 9, -30), Block::Stone);
        w.fill(ivec3(x - 1, floor + 8, -30), ivec3(x + 1, floor + 8, -30), Block::Gold);
    }
    for _ in 0..26 {
        let (x, z) = (rng.random_range(-28..=28), rng.random_range(-90..=-38));
        if !(-13..=13).contains(&x) {
            rubble(w, rng, ivec3(x, floor, z), 3);
        }
    }
}

fn rubble(w: &mut World, rng: &mut Pcg32, center: IVec3, spread: i32) {
    for _ in 0..spread * 4 {
        let d = ivec2(rng.random_range(-spread..=spread), rng.random_range(-spread..=spread));
        let p = center + ivec3(d.x, 0, d.y);
        if w.get(p) == AIR && w.get(p - IVec3::Y) != AIR && p.x.abs() > 7 {
            w.set(p, if rng.random() { Block::Cobble } else { Block::Sandstone });
        }
    }
}

/// Returns the height of the bridge's deck: the first voxel of air above it.
fn deck(z: i32) -> i32 {
    let t = (z - 28) as f32 / 20.0;
    TERRACE + (3.2 * (1.0 - t * t)).max(0.0).round() as i32
}

fn bridge(w: &mut World) {
    for z in 6..=50 {
        let top = deck(z);
        for x in -5..=5 {
            let under = [17, 39].iter().map(|&pier: &i32| (z - pier).abs()).min().unwrap_or(0);
            let arch = if (z - 28).abs() <= 9 {
                let t = (z - 28) as f32 / 9.0;
                (-1.0 + 7.0 * (1.0 - t * t).max(0.0).sqrt()) as i32
            } else if under <= 2 {
                -8
            } else {
                2
            };
            for y in arch..top {
                let p = ivec3(x, y, z);
                w.set(p, if y == top - 1 && x.abs() < 4 { Block::Cobble } else { w.old_brick(p) });
            }
            w.clear(ivec3(x, top, z), ivec3(x, top + 6, z));
        }
        for x in [-5, 5] {
            let p = ivec3(x, top, z);
            if w.noise(p, 4.0, 15) < 0.78 {
                w.set(p, w.old_brick(p));
                if z % 8 < 2 {
                    w.set(p + IVec3::Y, Block::StoneBrick);
                }
            }
        }
    }
    for z in -9..=96 {
        for x in -3..=3 {
            let outside_bridge = !(6..=50).contains(&z);
            let path_x = x + path_bend(z);
            if outside_bridge && w.chance(ivec3(path_x, 0, z), 16) < 0.85 {
                let top = w.top(path_x, z);
                w.set(
                    ivec3(path_x, top, z),
                    if w.chance(ivec3(x, 1, z), 17) < 0.3 { Block::Gravel } else { Block::Cobble },
                );
            }
        }
    }
}

/// Returns the distance of the path on the near bank from the bridge's axis.
fn path_bend(z: i32) -> i32 {
    let t = ((z - 50) as f32 / 40.0).max(0.0);
    (9.0 * t * t).round() as i32
}

fn round_tower(w: &mut World, base: IVec3, radius: i32, height: i32, roof: bool) {
    let r2 = (radius * radius) as f32 + radius as f32 * 0.8;
    for (dx, dz) in (-radius - 1..=radius + 1).flat_map(|x| (-radius - 1..=radius + 1).map(move |z| (x, z))) {
        let d = (dx * dx + dz * dz) as f32;
        let rim = (radius + 1).pow(2) as f32 + radius as f32 * 0.8;
        for y in -8..height {
            let p = base + ivec3(dx, y, dz);
            let slit = y > 4 && y % 12 < 4 && (dx == 0 || dz == 0);
            if d <= r2 && d > r2 * 0.55 && !slit || (d <= r2 && y % 12 == 0) {
                w.set(p, w.old_brick(p));
            }
        }
        if d <= rim {
            for y in height..height + 3 {
                let crenel = y == height + 2 && (dx + dz).rem_euclid(4) < 2;
                if y == height || d > r2 * 0.6 && !crenel {
                    w.set(base + ivec3(dx, y, dz), Block::StoneBrick);
                }
            }
        }
        if roof {
            let steep = 2 * (radius + 1) - (2.0 * d.sqrt()) as i32;
            for y in 0..steep.max(0) {
                w.set(base + ivec3(dx, height + 3 + y, dz), Block::Roof);
            }
        }
    }
}

fn castle(w: &mut World) {
    let c = ivec3(CASTLE.x, CASTLE_GROUND, CASTLE.y);
    let half = 34;
    let seed = World { voxels: Vec::new(), seed: w.seed };
    w.fill_with(c + ivec3(-half, -6, -half), c + ivec3(half, 14, half), |p| {
        let q = (p - c).abs();
        let wall = q.x.max(q.z);
        let gate = (p.x - c.x).abs() <= 4 && p.z > c.z && p.y < c.y + 9 && p.y >= c.y;
        let crenel = p.y > c.y + 12 && (wall < half || (p.x + p.z).rem_euclid(4) < 2);
        let torn = p.y > c.y + 3 && seed.noise(p, 14.0, 18) > 0.72;
        (wall > half - 4 && !gate && !crenel && !torn).then(|| seed.old_brick(p))
    });
    for (x, z) in [(-half, -half), (half, -half), (-half, half), (half, half)] {
        round_tower(w, c + ivec3(x, 0, z), 8, 24, (x, z) != (half, half));
    }
    // The keep.
    w.fill_with(c + ivec3(-14, -4, -22), c + ivec3(14, 36, 4), |p| {
        let q = p - c - ivec3(0, 0, -9);
        let shell = q.x.abs() >= 12 || q.z.abs() >= 11 || q.y % 12 == 0;
        let window = q.y % 12 > 4 && q.y % 12 < 9 && (q.x.rem_euclid(8) < 2 || q.z.rem_euclid(8) < 2);
        let crenel = q.y == 36 && (p.x + p.z).rem_euclid(4) < 2;
        (shell && !window && !crenel).then(|| seed.old_brick(p))
    });
    for (x, z) in [(-14, -22), (14, -22), (-14, 4), (14, 4)] {
        round_tower(w, c + ivec3(x, 0, z), 4, 42, true);
    }
}

fn pyramid(w: &mut World) {
    let center = ivec2(40, -190);
    let base = ground(w.seed, center.x, center.y) as i32 - 6;
    let seed = World { voxels: Vec::new(), seed: w.seed };
    for tier in 0..9 {
        let half = 50 - tier * 5;
        let y = base + tier * 5;
        w.fill_with(
            ivec3(center.x - half, y, center.y - half),
            ivec3(center.x + half, y + 4, center.y + half),
            |p| {
                let edge = half - (p.x - center.x).abs().max((p.z - center.y).abs());
                let stairs = (p.x - center.x).abs() < 5;
                // Each tier is only a shell, since its inside cannot be seen.
                let bitten = edge < 3 && seed.noise(p, 8.0, 19) > 0.75 && !stairs;
                (edge < 8 && !bitten).then(|| if p.y == y + 4 { Block::Sandstone } else { seed.old_brick(p) })
            },
        );
        for step in 0..5 {
            let z = center.y + half + 5 - step;
            w.fill(ivec3(center.x - 5, y, z), ivec3(center.x + 5, y + step, z), Block::Sandstone);
        }
    }
    let top = base + 45;
    for (x, z) in [(-7, -7), (7, -7), (-7, 7), (7, 7)] {
        w.fill(
            ivec3(center.x + x, top, center.y + z),
            ivec3(center.x + x + 1, top + 8, center.y + z + 1),
            Block::StoneBrick,
        );
    }
    w.fill(
        ivec3(center.x - 9, top + 9, center.y - 9),
        ivec3(center.x + 10, top + 10, center.y + 10),
        Block::Gold,
    );
}

fn house(w: &mut World, corner: IVec2, size: IVec2, door_west: bool) {
    let floor = (0..size.x)
        .flat_map(|x| (0..size.y).map(move |z| (x, z)))
        .map(|(x, z)| w.top(corner.x + x, corner.y + z))
        .max()
        .unwrap_or(0)
        + 1;
    let at = |x: i32, y: i32, z: i32| ivec3(corner.x + x, floor + y, corner.y + z);
    w.fill(at(0, -6, 0), at(size.x, 0, size.y), Block::Cobble);
    for y in 1..=9 {
        for (x, z) in (0..=size.x).flat_map(|x| (0..=size.y).map(move |z| (x, z))) {
            let wall = x == 0 || z == 0 || x == size.x || z == size.y;
            let corner_post = (x == 0 || x == size.x) && (z == 0 || z == size.y);
            let window = (4..=6).contains(&y)
                && ((x + 3) % 6 < 2 && x > 1 && x < size.x - 1 || (z + 3) % 6 < 2 && z > 1 && z < size.y - 1);
            let door_x = if door_west { 0 } else { size.x };
            let door = x == door_x && (z - size.y / 2).abs() <= 1 && y < 6;
            if !wall || window || door {
                w.put(at(x, y, z), AIR);
            } else if corner_post {
                w.set(at(x, y, z), Block::LogSide);
            } else {
                w.set(at(x, y, z), if y < 4 { Block::Cobble } else { Block::Planks });
            }
        }
    }
    // A gable roof with eaves, whose ridge runs along z.
    for i in -1..=size.x / 2 {
        for z in -1..=size.y + 1 {
            for x in [i, size.x - i] {
                w.set(at(x, 10 + i, z), Block::Roof);
                w.set(
                    at(x, 9 + i, z),
                    if (0..=size.y).contains(&z) && (z == 0 || z == size.y) {
                        Block::Planks
                    } else {
                        Block::Roof
                    },
                );
            }
        }
        for z in [0, size.y] {
            for x in i.max(0)..=size.x - i.max(0) {
                w.set(at(x, 9 + i, z), Block::Planks);
            }
        }
    }
    w.fill(at(3, 10, 2), at(4, 14 + size.x / 2, 3), Block::Cobble);
    w.set(at(size.x / 2, 9, size.y / 2), Block::Lantern);
}

/// Digs a winding tunnel into the rock, lit by lamps.
fn cave(w: &mut World, rng: &mut Pcg32, mouth: Vec3, mut heading: f32, length: usize) {
    let mut p = mouth;
    for step in 0..length {
        heading += (rng.random::<f32>() - 0.5) * 0.5;
        p += vec3(heading.cos(), -0.06, heading.sin()) * 1.5;
        let radius = 4.0 + 1.2 * (step as f32 * 0.3).sin();
        let r = radius.ceil() as i32;
        let c = p.as_ivec3();
        for (dx, dy, dz) in
            (-r..=r).flat_map(|x| (-r..=r).flat_map(move |y| (-r..=r).map(move |z| (x, y, z))))
        {
            let d = vec3(dx as f32, dy as f32 * 1.15, dz as f32).length();
            let q = c + ivec3(dx, dy, dz);
            if d <= radius && w.get(q) != WATER && q.y > 2 {
                w.put(q, AIR);
            }
        }
        if step % 12 == 8 {
            let side = c + ivec3((heading.sin() * radius) as i32, 1, (-heading.cos() * radius) as i32);
            w.set(side, Block::Lantern);
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Tree {
    Oak,
    Pine,
    Blossom,
}

fn tree(w: &mut World, rng: &mut Pcg32, root: IVec3, kind: Tree) {
    let leaf = if kind == Tree::Blossom { Block::Blossom } else { Block::Leaves };
    let crown = |w: &mut World, center: Vec3, radii: Vec3| {
        let r = radii.ceil().as_ivec3();
        for (x, y, z) in
            (-r.x..=r.x).flat_map(|x| (-r.y..=r.y).flat_map(move |y| (-r.z..=r.z).map(move |z| (x, y, z))))
        {
            let p = center.floor().as_ivec3() + ivec3(x, y, z);
            let d = (ivec3(x, y, z).as_vec3() / radii).length();
            if d < 1.0 && d > 0.45 && w.chance(p, 30) > 0.2 + 0.5 * smoothstep(0.7, 1.0, d) && w.get(p) == AIR
            {
                w.set(p, leaf);
            }
        }
    };
    match kind {
        Tree::Pine => {
            let height = rng.random_range(16..26);
            for layer in 0..(height - 5) / 3 {
                let y = 5 + layer * 3;
                let r = 1.2 + 0.30 * (height - y) as f32;
                crown(w, (root + IVec3::Y * y).as_vec3() + vec3(0.0, 0.5, 0.0), vec3(r, 2.0, r));
            }
            crown(w, (root + IVec3::Y * (height - 1)).as_vec3(), vec3(1.5, 2.6, 1.5));
            w.fill(root - IVec3::Y * 2, root + IVec3::Y * (height - 2), Block::LogSide);
        }
        Tree::Oak | Tree::Blossom => {
            let height = rng.random_range(9..15);
            let top = root.as_vec3() + vec3(1.0, height as f32, 1.0);
            let r = rng.random_range(5.0..7.2);
            crown(w, top, vec3(r, r * 0.75, r));
            for _ in 0..3 {
                let turn = rng.random::<f32>() * TAU;
                let out = vec3(turn.cos(), -0.25, turn.sin()) * r * 0.75;
                crown(w, top + out, vec3(0.6, 0.5, 0.6) * r);
                for i in 0..6 {
                    w.set((top + out * (i as f32 / 6.0) - Vec3::Y).as_ivec3(), Block::LogSide);
                }
            }
            w.fill(root - IVec3::Y * 2, root + ivec3(1, height, 1), Block::LogSide);
        }
    }
}

/// True if plants must leave this place free.
fn is_kept_free(x: i32, z: i32, margin: i32) -> bool {
    let p = vec2(x as f32, z as f32);
    let m = margin as f32;
    let near_path = z > -14 && z < 100 && (x - path_bend(z)).abs() < 5 + margin;
    near_path
        || outside(p, vec2(-34.0, -100.0), vec2(34.0, -10.0)) < m
        || outside(p, vec2(14.0, 56.0), vec2(56.0, 92.0)) < m * 0.6
        || (p - CASTLE.as_vec2()).abs().max_element() < 36.0 + 2.0 * m
        || (p - vec2(40.0, -190.0)).abs().max_element() < 50.0 + m
}

fn woods(w: &mut World, rng: &mut Pcg32) {
    let mut placed = 0;
    for _ in 0..40_000 {
        if placed == TREES {
            break;
        }
        // Every other tree is where the walk can see it.
        let reach = if placed % 2 == 0 { 130 } else { HALF - 10 };
        let (x, z) = (rng.random_range(-reach..reach), rng.random_range(-reach..reach));
        let density = w.noise(ivec3(x, 0, z), 34.0, 31);
        let y = w.top(x, z);
        let grows = [Block::GrassTop, Block::Dirt].map(code).contains(&w.get(ivec3(x, y, z)));
        if density < 0.38 || !grows || is_kept_free(x, z, 5) || y > 66 {
            continue;
        }
        let kind = if y > 24 || w.noise(ivec3(x, 0, z), 50.0, 32) > 0.6 {
            Tree::Pine
        } else if rng.random::<f32>() < 0.2 {
            Tree::Blossom
        } else {
            Tree::Oak
        };
        tree(w, rng, ivec3(x, y + 1, z), kind);
        placed += 1;
    }
}

/// Number of trees, chosen to reach the scene's number of triangles.
const TREES: usize = 380;

struct Mesh {
    vertices: Vec<Vertex>,
    /// One list for each block, water last.
    indices: Vec<Vec<u32>>,
}

struct Direction {
    step: IVec3,
    /// Corners of the face in the unit cube, counter-clockwise from the lower left.
    corners: [IVec3; 4],
    right: Vec3,
    up: Vec3,
}

fn directions() -> [Direction; 6] {
    let face = |step: IVec3, right: IVec3, up: IVec3| {
        let origin = (step + IVec3::ONE) / 2 + (-right.min(IVec3::ZERO)) + (-up.min(IVec3::ZERO));
        // Sets the face's own axis to 0 or 1, and keeps the others within the unit cube.
        let origin = origin.min(IVec3::ONE) * (IVec3::ONE - step.abs()) + step.max(IVec3::ZERO);
        Direction {
            step,
            corners: [origin, origin + right, origin + right + up, origin + up],
            right: right.as_vec3(),
            up: up.as_vec3(),
        }
    };
    [
        face(IVec3::X, IVec3::NEG_Z, IVec3::Y),
        face(IVec3::NEG_X, IVec3::Z, IVec3::Y),
        face(IVec3::Y, IVec3::X, IVec3::NEG_Z),
        face(IVec3::NEG_Y, IVec3::X, IVec3::Z),
        face(IVec3::Z, IVec3::X, IVec3::Y),
        face(IVec3::NEG_Z, IVec3::NEG_X, IVec3::Y),
    ]
}

/// Returns the exposed faces of one chunk. Neighbouring faces in one plane and of one block share their vertices.
fn mesh_chunk(w: &World, chunk: IVec2, directions: &[Direction; 6]) -> Mesh {
    let low = ivec3(chunk.x * CHUNK - HALF, -DEPTH, chunk.y * CHUNK - HALF);
    let mut mesh = Mesh { vertices: Vec::new(), indices: vec![Vec::new(); BLOCKS.len() + 1] };
    let [row, layer] = [CHUNK + 1, (CHUNK + 1) * (CHUNK + 1)];
    let corner_count = (layer * (HEIGHT + 1)) as usize;
    let mut shared = vec![u32::MAX; corner_count * 6];
    let mut owner: Vec<u8> = Vec::new();
    let strides = directions.each_ref().map(|d| ((d.step.x * SPAN + d.step.z) * HEIGHT + d.step.y) as isize);
    for (x, z) in (0..CHUNK).flat_map(|x| (0..CHUNK).map(move |z| (x, z))) {
        let (wx, wz) = (low.x + x + HALF, low.z + z + HALF);
        let base = ((wx * SPAN + wz) * HEIGHT) as usize;
        let inside = [wx + 1 < SPAN, wx > 0, true, true, wz + 1 < SPAN, wz > 0];
        for y in 0..HEIGHT {
            let voxel = w.voxels[base + y as usize];
            if voxel == AIR {
                continue;
            }
            for (d, direction) in directions.iter().enumerate() {
                // The outside of the world is visible only from above.
                let beyond = if inside[d] && (0..HEIGHT).contains(&(y + direction.step.y)) {
                    w.voxels[(base as isize + y as isize + strides[d]) as usize]
                } else {
                    continue;
                };
                let is_exposed = match voxel {
                    WATER => beyond == AIR && d == 2,
                    _ => beyond == AIR || beyond == WATER,
                };
                if !is_exposed {
                    continue;
                }
                let face = if voxel == WATER { WATER } else { face_of(voxel, direction.step.y) };
                let ids = direction.corners.map(|corner| {
                    let c = ivec3(x, y, z) + corner;
                    let slot = &mut shared[d * corner_count + (c.y * layer + c.x * row + c.z) as usize];
                    if *slot == u32::MAX || owner[*slot as usize] != face {
                        *slot = mesh.vertices.len() as u32;
                        owner.push(face);
                        let at = (low + c).as_vec3();
                        // A water surface is a little below the edge of its voxel.
                        let sunk = if voxel == WATER { 0.12 } else { 0.0 };
                        mesh.vertices.push(Vertex {
                            position: at * EDGE - Vec3::Y * sunk,
                            normal: direction.step.as_vec3(),
                            uv: vec2(at.dot(direction.right), at.dot(direction.up)),
                        });
                    }
                    *slot
                });
                let [a, b, c, e] = ids;
                mesh.indices[face as usize - 1].extend_from_slice(&[a, b, c, a, c, e]);
            }
        }
    }
    mesh
}

/// Adds a row of chunks.
fn add_chunks(model: &mut Model, world: &World, materials: &[usize], row: i32) {
    let directions = directions();
    let meshes: Vec<(IVec2, Mesh)> = (0..SPAN / CHUNK)
        .into_par_iter()
        .map(|i| {
            let chunk = ivec2(row, i);
            (chunk, mesh_chunk(world, chunk, &directions))
        })
        .collect();
    for (chunk, mesh) in meshes {
        let base = model.vertices.len() as u32;
        model.vertices.extend_from_slice(&mesh.vertices);
        for (list, &material) in mesh.indices.iter().zip(materials).filter(|(list, _)| !list.is_empty()) {
            let start = model.indices.len();
            model.indices.extend(list.iter().map(|i| base + i));
            let name = format!("chunk-{}-{}", chunk.x, chunk.y);
            model.parts.push(Part { name, material, indices: start..model.indices.len() });
        }
    }
}

/// Builds crossed cards on the grass near the path, and vines on the ruins.
fn plants(s: &mut SceneBuilder, w: &World, rng: &mut Pcg32, seed: u32) {
    let kinds = [Plant::Grass, Plant::Poppy, Plant::Buttercup, Plant::Fern, Plant::Vine];
    let materials = kinds.map(|plant| {
        let name = format!("{plant:?}").to_lowercase();
        let image = s.texture(paint::voxel_plant(&name, seed, plant));
        s.material(
            Material {
                name,
                diffuse: Vec3::ONE,
                specular: Vec3::splat(0.05),
                roughness: 0.9,
                alpha: Alpha::Cutout(0.5),
                double_sided: true,
                diffuse_map: Some(image),
                ..Material::default()
            },
            1.0,
        )
    });
    let mut planted = 0;
    for _ in 0..60_000 {
        if planted == 7000 {
            break;
        }
        let (x, z) = (rng.random_range(-110..110), rng.random_range(-120..130));
        let y = w.top(x, z);
        let meadow = w.noise(ivec3(x, 0, z), 9.0, 40);
        let free = w.get(ivec3(x, y + 1, z)) == AIR;
        if w.get(ivec3(x, y, z)) != code(Block::GrassTop) || meadow < 0.35 || !free || is_kept_free(x, z, 0) {
            continue;
        }
        planted += 1;
        let pick = w.chance(ivec3(x, y, z), 41);
        let kind = if pick < 0.07 {
            1
        } else if pick < 0.14 {
            2
        } else if pick < 0.25 {
            3
        } else {
            0
        };
        s.object(&format!("plants-{}-{}", (x + HALF) / CHUNK, (z + HALF) / CHUNK))
            .with_material(materials[kind]);
        let jitter = vec3(rng.random::<f32>() - 0.5, 0.0, rng.random::<f32>() - 0.5) * 0.3;
        let center = (vec3(x as f32 + 0.5, y as f32 + 1.5, z as f32 + 0.5) + jitter) * EDGE;
        for side in [1.0, -1.0] {
            s.card(center, vec3(0.5, 0.0, 0.5 * side) * EDGE * 0.9, Vec3::Y * 0.5 * EDGE, Vec3::Y);
        }
    }
    s.object("vines").with_material(materials[4]);
    let floor = TERRACE + 4;
    for _ in 0..6000 {
        let (x, z) = (rng.random_range(-30..=30), rng.random_range(-98..=-16));
        let top = floor + rng.random_range(4..22);
        let (dx, dz) = [(1, 0), (-1, 0), (0, 1), (0, -1)][rng.random_range(0..4)];
        for y in (top - rng.random_range(2..9)..top).rev() {
            let p = ivec3(x, y, z);
            let hangs = w.get(p) != AIR && w.get(p + ivec3(dx, 0, dz)) == AIR && y >= floor;
            if !hangs || w.noise(p, 7.0, 42) < 0.62 {
                break;
            }
            let out = vec3(dx as f32, 0.0, dz as f32);
            let center = (p.as_vec3() + 0.5 + out * 0.56) * EDGE;
            s.card(center, Vec3::Y.cross(out) * 0.5 * EDGE, Vec3::Y * 0.5 * EDGE, out);
        }
    }
}

/// Builds a lamp post with an arm. Returns the position of its light in metres.
fn lamp_post(s: &mut SceneBuilder, wood: usize, iron: usize, glow: usize, foot: Vec3, arm: Vec3) -> Vec3 {
    s.within(moved(foot.x, foot.y, foot.z), |s| {
        s.with_material(wood);
        s.cuboid(vec3(-0.06, -0.2, -0.06), vec3(0.06, 2.5, 0.06));
        let (back, tip) = (arm * -0.1, arm * 0.72);
        s.cuboid((back.min(tip) - 0.045).with_y(2.34), (back.max(tip) + 0.045).with_y(2.43));
        s.with_material(iron);
        let hook = arm * 0.66;
        s.cuboid(hook + vec3(-0.008, 2.05, -0.008), hook + vec3(0.008, 2.34, 0.008));
        s.cuboid(hook + vec3(-0.11, 2.03, -0.11), hook + vec3(0.11, 2.06, 0.11));
        s.cuboid(hook + vec3(-0.11, 1.74, -0.11), hook + vec3(0.11, 1.77, 0.11));
        for (x, z) in [(-0.1, -0.1), (0.1, -0.1), (-0.1, 0.1), (0.1, 0.1)] {
            let post = hook + vec3(x, 0.0, z);
            s.cuboid(post + vec3(-0.012, 1.77, -0.012), post + vec3(0.012, 2.03, 0.012));
        }
        s.with_material(glow);
        s.cuboid(hook + vec3(-0.075, 1.77, -0.075), hook + vec3(0.075, 2.0, 0.075));
        foot + hook + Vec3::Y * 1.9
    })
}

/// The scene; see [`super::BUILTINS`].
pub fn build(seed: u64, mut s: SceneBuilder) -> Scene {
    let mut rng = random(seed, "voxel");
    let noise_seed = rng.random::<u32>() >> 8;
    let mut w = terrain(noise_seed);
    castle(&mut w);
    pyramid(&mut w);
    temple(&mut w, &mut rng);
    bridge(&mut w);
    house(&mut w, ivec2(22, 62), ivec2(14, 18), true);
    house(&mut w, ivec2(40, 78), ivec2(12, 14), true);
    house(&mut w, ivec2(-30, 70), ivec2(14, 16), false);
    for (mouth, heading) in
        [(vec3(60.0, 12.0, -30.0), 0.3), (vec3(-64.0, 12.0, -40.0), 3.0), (vec3(100.0, 14.0, 60.0), 0.5)]
    {
        cave(&mut w, &mut rng, mouth, heading, 70);
    }
    woods(&mut w, &mut rng);

    let mut materials: Vec<usize> = BLOCKS
        .iter()
        .map(|&block| {
            let name = format!("{block:?}").to_lowercase();
            let image = s.texture(paint::voxel(&name, noise_seed, block));
            let glows = block == Block::Lantern;
            s.material(
                Material {
                    name,
                    diffuse: Vec3::ONE,
                    specular: if block == Block::Gold { vec3(0.9, 0.7, 0.3) } else { Vec3::splat(0.05) },
                    emissive: if glows { vec3(2.2, 1.6, 0.8) } else { Vec3::ZERO },
                    roughness: if block == Block::Gold { 0.35 } else { 0.95 },
                    diffuse_map: Some(image),
                    emissive_map: glows.then_some(image),
                    ..Material::default()
                },
                EDGE,
            )
        })
        .collect();
    let water = s.texture(paint::voxel("water", noise_seed, Block::Water));
    materials.push(s.material(
        Material {
            name: "water".into(),
            diffuse: Vec3::ONE,
            specular: Vec3::splat(0.4),
            roughness: 0.12,
            alpha: Alpha::Blend(0.72),
            diffuse_map: Some(water),
            ..Material::default()
        },
        EDGE,
    ));
    let iron = s.material(
        Material {
            name: "iron".into(),
            diffuse: Vec3::splat(0.14),
            specular: Vec3::splat(0.35),
            roughness: 0.5,
            ..Material::default()
        },
        1.0,
    );
    let wood = materials[code(Block::Planks) as usize - 1];
    let glow = materials[code(Block::Lantern) as usize - 1];

    plants(&mut s, &w, &mut rng, noise_seed);

    let warm = vec3(2.6, 1.5, 0.6);
    let mut lights = Vec::new();
    let floor = (TERRACE + 4) as f32 * EDGE;
    for z in [12, 20, 28, 36, 44] {
        for side in [-1.0, 1.0] {
            let foot = vec3(side * 2.25 + 0.25, deck(z) as f32 * EDGE, z as f32 * EDGE + 0.25);
            s.object(&format!("lamp-bridge-{z}"));
            let p = lamp_post(&mut s, wood, iron, glow, foot, Vec3::X * -side);
            if side > 0.0 || z % 16 == 12 {
                lights.push(PointLight { position: p, color: warm, range: 9.0 });
            }
        }
    }
    for z in [56, 66, 78] {
        let x = path_bend(z) - 5;
        let foot = vec3(x as f32 + 0.5, w.walkable_top(x, z) as f32 + 1.0, z as f32 + 0.5) * EDGE;
        s.object(&format!("lamp-path-{z}"));
        let p = lamp_post(&mut s, wood, iron, glow, foot, Vec3::X);
        lights.push(PointLight { position: p, color: warm, range: 9.0 });
    }
    for (x, z) in [(-4.0, -80.0), (4.0, -80.0)] {
        let position = vec3(x + 0.5, 0.0, z + 0.5) * EDGE + Vec3::Y * (floor + 3.2);
        lights.push(PointLight { position, color: warm * 1.6, range: 14.0 });
    }
    // Ropes with pennants between the first columns, and ropes along the temple's stairs.
    let rope = s.material(
        Material {
            name: "rope".into(),
            diffuse: vec3(0.45, 0.36, 0.24),
            roughness: 0.95,
            ..Material::default()
        },
        1.0,
    );
    let cloth = [vec3(0.75, 0.18, 0.15), vec3(0.9, 0.7, 0.2), vec3(0.2, 0.4, 0.6)].map(|color| {
        s.material(
            Material {
                name: format!("pennant-{}", (color.x * 100.0) as i32),
                diffuse: color,
                specular: Vec3::splat(0.04),
                roughness: 0.9,
                double_sided: true,
                ..Material::default()
            },
            1.0,
        )
    });
    s.object("ropes");
    let height = floor + 5.2;
    for pair in [-18.0, -10.0, 10.0, 18.0f32].windows(2) {
        let [a, b] = [0, 1].map(|i| vec3(pair[i] + 0.5, 0.0, -17.9) * EDGE + Vec3::Y * height);
        s.with_material(rope).wire(a, b, 0.5, 0.014, 16);
        for i in 1..12 {
            let p = super::build::hanging(a, b, 0.5, i as f32 / 12.0);
            s.with_material(cloth[i % 3]);
            let ids = [vec3(-0.13, 0.0, 0.0), vec3(0.0, -0.36, 0.03), vec3(0.13, 0.0, 0.0)]
                .map(|d| s.vertex(p + d, Vec3::Z, Vec2::ZERO));
            s.triangle(ids[0], ids[1], ids[2]);
        }
    }

    let viewpoints = walk(&w);
    let mut model = s.finish();
    for row in 0..SPAN / CHUNK {
        let before = model.triangle_count();
        add_chunks(&mut model, &w, &materials, row);
        s.count(model.triangle_count() - before);
    }
    model.vertices.shrink_to_fit();
    model.indices.shrink_to_fit();
    Scene {
        model,
        sky: Sky {
            sun_direction: vec3(0.52, 0.58, 0.45).normalize(),
            sun_color: vec3(3.2, 2.75, 2.2),
            zenith: vec3(0.2, 0.36, 0.72),
            horizon: vec3(0.72, 0.74, 0.78),
            ground: vec3(0.2, 0.2, 0.16),
        },
        lights,
        viewpoints,
        ..Scene::default()
    }
}

/// Returns a walk from the village over the bridge and up to the sanctum.
fn walk(w: &World) -> Vec<Viewpoint> {
    let steps = [
        (9.0, 84.0),
        (7.0, 79.5),
        (4.5, 75.0),
        (3.0, 70.5),
        (1.8, 66.0),
        (1.0, 61.5),
        (0.6, 57.0),
        (0.8, 52.5),
        (1.4, 48.0),
        (2.0, 43.5),
        (2.4, 39.0),
        (2.2, 34.5),
        (1.4, 30.0),
        (0.2, 25.5),
        (-1.0, 21.0),
        (-1.8, 16.5),
        (-2.0, 12.0),
        (-1.6, 7.5),
        (-0.8, 3.0),
        (0.4, -1.5),
        (1.6, -6.0),
        (2.4, -10.5),
        (2.4, -15.0),
        (1.6, -19.5),
        (0.8, -24.0),
        (0.2, -28.5),
    ];
    let height = |x: f32, z: f32| {
        // The mean over a stride, so that the head does not jump by a voxel.
        let around: f32 =
            (-4..=4).map(|d| (w.walkable_top(x.floor() as i32, z.floor() as i32 + d) + 1) as f32).sum();
        around / 9.0 * EDGE + 1.65
    };
    steps
        .iter()
        .enumerate()
        .map(|(i, &(x, z))| {
            let sway = vec2((i as f32 * 0.7).sin() * 5.0, (i as f32 * 0.45).cos() * 1.0);
            let position = vec3(x * EDGE, height(x, z), z * EDGE);
            Viewpoint { position, target: position + vec3(sway.x - x * 0.2, sway.y + 0.2, -14.0) }
        })
        .collect()
}
