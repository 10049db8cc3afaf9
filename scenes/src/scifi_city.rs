//! A street between towers at night, all neon, in place of SciFiCity.
//!
//! The street runs along -z with its middle at x = 0; facades are at x = -9 and x = 9. A monorail hangs over the
//! street, bridges cross it, and vehicles fly above.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Affine3A, Vec2, Vec3, vec2, vec3};
use rand::Rng;
use rand_pcg::Pcg32;

use super::build::{BoxFaces, Railing, SceneBuilder, around, moved, placed, random, viewpoints};
use super::paint;
use super::props::{
    self, glass, glowing, metal, palette, pictured, plain, textured, tube_text, tube_text_width,
};
use yoro_assets::{PointLight, Scene, Sky, Viewpoint};

const FACADES: f32 = 9.0;
const ROAD: f32 = 5.0;
const PAVEMENT: f32 = 0.15;
/// Height up to which facades are modelled panel by panel.
const DETAILED: f32 = 21.0;

#[derive(Clone, Copy)]
struct Neon {
    material: usize,
    color: Vec3,
}

/// Generates the scene.
pub fn build(seed: u64, mut b: SceneBuilder) -> Scene {
    let p = palette(&mut b, seed);
    let mut lights = Vec::new();
    ground(&mut b, &p, &mut random(seed, "ground"));
    towers(&mut b, &p, &mut random(seed, "towers"));
    lights.extend(noodle_bar(&mut b, &p, &mut random(seed, "noodle bar")));
    lights.extend(signs(&mut b, &p, &mut random(seed, "signs")));
    lights.extend(street_furniture(&mut b, &p, &mut random(seed, "furniture")));
    cables(&mut b, &p, &mut random(seed, "cables"));
    bridges(&mut b, &p, &mut random(seed, "bridges"));
    monorail(&mut b, &p);
    traffic(&mut b, &p, &mut random(seed, "traffic"));
    let sky = Sky {
        sun_direction: vec3(-0.35, 0.8, 0.3).normalize(),
        sun_color: vec3(0.4, 0.5, 0.8),
        zenith: vec3(0.06, 0.07, 0.16),
        horizon: vec3(0.26, 0.14, 0.3),
        ground: vec3(0.14, 0.1, 0.15),
    };
    lights.truncate(24);
    Scene { model: b.finish(), sky, lights, viewpoints: walk(), ..Scene::default() }
}

/// Returns a walk from the middle of the street to the pavement, past the noodle bar and along the railing.
fn walk() -> Vec<Viewpoint> {
    viewpoints(&[
        ([-0.6, 1.65, 9.0], [1.5, 3.8, -12.0]),
        ([0.6, 1.65, 7.0], [3.2, 3.4, -12.0]),
        ([2.0, 1.65, 5.1], [4.8, 2.8, -11.0]),
        ([3.6, 1.65, 3.4], [6.2, 2.3, -9.0]),
        ([5.0, 1.76, 1.6], [7.0, 1.8, -8.0]),
        ([5.8, 1.78, -0.6], [7.3, 1.6, -9.5]),
        ([6.05, 1.72, -2.8], [7.2, 1.5, -11.0]),
        ([6.1, 1.62, -4.8], [6.7, 1.6, -13.5]),
        ([6.1, 1.6, -6.8], [5.6, 1.8, -17.0]),
        ([6.05, 1.68, -8.8], [4.2, 2.4, -21.0]),
        ([5.95, 1.75, -10.9], [2.6, 3.2, -25.0]),
        ([5.9, 1.78, -13.0], [1.0, 4.2, -29.0]),
        ([5.9, 1.78, -15.0], [-0.8, 5.4, -33.0]),
    ])
}

palette! {
    fn palette(b: &mut SceneBuilder, seed: u64) -> Palette {
        let s = seed as u32;
        let panel = |b: &mut SceneBuilder, name: &str, k: u32, color: Vec3, grid: [u32; 2]| {
            let id = textured(b, paint::metal_panels(name, 512, s + k, color, grid), 1.6, 0.42);
            b.edit_material(id, |m| m.specular = Vec3::splat(0.4));
            id
        };
        let panels = [
            panel(b, "panels-blue", 0, vec3(0.25, 0.29, 0.36), [2, 3]),
            panel(b, "panels-grey", 1, vec3(0.36, 0.35, 0.36), [3, 2]),
            panel(b, "panels-brown", 2, vec3(0.36, 0.28, 0.23), [2, 2]),
        ];
        let facades = [
            ("facade-a", vec3(0.2, 0.22, 0.28), [5, 6], 0.34),
            ("facade-b", vec3(0.27, 0.24, 0.25), [8, 5], 0.22),
            ("facade-c", vec3(0.16, 0.19, 0.24), [4, 8], 0.42),
        ]
        .map(|(name, color, grid, lit)| {
            let painted = paint::facade(name, 512, s + grid[0], color, vec3(0.08, 0.1, 0.14), grid, lit);
            let emissive = b.texture(painted.emissive);
            let id = textured(b, paint::Surface { color: painted.color, normal: painted.normal }, 19.0, 0.4);
            b.edit_material(id, |m| {
                m.emissive = Vec3::splat(1.1);
                m.emissive_map = Some(emissive);
            });
            id
        });
        // Rain fills the hollows of the asphalt, which are smooth and dark; between them it is grainy.
        let wet = paint::surface("wet-asphalt", [1024, 1024], 0.0012, |uv| {
            let grain = paint::fbm(s + 3, glam::UVec2::splat(128), 2, uv);
            let hollow = paint::fbm(s + 13, glam::UVec2::splat(4), 4, uv);
            let dry = paint::smoothstep(0.42, 0.58, hollow);
            (Vec3::splat(0.09).lerp(vec3(0.2, 0.2, 0.22) * (0.7 + 0.6 * grain), dry), dry * (0.3 + grain))
        });
        let street = textured(b, wet, 5.0, 0.17);
        let pavement = paint::tiles("pavement", 512, s + 4, [vec3(0.27, 0.27, 0.3), vec3(0.22, 0.22, 0.25)], 6);
        let pavement = textured(b, pavement, 3.0, 0.28);
        for id in [street, pavement] {
            b.edit_material(id, |m| m.specular = Vec3::splat(0.42));
        }
        let puddle = plain(b, "puddle", vec3(0.05, 0.055, 0.075), 0.07);
        b.edit_material(puddle, |m| m.specular = Vec3::splat(0.5));
        let neon = [
            ("neon-pink", vec3(1.0, 0.15, 0.55)),
            ("neon-cyan", vec3(0.1, 0.85, 1.0)),
            ("neon-amber", vec3(1.0, 0.55, 0.1)),
            ("neon-violet", vec3(0.6, 0.25, 1.0)),
            ("neon-green", vec3(0.25, 1.0, 0.45)),
        ]
        .map(|(name, color)| Neon { material: glowing(b, name, color, 1.7), color });
        let boards = [
            ("sign-hotel", "HOTEL 9", vec3(1.0, 0.3, 0.6), vec3(0.1, 0.02, 0.08)),
            ("sign-data", "DATA BANK", vec3(0.3, 0.9, 1.0), vec3(0.02, 0.06, 0.12)),
            ("sign-ramen", "RAMEN", vec3(1.0, 0.85, 0.4), vec3(0.35, 0.03, 0.03)),
            ("sign-clinic", "CLINIC", vec3(0.5, 1.0, 0.6), vec3(0.02, 0.1, 0.05)),
            ("sign-metro", "METRO 7", vec3(1.0, 1.0, 1.0), vec3(0.1, 0.15, 0.5)),
            ("sign-arcade", "ARCADE", vec3(1.0, 0.9, 0.3), vec3(0.25, 0.05, 0.4)),
            ("sign-motors", "HOVER CO", vec3(1.0, 0.6, 0.2), vec3(0.06, 0.05, 0.05)),
            ("sign-vr", "DREAM VR", vec3(0.8, 0.5, 1.0), vec3(0.06, 0.02, 0.14)),
        ];
        let signs = boards.map(|(name, text, ink, ground)| {
            pictured(b, paint::sign(name, [512, 128], text, ink, ground), 0.4, 1.6)
        });
        let screens = [
            ("advert-a", vec3(0.2, 0.9, 1.0), "NEURAL LINK"),
            ("advert-b", vec3(1.0, 0.35, 0.6), "FLY TONIGHT"),
            ("advert-c", vec3(0.5, 1.0, 0.5), "GREEN FOOD"),
        ]
        .map(|(name, color, title)| pictured(b, paint::screen(name, [512, 320], s + 6, color, title), 0.3, 1.4));
        let shutter = paint::surface("shutter", [256, 256], 0.02, |uv| {
            let wave = (uv.y * 16.0 * TAU).sin() * 0.5 + 0.5;
            let dirt = paint::fbm(s + 7, glam::UVec2::splat(5), 5, uv);
            (vec3(0.36, 0.36, 0.38) * (0.6 + 0.3 * wave + 0.35 * (dirt - 0.5)), wave)
        });
        let stripe = paint::surface("hazard", [128, 128], 0.002, |uv| {
            let on = ((uv.x + uv.y) * 4.0).fract() < 0.5;
            (if on { vec3(0.8, 0.62, 0.08) } else { vec3(0.08, 0.08, 0.08) }, 0.0)
        });
        let cloth = textured(b, paint::fabric("awning", 256, s + 8, vec3(0.55, 0.1, 0.1), 40), 0.5, 0.8);
        b.edit_material(cloth, |m| m.double_sided = true);
    }
    panels: [usize; 3] = panels,
    facades: [usize; 3] = facades,
    street = street,
    pavement = pavement,
    curb = textured(b, paint::concrete("concrete", 512, s + 5, vec3(0.36, 0.36, 0.38)), 2.4, 0.5),
    puddle = puddle,
    dark = plain(b, "dark", vec3(0.07, 0.07, 0.08), 0.45),
    steel = metal(b, "steel", vec3(0.5, 0.52, 0.56), 0.28),
    rust = metal(b, "rust", vec3(0.4, 0.24, 0.16), 0.6),
    copper = metal(b, "copper", vec3(0.6, 0.36, 0.24), 0.35),
    rubber = plain(b, "rubber", vec3(0.06, 0.06, 0.06), 0.7),
    neon: [Neon; 5] = neon,
    lamp: Neon = Neon { material: glowing(b, "lamp", vec3(0.85, 0.93, 1.0), 1.8), color: vec3(0.75, 0.88, 1.0) },
    lantern: Neon = Neon {
        material: glowing(b, "lantern", vec3(1.0, 0.4, 0.16), 1.35),
        color: vec3(1.0, 0.4, 0.15),
    },
    red_light = glowing(b, "red-light", vec3(1.0, 0.08, 0.06), 1.8),
    window = glowing(b, "lit-window", vec3(1.0, 0.78, 0.45), 1.0),
    signs: Vec<usize> = signs.to_vec(),
    screens: [usize; 3] = screens,
    shutter = textured(b, shutter, 1.4, 0.5),
    wood = textured(b, paint::planks("wood", 256, s + 9, vec3(0.4, 0.25, 0.14), 5), 0.8, 0.5),
    cloth = cloth,
    china = plain(b, "china", vec3(0.85, 0.84, 0.8), 0.2),
    broth = plain(b, "broth", vec3(0.5, 0.3, 0.12), 0.2),
    crate_ = plain(b, "crate", vec3(0.2, 0.33, 0.36), 0.55),
    pane = glass(b, "pane", vec3(0.3, 0.5, 0.6), 0.25),
    hulls: [usize; 3] = [
        plain(b, "hull-yellow", vec3(0.75, 0.52, 0.1), 0.25),
        plain(b, "hull-white", vec3(0.68, 0.7, 0.72), 0.22),
        plain(b, "hull-teal", vec3(0.1, 0.38, 0.4), 0.22),
    ],
    leaves = props::foliage(b, "leaves", seed, vec3(0.2, 0.42, 0.2)),
    stripe = textured(b, stripe, 0.6, 0.6),
}

