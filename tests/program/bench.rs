//! `yoro bench`.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::program::{interrupt, run, succeed};

fn records(file: &Path) -> Vec<Value> {
    let text = fs::read_to_string(file).unwrap_or_default();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn of_kind<'a>(records: &'a [Value], kind: &str) -> Vec<&'a Value> {
    records.iter().filter(|r| r["record"] == kind).collect()
}

/// Returns the values of a contender's metric in the first round.
fn values(records: &[Value], contender: &str, metric: &str) -> Vec<f64> {
    let measurements = of_kind(records, "measurement");
    let found = measurements.iter().find(|m| m["contender"] == contender && m["round"] == 0);
    let found = found.unwrap_or_else(|| panic!("{contender} was not measured"));
    let values = found["values"][metric].as_array().unwrap_or_else(|| panic!("{contender}: no {metric}"));
    values.iter().map(|v| v.as_f64().unwrap_or(f64::INFINITY)).collect()
}

#[test]
fn every_method_has_its_row_and_a_cut_run_goes_on() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let line = "bench scenes --scene prototype --size 96x96 --viewpoints 2 --rounds 2 --out run.jsonl";
    let said = succeed(at, line).stdout;
    assert!(said.contains("scenes, prototype") && said.contains("results: run.jsonl"), "{said}");
    let file = at.join("run.jsonl");
    let whole = records(&file);
    assert_eq!(whole[0]["record"], "header");
    for contender in [
        "conventional",
        "instanced",
        "multiview",
        "hybrid",
        "shading-reprojection",
        "mono",
        "yoro-gather",
        "yoro-paper",
    ] {
        // Each contender is either measured or skipped with a reason.
        let rows = whole.iter().filter(|r| r["contender"] == contender);
        let (measured, left_out): (Vec<&Value>, Vec<&Value>) =
            rows.partition(|r| r["record"] == "measurement");
        match left_out.as_slice() {
            [] => {
                assert_eq!(measured.len(), 2, "{contender}: one measurement a round");
                assert!(measured.iter().all(|m| m["values"]["frame_ms"].as_array().unwrap().len() == 2));
                assert!(values(&whole, contender, "cpu_ms").iter().all(|ms| *ms > 0.0), "{contender}");
            }
            [one] => assert!(one["reason"].as_str().unwrap().len() > 10 && measured.is_empty(), "{one}"),
            _ => panic!("{contender} was left out more than once"),
        }
    }
    let mean = |contender: &str, metric: &str| {
        let values = values(&whole, contender, metric);
        values.iter().sum::<f64>() / values.len() as f64
    };
    assert!(mean("yoro-gather", "psnr") > mean("mono", "psnr") + 3.0);
    assert!(mean("yoro-gather", "flip") < mean("mono", "flip"));
    assert!(mean("yoro-paper", "visible_psnr") > mean("yoro-paper", "hole_psnr"));
    assert!(mean("yoro-gather", "texture_mib") > mean("mono", "texture_mib"));
    assert_eq!(values(&whole, "mono", "hole_share"), values(&whole, "yoro-paper", "hole_share"));
    assert!((0.0..0.3).contains(&mean("mono", "hole_share")));

    // As if the power failed in the middle of the second round.
    let text = fs::read_to_string(&file).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let first_round = 1 + lines.iter().position(|l| l.contains(r#""record":"round""#)).unwrap();
    let kept = lines[..first_round].join("\n");
    fs::write(&file, format!("{kept}\n{}\n{}", lines[first_round], &lines[first_round + 1][..40])).unwrap();
    succeed(at, line);
    let again = fs::read_to_string(&file).unwrap();
    assert!(again.starts_with(&kept), "the finished round was touched");
    assert_eq!(records(&file).len(), whole.len());
    // A repeated run has nothing left to measure.
    assert!(succeed(at, line).stderr.contains("1 of 1 settings are measured already"));
    assert_eq!(fs::read_to_string(&file).unwrap(), again);

    run(at, &line.replace("96x96", "80x80")).refuses(&["run.jsonl", "96 x 96", "80 x 80", "--out"]);
    assert_eq!(fs::read_to_string(&file).unwrap(), again);
}

#[test]
fn the_files_of_all_shards_are_one_run() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let line = "bench ipd --quick --scene prototype --size 32 --rounds 1 --contender yoro-gather";
    for part in ["1/2", "2/2"] {
        succeed(at, &format!("{line} --shard {part}"));
    }
    succeed(at, &format!("{line} --out whole.jsonl"));
    let parts = ["out/bench-ipd-quick-1of2.jsonl", "out/bench-ipd-quick-2of2.jsonl"];
    let records_of = |name: &str| -> Vec<Value> { records(&at.join(name)).split_off(1) };
    // Only quality is measured here, so all records are equal.
    assert_eq!(parts.map(records_of).concat(), records_of("whole.jsonl"));
    succeed(at, &format!("report {} {} --out parts", parts[0], parts[1]));
    succeed(at, "report whole.jsonl --out whole");
    let tables = |folder: &str| -> Vec<String> {
        let text = fs::read_to_string(at.join(folder).join("report.md")).unwrap();
        let (measured, _) = text.split_once("## How it was measured").unwrap();
        measured.lines().filter(|line| line.starts_with('|')).map(String::from).collect()
    };
    assert!(tables("parts").len() > 3);
    assert_eq!(tables("parts"), tables("whole"));
    run(at, &format!("{line} --shard 1/9")).refuses(&["1/9 is empty", "3 settings"]);
}

