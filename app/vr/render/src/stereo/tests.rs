//! Tests of private parts: seams, reprojected shading, requested depths, drivers.

use std::cell::RefCell;
use std::rc::Rc;

use glam::{Quat, Vec3};

use super::*;
use crate::PreparedScene;
use crate::fixture::quad;
use crate::view::{DepthCopy, RenderSettings, Seam};
use frame::Frame;
use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, Frustum, Pose, StereoViews};
use yoro_assets::motion::{Carrier, MovingMesh, Node, Track};
use yoro_assets::{Alpha, Material, Model, Motion, PointLight, Scene, ShadingStyle, Sky, Viewpoint};
use yoro_context::{Backend, Headless};
use yoro_gl::{
    Context, Declaration, Destination, Draw, Filter, Format, Image, Observer, Profiling, Program,
    RasterState, RenderTarget, ShaderSource,
};

const SIZE: [u32; 2] = [160, 120];

/// Posts in front of a wall on a floor, under a sky, wide enough to cross the border of every eye; and glass.
pub(super) fn scene() -> Scene {
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

/// The scene with its last quad, which is opaque, in motion.
pub(super) fn moving_scene() -> Scene {
    let mut scene = scene();
    quad(&mut scene.model, 2, Vec3::new(-0.9, -0.3, -1.2), Vec3::X * 0.5, Vec3::Y * 0.6);
    move_last_quad(&mut scene);
    scene
}

/// Settings without effects that reach beyond a pixel: no bloom, one sample.
pub(super) fn local() -> RenderSettings {
    RenderSettings { shadow_map_size: 256, bloom: false, msaa: 1, ..RenderSettings::default() }
}

pub(super) fn pair(dominant: Eye, convention: DepthConvention) -> EyePair {
    let depth = DepthRange { near: 0.2, far: 500.0, convention };
    EyePair::parallel(Pose::IDENTITY, Frustum::symmetric(1.0, 4.0 / 3.0), 0.063, depth, SIZE, dominant)
}

pub(super) struct Rig {
    scene: PreparedScene,
    frame: StereoFrame,
}

impl Rig {
    pub(super) fn new(gl: &Rc<Context>, settings: &RenderSettings) -> Rig {
        Rig::of(gl, settings, scene())
    }

    pub(super) fn of(gl: &Rc<Context>, settings: &RenderSettings, scene: Scene) -> Rig {
        let scene = PreparedScene::new(gl, scene, settings).unwrap();
        Rig { scene, frame: StereoFrame::new(gl, SIZE).unwrap() }
    }

    /// The same scene in a row of lights, of which the nearer ones are weaker.
    pub(super) fn with_lights(gl: &Rc<Context>, settings: &RenderSettings) -> Rig {
        let mut scene = scene();
        scene.lights = (0..12)
            .map(|i| PointLight {
                position: Vec3::new(i as f32 * 0.6 - 3.3, 0.2, -3.0),
                color: Vec3::splat(0.5 + (i as f32 - 5.5).abs()),
                range: 1.0,
            })
            .collect();
        Rig::of(gl, settings, scene)
    }

    pub(super) fn gl(&self) -> Rc<Context> {
        self.scene.renderer.gl.clone()
    }

    pub(super) fn scene(&mut self) -> &mut PreparedScene {
        &mut self.scene
    }

    pub(super) fn frame(
        &mut self,
        session: &mut StereoSession,
        views: &StereoViews,
        targets: FrameTargets,
    ) -> FrameReport {
        session.frame(&mut self.scene, views, targets, None).unwrap()
    }

    pub(super) fn render(&mut self, session: &mut StereoSession, pair: &EyePair) -> [Vec<u8>; 2] {
        self.render_after(session, pair, None)
    }

    /// Renders a frame after one with this load.
    pub(super) fn render_after(
        &mut self,
        session: &mut StereoSession,
        pair: &EyePair,
        previous: Option<&FrameLoad>,
    ) -> [Vec<u8>; 2] {
        let targets = self.frame.fit(pair.size).unwrap();
        session.frame(&mut self.scene, &(*pair).into(), targets, previous).unwrap();
        self.images()
    }

    /// Renders to targets that `change` has changed.
    pub(super) fn render_with<'a>(
        &mut self,
        session: &mut StereoSession,
        pair: &EyePair,
        change: impl Fn(Eye, EyeTarget<'a>) -> EyeTarget<'a>,
    ) -> FrameReport {
        self.frame.resize(pair.size).unwrap();
        let to = self.frame.targets();
        let to = Eye::BOTH.map(|eye| change(eye, to[eye.index()]));
        self.frame(session, &(*pair).into(), FrameTargets::Eyes(to))
    }

    /// Renders by a method without a session.
    fn render_by(&mut self, method: &mut dyn StereoMethod, pair: &EyePair) -> [Vec<u8>; 2] {
        self.frame.resize(pair.size).unwrap();
        let (to, PreparedScene { renderer, scene }) = (self.frame.targets(), &mut self.scene);
        method.prepare(renderer, scene).unwrap();
        let layer = StereoViews::from(*pair).wide;
        method.render(&Frame::new(renderer, scene, &layer, None, &to).unwrap()).unwrap();
        self.images()
    }

    /// Returns both images of the last frame.
    pub(super) fn images(&self) -> [Vec<u8>; 2] {
        Eye::BOTH.map(|eye| self.frame.rgba(eye))
    }

    pub(super) fn set_time(&mut self, seconds: f64) {
        self.scene.set_time(seconds).unwrap();
    }
}

/// Makes a session of a method with options.
pub(super) fn session_of(
    gl: &Rc<Context>,
    method: Method,
    settings: &RenderSettings,
    options: &StereoOptions,
) -> StereoSession {
    StereoSession::new(gl, method.into(), settings, options).unwrap()
}

/// Makes a session of a method with default options.
fn session(gl: &Rc<Context>, method: Method, settings: &RenderSettings) -> StereoSession {
    session_of(gl, method, settings, &StereoOptions::default())
}

/// Returns the share of pixels whose channels all differ by at most 1.
pub(super) fn equal_share(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let equal =
        a.chunks(4).zip(b.chunks(4)).filter(|(a, b)| a.iter().zip(*b).all(|(a, b)| a.abs_diff(*b) <= 1));
    equal.count() as f64 / (a.len() / 4) as f64
}

/// Returns the distances in metres of an eye's depth.
pub(super) fn distances(gl: &Rc<Context>, depth: &RenderTarget, pair: &EyePair) -> Vec<f32> {
    let formats = [(Format::R32F, Filter::Nearest)];
    let copy = RenderTarget::new(gl, pair.size, &formats, None).unwrap();
    let program = Program::new(gl, ShaderSource::Screen("render/depth_copy.frag"), &[]).unwrap();
    copy.overwrite();
    gl.set_raster_state(&RasterState::SCREEN);
    program.bind().texture("depth_map", 0, depth.depth().raw());
    gl.draw_screen();
    copy.read_rgba32f(0, [0, 0], pair.size).iter().map(|texel| pair.depth.distance(texel[0])).collect()
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
        let mut rig = Rig::new(gl, &settings);
        let mut conventional = session(gl, Method::Conventional, &settings);
        for seam in [Seam::ClipDistance, Seam::Discard] {
            if seam == Seam::ClipDistance && !gl.capabilities().clip_distances {
                eprintln!("SKIPPED: {backend:?} has no clip distances");
                continue;
            }
            let mut method = SinglePass::new(Layout::DoubleWide(seam));
            for size in [SIZE, [97, 60]] {
                let pair = EyePair { size, ..pair(Eye::Left, DepthConvention::Reversed) };
                let expected = rig.render(&mut conventional, &pair);
                let both = rig.render_by(&mut method, &pair);
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
fn ipd_0_disoccludes_nothing() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let mut rig = Rig::new(gl, &local());
    let mut method = session(gl, Method::ShadingReprojection, &local());
    let mut pair = pair(Eye::Left, DepthConvention::Standard);
    pair.poses = [Pose::IDENTITY; 2];
    let [left, right] = rig.render(&mut method, &pair);
    // Alpha, luma, is that of rounded colours.
    let differing = left.chunks(4).zip(right.chunks(4)).filter(|(a, b)| a[..3] != b[..3]).count();
    assert_eq!(differing, 0);
}

#[test]
fn mono_shows_each_eye_its_own_part_of_the_view() {
    let head = Headless::open(Backend::Egl).unwrap();
    let (gl, settings) = (head.gl(), local());
    let mut rig = Rig::new(gl, &settings);
    let mut conventional = session(gl, Method::Conventional, &settings);
    let mut mono = session(gl, Method::Mono, &settings);
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

/// Notes what passes declare, and the draw calls of each.
#[derive(Default)]
struct Noted {
    declared: Vec<Declaration>,
    open: Vec<&'static str>,
    drawn: Vec<(&'static str, [u32; 2])>,
}

struct Noting(Rc<RefCell<Noted>>);

impl Observer for Noting {
    fn pass_begins(&mut self, pass: &Declaration) {
        let mut noted = self.0.borrow_mut();
        noted.open.push(pass.name);
        noted.declared.push(pass.clone());
    }

    fn pass_ends(&mut self) {
        self.0.borrow_mut().open.pop();
    }

    fn draw_begins(&mut self, _: &Context, draw: &Draw) {
        let mut noted = self.0.borrow_mut();
        let pass = noted.open.last().copied().unwrap_or_default();
        noted.drawn.push((pass, draw.area));
    }
}

#[test]
fn passes_declare_what_they_read_and_write() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let pair = pair(Eye::Right, DepthConvention::Reversed);
    let note = |method, settings: &RenderSettings, scene| {
        let (mut rig, mut method) = (Rig::of(gl, settings, scene), session(gl, method, settings));
        rig.render(&mut method, &pair);
        let noted = Rc::<RefCell<Noted>>::default();
        gl.set_observer(Some(Box::new(Noting(noted.clone()))));
        rig.render(&mut method, &pair);
        gl.set_observer(None);
        noted.take()
    };
    let mut opaque = scene();
    opaque.model.parts.pop();
    let Noted { declared, open, drawn } = &note(Method::Synthesized, &local(), opaque);
    assert!(open.is_empty() && drawn.iter().all(|(pass, _)| !pass.is_empty()), "{drawn:?}");
    let find = |name: &str| declared.iter().find(|pass| pass.name == name).unwrap();
    let wide = find("surfaces").writes[0].image;
    assert!(wide.size[0] > SIZE[0] && wide.size[1] == SIZE[1], "{wide:?}");
    let march = find("gather march");
    let color = march.reads.iter().find(|read| read.uniform == "color_map").unwrap();
    assert_eq!((color.image.size, march.writes[0].image.size), (wide.size, SIZE));
    assert!(march.writes[0].is_stored && !march.writes[0].is_loaded);
    assert!(drawn.contains(&("gather march", SIZE)), "{drawn:?}");
    // Under glass, too, each eye is stored once, and its depth not at all.
    for settings in [local(), smooth(), RenderSettings { bloom: true, ..smooth() }] {
        let Noted { declared, .. } = note(Method::Synthesized, &settings, scene());
        // Bloom is not computed of the guard band.
        let shining =
            declared.iter().filter(|pass| pass.name == "bloom").map(|pass| pass.reads[0].image.size);
        assert_eq!(shining.collect::<Vec<_>>(), vec![SIZE; settings.bloom.into()]);
        let writes = declared.iter().flat_map(|pass| &pass.writes);
        let stored =
            writes.filter(|write| write.is_stored && write.image.size == SIZE).map(|write| write.image);
        let stored: Vec<Image> = stored.collect();
        assert!(stored.len() == 2 && stored.iter().all(|image| image.format == Format::Rgba8), "{stored:?}");
    }
    // Outlines are found in stored samples. Two renders then store the picture alone, a source its depth in half floats, too.
    for (method, depths) in [(Method::Conventional, 0), (Method::Synthesized, 1)] {
        let outlined = Scene { style: ShadingStyle::Anime, ..scene() };
        let Noted { declared, .. } = note(method, &smooth(), outlined);
        let writes = declared.iter().flat_map(|pass| &pass.writes).filter(|write| write.is_stored);
        let (samples, resolved): (Vec<_>, Vec<_>) =
            writes.map(|write| write.image).partition(|image| image.samples > 1);
        assert!(samples.iter().any(|image| image.format.is_depth()), "{samples:?}");
        assert!(resolved.iter().all(|image| !image.format.is_depth()), "{resolved:?}");
        assert_eq!(resolved.iter().filter(|image| image.format == Format::R16F).count(), depths);
    }
}

/// Settings with several samples in each pixel.
pub(super) fn smooth() -> RenderSettings {
    RenderSettings { msaa: 4, ..local() }
}

/// Counts the passes with a name in a frame. `wanted` says, by [`Eye::index`], whose depth is wanted.
fn count_passes(
    gl: &Rc<Context>,
    rig: &mut Rig,
    session: &mut StereoSession,
    wanted: [bool; 2],
    name: &str,
) -> usize {
    count_passes_of(gl, rig, session, &pair(Eye::Right, DepthConvention::Reversed), wanted, name)
}

/// Like [`count_passes`], for a given pair of eyes.
fn count_passes_of(
    gl: &Rc<Context>,
    rig: &mut Rig,
    session: &mut StereoSession,
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
    rig.frame(session, &(*pair).into(), FrameTargets::Eyes(targets));
    let passes = gl.take_pass_times();
    gl.set_profiling(Profiling::Off);
    assert!(passes.iter().any(|pass| pass.name == "surfaces"));
    passes.iter().filter(|pass| pass.name == name).count()
}

/// Surfaces that the dominant eye sees take its colours, and the others are shaded as in a render of their own.
#[test]
fn reprojected_shading_is_close_to_a_render() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    for settings in [local(), smooth()] {
        let mut rig = Rig::new(gl, &settings);
        let mut conventional = session(gl, Method::Conventional, &settings);
        let mut method = session(gl, Method::ShadingReprojection, &settings);
        for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
            for dominant in Eye::BOTH {
                let pair = pair(dominant, convention);
                let expected = rig.render(&mut conventional, &pair);
                let both = rig.render(&mut method, &pair);
                let [eye, other] = [dominant, dominant.other()].map(Eye::index);
                let rendered = equal_share(&both[eye], &expected[eye]);
                assert!(rendered > 0.97, "{dominant:?}: {rendered} of the rendered eye is equal");
                let share = equal_share(&both[other], &expected[other]);
                assert!(share > 0.88, "{convention:?}, {dominant:?}, {}: {share}", settings.msaa);
                let same = equal_share(&both[eye], &expected[other]);
                assert!(share > same + 0.1, "the same image has {same}");
            }
        }
    }
    assert_eq!(gl.take_errors(), None);
}

/// Asking for depth for a compositor changes no picture, not even glass.
#[test]
fn depth_is_written_where_it_is_wanted() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    for settings in [local(), smooth()] {
        let mut rig = Rig::new(gl, &settings);
        let mut method = session(gl, Method::Synthesized, &settings);
        let [unread, read] = [[false; 2], [true; 2]].map(|wanted| {
            count_passes(gl, &mut rig, &mut method, wanted, "depth copy");
            rig.images()
        });
        assert!(unread == read, "{} samples", settings.msaa);
    }
    assert_eq!(gl.take_errors(), None);
}

/// A copy costs 8 bytes a pixel: eyes are finished in their own targets.
#[test]
fn nothing_is_copied_unless_depth_is_read() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let settings = RenderSettings { bloom: true, ..smooth() };
    for method in [Method::Conventional, Method::Synthesized] {
        let mut rig = Rig::new(gl, &settings);
        let mut method = session(gl, method, &settings);
        assert_eq!(count_passes(gl, &mut rig, &mut method, [false; 2], "copy"), 0);
    }
}

