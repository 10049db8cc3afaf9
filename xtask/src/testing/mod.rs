//! Runs all tests of the workspace: cargo compiles them, and several processes run them at a time.
//!
//! Differences from `cargo test`: several processes run at a time rather than several threads, since Mesa's rasterizer
//! occasionally crashes when two threads of a process draw; after a crash, the other tests still run; failed tests run
//! once more, alone; and what tests need is fetched and built meanwhile. cargo-nextest provides most of this, but depends
//! on 400 packages, which a fresh clone would have to compile first.

mod binaries;
mod equipment;
mod process;
mod summary;

use std::collections::VecDeque;
use std::env;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::Stdio;
use std::sync::{Mutex, PoisonError, mpsc};
use std::thread;
use std::time::Instant;

use anyhow::bail;

use crate::cargo::cargo;
use crate::folders::target_folder;
use crate::{apt, setup};

use binaries::Program;
use equipment::{Equipment, Preparation};
use process::Finished;
use summary::Summary;

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
/// Maximum number of failures that are retried. More of them are no coincidence.
const MAX_RETRIED: usize = 8;

/// Which tests to run, and how.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Run only tests whose names contain one of these.
    pub filters: Vec<String>,
    /// Run only tests of these packages.
    pub packages: Vec<String>,
    /// Renew the golden images.
    pub bless: bool,
    /// Number of processes at a time. `None` means one per processor.
    pub jobs: Option<NonZeroUsize>,
}

impl Options {
    fn all(&self) -> bool {
        self.filters.is_empty() && self.packages.is_empty()
    }

    fn takes(&self, name: &str) -> bool {
        self.filters.is_empty() || self.filters.iter().any(|filter| name.contains(filter))
    }
}

/// The work of one process.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Job {
    /// The program's index. `None` for the tests in the documentation of all libraries.
    program: Option<usize>,
    /// The names of its tests.
    names: Vec<String>,
}

/// All jobs, in groups that run one after another.
#[derive(Debug, Default, PartialEq, Eq)]
struct Plan {
    /// Tests that need no equipment.
    first: Vec<Job>,
    /// Tests that need equipment.
    equipped: Vec<Job>,
    /// The tests in [`ALONE`].
    alone: Vec<Job>,
}

/// Compiles and runs the selected tests of the workspace, or all, and prints a summary.
pub fn test(options: &Options) -> anyhow::Result<()> {
    let mut summary = Summary::begin();
    apt::install_missing(|| vec![setup::cpp()], true)?;
    let equipment = thread::scope(|scope| {
        let preparation = options.all().then(|| Preparation::begin(scope, None)).transpose()?;
        let binaries = summary.measure("compiling the tests", || binaries::compile(&options.packages))?;
        let mut programs = Vec::new();
        for binary in binaries {
            let mut names = binary.list()?;
            names.retain(|name| options.takes(name));
            programs.push((binary, names));
        }
        let mut preparation = match preparation {
            Some(preparation) => preparation,
            None => Preparation::begin(scope, Some(&programs))?,
        };
        if options.all() {
            for part in stale(&programs) {
                eprintln!("warning: no test is called {part}: correct the table in xtask/src/testing");
            }
        }
        let equipment = summary.measure("waiting for the libraries", || preparation.libraries())?;
        let mut run = Run { programs: &programs, options, equipment, folder: target_folder()? };
        let plan = plan(&programs, options);
        let workers =
            options.jobs.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZeroUsize::get);
        // The first worker builds, since cargo keeps but one processor busy while it links and optimizes whole programs.
        let mut prepared = Ok(Equipment::default());
        let prepare = || prepared = preparation.finish();
        run.all(plan.first, workers, "running tests, building equipment", &mut summary, prepare);
        let prepared = prepared?;
        for (what, seconds) in &prepared.seconds {
            summary.add_phase(&format!("  of it {what}"), *seconds);
        }
        run.equipment.extend(prepared);
        run.all(plan.equipped, workers, "running tests with equipment", &mut summary, || ());
        run.all(plan.alone, 1, "running tests alone", &mut summary, || ());
        run.retry(&mut summary);
        Ok::<Equipment, anyhow::Error>(run.equipment)
    })?;
    for sentence in &equipment.absent {
        println!("{sentence}");
    }
    if options.bless {
        println!("golden images renewed: look at `git diff --stat tests/golden` and at the pictures");
    }
    print!("{summary}");
    if summary.count() == 0 {
        bail!("no test is called so: say less of its name");
    }
    if !summary.failed.is_empty() {
        bail!("{} tests failed: see above", summary.failed.len());
    }
    Ok(())
}

