//! Uniforms shared by several passes.

use glam::{Mat3, Mat4, Vec2, Vec3};

use yoro::eyes::{DepthConvention, View};
use yoro_gl::{DepthTest, Program};

/// Returns the matrix from world axes around the eye to clip space.
pub fn eye_to_clip(view: &View) -> Mat4 {
    view.projection() * Mat4::from_quat(view.pose.orientation.inverse())
}

/// Returns the depth test of a convention.
pub fn depth_test(convention: DepthConvention) -> DepthTest {
    match convention {
        DepthConvention::Standard => DepthTest::Less,
        DepthConvention::Reversed => DepthTest::Greater,
    }
}

/// Returns the sign, 1 or -1, by which depth is multiplied so that nearer surfaces have smaller values.
pub fn nearer(convention: DepthConvention) -> f32 {
    match convention {
        DepthConvention::Standard => 1.0,
        DepthConvention::Reversed => -1.0,
    }
}

/// Sets the uniforms of `include/view.glsl`.
pub fn set_view(program: &Program, view: &View) {
    let f = &view.frustum;
    let axes = |v: Vec3| view.pose.orientation * v;
    let (c, m) = view.depth.inverse_distance_law();
    program
        .set("ray_corner", axes(Vec3::new(f.left, f.bottom, -1.0)))
        .set("ray_width", axes(Vec3::X * f.width()))
        .set("ray_height", axes(Vec3::Y * f.height()))
        .set("inverse_distance", Vec2::new(c as f32, m as f32))
        .set("far_depth", view.depth.clear_value());
}

/// Returns rays at distance 1 along the viewing axis, in world axes. Columns: the ray through the middle of the lower
/// left pixel, the step to the next pixel on the right, and the step to the next one above.
pub fn pixel_rays(view: &View) -> Mat3 {
    let f = &view.frustum;
    let [right, up] = [f.width() / view.size[0] as f32, f.height() / view.size[1] as f32];
    let corner = Vec3::new(f.left + 0.5 * right, f.bottom + 0.5 * up, -1.0);
    Mat3::from_quat(view.pose.orientation) * Mat3::from_cols(corner, Vec3::X * right, Vec3::Y * up)
}
