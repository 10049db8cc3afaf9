//! Frame time in all scenes and with few lights.

use super::cells::{CONVENTIONAL, milliseconds, paper_scene, papers, scene_plot};
use super::tables::{PaperColumn, scene_table, time_details};
use crate::bench::record::metric;
use crate::report::bench::data::{SettingData, Suite};
use yoro_report::paper::{self, PAPER};
use yoro_report::text::fixed;
use yoro_report::{Axis, Entry, Plot, Section};

fn paper_ratios(setting: &SettingData) -> Vec<(&'static str, f64)> {
    paper_scene(setting).map_or_else(Vec::new, |scene| {
        vec![("yoro-paper", scene.frame_time_ratio()), ("hybrid", scene.fps[1] / scene.fps[2])]
    })
}

/// Returns the section on frame times of the suite `scenes`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "Frame time",
        "A whole stereo frame by every method, on scenes that correspond to the paper's eight. The paper measured \
         frame rates of its own scenes on six phones and a Quest 2. Ratios can be compared, times cannot.",
    );
    let contenders = suite.measured(metric::FRAME_MS);
    let plot = scene_plot(
        suite,
        "Frame time over two full renders",
        Axis::new("frame time / conventional").baseline(1.0),
        &suite.compared(metric::FRAME_MS),
        |setting, name| setting.cost(name).map(|cost| cost.median),
        paper_ratios,
    );
    section.plot(plot.caption(
        "Less is better; the line is conventional rendering. The paper's values come from its frame rates (Figure \
         “frame rate”).",
    ));
    let plot = scene_plot(
        suite,
        "Frame time here",
        Axis::new("frame time, ms").logarithmic(),
        &contenders,
        |setting, name| setting.find(name)?.median(metric::FRAME_MS),
        |_| Vec::new(),
    );
    section.plot(plot.caption("Medians on this machine."));
    let plot = Plot::rows("The paper's frame time", Axis::new("frame time, ms").from_zero());
    let mut plot = plot.caption("1000 / frames a second: means over its seven devices, on its own scenes.");
    for scene in suite.settings.iter().filter_map(paper_scene) {
        for (method, fps) in paper::SYSTEMS.iter().zip(scene.fps) {
            plot.mark(&scene.name, papers(method), 1000.0 / fps);
        }
    }
    section.plot(plot);
    section.table(scene_table(
        suite,
        "Frame time over two full renders",
        &contenders,
        |setting, name| {
            let median = setting.cost(name)?.median;
            if name == CONVENTIONAL {
                let ms = setting.conventional()?.median(metric::FRAME_MS)?;
                return Some(format!("{} ms", milliseconds(ms)));
            }
            Some(format!("{median:.2}"))
        },
        |name| fixed(suite.mean_cost(name), 2),
        Some(PaperColumn {
            head: "the paper's YORO",
            text: &|setting| {
                let scene = paper_scene(setting)?;
                Some(format!("{}: {:.2}", scene.name, scene.frame_time_ratio()))
            },
            mean: format!("{:.2}", PAPER.average.frame_time_ratio()),
        }),
    ));
    let papers = |setting: &SettingData, name: &str| {
        paper_ratios(setting).into_iter().find(|(method, _)| *method == name).map(|(_, ratio)| ratio)
    };
    section.table(time_details(suite, "Frame times in full", papers));
    section
}

/// Returns the section of the suite `lights`.
pub fn few_lights(suite: &Suite) -> Section {
    let mut section = Section::new(
        "Few lights",
        "The paper's setting for single-pass instancing: fewer than five lights, basic post-processing. It gives means \
         over scenes and devices only.",
    );
    let contenders = suite.measured(metric::FRAME_MS);
    let others = suite.compared(metric::FRAME_MS);
    let fps = &PAPER.few_lights;
    let paper_ratio = |method: &str| fps[CONVENTIONAL] / fps[method];
    let mut plot = scene_plot(
        suite,
        "Frame time over two full renders",
        Axis::new("frame time / conventional").baseline(1.0),
        &others,
        |setting, name| setting.cost(name).map(|cost| cost.median),
        |_| Vec::new(),
    );
    for name in others {
        plot.mark("mean", Entry::ours(name), suite.mean_cost(name).unwrap_or(f64::NAN));
    }
    for method in fps.keys().filter(|method| *method != CONVENTIONAL) {
        plot.mark("mean", papers(method), paper_ratio(method));
    }
    section.plot(plot.caption("The line is conventional rendering."));
    let paper_means =
        fps.keys().map(|method| format!("{} {:.2}", paper::system(method), paper_ratio(method)));
    section.table(scene_table(
        suite,
        "Frame time over two full renders",
        &contenders,
        |setting, name| fixed(setting.cost(name).map(|cost| cost.median), 2),
        |name| fixed(suite.mean_cost(name), 2),
        Some(PaperColumn {
            head: "the paper's means",
            text: &|_| None,
            mean: paper_means.collect::<Vec<_>>().join(", "),
        }),
    ));
    section.table(time_details(suite, "Frame times in full", |_, _| None));
    section
}