fn ground(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    b.object("street").with_material(p.street);
    b.height_field(10, 20, vec2(-ROAD, -110.0), vec2(ROAD, 40.0), |x, _| 0.05 * (1.0 - (x / ROAD).powi(2)));
    b.object("far street");
    b.height_field(1, 1, vec2(-90.0, -420.0), vec2(90.0, -110.0), |_, _| 0.0);
    for (name, x0, x1) in [("left", -FACADES - 14.0, -ROAD - 0.2), ("right", ROAD + 0.2, FACADES + 14.0)] {
        b.object(&format!("{name} pavement")).with_material(p.pavement);
        b.height_field(1, 1, vec2(x0, -110.0), vec2(x1, 40.0), |_, _| PAVEMENT);
        b.object(&format!("{name} curb"));
        let (low, high) = if x0 < 0.0 { (-ROAD - 0.2, -ROAD) } else { (ROAD, ROAD + 0.2) };
        let mut z = 20.0;
        while z > -90.0 {
            b.with_material(p.curb);
            b.beveled_cuboid(vec3(low, -0.1, z - 1.48), vec3(high, PAVEMENT + 0.01, z), 0.02);
            b.with_material(p.neon[if x0 < 0.0 { 0 } else { 1 }].material);
            let x = if x0 < 0.0 { high } else { low };
            let out = if x0 < 0.0 { 0.012 } else { -0.012 };
            if (z as i32) % 3 == 0 {
                b.cuboid(vec3(x.min(x + out), 0.05, z - 1.1), vec3(x.max(x + out), 0.075, z - 0.4));
            }
            z -= 1.5;
        }
    }
    b.object("road marks").with_material(p.neon[2].material);
    for i in 0..28 {
        let z = 12.0 - 3.6 * i as f32;
        b.rectangle(vec3(-0.06, 0.054, z), Vec3::X * 0.12, Vec3::NEG_Z * 1.5);
    }
    b.object("puddles").with_material(p.puddle);
    for _ in 0..46 {
        let (x, z) = (around(rng, 0.0, 4.6), around(rng, -22.0, 34.0));
        let height = 0.05 * (1.0 - (x / ROAD).powi(2)) + 0.008;
        let size = vec2(around(rng, 0.7, 0.4), around(rng, 0.5, 0.3));
        let phase = rng.random::<f32>() * TAU;
        let rim: Vec<Vec3> = (0..28)
            .map(|k| {
                let turn = k as f32 / 28.0 * TAU;
                let reach = 1.0 + 0.2 * (turn * 3.0 + phase).sin() + 0.1 * (turn * 5.0).cos();
                vec3(x + turn.cos() * size.x * reach, height, z + turn.sin() * size.y * reach)
            })
            .collect();
        b.fan(&rim, Vec3::Y);
    }
    for (i, (x, z)) in [(-1.8, 4.0), (2.4, -9.0), (-2.2, -21.0), (1.5, -34.0)].into_iter().enumerate() {
        b.object(&format!("manhole {i}")).with_material(p.steel);
        b.within(moved(x, 0.045, z), |b| {
            b.lathe(&[(0.42, 0.0), (0.42, 0.02), (0.42, 0.02), (0.36, 0.022), (0.36, 0.01), (0.0, 0.01)], 32);
            for k in 0..12 {
                b.within(Affine3A::from_rotation_y(k as f32 / 12.0 * TAU), |b| {
                    b.cuboid(vec3(-0.014, 0.01, 0.08), vec3(0.014, 0.021, 0.33));
                });
            }
        });
    }
}

fn towers(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    let mut number = 0;
    for side in [-1.0_f32, 1.0] {
        let mut z = 24.0;
        while z > -100.0 {
            let width = around(rng, 14.0, 2.0);
            let height = around(rng, 62.0, 26.0);
            let frame = if side > 0.0 {
                placed(vec3(FACADES, 0.0, z - width), -FRAC_PI_2)
            } else {
                placed(vec3(-FACADES, 0.0, z), FRAC_PI_2)
            };
            b.within(frame, |b| tower(b, p, number, [width, height], z, rng));
            number += 1;
            // Sometimes there is a lane between two towers.
            z -= width + if rng.random_bool(0.35) { 2.4 } else { 0.0 };
        }
    }
    // The skyline.
    for i in 0..46 {
        let side = if i % 2 == 0 { -1.0 } else { 1.0 };
        let center = i % 5 == 4;
        let x = if center { around(rng, 0.0, 30.0) } else { side * around(rng, 56.0, 30.0) };
        let z = if center { around(rng, -230.0, 50.0) } else { around(rng, -110.0, 110.0) };
        let size = vec3(around(rng, 19.0, 6.0), around(rng, 95.0, 50.0), around(rng, 19.0, 6.0));
        b.object(&format!("skyline {i}"));
        skyline_tower(b, p, vec3(x, 0.0, z), size, rng);
    }
}

/// Builds a distant tower: stacked boxes with lit windows, edges of light, an aerial.
fn skyline_tower(b: &mut SceneBuilder, p: &Palette, at: Vec3, size: Vec3, rng: &mut Pcg32) {
    let mut y = 0.0;
    let mut half = vec2(size.x, size.z) * 0.5;
    let facade = p.facades[rng.random_range(0..3)];
    let glow = p.neon[rng.random_range(0..5)].material;
    for step in 0..3 {
        let top = size.y * [0.55, 0.85, 1.0][step];
        let (min, max) = (at + vec3(-half.x, y, -half.y), at + vec3(half.x, top, half.y));
        b.with_material(facade);
        b.set_uv_offset(vec2(rng.random::<f32>() * 19.0, rng.random::<f32>() * 19.0));
        b.cuboid_faces(min, max, BoxFaces::STANDING.without(BoxFaces::TOP));
        b.set_uv_offset(Vec2::ZERO);
        b.with_material(p.panels[0]).cuboid_faces(min, max, BoxFaces::TOP);
        b.beveled_cuboid(
            vec3(min.x - 0.4, top - 0.8, min.z - 0.4),
            vec3(max.x + 0.4, top + 0.3, max.z + 0.4),
            0.2,
        );
        if step == 0 || rng.random_bool(0.5) {
            b.with_material(glow);
            for (x, z) in [(min.x, min.z), (max.x, min.z), (min.x, max.z), (max.x, max.z)] {
                b.cuboid(vec3(x - 0.14, y, z - 0.14), vec3(x + 0.14, top - 1.0, z + 0.14));
            }
        }
        y = top;
        half *= around(rng, 0.7, 0.1);
    }
    b.with_material(p.dark);
    let mast = at + Vec3::Y * size.y;
    b.cylinder(mast, mast + Vec3::Y * 13.0, 0.25, 0.06, 8, false);
    b.with_material(p.red_light).ellipsoid(mast + Vec3::Y * 13.1, Vec3::splat(0.35), 6, 10);
}

