//! Measures jobs, round by round.

use std::rc::Rc;
use std::time::Duration;

use anyhow::{Context as _, ensure};
use image::RgbImage;
use indicatif::ProgressBar;

use super::blank::BlankFinder;
use super::contender::{Band, Contender};
use super::entrant::{Entrant, FrameTime};
use super::executed::{Device, Meter};
use super::holes::HoleFinder;
use super::pictures::picture_folder;
use super::record::{Measurement, Record, Results, RoundEnd, Unsupported, Writer, metric};
use super::scenes::LazyObject;
use super::suite::{Choices, Job, Measure, Source, Suite};
use super::views::{self, Views};
use super::{bandwidth, process};
use crate::dataset::{GroupOptions, GroupRenderer, ImageGroup};
use crate::inpaint::{self, Patcher, PatcherOptions};
use crate::metrics::{Channels, Comparison, FlickerMeter, psnr};
use crate::picture;
use yoro::eyes::{Eye, EyePair};
use yoro_files::interrupt;
use yoro_gl::Context;
use yoro_render::stereo::{ImBufferSize, StereoFrame};
use yoro_render::{PreparedScene, RenderSettings};
use yoro_scene::{Scene, ShadingStyle, Viewpoint};

/// Bytes that a triangle needs while its scene is made and uploaded, roughly: for the bound on memory.
const BYTES_PER_TRIANGLE: f64 = 150.0;

/// What a scene may cost before it is left out.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Memory in MiB that the scene may need.
    pub memory_mib: f64,
    /// Time that a frame of the conventional method may take.
    pub frame: Duration,
}

/// What the jobs of a run have in common.
pub struct Inputs<'a> {
    /// What the user chose for all suites.
    pub choices: &'a Choices,
    /// The object of the suites that need one.
    pub object: &'a LazyObject,
    /// Another camera path than that of the scenes.
    pub path: Option<&'a [Viewpoint]>,
    /// When to leave a scene out.
    pub bounds: Bounds,
    /// Model of the neural patcher.
    pub patchers: PatcherOptions,
}

/// Measures jobs and appends the results to a file.
pub struct Runner<'a> {
    gl: &'a Rc<Context>,
    inputs: Inputs<'a>,
    writer: Writer,
    /// What the file held before.
    before: Results,
    bar: ProgressBar,
    prepared: Option<(SceneKey, PreparedScene)>,
}

/// What a prepared scene was made of: settings that share it do not prepare it again.
#[derive(Clone, Debug, PartialEq)]
struct SceneKey {
    source: Source,
    style: Option<ShadingStyle>,
    render: RenderSettings,
}

/// Everyone who renders frames of a setting, and what became of the others.
struct Field {
    entrants: Vec<(Contender, Entrant)>,
    frame: StereoFrame,
    /// What is written with the first round: facts, who is missing, memory.
    first: Vec<Record>,
    memory: Vec<Measurement>,
}

