//! Eyes with all pixels only where they look.

use super::cells::cell;
use crate::bench::record::metric;
use crate::report::bench::data::{CONVENTIONAL, MONO, SettingData, Suite};
use yoro_report::stats::{geometric_mean, mean};
use yoro_report::text::fixed;
use yoro_report::{Cell, Section, Table};

/// Returns the section of the suite `foveation`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "Foveation",
        "Each eye in two levels, an inset of all pixels around its axis and a wide view of fewer, by two renders and by synthesis of \
         each level: all pixels to 30 (low) or 20 degrees (medium, high), and half (low, medium) or a third of them along each axis \
         beyond. Quality is that of the synthesized eye: in the fovea, within 20 degrees, and in the periphery beyond \
         the inset, against two full renders; alike, against two renders with the same levels; near silhouettes, within 3 pixels of \
         them in the periphery, alike. The paper does not measure this.",
    );
    for label in suite.labels() {
        section.table(means(suite, label));
    }
    for label in suite.labels() {
        section.table(by_scene(suite, label));
    }
    section
}

fn settings<'a>(suite: &'a Suite, label: &'a str) -> impl Iterator<Item = &'a SettingData> {
    suite.settings.iter().filter(move |setting| setting.conditions.label.as_deref() == Some(label))
}

/// Returns the name of two renders with the same levels.
fn alike(name: &str) -> String {
    match name.split_once('-') {
        Some((_, level)) => format!("{CONVENTIONAL}-{level}"),
        None => CONVENTIONAL.to_owned(),
    }
}

/// Returns a frame's time over that of another contender in a setting.
fn over(setting: &SettingData, name: &str, base: &str) -> Option<f64> {
    Some(setting.find(name)?.ratio(setting.find(base)?, metric::FRAME_MS)?.median)
}

/// Returns the means over all scenes at one field of view.
fn means(suite: &Suite, label: &str) -> Table {
    let columns = [
        "<levels",
        "time over two full renders",
        "over two alike",
        "shaded",
        "fovea",
        "periphery",
        "periphery, alike",
        "near silhouettes, alike",
        "flicker of the periphery, rendered eye",
        "flicker of the periphery, synthesized eye",
    ];
    let mut table =
        Table::new(format!("Means over the scenes at {label}: times, PSNR in dB / SSIM"), &columns);
    for name in suite.contenders() {
        let average = |metric: &str| mean(settings(suite, label).filter_map(|s| s.find(name)?.mean(metric)));
        let quality = |[psnr, ssim]: [&str; 2]| {
            let ssim = average(ssim)?;
            // Identical images have no finite PSNR.
            Some(average(psnr).map_or_else(|| "equal".into(), |psnr| format!("{psnr:.2} / {ssim:.3}")))
        };
        let ratio =
            |base: &str| fixed(geometric_mean(settings(suite, label).filter_map(|s| over(s, name, base))), 2);
        let mut cells = vec![Cell::plain(name)];
        let own = [
            ratio(CONVENTIONAL),
            ratio(&alike(name)).filter(|_| name != MONO),
            fixed(average(metric::SHADED), 3),
            quality(metric::FOVEA),
            quality(metric::PERIPHERY),
            quality(metric::ALIKE),
            quality(metric::SILHOUETTES),
            fixed(average(metric::PERIPHERY_FLICKER[0]), 2),
            fixed(average(metric::PERIPHERY_FLICKER[1]), 2),
        ];
        cells.extend(own.map(|text| cell(name, text)));
        table.push(cells);
    }
    table.note = "The same image near silhouettes is compared with a full render.".into();
    table
}

/// Returns the times of each scene over two full renders at one field of view.
fn by_scene(suite: &Suite, label: &str) -> Table {
    let scenes: Vec<&SettingData> = settings(suite, label).collect();
    let mut columns = vec!["<levels"];
    columns.extend(scenes.iter().map(|setting| setting.conditions.scene.as_str()));
    let mut table = Table::new(format!("Frame time over two full renders at {label}"), &columns);
    for name in suite.measured(metric::FRAME_MS) {
        let mut cells = vec![Cell::plain(name)];
        cells.extend(scenes.iter().map(|setting| cell(name, fixed(over(setting, name, CONVENTIONAL), 2))));
        table.push(cells);
    }
    table
}
