//! Tests of private parts: seams, the mask of disocclusions, requested depths, guard bands.

use std::rc::Rc;

use glam::{Quat, Vec3};

use super::near_fraction::{DepthMap, NearFraction};
use super::*;
use crate::fixture::quad;
use crate::render::{
    Columns, DepthCopy, GpuScene, KeptSamples, PixelDepth, Renderer, RendererKind, Seam, ViewImages,
    ViewRenderer, ViewRequest,
};
use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, Frustum, GuardBand, Pose, SynthesisViews};
use yoro::synthesis::{self, Edges, Outputs, Source, SynthesisOptions};
use yoro_assets::motion::{Carrier, MovingMesh, Node, Track};
use yoro_assets::{Alpha, Material, Model, Motion, Scene, ShadingStyle, Sky, Viewpoint};
use yoro_context::{Backend, Headless};
use yoro_estimate::{Command, Recorder};
use yoro_gl::{Destination, Filter, Format, Profiling, RenderTarget};

const SIZE: [u32; 2] = [160, 120];

/// Posts in front of a wall on a floor, under a sky, wide enough to cross the border of every eye; and glass.
fn scene() -> Scene {
    let color =
        |rgb: [f32; 3]| Material { diffuse: Vec3::from(rgb), double_sided: true, ..Material::default() };
    let glass = Material { alpha: Alpha::Blend(0.4), ..color([0.2, 0.5, 0.9]) };
    let mut model = Model {
        materials: vec![color([0.6, 0.6, 0.5]), color([0.8, 0.3, 0.2]), color([0.2, 0.7, 0.3]), glass],
        ..Model::default()
    };
    let mut place = |material, center: Vec3, half_across: Vec3, half_up: Vec3| {
        quad(&mut model, material, center - half_across - half_up, half_across * 2.0, half_up * 2.0);
    };
    place(0, Vec3::new(0.0, -1.0, -10.0), Vec3::X * 20.0, Vec3::NEG_Z * 20.0);
    place(1, Vec3::new(0.0, 0.0, -9.0), Vec3::X * 12.0, Vec3::Y);
    for i in 0..9 {
        let center = Vec3::new(i as f32 * 0.5 - 2.0, -0.2, -1.5 - 0.4 * (i % 3) as f32);
        place(2, center, Vec3::new(0.07, 0.0, 0.03), Vec3::Y * 0.8);
    }
    place(3, Vec3::new(0.2, 0.3, -3.0), Vec3::X * 0.5, Vec3::Y * 0.4);
    Scene {
        name: "posts".into(),
        model,
        style: ShadingStyle::Realistic,
        sky: Sky::default(),
        lights: Vec::new(),
        viewpoints: vec![Viewpoint { position: Vec3::ZERO, target: Vec3::NEG_Z }],
        ..Scene::default()
    }
}

/// Moves the last quad of a scene a metre to the right from 0.1 to 0.225 seconds. The motion repeats after 0.4 seconds.
fn move_last_quad(scene: &mut Scene) {
    let end = scene.model.vertices.len();
    let vertices = end - 4..end;
    let rest = scene.model.vertices[vertices.clone()].to_vec();
    let moves = Track {
        times: vec![0.1, 0.225, 0.4],
        values: vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        ..Track::default()
    };
    let nodes = vec![Node { moves: Some(moves), ..Node::default() }];
    let meshes = vec![MovingMesh { vertices, rest, carrier: Carrier::Node(0), morph: None }];
    scene.motion = Motion { loops: vec![0.4], nodes, meshes, ..Motion::default() };
}

/// Settings without effects that reach beyond a pixel: no ambient occlusion, no bloom.
pub(super) fn local() -> RenderSettings {
    RenderSettings { shadow_map_size: 256, ssao: false, bloom: false, ..RenderSettings::default() }
}

pub(super) fn pair(dominant: Eye, convention: DepthConvention) -> EyePair {
    let depth = DepthRange { near: 0.2, far: 500.0, convention };
    EyePair::parallel(Pose::IDENTITY, Frustum::symmetric(1.0, 4.0 / 3.0), 0.063, depth, SIZE, dominant)
}

pub(super) struct Rig {
    scene: GpuScene,
    renderer: Renderer,
    frame: StereoFrame,
}

impl Rig {
    pub(super) fn new(gl: &Rc<Context>, settings: &RenderSettings) -> Rig {
        Rig::of(gl, settings, scene())
    }

    fn of(gl: &Rc<Context>, settings: &RenderSettings, scene: Scene) -> Rig {
        let scene = GpuScene::upload(gl, scene).unwrap();
        let renderer = Renderer::new(gl, settings, &scene).unwrap();
        Rig { scene, renderer, frame: StereoFrame::new(gl, SIZE).unwrap() }
    }

    pub(super) fn render(&mut self, method: &mut dyn StereoMethod, pair: &EyePair) -> [Vec<u8>; 2] {
        method.render(&mut self.renderer, &self.scene, pair, &mut self.frame).unwrap();
        Eye::BOTH.map(|eye| self.frame.eye(eye).read_rgba8(0, [0, 0], pair.size))
    }
}

