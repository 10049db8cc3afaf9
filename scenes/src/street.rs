//! A street with a café in the late afternoon, in place of Bistro.
//!
//! The street runs along -z with its middle at x = 0. Houses are at x = -7 and x = 9; the café's terrace is on the wide
//! pavement on the right.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Affine3A, Vec2, Vec3, vec2, vec3, vec4};
use rand::Rng;
use rand_pcg::Pcg32;

use super::build::{BoxFaces, Railing, SceneBuilder, around, hanging, moved, placed, random, viewpoints};
use super::paint::{self, Canvas};
use super::props::{
    self, Tree, bulb_string, cup, foliage, glass, glowing, hedge, metal, palette, pictured, plain, textured,
};
use yoro_assets::{PointLight, Scene, Sky, Viewpoint};

const LEFT_FACADES: f32 = -7.0;
const RIGHT_FACADES: f32 = 9.0;
const ROAD: f32 = 3.2;
const PAVEMENT: f32 = 0.12;
const GROUND_FLOOR: f32 = 3.8;
const STOREY: f32 = 3.1;
/// The terrace's range along z; the café is behind it.
const TERRACE: [f32; 2] = [-16.0, -2.0];

/// Generates the scene.
pub fn build(seed: u64, mut b: SceneBuilder) -> Scene {
    let p = palette(&mut b, seed);
    ground(&mut b, &p, &mut random(seed, "cobbles"));
    houses(&mut b, &p, seed);
    church(&mut b, &p);
    let mut lights = terrace(&mut b, &p, &mut random(seed, "terrace"));
    lights.extend(street_furniture(&mut b, &p, seed));
    let sky = Sky {
        sun_direction: vec3(-0.47, 0.62, 0.6).normalize(),
        sun_color: vec3(3.1, 2.65, 2.05),
        zenith: vec3(0.24, 0.4, 0.74),
        horizon: vec3(0.72, 0.72, 0.7),
        ground: vec3(0.26, 0.22, 0.18),
    };
    Scene { model: b.finish(), sky, lights, viewpoints: walk(), ..Scene::default() }
}

/// Returns a walk up the street, between the tables of the terrace, and on along its railing.
fn walk() -> Vec<Viewpoint> {
    viewpoints(&[
        ([-1.2, 1.62, 6.5], [1.8, 1.9, -10.0]),
        ([0.2, 1.62, 4.2], [4.4, 1.8, -8.0]),
        ([2.0, 1.64, 2.2], [6.2, 1.6, -6.0]),
        ([4.2, 1.72, 0.6], [6.6, 1.2, -6.5]),
        ([5.9, 1.72, -1.2], [5.7, 1.15, -7.5]),
        ([6.1, 1.7, -3.0], [5.2, 1.1, -9.0]),
        ([6.12, 1.6, -4.8], [4.5, 0.95, -9.5]),
        ([6.1, 1.4, -6.6], [4.8, 0.95, -12.5]),
        ([6.1, 1.35, -8.6], [5.5, 1.1, -15.0]),
        ([6.1, 1.5, -10.6], [6.3, 1.4, -17.0]),
        ([6.05, 1.68, -12.8], [5.0, 1.8, -22.0]),
        ([5.8, 1.72, -15.4], [2.2, 2.0, -28.0]),
        ([4.6, 1.72, -17.6], [-0.5, 2.4, -36.0]),
        ([2.6, 1.64, -19.4], [-1.5, 3.0, -45.0]),
    ])
}

palette! {
    fn palette(b: &mut SceneBuilder, seed: u64) -> Palette {
        let s = seed as u32;
        let cream = textured(b, paint::plaster("plaster-cream", 512, s, vec3(0.86, 0.78, 0.64)), 3.0, 0.9);
        let rose = textured(b, paint::plaster("plaster-rose", 512, s + 1, vec3(0.82, 0.62, 0.52)), 3.0, 0.9);
        let ochre = textured(b, paint::plaster("plaster-ochre", 512, s + 2, vec3(0.84, 0.66, 0.4)), 3.0, 0.9);
        let brick = paint::bricks("brick", 512, s + 3, vec3(0.58, 0.3, 0.22), vec3(0.66, 0.62, 0.56), [8, 24]);
        let brick = textured(b, brick, 1.7, 0.85);
        let granite = paint::concrete("granite", 512, s + 4, vec3(0.5, 0.49, 0.48));
        let cobble = textured(b, granite, 2.3, 0.6);
        let paving = paint::stone_blocks("paving", 512, s + 5, vec3(0.6, 0.58, 0.54), [4, 6]);
        let leaf = Vec3::new(0.3, 0.47, 0.14);
    }
    plasters: [usize; 4] = [cream, rose, ochre, brick],
    ashlar = textured(
        b,
        paint::stone_blocks("ashlar", 512, s + 6, vec3(0.78, 0.72, 0.6), [3, 6]),
        2.4,
        0.85,
    ),
    trim = plain(b, "trim", vec3(0.86, 0.82, 0.73), 0.8),
    shutters: [usize; 3] = [
        plain(b, "shutter-blue", vec3(0.36, 0.48, 0.56), 0.55),
        plain(b, "shutter-green", vec3(0.28, 0.4, 0.3), 0.55),
        plain(b, "shutter-grey", vec3(0.58, 0.58, 0.54), 0.55),
    ],
    frame = plain(b, "window-frame", vec3(0.9, 0.88, 0.83), 0.5),
    window = pictured(b, window_picture("window", false), 0.08, 0.0),
    window_lit = pictured(b, window_picture("window-lit", true), 0.1, 0.9),
    pane = glass(b, "pane", vec3(0.6, 0.7, 0.7), 0.16),
    iron = metal(b, "iron", vec3(0.12, 0.12, 0.13), 0.45),
    brass = metal(b, "brass", vec3(0.78, 0.6, 0.3), 0.3),
    slate = textured(
        b,
        paint::roof_tiles("slate", 512, s + 7, vec3(0.34, 0.36, 0.41), [10, 12]),
        2.2,
        0.6,
    ),
    cobble = cobble,
    joint = plain(b, "joint", vec3(0.22, 0.2, 0.18), 0.95),
    paving = textured(b, paving, 2.4, 0.8),
    curb = plain(b, "curb", vec3(0.56, 0.55, 0.53), 0.8),
    awnings: [usize; 2] = [
        textured(b, striped("awning-red", s, vec3(0.7, 0.13, 0.11)), 0.6, 0.85),
        textured(b, striped("awning-green", s, vec3(0.12, 0.38, 0.24)), 0.6, 0.85),
    ],
    wood = textured(b, paint::planks("wood", 512, s + 8, vec3(0.46, 0.31, 0.19), 6), 0.9, 0.55),
    shop_fronts: [usize; 3] = [
        plain(b, "front-green", vec3(0.1, 0.25, 0.19), 0.35),
        plain(b, "front-red", vec3(0.42, 0.1, 0.1), 0.35),
        plain(b, "front-blue", vec3(0.12, 0.2, 0.36), 0.35),
    ],
    marble = textured(
        b,
        paint::marble("marble", 256, s + 9, vec3(0.9, 0.89, 0.87), vec3(0.5, 0.5, 0.53)),
        0.9,
        0.18,
    ),
    wicker = textured(b, paint::fabric("wicker", 256, s + 10, vec3(0.76, 0.6, 0.36), 16), 0.16, 0.6),
    chair = plain(b, "cane", vec3(0.5, 0.3, 0.16), 0.4),
    china = plain(b, "china", vec3(0.95, 0.95, 0.93), 0.15),
    coffee = plain(b, "coffee", vec3(0.16, 0.08, 0.04), 0.1),
    bulb = glowing(b, "bulb", vec3(1.0, 0.82, 0.5), 1.85),
    lantern = glowing(b, "lantern", vec3(1.0, 0.85, 0.6), 1.6),
    bark = textured(b, paint::bark("bark", 256, s + 11, vec3(0.42, 0.34, 0.26)), 0.8, 0.9),
    leaves = foliage(b, "leaves", seed, leaf),
    box_leaves = foliage(b, "box-leaves", seed + 1, vec3(0.2, 0.4, 0.13)),
    flowers = foliage(b, "flowers", seed + 2, vec3(0.82, 0.2, 0.26)),
    terracotta = plain(b, "terracotta", vec3(0.72, 0.4, 0.27), 0.8),
    soil = textured(b, paint::soil("soil", 256, s + 12, vec3(0.27, 0.19, 0.13)), 0.7, 0.95),
    rubber = plain(b, "rubber", vec3(0.09, 0.09, 0.09), 0.75),
    car = plain(b, "car-paint", vec3(0.62, 0.76, 0.78), 0.16),
    chrome = metal(b, "chrome", vec3(0.8, 0.8, 0.82), 0.12),
    dark_glass = plain(b, "dark-glass", vec3(0.07, 0.09, 0.1), 0.05),
    books = pictured(b, paint::book_spines("books", [512, 128], s, 40), 0.8, 0.0),
}

/// Paints white cloth with coloured stripes; one stripe of each per picture.
fn striped(name: &str, seed: u32, color: Vec3) -> paint::Surface {
    paint::surface(name, [256, 256], 0.004, |uv| {
        let edge = 0.02;
        let stripe = paint::smoothstep(0.25 - edge, 0.25, uv.x) - paint::smoothstep(0.75, 0.75 + edge, uv.x);
        let weave = ((uv.x * 128.0).fract() - 0.5).abs() + ((uv.y * 128.0).fract() - 0.5).abs();
        let dirt = paint::fbm(seed, glam::UVec2::splat(4), 4, uv) * 0.16;
        (vec3(0.92, 0.89, 0.82).lerp(color, stripe) * (0.96 - dirt), weave)
    })
}

/// Paints the view through a window pane: curtains, and a dim or a lit room.
fn window_picture(name: &str, lit: bool) -> yoro_assets::TextureImage {
    let mut c =
        Canvas::new([256, 512], if lit { vec4(0.85, 0.62, 0.33, 1.0) } else { vec4(0.1, 0.12, 0.14, 1.0) });
    for i in 0..16 {
        let t = i as f32 / 15.0;
        let tone = if lit { vec3(0.95, 0.76, 0.47) } else { vec3(0.25, 0.3, 0.36) } * (0.4 + 0.6 * (1.0 - t));
        c.rect(vec2(0.0, t * 260.0), vec2(256.0, t * 260.0 + 18.0), tone.extend(0.35));
    }
    c.rounded(vec2(96.0, 330.0), vec2(180.0, 520.0), 10.0, vec4(0.08, 0.07, 0.06, 0.55));
    c.ellipse(vec2(138.0, 170.0), vec2(36.0, 22.0), vec4(1.0, 0.93, 0.7, if lit { 1.0 } else { 0.12 }));
    let cloth = if lit { vec3(0.98, 0.88, 0.68) } else { vec3(0.62, 0.63, 0.62) };
    for side in [0.0, 1.0] {
        for fold in 0..7 {
            let x = 6.0 + fold as f32 * 11.0;
            let x = if side > 0.0 { 256.0 - x } else { x };
            let shade = 0.62 + 0.38 * ((fold * 5) % 3) as f32 / 2.0;
            c.line(vec2(x, -8.0), vec2(x + (0.5 - side) * 18.0, 530.0), 12.0, (cloth * shade).extend(0.95));
        }
    }
    c.into_texture(name)
}

