//! The table of `yoro run` for a terminal.

use std::fmt::Write as _;

use super::run::RunReport;
use yoro_metrics::Quality;
use yoro_report::text::short_count;

fn pair(quality: &Quality) -> String {
    format!("{} / {:.4}", quality.psnr, quality.ssim_gaussian)
}

/// Returns the table as plain text: one line for each scene and method, then the means.
pub(super) fn text(report: &RunReport) -> String {
    let (rows, means) = (report.rows(), report.means());
    let label = |scenes: usize| format!("mean of {scenes}");
    let widest = |names: &mut dyn Iterator<Item = usize>, least: usize| names.max().unwrap_or(0).max(least);
    let scene = widest(&mut rows.iter().map(|row| row.scene.chars().count()), "mean of 8".len());
    let method = widest(&mut rows.iter().map(|row| row.method.chars().count()), "method".len());
    let mut out = format!(
        "{:scene$}  {:>9}  {:method$}  {:^15}  {:^15}  {:>8}  {:>11}  {:>5}\n",
        "", "", "", "PSNR / SSIM", "same image", "frame", "two renders", ""
    );
    let _ = writeln!(
        out,
        "{:scene$}  {:>9}  {:method$}  {:^15}  {:^15}  {:>8}  {:>11}  {:>5}",
        "scene", "triangles", "method", "synthesized", "to both eyes", "ms", "ms", "ratio"
    );
    for row in &rows {
        let _ = writeln!(
            out,
            "{:scene$}  {:>9}  {:method$}  {:>15}  {:>15}  {:>8.1}  {:>11.1}  {:>5.2}",
            row.scene,
            short_count(row.triangles),
            row.method,
            pair(&row.quality),
            pair(&row.same_image),
            row.frame_ms,
            row.conventional_ms,
            row.cost_ratio
        );
    }
    for mean in &means {
        let _ = writeln!(
            out,
            "{:scene$}  {:>9}  {:method$}  {:>15}  {:>15}  {:>8}  {:>11}  {:>5.2}",
            label(mean.scenes),
            "",
            mean.method,
            pair(&mean.quality),
            pair(&mean.same_image),
            "",
            "",
            mean.cost_ratio
        );
    }
    out += "SSIM: gaussian window 11x11, RGB. Frame times are medians; ratio = frame / two renders.\n";
    out
}

#[cfg(test)]
mod tests {
    use crate::report::tests::synthetic;

    #[test]
    fn the_terminal_table_is_aligned() {
        let text = synthetic(24, 3).to_text();
        let lines: Vec<&str> = text.lines().collect();
        let widths: Vec<usize> = lines[1..lines.len() - 1].iter().map(|line| line.chars().count()).collect();
        assert!(widths.iter().all(|width| *width == widths[0]), "{text}");
        assert!(widths[0] < 120);
    }
}
