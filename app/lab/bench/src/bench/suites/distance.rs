//! Quality by the distance of an object

use super::super::contender::Contender;
use super::super::frames::{self, FrameMeasures};
use super::super::job::{Choices, Job, Source};
use super::super::runner::Runner;
use super::super::scenes::LazyObject;
use super::super::Experiment;
use yoro_render::PreparedScene;

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
}
