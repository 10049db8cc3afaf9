//! The geometry toolkit of the built-in scenes.
//!
//! A [`SceneBuilder`] collects triangles under a current object name, material and transform, and sorts them into one
//! [`Part`] for each pair of object and material. Shapes are wound counter-clockwise seen from outside. Their texture
//! coordinates are in metres and are divided by the material's tile size, so that a texture has the same texel density
//! everywhere. [`SceneBuilder::picture`] and [`SceneBuilder::card`] instead stretch a whole picture over a quad.

use std::collections::HashMap;
use std::f32::consts::{PI, TAU};

use glam::{Affine3A, Mat3, Quat, Vec2, Vec3, vec2, vec3};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg32;

use yoro_assets::{Material, Model, Part, TextureImage, Vertex, Viewpoint};

/// Returns a random number generator that is equal for equal seed and purpose, and independent between purposes.
pub fn random(seed: u64, purpose: &str) -> Pcg32 {
    let hash = purpose
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3));
    Pcg32::seed_from_u64(seed.rotate_left(32) ^ hash)
}

/// Returns a uniform random number in `centre - spread ..= centre + spread`.
pub fn around(rng: &mut impl Rng, centre: f32, spread: f32) -> f32 {
    centre + spread * (rng.random::<f32>() * 2.0 - 1.0)
}

/// Returns a translation in metres.
pub fn moved(x: f32, y: f32, z: f32) -> Affine3A {
    Affine3A::from_translation(vec3(x, y, z))
}

/// Returns a rotation about Y by `yaw` radians (counter-clockwise seen from above), followed by a move to a position.
pub fn placed(position: Vec3, yaw: f32) -> Affine3A {
    Affine3A::from_rotation_translation(Quat::from_rotation_y(yaw), position)
}

/// A point of a [`SceneBuilder::surface`] in metres, and its texture coordinates in metres.
pub type SurfacePoint = (Vec3, Vec2);

/// The progress of building a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Number of textures so far; these come first.
    pub textures: usize,
    /// Number of triangles so far.
    pub triangles: usize,
}

/// Number of triangles between two reports of [`Progress`].
pub const WATCHED_STEP: usize = 1 << 10;

/// Collects the geometry of one scene.
///
/// Shapes take positions in metres in the frame of the current transform ([`SceneBuilder::within`]).
pub struct SceneBuilder {
    vertices: Vec<Vertex>,
    materials: Vec<Material>,
    tile_sizes: Vec<f32>,
    textures: Vec<TextureImage>,
    objects: Vec<String>,
    object_ids: HashMap<String, usize>,
    groups: Vec<Group>,
    group_ids: HashMap<(usize, usize), usize>,
    object: usize,
    material: usize,
    group: Option<usize>,
    transform: Affine3A,
    normal_transform: Mat3,
    mirrored: bool,
    smooth: bool,
    uv_offset: Vec2,
    progress: Progress,
    watch: Option<Box<dyn FnMut(Progress)>>,
}

struct Group {
    object: usize,
    material: usize,
    indices: Vec<u32>,
}

impl Default for SceneBuilder {
    fn default() -> SceneBuilder {
        SceneBuilder::new()
    }
}

impl SceneBuilder {
    /// Creates an empty scene, with smooth normals and no transform.
    pub fn new() -> SceneBuilder {
        SceneBuilder {
            vertices: Vec::new(),
            materials: Vec::new(),
            tile_sizes: Vec::new(),
            textures: Vec::new(),
            objects: vec!["scene".into()],
            object_ids: HashMap::from([("scene".into(), 0)]),
            groups: Vec::new(),
            group_ids: HashMap::new(),
            object: 0,
            material: 0,
            group: None,
            transform: Affine3A::IDENTITY,
            normal_transform: Mat3::IDENTITY,
            mirrored: false,
            smooth: true,
            uv_offset: Vec2::ZERO,
            progress: Progress::default(),
            watch: None,
        }
    }

    /// Creates an empty scene. `watch` is called after each texture and after every [`WATCHED_STEP`] triangles.
    pub fn watched(watch: impl FnMut(Progress) + 'static) -> SceneBuilder {
        SceneBuilder { watch: Some(Box::new(watch)), ..SceneBuilder::new() }
    }

    fn report_progress(&mut self) {
        if let Some(watch) = &mut self.watch {
            watch(self.progress);
        }
    }

    /// Adds a picture and returns its index, for the maps of a [`Material`].
    pub fn texture(&mut self, image: TextureImage) -> usize {
        self.textures.push(image);
        self.progress.textures += 1;
        self.report_progress();
        self.textures.len() - 1
    }

    /// Adds a material whose pictures repeat every `tile_size` metres.
    pub fn material(&mut self, material: Material, tile_size: f32) -> usize {
        self.materials.push(material);
        self.tile_sizes.push(tile_size);
        self.materials.len() - 1
    }

    /// Changes a material that was added earlier.
    pub fn edit_material(&mut self, material: usize, edit: impl FnOnce(&mut Material)) {
        edit(&mut self.materials[material]);
    }

    /// Sets the material of what follows.
    pub fn with_material(&mut self, material: usize) -> &mut Self {
        debug_assert!(material < self.materials.len());
        self.material = material;
        self.group = None;
        self
    }

    /// Sets the object, by name, that what follows belongs to. Objects should be compact: culling uses their bounds.
    pub fn object(&mut self, name: &str) -> &mut Self {
        self.object = match self.object_ids.get(name) {
            Some(&id) => id,
            None => {
                self.objects.push(name.into());
                self.object_ids.insert(name.into(), self.objects.len() - 1);
                self.objects.len() - 1
            }
        };
        self.group = None;
        self
    }

    /// Lets curved shapes share normals between neighbouring triangles (the default), or have one normal per triangle.
    pub fn set_smooth(&mut self, smooth: bool) -> &mut Self {
        self.smooth = smooth;
        self
    }

