//! Flicker from frame to frame.

use super::cells::{CONVENTIONAL, scene_plot};
use super::tables::{means_table, scene_table};
use crate::bench::record::metric;
use crate::report::bench::data::Suite;
use yoro_report::text::fixed;
use yoro_report::{Axis, Cell, Section};

/// Returns the section of the suite `flicker`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "Flicker",
        "Frame-to-frame change of the synthesized eye that a real render does not have, along part of the camera path \
         at walking pace. The paper does not measure this.",
    );
    for (title, name) in [
        ("Flicker of all pixels", metric::FLICKER),
        ("Flicker in holes", metric::FLICKER_HOLES),
        ("Flicker at edges", metric::FLICKER_EDGES),
    ] {
        let plot = scene_plot(
            suite,
            title,
            Axis::new("flicker, of 255").from_zero(),
            &suite.measured(name),
            |setting, contender| setting.find(contender)?.mean(name),
            |_| Vec::new(),
        );
        section.plot(plot.caption("Less is better."));
    }
    let columns = [
        ("all", metric::FLICKER, 3),
        ("in holes", metric::FLICKER_HOLES, 3),
        ("at edges", metric::FLICKER_EDGES, 3),
        ("elsewhere", metric::FLICKER_REST, 3),
    ];
    let mut table = means_table(
        suite,
        "Flicker, of 255, means over the scenes",
        &suite.measured(metric::FLICKER),
        &columns,
    );
    let changes = [metric::CHANGE, metric::CHANGE_HOLES, metric::CHANGE_EDGES, metric::CHANGE_REST];
    let changes = changes.map(|name| suite.mean(CONVENTIONAL, name));
    if changes.iter().any(Option::is_some) {
        let mut cells = vec![Cell::plain("the scene's own change")];
        cells.extend(changes.map(|change| Cell::base(fixed(change, 3))));
        cells.truncate(table.columns.len());
        table.push_first(cells);
    }
    section.table(table);
    let contenders = suite.measured(metric::FLICKER);
    section.table(scene_table(
        suite,
        "Flicker of all pixels / in holes",
        &contenders,
        |setting, name| {
            let measured = setting.find(name)?;
            let holes = fixed(measured.mean(metric::FLICKER_HOLES), 2).unwrap_or_else(|| "–".into());
            Some(format!("{:.2} / {holes}", measured.mean(metric::FLICKER)?))
        },
        |name| fixed(suite.mean(name, metric::FLICKER), 2),
        None,
    ));
    section
}
