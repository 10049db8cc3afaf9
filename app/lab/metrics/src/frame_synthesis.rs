//! A stand-in for a headset's runtime that makes frames (XR_FB_space_warp, XR_EXT_frame_synthesis), on the CPU.
//!
//! Each pixel takes the depth and the motion vector of its block. It is placed in space by the frame's camera, and its
//! previous place by the previous camera. It goes on in a straight line through both and is projected by the newest
//! pose, which is exact. Points are splatted with a depth test, and holes are filled along rows from the farther side.

use glam::{DMat3, DVec2, DVec3, Quat, Vec3};

/// The position and orientation of an eye in a space that stays where it is. The eye looks along -z, with y upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyePose {
    /// The position in metres.
    pub position: Vec3,
    /// The rotation from the eye's axes to those of the space.
    pub orientation: Quat,
}

/// An eye as it was rendered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeCamera {
    /// The pose.
    pub pose: EyePose,
    /// Tangents of the image's left, right, bottom and top edges.
    pub tangents: [f32; 4],
    /// The inverse distances, per metre, of the depths 0 and 1. Those between are linear in depth.
    pub inverse_distances: [f64; 2],
}

/// What an application submits of one eye. Rows run from the bottom.
#[derive(Clone, Copy, Debug)]
pub struct SubmittedEye<'a> {
    /// RGBA of every pixel.
    pub rgba: &'a [u8],
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Normalized device coordinates minus those of the same surface in the previous frame: x to the right, y upwards,
    /// z from 0 to 1.
    pub vectors: &'a [Vec3],
    /// Depth from 0 to 1, of the same surfaces.
    pub depth: &'a [f32],
    /// Width and height of vectors and depth.
    pub vector_size: [u32; 2],
    /// The eye in this frame.
    pub camera: EyeCamera,
    /// The same eye in the previous frame.
    pub previous: EyeCamera,
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

