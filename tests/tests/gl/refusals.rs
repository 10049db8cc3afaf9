//! Eyes that cannot be synthesized are both rendered, with the reason in one sentence.

use glam::Quat;
use yoro::eyes::{DepthRange, Eye, EyePair, Frustum, Pose};
use yoro_assets::ShadingStyle;
use yoro_context::Headless;
use yoro_render::stereo::{Method, StereoFrame, StereoOptions, StereoSession};
use yoro_render::{PreparedScene, RenderSettings};
use yoro_test_support::laws::backends;
use yoro_tests::scene;

#[test]
fn canted_eyes_are_rendered_but_not_synthesized() {
    let headless = Headless::open(backends()[0]).unwrap();
    let gl = headless.gl();
    let (settings, options) = (RenderSettings::default(), StereoOptions::default());
    let scene = scene::every_material(ShadingStyle::Realistic);
    let mut scene = PreparedScene::new(gl, scene, &settings).unwrap();
    let frustum = Frustum::symmetric(1.2, 1.0);
    let mut pair = EyePair::parallel(Pose::IDENTITY, frustum, 0.063, DepthRange::PAPER, [32, 32], Eye::Right);
    for (eye, side) in pair.poses.iter_mut().zip([1.0, -1.0]) {
        eye.orientation *= Quat::from_rotation_y(side * 5f32.to_radians());
    }
    let mut frame = StereoFrame::new(gl, [32, 32]).unwrap();
    let mut render = |method: Method| {
        let mut session = StereoSession::new(gl, method.into(), &settings, &options).unwrap();
        let targets = frame.fit([32, 32]).unwrap();
        let report = session.frame(&mut scene, &pair.into(), targets, None).unwrap();
        (report.fallback, Eye::BOTH.map(|eye| frame.rgba(eye)))
    };
    let [both, _] = [Method::Conventional, Method::Instanced].map(|method| {
        let (fallback, eyes) = render(method);
        assert_eq!(fallback, None);
        eyes
    });
    for method in [Method::Synthesized, Method::Hybrid, Method::ShadingReprojection, Method::Mono] {
        let (fallback, eyes) = render(method);
        let reason = fallback.unwrap().to_string();
        assert!(reason.starts_with("the eyes are canted by 10.00 degrees"), "{reason}");
        assert!(reason.contains("render both eyes"), "{reason}");
        assert!(eyes == both, "{method:?}");
    }
    assert_eq!(gl.take_errors(), None);
}
