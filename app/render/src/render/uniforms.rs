//! Uniforms that several passes share.

use glam::{Mat3, Mat4, Vec2, Vec3};

use yoro::eyes::{DepthConvention, View};
use yoro_gl::{DepthTest, Program};

/// World axes around the eye to clip space.
pub fn eye_to_clip(view: &View) -> Mat4 {
    view.projection() * Mat4::from_quat(view.pose.orientation.inverse())
}

/// The depth test of a convention.
pub fn depth_test(convention: DepthConvention) -> DepthTest {
    match convention {
        DepthConvention::Standard => DepthTest::Less,
        DepthConvention::Reversed => DepthTest::Greater,
    }
}

/// Times a depth: smaller is nearer.
pub fn nearer(convention: DepthConvention) -> f32 {
    match convention {
        DepthConvention::Standard => 1.0,
        DepthConvention::Reversed => -1.0,
    }
}

/// Sets what `include/view.glsl` needs.
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

/// Rays at distance 1 along the viewing axis, along the world's axes: through the middle of the lower left pixel, and what
/// the next pixel to the right and the next one above add.
pub fn pixel_rays(view: &View) -> Mat3 {
    let f = &view.frustum;
    let [right, up] = [f.width() / view.size[0] as f32, f.height() / view.size[1] as f32];
    let corner = Vec3::new(f.left + 0.5 * right, f.bottom + 0.5 * up, -1.0);
    Mat3::from_quat(view.pose.orientation) * Mat3::from_cols(corner, Vec3::X * right, Vec3::Y * up)
}