    /// Shifts the texture coordinates (in metres) of what follows, so that identical objects look different.
    pub fn set_uv_offset(&mut self, metres: Vec2) -> &mut Self {
        self.uv_offset = metres;
        self
    }

    /// Runs `body` in a frame that is `transform` relative to the current one.
    pub fn within<R>(&mut self, transform: Affine3A, body: impl FnOnce(&mut SceneBuilder) -> R) -> R {
        let outer = self.transform;
        self.set_transform(outer * transform);
        let result = body(self);
        self.set_transform(outer);
        result
    }

    fn set_transform(&mut self, transform: Affine3A) {
        let linear = Mat3::from(transform.matrix3);
        let determinant = linear.determinant();
        self.transform = transform;
        self.mirrored = determinant < 0.0;
        self.normal_transform =
            if determinant.abs() > 1e-12 { linear.inverse().transpose() } else { Mat3::IDENTITY };
    }

    /// Returns the number of triangles so far.
    pub fn triangle_count(&self) -> usize {
        self.progress.triangles
    }

    /// Adds to the count the triangles that a scene adds to its finished model itself.
    pub fn count(&mut self, triangles: usize) {
        self.progress.triangles += triangles;
        self.report_progress();
    }

    /// Returns the finished model: one part for each object and material, objects in the order in which they were first
    /// drawn. Leaves the builder empty.
    pub fn finish(&mut self) -> Model {
        let empty = SceneBuilder { progress: self.progress, watch: self.watch.take(), ..SceneBuilder::new() };
        let mut done = std::mem::replace(self, empty);
        done.groups.sort_by_key(|g| (g.object, g.material));
        let mut indices = Vec::with_capacity(done.groups.iter().map(|g| g.indices.len()).sum());
        let mut parts = Vec::with_capacity(done.groups.len());
        for group in done.groups {
            if group.indices.is_empty() {
                continue;
            }
            let start = indices.len();
            indices.extend_from_slice(&group.indices);
            parts.push(Part {
                name: done.objects[group.object].clone(),
                material: group.material,
                indices: start..indices.len(),
            });
        }
        done.vertices.shrink_to_fit();
        Model { vertices: done.vertices, indices, parts, materials: done.materials, textures: done.textures }
    }

    /// Adds a vertex, with `uv` used as is. Returns its index for [`SceneBuilder::triangle`].
    pub fn vertex(&mut self, position: Vec3, normal: Vec3, uv: Vec2) -> u32 {
        let index = self.vertices.len() as u32;
        self.vertices.push(Vertex {
            position: self.transform.transform_point3(position),
            normal: (self.normal_transform * normal).try_normalize().unwrap_or(Vec3::Y),
            uv,
        });
        index
    }

    /// Adds a vertex with texture coordinates in metres.
    fn vertex_metres(&mut self, position: Vec3, normal: Vec3, metres: Vec2) -> u32 {
        let tile = self.tile_sizes.get(self.material).copied().unwrap_or(1.0);
        self.vertex(position, normal, (metres + self.uv_offset) / tile)
    }

    /// Adds a triangle that is counter-clockwise seen from the front.
    pub fn triangle(&mut self, a: u32, b: u32, c: u32) {
        let group = match self.group {
            Some(group) => group,
            None => self.current_group(),
        };
        let corners = if self.mirrored { [a, c, b] } else { [a, b, c] };
        self.groups[group].indices.extend_from_slice(&corners);
        self.progress.triangles += 1;
        if self.progress.triangles.is_multiple_of(WATCHED_STEP) {
            self.report_progress();
        }
    }

    fn current_group(&mut self) -> usize {
        let groups = &mut self.groups;
        let (object, material) = (self.object, self.material);
        let id = *self.group_ids.entry((object, material)).or_insert_with(|| {
            groups.push(Group { object, material, indices: Vec::new() });
            groups.len() - 1
        });
        self.group = Some(id);
        id
    }

    fn quad_indices(&mut self, [a, b, c, d]: [u32; 4]) {
        self.triangle(a, b, c);
        self.triangle(a, c, d);
    }

    /// Adds a flat quad by its corners: lower left, lower right, upper right, upper left.
    pub fn quad(&mut self, corners: [Vec3; 4]) {
        let [a, b, _, d] = corners;
        let right = (b - a).normalize_or(Vec3::X);
        let up = (d - a).normalize_or(Vec3::Y);
        let metres = corners.map(|p| vec2((p - a).dot(right), (p - a).dot(up)));
        self.quad_metres(corners, metres);
    }

    /// Adds a flat quad with its own texture coordinates in metres.
    pub fn quad_metres(&mut self, corners: [Vec3; 4], metres: [Vec2; 4]) {
        let normal = quad_normal(&corners);
        let ids: [u32; 4] = std::array::from_fn(|i| self.vertex_metres(corners[i], normal, metres[i]));
        self.quad_indices(ids);
    }

    /// Adds a flat rectangle spanned by `right` and `up` from its lower left corner.
    pub fn rectangle(&mut self, corner: Vec3, right: Vec3, up: Vec3) {
        self.quad([corner, corner + right, corner + right + up, corner + up]);
    }

    /// Adds a flat quad that shows the whole picture: lower left, lower right, upper right, upper left.
    pub fn picture(&mut self, corners: [Vec3; 4]) {
        self.picture_region(corners, Vec2::ZERO, Vec2::ONE);
    }

    /// Adds a flat quad that shows the part of the picture from `low` to `high` (texture coordinates).
    fn picture_region(&mut self, corners: [Vec3; 4], low: Vec2, high: Vec2) {
        let normal = quad_normal(&corners);
        let uvs = [low, vec2(high.x, low.y), high, vec2(low.x, high.y)];
        let ids: [u32; 4] = std::array::from_fn(|i| self.vertex(corners[i], normal, uvs[i]));
        self.quad_indices(ids);
    }

