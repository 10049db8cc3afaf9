//! The result format of `yoro bench`: JSON lines, one file a run, appended to and never rewritten.
//!
//! ```text
//! {"record":"header","yoro_bench":1,"suites":["scenes"],"quick":false,"machine":{...},"pass_clock":"finish","parameters":[...]}
//! {"record":"scene","suite":"scenes","scene":"atrium","stands_for":"Sponza","style":"realistic","triangles":365211,"lights":12,"frames":["viewpoint 0",...]}
//! {"record":"unsupported","suite":"scenes","scene":"atrium","contender":"multiview","reason":"..."}
//! {"record":"measurement","suite":"scenes","scene":"atrium","contender":"yoro-gather","round":0,"values":{"frame_ms":[530.1,...],"psnr":[34.1,...]}}
//! ...
//! {"record":"round","suite":"scenes","scene":"atrium","round":0}
//! ```
//!
//! The first line is the [`Header`]. What follows comes in rounds: all records of a round, closed by a
//! [`RoundEnd`], in one write. Records after the last [`RoundEnd`] belong to a round that was cut off; readers
//! leave them out, and a resumed run removes them. A setting (`suite`, `scene`, and where the suite has them
//! `label` and `point`) stands in each record; its facts ([`SceneFacts`]) and [`Unsupported`] contenders come
//! with its first round, and so do values that are equal in each round (quality, memory).
//!
//! In `values` each metric has one number for each of the setting's frames, in the order of
//! [`SceneFacts::frames`]; `null` where there is no finite number: the PSNR of identical images, the quality of
//! holes where there are none. [`metric`] has the names and units.

