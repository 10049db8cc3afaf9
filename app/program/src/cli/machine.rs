//! The machine that figures are measured on.

use std::fs;
use std::time::{Duration, SystemTime};

use yoro_bench::machine::Machine;
use yoro_gl::Capabilities;

/// Describes this machine, the current time and this command line.
pub fn describe(capabilities: &Capabilities) -> Machine {
    Machine {
        cpu: cpu_name().unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
        cores: std::thread::available_parallelism().map_or(1, |n| n.get()),
        os: os_name().unwrap_or_else(|| std::env::consts::OS.to_owned()),
        gl_renderer: capabilities.renderer.clone(),
        gl_version: capabilities.version_string.clone(),
        yoro: env!("CARGO_PKG_VERSION").to_owned(),
        date: date(SystemTime::now()),
        command: command(),
    }
}

/// Returns the origin of a file: command line, program, version and date.
pub fn made_by() -> String {
    format!("{} (yoro {}, {})", command(), env!("CARGO_PKG_VERSION"), date(SystemTime::now()))
}

fn cpu_name() -> Option<String> {
    let info = fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = info.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

fn os_name() -> Option<String> {
    let release = fs::read_to_string("/etc/os-release").ok()?;
    let line = release.lines().find_map(|line| line.strip_prefix("PRETTY_NAME="))?;
    Some(line.trim_matches('"').to_owned())
}

/// Returns the command line, without the folder of the program.
fn command() -> String {
    let mut arguments = std::env::args();
    arguments.next();
    std::iter::once("yoro".to_owned()).chain(arguments).collect::<Vec<_>>().join(" ")
}

fn date(time: SystemTime) -> String {
    let seconds = time.duration_since(SystemTime::UNIX_EPOCH).unwrap_or(Duration::ZERO);
    humantime::format_rfc3339_seconds(SystemTime::UNIX_EPOCH + seconds).to_string()
}
