//! `yoro device` on simulated devices.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Stdio;

use yoro_devices::capture::{self, Capture, FaultKind, Outcome, Sample};

use crate::program::{finish, interrupt, run, succeed, yoro};

/// The experiments in the repository.
const EXPERIMENTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../lab/devices/experiments");

fn write(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), text).unwrap();
}

/// Reads the run in a folder.
fn read(folder: &Path) -> Capture {
    capture::read(folder).unwrap()
}

fn kinds(capture: &Capture) -> Vec<FaultKind> {
    let kinds: BTreeSet<FaultKind> = capture.info.faults.iter().map(|fault| fault.kind).collect();
    kinds.into_iter().collect()
}

/// Captures a run of one minute on a device with this script.
fn minute(script: &str) -> Capture {
    let dir = tempfile::tempdir().unwrap();
    write(dir.path(), "s.toml", &format!("[[device]]\nserial = \"SIM1\"\n{script}"));
    let run =
        succeed(dir.path(), "device run talk --seconds 55 --warm-up-seconds 5 --replay s.toml --out run");
    assert!(run.stdout.starts_with("SIMULATED: ") && run.stdout.contains("SIM1: complete"), "{}", run.stdout);
    let capture = read(&dir.path().join("run"));
    let info = &capture.info;
    assert!(
        info.device.simulated && info.device.serial == "SIM1" && info.outcome == Outcome::Complete,
        "{info:?}"
    );
    assert_eq!((info.method.as_str(), info.scene.as_str(), info.warm_up_s), ("yoro", "talk", 5.0));
    assert!(capture.samples.is_sorted_by(|a, b| a.time_s < b.time_s), "no second comes twice");
    for fault in &info.faults {
        assert!(run.stdout.contains(&fault.detail), "{} is not in {}", fault.detail, run.stdout);
    }
    // The samples match the log beside them.
    let log = fs::read_to_string(dir.path().join("run/log.txt")).unwrap();
    let lines = log.lines().filter(|line| line.contains(": v=1,t=")).count();
    assert!(lines >= capture.samples.len(), "{lines}");
    capture
}

/// Returns how many of the seconds 1 to 61 the capture lacks.
fn missing(capture: &Capture) -> usize {
    61 - capture.samples.iter().filter(|sample| (0.5..61.5).contains(&sample.time_s)).count()
}

fn fault(kind: &str, rest: &str) -> String {
    format!("[[device.fault]]\nkind = \"{kind}\"\n{rest}\n")
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
    let at = dir.path();
    for (name, script, reason) in [
        ("tap", fault("tap", "at = 20.5"), "conventional in place of yoro"),
        ("gone", fault("disconnect", "at = 20.5"), "did not come back"),
        (
            "crash",
            (1..5).map(|n| fault("crash", &format!("at = 3.5\nstart = {n}"))).collect(),
            "ended 3 times",
        ),
    ] {
        write(at, "s.toml", &format!("[[device]]\nserial = \"SIM1\"\n{script}"));
        let line = format!("device run talk --replay s.toml --out {name}");
        let run = run(at, &line);
        assert_eq!(run.code, Some(2), "{name}: {}", run.stderr);
        assert!(run.stderr.contains(reason) && run.stderr.contains("error: "), "{name}: {}", run.stderr);
        let capture = read(&at.join(name));
        assert!(!capture.samples.is_empty());
        match capture.info.outcome {
            Outcome::Interrupted { reason: found } if name == "gone" => assert!(found.contains(reason)),
            Outcome::Failed { reason: found } if name != "gone" => assert!(found.contains(reason)),
            outcome => panic!("{name}: {outcome:?}"),
        }
    }
}