use std::collections::BTreeMap;
use std::fmt;
use std::fs::{File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::machine::{Machine, Parameter};
use yoro_files::{self as files, FileError};
use yoro_scene::ShadingStyle;

/// Version of the format; raised when old readers would misread a new file.
pub const VERSION: u32 = 1;

/// Names of the metrics, with units. Quality is that of the eye that is not dominant, against the same eye
/// really rendered (`conventional`); images are 8 bits, display-referred.
pub mod metric {
    /// Wall clock of a whole stereo frame up to glFinish, in ms.
    pub const FRAME_MS: &str = "frame_ms";
    /// CPU time of the whole process during that frame, all threads together, in ms.
    pub const CPU_MS: &str = "cpu_ms";
    /// Prefix of the time of one pass in ms: `pass_ms/march`. The header's `pass_clock` says what clock. Frames
    /// of their own, since timing passes costs time. One value per round, at the setting's first frame.
    pub const PASS_MS: &str = "pass_ms/";
    /// GPU time of all passes of a frame by timer queries, in ms; only where they can be trusted. One value per
    /// round, at the setting's first frame.
    pub const GPU_MS: &str = "gpu_ms";
    /// Textures that the contender holds after its first frame, by their formats, in MiB; one value.
    pub const TEXTURE_MIB: &str = "texture_mib";
    /// The same with the resident memory of the process that has loaded the scene and made no contender yet, in MiB;
    /// one value.
    pub const MEMORY_MIB: &str = "memory_mib";

    /// PSNR of red, green and blue in dB; null for identical images.
    pub const PSNR: &str = "psnr";
    /// PSNR of luma in dB.
    pub const PSNR_LUMA: &str = "psnr_luma";
    /// SSIM, gaussian 11x11, mean of red, green and blue.
    pub const SSIM: &str = "ssim";
    /// The same of luma.
    pub const SSIM_LUMA: &str = "ssim_luma";
    /// SSIM, uniform 7x7, mean of red, green and blue.
    pub const SSIM_UNIFORM: &str = "ssim_uniform";
    /// LDR-FLIP, mean over the image, 0 (equal) to 1.
    pub const FLIP: &str = "flip";
    /// Share of the pixels that the dominant eye's own image does not show, 0 to 1: the same for all contenders.
    pub const HOLE_SHARE: &str = "hole_share";
    /// PSNR (RGB) in the holes, in dB.
    pub const HOLE_PSNR: &str = "hole_psnr";
    /// SSIM (gaussian, RGB) in the holes.
    pub const HOLE_SSIM: &str = "hole_ssim";
    /// FLIP in the holes.
    pub const HOLE_FLIP: &str = "hole_flip";
    /// PSNR (RGB) elsewhere, in dB.
    pub const VISIBLE_PSNR: &str = "visible_psnr";
    /// SSIM (gaussian, RGB) elsewhere.
    pub const VISIBLE_SSIM: &str = "visible_ssim";
    /// FLIP elsewhere.
    pub const VISIBLE_FLIP: &str = "visible_flip";

    /// Flicker over all pixels, of 255; see [`crate::metrics::Flicker`]. One value per pair of frames, so one
    /// less than frames, as for the following.
    pub const FLICKER: &str = "flicker";
    /// Flicker in the holes of either frame.
    pub const FLICKER_HOLES: &str = "flicker_holes";
    /// Flicker at the edges of the image, outside of holes.
    pub const FLICKER_EDGES: &str = "flicker_edges";
    /// Flicker everywhere else.
    pub const FLICKER_REST: &str = "flicker_rest";
    /// Change of the ground truth from frame to frame, over all pixels, of 255: what flicker is to be held
    /// against.
    pub const CHANGE: &str = "change";
    /// The same in the holes of either frame.
    pub const CHANGE_HOLES: &str = "change_holes";
    /// The same at edges.
    pub const CHANGE_EDGES: &str = "change_edges";
    /// The same everywhere else.
    pub const CHANGE_REST: &str = "change_rest";

    /// The flicker metrics: all pixels, holes, edges, the rest.
    pub const FLICKERS: [&str; 4] = [FLICKER, FLICKER_HOLES, FLICKER_EDGES, FLICKER_REST];
    /// Their counterparts of the ground truth, measured for `conventional`.
    pub const CHANGES: [&str; 4] = [CHANGE, CHANGE_HOLES, CHANGE_EDGES, CHANGE_REST];

    /// Columns of the guard band that were drawn in a frame.
    pub const GUARD_COLUMNS: &str = "guard_columns";
    /// Pixels that lay in the guard band and were seen, but were not drawn, in a frame.
    pub const UNDRAWN: &str = "undrawn";
    /// PSNR of red, green and blue in dB in the columns at the other eye's outer border that a guard band is for.
    pub const BORDER_PSNR: &str = "border_psnr";

    /// Trips of the loop of the march's short way for a pixel.
    pub const TRIPS_PIXEL: &str = "trips_pixel";
    /// The same for a wave.
    pub const TRIPS_WAVE: &str = "trips_wave";
    /// Share of the pixels that go the long way, 0 to 1.
    pub const GOES_ON_PIXEL: &str = "goes_on_pixel";
    /// Share of the waves of which a pixel does.
    pub const GOES_ON_WAVE: &str = "goes_on_wave";
    /// Columns that the march walks on its long way, for a wave.
    pub const LONG_TRIPS_WAVE: &str = "long_trips_wave";
    /// Estimated issue slots for each pixel of the first pass of `gather`.
    pub const SLOTS_TILES: &str = "slots_tiles";
    /// The same of the second pass.
    pub const SLOTS_SPANS: &str = "slots_spans";
    /// The same of the third.
    pub const SLOTS_MARCH: &str = "slots_march";
    /// The same of all three.
    pub const SLOTS: &str = "slots";
    /// Estimated texture instructions for each pixel.
    pub const FETCHES: &str = "fetches";
    /// Estimated time of the issue slots alone, in ms.
    pub const ALU_MS: &str = "alu_ms";
    /// Estimated time of the texture instructions alone, in ms.
    pub const FETCH_MS: &str = "fetch_ms";
    /// Estimated time of the bytes alone, in ms.
    pub const MEMORY_MS: &str = "memory_ms";

    /// Time of a patcher alone in ms, by the wall clock, on an image that lies where the patcher works.
    pub const PATCH_MS: &str = "patch_ms";
    /// Upload and readback around that, in ms; 0 for patchers on the CPU.
    pub const PATCH_TRANSFER_MS: &str = "patch_transfer_ms";
}

/// What clock the times of passes are taken with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PassClock {
    /// Timer queries of a GPU.
    TimerQueries,
    /// The wall clock with glFinish around each pass: a CPU rasterizer, whose timer queries are unusable.
    Finish,
}

