//! The threads of this process: whether they are at rest.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::Path;
use std::time::Duration;

/// Number of checks in which a thread must be asleep.
const LOOKS: u32 = 4;
/// Time between two checks.
const PAUSE: Duration = Duration::from_millis(2);

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