/// Returns the share of pixels whose channels all differ by at most 1.
fn equal_share(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let equal =
        a.chunks(4).zip(b.chunks(4)).filter(|(a, b)| a.iter().zip(*b).all(|(a, b)| a.abs_diff(*b) <= 1));
    equal.count() as f64 / (a.len() / 4) as f64
}

#[test]
fn every_seam_separates_the_eyes() {
    for backend in [Backend::Egl, Backend::Osmesa] {
        let Ok(head) = Headless::open(backend) else {
            eprintln!("SKIPPED: no {backend:?} here");
            continue;
        };
        let gl = head.gl();
        let settings = RenderSettings { shadow_map_size: 256, ..RenderSettings::default() };
        let options = StereoOptions { anti_aliasing: AntiAliasing::Off, ..StereoOptions::default() };
        let mut rig = Rig::new(gl, &settings);
        let mut conventional =
            Conventional::<DeferredRenderer>::new(&Setup { gl, settings: &settings, options: &options })
                .unwrap();
        for seam in [Seam::ClipDistance, Seam::Discard] {
            if seam == Seam::ClipDistance && !gl.capabilities().clip_distances {
                eprintln!("SKIPPED: {backend:?} has no clip distances");
                continue;
            }
            let mut method = SinglePass::<DeferredPair>::new(
                &Setup { gl, settings: &settings, options: &options },
                Layout::DoubleWide(seam),
            )
            .unwrap();
            for size in [SIZE, [97, 60]] {
                let pair = EyePair { size, ..pair(Eye::Left, DepthConvention::Reversed) };
                let expected = rig.render(&mut conventional, &pair);
                let both = rig.render(&mut method, &pair);
                for eye in Eye::BOTH {
                    let share = equal_share(&expected[eye.index()], &both[eye.index()]);
                    assert!(share >= 0.999, "{backend:?}, {seam:?}, {size:?}, {eye:?}: {share}");
                }
            }
        }
        assert_eq!(gl.take_errors(), None, "{backend:?}");
    }
}

#[test]
fn disocclusions_are_shaded_exactly_and_the_rest_closely() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let options = StereoOptions { anti_aliasing: AntiAliasing::Off, ..StereoOptions::default() };
    let mut rig = Rig::new(gl, &local());
    let mut conventional =
        Conventional::<DeferredRenderer>::new(&Setup { gl, settings: &local(), options: &options }).unwrap();
    let mut method = ShadingReprojection::new(&Setup { gl, settings: &local(), options: &options }).unwrap();
    for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
        for dominant in Eye::BOTH {
            let pair = pair(dominant, convention);
            let expected = rig.render(&mut conventional, &pair);
            let both = rig.render(&mut method, &pair);
            assert_eq!(both[dominant.index()], expected[dominant.index()], "the dominant eye is rendered");
            let second = dominant.other().index();
            let mask = method.disocclusion().read_rgba8(0, [0, 0], SIZE);
            let (mut disoccluded, mut sum) = (0, 0u32);
            for ((m, a), b) in mask.chunks(4).zip(both[second].chunks(4)).zip(expected[second].chunks(4)) {
                let difference = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
                sum += u32::from(difference);
                if m[0] == 255 {
                    disoccluded += 1;
                    assert!(difference <= 1, "{a:?} instead of {b:?}");
                }
            }
            let pixels = SIZE[0] * SIZE[1];
            assert!(disoccluded > pixels / 100 && disoccluded < pixels / 4, "{disoccluded} of {pixels}");
            let mean = f64::from(sum) / f64::from(pixels);
            assert!(mean < 1.0, "{convention:?}, {dominant:?}: mean difference {mean}");
            let share = equal_share(&both[second], &expected[second]);
            assert!(share > 0.9, "{convention:?}, {dominant:?}: {share} equal");
        }
    }
    assert_eq!(gl.take_errors(), None);
}

#[test]
fn ipd_0_disoccludes_nothing() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let options = StereoOptions::default();
    let mut rig = Rig::new(gl, &local());
    let mut method = ShadingReprojection::new(&Setup { gl, settings: &local(), options: &options }).unwrap();
    let mut pair = pair(Eye::Left, DepthConvention::Standard);
    pair.poses = [Pose::IDENTITY; 2];
    let [left, right] = rig.render(&mut method, &pair);
    assert_eq!(left, right);
}

#[test]
fn ambient_occlusion_is_exact_at_rims_of_disocclusions() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let options = StereoOptions { anti_aliasing: AntiAliasing::Off, ..StereoOptions::default() };
    for ssao_half_size in [false, true] {
        let settings = RenderSettings { ssao: true, ssao_half_size, ..local() };
        let mut rig = Rig::new(gl, &settings);
        let mut conventional =
            Conventional::<DeferredRenderer>::new(&Setup { gl, settings: &settings, options: &options })
                .unwrap();
        let mut method =
            ShadingReprojection::new(&Setup { gl, settings: &settings, options: &options }).unwrap();
        let pair = pair(Eye::Right, DepthConvention::Standard);
        let expected = rig.render(&mut conventional, &pair);
        let both = rig.render(&mut method, &pair);
        let mask = method.disocclusion().read_rgba8(0, [0, 0], SIZE);
        for (i, m) in mask.chunks(4).enumerate() {
            let [a, b] = [&both[0], &expected[0]].map(|image| &image[i * 4..i * 4 + 4]);
            let equal = a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= 1);
            assert!(m[0] < 255 || equal, "half size {ssao_half_size}, pixel {i}: {a:?} instead of {b:?}");
        }
    }
}

