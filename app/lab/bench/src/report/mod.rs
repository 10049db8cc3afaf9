//! What the reports of `yoro run` and `yoro bench` consist of. This file has the report of `run`; [`crate::bench`] has that of
//! `bench`.
//!
//! Every figure is shown beside its baseline: quality beside "same image to both eyes" (which costs nothing), cost
//! beside two full renders. The paper's figures are marked as the paper's.

mod page;
mod run;
mod table;

use std::path::Path;

use serde::Serialize;

use yoro_report::paper::{PAPER, PaperScene};
use yoro_report::{ReportError, ReportFiles};

pub(crate) use page::pictures;
pub(crate) use run::{Cost, MethodCost, MethodMean, PassTime, QUALITY_METHOD, Row};
pub use run::{MethodView, RunReport, SceneReport, Viewpoint};

impl RunReport {
    /// Returns all figures as JSON, without the pictures.
    pub fn to_json(&self) -> Result<String, ReportError> {
        #[derive(Serialize)]
        struct Json<'a> {
            quality_method: &'static str,
            means: Vec<MethodMean>,
            paper_average: &'static PaperScene,
            rows: Vec<Row>,
            #[serde(flatten)]
            report: &'a RunReport,
        }
        Ok(serde_json::to_string_pretty(&Json {
            quality_method: QUALITY_METHOD,
            means: self.means(),
            paper_average: &PAPER.average,
            rows: self.rows(),
            report: self,
        })?)
    }

    /// Returns a short table for a terminal.
    pub fn to_text(&self) -> String {
        table::text(self)
    }

    /// Writes the page, the table and all figures into `folder`.
    pub fn write(&self, folder: &Path) -> Result<ReportFiles, ReportError> {
        page::report(self).write(folder, "report", Some(&self.to_json()?))
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::machine::{Machine, Parameter};
    use yoro::eyes::Eye;
    use yoro_report::stats::Summary;

    use image::{Rgb, RgbImage};

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

    /// Returns a report on images made from formulas; `size` is in pixels.
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
            let render = [("surfaces", two * 0.3), ("bloom", two * 0.15)];
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
}
