//! Experiments.

use std::fs;
use std::path::Path;

use indicatif::ProgressBar;
use serde_json::json;
use yoro_devices::adb::{Adb as _, Device, DeviceError};
use yoro_devices::capture::{self, Capture, FaultKind, Outcome};
use yoro_devices::experiment::{self, Experiment, Progress};

use super::replay::Replay;
use super::{fault, kinds, report};

const SMALL: &str = "name = \"small\"\nseconds = 20\nwarm-up-seconds = 5\nrepetitions = 2\nscenes = [\"talk\", \"stage\"]\nbrightness = 100\nrefresh-hz = 60\n[cool-down]\ncelsius = 30\n[[method]]\nname = \"conventional\"\n[[method]]\nname = \"paper\"\nsettings = { method = \"yoro\", pipeline = \"paper\" }\n";

/// Returns an experiment of eight runs, with one part of its text replaced by another.
pub fn small(folder: &Path, part: &str, by: &str) -> Experiment {
    let path = folder.join("e.toml");
    fs::write(&path, if part.is_empty() { SMALL.into() } else { SMALL.replace(part, by) }).unwrap();
    Experiment::read(&path).unwrap()
}

fn conduct(device: &dyn Device, experiment: &Experiment, out: &Path) -> Result<Progress, DeviceError> {
    experiment::conduct(device, experiment, out, &ProgressBar::hidden())
}

/// Checks that a device has the settings, properties and files that it had before.
#[track_caller]
fn is_given_back(device: &dyn Device) {
    let setting = |key: &str| device.shell(&["settings", "get", "system", key]).unwrap();
    assert_eq!([setting("screen_brightness"), setting("screen_brightness_mode")], ["102\n", "1\n"]);
    assert_eq!([setting("peak_refresh_rate"), setting("screen_off_timeout")], ["null\n", "null\n"]);
    let property = |name: &str| device.shell(&["getprop", name]).unwrap();
    // A property cannot be deleted; an empty one counts as missing.
    assert_eq!([property("debug.yoro.hud"), property("debug.oculus.refreshRate")], ["true\n", "\n"]);
    device.shell(&["cat", "/data/local/tmp/yoro-restore.txt"]).unwrap_err();
}

#[test]
fn an_experiment_on_two_devices_over_faults() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let experiment = small(dir.path(), "", "");
    let faults = [
        fault("disconnect", "start = 1\nat = 10.0\nseconds = 10.0"),
        fault("plug", "start = 2\nat = 10.0\nseconds = 5.0"),
        fault("reboot", "start = 3\nat = 10.0\nseconds = 10.0"),
        fault("truncate", "start = 5\nat = 10.0"),
    ];
    let hud = "[device.properties]\n\"debug.yoro.hud\" = \"true\"\n";
    let replay = Replay::new(&format!(
        "[[device]]\nserial = \"SIM1\"\n{hud}{}\n[[device]]\nserial = \"SIM2\"\ncurrent = \"milliamperes\"\n{hud}",
        faults.concat()
    ));
    for serial in ["SIM1", "SIM2"] {
        let device = &*replay.open(serial);
        let progress = conduct(device, &experiment, &out).unwrap();
        assert_eq!(progress.to_string(), "8 of 8 runs complete");
        is_given_back(device);
    }
    let captures = capture::read_all(std::slice::from_ref(&out)).unwrap();
    assert_eq!(captures.len(), 16);
    for serial in ["SIM1", "SIM2"] {
        let of: Vec<&Capture> = captures.iter().filter(|c| c.info.device.serial == serial).collect();
        let orders: Vec<u32> = of.iter().map(|c| c.info.order).collect();
        assert_eq!(orders, (1..=8).collect::<Vec<_>>());
        for capture in of {
            let info = &capture.info;
            assert_eq!((info.experiment.as_deref(), &info.outcome), (Some("small"), &Outcome::Complete));
            assert!(info.start_celsius.unwrap() <= 30.0, "{info:?}");
            assert_eq!(
                info.settings.get("pipeline").map(String::as_str),
                (info.method == "paper").then_some("paper")
            );
        }
    }
    let faults: Vec<Vec<FaultKind>> = captures[..5].iter().map(kinds).collect();
    use FaultKind::*;
    assert_eq!(
        faults,
        [
            vec![Disconnected],
            vec![PluggedIn],
            vec![Disconnected, MissingLines, Rebooted, Restarted],
            vec![DamagedLines],
            vec![]
        ]
    );
    assert!(captures[8..].iter().all(|c| kinds(c) == [CurrentInMilliamperes]));
    let again = conduct(&*replay.open("SIM1"), &experiment, &out).unwrap();
    assert_eq!(again.to_string(), "8 of 8 runs complete (8 from before)");
    assert_eq!(capture::read_all(&[out]).unwrap(), captures, "what is complete is not touched");
}

