//! Motion vectors of both eyes: those that are synthesized against those of two renders; and what frames compile.

use std::cell::Cell;

use glam::{Quat, Vec3};

use super::tests::{Rig, local, moving_scene, pair, scene, session_of};
use super::*;
use crate::view::{DepthResolve, RenderSettings};
use yoro::eyes::{DepthConvention, Eye, EyePair, Foveation, Gaze, Ndc, Pose};
use yoro_assets::Alpha;
use yoro_context::{Backend, Headless};
use yoro_gl::{Capabilities, Destination, Filter, Format, Observer, ProgramRecipe, RenderTarget};

const SIZE: [u32; 2] = [80, 60];

/// Renders a frame, and returns the vectors of both eyes, at half the size.
fn vectors(
    gl: &Rc<Context>,
    rig: &mut Rig,
    session: &mut StereoSession,
    [now, then]: [&EyePair; 2],
    ndc: Ndc,
) -> [Vec<[f32; 4]>; 2] {
    let formats = [(Format::Rgba32F, Filter::Nearest)];
    let depth = Some(Format::Depth32F);
    let target = || RenderTarget::new(gl, SIZE.map(|n| n + 5), &formats, depth).unwrap();
    let images = [target(), target()];
    let motion = |eye: Eye| MotionTarget {
        to: Destination { origin: [2, 3], size: SIZE, ..Destination::whole(&images[eye.index()]) },
        previous: then.view(eye),
        ndc,
    };
    let report = rig.render_with(session, now, |eye, to| EyeTarget { motion: Some(motion(eye)), ..to });
    assert!(report.has_motion);
    images.each_ref().map(|image| image.read_rgba32f(0, [2, 3], SIZE))
}

/// Pixels by which two vectors differ.
fn off(a: &[f32; 4], b: &[f32; 4]) -> f32 {
    let [x, y] = [0, 1].map(|c| (a[c] - b[c]) * SIZE[c] as f32 / 2.0);
    x.hypot(y)
}

/// Outside holes, vectors made of one eye's are those of two renders: with a moving head, and of what moves itself. Beside
/// silhouettes, a pixel may show the other surface.
#[test]
fn vectors_of_both_eyes_are_those_of_two_renders() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    for (dominant, convention, ndc, holes) in [
        (Eye::Left, DepthConvention::Standard, Ndc::MinusOneToOne, HoleMethod::Filled),
        (Eye::Right, DepthConvention::Reversed, Ndc::ZeroToOne, HoleMethod::Filled),
        (Eye::Right, DepthConvention::Reversed, Ndc::ZeroToOne, HoleMethod::Rendered),
    ] {
        let settings = local();
        let options = StereoOptions { motion_vectors: true, holes, ..StereoOptions::default() };
        let is_rendered = holes == HoleMethod::Rendered;
        let create = |method| session_of(gl, method, &settings, &options);
        let mut rig = Rig::of(gl, &settings, moving_scene());
        let now = pair(dominant, convention);
        let turn = Quat::from_rotation_y(0.02);
        let then = EyePair {
            poses: now.poses.map(|pose| Pose {
                position: turn * pose.position + Vec3::new(0.01, -0.02, 0.05),
                orientation: turn * pose.orientation,
            }),
            ..now
        };
        let [mut truth, mut one] = [create(Method::Conventional), create(Method::Synthesized)];
        rig.set_time(0.15);
        rig.set_time(0.17);
        let expected = vectors(gl, &mut rig, &mut truth, [&now, &then], ndc);
        let got = vectors(gl, &mut rig, &mut one, [&now, &then], ndc);
        for eye in Eye::BOTH {
            let (got, expected) = (&got[eye.index()], &expected[eye.index()]);
            let moving = expected.iter().filter(|v| v[3] == 1.0).count();
            let far: f32 = expected.iter().map(|v| off(v, &[0.0; 4])).fold(0.0, f32::max);
            assert!(moving > 100 && far > 4.0, "{eye:?}: {moving} pixels move, by up to {far}");
            let least = if is_rendered { [97, 90] } else { [90, 80] };
            for (what, moves, least) in [("still", 0.0, least[0]), ("moving", 1.0, least[1])] {
                let of: Vec<_> = got.iter().zip(expected).filter(|(_, want)| want[3] == moves).collect();
                let near =
                    of.iter().filter(|(got, want)| off(got, want) < 0.05 && (got[2] - want[2]).abs() < 2e-3);
                let near = near.count();
                assert!(
                    near * 100 >= of.len() * least,
                    "{what}, {dominant:?}, {eye:?}: {near} of {}",
                    of.len()
                );
            }
        }
        // Nothing has moved.
        rig.set_time(0.17);
        let still = vectors(gl, &mut rig, &mut one, [&now, &now], ndc);
        let largest = still.iter().flatten().map(|v| off(v, &[0.0; 4])).fold(0.0, f32::max);
        assert!(largest < 1e-3, "{largest}");
        // An eye that moved by itself has another law.
        let mut raised = now;
        raised.frusta.iter_mut().for_each(|f| (f.bottom, f.top) = (f.bottom + 0.1, f.top + 0.1));
        raised.frusta[0].bottom += 0.2;
        raised.frusta[0].top += 0.2;
        let to = |eye: Eye, to| {
            let target = Destination { framebuffer: None, origin: [0, 0], size: SIZE };
            EyeTarget { motion: Some(MotionTarget { to: target, previous: raised.view(eye), ndc }), ..to }
        };
        // Where all depths are known, vectors need none.
        assert!(is_rendered || !rig.render_with(&mut one, &now, to).has_motion);
    }
    assert_eq!(gl.take_errors(), None);
}

