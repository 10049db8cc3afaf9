//! A conference room high above a town, in place of Conference.
//!
//! The table lies along x in the middle. The screen hangs on the wall at -x; windows with blinds are at -z, a wall of
//! wooden battens at +z, and the door at +x.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Affine3A, Vec2, Vec3, vec2, vec3, vec4};
use rand::Rng;
use rand_pcg::Pcg32;

use super::build::{BoxFaces, Railing, SceneBuilder, around, hanging, moved, placed, random, viewpoints};
use super::paint::{self, Canvas};
use super::props::{self, Tree, cup, fronds, glass, glowing, metal, palette, pictured, plain, textured};
use yoro_assets::{Alpha, Material, PointLight, Scene, Sky, TextureImage, Viewpoint};

/// Half the size of the room; its height is `CEILING`.
const ROOM: Vec2 = vec2(5.6, 4.0);
const CEILING: f32 = 2.95;
/// Half the size of the table top; its height is `TOP`.
const TABLE: Vec2 = vec2(3.2, 0.95);
const TOP: f32 = 0.745;

/// Generates the scene.
pub fn build(seed: u64, mut b: SceneBuilder) -> Scene {
    let p = palette(&mut b, seed);
    let rng = &mut random(seed, "conference");
    shell(&mut b, &p);
    let mut lights = ceiling(&mut b, &p, rng);
    windows(&mut b, &p, rng);
    screen_wall(&mut b, &p);
    batten_wall(&mut b, &p, rng);
    door_wall(&mut b, &p);
    b.object("table");
    table(&mut b, &p);
    chairs(&mut b, &p, rng);
    on_the_table(&mut b, &p, rng);
    lights.extend(pendants(&mut b, &p));
    plants(&mut b, &p, rng);
    town(&mut b, &p, rng);
    lights.push(PointLight { position: vec3(-4.6, 1.7, 0.0), color: vec3(0.35, 0.5, 0.8), range: 4.0 });
    let sky = Sky {
        sun_direction: vec3(0.34, 0.5, -0.8).normalize(),
        sun_color: vec3(3.2, 2.95, 2.6),
        zenith: vec3(0.3, 0.42, 0.66),
        horizon: vec3(0.56, 0.62, 0.68),
        ground: vec3(0.24, 0.22, 0.2),
    };
    Scene { model: b.finish(), sky, lights, viewpoints: walk(), ..Scene::default() }
}

/// Returns a walk along the battens behind the chairs, around the table below the screen, and past the blinds.
fn walk() -> Vec<Viewpoint> {
    viewpoints(&[
        ([4.7, 1.62, 1.5], [-1.5, 1.05, -0.6]),
        ([4.4, 1.62, 2.35], [-1.6, 1.0, -0.7]),
        ([3.2, 1.6, 2.6], [-2.2, 1.0, -0.8]),
        ([1.8, 1.52, 2.55], [-2.8, 0.95, -0.9]),
        ([0.4, 1.42, 2.45], [-3.4, 0.95, -1.0]),
        ([-1.1, 1.38, 2.4], [-3.6, 1.0, -1.4]),
        ([-2.6, 1.45, 2.4], [-3.0, 1.0, -2.2]),
        ([-3.9, 1.55, 2.1], [-1.8, 0.9, -2.6]),
        ([-4.65, 1.6, 1.2], [-0.8, 0.85, -1.6]),
        ([-4.8, 1.55, 0.1], [0.2, 0.8, -0.5]),
        ([-4.65, 1.5, -1.0], [0.6, 0.8, 0.4]),
        ([-3.9, 1.55, -2.0], [1.2, 0.85, 0.7]),
        ([-2.7, 1.6, -2.5], [2.2, 0.9, 0.6]),
    ])
}

palette! {
    fn palette(b: &mut SceneBuilder, seed: u64) -> Palette {
        let s = seed as u32;
        let mesh_map = b.texture(paint::picture("chair-mesh", [128, 128], |uv| {
            let cell = (uv * vec2(16.0, 16.0)).fract() - 0.5;
            let thread = cell.x.abs().max(cell.y.abs()) > 0.27;
            vec4(0.16, 0.17, 0.19, f32::from(thread))
        }));
        let mesh = b.material(
            Material {
                name: "chair-mesh".into(),
                diffuse: Vec3::ONE,
                roughness: 0.8,
                alpha: Alpha::Cutout(0.4),
                double_sided: true,
                diffuse_map: Some(mesh_map),
                ..Material::default()
            },
            0.11,
        );
        let two_sided = |b: &mut SceneBuilder, name: &str, color: Vec3, roughness: f32| {
            let id = plain(b, name, color, roughness);
            b.edit_material(id, |m| m.double_sided = true);
            id
        };
        let panels = paint::surface("ceiling-panel", [256, 256], 0.004, |uv| {
            let hole = (uv * 24.0).fract() - 0.5;
            let deep = hole.length() < 0.2;
            let grain = paint::fbm(s, glam::UVec2::splat(16), 3, uv);
            (Vec3::splat(if deep { 0.5 } else { 0.86 + 0.08 * grain }), f32::from(!deep))
        });
        let wood = paint::planks("walnut", 512, s + 1, vec3(0.42, 0.27, 0.16), 4);
        let veneer = paint::surface("veneer", [512, 512], 0.0006, |uv| {
            let stretch = paint::fbm(s + 2, glam::UVec2::new(3, 40), 5, uv);
            let figure = paint::fbm(s + 3, glam::UVec2::new(2, 8), 4, uv);
            let t = (stretch * 0.6 + figure * 0.6).clamp(0.0, 1.0);
            (vec3(0.36, 0.2, 0.11).lerp(vec3(0.66, 0.43, 0.25), t), stretch)
        });
        let oak = paint::surface("oak-batten", [256, 256], 0.001, |uv| {
            let grain = paint::fbm(s + 12, glam::UVec2::new(40, 2), 4, uv);
            (vec3(0.5, 0.34, 0.2).lerp(vec3(0.72, 0.52, 0.33), grain), grain)
        });
        let towns = [(vec3(0.6, 0.55, 0.5), "town-stone"), (vec3(0.42, 0.47, 0.52), "town-glass")].map(
            |(color, name)| {
                let facade = paint::facade(name, 512, s + 9, color, vec3(0.25, 0.33, 0.42), [6, 6], 0.1);
                textured(b, paint::Surface { color: facade.color, normal: facade.normal }, 19.0, 0.6)
            },
        );
        let table = textured(b, veneer, 1.6, 0.22);
        b.edit_material(table, |m| m.specular = Vec3::splat(0.28));
    }
    wall = textured(b, emulsion(s + 4), 1.6, 0.9),
    carpet = textured(b, carpet(s + 5), 2.0, 0.95),
    skirting = plain(b, "skirting", vec3(0.3, 0.29, 0.28), 0.5),
    ceiling = textured(b, panels, 0.6, 0.9),
    ceiling_bar = plain(b, "ceiling-bar", vec3(0.88, 0.88, 0.87), 0.5),
    lamp = glowing(b, "ceiling-lamp", vec3(1.0, 0.97, 0.92), 1.8),
    pendant = metal(b, "pendant", vec3(0.72, 0.5, 0.3), 0.28),
    bulb = glowing(b, "bulb", vec3(1.0, 0.86, 0.6), 1.8),
    wood = textured(b, wood, 0.9, 0.5),
    batten = textured(b, oak, 0.8, 0.5),
    table = table,
    dark = plain(b, "dark-lacquer", vec3(0.12, 0.12, 0.13), 0.35),
    chrome = metal(b, "chrome", vec3(0.78, 0.79, 0.8), 0.15),
    black = plain(b, "black-plastic", vec3(0.08, 0.08, 0.085), 0.45),
    fabric = textured(b, paint::fabric("seat-fabric", 256, s + 6, vec3(0.2, 0.27, 0.36), 32), 0.24, 0.9),
    mesh = mesh,
    slat = two_sided(b, "blind-slat", vec3(0.86, 0.84, 0.79), 0.4),
    cord = plain(b, "cord", vec3(0.8, 0.78, 0.72), 0.8),
    screen = pictured(
        b,
        paint::screen("big-screen", [1024, 576], s, vec3(0.25, 0.7, 0.95), "QUARTERLY REVIEW"),
        0.3,
        1.3,
    ),
    laptop_screens: [usize; 2] = [
        pictured(
            b,
            paint::screen("laptop-a", [256, 160], s + 7, vec3(0.95, 0.6, 0.25), "NOTES"),
            0.3,
            1.1,
        ),
        pictured(
            b,
            paint::screen("laptop-b", [256, 160], s + 8, vec3(0.45, 0.85, 0.45), "BUDGET"),
            0.3,
            1.1,
        ),
    ],
    whiteboard = pictured(b, whiteboard_picture(), 0.2, 0.0),
    white = plain(b, "white", vec3(0.93, 0.93, 0.92), 0.4),
    paper = pictured(b, paper_picture(), 0.9, 0.0),
    art: [usize; 2] = [
        pictured(b, art_picture("art-a", s), 0.6, 0.0),
        pictured(b, art_picture("art-b", s + 1), 0.6, 0.0),
    ],
    china = plain(b, "china", vec3(0.95, 0.95, 0.94), 0.12),
    coffee = plain(b, "coffee", vec3(0.13, 0.07, 0.04), 0.1),
    tumbler = glass(b, "tumbler", vec3(0.8, 0.88, 0.9), 0.22),
    pane = glass(b, "pane", vec3(0.7, 0.8, 0.82), 0.1),
    leather = plain(b, "leather", vec3(0.24, 0.13, 0.09), 0.4),
    pot = textured(b, paint::concrete("pot", 256, s + 10, vec3(0.72, 0.71, 0.69)), 0.8, 0.7),
    bark = textured(b, paint::bark("bark", 256, s + 11, vec3(0.44, 0.37, 0.28)), 0.5, 0.9),
    leaves = props::foliage(b, "leaves", seed, vec3(0.19, 0.38, 0.14)),
    frond = two_sided(b, "frond", vec3(0.24, 0.44, 0.17), 0.45),
    soil = plain(b, "soil", vec3(0.2, 0.15, 0.11), 0.95),
    town: [usize; 2] = towns,
    ground = plain(b, "ground", vec3(0.4, 0.42, 0.4), 0.95),
    books = pictured(b, paint::book_spines("books", [512, 128], s, 36), 0.8, 0.0),
}