/// The first line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// [`VERSION`] of the format.
    pub yoro_bench: u32,
    /// The suites, in their order.
    pub suites: Vec<String>,
    /// Whether this was the short form (`--quick`).
    pub quick: bool,
    /// Machine, driver, date and command.
    pub machine: Machine,
    /// Clock of pass times.
    pub pass_clock: PassClock,
    /// Everything that has an influence on the figures, as resolved; a run with others cannot go on with the
    /// file.
    pub parameters: Vec<Parameter>,
}

/// What is held fixed while the contenders take turns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// Name of the suite.
    pub suite: String,
    /// Name of the scene.
    pub scene: String,
    /// The point of a sweep over what has no number: the name of a shading style.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// Where something is swept: its value, in the unit of the suite (triangles, mm, m, ImBuffer divisor,
    /// pixels).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<f64>,
}

/// `ipd, atrium, 65`.
impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}", self.suite, self.scene)?;
        self.label.iter().try_for_each(|label| write!(f, ", {label}"))?;
        self.point.iter().try_for_each(|point| write!(f, ", {point}"))
    }
}

/// What there is to know of a setting's scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneFacts {
    /// Which setting.
    #[serde(flatten)]
    pub setting: Setting,
    /// The scene of the paper that it stands for; empty if for none.
    pub stands_for: String,
    /// Shading style in use.
    pub style: ShadingStyle,
    /// Triangles of the whole scene.
    pub triangles: u64,
    /// Point lights in use, at most.
    pub lights: u64,
    /// Names of the frames that are measured, in the order of the values.
    pub frames: Vec<String>,
}

/// A contender in one round.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// Which setting.
    #[serde(flatten)]
    pub setting: Setting,
    /// [`crate::bench::Contender::name`].
    pub contender: String,
    /// Counted from 0.
    pub round: u32,
    /// By metric: a number for each frame, none where there is no finite one.
    pub values: BTreeMap<String, Vec<Option<f64>>>,
}

impl Measurement {
    /// The finite values of a metric; empty when it was not measured.
    pub fn finite(&self, metric: &str) -> impl Iterator<Item = f64> + '_ {
        self.values.get(metric).into_iter().flatten().filter_map(|value| *value)
    }

    /// Adds the next frame's value of a metric; what is not finite becomes none.
    pub fn push(&mut self, metric: impl Into<String>, value: f64) {
        self.values.entry(metric.into()).or_default().push(value.is_finite().then_some(value));
    }
}

/// A contender that cannot take part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unsupported {
    /// Which setting.
    #[serde(flatten)]
    pub setting: Setting,
    /// [`crate::bench::Contender::name`].
    pub contender: String,
    /// Why not, in one sentence or clause.
    pub reason: String,
}

/// All of a round is in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoundEnd {
    /// Which setting.
    #[serde(flatten)]
    pub setting: Setting,
    /// Counted from 0.
    pub round: u32,
}

/// One line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "record", rename_all = "kebab-case")]
pub enum Record {
    /// The first line.
    Header(Header),
    /// Facts of a setting.
    Scene(SceneFacts),
    /// Figures of a contender.
    Measurement(Measurement),
    /// A contender that cannot take part.
    Unsupported(Unsupported),
    /// Closes a round.
    Round(RoundEnd),
}

