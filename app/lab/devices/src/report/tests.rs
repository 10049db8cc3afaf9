use std::collections::BTreeMap;
use std::path::PathBuf;

use super::*;
use crate::capture::tests::info;
use crate::capture::{DeviceInfo, Fault, FaultKind, Outcome, RunInfo, Sample};

const WARM_UP: u32 = 10;
const DURATION: u32 = 100;
const MILLIVOLTS: f64 = 4000.0;

/// Makes up a run with a sample per second. Power is a function of time, in milliwatts.
fn made_up(method: &str, scene: &str, repetition: u32, power: impl Fn(f64) -> f64) -> Capture {
    let info = RunInfo {
        device: DeviceInfo {
            serial: "MADEUP1".into(),
            manufacturer: "Maker".into(),
            model: "Model 1".into(),
            android: "14".into(),
            capacity_mah: Some(4000.0),
            simulated: true,
        },
        method: method.into(),
        scene: scene.into(),
        repetition,
        settings: BTreeMap::new(),
        duration_s: f64::from(DURATION),
        warm_up_s: f64::from(WARM_UP),
        ..info()
    };
    let mut milliampere_hours = 0.0;
    let samples = (0..=WARM_UP + DURATION).map(|second| {
        let time_s = f64::from(second);
        let milliamperes = power(time_s) / MILLIVOLTS * 1e3;
        milliampere_hours += milliamperes / 3600.0;
        Sample {
            time_s,
            fps: Some(60.0),
            stale: Some(0.0),
            frame_ms: Some(1e3 / 60.0),
            current_ma: Some(-milliamperes),
            voltage_mv: Some(MILLIVOLTS),
            charge_uah: Some((3e6 - milliampere_hours * 1e3).round()),
            level_percent: Some((75.0 - milliampere_hours / 40.0).ceil()),
            plugged: Some(0),
            battery_celsius: Some(30.0 + time_s / 100.0),
            cpu_percent: Some(50.0),
            rss_mb: Some(200.0),
            ..Sample::default()
        }
    });
    Capture { samples: samples.collect(), info }
}

/// Makes up a run of yoro in the street with these milliwatts.
fn yoro(milliwatts: f64) -> Capture {
    made_up("yoro", "street", 1, |_| milliwatts)
}

/// Makes up a run of yoro in the street with these milliwatts, whose samples are then changed.
fn changed(milliwatts: f64, change: impl Fn(&mut Sample)) -> Capture {
    let mut capture = yoro(milliwatts);
    capture.samples.iter_mut().for_each(change);
    capture
}

/// Makes up a pair of runs with these milliwatts: by the baseline, and by yoro.
fn pair(scene: &str, repetition: u32, baseline: f64, ours: f64) -> [Capture; 2] {
    [("conventional", baseline), ("yoro", ours)]
        .map(|(method, milliwatts)| made_up(method, scene, repetition, |_| milliwatts))
}

fn run_of(capture: &Capture) -> Run {
    Run::of(capture, "folder".into(), 0, "device".into(), 1)
}

fn report_of(sets: &[&[Capture]], cells: &[(&str, u32)]) -> DeviceReport {
    let set = |set: &&[Capture]| set.iter().map(|capture| (PathBuf::from("run"), capture.clone())).collect();
    let sets: Vec<Vec<_>> = sets.iter().map(set).collect();
    let cells = cells.iter().map(|(serial, cells)| ((*serial).to_owned(), *cells)).collect();
    DeviceReport::new(&sets, "conventional", &cells, "a test".into())
}

fn report(captures: Vec<Capture>) -> DeviceReport {
    report_of(&[&captures], &[])
}

fn names(notes: &[Note]) -> Vec<&str> {
    notes.iter().map(|note| note.name).collect()
}

fn difference<'a>(report: &'a DeviceReport, scene: Option<&str>, quantity: Quantity) -> &'a Difference {
    let found = report.differences.iter().find(|d| d.scene.as_deref() == scene && d.quantity == quantity);
    found.unwrap_or_else(|| panic!("no {quantity:?} of {scene:?}"))
}

#[track_caller]
fn near(ours: f64, expected: f64, within: f64) {
    assert!((ours - expected).abs() <= within, "{ours} is not {expected}");
}

