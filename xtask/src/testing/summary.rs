//! Totals of all tests, and where the time went.

use std::collections::BTreeMap;
use std::fmt;
use std::time::{Duration, Instant};

use super::process::{Finished, Outcome};

/// Number of slowest tests that are listed.
const SLOWEST: usize = 10;

/// The totals of a test run.
#[derive(Debug)]
pub struct Summary {
    start: Instant,
    /// Names and durations in seconds.
    phases: Vec<(String, f64)>,
    /// Per program, the number of tests and the seconds of their processes.
    programs: BTreeMap<String, (usize, f64)>,
    /// Durations in seconds and names of passed tests.
    passed: Vec<(f64, String)>,
    /// Failed tests, as `program test`.
    pub failed: Vec<String>,
    /// Tests that failed beside others, but passed alone.
    flaky: Vec<String>,
    ignored: usize,
    /// Messages about missing equipment, and the number of tests that printed each.
    left_out: BTreeMap<String, usize>,
}

impl Summary {
    /// Starts the clock.
    pub fn begin() -> Self {
        Self {
            start: Instant::now(),
            phases: Vec::new(),
            programs: BTreeMap::new(),
            passed: Vec::new(),
            failed: Vec::new(),
            flaky: Vec::new(),
            ignored: 0,
            left_out: BTreeMap::new(),
        }
    }

    /// Does some work, and records its duration.
    pub fn measure<T>(&mut self, what: &str, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.phase(what, start.elapsed());
        result
    }

    /// Records a duration.
    pub fn phase(&mut self, what: &str, taken: Duration) {
        self.phases.push((what.to_owned(), taken.as_secs_f64()));
    }

    /// Adds a process of a test program.
    pub fn add(&mut self, program: &str, finished: &Finished) {
        let (tests, seconds) = self.programs.entry(program.to_owned()).or_default();
        *tests += finished.tests.len();
        *seconds += finished.seconds;
        for test in &finished.tests {
            let full = format!("{program} {}", test.name);
            match test.outcome {
                Outcome::Passed => self.passed.push((test.seconds, full)),
                Outcome::Failed => self.failed.push(full),
                Outcome::Ignored => self.ignored += 1,
            }
        }
        // Many tests print the same message.
        for text in finished.lines.iter().map(|line| line.text.trim()) {
            if let Some(at) = text.find("LEFT OUT: ").or_else(|| text.find("SKIPPED: ")) {
                *self.left_out.entry(text[at..].to_owned()).or_default() += 1;
            }
        }
    }

    /// Adds the second run of failed tests. Those that now pass are counted as flaky instead of failed.
    pub fn add_retry(&mut self, program: &str, finished: &Finished) {
        for test in finished.tests.iter().filter(|test| test.outcome == Outcome::Passed) {
            let full = format!("{program} {}", test.name);
            self.failed.retain(|failed| *failed != full);
            self.passed.push((test.seconds, full.clone()));
            self.flaky.push(full);
        }
    }

    /// Returns the number of finished tests.
    pub fn count(&self) -> usize {
        self.passed.len() + self.failed.len() + self.ignored
    }

    /// Returns the number of finished tests of a program.
    pub fn count_of(&self, program: &str) -> usize {
        self.programs.get(program).map_or(0, |(tests, _)| *tests)
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "\nwhere the time went                                      s")?;
        for (what, seconds) in self.phases.iter().filter(|(_, seconds)| *seconds >= 0.05) {
            writeln!(f, "  {what:48} {seconds:8.1}")?;
        }
        writeln!(f, "\nprogram                                 tests   in processes s")?;
        let mut programs: Vec<_> = self.programs.iter().collect();
        programs.sort_by(|a, b| b.1.1.total_cmp(&a.1.1));
        for (name, (tests, seconds)) in programs {
            writeln!(f, "  {name:38}{tests:5}{seconds:17.1}")?;
        }
        writeln!(f, "\nslowest tests")?;
        let mut tests: Vec<_> = self.passed.iter().collect();
        tests.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (seconds, name) in tests.into_iter().take(SLOWEST) {
            writeln!(f, "{seconds:8.1} s  {name}")?;
        }
        for (text, count) in &self.left_out {
            writeln!(f, "{count:6} x  {text}")?;
        }
        for name in &self.flaky {
            writeln!(f, "FLAKY: {name} failed, and passed alone: see above what it printed")?;
        }
        for name in &self.failed {
            writeln!(f, "FAILED: {name}")?;
        }
        // The last line has libtest's format.
        writeln!(
            f,
            "\ntest result: {}. {} passed; {} failed; {} ignored; finished in {:.2}s",
            if self.failed.is_empty() { "ok" } else { "FAILED" },
            self.passed.len(),
            self.failed.len(),
            self.ignored,
            self.start.elapsed().as_secs_f64()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::process::Test;
    use super::*;

    fn finished(names: &[&str], outcome: Outcome, seconds: f64) -> Finished {
        let test = |&name: &&str| Test { name: name.to_owned(), outcome, seconds };
        Finished { tests: names.iter().map(test).collect(), seconds, ..Finished::default() }
    }

    #[test]
    fn tests_are_summed_up_as_libtest_does() {
        let mut summary = Summary::begin();
        assert_eq!(summary.measure("compiling", || 7), 7);
        summary.add("yoro", &finished(&["a", "b"], Outcome::Passed, 1.0));
        summary.add("yoro", &finished(&["c"], Outcome::Ignored, 2.0));
        summary.add("yoro-cli::program", &finished(&["bad", "worse"], Outcome::Failed, 9.0));
        assert_eq!(summary.count(), 5);
        summary.add_retry("yoro-cli::program", &finished(&["bad"], Outcome::Passed, 100.0));
        assert_eq!(summary.failed, ["yoro-cli::program worse"]);
        let text = summary.to_string();
        assert!(
            text.contains("\ntest result: FAILED. 3 passed; 1 failed; 1 ignored; finished in 0."),
            "{text}"
        );
        assert!(text.contains("\nFLAKY: yoro-cli::program bad failed"), "{text}");
        assert!(
            text.contains("slowest tests\n   100.0 s  yoro-cli::program bad\n     1.0 s  yoro a\n"),
            "{text}"
        );
        let yoro = text.lines().find(|line| line.starts_with("  yoro ")).unwrap();
        assert_eq!(yoro.split_whitespace().collect::<Vec<_>>(), ["yoro", "3", "3.0"]);
    }
}
