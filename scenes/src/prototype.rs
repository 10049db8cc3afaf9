//! A game level at the prototype stage: grid textures, ramps, stairs, platforms, dummies. In place of the paper's
//! Prototype.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Affine3A, Quat, Vec2, Vec3, vec2, vec3};
use rand::Rng;
use rand_pcg::Pcg32;

use super::build::{Railing, SceneBuilder, around, hanging, moved, placed, random};
use super::paint;
use super::props::palette;
use yoro_assets::{Alpha, Material, PointLight, Scene, Sky, Viewpoint};

fn grid(
    s: &mut SceneBuilder,
    name: &str,
    colors: [Vec3; 2],
    divisions: u32,
    label: &str,
    tile: f32,
) -> usize {
    let map = s.texture(paint::prototype_grid(name, 512, colors[0], colors[1], divisions, label));
    s.material(
        Material {
            name: name.into(),
            diffuse: Vec3::ONE,
            specular: Vec3::splat(0.12),
            roughness: 0.7,
            diffuse_map: Some(map),
            ..Material::default()
        },
        tile,
    )
}

fn plain(s: &mut SceneBuilder, name: &str, color: Vec3, roughness: f32, specular: f32) -> usize {
    s.material(
        Material {
            name: name.into(),
            diffuse: color,
            specular: Vec3::splat(specular),
            roughness,
            ..Material::default()
        },
        1.0,
    )
}

palette! {
    fn palette(s: &mut SceneBuilder, seed: u32) -> Palette {
        let white = Vec3::splat(0.9);
        let stripes = s.texture(paint::picture("stripes", [128, 128], |uv| {
            let band = ((uv.x + uv.y) * 4.0).fract() < 0.5;
            (if band { vec3(0.95, 0.75, 0.1) } else { Vec3::splat(0.12) }).extend(1.0)
        }));
        let boards = paint::planks("boards", 256, seed, vec3(0.72, 0.54, 0.34), 5);
        let (boards, boards_normal) = (s.texture(boards.color), s.texture(boards.normal));
        // Chain link: two families of diagonal wires.
        let links = s.texture(paint::picture("links", [128, 128], |uv| {
            let a = ((uv.x + uv.y) * 8.0).fract();
            let b = ((uv.x - uv.y) * 8.0).rem_euclid(1.0);
            let wire = (a - 0.5).abs().min((b - 0.5).abs());
            Vec3::splat(0.62).extend(paint::smoothstep(0.13, 0.07, wire))
        }));
    }
    floor = grid(s, "grid-floor", [Vec3::splat(0.3), Vec3::splat(0.62)], 4, "1 X 1 M", 1.0),
    wall = grid(s, "grid-wall", [Vec3::splat(0.68), Vec3::splat(0.95)], 4, "1 M", 1.0),
    orange = grid(s, "grid-orange", [vec3(0.92, 0.5, 0.16), white], 4, "RAMP", 1.0),
    blue = grid(s, "grid-blue", [vec3(0.2, 0.46, 0.78), white], 4, "BLOCK", 1.0),
    green = grid(s, "grid-green", [vec3(0.3, 0.62, 0.34), white], 4, "GOAL", 1.0),
    far = grid(s, "grid-far", [vec3(0.42, 0.45, 0.5), Vec3::splat(0.6)], 8, "8 M", 8.0),
    stripes = s.material(
        Material {
            name: "stripes".into(),
            diffuse: Vec3::ONE,
            diffuse_map: Some(stripes),
            ..Material::default()
        },
        0.5,
    ),
    metal = plain(s, "metal", Vec3::splat(0.5), 0.4, 0.5),
    dark = plain(s, "dark-metal", Vec3::splat(0.16), 0.5, 0.4),
    wood = s.material(
        Material {
            name: "boards".into(),
            diffuse: Vec3::ONE,
            diffuse_map: Some(boards),
            normal_map: Some(boards_normal),
            ..Material::default()
        },
        1.0,
    ),
    red = plain(s, "red", vec3(0.78, 0.17, 0.14), 0.45, 0.3),
    yellow = plain(s, "yellow", vec3(0.93, 0.74, 0.16), 0.5, 0.3),
    skin = plain(s, "dummy", vec3(0.86, 0.83, 0.76), 0.6, 0.2),
    glow = s.material(
        Material {
            name: "glow".into(),
            diffuse: vec3(0.2, 0.5, 0.4),
            emissive: vec3(0.6, 2.2, 1.5),
            ..Material::default()
        },
        1.0,
    ),
    mesh = s.material(
        Material {
            name: "links".into(),
            diffuse: Vec3::ONE,
            alpha: Alpha::Cutout(0.5),
            double_sided: true,
            diffuse_map: Some(links),
            ..Material::default()
        },
        0.5,
    ),
}

