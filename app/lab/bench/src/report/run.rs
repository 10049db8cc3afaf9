//! The results of `yoro run`, as data.

use image::RgbImage;
use serde::Serialize;

use crate::machine::{Machine, Parameter};
use yoro::eyes::Eye;
use yoro_metrics::{Channels, MetricsError, Quality, error_map};
use yoro_report::paper::{self, PaperScene};
use yoro_report::stats::{Summary, geometric_mean, unique};

/// Explains how quality is measured; printed wherever it is shown.
pub const QUALITY_METHOD: &str = "PSNR in dB over red, green and blue, data range 255. SSIM as the mean of red, \
green and blue: gaussian window 11x11, sigma 1.5 (Wang et al. 2004), and uniform window 7x7 (scikit-image's \
default). The reference is the same eye, really rendered. Error maps show 1 - SSIM (gaussian) from 0, black, to \
1, pale yellow.";

/// Everything that a run measured.
#[derive(Clone, Debug, Serialize)]
pub struct RunReport {
    /// The heading of the page.
    pub title: String,
    /// Machine, date and command.
    pub machine: Machine,
    /// The configuration with defaults filled in, in the order of printing.
    pub parameters: Vec<Parameter>,
    /// Explains how frame times are measured: rounds, warm-up, interleaving, what a frame includes.
    pub timing_method: String,
    /// The scenes in the order of printing.
    pub scenes: Vec<SceneReport>,
}

/// The pictures and figures of one scene.
#[derive(Clone, Debug, Serialize)]
pub struct SceneReport {
    /// The scene's name.
    pub name: String,
    /// The paper's name of the scene that it corresponds to, or empty.
    pub(crate) stands_for: String,
    pub(crate) triangles: u64,
    pub(crate) conventional: Cost,
    pub(crate) methods: Vec<MethodCost>,
    /// The viewpoints, at least one, each with one view per method.
    pub viewpoints: Vec<Viewpoint>,
}

/// The cost of a stereo frame.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Cost {
    pub frame_ms: Summary,
    /// The passes in the order in which they run.
    pub passes: Vec<PassTime>,
}

/// The time of one pass.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct PassTime {
    /// The name of the pass, as in the timers.
    pub name: String,
    pub ms: f64,
}

/// The cost of a stereo frame with one method.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct MethodCost {
    pub method: String,
    #[serde(flatten)]
    pub cost: Cost,
}

/// One camera pose, with its pictures and their quality. The JSON does not contain the pictures.
#[derive(Clone, Debug, Serialize)]
pub struct Viewpoint {
    /// A short name, such as `pose 3`.
    pub name: String,
    /// The eye that was rendered for the synthesis.
    pub dominant_eye: Eye,
    /// The image of that eye.
    #[serde(skip)]
    pub dominant: RgbImage,
    /// A real render of the other eye.
    #[serde(skip)]
    pub ground_truth: RgbImage,
    /// The similarity of the dominant eye's image to the ground truth, which is the score of showing it to both eyes.
    pub same_image: Quality,
    /// The error map of the dominant eye's image.
    #[serde(skip)]
    pub same_image_error: RgbImage,
    /// The other eye as made by each method.
    pub views: Vec<MethodView>,
}

/// An eye made by a method.
#[derive(Clone, Debug, Serialize)]
pub struct MethodView {
    /// The method's name, as in the costs.
    pub method: String,
    /// The synthesized eye.
    #[serde(skip)]
    pub eye: RgbImage,
    /// Its error map.
    #[serde(skip)]
    pub error: RgbImage,
    /// The similarity to the ground truth.
    pub quality: Quality,
}

impl Viewpoint {
    /// Measures the images of one pose. All have the same size, with row 0 at the top. `synthesized` is the other eye
    /// as made by each method, by name.
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

/// The figures of one method in one scene, as means over its viewpoints, with their baselines.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Row {
    pub scene: String,
    pub triangles: u64,
    pub method: String,
    pub quality: Quality,
    /// The baseline for quality: the same image for both eyes.
    pub same_image: Quality,
    /// The median time of a stereo frame in milliseconds.
    pub frame_ms: f64,
    /// The baseline for cost: the median time of two full renders in milliseconds.
    pub conventional_ms: f64,
    pub cost_ratio: f64,
    /// The paper's figures for the scene that this one corresponds to.
    pub paper: Option<&'static PaperScene>,
}

/// The figures of one method over all scenes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct MethodMean {
    pub method: String,
    /// The number of scenes with results of the method.
    pub scenes: usize,
    /// The mean quality over the scenes.
    pub quality: Quality,
    /// The baseline: the mean over the same scenes of showing the same image to both eyes.
    pub same_image: Quality,
    /// The geometric mean over the scenes of the frame time divided by that of two full renders.
    pub cost_ratio: f64,
}

impl RunReport {
    /// Returns one row for each method in each scene, in the order of the report. A method without a view of a scene
    /// has no row for it.
    pub(crate) fn rows(&self) -> Vec<Row> {
        self.scenes.iter().flat_map(SceneReport::rows).collect()
    }

    /// Returns the means of the rows, with the methods in the order of first occurrence.
    pub(crate) fn means(&self) -> Vec<MethodMean> {
        let rows = self.rows();
        let methods = unique(rows.iter().map(|row| row.method.as_str()));
        let mean = |method: &str| {
            let rows: Vec<&Row> = rows.iter().filter(|row| row.method == method).collect();
            Some(MethodMean {
                method: method.to_string(),
                scenes: rows.len(),
                quality: Quality::mean(rows.iter().map(|row| &row.quality))?,
                same_image: Quality::mean(rows.iter().map(|row| &row.same_image))?,
                cost_ratio: geometric_mean(rows.iter().map(|row| row.cost_ratio))?,
            })
        };
        methods.into_iter().filter_map(mean).collect()
    }
}

impl SceneReport {
    /// Returns one row for each method that made a view of this scene.
    pub(super) fn rows(&self) -> Vec<Row> {
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
                paper: paper::find(&self.stands_for),
            })
        };
        self.methods.iter().filter_map(row).collect()
    }
}

fn view_of<'a>(viewpoint: &'a Viewpoint, method: &str) -> Option<&'a MethodView> {
    viewpoint.views.iter().find(|view| view.method == method)
}