fn ground(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    let crown = |x: f32| 0.04 * (1.0 - (x / ROAD).powi(2));
    // Single stones where the walk passes.
    let (near, far) = (10.0, -30.0);
    let mut z = near;
    let mut row = 0;
    while z > far {
        let depth = around(rng, 0.118, 0.012);
        b.object(&format!("cobbles {}", row / 24));
        let mut x = -ROAD - if row % 2 == 0 { 0.0 } else { 0.08 };
        while x < ROAD {
            let width = around(rng, 0.165, 0.03);
            let (x0, x1) = (x.max(-ROAD) + 0.006, (x + width).min(ROAD) - 0.006);
            x += width;
            if x1 - x0 < 0.05 {
                continue;
            }
            cobble(b, p, [vec2(x0, z - depth + 0.006), vec2(x1, z - 0.006)], crown((x0 + x1) * 0.5), rng);
        }
        z -= depth;
        row += 1;
    }
    b.set_uv_offset(Vec2::ZERO);
    b.object("road bed").with_material(p.joint);
    b.height_field(8, 1, vec2(-ROAD, far), vec2(ROAD, near), |x, _| crown(x) - 0.012);
    b.object("far road").with_material(p.paving);
    b.height_field(8, 8, vec2(-ROAD, -96.0), vec2(ROAD, far), |x, _| crown(x));
    b.height_field(8, 2, vec2(-ROAD, near), vec2(ROAD, 40.0), |x, _| crown(x));
    for (side, facade) in [(-1.0, LEFT_FACADES), (1.0, RIGHT_FACADES)] {
        let edge = ROAD * side;
        b.object(if side < 0.0 { "left pavement" } else { "right pavement" }).with_material(p.paving);
        let (x0, x1) = if side < 0.0 { (facade - 20.0, edge - 0.15) } else { (edge + 0.15, facade + 20.0) };
        b.height_field(1, 1, vec2(x0, -96.0), vec2(x1, 40.0), |_, _| PAVEMENT);
        b.object(if side < 0.0 { "left curb" } else { "right curb" }).with_material(p.curb);
        let mut z = 20.0;
        while z > -80.0 {
            let length = around(rng, 1.0, 0.08);
            let (a, c) = if side < 0.0 { (edge - 0.15, edge) } else { (edge, edge + 0.15) };
            let top = PAVEMENT + around(rng, 0.006, 0.004);
            b.beveled_cuboid(vec3(a, -0.1, z - length + 0.006), vec3(c, top, z), 0.015);
            z -= length;
        }
    }
    b.object("manhole").with_material(p.iron);
    b.within(moved(-0.9, crown(0.9) + 0.004, -3.2), |b| {
        b.lathe(&[(0.36, 0.0), (0.36, 0.016), (0.36, 0.016), (0.0, 0.016)], 40);
        for i in 0..11 {
            let x = (i as f32 - 5.0) * 0.055;
            let half = (0.3 * 0.3 - x * x).max(0.0).sqrt();
            b.cuboid(vec3(x - 0.012, 0.016, -half), vec3(x + 0.012, 0.023, half));
        }
    });
}

/// Builds one paving stone: a domed top with rounded sides.
fn cobble(b: &mut SceneBuilder, p: &Palette, [min, max]: [Vec2; 2], height: f32, rng: &mut Pcg32) {
    b.with_material(p.cobble).set_uv_offset(vec2(rng.random::<f32>() * 2.0, rng.random::<f32>() * 2.0));
    let tilt = vec2(around(rng, 0.0, 0.004), around(rng, 0.0, 0.004));
    let top = height + around(rng, 0.006, 0.005);
    let stops = [0.0, 0.16, 0.84, 1.0];
    let mut points = [(Vec3::ZERO, Vec2::ZERO); 16];
    for (k, point) in points.iter_mut().enumerate() {
        let (i, j) = (k % 4, k / 4);
        let (u, v) = (stops[i], stops[j]);
        let rim = usize::from(i == 0 || i == 3) + usize::from(j == 0 || j == 3);
        let drop = [0.0, 0.026, 0.034][rim];
        let corner = if rim == 2 { 0.008 } else { 0.0 };
        let x = min.x + (max.x - min.x) * u + if i == 0 { corner } else { -corner };
        let z = max.y + (min.y - max.y) * v + if j == 0 { -corner } else { corner };
        let y = top - drop + tilt.x * (u - 0.5) + tilt.y * (v - 0.5);
        *point = (vec3(x, y, z), vec2(x, -z));
    }
    b.grid(3, 3, false, &points);
}

#[derive(Clone, Copy, PartialEq)]
enum GroundFloor {
    Cafe,
    Shop(usize),
    Home,
}

struct House<'a> {
    name: String,
    width: f32,
    floors: usize,
    wall: usize,
    shutter: Option<usize>,
    ground: GroundFloor,
    sign: Option<usize>,
    front: usize,
    palette: &'a Palette,
}

fn houses(b: &mut SceneBuilder, p: &Palette, seed: u64) {
    let rng = &mut random(seed, "houses");
    let ink = vec3(0.93, 0.85, 0.62);
    let names = ["BOULANGERIE", "LIBRAIRIE", "FLEURISTE", "FROMAGERIE", "TABAC", "PHARMACIE"];
    let grounds = [vec3(0.1, 0.25, 0.19), vec3(0.42, 0.1, 0.1), vec3(0.12, 0.2, 0.36)];
    let signs: Vec<usize> = names
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let ground = grounds[i % 3];
            pictured(b, paint::sign(&format!("sign-{i}"), [512, 64], name, ink, ground), 0.5, 0.0)
        })
        .collect();
    let cafe_sign =
        pictured(b, paint::sign("sign-cafe", [512, 64], "CAFE DU COIN", ink, grounds[1]), 0.5, 0.0);
    let mut number = 0;
    let mut shops = 0;
    for (side, start) in [(1.0_f32, -2.0_f32), (-1.0, -1.0)] {
        // Behind the camera first, then up the street.
        let mut spans = Vec::new();
        let mut z = start;
        while z < 30.0 {
            let width = around(rng, 10.0, 1.2);
            spans.push((z + width, width));
            z += width;
        }
        if side > 0.0 {
            spans.push((start, 14.0));
        }
        let mut z = if side > 0.0 { start - 14.0 } else { start };
        while z > -72.0 {
            // An alley on the left, a cross street on the right.
            if (side < 0.0 && (-27.0..-18.0).contains(&z) && spans.iter().all(|s| s.0 > -22.0))
                || (side > 0.0 && (-45.0..-34.0).contains(&z) && spans.iter().all(|s| s.0 > -40.0))
            {
                z -= 5.0;
                spans.push((z, 10.5));
                z -= 10.5;
                continue;
            }
            let width = around(rng, 10.0, 1.6);
            spans.push((z, width));
            z -= width;
        }
        for (near, width) in spans {
            let is_cafe = side > 0.0 && near == start && width == 14.0;
            let ground = match rng.random_range(0..4) {
                _ if is_cafe => GroundFloor::Cafe,
                0 => GroundFloor::Home,
                _ => GroundFloor::Shop(shops),
            };
            shops += 1;
            let sign = match ground {
                GroundFloor::Cafe => Some(cafe_sign),
                GroundFloor::Shop(i) => Some(signs[i % signs.len()]),
                GroundFloor::Home => None,
            };
            let house = House {
                name: format!("house {number}"),
                width,
                floors: if is_cafe { 4 } else { rng.random_range(3..=5) },
                wall: if is_cafe { p.plasters[0] } else { p.plasters[rng.random_range(0..4)] },
                shutter: rng.random_bool(0.75).then(|| p.shutters[rng.random_range(0..3)]),
                ground,
                sign,
                front: p.shop_fronts[if is_cafe { 1 } else { shops.wrapping_sub(1) % 6 % 3 }],
                palette: p,
            };
            number += 1;
            let frame = if side > 0.0 {
                placed(vec3(RIGHT_FACADES, 0.0, near - width), -FRAC_PI_2)
            } else {
                placed(vec3(LEFT_FACADES, 0.0, near), FRAC_PI_2)
            };
            b.within(frame, |b| house_front(b, &house, rng));
        }
    }
    // Houses behind the walk and at the end of the side streets.
    for (frame, width) in [
        (placed(vec3(10.0, 0.0, 30.0), PI), 20.0),
        (placed(vec3(-24.0, 0.0, -14.0), FRAC_PI_2), 18.0),
        (placed(vec3(27.0, 0.0, -52.0), -FRAC_PI_2), 18.0),
    ] {
        let house = House {
            name: format!("house {number}"),
            width,
            floors: 4,
            wall: p.plasters[number % 4],
            shutter: Some(p.shutters[number % 3]),
            ground: GroundFloor::Home,
            sign: None,
            front: p.shop_fronts[0],
            palette: p,
        };
        number += 1;
        b.within(frame, |b| house_front(b, &house, rng));
    }
}

/// Builds a wall from `min` to `max` (x, y) at z = 0. Its picture lines up with that of neighbouring walls.
fn wall(b: &mut SceneBuilder, min: Vec2, max: Vec2) {
    let corners = [min, vec2(max.x, min.y), max, vec2(min.x, max.y)];
    b.quad_metres(corners.map(|c| c.extend(0.0)), corners);
}

/// Builds a wall panel with a hole, and the sides of the hole, `depth` deep.
fn wall_with_hole(b: &mut SceneBuilder, [min, max]: [Vec2; 2], [low, high]: [Vec2; 2], depth: f32) {
    wall(b, min, vec2(low.x, max.y));
    wall(b, vec2(high.x, min.y), max);
    wall(b, vec2(low.x, min.y), vec2(high.x, low.y));
    wall(b, vec2(low.x, high.y), vec2(high.x, max.y));
    let (back, across, up) = (Vec3::NEG_Z * depth, high.x - low.x, high.y - low.y);
    b.rectangle(low.extend(-depth), -back, Vec3::Y * up);
    b.rectangle(vec3(high.x, low.y, 0.0), back, Vec3::Y * up);
    b.rectangle(low.extend(0.0), Vec3::X * across, back);
    b.rectangle(vec3(low.x, high.y, -depth), Vec3::X * across, -back);
}

