//! Processes of tests, as many at a time as there are processors.
//!
//! Ctrl-C at a terminal ends all of them, since they stay in this program's group of processes.

use std::collections::VecDeque;
use std::fs;
use std::io::{self, BufRead as _, BufReader};
use std::process::{Child, Command, ExitStatus};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::transcript::{self, Line, Reading};

/// A silence of this long is told of.
const SLOW: Duration = Duration::from_secs(120);
/// One of this long is the end: the longest tests take a few minutes.
const LIMIT: Duration = Duration::from_secs(900);
/// How often a silent process is looked at.
const LOOK: Duration = Duration::from_millis(100);
/// For how long what a process has printed may be on its way to here when it has ended.
const LATE: Duration = Duration::from_secs(1);

/// What is told while tests run.
#[derive(Debug)]
pub enum News<J> {
    /// This test has been running for so many seconds, and still does.
    Slow(String, u64),
    /// A process has ended.
    Ended {
        /// What it was for.
        job: J,
        /// What became of its tests.
        reading: Reading,
        /// Everything that it printed.
        lines: Vec<Line>,
        /// Seconds by the clock.
        wall: f64,
        /// Seconds on processors, its children's among them.
        processor: f64,
    },
}

/// What is to be run.
pub trait Jobs: Sync {
    /// What one process does.
    type Job: Send;
    /// The process for it.
    fn command(&self, job: &Self::Job) -> Command;
    /// The tests that are chosen, in the order that they run in; none when that is not known.
    fn names<'a>(&self, job: &'a Self::Job) -> Option<&'a [String]>;
    /// A job for the tests that a process did not come to.
    fn again(&self, job: &Self::Job, names: Vec<String>) -> Self::Job;
}

/// Runs all jobs, the first ones first, in `workers` processes at a time; tells of each from here.
pub fn run<J: Jobs>(jobs: &J, list: Vec<J::Job>, workers: usize, mut tell: impl FnMut(News<J::Job>)) {
    let queue = Mutex::new(VecDeque::from(list));
    let (sender, receiver) = mpsc::channel();
    thread::scope(|scope| {
        for _ in 0..workers {
            let (queue, sender) = (&queue, sender.clone());
            scope.spawn(move || work(jobs, queue, &sender));
        }
        drop(sender);
        receiver.iter().for_each(&mut tell);
    });
}

fn work<J: Jobs>(jobs: &J, queue: &Mutex<VecDeque<J::Job>>, sender: &Sender<News<J::Job>>) {
    let locked = || queue.lock().unwrap_or_else(PoisonError::into_inner);
    loop {
        // In a statement of its own: the lock must not be held for as long as the job takes.
        let next = locked().pop_front();
        let Some(job) = next else { return };
        let names = jobs.names(&job);
        let slow = |finished: usize, seconds| {
            let name = names.and_then(|names| names.get(finished).or(names.last()));
            let name = name.map_or("documentation tests", String::as_str);
            sender.send(News::Slow(name.to_owned(), seconds)).ok();
        };
        let (reading, lines, wall, processor) = match process(jobs.command(&job), slow) {
            Ok(Ended { status, lines, wall, processor, too_long }) => {
                let mut reading = transcript::read(names, &lines, status);
                if too_long {
                    reading.trouble = Some(format!("it was ended after {} s", LIMIT.as_secs()));
                }
                (reading, lines, wall, processor)
            }
            Err(error) => {
                let lines = vec![Line { text: format!("it cannot be started: {error}"), at: 0.0 }];
                (transcript::read(names, &lines, failure()), lines, 0.0, 0.0)
            }
        };
        if !reading.rest.is_empty() {
            locked().push_front(jobs.again(&job, reading.rest.clone()));
        }
        sender.send(News::Ended { job, reading, lines, wall, processor }).ok();
    }
}

/// As of a shell that does not find a program.
fn failure() -> ExitStatus {
    std::os::unix::process::ExitStatusExt::from_raw(127 << 8)
}

struct Ended {
    status: ExitStatus,
    lines: Vec<Line>,
    wall: f64,
    processor: f64,
    too_long: bool,
}

