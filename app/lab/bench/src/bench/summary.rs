//! A short table of a file of results for the terminal.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::contender::Contender;
use super::record::{Conditions, Measurement, Results, metric};
use yoro_report::stats::{self, median, unique};

/// A column: heading, metric, number of decimals, and the function that combines its values.
type Column = (&'static str, &'static str, usize, fn(&[f64]) -> Option<f64>);

const COLUMNS: [Column; 12] = [
    ("frame ms", metric::FRAME_MS, 1, median),
    ("CPU ms", metric::CPU_MS, 1, median),
    ("GPU ms", metric::GPU_MS, 2, median),
    ("patch ms", metric::PATCH_MS, 2, median),
    ("draws", metric::DRAW_CALLS, 0, median),
    ("open", metric::OPEN_SHARE, 4, mean),
    ("PSNR", metric::PSNR, 2, mean),
    ("SSIM", metric::SSIM, 4, mean),
    ("FLIP", metric::FLIP, 4, mean),
    ("flicker", metric::FLICKER, 2, mean),
    ("kbit/s", metric::KBIT_S, 0, mean),
    ("saved %", metric::SAVED, 1, mean),
];

fn mean(values: &[f64]) -> Option<f64> {
    stats::mean(values.iter().copied())
}

/// Returns a block for each setting with a line for each contender, then the contenders that could not take part.
pub fn text(results: &Results) -> String {
    let mut out = String::new();
    for facts in results.scenes() {
        let _ = writeln!(out, "{} ({} triangles)", facts.conditions, facts.triangles);
        out += &block(results, &facts.conditions);
    }
    let mut reasons = BTreeSet::new();
    for unsupported in results.unsupported() {
        if reasons.insert((&unsupported.contender, &unsupported.reason)) {
            let _ = writeln!(
                out,
                "not measured: {} in {}: {}",
                unsupported.contender, unsupported.conditions, unsupported.reason
            );
        }
    }
    out
}

fn block(results: &Results, conditions: &Conditions) -> String {
    let measured: Vec<&Measurement> =
        results.measurements().filter(|m| m.conditions == *conditions).collect();
    let values = |contender: &str, metric: &str| -> Vec<f64> {
        let of_contender = measured.iter().filter(|m| m.contender == contender);
        of_contender.flat_map(|m| m.finite(metric)).collect()
    };
    let contenders = unique(measured.iter().map(|measurement| measurement.contender.as_str()));
    let columns: Vec<&Column> =
        COLUMNS.iter().filter(|c| measured.iter().any(|m| m.values.contains_key(c.1))).collect();
    let width = contenders.iter().map(|name| name.len()).max().unwrap_or(0);
    let baseline = median(&values(&Contender::CONVENTIONAL.name(), metric::FRAME_MS));
    let mut out = format!("  {:width$}", "");
    for (heading, ..) in &columns {
        let _ = write!(out, "  {heading:>9}");
    }
    out += if baseline.is_some() { "      ratio\n" } else { "\n" };
    for contender in contenders {
        let _ = write!(out, "  {contender:width$}");
        for (_, metric, digits, one) in &columns {
            let text =
                one(&values(contender, metric)).map_or_else(|| "–".into(), |v| format!("{v:.digits$}"));
            let _ = write!(out, "  {text:>9}");
        }
        if let (Some(baseline), Some(own)) = (baseline, median(&values(contender, metric::FRAME_MS))) {
            let _ = write!(out, "  {:>9.3}", own / baseline);
        }
        out += "\n";
    }
    out
}
