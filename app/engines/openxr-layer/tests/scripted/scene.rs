//! A room with two balls, rendered by ray casting: the reference for any eye at any position.

use glam::Vec3;
use yoro::eyes::{Frustum, Pose};

/// A rendered view, with rows from the bottom.
pub struct Picture {
    pub size: [u32; 2],
    pub rgba: Vec<u8>,
    /// Distances in metres along the viewing axis.
    pub distance: Vec<f32>,
}

const ROOM: Vec3 = Vec3::new(4.0, 3.0, 4.0);
const BALLS: [(Vec3, f32); 2] = [(Vec3::new(0.2, -0.1, -1.1), 0.3), (Vec3::new(-0.6, 0.2, -2.0), 0.4)];

/// Returns the distance to the first surface along a ray, and its colour.
fn meet(origin: Vec3, ray: Vec3) -> (f32, Vec3) {
    let wall = ((ROOM * ray.signum() - origin) / ray).min_element();
    let mut met = (wall, 0.0);
    for (number, (centre, radius)) in BALLS.into_iter().enumerate() {
        let (a, b, to) = (ray.length_squared(), ray.dot(centre - origin), centre - origin);
        let inside = b * b - a * (to.length_squared() - radius * radius);
        if inside > 0.0 {
            let distance = (b - inside.sqrt()) / a;
            if distance > 0.0 && distance < met.0 {
                met = (distance, number as f32 + 1.0);
            }
        }
    }
    let (distance, number) = met;
    // Smooth enough for a picture with few pixels.
    let place = (origin + ray * distance) * (4.0 + 3.0 * number);
    let waves = Vec3::new((place.x + number).sin(), (place.y + place.z).sin(), (place.x - place.y).cos());
    (distance, Vec3::splat(0.5) + 0.4 * waves)
}

/// Renders a view. The colour is the mean of `samples` times `samples` samples, like that of an application that
/// resolves MSAA. The distance is that of the pixel's centre.
pub fn render(pose: Pose, frustum: Frustum, size: [u32; 2], samples: u32) -> Picture {
    let [width, height] = size.map(|n| n as f32);
    let at = |x: f32, y: f32| {
        let tangents =
            [frustum.left + x / width * frustum.width(), frustum.bottom + y / height * frustum.height()];
        meet(pose.position, pose.orientation * Vec3::new(tangents[0], tangents[1], -1.0))
    };
    let mut picture = Picture { size, rgba: Vec::new(), distance: Vec::new() };
    for (y, x) in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (y as f32, x as f32))) {
        let step = |i: u32| (i as f32 + 0.5) / samples as f32;
        let all = (0..samples * samples).map(|i| at(x + step(i % samples), y + step(i / samples)).1);
        let color = all.sum::<Vec3>() / (samples * samples) as f32;
        picture.rgba.extend(color.to_array().map(|c| (c * 255.0).round() as u8));
        picture.rgba.push(255);
        picture.distance.push(at(x + 0.5, y + 0.5).0);
    }
    picture
}
