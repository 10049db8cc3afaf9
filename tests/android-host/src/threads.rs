//! The threads of this process: whether they make progress, and whether they are at rest.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::Path;
use std::time::{Duration, Instant};

/// Number of checks in which a thread must be asleep.
const LOOKS: u32 = 4;
/// Time between two checks.
const PAUSE: Duration = Duration::from_millis(2);

/// Real time that a step or a callback of the activity may take without progress.
const PATIENCE: Duration = Duration::from_secs(60);
/// Minimum processor time that counts as progress. On a busy machine, especially under qemu, a frame may take minutes,
/// so real time alone does not show that a process hangs.
const MIN_PROGRESS: Duration = Duration::from_millis(1200);
/// Maximum processor time. A process that uses more is in an endless loop.
const MAX_PROCESSOR_TIME: Duration = Duration::from_secs(1200);

/// The progress of something that must end.
pub struct Progress {
    /// Processor time of the process at the beginning.
    begun: Duration,
    /// When the process last made progress, and its processor time then.
    moved: (Instant, Duration),
}

impl Progress {
    /// Starts now, with this processor time of the process.
    pub fn new(now: Instant, spent: Duration) -> Progress {
        Progress { begun: spent, moved: (now, spent) }
    }

    /// Returns the reason for giving up, if there is one.
    pub fn given_up(&mut self, now: Instant, spent: Duration) -> Option<String> {
        let used = spent.saturating_sub(self.begun);
        if used > MAX_PROCESSOR_TIME {
            return Some(format!("has used {:.0} s of processor time", used.as_secs_f64()));
        }
        if spent.saturating_sub(self.moved.1) > MIN_PROGRESS {
            self.moved = (now, spent);
        }
        let still = now.saturating_duration_since(self.moved.0);
        (still > PATIENCE).then(|| format!("has stood still for {:.0} s", still.as_secs_f64()))
    }
}

/// Returns the processor time of all threads since the process began.
pub fn processor_time() -> Duration {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: writes to the structure.
    unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &raw mut time) };
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Returns the name and the state of a thread: R if it is running or ready, S if it sleeps.
fn state(task: &Path) -> Option<(String, char)> {
    let stat = std::fs::read_to_string(task.join("stat")).ok()?;
    // The name is in parentheses, and may itself contain some.
    let (before, after) = stat.rsplit_once(") ")?;
    Some((before.split_once('(')?.1.to_owned(), after.chars().next()?))
}

/// Returns the names and states of all other threads in /proc, or `None` if they cannot be listed.
pub fn others() -> Option<impl Iterator<Item = (OsString, char)>> {
    // SAFETY: takes nothing and cannot fail.
    let own = unsafe { libc::gettid() }.to_string();
    let tasks = std::fs::read_dir("/proc/self/task").ok()?;
    let others = tasks.flatten().filter(move |task| task.file_name() != own.as_str());
    Some(others.filter_map(|task| Some((task.file_name(), state(&task.path())?.1))))
}

/// Waits until all other threads are at rest, so that those that are about to end have ended. A thread that waits for a
/// time on the virtual clock wakes up again and again, so it need not be asleep in consecutive checks.
pub fn rest() {
    let mut asleep: BTreeMap<OsString, u32> = BTreeMap::new();
    loop {
        let mut at_rest = true;
        for (thread, state) in others().into_iter().flatten() {
            let looks = asleep.entry(thread).or_default();
            *looks += u32::from(state == 'S');
            at_rest &= *looks >= LOOKS;
        }
        if at_rest {
            return;
        }
        std::thread::sleep(PAUSE);
    }
}

/// Returns the kernel function in which each thread waits, which is the first clue to a deadlock.
pub fn list() -> String {
    let mut states: BTreeMap<String, u32> = BTreeMap::new();
    for task in std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten() {
        let (name, state) = state(&task.path()).unwrap_or(("?".into(), '?'));
        let wchan = std::fs::read_to_string(task.path().join("wchan")).unwrap_or_default();
        *states.entry(format!("{name} ({state}, {})", wchan.trim())).or_default() += 1;
    }
    let list: Vec<_> = states
        .into_iter()
        .map(|(name, count)| if count > 1 { format!("{count}x {name}") } else { name })
        .collect();
    format!("threads: {}", list.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_hangs_when_it_stands_still_or_runs_in_circles_and_not_when_it_is_slow() {
        let start = Instant::now();
        let seconds = Duration::from_secs_f64;
        // Returns when and why the run gives up on a process with this share of a processor.
        let given_up = |share: f64| {
            let mut progress = Progress::new(start, seconds(5.0));
            (0..40_000).find_map(|second| {
                let (now, spent) = (seconds(f64::from(second)), seconds(5.0 + share * f64::from(second)));
                progress.given_up(start + now, spent).map(|reason| (second, reason))
            })
        };
        assert_eq!(given_up(0.0), Some((61, "has stood still for 61 s".into())));
        assert_eq!(given_up(0.0001), Some((61, "has stood still for 61 s".into())));
        assert_eq!(given_up(0.025), None, "1200 s of processor time take 48000 s");
        assert_eq!(given_up(0.1), Some((12_001, "has used 1200 s of processor time".into())));
    }
}