#[test]
fn mistakes_and_conditions_are_one_sentence() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let device = |text: &str| format!("[[device]]\nserial = \"SIM1\"\n{text}\n");
    let two = device("") + &device("").replace("SIM1", "SIM2");
    write(at, "e.toml", "name = \"e\"\nseconds = 5\nscenes = [\"talk\"]\n[[method]]\nname = \"yoro\"\n");
    for (script, line, words) in [
        ("seed = 1\n".to_owned(), "list", ["no device is connected", "USB debugging"]),
        (two.clone(), "run", ["SIM1, SIM2", "--serial"]),
        (two.clone(), "logcat", ["SIM1, SIM2", "--serial"]),
        (two.clone(), "run --serial SIM3", ["SIM3 is not connected", "yoro device list"]),
        (two.replace("SIM2", "SIM1"), "list", ["s.toml", "same serial"]),
        (device("state = \"unauthorized\""), "run", ["SIM1 does not trust", "accept the key"]),
        (device("state = \"offline\""), "logcat", ["SIM1 is offline", "again"]),
        (device("state = \"recovery\""), "run", ["recovery", "start Android"]),
        (device("installed = false"), "run", ["not installed on SIM1", "yoro device install"]),
        (device("installed = false"), "experiment e.toml", ["not installed on SIM1", "yoro device install"]),
        (device("plugged = true"), "run", ["tcpip 5555", "adb connect 192.0.2.7:5555"]),
        (device("plugged = true"), "experiment e.toml", ["tcpip 5555", "--plugged"]),
        (device("battery-held = true"), "run", ["set by hand", "adb -s SIM1 shell dumpsys battery reset"]),
        (
            device("settings = { \"global/low_power\" = \"1\" }"),
            "run",
            ["battery saver of SIM1", "low_power 0"],
        ),
        (device("secure-lock = true"), "experiment e.toml", ["locked by PIN", "none or swipe"]),
        (device("level-percent = 15"), "experiment e.toml", ["SIM1 has 15 %, and nobody", "charged-below"]),
        (device("capacity-mah = inf"), "list", ["capacity-mah is inf", "from 0 to 1000000"]),
        (
            device("load = { yoro = { frame-ms = 9.0, milliwatts = -inf } }"),
            "run",
            ["milliwatts is -inf", "give a number from 0"],
        ),
        (
            device("serial = \"adb-X (2)._adb-tls-connect._tcp\"\nplugged = true")
                .replace("serial = \"SIM1\"\n", ""),
            "run",
            ["it already is", "charger off"],
        ),
        (
            device("serial = \"adb-X (2)._adb\"\nbattery-held = true").replace("serial = \"SIM1\"\n", ""),
            "run",
            ["set by hand", "adb -s 'adb-X (2)._adb' shell"],
        ),
        (
            device(""),
            "run room --package com.example.game --activity .Main --method one-view",
            ["com.example.game is not installed on SIM1", "pm list packages"],
        ),
        (device(""), "logcat --package com.example.game", ["com.example.game is not installed", "pm list"]),
        (device("storage-full = true"), "install --apk e.toml", ["storage of SIM1 is full", "remove"]),
        (device("colour = 1"), "list", ["s.toml", "colour"]),
        ("speed = 0.0\n".into(), "list", ["s.toml", "speed"]),
        (device("logs = [\"none.log\"]"), "run", ["none.log", "does not exist"]),
    ] {
        write(at, "s.toml", &script);
        run(at, &format!("device {line} --replay s.toml")).refuses(&words);
    }
    write(at, "s.toml", &device(""));
    run(at, "device install --replay s.toml").refuses(&["target/apk/yoro.apk", "cargo xtask apk"]);
    run(at, "device list --replay none.toml").refuses(&["none.toml", "does not exist"]);
    fs::create_dir(at.join("empty")).unwrap();
    run(at, "device list --replay empty").refuses(&["no capture"]);
    run(at, "device experiment none.toml --replay s.toml").refuses(&["none.toml"]);
    run(at, "device experiment s.toml --dry-run").refuses(&["s.toml", "device"]);
    run(at, "device run --set speed=1 --replay s.toml").refuses(&["speed"]);
    run(at, "device list --adb none").refuses(&["not found in none", "--adb FILE"]);
    run(at, "device logcat none.log").refuses(&["none.log", "does not exist"]);
    run(at, "device logcat e.toml --serial SIM1").refuses(&["needs no device"]);
    let homeless = yoro(["device", "list"])
        .current_dir(at)
        .env("PATH", "")
        .env_remove("ANDROID_HOME")
        .env_remove("ANDROID_SDK_ROOT")
        .output();
    let said = String::from_utf8(homeless.unwrap().stderr).unwrap();
    assert!(
        said.starts_with("error: adb was not found in PATH, ANDROID_HOME and ANDROID_SDK_ROOT: install"),
        "{said}"
    );
    succeed(at, "device run talk --seconds 5 --replay s.toml --out once");
    let before = fs::read(at.join("once/run.json")).unwrap();
    run(at, "device run talk --seconds 5 --replay s.toml --out once").refuses(&["once holds a run already"]);
    assert_eq!(fs::read(at.join("once/run.json")).unwrap(), before);
}

#[test]
fn devices_are_listed_and_installed_on() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    write(
        at,
        "s.toml",
        "[[device]]\nserial = \"SIM1\"\ninstalled = false\n[[device]]\nserial = \"SIM2\"\nstate = \"offline\"\n",
    );
    let list = succeed(at, "device list --replay s.toml").stdout;
    assert!(
        list.contains("(simulated)") && list.contains("not installed") && list.contains("offline"),
        "{list}"
    );
    write(at, "a.apk", "");
    // The only device that is ready is chosen.
    let said = succeed(at, "device install --apk a.apk --replay s.toml").stdout;
    assert!(said.contains("SIM1: installed a.apk"), "{said}");
}

const SMALL: &str = "name = \"small\"\nseconds = 20\nwarm-up-seconds = 5\nrepetitions = 2\nscenes = [\"talk\", \"stage\"]\nbrightness = 100\nrefresh-hz = 60\n[cool-down]\ncelsius = 30\n[[method]]\nname = \"conventional\"\n[[method]]\nname = \"paper\"\nsettings = { method = \"yoro\", pipeline = \"paper\" }\n";