#[test]
fn sweeps_have_their_points_and_baselines() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let line = "bench ipd styles flicker imbuffer patchers --quick --scene prototype --size 96x96 --rounds 1 --out all.jsonl \
                --contender yoro-gather --contender yoro-paper --contender patcher-gather --contender patcher-median";
    succeed(at, line);
    let records = records(&at.join("all.jsonl"));
    let of_suite =
        |suite: &str| -> Vec<Value> { records.iter().filter(|r| r["suite"] == suite).cloned().collect() };
    let points = |suite: &str, key: &str| -> Vec<String> {
        let records = of_suite(suite);
        of_kind(&records, "scene").iter().map(|r| r[key].to_string().replace(['"', '.'], "")).collect()
    };
    assert_eq!(points("ipd", "point"), ["500", "630", "750"]);
    assert_eq!(points("styles", "label"), ["realistic", "cartoon", "low-poly", "voxel", "anime"]);
    assert_eq!(points("imbuffer", "point"), ["10", "20", "40", "80", "160"]);

    // A larger distance between the eyes makes the same image worse. Nothing is timed if only quality is requested.
    let ipd = of_suite("ipd");
    let mono: Vec<f64> = of_kind(&ipd, "measurement")
        .iter()
        .filter(|m| m["contender"] == "mono")
        .map(|m| m["values"]["psnr"][0].as_f64().unwrap())
        .collect();
    assert!(mono.len() == 3 && mono[0] > mono[2], "{mono:?}");
    assert!(of_kind(&ipd, "measurement").iter().all(|m| m["values"]["frame_ms"].is_null()));

    let flicker = of_suite("flicker");
    let change = values(&flicker, "conventional", "change");
    assert_eq!(change.len(), 3, "four frames have three steps between them");
    assert!(change.iter().all(|c| *c > 0.0));
    let [gather, mono] = ["yoro-gather", "mono"].map(|c| values(&flicker, c, "flicker").iter().sum::<f64>());
    assert!(gather < mono, "{gather} {mono}");

    let patchers = of_suite("patchers");
    for patcher in ["patcher-gather", "patcher-median"] {
        assert!(values(&patchers, patcher, "patch_ms")[0] > 0.0);
        assert!(values(&patchers, patcher, "psnr")[0] > values(&patchers, "mono", "psnr")[0]);
    }
    // All patchers get the same image, so they differ only in holes.
    let [a, b] = ["patcher-gather", "patcher-median"].map(|p| values(&patchers, p, "visible_psnr"));
    assert_eq!(a, b);
}

