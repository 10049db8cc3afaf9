//! What `yoro run` and `yoro bench` found, as self-contained pages, as JSON, as Markdown tables and as a table for
//! the terminal. This file has the report of `run`; [`mod@bench`] has that of `bench`.
//!
//! Every figure stands beside its baseline: quality beside "same image to both eyes" (which costs nothing), cost
//! beside two full renders. The paper's figures are marked as the paper's.

pub mod bd_rate;
pub mod bench;
pub mod grid;
pub(crate) mod page;
mod palette;
pub mod paper;
pub mod plot;
mod table;

use std::path::{Path, PathBuf};

use image::RgbImage;
use serde::{Deserialize, Serialize};

use crate::eyes::Eye;
use crate::files::{self, FileError};
use crate::metrics::stats::Summary;
use crate::metrics::{Channels, MetricsError, Quality, error_map};
use paper::PaperScene;

/// How the quality figures are made; printed wherever they are.
pub const QUALITY_METHOD: &str = "PSNR in dB over red, green and blue, data range 255. SSIM as the mean of red, \
green and blue: gaussian window 11x11, sigma 1.5 (Wang et al. 2004), and uniform window 7x7 (scikit-image's \
default). The reference is the same eye, really rendered. Error maps show 1 - SSIM (gaussian) from 0, black, to \
1, pale yellow.";

