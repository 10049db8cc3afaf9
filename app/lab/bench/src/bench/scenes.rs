//! Scenes that suites build themselves: an object at a distance, and a swarm of objects.

use std::cell::LazyCell;
use std::path::Path;

use glam::{Affine3A, Mat3, Quat, Vec3, vec2, vec3};

use yoro_assets::{self as scene, Model, PointLight, Scene, SceneError, ShadingStyle, Sky, Viewpoint};
use yoro_scenes::build::SceneBuilder;
use yoro_scenes::paint::{self, hash, unit};
use yoro_scenes::props::textured;
use yoro_scenes::sculpt::Clay;

/// An object that is built when a suite first needs it.
pub type LazyObject = LazyCell<Object, Box<dyn FnOnce() -> Object>>;

/// Height of the eyes in metres.
const EYE_HEIGHT: f32 = 1.6;

/// An object of irregular shape, centred at the origin, with its farthest vertex at 1 m.
#[derive(Clone, Debug)]
pub struct Object {
    /// The name: `hare`, or the stem of the file's name.
    pub name: String,
    model: Model,
}

impl Object {
    /// Returns the built-in object: a sitting hare of marble with about as many triangles as the Stanford bunny.
    pub fn hare() -> Object {
        let mut clay = Clay::new(0.06);
        clay.ball(vec3(0.0, 0.42, -0.1), vec3(0.34, 0.4, 0.42))
            .ball(vec3(0.0, 0.74, 0.16), vec3(0.24, 0.3, 0.22))
            .turned_ball(vec3(0.0, 1.1, 0.3), vec3(0.19, 0.18, 0.26), Quat::from_rotation_x(0.35))
            .ball(vec3(0.0, 0.3, -0.52), vec3(0.12, 0.12, 0.12));
        for side in [-1.0, 1.0] {
            // The ears differ: one is bent forwards.
            let bend = if side < 0.0 { 0.28 } else { -0.3 };
            clay.limb(vec3(side * 0.08, 1.2, 0.2), vec3(side * 0.16, 1.5, 0.06), 0.045, 0.07)
                .limb(vec3(side * 0.16, 1.5, 0.06), vec3(side * 0.22, 1.72, 0.06 + bend), 0.07, 0.025)
                .ball(vec3(side * 0.3, 0.26, -0.12), vec3(0.14, 0.26, 0.28))
                .limb(vec3(side * 0.3, 0.06, -0.1), vec3(side * 0.32, 0.05, 0.26), 0.07, 0.055)
                .limb(vec3(side * 0.14, 0.6, 0.26), vec3(side * 0.15, 0.06, 0.36), 0.08, 0.055)
                .carve(vec3(side * 0.16, 1.16, 0.47), vec3(0.04, 0.035, 0.04));
        }
        let mut b = SceneBuilder::new();
        let marble = textured(
            &mut b,
            paint::marble("hare", 512, 7, vec3(0.82, 0.74, 0.62), vec3(0.42, 0.3, 0.22)),
            0.7,
            0.4,
        );
        b.with_material(marble).object("hare");
        clay.mesh(&mut b, 0.013, |p, _| vec2(p.x + p.z, p.y) / 0.7);
        Object::new("hare".into(), b.finish())
    }

    /// Loads an object from a file.
    pub fn load(path: &Path) -> Result<Object, SceneError> {
        let scene = scene::load(path)?;
        Ok(Object::new(scene.name, scene.model))
    }

    fn new(name: String, mut model: Model) -> Object {
        let center = model.bounds().center();
        let reach = model.vertices.iter().map(|v| v.position.distance(center)).fold(1e-6, f32::max);
        model.vertices.iter_mut().for_each(|v| v.position = (v.position - center) / reach);
        Object { name, model }
    }

    /// Returns the number of triangles.
    pub fn triangles(&self) -> usize {
        self.model.triangle_count()
    }

    /// Returns a scene with the object in a room, seen from `distance` metres. Its size on the screen is the same at
    /// any distance. The viewpoints are on an arc around it.
    pub fn at_distance(&self, distance: f32) -> Scene {
        let mut model = room();
        let first_material = take_materials(&mut model, &self.model);
        let place = vec3(0.0, EYE_HEIGHT, 0.0);
        let transform = Affine3A::from_scale_rotation_translation(
            Vec3::splat(0.25 * distance),
            Quat::from_rotation_y(0.4),
            place,
        );
        append(&mut model, &self.model, first_material, transform);
        let viewpoint = |degrees: f32| {
            let back = Quat::from_rotation_y(degrees.to_radians()) * Vec3::Z * distance;
            Viewpoint { position: place + back, target: place }
        };
        let light =
            |x: f32, z: f32| PointLight { position: vec3(x, 3.2, z), color: vec3(2.4, 2.2, 1.9), range: 9.0 };
        Scene {
            name: self.name.clone(),
            model,
            style: ShadingStyle::Realistic,
            sky: Sky::default(),
            lights: vec![light(-2.5, -2.0), light(2.5, -2.0), light(0.0, 3.0)],
            viewpoints: [-24.0, 0.0, 24.0].map(viewpoint).to_vec(),
            ..Scene::default()
        }
    }