/// Reads the state that a device keeps between replays: settings, properties and files.
fn kept(folder: &Path, serial: &str) -> serde_json::Value {
    serde_json::from_slice(&fs::read(folder.join(format!("state/{serial}.json"))).unwrap()).unwrap()
}

#[track_caller]
fn is_given_back(folder: &Path, serial: &str) {
    let kept = kept(folder, serial);
    assert_eq!(
        kept["settings"],
        serde_json::json!({"screen_brightness": "102", "screen_brightness_mode": "1"})
    );
    assert_eq!(kept["properties"]["debug.yoro.hud"], "true");
    assert_eq!(kept["files"], serde_json::json!({}));
}

fn two_devices(speed: &str, faults: &str) -> String {
    format!(
        "{speed}\nstate = \"state\"\n[[device]]\nserial = \"SIM1\"\n[device.properties]\n\"debug.yoro.hud\" = \"true\"\n{faults}\n[[device]]\nserial = \"SIM2\"\ncurrent = \"milliamperes\"\n[device.properties]\n\"debug.yoro.hud\" = \"true\"\n"
    )
}

#[test]
fn an_experiment_on_two_devices_over_faults() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    write(at, "e.toml", SMALL);
    let faults = [
        fault("disconnect", "start = 1\nat = 10.0\nseconds = 10.0"),
        fault("plug", "start = 2\nat = 10.0\nseconds = 5.0"),
        fault("reboot", "start = 3\nat = 10.0\nseconds = 10.0"),
        fault("truncate", "start = 5\nat = 10.0"),
    ];
    write(at, "s.toml", &two_devices("", &faults.concat()));
    let line = "device experiment e.toml --replay s.toml --all --out out";
    let said = succeed(at, line).stdout;
    assert!(said.contains("SIM1: 8 of 8 runs complete") && said.contains("SIM2: 8 of 8"), "{said}");
    let captures = capture::read_all(&[at.join("out")]).unwrap();
    assert_eq!(captures.len(), 16);
    for serial in ["SIM1", "SIM2"] {
        let of: Vec<&Capture> = captures.iter().filter(|c| c.info.device.serial == serial).collect();
        let orders: Vec<u32> = of.iter().map(|c| c.info.order).collect();
        assert_eq!(orders, (1..=8).collect::<Vec<_>>());
        for capture in of {
            let info = &capture.info;
            assert_eq!((info.experiment.as_deref(), &info.outcome), (Some("small"), &Outcome::Complete));
            assert!(info.device.simulated && info.start_celsius.unwrap() <= 30.0, "{info:?}");
            assert_eq!(
                info.settings.get("pipeline").map(String::as_str),
                (info.method == "paper").then_some("paper")
            );
        }
        is_given_back(at, serial);
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
    let again = succeed(at, line).stdout;
    assert!(again.contains("SIM1: 8 of 8 runs complete (8 from before)"), "{again}");
    assert_eq!(capture::read_all(&[at.join("out")]).unwrap(), captures, "what is complete is not touched");
    write(at, "e.toml", &SMALL.replace("seconds = 20", "seconds = 25"));
    run(at, line).refuses(&["out holds runs of another experiment", "--out"]);
}

#[test]
fn from_an_experiment_to_its_report() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    write(at, "e.toml", &SMALL.replace("seconds = 20", "seconds = 40"));
    let load = "[device.load]\nconventional = { frame-ms = 20.0, milliwatts = 4000.0 }\nyoro = { frame-ms = 10.0, milliwatts = 3000.0 }\n";
    // One fault per run. A fault that restarts the application also increments the number of its start.
    let faults = [
        fault("disconnect", "start = 1\nat = 20.5\nseconds = 10.0"),
        fault("plug", "start = 2\nat = 20.5\nseconds = 5.0"),
        fault("reboot", "start = 3\nat = 20.5\nseconds = 5.0"),
        fault("clock-jump", "start = 5\nat = 20.5\nby = 3600.0"),
        fault("truncate", "start = 6\nat = 20.5"),
        fault("silence", "start = 7\nat = 20.5\nseconds = 3.0"),
        fault("throttle", "start = 8\nat = 20.5\nseconds = 3.0"),
        fault("crash", "start = 9\nat = 20.5"),
    ];
    let devices = [
        format!("[[device]]\nserial = \"FAULTY\"\nmodel = \"FAULTY\"\n{load}{}", faults.concat()),
        format!(
            "[[device]]\nserial = \"ODD\"\nmodel = \"ODD\"\ncurrent = \"milliamperes\"\npositive = true\n{load}"
        ),
        format!("[[device]]\nserial = \"DUMB\"\nmodel = \"DUMB\"\ncurrent = \"missing\"\n{load}"),
    ];
    write(at, "s.toml", &devices.concat());
    succeed(at, "device experiment e.toml --replay s.toml --all --out captures");
    let said = succeed(at, "device report captures --out report").stdout;
    assert!(said.contains("Simulated: "), "{said}");
    let report: serde_json::Value =
        serde_json::from_slice(&fs::read(at.join("report/report.json")).unwrap()).unwrap();
    assert_eq!(report["simulated"], true);
    let named = |list: &str| -> BTreeSet<&str> {
        report[list].as_array().unwrap().iter().filter_map(|entry| entry["name"].as_str()).collect()
    };
    for name in [
        "application restarted",
        "clock jump",
        "current in mA",
        "damaged lines",
        "disconnected",
        "missing lines",
        "no current",
        "plugged in",
        "rebooted",
        "sign of the current",
        "too warm",
    ] {
        assert!(named("faults").contains(name), "{name}: {:?}", named("faults"));
    }
    assert!(named("left_out").contains("plugged in") && named("left_out").contains("rebooted"));
    // Systematic errors in a device's values are corrected.
    let power = report["differences"].as_array().unwrap().iter().find(|entry| {
        entry["quantity"] == "power"
            && entry["scene"].is_null()
            && entry["device"].to_string().contains("ODD")
    });
    let change = power.unwrap()["change"].as_f64().unwrap();
    assert!((change + 25.0).abs() < 3.0, "{change}");
    let page = fs::read_to_string(at.join("report/report.md")).unwrap();
    assert!(page.contains("simulated") && page.contains("no current"), "{page}");
}

