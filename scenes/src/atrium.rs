//! A court with two storeys of arcades, curtains and banners, in place of Sponza.
//!
//! The court lies along z and is open to the sky. Aisles with cross vaults run around it, with a gallery above them.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Affine3A, UVec2, Vec2, Vec3, vec2, vec3};
use rand::Rng;
use rand_pcg::Pcg32;

use super::build::{ArchOpening, BoxFaces, SceneBuilder, around, moved, placed, random, viewpoints};
use super::paint::{self, Canvas};
use super::props::{self, fronds, glowing, metal, palette, pictured, plain, textured};
use yoro_assets::{PointLight, Scene, Sky, TextureImage, Viewpoint};

/// Half the width and half the length of the court.
const COURT: Vec2 = vec2(4.0, 15.0);
/// Width of the aisles.
const AISLE: f32 = 4.0;
const SPRING: f32 = 3.3;
const GALLERY: f32 = 5.7;
const EAVES: f32 = 10.4;
/// Half the thickness of the arcade walls.
const HALF_WALL: f32 = 0.32;

/// Generates the scene.
pub fn build(seed: u64, mut b: SceneBuilder) -> Scene {
    let p = palette(&mut b, seed);
    let rng = &mut random(seed, "atrium");
    floors(&mut b, &p);
    let long = 2.0 * COURT.y;
    let wide = 2.0 * COURT.x;
    let sides = [
        (placed(vec3(COURT.x, 0.0, -COURT.y), -FRAC_PI_2), 8, long / 8.0, "east"),
        (placed(vec3(-COURT.x, 0.0, COURT.y), FRAC_PI_2), 8, long / 8.0, "west"),
        (placed(vec3(-COURT.x, 0.0, -COURT.y), 0.0), 2, wide / 2.0, "north"),
        (placed(vec3(COURT.x, 0.0, COURT.y), PI), 2, wide / 2.0, "south"),
    ];
    let mut lights = Vec::new();
    for (frame, bays, bay, name) in sides {
        b.within(frame, |b| arcade(b, &p, &Side { bays, bay, name }, rng));
        if bays > 2 {
            for i in (0..bays).filter(|i| i % 2 == 1) {
                let at = vec3((i as f32 + 0.5) * bay, 3.05, -HALF_WALL - AISLE * 0.45);
                b.object(&format!("{name} lantern {i}"));
                b.within(frame * Affine3A::from_translation(at), |b| lantern(b, &p));
                let position = frame.transform_point3(at);
                lights.push(PointLight { position, color: vec3(3.4, 2.2, 1.1), range: 7.5 });
            }
        }
    }
    corners(&mut b, &p);
    lights.extend(court(&mut b, &p, rng));
    let sky = Sky {
        sun_direction: vec3(0.36, 0.87, 0.3).normalize(),
        sun_color: vec3(3.6, 3.3, 2.8),
        zenith: vec3(0.24, 0.38, 0.7),
        horizon: vec3(0.5, 0.52, 0.55),
        ground: vec3(0.24, 0.2, 0.15),
    };
    Scene { model: b.finish(), sky, lights, viewpoints: walk(), ..Scene::default() }
}

/// Returns a walk down the court past the vases, through an arch beside a curtain, and along the aisle.
fn walk() -> Vec<Viewpoint> {
    viewpoints(&[
        ([0.4, 1.66, 13.2], [-0.3, 2.8, 0.0]),
        ([0.9, 1.66, 11.2], [-0.5, 2.6, -2.0]),
        ([1.7, 1.66, 9.3], [0.2, 2.2, -4.0]),
        ([2.35, 1.66, 7.3], [2.2, 1.9, -5.0]),
        ([2.5, 1.66, 5.4], [3.4, 1.8, -6.0]),
        ([3.1, 1.66, 3.6], [4.4, 1.7, -6.0]),
        ([4.2, 1.66, 1.95], [5.4, 1.7, -7.0]),
        ([5.3, 1.66, 0.5], [5.7, 1.7, -9.0]),
        ([5.9, 1.66, -1.4], [5.2, 1.75, -11.0]),
        ([5.9, 1.66, -3.6], [4.6, 1.75, -12.0]),
        ([5.8, 1.66, -5.6], [3.6, 1.85, -13.0]),
        ([5.3, 1.66, -7.4], [1.6, 2.0, -13.5]),
        ([4.2, 1.66, -8.7], [-0.8, 2.3, -14.0]),
        ([2.9, 1.66, -9.7], [-2.6, 2.6, -14.5]),
    ])
}