/// Why a report could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A picture could not be encoded.
    #[error("cannot encode a picture of the report: {0}")]
    Picture(#[from] image::ImageError),
    /// The template and the data do not fit.
    #[error("cannot fill in the report's template: {0}")]
    Template(#[from] minijinja::Error),
    /// A figure could not be drawn.
    #[error(transparent)]
    Plot(#[from] plot::PlotError),
    /// A file of results has nothing to report.
    #[error("{} holds no finished round: let yoro bench finish one, then report", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// A picture that a run saved cannot be used.
    #[error(transparent)]
    PictureFile(#[from] crate::picture::PictureError),
    /// The pictures of a setting do not go together.
    #[error("the pictures in {} do not go together ({source}): measure again, or remove the folder", path.display())]
    Sizes {
        /// The folder.
        path: PathBuf,
        /// What is wrong.
        source: MetricsError,
    },
    /// The figures cannot be written as JSON.
    #[error("cannot write the report as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

/// All that one run measured.
#[derive(Clone, Debug, Serialize)]
pub struct RunReport {
    /// Heading of the page.
    pub title: String,
    /// Where and how it ran.
    pub machine: Machine,
    /// The resolved configuration, in the order to be printed.
    pub parameters: Vec<Parameter>,
    /// How frame times were taken: rounds, warm-up, interleaving, what a frame includes.
    pub timing_method: String,
    /// In the order to be printed.
    pub scenes: Vec<SceneReport>,
}

/// Where and how a run took place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Model name of the processor.
    pub cpu: String,
    /// Logical processors in use.
    pub cores: usize,
    /// Operating system.
    pub os: String,
    /// `GL_RENDERER`.
    pub gl_renderer: String,
    /// `GL_VERSION`.
    pub gl_version: String,
    /// Version of yoro, with the commit if known.
    pub yoro: String,
    /// Date and time, ISO 8601.
    pub date: String,
    /// The command that repeats the run.
    pub command: String,
}

/// One setting of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Its name, with the unit.
    pub name: String,
    /// Its value.
    pub value: String,
}

/// One scene: pictures and figures.
#[derive(Clone, Debug, Serialize)]
pub struct SceneReport {
    /// The scene's name.
    pub name: String,
    /// The scene of the paper that it stands for, by the paper's name; empty if for none.
    pub stands_for: String,
    /// Triangles in the whole scene.
    pub triangles: u64,
    /// Two full renders.
    pub conventional: Cost,
    /// The methods that synthesize an eye.
    pub methods: Vec<MethodCost>,
    /// At least one; each with one view for each method.
    pub viewpoints: Vec<Viewpoint>,
}

/// What a stereo frame costs.
#[derive(Clone, Debug, Serialize)]
pub struct Cost {
    /// Time of a whole stereo frame in milliseconds.
    pub frame_ms: Summary,
    /// Its passes in order.
    pub passes: Vec<PassTime>,
}

/// Time of one pass.
#[derive(Clone, Debug, Serialize)]
pub struct PassTime {
    /// The pass's name, as in the timers.
    pub name: String,
    /// Median in milliseconds.
    pub ms: f64,
}

/// What a stereo frame costs by a method.
#[derive(Clone, Debug, Serialize)]
pub struct MethodCost {
    /// The method's name.
    pub method: String,
    /// Its cost.
    #[serde(flatten)]
    pub cost: Cost,
}

/// One camera pose: the pictures and their quality. Pictures are not part of the JSON.
#[derive(Clone, Debug, Serialize)]
pub struct Viewpoint {
    /// A short name, such as `pose 3`.
    pub name: String,
    /// Which eye was rendered for the synthesis.
    pub dominant_eye: Eye,
    /// That eye.
    #[serde(skip)]
    pub dominant: RgbImage,
    /// The other eye, really rendered.
    #[serde(skip)]
    pub ground_truth: RgbImage,
    /// Likeness of the dominant eye's image to the ground truth: what showing it to both eyes would score.
    pub same_image: Quality,
    /// Error map of the same.
    #[serde(skip)]
    pub same_image_error: RgbImage,
    /// The other eye as each method makes it.
    pub views: Vec<MethodView>,
}

/// An eye made by a method.
#[derive(Clone, Debug, Serialize)]
pub struct MethodView {
    /// The method's name, as in [`MethodCost`].
    pub method: String,
    /// The synthesized eye.
    #[serde(skip)]
    pub eye: RgbImage,
    /// Its error map.
    #[serde(skip)]
    pub error: RgbImage,
    /// Its likeness to the ground truth.
    pub quality: Quality,
}

impl Viewpoint {
    /// Measures the images of one pose. All have one size and row 0 at the top; `synthesized` is the other eye as
    /// each method (by name) makes it.
    pub fn measure(
        name: impl Into<String>,
        dominant_eye: Eye,
        dominant: RgbImage,
        ground_truth: RgbImage,
        synthesized: Vec<(String, RgbImage)>,
    ) -> Result<Viewpoint, MetricsError> {
        let views = synthesized.into_iter().map(|(method, eye)| {
            let quality = Quality::of(&eye, &ground_truth, Channels::Rgb)?;
            let error = error_map(&eye, &ground_truth)?;
            Ok(MethodView { method, eye, error, quality })
        });
        let views = views.collect::<Result<Vec<_>, MetricsError>>()?;
        Ok(Viewpoint {
            name: name.into(),
            dominant_eye,
            same_image: Quality::of(&dominant, &ground_truth, Channels::Rgb)?,
            same_image_error: error_map(&dominant, &ground_truth)?,
            dominant,
            ground_truth,
            views,
        })
    }
}

/// The figures of one method on one scene, means over its viewpoints, with their baselines.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The scene's name.
    pub scene: String,
    /// Its triangles.
    pub triangles: u64,
    /// The method's name.
    pub method: String,
    /// Quality of the synthesized eye.
    pub quality: Quality,
    /// Baseline of the quality: the same image to both eyes.
    pub same_image: Quality,
    /// Median time of a stereo frame in milliseconds.
    pub frame_ms: f64,
    /// Baseline of the cost: median time of two full renders in milliseconds.
    pub conventional_ms: f64,
    /// `frame_ms / conventional_ms`.
    pub cost_ratio: f64,
    /// The paper's figures of the scene that this one stands for.
    pub paper: Option<PaperScene>,
}

/// The figures of one method over all scenes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MethodMean {
    /// The method's name.
    pub method: String,
    /// Scenes that it ran on.
    pub scenes: usize,
    /// Mean over the scenes.
    pub quality: Quality,
    /// Baseline: the same image to both eyes, mean over the same scenes.
    pub same_image: Quality,
    /// Geometric mean over the scenes of the frame time over two full renders.
    pub cost_ratio: f64,
}

impl RunReport {
    /// One row for each method on each scene, in the report's order. A method without any view of a scene has no
    /// row there.
    pub fn rows(&self) -> Vec<Row> {
        self.scenes.iter().flat_map(SceneReport::rows).collect()
    }

    /// The means of the rows, in the order in which the methods first occur.
    pub fn means(&self) -> Vec<MethodMean> {
        let rows = self.rows();
        let mut methods: Vec<&str> = Vec::new();
        for row in &rows {
            if !methods.contains(&row.method.as_str()) {
                methods.push(&row.method);
            }
        }
        let mean = |method: &str| {
            let rows: Vec<&Row> = rows.iter().filter(|row| row.method == method).collect();
            let logs: f64 = rows.iter().map(|row| row.cost_ratio.ln()).sum();
            Some(MethodMean {
                method: method.to_string(),
                scenes: rows.len(),
                quality: Quality::mean(rows.iter().map(|row| &row.quality))?,
                same_image: Quality::mean(rows.iter().map(|row| &row.same_image))?,
                cost_ratio: (logs / rows.len() as f64).exp(),
            })
        };
        methods.into_iter().filter_map(mean).collect()
    }

