//! What the layer says: to the standard error output, and to a file that `yoro layer log` shows; on Android to logcat.

use std::fmt;
use std::fs::File;
use std::io::Write;
use std::path::PathBuf;
use std::sync::OnceLock;

use crate::xdg;

/// Bytes that a line has room for; the rest is cut off.
const LONGEST: usize = 1024;

/// The file that the program that has begun last writes to: `$XDG_STATE_HOME/yoro/layer.log`, in `~/.local/state` where
/// that is not set; None without a home.
pub fn path() -> Option<PathBuf> {
    Some(xdg::folder("XDG_STATE_HOME", ".local/state")?.join("yoro/layer.log"))
}

/// Begun anew by each program, with its first line. Where it cannot be written there is none: the lines are on the standard
/// error output, too.
fn file() -> Option<&'static File> {
    static FILE: OnceLock<Option<File>> = OnceLock::new();
    let open = || {
        let path = path()?;
        std::fs::create_dir_all(path.parent()?).ok()?;
        // Emptied, not replaced: whoever follows it goes on reading. Appended to, since two programs may run.
        let file = File::options().create(true).append(true).open(path).ok()?;
        file.set_len(0).ok()?;
        Some(file)
    };
    FILE.get_or_init(open).as_ref()
}

#[cfg(not(target_os = "android"))]
fn show(line: &[u8]) {
    std::io::stderr().lock().write_all(line).ok();
}

/// Under the tag `yoro`. A line has room for the zero that C wants in place of its end.
#[cfg(target_os = "android")]
fn show(line: &[u8]) {
    use std::ffi::{c_char, c_int};
    #[link(name = "log")]
    unsafe extern "C" {
        fn __android_log_write(priority: c_int, tag: *const c_char, text: *const c_char) -> c_int;
    }
    const INFO: c_int = 4;
    let mut text = [0u8; LONGEST];
    text[..line.len() - 1].copy_from_slice(&line[..line.len() - 1]);
    // SAFETY: both texts end in zero.
    unsafe { __android_log_write(INFO, c"yoro".as_ptr(), text.as_ptr().cast()) };
}

/// Writes a line, at once and without an allocation, so that the application's own do not get in between; it may have
/// closed its standard error output.
pub fn say(text: fmt::Arguments) {
    let mut line = [b'\n'; LONGEST];
    let (place, _) = line.split_at_mut(LONGEST - 1);
    let mut rest = &mut *place;
    // What does not fit is cut off.
    write!(rest, "yoro layer: {text}").ok();
    let length = LONGEST - 1 - rest.len();
    line[length] = b'\n';
    let line = &line[..=length];
    show(line);
    if let Some(mut file) = file() {
        file.write_all(line).ok();
    }
}