palette! {
    fn palette(b: &mut SceneBuilder, seed: u64) -> Palette {
        let s = seed as u32;
        let ashlar = paint::stone_blocks("ashlar", 1024, s, vec3(0.74, 0.65, 0.5), [4, 8]);
        let red = vec3(0.48, 0.14, 0.11);
        let green = vec3(0.16, 0.3, 0.19);
        let blue = vec3(0.16, 0.21, 0.38);
        let gold = vec3(0.72, 0.54, 0.22);
        let double_sided = |b: &mut SceneBuilder, surface: paint::Surface, tile: f32| {
            let id = textured(b, surface, tile, 0.85);
            b.edit_material(id, |m| m.double_sided = true);
            id
        };
        let curtains =
            [("curtain-red", red), ("curtain-green", green), ("curtain-blue", blue)].map(|(name, color)| {
                double_sided(b, paint::damask(name, 512, s + 5, color, color * 0.5 + gold * 0.45, 3), 1.2)
            });
        let banners =
            [("banner-red", red), ("banner-green", green), ("banner-blue", blue)].map(|(name, color)| {
                let id = pictured(b, banner_picture(name, s, color, gold), 0.85, 0.0);
                b.edit_material(id, |m| m.double_sided = true);
                id
            });
        let frond = plain(b, "frond", vec3(0.24, 0.42, 0.16), 0.5);
        b.edit_material(frond, |m| m.double_sided = true);
        let water = props::glass(b, "water", vec3(0.1, 0.22, 0.22), 0.55);
    }
    ashlar = textured(b, ashlar, 3.2, 0.85),
    plaster = textured(b, paint::plaster("vault-plaster", 512, s + 1, vec3(0.8, 0.74, 0.62)), 2.6, 0.9),
    trim = textured(b, paint::concrete("limestone", 512, s + 2, vec3(0.8, 0.74, 0.63)), 1.9, 0.75),
    column = textured(
        b,
        paint::marble("column-marble", 512, s + 3, vec3(0.78, 0.72, 0.62), vec3(0.55, 0.45, 0.34)),
        1.6,
        0.35,
    ),
    red_marble = textured(
        b,
        paint::marble("red-marble", 512, s + 4, vec3(0.5, 0.26, 0.2), vec3(0.82, 0.7, 0.6)),
        1.4,
        0.25,
    ),
    floor = textured(
        b,
        paint::tiles("floor-tiles", 1024, s + 6, [vec3(0.7, 0.64, 0.54), vec3(0.42, 0.32, 0.26)], 6),
        3.6,
        0.3,
    ),
    aisle_floor = textured(
        b,
        paint::tiles("aisle-tiles", 512, s + 7, [vec3(0.62, 0.5, 0.38), vec3(0.54, 0.41, 0.3)], 4),
        2.0,
        0.45,
    ),
    curtains: [usize; 3] = curtains,
    banners: [usize; 3] = banners,
    bronze = metal(b, "bronze", vec3(0.42, 0.3, 0.17), 0.4),
    gold = metal(b, "gold", vec3(0.83, 0.64, 0.28), 0.3),
    wood = textured(b, paint::planks("dark-wood", 512, s + 8, vec3(0.33, 0.21, 0.12), 5), 1.1, 0.6),
    roof = textured(b, paint::roof_tiles("roof", 512, s + 9, vec3(0.68, 0.39, 0.25), [8, 8]), 2.0, 0.85),
    ceramic: [usize; 2] = [
        plain(b, "ceramic-blue", vec3(0.2, 0.36, 0.5), 0.2),
        plain(b, "ceramic-cream", vec3(0.84, 0.76, 0.6), 0.25),
    ],
    terracotta = textured(b, paint::plaster("terracotta", 256, s + 10, vec3(0.7, 0.42, 0.28)), 1.0, 0.8),
    soil = plain(b, "soil", vec3(0.22, 0.16, 0.11), 0.95),
    frond = frond,
    stem = plain(b, "stem", vec3(0.32, 0.36, 0.17), 0.7),
    leaves = props::foliage(b, "leaves", seed, vec3(0.23, 0.42, 0.15)),
    flame = glowing(b, "flame", vec3(1.0, 0.75, 0.4), 1.85),
    water = water,
    iron = metal(b, "iron", vec3(0.13, 0.12, 0.12), 0.5),
    niche = plain(b, "niche", vec3(0.3, 0.24, 0.18), 0.95),
    rope = textured(b, paint::fabric("rope", 256, s + 11, vec3(0.75, 0.6, 0.3), 16), 0.1, 0.7),
}

/// Paints a heraldic banner: border, ornament and a lion-like star in gold.
fn banner_picture(name: &str, seed: u32, color: Vec3, gold: Vec3) -> TextureImage {
    let mut c = Canvas::new([256, 640], (color * 1.1).extend(1.0));
    let ink = gold.extend(1.0);
    for (inset, width) in [(10.0, 6.0), (22.0, 2.0)] {
        let (l, t, r, d) = (inset, inset, 256.0 - inset, 640.0 - inset);
        for [a, e] in [
            [vec2(l, t), vec2(r, t)],
            [vec2(r, t), vec2(r, d)],
            [vec2(r, d), vec2(l, d)],
            [vec2(l, d), vec2(l, t)],
        ] {
            c.line(a, e, width, ink);
        }
    }
    let center = vec2(128.0, 250.0);
    c.ellipse(center, Vec2::splat(84.0), ink);
    c.ellipse(center, Vec2::splat(76.0), (color * 0.8).extend(1.0));
    for i in 0..16 {
        let (sin, cos) = (i as f32 / 16.0 * TAU).sin_cos();
        let reach = if i % 2 == 0 { 70.0 } else { 44.0 };
        c.leaf(center + vec2(cos, sin) * 12.0, center + vec2(cos, sin) * reach, 9.0, ink);
    }
    c.ellipse(center, Vec2::splat(14.0), (color * 0.8).extend(1.0));
    for row in 0..2 {
        let y = 60.0 + 470.0 * row as f32;
        for i in 0..5 {
            let x = 48.0 + 40.0 * i as f32;
            c.leaf(vec2(x, y + 26.0), vec2(x, y - 22.0), 9.0, ink);
            c.leaf(vec2(x, y + 26.0), vec2(x - 16.0, y), 5.0, ink);
            c.leaf(vec2(x, y + 26.0), vec2(x + 16.0, y), 5.0, ink);
        }
    }
    for i in 0..3 {
        c.line(vec2(48.0, 390.0 + 30.0 * i as f32), vec2(208.0, 390.0 + 30.0 * i as f32), 3.0, ink);
        c.ellipse(vec2(128.0, 390.0 + 30.0 * i as f32), Vec2::splat(9.0), ink);
    }
    let mut image = c.into_texture(name);
    // Wear of the cloth.
    let [w, h] = image.size;
    for (i, pixel) in image.rgba.chunks_exact_mut(4).enumerate() {
        let uv = vec2((i as u32 % w) as f32 / w as f32, (i as u32 / w) as f32 / h as f32);
        let wear = 0.78 + 0.4 * paint::fbm(seed, UVec2::new(6, 14), 4, uv);
        for channel in &mut pixel[..3] {
            *channel = (f32::from(*channel) * wear).min(255.0) as u8;
        }
    }
    image
}