#[test]
fn mono_shows_each_eye_its_own_part_of_the_view() {
    let head = Headless::open(Backend::Egl).unwrap();
    let (gl, settings) = (head.gl(), local());
    let options = StereoOptions { anti_aliasing: AntiAliasing::Off, ..StereoOptions::default() };
    let mut rig = Rig::new(gl, &settings);
    let mut conventional =
        Conventional::<DeferredRenderer>::new(&Setup { gl, settings: &settings, options: &options }).unwrap();
    let mut mono =
        Mono::<DeferredRenderer>::new(&Setup { gl, settings: &settings, options: &options }).unwrap();
    let plain = pair(Eye::Right, DepthConvention::Standard);
    let [left, right] = rig.render(&mut mono, &plain);
    assert!(left == right, "the same image where the frusta are the same");
    // The right eye's frustum lies 32 pixels further right and 12 further up.
    let frustum = plain.frusta[0];
    let [x, y] = [32.0 / SIZE[0] as f32 * frustum.width(), 12.0 / SIZE[1] as f32 * frustum.height()];
    let shifted = |x: f32, y: f32| Frustum {
        left: frustum.left + x,
        right: frustum.right + x,
        bottom: frustum.bottom + y,
        top: frustum.top + y,
    };
    for dominant in Eye::BOTH {
        let asymmetric = EyePair { frusta: [shifted(-x / 2.0, 0.0), shifted(x / 2.0, y)], dominant, ..plain };
        let here = asymmetric.poses[dominant.index()];
        let expected = rig.render(&mut conventional, &EyePair { poses: [here; 2], ..asymmetric });
        let both = rig.render(&mut mono, &asymmetric);
        for eye in Eye::BOTH {
            let equal = equal_share(&both[eye.index()], &expected[eye.index()]);
            assert!(equal > 0.99, "{dominant:?} dominant, {eye:?}: {equal}");
        }
    }
}

/// Options with a band that covers surfaces from 20 cm on. The scene of posts needs a quarter of it.
fn auto_band() -> StereoOptions {
    StereoOptions { guard_band: GuardBand::Auto(0.2), ..StereoOptions::default() }
}

#[test]
fn an_automatic_band_gives_the_picture_of_a_whole_one() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    // Ambient occlusion and bloom, which reach far, are on.
    let deferred = RenderSettings { shadow_map_size: 256, ..RenderSettings::default() };
    let forward = RenderSettings { renderer: RendererKind::Forward, ..deferred.clone() };
    for settings in [deferred, forward] {
        let mut rig = Rig::new(gl, &settings);
        for dominant in Eye::BOTH {
            let mut asymmetric = pair(dominant, DepthConvention::Reversed);
            asymmetric.frusta[0].left *= 1.2;
            asymmetric.frusta[1].right *= 1.2;
            for pair in [pair(dominant, DepthConvention::Standard), asymmetric.row_aligned()] {
                let mut method = create(gl, Method::Yoro, &settings, &auto_band()).unwrap();
                // The result of a frame arrives two frames later.
                let [whole, _, part] = [(); 3].map(|()| rig.render(&mut *method, &pair));
                let looked = method.guard_band().unwrap();
                assert!(looked.columns == looked.most && looked.most > 30, "{looked:?}");
                (0..2).for_each(|_| drop(rig.render(&mut *method, &pair)));
                let used = method.guard_band().unwrap();
                assert!(used.columns > 3 && used.columns < 20 && used.undrawn == 0, "{used:?}");
                let [rendered, other] = [dominant, dominant.other()].map(Eye::index);
                assert!(whole[rendered] == part[rendered], "{:?}, {dominant:?}", settings.renderer);
                let share = equal_share(&whole[other], &part[other]);
                assert!(share > 0.999, "{:?}, {dominant:?}: {share}", settings.renderer);
            }
        }
    }
    assert_eq!(gl.take_errors(), None);
}

#[test]
fn an_automatic_band_keeps_up_with_a_moving_head() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let mut rig = Rig::new(gl, &local());
    let whole = StereoOptions { guard_band: GuardBand::Distance(0.2), ..StereoOptions::default() };
    for (dominant, sense) in [(Eye::Left, 1.0), (Eye::Left, -1.0), (Eye::Right, 1.0), (Eye::Right, -1.0)] {
        let [mut whole, mut auto] =
            [whole, auto_band()].map(|options| create(gl, Method::Yoro, &local(), &options).unwrap());
        let mut narrow = 0;
        for frame in 0..20 {
            // 0.4 degrees and 3 mm per frame.
            let by = sense * frame as f32;
            let pose = Pose {
                position: Vec3::new(0.003 * by, 0.0, -0.002 * frame as f32),
                orientation: Quat::from_rotation_y(0.007 * by),
            };
            let still = pair(dominant, DepthConvention::Standard);
            let moved = EyePair::parallel(pose, still.frusta[0], still.ipd(), still.depth, SIZE, dominant);
            let expected = rig.render(&mut *whole, &moved);
            let images = rig.render(&mut *auto, &moved);
            let [rendered, other] = [dominant, dominant.other()].map(Eye::index);
            assert!(images[rendered] == expected[rendered], "{dominant:?}, frame {frame}");
            let share = equal_share(&images[other], &expected[other]);
            assert!(share > 0.999, "{dominant:?}, {sense}, frame {frame}: {share}");
            if let Some(used) = auto.guard_band() {
                assert_eq!(used.undrawn, 0, "{dominant:?}, {sense}, frame {frame}");
                narrow += u32::from(used.columns < used.most);
            }
        }
        assert!(narrow > 12, "{dominant:?}, {sense}: {narrow} frames drew less than the whole band");
    }
    assert_eq!(gl.take_errors(), None);
}

