//! Frame time by number of triangles

use super::super::contender::Contender;
use super::super::frames::{self, FrameMeasures};
use super::super::job::{Choices, Job, Source};
use super::super::runner::Runner;
use super::super::scenes::LazyObject;
use super::super::Experiment;
use yoro_render::PreparedScene;

/// The number of sizes, as in the paper, and in the short form.
const SIZES: [usize; 2] = [9, 5];

/// Frame time by number of triangles.
pub struct Complexity;

impl Experiment for Complexity {
    fn name(&self) -> &'static str {
        "complexity"
    }

    fn about(&self) -> &'static str {
        "Frame time of every method as the number of triangles grows"
    }

    fn jobs(&'static self, choices: &Choices, object: &LazyObject) -> anyhow::Result<Vec<Job>> {
        // Sizes grow in even steps, the first of which is one step. Slopes are measurable only if all else is equal.
        let sizes = choices.long_or_quick(SIZES[0], SIZES[1]);
        let step = (choices.max_triangles / sizes / object.triangles()).max(1);
        let contenders = choices.contenders(self.name(), Contender::methods(), &[Contender::CONVENTIONAL])?;
        Ok(choices.sweep(self, vec!["swarm".into()], (1..=sizes).map(|i| i * step), |job, copies| {
            job.contenders.clone_from(&contenders);
            job.rounds = choices.rounds;
            job.source = Source::Swarm { copies, places: step * sizes };
            job.conditions.point = Some(object.swarm_triangles(copies) as f64);
            job.frames = 1;
        }))
    }

    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        frames::measure(runner, job, scene, FrameMeasures { cost: true, quality: false, pictures: false })
    }
}