    /// All figures, without the pictures.
    pub fn to_json(&self) -> Result<String, ReportError> {
        #[derive(Serialize)]
        struct Json<'a> {
            quality_method: &'static str,
            means: Vec<MethodMean>,
            paper_average: PaperScene,
            rows: Vec<Row>,
            #[serde(flatten)]
            report: &'a RunReport,
        }
        Ok(serde_json::to_string_pretty(&Json {
            quality_method: QUALITY_METHOD,
            means: self.means(),
            paper_average: paper::AVERAGE,
            rows: self.rows(),
            report: self,
        })?)
    }

    /// The self-contained page.
    pub fn to_html(&self) -> Result<String, ReportError> {
        page::render(self)
    }

    /// A table of all rows and means, for a README.
    pub fn to_markdown(&self) -> String {
        table::markdown(self)
    }

    /// A short table for a terminal.
    pub fn to_text(&self) -> String {
        table::text(self)
    }

    /// Writes `report.html`, `report.json` and `report.md` (the table) into `folder` and returns the path of the
    /// page.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, ReportError> {
        let page = folder.join("report.html");
        files::write(&page, self.to_html()?.as_bytes())?;
        files::write(&folder.join("report.json"), self.to_json()?.as_bytes())?;
        files::write(&folder.join("report.md"), self.to_markdown().as_bytes())?;
        Ok(page)
    }
}

impl SceneReport {
    fn rows(&self) -> Vec<Row> {
        let row = |method: &MethodCost| {
            let of_method = |viewpoint| view_of(viewpoint, &method.method);
            let (frame_ms, conventional_ms) =
                (method.cost.frame_ms.median, self.conventional.frame_ms.median);
            Some(Row {
                scene: self.name.clone(),
                triangles: self.triangles,
                method: method.method.clone(),
                quality: Quality::mean(
                    self.viewpoints.iter().filter_map(of_method).map(|view| &view.quality),
                )?,
                same_image: Quality::mean(self.viewpoints.iter().map(|viewpoint| &viewpoint.same_image))?,
                frame_ms,
                conventional_ms,
                cost_ratio: frame_ms / conventional_ms,
                paper: paper::find(&self.stands_for).copied(),
            })
        };
        self.methods.iter().filter_map(row).collect()
    }
}

fn view_of<'a>(viewpoint: &'a Viewpoint, method: &str) -> Option<&'a MethodView> {
    viewpoint.views.iter().find(|view| view.method == method)
}

