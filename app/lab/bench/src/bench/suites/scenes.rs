//! Frame time, overhead and quality on the eight scenes

use super::super::contender::Contender;
use super::super::record::{PassClock, metric};
use super::super::results::{CONVENTIONAL, SettingData, SuiteData};
use super::super::tables::{
    MetricColumn, PSNR_SSIM_FLIP, PapersColumn, QUALITY_PLOTS, QUARTILES, QualityPlot, cell, cost_of,
    mark_scenes, means_table, metric_table, paper_scene, psnr_ssim_flip, scene_table, table_of, time_details,
};
use super::{ALL, FrameSuite};
use yoro_report::paper::{PAPER, SYSTEMS};
use yoro_report::stats::{mean, unique};
use yoro_report::text::fixed;
use yoro_report::{Axis, Cell, Plot, Section, Table};

pub(super) const SCENES: FrameSuite = FrameSuite {
    name: "scenes",
    about: "Frame time and quality of every method on eight scenes",
    measures: ALL,
    contenders: Contender::methods,
    jobs: |suite, choices, _| choices.sweep(suite, choices.all_scenes(), [()], |_, ()| {}),
    // The paper treats frame time, quality and overhead of the same eight scenes in three places.
    sections: |suite| vec![frame_time(suite), quality(suite), overhead(suite)],
};

/// Returns the paper's values of its systems over that of conventional rendering.
fn over_conventional(values: [f64; 3]) -> Vec<(&'static str, f64)> {
    let ratios = SYSTEMS.into_iter().zip(values.map(|value| value / values[1]));
    ratios.filter(|(name, _)| *name != CONVENTIONAL).collect()
}

/// Returns the paper's frame times over that of conventional rendering.
fn papers_times(setting: &SettingData) -> Vec<(&'static str, f64)> {
    paper_scene(setting).map_or_else(Vec::new, |scene| over_conventional(scene.fps.map(f64::recip)))
}

fn frame_time(suite: &SuiteData) -> Section {
    let mut section = Section::new(
        "Frame time",
        "A whole stereo frame by every method, on scenes that correspond to the paper's eight. The paper measured \
         frame rates of its own scenes on six phones and a Quest 2. Ratios can be compared, times cannot.",
    );
    let contenders = suite.measured(metric::FRAME_MS);
    let title = "Frame time over two full renders";
    let plot = Plot::rows(title, Axis::new("frame time / conventional").baseline(1.0)).caption(
        "Less is better; the line is conventional rendering. The paper's values come from its frame rates (Figure “frame \
         rate”).",
    );
    let cost = |setting: &SettingData, name: &str| setting.cost(name).map(|cost| cost.median);
    section.plot(mark_scenes(plot, suite, &suite.compared(metric::FRAME_MS), cost, papers_times));
    let plot = Plot::rows("Frame time here", Axis::new("frame time, ms").logarithmic())
        .caption("Medians on this machine.");
    let median = |setting: &SettingData, name: &str| setting.find(name)?.median(metric::FRAME_MS);
    section.plot(mark_scenes(plot, suite, &contenders, median, |_| Vec::new()));
    let papers = PapersColumn {
        title: "the paper's YORO",
        of_scene: |setting| {
            let scene = paper_scene(setting)?;
            Some(format!("{}: {:.2}", scene.name, scene.frame_time_ratio()))
        },
        mean: Some(format!("{:.2}", PAPER.average.frame_time_ratio())),
    };
    let mean = |name: &str| fixed(suite.mean_cost(name), 2);
    let mut table = scene_table(suite, title, &contenders, cost_of, mean, Some(papers));
    table.note = QUARTILES.into();
    section.table(table);
    section.table(time_details(suite, |setting, name| {
        papers_times(setting).into_iter().find(|(method, _)| *method == name).map(|(_, ratio)| ratio)
    }));
    section
}

fn quality(suite: &SuiteData) -> Section {
    let mut section = Section::new(
        "Image quality",
        "The synthesized eye against a real render of the same eye. “mono” shows the dominant eye's image to both \
         eyes: the baseline for every other figure.",
    );
    // The ground truth needs no column for its similarity to itself.
    let contenders = suite.compared(metric::SSIM);
    // The paper's figures alone are not worth a section: browsers measure time only.
    if contenders.is_empty() {
        return section;
    }
    for QualityPlot { metric, axis, caption } in QUALITY_PLOTS {
        let papers = |setting: &SettingData| {
            let value = paper_scene(setting).and_then(|scene| match metric {
                metric::PSNR => Some(scene.psnr),
                metric::SSIM => Some(scene.ssim),
                _ => None,
            });
            value.map(|value| ("yoro-paper", value)).into_iter().collect()
        };
        let plot = Plot::rows(axis, Axis::new(axis)).caption(caption);
        let value = |setting: &SettingData, name: &str| setting.find(name)?.mean(metric);
        section.plot(mark_scenes(plot, suite, &suite.compared(metric), value, papers));
    }
    let papers = PapersColumn {
        title: "the paper's YORO",
        of_scene: |setting| {
            let scene = paper_scene(setting)?;
            Some(format!("{}: {:.2} / {:.4}", scene.name, scene.psnr, scene.ssim))
        },
        mean: Some(format!("{:.2} / {:.4}", PAPER.average.psnr, PAPER.average.ssim)),
    };
    let text = |setting: &SettingData, name: &str| {
        let measured = setting.find(name)?;
        psnr_ssim_flip(|metric| measured.mean(metric))
    };
    let mean_of = |name: &str| psnr_ssim_flip(|metric| suite.mean(name, metric));
    let mut table = scene_table(suite, PSNR_SSIM_FLIP, &contenders, text, mean_of, Some(papers));
    table.note = "RGB; SSIM with a gaussian window 11x11. ∞: identical images. The paper has no FLIP.".into();
    section.table(table);
    section.table(quality_in_parts(suite, &contenders));
    section.table(metric_table(suite, "Every scene and method in full", &contenders));
    section
}

