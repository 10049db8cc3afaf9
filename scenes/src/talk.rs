//! Two stylised figures that talk across a small table in a room with a view. In place of the paper's Chat.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Affine3A, Quat, Vec3, vec2, vec3};
use rand::Rng;
use rand_pcg::Pcg32;

use super::build::{BoxFaces, SceneBuilder, around, moved, placed, random};
use super::figure::{self, Hand, Joints};
use super::motion::{Movers, about};
use super::paint::{self, Face};
use super::props::{self, palette};
use super::sculpt::Clay;
use yoro_assets::{Material, PointLight, Scene, Sky, Viewpoint};

/// One figure's materials and the shape of its head.
struct Look {
    face: usize,
    skin: usize,
    hair: usize,
    top: usize,
    trousers: usize,
    shoe: usize,
    radii: Vec3,
    nose: f32,
}

fn cloth(s: &mut SceneBuilder, name: &str, color: impl Fn(glam::Vec2) -> Vec3 + Sync) -> usize {
    let map = s.texture(paint::picture(name, [256, 256], |uv| color(uv).extend(1.0)));
    s.material(
        Material {
            name: name.into(),
            diffuse: Vec3::ONE,
            specular: Vec3::splat(0.05),
            roughness: 0.9,
            diffuse_map: Some(map),
            ..Material::default()
        },
        1.0,
    )
}

fn knit(seed: u32, uv: glam::Vec2) -> f32 {
    let p = uv * vec2(32.0, 48.0);
    let across = (p.x.fract() - 0.5).abs();
    let stitch = ((p.y + across * 1.2).fract() - 0.5).abs();
    0.86 + 0.2 * stitch + 0.12 * (paint::fbm(seed, glam::UVec2::splat(6), 3, uv) - 0.5)
}

palette! {
    fn palette(s: &mut SceneBuilder, seed: u32) -> Palette {
        let oak = paint::planks("oak", 512, seed + 1, vec3(0.72, 0.53, 0.34), 4);
        let walnut = paint::planks("walnut", 512, seed + 2, vec3(0.42, 0.28, 0.18), 3);
        let linen = paint::damask("linen", 512, seed + 3, vec3(0.85, 0.8, 0.68), vec3(0.74, 0.62, 0.46), 3);
        let wool = paint::fabric("wool", 256, seed + 4, vec3(0.3, 0.46, 0.5), 24);
        let curtain = props::textured(s, linen, 0.6, 0.9);
    }
    wood = props::textured(s, oak, 0.8, 0.5),
    dark_wood = props::textured(s, walnut, 0.7, 0.45),
    white = props::plain(s, "white-paint", vec3(0.92, 0.9, 0.86), 0.5),
    china = props::plain(s, "china", vec3(0.93, 0.93, 0.9), 0.2),
    coffee = props::plain(s, "coffee", vec3(0.2, 0.11, 0.06), 0.2),
    brass = props::metal(s, "brass", vec3(0.85, 0.66, 0.3), 0.3),
    shade = props::glowing(s, "lamp-shade", vec3(1.0, 0.82, 0.55), 1.1),
    pot = props::plain(s, "terracotta", vec3(0.72, 0.4, 0.27), 0.8),
    leaf = s.material(
        Material {
            name: "broad-leaf".into(),
            diffuse: vec3(0.22, 0.48, 0.2),
            specular: Vec3::splat(0.15),
            roughness: 0.5,
            double_sided: true,
            ..Material::default()
        },
        1.0,
    ),
    card = props::foliage(s, "twigs", u64::from(seed), vec3(0.36, 0.56, 0.22)),
    paper = props::plain(s, "paper", vec3(0.93, 0.9, 0.82), 0.9),
    curtain = curtain,
    glass = props::glass(s, "window-glass", vec3(0.75, 0.85, 0.9), 0.12),
    cushion = props::textured(s, wool, 0.3, 0.95),
    iron = props::metal(s, "iron", Vec3::splat(0.25), 0.5),
}

fn looks(s: &mut SceneBuilder, seed: u32) -> [Look; 2] {
    let paint_face = |s: &mut SceneBuilder, name: &str, face: &Face| {
        let image = paint::face(name, 1024, face);
        props::pictured(s, image, 0.55, 0.0)
    };
    let base = Face {
        skin: vec3(0.93, 0.72, 0.58),
        iris: vec3(0.25, 0.5, 0.35),
        brow: vec3(0.3, 0.14, 0.08),
        lips: vec3(0.8, 0.36, 0.34),
        eye: vec2(0.345, 0.5),
        eye_radii: vec2(0.085, 0.1),
        mouth_y: 0.235,
        mouth_width: 0.11,
        mouth_open: 0.55,
        blush: 0.8,
    };
    let other = Face {
        skin: vec3(0.62, 0.42, 0.3),
        iris: vec3(0.42, 0.26, 0.14),
        brow: vec3(0.1, 0.07, 0.06),
        lips: vec3(0.62, 0.32, 0.27),
        eye: vec2(0.35, 0.51),
        eye_radii: vec2(0.078, 0.088),
        mouth_open: 0.0,
        blush: 0.35,
        mouth_width: 0.125,
        ..base
    };
    let stripes = move |uv: glam::Vec2| {
        let band = ((uv.y * 4.0).fract() < 0.5) as u32 as f32;
        vec3(0.78, 0.26, 0.22).lerp(vec3(0.93, 0.87, 0.76), band) * knit(seed, uv)
    };
    let checks = move |uv: glam::Vec2| {
        let [x, y] = [(uv.x * 6.0).fract(), (uv.y * 3.0).fract()].map(|v| (v < 0.4) as u32 as f32);
        vec3(0.2, 0.36, 0.52)
            * (1.15 - 0.28 * x - 0.28 * y)
            * (0.95 + 0.1 * paint::value_noise(seed, glam::UVec2::splat(64), uv))
    };
    let denim = move |tone: Vec3| {
        move |uv: glam::Vec2| {
            let twill = ((uv.x + uv.y) * 48.0).fract();
            tone * (0.85 + 0.2 * twill + 0.3 * (paint::fbm(seed + 8, glam::UVec2::splat(4), 4, uv) - 0.5))
        }
    };
    let hair = |name: &str, color: Vec3, s: &mut SceneBuilder| {
        cloth(s, name, move |uv| {
            let strand = paint::fbm(seed + 5, glam::UVec2::new(24, 2), 4, uv);
            color * (0.7 + 0.6 * strand)
        })
    };
    [
        Look {
            face: paint_face(s, "face-a", &base),
            skin: props::plain(s, "skin-a", base.skin, 0.55),
            hair: hair("hair-a", vec3(0.5, 0.22, 0.1), s),
            top: cloth(s, "striped-jumper", stripes),
            trousers: cloth(s, "olive-trousers", denim(vec3(0.36, 0.36, 0.24))),
            shoe: props::plain(s, "shoe-a", vec3(0.85, 0.8, 0.7), 0.6),
            radii: vec3(0.118, 0.142, 0.124),
            nose: 0.006,
        },
        Look {
            face: paint_face(s, "face-b", &other),
            skin: props::plain(s, "skin-b", other.skin, 0.55),
            hair: hair("hair-b", vec3(0.11, 0.09, 0.09), s),
            top: cloth(s, "checked-shirt", checks),
            trousers: cloth(s, "denim", denim(vec3(0.2, 0.27, 0.42))),
            shoe: props::plain(s, "shoe-b", vec3(0.35, 0.2, 0.13), 0.5),
            radii: vec3(0.122, 0.146, 0.126),
            nose: 0.012,
        },
    ]
}