/// Builds the front of a house as seen from the street: x to the right, y up, facade at z = 0, depth towards -z.
fn house_front(b: &mut SceneBuilder, house: &House, rng: &mut Pcg32) {
    let p = house.palette;
    let w = house.width;
    let top = GROUND_FLOOR + STOREY * house.floors as f32 - STOREY;
    let depth = 11.0;
    let columns = (w / 2.5).round() as usize;
    let bay = w / columns as f32;
    b.object(&format!("{} walls", house.name)).with_material(house.wall);
    let sides = BoxFaces::RIGHT.and(BoxFaces::LEFT).and(BoxFaces::BACK);
    b.cuboid_faces(vec3(0.0, 0.0, -depth), vec3(w, top, 0.0), sides);
    for floor in 0..house.floors - 1 {
        let y = GROUND_FLOOR + STOREY * floor as f32;
        let balcony = floor == 0 && house.floors > 3;
        for column in 0..columns {
            let x = bay * (column as f32 + 0.5);
            let (low, high) = (if balcony { 0.12 } else { 0.75 }, 2.5 - 0.1 * floor as f32);
            let hole = [vec2(x - 0.55, y + low), vec2(x + 0.55, y + high)];
            b.object(&format!("{} walls", house.name)).with_material(house.wall);
            let panel = [vec2(x - bay * 0.5, y), vec2(x + bay * 0.5, y + STOREY)];
            wall_with_hole(b, panel, hole, 0.24);
            b.object(&format!("{} windows {floor}", house.name));
            window(b, house, hole, rng);
            if !balcony && rng.random_bool(0.35) {
                flower_box(b, p, vec3(x, y + low + 0.02, 0.16), 1.0, rng);
            }
        }
        b.object(&format!("{} trim", house.name)).with_material(p.trim);
        b.beveled_cuboid(vec3(0.0, y - 0.11, -0.1), vec3(w, y + 0.06, 0.09), 0.025);
        if balcony {
            b.object(&format!("{} balcony", house.name));
            balcony_along(b, p, w, y + 0.06);
        }
    }
    b.object(&format!("{} trim", house.name)).with_material(p.trim);
    for (low, high, out) in [(-0.35, -0.2, 0.1), (-0.2, -0.05, 0.22), (-0.05, 0.1, 0.38)] {
        b.beveled_cuboid(vec3(-0.02, top + low, -0.3), vec3(w + 0.02, top + high, out), 0.03);
    }
    let brackets = (w / 0.7) as usize;
    for i in 0..brackets {
        let x = (i as f32 + 0.5) * w / brackets as f32;
        b.cuboid(vec3(x - 0.07, top - 0.32, 0.0), vec3(x + 0.07, top - 0.06, 0.28));
    }
    for side in [0.0, w - 0.45] {
        for k in 0..((top - GROUND_FLOOR) / 0.62) as usize {
            let y = GROUND_FLOOR + 0.1 + k as f32 * 0.62;
            let size = if k % 2 == 0 { 0.45 } else { 0.3 };
            let x = if side == 0.0 { 0.0 } else { w - size };
            b.beveled_cuboid(vec3(x, y, -0.05), vec3(x + size, y + 0.56, 0.035), 0.015);
        }
    }
    b.object(&format!("{} roof", house.name));
    roof(b, house, top, depth, bay, columns, rng);
    b.object(&format!("{} ground floor", house.name));
    match house.ground {
        GroundFloor::Home => home_front(b, house, columns, bay, rng),
        GroundFloor::Cafe | GroundFloor::Shop(_) => shop_front(b, house, rng),
    }
    // A drain pipe at the party wall.
    b.object(&format!("{} pipe", house.name)).with_material(p.iron);
    let x = w - 0.12;
    b.tube(&[vec3(x, top, 0.3), vec3(x, top - 0.5, 0.12), vec3(x, 0.2, 0.12)], 0.05, 10, false);
    for y in [1.2, 4.2, 7.2] {
        b.cylinder(vec3(x, y, 0.12), vec3(x, y + 0.06, 0.12), 0.062, 0.062, 10, true);
    }
}

fn window(b: &mut SceneBuilder, house: &House, [low, high]: [Vec2; 2], rng: &mut Pcg32) {
    let p = house.palette;
    let z = -0.17;
    let middle = (low.x + high.x) * 0.5;
    b.with_material(if rng.random_bool(0.22) { p.window_lit } else { p.window });
    b.picture([
        vec3(low.x, low.y, z),
        vec3(high.x, low.y, z),
        vec3(high.x, high.y, z),
        vec3(low.x, high.y, z),
    ]);
    b.with_material(p.frame);
    let bar = |b: &mut SceneBuilder, x0: f32, x1: f32, y0: f32, y1: f32, front: f32| {
        b.beveled_cuboid(vec3(x0, y0, z - 0.02), vec3(x1, y1, z + front), 0.008);
    };
    bar(b, low.x, low.x + 0.07, low.y, high.y, 0.06);
    bar(b, high.x - 0.07, high.x, low.y, high.y, 0.06);
    bar(b, low.x, high.x, low.y, low.y + 0.09, 0.07);
    bar(b, low.x, high.x, high.y - 0.07, high.y, 0.06);
    bar(b, middle - 0.05, middle + 0.05, low.y, high.y, 0.08);
    for k in 1..3 {
        let y = low.y + (high.y - low.y) * k as f32 / 3.0;
        bar(b, low.x, high.x, y - 0.015, y + 0.015, 0.04);
    }
    b.with_material(p.trim);
    b.beveled_cuboid(vec3(low.x - 0.12, low.y - 0.08, -0.05), vec3(high.x + 0.12, low.y, 0.12), 0.015);
    b.beveled_cuboid(vec3(low.x - 0.14, high.y, -0.02), vec3(high.x + 0.14, high.y + 0.16, 0.06), 0.015);
    b.beveled_cuboid(vec3(low.x - 0.2, high.y + 0.16, -0.02), vec3(high.x + 0.2, high.y + 0.23, 0.13), 0.02);
    for side in [low.x - 0.13, high.x] {
        b.beveled_cuboid(vec3(side, low.y, -0.02), vec3(side + 0.13, high.y, 0.045), 0.012);
    }
    if let Some(shutter) = house.shutter {
        b.with_material(shutter);
        let open = rng.random_bool(0.85);
        for (hinge, direction) in [(low.x - 0.01, -1.0), (high.x + 0.01, 1.0)] {
            let yaw = if open { around(rng, 0.08, 0.06) } else { around(rng, 0.9, 0.3) };
            let angle = if direction < 0.0 { PI - yaw } else { yaw };
            // In the shutter's own frame, x runs from the hinge outwards.
            let frame = placed(vec3(hinge, low.y, 0.06), -angle.rem_euclid(TAU));
            let outward =
                if direction < 0.0 { Affine3A::from_scale(vec3(1.0, 1.0, -1.0)) } else { Affine3A::IDENTITY };
            b.within(frame * outward, |b| shutter_leaf(b, 0.54, high.y - low.y));
        }
    }
}

/// Builds a louvred shutter in the XY plane.
fn shutter_leaf(b: &mut SceneBuilder, width: f32, height: f32) {
    for (x0, x1, y0, y1) in [
        (0.0, 0.06, 0.0, height),
        (width - 0.06, width, 0.0, height),
        (0.06, width - 0.06, 0.0, 0.08),
        (0.06, width - 0.06, height - 0.07, height),
        (0.06, width - 0.06, height * 0.5 - 0.035, height * 0.5 + 0.035),
    ] {
        b.cuboid(vec3(x0, y0, 0.0), vec3(x1, y1, 0.035));
    }
    let slats = (height / 0.075) as usize;
    for i in 1..slats {
        let y = 0.05 + (height - 0.1) * i as f32 / slats as f32;
        b.quad([
            vec3(0.06, y - 0.022, 0.032),
            vec3(width - 0.06, y - 0.022, 0.032),
            vec3(width - 0.06, y + 0.022, 0.004),
            vec3(0.06, y + 0.022, 0.004),
        ]);
        b.quad([
            vec3(width - 0.06, y - 0.022, 0.03),
            vec3(0.06, y - 0.022, 0.03),
            vec3(0.06, y + 0.022, 0.002),
            vec3(width - 0.06, y + 0.022, 0.002),
        ]);
    }
}

fn balcony_along(b: &mut SceneBuilder, p: &Palette, w: f32, y: f32) {
    b.with_material(p.trim);
    b.beveled_cuboid(vec3(0.25, y - 0.1, 0.0), vec3(w - 0.25, y + 0.02, 0.75), 0.03);
    for i in 0..(w / 1.3) as usize {
        let x = 0.5 + i as f32 * 1.3;
        let bracket =
            [vec2(0.0, -0.55), vec2(0.12, -0.5), vec2(0.62, -0.14), vec2(0.62, -0.1), vec2(0.0, -0.1)];
        b.within(placed(vec3(x, y, 0.0), -FRAC_PI_2), |b| b.extrude(&bracket, -0.06, 0.06, true));
    }
    b.with_material(p.iron);
    let rail =
        Railing { height: 0.98, low_rail: 0.12, rail_radius: 0.018, bar_radius: 0.007, bar_spacing: 0.12 };
    let (l, r, z) = (0.32, w - 0.32, 0.68);
    let y = y + 0.02;
    b.railing(&[vec3(l, y, 0.02), vec3(l, y, z), vec3(r, y, z), vec3(r, y, 0.02)], &rail);
    // Rings between the bars, as on cast-iron balconies.
    let count = ((r - l) / 0.24) as usize;
    for i in 0..count {
        let center = vec3(l + (i as f32 + 0.5) * (r - l) / count as f32, y + 0.86, z);
        let ring: Vec<Vec3> = (0..=12)
            .map(|k| {
                let (sin, cos) = (k as f32 / 12.0 * TAU).sin_cos();
                center + vec3(cos * 0.075, sin * 0.075, 0.0)
            })
            .collect();
        b.tube(&ring, 0.006, 4, false);
    }
}

fn flower_box(b: &mut SceneBuilder, p: &Palette, base: Vec3, width: f32, rng: &mut Pcg32) {
    let half = width * 0.5;
    b.with_material(p.terracotta);
    b.beveled_cuboid(base + vec3(-half, 0.0, -0.1), base + vec3(half, 0.18, 0.1), 0.012);
    hedge(b, base + vec3(-half, 0.16, -0.1), base + vec3(half, 0.36, 0.12), p.box_leaves, 110, rng);
    b.with_material(p.flowers);
    for _ in 0..50 {
        let at = base + vec3(around(rng, 0.0, half), around(rng, 0.32, 0.14), around(rng, 0.08, 0.1));
        props::leaf_card(b, at, vec3(0.0, 0.6, 0.8), 0.05, rng);
    }
}