/// Paints rolled emulsion paint: almost flat.
fn emulsion(seed: u32) -> paint::Surface {
    paint::surface("wall", [256, 256], 0.0014, |uv| {
        let grain = paint::fbm(seed, glam::UVec2::splat(48), 2, uv);
        let stain = paint::fbm(seed + 1, glam::UVec2::splat(3), 4, uv);
        (vec3(0.84, 0.83, 0.8) * (0.96 + 0.03 * grain + 0.05 * stain), grain)
    })
}

/// Paints carpet tiles of two tones, 50 cm each, turned against each other.
fn carpet(seed: u32) -> paint::Surface {
    paint::surface("carpet", [512, 512], 0.004, |uv| {
        let cell = (uv * 4.0).floor();
        let local = (uv * 4.0).fract();
        let turned = ((cell.x + cell.y) as u32).is_multiple_of(2);
        let loops = if turned { uv * vec2(96.0, 48.0) } else { uv * vec2(48.0, 96.0) };
        let bump = (loops.x * TAU).sin() * (loops.y * TAU).sin() * 0.5 + 0.5;
        let fleck = paint::unit(paint::hash_cell(seed, loops.x as u32, loops.y as u32));
        let tone = paint::unit(paint::hash_cell(seed, cell.x as u32, cell.y as u32)) * 0.14;
        let seam = local.min_element() < 0.012;
        let base = vec3(0.3, 0.33, 0.37) * (0.72 + 0.2 * bump + 0.3 * fleck + tone);
        (if seam { base * 0.75 } else { base }, bump)
    })
}

fn whiteboard_picture() -> TextureImage {
    let mut c = Canvas::new([768, 384], vec4(0.95, 0.95, 0.95, 1.0));
    let (blue, red, green) =
        (vec4(0.1, 0.25, 0.7, 1.0), vec4(0.8, 0.15, 0.12, 1.0), vec4(0.1, 0.5, 0.25, 1.0));
    c.text(vec2(40.0, 30.0), 44.0, "ROADMAP", blue);
    c.line(vec2(40.0, 84.0), vec2(330.0, 88.0), 4.0, blue);
    for (i, label) in ["PLAN", "BUILD", "TEST", "SHIP"].iter().enumerate() {
        let x = 50.0 + 175.0 * i as f32;
        let color = [blue, red, green, blue][i];
        for [a, e] in [
            [vec2(x, 140.0), vec2(x + 120.0, 143.0)],
            [vec2(x + 120.0, 143.0), vec2(x + 118.0, 204.0)],
            [vec2(x + 118.0, 204.0), vec2(x + 2.0, 201.0)],
            [vec2(x + 2.0, 201.0), vec2(x, 140.0)],
        ] {
            c.line(a, e, 4.0, color);
        }
        c.text(vec2(x + 14.0, 158.0), 26.0, label, color);
        if i < 3 {
            c.line(vec2(x + 126.0, 172.0), vec2(x + 168.0, 170.0), 4.0, blue);
            c.line(vec2(x + 168.0, 170.0), vec2(x + 156.0, 160.0), 4.0, blue);
            c.line(vec2(x + 168.0, 170.0), vec2(x + 156.0, 181.0), 4.0, blue);
        }
    }
    let curve: Vec<Vec2> = (0..40)
        .map(|i| {
            let t = i as f32 / 39.0;
            vec2(80.0 + 300.0 * t, 350.0 - 90.0 * t * t - 10.0 * (t * 20.0).sin())
        })
        .collect();
    for pair in curve.windows(2) {
        c.line(pair[0], pair[1], 4.0, red);
    }
    c.line(vec2(70.0, 250.0), vec2(70.0, 358.0), 4.0, blue);
    c.line(vec2(70.0, 358.0), vec2(400.0, 356.0), 4.0, blue);
    for i in 0..4 {
        let y = 250.0 + 28.0 * i as f32;
        c.ellipse(vec2(470.0, y + 8.0), Vec2::splat(5.0), green);
        c.line(vec2(490.0, y + 8.0), vec2(620.0 + 25.0 * (i % 3) as f32, y + 10.0), 4.0, green);
    }
    c.into_texture("whiteboard")
}