#[test]
fn power_is_integrated_over_the_times_without_warm_up() {
    // From 110 mW at the end of the warm-up, power rises by 2 mW per second. Trapezoids integrate this exactly.
    let run = run_of(&made_up("yoro", "street", 1, |t| if t < 10.0 { 9000.0 } else { 90.0 + 2.0 * t }));
    near(run.integrated.unwrap().seconds, 100.0, 1e-9);
    for (quantity, value) in [
        (Quantity::Power, 90.0 + 2.0 * 60.0),
        (Quantity::Fps, 60.0),
        (Quantity::Temperature, 30.6),
        (Quantity::Rise, 1.0),
    ] {
        near(run.values[&quantity], value, 1e-9);
    }
    assert_eq!(run.exclusions, []);
    // Irregular times: 400 mW, plus a triangle up to 800 mW that lasts one second.
    let mut uneven = yoro(400.0);
    let mut extra = uneven.samples[50].clone();
    extra.time_s += 0.5;
    extra.current_ma = Some(-300.0);
    uneven.samples.insert(51, extra);
    near(run_of(&uneven).integrated.unwrap().milliwatts, 404.0, 1e-9);
}

#[test]
fn gaps_are_not_bridged() {
    let mut capture = yoro(400.0);
    // Half of the gap would count with the power of the sample after it, if the gap were bridged.
    capture.samples.retain(|s| !(30.5..45.5).contains(&s.time_s));
    capture.samples.iter_mut().filter(|s| s.time_s == 46.0).for_each(|s| s.current_ma = Some(-1000.0));
    let run = run_of(&capture);
    let integrated = run.integrated.unwrap();
    near(integrated.seconds, 84.0, 1e-9);
    near(integrated.milliwatts, 400.0 + (4000.0 - 400.0) / 2.0 / 84.0, 1e-9);
    assert_eq!((run.gaps, run.covered_s), (1, 84.0));
    let report = report(vec![capture]);
    assert!(report.faults.iter().any(|note| note.name == "gaps" && note.detail.contains("84 s")));
}

#[test]
fn frame_times_are_means_over_frames() {
    let run = run_of(&changed(400.0, |sample| {
        if (sample.time_s as u32).is_multiple_of(2) {
            (sample.fps, sample.frame_ms, sample.gpu_ms) = (Some(20.0), Some(50.0), Some(40.0));
        }
    }));
    // 51 even seconds with 20 frames, 50 odd ones with 60.
    let frames = 51.0 * 20.0 + 50.0 * 60.0;
    near(run.values[&Quantity::Fps], frames / 101.0, 1e-9);
    near(run.values[&Quantity::FrameTime], 101e3 / frames, 1e-9);
    near(run.values[&Quantity::GpuTime], 40.0, 1e-9);
}

#[test]
fn the_charge_counter_agrees_or_is_named() {
    // The counter moves in steps of 1 mAh, one per 72 seconds at 50 mA.
    let coarse = |factor: f64| {
        changed(2000.0, |s| s.charge_uah = Some(1e3 * (3000.0 - factor * 500.0 / 3600.0 * s.time_s).floor()))
    };
    near(run_of(&coarse(1.0)).counted.unwrap().disagreement(), 0.0, 0.02);
    near(run_of(&coarse(1.3)).counted.unwrap().disagreement(), 0.3, 0.03);
    assert_eq!(names(&report(vec![coarse(1.3)]).faults), ["counter disagrees"]);
    assert!(report(vec![coarse(1.0)]).faults.is_empty());
    // A single step has no duration.
    let still = changed(2000.0, |s| s.charge_uah = Some(if s.time_s < 50.0 { 2e6 } else { 1.999e6 }));
    assert_eq!(run_of(&still).counted, None);
}

/// Phones by HONOR and Xiaomi count milliampere-hours (amply pull request 80).
#[test]
fn the_level_reveals_a_counter_in_milliampere_hours() {
    let capture = changed(20_000.0, |s| s.charge_uah = s.charge_uah.map(|charge| (charge / 1e3).round()));
    let counted = run_of(&capture).counted.unwrap();
    assert_eq!(counted.scale, 1e3);
    near(counted.disagreement(), 0.0, 0.02);
    assert_eq!(names(&report(vec![capture]).faults), ["counter in mAh"]);
}

