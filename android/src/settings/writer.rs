//! A small file that is written on a thread of its own, since flash memory may be too slow for a frame.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Sender};
use std::thread::{self, JoinHandle};

/// The writing thread. Dropping this waits until the last content is written.
pub struct Writer {
    contents: Option<Sender<Vec<u8>>>,
    thread: Option<JoinHandle<()>>,
}

impl Writer {
    /// Starts a thread for a file.
    pub fn new(file: PathBuf) -> Writer {
        let (contents, queue) = mpsc::channel::<Vec<u8>>();
        let work = move || {
            while let Ok(first) = queue.recv() {
                // Only the newest content is written.
                let content = queue.try_iter().last().unwrap_or(first);
                if let Err(error) = write(&file, &content) {
                    let file = file.display();
                    log::warn!("{file} cannot be written ({error}): the menu's settings are lost at the end");
                }
            }
        };
        let thread = thread::Builder::new()
            .name("yoro-settings".into())
            .spawn(work)
            .inspect_err(|error| log::warn!("no thread for the menu's settings ({error}): they are lost"))
            .ok();
        Writer { contents: Some(contents), thread }
    }

    /// Replaces the file's content, on the thread.
    pub fn write(&self, content: Vec<u8>) {
        if let Some(contents) = &self.contents {
            // If the thread could not be started, that is in the log already.
            _ = contents.send(content);
        }
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        self.contents = None;
        if let Some(thread) = self.thread.take() {
            _ = thread.join();
        }
    }
}

/// Replaces a file atomically: readers see either the previous content or this one.
fn write(file: &Path, content: &[u8]) -> io::Result<()> {
    let new = file.with_extension("new");
    std::fs::write(&new, content).and_then(|()| std::fs::rename(&new, file))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_content_is_in_the_file_when_the_writer_is_gone() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("settings");
        let writer = Writer::new(file.clone());
        (0..100).for_each(|n: u32| writer.write(n.to_string().into_bytes()));
        drop(writer);
        assert_eq!(std::fs::read(&file).unwrap(), b"99");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        // No such folder: a sentence in the log, and nothing else.
        let nowhere = Writer::new(folder.path().join("a/b"));
        nowhere.write(Vec::new());
    }
}
