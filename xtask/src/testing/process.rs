//! Runs one process of a test program to its end.

use std::fs::{self, File};
use std::io;
use std::path::Path;
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Time after which a process is killed. The longest tests take a few minutes.
const TIMEOUT: Duration = Duration::from_secs(1200);

/// A finished process.
#[derive(Clone, Debug, Default)]
pub struct Finished {
    /// Numbers of tests that passed, failed and were ignored, by the program's own summaries.
    pub counts: [usize; 3],
    /// The tests that failed, which the program lists at its end; all of its tests if it does not come so far.
    pub failed: Vec<String>,
    /// The whole output.
    pub output: String,
    /// Its duration in seconds.
    pub seconds: f64,
}

/// Runs a program with these tests, which are known by name unless they are those of documentation. The output goes
/// through a file in `folder`, since a process that the program leaves behind could keep a pipe open.
pub fn run(command: Command, names: &[String], folder: &Path) -> Finished {
    let start = Instant::now();
    let (output, succeeded) =
        output(command, folder).unwrap_or_else(|error| (format!("it cannot be run: {error}\n"), false));
    let mut failed = failures(&output);
    if !succeeded && failed.is_empty() {
        failed = names.to_vec();
        if failed.is_empty() {
            failed.push("it ended without a list of failures".to_owned());
        }
    }
    let mut counts = counts(&output);
    counts[1] = failed.len();
    Finished { counts, failed, output, seconds: start.elapsed().as_secs_f64() }
}

/// Runs a process. Returns its output, and true if it succeeded.
fn output(mut command: Command, folder: &Path) -> io::Result<(String, bool)> {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let path = folder.join(format!("tests-{}-{number}.log", std::process::id()));
    let log = File::options().append(true).create(true).open(&path)?;
    let mut reader = File::open(&path)?;
    // Removed at once, so that nothing remains, even after Ctrl-C.
    fs::remove_file(&path)?;
    command.stdout(log.try_clone()?).stderr(log);
    let (start, mut child) = (Instant::now(), command.spawn()?);
    let mut was_killed = false;
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if start.elapsed() > TIMEOUT && !was_killed {
            was_killed = true;
            child.kill()?;
        }
        thread::sleep(Duration::from_millis(10));
    };
    let mut bytes = Vec::new();
    io::Read::read_to_end(&mut reader, &mut bytes)?;
    let mut output = String::from_utf8_lossy(&bytes).into_owned();
    if was_killed {
        output += &format!("\nit was killed after {} s\n", TIMEOUT.as_secs());
    } else if status.code().is_none() {
        output += &format!("\nit ended with {status}\n");
    }
    Ok((output, status.success()))
}

/// Returns the tests that a program lists as failed at its end. Tests in documentation have one list per library.
fn failures(output: &str) -> Vec<String> {
    let lists = output.split("\nfailures:\n").skip(1);
    let names = lists.flat_map(|list| list.lines().take_while(|line| line.starts_with("    ")));
    names.map(|name| name.trim().to_owned()).collect()
}

/// Sums up the lines `test result: ok. 1 passed; 2 failed; 3 ignored; ...`.
fn counts(output: &str) -> [usize; 3] {
    let mut counts = [0; 3];
    for line in output.lines().filter_map(|line| line.strip_prefix("test result: ")) {
        let numbers = line.split([' ', ';']).filter_map(|word| word.parse::<usize>().ok());
        counts.iter_mut().zip(numbers).for_each(|(count, number)| *count += number);
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs tests of a shell script that prints like libtest.
    fn run_script(script: &str, names: &[&str]) -> Finished {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        let names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
        run(command, &names, tempfile::tempdir().unwrap().path())
    }

    #[test]
    fn results_are_the_programs_own_list_or_all_its_tests() {
        let passed =
            run_script("echo 'test result: ok. 2 passed; 0 failed; 1 ignored; 0 measured'", &["a", "b", "c"]);
        assert_eq!((passed.counts, passed.failed.len()), ([2, 0, 1], 0));
        let listing = "printf 'test a ... ok\\n\\nfailures:\\n\\n---- b ----\\nfailures\\n\\nfailures:\\n    b\\n\\n\
                       test result: FAILED. 1 passed; 1 failed; 0 ignored; 0\\n'; exit 101";
        let failed = run_script(listing, &["a", "b"]);
        assert_eq!((failed.counts, failed.failed.join(" ").as_str()), ([1, 1, 0], "b"));
        let crashed = run_script("echo test a; kill -SEGV $$", &["a", "b"]);
        assert_eq!((crashed.counts, crashed.failed.join(" ").as_str()), ([0, 2, 0], "a b"));
        assert!(crashed.output.contains("test a\n") && crashed.output.contains("signal: 11"), "{crashed:?}");
        let absent = run(Command::new("/no/such/program"), &[], &std::env::temp_dir());
        assert_eq!(absent.failed.len(), 1);
    }

    #[test]
    fn a_process_left_behind_is_not_waited_for() {
        assert!(run_script("sleep 5 & echo done", &[]).seconds < 4.0);
    }
}