#[test]
fn the_current_of_one_of_two_cells_doubles_power() {
    // The counter is that of the whole battery.
    let half = [changed(4000.0, |s| s.current_ma = s.current_ma.map(|current| current / 2.0))];
    assert_eq!(names(&report_of(&[&half], &[]).faults), ["two cells?"]);
    let whole = report_of(&[&half], &[("MADEUP1", 2)]);
    near(whole.runs[0].values[&Quantity::Power], 4000.0, 1e-9);
    assert!(whole.faults.is_empty(), "{:?}", whole.faults);
    assert!(whole.report().to_markdown().contains("current x 2 cells"));
    // The counter is also that of one cell, which the level reveals.
    let cell = [changed(40_000.0, |sample| {
        sample.current_ma = sample.current_ma.map(|current| current / 2.0);
        sample.charge_uah = sample.charge_uah.map(|charge| charge / 2.0);
    })];
    assert_eq!(names(&report_of(&[&cell], &[]).faults), ["two cells?"]);
    let counted = report_of(&[&cell], &[("MADEUP1", 2)]).runs[0].counted.unwrap();
    assert_eq!(counted.scale, 2.0);
    near(counted.disagreement(), 0.0, 0.02);
}

#[test]
fn implausible_power_is_named() {
    // A power of 3 W, once with a voltage of 4, once with a current that is 1000 times too large.
    let mut volts = changed(3000.0, |s| s.voltage_mv = Some(4.0));
    volts.info.faults.push(Fault {
        kind: FaultKind::VoltageInVolts,
        at_s: None,
        detail: "whole volts".into(),
    });
    let run = run_of(&volts);
    assert!(run.integrated.is_none() && run.exclusions[0].name == "voltage in V", "{:?}", run.exclusions);
    for milliwatts in [3.0, 300_000.0] {
        let report = report(vec![yoro(milliwatts)]);
        assert!(names(&report.faults).contains(&"implausible power"), "{milliwatts}: {:?}", report.faults);
    }
}

#[test]
fn two_equal_pairs_have_no_scatter() {
    let pairs = |factor: f64| {
        [1, 2].map(|repetition| {
            pair("street", repetition, 500.0, 400.0 * (1.0 + factor * f64::from(repetition)))
        })
    };
    let same = report(pairs(0.0).concat());
    assert!(same.to_text().contains("no scatter was seen"), "{}", same.to_text());
    assert!(!same.report().to_markdown().contains("[-20.0, -20.0]"), "{}", same.report().to_markdown());
    let text = report(pairs(0.01).concat()).to_text();
    assert!(text.contains("power -18.8 % (406 mW instead of 500 mW, 95 % interval"), "{text}");
}

#[test]
fn the_papers_power_estimate_has_steps_of_one_percent() {
    let mut capture = changed(2000.0, |s| s.level_percent = Some(if s.time_s < 60.0 { 80.0 } else { 79.0 }));
    // One percent of 4000 mAh at 3.7 V in 100 s.
    let by_level = run_of(&capture).by_level.unwrap();
    near(by_level.step_milliwatts, 40.0 * 3.7 * 36.0, 1e-9);
    near(by_level.milliwatts, by_level.step_milliwatts, 1e-9);
    capture.info.device.capacity_mah = None;
    assert_eq!(run_of(&capture).by_level, None);
}

