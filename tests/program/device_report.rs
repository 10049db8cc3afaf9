//! `yoro device report`: captures in, a page and tables out. The captures are made up by this test.

use std::fs;
use std::path::Path;

use serde_json::Value;
use yoro_devices::capture::{DeviceInfo, Outcome, RunInfo, Sample, VERSION, Writer};

use crate::browser::{Browser, check_report};
use crate::program::{run, succeed};

const SECONDS: u32 = 60;

/// Writes a run with constant power and frame rate.
fn write(folder: &Path, method: &str, scene: &str, repetition: u32, milliwatts: f64, fps: f64) {
    let info = RunInfo {
        version: VERSION,
        device: DeviceInfo {
            serial: "MADEUP1".into(),
            manufacturer: "Maker".into(),
            model: "Model 1".into(),
            ..DeviceInfo::default()
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
        faults: Vec::new(),
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

#[test]
fn captures_become_a_page_and_tables() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    for scene in ["street", "atrium"] {
        for repetition in 1..=2 {
            for (method, milliwatts, fps) in [("conventional", 500.0, 30.0), ("yoro", 400.0, 60.0)] {
                let folder = at.join(format!("captures/{scene}/{method}-{repetition}"));
                write(&folder, method, scene, repetition, milliwatts, fps);
            }
        }
    }
    let run = succeed(at, "device report captures --out out");
    assert!(
        run.stdout.contains("Maker Model 1, yoro:") && run.stdout.contains("8 of 8 runs"),
        "{}",
        run.stdout
    );
    let report: Value = serde_json::from_slice(&fs::read(at.join("out/report.json")).unwrap()).unwrap();
    assert_eq!((&report["simulated"], &report["baseline"]), (&false.into(), &"conventional".into()));
    let markdown = fs::read_to_string(at.join("out/report.md")).unwrap();
    for needed in ["yoro: change per device", "Meta Quest 2, the paper's", "-20.0 %"] {
        assert!(markdown.contains(needed), "{needed}: {markdown}");
    }
    if let Some(mut browser) = Browser::start() {
        check_report(&mut browser, &at.join("out/report.html"));
    }
}

#[test]
fn folders_without_captures_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    write(&at.join("good"), "yoro", "street", 1, 400.0, 60.0);
    write(&at.join("damaged"), "yoro", "street", 1, 400.0, 60.0);
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
