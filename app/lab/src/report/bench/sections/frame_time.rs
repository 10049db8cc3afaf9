//! Frame time.

use super::cells::{CONVENTIONAL, milliseconds, paper_scene};
use super::dots::{papers_mark, scene_dots};
use super::section::Section;
use super::tables::{scene_table, time_details};
use crate::bench::record::metric;
use crate::report::bench::data::{SettingData, Suite, geometric_mean};
use yoro_figures::paper;
use yoro_figures::plot::{Axis, DotRow, Panel};
use yoro_figures::text::fixed;

fn paper_ratios(setting: &SettingData) -> Vec<(&'static str, f64)> {
    paper_scene(setting).map_or_else(Vec::new, |scene| {
        vec![("yoro-paper", scene.frame_time_ratio()), ("hybrid", scene.fps_conventional / scene.fps_fink)]
    })
}

/// The section on frame times of the suite `scenes`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "frame-time",
        "Frame time",
        "A whole stereo frame by every method, on scenes that stand for the paper's eight. The paper measured \
         frame rates of its own scenes on six phones and a Quest 2; ratios can be held against each other, times \
         cannot.",
    );
    let contenders = suite.measured(metric::FRAME_MS);
    section.figure(
        "ratio",
        "Frame time over two full renders",
        "Less is better; the line is conventional rendering. The paper's from its frame rates (Figure “frame rate”).",
        scene_dots(
            suite,
            Axis::new("frame time / conventional").baseline(1.0),
            &contenders.iter().copied().filter(|name| *name != CONVENTIONAL).collect::<Vec<_>>(),
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
        |name| {
            let costs =
                suite.settings.iter().filter_map(|setting| Some(setting.cost(name)?.median)).collect();
            fixed(geometric_mean(costs), 2)
        },
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
