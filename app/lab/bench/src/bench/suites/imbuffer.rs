//! Cost and quality of smaller ImBuffers

use super::super::Experiment;
use super::super::contender::Contender;
use super::super::frames::{self, FrameMeasures};
use super::super::job::{Choices, Job};
use super::super::results::SuiteData;
use super::super::runner::Runner;
use super::super::scenes::LazyObject;
use super::super::tables::Sweep;
use yoro_render::PreparedScene;
use yoro_render::stereo::Pipeline;
use yoro_report::{Axis, Section};

/// Cost and quality of smaller ImBuffers.
pub struct Imbuffer;

impl Experiment for Imbuffer {
    fn name(&self) -> &'static str {
        "imbuffer"
    }

    fn about(&self) -> &'static str {
        "Frame time and quality with the ImBuffer at 1 to 1/16 of the resolution, with and without interpolation"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let own = vec![
            Contender::CONVENTIONAL,
            Contender::MONO,
            Contender::Synthesized(Pipeline::Paper),
            Contender::PaperNearest,
            Contender::PaperStrict,
        ];
        let contenders = choices.contenders(self.name(), own, &Contender::BASELINES)?;
        Ok(choices.sweep(self, choices.varied_scenes(), [1, 2, 4, 8, 16], |job, divisor| {
            job.contenders.clone_from(&contenders);
            job.rounds = choices.rounds;
            job.imbuffer = divisor;
            job.conditions.point = Some(f64::from(divisor));
        }))
    }

    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        frames::measure(runner, job, scene, FrameMeasures { cost: true, quality: true, pictures: false })
    }

    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        let mut section = Section::new(
            "ImBuffer",
            "The paper's pipeline with a smaller ImBuffer: its width and height are the image's over the divisor, with \
             and without linear interpolation.",
        );
        let axis = Axis::new("ImBuffer divisor").logarithmic();
        let sweep = Sweep { axis, text: |point| format!("1/{point}") };
        sweep.show_quality(&mut section, suite, &[]);
        sweep.show_times(&mut section, suite);
        vec![section]
    }
}
