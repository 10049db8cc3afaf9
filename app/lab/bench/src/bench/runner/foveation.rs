//! Levels of foveation: their frame time, shaded pixels, quality and flicker, by two renders and by synthesis.

use std::rc::Rc;
use std::time::Instant;

use image::RgbImage;

use super::{Runner, eye_image, milliseconds};
use crate::bench::job::Job;
use crate::bench::record::{Measurement, Record, metric};
use crate::bench::views::{self, Views};
use glam::Vec3;
use yoro::eyes::{
    Composition, EyePair, EyesError, Foveation, FoveationLevel, Gaze, StereoViews, SynthesisViews,
};
use yoro_files::interrupt;
use yoro_gl::{Context, GlError};
use yoro_metrics::{FlickerMeter, SsimWindow, psnr_where, ssim_where};
use yoro_render::stereo::{
    EyeLevels, EyeTarget, LevelFrame, LevelTargets, Method, SelectedMethod, StereoError,
    StereoFrame, StereoMethod, StereoOptions,
};
use yoro_render::{DepthReader, PreparedScene, Selection, ViewTargets};

/// The methods that render the levels.
const METHODS: [(Method, &str); 2] = [(Method::Conventional, "conventional"), (Method::Synthesized, "yoro")];
/// The baseline for quality: the dominant eye's picture of all pixels.
const SAME_IMAGE: &str = "mono";
/// The angle in radians around the axis in which quality counts as that of the fovea.
const FOVEA: f32 = Foveation::MEDIUM.radius;
/// Neighbouring pixels belong to different surfaces if one is farther by this factor.
const STEP_IN_DISTANCE: f32 = 1.1;
/// Pixels this near to such a step are near a silhouette.
const NEAR_SILHOUETTE: usize = 3;

impl Runner<'_> {
    /// Measures all ways of rendering the levels at each viewpoint, and one step ahead of it for flicker. The ways take turns.
    pub(super) fn foveation(
        &mut self,
        job: &Job,
        prepared: &mut PreparedScene,
        done: u32,
    ) -> anyhow::Result<()> {
        let views = Views::spread(job, prepared)?;
        let mut ways = Way::all(self.gl, job)?;
        let mut frame = StereoFrame::new(self.gl, job.eyes.size)?;
        let mut silhouettes = Silhouettes::new(self.gl)?;
        for round in done..job.rounds {
            self.bar.set_message(format!("{}: round {} of {}", job.conditions, round + 1, job.rounds));
            let names = ways.iter().map(|way| way.name.as_str()).chain([SAME_IMAGE]);
            let mut measurements: Vec<Measurement> =
                names.map(|name| Measurement::new(&job.conditions, name, round)).collect();
            for pair in &views.pairs {
                interrupt::check()?;
                if round == 0 {
                    let near = silhouettes.find(prepared, pair)?;
                    qualities(&mut ways, prepared, pair, &mut frame, &near, &mut measurements)?;
                }
                let turns = ways.len();
                for turn in 0..turns {
                    let at = (turn + round as usize) % turns;
                    // The first frame at a place uploads what the next ones have.
                    ways[at].render(prepared, pair, &frame.targets())?;
                    self.gl.finish();
                    let begin = Instant::now();
                    ways[at].render(prepared, pair, &frame.targets())?;
                    self.gl.finish();
                    measurements[at].push(metric::FRAME_MS, milliseconds(begin.elapsed()));
                    self.bar.inc(1);
                }
            }
            let facts = (round == 0).then(|| Record::Scene(views.facts(job, prepared)));
            self.finish_round(job, round, facts.into_iter().collect(), measurements)?;
        }
        Ok(())
    }
}

/// The number of ways in which each frame is rendered.
pub(in crate::bench) const WAYS: usize = METHODS.len() * FoveationLevel::ALL.len();

/// A method that renders levels.
pub(super) struct Way {
    /// `conventional`, `yoro-medium` and so on.
    pub name: String,
    level: FoveationLevel,
    pub is_synthesis: bool,
    method: SelectedMethod,
    options: StereoOptions,
    frame: LevelFrame,
}

impl Way {
    /// Returns every method with every level: by method, from all pixels to the fewest.
    fn all(gl: &Rc<Context>, job: &Job) -> Result<Vec<Way>, GlError> {
        let each = METHODS.into_iter().flat_map(|method| FoveationLevel::ALL.map(|level| (method, level)));
        each.map(|(method, level)| Way::new(gl, job, method, level, false)).collect()
    }

