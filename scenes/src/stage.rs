//! An anime-style singer on a concert stage at nightfall. In place of the paper's UnityChan.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Affine3A, Quat, Vec2, Vec3, vec2, vec3};
use rand::Rng;
use rand_pcg::Pcg32;

use super::build::{BoxFaces, Railing, SceneBuilder, around, moved, placed, random};
use super::figure::{self, Hand, Joints};
use super::motion::{Movers, about};
use super::paint::{self, Face};
use super::props::{self, palette};
use super::sculpt::Clay;
use yoro_assets::{Alpha, Material, PointLight, Scene, Sky, Viewpoint};

/// Height of the stage in metres.
const STAGE: f32 = 1.0;
const TEAL: Vec3 = Vec3::new(0.12, 0.55, 0.6);
const PINK: Vec3 = Vec3::new(0.95, 0.35, 0.55);

fn two_sided(s: &mut SceneBuilder, name: &str, color: Vec3) -> usize {
    s.material(
        Material {
            name: name.into(),
            diffuse: color,
            specular: Vec3::splat(0.08),
            roughness: 0.8,
            double_sided: true,
            ..Material::default()
        },
        1.0,
    )
}

palette! {
    fn palette(s: &mut SceneBuilder) -> Palette {
        let grille = paint::surface("grille", [128, 128], 0.02, |uv| {
            let p = uv * 16.0 - (uv * 16.0).floor() - 0.5;
            let hole = paint::smoothstep(0.36, 0.3, p.length());
            (Vec3::splat(0.3 - 0.2 * hole), 1.0 - hole)
        });
        let cone = |s: &mut SceneBuilder, name: &str, color: Vec3| {
            s.material(
                Material {
                    name: name.into(),
                    diffuse: color * 0.5,
                    specular: Vec3::ZERO,
                    emissive: color * 0.5,
                    alpha: Alpha::Blend(0.07),
                    double_sided: true,
                    ..Material::default()
                },
                1.0,
            )
        };
    }
    black = props::plain(s, "black", Vec3::splat(0.13), 0.6),
    steel = props::metal(s, "truss", Vec3::splat(0.66), 0.4),
    dark = props::metal(s, "dark-metal", Vec3::splat(0.34), 0.5),
    lens: [usize; 3] = [
        props::glowing(s, "lens-warm", vec3(1.0, 0.85, 0.6), 3.0),
        props::glowing(s, "lens-pink", vec3(1.0, 0.35, 0.65), 3.0),
        props::glowing(s, "lens-cyan", vec3(0.3, 0.85, 1.0), 3.0),
    ],
    strip: [usize; 2] = [
        props::glowing(s, "strip-pink", vec3(1.0, 0.25, 0.6), 2.2),
        props::glowing(s, "strip-cyan", vec3(0.2, 0.8, 1.0), 2.2),
    ],
    grille = props::textured(s, grille, 0.3, 0.7),
    cone: [usize; 2] = [cone(s, "beam-pink", vec3(1.0, 0.4, 0.8)), cone(s, "beam-cyan", vec3(0.4, 0.8, 1.0))],
    gold = props::metal(s, "cymbal", vec3(0.86, 0.68, 0.3), 0.3),
    crowd: [usize; 3] = [
        props::plain(s, "crowd-a", vec3(0.3, 0.28, 0.42), 0.9),
        props::plain(s, "crowd-b", vec3(0.45, 0.28, 0.32), 0.9),
        props::plain(s, "crowd-c", vec3(0.26, 0.38, 0.45), 0.9),
    ],
    crowd_skin: [usize; 2] = [
        props::plain(s, "crowd-skin-a", vec3(0.85, 0.66, 0.56), 0.8),
        props::plain(s, "crowd-skin-b", vec3(0.55, 0.38, 0.3), 0.8),
    ],
    crowd_hair: [usize; 2] = [
        props::plain(s, "crowd-hair-a", vec3(0.16, 0.11, 0.1), 0.8),
        props::plain(s, "crowd-hair-b", vec3(0.42, 0.24, 0.14), 0.8),
    ],
    sticks: [usize; 4] = [
        props::glowing(s, "stick-pink", vec3(1.0, 0.3, 0.6), 2.6),
        props::glowing(s, "stick-cyan", vec3(0.25, 0.8, 1.0), 2.6),
        props::glowing(s, "stick-yellow", vec3(1.0, 0.85, 0.3), 2.6),
        props::glowing(s, "stick-green", vec3(0.4, 1.0, 0.5), 2.6),
    ],
}

palette! {
    fn outfit(s: &mut SceneBuilder, seed: u32) -> Outfit {
        let skin = vec3(0.98, 0.84, 0.76);
        // A little emission keeps the drawn face readable on its shadow side.
        let fair = |s: &mut SceneBuilder, name: &str, image: Option<yoro_assets::TextureImage>| {
            let map = image.map(|image| s.texture(image));
            let tone = if map.is_some() { Vec3::ONE } else { skin };
            s.material(
                Material {
                    name: name.into(),
                    diffuse: tone * 0.9,
                    specular: Vec3::splat(0.04),
                    emissive: tone * 0.28,
                    roughness: 0.7,
                    diffuse_map: map,
                    emissive_map: map,
                    ..Material::default()
                },
                1.0,
            )
        };
        let face = paint::face(
            "singer-face",
            1024,
            &Face {
                skin,
                iris: vec3(0.2, 0.5, 0.78),
                brow: vec3(0.42, 0.22, 0.3),
                lips: vec3(0.9, 0.45, 0.45),
                eye: vec2(0.338, 0.455),
                eye_radii: vec2(0.098, 0.132),
                mouth_y: 0.235,
                mouth_width: 0.075,
                mouth_open: 0.6,
                blush: 1.0,
            },
        );
        let hair = paint::picture("singer-hair", [256, 256], |uv| {
            let strand = paint::fbm(seed, glam::UVec2::new(20, 1), 3, uv);
            let shine = paint::smoothstep(0.12, 0.0, ((uv.y * 2.0).fract() - 0.4).abs() + 0.1 * (strand - 0.5));
            (vec3(0.95, 0.62, 0.7) * (0.75 + 0.4 * strand) + Vec3::splat(0.12 * shine)).extend(1.0)
        });
        let striped = |name: &str, base: Vec3, stripe: Vec3, at: [f32; 2], width: f32| {
            paint::picture(name, [64, 256], |uv| {
                let on = at.iter().any(|a| (uv.y - a).abs() < width);
                (if on { stripe } else { base }).extend(1.0)
            })
        };
        let skirt = striped("skirt", TEAL, vec3(0.96, 0.96, 0.98), [0.12, 0.2], 0.022);
        let stocking = paint::picture("stocking", [64, 256], |uv| {
            let weave = 0.9 + 0.2 * (uv.x * 64.0 * PI).sin().abs();
            (vec3(0.16, 0.15, 0.22) * weave).extend(1.0)
        });
        let double = |s: &mut SceneBuilder, image: yoro_assets::TextureImage| {
            let name = image.name.clone();
            let map = s.texture(image);
            s.material(
                Material {
                    name,
                    diffuse: Vec3::ONE,
                    specular: Vec3::splat(0.08),
                    roughness: 0.8,
                    double_sided: true,
                    diffuse_map: Some(map),
                    ..Material::default()
                },
                1.0,
            )
        };
    }
    face = fair(s, "singer-face", Some(face)),
    skin = fair(s, "singer-skin", None),
    hair = props::pictured(s, hair, 0.4, 0.0),
    white = props::plain(s, "blouse", vec3(0.96, 0.95, 0.98), 0.8),
    teal = two_sided(s, "teal-cloth", TEAL),
    frill = two_sided(s, "frill", vec3(0.97, 0.94, 0.97)),
    skirt = double(s, skirt),
    red = two_sided(s, "ribbon", vec3(0.9, 0.2, 0.3)),
    stocking = double(s, stocking),
    boot = props::plain(s, "boot", vec3(0.94, 0.93, 0.95), 0.3),
    gold = props::metal(s, "buckle", vec3(0.9, 0.72, 0.3), 0.3),
}

