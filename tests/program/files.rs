//! How the program treats files: outputs never replace inputs, and only one process at a time appends to a file.

use std::fs;
use std::path::Path;

use crate::pair;
use crate::program::run;

const RATINGS: &str =
    "participant,method,scene,question,rating\nP1,yoro,street,q,3\nP1,conventional,street,q,3\n";

/// Returns all files below a folder with their contents.
fn contents(at: &Path) -> Vec<(String, Vec<u8>)> {
    let names = yoro_files::find(at, &["png", "log", "csv", "jsonl", "txt", "json", "exr", "md"]).unwrap();
    names.into_iter().map(|name| (name.display().to_string(), fs::read(at.join(name)).unwrap())).collect()
}

#[test]
fn no_output_replaces_an_input() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    for name in ["a.png", "b.png", "left/one.png", "left/sub/one.png", "right/one.png", "right/sub/one.png"] {
        yoro_media::save_color(&at.join(name), &pair::color(0.5)).unwrap();
    }
    fs::create_dir_all(at.join("data/prototype/group")).unwrap();
    for (name, text) in [
        ("p.csv", "participant,trial,scene,method,settings\nP1,1,street,yoro,\n"),
        ("ratings.csv", RATINGS),
        ("study.json", RATINGS),
        (
            "log.txt",
            "rating,v=1,participant=P1,trial=1,method=yoro,pipeline=gather,scene=street,question=q,value=3.0\n",
        ),
        ("report.md", "{}\n"),
        ("data/prototype/group/000000.json", "[{\"position\": [0, 1.6, 2], \"target\": [0, 1.2, 0]}]"),
    ] {
        fs::write(at.join(name), text).unwrap();
    }
    let before = contents(at);
    for (line, naming) in [
        ("compare a.png b.png --map a.png", "a.png is read, so the error map of a.png"),
        ("compare a.png b.png --map ./b.png", "b.png is read"),
        ("compare a.png b.png --mask b.png --map b.png", "b.png is read"),
        ("compare left right --map right", "one.png is read"),
        // The map of the first pair would replace a picture of the second pair.
        ("compare left right --map left/sub", "left/sub/one.png is read"),
        ("study collect log.txt --out log.txt", "log.txt is read, so the table of ratings"),
        ("study collect log.txt --plan p.csv --out p.csv", "p.csv is read"),
        ("study analyse study.json --out .", "study.json is read"),
        ("device logcat log.txt --out .", "log.txt is there already"),
        ("report report.md --out .", "report.md is read, so the report"),
        ("bench scenes --path p.csv --out p.csv", "p.csv is read, so the results"),
        (
            "dataset prototype --groups 1 --size 16 --out data --path data/prototype/group/000000.json",
            "000000.json is read, so the groups of prototype",
        ),
    ] {
        run(at, line).refuses(&[naming]);
        assert!(contents(at) == before, "yoro {line} has changed a file");
    }
}

#[test]
fn one_process_at_a_time_appends_to_a_file() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let held = yoro_files::append(&at.join("results.jsonl")).unwrap();
    let bench = "bench scenes --quick --rounds 1 --size 32x32 --scene prototype --out results.jsonl";
    run(at, bench).refuses(&["results.jsonl is being written by another yoro", "--out"]);
    drop(held);
}
