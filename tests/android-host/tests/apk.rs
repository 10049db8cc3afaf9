//! Runs the built APK's own library in the simulated Android host. `cargo xtask test` builds it and sets
//! `YORO_TEST_APK`.

mod host;

use std::path::Path;

use glam::{EulerRot, Quat};
use image::RgbImage;
use yoro_context::{Backend, Headless};
use yoro_gl::{Destination, Filter, Format, RenderTarget};
use yoro_lenses::{Rotation, Screen};
use yoro_metrics::{Channels, psnr};
use yoro_settings::Settings;
use yoro_settings::telemetry::{self, Line};
use yoro_test_support::glb;
use yoro_viewer::{Cardboard, FrameTiming, HeldHead, SceneState};

use yoro_android_host::summary::Summary;
use yoro_openxr_stub::log::{self, Entry, Layer, View};
use yoro_openxr_stub::script::{Eye, Fault, Pictures, Script as Headset};

use host::{READY, Run, asset, device, layer, play, play_arm64, show};

/// The settings of all devices, and of the desktop for comparison. A CPU renders this scene and quality quickly.
const SETTINGS: [(&str, &str); 7] = [
    ("scene", "prototype"),
    ("method", "yoro"),
    ("hud", "false"),
    ("shadow-map", "512"),
    ("msaa", "1"),
    ("bloom", "false"),
    ("render-scale", "0.5"),
];
const SIZE: [u32; 2] = [320, 180];
const DPI: f32 = 74.0;

/// Returns the settings of all tests, with those of one test replacing them.
fn settings<'a>(own: &[(&'a str, &'a str)]) -> Vec<(&'a str, &'a str)> {
    let is_shared = |(key, _): &&(&str, &str)| !own.iter().any(|(other, _)| other == key);
    SETTINGS.iter().filter(is_shared).chain(own).copied().collect()
}

/// Returns a phone with the settings of all tests and `more`, and further keys of `[device]`.
fn phone(more: &[(&str, &str)], keys: &str) -> String {
    device(&settings(more), keys)
}

fn lines(run: &Run) -> Vec<Line> {
    let lines: Vec<_> = run
        .summary
        .log_of("YORO")
        .filter(|text| text.starts_with("v=2,") && !text.contains("summary="))
        .collect();
    lines.iter().map(|line| line.parse().unwrap_or_else(|error| panic!("{line}: {error}"))).collect()
}

/// Returns the picture that the desktop renders with the same settings. `yaw_degrees` fixes the direction of the head.
fn desktop(extra: &[(&str, &str)], yaw_degrees: Option<f32>) -> RgbImage {
    desktops(extra, &[yaw_degrees]).remove(0)
}

/// Returns the pictures that the desktop renders in several directions of the head.
fn desktops(extra: &[(&str, &str)], yaws_degrees: &[Option<f32>]) -> Vec<RgbImage> {
    let pairs = SETTINGS.iter().chain(extra).map(|(key, value)| format!("{key}={value}"));
    let screen = Screen { size: SIZE, dpi: [DPI; 2], rotation: Rotation::LandscapeLeft };
    let mut viewer = Cardboard::new(Settings::resolve(None, pairs).unwrap(), screen, &[]).unwrap();
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    viewer.attach(gl.clone()).unwrap();
    let window = RenderTarget::new(gl, SIZE, &[(Format::Rgba8, Filter::Nearest)], None).unwrap();
    while viewer.viewer().scene_state() == SceneState::Loading {
        viewer.viewer_mut().poll_scene();
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert_eq!(viewer.viewer().scene_state(), SceneState::Ready);
    let mut now_ns = 0;
    let mut picture = |yaw_degrees: &Option<f32>| {
        viewer.hold_head(yaw_degrees.map(|degrees| {
            let head = Quat::from_euler(EulerRot::YXZ, degrees.to_radians(), 0.0, 0.0);
            HeldHead { rendered: head, displayed: head }
        }));
        for _ in 0..3 {
            now_ns += 16_666_667;
            let timing = FrameTiming { now_ns, expected_display_ns: now_ns + 33_333_333, refresh_hz: 60.0 };
            viewer.frame(&Destination::whole(&window), &timing).unwrap();
        }
        let pixels = window.read_rgba8(0, [0, 0], SIZE);
        RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| {
            let at = (((SIZE[1] - 1 - y) * SIZE[0] + x) * 4) as usize;
            image::Rgb([pixels[at], pixels[at + 1], pixels[at + 2]])
        })
    };
    yaws_degrees.iter().map(&mut picture).collect()
}

fn decibels(one: &RgbImage, other: &RgbImage) -> f64 {
    psnr(one, other, Channels::Rgb).unwrap().0
}

#[test]
fn boots_to_the_first_frame() {
    let Some(run) = show("boot", &phone(&[], ""), r#"{ frames = 2 }, { capture = "boot.png" }"#) else {
        return;
    };
    assert!(run.summary.frames >= 5);
    let picture = run.picture("boot.png");
    let colours: std::collections::HashSet<_> = picture.pixels().collect();
    assert!(colours.len() > 100, "the picture has {} colours", colours.len());
    // The window is filled with magenta after each swap, which remains visible where nothing is drawn.
    assert!(!colours.contains(&image::Rgb([255, 0, 255])), "parts of the window are not drawn");
    assert_eq!(run.summary.trapped_symbols, Vec::<String>::new());

    // The GPU is at most one frame behind, and the application requests sustained performance.
    let Summary { frames, gl, requests, .. } = &run.summary;
    assert!(gl.waits + 2 >= *frames, "{} waits for the GPU in {frames} frames", gl.waits);
    let asked = |what: &str| requests.get(what).copied().unwrap_or(0);
    for once in ["60 Hz", "sustained performance on", "hints for 1 thread, 16.7 ms"] {
        assert_eq!(asked(once), 1, "{once}: {requests:?}");
    }
    assert!(asked("work duration") + 2 >= *frames, "{requests:?} in {frames} frames");
    assert!(run.summary.log_of("YORO").any(|text| text == "Android says when a frame is seen"));
    // Why it is no headset.
    assert_display(&run, "no broker at org.khronos.openxr.runtime_broker");
    assert_display(&run, "Cardboard");
}