/// Without bloom, the view with its guard band is rendered where the dominant eye is shown. The picture is that of an eye that
/// is copied out of the view, glass included, on every kind of driver.
#[test]
fn an_eye_is_shown_where_it_is_rendered() {
    type Limit = fn(&mut yoro_gl::Capabilities);
    let limits: [Limit; 4] = [
        |_| {},
        |capabilities| capabilities.tile_samples = false,
        |capabilities| (capabilities.tile_samples, capabilities.multisample_textures) = (false, false),
        yoro_gl::Capabilities::limit_to_es_300,
    ];
    for (limit, settings) in limits.into_iter().map(|limit| (limit, smooth())).chain([(limits[0], local())]) {
        let head = Headless::open_limited(Backend::Egl, limit).unwrap();
        let gl = head.gl();
        let mut rig = Rig::new(gl, &settings);
        let mut images = StereoImages::new(gl).unwrap();
        for dominant in Eye::BOTH {
            let pair = pair(dominant, DepthConvention::Reversed);
            let mut method = session(gl, Method::Synthesized, &settings);
            let copied = rig.render(&mut method, &pair);
            gl.set_profiling(Profiling::Finish);
            rig.frame(&mut method, &pair.into(), FrameTargets::Images(&mut images));
            let passes = gl.take_pass_times();
            gl.set_profiling(Profiling::Off);
            assert!(passes.iter().all(|pass| pass.name != "copy"), "{:?}", passes);
            let shown = images.wide();
            assert!(shown.eye(dominant).size()[0] > SIZE[0] && shown.eye(dominant.other()).size() == SIZE);
            for eye in Eye::BOTH {
                let is_same = shown.rgba(eye) == copied[eye.index()];
                assert!(is_same, "{} samples, {dominant:?} dominant, {eye:?}", settings.msaa);
            }
        }
        assert_eq!(gl.take_errors(), None);
    }
}

