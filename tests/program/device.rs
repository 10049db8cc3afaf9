//! `yoro device` from end to end, with a fake adb. What is measured on a device and how is tested in app/lab/devices.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
#[cfg(unix)]
use std::process::Stdio;

use serde_json::Value;
#[cfg(unix)]
use yoro_devices::capture::Outcome;
use yoro_devices::capture::{self, Capture, FaultKind};

use crate::browser::{Browser, check_report};
#[cfg(unix)]
use crate::program::interrupt;
use crate::program::{finish, folder, run, succeed, yoro};

/// The experiments in the repository.
const EXPERIMENTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../lab/devices/experiments");
/// A log of the application in the simulated Android host.
const RECORDED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/program/recorded.log");

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

#[test]
fn mistakes_are_one_sentence() {
    let at = &folder();
    write(at, "e.toml", SMALL);
    write(at, "bad.toml", "colour = 1\n");
    write(at, "level.toml", &SMALL.replace("[[method]]", "min-level = 95\n[[method]]"));
    for (line, words) in [
        ("list --adb none", &["not found in none", "--adb FILE"][..]),
        ("list --replay bad.toml", &["--replay"]),
        ("install --adb none", &["target/apk/yoro.apk", "cargo xtask apk"]),
        ("experiment none.toml --adb none", &["none.toml"]),
        ("experiment bad.toml --dry-run", &["bad.toml", "colour"]),
        ("experiment level.toml --dry-run", &["level.toml", "min-level must be below charge-level"]),
        ("run --set speed=1 --adb none", &["speed"]),
        ("run --set stream=x --adb none", &["stream"]),
        ("logcat none.log", &["none.log", "does not exist"]),
    ] {
        run(at, &format!("device {line}")).refuses(words);
    }
    let homeless = yoro(["device", "list"])
        .current_dir::<&Path>(at)
        .env("PATH", "")
        .env_remove("ANDROID_HOME")
        .env_remove("ANDROID_SDK_ROOT")
        .output();
    let said = String::from_utf8(homeless.unwrap().stderr).unwrap();
    assert!(
        said.starts_with("error: adb was not found in PATH, ANDROID_HOME and ANDROID_SDK_ROOT: install"),
        "{said}"
    );
}

/// An experiment of three runs.
const SMALL: &str = "name = \"small\"\nseconds = 2\nwarm-up-seconds = 1\nrepetitions = 3\nscenes = [\"prototype\"]\nbrightness = 100\n[[method]]\nname = \"yoro\"\n";

#[test]
fn a_dry_run_is_a_plan() {
    let dir = tempfile::tempdir().unwrap();
    for (name, runs, length) in [("paper", 40, "7 h 1"), ("five-minutes", 4, "5 min")] {
        let line = format!("device experiment {EXPERIMENTS}/{name}.toml --dry-run");
        let said = succeed(dir.path(), &line).stdout;
        assert!(said.contains(&format!("{runs} runs on a device: {length}")), "{said}");
        assert_eq!(
            said.lines().filter(|line| line.trim_start().starts_with(|c: char| c.is_ascii_digit())).count(),
            runs + 1
        );
    }
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
}

#[test]
fn a_saved_log_becomes_a_capture() {
    let at = &folder();
    let said = succeed(at, &format!("device logcat {RECORDED} --out kept")).stdout;
    assert!(said.contains("SIMULATED: yoro in prototype: 12 samples, 0 damaged lines"), "{said}");
    let kept = read(&at.join("kept"));
    assert!(kept.info.device.simulated && kept.info.method == "yoro" && kept.samples.len() == 12);
    assert_eq!(fs::read(at.join("kept/log.txt")).unwrap(), fs::read(RECORDED).unwrap());
    // Via standard input: a log with a line that is cut off, an unknown key, and bytes that are not text.
    let mut bytes = fs::read(RECORDED).unwrap();
    let text = String::from_utf8(bytes.clone()).unwrap();
    let seventh = text.find("v=2,t=7.0s").unwrap();
    bytes.splice(seventh + 60..seventh + 70, *b"\xff\xfe\n");
    let more =
        text.lines().find(|line| line.contains("t=12.0s,method")).unwrap().replace("t=12.0s", "t=13.0s");
    bytes.extend_from_slice(format!("{more},gaze=0.25\n").as_bytes());
    fs::write(at.join("damaged.log"), bytes).unwrap();
    let input = fs::File::open(at.join("damaged.log")).unwrap();
    let run = finish(yoro("device logcat - --out damaged".split(' ')).current_dir::<&Path>(at).stdin(input));
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
    assert_eq!(damaged.samples.len(), 12);
    write(at, "none.log", "--------- beginning of main\n");
    crate::program::run(at, "device logcat none.log").refuses(&["none.log", "the tag YORO"]);
}

