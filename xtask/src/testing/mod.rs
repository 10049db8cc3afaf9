//! Runs all tests of the workspace: cargo compiles them, and several processes run them at a time.
//!
//! Differences from `cargo test`: several processes run at a time rather than several threads, since Mesa's rasterizer
//! occasionally crashes when two threads of a process draw; after a crash, the other tests still run; failed tests run
//! once more, alone; and what tests need is fetched and built meanwhile. cargo-nextest provides most of this, but depends
//! on 400 packages, which a fresh clone would have to compile first.

mod equipment;
mod run;

use std::env;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Instant;

use anyhow::{Context as _, bail};
use serde_json::Value;

use crate::cargo::{self, cargo};
use crate::{apt, setup};

use equipment::{Equipment, Preparation};
use run::Run;

/// Parts of `program name` of the tests that must not run beside others.
///
/// Almost all tests can: each has its own folders, ports are pipes, and time is either processor time or simulated.
const ALONE: [&str; 2] = [
    // A small machine does not have enough memory for two large scenes.
    "yoro-cli::program memory::",
    // In qemu, beside other tests, the first frames take longer than a minute.
    "yoro-android-host::apk the_arm64_library",
];
/// Number of unit tests per process. Each takes milliseconds, while an integration test takes seconds and has its own.
const UNIT: usize = 60;

/// Set up, then run all tests
#[derive(clap::Args, Clone, Debug, Default)]
pub struct Options {
    /// Run only tests whose names contain one of these; tests in documentation only if no other test fits
    pub filters: Vec<String>,
    /// Run only the tests of these packages, without those in documentation
    #[arg(long = "package", short, value_name = "NAME")]
    pub packages: Vec<String>,
    /// Renew the golden images of tests/golden instead of comparing with them
    #[arg(long)]
    pub bless: bool,
    /// Run this many test processes at a time [default: one for each processor]
    #[arg(long, value_name = "N")]
    pub jobs: Option<NonZeroUsize>,
}

/// A test program.
#[derive(Clone, Debug)]
struct Program {
    /// The name in messages: the package, and the target unless it is the package's library.
    label: String,
    package: String,
    /// True for integration tests. Each takes seconds, while unit tests take milliseconds.
    is_integration: bool,
    executable: PathBuf,
    /// The package's folder, in which cargo runs it.
    folder: PathBuf,
    /// The names of the selected tests.
    tests: Vec<String>,
}

/// The work of one process: a program's tests, or all tests in documentation if there is no program.
#[derive(Clone, Debug)]
struct Job<'a> {
    program: Option<&'a Program>,
    tests: Vec<String>,
}

/// All jobs, in groups that run one after another.
#[derive(Debug, Default)]
struct Plan<'a> {
    /// Tests that need nothing that is built.
    first: Vec<Job<'a>>,
    /// Tests that need something that is built.
    equipped: Vec<Job<'a>>,
    /// The tests in [`ALONE`].
    alone: Vec<Job<'a>>,
}

/// Compiles and runs the selected tests of the workspace, or all, and prints a summary.
pub fn test(options: &Options) -> anyhow::Result<()> {
    let start = Instant::now();
    apt::install_missing(|| vec![setup::cpp()], true)?;
    let is_all = options.filters.is_empty() && options.packages.is_empty();
    thread::scope(|scope| {
        let preparation = is_all.then(|| Preparation::begin(scope, None)).transpose()?;
        let programs = compile(options)?;
        let mut run = Run::default();
        let mut preparation = match preparation {
            Some(preparation) => preparation,
            None => Preparation::begin(scope, Some(&programs))?,
        };
        run.equipment = preparation.libraries()?;
        run.equip(preparation.fetched());
        let plan = plan(&programs, options);
        run.total = programs.iter().map(|program| program.tests.len()).sum();
        let workers =
            options.jobs.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZeroUsize::get);
        // The first worker builds, since cargo keeps but one processor busy while it links and optimizes whole programs.
        let mut prepared = Ok(Equipment::default());
        let prepare = || prepared = preparation.built();
        run.perform(plan.first, workers, options, prepare)?;
        run.equip(prepared?);
        run.perform(plan.equipped, workers, options, || ())?;
        run.perform(plan.alone, 1, options, || ())?;
        run.retry(options)?;
        if options.bless {
            println!("golden images renewed: look at `git diff --stat tests/golden` and at the pictures");
        }
        run.conclude(start)
    })
}

/// Compiles the selected packages' tests, and lists those that the filters select.
fn compile(options: &Options) -> anyhow::Result<Vec<Program>> {
    let mut arguments = vec!["test", "--no-run", "--message-format=json-render-diagnostics"];
    arguments.extend(cargo::choice(&options.packages));
    cargo::announce(&arguments);
    let messages = cargo::output(&arguments)?;
    let mut programs: Vec<Program> = messages.lines().filter_map(parse).collect();
    // Integration tests come first, since they take longer. Cargo reports programs in the order in which it finishes them.
    programs.sort_by(|a, b| b.is_integration.cmp(&a.is_integration).then(a.label.cmp(&b.label)));
    for program in &mut programs {
        program.tests = list(program)?;
        let fits = |name: &String| options.filters.iter().any(|filter| name.contains(filter));
        program.tests.retain(|name| options.filters.is_empty() || fits(name));
    }
    Ok(programs)
}

