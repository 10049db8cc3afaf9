//! The largest scene fits a small machine.

use std::fs;
use std::process::Stdio;
use std::thread;
use std::time::Duration;

use crate::program::yoro;

const LIMIT_MIB: u64 = 1500;

/// Returns the peak memory of a running process so far, in MiB.
fn peak(process: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? / 1024)
}

#[test]
fn the_largest_scene_stays_below_the_limit() {
    let dir = tempfile::tempdir().unwrap();
    let arguments = ["render", "voxel", "--size", "512x512"];
    let mut child = yoro(arguments).current_dir(dir.path()).stdout(Stdio::null()).spawn().unwrap();
    let mut highest = 0;
    // The peak only grows, so at most the last few milliseconds are missed.
    let status = loop {
        highest = highest.max(peak(child.id()).unwrap_or(0));
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        thread::sleep(Duration::from_millis(5));
    };
    assert!(status.success());
    println!("peak: {highest} MiB");
    assert!((100..LIMIT_MIB).contains(&highest), "{highest} MiB instead of at most {LIMIT_MIB}");
}