/// Builds a tower at the street, in a frame seen from it: x to the right, y up, facade at z = 0.
fn tower(
    b: &mut SceneBuilder,
    p: &Palette,
    number: usize,
    [width, height]: [f32; 2],
    near: f32,
    rng: &mut Pcg32,
) {
    let depth = 13.0;
    let base = 3.9;
    b.object(&format!("tower {number} core")).with_material(p.panels[number % 3]);
    b.cuboid_faces(
        vec3(0.0, 0.0, -depth),
        vec3(width, DETAILED, -0.25),
        BoxFaces::LEFT.and(BoxFaces::RIGHT).and(BoxFaces::FRONT).and(BoxFaces::BACK),
    );
    // Panels may be larger far from the walk.
    let coarse = !(-48.0..=16.0).contains(&near);
    let mut y = base;
    let mut floor = 0;
    while y < DETAILED - 1.0 {
        let top = (y + around(rng, 3.6, 0.5)).min(DETAILED);
        b.object(&format!("tower {number} floor {floor}"));
        panel_wall(b, p, number, [vec2(0.0, y), vec2(width, top - 0.25)], coarse, rng);
        b.with_material(p.panels[(number + 1) % 3]);
        b.beveled_cuboid(
            vec3(-0.02, top - 0.25, -0.3),
            vec3(width + 0.02, top, around(rng, 0.24, 0.12)),
            0.04,
        );
        if rng.random_bool(0.28) {
            let neon = p.neon[rng.random_range(0..5)];
            b.with_material(neon.material);
            b.tube(&[vec3(0.2, top - 0.32, 0.14), vec3(width - 0.2, top - 0.32, 0.14)], 0.025, 8, true);
        }
        y = top;
        floor += 1;
    }
    b.object(&format!("tower {number} ribs"));
    let ribs = (width / 4.5) as usize;
    for i in 0..=ribs {
        let x = (i as f32 * width / ribs as f32).clamp(0.2, width - 0.2);
        b.with_material(p.panels[(number + 2) % 3]);
        b.beveled_cuboid(vec3(x - 0.18, base, -0.3), vec3(x + 0.18, DETAILED, 0.42), 0.06);
        if i % 2 == 0 {
            b.with_material(p.neon[(number + i) % 5].material);
            b.cuboid(vec3(x - 0.02, base + 1.0, 0.42), vec3(x + 0.02, DETAILED - 2.0, 0.435));
        }
    }
    for _ in 0..if coarse { 2 } else { 7 } {
        let at = vec3(around(rng, width * 0.5, width * 0.42), around(rng, 9.5, 5.0), 0.12);
        b.object(&format!("tower {number} air conditioners"));
        b.within(moved(at.x, at.y, at.z), |b| air_conditioner(b, p, if coarse { 10 } else { 18 }));
    }
    b.object(&format!("tower {number} pipes"));
    for i in 0..5 {
        let x = around(rng, width * 0.5, width * 0.46);
        pipe(b, p, vec3(x, 0.2 + PAVEMENT, 0.52 + 0.05 * (i % 3) as f32), around(rng, 12.0, 6.0), rng);
    }
    shops(b, p, number, width, base, rng);
    // The shaft above.
    b.object(&format!("tower {number} shaft"));
    let mut y = DETAILED;
    let mut inset = 0.4;
    for step in 0..3 {
        let top = DETAILED + (height - DETAILED) * [0.5, 0.8, 1.0][step];
        let (min, max) = (vec3(inset, y, -depth), vec3(width - inset, top, -inset));
        b.with_material(p.facades[number % 3]);
        b.set_uv_offset(vec2(rng.random::<f32>() * 19.0, rng.random::<f32>() * 19.0));
        b.cuboid_faces(min, max, BoxFaces::STANDING);
        b.set_uv_offset(Vec2::ZERO);
        b.with_material(p.panels[number % 3]);
        b.beveled_cuboid(vec3(min.x - 0.3, top - 0.9, -depth), vec3(max.x + 0.3, top, max.z + 0.4), 0.15);
        let fins = (width / 3.2) as usize;
        for k in 0..=fins {
            let x = min.x + (max.x - min.x) * k as f32 / fins as f32;
            b.beveled_cuboid(vec3(x - 0.12, y, max.z - 0.1), vec3(x + 0.12, top, max.z + 0.35), 0.05);
        }
        y = top;
        inset += around(rng, 1.5, 0.5);
    }
    b.with_material(p.dark);
    for _ in 0..4 {
        let at = vec3(around(rng, width * 0.5, 2.5), height, around(rng, -6.0, 2.5));
        let tall = around(rng, 6.0, 3.0);
        b.cylinder(at, at + Vec3::Y * tall, 0.09, 0.03, 6, false);
        b.with_material(p.red_light).ellipsoid(at + Vec3::Y * tall, Vec3::splat(0.14), 6, 10);
        b.with_material(p.dark);
    }
}

/// Splits a wall into panels of different depth, with vents, lit windows and lamps among them.
fn panel_wall(
    b: &mut SceneBuilder,
    p: &Palette,
    number: usize,
    [min, max]: [Vec2; 2],
    coarse: bool,
    rng: &mut Pcg32,
) {
    let size = max - min;
    let limit = if coarse { 3.0 } else { 1.75 };
    if size.max_element() > limit {
        let share = around(rng, 0.5, 0.18);
        let cut = if size.x > size.y { vec2(size.x * share, size.y) } else { vec2(size.x, size.y * share) };
        panel_wall(b, p, number, [min, min + cut], coarse, rng);
        let rest = if size.x > size.y { vec2(min.x + cut.x, min.y) } else { vec2(min.x, min.y + cut.y) };
        panel_wall(b, p, number, [rest, max], coarse, rng);
        return;
    }
    let gap = 0.018;
    let out = around(rng, 0.06, 0.055) - 0.05;
    let (low, high) = (vec3(min.x + gap, min.y + gap, -0.26), vec3(max.x - gap, max.y - gap, out));
    let kind = rng.random_range(0..100);
    let panel = p.panels[if rng.random_bool(0.7) { number % 3 } else { rng.random_range(0..3) }];
    b.set_uv_offset(vec2(rng.random::<f32>() * 1.6, rng.random::<f32>() * 1.6));
    b.with_material(panel).beveled_cuboid(low, high, 0.022);
    b.set_uv_offset(Vec2::ZERO);
    let (w, h) = (high.x - low.x, high.y - low.y);
    if w < 0.35 || h < 0.35 {
        return;
    }
    let inner = |x: f32, y: f32, z: f32| vec3(low.x + w * x, low.y + h * y, out + z);
    match kind {
        0..=15 => {
            b.with_material(p.window);
            b.cuboid(inner(0.16, 0.2, 0.0), inner(0.84, 0.84, 0.012));
            b.with_material(p.dark);
            for y in [0.36, 0.52, 0.68] {
                b.cuboid(inner(0.14, y, 0.0), inner(0.86, y + 0.03, 0.03));
            }
            b.beveled_cuboid(inner(0.1, 0.13, 0.0), inner(0.9, 0.2, 0.07), 0.01);
        }
        16..=31 => {
            b.with_material(p.dark);
            b.cuboid(inner(0.12, 0.12, 0.0), inner(0.88, 0.88, 0.006));
            b.with_material(p.steel);
            let slats = 7;
            for k in 0..slats {
                let y = 0.14 + 0.74 * k as f32 / slats as f32;
                let (a, c) = (inner(0.12, y, 0.012), inner(0.88, y + 0.07, 0.05));
                b.quad([a, vec3(c.x, a.y, a.z), c, vec3(a.x, c.y, c.z)]);
                b.quad([vec3(c.x, a.y, a.z - 0.004), vec3(a.x, a.y, a.z - 0.004), vec3(a.x, c.y, c.z), c]);
            }
        }
        32..=41 => {
            b.with_material(p.steel);
            b.beveled_cuboid(inner(0.25, 0.25, 0.0), inner(0.75, 0.75, 0.14), 0.02);
            b.with_material(p.neon[rng.random_range(0..5)].material);
            b.cuboid(inner(0.32, 0.62, 0.14), inner(0.42, 0.68, 0.148));
            b.cuboid(inner(0.46, 0.62, 0.14), inner(0.56, 0.68, 0.148));
        }
        42..=52 => {
            b.with_material(p.rust);
            for x in [0.12, 0.88] {
                for y in [0.12, 0.88] {
                    let at = inner(x, y, 0.0);
                    b.cylinder(at, at + Vec3::Z * 0.02, 0.022, 0.018, 8, true);
                }
            }
        }
        53..=58 => {
            b.with_material(p.stripe);
            b.rectangle(inner(0.08, 0.08, 0.004), Vec3::X * w * 0.84, Vec3::Y * h * 0.16);
        }
        _ => {}
    }
}

