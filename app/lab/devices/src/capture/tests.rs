use std::fs;

use proptest::prelude::*;

use super::sample::COLUMNS;
use super::*;
use yoro_settings::telemetry::{LINE_KEYS, Line};

pub(crate) fn info() -> RunInfo {
    RunInfo {
        version: VERSION,
        device: DeviceInfo { serial: "S1".into(), simulated: true, ..DeviceInfo::default() },
        experiment: Some("test".into()),
        method: "yoro".into(),
        scene: "prototype".into(),
        repetition: 1,
        order: 1,
        settings: BTreeMap::from([("hud".into(), "false".into())]),
        started_unix_s: 1.7e9,
        duration_s: 60.0,
        warm_up_s: 5.0,
        start_celsius: None,
        application: Some("0.1.0".into()),
        outcome: Outcome::Complete,
        faults: Vec::new(),
    }
}

fn others(pairs: &[(&str, &str)]) -> BTreeMap<String, String> {
    pairs.iter().map(|(key, value)| ((*key).into(), (*value).into())).collect()
}

#[test]
fn a_capture_replaces_no_file_and_leaves_none_behind() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join(SAMPLES_FILE), "mine").unwrap();
    let error = Writer::create(dir.path(), info()).unwrap_err().to_string();
    assert!(error.contains("samples.csv is there already"), "{error}");
    assert_eq!(fs::read(dir.path().join(SAMPLES_FILE)).unwrap(), b"mine");
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
}

#[test]
fn a_run_is_readable_at_any_time() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("a/b");
    let mut writer = Writer::create(&folder, info()).unwrap();
    let none = read(&folder).unwrap();
    assert!(matches!(none.info.outcome, Outcome::Interrupted { .. }) && none.samples.is_empty());
    writer.log(b"one\n").unwrap();
    let first = Sample { time_s: 1.0, gpu_ms: Some(4.49), ..Sample::default() };
    writer.sample(&first).unwrap();
    let second = Sample {
        time_s: 2.1,
        current_raw: Some(-512_000),
        plugged: Some(0),
        other: others(&[("App.march", "1.5"), ("VrApi.LCnt", "2(DR72,LM2)"), ("odd", "a \"b\"")]),
        ..Sample::default()
    };
    writer.sample(&second).unwrap();
    let third = Sample { time_s: 3.0, other: others(&[("later", "1")]), ..Sample::default() };
    writer.sample(&third).unwrap();
    let fault = Fault { kind: FaultKind::ClockJump, at_s: Some(2.0), detail: "by an hour".into() };
    writer.change(|info| info.faults.push(fault.clone())).unwrap();
    let cut = read(&folder).unwrap();
    assert_eq!(cut.samples, [first.clone(), second.clone(), third.clone()]);
    assert_eq!(cut.info.faults, [fault]);
    let done = writer.finish(Outcome::Complete).unwrap();
    assert_eq!(read(&folder).unwrap().info, done);
    assert_eq!(fs::read_to_string(folder.join(LOG_FILE)).unwrap(), "one\n");
    let error = Writer::create(&folder, info()).unwrap_err().to_string();
    assert!(error.contains("log.txt is there already"), "{error}");
    // A last row that is incomplete is ignored.
    let path = folder.join(SAMPLES_FILE);
    let mut text = fs::read_to_string(&path).unwrap();
    assert!(text.starts_with("Time Stamp,average_frame_rate,display_refresh_rate,stale_frame_count,"));
    text.push_str("4000,72,7");
    fs::write(&path, &text).unwrap();
    assert_eq!(read(&folder).unwrap().samples, [first, second, third]);
    assert_eq!(find(&[dir.path().into(), folder.clone()]).unwrap(), [folder]);
    // A cell for a value that is not finite is read as `None`.
    let odd = dir.path().join("odd");
    let mut writer = Writer::create(&odd, info()).unwrap();
    writer.sample(&Sample { fps: Some(f64::NAN), stale: Some(f64::INFINITY), ..Sample::default() }).unwrap();
    assert_eq!(read(&odd).unwrap().samples, [Sample::default()]);
}