/// Why a file of results cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// It cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// Its first line is not a header.
    #[error(
        "{} is not a result of yoro bench (its first line is not a header): name another file",
        path.display()
    )]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// It was written by another version.
    #[error(
        "{} has version {version} of the result format and this yoro reads version {VERSION}: use the yoro that wrote it, or measure again into another file",
        path.display()
    )]
    Version {
        /// The file.
        path: PathBuf,
        /// What it says.
        version: u64,
    },
    /// A line that is not the last one cannot be read.
    #[error(
        "{}, line {line} is damaged ({what}): restore the file from a copy, or measure again into another file",
        path.display()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Counted from 1.
        line: usize,
        /// What is wrong.
        what: String,
    },
    /// It belongs to a run with other parameters.
    #[error(
        "{} holds results with {name} = {there}, and this run has {here}: give the same options to go on with it, or name another file",
        path.display()
    )]
    Parameters {
        /// The file.
        path: PathBuf,
        /// What differs.
        name: String,
        /// The file's value.
        there: String,
        /// This run's value.
        here: String,
    },
}

/// A file of results.
#[derive(Clone, Debug, PartialEq)]
pub struct Results {
    /// Where it was read.
    pub path: PathBuf,
    /// The first line.
    pub header: Header,
    /// All records of finished rounds, in the file's order, without the header.
    pub records: Vec<Record>,
    /// Bytes up to the end of the last finished round.
    finished_bytes: u64,
}

impl Results {
    /// Reads a file. What belongs to a round that was cut off, as by Ctrl-C or a power failure, is left out with
    /// a warning.
    ///
    /// # Errors
    /// [`RecordError`] for a file that cannot be read, is something else, or is damaged before its last line.
    pub fn read(path: &Path) -> Result<Results, RecordError> {
        let bytes = files::read(path)?;
        // Without its newline even a line that can be read is not finished.
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
                Err(error) => {
                    let (path, what) = (path.into(), error.to_string());
                    return Err(RecordError::Damaged { path, line: index + 1, what });
                }
            }
        }
        let header = header.ok_or_else(|| RecordError::Foreign { path: path.into() })?;
        if cut_off || records.len() > finished_records {
            log::warn!("{}: the last round is cut off and is left out", path.display());
        }
        records.truncate(finished_records);
        Ok(Results { path: path.into(), header, records, finished_bytes: finished_bytes as u64 })
    }

    /// The figures.
    pub fn measurements(&self) -> impl Iterator<Item = &Measurement> {
        self.records.iter().filter_map(|record| match record {
            Record::Measurement(measurement) => Some(measurement),
            _ => None,
        })
    }

    /// The facts of the settings, in the order in which they were measured.
    pub fn scenes(&self) -> impl Iterator<Item = &SceneFacts> {
        self.records.iter().filter_map(|record| match record {
            Record::Scene(facts) => Some(facts),
            _ => None,
        })
    }

    /// The contenders that could not take part.
    pub fn unsupported(&self) -> impl Iterator<Item = &Unsupported> {
        self.records.iter().filter_map(|record| match record {
            Record::Unsupported(unsupported) => Some(unsupported),
            _ => None,
        })
    }

    /// Number of finished rounds of a setting.
    pub fn rounds(&self, setting: &Setting) -> u32 {
        let ends = self.records.iter().filter(|r| matches!(r, Record::Round(end) if end.setting == *setting));
        ends.count() as u32
    }

    /// Whether a setting was left out, as one that the machine cannot carry: nobody was measured, and the file
    /// says why.
    pub fn is_left_out(&self, setting: &Setting) -> bool {
        self.rounds(setting) > 0 && !self.measurements().any(|m| m.setting == *setting)
    }
}

/// The header, with a sentence of its own for each way in which the first line can be something else.
fn read_header(path: &Path, line: &[u8]) -> Result<Header, RecordError> {
    let foreign = || RecordError::Foreign { path: path.into() };
    let value: serde_json::Value = serde_json::from_slice(line).map_err(|_| foreign())?;
    let version = value["yoro_bench"].as_u64().ok_or_else(foreign)?;
    if version != u64::from(VERSION) {
        return Err(RecordError::Version { path: path.into(), version });
    }
    match serde_json::from_value(value) {
        Ok(Record::Header(header)) => Ok(header),
        Ok(_) => Err(foreign()),
        Err(error) => Err(RecordError::Damaged { path: path.into(), line: 1, what: error.to_string() }),
    }
}

