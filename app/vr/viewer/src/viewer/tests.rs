//! Tests of the viewer with a real GL context.

use std::path::PathBuf;
use std::time::Duration;

use glam::{Quat, Vec3};

use super::*;
use crate::cardboard::{Cardboard, HeldHead};
use crate::event::{Action, Event};
use crate::frame::{FrameTiming, PresentReport};
use yoro::eyes::FoveationLevel;
use yoro_context::{Backend, Headless};
use yoro_gl::{Destination, Filter, Format, RenderTarget};
use yoro_lenses::{MotionSample, Rotation, Screen};
use yoro_render::stereo::{Method, MethodChoice};
use yoro_settings::telemetry::{DeviceState, Line};

const WINDOW: [u32; 2] = [320, 180];
const PERIOD_NS: i64 = 16_666_667;

fn screen() -> Screen {
    // 110 x 62 mm.
    Screen { size: WINDOW, dpi: [74.0; 2], rotation: Rotation::LandscapeLeft }
}

fn window(gl: &Rc<Context>) -> RenderTarget {
    RenderTarget::new(gl, WINDOW, &[(Format::Rgba8, Filter::Nearest)], None).unwrap()
}

fn settings(pairs: &[&str]) -> Settings {
    let cheap = ["scene=prototype", "viewer=v1", "shadow-map=0", "msaa=1", "bloom=false", "render-scale=0.5"];
    Settings::measured().changed(None, cheap.iter().chain(pairs)).unwrap()
}

/// A display and a clock for a viewer.
struct Run {
    viewer: Cardboard,
    window: RenderTarget,
    now_ns: i64,
}

impl Run {
    fn new(gl: &Rc<Context>, pairs: &[&str]) -> Run {
        let mut viewer = Cardboard::new(settings(pairs), screen(), &[]).unwrap();
        viewer.attach(gl.clone()).unwrap();
        Run { viewer, window: window(gl), now_ns: 0 }
    }

    /// Returns a run whose scene is loaded.
    fn ready(gl: &Rc<Context>, pairs: &[&str]) -> Run {
        let mut run = Run::new(gl, pairs);
        run.load();
        run
    }

    fn frame(&mut self) -> PresentReport {
        self.now_ns += PERIOD_NS;
        let timing = FrameTiming {
            now_ns: self.now_ns,
            expected_display_ns: self.now_ns + PERIOD_NS,
            refresh_hz: 60.0,
        };
        self.viewer.frame(&Destination::whole(&self.window), &timing).unwrap()
    }

    fn load(&mut self) {
        finish_loading(&mut self.viewer);
    }

    fn image(&self) -> Vec<u8> {
        self.window.read_rgba8(0, [0, 0], WINDOW)
    }

    /// Returns the image of the next frame.
    fn next_image(&mut self) -> Vec<u8> {
        self.frame();
        self.image()
    }
}

