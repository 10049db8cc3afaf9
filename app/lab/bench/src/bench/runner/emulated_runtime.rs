//! A stand-in for a headset's runtime that makes frames (XR_FB_space_warp, XR_EXT_frame_synthesis), on the CPU.
//!
//! Each pixel takes the depth and the vector of its block, is placed in space by the frame's pose, and its former place by
//! the former pose. It goes on in a straight line through both, and is projected by the newest pose, which is exact. Points
//! are splatted with a depth test, and holes filled along rows from the farther side.

use glam::{DMat3, DVec2, DVec3};

use yoro::eyes::{Pose, View};

/// What an application submits of one eye. Rows run from the bottom.
pub(super) struct Submitted<'a> {
    /// RGBA at the eye's size.
    pub rgba: &'a [u8],
    /// Vectors (depth in normalized device coordinates is 0 to 1) and depth, at a size of their own.
    pub vectors: &'a [[f32; 4]],
    pub depth: &'a [f32],
    pub vector_size: [u32; 2],
    /// The eye in this frame and in the former one. The size is that of the colour.
    pub now: View,
    pub former: View,
}

/// Half the side of a point, in pixels.
const REACH: f64 = 0.75;
/// Points within this share of the nearest one's inverse distance are one surface.
const SAME_SURFACE: f64 = 0.96;
/// The least inverse distance: farther away, nothing moves by a pixel.
const FARTHEST: f64 = 1e-4;

/// A place in the eye's image and the inverse distance there.
struct Point {
    at: DVec2,
    inverse: f64,
}

impl Submitted<'_> {
    /// Returns the eye's RGBA at the newest pose, after a part of the step between the two frames.
    pub fn extrapolate(&self, newest: Pose, ahead: f64) -> Vec<u8> {
        let (now, then) =
            (Camera::new(&self.now, self.now.pose), Camera::new(&self.former, self.former.pose));
        let shown = Camera::new(&self.now, newest);
        let (c, m) = self.now.depth.inverse_distance_law();
        let (former_c, former_m) = self.former.depth.inverse_distance_law();
        let place = |x: usize, y: usize| {
            let block = [x, y].map(|n| n as f64 + 0.5);
            let [bx, by] = [0, 1]
                .map(|i| (block[i] * f64::from(self.vector_size[i]) / f64::from(self.now.size[i])) as usize);
            let texel = by * self.vector_size[0] as usize + bx;
            let (depth, vector) = (f64::from(self.depth[texel]), self.vectors[texel].map(f64::from));
            let ndc = now.to_ndc(DVec2::from(block));
            let inverse = (c + m * depth).max(FARTHEST);
            let before = (former_c + former_m * (depth - vector[2])).max(FARTHEST);
            let here = now.in_space(ndc, inverse);
            let was = then.in_space(ndc - DVec2::new(vector[0], vector[1]), before);
            shown.project(here + (here - was) * ahead)
        };
        self.splatted(place)
    }

    /// Returns the eye's RGBA turned to the newest pose, as if everything were far away.
    pub fn rotate(&self, newest: Pose) -> Vec<u8> {
        let at_origin = |pose: Pose| Pose { position: glam::Vec3::ZERO, ..pose };
        let now = Camera::new(&self.now, at_origin(self.now.pose));
        let shown = Camera::new(&self.now, at_origin(newest));
        self.splatted(|x, y| {
            let ndc = now.to_ndc(DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
            shown.project(now.in_space(ndc, 1.0))
        })
    }

    fn splatted(&self, place: impl Fn(usize, usize) -> Point) -> Vec<u8> {
        let [width, height] = self.now.size.map(|n| n as usize);
        let points: Vec<Point> = (0..width * height).map(|i| place(i % width, i / width)).collect();
        let covered = |point: &Point| {
            let range = |at: f64, count: usize| {
                let (low, high) =
                    ((at - REACH).ceil().max(0.0), (at + REACH).floor().min(count as f64 - 1.0));
                if high >= low { low as usize..high as usize + 1 } else { 0..0 }
            };
            // What is behind the eye is not seen.
            let is_ahead = point.inverse > 0.0 && point.at.is_finite();
            let rows = if is_ahead { range(point.at.y, height) } else { 0..0 };
            let columns = range(point.at.x, width);
            rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
        };
        let mut nearest = vec![0.0f64; width * height];
        for point in &points {
            for (x, y) in covered(point) {
                let slot = &mut nearest[y * width + x];
                *slot = slot.max(point.inverse);
            }
        }
        // For each pixel, the mean place in the source of the nearest surface's points, and their weight.
        let mut sums = vec![(DVec2::ZERO, 0.0f64); width * height];
        for (i, point) in points.iter().enumerate() {
            let source = DVec2::new((i % width) as f64, (i / width) as f64);
            for (x, y) in covered(point) {
                if point.inverse >= SAME_SURFACE * nearest[y * width + x] {
                    let off = DVec2::new(x as f64, y as f64) - point.at;
                    let weight = (1.0 - off.x.abs()).max(1e-3) * (1.0 - off.y.abs()).max(1e-3);
                    let (sum, weights) = &mut sums[y * width + x];
                    *sum += weight * (source + off);
                    *weights += weight;
                }
            }
        }
        let mut from: Vec<Option<DVec2>> =
            sums.iter().map(|(sum, weight)| (*weight > 0.0).then(|| *sum / *weight)).collect();
        for (places, depths) in from.chunks_mut(width).zip(nearest.chunks(width)) {
            fill_row(places, depths);
        }
        let colors = from.iter().enumerate().flat_map(|(i, place)| {
            let own = DVec2::new((i % width) as f64, (i / width) as f64);
            self.bilinear(place.unwrap_or(own))
        });
        colors.collect()
    }

    fn bilinear(&self, at: DVec2) -> [u8; 4] {
        let [width, height] = self.now.size.map(|n| n as usize);
        let last = DVec2::new((width - 1) as f64, (height - 1) as f64);
        let at = at.clamp(DVec2::ZERO, last);
        let (low, part) = (at.floor(), at - at.floor());
        let texel = |dx: usize, dy: usize, channel: usize| {
            let (x, y) = ((low.x as usize + dx).min(width - 1), (low.y as usize + dy).min(height - 1));
            f64::from(self.rgba[(y * width + x) * 4 + channel])
        };
        std::array::from_fn(|channel| {
            let row = |dy| texel(0, dy, channel) * (1.0 - part.x) + texel(1, dy, channel) * part.x;
            (row(0) * (1.0 - part.y) + row(1) * part.y).round() as u8
        })
    }
}

