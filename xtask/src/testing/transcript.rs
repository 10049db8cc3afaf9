//! What a test program has printed, read as results.
//!
//! With one thread it prints `test NAME ... ` before a test and ` ok` behind it, so that a crash leaves the name of the test
//! that ran. What processes below it print gets in between.

use std::process::ExitStatus;

/// How a test ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Well.
    Passed,
    /// By a panic, or together with its process.
    Failed,
    /// It did not run.
    Ignored,
}

/// A finished test.
#[derive(Clone, Debug, PartialEq)]
pub struct Result {
    /// Its name.
    pub name: String,
    /// How it ended.
    pub outcome: Outcome,
    /// How long it took.
    pub seconds: f64,
}

/// A line and when it was there, in seconds since the process was started.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Without its end.
    pub text: String,
    /// When it was whole.
    pub at: f64,
}

/// What became of a process.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Its tests.
    pub results: Vec<Result>,
    /// Tests that it did not come to.
    pub rest: Vec<String>,
    /// Why it ended otherwise than test programs do.
    pub trouble: Option<String>,
}

/// The results in what was printed. A test without one is the one that was running when the process ended.
fn results(lines: &[Line]) -> (Vec<Result>, Option<String>) {
    let mut results: Vec<Result> = Vec::new();
    let mut running: Option<String> = None;
    let mut since = 0.0;
    for line in lines {
        let mut said = line.text.as_str();
        if let Some((name, rest)) = said.strip_prefix("test ").and_then(|rest| rest.split_once(" ... ")) {
            running = Some(name.trim_end_matches(" - should panic").to_owned());
            said = rest;
        }
        let outcome = if said.ends_with("ok") {
            Outcome::Passed
        } else if said.ends_with("FAILED") {
            Outcome::Failed
        } else if said == "ignored" || said.starts_with("ignored, ") {
            Outcome::Ignored
        } else {
            continue;
        };
        if let Some(name) = running.take() {
            results.push(Result { name, outcome, seconds: line.at - since });
            since = line.at;
        }
    }
    (results, running)
}

/// The tests that a program names as failed at its end, where nothing gets in between.
fn failures(lines: &[Line]) -> Vec<&str> {
    let list = lines.iter().rposition(|line| line.text == "failures:").map_or(&[][..], |at| &lines[at + 1..]);
    list.iter().map(|line| line.text.trim()).take_while(|name| !name.is_empty()).collect()
}

/// Reads what a process of chosen tests printed; without a choice it is the documentation tests' one.
pub fn read(names: Option<&[String]>, lines: &[Line], status: ExitStatus) -> Reading {
    let (mut results, running) = results(lines);
    // A line of somebody else's may look like a result; the end of a program does not.
    let failures = failures(lines);
    if status.success() || !failures.is_empty() {
        for result in results.iter_mut().filter(|result| result.outcome != Outcome::Ignored) {
            let failed = failures.contains(&result.name.as_str());
            result.outcome = if failed { Outcome::Failed } else { Outcome::Passed };
        }
    }
    let failed = results.iter().any(|result| result.outcome == Outcome::Failed);
    // Test programs end with 101 when a test has failed.
    let usual = status.success() || failed && status.code().is_some();
    let mut trouble = (!usual).then(|| format!("the process ended with {status}"));
    let seconds =
        lines.last().map_or(0.0, |line| line.at) - results.iter().map(|result| result.seconds).sum::<f64>();
    let mut unfinished = running;
    if unfinished.is_some() {
        trouble.get_or_insert_with(|| "the process ended in the midst of it".to_owned());
    } else if trouble.is_some() {
        match results.last_mut() {
            Some(last) => last.outcome = Outcome::Failed,
            None => {
                let first =
                    names.and_then(|names| names.first()).map_or("documentation tests", String::as_str);
                unfinished = Some(first.to_owned());
            }
        }
    }
    results.extend(unfinished.map(|name| Result { name, outcome: Outcome::Failed, seconds }));
    let missing = |name: &&String| results.iter().all(|result| result.name != **name);
    let mut rest: Vec<String> = names.unwrap_or_default().iter().filter(missing).cloned().collect();
    // A program that ends well without having run what it listed would be asked for ever.
    if trouble.is_none() && !rest.is_empty() {
        trouble = Some(format!("the process said nothing of {}", rest.join(", ")));
        results.extend(rest.drain(..).map(|name| Result { name, outcome: Outcome::Failed, seconds: 0.0 }));
    }
    Reading { results, rest, trouble }
}

/// What a failing test's process printed, without what is said of tests that went well.
pub fn shown(lines: &[Line]) -> String {
    let is_noise = |text: &str| text.starts_with("test ") && text.ends_with(" ... ok");
    lines.iter().filter(|line| !is_noise(&line.text)).map(|line| format!("    {}\n", line.text)).collect()
}

#[cfg(test)]
mod tests {
    use std::os::unix::process::ExitStatusExt as _;

    use super::*;

    const SEGMENTATION_FAULT: i32 = 11;

