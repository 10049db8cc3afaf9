//! The page: what the template `report.html.j2` needs, with pictures embedded.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use minijinja::{Environment, UndefinedBehavior, context};
use rayon::prelude::*;
use serde::Serialize;

use super::{
    PassTime, QUALITY_METHOD, ReportError, Row, RunReport, SceneReport, Viewpoint, paper, short_count,
};
use crate::metrics::Quality;
use crate::picture::encode_jpeg;

const TEMPLATE: &str = include_str!("report.html.j2");

/// What all pictures of a page may take, encoded in base64.
const PICTURE_BUDGET: usize = 14 << 20;

/// Tried in order until the pictures fit: JPEG quality, and how many times photographs are halved.
const LADDER: [(u8, u32); 7] = [(90, 0), (84, 0), (76, 0), (66, 0), (80, 1), (66, 1), (66, 2)];

/// Error maps are blurred by SSIM's window: half the size shows as much.
const MAP_HALVINGS: u32 = 1;

pub(super) fn render(report: &RunReport) -> Result<String, ReportError> {
    render_within(report, PICTURE_BUDGET)
}

fn render_within(report: &RunReport, budget: usize) -> Result<String, ReportError> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_trim_blocks(true);
    environment.set_lstrip_blocks(true);
    // The name's ending turns on HTML escaping.
    environment.add_template("report.html.j2", TEMPLATE)?;
    let pictures = Pictures::encode(report, budget)?;
    let rows = report.rows();
    let means = report.means();
    Ok(environment.get_template("report.html.j2")?.render(context! {
        report => context! {
            title => &report.title,
            machine => &report.machine,
            parameters => &report.parameters,
            timing_method => &report.timing_method,
        },
        quality_method => QUALITY_METHOD,
        picture_note => pictures.note,
        methods => means.iter().map(|mean| &mean.method).collect::<Vec<_>>(),
        rows => rows.iter().map(row_text).collect::<Vec<_>>(),
        means => means
            .iter()
            .map(|mean| context! {
                method => &mean.method,
                scenes => mean.scenes,
                quality => quality_text(&mean.quality),
                same_image => quality_text(&mean.same_image),
                ratio => format!("{:.2}", mean.cost_ratio),
            })
            .collect::<Vec<_>>(),
        paper_average => paper_text(&paper::AVERAGE),
        plots => plots(report, &rows),
        scenes => report
            .scenes
            .iter()
            .zip(pictures.scenes)
            .map(|(scene, viewpoints)| context! {
                name => &scene.name,
                stands_for => &scene.stands_for,
                triangles => short_count(scene.triangles),
                viewpoints => viewpoints,
                passes => pass_columns(scene),
            })
            .collect::<Vec<_>>(),
    })?)
}

#[derive(Serialize)]
struct QualityText {
    psnr: String,
    ssim_gaussian: String,
    ssim_uniform: String,
}

fn quality_text(quality: &Quality) -> QualityText {
    QualityText {
        psnr: quality.psnr.to_string(),
        ssim_gaussian: format!("{:.4}", quality.ssim_gaussian),
        ssim_uniform: format!("{:.4}", quality.ssim_uniform),
    }
}

fn paper_text(scene: &paper::PaperScene) -> minijinja::Value {
    context! {
        name => scene.name,
        psnr => format!("{:.2}", scene.psnr),
        ssim => format!("{:.4}", scene.ssim),
        ratio => format!("{:.2}", scene.frame_time_ratio()),
    }
}

fn row_text(row: &Row) -> minijinja::Value {
    context! {
        scene => &row.scene,
        triangles => short_count(row.triangles),
        method => &row.method,
        quality => quality_text(&row.quality),
        same_image => quality_text(&row.same_image),
        frame_ms => format!("{:.1}", row.frame_ms),
        conventional_ms => format!("{:.1}", row.conventional_ms),
        ratio => format!("{:.2}", row.cost_ratio),
        paper => row.paper.as_ref().map(paper_text),
    }
}

/// A picture in the flick switch.
#[derive(Serialize)]
struct View {
    label: String,
    /// `truth`, `method`, `same` or `map`.
    kind: &'static str,
    /// Likeness to the ground truth; none for the ground truth itself.
    quality: Option<QualityText>,
    src: String,
}

#[derive(Serialize)]
struct ViewpointPictures {
    name: String,
    dominant_eye: &'static str,
    other_eye: &'static str,
    /// Of the views as rendered, in pixels.
    width: u32,
    height: u32,
    views: Vec<View>,
}

struct Pictures {
    scenes: Vec<Vec<ViewpointPictures>>,
    note: String,
}