    /// Returns both methods with one level.
    pub fn both(gl: &Rc<Context>, job: &Job, level: FoveationLevel) -> Result<Vec<Way>, GlError> {
        METHODS.map(|method| Way::new(gl, job, method, level, false)).into_iter().collect()
    }

    /// Makes a method with a level; `name` is that of all pixels. `motion_vectors` as in [`StereoOptions`].
    pub fn new(
        gl: &Rc<Context>,
        job: &Job,
        (method, name): (Method, &str),
        level: FoveationLevel,
        motion_vectors: bool,
    ) -> Result<Way, GlError> {
        let inset = level.foveation().map(|foveation| foveation.nearest);
        let options = StereoOptions { policy: None, inset, motion_vectors, ..StereoOptions::default() };
        Ok(Way {
            name: match level {
                FoveationLevel::Off => name.to_owned(),
                level => format!("{name}-{}", level.name()),
            },
            level,
            is_synthesis: method == Method::Synthesized,
            method: SelectedMethod::new(gl, method.into(), &job.render, &options)?,
            options,
            frame: LevelFrame::new(gl, false)?,
        })
    }

    /// Renders all levels, and does not compose them.
    pub fn render_levels(&mut self, prepared: &mut PreparedScene, pair: &EyePair) -> Result<(), StereoError> {
        let levels = self.levels(pair)?;
        let to = self.frame.fit(&levels)?;
        let PreparedScene { renderer, scene } = prepared;
        self.method.render_levels(renderer, scene, &(&levels).into(), &to)
    }

    fn levels(&self, pair: &EyePair) -> Result<StereoViews, EyesError> {
        let axes = Gaze::Axes(pair.axes());
        pair.levels(self.level.foveation().as_ref(), axes, self.options.guard_band)
    }

    /// Renders both eyes, and composes them of their levels. Motion vectors are the wide level's.
    pub fn render(
        &mut self,
        PreparedScene { renderer, scene }: &mut PreparedScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        let (levels, targets) = self.fit(pair, to)?;
        self.method.render_levels(renderer, scene, &levels, &targets)?;
        self.compose(&levels, to);
        Ok(())
    }

    /// True if the last frame's motion targets were filled.
    pub fn has_motion(&self) -> bool {
        self.method.report().has_motion
    }

    /// Returns the levels of the eyes with their targets: those of the eyes themselves if there is one level.
    fn fit<'a>(
        &mut self,
        pair: &EyePair,
        to: &[EyeTarget<'a>; 2],
    ) -> Result<(EyeLevels, LevelTargets<'a>), StereoError> {
        let levels = self.levels(pair)?;
        if levels.inset.is_none() {
            return Ok((pair.into(), to.into()));
        }
        let mut targets = self.frame.fit(&levels)?;
        for (own, to) in targets.wide.iter_mut().zip(to) {
            own.motion = to.motion;
        }
        Ok(((&levels).into(), targets))
    }

    fn compose(&self, levels: &EyeLevels, to: &[EyeTarget; 2]) {
        if levels.inset.is_some() {
            self.frame.compose(&to.map(|eye| eye.color));
        }
    }

    /// Returns the views to render for synthesis, of each level.
    pub fn views(&self, pair: &EyePair) -> Result<Vec<SynthesisViews>, EyesError> {
        let levels = self.levels(pair)?;
        Ok([Some(levels.wide), levels.inset].into_iter().flatten().map(|level| level.views).collect())
    }

    /// Returns the pixels that are rendered, of those of two full eyes.
    fn shaded(&self, pair: &EyePair) -> Result<f64, EyesError> {
        let pixels = |size: [u32; 2]| f64::from(size[0]) * f64::from(size[1]);
        let levels = self.levels(pair)?;
        let each = [Some(levels.wide), levels.inset].into_iter().flatten().map(|level| {
            if self.is_synthesis { pixels(level.views.source.size) } else { 2.0 * pixels(level.eyes.size) }
        });
        Ok(each.sum::<f64>() / (2.0 * pixels(pair.size)))
    }
}