fn air_conditioner(b: &mut SceneBuilder, p: &Palette, sides: usize) {
    b.with_material(p.panels[1]);
    b.beveled_cuboid(vec3(-0.48, -0.34, -0.1), vec3(0.48, 0.34, 0.42), 0.03);
    b.with_material(p.dark);
    b.within(moved(0.0, 0.0, 0.42) * Affine3A::from_rotation_x(FRAC_PI_2), |b| {
        b.lathe(&[(0.29, 0.0), (0.29, 0.035), (0.26, 0.04), (0.26, 0.01), (0.0, 0.01)], sides);
        b.with_material(p.steel);
        for k in 0..5 {
            b.within(Affine3A::from_rotation_y(k as f32 / 5.0 * TAU), |b| {
                b.cuboid(vec3(-0.035, 0.012, 0.03), vec3(0.05, 0.02, 0.24));
            });
        }
        for radius in [0.08_f32, 0.16, 0.24] {
            let ring: Vec<Vec3> = (0..=sides)
                .map(|k| {
                    let (sin, cos) = (k as f32 / sides as f32 * TAU).sin_cos();
                    vec3(cos * radius, 0.045, sin * radius)
                })
                .collect();
            b.tube(&ring, 0.005, 4, false);
        }
        for k in 0..4 {
            let (sin, cos) = (k as f32 / 4.0 * PI).sin_cos();
            let out = vec3(cos, 0.0, sin) * 0.28;
            b.tube(&[out + Vec3::Y * 0.05, -out + Vec3::Y * 0.05], 0.005, 4, false);
        }
    });
    b.with_material(p.dark);
    for x in [-0.38, 0.38] {
        b.tube(&[vec3(x, -0.36, 0.4), vec3(x, -0.36, -0.15), vec3(x, -0.7, -0.15)], 0.018, 6, true);
    }
    b.with_material(p.rubber);
    b.tube(
        &[vec3(0.4, -0.3, 0.1), vec3(0.46, -0.6, 0.05), vec3(0.42, -1.4, 0.02), vec3(0.42, -2.2, 0.02)],
        0.022,
        6,
        false,
    );
}

/// Builds a pipe up a wall that bends into it, with flanges and brackets.
fn pipe(b: &mut SceneBuilder, p: &Palette, foot: Vec3, height: f32, rng: &mut Pcg32) {
    let radius = [0.05, 0.08, 0.12][rng.random_range(0..3)];
    let jog = around(rng, 0.7, 0.25) * if rng.random_bool(0.5) { 1.0 } else { -1.0 };
    let middle = height * around(rng, 0.5, 0.2);
    b.with_material([p.rust, p.copper, p.steel][rng.random_range(0..3)]);
    let corners = [
        foot,
        foot + Vec3::Y * middle,
        foot + vec3(jog, middle + jog.abs(), 0.0),
        foot + vec3(jog, height, 0.0),
        foot + vec3(jog, height, -0.7),
    ];
    let mut path = vec![corners[0]];
    for k in 1..corners.len() - 1 {
        let [a, c, e] = [corners[k - 1], corners[k], corners[k + 1]];
        let cut = 0.22_f32.min(a.distance(c) * 0.4).min(c.distance(e) * 0.4);
        let (start, end) = (c + (a - c).normalize_or_zero() * cut, c + (e - c).normalize_or_zero() * cut);
        path.extend((0..=4).map(|i| {
            let t = i as f32 / 4.0;
            start.lerp(c, t).lerp(c.lerp(end, t), t)
        }));
    }
    path.push(corners[4]);
    b.tube(&path, radius, 10, false);
    let mut y = 0.6;
    while y < middle - 0.2 {
        let at = foot + Vec3::Y * y;
        b.cylinder(at, at + Vec3::Y * 0.06, radius * 1.35, radius * 1.35, 12, true);
        b.cuboid(at + vec3(-0.02, 0.0, -0.5), at + vec3(0.02, 0.04, 0.0));
        y += 1.7;
    }
}

/// Builds the ground floor: doors, roller shutters, lit windows and machines.
fn shops(b: &mut SceneBuilder, p: &Palette, number: usize, width: f32, base: f32, rng: &mut Pcg32) {
    let bays = (width / 3.6) as usize;
    let step = width / bays as f32;
    b.object(&format!("tower {number} shops"));
    b.with_material(p.panels[number % 3]);
    b.beveled_cuboid(vec3(0.01, base - 0.7, -0.3), vec3(width - 0.01, base, 0.3), 0.05);
    for i in 0..=bays {
        let x = (i as f32 * step).clamp(0.3, width - 0.3);
        b.with_material(p.panels[(number + 1) % 3]);
        b.beveled_cuboid(vec3(x - 0.28, 0.0, -0.3), vec3(x + 0.28, base - 0.65, 0.22), 0.05);
        b.with_material(p.stripe);
        b.rectangle(vec3(x - 0.22, 0.35, 0.223), Vec3::X * 0.44, Vec3::Y * 0.18);
    }
    for i in 0..bays {
        let (x0, x1) = (i as f32 * step + 0.28, (i + 1) as f32 * step - 0.28);
        let (w, top) = (x1 - x0, base - 0.7);
        match rng.random_range(0..4) {
            0 => {
                b.with_material(p.shutter);
                b.rectangle(vec3(x0, 0.1, -0.2), Vec3::X * w, Vec3::Y * (top - 0.1));
                b.with_material(p.steel);
                b.beveled_cuboid(vec3(x0, 0.1, -0.22), vec3(x1, 0.28, -0.14), 0.02);
                b.with_material(p.dark);
                b.cylinder(vec3(x0, top - 0.16, -0.1), vec3(x1, top - 0.16, -0.1), 0.16, 0.16, 16, false);
            }
            1 => {
                b.with_material(p.screens[rng.random_range(0..3)]);
                let (l, r, low, high) = (x0 + 0.1, x1 - 0.1, 0.7, top - 0.25);
                b.picture([
                    vec3(l, low, -0.14),
                    vec3(r, low, -0.14),
                    vec3(r, high, -0.14),
                    vec3(l, high, -0.14),
                ]);
                b.with_material(p.dark);
                for (a, c, y0, y1) in
                    [(x0, x1, 0.6, 0.7), (x0, x1, top - 0.25, top), (x0, l, 0.6, top), (r, x1, 0.6, top)]
                {
                    b.beveled_cuboid(vec3(a, y0, -0.25), vec3(c, y1, -0.08), 0.015);
                }
                b.with_material(p.panels[2]).beveled_cuboid(vec3(x0, 0.0, -0.25), vec3(x1, 0.6, 0.05), 0.03);
            }
            2 => {
                // A sliding door with a lit frame.
                b.with_material(p.panels[0]);
                b.cuboid(vec3(x0, 0.0, -0.26), vec3(x1, top, -0.2));
                let middle = (x0 + x1) * 0.5;
                b.with_material(p.steel);
                for (a, c) in [(middle - 0.85, middle - 0.015), (middle + 0.015, middle + 0.85)] {
                    b.beveled_cuboid(vec3(a, 0.12, -0.2), vec3(c, 2.4, -0.14), 0.02);
                    b.beveled_cuboid(vec3(a + 0.12, 1.2, -0.15), vec3(c - 0.12, 2.1, -0.11), 0.02);
                }
                b.with_material(p.neon[(number + i) % 5].material);
                let (l, r) = (middle - 0.95, middle + 0.95);
                b.tube(
                    &[vec3(l, 0.15, -0.15), vec3(l, 2.52, -0.15), vec3(r, 2.52, -0.15), vec3(r, 0.15, -0.15)],
                    0.025,
                    8,
                    true,
                );
            }
            _ => {
                // A shop window with goods on shelves.
                b.with_material(p.window);
                b.rectangle(vec3(x0, 0.8, -0.22), Vec3::X * w, Vec3::Y * (top - 0.8));
                b.with_material(p.panels[1]).beveled_cuboid(vec3(x0, 0.0, -0.25), vec3(x1, 0.8, 0.0), 0.03);
                b.with_material(p.dark);
                for k in 0..3 {
                    let y = 1.2 + 0.6 * k as f32;
                    b.with_material(p.dark).cuboid(vec3(x0, y, -0.22), vec3(x1, y + 0.03, -0.04));
                    for j in 0..(w / 0.32) as usize {
                        let at = vec3(x0 + 0.2 + 0.32 * j as f32, y + 0.03, -0.12);
                        b.with_material([p.dark, p.crate_, p.hulls[0], p.rust][rng.random_range(0..4)]);
                        if rng.random_bool(0.5) {
                            b.cuboid_on(at, vec3(around(rng, 0.14, 0.05), around(rng, 0.24, 0.1), 0.1));
                        } else {
                            let tall = around(rng, 0.26, 0.08);
                            b.cylinder(at, at + Vec3::Y * tall, 0.06, 0.04, 12, true);
                        }
                    }
                }
                b.with_material(p.pane).rectangle(vec3(x0, 0.8, 0.02), Vec3::X * w, Vec3::Y * (top - 0.8));
            }
        }
    }
}

