//! Stylised people for the built-in scenes.
//!
//! A figure has its own frame: origin on the floor, facing +Z, so that its left side is +X. Pairs are left first.

use std::f32::consts::{PI, TAU};

use glam::{Affine3A, Mat3, Quat, Vec2, Vec3, vec2, vec3};

use super::build::SceneBuilder;
use super::sculpt::Clay;

/// Half the width in metres that a face picture covers; see [`head`].
pub const FACE_HALF: f32 = 0.15;

/// The positions of a figure's joints in metres.
#[derive(Clone, Copy, Debug)]
pub struct Joints {
    /// Centre of the head.
    pub head: Vec3,
    /// Rotation of the head; the identity looks along +Z.
    pub head_turn: Quat,
    /// Lower end of the neck.
    pub neck: Vec3,
    /// Middle of the chest.
    pub chest: Vec3,
    /// Waist.
    pub waist: Vec3,
    /// Middle of the hips.
    pub pelvis: Vec3,
    /// Shoulders.
    pub shoulders: [Vec3; 2],
    /// Elbows.
    pub elbows: [Vec3; 2],
    /// Wrists.
    pub wrists: [Vec3; 2],
    /// Hips.
    pub hips: [Vec3; 2],
    /// Knees.
    pub knees: [Vec3; 2],
    /// Ankles.
    pub ankles: [Vec3; 2],
}

/// Draws clay with texture coordinates that run around the vertical axis through `axis`, `around` tiles per turn, and
/// up, one tile every `tile` metres.
pub fn clad(s: &mut SceneBuilder, clay: &Clay, cell: f32, axis: Vec3, around: f32, tile: f32) {
    clay.mesh(s, cell, |p, _| {
        let q = p - axis;
        vec2(q.x.atan2(q.z) / TAU * around, p.y / tile)
    });
}

/// Returns the frame of a head.
pub fn head_frame(joints: &Joints) -> Affine3A {
    Affine3A::from_rotation_translation(joints.head_turn, joints.head)
}

/// Builds a head with neck, in its own frame (centre between the ears, face along +Z). The material's picture is
/// projected along Z and covers [`FACE_HALF`] on all sides; its border must be plain skin.
pub fn head(s: &mut SceneBuilder, radii: Vec3, nose: f32, cell: f32) {
    let r = radii;
    let mut clay = Clay::new(0.035);
    clay.ball(vec3(0.0, 0.1 * r.y, -0.06 * r.z), vec3(r.x, r.y * 0.9, r.z))
        .ball(vec3(0.0, -0.4 * r.y, 0.16 * r.z), vec3(r.x * 0.68, r.y * 0.55, r.z * 0.72))
        .ball(vec3(0.0, -0.8 * r.y, 0.46 * r.z), vec3(r.x * 0.2, r.y * 0.15, r.z * 0.26));
    for side in [-1.0, 1.0] {
        clay.ball(vec3(side * 0.42 * r.x, -0.35 * r.y, 0.5 * r.z), vec3(r.x, r.y, r.z) * 0.34);
    }
    clay.limb(vec3(0.0, -0.4 * r.y, -0.2 * r.z), vec3(0.0, -1.5 * r.y, -0.42 * r.z), 0.38 * r.x, 0.42 * r.x);
    let mut detail = Clay::new(0.012);
    detail.turned_ball(
        vec3(0.0, -0.2 * r.y, 0.93 * r.z + 0.3 * nose),
        vec3(0.011, 0.02, 0.012 + nose),
        Quat::from_rotation_x(0.5),
    );
    let uv = |p: Vec3, _: Vec3| {
        let flat = (p.truncate() / (2.0 * FACE_HALF) + 0.5).clamp(Vec2::splat(0.02), Vec2::splat(0.98));
        // The back of the head shows the picture's border.
        if p.z > -0.2 * r.z { flat } else { vec2(if p.x > 0.0 { 0.98 } else { 0.02 }, flat.y) }
    };
    clay.mesh(s, cell, uv);
    detail.mesh(s, cell * 0.6, uv);
}

/// Builds the two ears of a head of these radii, in its frame.
pub fn ears(s: &mut SceneBuilder, radii: Vec3) {
    for side in [-1.0, 1.0] {
        let turn = Quat::from_rotation_y(side * 0.35);
        s.within(
            Affine3A::from_rotation_translation(
                turn,
                vec3(side * radii.x * 0.98, -0.14 * radii.y, -0.05 * radii.z),
            ),
            |s| {
                s.ellipsoid(Vec3::ZERO, vec3(0.011, 0.03, 0.02), 10, 14);
            },
        );
    }
}

/// The pose of a hand.
#[derive(Clone, Copy, Debug)]
pub struct Hand {
    /// The position of the wrist.
    pub wrist: Vec3,
    /// Direction of the outstretched fingers.
    pub along: Vec3,
    /// Direction out of the palm.
    pub palm: Vec3,
    /// 0 for outstretched fingers, 1 for a fist.
    pub curl: f32,
    /// Side of the thumb: +1 or -1 along `along` x `palm`.
    pub thumb: f32,
    /// Size, 1 for a hand 19 cm long.
    pub scale: f32,
}

