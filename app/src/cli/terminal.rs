//! The program and its terminal: pipes, Ctrl-C, progress.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use yoro_files::interrupt;

/// Ends the program without a word when nobody reads its standard output any more, as after `| head`: `print!` would
/// panic.
pub fn end_with_reader() {
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        let message = info.payload_as_str().unwrap_or_default();
        if message.starts_with("failed printing to stdout") && message.contains("Broken pipe") {
            std::process::exit(0);
        }
        before(info);
    }));
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