/// The devices in the estimate keep their own sizes, which takes most of the test's time.
#[test]
fn guard_bands_and_estimates_are_measured_and_reported() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let line = "bench guard-band shader-cost --quick --scene prototype --size 384x384 --viewpoints 1 --out both.jsonl";
    succeed(at, line);
    let records = records(&at.join("both.jsonl"));
    assert!(of_kind(&records, "unsupported").is_empty());
    let of = |contender: &str, metric: &str| values(&records, contender, metric);
    let mean = |contender: &str, metric: &str| {
        let values = of(contender, metric);
        values.iter().sum::<f64>() / values.len() as f64
    };
    let measured = of_kind(&records, "measurement");
    let who = |suite: &str| -> Vec<&str> {
        let rows = measured.iter().filter(|m| m["suite"] == suite && m["scene"] == "prototype");
        rows.map(|m| m["contender"].as_str().unwrap()).collect()
    };

    let bands = ["yoro-guard-none", "yoro-guard-1", "yoro-guard-0.5", "yoro-guard-auto"];
    assert_eq!(who("guard-band"), [&["conventional", "mono"][..], &bands].concat());
    let frames = of("conventional", "frame_ms").len();
    assert!(frames > 2, "{frames} frames");
    for contender in who("guard-band") {
        let times = of(contender, "frame_ms");
        assert!(times.len() == frames && times.iter().all(|ms| *ms > 0.0), "{contender}: {times:?}");
    }
    for band in bands {
        assert!(mean(band, "psnr") > mean("mono", "psnr") + 2.0, "{band}");
        let [border, all] = ["border_psnr", "psnr"].map(|metric| of(band, metric));
        assert!(border.len() == frames && border != all, "{band}: {border:?}");
    }
    let at_border = bands.map(|band| mean(band, "border_psnr"));
    assert!(at_border[1..].iter().all(|band| *band > at_border[0] + 0.5), "{at_border:?}");
    // Only one of the contenders chooses its guard band.
    for metric in ["guard_columns", "undrawn"] {
        let told = |m: &&&Value| !m["values"][metric].is_null();
        let tell: Vec<&str> =
            measured.iter().filter(told).map(|m| m["contender"].as_str().unwrap()).collect();
        assert_eq!(tell, ["yoro-guard-auto"], "{metric}");
    }
    let [columns, undrawn] = ["guard_columns", "undrawn"].map(|metric| of("yoro-guard-auto", metric));
    assert!(columns.len() <= frames && columns.len() > 1, "{columns:?}");
    // All 21 columns at first, then as many as are visible.
    assert!(columns.iter().all(|n| *n >= 10.0 && *n <= 21.0 && n.fract() == 0.0), "{columns:?}");
    assert!(columns.contains(&21.0) && columns.iter().any(|n| *n < 21.0), "{columns:?}");
    assert!(undrawn.iter().all(|n| *n >= 0.0 && *n < 384.0 * 384.0 / 100.0), "{undrawn:?}");

    let devices = ["quest-2", "quest-3", "mali-g57"];
    assert_eq!(who("shader-cost"), devices);
    for device in devices {
        let one = |metric: &str| match of(device, metric)[..] {
            [value] => value,
            ref values => panic!("{device}, {metric}: {values:?} of one viewpoint"),
        };
        let slots = ["slots_tiles", "slots_spans", "slots_march"].map(one);
        assert!(slots.iter().all(|n| *n > 1.0) && slots[2] > slots[0] + slots[1], "{device}: {slots:?}");
        let sum = slots.iter().sum::<f64>();
        assert!((sum - one("slots")).abs() < 1e-6 * sum && sum < 1000.0, "{device}: {slots:?}");
        // For each pixel, the march reads at least its tile's span and the colour.
        assert!(one("fetches") > 2.0 && one("fetches") < one("slots"), "{device}");
        // A wave takes as long as the slowest of its pixels. It uses the law only if all of its pixels do.
        for [pixel, wave] in
            [["trips_pixel", "trips_wave"], ["goes_on_pixel", "goes_on_wave"], ["law_wave", "law_pixel"]]
        {
            let [pixel, wave] = [one(pixel), one(wave)];
            // The two means are over different numbers of values, so they are rounded differently.
            assert!(pixel > 0.0 && pixel <= wave * (1.0 + 1e-12), "{device}: {pixel} and {wave}");
        }
        assert!(one("goes_on_wave") < 1.0, "{device}");
        for metric in ["alu_ms", "fetch_ms", "memory_ms"] {
            assert!(one(metric) > 0.01 && one(metric) < 100.0, "{device}: {metric} {}", one(metric));
        }
    }

    succeed(at, "report both.jsonl --out out");
    let results = fs::read_to_string(at.join("out/report.md")).unwrap();
    let (guard_band, shader_cost) = results.split_once("## Shader cost").expect("a section of each suite");
    assert!(guard_band.contains("## Guard band"), "{results}");
    for (section, rows) in [(guard_band, &bands[..]), (shader_cost, &devices)] {
        for row in rows {
            assert!(section.contains(&format!(" | {row} | ")), "{row}: {section}");
        }
    }
    let told = format!(
        " | {:.4} | {:.4} |",
        mean("yoro-guard-auto", "guard_columns"),
        mean("yoro-guard-auto", "undrawn")
    );
    assert!(guard_band.contains(&told), "{told}: {guard_band}");
    let page = fs::read_to_string(at.join("out/report.html")).unwrap();
    for needed in ["guard-band", "border_psnr", "yoro-guard-auto", "shader-cost", "mali-g57"] {
        assert!(page.contains(needed), "{needed}");
    }
}