fn dressed(s: &mut SceneBuilder, look: &Look, sole: usize, j: &Joints, hands: [Hand; 2], name: &str) {
    s.object(&format!("{name}-body"));
    let axis = j.waist.with_y(0.0);
    let mut top = Clay::new(0.06);
    top.ball(j.chest, vec3(0.155, 0.15, 0.105))
        .ball(j.waist, vec3(0.135, 0.13, 0.1))
        .ball(j.pelvis + Vec3::Y * 0.07, vec3(0.15, 0.09, 0.115))
        .limb(j.shoulders[0], j.shoulders[1], 0.062, 0.062)
        .limb(j.neck - Vec3::Y * 0.04, j.neck, 0.075, 0.06);
    s.with_material(look.top);
    figure::clad(s, &top, 0.021, axis, 4.0, 0.5);
    for side in 0..2 {
        let mut sleeve = Clay::new(0.04);
        sleeve.limb(j.shoulders[side], j.elbows[side], 0.06, 0.05).limb(
            j.elbows[side],
            j.wrists[side],
            0.05,
            0.04,
        );
        s.object(&format!("{name}-sleeve-{side}"));
        // A cuff.
        let back = (j.elbows[side] - j.wrists[side]).normalize_or(Vec3::Y);
        sleeve.limb(j.wrists[side] + back * 0.035, j.wrists[side] + back * 0.01, 0.042, 0.042);
        let center = (j.shoulders[side] + j.wrists[side]) * 0.5;
        figure::clad(s, &sleeve, 0.018, center - Vec3::Z * 0.2, 4.0, 0.5);
    }
    s.object(&format!("{name}-body"));
    // The collar.
    s.within(
        Affine3A::from_rotation_translation(Quat::from_rotation_x(0.15), j.neck + Vec3::Y * 0.035),
        |s| {
            s.surface(28, 8, true, |u, v| {
                let (turn, roll) = (u.fract() * TAU, v.fract() * TAU);
                let out = vec3(turn.cos(), 0.0, -turn.sin());
                let p = out * (0.068 + 0.014 * roll.cos()) + Vec3::Y * (0.02 * roll.sin());
                (p, vec2(u * 3.0, v * 0.1))
            });
        },
    );
    let mut legs = Clay::new(0.05);
    legs.ball(j.pelvis, vec3(0.155, 0.1, 0.125));
    for side in 0..2 {
        legs.limb(j.hips[side], j.knees[side], 0.085, 0.066).limb(
            j.knees[side],
            j.ankles[side] + Vec3::Y * 0.03,
            0.066,
            0.056,
        );
    }
    s.with_material(look.trousers);
    figure::clad(s, &legs, 0.022, axis, 4.0, 0.4);
    s.object(&format!("{name}-feet"));
    for side in 0..2 {
        let toe = vec3(if side == 0 { 0.25 } else { -0.25 }, 0.0, 1.0);
        figure::shoe(s, [look.shoe, sole], j.ankles[side], toe, 1.0, 0.015);
    }
    s.with_material(look.skin);
    for (side, hand) in hands.into_iter().enumerate() {
        s.object(&format!("{name}-hand-{side}"));
        figure::hand(s, &hand, 0.0074);
    }
    s.object(&format!("{name}-head"));
    s.within(figure::head_frame(j), |s| {
        s.with_material(look.face);
        figure::head(s, look.radii, look.nose, 0.0105);
        s.with_material(look.skin);
        figure::ears(s, look.radii);
    });
}

fn long_hair(s: &mut SceneBuilder, r: Vec3, rng: &mut Pcg32) {
    let mut cap = Clay::new(0.03);
    cap.ball(vec3(0.0, 0.16 * r.y, -0.12 * r.z), r * vec3(1.07, 0.98, 1.06));
    cap.ball(vec3(0.0, -0.25 * r.y, -0.5 * r.z), r * vec3(1.0, 0.8, 0.66));
    cap.carve(vec3(0.0, -0.5 * r.y, 1.0 * r.z), r * vec3(0.86, 1.05, 0.85));
    cap.mesh(s, 0.011, |p, _| vec2(p.x.atan2(p.z), p.y * 3.0));
    // The bun.
    let mut bun = Clay::new(0.02);
    bun.ball(vec3(0.0, 0.95 * r.y, -0.75 * r.z), Vec3::splat(0.055));
    bun.mesh(s, 0.008, |p, _| vec2(p.x * 8.0, p.y * 3.0));
    for i in 0..7 {
        let turn = i as f32 / 7.0 * TAU;
        let c = vec3(0.0, 0.95 * r.y, -0.75 * r.z);
        let (x, y) = (turn.cos(), turn.sin());
        figure::lock(
            s,
            [
                c + vec3(x, y, 0.3) * 0.05,
                c + vec3(x, y, 0.9) * 0.06,
                c + vec3(-y, x, 1.0) * 0.055,
                c + vec3(-x, -y, 0.4) * 0.045,
            ],
            0.014,
            0.6,
            [8, 8],
        );
    }
    // A fringe swept to one side, with locks beside the face and down the neck.
    for i in 0..13 {
        let t = i as f32 / 12.0;
        let turn = -1.15 + 2.3 * t;
        let root = figure::on_head(r, 0.35 + turn * 0.3, 1.15, 1.03);
        let tip_turn = turn * 1.02 - 0.12;
        let tip_rise = 0.28 - 0.5 * turn.abs().powi(2) + around(rng, 0.0, 0.04);
        let tip = figure::on_head(r, tip_turn, tip_rise, 1.07);
        let bend = figure::on_head(r, turn * 0.75, 0.85, 1.22);
        let low = figure::on_head(r, tip_turn, tip_rise + 0.3, 1.18);
        figure::lock(s, [root, bend, low, tip], 0.019, 0.45, [6, 10]);
    }
    for side in [-1.0, 1.0] {
        for i in 0..7 {
            let turn = side * (1.25 + 0.22 * i as f32);
            let root = figure::on_head(r, turn, 0.35, 1.02);
            let mid = figure::on_head(r, turn, -0.2, 1.16);
            let tip = figure::on_head(r, turn * 0.97, -1.0, 1.1) + Vec3::NEG_Y * around(rng, 0.075, 0.02);
            figure::lock(s, [root, mid, tip + vec3(side * 0.03, 0.06, -0.01), tip], 0.02, 0.5, [6, 10]);
        }
    }
}

