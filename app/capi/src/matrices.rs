//! Eyes given by view and projection matrices, from which pose, frustum and depth range are computed and checked.

use glam::{DMat3, DMat4, DQuat, DVec3, DVec4};
use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, Frustum, Pose};

use crate::result::{Failure, YORO_ERROR_MATRIX, YoroMessages, YoroResult};
use crate::types::{Clip, YoroClip, YoroEye, YoroRows, clip, eye, rows_down};
use crate::versioned::versioned;
use crate::views::{YoroViews, fill_views, guard_band, images, views};

/// The two eyes of a frame, given by matrices. All are column-major, for column vectors, as GL and Vulkan take them. The
/// translation of a view matrix is in elements 12 to 14. Element 11 of a projection is -1 for eyes that look along -Z, and 1
/// for eyes that look along +Z.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroMatrices {
    /// sizeof(YoroMatrices).
    pub struct_size: u32,
    /// The eye that is rendered.
    pub rendered: YoroEye,
    /// Width of each eye's image in pixels.
    pub width: u32,
    /// Height of each eye's image in pixels.
    pub height: u32,
    /// World to eye, left eye first: rotation and translation only. The world may be right- or left-handed.
    pub view: [[f32; 16]; 2],
    /// Eye to clip space, left eye first: perspective. Reversed and infinite depth are recognized.
    pub projection: [[f32; 16]; 2],
    /// The clip volume of the projections.
    pub clip: YoroClip,
    /// Order of rows in the images.
    pub rows: YoroRows,
    /// As in YoroEyes, in metres.
    pub guard_band: f32,
    /// Units of the world in a metre: 100 for centimetres. 0 means 1.
    pub units_per_metre: f32,
    /// Where the sentences of errors go.
    pub messages: YoroMessages,
}

versioned!(YoroMatrices);

/// Computes the view to render, and the mapping of its pixels to the other eye. The resulting matrices have the world, clip
/// volume and units of the given ones. Poses are in metres.
///
/// Call it from any thread, without a context. It allocates and keeps nothing.
///
/// @param matrices The eyes.
/// @param views    Filled in; the caller sets struct_size.
/// @pre Both pointers lead to structures of the size that they state.
/// @return YORO_ERROR_MATRIX for matrices that are not rigid views or perspective projections; otherwise as
///         yoro_views_from_eyes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_views_from_matrices(
    matrices: *const YoroMatrices,
    views: *mut YoroViews,
) -> YoroResult {
    // SAFETY: the header asks for pointers to structures of the size that they state.
    unsafe { fill_views(matrices, "matrices", views, |matrices| matrices.messages, YoroMatrices::views) }
}

/// The contents of a projection matrix, for an eye that looks along -Z.
#[derive(Clone, Copy, Debug)]
struct Projection {
    /// +1 for an eye that looks along -Z, -1 along +Z.
    sense: f64,
    frustum: Frustum,
    /// Stored depth is `law[0] + law[1] / distance`.
    law: [f64; 2],
}

fn wrong(sentence: String) -> Failure {
    Failure::new(YORO_ERROR_MATRIX, sentence)
}

impl Projection {
    fn new(elements: &[f32; 16], clip: &Clip, eye: Eye) -> Result<Projection, Failure> {
        let name = eye.name();
        let matrix = DMat4::from_cols_array(&elements.map(f64::from));
        let w = matrix.row(3);
        let zeros = [matrix.x_axis.y, matrix.x_axis.z, matrix.y_axis.x, matrix.y_axis.z];
        let offsets = [matrix.w_axis.x, matrix.w_axis.y, w.x, w.y, w.w, w.z.abs() - 1.0];
        let is_zero = |n: &f64| n.abs() <= 1e-5;
        // In this form NaN fails, too.
        if !(matrix.is_finite() && zeros.iter().chain(&offsets).all(is_zero)) {
            return Err(wrong(format!(
                "the {name} eye's projection is not a perspective one: give a column-major matrix with -1 or 1 in element \
                 11, without rotation or shear"
            )));
        }
        let sense = -w.z.signum();
        let [x, y, z] = [0, 1, 2].map(|row| matrix.row(row));
        let up = clip.up * y.y;
        if !(x.x > 0.0 && up > 0.0) {
            return Err(wrong(format!(
                "the {name} eye's projection has {:.4} and {:.4} in elements 0 and 5, which for this YORO_CLIP_ must be \
                 positive and {}: choose the clip volume that the matrix is made for",
                x.x,
                y.y,
                if clip.up > 0.0 { "positive" } else { "negative" }
            )));
        }
        // x_ndc = x.x * tangent - sense * x.z, and the edges are at -1 and 1.
        let frustum = Frustum {
            left: ((-1.0 + sense * x.z) / x.x) as f32,
            right: ((1.0 + sense * x.z) / x.x) as f32,
            bottom: ((-1.0 + clip.up * sense * y.z) / up) as f32,
            top: ((1.0 + clip.up * sense * y.z) / up) as f32,
        };
        let law = [(-sense * z.z - clip.offset) / clip.scale, z.w / clip.scale];
        Ok(Projection { sense, frustum, law })
    }

