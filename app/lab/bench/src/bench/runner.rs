//! Measures jobs round by round.

use std::rc::Rc;
use std::time::Duration;

use image::RgbImage;
use indicatif::ProgressBar;

use super::blank::BlankFinder;
use super::contender::Contender;
use super::job::{Choices, Job, Source};
use super::pictures::picture_folder;
use super::record::{Measurement, Record, Results, RoundEnd, Unsupported, Writer};
use super::scenes::LazyObject;
use super::views::{self, Motion, Views};
use crate::inpaint::PatcherOptions;
use yoro::eyes::Eye;
use yoro_assets::{Scene, ShadingStyle, Viewpoint};
use yoro_files::interrupt;
use yoro_gl::Context;
use yoro_render::stereo::StereoFrame;
use yoro_render::{PreparedScene, RenderSettings};

/// The inputs that all jobs of a run share.
pub struct Inputs<'a> {
    /// The user's choices for all suites.
    pub choices: &'a Choices,
    /// The object, for the suites that need one.
    pub object: &'a LazyObject,
    /// A camera path that replaces those of the scenes.
    pub path: Option<&'a [Viewpoint]>,
    /// The options of patchers.
    pub patchers: PatcherOptions,
}

/// Measures jobs and appends the results to a file.
pub struct Runner<'a> {
    pub(super) gl: &'a Rc<Context>,
    pub(super) inputs: Inputs<'a>,
    pub(super) bar: ProgressBar,
    writer: Writer,
    /// The content of the file at the start.
    before: Results,
    prepared: Option<(SceneKey, PreparedScene)>,
}

/// Everything that a prepared scene depends on. Settings with the same key share the scene.
#[derive(Clone, Debug, PartialEq)]
struct SceneKey {
    source: Source,
    style: Option<ShadingStyle>,
    render: RenderSettings,
}

impl<'a> Runner<'a> {
    /// Creates a runner that appends to a file opened by [`Writer::open`].
    pub fn new(
        gl: &'a Rc<Context>,
        inputs: Inputs<'a>,
        (writer, before): (Writer, Results),
        bar: ProgressBar,
    ) -> Runner<'a> {
        Runner { gl, inputs, writer, before, bar, prepared: None }
    }

    /// Measures the rounds of a job that the file does not have yet.
    ///
    /// # Errors
    /// [`interrupt::Interrupted`] after Ctrl-C, and one sentence for any error that a user can remedy. The finished
    /// rounds are in the file in both cases.
    pub fn run(&mut self, job: &Job) -> anyhow::Result<()> {
        let done = self.before.rounds(&job.conditions);
        if done >= job.rounds {
            self.bar.inc(job.experiment.steps(job));
            return Ok(());
        }
        self.bar.set_message(format!("{}: preparing", job.conditions));
        interrupt::check()?;
        let key = SceneKey { source: job.source.clone(), style: job.style, render: job.render.clone() };
        let mut prepared = match self.prepared.take() {
            Some((present, prepared)) if present == key => prepared,
            // The old scene is dropped first, because two large scenes may not fit into memory together.
            old => {
                drop(old);
                PreparedScene::new(self.gl, self.scene(job)?, &job.render)?
            }
        };
        let measured = job.experiment.measure(self, job, &mut prepared);
        self.prepared = Some((key, prepared));
        measured
    }

    fn scene(&self, job: &Job) -> anyhow::Result<Scene> {
        let mut scene = match &job.source {
            Source::Named(name) => {
                let mut scene = yoro_scenes::load(name, self.inputs.choices.seed, None)?;
                if let Some(path) = self.inputs.path {
                    scene.viewpoints = path.to_vec();
                }
                scene
            }
            Source::Swarm { copies, places } => self.inputs.object.swarm(*copies, *places),
            Source::Object(distance) => self.inputs.object.at_distance(*distance),
        };
        scene.style = job.style.unwrap_or(scene.style);
        Ok(scene)
    }

    /// Returns the rounds of a job that are still to be measured.
    pub(super) fn rounds(&self, job: &Job) -> std::ops::Range<u32> {
        self.before.rounds(&job.conditions)..job.rounds
    }

    /// Shows what is measured now.
    pub(super) fn announce(&self, job: &Job, round: u32) {
        let round =
            if job.rounds > 1 { format!(": round {} of {}", round + 1, job.rounds) } else { String::new() };
        self.bar.set_message(format!("{}{round}", job.conditions));
    }

    /// Returns viewpoints of the scene, evenly spread, all of which show something.
    pub(super) fn viewpoints(&self, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<Views> {
        let views = Views::spread(job, scene)?;
        self.refuse_blank(job, scene, &views, views.pairs.len())?;
        Ok(views)
    }

    /// Returns frames along the camera path that are `step` metres apart. The first of them shows something; a later one
    /// may look past the scene.
    pub(super) fn path(&self, job: &Job, scene: &mut PreparedScene, step: f32) -> anyhow::Result<Views> {
        let views = Views::along_path(job, scene, step)?;
        self.refuse_blank(job, scene, &views, 1)?;
        Ok(views)
    }

    /// Returns `frames` frames of a head that moves from the middle of the camera path on, where something is seen.
    pub(super) fn moving(
        &self,
        job: &Job,
        scene: &mut PreparedScene,
        motion: Motion,
        frames: usize,
    ) -> anyhow::Result<Views> {
        self.path(job, scene, views::STEP)?;
        Views::of_motion(&Job { frames, ..job.clone() }, scene, motion)
    }

    fn refuse_blank(
        &self,
        job: &Job,
        scene: &mut PreparedScene,
        views: &Views,
        count: usize,
    ) -> anyhow::Result<()> {
        if !matches!(job.source, Source::Named(_)) {
            return Ok(());
        }
        let named = views.names.iter().cloned().zip(&views.pairs).take(count);
        BlankFinder::new(self.gl)?.refuse_blank(scene, named)
    }

    /// Saves a picture of the setting for the report.
    pub(super) fn save_picture(&self, job: &Job, name: &str, image: &RgbImage) -> anyhow::Result<()> {
        let folder = picture_folder(&self.before.path, &job.conditions);
        Ok(yoro_media::save_color(&folder.join(format!("{name}.png")), image)?)
    }

    /// Writes a round.
    pub(super) fn finish(&mut self, round: Round) -> anyhow::Result<()> {
        let Round { mut records, measurements, end } = round;
        let filled = measurements.into_iter().filter(|measurement| !measurement.values.is_empty());
        records.extend(filled.map(Record::Measurement));
        Ok(self.writer.append(records, end)?)
    }
}