fn roof(
    b: &mut SceneBuilder,
    house: &House,
    top: f32,
    depth: f32,
    bay: f32,
    columns: usize,
    rng: &mut Pcg32,
) {
    let p = house.palette;
    let (w, rise, setback) = (house.width, 2.9, 1.3);
    b.with_material(p.slate);
    let y = top + 0.1;
    let front =
        [vec3(0.0, y, 0.2), vec3(w, y, 0.2), vec3(w, y + rise, -setback), vec3(0.0, y + rise, -setback)];
    b.quad(front);
    let back = -depth;
    b.quad([
        vec3(0.0, y + rise, -setback),
        vec3(w, y + rise, -setback),
        vec3(w, y + rise + 1.2, -depth * 0.5),
        vec3(0.0, y + rise + 1.2, -depth * 0.5),
    ]);
    b.quad([
        vec3(w, y, back),
        vec3(0.0, y, back),
        vec3(0.0, y + rise + 1.2, -depth * 0.5),
        vec3(w, y + rise + 1.2, -depth * 0.5),
    ]);
    b.with_material(house.wall);
    let gable = [vec2(-0.2, y), vec2(depth, y), vec2(depth * 0.5, y + rise + 1.2), vec2(setback, y + rise)];
    for (x, direction) in [(0.0, Vec3::NEG_X), (w, Vec3::X)] {
        b.fan(&gable.map(|g| vec3(x, g.y, -g.x)), direction);
    }
    for column in 0..columns {
        let x = bay * (column as f32 + 0.5);
        b.with_material(p.trim);
        let (x0, x1, y0, y1) = (x - 0.62, x + 0.62, y + 0.3, y + 2.1);
        b.cuboid_faces(vec3(x0, y0, -1.3), vec3(x0 + 0.17, y1, 0.12), BoxFaces::ALL);
        b.cuboid_faces(vec3(x1 - 0.17, y0, -1.3), vec3(x1, y1, 0.12), BoxFaces::ALL);
        b.cuboid(vec3(x0, y1 - 0.2, -1.3), vec3(x1, y1, 0.12));
        b.cuboid(vec3(x0 - 0.08, y0 - 0.08, -1.0), vec3(x1 + 0.08, y0 + 0.1, 0.2));
        let pediment = [vec2(x0 - 0.15, y1), vec2(x1 + 0.15, y1), vec2(x, y1 + 0.5)];
        b.extrude(&pediment, -1.4, 0.22, false);
        b.with_material(if rng.random_bool(0.2) { p.window_lit } else { p.window });
        b.picture([
            vec3(x0 + 0.17, y0 + 0.1, -0.02),
            vec3(x1 - 0.17, y0 + 0.1, -0.02),
            vec3(x1 - 0.17, y1 - 0.2, -0.02),
            vec3(x0 + 0.17, y1 - 0.2, -0.02),
        ]);
        b.with_material(p.frame);
        b.cuboid(vec3(x - 0.03, y0 + 0.1, -0.05), vec3(x + 0.03, y1 - 0.2, 0.02));
        b.cuboid(vec3(x0 + 0.17, y0 + 0.95, -0.05), vec3(x1 - 0.17, y0 + 1.0, 0.02));
    }
    for side in [0.35, w - 0.95] {
        b.with_material(p.plasters[3]);
        let ridge = y + rise + 2.2;
        b.cuboid_faces(
            vec3(side, y, -depth * 0.7),
            vec3(side + 0.6, ridge, -depth * 0.4),
            BoxFaces::STANDING,
        );
        b.with_material(p.terracotta);
        for i in 0..5 {
            let base = vec3(side + 0.3, ridge, -depth * 0.42 - 0.55 * i as f32);
            b.cylinder(base, base + Vec3::Y * around(rng, 0.6, 0.2), 0.13, 0.1, 12, true);
        }
    }
    // A television aerial.
    b.with_material(p.iron);
    let mast = vec3(w * 0.5, y + rise, -2.2);
    b.cylinder(mast, mast + Vec3::Y * 2.8, 0.025, 0.02, 6, false);
    for i in 0..6 {
        let at = mast + vec3(0.0, 2.6, -0.4 + 0.2 * i as f32);
        let half = 0.45 - 0.04 * i as f32;
        b.cylinder(at - Vec3::X * half, at + Vec3::X * half, 0.008, 0.008, 5, false);
    }
    let beam = mast + Vec3::Y * 2.6;
    b.cylinder(beam - Vec3::Z * 0.5, beam + Vec3::Z * 0.7, 0.012, 0.012, 5, false);
}

fn home_front(b: &mut SceneBuilder, house: &House, columns: usize, bay: f32, rng: &mut Pcg32) {
    let p = house.palette;
    let door = columns / 2;
    for column in 0..columns {
        let x = bay * (column as f32 + 0.5);
        let panel = [vec2(x - bay * 0.5, 0.0), vec2(x + bay * 0.5, GROUND_FLOOR)];
        b.with_material(p.ashlar);
        if column == door {
            let hole = [vec2(x - 0.65, 0.0), vec2(x + 0.65, 2.75)];
            wall_with_hole(b, panel, hole, 0.3);
            b.with_material(house.front);
            for (x0, x1) in [(x - 0.65, x - 0.01), (x + 0.01, x + 0.65)] {
                b.beveled_cuboid(vec3(x0, 0.12, -0.3), vec3(x1, 2.35, -0.22), 0.01);
                for (y0, y1) in [(0.3, 1.0), (1.15, 2.2)] {
                    b.beveled_cuboid(vec3(x0 + 0.1, y0, -0.24), vec3(x1 - 0.1, y1, -0.19), 0.02);
                }
            }
            b.with_material(p.window_lit);
            b.picture([
                vec3(x - 0.65, 2.35, -0.24),
                vec3(x + 0.65, 2.35, -0.24),
                vec3(x + 0.65, 2.75, -0.24),
                vec3(x - 0.65, 2.75, -0.24),
            ]);
            b.with_material(p.brass);
            b.ellipsoid(vec3(x + 0.09, 1.15, -0.17), Vec3::splat(0.035), 8, 12);
            b.with_material(p.trim).beveled_cuboid(vec3(x - 0.8, 0.0, -0.3), vec3(x + 0.8, 0.24, 0.32), 0.02);
        } else {
            let hole = [vec2(x - 0.55, 1.1), vec2(x + 0.55, 2.9)];
            wall_with_hole(b, panel, hole, 0.26);
            window(b, house, hole, rng);
            b.with_material(p.iron);
            for i in 0..8 {
                let bar = hole[0].x + 0.07 + 0.137 * i as f32;
                b.cylinder(vec3(bar, 1.1, 0.03), vec3(bar, 2.0, 0.03), 0.009, 0.009, 6, false);
            }
            b.cylinder(vec3(hole[0].x, 2.0, 0.03), vec3(hole[1].x, 2.0, 0.03), 0.014, 0.014, 6, false);
        }
    }
    b.with_material(p.ashlar);
    b.beveled_cuboid(vec3(0.0, 0.0, -0.02), vec3(house.width, 0.55, 0.06), 0.02);
}

/// Builds a wooden shop front with an awning, and a room behind its panes.
fn shop_front(b: &mut SceneBuilder, house: &House, rng: &mut Pcg32) {
    let p = house.palette;
    let w = house.width;
    let (sill, head) = (0.62, 2.75);
    b.with_material(house.front);
    b.cuboid(vec3(0.01, 2.85, -0.3), vec3(w - 0.01, GROUND_FLOOR - 0.1, 0.08));
    b.beveled_cuboid(vec3(0.01, GROUND_FLOOR - 0.25, -0.1), vec3(w - 0.01, GROUND_FLOOR - 0.08, 0.24), 0.03);
    b.beveled_cuboid(vec3(0.01, head, -0.25), vec3(w - 0.01, 2.88, 0.14), 0.02);
    if let Some(sign) = house.sign {
        let half = (w * 0.5 - 0.6).min(2.9);
        b.with_material(sign);
        let at = |x: f32, y: f32| vec3(w * 0.5 + x, y, 0.1);
        b.picture([at(-half, 2.95), at(half, 2.95), at(half, 3.5), at(-half, 3.5)]);
    }
    let panels = (w / 1.75).round() as usize;
    let step = w / panels as f32;
    let door = panels / 2;
    for i in 0..=panels {
        let x = (i as f32 * step).clamp(0.13, w - 0.13);
        b.with_material(house.front);
        b.beveled_cuboid(vec3(x - 0.09, 0.0, -0.28), vec3(x + 0.09, head, 0.1), 0.015);
        b.beveled_cuboid(vec3(x - 0.12, 0.0, -0.28), vec3(x + 0.12, 0.3, 0.13), 0.015);
        b.beveled_cuboid(vec3(x - 0.12, head - 0.12, -0.28), vec3(x + 0.12, head, 0.13), 0.015);
    }
    for i in 0..panels {
        let (x0, x1) = (i as f32 * step + 0.09, (i + 1) as f32 * step - 0.09);
        let low = if i == door { 0.15 } else { sill };
        let z = if i == door { -0.25 } else { -0.12 };
        b.with_material(house.front);
        b.beveled_cuboid(vec3(x0, 0.0, -0.2), vec3(x1, low, z + 0.1), 0.012);
        if i != door {
            b.beveled_cuboid(vec3(x0 + 0.15, 0.14, -0.1), vec3(x1 - 0.15, sill - 0.12, 0.015), 0.015);
        }
        for (a, c, y0, y1) in [
            (x0, x0 + 0.06, low, head),
            (x1 - 0.06, x1, low, head),
            (x0, x1, head - 0.06, head),
            (x0, x1, low, low + 0.07),
            (x0, x1, 2.2, 2.25),
        ] {
            b.cuboid(vec3(a, y0, z - 0.03), vec3(c, y1, z + 0.03));
        }
        if i == door {
            b.with_material(p.brass);
            b.tube(&[vec3(x0 + 0.12, 0.95, z + 0.08), vec3(x0 + 0.12, 1.45, z + 0.08)], 0.014, 8, true);
        }
        b.with_material(p.pane);
        b.rectangle(vec3(x0, low, z), Vec3::X * (x1 - x0), Vec3::Y * (head - low));
    }
    shop_room(b, house, rng);
    awning(b, p, w, rng.random_range(0..2), house.ground == GroundFloor::Cafe);
}