fn ramp(s: &mut SceneBuilder, width: f32, rise: f32, run: f32) {
    let half = width * 0.5;
    let [a, b] = [vec3(-half, 0.0, 0.0), vec3(half, 0.0, 0.0)];
    let [c, d] = [vec3(half, rise, -run), vec3(-half, rise, -run)];
    s.quad([a, b, c, d]);
    s.fan(&[b, c.with_y(0.0), c], Vec3::X);
    s.fan(&[a, d.with_y(0.0), d], Vec3::NEG_X);
    s.quad([c.with_y(0.0), d.with_y(0.0), d, c]);
}

fn ladder(s: &mut SceneBuilder, material: usize, height: f32) {
    s.with_material(material);
    for x in [-0.22, 0.22] {
        s.cylinder(vec3(x, 0.0, 0.0), vec3(x, height + 0.9, 0.0), 0.022, 0.022, 8, true);
        for y in [0.4, height - 0.3] {
            s.cylinder(vec3(x, y, 0.0), vec3(x, y, -0.16), 0.014, 0.014, 6, false);
        }
    }
    for i in 0..(height / 0.28) as usize {
        let y = 0.25 + i as f32 * 0.28;
        s.cylinder(vec3(-0.22, y, 0.0), vec3(0.22, y, 0.0), 0.014, 0.014, 6, false);
    }
}

fn crate_box(s: &mut SceneBuilder, p: &Palette, size: f32) {
    let half = size * 0.5;
    s.with_material(p.wood).beveled_cuboid(
        vec3(-half + 0.02, 0.02, -half + 0.02),
        vec3(half - 0.02, size - 0.02, half - 0.02),
        0.01,
    );
    s.with_material(p.dark);
    for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
        let c = vec3(x * (half - 0.025), 0.0, z * (half - 0.025));
        s.cuboid(c - vec3(0.025, 0.0, 0.025), c + vec3(0.025, size, 0.025));
    }
}

fn barrel(s: &mut SceneBuilder, material: usize) {
    let r = 0.29;
    let profile = [
        (0.0, 0.0),
        (r - 0.01, 0.0),
        (r - 0.01, 0.0),
        (r, 0.02),
        (r, 0.28),
        (r + 0.012, 0.3),
        (r, 0.32),
        (r, 0.56),
        (r + 0.012, 0.58),
        (r, 0.6),
        (r, 0.86),
        (r - 0.01, 0.88),
        (r - 0.01, 0.88),
        (r - 0.03, 0.87),
        (0.0, 0.87),
    ];
    s.with_material(material).lathe(&profile, 10);
}

/// Builds a capsule with a nose, as tall as a person.
fn dummy(s: &mut SceneBuilder, p: &Palette, band: usize) {
    let r = 0.3;
    let dome = |i: i32, top: bool| {
        let angle = i as f32 / 5.0 * FRAC_PI_2;
        if top { (r * angle.cos(), 1.5 + r * angle.sin()) } else { (r * angle.sin(), r - r * angle.cos()) }
    };
    let low: Vec<_> = (0..=5).map(|i| dome(i, false)).chain([(r, 1.0)]).collect();
    let high: Vec<_> = (0..=5).map(|i| if i == 5 { (0.0, 1.8) } else { dome(i, true) }).collect();
    s.with_material(p.skin).lathe(&low, 10);
    s.lathe(&[(r, 1.14), (r, 1.5)], 10);
    s.lathe(&high, 10);
    s.with_material(band).lathe(&[(r, 1.0), (r + 0.015, 1.01), (r + 0.015, 1.13), (r, 1.14)], 10);
    s.with_material(p.dark).beveled_cuboid(vec3(-0.16, 1.5, 0.18), vec3(0.16, 1.62, 0.36), 0.03);
}