    /// Returns the planes, in the world's units, and their encoding.
    fn range(&self, eye: Eye) -> Result<DepthRange, Failure> {
        let [a, b] = self.law;
        // Depth 0 and 1 at these distances; a difference of one or two roundings stands for an infinite one.
        let at = |difference: f64| if difference.abs() < 2.5e-7 { f64::INFINITY } else { b / difference };
        let (zero, one) = (at(-a), at(1.0 - a));
        let convention = if b < 0.0 { DepthConvention::Standard } else { DepthConvention::Reversed };
        let (near, far) = if b < 0.0 { (zero, one) } else { (one, zero) };
        if !(near > 0.0 && near < far && near.is_finite()) {
            return Err(wrong(format!(
                "the {} eye's projection has its near plane at {near:.4} and its far plane at {far:.4}, which need \
                 0 < near < far: choose the clip volume that the matrix is made for",
                eye.name()
            )));
        }
        Ok(DepthRange { near: near as f32, far: far as f32, convention })
    }
}

/// Returns the contents of a view matrix: the eye's pose in the world's units, and true if the world is left-handed. The pose
/// is then in the world with the Z axis negated.
fn pose(elements: &[f32; 16], sense: f64, eye: Eye) -> Result<(DQuat, DVec3, bool), Failure> {
    let matrix = DMat4::from_cols_array(&elements.map(f64::from));
    let mut rotation = DMat3::from_mat4(matrix);
    let mut translation = matrix.w_axis.truncate();
    let gram = rotation * rotation.transpose() - DMat3::IDENTITY;
    let last = matrix.row(3) - DVec4::W;
    // In this form NaN fails, too.
    let small = |n: f64| n.abs() < 1e-3;
    if !(matrix.is_finite()
        && gram.to_cols_array().into_iter().all(small)
        && last.to_array().into_iter().all(small))
    {
        return Err(wrong(format!(
            "the {} eye's view is more than rotation and translation: give a column-major matrix from the world to the \
             eye, without scale",
            eye.name()
        )));
    }
    if sense < 0.0 {
        // Of an eye that looks along +Z the one that looks along -Z.
        let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
        rotation = mirror * rotation;
        translation = mirror * translation;
    }
    let left_handed = rotation.determinant() < 0.0;
    if left_handed {
        rotation *= DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
    }
    let orientation = DQuat::from_mat3(&rotation.transpose()).normalize();
    Ok((orientation, -(rotation.transpose() * translation), left_handed))
}

impl YoroMatrices {
    fn views(&self) -> Result<YoroViews, Failure> {
        let units = if self.units_per_metre == 0.0 { 1.0 } else { f64::from(self.units_per_metre) };
        if !(units > 0.0 && units.is_finite()) {
            return Err(Failure::value(format!(
                "{units} units in a metre are impossible: give 1 for metres"
            )));
        }
        let clip = clip(self.clip)?;
        let rendered = eye(self.rendered)?;
        let down = rows_down(self.rows)?;
        let [left, right] = [Eye::Left, Eye::Right].map(|eye| {
            let projection = Projection::new(&self.projection[eye.index()], &clip, eye)?;
            let view = pose(&self.view[eye.index()], projection.sense, eye)?;
            Ok::<_, Failure>((projection, view))
        });
        let eyes = [left?, right?];
        let [(a, (_, _, a_left_handed)), (b, (_, _, b_left_handed))] = &eyes;
        if a.sense != b.sense || a_left_handed != b_left_handed {
            return Err(wrong("one eye's matrices are left-handed and the other's right-handed".into()));
        }
        // The law moves a pixel by the distance that its depth stands for: a thousandth of that does not show.
        if (a.law[0] - b.law[0]).abs() > 1e-6 || (a.law[1] / b.law[1] - 1.0).abs() > 1e-3 {
            return Err(wrong(
                "the eyes' projections have different depth planes: give both the same".into(),
            ));
        }
        let mut depth = eyes[rendered.index()].0.range(rendered)?;
        depth.near = (f64::from(depth.near) / units) as f32;
        depth.far = (f64::from(depth.far) / units) as f32;
        let pair = EyePair {
            poses: eyes.map(|(_, (orientation, position, _))| Pose {
                position: (position / units).as_vec3(),
                orientation: orientation.as_quat(),
            }),
            frusta: eyes.map(|(projection, _)| projection.frustum),
            depth,
            size: [self.width, self.height],
            dominant: rendered,
        };
        let mut views = views(pair, guard_band(self.guard_band), down)?;
        for (image, eye) in images(&mut views).into_iter().zip([rendered, rendered, rendered.other()]) {
            let index = eye.index();
            image.view = self.view[index];
            image.projection = self.projection[index];
            // Depth stays as it is; edges are the image's.
            let sense = eyes[index].0.sense;
            for (row, values) in image.projection_xy(&clip).into_iter().enumerate() {
                image.projection[row] = values.x as f32;
                image.projection[4 + row] = values.y as f32;
                image.projection[8 + row] = (values.z * sense) as f32;
            }
        }
        Ok(views)
    }
}