/// Builds an open kitchen on the right pavement with stools, bowls and lanterns.
fn noodle_bar(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) -> Vec<PointLight> {
    let mut lights = Vec::new();
    let (near, far) = (-4.0, -10.5);
    let x = 7.75;
    b.object("noodle bar").with_material(p.wood);
    b.beveled_cuboid(vec3(x, PAVEMENT, far), vec3(x + 0.12, 1.1, near), 0.01);
    b.beveled_cuboid(vec3(x - 0.3, 1.1, far - 0.1), vec3(x + 0.35, 1.16, near + 0.1), 0.015);
    b.with_material(p.steel);
    b.beveled_cuboid(vec3(x + 0.75, PAVEMENT, far), vec3(FACADES - 0.1, 1.05, near), 0.02);
    for (z, radius) in [(-5.0, 0.2), (-5.7, 0.25), (-6.6, 0.22), (-8.4, 0.25), (-9.2, 0.18)] {
        b.within(moved(x + 0.95, 1.05, z), |b| {
            b.lathe(
                &[
                    (radius, 0.0),
                    (radius, 0.26),
                    (radius * 1.06, 0.27),
                    (radius * 1.06, 0.29),
                    (radius * 0.95, 0.29),
                    (radius * 0.95, 0.2),
                ],
                28,
            );
            b.tube(
                &[vec3(radius, 0.2, 0.0), vec3(radius + 0.1, 0.22, 0.0), vec3(radius + 0.2, 0.22, 0.0)],
                0.012,
                8,
                true,
            );
        });
    }
    b.with_material(p.dark);
    for z in [near, (near + far) * 0.5, far] {
        b.beveled_cuboid(vec3(x - 0.25, PAVEMENT, z - 0.05), vec3(x - 0.15, 2.75, z + 0.05), 0.012);
    }
    b.with_material(p.panels[2]);
    b.beveled_cuboid(vec3(x - 0.35, 2.75, far - 0.2), vec3(FACADES + 0.2, 2.85, near + 0.2), 0.03);
    b.with_material(p.wood);
    for k in 0..3 {
        let y = 1.55 + 0.38 * k as f32;
        b.cuboid(vec3(FACADES - 0.12, y, far + 0.2), vec3(FACADES + 0.2, y + 0.03, near - 0.2));
        for j in 0..20 {
            let at = vec3(FACADES - 0.0, y + 0.03, far + 0.4 + 0.3 * j as f32);
            b.with_material([p.china, p.hulls[0], p.rust, p.crate_][rng.random_range(0..4)]);
            let tall = around(rng, 0.2, 0.07);
            b.cylinder(at, at + Vec3::Y * tall, 0.055, 0.04, 12, true);
        }
        b.with_material(p.wood);
    }
    // Cloth strips over the counter.
    b.with_material(p.cloth);
    for k in 0..9 {
        let z = near - 0.1 - 0.72 * k as f32;
        b.curtain(vec3(x - 0.24, 2.72, z), vec3(x - 0.24, 2.72, z - 0.66), 0.5, 2.0, 0.02, [16, 8]);
    }
    for k in 0..6 {
        let z = near - 0.75 - 1.0 * k as f32;
        b.object(&format!("stool {k}"));
        b.within(moved(x - 0.62, PAVEMENT, z + around(rng, 0.0, 0.12)), |b| {
            b.with_material(p.steel);
            b.lathe(
                &[(0.19, 0.0), (0.19, 0.015), (0.05, 0.04), (0.025, 0.06), (0.025, 0.6), (0.05, 0.62)],
                20,
            );
            let ring: Vec<Vec3> = (0..=24)
                .map(|j| {
                    let (sin, cos) = (j as f32 / 24.0 * TAU).sin_cos();
                    vec3(cos * 0.16, 0.25, sin * 0.16)
                })
                .collect();
            b.tube(&ring, 0.009, 6, false);
            for j in 0..3 {
                let (sin, cos) = (j as f32 / 3.0 * TAU).sin_cos();
                b.tube(&[vec3(0.0, 0.25, 0.0), vec3(cos * 0.16, 0.25, sin * 0.16)], 0.007, 6, false);
            }
            b.with_material(p.cloth);
            b.lathe(&[(0.0, 0.61), (0.16, 0.62), (0.185, 0.645), (0.17, 0.675), (0.0, 0.69)], 24);
        });
        b.object(&format!("bowl {k}"));
        b.within(moved(x - 0.06, 1.16, z), |b| {
            b.with_material(p.china);
            b.lathe(
                &[
                    (0.05, 0.0),
                    (0.05, 0.012),
                    (0.08, 0.03),
                    (0.105, 0.08),
                    (0.105, 0.08),
                    (0.1, 0.078),
                    (0.07, 0.03),
                ],
                24,
            );
            b.with_material(p.broth).lathe(&[(0.093, 0.062), (0.0, 0.062)], 20);
            b.with_material(p.wood);
            b.cylinder(vec3(0.11, 0.085, -0.08), vec3(-0.08, 0.09, 0.12), 0.0035, 0.0025, 6, true);
            b.cylinder(vec3(0.12, 0.085, -0.06), vec3(-0.06, 0.09, 0.13), 0.0035, 0.0025, 6, true);
        });
        b.object(&format!("noodle lantern {k}"));
        let at = vec3(x - 0.5, 2.3, z - 0.1);
        b.within(Affine3A::from_translation(at), |b| paper_lantern(b, p));
        if k % 2 == 0 {
            lights.push(PointLight {
                position: at - Vec3::X * 0.25,
                color: p.lantern.color * 2.4,
                range: 4.5,
            });
        }
    }
    lights.push(PointLight { position: vec3(x + 0.7, 2.4, -7.2), color: vec3(4.6, 3.7, 2.6), range: 6.0 });
    b.object("noodle sign");
    let frame = placed(vec3(x - 0.4, 3.05, near - 0.9), -FRAC_PI_2)
        * moved(-tube_text_width("NOODLES", 0.62), 0.0, 0.0);
    b.within(frame, |b| neon_sign(b, p, p.neon[0], "NOODLES", 0.62));
    lights.push(PointLight { position: vec3(x - 0.9, 3.3, -6.2), color: p.neon[0].color * 6.0, range: 9.0 });
    // Steam pipe of the kitchen.
    b.object("noodle chimney").with_material(p.steel);
    b.tube(
        &[vec3(8.5, 2.85, -9.6), vec3(8.5, 4.6, -9.6), vec3(8.7, 5.0, -9.6), vec3(8.7, 8.0, -9.6)],
        0.16,
        16,
        false,
    );
    lights
}

fn paper_lantern(b: &mut SceneBuilder, p: &Palette) {
    b.with_material(p.dark);
    b.cylinder(vec3(0.0, 0.17, 0.0), vec3(0.0, 0.44, 0.0), 0.004, 0.004, 5, false);
    for y in [-0.19, 0.15] {
        b.cylinder(vec3(0.0, y, 0.0), vec3(0.0, y + 0.03, 0.0), 0.065, 0.065, 18, true);
    }
    b.with_material(p.lantern.material);
    let profile: Vec<(f32, f32)> = (0..=24)
        .map(|i| {
            let t = i as f32 / 24.0;
            let belly = 0.075 + 0.075 * (t * PI).sin().max(0.0).sqrt();
            (belly + if i % 2 == 0 { 0.004 } else { -0.004 }, -0.165 + 0.32 * t)
        })
        .collect();
    b.lathe(&profile, 20);
}

/// Builds letters of glass tube on a dark board with a frame, in the XY plane from the origin.
fn neon_sign(b: &mut SceneBuilder, p: &Palette, neon: Neon, text: &str, height: f32) {
    let width = tube_text_width(text, height);
    b.with_material(p.dark);
    b.beveled_cuboid(vec3(-0.2, -0.18, -0.12), vec3(width + 0.2, height + 0.18, -0.05), 0.02);
    b.with_material(neon.material);
    b.within(Affine3A::from_translation(Vec3::ZERO), |b| tube_text(b, text, height, height * 0.045));
    let (l, r, low, high) = (-0.13, width + 0.13, -0.11, height + 0.11);
    let frame = [[l, low], [r, low], [r, high], [l, high], [l, low]].map(|c| vec3(c[0], c[1], -0.02));
    b.with_material(p.lamp.material).tube(&frame, 0.014, 6, false);
    b.with_material(p.steel);
    for x in [0.1, width - 0.1] {
        b.tube(&[vec3(x, height * 0.5, -0.1), vec3(x, height * 0.5, -0.6)], 0.02, 6, false);
    }
}

