//! All tests of the workspace: cargo compiles them, and processes of their own run them on all processors.
//!
//! Mesa's rasterizer crashes now and then when two threads of one process draw; two processes do not disturb each other.

mod binaries;
mod equipment;
mod plan;
mod runner;
mod summary;
mod transcript;

use std::env;
use std::fs;
use std::num::NonZeroUsize;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Instant;

use anyhow::bail;
use yoro_tools::cargo::cargo;
use yoro_tools::folders::target_folder;

use binaries::Program;
use equipment::{Equipment, Preparation, Wanted};
use plan::{Job, Times, plan};
use runner::{Jobs, News};
use summary::Summary;
use transcript::{Line, Outcome, Reading, shown};

/// What the tests of documentation are called among programs.
const DOCUMENTATION: &str = "documentation";

/// Which tests, and how.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Only those whose names contain one of these.
    pub filters: Vec<String>,
    /// Only those of these packages.
    pub packages: Vec<String>,
    /// Renew golden images.
    pub bless: bool,
    /// Processes at a time, instead of one for each processor.
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

/// Runs all tests of the workspace, or those whose names contain one of the filters, and sums up.
///
/// # Errors
/// When a test fails twice or does not compile, or nothing is to be run.
pub fn test(options: &Options) -> anyhow::Result<()> {
    let mut summary = Summary::begin();
    let (programs, equipment) = prepare(options, &mut summary)?;
    let chosen: usize = programs.iter().map(|(_, names)| names.len()).sum();
    if options.all() {
        for part in plan::stale(&programs) {
            eprintln!("warning: no test is called {part}: correct the table in xtask/src/testing/plan.rs");
        }
    }
    let times_file = target_folder()?.join("test-times");
    let mut times = Times::parse(&fs::read_to_string(&times_file).unwrap_or_default());
    // Looking for those takes seconds in each library: a name that is found elsewhere is not looked for there.
    let documentation = options.packages.is_empty() && (options.filters.is_empty() || chosen == 0);
    let plan = plan(&programs, documentation, &times);
    let tests = Tests { programs: &programs, equipment: &equipment, options };
    let processors =
        options.jobs.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZeroUsize::get);
    eprintln!("{chosen} tests in {processors} processes at a time");
    let start = Instant::now();
    for (jobs, workers) in [(plan.together, processors), (plan.alone, 1)] {
        runner::run(&tests, jobs, workers, |news| tests.tell(news, chosen, &mut summary, &mut times));
    }
    let again = tests.again(&summary);
    if !again.is_empty() {
        println!("\nwhat failed, a second time and alone:");
        runner::run(&tests, again, 1, |news| tests.tell_again(news, &mut summary));
    }
    summary.phase("running the tests", start.elapsed());
    if let Err(error) = fs::write(&times_file, times.to_text()) {
        eprintln!("warning: {} cannot be written: {error}", times_file.display());
    }
    conclude(&summary, &equipment, options)
}

/// Compiles the tests and meanwhile installs and fetches what they need; programs with the names of the chosen tests.
fn prepare(options: &Options, summary: &mut Summary) -> anyhow::Result<(Vec<Program>, Equipment)> {
    thread::scope(|scope| {
        let early = options.all().then(|| Preparation::begin(scope, Wanted::ALL)).transpose()?;
        let binaries = summary.measure("compiling the tests", || binaries::compile(&options.packages))?;
        let mut programs = Vec::new();
        for binary in binaries {
            let mut names = binary.list()?;
            names.retain(|name| options.takes(name));
            programs.push((binary, names));
        }
        let preparation = match early {
            Some(preparation) => preparation,
            None => {
                let all = programs.iter().flat_map(|(binary, names)| {
                    names.iter().map(|name| (binary.package.as_str(), name.as_str()))
                });
                Preparation::begin(scope, Wanted::by(all))?
            }
        };
        Ok((programs, preparation.finish(summary)?))
    })
}

/// More failures than this are no accident.
const AGAIN: usize = 8;

/// How chosen tests are run, and what is told of them.
struct Tests<'a> {
    programs: &'a [Program],
    equipment: &'a Equipment,
    options: &'a Options,
}

