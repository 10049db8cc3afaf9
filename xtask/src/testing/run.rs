//! Processes of tests, and their results.

use std::collections::{BTreeMap, VecDeque};
use std::fs;
use std::sync::{Mutex, PoisonError, mpsc};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};

use super::equipment::Equipment;
use super::{Job, Options};

/// Time after which a process is killed. The longest tests take a few minutes.
const TIMEOUT: Duration = Duration::from_secs(1200);
/// Maximum number of failures that are retried. More of them are no coincidence.
const MAX_RETRIED: usize = 8;

/// A finished process.
struct Finished {
    has_passed: bool,
    output: String,
    seconds: f64,
}

/// A run of the selected tests, and its results so far.
#[derive(Default)]
pub struct Run<'a> {
    /// What this machine has for tests.
    pub equipment: Equipment,
    /// The number of selected tests, without those in documentation.
    pub total: usize,
    passed: usize,
    failed: Vec<Job<'a>>,
    /// What failed beside others, but passed alone.
    flaky: Vec<String>,
    /// Messages about missing equipment, and the number of tests that printed each.
    left_out: BTreeMap<String, usize>,
}

impl<'a> Run<'a> {
    /// Adds what was prepared meanwhile.
    pub fn equip(&mut self, more: Equipment) {
        self.equipment.items.extend(more.items);
    }

    /// Runs jobs with `workers` processes at a time, one of which does something else `before`, and prints the results.
    /// If a process of several tests fails, each of them gets a process of its own, which shows the one that fails.
    pub fn perform(
        &mut self,
        jobs: Vec<Job<'a>>,
        workers: usize,
        options: &Options,
        before: impl FnOnce() + Send,
    ) -> anyhow::Result<()> {
        let queue = Mutex::new(VecDeque::from(jobs));
        let take = || queue.lock().unwrap_or_else(PoisonError::into_inner).pop_front();
        let equipment = std::mem::take(&mut self.equipment);
        let mut before = Some(before);
        let (sender, receiver) = mpsc::channel();
        thread::scope(|scope| {
            for _ in 0..workers {
                let (sender, take, before, equipment) = (sender.clone(), &take, before.take(), &equipment);
                scope.spawn(move || {
                    if let Some(before) = before {
                        before();
                    }
                    while let Some(job) = take() {
                        let finished = process(job.command(options, equipment));
                        let has_failed = finished.as_ref().is_ok_and(|finished| !finished.has_passed);
                        sender.send((job.clone(), finished)).ok();
                        if has_failed && job.tests.len() > 1 {
                            for test in job.tests.chunks(1) {
                                let job = Job { tests: test.to_vec(), ..job };
                                let finished = process(job.command(options, equipment));
                                sender.send((job, finished)).ok();
                            }
                        }
                    }
                });
            }
            drop(sender);
            receiver.into_iter().try_for_each(|(job, finished)| {
                self.add(job, &finished?);
                Ok::<(), anyhow::Error>(())
            })
        })?;
        self.equipment = equipment;
        Ok(())
    }

    /// Counts and prints a finished process.
    fn add(&mut self, job: Job<'a>, finished: &Finished) {
        let name = job.name();
        // Many tests print the same message.
        for text in finished.output.lines().map(str::trim) {
            if let Some(at) = text.find("LEFT OUT: ").or_else(|| text.find("SKIPPED: ")) {
                *self.left_out.entry(text[at..].to_owned()).or_default() += 1;
            }
        }
        if finished.has_passed {
            self.passed += passed(&finished.output);
        } else if job.tests.len() > 1 {
            self.flaky.push(name.clone());
        } else {
            self.failed.push(job);
        }
        let count = self.passed + self.failed.len();
        print(&format!("[{count:4}/{}] ", self.total), &name, finished);
    }

