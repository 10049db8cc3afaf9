//! `yoro xr` on the simulated runtime of ../openxr-stub and on Monado.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use glam::{Quat, Vec3};
use image::{Rgb, RgbImage};
use serde_json::{Value, json};
use tempfile::TempDir;
use xtask::maintain::monado::{self, Running};
use yoro::eyes::{Eye, EyePair, Pose};
use yoro_context::{Backend, Headless};
use yoro_media::rgb_image;
use yoro_metrics::{Channels, Quality};
use yoro_openxr_stub::log::{self, Entry, Layer, View};
use yoro_openxr_stub::script::{
    Aim, At, Event, Eye as ScriptEye, Fault, Input, Insets, POISON, Pictures, Script, State, VARIABLE, What,
};
use yoro_render::PreparedScene;
use yoro_render::stereo::{Method, StereoFrame, StereoSession};
use yoro_settings::Settings;
use yoro_viewer::{render_settings, stereo_options};

use crate::program::{self, Run, finish, yoro};

const ONE_SAMPLE: &str = "msaa=1";
/// A scene that is there at once, in the folder of each simulated runtime.
const SQUARE: &str = "square.obj";
/// Settings that make rendering cheap.
const CHEAP: [&str; 3] = ["shadow-map=0", "bloom=false", "hud=false"];
/// The time limit of a run.
const LIMIT: Duration = Duration::from_secs(60);

fn cheap() -> impl Iterator<Item = &'static str> {
    CHEAP.iter().flat_map(|setting| ["--set", *setting])
}

/// Runs a command, which must end in time.
#[track_caller]
fn in_time(command: &mut Command) -> Run {
    let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    program::in_time(command.spawn().expect("the program starts"), LIMIT)
}

/// The simulated runtime with a script and its log.
struct Simulated {
    folder: TempDir,
}

impl Simulated {
    fn new(script: &Script) -> Simulated {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let mut script = script.clone();
        script.log = Some(at("log.jsonl"));
        if let Some(pictures) = &mut script.pictures {
            pictures.folder = folder.path().into();
        }
        fs::write(at("script.json"), serde_json::to_string(&script).unwrap()).unwrap();
        fs::write(at(SQUARE), "v -1 -1 -3\nv 1 -1 -3\nv 1 1 -3\nv -1 1 -3\nf 1 2 3 4\n").unwrap();
        // Cargo builds it for these tests, into the same folder.
        let library = std::env::current_exe().unwrap().with_file_name("libyoro_openxr_stub.so");
        let manifest = json!({
            "file_format_version": "1.0.0",
            "runtime": { "name": "simulated", "library_path": library },
        });
        fs::write(at("runtime.json"), manifest.to_string()).unwrap();
        Simulated { folder }
    }

    /// Returns the command `yoro xr` with a line of arguments and cheap settings.
    fn command(&self, line: &str) -> Command {
        let line = format!("xr --runtime runtime.json {line}");
        let arguments = line.split_whitespace().map(str::to_owned);
        let mut command = yoro(arguments.chain(cheap().map(str::to_owned)));
        command.env(VARIABLE, "script.json").env("RUST_LOG", "yoro=info").current_dir(&self.folder);
        command
    }

    /// Runs the command.
    #[track_caller]
    fn run(&self, line: &str) -> Run {
        in_time(&mut self.command(line))
    }

    /// Runs the program like [`Simulated::run`]. Fails if it fails or violates the specification.
    #[track_caller]
    fn succeed(&self, line: &str) -> Run {
        let run = self.run(line);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        self.check();
        run
    }

    fn log(&self) -> Vec<Entry> {
        log::read(&self.path("log.jsonl"))
    }

