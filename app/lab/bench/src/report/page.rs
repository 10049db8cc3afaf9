//! The report of `yoro run`, and the blocks that both reports have.

use image::RgbImage;

use super::run::{QUALITY_METHOD, Row, RunReport, SceneReport, Viewpoint};
use crate::machine::{Machine, Parameter};
use yoro::eyes::Eye;
use yoro_metrics::Quality;
use yoro_report::paper::{PAPER, PaperScene};
use yoro_report::stats::unique;
use yoro_report::text::short_count;
use yoro_report::{Axis, Cell, Entry, OtherEye, Picture, Pictures, Plot, Report, Section, Table, Text};

/// The number of viewpoints per scene with pictures on the page. More would have to be shrunk to keep the page small.
const PICTURED_VIEWPOINTS: usize = 1;

const PAPERS_SCENES: &str = "The paper's figures (\"You Only Render Once\", MobiSys '25) belong to its own scenes and machines: quality \
over its 29,128 image groups, frame rates as means over six phones and a Quest 2. The built-in scenes stand for them in style and \
triangle count.";

/// Returns the report of a run.
pub(super) fn report(run: &RunReport) -> Report {
    let mut overview = Section::new("Quality and cost", "");
    plots(run).into_iter().for_each(|plot| overview.plot(plot));
    overview.table(figures(run));
    let mut scenes = Section::new("Scenes", "");
    for scene in &run.scenes {
        let stands_for = match scene.stands_for.as_str() {
            "" => String::new(),
            name => format!(", stands for the paper's {name}"),
        };
        let note = format!("{} triangles{stands_for}", short_count(scene.triangles));
        for viewpoint in scene.viewpoints.iter().take(PICTURED_VIEWPOINTS) {
            scenes.pictures(pictures(viewpoint, scene.name.clone(), format!("{note}, {}", viewpoint.name)));
        }
        scenes.table(passes(scene));
    }
    let mut measured = Section::new("How it was measured", QUALITY_METHOD);
    measured.text(format!("{} Ratios are medians over medians; their mean is geometric.", run.timing_method));
    measured.text(PAPERS_SCENES);
    measured.table(machine("Machine and parameters", &run.machine, &run.parameters));
    let summary = run.means().into_iter().map(|mean| {
        format!(
            "**{}**: the synthesized eye has PSNR **{} dB**, SSIM **{:.4}** (same image to both eyes: {} dB, {:.4}); a stereo frame takes \
             **{:.2}** of the time of two full renders. Mean of {} scene{}.",
            mean.method,
            mean.quality.psnr,
            mean.quality.ssim_gaussian,
            mean.same_image.psnr,
            mean.same_image.ssim_gaussian,
            mean.cost_ratio,
            mean.scenes,
            if mean.scenes == 1 { "" } else { "s" },
        )
    });
    Report {
        title: run.title.clone(),
        summary: summary.map(Text::from).collect(),
        sections: vec![overview, scenes, measured],
    }
}

/// Returns a table of the machine and of everything that influences the figures.
fn machine(title: &str, machine: &Machine, parameters: &[Parameter]) -> Table {
    let mut table = Table::new(title, &["<what", "<value"]);
    let facts = [
        ("command", machine.command.clone()),
        ("date", machine.date.clone()),
        ("yoro", machine.yoro.clone()),
        ("processor", format!("{}, cores: {}", machine.cpu, machine.cores)),
        ("system", machine.os.clone()),
        ("GL", format!("{}; {}", machine.gl_renderer, machine.gl_version)),
    ];
    let parameters = parameters.iter().map(|parameter| (parameter.name.as_str(), parameter.value.clone()));
    for (name, value) in facts.into_iter().chain(parameters) {
        table.push(vec![Cell::plain(name), Cell::long(value)]);
    }
    table
}

