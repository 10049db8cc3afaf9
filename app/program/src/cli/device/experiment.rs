//! `yoro device experiment`.

use std::path::{Path, PathBuf};

use anyhow::bail;

use super::which::{WhichArgs, each};
use crate::cli::Subcommand;
use yoro_devices::experiment::{self, Experiment, length, method_name};

/// Make the runs of an experiment: methods, scenes and repetitions in a balanced order, with pauses to cool down
#[derive(clap::Args, Clone, Debug)]
pub struct ExperimentArgs {
    /// The experiment, such as app/lab/devices/experiments/five-minutes.toml
    #[arg(value_name = "FILE.toml")]
    file: PathBuf,
    /// Folder of the captures. One that an interrupted experiment has left is continued
    /// [default: out/device/NAME]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Print the plan and its duration, without using devices
    #[arg(long)]
    dry_run: bool,
    /// Measure devices that are plugged in: everything except power
    #[arg(long)]
    plugged: bool,
    #[command(flatten)]
    which: WhichArgs,
}

impl Subcommand for ExperimentArgs {
    /// Makes the runs on each device.
    fn run(&self) -> anyhow::Result<()> {
        let mut experiment = Experiment::read(&self.file)?;
        experiment.power &= !self.plugged;
        if self.dry_run {
            print_plan(&experiment, &self.which.serials);
            return Ok(());
        }
        let devices = self.which.choose()?;
        let default = || Path::new("out/device").join(experiment::file_name(&experiment.name));
        let out = self.out.clone().unwrap_or_else(default);
        let _claim = experiment.claim(&out, &self.file)?;
        each(devices, |device, bar| {
            let progress = experiment::conduct(device, &experiment, &out, bar)?;
            if progress.failed.is_empty() {
                return Ok(progress.to_string());
            }
            let (folder, reason) = &progress.failed[0];
            bail!(
                "{}: {progress}, the first because {reason} ({}); the same command tries again",
                device.serial,
                folder.display()
            )
        })?;
        println!("captures: {}", out.display());
        println!("report:   yoro device report {}", out.display());
        Ok(())
    }
}

fn print_plan(experiment: &Experiment, serials: &[String]) {
    let any = [String::new()];
    for serial in if serials.is_empty() { &any } else { serials } {
        let plan = experiment.plan(serial);
        println!(
            "{:>4} {:>4}  {:<14} {:<16} {:<20} {:>8}",
            "RUN", "REP", "SCENE", "METHOD", "STEREO", "SECONDS"
        );
        for planned in &plan {
            let plan = &planned.plan;
            println!(
                "{:>4} {:>4}  {:<14} {:<16} {:<20} {:>8}",
                plan.order,
                plan.repetition,
                plan.settings.scene,
                plan.method,
                method_name(plan),
                plan.seconds()
            );
        }
        let [shortest, longest] = experiment.length(plan.len());
        let of = if serial.is_empty() { "a device" } else { serial.as_str() };
        println!(
            "{} runs on {of}: {} to {}, by how quickly it cools down",
            plan.len(),
            length(shortest),
            length(longest)
        );
    }
    if serials.is_empty() {
        println!("the order is another one on each device: give --serial to see it");
    }
}