fn paper_picture() -> TextureImage {
    let mut c = Canvas::new([192, 272], vec4(0.97, 0.97, 0.95, 1.0));
    let ink = vec4(0.2, 0.2, 0.22, 1.0);
    c.text(vec2(20.0, 18.0), 16.0, "AGENDA", ink);
    for i in 0..16 {
        let y = 50.0 + 13.0 * i as f32;
        let end = 172.0 - if i % 5 == 4 { 70.0 } else { 7.0 * (i % 3) as f32 };
        c.line(vec2(20.0, y), vec2(end, y), 2.2, vec4(0.45, 0.45, 0.48, 1.0));
    }
    c.into_texture("paper")
}

fn art_picture(name: &str, seed: u32) -> TextureImage {
    let palette = [vec3(0.85, 0.45, 0.25), vec3(0.2, 0.35, 0.5), vec3(0.93, 0.83, 0.6), vec3(0.3, 0.5, 0.42)];
    let mut c = Canvas::new([256, 320], vec4(0.94, 0.91, 0.85, 1.0));
    for i in 0..14 {
        let r = |k: u32| paint::unit(paint::hash_cell(seed, i, k));
        let color = palette[i as usize % 4].extend(0.85);
        let at = vec2(30.0 + 196.0 * r(1), 30.0 + 260.0 * r(2));
        if i % 3 == 0 {
            c.ellipse(at, Vec2::splat(18.0 + 50.0 * r(3)), color);
        } else {
            let size = vec2(20.0 + 70.0 * r(3), 20.0 + 110.0 * r(4));
            c.rect((at - size * 0.5).max(Vec2::ZERO), (at + size * 0.5).min(vec2(256.0, 320.0)), color);
        }
    }
    c.into_texture(name)
}

fn shell(b: &mut SceneBuilder, p: &Palette) {
    let (x, z) = (ROOM.x, ROOM.y);
    b.object("floor").with_material(p.carpet);
    b.rectangle(vec3(-x, 0.0, z), Vec3::X * 2.0 * x, Vec3::NEG_Z * 2.0 * z);
    b.object("walls").with_material(p.wall);
    b.rectangle(vec3(-x, 0.0, z), Vec3::NEG_Z * 2.0 * z, Vec3::Y * CEILING);
    b.rectangle(vec3(x, 0.0, -z), Vec3::Z * 2.0 * z, Vec3::Y * CEILING);
    b.rectangle(vec3(x, 0.0, z), Vec3::NEG_X * 2.0 * x, Vec3::Y * CEILING);
    // The outside, which keeps the sun from shining in from behind.
    for (corner, right) in [
        (vec3(-x - 0.2, 0.0, -z), Vec3::Z * (2.0 * z + 0.2)),
        (vec3(x + 0.2, 0.0, z + 0.2), Vec3::NEG_Z * (2.0 * z + 0.2)),
        (vec3(-x - 0.2, 0.0, z + 0.2), Vec3::X * (2.0 * x + 0.4)),
    ] {
        b.rectangle(corner, right, Vec3::Y * (CEILING + 0.3));
    }
    b.rectangle(
        vec3(-x - 0.2, CEILING + 0.3, z + 0.2),
        Vec3::X * (2.0 * x + 0.4),
        Vec3::NEG_Z * (2.0 * z + 0.4),
    );
    b.object("skirting").with_material(p.skirting);
    b.beveled_cuboid(vec3(-x, 0.0, -z), vec3(-x + 0.015, 0.09, z), 0.004);
    b.beveled_cuboid(vec3(x - 0.015, 0.0, -z), vec3(x, 0.09, -0.8), 0.004);
}

/// Builds a grid of panels with lamps, vents and sprinklers. Returns the lamps' lights.
fn ceiling(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) -> Vec<PointLight> {
    b.object("ceiling").with_material(p.ceiling);
    b.rectangle(vec3(-ROOM.x, CEILING, -ROOM.y), Vec3::X * 2.0 * ROOM.x, Vec3::Z * 2.0 * ROOM.y);
    b.with_material(p.ceiling_bar);
    let step = 0.6;
    let mut x = -ROOM.x + 0.4;
    while x < ROOM.x {
        b.cuboid_faces(
            vec3(x - 0.012, CEILING - 0.01, -ROOM.y),
            vec3(x + 0.012, CEILING, ROOM.y),
            BoxFaces::ALL.without(BoxFaces::TOP),
        );
        x += step;
    }
    let mut z = -ROOM.y + 0.2;
    while z < ROOM.y {
        b.cuboid_faces(
            vec3(-ROOM.x, CEILING - 0.01, z - 0.012),
            vec3(ROOM.x, CEILING, z + 0.012),
            BoxFaces::ALL.without(BoxFaces::TOP),
        );
        z += step;
    }
    let mut lights = Vec::new();
    for (i, x) in [-4.6, -1.6, 1.4, 4.4].into_iter().enumerate() {
        for (j, z) in [-2.3, 1.9].into_iter().enumerate() {
            b.object(&format!("ceiling lamp {i} {j}"));
            let (min, max) =
                (vec3(x - 0.288, CEILING - 0.012, z - 0.288), vec3(x + 0.288, CEILING - 0.003, z + 0.288));
            b.with_material(p.lamp).cuboid_faces(min, max, BoxFaces::BOTTOM);
            b.with_material(p.ceiling_bar);
            for k in 0..=6 {
                let t = k as f32 / 6.0;
                let (a, c) = (min.x + (max.x - min.x) * t, min.z + (max.z - min.z) * t);
                b.cuboid(vec3(a - 0.004, CEILING - 0.045, min.z), vec3(a + 0.004, CEILING - 0.012, max.z));
                b.cuboid(vec3(min.x, CEILING - 0.045, c - 0.004), vec3(max.x, CEILING - 0.012, c + 0.004));
            }
            lights.push(PointLight {
                position: vec3(x, CEILING - 0.35, z),
                color: vec3(1.25, 1.2, 1.1),
                range: 6.5,
            });
        }
    }
    for (i, x) in [-3.1, 0.0, 2.9].into_iter().enumerate() {
        b.object(&format!("vent {i}")).with_material(p.ceiling_bar);
        for k in 0..10 {
            let z = 3.0 + 0.05 * k as f32;
            b.quad(
                [
                    vec3(x - 0.5, CEILING - 0.035, z),
                    vec3(x - 0.5, CEILING - 0.012, z + 0.035),
                    vec3(x + 0.5, CEILING - 0.012, z + 0.035),
                    vec3(x + 0.5, CEILING - 0.035, z),
                ]
                .map(|q| q - Vec3::Y * 0.004),
            );
        }
        b.cuboid(vec3(x - 0.54, CEILING - 0.04, 2.96), vec3(x - 0.5, CEILING, 3.52));
        b.cuboid(vec3(x + 0.5, CEILING - 0.04, 2.96), vec3(x + 0.54, CEILING, 3.52));
        b.with_material(p.chrome);
        b.within(moved(x + around(rng, 0.6, 0.2), CEILING, -0.7), |b| {
            b.lathe(
                &[(0.0, -0.06), (0.018, -0.06), (0.006, -0.045), (0.006, -0.02), (0.04, -0.01), (0.04, 0.0)],
                16,
            );
        });
    }
    // A projector on its pole.
    b.object("projector").with_material(p.white);
    b.beveled_cuboid(vec3(-1.75, 2.42, -0.17), vec3(-1.3, 2.56, 0.17), 0.03);
    b.with_material(p.black);
    b.cylinder(vec3(-1.75, 2.48, 0.05), vec3(-1.8, 2.48, 0.05), 0.05, 0.045, 20, true);
    b.with_material(p.chrome).cylinder(
        vec3(-1.52, 2.56, 0.0),
        vec3(-1.52, CEILING, 0.0),
        0.02,
        0.02,
        12,
        false,
    );
    lights
}

