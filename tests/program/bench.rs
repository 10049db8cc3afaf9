//! `yoro bench`.

use std::fs;
use std::path::Path;

use serde_json::Value;
use yoro_scenes::hard_cases::{CASES, Case};

use crate::program::{folder, interrupt, run, succeed};

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
    let at = &folder();
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
        "yoro-holes-rendered",
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
    assert!(mean("yoro-holes-rendered", "psnr") > mean("yoro-gather", "psnr"));
    assert!(mean("yoro-gather", "flip") < mean("mono", "flip"));
    assert!(mean("yoro-paper", "visible_psnr") > mean("yoro-paper", "hole_psnr"));
    assert!(mean("yoro-gather", "texture_mib") > mean("mono", "texture_mib"));
    assert_eq!(values(&whole, "mono", "hole_share"), values(&whole, "yoro-paper", "hole_share"));
    assert!((0.0..0.3).contains(&mean("mono", "hole_share")));
    assert!((0.001..0.2).contains(&mean("yoro-holes-rendered", "open_share")));
    let draws = |contender: &str| mean(contender, "draw_calls");
    assert!(draws("yoro-gather") < draws("yoro-holes-rendered"));
    // Opaque surfaces are drawn for both eyes, and both have passes of their own.
    assert!(draws("yoro-holes-rendered") < 2.0 * draws("yoro-gather"));

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
    let at = &folder();
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
        text.lines().filter(|line| line.starts_with('|')).map(String::from).collect()
    };
    assert!(tables("parts").len() > 3);
    assert_eq!(tables("parts"), tables("whole"));
    run(at, &format!("{line} --shard 1/9")).refuses(&["1/9 is empty", "3 settings"]);
}

#[test]
fn sweeps_have_their_points_and_baselines() {
    let at = &folder();
    let line = "bench ipd styles flicker patchers --quick --scene prototype --size 96x96 --rounds 1 --out all.jsonl \
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

/// Every experiment that no other test runs goes through its measurements and has its section.
#[test]
fn the_other_experiments_are_measured_and_reported() {
    let at = &folder();
    let options = "--quick --scene talk --size 64x64 --rounds 1 --out r.jsonl";
    succeed(at, &format!("bench reprojection half-rate hard-cases foveation stream {options}"));
    let records = records(&at.join("r.jsonl"));
    let who = |label: &str| -> Vec<&str> {
        let measured = of_kind(&records, "measurement").into_iter().filter(|m| m["label"] == label);
        measured.map(|m| m["contender"].as_str().unwrap()).collect()
    };
    assert_eq!(who("canted eyes"), ["same-image", "gather-parallel-eyes", "any-view"]);
    assert_eq!(who("walk, 4 late"), ["same-image", "rotation", "any-view"]);
    for label in ["still", "walk, foveation medium, 90 degrees"] {
        let runtime = [
            "runtime-two-eyes",
            "runtime-one-eye",
            "runtime-one-eye-holes-rendered",
            "runtime-made-vectors",
            "rotation",
        ];
        let rest = ["yoro-full-rate", "same-image", "conventional"];
        assert_eq!(who(label), [&runtime[..], &rest].concat(), "{label}");
    }
    assert_eq!(who("60 degrees").len(), 9);
    succeed(at, "report r.jsonl --out out");
    let results = fs::read_to_string(at.join("out/report.md")).unwrap();
    for Case { name, seen, .. } in CASES {
        assert_eq!(who(name), ["mono", "yoro-gather", "yoro-holes-rendered"], "{name}");
        let quality = of_kind(&records, "measurement").into_iter().filter(|m| m["label"] == name);
        let psnr: Vec<f64> = quality.map(|m| m["values"]["psnr"][0].as_f64().unwrap()).collect();
        assert!(psnr.is_sorted() && psnr[0] < psnr[1], "{name}: {psnr:?}");
        assert!(results.contains(seen), "{name}: {results}");
    }
    for needed in
        ["## Any view", "## Half rate", "## Foveation", "one eye and depth, QP 20", "the paper's -39.6 %"]
    {
        assert!(results.contains(needed), "{needed}: {results}");
    }
    // Three quantizers, from fine to coarse: each costs more than the next one.
    let rates = results.lines().filter_map(|line| line.strip_prefix("| two eyes, rotation, QP "));
    let rates = rates.filter_map(|line| line.split(" | ").nth(1)?.trim_end_matches(" |").parse().ok());
    let rates: Vec<f64> = rates.take(3).collect();
    assert!(rates.len() == 3 && rates.is_sorted_by(|a, b| a > b), "{rates:?}: {results}");
}

#[test]
fn the_scenes_of_complexity_grow_in_even_steps() {
    let dir = tempfile::tempdir().unwrap();
    let line = "bench complexity --quick --size 64x64 --rounds 1 --contender mono --max-triangles 400000 --out c.jsonl";
    succeed(dir.path(), line);
    let records = records(&dir.path().join("c.jsonl"));
    let mut triangles: Vec<f64> =
        of_kind(&records, "round").iter().map(|r| r["point"].as_f64().unwrap()).collect();
    assert_eq!(triangles.len(), 5);
    triangles.insert(0, 2.0);
    assert!(
        triangles.windows(2).all(|w| (w[1] - w[0] - triangles[1] + 2.0).abs() < 1.0),
        "uneven steps: {triangles:?}"
    );
}

#[test]
fn mistakes_get_a_sentence() {
    let at = &folder();
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