    /// Adds a picture card around `center` with half extents `right` and `up` and its own normal: leaves take the
    /// normal of the crown they belong to. Meant for double-sided cut-out materials.
    pub fn card(&mut self, center: Vec3, right: Vec3, up: Vec3, normal: Vec3) {
        let corners = [center - right - up, center + right - up, center + right + up, center - right + up];
        let uvs = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
        let ids: [u32; 4] = std::array::from_fn(|i| self.vertex(corners[i], normal, uvs[i]));
        self.quad_indices(ids);
    }

    /// Adds a box between two corners: 12 triangles.
    pub fn cuboid(&mut self, min: Vec3, max: Vec3) {
        self.cuboid_faces(min, max, BoxFaces::ALL);
    }

    /// Adds a box by the centre of its base and its size.
    pub fn cuboid_on(&mut self, base: Vec3, size: Vec3) {
        let half = vec3(size.x * 0.5, 0.0, size.z * 0.5);
        self.cuboid(base - half, base + half + Vec3::Y * size.y);
    }

    /// Adds some faces of a box.
    pub fn cuboid_faces(&mut self, min: Vec3, max: Vec3, faces: BoxFaces) {
        for face in FACES.iter().filter(|f| faces.contains(f)) {
            let corners = face.corners(min, max);
            let ids = corners.map(|p| self.vertex_metres(p, face.normal, face.metres(p)));
            self.quad_indices(ids);
        }
    }