/// Renders each way at a place and one step ahead, and compares the eye that is synthesized.
fn qualities(
    ways: &mut [Way],
    prepared: &mut PreparedScene,
    pair: &EyePair,
    frame: &mut StereoFrame,
    near_silhouettes: &[bool],
    measurements: &mut [Measurement],
) -> anyhow::Result<()> {
    let other = pair.dominant.other();
    let next =
        EyePair { poses: pair.poses.map(|pose| pose.translated_local(Vec3::NEG_Z * views::STEP)), ..*pair };
    // Here and one step ahead, of the eye that is rendered and of the one that is synthesized.
    let (mut rendered, mut images): (Vec<[RgbImage; 2]>, Vec<[RgbImage; 2]>) = (Vec::new(), Vec::new());
    for way in &mut *ways {
        let mut both = |pair: &EyePair| {
            way.render(prepared, pair, &frame.targets())?;
            Ok::<_, StereoError>([pair.dominant, other].map(|eye| eye_image(frame, eye)))
        };
        let ([a, b], [a_after, b_after]) = (both(pair)?, both(&next)?);
        rendered.push([a, a_after]);
        images.push([b, b_after]);
    }
    let (truth, same) = (&images[0][0], &rendered[0][0]);
    let fovea = fovea(pair);
    let medium = ways[FoveationLevel::Medium as usize].levels(pair)?;
    let quality =
        |measurement: &mut Measurement, names: [&'static str; 2], images: [&RgbImage; 2], at: &[bool]| {
            let [image, truth] = images;
            if let Some(psnr) = psnr_where(image, truth, at)? {
                measurement.push(names[0], psnr.0);
            }
            if let Some(ssim) = ssim_where(image, truth, SsimWindow::Gaussian11, at)? {
                measurement.push(names[1], ssim);
            }
            anyhow::Ok(())
        };
    for (at, way) in ways.iter().enumerate() {
        let measurement = &mut measurements[at];
        measurement.push(metric::SHADED, way.shaded(pair)?);
        let own = way.levels(pair)?;
        // All pixels everywhere have no periphery: that of the middle level is compared.
        let levels = if own.inset.is_some() { own } else { medium };
        let periphery = periphery(&levels.composition(other));
        let silhouettes: Vec<bool> = periphery.iter().zip(near_silhouettes).map(|(a, b)| *a && *b).collect();
        let image = &images[at][0];
        let alike = &images[at % FoveationLevel::ALL.len()][0];
        quality(measurement, metric::FOVEA, [image, truth], &fovea)?;
        quality(measurement, metric::PERIPHERY, [image, truth], &periphery)?;
        quality(measurement, metric::ALIKE, [image, alike], &periphery)?;
        quality(measurement, metric::SILHOUETTES, [image, alike], &silhouettes)?;
        let both = [(&rendered, pair.dominant), (&images, other)];
        for ((images, eye), name) in both.into_iter().zip(metric::PERIPHERY_FLICKER) {
            let periphery = self::periphery(&levels.composition(eye));
            // The meter's mask is the part that is told apart.
            let meter = FlickerMeter::new(images[0].each_ref(), [&periphery, &periphery])?;
            let flicker = meter.flicker(images[at].each_ref())?;
            flicker.holes.into_iter().for_each(|value| measurement.push(name, value));
        }
    }
    if let Some(measurement) = measurements.last_mut() {
        let periphery = periphery(&medium.composition(other));
        let silhouettes: Vec<bool> = periphery.iter().zip(near_silhouettes).map(|(a, b)| *a && *b).collect();
        quality(measurement, metric::FOVEA, [same, truth], &fovea)?;
        quality(measurement, metric::PERIPHERY, [same, truth], &periphery)?;
        quality(measurement, metric::SILHOUETTES, [same, truth], &silhouettes)?;
    }
    Ok(())
}

/// Returns, row by row from the top, whether each pixel of the synthesized eye is in its fovea.
fn fovea(pair: &EyePair) -> Vec<bool> {
    let frustum = &pair.frusta[pair.dominant.other().index()];
    let reach = FOVEA.tan();
    pixels(pair.size, |[x, y]| {
        let [x, y] = [frustum.left + x * frustum.width(), frustum.bottom + y * frustum.height()];
        x * x + y * y <= reach * reach
    })
}

/// Returns, row by row from the top, whether each pixel of an eye is beyond its inset.
fn periphery(composition: &Composition) -> Vec<bool> {
    let Some(inset) = composition.inset.map(|inset| inset.place) else { return Vec::new() };
    pixels(composition.size, |place| {
        let inside = |i: usize| {
            let at = inset.scale[i] * f64::from(place[i]) + inset.offset[i];
            (0.0..=1.0).contains(&at)
        };
        !(inside(0) && inside(1))
    })
}

