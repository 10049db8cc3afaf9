//! What is shown of each suite, a file for each experiment: figures with the paper's curves beside ours, and tables.

mod anti_aliasing;
mod bandwidth;
mod cells;
mod complexity;
mod distance;
mod dots;
mod few_lights;
mod flicker;
mod frame_time;
mod imbuffer;
mod ipd;
mod other;
mod overhead;
mod patchers;
mod quality;
mod resolution;
mod section;
mod styles;
mod sweeps;
mod tables;

use crate::report::bench::data::Suite;

pub use section::Section;

type MakeSection = fn(&Suite) -> Section;

/// Suites by name in the paper's order, with what makes their sections. One suite can have several: the paper
/// looks at frame time, quality and overhead of the same eight scenes in three places.
const ORDER: [(&str, MakeSection); 14] = [
    ("scenes", frame_time::section),
    ("complexity", complexity::section),
    ("scenes", quality::section),
    ("scenes", overhead::section),
    ("lights", few_lights::section),
    ("styles", styles::section),
    ("ipd", ipd::section),
    ("distance", distance::section),
    ("patchers", patchers::section),
    ("imbuffer", imbuffer::section),
    ("resolution", resolution::section),
    ("anti-aliasing", anti_aliasing::section),
    ("flicker", flicker::section),
    ("bandwidth", bandwidth::section),
];

/// The sections of all suites in the paper's order, each with its suite; suites of other names come last.
pub fn sections(suites: &[Suite]) -> Vec<(&Suite, Section)> {
    let mut sections = Vec::new();
    for (name, make) in ORDER {
        sections.extend(suites.iter().filter(|suite| suite.name == name).map(|suite| (suite, make(suite))));
    }
    let known = |suite: &&Suite| ORDER.iter().any(|(name, _)| *name == suite.name);
    sections.extend(suites.iter().filter(|suite| !known(suite)).map(|suite| (suite, other::section(suite))));
    sections.retain(|(_, section)| !section.figures.is_empty() || !section.tables.is_empty());
    // The same experiment on another machine needs another anchor.
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
