//! The bits of a stream, and the quality of what it shows some frames later.

use super::cells::{cell, percent, psnr_ssim};
use super::tables::push_refusals;
use crate::bench::record::metric::{KBIT_S, SAVED};
use crate::report::bench::data::{SettingData, Suite};
use yoro_report::paper::PAPER;
use yoro_report::stats::mean;
use yoro_report::text::fixed;
use yoro_report::{Cell, Section, Table};

/// Returns the section of the suite `stream`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "Streaming",
        "Frames of a walking head (1.35 m/s, 72 frames a second) as `yoro serve` sends them, encoded by openh264 at one quantizer: one \
         eye and its depth, from which both eyes are made at the pose where they are shown; both eyes, turned to that pose; and both eyes \
         with the depth of one. Quality is the mean of both eyes against real renders at that pose, at once and 2 and 5 frames (28 and \
         69 ms) later. The first frame's bits, an intra frame's, do not count. No times are measured.",
    );
    section.table(bits(suite));
    section.table(quality(suite));
    section
}

/// Returns a table of bits, and of the savings compared with both eyes. They do not depend on the delay.
fn bits(suite: &Suite) -> Table {
    let scenes = suite.scenes();
    let mut columns = vec!["<sent, each with its quantizer"];
    columns.extend(&scenes);
    let mut table =
        Table::new("Bit rate in kbit/s, and bits saved against both eyes at the same quantizer", &columns);
    let mut saved = Vec::new();
    for name in suite.measured(KBIT_S) {
        let mut cells = vec![Cell::plain(name)];
        for scene in &scenes {
            let setting = suite.settings.iter().find(|setting| setting.conditions.scene == *scene);
            let measured = setting.and_then(|setting| setting.find(name));
            let value = |metric: &str| measured.and_then(|measured| measured.mean(metric));
            let share = value(SAVED);
            saved.extend(share.filter(|_| name.starts_with("one eye")));
            let text = fixed(value(KBIT_S), 0).map(|rate| match fixed(share, 1) {
                Some(share) => format!("{rate}, {share} %"),
                None => rate,
            });
            cells.push(cell(name, text));
        }
        table.push(cells);
    }
    push_refusals(&mut table, suite);
    let papers = mean(PAPER.scenes.iter().map(|scene| scene.kbit[0] / scene.kbit[1] - 1.0));
    table.note = format!(
        "Mean difference of one eye and depth here {}; the paper's {}. The paper names neither quantizer nor resolution.",
        mean(saved).map_or_else(|| "–".into(), |saved| percent(-saved / 100.0)),
        papers.map_or_else(|| "–".into(), percent),
    );
    table
}

/// Returns a table of the quality of both eyes by delay.
fn quality(suite: &Suite) -> Table {
    let mut columns = vec!["<shown by".to_owned()];
    columns.extend(suite.settings.iter().map(|setting| setting.label()));
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    let mut table =
        Table::new("Quality of both eyes by scene and frames of delay: PSNR in dB / SSIM", &columns);
    for name in suite.contenders() {
        let mut cells = vec![Cell::plain(name)];
        let of = |setting: &SettingData| setting.find(name).and_then(psnr_ssim);
        cells.extend(suite.settings.iter().map(|setting| cell(name, of(setting))));
        table.push(cells);
    }
    table.note = "The same image is not encoded.".into();
    table
}
