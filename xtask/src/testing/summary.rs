//! What all tests together came to, and where the time went.

use std::collections::BTreeMap;
use std::fmt;
use std::time::{Duration, Instant};

use super::transcript::Outcome;

/// So many of the slowest tests are shown.
const SLOWEST: usize = 10;

/// Sums, while tests run.
#[derive(Debug)]
pub struct Summary {
    start: Instant,
    phases: Vec<Phase>,
    programs: BTreeMap<String, Program>,
    tests: Vec<(f64, String)>,
    ignored: usize,
    failures: Vec<String>,
    /// Failed beside others, passed alone.
    flaky: Vec<String>,
    /// What tests had to do without, and how often it was said.
    left_out: BTreeMap<String, usize>,
}

/// A part of the time.
#[derive(Debug)]
struct Phase {
    what: &'static str,
    taken: Duration,
    /// While others went on.
    beside: bool,
}

/// Sums of a test program.
#[derive(Debug, Default)]
struct Program {
    tests: usize,
    wall: f64,
    processor: f64,
}

impl Summary {
    /// The time begins.
    pub fn begin() -> Self {
        Self {
            start: Instant::now(),
            phases: Vec::new(),
            programs: BTreeMap::new(),
            tests: Vec::new(),
            ignored: 0,
            failures: Vec::new(),
            flaky: Vec::new(),
            left_out: BTreeMap::new(),
        }
    }

    /// Something has taken its time.
    pub fn phase(&mut self, what: &'static str, taken: Duration) {
        self.phases.push(Phase { what, taken, beside: false });
    }

    /// Something has taken its time while something else went on.
    pub fn beside(&mut self, what: &'static str, taken: Duration) {
        self.phases.push(Phase { what, taken, beside: true });
    }

    /// Does something, and notes its time.
    pub fn measure<T>(&mut self, what: &'static str, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.phase(what, start.elapsed());
        result
    }

    /// A test has ended.
    pub fn test(&mut self, program: &str, name: &str, outcome: Outcome, seconds: f64) {
        let full = format!("{program} {name}");
        match outcome {
            Outcome::Passed => {}
            Outcome::Failed => self.failures.push(full.clone()),
            Outcome::Ignored => {
                self.ignored += 1;
                return;
            }
        }
        self.programs.entry(program.to_owned()).or_default().tests += 1;
        self.tests.push((seconds, full));
    }

    /// A process of a test program has ended.
    pub fn process(&mut self, program: &str, wall: f64, processor: f64) {
        let program = self.programs.entry(program.to_owned()).or_default();
        program.wall += wall;
        program.processor += processor;
    }

    /// A test says what it has to do without.
    pub fn left_out(&mut self, text: &str) {
        *self.left_out.entry(text.to_owned()).or_default() += 1;
    }

    /// A test that had failed has passed now: no failure, and told of.
    pub fn unsteady(&mut self, full: &str) {
        self.failures.retain(|failure| failure != full);
        self.flaky.push(full.to_owned());
    }

    /// The names of those that failed and passed in their second run.
    pub fn flaky(&self) -> &[String] {
        &self.flaky
    }

    /// How many tests have ended.
    pub fn count(&self) -> usize {
        self.tests.len() + self.ignored
    }

    /// The tests that ran.
    pub fn ran(&self) -> usize {
        self.tests.len()
    }

    /// The names of those that failed.
    pub fn failures(&self) -> &[String] {
        &self.failures
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "\nwhere the time went                          s")?;
        for Phase { what, taken, beside } in &self.phases {
            let beside = if *beside { "  beside the compiling" } else { "" };
            writeln!(f, "  {what:36} {:8.1}{beside}", taken.as_secs_f64())?;
        }
        writeln!(f, "\nprogram                               tests  processor s   in processes s")?;
        let mut programs: Vec<_> = self.programs.iter().collect();
        programs.sort_by(|a, b| b.1.wall.total_cmp(&a.1.wall));
        for (name, Program { tests, wall, processor }) in programs {
            writeln!(f, "  {name:36}{tests:5}{processor:13.1}{wall:17.1}")?;
        }
        writeln!(f, "\nslowest tests                                s")?;
        let mut tests: Vec<_> = self.tests.iter().collect();
        tests.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (seconds, name) in tests.into_iter().take(SLOWEST) {
            writeln!(f, "{seconds:46.1}  {name}")?;
        }
        if !self.left_out.is_empty() {
            writeln!(f, "\ntests said")?;
        }
        for (text, count) in &self.left_out {
            writeln!(f, "  {count:4} x  {text}")?;
        }
        let failed = self.failures.len();
        writeln!(
            f,
            "\n{} passed, {failed} failed, {} ignored in {:.0} s",
            self.ran() - failed,
            self.ignored,
            self.start.elapsed().as_secs_f64()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_are_summed_up() {
        let mut summary = Summary::begin();
        summary.beside("Monado", Duration::from_secs(30));
        assert_eq!(summary.measure("compiling", || 7), 7);
        for i in 0..12 {
            summary.test("yoro", &format!("test{i}"), Outcome::Passed, f64::from(i));
        }
        summary.test("yoro-app::program", "xr::bad", Outcome::Failed, 100.0);
        summary.test("yoro-app::program", "xr::left", Outcome::Ignored, 0.0);
        summary.process("yoro", 1.0, 0.5);
        summary.process("yoro", 2.0, 1.5);
        assert_eq!((summary.count(), summary.ran()), (14, 13));
        assert_eq!(summary.failures(), ["yoro-app::program xr::bad"]);
        let text = summary.to_string();
        assert!(text.contains("\n12 passed, 1 failed, 1 ignored in 0 s\n"), "{text}");
        assert!(
            text.contains("Monado                                   30.0  beside the compiling\n"),
            "{text}"
        );
        let yoro = text.lines().find(|line| line.starts_with("  yoro ")).unwrap();
        assert_eq!(yoro.split_whitespace().collect::<Vec<_>>(), ["yoro", "12", "2.0", "3.0"]);
        let slowest: Vec<_> = text.lines().skip_while(|line| !line.starts_with("slowest")).skip(1).collect();
        assert!(slowest[0].ends_with("100.0  yoro-app::program xr::bad"), "{text}");
        assert!(slowest[9].ends_with("3.0  yoro test3") && slowest[10].is_empty(), "{text}");
    }

    #[test]
    fn a_test_that_passes_alone_is_flaky_and_what_is_said_often_is_told_once() {
        let mut summary = Summary::begin();
        for name in ["a", "b"] {
            summary.test("yoro", name, Outcome::Failed, 1.0);
            summary.left_out("SKIPPED: no GPU");
        }
        summary.unsteady("yoro a");
        assert_eq!((summary.failures(), summary.flaky()), (&["yoro b".into()][..], &["yoro a".into()][..]));
        let text = summary.to_string();
        assert!(text.contains("\ntests said\n     2 x  SKIPPED: no GPU\n\n1 passed, 1 failed"), "{text}");
    }
}
