//! What is refused before a run, in one sentence with the remedy.

use indicatif::ProgressBar;
use yoro_devices::adb::{self, Adb as _, Device};
use yoro_devices::external_app::Subject;
use yoro_devices::run::{Other, Plan};

use super::experiments::small;
use super::replay::Replay;
use super::runs::{make, plan};

fn script(text: &str) -> String {
    format!("[[device]]\nserial = \"SIM1\"\n{text}\n")
}

fn chosen(replay: &Replay) -> Box<dyn Device> {
    adb::choose(replay, &[], false).unwrap().remove(0)
}

#[track_caller]
fn says(error: impl std::fmt::Display, words: &[&str]) {
    let error = error.to_string();
    assert!(!error.contains('\n'), "{error}");
    for words in words {
        assert!(error.contains(words), "{words:?} is not in: {error}");
    }
}

#[test]
fn devices_that_cannot_be_chosen() {
    let two = script("") + &script("").replace("SIM1", "SIM2");
    for (script, serials, words) in [
        ("seed = 1\n".to_owned(), &[][..], ["no device is connected", "USB debugging"]),
        (two.clone(), &[], ["SIM1, SIM2", "name one or some"]),
        (two, &["SIM3"], ["SIM3 is not connected", "yoro device list"]),
        (script("state = \"unauthorized\""), &[], ["SIM1 does not trust", "accept the key"]),
        (script("state = \"offline\""), &[], ["SIM1 is offline", "again"]),
        (script("state = \"recovery\""), &[], ["recovery", "start Android"]),
    ] {
        let serials: Vec<String> = serials.iter().map(|&serial| serial.into()).collect();
        says(adb::choose(&Replay::new(&script), &serials, false).err().unwrap(), &words);
    }
    // The only device that is ready is chosen.
    let replay = Replay::new(&(script("") + &script("state = \"offline\"").replace("SIM1", "SIM2")));
    assert_eq!(chosen(&replay).serial(), "SIM1");
}

#[test]
fn devices_that_cannot_be_measured() {
    let dir = tempfile::tempdir().unwrap();
    let wireless = |serial: &str, text: &str| format!("[[device]]\nserial = \"{serial}\"\n{text}\n");
    for (script, words) in [
        (script("installed = false"), ["not installed on SIM1", "yoro device install"]),
        (script("plugged = true"), ["tcpip 5555", "adb connect 192.0.2.7:5555"]),
        (script("battery-held = true"), ["set by hand", "adb -s SIM1 shell dumpsys battery reset"]),
        (script("settings = { \"global/low_power\" = \"1\" }"), ["battery saver of SIM1", "low_power 0"]),
        (wireless("adb-X (2)._adb-tls-connect._tcp", "plugged = true"), ["it already is", "charger off"]),
        (wireless("adb-X (2)._adb", "battery-held = true"), ["set by hand", "adb -s 'adb-X (2)._adb' shell"]),
    ] {
        let device = chosen(&Replay::new(&script));
        says(make(&*device, &plan(5.0), &dir.path().join("run")).unwrap_err(), &words);
    }
    assert!(!dir.path().join("run").exists());
    let device = &*chosen(&Replay::new(&script("")));
    let subject = Subject { package: "com.example.game".into(), process: "com.example.game".into() };
    let plan = Plan { other: Some(Other { subject, activity: ".Main".into() }), ..plan(5.0) };
    says(
        make(device, &plan, &dir.path().join("run")).unwrap_err(),
        &["com.example.game is not installed on SIM1", "pm list packages"],
    );
    let full = chosen(&Replay::new(&script("storage-full = true")));
    says(full.install("a.apk".as_ref()).unwrap_err(), &["storage of SIM1 is full", "remove"]);
}

#[test]
fn devices_that_cannot_be_left_alone() {
    let dir = tempfile::tempdir().unwrap();
    let experiment = small(dir.path(), "", "");
    for (script, words) in [
        (script("installed = false"), ["not installed on SIM1", "yoro device install"]),
        (script("plugged = true"), ["tcpip 5555", "allow a plugged-in device"]),
        (script("secure-lock = true"), ["locked by PIN", "none or swipe"]),
    ] {
        let device = chosen(&Replay::new(&script));
        let conducted = yoro_devices::experiment::conduct(
            &*device,
            &experiment,
            &dir.path().join("out"),
            &ProgressBar::hidden(),
        );
        says(conducted.unwrap_err(), &words);
    }
}

#[test]
fn a_run_replaces_no_other() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("once");
    let replay = Replay::new(&script(""));
    let device = replay.open("SIM1");
    make(&*device, &plan(5.0), &folder).unwrap();
    let before = std::fs::read(folder.join("run.json")).unwrap();
    says(make(&*device, &plan(5.0), &folder).unwrap_err(), &["once holds a run already"]);
    assert_eq!(std::fs::read(folder.join("run.json")).unwrap(), before);
}
