//! Runs one process of a test program, and determines the results of its tests.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::os::unix::process::ExitStatusExt as _;
use std::path::Path;
use std::process::{Command, ExitStatus};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Time without output after which a process is mentioned.
const SLOW: Duration = Duration::from_secs(120);
/// Time without output after which a process is killed. The longest tests take a few minutes.
const TIMEOUT: Duration = Duration::from_secs(900);
/// Interval at which a process and its output are checked.
const POLL: Duration = Duration::from_millis(10);

/// The result of a test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The test succeeded.
    Passed,
    /// The test panicked, or ended its process.
    Failed,
    /// The test was not run.
    Ignored,
}

/// A finished test.
#[derive(Clone, Debug, PartialEq)]
pub struct Test {
    /// Its name.
    pub name: String,
    /// Its outcome.
    pub outcome: Outcome,
    /// Its duration.
    pub seconds: f64,
}

/// A line of output.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// The text without the line end.
    pub text: String,
    at: f64,
}

/// A finished process.
#[derive(Clone, Debug, Default)]
pub struct Finished {
    /// The tests that were run.
    pub tests: Vec<Test>,
    /// The tests that were not reached.
    pub rest: Vec<String>,
    /// The whole output.
    pub lines: Vec<Line>,
    /// The reason, if the process did not end as test programs do.
    pub trouble: Option<String>,
    /// Its duration.
    pub seconds: f64,
}

/// Runs these tests of a program, or whatever it runs if `None`, such as doc tests. The output goes through a file in
/// `folder`, since a process that the program leaves behind could keep a pipe open.
pub fn run(command: Command, names: Option<&[String]>, folder: &Path) -> Finished {
    let start = Instant::now();
    let (lines, status, timed_out) = output(command, folder, start).unwrap_or_else(|error| {
        let line = Line { text: format!("it cannot be started: {error}"), at: 0.0 };
        // The exit status of a shell that cannot find the program.
        (vec![line], ExitStatus::from_raw(127 << 8), false)
    });
    let mut finished = read(names, lines, status, start.elapsed().as_secs_f64());
    if timed_out {
        finished.trouble = Some(format!("it was killed after {} s without a word", TIMEOUT.as_secs()));
    }
    finished
}

/// Runs a process to its end. Returns its lines, its status, and true if it was killed for being silent.
fn output(mut command: Command, folder: &Path, start: Instant) -> io::Result<(Vec<Line>, ExitStatus, bool)> {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let path = folder.join(format!("tests-{}-{number}.log", std::process::id()));
    let log = File::options().append(true).create(true).open(&path)?;
    let mut reader = File::open(&path)?;
    // Removed at once, so that nothing remains, even after Ctrl-C.
    fs::remove_file(&path)?;
    command.stdout(log.try_clone()?).stderr(log);
    let mut child = command.spawn()?;
    let (mut lines, mut bytes) = (Vec::new(), Vec::new());
    let (mut last, mut mention, mut timed_out) = (Instant::now(), SLOW, false);
    // When the beginning of an incomplete line appeared, such as the name of a test that prints nothing until it ends.
    let mut begun = None;
    loop {
        // In this order, so that output before the end is read after it.
        let status = child.try_wait()?;
        if reader.read_to_end(&mut bytes)? > 0 {
            (last, mention) = (Instant::now(), SLOW);
        }
        let whole = if status.is_some() { bytes.len() } else { whole_lines(&bytes) };
        let text = String::from_utf8_lossy(&bytes[..whole]).into_owned();
        let at = start.elapsed().as_secs_f64();
        for line in text.lines() {
            lines.push(Line { text: line.to_owned(), at: begun.take().unwrap_or(at) });
        }
        bytes.drain(..whole);
        if !bytes.is_empty() {
            begun.get_or_insert(at);
        }
        if let Some(status) = status {
            return Ok((lines, status, timed_out));
        }
        if last.elapsed() > TIMEOUT && !timed_out {
            timed_out = true;
            child.kill()?;
        } else if last.elapsed() > mention {
            let test = lines.iter().rev().find_map(|line| started(&line.text)).map_or("", |(name, _)| name);
            println!("silent for {} s: {test}", mention.as_secs());
            mention *= 2;
        }
        thread::sleep(POLL);
    }
}

fn whole_lines(bytes: &[u8]) -> usize {
    bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1)
}

/// Splits a line `test NAME ... REST` into the name and the rest. With one thread, libtest prints the name before it
/// runs the test, so a test that ends its process can be identified.
fn started(line: &str) -> Option<(&str, &str)> {
    let (name, rest) = line.strip_prefix("test ")?.split_once(" ... ")?;
    Some((name.trim_end_matches(" - should panic"), rest))
}