/// Viewpoints of each scene whose pictures are on the page: more would have to be shrunk to keep it small.
const PICTURED_VIEWPOINTS: usize = 1;

impl Pictures {
    fn encode(report: &RunReport, budget: usize) -> Result<Pictures, ReportError> {
        let mut fitting = None;
        for (quality, halvings) in LADDER {
            let scenes: Vec<Vec<ViewpointPictures>> = report
                .scenes
                .iter()
                .map(|scene| {
                    let pictured = scene.viewpoints.par_iter().take(PICTURED_VIEWPOINTS);
                    pictured.map(|v| viewpoint_pictures(v, quality, halvings)).collect()
                })
                .collect::<Result<_, image::ImageError>>()?;
            let bytes: usize = scenes
                .iter()
                .flatten()
                .flat_map(|viewpoint| &viewpoint.views)
                .map(|view| view.src.len())
                .sum();
            let size = match halvings {
                0 => String::new(),
                n => format!(", shrunk to 1/{} of their size", 1 << n),
            };
            let note = format!(
                "Pictures on this page are JPEG, quality {quality}{size}; error maps are shrunk to half. All \
                 figures were measured on the images as rendered."
            );
            fitting = Some(Pictures { scenes, note });
            if bytes <= budget {
                break;
            }
        }
        Ok(fitting.expect("the ladder has steps"))
    }
}

fn viewpoint_pictures(
    viewpoint: &Viewpoint,
    quality: u8,
    halvings: u32,
) -> Result<ViewpointPictures, image::ImageError> {
    let photo = |image: &RgbImage| data_uri(image, quality, halvings);
    let map = |image: &RgbImage| data_uri(image, quality, halvings.max(MAP_HALVINGS));
    let mut views = vec![View {
        label: "really rendered".into(),
        kind: "truth",
        quality: None,
        src: photo(&viewpoint.ground_truth)?,
    }];
    for view in &viewpoint.views {
        let (label, quality) = (view.method.clone(), Some(quality_text(&view.quality)));
        views.push(View { label, kind: "method", quality, src: photo(&view.eye)? });
    }
    let same = || Some(quality_text(&viewpoint.same_image));
    views.push(View {
        label: "same image".into(),
        kind: "same",
        quality: same(),
        src: photo(&viewpoint.dominant)?,
    });
    for view in &viewpoint.views {
        let (label, quality) = (format!("error: {}", view.method), Some(quality_text(&view.quality)));
        views.push(View { label, kind: "map", quality, src: map(&view.error)? });
    }
    views.push(View {
        label: "error: same image".into(),
        kind: "map",
        quality: same(),
        src: map(&viewpoint.same_image_error)?,
    });
    Ok(ViewpointPictures {
        name: viewpoint.name.clone(),
        dominant_eye: viewpoint.dominant_eye.name(),
        other_eye: viewpoint.dominant_eye.other().name(),
        width: viewpoint.ground_truth.width(),
        height: viewpoint.ground_truth.height(),
        views,
    })
}

fn data_uri(image: &RgbImage, quality: u8, halvings: u32) -> Result<String, image::ImageError> {
    let jpeg = match halvings {
        0 => encode_jpeg(image, quality)?,
        n => {
            let (width, height) = ((image.width() >> n).max(1), (image.height() >> n).max(1));
            encode_jpeg(&image::imageops::thumbnail(image, width, height), quality)?
        }
    };
    Ok(format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg)))
}

/// The passes of two full renders and of each method, with bars on one scale.
fn pass_columns(scene: &SceneReport) -> Vec<minijinja::Value> {
    let conventional = std::iter::once(("two full renders", &scene.conventional));
    let methods = scene.methods.iter().map(|method| (method.method.as_str(), &method.cost));
    let columns: Vec<_> = conventional.chain(methods).collect();
    let longest = columns.iter().flat_map(|(_, cost)| &cost.passes).map(|pass| pass.ms).fold(1e-9, f64::max);
    let line = |pass: &PassTime| {
        context! {
            name => &pass.name,
            ms => format!("{:.2}", pass.ms),
            percent => format!("{:.1}", 100.0 * pass.ms / longest),
        }
    };
    columns
        .iter()
        .map(|(name, cost)| {
            context! {
                name => name,
                median => format!("{:.1}", cost.frame_ms.median),
                std => format!("{:.1}", cost.frame_ms.std),
                p95 => format!("{:.1}", cost.frame_ms.p95),
                count => cost.frame_ms.count,
                ratio => format!("{:.2}", cost.frame_ms.median / scene.conventional.frame_ms.median),
                passes => cost.passes.iter().map(line).collect::<Vec<_>>(),
            }
        })
        .collect()
}