/// Builds a bow in the XY plane: two loops, a knot, two tails.
fn bow(s: &mut SceneBuilder, material: usize, size: f32) {
    s.with_material(material);
    for side in [-1.0, 1.0] {
        let mut loops = Clay::new(0.02 * size);
        loops.turned_ball(
            vec3(side * 0.5, 0.1, 0.0) * size,
            vec3(0.46, 0.27, 0.13) * size,
            Quat::from_rotation_z(side * 0.25),
        );
        loops.carve(vec3(side * 0.95, 0.2, 0.0) * size, vec3(0.2, 0.12, 0.3) * size);
        loops.mesh(s, 0.07 * size, |p, _| p.truncate());
        s.surface(6, 10, false, |u, v| {
            let across = u - 0.5;
            let fall = 1.0 - v;
            let x = side * (0.12 + 0.45 * fall + 0.06 * (fall * 7.0).sin()) + across * (0.22 + 0.16 * fall);
            let p =
                vec3(x, -1.15 * fall - 0.1 * across.abs() * fall, 0.05 + 0.08 * (fall * 6.0 + side).sin())
                    * size;
            (p, vec2(u, v))
        });
    }
    s.ellipsoid(Vec3::Z * 0.05 * size, vec3(0.15, 0.17, 0.14) * size, 10, 14);
}

fn singer_hair(s: &mut SceneBuilder, o: &Outfit, r: Vec3, rng: &mut Pcg32) {
    s.with_material(o.hair);
    let mut cap = Clay::new(0.025);
    cap.ball(vec3(0.0, 0.18 * r.y, -0.12 * r.z), r * vec3(1.09, 1.0, 1.08));
    cap.ball(vec3(0.0, -0.3 * r.y, -0.45 * r.z), r * vec3(0.98, 0.8, 0.68));
    cap.carve(vec3(0.0, -0.55 * r.y, 1.0 * r.z), r * vec3(0.93, 1.18, 0.92));
    cap.mesh(s, 0.011, |p, _| vec2(p.x.atan2(p.z), p.y * 3.0));
    // The fringe: pointed locks that end above the eyes.
    for i in 0..15 {
        let t = i as f32 / 14.0;
        let turn = -1.2 + 2.4 * t;
        let root = figure::on_head(r, turn * 0.3, 1.25, 1.04);
        let tip_turn = turn + around(rng, 0.0, 0.05);
        let tip_rise = 0.16 - 0.42 * turn.abs().powi(3) + if i % 2 == 0 { 0.0 } else { 0.12 };
        let tip = figure::on_head(r, tip_turn, tip_rise, 1.1);
        let bend = figure::on_head(r, turn * 0.8, 0.95, 1.24);
        let low = figure::on_head(r, tip_turn, tip_rise + 0.35, 1.22);
        figure::lock(s, [root, bend, low, tip], 0.0205, 0.4, [7, 10]);
    }
    // Long locks in front of the ears.
    for side in [-1.0, 1.0] {
        for i in 0..3 {
            let turn = side * (1.12 + 0.16 * i as f32);
            let root = figure::on_head(r, turn, 0.5, 1.05);
            let mid = figure::on_head(r, turn, -0.3, 1.2);
            let tip = mid + vec3(-side * 0.012, -0.2 + 0.03 * i as f32, 0.03);
            figure::lock(s, [root, mid, mid + vec3(side * 0.015, -0.1, 0.01), tip], 0.019, 0.5, [7, 11]);
        }
        // An ahoge and the twin tails.
        let tie = vec3(side * 1.02, 0.62, -0.42) * r;
        for i in 0..17 {
            let turn = i as f32 / 16.0 * TAU * 2.0;
            let spread = 0.035 + 0.03 * (i as f32 / 16.0);
            let offset = vec3(turn.cos(), 0.0, turn.sin()) * spread;
            let sweep = vec3(side * around(rng, 0.2, 0.03), 0.06, -0.05);
            let length = around(rng, 0.72, 0.08);
            let tip = tie + vec3(side * around(rng, 0.17, 0.07), -length, around(rng, -0.12, 0.07));
            let low =
                tie + sweep + offset * 1.8 + vec3(side * around(rng, 0.05, 0.05), -length * 0.62, -0.04);
            figure::lock(s, [tie, tie + sweep + offset, low, tip], around(rng, 0.027, 0.004), 0.7, [7, 17]);
        }
        let at = Affine3A::from_rotation_translation(
            Quat::from_rotation_y(side * 0.7),
            tie + vec3(side * 0.02, 0.02, 0.03),
        );
        s.within(at, |s| bow(s, o.red, 0.075));
        s.with_material(o.hair);
    }
    figure::lock(
        s,
        [vec3(0.0, 1.08, 0.0) * r, vec3(0.02, 1.5, 0.1), vec3(0.06, 1.5, 0.4), vec3(0.14, 1.25, 0.75)]
            .map(|p| if p.y > 1.2 { p * vec3(1.0, r.y, r.z) } else { p }),
        0.012,
        0.5,
        [6, 10],
    );
}

/// Builds pleated cloth around the waist, from `top` (radii, height) to `hem`.
fn skirt(s: &mut SceneBuilder, [top, hem]: [Vec3; 2], pleats: f32, depth: f32, lean: Vec3) {
    s.surface(120, 10, true, |u, v| {
        let angle = if u == 1.0 { 0.0 } else { u * TAU };
        let fall = 1.0 - v;
        let wave = 1.0 + depth * fall * (pleats * angle).sin() + 0.05 * fall * (3.0 * angle + 0.7).sin();
        let flare = fall.powf(0.8);
        let rx = (top.x + (hem.x - top.x) * flare) * wave;
        let rz = (top.z + (hem.z - top.z) * flare) * wave;
        let y = top.y + (hem.y - top.y) * fall + 0.012 * fall * (2.0 * angle + 0.4).sin();
        (vec3(rx * angle.cos(), y, -rz * angle.sin()) + lean * fall, vec2(u * 6.0, v))
    });
}