/// Appends to a file of results, a whole round at a time.
#[derive(Debug)]
pub struct Writer {
    file: File,
    path: PathBuf,
}

impl Writer {
    /// Opens the file of a run: a new one, or one that a run with the same header has begun; what was cut off at
    /// its end is removed. Returns what it holds already.
    ///
    /// # Errors
    /// [`RecordError`]; the file stays as it was then.
    pub fn open(path: &Path, header: &Header) -> Result<(Writer, Results), RecordError> {
        if !path.exists() {
            files::write(path, &lines(&[Record::Header(header.clone())]))?;
        }
        let results = Results::read(path)?;
        if let Some((name, there, here)) = difference(&results.header, header) {
            return Err(RecordError::Parameters { path: path.into(), name, there, here });
        }
        let failed = |source| FileError::Write { path: path.into(), source };
        let file = OpenOptions::new().append(true).open(path).map_err(failed)?;
        file.set_len(results.finished_bytes).map_err(failed)?;
        Ok((Writer { file, path: path.into() }, results))
    }

    /// Appends the records of a round and its end, and waits until the disk has them.
    ///
    /// # Errors
    /// [`RecordError::File`]; the round is not counted then, whatever part of it was written.
    pub fn append(&mut self, mut records: Vec<Record>, end: RoundEnd) -> Result<(), RecordError> {
        records.push(Record::Round(end));
        let write = |file: &mut File| -> io::Result<()> {
            file.write_all(&lines(&records))?;
            file.sync_data()
        };
        write(&mut self.file).map_err(|source| FileError::Write { path: self.path.clone(), source }.into())
    }
}

fn lines(records: &[Record]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for record in records {
        serde_json::to_writer(&mut bytes, record)
            .expect("records have text keys, and memory takes all bytes");
        bytes.push(b'\n');
    }
    bytes
}

