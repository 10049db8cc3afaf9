//! Eyes given as view and projection matrices, from which poses, frusta and the depth range are computed and checked.

use glam::{DMat3, DMat4, DQuat, DVec3, DVec4};
use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, Frustum, Pose};

use crate::eyes::{YoroEyesFlags, with_flags};
use crate::result::{Failure, YORO_ERROR_MATRIX, YoroMessages, YoroResult};
use crate::types::{Clip, YoroClip, YoroEye, YoroRows, clip, eye, rows_down};
use crate::versioned::{check_reserved, versioned};
use crate::views::{YoroViews, fill_views, guard_band, images, views};

/// The two eyes of a frame, given as matrices. They may be any distance apart. All matrices are column-major, for
/// column vectors, as in GL and Vulkan. The translation of a view matrix is in elements 12 to 14. Element 11 of a
/// projection is -1 for eyes that look along -Z, and 1 for eyes that look along +Z.
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
    /// Eye to clip space, left eye first: perspective projections. Reversed and infinite depth are recognized.
    pub projection: [[f32; 16]; 2],
    /// The clip volume of the projections.
    pub clip: YoroClip,
    /// The order of rows in the images.
    pub rows: YoroRows,
    /// Guard band in metres, as in YoroEyes.
    pub guard_band: f32,
    /// Number of world units in a metre: 100 for centimetres. 0 means 1.
    pub units_per_metre: f32,
    /// Receives error messages.
    pub messages: YoroMessages,
    /// YORO_EYES_ bits. The resulting view matrices are rotated with the eyes.
    pub flags: YoroEyesFlags,
    /// Must be 0.
    pub reserved: u32,
}

versioned!(YoroMatrices);

/// Computes the view to render, and the mapping of its pixels to the other eye. The resulting matrices use the same
/// world, clip volume and units as the given ones. Poses are in metres.
///
/// The translation of a view matrix is rounded to 32 bits: at 1 km from the origin to 0.06 mm, a thousandth of the
/// distance between the eyes. Displacements caused by this rounding are removed, but the distance between the eyes
/// keeps its error. In larger worlds give matrices relative to the head: subtract its position from both eyes'
/// positions, in 64 bits, before computing the matrices.
///
/// Call it from any thread, without a context. It allocates and keeps nothing.
///
/// @param matrices The eyes.
/// @param views    Receives the views. The caller sets struct_size.
/// @pre Both pointers point to structures of the sizes that they state.
/// @return YORO_ERROR_MATRIX for matrices that are not rigid views or perspective projections; otherwise as for
///         yoro_views_from_eyes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_views_from_matrices(
    matrices: *const YoroMatrices,
    views: *mut YoroViews,
) -> YoroResult {
    // SAFETY: the header requires pointers to structures of the sizes that they state.
    unsafe { fill_views(matrices, "matrices", views, |matrices| matrices.messages, YoroMatrices::views) }
}

/// The contents of a projection matrix, as for an eye that looks along -Z.
#[derive(Clone, Copy, Debug)]
struct Projection {
    /// +1 for an eye that looks along -Z, -1 along +Z.
    sense: f64,
    frustum: Frustum,
    /// The depth buffer holds `law[0] + law[1] / distance`.
    law: [f64; 2],
}

fn wrong(sentence: String) -> Failure {
    Failure::new(YORO_ERROR_MATRIX, sentence)
}

/// Adds to a remedy that a matrix of the caller's has its rows where columns belong.
fn or_transposed(remedy: &str, transposed_fits: bool) -> String {
    let hint = if transposed_fits { " (yours is row-major: transpose it)" } else { "" };
    format!("{remedy}{hint}")
}

/// True for a perspective projection without rotation or shear.
fn is_perspective(matrix: &DMat4) -> bool {
    let w = matrix.row(3);
    let zeros = [matrix.x_axis.y, matrix.x_axis.z, matrix.y_axis.x, matrix.y_axis.z];
    let offsets = [matrix.w_axis.x, matrix.w_axis.y, w.x, w.y, w.w, w.z.abs() - 1.0];
    // Written so that NaN fails too.
    matrix.is_finite() && zeros.iter().chain(&offsets).all(|n| n.abs() <= 1e-5)
}