/// Takes away what a lesser driver lacks.
type Limit = fn(&mut Capabilities);

/// Counts the programs that are made.
struct Counted(Rc<Cell<usize>>);

impl Observer for Counted {
    fn program_made(&mut self, _: &Rc<ProgramRecipe>) {
        self.0.set(self.0.get() + 1);
    }
}

/// At half the rate, frames compile nothing that can be prepared, and allocate nothing once each kind of frame was shown:
/// with one depth a pixel and with two, by one eye's render and by both.
#[test]
fn frames_of_half_the_rate_compile_and_allocate_nothing() {
    let limits: [(Limit, DepthResolve); 2] = [
        (|capabilities| capabilities.tile_samples = false, DepthResolve::Samples),
        (|capabilities| capabilities.multisample_textures = false, DepthResolve::InColor),
    ];
    for (limit, way) in limits {
        let head = Headless::open_limited(Backend::Egl, limit).unwrap();
        let gl = head.gl();
        let settings = RenderSettings { msaa: 4, ..local() };
        let mut rig = Rig::of(gl, &settings, moving_scene());
        assert_eq!(rig.scene().renderer.depth_resolve, way);
        let eyes = pair(Eye::Right, DepthConvention::Reversed);
        let formats = [(Format::Rgba16F, Filter::Nearest)];
        let vectors = RenderTarget::new(gl, SIZE, &formats, Some(Format::Depth32F)).unwrap();
        let motion = MotionTarget {
            to: Destination::whole(&vectors),
            previous: eyes.view(Eye::Left),
            ndc: Ndc::ZeroToOne,
        };
        for (method, holes) in [
            (Method::Conventional, HoleMethod::Filled),
            (Method::Synthesized, HoleMethod::Filled),
            (Method::Synthesized, HoleMethod::Rendered),
        ] {
            let what = format!("{way:?}, {method:?}, {holes:?}");
            let options = StereoOptions { motion_vectors: true, holes, ..StereoOptions::default() };
            let mut subject = session_of(gl, method, &settings, &options);
            subject.prepare(rig.scene(), false).unwrap();
            let made = Rc::new(Cell::new(0));
            gl.set_observer(Some(Box::new(Counted(made.clone()))));
            let mut held = None;
            for i in 0..6 {
                rig.set_time(0.12 + 0.01 * f64::from(i));
                let report =
                    rig.render_with(&mut subject, &eyes, |_, to| EyeTarget { motion: Some(motion), ..to });
                assert!(report.has_motion, "{what}");
                assert_eq!(made.get(), 0, "{what}, frame {i}");
                let now = (gl.object_count(), gl.texture_bytes());
                assert!(i < 2 || *held.get_or_insert(now) == now, "{what}, frame {i}");
            }
            gl.set_observer(None);
        }
        assert_eq!(gl.take_errors(), None);
    }
}

/// Neither do frames with an inset, around which the wide layer has depth.
#[test]
fn prepared_frames_with_an_inset_compile_nothing() {
    let head = Headless::open(Backend::Egl).unwrap();
    let (gl, settings) = (head.gl(), RenderSettings { msaa: 4, ..local() });
    let mut opaque = scene();
    opaque.model.materials.iter_mut().for_each(|material| material.alpha = Alpha::Opaque);
    let eyes = pair(Eye::Right, DepthConvention::Reversed);
    let foveation = Foveation { radius: 0.2, ..Foveation::MEDIUM };
    let views = eyes.stereo_views(Some(&foveation), Gaze::Axes(eyes.axes())).unwrap();
    // The images have passes of their own, which they keep.
    let mut images = StereoImages::new(gl).unwrap();
    let choices = [Method::Synthesized.into(), Method::Conventional.into(), MethodChoice::Auto];
    for (choice, holes) in choices.into_iter().flat_map(|c| HoleMethod::ALL.map(|holes| (c, holes))) {
        let mut rig = Rig::of(gl, &settings, opaque.clone());
        let options = StereoOptions { holes, ..StereoOptions::default() };
        let mut session = StereoSession::new(gl, choice, &settings, &options).unwrap();
        session.prepare(rig.scene(), true).unwrap();
        let made = Rc::new(Cell::new(0));
        images.fit(&views, true, [None; 2]).unwrap();
        gl.set_observer(Some(Box::new(Counted(made.clone()))));
        for _ in 0..2 {
            rig.frame(&mut session, &views, FrameTargets::Images(&mut images));
        }
        gl.set_observer(None);
        assert_eq!(made.get(), 0, "{choice:?}, {holes:?}");
    }
    assert_eq!(gl.take_errors(), None);
}