impl Tests<'_> {
    fn program(&self, job: &Job) -> &str {
        match job {
            Job::Tests { binary, .. } => &self.programs[*binary].0.label,
            Job::Documentation => DOCUMENTATION,
        }
    }

    /// Prints a line for each test, and what a failing one's process has printed.
    fn tell(&self, news: News<Job>, chosen: usize, summary: &mut Summary, times: &mut Times) {
        let (job, reading, lines, wall, processor) = match news {
            News::Slow(name, seconds) => return println!("still running after {seconds} s: {name}"),
            News::Ended { job, reading, lines, wall, processor } => (job, reading, lines, wall, processor),
        };
        let program = self.program(&job);
        summary.process(program, wall, processor);
        for result in &reading.results {
            summary.test(program, &result.name, result.outcome, result.seconds);
            let word = match result.outcome {
                Outcome::Passed => "ok",
                Outcome::Failed => "FAILED",
                Outcome::Ignored => "ignored",
            };
            if result.outcome == Outcome::Passed {
                times.set(program, &result.name, result.seconds);
            }
            let (count, seconds) = (summary.count(), result.seconds);
            println!("[{count:4}/{chosen}] {word:7} {seconds:6.2} s  {program} {}", result.name);
        }
        // Tests say so where they were told to do without something, many of them the same.
        let is_told = |text: &str| text.contains("LEFT OUT: ") || text.contains("SKIPPED: ");
        lines.iter().filter(|line| is_told(&line.text)).for_each(|line| summary.left_out(line.text.trim()));
        show_failure(&reading, &lines);
    }

    /// The tests that failed, each in a process of its own; none if there are many.
    fn again(&self, summary: &Summary) -> Vec<Job> {
        let failures = summary.failures();
        let jobs = self.programs.iter().enumerate().flat_map(|(binary, (program, names))| {
            let failed = |name: &&String| failures.contains(&format!("{} {name}", program.label));
            names.iter().filter(failed).map(move |name| Job::Tests { binary, names: vec![name.clone()] })
        });
        if failures.len() > AGAIN { Vec::new() } else { jobs.collect() }
    }

    /// Prints what became of a test in its second run.
    fn tell_again(&self, news: News<Job>, summary: &mut Summary) {
        let News::Ended { job, reading, lines, .. } = news else { return };
        for result in &reading.results {
            let full = format!("{} {}", self.program(&job), result.name);
            let passed = result.outcome == Outcome::Passed;
            println!("{:7} {:6.2} s  {full}", if passed { "ok" } else { "FAILED" }, result.seconds);
            if passed {
                summary.unsteady(&full);
            }
        }
        show_failure(&reading, &lines);
    }
}

/// Prints what a process of tests printed, if one of them failed.
fn show_failure(reading: &Reading, lines: &[Line]) {
    if reading.results.iter().any(|result| result.outcome == Outcome::Failed) {
        print!("{}", shown(lines));
    }
    if let Some(trouble) = &reading.trouble {
        println!("    {trouble}");
    }
}

impl Jobs for Tests<'_> {
    type Job = Job;

    fn command(&self, job: &Job) -> Command {
        let mut command = match job {
            Job::Tests { binary, names } => {
                let mut command = self.programs[*binary].0.command();
                // What is printed before a crash is not lost.
                command.args(["--exact", "--test-threads=1", "--nocapture"]).args(names);
                command
            }
            Job::Documentation => {
                let mut command = cargo();
                command.args(["test", "--workspace", "--doc", "--no-fail-fast"]);
                command.arg("--").args(&self.options.filters).stdin(Stdio::null());
                command
            }
        };
        // Golden images are made by Mesa's rasterizer; a GPU's own rounding is another question.
        if env::var_os("LIBGL_ALWAYS_SOFTWARE").is_none() {
            command.env("LIBGL_ALWAYS_SOFTWARE", "1");
        }
        if self.options.bless {
            command.env("YORO_BLESS", "1");
        }
        self.equipment.tell(&mut command);
        command
    }

    fn names<'a>(&self, job: &'a Job) -> Option<&'a [String]> {
        match job {
            Job::Tests { names, .. } => Some(names),
            Job::Documentation => None,
        }
    }

    fn again(&self, job: &Job, names: Vec<String>) -> Job {
        match job {
            Job::Tests { binary, .. } => Job::Tests { binary: *binary, names },
            Job::Documentation => Job::Documentation,
        }
    }
}

/// Prints the sums, and what was left out.
fn conclude(summary: &Summary, equipment: &Equipment, options: &Options) -> anyhow::Result<()> {
    print!("{summary}");
    for what in equipment.absent() {
        println!("{what}: what needs it was left out");
    }
    if options.bless {
        println!("golden images renewed: look at `git diff --stat tests/golden` and at the pictures");
    }
    for name in summary.flaky() {
        println!("FLAKY: {name} failed and passed alone: what it printed is above");
    }
    if !summary.failures().is_empty() {
        bail!("these tests failed: {}", summary.failures().join(", "));
    }
    if summary.ran() == 0 {
        bail!("no test is called so: say less of its name");
    }
    Ok(())
}
