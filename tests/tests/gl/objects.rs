//! Checks that frames leak no GL objects.

use std::rc::Rc;

use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, Frustum, Pose};
use yoro_assets::ShadingStyle;
use yoro_context::Headless;
use yoro_gl::Context;
use yoro_render::stereo::{ImBufferSize, Method, Pipeline, StereoFrame, StereoOptions, StereoSession};
use yoro_render::{PreparedScene, RenderSettings};
use yoro_test_support::laws::backends;
use yoro_tests::{is_tested, scene};

/// Returns every way to render a frame, by name.
fn ways(gl: &Context, settings: &RenderSettings) -> Vec<(&'static str, Method, StereoOptions)> {
    let of = StereoOptions::of_pipeline;
    let mut small_imbuffer = of(Pipeline::Paper);
    small_imbuffer.synthesis.paper.imbuffer = ImBufferSize::Divisor(4);
    let default = StereoOptions::default();
    // Squares and floor lie on both sides of 2.5 metres.
    let split = StereoOptions { split_disparity: 0.6, ..default };
    vec![
        ("conventional", Method::Conventional, default),
        ("instanced", Method::Instanced, default),
        ("multiview", Method::Multiview, default),
        ("hybrid", Method::Hybrid, split),
        ("shading reprojection", Method::ShadingReprojection, default),
        ("mono", Method::Mono, default),
        ("gather", Method::Synthesized, of(Pipeline::Gather)),
        ("paper", Method::Synthesized, of(Pipeline::Paper)),
        ("paper 1/4", Method::Synthesized, small_imbuffer),
    ]
    .into_iter()
    .filter(|(_, method, _)| is_tested(*method, settings, gl))
    .collect()
}

/// Makes a scene with few pixels and few programs, since only the number of frames matters here.
fn tiny(gl: &Rc<Context>, settings: &RenderSettings) -> PreparedScene {
    let mut scene = scene::every_material(ShadingStyle::Realistic);
    scene::keep_plain_and_full(&mut scene);
    PreparedScene::new(gl, scene, settings).unwrap()
}

/// Returns settings with one sample a pixel and with several.
fn settings() -> [RenderSettings; 2] {
    [1, 4].map(|msaa| RenderSettings { msaa, shadow_map_size: 64, ..RenderSettings::default() })
}

/// Returns the eyes of a moving head.
fn pair(frame: u32, dominant: Eye) -> EyePair {
    let position = glam::Vec3::new((frame as f32 * 0.1).sin() * 0.3, 0.0, 0.0);
    let head = Pose { position, ..Pose::IDENTITY };
    let depth = DepthRange { near: 0.1, far: 100.0, convention: DepthConvention::Reversed };
    EyePair::parallel(head, Frustum::symmetric(1.2, 1.0), 0.063, depth, [32, 32], dominant)
}

#[test]
fn thirty_frames_hold_as_many_objects_as_ten() {
    for &backend in backends() {
        let headless = Headless::open(backend).unwrap();
        let gl = headless.gl();
        for settings in settings() {
            let mut scene = tiny(gl, &settings);
            for (name, method, options) in ways(gl, &settings) {
                let mut session = StereoSession::new(gl, method.into(), &settings, &options).unwrap();
                let mut frame = StereoFrame::new(gl, [32, 32]).unwrap();
                let mut after_ten = 0;
                for i in 0..30 {
                    let views = pair(i, Eye::Right).into();
                    session.frame(&mut scene, &views, frame.fit([32, 32]).unwrap(), None).unwrap();
                    if i == 9 {
                        after_ten = gl.object_count();
                    }
                }
                let name = format!("{backend:?}, {name}, {} samples", settings.msaa);
                assert_eq!(gl.take_errors(), None, "{name}");
                assert_eq!(gl.object_count(), after_ten, "{name}");
            }
        }
        assert_eq!(gl.object_count(), 0, "{backend:?}");
    }
}

#[test]
fn new_sizes_and_eyes_replace_objects() {
    let headless = Headless::open(backends()[0]).unwrap();
    let gl = headless.gl();
    for settings in settings() {
        let mut scene = tiny(gl, &settings);
        for (name, method, options) in ways(gl, &settings) {
            let mut session = StereoSession::new(gl, method.into(), &settings, &options).unwrap();
            let mut frame = StereoFrame::new(gl, [32, 32]).unwrap();
            let mut counts = Vec::new();
            for round in 0..3 {
                for (size, dominant) in [([32, 32], Eye::Left), ([50, 20], Eye::Right), ([17, 64], Eye::Left)]
                {
                    for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
                        let mut pair = EyePair { size, ..pair(round, dominant) };
                        pair.depth.convention = convention;
                        pair.frusta = [Frustum::symmetric(1.2, size[0] as f32 / size[1] as f32); 2];
                        session.frame(&mut scene, &pair.into(), frame.fit(size).unwrap(), None).unwrap();
                    }
                }
                counts.push(gl.object_count());
            }
            assert_eq!(gl.take_errors(), None, "{name}");
            assert!(counts.iter().all(|count| *count == counts[0]), "{name}: {counts:?}");
        }
    }
}