    /// Fails if the specification was violated.
    #[track_caller]
    fn check(&self) {
        let violations: Vec<Entry> =
            self.log().into_iter().filter(|entry| matches!(entry, Entry::Violation { .. })).collect();
        assert!(violations.is_empty(), "{violations:#?}");
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn picture(&self, name: &str) -> RgbImage {
        yoro_media::load_color(&self.path(name)).unwrap()
    }

    /// Returns the number and the views of each frame that has views.
    fn views(&self) -> Vec<(u32, Vec<View>)> {
        let views = |entry| match entry {
            Entry::Frame { frame, layers, .. } => layers.into_iter().find_map(|layer| match layer {
                Layer::Projection { views } => Some((frame, views)),
                _ => None,
            }),
            _ => None,
        };
        self.log().into_iter().filter_map(views).collect()
    }

    /// Returns the values that the program requested.
    fn requests(&self, of: &str) -> Vec<f64> {
        let value = |entry| match entry {
            Entry::Request { what, value } if what == of => Some(value),
            _ => None,
        };
        self.log().into_iter().filter_map(value).collect()
    }

    fn count(&self, is: impl Fn(&Entry) -> bool) -> usize {
        self.log().iter().filter(|entry| is(entry)).count()
    }
}

/// Pictures in the folder of the run, from the first frame on.
fn pictures() -> Option<Pictures> {
    Some(Pictures { folder: PathBuf::new(), from: 1 })
}

fn event(at: At, what: What) -> Event {
    Event { at, what }
}

/// Returns the lines of the log that report a failure.
fn failures(run: &Run) -> Vec<&str> {
    run.stderr.lines().filter(|line| line.contains("OpenXR runtime")).collect()
}

#[track_caller]
fn assert_no_crash(run: &Run) {
    assert!(matches!(run.code, Some(0 | 2)), "{:?}: {}", run.code, run.stderr);
    for internal in ["panicked", "stack backtrace", "RUST_BACKTRACE"] {
        assert!(!run.stderr.contains(internal), "{}", run.stderr);
    }
}

/// Fails if a pixel was never drawn, in the columns and rows at the edges or anywhere between.
#[track_caller]
fn assert_drawn(image: &RgbImage) {
    let poison = Rgb([POISON[0], POISON[1], POISON[2]]);
    let undrawn = image.enumerate_pixels().find(|(_, _, pixel)| **pixel == poison);
    assert_eq!(undrawn, None, "a pixel that was never drawn");
}

/// On a runtime that leaves another context current, and has functions without an instance only without one.
#[test]
fn a_session_from_beginning_to_end() {
    let script = Script {
        poison: true,
        no_globals: true,
        unbind_context: true,
        pictures: pictures(),
        ..Script::default()
    };
    let simulated = Simulated::new(&script.asymmetric());
    let run = simulated.succeed("--method conventional,yoro --frames 3 --capture captured --json");
    let summary = run.json();
    let states = "IDLE READY SYNCHRONIZED VISIBLE FOCUSED VISIBLE SYNCHRONIZED STOPPING IDLE EXITING";
    assert_eq!(summary["states"], json!(states.split(' ').collect::<Vec<_>>()));
    assert_eq!(summary["methods"].as_array().unwrap().len(), 2);
    for entry in simulated.log() {
        if let Entry::Frame { should_render, layers, .. } = entry {
            assert_eq!(should_render, !layers.is_empty(), "images exactly when they are wanted");
        }
    }
    let views = simulated.views();
    assert!(views.len() >= 6);
    for (_, views) in &views {
        let [left, right] = views.as_slice() else { panic!("{views:?}") };
        assert!((right.position[0] - left.position[0] - 0.063).abs() < 1e-4);
        for (view, fov) in [(left, [-52.0, 42.0, 47.0, -50.0]), (right, [-42.0, 52.0, 47.0, -50.0])] {
            for (submitted, located) in view.fov_degrees.into_iter().zip(fov) {
                assert!((submitted - located).abs() < 0.01, "{view:?}");
            }
        }
        assert_ne!(left.image.swapchain, right.image.swapchain, "a swapchain for each eye");
        for view in views {
            let depth = view.depth.as_ref().expect("depth is submitted where the extension exists");
            assert!(depth.near_far[0] < depth.near_far[1], "{depth:?}");
        }
    }
    let pictures = [0, 1].map(|view| simulated.picture(&format!("view-{view}.png")));
    pictures.iter().for_each(assert_drawn);
    assert!(pictures[0] != pictures[1]);
    let captured = ["left", "right"].map(|eye| simulated.picture(&format!("captured/yoro.{eye}.png")));
    assert!(captured == pictures, "what is captured is what the runtime gets");
    assert_eq!(simulated.count(|entry| matches!(entry, Entry::Destroyed { .. })), 2, "session and instance");
}

/// The right eye is dominant, and the view that is rendered begins left of it.
#[test]
fn the_rendered_eye_is_shown_where_it_is_rendered() {
    let shown = |extensions: &str, setting: &str| {
        let simulated = Simulated::new(&Script { poison: true, pictures: pictures(), ..Script::default() });
        let mut command = simulated.command("prototype --method yoro --frames 2");
        let run = in_time(command.args(["--set", setting]).env("MESA_EXTENSION_OVERRIDE", extensions));
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        simulated.check();
        let (_, views) = simulated.views().pop().expect("a frame was shown");
        let pictures = [0, 1].map(|view| simulated.picture(&format!("view-{view}.png")));
        pictures.iter().for_each(assert_drawn);
        (views.into_iter().map(|view| view.image.rect).collect::<Vec<_>>(), pictures)
    };
    let begins_at_corner = |rect: &[i32; 4]| rect[..2] == [0, 0];
    for samples in ["msaa=4", "msaa=1"] {
        let (rendered, pictures) = shown("", samples);
        let (copied, expected) = shown("-GL_EXT_texture_sRGB_decode", samples);
        assert!(rendered[1][0] > 0 && begins_at_corner(&rendered[0]), "{rendered:?}");
        assert!(copied.iter().all(begins_at_corner), "{copied:?}");
        assert_eq!(
            [0, 1].map(|eye| rendered[eye][2..].to_vec()),
            [0, 1].map(|eye| copied[eye][2..].to_vec())
        );
        assert!(pictures == expected, "{samples}: the same pictures");
    }
    let (with_bloom, _) = shown("", "bloom=true");
    assert!(
        with_bloom.iter().all(begins_at_corner),
        "bloom is added while the eye is copied: {with_bloom:?}"
    );
}

#[test]
fn any_call_may_fail_once() {
    let clean = Simulated::new(&Script::default());
    clean.succeed(&format!("{SQUARE} --frames 2"));
    let Some(Entry::Calls { counts }) = clean.log().pop() else { panic!("the log ends with the calls") };
    assert!(counts.len() > 40, "{counts:?}");
    for call in counts.keys() {
        // Only the calls of xrGetInstanceProcAddr before the instance is created matter.
        let fault = Fault { call: call.clone(), nth: 1, and_later: false, result: -2 };
        let simulated = Simulated::new(&Script { faults: vec![fault], ..Script::default() });
        let run = simulated.run(&format!("{SQUARE} --frames 2"));
        assert_no_crash(&run);
        simulated.check();
        assert_eq!(simulated.count(|entry| matches!(entry, Entry::Fault { .. })), 1, "{call}");
        let reported =
            failures(&run).into_iter().filter(|line| line.contains("failed with")).collect::<Vec<_>>();
        // A failure to destroy an object has no consequence.
        let expected = if call.starts_with("xrDestroy") { 0 } else { 1 };
        assert_eq!(reported.len(), expected, "{call}: {}", run.stderr);
        assert!(reported.iter().all(|line| line.contains(call)), "{call}: {reported:?}");
    }

    // A call that fails for ever ends the program.
    let fault = Fault { call: "xrWaitFrame".into(), nth: 3, and_later: true, result: -2 };
    let simulated = Simulated::new(&Script { faults: vec![fault], ..Script::default() });
    let run = simulated.run("--frames 9");
    assert_eq!(run.code, Some(2), "{}", run.stderr);
    assert!(failures(&run).len() < 10, "{}", run.stderr);
    simulated.check();
}

#[test]
fn a_session_is_lost_in_every_state() {
    let states =
        [State::Idle, State::Ready, State::Synchronized, State::Visible, State::Focused, State::Stopping];
    for state in states {
        for what in [What::LoseSession, What::SessionLossPending, What::LoseInstance] {
            let case = format!("{what:?} in {state:?}");
            let events = vec![event(At::State(state), what)];
            let simulated = Simulated::new(&Script { events, ..Script::default() });
            let run = simulated.run(&format!("{SQUARE} --frames 2"));
            assert_no_crash(&run);
            simulated.check();
            assert_eq!(simulated.count(|e| matches!(e, Entry::Scripted { .. })), 1, "{case}");
            if state == State::Stopping {
                // All frames were shown, so nothing has to be started again.
                continue;
            }
            assert_eq!(run.code, Some(0), "{case}: {}", run.stderr);
            assert_eq!(
                failures(&run).iter().filter(|line| !line.contains("INFO")).count(),
                1,
                "{case}: {}",
                run.stderr
            );
            assert_eq!(simulated.count(|e| matches!(e, Entry::Session { .. })), 2, "{case}");
            let frames = simulated.views().len();
            assert!(frames >= 2, "{case}: {frames} frames");
        }
    }
}

#[test]
fn changes_of_state_pose_refresh_rate_and_ipd_are_followed_until_the_user_ends_it() {
    let events = vec![
        event(At::Frame(6), What::Level(State::Visible)),
        event(At::Frame(8), What::Level(State::Synchronized)),
        event(At::Frame(10), What::Level(State::Focused)),
        event(At::Frame(14), What::Recenter(30.0)),
        event(At::Frame(16), What::RefreshRate(90.0)),
        event(At::Frame(18), What::Profile(None)),
        event(At::Frame(19), What::Profile(Some("/interaction_profiles/khr/simple_controller".into()))),
        event(At::Frame(20), What::EventsLost),
        event(At::Frame(21), What::MaskChanged),
        event(At::Frame(24), What::TakeOff(5)),
        event(At::Frame(40), What::Exit),
    ];
    let script = Script {
        events,
        visibility_mask: true,
        untracked: vec![12, 13],
        quaternion_lengths: vec![(3, 1.02), (4, 0.0), (5, 0.9)],
        ipd: vec![(0, 0.063), (15, 0.058), (22, 0.068)],
        ..Script::default()
    };
    let simulated = Simulated::new(&script.asymmetric());
    let run = simulated.succeed("--set refresh-rate=80");
    assert!(run.stdout.contains("EXITING"), "{}", run.stdout);
    assert_eq!(simulated.count(|e| matches!(e, Entry::Begun { .. })), 2, "taken off and put on again");
    assert_eq!(simulated.count(|e| matches!(e, Entry::Session { .. })), 1, "nothing is started again");
    assert_eq!(simulated.requests("refresh-rate"), [80.0]);
    let views = simulated.views();
    let shown = |frame| views.iter().any(|(shown, _)| *shown == frame);
    assert!(shown(3) && shown(5), "a quaternion of another length still gives a pose");
    assert!(!shown(4), "a quaternion without a length gives none");
    for (frame, views) in views {
        let wanted = if frame < 15 {
            0.063
        } else if frame < 22 {
            0.058
        } else {
            0.068
        };
        let across: f32 = (0..3).map(|i| (views[1].position[i] - views[0].position[i]).powi(2)).sum();
        assert!((across.sqrt() - wanted).abs() < 1e-4, "frame {frame}: {views:?}");
        assert!(![12, 13].contains(&frame), "nothing is shown from an unknown pose");
    }
}

#[test]
fn controllers_switch_methods() {
    let input =
        |frame, path: &str, value| Input { frame, path: format!("/user/hand/{path}"), value: [value, 0.0] };
    let stick = [input(20, "left/input/thumbstick", -1.0), input(22, "left/input/thumbstick", 0.0)];
    let button = [input(10, "right/input/a/click", 1.0), input(12, "right/input/a/click", 0.0)];
    for (controller, inputs, expected) in [
        ("oculus/touch_controller", [&button[..], &stick].concat(), &["auto", "yoro", "auto"][..]),
        ("bytedance/pico4_controller", stick.to_vec(), &["auto", "mono"]),
    ] {
        let script = Script {
            profile: Some(format!("/interaction_profiles/{controller}")),
            inputs,
            events: vec![event(At::Frame(30), What::Exit)],
            ..Script::default()
        };
        let summary = Simulated::new(&script).succeed("--json").json();
        let methods = summary["methods"].as_array().unwrap().iter();
        let methods: Vec<&str> = methods.map(|m| m["method"].as_str().unwrap()).collect();
        assert_eq!(methods, expected, "{controller}");
    }
}

/// The menu's panel is a separate layer. A tile is selected by a controller's ray, another one by the left hand's.
#[test]
fn a_ray_chooses_from_the_menu() {
    let input =
        |frame, path: &str, value| Input { frame, path: format!("/user/hand/{path}"), value: [value, 0.0] };
    // From the right hip to the tile of the viewpoint, and from the left hip to the tile of the figures.
    let aim = |frame, is_left, yaw_degrees, pitch_degrees| Aim { frame, is_left, yaw_degrees, pitch_degrees };
    let script = Script {
        inputs: vec![
            input(10, "right/input/a/click", 1.0),
            input(90, "right/input/a/click", 0.0),
            input(100, "right/input/trigger/value", 1.0),
            input(104, "right/input/trigger/value", 0.0),
            input(126, "left/input/x/click", 1.0),
            input(130, "left/input/x/click", 0.0),
        ],
        aims: vec![
            aim(0, false, 0.0, -80.0),
            aim(92, false, -2.12, 10.70),
            aim(110, false, 0.0, -80.0),
            aim(120, true, 8.03, 1.0),
        ],
        events: vec![event(At::Frame(140), What::Exit)],
        pictures: Some(Pictures { folder: PathBuf::new(), from: 136 }),
        ..Script::default()
    };
    let simulated = Simulated::new(&script);
    let run = simulated.succeed("");
    let said: Vec<&str> =
        run.stderr.lines().filter_map(|line| line.split_once("menu: ")).map(|(_, said)| said).collect();
    assert_eq!(said, ["open", "viewpoint=1", "hud=true"], "{}", run.stderr);
    // White letters on tiles with the values 45 and 15 of 255.
    let panel = simulated.picture("quad-0.png");
    let share = |is: fn(u8) -> bool| {
        panel.pixels().filter(|pixel| is(pixel.0[0])).count() as f32 / (panel.width() * panel.height()) as f32
    };
    let (ground, ink) = (share(|light| light < 60), share(|light| light > 200));
    assert!(ground > 0.7 && (0.02..0.3).contains(&ink), "{ground} {ink}");
}

#[test]
fn missing_extensions_are_worked_around() {
    let optional = [
        "XR_KHR_composition_layer_depth",
        "XR_KHR_visibility_mask",
        "XR_FB_display_refresh_rate",
        "XR_EXT_performance_settings",
        "XR_EXT_local_floor",
        "XR_BD_controller_interaction",
        "XR_VARJO_quad_views",
        "XR_FB_foveation_configuration",
    ];
    let missing_extensions = optional.map(str::to_owned).into();
    let simulated = Simulated::new(&Script { missing_extensions, ..Script::default() });
    simulated.succeed("--frames 1 --set refresh-rate=90");
    assert!(simulated.views().iter().flat_map(|(_, views)| views).all(|view| view.depth.is_none()));
    assert!(simulated.requests("refresh-rate").is_empty());

    // Without sRGB and depth, without controllers, without stereo.
    let simulated = Simulated::new(&Script { formats: vec![0x8058], profile: None, ..Script::default() });
    simulated.succeed("--frames 1");
    let simulated = Simulated::new(&Script { stereo: false, ..Script::default() });
    simulated.succeed("--frames 1 --mono");
    assert!(simulated.views().iter().all(|(_, views)| views.len() == 1));
}

#[test]
fn missing_requirements_are_named() {
    let refuse = |script: Script, naming: &[&str]| {
        let simulated = Simulated::new(&script);
        let arguments = ["xr", "--runtime", "runtime.json", "--frames", "1"];
        let mut command = yoro(arguments);
        command.env(VARIABLE, "script.json").current_dir(&simulated.folder);
        in_time(&mut command).refuses(naming);
    };
    for extension in ["XR_KHR_opengl_es_enable", "XR_MNDX_egl_enable"] {
        refuse(
            Script { missing_extensions: vec![extension.into()], ..Script::default() },
            &[extension, "another runtime"],
        );
    }
    refuse(Script { formats: Vec::new(), ..Script::default() }, &["format"]);
    refuse(Script { unavailable: 99, ..Script::default() }, &["xrGetSystem", "connect the headset"]);
    refuse(Script { stereo: false, mono: false, ..Script::default() }, &["OpenXR"]);

    let folder = tempfile::tempdir().unwrap();
    let xr = |arguments: &[&str], manifest: &str| {
        fs::write(folder.path().join("r.json"), manifest).unwrap();
        let mut command = yoro(["xr"].iter().chain(arguments));
        in_time(command.current_dir(&folder).env("XR_RUNTIME_JSON", "r.json"))
    };
    xr(&["--runtime", "absent.json"], "").refuses(&["absent.json"]);
    xr(&[], "{").refuses(&["r.json", "not the manifest"]);
    let lost = r#"{ "file_format_version": "1.0.0", "runtime": { "library_path": "./lost.so" } }"#;
    xr(&[], lost).refuses(&["lost.so"]);
}

#[test]
fn canted_and_unequal_eyes_are_drawn_completely() {
    let asymmetric = Script::default().asymmetric();
    let [left, right] = asymmetric.eyes;
    let cases = [
        ("canted", [left, right].map(|eye| ScriptEye { cant_degrees: 5.0, ..eye })),
        ("unequal in size", [ScriptEye { size: [128, 128], ..left }, ScriptEye { size: [96, 112], ..right }]),
        ("far apart in height", [left, ScriptEye { fov_degrees: [-42.0, 52.0, 40.0, -44.0], ..right }]),
        (
            "a wide frustum and a narrow one",
            [left, ScriptEye { fov_degrees: [-30.0, 30.0, 47.0, -50.0], ..right }],
        ),
    ];
    for (case, eyes) in cases {
        let simulated =
            Simulated::new(&Script { eyes, poison: true, pictures: pictures(), ..Script::default() });
        let run = simulated.succeed("--frames 4");
        for view in 0..2 {
            assert_drawn(&simulated.picture(&format!("view-{view}.png")));
        }
        if case == "canted" {
            let lines = run.stderr.lines().filter(|line| line.contains("cant")).count();
            assert_eq!(lines, 1, "{}", run.stderr);
        }
    }
}

/// Renders the same eyes with the same settings on the desktop.
fn desktop(scene: &str, method: Method, pair: &EyePair, settings: &Settings) -> [RgbImage; 2] {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let scene = yoro_scenes::build(scene, yoro_scenes::DEFAULT_SEED).unwrap();
    let (render, options) = (render_settings(settings, None), stereo_options(settings, settings.pipeline));
    let mut scene = PreparedScene::new(gl, scene, &render).unwrap();
    let mut session = StereoSession::new(gl, method.into(), &render, &options).unwrap();
    let mut frame = StereoFrame::new(gl, pair.size).unwrap();
    session.frame(&mut scene, &(*pair).into(), frame.fit(pair.size).unwrap(), None).unwrap();
    Eye::BOTH.map(|eye| rgb_image(&frame.rgba(eye), frame.size()))
}

fn captured(folder: &Path, summary: &Value) -> Vec<(Method, EyePair, [RgbImage; 2])> {
    let methods = summary["methods"].as_array().unwrap().iter();
    let load = |m: &Value| {
        let name = m["method"].as_str().unwrap();
        let method = Method::ALL.into_iter().find(|method| method.name() == name).unwrap();
        let pair = serde_json::from_value(m["capture"]["eyes"].clone()).unwrap();
        let eye =
            |eye: &str| yoro_media::load_color(&folder.join(m["capture"][eye].as_str().unwrap())).unwrap();
        (method, pair, [eye("left"), eye("right")])
    };
    methods.map(load).collect()
}

fn rgb(a: &RgbImage, b: &RgbImage) -> Quality {
    Quality::of(a, b, Channels::Rgb).unwrap()
}

/// Frusta of a headset: 52 degrees outwards, 42 degrees inwards.
fn asymmetric(size: [u32; 2]) -> [ScriptEye; 2] {
    Script::default().asymmetric().eyes.map(|eye| ScriptEye { size, ..eye })
}

/// The headset shows what the desktop renders, and the synthesized eye is close to a rendered one, also in its outer tenth,
/// which the other eye does not see.
#[test]
fn the_headset_shows_what_the_desktop_renders() {
    let script = Script { poison: true, eyes: asymmetric([512; 2]), ..Script::default() };
    let simulated = Simulated::new(&script);
    let run = simulated
        .succeed("--method conventional,yoro --frames 1 --set foveation=off --capture captured --json");
    let settings = Settings::resolve(None, CHEAP.map(str::to_owned)).unwrap();
    let all = captured(simulated.folder.path(), &run.json());
    for (method, pair, eyes) in &all {
        let expected = desktop("prototype", *method, pair, &settings);
        for (eye, expected) in eyes.iter().zip(&expected) {
            assert_drawn(eye);
            let quality = rgb(eye, expected);
            assert!(quality.ssim_gaussian > 0.999, "{method:?}: {quality:?}");
        }
    }
    let [(_, pair, real), (_, _, made)] = all.as_slice() else { panic!("two methods") };
    let second = pair.dominant.other();
    let (real, made) = (&real[second.index()], &made[second.index()]);
    let [size, height] = pair.size;
    let width = size / 10;
    let x = if second == Eye::Left { 0 } else { size - width };
    let outer = |image: &RgbImage| image::imageops::crop_imm(image, x, 0, width, height).to_image();
    let [whole, border] = [rgb(made, real), rgb(&outer(made), &outer(real))];
    assert!(
        whole.ssim_gaussian > 0.97 && border.ssim_gaussian > 0.97,
        "{whole:?}, at the outer border {border:?}"
    );
}

/// Returns a headset with insets of 20 degrees that follow the gaze.
fn with_insets(cant_degrees: f32) -> Script {
    let gaze = vec![(0, [0.0, 0.0]), (20, [25.0, -12.0]), (40, [60.0, 40.0])];
    let insets = Some(Insets { size: [112; 2], radius_degrees: 20.0, gaze });
    let mut script = Script { insets, poison: true, pictures: pictures(), ..Script::default() }.asymmetric();
    script.eyes.iter_mut().for_each(|eye| eye.cant_degrees = cant_degrees);
    script
}

/// With the extension and with OpenXR 1.1 alone, for parallel and for canted eyes.
#[test]
fn four_views_are_submitted_where_the_runtime_has_insets() {
    for (cant_degrees, missing) in [(0.0, None), (5.0, Some("XR_VARJO_quad_views"))] {
        let missing_extensions = missing.into_iter().map(str::to_owned).collect();
        let script = Script { missing_extensions, ..with_insets(cant_degrees) };
        let [real, made] = ["conventional", "yoro"].map(|method| {
            let simulated = Simulated::new(&script);
            let run = simulated.succeed(&format!("--method {method} --frames 8 --set foveation=high --json"));
            assert_eq!(
                (&run.json()["views"], &run.json()["inset-size"]),
                (&json!("quad"), &json!([112, 112]))
            );
            simulated
        });
        let views = made.views();
        assert!(views.len() >= 8 && views.iter().all(|(_, views)| views.len() == 4));
        for view in views.iter().flat_map(|(_, views)| views) {
            assert_eq!(view.depth.as_ref().unwrap().image.rect, view.image.rect);
        }
        let lefts: Vec<f32> = views.iter().map(|(_, views)| views[2].fov_degrees[0]).collect();
        // The gaze rests until there has been a picture, which takes a busy machine some frames.
        let rests = lefts.iter().take_while(|left| **left == lefts[0]).count();
        let moves = lefts.len() - rests >= 6 && lefts[rests - 1..].is_sorted_by(|a, b| a < b);
        assert!(moves, "the inset follows the gaze: {lefts:?}");
        let [real, made] =
            [real, made].map(|run| [0, 1, 2, 3].map(|i| run.picture(&format!("view-{i}.png"))));
        made.iter().for_each(assert_drawn);
        assert_eq!(made[2].dimensions(), (112, 112));
        // Two renders of canted eyes are not turned parallel, and have other frusta.
        if cant_degrees == 0.0 {
            let quality = |i: usize, of: usize| rgb(&made[i], &real[of]);
            for (i, least) in [0.94, 0.999, 0.92, 0.999].into_iter().enumerate() {
                assert!(quality(i, i).ssim_gaussian > least, "view {i}: {:?}", quality(i, i));
            }
            // The baseline is the same image to both eyes.
            let [own, same] = [quality(2, 2), quality(3, 2)];
            assert!(own.psnr.0 > same.psnr.0 + 3.0, "{own:?}, {same:?}");
        }
    }
}

/// A headset's foveation is `medium` unless the settings say otherwise.
#[test]
fn the_eyes_are_foveated_unless_the_settings_say_otherwise() {
    for (settings, count) in [("", 4), ("--set foveation=off", 2)] {
        let events = vec![event(At::Frame(12), What::Exit)];
        let simulated = Simulated::new(&Script { events, ..with_insets(0.0) });
        simulated.succeed(settings);
        assert!(simulated.views().iter().all(|(_, views)| views.len() == count), "{settings}");
    }
}

/// Without insets of the runtime, each eye is composed of its levels before it is submitted.
#[test]
fn foveated_eyes_are_composed_for_runtimes_without_insets() {
    let script =
        Script { eyes: asymmetric([512; 2]), poison: true, pictures: pictures(), ..Script::default() };
    let [whole, foveated] = ["off", "medium"].map(|foveation| {
        let simulated = Simulated::new(&script);
        simulated.succeed(&format!("--frames 2 --set foveation={foveation}"));
        simulated
    });
    // The runtime's own foveation is set for the pass that composes, in both eyes' swapchains.
    let levels = [&whole, &foveated].map(|run| run.requests("foveation"));
    assert_eq!(levels, [vec![], vec![2.0, 2.0]]);
    let (_, views) = foveated.views().pop().unwrap();
    for (i, view) in views.iter().enumerate() {
        let depth = view.depth.as_ref().unwrap().image.rect;
        assert_eq!(
            (view.image.rect[2], depth[2..].to_vec()),
            (512, vec![256, 256]),
            "depth is the wide level's"
        );
        let [whole, foveated] = [&whole, &foveated].map(|run| run.picture(&format!("view-{i}.png")));
        assert_drawn(&foveated);
        assert!(foveated != whole);
        let quality = rgb(&foveated, &whole);
        // The axis, at the tangents of the frusta.
        let [left, right, up, down] = view.fov_degrees.map(|angle| angle.to_radians().tan());
        let axis = [-left / (right - left), up / (up - down)].map(|at| (at * 512.0) as u32);
        let fovea = |image: &RgbImage| {
            image::imageops::crop_imm(image, axis[0] - 40, axis[1] - 40, 80, 80).to_image()
        };
        let in_fovea = rgb(&fovea(&foveated), &fovea(&whole));
        println!("view {i}: {quality:?}, in the fovea {in_fovea:?}");
        assert!(quality.psnr.0 > 24.0 && in_fovea.psnr.0 > 45.0, "view {i}: {quality:?}, {in_fovea:?}");
    }
}

/// At half the rate the runtime makes every second frame of colour, depth and motion vectors of both eyes, by either
/// extension, of whole eyes and of foveated ones. The frame that the simulated runtime makes is what is to be seen then.
#[test]
fn the_runtime_makes_the_frames_between_of_motion_vectors() {
    let script = Script {
        eyes: asymmetric([256; 2]),
        vector_size: [64, 64],
        velocity: [5.0, 1.5, -4.0],
        pictures: pictures(),
        ..Script::default()
    };
    let settings = Settings::resolve(None, CHEAP.map(str::to_owned)).unwrap();
    let extensions = ["XR_EXT_frame_synthesis", "XR_FB_space_warp"];
    // The truth is not foveated.
    for (method, foveation, missing, least) in [
        ("yoro", "off", None, 4.0),
        ("yoro", "off", Some(0), 4.0),
        ("yoro", "medium", Some(0), 2.0),
        ("conventional", "off", None, 4.0),
    ] {
        let what = format!("{method}, foveation {foveation}, without {missing:?}");
        let missing_extensions = missing.into_iter().map(|i| extensions[i].to_owned()).collect();
        let simulated = Simulated::new(&Script { missing_extensions, ..script.clone() });
        let run = simulated.succeed(&format!(
            "--method {method} --frames 5 --set frame-rate=half --set foveation={foveation} --capture captured --json"
        ));
        assert_eq!(run.json()["makes-frames"], extensions[missing.map_or(0, |i| 1 - i)], "{what}");
        let moving: Vec<_> =
            simulated.views().into_iter().filter(|(_, views)| views[0].synthesis.is_some()).collect();
        assert!(moving.len() >= 4, "{what}: {}", moving.len());
        let (_, views) = moving.last().unwrap();
        for view in views {
            let synthesis = view.synthesis.as_ref().unwrap();
            assert_eq!(synthesis.is_space_warp, missing.is_some(), "{what}");
            assert_eq!((synthesis.vectors.rect[2], synthesis.is_flat), (64, false), "{what}");
        }
        // Every second frame of the display: half of the time to the next one is one refresh.
        let later = Vec3::from(script.velocity) / script.refresh_rates[0];
        let (_, pair, _) = captured(simulated.folder.path(), &run.json()).remove(0);
        let room_to_scene = pair.poses[0].orientation * Quat::from_array(views[0].orientation).inverse();
        let moved = |pose: Pose| Pose { position: pose.position + room_to_scene * later, ..pose };
        let pair = EyePair { poses: pair.poses.map(moved), ..pair };
        let truth = desktop("prototype", Method::Conventional, &pair, &settings);
        for (i, truth) in truth.iter().enumerate() {
            let picture = |name: &str| rgb(&simulated.picture(&format!("{name}-{i}.png")), truth);
            let [made, last] = [picture("between"), picture("view")];
            println!("{what}: eye {i}: {made:?}, the last frame {last:?}");
            assert!(made.psnr.0 > last.psnr.0 + least, "{what}: eye {i}: {made:?}, {last:?}");
        }
    }
}

/// A jump is no motion, and with a runtime without extensions every frame is rendered.
#[test]
fn jumps_are_not_extrapolated() {
    let events = vec![event(At::Frame(8), What::Recenter(30.0))];
    let script = Script { events, ..Script::default() };
    let simulated = Simulated::new(&script);
    simulated.succeed("--frames 10 --set frame-rate=half");
    let without: Vec<u32> = simulated
        .views()
        .into_iter()
        .filter(|(frame, views)| *frame > 3 && views[0].synthesis.is_none())
        .map(|(frame, _)| frame)
        .collect();
    assert_eq!(without.len(), 1, "{without:?}");

    // The other extension has a word for it.
    let missing_extensions = vec!["XR_EXT_frame_synthesis".to_owned()];
    let simulated = Simulated::new(&Script { missing_extensions, ..script });
    simulated.succeed("--frames 10 --set frame-rate=half");
    let skipped = |(_, views): &(u32, Vec<View>)| views[0].synthesis.as_ref().is_some_and(|s| s.is_skipped);
    let views = simulated.views();
    assert!(views.iter().all(|(_, views)| views[0].synthesis.is_some()));
    assert_eq!(views.iter().filter(|frame| frame.0 > 3 && skipped(frame)).count(), 1, "{views:#?}");

    let missing_extensions = ["XR_EXT_frame_synthesis", "XR_FB_space_warp"].map(str::to_owned).into();
    let simulated = Simulated::new(&Script { missing_extensions, ..Script::default() });
    let run = simulated.succeed("--frames 4 --set frame-rate=half --json");
    assert_eq!(run.json()["makes-frames"], Value::Null);
    assert!(run.stderr.contains("frame-rate=half needs a headset whose runtime"), "{}", run.stderr);
    assert!(simulated.views().iter().all(|(_, views)| views[0].synthesis.is_none()));
}

/// Monado's service with its own folder.
struct Monado {
    programs: PathBuf,
    folder: TempDir,
    _service: Running,
}

impl Monado {
    /// Starts the service. Returns `None` if the tests have to run without it.
    fn start() -> Option<Monado> {
        let Some(programs) = std::env::var_os("YORO_TEST_MONADO").map(PathBuf::from) else {
            let without = std::env::var_os("YORO_TEST_WITHOUT_MONADO").is_some();
            assert!(
                without,
                "set YORO_TEST_MONADO to the folder of `cargo xtask maintain monado`, or YORO_TEST_WITHOUT_MONADO=1"
            );
            return None;
        };
        let folder = tempfile::tempdir().unwrap();
        let service = monado::start(&programs.join("monado-service"), folder.path()).unwrap();
        Some(Monado { programs, folder, _service: service })
    }

