//! The report's sections, one file per experiment: plots with the paper's curves beside ours, and tables.

mod cells;
mod complexity;
mod flicker;
mod foveation;
mod frame_time;
mod labels;
mod other;
mod overhead;
mod patchers;
mod quality;
mod stream;
mod sweeps;
mod tables;

use crate::bench;
use crate::report::bench::data::Suite;
use yoro_report::Section;

pub use cells::{CONVENTIONAL, MONO};

type MakeSection = fn(&Suite) -> Section;

/// The suites in the paper's order, with the functions that make their sections. A suite can have several, because the
/// paper treats frame time, quality and overhead of the same eight scenes in three places.
const ORDER: [(bench::Suite, MakeSection); 15] = [
    (bench::Suite::Scenes, frame_time::section),
    (bench::Suite::Complexity, complexity::section),
    (bench::Suite::Scenes, quality::section),
    (bench::Suite::Scenes, overhead::section),
    (bench::Suite::Lights, frame_time::few_lights),
    (bench::Suite::Styles, labels::styles),
    (bench::Suite::Ipd, sweeps::ipd),
    (bench::Suite::Distance, sweeps::distance),
    (bench::Suite::Patchers, patchers::section),
    (bench::Suite::Imbuffer, sweeps::imbuffer),
    (bench::Suite::Resolution, sweeps::resolution),
    (bench::Suite::AntiAliasing, labels::anti_aliasing),
    (bench::Suite::Flicker, flicker::section),
    (bench::Suite::Foveation, foveation::section),
    (bench::Suite::Stream, stream::section),
];

/// Returns the sections of all suites in the paper's order, each with its suite. Suites with other names come last.
pub fn sections(suites: &[Suite]) -> Vec<(&Suite, Section)> {
    let mut sections = Vec::new();
    for (kind, make) in ORDER {
        let of_kind = suites.iter().filter(|suite| suite.name == kind.name());
        sections.extend(of_kind.map(|suite| (suite, make(suite))));
    }
    let is_known = |suite: &&Suite| ORDER.iter().any(|(kind, _)| kind.name() == suite.name);
    let others = suites.iter().filter(|suite| !is_known(suite));
    sections.extend(others.map(|suite| (suite, other::section(suite))));
    sections.retain(|(_, section)| !section.is_empty());
    sections
}
