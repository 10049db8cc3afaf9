//! Ctrl-C.

use std::fs;
use std::path::{Path, PathBuf};

use crate::program::interrupt;

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