fn singer(s: &mut SceneBuilder, p: &Palette, seed: u32, rng: &mut Pcg32) {
    let o = outfit(s, seed);
    let r = vec3(0.113, 0.132, 0.118);
    let j = Joints {
        head: vec3(0.012, 1.435, 0.02),
        head_turn: Quat::from_rotation_z(-0.1) * Quat::from_rotation_y(-0.12) * Quat::from_rotation_x(-0.03),
        neck: vec3(0.005, 1.285, -0.012),
        chest: vec3(0.0, 1.16, 0.0),
        waist: vec3(-0.012, 1.01, 0.004),
        pelvis: vec3(-0.02, 0.885, 0.0),
        shoulders: [vec3(0.128, 1.245, -0.008), vec3(-0.126, 1.23, -0.005)],
        elbows: [vec3(0.33, 1.36, 0.06), vec3(-0.255, 1.035, 0.07)],
        wrists: [vec3(0.41, 1.575, 0.1), vec3(-0.115, 1.19, 0.185)],
        hips: [vec3(0.06, 0.86, 0.0), vec3(-0.095, 0.86, 0.0)],
        knees: [vec3(0.11, 0.475, 0.05), vec3(-0.1, 0.475, 0.01)],
        ankles: [vec3(0.17, 0.1, 0.0), vec3(-0.1, 0.1, -0.05)],
    };
    let axis = j.waist.with_y(0.0);
    s.object("singer-body").with_material(o.white);
    let mut blouse = Clay::new(0.04);
    blouse
        .ball(j.chest, vec3(0.108, 0.13, 0.078))
        .ball(j.waist, vec3(0.082, 0.1, 0.066))
        .limb(j.shoulders[0] - Vec3::Y * 0.01, j.shoulders[1] - Vec3::Y * 0.01, 0.042, 0.042)
        .limb(j.neck - Vec3::Y * 0.03, j.neck, 0.045, 0.036);
    for side in [-1.0, 1.0] {
        blouse.ball(j.chest + vec3(side * 0.05, -0.012, 0.05), vec3(0.05, 0.05, 0.046));
    }
    for side in 0..2 {
        let down = (j.elbows[side] - j.shoulders[side]).normalize_or(Vec3::NEG_Y);
        blouse.ball(j.shoulders[side] + down * 0.035, vec3(0.062, 0.06, 0.06));
    }
    figure::clad(s, &blouse, 0.0145, axis, 4.0, 0.5);
    s.with_material(o.skin);
    for side in 0..2 {
        let mut arm = Clay::new(0.02);
        arm.limb(j.shoulders[side], j.elbows[side], 0.036, 0.029).limb(
            j.elbows[side],
            j.wrists[side],
            0.029,
            0.022,
        );
        figure::clad(s, &arm, 0.0105, j.shoulders[side], 2.0, 0.5);
        let mut thigh = Clay::new(0.03);
        thigh.limb(j.hips[side], j.knees[side], 0.079, 0.053);
        figure::clad(s, &thigh, 0.019, axis, 2.0, 0.5);
    }
    for side in 0..2 {
        // Cuffs that widen towards the hand, stockings, boots.
        let (from, to) = (j.elbows[side].lerp(j.wrists[side], 0.25), j.wrists[side]);
        let mut cuff = Clay::new(0.01);
        cuff.limb(from, to, 0.033, 0.046);
        s.with_material(o.white);
        figure::clad(s, &cuff, 0.0135, from, 2.0, 0.2);
        s.with_material(o.teal);
        let mut band = Clay::new(0.01);
        let back = (from - to).normalize_or(Vec3::Y);
        band.limb(to + back * 0.03, to + back * 0.02, 0.049, 0.05);
        figure::clad(s, &band, 0.012, from, 2.0, 0.2);
        s.with_material(o.stocking);
        let mut stocking = Clay::new(0.02);
        let upper = j.hips[side].lerp(j.knees[side], 0.5);
        stocking.limb(upper, j.knees[side], 0.0705, 0.057).limb(j.knees[side], j.ankles[side], 0.057, 0.04);
        figure::clad(s, &stocking, 0.0175, axis, 3.0, 0.5);
        s.with_material(o.teal);
        let mut garter = Clay::new(0.005);
        garter.limb(upper + Vec3::Y * 0.004, upper - Vec3::Y * 0.012, 0.0745, 0.073);
        figure::clad(s, &garter, 0.0145, axis, 3.0, 0.5);
        s.with_material(o.boot);
        let mut boot = Clay::new(0.03);
        let shin = j.knees[side].lerp(j.ankles[side], 0.3);
        let toe = vec3(if side == 0 { 0.3 } else { -0.12 }, 0.0, 1.0).normalize();
        let heel = j.ankles[side].with_y(0.06);
        boot.limb(shin, j.ankles[side], 0.061, 0.047)
            .limb(heel - toe * 0.02, heel + toe * 0.1 - Vec3::Y * 0.02, 0.045, 0.036)
            .ball(heel + toe * 0.12 - Vec3::Y * 0.022, vec3(0.041, 0.034, 0.045));
        figure::clad(s, &boot, 0.0165, axis, 3.0, 0.5);
        s.with_material(o.teal);
        let mut rim = Clay::new(0.01);
        rim.limb(shin + Vec3::Y * 0.004, shin - Vec3::Y * 0.018, 0.069, 0.066);
        figure::clad(s, &rim, 0.0145, axis, 3.0, 0.5);
        s.within(placed(heel.with_y(0.0), toe.x.atan2(toe.z)), |s| {
            s.with_material(o.teal).beveled_cuboid(
                vec3(-0.036, 0.0, -0.06),
                vec3(0.036, 0.05, -0.005),
                0.008,
            );
            s.beveled_cuboid(vec3(-0.04, 0.0, 0.04), vec3(0.04, 0.018, 0.165), 0.008);
            s.with_material(o.gold).beveled_cuboid(vec3(-0.02, 0.12, 0.05), vec3(0.02, 0.15, 0.062), 0.004);
        });
    }
    s.object("singer-skirt");
    let lean = vec3(-0.012, 0.0, 0.0);
    s.within(moved(j.waist.x, 0.0, j.waist.z), |s| {
        s.with_material(o.frill);
        skirt(s, [vec3(0.083, 0.985, 0.068), vec3(0.25, 0.685, 0.235)], 32.0, 0.05, lean);
        s.with_material(o.skirt);
        skirt(s, [vec3(0.087, 0.99, 0.072), vec3(0.265, 0.715, 0.25)], 20.0, 0.045, lean);
        s.with_material(o.red);
        s.lathe(&[(0.089, 0.975), (0.092, 0.98), (0.09, 1.015), (0.087, 1.02)], 40);
    });
    s.within(placed(j.waist + vec3(0.0, -0.01, -0.085), PI), |s| bow(s, o.red, 0.15));
    s.object("singer-collar").with_material(o.teal);
    // A sailor's collar: wide over the shoulders and the back.
    s.surface(48, 6, true, |u, v| {
        let angle = if u == 1.0 { 0.0 } else { u * TAU };
        let (x, z) = (angle.cos(), -angle.sin());
        let fall = 1.0 - v;
        let reach = 1.0 + 0.12 * (2.0 * angle).cos().powi(2);
        let front = z.max(0.0);
        let rx = 0.05 + (0.128 * reach - 0.05) * fall;
        let rz = 0.046 + (0.095 * reach - 0.046) * fall;
        let y = j.neck.y + 0.018 - 0.055 * fall.powf(1.3) - 0.03 * front * fall;
        (vec3(j.neck.x + rx * x, y + 0.012, j.neck.z + 0.006 + rz * z), vec2(u, v))
    });
    s.within(moved(j.chest.x, j.chest.y + 0.055, j.chest.z + 0.115), |s| bow(s, o.red, 0.075));
    s.object("singer-hands").with_material(o.skin);
    let hands = [
        Hand {
            wrist: j.wrists[0],
            along: vec3(0.25, 1.0, 0.05),
            palm: vec3(-0.1, 0.1, 1.0),
            curl: 0.12,
            thumb: 1.0,
            scale: 0.86,
        },
        Hand {
            wrist: j.wrists[1],
            along: vec3(0.85, 0.45, 0.25),
            palm: vec3(0.2, -0.15, -1.0),
            curl: 0.85,
            thumb: 1.0,
            scale: 0.86,
        },
    ];
    for hand in hands {
        figure::hand(s, &hand, 0.0058);
    }
    // The microphone in her right hand.
    s.object("singer-microphone").with_material(p.black);
    let grip = j.wrists[1] + vec3(0.05, 0.012, -0.012);
    let up = vec3(0.32, 0.82, -0.25).normalize();
    s.cylinder(grip - up * 0.08, grip + up * 0.09, 0.011, 0.016, 14, true);
    s.with_material(p.steel).ellipsoid(grip + up * 0.11, Vec3::splat(0.026), 12, 18);
    s.object("singer-head");
    s.within(figure::head_frame(&j), |s| {
        s.with_material(o.face);
        figure::head(s, r, 0.002, 0.0085);
        s.with_material(o.skin);
        figure::ears(s, r);
    });
    s.object("singer-hair");
    s.within(figure::head_frame(&j), |s| singer_hair(s, &o, r, rng));
}

