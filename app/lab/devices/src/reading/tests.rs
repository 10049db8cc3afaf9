use proptest::prelude::*;

use super::*;
use yoro_settings::telemetry::BatteryStatus;

fn line(time_s: f64) -> Line {
    Line {
        time_s,
        method: "yoro".into(),
        scene: "talk".into(),
        fps: Some(60.0),
        current_raw: Some(-512_000),
        current_ma: Some(-512.0),
        voltage_mv: Some(3900),
        plugged: Some(0),
        render_scale: 1.0,
        status: Some(BatteryStatus::Discharging),
        run: Some("r1".into()),
        ..Line::default()
    }
}

fn logged(clock: f64, pid: u32, text: &dyn std::fmt::Display) -> String {
    format!("{clock:.6}  {pid}  {pid} I YORO    : {text}")
}

fn sample(news: LineContent) -> Sample {
    match news {
        LineContent::Sample(sample) => *sample,
        other => panic!("{other:?}"),
    }
}

fn kinds(reading: &Reading) -> Vec<FaultKind> {
    reading.faults().iter().map(|fault| fault.kind).collect()
}

#[test]
fn a_good_log_has_no_faults() {
    let mut reading = Reading::new(Some("r1".into()));
    for i in 1..=60 {
        let text = logged(1e9 + i as f64, 7, &line(i as f64 * 1.02));
        assert_eq!(
            sample(reading.line(&text, None)).time_s,
            line(i as f64 * 1.02).to_string().parse::<Line>().unwrap().time_s
        );
    }
    assert_eq!((reading.samples(), reading.faults()), (60, Vec::new()));
    let other = Line { run: Some("before".into()), ..line(9.0) };
    assert_eq!(reading.line(&logged(1e9, 6, &other), None), LineContent::Other);
    assert_eq!(reading.line("--------- beginning of main", None), LineContent::Other);
    assert_eq!(reading.line(&logged(1e9, 7, &"yoro 0.1.0 starts"), None), LineContent::Other);
    assert_eq!(reading.line(&logged(1e9, 7, &"v=2,summary=1,t=60.0s"), None), LineContent::Summary);
}

#[test]
fn unknown_keys_stages_and_runtime_values_are_kept() {
    let mut reading = Reading::default();
    assert_eq!(reading.line("1000000000.2 1 2 I VrApi   : FPS=70/72", None), LineContent::Other);
    let runtime = "1000000000.5 1 2 I VrApi   : FPS=72/72,Stale=3,1171/441MHz,LCnt=2(DR72,LM2),GPU%=0.43";
    let mut text = line(1.0).to_string().replace("App=na", "App=2.00ms(march=1.500,lens=0.500)");
    let first = sample(reading.line(&logged(1e9, 7, &text), None));
    assert_eq!((first.other["VrApi.FPS"].as_str(), reading.samples()), ("70/72", 1));
    assert_eq!(reading.line(runtime, None), LineContent::Other);
    // The second line of App SpaceWarp (Meta's guide to it).
    let warp = "1000000000.6 1 2 I VrApi   : ASW=72, Type=App E=-0.000/0.250,D=0.000/0.000";
    assert_eq!(reading.line(warp, None), LineContent::Other);
    text = text.replace("t=1.0s", "t=2.0s") + ",gaze=0.5";
    let kept = sample(reading.line(&logged(1e9 + 1.0, 7, &text), None));
    let get = |key: &str| kept.other.get(key).map(String::as_str);
    assert_eq!((get("gaze"), get("App.march"), get("scale")), (Some("0.5"), Some("1.5"), Some("1.00")));
    assert_eq!(
        (get("VrApi.Stale"), get("VrApi.1"), get("VrApi.LCnt")),
        (Some("3"), Some("1171/441MHz"), Some("2(DR72,LM2)"))
    );
    assert_eq!((kept.stale, kept.gpu_ms, get("run")), (None, Some(2.0), None));
}