fn short_hair(s: &mut SceneBuilder, r: Vec3, rng: &mut Pcg32) {
    let mut cap = Clay::new(0.025);
    cap.ball(vec3(0.0, 0.2 * r.y, -0.14 * r.z), r * vec3(1.05, 0.92, 1.03));
    cap.carve(vec3(0.0, -0.75 * r.y, 0.75 * r.z), r * vec3(1.2, 1.2, 1.0));
    cap.mesh(s, 0.011, |p, _| vec2(p.x.atan2(p.z), p.y * 3.0));
    // Curls over the top and the sides.
    for i in 0..72 {
        let turn = i as f32 * 2.399_963;
        let rise = (1.0 - (i as f32 + 0.5) / 72.0 * 0.95).asin();
        let facing_down = turn.cos() * rise.cos() > 0.55 && rise < 0.55;
        if facing_down {
            continue;
        }
        let c = figure::on_head(r, turn, rise, 1.04);
        let out = (c - vec3(0.0, 0.1 * r.y, 0.0)).normalize_or(Vec3::Y);
        let side = out.any_orthonormal_vector();
        let side = Quat::from_axis_angle(out, around(rng, 0.0, PI)) * side;
        let k = 0.036;
        figure::lock(
            s,
            [
                c - out * 0.01,
                c + (out * 1.3 - side * 0.3) * k,
                c + (out * 1.3 + side * 1.5) * k,
                c + (side * 1.3 - out * 0.2) * k,
            ],
            0.0155,
            0.8,
            [6, 9],
        );
    }
}

/// Makes a head look about and nod, once per loop. `frame` is the figure's frame in the scene.
fn look_about(movers: &mut Movers, frame: Affine3A, j: &Joints, seconds: f32, yaw: f32) -> usize {
    let side = frame.transform_vector3(Vec3::X);
    movers.turn(None, frame.transform_point3(j.neck), seconds, move |t| {
        let nod = 0.05 * (1.0 - (2.0 * TAU * t).cos());
        about(Vec3::Y, yaw * (TAU * t).sin()) * about(side, nod)
    })
}

/// Makes a forearm gesture: it bends at the elbow, and the hand at the wrist.
fn gesture(movers: &mut Movers, frame: Affine3A, j: &Joints, side: usize, name: &str) {
    let [shoulder, elbow, wrist] =
        [j.shoulders[side], j.elbows[side], j.wrists[side]].map(|p| frame.transform_point3(p));
    let across = frame.transform_vector3(Vec3::X);
    let arm = movers.turn(None, elbow, 4.0, move |t| {
        let lift = 0.11 * (1.0 - (TAU * t).cos());
        about(Vec3::Y, 0.3 * (TAU * t).sin()) * about(across, -lift)
    });
    let hand = movers.turn(Some(arm), wrist, 4.0, move |t| about(across, 0.35 * (2.0 * TAU * t).sin()));
    movers.carry(hand, &[&format!("{name}-hand-{side}")]);
    let still = movers.still();
    // From the upper arm to the forearm, across the plane halfway between them.
    let along = ((wrist - elbow).normalize_or(Vec3::Y) - (shoulder - elbow).normalize_or(Vec3::Y))
        .normalize_or(Vec3::Y);
    movers.bend([still, arm], &format!("{name}-sleeve-{side}"), move |p| {
        let t = ((p - elbow).dot(along) / 0.06 + 0.5).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    });
}