#[test]
fn worthless_runs_are_left_out_with_the_reason() {
    let fault = |kind: FaultKind| Fault { kind, at_s: Some(40.0), detail: "it was so".into() };
    type Change<'a> = &'a dyn Fn(&mut Capture);
    let with = |kind: FaultKind| move |c: &mut Capture| c.info.faults.push(fault(kind));
    let with_outcome = |outcome: Outcome| move |c: &mut Capture| c.info.outcome = outcome.clone();
    let reason = || "it was so".to_owned();
    let cases: [(&str, bool, Change); 10] = [
        ("interrupted", false, &with_outcome(Outcome::Interrupted { reason: reason() })),
        ("failed", false, &with_outcome(Outcome::Failed { reason: reason() })),
        ("rebooted", false, &with(FaultKind::Rebooted)),
        ("application restarted", false, &with(FaultKind::Restarted)),
        ("too short", false, &|c| c.samples.truncate(60)),
        ("plugged in", true, &with(FaultKind::PluggedIn)),
        ("plugged in", true, &|c| c.samples[50].plugged = Some(2)),
        ("no current", true, &|c| c.samples.iter_mut().for_each(|s| s.current_ma = None)),
        ("current missing", true, &|c| c.samples[..60].iter_mut().for_each(|s| s.current_ma = None)),
        ("charging", true, &|c| c.samples.iter_mut().for_each(|s| s.current_ma = Some(100.0))),
    ];
    for (name, power_only, change) in cases {
        let mut capture = yoro(400.0);
        change(&mut capture);
        let run = run_of(&capture);
        let is_left_out = run.exclusions.iter().any(|e| e.name == name && e.power_only == power_only);
        assert!(is_left_out, "{name}: {:?}", run.exclusions);
        assert!(!run.values.contains_key(&Quantity::Power), "{name}");
        assert_eq!(run.values.contains_key(&Quantity::Fps), power_only, "{name}");
        assert!(names(&report(vec![capture]).left_out).contains(&name), "{name}");
    }
    for kind in [
        FaultKind::Disconnected,
        FaultKind::CurrentInMilliamperes,
        FaultKind::CurrentSign,
        FaultKind::ClockJump,
        FaultKind::DamagedLines,
        FaultKind::MissingLines,
        FaultKind::TooWarm,
        FaultKind::NoCurrent,
        FaultKind::VoltageInVolts,
        FaultKind::NotPinned,
        FaultKind::RefreshRate,
        FaultKind::Pictures,
    ] {
        let mut capture = yoro(400.0);
        capture.info.faults.push(fault(kind));
        assert_eq!(run_of(&capture).exclusions, [], "{kind:?}");
        let faults = report(vec![capture]).faults;
        let is_it = |note: &Note| note.name == kind.name() && note.detail.contains("at 40 s");
        assert!(faults.iter().any(is_it), "{kind:?}: {faults:?}");
    }
}

#[test]
fn changes_agree_with_scipy() {
    let check = |power: &Difference, [change, low, high]: [f64; 3]| {
        near(power.change, 100.0 * (change - 1.0), 1e-6);
        near(power.interval.unwrap()[0], 100.0 * (low - 1.0), 1e-6);
        near(power.interval.unwrap()[1], 100.0 * (high - 1.0), 1e-6);
        assert!(!power.rests_on_scenes());
    };
    // SciPy 1.17.1: exp of ttest_1samp's mean and interval of the logarithms of a / b.
    let a = [364.06, 362.14, 366.09, 368.54, 371.17];
    let b = [501.55, 498.23, 497.07, 504.75, 509.19];
    let report_of_pairs = report((0..5).flat_map(|i| pair("street", i as u32 + 1, b[i], a[i])).collect());
    for scene in [Some("street"), None] {
        let power = difference(&report_of_pairs, scene, Quantity::Power);
        check(power, [0.7296513565581347, 0.7244979729686504, 0.7348413963749809]);
        assert_eq!(power.pairs, 5);
    }
    let same = difference(&report_of_pairs, None, Quantity::Fps);
    assert_eq!((same.change, same.ours), (0.0, 60.0));
    // Scenes are fixed blocks, as in statsmodels' ordinary least squares of these logarithms of ratios.
    let groups =
        [("street", &[0.5f64, 0.52][..]), ("atrium", &[0.7]), ("conference", &[0.44, 0.4, 0.43, 0.45])];
    let pairs = groups.iter().flat_map(|(scene, logs)| {
        logs.iter().zip(1..).flat_map(|(log, repetition)| pair(scene, repetition, 500.0, 500.0 * log.exp()))
    });
    let logs = [0.5466666666666665, 0.5221807224094135, 0.5711526109239196];
    check(difference(&report(pairs.collect()), None, Quantity::Power), logs.map(f64::exp));
}

#[test]
fn without_repetitions_there_is_no_interval() {
    let pair = |scene: &str, power: f64| pair(scene, 1, 500.0, power);
    let one = report(pair("street", 400.0).to_vec());
    let power = difference(&one, None, Quantity::Power);
    near(power.change, -20.0, 1e-9);
    assert_eq!(power.interval, None);
    assert!(one.to_text().contains("nothing was repeated, so there is no interval"), "{}", one.to_text());
    assert!(one.means.iter().all(|mean| mean.sample.interval.is_none()));

    let scenes = report([pair("street", 400.0), pair("atrium", 350.0), pair("talk", 380.0)].concat());
    assert_eq!(difference(&scenes, Some("street"), Quantity::Power).interval, None);
    let [low, high] = difference(&scenes, None, Quantity::Power).interval.unwrap();
    assert!(low < -24.7 && high > -24.7, "{low} {high}");
    assert!(scenes.to_text().contains("intervals rest on the scenes"));
    assert!(scenes.report().to_markdown().contains("†"));
}

