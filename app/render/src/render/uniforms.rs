//! Uniforms that several passes share.

use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};

use super::cluster::Culler;
use super::settings::MAX_POINT_LIGHTS;
use yoro::eyes::{DepthConvention, View};
use yoro_gl::{DepthTest, Program};
use yoro_scene::{PointLight, Sky};

/// World axes around the eye to clip space.
pub fn eye_to_clip(view: &View) -> Mat4 {
    view.projection() * Mat4::from_quat(view.pose.orientation.inverse())
}

/// The depth test of a convention.
pub fn depth_test(convention: DepthConvention) -> DepthTest {
    match convention {
        DepthConvention::Standard => DepthTest::Less,
        DepthConvention::Reversed => DepthTest::Greater,
    }
}

/// Times a depth: smaller is nearer.
pub fn nearer(convention: DepthConvention) -> f32 {
    match convention {
        DepthConvention::Standard => 1.0,
        DepthConvention::Reversed => -1.0,
    }
}

/// Sets what `include/view.glsl` needs.
pub fn set_view(program: &Program, view: &View) {
    let f = &view.frustum;
    let axes = |v: Vec3| view.pose.orientation * v;
    let (c, m) = view.depth.inverse_distance_law();
    program
        .set("ray_corner", axes(Vec3::new(f.left, f.bottom, -1.0)))
        .set("ray_width", axes(Vec3::X * f.width()))
        .set("ray_height", axes(Vec3::Y * f.height()))
        .set("inverse_distance", Vec2::new(c as f32, m as f32))
        .set("far_depth", view.depth.clear_value());
}

/// Rays at distance 1 along the viewing axis, along the world's axes: through the middle of the lower left pixel, and what
/// the next pixel to the right and the next one above add.
pub fn pixel_rays(view: &View) -> Mat3 {
    let f = &view.frustum;
    let [right, up] = [f.width() / view.size[0] as f32, f.height() / view.size[1] as f32];
    let corner = Vec3::new(f.left + 0.5 * right, f.bottom + 0.5 * up, -1.0);
    Mat3::from_quat(view.pose.orientation) * Mat3::from_cols(corner, Vec3::X * right, Vec3::Y * up)
}

/// The point lights of one view, or of both eyes, strongest first.
pub struct Lights {
    /// Where positions are relative to.
    eye: Vec3,
    positions: [Vec4; MAX_POINT_LIGHTS],
    colors: [Vec4; MAX_POINT_LIGHTS],
    count: usize,
}

impl Lights {
    /// Chooses, of the lights that reach into any of the views, the `limit` strongest at the eye.
    pub fn choose(lights: &[PointLight], eye: Vec3, cullers: &[Culler], limit: usize) -> Lights {
        let limit = limit.min(MAX_POINT_LIGHTS);
        let mut scores = [(0.0, 0); MAX_POINT_LIGHTS];
        let mut count = 0;
        for (i, light) in lights.iter().enumerate() {
            if limit == 0 || !cullers.iter().any(|c| c.sees_sphere(light.position, light.range)) {
                continue;
            }
            let distance = light.position.distance_squared(eye);
            let score = light.color.dot(Vec3::new(0.3, 0.6, 0.1)) / (1.0 + distance);
            if count < limit {
                count += 1;
            } else if scores[count - 1].0 >= score {
                continue;
            }
            let mut place = count - 1;
            while place > 0 && scores[place - 1].0 < score {
                scores[place] = scores[place - 1];
                place -= 1;
            }
            scores[place] = (score, i);
        }
        let (mut positions, mut colors) = ([Vec4::ZERO; MAX_POINT_LIGHTS], [Vec4::ZERO; MAX_POINT_LIGHTS]);
        for (k, &(_, i)) in scores[..count].iter().enumerate() {
            positions[k] = (lights[i].position - eye).extend(1.0 / lights[i].range.max(1e-3));
            colors[k] = lights[i].color.extend(0.0);
        }
        Lights { eye, positions, colors, count }
    }

    /// The same lights, relative to another eye.
    pub fn seen_from(&self, eye: Vec3) -> Lights {
        let shift = (self.eye - eye).extend(0.0);
        Lights { eye, positions: self.positions.map(|p| p + shift), ..*self }
    }

    /// Centres relative to the eye, along the world's axes, and ranges in metres.
    pub fn spheres(&self) -> impl Iterator<Item = (Vec3, f32)> {
        self.positions[..self.count].iter().map(|p| (p.truncate(), 1.0 / p.w))
    }

    /// Sets what `include/shade.glsl` needs of the sky and these lights.
    pub fn set(&self, program: &Program, sky: &Sky) {
        program
            .set("zenith", sky.zenith)
            .set("horizon", sky.horizon)
            .set("ground", sky.ground)
            .set("sun_direction", sky.sun_direction.normalize_or(Vec3::Y))
            .set("sun_color", sky.sun_color)
            .set("light_positions", &self.positions[..])
            .set("light_colors", &self.colors[..])
            .set("light_count", self.count as i32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::Selection;
    use yoro::eyes::{DepthRange, Frustum, Pose};

    #[test]
    fn the_strongest_lights_in_view_are_chosen() {
        let view = View {
            pose: Pose::IDENTITY,
            frustum: Frustum::symmetric(1.0, 1.0),
            depth: DepthRange::PAPER,
            size: [64, 64],
        };
        let culler = Culler::new(Vec3::ZERO, &eye_to_clip(&view), Selection::All);
        let light = |z: f32, strength: f32| PointLight {
            position: Vec3::new(0.0, 0.0, z),
            color: Vec3::splat(strength),
            range: 4.0,
        };
        // Behind the eye; far and weak; then forty that grow stronger.
        let mut lights = vec![light(20.0, 1000.0), light(-100.0, 1.0)];
        lights.extend((0..40).map(|i| light(-5.0, 1.0 + i as f32)));
        let chosen = Lights::choose(&lights, Vec3::ZERO, &[culler], 16);
        assert_eq!(chosen.count, 16);
        let strengths: Vec<_> = chosen.colors[..16].iter().map(|c| c.x).collect();
        assert_eq!(strengths, (0..16).map(|i| 40.0 - i as f32).collect::<Vec<_>>());
        assert_eq!(Lights::choose(&lights, Vec3::ZERO, &[culler], 100).count, MAX_POINT_LIGHTS);
        assert_eq!(Lights::choose(&lights, Vec3::ZERO, &[culler], 0).count, 0);
        assert_eq!(Lights::choose(&lights[..2], Vec3::ZERO, &[culler], 8).count, 1);
    }
}