/// Builds a panel of wire mesh on posts along +x.
fn wire_fence(s: &mut SceneBuilder, p: &Palette, length: f32, height: f32) {
    s.with_material(p.dark);
    let posts = (length / 2.0).round().max(1.0) as usize;
    for i in 0..=posts {
        let x = length * i as f32 / posts as f32;
        s.cylinder(vec3(x, 0.0, 0.0), vec3(x, height + 0.12, 0.0), 0.03, 0.03, 8, true);
    }
    s.with_material(p.metal);
    let rows = (height / 0.18) as usize;
    for i in 1..=rows {
        let y = height * i as f32 / rows as f32;
        s.cylinder(vec3(0.0, y, 0.0), vec3(length, y, 0.0), 0.004, 0.004, 4, false);
    }
    let columns = (length / 0.18) as usize;
    for i in 1..columns {
        let x = length * i as f32 / columns as f32;
        s.cylinder(vec3(x, 0.02, 0.0), vec3(x, height, 0.0), 0.004, 0.004, 4, false);
    }
}

fn ring(s: &mut SceneBuilder, radius: f32, thickness: f32) {
    s.surface(22, 7, true, |u, v| {
        let (turn, around) = (u.fract() * TAU, v.fract() * TAU);
        let out = vec3(turn.cos(), turn.sin(), 0.0);
        let p = out * (radius + thickness * around.cos()) + Vec3::Z * (thickness * -around.sin());
        (p, vec2(u * radius * TAU, v * thickness * TAU))
    });
}

