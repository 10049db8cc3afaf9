//! Makes a file's contents fit to draw: drops bad triangles, generates missing normals and texture coordinates, and
//! sorts triangles by material.

use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;

use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::error::{MAX_ELEMENTS, SceneError};
use super::model::{Material, Model, Part, Vertex};

/// Cosine of 40 degrees. Generated normals smooth the edge between faces that differ by less than this angle.
const CREASE_COSINE: f32 = 0.766;

/// Number of faces around a point above which generated normals are flat: comparing all pairs takes quadratic time.
const MAX_NEIGHBOURS: usize = 128;

/// Triangles as a file has them. Normals and texture coordinates may be missing for single vertices: these are not
/// finite, or zero normals.
#[derive(Clone, Debug, Default)]
pub(super) struct RawMesh {
    pub name: String,
    pub material: usize,
    pub vertices: Vec<Vertex>,
    pub indices: Vec<u32>,
    /// True if missing normals are those of the faces.
    pub flat: bool,
    /// A number for a moving mesh, whose vertices are in the frame of what carries it.
    pub moving: Option<usize>,
    /// For a moving mesh, each vertex's index in the file.
    pub sources: Vec<u32>,
}

impl RawMesh {
    /// Notes that the vertices were split. `previous` has the previous index of each.
    pub fn split(&mut self, previous: &[u32]) {
        if self.moving.is_some() {
            self.sources = previous.iter().map(|&i| self.sources[i as usize]).collect();
        }
    }
}

/// The place of a moving mesh in the model.
pub(super) struct Placed {
    /// The mesh's [`RawMesh::moving`].
    pub moving: usize,
    /// Range of the model's vertices.
    pub vertices: Range<usize>,
    /// Each vertex's index in the file.
    pub sources: Vec<u32>,
}

/// Marks a missing normal.
pub(super) const NO_NORMAL: Vec3 = Vec3::NAN;
/// Marks missing texture coordinates.
pub(super) const NO_UV: Vec2 = Vec2::NAN;

/// Makes the model, and returns the places of moving meshes in it. The caller adds the textures, and must have set the
/// materials' maps before.
pub(super) fn assemble(
    path: &Path,
    mut meshes: Vec<RawMesh>,
    materials: Vec<Material>,
) -> Result<(Model, Vec<Placed>), SceneError> {
    let before: usize = meshes.iter().map(|m| m.indices.len() / 3).sum();
    meshes.par_iter_mut().for_each(clean);
    let kept: usize = meshes.iter().map(|m| m.indices.len() / 3).sum();
    if kept == 0 {
        return Err(SceneError::empty(path));
    }
    if kept < before {
        log::warn!(
            "{}: {} of {before} triangles have no area or coordinates that are not numbers; they are left out",
            path.display(),
            before - kept
        );
    }
    generate(&mut meshes, &materials);
    if meshes.iter().map(|m| m.vertices.len()).sum::<usize>() > MAX_ELEMENTS {
        return Err(SceneError::too_large(path, MAX_ELEMENTS, "vertices"));
    }
    Ok(sorted(meshes, materials))
}

/// Drops triangles without area, normalizes normals, and marks unusable ones as missing.
fn clean(mesh: &mut RawMesh) {
    let RawMesh { vertices, indices, .. } = mesh;
    let mut kept = 0;
    for i in 0..indices.len() / 3 {
        let triangle = [indices[i * 3], indices[i * 3 + 1], indices[i * 3 + 2]];
        let points = triangle.map(|v| vertices.get(v as usize).map_or(Vec3::NAN, |v| v.position));
        if points.iter().all(|p| p.is_finite()) && area_vector(points) != DVec3::ZERO {
            indices[kept..kept + 3].copy_from_slice(&triangle);
            kept += 3;
        }
    }
    indices.truncate(kept);
    for v in vertices {
        v.normal = v.normal.as_dvec3().try_normalize().map_or(NO_NORMAL, |n| n.as_vec3());
        if !v.uv.is_finite() {
            v.uv = NO_UV;
        }
    }
}

/// Returns the normal times twice the area; zero if rounding leaves no direction. Uses f64, since f32 underflows on
/// small parts.
fn area_vector([a, b, c]: [Vec3; 3]) -> DVec3 {
    let (u, v) = ((b - a).as_dvec3(), (c - a).as_dvec3());
    let cross = u.cross(v);
    let longest = u.length_squared().max(v.length_squared()).max((v - u).length_squared());
    if cross.length() > 1e-9 * longest { cross } else { DVec3::ZERO }
}