#[test]
fn a_new_surface_at_the_border_is_drawn_two_frames_later() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let mut far = scene();
    far.model.parts.truncate(2);
    let mut near = far.clone();
    // A board at 40 cm that crosses the left border of both eyes.
    let corner = Vec3::new(-0.6, -0.5, -0.4);
    quad(&mut near.model, 2, corner, Vec3::X * 0.5, Vec3::Y);
    for renderer in [RendererKind::Deferred, RendererKind::Forward] {
        let settings = RenderSettings { renderer, ..local() };
        let mut rigs = [far.clone(), near.clone()].map(|scene| Rig::of(gl, &settings, scene));
        let pair = pair(Eye::Right, DepthConvention::Standard);
        let mut method = create(gl, Method::Yoro, &settings, &auto_band()).unwrap();
        for _ in 0..5 {
            rigs[0].render(&mut *method, &pair);
        }
        let narrow = method.guard_band().unwrap();
        assert!(narrow.columns <= 10 && narrow.undrawn == 0, "{narrow:?}");
        let [[filled, _], _, [drawn, _]] = [(); 3].map(|()| rigs[1].render(&mut *method, &pair));
        let used = method.guard_band().unwrap();
        assert!(used.columns <= 10 && used.undrawn > 500, "{renderer:?}: {used:?}");
        (0..2).for_each(|_| drop(rigs[1].render(&mut *method, &pair)));
        let used = method.guard_band().unwrap();
        assert!(used.columns >= 20 && used.undrawn == 0, "{renderer:?}: {used:?}");
        // The fill continues the board to the border.
        let share = equal_share(&filled, &drawn);
        assert!(share > 0.95, "{renderer:?}: {share} of the picture as it should be");
    }
    assert_eq!(gl.take_errors(), None);
}

#[test]
fn what_moves_at_the_border_is_drawn_at_once() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let mut scene = scene();
    scene.model.parts.truncate(2);
    // A board at 40 cm comes in at the left border within an eighth of a second, and stays a while.
    quad(&mut scene.model, 2, Vec3::new(-1.6, -0.5, -0.4), Vec3::X * 0.5, Vec3::Y);
    move_last_quad(&mut scene);
    let mut rig = Rig::of(gl, &local(), scene);
    let pair = pair(Eye::Right, DepthConvention::Standard);
    let whole = StereoOptions { guard_band: GuardBand::Distance(0.2), ..StereoOptions::default() };
    let [mut whole, mut auto] =
        [whole, auto_band()].map(|options| create(gl, Method::Yoro, &local(), &options).unwrap());
    let mut narrow = 0;
    for frame in 0..24 {
        rig.renderer.set_time(&mut rig.scene, f64::from(frame) / 60.0).unwrap();
        let [expected, images] = [&mut whole, &mut auto].map(|method| rig.render(&mut **method, &pair));
        let share = equal_share(&images[0], &expected[0]);
        assert!(share > 0.999 && images[1] == expected[1], "frame {frame}: {share}");
        if let Some(used) = auto.guard_band() {
            assert_eq!(used.undrawn, 0, "frame {frame}");
            narrow += u32::from(used.columns < used.most);
        }
    }
    assert!(narrow > 2, "{narrow} frames drew less than the whole band");
    assert_eq!(gl.take_errors(), None);
}

/// Settings with several samples in each pixel.
fn forward() -> RenderSettings {
    RenderSettings { renderer: RendererKind::Forward, ..local() }
}

/// Counts the passes with a name in a frame. `wanted` says, by [`Eye::index`], whose depth is wanted.
fn count_passes(
    gl: &Rc<Context>,
    rig: &mut Rig,
    method: &mut dyn StereoMethod,
    wanted: [bool; 2],
    name: &str,
) -> usize {
    count_passes_of(gl, rig, method, &pair(Eye::Right, DepthConvention::Reversed), wanted, name)
}

/// Like [`count_passes`], for a given pair of eyes.
fn count_passes_of(
    gl: &Rc<Context>,
    rig: &mut Rig,
    method: &mut dyn StereoMethod,
    pair: &EyePair,
    wanted: [bool; 2],
    name: &str,
) -> usize {
    let copy = DepthCopy::new(gl).unwrap();
    let depth = [(); 2].map(|()| RenderTarget::new(gl, SIZE, &[], Some(Format::Depth32F)).unwrap());
    let mut targets = rig.frame.targets();
    for ((target, depth), _) in targets.iter_mut().zip(&depth).zip(wanted).filter(|(_, wanted)| *wanted) {
        target.depth = Some(DepthTarget { to: Destination::whole(depth), copy: &copy });
    }
    gl.set_profiling(Profiling::Finish);
    method.render_to(&mut rig.renderer, &rig.scene, pair, &targets).unwrap();
    let passes = gl.take_pass_times();
    gl.set_profiling(Profiling::Off);
    assert!(passes.iter().any(|pass| pass.name == "forward"));
    passes.iter().filter(|pass| pass.name == name).count()
}