fn people(s: &mut SceneBuilder, p: &Palette, seed: u32, movers: &mut Movers, rng: &mut Pcg32) {
    let [first, second] = looks(s, seed);
    let seated = Joints {
        head: vec3(0.0, 1.275, 0.11),
        head_turn: Quat::from_rotation_x(0.06),
        neck: vec3(0.0, 1.075, 0.05),
        chest: vec3(0.0, 0.94, 0.04),
        waist: vec3(0.0, 0.73, 0.0),
        pelvis: vec3(0.0, 0.56, -0.02),
        shoulders: [vec3(0.165, 1.01, 0.03), vec3(-0.165, 1.01, 0.03)],
        elbows: [vec3(0.26, 0.79, 0.24), vec3(-0.27, 0.8, 0.22)],
        wrists: [vec3(0.13, 0.785, 0.47), vec3(-0.21, 1.0, 0.4)],
        hips: [vec3(0.085, 0.545, 0.02), vec3(-0.085, 0.545, 0.02)],
        knees: [vec3(0.12, 0.54, 0.42), vec3(-0.12, 0.54, 0.42)],
        ankles: [vec3(0.13, 0.09, 0.36), vec3(-0.12, 0.09, 0.44)],
    };
    let ada = placed(vec3(-0.92, 0.0, 0.0), FRAC_PI_2);
    let head = look_about(movers, ada, &seated, 6.0, 0.22);
    movers.carry(head, &["ada-head", "ada-hair"]);
    gesture(movers, ada, &seated, 1, "ada");
    s.within(ada, |s| {
        let j = seated;
        let hands = [
            Hand {
                wrist: j.wrists[0],
                along: vec3(-0.45, -0.12, 1.0),
                palm: Vec3::NEG_Y,
                curl: 0.18,
                thumb: -1.0,
                scale: 0.95,
            },
            Hand {
                wrist: j.wrists[1],
                along: vec3(0.15, 0.85, 0.5),
                palm: vec3(0.35, 0.45, 0.8),
                curl: 0.3,
                thumb: -1.0,
                scale: 0.95,
            },
        ];
        dressed(s, &first, p.white, &j, hands, "ada");
        s.object("ada-hair").with_material(first.hair);
        s.within(figure::head_frame(&j), |s| long_hair(s, first.radii, rng));
    });
    let ben = placed(vec3(0.92, 0.0, 0.0), -FRAC_PI_2);
    let head = look_about(movers, ben, &seated, 8.0, -0.16);
    movers.carry(head, &["ben-head", "ben-hair", "ben-glasses"]);
    s.within(ben, |s| {
        let mut j = seated;
        j.head += vec3(0.02, 0.015, -0.03);
        j.head_turn =
            Quat::from_rotation_y(0.08) * Quat::from_rotation_x(-0.02) * Quat::from_rotation_z(0.06);
        j.elbows = [vec3(0.3, 0.8, 0.2), vec3(-0.3, 0.8, 0.2)];
        j.wrists = [vec3(0.13, 0.83, 0.44), vec3(-0.12, 0.79, 0.44)];
        let hands = [
            Hand {
                wrist: j.wrists[0],
                along: vec3(-0.7, 0.05, 0.5),
                palm: vec3(-0.55, 0.0, -0.8),
                curl: 0.62,
                thumb: 1.0,
                scale: 1.02,
            },
            Hand {
                wrist: j.wrists[1],
                along: vec3(0.55, -0.08, 0.9),
                palm: Vec3::NEG_Y,
                curl: 0.2,
                thumb: 1.0,
                scale: 1.02,
            },
        ];
        dressed(s, &second, p.dark_wood, &j, hands, "ben");
        s.object("ben-hair").with_material(second.hair);
        s.within(figure::head_frame(&j), |s| short_hair(s, second.radii, rng));
        // Round glasses.
        s.object("ben-glasses").with_material(p.iron);
        s.within(figure::head_frame(&j), |s| {
            let z = second.radii.z * 0.99;
            for side in [-1.0, 1.0] {
                let rim: Vec<Vec3> = (0..=24)
                    .map(|i| {
                        let a = i as f32 / 24.0 * TAU;
                        vec3(
                            side * 0.046 + 0.036 * a.cos(),
                            0.002 + 0.034 * a.sin(),
                            z - 0.012 * (a.cos() * side).max(0.0),
                        )
                    })
                    .collect();
                s.tube(&rim, 0.0022, 6, false);
                s.tube(
                    &[
                        vec3(side * 0.082, 0.006, z - 0.012),
                        vec3(side * 0.122, 0.008, 0.02),
                        vec3(side * 0.126, -0.01, -0.02),
                    ],
                    0.002,
                    5,
                    true,
                );
            }
            s.tube(
                &[vec3(-0.01, 0.006, z), vec3(0.0, 0.012, z + 0.004), vec3(0.01, 0.006, z)],
                0.002,
                5,
                false,
            );
        });
    });
}

fn chair(s: &mut SceneBuilder, p: &Palette) {
    s.with_material(p.dark_wood);
    s.beveled_cuboid(vec3(-0.21, 0.415, -0.22), vec3(0.21, 0.44, 0.2), 0.01);
    for x in [-0.18, 0.18] {
        s.cylinder(vec3(x * 1.08, 0.0, 0.2), vec3(x, 0.42, 0.16), 0.013, 0.019, 10, true);
        let back: Vec<Vec3> = (0..=8)
            .map(|i| {
                let t = i as f32 / 8.0;
                vec3(x * (1.1 - 0.1 * t), 0.96 * t, -0.2 - 0.1 * (t - 0.35).abs())
            })
            .collect();
        s.tube(&back, 0.017, 8, true);
        s.cylinder(vec3(x, 0.2, 0.18), vec3(x, 0.2, -0.21), 0.009, 0.009, 6, false);
    }
    for (y, r) in [(0.94, 0.022), (0.62, 0.012)] {
        let rail: Vec<Vec3> = (0..=8)
            .map(|i| {
                let t = i as f32 / 4.0 - 1.0;
                vec3(0.18 * t, y, -0.255 - 0.03 * (1.0 - t * t))
            })
            .collect();
        s.tube(&rail, r, 8, true);
    }
    for i in 0..6 {
        let x = -0.135 + 0.054 * i as f32;
        s.cylinder(vec3(x, 0.62, -0.27), vec3(x, 0.94, -0.285), 0.006, 0.006, 6, false);
    }
    s.with_material(p.cushion).beveled_cuboid(vec3(-0.19, 0.44, -0.19), vec3(0.19, 0.465, 0.18), 0.012);
}