/// Captures the recorded log into a folder, as if this method had drawn this current on average.
fn capture_recorded(at: &Path, folder: &str, method: &str, milliamperes: u32) {
    let log = fs::read_to_string(RECORDED).unwrap().replace("scene=prototype", "scene=street");
    let log = log.replace("method=yoro", &format!("method={method}"));
    write(at, "made-up.log", &log.replace("mA=-512", &format!("mA=-{milliamperes}")));
    succeed(at, &format!("device logcat made-up.log --out {folder}"));
}

#[test]
fn captures_become_a_page_and_tables() {
    let at = &folder();
    capture_recorded(at, "captures/conventional", "conventional", 640);
    capture_recorded(at, "captures/yoro", "yoro", 512);
    let run = succeed(at, "device report captures --out out");
    assert!(run.stdout.contains("yoro:") && run.stdout.contains("2 of 2 runs"), "{}", run.stdout);
    let report: Value = serde_json::from_slice(&fs::read(at.join("out/report.json")).unwrap()).unwrap();
    assert_eq!((&report["simulated"], &report["baseline"]), (&true.into(), &"conventional".into()));
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
    let at = &folder();
    capture_recorded(at, "good", "yoro", 512);
    capture_recorded(at, "damaged", "yoro", 512);
    write(at, "damaged/run.json", "{");
    fs::create_dir(at.join("empty")).unwrap();
    fs::create_dir(at.join("out")).unwrap();
    write(at, "out/report.html", "made earlier");
    write(at, "file", "");
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

/// A shell script that answers like the program adb.
#[cfg(unix)]
const FAKE_ADB: &str = r#"#!/bin/sh
# A fake adb: one device, on which everything works. While the file "slow" is there, an application logs two lines and no
# end; if the file "ends" is there, the log ends once.
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
    logcat*)
        if [ -e "$here/ends" ]; then rm "$here/ends"; cat "$here/log"; exit 0; fi
        exec tail -n +1 -f "$here/log" ;;
    *boot_id*) echo one-boot ;;
    *date*) echo 1700000000.000000000 ;;
    "shell cat > "*) cat > "$here/put" ;;
    "shell cat /data/"*)
        if [ -e "$here/put" ]; then cat "$here/put"; exit 0; fi
        echo 'cat: No such file or directory' >&2; exit 1 ;;
    "shell cat "*) echo 'cat: No such file or directory' >&2; exit 1 ;;
    "shell rm "*) rm -f "$here/put" ;;
    *"dumpsys battery") printf '  AC powered: false\n  level: 80\n  temperature: 250\n' ;;
    *"dumpsys package"*) printf '    versionName=0.1.0\n' ;;
    *ro.serialno*) echo FAKE1 ;;
    *ro.product.model*) echo "Fake phone" ;;
    *"settings get system screen_off_timeout"*) echo 30000 ;;
    *"settings get"*zen_mode*|*"settings get"*low_power*) echo 0 ;;
    *"settings get system screen_brightness_mode"*) echo 0 ;;
    *"settings get system screen_brightness"*) echo 100 ;;
    *"am force-stop"*) : > "$here/log" ;;
    *"am start"*) run=$(echo "$*" | sed 's/.*--es run \([^ ]*\).*/\1/')
        n=1; lines=4; [ -e "$here/slow" ] && lines=2
        while [ $n -le $lines ]; do sed "s/t=1.0s/t=$n.0s/; s/^17000000000/170000000$n/; s/RUN/$run/" "$here/line"; n=$((n+1)); done >> "$here/log"
        [ -e "$here/slow" ] || echo 'v=2,summary=1,t=4.0s' >> "$here/log"
        echo 'Status: ok' ;;
esac
"#;

/// Writes a fake adb into a folder, and the line that its application logs.
#[cfg(unix)]
fn fake_device(at: &Path) {
    fake_program(at, FAKE_ADB);
    let log = fs::read_to_string(RECORDED).unwrap();
    let line = log.lines().find(|line| line.contains("t=1.0s,method")).unwrap();
    let message = line.split_once(": ").unwrap().1;
    write(
        at,
        "line",
        &format!("17000000000.500000  42  43 I YORO    : {}\n", message.replace("run=na", "run=RUN")),
    );
    write(at, "log", "");
}

#[cfg(unix)]
fn fake_program(at: &Path, script: &str) {
    use std::os::unix::fs::PermissionsExt;
    write(at, "adb", script);
    fs::set_permissions(at.join("adb"), fs::Permissions::from_mode(0o755)).unwrap();
}