/// Waits until the scene is loaded, or cannot be.
fn finish_loading(viewer: &mut Cardboard) {
    while viewer.viewer().is_loading() {
        viewer.viewer_mut().poll_scene();
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Waits until the scene is loaded.
#[track_caller]
fn wait(viewer: &mut Cardboard) {
    finish_loading(viewer);
    assert_eq!(viewer.viewer().scene_state(), SceneState::Ready);
}

#[test]
fn a_session_runs_from_loading_to_its_summary() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let mut run = Run::new(gl, &["duration=0.5", "adaptive=true"]);
    assert_eq!(run.frame().scene, SceneState::Loading);
    let loading = run.image();
    assert!(loading.chunks_exact(4).any(|p| p[0] > 200), "the progress bar");
    run.load();
    let (mut over, mut lines) = (0, Vec::new());
    for i in 0..64 {
        let report = run.frame();
        assert_eq!((report.scene, report.late_refreshes), (SceneState::Ready, 0));
        over += report.session_over as u32;
        if report.telemetry_due {
            let device = DeviceState { battery_celsius: Some(31.0), ..DeviceState::default() };
            lines.push((i, run.viewer.viewer_mut().telemetry(run.now_ns, &device)));
        }
    }
    assert_eq!(over, 1);
    assert_ne!(run.image(), loading);
    let [(_, line)] = lines.as_slice() else { panic!("{lines:?}") };
    let read: Line = line.to_string().parse().unwrap();
    assert_eq!(read.to_string(), line.to_string());
    assert_eq!((line.method.as_str(), line.pipeline.as_deref()), ("yoro", Some("gather")));
    assert_eq!((line.scene.as_str(), line.stale, line.current_ma), ("prototype", Some(0), None));
    assert!((line.fps.unwrap() - 60.0).abs() < 0.1, "{line}");
    let summary = run.viewer.viewer().summary(run.now_ns).to_string();
    assert!(summary.contains("frames=60,FPS=60.0"), "{summary}");

    // The context is lost and comes back, and the scene is loaded again.
    let before = run.image();
    run.viewer.detach();
    assert!(matches!(
        run.viewer.render(&FrameTiming { now_ns: 0, expected_display_ns: 0, refresh_hz: 0.0 }),
        Err(ViewerError::NoContext)
    ));
    run.viewer.attach(gl.clone()).unwrap();
    run.load();
    run.viewer.event(Event::ToggleHud).unwrap();
    let differing = run.next_image().iter().zip(&before).filter(|(a, b)| a.abs_diff(**b) > 2).count();
    assert!(differing > 0 && differing < before.len() / 8, "only the HUD is gone: {differing}");
    drop(run);
    assert_eq!((gl.object_count(), gl.take_errors()), (0, None));
}

#[test]
fn events_change_method_ipd_hud_and_viewpoint() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let mut run = Run::ready(gl, &["hud=false", "method=yoro", "ipd=0.063"]);
    let yoro = run.next_image();
    assert_eq!(run.viewer.event(Event::Tap).unwrap(), Action::Method(Method::Conventional.into()));
    assert_eq!(run.viewer.event(Event::Tap).unwrap(), Action::Method(Method::Mono.into()));
    // The renderer keeps what the methods have asked it for.
    let objects = [(); 2].map(|()| {
        for _ in 0..4 {
            run.viewer.event(Event::Tap).unwrap();
            run.frame();
        }
        gl.object_count()
    });
    assert_eq!(run.viewer.viewer().method(), Method::Mono.into());
    assert_eq!(objects[0], objects[1], "switching leaves nothing behind");
    run.viewer.event(Event::Tap).unwrap();
    let Action::Ipd(ipd) = run.viewer.event(Event::IpdUp).unwrap() else { panic!() };
    assert!((ipd.metres() - 0.064).abs() < 1e-6);
    for _ in 0..100 {
        run.viewer.event(Event::IpdUp).unwrap();
    }
    assert_eq!(run.viewer.viewer().ipd(), Ipd::MAX);
    assert_ne!(run.next_image(), yoro);
    assert_eq!(run.viewer.event(Event::LongPress).unwrap(), Action::Menu(true));
    assert_eq!(run.viewer.event(Event::LongPress).unwrap(), Action::Recenter);
    assert_eq!(run.viewer.event(Event::ToggleHud).unwrap(), Action::Hud(true));
    assert!(matches!(run.viewer.event(Event::NextViewpoint).unwrap(), Action::Viewpoint(1)));
    let rotated = Screen { size: [200, 100], rotation: Rotation::LandscapeRight, ..screen() };
    run.viewer.resize(rotated).unwrap();
    run.frame();
    assert_eq!(gl.take_errors(), None);
}

/// Which method is cheaper depends on the machine.
#[test]
fn auto_measures_both_methods_while_nothing_is_allocated_and_says_which_and_why() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let mut run = Run::ready(gl, &["method=auto", "adaptive=true"]);
    run.frame();
    let held = |gl: &Context| (gl.object_count(), gl.texture_bytes());
    let both = held(gl);
    let mut lines = Vec::new();
    let mut seconds = |run: &mut Run, seconds: usize| {
        for _ in 0..60 * seconds {
            if run.frame().telemetry_due {
                let line = run.viewer.viewer_mut().telemetry(run.now_ns, &DeviceState::default());
                lines.push(line.to_string().parse::<Line>().unwrap());
            }
        }
        lines.last().unwrap().clone()
    };
    assert_eq!(seconds(&mut run, 2).auto.as_deref(), Some("measuring"));
    let line = seconds(&mut run, 2);
    let auto = line.auto.unwrap();
    let times: Vec<f32> = auto.trim_end_matches("ms").split('/').map(|ms| ms.parse().unwrap()).collect();
    assert!(times.len() == 2 && times[0] <= times[1], "{auto}");
    assert_eq!(line.pipeline.is_some(), line.method == "yoro");
    assert_eq!(held(gl), both, "both methods are ready from the first frame on");
    let seen = &run.viewer.viewer().caption.text;
    assert!(seen.contains(&format!("auto:{} {auto}\n", line.method)), "{seen}");
    let chosen = run.viewer.viewer().rendering_method();
    assert_eq!((chosen.name(), run.viewer.viewer().method()), (line.method.as_str(), MethodChoice::Auto));
    // Another viewpoint is measured again; a method that is named is not.
    run.viewer.event(Event::NextViewpoint).unwrap();
    assert_eq!(seconds(&mut run, 2).auto.as_deref(), Some("measuring"));
    assert_eq!(run.viewer.event(Event::Tap).unwrap(), Action::Method(Method::Synthesized.into()));
    assert_eq!(seconds(&mut run, 2).auto, None);
    let taps = [(); 3].map(|()| run.viewer.event(Event::Tap).unwrap());
    assert_eq!(taps[2], Action::Method(MethodChoice::Auto));
}

