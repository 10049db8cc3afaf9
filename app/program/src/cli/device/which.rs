//! Choosing devices, and working on all of them at the same time.

use std::path::{Path, PathBuf};
use std::thread;

use anyhow::bail;
use indicatif::{MultiProgress, ProgressBar, ProgressStyle};

use yoro_devices::adb::{Adb, Device, DeviceError};
use yoro_files::interrupt;

use crate::cli::message;

/// The source of devices.
#[derive(clap::Args, Clone, Debug)]
pub struct SourceArgs {
    /// The program adb [default: the one in PATH, or below ANDROID_HOME or ANDROID_SDK_ROOT]
    #[arg(long, value_name = "FILE")]
    pub adb: Option<PathBuf>,
}

impl SourceArgs {
    /// Opens the source of devices.
    pub fn open(&self) -> Result<Adb, DeviceError> {
        Adb::find(self.adb.as_deref())
    }
}

/// The choice of devices.
#[derive(clap::Args, Clone, Debug)]
pub struct WhichArgs {
    /// The device, as `yoro device list` names it; more than once for several [default: the only one]
    #[arg(long = "serial", value_name = "SERIAL")]
    pub serials: Vec<String>,
    /// All devices
    #[arg(long, conflicts_with = "serials")]
    pub all: bool,
    #[command(flatten)]
    pub source: SourceArgs,
}

impl WhichArgs {
    /// Returns the chosen devices.
    ///
    /// # Errors
    /// [`DeviceError`] if there is no device, or if there are several and none was named.
    pub fn choose(&self) -> Result<Vec<Device>, DeviceError> {
        self.source.open()?.choose(&self.serials, self.all)
    }
}

/// Runs `work` on all devices at the same time, each with its own progress bar, and prints the results. The error
/// contains the failures of all devices.
pub fn each<F>(devices: Vec<Device>, work: F) -> anyhow::Result<()>
where
    F: Fn(&Device, &ProgressBar) -> anyhow::Result<String> + Sync,
{
    let bars = MultiProgress::new();
    let style = ProgressStyle::with_template("{prefix}  {bar:20} {pos}/{len} s  {wide_msg}");
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    let count = devices.len();
    let mut failures = Vec::new();
    thread::scope(|scope| {
        let begin = |device: Device| {
            let serial = device.serial.clone();
            let bar = bars.add(ProgressBar::new(0).with_style(style.clone()).with_prefix(serial.clone()));
            let work = &work;
            let thread = scope.spawn(move || {
                let done = work(&device, &bar);
                bar.finish_and_clear();
                done
            });
            (serial, thread)
        };
        let threads: Vec<_> = devices.into_iter().map(begin).collect();
        for (serial, thread) in threads {
            match thread.join() {
                Ok(Ok(text)) => println!("{serial}: {text}"),
                Ok(Err(error)) => failures.push((serial, error)),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
    });
    match (&mut failures[..], count) {
        ([], _) => Ok(()),
        (_, 1) => Err(failures.remove(0).1),
        _ if interrupt::requested() => Err(DeviceError::Interrupted.into()),
        (failures, count) => {
            // Most of the messages name their device.
            let all: Vec<String> = failures.iter().map(|(_, error)| message::sentence(error)).collect();
            bail!("{} of {count} devices: {}", failures.len(), all.join("; "))
        }
    }
}

/// Returns the folder for the output of one device, which is `out` itself if there is only one device.
pub fn folder_of(out: &Path, serial: &str, is_only: bool) -> PathBuf {
    if is_only { out.into() } else { out.join(yoro_devices::experiment::file_name(serial)) }
}
