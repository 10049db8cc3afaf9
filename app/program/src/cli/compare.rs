//! `yoro compare`: the similarity of two images, or of the images of two folders.

use std::path::PathBuf;

use super::Subcommand;
use yoro_bench::compare::{CompareReport, Inputs};

/// Compare two images, or two folders of images, by PSNR, SSIM and FLIP
#[derive(clap::Args, Clone, Debug)]
pub struct CompareArgs {
    /// The image to judge, or a folder of them
    a: PathBuf,
    /// The reference, or a folder of references; pairs are files of the same relative path
    b: PathBuf,
    /// Also measure inside and outside of holes: a grey image, dark where there is a hole; or a folder of them
    #[arg(long, value_name = "FILE|FOLDER")]
    mask: Option<PathBuf>,
    /// The mask is bright, not dark, where there is a hole
    #[arg(long, requires = "mask")]
    bright_holes: bool,
    /// Write the error map, 1 - SSIM from 0 (black) to 1 (pale yellow), as PNG; a folder when folders are compared
    #[arg(long, value_name = "FILE|FOLDER")]
    map: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl CompareArgs {
    fn inputs(&self) -> Inputs {
        Inputs {
            a: self.a.clone(),
            b: self.b.clone(),
            mask: self.mask.clone(),
            bright_holes: self.bright_holes,
            map: self.map.clone(),
        }
    }
}

impl Subcommand for CompareArgs {
    /// Compares, prints, and writes error maps if requested.
    fn run(&self) -> anyhow::Result<()> {
        let report = CompareReport::of(&self.inputs())?;
        for path in &report.unmatched {
            log::warn!("{} has no partner and is left out", path.display());
        }
        let text = if self.json { serde_json::to_string_pretty(&report)? + "\n" } else { report.to_text() };
        print!("{text}");
        Ok(())
    }
}