fn platforms(s: &mut SceneBuilder, p: &Palette) {
    let rail = Railing { bar_spacing: 0.18, ..Railing::default() };
    s.object("platform-west").with_material(p.blue).cuboid(vec3(-10.0, 0.0, -8.0), vec3(-4.0, 2.0, 2.0));
    s.object("ramp").with_material(p.orange);
    s.within(moved(-7.0, 0.0, 8.0), |s| ramp(s, 2.2, 2.0, 6.0));
    s.object("ramp-rails").with_material(p.metal);
    for x in [-8.0, -6.0] {
        s.railing(&[vec3(x, 0.05, 7.8), vec3(x, 1.0, 5.0), vec3(x, 2.0, 2.0)], &rail);
    }
    s.object("platform-west-rails");
    s.railing(
        &[vec3(-8.0, 2.0, 1.95), vec3(-9.95, 2.0, 1.95), vec3(-9.95, 2.0, -3.0), vec3(-9.95, 2.0, -7.95)],
        &rail,
    );
    s.railing(&[vec3(-6.0, 2.0, 1.95), vec3(-4.05, 2.0, 1.95), vec3(-4.05, 2.0, -1.9)], &rail);
    s.object("bridge").with_material(p.orange).cuboid(vec3(-4.0, 1.82, -4.0), vec3(6.0, 2.0, -2.0));
    s.with_material(p.stripes);
    for z in [-4.0, -2.06] {
        s.cuboid(vec3(-4.0, 1.7, z), vec3(6.0, 1.82, z + 0.06));
    }
    s.object("bridge-rails").with_material(p.metal);
    for z in [-3.95, -2.05] {
        s.railing(
            &[
                vec3(-4.0, 2.0, z),
                vec3(-1.5, 2.0, z),
                vec3(1.0, 2.0, z),
                vec3(3.5, 2.0, z),
                vec3(6.0, 2.0, z),
            ],
            &rail,
        );
    }
    s.object("platform-east").with_material(p.blue).cuboid(vec3(6.0, 0.0, -8.0), vec3(12.0, 2.0, 2.0));
    s.object("stairs-east").with_material(p.wall);
    s.within(moved(9.0, 0.0, 6.0), |s| s.stairs(2.0, 0.2, 0.4, 10));
    s.object("tower-platform").with_material(p.wall).cuboid(vec3(-12.0, 0.0, -18.0), vec3(-4.0, 4.0, -10.0));
    s.object("stairs-tower").with_material(p.wall);
    s.within(moved(-8.0, 2.0, -8.0), |s| s.stairs(1.6, 0.2, 0.2, 10));
    s.object("pillars").with_material(p.wall);
    s.cuboid(vec3(-8.8, 0.0, -10.0), vec3(-7.2, 2.0, -8.0));
    for x in [-2.0, 4.0] {
        for z in [-3.7, -2.3] {
            s.with_material(p.metal).cylinder(vec3(x, 0.0, z), vec3(x, 1.8, z), 0.09, 0.09, 10, false);
        }
    }
    for (i, (x, z)) in
        [(-14.0, 8.0), (-14.0, 0.0), (-14.0, -8.0), (14.0, 8.0), (14.0, 0.0), (14.0, -8.0)].iter().enumerate()
    {
        s.object(&format!("pillar-{i}")).with_material(p.wall);
        s.cuboid(vec3(x - 0.4, 0.0, z - 0.4), vec3(x + 0.4, 5.0, z + 0.4));
        s.with_material(p.stripes).cuboid(vec3(x - 0.42, 0.0, z - 0.42), vec3(x + 0.42, 0.5, z + 0.42));
    }
    s.object("beams").with_material(p.orange);
    for x in [-14.0, 14.0f32] {
        s.cuboid(vec3(x - 0.25, 5.0, -9.0), vec3(x + 0.25, 5.4, 9.0));
    }
    s.with_material(p.dark);
    for z in [-8.0, 0.0, 8.0] {
        // Lattice girders: two chords with thin diagonals.
        for y in [5.1, 5.7] {
            s.cylinder(vec3(-14.0, y, z), vec3(14.0, y, z), 0.04, 0.04, 6, false);
        }
        for i in 0..28 {
            let (a, b) = (-14.0 + i as f32, -13.0 + i as f32);
            let (low, high) = if i % 2 == 0 { (5.1, 5.7) } else { (5.7, 5.1) };
            s.cylinder(vec3(a, low, z), vec3(b, high, z), 0.018, 0.018, 4, false);
        }
    }
    for (i, (x, z, y)) in [(0.0, 0.0, 2.6), (3.0, 8.0, 2.2), (-2.5, -8.0, 3.0)].into_iter().enumerate() {
        s.object(&format!("swing-{i}")).with_material(p.orange);
        s.cuboid(vec3(x - 1.0, y, z - 0.75), vec3(x + 1.0, y + 0.15, z + 0.75));
        s.with_material(p.dark);
        for (dx, dz) in [(-0.9, -0.65), (0.9, -0.65), (-0.9, 0.65), (0.9, 0.65)] {
            s.cylinder(vec3(x + dx, y + 0.15, z + dz), vec3(x + dx * 0.4, 5.1, z), 0.009, 0.009, 5, false);
        }
    }
}

fn spiral(s: &mut SceneBuilder, p: &Palette) {
    s.object("spiral");
    s.within(moved(17.0, 0.0, -15.0), |s| {
        s.with_material(p.wall).cylinder(Vec3::ZERO, Vec3::Y * 5.6, 0.3, 0.3, 12, true);
        let mut rail = Vec::new();
        for i in 0..26 {
            let (angle, y) = (i as f32 * 0.26, 0.2 * (i + 1) as f32);
            s.within(placed(Vec3::Y * y, angle), |s| {
                s.with_material(p.orange).cuboid(vec3(0.25, -0.06, -0.22), vec3(1.8, 0.0, 0.22));
                s.with_material(p.metal).cylinder(
                    vec3(1.72, 0.0, 0.0),
                    vec3(1.72, 0.95, 0.0),
                    0.011,
                    0.011,
                    5,
                    false,
                );
            });
            rail.push(vec3(1.72 * angle.cos(), y + 0.95, -1.72 * angle.sin()));
        }
        s.with_material(p.metal).tube(&rail, 0.024, 8, true);
    });
    s.object("lookout").with_material(p.blue).cuboid(vec3(13.0, 5.3, -23.0), vec3(21.0, 5.5, -17.0));
    s.with_material(p.wall);
    for (x, z) in [(13.4, -22.6), (20.6, -22.6), (13.4, -17.4), (20.6, -17.4)] {
        s.cuboid(vec3(x - 0.2, 0.0, z - 0.2), vec3(x + 0.2, 5.3, z + 0.2));
    }
}