#[test]
fn pairs_need_a_partner_and_the_last_repetition_counts() {
    let mut captures = pair("street", 1, 500.0, 450.0).to_vec();
    captures.extend([yoro(300.0), made_up("yoro", "street", 2, |_| 400.0)]);
    captures[2].info.started_unix_s += 500.0;
    let report = report(captures.clone());
    let power = difference(&report, None, Quantity::Power);
    assert_eq!(power.pairs, 1);
    near(power.change, -40.0, 1e-9);
    assert_eq!(names(&report.left_out), ["measured again", "no partner"]);
    // The mean includes the run without a partner.
    let mean = report.means.iter().find(|m| m.method == "yoro" && m.quantity == Quantity::Power).unwrap();
    assert_eq!((mean.sample.n, mean.sample.mean), (2, 350.0));

    // The same folder given twice adds nothing. Another folder with the same numbers has further repetitions.
    let pair = &captures[..2];
    let mut later = pair.to_vec();
    later.iter_mut().for_each(|capture| capture.info.started_unix_s += 86_400.0);
    for (other, pairs) in [(pair, 1), (&later, 2)] {
        assert_eq!(difference(&report_of(&[pair, other], &[]), None, Quantity::Power).pairs, pairs);
    }
}

#[test]
fn devices_that_share_a_name_have_their_serial_numbers() {
    let on = |serial: &str, simulated: bool| {
        pair("street", 1, 500.0, 400.0).map(|mut capture| {
            capture.info.device.serial = serial.into();
            capture.info.device.simulated = simulated;
            capture
        })
    };
    let measured = report(on("A", false).to_vec());
    assert_eq!(measured.devices[0].name, "Maker Model 1");
    assert!(serde_json::to_string(&measured).unwrap().starts_with("{\"simulated\":false"));
    let report = report([on("A", false), on("B", false), on("C", true)].concat());
    let names: Vec<&str> = report.devices.iter().map(|device| device.name.as_str()).collect();
    assert_eq!(names, ["Maker Model 1 A", "Maker Model 1 B", "Maker Model 1 C (simulated)"]);
    assert!(report.report().to_html().unwrap().contains("partly simulated"));
}

#[test]
fn simulated_results_are_marked() {
    let report = report([pair("street", 1, 500.0, 450.0), pair("atrium", 1, 500.0, 400.0)].concat());
    let page = report.report();
    // Tables and plots are marked each, since they may be used on their own.
    let tables = page.sections.iter().flat_map(|section| section.tables().map(|table| &table.title));
    let plots: Vec<_> = page.sections.iter().flat_map(|section| section.plots()).collect();
    assert!(
        plots.len() >= 3 && plots.iter().all(|plot| plot.to_svg().unwrap().contains("simulated)\n</text>"))
    );
    let headings = page.sections.iter().map(|section| &section.heading);
    for title in tables.chain(plots.iter().map(|plot| &plot.title)).chain(headings).chain([&page.title]) {
        assert!(title.contains("simulated") || title == "How to read this", "{title}");
    }
    assert!(report.to_text().contains("come from simulated devices"));
}

#[test]
fn settings_under_one_name_must_be_the_same() {
    let mut other = made_up("yoro", "street", 2, |_| 400.0);
    other.info.settings.insert("render-scale".into(), "0.5".into());
    let report = report(vec![yoro(400.0), other]);
    let note = report.faults.iter().find(|note| note.name == "settings differ").unwrap();
    assert!(note.detail.contains("defaults; render-scale=0.5"), "{note:?}");
    assert!(report.to_text().contains("no run of conventional"), "{}", report.to_text());
}

#[test]
fn the_papers_changes_stand_beside_ours() {
    let methods = [("conventional", 500.0), ("yoro-paper", 400.0), ("hybrid", 450.0)];
    let of = |scene: &'static str| methods.map(|(method, power)| made_up(method, scene, 1, |_| power));
    let markdown = report([of("street"), of("talk")].concat()).report().to_markdown();
    // The paper's change of power in Bistro, which corresponds to the street, and its mean over the scenes.
    assert!(markdown.contains("*-26.7 %*") && markdown.contains("*-26.9 %*"), "{markdown}");
    assert!(markdown.contains("*+149.6 %*") && markdown.contains("Meta Quest 3, the paper's"));
}
