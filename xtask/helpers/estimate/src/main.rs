//! `cargo xtask maintain estimate`: what whole stereo frames cost on mobile GPUs that are not here.
//!
//! Frames are rendered here and recorded: their passes and images, and the samples that pass each depth test. `costs` has
//! what Mesa's compilers make of each shader, `traffic` what a tile-based GPU moves between its tiles and memory, `lamps`
//! the number of lights that a wave computes, `gather` what the synthesis executes, and `model` adds these up.

mod costs;
mod gather;
mod gpus;
mod lamps;
mod model;
mod tables;
mod traffic;
mod waves;

use std::rc::Rc;

use anyhow::ensure;
use clap::Parser;

use crate::gather::{Counted, Counter, Executed, March};
use crate::gpus::GPUS;
use crate::lamps::Lamps;
use crate::model::{Frame, FrameModel, MULTIVIEW, SIZE};
use crate::tables::Estimate;
use crate::traffic::correct_depth_formats;
use yoro::eyes::{DepthConvention, DepthRange, EyeOptions, EyePair, FoveationLevel, Gaze};
use yoro_assets::ShadingStyle;
use yoro_context::{Backend, Headless};
use yoro_gl::{Capabilities, Context};
use yoro_render::stereo::{FrameTargets, HoleMethod, Method, StereoImages, StereoOptions, StereoSession};
use yoro_render::{DepthReader, PreparedScene, RenderSettings, ViewTargets};
use yoro_scenes::{BUILTINS, Builtin, DEFAULT_SEED, replacements};
use yoro_test_support::record::{RecordedPass, Recorder};
use yoro_viewer::render_settings;

/// Slots and bytes of whole stereo frames, by two renders, multiview and synthesis
#[derive(Parser)]
struct Args {
    /// Built-in scenes [default: all]
    scenes: Vec<String>,
    /// Vertical field of view in degrees
    #[arg(long, default_value_t = 60.0)]
    fov_y_degrees: f32,
    /// Viewpoints of each scene, spread over its camera path
    #[arg(long, default_value_t = 3)]
    viewpoints: usize,
}

/// A method with its options, whose frames are recorded.
struct Contender {
    /// Its name in the tables.
    name: &'static str,
    method: Method,
    foveation: FoveationLevel,
    holes: HoleMethod,
}

impl Contender {
    const fn new(name: &'static str, method: Method) -> Contender {
        Contender { name, method, foveation: FoveationLevel::Off, holes: HoleMethod::Filled }
    }
}

const CONTENDERS: [Contender; 6] = [
    Contender::new("conventional", Method::Conventional),
    Contender::new(MULTIVIEW, Method::Instanced),
    Contender::new("yoro-gather", Method::Synthesized),
    Contender { holes: HoleMethod::Rendered, ..Contender::new("yoro-holes-rendered", Method::Synthesized) },
    Contender {
        foveation: FoveationLevel::Medium,
        ..Contender::new("conventional-medium", Method::Conventional)
    },
    Contender { foveation: FoveationLevel::Medium, ..Contender::new("yoro-medium", Method::Synthesized) },
];
/// The passes of `gather`.
const PASSES: [&str; 3] = ["gather tiles", "gather spans", "gather march"];

fn main() -> anyhow::Result<()> {
    let args = Args::parse();
    ensure!(
        std::env::var_os("YORO_SHADERS").is_some(),
        "the shaders must count what they run: use cargo xtask maintain estimate"
    );
    let scenes: Vec<&Builtin> = match &args.scenes[..] {
        [] => replacements().collect(),
        named => BUILTINS.iter().filter(|builtin| named.iter().any(|name| name == builtin.name)).collect(),
    };
    let mut estimates = Vec::new();
    for builtin in scenes {
        eprintln!("counting {}", builtin.name);
        // A renderer that cannot read samples carries depth through their average, as phones do where they live in tiles.
        // Outlines need all samples, which phones read by OpenGL ES 3.1. Desktop GL counts samples.
        let limit: fn(&mut Capabilities) = match builtin.style {
            ShadingStyle::Anime => |_| {},
            _ => |capabilities| capabilities.multisample_textures = false,
        };
        let headless = Headless::open_limited(Backend::Osmesa, limit)?;
        for (label, bloom) in [("bloom", true), ("no bloom", false)] {
            estimates.extend(Estimator::new(headless.gl(), builtin.name, bloom)?.estimates(&args, label)?);
        }
    }
    ensure!(!estimates.is_empty(), "no built-in scene is called so");
    print!("{}", tables::report(estimates).to_markdown());
    Ok(())
}

/// A scene and what counts its frames.
struct Estimator {
    gl: Rc<Context>,
    /// Made before the scene, since it must know its textures.
    recorder: Recorder,
    scene: PreparedScene,
    name: &'static str,
    settings: RenderSettings,
    counter: Counter,
    model: FrameModel,
}

impl Estimator {
    fn new(gl: &Rc<Context>, name: &'static str, bloom: bool) -> anyhow::Result<Estimator> {
        // Phones render with the viewer's settings.
        let settings = RenderSettings { bloom, ..render_settings(&Default::default(), None) };
        let recorder = Recorder::new(gl);
        let scene = PreparedScene::new(gl, yoro_scenes::load(name, DEFAULT_SEED, None)?, &settings)?;
        let counter = Counter::new(gl, scene.renderer.depth_resolve)?;
        Ok(Estimator { gl: gl.clone(), recorder, scene, name, settings, counter, model: FrameModel::new()? })
    }

