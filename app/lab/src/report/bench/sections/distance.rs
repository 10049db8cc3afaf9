//! Quality over the distance of an object.

use super::section::Section;
use super::sweeps::quality_sweep;
use crate::report::bench::data::Suite;
use yoro_figures::paper;
use yoro_figures::plot::Axis;

/// The section of the suite `distance`.
pub fn section(suite: &Suite) -> Section {
    let (ssim, psnr) = paper::DISTANCE;
    let mut section = Section::new(
        "distance",
        "Distance of the object",
        &format!(
            "Quality against the distance of one irregular object, scaled so that it keeps its size on the screen. \
             The paper shows its curve as a picture only; its text says SSIM {ssim} and {psnr} dB for 0.5 to 3 m."
        ),
    );
    quality_sweep(&mut section, suite, &Axis::new("distance, m"), |_| Vec::new(), |point| format!("{point}"));
    section
}
