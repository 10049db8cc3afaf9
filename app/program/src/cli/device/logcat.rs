//! `yoro device logcat`.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, IsTerminal};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use anyhow::{Context, bail, ensure};

use super::which::WhichArgs;
use crate::cli::Subcommand;
use crate::cli::args::{self, parse_positive};
use crate::cli::message;
use yoro_devices::adb::{Device, DeviceError, now};
use yoro_devices::capture::{DeviceInfo, Fault, Outcome, RunInfo, Sample, VERSION, Writer};
use yoro_devices::follow::{Event, Follower, faults_of_loss};
use yoro_devices::log::{self, SIMULATED_MARK};
use yoro_devices::phone;
use yoro_devices::reading::{LineContent, Reading};
use yoro_files::FileError;
use yoro_files::interrupt;

/// The number of rows after which the head of the table is repeated on a terminal.
const ROWS: u64 = 24;
/// The names of method and scene in a capture if the log has several, or none.
const SEVERAL: &str = "several";
const UNKNOWN: &str = "unknown";

/// Follow a device's log as a table, or read a saved one; keep it as a capture
#[derive(clap::Args, Clone, Debug)]
pub struct LogcatArgs {
    /// A saved log instead of a device; - for standard input
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
    /// Folder for the capture: the log as it came, and samples.csv [default for a device: out/logcat-TIME; for a file:
    /// none]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Stop after this many seconds [default: on Ctrl-C]
    #[arg(long, value_parser = parse_positive, value_name = "S", conflicts_with = "file")]
    seconds: Option<f32>,
    /// Begin with the oldest line that the device still has
    #[arg(long, conflicts_with = "file")]
    from_oldest: bool,
    /// Name of the method in the capture [default: what the log says]
    #[arg(long, value_name = "NAME")]
    method: Option<String>,
    /// Name of the scene in the capture [default: what the log says]
    #[arg(long, value_name = "NAME")]
    scene: Option<String>,
    /// Number of the repetition in the capture: those of the same number, scene and device are compared
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = args::whole::<u32>(1..=u32::MAX))]
    repetition: u32,
    #[command(flatten)]
    which: WhichArgs,
}

impl Subcommand for LogcatArgs {
    /// Follows or reads the log, and prints its faults.
    fn run(&self) -> anyhow::Result<()> {
        match &self.file {
            Some(file) => saved(self, file),
            None => live(self),
        }
    }
}

fn saved(args: &LogcatArgs, file: &Path) -> anyhow::Result<()> {
    let given = &args.which;
    ensure!(
        given.serials.is_empty() && !given.all && given.source.adb.is_none(),
        "a saved log needs no device: leave --serial, --all and --adb out"
    );
    let is_stdin = file == Path::new("-");
    let failed = |source| FileError::Read { path: file.into(), source };
    let mut input: Box<dyn BufRead> = if is_stdin {
        Box::new(io::stdin().lock())
    } else {
        // A pipe such as /dev/fd/63 is accepted like a file.
        ensure!(!file.is_dir(), FileError::IsFolder { path: file.into() });
        let missing = |error: &io::Error| error.kind() == io::ErrorKind::NotFound;
        Box::new(BufReader::new(File::open(file).map_err(|source| {
            if missing(&source) { FileError::Missing { path: file.into() } } else { failed(source) }
        })?))
    };
    let began = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default().as_secs_f64();
    let device = DeviceInfo { serial: UNKNOWN.into(), ..DeviceInfo::default() };
    let mut table = Table::new(args.out.as_deref(), args, device, began, None)?;
    let mut line = Vec::new();
    while !interrupt::requested() && input.read_until(b'\n', &mut line).map_err(failed)? > 0 {
        table.line(&line, None)?;
        line.clear();
    }
    if !table.reading.has_read() {
        bail!(
            "{} has no line of the tags YORO and VrApi: save it by adb logcat -v threadtime -v epoch",
            file.display()
        );
    }
    table.finish()
}

fn live(args: &LogcatArgs) -> anyhow::Result<()> {
    let devices = args.which.choose()?;
    let [device] = &devices[..] else {
        let serials = devices.iter().map(|device| device.serial().to_owned()).collect();
        return Err(DeviceError::Several(serials)).context("one log at a time");
    };
    let info = phone::info(device)?;
    let began = now();
    let out = args.out.clone().unwrap_or_else(|| {
        let time = SystemTime::UNIX_EPOCH + Duration::from_secs(began as u64);
        let time = humantime::format_rfc3339_seconds(time).to_string();
        PathBuf::from(format!("out/logcat-{}", time.replace([':', '-', 'Z'], "").replace('T', "-")))
    });
    let version = phone::version(device, phone::PACKAGE)?;
    let mut follower = Follower::new(device, args.from_oldest)?;
    let mut table = Table::new(Some(&out), args, info, began, version)?;
    let done = follow(args, device, &mut follower, &mut table, began);
    // The capture records why it ended.
    table.finish()?;
    done
}