fn floors(b: &mut SceneBuilder, p: &Palette) {
    b.object("court floor").with_material(p.floor);
    b.rectangle(vec3(-3.6, 0.0, 14.4), Vec3::X * 7.2, Vec3::NEG_Z * 28.8);
    b.object("aisle floor").with_material(p.aisle_floor);
    // Doors are set back from the outer walls.
    let outer = COURT + AISLE + HALF_WALL + 0.4;
    for (min, max) in [
        (vec2(-outer.x, -outer.y), vec2(outer.x, -14.4)),
        (vec2(-outer.x, 14.4), vec2(outer.x, outer.y)),
        (vec2(-outer.x, -14.4), vec2(-3.6, 14.4)),
        (vec2(3.6, -14.4), vec2(outer.x, 14.4)),
    ] {
        let size = max - min;
        let corner = vec3(min.x, 0.0, max.y);
        b.set_uv_offset(vec2(min.x, -max.y));
        b.rectangle(corner, Vec3::X * size.x, Vec3::NEG_Z * size.y);
        b.rectangle(corner + Vec3::Y * GALLERY, Vec3::X * size.x, Vec3::NEG_Z * size.y);
    }
    b.set_uv_offset(Vec2::ZERO);
    b.object("floor border").with_material(p.red_marble);
    let y = 0.004;
    for x in [-3.6, 3.35] {
        b.rectangle(vec3(x, y, 14.4), Vec3::X * 0.25, Vec3::NEG_Z * 28.8);
    }
    for z in [14.4, -14.15] {
        b.rectangle(vec3(-3.6, y, z), Vec3::X * 7.2, Vec3::NEG_Z * 0.25);
    }
}

struct Side {
    bays: usize,
    bay: f32,
    name: &'static str,
}

/// Builds one side of the court: x along the arcade, the court towards +z, the aisle towards -z.
fn arcade(b: &mut SceneBuilder, p: &Palette, side: &Side, rng: &mut Pcg32) {
    let Side { bays, bay, name } = *side;
    let length = bay * bays as f32;
    let thick = HALF_WALL * 2.0;
    let upper_spring = 1.75;
    for i in 0..bays {
        let middle = (i as f32 + 0.5) * bay;
        b.object(&format!("{name} arch {i}")).with_material(p.ashlar);
        b.set_uv_offset(vec2(middle, 0.0));
        b.within(moved(middle, SPRING, HALF_WALL), |b| {
            let opening = ArchOpening { width: bay - 0.64, spring: 0.06 };
            b.arched_wall(vec2(bay, GALLERY - SPRING), opening, thick, 24);
        });
        b.within(moved(middle, GALLERY + upper_spring, HALF_WALL), |b| {
            let opening = ArchOpening { width: bay - 0.5, spring: 0.05 };
            b.arched_wall(vec2(bay, EAVES - GALLERY - upper_spring), opening, thick, 24);
        });
        b.set_uv_offset(Vec2::ZERO);
        // Archivolts: a raised moulding that follows each arch.
        b.with_material(p.trim);
        for (width, y) in [(bay - 0.64, SPRING + 0.06), (bay - 0.5, GALLERY + upper_spring + 0.05)] {
            let path: Vec<Vec3> = (0..=32)
                .map(|k| {
                    let (sin, cos) = (PI * k as f32 / 32.0).sin_cos();
                    let radius = width * 0.5 + 0.07;
                    vec3(middle + cos * radius, y + sin * radius, HALF_WALL + 0.01)
                })
                .collect();
            b.tube(&path, 0.055, 8, false);
        }
        b.within(moved(middle, SPRING + 0.06 + (bay - 0.64) * 0.5, HALF_WALL), |b| {
            b.extrude(
                &[vec2(-0.1, -0.02), vec2(0.1, -0.02), vec2(0.17, 0.36), vec2(-0.17, 0.36)],
                0.0,
                0.12,
                false,
            );
        });
        b.object(&format!("{name} vault {i}")).with_material(p.plaster);
        vault(b, vec2(i as f32 * bay, -HALF_WALL - AISLE), vec2((i + 1) as f32 * bay, -HALF_WALL));
        outer_wall(b, p, side, i, rng);
        b.object(&format!("{name} balustrade {i}"));
        balustrade(b, p, vec3(i as f32 * bay + 0.26, GALLERY, 0.05), bay - 0.52);
        hangings(b, p, side, i, rng);
    }
    for i in 0..=bays {
        let x = i as f32 * bay;
        let corner = i == 0 || i == bays;
        b.object(&format!("{name} column {i}"));
        b.within(moved(x, 0.0, 0.0), |b| {
            if corner {
                // Of the two piers at a corner, the neighbouring side builds the other.
                if i == 0 {
                    pier(b, p, 0.44, SPRING);
                    b.within(moved(0.0, GALLERY, 0.0), |b| pier(b, p, 0.4, upper_spring));
                }
            } else {
                if i % 3 == 0 {
                    pier(b, p, 0.36, SPRING);
                } else {
                    column(b, p, 0.3, SPRING, 24);
                }
                b.within(moved(0.0, GALLERY, 0.0), |b| column(b, p, 0.19, upper_spring, 18));
            }
        });
    }
    // String courses, dentils and the eaves.
    b.object(&format!("{name} cornice")).with_material(p.trim);
    let z = HALF_WALL;
    for (y0, y1, out) in
        [(GALLERY - 0.22, GALLERY - 0.1, 0.07), (GALLERY - 0.1, GALLERY + 0.02, 0.16), (9.75, 9.85, 0.08)]
    {
        b.beveled_cuboid(vec3(0.0, y0, z - 0.1), vec3(length, y1, z + out), 0.02);
    }
    b.beveled_cuboid(vec3(0.0, EAVES - 0.16, z - 0.1), vec3(length, EAVES, z + 0.34), 0.03);
    let dentils = (length / 0.32) as usize;
    for i in 0..dentils {
        let x = (i as f32 + 0.5) * length / dentils as f32;
        b.cuboid(vec3(x - 0.08, EAVES - 0.36, z), vec3(x + 0.08, EAVES - 0.16, z + 0.22));
        b.cuboid(vec3(x - 0.05, GALLERY - 0.34, z), vec3(x + 0.05, GALLERY - 0.22, z + 0.06));
    }
    b.object(&format!("{name} roof")).with_material(p.roof);
    let (low, high) = (vec3(0.0, EAVES, z + 0.5), vec3(0.0, EAVES + 1.5, -HALF_WALL - AISLE));
    // The slopes run into each other to close the corners.
    let reach = AISLE + 2.0 * HALF_WALL;
    b.quad([low, low + Vec3::X * length, high + Vec3::X * (length + reach), high - Vec3::X * reach]);
    for i in 0..(length / 0.24) as usize {
        let x = 0.12 + i as f32 * 0.24;
        let tile = [vec3(x, EAVES + 0.01, z + 0.56), vec3(x, EAVES + 0.6, z - 1.3)];
        b.tube(&tile, 0.075, 8, true);
    }
    b.object(&format!("{name} gallery ceiling")).with_material(p.wood);
    let back = -HALF_WALL - AISLE;
    let ceiling = EAVES - 0.5;
    b.rectangle(vec3(-reach, ceiling, back), Vec3::X * (length + 2.0 * reach), Vec3::NEG_Z * back);
    let beams = (length / 1.25) as usize;
    for i in 0..beams {
        let x = (i as f32 + 0.5) * length / beams as f32;
        b.cuboid(vec3(x - 0.09, ceiling - 0.24, back), vec3(x + 0.09, ceiling, -HALF_WALL));
    }
}