/// Returns a table of the quality in holes and elsewhere, as means over the scenes.
fn quality_in_parts(suite: &SuiteData, contenders: &[&str]) -> Table {
    const COLUMNS: [MetricColumn; 12] = [
        ("PSNR, dB", metric::PSNR, 2),
        ("SSIM", metric::SSIM, 4),
        ("SSIM 7x7", metric::SSIM_UNIFORM, 4),
        ("PSNR of luma, dB", metric::PSNR_LUMA, 2),
        ("SSIM of luma", metric::SSIM_LUMA, 4),
        ("FLIP", metric::FLIP, 4),
        ("holes: PSNR, dB", metric::HOLE_PSNR, 2),
        ("holes: SSIM", metric::HOLE_SSIM, 4),
        ("holes: FLIP", metric::HOLE_FLIP, 4),
        ("elsewhere: PSNR, dB", metric::VISIBLE_PSNR, 2),
        ("elsewhere: SSIM", metric::VISIBLE_SSIM, 4),
        ("elsewhere: FLIP", metric::VISIBLE_FLIP, 4),
    ];
    let mut table = means_table(suite, "Holes and the rest, means over the scenes", contenders, &COLUMNS);
    let contenders = suite.contenders();
    let shares = contenders.iter().flat_map(|name| suite.values(name, |m| m.mean(metric::HOLE_SHARE)));
    if let Some(share) = mean(shares) {
        table.note = format!(
            "Holes: what the dominant eye's own image does not show, {:.2} % of the pixels. FLIP: less is better.",
            100.0 * share
        );
    }
    table
}

fn overhead(suite: &SuiteData) -> Section {
    let mut section = Section::new(
        "Overhead",
        "CPU time and memory of a stereo frame. The paper gives CPU load in percent and its applications' memory. \
         Power and temperature need a phone.",
    );
    let others = suite.compared(metric::CPU_MS);
    let plot = Plot::rows("CPU time over two full renders", Axis::new("CPU time / conventional").baseline(1.0)).caption(
        "CPU time of a stereo frame over all threads, including rasterization if the CPU rasterizes. The paper's: CPU \
         load over conventional rendering's.",
    );
    let ratio = |setting: &SettingData, name: &str| {
        Some(setting.find(name)?.ratio(setting.find(CONVENTIONAL)?, metric::CPU_MS)?.median)
    };
    let papers = |setting: &SettingData| {
        paper_scene(setting).map_or_else(Vec::new, |scene| over_conventional(scene.cpu))
    };
    section.plot(mark_scenes(plot, suite, &others, ratio, papers));
    let plot = Plot::rows("Memory over two full renders", Axis::new("memory / conventional")).caption(
        "Memory of the process, with the scene and one method's textures. The paper's: memory of its applications over \
         conventional rendering's.",
    );
    let ratio = |setting: &SettingData, name: &str| {
        let base = setting.find(CONVENTIONAL)?.mean(metric::MEMORY_MIB)?;
        Some(setting.find(name)?.mean(metric::MEMORY_MIB)? / base)
    };
    let papers = |setting: &SettingData| {
        paper_scene(setting).map_or_else(Vec::new, |scene| over_conventional(scene.memory))
    };
    section.plot(mark_scenes(plot, suite, &others, ratio, papers));
    const COLUMNS: [MetricColumn; 5] = [
        ("CPU time, ms", metric::CPU_MS, 1),
        ("memory, MiB", metric::MEMORY_MIB, 1),
        ("textures of the method, MiB", metric::TEXTURE_MIB, 1),
        ("GPU time, ms", metric::GPU_MS, 3),
        ("draw calls", metric::DRAW_CALLS, 0),
    ];
    section.table(means_table(suite, "Means over the scenes", &suite.measured(metric::CPU_MS), &COLUMNS));
    section.table(pass_table(suite));
    section
}

/// Returns a table of the passes' times, as medians over the scenes' medians.
fn pass_table(suite: &SuiteData) -> Table {
    let measured = suite.settings.iter().flat_map(|setting| &setting.contenders);
    let metrics = unique(measured.flat_map(|measured| measured.metrics()));
    let passes: Vec<&str> = metrics.into_iter().filter(|name| name.starts_with(metric::PASS_MS)).collect();
    let of = |name: &str, pass: &str| mean(suite.values(name, |measured| measured.median(pass)));
    let has_passes = |name: &&str| passes.iter().any(|pass| of(name, pass).is_some());
    let contenders: Vec<&str> = suite.contenders().into_iter().filter(has_passes).collect();
    let mut table =
        table_of("Time of each pass, means over the scenes of the medians", &["<pass, ms"], &contenders);
    for pass in &passes {
        let cells = contenders.iter().map(|name| cell(name, fixed(of(name, pass), 2)));
        let name = pass.trim_start_matches(metric::PASS_MS);
        table.push([Cell::plain(name)].into_iter().chain(cells).collect());
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