    /// Adds a box with bevelled edges whose normals blend over the bevel: 44 triangles.
    pub fn beveled_cuboid(&mut self, min: Vec3, max: Vec3, bevel: f32) {
        let bevel = bevel.min((max - min).min_element() * 0.49);
        let mut ring: HashMap<(usize, [i8; 3]), u32> = HashMap::with_capacity(24);
        let inset = |face: &Face, p: Vec3| {
            let center = (min + max) * 0.5;
            let tangential = Vec3::ONE - face.normal.abs();
            p - (p - center).signum() * tangential * bevel
        };
        let sign = |p: Vec3| ((p - (min + max) * 0.5).signum().to_array()).map(|s| s as i8);
        for (f, face) in FACES.iter().enumerate() {
            let corners = face.corners(min, max);
            let ids = corners.map(|p| {
                let q = inset(face, p);
                let id = self.vertex_metres(q, face.normal, face.metres(q));
                ring.insert((f, sign(p)), id);
                id
            });
            self.quad_indices(ids);
        }
        for (f, face) in FACES.iter().enumerate() {
            let corners = face.corners(min, max);
            for side in 0..4 {
                let (p, q) = (corners[side], corners[(side + 1) % 4]);
                // The neighbour across this edge is the other face that contains both corners.
                let neighbour = FACES.iter().enumerate().position(|(g, other)| {
                    g != f && other.lies_on(p, min, max) && other.lies_on(q, min, max)
                });
                let Some(g) = neighbour.filter(|&g| g > f) else { continue };
                let other = &FACES[g];
                let a = ring[&(f, sign(p))];
                let b = ring[&(f, sign(q))];
                let far = |s: &mut Self, corner: Vec3| {
                    let at = inset(other, corner);
                    s.vertex_metres(at, other.normal, face.metres(inset(face, corner)) + vec2(bevel, bevel))
                };
                let c = far(self, q);
                let d = far(self, p);
                self.quad_indices([b, a, d, c]);
            }
        }
        for corner in 0..8u8 {
            let pick = |bit: u8, low: f32, high: f32| if corner & bit == 0 { low } else { high };
            let p = vec3(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z));
            let touching: Vec<u32> = FACES
                .iter()
                .enumerate()
                .filter(|(_, face)| face.lies_on(p, min, max))
                .map(|(f, _)| ring[&(f, sign(p))])
                .collect();
            let outward: f32 = sign(p).iter().map(|&s| f32::from(s)).product();
            // FACES lists X, Y, Z; their normals are right-handed if the signs multiply to +1.
            if outward > 0.0 {
                self.triangle(touching[0], touching[1], touching[2]);
            } else {
                self.triangle(touching[0], touching[2], touching[1]);
            }
        }
    }

    /// Adds a surface over a grid of `columns` x `rows` cells with normals computed from its shape.
    ///
    /// `point(u, v)` gives the surface at `u`, `v` from 0 to 1; the front is where `u` runs right and `v` up. With
    /// `wraps`, normals at `u = 0` and `u = 1` are joined. Points of a row may coincide (poles).
    pub fn surface(
        &mut self,
        columns: usize,
        rows: usize,
        wraps: bool,
        mut point: impl FnMut(f32, f32) -> SurfacePoint,
    ) {
        let width = columns + 1;
        let mut points: Vec<SurfacePoint> = Vec::with_capacity(width * (rows + 1));
        for j in 0..=rows {
            for i in 0..=columns {
                points.push(point(i as f32 / columns as f32, j as f32 / rows as f32));
            }
        }
        self.grid(columns, rows, wraps, &points);
    }

    /// Adds a surface by its `(columns + 1) * (rows + 1)` points, row by row from the bottom.
    pub fn grid(&mut self, columns: usize, rows: usize, wraps: bool, points: &[SurfacePoint]) {
        let width = columns + 1;
        debug_assert_eq!(points.len(), width * (rows + 1));
        let cell = |i: usize, j: usize| {
            let a = j * width + i;
            [a, a + 1, a + 1 + width, a + width]
        };
        let is_flat = |a: usize, b: usize, c: usize| {
            let (a, b, c) = (points[a].0, points[b].0, points[c].0);
            (b - a).cross(c - a).length_squared() < 1e-16
        };
        if !self.smooth {
            for (i, j) in (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))) {
                let [a, b, c, d] = cell(i, j);
                for triangle in [[a, b, c], [a, c, d]] {
                    if is_flat(triangle[0], triangle[1], triangle[2]) {
                        continue;
                    }
                    let [p, q, r] = triangle.map(|k| points[k].0);
                    let normal = (q - p).cross(r - p).normalize_or(Vec3::Y);
                    let [p, q, r] = triangle.map(|k| self.vertex_metres(points[k].0, normal, points[k].1));
                    self.triangle(p, q, r);
                }
            }
            return;
        }
        let mut normals = vec![Vec3::ZERO; points.len()];
        for (i, j) in (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))) {
            let [a, b, c, d] = cell(i, j);
            // The cross product of the diagonals weights by area and stays valid if one side has no length.
            let normal = (points[c].0 - points[a].0).cross(points[d].0 - points[b].0);
            for k in [a, b, c, d] {
                normals[k] += normal;
            }
        }
        for row in normals.chunks_exact_mut(width).enumerate().filter(|_| wraps) {
            let (_, row) = row;
            let joined = row[0] + row[columns];
            row[0] = joined;
            row[columns] = joined;
        }
        for j in 0..=rows {
            let row = j * width..(j + 1) * width;
            let first = points[row.start].0;
            if points[row.clone()].iter().all(|(p, _)| p.distance_squared(first) < 1e-12) {
                let joined = normals[row.clone()].iter().sum();
                normals[row].fill(joined);
            }
        }
        let base = self.vertices.len() as u32;
        for ((position, metres), normal) in points.iter().zip(&normals) {
            self.vertex_metres(*position, normal.normalize_or(Vec3::Y), *metres);
        }
        for (i, j) in (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))) {
            let [a, b, c, d] = cell(i, j);
            for [p, q, r] in [[a, b, c], [a, c, d]] {
                if !is_flat(p, q, r) {
                    self.triangle(base + p as u32, base + q as u32, base + r as u32);
                }
            }
        }
    }

    /// Adds a height field over the rectangle from `min` to `max` (x and z), seen from above.
    pub fn height_field(
        &mut self,
        columns: usize,
        rows: usize,
        min: Vec2,
        max: Vec2,
        mut height: impl FnMut(f32, f32) -> f32,
    ) {
        self.surface(columns, rows, false, |u, v| {
            let (x, z) = (min.x + (max.x - min.x) * u, max.y + (min.y - max.y) * v);
            (vec3(x, height(x, z), z), vec2(x, -z))
        });
    }

    /// Adds a profile of (radius, height) points from the bottom up, turned about the Y axis of the current frame. A
    /// point given twice makes a sharp edge.
    pub fn lathe(&mut self, profile: &[(f32, f32)], sides: usize) {
        for run in profile.split_inclusive_at(|a, b| a == b) {
            let widest = run.iter().fold(0.0_f32, |r, p| r.max(p.0));
            let mut along = vec![0.0_f32];
            for pair in run.windows(2) {
                let last = along[along.len() - 1];
                along.push(last + vec2(pair[1].0 - pair[0].0, pair[1].1 - pair[0].1).length());
            }
            let rows = run.len() - 1;
            let mut points = Vec::with_capacity((sides + 1) * run.len());
            for (&(radius, height), &v) in run.iter().zip(&along) {
                for i in 0..=sides {
                    let turn = i as f32 / sides as f32;
                    let (sin, cos) = if i == sides { (0.0, 1.0) } else { (turn * TAU).sin_cos() };
                    points.push((
                        vec3(radius * cos, height, -radius * sin),
                        vec2(turn * TAU * widest, v + run[0].1),
                    ));
                }
            }
            self.grid(sides, rows, true, &points);
        }
    }

    /// Adds a cylinder from `a` to `b` or, with different radii, a cone.
    pub fn cylinder(&mut self, a: Vec3, b: Vec3, radius_a: f32, radius_b: f32, sides: usize, caps: bool) {
        let length = a.distance(b);
        let rotation = Quat::from_rotation_arc(Vec3::Y, (b - a).normalize_or(Vec3::Y));
        self.within(Affine3A::from_rotation_translation(rotation, a), |s| {
            if caps {
                let edge = [(0.0, 0.0), (radius_a, 0.0), (radius_a, 0.0), (radius_b, length)];
                s.lathe(&[edge[0], edge[1], edge[2], edge[3], edge[3], (0.0, length)], sides);
            } else {
                s.lathe(&[(radius_a, 0.0), (radius_b, length)], sides);
            }
        });
    }

    /// Adds a sphere or ellipsoid.
    pub fn ellipsoid(&mut self, center: Vec3, radii: Vec3, rings: usize, sides: usize) {
        let girth = TAU * radii.x.max(radii.z);
        self.surface(sides, rings, true, |u, v| {
            let (sin_u, cos_u) = if u == 1.0 { (0.0, 1.0) } else { (u * TAU).sin_cos() };
            let ring = if v == 0.0 || v == 1.0 { 0.0 } else { (v * PI).sin() };
            let direction = vec3(ring * cos_u, -(v * PI).cos(), -ring * sin_u);
            (center + direction * radii, vec2(u * girth, v * PI * radii.y))
        });
    }

    /// Adds a round tube along a polyline, open at the ends unless `capped`.
    pub fn tube(&mut self, path: &[Vec3], radius: f32, sides: usize, capped: bool) {
        self.tapered_tube(path, &|_| radius, sides, capped);
    }

    /// Adds a tube whose radius depends on the position along it (0 to 1 by number of points).
    pub fn tapered_tube(&mut self, path: &[Vec3], radius: &dyn Fn(f32) -> f32, sides: usize, capped: bool) {
        if path.len() < 2 {
            return;
        }
        let last = path.len() - 1;
        let along = |i: usize| (path[i + 1] - path[i]).normalize_or(Vec3::Y);
        let radius_at = |i: usize| radius(i as f32 / last as f32);
        // Between long pieces is a bend with a mitre; short pieces are a curve.
        let is_bend = |i: usize| {
            i > 0
                && i < last
                && [i - 1, i].iter().all(|&k| path[k].distance(path[k + 1]) > 4.0 * radius_at(i))
        };
        let direction = |i: usize| {
            if is_bend(i) {
                (along(i - 1) + along(i)).try_normalize().unwrap_or(along(i))
            } else {
                (path[(i + 1).min(last)] - path[i.saturating_sub(1)]).normalize_or(Vec3::Y)
            }
        };
        // Carrying one normal along the path keeps the tube from twisting.
        let mut side = direction(0).any_orthonormal_vector();
        let mut distance = 0.0;
        let mut points = Vec::with_capacity((sides + 1) * path.len());
        for (i, &center) in path.iter().enumerate() {
            let forward = direction(i);
            side = Quat::from_rotation_arc(direction(i.saturating_sub(1)), forward) * side;
            side = (side - forward * side.dot(forward)).normalize_or(forward.any_orthonormal_vector());
            let other = forward.cross(side);
            distance += if i == 0 { 0.0 } else { center.distance(path[i - 1]) };
            let r = radius_at(i);
            let (bend, mitre) = if is_bend(i) {
                ((along(i) - along(i - 1)).normalize_or_zero(), 1.0 / along(i).dot(forward).max(0.5) - 1.0)
            } else {
                (Vec3::ZERO, 0.0)
            };
            for k in 0..=sides {
                let turn = k as f32 / sides as f32;
                let (sin, cos) = if k == sides { (0.0, 1.0) } else { (turn * TAU).sin_cos() };
                let out = (side * cos + other * sin) * r;
                let out = out + bend * (out.dot(bend) * mitre);
                points.push((center + out, vec2(turn * TAU * r, distance)));
            }
        }
        self.grid(sides, last, true, &points);
        if capped {
            for (end, outward) in [(0, -direction(0)), (last, direction(last))] {
                let rim: Vec<Vec3> = points[end * (sides + 1)..][..sides].iter().map(|p| p.0).collect();
                self.fan(&rim, outward);
            }
        }
    }

    /// Adds a flat convex polygon facing `normal`, with its corners in either order.
    pub fn fan(&mut self, corners: &[Vec3], normal: Vec3) {
        let Some(&first) = corners.first() else { return };
        let right = normal.any_orthonormal_vector();
        let up = normal.cross(right);
        let ids: Vec<u32> = corners
            .iter()
            .map(|p| self.vertex_metres(*p, normal, vec2((p - first).dot(right), (p - first).dot(up))))
            .collect();
        for k in 1..corners.len().saturating_sub(1) {
            let facing = (corners[k] - first).cross(corners[k + 1] - first).dot(normal);
            if facing > 0.0 {
                self.triangle(ids[0], ids[k], ids[k + 1]);
            } else if facing < 0.0 {
                self.triangle(ids[0], ids[k + 1], ids[k]);
            }
        }
    }

    /// Adds a wire that hangs between two points, `sag` metres below the straight line in the middle.
    pub fn wire(&mut self, a: Vec3, b: Vec3, sag: f32, radius: f32, segments: usize) {
        let path: Vec<Vec3> =
            (0..=segments).map(|i| hanging(a, b, sag, i as f32 / segments as f32)).collect();
        self.tube(&path, radius, 5, false);
    }

    /// Adds a simple polygon (counter-clockwise in the XY plane) extruded from z = `back` to z = `front`. Its sides are
    /// flat; its back is left out unless `closed`.
    pub fn extrude(&mut self, outline: &[Vec2], back: f32, front: f32, closed: bool) {
        let triangles = triangulate(outline);
        for (z, normal, wanted) in [(front, Vec3::Z, true), (back, Vec3::NEG_Z, closed)] {
            if !wanted {
                continue;
            }
            let ids: Vec<u32> = outline
                .iter()
                .map(|p| self.vertex_metres(p.extend(z), normal, vec2(p.x * normal.z, p.y)))
                .collect();
            for &[a, b, c] in &triangles {
                if normal.z > 0.0 {
                    self.triangle(ids[a], ids[b], ids[c]);
                } else {
                    self.triangle(ids[a], ids[c], ids[b]);
                }
            }
        }
        let mut distance = 0.0;
        for (i, &p) in outline.iter().enumerate() {
            let q = outline[(i + 1) % outline.len()];
            let (start, end) = (distance, distance + p.distance(q));
            distance = end;
            if p.distance_squared(q) < 1e-12 {
                continue;
            }
            let corners = [p.extend(front), p.extend(back), q.extend(back), q.extend(front)];
            self.quad_metres(
                corners,
                [vec2(start, front), vec2(start, back), vec2(end, back), vec2(end, front)],
            );
        }
    }

    /// Adds a wall panel in the XY plane, centred on x = 0 and standing on y = 0, with its front at z = 0 and `depth`
    /// thick (towards -z). Its opening ends in a round arch.
    pub fn arched_wall(&mut self, size: Vec2, opening: ArchOpening, depth: f32, segments: usize) {
        let radius = opening.width * 0.5;
        let half = size.x * 0.5;
        let mut inner = vec![vec2(radius, 0.0)];
        for i in 0..=segments {
            let (sin, cos) = (PI * i as f32 / segments as f32).sin_cos();
            inner.push(vec2(radius * cos, opening.spring + radius * sin));
        }
        inner.push(vec2(-radius, 0.0));
        // Every point of the opening is joined with the point above or beside it on the panel's outline.
        let outer: Vec<Vec2> = inner
            .iter()
            .map(|p| {
                if p.y <= opening.spring {
                    return vec2(half * p.x.signum(), p.y);
                }
                let direction = *p - vec2(0.0, opening.spring);
                let to_top = (size.y - opening.spring) / direction.y;
                let to_side = half / direction.x.abs().max(1e-6);
                vec2(0.0, opening.spring) + direction * to_top.min(to_side)
            })
            .collect();
        for k in 0..inner.len() - 1 {
            let (a, b, c, d) = (inner[k], outer[k], outer[k + 1], inner[k + 1]);
            let front = [a.extend(0.0), b.extend(0.0), c.extend(0.0), d.extend(0.0)];
            self.quad_metres(front, [a, b, c, d]);
            let back = [d.extend(-depth), c.extend(-depth), b.extend(-depth), a.extend(-depth)];
            let flip = |p: Vec2| vec2(-p.x, p.y);
            self.quad_metres(back, [flip(d), flip(c), flip(b), flip(a)]);
            // A corner of the panel lies between two points of the arch.
            let corner = vec2(half * b.x.signum(), size.y);
            let turns = (b.x.abs() >= half - 1e-4) != (c.x.abs() >= half - 1e-4);
            if turns && b.distance(corner) > 1e-4 && c.distance(corner) > 1e-4 {
                let corner = vec2(half * (b.x + c.x).signum(), size.y);
                for (z, normal) in [(0.0, Vec3::Z), (-depth, Vec3::NEG_Z)] {
                    let ids = [b, corner, c]
                        .map(|p| self.vertex_metres(p.extend(z), normal, vec2(p.x * normal.z, p.y)));
                    let [b, corner, c] = if normal.z > 0.0 { ids } else { [ids[2], ids[1], ids[0]] };
                    self.triangle(b, corner, c);
                }
            }
        }
        let total: f32 = inner.windows(2).map(|p| p[0].distance(p[1])).sum();
        let mut along = 0.0;
        let mut soffit = Vec::with_capacity(inner.len());
        for (k, p) in inner.iter().enumerate() {
            along += if k == 0 { 0.0 } else { p.distance(inner[k - 1]) };
            soffit.push((*p, total - along));
        }
        let columns = inner.len() - 1;
        let points: Vec<SurfacePoint> = [-depth, 0.0]
            .into_iter()
            .flat_map(|z| soffit.iter().map(move |(p, along)| (p.extend(z), vec2(*along, z))))
            .collect();
        let flipped: Vec<SurfacePoint> =
            points.chunks_exact(columns + 1).flat_map(|row| row.iter().rev().copied()).collect();
        self.grid(columns, 1, false, &flipped);
        let (x, top) = (half, size.y);
        self.quad([vec3(x, 0.0, 0.0), vec3(x, 0.0, -depth), vec3(x, top, -depth), vec3(x, top, 0.0)]);
        self.quad([vec3(-x, 0.0, -depth), vec3(-x, 0.0, 0.0), vec3(-x, top, 0.0), vec3(-x, top, -depth)]);
        self.quad([vec3(-x, top, 0.0), vec3(x, top, 0.0), vec3(x, top, -depth), vec3(-x, top, -depth)]);
    }

    /// Adds stairs that climb towards -z from the origin, `width` wide and centred on x = 0.
    pub fn stairs(&mut self, width: f32, rise: f32, run: f32, steps: usize) {
        for i in 0..steps {
            let (low, high) = (rise * i as f32, rise * (i + 1) as f32);
            let (near, far) = (-run * i as f32, -run * (i + 1) as f32);
            let half = width * 0.5;
            self.rectangle(vec3(-half, low, near), Vec3::X * width, Vec3::Y * rise);
            self.rectangle(vec3(-half, high, near), Vec3::X * width, Vec3::NEG_Z * run);
            for (x, back, front) in [(half, near, far), (-half, far, near)] {
                self.quad([
                    vec3(x, 0.0, back),
                    vec3(x, 0.0, front),
                    vec3(x, high, front),
                    vec3(x, high, back),
                ]);
            }
        }
        let (half, top, far) = (width * 0.5, rise * steps as f32, -run * steps as f32);
        self.rectangle(vec3(half, 0.0, far), Vec3::NEG_X * width, Vec3::Y * top);
    }

    /// Adds cloth that hangs from the line `left` to `right`, as named from in front of it. It falls `drop` metres in
    /// `folds` waves of `depth` metres that grow towards the hem.
    pub fn curtain(&mut self, left: Vec3, right: Vec3, drop: f32, folds: f32, depth: f32, cells: [usize; 2]) {
        let along = (right - left).normalize_or(Vec3::X);
        let out = along.cross(Vec3::Y).normalize_or(Vec3::Z);
        let width = left.distance(right);
        // Gathered cloth is longer than the line it hangs from.
        let length = width * (1.0 + (depth * folds * 4.0 / width.max(1e-3)).powi(2) * 0.25).sqrt();
        self.surface(cells[0], cells[1], false, |u, v| {
            let fall = 1.0 - v;
            let phase = u * folds * TAU;
            let wave = phase.sin() + 0.35 * (phase * 0.5 + 1.7 + fall).sin();
            let shift = 0.12 * (phase * 2.0).sin() * width / folds.max(1.0) * fall;
            let amount = depth * (0.35 + 0.65 * fall);
            let hem = 0.015 * (phase + 0.6).sin() * fall;
            let position = left + along * (u * width + shift * 0.3) + out * (wave * amount)
                - Vec3::Y * (fall * drop + hem);
            (position, vec2(u * length, -fall * drop))
        });
    }

    /// Adds a railing along a polyline on the floor: posts, a hand rail, a lower rail and thin bars between them.
    pub fn railing(&mut self, path: &[Vec3], rail: &Railing) {
        let up = Vec3::Y * rail.height;
        for pair in path.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            self.tube(&[a + up, b + up], rail.rail_radius, 8, true);
            let low = Vec3::Y * rail.low_rail;
            self.tube(&[a + low, b + low], rail.bar_radius * 1.3, 6, true);
            let count = (a.distance(b) / rail.bar_spacing).round().max(1.0) as usize;
            for i in 1..count {
                let p = a.lerp(b, i as f32 / count as f32);
                self.cylinder(p + low, p + up, rail.bar_radius, rail.bar_radius, 6, false);
            }
        }
        for &p in path {
            self.cylinder(p, p + up, rail.rail_radius, rail.rail_radius, 8, true);
        }
    }
}

