//! Ctrl-C.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::Stdio;

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
    interrupt(dir.path(), line, || files(&out).len() >= 12);
    for path in files(&out) {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        assert!(name.starts_with("prototype-") && name.ends_with(".png"), "{name} was left behind");
        image::open(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
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
