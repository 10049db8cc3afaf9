//! Properties that all stereo methods must have.

use std::rc::Rc;

use glam::Quat;
use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, Frustum};
use yoro_assets::{Scene, ShadingStyle};
use yoro_gl::Context;
use yoro_render::stereo::{Method, StereoFrame, StereoOptions, StereoSession};
use yoro_render::{GpuScene, PreparedScene, RenderSettings};
use yoro_test_support::laws::on_every_backend;
use yoro_tests::{is_tested, scene};

const SIZE: [u32; 2] = [128, 96];
const IPD: f32 = 0.063;

struct Stage {
    gl: Rc<Context>,
    settings: RenderSettings,
    prepared: PreparedScene,
    frame: StereoFrame,
}

type Eyes = [Vec<u8>; 2];

impl Stage {
    fn new(gl: &Rc<Context>, scene: Scene, msaa: u32) -> Stage {
        let settings = RenderSettings { msaa, shadow_map_size: 512, ..RenderSettings::default() };
        let prepared = PreparedScene::new(gl, scene, &settings).unwrap();
        Stage { gl: gl.clone(), settings, prepared, frame: StereoFrame::new(gl, SIZE).unwrap() }
    }

    fn render(&mut self, method: Method, options: &StereoOptions, pair: &EyePair) -> Eyes {
        let mut session = StereoSession::new(&self.gl, method.into(), &self.settings, options).unwrap();
        let targets = self.frame.fit(pair.size).unwrap();
        session.frame(&mut self.prepared, &(*pair).into(), targets, None).unwrap();
        Eye::BOTH.map(|eye| self.frame.rgba(eye))
    }

    /// Returns both eyes by two renders and by a method, whose second eye must be closer to its render than the same image
    /// is, by this share.
    fn closer_than_mono(
        &mut self,
        method: Method,
        options: &StereoOptions,
        pair: &EyePair,
        share: f64,
    ) -> [Eyes; 2] {
        let [expected, mono, both] =
            [Method::Conventional, Method::Mono, method].map(|method| self.render(method, options, pair));
        let second = pair.dominant.other().index();
        let [ours, same] = [&both, &mono].map(|eyes| mean_difference(&eyes[second], &expected[second]));
        let scene = &self.prepared.scene.name;
        assert!(ours < share * same, "{scene}, {:?}: {ours} against {same}", pair.frusta);
        [expected, both]
    }

    fn pair(&self, dominant: Eye, convention: DepthConvention) -> EyePair {
        let depth = DepthRange { near: 0.1, far: 300.0, convention };
        let frustum = Frustum::symmetric(1.1, SIZE[0] as f32 / SIZE[1] as f32);
        EyePair::parallel(self.prepared.scene.viewpoints[0].pose(), frustum, IPD, depth, SIZE, dominant)
    }
}

/// Returns all scenes with one sample a pixel, and the small one with four.
fn scenes_and_samples() -> impl Iterator<Item = (Scene, u32)> {
    let small = scenes().swap_remove(0);
    scenes().into_iter().map(|scene| (scene, 1)).chain([(small, 4)])
}

/// Returns pairs of parallel and canted eyes, with symmetric and asymmetric frusta, both depth conventions and both
/// dominant eyes. There are fewer for a scene that takes longer.
fn pairs(stage: &Stage) -> Vec<(&'static str, EyePair)> {
    let plain = stage.pair(Eye::Right, DepthConvention::Standard);
    let mut infinite = stage.pair(Eye::Left, DepthConvention::Reversed);
    infinite.depth.far = f32::INFINITY;
    let mut asymmetric = infinite;
    asymmetric.frusta[0] = Frustum::from_fov(-0.8, 0.6, 0.6, -0.55);
    asymmetric.frusta[1] = Frustum::from_fov(-0.6, 0.8, 0.6, -0.55);
    let mut canted = plain;
    for (eye, side) in canted.poses.iter_mut().zip([1.0, -1.0]) {
        eye.orientation *= Quat::from_rotation_y(side * 0.09);
    }
    let odd = EyePair { size: [75, 51], ..plain };
    let mut pairs = vec![("plain", plain), ("asymmetric", asymmetric), ("canted", canted)];
    if is_small(&stage.prepared.scene) {
        pairs.extend([("infinite", infinite), ("odd", odd)]);
    }
    pairs
}

fn is_small(scene: &GpuScene) -> bool {
    scene.triangle_count() < 500
}

/// Returns a small scene with every material, including glass, and a room.
fn scenes() -> Vec<Scene> {
    let mut small = scene::every_material(ShadingStyle::Realistic);
    scene::keep_plain_and_full(&mut small);
    vec![small, yoro_scenes::build("prototype", yoro_scenes::DEFAULT_SEED).unwrap()]
}

fn differences<'a>(a: &'a [u8], b: &'a [u8]) -> impl Iterator<Item = u8> + 'a {
    assert_eq!(a.len(), b.len());
    let difference = |(a, b): (&[u8], &[u8])| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
    a.chunks(4).zip(b.chunks(4)).map(difference)
}

/// Returns the fraction of pixels that differ by at most `tolerance`.
fn within(tolerance: u8, a: &[u8], b: &[u8]) -> f64 {
    let within = differences(a, b).filter(|d| *d <= tolerance).count();
    within as f64 / (a.len() / 4) as f64
}

