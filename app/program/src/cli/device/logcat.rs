//! `yoro device logcat`.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::ensure;

use crate::cli::Subcommand;
use crate::cli::args;
use crate::cli::message;
use yoro_devices::capture::{DeviceInfo, Outcome, RunInfo, Sample, VERSION, Writer};
use yoro_devices::log::{self, SIMULATED_MARK};
use yoro_devices::reading::{LineContent, Reading};
use yoro_files::FileError;
use yoro_files::interrupt;

/// The names of method and scene in a capture if the log has several, or none.
const SEVERAL: &str = "several";
const UNKNOWN: &str = "unknown";

/// Print a saved log as a table; keep it as a capture
#[derive(clap::Args, Clone, Debug)]
pub struct LogcatArgs {
    /// The log, as adb logcat -v threadtime -v epoch prints it; - for standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Folder for the capture: the log as it came, and samples.csv
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Name of the method in the capture [default: what the log says]
    #[arg(long, value_name = "NAME")]
    method: Option<String>,
    /// Name of the scene in the capture [default: what the log says]
    #[arg(long, value_name = "NAME")]
    scene: Option<String>,
    /// Number of the repetition in the capture: those of the same number, scene and device are compared
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = args::whole::<u32>(1..=u32::MAX))]
    repetition: u32,
}

impl Subcommand for LogcatArgs {
    /// Reads the log, and prints its samples and faults.
    fn run(&self) -> anyhow::Result<()> {
        let file = &self.file;
        let failed = |source| FileError::Read { path: file.into(), source };
        let mut input: Box<dyn BufRead> = if file == Path::new("-") {
            Box::new(io::stdin().lock())
        } else {
            // A pipe such as /dev/fd/63 is accepted like a file.
            ensure!(!file.is_dir(), FileError::IsFolder { path: file.into() });
            Box::new(BufReader::new(File::open(file).map_err(|source| match source.kind() {
                io::ErrorKind::NotFound => FileError::Missing { path: file.into() },
                _ => failed(source),
            })?))
        };
        let mut table = Table::new(self)?;
        let mut line = Vec::new();
        while !interrupt::requested() && input.read_until(b'\n', &mut line).map_err(failed)? > 0 {
            table.line(&line)?;
            line.clear();
        }
        ensure!(
            table.reading.has_read(),
            "{} has no line of the tags YORO and VrApi: save it by adb logcat -v threadtime -v epoch",
            file.display()
        );
        table.finish()
    }
}

/// Prints the samples of a log, and writes them if a folder is given.
struct Table<'a> {
    args: &'a LogcatArgs,
    reading: Reading,
    writer: Option<Writer>,
    simulated: bool,
    /// The method and the scene of the rows so far.
    named: Option<(String, String)>,
}

impl<'a> Table<'a> {
    fn new(args: &'a LogcatArgs) -> anyhow::Result<Table<'a>> {
        let began = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        let info = RunInfo {
            version: VERSION,
            device: DeviceInfo { serial: UNKNOWN.into(), ..DeviceInfo::default() },
            experiment: None,
            method: UNKNOWN.into(),
            scene: UNKNOWN.into(),
            repetition: args.repetition,
            order: 1,
            settings: BTreeMap::new(),
            started_unix_s: began.as_secs_f64(),
            duration_s: 0.0,
            warm_up_s: 0.0,
            start_celsius: None,
            application: None,
            outcome: Outcome::Complete,
            faults: Vec::new(),
        };
        let writer = args.out.as_deref().map(|folder| Writer::create(folder, info)).transpose()?;
        Ok(Table { args, reading: Reading::new(None), writer, simulated: false, named: None })
    }

    fn line(&mut self, line: &[u8]) -> anyhow::Result<()> {
        if let Some(writer) = &mut self.writer {
            writer.log(line)?;
        }
        let line = &*log::text(line);
        if line.starts_with(SIMULATED_MARK) && !self.simulated {
            self.simulated = true;
            println!("SIMULATED: {}", line.trim_matches(['-', ' ']));
        }
        match self.reading.line(line, None) {
            LineContent::Sample(sample) => self.sample(&sample)?,
            LineContent::Damaged(why) => {
                let text: String = line.chars().take(60).collect();
                println!("{}", message::one_line(&format!("damaged line ({why}): {text}...")));
            }
            LineContent::Summary | LineContent::Other => {}
        }
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> anyhow::Result<()> {
        if let Some(writer) = &mut self.writer {
            writer.sample(sample)?;
        }
        let named = self.reading.methods().last();
        if named != self.named.as_ref() || sample.time_s == 0.0 {
            self.named = named.cloned();
            if let Some((method, scene)) = named {
                println!("{method} in {scene}");
            }
            let head = [
                "TIME", "FPS", "STALE", "FRAME ms", "P99 ms", "GPU ms", "CPU %", "RSS MB", "mA", "W",
                "LEVEL %", "BATT C", "SKIN C", "PLUG", "THERMAL",
            ];
            println!("{}", cells(head.map(str::to_owned)));
        }
        let real =
            |value: Option<f64>, decimals: usize| value.map_or("na".into(), |v| format!("{v:.decimals$}"));
        let whole = |value: Option<i32>| value.map_or("na".into(), |v| v.to_string());
        let rate = match (sample.fps, sample.refresh_hz) {
            (Some(fps), Some(hz)) => format!("{fps:.1}/{hz:.0}"),
            (fps, _) => real(fps, 1),
        };
        let watts = sample.current_ma.zip(sample.voltage_mv).map(|(ma, mv)| -ma * mv / 1e6);
        let row = [
            format!("{:.1}", sample.time_s),
            rate,
            real(sample.stale, 0),
            real(sample.frame_ms, 2),
            real(sample.p99_ms, 2),
            real(sample.gpu_ms, 2),
            real(sample.cpu_percent, 0),
            real(sample.rss_mb, 0),
            real(sample.current_ma, 0),
            real(watts, 2),
            real(sample.level_percent, 0),
            real(sample.battery_celsius, 1),
            real(sample.skin_celsius, 1),
            whole(sample.plugged),
            whole(sample.thermal_status),
        ];
        println!("{}", cells(row));
        Ok(())
    }

    fn finish(mut self) -> anyhow::Result<()> {
        if let Some(last) = self.reading.end() {
            self.sample(&last)?;
        }
        let faults = self.reading.faults();
        for fault in &faults {
            let at = fault.at_s.map_or(String::new(), |at_s| format!(" (from {at_s:.0} s)"));
            println!("fault: {}{at}", fault.detail);
        }
        println!("{} samples, {} damaged lines", self.reading.samples(), self.reading.damaged());
        let Some(mut writer) = self.writer.take() else { return Ok(()) };
        let (method, scene) = match self.reading.methods() {
            [] => (UNKNOWN, UNKNOWN),
            [(method, scene)] => (method.as_str(), scene.as_str()),
            _ => (SEVERAL, SEVERAL),
        };
        writer.change(|info| {
            info.method = self.args.method.as_deref().unwrap_or(method).into();
            info.scene = self.args.scene.as_deref().unwrap_or(scene).into();
            info.device.simulated = self.simulated;
            info.duration_s = self.reading.time_s();
            info.faults = faults;
        })?;
        let folder = writer.folder().to_path_buf();
        writer.finish(Outcome::Complete)?;
        println!("capture: {}", folder.display());
        Ok(())
    }
}

/// Formats a row of cells that are wide enough for all usual values.
fn cells<const N: usize>(cells: [String; N]) -> String {
    cells.iter().map(|cell| format!("{cell:>8}")).collect::<Vec<_>>().join(" ")
}