/// Prints what auto measures and chooses on this machine, and the memory of the targets (docs/settings.md).
#[test]
#[ignore = "takes minutes, and prints what is the machine's matter"]
fn choices_on_this_machine() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let screen = Screen { size: [640, 360], dpi: [148.0; 2], rotation: Rotation::LandscapeLeft };
    let window = RenderTarget::new(gl, screen.size, &[(Format::Rgba8, Filter::Nearest)], None).unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("wall.obj"), "v -2 -2 -3\nv 2 -2 -3\nv 2 2 -3\nv -2 2 -3\nf 1 2 3 4\n")
        .unwrap();
    let bare = ["msaa=1", "shadow-map=0", "bloom=false"];
    for (scene, more) in [
        ("wall", &bare[..]),
        ("prototype", &bare),
        ("street", &bare),
        ("prototype", &[]),
        ("street", &[]),
        ("atrium", &[]),
    ] {
        let scene = format!("scene={scene}");
        let pairs: Vec<&str> =
            [scene.as_str(), "viewer=v1"].into_iter().chain(more.iter().copied()).collect();
        let mut megabytes = Vec::new();
        for method in ["method=conventional", "method=yoro", "method=auto"] {
            let settings = Settings::resolve(None, pairs.iter().copied().chain([method])).unwrap();
            let before = gl.texture_bytes();
            let mut viewer = Cardboard::new(settings, screen, &[folder.path().into()]).unwrap();
            viewer.attach(gl.clone()).unwrap();
            wait(&mut viewer);
            let mut now_ns = 0;
            let mut frame = |viewer: &mut Cardboard| {
                now_ns += 200_000_000;
                let timing = FrameTiming { now_ns, expected_display_ns: now_ns, refresh_hz: 60.0 };
                viewer.frame(&Destination::whole(&window), &timing).unwrap();
            };
            frame(&mut viewer);
            megabytes.push((gl.texture_bytes() - before) as f64 / 1e6);
            while viewer.viewer().auto().is_some_and(|auto| auto.is_measuring()) {
                frame(&mut viewer);
            }
            let shown = viewer.viewer();
            if let Some(auto) = shown.auto() {
                let ([w, h], name) = (viewer.eye_size(), shown.rendering_method().name());
                println!("{pairs:?} {w}x{h}: auto:{name} {auto}; textures {megabytes:.1?} MB");
            }
        }
    }
}

#[test]
fn sensors_turn_the_picture() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let mut run = Run::ready(headless.gl(), &["hud=false"]);
    let ahead = run.next_image();
    run.viewer.sensor(MotionSample::Accelerometer(Vec3::new(9.81, 0.0, 0.0)), 1);
    assert_eq!(run.next_image(), ahead, "upright is straight ahead");
    for i in 1..=50 {
        run.viewer.sensor(MotionSample::Gyroscope(Vec3::X), i * 10_000_000);
    }
    run.viewer.pause();
    run.viewer.resume();
    run.now_ns = 500_000_000;
    let turned = run.next_image();
    assert_ne!(turned, ahead);
    let angle = run.viewer.tracker().head_from_world(0.0).inverse().to_scaled_axis().y;
    run.viewer.hold_head(Some(HeldHead {
        rendered: Quat::from_rotation_y(angle),
        displayed: Quat::from_rotation_y(angle),
    }));
    let differing = run.next_image().iter().zip(&turned).filter(|(a, b)| a.abs_diff(**b) > 3).count();
    assert!(differing < turned.len() / 100, "the picture is that of the head's angle: {differing}");
}