    /// Returns a scene with `copies` of the object in front of a wall, near and far, all visible and equally large on
    /// the screen. `places` is the largest number of copies: those of smaller swarms stand at the same places.
    pub fn swarm(&self, copies: usize, places: usize) -> Scene {
        let mut b = SceneBuilder::new();
        let bricks = paint::bricks("wall", 512, 3, vec3(0.55, 0.42, 0.36), vec3(0.7, 0.68, 0.64), [8, 16]);
        let wall = textured(&mut b, bricks, 4.0, 0.8);
        let (width, height, back) = (40.0, 40.0, -24.0);
        b.with_material(wall).object("wall").rectangle(
            vec3(-0.5 * width, EYE_HEIGHT - 0.5 * height, back),
            Vec3::X * width,
            Vec3::Y * height,
        );
        let mut model = b.finish();
        let first_material = take_materials(&mut model, &self.model);
        let side = (places.max(1) as f32).sqrt().ceil() as usize;
        for copy in 0..copies {
            // A step that has no common factor with the number of places reaches each of them once, in irregular order.
            let cells = side * side;
            let cell = copy * coprime_step(cells) % cells;
            let at = |i: usize| ((i as f32 + 0.5) / side as f32 - 0.5) * 1.1;
            let random = |purpose: u32| unit(hash(copy as u32 * 3 + purpose));
            let distance = 3.0 + 16.0 * random(0);
            let place = vec3(at(cell % side), at(cell / side), -1.0) * distance + Vec3::Y * EYE_HEIGHT;
            let radius = 0.5 * distance / side as f32;
            let turn = Quat::from_rotation_y(random(1) * std::f32::consts::TAU);
            let transform = Affine3A::from_scale_rotation_translation(Vec3::splat(radius), turn, place);
            append(&mut model, &self.model, first_material, transform);
        }
        let viewpoint = |x: f32| {
            let position = vec3(x, EYE_HEIGHT, 0.0);
            Viewpoint { position, target: position + Vec3::NEG_Z }
        };
        let light = |x: f32, y: f32| PointLight {
            position: vec3(x, y, -4.0),
            color: vec3(3.0, 2.8, 2.5),
            range: 20.0,
        };
        Scene {
            name: "swarm".into(),
            model,
            style: ShadingStyle::Realistic,
            sky: Sky::default(),
            lights: vec![light(-4.0, 4.0), light(4.0, 4.0), light(-4.0, -1.0), light(4.0, -1.0)],
            viewpoints: [0.0, -0.3, 0.3].map(viewpoint).to_vec(),
            ..Scene::default()
        }
    }

    /// Returns the number of triangles of [`Object::swarm`] with this many copies.
    pub fn swarm_triangles(&self, copies: usize) -> usize {
        copies * self.triangles() + 2
    }
}

/// Returns the smallest step from about the golden section of `cells` on that has no common factor with it.
fn coprime_step(cells: usize) -> usize {
    let common = |mut a: usize, mut b: usize| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let golden = (cells as f64 * 0.618) as usize;
    (golden.max(1)..).find(|step| common(*step, cells) == 1).expect("a prime above any number")
}

/// Returns a room of ten metres, open to the sky.
fn room() -> Model {
    const HALF: f32 = 5.0;
    const HEIGHT: f32 = 4.0;
    let mut b = SceneBuilder::new();
    let planks = textured(&mut b, paint::planks("floor", 512, 1, vec3(0.5, 0.36, 0.24), 8), 2.0, 0.5);
    let bricks = paint::bricks("wall", 512, 3, vec3(0.55, 0.42, 0.36), vec3(0.7, 0.68, 0.64), [8, 16]);
    let wall = textured(&mut b, bricks, 2.0, 0.8);
    b.with_material(planks).object("floor");
    b.rectangle(vec3(-HALF, 0.0, HALF), Vec3::X * 2.0 * HALF, Vec3::NEG_Z * 2.0 * HALF);
    b.with_material(wall).object("walls");
    for turn in 0..4 {
        let turn = Quat::from_rotation_y(turn as f32 * std::f32::consts::FRAC_PI_2);
        let (corner, right) = (turn * vec3(-HALF, 0.0, -HALF), turn * Vec3::X * 2.0 * HALF);
        b.rectangle(corner, right, Vec3::Y * HEIGHT);
    }
    b.finish()
}

