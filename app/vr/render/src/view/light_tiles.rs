//! Lists of the lights that reach each tile of an image, so that a surface is lit by nearby lights only.

use glam::{IVec4, Vec2, Vec3};

use super::layout::Layout;
use super::lights::Lights;
use yoro::eyes::{Eye, Frustum, View};
use yoro_gl::Program;

/// Number of tiles across and down an image. A mask for each fits into every driver's uniforms, at every image size.
const COLUMNS: usize = 16;
const ROWS: usize = 8;
const COUNT: usize = COLUMNS * ROWS;

/// For each tile, the lights that reach into its part of the view at any distance.
pub struct LightTiles {
    /// Bit `i` stands for light `i` of [`Lights`]. Each vector holds four tiles, row by row from the bottom.
    masks: [IVec4; COUNT / 4],
    tiles_per_pixel: Vec2,
}

impl LightTiles {
    /// Returns the defines of `include/shade.glsl`.
    pub fn defines() -> [(&'static str, String); 2] {
        [("LIGHT_TILES", COUNT.to_string()), ("LIGHT_TILE_COLUMNS", COLUMNS.to_string())]
    }

    /// Creates the tiles for an image of this layout and the lights of its views, relative to the first view.
    pub fn new(lights: &Lights, layout: Layout, views: &[View]) -> LightTiles {
        let size = views.first().map_or([1, 1], |view| layout.texture_size(view.size)).map(|n| n as f32);
        let tile = [size[0] / COLUMNS as f32, size[1] / ROWS as f32];
        let mut masks = [IVec4::ZERO; COUNT / 4];
        let first = views.first().map_or(Vec3::ZERO, |view| view.pose.position);
        let columns = COLUMNS / layout.instances();
        for (view, eye) in views.iter().zip(Eye::BOTH) {
            let left = layout.origin(view.size, eye)[0] as f32;
            let first_column = (left / tile[0]).round() as usize;
            let to_view = view.pose.orientation.inverse();
            for (i, (center, range)) in lights.spheres().enumerate() {
                let center = to_view * (center + first - view.pose.position);
                let reaches = Reach { center, range, frustum: view.frustum };
                for row in (0..ROWS).filter(|&row| reaches.row(row, tile[1] / view.size[1] as f32)) {
                    for column in (0..columns).filter(|&c| reaches.column(c, tile[0] / view.size[0] as f32)) {
                        let at = row * COLUMNS + first_column + column;
                        masks[at / 4][at % 4] |= 1 << i;
                    }
                }
            }
        }
        LightTiles { masks, tiles_per_pixel: Vec2::new(1.0 / tile[0], 1.0 / tile[1]) }
    }

    /// Sets the uniforms of `include/shade.glsl`.
    pub fn set(&self, program: &Program) {
        program.set("light_tiles", &self.masks[..]).set("tiles_per_pixel", self.tiles_per_pixel);
    }
}

/// The sphere that a light reaches, in an eye's axes.
struct Reach {
    /// Centre in the eye's axes.
    center: Vec3,
    range: f32,
    frustum: Frustum,
}

impl Reach {
    /// True if the light reaches into a column of tiles. `width` is a tile's share of the view's width.
    fn column(&self, column: usize, width: f32) -> bool {
        let tangent = |edge: usize| self.frustum.left + edge as f32 * width * self.frustum.width();
        self.is_between(self.center.x, tangent(column), tangent(column + 1))
    }

    /// True if the light reaches into a row of tiles. `height` is a tile's share of the view's height.
    fn row(&self, row: usize, height: f32) -> bool {
        let tangent = |edge: usize| self.frustum.bottom + edge as f32 * height * self.frustum.height();
        self.is_between(self.center.y, tangent(row), tangent(row + 1))
    }

    /// True if the light reaches between the planes through the eye at two tangents. `across` is the centre's
    /// coordinate along the tangents' axis.
    fn is_between(&self, across: f32, low: f32, high: f32) -> bool {
        // Distance of the centre from the plane, positive on the side of larger tangents.
        let beyond = |tangent: f32| (across + tangent * self.center.z) / (1.0 + tangent * tangent).sqrt();
        beyond(low) > -self.range && beyond(high) < self.range
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::cluster::Culler;
    use glam::Quat;
    use yoro::eyes::{DepthRange, Pose};
    use yoro_assets::PointLight;

    /// Every point that a light reaches must lie in a tile that lists it, and most tiles must not list it.
    #[test]
    fn tiles_list_the_lights_that_reach_them() {
        let pose = Pose { position: Vec3::new(2.0, 1.0, 5.0), orientation: Quat::from_rotation_y(0.7) };
        let view = View {
            pose,
            frustum: Frustum { left: -1.0, right: 0.7, bottom: -0.5, top: 0.8 },
            depth: DepthRange::PAPER,
            size: [150, 90],
        };
        let local = [Vec3::new(-1.5, 0.4, -3.0), Vec3::new(0.5, 0.0, -8.0), Vec3::new(0.1, -0.3, 0.2)];
        let scene: Vec<PointLight> = local
            .iter()
            .map(|&p| PointLight {
                position: pose.position + pose.orientation * p,
                color: Vec3::ONE,
                range: 1.1,
            })
            .collect();
        let culler = Culler::of_view(&view);
        let lights = Lights::choose(&scene, pose.position, pose.position, &[culler], 24);
        let tiles = LightTiles::new(&lights, Layout::Single, &[view]);
        let mask = |x: f32, y: f32| {
            let at =
                (y * tiles.tiles_per_pixel.y) as usize * COLUMNS + (x * tiles.tiles_per_pixel.x) as usize;
            tiles.masks[at / 4][at % 4]
        };
        let mut known = 0;
        for (i, (center, range)) in lights.spheres().enumerate() {
            for step in 0..400 {
                let angles = Vec2::new(step as f32 * 0.71, step as f32 * 0.173);
                let ray = Vec3::new(angles.x.cos() * angles.y.sin(), angles.y.cos(), angles.x.sin());
                let p = pose.orientation.inverse() * (center + ray.normalize() * range * 0.999);
                let tangent = Vec2::new(p.x, p.y) / -p.z;
                let f = view.frustum;
                let at = (tangent - Vec2::new(f.left, f.bottom)) / Vec2::new(f.width(), f.height())
                    * Vec2::new(150.0, 90.0);
                if p.z < 0.0 && at.cmpge(Vec2::ZERO).all() && at.x < 150.0 && at.y < 90.0 {
                    known += 1;
                    assert!(mask(at.x, at.y) >> i & 1 == 1, "light {i} at {at}");
                }
            }
        }
        assert!(known > 300, "{known}");
        let bits: u32 = tiles.masks.iter().flat_map(|m| m.to_array()).map(i32::count_ones).sum();
        assert!(bits < 2 * COUNT as u32, "{bits} of {} tiles and lights", 3 * COUNT);
    }
}
