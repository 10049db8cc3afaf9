//! The log, its copy in a game loop's results, and its last lines for sharing, without logcat's times and tags.

use std::collections::VecDeque;
use std::fs::File;
use std::io::Write as _;
use std::sync::{Mutex, MutexGuard, PoisonError};

use android_logger::{AndroidLogger, Config};
use log::{LevelFilter, Log, Metadata, Record};

/// The file for results while a game loop is played.
static FILE: Mutex<Option<File>> = Mutex::new(None);

/// The last lines of the log.
static RECENT: Mutex<VecDeque<String>> = Mutex::new(VecDeque::new());
/// The number of those lines, and the characters of each. An intent holds a text twice, in two bytes per character: 240
/// kB.
const LINES: usize = 200;
const CHARACTERS: usize = 300;

/// Returns the last lines of the log.
pub fn recent() -> String {
    let lines = RECENT.lock().unwrap_or_else(PoisonError::into_inner);
    lines.iter().flat_map(|line| [line.as_str(), "\n"]).collect()
}

fn file() -> MutexGuard<'static, Option<File>> {
    FILE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Installs the logger. In a second run of the process the first logger stays.
pub fn init_log(config: Config) {
    if log::set_boxed_logger(Box::new(Logger(AndroidLogger::new(config)))).is_ok() {
        log::set_max_level(LevelFilter::Info);
    }
}

/// Starts to write every line to this file, too.
pub fn begin(results: Option<File>) {
    *file() = results;
}

/// Closes the file.
pub fn end() {
    *file() = None;
}

struct Logger(AndroidLogger);

impl Log for Logger {
    fn enabled(&self, metadata: &Metadata) -> bool {
        self.0.enabled(metadata)
    }

    fn log(&self, record: &Record) {
        self.0.log(record);
        if self.0.enabled(record.metadata()) {
            let mut lines = RECENT.lock().unwrap_or_else(PoisonError::into_inner);
            if lines.len() == LINES {
                lines.pop_front();
            }
            lines.push_back(record.args().to_string().chars().take(CHARACTERS).collect());
        }
        if self.0.enabled(record.metadata())
            && let Some(file) = &mut *file()
        {
            // A line is one write. If it fails, the same line is still in the device's log.
            _ = file.write_all(format!("{}\n", record.args()).as_bytes());
        }
    }

    fn flush(&self) {}
}