/// Returns patterns in the tables that match no test, for example because it was renamed.
fn stale(programs: &[Program]) -> Vec<String> {
    let is_alone = |part: &str, (binary, names): &Program| {
        names.iter().any(|name| format!("{} {name}", binary.label).contains(part))
    };
    let alone = ALONE.iter().filter(|part| !programs.iter().any(|program| is_alone(part, program)));
    alone.map(|part| (*part).to_owned()).chain(equipment::stale(programs)).collect()
}

/// Divides the tests into jobs. Integration tests come first, since they take longer.
fn plan(programs: &[Program], options: &Options) -> Plan {
    let mut plan = Plan::default();
    let chosen = programs.iter().any(|(_, names)| !names.is_empty());
    // Searching doc tests takes seconds per library. It is omitted if the filter has matched other tests.
    if options.packages.is_empty() && (options.filters.is_empty() || !chosen) {
        plan.first.push(Job { program: None, names: Vec::new() });
    }
    let mut order: Vec<usize> = (0..programs.len()).collect();
    order.sort_by_key(|&program| !programs[program].0.integration);
    for program in order {
        let (binary, names) = &programs[program];
        let job = |names: &[String]| Job { program: Some(program), names: names.to_vec() };
        let is_alone = |name: &String| {
            let full = format!("{} {name}", binary.label);
            ALONE.iter().any(|part| full.contains(part))
        };
        let (alone, beside): (Vec<_>, Vec<_>) = names.iter().cloned().partition(is_alone);
        plan.alone.extend(alone.chunks(1).map(job));
        let (equipped, first): (Vec<_>, Vec<_>) =
            beside.into_iter().partition(|name| equipment::is_needed(&binary.package, name));
        let size = if binary.integration { 1 } else { UNIT };
        plan.first.extend(first.chunks(size).map(job));
        plan.equipped.extend(equipped.chunks(size).map(job));
    }
    plan
}

/// A run of the selected tests.
struct Run<'a> {
    programs: &'a [Program],
    options: &'a Options,
    equipment: Equipment,
    /// The folder for the output of processes.
    folder: PathBuf,
}

