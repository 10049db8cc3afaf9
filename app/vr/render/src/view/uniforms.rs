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

/// Sets the uniforms of `include/ink.glsl`.
pub fn set_view(program: &Program, view: &View) {
    let (c, m) = view.depth.inverse_distance_law();
    program.set("inverse_distance", Vec2::new(c as f32, m as f32)).set("far_depth", view.depth.clear_value());
}

/// Returns rays at distance 1 along the viewing axis, in world axes. Columns: through the lower left corner, from the left
/// edge to the right, and from the bottom edge to the top.
pub fn view_rays(view: &View) -> Mat3 {
    let f = &view.frustum;
    let corner = Vec3::new(f.left, f.bottom, -1.0);
    Mat3::from_quat(view.pose.orientation)
        * Mat3::from_cols(corner, Vec3::X * f.width(), Vec3::Y * f.height())
}
