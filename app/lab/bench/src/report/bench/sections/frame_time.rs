//! Frame time in all scenes and with few lights.

use super::cells::{CONVENTIONAL, milliseconds, paper_scene};
use super::dots::{papers_mark, scene_dots};
use super::section::Section;
use super::tables::{scene_table, time_details};
use crate::bench::record::metric;
use crate::report::bench::data::{SettingData, Suite};
use yoro_report::paper;
use yoro_report::plot::{Axis, DotRow, Mark, Panel};
use yoro_report::text::fixed;

fn paper_ratios(setting: &SettingData) -> Vec<(&'static str, f64)> {
    paper_scene(setting).map_or_else(Vec::new, |scene| {
        vec![("yoro-paper", scene.frame_time_ratio()), ("hybrid", scene.fps_conventional / scene.fps_fink)]
    })
}

/// Returns the section on frame times of the suite `scenes`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "frame-time",
        "Frame time",
        "A whole stereo frame by every method, on scenes that correspond to the paper's eight. The paper measured \
         frame rates of its own scenes on six phones and a Quest 2. Ratios can be compared, times cannot.",
    );
    let contenders = suite.measured(metric::FRAME_MS);
    section.figure(
        "ratio",
        "Frame time over two full renders",
        "Less is better; the line is conventional rendering. The paper's values come from its frame rates (Figure \
         “frame rate”).",
        scene_dots(
            suite,
            Axis::new("frame time / conventional").baseline(1.0),
            &suite.compared(metric::FRAME_MS),
            |setting, name| setting.cost(name).map(|cost| cost.median),
            paper_ratios,
        ),
    );
    section.figure(
        "ms",
        "Frame time here",
        "Medians on this machine.",
        scene_dots(
            suite,
            Axis::new("frame time, ms").logarithmic(),
            &contenders,
            |setting, name| setting.find(name)?.median(metric::FRAME_MS),
            |_| Vec::new(),
        ),
    );
    let rows = suite.settings.iter().filter_map(paper_scene).map(|scene| {
        let systems = [
            ("hybrid", scene.fps_fink),
            (CONVENTIONAL, scene.fps_conventional),
            ("yoro-paper", scene.fps_yoro),
        ];
        let mark = |(method, fps): (&str, f64)| papers_mark(method, 1000.0 / fps);
        DotRow { label: scene.name.into(), marks: systems.map(mark).to_vec() }
    });
    section.figure(
        "paper-ms",
        "The paper's frame time",
        "1000 / frames a second: means over its seven devices, on its own scenes.",
        Panel::Dots { value: Axis::new("frame time, ms").from_zero(), rows: rows.collect() },
    );
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
        (
            "the paper's YORO",
            |setting| {
                let scene = paper_scene(setting)?;
                Some(format!("{}: {:.2}", scene.name, scene.frame_time_ratio()))
            },
            Some(format!("{:.2}", paper::AVERAGE.frame_time_ratio())),
        ),
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
        "few-lights",
        "Few lights",
        "The paper's setting for single-pass instancing: fewer than five lights, basic post-processing. It gives means \
         over scenes and devices only.",
    );
    let contenders = suite.measured(metric::FRAME_MS);
    let others = suite.compared(metric::FRAME_MS);
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
        let ours = others.iter().rev();
        let ours = ours.filter_map(|name| Some(Mark::new(*name, *name, suite.mean_cost(name)?)));
        let marks = papers.chain(ours).collect();
        rows.push(DotRow { label: "mean".into(), marks });
    }
    section.figure("ratio", "Frame time over two full renders", "The line is conventional rendering.", panel);
    section.table(scene_table(
        suite,
        "Frame time over two full renders",
        &contenders,
        |setting, name| fixed(setting.cost(name).map(|cost| cost.median), 2),
        |name| fixed(suite.mean_cost(name), 2),
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