/// The dimensions of a [`SceneBuilder::railing`] in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Railing {
    /// Height of the hand rail.
    pub height: f32,
    /// Height of the lower rail.
    pub low_rail: f32,
    /// Radius of the hand rail and the posts.
    pub rail_radius: f32,
    /// Radius of the bars.
    pub bar_radius: f32,
    /// Distance between bars.
    pub bar_spacing: f32,
}

impl Default for Railing {
    fn default() -> Railing {
        Railing { height: 1.0, low_rail: 0.1, rail_radius: 0.022, bar_radius: 0.007, bar_spacing: 0.11 }
    }
}

/// The opening of a [`SceneBuilder::arched_wall`] in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArchOpening {
    /// Clear width; the arch is a semicircle over it.
    pub width: f32,
    /// Height at which the arch begins.
    pub spring: f32,
}

/// Returns the point of a hanging wire at `t` from 0 to 1: a parabola `sag` metres deep.
pub fn hanging(a: Vec3, b: Vec3, sag: f32, t: f32) -> Vec3 {
    a.lerp(b, t) - Vec3::Y * (sag * 4.0 * t * (1.0 - t))
}

/// A set of faces of a box, one bit each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoxFaces(u8);

impl BoxFaces {
    /// +X.
    pub const RIGHT: BoxFaces = BoxFaces(1);
    /// -X.
    pub const LEFT: BoxFaces = BoxFaces(2);
    /// +Y.
    pub const TOP: BoxFaces = BoxFaces(4);
    /// -Y.
    pub const BOTTOM: BoxFaces = BoxFaces(8);
    /// +Z.
    pub const FRONT: BoxFaces = BoxFaces(16);
    /// -Z.
    pub const BACK: BoxFaces = BoxFaces(32);
    /// All six.
    pub const ALL: BoxFaces = BoxFaces(63);
    /// All but the bottom, for boxes that stand on the ground.
    pub const STANDING: BoxFaces = BoxFaces(63 - 8);

