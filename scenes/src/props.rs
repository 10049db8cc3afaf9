//! Objects used by several built-in scenes: materials, plants, lettering, strings of bulbs, crockery.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec3, vec2, vec3};
use rand::Rng;

use super::build::{SceneBuilder, around, hanging};
use super::paint;
use yoro_assets::{Alpha, Material, TextureImage};

/// Declares the materials of a scene, as a struct with a field for each, and the function that makes them. The function
/// runs the statements in its body first, then makes the fields in order. A field is a `usize`, the index of a material
/// in the [`SceneBuilder`], unless it has another type.
macro_rules! palette {
    (
        fn $make:ident($($argument:ident: $argument_type:ty),*) -> $palette:ident { $($before:tt)* }
        $($name:ident $(: $type:ty)? = $value:expr),* $(,)?
    ) => {
        struct $palette {
            $($name: palette!(@type $($type)?),)*
        }

        fn $make($($argument: $argument_type),*) -> $palette {
            $($before)*
            $palette { $($name: $value,)* }
        }
    };
    (@type) => { usize };
    (@type $type:ty) => { $type };
}
pub(crate) use palette;

/// Adds a material with a painted surface. `tile_size` is the edge length in metres that the picture covers.
pub fn textured(b: &mut SceneBuilder, surface: paint::Surface, tile_size: f32, roughness: f32) -> usize {
    let name = surface.color.name.clone();
    let diffuse_map = Some(b.texture(surface.color));
    let normal_map = Some(b.texture(surface.normal));
    let diffuse = Vec3::ONE;
    b.material(
        Material { name, diffuse, roughness, diffuse_map, normal_map, ..Material::default() },
        tile_size,
    )
}

/// Adds a material of one colour.
pub fn plain(b: &mut SceneBuilder, name: &str, diffuse: Vec3, roughness: f32) -> usize {
    b.material(Material { name: name.into(), diffuse, roughness, ..Material::default() }, 1.0)
}

/// Adds a bare metal of one colour.
pub fn metal(b: &mut SceneBuilder, name: &str, color: Vec3, roughness: f32) -> usize {
    let (diffuse, specular) = (color * 0.5, color);
    b.material(Material { name: name.into(), diffuse, specular, roughness, ..Material::default() }, 1.0)
}

/// Adds a material that emits light.
pub fn glowing(b: &mut SceneBuilder, name: &str, color: Vec3, strength: f32) -> usize {
    let (diffuse, emissive) = (color * 0.5, color * strength);
    b.material(Material { name: name.into(), diffuse, emissive, ..Material::default() }, 1.0)
}

/// Adds clear, blended glass.
pub fn glass(b: &mut SceneBuilder, name: &str, tint: Vec3, opacity: f32) -> usize {
    let alpha = Alpha::Blend(opacity);
    let material = Material {
        name: name.into(),
        diffuse: tint,
        specular: Vec3::splat(0.5),
        roughness: 0.06,
        alpha,
        double_sided: true,
        ..Material::default()
    };
    b.material(material, 1.0)
}

/// Adds a material with a picture, which emits light if `glow` is above 0.
pub fn pictured(b: &mut SceneBuilder, image: TextureImage, roughness: f32, glow: f32) -> usize {
    let name = image.name.clone();
    let map = b.texture(image);
    let material = Material {
        name,
        diffuse: Vec3::splat(if glow > 0.0 { 0.25 } else { 1.0 }),
        emissive: Vec3::splat(glow),
        roughness,
        diffuse_map: Some(map),
        emissive_map: (glow > 0.0).then_some(map),
        ..Material::default()
    };
    b.material(material, 1.0)
}

/// Adds a material of leaf cards, cut out of a painted twig.
pub fn foliage(b: &mut SceneBuilder, name: &str, seed: u64, color: Vec3) -> usize {
    let map = b.texture(paint::leaf_card(name, 256, seed as u32, color));
    let material = Material {
        name: name.into(),
        diffuse: Vec3::ONE,
        specular: Vec3::splat(0.15),
        roughness: 0.6,
        alpha: Alpha::Cutout(0.5),
        double_sided: true,
        diffuse_map: Some(map),
        ..Material::default()
    };
    b.material(material, 1.0)
}

/// The dimensions and materials of a [`tree`].
#[derive(Clone, Copy, Debug)]
pub struct Tree {
    /// Height of the top of the crown in metres.
    pub height: f32,
    /// Height in metres at which the trunk divides.
    pub trunk: f32,
    /// Radius of the crown in metres.
    pub spread: f32,
    /// Number of leaf cards.
    pub cards: usize,
    /// Half the edge length of a leaf card in metres.
    pub card_size: f32,
    /// Material of the trunk and branches.
    pub bark: usize,
    /// Cut-out material of the leaves.
    pub leaves: usize,
}