/// Builds a cross vault over the rectangle (x, z), seen from below.
fn vault(b: &mut SceneBuilder, min: Vec2, max: Vec2) {
    let (center, half) = ((min + max) * 0.5, (max - min) * 0.5);
    b.surface(20, 20, false, |u, v| {
        // Denser at the walls, where the vault is steep.
        let ease = |t: f32| -(t * PI).cos();
        let local = vec2(ease(u), ease(v));
        let rise = |t: f32| (1.0 - t * t).max(0.0).sqrt();
        let y = SPRING + 0.1 + (GALLERY - 0.35 - SPRING) * rise(local.x).max(rise(local.y));
        let at = center + local * half;
        (vec3(at.x, y, at.y), at + vec2(0.0, y))
    });
    let rib = |b: &mut SceneBuilder, from: Vec2, to: Vec2| {
        let path: Vec<Vec3> = (0..=20)
            .map(|k| {
                let t = -(k as f32 / 20.0 * PI).cos();
                let at = center + from.lerp(to, t * 0.5 + 0.5) * half * 0.995;
                let y = SPRING + 0.08 + (GALLERY - 0.35 - SPRING) * (1.0 - t * t).max(0.0).sqrt();
                vec3(at.x, y - 0.01, at.y)
            })
            .collect();
        b.tube(&path, 0.06, 8, false);
    };
    rib(b, vec2(-1.0, -1.0), vec2(1.0, 1.0));
    rib(b, vec2(-1.0, 1.0), vec2(1.0, -1.0));
}

fn column(b: &mut SceneBuilder, p: &Palette, radius: f32, height: f32, sides: usize) {
    let r = radius;
    let top = height - r * 1.25;
    b.with_material(p.trim);
    b.cuboid_faces(vec3(-r * 1.45, 0.0, -r * 1.45), vec3(r * 1.45, r * 0.4, r * 1.45), BoxFaces::STANDING);
    let base: Vec<(f32, f32)> = [
        (1.4, 0.4),
        (1.46, 0.48),
        (1.4, 0.58),
        (1.22, 0.6),
        (1.18, 0.68),
        (1.24, 0.74),
        (1.24, 0.82),
        (1.06, 0.88),
    ]
    .map(|(x, y)| (x * r, y * r))
    .to_vec();
    b.lathe(&base, sides);
    b.with_material(p.column);
    let shaft: Vec<(f32, f32)> = (0..=8)
        .map(|i| {
            let t = i as f32 / 8.0;
            (r * (1.05 - 0.17 * t.powf(1.6)), r * 0.88 + (top - r * 0.88) * t)
        })
        .collect();
    b.lathe(&shaft, sides);
    // Capital: a bell, two rings of leaves and the abacus.
    b.with_material(p.trim);
    b.lathe(
        &[
            (r * 0.9, top - r * 0.08),
            (r * 1.02, top - r * 0.03),
            (r * 0.9, top + r * 0.05),
            (r * 0.95, top + r * 0.5),
            (r * 1.3, top + r * 0.95),
        ],
        sides,
    );
    for (ring, (leaves, low, tall)) in [(8, 0.05, 0.55), (8, 0.35, 0.6)].into_iter().enumerate() {
        for k in 0..leaves {
            let turn = (k as f32 + 0.5 * ring as f32) / leaves as f32 * TAU;
            let (sin, cos) = turn.sin_cos();
            let (out, across) = (vec3(cos, 0.0, -sin), vec3(-sin, 0.0, -cos));
            b.surface(4, 6, false, |u, v| {
                let side = u * 2.0 - 1.0;
                let half = r * 0.3 * (1.0 - 0.75 * v * v);
                let curl = r * (0.96 + 0.1 * ring as f32 + 0.4 * v.powi(4) - 0.1 * side * side);
                let y = top + r * (low + tall * (v - 0.25 * v.powi(4)));
                (out * curl + across * (side * half) + Vec3::Y * y, vec2(side * half, y))
            });
        }
    }
    b.beveled_cuboid(
        vec3(-r * 1.45, height - r * 0.32, -r * 1.45),
        vec3(r * 1.45, height, r * 1.45),
        r * 0.08,
    );
}