fn table(s: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    s.object("table").with_material(p.wood);
    s.lathe(&[(0.0, 0.69), (0.42, 0.69), (0.44, 0.7), (0.445, 0.712), (0.44, 0.722), (0.43, 0.725)], 56);
    let rim: Vec<Vec3> = (0..56)
        .map(|i| {
            let turn = i as f32 / 56.0 * TAU;
            vec3(0.43 * turn.cos(), 0.725, 0.43 * turn.sin())
        })
        .collect();
    s.fan(&rim, Vec3::Y);
    s.with_material(p.dark_wood);
    s.lathe(
        &[(0.03, 0.06), (0.05, 0.1), (0.032, 0.2), (0.028, 0.4), (0.04, 0.52), (0.03, 0.62), (0.09, 0.69)],
        20,
    );
    for i in 0..3 {
        let turn = i as f32 / 3.0 * TAU + 0.5;
        let out = vec3(turn.cos(), 0.0, turn.sin());
        s.tapered_tube(
            &[
                out * 0.02 + Vec3::Y * 0.13,
                out * 0.14 + Vec3::Y * 0.1,
                out * 0.27 + Vec3::Y * 0.03,
                out * 0.34 + Vec3::Y * 0.018,
            ],
            &|t| 0.028 - 0.012 * t,
            10,
            true,
        );
    }
    s.object("table-top");
    for (at, turn) in [(vec3(-0.2, 0.725, 0.17), 0.6), (vec3(0.3, 0.725, -0.14), 2.4)] {
        s.within(placed(at, turn), |s| props::cup(s, p.china, p.coffee));
    }
    // A plate of biscuits, a tea pot, a small vase, an open book.
    s.within(moved(0.02, 0.725, -0.2), |s| {
        s.with_material(p.china);
        s.lathe(
            &[
                (0.0, 0.004),
                (0.06, 0.004),
                (0.1, 0.016),
                (0.102, 0.02),
                (0.102, 0.02),
                (0.06, 0.01),
                (0.0, 0.01),
            ],
            32,
        );
        s.with_material(p.wood);
        for i in 0..6 {
            let turn = i as f32 * 1.05;
            let r = if i == 5 { 0.0 } else { 0.045 };
            let at = vec3(r * turn.cos(), 0.011 + 0.012 * (i == 5) as u32 as f32, r * turn.sin());
            s.within(placed(at, turn), |s| {
                s.lathe(&[(0.0, 0.0), (0.024, 0.0), (0.027, 0.006), (0.023, 0.012), (0.0, 0.013)], 16)
            });
        }
    });
    s.within(placed(vec3(0.12, 0.725, 0.2), 0.9), |s| {
        s.with_material(p.cushion);
        s.lathe(
            &[
                (0.0, 0.0),
                (0.045, 0.0),
                (0.07, 0.03),
                (0.078, 0.065),
                (0.065, 0.105),
                (0.035, 0.122),
                (0.035, 0.122),
                (0.03, 0.13),
                (0.008, 0.14),
                (0.008, 0.14),
                (0.014, 0.15),
                (0.0, 0.163),
            ],
            28,
        );
        s.tapered_tube(
            &[vec3(0.06, 0.05, 0.0), vec3(0.1, 0.07, 0.0), vec3(0.115, 0.11, 0.0), vec3(0.14, 0.13, 0.0)],
            &|t| 0.02 - 0.011 * t,
            12,
            true,
        );
        let handle: Vec<Vec3> = (0..=12)
            .map(|i| {
                let a = i as f32 / 12.0 * PI - FRAC_PI_2;
                vec3(-0.07 - 0.04 * a.cos(), 0.065 + 0.042 * a.sin(), 0.0)
            })
            .collect();
        s.tube(&handle, 0.007, 8, false);
    });
    s.within(moved(-0.06, 0.725, 0.02), |s| {
        s.with_material(p.china);
        s.lathe(
            &[
                (0.0, 0.0),
                (0.03, 0.0),
                (0.038, 0.03),
                (0.022, 0.085),
                (0.027, 0.11),
                (0.024, 0.11),
                (0.018, 0.085),
            ],
            24,
        );
        for i in 0..5 {
            let turn = i as f32 * 1.26 + around(rng, 0.0, 0.3);
            let lean = vec3(turn.cos(), 0.0, turn.sin()) * 0.07;
            let tip = lean + Vec3::Y * around(rng, 0.24, 0.03);
            s.with_material(p.leaf).tapered_tube(
                &[Vec3::Y * 0.06, lean * 0.3 + Vec3::Y * 0.16, tip],
                &|_| 0.0022,
                5,
                false,
            );
            s.with_material(if i % 2 == 0 { p.pot } else { p.paper });
            for k in 0..7 {
                let a = k as f32 / 7.0 * TAU;
                let petal = vec3(a.cos(), 0.25, a.sin()) * 0.019;
                s.ellipsoid(tip + petal, vec3(0.011, 0.006, 0.011), 6, 8);
            }
            s.with_material(p.brass).ellipsoid(tip + Vec3::Y * 0.006, Vec3::splat(0.009), 7, 9);
        }
    });
}