/// True for a rotation, or a reflection, with a translation.
fn is_rigid(matrix: &DMat4) -> bool {
    let rotation = DMat3::from_mat4(*matrix);
    let gram = rotation * rotation.transpose() - DMat3::IDENTITY;
    let last = matrix.row(3) - DVec4::W;
    // Written so that NaN fails too.
    let small = |n: f64| n.abs() < 1e-3;
    matrix.is_finite()
        && gram.to_cols_array().into_iter().all(small)
        && last.to_array().into_iter().all(small)
}

impl Projection {
    fn new(elements: &[f32; 16], clip: &Clip, eye: Eye) -> Result<Projection, Failure> {
        let name = eye.name();
        let matrix = DMat4::from_cols_array(&elements.map(f64::from));
        if !is_perspective(&matrix) {
            return Err(wrong(format!(
                "the {name} eye's projection is not a perspective one: give {}",
                or_transposed(
                    "a column-major matrix with -1 or 1 in element 11, without rotation or shear",
                    is_perspective(&matrix.transpose())
                )
            )));
        }
        let sense = -matrix.row(3).z.signum();
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

    /// Returns the depth planes, in world units, and their encoding.
    fn range(&self, eye: Eye) -> Result<DepthRange, Failure> {
        let [a, b] = self.law;
        // The distances at which depth is 0 and 1. A difference of one or two roundings stands for infinity.
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

/// The contents of a view matrix, as for an eye that looks along -Z. In a left-handed world, the world's Z axis is
/// negated.
#[derive(Clone, Copy, Debug)]
struct EyeView {
    orientation: DQuat,
    /// Translation of the matrix, in the world's units.
    translation: DVec3,
    left_handed: bool,
}

fn eye_view(elements: &[f32; 16], sense: f64, eye: Eye) -> Result<EyeView, Failure> {
    let matrix = DMat4::from_cols_array(&elements.map(f64::from));
    if !is_rigid(&matrix) {
        return Err(wrong(format!(
            "the {} eye's view is more than rotation and translation: give {}",
            eye.name(),
            or_transposed(
                "a column-major matrix from the world to the eye, without scale",
                is_rigid(&matrix.transpose())
            )
        )));
    }
    let mut rotation = DMat3::from_mat4(matrix);
    let mut translation = matrix.w_axis.truncate();
    if sense < 0.0 {
        // Converts an eye that looks along +Z to one that looks along -Z.
        let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
        rotation = mirror * rotation;
        translation = mirror * translation;
    }
    let left_handed = rotation.determinant() < 0.0;
    if left_handed {
        rotation *= DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
    }
    let orientation = DQuat::from_mat3(&rotation.transpose()).normalize();
    Ok(EyeView { orientation, translation, left_handed })
}

/// The positions of both eyes.
struct Places {
    /// The point between the eyes, in the world's units.
    head: DVec3,
    /// The offset of each eye from that point.
    eyes: [DVec3; 2],
}

impl Places {
    /// Removes displacements off the rendered eye's X axis that are no larger than the rounding of the matrices.
    fn new(views: &mut [EyeView; 2], rendered: Eye) -> Places {
        const ROUNDING: f64 = f32::EPSILON as f64;
        // A rotation that is rounded differently would turn the vector to a distant origin.
        if views[0].orientation.angle_between(views[1].orientation) < 4.0 * ROUNDING {
            views[1].orientation = views[0].orientation;
        }
        let [left, right] = views.map(|view| -(view.orientation * view.translation));
        let mut between = right - left;
        let off_axis = between.reject_from_normalized(views[rendered.index()].orientation * DVec3::X);
        // Each coordinate of a translation is a sum of three products, rounded three times. For two eyes this is up to
        // six halves of a unit in the last place, in each of two directions off the axis. The same amount again allows
        // for the rotations.
        if off_axis.length() < 8.0 * ROUNDING * left.length().max(right.length()) {
            between -= off_axis;
        }
        Places { head: (left + right) / 2.0, eyes: [-between / 2.0, between / 2.0] }
    }
}

/// Returns a view matrix whose eye is rotated from one orientation to another.
fn turned(view: &[f32; 16], from: DQuat, to: DQuat, sense: f64) -> [f32; 16] {
    let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, sense));
    let turn = mirror * DMat3::from_quat(to.inverse() * from) * mirror;
    (DMat4::from_mat3(turn) * DMat4::from_cols_array(&view.map(f64::from))).as_mat4().to_cols_array()
}

impl YoroMatrices {
    fn views(&self) -> Result<YoroViews, Failure> {
        check_reserved("matrices", &[self.reserved])?;
        let units = if self.units_per_metre == 0.0 { 1.0 } else { f64::from(self.units_per_metre) };
        if !(units > 0.0 && units.is_finite()) {
            return Err(Failure::value(format!(
                "{units} units in a metre are impossible: give 1 for metres"
            )));
        }
        let clip = clip(self.clip)?;
        let rendered = eye(self.rendered)?;
        let down = rows_down(self.rows)?;
        let ([a, b], mut eyes) = self.contents(&clip)?;
        if a.sense != b.sense || eyes[0].left_handed != eyes[1].left_handed {
            return Err(wrong("one eye's matrices are left-handed and the other's right-handed".into()));
        }
        // The law moves a pixel by an amount that depends on its depth. A thousandth of that is not visible.
        if (a.law[0] - b.law[0]).abs() > 1e-6 || (a.law[1] / b.law[1] - 1.0).abs() > 1e-3 {
            return Err(wrong(
                "the eyes' projections have different depth planes: give both the same".into(),
            ));
        }
        let projections = [a, b];
        let mut depth = projections[rendered.index()].range(rendered)?;
        depth.near = (f64::from(depth.near) / units) as f32;
        depth.far = (f64::from(depth.far) / units) as f32;
        let places = Places::new(&mut eyes, rendered);
        let pose = |eye: Eye| Pose {
            position: (places.eyes[eye.index()] / units).as_vec3(),
            orientation: eyes[eye.index()].orientation.as_quat(),
        };
        let given = EyePair {
            poses: Eye::BOTH.map(pose),
            frusta: projections.map(|projection| projection.frustum),
            depth,
            size: [self.width, self.height],
            dominant: rendered,
        };
        let pair = with_flags(given, self.flags)?;
        let mut views = views(pair, guard_band(self.guard_band), down)?;
        for (image, eye) in images(&mut views).into_iter().zip([rendered, rendered, rendered.other()]) {
            let index = eye.index();
            let sense = projections[index].sense;
            let place = (places.head + places.eyes[index]) / units;
            image.pose.position = place.as_vec3().to_array();
            image.view = self.view[index];
            if pair.poses[index].orientation != given.poses[index].orientation {
                let to = pair.poses[index].orientation.as_dquat().normalize();
                image.view = turned(&image.view, eyes[index].orientation, to, sense);
            }
            image.projection = self.projection[index];
            // The depth rows stay as they are. The edges are those of the image.
            for (row, values) in image.projection_xy(&clip).into_iter().enumerate() {
                image.projection[row] = values.x as f32;
                image.projection[4 + row] = values.y as f32;
                image.projection[8 + row] = (values.z * sense) as f32;
            }
        }
        Ok(views)
    }

    /// Reads both eyes' matrices.
    fn contents(&self, clip: &Clip) -> Result<([Projection; 2], [EyeView; 2]), Failure> {
        let contents = |eye: Eye| {
            let projection = Projection::new(&self.projection[eye.index()], clip, eye)?;
            Ok::<_, Failure>((projection, eye_view(&self.view[eye.index()], projection.sense, eye)?))
        };
        let [(a, left), (b, right)] = [contents(Eye::Left)?, contents(Eye::Right)?];
        Ok(([a, b], [left, right]))
    }
}
