//! CPU time and memory.

use super::cells::{CONVENTIONAL, cell, paper_scene, scene_plot};
use super::tables::means_table;
use crate::bench::record::PassClock;
use crate::bench::record::metric;
use crate::report::bench::data::{SettingData, Suite};
use yoro_report::paper::{self, PaperScene};
use yoro_report::stats::{mean, unique};
use yoro_report::text::fixed;
use yoro_report::{Axis, Cell, Section, Table};

/// Returns the section on CPU time and memory of the suite `scenes`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "Overhead",
        "CPU time and memory of a stereo frame. The paper gives CPU load in percent and its applications' memory. \
         Power and temperature need a phone.",
    );
    let contenders = suite.measured(metric::CPU_MS);
    let others = suite.compared(metric::CPU_MS);
    let papers = |value: fn(&PaperScene) -> [f64; 3]| {
        move |setting: &SettingData| -> Vec<(&'static str, f64)> {
            let Some(scene) = paper_scene(setting) else { return Vec::new() };
            let values = value(scene);
            let ratios = paper::SYSTEMS.iter().zip(values).map(|(name, v)| (*name, v / values[1]));
            ratios.filter(|(name, _)| *name != CONVENTIONAL).collect()
        }
    };
    let plot = scene_plot(
        suite,
        "CPU time over two full renders",
        Axis::new("CPU time / conventional").baseline(1.0),
        &others,
        |setting, name| Some(setting.find(name)?.ratio(setting.conventional()?, metric::CPU_MS)?.median),
        papers(|o| o.cpu),
    );
    section.plot(plot.caption(
        "CPU time of a stereo frame over all threads, including rasterization if the CPU rasterizes. The paper's: CPU \
         load over conventional rendering's.",
    ));
    let plot = scene_plot(
        suite,
        "Memory over two full renders",
        Axis::new("memory / conventional"),
        &others,
        |setting, name| {
            let base = setting.conventional()?.mean(metric::MEMORY_MIB)?;
            Some(setting.find(name)?.mean(metric::MEMORY_MIB)? / base)
        },
        papers(|o| o.memory),
    );
    section.plot(plot.caption(
        "Memory of the process, with the scene and one method's textures. The paper's: memory of its applications over \
         conventional rendering's.",
    ));
    let columns = [
        ("CPU time, ms", metric::CPU_MS, 1),
        ("memory, MiB", metric::MEMORY_MIB, 1),
        ("textures of the method, MiB", metric::TEXTURE_MIB, 1),
        ("GPU time, ms", metric::GPU_MS, 3),
    ];
    section.table(means_table(suite, "Means over the scenes", &contenders, &columns));
    section.table(pass_table(suite));
    section
}

/// Returns a table of the passes' times, as medians over the scenes' medians.
fn pass_table(suite: &Suite) -> Table {
    let measured = suite.settings.iter().flat_map(|setting| &setting.contenders);
    let metrics = unique(measured.flat_map(|measured| measured.metrics()));
    let passes: Vec<&str> =
        metrics.into_iter().filter_map(|name| name.strip_prefix(metric::PASS_MS)).collect();
    let has_passes = |name: &&str| {
        passes.iter().any(|pass| !suite.values(name, |m| m.median(&pass_metric(pass))).is_empty())
    };
    let contenders: Vec<&str> = suite.contenders().into_iter().filter(has_passes).collect();
    let mut columns = vec!["<pass, ms".to_owned()];
    columns.extend(contenders.iter().map(|name| name.to_string()));
    let mut table = Table::new("Time of each pass, means over the scenes of the medians", &columns);
    for pass in &passes {
        let mut cells = vec![Cell::plain(*pass)];
        for name in &contenders {
            cells.push(cell(name, fixed(mean(suite.values(name, |m| m.median(&pass_metric(pass)))), 2)));
        }
        table.push(cells);
    }
    table.note = match suite.header.pass_clock {
        PassClock::TimerQueries => "GPU time by timer queries.".into(),
        PassClock::None => "Not told by this browser.".into(),
        PassClock::Finish => {
            "Wall clock with glFinish around each pass, on frames of their own: a CPU rasterizer's timer queries are \
             unusable."
                .into()
        }
    };
    table
}

fn pass_metric(pass: &str) -> String {
    format!("{}{pass}", metric::PASS_MS)
}