/// Runs a process to its end; `slow` is told how many results there are, and for how many seconds no other has come.
fn process(mut command: Command, slow: impl Fn(usize, u64)) -> io::Result<Ended> {
    let (reader, writer) = io::pipe()?;
    command.stdout(writer.try_clone()?).stderr(writer);
    let start = Instant::now();
    let mut child = command.spawn()?;
    // It has the ends for writing, too: as long as they are here, nothing ends.
    drop(command);
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        let mut reader = BufReader::new(reader);
        let mut bytes = Vec::new();
        while reader.read_until(b'\n', &mut bytes).is_ok_and(|count| count > 0) {
            let text = String::from_utf8_lossy(&bytes).trim_end_matches('\n').to_owned();
            if sender.send(Line { text, at: start.elapsed().as_secs_f64() }).is_err() {
                return;
            }
            bytes.clear();
        }
    });
    let (lines, too_long) = listen(&mut child, &receiver, slow)?;
    let processor = processor_seconds(child.id());
    let status = child.wait()?;
    Ok(Ended { status, lines, wall: start.elapsed().as_secs_f64(), processor, too_long })
}

/// What a process prints until it ends, and whether it was ended for its silence.
fn listen(
    child: &mut Child,
    lines: &Receiver<Line>,
    slow: impl Fn(usize, u64),
) -> io::Result<(Vec<Line>, bool)> {
    let mut all = Vec::new();
    let (mut last, mut told, mut results) = (Instant::now(), SLOW, 0);
    let mut end: Option<Instant> = None;
    loop {
        match lines.recv_timeout(end.map_or(LOOK, |end| LATE.saturating_sub(end.elapsed()))) {
            Ok(line) => {
                results += usize::from(line.text.starts_with("test "));
                (last, told) = (Instant::now(), SLOW);
                all.push(line);
            }
            Err(RecvTimeoutError::Disconnected) => return Ok((all, false)),
            // A process below it that goes on may still hold the pipe.
            Err(RecvTimeoutError::Timeout) if end.is_some() => return Ok((all, false)),
            Err(RecvTimeoutError::Timeout) => {
                if has_ended(child.id()) {
                    end = Some(Instant::now());
                    continue;
                }
                if last.elapsed() > LIMIT {
                    child.kill()?;
                    return Ok((all, true));
                }
                if last.elapsed() > told {
                    slow(results, told.as_secs());
                    told *= 2;
                }
            }
        }
    }
}

/// The fields of a process's state behind its name, from the state's letter on.
fn state(process: u32) -> Option<Vec<String>> {
    let text = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let (_, fields) = text.rsplit_once(')')?;
    Some(fields.split_whitespace().map(str::to_owned).collect())
}

/// It has ended, and waits for being asked how.
fn has_ended(process: u32) -> bool {
    state(process).is_none_or(|fields| fields.first().is_some_and(|letter| letter == "Z"))
}

/// Seconds on processors: of a process that was not yet waited for, and of its children that were.
fn processor_seconds(process: u32) -> f64 {
    /// Linux tells programs so, whatever it uses itself.
    const TICKS: f64 = 100.0;
    let fields = state(process).unwrap_or_default();
    let ticks: f64 = fields.iter().skip(11).take(4).filter_map(|field| field.parse::<f64>().ok()).sum();
    ticks / TICKS
}

#[cfg(test)]
mod tests {
    use super::super::transcript::Outcome;
    use super::*;

    /// Tests are lines of a shell's script.
    struct Scripts;

    impl Jobs for Scripts {
        type Job = (&'static str, Vec<String>);

        fn command(&self, (script, names): &Self::Job) -> Command {
            let mut command = Command::new("sh");
            command.args(["-c", script, "sh"]).args(names);
            command
        }

        fn names<'a>(&self, (_, names): &'a Self::Job) -> Option<&'a [String]> {
            Some(names)
        }

