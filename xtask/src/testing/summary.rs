//! Totals of all tests, and where the time went.

use std::collections::BTreeMap;
use std::fmt;
use std::time::Instant;

use super::process::Finished;

/// Number of slowest processes that are listed.
const SLOWEST: usize = 10;

/// The totals of a test run.
#[derive(Debug)]
pub struct Summary {
    start: Instant,
    /// Names and durations in seconds.
    phases: Vec<(String, f64)>,
    /// Seconds and names of processes.
    processes: Vec<(f64, String)>,
    passed: usize,
    ignored: usize,
    /// Failed tests, as `program test`.
    pub failed: Vec<String>,
    /// Tests that failed beside others, but passed alone.
    flaky: Vec<String>,
    /// Messages about missing equipment, and the number of tests that printed each.
    left_out: BTreeMap<String, usize>,
}

impl Summary {
    /// Starts the clock.
    pub fn begin() -> Self {
        Self {
            start: Instant::now(),
            phases: Vec::new(),
            processes: Vec::new(),
            passed: 0,
            ignored: 0,
            failed: Vec::new(),
            flaky: Vec::new(),
            left_out: BTreeMap::new(),
        }
    }

    /// Does some work, and records its duration.
    pub fn measure<T>(&mut self, what: &str, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.add_phase(what, start.elapsed().as_secs_f64());
        result
    }

    /// Records a duration in seconds.
    pub fn add_phase(&mut self, what: &str, seconds: f64) {
        self.phases.push((what.to_owned(), seconds));
    }

    /// Adds a process of a program. `name` names what it has run.
    pub fn add(&mut self, program: &str, name: &str, finished: &Finished) {
        self.processes.push((finished.seconds, name.to_owned()));
        self.passed += finished.counts[0];
        self.ignored += finished.counts[2];
        self.failed.extend(finished.failed.iter().map(|test| format!("{program} {test}")));
        // Many tests print the same message.
        for text in finished.output.lines().map(str::trim) {
            if let Some(at) = text.find("LEFT OUT: ").or_else(|| text.find("SKIPPED: ")) {
                *self.left_out.entry(text[at..].to_owned()).or_default() += 1;
            }
        }
    }

    /// Counts a failed test that passes alone.
    pub fn add_flaky(&mut self, test: &str) {
        self.failed.retain(|failed| failed != test);
        self.passed += 1;
        self.flaky.push(test.to_owned());
    }

    /// Returns the number of finished tests.
    pub fn count(&self) -> usize {
        self.passed + self.failed.len() + self.ignored
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "\nwhere the time went                                      s")?;
        for (what, seconds) in self.phases.iter().filter(|(_, seconds)| *seconds >= 0.05) {
            writeln!(f, "  {what:48} {seconds:8.1}")?;
        }
        writeln!(f, "\nslowest")?;
        let mut processes: Vec<_> = self.processes.iter().collect();
        processes.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (seconds, name) in processes.into_iter().take(SLOWEST) {
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
            self.passed,
            self.failed.len(),
            self.ignored,
            self.start.elapsed().as_secs_f64()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_are_summed_up_as_libtest_does() {
        let mut summary = Summary::begin();
        let failed = vec!["bad".to_owned(), "worse".to_owned()];
        let output = "LEFT OUT: no GPU\n".to_owned();
        summary.add("yoro", "yoro, 5 tests", &Finished { counts: [2, 2, 1], failed, output, seconds: 3.0 });
        assert_eq!(summary.count(), 5);
        summary.add_flaky("yoro bad");
        assert_eq!(summary.failed, ["yoro worse"]);
        let text = summary.to_string();
        for part in [
            "\ntest result: FAILED. 3 passed; 1 failed; 1 ignored; finished in 0.",
            "\nFLAKY: yoro bad failed",
            "     3.0 s  yoro, 5 tests\n",
            "     1 x  LEFT OUT: no GPU\n",
        ] {
            assert!(text.contains(part), "{text}");
        }
    }
}
