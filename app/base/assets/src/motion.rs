//! What moves in a scene, and where it is at a given time.
//!
//! Nodes move by keyframes, and carry triangles, joints of skins, and lights. [`Motion::at`] is a pure function of
//! time. It computes vertices on the CPU, so that every pass draws moving surfaces like all others, on any driver.

use std::ops::Range;

use glam::{Affine3A, Mat3A, Quat, Vec3, Vec3A};
use serde::{Deserialize, Serialize};

use super::model::{Bounds, PointLight, Sky, Vertex};

/// Number of moments of the longest loop that [`Motion::bounds`] samples.
const LOOKS: u32 = 32;

/// How values between two keys are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Interpolation {
    /// The earlier key's value.
    Step,
    /// Linear; rotations go the short way round at constant speed.
    #[default]
    Linear,
    /// A cubic Hermite spline through the keys, with tangents as in glTF.
    CubicSpline,
}

/// A value animated by keyframes. Before the first key it has that key's value, after the last key that one's.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Track {
    /// Index into [`Motion::loops`].
    pub clock: usize,
    /// Times of the keys in seconds, increasing; at least one.
    pub times: Vec<f32>,
    /// The keys' values, one after the other. For a cubic spline each key has the tangent before it, the value, and the
    /// tangent after it.
    pub values: Vec<f32>,
    /// How values between two keys are computed.
    pub interpolation: Interpolation,
}

impl Track {
    /// Returns the number of keys up to a time of its clock.
    fn passed(&self, now: f32) -> usize {
        self.times.partition_point(|&time| time <= now)
    }

    /// Writes the value at the current time of its clock.
    fn sample(&self, clocks: &[f32], out: &mut [f32]) {
        let width = out.len();
        let spline = self.interpolation == Interpolation::CubicSpline;
        let part = |key: usize, part: usize| {
            &self.values[(key * if spline { 3 } else { 1 } + part) * width..][..width]
        };
        let value = |key: usize| part(key, usize::from(spline));
        let (now, keys) = (clocks[self.clock], self.times.len());
        let after = self.passed(now);
        if after == 0 || after == keys || self.interpolation == Interpolation::Step {
            out.copy_from_slice(value(after.saturating_sub(1)));
            return;
        }
        let before = after - 1;
        let length = self.times[after] - self.times[before];
        let t = (now - self.times[before]) / length;
        if !spline {
            let ends = value(before).iter().zip(value(after));
            out.iter_mut().zip(ends).for_each(|(out, (a, b))| *out = a + (b - a) * t);
            return;
        }
        let (square, cube) = (t * t, t * t * t);
        let shares = [
            2.0 * cube - 3.0 * square + 1.0,
            (cube - 2.0 * square + t) * length,
            3.0 * square - 2.0 * cube,
            (cube - square) * length,
        ];
        let ends = [value(before), part(before, 2), value(after), part(after, 0)];
        for (k, out) in out.iter_mut().enumerate() {
            *out = shares.iter().zip(ends).map(|(share, end)| share * end[k]).sum();
        }
    }

    /// True if the value does not go on from one time to another one, but starts over, or is another one at once.
    fn jumps(&self, loops: &[f32], [from, to]: [f64; 2]) -> bool {
        let length = loops[self.clock];
        if length <= 0.0 || self.times.len() < 2 {
            return false;
        }
        let round = |seconds: f64| (seconds / f64::from(length)).floor();
        let value = |seconds: f64| {
            let before = self.passed(clock(length, seconds)).saturating_sub(1);
            let width = self.values.len() / self.times.len();
            &self.values[before * width..][..width]
        };
        round(from) != round(to) || self.interpolation == Interpolation::Step && value(from) != value(to)
    }

    fn vector(&self, clocks: &[f32]) -> Vec3 {
        let mut out = [0.0; 3];
        self.sample(clocks, &mut out);
        out.into()
    }

    fn rotation(&self, clocks: &[f32]) -> Quat {
        let mut out = [0.0; 4];
        let after = self.passed(clocks[self.clock]);
        if self.interpolation == Interpolation::Linear && after > 0 && after < self.times.len() {
            let key = |key: usize| unit(Quat::from_slice(&self.values[key * 4..]));
            let length = self.times[after] - self.times[after - 1];
            let t = (clocks[self.clock] - self.times[after - 1]) / length;
            return if t > 0.0 { key(after - 1).slerp(key(after), t) } else { key(after - 1) };
        }
        self.sample(clocks, &mut out);
        unit(Quat::from_array(out))
    }
}

/// Returns the time of a clock that starts over after `length` seconds; 0 for a clock that stands still.
fn clock(length: f32, seconds: f64) -> f32 {
    if length > 0.0 { seconds.rem_euclid(f64::from(length)) as f32 } else { 0.0 }
}