    /// Runs failed tests once more, alone.
    pub fn retry(&mut self, options: &Options) -> anyhow::Result<()> {
        // Tests that failed together are reported only if none of them fails in its own process.
        let is_explained = |name: &String| {
            let mut programs = self.failed.iter().filter_map(|job| job.program);
            programs.any(|program| name.starts_with(&format!("{},", program.label)))
        };
        self.flaky.retain(|name| !is_explained(name));
        if self.failed.is_empty() || self.failed.len() > MAX_RETRIED {
            return Ok(());
        }
        println!("\nwhat failed, a second time and alone:");
        for job in std::mem::take(&mut self.failed) {
            let finished = process(job.command(options, &self.equipment))?;
            print("", &job.name(), &finished);
            if finished.has_passed {
                self.passed += passed(&finished.output);
                self.flaky.push(job.name());
            } else {
                self.failed.push(job);
            }
        }
        Ok(())
    }

    /// Prints the result of a run that began at `start`.
    ///
    /// # Errors
    /// If a test has failed, or none was found.
    pub fn conclude(self, start: Instant) -> anyhow::Result<()> {
        for (what, ..) in self.equipment.items.iter().filter(|(.., path)| path.is_none()) {
            println!("{what} cannot be had here: its tests were left out");
        }
        self.left_out.iter().for_each(|(text, count)| println!("{count:6} x  {text}"));
        for name in &self.flaky {
            println!("FLAKY: {name} failed, and passed alone: see above what it printed");
        }
        self.failed.iter().for_each(|job| println!("FAILED: {}", job.name()));
        let (passed, failed) = (self.passed, self.failed.len());
        let word = if failed == 0 { "ok" } else { "FAILED" };
        let seconds = start.elapsed().as_secs_f64();
        println!("\ntest result: {word}. {passed} passed; {failed} failed; finished in {seconds:.2}s");
        ensure!(passed + failed > 0, "no test is called so: say less of its name");
        ensure!(failed == 0, "{failed} tests failed: see above");
        Ok(())
    }
}

/// Prints a line for a process, and its whole output if a test failed.
fn print(count: &str, name: &str, finished: &Finished) {
    let word = if finished.has_passed { "ok" } else { "FAILED" };
    println!("{count}{word:7} {:6.2} s  {name}", finished.seconds);
    if !finished.has_passed {
        finished.output.lines().for_each(|line| println!("    {line}"));
    }
}

/// Runs a process to its end. Its output goes through a file, since a process that it leaves behind could keep a pipe open.
fn process(mut command: std::process::Command) -> anyhow::Result<Finished> {
    let file = tempfile::NamedTempFile::new().context("the output of tests finds no place")?;
    let log = file.reopen()?;
    command.stdout(log.try_clone()?).stderr(log);
    let start = Instant::now();
    let mut child = command.spawn().with_context(|| format!("{command:?} cannot be started"))?;
    let status = loop {
        match child.try_wait()? {
            Some(status) => break status,
            None if start.elapsed() > TIMEOUT => child.kill()?,
            None => thread::sleep(Duration::from_millis(10)),
        }
    };
    let mut output = String::from_utf8_lossy(&fs::read(file.path())?).into_owned();
    if status.code().is_none() {
        output += &format!("\nit ended with {status} after {} s\n", start.elapsed().as_secs());
    }
    Ok(Finished { has_passed: status.success(), output, seconds: start.elapsed().as_secs_f64() })
}

/// Sums up the tests that have passed by the lines `test result: ok. 1 passed; 2 failed; ...`.
fn passed(output: &str) -> usize {
    let results = output.lines().filter_map(|line| line.strip_prefix("test result: ok. "));
    results.filter_map(|result| result.split(' ').next()?.parse::<usize>().ok()).sum()
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::*;

    #[test]
    fn a_process_is_judged_by_its_end_and_one_left_behind_is_not_waited_for() {
        let run = |script: &str| {
            let mut command = Command::new("sh");
            command.args(["-c", script]);
            process(command).unwrap()
        };
        let done = run("sleep 5 & echo 'test result: ok. 2 passed; 0 failed; 1 ignored'");
        assert!(done.has_passed && done.seconds < 4.0 && passed(&done.output) == 2);
        let crashed = run("echo test a; kill -SEGV $$");
        assert!(!crashed.has_passed && crashed.output.starts_with("test a\n"), "{}", crashed.output);
        assert!(crashed.output.contains("signal: 11"), "{}", crashed.output);
        assert!(process(Command::new("/no/such/program")).is_err());
    }
}
