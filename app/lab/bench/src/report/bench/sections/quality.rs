//! Image quality.

use super::cells::{paper_scene, psnr_ssim, scene_plot};
use super::sweeps::QUALITY_FIGURES;
use super::tables::{PaperColumn, means_table, metric_table, scene_table};
use crate::bench::record::metric;
use crate::report::bench::data::Suite;
use yoro_report::paper::{PAPER, PaperScene};
use yoro_report::stats::mean;
use yoro_report::text::fixed;
use yoro_report::{Axis, Section, Table};

fn paper_quality(scene: &PaperScene, name: &str) -> Option<f64> {
    match name {
        metric::PSNR => Some(scene.psnr),
        metric::SSIM => Some(scene.ssim),
        _ => None,
    }
}

/// Returns the section on quality of the suite `scenes`.
pub fn section(suite: &Suite) -> Section {
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
    quality_figures(&mut section, suite);
    let mean_of = |name: &str| {
        let ssim = suite.mean(name, metric::SSIM)?;
        let psnr = fixed(suite.mean(name, metric::PSNR), 2);
        Some(format!("{} / {ssim:.4}", psnr.unwrap_or_else(|| "∞".into())))
    };
    let average = &PAPER.average;
    let mut table = scene_table(
        suite,
        "PSNR in dB / SSIM",
        &contenders,
        |setting, name| psnr_ssim(setting.find(name)?),
        mean_of,
        Some(PaperColumn {
            head: "the paper's YORO",
            text: &|setting| {
                let scene = paper_scene(setting)?;
                Some(format!("{}: {:.2} / {:.4}", scene.name, scene.psnr, scene.ssim))
            },
            mean: format!("{:.2} / {:.4}", average.psnr, average.ssim),
        }),
    );
    table.note = "RGB; SSIM with a gaussian window 11x11. ∞: identical images.".into();
    section.table(table);
    section.table(parts_table(suite, &contenders));
    section.table(metric_table(suite, "Every scene and method in full", &contenders));
    section
}

fn quality_figures(section: &mut Section, suite: &Suite) {
    for (name, axis, caption) in QUALITY_FIGURES {
        let plot = scene_plot(
            suite,
            axis,
            Axis::new(axis),
            &suite.compared(name),
            |setting, contender| setting.find(contender)?.mean(name),
            |setting| {
                let value = paper_scene(setting).and_then(|scene| paper_quality(scene, name));
                value.map(|value| ("yoro-paper", value)).into_iter().collect()
            },
        );
        section.plot(plot.caption(caption));
    }
}

/// Returns a table of the quality in holes and elsewhere, as means over the scenes.
fn parts_table(suite: &Suite, contenders: &[&str]) -> Table {
    let columns = [
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
    let mut table = means_table(suite, "Holes and the rest, means over the scenes", contenders, &columns);
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