#[cfg(unix)]
#[test]
fn adb_is_called_with_the_right_arguments() {
    let at = &folder();
    fake_device(at);
    let list = succeed(at, "device list --adb adb").stdout;
    assert!(
        list.contains("Fake phone") && list.contains("unauthorized") && !list.contains("imulated"),
        "{list}"
    );
    run(at, "device run --adb adb --serial FAKE2")
        .refuses(&["FAKE2 is not reached by adb (unauthorized)", "key"]);
    write(at, "a.apk", "");
    succeed(at, "device install --adb adb --apk a.apk");
    // Output of adb from issues of other projects: sndcpy 64, HyperSploit 54.
    fs::create_dir_all(at.join("offline")).unwrap();
    for reason in [
        "INSTALL_FAILED_USER_RESTRICTED: Install canceled by user",
        "INSTALL_FAILED_VERSION_DOWNGRADE: Downgrade",
    ] {
        let said = format!("adb: failed to install offline/refused.apk: Failure [{reason}]\n");
        write(at, "offline/refused.apk", &said);
        run(at, "device install --adb adb --apk offline/refused.apk")
            .refuses(&[&format!("refused.apk cannot be installed on FAKE1: {reason}")]);
    }
    write(at, "refused.apk", "adb: failed to run abb_exec. Error: cannot connect to daemon at tcp:5037\n");
    run(at, "device install --adb adb --apk refused.apk").refuses(&["cannot connect to daemon at tcp:5037"]);
    write(at, "full.apk", "");
    run(at, "device install --adb adb --apk full.apk")
        .refuses(&["full.apk cannot be installed on FAKE1", "INSTALL_FAILED_INSUFFICIENT_STORAGE"]);
    // The log ends at once: the connection is lost, and found again.
    write(at, "ends", "");
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
    assert_eq!(said.code, Some(0), "{}", said.stderr);
    let capture = read(&at.join("run"));
    assert!(!capture.info.device.simulated && capture.info.device.model == "Fake phone");
    assert_eq!(capture.samples.len(), 4);
    assert!(kinds(&capture).contains(&FaultKind::Disconnected), "{:?}", capture.info.faults);
}

#[cfg(unix)]
#[test]
fn an_experiment_goes_on_where_it_was_interrupted_or_killed() {
    let at = &folder();
    fake_device(at);
    write(at, "e.toml", SMALL);
    write(at, "slow", "");
    let line = "device experiment e.toml --adb adb --serial FAKE1 --out out";
    let held = yoro_files::append(&at.join("out/experiment.toml")).unwrap();
    run(at, line).refuses(&["out/experiment.toml is being written by another yoro"]);
    drop(held);
    let rows = |folder: &str| {
        let text = fs::read_to_string(at.join(folder).join("samples.csv")).unwrap_or_default();
        text.lines().count()
    };
    let first = "out/FAKE1/001-prototype-yoro-1";
    let stopped = interrupt(at, line, || rows(first) > 1);
    assert!(stopped.stderr.contains("the same command goes on"), "{}", stopped.stderr);
    let asked = fs::read_to_string(at.join("asked")).unwrap();
    assert!(asked.contains("settings put system screen_off_timeout 30000"), "given back: {asked}");
    assert!(!at.join("put").exists());
    assert!(matches!(read(&at.join(first)).info.outcome, Outcome::Interrupted { .. }));

    // A killed program cannot restore the settings. The next one does.
    let mut child = yoro(line.split(' '))
        .current_dir::<&Path>(at)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while rows(first) < 2 || !at.join(format!("{first}-cut-1")).exists() {
        assert_eq!(child.try_wait().unwrap(), None, "it has ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(
        fs::read_to_string(at.join("put")).unwrap(),
        "system screen_off_timeout 30000\nglobal zen_mode 0\nsystem screen_brightness_mode 0\nsystem screen_brightness 100\n"
    );
    fs::remove_file(at.join("slow")).unwrap();
    let said = succeed(at, line);
    assert!(said.stdout.contains("FAKE1: 3 of 3 runs complete"), "{}", said.stdout);
    assert!(said.stderr.contains("an earlier measurement had left changed"), "{}", said.stderr);
    assert!(!at.join("put").exists());
    let runs: Vec<Capture> = capture::find(&[at.join("out")]).unwrap().iter().map(|run| read(run)).collect();
    let outcomes = |complete: bool| {
        runs.iter().filter(|run| (run.info.outcome == Outcome::Complete) == complete).count()
    };
    assert_eq!((outcomes(true), outcomes(false)), (3, 2));
    let again = succeed(at, line).stdout;
    assert!(again.contains("3 of 3 runs complete (3 from before)"), "{again}");
    write(at, "e.toml", &SMALL.replace("seconds = 2", "seconds = 3"));
    run(at, line).refuses(&["out holds runs of another experiment", "--out"]);
}

/// Writes a fake adb that runs this script for every command except `start-server`.
#[cfg(unix)]
fn fake_adb(at: &Path, script: &str) {
    fake_program(at, &format!("#!/bin/sh\n[ \"$1\" = start-server ] && exit 0\n{script}"));
}

#[cfg(unix)]
#[test]
fn a_missing_adb_server_is_not_reported_as_a_missing_device() {
    let at = &folder();
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
    fake_adb(
        at,
        "printf 'List of devices attached\\nemulator-5554\\tdevice\\nemulator-5556\\tdevice\\n\\n'\n",
    );
    run(at, "device run --adb adb")
        .refuses(&["several devices are connected (emulator-5554, emulator-5556)"]);
}
