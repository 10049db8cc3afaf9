//! Files of results: reading finished rounds, and appending new ones.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};

use super::{Conditions, Header, Measurement, Record, RoundEnd, SceneFacts, Unsupported, VERSION};
use yoro_files::{self as files, FileError};

/// A file of results.
#[derive(Clone, Debug, PartialEq)]
pub struct Results {
    /// The path of the file.
    pub path: PathBuf,
    /// The header, which is the first line.
    pub header: Header,
    /// All records of finished rounds in the order of the file, without the header.
    pub records: Vec<Record>,
    /// The number of bytes up to the end of the last finished round.
    finished_bytes: u64,
}

impl Results {
    /// Reads a file. The records of a round that was cut off, for example by Ctrl-C or a power failure, are left out
    /// with a warning.
    ///
    /// # Errors
    /// [`FileError`], and for a file that is not a result file, or is damaged before its last line.
    pub fn read(path: &Path) -> anyhow::Result<Results> {
        let bytes = files::read(path)?;
        // A line without its newline is not finished, even if it can be read.
        let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
        let mut cut_off = whole < bytes.len();
        let mut header = None;
        let mut records = Vec::new();
        let (mut finished_records, mut finished_bytes, mut offset) = (0, 0, 0);
        for (index, line) in bytes[..whole].split_inclusive(|byte| *byte == b'\n').enumerate() {
            offset += line.len();
            if index == 0 {
                header = Some(read_header(path, line)?);
                finished_bytes = offset;
                continue;
            }
            match serde_json::from_slice::<Record>(line) {
                Ok(record) => {
                    let end = matches!(record, Record::Round(_));
                    records.push(record);
                    if end {
                        (finished_records, finished_bytes) = (records.len(), offset);
                    }
                }
                Err(_) if offset == bytes.len() => cut_off = true,
                Err(error) => return Err(damaged(path, index + 1, &error)),
            }
        }
        let header = header.ok_or_else(|| foreign(path))?;
        if cut_off || records.len() > finished_records {
            log::warn!("{}: the last round is cut off and is left out", path.display());
        }
        records.truncate(finished_records);
        Ok(Results { path: path.into(), header, records, finished_bytes: finished_bytes as u64 })
    }

    /// Returns the measurements.
    pub fn measurements(&self) -> impl Iterator<Item = &Measurement> {
        self.records.iter().filter_map(|record| match record {
            Record::Measurement(measurement) => Some(measurement),
            _ => None,
        })
    }

    /// Returns the facts about the settings in the order of measurement.
    pub fn scenes(&self) -> impl Iterator<Item = &SceneFacts> {
        self.records.iter().filter_map(|record| match record {
            Record::Scene(facts) => Some(facts),
            _ => None,
        })
    }

    /// Returns the contenders that could not take part.
    pub fn unsupported(&self) -> impl Iterator<Item = &Unsupported> {
        self.records.iter().filter_map(|record| match record {
            Record::Unsupported(unsupported) => Some(unsupported),
            _ => None,
        })
    }

    /// Returns the number of finished rounds of a setting.
    pub fn rounds(&self, conditions: &Conditions) -> u32 {
        let ends =
            self.records.iter().filter(|r| matches!(r, Record::Round(end) if end.conditions == *conditions));
        ends.count() as u32
    }
}

/// Reads the header, with a different error for each way in which the first line can be wrong.
fn read_header(path: &Path, line: &[u8]) -> anyhow::Result<Header> {
    let value: serde_json::Value = serde_json::from_slice(line).map_err(|_| foreign(path))?;
    let version = value["yoro_bench"].as_u64().ok_or_else(|| foreign(path))?;
    if version != u64::from(VERSION) {
        bail!(
            "{} has version {version} of the result format and this yoro reads version {VERSION}: use the yoro that wrote it, or measure again into another file",
            path.display()
        );
    }
    match serde_json::from_value(value) {
        Ok(Record::Header(header)) => Ok(header),
        Ok(_) => Err(foreign(path)),
        Err(error) => Err(damaged(path, 1, &error)),
    }
}

