//! Foveation: frame time, shaded pixels, quality and flicker of each level, by two renders and by synthesis.

use std::rc::Rc;
use std::time::Instant;

use glam::Vec3;
use image::RgbImage;

use super::super::Experiment;
use super::super::job::{Choices, Job, QUICK_SCENES};
use super::super::record::{Measurement, metric};
use super::super::results::{CONVENTIONAL, MONO, SettingData, SuiteData};
use super::super::runner::{Round, Runner, eye_image, milliseconds};
use super::super::scenes::LazyObject;
use super::super::subject::Subject;
use super::super::tables::{cell, table_of};
use super::super::views;
use yoro::eyes::{Composition, EyePair, EyesError, Foveation, FoveationLevel};
use yoro_files::interrupt;
use yoro_gl::{Context, GlError};
use yoro_metrics::{FlickerMeter, SsimWindow, psnr_where, ssim_where};
use yoro_render::stereo::{HoleMethod, Method, StereoError, StereoFrame};
use yoro_render::{DepthReader, PreparedScene, ViewTargets};
use yoro_report::stats::{geometric_mean, mean};
use yoro_report::text::fixed;
use yoro_report::{Cell, Section, Table};

/// The vertical fields of view in degrees.
pub(super) const DEGREES: [f32; 2] = [60.0, 90.0];
/// The methods, with the names of all pixels.
const METHODS: [(Method, &str); 2] = [(Method::Conventional, "conventional"), (Method::Synthesized, "yoro")];
/// The baseline for quality: the dominant eye's picture of all pixels.
const SAME_IMAGE: &str = "mono";
/// The angle in radians around the axis in which quality counts as that of the fovea.
const FOVEA: f32 = Foveation::MEDIUM.radius;
/// Neighbouring pixels belong to different surfaces if one is farther by this factor.
const STEP_IN_DISTANCE: f32 = 1.1;
/// Pixels this near to such a step are near a silhouette.
const NEAR_SILHOUETTE: usize = 3;

/// Eyes with all pixels only where they look.
pub struct Foveated;

impl Experiment for Foveated {
    fn name(&self) -> &'static str {
        "foveation"
    }

    fn about(&self) -> &'static str {
        "Frame time, shaded pixels and quality of eyes with all pixels only where they look, by two renders and by synthesis, at 60 and 90 degrees"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let scenes = if choices.quick { choices.scenes(QUICK_SCENES) } else { choices.all_scenes() };
        Ok(choices.sweep(self, scenes, DEGREES, |job, degrees| {
            job.rounds = choices.rounds;
            job.eyes.fov_y = degrees.to_radians();
            job.conditions.label = Some(format!("{degrees} degrees"));
        }))
    }

    fn steps(&self, job: &Job) -> u64 {
        u64::from(job.rounds) * (job.frames * METHODS.len() * FoveationLevel::ALL.len()) as u64
    }

    /// Measures every contender at each viewpoint, and one step ahead of it for flicker. They take turns.
    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        let views = runner.viewpoints(job, scene)?;
        let mut contenders = Foveator::all(runner.gl, job)?;
        let mut frame = StereoFrame::new(runner.gl, job.eyes.size)?;
        let mut silhouettes = Silhouettes::new(runner.gl)?;
        for number in runner.rounds(job) {
            runner.announce(job, number);
            let mut round = Round::of_views(job, number, &views, scene);
            for name in contenders.iter().map(|contender| contender.name.as_str()).chain([SAME_IMAGE]) {
                round.of(name);
            }
            for pair in &views.pairs {
                interrupt::check()?;
                if number == 0 {
                    let near = silhouettes.find(scene, pair)?;
                    compare(&mut contenders, scene, pair, &mut frame, &near, &mut round)?;
                }
                let count = contenders.len();
                for turn in 0..count {
                    let Foveator { name, subject, .. } = &mut contenders[(turn + number as usize) % count];
                    // The first frame at a place uploads what the next ones have.
                    subject.render_to(scene, pair, &frame.targets())?;
                    runner.gl.finish();
                    let begin = Instant::now();
                    subject.render_to(scene, pair, &frame.targets())?;
                    runner.gl.finish();
                    round.of(name).push(metric::FRAME_MS, milliseconds(begin.elapsed()));
                    runner.bar.inc(1);
                }
            }
            runner.finish(round)?;
        }
        Ok(())
    }

    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        let mut section = Section::new(
            "Foveation",
            "Each eye in two levels, an inset of all pixels around its axis and a wide view of fewer, by two renders and by \
             synthesis of each level: all pixels to 30 (low) or 20 degrees (medium, high), and half (low, medium) or a third of \
             them along each axis beyond. Quality is that of the synthesized eye: in the fovea, within 20 degrees, and in the \
             periphery beyond the inset, against two full renders; alike, against two renders with the same levels; near \
             silhouettes, within 3 pixels of them in the periphery, alike. The paper does not measure this.",
        );
        suite.labels().iter().for_each(|label| section.table(means(suite, label)));
        suite.labels().iter().for_each(|label| section.table(by_scene(suite, label)));
        vec![section]
    }
}