/// A dot plot with one line for each scene; positions in SVG units.
#[derive(Serialize)]
struct Plot {
    title: &'static str,
    caption: &'static str,
    height: u32,
    ticks: Vec<Tick>,
    lines: Vec<Line>,
}

#[derive(Serialize)]
struct Tick {
    x: f64,
    label: String,
    /// The baseline of the plot.
    strong: bool,
}

#[derive(Serialize)]
struct Line {
    y: u32,
    label: String,
    marks: Vec<Mark>,
}

#[derive(Serialize)]
struct Mark {
    x: f64,
    /// `same`, `paper`, or `m0`, `m1`, ... for the methods.
    class: String,
    title: String,
}

const LINE_HEIGHT: u32 = 24;
const PLOT_TOP: u32 = 10;
const PLOT_LEFT: f64 = 142.0;
const PLOT_WIDTH: f64 = 264.0;
/// Characters that fit to the left of a plot.
const PLOT_LABEL: usize = 17;

/// What a plot shows of a row.
struct Figure {
    title: &'static str,
    caption: &'static str,
    decimals: usize,
    ours: fn(&Row) -> f64,
    baseline: fn(&Row) -> Option<f64>,
    papers: fn(&paper::PaperScene) -> f64,
    /// Where all rows have the same baseline: a line there, and the axis starts at 0.
    line_at: Option<f64>,
}

const FIGURES: [Figure; 3] = [
    Figure {
        title: "SSIM, gaussian 11x11 (more is better)",
        caption: "Baseline: the same image to both eyes (ring).",
        decimals: 4,
        ours: |row| row.quality.ssim_gaussian,
        baseline: |row| Some(row.same_image.ssim_gaussian),
        papers: |paper| paper.ssim,
        line_at: None,
    },
    Figure {
        title: "PSNR, dB (more is better)",
        caption: "Baseline: the same image to both eyes (ring).",
        decimals: 2,
        ours: |row| row.quality.psnr.0,
        baseline: |row| Some(row.same_image.psnr.0),
        papers: |paper| paper.psnr,
        line_at: None,
    },
    Figure {
        title: "Frame time / two renders (less is better)",
        caption: "Baseline: two full renders = 1. The paper's: frame rates of seven devices.",
        decimals: 2,
        ours: |row| row.cost_ratio,
        baseline: |_| None,
        papers: paper::PaperScene::frame_time_ratio,
        line_at: Some(1.0),
    },
];

fn plots(report: &RunReport, rows: &[Row]) -> Vec<Plot> {
    FIGURES.iter().map(|figure| plot(report, rows, figure)).collect()
}

fn plot(report: &RunReport, rows: &[Row], figure: &Figure) -> Plot {
    let Figure { ours, baseline, papers, line_at, .. } = *figure;
    let of_row = |row: &Row| [Some(ours(row)), baseline(row), row.paper.as_ref().map(papers)];
    let values = rows.iter().flat_map(of_row).flatten().filter(|value| value.is_finite());
    let values = values.chain(line_at).chain(line_at.map(|_| 0.0));
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    let (low, high) = if low < high { (low, high) } else { (0.0, 1.0) };
    let step = tick_step(high - low);
    let (low, high) = ((low / step).floor() * step, (high / step).ceil() * step);
    // An infinite PSNR sticks to the right edge.
    let x = |value: f64| {
        let x = PLOT_LEFT + PLOT_WIDTH * ((value - low) / (high - low)).clamp(0.0, 1.0);
        (x * 10.0).round() / 10.0
    };
    let mark = |class: String, name: &str, value: f64| Mark {
        x: x(value),
        class,
        title: format!("{name}: {value:.0$}", figure.decimals),
    };
    let tick_decimals = (-step.log10().floor()).max(0.0) as usize;
    let ticks = (0..=((high - low) / step).round() as usize).map(|i| {
        let value = low + i as f64 * step;
        let strong = line_at.is_some_and(|line| (line - value).abs() < step * 1e-6);
        Tick { x: x(value), label: format!("{value:.tick_decimals$}"), strong }
    });
    let methods = report.means();
    let lines = report.scenes.iter().enumerate().map(|(index, scene)| {
        let rows: Vec<Row> = scene.rows();
        let mut marks = Vec::new();
        if let Some(row) = rows.first() {
            let paper = row.paper.as_ref();
            marks
                .extend(paper.map(|p| mark("paper".into(), &format!("the paper's ({})", p.name), papers(p))));
            marks.extend(baseline(row).map(|value| mark("same".into(), "same image to both eyes", value)));
        }
        // Of methods with equal figures the first stays on top.
        for row in rows.iter().rev() {
            let method = methods.iter().position(|mean| mean.method == row.method).unwrap_or(0);
            marks.push(mark(format!("m{}", method % 6), &row.method, ours(row)));
        }
        let y = PLOT_TOP + LINE_HEIGHT * index as u32 + LINE_HEIGHT / 2;
        Line { y, label: shortened(&scene.name, PLOT_LABEL), marks }
    });
    Plot {
        title: figure.title,
        caption: figure.caption,
        height: PLOT_TOP + LINE_HEIGHT * report.scenes.len() as u32,
        ticks: ticks.collect(),
        lines: lines.collect(),
    }
}

