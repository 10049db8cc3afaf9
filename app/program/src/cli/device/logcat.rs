//! `yoro device logcat`.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::SystemTime;

use anyhow::ensure;

use crate::cli::Subcommand;
use crate::cli::args;
use crate::cli::message;
use yoro_devices::capture::{DeviceInfo, Outcome, RunInfo, VERSION, Writer};
use yoro_devices::log::{self, SIMULATED_MARK};
use yoro_devices::reading::{LineContent, Reading};

/// The names of method and scene in a capture if the log has several, or none.
const SEVERAL: &str = "several";
const UNKNOWN: &str = "unknown";

/// Make a capture of a saved log, as a run leaves it
#[derive(clap::Args, Clone, Debug)]
pub struct LogcatArgs {
    /// The log, as adb logcat -v threadtime -v epoch prints it; - for standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// New folder for the capture
    #[arg(long, default_value = "out/log", value_name = "FOLDER")]
    out: PathBuf,
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
    /// Reads the log into a capture, and prints what is wrong with it.
    fn run(&self) -> anyhow::Result<()> {
        let bytes = args::read_log(&self.file)?;
        let (mut reading, mut samples, mut is_simulated) = (Reading::new(None), Vec::new(), false);
        for line in bytes.split_inclusive(|byte| *byte == b'\n') {
            let text = &*log::text(line);
            is_simulated |= text.starts_with(SIMULATED_MARK);
            match reading.line(text, None) {
                LineContent::Sample(sample) => samples.push(sample),
                LineContent::Damaged(why) => {
                    let text: String = text.chars().take(60).collect();
                    println!("{}", message::one_line(&format!("damaged line ({why}): {text}...")));
                }
                LineContent::Summary | LineContent::Other => {}
            }
        }
        ensure!(
            reading.has_read(),
            "{} has no line of the tag YORO: save it by adb logcat -v threadtime -v epoch",
            self.file.display()
        );
        let faults = reading.faults();
        for fault in &faults {
            let at = fault.at_s.map_or(String::new(), |at_s| format!(" (from {at_s:.0} s)"));
            println!("fault: {}{at}", fault.detail);
        }
        let (method, scene) = match reading.methods() {
            [] => (UNKNOWN, UNKNOWN),
            [(method, scene)] => (method.as_str(), scene.as_str()),
            _ => (SEVERAL, SEVERAL),
        };
        let (method, scene) =
            (self.method.as_deref().unwrap_or(method), self.scene.as_deref().unwrap_or(scene));
        let began = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        let info = RunInfo {
            version: VERSION,
            device: DeviceInfo { serial: UNKNOWN.into(), simulated: is_simulated, ..DeviceInfo::default() },
            experiment: None,
            method: method.into(),
            scene: scene.into(),
            repetition: self.repetition,
            order: 1,
            settings: BTreeMap::new(),
            started_unix_s: began.as_secs_f64(),
            duration_s: reading.time_s(),
            warm_up_s: 0.0,
            start_celsius: None,
            application: None,
            outcome: Outcome::Complete,
            faults,
        };
        let mut writer = Writer::create(&self.out, info)?;
        writer.log(&bytes)?;
        samples.iter().try_for_each(|sample| writer.sample(sample))?;
        writer.finish(Outcome::Complete)?;
        let simulated = if is_simulated { "SIMULATED: " } else { "" };
        println!(
            "{simulated}{method} in {scene}: {} samples, {} damaged lines, captured into {}",
            reading.samples(),
            reading.damaged(),
            self.out.display()
        );
        Ok(())
    }
}