/// Other programs read these column names and cells.
#[test]
fn a_sample_row_has_every_column() {
    let line = "v=2,t=12.5s,method=yoro,pipeline=gather,scene=prototype,FPS=59.9/60,Stale=3,frame=16.68ms,p99=17.02ms,App=6.10ms(march=1.250),CPU=41.0%,RSS=212.4MB,mA_raw=-512000,mA=-512.0,mV=3921,level=87%,uAh=2712000,plug=2,Tbat=31.2C,Tskin=33.5C,thermal=1,headroom=0.42,scale=1.00,imbuffer=na,frames=60,status=discharging,run=a,perf=na,auto=na";
    let line: Line = line.parse().unwrap();
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("run");
    let mut writer = Writer::create(&folder, info()).unwrap();
    writer.sample(&Sample::of(&line)).unwrap();
    assert_eq!(
        fs::read_to_string(folder.join(SAMPLES_FILE)).unwrap(),
        "Time Stamp,average_frame_rate,display_refresh_rate,stale_frame_count,frame_time_milliseconds,frame_time_p99_milliseconds,app_gpu_time_microseconds,app_cpu_percentage_of_one_core,app_rss_MB,battery_current_raw,battery_current_now_milliamps,battery_voltage_millivolts,battery_level_percentage,battery_charge_microampere_hours,battery_plugged,battery_temperature_celcius,skin_temperature_celcius,thermal_status\n\
         12500,59.9,60,3,16.68,17.02,6100,41,212.4,-512000,-512,3921,87,2712000,2,31.2,33.5,1\n"
    );
    // Each column finds its key.
    assert!(COLUMNS.iter().all(|column| LINE_KEYS.iter().any(|key| key.name == column.key)));
}

#[test]
fn damaged_folders_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let sentence = |folder: &Path| read(folder).unwrap_err().to_string();
    assert!(sentence(dir.path()).contains("is no capture"));
    assert!(sentence(&dir.path().join("none")).contains("does not exist"));
    let error = find(&[dir.path().into()]).unwrap_err();
    assert!(error.to_string().starts_with("there is no capture in "), "{error}");
    let folder = dir.path().join("run");
    let mut writer = Writer::create(&folder, info()).unwrap();
    writer.sample(&Sample::default()).unwrap();
    let (run, samples) = (folder.join(RUN_FILE), folder.join(SAMPLES_FILE));
    let good = fs::read_to_string(&run).unwrap();
    for (damage, word) in [("{", "damaged"), ("{}", "missing field"), ("{\"version\":9}", "version 9")] {
        fs::write(&run, damage).unwrap();
        assert!(sentence(&folder).contains(word), "{}", sentence(&folder));
    }
    fs::write(&run, good.replace("\"scene\"", "\"scenery\"")).unwrap();
    assert!(sentence(&folder).contains("scenery"));
    fs::write(&run, good).unwrap();
    let table = fs::read_to_string(&samples).unwrap();
    for (row, word) in
        [("x,1\n", "2 cells"), ("abc,,,,,,,,,,,,,,,,,\n", "no number"), (",,,,,,,,,,,,,,,,,\n", "Time Stamp")]
    {
        fs::write(&samples, format!("{table}{row}")).unwrap();
        assert!(
            sentence(&folder).contains("line 3") && sentence(&folder).contains(word),
            "{}",
            sentence(&folder)
        );
    }
    fs::remove_file(&samples).unwrap();
    assert!(sentence(&folder).contains(SAMPLES_FILE));
}

proptest! {
    #[test]
    fn samples_survive_writing_and_reading(
        numbers in proptest::collection::vec(proptest::option::of(-1_000_000_000i64..1_000_000_000), 10),
        key in "[A-Za-z][A-Za-z./,\" ]{0,8}", value in "[ -~]{1,12}",
    ) {
        let real = |i: usize| numbers[i].map(|n| n as f64 / 1e3);
        let sample = Sample {
            time_s: real(0).unwrap_or(0.0), fps: real(1), stale: real(2), frame_ms: real(3), current_raw: numbers[4],
            current_ma: real(5), charge_uah: numbers[6].map(|n| n as f64), thermal_status: numbers[7].map(|n| n as i32),
            plugged: numbers[8].map(|n| n as i32), skin_celsius: real(9),
            other: others(&[(&key, &value)]), ..Sample::default()
        };
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path().join("run");
        let mut writer = Writer::create(&folder, info()).unwrap();
        writer.sample(&sample).unwrap();
        prop_assert_eq!(read(&folder).unwrap().samples, [sample]);
    }
}
