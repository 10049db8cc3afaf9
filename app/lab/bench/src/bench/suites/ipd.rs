//! Quality by the distance between the eyes

use super::super::Experiment;
use super::super::contender::Contender;
use super::super::frames::{self, FrameMeasures};
use super::super::job::{Choices, Job};
use super::super::results::SuiteData;
use super::super::runner::Runner;
use super::super::scenes::LazyObject;
use super::super::tables::Sweep;
use yoro_render::PreparedScene;
use yoro_report::paper::PAPER;
use yoro_report::{Axis, Section};

/// Quality by the distance between the eyes.
pub struct Ipd;

impl Experiment for Ipd {
    fn name(&self) -> &'static str {
        "ipd"
    }

    fn about(&self) -> &'static str {
        "Quality as the distance between the eyes grows from 50 to 75 mm"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let millimetres: &[u32] = choices.long_or_quick(&[50, 55, 60, 65, 70, 75], &[50, 63, 75]);
        let contenders = choices.contenders(self.name(), Contender::synthesis(), &Contender::BASELINES)?;
        Ok(choices.sweep(self, choices.varied_scenes(), millimetres.iter().copied(), |job, mm| {
            job.contenders.clone_from(&contenders);
            job.eyes.ipd = mm as f32 * 1e-3;
            job.conditions.point = Some(f64::from(mm));
        }))
    }

    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        frames::measure(runner, job, scene, FrameMeasures { cost: false, quality: true, pictures: false })
    }

    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        let mut section = Section::new(
            "Distance between the eyes",
            "Quality of the synthesized eye against the interpupillary distance.",
        );
        let sweep = Sweep { axis: Axis::new("IPD, mm"), text: |point| format!("{point}") };
        sweep.show_quality(&mut section, suite, &PAPER.sweeps["ipd"]);
        vec![section]
    }
}
