//! `yoro dataset`, resumed, interrupted, and read again by `yoro synthesize`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use yoro_metrics::{Channels, Psnr, psnr};

use crate::program::{interrupt, run, succeed};

const KINDS: [&str; 7] = ["rgb", "depth", "truth", "reprojected", "reprojected-depth", "mask", "patched"];

fn times(folder: &Path) -> BTreeMap<PathBuf, SystemTime> {
    let files = yoro_files::find(folder, &["png", "json"]).unwrap();
    files
        .into_iter()
        .map(|file| (file.clone(), fs::metadata(folder.join(file)).unwrap().modified().unwrap()))
        .collect()
}

fn group(folder: &Path, index: u32) -> serde_json::Value {
    serde_json::from_slice(&fs::read(folder.join(format!("group/{index:06}.json"))).unwrap()).unwrap()
}

#[test]
fn only_what_is_missing_is_made() {
    let dir = tempfile::tempdir().unwrap();
    let line = "dataset prototype --groups 3 --size 64 --out data --patcher median";
    assert_eq!(succeed(dir.path(), line).stdout, "3 groups in data (3 new)\n");
    let scene = dir.path().join("data/prototype");
    let first = times(&scene);
    assert_eq!(first.len(), 3 * (KINDS.len() + 1) + 1);

    let pixels = fs::read(scene.join("patched/000001.png")).unwrap();
    let json = fs::read(scene.join("group/000001.json")).unwrap();
    // As after an interruption: some pictures, but no JSON.
    fs::remove_file(scene.join("patched/000001.png")).unwrap();
    fs::remove_file(scene.join("group/000001.json")).unwrap();
    assert_eq!(succeed(dir.path(), line).stdout, "3 groups in data (1 new)\n");
    assert_eq!(
        fs::read(scene.join("patched/000001.png")).unwrap(),
        pixels,
        "a group depends on its index alone"
    );
    assert_eq!(fs::read(scene.join("group/000001.json")).unwrap(), json);
    let second = times(&scene);
    for (file, time) in &first {
        let remade = file.to_string_lossy().contains("000001") || file.ends_with("dataset.json");
        assert!(remade || second[file] == *time, "{} was made again", file.display());
    }
    assert_eq!(succeed(dir.path(), line).stdout, "3 groups in data (0 new)\n");
    assert_eq!(times(&scene), second);

    run(dir.path(), &format!("{line} --ipd 0.07")).refuses(&[
        "prototype holds groups of other settings",
        "ipd",
        "--out",
    ]);
    run(dir.path(), &line.replace("median", "gather")).refuses(&["patcher \"median\" instead of \"gather\""]);
    assert_eq!(times(&scene), second, "a mistake changes nothing");
}

/// Array jobs may write into one folder, or into several that are later merged.
#[test]
fn the_parts_of_all_shards_are_one_run() {
    let dir = tempfile::tempdir().unwrap();
    let line = "dataset prototype talk --groups 2 --size 32";
    assert_eq!(succeed(dir.path(), &format!("{line} --out whole")).stdout, "4 groups in whole (4 new)\n");
    for (shard, groups) in [("1/3", 1), ("2/3", 1), ("3/3", 2), ("3/5", 1)] {
        let new = if shard == "3/5" { 0 } else { groups };
        let said = succeed(dir.path(), &format!("{line} --shard {shard} --out parts")).stdout;
        assert_eq!(said, format!("{groups} groups in parts ({new} new)\n"));
    }
    let content = |folder: &str| -> BTreeMap<PathBuf, Vec<u8>> {
        let folder = dir.path().join(folder);
        let files = yoro_files::find(&folder, &["png", "json"]).unwrap();
        files.into_iter().map(|file| (file.clone(), fs::read(folder.join(file)).unwrap())).collect()
    };
    let whole = content("whole");
    assert_eq!(whole.len(), 4 * (KINDS.len() + 1) + 2);
    assert_eq!(content("parts").into_keys().collect::<Vec<_>>(), whole.keys().cloned().collect::<Vec<_>>());
    assert!(content("parts") == whole, "a file differs");
    run(dir.path(), &format!("{line} --shard 0/3")).refuses(&["--shard", "1/8 up to 8/8"]);
}

/// Settings are compared with those in a file, so each number must be read as it was written.
#[test]
fn a_folder_is_continued_whatever_its_numbers() {
    let dir = tempfile::tempdir().unwrap();
    let path = "[{\"position\": [0.051, 1.6, 2.3], \"target\": [0.1, 1.2, -0.0575]}]";
    fs::write(dir.path().join("path.json"), path).unwrap();
    let line =
        "dataset prototype --groups 1 --size 16x16 --ipd 0.051 --near 0.03 --far 3.4e38 --path path.json";
    assert!(succeed(dir.path(), line).stdout.contains("(1 new)"));
    assert!(succeed(dir.path(), line).stdout.contains("(0 new)"));
}

