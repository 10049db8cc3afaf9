//! The program and its terminal: standard output, panics, log, Ctrl-C, progress.

use std::fmt;
use std::io::{self, Write as _};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use log::Level;

use super::message;
use yoro_files::{FileError, decoder, interrupt};

/// Prints to standard output by [`write`](crate::cli::terminal::write), where the macro of `std` would panic.
macro_rules! print {
    ($($text:tt)*) => { $crate::cli::terminal::write(format_args!($($text)*)) };
}

/// Prints a line as `print!` does.
macro_rules! println {
    () => { print!("\n") };
    ($($text:tt)*) => { print!("{}\n", format_args!($($text)*)) };
}

/// Writes to standard output. Ends the program if that is not possible: without a word when nobody reads it any more,
/// as after `| head`.
pub fn write(text: fmt::Arguments<'_>) {
    let mut out = io::stdout().lock();
    let Err(source) = out.write_fmt(text).and_then(|()| out.flush()) else { return };
    if source.kind() == io::ErrorKind::BrokenPipe {
        std::process::exit(0);
    }
    eprintln!("error: {}", FileError::Write { path: "standard output".into(), source });
    std::process::exit(2);
}

/// Leaves panics of decoders to the sentence about the damaged file.
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

/// Logs to stderr what is at least as important as `level`, or what RUST_LOG names; each warning in one line.
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

/// Makes Ctrl-C and SIGTERM end the program at the next step instead of at once, so that no half-made file
/// stays; a second one ends it at once.
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

/// A progress bar on stderr; hidden when that is not a terminal.
pub fn progress_bar(steps: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {elapsed}, {eta} left  {wide_msg}");
    let bar = ProgressBar::new(steps).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