/// Returns the tests that a program lists as failed at its end. Doc tests have one list per library.
fn failures(lines: &[Line]) -> Vec<&str> {
    let lists = lines.split(|line| line.text == "failures:").skip(1);
    let names = lists.map(|list| list.iter().map(|line| line.text.trim()));
    names.flat_map(|names| names.take_while(|name| !name.is_empty())).collect()
}

/// Determines the results. A child process of a test may print into the test's own line, so its `ok` is not searched
/// for; the list at the end and the exit status decide.
fn read(names: Option<&[String]>, lines: Vec<Line>, status: ExitStatus, seconds: f64) -> Finished {
    let chosen = |name: &str| names.is_none_or(|names| names.iter().any(|chosen| chosen == name));
    let begins = |line: &Line| started(&line.text).is_some_and(|(name, _)| chosen(name));
    let starts: Vec<usize> = (0..lines.len()).filter(|&at| begins(&lines[at])).collect();
    let failures = failures(&lines);
    // Test programs exit with 101 after listing the failed tests.
    let usual = status.success() || !failures.is_empty() && status.code() == Some(101);
    let mut tests: Vec<Test> = Vec::new();
    let mut since = 0.0;
    for (i, &at) in starts.iter().enumerate() {
        let Some((name, rest)) = started(&lines[at].text) else { continue };
        let next = starts.get(i + 1).copied();
        let own = &lines[at..next.unwrap_or(lines.len())];
        let failed = match (usual, next) {
            (true, _) => failures.contains(&name),
            (false, Some(_)) => own.iter().any(|line| line.text.ends_with("FAILED")),
            (false, None) => true,
        };
        let outcome = match (rest.starts_with("ignored"), failed) {
            (true, _) => Outcome::Ignored,
            (false, true) => Outcome::Failed,
            (false, false) => Outcome::Passed,
        };
        // A test ends when the next one begins, or when the process ends.
        let until = next.map_or(seconds, |next| lines[next].at);
        tests.push(Test { name: name.to_owned(), outcome, seconds: until - since });
        since = until;
    }
    let mut rest: Vec<String> = names.unwrap_or_default().to_vec();
    rest.retain(|name| tests.iter().all(|test| test.name != *name));
    let mut trouble = (!usual).then(|| format!("the process ended with {status}"));
    let mut lost = Vec::new();
    if usual && !rest.is_empty() {
        trouble = Some(format!("the process said nothing of {}", rest.join(", ")));
        lost = std::mem::take(&mut rest);
    } else if !usual && tests.is_empty() {
        lost.push(if rest.is_empty() { "documentation tests".to_owned() } else { rest.remove(0) });
    }
    let failed = |name| Test { name, outcome: Outcome::Failed, seconds: 0.0 };
    tests.extend(lost.into_iter().map(failed));
    Finished { tests, rest, lines, trouble, seconds }
}

