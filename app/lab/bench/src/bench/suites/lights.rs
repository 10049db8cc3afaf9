//! Frame time with few lights

use super::super::contender::Contender;
use super::super::record::metric;
use super::super::results::{CONVENTIONAL, SettingData};
use super::super::tables::{PapersColumn, QUARTILES, cost_of, mark_scenes, scene_table, time_details};
use super::{COST, FrameSuite};
use yoro_report::paper::{self, PAPER};
use yoro_report::text::fixed;
use yoro_report::{Axis, Plot, Section};

/// The number of lights: the paper has fewer than five.
const FEW_LIGHTS: usize = 4;

pub(super) const LIGHTS: FrameSuite = FrameSuite {
    name: "lights",
    about: "Frame time of every method with four lights: the paper's setting for single-pass instancing",
    measures: COST,
    contenders: Contender::methods,
    jobs: |suite, choices, _| {
        choices.sweep(suite, choices.all_scenes(), [FEW_LIGHTS], |job, lights| {
            job.render.point_lights = lights;
            job.conditions.point = Some(lights as f64);
        })
    },
    sections: |suite| {
        let mut section = Section::new(
            "Few lights",
            "The paper's setting for single-pass instancing: fewer than five lights, basic post-processing. It gives means \
             over scenes and devices only.",
        );
        let cost = |setting: &SettingData, name: &str| setting.cost(name).map(|cost| cost.median);
        let title = "Frame time over two full renders";
        let plot = Plot::rows(title, Axis::new("frame time / conventional").baseline(1.0))
            .caption("The line is conventional rendering.");
        section.plot(mark_scenes(plot, suite, &suite.compared(metric::FRAME_MS), cost, |_| Vec::new()));
        let base = PAPER.few_lights[CONVENTIONAL];
        let means =
            PAPER.few_lights.iter().map(|(name, fps)| format!("{} {:.2}", paper::system(name), base / fps));
        let column = PapersColumn {
            title: "the paper's means",
            of_scene: |_| None,
            mean: Some(means.collect::<Vec<_>>().join(", ")),
        };
        let contenders = suite.measured(metric::FRAME_MS);
        let mean = |name: &str| fixed(suite.mean_cost(name), 2);
        let mut table = scene_table(suite, title, &contenders, cost_of, mean, Some(column));
        table.note = QUARTILES.into();
        section.table(table);
        section.table(time_details(suite, |_, _| None));
        vec![section]
    },
};
