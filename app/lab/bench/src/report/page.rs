//! Pages: the data for the templates, with embedded pictures.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use minijinja::context;
use rayon::prelude::*;
use serde::Serialize;

use super::error::ReportError;
use super::run::{PassTime, QUALITY_METHOD, Row, RunReport, SceneReport, Viewpoint};
use yoro_media::encode_jpeg;
use yoro_metrics::Quality;
use yoro_report::page::{Template, figures, fill};
use yoro_report::paper;
use yoro_report::plot::{Axis, DotRow, Figure, Mark, Panel};
use yoro_report::text::short_count;

const TEMPLATE: Template = Template { name: "run.html.j2", text: include_str!("templates/run.html.j2") };

/// The largest number of bytes, in base64, of all pictures on a page.
pub(super) const PICTURE_BUDGET: usize = 14 << 20;

/// Encodings that are tried in order until the pictures fit: JPEG quality, and how often photographs are halved.
const LADDER: [(u8, u32); 7] = [(90, 0), (84, 0), (76, 0), (66, 0), (80, 1), (66, 1), (66, 2)];

/// Error maps are blurred by SSIM's window, so that half the size shows as much.
const MAP_HALVINGS: u32 = 1;

pub(super) fn render(report: &RunReport) -> Result<String, ReportError> {
    render_within(report, PICTURE_BUDGET)
}

fn render_within(report: &RunReport, budget: usize) -> Result<String, ReportError> {
    let viewpoints = report.scenes.iter().map(|scene| &scene.viewpoints[..]).collect::<Vec<_>>();
    let pictures = Pictures::encode(&viewpoints, budget)?;
    let rows = report.rows();
    let means = report.means();
    let page = context! {
        report => context! {
            machine => &report.machine,
            parameters => &report.parameters,
            timing_method => &report.timing_method,
        },
        quality_method => QUALITY_METHOD,
        picture_note => pictures.note,
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
        figures => figures(&plots(report))?,
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
    };
    Ok(fill(TEMPLATE, &report.title, page)?)
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

/// A picture that the page's flick switch shows.
#[derive(Serialize)]
struct View {
    label: String,
    /// One of `truth`, `method`, `same` and `map`.
    kind: &'static str,
    /// The similarity to the ground truth; `None` for the ground truth itself.
    quality: Option<QualityText>,
    src: String,
}

#[derive(Serialize)]
pub(super) struct ViewpointPictures {
    name: String,
    dominant_eye: &'static str,
    other_eye: &'static str,
    /// The size in pixels of the views as rendered.
    width: u32,
    height: u32,
    views: Vec<View>,
}

pub(super) struct Pictures {
    /// The first viewpoints of each scene.
    pub scenes: Vec<Vec<ViewpointPictures>>,
    /// A sentence about how the pictures were encoded.
    pub note: String,
}

/// The number of viewpoints per scene with pictures on the page. More would have to be shrunk to keep the page small.
const PICTURED_VIEWPOINTS: usize = 1;

impl Pictures {
    /// Encodes the pictures of each scene's viewpoints, within a budget of bytes for all.
    pub fn encode(scenes: &[&[Viewpoint]], budget: usize) -> Result<Pictures, ReportError> {
        let mut fitting = None;
        for (quality, halvings) in LADDER {
            let encoded: Vec<Vec<ViewpointPictures>> = scenes
                .iter()
                .map(|viewpoints| {
                    let pictured = viewpoints.par_iter().take(PICTURED_VIEWPOINTS);
                    pictured.map(|v| viewpoint_pictures(v, quality, halvings)).collect()
                })
                .collect::<Result<_, image::ImageError>>()?;
            let bytes: usize = encoded
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
            fitting = Some(Pictures { scenes: encoded, note });
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

/// Returns the passes of two full renders and of each method, with bars on one scale.
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

/// A quantity of the rows that is plotted.
struct Quantity {
    id: &'static str,
    title: &'static str,
    caption: &'static str,
    ours: fn(&Row) -> f64,
    baseline: fn(&Row) -> Option<f64>,
    papers: fn(&paper::PaperScene) -> f64,
    /// The baseline, if all rows have the same one.
    line_at: Option<f64>,
}

const QUANTITIES: [Quantity; 3] = [
    Quantity {
        id: "ssim",
        title: "SSIM, gaussian 11x11 (more is better)",
        caption: "Baseline: the same image to both eyes (ring). The paper's for its own scene.",
        ours: |row| row.quality.ssim_gaussian,
        baseline: |row| Some(row.same_image.ssim_gaussian),
        papers: |paper| paper.ssim,
        line_at: None,
    },
    Quantity {
        id: "psnr",
        title: "PSNR, dB (more is better)",
        caption: "Baseline: the same image to both eyes (ring). The paper's for its own scene.",
        ours: |row| row.quality.psnr.0,
        baseline: |row| Some(row.same_image.psnr.0),
        papers: |paper| paper.psnr,
        line_at: None,
    },
    Quantity {
        id: "ratio",
        title: "Frame time / two renders (less is better)",
        caption: "Baseline: two full renders = 1. The paper's: frame rates of seven devices.",
        ours: |row| row.cost_ratio,
        baseline: |_| None,
        papers: paper::PaperScene::frame_time_ratio,
        line_at: Some(1.0),
    },
];

fn plots(report: &RunReport) -> Vec<Figure> {
    let figure = |quantity: &Quantity| {
        let axis = Axis::new(quantity.title);
        let value = quantity.line_at.map_or(axis.clone(), |line| axis.baseline(line));
        let rows = report.scenes.iter().map(|scene| dot_row(scene, quantity)).collect();
        Figure {
            id: quantity.id.into(),
            title: quantity.title.into(),
            caption: quantity.caption.into(),
            panel: Panel::Dots { value, rows },
        }
    };
    QUANTITIES.iter().map(figure).collect()
}

fn dot_row(scene: &SceneReport, quantity: &Quantity) -> DotRow {
    let rows = scene.rows();
    let mut marks = Vec::new();
    if let Some(row) = rows.first() {
        let paper = row.paper.as_ref().map(|paper| (quantity.papers)(paper));
        marks.extend(paper.map(|value| Mark::papers("paper", "the paper's", value)));
        marks.extend((quantity.baseline)(row).map(|value| Mark::new("same image", "same image", value)));
    }
    // The first method is drawn on top of others with equal figures.
    let ours = rows.iter().rev();
    marks.extend(ours.map(|row| Mark::new(&row.method, &row.method, (quantity.ours)(row))));
    DotRow { label: scene.name.clone(), marks }
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
        // One of two viewpoints: the truth, two methods, the same image, and three error maps.
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
    fn an_empty_or_perfect_run_renders() {
        let mut report = synthetic(24, 1);
        for viewpoint in &mut report.scenes[0].viewpoints {
            viewpoint.views[0].quality.psnr = yoro_metrics::Psnr(f64::INFINITY);
        }
        assert!(report.to_html().unwrap().contains("inf"));
        report.scenes.clear();
        assert!(report.to_html().is_ok());
    }
}
