//! Spatial clusters: runs of triangles that are drawn or left out together.

use std::ops::Range;

use glam::{Mat4, Vec3, Vec3Swizzles, Vec4};

use super::uniforms::eye_to_clip;
use yoro::eyes::View;
use yoro_assets::{Alpha, Bounds, Model, Vertex};

/// Number of floats in the position, normal and uv of a [`Vertex`].
pub(super) const VERTEX_ATTRIBUTES: [i32; 3] = [3, 3, 2];
/// A part with more triangles than this is split.
const SPLIT_ABOVE: usize = 4096;
/// Neighbouring parts are gathered into one cluster up to this many triangles.
const GATHER_UP_TO: usize = 512;
/// The largest number of a material's boxes in [`Clusters::blended_boxes`].
const MAX_BOXES: usize = 256;

/// A run of indices of one material that is compact in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cluster {
    /// Smallest box around its triangles.
    pub bounds: Bounds,
    /// First index.
    pub start: u32,
    /// One past the last index.
    pub end: u32,
}

/// The clusters of one material.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// Index of the material.
    pub material: usize,
    /// Its clusters. Clusters that are close in space are close in the list, and their indices have no gaps.
    pub clusters: Range<usize>,
    /// True if its triangles move: the indices then refer to the mesh that is rewritten.
    pub moves: bool,
}

/// A model's triangles in clusters, as made by [`build`].
pub struct Clusters {
    /// All clusters, batch after batch.
    pub clusters: Vec<Cluster>,
    /// One batch for each material in use, ordered by material.
    pub batches: Vec<Batch>,
    /// Boxes that together contain all blended triangles, and little else.
    pub blended_boxes: Vec<Bounds>,
    /// The model's indices in the order of the clusters.
    pub indices: Vec<u32>,
}

/// A set of triangles that is not split any further.
struct Unit {
    bounds: Bounds,
    triangles: Range<usize>,
}

/// Sorts a model's triangles by material and place. A cluster holds one piece of a large part, or several small parts
/// that are close together, but never pieces of two large parts.
pub fn build(model: &Model) -> Clusters {
    let mut built = Clusters {
        clusters: Vec::new(),
        batches: Vec::new(),
        blended_boxes: Vec::new(),
        indices: Vec::with_capacity(model.indices.len()),
    };
    // First indices of triangles, sorted within each part.
    let mut triangles: Vec<u32> = Vec::new();
    let mut units = Vec::new();
    for material in 0..model.materials.len() {
        triangles.clear();
        units.clear();
        for part in model.parts.iter().filter(|p| p.material == material && p.indices.len() >= 3) {
            let first = triangles.len();
            triangles.extend(part.indices.clone().step_by(3).map(|i| i as u32));
            split_triangles(model, &mut triangles, first, &mut units);
        }
        if units.is_empty() {
            continue;
        }
        let first = built.clusters.len();
        gather_units(model, &mut units, &triangles, &mut built);
        built.batches.push(Batch { material, clusters: first..built.clusters.len(), moves: false });
        if matches!(model.materials[material].alpha, Alpha::Blend(_)) {
            built.blended_boxes.extend(enclose(model, std::mem::take(&mut triangles)));
        }
    }
    built
}

fn corners(model: &Model, triangle: u32) -> impl Iterator<Item = &Vertex> {
    let i = triangle as usize;
    model.indices[i..i + 3].iter().map(|&v| &model.vertices[v as usize])
}

/// Returns the smallest box around triangles.
fn bounds_of(model: &Model, triangles: &[u32]) -> Bounds {
    let vertices = triangles.iter().flat_map(|&t| corners(model, t));
    vertices.fold(Bounds::EMPTY, |bounds, vertex| bounds.including(vertex.position))
}

/// Splits `triangles[first..]` at the median of the longest axis until the pieces are small enough.
fn split_triangles(model: &Model, triangles: &mut [u32], first: usize, units: &mut Vec<Unit>) {
    let piece = &mut triangles[first..];
    let bounds = bounds_of(model, piece);
    let middle = piece.len() / 2;
    if piece.len() <= SPLIT_ABOVE {
        units.push(Unit { bounds, triangles: first..first + piece.len() });
        return;
    }
    let axis = (bounds.max - bounds.min).max_position();
    piece.select_nth_unstable_by_key(middle, |&t| {
        ordered(corners(model, t).map(|v| v.position[axis]).sum::<f32>())
    });
    split_triangles(model, &mut triangles[..first + middle], first, units);
    split_triangles(model, triangles, first + middle, units);
}

