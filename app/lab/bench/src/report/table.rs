//! The table of `yoro run` for a terminal.

use std::fmt::Write as _;

use super::run::RunReport;
use yoro_metrics::Quality;
use yoro_report::text::short_count;

/// Returns the table as plain text: one line for each scene and method, then the means.
pub(super) fn text(report: &RunReport) -> String {
    let pair = |quality: &Quality| format!("{} / {:.4}", quality.psnr, quality.ssim_gaussian);
    let mut lines = vec![
        ["", "", "", "PSNR / SSIM", "same image", "frame", "two renders", ""].map(str::to_owned),
        ["scene", "triangles", "method", "synthesized", "to both eyes", "ms", "ms", "ratio"]
            .map(str::to_owned),
    ];
    lines.extend(report.rows().into_iter().map(|row| {
        let times = [format!("{:.1}", row.frame_ms), format!("{:.1}", row.conventional_ms)];
        let [frame, conventional] = times;
        let ratio = format!("{:.2}", row.cost_ratio);
        let (quality, same_image) = (pair(&row.quality), pair(&row.same_image));
        [row.scene, short_count(row.triangles), row.method, quality, same_image, frame, conventional, ratio]
    }));
    lines.extend(report.means().into_iter().map(|mean| {
        let (quality, same_image) = (pair(&mean.quality), pair(&mean.same_image));
        let [scenes, ratio] = [format!("mean of {}", mean.scenes), format!("{:.2}", mean.cost_ratio)];
        [scenes, String::new(), mean.method, quality, same_image, String::new(), String::new(), ratio]
    }));
    let width = |i: usize| lines.iter().map(|line| line[i].chars().count()).max().unwrap_or(0);
    let (scene, method) = (width(0), width(2));
    let mut out = String::new();
    for [name, triangles, by, quality, same_image, frame, conventional, ratio] in &lines {
        let _ = writeln!(
            out,
            "{name:scene$}  {triangles:>9}  {by:method$}  {quality:>15}  {same_image:>15}  {frame:>8}  \
             {conventional:>11}  {ratio:>5}"
        );
    }
    out += "SSIM: gaussian window 11x11, RGB. Frame times are medians; ratio = frame / two renders.\n";
    out
}