#[test]
fn from_an_experiment_to_its_report() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("captures");
    let experiment = small(dir.path(), "seconds = 20", "seconds = 40");
    let load = "[device.load]\nconventional = { frame-ms = 20.0, milliwatts = 4000.0 }\nyoro = { frame-ms = 10.0, milliwatts = 3000.0 }\n";
    let devices = [
        format!(
            "[[device]]\nserial = \"ODD\"\nmodel = \"ODD\"\ncurrent = \"milliamperes\"\npositive = true\n{load}"
        ),
        format!("[[device]]\nserial = \"DUMB\"\nmodel = \"DUMB\"\ncurrent = \"missing\"\n{load}"),
    ];
    let replay = Replay::new(&devices.concat());
    for serial in ["ODD", "DUMB"] {
        conduct(&*replay.open(serial), &experiment, &out).unwrap();
    }
    let (report, page) = report(&out);
    // Systematic errors in a device's values are corrected.
    let power = report["differences"].as_array().unwrap().iter().find(|entry| {
        entry["quantity"] == "power"
            && entry["scene"].is_null()
            && entry["device"].to_string().contains("ODD")
    });
    let change = power.unwrap()["change"].as_f64().unwrap();
    assert!((change + 25.0).abs() < 3.0, "{change}");
    assert_eq!(report["simulated"], json!(false));
    assert!(page.contains("no current") && !page.contains("(simulated)"), "{page}");
}

#[test]
fn a_warm_device_does_what_the_experiment_says() {
    let dir = tempfile::tempdir().unwrap();
    let make = |otherwise: &str| {
        let cool = format!("celsius = 30\nmax-seconds = 60\notherwise = \"{otherwise}\"\n");
        let experiment = Experiment { repetitions: 1, ..small(dir.path(), "celsius = 30\n", &cool) };
        let replay = Replay::new("[[device]]\nserial = \"SIM1\"\ncelsius = 40.0\nambient-celsius = 39.0\n");
        let out = dir.path().join(otherwise);
        let progress = conduct(&*replay.open("SIM1"), &experiment, &out);
        (progress, capture::read_all(&[out]).unwrap_or_default())
    };
    let (progress, captures) = make("start");
    assert_eq!((progress.unwrap().made, captures.len()), (4, 4));
    assert!(captures.iter().all(|c| kinds(c) == [FaultKind::TooWarm] && c.info.outcome == Outcome::Complete));
    let (progress, captures) = make("skip");
    let failed = progress.unwrap().failed;
    assert!(failed.len() == 4 && failed[0].1.contains("did not cool down"), "{failed:?}");
    assert!(
        captures.iter().all(|c| matches!(c.info.outcome, Outcome::Failed { .. }) && c.samples.is_empty())
    );
    let said = make("stop").0.unwrap_err().to_string();
    assert!(said.contains("does not cool down to 30.0 C") && said.contains("same command"), "{said}");
}

#[test]
fn a_plan_longer_than_a_charge_waits_for_the_charger() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    // A run takes 4 % of so small a battery.
    let replay = Replay::new(
        "[[device]]\nserial = \"SIM1\"\ncapacity-mah = 120\nlevel-percent = 60\ncharged-below = 39\n",
    );
    let experiment = small(dir.path(), "[cool-down]", "min-level = 40\ncharge-level = 90\n[cool-down]");
    let progress = conduct(&*replay.open("SIM1"), &experiment, &out).unwrap();
    assert_eq!(progress.to_string(), "8 of 8 runs complete");
    let runs = capture::read_all(&[out]).unwrap();
    let levels: Vec<f64> = runs.iter().map(|run| run.samples[0].level_percent.unwrap()).collect();
    assert!(levels.iter().all(|level| *level >= 38.0) && levels[0] < 61.0 && levels[7] > 60.0, "{levels:?}");
    assert!(runs.iter().all(|run| kinds(run).is_empty()));
}

/// A device that is gone ends the experiment; when it is back, the same command goes on.
#[test]
fn a_lost_devices_experiment_goes_on() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let experiment = small(dir.path(), "", "");
    let gone = fault("disconnect", "start = 2\nat = 10.0\nseconds = 3600.0");
    let replay = Replay::new(&format!(
        "[[device]]\nserial = \"SIM1\"\n[device.properties]\n\"debug.yoro.hud\" = \"true\"\n{gone}"
    ));
    let device = &*replay.open("SIM1");
    assert!(conduct(device, &experiment, &out).unwrap_err().is_lost());
    device.sleep(std::time::Duration::from_secs(3600));
    // What was held could not be given back; the next experiment begins with that.
    assert_eq!(device.shell(&["settings", "get", "system", "screen_brightness"]).unwrap(), "100\n");
    let progress = conduct(device, &experiment, &out).unwrap();
    assert_eq!(progress.to_string(), "8 of 8 runs complete (1 from before)");
    is_given_back(device);
}