#[test]
fn an_experiment_goes_on_where_it_was_interrupted_or_killed() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    write(at, "e.toml", SMALL);
    write(at, "s.toml", &two_devices("speed = 12.0", ""));
    let line = "device experiment e.toml --replay s.toml --serial SIM1 --out out";
    let folder = at.join("out/SIM1");
    let begun = |n: usize| {
        let runs = fs::read_dir(&folder).into_iter().flatten().flatten();
        let mut logs = runs.filter_map(|run| fs::read_to_string(run.path().join("samples.csv")).ok());
        let rows = |text: &String| text.lines().count() > 3;
        logs.by_ref().filter(rows).count() >= n
    };
    let stopped = interrupt(at, line, || begun(2));
    assert!(stopped.stderr.contains("the same command goes on"), "{}", stopped.stderr);
    is_given_back(at, "SIM1");
    let outcomes = |state: &str| {
        let runs = capture::read_all(&[at.join("out")]).unwrap();
        runs.iter().filter(|run| serde_json::to_value(&run.info.outcome).unwrap()["state"] == state).count()
    };
    assert_eq!((outcomes("complete"), outcomes("interrupted")), (1, 1));
    // A killed program cannot restore the settings. The next one does.
    let mut child =
        yoro(line.split(' ')).current_dir(at).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    while !begun(4) {
        assert_eq!(child.try_wait().unwrap(), None, "it has ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(kept(at, "SIM1")["settings"]["screen_brightness"], "100");
    write(at, "s.toml", &two_devices("", ""));
    let said = succeed(at, line);
    assert!(said.stdout.contains("8 of 8 runs complete (2 from before)"), "{}", said.stdout);
    assert!(said.stderr.contains("an earlier measurement had left changed"), "{}", said.stderr);
    assert_eq!((outcomes("complete"), outcomes("interrupted")), (8, 2));
    is_given_back(at, "SIM1");
}

#[test]
fn a_warm_device_does_what_the_experiment_says() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    write(at, "s.toml", "[[device]]\nserial = \"SIM1\"\ncelsius = 40.0\nambient-celsius = 39.0\n");
    let line = "device experiment e.toml --replay s.toml --out";
    let say = |otherwise: &str| {
        let cool = format!("celsius = 30\nmax-seconds = 60\notherwise = \"{otherwise}\"\n");
        write(at, "e.toml", &SMALL.replace("celsius = 30\n", &cool).replace("repetitions = 2\n", ""));
    };
    say("start");
    succeed(at, &format!("{line} start"));
    let captures = capture::read_all(&[at.join("start")]).unwrap();
    assert_eq!(captures.len(), 4);
    assert!(captures.iter().all(|c| kinds(c) == [FaultKind::TooWarm] && c.info.outcome == Outcome::Complete));
    say("skip");
    let skipped = run(at, &format!("{line} skip"));
    assert!(skipped.code == Some(2) && skipped.stderr.contains("did not cool down"), "{}", skipped.stderr);
    let captures = capture::read_all(&[at.join("skip")]).unwrap();
    assert!(
        captures.iter().all(|c| matches!(c.info.outcome, Outcome::Failed { .. }) && c.samples.is_empty())
    );
    say("stop");
    run(at, &format!("{line} stop")).refuses(&["does not cool down to 30.0 C", "same command"]);
}