fn room(s: &mut SceneBuilder, p: &Palette, seed: u32) {
    let wall = props::textured(s, paint::plaster("wall", 512, seed + 10, vec3(0.78, 0.68, 0.56)), 2.0, 0.9);
    let panel =
        props::textured(s, paint::planks("panel", 512, seed + 11, vec3(0.42, 0.5, 0.48), 6), 1.2, 0.6);
    let floor =
        props::textured(s, paint::planks("floor", 1024, seed + 12, vec3(0.62, 0.42, 0.26), 8), 1.6, 0.35);
    let ceiling = props::plain(s, "ceiling", vec3(0.9, 0.88, 0.83), 0.95);
    let rug = props::textured(
        s,
        paint::damask("rug", 512, seed + 13, vec3(0.5, 0.16, 0.17), vec3(0.8, 0.66, 0.42), 3),
        1.0,
        0.95,
    );
    let (x, near, far, top) = (3.2, 4.4, -3.0, 2.8);
    s.object("floor").with_material(floor).rectangle(
        vec3(-x, 0.0, near),
        Vec3::X * 2.0 * x,
        Vec3::NEG_Z * (near - far),
    );
    s.object("ceiling").with_material(ceiling).rectangle(
        vec3(-x, top, far),
        Vec3::X * 2.0 * x,
        Vec3::Z * (near - far),
    );
    s.with_material(p.dark_wood);
    for i in 0..5 {
        let z = -2.4 + 1.5 * i as f32;
        s.cuboid_faces(
            vec3(-x, top - 0.16, z - 0.07),
            vec3(x, top, z + 0.07),
            BoxFaces::ALL.without(BoxFaces::TOP),
        );
    }
    s.object("walls").with_material(wall);
    // The far wall has a wide window: sill at 0.85, head at 2.35, from -1.5 to 1.5.
    let hole = [-1.5, 1.5, 0.85, 2.35];
    let t = -0.3;
    for (a, b, low, high) in [
        (-x, hole[0], 0.0, top),
        (hole[1], x, 0.0, top),
        (hole[0], hole[1], 0.0, hole[2]),
        (hole[0], hole[1], hole[3], top),
    ] {
        s.rectangle(vec3(a, low, far), Vec3::X * (b - a), Vec3::Y * (high - low));
    }
    s.rectangle(vec3(-x, 0.0, near), Vec3::NEG_Z * (near - far), Vec3::Y * top);
    s.rectangle(vec3(x, 0.0, far), Vec3::Z * (near - far), Vec3::Y * top);
    s.rectangle(vec3(x, 0.0, near), Vec3::NEG_X * 2.0 * x, Vec3::Y * top);
    // The outside of the window wall, which keeps the sun from shining through it.
    s.with_material(p.white);
    for (a, b, low, high) in [
        (-x, hole[0], 0.0, top),
        (hole[1], x, 0.0, top),
        (hole[0], hole[1], 0.0, hole[2]),
        (hole[0], hole[1], hole[3], top),
    ] {
        s.rectangle(vec3(b, low, far + t), Vec3::X * (a - b), Vec3::Y * (high - low));
    }
    s.object("roof").with_material(p.pot);
    s.cuboid_faces(
        vec3(-x - 0.3, top + 0.02, far - 0.5),
        vec3(x + 0.3, top + 0.2, near + 0.3),
        BoxFaces::ALL,
    );
    for side in [-1.0, 1.0f32] {
        let (a, b) = (side * x + side * 0.02, side * (x + 0.25));
        s.cuboid(vec3(a.min(b), 0.0, far - 0.3), vec3(a.max(b), top + 0.02, near + 0.25));
    }
    s.object("panelling").with_material(panel);
    for (a, right) in [
        (vec3(-x + 0.02, 0.0, near), Vec3::NEG_Z * (near - far)),
        (vec3(x - 0.02, 0.0, far), Vec3::Z * (near - far)),
    ] {
        s.rectangle(a, right, Vec3::Y * 0.85);
    }
    s.with_material(p.white);
    for side in [-1.0, 1.0f32] {
        let (a, b) = (side * (x - 0.05), side * x);
        s.cuboid(vec3(a.min(b), 0.85, far), vec3(a.max(b), 0.9, near));
        s.cuboid(vec3(a.min(b), 0.0, far), vec3(a.max(b), 0.12, near));
    }
    s.object("window").with_material(p.white);
    s.cuboid(vec3(-1.62, 0.78, far - 0.3), vec3(1.62, 0.85, far + 0.14));
    for (a, b) in [
        (vec3(-1.56, 0.85, -0.02), vec3(-1.5, 2.35, 0.03)),
        (vec3(1.5, 0.85, -0.02), vec3(1.56, 2.35, 0.03)),
        (vec3(-1.56, 2.35, -0.02), vec3(1.56, 2.42, 0.03)),
    ] {
        s.cuboid(a + Vec3::Z * far, b + Vec3::Z * far);
    }
    for x in [-1.5, -0.52, 0.5, 1.48] {
        s.cuboid(vec3(x, 0.85, far - 0.18), vec3(x + 0.045, 2.35, far - 0.12));
    }
    for y in [0.85, 1.83, 2.31] {
        s.cuboid(vec3(-1.5, y, far - 0.175), vec3(1.5, y + 0.04, far - 0.125));
    }
    for (a, b, face) in [(-1.5, -1.5, Vec3::X), (1.5, 1.5, Vec3::NEG_X)] {
        let z = if face == Vec3::X { [far, far + t] } else { [far + t, far] };
        s.quad([vec3(a, 0.85, z[0]), vec3(b, 0.85, z[1]), vec3(b, 2.35, z[1]), vec3(a, 2.35, z[0])]);
    }
    s.rectangle(vec3(-1.5, 2.35, far + t), Vec3::X * 3.0, Vec3::Z * -t);
    s.object("window-glass").with_material(p.glass).rectangle(
        vec3(-1.5, 0.85, far - 0.15),
        Vec3::X * 3.0,
        Vec3::Y * 1.5,
    );
    s.object("curtains");
    s.with_material(p.brass).cylinder(
        vec3(-2.2, 2.52, far + 0.12),
        vec3(2.2, 2.52, far + 0.12),
        0.014,
        0.014,
        10,
        true,
    );
    s.with_material(p.curtain);
    s.curtain(vec3(-2.15, 2.5, far + 0.12), vec3(-1.4, 2.5, far + 0.12), 2.4, 6.0, 0.035, [72, 14]);
    s.curtain(vec3(1.4, 2.5, far + 0.12), vec3(2.15, 2.5, far + 0.12), 2.4, 6.0, 0.035, [72, 14]);
    s.object("rug").with_material(rug);
    s.cuboid_faces(vec3(-1.7, 0.0, -1.2), vec3(1.7, 0.012, 1.2), BoxFaces::STANDING);
}

/// Builds shelves with books, from the floor up, against the plane z = 0, 1.6 m wide.
fn bookcase(s: &mut SceneBuilder, p: &Palette, covers: &[usize], rng: &mut Pcg32) {
    let (width, height, depth) = (1.6, 2.2, 0.3);
    s.with_material(p.dark_wood);
    for x in [0.0, width - 0.03] {
        s.cuboid(vec3(x, 0.0, 0.0), vec3(x + 0.03, height, depth));
    }
    s.cuboid(vec3(0.0, 0.0, 0.0), vec3(width, height, 0.015));
    let boards: Vec<f32> = (0..6).map(|i| 0.08 + 0.415 * i as f32).collect();
    for &y in &boards {
        s.cuboid(vec3(0.03, y, 0.015), vec3(width - 0.03, y + 0.025, depth));
    }
    for &y in &boards[..5] {
        let mut x = 0.05;
        while x < width - 0.12 {
            if rng.random::<f32>() < 0.06 {
                x += around(rng, 0.14, 0.06);
                continue;
            }
            let thick = around(rng, 0.033, 0.014);
            let size = vec3(thick, around(rng, 0.25, 0.06), around(rng, 0.19, 0.03));
            let lean = if rng.random::<f32>() < 0.1 { -0.16 } else { 0.0 };
            let at = Affine3A::from_rotation_translation(
                Quat::from_rotation_z(lean),
                vec3(
                    x + if lean < 0.0 { 0.005 } else { 0.0 },
                    y + 0.026 + if lean < 0.0 { thick * 0.16 } else { 0.0 },
                    0.04,
                ),
            );
            s.within(at, |s| {
                s.with_material(covers[rng.random_range(0..covers.len())]);
                s.cuboid_faces(Vec3::ZERO, size, BoxFaces::ALL.without(BoxFaces::BACK));
                s.with_material(p.paper);
                s.cuboid_faces(
                    vec3(0.004, size.y - 0.004, 0.004),
                    vec3(thick - 0.004, size.y + 0.001, size.z - 0.008),
                    BoxFaces::TOP,
                );
                s.with_material(p.brass);
                let z = size.z + 0.0006;
                s.rectangle(
                    vec3(thick * 0.2, size.y * 0.72, z),
                    Vec3::X * thick * 0.6,
                    Vec3::Y * size.y * 0.06,
                );
                s.rectangle(
                    vec3(thick * 0.2, size.y * 0.2, z),
                    Vec3::X * thick * 0.6,
                    Vec3::Y * size.y * 0.03,
                );
            });
            x += thick + 0.002 + if lean < 0.0 { size.y * 0.17 } else { 0.0 };
        }
    }
}