/// Builds a square truss: four chords with thin diagonals on all sides.
fn truss(s: &mut SceneBuilder, a: Vec3, b: Vec3, size: f32) {
    let forward = (b - a).normalize_or(Vec3::X);
    let side = forward.any_orthonormal_vector();
    let other = forward.cross(side);
    let h = size * 0.5;
    let corners = [side + other, other - side, -side - other, side - other].map(|c| c * h);
    let cells = (a.distance(b) / (size * 1.25)).round().max(1.0) as usize;
    for c in corners {
        s.cylinder(a + c, b + c, 0.022, 0.022, 7, false);
    }
    for i in 0..cells {
        let at = |k: usize| a.lerp(b, k as f32 / cells as f32);
        for k in 0..4 {
            let (c, d) = (corners[k], corners[(k + 1) % 4]);
            let (from, to) = if (i + k) % 2 == 0 { (c, d) } else { (d, c) };
            s.cylinder(at(i) + from, at(i + 1) + to, 0.0095, 0.0095, 4, false);
            if i > 0 {
                s.cylinder(at(i) + c, at(i) + d, 0.0095, 0.0095, 4, false);
            }
        }
    }
}

/// Builds a spotlight that hangs at `at` and shines towards `target`.
fn spotlight(s: &mut SceneBuilder, p: &Palette, lens: usize, at: Vec3, target: Vec3) {
    s.with_material(p.black);
    s.cylinder(at + Vec3::Y * 0.28, at + Vec3::Y * 0.1, 0.012, 0.012, 6, false);
    let turn = Quat::from_rotation_arc(Vec3::NEG_Y, (target - at).normalize_or(Vec3::NEG_Y));
    s.within(Affine3A::from_rotation_translation(turn, at), |s| {
        s.lathe(&[(0.115, -0.2), (0.12, -0.19), (0.1, 0.0), (0.07, 0.1), (0.03, 0.13), (0.0, 0.13)], 14);
        s.tube(
            &[vec3(-0.13, -0.05, 0.0), vec3(-0.13, 0.12, 0.0), vec3(0.13, 0.12, 0.0), vec3(0.13, -0.05, 0.0)],
            0.008,
            5,
            true,
        );
        s.with_material(lens).lathe(&[(0.0, -0.185), (0.11, -0.19)], 14);
    });
}

fn speaker_stack(s: &mut SceneBuilder, p: &Palette, top: Vec3, count: usize) {
    s.with_material(p.dark);
    for x in [-0.4, 0.4] {
        s.cylinder(top + vec3(x, 0.0, 0.0), top + vec3(x, 1.0, 0.0), 0.008, 0.008, 5, false);
    }
    for i in 0..count {
        let tilt = 0.035 * (i * i) as f32 * 0.6;
        let at = top - vec3(0.0, 0.36 * (i + 1) as f32, 0.012 * (i * i) as f32);
        s.within(Affine3A::from_rotation_translation(Quat::from_rotation_x(tilt), at), |s| {
            s.with_material(p.black).beveled_cuboid(vec3(-0.55, 0.0, -0.35), vec3(0.55, 0.335, 0.25), 0.015);
            s.with_material(p.grille).rectangle(vec3(-0.52, 0.02, 0.253), Vec3::X * 1.04, Vec3::Y * 0.295);
        });
    }
}

fn drums(s: &mut SceneBuilder, p: &Palette, shell: usize, skin: usize) {
    let drum = |s: &mut SceneBuilder, at: Vec3, radius: f32, height: f32, tilt: f32| {
        s.within(Affine3A::from_rotation_translation(Quat::from_rotation_x(tilt), at), |s| {
            s.with_material(shell).lathe(&[(radius, 0.0), (radius, height)], 24);
            s.with_material(p.steel);
            for y in [0.0, height - 0.02] {
                s.lathe(
                    &[(radius, y), (radius + 0.01, y), (radius + 0.01, y + 0.02), (radius, y + 0.02)],
                    24,
                );
            }
            s.with_material(skin).lathe(&[(radius, height - 0.004), (0.0, height - 0.004)], 24);
            s.lathe(&[(0.0, 0.004), (radius, 0.004)], 24);
        });
    };
    drum(s, vec3(0.0, 0.3, 0.2), 0.28, 0.42, FRAC_PI_2);
    drum(s, vec3(-0.24, 0.72, 0.25), 0.15, 0.2, 0.35);
    drum(s, vec3(0.16, 0.72, 0.25), 0.16, 0.22, 0.35);
    drum(s, vec3(0.62, 0.2, -0.1), 0.22, 0.4, 0.0);
    drum(s, vec3(-0.55, 0.5, -0.1), 0.18, 0.14, 0.1);
    for (x, y, z, tilt) in
        [(-0.8, 1.15, 0.3, 0.3), (0.75, 1.25, 0.35, 0.3), (-0.9, 0.9, -0.25, 0.05), (0.25, 1.3, 0.5, 0.25)]
    {
        s.with_material(p.steel).cylinder(vec3(x, 0.0, z), vec3(x, y, z), 0.009, 0.009, 6, false);
        for k in 0..3 {
            let turn = k as f32 / 3.0 * TAU;
            s.cylinder(
                vec3(x, 0.25, z),
                vec3(x + 0.22 * turn.cos(), 0.0, z + 0.22 * turn.sin()),
                0.007,
                0.007,
                5,
                false,
            );
        }
        s.within(Affine3A::from_rotation_translation(Quat::from_rotation_x(tilt), vec3(x, y, z)), |s| {
            s.with_material(p.gold).lathe(&[(0.22, 0.0), (0.05, 0.02), (0.03, 0.045), (0.0, 0.05)], 26);
            s.lathe(&[(0.0, 0.048), (0.03, 0.043), (0.05, 0.018), (0.22, -0.002)], 26);
        });
    }
}

