//! Suites whose settings have a label: the shading style, or the number of samples.

use std::collections::BTreeMap;

use super::cells::{CONVENTIONAL, cell, papers};
use super::sweeps::QUALITY_FIGURES;
use super::tables::{metric_table, push_refusals};
use crate::bench::record::metric;
use crate::report::bench::data::{SettingData, Suite};
use yoro_report::paper::PAPER;
use yoro_report::stats::mean;
use yoro_report::{Axis, Cell, Entry, Plot, Section, Table};

/// What differs between sections of this kind.
struct Labels {
    /// The heading of the labels' column.
    column: &'static str,
    /// The title of the table with a row for each label.
    title: &'static str,
    /// The title of the table with all settings.
    details: &'static str,
    /// The paper's SSIM and PSNR in dB by label, if it has any.
    papers: Option<&'static BTreeMap<String, [f64; 2]>>,
    /// True if frame times were measured.
    timed: bool,
}

/// Returns the section of the suite `styles`.
pub fn styles(suite: &Suite) -> Section {
    let section = Section::new(
        "Shading styles",
        "The same synthesis under five styles of shading. In the paper, each style is a separate scene.",
    );
    let labels = Labels {
        column: "<style",
        title: "PSNR in dB / SSIM, means over the scenes",
        details: "Every scene and style in full",
        papers: Some(&PAPER.styles),
        timed: false,
    };
    fill(section, suite, &labels)
}

/// Returns the section of the suite `anti-aliasing`.
pub fn anti_aliasing(suite: &Suite) -> Section {
    let section = Section::new(
        "Anti-aliasing",
        "Each synthesized eye against the same eye rendered with as many samples per pixel. Synthesis takes the mean \
         colour and the nearest depth of each pixel's samples.",
    );
    let labels = Labels {
        column: "<samples per pixel",
        title: "PSNR in dB / SSIM / frame time over two renders, means over the scenes",
        details: "Every scene in full",
        papers: None,
        timed: true,
    };
    fill(section, suite, &labels)
}

/// Adds dot plots of quality, a table with a row for each label, and one with all settings.
fn fill(mut section: Section, suite: &Suite, labels: &Labels) -> Section {
    let contenders = suite.compared(metric::SSIM);
    let labelled = |label: &str| -> Vec<&SettingData> {
        suite.settings.iter().filter(|setting| setting.conditions.label.as_deref() == Some(label)).collect()
    };
    let value = |label: &str, contender: &str, name: &str| {
        mean(labelled(label).iter().filter_map(|setting| setting.find(contender)?.mean(name)))
    };
    let paper_of = |label: &str| labels.papers.and_then(|papers| papers.get(label));
    for (name, axis, caption) in QUALITY_FIGURES {
        let mut plot = Plot::rows(axis, Axis::new(axis)).caption(format!("{caption} Means over the scenes."));
        for label in suite.labels() {
            for contender in &contenders {
                let value = value(label, contender, name).unwrap_or(f64::NAN);
                plot.mark(label, Entry::ours(*contender), value);
            }
            let paper = paper_of(label).and_then(|[ssim, psnr]| match name {
                metric::SSIM => Some(*ssim),
                metric::PSNR => Some(*psnr),
                _ => None,
            });
            plot.mark(label, papers("yoro-paper"), paper.unwrap_or(f64::NAN));
        }
        section.plot(plot);
    }
    let mut columns = vec![labels.column];
    columns.extend(&contenders);
    if labels.papers.is_some() {
        columns.push("the paper's YORO");
    }
    let mut table = Table::new(labels.title, &columns);
    for label in suite.labels() {
        let mut cells = vec![Cell::plain(label)];
        for name in &contenders {
            let pair = value(label, name, metric::PSNR).zip(value(label, name, metric::SSIM));
            let ratios = labelled(label).into_iter().filter_map(|setting| {
                let of = |contender: &str| setting.find(contender)?.median(metric::FRAME_MS);
                Some(of(name)? / of(CONVENTIONAL)?)
            });
            let ratio = mean(ratios).filter(|_| labels.timed);
            let ratio = ratio.map_or_else(String::new, |ratio| format!(" / {ratio:.2}"));
            cells.push(cell(name, pair.map(|(psnr, ssim)| format!("{psnr:.2} / {ssim:.4}{ratio}"))));
        }
        if labels.papers.is_some() {
            let paper = paper_of(label).map(|[ssim, psnr]| format!("{psnr:.1} / {ssim:.3}"));
            cells.push(Cell::paper(paper));
        }
        table.push(cells);
    }
    push_refusals(&mut table, suite);
    table.note = format!("Scenes: {}.", suite.scenes().join(", "));
    section.table(table);
    section.table(metric_table(suite, labels.details, &contenders));
    section
}
