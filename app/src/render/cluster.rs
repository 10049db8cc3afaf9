//! Spatial clusters: runs of triangles that are drawn or left out together.

use std::ops::Range;

use glam::{Mat4, Vec3, Vec4};

use crate::scene::{Bounds, Model, Vertex};

/// A part with more triangles than this is split.
const SPLIT_ABOVE: usize = 4096;
/// Neighbouring parts are put into one cluster up to this many triangles.
const GATHER_UP_TO: usize = 512;

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
    /// Its clusters, neighbours in space near each other in the list, without gaps in their indices.
    pub clusters: Range<usize>,
}

/// What [`build`] makes of a model's parts.
pub struct Clusters {
    /// All clusters, batch after batch.
    pub clusters: Vec<Cluster>,
    /// One batch for each material that is used, ordered by material.
    pub batches: Vec<Batch>,
    /// The model's indices in the order of the clusters.
    pub indices: Vec<u32>,
}

/// A set of triangles that is not split any further.
struct Unit {
    bounds: Bounds,
    triangles: Range<usize>,
}

/// Sorts a model's triangles by material and place. A cluster holds one piece of a part, or several small
/// parts that lie together; it never holds pieces of two large parts.
pub fn build(model: &Model) -> Clusters {
    let mut built = Clusters {
        clusters: Vec::new(),
        batches: Vec::new(),
        indices: Vec::with_capacity(model.indices.len()),
    };
    // First indices of triangles, permuted part by part.
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
        built.batches.push(Batch { material, clusters: first..built.clusters.len() });
    }
    built
}

fn corners<'a>(model: &'a Model, triangle: u32) -> impl Iterator<Item = &'a Vertex> {
    let i = triangle as usize;
    model.indices[i..i + 3].iter().map(|&v| &model.vertices[v as usize])
}

/// Splits `triangles[first..]` at the median of the longest axis until the pieces are small enough.
fn split_triangles(model: &Model, triangles: &mut [u32], first: usize, units: &mut Vec<Unit>) {
    let piece = &mut triangles[first..];
    let bounds =
        piece.iter().flat_map(|&t| corners(model, t)).fold(Bounds::EMPTY, |b, v| b.including(v.position));
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

/// A total order of finite floats as integers.
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

/// Which objects of a scene to draw.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Selection {
    /// All of them.
    #[default]
    All,
    /// Those whose bounds come nearer to `from` than `distance` metres.
    Nearer {
        /// Usually the midpoint between the eyes.
        from: Vec3,
        /// Metres.
        distance: f32,
    },
    /// The others.
    Farther {
        /// Usually the midpoint between the eyes.
        from: Vec3,
        /// Metres.
        distance: f32,
    },
}

impl Selection {
    fn contains(&self, bounds: &Bounds) -> bool {
        match *self {
            Selection::All => true,
            Selection::Nearer { from, distance } => bounds.distance(from) < distance,
            Selection::Farther { from, distance } => bounds.distance(from) >= distance,
        }
    }
}

/// Decides what a view sees: the six planes of its clip volume, and a selection.
#[derive(Clone, Copy, Debug)]
pub struct Culler {
    planes: [Vec4; 6],
    eye: Vec3,
    selection: Selection,
}

impl Culler {
    /// A culler for the clip volume of `eye_to_clip`, which takes positions relative to `eye`.
    pub fn new(eye: Vec3, eye_to_clip: &Mat4, selection: Selection) -> Culler {
        let m = eye_to_clip.transpose();
        let (x, y, z, w) = (m.x_axis, m.y_axis, m.z_axis, m.w_axis);
        Culler { planes: [w + x, w - x, w + y, w - y, w + z, w - z], eye, selection }
    }

    /// Whether any of the box may be seen.
    pub fn sees(&self, bounds: &Bounds) -> bool {
        let (min, max) = (bounds.min - self.eye, bounds.max - self.eye);
        self.planes.iter().all(|plane| {
            let normal = plane.truncate();
            let farthest = Vec3::select(normal.cmpgt(Vec3::ZERO), max, min);
            // The slack covers the rounding of the planes, which far away is that of an infinite far plane.
            let reach = normal.abs().dot(min.abs().max(max.abs())) + plane.w.abs();
            normal.dot(farthest) + plane.w >= -1e-5 * reach
        }) && self.selection.contains(bounds)
    }

    /// Whether any of the sphere may be seen.
    pub fn sees_sphere(&self, center: Vec3, radius: f32) -> bool {
        let center = center - self.eye;
        self.planes.iter().all(|plane| {
            let normal = plane.truncate();
            normal.dot(center) + plane.w >= -radius * normal.length() * 1.001 - 1e-4
        })
    }

    /// The index ranges of the clusters that may be seen, adjacent ones merged.
    pub fn visible<'a>(&'a self, clusters: &'a [Cluster]) -> impl Iterator<Item = Range<usize>> + 'a {
        let mut seen = clusters.iter().filter(|c| self.sees(&c.bounds)).peekable();
        std::iter::from_fn(move || {
            let first = seen.next()?;
            let mut end = first.end;
            while let Some(next) = seen.next_if(|c| c.start == end) {
                end = next.end;
            }
            Some(first.start as usize..end as usize)
        })
    }
}
