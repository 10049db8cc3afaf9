//! The frame between two that an application renders: each surface goes straight on from where it was.
//!
//! A runtime is free in how it makes frames of motion vectors. This one unprojects every pixel twice, as it is and as
//! its vector says that it was, each by the pose of its frame, and moves it on by a part of the difference. It
//! projects the result by the newest pose, keeps the nearest surface of each pixel, and fills what no surface reaches: a
//! crack between two rows from the farther of them, the rest from the farther side of its row.

use glam::{Vec2, Vec3};

use crate::space::{Pose, inverse};

/// A view with motion vectors. Rows are from the bottom.
pub struct View<'a> {
    /// The pose in the layer's space.
    pub pose: Pose,
    /// The tangents of the edges: left, right, up, down.
    pub edges: [f32; 4],
    /// Width and height of the picture in pixels.
    pub size: [usize; 2],
    /// The picture, four bytes a pixel.
    pub rgba: &'a [u8],
    /// Width and height of vectors and depth.
    pub vector_size: [usize; 2],
    /// NDC minus NDC in the last frame: x to the right, y up, z from 0 at `near_far[0]` to 1 at `near_far[1]`.
    pub vectors: &'a [Vec3],
    /// z of NDC.
    pub depth: &'a [f32],
    /// The distances in metres that 0 and 1 stand for.
    pub near_far: [f32; 2],
}

/// The same view in the last frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Before {
    /// The pose in the layer's space.
    pub pose: Pose,
    /// The tangents of the edges: left, right, up, down.
    pub edges: [f32; 4],
    /// The distances in metres that 0 and 1 stand for.
    pub near_far: [f32; 2],
}

/// Returns the point that an NDC stands for, in the space of the layer.
fn point(ndc: Vec3, pose: Pose, [left, right, up, down]: [f32; 4], [near, far]: [f32; 2]) -> Vec3 {
    let inverse = 1.0 / near + ndc.z * (1.0 / far - 1.0 / near);
    let distance = 1.0 / inverse.max(1e-6);
    let part = (Vec2::new(ndc.x, ndc.y) + 1.0) / 2.0;
    let tangents = Vec2::new(left + part.x * (right - left), down + part.y * (up - down));
    pose.1 + pose.0 * (tangents.extend(-1.0) * distance)
}

/// Returns the picture of a view as `newest` sees it, after `fraction` of the time from the last frame to this one.
/// `moved` is this frame's space in the last one's, as far as the application moved it: it is no motion.
pub fn between(view: &View, before: &Before, moved: Pose, newest: Pose, fraction: f32) -> Vec<u8> {
    let [width, height] = view.size;
    let [left, right, up, down] = view.edges;
    let (to_eye, unmoved) = (inverse(newest), inverse(moved));
    let mut nearest = vec![(f32::INFINITY, [0; 4]); width * height];
    for (i, pixel) in view.rgba.chunks_exact(4).enumerate() {
        let part =
            Vec2::new(((i % width) as f32 + 0.5) / width as f32, ((i / width) as f32 + 0.5) / height as f32);
        let [columns, rows] = view.vector_size;
        let texel = (part.y * rows as f32) as usize * columns + (part.x * columns as f32) as usize;
        let ndc = (part * 2.0 - 1.0).extend(view.depth[texel]);
        let now = point(ndc, view.pose, view.edges, view.near_far);
        let was = point(ndc - view.vectors[texel], before.pose, before.edges, before.near_far);
        let was = unmoved.1 + unmoved.0 * was;
        let seen = to_eye.1 + to_eye.0 * (now + (now - was) * fraction);
        if seen.z >= 0.0 {
            continue;
        }
        let x = (seen.x / -seen.z - left) / (right - left) * width as f32;
        let y = (seen.y / -seen.z - down) / (up - down) * height as f32;
        if (0.0..width as f32).contains(&x) && (0.0..height as f32).contains(&y) {
            let place = &mut nearest[y as usize * width + x as usize];
            if -seen.z < place.0 {
                *place = (-seen.z, [pixel[0], pixel[1], pixel[2], pixel[3]]);
            }
        }
    }
    close_cracks(&mut nearest, width);
    for row in nearest.chunks_exact_mut(width) {
        fill(row);
    }
    nearest.into_iter().flat_map(|(_, pixel)| pixel).collect()
}