/// Builds four windows with blinds, a sill and radiators below.
fn windows(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    let z = -ROOM.y;
    let (sill, head) = (0.82, 2.72);
    b.object("window wall").with_material(p.wall);
    let x = ROOM.x;
    b.rectangle(vec3(-x, 0.0, z), Vec3::X * 2.0 * x, Vec3::Y * sill);
    b.rectangle(vec3(-x, head, z), Vec3::X * 2.0 * x, Vec3::Y * (CEILING - head));
    b.rectangle(vec3(x, 0.0, z - 0.3), Vec3::NEG_X * 2.0 * x, Vec3::Y * sill);
    b.rectangle(vec3(x, head, z - 0.3), Vec3::NEG_X * 2.0 * x, Vec3::Y * (CEILING + 0.3 - head));
    b.rectangle(vec3(-x, sill, z), Vec3::X * 2.0 * x, Vec3::NEG_Z * 0.3);
    b.rectangle(vec3(-x, head, z - 0.3), Vec3::X * 2.0 * x, Vec3::Z * 0.3);
    let count = 4;
    let width = 2.0 * x / count as f32;
    for i in 0..=count {
        let at = -x + width * i as f32;
        b.with_material(p.wall);
        let (left, right) = ((at - 0.17).max(-x), (at + 0.17).min(x));
        let faces = BoxFaces::LEFT.and(BoxFaces::RIGHT).and(BoxFaces::FRONT).and(BoxFaces::BACK);
        b.cuboid_faces(vec3(left, sill, z - 0.3), vec3(right, head, z + 0.002), faces);
    }
    b.object("window sill").with_material(p.white);
    b.beveled_cuboid(vec3(-x, sill - 0.03, z - 0.02), vec3(x, sill + 0.005, z + 0.24), 0.01);
    for i in 0..count {
        let (left, right) = (-x + width * i as f32 + 0.17, -x + width * (i + 1) as f32 - 0.17);
        b.object(&format!("window {i}")).with_material(p.dark);
        let (back, front) = (z - 0.2, z - 0.14);
        let bars = [
            (left, left + 0.05, sill, head),
            (right - 0.05, right, sill, head),
            (left, right, sill, sill + 0.06),
            (left, right, head - 0.05, head),
            ((left + right) * 0.5 - 0.03, (left + right) * 0.5 + 0.03, sill, head),
        ];
        for (x0, x1, y0, y1) in bars {
            b.beveled_cuboid(vec3(x0, y0, back), vec3(x1, y1, front), 0.008);
        }
        b.with_material(p.pane);
        b.rectangle(vec3(left, sill, z - 0.17), Vec3::X * (right - left), Vec3::Y * (head - sill));
        blind(
            b,
            p,
            i,
            [vec3(left + 0.02, head - 0.05, z - 0.06), vec3(right - 0.02, sill + 0.08, z - 0.06)],
            rng,
        );
        b.object(&format!("radiator {i}")).with_material(p.white);
        for k in 0..22 {
            let at = left + 0.25 + k as f32 * 0.09;
            b.beveled_cuboid(vec3(at, 0.12, z + 0.05), vec3(at + 0.075, 0.7, z + 0.15), 0.02);
        }
    }
}

/// Builds a venetian blind between its upper left and lower right corners.
fn blind(b: &mut SceneBuilder, p: &Palette, number: usize, [top, low]: [Vec3; 2], rng: &mut Pcg32) {
    b.object(&format!("blind {number}"));
    let drawn = [0.55, 1.0, 0.82, 1.0][number % 4];
    let pitch = 0.043;
    let slats = ((top.y - low.y) * drawn / pitch) as usize;
    let tilt = around(rng, 0.42, 0.12);
    b.with_material(p.slat);
    b.beveled_cuboid(top - vec3(0.0, 0.0, 0.02), vec3(low.x, top.y + 0.045, top.z + 0.025), 0.006);
    for i in 1..=slats {
        let y = top.y - pitch * i as f32;
        let angle = tilt + around(rng, 0.0, 0.03);
        let droop = around(rng, 0.0, 0.003);
        b.surface(6, 4, false, |u, v| {
            let across = (v - 0.5) * 0.046;
            let crown = 0.005 * (1.0 - (v * 2.0 - 1.0).powi(2)) - droop * (u * PI).sin();
            let (sin, cos) = angle.sin_cos();
            let x = top.x + (low.x - top.x) * u;
            (vec3(x, y + crown * cos + across * sin, top.z - across * cos), vec2(x, v * 0.05))
        });
    }
    let bottom = top.y - pitch * (slats as f32 + 1.0);
    b.beveled_cuboid(
        vec3(top.x, bottom - 0.01, top.z - 0.018),
        vec3(low.x, bottom + 0.008, top.z + 0.018),
        0.004,
    );
    b.with_material(p.cord);
    for k in 0..4 {
        let x = top.x + (low.x - top.x) * (0.08 + 0.28 * k as f32);
        for side in [-0.024, 0.024] {
            b.cylinder(vec3(x, bottom, top.z + side), vec3(x, top.y, top.z + side), 0.0014, 0.0014, 4, false);
        }
    }
    let x = low.x - 0.12;
    let path: Vec<Vec3> =
        (0..=12).map(|k| vec3(x + 0.006 * (k as f32).sin(), top.y - 0.11 * k as f32, top.z + 0.04)).collect();
    b.tube(&path, 0.002, 5, false);
    b.ellipsoid(vec3(x, top.y - 1.36, top.z + 0.04), vec3(0.008, 0.028, 0.008), 6, 10);
}

fn screen_wall(b: &mut SceneBuilder, p: &Palette) {
    b.object("screen");
    b.within(placed(vec3(-ROOM.x, 1.62, 0.0), FRAC_PI_2), |b| {
        b.with_material(p.black);
        b.beveled_cuboid(vec3(-1.36, -0.79, 0.0), vec3(1.36, 0.79, 0.07), 0.012);
        b.with_material(p.screen);
        b.picture(
            [[-1.32, -0.75], [1.32, -0.75], [1.32, 0.75], [-1.32, 0.75]].map(|c| vec3(c[0], c[1], 0.072)),
        );
        b.with_material(p.black);
        b.beveled_cuboid(vec3(-0.55, -0.97, 0.0), vec3(0.55, -0.86, 0.1), 0.02);
        b.beveled_cuboid(vec3(-0.08, 0.82, 0.0), vec3(0.08, 0.9, 0.12), 0.015);
        b.ellipsoid(vec3(0.0, 0.86, 0.12), Vec3::splat(0.03), 10, 16);
    });
    for (i, z) in [-2.5, 2.6].into_iter().enumerate() {
        b.object(&format!("loudspeaker {i}"));
        b.within(placed(vec3(-ROOM.x, 1.75, z), FRAC_PI_2), |b| {
            b.with_material(p.dark).beveled_cuboid(vec3(-0.13, -0.3, 0.0), vec3(0.13, 0.3, 0.2), 0.015);
            b.with_material(p.black);
            for (y, r) in [(-0.12, 0.09), (0.15, 0.05)] {
                b.within(moved(0.0, y, 0.2) * Affine3A::from_rotation_x(FRAC_PI_2), |b| {
                    b.lathe(
                        &[(r * 1.1, 0.0), (r * 1.1, 0.012), (r, 0.014), (r * 0.35, -0.02), (0.0, 0.0)],
                        24,
                    );
                });
            }
        });
    }
}