/// Returns the rotation normalized, or the identity for the zeros of a damaged file.
fn unit(rotation: Quat) -> Quat {
    let length = rotation.length();
    if length > 0.0 && length.is_finite() { rotation / length } else { Quat::IDENTITY }
}

/// A node: a frame that contains other nodes, triangles or lights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Node {
    /// Index of the parent node, smaller than this node's; `None` for the world.
    pub parent: Option<usize>,
    /// The transform from the node's own frame, before its motion, to the parent's.
    pub fixed: Affine3A,
    /// Translation in metres, if `moves` is `None`.
    pub translation: Vec3,
    /// Rotation, if `turns` is `None`.
    pub rotation: Quat,
    /// Scale, if `grows` is `None`.
    pub scale: Vec3,
    /// The keys of the translation, three numbers each.
    pub moves: Option<Track>,
    /// The keys of the rotation, quaternions x, y, z, w.
    pub turns: Option<Track>,
    /// The keys of the scale, three numbers each.
    pub grows: Option<Track>,
}

impl Default for Node {
    fn default() -> Node {
        Node {
            parent: None,
            fixed: Affine3A::IDENTITY,
            translation: Vec3::ZERO,
            rotation: Quat::IDENTITY,
            scale: Vec3::ONE,
            moves: None,
            turns: None,
            grows: None,
        }
    }
}

impl Node {
    /// Returns the transform to the parent's frame.
    fn at(&self, clocks: &[f32]) -> Affine3A {
        let translation = self.moves.as_ref().map_or(self.translation, |track| track.vector(clocks));
        let rotation = self.turns.as_ref().map_or(self.rotation, |track| track.rotation(clocks));
        let scale = self.grows.as_ref().map_or(self.scale, |track| track.vector(clocks));
        self.fixed * Affine3A::from_scale_rotation_translation(scale, rotation, translation)
    }

    /// True if the node jumps between two times, or had no extent at the first one, to which `clocks` are set.
    fn jumps(&self, loops: &[f32], clocks: &[f32], times: [f64; 2]) -> bool {
        let tracks = [&self.moves, &self.turns, &self.grows];
        let is_absent = |track: &Track| track.vector(clocks) == Vec3::ZERO;
        tracks.into_iter().flatten().any(|track| track.jumps(loops, times))
            || self.grows.as_ref().is_some_and(is_absent)
    }
}

/// The joints that move a vertex, and their shares, which add up to one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Influence {
    /// Indices into [`Carrier::Skin`]'s joints.
    pub joints: [u16; 4],
    /// Shares; 0 for no joint.
    pub shares: [f32; 4],
}

/// What carries vertices.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Carrier {
    /// A node.
    Node(usize),
    /// Joints.
    Skin {
        /// Nodes, and the transforms from the mesh's frame to theirs in the bind pose.
        joints: Vec<(usize, Affine3A)>,
        /// The influences on each vertex.
        influences: Vec<Influence>,
    },
}

/// Shapes that are blended into the shape at rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Morph {
    /// For each shape, the differences of each vertex's position and normal from the shape at rest.
    pub targets: Vec<Vec<[Vec3; 2]>>,
    /// The shapes' weights, if `changes` is `None`.
    pub weights: Vec<f32>,
    /// The keys of the weights, each with one number per shape.
    pub changes: Option<Track>,
}

/// Vertices that move.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MovingMesh {
    /// Range of the model's vertices. A part of the model has all of its vertices in one such range, or none of them.
    pub vertices: Range<usize>,
    /// These vertices in the frame of their carrier.
    pub rest: Vec<Vertex>,
    /// What carries them.
    pub carrier: Carrier,
    /// The shapes that are blended in before the vertices are carried.
    pub morph: Option<Morph>,
}

/// A point light that moves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MovingLight {
    /// Index into [`Scene::lights`](crate::Scene::lights).
    pub light: usize,
    /// The node that carries it.
    pub node: usize,
    /// Its position in the node's frame.
    pub position: Vec3,
}

/// Everything that moves in a scene; by default nothing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// For each clock, the seconds after which it starts over; 0 for a clock that stands still.
    pub loops: Vec<f32>,
    /// Nodes, each after its parent.
    pub nodes: Vec<Node>,
    /// Vertices that move, in the order of the model's vertices.
    pub meshes: Vec<MovingMesh>,
    /// Lights that move.
    pub lights: Vec<MovingLight>,
    /// The node whose Z axis points to the sun, if the sun moves.
    pub sun: Option<usize>,
}