#[test]
fn a_scene_that_cannot_be_loaded_is_explained_in_view() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("room.obj"), "f 1 2 3\n").unwrap();
    let folders: [PathBuf; 1] = [folder.path().into()];
    let mut viewer = Cardboard::new(settings(&["scene=room"]), screen(), &folders).unwrap();
    viewer.attach(headless.gl().clone()).unwrap();
    let mut run = Run { viewer, window: window(headless.gl()), now_ns: 0 };
    run.load();
    assert_eq!(run.frame().scene, SceneState::Failed);
    assert!(run.viewer.viewer().failure().unwrap().contains("room.obj"));
    let brightest = run.image().chunks_exact(4).map(|p| p[0]).max();
    // Small letters before a background that is nearly black.
    assert!(brightest > Some(150), "the reason is in view: {brightest:?}");
    let mistake = Cardboard::new(settings(&["scene=palace"]), screen(), &folders).err().unwrap().to_string();
    assert!(mistake.contains("palace") && mistake.contains("room.obj"), "{mistake}");
}

#[test]
fn questions_are_asked_after_the_session_and_answered_by_head_or_keys() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let settings = ["duration=0.1", "hud=false", "participant=P03", "trial=4"];
    let questions = ["questions=image-quality,comfort", "method=mono"];
    let mut run = Run::ready(headless.gl(), &[&settings[..], &questions].concat());
    let seen = run.frame();
    assert!(!seen.session_over);
    let scene = run.image();
    for _ in 0..8 {
        assert!(!run.frame().session_over, "it is not over before the questions are answered");
    }
    assert_ne!(run.image(), scene, "the panel");
    // Keys have another meaning now, and the method that is being judged does not change.
    assert_eq!(run.viewer.event(Event::IpdUp).unwrap(), Action::Marker(3.5));
    assert_eq!(run.viewer.event(Event::NextViewpoint).unwrap(), Action::Nothing);
    assert_eq!(run.viewer.event(Event::Tap).unwrap(), Action::Answer);
    assert_eq!(run.viewer.viewer().method(), Method::Mono.into());
    // The second question: the head turns to the left and stays there.
    let hold = |run: &mut Run, left: f32| {
        let head = Quat::from_rotation_y(left);
        run.viewer.hold_head(Some(HeldHead { rendered: head, displayed: head }));
    };
    hold(&mut run, 0.0);
    run.frame();
    hold(&mut run, 0.35);
    let mut report = run.frame();
    for _ in 0..6 * 60 {
        if report.session_over {
            break;
        }
        report = run.frame();
    }
    assert!(report.session_over, "a marker left alone is an answer");
    let said: Vec<String> = run.viewer.viewer().ratings().iter().map(ToString::to_string).collect();
    let line = "rating,v=2,participant=P03,trial=4,method=mono,pipeline=na,scene=prototype,question=";
    assert_eq!(said, [format!("{line}image-quality,value=3.5"), format!("{line}comfort,value=1.0")]);
}

const TIMING: FrameTiming = FrameTiming { now_ns: 1, expected_display_ns: 2, refresh_hz: 60.0 };

fn ready(headless: &Headless) -> Cardboard {
    let screen = Screen { size: [256, 128], dpi: [0.0; 2], rotation: Rotation::LandscapeLeft };
    let mut settings = Settings::default();
    for pair in ["scene=prototype", "render-scale=0.25", "shadow-map=0", "msaa=1", "bloom=false"] {
        settings.apply(pair).unwrap();
    }
    let mut viewer = Cardboard::new(settings, screen, &[]).unwrap();
    viewer.attach(headless.gl().clone()).unwrap();
    wait(&mut viewer);
    viewer
}

fn with(viewer: &Cardboard, pairs: &[&str]) -> Settings {
    let mut settings = viewer.viewer().settings().clone();
    pairs.iter().for_each(|pair| settings.apply(pair).unwrap());
    settings
}