/// Glass costs a pass over the samples only where it is in view.
#[test]
fn glass_out_of_view_costs_nothing() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let mut opaque = scene();
    opaque.model.parts.pop();
    let mut rigs = [scene(), opaque].map(|scene| Rig::of(gl, &smooth(), scene));
    let options = StereoOptions { policy: None, ..StereoOptions::default() };
    let mut methods = [(); 2].map(|()| session_of(gl, Method::Synthesized, &smooth(), &options));
    let mut free = 0;
    for turn in 0..24 {
        let orientation = Quat::from_rotation_y(turn as f32 * std::f32::consts::TAU / 24.0);
        let still = pair(Eye::Right, DepthConvention::Reversed);
        let pose = Pose { orientation, ..Pose::IDENTITY };
        let pair = EyePair::parallel(pose, still.frusta[0], still.ipd(), still.depth, SIZE, still.dominant);
        let [glass, plain] = [0, 1].map(|i| {
            let (rig, method) = (&mut rigs[i], &mut methods[i]);
            let resolved = count_passes_of(gl, rig, method, &pair, [false; 2], "resolve");
            (rig.images(), resolved)
        });
        if glass.1 == 1 {
            assert!(glass == plain, "turn {turn}");
            free += 1;
        } else {
            assert!(glass.1 == 3, "turn {turn}");
        }
    }
    // The view is 67 degrees wide, the glass 19.
    assert!((16..24).contains(&free), "{free} of 24");
    assert_eq!(gl.take_errors(), None);
}

