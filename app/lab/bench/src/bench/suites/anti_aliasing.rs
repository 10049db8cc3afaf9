//! Cost and quality by samples per pixel

use super::super::Experiment;
use super::super::contender::Contender;
use super::super::frames::{self, FrameMeasures};
use super::super::job::{Choices, Job};
use super::super::results::SuiteData;
use super::super::runner::Runner;
use super::super::scenes::LazyObject;
use super::super::tables::Labels;
use yoro_render::MSAA;
use yoro_render::PreparedScene;
use yoro_render::stereo::Pipeline;
use yoro_report::Section;

/// Cost and quality by samples per pixel.
pub struct AntiAliasing;

impl Experiment for AntiAliasing {
    fn name(&self) -> &'static str {
        "anti-aliasing"
    }

    fn about(&self) -> &'static str {
        "Quality and frame time with one, two and four samples per pixel"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let own = vec![Contender::CONVENTIONAL, Contender::MONO, Contender::Synthesized(Pipeline::Gather)];
        let contenders = choices.contenders(self.name(), own, &Contender::BASELINES)?;
        Ok(choices.sweep(self, choices.all_scenes(), MSAA, |job, samples| {
            job.contenders.clone_from(&contenders);
            job.rounds = choices.rounds;
            job.render.msaa = samples;
            job.conditions.label = Some(match samples {
                1 => "1 sample".to_owned(),
                n => format!("{n} samples"),
            });
        }))
    }

    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        frames::measure(runner, job, scene, FrameMeasures { cost: true, quality: true, pictures: true })
    }

    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        let mut section = Section::new(
            "Anti-aliasing",
            "Each synthesized eye against the same eye rendered with as many samples per pixel. Synthesis takes the mean \
             colour and the nearest depth of each pixel's samples.",
        );
        let labels = Labels {
            column: "<samples per pixel",
            title: "PSNR in dB / SSIM / frame time over two renders, means over the scenes",
            details: "Every scene in full",
            papers: None,
            timed: true,
        };
        labels.show(&mut section, suite);
        vec![section]
    }
}
