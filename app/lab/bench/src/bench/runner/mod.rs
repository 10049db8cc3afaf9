//! Measures jobs round by round.

mod foveation;
mod frames;
mod half_rate;
mod patchers;
mod reprojection;
mod sequences;
mod stream;
mod whole_frames;

pub(super) use foveation::WAYS;

use std::rc::Rc;
use std::time::Duration;

use image::RgbImage;
use indicatif::ProgressBar;

use super::blank::BlankFinder;
use super::contender::Contender;
use super::job::{Displaced, Job, Measure, Source};
use super::pictures::picture_folder;
use super::record::{Measurement, Record, Results, RoundEnd, Unsupported, Writer};
use super::scenes::LazyObject;
use super::suite::{Choices, Suite};
use super::views::{self, Views};
use crate::inpaint::PatcherOptions;
use yoro::eyes::Eye;
use yoro_assets::{Scene, ShadingStyle, Viewpoint};
use yoro_estimate::Recorder;
use yoro_files::interrupt;
use yoro_gl::Context;
use yoro_render::stereo::StereoFrame;
use yoro_render::{PreparedScene, RenderSettings};

/// The approximate number of bytes per triangle while a scene is built and uploaded, for the limit on memory.
const BYTES_PER_TRIANGLE: f64 = 150.0;

/// The limits above which a scene is left out.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Memory in MiB that the scene may need.
    pub memory_mib: f64,
    /// The time that a frame of the conventional method may take.
    pub frame: Duration,
}

/// The inputs that all jobs of a run share.
pub struct Inputs<'a> {
    /// The user's choices for all suites.
    pub choices: &'a Choices,
    /// The object, for the suites that need one.
    pub object: &'a LazyObject,
    /// A camera path that replaces those of the scenes.
    pub path: Option<&'a [Viewpoint]>,
    /// The limits above which a scene is left out.
    pub bounds: Bounds,
    /// The options of patchers.
    pub patchers: PatcherOptions,
}

