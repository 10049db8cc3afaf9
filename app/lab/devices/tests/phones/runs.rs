//! One run.

use std::fs;
use std::path::Path;
use std::time::Duration;

use indicatif::ProgressBar;
use yoro_devices::adb::{Adb as _, Device, DeviceError};
use yoro_devices::capture::{Capture, FaultKind, Outcome, RunInfo, Sample};
use yoro_devices::external_app::Subject;
use yoro_devices::held_settings::{HeldSettings, Wanted};
use yoro_devices::phone;
use yoro_devices::run::{self, Other, Plan};
use yoro_settings::Settings;

use super::replay::{Replay, WORN};
use super::{fault, kinds, read, report};

/// Returns the plan of a run of yoro in the scene `talk`.
pub fn plan(seconds: f64) -> Plan {
    Plan {
        other: None,
        experiment: None,
        method: "yoro".into(),
        settings: Settings::measured().changed(None, ["scene=talk"]).unwrap(),
        repetition: 1,
        order: 1,
        duration_s: seconds,
        warm_up_s: 5.0,
        warmest_celsius: None,
        refresh_hz: None,
        power: true,
    }
}

/// Makes a run, with the display at the plan's refresh rate.
pub fn make(device: &dyn Device, plan: &Plan, folder: &Path) -> Result<RunInfo, DeviceError> {
    let wanted = Wanted { brightness: None, refresh_hz: plan.refresh_hz };
    run::make(device, plan, &wanted, folder, &ProgressBar::hidden())
}

/// Captures a run of one minute on a device with this script.
fn minute(script: &str) -> Capture {
    let dir = tempfile::tempdir().unwrap();
    let replay = Replay::new(&format!("[[device]]\nserial = \"SIM1\"\n{script}"));
    let made = make(&*replay.open("SIM1"), &plan(55.0), &dir.path().join("run")).unwrap();
    let capture = read(&dir.path().join("run"));
    let info = &capture.info;
    assert_eq!((info, &info.outcome), (&made, &Outcome::Complete));
    assert_eq!(
        (info.device.serial.as_str(), info.method.as_str(), info.scene.as_str(), info.warm_up_s),
        ("SIM1", "yoro", "talk", 5.0)
    );
    assert!(capture.samples.is_sorted_by(|a, b| a.time_s < b.time_s), "no second comes twice");
    // The samples match the log beside them.
    let log = fs::read_to_string(dir.path().join("run/log.txt")).unwrap();
    let lines = log.lines().filter(|line| line.contains(": v=2,t=")).count();
    assert!(lines >= capture.samples.len(), "{lines}");
    capture
}

/// Returns how many of the seconds 1 to 61 the capture lacks.
fn missing(capture: &Capture) -> usize {
    61 - capture.samples.iter().filter(|sample| (0.5..61.5).contains(&sample.time_s)).count()
}

#[test]
fn no_sample_is_lost_and_each_fault_is_named() {
    use FaultKind::*;
    let clean = minute("");
    assert_eq!((kinds(&clean), missing(&clean), clean.samples.len()), (vec![], 0, 62));
    let sample = &clean.samples[30];
    assert!(sample.current_ma.unwrap() < -500.0 && sample.voltage_mv.unwrap() > 3500.0, "{sample:?}");
    assert!(
        sample.charge_uah < clean.samples[0].charge_uah && sample.other.contains_key("status"),
        "{sample:?}"
    );

    // The charge that was used matches the current.
    let charge = |i: usize| clean.samples[i].charge_uah.unwrap() / 1e3;
    let integral: f64 = clean.samples[1..].iter().map(|sample| -sample.current_ma.unwrap() / 3600.0).sum();
    assert!(((charge(0) - charge(61)) / integral - 1.0).abs() < 0.03, "{integral}");

    let away = fault("disconnect", "at = 20.5\nseconds = 25.0");
    let jump = fault("clock-jump", "at = 30.0\nby = -3600.0");
    for (script, expected, lost) in [
        (away.clone(), vec![Disconnected], 0),
        (fault("log-ends", "at = 20.0"), vec![Disconnected], 0),
        (fault("unauthorized", "at = 20.0\nseconds = 12.0"), vec![Disconnected], 0),
        (fault("plug", "at = 30.0\nseconds = 10.0"), vec![PluggedIn], 0),
        ("current = \"missing\"\n".into(), vec![NoCurrent], 0),
        ("current = \"zero\"\n".into(), vec![NoCurrent], 0),
        ("voltage = \"volts\"\n".into(), vec![VoltageInVolts], 0),
        ("current = \"milliamperes\"\n".into(), vec![CurrentInMilliamperes], 0),
        ("positive = true\n".into(), vec![CurrentSign], 0),
        (jump.clone(), vec![ClockJump], 0),
        (fault("clock-jump", "at = 30.0\nby = 7200.0"), vec![ClockJump], 0),
        // The clock jumps while the device is lost. In neither direction are lines lost or duplicated.
        (format!("{away}{jump}"), vec![Disconnected, ClockJump], 0),
        (fault("truncate", "at = 30.5"), vec![DamagedLines], 1),
        (fault("silence", "at = 30.5\nseconds = 5.0"), vec![MissingLines], 5),
        (format!("{away}{}", fault("rotate", "at = 40.5")), vec![Disconnected, MissingLines], 20),
        (fault("crash", "at = 20.5"), vec![MissingLines, Restarted], 17),
        (fault("throttle", "at = 30.0"), vec![TooWarm], 0),
        ("vr-api = true\n".into(), vec![], 0),
    ] {
        let capture = minute(&script);
        assert_eq!(
            (kinds(&capture), missing(&capture)),
            (expected, lost),
            "{script}: {:?}",
            capture.info.faults
        );
    }
    let rebooted = minute(&fault("reboot", "at = 20.5\nseconds = 20.0"));
    assert_eq!(kinds(&rebooted), [Disconnected, MissingLines, Rebooted, Restarted]);
    assert!((30..40).contains(&missing(&rebooted)), "{:?}", rebooted.info.faults);
    let detail = &rebooted.info.faults.iter().find(|fault| fault.kind == MissingLines).unwrap().detail;
    assert!(detail.starts_with(&missing(&rebooted).to_string()), "{detail}");
}

