//! `yoro device report`: turns captures into a page and tables.

use std::collections::BTreeMap;
use std::path::PathBuf;

use anyhow::ensure;

use crate::cli::Subcommand;
use crate::cli::machine;
use yoro_devices::capture;
use yoro_devices::report::DeviceReport;
use yoro_files as files;

/// Figures of captures: power, frame rate, temperature and the rest, each method against the baseline
#[derive(clap::Args, Clone, Debug)]
pub struct ReportArgs {
    /// Folders with captures, at any depth; the same repetition in another folder counts as another one
    #[arg(required = true, value_name = "FOLDER")]
    folders: Vec<PathBuf>,
    /// The method that the others are compared with
    #[arg(long, default_value = "conventional", value_name = "METHOD")]
    baseline: String,
    /// Number of battery cells of a device that reports the current of one cell; its power is multiplied by this.
    /// More than once for several devices
    #[arg(long = "cells", value_name = "SERIAL=N", value_parser = parse_cells)]
    cells: Vec<(String, u32)>,
    /// Folder for report.html, report.md and report.json
    #[arg(long, default_value = "out/device", value_name = "FOLDER")]
    out: PathBuf,
}

impl Subcommand for ReportArgs {
    /// Reads the captures, writes the report and prints the main figures.
    fn run(&self) -> anyhow::Result<()> {
        let mut sets = Vec::new();
        for folder in &self.folders {
            let mut captures = Vec::new();
            for run in capture::find(std::slice::from_ref(folder))? {
                let capture = capture::read(&run)?;
                captures.push((run, capture));
            }
            sets.push(captures);
        }
        let cells: BTreeMap<String, u32> = self.cells.iter().cloned().collect();
        for serial in cells.keys() {
            let is_known = sets.iter().flatten().any(|(_, capture)| capture.info.device.serial == *serial);
            ensure!(
                is_known,
                "there is no capture of a device {serial}: run.json names each device's serial number"
            );
        }
        files::create_folder(&self.out)?;
        let report = DeviceReport::new(&sets, &self.baseline, &cells, machine::made_by());
        let written = report.write(&self.out)?;
        print!("{}{written}", report.to_text());
        Ok(())
    }
}

fn parse_cells(text: &str) -> Result<(String, u32), String> {
    let pair =
        text.rsplit_once('=').and_then(|(serial, cells)| Some((serial.to_owned(), cells.parse().ok()?)));
    pair.filter(|(_, cells)| (1..=4).contains(cells)).ok_or_else(|| "give SERIAL=N with 1 to 4 cells".into())
}