fn shortened(text: &str, length: usize) -> String {
    if text.chars().count() <= length {
        return text.to_string();
    }
    text.chars().take(length - 1).chain(['…']).collect()
}

/// 1, 2 or 5 times a power of ten: three to eight steps in `range`.
fn tick_step(range: f64) -> f64 {
    let power = 10f64.powf((range / 3.0).log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|m| m * power).find(|step| range / step >= 3.0).unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::tests::synthetic;

    #[test]
    fn text_is_escaped() {
        let html = synthetic(24, 2).to_html().unwrap();
        assert!(html.contains("street &lt;b&gt;&amp;&quot;café&quot;&lt;&#x2f;b&gt;"));
        assert!(!html.contains("<b>&\"café") && !html.contains("<two>"));
        assert!(html.contains("--out &#x27;a &lt;b&gt;&#x27;"), "the command is printed");
    }

    #[test]
    fn every_figure_has_its_baseline() {
        let report = synthetic(24, 3);
        let html = report.to_html().unwrap();
        let body = html.split("id=\"figures\"").nth(1).unwrap().split("</table>").next().unwrap();
        let lines: Vec<&str> = body.split("<tr").collect();
        for row in report.rows() {
            let scene = row.scene.chars().take(5).collect::<String>();
            let line = lines
                .iter()
                .find(|line| line.contains(&scene) && line.contains(&row.method.replace('/', "&#x2f;")))
                .unwrap_or_else(|| panic!("no row of {scene} {}", row.method));
            for figure in [
                row.quality.psnr.to_string(),
                format!("{:.4}", row.quality.ssim_gaussian),
                format!("{:.4}", row.quality.ssim_uniform),
                row.same_image.psnr.to_string(),
                format!("{:.4}", row.same_image.ssim_gaussian),
                format!("{:.4}", row.same_image.ssim_uniform),
                format!("{:.1}", row.frame_ms),
                format!("{:.1}", row.conventional_ms),
                format!("{:.2}", row.cost_ratio),
                format!("{:.4}", row.paper.unwrap().ssim),
            ] {
                assert!(line.contains(&figure), "{figure} is missing in {line}");
            }
        }
    }

    #[test]
    fn the_page_needs_nothing_from_elsewhere() {
        let html = synthetic(24, 1).to_html().unwrap();
        for foreign in ["http://", "https://", "<link", "url(", "@import", " src=\"/", "<script src"] {
            assert!(!html.contains(foreign), "{foreign}");
        }
        // One of two viewpoints, with the truth, two methods, the same image and three error maps.
        assert_eq!(html.matches("src=\"data:image/jpeg;base64,").count(), 7);
    }

    #[test]
    fn pictures_shrink_to_fit() {
        let report = synthetic(64, 1);
        let large = render_within(&report, usize::MAX).unwrap();
        let small = render_within(&report, large.len() / 4).unwrap();
        assert!(large.contains("JPEG, quality 90;"));
        assert!(small.len() < large.len() && !small.contains("quality 90"));
    }

    #[test]
    fn ticks_are_round_and_few() {
        for (range, step) in [(1.0, 0.2), (0.35, 0.1), (20.0, 5.0), (8.0, 2.0), (0.04, 0.01)] {
            assert!((tick_step(range) - step).abs() < 1e-12, "{range}: {}", tick_step(range));
        }
    }

    #[test]
    fn an_empty_or_perfect_run_renders() {
        let mut report = synthetic(24, 1);
        for viewpoint in &mut report.scenes[0].viewpoints {
            viewpoint.views[0].quality.psnr = crate::metrics::Psnr(f64::INFINITY);
        }
        assert!(report.to_html().unwrap().contains("inf"));
        report.scenes.clear();
        assert!(report.to_html().is_ok());
    }
}
