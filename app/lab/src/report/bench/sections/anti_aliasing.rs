//! Quality and cost by what the edges of the rendered eye are made of.

use super::cells::{CONVENTIONAL, cell};
use super::section::Section;
use super::sweeps::QUALITY_FIGURES;
use super::tables::{metric_table, push_refusals};
use crate::bench::record::metric;
use crate::report::bench::data::{SettingData, Suite, mean};
use yoro_figures::grid::{Cell, Table};
use yoro_figures::plot::{Axis, DotRow, Mark, Panel};

/// The section of the suite `anti-aliasing`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "anti-aliasing",
        "Anti-aliasing",
        "Each synthesized eye against the same eye rendered in the same way: with one sample per pixel, with FXAA after \
         synthesis, and with MSAA, where the synthesis is told nothing of the edges (hard), the nearest or the first \
         sample's depth, or the depth of all samples.",
    );
    let contenders: Vec<&str> =
        suite.measured(metric::SSIM).into_iter().filter(|name| *name != CONVENTIONAL).collect();
    let labelled = |label: &str| -> Vec<&SettingData> {
        suite.settings.iter().filter(|setting| setting.setting.label.as_deref() == Some(label)).collect()
    };
    let value = |label: &str, contender: &str, name: &str| {
        mean(labelled(label).iter().filter_map(|setting| setting.find(contender)?.mean(name)).collect())
    };
    for (name, axis, caption) in QUALITY_FIGURES {
        let rows = suite.labels().into_iter().map(|label| {
            let marks = contenders.iter().rev().filter_map(|contender| {
                Some(Mark::new(*contender, *contender, value(label, contender, name)?))
            });
            DotRow { label: label.into(), marks: marks.collect() }
        });
        let panel = Panel::Dots { value: Axis::new(axis), rows: rows.collect() };
        section.figure(name, axis, &format!("{caption} Means over the scenes."), panel);
    }
    let mut columns = vec!["<edges"];
    columns.extend(&contenders);
    let title = "PSNR in dB / SSIM / frame time over two renders, means over the scenes";
    let mut table = Table::new(title, &columns);
    for label in suite.labels() {
        let mut cells = vec![Cell::plain(label)];
        for name in &contenders {
            let pair = value(label, name, metric::PSNR).zip(value(label, name, metric::SSIM));
            let ratios = labelled(label).into_iter().filter_map(|setting| {
                let of = |contender: &str| setting.find(contender)?.median(metric::FRAME_MS);
                Some(of(name)? / of(CONVENTIONAL)?)
            });
            let ratio = mean(ratios.collect()).map_or_else(String::new, |ratio| format!(" / {ratio:.2}"));
            cells.push(cell(name, pair.map(|(psnr, ssim)| format!("{psnr:.2} / {ssim:.4}{ratio}"))));
        }
        table.push(cells);
    }
    push_refusals(&mut table, suite);
    table.note = format!("Scenes: {}.", suite.scenes().join(", "));
    section.table(table);
    section.table(metric_table(suite, "Every scene in full", &contenders));
    section
}