/// The results of a round, before they are written.
pub(super) struct Round {
    /// What comes with the first round: facts about the scene, contenders that cannot take part.
    pub records: Vec<Record>,
    measurements: Vec<Measurement>,
    end: RoundEnd,
}

impl Round {
    pub fn new(job: &Job, round: u32) -> Round {
        let end = RoundEnd { conditions: job.conditions.clone(), round };
        Round { records: Vec::new(), measurements: Vec::new(), end }
    }

    /// Starts a round which, if it is the first one, has the facts about the scene.
    pub fn of_views(job: &Job, round: u32, views: &Views, scene: &PreparedScene) -> Round {
        let mut new = Round::new(job, round);
        if round == 0 {
            new.records.push(Record::Scene(views.facts(job, scene)));
        }
        new
    }

    /// Returns the measurement of a contender, which is created if there is none yet.
    pub fn of(&mut self, contender: &str) -> &mut Measurement {
        let at = self.measurements.iter().position(|m| m.contender == contender).unwrap_or_else(|| {
            let RoundEnd { conditions, round } = self.end.clone();
            let contender = contender.to_owned();
            self.measurements.push(Measurement { conditions, contender, round, values: Default::default() });
            self.measurements.len() - 1
        });
        &mut self.measurements[at]
    }
}

/// Returns the record of a contender that could not be created.
pub(super) fn left_out(job: &Job, contender: Contender, error: &impl std::fmt::Display) -> Record {
    log::info!("{}: {contender} is left out: {error}", job.conditions);
    Record::Unsupported(Unsupported {
        conditions: job.conditions.clone(),
        contender: contender.name(),
        reason: error.to_string(),
    })
}

/// Returns one eye of a finished frame.
pub(super) fn eye_image(frame: &StereoFrame, eye: Eye) -> RgbImage {
    yoro_media::rgb_image(&frame.rgba(eye), frame.size())
}

pub(super) fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}