/// Builds a broad-leaved tree on the origin: three orders of branches, with leaf cards around the twigs.
pub fn tree(b: &mut SceneBuilder, tree: &Tree, rng: &mut impl Rng) {
    b.with_material(tree.bark);
    let base_radius = tree.height * 0.022;
    let lean = vec3(around(rng, 0.0, 0.15), 0.0, around(rng, 0.0, 0.15));
    let fork = vec3(lean.x, tree.trunk, lean.z);
    let trunk: Vec<Vec3> = (0..=8)
        .map(|i| {
            let t = i as f32 / 8.0;
            fork * vec3(t * t, t, t * t) + vec3((t * 5.0).sin(), 0.0, (t * 4.0).cos() - 1.0) * 0.03
        })
        .collect();
    let flare = move |t: f32| base_radius * (1.0 - 0.35 * t + 0.6 * (1.0 - t).powi(8));
    b.tapered_tube(&trunk, &flare, 14, false);
    let crown = vec3(fork.x, (tree.trunk + tree.height) * 0.5, fork.z);
    let radii = vec3(tree.spread, (tree.height - tree.trunk) * 0.55, tree.spread);
    let mut tips = Vec::new();
    let branch = |b: &mut SceneBuilder, from: Vec3, to: Vec3, radius: f32, sides: usize, droop: f32| {
        let path: Vec<Vec3> = (0..=6).map(|i| hanging(from, to, droop, i as f32 / 6.0)).collect();
        b.tapered_tube(&path, &|t| radius * (1.0 - 0.7 * t), sides, false);
        path
    };
    let boughs = 7;
    for i in 0..boughs {
        let turn = (i as f32 + around(rng, 0.0, 0.3)) / boughs as f32 * TAU;
        let rise = around(rng, 0.35, 0.35);
        let reach =
            if i == 0 { vec3(0.05, 0.75, 0.05) } else { vec3(turn.cos() * 0.62, rise, turn.sin() * 0.62) };
        let bough = branch(b, trunk[8 - i % 2], crown + reach * radii, base_radius * 0.5, 9, -0.25);
        for j in 0..6 {
            let from = bough[2 + j % 5];
            let direction = random_direction(rng) * vec3(1.0, 0.7, 1.0) + (from - crown) / radii * 0.7;
            let to = inside_crown(from + direction * tree.spread * 0.45, crown, radii);
            let limb = branch(b, from, to, base_radius * 0.2, 6, -0.08);
            for k in 0..5 {
                let from = limb[2 + k % 5];
                let direction = random_direction(rng) + (from - crown) / radii * 0.5;
                let to = inside_crown(from + direction * tree.spread * 0.28, crown, radii);
                branch(b, from, to, base_radius * 0.07, 4, 0.02);
                tips.push(from.lerp(to, 0.6));
                tips.push(to);
            }
        }
    }
    b.with_material(tree.leaves);
    for i in 0..tree.cards {
        let tip = tips[i % tips.len()];
        let center = tip + random_direction(rng) * tree.spread * 0.16 * rng.random::<f32>();
        let outward = ((center - crown) / radii + Vec3::Y * 0.25).normalize_or(Vec3::Y);
        leaf_card(b, center, outward, tree.card_size * around(rng, 1.0, 0.35), rng);
    }
}

fn inside_crown(p: Vec3, center: Vec3, radii: Vec3) -> Vec3 {
    let relative = (p - center) / radii;
    center + relative * radii / relative.length().max(1.0)
}

/// Returns a random unit vector, uniform over the sphere.
pub fn random_direction(rng: &mut impl Rng) -> Vec3 {
    let y = around(rng, 0.0, 1.0);
    let (sin, cos) = (rng.random::<f32>() * TAU).sin_cos();
    let ring = (1.0 - y * y).max(0.0).sqrt();
    vec3(ring * cos, y, ring * sin)
}

/// Builds one leaf card in a random direction that is lit as if it faced `outward`.
pub fn leaf_card(b: &mut SceneBuilder, center: Vec3, outward: Vec3, size: f32, rng: &mut impl Rng) {
    let facing = (outward + random_direction(rng) * 0.9).normalize_or(Vec3::Y);
    let right = facing.any_orthonormal_vector();
    let turn = Quat::from_axis_angle(facing, rng.random::<f32>() * TAU);
    let (right, up) = (turn * right, turn * facing.cross(right));
    let normal = (outward * 1.2 + random_direction(rng) * 0.5).normalize_or(Vec3::Y);
    b.card(center, right * size, up * size, normal);
}