#[test]
fn refused_settings_and_refresh_rates_are_reported() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    write(at, "s.toml", "[[device]]\nserial = \"SIM1\"\nfixed-settings = [\"peak_refresh_rate\"]\n");
    let said = succeed(at, "device run talk --seconds 5 --refresh-hz 60 --replay s.toml --out run");
    for words in
        ["peak_refresh_rate", "SecurityException", "USB debugging (Security settings)", "stays as it is"]
    {
        assert!(said.stderr.contains(words) && said.stdout.contains(words), "{words}: {}", said.stderr);
    }
    assert_eq!(kinds(&read(&at.join("run"))), [FaultKind::NotPinned]);
    // A device may accept a setting that has no effect.
    write(at, "s.toml", "[[device]]\nserial = \"SIM1\"\nrefresh-hz = 60\n");
    let said = succeed(at, "device run talk --seconds 5 --refresh-hz 90 --replay s.toml --out other");
    assert!(said.stdout.contains("the display runs at 60 Hz, 90 Hz were asked for"), "{}", said.stdout);
    assert_eq!(kinds(&read(&at.join("other"))), [FaultKind::RefreshRate]);
}

#[test]
fn a_plan_longer_than_a_charge_waits_for_the_charger() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    // A run takes 4 % of so small a battery.
    write(
        at,
        "s.toml",
        "[[device]]\nserial = \"SIM1\"\ncapacity-mah = 120\nlevel-percent = 60\ncharged-below = 39\n",
    );
    write(at, "e.toml", &SMALL.replace("[cool-down]", "min-level = 40\ncharge-level = 90\n[cool-down]"));
    let said = succeed(at, "device experiment e.toml --replay s.toml --out out");
    assert!(said.stdout.contains("8 of 8 runs complete"), "{}", said.stdout);
    assert!(said.stderr.contains("charge it to 90 %, then take the charger off"), "{}", said.stderr);
    let runs = capture::read_all(&[at.join("out")]).unwrap();
    let levels: Vec<f64> = runs.iter().map(|run| run.samples[0].level_percent.unwrap()).collect();
    assert!(levels.iter().all(|level| *level >= 38.0) && levels[0] < 61.0 && levels[7] > 60.0, "{levels:?}");
    assert!(runs.iter().all(|run| kinds(run).is_empty()));
    write(at, "e.toml", &SMALL.replace("[cool-down]", "min-level = 95\n[cool-down]"));
    run(at, "device experiment e.toml --dry-run")
        .refuses(&["e.toml", "min-level must be below charge-level"]);
}

#[test]
fn other_applications_are_measured_and_compared() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let device = "[[device]]\nserial = \"HEADSET\"\nmanufacturer = \"Oculus\"\nrefresh-hz = 72\nothers = [\"com.example.game\"]\n";
    let load = "[device.load.yoro]\nframe-ms = 12.0\nmilliwatts = ";
    for (method, milliwatts) in [("conventional", 5000.0), ("one-view", 4000.0)] {
        let script = format!("{device}kernel-battery = true\n{load}{milliwatts:?}\n");
        write(at, "s.toml", &script);
        for repetition in 1..=2 {
            let line = format!(
                "device run room --package com.example.game --activity .Main --method {method} --repetition {repetition} --seconds 30 --replay s.toml --out captures/{method}-{repetition}"
            );
            succeed(at, &line);
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
    succeed(at, "device report captures --out report");
    let report: serde_json::Value =
        serde_json::from_slice(&fs::read(at.join("report/report.json")).unwrap()).unwrap();
    let found = report["differences"].as_array().unwrap().iter();
    let power = found.clone().find(|d| d["quantity"] == "power" && d["scene"].is_null()).unwrap();
    assert_eq!((power["pairs"].as_u64(), &power["method"]), (Some(2), &"one-view".into()));
    assert!((power["change"].as_f64().unwrap() + 20.0).abs() < 4.0, "{power}");

    // The same for an application that is already running, with names for the report.
    write(at, "s.toml", &format!("{device}foreground = \"com.example.game\"\n"));
    let names = "--package com.example.game --method one-view --scene room --repetition 3";
    succeed(at, &format!("device logcat {names} --seconds 20 --out log --replay s.toml"));
    let log = read(&at.join("log"));
    assert_eq!(
        (log.info.method.as_str(), log.info.scene.as_str(), log.info.repetition),
        ("one-view", "room", 3)
    );
    assert!(log.samples.len() > 15 && log.samples.iter().all(|sample| sample.fps > Some(60.0)));
    assert!(log.samples.iter().all(|sample| sample.level_percent.is_some()));
    // No current, since this headset does not give it to the shell.
    assert_eq!(kinds(&log), [FaultKind::NoCurrent]);
    // The application logs nothing itself.
    let line = "device run room --package com.example.game --activity .Main --method x --log-process com.example.none --replay s.toml --out none";
    run(at, line).refuses(&["com.example.none has logged no frame rate", "4002", "2072"]);
}

#[test]
fn a_dry_run_is_a_plan() {
    let dir = tempfile::tempdir().unwrap();
    for (name, runs, length) in [("paper", 40, "7 h 1"), ("five-minutes", 4, "5 min")] {
        let line = format!("device experiment {EXPERIMENTS}/{name}.toml --dry-run");
        let said = succeed(dir.path(), &line).stdout;
        assert!(said.contains(&format!("{runs} runs on a device: {length}")), "{said}");
        // Seven hours take more than one battery charge.
        assert_eq!(said.contains("waits for somebody who charges it"), name == "paper", "{said}");
        assert_eq!(
            said.lines().filter(|line| line.trim_start().starts_with(|c: char| c.is_ascii_digit())).count(),
            runs + 1
        );
    }
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
}

#[test]
fn logs_recorded_from_the_application_play_again() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let line = format!("device run prototype --seconds 20 --replay {EXPERIMENTS}/recorded.toml --out");
    succeed(at, &format!("{line} run"));
    let first = read(&at.join("run"));
    assert_eq!((first.samples.len(), first.samples[3].refresh_hz, kinds(&first)), (27, Some(60.0), vec![]));
    assert_eq!(first.samples[3].current_raw, Some(-512_000));
    let stderr = run(at, &line.replace("prototype", "talk").replace("--out", "--out talk")).stderr;
    assert!(stderr.contains("no recorded log of yoro in talk"), "{stderr}");
    // Captures can be replayed.
    succeed(at, "device run prototype --seconds 10 --replay run --out again");
    let again = read(&at.join("again"));
    assert_eq!(again.samples[5].cpu_percent, first.samples[5].cpu_percent);
    assert!(again.info.device.simulated && again.info.device.model == first.info.device.model);
}

