//! The triangles of a primitive.

use glam::{Mat3, Mat4, Vec3};
use gltf::accessor::Dimensions;
use gltf::mesh::Mode;
use gltf::{Primitive, Semantic};

use super::material::unit;
use super::reader::Reader;
use crate::error::SceneError;
use crate::model::Vertex;
use crate::repair::{NO_NORMAL, NO_UV, RawMesh};

/// Transforms triangles, and reverses their winding if they are `turned`.
pub(super) fn transform(mesh: &mut RawMesh, matrix: Mat4, turned: bool) {
    let linear = Mat3::from_mat4(matrix);
    // Normals transform with the inverse transpose, which is the matrix of cofactors without the division.
    let normal_matrix = Mat3::from_cols(
        linear.y_axis.cross(linear.z_axis),
        linear.z_axis.cross(linear.x_axis),
        linear.x_axis.cross(linear.y_axis),
    ) * if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    for v in &mut mesh.vertices {
        v.position = matrix.transform_point3(v.position);
        v.normal = normal_matrix * v.normal;
    }
    if turned {
        mesh.indices.chunks_exact_mut(3).for_each(|t| t.swap(1, 2));
    }
}

impl Reader<'_> {
    /// Returns the triangles of a primitive in its own frame, with a set of texture coordinates.
    pub(super) fn primitive(&self, primitive: &Primitive, set: u32) -> Result<Option<RawMesh>, SceneError> {
        let Some(positions) = primitive.get(&Semantic::Positions) else { return Ok(None) };
        let positions = self.floats::<3>(&positions, &[Dimensions::Vec3])?;
        let normals = primitive
            .get(&Semantic::Normals)
            .map(|a| self.floats::<3>(&a, &[Dimensions::Vec3]))
            .transpose()?
            .unwrap_or_default();
        let uvs = primitive
            .get(&Semantic::TexCoords(set))
            .map(|a| self.floats::<2>(&a, &[Dimensions::Vec2]))
            .transpose()?
            .unwrap_or_default();
        let vertices: Vec<Vertex> = positions
            .iter()
            .enumerate()
            .map(|(i, p)| Vertex {
                position: (*p).into(),
                normal: normals.get(i).map_or(NO_NORMAL, |n| (*n).into()),
                uv: uvs.get(i).map_or(NO_UV, |t| (*t).into()),
            })
            .collect();
        let list = match primitive.indices() {
            Some(accessor) => self.indices(&accessor, vertices.len())?,
            None => (0..vertices.len() as u32).collect(),
        };
        let mut indices = match primitive.mode() {
            Mode::Triangles => list,
            Mode::TriangleStrip => {
                let odd_turned = |(i, t): (usize, &[u32])| {
                    if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] }
                };
                list.windows(3).enumerate().flat_map(odd_turned).collect()
            }
            Mode::TriangleFan => match list.split_first() {
                Some((&center, rim)) => rim.windows(2).flat_map(|t| [center, t[0], t[1]]).collect(),
                None => Vec::new(),
            },
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => return Ok(None),
        };
        indices.truncate(indices.len() / 3 * 3);
        // The specification requires flat normals if none are given.
        Ok(Some(RawMesh { vertices, indices, flat: true, ..RawMesh::default() }))
    }

    /// Returns the colours of a primitive's vertices, linear RGB; `None` if there are none, or if all are white.
    pub(super) fn colors(&self, primitive: &Primitive) -> Result<Option<Vec<Vec3>>, SceneError> {
        let Some(accessor) = primitive.get(&Semantic::Colors(0)) else { return Ok(None) };
        let colors = self.floats::<3>(&accessor, &[Dimensions::Vec3, Dimensions::Vec4])?;
        let colors: Vec<Vec3> = colors.into_iter().map(|c| Vec3::from(c.map(unit))).collect();
        Ok(colors.iter().any(|c| *c != Vec3::ONE).then_some(colors))
    }
}