/// Returns the pictures of a viewpoint: the truth, each method's, the same image, and the error maps of these.
pub(crate) fn pictures(viewpoint: &Viewpoint, title: String, note: String) -> Pictures {
    let (dominant, other) = (viewpoint.dominant_eye.name(), viewpoint.dominant_eye.other().name());
    let figures = |quality: &Quality| {
        format!(
            "PSNR {} dB, SSIM {:.4} (uniform 7x7: {:.4}).",
            quality.psnr, quality.ssim_gaussian, quality.ssim_uniform
        )
    };
    let picture = |label: &str, caption: String, image: &RgbImage, is_map: bool| Picture {
        label: label.into(),
        caption,
        image: image.clone(),
        is_map,
    };
    let truth = format!("The {other} eye, really rendered: the reference.");
    let mut pictures = vec![picture("really rendered", truth, &viewpoint.ground_truth, false)];
    for view in &viewpoint.views {
        let caption =
            format!("The {other} eye, synthesized from the {dominant} one. {}", figures(&view.quality));
        pictures.push(picture(&view.method, caption, &view.eye, false));
    }
    let same = figures(&viewpoint.same_image);
    let caption = format!("The {dominant} (dominant) eye's image, shown to both eyes: the baseline. {same}");
    let other_eye = OtherEye { picture: pictures.len(), is_left: viewpoint.dominant_eye == Eye::Left };
    pictures.push(picture("same image", caption, &viewpoint.dominant, false));
    let maps = viewpoint.views.iter().map(|view| (view.method.as_str(), &view.error, figures(&view.quality)));
    for (name, map, figures) in maps.chain([("same image", &viewpoint.same_image_error, same)]) {
        let caption = format!("1 - SSIM, black = 0, pale yellow = 1. {figures}");
        pictures.push(picture(&format!("error: {name}"), caption, map, true));
    }
    Pictures { title, note, pictures, other_eye: Some(other_eye) }
}

/// A quantity of the rows that is plotted.
struct Quantity {
    title: &'static str,
    caption: &'static str,
    ours: fn(&Row) -> f64,
    baseline: Option<fn(&Row) -> f64>,
    papers: fn(&PaperScene) -> f64,
}

const QUANTITIES: [Quantity; 3] = [
    Quantity {
        title: "SSIM, gaussian 11x11",
        caption: "More is better. Baseline: the same image to both eyes (ring). The paper's for its own scene.",
        ours: |row| row.quality.ssim_gaussian,
        baseline: Some(|row| row.same_image.ssim_gaussian),
        papers: |paper| paper.ssim,
    },
    Quantity {
        title: "PSNR, dB",
        caption: "More is better. Baseline: the same image to both eyes (ring). The paper's for its own scene.",
        ours: |row| row.quality.psnr.0,
        baseline: Some(|row| row.same_image.psnr.0),
        papers: |paper| paper.psnr,
    },
    Quantity {
        title: "Frame time over two renders",
        caption: "Less is better. Baseline: two full renders = 1. The paper's: frame rates of seven devices.",
        ours: |row| row.cost_ratio,
        baseline: None,
        papers: PaperScene::frame_time_ratio,
    },
];

fn plots(run: &RunReport) -> Vec<Plot> {
    let plot = |quantity: &Quantity| {
        let axis = Axis::new(quantity.title);
        let axis = if quantity.baseline.is_none() { axis.baseline(1.0) } else { axis };
        let mut plot = Plot::rows(quantity.title, axis).caption(quantity.caption);
        for row in run.rows() {
            plot.mark(&row.scene, Entry::ours(&row.method), (quantity.ours)(&row));
        }
        for row in run.scenes.iter().filter_map(|scene| scene.rows().into_iter().next()) {
            if let Some(baseline) = quantity.baseline {
                plot.mark(&row.scene, Entry::ours("same image"), baseline(&row));
            }
            if let Some(paper) = row.paper {
                plot.mark(&row.scene, Entry::papers("paper", "the paper's"), (quantity.papers)(paper));
            }
        }
        plot
    };
    QUANTITIES.iter().map(plot).collect()
}

