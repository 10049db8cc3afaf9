//! `yoro bench`: every method, patcher and parameter of the paper, measured side by side.
//!
//! An [`Experiment`] plans [jobs](Job), each of which is a scene and, in a sweep, one point of it. In each round of a job
//! every [`Contender`] takes its turn, and the finished round is appended to a file of [records](record), which are all
//! that the report knows. Quality is always measured against a real render of the same eye, and shown beside "the same
//! image to both eyes" ([`Contender::MONO`]); cost is compared with two full renders ([`Contender::CONVENTIONAL`]).

mod blank;
mod contender;
mod frames;
mod holes;
mod job;
mod measured;
mod pictures;
mod process;
pub mod record;
mod report;
#[cfg(test)]
mod report_tests;
mod results;
mod runner;
mod scenes;
mod subject;
mod suites;
mod summary;
mod tables;
mod views;

use yoro_render::PreparedScene;
use yoro_report::Section;

pub use blank::{Blank, BlankFinder, BlankView};
pub use contender::Contender;
pub use job::{Choices, Job, Source};
pub use pictures::{picture_folder, pictures_beside};
pub use record::{Conditions, Measurement, Record, Results, Writer, metric};
pub use report::BenchReport;
pub use results::{Measured, SettingData, Spread, SuiteData};
pub use runner::{Inputs, Runner};
pub use scenes::{LazyObject, Object};
pub use suites::EXPERIMENTS;
pub use summary::text;
pub use views::check_path;

/// A suite of `yoro bench`: what it measures, and how its results are shown.
pub trait Experiment: Sync {
    /// Returns the name on the command line and in files.
    fn name(&self) -> &'static str;

    /// Returns what it measures, in a line.
    fn about(&self) -> &'static str;

    /// Returns the settings in the order of measurement: those that share a scene follow each other. `object` is the
    /// object of the suites `distance` and `complexity`.
    ///
    /// # Errors
    /// One sentence if the choices leave nothing to measure.
    fn jobs(&'static self, choices: &Choices, object: &LazyObject) -> anyhow::Result<Vec<Job>>;

    /// Measures the rounds of a job that are not yet measured.
    ///
    /// # Errors
    /// As [`Runner::run`].
    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()>;

    /// Returns whether the head of a job moves along the scene's camera path.
    fn moves(&self, _job: &Job) -> bool {
        false
    }

    /// Returns the number of steps of progress of a job: by default the preparation and the frames of each contender.
    fn steps(&self, job: &Job) -> u64 {
        (u64::from(job.rounds) * job.frames as u64 + 1) * job.contenders.len() as u64
    }

    /// Returns the sections of the report: by default a table of all means.
    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        vec![tables::everything(self.about(), suite)]
    }
}