/// Parses the test program in one of cargo's messages.
fn parse(message: &str) -> Option<Program> {
    let message: Value = serde_json::from_str(message).ok()?;
    if message["reason"] != "compiler-artifact" || message["profile"]["test"] != true {
        return None;
    }
    let executable = PathBuf::from(message["executable"].as_str()?);
    // `path+file:///folder/name#version` or `path+file:///folder#name@version`
    let (place, rest) = message["package_id"].as_str()?.rsplit_once('#')?;
    let package = rest.split_once('@').map(|(name, _)| name).or_else(|| place.rsplit('/').next())?;
    let (kind, target) = (message["target"]["kind"][0].as_str()?, message["target"]["name"].as_str()?);
    let label = match kind {
        "test" => format!("{package}::{target}"),
        "bin" | "example" => format!("{package}::{kind}/{target}"),
        _ => package.to_owned(),
    };
    let folder = PathBuf::from(message["manifest_path"].as_str()?).parent()?.to_owned();
    let (package, is_integration) = (package.to_owned(), kind == "test");
    Some(Program { label, package, is_integration, executable, folder, tests: Vec::new() })
}

/// Returns the names of a program's tests in the order in which it runs them.
fn list(program: &Program) -> anyhow::Result<Vec<String>> {
    let mut command = program.command();
    let output = command.args(["--list", "--format", "terse"]).stderr(Stdio::inherit()).output();
    let output = output.with_context(|| format!("{} cannot be started", program.executable.display()))?;
    if !output.status.success() {
        bail!("{} cannot list its tests ({})", program.label, output.status);
    }
    let listing = String::from_utf8_lossy(&output.stdout);
    Ok(listing.lines().filter_map(|line| line.strip_suffix(": test")).map(str::to_owned).collect())
}

impl Program {
    fn command(&self) -> Command {
        let mut command = Command::new(&self.executable);
        command.current_dir(&self.folder).stdin(Stdio::null());
        command
    }

    /// True if a test must not run beside others.
    fn is_alone(&self, test: &str) -> bool {
        let full = format!("{} {test}", self.label);
        ALONE.iter().any(|part| full.contains(part))
    }
}

impl Job<'_> {
    /// Returns the name in messages.
    fn name(&self) -> String {
        match (self.program, &self.tests[..]) {
            (None, _) => "documentation".to_owned(),
            (Some(program), [test]) => format!("{} {test}", program.label),
            (Some(program), tests) => format!("{}, {} tests", program.label, tests.len()),
        }
    }

    fn command(&self, options: &Options, equipment: &Equipment) -> Command {
        let mut command = match self.program {
            Some(program) => {
                let mut command = program.command();
                command.args(["--exact", "--test-threads=1"]).args(&self.tests);
                // Not captured if it is one, so that output before a crash is not lost; else to be found by its name.
                command.arg(if self.tests.len() == 1 { "--nocapture" } else { "--show-output" });
                command
            }
            None => {
                let mut command = cargo();
                command.args(["test", "--workspace", "--doc", "--no-fail-fast", "--"]).args(&options.filters);
                command.stdin(Stdio::null());
                command
            }
        };
        // The golden images were made with Mesa's rasterizer. A GPU would round differently.
        if env::var_os("LIBGL_ALWAYS_SOFTWARE").is_none() {
            command.env("LIBGL_ALWAYS_SOFTWARE", "1");
        }
        if options.bless {
            command.env("YORO_BLESS", "1");
        }
        equipment.set_variables(&mut command);
        command
    }
}

/// Divides the tests into jobs.
fn plan<'a>(programs: &'a [Program], options: &Options) -> Plan<'a> {
    let mut plan = Plan::default();
    let is_found = programs.iter().any(|program| !program.tests.is_empty());
    // Searching doc tests takes seconds per library. It is omitted if the filter has matched other tests.
    if options.packages.is_empty() && (options.filters.is_empty() || !is_found) {
        plan.first.push(Job { program: None, tests: Vec::new() });
    }
    for program in programs {
        let (alone, beside): (Vec<_>, Vec<_>) =
            program.tests.iter().cloned().partition(|test| program.is_alone(test));
        let (equipped, first): (Vec<_>, Vec<_>) =
            beside.into_iter().partition(|test| equipment::is_built(&program.package, test));
        let size = if program.is_integration { 1 } else { UNIT };
        for (group, tests, size) in [
            (&mut plan.first, first, size),
            (&mut plan.equipped, equipped, size),
            (&mut plan.alone, alone, 1),
        ] {
            group.extend(
                tests.chunks(size).map(|tests| Job { program: Some(program), tests: tests.to_vec() }),
            );
        }
    }
    plan
}

#[cfg(test)]
mod tests {
    use super::*;

    fn program(package: &str, kind: &str, tests: &[&str]) -> Program {
        let message = format!(
            r#"{{"reason":"compiler-artifact","package_id":"path+file:///w/app#{package}@0.1.0","manifest_path":"/w/app/Cargo.toml",
            "target":{{"kind":["{kind}"],"name":"program"}},"profile":{{"test":true}},"executable":"/w/target/p"}}"#
        );
        let tests = tests.iter().map(|&test| test.to_owned()).collect();
        Program { tests, ..parse(&message).unwrap() }
    }

    #[test]
    fn each_test_has_its_turn() {
        let programs = [
            program("yoro-cli", "test", &["memory::largest", "web::1", "xr::memory", "2"]),
            program("yoro", "lib", &["a", "b"]),
        ];
        let plan = plan(&programs, &Options::default());
        let names = |jobs: &[Job]| jobs.iter().map(Job::name).collect::<Vec<_>>().join("; ");
        let first = ["documentation", "yoro-cli::program xr::memory", "yoro-cli::program 2", "yoro, 2 tests"];
        assert_eq!(names(&plan.first), first.join("; "));
        // The page is built.
        assert_eq!(names(&plan.equipped), "yoro-cli::program web::1");
        assert_eq!(names(&plan.alone), "yoro-cli::program memory::largest");
    }
}