#[test]
fn only_settings_that_differ_take_effect() {
    let headless = Headless::open(Backend::Auto).unwrap();
    let mut viewer = ready(&headless);
    viewer.event(Event::IpdUp).unwrap();
    let ipd = viewer.viewer().ipd();
    viewer.configure(with(&viewer, &["method=mono", "timewarp=position", "hud=false"]), &[]).unwrap();
    assert_eq!(
        (viewer.viewer().method(), viewer.viewer().ipd(), viewer.viewer().caption.is_shown),
        (Method::Mono.into(), ipd, false)
    );
    viewer.event(Event::Tap).unwrap();
    assert_ne!(viewer.viewer().method(), Method::Mono.into());
    let tapped = viewer.viewer().method();
    viewer.configure(with(&viewer, &["ipd=0.05", "viewer=v1", "msaa=4"]), &[]).unwrap();
    assert_eq!((viewer.viewer().method(), viewer.viewer().ipd()), (tapped, Ipd::nearest(0.05)));
    assert!((viewer.optics().params().inter_lens - 0.060).abs() < 1e-6);
    let reported = viewer.optics().screen();
    viewer.configure(with(&viewer, &["screen=158x71mm"]), &[]).unwrap();
    assert_eq!(viewer.optics().screen(), [0.158, 0.071]);
    viewer.configure(with(&viewer, &["screen=auto"]), &[]).unwrap();
    assert_eq!(viewer.optics().screen(), reported);
    viewer.configure(with(&viewer, &["ipd=auto"]), &[]).unwrap();
    assert_eq!(viewer.viewer().ipd(), Ipd::nearest(viewer.optics().params().inter_lens));
    viewer.configure(with(&viewer, &["scene=talk"]), &[]).unwrap();
    assert!(viewer.viewer().scene.is_loading());
    wait(&mut viewer);
    viewer.render(&TIMING).unwrap();
    assert_eq!(headless.gl().take_errors(), None);
}

#[test]
fn mistakes_change_nothing() {
    let headless = Headless::open(Backend::Auto).unwrap();
    let mut viewer = ready(&headless);
    let before = viewer.viewer().settings().clone();
    for pair in ["scene=nowhere", "viewer=/no/such/file"] {
        let settings = with(&viewer, &[pair, "method=mono", "ipd=0.02"]);
        assert!(viewer.configure(settings, &[]).is_err());
        assert_eq!((viewer.viewer().settings(), viewer.viewer().method()), (&before, before.method));
    }
    if !headless.gl().capabilities().multiview {
        let settings = with(&viewer, &["method=multiview"]);
        assert!(matches!(viewer.configure(settings, &[]), Err(ViewerError::Gl(GlError::Unsupported(_)))));
        assert_eq!((viewer.viewer().settings(), viewer.viewer().method()), (&before, before.method));
    }
    viewer.render(&TIMING).unwrap();
}

