//! Cost and quality by resolution

use super::super::Experiment;
use super::super::contender::Contender;
use super::super::frames::{self, FrameMeasures};
use super::super::job::{Choices, Job};
use super::super::results::SuiteData;
use super::super::runner::Runner;
use super::super::scenes::LazyObject;
use super::super::tables::Sweep;
use yoro_render::PreparedScene;
use yoro_report::{Axis, Section};

/// Cost and quality by resolution.
pub struct Resolution;

impl Experiment for Resolution {
    fn name(&self) -> &'static str {
        "resolution"
    }

    fn about(&self) -> &'static str {
        "Frame time and quality of every method from 512 to 2048 pixels per eye"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let pixels: &[u32] = choices.long_or_quick(&[512, 1024, 1536, 2048], &[256, 512]);
        let contenders = choices.contenders(self.name(), Contender::methods(), &Contender::BASELINES)?;
        Ok(choices.sweep(self, choices.varied_scenes(), pixels.iter().copied(), |job, pixels| {
            job.contenders.clone_from(&contenders);
            job.rounds = choices.rounds;
            job.eyes.size = [pixels; 2];
            job.conditions.point = Some(f64::from(pixels));
            job.frames = 1;
        }))
    }

    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        frames::measure(runner, job, scene, FrameMeasures { cost: true, quality: true, pictures: false })
    }

    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        let mut section = Section::new(
            "Resolution",
            "Cost and quality against the width of each eye's image. The paper measured at its devices' own resolution \
             only.",
        );
        let sweep = Sweep { axis: Axis::new("width of an eye, pixels"), text: |point| format!("{point}") };
        sweep.show_times(&mut section, suite);
        sweep.show_quality(&mut section, suite, &[]);
        vec![section]
    }
}