    /// Returns these faces without the others.
    pub const fn without(self, other: BoxFaces) -> BoxFaces {
        BoxFaces(self.0 & !other.0)
    }

    /// Returns these faces and the others.
    pub const fn and(self, other: BoxFaces) -> BoxFaces {
        BoxFaces(self.0 | other.0)
    }

    fn contains(self, face: &Face) -> bool {
        self.0 & face.bit != 0
    }
}

struct Face {
    bit: u8,
    normal: Vec3,
    right: Vec3,
    up: Vec3,
}

const FACES: [Face; 6] = [
    Face { bit: 1, normal: Vec3::X, right: Vec3::NEG_Z, up: Vec3::Y },
    Face { bit: 2, normal: Vec3::NEG_X, right: Vec3::Z, up: Vec3::Y },
    Face { bit: 4, normal: Vec3::Y, right: Vec3::X, up: Vec3::NEG_Z },
    Face { bit: 8, normal: Vec3::NEG_Y, right: Vec3::X, up: Vec3::Z },
    Face { bit: 16, normal: Vec3::Z, right: Vec3::X, up: Vec3::Y },
    Face { bit: 32, normal: Vec3::NEG_Z, right: Vec3::NEG_X, up: Vec3::Y },
];

impl Face {
    fn corners(&self, min: Vec3, max: Vec3) -> [Vec3; 4] {
        let (center, half) = ((min + max) * 0.5, (max - min) * 0.5);
        let at = |r: f32, u: f32| center + (self.normal + self.right * r + self.up * u) * half;
        [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]
    }

