//! Flicker from frame to frame along a camera path.

use image::RgbImage;

use super::super::Experiment;
use super::super::contender::Contender;
use super::super::frames::Field;
use super::super::holes::HoleFinder;
use super::super::job::{Choices, Job};
use super::super::record::metric;
use super::super::results::{CONVENTIONAL, SettingData, SuiteData};
use super::super::runner::{Runner, eye_image};
use super::super::scenes::LazyObject;
use super::super::tables::{MetricColumn, mark_scenes, means_table};
use super::super::views;
use yoro_files::interrupt;
use yoro_metrics::FlickerMeter;
use yoro_render::PreparedScene;
use yoro_report::text::fixed;
use yoro_report::{Axis, Cell, Plot, Section};

/// The number of frames, and in the short form.
const FRAMES: [usize; 2] = [12, 4];

/// Flicker from frame to frame along a camera path.
pub struct Flicker;

impl Experiment for Flicker {
    fn name(&self) -> &'static str {
        "flicker"
    }

    fn about(&self) -> &'static str {
        "Flicker of the synthesized eye from frame to frame along a camera path"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let contenders = choices.contenders(
            self.name(),
            [Contender::synthesis(), vec![Contender::RenderedHoles]].concat(),
            &Contender::BASELINES,
        )?;
        Ok(choices.sweep(self, choices.varied_scenes(), [()], |job, ()| {
            job.contenders.clone_from(&contenders);
            job.frames = choices.long_or_quick(FRAMES[0], FRAMES[1]);
        }))
    }

    fn moves(&self, _job: &Job) -> bool {
        true
    }

    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        let views = runner.path(job, scene, views::STEP)?;
        let mut field = Field::new(runner, job, scene, &views, false)?;
        let mut finder = HoleFinder::new(runner.gl)?;
        let mut round = field.start_round(job, 0);
        let mut previous: Option<(Vec<RgbImage>, Vec<bool>)> = None;
        runner.announce(job, 0);
        for (i, pair) in views.pairs.iter().enumerate() {
            scene.set_time(i as f64 / views::STEP_RATE)?;
            let holes = finder.find(scene, pair)?;
            let mut images = Vec::new();
            for entry in &mut field.entries {
                interrupt::check()?;
                entry.subject.render(scene, pair, &mut field.frame)?;
                images.push(eye_image(&field.frame, pair.dominant.other()));
                runner.bar.inc(1);
            }
            if let Some((before, holes_before)) = &previous {
                let meter = FlickerMeter::new([&before[0], &images[0]], [holes_before, &holes])?;
                round.of(&field.entries[0].name).push_flicker(&metric::CHANGES, &meter.change());
                for (at, entry) in field.entries.iter().enumerate().skip(1) {
                    let flicker = meter.flicker([&before[at], &images[at]])?;
                    round.of(&entry.name).push_flicker(&metric::FLICKERS, &flicker);
                }
            }
            previous = Some((images, holes));
        }
        scene.set_time(0.0)?;
        runner.finish(round)
    }

    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        let mut section = Section::new(
            "Flicker",
            "Frame-to-frame change of the synthesized eye that a real render does not have, along part of the camera path \
             at walking pace. The paper does not measure this.",
        );
        for (title, name) in [
            ("Flicker of all pixels", metric::FLICKER),
            ("Flicker in holes", metric::FLICKER_HOLES),
            ("Flicker at edges", metric::FLICKER_EDGES),
        ] {
            let plot = Plot::rows(title, Axis::new("flicker, of 255").from_zero()).caption("Less is better.");
            let value = |setting: &SettingData, name_of: &str| setting.find(name_of)?.mean(name);
            section.plot(mark_scenes(plot, suite, &suite.measured(name), value, |_| Vec::new()));
        }
        const COLUMNS: [MetricColumn; 4] = [
            ("all", metric::FLICKER, 3),
            ("in holes", metric::FLICKER_HOLES, 3),
            ("at edges", metric::FLICKER_EDGES, 3),
            ("elsewhere", metric::FLICKER_REST, 3),
        ];
        let contenders = suite.measured(metric::FLICKER);
        let mut table = means_table(suite, "Flicker, of 255, means over the scenes", &contenders, &COLUMNS);
        let changes = metric::CHANGES.map(|name| suite.mean(CONVENTIONAL, name));
        if changes.iter().any(Option::is_some) {
            let mut cells = vec![Cell::plain("the scene's own change")];
            cells.extend(changes.map(|change| Cell::base(fixed(change, 3))));
            cells.truncate(table.columns.len());
            table.push_first(cells);
        }
        section.table(table);
        vec![section]
    }
}