fn shop_room(b: &mut SceneBuilder, house: &House, rng: &mut Pcg32) {
    let p = house.palette;
    let (w, back, top) = (house.width, -4.5, 2.85);
    b.with_material(p.wood);
    b.rectangle(vec3(0.0, PAVEMENT + 0.03, 0.0), Vec3::X * w, Vec3::Z * back);
    b.with_material(p.plasters[0]);
    b.rectangle(vec3(0.0, top, back), Vec3::X * w, Vec3::NEG_Z * back);
    b.rectangle(vec3(0.0, 0.0, back), Vec3::X * w, Vec3::Y * top);
    // In front of the party walls, which would otherwise flicker through.
    let inset = 0.08;
    b.rectangle(vec3(inset, 0.0, 0.0), Vec3::Z * back, Vec3::Y * top);
    b.rectangle(vec3(w - inset, 0.0, back), Vec3::NEG_Z * back, Vec3::Y * top);
    for shelf in 0..4 {
        let y = 0.7 + 0.5 * shelf as f32;
        b.with_material(p.wood);
        b.cuboid(vec3(0.4, y - 0.03, back), vec3(w - 0.4, y, back + 0.32));
        b.with_material(p.books);
        let mut x = 0.6;
        while x < w - 1.6 {
            if rng.random_bool(0.7) {
                let corners = [[0.0, 0.0], [1.1, 0.0], [1.1, 0.3], [0.0, 0.3]];
                b.picture(corners.map(|c| vec3(x + c[0], y + c[1], back + 0.22)));
            }
            x += 1.15;
        }
    }
    b.with_material(p.wood);
    b.beveled_cuboid(vec3(w * 0.2, PAVEMENT, back + 1.0), vec3(w * 0.75, 1.1, back + 1.6), 0.03);
    b.with_material(p.marble);
    b.beveled_cuboid(vec3(w * 0.19, 1.1, back + 0.95), vec3(w * 0.76, 1.15, back + 1.65), 0.015);
    for i in 0..(w / 2.2) as usize {
        let at = vec3(1.2 + i as f32 * 2.2, 2.05, -1.4);
        b.with_material(p.iron).cylinder(at + Vec3::Y * 0.1, vec3(at.x, top, at.z), 0.006, 0.006, 5, false);
        b.with_material(p.brass).within(Affine3A::from_translation(at), |b| {
            b.lathe(&[(0.17, -0.06), (0.13, 0.02), (0.04, 0.09), (0.0, 0.11)], 20);
        });
        b.with_material(p.lantern).ellipsoid(at - Vec3::Y * 0.03, Vec3::splat(0.06), 8, 14);
    }
}

fn awning(b: &mut SceneBuilder, p: &Palette, w: f32, color: usize, large: bool) {
    let cloth = p.awnings[if large { 0 } else { color }];
    let (out, drop) = if large { (2.1, 0.72) } else { (1.3, 0.5) };
    let (x0, x1, y) = (0.35, w - 0.35, 2.95);
    let sag = move |v: f32| 0.05 * (v * PI).sin();
    b.with_material(cloth);
    let spot =
        move |u: f32, v: f32| vec3(x0 + (x1 - x0) * u, y - drop * (1.0 - v) - sag(v), 0.1 + out * (1.0 - v));
    b.surface(40, 8, false, |u, v| (spot(u, v), vec2(u * (x1 - x0), v * out)));
    b.surface(40, 8, false, |u, v| {
        (spot(1.0 - u, v) - Vec3::Y * 0.006, vec2((1.0 - u) * (x1 - x0), v * out))
    });
    // Scallops along the edge, one for each stripe.
    let count = ((x1 - x0) / 0.3) as usize;
    let width = (x1 - x0) / count as f32;
    for i in 0..count {
        let left = x0 + width * i as f32;
        let mut rim = vec![vec3(left + width, y - drop, 0.1 + out), vec3(left, y - drop, 0.1 + out)];
        for k in 0..=6 {
            let (sin, cos) = (PI + PI * k as f32 / 6.0).sin_cos();
            rim.push(vec3(left + width * (0.5 + 0.5 * cos), y - drop - 0.14 + sin * 0.07, 0.1 + out + 0.01));
        }
        b.set_uv_offset(vec2(0.15 + 0.3 * (i % 2) as f32 - left, 0.0));
        b.fan(&rim, Vec3::Z);
        b.fan(&rim.iter().map(|p| *p - Vec3::Z * 0.006).collect::<Vec<_>>(), Vec3::NEG_Z);
    }
    b.set_uv_offset(Vec2::ZERO);
    b.with_material(p.iron);
    for x in [x0, (x0 + x1) * 0.5, x1] {
        b.tube(&[vec3(x, y - 0.02, 0.1), vec3(x, y - drop - 0.05, 0.08 + out)], 0.014, 8, true);
        b.tube(&[vec3(x, y - 0.9, 0.08), vec3(x, y - drop - 0.05, 0.08 + out)], 0.011, 8, true);
    }
    b.tube(&[vec3(x0, y - drop - 0.04, 0.09 + out), vec3(x1, y - drop - 0.04, 0.09 + out)], 0.016, 8, true);
}

fn terrace(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) -> Vec<PointLight> {
    let mut number = 0;
    for row in 0..6 {
        let z = TERRACE[1] - 1.5 - 2.2 * row as f32;
        for x in [4.75, 7.5] {
            let at = vec3(x + around(rng, 0.0, 0.08), PAVEMENT, z + around(rng, 0.0, 0.15));
            b.object(&format!("table {number}"));
            b.within(placed(at, rng.random::<f32>() * TAU), |b| table(b, p, rng));
            let first = rng.random::<f32>() * TAU;
            let seats = 3;
            for seat in 0..seats {
                let turn = first + seat as f32 * TAU / seats as f32 + around(rng, 0.0, 0.2);
                let chair_at = at + vec3(turn.sin(), 0.0, turn.cos()) * around(rng, 0.62, 0.06);
                // Keep the aisle free.
                if (chair_at.x - 6.1).abs() < 0.75 {
                    continue;
                }
                b.object(&format!("chair {number} {seat}"));
                b.within(placed(chair_at, turn + PI + around(rng, 0.0, 0.25)), |b| chair(b, p));
            }
            number += 1;
        }
    }
    // Planters and a low railing separate the terrace from the road.
    let edge = ROAD + 0.42;
    let mut z = TERRACE[1] - 0.3;
    let mut planter = 0;
    while z - 1.2 > TERRACE[0] {
        b.object(&format!("planter {planter}")).with_material(p.wood);
        b.beveled_cuboid(vec3(edge, PAVEMENT, z - 1.15), vec3(edge + 0.36, 0.62, z), 0.015);
        b.with_material(p.soil);
        b.rectangle(vec3(edge + 0.03, 0.58, z - 0.03), Vec3::X * 0.3, Vec3::NEG_Z * 1.09);
        let (low, high) = (vec3(edge + 0.03, 0.6, z - 1.12), vec3(edge + 0.33, 0.98, z - 0.03));
        hedge(b, low, high, p.box_leaves, 950, rng);
        if planter % 2 == 1 {
            b.with_material(p.flowers);
            for _ in 0..60 {
                let at = low.lerp(high, 0.5)
                    + vec3(around(rng, 0.0, 0.16), around(rng, 0.2, 0.08), around(rng, 0.0, 0.52));
                props::leaf_card(b, at, Vec3::Y, 0.035, rng);
            }
        }
        planter += 1;
        z -= 1.75;
    }
    b.object("terrace railing").with_material(p.iron);
    let rail = Railing { height: 0.92, low_rail: 0.14, ..Railing::default() };
    let (x0, x1, far) = (edge + 0.1, RIGHT_FACADES - 1.6, TERRACE[0] - 0.3);
    b.railing(&[vec3(x0, PAVEMENT, far), vec3(5.2, PAVEMENT, far)], &rail);
    b.railing(&[vec3(6.9, PAVEMENT, far), vec3(x1, PAVEMENT, far)], &rail);
    b.railing(&[vec3(6.9, PAVEMENT, TERRACE[1] + 0.4), vec3(x1, PAVEMENT, TERRACE[1] + 0.4)], &rail);

    menu_board(b, p, vec3(4.55, PAVEMENT, TERRACE[1] + 0.6));
    let mut lights = Vec::new();
    // Posts at the curb carry strings of bulbs to the facade and back.
    let posts: Vec<Vec3> =
        (0..5).map(|i| vec3(edge + 0.15, PAVEMENT, TERRACE[1] - 0.1 - 3.45 * i as f32)).collect();
    for (i, post) in posts.iter().enumerate() {
        b.object(&format!("bulb post {i}")).with_material(p.iron);
        b.cylinder(*post, *post + Vec3::Y * 3.25, 0.03, 0.022, 12, true);
        b.ellipsoid(*post + Vec3::Y * 3.28, Vec3::splat(0.045), 8, 12);
    }
    for (i, pair) in posts.windows(2).enumerate() {
        b.object(&format!("bulbs {i}"));
        let wires = [p.iron, p.iron, p.bulb];
        let wall = vec3(RIGHT_FACADES - 0.05, 3.65, (pair[0].z + pair[1].z) * 0.5);
        let first = bulb_string(b, wires, [pair[0] + Vec3::Y * 3.25, wall], 0.42, 0.42);
        let second = bulb_string(b, wires, [wall, pair[1] + Vec3::Y * 3.25], 0.42, 0.42);
        bulb_string(b, wires, [pair[0] + Vec3::Y * 3.25, pair[1] + Vec3::Y * 3.25], 0.25, 0.42);
        for bulbs in [first, second] {
            let position = bulbs[bulbs.len() / 2] - Vec3::Y * 0.1;
            lights.push(PointLight { position, color: vec3(1.5, 1.0, 0.5), range: 4.5 });
        }
    }
    for i in 0..3 {
        let position = vec3(RIGHT_FACADES + 1.6, 2.1, TERRACE[1] - 2.5 - 4.5 * i as f32);
        lights.push(PointLight { position, color: vec3(2.6, 1.8, 1.0), range: 6.0 });
    }
    for (i, z) in [-5.5, -12.5].into_iter().enumerate() {
        b.object(&format!("parasol {i}"));
        b.within(moved(7.5, PAVEMENT, z), |b| parasol(b, p));
    }
    lights
}