fn stage(s: &mut SceneBuilder, p: &Palette, seed: u32) -> Vec<PointLight> {
    let deck = props::textured(s, paint::planks("deck", 512, seed + 1, vec3(0.34, 0.3, 0.36), 6), 1.5, 0.25);
    let skirting = props::textured(
        s,
        paint::metal_panels("skirting", 512, seed + 2, vec3(0.45, 0.45, 0.52), [4, 2]),
        2.0,
        0.4,
    );
    s.object("deck").with_material(deck);
    s.rectangle(vec3(-8.0, STAGE, 1.5), Vec3::X * 16.0, Vec3::NEG_Z * 8.0);
    s.rectangle(vec3(-1.3, STAGE, 10.0), Vec3::X * 2.6, Vec3::NEG_Z * 8.5);
    s.object("skirting").with_material(skirting);
    for (a, right) in [
        (vec3(-8.0, 0.0, 1.5), Vec3::X * 6.7),
        (vec3(1.3, 0.0, 1.5), Vec3::X * 6.7),
        (vec3(-1.3, 0.0, 10.0), Vec3::X * 2.6),
        (vec3(1.3, 0.0, 10.0), Vec3::NEG_Z * 8.5),
        (vec3(-1.3, 0.0, 1.5), Vec3::Z * 8.5),
        (vec3(8.0, 0.0, 1.5), Vec3::NEG_Z * 8.0),
        (vec3(-8.0, 0.0, -6.5), Vec3::Z * 8.0),
    ] {
        s.rectangle(a, right, Vec3::Y * STAGE);
    }
    s.object("edge-lights");
    for (i, (a, b)) in [
        (vec3(-8.0, 0.0, 1.5), vec3(-1.3, 0.0, 1.5)),
        (vec3(1.3, 0.0, 1.5), vec3(8.0, 0.0, 1.5)),
        (vec3(-1.3, 0.0, 1.5), vec3(-1.3, 0.0, 10.0)),
        (vec3(1.3, 0.0, 1.5), vec3(1.3, 0.0, 10.0)),
    ]
    .into_iter()
    .enumerate()
    {
        let up = Vec3::Y * (STAGE - 0.02);
        s.with_material(p.strip[i % 2]).cylinder(a + up, b + up, 0.03, 0.03, 6, false);
    }
    // A riser for the drums, with steps beside it.
    s.object("riser").with_material(skirting).cuboid(vec3(-2.4, STAGE, -5.6), vec3(2.4, STAGE + 0.6, -3.4));
    s.with_material(p.strip[0]).cuboid(vec3(-2.4, STAGE + 0.5, -3.4), vec3(2.4, STAGE + 0.54, -3.37));
    s.with_material(p.dark);
    for x in [-3.0, 3.0] {
        s.within(moved(x, STAGE, -3.6), |s| s.stairs(1.1, 0.2, 0.28, 3));
    }
    let shell = props::plain(s, "drum-shell", vec3(0.6, 0.12, 0.25), 0.25);
    let skin = props::plain(s, "drum-skin", vec3(0.9, 0.89, 0.85), 0.6);
    s.object("drums");
    s.within(moved(0.0, STAGE + 0.6, -4.6), |s| drums(s, p, shell, skin));
    // Keyboard and amplifiers.
    s.object("keyboard");
    s.within(placed(vec3(-3.6, STAGE, -1.6), 0.5), |s| {
        s.with_material(p.dark);
        for (a, b) in [(-0.5, 0.5), (0.5, -0.5)] {
            s.cylinder(vec3(a, 0.0, -0.15), vec3(b, 0.86, 0.12), 0.016, 0.016, 8, true);
        }
        s.with_material(p.black).beveled_cuboid(vec3(-0.68, 0.86, -0.17), vec3(0.68, 0.95, 0.17), 0.012);
        s.with_material(skin).cuboid(vec3(-0.6, 0.95, -0.15), vec3(0.6, 0.956, -0.01));
        s.with_material(p.black);
        for i in 0..36 {
            if ![2, 6].contains(&(i % 7)) {
                let x = -0.58 + i as f32 * 0.0325;
                s.cuboid(vec3(x, 0.956, -0.1), vec3(x + 0.014, 0.966, -0.01));
            }
        }
    });
    s.object("amplifiers");
    for (x, z) in [(3.4, -2.6), (4.6, -2.6), (4.0, -2.7)] {
        let y = if x == 4.0 { STAGE + 0.95 } else { STAGE };
        s.with_material(p.black).beveled_cuboid(
            vec3(x - 0.5, y, z - 0.3),
            vec3(x + 0.5, y + 0.93, z + 0.3),
            0.02,
        );
        s.with_material(p.grille).rectangle(
            vec3(x - 0.46, y + 0.05, z + 0.303),
            Vec3::X * 0.92,
            Vec3::Y * 0.68,
        );
        s.with_material(p.gold);
        for k in 0..6 {
            let knob = vec3(x - 0.35 + 0.14 * k as f32, y + 0.82, z + 0.3);
            s.cylinder(knob, knob + Vec3::Z * 0.02, 0.016, 0.014, 8, true);
        }
    }
    // Floor monitors and the microphone stand.
    for (i, (x, yaw)) in [(-2.4, 2.9), (2.4, 3.4), (-5.2, 2.7), (5.2, 3.6)].into_iter().enumerate() {
        s.object(&format!("monitor-{i}"));
        s.within(placed(vec3(x, STAGE, 1.0), yaw), |s| {
            let profile =
                [vec2(-0.28, 0.0), vec2(0.25, 0.0), vec2(0.28, 0.08), vec2(0.02, 0.4), vec2(-0.2, 0.4)];
            s.within(placed(Vec3::ZERO, -FRAC_PI_2), |s| {
                s.with_material(p.black).extrude(&profile, -0.35, 0.35, true);
                s.with_material(p.grille);
                let (a, b) = (vec2(0.283, 0.085), vec2(0.026, 0.402));
                s.quad([a.extend(0.32), a.extend(-0.32), b.extend(-0.32), b.extend(0.32)]);
            });
        });
    }
    s.object("microphone-stand").with_material(p.dark);
    let foot = vec3(-0.8, STAGE, 0.62);
    s.cylinder(foot, foot + Vec3::Y * 1.25, 0.0105, 0.0095, 8, true);
    for k in 0..3 {
        let turn = k as f32 / 3.0 * TAU + 0.4;
        s.cylinder(
            foot + Vec3::Y * 0.2,
            foot + vec3(0.3 * turn.cos(), 0.005, 0.3 * turn.sin()),
            0.008,
            0.008,
            6,
            true,
        );
    }
    let boom = foot + Vec3::Y * 1.25;
    s.cylinder(boom - vec3(0.16, 0.08, 0.0), boom + vec3(0.4, 0.18, -0.1), 0.007, 0.007, 6, true);
    s.with_material(p.black).cylinder(
        boom + vec3(0.36, 0.16, -0.09),
        boom + vec3(0.48, 0.22, -0.12),
        0.012,
        0.017,
        10,
        true,
    );
    s.with_material(p.steel).ellipsoid(boom + vec3(0.5, 0.23, -0.125), Vec3::splat(0.027), 8, 12);
    s.object("cables").with_material(p.black);
    for (a, b, bend) in [
        (vec3(-0.8, 0.0, 0.6), vec3(-2.3, 0.0, 0.9), 0.5),
        (vec3(-3.4, 0.0, -1.5), vec3(-2.5, 0.0, -3.3), 0.4),
        (vec3(3.3, 0.0, -2.2), vec3(2.3, 0.0, 0.8), -0.6),
    ] {
        let path: Vec<Vec3> = (0..=20)
            .map(|i| {
                let t = i as f32 / 20.0;
                a.lerp(b, t) + vec3((t * 7.0).sin() * 0.16, STAGE + 0.009, (t * PI).sin() * bend)
            })
            .collect();
        s.tube(&path, 0.008, 6, true);
    }
    // The roof: four towers, beams front and back, spotlights below.
    s.object("trusses").with_material(p.steel);
    let roof = 6.6;
    for (x, z) in [(-7.6, 1.0), (7.6, 1.0), (-7.6, -6.0), (7.6, -6.0)] {
        truss(s, vec3(x, 0.0, z), vec3(x, roof, z), 0.4);
    }
    for (a, b) in [
        (vec3(-7.6, roof, 1.0), vec3(7.6, roof, 1.0)),
        (vec3(-7.6, roof, -2.6), vec3(7.6, roof, -2.6)),
        (vec3(-7.6, roof, 1.0), vec3(-7.6, roof, -6.0)),
        (vec3(7.6, roof, 1.0), vec3(7.6, roof, -6.0)),
    ] {
        truss(s, a, b, 0.4);
    }
    let mut lights = Vec::new();
    s.object("spotlights");
    for (row, z) in [1.0, -2.6].into_iter().enumerate() {
        for i in 0..8 {
            let x = -6.3 + 1.8 * i as f32;
            let lens = p.lens[(i + row) % 3];
            let at = vec3(x, roof - 0.5, z);
            let target = vec3(x * 0.35, STAGE, if row == 0 { -0.4 } else { -3.0 });
            spotlight(s, p, lens, at, target);
            if i % 2 == row {
                let color =
                    [vec3(1.0, 0.85, 0.6), vec3(1.0, 0.3, 0.65), vec3(0.25, 0.75, 1.0)][(i + row) % 3];
                lights.push(PointLight { position: at.lerp(target, 0.35), color: color * 7.0, range: 8.0 });
            }
        }
    }
    s.object("beams");
    for (i, x) in [-5.4, -2.7, 2.7, 5.4].into_iter().enumerate() {
        let (a, b) = (vec3(x, roof - 0.7, -2.6), vec3(x * 0.5, STAGE + 0.01, -1.8));
        s.with_material(p.cone[i % 2]).cylinder(a, b, 0.1, 0.8, 24, false);
    }
    s.object("speakers");
    for x in [-6.9, 6.9] {
        speaker_stack(s, p, vec3(x, 5.4, 1.6), 8);
    }
    s.object("stage-rails").with_material(p.dark);
    let rail = Railing { bar_spacing: 0.16, ..Railing::default() };
    for x in [-7.9, 7.9] {
        s.railing(&[vec3(x, STAGE, 0.6), vec3(x, STAGE, -2.5), vec3(x, STAGE, -5.6)], &rail);
    }
    s.railing(&[vec3(-7.9, STAGE, -6.4), vec3(-4.6, STAGE, -6.4)], &rail);
    s.railing(&[vec3(4.6, STAGE, -6.4), vec3(7.9, STAGE, -6.4)], &rail);
    lights
}