fn corners(mesh: &RawMesh, triangle: usize) -> [Vertex; 3] {
    [0, 1, 2].map(|k| mesh.vertices[mesh.indices[triangle * 3 + k] as usize])
}

/// Fills in what is missing. Normals are averages, weighted by area, over the faces around a point that differ by less
/// than the crease angle. Texture coordinates are the two coordinates across the face's main axis, 1 per metre.
fn generate(meshes: &mut [RawMesh], materials: &[Material]) {
    let mapped: Vec<bool> = materials
        .iter()
        .map(|m| [m.diffuse_map, m.specular_map, m.emissive_map, m.normal_map].iter().any(Option::is_some))
        .collect();
    let lacks_normal = |m: &RawMesh| m.indices.iter().any(|&i| m.vertices[i as usize].normal.is_nan());
    let lacks_uv = |m: &RawMesh| m.indices.iter().any(|&i| m.vertices[i as usize].uv.is_nan());
    let neighbours = Neighbours::new(meshes, |m| !m.flat && lacks_normal(m));
    meshes.par_iter_mut().enumerate().for_each(|(index, mesh)| {
        let (no_normal, no_uv) = (lacks_normal(mesh), lacks_uv(mesh));
        if no_uv && !mapped[mesh.material] {
            mesh.vertices.iter_mut().filter(|v| v.uv.is_nan()).for_each(|v| v.uv = Vec2::ZERO);
        }
        if !(no_normal || no_uv && mapped[mesh.material]) {
            return;
        }
        let mut vertices = Vec::with_capacity(mesh.vertices.len());
        let mut previous = Vec::with_capacity(mesh.vertices.len());
        let mut indices = Vec::with_capacity(mesh.indices.len());
        let mut known: HashMap<[u32; 6], u32> = HashMap::new();
        for triangle in 0..mesh.indices.len() / 3 {
            let mut triangle_corners = corners(mesh, triangle);
            let face = area_vector(triangle_corners.map(|v| v.position)).normalize().as_vec3();
            for (k, v) in triangle_corners.iter_mut().enumerate() {
                let old = mesh.indices[triangle * 3 + k];
                if v.normal.is_nan() {
                    v.normal = if mesh.flat { face } else { neighbours.normal(index, old, face) };
                }
                if v.uv.is_nan() {
                    v.uv = box_projection(v.position, face);
                }
                let bits = [v.normal.x, v.normal.y, v.normal.z, v.uv.x, v.uv.y].map(f32::to_bits);
                let key = [old, bits[0], bits[1], bits[2], bits[3], bits[4]];
                indices.push(*known.entry(key).or_insert_with(|| {
                    vertices.push(*v);
                    previous.push(old);
                    vertices.len() as u32 - 1
                }));
            }
        }
        mesh.split(&previous);
        mesh.vertices = vertices;
        mesh.indices = indices;
    });
}

fn box_projection(p: Vec3, normal: Vec3) -> Vec2 {
    let size = normal.abs();
    if size.y >= size.x && size.y >= size.z {
        Vec2::new(p.x, -p.z * normal.y.signum())
    } else if size.x >= size.z {
        Vec2::new(-p.z * normal.x.signum(), p.y)
    } else {
        Vec2::new(p.x * normal.z.signum(), p.y)
    }
}

/// The faces around every point of the meshes with missing normals. Vertices with equal coordinates are one point,
/// because exporters and groups split them.
struct Neighbours {
    /// For every mesh, the point of each vertex; empty for meshes without missing normals.
    points: Vec<Vec<u32>>,
    /// Index of each point's first face, and one more at the end.
    starts: Vec<u32>,
    /// Normals times area.
    faces: Vec<Vec3>,
}

