//! Frame time with few lights

use super::super::contender::Contender;
use super::super::frames::{self, FrameMeasures};
use super::super::job::{Choices, Job};
use super::super::runner::Runner;
use super::super::scenes::LazyObject;
use super::super::Experiment;
use yoro_render::PreparedScene;

/// The number of lights: the paper has fewer than five.
const FEW_LIGHTS: usize = 4;

/// Frame time with few lights.
pub struct Lights;

impl Experiment for Lights {
    fn name(&self) -> &'static str {
        "lights"
    }

    fn about(&self) -> &'static str {
        "Frame time of every method with four lights: the paper's setting for single-pass instancing"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let contenders = choices.contenders(self.name(), Contender::methods(), &[Contender::CONVENTIONAL])?;
        Ok(choices.sweep(self, choices.all_scenes(), [FEW_LIGHTS], |job, lights| {
            job.contenders.clone_from(&contenders);
            job.rounds = choices.rounds;
            job.render.point_lights = lights;
            job.conditions.point = Some(lights as f64);
        }))
    }

    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        frames::measure(runner, job, scene, FrameMeasures { cost: true, quality: false, pictures: false })
    }
}