fn batten_wall(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    let z = ROOM.y;
    b.object("batten wall");
    b.with_material(p.black);
    b.rectangle(vec3(ROOM.x, 0.0, z - 0.015), Vec3::NEG_X * 2.0 * ROOM.x, Vec3::Y * CEILING);
    b.with_material(p.batten);
    let pitch = 0.075;
    let faces = BoxFaces::LEFT.and(BoxFaces::RIGHT).and(BoxFaces::BACK);
    for i in 0..(2.0 * ROOM.x / pitch) as usize {
        let x = -ROOM.x + 0.02 + pitch * i as f32;
        b.set_uv_offset(vec2(around(rng, 0.0, 1.0), around(rng, 0.0, 1.0)));
        b.cuboid_faces(vec3(x, 0.0, z - 0.055), vec3(x + 0.042, CEILING, z), faces);
    }
    b.set_uv_offset(Vec2::ZERO);
    // A sideboard with a coffee machine, cups and books.
    b.object("sideboard").with_material(p.dark);
    let front = z - 0.5;
    b.beveled_cuboid(vec3(-1.9, 0.12, front), vec3(1.9, 0.8, z - 0.06), 0.01);
    b.with_material(p.table).beveled_cuboid(
        vec3(-1.94, 0.8, front - 0.03),
        vec3(1.94, 0.83, z - 0.06),
        0.008,
    );
    for i in 0..4 {
        let x = -1.86 + 0.94 * i as f32;
        b.with_material(p.wood);
        b.beveled_cuboid(vec3(x, 0.16, front - 0.018), vec3(x + 0.9, 0.76, front + 0.01), 0.006);
        b.with_material(p.chrome);
        b.tube(
            &[
                vec3(x + 0.3, 0.68, front - 0.015),
                vec3(x + 0.3, 0.68, front - 0.045),
                vec3(x + 0.6, 0.68, front - 0.045),
                vec3(x + 0.6, 0.68, front - 0.015),
            ],
            0.006,
            8,
            false,
        );
    }
    for x in [-1.8, 1.76] {
        for z in [front + 0.05, z - 0.15] {
            b.cylinder(vec3(x, 0.0, z), vec3(x, 0.12, z), 0.015, 0.02, 10, false);
        }
    }
    let y = 0.83;
    b.object("coffee machine").with_material(p.chrome);
    b.beveled_cuboid(vec3(-1.5, y, z - 0.42), vec3(-1.15, y + 0.36, z - 0.12), 0.02);
    b.with_material(p.black);
    b.beveled_cuboid(vec3(-1.47, y + 0.02, z - 0.5), vec3(-1.18, y + 0.05, z - 0.4), 0.008);
    b.beveled_cuboid(vec3(-1.47, y + 0.24, z - 0.48), vec3(-1.18, y + 0.35, z - 0.4), 0.015);
    b.cylinder(vec3(-1.32, y + 0.24, z - 0.45), vec3(-1.32, y + 0.18, z - 0.45), 0.016, 0.012, 12, true);
    for i in 0..7 {
        b.object(&format!("sideboard cup {i}"));
        let at = vec3(-0.95 + 0.13 * (i % 4) as f32, y, z - 0.35 + 0.15 * (i / 4) as f32);
        b.within(placed(at, rng.random::<f32>() * TAU), |b| cup(b, p.china, p.coffee));
    }
    b.object("shelf books").with_material(p.books);
    let books = [[0.5, 0.0], [1.2, 0.0], [1.2, 0.24], [0.5, 0.24]];
    b.picture(books.map(|c| vec3(1.7 - c[0], y + c[1], z - 0.38)));
    b.with_material(p.dark);
    b.cuboid_faces(
        vec3(0.5, y, z - 0.379),
        vec3(1.2, y + 0.24, z - 0.16),
        BoxFaces::STANDING.without(BoxFaces::BACK),
    );
    for (i, x) in [-3.4, 3.2].into_iter().enumerate() {
        b.object(&format!("picture {i}"));
        b.within(placed(vec3(x, 1.65, z - 0.06), PI), |b| {
            b.with_material(p.black);
            b.beveled_cuboid(vec3(-0.46, -0.56, -0.01), vec3(0.46, 0.56, 0.03), 0.01);
            b.with_material(p.art[i]);
            b.picture(
                [[-0.42, -0.52], [0.42, -0.52], [0.42, 0.52], [-0.42, 0.52]].map(|c| vec3(c[0], c[1], 0.032)),
            );
        });
    }
}

fn door_wall(b: &mut SceneBuilder, p: &Palette) {
    b.object("whiteboard");
    b.within(placed(vec3(ROOM.x, 1.5, -1.6), -FRAC_PI_2), |b| {
        b.with_material(p.chrome).beveled_cuboid(vec3(-1.25, -0.66, 0.0), vec3(1.25, 0.66, 0.025), 0.008);
        b.with_material(p.whiteboard);
        b.picture(
            [[-1.22, -0.63], [1.22, -0.63], [1.22, 0.63], [-1.22, 0.63]].map(|c| vec3(c[0], c[1], 0.027)),
        );
        b.with_material(p.chrome).beveled_cuboid(vec3(-0.9, -0.72, 0.0), vec3(0.9, -0.67, 0.1), 0.006);
        for (i, color) in [p.black, p.screen, p.leather].into_iter().enumerate() {
            let x = -0.3 + 0.2 * i as f32;
            b.with_material(color);
            b.cylinder(vec3(x, -0.66, 0.05), vec3(x + 0.13, -0.66, 0.05), 0.009, 0.009, 10, true);
        }
    });
    b.object("door");
    b.within(placed(vec3(ROOM.x, 0.0, 1.9), -FRAC_PI_2), |b| {
        b.with_material(p.dark);
        for (x0, x1, y0, y1) in [(-0.58, -0.5, 0.0, 2.2), (0.5, 0.58, 0.0, 2.2), (-0.58, 0.58, 2.12, 2.2)] {
            b.beveled_cuboid(vec3(x0, y0, -0.02), vec3(x1, y1, 0.05), 0.01);
        }
        b.with_material(p.wood);
        b.beveled_cuboid(vec3(-0.5, 0.01, -0.01), vec3(0.5, 2.12, 0.025), 0.006);
        b.with_material(p.dark).beveled_cuboid(vec3(0.12, 0.9, 0.02), vec3(0.36, 1.95, 0.03), 0.004);
        b.with_material(p.chrome);
        b.tube(&[vec3(-0.4, 1.02, 0.02), vec3(-0.4, 1.02, 0.075), vec3(-0.27, 1.02, 0.075)], 0.01, 10, true);
        b.cylinder(vec3(-0.4, 1.02, 0.02), vec3(-0.4, 1.02, 0.032), 0.026, 0.026, 18, true);
    });
    b.object("clock");
    b.within(placed(vec3(ROOM.x, 2.45, 0.4), -FRAC_PI_2) * Affine3A::from_rotation_x(FRAC_PI_2), |b| {
        b.with_material(p.black);
        b.lathe(&[(0.19, 0.0), (0.19, 0.035), (0.175, 0.04), (0.17, 0.02)], 40);
        b.with_material(p.white).lathe(&[(0.172, 0.022), (0.0, 0.022)], 40);
        b.with_material(p.black);
        for hour in 0..12 {
            b.within(Affine3A::from_rotation_y(hour as f32 / 12.0 * TAU), |b| {
                b.cuboid(vec3(-0.004, 0.022, 0.135), vec3(0.004, 0.026, 0.16));
            });
        }
        for (turn, length, half) in [(0.9, 0.09, 0.005), (2.6, 0.135, 0.0035)] {
            b.within(Affine3A::from_rotation_y(turn), |b| {
                b.cuboid(vec3(-half, 0.027, -0.02), vec3(half, 0.03, length));
            });
        }
    });
    b.object("coat stand").with_material(p.dark);
    let foot = vec3(4.95, 0.0, 3.2);
    b.cylinder(foot, foot + Vec3::Y * 1.8, 0.018, 0.014, 12, true);
    for k in 0..6 {
        let (sin, cos) = (k as f32 / 6.0 * TAU).sin_cos();
        let out = vec3(cos, 0.0, sin);
        if k % 2 == 0 {
            b.tube(&[foot + Vec3::Y * 0.25, foot + out * 0.26 + Vec3::Y * 0.02], 0.013, 8, true);
        }
        let top = foot + Vec3::Y * 1.68;
        b.tube(&[top, top + out * 0.12 + Vec3::Y * 0.02, top + out * 0.17 + Vec3::Y * 0.1], 0.009, 8, true);
        b.ellipsoid(top + out * 0.17 + Vec3::Y * 0.11, Vec3::splat(0.016), 8, 12);
    }
}