fn pier(b: &mut SceneBuilder, p: &Palette, half: f32, height: f32) {
    b.with_material(p.ashlar);
    b.cuboid_faces(vec3(-half, 0.0, -half), vec3(half, height, half), BoxFaces::STANDING);
    b.with_material(p.trim);
    for (y0, y1, out) in [
        (0.0, 0.22, 0.09),
        (0.22, 0.3, 0.05),
        (height - 0.34, height - 0.26, 0.04),
        (height - 0.2, height, 0.09),
    ] {
        let h = half + out;
        b.beveled_cuboid(vec3(-h, y0, -h), vec3(h, y1, h), 0.02);
    }
}

/// Builds turned balusters between two rails, from `left` along +x.
fn balustrade(b: &mut SceneBuilder, p: &Palette, left: Vec3, width: f32) {
    b.with_material(p.trim);
    b.beveled_cuboid(left + vec3(0.0, 0.0, -0.12), left + vec3(width, 0.12, 0.12), 0.015);
    b.beveled_cuboid(left + vec3(0.0, 0.86, -0.13), left + vec3(width, 1.0, 0.13), 0.025);
    let count = (width / 0.27) as usize;
    for i in 0..count {
        let x = (i as f32 + 0.5) * width / count as f32;
        b.within(Affine3A::from_translation(left + vec3(x, 0.12, 0.0)), |b| {
            b.lathe(
                &[
                    (0.07, 0.0),
                    (0.07, 0.06),
                    (0.045, 0.09),
                    (0.06, 0.14),
                    (0.085, 0.24),
                    (0.075, 0.32),
                    (0.04, 0.46),
                    (0.034, 0.56),
                    (0.055, 0.6),
                    (0.036, 0.64),
                    (0.07, 0.69),
                    (0.07, 0.74),
                ],
                12,
            );
        });
    }
}

fn outer_wall(b: &mut SceneBuilder, p: &Palette, side: &Side, i: usize, rng: &mut Pcg32) {
    let (x0, x1) = (i as f32 * side.bay, (i + 1) as f32 * side.bay);
    let (middle, z) = ((x0 + x1) * 0.5, -HALF_WALL - AISLE);
    b.object(&format!("{} outer wall {i}", side.name)).with_material(p.ashlar);
    let niche = i.is_multiple_of(2);
    if niche {
        b.set_uv_offset(vec2(middle, 0.0));
        b.within(moved(middle, 0.0, z), |b| {
            b.arched_wall(vec2(side.bay, GALLERY), ArchOpening { width: 1.5, spring: 2.2 }, 0.4, 18);
        });
        b.set_uv_offset(Vec2::ZERO);
        if rng.random_bool(0.5) {
            // A door of planks with iron bands.
            b.with_material(p.wood);
            b.rectangle(vec3(middle - 0.75, 0.0, z - 0.28), Vec3::X * 1.5, Vec3::Y * 3.0);
            b.with_material(p.iron);
            for y in [0.5, 1.3, 2.1] {
                b.cuboid(vec3(middle - 0.75, y, z - 0.28), vec3(middle + 0.75, y + 0.07, z - 0.25));
            }
            b.with_material(p.gold);
            let ring: Vec<Vec3> = (0..=20)
                .map(|k| {
                    let (sin, cos) = (k as f32 / 20.0 * TAU).sin_cos();
                    vec3(middle + 0.45 + cos * 0.08, 1.1 + sin * 0.08, z - 0.22)
                })
                .collect();
            b.tube(&ring, 0.012, 8, false);
        } else {
            b.with_material(p.niche);
            b.rectangle(vec3(middle - 0.75, 0.0, z - 0.38), Vec3::X * 1.5, Vec3::Y * 3.0);
            b.with_material(p.red_marble);
            b.beveled_cuboid(vec3(middle - 0.3, 0.0, z - 0.38), vec3(middle + 0.3, 0.95, z + 0.1), 0.03);
            b.within(moved(middle, 0.95, z - 0.12), |b| urn(b, p, 0.55));
        }
    } else {
        b.rectangle(vec3(x0, 0.0, z), Vec3::X * side.bay, Vec3::Y * GALLERY);
        // A barred window high up, with sill and lintel.
        b.with_material(p.niche);
        b.rectangle(vec3(middle - 0.5, 1.9, z + 0.01), Vec3::X, Vec3::Y * 1.2);
        b.with_material(p.trim);
        b.beveled_cuboid(vec3(middle - 0.68, 1.76, z), vec3(middle + 0.68, 1.9, z + 0.16), 0.02);
        b.beveled_cuboid(vec3(middle - 0.68, 3.1, z), vec3(middle + 0.68, 3.26, z + 0.12), 0.02);
        for x in [middle - 0.62, middle + 0.5] {
            b.beveled_cuboid(vec3(x, 1.9, z), vec3(x + 0.12, 3.1, z + 0.08), 0.015);
        }
        b.with_material(p.iron);
        for k in 0..7 {
            let x = middle - 0.5 + k as f32 / 6.0;
            b.cylinder(vec3(x, 1.9, z + 0.06), vec3(x, 3.1, z + 0.06), 0.012, 0.012, 6, false);
        }
        for y in [2.3, 2.7] {
            b.cylinder(
                vec3(middle - 0.5, y, z + 0.06),
                vec3(middle + 0.5, y, z + 0.06),
                0.01,
                0.01,
                6,
                false,
            );
        }
    }
    // Half columns carry the vault; the upper wall is plastered.
    b.with_material(p.trim);
    b.beveled_cuboid(vec3(x0 - 0.2, 0.0, z - 0.02), vec3(x0 + 0.2, 0.3, z + 0.24), 0.02);
    b.cuboid_faces(vec3(x0 - 0.15, 0.3, z), vec3(x0 + 0.15, SPRING - 0.1, z + 0.18), BoxFaces::STANDING);
    b.beveled_cuboid(vec3(x0 - 0.22, SPRING - 0.12, z - 0.02), vec3(x0 + 0.22, SPRING + 0.1, z + 0.26), 0.03);
    b.with_material(p.plaster);
    b.set_uv_offset(vec2(x0, 0.0));
    b.rectangle(vec3(x0, GALLERY, z), Vec3::X * side.bay, Vec3::Y * (EAVES - GALLERY));
    b.set_uv_offset(Vec2::ZERO);
    b.with_material(p.wood);
    b.cuboid(vec3(middle - 0.55, GALLERY, z), vec3(middle + 0.55, GALLERY + 2.2, z + 0.06));
    b.with_material(p.trim);
    for x in [middle - 0.7, middle + 0.55] {
        b.beveled_cuboid(vec3(x, GALLERY, z), vec3(x + 0.15, GALLERY + 2.2, z + 0.1), 0.015);
    }
    b.beveled_cuboid(
        vec3(middle - 0.75, GALLERY + 2.2, z),
        vec3(middle + 0.75, GALLERY + 2.4, z + 0.14),
        0.02,
    );
}