/// Measures jobs and appends the results to a file.
pub struct Runner<'a> {
    gl: &'a Rc<Context>,
    inputs: Inputs<'a>,
    writer: Writer,
    /// The content of the file at the start.
    before: Results,
    bar: ProgressBar,
    prepared: Option<(SceneKey, PreparedScene)>,
    /// Records whole frames. Made before the scenes, since it must know their textures.
    recorder: Option<Recorder>,
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
        Runner { gl, inputs, writer, before, bar, prepared: None, recorder: None }
    }

    /// Returns the file, for a runner with another context.
    pub fn finish(self) -> (Writer, Results) {
        (self.writer, self.before)
    }

    /// Measures the rounds of a job that the file does not have yet.
    ///
    /// # Errors
    /// [`interrupt::Interrupted`] after Ctrl-C, and one sentence for any error that a user can remedy. The finished
    /// rounds are in the file in both cases.
    pub fn run(&mut self, job: &Job) -> anyhow::Result<()> {
        let done = self.before.rounds(&job.conditions);
        if done >= job.rounds || self.before.is_left_out(&job.conditions) {
            self.bar.inc(job.steps());
            return Ok(());
        }
        self.bar.set_message(format!("{}: {}", job.conditions, "preparing"));
        interrupt::check()?;
        if let Some(reason) = self.too_large(job) {
            return self.leave_out(job, reason);
        }
        // Where a suite varies the samples, the driver may lack some of them. What the user asks for is an error instead.
        if job.render.msaa != self.inputs.choices.render.msaa
            && let Err(reason) = job.render.supported(self.gl.capabilities())
        {
            return self.leave_out(job, reason.to_string());
        }
        if matches!(job.measure, Measure::WholeFrames) && self.recorder.is_none() {
            self.prepared = None;
            self.recorder = Some(Recorder::new(self.gl));
        }
        let mut prepared = self.prepare(job)?;
        self.refuse_blank(job, &mut prepared)?;
        let measured = match job.measure {
            Measure::Frames { .. } => self.frames(job, &mut prepared, done),
            Measure::Flicker => self.flicker(job, &mut prepared),
            Measure::GuardBand => self.guard_band(job, &mut prepared),
            Measure::Foveation => self.foveation(job, &mut prepared, done),
            Measure::Patchers => self.patchers(job, &mut prepared, done),
            Measure::Reprojection(displaced) => self.reprojection(job, displaced, &mut prepared),
            Measure::HalfRate(motion, level) => self.half_rate(job, (motion, level), &mut prepared),
            Measure::Stream(late) => self.stream(job, late, &mut prepared),
            Measure::Executed(device) => self.executed(job, &device, &mut prepared),
            Measure::WholeFrames => self.whole_frames(job, &mut prepared),
        };
        self.prepared = Some((SceneKey::of(job), prepared));
        measured
    }

    fn too_large(&self, job: &Job) -> Option<String> {
        let Source::Swarm { copies, .. } = job.source else { return None };
        let needed =
            self.inputs.object.swarm_triangles(copies) as f64 * BYTES_PER_TRIANGLE / f64::from(1 << 20);
        let bound = self.inputs.bounds.memory_mib;
        (needed > bound)
            .then(|| format!("the scene needs about {needed:.0} MiB, and {bound:.0} MiB are allowed"))
    }

    /// Refuses a named scene if one of its viewpoints shows nothing.
    fn refuse_blank(&self, job: &Job, prepared: &mut PreparedScene) -> anyhow::Result<()> {
        if !matches!(job.source, Source::Named(_)) {
            return Ok(());
        }
        let views = match job.measure {
            Measure::Frames { .. }
            | Measure::Foveation
            | Measure::Patchers
            | Measure::Reprojection(Displaced::Canted)
            | Measure::Executed(_)
            | Measure::WholeFrames => Views::spread(job, prepared)?,
            // Only the start of the path has to show something; a later frame may look past the scene.
            Measure::Flicker
            | Measure::GuardBand
            | Measure::Reprojection(Displaced::Late(..))
            | Measure::HalfRate(..)
            | Measure::Stream(_) => Views::along_path(job, prepared, views::STEP)?.first(),
        };
        BlankFinder::new(self.gl)?.refuse_blank(prepared, views.names.iter().cloned().zip(&views.pairs))
    }

    /// Records for every contender that the setting was left out, and why.
    fn leave_out(&mut self, job: &Job, reason: String) -> anyhow::Result<()> {
        log::warn!("{} is left out: {reason}", job.conditions);
        let records = job.contenders.iter().map(|contender| unsupported(job, *contender, reason.clone()));
        self.writer.append(records.collect(), RoundEnd { conditions: job.conditions.clone(), round: 0 })?;
        self.bar.inc(job.steps());
        Ok(())
    }

    /// Returns the scene of the previous job if it fits, or else a new one.
    fn prepare(&mut self, job: &Job) -> anyhow::Result<PreparedScene> {
        let key = SceneKey::of(job);
        match self.prepared.take() {
            Some((present, prepared)) if present == key => Ok(prepared),
            // The old scene is dropped first, because two large scenes may not fit into memory together.
            old => {
                drop(old);
                Ok(PreparedScene::new(self.gl, self.scene(job)?, &job.render)?)
            }
        }
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

    /// Saves a contender's other eye in the first view for the report, in the suites that show pictures.
    fn save_picture(&self, job: &Job, contender: Contender, image: &RgbImage) -> anyhow::Result<()> {
        if ![Suite::Scenes, Suite::AntiAliasing, Suite::Patchers]
            .iter()
            .any(|suite| suite.name() == job.conditions.suite)
        {
            return Ok(());
        }
        let name = match contender {
            Contender::CONVENTIONAL => "truth".to_owned(),
            Contender::MONO => "dominant".to_owned(),
            other => other.name(),
        };
        let folder = picture_folder(&self.before.path, &job.conditions);
        Ok(yoro_media::save_color(&folder.join(format!("{name}.png")), image)?)
    }

    /// Writes a round: the records that come with the first round, and all measurements with values.
    fn finish_round(
        &mut self,
        job: &Job,
        round: u32,
        mut records: Vec<Record>,
        measurements: Vec<Measurement>,
    ) -> anyhow::Result<()> {
        let filled = measurements.into_iter().filter(|measurement| !measurement.values.is_empty());
        records.extend(filled.map(Record::Measurement));
        self.writer.append(records, RoundEnd { conditions: job.conditions.clone(), round })?;
        Ok(())
    }
}

impl SceneKey {
    fn of(job: &Job) -> SceneKey {
        SceneKey { source: job.source.clone(), style: job.style, render: job.render.clone() }
    }
}

fn unsupported(job: &Job, contender: Contender, reason: String) -> Record {
    Record::Unsupported(Unsupported {
        conditions: job.conditions.clone(),
        contender: contender.name(),
        reason,
    })
}

/// Returns the record of a contender that could not be created.
fn left_out(job: &Job, contender: Contender, error: &impl std::fmt::Display) -> Record {
    log::info!("{}: {contender} is left out: {error}", job.conditions);
    unsupported(job, contender, error.to_string())
}

/// Returns one eye of a finished frame.
fn eye_image(frame: &StereoFrame, eye: Eye) -> RgbImage {
    yoro_media::rgb_image(&frame.rgba(eye), frame.size())
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}