/// Builds boards, neon letters and tall signs that stick out into the street.
fn signs(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) -> Vec<PointLight> {
    let mut lights = Vec::new();
    let words = ["HOTEL", "BAR", "TECH", "SUSHI", "CLUB", "LOAN", "CYBER", "GAMES", "24H", "PARTS"];
    for i in 0..18 {
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let z = 6.0 - 4.6 * (i / 2) as f32 + around(rng, 0.0, 0.7);
        let word = words[i % words.len()];
        let neon = p.neon[i % 5];
        let letter = around(rng, 0.62, 0.12);
        let tall = word.len() as f32 * letter * 1.3 + 0.3;
        let y = around(rng, 5.4, 0.9);
        b.object(&format!("tall sign {i}"));
        // The board can be read from both ends of the street.
        for (facing, turn) in [(1.0, 0.0), (-1.0, PI)] {
            let x = side * (FACADES - 1.25);
            b.within(placed(vec3(x, y, z + 0.09 * facing), turn), |b| {
                b.with_material(p.dark);
                b.beveled_cuboid(vec3(-0.55, 0.0, -0.09), vec3(0.55, tall, -0.01), 0.03);
                b.with_material(p.lamp.material);
                let frame =
                    [[-0.47, 0.08], [0.47, 0.08], [0.47, tall - 0.08], [-0.47, tall - 0.08], [-0.47, 0.08]];
                b.tube(&frame.map(|c| vec3(c[0], c[1], 0.01)), 0.013, 6, false);
                b.with_material(neon.material);
                for (k, glyph) in word.chars().enumerate() {
                    let at = tall - 0.2 - (k as f32 + 0.92) * letter * 1.3;
                    b.within(moved(-letter / 3.0, at, 0.04), |b| {
                        tube_text(b, glyph.encode_utf8(&mut [0; 4]), letter, letter * 0.05);
                    });
                }
            });
        }
        b.with_material(p.steel);
        let wall = side * (FACADES + 0.3);
        for k in [0.2, 0.8] {
            let at = vec3(side * (FACADES - 0.75), y + tall * k, z);
            b.tube(&[at, vec3(wall, at.y, z)], 0.03, 6, false);
        }
        if (2..11).contains(&i) {
            let position = vec3(side * (FACADES - 1.6), y + 0.2, z + 0.5);
            lights.push(PointLight { position, color: neon.color * 11.0, range: 13.0 });
        }
    }
    for i in 0..18 {
        let side = if i % 2 == 0 { -1.0 } else { 1.0 };
        let z = 4.0 - 5.0 * (i / 2) as f32 + around(rng, 0.0, 1.0);
        if side > 0.0 && (-12.0..-3.0).contains(&z) {
            continue;
        }
        b.object(&format!("board {i}"));
        let yaw = -FRAC_PI_2 * side;
        b.within(placed(vec3(side * (FACADES - 0.34), 3.42, z), yaw), |b| {
            b.with_material(p.dark).beveled_cuboid(vec3(-1.3, -0.34, -0.1), vec3(1.3, 0.34, 0.06), 0.02);
            b.with_material(p.signs[i % 8]);
            let corners = [[-1.24, -0.3], [1.24, -0.3], [1.24, 0.3], [-1.24, 0.3]];
            b.picture(corners.map(|c| vec3(c[0], c[1], 0.063)));
        });
    }
    for (i, (x, y, z)) in [(1.0, 12.0, -16.0), (-1.0, 13.5, -28.0), (1.0, 15.0, -42.0), (-1.0, 10.5, -5.0)]
        .into_iter()
        .enumerate()
    {
        b.object(&format!("advert {i}"));
        b.within(placed(vec3(x * (FACADES - 0.75), y, z), -FRAC_PI_2 * x), |b| {
            b.with_material(p.dark).beveled_cuboid(vec3(-3.4, -2.2, -0.5), vec3(3.4, 2.2, 0.0), 0.08);
            b.with_material(p.screens[i % 3]);
            b.picture([[-3.2, -2.0], [3.2, -2.0], [3.2, 2.0], [-3.2, 2.0]].map(|c| vec3(c[0], c[1], 0.01)));
            b.with_material(p.neon[(i + 1) % 5].material);
            let frame = [[-3.3, -2.1], [3.3, -2.1], [3.3, 2.1], [-3.3, 2.1], [-3.3, -2.1]];
            b.tube(&frame.map(|c| vec3(c[0], c[1], 0.05)), 0.04, 8, false);
        });
    }
    lights
}

fn street_furniture(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) -> Vec<PointLight> {
    let mut lights = Vec::new();
    let rail =
        Railing { height: 1.02, low_rail: 0.3, rail_radius: 0.026, bar_radius: 0.009, bar_spacing: 0.16 };
    for (i, side) in [-1.0, 1.0].into_iter().enumerate() {
        for span in 0..12 {
            let z = 1.0 - 5.0 * span as f32;
            // Crossings stay open.
            if span % 5 == 4 || (side > 0.0 && span == 0) {
                continue;
            }
            b.object(&format!("railing {i} {span}")).with_material(p.steel);
            let x = side * (ROAD + 0.32);
            let path: Vec<Vec3> = (0..4).map(|k| vec3(x, PAVEMENT, z - 1.5 * k as f32)).collect();
            b.railing(&path, &rail);
            b.with_material(p.neon[if side < 0.0 { 0 } else { 1 }].material);
            let strip = [vec3(x, PAVEMENT + 0.93, z), vec3(x, PAVEMENT + 0.93, z - 4.5)];
            b.tube(&strip, 0.008, 6, false);
        }
    }
    for i in 0..10 {
        let side = if i % 2 == 0 { -1.0 } else { 1.0 };
        let at = vec3(side * (ROAD + 0.62), PAVEMENT, 5.5 - 8.0 * i as f32);
        b.object(&format!("street lamp {i}"));
        b.within(placed(at, if side > 0.0 { PI } else { 0.0 }), |b| {
            b.with_material(p.dark);
            b.beveled_cuboid(vec3(-0.16, 0.0, -0.16), vec3(0.16, 0.5, 0.16), 0.03);
            let arm: Vec<Vec3> = (0..=16)
                .map(|k| {
                    let t = k as f32 / 16.0;
                    vec3(2.0 * t.powi(4), 0.4 + 5.4 * (1.0 - (1.0 - t).powf(1.6)), 0.0)
                })
                .collect();
            b.tapered_tube(&arm, &|t| 0.075 - 0.035 * t, 12, true);
            b.with_material(p.steel);
            b.beveled_cuboid(vec3(1.5, 5.74, -0.14), vec3(2.5, 5.84, 0.14), 0.03);
            b.with_material(p.lamp.material);
            b.cuboid_faces(vec3(1.58, 5.72, -0.1), vec3(2.42, 5.745, 0.1), BoxFaces::ALL);
        });
        if i < 6 {
            let position = at + vec3(-side * 2.0, 5.5, 0.0);
            lights.push(PointLight { position, color: p.lamp.color * 17.0, range: 15.0 });
        }
    }
    for (i, (x, z, yaw)) in [
        (8.35, 1.4, -FRAC_PI_2),
        (8.35, 0.3, -FRAC_PI_2),
        (-8.3, -3.0, FRAC_PI_2),
        (-8.3, -4.1, FRAC_PI_2),
        (8.35, -14.5, -FRAC_PI_2),
    ]
    .into_iter()
    .enumerate()
    {
        b.object(&format!("vending machine {i}"));
        b.within(placed(vec3(x, PAVEMENT, z), yaw), |b| vending_machine(b, p, i, rng));
        if i % 2 == 0 && i < 4 {
            let position = vec3(x - 0.9 * x.signum(), 1.3, z - 0.4);
            lights.push(PointLight { position, color: p.neon[(i + 1) % 5].color * 3.5, range: 5.0 });
        }
    }
    for i in 0..26 {
        let side = if i % 3 == 0 { -1.0 } else { 1.0 };
        let z = 7.0 - 2.2 * i as f32 + around(rng, 0.0, 0.6);
        let (x, at_bar) = (side * around(rng, 8.3, 0.25), side > 0.0 && (-11.5..2.3).contains(&z));
        if at_bar || (-15.5..-13.5).contains(&z) {
            continue;
        }
        b.object(&format!("goods {i}"));
        b.within(placed(vec3(x, PAVEMENT, z), rng.random::<f32>() * TAU), |b| match i % 3 {
            0 => barrel(b, p),
            1 => crates(b, p, rng),
            _ => {
                b.with_material(p.rubber);
                for k in 0..4 {
                    let at = vec3(around(rng, 0.0, 0.3), 0.2 + 0.12 * (k / 3) as f32, around(rng, 0.0, 0.3));
                    b.ellipsoid(at, vec3(0.26, 0.21, 0.24), 12, 18);
                }
            }
        });
    }
    for i in 0..3 {
        let z = -2.4 - 9.5 * i as f32;
        b.object(&format!("planter {i}")).with_material(p.curb);
        let at = vec3(-7.6, PAVEMENT, z);
        b.beveled_cuboid(at + vec3(-0.35, 0.0, -0.9), at + vec3(0.35, 0.5, 0.9), 0.04);
        props::hedge(b, at + vec3(-0.3, 0.48, -0.85), at + vec3(0.3, 0.95, 0.85), p.leaves, 500, rng);
    }
    // A hover bike parked by the railing.
    b.object("hover bike");
    b.within(placed(vec3(6.1, PAVEMENT, 4.4), 0.25), |b| hover_bike(b, p));
    lights
}

