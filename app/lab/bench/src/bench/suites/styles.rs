//! Quality in each shading style

use super::super::Experiment;
use super::super::contender::Contender;
use super::super::frames::{self, FrameMeasures};
use super::super::job::{Choices, Job};
use super::super::results::SuiteData;
use super::super::runner::Runner;
use super::super::scenes::LazyObject;
use super::super::tables::Labels;
use yoro_assets::ShadingStyle;
use yoro_render::PreparedScene;
use yoro_report::Section;
use yoro_report::paper::PAPER;

/// Quality in each shading style.
pub struct Styles;

impl Experiment for Styles {
    fn name(&self) -> &'static str {
        "styles"
    }

    fn about(&self) -> &'static str {
        "Quality in each shading style"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let contenders = choices.contenders(self.name(), Contender::synthesis(), &Contender::BASELINES)?;
        Ok(choices.sweep(self, choices.varied_scenes(), ShadingStyle::ALL, |job, style| {
            job.contenders.clone_from(&contenders);
            job.style = Some(style);
            job.conditions.label = Some(style.name().to_owned());
        }))
    }

    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        frames::measure(runner, job, scene, FrameMeasures { cost: false, quality: true, pictures: false })
    }

    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        let mut section = Section::new(
            "Shading styles",
            "The same synthesis under five styles of shading. In the paper, each style is a separate scene.",
        );
        let labels = Labels {
            column: "<style",
            title: "PSNR in dB / SSIM, means over the scenes",
            details: "Every scene and style in full",
            papers: Some(|label| PAPER.styles.get(label).copied()),
            timed: false,
        };
        labels.show(&mut section, suite);
        vec![section]
    }
}