fn enclosure(s: &mut SceneBuilder, p: &Palette) {
    s.object("floor").with_material(p.floor);
    for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
        let corner = vec3(-24.0 + 8.0 * i as f32, 0.0, -16.0 + 8.0 * j as f32);
        s.rectangle(corner, Vec3::X * 8.0, Vec3::NEG_Z * 8.0);
    }
    s.object("walls").with_material(p.wall);
    for (min, max) in [
        (vec3(-24.5, 0.0, -24.5), vec3(-6.0, 5.0, -24.0)),
        (vec3(2.0, 0.0, -24.5), vec3(24.5, 5.0, -24.0)),
        (vec3(-6.0, 3.5, -24.5), vec3(2.0, 5.0, -24.0)),
        (vec3(-24.5, 0.0, -24.0), vec3(-24.0, 5.0, -4.0)),
        (vec3(-24.5, 0.0, 4.0), vec3(-24.0, 5.0, 24.0)),
        (vec3(-24.5, 0.0, -4.0), vec3(-24.0, 1.0, 4.0)),
        (vec3(24.0, 0.0, -24.0), vec3(24.5, 5.0, 24.0)),
        (vec3(-24.5, 0.0, 24.0), vec3(24.5, 5.0, 24.5)),
    ] {
        s.cuboid(min, max);
    }
    s.object("gate").with_material(p.stripes);
    for x in [-6.1, 1.9] {
        s.cuboid(vec3(x, 0.0, -24.6), vec3(x + 0.2, 3.5, -23.9));
    }
    s.object("outside").with_material(p.far);
    s.rectangle(vec3(-240.0, -0.05, 240.0), Vec3::X * 480.0, Vec3::NEG_Z * 480.0);
}

fn surroundings(s: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    for i in 0..46 {
        let turn = i as f32 / 46.0 * TAU + around(rng, 0.0, 0.05);
        let distance = 46.0 + 150.0 * rng.random::<f32>().powf(1.4);
        let size =
            vec3(around(rng, 9.0, 4.0), around(rng, 16.0, 12.0) + distance * 0.08, around(rng, 9.0, 4.0));
        let base = vec3(turn.cos() * distance, -0.05, turn.sin() * distance);
        let material = [p.far, p.far, p.far, p.blue, p.green, p.orange][rng.random_range(0..6)];
        s.object(&format!("block-{i}")).with_material(material).cuboid_on(base, size);
        if i % 3 == 0 {
            s.with_material(p.far).cuboid_on(base + Vec3::Y * size.y, size * vec3(0.6, 0.4, 0.6));
        }
    }
    // Masts with cables that lead out of the level.
    s.object("masts").with_material(p.dark);
    let masts: Vec<Vec3> =
        (0..9).map(|i| vec3(-30.0 + 12.0 * (i as f32 * 0.9).sin(), 0.0, -30.0 - 16.0 * i as f32)).collect();
    for &m in &masts {
        s.cylinder(m, m + Vec3::Y * 11.0, 0.16, 0.09, 7, true);
        s.cuboid(m + vec3(-1.6, 9.9, -0.06), m + vec3(1.6, 10.02, 0.06));
    }
    for pair in masts.windows(2) {
        for x in [-1.5, 0.0, 1.5] {
            let up = vec3(x, 10.0, 0.0);
            s.wire(pair[0] + up, pair[1] + up, 0.7, 0.02, 8);
        }
    }
}