fn screens(s: &mut SceneBuilder, p: &Palette, seed: u32) {
    let wall = paint::picture("screen-wall", [1024, 512], |uv| {
        let q = (uv - vec2(0.5, 0.45)) * vec2(2.0, 1.0);
        let distance = q.length();
        let angle = q.y.atan2(q.x);
        let rays = 0.5 + 0.5 * (angle * 14.0 + distance * 3.0).sin();
        let rings = paint::smoothstep(0.75, 0.95, (distance * 9.0).fract());
        let night = vec3(0.1, 0.05, 0.25).lerp(vec3(0.75, 0.2, 0.55), paint::smoothstep(0.9, 0.0, distance));
        let star = paint::worley(seed, glam::UVec2::new(24, 12), 1.0, uv);
        let spark = paint::smoothstep(0.12, 0.04, star.nearest) * (paint::unit(star.id) > 0.6) as u32 as f32;
        let pixel = (uv * vec2(256.0, 128.0)).fract() - 0.5;
        let grid = 0.75 + 0.25 * paint::smoothstep(0.5, 0.38, pixel.abs().max_element());
        let color = night * (0.55 + 0.6 * rays) + vec3(0.2, 0.6, 0.8) * rings * 0.6 + Vec3::splat(spark);
        (color * grid).extend(1.0)
    });
    let title =
        paint::sign("screen-title", [512, 128], "YORO LIVE", vec3(0.3, 1.0, 0.95), vec3(0.06, 0.02, 0.14));
    let bars = paint::picture("screen-bars", [256, 512], |uv| {
        let column = (uv.x * 8.0).floor();
        let level = 0.25 + 0.65 * paint::unit(paint::hash_cell(seed, column as u32, 4));
        let gap = (uv.x * 8.0).fract() < 0.12 || (uv.y * 28.0).fract() < 0.2;
        let tone = vec3(0.2, 0.9, 1.0).lerp(vec3(1.0, 0.25, 0.6), uv.y);
        (if uv.y < level && !gap { tone } else { vec3(0.03, 0.02, 0.07) }).extend(1.0)
    });
    let [wall, title, bars] = [wall, title, bars].map(|image| props::pictured(s, image, 0.4, 1.3));
    let screen = |s: &mut SceneBuilder, material: usize, base: Vec3, size: Vec2, yaw: f32| {
        s.within(placed(base, yaw), |s| {
            let w = size.x * 0.5;
            s.with_material(p.black).cuboid_faces(
                vec3(-w - 0.08, -0.08, -0.25),
                vec3(w + 0.08, size.y + 0.08, -0.02),
                BoxFaces::ALL,
            );
            s.with_material(material);
            s.picture([vec3(-w, 0.0, 0.0), vec3(w, 0.0, 0.0), vec3(w, size.y, 0.0), vec3(-w, size.y, 0.0)]);
        });
    };
    s.object("screen-wall");
    screen(s, wall, vec3(0.0, STAGE + 0.8, -6.1), vec2(8.0, 4.0), 0.0);
    s.object("screen-title");
    screen(s, title, vec3(0.0, 6.95, 0.9), vec2(4.4, 1.1), 0.0);
    for (i, x) in [-5.8, 5.8].into_iter().enumerate() {
        s.object(&format!("screen-side-{i}"));
        screen(s, bars, vec3(x, STAGE + 0.7, -5.6), vec2(2.2, 4.2), -x.signum() * 0.3);
    }
}

