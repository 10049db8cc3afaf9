//! Ctrl-C.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::program::{Run, interrupt, press_ctrl_c, yoro};

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).collect()
}

#[test]
fn ctrl_c_ends_soon_and_leaves_whole_files() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let line = "render prototype --frames 5000 --size 64x64";
    let ended = interrupt(dir.path(), line, || files(&out).len() >= 12);
    assert!(ended.stderr.contains("of 5000 frames are in out"), "{}", ended.stderr);
    for path in files(&out) {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        assert!(name.starts_with("prototype-") && name.ends_with(".png"), "{name} was left behind");
        image::open(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

#[test]
fn ctrl_c_ends_a_wait_before_the_picture() {
    let dir = tempfile::tempdir().unwrap();
    let start = Instant::now();
    let line = "view prototype --png view.png --screen 400x200 --dpi 70 --do wait:60";
    interrupt(dir.path(), line, || start.elapsed() > Duration::from_secs(3));
    assert_eq!(files(dir.path()).len(), 0);
}

#[test]
fn ctrl_c_is_how_a_server_ends() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("index.html"), "").unwrap();
    let mut server = yoro("serve prototype --page . --port 0".split_whitespace());
    let server = server.current_dir(dir.path()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = server.spawn().unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    assert!(lines.any(|line| line.unwrap().ends_with("until Ctrl-C")));
    press_ctrl_c(&child);
    let ended = Run::new(child.wait_with_output().unwrap());
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
}
