//! Smooth figures of blended shapes: a distance field, meshed by naive surface nets.

use glam::{IVec3, Mat3, Quat, Vec2, Vec3, Vec3Swizzles as _, ivec3, vec3};
use rayon::prelude::*;

use super::build::SceneBuilder;
use yoro_assets::Bounds;

/// A shape, given by its signed distance in metres, negative inside.
#[derive(Clone, Copy, Debug)]
enum Shape {
    Ellipsoid { center: Vec3, inverse: Mat3, radii: Vec3 },
    RoundCone { a: Vec3, b: Vec3, radius_a: f32, radius_b: f32 },
}

impl Shape {
    fn distance(&self, p: Vec3) -> f32 {
        match *self {
            Shape::Ellipsoid { center, inverse, radii } => {
                let q = inverse * (p - center);
                let scaled = (q / radii).length();
                let gradient = (q / (radii * radii)).length();
                if gradient < 1e-6 { -radii.min_element() } else { scaled * (scaled - 1.0) / gradient }
            }
            Shape::RoundCone { a, b, radius_a, radius_b } => {
                let axis = b - a;
                let t = ((p - a).dot(axis) / axis.length_squared().max(1e-12)).clamp(0.0, 1.0);
                p.distance(a + axis * t) - (radius_a + (radius_b - radius_a) * t)
            }
        }
    }

    fn bounds(&self) -> Bounds {
        match *self {
            Shape::Ellipsoid { center, radii, .. } => {
                let r = Vec3::splat(radii.max_element());
                Bounds { min: center - r, max: center + r }
            }
            Shape::RoundCone { a, b, radius_a, radius_b } => {
                let r = Vec3::splat(radius_a.max(radius_b));
                Bounds { min: a.min(b) - r, max: a.max(b) + r }
            }
        }
    }
}

enum Use {
    Add,
    Carve,
}

/// Shapes that blend into each other where they are within `blend` metres.
pub struct Clay {
    shapes: Vec<(Use, Shape)>,
    blend: f32,
}

impl Clay {
    /// Creates it without shapes.
    pub fn new(blend: f32) -> Clay {
        Clay { shapes: Vec::new(), blend }
    }

    /// Adds an upright ellipsoid.
    pub fn ball(&mut self, center: Vec3, radii: Vec3) -> &mut Clay {
        self.turned_ball(center, radii, Quat::IDENTITY)
    }

    /// Adds a rotated ellipsoid.
    pub fn turned_ball(&mut self, center: Vec3, radii: Vec3, rotation: Quat) -> &mut Clay {
        let inverse = Mat3::from_quat(rotation.conjugate());
        self.shapes.push((Use::Add, Shape::Ellipsoid { center, inverse, radii }));
        self
    }

    /// Adds a limb with round ends.
    pub fn limb(&mut self, a: Vec3, b: Vec3, radius_a: f32, radius_b: f32) -> &mut Clay {
        self.shapes.push((Use::Add, Shape::RoundCone { a, b, radius_a, radius_b }));
        self
    }

    /// Removes an ellipsoid from the shapes added so far.
    pub fn carve(&mut self, center: Vec3, radii: Vec3) -> &mut Clay {
        self.shapes.push((Use::Carve, Shape::Ellipsoid { center, inverse: Mat3::IDENTITY, radii }));
        self
    }

    /// Returns the signed distance in metres, negative inside. It is exact only near the surface.
    pub fn distance(&self, p: Vec3) -> f32 {
        self.shapes.iter().fold(f32::MAX, |d, (kind, shape)| match kind {
            Use::Add => smooth_min(d, shape.distance(p), self.blend),
            Use::Carve => -smooth_min(-d, shape.distance(p), self.blend),
        })
    }

