//! Tables as text.

use std::fmt::Write as _;

use super::run::RunReport;
use yoro_metrics::Quality;
use yoro_report::paper;
use yoro_report::text::short_count;

fn pair(quality: &Quality) -> String {
    format!("{} / {:.4}", quality.psnr, quality.ssim_gaussian)
}

/// Returns the table in Markdown: one row for each scene and method, then the means.
pub(super) fn markdown(report: &RunReport) -> String {
    let mut out = String::from(
        "| Scene | Triangles | Method | PSNR / SSIM | Same image to both eyes | SSIM 7x7 | Frame, ms | Two renders, ms | Ratio | The paper's PSNR / SSIM |\n\
         |---|---:|---|---:|---:|---:|---:|---:|---:|---:|\n",
    );
    let cell = |text: &str| text.replace('|', "\\|");
    for row in report.rows() {
        let paper = row.paper.map_or("–".into(), |p| format!("{}: {:.2} / {:.4}", p.name, p.psnr, p.ssim));
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {:.4} | {:.1} | {:.1} | {:.2} | {paper} |",
            cell(&row.scene),
            short_count(row.triangles),
            cell(&row.method),
            pair(&row.quality),
            pair(&row.same_image),
            row.quality.ssim_uniform,
            row.frame_ms,
            row.conventional_ms,
            row.cost_ratio,
        );
    }
    for mean in report.means() {
        let average = paper::AVERAGE;
        let _ = writeln!(
            out,
            "| **mean of {}** | | {} | {} | {} | {:.4} | | | {:.2} | {}: {:.2} / {:.4} |",
            mean.scenes,
            cell(&mean.method),
            pair(&mean.quality),
            pair(&mean.same_image),
            mean.quality.ssim_uniform,
            mean.cost_ratio,
            average.name,
            average.psnr,
            average.ssim,
        );
    }
    let machine = &report.machine;
    let _ = writeln!(
        out,
        "\nSSIM: gaussian window 11x11, sigma 1.5 (SSIM 7x7: uniform window); RGB. Ratio: frame time over two full \
         renders; its mean is geometric. `{}` on {}, {} cores, {}, {}.",
        machine.command, machine.cpu, machine.cores, machine.gl_renderer, machine.date
    );
    out
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
    fn every_markdown_row_has_all_cells_and_baselines() {
        let report = synthetic(24, 2);
        let table = report.to_markdown();
        let lines: Vec<&str> = table.lines().take_while(|line| !line.is_empty()).collect();
        assert_eq!(lines.len(), 2 + 4 + 2);
        for line in &lines {
            assert_eq!(line.replace("\\|", "").matches('|').count(), 11, "{line}");
        }
        let baseline = format!("{:.4}", report.rows()[0].same_image.ssim_gaussian);
        assert!(lines[2].contains(&baseline) && lines[2].contains("Bistro: 31.99 / 0.9505"), "{}", lines[2]);
        assert!(table.contains("yoro run --size 1024"));
    }

    #[test]
    fn the_terminal_table_is_aligned() {
        let text = synthetic(24, 3).to_text();
        let lines: Vec<&str> = text.lines().collect();
        let widths: Vec<usize> = lines[1..lines.len() - 1].iter().map(|line| line.chars().count()).collect();
        assert!(widths.iter().all(|width| *width == widths[0]), "{text}");
        assert!(widths[0] < 120);
    }
}