/// Fills the holes of a row from their farther side.
fn fill_row(places: &mut [Option<DVec2>], inverse: &[f64]) {
    let mut x = 0;
    while x < places.len() {
        if places[x].is_some() {
            x += 1;
            continue;
        }
        let end = (x..places.len()).find(|&i| places[i].is_some()).unwrap_or(places.len());
        let (before, after) = (x.checked_sub(1), Some(end).filter(|end| *end < places.len()));
        let side = match (before, after) {
            (Some(a), Some(b)) => Some(if inverse[a] <= inverse[b] { a } else { b }),
            (a, b) => a.or(b),
        };
        let fill = side.and_then(|side| places[side]);
        places[x..end].fill(fill);
        x = end;
    }
}

/// A view in f64.
struct Camera {
    position: DVec3,
    orientation: DMat3,
    /// Tangents of the image's middle, and half its extent.
    middle: DVec2,
    half: DVec2,
    size: DVec2,
}

impl Camera {
    fn new(view: &View, pose: Pose) -> Camera {
        let f = &view.frustum;
        let [left, right, bottom, top] = [f.left, f.right, f.bottom, f.top].map(f64::from);
        Camera {
            position: pose.position.as_dvec3(),
            orientation: DMat3::from_quat(pose.orientation.as_dquat().normalize()),
            middle: DVec2::new(left + right, bottom + top) / 2.0,
            half: DVec2::new(right - left, top - bottom) / 2.0,
            size: DVec2::new(f64::from(view.size[0]), f64::from(view.size[1])),
        }
    }

    fn to_ndc(&self, pixel: DVec2) -> DVec2 {
        2.0 * pixel / self.size - 1.0
    }

    fn in_space(&self, ndc: DVec2, inverse: f64) -> DVec3 {
        let ray = (self.middle + ndc * self.half).extend(-1.0);
        self.position + self.orientation * (ray / inverse)
    }

    /// Returns the index of a pixel, whose middle is an integer.
    fn project(&self, place: DVec3) -> Point {
        let local = self.orientation.transpose() * (place - self.position);
        let inverse = -1.0 / local.z;
        let ndc = (local.truncate() * inverse - self.middle) / self.half;
        Point { at: (ndc + 1.0) / 2.0 * self.size - 0.5, inverse }
    }
}
