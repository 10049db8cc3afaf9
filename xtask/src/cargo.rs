//! Running cargo.

use std::env;
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context as _, bail};

/// The cargo that runs this program, in the workspace's root.
fn cargo() -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."));
    command
}

fn announce(arguments: &[&str]) {
    eprintln!("$ cargo {}", arguments.join(" "));
}

/// Runs cargo; the exit code of a program that it ran is passed on.
///
/// # Errors
/// When cargo itself cannot be started.
pub fn run(arguments: &[&str], more: &[String]) -> anyhow::Result<()> {
    // The user's paths are relative to where the user is.
    let here = env::current_dir().context("the current folder is gone: change to another")?;
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.toml");
    let status = cargo()
        .current_dir(here)
        .args(&arguments[..1])
        .arg("--manifest-path")
        .arg(manifest)
        .args(&arguments[1..])
        .args(more)
        .status()
        .context("cargo cannot be started")?;
    match status.code() {
        Some(0) => Ok(()),
        code => std::process::exit(code.unwrap_or(130)),
    }
}

/// Runs cargo and says whether it went well.
pub fn succeeds(arguments: &[&str], environment: &[(&str, &str)]) -> bool {
    announce(arguments);
    cargo().args(arguments).envs(environment.iter().copied()).status().is_ok_and(|status| status.success())
}

/// Counts of libtest's result lines, summed up.
#[derive(Default)]
struct Summary {
    passed: usize,
    failed: usize,
    ignored: usize,
    failures: Vec<String>,
}

impl Summary {
    fn take(&mut self, line: &str) {
        if let Some(counts) = line.strip_prefix("test result: ") {
            for part in counts.split([';', '.']) {
                let mut words = part.split_whitespace();
                match (words.next().and_then(|n| n.parse::<usize>().ok()), words.next()) {
                    (Some(n), Some("passed")) => self.passed += n,
                    (Some(n), Some("failed")) => self.failed += n,
                    (Some(n), Some("ignored")) => self.ignored += n,
                    _ => {}
                }
            }
        } else if let Some(name) = line.strip_prefix("test ").and_then(|l| l.strip_suffix(" ... FAILED")) {
            self.failures.push(name.to_owned());
        }
    }
}

/// An end-to-end test of the package has one of the filters in its name, and `part` as well. Without filters all of them are
/// wanted.
pub fn wants(package: &str, filters: &[String], part: &str) -> bool {
    if filters.is_empty() {
        return true;
    }
    let list = ["test", "--package", package, "--test", "*", "--quiet", "--", "--list"];
    let list = cargo().args(list).args(filters).output();
    // What does not compile is told when the tests are to be run.
    list.is_ok_and(|output| {
        let list = String::from_utf8_lossy(&output.stdout);
        list.lines().any(|line| line.strip_suffix(": test").is_some_and(|name| name.contains(part)))
    })
}

/// What some tests need, and others can do without.
#[derive(Clone, Debug, Default)]
pub struct Equipment {
    /// Mesa's rasterizer without a window system.
    pub osmesa: bool,
    /// The Android application.
    pub apk: Equipped,
    /// The simulated Android host for arm64.
    pub arm64: Equipped,
    /// A browser for report pages.
    pub browser: Equipped,
    /// The folder of Monado, an OpenXR runtime.
    pub monado: Equipped,
}

/// Is a file for tests here?
#[derive(Clone, Debug, Default)]
pub enum Equipped {
    /// No test that runs asks for it.
    #[default]
    NotWanted,
    /// It cannot be had on this machine: its tests are left out.
    Missing,
    /// Here.
    At(PathBuf),
}

impl Equipped {
    /// Tells the tests: by `YORO_TEST_name` where it is, or by `YORO_TEST_WITHOUT_name` that they are left out.
    fn tell(&self, name: &str, command: &mut Command) {
        match self {
            Self::At(path) => command.env(format!("YORO_TEST_{name}"), path),
            Self::Missing | Self::NotWanted => command.env(format!("YORO_TEST_WITHOUT_{name}"), "1"),
        };
    }
}

/// Runs all tests of the workspace, or those whose names contain one of the filters, and sums up.
///
/// # Errors
/// When a test fails or does not compile.
pub fn test(filters: &[String], bless: bool, equipment: &Equipment) -> anyhow::Result<()> {
    let start = Instant::now();
    let mut arguments = vec!["test", "--workspace", "--no-fail-fast", "--"];
    arguments.extend(filters.iter().map(String::as_str));
    announce(&arguments);
    let mut command = cargo();
    command.args(&arguments).stdout(Stdio::piped());
    // Golden images are made by Mesa's rasterizer; a GPU's own rounding is another question.
    if env::var_os("LIBGL_ALWAYS_SOFTWARE").is_none() {
        command.env("LIBGL_ALWAYS_SOFTWARE", "1");
    }
    if bless {
        command.env("YORO_BLESS", "1");
    }
    if !equipment.osmesa {
        command.env("YORO_TEST_WITHOUT_OSMESA", "1");
    }
    equipment.apk.tell("APK", &mut command);
    equipment.arm64.tell("ARM64_HOST", &mut command);
    equipment.browser.tell("CHROMIUM", &mut command);
    equipment.monado.tell("MONADO", &mut command);
    let mut child = command.spawn().context("cargo cannot be started")?;
    let mut summary = Summary::default();
    if let Some(stdout) = child.stdout.take() {
        for line in BufReader::new(stdout).lines() {
            let line = line.context("the tests print something that is not text")?;
            println!("{line}");
            summary.take(&line);
        }
    }
    let status = child.wait().context("cargo is gone")?;
    let Summary { passed, failed, ignored, failures } = summary;
    println!("{passed} passed, {failed} failed, {ignored} ignored in {:.0} s", start.elapsed().as_secs_f64());
    let absent = [
        ("OSMesa is not here", !equipment.osmesa),
        ("The APK cannot be built here (cargo xtask doctor)", matches!(equipment.apk, Equipped::Missing)),
        (
            "The simulated Android host for arm64 cannot be set up here (see the warning above)",
            matches!(equipment.arm64, Equipped::Missing),
        ),
        ("Chromium is not here", matches!(equipment.browser, Equipped::Missing)),
        (
            "Monado cannot be set up here (see the warning above)",
            matches!(equipment.monado, Equipped::Missing),
        ),
    ];
    for (what, _) in absent.iter().filter(|(_, missing)| *missing) {
        println!("{what}: what needs it was left out");
    }
    if bless {
        println!("golden images renewed: look at `git diff --stat tests/golden` and at the pictures");
    }
    if !failures.is_empty() {
        bail!("these tests failed: {}", failures.join(", "));
    }
    if !status.success() {
        bail!("cargo test failed: see above");
    }
    if passed == 0 {
        bail!("no test has one of these in its name: {}", filters.join(", "));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_summed_up() {
        let mut summary = Summary::default();
        for line in [
            "test a::b ... ok",
            "test a::c ... FAILED",
            "test result: FAILED. 3 passed; 1 failed; 0 ignored; 0 measured; 2 filtered out; finished in 0.01s",
            "test result: ok. 4 passed; 0 failed; 2 ignored; 0 measured; 0 filtered out; finished in 1.00s",
        ] {
            summary.take(line);
        }
        assert_eq!((summary.passed, summary.failed, summary.ignored), (7, 1, 2));
        assert_eq!(summary.failures, ["a::c"]);
    }
}