#[test]
fn the_nearest_depth_is_resolved_only_where_it_is_read() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let mut rig = Rig::new(gl, &forward());
    let plain = StereoOptions { edges: Some(Edges::Multisample), ..StereoOptions::default() };
    assert!(plain.policy.is_some(), "the switch to two renders reads the samples");
    let near = StereoOptions { near_field: Some(1.6), ..plain };
    let of = |edges| StereoOptions { edges: Some(edges), ..plain };
    let without_policy = StereoOptions { policy: None, ..plain };
    let [nobody, dominant, other, both] = [[false, false], [false, true], [true, false], [true, true]];
    for (options, wanted, expected) in [
        (plain, nobody, 0),
        (without_policy, nobody, 0),
        (plain, dominant, 1),
        (plain, other, 0),
        (near, nobody, 0),
        (near, dominant, 1),
        (near, both, 2),
        (auto_band(), nobody, 1),
        (auto_band(), dominant, 1),
        (of(Edges::Nearest), nobody, 1),
        (of(Edges::Hard), nobody, 1),
        (of(Edges::Sample), nobody, 0),
    ] {
        let mut method = create(gl, Method::Yoro, &forward(), &options).unwrap();
        let taken = count_passes(gl, &mut rig, &mut *method, wanted, "nearest depth");
        assert_eq!(taken, expected, "{wanted:?}, {options:?}");
    }
    // Everything is too near: the third frame is rendered twice, and the switch reads the dominant eye's depth.
    let policy = Some(NearFieldPolicy { distance: 400.0, ..NearFieldPolicy::default() });
    let mut method = create(gl, Method::Yoro, &forward(), &StereoOptions { policy, ..plain }).unwrap();
    assert_eq!(
        [nobody, nobody, nobody, both].map(|wanted| count_passes(
            gl,
            &mut rig,
            &mut *method,
            wanted,
            "nearest depth"
        )),
        [0, 0, 1, 2]
    );
    assert_eq!(gl.take_errors(), None);
}

/// A copy costs 8 bytes a pixel. Glass is drawn over both eyes, and the depth of an eye comes from the intermediate
/// image, so both need the copy.
#[test]
fn an_eye_that_is_complete_once_it_is_synthesized_is_not_copied() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let mut opaque = scene();
    opaque.model.materials[3].alpha = Alpha::Opaque;
    let [nobody, other] = [[false, false], [true, false]];
    let mut pictures = Vec::new();
    for (scene, wanted, copies) in [(scene(), nobody, 2), (opaque.clone(), nobody, 1), (opaque, other, 2)] {
        let mut rig = Rig::of(gl, &forward(), scene);
        let mut method = create(gl, Method::Yoro, &forward(), &StereoOptions::default()).unwrap();
        assert_eq!(count_passes(gl, &mut rig, &mut *method, wanted, "copy"), copies);
        pictures.push(Eye::BOTH.map(|eye| rig.frame.eye(eye).read_rgba8(0, [0, 0], SIZE)));
    }
    assert!(pictures[0] != pictures[1] && pictures[1] == pictures[2]);
    assert_eq!(gl.take_errors(), None);
}

/// While the head looks around, samples are kept and the other eye is copied where glass changes either eye, and hardly
/// anywhere else.
#[test]
fn glass_out_of_view_costs_nothing() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let recorder = Recorder::new(gl);
    let mut opaque = scene();
    opaque.model.parts.pop();
    let mut rigs = [scene(), opaque].map(|scene| Rig::of(gl, &forward(), scene));
    for edges in [Edges::Hard, Edges::Multisample] {
        let options = StereoOptions { edges: Some(edges), policy: None, ..StereoOptions::default() };
        let mut methods = [(); 2].map(|()| create(gl, Method::Yoro, &forward(), &options).unwrap());
        let mut free = 0;
        for turn in 0..24 {
            let orientation = Quat::from_rotation_y(turn as f32 * std::f32::consts::TAU / 24.0);
            let still = pair(Eye::Right, DepthConvention::Reversed);
            let pose = Pose { orientation, ..Pose::IDENTITY };
            let pair =
                EyePair::parallel(pose, still.frusta[0], still.ipd(), still.depth, SIZE, still.dominant);
            let [glass, plain] = [0, 1].map(|i| {
                let (rig, method) = (&mut rigs[i], &mut *methods[i]);
                recorder.start();
                let copies = count_passes_of(gl, rig, method, &pair, [false; 2], "copy");
                let kept =
                    recorder.take().iter().filter(|c| matches!(c, Command::Discard(_, [true, _]))).count();
                let eyes = Eye::BOTH.map(|eye| rig.frame.eye(eye).read_rgba8(0, [0, 0], SIZE));
                (eyes, copies, kept)
            });
            if glass.1 == 1 {
                assert!(glass == plain, "{edges:?}, turn {turn}");
                free += 1;
            } else {
                assert!(glass.1 == 2 && glass.2 != plain.2, "{edges:?}, turn {turn}");
            }
        }
        // The view is 67 degrees wide, the glass 19.
        assert!((16..24).contains(&free), "{edges:?}: {free} of 24");
    }
    assert_eq!(gl.take_errors(), None);
}