/// Returns the output of a failed test's process without the lines of tests that passed.
pub fn shown(lines: &[Line]) -> String {
    let is_noise = |text: &str| text.starts_with("test ") && text.ends_with(" ... ok");
    lines.iter().filter(|line| !is_noise(&line.text)).map(|line| format!("    {}\n", line.text)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEGMENTATION_FAULT: i32 = 11;

    fn names(line: &str) -> Vec<String> {
        line.split_whitespace().map(str::to_owned).collect()
    }

    /// Makes lines, one per second.
    fn lines(text: &str) -> Vec<Line> {
        let line = |(i, text): (usize, &str)| Line { text: text.to_owned(), at: (i + 1) as f64 };
        text.lines().enumerate().map(line).collect()
    }

    /// Returns the tests' names and outcomes, then the tests that were not reached, and `!` for trouble.
    fn outcomes(finished: &Finished) -> String {
        let words = finished.tests.iter().map(|test| format!("{} {:?}", test.name, test.outcome));
        let rest = finished.rest.iter().cloned();
        let trouble = finished.trouble.iter().map(|_| "!".to_owned());
        words.chain(rest).chain(trouble).collect::<Vec<_>>().join(", ")
    }

    #[test]
    fn results_are_read_from_the_programs_own_lines() {
        let crash = ExitStatus::from_raw(SEGMENTATION_FAULT);
        let exited = |code: i32| ExitStatus::from_raw(code << 8);
        let cases = [
            // All kinds of results.
            (
                "a b c d",
                "\nrunning 4 tests\ntest a ... ok\ntest b - should panic ... ok\ntest c ... ignored, slow\n\
                 test d ... FAILED\n\nfailures:\n\n---- d stdout ----\nall ok\n\nfailures:\n    d\n\ntest result",
                exited(101),
                "a Passed, b Passed, c Ignored, d Failed",
            ),
            // Output of other processes in between has no effect.
            ("a b", "test a ... LEFT OUT: a\nFAILED\nok\ntest b ... x\nok", exited(0), "a Passed, b Passed"),
            (
                "a b",
                "test a ... x\ntest z ... ok\ntest b ... ok\nfailures:\n    b\n",
                exited(101),
                "a Passed, b Failed",
            ),
            // A crash fails the running test; the others still run.
            (
                "a b c d",
                "test a ... ok\ntest b ... FAILED\ntest c ... ",
                crash,
                "a Passed, b Failed, c Failed, d, !",
            ),
            ("a", "test a ... ok\n\ntest result: ok. 1 passed", crash, "a Failed, !"),
            ("a b", "libx.so: not found", exited(127), "a Failed, b, !"),
            // A success is not accepted if results are missing.
            ("a b", "test a ... ok", exited(0), "a Passed, b Failed, !"),
        ];
        for (chosen, text, status, expected) in cases {
            let finished = read(Some(&names(chosen)), lines(text), status, 9.0);
            assert_eq!(outcomes(&finished), expected, "{text}");
        }
        let documentation = [
            (
                "test src/lib.rs - (line 3) - compile ... ok",
                exited(0),
                "src/lib.rs - (line 3) - compile Passed",
            ),
            ("error: no such crate", exited(101), "documentation tests Failed, !"),
            (
                "test x ... FAILED\nfailures:\n    x\n\ntest y ... FAILED\nfailures:\n    y\n",
                exited(101),
                "x Failed, y Failed",
            ),
        ];
        for (text, status, expected) in documentation {
            assert_eq!(outcomes(&read(None, lines(text), status, 9.0)), expected, "{text}");
        }
    }

    #[test]
    fn a_test_takes_until_the_next_one_begins() {
        let text = "running\ntest a ... ok\ntest b ... ignored\ntest c ... ok";
        let finished = read(Some(&names("a b c")), lines(text), ExitStatus::default(), 9.0);
        let seconds: Vec<f64> = finished.tests.iter().map(|test| test.seconds).collect();
        assert_eq!(seconds, [3.0, 1.0, 5.0]);
        assert_eq!(finished.tests[1].outcome, Outcome::Ignored);
        assert_eq!(shown(&finished.lines), "    running\n    test b ... ignored\n");
    }

    /// Runs tests of a shell script that prints like libtest.
    fn run_script(tests: &str) -> Finished {
        const PROGRAM: &str = r#"
            code=0
            for name; do
                printf 'test %s ... ' "$name"
                case $name in
                    crash) kill -SEGV $$ ;;
                    fail) echo FAILED; printf 'why it fails\nfailures:\n    fail\n' >&2; code=101 ;;
                    leave) sleep 5 & echo ok ;;
                    slow) sleep 0.3; echo ok ;;
                    *) echo ok ;;
                esac
            done
            exit $code"#;
        let mut command = Command::new("sh");
        command.args(["-c", PROGRAM, "sh"]).args(names(tests));
        run(command, Some(&names(tests)), tempfile::tempdir().unwrap().path())
    }

    #[test]
    fn processes_are_run_to_their_end() {
        assert_eq!(outcomes(&run_script("a fail")), "a Passed, fail Failed");
        let crashed = run_script("a crash b");
        assert_eq!(outcomes(&crashed), "a Passed, crash Failed, b, !");
        assert!(crashed.trouble.unwrap().contains("signal: 11"));
        let absent = run(Command::new("/no/such/program"), Some(&names("a")), &std::env::temp_dir());
        assert_eq!(outcomes(&absent), "a Failed, !");
    }

    #[test]
    fn the_time_of_a_test_that_prints_nothing_is_its_own() {
        let finished = run_script("a slow b");
        let [a, slow, b] = [0, 1, 2].map(|test| finished.tests[test].seconds);
        assert!(slow > 0.25 && a < slow && b < slow, "{a} s, {slow} s, {b} s");
    }

    #[test]
    fn a_process_left_behind_is_not_waited_for() {
        let finished = run_script("leave");
        assert_eq!(outcomes(&finished), "leave Passed");
        assert!(finished.seconds < 4.0);
    }
}