/// Returns the outline of the table, a boat shape, counter-clockwise in x and -z.
fn table_outline(grow: f32) -> Vec<Vec2> {
    (0..72)
        .map(|i| {
            let (sin, cos) = (i as f32 / 72.0 * TAU).sin_cos();
            let squared = |v: f32, power: f32| v.signum() * v.abs().powf(power);
            vec2(squared(cos, 0.35) * (TABLE.x + grow), squared(sin, 0.55) * (TABLE.y + grow))
        })
        .collect()
}

fn table(b: &mut SceneBuilder, p: &Palette) {
    let flat = Affine3A::from_rotation_x(-FRAC_PI_2);
    b.with_material(p.table);
    b.within(flat, |b| b.extrude(&table_outline(0.0), TOP - 0.032, TOP, true));
    b.with_material(p.dark);
    b.within(flat, |b| b.extrude(&table_outline(-0.06), TOP - 0.06, TOP - 0.032, true));
    let mut edge: Vec<Vec3> = table_outline(0.004).iter().map(|q| vec3(q.x, TOP - 0.012, -q.y)).collect();
    edge.push(edge[0]);
    b.with_material(p.chrome).tube(&edge, 0.009, 8, false);
    for x in [-1.9, 0.0, 1.9] {
        b.with_material(p.dark);
        b.beveled_cuboid(vec3(x - 0.2, 0.05, -0.32), vec3(x + 0.2, TOP - 0.06, 0.32), 0.03);
        b.with_material(p.chrome);
        b.beveled_cuboid(vec3(x - 0.3, 0.0, -0.5), vec3(x + 0.3, 0.05, 0.5), 0.012);
    }
    // Sockets in the middle, with their cables.
    for x in [-1.2, 1.2] {
        b.with_material(p.chrome);
        b.beveled_cuboid(vec3(x - 0.2, TOP, -0.07), vec3(x + 0.2, TOP + 0.006, 0.07), 0.002);
        b.with_material(p.black);
        for k in 0..5 {
            let at = x - 0.15 + 0.075 * k as f32;
            b.cuboid(vec3(at - 0.02, TOP + 0.004, -0.04), vec3(at + 0.02, TOP + 0.008, 0.04));
        }
    }
}

fn chairs(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    let mut places: Vec<(Vec3, f32)> = Vec::new();
    for i in 0..5 {
        let x = -2.35 + 1.175 * i as f32;
        places.push((vec3(x, 0.0, -TABLE.y - 0.42), 0.0));
        places.push((vec3(x, 0.0, TABLE.y + 0.42), PI));
    }
    places.push((vec3(-TABLE.x - 0.42, 0.0, 0.0), FRAC_PI_2));
    places.push((vec3(TABLE.x + 0.42, 0.0, 0.0), -FRAC_PI_2));
    for (i, (at, yaw)) in places.into_iter().enumerate() {
        let at = at + vec3(around(rng, 0.0, 0.08), 0.0, around(rng, 0.0, 0.08));
        b.object(&format!("chair {i}"));
        b.within(placed(at, yaw + around(rng, 0.0, 0.35)), |b| office_chair(b, p, rng));
    }
}

/// Builds a rounded cushion between two corners.
fn cushion(b: &mut SceneBuilder, min: Vec3, max: Vec3) {
    let (center, half) = ((min + max) * 0.5, (max - min) * 0.5);
    let squared = |v: f32, power: f32| v.signum() * v.abs().powf(power);
    b.surface(28, 14, true, |u, v| {
        let (sin, cos) = if u == 1.0 { (0.0, 1.0) } else { (u * TAU).sin_cos() };
        let (ring, rise) = if v == 0.0 {
            (0.0, -1.0)
        } else if v == 1.0 {
            (0.0, 1.0)
        } else {
            ((v * PI).sin(), -(v * PI).cos())
        };
        let out = ring.powf(0.4);
        let at = vec3(squared(cos, 0.45) * out, squared(rise, 0.6), -squared(sin, 0.45) * out);
        (center + at * half, vec2(at.x * half.x, at.z * half.z + at.y * half.y))
    });
}

/// Builds a swivel chair that faces +z.
fn office_chair(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    b.with_material(p.chrome);
    let spin = rng.random::<f32>() * TAU;
    for k in 0..5 {
        let (sin, cos) = (spin + k as f32 / 5.0 * TAU).sin_cos();
        let out = vec3(cos, 0.0, sin);
        b.with_material(p.chrome);
        let leg: Vec<Vec3> =
            (0..=6).map(|i| out * (0.03 + 0.048 * i as f32) + Vec3::Y * (0.12 - 0.007 * i as f32)).collect();
        b.tapered_tube(&leg, &|t| 0.022 - 0.008 * t, 10, true);
        b.with_material(p.black);
        let hub = out * 0.315 + Vec3::Y * 0.03;
        let axle = vec3(-sin, 0.0, cos);
        for side in [-1.0, 1.0] {
            b.cylinder(hub + axle * 0.006 * side, hub + axle * 0.026 * side, 0.029, 0.026, 16, true);
        }
    }
    b.with_material(p.black).cylinder(vec3(0.0, 0.09, 0.0), vec3(0.0, 0.26, 0.0), 0.032, 0.028, 16, true);
    b.with_material(p.chrome).cylinder(vec3(0.0, 0.26, 0.0), vec3(0.0, 0.41, 0.0), 0.017, 0.017, 14, false);
    b.with_material(p.black);
    b.beveled_cuboid(vec3(-0.12, 0.4, -0.15), vec3(0.12, 0.43, 0.12), 0.01);
    b.with_material(p.fabric);
    cushion(b, vec3(-0.245, 0.425, -0.22), vec3(0.245, 0.5, 0.26));
    // The back: a bent frame with mesh in it.
    let lean = |rise: f32| -0.21 - 0.16 * rise - 0.1 * (rise * 1.6).sin();
    let shape = |u: f32, v: f32| {
        let rise = 0.1 + 0.5 * v;
        let half = 0.215 * (1.0 - 0.18 * v * v) * (1.0 - 0.12 * (1.0 - v));
        let side = u * 2.0 - 1.0;
        vec3(side * half, 0.48 + rise, lean(rise) + 0.05 * side * side)
    };
    b.with_material(p.mesh);
    b.surface(10, 12, false, |u, v| (shape(1.0 - u, v), vec2(u * 0.42, v * 0.5)));
    b.with_material(p.black);
    let mut frame = Vec::new();
    for i in 0..=12 {
        frame.push(shape(0.0, i as f32 / 12.0));
    }
    for i in 1..=12 {
        frame.push(shape(i as f32 / 12.0, 1.0) + Vec3::Y * 0.015 * (i as f32 / 12.0 * PI).sin());
    }
    for i in 1..=12 {
        frame.push(shape(1.0, 1.0 - i as f32 / 12.0));
    }
    for i in 1..=12 {
        frame.push(shape(1.0 - i as f32 / 12.0, 0.0));
    }
    b.tube(&frame, 0.011, 8, false);
    let lumbar: Vec<Vec3> = (0..=12).map(|i| shape(i as f32 / 12.0, 0.35) - Vec3::Z * 0.015).collect();
    b.tube(&lumbar, 0.009, 8, true);
    b.tube(
        &[vec3(0.0, 0.41, -0.1), vec3(0.0, 0.42, -0.26), shape(0.5, 0.0), shape(0.5, 0.35) - Vec3::Z * 0.02],
        0.018,
        10,
        true,
    );
    for side in [-1.0, 1.0] {
        let x = 0.29 * side;
        b.tube(
            &[
                vec3(0.1 * side, 0.415, 0.0),
                vec3(x, 0.425, 0.0),
                vec3(x * 1.02, 0.5, -0.01),
                vec3(x, 0.655, -0.02),
            ],
            0.013,
            8,
            true,
        );
        b.beveled_cuboid(vec3(x - 0.042, 0.65, -0.13), vec3(x + 0.042, 0.682, 0.13), 0.012);
    }
}