fn table(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    b.with_material(p.iron);
    b.lathe(&[(0.025, 0.04), (0.035, 0.08), (0.022, 0.14), (0.022, 0.6), (0.034, 0.66), (0.16, 0.705)], 16);
    for i in 0..3 {
        let (sin, cos) = (i as f32 / 3.0 * TAU).sin_cos();
        let out = vec3(cos, 0.0, sin);
        let path: Vec<Vec3> = (0..=8)
            .map(|k| {
                let t = k as f32 / 8.0;
                out * (0.02 + 0.26 * t) + Vec3::Y * (0.12 - 0.11 * t + 0.06 * (t * PI).sin())
            })
            .collect();
        b.tube(&path, 0.013, 8, true);
    }
    b.with_material(p.marble);
    b.lathe(
        &[
            (0.0, 0.71),
            (0.335, 0.71),
            (0.35, 0.72),
            (0.35, 0.735),
            (0.335, 0.742),
            (0.335, 0.742),
            (0.0, 0.742),
        ],
        40,
    );
    for i in 0..rng.random_range(1..=3) {
        let turn = i as f32 * 2.2 + rng.random::<f32>();
        let at = vec3(turn.sin() * 0.19, 0.742, turn.cos() * 0.19);
        b.within(placed(at, rng.random::<f32>() * TAU), |b| cup(b, p.china, p.coffee));
    }
    // A small vase with a flower in the middle.
    b.with_material(p.china).within(moved(0.0, 0.742, 0.0), |b| {
        b.lathe(&[(0.02, 0.0), (0.032, 0.03), (0.016, 0.08), (0.02, 0.1), (0.014, 0.1)], 16);
    });
    b.with_material(p.leaves);
    for _ in 0..5 {
        props::leaf_card(b, vec3(around(rng, 0.0, 0.03), 0.88, around(rng, 0.0, 0.03)), Vec3::Y, 0.04, rng);
    }
    b.with_material(p.flowers);
    for _ in 0..6 {
        props::leaf_card(
            b,
            vec3(around(rng, 0.0, 0.035), 0.93, around(rng, 0.0, 0.035)),
            Vec3::Y,
            0.035,
            rng,
        );
    }
}

/// Builds a cane chair that faces +z.
fn chair(b: &mut SceneBuilder, p: &Palette) {
    b.with_material(p.wicker);
    b.lathe(&[(0.0, 0.435), (0.19, 0.435), (0.205, 0.45), (0.195, 0.462), (0.195, 0.462), (0.0, 0.466)], 28);
    b.with_material(p.chair);
    for (x, z) in [(-0.14, 0.13), (0.14, 0.13), (-0.14, -0.14), (0.14, -0.14)] {
        let foot = vec3(x * 1.35, 0.0, z * 1.3);
        b.tube(&[foot, vec3(x, 0.44, z)], 0.014, 8, true);
    }
    let ring: Vec<Vec3> = (0..=24)
        .map(|i| {
            let (sin, cos) = (i as f32 / 24.0 * TAU).sin_cos();
            vec3(cos * 0.185, 0.2, sin * 0.175)
        })
        .collect();
    b.tube(&ring, 0.009, 6, false);
    for (half, height) in [(0.185, 0.43), (0.12, 0.3)] {
        let hoop: Vec<Vec3> = (0..=20)
            .map(|i| {
                let (sin, cos) = (PI * i as f32 / 20.0).sin_cos();
                let rise = sin.max(0.0).powf(0.55) * height;
                vec3(cos * half, 0.45 + rise, -0.15 - 0.2 * rise * rise)
            })
            .collect();
        b.tube(&hoop, 0.012, 8, false);
    }
    b.with_material(p.wicker);
    let back = |u: f32, v: f32, push: f32| {
        let rise = 0.12 + 0.16 * v;
        let half = 0.11 * (1.0 - 0.25 * v * v);
        (
            vec3((u - 0.5) * 2.0 * half, 0.45 + rise, -0.155 - 0.2 * rise * rise + push),
            vec2(u * 0.22, v * 0.16),
        )
    };
    b.surface(6, 6, false, |u, v| back(u, v, 0.006));
    b.surface(6, 6, false, |u, v| back(1.0 - u, v, -0.006));
}

fn parasol(b: &mut SceneBuilder, p: &Palette) {
    b.with_material(p.wood).cylinder(Vec3::ZERO, Vec3::Y * 2.75, 0.022, 0.022, 12, true);
    b.with_material(p.curb);
    b.lathe(&[(0.24, 0.0), (0.24, 0.06), (0.22, 0.08), (0.05, 0.1), (0.04, 0.2)], 28);
    let ribs = 8;
    let edge = |i: usize| {
        let (sin, cos) = (i as f32 / ribs as f32 * TAU).sin_cos();
        vec3(cos * 1.3, 2.22, -sin * 1.3)
    };
    let top = Vec3::Y * 2.72;
    for i in 0..ribs {
        b.with_material(p.awnings[0]);
        let (a, c) = (edge(i), edge(i + 1));
        // Cloth between two ribs sags a little.
        let panel = |u: f32, v: f32| {
            let rim = a.lerp(c, u);
            let sag = 0.07 * (u * PI).sin() * (1.0 - v);
            rim.lerp(top, v) - Vec3::Y * sag
        };
        b.surface(8, 8, false, |u, v| (panel(u, v), vec2(u * 0.99 * (1.0 - v) + 0.15, v * 1.4)));
        b.surface(8, 8, false, |u, v| {
            (panel(1.0 - u, v) - Vec3::Y * 0.008, vec2(u * 0.99 * (1.0 - v), v * 1.4))
        });
        b.with_material(p.wood).tube(&[edge(i), top], 0.008, 6, false);
        b.tube(&[edge(i).lerp(top, 0.5), Vec3::Y * 2.0], 0.007, 6, false);
    }
}

fn menu_board(b: &mut SceneBuilder, p: &Palette, at: Vec3) {
    let mut c = Canvas::new([256, 384], vec4(0.1, 0.12, 0.11, 1.0));
    c.text(vec2(60.0, 20.0), 40.0, "MENU", vec4(0.95, 0.92, 0.8, 1.0));
    for (i, line) in ["SOUPE 7", "QUICHE 9", "STEAK 16", "TARTE 6", "CAFE 2"].iter().enumerate() {
        c.text(vec2(24.0, 95.0 + 54.0 * i as f32), 24.0, line, vec4(0.9, 0.9, 0.86, 1.0));
    }
    b.object("menu board");
    let board = pictured(b, c.into_texture("menu"), 0.8, 0.0);
    for yaw in [0.0, PI] {
        let frame = placed(at, yaw) * Affine3A::from_rotation_x(-0.2) * moved(0.0, 0.0, 0.2);
        b.within(frame, |b| {
            b.with_material(p.wood);
            b.beveled_cuboid(vec3(-0.34, 0.02, -0.02), vec3(0.34, 1.08, 0.015), 0.01);
            b.with_material(board);
            b.picture([
                vec3(-0.29, 0.14, 0.018),
                vec3(0.29, 0.14, 0.018),
                vec3(0.29, 1.03, 0.018),
                vec3(-0.29, 1.03, 0.018),
            ]);
        });
    }
}

fn street_furniture(b: &mut SceneBuilder, p: &Palette, seed: u64) -> Vec<PointLight> {
    let rng = &mut random(seed, "furniture");
    let mut lights = Vec::new();
    for (i, (x, z)) in [(-4.1, 3.0), (-4.1, -9.5), (4.1, -19.0), (-4.1, -31.0), (4.1, -37.0), (-4.1, -52.0)]
        .into_iter()
        .enumerate()
    {
        b.object(&format!("lamp post {i}"));
        b.within(moved(x, PAVEMENT, z), |b| lamp_post(b, p));
        lights.push(PointLight { position: vec3(x, 3.9, z), color: vec3(2.6, 2.0, 1.2), range: 8.0 });
    }
    let trees =
        [(-5.3, 1.0), (-5.3, -6.5), (-5.3, -14.5), (5.6, -24.5), (-5.3, -36.0), (5.6, -33.0), (-5.3, -47.0)];
    for (i, (x, z)) in trees.into_iter().enumerate() {
        let tree = Tree {
            height: around(rng, 7.4, 0.9),
            trunk: around(rng, 2.6, 0.25),
            spread: around(rng, 2.3, 0.25),
            cards: if i < 4 { 9000 } else { 5000 },
            card_size: if i < 4 { 0.11 } else { 0.15 },
            bark: p.bark,
            leaves: p.leaves,
        };
        b.object(&format!("tree {i}"));
        b.within(placed(vec3(x, PAVEMENT, z), rng.random::<f32>() * TAU), |b| props::tree(b, &tree, rng));
        b.object(&format!("tree grate {i}")).with_material(p.iron);
        b.within(moved(x, PAVEMENT + 0.005, z), |b| {
            for k in 0..40 {
                let (sin, cos) = (k as f32 / 40.0 * TAU).sin_cos();
                let out = vec3(cos, 0.0, sin);
                b.tube(&[out * 0.32, out * 0.8], 0.012, 4, false);
            }
            for radius in [0.32_f32, 0.56, 0.8] {
                let ring: Vec<Vec3> = (0..=40)
                    .map(|k| {
                        let (sin, cos) = (k as f32 / 40.0 * TAU).sin_cos();
                        vec3(cos * radius, 0.0, sin * radius)
                    })
                    .collect();
                b.tube(&ring, 0.016, 4, false);
            }
        });
    }
    b.object("overhead wires").with_material(p.iron);
    for i in 0..9 {
        let z = 5.0 - 7.5 * i as f32;
        let a = vec3(LEFT_FACADES, around(rng, 7.4, 0.8), z + around(rng, 0.0, 1.5));
        let c = vec3(RIGHT_FACADES, around(rng, 7.4, 0.8), z + around(rng, 0.0, 1.5));
        b.wire(a, c, around(rng, 0.5, 0.2), 0.011, 24);
    }
    for (x, y) in [(-6.6, 6.6), (-6.5, 6.35), (8.5, 7.1)] {
        for span in 0..6 {
            let z = 8.0 - 12.0 * span as f32;
            b.wire(vec3(x, y, z), vec3(x, y, z - 12.0), 0.35, 0.01, 16);
        }
    }
    for i in 0..3 {
        let z = -20.0 - 8.0 * i as f32;
        let (a, c) = (vec3(LEFT_FACADES, 6.0, z), vec3(RIGHT_FACADES, 6.0, z - 1.0));
        b.object(&format!("street bulbs {i}"));
        bulb_string(b, [p.iron, p.iron, p.bulb], [a, c], 0.8, 0.55);
        let position = hanging(a, c, 0.8, 0.5) - Vec3::Y * 0.2;
        lights.push(PointLight { position, color: vec3(2.0, 1.35, 0.7), range: 7.0 });
    }
    bunting(b, p, rng);
    for i in 0..16 {
        let z = 7.0 - 4.0 * i as f32;
        for x in [-ROAD - 0.45, ROAD + 0.45] {
            if x > 0.0 && (TERRACE[0] - 1.0..TERRACE[1] + 1.0).contains(&z) {
                continue;
            }
            b.object(&format!("bollard {i} {}", if x < 0.0 { "left" } else { "right" }))
                .with_material(p.iron);
            b.within(moved(x, PAVEMENT, z), |b| {
                let profile =
                    [(0.075, 0.0), (0.075, 0.1), (0.05, 0.16), (0.045, 0.72), (0.062, 0.76), (0.04, 0.8)];
                b.lathe(&profile, 18);
                b.ellipsoid(Vec3::Y * 0.84, Vec3::splat(0.062), 10, 18);
            });
        }
    }
    for (i, z) in [-1.8, -2.7, -25.0].into_iter().enumerate() {
        b.object(&format!("bicycle {i}"));
        let frame = if i < 2 {
            placed(vec3(-4.35, PAVEMENT, z), FRAC_PI_2 + 0.12) * Affine3A::from_rotation_x(0.09)
        } else {
            placed(vec3(4.0, PAVEMENT, z), FRAC_PI_2) * Affine3A::from_rotation_x(-0.07)
        };
        b.within(frame, |b| bicycle(b, p, p.shutters[i % 3]));
    }
    for (i, (x, z, yaw)) in
        [(-2.25, -13.5, 0.0), (2.2, -24.0, PI), (-2.25, -42.0, 0.02)].into_iter().enumerate()
    {
        b.object(&format!("car {i}"));
        let colors = [p.car, p.shop_fronts[1], p.plasters[0]];
        b.within(placed(vec3(x, 0.02, z), yaw), |b| car(b, p, colors[i]));
    }
    for (i, z) in [-11.5, -20.0].into_iter().enumerate() {
        b.object(&format!("bench {i}"));
        b.within(placed(vec3(-6.2, PAVEMENT, z), FRAC_PI_2), |b| bench(b, p));
    }
    lights
}

