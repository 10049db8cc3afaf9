//! liblog: the application's log, which is written to the summary and, on request, to standard error.

use std::collections::VecDeque;
use std::ffi::{c_char, c_int};
use std::sync::Mutex;

use crate::bionic::{text, thread_name};
use crate::exports::{Export, System, exports};
use crate::host::{host, lock};
use crate::summary::LogLine;

/// The tags of the application, also used by its telemetry, and of the API layer.
pub const TAGS: [&str; 2] = ["YORO", "yoro"];

/// Everything logged so far.
pub struct Log {
    /// True if all lines are printed.
    pub verbose: bool,
    state: Mutex<Collected>,
    abort_message: Mutex<String>,
}

#[derive(Default)]
struct Collected {
    /// Lines with one of [`TAGS`], and errors: those of the summary.
    lines: Vec<LogLine>,
    recent: VecDeque<String>,
    total: usize,
}

/// Maximum number of lines kept for the summary and for waiting steps. A failing application may log millions.
const KEPT: usize = 5000;

impl Log {
    /// Creates an empty log.
    pub fn new(verbose: bool) -> Self {
        Self { verbose, state: Mutex::default(), abort_message: Mutex::default() }
    }

    fn add(&self, priority: c_int, tag: String, text: String) {
        let host = host();
        let priority = *b"??VDIWEFS".get(priority as usize).unwrap_or(&b'?') as char;
        let line = LogLine { seconds: host.clock.seconds(), frame: host.frames.shown(), priority, tag, text };
        let shown =
            format!("{:9.3} {}/{} ({}): {}", line.seconds, line.priority, line.tag, thread_name(), line.text);
        if self.verbose {
            host.say(&shown);
        }
        let mut state = lock(&self.state);
        state.recent.push_back(format!("{}/{}: {}", line.priority, line.tag, line.text));
        state.total += 1;
        if state.recent.len() > KEPT {
            state.recent.pop_front();
        }
        if (TAGS.contains(&line.tag.as_str()) || matches!(priority, 'E' | 'F')) && state.lines.len() < KEPT {
            state.lines.push(line);
        }
    }

    /// Returns the lines for the summary.
    pub fn lines(&self) -> Vec<LogLine> {
        lock(&self.state).lines.clone()
    }

    /// Returns the number of the first line, from number `from` on, that contains the text. The tag does not matter.
    pub fn find(&self, from: usize, text: &str) -> Option<usize> {
        let state = lock(&self.state);
        let first = state.total - state.recent.len();
        let skipped = from.saturating_sub(first);
        state
            .recent
            .iter()
            .skip(skipped)
            .position(|line| line.contains(text))
            .map(|index| first + skipped + index)
    }

    /// Stores the message that the application gives before it calls `abort`.
    pub fn set_abort_message(&self, message: String) {
        *lock(&self.abort_message) = message;
    }

    /// Returns this message, or else the last lines of the log, for the text of a failure.
    pub fn abort_message(&self) -> String {
        let message = lock(&self.abort_message).clone();
        let state = lock(&self.state);
        let last: Vec<_> =
            state.recent.iter().skip(state.recent.len().saturating_sub(5)).map(String::as_str).collect();
        if message.is_empty() {
            format!("; last log lines: {}", last.join(" | "))
        } else {
            format!(": {message}")
        }
    }
}

/// Returns the functions that liblog.so exports.
pub fn exports() -> Vec<Export> {
    exports![
        System::Log, 1: [__android_log_buf_write, __android_log_write];
    ]
}

unsafe extern "C" fn __android_log_write(
    priority: c_int,
    tag: *const c_char,
    message: *const c_char,
) -> c_int {
    // SAFETY: terminated strings by contract.
    let (tag, message) = unsafe { (text(tag), text(message)) };
    host().log.add(priority, tag, message.trim_end_matches('\n').to_owned());
    1
}

unsafe extern "C" fn __android_log_buf_write(
    _buffer: c_int,
    priority: c_int,
    tag: *const c_char,
    message: *const c_char,
) -> c_int {
    // SAFETY: the same contract as this function's.
    unsafe { __android_log_write(priority, tag, message) }
}
