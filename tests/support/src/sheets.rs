//! Rectangles in front of a wall, seen from any pose: colour and depth that are consistent between views.

use glam::{DVec3, Quat, Vec3};

use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, Frustum, Pose, View};

pub const SIZE: [u32; 2] = [160, 48];

/// An upright rectangle parallel to the X and Y axes, in metres: left, right, bottom, top, z.
pub type Sheet = [f64; 5];

const WALL: Sheet = [-50.0, 50.0, -50.0, 50.0, -6.0];
pub const SHEETS: [Sheet; 5] = [
    WALL,
    [-0.5, -0.2, -9.0, 9.0, -1.0],
    [0.15, 0.4, -0.3, 0.05, -0.8],
    [0.6, 1.2, -0.2, 0.5, -2.0],
    [-1.6, -0.9, -0.5, 0.1, -3.0],
];

/// The colour and depth of a view, with rows from the bottom.
pub struct Picture {
    pub rgba: Vec<u8>,
    pub depth: Vec<f32>,
}

/// Converts a point in the world to the space of a view's eye.
pub fn local(view: &View, world: DVec3) -> DVec3 {
    view.pose.orientation.as_dquat().inverse() * (world - view.pose.position.as_dvec3())
}

/// Returns the point that a pixel of a view shows at a distance along the axis.
pub fn unproject(view: &View, [x, y]: [f64; 2], z: f64) -> DVec3 {
    let f = view.frustum;
    let tangent = |at: f64, low: f32, wide: f32, n: u32| f64::from(low) + at / f64::from(n) * f64::from(wide);
    let x = tangent(x, f.left, f.width(), view.size[0]);
    let y = tangent(y, f.bottom, f.height(), view.size[1]);
    view.pose.position.as_dvec3() + view.pose.orientation.as_dquat() * (DVec3::new(x, y, -1.0) * z)
}

/// Renders by casting a ray for each pixel. Colours vary slowly, so that resampling changes them little.
pub fn render(view: &View, sheets: &[Sheet]) -> Picture {
    let [w, h] = view.size;
    let mut picture = Picture { rgba: Vec::new(), depth: Vec::new() };
    for i in 0..w * h {
        let pixel = [f64::from(i % w) + 0.5, f64::from(i / w) + 0.5];
        let from = view.pose.position.as_dvec3();
        let ray = unproject(view, pixel, 1.0) - from;
        let hits = sheets.iter().enumerate().filter_map(|(n, [left, right, bottom, top, z])| {
            let t = (z - from.z) / ray.z;
            let at = from + t * ray;
            let inside = t > 0.0 && (*left..*right).contains(&at.x) && (*bottom..*top).contains(&at.y);
            inside.then_some((n, t, at))
        });
        let (n, _, at) = hits.min_by(|a, b| a.1.total_cmp(&b.1)).expect("a wall behind all");
        let wave = |x: f64| (127.0 + 100.0 * x.sin()) as u8;
        picture.rgba.extend([wave(1.5 * at.x + n as f64), wave(2.0 * at.y), 40 * n as u8, 255]);
        picture.depth.push(view.depth.depth(-local(view, at).z as f32));
    }
    picture
}

pub fn eyes(head: Pose, dominant: Eye, ipd: f32, convention: DepthConvention) -> EyePair {
    let depth = DepthRange { near: 0.3, far: 100.0, convention };
    EyePair::parallel(head, Frustum::symmetric(0.5, 10.0 / 3.0), ipd, depth, SIZE, dominant)
}

/// Returns the pose of a head that has moved and turned for a number of frames.
pub fn moved(frames: f32) -> Pose {
    Pose {
        position: frames * Vec3::new(0.008, -0.003, 0.01),
        orientation: Quat::from_euler(glam::EulerRot::YXZ, 0.012 * frames, 0.004 * frames, -0.003 * frames),
    }
}

/// Returns a picture in strips from row 0 on, each rendered from its own view, or from `other` if it is `None`.
pub fn in_strips(strips: &[Option<View>], other: &View) -> Picture {
    let mut picture = Picture { rgba: Vec::new(), depth: Vec::new() };
    let [width, height] = other.size.map(|n| n as usize);
    let rows = height.div_ceil(strips.len());
    for (i, strip) in strips.iter().enumerate() {
        let whole = render(strip.as_ref().unwrap_or(other), &SHEETS);
        let [from, to] = [i * rows, (i + 1) * rows].map(|row| row.min(height) * width);
        picture.rgba.extend(&whole.rgba[from * 4..to * 4]);
        picture.depth.extend(&whole.depth[from..to]);
    }
    picture
}