/// Adds the materials and pictures of `from`, and returns the index of the first material.
fn take_materials(to: &mut Model, from: &Model) -> usize {
    let (first_material, first_texture) = (to.materials.len(), to.textures.len());
    to.textures.extend(from.textures.iter().cloned());
    to.materials.extend(from.materials.iter().cloned().map(|mut material| {
        for map in [
            &mut material.diffuse_map,
            &mut material.specular_map,
            &mut material.emissive_map,
            &mut material.normal_map,
        ] {
            *map = map.map(|texture| texture + first_texture);
        }
        material
    }));
    first_material
}

/// Adds the triangles of `from`, transformed. Its materials start at index `first_material`.
fn append(to: &mut Model, from: &Model, first_material: usize, transform: Affine3A) {
    let (first_vertex, first_index) = (to.vertices.len() as u32, to.indices.len());
    // The transform rotates and scales evenly, so that normals need no inverse.
    let turn = Mat3::from(transform.matrix3);
    to.vertices.extend(from.vertices.iter().map(|v| {
        let mut moved = *v;
        moved.position = transform.transform_point3(v.position);
        moved.normal = (turn * v.normal).normalize_or(Vec3::Y);
        moved
    }));
    to.indices.extend(from.indices.iter().map(|index| index + first_vertex));
    to.parts.extend(from.parts.iter().cloned().map(|mut part| {
        part.material += first_material;
        part.indices = part.indices.start + first_index..part.indices.end + first_index;
        part
    }));
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro_assets::Bounds;

    /// Returns the largest angle, in radians, between the view's axis and a vertex of the object.
    fn reach_on_screen(scene: &Scene, object: &Object) -> f32 {
        let view = scene.viewpoints[1];
        let axis = (view.target - view.position).normalize();
        let vertices = &scene.model.vertices[scene.model.vertices.len() - object.model.vertices.len()..];
        vertices.iter().map(|v| (v.position - view.position).angle_between(axis)).fold(0.0, f32::max)
    }

    #[test]
    fn the_object_is_as_large_from_any_distance() {
        let object = Object::hare();
        assert!((50_000..100_000).contains(&object.triangles()), "{} triangles", object.triangles());
        let reach: Vec<f32> =
            [0.5, 1.0, 3.0].map(|d| reach_on_screen(&object.at_distance(d), &object)).to_vec();
        assert!(reach.iter().all(|r| (r / reach[0] - 1.0).abs() < 1e-3), "{reach:?}");
        assert!((0.15..0.3).contains(&reach[0]), "{reach:?}");
        let scene = object.at_distance(0.5);
        let bounds = scene.model.bounds();
        for view in &scene.viewpoints {
            assert!((view.position.distance(view.target) - 0.5).abs() < 1e-5);
            assert!(bounds.distance(view.position) == 0.0, "outside of the room");
        }
        let textures = scene.model.textures.len();
        assert!(scene.model.materials.iter().filter_map(|m| m.diffuse_map).all(|map| map < textures));
    }

    #[test]
    fn a_larger_swarm_contains_the_smaller() {
        let object = Object::hare();
        let (few, many) = (object.swarm(3, 10), object.swarm(10, 10));
        assert_eq!(many.model.triangle_count(), object.swarm_triangles(10));
        assert_eq!(few.model.vertices[..], many.model.vertices[..few.model.vertices.len()]);
        let mut centers: Vec<Vec3> = many.model.parts[1..]
            .iter()
            .map(|part| {
                let vertices = many.model.indices[part.indices.clone()].iter();
                let at = |i: &u32| many.model.vertices[*i as usize].position;
                vertices.map(at).fold(Bounds::EMPTY, Bounds::including).center()
            })
            .collect();
        let eye = many.viewpoints[0].position;
        for center in &centers {
            let seen = *center - eye;
            assert!(
                seen.x.abs().max(seen.y.abs()) < -seen.z * 30f32.to_radians().tan(),
                "{seen} is out of view"
            );
        }
        centers.dedup();
        assert_eq!(centers.len(), 10);
    }

    #[test]
    fn every_pixel_of_a_hole_is_reached() {
        for side in 1..20usize {
            let cells = side * side;
            let mut reached: Vec<usize> = (0..cells).map(|i| i * coprime_step(cells) % cells).collect();
            reached.sort_unstable();
            assert_eq!(reached, (0..cells).collect::<Vec<_>>());
        }
    }
}