#[test]
fn the_figures_of_odd_devices_are_corrected() {
    let current = |capture: &Capture| capture.samples[40].current_ma.unwrap();
    let [normal, odd] = ["", "current = \"milliamperes\"\npositive = true\n"].map(minute);
    assert!((current(&normal) - current(&odd)).abs() < 2.0, "{} {}", current(&normal), current(&odd));
    assert_eq!(odd.samples[40].current_raw, Some(-current(&odd) as i64));
    // With the voltage in whole volts, either the kernel gives the exact value, or power is left out.
    let exact = minute("voltage = \"volts\"\nkernel-battery = true\n");
    let volts = |capture: &Capture| capture.samples[40].voltage_mv;
    assert!((volts(&exact).unwrap() - volts(&normal).unwrap()).abs() < 20.0, "{:?}", volts(&exact));
    assert!(exact.info.faults.iter().any(|fault| fault.detail.contains("is the kernel's")));
    assert_eq!(volts(&minute("voltage = \"volts\"\n")), None);
    let runtime = minute("vr-api = true\n");
    assert_eq!(runtime.samples[40].other["VrApi.LCnt"], "2(DR72,LM2)");
}

#[test]
fn worthless_runs_fail_with_the_reason() {
    let dir = tempfile::tempdir().unwrap();
    for (name, script, reason) in [
        ("tap", fault("tap", "at = 20.5"), "conventional in place of yoro"),
        ("gone", fault("disconnect", "at = 20.5"), "did not come back"),
        (
            "crash",
            (1..5).map(|n| fault("crash", &format!("at = 3.5\nstart = {n}"))).collect(),
            "ended 3 times",
        ),
    ] {
        let replay = Replay::new(&format!("[[device]]\nserial = \"SIM1\"\n{script}"));
        let folder = dir.path().join(name);
        make(&*replay.open("SIM1"), &plan(60.0), &folder).unwrap();
        let capture = read(&folder);
        assert!(!capture.samples.is_empty());
        match capture.info.outcome {
            Outcome::Interrupted { reason: found } if name == "gone" => assert!(found.contains(reason)),
            Outcome::Failed { reason: found } if name != "gone" => assert!(found.contains(reason)),
            outcome => panic!("{name}: {outcome:?}"),
        }
    }
}

#[test]
fn refused_settings_and_refresh_rates_are_reported() {
    let dir = tempfile::tempdir().unwrap();
    let run = |script: &str, hz: f64, name: &str| {
        let replay = Replay::new(&format!("[[device]]\nserial = \"SIM1\"\n{script}"));
        let plan = Plan { refresh_hz: Some(hz), ..plan(5.0) };
        make(&*replay.open("SIM1"), &plan, &dir.path().join(name)).unwrap();
        let capture = read(&dir.path().join(name));
        (kinds(&capture), capture.info.faults[0].detail.clone())
    };
    let (kinds, said) = run("fixed-settings = [\"peak_refresh_rate\"]", 60.0, "run");
    assert_eq!(kinds, [FaultKind::NotPinned]);
    for words in
        ["peak_refresh_rate", "SecurityException", "USB debugging (Security settings)", "stays as it is"]
    {
        assert!(said.contains(words), "{words}: {said}");
    }
    // A device may accept a setting that has no effect.
    let (kinds, said) = run("refresh-hz = 60", 90.0, "other");
    assert_eq!(kinds, [FaultKind::RefreshRate]);
    assert!(said.contains("the display runs at 60 Hz, 90 Hz were asked for"), "{said}");
}

