//! Lights that reach the surfaces of a view.

use std::collections::HashMap;

use glam::{Vec3, vec3};

use crate::waves::{combine, wave_size};
use yoro::eyes::View;
use yoro_assets::PointLight;
use yoro_render::MAX_POINT_LIGHTS;

/// The lights that reach each pixel of a view, as bits.
pub struct Lamps {
    bits: Vec<u32>,
    size: [u32; 2],
    /// Means by the number of lanes in a wave.
    means: HashMap<u32, f64>,
}

impl Lamps {
    /// Finds the lights of each pixel from its depth, with rows from the bottom. Lights after the first 32 are ignored:
    /// in the built-in scenes no wave is reached by more.
    pub fn new(view: &View, depth: &[f32], lights: &[PointLight]) -> Lamps {
        let [width, height] = view.size;
        let local: Vec<(Vec3, f32)> = lights
            .iter()
            .map(|light| {
                let at = view.pose.orientation.inverse() * (light.position - view.pose.position);
                (at, light.range * light.range)
            })
            .filter(|(at, squared)| at.z < squared.sqrt())
            .take(32)
            .collect();
        let f = view.frustum;
        let bits = depth.iter().enumerate().map(|(i, &depth)| {
            if depth == view.depth.clear_value() {
                return 0;
            }
            let at = [i as u32 % width, i as u32 / width].map(|n| n as f32 + 0.5);
            let x = f.left + at[0] / width as f32 * f.width();
            let y = f.bottom + at[1] / height as f32 * f.height();
            let surface = vec3(x, y, -1.0) * view.depth.distance(depth);
            let reached = local.iter().enumerate();
            reached.fold(0u32, |bits, (k, (at, squared))| {
                bits | u32::from(at.distance_squared(surface) < *squared) << k
            })
        });
        Lamps { bits: bits.collect(), size: view.size, means: HashMap::new() }
    }

    /// Returns the mean number of lights that reach at least one pixel of a wave with this many lanes.
    pub fn of_wave(&mut self, lanes: u32) -> f64 {
        let (bits, width) = (&self.bits, self.size[0]);
        *self.means.entry(lanes).or_insert_with(|| {
            let waves = combine(bits.iter(), width, wave_size(lanes), |wave: &mut u32, bits| *wave |= bits);
            let lights: u32 = waves.iter().map(|bits| bits.count_ones().min(MAX_POINT_LIGHTS as u32)).sum();
            f64::from(lights) / waves.len().max(1) as f64
        })
    }
}