fn lamp_post(b: &mut SceneBuilder, p: &Palette) {
    b.with_material(p.iron);
    b.lathe(
        &[
            (0.17, 0.0),
            (0.17, 0.12),
            (0.14, 0.16),
            (0.12, 0.6),
            (0.075, 0.72),
            (0.09, 0.78),
            (0.05, 0.86),
            (0.042, 3.2),
            (0.07, 3.25),
            (0.05, 3.34),
            (0.03, 3.5),
        ],
        20,
    );
    for side in [-1.0, 1.0] {
        b.tube(&[vec3(0.0, 3.0, 0.0), vec3(0.32 * side, 3.0, 0.0)], 0.016, 8, true);
    }
    for k in 0..6 {
        let (sin, cos) = (k as f32 / 6.0 * TAU).sin_cos();
        let out = vec3(cos, 0.0, sin);
        b.tube(&[out * 0.11 + Vec3::Y * 3.5, out * 0.19 + Vec3::Y * 4.0], 0.011, 6, true);
    }
    b.lathe(&[(0.03, 3.48), (0.13, 3.5), (0.13, 3.52), (0.0, 3.52)], 12);
    b.lathe(
        &[(0.0, 3.99), (0.22, 3.99), (0.22, 4.02), (0.1, 4.14), (0.05, 4.18), (0.04, 4.26), (0.0, 4.3)],
        12,
    );
    b.with_material(p.lantern);
    b.lathe(&[(0.06, 3.54), (0.09, 3.6), (0.11, 3.85), (0.05, 3.93), (0.0, 3.94)], 16);
}

fn bunting(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    let colors = [p.awnings[0], p.awnings[1], p.shutters[0], p.plasters[2]];
    for line in 0..3 {
        let z = -9.0 - 13.0 * line as f32;
        let (a, c) = (vec3(LEFT_FACADES, 8.4, z), vec3(RIGHT_FACADES, 8.8, z - 3.0));
        b.object(&format!("bunting {line}")).with_material(p.iron).wire(a, c, 1.2, 0.006, 40);
        let count = 46;
        for i in 0..count {
            let [t0, t1] = [i as f32 + 0.1, i as f32 + 0.9].map(|t| t / count as f32);
            let (left, right) = (hanging(a, c, 1.2, t0), hanging(a, c, 1.2, t1));
            let tip = left.lerp(right, 0.5) + vec3(0.0, -0.36, around(rng, 0.0, 0.14));
            b.with_material(colors[rng.random_range(0..4)]);
            let normal = (right - left).cross(tip - left).normalize();
            b.fan(&[left, right, tip], normal);
            b.fan(&[left, right, tip].map(|q| q - normal * 0.004), -normal);
        }
    }
}

/// Builds a bicycle along x, with the handlebar towards +x.
fn bicycle(b: &mut SceneBuilder, p: &Palette, paint: usize) {
    let (rear, front) = (vec3(-0.52, 0.34, 0.0), vec3(0.53, 0.34, 0.0));
    for hub in [rear, front] {
        let circle = |radius: f32, n: usize| -> Vec<Vec3> {
            (0..=n)
                .map(|i| {
                    let (sin, cos) = (i as f32 / n as f32 * TAU).sin_cos();
                    hub + vec3(cos * radius, sin * radius, 0.0)
                })
                .collect()
        };
        b.with_material(p.rubber).tube(&circle(0.33, 48), 0.017, 8, false);
        b.with_material(p.chrome).tube(&circle(0.308, 48), 0.01, 6, false);
        for spoke in circle(0.3, 28) {
            let side = if spoke.x > hub.x { 0.02 } else { -0.02 };
            b.cylinder(hub + Vec3::Z * side, spoke, 0.0016, 0.0016, 4, false);
        }
        b.cylinder(hub - Vec3::Z * 0.05, hub + Vec3::Z * 0.05, 0.018, 0.018, 12, true);
    }
    let (crank, seat, head) = (vec3(-0.08, 0.3, 0.0), vec3(-0.23, 0.78, 0.0), vec3(0.36, 0.8, 0.0));
    let low_head = vec3(0.39, 0.68, 0.0);
    b.with_material(paint);
    for [a, c] in [[crank, seat], [seat, head], [crank, low_head], [head, low_head]] {
        b.tube(&[a, c], 0.016, 10, true);
    }
    for side in [-0.045, 0.045] {
        let shift = Vec3::Z * side;
        b.tube(&[crank + shift * 0.6, rear + shift], 0.009, 8, true);
        b.tube(&[seat + shift * 0.4, rear + shift], 0.008, 8, true);
        b.tube(&[low_head, low_head + shift - Vec3::Y * 0.05, front + shift], 0.011, 8, true);
    }
    for (hub, span) in [(rear, [0.15, 0.85]), (front, [0.1, 0.6])] {
        let guard: Vec<Vec3> = (0..=16)
            .map(|i| {
                let t = span[0] + (span[1] - span[0]) * i as f32 / 16.0;
                let (sin, cos) = (t * PI).sin_cos();
                hub + vec3(cos * 0.365, sin * 0.365, 0.0)
            })
            .collect();
        b.tube(&guard, 0.02, 6, true);
    }
    b.with_material(p.chrome);
    b.tube(&[head, vec3(0.33, 0.95, 0.0)], 0.013, 8, true);
    let bar =
        [[0.16, 0.93, -0.28], [0.3, 0.96, -0.24], [0.34, 0.95, 0.0], [0.3, 0.96, 0.24], [0.16, 0.93, 0.28]];
    b.tube(&bar.map(Vec3::from), 0.011, 8, true);
    b.tube(&[seat, vec3(-0.25, 0.9, 0.0)], 0.012, 8, true);
    b.ellipsoid(vec3(0.45, 0.8, 0.0), vec3(0.045, 0.05, 0.05), 10, 14);
    for side in [-1.0, 1.0] {
        let turn = if side > 0.0 { vec3(0.12, 0.1, 0.0) } else { vec3(-0.12, -0.1, 0.0) };
        let pedal = crank + turn + Vec3::Z * 0.09 * side;
        b.tube(&[crank + Vec3::Z * 0.06 * side, crank + turn + Vec3::Z * 0.06 * side], 0.009, 6, true);
        b.cuboid(pedal - vec3(0.045, 0.01, 0.03), pedal + vec3(0.045, 0.01, 0.04));
    }
    b.with_material(p.chair);
    b.ellipsoid(vec3(-0.29, 0.94, 0.0), vec3(0.14, 0.035, 0.085), 10, 20);
    b.ellipsoid(vec3(-0.17, 0.94, 0.0), vec3(0.1, 0.026, 0.035), 8, 16);
    // A basket on the handlebar.
    b.with_material(p.wicker);
    let (low, high) = (vec3(0.44, 0.86, -0.16), vec3(0.68, 1.06, 0.16));
    for x in [low.x, high.x] {
        for z in 0..6 {
            let z = low.z + (high.z - low.z) * z as f32 / 5.0;
            b.cylinder(vec3(x, low.y, z), vec3(x, high.y, z), 0.005, 0.005, 5, false);
        }
    }
    for k in 0..5 {
        let y = low.y + (high.y - low.y) * k as f32 / 4.0;
        let loop_ = [
            [low.x, y, low.z],
            [high.x, y, low.z],
            [high.x, y, high.z],
            [low.x, y, high.z],
            [low.x, y, low.z],
        ];
        b.tube(&loop_.map(Vec3::from), 0.006, 5, false);
    }
}