fn furniture(s: &mut SceneBuilder, p: &Palette, seed: u32, rng: &mut Pcg32) {
    for (name, at, yaw) in [
        ("chair-west", vec3(-0.94, 0.012, 0.0), FRAC_PI_2),
        ("chair-east", vec3(0.94, 0.012, 0.0), -FRAC_PI_2),
        ("chair-spare", vec3(2.5, 0.0, 3.2), -2.3),
    ] {
        s.object(name);
        s.within(placed(at, yaw), |s| chair(s, p));
    }
    let covers: Vec<usize> = [
        vec3(0.55, 0.16, 0.14),
        vec3(0.16, 0.28, 0.45),
        vec3(0.2, 0.38, 0.24),
        vec3(0.76, 0.68, 0.5),
        vec3(0.32, 0.2, 0.34),
        vec3(0.78, 0.5, 0.18),
        vec3(0.16, 0.17, 0.2),
    ]
    .iter()
    .enumerate()
    .map(|(i, &c)| props::plain(s, &format!("book-{i}"), c, 0.7))
    .collect();
    for (i, z) in [1.0, -0.62].into_iter().enumerate() {
        s.object(&format!("bookcase-{i}"));
        s.within(placed(vec3(-3.18, 0.0, z), FRAC_PI_2), |s| bookcase(s, p, &covers, rng));
    }
    // A floor lamp behind the table, one over it, a table by the wall.
    s.object("floor-lamp");
    s.within(moved(1.75, 0.0, -1.9), |s| {
        s.with_material(p.brass)
            .lathe(&[(0.0, 0.0), (0.14, 0.0), (0.14, 0.01), (0.03, 0.03), (0.011, 0.05), (0.011, 1.45)], 24);
        s.with_material(p.shade);
        s.lathe(&[(0.2, 1.4), (0.12, 1.7)], 32);
        s.lathe(&[(0.118, 1.7), (0.198, 1.4)], 32);
    });
    s.object("pendant");
    s.with_material(p.iron).cylinder(vec3(0.0, 2.8, 0.0), vec3(0.0, 2.02, 0.0), 0.004, 0.004, 6, false);
    s.within(moved(0.0, 1.84, 0.0), |s| {
        s.with_material(p.brass);
        s.lathe(&[(0.2, 0.0), (0.19, 0.05), (0.12, 0.12), (0.04, 0.16), (0.02, 0.2), (0.0, 0.2)], 36);
        s.with_material(p.shade);
        s.lathe(&[(0.0, 0.15), (0.035, 0.15), (0.115, 0.11), (0.185, 0.045), (0.196, 0.0)], 36);
        s.ellipsoid(Vec3::Y * 0.05, vec3(0.035, 0.045, 0.035), 12, 18);
    });
    s.object("sideboard").with_material(p.wood);
    s.within(moved(2.9, 0.0, -0.6), |s| {
        s.beveled_cuboid(vec3(-0.25, 0.12, -0.9), vec3(0.25, 0.78, 0.9), 0.012);
        s.with_material(p.brass);
        for i in 0..3 {
            let z = -0.6 + 0.6 * i as f32;
            s.ellipsoid(vec3(-0.265, 0.6, z), Vec3::splat(0.018), 8, 12);
            s.with_material(p.dark_wood).cuboid(vec3(-0.254, 0.15, z + 0.295), vec3(-0.249, 0.75, z + 0.305));
            s.with_material(p.brass);
        }
        s.with_material(p.dark_wood);
        for (x, z) in [(-0.2, -0.85), (0.2, -0.85), (-0.2, 0.85), (0.2, 0.85)] {
            s.cylinder(vec3(x, 0.0, z), vec3(x, 0.12, z), 0.015, 0.025, 8, false);
        }
    });
    for (i, (at, size)) in [
        (vec3(2.9, 0.78, -1.2), 0.5),
        (vec3(-2.55, 0.0, -2.4), 1.2),
        (vec3(2.75, 0.0, 1.4), 0.95),
        (vec3(-1.2, 0.85, -2.95), 0.35),
    ]
    .into_iter()
    .enumerate()
    {
        s.object(&format!("plant-{i}"));
        s.within(moved(at.x, at.y, at.z), |s| {
            let r = 0.15 * size;
            s.with_material(p.pot);
            s.lathe(
                &[
                    (0.0, 0.0),
                    (r * 0.75, 0.0),
                    (r, r * 1.7),
                    (r * 1.1, r * 1.7),
                    (r * 1.1, r * 2.0),
                    (r * 0.98, r * 2.0),
                    (r * 0.9, r * 1.6),
                    (0.0, r * 1.6),
                ],
                24,
            );
            s.within(moved(0.0, r * 1.6, 0.0), |s| {
                if i % 2 == 0 {
                    props::fronds(s, p.leaf, 18, size, 0.09 * size, rng);
                } else {
                    props::bush(s, [p.dark_wood, p.card], 0.36 * size, 0.9 * size, 220, rng);
                }
            });
        });
    }
    // Pictures on the wall.
    for (i, (z, y, w, h)) in
        [(-0.9, 1.65, 0.5, 0.36), (-0.1, 1.75, 0.3, 0.42), (2.6, 1.6, 0.7, 0.5)].into_iter().enumerate()
    {
        let name = format!("painting-{i}");
        let tone = i as f32;
        let image = paint::picture(&name, [256, 192], |uv| {
            let hills =
                0.35 + 0.2 * paint::value_noise(seed + i as u32, glam::UVec2::new(5, 1), vec2(uv.x, 0.5));
            let sky = vec3(0.95, 0.75, 0.5).lerp(vec3(0.35, 0.55, 0.75), uv.y + 0.1 * tone);
            let land = vec3(0.25, 0.42, 0.25).lerp(vec3(0.5, 0.35, 0.3), 0.4 * tone);
            let brush = 0.85 + 0.3 * paint::fbm(seed + 60 + i as u32, glam::UVec2::splat(12), 3, uv);
            let sun = paint::smoothstep(0.09, 0.08, uv.distance(vec2(0.7, 0.72)));
            let scene = if uv.y < hills { land * (0.7 + uv.y) } else { sky.lerp(vec3(1.0, 0.93, 0.75), sun) };
            (scene * brush).extend(1.0)
        });
        let canvas = props::pictured(s, image, 0.8, 0.0);
        s.object(&name);
        s.within(placed(vec3(3.19, y, z), -FRAC_PI_2), |s| {
            s.with_material(p.dark_wood);
            for (a, b) in [
                (vec3(-w, -h, 0.0), vec3(w, -h + 0.04, 0.03)),
                (vec3(-w, h - 0.04, 0.0), vec3(w, h, 0.03)),
                (vec3(-w, -h, 0.0), vec3(-w + 0.04, h, 0.03)),
                (vec3(w - 0.04, -h, 0.0), vec3(w, h, 0.03)),
            ] {
                s.cuboid(a * vec3(0.6, 0.6, 1.0), b * vec3(0.6, 0.6, 1.0));
            }
            let (w, h) = (w * 0.6 - 0.02, h * 0.6 - 0.02);
            s.with_material(canvas).picture([
                vec3(-w, -h, 0.008),
                vec3(w, -h, 0.008),
                vec3(w, h, 0.008),
                vec3(-w, h, 0.008),
            ]);
        });
    }
}

