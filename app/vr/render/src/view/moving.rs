//! The moving parts of a scene, on the GPU.

use std::cell::{Cell, RefCell};
use std::rc::Rc;

use super::cluster::{Batch, Cluster, VERTEX_ATTRIBUTES};
use yoro_assets::{Jumps, Model, Moment, Motion, Part, Vertex};
use yoro_gl::{Context, GlError, Mesh};

/// Vertices that are computed on the CPU and rewritten whenever the time changes. Each moving part of the model is a
/// cluster with the bounds of the mesh it belongs to.
pub struct Moving {
    pub motion: Motion,
    pub moment: Moment,
    pub mesh: Mesh,
    pieces: Vec<Piece>,
    /// Index of the first piece's cluster; the others follow it.
    first: usize,
    seconds: f64,
    /// The vertices before the last [`Moving::set_time`].
    previous: Vec<Vertex>,
    jumps: RefCell<Jumps>,
    /// The times of the last step, until somebody asks what has jumped in it: nobody does without motion vectors.
    unasked_step: Cell<Option<[f64; 2]>>,
    /// True if the last [`Moving::set_time`] moved the scene on in a short step. After a long one nothing would go on as it
    /// came.
    has_moved: bool,
}

/// The longest step in seconds that is not a jump.
const LONGEST_STEP: f64 = 0.25;
/// What is faster, in metres per second, has jumped.
const HIGHEST_SPEED: f64 = 10.0;

/// A part that moves.
struct Piece {
    material: usize,
    /// Range of the mesh's indices.
    start: u32,
    end: u32,
    /// Index into [`Motion::meshes`].
    moved: usize,
}

impl Moving {
    /// Takes the moving parts out of a model. `None` if nothing moves.
    pub fn take(gl: &Rc<Context>, model: &mut Model, motion: Motion) -> Result<Option<Moving>, GlError> {
        if motion.is_still() {
            return Ok(None);
        }
        let ranges: Vec<_> = motion.meshes.iter().map(|mesh| mesh.vertices.clone()).collect();
        let moved = |part: &Part| {
            let vertices = || model.indices[part.indices.clone()].iter().map(|&v| v as usize);
            let first = vertices().next()?;
            let at = ranges.partition_point(|range| range.end <= first);
            vertices().all(|v| ranges.get(at).is_some_and(|range| range.contains(&v))).then_some(at)
        };
        let mut parts: Vec<(Part, usize)> =
            model.parts.iter().filter_map(|part| Some((part.clone(), moved(part)?))).collect();
        parts.sort_by_key(|(part, _)| part.material);
        let still: Vec<Part> = model.parts.iter().filter(|part| moved(part).is_none()).cloned().collect();
        // For each range, the index of its first vertex among all moving vertices.
        let firsts: Vec<usize> =
            ranges.iter().scan(0, |next, range| Some(std::mem::replace(next, *next + range.len()))).collect();
        let (mut indices, mut pieces) = (Vec::new(), Vec::new());
        for (part, at) in parts {
            let start = indices.len() as u32;
            let shift = |v: &u32| (*v as usize - ranges[at].start + firsts[at]) as u32;
            indices.extend(model.indices[part.indices].iter().map(shift));
            pieces.push(Piece { material: part.material, start, end: indices.len() as u32, moved: at });
        }
        model.parts = still;
        let moment = motion.start();
        let mesh = Mesh::rewritable(gl, &VERTEX_ATTRIBUTES, &moment.vertices, &indices)?;
        let (previous, jumps) = (moment.vertices.clone(), RefCell::default());
        Ok(Some(Moving {
            motion,
            moment,
            mesh,
            pieces,
            first: 0,
            seconds: 0.0,
            previous,
            jumps,
            unasked_step: Cell::new(None),
            has_moved: false,
        }))
    }

    /// Appends the moving parts to a scene's clusters, in batches of their own after those of the still parts.
    pub fn append(&mut self, clusters: &mut Vec<Cluster>, batches: &mut Vec<Batch>) {
        self.first = clusters.len();
        for pieces in self.pieces.chunk_by(|a, b| a.material == b.material) {
            let first = clusters.len();
            clusters.extend(pieces.iter().map(|piece| Cluster {
                bounds: self.moment.bounds[piece.moved],
                start: piece.start,
                end: piece.end,
            }));
            batches.push(Batch {
                material: pieces[0].material,
                clusters: first..clusters.len(),
                moves: true,
            });
        }
    }

    /// Binds the mesh, with the positions before the last step of the time, if it was one, at the location after those of
    /// vertices.
    pub fn bind_with_previous(&self) {
        if let Some(times) = self.unasked_step.take() {
            self.forget_jumps(times);
        }
        self.mesh.bind_with_previous(self.has_moved);
    }

    /// Returns the clusters that move.
    pub fn of<'a>(&self, clusters: &'a [Cluster]) -> &'a [Cluster] {
        &clusters[self.first..self.first + self.pieces.len()]
    }

    /// Moves everything, and the clusters' bounds, to its place at a time in seconds. False if it is there already.
    pub fn set_time(&mut self, seconds: f64, clusters: &mut [Cluster]) -> bool {
        self.has_moved = false;
        if seconds == self.seconds {
            return false;
        }
        let before = std::mem::replace(&mut self.seconds, seconds);
        self.has_moved = (seconds - before).abs() < LONGEST_STEP;
        std::mem::swap(&mut self.moment.vertices, &mut self.previous);
        self.motion.at(seconds, &mut self.moment);
        self.mesh.rewrite(&self.moment.vertices);
        self.unasked_step.set(self.has_moved.then_some([before, seconds]));
        for (piece, cluster) in self.pieces.iter().zip(&mut clusters[self.first..]) {
            cluster.bounds = self.moment.bounds[piece.moved];
        }
        true
    }

    /// Makes the present vertices the previous ones of what has jumped between two times.
    fn forget_jumps(&self, times: [f64; 2]) {
        let mut jumps = self.jumps.borrow_mut();
        self.motion.find_jumps(times, &mut jumps);
        let farthest = (HIGHEST_SPEED * (times[1] - times[0]).abs()) as f32;
        let (mut first, mut is_renewed) = (0, false);
        for (mesh, jumps) in self.motion.meshes.iter().zip(&jumps.meshes) {
            let vertices = first..first + mesh.vertices.len();
            first = vertices.end;
            let now = &self.moment.vertices[vertices.clone()];
            let is_fast = |(now, then): (&Vertex, &Vertex)| {
                now.position.distance_squared(then.position) > farthest * farthest
            };
            if *jumps || now.iter().zip(&self.previous[vertices.clone()]).any(is_fast) {
                if !std::mem::replace(&mut is_renewed, true) {
                    self.mesh.renew_previous(&self.previous);
                }
                self.mesh.rewrite_previous(vertices.start, now);
            }
        }
    }
}
