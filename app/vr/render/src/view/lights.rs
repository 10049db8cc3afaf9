//! The point lights of a view.

use glam::{Vec3, Vec4};

use super::cluster::Culler;
use super::scene::GpuScene;
use super::settings::MAX_POINT_LIGHTS;
use yoro::eyes::View;
use yoro_assets::{PointLight, Sky};
use yoro_gl::Program;

/// The point lights of one view, or of both eyes, strongest first.
pub struct Lights {
    positions: [Vec4; MAX_POINT_LIGHTS],
    colors: [Vec4; MAX_POINT_LIGHTS],
    count: usize,
}

impl Lights {
    /// Chooses the `limit` lights that are strongest at the eye, of those that reach into any of the views. Positions are
    /// relative to `origin`.
    pub fn choose(
        lights: &[PointLight],
        eye: Vec3,
        origin: Vec3,
        cullers: &[Culler],
        limit: usize,
    ) -> Lights {
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
            positions[k] = (lights[i].position - origin).extend(1.0 / lights[i].range.max(1e-3));
            colors[k] = lights[i].color.extend(0.0);
        }
        Lights { positions, colors, count }
    }

    /// Chooses the lights of one view or of both eyes, with positions relative to `origin`.
    pub fn of(scene: &GpuScene, views: &[View], origin: Vec3, limit: usize) -> Lights {
        // One culler for each eye. A single view's culler is repeated, and the copy is not used.
        let cullers: [Culler; 2] =
            std::array::from_fn(|i| Culler::of_view(views.get(i).unwrap_or(&views[0])));
        Lights::choose(&scene.lights, views[0].pose.position, origin, &cullers[..views.len()], limit)
    }

    /// Returns centres relative to the eye, along the world's axes, and ranges in metres.
    pub fn spheres(&self) -> impl Iterator<Item = (Vec3, f32)> {
        self.positions[..self.count].iter().map(|p| (p.truncate(), 1.0 / p.w))
    }

    /// Sets the uniforms of `include/shade.glsl` for the sky and these lights.
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
    use yoro::eyes::{DepthRange, Frustum, Pose, View};

    #[test]
    fn the_strongest_lights_in_view_are_chosen() {
        let view = View {
            pose: Pose::IDENTITY,
            frustum: Frustum::symmetric(1.0, 1.0),
            depth: DepthRange::PAPER,
            size: [64, 64],
        };
        let culler = Culler::of_view(&view);
        let light = |z: f32, strength: f32| PointLight {
            position: Vec3::new(0.0, 0.0, z),
            color: Vec3::splat(strength),
            range: 4.0,
        };
        // One light behind the eye, one far and weak, then forty of increasing strength.
        let mut lights = vec![light(20.0, 1000.0), light(-100.0, 1.0)];
        lights.extend((0..40).map(|i| light(-5.0, 1.0 + i as f32)));
        let choose =
            |lights: &[PointLight], limit| Lights::choose(lights, Vec3::ZERO, Vec3::ZERO, &[culler], limit);
        let chosen = choose(&lights, 16);
        assert_eq!(chosen.count, 16);
        let strengths: Vec<_> = chosen.colors[..16].iter().map(|c| c.x).collect();
        assert_eq!(strengths, (0..16).map(|i| 40.0 - i as f32).collect::<Vec<_>>());
        assert_eq!(choose(&lights, 100).count, MAX_POINT_LIGHTS);
        assert_eq!(choose(&lights, 0).count, 0);
        assert_eq!(choose(&lights[..2], 8).count, 1);
    }
}
