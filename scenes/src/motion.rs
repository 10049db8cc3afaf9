//! The motion of built-in scenes: nodes that turn or shift and come back, and the objects that they carry.

use std::collections::HashMap;

use glam::{Affine3A, Quat, Vec3};

use yoro_assets::motion::{Carrier, Influence, MovingLight, MovingMesh, Node, Track};
use yoro_assets::{Model, Motion, PointLight, Vertex};

/// Keys per loop.
const KEYS: u32 = 24;

/// Returns the share of a vertex that follows the second of two nodes, from its position in metres in the scene.
type Share = Box<dyn Fn(Vec3) -> f32>;

/// Collects what moves in one scene. At time 0 everything is where the model has it.
#[derive(Default)]
pub struct Movers {
    motion: Motion,
    /// What carries objects, by the objects' names.
    carried: HashMap<String, Carried>,
}

enum Carried {
    By(usize),
    Between([usize; 2], Share),
}

impl Movers {
    /// Adds a node that turns about a joint, in `parent` or in the world. `turn` takes the time as a share of the loop,
    /// and must be the identity at 0 and 1.
    pub fn turn(
        &mut self,
        parent: Option<usize>,
        joint: Vec3,
        seconds: f32,
        turn: impl Fn(f32) -> Quat,
    ) -> usize {
        let turns = self.track(seconds, |t| turn(t).to_array());
        self.motion.nodes.push(Node {
            parent,
            fixed: Affine3A::from_translation(joint),
            turns: Some(turns),
            ..Node::default()
        });
        let about = self.motion.nodes.len() - 1;
        // What the node carries stays in place unless the joint turns.
        let fixed = Affine3A::from_translation(-joint);
        self.motion.nodes.push(Node { parent: Some(about), fixed, ..Node::default() });
        about + 1
    }

    /// Adds a node that does not move.
    pub fn still(&mut self) -> usize {
        self.motion.nodes.push(Node::default());
        self.motion.nodes.len() - 1
    }

    /// Adds a node that is translated: `path` maps the share of the loop to metres, with zero at 0 and 1.
    pub fn shift(&mut self, seconds: f32, path: impl Fn(f32) -> Vec3) -> usize {
        let moves = self.track(seconds, |t| path(t).to_array());
        self.motion.nodes.push(Node { moves: Some(moves), ..Node::default() });
        self.motion.nodes.len() - 1
    }

    fn track<const N: usize>(&mut self, seconds: f32, value: impl Fn(f32) -> [f32; N]) -> Track {
        let known = self.motion.loops.iter().position(|&length| length == seconds);
        let clock = known.unwrap_or_else(|| {
            self.motion.loops.push(seconds);
            self.motion.loops.len() - 1
        });
        // The loop ends exactly where it starts, to the bit.
        let share = |key: u32| (key % KEYS) as f32 / KEYS as f32;
        Track {
            clock,
            times: (0..=KEYS).map(|key| seconds * key as f32 / KEYS as f32).collect(),
            values: (0..=KEYS).flat_map(|key| value(share(key))).collect(),
            ..Track::default()
        }
    }

    /// Lets a node carry the objects with these names.
    pub fn carry(&mut self, node: usize, objects: &[&str]) {
        for name in objects {
            self.carried.insert((*name).into(), Carried::By(node));
        }
    }

    /// Lets an object bend between two nodes. `share` returns how much a vertex follows the second node.
    pub fn bend(&mut self, nodes: [usize; 2], object: &str, share: impl Fn(Vec3) -> f32 + 'static) {
        self.carried.insert(object.into(), Carried::Between(nodes, Box::new(share)));
    }

    /// Lets a node carry a light.
    pub fn carry_light(&mut self, node: usize, light: usize, lights: &[PointLight]) {
        self.motion.lights.push(MovingLight { light, node, position: lights[light].position });
    }

    /// Returns the motion, and sorts the vertices of the finished model: those that do not move come first.
    pub fn finish(mut self, model: &mut Model) -> Motion {
        let names: Vec<String> = {
            let mut names: Vec<_> = self.carried.keys().cloned().collect();
            names.sort();
            names
        };
        // 0 for vertices that do not move, otherwise one more than the object's index.
        let mut owners = vec![0; model.vertices.len()];
        for part in &model.parts {
            let Ok(at) = names.binary_search(&part.name) else { continue };
            model.indices[part.indices.clone()].iter().for_each(|&v| owners[v as usize] = at + 1);
        }
        let mut order: Vec<u32> = (0..owners.len() as u32).collect();
        order.sort_by_key(|&v| owners[v as usize]);
        let mut places = vec![0; order.len()];
        order.iter().zip(0..).for_each(|(&v, place)| places[v as usize] = place);
        model.vertices = order.iter().map(|&v| model.vertices[v as usize]).collect();
        model.indices.iter_mut().for_each(|v| *v = places[*v as usize]);
        let mut next = owners.iter().filter(|owner| **owner == 0).count();
        for (name, owner) in names.iter().zip(1..) {
            let vertices = next..next + owners.iter().filter(|o| **o == owner).count();
            next = vertices.end;
            let rest: Vec<Vertex> = model.vertices[vertices.clone()].to_vec();
            let carrier = match &self.carried[name] {
                Carried::By(node) => Carrier::Node(*node),
                Carried::Between(nodes, share) => Carrier::Skin {
                    joints: nodes.map(|node| (node, Affine3A::IDENTITY)).to_vec(),
                    influences: rest.iter().map(|v| between(share(v.position).clamp(0.0, 1.0))).collect(),
                },
            };
            self.motion.meshes.push(MovingMesh { vertices, rest, carrier, morph: None });
        }
        self.motion
    }
}

fn between(share: f32) -> Influence {
    Influence { joints: [0, 1, 0, 0], shares: [1.0 - share, share, 0.0, 0.0] }
}

/// Returns a turn by radians about an axis.
pub fn about(axis: Vec3, radians: f32) -> Quat {
    Quat::from_axis_angle(axis, radians)
}
