//! Quality by shading style.

use super::cells::{CONVENTIONAL, cell};
use super::dots::papers_mark;
use super::section::Section;
use super::sweeps::QUALITY_FIGURES;
use super::tables::{metric_table, push_refusals};
use crate::bench::record::metric;
use crate::report::bench::data::{SettingData, Suite, mean};
use yoro_figures::grid::{Cell, Table};
use yoro_figures::paper;
use yoro_figures::plot::{Axis, DotRow, Mark, Panel};

/// The section of the suite `styles`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "styles",
        "Shading styles",
        "The same synthesis under five styles of shading. In the paper each style is another scene of its own.",
    );
    let with_style = |style: &str| -> Vec<&SettingData> {
        suite.settings.iter().filter(|setting| setting.setting.label.as_deref() == Some(style)).collect()
    };
    let value = |style: &str, contender: &str, name: &str| {
        mean(with_style(style).iter().filter_map(|setting| setting.find(contender)?.mean(name)).collect())
    };
    let paper_style = |style: &str| paper::STYLES.iter().find(|(name, ..)| *name == style);
    let contenders: Vec<&str> =
        suite.measured(metric::SSIM).into_iter().filter(|name| *name != CONVENTIONAL).collect();
    for (name, axis, caption) in QUALITY_FIGURES {
        let rows = suite.labels().into_iter().map(|style| {
            let paper = paper_style(style).and_then(|(_, ssim, psnr)| match name {
                metric::SSIM => Some(*ssim),
                metric::PSNR => Some(*psnr),
                _ => None,
            });
            let paper = paper.map(|value| papers_mark("yoro-paper", value));
            let ours = contenders.iter().rev().filter_map(|contender| {
                let value = value(style, contender, name)?;
                Some(Mark::new(*contender, *contender, value))
            });
            DotRow { label: style.into(), marks: paper.into_iter().chain(ours).collect() }
        });
        let panel = Panel::Dots { value: Axis::new(axis), rows: rows.collect() };
        section.figure(name, axis, &format!("{caption} Means over the scenes."), panel);
    }
    let mut columns = vec!["<style"];
    columns.extend(&contenders);
    columns.push("the paper's YORO");
    let mut table = Table::new("PSNR in dB / SSIM, means over the scenes", &columns);
    for style in suite.labels() {
        let mut cells = vec![Cell::plain(style)];
        for name in &contenders {
            let pair = value(style, name, metric::PSNR).zip(value(style, name, metric::SSIM));
            cells.push(cell(name, pair.map(|(psnr, ssim)| format!("{psnr:.2} / {ssim:.4}"))));
        }
        cells.push(Cell::paper(paper_style(style).map(|(_, ssim, psnr)| format!("{psnr:.1} / {ssim:.3}"))));
        table.push(cells);
    }
    push_refusals(&mut table, suite);
    table.note = format!("Scenes: {}.", suite.scenes().join(", "));
    section.table(table);
    section.table(metric_table(suite, "Every scene and style in full", &contenders));
    section
}