/// The first thing in which two headers differ so that their figures do not belong together: its name, the
/// value there and here. Date and command do not count.
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

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use std::fs;

    fn header() -> Header {
        Header {
            yoro_bench: VERSION,
            suites: vec!["ipd".into()],
            quick: true,
            machine: Machine {
                cpu: "a CPU".into(),
                cores: 2,
                os: "Linux".into(),
                gl_renderer: "llvmpipe".into(),
                gl_version: "OpenGL ES 3.2".into(),
                yoro: "0.1.0".into(),
                date: "2026-01-01T00:00:00Z".into(),
                command: "yoro bench ipd".into(),
            },
            pass_clock: PassClock::Finish,
            parameters: vec![Parameter { name: "rounds".into(), value: "2".into() }],
        }
    }

    fn setting(point: f64) -> Setting {
        Setting { suite: "ipd".into(), scene: "talk".into(), label: None, point: Some(point) }
    }

    fn round(point: f64, round: u32) -> (Vec<Record>, RoundEnd) {
        let mut measurement =
            Measurement { setting: setting(point), contender: "mono".into(), round, values: BTreeMap::new() };
        measurement.push(metric::PSNR, f64::INFINITY);
        measurement.push(metric::PSNR, 31.5);
        measurement.push(metric::SSIM, 0.95);
        let reason = "no GL_OVR_multiview2".into();
        let unsupported = Unsupported { setting: setting(point), contender: "multiview".into(), reason };
        let records = vec![Record::Unsupported(unsupported), Record::Measurement(measurement)];
        (records, RoundEnd { setting: setting(point), round })
    }

    fn append(writer: &mut Writer, point: f64, number: u32) {
        let (records, end) = round(point, number);
        writer.append(records, end).unwrap();
    }

    #[test]
    fn rounds_come_back_as_they_were_written() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("new/run.jsonl");
        let (mut writer, before) = Writer::open(&path, &header()).unwrap();
        assert!(before.records.is_empty());
        append(&mut writer, 62.5, 0);
        append(&mut writer, 62.5, 1);
        drop(writer);
        let results = Results::read(&path).unwrap();
        assert_eq!(results.header, header());
        assert_eq!((results.rounds(&setting(62.5)), results.rounds(&setting(63.0))), (2, 0));
        let measurement = results.measurements().next().unwrap();
        assert_eq!(measurement.values[metric::PSNR], [None, Some(31.5)]);
        assert_eq!(measurement.finite(metric::PSNR).collect::<Vec<_>>(), [31.5]);
        assert_eq!(results.unsupported().count(), 2);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.starts_with(r#"{"record":"header","yoro_bench":1,"#), "{text}");
    }

    #[test]
    fn a_run_that_was_cut_off_anywhere_goes_on() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("run.jsonl");
        let (mut writer, _) = Writer::open(&path, &header()).unwrap();
        append(&mut writer, 50.0, 0);
        let finished = fs::metadata(&path).unwrap().len() as usize;
        append(&mut writer, 55.0, 0);
        drop(writer);
        let whole = fs::read(&path).unwrap();
        for length in finished..whole.len() {
            fs::write(&path, &whole[..length]).unwrap();
            let (mut writer, results) = Writer::open(&path, &header()).unwrap();
            assert_eq!((results.rounds(&setting(50.0)), results.rounds(&setting(55.0))), (1, 0), "{length}");
            append(&mut writer, 55.0, 0);
            assert_eq!(fs::read(&path).unwrap(), whole, "{length}");
        }
    }

    #[test]
    fn other_parameters_are_refused_and_the_file_stays() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("run.jsonl");
        Writer::open(&path, &header()).unwrap();
        let before = fs::read(&path).unwrap();
        let mut later = header();
        later.machine.date = "2026-01-02T00:00:00Z".into();
        later.machine.command = "yoro bench ipd --out run.jsonl".into();
        Writer::open(&path, &later).unwrap();
        let refused = |change: fn(&mut Header)| {
            let mut other = header();
            change(&mut other);
            Writer::open(&path, &other).unwrap_err().to_string()
        };
        let error = refused(|h| h.parameters[0].value = "5".into());
        assert!(error.contains("run.jsonl holds results with rounds = 2, and this run has 5"), "{error}");
        let error = refused(|h| h.parameters.clear());
        assert!(error.contains("rounds = 2, and this run has nothing"), "{error}");
        let error = refused(|h| h.machine.gl_renderer = "a GPU".into());
        assert!(error.contains("GL renderer = llvmpipe"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), before);
    }

    #[test]
    fn foreign_and_damaged_files_are_named() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("run.jsonl");
        let says = |bytes: &[u8]| {
            fs::write(&path, bytes).unwrap();
            let read = Results::read(&path).unwrap_err().to_string();
            let opened = Writer::open(&path, &header()).unwrap_err().to_string();
            assert_eq!(read, opened);
            assert_eq!(fs::read(&path).unwrap(), bytes, "it was changed");
            read
        };
        for foreign in [&b""[..], b"a letter\n", b"{\"name\":1}\n", b"\x89PNG\r\n\x1a\n", b"[1]"] {
            assert!(says(foreign).contains("run.jsonl is not a result of yoro bench"));
        }
        assert!(says(b"{\"record\":\"header\",\"yoro_bench\":7}\n").contains("version 7"));
        assert!(says(b"{\"record\":\"header\",\"yoro_bench\":1}\n").contains("line 1 is damaged"));
        let mut bytes = lines(&[Record::Header(header())]);
        bytes.extend_from_slice(b"{\"record\":\"meas\n");
        let (records, end) = round(50.0, 0);
        bytes.extend(lines(&records));
        bytes.extend(lines(&[Record::Round(end)]));
        let error = says(&bytes);
        assert!(error.contains("run.jsonl, line 2 is damaged"), "{error}");
        fs::remove_file(&path).unwrap();
        assert!(Results::read(&path).unwrap_err().to_string().contains("does not exist"));
    }
}