    fn metres(&self, p: Vec3) -> Vec2 {
        vec2(p.dot(self.right), p.dot(self.up))
    }

    fn lies_on(&self, p: Vec3, min: Vec3, max: Vec3) -> bool {
        let center = (min + max) * 0.5;
        (p - center).dot(self.normal) > 0.0
    }
}

fn quad_normal(corners: &[Vec3; 4]) -> Vec3 {
    let [a, b, c, d] = *corners;
    (c - a).cross(d - b).normalize_or(Vec3::Y)
}

trait SplitRuns<T> {
    fn split_inclusive_at(&self, cut: impl Fn(&T, &T) -> bool) -> Vec<&[T]>;
}

impl<T> SplitRuns<T> for [T] {
    /// Returns the runs of at least two items, split between neighbours for which `cut` is true.
    fn split_inclusive_at(&self, cut: impl Fn(&T, &T) -> bool) -> Vec<&[T]> {
        self.chunk_by(|a, b| !cut(a, b)).filter(|run| run.len() > 1).collect()
    }
}

/// Triangulates a simple counter-clockwise polygon by ear clipping. Returns indices into the outline.
pub fn triangulate(outline: &[Vec2]) -> Vec<[usize; 3]> {
    let mut left: Vec<usize> = (0..outline.len()).collect();
    let mut triangles = Vec::with_capacity(outline.len().saturating_sub(2));
    while left.len() > 3 {
        let n = left.len();
        let ear = (0..n).find(|&i| {
            let [a, b, c] = [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
            let [p, q, r] = [outline[a], outline[b], outline[c]];
            (q - p).perp_dot(r - p) > 1e-12
                && left.iter().all(|&k| k == a || k == b || k == c || !inside(outline[k], p, q, r))
        });
        // Only a degenerate rest, which has no area, has no ear.
        let Some(i) = ear else { return triangles };
        triangles.push([left[(i + n - 1) % n], left[i], left[(i + 1) % n]]);
        left.remove(i);
    }
    if let [a, b, c] = left[..] {
        triangles.push([a, b, c]);
    }
    triangles
}

fn inside(p: Vec2, a: Vec2, b: Vec2, c: Vec2) -> bool {
    let side = |a: Vec2, b: Vec2| (b - a).perp_dot(p - a);
    side(a, b) >= 0.0 && side(b, c) >= 0.0 && side(c, a) >= 0.0
}

/// Returns a camera path from positions and targets in metres.
pub fn viewpoints(steps: &[([f32; 3], [f32; 3])]) -> Vec<Viewpoint> {
    let viewpoint = |&(position, target): &([f32; 3], [f32; 3])| Viewpoint {
        position: position.into(),
        target: target.into(),
    };
    steps.iter().map(viewpoint).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn built(draw: impl FnOnce(&mut SceneBuilder)) -> Model {
        let mut s = SceneBuilder::new();
        let plain = s.material(Material::default(), 1.0);
        s.with_material(plain);
        draw(&mut s);
        s.finish()
    }

    /// Returns the volume by the divergence theorem, which is right only if the model is closed and wound outwards.
    fn volume(model: &Model) -> f32 {
        model
            .indices
            .chunks_exact(3)
            .map(|t| {
                let [a, b, c] = [t[0], t[1], t[2]].map(|i| model.vertices[i as usize].position);
                a.dot(b.cross(c)) / 6.0
            })
            .sum()
    }

    fn assert_faces_its_normals(model: &Model) {
        for t in model.indices.chunks_exact(3) {
            let v = [t[0], t[1], t[2]].map(|i| model.vertices[i as usize]);
            let facing = (v[1].position - v[0].position).cross(v[2].position - v[0].position);
            let normal: Vec3 = v.iter().map(|v| v.normal).sum();
            assert!(facing.dot(normal) > 0.0, "{v:?}");
        }
    }

    #[test]
    fn closed_shapes_have_their_volume_and_face_outwards() {
        let half_arch = 2.0 * 1.5 + PI * 0.5;
        let l_shape =
            [vec2(0.0, 0.0), vec2(2.0, 0.0), vec2(2.0, 1.0), vec2(1.0, 1.0), vec2(1.0, 2.0), vec2(0.0, 2.0)];
        type Draw<'a> = Box<dyn FnOnce(&mut SceneBuilder) + 'a>;
        let shapes: Vec<(&str, f32, Draw)> = vec![
            ("cuboid", 6.0, Box::new(|s| s.cuboid(vec3(1.0, 1.0, 1.0), vec3(2.0, 3.0, 4.0)))),
            ("bevel", 5.95, Box::new(|s| s.beveled_cuboid(vec3(1.0, 1.0, 1.0), vec3(2.0, 3.0, 4.0), 0.05))),
            (
                "cylinder",
                PI * 2.0,
                Box::new(|s| s.cylinder(Vec3::X, vec3(3.0, 0.0, 0.0), 1.0, 1.0, 64, true)),
            ),
            ("cone", PI / 3.0, Box::new(|s| s.cylinder(Vec3::Y, Vec3::ZERO, 1.0, 0.0, 64, true))),
            ("ball", 4.18, Box::new(|s| s.ellipsoid(Vec3::ONE, Vec3::ONE, 32, 64))),
            ("tube", PI * 0.5, Box::new(|s| s.tube(&[Vec3::ZERO, Vec3::Y, Vec3::Y * 2.0], 0.5, 64, true))),
            ("extrusion", 1.5, Box::new(|s| s.extrude(&l_shape, -0.25, 0.25, true))),
            ("stairs", 1.0 * 0.2 * 0.3 * 6.0, Box::new(|s| s.stairs(1.0, 0.2, 0.3, 3))),
        ];
        for (name, expected, draw) in shapes {
            let plain = built(draw);
            assert_faces_its_normals(&plain);
            assert!((volume(&plain) / expected - 1.0).abs() < 0.02, "{name}: {}", volume(&plain));
        }
        // The panel has no underside, but its base is in the plane that contributes nothing.
        let arch = built(|s| {
            s.arched_wall(vec2(4.0, 3.0), ArchOpening { width: 2.0, spring: 1.5 }, 0.5, 64);
        });
        assert_faces_its_normals(&arch);
        assert!((volume(&arch) - (12.0 - half_arch) * 0.5).abs() < 0.02, "{}", volume(&arch));
    }

    #[test]
    fn mirrored_shapes_still_face_outwards() {
        let mirrored = built(|s| {
            s.within(Affine3A::from_scale(vec3(-1.0, 1.0, 2.0)), |s| {
                s.ellipsoid(Vec3::X, Vec3::ONE, 16, 24);
                s.beveled_cuboid(Vec3::ZERO, Vec3::ONE, 0.1);
            });
        });
        assert!(volume(&mirrored) > 0.0);
        assert_faces_its_normals(&mirrored);
    }

    #[test]
    fn parts_are_merged_by_object_and_material() {
        let mut s = SceneBuilder::new();
        let a = s.material(Material::default(), 1.0);
        let b = s.material(Material::default(), 1.0);
        for (object, material) in [("x", a), ("y", b), ("x", b), ("x", a)] {
            s.object(object).with_material(material).cuboid(Vec3::ZERO, Vec3::ONE);
        }
        let model = s.finish();
        let parts: Vec<_> =
            model.parts.iter().map(|p| (p.name.as_str(), p.material, p.indices.len())).collect();
        assert_eq!(parts, [("x", a, 72), ("x", b, 36), ("y", b, 36)]);
        assert_eq!(model.triangle_count(), 48);
    }

    #[test]
    fn texel_density_is_constant() {
        let mut s = SceneBuilder::new();
        let half_metre = s.material(Material::default(), 0.5);
        s.with_material(half_metre).cuboid(Vec3::ZERO, vec3(2.0, 1.0, 3.0));
        for t in s.finish().vertices.chunks_exact(4) {
            let metres = t[0].position.distance(t[2].position);
            assert!((t[0].uv.distance(t[2].uv) - metres / 0.5).abs() < 1e-4);
        }
    }
}