/// Returns boxes around triangles, [`MAX_BOXES`] at most: the largest one is halved again and again.
fn enclose(model: &Model, triangles: Vec<u32>) -> Vec<Bounds> {
    let surface = |bounds: &Bounds| {
        let size = bounds.max - bounds.min;
        size.dot(size.yzx())
    };
    let mut boxes = vec![(bounds_of(model, &triangles), triangles)];
    while boxes.len() < MAX_BOXES {
        let several = boxes.iter().enumerate().filter(|(_, (_, triangles))| triangles.len() > 1);
        let largest = several.max_by(|(_, (a, _)), (_, (b, _))| surface(a).total_cmp(&surface(b)));
        let Some((at, _)) = largest else { break };
        let (bounds, whole) = boxes.swap_remove(at);
        let axis = (bounds.max - bounds.min).max_position();
        let center = |t: u32| corners(model, t).map(|v| v.position[axis]).sum::<f32>() / 3.0;
        let middle = bounds.center()[axis];
        let (mut low, mut high): (Vec<u32>, Vec<u32>) = whole.into_iter().partition(|&t| center(t) < middle);
        if low.is_empty() || high.is_empty() {
            low.append(&mut high);
            high = low.split_off(low.len() / 2);
        }
        boxes.extend([low, high].map(|half| (bounds_of(model, &half), half)));
    }
    boxes.into_iter().map(|(bounds, _)| bounds).collect()
}

/// Maps a finite float to an integer; the integers sort as the floats do.
fn ordered(x: f32) -> i32 {
    let bits = x.to_bits() as i32;
    bits ^ (((bits >> 31) as u32) >> 1) as i32
}

fn gather_units(model: &Model, units: &mut [Unit], triangles: &[u32], built: &mut Clusters) {
    let count: usize = units.iter().map(|u| u.triangles.len()).sum();
    if units.len() == 1 || count <= GATHER_UP_TO {
        let start = built.indices.len();
        for &t in units.iter().flat_map(|u| &triangles[u.triangles.clone()]) {
            built.indices.extend_from_slice(&model.indices[t as usize..t as usize + 3]);
        }
        let bounds =
            units.iter().fold(Bounds::EMPTY, |b, u| b.including(u.bounds.min).including(u.bounds.max));
        built.clusters.push(Cluster { bounds, start: start as u32, end: built.indices.len() as u32 });
        return;
    }
    let centers = units.iter().fold(Bounds::EMPTY, |b, u| b.including(u.bounds.center()));
    let axis = (centers.max - centers.min).max_position();
    let middle = units.len() / 2;
    units.select_nth_unstable_by_key(middle, |u| ordered(u.bounds.center()[axis]));
    let (low, high) = units.split_at_mut(middle);
    gather_units(model, low, triangles, built);
    gather_units(model, high, triangles, built);
}

/// Decides what is drawn in a view: what lies in its clip volume.
#[derive(Clone, Copy, Debug)]
pub struct Culler {
    planes: [Vec4; 6],
    eye: Vec3,
}

impl Culler {
    /// Makes a culler for everything in a view.
    pub fn of_view(view: &View) -> Culler {
        Culler::new(view.pose.position, &eye_to_clip(view))
    }

    /// Makes a culler for the clip volume of `eye_to_clip`, which takes positions relative to `eye`.
    pub fn new(eye: Vec3, eye_to_clip: &Mat4) -> Culler {
        let m = eye_to_clip.transpose();
        let (x, y, z, w) = (m.x_axis, m.y_axis, m.z_axis, m.w_axis);
        Culler { planes: [w + x, w - x, w + y, w - y, w + z, w - z], eye }
    }