#[test]
fn a_saved_log_is_a_table_and_a_capture() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let log = format!("{EXPERIMENTS}/recorded/prototype-yoro.log");
    let said = succeed(at, &format!("device logcat {log} --out kept")).stdout;
    assert!(
        said.contains("SIMULATED: ") && said.contains("yoro in prototype") && said.contains("60.0/60"),
        "{said}"
    );
    assert!(said.contains("12 samples, 0 damaged lines"), "{said}");
    let kept = read(&at.join("kept"));
    assert!(kept.info.device.simulated && kept.info.method == "yoro" && kept.samples.len() == 12);
    assert_eq!(fs::read(at.join("kept/log.txt")).unwrap(), fs::read(&log).unwrap());
    // Via standard input: a log with a line that is cut off, an unknown key, and bytes that are not text.
    let mut bytes = fs::read(&log).unwrap();
    let text = String::from_utf8(bytes.clone()).unwrap();
    let seventh = text.find("v=1,t=7.0s").unwrap();
    bytes.splice(seventh + 60..seventh + 70, *b"\xff\xfe\n");
    let more =
        text.lines().find(|line| line.contains("t=12.0s,method")).unwrap().replace("t=12.0s", "t=13.0s");
    bytes.extend_from_slice(format!("{more},gaze=0.25\n").as_bytes());
    fs::write(at.join("damaged.log"), bytes).unwrap();
    let input = fs::File::open(at.join("damaged.log")).unwrap();
    let run = finish(yoro("device logcat - --out damaged".split(' ')).current_dir(at).stdin(input));
    assert!(
        run.code == Some(0) && run.stdout.contains("12 samples, 2 damaged lines"),
        "{}{}",
        run.stdout,
        run.stderr
    );
    assert_eq!(fs::read(at.join("damaged/log.txt")).unwrap(), fs::read(at.join("damaged.log")).unwrap());
    let damaged = read(&at.join("damaged"));
    assert_eq!(kinds(&damaged), [FaultKind::DamagedLines]);
    assert_eq!(damaged.samples[11].other["gaze"], "0.25");
    assert_eq!(missing(&damaged), 61 - 12);
    write(at, "none.log", "--------- beginning of main\n");
    crate::program::run(at, "device logcat none.log").refuses(&["none.log", "YORO and VrApi"]);
}

#[test]
fn a_log_is_followed() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    write(at, "s.toml", "[[device]]\nserial = \"SIM1\"\n");
    let said = succeed(at, "device logcat --seconds 10 --out log --replay s.toml").stdout;
    assert!(said.contains("0 samples, 0 damaged lines") && said.contains("capture: log"), "{said}");
    let capture = read(&at.join("log"));
    assert!(capture.info.device.simulated && capture.info.method == "unknown", "{:?}", capture.info);
    // With everything that can happen to a log.
    let faults = [
        fault("disconnect", "at = 10.5\nseconds = 10.0"),
        fault("log-ends", "at = 30.5"),
        fault("clock-jump", "at = 35.5\nby = -100.0"),
        fault("truncate", "at = 40.5"),
        fault("tap", "at = 50.5"),
        fault("reboot", "at = 60.5\nseconds = 10.0"),
    ];
    let running = "[[device]]\nserial = \"SIM1\"\nvr-api = true\n[device.running]\nmethod = \"mono\"\nscene = \"talk\"\n";
    write(at, "s.toml", &format!("{running}{}", faults.concat()));
    let run = succeed(at, "device logcat --seconds 90 --out live --replay s.toml");
    assert!(run.stdout.contains("mono in talk") && run.stdout.contains("damaged line ("), "{}", run.stdout);
    assert!(
        run.stderr.contains("SIM1 is back after 10 s") && run.stderr.contains("was started anew"),
        "{}",
        run.stderr
    );
    let live = read(&at.join("live"));
    let seconds: Vec<u32> = live.samples.iter().map(|sample| sample.time_s.round() as u32).collect();
    assert_eq!(seconds, (1..=60).filter(|second| *second != 41).collect::<Vec<_>>());
    assert_eq!(
        (live.info.method.as_str(), live.samples[20].other["VrApi.Prd"].as_str()),
        ("several", "38ms")
    );
    use FaultKind::*;
    assert_eq!(kinds(&live), [Disconnected, ClockJump, DamagedLines, Rebooted]);
}