#[test]
fn the_menu_is_chosen_from_by_looking_and_keeps_what_it_changes() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let mut run = Run::ready(gl, &["hud=false"]);
    let look = |run: &mut Run, yaw: f32, pitch: f32, frames: u32| {
        let turn = Quat::from_rotation_y(yaw.to_radians()) * Quat::from_rotation_x(pitch.to_radians());
        run.viewer.hold_head(Some(HeldHead { rendered: turn, displayed: turn }));
        for _ in 0..frames {
            run.frame();
        }
        run.image()
    };
    let synthesized = look(&mut run, 0.0, 0.0, 2);
    assert_eq!(run.viewer.event(Event::LongPress).unwrap(), Action::Menu(true));
    let open = look(&mut run, 0.0, 0.0, 1);
    let differing = open.chunks_exact(4).zip(synthesized.chunks_exact(4)).filter(|(a, b)| a != b).count();
    let all = open.len() / 4;
    assert!(differing > all / 20 && differing < all / 3, "the panel alone: {differing} of {all}");
    // Chooses the dominant eye by looking for a second and a half, and the lenses' tile by the trigger.
    look(&mut run, 15.0, -3.5, 95);
    assert_eq!(run.viewer.viewer().settings().dominant, yoro::eyes::Eye::Left);
    look(&mut run, 5.0, -3.5, 2);
    assert_eq!(run.viewer.event(Event::Tap).unwrap(), Action::Settings);
    assert_eq!(run.viewer.viewer().settings().viewer, "v2");
    let kept = run.viewer.viewer_mut().take_kept().unwrap();
    assert_eq!(kept, [("dominant", "left".to_owned()), ("viewer", "v2".to_owned())]);
    assert_eq!(run.viewer.viewer_mut().take_kept(), None);
    // Compares while the trigger is held, without the panel.
    look(&mut run, 5.0, -7.5, 2);
    let menu = run.image();
    run.viewer.event(Event::Press).unwrap();
    let compared = look(&mut run, 5.0, -7.5, 1);
    assert_eq!(run.viewer.event(Event::LongPress).unwrap(), Action::Nothing);
    run.viewer.event(Event::Release).unwrap();
    let after = run.next_image();
    assert!(compared != menu && after != compared);
    let mut plain = Run::ready(gl, &["hud=false", "method=conventional", "dominant=left", "viewer=v2"]);
    let expected = look(&mut plain, 5.0, -7.5, 1);
    let apart = compared.iter().zip(&expected).filter(|(a, b)| a.abs_diff(**b) > 2).count();
    assert!(apart < expected.len() / 50, "two real renders besides the message: {apart}");
    drop(plain);
    // Reset restores the initial settings.
    look(&mut run, -5.0, -7.5, 2);
    assert_eq!(run.viewer.event(Event::Tap).unwrap(), Action::Settings);
    assert_eq!(run.viewer.viewer().settings().viewer, "v1");
    assert_eq!(run.viewer.viewer_mut().take_kept(), Some(Vec::new()));
    look(&mut run, -15.0, -7.5, 2);
    assert_eq!(run.viewer.event(Event::Tap).unwrap(), Action::Menu(false));
    assert!(look(&mut run, 0.0, 0.0, 2) == synthesized);
    drop(run);
    assert_eq!((gl.object_count(), gl.take_errors()), (0, None));
}

#[test]
fn no_quality_of_the_menu_contradicts_positional_timewarp() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let mut run = Run::ready(headless.gl(), &["hud=false", "timewarp=position"]);
    run.frame();
    run.viewer.event(Event::LongPress).unwrap();
    let turn = Quat::from_rotation_y(-15f32.to_radians()) * Quat::from_rotation_x(-3.5f32.to_radians());
    run.viewer.hold_head(Some(HeldHead { rendered: turn, displayed: turn }));
    for render_scale in [1.0, 1.4, 0.7] {
        run.frame();
        assert_eq!(run.viewer.event(Event::Tap).unwrap(), Action::Settings);
        let settings = run.viewer.viewer().settings();
        assert_eq!((settings.render_scale, settings.foveation), (render_scale, Some(FoveationLevel::Off)));
    }
}