#[test]
fn a_lower_resolution_is_the_same_screen() {
    // The display has 427 x 240 pixels at 74 dpi, which the user has reduced to 320 x 180.
    let device = phone(&[], "mode = [427, 240]");
    let Some(run) = play("resolution", &device, r#""launch", { frames = 2 }, "quit""#) else { return };
    run.assert_clean();
    let line = run.summary.log_of("YORO").find(|text| text.starts_with("viewer: ")).unwrap();
    assert!(line.ends_with("screen [146.6, 82.4] mm"), "{line}");
}

#[test]
fn the_phone_draws_the_same_picture_as_the_desktop() {
    let Some(run) = show("picture", &phone(&[], "sensors = false"), r#"{ capture = "phone.png" }"#) else {
        return;
    };
    let (phone, desktop) = (run.picture("phone.png"), desktop(&[], None));
    let differing = phone
        .pixels()
        .zip(desktop.pixels())
        .filter(|(one, other)| one.0.iter().zip(other.0).any(|(one, other)| one.abs_diff(other) > 2))
        .count();
    let share = differing as f64 / f64::from(SIZE[0] * SIZE[1]);
    run.keep("desktop.png", &desktop);
    assert!(
        share < 0.005,
        "{:.2} % of the pixels differ from the desktop's: {}",
        share * 100.0,
        run.folder()
    );
}

#[test]
fn turning_the_head_turns_the_picture() {
    let steps = r#"{ head = { yaw = 20, seconds = 0.5 } }, { seconds = 0.5 }, { capture = "left.png" }"#;
    let Some(run) = show("turn", &phone(&[], ""), steps) else { return };
    let phone = run.picture("left.png");
    let at = |degrees| decibels(&phone, &desktop(&[], Some(degrees)));
    let (exact, less, more, other_way) = (at(20.0), at(18.0), at(22.0), at(-20.0));
    assert!(
        exact > less + 2.0 && exact > more + 2.0 && exact > other_way + 5.0,
        "20 degrees: {exact:.1} dB, 18: {less:.1}, 22: {more:.1}, -20: {other_way:.1}"
    );
}

/// The head turns at 45 degrees per second when the picture is taken.
#[test]
fn the_picture_shows_the_head_at_the_time_it_is_seen() {
    let steps = r#"{ head = { yaw = 60, seconds = 2.0, go_on = true } }, { seconds = 1.0 }, { capture = "turning.png" }"#;
    let picture = |refreshes: u32| {
        // Without profiling: measured GPU time would be added to the delay, and it is not on the virtual clock.
        let keys = format!("refreshes_ahead = {refreshes}\nslept_seconds = 3600");
        let device = phone(&[("profiling", "false")], &keys);
        Some(show(&format!("ahead-{refreshes}"), &device, steps)?.picture("turning.png"))
    };
    let (Some(soon), Some(later)) = (picture(2), picture(5)) else { return };
    let yaws: Vec<f32> = (0..10).map(|i| 29.25 + 0.75 * i as f32).collect();
    let desktops = desktops(&[], &yaws.iter().copied().map(Some).collect::<Vec<_>>());
    let [soon, later] = [soon, later].map(|picture| {
        let likeness = |i: &usize| decibels(&picture, &desktops[*i]);
        (0..yaws.len()).max_by(|a, b| likeness(a).total_cmp(&likeness(b))).map(|i| yaws[i]).unwrap()
    });
    // Three refreshes of 1/60 s correspond to 2.25 degrees.
    assert!((1.5..=3.0).contains(&(later - soon)), "{soon} and {later} degrees");
}

#[test]
fn a_long_press_opens_the_menu_and_another_recenters() {
    let steps = r#"{ capture = "before.png" }, { head = { yaw = 35, seconds = 0.5 } }, { long-press = {} },
        { seconds = 0.3 }, { capture = "menu.png" }, { long-press = {} }, { seconds = 0.3 }, { capture = "after.png" }"#;
    let Some(run) = show("recenter", &phone(&[], ""), steps) else { return };
    assert!(run.summary.log_of("YORO").any(|text| text == "menu: open"));
    assert!(run.summary.log_of("YORO").any(|text| text == "recentered"));
    let before = run.picture("before.png");
    let same = decibels(&before, &run.picture("after.png"));
    let turned = decibels(&before, &desktop(&[], Some(35.0)));
    assert!(
        same > turned + 5.0,
        "straight ahead before and after: {same:.1} dB, 35 degrees apart: {turned:.1} dB"
    );
    let panel = decibels(&run.picture("menu.png"), &desktop(&[], Some(35.0)));
    assert!(panel < same, "the panel is in view: {panel:.1} dB, {same:.1} dB without it");
}

#[test]
fn taps_switch_methods_and_keys_the_ipd() {
    let steps = r#"{ seconds = 1.2 }, { tap = {} }, { seconds = 1.2 }, { key = "headset" }, { seconds = 1.2 },
        { key = "volume-up" }, { key = "volume-down" }, { property = { name = "debug.yoro.method", value = "conventional" } },
        { seconds = 2.2 }"#;
    let Some(run) = show("taps", &phone(&[("method", "yoro")], ""), steps) else { return };
    let mut methods: Vec<_> = lines(&run).into_iter().map(|line| line.method).collect();
    methods.dedup();
    assert_eq!(methods, ["yoro", "conventional", "mono", "conventional"]);
    assert_eq!(run.summary.log_of("YORO").filter(|text| text.starts_with("ipd: ")).count(), 2);
    assert_eq!(run.summary.input.sent, run.summary.input.finished);
    assert_eq!(run.summary.input.sent, run.summary.input.handled);
}

#[test]
fn telemetry_reports_battery_and_heat() {
    let battery = r#"
        [device.battery]
        level = 57
        millivolts = 3805
        decidegrees = 298
        plugged = 2
        status = 2
        current_now = 412000
        charge_counter = 2280000
        [device.thermal]
        status = 1
        headroom = 0.61
    "#;
    let Some(run) = show("telemetry", &(phone(&[], "") + battery), "{ seconds = 3.5 }") else { return };
    let lines = lines(&run);
    assert!((3..=4).contains(&lines.len()), "{} lines in 3.5 seconds", lines.len());
    let last = lines.last().unwrap();
    assert_eq!(
        (last.current_raw, last.voltage_mv, last.level_percent, last.plugged),
        (Some(412_000), Some(3805), Some(57), Some(2))
    );
    assert_eq!((last.charge_uah, last.thermal_status), (Some(2_280_000), Some(1)));
    assert!((last.battery_celsius.unwrap() - 29.8).abs() < 0.01);
    assert!((last.thermal_headroom.unwrap() - 0.61).abs() < 0.01);
    assert_eq!((last.refresh_hz, last.performance.as_deref()), (Some(60.0), Some("sustained/hints")));
    // Every frame takes one refresh on the virtual clock.
    assert!((last.fps.unwrap() - 60.0).abs() < 1.0, "{last}");
    assert_eq!(last.stale, Some(0), "{last}");
}

#[test]
fn runs_without_battery_and_sensors() {
    let steps = format!(r#""launch", "battery-missing", {READY}, {{ seconds = 2.5 }}, "quit""#);
    let Some(run) = play("bare", &phone(&[], "sensors = false\nsdk = 29"), &steps) else { return };
    run.assert_clean();
    let lines = lines(&run);
    let last = lines.last().expect("a telemetry line");
    assert_eq!(
        (last.current_raw, last.voltage_mv, last.level_percent, last.charge_uah, last.plugged),
        (None, None, None, None, None)
    );
    // Thermal status exists since API level 30, headroom since 31.
    assert_eq!((last.thermal_status, last.thermal_headroom), (None, None));
    assert!(run.summary.log_of("YORO").any(|text| text.contains("no gyroscope")));
    // A refresh rate can be requested since API level 30, and hints are accepted since 33.
    assert_eq!(run.summary.requests.keys().collect::<Vec<_>>(), ["sustained performance on"]);
    assert!(run.summary.log_of("YORO").any(|text| text.contains("does not say when a frame is seen")));
}

#[test]
fn opengl_es_3_0_is_enough() {
    let device = phone(&[("pipeline", "paper")], "gles = \"3.0\"\nsensors = false");
    let Some(run) = show("es30", &device, r#"{ seconds = 1.2 }, { capture = "es30.png" }"#) else { return };
    assert!(run.summary.gl.version.contains("ES 3.0"), "{}", run.summary.gl.version);
    assert_eq!(lines(&run).last().unwrap().pipeline.as_deref(), Some("gather"));
    let (phone, desktop) = (run.picture("es30.png"), desktop(&[], None));
    assert!(decibels(&phone, &desktop) > 30.0, "{:.1} dB", decibels(&phone, &desktop));
}

#[test]
fn opengl_es_2_0_ends_in_one_clear_message() {
    let Some(run) = play("es20", &phone(&[], "gles = \"2.0\""), r#""launch", { idle = 2.0 }, "quit""#) else {
        return;
    };
    assert_eq!(run.summary.failure, None);
    assert_eq!(run.summary.violations, Vec::<String>::new());
    let errors = run.summary.log.iter().filter(|line| line.priority == 'E' && line.tag == "YORO").count();
    assert_eq!(errors, 1, "{:#?}", run.summary.log);
    let toasts = run.summary.jni_invented.iter().filter(|(call, _)| call.contains("Toast.makeText"));
    assert_eq!(toasts.map(|(_, times)| times).sum::<u64>(), 1, "{:#?}", run.summary.jni_invented);
}

#[test]
fn without_a_choreographer_the_swap_sets_the_pace() {
    // An API level without `AChoreographer_postFrameCallback64`.
    let Some(run) = show("choreographer", &phone(&[], "sdk = 28"), "{ frames = 20 }") else { return };
    assert!(
        run.summary.log_of("YORO").any(|line| line.contains("no choreographer")),
        "{:#?}",
        run.summary.log
    );
    assert!(run.summary.frames >= 20, "{}", run.summary.frames);
}

#[test]
fn lifecycle_torture_leaks_nothing() {
    let Some(run) = play("torture", &phone(&[], ""), &(host::script("torture.toml"))) else { return };
    run.assert_clean();
    let mark = |name: &str| run.summary.mark(name).unwrap();
    assert_eq!(mark("warm").objects(), mark("pauses").objects());
    assert_eq!(mark("warm").objects(), mark("windows").objects());
    for name in ["gone", "gone again"] {
        let mark = mark(name);
        assert!(mark.gl_objects.is_empty(), "{}", mark.objects());
        assert_eq!(
            (mark.egl_contexts, mark.egl_surfaces, mark.window_references),
            (0, 0, 0),
            "{}",
            mark.objects()
        );
    }
    assert_eq!(mark("gone").objects(), mark("gone again").objects());
    let grown = mark("pauses").resident_kib.saturating_sub(mark("warm").resident_kib);
    assert!(grown < 8 * 1024, "100 cycles of pause and resume took {grown} KiB");
}

#[test]
fn a_lost_context_is_made_again() {
    let Some(run) = play("loss", &phone(&[], "sensors = false"), &host::script("context-loss.toml")) else {
        return;
    };
    assert!(run.summary.is_clean(), "{}", run.summary);
    assert_eq!(
        run.summary.log.iter().filter(|line| line.priority == 'E' && line.text.contains("lost")).count(),
        10
    );
    assert_eq!(run.summary.gl.contexts, 11);
    assert_eq!(run.summary.mark("first").unwrap().gl_objects, run.summary.mark("last").unwrap().gl_objects);
    assert_eq!(run.picture("before.png"), run.picture("after.png"));
}

#[test]
fn a_session_ends_by_itself() {
    let device = phone(&[("duration", "2")], "");
    let Some(run) = play("session", &device, r#""launch", { wait-finish = { frames = 3000 } }, "quit""#)
    else {
        return;
    };
    run.assert_clean();
    assert_eq!(run.summary.log_of("YORO").filter(|text| text.starts_with("v=2,summary=1,")).count(), 1);
}

#[test]
fn settings_come_from_file_extras_and_properties() {
    let outside = r#"
        [device.files]
        "yoro.toml" = "method = \"mono\"\nipd = 0.05\nviewpoint = 7\n"
        [device.extras]
        method = "conventional"
        ipd = "0.06"
        [device.properties]
        "debug.yoro.ipd" = "0.061"
        "debug.yoro.scene" = "prototype"
        "debug.yoro.shadow-map" = "512"
        "debug.yoro.refresh-rate" = "30"
        "debug.yoro.performance" = "boost"
    "#;
    let Some(run) = show("settings", &format!("[device]\n{outside}"), "{ seconds = 1.2 }") else { return };
    let settings = run.summary.log_of("YORO").find(|text| text.starts_with("settings: ")).unwrap();
    assert!(
        settings.contains("method=\"conventional\"")
            && settings.contains("ipd=0.061")
            && settings.contains("viewpoint=7"),
        "{settings}"
    );
    assert_eq!(
        run.summary.requests.keys().collect::<Vec<_>>(),
        ["30 Hz", "hints for 1 thread, 33.3 ms", "sustained performance off", "work duration"]
    );
}

#[test]
fn survives_random_events() {
    let Some(run) = play("random", &phone(&[], ""), &host::script("random.toml")) else { return };
    assert!(run.summary.is_clean(), "{}", run.summary);
    let losses = |text: &str| text.contains("lost the OpenGL ES context");
    let errors: Vec<_> =
        run.summary.log.iter().filter(|line| line.priority == 'E' && !losses(&line.text)).collect();
    assert!(errors.is_empty(), "{errors:#?}");
    assert_eq!(run.summary.input.sent, run.summary.input.finished);
    let end = run.summary.mark("end").unwrap();
    assert!(
        end.gl_objects.is_empty()
            && end.egl_contexts == 0
            && end.egl_surfaces == 0
            && end.window_references == 0,
        "{}",
        end.objects()
    );
}

/// Returns a `[device]` with a headset, whose runtime writes its log and pictures to `folder`.
fn headset(folder: &Path, system: bool) -> String {
    headset_with(folder, Headset::default().asymmetric(), &[], &format!("system = {system}"))
}

/// Returns a `[device]` with a headset that has this script, and with further settings and keys of `[device.openxr]`.
fn headset_with(folder: &Path, script: Headset, more: &[(&str, &str)], keys: &str) -> String {
    let script = Headset {
        log: Some(folder.join("log.jsonl")),
        poison: true,
        pictures: Some(Pictures { folder: folder.into(), from: 1 }),
        ..script
    };
    let path = folder.join("headset.json");
    std::fs::write(&path, serde_json::to_string(&script).unwrap()).unwrap();
    let mut settings = settings(more);
    settings.retain(|(key, _)| *key != "render-scale");
    let keys = format!("[device.openxr]\nscript = {:?}\n{keys}", path.display().to_string());
    format!("{}\n{keys}", device(&settings, ""))
}

const IMMERSIVE: &str = r#""launch", { wait-log = { text = "display: headset", frames = 10 } },
    { wait-log = { text = "triangles", frames = 2000 } }, { frames = 8 }, "pause", "resume", { frames = 4 }, "quit""#;

fn assert_immersive(run: &Run, folder: &Path) -> [RgbImage; 2] {
    run.assert_clean();
    assert_display(run, "headset, by OpenXR 1.1.54 runtime");
    let log = log::read(&folder.join("log.jsonl"));
    assert!(!log.iter().any(is_violation), "{log:#?}");
    assert_both_eyes(&log, folder)
}

fn is_violation(entry: &Entry) -> bool {
    matches!(entry, Entry::Violation { .. })
}

/// Checks that the application has shown all frames on this display.
fn assert_display(run: &Run, which: &str) {
    let display: Vec<_> = run.summary.log_of("YORO").filter(|line| line.starts_with("display:")).collect();
    assert!(!display.is_empty() && display.iter().all(|line| line.contains(which)), "{display:?}");
}

/// Checks that the runtime got two views from an Android application, drawn up to their edges. Returns the last two.
fn assert_both_eyes(log: &[Entry], folder: &Path) -> [RgbImage; 2] {
    assert!(log.iter().any(|entry| matches!(entry, Entry::Instance { android: true, .. })));
    assert!(log.iter().any(|entry| matches!(entry, Entry::Session { binding } if binding == "android")));
    // XR_ANDROID_THREAD_TYPE_RENDERER_MAIN_KHR.
    assert!(log.contains(&Entry::Request { what: "thread".into(), value: 3.0 }));
    let shown = |entry: &&Entry| matches!(entry, Entry::Frame { layers, .. } if layers.iter().any(|layer| matches!(layer, Layer::Projection { views } if views.len() == 2)));
    assert!(log.iter().filter(shown).count() >= 8);
    let views = [0, 1].map(|view| image::open(folder.join(format!("view-{view}.png"))).unwrap().into_rgb8());
    for view in &views {
        let colours: std::collections::HashSet<_> = view.pixels().collect();
        assert!(colours.len() > 100, "a view has {} colours", colours.len());
        assert!(!colours.contains(&image::Rgb([255, 0, 255])), "parts of a view are not drawn");
    }
    assert!(views[0] != views[1]);
    views
}

#[test]
fn a_headset_is_found_through_the_broker() {
    let folder = tempfile::tempdir().unwrap();
    let Some(run) = play("headset", &headset(folder.path(), true), IMMERSIVE) else { return };
    assert_immersive(&run, folder.path());
}

#[test]
fn a_second_activity_uses_the_loaded_runtime() {
    let folder = tempfile::tempdir().unwrap();
    let again = r#""launch", { wait-log = { text = "triangles", frames = 2000 } }, { frames = 4 }, "quit""#;
    let steps = format!("{IMMERSIVE}, {again}");
    let Some(run) = play("headset-again", &headset(folder.path(), false), &steps) else { return };
    // The runtime returns an error if it is initialised twice.
    assert_immersive(&run, folder.path());
    let log = log::read(&folder.path().join("log.jsonl"));
    assert_eq!(log.iter().filter(|entry| matches!(entry, Entry::Instance { .. })).count(), 2);
}

#[test]
fn a_headset_whose_runtime_fails_ends_the_application() {
    let unusable =
        Headset { missing_extensions: vec!["XR_KHR_opengl_es_enable".into()], ..Headset::default() };
    let fault = Fault { call: "xrWaitFrame".into(), nth: 3, and_later: true, result: -2 };
    let broken = Headset { faults: vec![fault], ..Headset::default() };
    for (script, reason) in [(unusable, "XR_KHR_opengl_es_enable"), (broken, "xrWaitFrame")] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("headset.json");
        std::fs::write(&path, serde_json::to_string(&script).unwrap()).unwrap();
        let keys = format!(
            "[device.features]\n\"android.hardware.vr.headtracking\" = 1\n[device.openxr]\nscript = {:?}",
            path.display().to_string()
        );
        let device = format!("{}\n{keys}", phone(&[], ""));
        let steps = r#""launch", { wait-finish = { frames = 3000 } }, "quit""#;
        let Some(run) = play("headset-fails", &device, steps) else { return };
        assert!(run.summary.is_clean(), "{}", run.summary);
        let display: Vec<_> =
            run.summary.log_of("YORO").filter(|line| line.starts_with("display:")).collect();
        assert!(
            display
                .last()
                .is_some_and(|line| line.starts_with("display: none, since") && line.contains(reason))
                && !display.iter().any(|line| line.contains("Cardboard")),
            "{display:?}"
        );
    }
}

/// Returns a device with a headset on which the application renders a single view through the API layer's Android
/// library, which is in this AAR.
fn layered(folder: &Path, script: Headset, aar: &Path, layer: &[(&str, &str)]) -> String {
    let own = [("one-view", "true"), ("method", "mono")];
    let settings: Vec<_> = own.iter().chain(layer).copied().collect();
    headset_with(folder, script, &settings, &format!("layer = {:?}", aar.display().to_string()))
}

/// Returns the layer's lines in logcat, without its prefix.
fn said(run: &Run) -> Vec<&str> {
    run.summary.log_of("yoro").filter_map(|line| line.strip_prefix("yoro layer: yoro: ")).collect()
}

/// Checks that the layer's library is loaded as on Android, nothing forbidden was done, and both eyes were shown.
fn assert_layered(run: &Run, folder: &Path) -> [RgbImage; 2] {
    assert!(run.summary.is_clean(), "{}\n{:#?}", run.summary, run.summary.log);
    assert_display(run, "headset, by OpenXR by the loader libopenxr_loader.so");
    let libraries = &run.summary.libraries;
    assert!(
        matches!(libraries.as_slice(), [_, layer] if layer.ends_with("/libyoro_openxr_layer.so")),
        "{libraries:?}"
    );
    let log = log::read(&folder.join("log.jsonl"));
    // A layer may look up functions of extensions that are not enabled, since it cannot know which are.
    let asks =
        |entry: &&Entry| matches!(entry, Entry::Violation { call, .. } if call == "xrGetInstanceProcAddr");
    let violations: Vec<_> = log.iter().filter(|entry| is_violation(entry) && !asks(entry)).collect();
    assert!(violations.is_empty(), "{violations:#?}");
    let ends: Vec<_> = said(run).into_iter().filter(|line| line.starts_with("session ended")).collect();
    assert!(!ends.is_empty() && ends.iter().all(|line| line.ends_with(" synthesized, 0 not")), "{ends:?}");
    let end = run.summary.mark("end").unwrap();
    assert!(end.gl_objects.is_empty() && end.egl_contexts == 0, "{}", end.objects());
    assert_both_eyes(&log, folder)
}

/// Returns the views of the last frame that has any.
fn submitted(folder: &Path) -> [View; 2] {
    let views = |entry| match entry {
        Entry::Frame { layers, .. } => layers.into_iter().find_map(|layer| match layer {
            Layer::Projection { views } => Some(views),
            _ => None,
        }),
        _ => None,
    };
    let log = log::read(&folder.join("log.jsonl"));
    log.into_iter().rev().find_map(views).unwrap().try_into().unwrap()
}

#[test]
fn one_view_through_the_layer_is_what_the_application_synthesizes() {
    let Some(aar) = layer("layer") else { return };
    // The application renders sizes that are multiples of 16 pixels. With this size the layer's eyes are multiples,
    // too: the single view has a width of 192.
    let mut script = Headset::default().asymmetric();
    script.eyes.iter_mut().for_each(|eye| eye.size = [154, 128]);
    // The dominant eye: once the default, once set by a property.
    for (dominant, settings) in [(1, &[][..]), (0, &[("layer.dominant", "left")][..])] {
        let folder = tempfile::tempdir().unwrap();
        let device = layered(folder.path(), script.clone(), &aar, settings);
        let Some(run) = play(&format!("layer-{dominant}"), &device, IMMERSIVE) else { return };
        run.assert_clean();
        let views = assert_layered(&run, folder.path());
        let names = ["left", "right"];
        let begins = format!("renders one view; the {} eye is synthesized", names[1 - dominant]);
        assert_eq!(said(&run).iter().filter(|line| **line == begins).count(), 1, "{:?}", said(&run));

        // The same eyes to the pixel: the edges of the layer's eyes are at pixels of the single view.
        let eyes = submitted(folder.path()).map(|view| {
            let [.., width, height] = view.image.rect.map(|n| n as u32);
            Eye { size: [width, height], fov_degrees: view.fov_degrees, ..Eye::default() }
        });
        let own = tempfile::tempdir().unwrap();
        let settings = [("method", "yoro"), ("dominant", names[dominant]), ("foveation", "off")];
        let device = headset_with(own.path(), Headset { eyes, ..Headset::default() }, &settings, "");
        let Some(run) = play(&format!("layer-none-{dominant}"), &device, IMMERSIVE) else { return };
        let expected = assert_immersive(&run, own.path());
        let [rendered, synthesized] =
            [dominant, 1 - dominant].map(|eye| decibels(&views[eye], &expected[eye]));
        let same = decibels(&views[dominant], &expected[1 - dominant]);
        println!("rendered {rendered:.1} dB, synthesized {synthesized:.1} dB, the same image {same:.1} dB");
        assert!(
            rendered > 40.0 && synthesized > 35.0 && synthesized > same + 10.0,
            "rendered {rendered:.1} dB, synthesized {synthesized:.1} dB, the same image {same:.1} dB"
        );
    }
}

/// All checks use the same run: under qemu, compiling shaders takes most of the time.
#[test]
fn the_arm64_library_does_what_the_x86_64_library_does() {
    let device = phone(&[("method", "yoro")], "sensors = false");
    let steps = format!(
        r#""launch", {READY}, {{ capture = "yoro.png" }}, {{ tap = {{}} }}, {{ wait-log = {{ text = "method: conventional", frames = 60 }} }},
            {{ frames = 3 }}, {{ capture = "conventional.png" }}, "quit""#
    );
    let Some(arm64) = play_arm64("arm64", &device, &steps) else { return };
    arm64.assert_clean();
    assert_eq!(arm64.summary.abi, "arm64-v8a");
    assert_eq!(arm64.summary.trapped_symbols, Vec::<String>::new());
    assert!(arm64.summary.gl.version.starts_with("OpenGL ES 3."), "{}", arm64.summary.gl.version);
    assert!(arm64.summary.input.sent > 0);
    assert_eq!(arm64.summary.input.sent, arm64.summary.input.handled);

    let Some(x86_64) = play("x86_64", &device, &steps) else { return };
    x86_64.assert_clean();
    assert_eq!(x86_64.summary.abi, "x86_64");
    // llvmpipe generates other code for arm64, with vectors of 128 bits, not 256: colours differ slightly, edges do
    // not.
    for picture in ["yoro.png", "conventional.png"] {
        let same = decibels(&arm64.picture(picture), &x86_64.picture(picture));
        assert!(same > 40.0, "{picture}: {same:.1} dB between {} and {}", arm64.folder(), x86_64.folder());
    }
    let methods = decibels(&arm64.picture("yoro.png"), &x86_64.picture("conventional.png"));
    assert!(methods < 40.0, "the two methods' pictures are the same: {methods:.1} dB");
}

/// Each scenario of a game loop plays its steps, writes the results to the intent's file, and ends by itself.
#[test]
fn game_loops_write_their_results_and_end() {
    let folder = tempfile::tempdir().unwrap();
    let lab = folder.path().join("lab");
    let results = lab.join("simulated-36-en-landscape/game_loop_results");
    std::fs::create_dir_all(&results).unwrap();
    for scenario in 1..=3 {
        let file = results.join(format!("results_scenario_{scenario}.json"));
        let keys = format!(
            "extras = {{ seconds = \"3.2\" }}\ngame_loop = {{ scenario = {scenario}, results = {file:?} }}"
        );
        // Properties override a scenario's settings, so the settings that it changes are left out.
        let settings: Vec<_> =
            settings(&[]).into_iter().filter(|(key, _)| !["method", "hud"].contains(key)).collect();
        let steps = r#""launch", { wait-finish = { frames = 3000 } }, "quit""#;
        let Some(run) = play(&format!("game-loop-{scenario}"), &device(&settings, &keys), steps) else {
            return;
        };
        run.assert_clean();
        let pictures: Vec<telemetry::Pictures> =
            run.summary.log_of("YORO").filter_map(|line| line.parse().ok()).collect();
        assert_eq!(pictures.len(), if scenario == 1 { 2 } else { 0 });
        assert!(pictures.iter().all(telemetry::Pictures::passed), "{pictures:?}");
    }
    let captures = yoro_devices::farm::read(&lab, &folder.path().join("captures")).unwrap();
    let methods: Vec<&str> = captures.iter().map(|capture| capture.method.as_str()).collect();
    assert_eq!(methods, ["loop-1-gather", "loop-1-paper", "conventional", "mono", "yoro", "loop-3-yoro"]);
    for capture in captures {
        assert_eq!(capture.outcome, yoro_devices::capture::Outcome::Complete, "{capture:?}");
        let kinds: Vec<_> = capture.faults.iter().map(|fault| fault.kind).collect();
        assert!(!kinds.contains(&yoro_devices::capture::FaultKind::Pictures), "{capture:?}");
        assert!(capture.device.simulated && capture.duration_s >= 3.0, "{capture:?}");
    }

    // Scenario 4 does not exist: the application says so, and ends.
    let device = phone(&[], "game_loop = { scenario = 4 }");
    let Some(run) = play("game-loop-4", &device, r#""launch", { wait-finish = { frames = 300 } }, "quit""#)
    else {
        return;
    };
    assert!(run.summary.log_of("YORO").any(|text| text.starts_with("there is no scenario 4")));
}

/// Writes the picture that a camera sees of a QR code.
fn save_code(text: &str, path: &Path) {
    let code = qrcode::QrCode::new(text).unwrap();
    let (modules, colors) = (code.width() as u32, code.to_colors());
    image::GrayImage::from_fn(7 * (modules + 8), 7 * (modules + 8), |x, y| {
        let [x, y] = [x, y].map(|n| (n / 7).wrapping_sub(4));
        let is_dark = x < modules && y < modules && colors[(y * modules + x) as usize] == qrcode::Color::Dark;
        image::Luma([if is_dark { 30 } else { 220 }])
    })
    .save(path)
    .unwrap();
}

#[test]
fn it_carries_the_notices_of_others() {
    let Some(notices) = asset("notices", "NOTICES.txt") else { return };
    for name in ["\n  ndk ", "\nandroid-properties ", "\nThe font B612 Mono"] {
        assert!(notices.contains(name), "{name}: {notices}");
    }
}

/// Returns the step that waits for a line in the log.
fn wait(text: &str) -> String {
    format!("{{ wait-log = {{ text = {text:?}, frames = 6000 }} }}")
}

/// Returns a tap on the centre of a tile on the start screen, which has four columns and two rows.
fn tile(column: f64, row: u32) -> String {
    let y = [0.635, 0.823][row as usize];
    format!("{{ tap = {{ x = {}, y = {y} }} }}", 0.125 + 0.25 * column)
}

/// Returns a device on which a person starts the application. Its settings file has the settings of all tests.
fn by_hand(keys: &str) -> String {
    let toml: String = SETTINGS
        .iter()
        .map(|(key, value)| match value.parse::<toml::Value>() {
            Ok(_) => format!("{key} = {value}\n"),
            Err(_) => format!("{key} = \"{value}\"\n"),
        })
        .collect();
    format!("[device]\n{keys}\n[device.files]\n\"yoro.toml\" = {toml:?}")
}

/// What a person does first, on a phone without a computer: selects the viewer by holding its code in front of the
/// camera, looks at another scene, compares, and finds the same choices at the next start. Then the phone is held
/// upright, and files and texts are shared.
#[test]
fn a_first_start_by_hand() {
    const URI: &str = "https://google.com/cardboard/cfg?p=CgRBY21lEghQb2NrZXQgNR3sUTg9JY_CdT0qEAAANEIAADRCAAA0QgAANEI1KVwPPToImpmZPs3MzD4";
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).display().to_string();
    save_code(URI, Path::new(&file("code.png")));
    save_code("https://goo.gl/abc", Path::new(&file("short.png")));
    image::GrayImage::from_pixel(640, 480, image::Luma([150])).save(file("wall.png")).unwrap();
    std::fs::write(file("my room.glb"), glb::triangle()).unwrap();

    let device = by_hand(&format!("camera = {:?}", file("wall.png")));
    // When the user leaves, the activity finishes itself, so that the next one receives what is shared.
    let leave = r#""unfocus", "pause", "window-lost", "stop", { wait-finish = { frames = 1 } }, "quit""#;
    let share =
        |key: &str, value: &str| format!("{leave}, {{ share = {{ {key} = {value:?} }} }}, \"launch\"");
    let look = |yaw: f64, pitch: f64| {
        format!("{{ head = {{ yaw = {yaw}, pitch = {pitch}, seconds = 0.3 }} }}, {{ seconds = 1.7 }}")
    };
    let see = |name: &str| format!("{{ camera = {:?} }}", file(name));
    let capture = |name: &str| format!("{{ frames = 2 }}, {{ capture = {name:?} }}");
    let steps = [
        "\"launch\"".to_owned(),
        wait("start screen: shown"),
        capture("first.png"),
        // The user first refuses, then allows it.
        tile(0.0, 1),
        "{ permission = false }".into(),
        wait("yoro may not use the camera"),
        capture("refused.png"),
        tile(0.0, 1),
        "{ permission = true }".into(),
        wait("the camera gives pictures of 640 x 480"),
        "{ seconds = 0.5 }".into(),
        "\"camera-lost\"".into(),
        wait("The camera was lost"),
        see("short.png"),
        tile(0.0, 1),
        wait("https://goo.gl/abc may be a shortened address"),
        see("wall.png"),
        tile(0.0, 1),
        wait("the camera gives pictures"),
        "{ seconds = 0.5 }".into(),
        see("code.png"),
        wait(&format!("scanned: the viewer {URI}")),
        capture("chosen.png"),
        tile(1.0 - 0.2, 1),
        wait("the log is shared"),
        tile(1.0 + 0.2, 1),
        wait("lines of notices"),
        tile(3.0, 1),
        wait("start screen: left"),
        READY.into(),
        "{ seconds = 1 }".into(),
        capture("explained.png"),
        "{ seconds = 8 }, { capture = \"eyes.png\" }, { long-press = {} }".into(),
        wait("menu: open"),
        look(5.0, 2.0),
        wait("menu: scene="),
        wait("triangles"),
        look(5.0, -8.0),
        wait("compare: two real renders"),
        look(15.0, 40.0),
        "{ frames = 2 }, \"quit\", \"launch\"".into(),
        wait("triangles"),
        // Upright in the hand, tilted backwards. Lying on a side does not count as upright.
        "{ head = { roll = 90, seconds = 0.5 } }, { seconds = 2 }".into(),
        capture("again.png"),
        "{ head = { pitch = -30, roll = -90, seconds = 0.5 } }".into(),
        wait("start screen: shown"),
        "{ frames = 2 }".into(),
        share("text", "Look: https://goo.gl/abc"),
        wait("shared: https://goo.gl/abc may be a shortened address"),
        capture("shortened.png"),
        // A picture with a text that is not about a viewer.
        share("text = \"My viewer\", file", &file("code.png")),
        wait(&format!("shared: the viewer {URI}")),
        // The file's owner takes three seconds to open it.
        format!(
            "\"quit\", {{ share = {{ file = {:?}, view = true, after = 3.0 }} }}, \"launch\"",
            file("my room.glb")
        ),
        wait("start screen: shown"),
        capture("reading.png"),
        "{ seconds = 1 }".into(),
        wait("shared: the model my-room"),
        tile(3.0, 1),
        wait("my-room: 1 triangles"),
        "{ frames = 2 }, \"quit\"".into(),
    ];
    let Some(run) = play("first-start", &device, &steps.join(", ")) else { return };
    run.assert_clean();
    assert_eq!(run.summary.jni_invented, Default::default());
    let left: Vec<_> =
        run.summary.marks.last().unwrap().ndk_objects.iter().filter(|(_, n)| **n != 0).collect();
    assert!(!left.iter().any(|(kind, _)| kind.contains("camera") || kind.contains("image")), "{left:?}");
    let log: Vec<&str> = run.summary.log_of("YORO").collect();
    let settings: Vec<&&str> = log.iter().filter(|line| line.starts_with("settings: ")).collect();
    let chosen = format!("viewer=\"{URI}\"");
    assert!(!settings[0].contains(&chosen) && settings.last().unwrap().contains(&chosen), "{settings:#?}");
    let scene = log.iter().find_map(|line| line.strip_prefix("menu: scene=")).unwrap();
    let starts = settings.iter().filter(|line| line.contains(&format!("scene=\"{scene}\""))).count();
    assert!(starts >= 2, "{settings:#?}");
    assert!(settings.last().unwrap().contains("scene=\"my-room.glb\""), "{settings:#?}");
    for what in ["brightness 1", "brightness -1", "another application", "a permission"] {
        assert!(run.summary.requests.contains_key(what), "{what}: {:?}", run.summary.requests);
    }
    let pictures = ["first.png", "refused.png", "chosen.png", "shortened.png", "reading.png"];
    let pictures = pictures.map(|name| run.picture(name));
    for (i, picture) in pictures.iter().enumerate() {
        assert!(!pictures[..i].contains(picture), "picture {i} is one before: {}", run.folder());
    }
    assert!(run.picture("explained.png") != run.picture("eyes.png"));

    // The eyes see what the desktop renders for this viewer, except for the corners.
    let (eyes, mut expected) = (run.picture("eyes.png"), desktop(&[("viewer", URI)], None));
    for (x, y, pixel) in expected.enumerate_pixels_mut() {
        if y < 23 && !(23..SIZE[0] - 23).contains(&x) {
            *pixel = *eyes.get_pixel(x, y);
        }
    }
    let (own, other) = (decibels(&eyes, &expected), decibels(&eyes, &desktop(&[], None)));
    assert!(
        own > 35.0 && own > other + 10.0,
        "{own:.1} dB, {other:.1} dB for the v2 viewer: {}",
        run.folder()
    );
}

#[test]
fn without_a_camera_the_start_screen_says_so() {
    let steps = [
        "\"launch\"".to_owned(),
        wait("start screen: shown"),
        "{ frames = 2 }".into(),
        tile(0.0, 1),
        "{ permission = true }".into(),
        wait("This device has no camera that yoro can use"),
        "{ frames = 2 }, \"quit\"".into(),
    ];
    let Some(run) = play("no-camera", &by_hand(""), &steps.join(", ")) else { return };
    run.assert_clean();
}