/// Builds the curtains in the arches and the banners on the gallery.
fn hangings(b: &mut SceneBuilder, p: &Palette, side: &Side, i: usize, rng: &mut Pcg32) {
    let middle = (i as f32 + 0.5) * side.bay;
    let cloth = p.curtains[(i + usize::from(side.name == "west")) % 3];
    b.object(&format!("{} curtain {i}", side.name));
    let rod_y = SPRING - 0.06;
    let half = side.bay * 0.5 - 0.36;
    let hung = side.bays > 2 && i % 4 != 3;
    if hung {
        b.with_material(p.bronze);
        let (left, right) = (vec3(middle - half - 0.2, rod_y, 0.0), vec3(middle + half + 0.2, rod_y, 0.0));
        b.tube(&[left, right], 0.022, 10, true);
        for k in 0..=16 {
            let x = middle + half * (k as f32 / 8.0 - 1.0) * 0.97;
            let ring: Vec<Vec3> = (0..=10)
                .map(|j| {
                    let (sin, cos) = (j as f32 / 10.0 * TAU).sin_cos();
                    vec3(x, rod_y - 0.015 + cos * 0.04, sin * 0.04)
                })
                .collect();
            b.tube(&ring, 0.006, 5, false);
        }
        match i % 4 {
            0 => {
                for direction in [-1.0, 1.0] {
                    tied_curtain(b, p, cloth, vec3(middle, rod_y - 0.05, 0.0), half * direction, rng);
                }
            }
            1 => tied_curtain(b, p, cloth, vec3(middle + half, rod_y - 0.05, 0.0), -half * 2.0, rng),
            _ => {
                b.with_material(cloth);
                let (left, right) =
                    (vec3(middle - half, rod_y - 0.05, 0.0), vec3(middle + half * 0.5, rod_y - 0.05, 0.0));
                b.curtain(left, right, rod_y - 0.12, 11.0, 0.09, [100, 22]);
            }
        }
    }
    if i % 2 == usize::from(side.name == "west") {
        b.object(&format!("{} banner {i}", side.name)).with_material(p.banners[i / 2 % 3]);
        let (width, drop) = (1.25, 3.1);
        let phase = rng.random::<f32>() * TAU;
        let mut points = Vec::new();
        let (columns, rows) = (18, 40);
        for j in 0..=rows {
            let v = j as f32 / rows as f32;
            for k in 0..=columns {
                let u = k as f32 / columns as f32;
                let fall = 1.0 - v;
                let swing = 0.05 * fall * ((u * 5.0 + phase).sin() + (fall * 4.0 + phase).sin());
                let point = if v == 0.0 { 0.18 * (1.0 - (u * 2.0 - 1.0).abs()) } else { 0.0 };
                let at = vec3(
                    middle + (u - 0.5) * width,
                    GALLERY + 1.02 - fall * drop - point,
                    HALF_WALL + 0.26 + swing,
                );
                points.push((at, vec2(u, v)));
            }
        }
        b.grid(columns, rows, false, &points);
        b.with_material(p.bronze);
        let y = GALLERY + 1.02;
        b.tube(
            &[vec3(middle - 0.75, y, HALF_WALL + 0.26), vec3(middle + 0.75, y, HALF_WALL + 0.26)],
            0.025,
            8,
            true,
        );
        for x in [middle - 0.7, middle + 0.7] {
            b.ellipsoid(vec3(x, y, HALF_WALL + 0.26), Vec3::splat(0.045), 8, 12);
            b.tube(&[vec3(x * 1.0, y, 0.1), vec3(x, y, HALF_WALL + 0.26)], 0.014, 6, true);
        }
    }
}