        fn again(&self, (script, _): &Self::Job, names: Vec<String>) -> Self::Job {
            (script, names)
        }
    }

    /// Prints as a test program does; `crash` ends by a signal, `fail` fails.
    const PROGRAM: &str = r#"
        code=0
        for name; do
            printf 'test %s ... ' "$name"
            case $name in
                crash) kill -SEGV $$ ;;
                fail) echo FAILED; echo "why it fails" >&2; code=101 ;;
                leave) sleep 5 & echo ok ;;
                *) echo ok ;;
            esac
        done
        exit $code"#;

    fn names(line: &str) -> Vec<String> {
        line.split(' ').map(str::to_owned).collect()
    }

    /// Every test with its outcome, in alphabetical order; everything that was printed; troubles.
    fn outcomes(
        list: &[(&'static str, &str)],
        workers: usize,
    ) -> (Vec<(String, Outcome)>, String, Vec<String>) {
        let list = list.iter().map(|(script, line)| (*script, names(line))).collect();
        let (mut all, mut text, mut troubles) = (Vec::new(), String::new(), Vec::new());
        run(&Scripts, list, workers, |news| {
            let News::Ended { reading, lines, .. } = news else { return };
            all.extend(reading.results.into_iter().map(|result| (result.name, result.outcome)));
            text.extend(lines.into_iter().map(|line| line.text + "\n"));
            troubles.extend(reading.trouble);
        });
        all.sort_by(|a, b| a.0.cmp(&b.0));
        (all, text, troubles)
    }

    #[test]
    fn a_crash_fails_one_test_and_all_others_run() {
        let (all, text, troubles) = outcomes(&[(PROGRAM, "a crash b fail c"), (PROGRAM, "d e")], 2);
        let expected = ["a", "b", "c", "crash", "d", "e", "fail"].map(|name| {
            let failed = ["crash", "fail"].contains(&name);
            (name.to_owned(), if failed { Outcome::Failed } else { Outcome::Passed })
        });
        assert_eq!(all, expected);
        assert!(text.contains("why it fails"), "{text}");
        assert_eq!(troubles.len(), 1, "{troubles:?}");
        assert!(troubles[0].contains("signal: 11"), "{troubles:?}");
    }

    #[test]
    fn two_workers_run_at_the_same_time_and_one_does_not() {
        let folder = tempfile::tempdir().unwrap();
        // Each waits a second for the other's file.
        let meet = format!(
            "cd {}; touch $1; i=0; until [ -e x ] && [ -e y ]; do
                 i=$((i+1)); [ $i -gt 50 ] && rm $1 && exit 1; sleep 0.02
             done; echo \"test $1 ... ok\"; sleep 0.1; rm $1",
            folder.path().display()
        );
        let meet: &'static str = Box::leak(meet.into_boxed_str());
        let met = |workers| {
            let (all, ..) = outcomes(&[(meet, "x"), (meet, "y")], workers);
            all.iter().filter(|(_, outcome)| *outcome == Outcome::Passed).count()
        };
        assert_eq!(met(1), 0);
        assert_eq!(met(2), 2);
    }

    #[test]
    fn a_process_left_behind_is_not_waited_for() {
        let start = Instant::now();
        let (all, ..) = outcomes(&[(PROGRAM, "leave")], 1);
        assert_eq!(all, [("leave".to_owned(), Outcome::Passed)]);
        assert!(start.elapsed() < Duration::from_secs(4));
    }

    /// On a busy machine whoever reads the pipe may come to it only when the process is gone.
    #[test]
    fn what_is_printed_last_is_not_lost() {
        let mut child = Command::new("true").spawn().unwrap();
        let (sender, receiver) = mpsc::channel();
        let reader = thread::spawn(move || {
            thread::sleep(4 * LOOK);
            sender.send(Line { text: "test x ... ok".into(), at: 0.4 }).unwrap();
        });
        let (lines, too_long) = listen(&mut child, &receiver, |_, _| {}).unwrap();
        assert_eq!((lines.len(), too_long), (1, false));
        reader.join().unwrap();
        child.wait().unwrap();
    }

    #[test]
    fn processor_time_holds_the_children() {
        let busy = "sh -c 'i=0; while [ $i -lt 300000 ]; do i=$((i+1)); done'; echo 'test x ... ok'";
        let mut spent = 0.0;
        run(&Scripts, vec![(busy, names("x"))], 1, |news| {
            if let News::Ended { processor, .. } = news {
                spent += processor;
            }
        });
        assert!(spent > 0.05, "{spent}");
    }

    #[test]
    fn what_does_not_start_fails() {
        struct Nothing;
        impl Jobs for Nothing {
            type Job = Vec<String>;
            fn command(&self, _: &Self::Job) -> Command {
                Command::new("/no/such/program")
            }
            fn names<'a>(&self, names: &'a Self::Job) -> Option<&'a [String]> {
                Some(names)
            }
            fn again(&self, _: &Self::Job, names: Vec<String>) -> Self::Job {
                names
            }
        }
        let mut failed = Vec::new();
        run(&Nothing, vec![names("a b")], 1, |news| {
            let News::Ended { reading, .. } = news else { return };
            failed.extend(reading.results.into_iter().map(|result| (result.name, result.outcome)));
        });
        assert_eq!(failed, [("a".to_owned(), Outcome::Failed), ("b".to_owned(), Outcome::Failed)]);
    }
}