fn foreign(path: &Path) -> anyhow::Error {
    let path = path.display();
    anyhow!("{path} is not a result of yoro bench (its first line is not a header): name another file")
}

/// Returns the error of a line, counted from 1.
fn damaged(path: &Path, line: usize, error: &serde_json::Error) -> anyhow::Error {
    anyhow!(
        "{}, line {line} is damaged ({error}): restore the file from a copy, or measure again into another file",
        path.display()
    )
}

/// Appends to a file of results, a whole round at a time.
#[derive(Debug)]
pub struct Writer {
    file: File,
    path: PathBuf,
}

impl Writer {
    /// Opens the file of a run: a new one, or one that a run with the same header has begun, whose cut-off end is
    /// removed. Returns the finished results in it. Only one process at a time can have the file open.
    ///
    /// # Errors
    /// [`FileError`], also for a file that is another run's, or that cannot be read; it is then unchanged.
    pub fn open(path: &Path, header: &Header) -> anyhow::Result<(Writer, Results)> {
        let failed = |source| FileError::Write { path: path.into(), source };
        let mut file = files::append(path)?;
        if file.metadata().map_err(failed)?.len() == 0 {
            file.write_all(&lines(&[Record::Header(header.clone())])).map_err(|source| {
                let _ = fs::remove_file(path);
                failed(source)
            })?;
        }
        let results = Results::read(path)?;
        if let Some((name, there, here)) = difference(&results.header, header) {
            bail!(FileError::OtherRun(format!(
                "{} holds results with {name} = {there}, and this run has {here}: give the same options to go on with it, or name another file",
                path.display()
            )));
        }
        file.set_len(results.finished_bytes).map_err(failed)?;
        Ok((Writer { file, path: path.into() }, results))
    }

    /// Appends the records of a round and its end, and waits until they are on the disk.
    ///
    /// # Errors
    /// [`FileError`]; the round then does not count, even if part of it was written.
    pub fn append(&mut self, mut records: Vec<Record>, end: RoundEnd) -> Result<(), FileError> {
        records.push(Record::Round(end));
        let write = |file: &mut File| -> io::Result<()> {
            file.write_all(&lines(&records))?;
            file.sync_data()
        };
        write(&mut self.file).map_err(|source| FileError::Write { path: self.path.clone(), source })
    }
}

pub(super) fn lines(records: &[Record]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for record in records {
        serde_json::to_writer(&mut bytes, record)
            .expect("records have text keys, and memory takes all bytes");
        bytes.push(b'\n');
    }
    bytes
}

/// Returns the first difference between two headers that keeps their figures apart: its name, the value there and the
/// value here. Date and command do not count.
fn difference(there: &Header, here: &Header) -> Option<(String, String, String)> {
    let differing =
        |name: &str, there: String, here: String| (there != here).then(|| (name.to_owned(), there, here));
    let (a, b) = (&there.machine, &here.machine);
    let fixed = [
        ("suites", there.suites.join(" "), here.suites.join(" ")),
        ("quick", there.quick.to_string(), here.quick.to_string()),
        ("version of yoro", a.yoro.clone(), b.yoro.clone()),
        ("CPU", a.cpu.clone(), b.cpu.clone()),
        ("cores", a.cores.to_string(), b.cores.to_string()),
        ("GL renderer", a.gl_renderer.clone(), b.gl_renderer.clone()),
        ("GL version", a.gl_version.clone(), b.gl_version.clone()),
    ];
    if let Some(found) = fixed.into_iter().find_map(|(name, a, b)| differing(name, a, b)) {
        return Some(found);
    }
    let value = |header: &Header, name: &str| {
        let found = header.parameters.iter().find(|parameter| parameter.name == name);
        found.map_or_else(|| "nothing".to_owned(), |parameter| parameter.value.clone())
    };
    let names = there.parameters.iter().chain(&here.parameters).map(|parameter| &parameter.name);
    names.into_iter().find_map(|name| differing(name, value(there, name), value(here, name)))
}
