//! Runs the program.

use std::ffi::OsStr;
use std::ops::Deref;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// The exit code and output of a finished run.
pub struct Run {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Run {
    /// Makes a run from the output of a finished process.
    pub fn new(output: Output) -> Run {
        let text = |bytes| String::from_utf8(bytes).expect("the program prints UTF-8");
        Run { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }

    /// Parses standard output as JSON.
    pub fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|e| panic!("{e}: {}", self.stdout))
    }

    /// Fails unless the run failed as it should after a user's mistake: with exit code 2 and one sentence on stderr
    /// that contains all of `naming`, without any message of Rust itself.
    #[track_caller]
    pub fn refuses(&self, naming: &[&str]) {
        let text = &self.stderr;
        assert_eq!(self.code, Some(2), "{text}");
        // The parser of the command line adds lines with the possible values and a hint to the help.
        let hints = ["Usage:", "For more information", "  "];
        let hint = |line: &&str| hints.iter().any(|hint| line.starts_with(hint));
        let mut lines = text.lines().filter(|line| !line.is_empty() && !hint(line));
        let sentence = lines.next().unwrap_or_default();
        let rest: Vec<&str> = lines.collect();
        assert!(sentence.starts_with("error: "), "{text}");
        assert!(rest.is_empty(), "more than one sentence: {text}");
        for name in naming {
            assert!(text.contains(name), "{name:?} is not in: {text}");
        }
        for internal in ["panicked", "stack backtrace", "RUST_BACKTRACE", "src/", "unwrap", "Some(", "Err("] {
            assert!(!text.contains(internal), "{text}");
        }
    }
}

/// A folder that is removed after the test.
pub struct Folder(tempfile::TempDir);

impl Deref for Folder {
    type Target = Path;

    fn deref(&self) -> &Path {
        self.0.path()
    }
}

/// Makes a folder for a test.
pub fn folder() -> Folder {
    Folder(tempfile::tempdir().unwrap())
}

/// Returns the command that runs the program with these arguments and without the tester's environment settings.
pub fn yoro<A: AsRef<OsStr>>(arguments: impl IntoIterator<Item = A>) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_yoro"));
    command.args(arguments).stdin(Stdio::null()).env_remove("RUST_LOG").env_remove("RUST_BACKTRACE");
    command
}

/// Runs the program in a folder with a line of arguments, which is split at spaces.
pub fn run(folder: &Path, line: &str) -> Run {
    finish(yoro(line.split_whitespace()).current_dir(folder))
}

/// Runs the program like [`run`]. Fails unless the exit code is 0.
#[track_caller]
pub fn succeed(folder: &Path, line: &str) -> Run {
    let run = run(folder, line);
    assert_eq!(run.code, Some(0), "yoro {line}: {}", run.stderr);
    run
}

/// Runs a command, and waits for its end.
pub fn finish(command: &mut Command) -> Run {
    Run::new(command.output().expect("the program starts"))
}

/// Runs the program in a folder with a line of arguments until `begun` returns true, then sends Ctrl-C. Fails if the
/// program has ended before, or does not end soon afterwards with exit code 130. Its standard output is lost.
#[track_caller]
pub fn interrupt(folder: &Path, line: &str, begun: impl Fn() -> bool) -> Run {
    let mut command = yoro(line.split_whitespace());
    let command = command.current_dir(folder).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    let start = Instant::now();
    while !begun() {
        assert!(start.elapsed() < Duration::from_secs(120), "yoro {line}: nothing was finished");
        assert_eq!(child.try_wait().unwrap(), None, "yoro {line}: it has ended by itself");
        thread::sleep(Duration::from_millis(20));
    }
    press_ctrl_c(&child);
    let run = in_time(child, Duration::from_secs(20));
    assert_eq!(run.code, Some(130), "yoro {line}: {}", run.stderr);
    run
}

/// Waits for the end of a running program, which must come in time.
#[track_caller]
pub fn in_time(mut child: Child, limit: Duration) -> Run {
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > limit {
            child.kill().unwrap();
            panic!("it goes on: {}", Run::new(child.wait_with_output().unwrap()).stderr);
        }
        thread::sleep(Duration::from_millis(5));
    }
    Run::new(child.wait_with_output().unwrap())
}

/// Sends a running program the signal of Ctrl-C.
pub fn press_ctrl_c(child: &Child) {
    let killed = Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert!(killed.success());
}
