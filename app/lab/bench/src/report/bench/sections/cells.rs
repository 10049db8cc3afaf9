//! Figures as text, cells of tables, and plots with a row for each setting.

use crate::bench::record::metric;
pub use crate::report::bench::data::{CONVENTIONAL, MONO};
use crate::report::bench::data::{Measured, SettingData, Suite};
use yoro_report::paper::{self, PaperScene};
use yoro_report::text::fixed;
use yoro_report::{Axis, Cell, Entry, Plot};

/// Formats a time in ms with two decimals or, from 100 ms on, without: `530` or `12.30`.
pub fn milliseconds(value: f64) -> String {
    // Avoids a minus sign in front of zero.
    let value = if value.abs() < 0.005 { 0.0 } else { value };
    if value >= 100.0 { format!("{value:.0}") } else { format!("{value:.2}") }
}

/// Formats a share as a signed difference in percent.
pub fn percent(share: f64) -> String {
    format!("{:+.1} %", 100.0 * share)
}

/// Returns PSNR and SSIM of a contender, as in the paper's tables; `None` if SSIM was not measured.
pub fn psnr_ssim(measured: &Measured) -> Option<String> {
    let ssim = measured.mean(metric::SSIM)?;
    // Identical images have no finite PSNR.
    let psnr = fixed(measured.mean(metric::PSNR), 2).unwrap_or_else(|| "∞".into());
    Some(format!("{psnr} / {ssim:.4}"))
}

/// Returns a cell with one of our figures, or with a baseline if the contender is one.
pub fn cell(contender: &str, text: Option<String>) -> Cell {
    if [CONVENTIONAL, MONO].contains(&contender) { Cell::base(text) } else { Cell::ours(text) }
}

/// Returns the paper's scene that a setting's scene corresponds to.
pub fn paper_scene(setting: &SettingData) -> Option<&'static PaperScene> {
    paper::find(setting.stands_for())
}

/// Returns the entry of the paper's figures of the system that a method here corresponds to.
pub fn papers(method: &str) -> Entry {
    Entry::papers(method, format!("the paper's {}", paper::system(method)))
}

/// Returns a plot with a row for each setting and a mark for each contender, and the paper's.
pub fn scene_plot(
    suite: &Suite,
    title: &str,
    axis: Axis,
    contenders: &[&str],
    value: impl Fn(&SettingData, &str) -> Option<f64>,
    of_paper: impl Fn(&SettingData) -> Vec<(&'static str, f64)>,
) -> Plot {
    let mut plot = Plot::rows(title, axis);
    for setting in &suite.settings {
        let row = setting.label();
        for name in contenders {
            plot.mark(&row, Entry::ours(*name), value(setting, name).unwrap_or(f64::NAN));
        }
        for (method, value) in of_paper(setting) {
            plot.mark(&row, papers(method), value);
        }
    }
    plot
}