#[test]
fn the_start_screen_is_touched_and_comes_when_the_phone_stands_upright() {
    const URI: &str = "https://google.com/cardboard/cfg?p=CgRBY21lEghQb2NrZXQgNR3sUTg9JY_CdT0qEAAANEIAADRCAAA0QgAANEI1KVwPPToImpmZPs3MzD4";
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let mut run = Run::ready(gl, &["hud=false"]);
    let [corner, scene] = [[10.0, 5.0], [160.0, 90.0]];
    assert_eq!(run.viewer.touch(Some(corner)).unwrap(), None, "a computer has started it: a tap is a tap");
    let bare = run.next_image();
    run.viewer.viewer_mut().offer_start_screen();
    let signs = run.next_image();
    let differing: Vec<usize> =
        (0..bare.len() / 4).filter(|i| bare[4 * i..][..4] != signs[4 * i..][..4]).collect();
    // 48 density-independent pixels at 74 pixels per inch.
    let is_corner = |i: &usize| 180 - i / 320 <= 22 && (i % 320 < 22 || i % 320 >= 320 - 22);
    assert!(differing.len() > 500 && differing.iter().all(is_corner), "{}", differing.len());
    assert_eq!(run.viewer.touch(Some(scene)).unwrap(), None);
    assert_eq!(run.viewer.touch(Some([315.0, 5.0])).unwrap(), Some(Action::Menu(true)));
    assert_eq!(run.viewer.touch(Some(corner)).unwrap(), Some(Action::StartScreen(true)));
    assert_eq!(run.viewer.viewer().menu_place(), None);
    run.viewer.viewer_mut().take_kept();

    // The centres of the tiles, by column and row.
    let tile = |column: usize, row: usize| Some([40.0 + 80.0 * column as f32, 115.0 + 34.0 * row as f32]);
    let shown = run.next_image();
    assert_eq!(run.viewer.touch(tile(1, 0)).unwrap(), Some(Action::Settings));
    assert_eq!(run.viewer.viewer().settings().viewer, "v2");
    assert_eq!(run.viewer.touch(tile(2, 0)).unwrap(), Some(Action::Nothing), "there is no third viewer");
    run.viewer.choose_viewer(URI).unwrap();
    assert_eq!(run.viewer.viewer().settings().viewer, URI);
    assert_eq!(run.viewer.touch(tile(0, 0)).unwrap(), Some(Action::Settings));
    assert_eq!(run.viewer.touch(tile(2, 0)).unwrap(), Some(Action::Settings), "the one before is offered");
    assert_eq!(run.viewer.viewer().settings().viewer, URI);
    let chosen = run.next_image();
    assert_eq!(run.viewer.touch(tile(0, 1)).unwrap(), Some(Action::Scan(true)));
    let other = run.next_image();
    assert!(shown != chosen && other != chosen, "it says how to get another viewer");
    let picture: Vec<u8> = (0..Board::PICTURE[0] * Board::PICTURE[1]).map(|i| (i % 251) as u8).collect();
    run.viewer.viewer_mut().show_camera(&picture);
    assert!(run.viewer.viewer().is_scanning());
    assert!(run.next_image() != other, "what the camera sees");
    assert_eq!(run.viewer.touch(tile(0, 1)).unwrap(), Some(Action::Scan(false)));
    assert!(!run.viewer.viewer().is_scanning());
    assert_eq!(run.viewer.touch(Some([110.0, 149.0])).unwrap(), Some(Action::ShareLog));
    assert_eq!(run.viewer.touch(Some([130.0, 149.0])).unwrap(), Some(Action::ShareNotices));
    assert_eq!(run.viewer.touch(Some([160.0, 1.0])).unwrap(), Some(Action::Nothing));
    assert_eq!(run.viewer.touch(tile(3, 1)).unwrap(), Some(Action::StartScreen(false)));
    let kept = run.viewer.viewer_mut().take_kept().unwrap();
    assert_eq!(kept, [("recent-viewers", URI.to_owned()), ("viewer", URI.to_owned())]);

    // Upright for more than a second: gravity points along the picture's width.
    run.frame();
    assert!(!run.viewer.viewer().is_start_screen());
    let stand = |run: &mut Run, up: Vec3, frames: i64| {
        for _ in 0..frames {
            run.viewer.sensor(MotionSample::Accelerometer(9.81 * up), run.now_ns);
            run.frame();
        }
        run.viewer.viewer().is_start_screen()
    };
    assert!(!stand(&mut run, Vec3::X, 30));
    assert!(stand(&mut run, Vec3::new(0.0, 0.87, 0.5), 200));
    assert_eq!(run.viewer.touch(None).unwrap(), Some(Action::StartScreen(false)), "a key starts");
    drop(run);
    assert_eq!((gl.object_count(), gl.take_errors()), (0, None));
}

/// A triangle that moves from left to right in one second.
const MOVING: &str = r#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}], "samplers": [{"input": 1, "output": 2}]}],
  "buffers": [{"byteLength": 68, "uri": "data:application/octet-stream;base64,zczMvs3MzL4AAADAzczMPs3MzL4AAADAAAAAAM3MzD4AAADAAAAAAAAAgD+amRm/AAAAAAAAAACamRk/AAAAAAAAAAA="}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8}, {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
    {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR"}, {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}]}"#;

#[test]
fn what_moves_plays_and_rests_in_the_background() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.gltf");
    std::fs::write(&path, MOVING).unwrap();
    std::fs::write(folder.path().join("camera.json"), r#"[{"position": [0, 0, 1], "target": [0, 0, -2]}]"#)
        .unwrap();
    let scene = format!("scene={}", path.display());
    let mut run = Run::ready(headless.gl(), &[&scene, "hud=false"]);
    let mut after = |frames: u32| {
        for _ in 0..frames {
            run.frame();
        }
        run.image()
    };
    let [start, later] = [1, 15].map(&mut after);
    assert!(start != later);
    // One second after the start the loop begins again.
    assert!(after(45) == start);
    let half = after(30);
    run.viewer.viewer_mut().pause();
    run.now_ns += 10_200_000_000;
    let resumed = run.next_image();
    assert!(half == resumed && half != start);
}