/// The state of everything that moves at one time. Made once, and filled by [`Motion::at`] without allocation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moment {
    /// The vertices of all of [`Motion::meshes`], one mesh after the other.
    pub vertices: Vec<Vertex>,
    /// The smallest box around each mesh.
    pub bounds: Vec<Bounds>,
    /// The positions of [`Motion::lights`].
    pub lights: Vec<Vec3>,
    /// The direction to the sun, if it moves.
    pub sun: Option<Vec3>,
    clocks: Vec<f32>,
    /// Transforms of the nodes to world space.
    nodes: Vec<Affine3A>,
    /// Transforms from a skin's mesh to world space, by joint.
    joints: Vec<Affine3A>,
    weights: Vec<f32>,
}

/// What jumps between two times. Made once, and filled by [`Motion::find_jumps`] without allocation.
#[derive(Clone, Debug, Default)]
pub struct Jumps {
    /// For each of [`Motion::meshes`], whether it jumps.
    pub meshes: Vec<bool>,
    nodes: Vec<bool>,
    clocks: Vec<f32>,
}

impl Motion {
    /// True if nothing moves.
    pub fn is_still(&self) -> bool {
        self.meshes.is_empty() && self.lights.is_empty() && self.sun.is_none()
    }

    /// Allocates a moment and fills it for time 0.
    pub fn start(&self) -> Moment {
        let joints = self.meshes.iter().map(|mesh| match &mesh.carrier {
            Carrier::Node(_) => 0,
            Carrier::Skin { joints, .. } => joints.len(),
        });
        let weights = self.meshes.iter().filter_map(|mesh| Some(mesh.morph.as_ref()?.weights.len()));
        let mut moment = Moment {
            vertices: Vec::with_capacity(self.meshes.iter().map(|mesh| mesh.rest.len()).sum()),
            bounds: Vec::with_capacity(self.meshes.len()),
            lights: Vec::with_capacity(self.lights.len()),
            sun: None,
            clocks: Vec::with_capacity(self.loops.len()),
            nodes: Vec::with_capacity(self.nodes.len()),
            joints: Vec::with_capacity(joints.max().unwrap_or(0)),
            weights: vec![0.0; weights.max().unwrap_or(0)],
        };
        self.at(0.0, &mut moment);
        moment
    }

    /// Fills a moment of this motion for a time in seconds. Every clock repeats its loop, also before time 0.
    pub fn at(&self, seconds: f64, moment: &mut Moment) {
        self.place_nodes(seconds, moment);
        let Moment { vertices, bounds, lights, sun, clocks, nodes, joints, weights } = moment;
        vertices.clear();
        bounds.clear();
        for mesh in &self.meshes {
            let first = vertices.len();
            vertices.extend_from_slice(&mesh.rest);
            let moved = &mut vertices[first..];
            if let Some(morph) = &mesh.morph {
                morph.blend(clocks, &mut weights[..morph.weights.len()], moved);
            }
            match &mesh.carrier {
                Carrier::Node(node) => carry(&nodes[*node], moved),
                Carrier::Skin { joints: bound, influences } => {
                    joints.clear();
                    joints.extend(bound.iter().map(|(node, to_joint)| nodes[*node] * *to_joint));
                    skin(joints, influences, moved);
                }
            }
            bounds.push(moved.iter().fold(Bounds::EMPTY, |bounds, v| bounds.including(v.position)));
        }
        lights.clear();
        lights.extend(self.lights.iter().map(|l| nodes[l.node].transform_point3(l.position)));
        *sun = self.sun.map(|node| nodes[node].transform_vector3(Vec3::Z).normalize_or(Vec3::Y));
    }

    /// Finds what does not move on from one time to another one but jumps, so that it has no motion between them: what has
    /// stepped to another value, appears (its scale was 0), or is carried by keys whose loop starts over.
    pub fn find_jumps(&self, times: [f64; 2], found: &mut Jumps) {
        let Jumps { meshes, nodes, clocks } = found;
        clocks.clear();
        clocks.extend(self.loops.iter().map(|&length| clock(length, times[0])));
        nodes.clear();
        for node in &self.nodes {
            let with_parent = node.parent.is_some_and(|parent| nodes[parent]);
            nodes.push(with_parent || node.jumps(&self.loops, clocks, times));
        }
        meshes.clear();
        meshes.extend(self.meshes.iter().map(|mesh| {
            let is_carried = match &mesh.carrier {
                Carrier::Node(node) => nodes[*node],
                Carrier::Skin { joints, .. } => joints.iter().any(|(node, _)| nodes[*node]),
            };
            let changes = mesh.morph.as_ref().and_then(|morph| morph.changes.as_ref());
            is_carried || changes.is_some_and(|track| track.jumps(&self.loops, times))
        }));
    }

    /// Fills in the nodes of a moment.
    fn place_nodes(&self, seconds: f64, moment: &mut Moment) {
        let Moment { clocks, nodes, .. } = moment;
        clocks.clear();
        clocks.extend(self.loops.iter().map(|&length| clock(length, seconds)));
        nodes.clear();
        for node in &self.nodes {
            let own = node.at(clocks);
            nodes.push(node.parent.map_or(own, |parent| nodes[parent] * own));
        }
    }