#[test]
fn whole_frames_are_counted_for_every_method_and_gpu() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let line =
        "bench shader-cost --frame --quick --scene prototype --size 128x128 --viewpoints 1 --out f.jsonl";
    let refused = run(at, &format!("{line} --gl egl"));
    assert_eq!(refused.code, Some(2), "{}", refused.stderr);
    assert!(refused.stderr.contains("--gl osmesa"), "{}", refused.stderr);
    if std::env::var_os("YORO_TEST_WITHOUT_OSMESA").is_some() {
        return;
    }
    succeed(at, line);
    let records = records(&at.join("f.jsonl"));
    for label in ["bloom", "no bloom"] {
        let measured = of_kind(&records, "measurement").into_iter().filter(|m| m["label"] == label);
        let measured: Vec<&Value> = measured.collect();
        let sum = |contender: &str, prefix: &str| -> f64 {
            let own = measured.iter().find(|m| m["contender"] == contender).expect(contender);
            let values = own["values"].as_object().unwrap().iter();
            values
                .filter(|(name, _)| name.starts_with(prefix) && !name.contains("/vertices"))
                .map(|(_, v)| v[0].as_f64().unwrap())
                .sum()
        };
        for gpu in ["a650", "a740", "a750", "g52", "g57", "g610"] {
            let [two, both, ours] = ["conventional", "multiview", "yoro-gather"]
                .map(|contender| sum(contender, &format!("slots/{gpu}/")));
            // Without vertices, of which such small pictures have many per pixel, drawing both eyes at once costs the
            // same as two renders.
            assert!((0.9..1.1).contains(&(both / two)), "{gpu}: {both} of {two}");
            assert!(ours > 0.5 * two, "{gpu}: {ours} of {two}");
            // With levels, a fifth to two fifths of the pixels are rendered: less than as a whole, but not for nothing.
            let levels = ["conventional-medium", "yoro-medium"]
                .map(|contender| sum(contender, &format!("slots/{gpu}/")));
            assert!(levels[0] < two && levels[1] < ours && levels[1] < levels[0], "{gpu}: {levels:?}");
            assert!(levels[1] > 0.1 * two, "{gpu}: {levels:?} of {two}");
        }
        // Each pixel of both eyes shows either a surface or the sky.
        assert!(sum("conventional", "fragments/surfaces") >= 2.0);
        let [small, tiles, blits] =
            ["bytes-16/", "bytes/", "bytes-blit/"].map(|prefix| sum("yoro-gather", prefix));
        assert!(8.0 < small && small < tiles && tiles < blits, "{small} {tiles} {blits}");
        // Two renders carry no depth.
        assert_eq!(sum("conventional", "bytes-16/"), sum("conventional", "bytes/"));
        let depth = sum("yoro-gather", "fragments/carry");
        assert!(depth > 1.0, "depth is carried: {depth}");
    }
}