/// Builds a curtain that hangs from `inner` along x over `width` metres (negative: to the left) and is tied to the
/// column at its outer end.
fn tied_curtain(b: &mut SceneBuilder, p: &Palette, cloth: usize, inner: Vec3, width: f32, rng: &mut Pcg32) {
    let drop = inner.y - 0.08;
    let folds = (width.abs() * 4.5).round();
    let phase = rng.random::<f32>() * TAU;
    let tie = 0.6;
    b.with_material(cloth);
    let gather = |fall: f32| {
        let above = paint::smoothstep(0.05, tie, fall);
        let below = paint::smoothstep(tie, 1.0, fall);
        (1.0 - 0.84 * above) + 0.16 * below
    };
    b.surface(64, 26, false, |u, v| {
        let fall = 1.0 - v;
        let spread = gather(fall);
        let x = inner.x + width * (1.0 - (1.0 - u) * spread);
        // The free edge hangs down in a bow; the folds deepen as the cloth is gathered.
        let lower = 0.22 * (1.0 - u) * (fall * PI).sin();
        let wave = (u * folds * TAU + phase).sin() + 0.3 * (u * folds * 1.3 * PI + phase * 2.0).sin();
        let z = wave * (0.05 + 0.05 * (1.0 - spread)) * (0.4 + 0.6 * fall);
        let y = inner.y - fall * drop - lower * (1.0 - fall);
        (vec3(x, y, inner.z + z), vec2(u * width.abs() * 1.5, -fall * drop))
    });
    b.with_material(p.rope);
    let knot = vec3(inner.x + width * (1.0 - 0.08), inner.y - drop * tie, inner.z);
    let loop_: Vec<Vec3> = (0..=24)
        .map(|k| {
            let (sin, cos) = (k as f32 / 24.0 * TAU).sin_cos();
            knot + vec3(cos * (width.abs() * 0.085 + 0.03), 0.02 * cos * width.signum(), sin * 0.16)
        })
        .collect();
    b.tube(&loop_, 0.022, 8, false);
    b.within(Affine3A::from_translation(knot + vec3(0.0, -0.02, 0.17)), |b| {
        b.lathe(&[(0.012, -0.3), (0.045, -0.28), (0.02, -0.08), (0.03, -0.03), (0.0, 0.0)], 10);
    });
}

fn urn(b: &mut SceneBuilder, p: &Palette, height: f32) {
    let h = height;
    b.with_material(p.ceramic[1]);
    b.lathe(
        &[
            (0.18 * h, 0.0),
            (0.2 * h, 0.04 * h),
            (0.09 * h, 0.12 * h),
            (0.12 * h, 0.2 * h),
            (0.34 * h, 0.5 * h),
            (0.36 * h, 0.66 * h),
            (0.22 * h, 0.84 * h),
            (0.16 * h, 0.9 * h),
            (0.24 * h, h),
            (0.24 * h, h),
            (0.2 * h, h),
            (0.13 * h, 0.9 * h),
        ],
        28,
    );
}

fn lantern(b: &mut SceneBuilder, p: &Palette) {
    b.with_material(p.bronze);
    // A chain up to the vault, with alternating links.
    let top = 2.1;
    let links = 24;
    for k in 0..links {
        let y = 0.3 + (top - 0.3) * (k as f32 + 0.5) / links as f32;
        let link: Vec<Vec3> = (0..=10)
            .map(|j| {
                let (sin, cos) = (j as f32 / 10.0 * TAU).sin_cos();
                let (across, up) = (cos * 0.022, sin * 0.048);
                if k % 2 == 0 { vec3(across, y + up, 0.0) } else { vec3(0.0, y + up, across) }
            })
            .collect();
        b.tube(&link, 0.006, 5, false);
    }
    b.lathe(&[(0.16, -0.22), (0.18, -0.2), (0.17, -0.16), (0.15, -0.16), (0.1, -0.2), (0.0, -0.21)], 24);
    b.lathe(&[(0.0, 0.17), (0.17, 0.17), (0.19, 0.19), (0.06, 0.28), (0.02, 0.34), (0.0, 0.34)], 24);
    for k in 0..8 {
        let (sin, cos) = (k as f32 / 8.0 * TAU).sin_cos();
        let out = vec3(cos, 0.0, sin) * 0.155;
        let path: Vec<Vec3> = (0..=6)
            .map(|j| {
                let t = j as f32 / 6.0;
                out * (1.0 + 0.18 * (t * PI).sin()) + Vec3::Y * (-0.18 + 0.36 * t)
            })
            .collect();
        b.tube(&path, 0.008, 6, false);
    }
    b.with_material(p.flame);
    b.ellipsoid(vec3(0.0, -0.03, 0.0), vec3(0.05, 0.1, 0.05), 12, 16);
}