/// Builds a hand with five fingers.
pub fn hand(s: &mut SceneBuilder, hand: &Hand, cell: f32) {
    let d = hand.along.normalize_or(Vec3::Z);
    let n = hand.palm.reject_from_normalized(d).normalize_or(d.any_orthonormal_vector());
    let t = d.cross(n);
    let k = hand.scale;
    let at = |along: f32, across: f32, out: f32| hand.wrist + (d * along + t * across + n * out) * k;
    let mut clay = Clay::new(0.014 * k);
    let frame = Quat::from_mat3(&Mat3::from_cols(t, d, n * t.cross(d).dot(n).signum()));
    clay.limb(at(-0.03, 0.0, 0.0), at(0.03, 0.0, 0.0), 0.026 * k, 0.027 * k);
    clay.turned_ball(at(0.058, 0.0, 0.0), vec3(0.041, 0.05, 0.018) * k, frame);
    for i in 0..4 {
        let x = (i as f32 - 1.5) * 0.021;
        let length = [0.038, 0.044, 0.042, 0.033][if hand.thumb > 0.0 { 3 - i } else { i }];
        let mut from = at(0.09 - 0.006 * (i as f32 - 1.5).abs(), x, 0.0);
        for joint in 0..3 {
            let bend = hand.curl * (0.5 + joint as f32 * 0.65) + 0.08;
            let spread = t * (x * 3.0 * (1.0 - hand.curl));
            let to = from
                + (d * bend.cos() + n * bend.sin() + spread).normalize()
                    * length
                    * k
                    * (1.0 - 0.22 * joint as f32);
            let thick = (0.0105 - 0.0012 * joint as f32) * k;
            clay.limb(from, to, thick, thick - 0.001 * k);
            from = to;
        }
    }
    let root = at(0.03, hand.thumb * 0.032, 0.006);
    let tip = root
        + (d * 0.62 + t * hand.thumb * (0.75 - 0.4 * hand.curl) + n * (0.15 + 0.5 * hand.curl)).normalize()
            * 0.045
            * k;
    clay.limb(root, tip, 0.015 * k, 0.012 * k);
    clay.limb(
        tip,
        tip + (d * 0.85 + t * hand.thumb * 0.25 + n * (0.1 + 0.7 * hand.curl)).normalize() * 0.032 * k,
        0.012 * k,
        0.0095 * k,
    );
    clay.mesh(s, cell, |p, _| vec2(p.x, p.y));
}

/// Builds a lock of hair from a root to a tip, bent by two handles: a tapered, slightly flattened tube.
pub fn lock(s: &mut SceneBuilder, points: [Vec3; 4], radius: f32, flat: f32, cells: [usize; 2]) {
    let curve = |t: f32| {
        let [a, b, c, d] = points;
        let u = 1.0 - t;
        a * (u * u * u) + b * (3.0 * u * u * t) + c * (3.0 * u * t * t) + d * (t * t * t)
    };
    let [sides, segments] = cells;
    let mut lift = points[1] - points[0];
    s.surface(sides, segments, true, |u, v| {
        let t = v.min(0.999);
        let forward = (curve((t + 0.01).min(1.0)) - curve((t - 0.01).max(0.0))).normalize_or(Vec3::NEG_Y);
        // Carried from row to row, so that curls do not turn the tube inside out.
        lift = lift.reject_from_normalized(forward).normalize_or(forward.any_orthonormal_vector());
        let across = forward.cross(lift);
        let r = radius * (1.0 - 0.35 * (1.0 - v).powi(3)) * (1.0 - v * v * v).max(0.0);
        let angle = if u == 1.0 { 0.0 } else { u * TAU };
        let p = curve(v) + lift * (angle.sin() * r * flat) + across * (-angle.cos() * r);
        (p, vec2(u, v * 2.0))
    });
}

/// Returns a point on a head's surface: `turn` about Y from +Z towards +X, `rise` above the horizon, in radians.
pub fn on_head(radii: Vec3, turn: f32, rise: f32, scale: f32) -> Vec3 {
    vec3(turn.sin() * rise.cos(), rise.sin(), turn.cos() * rise.cos()) * radii * scale
        + vec3(0.0, 0.1 * radii.y, -0.06 * radii.z)
}

/// Builds a shoe with a sole: from the heel's side of the ankle forward along `toe`, on the floor below.
pub fn shoe(s: &mut SceneBuilder, [upper, sole]: [usize; 2], ankle: Vec3, toe: Vec3, size: f32, cell: f32) {
    let floor = ankle.with_y(ankle.y - 0.075 * size);
    let turn = Quat::from_rotation_arc(Vec3::Z, toe.with_y(0.0).normalize_or(Vec3::Z));
    s.within(Affine3A::from_scale_rotation_translation(Vec3::splat(size), turn, floor), |s| {
        let mut clay = Clay::new(0.04);
        clay.limb(vec3(0.0, 0.05, -0.03), vec3(0.0, 0.045, 0.1), 0.04, 0.04)
            .ball(vec3(0.0, 0.038, 0.13), vec3(0.048, 0.036, 0.06))
            .limb(vec3(0.0, 0.06, -0.02), vec3(0.0, 0.12, -0.01), 0.042, 0.046);
        s.with_material(upper);
        clay.mesh(s, cell, |p, _| vec2(p.x, p.z) * 4.0);
        s.with_material(sole);
        let rim: Vec<Vec2> = (0..28)
            .map(|i| {
                let angle = i as f32 / 28.0 * TAU;
                let wide = 0.046 + 0.006 * angle.sin();
                vec2(angle.cos() * wide, 0.05 + angle.sin() * 0.128)
            })
            .collect();
        let upright = Affine3A::from_rotation_x(-PI / 2.0);
        s.within(upright, |s| {
            let outline: Vec<Vec2> = rim.iter().rev().map(|p| vec2(p.x, -p.y)).collect();
            s.extrude(&outline, 0.0, 0.028, true);
        });
    });
}