/// Drivers copy the first sample's depth between equal formats only.
#[test]
fn the_first_samples_depth_is_not_rounded() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let options = StereoOptions { edges: Some(Edges::Sample), ..StereoOptions::default() };
    let [fine, coarse] = [32, 16].map(|depth_bits| {
        let settings = RenderSettings { depth_bits, ..forward() };
        let mut method = create(gl, Method::Yoro, &settings, &options).unwrap();
        Rig::new(gl, &settings).render(&mut *method, &pair(Eye::Left, DepthConvention::Reversed))
    });
    assert!(fine == coarse);
    assert_eq!(gl.take_errors(), None);
}

#[test]
fn reading_the_nearest_depth_changes_no_picture() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    for (near_field, edges) in
        [(None, Edges::Multisample), (Some(1.6), Edges::Multisample), (None, Edges::Hard)]
    {
        let options = StereoOptions { near_field, edges: Some(edges), ..StereoOptions::default() };
        let mut rig = Rig::new(gl, &forward());
        let mut method = create(gl, Method::Yoro, &forward(), &options).unwrap();
        let [unread, read] = [[false; 2], [true; 2]].map(|wanted| {
            count_passes(gl, &mut rig, &mut *method, wanted, "nearest depth");
            Eye::BOTH.map(|eye| rig.frame.eye(eye).read_rgba8(0, [0, 0], SIZE))
        });
        assert!(unread == read, "{near_field:?}, {edges:?}");
    }
    assert_eq!(gl.take_errors(), None);
}

#[test]
fn first_and_nearest_samples_measure_the_same_near_fraction() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
        let scene = GpuScene::upload(gl, scene()).unwrap();
        let renderer = ForwardRenderer::new(gl, &forward(), &scene).unwrap();
        let mut targets = ForwardRenderer::targets(gl, &forward()).unwrap();
        let view = pair(Eye::Left, convention).view(Eye::Left);
        let samples = KeptSamples { color: false, depth: true };
        let request = ViewRequest { samples, ..ViewRequest::default() };
        renderer.render(&mut targets, &scene, &view, &request).unwrap();
        let samples = DepthMap::Samples(targets.depth_samples().unwrap());
        let mut fraction = NearFraction::new(gl, true).unwrap();
        let [first, nearest] = [samples, DepthMap::Resolved(targets.depth())].map(|depth| {
            // A measurement is available after the next one.
            (0..2).for_each(|_| fraction.measure(depth, [0, 0], SIZE, &view.depth, 3.0));
            fraction.take().unwrap()
        });
        // The posts, and the floor below them.
        assert!(first > 0.2 && first < 0.8, "{first}");
        assert!(first <= nearest && nearest - first < 0.05, "{first} and {nearest}");
    }
    assert_eq!(gl.take_errors(), None);
}

/// Returns both eyes, the rendered one first, as [`Synthesized`] makes them from samples when only some columns are
/// drawn.
fn of_columns(
    gl: &Rc<Context>,
    (renderer, scene): (&ForwardRenderer, &GpuScene),
    pair: &EyePair,
    views: &SynthesisViews,
    columns: Option<Columns>,
) -> [Vec<u8>; 2] {
    let mut targets = ForwardRenderer::targets(gl, &forward()).unwrap();
    let (depth, samples) = (PixelDepth::Unread, KeptSamples { color: true, depth: true });
    let request = ViewRequest { columns, depth, samples, ..ViewRequest::default() };
    renderer.render(&mut targets, scene, &views.source, &request).unwrap();
    let (depth, samples) = (targets.depth_samples().unwrap(), targets.color_samples());
    assert!(samples.is_some(), "nothing is added to their average");
    let options = SynthesisOptions { edges: Edges::Multisample, ..SynthesisOptions::default() };
    let mut synthesis =
        synthesis::create(gl, &options, Outputs { depth: true, ..Outputs::default() }).unwrap();
    let formats = [(Format::Rgba8, Filter::Linear)];
    let other = RenderTarget::new(gl, pair.size, &formats, Some(Format::Depth32F)).unwrap();
    let source = Source { samples, ..Source::new(targets.color().color(0).raw(), depth) };
    synthesis.synthesize(source, &views.warp, &Destination::whole(&other)).unwrap();
    renderer.resume_samples(&targets, scene, &views.source, None, false);
    let rendered = targets.color().read_rgba8(0, views.dominant_crop, pair.size);
    renderer.resume_samples_with(&targets, &other, scene, &views.target, None, false);
    [rendered, other.read_rgba8(0, [0, 0], pair.size)]
}

