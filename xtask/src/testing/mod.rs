//! Runs all tests of the workspace: cargo compiles them, and several processes run them at a time.
//!
//! Differences from `cargo test`: several processes run at a time rather than several threads, since Mesa's rasterizer
//! occasionally crashes when two threads of a process draw; after a crash, which fails one test, the others still run;
//! failed tests run once more, alone; and what tests need is fetched and built. cargo-nextest provides most of this,
//! but depends on 400 packages, which a fresh clone would have to compile first.

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

use anyhow::bail;

use crate::cargo::cargo;
use crate::folders::target_folder;
use crate::{apt, setup};

use binaries::Program;
use equipment::{Equipment, Preparation};
use process::{Finished, Outcome, shown};
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
/// Number of integration tests per process. Each takes seconds.
const INTEGRATION: usize = 4;
/// Number of unit tests per process. Each takes milliseconds.
const UNIT: usize = 60;
/// Maximum number of failures that are retried. More of them are no coincidence.
const RETRIED: usize = 8;
/// The label of the tests in documentation, which have no program.
const DOCUMENTATION: &str = "documentation";

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
enum Job {
    /// These tests of a program, which is given by its index.
    Tests(usize, Vec<String>),
    /// The doc tests of all libraries.
    Documentation,
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
///
/// # Errors
/// Fails if a test fails twice, does not compile, or none is selected.
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
        run.all(plan.first, workers, "running tests", &mut summary);
        preparation.finish(&mut run.equipment, &mut summary)?;
        run.all(plan.equipped, workers, "running tests with equipment", &mut summary);
        run.all(plan.alone, 1, "running tests alone", &mut summary);
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

fn is_alone(program: &str, name: &str) -> bool {
    ALONE.iter().any(|part| format!("{program} {name}").contains(part))
}

/// Returns patterns in the tables that match no test, for example because it was renamed.
fn stale(programs: &[Program]) -> Vec<String> {
    let fits = |part: &&&str| {
        programs.iter().any(|(binary, names)| {
            names.iter().any(|name| format!("{} {name}", binary.label).contains(**part))
        })
    };
    let alone = ALONE.iter().filter(|part| !fits(part)).map(|part| (*part).to_owned());
    alone.chain(equipment::stale(programs)).collect()
}

/// Divides the tests into jobs. Integration tests come first, since they take longer.
fn plan(programs: &[Program], options: &Options) -> Plan {
    let mut plan = Plan::default();
    let chosen = programs.iter().any(|(_, names)| !names.is_empty());
    // Searching doc tests takes seconds per library. It is omitted if the filter has matched other tests.
    if options.packages.is_empty() && (options.filters.is_empty() || !chosen) {
        plan.first.push(Job::Documentation);
    }
    let mut order: Vec<usize> = (0..programs.len()).collect();
    order.sort_by_key(|&program| !programs[program].0.integration);
    for program in order {
        let (binary, names) = &programs[program];
        let (alone, beside): (Vec<_>, Vec<_>) =
            names.iter().cloned().partition(|name| is_alone(&binary.label, name));
        plan.alone.extend(alone.into_iter().map(|name| Job::Tests(program, vec![name])));
        let (equipped, first): (Vec<_>, Vec<_>) =
            beside.into_iter().partition(|name| equipment::is_needed(&binary.package, name));
        let size = if binary.integration { INTEGRATION } else { UNIT };
        let jobs = |names: Vec<String>| {
            names.chunks(size).map(|names| Job::Tests(program, names.to_vec())).collect::<Vec<_>>()
        };
        plan.first.extend(jobs(first));
        plan.equipped.extend(jobs(equipped));
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
    fn program(&self, job: &Job) -> &'a str {
        match job {
            Job::Tests(program, _) => &self.programs[*program].0.label,
            Job::Documentation => DOCUMENTATION,
        }
    }

    fn process(&self, job: &Job) -> Finished {
        let (mut command, names) = match job {
            Job::Tests(program, names) => {
                let mut command = self.programs[*program].0.command();
                // Not captured, so that output before a crash is not lost.
                command.args(["--exact", "--test-threads=1", "--nocapture"]).args(names);
                (command, Some(names.as_slice()))
            }
            Job::Documentation => {
                let mut command = cargo();
                command.args(["test", "--workspace", "--doc", "--no-fail-fast", "--"]);
                command.args(&self.options.filters).stdin(Stdio::null());
                (command, None)
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
        process::run(command, names, &self.folder)
    }

    /// Runs jobs with `workers` processes at a time, and prints the results.
    fn all(&self, jobs: Vec<Job>, workers: usize, what: &str, summary: &mut Summary) {
        let total: usize = self.programs.iter().map(|(_, names)| names.len()).sum();
        let queue = Mutex::new(VecDeque::from(jobs));
        let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).pop_front();
        let (sender, receiver) = mpsc::channel();
        let start = std::time::Instant::now();
        thread::scope(|scope| {
            for _ in 0..workers {
                let (sender, queue) = (sender.clone(), &queue);
                scope.spawn(move || {
                    while let Some(job) = next() {
                        let finished = self.process(&job);
                        // After a crash, the remaining tests still run.
                        if let (Job::Tests(program, _), false) = (&job, finished.rest.is_empty()) {
                            let rest = Job::Tests(*program, finished.rest.clone());
                            queue.lock().unwrap_or_else(PoisonError::into_inner).push_front(rest);
                        }
                        sender.send((job, finished)).ok();
                    }
                });
            }
            drop(sender);
            for (job, finished) in receiver {
                let program = self.program(&job);
                let before = summary.count();
                summary.add(program, &finished);
                // The number of documentation tests is not known before they have run.
                let total = total + summary.count_of(DOCUMENTATION);
                print_tests(program, &finished, |i| format!("[{:4}/{total}] ", before + i + 1));
            }
        });
        summary.phase(what, start.elapsed());
    }

    /// Runs failed tests once more, alone.
    fn retry(&self, summary: &mut Summary) {
        if summary.failed.is_empty() || summary.failed.len() > RETRIED {
            return;
        }
        println!("\nwhat failed, a second time and alone:");
        for (program, (binary, names)) in self.programs.iter().enumerate() {
            for name in names {
                if summary.failed.contains(&format!("{} {name}", binary.label)) {
                    let finished = self.process(&Job::Tests(program, vec![name.clone()]));
                    summary.add_retry(&binary.label, &finished);
                    print_tests(&binary.label, &finished, |_| String::new());
                }
            }
        }
    }
}

/// Prints a line per test, and the whole output of a process with a failed test.
fn print_tests(program: &str, finished: &Finished, count: impl Fn(usize) -> String) {
    for (i, test) in finished.tests.iter().enumerate() {
        let word = match test.outcome {
            Outcome::Passed => "ok",
            Outcome::Failed => "FAILED",
            Outcome::Ignored => "ignored",
        };
        println!("{}{word:7} {:6.2} s  {program} {}", count(i), test.seconds, test.name);
    }
    if finished.tests.iter().any(|test| test.outcome == Outcome::Failed) {
        print!("{}", shown(&finished.lines));
    }
    if let Some(trouble) = &finished.trouble {
        println!("    {trouble}");
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
            (binary("yoro-render", "test"), names(&["1", "2", "3", "4", "5"])),
            (binary("yoro-cli", "test"), names(&["memory::largest", "xr::memory"])),
        ];
        let plan = plan(&programs, &Options::default());
        let first = [
            Job::Documentation,
            Job::Tests(1, names(&["1", "2", "3", "4"])),
            Job::Tests(1, names(&["5"])),
            Job::Tests(0, names(&["a", "b"])),
        ];
        assert_eq!(plan.first, first);
        assert_eq!(plan.equipped, [Job::Tests(2, names(&["xr::memory"]))]);
        assert_eq!(plan.alone, [Job::Tests(2, names(&["memory::largest"]))]);
        assert_eq!(stale(&programs)[0], ALONE[1]);
    }

    #[test]
    fn documentation_is_searched_only_for_names_that_are_nowhere_else() {
        let planned = |filter: &str, found: &[&str]| {
            let options = Options { filters: names(&[filter]), ..Options::default() };
            plan(&[(binary("yoro", "lib"), names(found))], &options).first.contains(&Job::Documentation)
        };
        assert_eq!((planned("a", &["a"]), planned("src/lib.rs", &[])), (false, true));
    }
}