fn crowd(s: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    let mut index = 0;
    for row in 0..12 {
        for seat in 0..17 {
            let (x, z) = (
                -10.4 + 1.3 * seat as f32 + around(rng, 0.0, 0.28),
                2.9 + 1.05 * row as f32 + around(rng, 0.0, 0.2),
            );
            let free = x.abs() < if z < 10.6 { 1.85 } else { 0.0 };
            if free || rng.random::<f32>() < 0.3 {
                continue;
            }
            index += 1;
            s.object(&format!("crowd-{}-{}", row / 3, (seat + 1) / 6));
            let tall = around(rng, 1.62, 0.12);
            let yaw = around(rng, PI, 0.25);
            let material = p.crowd[index % 3];
            s.within(placed(vec3(x, 0.0, z), yaw), |s| {
                s.with_material(material);
                let shoulder = tall - 0.3;
                s.within(Affine3A::from_scale(vec3(1.0, 1.0, 0.62)), |s| {
                    s.lathe(
                        &[
                            (0.15, 0.0),
                            (0.17, 0.85),
                            (0.15, 1.05),
                            (0.21, shoulder - 0.08),
                            (0.17, shoulder),
                            (0.06, shoulder + 0.05),
                        ],
                        8,
                    );
                });
                let skin = p.crowd_skin[index * 7 / 3 % 2];
                s.with_material(skin).ellipsoid(Vec3::Y * (tall - 0.11), vec3(0.084, 0.115, 0.095), 6, 8);
                s.with_material(p.crowd_hair[index % 2]);
                s.ellipsoid(vec3(0.0, tall - 0.075, -0.025), vec3(0.094, 0.1, 0.1), 5, 8);
                s.with_material(skin);
                let waving = rng.random::<f32>() < 0.7;
                for side in [-1.0, 1.0] {
                    let root = vec3(side * 0.19, shoulder - 0.05, 0.0);
                    if waving && side > 0.0 {
                        let hand = root + vec3(around(rng, 0.08, 0.12), 0.42, 0.18);
                        s.tube(&[root, root + vec3(side * 0.1, 0.12, 0.16), hand], 0.04, 5, false);
                        let tip = hand + vec3(around(rng, 0.0, 0.12), 0.3, around(rng, 0.03, 0.06));
                        s.with_material(p.black).cylinder(
                            hand - (tip - hand) * 0.3,
                            hand,
                            0.016,
                            0.016,
                            6,
                            true,
                        );
                        s.with_material(p.sticks[rng.random_range(0..4)])
                            .cylinder(hand, tip, 0.017, 0.014, 6, true);
                        s.with_material(skin);
                    } else {
                        s.tube(
                            &[
                                root,
                                root + vec3(side * 0.06, -0.28, 0.04),
                                root + vec3(side * 0.02, -0.5, 0.16),
                            ],
                            0.042,
                            5,
                            false,
                        );
                    }
                }
            });
        }
    }
    // Barriers between the crowd and the stage.
    s.object("barriers").with_material(p.steel);
    let rail = Railing { height: 1.1, bar_spacing: 0.2, ..Railing::default() };
    for side in [-1.0, 1.0] {
        let path: Vec<Vec3> = (0..=4).map(|i| vec3(side * (1.9 + 2.4 * i as f32), 0.0, 2.35)).collect();
        s.railing(&path, &rail);
        let path: Vec<Vec3> = (0..=4).map(|i| vec3(side * 1.72, 0.0, 2.35 + 2.0 * i as f32)).collect();
        s.railing(&path, &rail);
    }
}

fn town(s: &mut SceneBuilder, p: &Palette, seed: u32, rng: &mut Pcg32) {
    let ground = props::textured(s, paint::asphalt("ground", 512, seed + 5, Vec3::splat(0.34)), 4.0, 0.9);
    s.object("ground").with_material(ground);
    s.rectangle(vec3(-300.0, 0.0, 300.0), Vec3::X * 600.0, Vec3::NEG_Z * 600.0);
    let facades =
        [(vec3(0.3, 0.28, 0.36), 0.45), (vec3(0.22, 0.26, 0.34), 0.3), (vec3(0.36, 0.28, 0.3), 0.55)];
    let towers: Vec<usize> = facades
        .into_iter()
        .enumerate()
        .map(|(i, (wall, lit))| {
            let f = paint::facade(
                &format!("tower-{i}"),
                512,
                seed + 30 + i as u32,
                wall,
                vec3(0.12, 0.15, 0.24),
                [8, 8],
                lit,
            );
            let name = f.color.name.clone();
            let [color, emissive, normal] = [f.color, f.emissive, f.normal].map(|image| s.texture(image));
            s.material(
                Material {
                    name,
                    diffuse: Vec3::ONE,
                    emissive: Vec3::splat(1.1),
                    roughness: 0.6,
                    diffuse_map: Some(color),
                    emissive_map: Some(emissive),
                    normal_map: Some(normal),
                    ..Material::default()
                },
                26.0,
            )
        })
        .collect();
    for i in 0..64 {
        let turn = i as f32 / 64.0 * TAU;
        let distance = 48.0 + 90.0 * rng.random::<f32>();
        let size =
            vec3(around(rng, 11.0, 4.0), around(rng, 20.0, 12.0) + distance * 0.14, around(rng, 11.0, 4.0));
        s.object(&format!("tower-{i}")).with_material(towers[i % 3]);
        s.set_uv_offset(vec2(rng.random_range(0..8) as f32, rng.random_range(0..8) as f32) * 3.25);
        let base = vec3(distance * turn.cos(), 0.0, distance * turn.sin());
        s.within(placed(base, around(rng, 0.0, 0.7)), |s| {
            s.cuboid_faces(
                vec3(-size.x, 0.0, -size.z) * 0.5,
                vec3(size.x * 0.5, size.y, size.z * 0.5),
                BoxFaces::STANDING,
            );
            s.set_uv_offset(Vec2::ZERO);
            s.with_material(p.dark).cylinder(
                Vec3::Y * size.y,
                Vec3::Y * (size.y + 5.0),
                0.12,
                0.04,
                5,
                false,
            );
            s.with_material(p.strip[0]).ellipsoid(Vec3::Y * (size.y + 5.0), Vec3::splat(0.25), 6, 8);
        });
    }
    // A big wheel behind the stage.
    s.object("big-wheel");
    let hub = vec3(-26.0, 17.0, -44.0);
    s.within(placed(hub, 0.4), |s| {
        let rim = |angle: f32, r: f32, z: f32| vec3(r * angle.cos(), r * angle.sin(), z);
        for z in [-0.7, 0.7] {
            let ring: Vec<Vec3> = (0..=48).map(|i| rim(i as f32 / 48.0 * TAU, 14.0, z)).collect();
            s.with_material(p.steel).tube(&ring, 0.09, 5, false);
        }
        for i in 0..24 {
            let angle = i as f32 / 24.0 * TAU;
            for z in [-0.7, 0.7] {
                s.with_material(p.steel).cylinder(
                    Vec3::Z * z * 1.6,
                    rim(angle, 14.0, z),
                    0.035,
                    0.035,
                    4,
                    false,
                );
            }
            s.with_material(p.strip[i % 2]).cylinder(
                rim(angle, 5.0, 0.75),
                rim(angle, 13.6, 0.75),
                0.06,
                0.06,
                4,
                false,
            );
            s.with_material(p.crowd[i % 3]).ellipsoid(
                rim(angle, 14.0, 0.0) - Vec3::Y * 1.1,
                vec3(0.9, 1.0, 0.9),
                6,
                8,
            );
        }
        s.with_material(p.dark);
        for x in [-7.0, 7.0] {
            for z in [-1.6, 1.6] {
                s.cylinder(vec3(x, -17.0, z), vec3(0.0, 0.0, z), 0.25, 0.2, 6, false);
            }
        }
        s.cylinder(vec3(0.0, 0.0, -1.8), vec3(0.0, 0.0, 1.8), 0.5, 0.5, 12, true);
    });
}