/// Builds a tree to be seen from afar: a trunk, a few boughs, leaf cards in clumps.
fn tree(s: &mut SceneBuilder, bark: usize, leaves: usize, height: f32, rng: &mut Pcg32) {
    let fork = vec3(0.0, height * 0.34, 0.0);
    s.with_material(bark).cylinder(Vec3::ZERO, fork, height * 0.03, height * 0.02, 9, false);
    for i in 0..8 {
        let turn = i as f32 * 2.4;
        let out = vec3(turn.cos(), 0.0, turn.sin()) * height * 0.24 * (1.0 - 0.08 * i as f32);
        let clump = fork + out + Vec3::Y * height * (0.12 + 0.06 * i as f32);
        s.with_material(bark);
        s.tapered_tube(
            &[fork, fork.lerp(clump, 0.6) - Vec3::Y * 0.06 * height, clump],
            &|t| height * (0.014 - 0.011 * t),
            6,
            false,
        );
        s.with_material(leaves);
        for _ in 0..42 {
            let outward = props::random_direction(rng);
            let center = clump + outward * vec3(1.0, 0.8, 1.0) * height * 0.14;
            props::leaf_card(s, center, outward, height * 0.055, rng);
        }
    }
}

fn garden(s: &mut SceneBuilder, p: &Palette, seed: u32, rng: &mut Pcg32) {
    let grass = props::textured(s, paint::grass("grass", 512, seed + 20, vec3(0.38, 0.56, 0.24)), 3.0, 0.95);
    let hills = props::textured(s, paint::grass("hills", 256, seed + 21, vec3(0.42, 0.56, 0.4)), 30.0, 0.95);
    let bark = props::textured(s, paint::bark("bark", 256, seed + 22, vec3(0.4, 0.3, 0.22)), 0.8, 0.95);
    s.object("lawn").with_material(grass);
    s.height_field(24, 24, vec2(-40.0, -60.0), vec2(40.0, -3.3), |x, z| {
        -0.3 + 0.25 * (x * 0.2).sin() * (z * 0.17).cos() + 0.02 * (-3.3 - z).max(0.0)
    });
    s.object("hills").with_material(hills);
    s.height_field(48, 16, vec2(-260.0, -320.0), vec2(260.0, -58.0), |x, z| {
        let away = ((-58.0 - z) / 200.0).clamp(0.0, 1.0);
        away * (34.0 + 16.0 * (x * 0.03 + 1.0).sin() + 9.0 * (x * 0.071 + z * 0.02).sin()) + 0.3
    });
    for (i, (x, z, height)) in
        [(-3.2, -8.5, 4.6), (4.4, -11.0, 5.6), (-9.5, -17.0, 7.0), (11.0, -22.0, 8.0), (0.6, -26.0, 7.0)]
            .into_iter()
            .enumerate()
    {
        s.object(&format!("tree-{i}"));
        s.within(placed(vec3(x, -0.3, z), i as f32), |s| tree(s, bark, p.card, height, rng));
    }
    // A picket fence.
    s.object("fence").with_material(p.white);
    for i in 0..60 {
        let x = -9.0 + 0.3 * i as f32;
        s.cuboid(vec3(x, -0.35, -13.53), vec3(x + 0.09, 0.75, -13.5));
    }
    for y in [0.0, 0.5] {
        s.cuboid(vec3(-9.1, y, -13.56), vec3(9.0, y + 0.08, -13.53));
    }
}

/// Generates the scene; see [`super::BUILTINS`].
pub fn build(seed: u64, mut s: SceneBuilder) -> Scene {
    let mut rng = random(seed, "talk");
    let noise = rng.random::<u32>() >> 8;
    let p = palette(&mut s, noise);
    room(&mut s, &p, noise);
    table(&mut s, &p, &mut rng);
    let mut movers = Movers::default();
    people(&mut s, &p, noise, &mut movers, &mut rng);
    furniture(&mut s, &p, noise, &mut rng);
    garden(&mut s, &p, noise, &mut rng);
    let lamp = |position: Vec3, color: Vec3, range: f32| PointLight { position, color, range };
    let walk = [
        (1.9, 3.6, -0.3),
        (1.65, 3.1, -0.3),
        (1.4, 2.6, -0.35),
        (1.1, 2.15, -0.4),
        (0.75, 1.75, -0.45),
        (0.4, 1.4, -0.45),
        (0.05, 1.2, -0.4),
        (-0.25, 1.12, -0.1),
        (-0.55, 1.1, 0.25),
        (-0.85, 1.1, 0.5),
        (-1.15, 1.0, 0.7),
        (-1.4, 0.8, 0.85),
    ];
    let mut model = s.finish();
    Scene {
        motion: movers.finish(&mut model),
        model,
        sky: Sky {
            sun_direction: vec3(-0.35, 0.55, -0.75).normalize(),
            sun_color: vec3(3.2, 2.8, 2.2),
            zenith: vec3(0.4, 0.5, 0.7),
            horizon: vec3(0.75, 0.78, 0.8),
            ground: vec3(0.34, 0.28, 0.22),
        },
        lights: vec![
            lamp(vec3(0.0, 1.78, 0.0), vec3(1.5, 1.15, 0.75), 5.0),
            lamp(vec3(1.75, 1.55, -1.9), vec3(1.1, 0.8, 0.48), 5.0),
            lamp(vec3(0.6, 2.3, 2.6), vec3(1.0, 0.92, 0.8), 6.5),
            lamp(vec3(0.0, 1.7, -2.6), vec3(0.9, 1.0, 1.15), 5.0),
        ],
        viewpoints: walk
            .iter()
            .map(|&(x, z, tx)| Viewpoint { position: vec3(x, 1.5, z), target: vec3(tx, 1.12, -0.1) })
            .collect(),
        ..Scene::default()
    }
}