/// The command in a group's JSON reproduces the other eye, for either eye and either depth convention, and by a patcher.
#[test]
fn groups_go_into_synthesize() {
    for options in [
        "",
        "--dominant left --reversed-z --far inf --fov-y-degrees 75 --ipd 0.05",
        "--pipeline paper --imbuffer 2 --no-linear-interpolation",
        "--patcher telea",
    ] {
        let dir = tempfile::tempdir().unwrap();
        succeed(dir.path(), &format!("dataset prototype --groups 2 --size 160x128 --out data {options}"));
        let scene = dir.path().join("data/prototype");
        let command = group(&scene, 1)["synthesize"].as_str().unwrap().to_owned();
        assert_eq!(command.contains(" --patcher telea"), options.contains("telea"), "{command}");
        let line = format!("{} --mask-out holes.png", command.strip_prefix("yoro ").unwrap());
        succeed(&scene, &line);
        let load = |name: &str| yoro_media::load_color(&scene.join(name)).unwrap();
        let likeness = |a: &str, b: &str| {
            let Psnr(db) = psnr(&load(a), &load(b), Channels::Rgb).unwrap();
            db
        };
        // 16-bit depth is slightly coarser than the depth buffer.
        let again = likeness("synthesized/000001.png", "patched/000001.png");
        assert!(again > 45.0, "{options}: {again:.2} dB");
        let (real, same) = (
            likeness("synthesized/000001.png", "truth/000001.png"),
            likeness("rgb/000001.png", "truth/000001.png"),
        );
        assert!(real > same + 4.0, "{options}: {real:.2} dB, the same image {same:.2} dB");
        let mask = |name: &str| yoro_media::load_mask(&scene.join(name)).unwrap();
        let (holes, stored) = (mask("holes.png"), mask("mask/000001.png"));
        let different = holes.iter().zip(stored.iter()).filter(|(a, b)| a != b).count();
        assert!(different * 200 < holes.len(), "{options}: {different} pixels of the mask differ");
        let share = stored.iter().filter(|m| **m == 0).count() as f64 / stored.len() as f64;
        assert_eq!(group(&scene, 1)["holes"].as_f64(), Some(share));
        assert!(share > 0.005, "{options}: {share}");
    }
}

#[test]
fn reprojected_and_patched_differ_in_holes_alone() {
    let dir = tempfile::tempdir().unwrap();
    succeed(dir.path(), "dataset prototype --groups 1 --size 96 --out data --patcher navier-stokes --msaa 4");
    let scene = dir.path().join("data/prototype");
    let load = |kind: &str| yoro_media::load_color(&scene.join(format!("{kind}/000000.png"))).unwrap();
    let mask = yoro_media::load_mask(&scene.join("mask/000000.png")).unwrap();
    let depth = yoro_media::load_depth(&scene.join("reprojected-depth/000000.png")).unwrap().image;
    let (reprojected, patched) = (load("reprojected"), load("patched"));
    for (x, y, mask) in mask.enumerate_pixels() {
        if mask.0[0] == 0 {
            assert_eq!(reprojected.get_pixel(x, y).0, [0; 3]);
            assert_eq!(depth.get_pixel(x, y).0[0], 1.0);
        } else {
            assert_eq!(reprojected.get_pixel(x, y), patched.get_pixel(x, y));
        }
    }
}

#[test]
fn ctrl_c_keeps_finished_groups() {
    let dir = tempfile::tempdir().unwrap();
    let line = "dataset prototype --groups 4000 --size 32 --out data";
    let groups = dir.path().join("data/prototype/group");
    let finished = || fs::read_dir(&groups).map_or(0, |entries| entries.count());
    interrupt(dir.path(), line, || finished() >= 4);
    let count = finished();
    for index in 0..count as u32 {
        for (_, name) in group(&dir.path().join("data/prototype"), index)["pictures"].as_object().unwrap() {
            image::open(dir.path().join("data/prototype").join(name.as_str().unwrap())).unwrap();
        }
    }
    assert_eq!(yoro_files::find(&dir.path().join("data"), &["part"]).unwrap(), Vec::<PathBuf>::new());
}

#[test]
fn mistakes() {
    let dir = tempfile::tempdir().unwrap();
    let refuses = |line: &str, naming: &[&str]| run(dir.path(), line).refuses(naming);
    refuses("dataset nowhere", &["nowhere"]);
    refuses("dataset prototype --groups 0", &["--groups"]);
    refuses("dataset prototype --half-angles-degrees 52,42", &["--half-angles-degrees", "symmetric"]);
    refuses("dataset prototype --path none.json", &["none.json does not exist"]);
    fs::write(dir.path().join("path.json"), "[{\"position\": [0, 1, 2]}]").unwrap();
    refuses("dataset prototype --path path.json", &["path.json is not a camera path"]);
    fs::write(dir.path().join("path.json"), "[]").unwrap();
    refuses("dataset prototype --path path.json", &["path.json is not a camera path", "no viewpoint"]);
    fs::write(dir.path().join("noise.onnx"), "noise").unwrap();
    // Its own tests refuse files that are not models.
    if cfg!(not(feature = "neural")) {
        refuses(
            "dataset prototype --groups 1 --size 32 --patcher neural",
            &["no neural patcher", "--features neural"],
        );
    }
    refuses("dataset prototype --patcher xiao --model noise.onnx", &["--model goes with --patcher neural"]);
    fs::create_dir_all(dir.path().join("dataset/prototype")).unwrap();
    fs::write(dir.path().join("dataset/prototype/dataset.json"), "{").unwrap();
    refuses("dataset prototype", &["dataset.json is damaged", "--out"]);
}