/// Builds a clipped hedge: leaf cards over the box between two corners, dense enough to hide the inside.
pub fn hedge(b: &mut SceneBuilder, min: Vec3, max: Vec3, leaves: usize, cards: usize, rng: &mut impl Rng) {
    b.with_material(leaves);
    let (center, half) = ((min + max) * 0.5, (max - min) * 0.5);
    let areas = [half.y * half.z, half.x * half.z, half.x * half.y];
    let total: f32 = areas.iter().sum();
    for _ in 0..cards {
        let pick = rng.random::<f32>() * total;
        let axis = if pick < areas[0] { 0 } else { 1 + usize::from(pick >= areas[0] + areas[1]) };
        let mut p = vec3(around(rng, 0.0, 1.0), around(rng, 0.0, 1.0), around(rng, 0.0, 1.0));
        p[axis] = p[axis].signum() * around(rng, 0.93, 0.09);
        let mut outward = Vec3::ZERO;
        outward[axis] = p[axis].signum();
        let lit = (outward + p * 0.25 + Vec3::Y * 0.15).normalize_or(Vec3::Y);
        leaf_card(b, center + p * half, lit, around(rng, 0.055, 0.015), rng);
    }
}

/// Builds long bent leaves that grow from the origin: palms, grasses, lilies. They are solid strips, so `leaf` should
/// be double-sided.
pub fn fronds(b: &mut SceneBuilder, leaf: usize, count: usize, length: f32, width: f32, rng: &mut impl Rng) {
    b.with_material(leaf);
    for i in 0..count {
        let turn = (i as f32 * 0.381_966 + around(rng, 0.0, 0.06)) * TAU;
        let reach = length * around(rng, 0.85, 0.2);
        let steep = around(rng, 0.95, 0.35) * (1.0 - 0.35 * (i % 3) as f32 / 2.0);
        let (out, side) = (vec3(turn.cos(), 0.0, turn.sin()), vec3(-turn.sin(), 0.0, turn.cos()));
        let spine = |t: f32| {
            let rise = steep * t - 0.9 * t * t * (1.35 - steep * 0.6);
            out * (reach * (0.25 * t + 0.6 * t * t * (1.1 - 0.4 * steep))) + Vec3::Y * (reach * rise)
        };
        b.surface(4, 10, false, |u, v| {
            let across = u * 2.0 - 1.0;
            let breadth = width * 0.5 * (v * PI).sin().max(0.0).powf(0.6) * (1.0 - 0.55 * v) + 0.002;
            let fold = Vec3::Y * (across.abs() * breadth * 0.45);
            (spine(v) - side * (across * breadth) + fold, vec2(across * breadth, v * reach))
        });
    }
}

/// Builds a plant with broad leaves on stems around the origin: leaf cards in whorls.
pub fn bush(
    b: &mut SceneBuilder,
    [stem, leaves]: [usize; 2],
    radius: f32,
    height: f32,
    cards: usize,
    rng: &mut impl Rng,
) {
    b.with_material(stem);
    let mut tips = Vec::new();
    for i in 0..10 {
        let turn = (i as f32 + around(rng, 0.0, 0.3)) / 10.0 * TAU;
        let out = vec3(turn.cos(), 0.0, turn.sin()) * radius * around(rng, 0.5, 0.3);
        let tip = out + Vec3::Y * height * around(rng, 0.8, 0.2);
        let path: Vec<Vec3> =
            (0..=6).map(|k| hanging(Vec3::ZERO, tip, -0.06 * height, k as f32 / 6.0)).collect();
        b.tapered_tube(&path, &|t| 0.012 * height * (1.2 - t), 5, false);
        tips.extend_from_slice(&path[2..]);
    }
    b.with_material(leaves);
    for i in 0..cards {
        let center = tips[i % tips.len()] + random_direction(rng) * radius * 0.3;
        let outward = (center - Vec3::Y * height * 0.4).normalize_or(Vec3::Y);
        leaf_card(b, center, outward, radius * around(rng, 0.28, 0.1), rng);
    }
}

