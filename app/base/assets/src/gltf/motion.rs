//! The motion of a glTF file: its animations, skins and morph targets.

use std::collections::HashMap;

use glam::{Affine3A, DMat4, DVec3, Mat4, Quat, Vec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::animation::Property;
use gltf::{Document, Mesh, Node, Primitive, Semantic};

use super::reader::Reader;
use crate::error::{FAR, MAX_ELEMENTS, SceneError};
use crate::model::Model;
use crate::motion::{self, Carrier, Influence, Interpolation, Morph, Motion, MovingMesh, Track};
use crate::repair::Placed;

/// A node in its state at the start of the animations.
#[derive(Clone)]
pub(super) struct Standing<'a> {
    pub node: Node<'a>,
    pub to_world: Mat4,
    /// The node of [`Motion`] that moves it, if it moves.
    pub mover: Option<usize>,
}

/// The nodes of a scene and their motion.
pub(super) struct Moves<'a> {
    /// All nodes, each after its parent.
    pub standing: Vec<Standing<'a>>,
    /// The motion's nodes and clocks.
    pub motion: Motion,
    /// What is subtracted from all positions: nodes far from the origin are brought to it before f32 rounds their
    /// places.
    pub subtracted: DVec3,
    /// The weights of morph targets by node.
    weights: HashMap<usize, Track>,
    /// Indices into `standing` by node.
    places: HashMap<usize, usize>,
    /// Nodes of `motion` made for nodes that do not move, by node.
    still: HashMap<usize, usize>,
}

/// The triangles of a primitive that is carried by a node or by joints.
#[derive(Clone)]
pub(super) struct Carried {
    carrier: Carrier,
    morph: Option<Morph>,
    moves: bool,
    /// True if it is mirrored at the start of the animations.
    pub mirrored: bool,
}

/// A node and the number of one of its properties.
type Target = (usize, u8);

fn target(node: &Node, property: Property) -> Target {
    (node.index(), property as u8)
}

/// The tracks of the animations that are used, and the lengths of their loops in seconds.
#[derive(Default)]
struct Tracks {
    loops: Vec<f32>,
    tracks: HashMap<Target, Track>,
}

impl<'a> Moves<'a> {
    /// Returns the motion's node for a node, moving or not.
    fn node(&mut self, standing: usize) -> usize {
        let Standing { node, to_world, mover } = &self.standing[standing];
        let nodes = &mut self.motion.nodes;
        mover.unwrap_or_else(|| {
            *self.still.entry(node.index()).or_insert_with(|| {
                nodes.push(motion::Node { fixed: Affine3A::from_mat4(*to_world), ..motion::Node::default() });
                nodes.len() - 1
            })
        })
    }
}

/// Adds what is carried to the motion if it ever moves, and to the model in its state at time 0.
pub(super) fn place_carried(
    carried: &[Carried],
    placed: Vec<Placed>,
    motion: &mut Motion,
    model: &mut Model,
) {
    let mut moves = Vec::new();
    for Placed { moving, vertices, sources } in placed {
        let Carried { carrier, morph, moves: does_move, .. } = &carried[moving];
        let carrier = match carrier {
            Carrier::Node(node) => Carrier::Node(*node),
            Carrier::Skin { joints, influences } => Carrier::Skin {
                joints: joints.clone(),
                influences: sources.iter().map(|&i| influences[i as usize]).collect(),
            },
        };
        let of_sources = |target: &Vec<[Vec3; 2]>| sources.iter().map(|&i| target[i as usize]).collect();
        let morph = morph
            .as_ref()
            .map(|morph| Morph { targets: morph.targets.iter().map(of_sources).collect(), ..morph.clone() });
        let rest = model.vertices[vertices.clone()].to_vec();
        motion.meshes.push(MovingMesh { vertices, rest, carrier, morph });
        moves.push(*does_move);
    }
    motion.start().place(motion, &mut model.vertices);
    let mut moves = moves.into_iter();
    motion.meshes.retain(|_| moves.next() == Some(true));
}