    /// Returns the transforms of all nodes to world space at time 0.
    pub(crate) fn nodes_at_start(&self) -> Vec<Affine3A> {
        let mut moment = Moment::default();
        self.place_nodes(0.0, &mut moment);
        moment.nodes
    }

    /// Returns the smallest box around all moving triangles, sampled at 32 moments of the longest loop; empty if no
    /// triangles move.
    pub fn bounds(&self) -> Bounds {
        let mut moment = self.start();
        let longest = self.loops.iter().copied().fold(0.0, f32::max);
        let mut all = Bounds::EMPTY;
        for look in 0..LOOKS {
            self.at(f64::from(longest) * f64::from(look) / f64::from(LOOKS), &mut moment);
            all = moment.bounds.iter().fold(all, |all, b| all.including(b.min).including(b.max));
        }
        all
    }

    /// Moves everything by a vector.
    pub(crate) fn shift(&mut self, by: Vec3) {
        for node in self.nodes.iter_mut().filter(|node| node.parent.is_none()) {
            node.fixed = Affine3A::from_translation(by) * node.fixed;
        }
    }

    /// Scales everything around the origin.
    pub(crate) fn enlarge(&mut self, scale: f32) {
        for node in self.nodes.iter_mut().filter(|node| node.parent.is_none()) {
            node.fixed = Affine3A::from_scale(Vec3::splat(scale)) * node.fixed;
        }
    }
}

impl Morph {
    /// Adds the shapes to the vertices. `weights` is scratch space for their weights.
    fn blend(&self, clocks: &[f32], weights: &mut [f32], vertices: &mut [Vertex]) {
        match &self.changes {
            Some(track) => track.sample(clocks, weights),
            None => weights.copy_from_slice(&self.weights),
        }
        for (target, &weight) in self.targets.iter().zip(weights.iter()).filter(|(_, weight)| **weight != 0.0)
        {
            for (vertex, [position, normal]) in vertices.iter_mut().zip(target) {
                vertex.position += *position * weight;
                vertex.normal += *normal * weight;
            }
        }
        vertices.iter_mut().for_each(|v| v.normal = v.normal.normalize_or(Vec3::Y));
    }
}

/// Moves vertices with a node. A node that has not moved leaves them unchanged, to the bit.
fn carry(to_world: &Affine3A, vertices: &mut [Vertex]) {
    if *to_world == Affine3A::IDENTITY {
        return;
    }
    let normals = normal_matrix(&to_world.matrix3);
    for v in vertices {
        v.position = to_world.transform_point3(v.position);
        v.normal = Vec3::from(normals * Vec3A::from(v.normal)).normalize_or(Vec3::Y);
    }
}

/// Moves vertices by the mean of their joints. Joints that have not moved leave them unchanged, to the bit.
fn skin(joints: &[Affine3A], influences: &[Influence], vertices: &mut [Vertex]) {
    if joints.iter().all(|joint| *joint == Affine3A::IDENTITY) {
        return;
    }
    for (v, influence) in vertices.iter_mut().zip(influences) {
        let mut to_world = Affine3A { matrix3: Mat3A::ZERO, translation: Vec3A::ZERO };
        for (&joint, &share) in
            influence.joints.iter().zip(&influence.shares).filter(|(_, share)| **share != 0.0)
        {
            let joint = &joints[usize::from(joint)];
            to_world.matrix3 += joint.matrix3 * share;
            to_world.translation += joint.translation * share;
        }
        v.position = to_world.transform_point3(v.position);
        let normal = normal_matrix(&to_world.matrix3) * Vec3A::from(v.normal);
        v.normal = Vec3::from(normal).normalize_or(Vec3::Y);
    }
}

/// Returns the cofactors: the inverse transpose, for normals, without the division. Mirroring keeps the side.
fn normal_matrix(linear: &Mat3A) -> Mat3A {
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    let cofactors = Mat3A::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if x.dot(cofactors.x_axis) < 0.0 { cofactors * -1.0 } else { cofactors }
}

impl Moment {
    /// Copies the moving vertices to their places in a model.
    pub(crate) fn place(&self, motion: &Motion, vertices: &mut [Vertex]) {
        let mut from = 0;
        for mesh in &motion.meshes {
            let count = mesh.vertices.len();
            vertices[mesh.vertices.clone()].copy_from_slice(&self.vertices[from..from + count]);
            from += count;
        }
    }

    /// Updates a scene's moving lights and its sun.
    pub fn light(&self, motion: &Motion, lights: &mut [PointLight], sky: &mut Sky) {
        for (light, position) in motion.lights.iter().zip(&self.lights) {
            lights[light.light].position = *position;
        }
        sky.sun_direction = self.sun.unwrap_or(sky.sun_direction);
    }
}