fn follow(
    args: &LogcatArgs,
    device: &Device,
    follower: &mut Follower,
    table: &mut Table<'_>,
    began: f64,
) -> anyhow::Result<()> {
    let mut last = began;
    while !interrupt::requested()
        && args.seconds.is_none_or(|seconds| now() - began < f64::from(seconds))
    {
        match follower.next(Duration::from_secs(1))? {
            Event::Line(line) => {
                let now = now();
                table.line(&line, Some(now - last))?;
                last = now;
            }
            Event::Lost => eprintln!("{} is lost: connect it again, or stop with Ctrl-C", device.serial()),
            Event::Back { seconds, rebooted } => {
                let what = if rebooted { "was started anew" } else { "is back" };
                eprintln!("{} {what} after {seconds:.0} s", device.serial());
                table.back(seconds, rebooted)?;
            }
            Event::Quiet => {}
        }
    }
    Ok(())
}

/// Prints the samples of a log, and writes them if a folder is given.
struct Table<'a> {
    args: &'a LogcatArgs,
    reading: Reading,
    writer: Option<Writer>,
    own_faults: Vec<Fault>,
    rows: u64,
    is_terminal: bool,
    simulated: bool,
    named: Option<(String, String)>,
}

impl<'a> Table<'a> {
    fn new(
        out: Option<&Path>,
        args: &'a LogcatArgs,
        device: DeviceInfo,
        started_unix_s: f64,
        application: Option<String>,
    ) -> anyhow::Result<Table<'a>> {
        let info = RunInfo {
            version: VERSION,
            device,
            experiment: None,
            method: UNKNOWN.into(),
            scene: UNKNOWN.into(),
            repetition: args.repetition,
            order: 1,
            settings: BTreeMap::new(),
            started_unix_s,
            duration_s: 0.0,
            warm_up_s: 0.0,
            start_celsius: None,
            application,
            outcome: Outcome::Complete,
            faults: Vec::new(),
        };
        let writer = out.map(|folder| Writer::create(folder, info)).transpose()?;
        let is_terminal = io::stdout().is_terminal();
        Ok(Table {
            args,
            reading: Reading::new(None),
            writer,
            own_faults: Vec::new(),
            rows: 0,
            is_terminal,
            simulated: false,
            named: None,
        })
    }

    fn line(&mut self, line: &[u8], passed_s: Option<f64>) -> anyhow::Result<()> {
        if let Some(writer) = &mut self.writer {
            writer.log(line)?;
        }
        let line = &*log::text(line);
        if line.starts_with(SIMULATED_MARK) && !self.simulated {
            self.simulated = true;
            println!("SIMULATED: {}", line.trim_matches(['-', ' ']));
        }
        match self.reading.line(line, passed_s) {
            LineContent::Sample(sample) => self.sample(*sample)?,
            LineContent::Damaged(why) => {
                let text: String = line.chars().take(60).collect();
                println!("{}", message::one_line(&format!("damaged line ({why}): {text}...")));
            }
            LineContent::Summary | LineContent::Other => {}
        }
        Ok(())
    }

    fn sample(&mut self, sample: Sample) -> anyhow::Result<()> {
        if let Some(writer) = &mut self.writer {
            writer.sample(&sample)?;
        }
        self.row(&sample);
        Ok(())
    }

    fn row(&mut self, sample: &Sample) {
        let head = [
            "TIME", "FPS", "STALE", "FRAME ms", "P99 ms", "GPU ms", "CPU %", "RSS MB", "mA", "W", "LEVEL %",
            "BATT C", "SKIN C", "PLUG", "THERMAL",
        ];
        let named = self.reading.methods().last().cloned();
        let is_other = named != self.named;
        if is_other {
            if let Some((method, scene)) = &named {
                println!("{method} in {scene}");
            }
            self.named = named;
        }
        if self.rows == 0 || is_other || self.is_terminal && self.rows.is_multiple_of(ROWS) {
            println!("{}", cells(head.map(str::to_owned)));
        }
        self.rows += 1;
        let real =
            |value: Option<f64>, decimals: usize| value.map_or("na".into(), |v| format!("{v:.decimals$}"));
        let whole = |value: Option<i32>| value.map_or("na".into(), |v| v.to_string());
        let rate = match (sample.fps, sample.refresh_hz) {
            (Some(fps), Some(hz)) => format!("{fps:.1}/{hz:.0}"),
            (fps, _) => real(fps, 1),
        };
        let watts = sample.current_ma.zip(sample.voltage_mv).map(|(ma, mv)| -ma * mv / 1e6);
        let row = cells([
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
        ]);
        println!("{row}");
    }

    fn back(&mut self, seconds: f64, rebooted: bool) -> anyhow::Result<()> {
        self.own_faults.extend(faults_of_loss(self.reading.time_s(), seconds, rebooted));
        let faults = self.own_faults.clone();
        if let Some(writer) = &mut self.writer {
            writer.change(|info| info.faults = faults)?;
        }
        Ok(())
    }

    fn finish(mut self) -> anyhow::Result<()> {
        if let Some(last) = self.reading.end() {
            self.sample(last)?;
        }
        let own = self.own_faults.iter().cloned();
        let faults: Vec<Fault> = own.chain(self.reading.faults()).collect();
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
        let method = self.args.method.as_deref().unwrap_or(method);
        let scene = self.args.scene.as_deref().unwrap_or(scene);
        writer.change(|info| {
            (info.method, info.scene) = (method.into(), scene.into());
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
