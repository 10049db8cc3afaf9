//! `yoro device farm`.

use std::path::{Path, PathBuf};

use anyhow::ensure;

use crate::cli::Subcommand;
use crate::cli::args;
use yoro_devices::capture::{FaultKind, Outcome};
use yoro_devices::farm;

/// Measure on the devices of a farm: print the command that starts the scenarios, or read its results
#[derive(clap::Args, Clone, Debug)]
pub struct FarmArgs {
    /// Models of Firebase Test Lab, with =VERSION if it matters: prints the command of gcloud that starts them
    #[arg(required_unless_present = "read", conflicts_with = "read", value_name = "MODEL")]
    devices: Vec<String>,
    /// The release that is tested
    #[arg(long, default_value = "target/apk/yoro.apk", value_name = "FILE")]
    apk: String,
    /// Scenarios: 1 every pipeline, 2 a minute of each method, 3 ten minutes for heat
    #[arg(long, value_delimiter = ',', default_value = "1,2,3", value_name = "N,N",
          value_parser = args::whole::<u32>(1..=3))]
    scenarios: Vec<u32>,
    /// Read results: a folder with a folder for each device, of Firebase Test Lab or AWS Device Farm
    #[arg(long, value_name = "FOLDER")]
    read: Option<PathBuf>,
    /// Folder for the captures of --read
    #[arg(long, default_value = "out/farm", value_name = "FOLDER")]
    out: PathBuf,
}

impl Subcommand for FarmArgs {
    fn run(&self) -> anyhow::Result<()> {
        let Some(folder) = &self.read else {
            let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-=/".contains(c);
            for word in self.devices.iter().chain([&self.apk]) {
                ensure!(word.chars().all(is_plain), "{word} has characters that a shell reads: rename it");
            }
            println!("{}", farm::command(&self.apk, &self.scenarios, &self.devices));
            return Ok(());
        };
        let place = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let own = |path: &Path| path.canonicalize().unwrap_or_else(|_| place(path));
        ensure!(
            !own(&self.out).starts_with(own(folder)),
            "the captures would be written into {}, and read as results the next time: choose another folder with --out",
            folder.display()
        );
        for run in farm::read(folder, &self.out)? {
            let simulated = if run.device.simulated { "SIMULATED: " } else { "" };
            let end = match &run.outcome {
                Outcome::Complete => "complete",
                Outcome::Interrupted { reason } | Outcome::Failed { reason } => reason,
            };
            let wrong = run.faults.iter().find(|fault| fault.kind == FaultKind::Pictures);
            let wrong = wrong.map_or_else(String::new, |fault| format!("; WRONG PICTURES: {}", fault.detail));
            let is_plugged = run.faults.iter().any(|fault| fault.kind == FaultKind::PluggedIn);
            let power = if is_plugged { "; power na: on a charger" } else { "" };
            println!(
                "{simulated}{}: {} in {}: {:.0} s, {end}{power}{wrong}",
                run.device.serial, run.method, run.scene, run.duration_s
            );
        }
        println!("next: yoro device report {}", self.out.display());
        Ok(())
    }
}