fn furniture(s: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    let stacks = [
        (3.2, 12.0),
        (-4.6, 7.6),
        (11.0, 10.0),
        (-12.5, 12.0),
        (18.0, 4.0),
        (2.0, -12.0),
        (-18.0, -14.0),
        (8.0, -16.0),
    ];
    for (i, (x, z)) in stacks.into_iter().enumerate() {
        s.object(&format!("crates-{i}"));
        for (dx, dz, level) in [(0.0, 0.0, 0), (1.15, 0.1, 0), (0.1, -1.15, 0), (0.45, -0.3, 1)] {
            let size = 0.95;
            let at = vec3(x + dx, level as f32 * size, z + dz);
            s.within(placed(at, around(rng, 0.0, 0.18)), |s| crate_box(s, p, size));
        }
    }
    for (i, (x, z)) in [(0.4, 10.3), (-9.2, 10.8), (4.4, -7.0), (15.0, 12.0)].into_iter().enumerate() {
        s.object(&format!("barrels-{i}"));
        for k in 0..3 {
            let turn = k as f32 * 2.1 + around(rng, 0.0, 0.2);
            let at = vec3(x + 0.38 * turn.cos(), 0.0, z + 0.38 * turn.sin());
            let material = [p.red, p.blue, p.yellow][(i + k) % 3];
            s.within(placed(at, turn), |s| barrel(s, if material == p.blue { p.metal } else { material }));
        }
    }
    s.object("barrel-lying");
    let lying = Affine3A::from_rotation_translation(Quat::from_rotation_z(FRAC_PI_2), vec3(-1.2, 0.31, 14.6));
    s.within(lying, |s| barrel(s, p.red));
    let dummies = [
        (vec3(-1.6, 0.0, 9.0), 0.4),
        (vec3(-8.9, 2.0, -0.8), 1.4),
        (vec3(7.4, 2.0, -3.6), -1.6),
        (vec3(9.5, 2.0, -6.5), 0.2),
        (vec3(-6.0, 4.0, -12.0), 0.1),
        (vec3(13.0, 0.0, 14.0), -0.6),
        (vec3(0.8, 0.0, -10.0), 0.0),
        (vec3(-18.0, 0.0, 4.0), 1.2),
    ];
    for (i, (at, yaw)) in dummies.into_iter().enumerate() {
        s.object(&format!("dummy-{i}"));
        let band = [p.red, p.yellow, p.dark][i % 3];
        s.within(placed(at, yaw), |s| dummy(s, p, band));
    }
    for (i, (at, height, yaw)) in [
        (vec3(-11.0, 0.0, -9.8), 4.0, 0.0),
        (vec3(5.8, 0.0, -6.0), 2.0, -FRAC_PI_2),
        (vec3(17.0, 0.0, -16.8), 5.4, 0.0),
    ]
    .into_iter()
    .enumerate()
    {
        s.object(&format!("ladder-{i}"));
        s.within(placed(at, yaw), |s| ladder(s, p.yellow, height));
    }
    s.object("fence-near");
    s.within(placed(vec3(3.0, 0.0, 20.0), FRAC_PI_2), |s| wire_fence(s, p, 5.0, 1.8));
    s.object("fence-east");
    s.within(moved(14.0, 0.0, 4.0), |s| wire_fence(s, p, 5.0, 1.8));
    for (i, (x, z, yaw)) in
        [(10.0, 18.0, 0.0), (-22.0, 10.0, FRAC_PI_2), (-22.0, -6.0, 0.0)].into_iter().enumerate()
    {
        s.object(&format!("links-{i}"));
        s.within(placed(vec3(x, 0.0, z), yaw), |s| {
            s.with_material(p.dark);
            for k in 0..=4 {
                let x = k as f32 * 2.0;
                s.cylinder(vec3(x, 0.0, 0.0), vec3(x, 2.3, 0.0), 0.03, 0.03, 7, true);
            }
            s.cylinder(vec3(0.0, 2.22, 0.0), vec3(8.0, 2.22, 0.0), 0.02, 0.02, 6, false);
            s.with_material(p.mesh).rectangle(vec3(0.0, 0.05, 0.0), Vec3::X * 8.0, Vec3::Y * 2.15);
        });
    }
    for (i, (at, yaw)) in
        [(vec3(0.0, 1.9, 5.4), 0.0), (vec3(7.5, 4.2, -12.0), 0.6), (vec3(-16.0, 2.4, -3.0), FRAC_PI_2)]
            .into_iter()
            .enumerate()
    {
        s.object(&format!("ring-{i}"));
        s.within(placed(at, yaw), |s| {
            s.with_material(p.glow);
            ring(s, 0.9, 0.045);
            s.with_material(p.dark).cylinder(Vec3::NEG_Y * at.y, Vec3::NEG_Y * 0.94, 0.025, 0.025, 8, false);
        });
    }
    // Slalom poles joined by a rope, near the start.
    s.object("slalom");
    let poles: Vec<Vec3> =
        (0..6).map(|i| vec3(-3.1 - 0.35 * (i % 2) as f32, 0.0, 17.0 - 1.5 * i as f32)).collect();
    for (i, &pole) in poles.iter().enumerate() {
        s.with_material(if i % 2 == 0 { p.red } else { p.skin });
        s.cylinder(pole, pole + Vec3::Y * 1.9, 0.016, 0.016, 7, true);
        s.with_material(p.dark).cylinder(pole, pole + Vec3::Y * 0.06, 0.16, 0.12, 10, true);
    }
    s.with_material(p.yellow);
    for pair in poles.windows(2) {
        s.wire(pair[0] + Vec3::Y * 1.6, pair[1] + Vec3::Y * 1.6, 0.12, 0.007, 7);
    }
    s.object("flags");
    for (i, x) in [-20.0, -12.0, 12.0, 20.0].into_iter().enumerate() {
        s.with_material(p.metal).cylinder(vec3(x, 0.0, -21.0), vec3(x, 7.0, -21.0), 0.04, 0.025, 8, true);
        let color = [p.red, p.yellow, p.green, p.orange][i];
        s.with_material(color);
        for side in [1.0, -1.0] {
            // A flag has two faces, so it needs no double-sided material.
            s.surface(6, 2, false, |u, v| {
                let u = if side > 0.0 { u } else { 1.0 - u };
                let z = -21.0 + 0.12 * (u * 6.0).sin() * u + 0.004 * side;
                (vec3(x + 1.6 * u, 5.9 + v, z), vec2(u * 1.6, v))
            });
        }
    }
    // Bunting between the girders.
    s.object("bunting");
    for (i, z) in [8.0, 0.0].into_iter().enumerate() {
        let (a, b) = (vec3(-13.6, 4.9, z), vec3(13.6, 4.7, z + 5.0));
        s.with_material(p.dark).wire(a, b, 1.0, 0.008, 18);
        for k in 1..22 {
            let at = hanging(a, b, 1.0, k as f32 / 22.0);
            s.with_material([p.red, p.yellow, p.skin][(k + i) % 3]);
            for normal in [Vec3::Z, Vec3::NEG_Z] {
                let corners = [at - Vec3::X * 0.14, at - Vec3::Y * 0.34, at + Vec3::X * 0.14];
                s.fan(&corners, normal);
            }
        }
    }
    for (i, (text, at, yaw, color)) in [
        ("START", vec3(1.2, 2.5, 23.95), PI, vec3(0.2, 0.55, 0.3)),
        ("GOAL", vec3(-2.0, 4.25, -23.95), 0.0, vec3(0.75, 0.25, 0.2)),
        ("2 M", vec3(-9.2, 1.0, 2.03), 0.0, vec3(0.2, 0.3, 0.6)),
        ("4 M", vec3(-10.2, 3.2, -9.97), 0.0, vec3(0.2, 0.3, 0.6)),
        ("LEVEL 01", vec3(14.0, 3.2, 8.43), 0.0, vec3(0.2, 0.2, 0.25)),
    ]
    .into_iter()
    .enumerate()
    {
        let width = 0.36 * text.len() as f32 * 0.5 + 0.3;
        let image = s.texture(paint::sign(&format!("sign-{i}"), [512, 192], text, Vec3::splat(0.95), color));
        let material = s.material(
            Material {
                name: format!("sign-{i}"),
                diffuse: Vec3::ONE,
                diffuse_map: Some(image),
                ..Material::default()
            },
            1.0,
        );
        s.object(&format!("sign-{i}")).with_material(material);
        let h = width * 0.375;
        s.within(placed(at, yaw), |s| {
            s.picture([
                vec3(-width, -h, 0.0),
                vec3(width, -h, 0.0),
                vec3(width, h, 0.0),
                vec3(-width, h, 0.0),
            ]);
        });
    }
}