    fn exited(code: i32) -> ExitStatus {
        ExitStatus::from_raw(code << 8)
    }

    /// One line a second.
    fn lines(text: &str) -> Vec<Line> {
        let line = |(i, text): (usize, &str)| Line { text: text.to_owned(), at: (i + 1) as f64 };
        text.lines().enumerate().map(line).collect()
    }

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(|&name| name.to_owned()).collect()
    }

    fn outcomes(reading: &Reading) -> Vec<(&str, Outcome, f64)> {
        reading.results.iter().map(|r| (r.name.as_str(), r.outcome, r.seconds)).collect()
    }

    use Outcome::{Failed, Ignored, Passed};

    #[test]
    fn results_are_read_with_their_times() {
        let text = "\nrunning 4 tests\ntest a ... ok\ntest b - should panic ... ok\n\
                    test c ... ignored, takes minutes\ntest d ... FAILED\n\nfailures:\n\n---- d stdout ----\n\
                    everything ok\n\nfailures:\n    d\n\ntest result: FAILED. 2 passed; 1 failed";
        let all = names(&["a", "b", "c", "d"]);
        let reading = read(Some(&all), &lines(text), exited(101));
        assert_eq!(
            outcomes(&reading),
            [("a", Passed, 3.0), ("b", Passed, 1.0), ("c", Ignored, 1.0), ("d", Failed, 1.0)]
        );
        assert_eq!((reading.rest.len(), reading.trouble), (0, None));
    }

    #[test]
    fn what_others_print_in_between_changes_nothing() {
        let text = "test a ... LEFT OUT: a\nall is ok\nok\ntest b ... noise\nFAILED\nfailures:\n    b\n";
        let reading = read(Some(&names(&["a", "b"])), &lines(text), exited(101));
        assert_eq!(outcomes(&reading), [("a", Passed, 2.0), ("b", Failed, 3.0)]);
        // Something below the test says that all is well, but the program says that it is not.
        let text = "test a ... FAILED\nit says\nok\n\ntest result: ok. 1 passed";
        assert_eq!(outcomes(&read(Some(&names(&["a"])), &lines(text), exited(0))), [("a", Passed, 1.0)]);
        let text = "test a ... all is ok\nFAILED\nfailures:\n    a\n\ntest result: FAILED\n";
        let reading = read(Some(&names(&["a"])), &lines(text), exited(101));
        assert_eq!(outcomes(&reading), [("a", Failed, 1.0)]);
    }

    #[test]
    fn a_crash_is_the_running_tests_failure_and_the_others_still_run() {
        let status = ExitStatus::from_raw(SEGMENTATION_FAULT);
        let reading = read(Some(&names(&["a", "b", "c"])), &lines("test a ... ok\ntest b ... "), status);
        assert_eq!(outcomes(&reading), [("a", Passed, 1.0), ("b", Failed, 1.0)]);
        assert_eq!(reading.rest, ["c"]);
        assert!(reading.trouble.unwrap().contains("signal: 11"));
    }

    #[test]
    fn a_process_that_does_not_start_fails_its_first_test_only() {
        let reading = read(Some(&names(&["a", "b"])), &lines("libx.so: not found"), exited(127));
        assert_eq!(outcomes(&reading), [("a", Failed, 1.0)]);
        assert_eq!(reading.rest, ["b"]);
    }

    #[test]
    fn a_crash_behind_the_last_test_is_its_failure() {
        let status = ExitStatus::from_raw(SEGMENTATION_FAULT);
        let reading =
            read(Some(&names(&["a"])), &lines("test a ... ok\n\ntest result: ok. 1 passed"), status);
        assert_eq!(outcomes(&reading), [("a", Failed, 1.0)]);
        assert!(reading.rest.is_empty() && reading.trouble.is_some());
    }

    #[test]
    fn an_end_that_looks_well_is_none_without_all_results() {
        let reading = read(Some(&names(&["a", "b"])), &lines("test a ... ok"), exited(0));
        assert_eq!(outcomes(&reading), [("a", Passed, 1.0), ("b", Failed, 0.0)]);
        let reading = read(Some(&names(&["a", "b"])), &lines("test a ... "), exited(0));
        assert_eq!(outcomes(&reading), [("a", Failed, 1.0)]);
        assert_eq!(reading.rest, ["b"]);
    }

    #[test]
    fn documentation_that_does_not_compile_is_a_failure() {
        let text = "test src/lib.rs - (line 3) - compile ... ok\n";
        assert_eq!(
            outcomes(&read(None, &lines(text), exited(0))),
            [("src/lib.rs - (line 3) - compile", Passed, 1.0)]
        );
        let reading = read(None, &lines("error: no such crate"), exited(101));
        assert_eq!(outcomes(&reading), [("documentation tests", Failed, 1.0)]);
    }

    #[test]
    fn failures_are_shown_without_the_tests_that_went_well() {
        assert_eq!(
            shown(&lines("test a ... ok\ntest b ... FAILED\nwhy")),
            "    test b ... FAILED\n    why\n"
        );
    }
}