    fn normal(&self, p: Vec3) -> Vec3 {
        let h = 1e-3;
        let slope = |axis: Vec3| self.distance(p + axis * h) - self.distance(p - axis * h);
        vec3(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z)).normalize_or(Vec3::Y)
    }

    fn bounds(&self) -> Bounds {
        let added = self.shapes.iter().filter(|(kind, _)| matches!(kind, Use::Add));
        let b =
            added.map(|(_, s)| s.bounds()).fold(Bounds::EMPTY, |b, s| b.including(s.min).including(s.max));
        Bounds { min: b.min - self.blend, max: b.max + self.blend }
    }

    /// Draws the surface with cells of `cell` metres. `uv` maps a point and its normal to texture coordinates.
    pub fn mesh(&self, s: &mut SceneBuilder, cell: f32, uv: impl Fn(Vec3, Vec3) -> Vec2) {
        let bounds = self.bounds();
        let low = bounds.min - cell;
        let n = ((bounds.max - bounds.min) / cell).ceil().as_ivec3() + 3;
        if self.shapes.is_empty() || n.max_element() > 1024 {
            return;
        }
        let index = |p: IVec3| ((p.z * n.y + p.y) * n.x + p.x) as usize;
        let at = |p: IVec3| low + p.as_vec3() * cell;
        let mut field = vec![0.0_f32; (n.x * n.y * n.z) as usize];
        field.par_chunks_exact_mut((n.x * n.y) as usize).enumerate().for_each(|(z, layer)| {
            for (i, value) in layer.iter_mut().enumerate() {
                *value = self.distance(at(ivec3(i as i32 % n.x, i as i32 / n.x, z as i32)));
            }
        });
        let cells = |upper: IVec3| {
            (0..upper.z)
                .flat_map(move |z| (0..upper.y).flat_map(move |y| (0..upper.x).map(move |x| ivec3(x, y, z))))
        };
        let mut points: Vec<(Vec3, Vec3)> = Vec::new();
        let mut ids = vec![u32::MAX; field.len()];
        for c in cells(n - 1) {
            let values = CORNERS.map(|corner| field[index(c + corner)]);
            if values.iter().all(|v| *v < 0.0) || values.iter().all(|v| *v >= 0.0) {
                continue;
            }
            let (mut sum, mut count) = (Vec3::ZERO, 0.0);
            for [a, b] in EDGES {
                let (da, db) = (values[a], values[b]);
                if (da < 0.0) != (db < 0.0) {
                    sum += CORNERS[a].as_vec3().lerp(CORNERS[b].as_vec3(), da / (da - db));
                    count += 1.0;
                }
            }
            let mut p = at(c) + sum / count * cell;
            // One step towards the surface removes the staircase that averaging leaves.
            let normal = self.normal(p);
            p -= normal * self.distance(p).clamp(-0.5 * cell, 0.5 * cell);
            let normal = self.normal(p);
            ids[index(c)] = s.vertex(p, normal, uv(p, normal));
            points.push((p, normal));
        }
        let first = ids.iter().copied().filter(|&id| id != u32::MAX).min().unwrap_or(0);
        let faces = |t: [u32; 3]| {
            let [a, b, c] = t.map(|id| points[(id - first) as usize]);
            let facing = (b.0 - a.0).cross(c.0 - a.0);
            (facing.length_squared() > 1e-18).then(|| facing.dot(a.1 + b.1 + c.1) > 0.0)
        };
        for c in cells(n - 1) {
            for axis in [IVec3::X, IVec3::Y, IVec3::Z] {
                let inside = field[index(c)] < 0.0;
                if inside == (field[index(c + axis)] < 0.0) {
                    continue;
                }
                // The four cells around this edge, counter-clockwise seen along the axis.
                let (u, v) = (axis.zxy(), axis.yzx());
                if (c - u - v).min_element() < 0 {
                    continue;
                }
                let ring = [c - u - v, c - v, c, c - u].map(|cell| ids[index(cell)]);
                let [p, q, r, t] = ring.map(|id| points[(id - first) as usize].0);
                let halves = if p.distance_squared(r) < q.distance_squared(t) {
                    [[ring[0], ring[1], ring[2]], [ring[0], ring[2], ring[3]]]
                } else {
                    [[ring[0], ring[1], ring[3]], [ring[1], ring[2], ring[3]]]
                };
                for [a, b, c] in halves {
                    match faces([a, b, c]) {
                        Some(true) => s.triangle(a, b, c),
                        Some(false) => s.triangle(a, c, b),
                        None => {}
                    }
                }
            }
        }
    }
}

/// Returns the polynomial smooth minimum: `a.min(b)`, rounded over a width of `k`.
fn smooth_min(a: f32, b: f32, k: f32) -> f32 {
    let h = (k - (a - b).abs()).max(0.0);
    a.min(b) - h * h / (4.0 * k.max(1e-6))
}

const CORNERS: [IVec3; 8] = [
    IVec3::new(0, 0, 0),
    IVec3::new(1, 0, 0),
    IVec3::new(0, 1, 0),
    IVec3::new(1, 1, 0),
    IVec3::new(0, 0, 1),
    IVec3::new(1, 0, 1),
    IVec3::new(0, 1, 1),
    IVec3::new(1, 1, 1),
];
const EDGES: [[usize; 2]; 12] =
    [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];

#[cfg(test)]
mod tests {
    use super::*;
    use yoro_assets::{Material, Model};

    fn meshed(clay: &Clay, cell: f32) -> Model {
        let mut s = SceneBuilder::new();
        let plain = s.material(Material::default(), 1.0);
        s.with_material(plain);
        clay.mesh(&mut s, cell, |_, _| Vec2::ZERO);
        s.finish()
    }

    #[test]
    fn a_ball_is_closed_and_has_its_volume() {
        let mut clay = Clay::new(0.02);
        clay.ball(vec3(1.0, 2.0, 3.0), Vec3::splat(0.5));
        let model = meshed(&clay, 0.04);
        let volume: f32 = model
            .indices
            .chunks_exact(3)
            .map(|t| {
                let [a, b, c] =
                    [t[0], t[1], t[2]].map(|i| model.vertices[i as usize].position - vec3(1.0, 2.0, 3.0));
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        assert!((volume / std::f32::consts::FRAC_PI_6 - 1.0).abs() < 0.03, "{volume}");
        for v in &model.vertices {
            assert!((v.position.distance(vec3(1.0, 2.0, 3.0)) - 0.5).abs() < 2e-3);
        }
        let mut edges = std::collections::HashMap::new();
        for t in model.indices.chunks_exact(3) {
            for [a, b] in [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]] {
                *edges.entry((a.min(b), a.max(b))).or_insert(0) += 1;
            }
        }
        assert!(edges.values().all(|&n| n == 2), "every edge joins two triangles");
    }

    #[test]
    fn shapes_blend_and_carve() {
        let mut clay = Clay::new(0.2);
        clay.limb(Vec3::ZERO, Vec3::X, 0.2, 0.2).limb(Vec3::X, vec3(1.0, 1.0, 0.0), 0.2, 0.2);
        let inner_corner = vec3(0.78, 0.22, 0.0);
        assert!(clay.distance(inner_corner) < 0.0, "the joint is filled");
        clay.carve(Vec3::ZERO, Vec3::splat(0.15));
        assert!(clay.distance(Vec3::ZERO) > 0.0);
    }
}