fn mean_difference(a: &[u8], b: &[u8]) -> f64 {
    differences(a, b).map(f64::from).sum::<f64>() / (a.len() / 4) as f64
}

#[test]
fn single_pass_stereo_equals_two_renders() {
    on_every_backend(|gl| {
        let options = StereoOptions::default();
        for (scene, samples) in scenes_and_samples() {
            let mut stage = Stage::new(gl, scene, samples);
            for (name, pair) in pairs(&stage) {
                let expected = stage.render(Method::Conventional, &options, &pair);
                for method in [Method::Instanced, Method::Multiview] {
                    // Multiview draws one sample a pixel.
                    if method == Method::Multiview && samples > 1 || !is_tested(method, &stage.settings, gl) {
                        continue;
                    }
                    let both = stage.render(method, &options, &pair);
                    for eye in Eye::BOTH {
                        let share = within(1, &both[eye.index()], &expected[eye.index()]);
                        let (scene, method) = (&stage.prepared.scene.name, method.name());
                        assert!(share >= 0.999, "{scene}, {method}, {name}, {eye:?}: {share} equal");
                    }
                }
            }
        }
    });
}

#[test]
fn a_missing_driver_feature_is_one_sentence() {
    on_every_backend(|gl| {
        for method in Method::ALL {
            let settings = RenderSettings::default();
            let made = StereoSession::new(gl, method.into(), &settings, &StereoOptions::default());
            let Err(reason) = settings.supports(method, gl.capabilities()) else {
                made.unwrap();
                continue;
            };
            let sentence = reason.to_string();
            assert!(
                method == Method::Multiview && sentence.contains("GL_OVR_multiview2; use instanced"),
                "{sentence}"
            );
            assert!(made.err().is_some_and(|e| e.to_string() == sentence));
        }
    });
}

#[test]
fn hybrid_is_conventional_where_everything_is_near() {
    on_every_backend(|gl| {
        // The split is beyond the far plane, or beyond all objects.
        for samples in [1, 4] {
            let mut stage = Stage::new(gl, scenes().swap_remove(0), samples);
            for (threshold, pair) in [
                (1e-3, stage.pair(Eye::Left, DepthConvention::Standard)),
                (0.05, stage.pair(Eye::Right, DepthConvention::Reversed)),
            ] {
                let options = StereoOptions { split_disparity: threshold, ..StereoOptions::default() };
                let expected = stage.render(Method::Conventional, &options, &pair);
                assert!(stage.render(Method::Hybrid, &options, &pair) == expected, "threshold {threshold}");
            }
        }
    });
}

#[test]
fn the_far_field_of_hybrid_is_the_same_for_both_eyes() {
    on_every_backend(|gl| {
        let mut opaque = scenes().swap_remove(0);
        opaque.model.parts.retain(|part| part.material < 32);
        let mut stage = Stage::new(gl, opaque, RenderSettings::default().msaa);
        for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
            let pair = stage.pair(Eye::Left, convention);
            let options = StereoOptions { split_disparity: 1e6, ..StereoOptions::default() };
            let [left, right] = stage.render(Method::Hybrid, &options, &pair);
            assert!(left == right, "{convention:?}: everything is far");
            let expected = stage.render(Method::Mono, &options, &pair);
            assert!(within(8, &left, &expected[0]) > 0.5, "and seen from between the eyes");
            assert!(left != expected[0], "not from one of them");
        }
    });
}

#[test]
fn hybrid_with_a_split_is_close_to_conventional() {
    on_every_backend(|gl| {
        for (scene, samples) in scenes_and_samples() {
            let mut stage = Stage::new(gl, scene, samples);
            for (name, pair) in pairs(&stage).into_iter().filter(|(name, _)| *name != "canted") {
                // The small scene's squares and floor lie on both sides of 3 metres, the room on both sides of 7.
                let split = if is_small(&stage.prepared.scene) { 3.0 } else { 7.0 };
                let threshold = pair.focal_length_pixels() * IPD / split;
                let options = StereoOptions { split_disparity: threshold, ..StereoOptions::default() };
                let [expected, both] = stage.closer_than_mono(Method::Hybrid, &options, &pair, 0.7);
                assert!(both != expected, "{}, {name}: nothing was far", stage.prepared.scene.name);
            }
        }
    });
}

#[test]
fn reprojected_shading_is_close_to_two_renders() {
    on_every_backend(|gl| {
        let options = StereoOptions::default();
        for scene in scenes() {
            let mut stage = Stage::new(gl, scene, RenderSettings::default().msaa);
            for (name, pair) in pairs(&stage).into_iter().filter(|(name, _)| *name != "canted") {
                let method = Method::ShadingReprojection;
                let [expected, both] = stage.closer_than_mono(method, &options, &pair, 0.4);
                let dominant = pair.dominant.index();
                let off = mean_difference(&both[dominant], &expected[dominant]);
                // Glass alone is drawn later, over one depth a pixel and after the bloom.
                assert!(off < 0.5, "{name}: the dominant eye is rendered, but differs by {off}");
            }
        }
    });
}
