//! Writes a capture during a run.

use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use super::{LOG_FILE, Outcome, RUN_FILE, RunInfo, SAMPLES_FILE, Sample};
use crate::DataError;
use yoro_files::{self as files, FileError};

/// Writes a capture during a run.
#[derive(Debug)]
pub struct Writer {
    folder: PathBuf,
    /// The current description of the run.
    pub(crate) info: RunInfo,
    log: File,
    samples: File,
    /// The keys of [`Sample::other`] that have a column.
    others: Vec<String>,
}

impl Writer {
    /// Creates the folder and starts a capture in it. Until [`Writer::finish`], the run counts as interrupted.
    ///
    /// # Errors
    /// [`DataError`], also if the folder already holds a run or a file with the name of one of the capture's files.
    pub fn create(folder: &Path, info: RunInfo) -> Result<Writer, DataError> {
        files::create_folder(folder)?;
        let mut created = Vec::new();
        let begun = Writer::begin(folder, info, &mut created);
        if begun.is_err() {
            for path in created {
                let _ = fs::remove_file(path);
            }
        }
        begun
    }

    /// Starts a capture in new files and adds their paths to `created`.
    fn begin(folder: &Path, mut info: RunInfo, created: &mut Vec<PathBuf>) -> Result<Writer, DataError> {
        info.outcome = Outcome::Interrupted { reason: "the program that captured it was ended".into() };
        let mut new = |name: &str| {
            let path = folder.join(name);
            let file = File::create_new(&path).map_err(|source| match source.kind() {
                ErrorKind::AlreadyExists => DataError::Unusable(format!(
                    "{} is there already, and the capture would replace it: name another folder",
                    path.display()
                )),
                _ => FileError::Write { path: path.clone(), source }.into(),
            })?;
            created.push(path);
            Ok::<_, DataError>(file)
        };
        let writer = Writer {
            folder: folder.into(),
            info,
            log: new(LOG_FILE)?,
            samples: new(SAMPLES_FILE)?,
            others: Vec::new(),
        };
        writer.append(&writer.samples, SAMPLES_FILE, Sample::header(&[]).as_bytes())?;
        writer.renew()?;
        Ok(writer)
    }

    /// Appends bytes of the log.
    pub fn log(&mut self, bytes: &[u8]) -> Result<(), DataError> {
        self.append(&self.log, LOG_FILE, bytes)
    }

    /// Appends a sample. A new key of [`Sample::other`] becomes a column of the whole table.
    pub fn sample(&mut self, sample: &Sample) -> Result<(), DataError> {
        let before = self.others.len();
        for key in sample.other.keys() {
            if !self.others.contains(key) {
                self.others.push(key.clone());
            }
        }
        if self.others.len() > before {
            self.widen(before)?;
        }
        self.append(&self.samples, SAMPLES_FILE, sample.row(&self.others).as_bytes())
    }

    /// Ends the capture with an outcome.
    pub fn finish(mut self, outcome: Outcome) -> Result<RunInfo, DataError> {
        self.info.outcome = outcome;
        self.renew()?;
        Ok(self.info)
    }

    /// Changes the description of the run.
    pub fn change(&mut self, change: impl FnOnce(&mut RunInfo)) -> Result<(), DataError> {
        change(&mut self.info);
        self.renew()
    }

    fn renew(&self) -> Result<(), DataError> {
        Ok(files::write_with(&self.folder.join(RUN_FILE), |out| {
            serde_json::to_writer_pretty(&mut *out, &self.info)?;
            out.write_all(b"\n")
        })?)
    }

    /// Appends a row in a single write, so that readers do not see half a line.
    fn append(&self, mut file: &File, name: &str, row: &[u8]) -> Result<(), DataError> {
        let failed = |source| FileError::Write { path: self.folder.join(name), source };
        Ok(file.write_all(row).map_err(failed)?)
    }

    /// Rewrites the table with empty cells in the new columns. There were `before` columns for [`Sample::other`].
    fn widen(&mut self, before: usize) -> Result<(), DataError> {
        let path = self.folder.join(SAMPLES_FILE);
        let text = String::from_utf8_lossy(&files::read(&path)?).into_owned();
        let header = Sample::header(&self.others);
        let commas = ",".repeat(self.others.len() - before);
        files::write_with(&path, |out| {
            out.write_all(header.as_bytes())?;
            text.lines().skip(1).try_for_each(|row| writeln!(out, "{row}{commas}"))
        })?;
        let open = OpenOptions::new().append(true).open(&path);
        self.samples = open.map_err(|source| FileError::Write { path, source })?;
        Ok(())
    }
}
