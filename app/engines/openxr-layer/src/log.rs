//! The layer's log. It goes to standard error and to a file that `yoro layer log` shows; on Android it goes to logcat.

use std::fmt;
use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use crate::lock;
use crate::xdg;

/// The largest length of a line in bytes. Longer lines are truncated.
const MAX_LINE_BYTES: usize = 1024;

/// Returns the path of the log of the last program, `$XDG_STATE_HOME/yoro/layer.log` (`~/.local/state` if that is not
/// set), or `None` without a home folder.
pub fn path() -> Option<PathBuf> {
    Some(xdg::folder("XDG_STATE_HOME", ".local/state")?.join("yoro/layer.log"))
}

/// Open while there is an instance. Loaders unload the layer with the last one, and an open file would stay open.
static FILE: Mutex<Option<File>> = Mutex::new(None);

/// Returns the first line of the file, which identifies this process by its number and by the time when it began, in
/// ticks of the system's clock.
fn first_line() -> String {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The program's name, in parentheses, may contain spaces.
    let began = stat.rsplit(')').next().and_then(|rest| rest.split_whitespace().nth(19)).unwrap_or("0");
    format!("yoro layer: log of process {}, begun at {began}\n", std::process::id())
}

/// Opens a file for appending. It is emptied unless this process began it.
fn open(path: &Path, first_line: &str) -> io::Result<File> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    // Emptied, not replaced, so that programs that follow it go on reading. Appended to, since two programs may run.
    let mut file = File::options().create(true).append(true).read(true).open(path)?;
    let mut begins = vec![0; first_line.len()];
    if file.read_exact(&mut begins).is_err() || begins != first_line.as_bytes() {
        file.set_len(0)?;
        file.write_all(first_line.as_bytes())?;
    }
    Ok(file)
}

/// Closes the file until the next line is written.
pub fn close() {
    *lock(&FILE) = None;
}

#[cfg(not(target_os = "android"))]
fn show(line: &[u8]) {
    std::io::stderr().lock().write_all(line).ok();
}

/// Writes to logcat under the tag `yoro`. A terminating zero replaces the line break.
#[cfg(target_os = "android")]
fn show(line: &[u8]) {
    use std::ffi::{c_char, c_int};
    #[link(name = "log")]
    unsafe extern "C" {
        fn __android_log_write(priority: c_int, tag: *const c_char, text: *const c_char) -> c_int;
    }
    const INFO: c_int = 4;
    let mut text = [0u8; MAX_LINE_BYTES];
    text[..line.len() - 1].copy_from_slice(&line[..line.len() - 1]);
    // SAFETY: both strings are null-terminated.
    unsafe { __android_log_write(INFO, c"yoro".as_ptr(), text.as_ptr().cast()) };
}

/// Writes a line in one piece, so that no line of the application gets in between, and without allocating. The
/// application may have closed standard error.
pub fn log_line(text: fmt::Arguments) {
    let mut line = [b'\n'; MAX_LINE_BYTES];
    let (place, _) = line.split_at_mut(MAX_LINE_BYTES - 1);
    let mut rest = &mut *place;
    // Text that does not fit is truncated.
    write!(rest, "yoro layer: {text}").ok();
    let length = MAX_LINE_BYTES - 1 - rest.len();
    line[length] = b'\n';
    let line = &line[..=length];
    show(line);
    let mut file = lock(&FILE);
    if file.is_none() {
        // If the file cannot be written, nothing is lost: the lines also go to standard error.
        *file = path().and_then(|path| open(&path, &first_line()).ok());
    }
    if let Some(file) = &mut *file {
        file.write_all(line).ok();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_is_begun_anew_by_each_process_but_not_by_each_instance() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state/layer.log");
        for (first, line, want) in [
            ("process 7\n", "one\n", "process 7\none\n"),
            ("process 7\n", "two\n", "process 7\none\ntwo\n"),
            ("process 77\n", "three\n", "process 77\nthree\n"),
        ] {
            open(&path, first).unwrap().write_all(line.as_bytes()).unwrap();
            assert_eq!(std::fs::read_to_string(&path).unwrap(), want);
        }
        assert_eq!(first_line(), first_line());
    }
}