/// Generates the scene; see [`super::BUILTINS`].
pub fn build(seed: u64, mut s: SceneBuilder) -> Scene {
    let mut rng = random(seed, "prototype");
    s.set_smooth(false);
    let p = palette(&mut s, rng.random::<u32>() >> 8);
    enclosure(&mut s, &p);
    platforms(&mut s, &p);
    spiral(&mut s, &p);
    furniture(&mut s, &p, &mut rng);
    surroundings(&mut s, &p, &mut rng);

    let lamp = |x, y, z, color: Vec3| PointLight { position: vec3(x, y, z), color, range: 10.0 };
    let mut lights = vec![
        lamp(0.0, 1.9, 5.4, vec3(0.5, 1.8, 1.2)),
        lamp(7.5, 4.2, -12.0, vec3(0.5, 1.8, 1.2)),
        lamp(-16.0, 2.4, -3.0, vec3(0.5, 1.8, 1.2)),
    ];
    s.object("lamps");
    for (x, z) in [(-7.0, -3.0), (1.0, -3.0), (9.0, -3.0), (1.0, 8.0), (-9.0, 8.0), (9.0, 8.0)] {
        s.with_material(p.dark).cylinder(vec3(x, 5.1, z), vec3(x, 4.5, z), 0.006, 0.006, 5, false);
        s.cylinder(vec3(x, 4.5, z), vec3(x, 4.3, z), 0.05, 0.22, 10, false);
        lights.push(lamp(x, 4.2, z, vec3(1.6, 1.4, 1.1)));
    }
    let position = |x: f32, z: f32| {
        let on_ramp = ((8.0 - z) / 3.0).clamp(0.0, 2.0);
        vec3(x, 1.65 + if x < -5.0 || z < 0.0 { on_ramp } else { 0.0 }, z)
    };
    let walk: Vec<(Vec3, Vec2)> = [
        (1.7, 18.4, -1.0, 4.0),
        (1.5, 16.4, -1.4, 3.0),
        (1.0, 14.5, -2.0, 2.0),
        (-0.1, 12.9, -2.8, 1.0),
        (-1.7, 11.8, -4.4, 0.5),
        (-3.6, 11.0, -6.0, 0.0),
        (-5.4, 10.0, -7.0, -1.0),
        (-6.6, 8.6, -7.4, -2.0),
        (-7.0, 6.8, -7.2, -6.0),
        (-7.0, 5.0, -6.6, -8.0),
        (-7.0, 3.2, -5.4, -9.0),
        (-6.8, 1.4, -3.6, -9.0),
        (-6.3, -0.4, -0.5, -9.0),
        (-5.2, -1.9, 2.5, -8.0),
        (-3.6, -2.8, 6.0, -7.5),
        (-1.8, -3.0, 9.0, -7.5),
        (0.0, -3.0, 12.0, -7.5),
        (1.8, -3.0, 14.0, -8.0),
        (3.6, -3.0, 16.0, -9.0),
    ]
    .map(|(x, z, tx, tz)| (position(x, z), vec2(tx, tz)))
    .to_vec();
    Scene {
        model: s.finish(),
        sky: Sky { sun_direction: vec3(0.45, 0.75, 0.5).normalize(), ..Sky::default() },
        lights,
        viewpoints: walk
            .into_iter()
            .map(|(position, t)| Viewpoint { position, target: vec3(t.x, position.y - 0.35, t.y) })
            .collect(),
        ..Scene::default()
    }
}