/// Builds a wire from `a` to `b` with a lamp bulb every `spacing` metres. Returns the positions of the bulbs.
pub fn bulb_string(
    b: &mut SceneBuilder,
    [wire, socket, bulb]: [usize; 3],
    [from, to]: [Vec3; 2],
    sag: f32,
    spacing: f32,
) -> Vec<Vec3> {
    let count = (from.distance(to) / spacing).round().max(2.0) as usize;
    b.with_material(wire).wire(from, to, sag, 0.006, count * 2);
    let mut bulbs = Vec::with_capacity(count - 1);
    for i in 1..count {
        let p = hanging(from, to, sag, i as f32 / count as f32);
        b.with_material(socket).cylinder(p - Vec3::Y * 0.05, p, 0.014, 0.014, 8, true);
        let center = p - Vec3::Y * 0.085;
        b.with_material(bulb).ellipsoid(center, vec3(0.03, 0.042, 0.03), 8, 12);
        bulbs.push(center);
    }
    bulbs
}

/// Builds a cup on a saucer, on the origin.
pub fn cup(b: &mut SceneBuilder, china: usize, coffee: usize) {
    b.with_material(china);
    let saucer = [
        (0.0, 0.004),
        (0.03, 0.004),
        (0.07, 0.014),
        (0.072, 0.017),
        (0.072, 0.017),
        (0.03, 0.009),
        (0.0, 0.009),
    ];
    b.lathe(&saucer.map(|(r, y)| (r, y + 0.001)), 28);
    b.lathe(
        &[
            (0.0, 0.011),
            (0.022, 0.011),
            (0.032, 0.025),
            (0.041, 0.07),
            (0.042, 0.072),
            (0.039, 0.072),
            (0.039, 0.072),
            (0.030, 0.03),
        ],
        28,
    );
    let handle: Vec<Vec3> = (0..=12)
        .map(|i| {
            let angle = (i as f32 / 12.0 - 0.5) * PI * 1.1;
            vec3(0.034 + angle.cos() * 0.022, 0.045 + angle.sin() * 0.018, 0.0)
        })
        .collect();
    b.tube(&handle, 0.0045, 8, false);
    b.with_material(coffee).lathe(&[(0.038, 0.06), (0.0, 0.06)], 28);
}

/// Draws letters as round tubes in the XY plane, from the origin to the right, `height` metres tall. Letters without a
/// glyph in [`paint::glyph`] are left blank.
pub fn tube_text(b: &mut SceneBuilder, text: &str, height: f32, radius: f32) {
    let unit = height / 6.0;
    let mut x = 0.0;
    for letter in text.chars() {
        for stroke in paint::glyph(letter.to_ascii_uppercase()).split_whitespace() {
            let corners: Vec<Vec3> = stroke
                .as_bytes()
                .chunks_exact(2)
                .map(|p| vec3(x + f32::from(p[0] - b'0') * unit, f32::from(p[1] - b'0') * unit, 0.0))
                .collect();
            for bent in split_at_points(&corners) {
                b.tube(&rounded(bent, unit * 0.9), radius, 6, true);
            }
        }
        x += letter_width(letter) * unit;
    }
}

fn letter_width(letter: char) -> f32 {
    if letter == ' ' { 3.0 } else { 5.6 }
}

/// Returns the width of [`tube_text`] in metres.
pub fn tube_text_width(text: &str, height: f32) -> f32 {
    (text.chars().map(letter_width).sum::<f32>() - 1.6) * height / 6.0
}

/// Splits a polyline at acute corners, where a tube cannot bend far enough.
fn split_at_points(corners: &[Vec3]) -> Vec<&[Vec3]> {
    let mut pieces = Vec::new();
    let mut start = 0;
    for k in 1..corners.len() - 1 {
        if (corners[k] - corners[k - 1]).angle_between(corners[k + 1] - corners[k]) > 0.6 * PI {
            pieces.push(&corners[start..=k]);
            start = k;
        }
    }
    pieces.push(&corners[start..]);
    pieces
}

/// Returns a polyline with its corners rounded to arcs, as glass tubes are bent.
fn rounded(corners: &[Vec3], radius: f32) -> Vec<Vec3> {
    let mut path = vec![corners[0]];
    for k in 1..corners.len() - 1 {
        let [a, p, c] = [corners[k - 1], corners[k], corners[k + 1]];
        let cut = radius.min(a.distance(p) * 0.45).min(c.distance(p) * 0.45);
        let (start, end) = (p + (a - p).normalize() * cut, p + (c - p).normalize() * cut);
        for i in 0..=4 {
            let t = i as f32 / 4.0;
            path.push(start.lerp(p, t).lerp(p.lerp(end, t), t));
        }
    }
    path.push(corners[corners.len() - 1]);
    path
}