#[test]
fn scenes_beyond_the_bounds_are_left_out_with_the_reason() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let line = "bench complexity --quick --size 64x64 --rounds 1 --contender mono --max-triangles 400000 --max-memory-mib 25 --out c.jsonl";
    let said = succeed(at, line).stdout;
    let records = records(&at.join("c.jsonl"));
    let mut triangles: Vec<f64> =
        of_kind(&records, "round").iter().map(|r| r["point"].as_f64().unwrap()).collect();
    assert_eq!(triangles.len(), 5);
    triangles.insert(0, 2.0);
    assert!(
        triangles.windows(2).all(|w| (w[1] - w[0] - triangles[1] + 2.0).abs() < 1.0),
        "uneven steps: {triangles:?}"
    );
    let left_out = of_kind(&records, "unsupported");
    assert!(!left_out.is_empty() && !of_kind(&records, "measurement").is_empty(), "{records:?}");
    assert!(left_out.iter().all(|r| r["reason"].as_str().unwrap().contains("MiB are allowed")));
    assert!(said.contains("not measured: "), "{said}");
}

#[test]
fn mistakes_get_a_sentence() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    fs::write(at.join("other.jsonl"), "something else\n").unwrap();
    fs::write(at.join("path.json"), "[{\"position\":[0,1.6,0],\"target\":[0,1.6,-1]}]").unwrap();
    for (line, naming) in [
        ("bench", &["<SUITE>"][..]),
        ("bench speed", &["'speed'", "scenes", "patchers"]),
        ("bench scenes --contender magic", &["'magic'", "yoro-gather"]),
        ("bench patchers --contender hybrid", &["contenders", "patchers"]),
        ("bench scenes scenes", &["measured twice"]),
        ("bench scenes --scene bistroo", &["\"bistroo\""]),
        ("bench distance --object nowhere.obj", &["nowhere.obj"]),
        ("bench scenes --path nowhere.json", &["nowhere.json does not exist"]),
        ("bench scenes --rounds 0", &["--rounds"]),
        ("bench scenes --out other.jsonl", &["other.jsonl is not a result of yoro bench"]),
        (
            "bench flicker --scene prototype --size 64x64 --path path.json --out f.jsonl",
            &["camera path", "give another"],
        ),
    ] {
        run(at, line).refuses(naming);
    }
    assert_eq!(fs::read_to_string(at.join("other.jsonl")).unwrap(), "something else\n");
    assert!(!at.join("out").exists(), "something was written");
}

#[test]
fn ctrl_c_keeps_finished_rounds_and_says_how_to_go_on() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("long.jsonl");
    let line = "bench lights --scene prototype --size 64x64 --viewpoints 1 --rounds 1000 --contender mono --out long.jsonl";
    let rounds = || fs::read_to_string(&file).unwrap_or_default().matches(r#""record":"round""#).count();
    let said = interrupt(dir.path(), line, || rounds() >= 2).stderr;
    assert!(said.contains("interrupted") && said.contains("--out long.jsonl"), "{said}");
    let records = records(&file);
    assert_eq!(records.last().unwrap()["record"], "round");
    assert!(of_kind(&records, "round").len() < 1000);
}