fn vending_machine(b: &mut SceneBuilder, p: &Palette, kind: usize, rng: &mut Pcg32) {
    b.with_material(p.hulls[kind % 3]);
    b.beveled_cuboid(vec3(-0.48, 0.0, -0.4), vec3(0.48, 1.9, 0.34), 0.03);
    b.with_material(p.dark).cuboid(vec3(-0.4, 0.75, 0.3), vec3(0.4, 1.8, 0.345));
    for row in 0..3 {
        for column in 0..6 {
            let at = vec3(-0.33 + 0.13 * column as f32, 0.8 + 0.33 * row as f32, 0.37);
            b.with_material([p.china, p.hulls[0], p.rust, p.crate_, p.copper][rng.random_range(0..5)]);
            b.cylinder(at, at + Vec3::Y * 0.2, 0.04, 0.036, 12, true);
        }
        b.with_material(p.lamp.material);
        let y = 1.06 + 0.33 * row as f32;
        b.cuboid(vec3(-0.4, y, 0.345), vec3(0.4, y + 0.025, 0.36));
    }
    b.with_material(p.neon[(kind + 1) % 5].material);
    let frame = [[-0.44, 0.7], [0.44, 0.7], [0.44, 1.85], [-0.44, 1.85], [-0.44, 0.7]];
    b.tube(&frame.map(|c| vec3(c[0], c[1], 0.36)), 0.012, 6, false);
    b.with_material(p.pane).rectangle(vec3(-0.4, 0.75, 0.43), Vec3::X * 0.8, Vec3::Y * 1.05);
    b.with_material(p.dark).beveled_cuboid(vec3(-0.3, 0.25, 0.3), vec3(0.3, 0.5, 0.36), 0.02);
}

fn barrel(b: &mut SceneBuilder, p: &Palette) {
    b.with_material(p.rust);
    b.lathe(
        &[
            (0.28, 0.0),
            (0.29, 0.02),
            (0.28, 0.04),
            (0.28, 0.28),
            (0.3, 0.3),
            (0.28, 0.32),
            (0.28, 0.56),
            (0.3, 0.58),
            (0.28, 0.6),
            (0.28, 0.84),
            (0.29, 0.86),
            (0.28, 0.88),
            (0.26, 0.87),
            (0.26, 0.85),
            (0.0, 0.85),
        ],
        28,
    );
    b.with_material(p.steel).cylinder(vec3(0.14, 0.85, 0.0), vec3(0.14, 0.88, 0.0), 0.035, 0.035, 12, true);
}

fn crates(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    for k in 0..3 {
        let at = vec3(around(rng, 0.0, 0.06), 0.31 * k as f32, around(rng, 0.0, 0.06));
        b.with_material([p.crate_, p.hulls[0], p.dark][rng.random_range(0..3)]);
        b.within(placed(at, around(rng, 0.0, 0.2)), |b| {
            b.beveled_cuboid(vec3(-0.3, 0.0, -0.2), vec3(0.3, 0.05, 0.2), 0.01);
            for y in [0.08, 0.17, 0.25] {
                b.cuboid(vec3(-0.3, y, -0.2), vec3(0.3, y + 0.05, -0.18));
                b.cuboid(vec3(-0.3, y, 0.18), vec3(0.3, y + 0.05, 0.2));
                b.cuboid(vec3(-0.3, y, -0.18), vec3(-0.28, y + 0.05, 0.18));
                b.cuboid(vec3(0.28, y, -0.18), vec3(0.3, y + 0.05, 0.18));
            }
            for (x, z) in [(-0.28, -0.18), (0.28, -0.18), (-0.28, 0.18), (0.28, 0.18)] {
                b.cuboid(vec3(x - 0.025, 0.0, z - 0.025), vec3(x + 0.025, 0.3, z + 0.025));
            }
        });
    }
}

fn hover_bike(b: &mut SceneBuilder, p: &Palette) {
    b.with_material(p.hulls[2]);
    b.ellipsoid(vec3(0.0, 0.72, 0.0), vec3(0.2, 0.18, 0.75), 18, 28);
    b.ellipsoid(vec3(0.0, 0.85, 0.35), vec3(0.17, 0.16, 0.32), 14, 22);
    b.with_material(p.rubber).ellipsoid(vec3(0.0, 0.9, -0.3), vec3(0.15, 0.08, 0.38), 12, 20);
    for z in [0.85, -0.8] {
        b.within(moved(0.0, 0.42, z), |b| {
            b.with_material(p.steel);
            let ring: Vec<Vec3> = (0..=36)
                .map(|k| {
                    let (sin, cos) = (k as f32 / 36.0 * TAU).sin_cos();
                    vec3(cos * 0.3, 0.0, sin * 0.3)
                })
                .collect();
            b.tube(&ring, 0.05, 10, false);
            for k in 0..8 {
                let (sin, cos) = (k as f32 / 8.0 * TAU).sin_cos();
                b.tube(&[Vec3::ZERO, vec3(cos, 0.0, sin) * 0.28], 0.01, 6, false);
            }
            b.with_material(p.neon[1].material).cylinder(
                vec3(0.0, -0.05, 0.0),
                vec3(0.0, 0.02, 0.0),
                0.07,
                0.09,
                18,
                true,
            );
        });
        b.with_material(p.steel);
        b.tube(&[vec3(0.0, 0.72, z * 0.6), vec3(0.0, 0.55, z * 0.85), vec3(0.0, 0.44, z)], 0.04, 10, false);
    }
    b.with_material(p.steel);
    let bar =
        [[-0.36, 1.02, 0.3], [-0.3, 1.05, 0.42], [0.0, 0.98, 0.5], [0.3, 1.05, 0.42], [0.36, 1.02, 0.3]];
    b.tube(&bar.map(Vec3::from), 0.016, 8, true);
    b.with_material(p.lamp.material).ellipsoid(vec3(0.0, 0.84, 0.66), vec3(0.07, 0.05, 0.03), 8, 14);
    b.with_material(p.red_light).ellipsoid(vec3(0.0, 0.75, -0.74), vec3(0.1, 0.03, 0.03), 8, 14);
    b.with_material(p.steel).tube(&[vec3(0.18, 0.55, -0.1), vec3(0.3, 0.02, -0.15)], 0.014, 8, true);
}

/// Builds cables across the street and along the facades, with bundles and boxes.
fn cables(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    for i in 0..64 {
        let z = 9.0 - 1.0 * i as f32 + around(rng, 0.0, 0.8);
        let a = vec3(-FACADES + 0.2, around(rng, 7.6, 2.4), z);
        let c = vec3(FACADES - 0.2, around(rng, 7.6, 2.4), z + around(rng, 0.0, 4.0));
        b.object(&format!("cables {}", i / 8)).with_material(p.rubber);
        b.wire(a, c, around(rng, 1.0, 0.6), around(rng, 0.015, 0.007), 28);
    }
    for side in [-1.0, 1.0] {
        for line in 0..5 {
            b.object(&format!("facade cables {line} {}", if side < 0.0 { "left" } else { "right" }));
            b.with_material(p.rubber);
            let y = 4.3 + 0.16 * line as f32;
            let mut z = 10.0;
            while z > -70.0 {
                let next = z - around(rng, 4.5, 1.5);
                let x = side * (FACADES - 0.6 - 0.03 * line as f32);
                b.wire(vec3(x, y, z), vec3(x, y, next), around(rng, 0.22, 0.15), 0.016, 12);
                z = next;
            }
        }
    }
    // Small lamps on a wire, as at a market.
    for i in 0..6 {
        let z = 0.0 - 6.0 * i as f32;
        let (a, c) = (vec3(-FACADES + 0.6, 5.2, z), vec3(FACADES - 0.6, 4.9, z - 2.0));
        b.object(&format!("market lamps {i}"));
        props::bulb_string(b, [p.rubber, p.dark, p.neon[2].material], [a, c], 0.9, 0.7);
    }
}