/// Returns the name of two renders with the same levels.
fn alike(name: &str) -> String {
    match name.split_once('-') {
        Some((_, level)) => format!("{CONVENTIONAL}-{level}"),
        None => CONVENTIONAL.to_owned(),
    }
}

/// Returns a frame's time over that of another contender in a setting.
fn over(setting: &SettingData, name: &str, base: &str) -> Option<f64> {
    Some(setting.find(name)?.ratio(setting.find(base)?, metric::FRAME_MS)?.median)
}

/// A column: its head, and the text of a contender.
type Column<'a> = (&'a str, &'a dyn Fn(&str) -> Option<String>);

/// Returns the means over all scenes at one field of view.
fn means(suite: &SuiteData, label: &str) -> Table {
    let average = |name: &str, metric: &str| {
        mean(suite.labelled(label).filter_map(|setting| setting.find(name)?.mean(metric)))
    };
    let quality = |name: &str, [psnr, ssim]: [&str; 2]| {
        let ssim = average(name, ssim)?;
        // Identical images have no finite PSNR.
        Some(average(name, psnr).map_or_else(|| "equal".into(), |psnr| format!("{psnr:.2} / {ssim:.3}")))
    };
    let ratio = |name: &str, base: &str| {
        fixed(geometric_mean(suite.labelled(label).filter_map(|setting| over(setting, name, base))), 2)
    };
    let [own, synthesized] = metric::PERIPHERY_FLICKER;
    let columns: [Column<'_>; 9] = [
        ("time over two full renders", &|name| ratio(name, CONVENTIONAL)),
        ("over two alike", &|name| ratio(name, &alike(name)).filter(|_| name != MONO)),
        ("shaded", &|name| fixed(average(name, metric::SHADED), 3)),
        ("fovea", &|name| quality(name, metric::FOVEA)),
        ("periphery", &|name| quality(name, metric::PERIPHERY)),
        ("periphery, alike", &|name| quality(name, metric::ALIKE)),
        ("near silhouettes, alike", &|name| quality(name, metric::SILHOUETTES)),
        ("flicker of the periphery, rendered eye", &|name| fixed(average(name, own), 2)),
        ("flicker of the periphery, synthesized eye", &|name| fixed(average(name, synthesized), 2)),
    ];
    let title = format!("Means over the scenes at {label}: times, PSNR in dB / SSIM");
    let mut table = table_of(&title, &["<levels"], &columns.map(|(heading, _)| heading));
    for name in suite.contenders() {
        let cells = columns.iter().map(|(_, text)| cell(name, text(name)));
        table.push([Cell::plain(name)].into_iter().chain(cells).collect());
    }
    table.note = "The same image near silhouettes is compared with a full render.".into();
    table
}

/// Returns the times of each scene over two full renders at one field of view.
fn by_scene(suite: &SuiteData, label: &str) -> Table {
    let scenes: Vec<&SettingData> = suite.labelled(label).collect();
    let names: Vec<&str> = scenes.iter().map(|setting| setting.conditions.scene.as_str()).collect();
    let mut table = table_of(&format!("Frame time over two full renders at {label}"), &["<levels"], &names);
    for name in suite.measured(metric::FRAME_MS) {
        let mut cells = vec![Cell::plain(name)];
        cells.extend(scenes.iter().map(|setting| cell(name, fixed(over(setting, name, CONVENTIONAL), 2))));
        table.push(cells);
    }
    table
}

/// A method with a level.
struct Foveator {
    /// `conventional`, `yoro-medium` and so on.
    name: String,
    is_synthesis: bool,
    subject: Subject,
}

impl Foveator {
    /// Returns every method with every level: by method, from all pixels to the fewest.
    fn all(gl: &Rc<Context>, job: &Job) -> Result<Vec<Foveator>, GlError> {
        let each = METHODS.into_iter().flat_map(|method| FoveationLevel::ALL.map(|level| (method, level)));
        let made = each.map(|((method, name), level)| {
            Ok(Foveator {
                name: match level {
                    FoveationLevel::Off => name.to_owned(),
                    level => format!("{name}-{}", level.name()),
                },
                is_synthesis: method == Method::Synthesized,
                subject: Subject::foveated(gl, (method, HoleMethod::default()), &job.render, level, false)?,
            })
        });
        made.collect()
    }

