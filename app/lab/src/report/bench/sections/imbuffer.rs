//! The size of the paper's ImBuffer.

use super::section::Section;
use super::sweeps::{quality_sweep, time_sweep};
use crate::report::bench::data::Suite;
use yoro_figures::plot::Axis;

/// The section of the suite `imbuffer`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "imbuffer",
        "ImBuffer",
        "The paper's pipeline with a smaller ImBuffer: its width and height are the image's over the divisor, with \
         and without linear interpolation.",
    );
    let x = Axis::new("ImBuffer divisor").logarithmic();
    quality_sweep(&mut section, suite, &x, |_| Vec::new(), |point| format!("1/{point}"));
    time_sweep(&mut section, suite, x, |point| format!("1/{point}"));
    section
}