    fn log(&self) -> String {
        fs::read_to_string(self.folder.path().join("service.log")).unwrap()
    }
}

#[test]
fn monado_shows_what_the_desktop_renders() {
    let Some(monado) = Monado::start() else { return };
    let methods = ["conventional", "instanced", "multiview", "hybrid", "yoro"];
    let mut command = Command::new(monado.programs.join("run"));
    command
        .arg(env!("CARGO_BIN_EXE_yoro"))
        .args(["xr", "--method", &methods.join(","), "--frames", "20", "--capture", "captured", "--json"])
        .args(cheap())
        .env("XDG_RUNTIME_DIR", monado.folder.path())
        .env_remove("RUST_LOG")
        .stdin(Stdio::null())
        .current_dir(&monado.folder);
    let run = finish(&mut command);
    assert_eq!(run.code, Some(0), "{}\n{}", run.stderr, monado.log());
    let summary = run.json();
    let states: BTreeSet<&str> =
        summary["states"].as_array().unwrap().iter().map(|state| state.as_str().unwrap()).collect();
    assert!(states.contains("FOCUSED") && states.contains("EXITING"), "{states:?}");
    assert_eq!(summary["restarts"], 0);
    let frames: Vec<(&str, u64)> = summary["methods"]
        .as_array()
        .unwrap()
        .iter()
        .map(|m| (m["method"].as_str().unwrap(), m["frames"].as_u64().unwrap()))
        .collect();
    assert_eq!(frames.iter().map(|(method, _)| *method).collect::<Vec<_>>(), methods);
    assert!(frames.iter().all(|(_, frames)| *frames >= 20), "{frames:?}");
    let settings = |samples: &str| {
        Settings::resolve(None, CHEAP.into_iter().chain([samples]).map(str::to_owned)).unwrap()
    };
    for (method, pair, eyes) in captured(monado.folder.path(), &summary) {
        // This machine's Mesa may lack multiview, which draws one sample where the driver resolves no layers in a tile.
        let expected = match method {
            Method::Multiview => desktop("prototype", Method::Conventional, &pair, &settings(ONE_SAMPLE)),
            _ => desktop("prototype", method, &pair, &settings("msaa=4")),
        };
        for (eye, mut expected) in eyes.iter().zip(expected) {
            // Monado's visibility mask hides the corners.
            let mut hidden = 0;
            for (seen, expected) in eye.pixels().zip(expected.pixels_mut()) {
                if seen.0 == [0; 3] {
                    *expected = *seen;
                    hidden += 1;
                }
            }
            let share = f64::from(hidden) / f64::from(pair.size[0] * pair.size[1]);
            assert!((0.02..0.15).contains(&share), "{method:?}: {share} of the image is hidden");
            let quality = rgb(eye, &expected);
            assert!(quality.ssim_gaussian > 0.99, "{method:?}: {quality:?}");
        }
    }
}
