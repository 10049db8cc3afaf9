//! Where earlier renders of the synthesized eye show the surfaces of the current frame.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3, Mat4};

use crate::eyes::View;

/// The relation of the synthesized eye to a history: a rendered image of that eye, in strips of equally many rows that
/// may come from different frames. These are the inputs of `include/history.glsl` of `yoro-shaders`, with the layout of
/// a std140 block.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Strips {
    /// The matrices from a target pixel and its depth to a pixel of each strip's image and its depth. Zero for empty
    /// strips.
    pub to_history: [Mat4; Strips::MAX],
    /// Number of strips, at least 1.
    pub history_strips: i32,
    _padding: [i32; 3],
}

impl Strips {
    /// The largest number of strips.
    pub const MAX: usize = 8;
    /// An empty history.
    pub const NONE: Strips =
        Strips { to_history: [Mat4::ZERO; Strips::MAX], history_strips: 1, _padding: [0; 3] };

    /// Returns the relation of a target to the strips of a history, in the order of their rows, from row 0 on. Each
    /// strip is given by the view of the whole image that it was rendered with; `None` for an empty strip. All strips
    /// but the last have the same number of rows: the image's rows divided by the number of strips, rounded up. Views
    /// have the target's depth planes and encoding. Strips after the first [`Strips::MAX`] are ignored.
    pub fn new(target: &View, strips: &[Option<View>]) -> Strips {
        let mut relation =
            Strips { history_strips: strips.len().clamp(1, Strips::MAX) as i32, ..Strips::NONE };
        let from_target = window(target).inverse();
        for (i, view) in strips.iter().enumerate().take(Strips::MAX) {
            let Some(view) = view else { continue };
            // Subtract the positions first: their difference is small even where positions are large.
            let moved = (target.pose.position.as_dvec3() - view.pose.position.as_dvec3()).extend(0.0);
            let turn = |v: &View| DMat4::from_quat(v.pose.orientation.as_dquat().normalize());
            let mut between = turn(view).transpose() * turn(target);
            between.w_axis += turn(view).transpose() * moved;
            let to = window(view) * between * from_target;
            relation.to_history[i] = to.as_mat4();
        }
        relation
    }

    /// Returns the same relation for images whose rows are counted from the other end, with these heights in pixels,
    /// for graphics interfaces with row 0 at the top. The order of the strips does not change.
    #[doc(hidden)]
    pub fn rows_turned(&self, target_height: u32, history_height: u32) -> Strips {
        let turn = |height: u32| {
            DMat4::from_translation(DVec3::new(0.0, f64::from(height), 0.0))
                * DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0))
        };
        let turned =
            |matrix: Mat4| (turn(history_height) * matrix.as_dmat4() * turn(target_height)).as_mat4();
        Strips { to_history: self.to_history.map(turned), ..*self }
    }

    /// Sets those of its uniforms that a program has. The program must be current.
    #[cfg(feature = "gl")]
    pub fn set(&self, program: &yoro_gl::Program) {
        program.set("to_history", &self.to_history[..]).set("history_strips", self.history_strips);
    }
}

/// Returns the matrix from a view's local space to its pixels, with rows from the bottom, and stored depth. The
/// result's w is the distance.
fn window(view: &View) -> DMat4 {
    let [width, height] = view.size.map(f64::from);
    let half = DVec3::new(0.5 * width, 0.5 * height, 0.5);
    DMat4::from_translation(half) * DMat4::from_scale(half) * view.projection().as_dmat4()
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};

    use super::*;
    use crate::eyes::{DepthConvention, DepthRange, Frustum, Pose};

    #[test]
    fn strips_show_what_the_matrices_of_their_views_project() {
        for (convention, far) in
            [(DepthConvention::Standard, 1000.0), (DepthConvention::Reversed, f32::INFINITY)]
        {
            let view = |position: Vec3, orientation: Quat, size| View {
                pose: Pose { position, orientation },
                frustum: Frustum { left: -0.9, right: 0.7, bottom: -0.6, top: 0.65 },
                depth: DepthRange { near: 0.2, far, convention },
                size,
            };
            let turn = Quat::from_euler(glam::EulerRot::YXZ, 0.1, -0.05, 0.02);
            let target = view(Vec3::new(3.0, 1.6, -80.0), Quat::from_rotation_y(0.3), [640, 480]);
            let former = view(Vec3::new(3.05, 1.58, -80.02), Quat::from_rotation_y(0.3) * turn, [320, 240]);
            let strips = Strips::new(&target, &[None, Some(former)]);
            assert_eq!((strips.history_strips, strips.to_history[0]), (2, Mat4::ZERO));
            for z in [0.4f32, 1.5, 30.0] {
                let local = Vec3::new(0.2 * z, -0.1 * z, -z);
                let world =
                    target.pose.position.as_dvec3() + (target.pose.orientation.as_dquat() * local.as_dvec3());
                let seen = |view: &View| {
                    let own =
                        view.pose.orientation.as_dquat().inverse() * (world - view.pose.position.as_dvec3());
                    let f = view.frustum;
                    let at = |tangent: f64, low: f32, wide: f32, pixels: u32| {
                        (tangent - f64::from(low)) / f64::from(wide) * f64::from(pixels)
                    };
                    let (c, m) = view.depth.inverse_distance_law();
                    DVec3::new(
                        at(-own.x / own.z, f.left, f.width(), view.size[0]),
                        at(-own.y / own.z, f.bottom, f.height(), view.size[1]),
                        (-1.0 / own.z - c) / m,
                    )
                };
                let (here, there) = (seen(&target).as_vec3(), seen(&former));
                let to = strips.to_history[1].project_point3(here).as_dvec3();
                assert!(
                    (to - there).truncate().length() < 2e-3 && (to.z - there.z).abs() < 1e-6,
                    "{to}: {there}"
                );
                let turned = strips.rows_turned(480, 240);
                assert_eq!((turned.history_strips, turned.to_history[0]), (2, Mat4::ZERO));
                let turn = |at: Vec3, height: f32| Vec3::new(at.x, height - at.y, at.z);
                let there = there.as_vec3();
                let to = turn(turned.to_history[1].project_point3(turn(here, 480.0)), 240.0);
                assert!((to - there).length() < 2e-3, "{to}: {there}");
            }
        }
    }
}
