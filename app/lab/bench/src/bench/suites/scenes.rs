//! Frame time, overhead and quality on the eight scenes

use super::super::contender::Contender;
use super::super::frames::{self, FrameMeasures};
use super::super::job::{Choices, Job};
use super::super::runner::Runner;
use super::super::scenes::LazyObject;
use super::super::Experiment;
use yoro_render::PreparedScene;

/// Frame time, overhead and quality on the eight scenes.
pub struct Scenes;

impl Experiment for Scenes {
    fn name(&self) -> &'static str {
        "scenes"
    }

    fn about(&self) -> &'static str {
        "Frame time and quality of every method on eight scenes"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let contenders = choices.contenders(self.name(), Contender::methods(), &Contender::BASELINES)?;
        Ok(choices.sweep(self, choices.all_scenes(), [()], |job, ()| {
            job.contenders.clone_from(&contenders);
            job.rounds = choices.rounds;
        }))
    }

    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        frames::measure(runner, job, scene, FrameMeasures { cost: true, quality: true, pictures: true })
    }
}
