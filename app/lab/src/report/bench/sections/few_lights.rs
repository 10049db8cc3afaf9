//! Frame time with few lights.

use super::cells::CONVENTIONAL;
use super::dots::{papers_mark, scene_dots};
use super::section::Section;
use super::tables::{scene_table, time_details};
use crate::bench::record::metric;
use crate::report::bench::data::{Suite, geometric_mean};
use yoro_figures::paper;
use yoro_figures::plot::{Axis, DotRow, Mark, Panel};
use yoro_figures::text::fixed;

/// The section of the suite `lights`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "few-lights",
        "Few lights",
        "The paper's setting for single-pass instancing: fewer than five lights, basic post-processing. It gives \
         means over scenes and devices only.",
    );
    let contenders = suite.measured(metric::FRAME_MS);
    let others: Vec<&str> = contenders.iter().copied().filter(|name| *name != CONVENTIONAL).collect();
    let conventional_fps = paper::FEW_LIGHTS[1].1;
    let mut panel = scene_dots(
        suite,
        Axis::new("frame time / conventional").baseline(1.0),
        &others,
        |setting, name| setting.cost(name).map(|cost| cost.median),
        |_| Vec::new(),
    );
    if let Panel::Dots { rows, .. } = &mut panel {
        let papers = paper::FEW_LIGHTS.iter().filter(|(method, ..)| *method != CONVENTIONAL);
        let papers = papers.map(|(method, fps, _)| papers_mark(method, conventional_fps / fps));
        let ours = others.iter().rev().filter_map(|name| {
            let costs =
                suite.settings.iter().filter_map(|setting| Some(setting.cost(name)?.median)).collect();
            let value = geometric_mean(costs)?;
            Some(Mark::new(*name, *name, value))
        });
        let marks = papers.chain(ours).collect();
        rows.push(DotRow { label: "mean".into(), marks });
    }
    section.figure("ratio", "Frame time over two full renders", "The line is conventional rendering.", panel);
    section.table(scene_table(
        suite,
        "Frame time over two full renders",
        &contenders,
        |setting, name| fixed(setting.cost(name).map(|cost| cost.median), 2),
        |name| {
            let costs =
                suite.settings.iter().filter_map(|setting| Some(setting.cost(name)?.median)).collect();
            fixed(geometric_mean(costs), 2)
        },
        (
            "the paper's means",
            |_| None,
            Some(
                paper::FEW_LIGHTS
                    .map(|(method, fps, _)| {
                        format!("{} {:.2}", paper::system(method), conventional_fps / fps)
                    })
                    .join(", "),
            ),
        ),
    ));
    section.table(time_details(suite, "Frame times in full", |_, _| None));
    section
}