    /// Returns the pixels that are rendered, of those of two full eyes.
    fn shaded(&self, pair: &EyePair) -> Result<f64, EyesError> {
        let pixels = |size: [u32; 2]| f64::from(size[0]) * f64::from(size[1]);
        let mut shaded = 0.0;
        for layer in self.subject.views(pair)?.layers() {
            shaded += if self.is_synthesis {
                pixels(layer.synthesis_views(self.subject.options().guard_band)?.source.size)
            } else {
                2.0 * pixels(layer.eyes.size)
            };
        }
        Ok(shaded / (2.0 * pixels(pair.size)))
    }
}

/// Renders by each contender at a place and one step ahead, and compares the eye that is synthesized.
fn compare(
    contenders: &mut [Foveator],
    scene: &mut PreparedScene,
    pair: &EyePair,
    frame: &mut StereoFrame,
    near_silhouettes: &[bool],
    round: &mut Round,
) -> anyhow::Result<()> {
    let other = pair.dominant.other();
    let next =
        EyePair { poses: pair.poses.map(|pose| pose.translated_local(Vec3::NEG_Z * views::STEP)), ..*pair };
    // Here and one step ahead, of the eye that is rendered and of the one that is synthesized.
    let (mut rendered, mut images): (Vec<[RgbImage; 2]>, Vec<[RgbImage; 2]>) = (Vec::new(), Vec::new());
    for contender in &mut *contenders {
        let mut both = |pair: &EyePair| {
            contender.subject.render_to(scene, pair, &frame.targets())?;
            Ok::<_, StereoError>([pair.dominant, other].map(|eye| eye_image(frame, eye)))
        };
        let ([a, b], [a_after, b_after]) = (both(pair)?, both(&next)?);
        rendered.push([a, a_after]);
        images.push([b, b_after]);
    }
    let (truth, same) = (&images[0][0], &rendered[0][0]);
    let fovea = fovea(pair);
    let medium = contenders[FoveationLevel::Medium as usize].subject.views(pair)?;
    let silhouettes_of = |periphery: &[bool]| -> Vec<bool> {
        periphery.iter().zip(near_silhouettes).map(|(a, b)| *a && *b).collect()
    };
    for (at, contender) in contenders.iter().enumerate() {
        let measurement = round.of(&contender.name);
        measurement.push(metric::SHADED, contender.shaded(pair)?);
        let own = contender.subject.views(pair)?;
        // All pixels everywhere have no periphery: that of the middle level is compared.
        let levels = if own.inset.is_some() { own } else { medium };
        let periphery = periphery(&levels.composition(other));
        let image = &images[at][0];
        let alike = &images[at % FoveationLevel::ALL.len()][0];
        push_quality(measurement, metric::FOVEA, [image, truth], &fovea)?;
        push_quality(measurement, metric::PERIPHERY, [image, truth], &periphery)?;
        push_quality(measurement, metric::ALIKE, [image, alike], &periphery)?;
        push_quality(measurement, metric::SILHOUETTES, [image, alike], &silhouettes_of(&periphery))?;
        let both = [(&rendered, pair.dominant), (&images, other)];
        for ((images, eye), name) in both.into_iter().zip(metric::PERIPHERY_FLICKER) {
            let periphery = self::periphery(&levels.composition(eye));
            // The meter's mask is the part that is told apart.
            let meter = FlickerMeter::new(images[0].each_ref(), [&periphery, &periphery])?;
            let flicker = meter.flicker(images[at].each_ref())?;
            flicker.holes.into_iter().for_each(|value| measurement.push(name, value));
        }
    }
    let measurement = round.of(SAME_IMAGE);
    let periphery = periphery(&medium.composition(other));
    push_quality(measurement, metric::FOVEA, [same, truth], &fovea)?;
    push_quality(measurement, metric::PERIPHERY, [same, truth], &periphery)?;
    push_quality(measurement, metric::SILHOUETTES, [same, truth], &silhouettes_of(&periphery))
}

/// Records PSNR and SSIM of an image in a part of it.
fn push_quality(
    measurement: &mut Measurement,
    [psnr, ssim]: [&'static str; 2],
    [image, truth]: [&RgbImage; 2],
    part: &[bool],
) -> anyhow::Result<()> {
    if let Some(value) = psnr_where(image, truth, part)? {
        measurement.push(psnr, value.0);
    }
    if let Some(value) = ssim_where(image, truth, SsimWindow::Gaussian11, part)? {
        measurement.push(ssim, value);
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
        let rendered = renderer.render(&mut self.targets, scene, &view)?;
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
    use yoro::eyes::{EyeOptions, Gaze, Pose};

    fn pair() -> EyePair {
        EyeOptions { size: [90; 2], fov_y: 90f32.to_radians(), ..EyeOptions::default() }.pair(Pose::IDENTITY)
    }

    #[test]
    fn fovea_and_periphery_do_not_meet() {
        let pair = pair();
        let level = FoveationLevel::Medium.foveation().unwrap();
        let levels = pair.stereo_views(Some(&level), Gaze::Axes(pair.axes())).unwrap();
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