    fn estimates(&mut self, args: &Args, label: &'static str) -> anyhow::Result<Vec<Estimate>> {
        let eyes = EyeOptions { size: SIZE, fov_y: args.fov_y_degrees.to_radians(), ..EyeOptions::default() };
        let viewpoints = self.scene.scene.viewpoints.clone();
        let wanted = args.viewpoints.clamp(1, viewpoints.len());
        let mut estimates: Vec<Estimate> = Vec::new();
        for i in 0..wanted {
            let pair = eyes.pair(viewpoints[i * viewpoints.len() / wanted].pose());
            for (name, frame) in self.frames(&pair)? {
                match estimates.iter_mut().find(|estimate| estimate.method == name) {
                    Some(estimate) => estimate.frames.push(frame),
                    None => {
                        let (scene, frames) = (self.name, vec![frame]);
                        estimates.push(Estimate { scene, label, method: name, frames });
                    }
                }
            }
        }
        Ok(estimates)
    }

    /// Returns the costs of each method's frame at one place.
    fn frames(&mut self, pair: &EyePair) -> anyhow::Result<Vec<(&'static str, Frame)>> {
        let mut lamps = self.lamps(pair)?;
        let mut frames = Vec::new();
        for contender in CONTENDERS {
            let passes = self.record(&contender, pair)?;
            let counted = match contender.method {
                Method::Synthesized => self.count(pair, contender.foveation)?,
                _ => Vec::new(),
            };
            let mut frame = match contender.name {
                MULTIVIEW => self.model.multiview(&passes, pair.size, &mut lamps)?,
                _ => self.model.frame(&passes, pair.size, &mut lamps, laws(&counted))?,
            };
            self.add_synthesis(&mut frame, &passes, &counted)?;
            frames.push((contender.name, frame));
        }
        Ok(frames)
    }

    /// Returns the passes of a method's first frame.
    fn record(&mut self, contender: &Contender, pair: &EyePair) -> anyhow::Result<Vec<RecordedPass>> {
        let options = StereoOptions { policy: None, holes: contender.holes, ..StereoOptions::default() };
        let mut session = StereoSession::new(&self.gl, contender.method.into(), &self.settings, &options)?;
        let views = pair.stereo_views(contender.foveation.foveation().as_ref(), Gaze::Axes(pair.axes()))?;
        let mut images = StereoImages::new(&self.gl)?;
        session.prepare(&mut self.scene, views.inset.is_some())?;
        self.recorder.start();
        session.frame(&mut self.scene, &views, FrameTargets::Images(&mut images), None)?;
        let mut passes = self.recorder.take();
        correct_depth_formats(&mut passes);
        Ok(passes)
    }

    /// Counts the synthesis of each layer, with its share of the eye's pixels.
    fn count(&mut self, pair: &EyePair, level: FoveationLevel) -> anyhow::Result<Vec<(Counted, f64)>> {
        let pair = reversed(pair);
        let views = pair.stereo_views(level.foveation().as_ref(), Gaze::Axes(pair.axes()))?;
        let pixels = |size: [u32; 2]| f64::from(size[0]) * f64::from(size[1]);
        let mut counted = Vec::new();
        for layer in views.layers() {
            let views = layer.synthesis_views(StereoOptions::default().guard_band)?;
            let share = pixels(views.target.size) / pixels(pair.size);
            counted.push((self.counter.count(&mut self.scene, views)?, share));
        }
        Ok(counted)
    }

    /// Adds what the synthesis executes.
    fn add_synthesis(
        &self,
        frame: &mut Frame,
        passes: &[RecordedPass],
        counted: &[(Counted, f64)],
    ) -> anyhow::Result<()> {
        let depth = self.scene.renderer.depth_resolve;
        for gpu in GPUS {
            for (level, share) in counted {
                let Executed { slots, fetches, bytes } = level.executed(&gpu, depth, March::of(passes))?;
                let alone = PASSES
                    .into_iter()
                    .zip(slots)
                    .map(|(pass, slots)| (format!("slots/{}/{pass}", gpu.gpu), slots));
                let rest = [("fetches", fetches), ("traffic", bytes)]
                    .map(|(name, value)| (format!("{}{name}/{}", tables::SYNTHESIS_ALONE, gpu.gpu), value));
                for (metric, value) in alone.chain(rest) {
                    *frame.entry(metric).or_default() += share * value;
                }
            }
        }
        Ok(())
    }

    /// Returns the lights that reach the surfaces visible to the dominant eye.
    fn lamps(&mut self, pair: &EyePair) -> anyhow::Result<Lamps> {
        let view = reversed(pair).view(pair.dominant);
        let mut targets = ViewTargets::default();
        let PreparedScene { renderer, scene } = &mut self.scene;
        let rendered = renderer.render(&mut targets, scene, &view)?;
        let mut reader = DepthReader::new(&self.gl)?;
        reader.copy(&rendered.depth, view.size)?;
        Ok(Lamps::new(&view, &reader.read(), &scene.lights))
    }
}

/// Returns the share of the synthesized pixels whose tile has a law.
fn laws(counted: &[(Counted, f64)]) -> f64 {
    let all: f64 = counted.iter().map(|(_, share)| share).sum();
    counted.iter().map(|(level, share)| share * level.laws()).sum::<f64>() / all.max(f64::MIN_POSITIVE)
}

/// Returns the eyes with the only depth that can be carried.
fn reversed(pair: &EyePair) -> EyePair {
    let depth = DepthRange { convention: DepthConvention::Reversed, ..pair.depth };
    EyePair { depth, ..*pair }
}