/// Without bloom, synthesis reads the samples' colours, which are undefined in columns that are not drawn.
#[test]
fn undrawn_samples_are_seen_by_neither_eye() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let mut scene = scene();
    // Glass across the borders of both eyes and their bands, in front of the wall.
    for x in [-4.5, 1.5] {
        quad(&mut scene.model, 3, Vec3::new(x, -0.5, -2.5), Vec3::X * 3.0, Vec3::Y);
    }
    let scene = GpuScene::upload(gl, scene).unwrap();
    let renderer = ForwardRenderer::new(gl, &forward(), &scene).unwrap();
    for dominant in Eye::BOTH {
        for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
            let pair = pair(dominant, convention);
            let views = pair.synthesis_views(GuardBand::Distance(0.2)).unwrap();
            let of = |columns| of_columns(gl, (&renderer, &scene), &pair, &views, columns);
            let whole = of(None);
            // The number of columns by which the nearest post may move in from the side, plus one for a soft edge.
            let seen = (pair.focal_length_pixels() * pair.ipd() / 1.4).ceil() as u32 + 1;
            assert!(2 * seen < views.guard_columns);
            for (band, expected) in [(2 * seen, 0), (0, seen)] {
                let left_out = views.guard_columns - band;
                let [width, source_width] = [SIZE[0], views.source.size[0]];
                let is_left = views.warp.target_eye == Eye::Left;
                let drawn = if is_left { [left_out, source_width] } else { [0, source_width - left_out] };
                let part = of(Some(Columns { drawn, always: drawn }));
                assert!(whole[0] == part[0], "{dominant:?}, {convention:?}, {band}: the rendered eye");
                let from_border = |x: u32| if is_left { x } else { width - 1 - x };
                let differing = whole[1].chunks(4).zip(part[1].chunks(4)).enumerate();
                let differing = differing.filter(|(_, (a, b))| a != b);
                let beyond = differing.map(|(i, _)| from_border(i as u32 % width) + 1).max().unwrap_or(0);
                assert!(
                    beyond <= expected && (beyond == 0) == (expected == 0),
                    "{dominant:?}, {convention:?}, {band}: {beyond} columns of the other eye differ"
                );
            }
        }
    }
    assert_eq!(gl.take_errors(), None);
}

/// Returns the sums of squared errors of two images, over the pixels in which they differ.
fn errors_where_different([a, b]: [&[u8]; 2], truth: &[u8]) -> [u64; 2] {
    let pixels = || a.chunks(4).zip(b.chunks(4)).zip(truth.chunks(4)).filter(|((a, b), _)| a != b);
    let error =
        |a: &[u8], b: &[u8]| a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b)).pow(2)).sum::<u64>();
    [
        pixels().map(|((a, _), truth)| error(a, truth)).sum(),
        pixels().map(|((_, b), truth)| error(b, truth)).sum(),
    ]
}

#[test]
fn a_history_shows_what_is_uncovered_and_is_renewed_by_need() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let forward = RenderSettings { renderer: RendererKind::Forward, ..local() };
    for (settings, dominant) in [(local(), Eye::Right), (local(), Eye::Left), (forward, Eye::Right)] {
        let what = format!("{:?}, {dominant:?} dominant", settings.renderer);
        let mut rig = Rig::new(gl, &settings);
        let make = |method, history| {
            let plain =
                StereoOptions { policy: None, anti_aliasing: AntiAliasing::Off, ..Default::default() };
            create(gl, method, &settings, &StereoOptions { history, ..plain }).unwrap()
        };
        let mut without = make(Method::Yoro, History::Off);
        assert_eq!(without.history(), None);
        let mut truth = make(Method::Conventional, History::Off);
        let other = dominant.other().index();
        for history in [History::Full, History::Half] {
            let mut method = make(Method::Yoro, history);
            // A nearly still head; then another head far away; then eyes further apart.
            for (place, ipd) in [(0.0, 0.063), (0.8, 0.063), (0.8, 0.07)] {
                let mut strips = Vec::new();
                for frame in 0..16 {
                    let position = Vec3::new(0.0005 * frame as f32, 0.0, place);
                    let pose = Pose { position, orientation: Quat::from_rotation_y(0.001 * frame as f32) };
                    let still = pair(dominant, DepthConvention::Standard);
                    let pair = EyePair::parallel(pose, still.frusta[0], ipd, still.depth, SIZE, dominant);
                    let images = rig.render(&mut *method, &pair);
                    strips.push(method.history().unwrap().rendered);
                    if frame == 15 {
                        let [plain, truth] =
                            [&mut without, &mut truth].map(|method| rig.render(&mut **method, &pair));
                        assert!(images[1 - other] == plain[1 - other], "{what}: the rendered eye stays");
                        let eyes = [&images[other][..], &plain[other][..]];
                        let [with, plain] = errors_where_different(eyes, &truth[other]);
                        let share = with as f64 / plain as f64;
                        // At half the resolution, posts of seven pixels in front of a plain wall are no better than
                        // filled ones.
                        let is_better = share < 0.8 || history == History::Half;
                        assert!(is_better, "{what}: {share} of the error is left");
                    }
                }
                // Measured two frames later; then each strip once, and none until more is uncovered.
                let count = strips.iter().filter(|pixels| **pixels > 0).count();
                assert_eq!(count, 8, "{what}, {history:?}: {strips:?}");
            }
            let used = method.history().unwrap();
            assert!(
                used.uncovered > 50 && 3 * used.unknown < used.uncovered,
                "{what}, {history:?}: {used:?}"
            );
        }
    }
    assert_eq!(gl.take_errors(), None);
}