/// Builds the corners of the aisles: their vaults and outer walls.
fn corners(b: &mut SceneBuilder, p: &Palette) {
    let inner = COURT + HALF_WALL;
    let outer = COURT + HALF_WALL + AISLE;
    for (sx, sz, name) in [(1.0, 1.0, "se"), (-1.0, 1.0, "sw"), (1.0, -1.0, "ne"), (-1.0, -1.0, "nw")] {
        b.object(&format!("{name} corner")).with_material(p.plaster);
        let (a, c) = (vec2(inner.x * sx, inner.y * sz), vec2(outer.x * sx, outer.y * sz));
        vault(b, a.min(c), a.max(c));
        b.with_material(p.ashlar);
        let (reach, top) = (AISLE + HALF_WALL, EAVES);
        // The corner's two outer sides, each facing the aisle.
        let x = outer.x * sx;
        let z0 = COURT.y * sz;
        let z1 = outer.y * sz;
        let (from, to) = if sx > 0.0 { (z0.min(z1), z0.max(z1)) } else { (z0.max(z1), z0.min(z1)) };
        b.quad([vec3(x, 0.0, from), vec3(x, 0.0, to), vec3(x, top, to), vec3(x, top, from)]);
        let (x0, x1) = (COURT.x * sx, outer.x * sx);
        let (from, to) = if sz > 0.0 { (x0.max(x1), x0.min(x1)) } else { (x0.min(x1), x0.max(x1)) };
        b.quad([vec3(from, 0.0, z1), vec3(to, 0.0, z1), vec3(to, top, z1), vec3(from, top, z1)]);
        debug_assert!((to - from).abs() - reach < 1e-3);
    }
}

/// Builds vases, a fountain and benches in the court.
fn court(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) -> Vec<PointLight> {
    for i in 0..5 {
        for side in [-1.0, 1.0] {
            let z = 11.4 - 5.6 * i as f32;
            b.object(&format!("vase {i} {}", if side < 0.0 { "west" } else { "east" }));
            b.within(placed(vec3(3.15 * side, 0.0, z), rng.random::<f32>() * TAU), |b| vase(b, p, i, rng));
        }
    }
    b.object("fountain").with_material(p.trim);
    b.within(moved(0.0, 0.0, -2.0), |b| {
        b.lathe(
            &[
                (1.7, 0.0),
                (1.7, 0.12),
                (1.5, 0.16),
                (1.42, 0.42),
                (1.6, 0.5),
                (1.62, 0.58),
                (1.62, 0.58),
                (1.35, 0.58),
                (1.35, 0.58),
                (1.3, 0.2),
                (0.0, 0.18),
            ],
            48,
        );
        b.lathe(
            &[
                (0.3, 0.18),
                (0.22, 0.35),
                (0.14, 0.6),
                (0.13, 0.9),
                (0.2, 0.98),
                (0.55, 1.12),
                (0.72, 1.3),
                (0.74, 1.34),
                (0.74, 1.34),
                (0.66, 1.32),
                (0.2, 1.22),
                (0.09, 1.24),
                (0.07, 1.5),
                (0.13, 1.56),
                (0.16, 1.66),
                (0.0, 1.78),
            ],
            40,
        );
        b.with_material(p.water);
        b.lathe(&[(1.34, 0.48), (0.0, 0.48)], 40);
        b.lathe(&[(0.68, 1.3), (0.1, 1.3)], 32);
    });
    for (i, (x, z, yaw)) in
        [(-3.2, 8.6, FRAC_PI_2), (3.2, -2.6, -FRAC_PI_2), (-3.2, -2.6, FRAC_PI_2)].into_iter().enumerate()
    {
        b.object(&format!("bench {i}")).with_material(p.red_marble);
        b.within(placed(vec3(x, 0.0, z), yaw), |b| {
            b.beveled_cuboid(vec3(-0.8, 0.42, -0.22), vec3(0.8, 0.5, 0.22), 0.02);
            b.with_material(p.trim);
            for x in [-0.6, 0.6] {
                b.beveled_cuboid(vec3(x - 0.09, 0.0, -0.18), vec3(x + 0.09, 0.42, 0.18), 0.03);
            }
        });
    }
    // Ropes with pennants across the court.
    for i in 0..3 {
        let z = 9.0 - 9.0 * i as f32;
        let (a, c) = (vec3(-COURT.x + 0.3, 8.7, z), vec3(COURT.x - 0.3, 8.7, z));
        b.object(&format!("rope {i}")).with_material(p.rope).wire(a, c, 0.7, 0.015, 30);
        for k in 1..20 {
            let t = k as f32 / 20.0;
            let at = super::build::hanging(a, c, 0.7, t);
            b.with_material(p.curtains[(k + i) % 3]);
            let half = 0.13;
            b.fan(
                &[at - Vec3::X * half, at + vec3(0.0, -0.42, around(rng, 0.0, 0.06)), at + Vec3::X * half],
                Vec3::Z,
            );
        }
    }
    [-9.0, 0.0, 9.0]
        .map(|z| PointLight { position: vec3(0.0, 4.4, z), color: vec3(1.6, 1.45, 1.2), range: 9.0 })
        .to_vec()
}

fn vase(b: &mut SceneBuilder, p: &Palette, kind: usize, rng: &mut Pcg32) {
    b.with_material([p.terracotta, p.ceramic[0], p.terracotta][kind % 3]);
    b.lathe(
        &[
            (0.2, 0.0),
            (0.22, 0.03),
            (0.22, 0.07),
            (0.17, 0.12),
            (0.24, 0.26),
            (0.34, 0.48),
            (0.35, 0.6),
            (0.29, 0.72),
            (0.27, 0.76),
            (0.33, 0.8),
            (0.34, 0.84),
            (0.34, 0.84),
            (0.3, 0.84),
            (0.3, 0.84),
            (0.26, 0.76),
        ],
        36,
    );
    b.with_material(p.soil).lathe(&[(0.27, 0.78), (0.0, 0.79)], 24);
    b.within(moved(0.0, 0.78, 0.0), |b| match kind % 3 {
        0 => fronds(b, p.frond, 26, 1.0, 0.13, rng),
        1 => props::bush(b, [p.stem, p.leaves], 0.45, 0.8, 420, rng),
        _ => {
            fronds(b, p.frond, 34, 0.75, 0.06, rng);
            props::bush(b, [p.stem, p.leaves], 0.35, 0.4, 160, rng);
        }
    });
}