/// Fills pixels that no surface reaches between two that one does, above and below: what comes nearer grows.
fn close_cracks(pixels: &mut [(f32, [u8; 4])], width: usize) {
    let reached = pixels.to_vec();
    for i in width..pixels.len().saturating_sub(width) {
        let (above, below) = (reached[i - width], reached[i + width]);
        if reached[i].0.is_infinite() && above.0.is_finite() && below.0.is_finite() {
            pixels[i] = if above.0 > below.0 { above } else { below };
        }
    }
}

/// Fills the pixels of a row that no surface reaches, from the farther side of each gap.
fn fill(row: &mut [(f32, [u8; 4])]) {
    let mut x = 0;
    while x < row.len() {
        if row[x].0.is_finite() {
            x += 1;
            continue;
        }
        let end = (x..row.len()).find(|&i| row[i].0.is_finite()).unwrap_or(row.len());
        let sides = [x.checked_sub(1), (end < row.len()).then_some(end)].into_iter().flatten();
        if let Some(from) = sides.max_by(|&a, &b| row[a].0.total_cmp(&row[b].0)) {
            let pixel = row[from];
            row[x..end].fill(pixel);
        }
        x = end;
    }
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;
    use crate::space::compose;

    const SIZE: usize = 192;
    const BLOCK: usize = 4;
    const EDGES: [f32; 4] = [-1.1, 0.9, 1.0, -0.8];
    const NEAR_FAR: [f32; 2] = [0.1, 40.0];
    /// Seconds from one rendered frame to the next.
    const INTERVAL: f32 = 1.0 / 36.0;

    /// The head: it steps aside, rises, walks and turns.
    fn head(time: f32) -> Pose {
        let turn = Quat::from_rotation_y(0.6 * time) * Quat::from_rotation_x(0.3 * time);
        (turn, Vec3::new(0.9, 0.5, -0.8) * time)
    }

    /// The velocity of a thing in metres a second: 0 is the room, 1 a ball.
    const VELOCITIES: [Vec3; 2] = [Vec3::ZERO, Vec3::new(-1.2, 1.0, 2.5)];

    /// Returns distance, colour and number of what a ray meets.
    fn meet(origin: Vec3, ray: Vec3, time: f32) -> (f32, [u8; 3], usize) {
        let wall = ((Vec3::splat(2.5) * ray.signum() - origin) / ray).min_element();
        let centre = Vec3::new(0.1, -0.1, -1.6) + VELOCITIES[1] * time;
        let (a, b) = (ray.length_squared(), ray.dot(centre - origin));
        let inside = b * b - a * ((centre - origin).length_squared() - 0.16);
        let ball = if inside > 0.0 { (b - inside.sqrt()) / a } else { -1.0 };
        let (distance, number, at) = if ball > 0.0 && ball < wall {
            (ball, 1, origin + ray * ball - centre)
        } else {
            (wall, 0, origin + ray * wall)
        };
        let waves = (at * if number == 1 { 26.0 } else { 14.0 }).map(f32::sin);
        let mixed = [waves.x + waves.y, waves.y - waves.z, waves.z * waves.x];
        (distance, mixed.map(|c| (128.0 + 55.0 * c) as u8), number)
    }

    fn ray(x: f32, y: f32) -> Vec3 {
        let [left, right, up, down] = EDGES;
        Vec3::new(left + x * (right - left), down + y * (up - down), -1.0)
    }

    fn picture(time: f32) -> Vec<u8> {
        let (turn, place) = head(time);
        let pixel = |i: usize| {
            let part = [i % SIZE, i / SIZE].map(|n| (n as f32 + 0.5) / SIZE as f32);
            let [r, g, b] = meet(place, turn * ray(part[0], part[1]), time).1;
            [r, g, b, 255]
        };
        (0..SIZE * SIZE).flat_map(pixel).collect()
    }

    /// Returns NDC of a point in the eye's space.
    fn ndc(seen: Vec3) -> Vec3 {
        let [left, right, up, down] = EDGES;
        let [near, far] = NEAR_FAR;
        let [x, y] = [seen.x / -seen.z, seen.y / -seen.z];
        Vec3::new(
            2.0 * (x - left) / (right - left) - 1.0,
            2.0 * (y - down) / (up - down) - 1.0,
            (1.0 / -seen.z - 1.0 / near) / (1.0 / far - 1.0 / near),
        )
    }

    /// Returns true vectors and depth at a quarter of the size: those of the nearest sample of each block.
    fn vectors(time: f32) -> (Vec<Vec3>, Vec<f32>) {
        let (now, was) = (head(time), head(time - INTERVAL));
        let blocks = SIZE / BLOCK;
        let of_block = |i: usize| {
            let samples = (0..BLOCK * BLOCK).map(|n| {
                let [x, y] = [i % blocks * BLOCK + n % BLOCK, i / blocks * BLOCK + n / BLOCK]
                    .map(|n| (n as f32 + 0.5) / SIZE as f32);
                let ray = now.0 * ray(x, y);
                let (distance, _, number) = meet(now.1, ray, time);
                (distance, now.1 + ray * distance, number)
            });
            let (_, point, number) = samples.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
            let seen_by = |(turn, place): Pose, point: Vec3| ndc(turn.inverse() * (point - place));
            let here = seen_by(now, point);
            (here - seen_by(was, point - VELOCITIES[number] * INTERVAL), here.z)
        };
        (0..blocks * blocks).map(of_block).unzip()
    }

    fn psnr(a: &[u8], b: &[u8]) -> f64 {
        let squares: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum();
        10.0 * (255f64.powi(2) * a.len() as f64 / squares).log10()
    }

    /// Returns the PSNR of the frame half an interval later, of vectors that were changed.
    fn quality(change: impl Fn(Vec3) -> Vec3) -> f64 {
        let time = INTERVAL;
        let (true_vectors, depth) = vectors(time);
        let vectors: Vec<Vec3> = true_vectors.into_iter().map(change).collect();
        let rgba = picture(time);
        let view = View {
            pose: head(time),
            edges: EDGES,
            size: [SIZE; 2],
            rgba: &rgba,
            vector_size: [SIZE / BLOCK; 2],
            vectors: &vectors,
            depth: &depth,
            near_far: NEAR_FAR,
        };
        let before = Before { pose: head(time - INTERVAL), edges: EDGES, near_far: NEAR_FAR };
        let later = time + INTERVAL / 2.0;
        let made = between(&view, &before, (Quat::IDENTITY, Vec3::ZERO), head(later), 0.5);
        psnr(&made, &picture(later))
    }

    /// Half of each vector is an error half as large. A wrong z is not among them: in the picture it is an error of the second order, the square of the change of
    /// distance.
    #[test]
    fn vectors_of_a_wrong_sign_or_convention_are_seen() {
        type Change = fn(Vec3) -> Vec3;
        let right = quality(|v| v);
        println!("true vectors: {right:.2} dB");
        let wrong: [(&str, f64, Change); 5] = [
            ("the last frame minus this one", 6.0, |v| -v),
            ("x to the left", 6.0, |v| v * Vec3::new(-1.0, 1.0, 1.0)),
            ("y down", 6.0, |v| v * Vec3::new(1.0, -1.0, 1.0)),
            ("pixels of 0 to 1", 3.0, |v| v * Vec3::new(0.5, 0.5, 1.0)),
            ("none", 6.0, |_| Vec3::ZERO),
        ];
        for (what, least, change) in wrong {
            let quality = quality(change);
            println!("{what}: {quality:.2} dB");
            assert!(right - quality >= least, "{what}: {quality:.2} dB of {right:.2}");
        }
    }

    /// What the application moves is no motion: of a room at rest, the frame between is the frame.
    #[test]
    fn a_space_that_the_application_moves_does_not_move_on() {
        let rgba = picture(0.0);
        let depth: Vec<f32> = vectors(0.0).1;
        let moved: Pose = (Quat::from_rotation_y(0.4), Vec3::new(1.0, 0.0, -0.5));
        // The head stood still in the room, and now stands elsewhere in the application's space.
        let (now, was): (Pose, Pose) = (head(0.0), compose(moved, head(0.0)));
        let blocks = SIZE / BLOCK;
        let vectors = vec![Vec3::ZERO; blocks * blocks];
        let view = View {
            pose: now,
            edges: EDGES,
            size: [SIZE; 2],
            rgba: &rgba,
            vector_size: [blocks; 2],
            vectors: &vectors,
            depth: &depth,
            near_far: NEAR_FAR,
        };
        let before = Before { pose: was, edges: EDGES, near_far: NEAR_FAR };
        assert!(psnr(&between(&view, &before, moved, now, 0.5), &rgba) > 50.0);
        assert!(psnr(&between(&view, &before, (Quat::IDENTITY, Vec3::ZERO), now, 0.5), &rgba) < 20.0);
    }
}