fn on_the_table(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    let y = TOP + 0.001;
    for (i, (x, z, yaw)) in
        [(-2.35, -0.52, PI), (0.0, 0.52, 0.0), (1.175, -0.52, PI), (2.35, 0.52, 0.0), (-1.175, 0.52, 0.0)]
            .into_iter()
            .enumerate()
    {
        b.object(&format!("laptop {i}"));
        b.within(placed(vec3(x, y, z), yaw + around(rng, 0.0, 0.15)), |b| laptop(b, p, i));
        // Its mains cable, to the sockets in the middle.
        b.with_material(p.black);
        let from = vec3(x + 0.18, y + 0.006, z);
        let to = vec3(1.2 * x.signum(), y + 0.008, 0.0);
        let path: Vec<Vec3> = (0..=16)
            .map(|k| {
                let t = k as f32 / 16.0;
                from.lerp(to, t) + vec3(0.06 * (t * PI * 2.0).sin(), 0.0, 0.05 * (t * PI).sin())
            })
            .collect();
        b.tube(&path, 0.003, 6, false);
    }
    for i in 0..5 {
        for side in [-1.0, 1.0] {
            let x = -2.35 + 1.175 * i as f32;
            let place = |dx: f32, dz: f32| vec3(x + dx * side, y, (0.52 + dz) * side);
            b.object(&format!("place {i} {}", if side < 0.0 { "window" } else { "wall" }));
            b.with_material(p.paper);
            let facing = if side > 0.0 { 0.0 } else { PI };
            for sheet in 0..rng.random_range(1..4) {
                let at = place(0.3, 0.1 + 0.01 * sheet as f32) + Vec3::Y * (0.0012 * sheet as f32 + 0.0006);
                b.within(placed(at, facing + around(rng, 0.0, 0.25)), |b| {
                    let corners = [[-0.105, 0.148], [0.105, 0.148], [0.105, -0.148], [-0.105, -0.148]];
                    b.picture(corners.map(|c| vec3(c[0], 0.0, c[1])));
                });
            }
            b.with_material([p.black, p.leather, p.chrome][rng.random_range(0..3)]);
            let pen = place(0.3, around(rng, 0.1, 0.05)) + Vec3::Y * 0.01;
            let turn = rng.random::<f32>() * TAU;
            let along = vec3(turn.cos(), 0.0, turn.sin()) * 0.07;
            b.cylinder(pen - along, pen + along, 0.005, 0.004, 8, true);
            if rng.random_bool(0.8) {
                b.within(placed(place(-0.28, 0.12), rng.random::<f32>() * TAU), |b| {
                    cup(b, p.china, p.coffee)
                });
            }
            b.within(moved_to(place(-0.32, -0.14)), |b| tumbler(b, p, 0.033, 0.11));
            b.object(&format!("microphone {i} {}", if side < 0.0 { "window" } else { "wall" }));
            b.within(placed(place(0.0, -0.27), facing), |b| microphone(b, p));
        }
    }
    for (i, x) in [-1.75, 0.55].into_iter().enumerate() {
        b.object(&format!("carafe {i}"));
        b.within(moved(x, y, 0.08), |b| {
            b.with_material(p.chrome);
            b.lathe(&[(0.0, 0.0), (0.12, 0.0), (0.125, 0.006), (0.12, 0.012), (0.0, 0.012)], 32);
            b.within(moved(0.0, 0.012, 0.0), |b| {
                b.with_material(p.tumbler);
                b.lathe(
                    &[
                        (0.05, 0.002),
                        (0.056, 0.02),
                        (0.056, 0.12),
                        (0.03, 0.18),
                        (0.027, 0.23),
                        (0.036, 0.26),
                    ],
                    28,
                );
            });
        });
    }
    b.object("conference telephone").with_material(p.black);
    b.within(moved(0.0, y, -0.05), |b| {
        b.lathe(&[(0.06, 0.0), (0.15, 0.01), (0.16, 0.02), (0.1, 0.045), (0.06, 0.055), (0.0, 0.056)], 3);
        b.lathe(&[(0.07, 0.05), (0.068, 0.062), (0.0, 0.064)], 28);
    });
    b.object("bowl").with_material(p.china);
    b.within(moved(-0.55, y, 0.03), |b| {
        b.lathe(
            &[
                (0.06, 0.0),
                (0.065, 0.012),
                (0.14, 0.06),
                (0.15, 0.075),
                (0.15, 0.075),
                (0.13, 0.06),
                (0.0, 0.02),
            ],
            32,
        );
        for k in 0..6 {
            let (sin, cos) = (k as f32 * 1.05).sin_cos();
            let lift = if k == 5 { 0.11 } else { 0.062 };
            let at = if k == 5 { Vec3::ZERO } else { vec3(cos * 0.065, 0.0, sin * 0.065) };
            b.with_material([p.leather, p.pendant][k % 2]);
            b.ellipsoid(at + Vec3::Y * lift, vec3(0.038, 0.036, 0.038), 12, 18);
        }
    });
}

fn moved_to(at: Vec3) -> Affine3A {
    Affine3A::from_translation(at)
}