/// Returns a table of all figures, then of their means.
fn figures(run: &RunReport) -> Table {
    let columns = [
        "<scene",
        "triangles",
        "<method",
        "PSNR, dB",
        "SSIM",
        "SSIM 7x7",
        "same image: PSNR",
        "SSIM",
        "SSIM 7x7",
        "frame, ms",
        "two renders, ms",
        "ratio",
        "<the paper's scene",
        "PSNR",
        "SSIM",
        "ratio",
    ];
    let mut table = Table::new("All figures", &columns);
    let quality = |quality: &Quality, cell: fn(Option<String>) -> Cell| {
        let Quality { psnr, ssim_gaussian, ssim_uniform, .. } = quality;
        [psnr.to_string(), format!("{ssim_gaussian:.4}"), format!("{ssim_uniform:.4}")]
            .map(|text| cell(Some(text)))
    };
    let papers = |scene: Option<&PaperScene>| {
        let figures = |scene: &PaperScene| {
            let name = if scene.name.is_empty() { "average" } else { &scene.name };
            [
                name.into(),
                format!("{:.2}", scene.psnr),
                format!("{:.4}", scene.ssim),
                format!("{:.2}", scene.frame_time_ratio()),
            ]
        };
        let texts = scene.map(figures).map_or([const { None }; 4], |texts| texts.map(Some));
        texts.map(Cell::paper)
    };
    let rows = run.rows();
    for (i, row) in rows.iter().enumerate() {
        let mut cells =
            vec![Cell::plain(&row.scene), Cell::plain(short_count(row.triangles)), Cell::plain(&row.method)];
        cells.extend(quality(&row.quality, Cell::ours));
        cells.extend(quality(&row.same_image, Cell::base));
        cells.push(Cell::plain(format!("{:.1}", row.frame_ms)));
        cells.push(Cell::base(Some(format!("{:.1}", row.conventional_ms))));
        cells.push(Cell::ours(Some(format!("{:.2}", row.cost_ratio))));
        cells.extend(papers(row.paper));
        table.push_grouped(cells, i == 0 || rows[i - 1].scene != row.scene);
    }
    for (i, mean) in run.means().into_iter().enumerate() {
        let mut cells =
            vec![Cell::plain(format!("mean of {}", mean.scenes)), Cell::plain(""), Cell::plain(&mean.method)];
        cells.extend(quality(&mean.quality, Cell::ours));
        cells.extend(quality(&mean.same_image, Cell::base));
        cells.extend([Cell::plain(""), Cell::plain(""), Cell::ours(Some(format!("{:.2}", mean.cost_ratio)))]);
        cells.extend(papers(Some(&PAPER.average)));
        table.push_grouped(cells, i == 0);
    }
    table
}

/// Returns a table of the time of each pass of two full renders and of each method.
fn passes(scene: &SceneReport) -> Table {
    let methods = scene.methods.iter().map(|method| (method.method.as_str(), &method.cost));
    let columns: Vec<_> = std::iter::once(("two full renders", &scene.conventional)).chain(methods).collect();
    let mut heads = vec!["<pass, ms"];
    heads.extend(columns.iter().map(|(name, _)| *name));
    let mut table = Table::new(format!("{}: time of each pass", scene.name), &heads);
    for pass in unique(columns.iter().flat_map(|(_, cost)| &cost.passes).map(|pass| pass.name.as_str())) {
        let mut cells = vec![Cell::plain(pass)];
        cells.extend(columns.iter().enumerate().map(|(i, (_, cost))| {
            let ms =
                cost.passes.iter().find(|other| other.name == pass).map(|pass| format!("{:.2}", pass.ms));
            if i == 0 { Cell::base(ms) } else { Cell::ours(ms) }
        }));
        table.push(cells);
    }
    let mut frames = vec![Cell::plain("a stereo frame (median; standard deviation, p95)")];
    frames.extend(columns.iter().map(|(_, cost)| {
        let ms = &cost.frame_ms;
        Cell::plain(format!("{:.1} ({:.1}, {:.1})", ms.median, ms.std, ms.p95))
    }));
    table.push_first(frames);
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::tests::synthetic;

    #[test]
    fn every_figure_has_its_baseline() {
        let run = synthetic(24, 3);
        let table = figures(&run);
        for (row, line) in run.rows().iter().zip(&table.lines) {
            let texts: Vec<&str> = line.cells.iter().map(|cell| cell.text.as_str()).collect();
            assert_eq!((texts[0], texts[2]), (row.scene.as_str(), row.method.as_str()));
            let figures = [
                row.quality.psnr.to_string(),
                format!("{:.4}", row.quality.ssim_gaussian),
                format!("{:.4}", row.quality.ssim_uniform),
                row.same_image.psnr.to_string(),
                format!("{:.4}", row.same_image.ssim_gaussian),
                format!("{:.4}", row.same_image.ssim_uniform),
                format!("{:.1}", row.frame_ms),
                format!("{:.1}", row.conventional_ms),
                format!("{:.2}", row.cost_ratio),
            ];
            assert_eq!(texts[3..12], figures.each_ref().map(String::as_str));
            assert_eq!(texts[14], format!("{:.4}", row.paper.unwrap().ssim));
        }
        assert_eq!(table.lines.len(), 6 + 2, "rows and means");
    }

    #[test]
    fn an_empty_or_perfect_run_renders() {
        let mut run = synthetic(24, 1);
        for viewpoint in &mut run.scenes[0].viewpoints {
            viewpoint.views[0].quality.psnr = yoro_metrics::Psnr(f64::INFINITY);
        }
        let html = report(&run).to_html().unwrap();
        // One of two viewpoints: the truth, two methods, the same image, and three error maps.
        assert!(html.contains("inf") && html.matches("src=\"data:image/jpeg;base64,").count() == 7);
        run.scenes.clear();
        assert!(report(&run).to_html().is_ok());
    }
}
