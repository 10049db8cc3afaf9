//! Casts rays at a model's triangles, to find room for a camera and whether the sky is visible.

use glam::Vec3;

use super::model::{Bounds, Model};

/// Triangles in a leaf.
const LEAF: usize = 8;

/// A bounding volume hierarchy over all triangles, split at the median.
pub(super) struct Rays<'a> {
    model: &'a Model,
    /// For each material, true if it is drawn from both sides.
    two_sided: Vec<bool>,
    triangles: Vec<u32>,
    nodes: Vec<Node>,
}

struct Node {
    bounds: Bounds,
    /// The second child (the first follows its parent), or the first triangle of a leaf.
    next: u32,
    /// Triangles in a leaf, 0 for an inner node.
    count: u32,
}

/// The first triangle that a ray hits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    /// Distance in lengths of the direction.
    pub distance: f32,
    /// Unit normal of the face, facing either way.
    pub normal: Vec3,
    /// True if the side that the ray hits is drawn; the inside of a solid body is usually not.
    pub is_drawn: bool,
    /// True if the ray hits the face from behind, by its winding.
    pub is_behind: bool,
}

impl<'a> Rays<'a> {
    pub fn new(model: &'a Model) -> Rays<'a> {
        let two_sided = model.materials.iter().map(|m| m.double_sided).collect();
        let triangles = (0..model.triangle_count() as u32).collect();
        let mut rays = Rays { model, two_sided, triangles, nodes: Vec::new() };
        let mut triangles = std::mem::take(&mut rays.triangles);
        if !triangles.is_empty() {
            rays.split(&mut triangles, 0);
        }
        rays.triangles = triangles;
        rays
    }

    fn corners(&self, triangle: u32) -> [Vec3; 3] {
        let i = triangle as usize * 3;
        [0, 1, 2].map(|k| self.model.vertices[self.model.indices[i + k] as usize].position)
    }

    fn split(&mut self, triangles: &mut [u32], first: usize) {
        let bounds = triangles
            .iter()
            .fold(Bounds::EMPTY, |b, &t| self.corners(t).into_iter().fold(b, Bounds::including));
        let node = self.nodes.len();
        self.nodes.push(Node { bounds, next: first as u32, count: triangles.len() as u32 });
        if triangles.len() <= LEAF {
            return;
        }
        let size = bounds.max - bounds.min;
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let middle = triangles.len() / 2;
        let key = |t: &u32| self.corners(*t).iter().map(|p| p[axis]).sum::<f32>();
        triangles.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
        let (left, right) = triangles.split_at_mut(middle);
        self.split(left, first);
        self.nodes[node].next = self.nodes.len() as u32;
        self.nodes[node].count = 0;
        self.split(right, first + middle);
    }

    /// Returns the first face, seen from either side, at `origin + t * direction` with 0 < t < `reach`.
    pub fn cast(&self, origin: Vec3, direction: Vec3, reach: f32) -> Option<Hit> {
        let inverse = direction.recip();
        let mut best: Option<Hit> = None;
        let mut stack = vec![0u32];
        while let Some(i) = stack.pop() {
            let Some(node) = self.nodes.get(i as usize) else { break };
            let limit = best.map_or(reach, |h| h.distance);
            let (a, b) = ((node.bounds.min - origin) * inverse, (node.bounds.max - origin) * inverse);
            // A direction of 0 along an axis gives NaN on the border, which max and min ignore.
            let enter = a.min(b).max_element().max(0.0);
            let leave = a.max(b).min_element();
            if enter > leave || enter > limit {
                continue;
            }
            if node.count == 0 {
                stack.extend([node.next, i + 1]);
                continue;
            }
            for &t in &self.triangles[node.next as usize..(node.next + node.count) as usize] {
                if let Some(hit) = self.meet(t, origin, direction, best.map_or(reach, |h| h.distance)) {
                    best = Some(hit);
                }
            }
        }
        best
    }

    /// Intersects a ray with a triangle (Möller and Trumbore, 1997).
    fn meet(&self, triangle: u32, origin: Vec3, direction: Vec3, limit: f32) -> Option<Hit> {
        let [a, b, c] = self.corners(triangle);
        let (u, v) = (b - a, c - a);
        let p = direction.cross(v);
        let determinant = u.dot(p);
        if determinant == 0.0 {
            return None;
        }
        let s = origin - a;
        let x = s.dot(p) / determinant;
        let q = s.cross(u);
        let y = direction.dot(q) / determinant;
        let distance = v.dot(q) / determinant;
        let inside = x >= 0.0 && y >= 0.0 && x + y <= 1.0 && distance > 0.0 && distance < limit;
        inside.then(|| Hit {
            distance,
            normal: u.cross(v).normalize_or_zero(),
            is_drawn: determinant > 0.0 || self.is_two_sided(triangle),
            is_behind: determinant < 0.0,
        })
    }

    fn is_two_sided(&self, triangle: u32) -> bool {
        let parts = &self.model.parts;
        let after = parts.partition_point(|part| part.indices.start <= triangle as usize * 3);
        after.checked_sub(1).is_some_and(|i| self.two_sided[parts[i].material])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vertex;

    #[test]
    fn rays_find_the_nearest_of_many_triangles() {
        let mut model = Model::default();
        // Floors at y = 0, 1, ... 99 in tiles.
        for level in 0..100 {
            for (x, z) in [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0), (4.0, 4.0)] {
                let start = model.vertices.len() as u32;
                for (dx, dz) in [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)] {
                    let position = Vec3::new(x + dx, level as f32, z + dz);
                    model.vertices.push(Vertex { position, ..Vertex::default() });
                }
                model.indices.extend([0, 1, 2, 0, 2, 3].map(|i| i + start));
            }
        }
        let rays = Rays::new(&model);
        for (x, y, z) in [(1.0, 50.5, 3.0), (6.3, 7.25, 1.7), (4.0, 0.5, 4.0)] {
            let down = rays.cast(Vec3::new(x, y, z), Vec3::NEG_Y, 1e9).unwrap();
            assert!((down.distance - y.fract()).abs() < 1e-5 && down.normal.y.abs() == 1.0);
            let up = rays.cast(Vec3::new(x, y, z), Vec3::Y, 1e9).unwrap();
            assert!((up.distance - (1.0 - y.fract())).abs() < 1e-5);
            assert!(rays.cast(Vec3::new(x, y, z), Vec3::Y, 0.1).is_none());
            assert!(rays.cast(Vec3::new(x, y, z), Vec3::X, 1e9).is_none());
        }
        assert!(Rays::new(&Model::default()).cast(Vec3::ZERO, Vec3::Y, 1.0).is_none());
    }
}