/// Builds a laptop whose user sits at +z.
fn laptop(b: &mut SceneBuilder, p: &Palette, kind: usize) {
    b.with_material(p.chrome);
    b.beveled_cuboid(vec3(-0.165, 0.003, -0.115), vec3(0.165, 0.018, 0.115), 0.004);
    b.with_material(p.black);
    b.cuboid_faces(vec3(-0.148, 0.016, -0.095), vec3(0.148, 0.0185, 0.02), BoxFaces::TOP);
    b.cuboid_faces(vec3(-0.05, 0.016, 0.04), vec3(0.05, 0.0186, 0.1), BoxFaces::TOP);
    b.with_material(p.dark);
    for row in 0..5 {
        for column in 0..14 {
            let (x, z) = (-0.145 + 0.0208 * column as f32, -0.092 + 0.0222 * row as f32);
            b.cuboid_faces(vec3(x, 0.018, z), vec3(x + 0.0178, 0.0208, z + 0.019), BoxFaces::STANDING);
        }
    }
    b.within(moved(0.0, 0.015, -0.115) * Affine3A::from_rotation_x(-0.35), |b| {
        b.with_material(p.chrome).beveled_cuboid(vec3(-0.165, 0.0, -0.008), vec3(0.165, 0.215, 0.0), 0.003);
        b.with_material(p.laptop_screens[kind % 2]);
        let corners = [[-0.155, 0.014], [0.155, 0.014], [0.155, 0.205], [-0.155, 0.205]];
        b.picture(corners.map(|c| vec3(c[0], c[1], 0.001)));
    });
}

fn microphone(b: &mut SceneBuilder, p: &Palette) {
    b.with_material(p.black);
    b.lathe(&[(0.05, 0.0), (0.052, 0.012), (0.03, 0.026), (0.012, 0.03), (0.0, 0.03)], 20);
    let neck: Vec<Vec3> = (0..=14)
        .map(|i| {
            let t = i as f32 / 14.0;
            vec3(0.0, 0.03 + 0.3 * (1.0 - (1.0 - t).powi(2)), 0.16 * t * t)
        })
        .collect();
    b.tube(&neck, 0.004, 6, false);
    let head = neck[14];
    b.ellipsoid(head + vec3(0.0, 0.0, 0.015), vec3(0.011, 0.011, 0.024), 8, 12);
}

fn tumbler(b: &mut SceneBuilder, p: &Palette, radius: f32, height: f32) {
    b.with_material(p.tumbler);
    b.lathe(&[(0.0, 0.006), (radius * 0.82, 0.006), (radius * 0.86, 0.012), (radius, height)], 20);
}

/// Builds lamps on thin cables over the table.
fn pendants(b: &mut SceneBuilder, p: &Palette) -> Vec<PointLight> {
    let mut lights = Vec::new();
    for (i, x) in [-2.1, -0.7, 0.7, 2.1].into_iter().enumerate() {
        let y = 1.95;
        b.object(&format!("pendant lamp {i}"));
        b.with_material(p.black).cylinder(
            vec3(x, y + 0.2, 0.0),
            vec3(x, CEILING, 0.0),
            0.0035,
            0.0035,
            6,
            false,
        );
        b.within(moved(x, y, 0.0), |b| {
            b.cylinder(Vec3::Y * (CEILING - y - 0.03), Vec3::Y * (CEILING - y), 0.05, 0.05, 20, true);
            b.with_material(p.pendant);
            b.lathe(&[(0.17, 0.0), (0.165, 0.02), (0.12, 0.1), (0.05, 0.17), (0.02, 0.2), (0.0, 0.205)], 32);
            b.lathe(&[(0.0, 0.19), (0.05, 0.16), (0.115, 0.095), (0.16, 0.02), (0.17, 0.0)], 32);
            b.with_material(p.bulb).ellipsoid(vec3(0.0, 0.06, 0.0), vec3(0.035, 0.045, 0.035), 10, 16);
        });
        lights.push(PointLight { position: vec3(x, y - 0.08, 0.0), color: vec3(0.75, 0.6, 0.4), range: 3.5 });
    }
    lights
}

fn plants(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    for (i, at) in [vec3(-4.95, 0.0, 3.3), vec3(5.0, 0.0, -3.35)].into_iter().enumerate() {
        b.object(&format!("plant {i}"));
        b.within(Affine3A::from_translation(at), |b| {
            b.with_material(p.pot);
            b.lathe(
                &[
                    (0.0, 0.002),
                    (0.2, 0.002),
                    (0.2, 0.002),
                    (0.26, 0.45),
                    (0.26, 0.45),
                    (0.23, 0.45),
                    (0.23, 0.4),
                ],
                32,
            );
            b.with_material(p.soil).lathe(&[(0.24, 0.42), (0.0, 0.425)], 24);
            b.within(moved(0.0, 0.4, 0.0), |b| {
                if i == 0 {
                    let tree = Tree {
                        height: 1.75,
                        trunk: 0.55,
                        spread: 0.55,
                        cards: 1500,
                        card_size: 0.055,
                        bark: p.bark,
                        leaves: p.leaves,
                    };
                    props::tree(b, &tree, rng);
                } else {
                    fronds(b, p.frond, 34, 1.15, 0.11, rng);
                }
            });
        });
    }
    b.object("window plant");
    b.within(moved(-0.25, 0.825, -ROOM.y + 0.12), |b| {
        b.with_material(p.china).lathe(&[(0.06, 0.0), (0.075, 0.12), (0.075, 0.12), (0.065, 0.12)], 24);
        b.with_material(p.soil).lathe(&[(0.068, 0.11), (0.0, 0.112)], 16);
        b.within(moved(0.0, 0.1, 0.0), |b| fronds(b, p.frond, 22, 0.26, 0.025, rng));
    });
}

/// Builds the view through the windows: a balcony railing, houses, the ground far below.
fn town(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    b.object("balcony").with_material(p.pot);
    b.cuboid(vec3(-ROOM.x, -0.3, -ROOM.y - 1.6), vec3(ROOM.x, -0.02, -ROOM.y - 0.3));
    b.with_material(p.dark);
    let rail = Railing { height: 1.05, ..Railing::default() };
    let z = -ROOM.y - 1.5;
    b.railing(&[vec3(-ROOM.x, 0.0, z), vec3(-1.9, 0.0, z), vec3(1.9, 0.0, z), vec3(ROOM.x, 0.0, z)], &rail);
    b.object("town ground").with_material(p.ground);
    b.rectangle(vec3(-260.0, -34.0, -6.0), Vec3::X * 520.0, Vec3::NEG_Z * 420.0);
    for row in 0..4 {
        for column in -4..=4 {
            let at = vec3(column as f32 * 26.0 + around(rng, 0.0, 4.0), -34.0, -34.0 - 38.0 * row as f32);
            let size = vec3(
                around(rng, 17.0, 3.0),
                around(rng, 30.0 + 6.0 * row as f32, 14.0),
                around(rng, 16.0, 3.0),
            );
            b.object(&format!("house {row} {column}")).with_material(p.town[rng.random_range(0..2)]);
            b.cuboid_faces(
                at - vec3(size.x, 0.0, size.z) * 0.5,
                at + vec3(size.x * 0.5, size.y, size.z * 0.5),
                BoxFaces::STANDING,
            );
        }
    }
    // A wire across the street with a few birds on it.
    b.object("town wire").with_material(p.black);
    let (a, c) = (vec3(-18.0, 2.4, -15.0), vec3(18.0, 3.4, -14.0));
    b.wire(a, c, 0.9, 0.02, 30);
    for k in 0..7 {
        let at = hanging(a, c, 0.9, 0.42 + 0.021 * k as f32 + around(rng, 0.0, 0.006));
        b.ellipsoid(at + Vec3::Y * 0.08, vec3(0.06, 0.07, 0.11), 8, 12);
        b.ellipsoid(at + vec3(0.0, 0.15, 0.07), Vec3::splat(0.035), 6, 10);
    }
}