/// Builds paper in the air, away from the walk.
fn confetti(s: &mut SceneBuilder, walk: &[Vec3], rng: &mut Pcg32) {
    let colors = [PINK, TEAL, vec3(0.98, 0.85, 0.35), vec3(0.92, 0.92, 0.97)];
    let materials: Vec<usize> =
        colors.iter().enumerate().map(|(i, &c)| two_sided(s, &format!("confetti-{i}"), c)).collect();
    s.object("confetti");
    for i in 0..420 {
        let p = vec3(around(rng, 0.0, 7.0), around(rng, 3.6, 2.5), around(rng, 2.5, 7.0));
        if walk.iter().any(|w| w.distance(p) < 0.65) {
            continue;
        }
        let normal = props::random_direction(rng);
        let right = normal.any_orthonormal_vector();
        let (right, up) = (right * 0.026, normal.cross(right) * 0.016);
        s.with_material(materials[i % 4]);
        s.card(p, right, up, normal);
    }
}

/// Makes the singer dance, the crowd hop and the spotlights sweep.
fn dance(first_spot: usize, lights: &[PointLight]) -> Movers {
    let mut movers = Movers::default();
    let feet = vec3(0.03, STAGE, -0.02);
    let body = movers.turn(None, feet, 4.0, |t| {
        about(Vec3::Z, 0.05 * (2.0 * TAU * t).sin()) * about(Vec3::Y, 0.25 * (TAU * t).sin())
    });
    let parts = ["body", "skirt", "collar", "hands", "microphone"].map(|part| format!("singer-{part}"));
    movers.carry(body, &parts.each_ref().map(String::as_str));
    let head = movers.turn(Some(body), feet + vec3(-0.025, 1.285, 0.008), 2.0, |t| {
        about(Vec3::Z, -0.12 * (TAU * t).sin()) * about(Vec3::X, 0.06 * (1.0 - (2.0 * TAU * t).cos()))
    });
    movers.carry(head, &["singer-head", "singer-hair"]);
    for (row, seconds) in [0.5, 0.6, 0.7, 0.8].into_iter().enumerate() {
        let hop = movers.shift(seconds, |t| Vec3::Y * (0.035 * (1.0 - (TAU * t).cos())));
        let blocks: Vec<String> = (0..3).map(|block| format!("crowd-{row}-{block}")).collect();
        movers.carry(hop, &blocks.iter().map(String::as_str).collect::<Vec<_>>());
    }
    for light in first_spot..lights.len() {
        let way = if light % 2 == 0 { 1.2 } else { -1.2 };
        let sweep = movers.shift(4.0, move |t| vec3(way * (TAU * t).sin(), 0.0, 0.4 * (2.0 * TAU * t).sin()));
        movers.carry_light(sweep, light, lights);
    }
    movers
}

/// Generates the scene; see [`super::BUILTINS`].
pub fn build(seed: u64, mut s: SceneBuilder) -> Scene {
    let mut rng = random(seed, "stage");
    let noise = rng.random::<u32>() >> 8;
    let p = palette(&mut s);
    let mut lights = vec![
        PointLight { position: vec3(0.9, STAGE + 2.4, 1.8), color: vec3(2.6, 2.3, 2.2), range: 7.0 },
        PointLight { position: vec3(0.0, STAGE + 2.6, -4.6), color: vec3(3.0, 0.9, 2.2), range: 8.0 },
        PointLight { position: vec3(-5.4, STAGE + 2.4, -4.4), color: vec3(0.5, 1.8, 2.4), range: 6.0 },
        PointLight { position: vec3(5.4, STAGE + 2.4, -4.4), color: vec3(0.5, 1.8, 2.4), range: 6.0 },
    ];
    for (i, z) in [3.0, 6.0, 9.0].into_iter().enumerate() {
        for x in [-2.6, 2.6] {
            let color = [vec3(3.4, 1.0, 2.2), vec3(1.0, 2.6, 3.4)][(i + (x > 0.0) as usize) % 2];
            lights.push(PointLight { position: vec3(x, 2.3, z), color, range: 7.0 });
        }
    }
    s.within(moved(0.0, STAGE, 0.0), |s| singer(s, &p, noise, &mut rng));
    let first_spot = lights.len();
    lights.extend(stage(&mut s, &p, noise));
    screens(&mut s, &p, noise);
    crowd(&mut s, &p, &mut rng);
    town(&mut s, &p, noise, &mut rng);
    let walk: Vec<Vec3> = [
        (0.75, 8.6),
        (0.72, 7.5),
        (0.62, 6.4),
        (0.46, 5.4),
        (0.24, 4.5),
        (0.0, 3.7),
        (-0.25, 3.0),
        (-0.5, 2.45),
        (-0.8, 2.0),
        (-1.15, 1.65),
        (-1.5, 1.25),
        (-1.7, 0.75),
        (-1.75, 0.2),
    ]
    .iter()
    .map(|&(x, z)| vec3(x, STAGE + 1.5, z))
    .collect();
    confetti(&mut s, &walk, &mut rng);
    let mut model = s.finish();
    Scene {
        motion: dance(first_spot, &lights).finish(&mut model),
        model,
        sky: Sky {
            sun_direction: vec3(0.4, 0.7, 0.6).normalize(),
            sun_color: vec3(1.9, 1.75, 1.9),
            zenith: vec3(0.1, 0.11, 0.3),
            horizon: vec3(0.42, 0.2, 0.36),
            ground: vec3(0.24, 0.17, 0.26),
        },
        lights,
        viewpoints: walk
            .iter()
            .map(|&position| {
                let near = 1.0 - ((position.z - 2.0) / 6.0).clamp(0.0, 1.0);
                Viewpoint { position, target: vec3(0.0, STAGE + 1.5 - 0.25 * near, 0.0) }
            })
            .collect(),
        ..Scene::default()
    }
}