impl<'a> Run<'a> {
    fn label(&self, job: &Job) -> &'a str {
        job.program.map_or("documentation", |program| &self.programs[program].0.label)
    }

    fn process(&self, job: &Job) -> Finished {
        let mut command = match job.program {
            Some(program) => {
                let mut command = self.programs[program].0.command();
                command.args(["--exact", "--test-threads=1"]).args(&job.names);
                // Not captured if it is one, so that output before a crash is not lost; else to be found by its name.
                command.arg(if job.names.len() == 1 { "--nocapture" } else { "--show-output" });
                command
            }
            None => {
                let mut command = cargo();
                command.args(["test", "--workspace", "--doc", "--no-fail-fast", "--"]);
                command.args(&self.options.filters).stdin(Stdio::null());
                command
            }
        };
        // The golden images were made with Mesa's rasterizer. A GPU would round differently.
        if env::var_os("LIBGL_ALWAYS_SOFTWARE").is_none() {
            command.env("LIBGL_ALWAYS_SOFTWARE", "1");
        }
        if self.options.bless {
            command.env("YORO_BLESS", "1");
        }
        self.equipment.set_variables(&mut command);
        process::run(command, &job.names, &self.folder)
    }

    /// Runs jobs with `workers` processes at a time, one of which does something else `before`, and prints the results.
    fn all(
        &self,
        jobs: Vec<Job>,
        workers: usize,
        what: &str,
        summary: &mut Summary,
        before: impl FnOnce() + Send,
    ) {
        let total: usize = self.programs.iter().map(|(_, names)| names.len()).sum();
        let queue = Mutex::new(VecDeque::from(jobs));
        let queue = || queue.lock().unwrap_or_else(PoisonError::into_inner);
        let mut before = Some(before);
        let (sender, receiver) = mpsc::channel();
        let start = Instant::now();
        thread::scope(|scope| {
            for _ in 0..workers {
                let (sender, queue, before) = (sender.clone(), &queue, before.take());
                scope.spawn(move || {
                    if let Some(before) = before {
                        before();
                    }
                    loop {
                        let Some(job) = queue().pop_front() else { break };
                        let finished = self.process(&job);
                        if job.names.len() > 1 && finished.failed == job.names {
                            // It has crashed: each test in a process of its own shows which one.
                            let names = job.names.chunks(1);
                            queue().extend(names.map(|name| Job { names: name.to_vec(), ..job.clone() }));
                        } else {
                            sender.send((job, finished)).ok();
                        }
                    }
                });
            }
            drop(sender);
            for (job, finished) in receiver {
                let label = self.label(&job);
                let name = match &job.names[..] {
                    [name] => format!("{label} {name}"),
                    [] => label.to_owned(),
                    names => format!("{label}, {} tests", names.len()),
                };
                summary.add(label, &name, &finished);
                print(&format!("[{:4}/{total}] ", summary.count()), &name, &finished);
            }
        });
        summary.add_phase(what, start.elapsed().as_secs_f64());
    }

    /// Runs failed tests once more, alone.
    fn retry(&self, summary: &mut Summary) {
        if summary.failed.is_empty() || summary.failed.len() > MAX_RETRIED {
            return;
        }
        println!("\nwhat failed, a second time and alone:");
        for (program, (binary, names)) in self.programs.iter().enumerate() {
            for name in names {
                let full = format!("{} {name}", binary.label);
                if summary.failed.contains(&full) {
                    let finished = self.process(&Job { program: Some(program), names: vec![name.clone()] });
                    print("", &full, &finished);
                    if finished.failed.is_empty() {
                        summary.add_flaky(&full);
                    }
                }
            }
        }
    }
}

/// Prints a line for a process, and its whole output if a test failed.
fn print(count: &str, name: &str, finished: &Finished) {
    let word = if finished.failed.is_empty() { "ok" } else { "FAILED" };
    println!("{count}{word:7} {:6.2} s  {name}", finished.seconds);
    if !finished.failed.is_empty() {
        for line in finished.output.lines() {
            println!("    {line}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::binaries::tests::binary;
    use super::*;

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(|&name| name.to_owned()).collect()
    }

    #[test]
    fn long_tests_go_first_and_equipped_ones_last() {
        let programs = [
            (binary("yoro", "lib"), names(&["a", "b"])),
            (binary("yoro-render", "test"), names(&["1", "2"])),
            (binary("yoro-cli", "test"), names(&["memory::largest", "xr::memory"])),
        ];
        let plan = plan(&programs, &Options::default());
        let job = |program, tests: &[&str]| Job { program, names: names(tests) };
        let first = [job(None, &[]), job(Some(1), &["1"]), job(Some(1), &["2"]), job(Some(0), &["a", "b"])];
        assert_eq!(plan.first, first);
        assert_eq!(plan.equipped, [job(Some(2), &["xr::memory"])]);
        assert_eq!(plan.alone, [job(Some(2), &["memory::largest"])]);
        assert_eq!(stale(&programs)[0], ALONE[1]);
    }

    #[test]
    fn documentation_is_searched_only_for_names_that_are_nowhere_else() {
        let planned = |filter: &str, found: &[&str]| {
            let options = Options { filters: names(&[filter]), ..Options::default() };
            plan(&[(binary("yoro", "lib"), names(found))], &options).first[0].program.is_none()
        };
        assert_eq!((planned("a", &["a"]), planned("src/lib.rs", &[])), (false, true));
    }
}