/// Returns the indices of those of eight strips in which two images of an eye differ.
fn strips_that_differ(a: &[u8], b: &[u8]) -> Vec<usize> {
    let strip = a.len() / 8;
    let strips = a.chunks(strip).zip(b.chunks(strip)).enumerate();
    strips.filter(|(_, (a, b))| a != b).map(|(i, _)| i).collect()
}

/// A pane of glass moves in a corner. Nothing moves in front of the posts, so an old strip would show.
#[test]
fn strips_of_a_moving_scene_are_given_up_when_it_has_moved_eight_times() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let mut scene = scene();
    quad(&mut scene.model, 3, Vec3::new(-0.5, 0.9, -3.0), Vec3::X * 0.1, Vec3::Y * 0.1);
    move_last_quad(&mut scene);
    let mut rig = Rig::of(gl, &local(), scene);
    let pair = pair(Eye::Right, DepthConvention::Standard);
    let [mut without, mut method] = [History::Off, History::Full].map(|history| {
        let plain = StereoOptions { policy: None, anti_aliasing: AntiAliasing::Off, ..Default::default() };
        create(gl, Method::Yoro, &local(), &StereoOptions { history, ..plain }).unwrap()
    });
    let mut frame = 0;
    let mut moved = |rig: &mut Rig, times| {
        for _ in 0..times {
            frame += 1;
            rig.renderer.set_time(&mut rig.scene, f64::from(frame) / 72.0).unwrap();
        }
    };
    let mut shown = |rig: &mut Rig, method: &mut dyn StereoMethod| {
        let (plain, with) = (rig.render(&mut *without, &pair), rig.render(method, &pair));
        strips_that_differ(&plain[0], &with[0])
    };
    let mut all = Vec::new();
    for _ in 0..20 {
        moved(&mut rig, 1);
        all = shown(&mut rig, &mut *method);
        let used = method.history().unwrap();
        assert!(used.uncovered == 0 || used.rendered > 0, "what moves is renewed: {used:?}");
    }
    assert!(all.len() > 3, "all strips show something: {all:?}");
    // The scene stands still.
    let mut rendered = 0;
    for _ in 0..16 {
        assert_eq!(shown(&mut rig, &mut *method), all);
        rendered = method.history().unwrap().rendered;
    }
    assert_eq!(rendered, 0);
    // As if another method had been in use for a while.
    moved(&mut rig, 7);
    assert_eq!(shown(&mut rig, &mut *method), all);
    moved(&mut rig, 7);
    let one = shown(&mut rig, &mut *method);
    assert!(one.iter().all(|strip| *strip < 2), "only what was rendered in these two frames: {one:?}");
    assert_eq!(gl.take_errors(), None);
}

/// Both eyes are rendered while the head looks at the floor. The other eye's last render fills the first synthesized
/// frame, unless it had glass in it.
#[test]
fn the_switch_to_two_renders_fills_the_history() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let mut opaque = scene();
    opaque.model.parts.pop();
    let plain = StereoOptions { policy: None, anti_aliasing: AntiAliasing::Off, ..Default::default() };
    let policy = Some(NearFieldPolicy { distance: 1.3, ..NearFieldPolicy::default() });
    for (settings, scene, fills) in
        [(local(), opaque.clone(), true), (forward(), opaque, true), (local(), scene(), false)]
    {
        let what = settings.renderer;
        let mut rig = Rig::of(gl, &settings, scene);
        let ahead = pair(Eye::Right, DepthConvention::Standard);
        let down = Pose { orientation: Quat::from_rotation_x(-1.5), ..Pose::IDENTITY };
        let down = EyePair::parallel(down, ahead.frusta[0], ahead.ipd(), ahead.depth, SIZE, ahead.dominant);
        let switching = StereoOptions { policy, history: History::Full, ..plain };
        let mut method = create(gl, Method::Yoro, &settings, &switching).unwrap();
        (0..5).for_each(|_| drop(rig.render(&mut *method, &down)));
        assert!(method.is_substituted());
        let mut shown = rig.render(&mut *method, &ahead);
        while method.is_substituted() {
            shown = rig.render(&mut *method, &ahead);
        }
        assert_eq!(
            method.history().unwrap().rendered == 0,
            fills,
            "{what:?}: strips begin anew, or need not"
        );
        let mut without = create(gl, Method::Yoro, &settings, &plain).unwrap();
        let plain_picture = rig.render(&mut *without, &ahead);
        let strips = strips_that_differ(&shown[0], &plain_picture[0]);
        assert_eq!(strips.len() > 3, fills, "{what:?}: strips {strips:?}");
        // The result is the same as with strips rendered from here.
        let by_need = StereoOptions { history: History::Full, ..plain };
        let mut by_need = create(gl, Method::Yoro, &settings, &by_need).unwrap();
        let (mut expected, mut pixels) = (plain_picture.clone(), 0);
        for _ in 0..12 {
            expected = rig.render(&mut *by_need, &ahead);
            pixels += by_need.history().unwrap().rendered;
        }
        assert!(pixels > SIZE[0] * SIZE[1] && expected != plain_picture);
        let share = equal_share(&shown[0], &expected[0]);
        assert_eq!(share > 0.9995, fills, "{what:?}: {share} of the picture");
    }
    assert_eq!(gl.take_errors(), None);
}