/// Builds footbridges between the towers: trusses with lit cabins.
fn bridges(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    for (i, (y, z)) in
        [(9.5, -20.0), (17.0, -33.0), (13.0, -52.0), (26.0, -44.0), (22.0, -12.0), (34.0, -70.0)]
            .into_iter()
            .enumerate()
    {
        b.object(&format!("bridge {i}"));
        b.within(moved(-FACADES - 0.2, y, z), |b| {
            let (length, half) = (2.0 * FACADES + 0.4, 1.5);
            b.with_material(p.panels[i % 3]);
            b.beveled_cuboid(vec3(0.0, -0.3, -half), vec3(length, 0.0, half), 0.06);
            b.beveled_cuboid(vec3(0.0, 2.9, -half - 0.2), vec3(length, 3.05, half + 0.2), 0.05);
            b.with_material(p.neon[i % 5].material);
            for z in [-half - 0.22, half + 0.22] {
                b.tube(&[vec3(0.0, 2.97, z), vec3(length, 2.97, z)], 0.035, 8, false);
            }
            b.with_material(p.window);
            b.cuboid_faces(
                vec3(0.0, 0.9, -half * 0.55),
                vec3(length, 2.3, half * 0.55),
                BoxFaces::FRONT.and(BoxFaces::BACK),
            );
            b.with_material(p.dark);
            b.cuboid_faces(
                vec3(0.0, 0.0, -half * 0.56),
                vec3(length, 0.9, half * 0.56),
                BoxFaces::ALL.without(BoxFaces::BOTTOM),
            );
            b.cuboid_faces(vec3(0.0, 2.3, -half * 0.56), vec3(length, 2.9, half * 0.56), BoxFaces::ALL);
            for k in 0..24 {
                let x = length * (k as f32 + 0.5) / 24.0;
                b.cuboid(vec3(x - 0.05, 0.9, -half * 0.57), vec3(x + 0.05, 2.3, half * 0.57));
            }
            b.with_material(p.steel);
            let cells = 12;
            for side in [-half, half] {
                for k in 0..cells {
                    let (x0, x1) = (length * k as f32 / cells as f32, length * (k + 1) as f32 / cells as f32);
                    let (low, high) = if k % 2 == 0 { (0.0, 2.9) } else { (2.9, 0.0) };
                    b.tube(&[vec3(x0, low, side), vec3(x1, high, side)], 0.05, 8, false);
                    b.tube(&[vec3(x0, 0.0, side), vec3(x0, 2.9, side)], 0.035, 8, false);
                }
                for y in [0.55, 1.05] {
                    b.tube(&[vec3(0.0, y, side), vec3(length, y, side)], 0.02, 6, false);
                }
            }
            b.with_material(p.rust);
            for _ in 0..3 {
                let z = around(rng, 0.0, 1.0);
                b.tube(&[vec3(0.0, -0.45, z), vec3(length, -0.45, z)], around(rng, 0.08, 0.03), 10, false);
            }
        });
    }
}

fn monorail(b: &mut SceneBuilder, p: &Palette) {
    let (x, y) = (-2.6, 11.5);
    b.object("monorail beam").with_material(p.curb);
    for i in 0..10 {
        let z = 25.0 - 13.0 * i as f32;
        b.beveled_cuboid(vec3(x - 0.45, y, z - 12.96), vec3(x + 0.45, y + 1.1, z), 0.08);
    }
    b.with_material(p.neon[1].material);
    for side in [-0.46, 0.46] {
        b.tube(&[vec3(x + side, y + 0.25, 25.0), vec3(x + side, y + 0.25, -104.0)], 0.02, 6, false);
    }
    for i in 0..4 {
        let z = 12.5 - 26.0 * i as f32;
        b.object(&format!("monorail pylon {i}")).with_material(p.curb);
        b.beveled_cuboid(vec3(-6.2, PAVEMENT, z - 0.45), vec3(-5.5, y - 0.6, z + 0.45), 0.08);
        b.beveled_cuboid(vec3(-6.3, y - 0.7, z - 0.4), vec3(x + 0.6, y, z + 0.4), 0.08);
        b.with_material(p.stripe);
        b.cuboid_faces(
            vec3(-6.21, 0.5, z - 0.46),
            vec3(-5.49, 1.1, z + 0.46),
            BoxFaces::ALL.without(BoxFaces::TOP),
        );
    }
    for car in 0..3 {
        let z = -26.0 - 10.4 * car as f32;
        b.object(&format!("monorail car {car}")).with_material(p.hulls[1]);
        b.beveled_cuboid(vec3(x - 1.35, y + 1.25, z - 10.0), vec3(x + 1.35, y + 3.9, z), 0.35);
        b.with_material(p.dark);
        b.beveled_cuboid(vec3(x - 1.0, y + 0.4, z - 9.5), vec3(x + 1.0, y + 1.3, z - 0.5), 0.1);
        for side in [-1.0, 1.0] {
            for k in 0..7 {
                let (z0, z1) = (z - 1.0 - 1.2 * k as f32, z - 1.9 - 1.2 * k as f32);
                b.with_material(p.window);
                let at = x + 1.352 * side;
                b.cuboid(
                    vec3(at.min(at + 0.01 * side), y + 2.3, z1),
                    vec3(at.max(at + 0.01 * side), y + 3.3, z0),
                );
            }
            b.with_material(p.neon[0].material);
            let at = x + 1.37 * side;
            b.tube(&[vec3(at, y + 1.9, z - 0.4), vec3(at, y + 1.9, z - 9.6)], 0.03, 6, false);
        }
        if car == 0 {
            b.with_material(p.lamp.material);
            for side in [-0.8, 0.8] {
                b.ellipsoid(vec3(x + side, y + 1.8, z), vec3(0.2, 0.12, 0.05), 8, 14);
            }
            b.with_material(p.window);
            b.cuboid(vec3(x - 1.0, y + 2.4, z - 0.05), vec3(x + 1.0, y + 3.4, z + 0.02));
        }
    }
}

/// Builds the vehicles in the air and one at the curb.
fn traffic(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    b.object("parked vehicle");
    b.within(placed(vec3(-3.6, 0.35, -8.5), 0.06), |b| vehicle(b, p, 0));
    for i in 0..13 {
        let inbound = i % 2 == 0;
        let x = if inbound { around(rng, 3.0, 1.2) } else { around(rng, 1.0, 0.8) };
        let at = vec3(x, around(rng, 17.0, 11.0).max(7.0), -8.0 - 6.5 * i as f32 + around(rng, 0.0, 2.0));
        let yaw = if inbound { 0.0 } else { PI };
        b.object(&format!("vehicle {i}"));
        b.within(placed(at, yaw + around(rng, 0.0, 0.05)), |b| vehicle(b, p, i % 3));
    }
}

/// Builds a flying vehicle with its nose towards +z.
fn vehicle(b: &mut SceneBuilder, p: &Palette, kind: usize) {
    b.with_material(p.hulls[kind]);
    let section = |z: f32| {
        let t = (z + 2.2) / 4.4;
        let half = 0.95 * (1.0 - (2.0 * t - 0.9).abs().powf(2.6) * 0.55).max(0.05);
        let tall = 0.42 * (1.0 - (2.0 * t - 0.95).abs().powf(3.0) * 0.6).max(0.05);
        (half, tall)
    };
    let loft = |b: &mut SceneBuilder, z0: f32, z1: f32, lift: f32, scale: Vec2, rows: usize| {
        b.surface(28, rows, true, |u, v| {
            let z = z0 + (z1 - z0) * v;
            let (half, tall) = section(z);
            let closing =
                if v == 0.0 || v == 1.0 { 0.0 } else { (1.0 - (2.0 * v - 1.0).powi(8)).max(0.0).sqrt() };
            let (sin, cos) = if u == 1.0 { (0.0, 1.0) } else { (u * TAU).sin_cos() };
            let squared = |a: f32| a.signum() * a.abs().powf(0.7);
            let at = vec2(squared(cos) * half * scale.x, squared(sin) * tall * scale.y) * closing;
            (vec3(at.x, at.y + lift, z), vec2(u * 4.0, z))
        });
    };
    loft(b, -2.2, 2.2, 0.5, vec2(1.0, 1.0), 20);
    b.with_material(p.dark);
    loft(b, -1.2, 1.3, 0.82, vec2(0.72, 1.1), 14);
    for side in [-1.0, 1.0] {
        for z in [-1.35, 1.25] {
            b.with_material(p.steel);
            b.within(moved(0.98 * side, 0.35, z), |b| {
                b.lathe(&[(0.2, -0.2), (0.3, -0.16), (0.32, 0.1), (0.24, 0.2), (0.1, 0.22), (0.0, 0.22)], 20);
                b.with_material(p.neon[1].material);
                b.lathe(&[(0.0, -0.19), (0.2, -0.19)], 20);
            });
            b.tube(&[vec3(0.6 * side, 0.45, z), vec3(0.98 * side, 0.4, z)], 0.07, 8, false);
        }
        b.with_material(p.lamp.material);
        b.ellipsoid(vec3(0.45 * side, 0.5, 2.02), vec3(0.16, 0.06, 0.06), 8, 14);
        b.with_material(p.red_light);
        b.ellipsoid(vec3(0.5 * side, 0.55, -2.0), vec3(0.2, 0.05, 0.06), 8, 14);
        b.with_material(p.hulls[kind]);
        let fin = [vec2(-2.1, 0.6), vec2(-1.2, 0.75), vec2(-2.1, 1.3)];
        b.within(placed(vec3(0.7 * side, 0.0, 0.0), -FRAC_PI_2), |b| b.extrude(&fin, -0.03, 0.03, true));
    }
    b.with_material(p.neon[if kind == 1 { 3 } else { 2 }].material);
    b.cuboid(vec3(-0.3, 1.27, -0.3), vec3(0.3, 1.34, 0.0));
}