/// Returns a value for each pixel by its place in the image from 0 to 1, row by row from the top.
fn pixels(size: [u32; 2], value: impl Fn([f32; 2]) -> bool) -> Vec<bool> {
    let [width, height] = size;
    let place = |x: u32, y: u32| [(x as f32 + 0.5) / width as f32, (y as f32 + 0.5) / height as f32];
    (0..height).rev().flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| value(place(x, y))).collect()
}

/// Finds the pixels near a step in depth.
struct Silhouettes {
    targets: ViewTargets,
    reader: DepthReader,
}

impl Silhouettes {
    fn new(gl: &Rc<Context>) -> Result<Silhouettes, GlError> {
        Ok(Silhouettes { targets: ViewTargets::default(), reader: DepthReader::new(gl)? })
    }

    /// Returns, row by row from the top, whether each pixel of the synthesized eye is near a silhouette.
    fn find(&mut self, prepared: &mut PreparedScene, pair: &EyePair) -> Result<Vec<bool>, GlError> {
        let view = pair.view(pair.dominant.other());
        let PreparedScene { renderer, scene } = prepared;
        let rendered = renderer.render(&mut self.targets, scene, &view, Selection::All)?;
        self.reader.copy(&rendered.depth, view.size)?;
        let distances: Vec<f32> =
            self.reader.read().iter().map(|depth| view.depth.distance(*depth)).collect();
        Ok(near_steps(&distances, view.size.map(|pixels| pixels as usize)))
    }
}

/// Returns, row by row from the top, the pixels near a step in distances, whose rows are from the bottom.
fn near_steps(distances: &[f32], [width, height]: [usize; 2]) -> Vec<bool> {
    let is_step = |a: usize, b: usize| {
        let (a, b) = (distances[a], distances[b]);
        a.max(b) > STEP_IN_DISTANCE * a.min(b)
    };
    let mut near = vec![false; width * height];
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let at = y * width + x;
        if (x + 1 < width && is_step(at, at + 1)) || (y + 1 < height && is_step(at, at + width)) {
            let rows = y.saturating_sub(NEAR_SILHOUETTE)..(y + NEAR_SILHOUETTE + 1).min(height);
            let columns = x.saturating_sub(NEAR_SILHOUETTE)..(x + NEAR_SILHOUETTE + 1).min(width);
            for row in rows.map(|row| height - 1 - row) {
                near[row * width..][columns.clone()].fill(true);
            }
        }
    }
    near
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro::eyes::{EyeOptions, Pose};

    fn pair() -> EyePair {
        EyeOptions { size: [90; 2], fov_y: 90f32.to_radians(), ..EyeOptions::default() }.pair(Pose::IDENTITY)
    }

    #[test]
    fn fovea_and_periphery_do_not_meet() {
        let pair = pair();
        let level = FoveationLevel::Medium.foveation().unwrap();
        let levels =
            pair.levels(Some(&level), Gaze::Axes(pair.axes()), StereoOptions::default().guard_band).unwrap();
        let (fovea, periphery) = (fovea(&pair), periphery(&levels.composition(pair.dominant.other())));
        assert!(fovea.iter().zip(&periphery).all(|(a, b)| !(*a && *b)));
        let count = |mask: &[bool]| mask.iter().filter(|is| **is).count();
        // A disc of tangent .364 in a square of tangents from -1 to 1, and the square of whole pixels around it.
        assert!(count(&fovea).abs_diff(843) < 20, "{}", count(&fovea));
        assert_eq!(count(&periphery), 90 * 90 - 34 * 34);
    }

    #[test]
    fn pixels_near_a_step_are_found_with_rows_from_the_top() {
        let (width, height) = (20, 12);
        // A nearer surface in the lower left corner, four columns wide and two rows high.
        let distance = |i: usize| if i % width < 4 && i / width < 2 { 1.0 } else { 2.0 };
        let distances: Vec<f32> = (0..width * height).map(distance).collect();
        let near = near_steps(&distances, [width, height]);
        let is = |x: usize, row: usize| near[row * width + x];
        assert!(is(0, height - 1) && is(6, height - 1) && !is(7, height - 1) && !is(0, 0));
        assert!(is(0, height - 5) && !is(0, height - 6));
        assert!(near_steps(&vec![1.0; width * height], [width, height]).iter().all(|near| !near));
    }
}
