//! The report's sections, one file per experiment: figures with the paper's curves beside ours, and tables.

mod cells;
mod complexity;
mod dots;
mod flicker;
mod foveation;
mod frame_cost;
mod frame_time;
mod labels;
mod other;
mod overhead;
mod patchers;
mod quality;
mod section;
mod stream;
mod sweeps;
mod tables;

use crate::bench;
use crate::report::bench::data::Suite;

pub use cells::{CONVENTIONAL, MONO};
pub use section::Section;

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
    let frames = suites.iter().filter(|suite| suite.name == bench::FRAME_SUITE);
    sections.extend(frames.map(|suite| (suite, frame_cost::section(suite))));
    let known = |suite: &&Suite| {
        suite.name == bench::FRAME_SUITE || ORDER.iter().any(|(kind, _)| kind.name() == suite.name)
    };
    sections.extend(suites.iter().filter(|suite| !known(suite)).map(|suite| (suite, other::section(suite))));
    sections.retain(|(_, section)| !section.figures.is_empty() || !section.tables.is_empty());
    // The same experiment on another machine needs a different anchor.
    let mut seen: Vec<String> = Vec::new();
    for (_, section) in &mut sections {
        let before = seen.iter().filter(|id| **id == section.id).count();
        seen.push(section.id.clone());
        if before > 0 {
            let id = format!("{}-{}", section.id, before + 1);
            for figure in &mut section.figures {
                figure.id = figure.id.replacen(&section.id, &id, 1);
            }
            section.id = id;
        }
    }
    sections
}