/// A shell script that answers like the program adb.
#[cfg(unix)]
const FAKE_ADB: &str = r#"#!/bin/sh
# A fake adb: one device, on which everything works.
here=$(dirname "$0")
[ "$1" = start-server ] && exit 0
if [ "$1" = devices ]; then
    printf 'List of devices attached\nFAKE1\tdevice\nFAKE2\tunauthorized\n\n'
    exit 0
fi
[ "$1 $2" = "-s FAKE1" ] || { echo "error: device '$2' not found" >&2; exit 1; }
shift 2
echo "$@" >> "$here/asked"
case "$*" in
    "install -r "*refused*) cat "$3" >&2; exit 1 ;;
    "install -r"*full*) echo 'Failure [INSTALL_FAILED_INSUFFICIENT_STORAGE: no room]' >&2; exit 1 ;;
    "install -r"*) echo Success ;;
    logcat*) exec tail -n +1 -f "$here/log" ;;
    *boot_id*) echo one-boot ;;
    *date*) echo 1700000000.000000000 ;;
    "shell cat > "*) cat > "$here/put" ;;
    "shell cat "*) echo 'cat: No such file or directory' >&2; exit 1 ;;
    *"dumpsys battery") printf '  AC powered: false\n  level: 80\n  temperature: 250\n' ;;
    *"dumpsys package"*) printf '    versionName=0.1.0\n' ;;
    *ro.serialno*) echo FAKE1 ;;
    *ro.product.model*) echo "Fake phone" ;;
    *"settings get system screen_off_timeout"*) echo 30000 ;;
    *"settings get"*zen_mode*|*"settings get"*low_power*) echo 0 ;;
    *"settings get system screen_brightness_mode"*) echo 0 ;;
    *"settings get system screen_brightness"*) echo 100 ;;
    *"am start"*) run=$(echo "$*" | sed 's/.*--es run \([^ ]*\).*/\1/')
        n=1; while [ $n -le 4 ]; do sed "s/t=1.0s/t=$n.0s/; s/^17000000000/170000000$n/; s/RUN/$run/" "$here/line"; n=$((n+1)); done >> "$here/log"
        echo 'v=1,summary=1,t=4.0s' >> "$here/log"
        echo 'Status: ok' ;;
esac
"#;