impl<'a> Runner<'a> {
    /// Ready to measure into a file as [`Writer::open`] gives it.
    pub fn new(
        gl: &'a Rc<Context>,
        inputs: Inputs<'a>,
        (writer, before): (Writer, Results),
        bar: ProgressBar,
    ) -> Runner<'a> {
        Runner { gl, inputs, writer, before, bar, prepared: None }
    }

    /// Measures what is missing of a job.
    ///
    /// # Errors
    /// [`interrupt::Interrupted`] after Ctrl-C, and one sentence for whatever a user can help; finished rounds are in
    /// the file then.
    pub fn run(&mut self, job: &Job) -> anyhow::Result<()> {
        let done = self.before.rounds(&job.setting);
        if done >= job.rounds || self.before.is_left_out(&job.setting) {
            self.bar.inc(job.steps());
            return Ok(());
        }
        self.bar.set_message(format!("{}: {}", job.setting, "preparing"));
        interrupt::check()?;
        if let Some(reason) = self.too_large(job) {
            return self.leave_out(job, reason);
        }
        let mut prepared = self.prepare(job)?;
        self.refuse_blank(job, &mut prepared)?;
        let measured = match job.measure {
            Measure::Frames { .. } => self.frames(job, &mut prepared, done),
            Measure::Flicker => self.flicker(job, &mut prepared),
            Measure::GuardBand => self.guard_band(job, &mut prepared),
            Measure::Patchers => self.patchers(job, &mut prepared, done),
            Measure::Bandwidth => self.bandwidth(job, &mut prepared),
            Measure::Executed(device) => self.executed(job, &device, &mut prepared),
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

    /// Refuses viewpoints of a named scene that show nothing.
    fn refuse_blank(&self, job: &Job, prepared: &mut PreparedScene) -> anyhow::Result<()> {
        if !matches!(job.source, Source::Named(_)) {
            return Ok(());
        }
        let mut finder = BlankFinder::new(self.gl)?;
        let views = match job.measure {
            Measure::Frames { .. } | Measure::Patchers | Measure::Executed(_) => {
                Views::spread(job, prepared)?
            }
            // Of a path that shows something at its start, a frame may look past it.
            Measure::Flicker | Measure::GuardBand | Measure::Bandwidth => {
                Views::along_path(job, prepared, views::STEP)?.first()
            }
        };
        for (name, pair) in views.names.iter().zip(&views.pairs) {
            ensure!(
                !finder.is_blank(prepared, pair)?,
                "{name} of {0} shows nothing, so there is nothing to measure: write viewpoints that show the model into {0}.camera.json beside it",
                prepared.scene.name
            );
        }
        Ok(())
    }

    /// Writes for everyone that the setting was left out, and why.
    fn leave_out(&mut self, job: &Job, reason: String) -> anyhow::Result<()> {
        log::warn!("{} is left out: {reason}", job.setting);
        let records = job.contenders.iter().map(|contender| unsupported(job, *contender, reason.clone()));
        self.writer.append(records.collect(), RoundEnd { setting: job.setting.clone(), round: 0 })?;
        self.bar.inc(job.steps());
        Ok(())
    }

    /// The scene of the job before if it fits, or a new one.
    fn prepare(&mut self, job: &Job) -> anyhow::Result<PreparedScene> {
        let key = SceneKey::of(job);
        match self.prepared.take() {
            Some((present, prepared)) if present == key => Ok(prepared),
            // The old one goes first: two large scenes at once are one too many.
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

    fn frames(&mut self, job: &Job, prepared: &mut PreparedScene, done: u32) -> anyhow::Result<()> {
        let Measure::Frames { cost, quality } = job.measure else { return Ok(()) };
        let views = Views::spread(job, prepared)?;
        let mut field = self.field(job, prepared, &views, cost)?;
        if cost && self.is_too_slow(job, prepared, &views, &mut field)? {
            return Ok(());
        }
        for round in done..job.rounds {
            self.bar.set_message(format!("{}: round {} of {}", job.setting, round + 1, job.rounds));
            let mut measurements = field.measurements(job, round);
            let keep = quality && round == 0;
            let images = self.render_round(
                prepared,
                &views,
                &mut field,
                round,
                cost.then_some(&mut measurements),
                keep,
            )?;
            if keep {
                self.compare(prepared, &views, &field, &images, &mut measurements)?;
                for ((contender, _), images) in field.entrants.iter().zip(&images) {
                    self.save_picture(job, *contender, &images[0])?;
                }
            }
            if cost {
                self.time_passes(prepared, &views, &mut field, &mut measurements)?;
            }
            let mut records = Vec::new();
            if round == 0 {
                records.append(&mut field.first);
                for (measurement, memory) in measurements.iter_mut().zip(&field.memory) {
                    measurement.values.extend(memory.values.clone());
                }
            }
            self.finish_round(job, round, records, measurements)?;
        }
        Ok(())
    }

    /// Every contender at every view, the order rotated so that each comes first, second, ... equally often.
    /// Returns the other eye's images, by contender and view, if they are to be kept.
    fn render_round(
        &self,
        prepared: &mut PreparedScene,
        views: &Views,
        field: &mut Field,
        round: u32,
        mut times: Option<&mut Vec<Measurement>>,
        keep: bool,
    ) -> anyhow::Result<Vec<Vec<RgbImage>>> {
        let count = field.entrants.len();
        let mut images = vec![Vec::new(); count];
        for (i, pair) in views.pairs.iter().enumerate() {
            for turn in 0..count {
                interrupt::check()?;
                let at = (turn + i + round as usize) % count;
                let time = field.entrants[at].1.render_settled(prepared, pair, &mut field.frame)?;
                if let Some(measurements) = &mut times {
                    measurements[at].push(metric::FRAME_MS, milliseconds(time.wall));
                    measurements[at].push(metric::CPU_MS, milliseconds(time.cpu));
                }
                if keep {
                    images[at].push(picture::eye_image(&field.frame, pair.dominant.other()));
                }
                self.bar.inc(1);
            }
        }
        Ok(images)
    }

    /// Holds the images against those of the conventional method, which comes first.
    fn compare(
        &self,
        prepared: &mut PreparedScene,
        views: &Views,
        field: &Field,
        images: &[Vec<RgbImage>],
        measurements: &mut [Measurement],
    ) -> anyhow::Result<()> {
        let mut finder = HoleFinder::new(self.gl)?;
        for (i, pair) in views.pairs.iter().enumerate() {
            let holes = finder.find(prepared, pair)?;
            for at in 1..field.entrants.len() {
                interrupt::check()?;
                let comparison = Comparison::of(&images[at][i], &images[0][i], Some(&holes))?;
                measurements[at].push_comparison(&comparison);
            }
        }
        Ok(())
    }

    /// Saves the other eye as a contender shows it in the first view, for the report, in the suites that are about
    /// pictures.
    fn save_picture(&self, job: &Job, contender: Contender, image: &RgbImage) -> anyhow::Result<()> {
        if ![Suite::Scenes, Suite::AntiAliasing, Suite::Patchers]
            .iter()
            .any(|suite| suite.name() == job.setting.suite)
        {
            return Ok(());
        }
        let name = match contender {
            Contender::CONVENTIONAL => "truth".to_owned(),
            Contender::MONO => "dominant".to_owned(),
            other => other.name(),
        };
        let folder = picture_folder(&self.before.path, &job.setting);
        Ok(picture::save_color(&folder.join(format!("{name}.png")), image)?)
    }

    fn time_passes(
        &self,
        prepared: &mut PreparedScene,
        views: &Views,
        field: &mut Field,
        measurements: &mut [Measurement],
    ) -> anyhow::Result<()> {
        for ((_, entrant), measurement) in field.entrants.iter_mut().zip(measurements) {
            interrupt::check()?;
            let passes = entrant.pass_times(prepared, &views.pairs[0], &mut field.frame)?;
            if self.gl.capabilities().timer_queries && !passes.is_empty() {
                measurement.push(metric::GPU_MS, passes.iter().map(|(_, ms)| ms).sum());
            }
            for (name, ms) in passes {
                measurement.push(format!("{}{name}", metric::PASS_MS), ms);
            }
        }
        Ok(())
    }

    fn flicker(&mut self, job: &Job, prepared: &mut PreparedScene) -> anyhow::Result<()> {
        let views = Views::along_path(job, prepared, views::STEP)?;
        let mut field = self.field(job, prepared, &views, false)?;
        let mut finder = HoleFinder::new(self.gl)?;
        let mut measurements = field.measurements(job, 0);
        let mut last: Option<(Vec<RgbImage>, Vec<bool>)> = None;
        self.bar.set_message(job.setting.to_string());
        for pair in &views.pairs {
            let holes = finder.find(prepared, pair)?;
            let mut images = Vec::new();
            for (_, entrant) in &mut field.entrants {
                interrupt::check()?;
                entrant.render(prepared, pair, &mut field.frame)?;
                images.push(picture::eye_image(&field.frame, pair.dominant.other()));
                self.bar.inc(1);
            }
            if let Some((before, holes_before)) = &last {
                let meter = FlickerMeter::new([&before[0], &images[0]], [holes_before, &holes])?;
                measurements[0].push_flicker(&metric::CHANGES, &meter.change());
                for at in 1..images.len() {
                    let flicker = meter.flicker([&before[at], &images[at]])?;
                    measurements[at].push_flicker(&metric::FLICKERS, &flicker);
                }
            }
            last = Some((images, holes));
        }
        self.finish_round(job, 0, field.first, measurements)
    }

    /// Every contender's frames in their order, each once, as a viewer renders them. A frame's use of the band is known
    /// two frames after it.
    fn guard_band(&mut self, job: &Job, prepared: &mut PreparedScene) -> anyhow::Result<()> {
        let views = Views::along_path(job, prepared, views::HEADSET_STEP)?;
        let mut field = self.field(job, prepared, &views, true)?;
        let mut measurements = field.measurements(job, 0);
        self.bar.set_message(job.setting.to_string());
        let count = field.entrants.len();
        for (i, pair) in views.pairs.iter().enumerate() {
            let mut images = vec![RgbImage::default(); count];
            for turn in 0..count {
                interrupt::check()?;
                let at = (turn + i) % count;
                let entrant = &mut field.entrants[at].1;
                let time = entrant.render(prepared, pair, &mut field.frame)?;
                measurements[at].push(metric::FRAME_MS, milliseconds(time.wall));
                if let Some(used) = entrant.guard_band() {
                    measurements[at].push(metric::GUARD_COLUMNS, f64::from(used.columns));
                    measurements[at].push(metric::UNDRAWN, f64::from(used.undrawn));
                }
                images[at] = picture::eye_image(&field.frame, pair.dominant.other());
                self.bar.inc(1);
            }
            let truth = border(&images[0], pair)?;
            for at in 1..count {
                measurements[at].push(metric::PSNR, psnr(&images[at], &images[0], Channels::Rgb)?.0);
                let border = psnr(&border(&images[at], pair)?, &truth, Channels::Rgb)?;
                measurements[at].push(metric::BORDER_PSNR, border.0);
            }
        }
        self.finish_round(job, 0, field.first, measurements)
    }

    fn bandwidth(&mut self, job: &Job, prepared: &mut PreparedScene) -> anyhow::Result<()> {
        let views = Views::along_path(job, prepared, views::STEP)?;
        self.bar.set_message(job.setting.to_string());
        let bar = &self.bar;
        let mut step = || -> anyhow::Result<()> {
            bar.inc(1);
            Ok(interrupt::check()?)
        };
        let streams = bandwidth::run(self.gl, prepared, &views.pairs, &job.bandwidth, &mut step)?;
        let mut facts = views.facts(job, prepared);
        // Each value is that of a whole sequence at one quantizer.
        facts.frames = job.bandwidth.quantizers.iter().map(|quantizer| format!("QP {quantizer}")).collect();
        let measurement = |(stream, values): (&str, bandwidth::Values)| Measurement {
            setting: job.setting.clone(),
            contender: stream.to_owned(),
            round: 0,
            values,
        };
        let measurements = streams.into_iter().map(measurement).collect();
        self.finish_round(job, 0, vec![Record::Scene(facts)], measurements)
    }

    fn executed(&mut self, job: &Job, device: &Device, prepared: &mut PreparedScene) -> anyhow::Result<()> {
        let views = Views::spread(job, prepared)?;
        let mut meter = Meter::new(self.gl, *device)?;
        let mut measurement = Measurement {
            setting: job.setting.clone(),
            contender: device.name.to_owned(),
            round: 0,
            values: Default::default(),
        };
        self.bar.set_message(job.setting.to_string());
        for pair in &views.pairs {
            interrupt::check()?;
            for (name, value) in meter.measure(prepared, pair)? {
                measurement.push(name, value);
            }
            self.bar.inc(1);
        }
        self.finish_round(job, 0, vec![Record::Scene(views.facts(job, prepared))], vec![measurement])
    }

    fn patchers(&mut self, job: &Job, prepared: &mut PreparedScene, done: u32) -> anyhow::Result<()> {
        let views = Views::spread(job, prepared)?;
        let mut first = vec![Record::Scene(views.facts(job, prepared))];
        let mut patchers: Vec<(Contender, Box<dyn Patcher>)> = Vec::new();
        for &contender in &job.contenders {
            let Contender::Patcher(kind) = contender else { continue };
            match inpaint::create(self.gl, kind, &self.inputs.patchers) {
                Ok(patcher) => patchers.push((contender, patcher)),
                Err(error) => first.push(left_out(job, contender, &error)),
            }
        }
        let mut renderer = GroupRenderer::new(self.gl, &GroupOptions::default())?;
        let mut groups: Vec<ImageGroup> = Vec::new();
        for pair in &views.pairs {
            interrupt::check()?;
            groups.push(renderer.render(&mut prepared.renderer, &prepared.scene, pair)?);
        }
        for (_, patcher) in &mut patchers {
            interrupt::check()?;
            // The first call compiles and allocates.
            patcher.patch(&groups[0].reprojected)?;
        }
        for round in done..job.rounds {
            self.bar.set_message(format!("{}: round {} of {}", job.setting, round + 1, job.rounds));
            let mut measurements: Vec<Measurement> =
                patchers.iter().map(|(c, _)| Measurement::new(&job.setting, *c, round)).collect();
            let mut mono = Measurement::new(&job.setting, Contender::MONO, round);
            for (i, group) in groups.iter().enumerate() {
                let holes: Vec<bool> = group.reprojected.mask().iter().map(|m| *m == inpaint::HOLE).collect();
                for turn in 0..patchers.len() {
                    interrupt::check()?;
                    let at = (turn + i + round as usize) % patchers.len();
                    let patched = patchers[at].1.patch(&group.reprojected)?;
                    measurements[at].push(metric::PATCH_MS, milliseconds(patched.time.patching));
                    measurements[at].push(metric::PATCH_TRANSFER_MS, milliseconds(patched.time.transfer));
                    if round == 0 {
                        let comparison = Comparison::of(&patched.image, &group.truth, Some(&holes))?;
                        measurements[at].push_comparison(&comparison);
                        if i == 0 {
                            self.save_picture(job, patchers[at].0, &patched.image)?;
                        }
                    }
                    self.bar.inc(1);
                }
                if round == 0 {
                    let [x, y] = group.views.dominant_crop;
                    let [width, height] = group.pair.size;
                    let eye = image::imageops::crop_imm(&group.color, x, 0, width, height).to_image();
                    ensure!(
                        y == 0 && eye.dimensions() == group.truth.dimensions(),
                        "the eyes differ in height"
                    );
                    mono.push_comparison(&Comparison::of(&eye, &group.truth, Some(&holes))?);
                    if i == 0 {
                        self.save_picture(job, Contender::MONO, &eye)?;
                        self.save_picture(job, Contender::CONVENTIONAL, &group.truth)?;
                    }
                }
            }
            if round == 0 {
                measurements.insert(0, mono);
            }
            self.finish_round(job, round, std::mem::take(&mut first), measurements)?;
        }
        Ok(())
    }

    /// Makes every contender and lets it render a first frame, which warms it up and tells what memory it takes.
    fn field(
        &self,
        job: &Job,
        prepared: &mut PreparedScene,
        views: &Views,
        cost: bool,
    ) -> anyhow::Result<Field> {
        let mut field = Field {
            entrants: Vec::new(),
            frame: StereoFrame::new(self.gl, job.eyes.size)?,
            first: vec![Record::Scene(views.facts(job, prepared))],
            memory: Vec::new(),
        };
        let base = process::resident_mib();
        for &contender in &job.contenders {
            let Some((method, mut options)) = contender.method() else { continue };
            interrupt::check()?;
            if job.imbuffer > 1 {
                options.synthesis.paper.imbuffer = ImBufferSize::Divisor(job.imbuffer);
            }
            options.anti_aliasing = job.anti_aliasing.unwrap_or(options.anti_aliasing);
            let before = self.gl.texture_bytes();
            let ready = Entrant::new(self.gl, method, &job.render, &options).map_err(anyhow::Error::from);
            let ready = ready.and_then(|mut entrant| {
                if cost {
                    entrant.render(prepared, &views.pairs[0], &mut field.frame)?;
                }
                Ok(entrant)
            });
            self.bar.inc(1);
            match ready {
                Ok(entrant) => {
                    let mut memory = Measurement::new(&job.setting, contender, 0);
                    if cost {
                        let own = (self.gl.texture_bytes() - before) as f64 / f64::from(1 << 20);
                        memory.push(metric::TEXTURE_MIB, own);
                        memory.push(metric::MEMORY_MIB, base.map_or(f64::NAN, |base| base + own));
                    }
                    field.memory.push(memory);
                    field.entrants.push((contender, entrant));
                }
                // Without the ground truth there is nothing to hold the others against.
                Err(error) if contender == Contender::CONVENTIONAL => return Err(error),
                Err(error) => {
                    field.first.push(left_out(job, contender, &error));
                    self.bar.inc(u64::from(job.rounds) * job.frames as u64);
                }
            }
        }
        Ok(field)
    }

    /// Leaves the setting out when one conventional frame takes longer than the bound.
    fn is_too_slow(
        &mut self,
        job: &Job,
        prepared: &mut PreparedScene,
        views: &Views,
        field: &mut Field,
    ) -> anyhow::Result<bool> {
        if !matches!(job.source, Source::Swarm { .. }) {
            return Ok(false);
        }
        let (_, conventional) = field.entrants.first_mut().context("the conventional method comes first")?;
        let FrameTime { wall, .. } = conventional.render(prepared, &views.pairs[0], &mut field.frame)?;
        if wall <= self.inputs.bounds.frame {
            return Ok(false);
        }
        let (takes, allowed) = (milliseconds(wall), milliseconds(self.inputs.bounds.frame));
        self.leave_out(
            job,
            format!("a conventional frame takes {takes:.0} ms, and {allowed:.0} ms are allowed"),
        )?;
        Ok(true)
    }

    /// Writes a round: what comes with the first, and all measurements that hold something.
    fn finish_round(
        &mut self,
        job: &Job,
        round: u32,
        mut records: Vec<Record>,
        measurements: Vec<Measurement>,
    ) -> anyhow::Result<()> {
        let filled = measurements.into_iter().filter(|measurement| !measurement.values.is_empty());
        records.extend(filled.map(Record::Measurement));
        self.writer.append(records, RoundEnd { setting: job.setting.clone(), round })?;
        Ok(())
    }
}

/// The columns at the outer border of the eye that is not dominant for which surfaces at half a metre need a guard band:
/// the widest that is measured.
fn border(image: &RgbImage, pair: &EyePair) -> anyhow::Result<RgbImage> {
    let width = pair.synthesis(Band::HalfMetre.guard_band())?.guard_columns.min(image.width());
    let left = match pair.dominant.other() {
        Eye::Left => 0,
        Eye::Right => image.width() - width,
    };
    Ok(image::imageops::crop_imm(image, left, 0, width, image.height()).to_image())
}

impl SceneKey {
    fn of(job: &Job) -> SceneKey {
        SceneKey { source: job.source.clone(), style: job.style, render: job.render.clone() }
    }
}

impl Field {
    fn measurements(&self, job: &Job, round: u32) -> Vec<Measurement> {
        self.entrants.iter().map(|(contender, _)| Measurement::new(&job.setting, *contender, round)).collect()
    }
}

fn unsupported(job: &Job, contender: Contender, reason: String) -> Record {
    Record::Unsupported(Unsupported { setting: job.setting.clone(), contender: contender.name(), reason })
}

/// For a contender that could not be made.
fn left_out(job: &Job, contender: Contender, error: &impl std::fmt::Display) -> Record {
    log::info!("{}: {contender} is left out: {error}", job.setting);
    unsupported(job, contender, error.to_string())
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}
