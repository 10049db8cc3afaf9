//! Cost and quality over the resolution.

use super::section::Section;
use super::sweeps::{quality_sweep, time_sweep};
use crate::report::bench::data::Suite;
use yoro_figures::plot::Axis;

/// The section of the suite `resolution`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "resolution",
        "Resolution",
        "Cost and quality against the width of each eye's image. The paper measured at its devices' own resolution \
         only.",
    );
    let x = Axis::new("width of an eye, pixels");
    time_sweep(&mut section, suite, x.clone(), |point| format!("{point}"));
    quality_sweep(&mut section, suite, &x, |_| Vec::new(), |point| format!("{point}"));
    section
}
