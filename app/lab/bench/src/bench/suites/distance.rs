//! Quality by the distance of an object

use super::super::Experiment;
use super::super::contender::Contender;
use super::super::frames::{self, FrameMeasures};
use super::super::job::{Choices, Job, Source};
use super::super::results::SuiteData;
use super::super::runner::Runner;
use super::super::scenes::LazyObject;
use super::super::tables::Sweep;
use yoro_render::PreparedScene;
use yoro_report::paper::DISTANCE;
use yoro_report::{Axis, Section};

/// Quality by the distance of an object.
pub struct Distance;

impl Experiment for Distance {
    fn name(&self) -> &'static str {
        "distance"
    }

    fn about(&self) -> &'static str {
        "Quality as an object, equally large on the screen, moves from 0.5 to 3 m"
    }

    fn jobs(&'static self, choices: &Choices, object: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let metres: &[f32] = choices.long_or_quick(&[0.5, 1.0, 1.5, 2.0, 2.5, 3.0], &[0.5, 1.0, 3.0]);
        let contenders = choices.contenders(self.name(), Contender::synthesis(), &Contender::BASELINES)?;
        let scenes = vec![object.name.clone()];
        Ok(choices.sweep(self, scenes, metres.iter().copied(), |job, metres| {
            job.contenders.clone_from(&contenders);
            job.source = Source::Object(metres);
            job.conditions.point = Some(f64::from(metres));
        }))
    }

    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        frames::measure(runner, job, scene, FrameMeasures { cost: false, quality: true, pictures: false })
    }

    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        let [ssim, psnr] = DISTANCE;
        let mut section = Section::new(
            "Distance of the object",
            format!(
                "Quality against the distance of one irregular object, scaled so that it keeps its size on the screen. \
                 The paper shows its curve as a picture only; its text says SSIM {ssim} and {psnr} dB for 0.5 to 3 m."
            ),
        );
        let sweep = Sweep { axis: Axis::new("distance, m"), text: |point| format!("{point}") };
        sweep.show_quality(&mut section, suite, &[]);
        vec![section]
    }
}