/// `19.6 k`, `2.80 M`.
fn short_count(count: u64) -> String {
    match count {
        0..1_000 => count.to_string(),
        1_000..100_000 => format!("{:.1} k", count as f64 / 1e3),
        100_000..1_000_000 => format!("{:.0} k", count as f64 / 1e3),
        _ => format!("{:.2} M", count as f64 / 1e6),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use image::Rgb;

    fn picture(size: u32, shift: f64, frequency: f64) -> RgbImage {
        RgbImage::from_fn(size, size, |x, y| {
            let (u, v) = ((f64::from(x) + shift) / f64::from(size), f64::from(y) / f64::from(size));
            let wave = |p: f64| (127.5 + 127.5 * (frequency * u * (1.0 + p) + 9.0 * v * v + p).sin()) as u8;
            Rgb([wave(0.0), wave(0.7), wave(1.9)])
        })
    }

    fn cost(milliseconds: f64, passes: &[(&str, f64)]) -> Cost {
        let samples: Vec<f64> = (-2..=2).map(|i| milliseconds * (1.0 + 0.01 * f64::from(i))).collect();
        let passes = passes.iter().map(|(name, ms)| PassTime { name: name.to_string(), ms: *ms }).collect();
        Cost { frame_ms: Summary::of(&samples).unwrap(), passes }
    }

    /// A report on images made by formulas; `size` in pixels.
    pub(crate) fn synthetic(size: u32, scenes: usize) -> RunReport {
        let names = ["street <b>&\"café\"</b>", "atrium | columns", "voxel landscape", "stage"];
        let scene = |index: usize| {
            let frequency = 20.0 + 15.0 * index as f64;
            let viewpoint = |pose: usize| {
                let truth = picture(size, pose as f64 * 31.0, frequency);
                let warped = |error: f64| picture(size, pose as f64 * 31.0 + error, frequency);
                Viewpoint::measure(
                    format!("pose {pose}"),
                    if index == 1 { Eye::Left } else { Eye::Right },
                    warped(4.0),
                    truth,
                    vec![("gather".into(), warped(0.1)), ("paper 1/1".into(), warped(0.4))],
                )
                .unwrap()
            };
            let two = 80.0 + 60.0 * index as f64;
            let render = [("g-buffer", two * 0.3), ("lighting", two * 0.15)];
            let with = |name: &'static str, ms: f64| [render[0], render[1], (name, ms)];
            SceneReport {
                name: names[index % 4].into(),
                stands_for: ["Bistro", "Sponza", "LostEmpire", ""][index % 4].into(),
                triangles: 26_400 * 10u64.pow(index as u32 % 3),
                conventional: cost(two, &render.map(|(name, ms)| (name, 2.0 * ms))),
                methods: vec![
                    MethodCost {
                        method: "gather".into(),
                        cost: cost(two * 0.53, &with("march", two * 0.05)),
                    },
                    MethodCost {
                        method: "paper 1/1".into(),
                        cost: cost(two * 0.63, &with("scatter", two * 0.12)),
                    },
                ],
                viewpoints: (0..2).map(viewpoint).collect(),
            }
        };
        RunReport {
            title: "yoro: one render, <two> eyes".into(),
            machine: Machine {
                cpu: "Example & Sons CPU".into(),
                cores: 2,
                os: "Linux".into(),
                gl_renderer: "llvmpipe (LLVM 15.0.6, 256 bits)".into(),
                gl_version: "OpenGL ES 3.2 Mesa".into(),
                yoro: "0.1.0".into(),
                date: "2025-01-01T12:00:00Z".into(),
                command: "yoro run --size 1024 --out 'a <b>'".into(),
            },
            parameters: vec![
                Parameter { name: "size per eye, pixels".into(), value: "1024x1024".into() },
                Parameter { name: "IPD, mm".into(), value: "63".into() },
            ],
            timing_method:
                "Median of 5 interleaved rounds after one warm-up frame; a frame ends with glFinish.".into(),
            scenes: (0..scenes).map(scene).collect(),
        }
    }

    #[test]
    fn rows_carry_their_baselines() {
        let report = synthetic(24, 2);
        let rows = report.rows();
        assert_eq!(rows.len(), 4);
        assert!((rows[0].cost_ratio - 0.53).abs() < 1e-9);
        assert_eq!(rows[0].paper.unwrap().name, "Bistro");
        let first = &report.scenes[0].viewpoints;
        let expected =
            (first[0].views[0].quality.ssim_gaussian + first[1].views[0].quality.ssim_gaussian) / 2.0;
        assert!((rows[0].quality.ssim_gaussian - expected).abs() < 1e-12);
        let expected = (first[0].same_image.psnr.0 + first[1].same_image.psnr.0) / 2.0;
        assert!((rows[0].same_image.psnr.0 - expected).abs() < 1e-9);
        let means = report.means();
        assert_eq!((means[0].method.as_str(), means[0].scenes), ("gather", 2));
        assert!((means[1].cost_ratio - 0.63).abs() < 1e-9);
    }

    #[test]
    fn json_has_every_figure_and_no_picture() {
        let json = synthetic(24, 1).to_json().unwrap();
        let value: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(value["rows"][0]["same_image"]["psnr"], value["rows"][1]["same_image"]["psnr"]);
        assert!(value["rows"][0]["quality"]["ssim_uniform"].is_f64());
        assert_eq!(value["scenes"][0]["methods"][1]["passes"][2]["name"], "scatter");
        assert!(value["scenes"][0]["viewpoints"][0].get("dominant").is_none());
        assert!(json.len() < 20_000);
    }

    #[test]
    fn counts_are_short() {
        assert_eq!([999, 19_640, 264_000, 2_804_000].map(short_count), ["999", "19.6 k", "264 k", "2.80 M"]);
    }

    #[test]
    fn files_are_written() {
        let folder = tempfile::tempdir().unwrap();
        let page = synthetic(24, 1).write(&folder.path().join("new")).unwrap();
        assert!(page.is_file() && page.with_extension("json").is_file());
    }
}
