//! Bit rates with H.264.

use super::cells::percent;
use super::section::Section;
use super::tables::push_refusals;
use crate::bench::bandwidth;
use crate::report::bench::data::{Measured, SettingData, Suite};
use yoro_report::bd_rate::bd_rate;
use yoro_report::grid::{Cell, Table};
use yoro_report::paper;
use yoro_report::plot::{Axis, Panel, Series};
use yoro_report::stats::mean;
use yoro_report::text::{fixed, slug};

/// The smallest share of the anchor's range of qualities that a curve must reach to be compared.
const LEAST_OVERLAP: f64 = 0.1;

/// Returns the section of the suite `bandwidth`.
pub fn section(suite: &Suite) -> Section {
    use bandwidth::{STEREO_RGB, metric::*};
    let mut section = Section::new(
        "bandwidth",
        "Bandwidth",
        "H.264 of one eye and its depth, from which the receiver synthesizes the other eye, against H.264 of both \
         eyes. The paper compares bit rates alone. At one quantizer the two streams differ in quality, so both eyes \
         are measured after decoding, and rates are compared at equal quality.",
    );
    let streams = suite.measured(KBIT_S);
    let both_luma = [PSNR_LUMA_DOMINANT, PSNR_LUMA_OTHER];
    let both_rgb = [PSNR_DOMINANT, PSNR_OTHER];
    let both_ssim = [SSIM_DOMINANT, SSIM_OTHER];
    for setting in &suite.settings {
        let series = streams.iter().rev().map(|name| Series {
            method: (*name).into(),
            papers: false,
            label: (*name).into(),
            points: rate_points(setting, name, both_luma),
        });
        let panel = Panel::Curves {
            x: Axis::new("bit rate, kbit/s").logarithmic(),
            y: Axis::new("luma PSNR of both eyes, dB"),
            series: series.collect(),
        };
        let scene = setting.label();
        let caption = "Mean of both eyes after decoding, against the uncompressed renders.";
        section.figure(&slug(&scene), &format!("Rate and distortion: {scene}"), caption, panel);
    }
    section.table(rate_table(suite));

    let columns = [
        "<scene",
        "<stream",
        "by luma PSNR",
        "over dB",
        "by RGB PSNR",
        "over dB",
        "by SSIM",
        "over",
        "best luma PSNR of the other eye, dB",
    ];
    let mut equal = Table::new("Bit rate at equal quality against stereo RGB (BD-rate)", &columns);
    for setting in &suite.settings {
        for (i, name) in streams.iter().filter(|name| **name != STEREO_RGB).enumerate() {
            // The fitted curves say nothing if they have hardly any quality in common.
            let compare = |metrics: [&str; 2]| {
                let (anchor, tested) =
                    (rate_points(setting, STEREO_RGB, metrics), rate_points(setting, name, metrics));
                bd_rate(&anchor, &tested).filter(|bd| bd.overlap >= LEAST_OVERLAP)
            };
            let mut cells = vec![Cell::plain(setting.label()), Cell::plain(*name)];
            for (metrics, decimals) in [(both_luma, 1), (both_rgb, 1), (both_ssim, 3)] {
                let bd = compare(metrics);
                let share = bd.map_or_else(|| "no quality in common".to_owned(), |bd| percent(bd.share));
                cells.push(Cell::ours(Some(share)));
                let over = bd.map(|bd| format!("{:.2$} – {:.2$}", bd.quality[0], bd.quality[1], decimals));
                cells.push(Cell::plain(over.unwrap_or_default()));
            }
            let best = rate_points(setting, name, [PSNR_LUMA_OTHER; 2]).into_iter().map(|p| p.1);
            cells.push(Cell::ours(fixed(best.reduce(f64::max), 2)));
            equal.push_grouped(cells, i == 0);
        }
    }
    equal.note =
        "Bjøntegaard's mean difference by the mean quality of both eyes. Negative means fewer bits than stereo RGB for \
         the same quality. Curves are compared only over qualities that both reach: no bit rate recovers what \
         synthesis cannot show."
            .into();
    section.table(equal);
    section
}

/// Returns the rate of a stream and the mean quality of both eyes, by quantizer.
fn rate_points(setting: &SettingData, stream: &str, metrics: [&str; 2]) -> Vec<(f64, f64)> {
    let Some(measured) = setting.find(stream) else { return Vec::new() };
    let rates = measured.by_frame(bandwidth::metric::KBIT_S);
    let quality = metrics.map(|name| measured.by_frame(name));
    let points = rates.iter().zip(quality[0]).zip(quality[1]);
    let mut points: Vec<(f64, f64)> =
        points.filter_map(|((rate, a), b)| Some(((*rate)?, ((*a)? + (*b)?) / 2.0))).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

/// Returns the bit rates at one quantizer, as compared by the paper.
fn rate_table(suite: &Suite) -> Table {
    use bandwidth::{RGB_DEPTH, STEREO_RGB, metric::*};
    let columns = [
        "<scene",
        "QP",
        "stereo RGB, kbit/s",
        "RGB + depth, kbit/s",
        "depth's share, kbit/s",
        "difference",
        "stereo RGB: luma PSNR, dB",
        "RGB + depth: luma PSNR, dB",
        "the paper's stereo RGB",
        "the paper's RGB + depth",
        "the paper's difference",
    ];
    let mut table = Table::new("Bit rate at one quantizer", &columns);
    let mut differences = Vec::new();
    for setting in &suite.settings {
        let Some((stereo, depth)) = setting.find(STEREO_RGB).zip(setting.find(RGB_DEPTH)) else { continue };
        let paper = paper::BANDWIDTH.iter().find(|(name, ..)| *name == setting.stands_for());
        for (i, quantizer) in stereo.by_frame(QP).iter().enumerate() {
            let value = |measured: &Measured, name: &str| measured.by_frame(name).get(i).copied().flatten();
            let both = |measured: &Measured| {
                Some((value(measured, PSNR_LUMA_DOMINANT)? + value(measured, PSNR_LUMA_OTHER)?) / 2.0)
            };
            let rates = (value(stereo, KBIT_S), value(depth, KBIT_S));
            let difference = rates.0.zip(rates.1).map(|(stereo, depth)| depth / stereo - 1.0);
            differences.extend(difference);
            let paper = paper.filter(|_| i == 0);
            let cells = vec![
                Cell::plain(setting.label()),
                Cell::plain(quantizer.map(|qp| qp.to_string()).unwrap_or_default()),
                Cell::base(fixed(rates.0, 0)),
                Cell::ours(fixed(rates.1, 0)),
                Cell::plain(fixed(value(depth, KBIT_S_DEPTH), 0).unwrap_or_default()),
                Cell::ours(difference.map(percent)),
                Cell::base(fixed(both(stereo), 2)),
                Cell::ours(fixed(both(depth), 2)),
                Cell::paper(fixed(paper.map(|p| p.2), 0)),
                Cell::paper(fixed(paper.map(|p| p.1), 0)),
                Cell::paper(paper.map(|p| percent(p.1 / p.2 - 1.0))),
            ];
            table.push_grouped(cells, i == 0);
        }
    }
    push_refusals(&mut table, suite);
    let papers = mean(paper::BANDWIDTH.iter().map(|(_, depth, stereo)| depth / stereo - 1.0));
    table.note = format!(
        "Mean difference here {}; the paper's {}. The paper names neither quantizer nor resolution, so its rates are \
         in each scene's first row.",
        mean(differences).map_or_else(|| "–".into(), percent),
        papers.map_or_else(|| "–".into(), percent),
    );
    table
}