impl Reader<'_> {
    /// Returns the nodes of the default scene, or all nodes of a file without scenes, and their animations.
    pub(super) fn moves<'a>(&self, document: &'a Document) -> Result<Moves<'a>, SceneError> {
        let Tracks { loops, mut tracks } = self.tracks(document)?;
        let mut motion = Motion { loops, ..Motion::default() };
        let mut standing: Vec<Standing> = Vec::new();
        // By node of `standing`, and by node of the motion that has no moving parent.
        let (mut worlds, mut fixed): (Vec<DMat4>, Vec<(usize, DMat4)>) = (Vec::new(), Vec::new());
        let mut visited = vec![false; document.nodes().len()];
        let scene = document.default_scene().or_else(|| document.scenes().next());
        let mut open: Vec<(Node, Option<usize>)> = match scene {
            Some(scene) => scene.nodes().map(|node| (node, None)).collect(),
            None => document.nodes().map(|node| (node, None)).collect(),
        };
        open.reverse();
        let mut places = HashMap::new();
        while let Some((node, parent)) = open.pop() {
            // A node has one parent, but a damaged file may have cycles.
            if std::mem::replace(&mut visited[node.index()], true) {
                continue;
            }
            let (parent_world, parent_mover) =
                parent.map_or((DMat4::IDENTITY, None), |p: usize| (worlds[p], standing[p].mover));
            let mut take = |property| tracks.remove(&target(&node, property));
            let (moves, turns, grows) =
                (take(Property::Translation), take(Property::Rotation), take(Property::Scale));
            let stored = Mat4::from_cols_array_2d(&node.transform().matrix());
            let to_world = parent_world * stored.as_dmat4();
            let keyed = moves.is_some() || turns.is_some() || grows.is_some();
            let mover = (keyed || parent_mover.is_some()).then(|| {
                let mut own =
                    motion::Node { parent: parent_mover, moves, turns, grows, ..motion::Node::default() };
                if parent_mover.is_none() {
                    fixed.push((motion.nodes.len(), if keyed { parent_world } else { to_world }));
                }
                if keyed {
                    let (translation, rotation, scale) = node.transform().decomposed();
                    own.translation = translation.into();
                    own.rotation = Quat::from_array(rotation);
                    own.scale = scale.into();
                } else {
                    own.fixed = Affine3A::from_mat4(stored);
                }
                motion.nodes.push(own);
                motion.nodes.len() - 1
            });
            places.insert(node.index(), standing.len());
            open.extend(node.children().map(|child| (child, Some(standing.len()))));
            worlds.push(to_world);
            standing.push(Standing { node, to_world: Mat4::IDENTITY, mover });
        }
        let first = standing.iter().zip(&worlds).find(|(s, _)| s.node.mesh().is_some());
        let first = first.map_or(DVec3::ZERO, |(_, world)| world.w_axis.truncate().round());
        let subtracted = if first.is_finite() && first.length() > FAR { first } else { DVec3::ZERO };
        let to_origin = |world: &DMat4| (DMat4::from_translation(-subtracted) * *world).as_mat4();
        standing.iter_mut().zip(&worlds).for_each(|(s, world)| s.to_world = to_origin(world));
        fixed
            .iter()
            .for_each(|(node, world)| motion.nodes[*node].fixed = Affine3A::from_mat4(to_origin(world)));
        let start = motion.nodes_at_start();
        for Standing { to_world, mover, .. } in &mut standing {
            if let Some(mover) = *mover {
                *to_world = Mat4::from(start[mover]);
            }
        }
        // What is left of nodes in the scene are weights.
        let weights = tracks.into_iter().map(|((node, _), track)| (node, track)).collect();
        Ok(Moves { standing, motion, subtracted, weights, places, still: HashMap::new() })
    }

    /// Reads the animations, or the chosen one. Skips an animation that would move something that an earlier one moves.
    fn tracks(&self, document: &Document) -> Result<Tracks, SceneError> {
        let mut played = Tracks::default();
        let name = |animation: &gltf::Animation| {
            animation.name().map_or_else(|| animation.index().to_string(), str::to_owned)
        };
        let chosen = match self.animation {
            Some(wanted) => {
                let called = document.animations().find(|a| a.name() == Some(wanted));
                let found = called.or_else(|| document.animations().nth(wanted.parse().ok()?));
                let names: Vec<String> = document.animations().map(|a| name(&a)).collect();
                let unknown = || {
                    let remedy = match names.as_slice() {
                        [] => "it has none".to_owned(),
                        _ => format!("choose one of {}", names.join(", ")),
                    };
                    SceneError::unusable(self.path, format!("it has no animation {wanted}: {remedy}"))
                };
                Some(found.ok_or_else(unknown)?.index())
            }
            None => None,
        };
        let mut left_out = Vec::new();
        for animation in document.animations().filter(|a| chosen.is_none_or(|chosen| a.index() == chosen)) {
            let clock = played.loops.len();
            let mut tracks = HashMap::new();
            for channel in animation.channels() {
                let (node, property, sampler) =
                    (channel.target().node(), channel.target().property(), channel.sampler());
                let what = format!("channel {} of animation {}", channel.index(), animation.index());
                let interpolation = match sampler.interpolation() {
                    gltf::animation::Interpolation::Step => Interpolation::Step,
                    gltf::animation::Interpolation::Linear => Interpolation::Linear,
                    gltf::animation::Interpolation::CubicSpline => Interpolation::CubicSpline,
                };
                let times: Vec<f32> = self
                    .floats::<1>(&sampler.input(), &[Dimensions::Scalar])?
                    .into_iter()
                    .flatten()
                    .collect();
                let increase = times.windows(2).all(|pair| pair[0] < pair[1]);
                if times.is_empty() || !increase || !times.iter().all(|t| t.is_finite() && *t >= 0.0) {
                    return Err(self.damaged(format!("the times of {what} do not increase from 0 on")));
                }
                let output = sampler.output();
                let (width, values): (usize, Vec<f32>) = match property {
                    Property::Translation | Property::Scale => {
                        let values = self.floats::<3>(&output, &[Dimensions::Vec3])?;
                        (3, values.into_iter().flatten().collect())
                    }
                    Property::Rotation => {
                        let values = self.floats::<4>(&output, &[Dimensions::Vec4])?;
                        (4, values.into_iter().flatten().collect())
                    }
                    Property::MorphTargetWeights => {
                        let mesh = node.mesh();
                        let shapes =
                            mesh.and_then(|mesh| Some(mesh.primitives().next()?.morph_targets().count()));
                        let Some(shapes) = shapes.filter(|shapes| *shapes > 0) else {
                            let what =
                                format!("{what} moves node {}, which has no morph targets", node.index());
                            return Err(self.damaged(what));
                        };
                        let values = self.floats::<1>(&output, &[Dimensions::Scalar])?;
                        (shapes, values.into_iter().flatten().collect())
                    }
                };
                let parts = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
                if times.len().checked_mul(parts * width) != Some(values.len()) {
                    let what = format!(
                        "{what} has {} numbers for {} keys of {width} each",
                        values.len(),
                        times.len() * parts
                    );
                    return Err(self.damaged(what));
                }
                if !values.iter().all(|value| value.is_finite()) {
                    return Err(self.damaged(format!("{what} has values that are not numbers")));
                }
                let track = Track { clock, times, values, interpolation };
                tracks.insert(target(&node, property), track);
            }
            if tracks.keys().any(|target| played.tracks.contains_key(target)) {
                left_out.push(name(&animation));
                continue;
            }
            let last = tracks.values().filter_map(|track| track.times.last()).copied();
            played.loops.push(last.fold(0.0, f32::max));
            played.tracks.extend(tracks);
        }
        if !left_out.is_empty() {
            log::warn!(
                "{}: animations that move what earlier ones move are left out: {}",
                self.path.display(),
                left_out.join(", ")
            );
        }
        Ok(played)
    }

    /// Returns what carries a node's primitive; `None` if the node does not move and the primitive keeps its shape.
    pub(super) fn carried(
        &self,
        moves: &mut Moves,
        at: usize,
        mesh: &Mesh,
        primitive: &Primitive,
    ) -> Result<Option<Carried>, SceneError> {
        let Standing { node, to_world, mover } = moves.standing[at].clone();
        let morph = self.morph(&node, mesh, primitive, moves.weights.get(&node.index()))?;
        let changes = morph.as_ref().is_some_and(|morph| morph.changes.is_some());
        // A mesh with a skin but no joints is placed by its node.
        let joints_named = |_: &gltf::Skin| primitive.get(&Semantic::Joints(0)).is_some();
        if let Some(skin) = node.skin().filter(joints_named) {
            let bound = self.joints(moves, &skin)?;
            let influences = self.influences(primitive, &skin, bound.len())?;
            let stands = |joint: &gltf::Node| moves.places.get(&joint.index()).map(|&at| &moves.standing[at]);
            let does_move =
                changes || skin.joints().filter_map(|joint| stands(&joint)).any(|s| s.mover.is_some());
            let first = skin.joints().next().and_then(|joint| stands(&joint));
            let mirrored = first.zip(bound.first()).is_some_and(|(joint, (_, to_joint))| {
                (joint.to_world * Mat4::from(*to_joint)).determinant() < 0.0
            });
            let carrier = Carrier::Skin { joints: bound, influences };
            return Ok(Some(Carried { carrier, morph, moves: does_move, mirrored }));
        }
        if mover.is_none() && morph.is_none() {
            return Ok(None);
        }
        let carrier = Carrier::Node(moves.node(at));
        let mirrored = to_world.determinant() < 0.0;
        Ok(Some(Carried { carrier, morph, moves: changes || mover.is_some(), mirrored }))
    }

    /// Returns a skin's joints as nodes of the motion, with the transforms to their frames.
    fn joints(&self, moves: &mut Moves, skin: &gltf::Skin) -> Result<Vec<(usize, Affine3A)>, SceneError> {
        let count = skin.joints().count();
        let to_joints = match skin.inverse_bind_matrices() {
            Some(accessor) => self.floats::<16>(&accessor, &[Dimensions::Mat4])?,
            None => vec![Mat4::IDENTITY.to_cols_array(); count],
        };
        if to_joints.len() < count {
            let what = format!("skin {} has {} matrices for {count} joints", skin.index(), to_joints.len());
            return Err(self.damaged(what));
        }
        let joint = |(joint, to_joint): (Node, &[f32; 16])| {
            let Some(&at) = moves.places.get(&joint.index()) else {
                let what = format!("joint {} of skin {} is not in the scene", joint.index(), skin.index());
                return Err(self.damaged(what));
            };
            Ok((moves.node(at), Affine3A::from_mat4(Mat4::from_cols_array(to_joint))))
        };
        skin.joints().zip(&to_joints).map(joint).collect()
    }

    /// Returns the joints of each vertex with their shares; if there are more than four, the four largest.
    fn influences(
        &self,
        primitive: &Primitive,
        skin: &gltf::Skin,
        joints: usize,
    ) -> Result<Vec<Influence>, SceneError> {
        let vertices = primitive.get(&Semantic::Positions).map_or(0, |a| a.count());
        let mut all = vec![Vec::new(); vertices];
        for set in 0.. {
            let accessors = (primitive.get(&Semantic::Joints(set)), primitive.get(&Semantic::Weights(set)));
            let (Some(joint), Some(weight)) = accessors else { break };
            for accessor in [&joint, &weight] {
                self.per_vertex(accessor, vertices)?;
            }
            if matches!(joint.data_type(), DataType::F32) || joint.normalized() {
                return Err(self.damaged(format!("accessor {} has the wrong type", joint.index())));
            }
            let joint = self.floats::<4>(&joint, &[Dimensions::Vec4])?;
            let weight = self.floats::<4>(&weight, &[Dimensions::Vec4])?;
            for (all, (joint, weight)) in all.iter_mut().zip(joint.into_iter().zip(weight)) {
                all.extend(joint.into_iter().zip(weight).filter(|(_, weight)| *weight > 0.0));
            }
        }
        let out_of_range = |joint: f32| {
            self.damaged(format!("a vertex names joint {joint} of skin {}, which has {joints}", skin.index()))
        };
        let influence = |mut all: Vec<(f32, f32)>| {
            if let Some((joint, _)) = all.iter().find(|(joint, _)| *joint as usize >= joints.min(1 << 16)) {
                return Err(out_of_range(*joint));
            }
            all.sort_by(|a, b| b.1.total_cmp(&a.1));
            all.truncate(4);
            if all.is_empty() {
                all.push((0.0, 1.0));
            }
            let sum: f32 = all.iter().map(|(_, weight)| weight).sum();
            let mut influence = Influence::default();
            for (k, (joint, weight)) in all.into_iter().enumerate() {
                influence.joints[k] = joint as u16;
                influence.shares[k] = weight / sum;
            }
            Ok(influence)
        };
        all.into_iter().map(influence).collect()
    }

    /// Refuses an accessor that does not have one element for each vertex of a primitive.
    fn per_vertex(&self, accessor: &gltf::Accessor, vertices: usize) -> Result<(), SceneError> {
        if accessor.count() == vertices {
            return Ok(());
        }
        let what = format!(
            "accessor {} has {} elements for {vertices} vertices",
            accessor.index(),
            accessor.count()
        );
        Err(self.damaged(what))
    }

    /// Returns a primitive's morph targets if they ever change its shape.
    fn morph(
        &self,
        node: &Node,
        mesh: &Mesh,
        primitive: &Primitive,
        changes: Option<&Track>,
    ) -> Result<Option<Morph>, SceneError> {
        let count = primitive.morph_targets().count();
        let vertices = primitive.get(&Semantic::Positions).map_or(0, |a| a.count());
        let mut weights = node.weights().or(mesh.weights()).unwrap_or_default().to_vec();
        weights.resize(count, 0.0);
        if count == 0 || changes.is_none() && weights.iter().all(|weight| *weight == 0.0) {
            return Ok(None);
        }
        if count.saturating_mul(vertices) > MAX_ELEMENTS {
            return Err(SceneError::too_large(self.path, MAX_ELEMENTS, "vertices in morph targets"));
        }
        let fits = |track: &Track| {
            let parts = if track.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
            track.values.len() == track.times.len() * parts * count
        };
        if !changes.is_none_or(fits) || !weights.iter().all(|weight| weight.is_finite()) {
            return Err(
                self.damaged(format!("the weights of mesh {} do not fit its morph targets", mesh.index()))
            );
        }
        let differences = |accessor: Option<gltf::Accessor>| match accessor {
            Some(accessor) => {
                self.per_vertex(&accessor, vertices)?;
                self.floats::<3>(&accessor, &[Dimensions::Vec3])
            }
            None => Ok(vec![[0.0; 3]; vertices]),
        };
        let mut targets = Vec::with_capacity(count);
        for target in primitive.morph_targets() {
            let (positions, normals) = (differences(target.positions())?, differences(target.normals())?);
            let finite = |v: [f32; 3]| Vec3::from(v.map(|x| if x.is_finite() { x } else { 0.0 }));
            targets.push(positions.into_iter().zip(normals).map(|(p, n)| [finite(p), finite(n)]).collect());
        }
        Ok(Some(Morph { targets, weights, changes: changes.cloned() }))
    }
}