/// A driver that lacks everything beyond OpenGL ES 3.0, and one that carries depth as phones do, draw the same frame.
#[test]
fn lesser_drivers_draw_the_same_frame() {
    let limits: [fn(&mut yoro_gl::Capabilities); 2] =
        [|capabilities| capabilities.multisample_textures = false, yoro_gl::Capabilities::limit_to_es_300];
    let settings = RenderSettings { bloom: true, ..smooth() };
    let pair = pair(Eye::Right, DepthConvention::Standard);
    let frame = |head: &Headless, method| {
        let gl = head.gl();
        let mut rig = Rig::new(gl, &settings);
        let eyes = rig.render(&mut session(gl, method, &settings), &pair);
        assert_eq!(gl.take_errors(), None);
        eyes
    };
    let methods = [
        Method::Conventional,
        Method::Instanced,
        Method::Hybrid,
        Method::ShadingReprojection,
        Method::Mono,
        Method::Synthesized,
    ];
    let best = Headless::open(Backend::Egl).unwrap();
    let expected = methods.map(|method| frame(&best, method));
    for limit in limits {
        let head = Headless::open_limited(Backend::Egl, limit).unwrap();
        for (method, expected) in methods.into_iter().zip(&expected) {
            let eyes = frame(&head, method);
            for eye in 0..2 {
                let share = equal_share(&eyes[eye], &expected[eye]);
                // At edges, a driver without sample masks takes another sample's depth.
                assert!(share > 0.92, "{method:?}, eye {eye}: {share} of the picture is equal");
            }
        }
    }
}