impl SubmittedEye<'_> {
    /// Returns the eye's RGBA at the newest pose, after `ahead` steps of the length of that between the two frames.
    pub fn extrapolate(&self, newest: EyePose, ahead: f64) -> Vec<u8> {
        let project = |camera: &EyeCamera, pose| Projection::new(camera, pose, self.size);
        let now = project(&self.camera, self.camera.pose);
        let then = project(&self.previous, self.previous.pose);
        let shown = project(&self.camera, newest);
        let inverse = |camera: &EyeCamera, depth: f64| {
            let [at_0, at_1] = camera.inverse_distances;
            (at_0 + (at_1 - at_0) * depth).max(FARTHEST)
        };
        self.splat(|x, y| {
            let pixel = [x, y].map(|n| n as f64 + 0.5);
            let [bx, by] = [0, 1]
                .map(|i| (pixel[i] * f64::from(self.vector_size[i]) / f64::from(self.size[i])) as usize);
            let texel = by * self.vector_size[0] as usize + bx;
            let (depth, vector) = (f64::from(self.depth[texel]), self.vectors[texel].as_dvec3());
            let ndc = now.to_ndc(DVec2::from(pixel));
            let here = now.in_space(ndc, inverse(&self.camera, depth));
            let was = then.in_space(ndc - vector.truncate(), inverse(&self.previous, depth - vector.z));
            shown.project(here + (here - was) * ahead)
        })
    }

    /// Returns the eye's RGBA turned to the newest pose, as if everything were far away.
    pub fn rotate(&self, newest: EyePose) -> Vec<u8> {
        let turned =
            |pose| Projection::new(&self.camera, EyePose { position: Vec3::ZERO, ..pose }, self.size);
        let (now, shown) = (turned(self.camera.pose), turned(newest));
        self.splat(|x, y| {
            let ndc = now.to_ndc(DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
            shown.project(now.in_space(ndc, 1.0))
        })
    }

    /// Draws each pixel where `place` moves it.
    fn splat(&self, place: impl Fn(usize, usize) -> Point) -> Vec<u8> {
        let [width, height] = self.size.map(|n| n as usize);
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
            self.sample(place.unwrap_or(own))
        });
        colors.collect()
    }

    /// Returns the colour at an index of pixels, interpolated between four.
    fn sample(&self, at: DVec2) -> [u8; 4] {
        let [width, height] = self.size.map(|n| n as usize);
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

/// A camera at a pose, in f64.
struct Projection {
    position: DVec3,
    orientation: DMat3,
    /// Tangents of the image's middle, and half its extent.
    middle: DVec2,
    half: DVec2,
    size: DVec2,
}

impl Projection {
    fn new(camera: &EyeCamera, pose: EyePose, size: [u32; 2]) -> Projection {
        let [left, right, bottom, top] = camera.tangents.map(f64::from);
        Projection {
            position: pose.position.as_dvec3(),
            orientation: DMat3::from_quat(pose.orientation.as_dquat().normalize()),
            middle: DVec2::new(left + right, bottom + top) / 2.0,
            half: DVec2::new(right - left, top - bottom) / 2.0,
            size: DVec2::new(f64::from(size[0]), f64::from(size[1])),
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

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: usize = 192;
    const BLOCK: usize = 4;
    const BLOCKS: usize = SIZE / BLOCK;
    const TANGENTS: [f32; 4] = [-1.1, 0.9, -0.8, 1.0];
    const NEAR_FAR: [f32; 2] = [0.1, 40.0];
    /// Seconds from one rendered frame to the next.
    const INTERVAL: f32 = 1.0 / 36.0;
    /// The velocity of a thing in metres a second: 0 is the room, 1 a ball.
    const VELOCITIES: [Vec3; 2] = [Vec3::ZERO, Vec3::new(-1.2, 1.0, 2.5)];

    /// The head steps aside, rises, walks and turns.
    fn head(time: f32) -> EyePose {
        EyePose {
            position: Vec3::new(0.9, 0.5, -0.8) * time,
            orientation: Quat::from_rotation_y(0.6 * time) * Quat::from_rotation_x(0.3 * time),
        }
    }

    fn camera(pose: EyePose) -> EyeCamera {
        EyeCamera {
            pose,
            tangents: TANGENTS,
            inverse_distances: NEAR_FAR.map(|metres| 1.0 / f64::from(metres)),
        }
    }

    /// The nearest surface along a ray.
    struct Hit {
        distance: f32,
        color: [u8; 3],
        thing: usize,
    }

    fn hit(origin: Vec3, ray: Vec3, time: f32) -> Hit {
        let wall = ((Vec3::splat(2.5) * ray.signum() - origin) / ray).min_element();
        let centre = Vec3::new(0.1, -0.1, -1.6) + VELOCITIES[1] * time;
        let (a, b) = (ray.length_squared(), ray.dot(centre - origin));
        let inside = b * b - a * ((centre - origin).length_squared() - 0.16);
        let ball = if inside > 0.0 { (b - inside.sqrt()) / a } else { -1.0 };
        let (distance, thing, at) = if ball > 0.0 && ball < wall {
            (ball, 1, origin + ray * ball - centre)
        } else {
            (wall, 0, origin + ray * wall)
        };
        let waves = (at * if thing == 1 { 26.0 } else { 14.0 }).map(f32::sin);
        let mixed = [waves.x + waves.y, waves.y - waves.z, waves.z * waves.x];
        Hit { distance, color: mixed.map(|c| (128.0 + 55.0 * c) as u8), thing }
    }

    fn ray([x, y]: [usize; 2]) -> Vec3 {
        let [left, right, bottom, top] = TANGENTS;
        let [x, y] = [x, y].map(|n| (n as f32 + 0.5) / SIZE as f32);
        Vec3::new(left + x * (right - left), bottom + y * (top - bottom), -1.0)
    }

    fn picture(time: f32) -> Vec<u8> {
        let EyePose { position, orientation } = head(time);
        let pixel = |i: usize| {
            let [r, g, b] = hit(position, orientation * ray([i % SIZE, i / SIZE]), time).color;
            [r, g, b, 255]
        };
        (0..SIZE * SIZE).flat_map(pixel).collect()
    }

    /// Returns the normalized device coordinates of a point in space.
    fn ndc(eye: EyePose, point: Vec3) -> Vec3 {
        let seen = eye.orientation.inverse() * (point - eye.position);
        let [left, right, bottom, top] = TANGENTS;
        let [near, far] = NEAR_FAR;
        let [x, y] = [seen.x / -seen.z, seen.y / -seen.z];
        Vec3::new(
            2.0 * (x - left) / (right - left) - 1.0,
            2.0 * (y - bottom) / (top - bottom) - 1.0,
            (1.0 / -seen.z - 1.0 / near) / (1.0 / far - 1.0 / near),
        )
    }

    /// Returns true vectors and depth at a quarter of the size: those of the nearest pixel of each block.
    fn vectors(time: f32) -> (Vec<Vec3>, Vec<f32>) {
        let (now, was) = (head(time), head(time - INTERVAL));
        let of_block = |i: usize| {
            let samples = (0..BLOCK * BLOCK).map(|n| {
                let at = [i % BLOCKS * BLOCK + n % BLOCK, i / BLOCKS * BLOCK + n / BLOCK];
                let ray = now.orientation * ray(at);
                let Hit { distance, thing, .. } = hit(now.position, ray, time);
                (distance, now.position + ray * distance, thing)
            });
            let (_, point, thing) = samples.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
            let here = ndc(now, point);
            (here - ndc(was, point - VELOCITIES[thing] * INTERVAL), here.z)
        };
        (0..BLOCKS * BLOCKS).map(of_block).unzip()
    }

    fn psnr(a: &[u8], b: &[u8]) -> f64 {
        let squares: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum();
        10.0 * (255f64.powi(2) * a.len() as f64 / squares).log10()
    }

    /// Half of each vector is an error half as large. A wrong z is not among them: in the picture it is an error of the
    /// second order, the square of the change of distance.
    #[test]
    fn vectors_of_a_wrong_sign_or_convention_are_seen() {
        type Change = fn(Vec3) -> Vec3;
        let (rgba, (true_vectors, depth)) = (picture(INTERVAL), vectors(INTERVAL));
        let (later, truth) = (head(1.5 * INTERVAL), picture(1.5 * INTERVAL));
        let quality = |change: Change| {
            let vectors: Vec<Vec3> = true_vectors.iter().copied().map(change).collect();
            let eye = SubmittedEye {
                rgba: &rgba,
                size: [SIZE as u32; 2],
                vectors: &vectors,
                depth: &depth,
                vector_size: [BLOCKS as u32; 2],
                camera: camera(head(INTERVAL)),
                previous: camera(head(0.0)),
            };
            psnr(&eye.extrapolate(later, 0.5), &truth)
        };
        let right = quality(|v| v);
        let wrong: [(&str, f64, Change); 5] = [
            ("the last frame minus this one", 6.0, |v| -v),
            ("x to the left", 6.0, |v| v * Vec3::new(-1.0, 1.0, 1.0)),
            ("y down", 6.0, |v| v * Vec3::new(1.0, -1.0, 1.0)),
            ("pixels of 0 to 1", 3.0, |v| v * Vec3::new(0.5, 0.5, 1.0)),
            ("none", 6.0, |_| Vec3::ZERO),
        ];
        for (what, least, change) in wrong {
            let quality = quality(change);
            assert!(right - quality >= least, "{what}: {quality:.2} dB of {right:.2}");
        }
    }

    /// What does not move stays, whatever its depth, and what only turns is turned.
    #[test]
    fn a_still_frame_is_kept() {
        let rgba = picture(0.0);
        let (vectors, depth) = (vec![Vec3::ZERO; BLOCKS * BLOCKS], vectors(0.0).1);
        let eye = SubmittedEye {
            rgba: &rgba,
            size: [SIZE as u32; 2],
            vectors: &vectors,
            depth: &depth,
            vector_size: [BLOCKS as u32; 2],
            camera: camera(head(0.0)),
            previous: camera(head(0.0)),
        };
        assert!(psnr(&eye.extrapolate(head(0.0), 0.5), &rgba) > 50.0);
        assert!(psnr(&eye.rotate(head(0.0)), &rgba) > 50.0);
        let turned = EyePose { orientation: Quat::from_rotation_y(0.1), ..head(0.0) };
        assert!(psnr(&eye.rotate(turned), &rgba) < 25.0);
    }
}