#[test]
fn placeholders_of_the_battery_are_left_out() {
    let read = |change: fn(&mut Line)| {
        let mut reading = Reading::default();
        let mut last = Sample::default();
        for i in 1..=3 {
            let mut line = line(i as f64);
            change(&mut line);
            last = sample(reading.line(&logged(1e9 + i as f64, 7, &line), None));
        }
        let faults = reading.faults();
        (last, faults.iter().map(|fault| (fault.kind, fault.detail.clone())).collect::<Vec<_>>())
    };
    use FaultKind::{NoCurrent, PluggedIn, VoltageInVolts};
    // Some phones give EXTRA_VOLTAGE in whole volts (PlusPlusBattery issue 5, home-assistant/android 4286).
    let (volts, faults) = read(|line| line.voltage_mv = Some(4));
    assert_eq!((volts.voltage_mv, faults.len(), faults[0].0), (None, 1, VoltageInVolts));
    let (_, faults) = read(|line| (line.current_raw, line.current_ma) = (Some(0), None));
    assert!(faults.len() == 1 && faults[0].0 == NoCurrent && faults[0].1.contains("is 0"), "{faults:?}");
    // The OVR Metrics Tool's placeholder, and Integer.MIN_VALUE (home-assistant/android 4977).
    for raw in [9999, -9999, -2_147_483_648] {
        let mut reading = Reading::default();
        let line = Line { current_raw: Some(raw), current_ma: Some(raw as f64), ..line(1.0) };
        assert_eq!(sample(reading.line(&logged(1e9, 7, &line), None)).current_ma, None);
        let faults = reading.faults();
        assert!(faults.len() == 1 && faults[0].detail.contains(&raw.to_string()), "{faults:?}");
    }
    let (_, faults) = read(|line| line.status = Some(BatteryStatus::NotCharging));
    assert_eq!((faults.len(), faults[0].0), (1, PluggedIn));
}

#[test]
fn each_fault_is_detected_and_named() {
    let mut reading = Reading::new(Some("r1".into()));
    let mut put = |clock: f64, pid: u32, line: &Line| reading.line(&logged(1e9 + clock, pid, line), None);
    put(1.0, 7, &line(1.0));
    // The clock goes back by an hour, but the session's time does not.
    put(2.0 - 3600.0, 7, &line(2.0));
    let cut = logged(1e9 + 3.0 - 3600.0, 7, &line(3.0));
    put(4.0 - 3600.0, 7, &Line { plugged: Some(2), ..line(4.0) });
    put(7.0 - 3600.0, 7, &Line { current_raw: Some(512), ..line(7.0) });
    put(8.0 - 3600.0, 7, &Line { current_raw: None, current_ma: None, thermal_status: Some(3), ..line(8.0) });
    // A new session begins twenty seconds later.
    let again = put(28.0 - 3600.0, 8, &line(1.0));
    assert_eq!(sample(again).time_s, 28.0);
    let run = cut.find("run=").unwrap();
    assert!(matches!(reading.line(&cut[..run + 4], None), LineContent::Damaged(_)));
    assert!(matches!(reading.line(&cut[..60], None), LineContent::Damaged(_)));
    use FaultKind::*;
    assert_eq!(
        kinds(&reading),
        [
            PluggedIn,
            NoCurrent,
            CurrentInMilliamperes,
            CurrentSign,
            ClockJump,
            DamagedLines,
            MissingLines,
            Restarted,
            TooWarm
        ]
    );
    let faults = reading.faults();
    assert!(faults[4].detail.contains("-3600.0 s"), "{faults:?}");
    assert_eq!((faults[4].at_s, faults[6].at_s), (Some(1.0), Some(2.0)));
    // 3, 5 and 6, and 9 to 27.
    assert!(faults[6].detail.starts_with("22 seconds"), "{faults:?}");
}

#[test]
fn raw_logs_may_contain_other_words() {
    let text = line(1.0).to_string();
    let of = |lines: &[&str]| {
        let mut reading = Reading::default();
        lines.iter().for_each(|line| drop(reading.line(line, None)));
        (reading.samples(), reading.damaged())
    };
    // In a log of bare messages, other words are messages as well.
    assert_eq!(of(&["yoro 0.1.0 starts", &text, "rating,v=2", &text[..50]]), (1, 1));
    let full = logged(1e9, 7, &text);
    assert_eq!(of(&["00I YORO    : v=2", &full, "10000000"]), (1, 2));
    assert_eq!(of(&["nothing", "of ours"]), (0, 0));
}

#[test]
fn a_senseless_device_clock_is_replaced_by_this_computers() {
    let mut reading = Reading::default();
    reading.line(&logged(1e9, 7, &line(50.0)), None);
    let after = sample(reading.line(&logged(5.0, 3, &line(1.0)), Some(40.0)));
    assert_eq!(after.time_s, 90.0);
}

proptest! {
    #[test]
    fn damaged_logs_never_panic(lines in proptest::collection::vec((0usize..400, ".{0,4}", any::<bool>()), 1..12)) {
        let mut reading = Reading::new(Some("r1".into()));
        let mut seen = 0;
        for (i, (at, with, cut)) in lines.iter().enumerate() {
            let mut text = logged(1e9 + i as f64, 7, &line(i as f64));
            let at = (*at).min(text.len());
            if *cut { text.truncate(at) } else { text.insert_str(at, with) }
            // Each line is a sample, is damaged, or has no data.
            seen += match reading.line(&text, None) { LineContent::Sample(_) => 1, _ => 0 };
        }
        prop_assert_eq!(reading.samples(), seen);
        let _ = reading.faults();
    }
}