/// Builds a small old saloon car along z, with the bonnet towards +z and the wheels on y = 0.
fn car(b: &mut SceneBuilder, p: &Palette, paint: usize) {
    // Stations along the car: z, half width, floor, waist.
    let hull = [
        (-1.68, 0.42, 0.42, 0.58),
        (-1.62, 0.58, 0.34, 0.74),
        (-1.35, 0.66, 0.27, 0.86),
        (-0.8, 0.7, 0.25, 0.9),
        (0.0, 0.71, 0.25, 0.9),
        (0.6, 0.7, 0.25, 0.9),
        (1.1, 0.66, 0.26, 0.86),
        (1.5, 0.58, 0.32, 0.74),
        (1.62, 0.46, 0.4, 0.6),
    ];
    let cabin = [
        (-1.3, 0.5, 0.84, 0.9),
        (-1.0, 0.56, 0.84, 1.22),
        (-0.6, 0.58, 0.84, 1.38),
        (-0.1, 0.58, 0.84, 1.42),
        (0.3, 0.57, 0.84, 1.37),
        (0.55, 0.55, 0.84, 1.14),
        (0.78, 0.5, 0.84, 0.88),
    ];
    let loft = |b: &mut SceneBuilder, stations: &[(f32, f32, f32, f32)], power: f32, grow: f32| {
        let sides = 28;
        let mut points = Vec::new();
        let ring = |station: (f32, f32, f32, f32), scale: f32, points: &mut Vec<(Vec3, Vec2)>| {
            let (z, half, low, high) = station;
            for i in 0..=sides {
                let (sin, cos) =
                    if i == sides { (0.0, 1.0) } else { (i as f32 / sides as f32 * TAU).sin_cos() };
                let squared = |v: f32| v.signum() * v.abs().powf(power);
                let (middle, tall) = ((low + high) * 0.5, (high - low) * 0.5 + grow);
                let x = squared(cos) * (half + grow) * scale;
                let y = middle + squared(sin) * tall * scale;
                points.push((vec3(x, y, z), vec2(i as f32 * 0.1, z)));
            }
        };
        ring(stations[0], 0.0, &mut points);
        for &station in stations {
            ring(station, 1.0, &mut points);
        }
        ring(stations[stations.len() - 1], 0.0, &mut points);
        b.grid(sides, stations.len() + 1, true, &points);
    };
    b.with_material(paint);
    loft(b, &hull, 0.55, 0.0);
    b.with_material(p.dark_glass);
    loft(b, &cabin, 0.5, -0.006);
    b.with_material(paint);
    // Roof and pillars over the glass.
    let skin = |z: f32, side: f32, height: f32| {
        let k = cabin
            .windows(2)
            .find(|s| z <= s[1].0)
            .map_or(cabin.len() - 2, |s| cabin.iter().position(|c| c.0 == s[0].0).unwrap_or(0));
        let t = (z - cabin[k].0) / (cabin[k + 1].0 - cabin[k].0);
        let half = cabin[k].1 + (cabin[k + 1].1 - cabin[k].1) * t;
        let top = cabin[k].3 + (cabin[k + 1].3 - cabin[k].3) * t;
        let (middle, tall) = ((0.84 + top) * 0.5, (top - 0.84) * 0.5);
        let sin = height.clamp(-0.99, 0.99);
        let cos = (1.0 - sin * sin).sqrt();
        let squared = |v: f32| v.signum() * v.abs().powf(0.5);
        vec3(squared(cos) * half * side, middle + squared(sin) * tall, z)
    };
    b.surface(12, 8, false, |u, v| {
        let z = 0.38 - 1.18 * v;
        let side = u * 2.0 - 1.0;
        let edge = skin(z, 1.0, 0.72);
        let top = skin(z, 1.0, 0.99).y;
        let y = edge.y + (top - edge.y) * (1.0 - side.abs().powi(4)) + 0.012;
        (vec3(edge.x * side, y, z), vec2(side, -z))
    });
    for side in [-1.0, 1.0] {
        for [a, c] in
            [[(0.66, -0.9), (0.36, 0.75)], [(-0.2, -0.9), (-0.2, 0.75)], [(-1.16, -0.9), (-0.8, 0.75)]]
        {
            let path: Vec<Vec3> = (0..=6)
                .map(|i| {
                    let t = i as f32 / 6.0;
                    skin(a.0 + (c.0 - a.0) * t, side, a.1 + (c.1 - a.1) * t)
                })
                .collect();
            b.tube(&path, 0.026, 8, false);
        }
        for z in [-1.02, 1.0] {
            b.with_material(paint).ellipsoid(vec3(0.6 * side, 0.44, z), vec3(0.17, 0.27, 0.42), 14, 24);
            let turned = if side > 0.0 { -FRAC_PI_2 } else { FRAC_PI_2 };
            b.within(moved(0.62 * side, 0.29, z) * Affine3A::from_rotation_z(turned), |b| {
                b.with_material(p.rubber);
                b.lathe(
                    &[(0.0, -0.1), (0.24, -0.1), (0.285, -0.07), (0.29, 0.05), (0.26, 0.16), (0.18, 0.165)],
                    32,
                );
                b.with_material(p.chrome);
                b.lathe(&[(0.18, 0.16), (0.17, 0.15), (0.1, 0.15), (0.09, 0.175), (0.0, 0.185)], 28);
            });
        }
        b.with_material(p.chrome);
        b.ellipsoid(vec3(0.44 * side, 0.68, 1.5), vec3(0.1, 0.1, 0.08), 12, 20);
        b.tube(&[vec3(0.712 * side, 0.78, -0.1), vec3(0.712 * side, 0.78, 0.05)], 0.014, 8, true);
        b.tube(&[vec3(0.58 * side, 0.9, 0.62), vec3(0.72 * side, 0.98, 0.66)], 0.009, 6, true);
        b.ellipsoid(vec3(0.75 * side, 1.0, 0.67), vec3(0.06, 0.045, 0.025), 8, 14);
        b.with_material(p.lantern).ellipsoid(
            vec3(0.44 * side, 0.68, 1.545),
            vec3(0.078, 0.078, 0.05),
            10,
            18,
        );
        b.with_material(p.shop_fronts[1]);
        b.ellipsoid(vec3(0.47 * side, 0.66, -1.6), vec3(0.05, 0.07, 0.05), 8, 14);
    }
    b.with_material(p.chrome);
    for (z, bulge) in [(1.68, 0.08), (-1.74, -0.08)] {
        let path: Vec<Vec3> = (0..=12)
            .map(|i| {
                let side = i as f32 / 6.0 - 1.0;
                vec3(side * 0.66, 0.4, z - bulge * 2.5 * side.powi(4))
            })
            .collect();
        b.tube(&path, 0.035, 10, true);
    }
    for i in 0..6 {
        let y = 0.47 + 0.035 * i as f32;
        b.tube(&[vec3(-0.24, y, 1.6), vec3(0.24, y, 1.6)], 0.009, 6, true);
    }
}

fn bench(b: &mut SceneBuilder, p: &Palette) {
    b.with_material(p.wood);
    for i in 0..4 {
        let z = 0.06 + 0.11 * i as f32;
        b.beveled_cuboid(vec3(-0.85, 0.43, z), vec3(0.85, 0.465, z + 0.085), 0.008);
    }
    for i in 0..3 {
        let y = 0.56 + 0.13 * i as f32;
        b.beveled_cuboid(
            vec3(-0.85, y, -0.03 - 0.03 * i as f32),
            vec3(0.85, y + 0.09, 0.005 - 0.03 * i as f32),
            0.008,
        );
    }
    b.with_material(p.iron);
    for x in [-0.65, 0.65] {
        b.tube(
            &[vec3(x, 0.0, 0.46), vec3(x, 0.42, 0.42), vec3(x, 0.42, 0.02), vec3(x, 0.95, -0.11)],
            0.02,
            8,
            true,
        );
        b.tube(&[vec3(x, 0.42, 0.04), vec3(x, 0.0, -0.05)], 0.02, 8, true);
    }
}

/// Builds the church at the end of the street, with its tower and the fountain in front of it.
fn church(b: &mut SceneBuilder, p: &Palette) {
    b.object("church").with_material(p.ashlar);
    let z = -92.0;
    b.cuboid_faces(vec3(-9.0, 0.0, z - 20.0), vec3(9.0, 14.0, z), BoxFaces::STANDING);
    b.cuboid_faces(vec3(-3.6, 0.0, z - 6.0), vec3(3.6, 27.0, z + 2.0), BoxFaces::STANDING);
    b.with_material(p.slate);
    b.fan(&[vec3(-9.6, 14.0, z + 0.3), vec3(9.6, 14.0, z + 0.3), vec3(0.0, 21.0, z + 0.3)], Vec3::Z);
    b.quad([
        vec3(-9.8, 13.8, z - 20.0),
        vec3(-9.8, 13.8, z + 0.5),
        vec3(0.0, 21.2, z + 0.5),
        vec3(0.0, 21.2, z - 20.0),
    ]);
    b.quad([
        vec3(9.8, 13.8, z + 0.5),
        vec3(9.8, 13.8, z - 20.0),
        vec3(0.0, 21.2, z - 20.0),
        vec3(0.0, 21.2, z + 0.5),
    ]);
    b.within(moved(0.0, 27.3, z - 2.0) * Affine3A::from_rotation_y(PI / 4.0), |b| {
        b.lathe(&[(5.3, 0.0), (2.2, 5.0), (0.15, 15.0)], 4);
    });
    b.with_material(p.trim);
    for y in [9.0, 17.5, 26.6] {
        b.beveled_cuboid(vec3(-3.9, y, z - 6.2), vec3(3.9, y + 0.6, z + 2.3), 0.12);
    }
    b.within(moved(0.0, 20.0, z + 2.02), |b| {
        for x in [-1.6, 1.6] {
            b.within(moved(x, 0.0, 0.0), |b| {
                b.arched_wall(vec2(2.2, 4.8), super::build::ArchOpening { width: 1.3, spring: 2.9 }, 0.3, 16);
            });
        }
    });
    b.within(moved(0.0, 0.1, z + 2.4), |b| {
        b.arched_wall(vec2(4.2, 6.4), super::build::ArchOpening { width: 2.6, spring: 3.6 }, 0.4, 20);
    });
    b.with_material(p.window);
    b.picture([[-1.3, 0.1], [1.3, 0.1], [1.3, 5.1], [-1.3, 5.1]].map(|c| vec3(c[0], c[1], z + 2.05)));
    for x in [-1.6_f32, 1.6] {
        b.picture(
            [[-0.65, 20.0], [0.65, 20.0], [0.65, 23.7], [-0.65, 23.7]]
                .map(|c| vec3(x + c[0], c[1], z + 2.03)),
        );
    }
    b.with_material(p.china);
    b.within(moved(0.0, 14.0, z + 2.0) * Affine3A::from_rotation_x(FRAC_PI_2), |b| {
        b.lathe(&[(1.25, 0.0), (1.25, 0.12), (1.25, 0.12), (0.0, 0.12)], 40);
        b.with_material(p.iron);
        b.cuboid(vec3(-0.05, 0.12, -0.95), vec3(0.05, 0.16, 0.1));
        b.cuboid(vec3(-0.1, 0.12, -0.06), vec3(0.66, 0.16, 0.06));
        for hour in 0..12 {
            b.within(Affine3A::from_rotation_y(hour as f32 / 12.0 * TAU), |b| {
                b.cuboid(vec3(-0.04, 0.12, 0.98), vec3(0.04, 0.15, 1.14));
            });
        }
    });
    b.object("fountain").with_material(p.trim);
    b.within(moved(0.0, 0.0, -72.0), |b| {
        b.lathe(&[(2.4, 0.0), (2.4, 0.55), (2.5, 0.6), (2.5, 0.7), (2.2, 0.7), (2.2, 0.4), (0.3, 0.4)], 40);
        b.lathe(
            &[(0.34, 0.4), (0.22, 0.6), (0.18, 1.5), (0.3, 1.6), (1.0, 1.8), (1.1, 1.95), (0.9, 1.9)],
            32,
        );
        b.lathe(&[(0.9, 1.85), (0.12, 1.85), (0.1, 2.5), (0.4, 2.65), (0.45, 2.75), (0.0, 2.7)], 28);
    });
}