#[cfg(unix)]
#[test]
fn adb_is_called_with_the_right_arguments() {
    use std::os::unix::fs::PermissionsExt;
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    write(at, "adb", FAKE_ADB);
    fs::set_permissions(at.join("adb"), fs::Permissions::from_mode(0o755)).unwrap();
    let log = fs::read_to_string(format!("{EXPERIMENTS}/recorded/prototype-yoro.log")).unwrap();
    let line = log.lines().find(|line| line.contains("t=1.0s,method")).unwrap();
    let message = line.split_once(": ").unwrap().1;
    write(
        at,
        "line",
        &format!("17000000000.500000  42  43 I YORO    : {message},frames=60,status=discharging,run=RUN\n"),
    );
    write(at, "log", "");
    let list = succeed(at, "device list --adb adb").stdout;
    assert!(
        list.contains("Fake phone") && list.contains("unauthorized") && !list.contains("imulated"),
        "{list}"
    );
    run(at, "device run --adb adb --serial FAKE2").refuses(&["FAKE2 does not trust"]);
    write(at, "a.apk", "");
    succeed(at, "device install --adb adb --apk a.apk");
    // Output of adb from issues of other projects: sndcpy 64, HyperSploit 54, InstallWithOptions 22, APK-Installer 25.
    for (said, words) in [
        ("Failure [INSTALL_FAILED_USER_RESTRICTED: Install canceled by user]", "Install via USB"),
        ("Failure [INSTALL_FAILED_VERSION_DOWNGRADE: Downgrade detected]", "a newer yoro is on FAKE1"),
        ("Failure [INSTALL_FAILED_NO_MATCHING_ABIS: Failed to extract, res=-113]", "processor of FAKE1"),
        ("Failure [INSTALL_FAILED_UPDATE_INCOMPATIBLE: ignoring!]", "signed with another key"),
        ("Failure [INSTALL_PARSE_FAILED_NOT_APK: x]", "(INSTALL_PARSE_FAILED_NOT_APK)"),
    ] {
        fs::create_dir_all(at.join("offline")).unwrap();
        write(at, "offline/refused.apk", &format!("adb: failed to install offline/refused.apk: {said}\n"));
        run(at, "device install --adb adb --apk offline/refused.apk").refuses(&[words]);
    }
    let gone = "adb: failed to run abb_exec. Error: cannot connect to daemon at tcp:5037\n";
    write(at, "refused.apk", gone);
    run(at, "device install --adb adb --apk refused.apk")
        .refuses(&["adb's server does not answer", "kill-server"]);
    write(at, "full.apk", "");
    run(at, "device install --adb adb --apk full.apk").refuses(&["storage of FAKE1 is full"]);
    let started = std::time::Instant::now();
    let said =
        run(at, "device run prototype --seconds 2 --warm-up-seconds 1 --brightness 100 --adb adb --out run");
    assert!(started.elapsed().as_secs() < 60, "{}", said.stderr);
    let asked = fs::read_to_string(at.join("asked")).unwrap();
    for words in [
        "shell am start -S -W -n io.github.yoro/android.app.NativeActivity --es scene prototype",
        "--es duration 4.5",
        "settings put system screen_brightness 100",
        "settings put system screen_off_timeout 86400000",
        "shell am force-stop io.github.yoro",
        "logcat -v threadtime -v epoch -v usec -T 1700000000.000000 YORO:V VrApi:V",
    ] {
        assert!(asked.contains(words), "{words}: {asked}");
    }
    assert_eq!(
        fs::read_to_string(at.join("put")).unwrap(),
        "system screen_off_timeout 30000\nglobal zen_mode 0\nsystem screen_brightness_mode 0\nsystem screen_brightness 100\n"
    );
    assert_eq!(said.code, Some(0), "{}", said.stderr);
    let capture = read(&at.join("run"));
    assert!(!capture.info.device.simulated && capture.info.device.model == "Fake phone");
    assert_eq!(capture.samples.len(), 4);
}

/// Writes a fake adb that runs this script for every command except `start-server`.
#[cfg(unix)]
fn fake_adb(at: &Path, script: &str) {
    use std::os::unix::fs::PermissionsExt;
    write(at, "adb", &format!("#!/bin/sh\n[ \"$1\" = start-server ] && exit 0\n{script}"));
    fs::set_permissions(at.join("adb"), fs::Permissions::from_mode(0o755)).unwrap();
}

#[cfg(unix)]
#[test]
fn a_missing_adb_server_is_not_reported_as_a_missing_device() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    // The message as quoted in flutter issue 125971.
    fake_adb(
        at,
        "echo 'List of devices attached'; echo '* daemon still not running' >&2; echo 'error: cannot connect to daemon at tcp:5037: Connection refused' >&2; exit 1\n",
    );
    run(at, "device list --adb adb").refuses(&[
        "adb's server does not answer",
        "Connection refused",
        "adb kill-server",
    ]);
    fake_adb(at, "echo 'List of devices attached'; echo; echo '* daemon started successfully' >&2\n");
    run(at, "device list --adb adb").refuses(&["no device is connected"]);
}

#[cfg(unix)]
#[test]
fn a_phone_by_cable_and_by_wifi_is_one_phone() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let fake = |serials: &[&str], own: &str| {
        let lines: String = serials.iter().map(|serial| format!("{serial}\\tdevice\\n")).collect();
        fake_adb(
            at,
            &format!(
                "if [ \"$1\" = devices ]; then printf 'List of devices attached\\n{lines}\\n'; exit; fi\ncase \"$*\" in *ro.serialno*) echo {own} ;; *install*) echo \"$2\" >> installed; echo Success ;; esac\n"
            ),
        );
        let _ = fs::remove_file(at.join("installed"));
    };
    write(at, "a.apk", "");
    let installed = || fs::read_to_string(at.join("installed")).unwrap().lines().count();
    // scrcpy issue 5967, ws-scrcpy-web pull request 532.
    let wireless = "adb-5C061JEA327610-bo0E0q (2)._adb-tls-connect._tcp";
    fake(&["5C061JEA327610", wireless, "192.168.86.190:37571"], "5C061JEA327610");
    let said = succeed(at, "device install --apk a.apk --all --adb adb");
    assert_eq!(installed(), 1, "{}", said.stdout);
    assert!(said.stderr.contains("are the same device: 5C061JEA327610 is used"), "{}", said.stderr);
    // Since they are one device, nothing has to be chosen.
    succeed(at, "device install --apk a.apk --adb adb");
    // All emulators of an image have the same serial number (marathon issue 223).
    fake(&["emulator-5554", "emulator-5556"], "EMULATOR28X0X23X0");
    succeed(at, "device install --apk a.apk --all --adb adb");
    assert_eq!(installed(), 2);
    run(at, "device install --apk a.apk --adb adb").refuses(&["several devices"]);
}