#[test]
fn other_applications_are_measured_and_compared() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let package = "com.example.game";
    let plan = |method: &str, repetition: u32, process: &str| {
        let subject = Subject { package: package.into(), process: process.into() };
        Plan {
            other: Some(Other { subject, activity: ".Main".into() }),
            method: method.into(),
            settings: Settings { scene: "room".into(), ..Settings::default() },
            repetition,
            ..plan(30.0)
        }
    };
    let headset = |more: &str| {
        Replay::new(&format!(
            "[[device]]\nserial = \"HEADSET\"\nmanufacturer = \"Oculus\"\nrefresh-hz = 72\nothers = [\"{package}\"]\n{more}"
        ))
    };
    for (method, milliwatts) in [("conventional", 5000.0), ("one-view", 4000.0)] {
        for repetition in 1..=2 {
            let replay = headset(&format!(
                "kernel-battery = true\n[device.load.yoro]\nframe-ms = 12.0\nmilliwatts = {milliwatts:?}\n"
            ));
            let folder = at.join(format!("captures/{method}-{repetition}"));
            make(&*replay.open("HEADSET"), &plan(method, repetition, package), &folder).unwrap();
        }
    }
    let capture = read(&at.join("captures/one-view-2"));
    let info = &capture.info;
    assert_eq!((info.method.as_str(), info.scene.as_str(), info.repetition), ("one-view", "room", 2));
    assert_eq!(info.application.as_deref(), Some("7.1"));
    assert_eq!((kinds(&capture), info.outcome.clone()), (vec![], Outcome::Complete));
    // The other process has 1 FPS, which is ignored.
    assert!(capture.samples.len() > 30 && capture.samples.iter().all(|sample| sample.fps > Some(60.0)));
    let power = |sample: &Sample| -sample.current_ma.unwrap() * sample.voltage_mv.unwrap() / 1e3;
    assert!(capture.samples[10..].iter().all(|sample| (power(sample) / 4000.0 - 1.0).abs() < 0.2));
    let (report, _) = report(&at.join("captures"));
    let mut found = report["differences"].as_array().unwrap().iter();
    let power = found.find(|d| d["quantity"] == "power" && d["scene"].is_null()).unwrap();
    assert_eq!((power["pairs"].as_u64(), &power["method"]), (Some(2), &"one-view".into()));
    assert!((power["change"].as_f64().unwrap() + 20.0).abs() < 4.0, "{power}");

    // This headset does not give the current to the shell.
    let folder = at.join("no-current");
    make(&*headset("").open("HEADSET"), &plan("x", 1, package), &folder).unwrap();
    assert_eq!(kinds(&read(&folder)), [FaultKind::NoCurrent]);
    // The application logs nothing itself.
    let silent = make(&*headset("").open("HEADSET"), &plan("x", 1, "com.example.none"), &at.join("none"));
    let reason = match silent {
        Ok(RunInfo { outcome: Outcome::Failed { reason } | Outcome::Interrupted { reason }, .. }) => reason,
        other => panic!("{other:?}"),
    };
    for words in ["com.example.none has logged no frame rate", "4001", "2072"] {
        assert!(reason.contains(words), "{words}: {reason}");
    }
}

#[test]
fn a_headset_is_told_that_it_is_worn_until_restored() {
    let replay = Replay::new(&format!(
        "[[device]]\nserial = \"HEADSET\"\nmanufacturer = \"Oculus\"\n{}",
        fault("reboot", "at = 1.0\nseconds = 2.0")
    ));
    let device = &*replay.open("HEADSET");
    let told = || [WORN, "debug.oculus.guardian_pause"].map(|name| device.shell(&["getprop", name]).unwrap());
    let info = phone::info(device).unwrap();
    let mut settings = HeldSettings::new(device, &info, &Wanted::default()).unwrap();
    assert_eq!((told(), settings.refused()), (["yes\n".into(), "1\n".into()], &[][..]));
    // Both are lost when the headset restarts.
    phone::start(device, &Default::default()).unwrap();
    device.sleep(Duration::from_secs(30));
    assert_eq!(told(), ["\n", "\n"]);
    settings.renew(device).unwrap();
    assert_eq!(told(), ["yes\n", "1\n"]);
    settings.restore(device).unwrap();
    assert_eq!(told(), ["\n", "\n"]);
}
