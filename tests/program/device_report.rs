//! `yoro device report`: captures in, a page and tables out. The captures are made up by this test.

use std::fs;
use std::path::Path;

use serde_json::Value;
use yoro_devices::capture::{DeviceInfo, Fault, FaultKind, Outcome, RunInfo, Sample, VERSION, Writer};

use crate::browser::{Browser, check_figures};
use crate::program::{run, succeed};

const SECONDS: u32 = 60;

/// Writes a run with constant power and frame rate.
fn write(
    folder: &Path,
    method: &str,
    scene: &str,
    repetition: u32,
    milliwatts: f64,
    fps: f64,
    faults: &[FaultKind],
) {
    let info = RunInfo {
        version: VERSION,
        device: DeviceInfo {
            serial: "MADEUP1".into(),
            manufacturer: "Maker".into(),
            model: "Model 1".into(),
            android: "14".into(),
            capacity_mah: Some(4000.0),
            simulated: true,
        },
        experiment: Some("made-up".into()),
        method: method.into(),
        scene: scene.into(),
        repetition,
        order: 1,
        settings: [("scene".to_owned(), scene.to_owned())].into(),
        started_unix_s: f64::from(repetition) * 1e4 + milliwatts,
        duration_s: f64::from(SECONDS),
        warm_up_s: 0.0,
        start_celsius: Some(30.0),
        application: None,
        outcome: Outcome::Complete,
        faults: faults
            .iter()
            .map(|kind| Fault { kind: *kind, at_s: Some(3.0), detail: "made up".into() })
            .collect(),
    };
    let mut writer = Writer::create(folder, info).unwrap();
    for second in 0..=SECONDS {
        let sample = Sample {
            time_s: f64::from(second),
            fps: Some(fps),
            stale: Some(1.0),
            frame_ms: Some(1e3 / fps),
            current_ma: Some(-milliwatts / 4.0),
            voltage_mv: Some(4000.0),
            level_percent: Some(80.0),
            plugged: Some(0),
            battery_celsius: Some(31.0 + f64::from(second) / 60.0),
            cpu_percent: Some(40.0),
            rss_mb: Some(180.0),
            ..Sample::default()
        };
        writer.sample(&sample).unwrap();
    }
    writer.finish(Outcome::Complete).unwrap();
}

fn find<'a>(report: &'a Value, list: &str, wanted: &[(&str, &str)]) -> &'a Value {
    let matches = |entry: &&Value| wanted.iter().all(|(key, value)| entry[key].as_str() == Some(value));
    report[list].as_array().unwrap().iter().find(matches).unwrap_or_else(|| panic!("{wanted:?} in {list}"))
}

#[test]
fn known_differences_come_out_and_faults_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let faults: [&[FaultKind]; 3] =
        [&[], &[FaultKind::Disconnected, FaultKind::CurrentSign], &[FaultKind::PluggedIn]];
    for (i, scene) in ["street", "atrium"].into_iter().enumerate() {
        for repetition in 1..=3u32 {
            // The battery drifts, which affects both methods.
            let drift = 1.0 + 0.01 * f64::from(repetition);
            let folder = |method: &str| at.join(format!("captures/{scene}/{method}-{repetition}"));
            write(&folder("conventional"), "conventional", scene, repetition, 500.0 * drift, 30.0, &[]);
            let ours = [0.8, 0.7][i] * 500.0 * drift;
            let faults = if scene == "street" { faults[repetition as usize - 1] } else { &[] };
            write(&folder("yoro"), "yoro", scene, repetition, ours, 60.0, faults);
        }
    }
    write(&at.join("captures/alone"), "hybrid", "talk", 1, 450.0, 45.0, &[]);
    let run = succeed(at, "device report captures --out out");
    assert!(run.stdout.contains("Maker Model 1 (simulated), yoro:"), "{}", run.stdout);
    assert!(run.stdout.contains("plugged in") && run.stdout.contains("12 of 13 runs"), "{}", run.stdout);

    let report: Value = serde_json::from_slice(&fs::read(at.join("out/report.json")).unwrap()).unwrap();
    assert_eq!((&report["simulated"], &report["baseline"]), (&true.into(), &"conventional".into()));
    let near = |value: &Value, expected: f64| {
        let value = value.as_f64().unwrap_or_else(|| panic!("{value} is no number"));
        assert!((value - expected).abs() < 1e-3, "{value} is not {expected}");
    };
    let street = find(&report, "differences", &[("scene", "street"), ("quantity", "power")]);
    // A charger was plugged in during one of the three pairs.
    assert_eq!(street["pairs"], 2);
    near(&street["change"], -20.0);
    let all = report["differences"].as_array().unwrap().iter();
    let all = all.filter(|d| d["scene"].is_null() && d["method"] == "yoro").collect::<Vec<_>>();
    let of = |quantity: &str| all.iter().find(|d| d["quantity"] == quantity).unwrap();
    near(&of("power")["change"], 100.0 * (0.8f64 * 0.7).sqrt() - 100.0);
    near(&of("fps")["change"], 100.0);
    near(&of("frame-time")["change"], -50.0);
    assert_eq!((&of("power")["pairs"], &of("fps")["pairs"]), (&5.into(), &6.into()));
    assert_eq!(of("power")["interval"]["basis"], "repetitions");
    let mean =
        find(&report, "means", &[("scene", "atrium"), ("method", "conventional"), ("quantity", "power")]);
    // 505, 510, 515: t(0.975, 2) = 4.302653 times 5 / sqrt(3).
    near(&mean["mean"], 510.0);
    near(&mean["std"], 5.0);
    near(&mean["interval"]["low"], 510.0 - 12.420_689);
    for (list, name) in [
        ("left_out", "plugged in"),
        ("left_out", "no partner"),
        ("faults", "disconnected"),
        ("faults", "sign of the current"),
    ] {
        find(&report, list, &[("name", name)]);
    }
    let markdown = fs::read_to_string(at.join("out/report.md")).unwrap();
    for needed in
        ["yoro: change per device (simulated)", "Meta Quest 2, the paper's", "plugged in", "-20.0 %"]
    {
        assert!(markdown.contains(needed), "{needed}: {markdown}");
    }
    if let Some(mut browser) = Browser::start() {
        check_figures(&mut browser, &at.join("out/report.html"));
    }
}

#[test]
fn folders_without_captures_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    write(&at.join("good"), "yoro", "street", 1, 400.0, 60.0, &[]);
    write(&at.join("damaged"), "yoro", "street", 1, 400.0, 60.0, &[]);
    fs::write(at.join("damaged/run.json"), "{").unwrap();
    fs::create_dir(at.join("empty")).unwrap();
    fs::create_dir(at.join("out")).unwrap();
    fs::write(at.join("out/report.html"), "made earlier").unwrap();
    fs::write(at.join("file"), "").unwrap();
    for (line, naming) in [
        ("device report nowhere --out out", &["nowhere"][..]),
        ("device report empty --out out", &["no capture in empty"]),
        ("device report good damaged --out out", &["damaged/run.json is damaged"]),
        ("device report good --out file", &["file is not a folder"]),
        ("device report", &["<FOLDER>"]),
    ] {
        run(at, line).refuses(naming);
    }
    assert_eq!(fs::read(at.join("out/report.html")).unwrap(), b"made earlier");
    // Without the baseline, the report has the means and says what is missing.
    let run = succeed(at, "device report good --out out");
    assert!(run.stdout.contains("no run of conventional"), "{}", run.stdout);
    let again = succeed(at, "device report good --baseline yoro --out out");
    assert!(!again.stdout.contains("no run of"), "{}", again.stdout);
}