impl Neighbours {
    fn new(meshes: &[RawMesh], needed: impl Fn(&RawMesh) -> bool) -> Neighbours {
        let mut ids: HashMap<[u32; 3], u32> = HashMap::new();
        let mut points = vec![Vec::new(); meshes.len()];
        for (mesh, points) in meshes.iter().zip(&mut points) {
            if needed(mesh) {
                points.extend(mesh.vertices.iter().map(|v| {
                    // -0 and 0 are the same place.
                    let key = (v.position + 0.0).to_array().map(f32::to_bits);
                    let next = ids.len() as u32;
                    *ids.entry(key).or_insert(next)
                }));
            }
        }
        let mut starts = vec![0u32; ids.len() + 1];
        let needing = || meshes.iter().zip(&points).filter(|(_, p)| !p.is_empty());
        for (mesh, points) in needing() {
            mesh.indices.iter().for_each(|&i| starts[points[i as usize] as usize + 1] += 1);
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let mut faces = vec![Vec3::ZERO; starts.last().map_or(0, |&n| n as usize)];
        for (mesh, points) in needing() {
            for triangle in 0..mesh.indices.len() / 3 {
                let area = area_vector(corners(mesh, triangle).map(|v| v.position)).as_vec3();
                for &i in &mesh.indices[triangle * 3..triangle * 3 + 3] {
                    let slot = &mut next[points[i as usize] as usize];
                    faces[*slot as usize] = area;
                    *slot += 1;
                }
            }
        }
        Neighbours { points, starts, faces }
    }

    fn normal(&self, mesh: usize, vertex: u32, face: Vec3) -> Vec3 {
        let point = self.points[mesh][vertex as usize] as usize;
        let around = &self.faces[self.starts[point] as usize..self.starts[point + 1] as usize];
        if around.len() > MAX_NEIGHBOURS {
            return face;
        }
        let similar = around.iter().filter(|n| n.dot(face) >= CREASE_COSINE * n.length());
        similar.sum::<Vec3>().try_normalize().unwrap_or(face)
    }
}

/// Returns one vertex and one index list, sorted by material and otherwise in the file's order. Joins parts with the
/// same name and material, and drops unused vertices. A moving mesh is a part of its own.
fn sorted(meshes: Vec<RawMesh>, materials: Vec<Material>) -> (Model, Vec<Placed>) {
    let mut placed = Vec::new();
    let mut model = Model { materials, ..Model::default() };
    let mut first: HashMap<(usize, &str), usize> = HashMap::new();
    let place: Vec<usize> = meshes
        .iter()
        .enumerate()
        .map(|(i, m)| *first.entry((m.material, m.name.as_str())).or_insert(i))
        .collect();
    let mut order: Vec<usize> = (0..meshes.len()).filter(|&i| !meshes[i].indices.is_empty()).collect();
    order.sort_by_key(|&i| (meshes[i].material, place[i]));
    model.indices.reserve_exact(meshes.iter().map(|m| m.indices.len()).sum());
    for i in order {
        let mesh = &meshes[i];
        let mut remap = vec![u32::MAX; mesh.vertices.len()];
        let (start, first) = (model.indices.len(), model.vertices.len());
        let mut sources = Vec::new();
        for &index in &mesh.indices {
            let slot = &mut remap[index as usize];
            if *slot == u32::MAX {
                *slot = model.vertices.len() as u32;
                model.vertices.push(mesh.vertices[index as usize]);
                sources.extend(mesh.sources.get(index as usize));
            }
            model.indices.push(*slot);
        }
        let end = model.indices.len();
        let still = mesh.moving.is_none() && placed.last().is_none_or(|p: &Placed| p.vertices.end < first);
        if let Some(moving) = mesh.moving {
            placed.push(Placed { moving, vertices: first..model.vertices.len(), sources });
        }
        match model.parts.last_mut() {
            Some(last) if still && last.material == mesh.material && last.name == mesh.name => {
                last.indices.end = end;
            }
            _ => model.parts.push(Part {
                name: mesh.name.clone(),
                material: mesh.material,
                indices: start..end,
            }),
        }
    }
    (model, placed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(points: &[[f32; 3]], indices: &[u32]) -> RawMesh {
        let vertex = |p: &[f32; 3]| Vertex { position: (*p).into(), normal: NO_NORMAL, uv: NO_UV };
        RawMesh {
            name: "m".into(),
            vertices: points.iter().map(vertex).collect(),
            indices: indices.to_vec(),
            ..Default::default()
        }
    }

    fn mapped() -> Material {
        Material { diffuse_map: Some(0), ..Material::default() }
    }

    /// Returns a ridge of two faces at the given angle to each other.
    fn ridge(degrees: f32) -> Model {
        let (s, c) = degrees.to_radians().sin_cos();
        let m = mesh(&[[0., 0., 0.], [0., 0., -1.], [-1., 0., 0.], [c, -s, 0.]], &[0, 1, 2, 0, 3, 1]);
        assemble(Path::new("ridge"), vec![m], vec![Material::default()]).unwrap().0
    }

    #[test]
    fn edges_are_smooth_below_the_crease_angle() {
        let smooth = ridge(30.0);
        assert_eq!(smooth.vertices.len(), 4);
        let tilt = smooth.vertices[0].normal.angle_between(Vec3::Y).to_degrees();
        assert!((tilt - 15.0).abs() < 0.1, "{tilt}");
        let hard = ridge(50.0);
        assert_eq!(hard.vertices.len(), 6);
        assert!(hard.vertices[0].normal.distance(Vec3::Y) < 1e-5);
    }

    #[test]
    fn split_points_are_smoothed_across_meshes() {
        let (s, c) = 30f32.to_radians().sin_cos();
        let a = mesh(&[[-0.0, 0., 0.], [0., 0., -1.], [-1., 0., 0.]], &[0, 1, 2]);
        let b = mesh(&[[0., 0., 0.], [c, -s, 0.], [0., 0., -1.]], &[0, 1, 2]);
        let (model, _) = assemble(Path::new("x"), vec![a, b], vec![Material::default()]).unwrap();
        assert!((model.vertices[0].normal.angle_between(Vec3::Y).to_degrees() - 15.0).abs() < 0.1);
        assert_eq!(model.parts.len(), 1);
        assert_eq!(model.parts[0].indices, 0..6);
    }

    #[test]
    fn bad_triangles_and_unused_vertices_are_dropped() {
        let m = mesh(
            &[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [f32::NAN, 0., 0.], [2., 0., 0.], [1e30, 0., 0.]],
            &[0, 1, 2, 0, 1, 3, 0, 1, 4, 0, 0, 1, 0, 1, 99],
        );
        let (model, _) = assemble(Path::new("x"), vec![m.clone()], vec![Material::default()]).unwrap();
        assert_eq!((model.triangle_count(), model.vertices.len()), (1, 3));
        assert_eq!(model.bounds().max, Vec3::new(1.0, 1.0, 0.0));
        let nothing = RawMesh { indices: vec![0, 0, 1], ..m };
        let refused = assemble(Path::new("x"), vec![nothing], vec![Material::default()]).err().unwrap();
        assert!(refused.to_string().contains("no triangle"), "{refused}");
    }

    #[test]
    fn tiny_triangles_are_kept() {
        let m = mesh(&[[0., 0., 0.], [1e-12, 0., 0.], [0., 1e-12, 0.]], &[0, 1, 2]);
        let (model, _) = assemble(Path::new("x"), vec![m], vec![Material::default()]).unwrap();
        assert_eq!(model.vertices[0].normal, Vec3::Z);
    }

    #[test]
    fn texture_coordinates_are_in_metres_and_only_where_needed() {
        let m = mesh(&[[0., 0., 0.], [3., 0., 0.], [3., 2., 0.]], &[0, 1, 2]);
        let (model, _) = assemble(Path::new("x"), vec![m.clone()], vec![mapped()]).unwrap();
        assert_eq!(model.vertices[2].uv, Vec2::new(3.0, 2.0));
        let (model, _) = assemble(Path::new("x"), vec![m], vec![Material::default()]).unwrap();
        assert_eq!(model.vertices[2].uv, Vec2::ZERO);
    }

    #[test]
    fn parts_are_sorted_by_material_and_joined_by_name() {
        let part = |name: &str, material| RawMesh {
            name: name.into(),
            material,
            ..mesh(&[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], &[0, 1, 2])
        };
        let meshes = vec![part("a", 1), part("b", 0), part("c", 1), part("a", 1)];
        let (model, _) = assemble(Path::new("x"), meshes, vec![Material::default(), mapped()]).unwrap();
        let parts: Vec<_> =
            model.parts.iter().map(|p| (p.name.as_str(), p.material, p.indices.clone())).collect();
        assert_eq!(parts, [("b", 0, 0..3), ("a", 1, 3..9), ("c", 1, 9..12)]);
    }
}