    /// True if any part of the box may be seen.
    pub fn sees(&self, bounds: &Bounds) -> bool {
        let (min, max) = (bounds.min - self.eye, bounds.max - self.eye);
        self.planes.iter().all(|plane| {
            let normal = plane.truncate();
            let farthest = Vec3::select(normal.cmpgt(Vec3::ZERO), max, min);
            // The slack covers the rounding of the planes; an infinite far plane is rounded most.
            let reach = normal.abs().dot(min.abs().max(max.abs())) + plane.w.abs();
            normal.dot(farthest) + plane.w >= -1e-5 * reach
        })
    }

    /// True if any part of the sphere may be seen.
    pub fn sees_sphere(&self, center: Vec3, radius: f32) -> bool {
        let center = center - self.eye;
        self.planes.iter().all(|plane| {
            let normal = plane.truncate();
            normal.dot(center) + plane.w >= -radius * normal.length() * 1.001 - 1e-4
        })
    }

    /// Returns the index ranges of the clusters that may be seen. Adjacent ranges are merged.
    pub fn visible<'a>(&'a self, clusters: &'a [Cluster]) -> impl Iterator<Item = Range<usize>> + 'a {
        visible(std::slice::from_ref(self), clusters)
    }
}

/// Returns the index ranges of the clusters that any of the cullers sees. Adjacent ranges are merged.
pub fn visible<'a>(
    cullers: &'a [Culler],
    clusters: &'a [Cluster],
) -> impl Iterator<Item = Range<usize>> + 'a {
    let sees = |c: &&Cluster| cullers.iter().any(|culler| culler.sees(&c.bounds));
    let mut seen = clusters.iter().filter(sees).peekable();
    std::iter::from_fn(move || {
        let first = seen.next()?;
        let mut end = first.end;
        while let Some(next) = seen.next_if(|c| c.start == end) {
            end = next.end;
        }
        Some(first.start as usize..end as usize)
    })
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use rand::{Rng, SeedableRng};
    use rand_pcg::Pcg64;

    use super::*;
    use yoro::eyes::{DepthConvention, DepthRange, Frustum, Pose};
    use yoro_assets::{Material, Part};

    fn random_model(rng: &mut Pcg64) -> Model {
        let mut model = Model { materials: vec![Material::default(); 5], ..Model::default() };
        for (p, count) in [1, 3, 9000, 700, 0, 12, 5000, 2, 2, 2, 300, 4097].into_iter().enumerate() {
            let center = Vec3::new(rng.random_range(-50.0..50.0), 0.0, rng.random_range(-50.0..50.0));
            let start = model.indices.len();
            for _ in 0..count {
                let at = center + Vec3::new(rng.random(), rng.random(), rng.random()) * 8.0;
                for corner in [Vec3::ZERO, Vec3::X, Vec3::Y] {
                    model.indices.push(model.vertices.len() as u32);
                    model.vertices.push(Vertex { position: at + corner, ..Vertex::default() });
                }
            }
            // Material 3 is used by no part.
            let material = [0, 1, 2, 4][p % 4];
            model.parts.push(Part {
                name: format!("part {p}"),
                material,
                indices: start..model.indices.len(),
            });
        }
        model
    }

    #[test]
    fn every_triangle_is_in_one_cluster_of_its_material() {
        let mut model = random_model(&mut Pcg64::seed_from_u64(1));
        model.materials[0].alpha = Alpha::Blend(0.5);
        let built = build(&model);
        let mut expected: HashMap<[u32; 3], usize> = HashMap::new();
        for part in &model.parts {
            for triangle in model.indices[part.indices.clone()].chunks_exact(3) {
                expected.insert(triangle.try_into().unwrap(), part.material);
            }
        }
        assert_eq!(built.indices.len(), model.indices.len());
        let mut next = 0;
        for batch in &built.batches {
            for cluster in &built.clusters[batch.clusters.clone()] {
                assert_eq!(cluster.start, next, "clusters leave no gap");
                next = cluster.end;
                assert!(cluster.end - cluster.start <= 3 * SPLIT_ABOVE as u32);
                for triangle in built.indices[cluster.start as usize..cluster.end as usize].chunks_exact(3) {
                    assert_eq!(expected.remove(triangle), Some(batch.material));
                    for &v in triangle {
                        assert_eq!(cluster.bounds.distance(model.vertices[v as usize].position), 0.0);
                    }
                }
            }
        }
        assert!(expected.is_empty());
        let is_blended = |position| built.blended_boxes.iter().any(|bounds| bounds.distance(position) == 0.0);
        let blended =
            model.parts.iter().filter(|part| part.material == 0).flat_map(|part| part.indices.clone());
        assert!(blended.into_iter().all(|i| is_blended(model.vertices[model.indices[i] as usize].position)));
        let used: Vec<_> = built.batches.iter().map(|b| b.material).collect();
        assert_eq!(used, [0, 1, 2, 4]);
    }

    #[test]
    fn large_parts_do_not_share_clusters() {
        let mut rng = Pcg64::seed_from_u64(2);
        let mut model = random_model(&mut rng);
        model.parts.iter_mut().for_each(|p| p.material = 0);
        let built = build(&model);
        let part_of =
            |vertex: u32| model.parts.iter().position(|p| p.indices.contains(&(vertex as usize))).unwrap();
        for cluster in &built.clusters {
            let mut parts: Vec<_> = built.indices[cluster.start as usize..cluster.end as usize]
                .iter()
                .map(|&v| part_of(v))
                .collect();
            parts.sort_unstable();
            parts.dedup();
            let large = parts.iter().filter(|&&p| model.parts[p].indices.len() > 3 * GATHER_UP_TO).count();
            assert!(large == 0 || parts.len() == 1);
        }
    }

    fn random_view(rng: &mut Pcg64) -> View {
        let mut point =
            |r: f32| Vec3::new(rng.random_range(-r..r), rng.random_range(-r..r), rng.random_range(-r..r));
        let pose = Pose::look_at(point(30.0), point(30.0));
        let depth = DepthRange {
            near: 0.1,
            far: [20.0, 1000.0, f32::INFINITY][rng.random_range(0..3)],
            convention: [DepthConvention::Standard, DepthConvention::Reversed][rng.random_range(0..2)],
        };
        let frustum = Frustum { left: -1.2, right: 0.4, bottom: -0.3, top: 0.9 };
        View { pose, frustum, depth, size: [160, 120] }
    }

    #[test]
    fn nothing_visible_is_culled_and_most_of_the_rest_is() {
        let mut rng = Pcg64::seed_from_u64(3);
        let (mut hidden, mut culled) = (0, 0);
        for _ in 0..300 {
            let view = random_view(&mut rng);
            let culler = Culler::of_view(&view);
            let matrix = view.view_projection();
            for _ in 0..20 {
                let mut coordinate = |r: f32| rng.random_range(-r..r);
                let center = Vec3::new(coordinate(60.0), coordinate(60.0), coordinate(60.0));
                let half = Vec3::new(coordinate(4.0), coordinate(4.0), coordinate(4.0)).abs();
                let bounds = Bounds { min: center - half, max: center + half };
                let visible = (0..200).any(|_| {
                    let t = Vec3::new(rng.random(), rng.random(), rng.random());
                    let clip = matrix * (bounds.min + (bounds.max - bounds.min) * t).extend(1.0);
                    clip.w > 0.0 && clip.truncate().abs().max_element() <= clip.w
                });
                if visible {
                    assert!(culler.sees(&bounds), "{view:?} {bounds:?}");
                    assert!(culler.sees_sphere(center, half.length()));
                } else {
                    hidden += 1;
                    culled += !culler.sees(&bounds) as usize;
                }
            }
        }
        assert!(culled * 10 > hidden * 9, "{culled} of {hidden}");
    }

    #[test]
    fn adjacent_ranges_merge() {
        let mut rng = Pcg64::seed_from_u64(4);
        let model = random_model(&mut rng);
        let built = build(&model);
        for _ in 0..50 {
            let culler = Culler::of_view(&random_view(&mut rng));
            let ranges: Vec<_> = culler.visible(&built.clusters).collect();
            assert!(ranges.windows(2).all(|w| w[0].end < w[1].start), "adjacent ranges are one");
        }
    }

    #[test]
    fn integer_keys_keep_the_order_of_floats() {
        let values = [f32::NEG_INFINITY, -3.5, -1e-20, -0.0, 0.0, 1e-20, 2.0, f32::INFINITY];
        assert!(values.windows(2).all(|w| ordered(w[0]) <= ordered(w[1]) || w[0] == w[1]));
    }
}
