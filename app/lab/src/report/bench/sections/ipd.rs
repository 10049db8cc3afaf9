//! Quality over the distance between the eyes.

use super::section::Section;
use super::sweeps::quality_sweep;
use crate::bench::record::metric;
use crate::report::bench::data::Suite;
use yoro_figures::paper;
use yoro_figures::plot::Axis;

/// The section of the suite `ipd`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "ipd",
        "Distance between the eyes",
        "Quality of the synthesized eye against the interpupillary distance.",
    );
    let papers = |name: &str| -> Vec<(f64, f64)> {
        match name {
            metric::SSIM => paper::IPD.iter().map(|point| (point.0, point.1)).collect(),
            metric::PSNR => paper::IPD.iter().map(|point| (point.0, point.2)).collect(),
            _ => Vec::new(),
        }
    };
    quality_sweep(&mut section, suite, &Axis::new("IPD, mm"), papers, |point| format!("{point}"));
    section
}
