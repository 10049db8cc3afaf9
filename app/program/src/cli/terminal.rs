//! The program's terminal: standard output, panics, log, Ctrl-C, progress.

use std::fmt;
use std::io::{self, Write as _};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use log::Level;

use super::message;
use yoro_files::{FileError, decoder, interrupt};

/// Prints to standard output with [`write`](crate::cli::terminal::write), where the macro of `std` would panic.
macro_rules! print {
    ($($text:tt)*) => { $crate::cli::terminal::write(format_args!($($text)*)) };
}

/// Prints a line like `print!`.
macro_rules! println {
    () => { print!("\n") };
    ($($text:tt)*) => { print!("{}\n", format_args!($($text)*)) };
}

/// Writes to standard output. If that fails, ends the program: silently if nobody reads the output any more, as after
/// `| head`.
pub fn write(text: fmt::Arguments<'_>) {
    let mut out = io::stdout().lock();
    let Err(source) = out.write_fmt(text).and_then(|()| out.flush()) else { return };
    if source.kind() == io::ErrorKind::BrokenPipe {
        std::process::exit(0);
    }
    eprintln!("error: {}", FileError::Write { path: "standard output".into(), source });
    std::process::exit(2);
}

/// Moves panics of decoders to the debug log, because an error about the damaged file replaces them.
pub fn quiet_decoders() {
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if decoder::runs() {
            log::debug!("{info}");
        } else {
            before(info);
        }
    }));
}

/// Logs messages of at least `level`, or those that RUST_LOG selects, to stderr, with each warning in one line.
pub fn log_from(level: &str) {
    env_logger::Builder::from_env(env_logger::Env::default().default_filter_or(level))
        .format(|out, record| {
            let level = record.level();
            let style = out.default_level_style(level);
            let mut text = record.args().to_string();
            if level <= Level::Warn {
                text = message::one_line(&text);
            }
            writeln!(out, "[{style}{level:<5}{style:#}] {text}")
        })
        .init();
}

/// Makes the first Ctrl-C or SIGTERM end the program at the next step, so that no incomplete file remains, and a second
/// one end it at once.
pub fn catch_interrupt() {
    let handler = || {
        if interrupt::request() {
            std::process::exit(130);
        }
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        log::debug!("Ctrl-C is not caught: {error}");
    }
}

/// Returns a progress bar on stderr, which is hidden if that is not a terminal.
pub fn progress_bar(steps: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {elapsed}, {eta} left  {wide_msg}");
    let bar = ProgressBar::new(steps).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
