//! The experiments: those that measure frames at viewpoints are a table each, the others a type.

mod complexity;
mod flicker;
mod foveation;
mod half_rate;
mod hard_cases;
mod lights;
mod patchers;
mod reprojection;
mod scenes;
mod stream;
mod sweeps;

use yoro_render::PreparedScene;
use yoro_report::Section;

use super::Experiment;
use super::contender::Contender;
use super::frames::{self, FrameMeasures};
use super::job::{Choices, Job};
use super::results::SuiteData;
use super::runner::Runner;
use super::scenes::LazyObject;

/// All experiments, in the order in which `all` runs them.
pub const EXPERIMENTS: [&dyn Experiment; 13] = [
    &scenes::SCENES,
    &complexity::COMPLEXITY,
    &sweeps::STYLES,
    &sweeps::IPD,
    &sweeps::DISTANCE,
    &patchers::Patchers,
    &lights::LIGHTS,
    &flicker::Flicker,
    &reprojection::Reprojection,
    &half_rate::HalfRate,
    &foveation::Foveated,
    &stream::Stream,
    &hard_cases::HardCases,
];

/// An experiment that measures frames at viewpoints.
struct FrameSuite {
    /// See [`Experiment::name`].
    name: &'static str,
    /// See [`Experiment::about`].
    about: &'static str,
    measures: FrameMeasures,
    contenders: fn() -> Vec<Contender>,
    /// Returns the jobs, whose contenders and rounds the suite sets.
    jobs: fn(&'static FrameSuite, &Choices, &LazyObject) -> Vec<Job>,
    /// See [`Experiment::sections`].
    sections: fn(&SuiteData) -> Vec<Section>,
}

const QUALITY: FrameMeasures = FrameMeasures { cost: false, quality: true, pictures: false };
const COST: FrameMeasures = FrameMeasures { cost: true, quality: false, pictures: false };
const ALL: FrameMeasures = FrameMeasures { cost: true, quality: true, pictures: true };

impl Experiment for FrameSuite {
    fn name(&self) -> &'static str {
        self.name
    }

    fn about(&self) -> &'static str {
        self.about
    }

    fn jobs(&'static self, choices: &Choices, object: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let FrameMeasures { cost, quality, .. } = self.measures;
        let baselines = if quality { &Contender::BASELINES[..] } else { &[Contender::CONVENTIONAL] };
        let contenders = choices.contenders(self.name, (self.contenders)(), baselines)?;
        let mut jobs = (self.jobs)(self, choices, object);
        for job in &mut jobs {
            job.contenders.clone_from(&contenders);
            job.rounds = if cost { choices.rounds } else { 1 };
        }
        Ok(jobs)
    }

    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        frames::measure(runner, job, scene, self.measures)
    }

    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        (self.sections)(suite)
    }
}
