//! Ctrl-C.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::program::yoro;

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).collect()
}

#[test]
fn ends_soon_and_leaves_whole_files_only() {
    let dir = tempfile::tempdir().unwrap();
    let arguments = ["render", "prototype", "--frames", "5000", "--size", "64x64"];
    let mut child =
        yoro(arguments).current_dir(dir.path()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let out = dir.path().join("out");
    let start = Instant::now();
    while files(&out).len() < 12 {
        assert!(start.elapsed() < Duration::from_secs(120), "no pictures");
        assert_eq!(child.try_wait().unwrap(), None, "it has ended by itself");
        thread::sleep(Duration::from_millis(20));
    }
    let killed = Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert!(killed.success());
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if start.elapsed() > Duration::from_secs(20) {
            child.kill().unwrap();
            panic!("it goes on after Ctrl-C");
        }
        thread::sleep(Duration::from_millis(20));
    };
    assert_eq!(status.code(), Some(130));
    for path in files(&out) {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        assert!(name.starts_with("prototype-") && name.ends_with(".png"), "{name} was left behind");
        image::open(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}
