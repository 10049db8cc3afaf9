//! Eyes that cannot be synthesized are refused with one sentence.

use glam::Quat;
use yoro::eyes::{DepthRange, Eye, EyePair, Frustum, Pose};
use yoro_assets::ShadingStyle;
use yoro_context::Headless;
use yoro_render::stereo::{self, Method, StereoFrame, StereoOptions};
use yoro_render::{GpuScene, RenderSettings, Renderer};
use yoro_tests::{backends, scene};

#[test]
fn canted_eyes_are_rendered_but_not_synthesized() {
    let headless = Headless::open(backends()[0]).unwrap();
    let gl = headless.gl();
    let (settings, options) = (RenderSettings::default(), StereoOptions::default());
    let scene = GpuScene::upload(gl, scene::every_material(ShadingStyle::Realistic)).unwrap();
    let mut renderer = Renderer::new(gl, &settings, &scene).unwrap();
    let frustum = Frustum::symmetric(1.2, 1.0);
    let mut pair = EyePair::parallel(Pose::IDENTITY, frustum, 0.063, DepthRange::PAPER, [32, 32], Eye::Right);
    for (eye, side) in pair.poses.iter_mut().zip([1.0, -1.0]) {
        eye.orientation *= Quat::from_rotation_y(side * 5f32.to_radians());
    }
    let mut frame = StereoFrame::new(gl, [32, 32]).unwrap();
    let mut render = |method| {
        let mut method = stereo::create(gl, method, &settings, &options).unwrap();
        method.render(&mut renderer, &scene, &pair, &mut frame)
    };
    for method in [Method::Conventional, Method::Instanced, Method::Mono] {
        render(method).unwrap();
    }
    for method in [Method::Synthesized, Method::Hybrid, Method::ShadingReprojection] {
        let refusal = render(method).unwrap_err().to_string();
        assert!(refusal.starts_with("the eyes are canted by 10.00 degrees"), "{refusal}");
        assert!(refusal.contains("render both eyes"), "{refusal}");
    }
    assert_eq!(gl.take_errors(), None);
}
