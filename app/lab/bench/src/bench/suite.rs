//! The suites: experiments as lists of settings to be measured.

use std::path::PathBuf;

use anyhow::ensure;

use super::contender::Contender;
use super::frame;
use super::job::{Job, Measure, Source, TargetPose};
use super::motion::Motion;
use super::record::Conditions;
use super::scenes::LazyObject;
use crate::machine::Parameter;
use yoro::eyes::{EyeOptions, FoveationLevel};
use yoro_assets::ShadingStyle;
use yoro_estimate::DEVICES;
use yoro_render::stereo::Pipeline;
use yoro_render::{MSAA, RenderSettings};
use yoro_scenes::BUILTINS;

/// Defines [`Suite`] from one list: the variant, its name on the command line and in files, and what it measures.
macro_rules! suites {
    ($($variant:ident $name:literal $about:literal,)*) => {
        /// An experiment.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Suite {
            $(#[doc = $about] $variant,)*
            /// All of them, one after the other
            All,
        }

        impl Suite {
            /// Each suite, in the order in which [`Suite::All`] runs them.
            pub const EACH: &[Suite] = &[$(Suite::$variant),*];

            /// Returns its name on the command line and in files.
            pub fn name(self) -> &'static str {
                match self {
                    $(Suite::$variant => $name,)*
                    Suite::All => "all",
                }
            }

            /// Returns what it measures, in a line.
            pub fn about(self) -> &'static str {
                match self {
                    $(Suite::$variant => $about,)*
                    Suite::All => "All of them, one after the other",
                }
            }
        }
    };
}

suites! {
    Scenes "scenes" "Frame time and quality of every method on eight scenes",
    Complexity "complexity" "Frame time of every method as the number of triangles grows",
    Styles "styles" "Quality in each shading style",
    Ipd "ipd" "Quality as the distance between the eyes grows from 50 to 75 mm",
    Distance "distance" "Quality as an object, equally large on the screen, moves from 0.5 to 3 m",
    Patchers "patchers" "Quality and time of the patchers on the same reprojected images",
    Imbuffer "imbuffer" "Frame time and quality with the ImBuffer at 1 to 1/16 of the resolution, with and without interpolation",
    Lights "lights" "Frame time of every method with four lights: the paper's setting for single-pass instancing",
    Resolution "resolution" "Frame time and quality of every method from 512 to 2048 pixels per eye",
    AntiAliasing "anti-aliasing" "Quality and frame time with one, two and four samples per pixel",
    Flicker "flicker" "Flicker of the synthesized eye from frame to frame along a camera path",
    Reprojection "reprojection" "Quality of one render shown at a later pose of the head, and of canted eyes",
    HalfRate "half-rate" "Quality and time of the frame that a runtime makes between two renders, from both eyes' motion or from one eye's",
    Foveation "foveation" "Frame time, shaded pixels and quality of eyes with all pixels only where they look, by two renders and by synthesis, at 60 and 90 degrees",
    Stream "stream" "Bit rate and quality of a stream of one eye with depth, against both eyes, by quantizer and delay",
    ShaderCost "shader-cost" "Estimate of what the synthesis takes on three mobile GPUs, and with --frame whole frames on six, none of which need be here",
}

/// The user's choices for all suites.
#[derive(Clone, Debug)]
pub struct Choices {
    /// True for the short form.
    pub quick: bool,
    /// The eyes, except where a suite varies them.
    pub eyes: EyeOptions,
    /// The renderer's settings, except where a suite varies them.
    pub render: RenderSettings,
    /// True if `shader-cost` estimates whole frames instead of the synthesis alone.
    pub whole_frames: bool,
    /// The number of timed rounds.
    pub rounds: u32,
    /// The number of viewpoints per scene.
    pub viewpoints: usize,
    /// Scenes that replace the suites' own.
    pub scenes: Vec<String>,
    /// Contenders that replace the suites' own.
    pub contenders: Vec<Contender>,
    /// The seed of the built-in scenes.
    pub seed: u64,
    /// The file with the object of `distance` and `complexity`; `None` for the built-in one.
    pub object: Option<PathBuf>,
    /// The number of triangles of the largest scene of `complexity`.
    pub max_triangles: usize,
}

/// The scenes of suites that vary something else: one for each shading style.
const VARIED_SCENES: [&str; 5] = ["atrium", "voxel", "prototype", "talk", "stage"];
/// The one scene of these suites in the short form.
const QUICK_SCENES: [&str; 1] = ["prototype"];
/// The number of sizes of the suite `complexity`: as in the paper, and in the short form.
const SIZES: [usize; 2] = [9, 5];
/// The number of lights of the suite `lights`: the paper has fewer than five.
const FEW_LIGHTS: usize = 4;
/// The number of frames of the suite `flicker`, and in the short form.
const FLICKER_FRAMES: [usize; 2] = [12, 4];
/// The scenes of the suite `half-rate`: those with people who move.
const MOVING_SCENES: [&str; 2] = ["talk", "stage"];
/// The vertical fields of view of the suite `foveation` in degrees.
const FOVEATED_DEGREES: [f32; 2] = [60.0, 90.0];
/// The scenes of the suite `stream`.
const STREAM_SCENES: [&str; 3] = ["talk", "street", "atrium"];
/// The numbers of frames by which the suite `stream` shows frames late, at 72 per second: at once, after 28 and 69 ms.
const STREAM_DELAYS: [usize; 3] = [0, 2, 5];
/// The number of frames of the suite `stream`, and in the short form.
const STREAM_FRAMES: [usize; 2] = [8, 3];
/// The number of frames of the suite `guard-band`, and in the short form.

impl Choices {
    /// Returns the settings of a suite in the order of measurement: those that share a scene follow each other.
    /// `object` is the object of `distance` and `complexity`.
    ///
    /// # Errors
    /// One sentence if the choices leave nothing to measure.
    pub fn jobs(&self, suite: Suite, object: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let time = Measure::Frames { cost: true, quality: false };
        let quality = Measure::Frames { cost: false, quality: true };
        let both = Measure::Frames { cost: true, quality: true };
        let all = Contender::methods();
        let synthesis = || [vec![Contender::MONO], Contender::pipelines()].concat();
        let every: Vec<&str> = BUILTINS.iter().map(|b| b.name).collect();
        let sweep = |measure, contenders: Vec<Contender>| Sweep { choices: self, suite, measure, contenders };
        match suite {
            Suite::Scenes => sweep(both, all).over(self.scenes(&every), [()], |_, ()| {}),
            Suite::Complexity => self.complexity(sweep(time, all), object),
            Suite::Styles => {
                sweep(quality, synthesis()).over(self.varied(), ShadingStyle::ALL, |job, style| {
                    job.style = Some(style);
                    job.conditions.label = Some(style.name().to_owned());
                })
            }
            Suite::Ipd => self.ipd(sweep(quality, synthesis())),
            Suite::Distance => self.distance(sweep(quality, synthesis()), object),
            Suite::Patchers => {
                let patchers = [vec![Contender::MONO], Contender::patchers()].concat();
                sweep(Measure::Patchers, patchers).over(self.varied(), [()], |_, ()| {})
            }
            Suite::Imbuffer => {
                let contenders = vec![
                    Contender::CONVENTIONAL,
                    Contender::MONO,
                    Contender::Synthesized(Pipeline::Paper),
                    Contender::PaperNearest,
                    Contender::PaperStrict,
                ];
                sweep(both, contenders).over(self.varied(), [1, 2, 4, 8, 16], |job, divisor| {
                    job.imbuffer = divisor;
                    job.conditions.point = Some(f64::from(divisor));
                })
            }
            Suite::Lights => sweep(time, all).over(self.scenes(&every), [FEW_LIGHTS], |job, lights| {
                job.render.point_lights = lights;
                job.conditions.point = Some(lights as f64);
            }),
            Suite::Resolution => self.resolution(sweep(both, all)),
            Suite::AntiAliasing => {
                let contenders =
                    vec![Contender::CONVENTIONAL, Contender::MONO, Contender::Synthesized(Pipeline::Gather)];
                self.anti_aliasing(sweep(both, contenders), &every)
            }
            Suite::Flicker => sweep(Measure::Flicker, synthesis()).over(self.varied(), [()], |job, ()| {
                job.frames = FLICKER_FRAMES[usize::from(self.quick)];
            }),
            Suite::Reprojection => {
                self.reprojection(sweep(Measure::Reprojection(TargetPose::Canted), Vec::new()))
            }
            Suite::HalfRate => {
                self.half_rate(sweep(Measure::HalfRate(Motion::Still, FoveationLevel::Off), Vec::new()))
            }
            Suite::Foveation => self.foveation(sweep(Measure::Foveation, Vec::new()), &every),
            Suite::Stream => self.stream(sweep(Measure::Stream(0), Vec::new())),
            Suite::ShaderCost if self.whole_frames => {
                self.whole_frames(sweep(Measure::WholeFrames, vec![Contender::CONVENTIONAL]), &every)
            }
            Suite::ShaderCost => self.executed(sweep(Measure::Executed(DEVICES[0]), Vec::new()), &every),
            Suite::All => {
                let each = Suite::EACH.iter().map(|suite| self.jobs(*suite, object));
                Ok(each.collect::<anyhow::Result<Vec<_>>>()?.concat())
            }
        }
    }

    fn complexity(&self, sweep: Sweep, object: &LazyObject) -> anyhow::Result<Vec<Job>> {
        // Sizes grow in even steps, the first of which is one step. Slopes are measurable only if all else is equal.
        let sizes = SIZES[usize::from(self.quick)];
        let step = (self.max_triangles / sizes / object.triangles()).max(1);
        let places = step * sizes;
        let copies: Vec<usize> = (1..=sizes).map(|i| i * step).collect();
        sweep.over(vec!["swarm".into()], copies, |job, copies| {
            job.source = Source::Swarm { copies, places };
            job.conditions.point = Some(object.swarm_triangles(copies) as f64);
            job.frames = 1;
        })
    }

    fn ipd(&self, sweep: Sweep) -> anyhow::Result<Vec<Job>> {
        let millimetres: &[u32] = if self.quick { &[50, 63, 75] } else { &[50, 55, 60, 65, 70, 75] };
        sweep.over(self.varied(), millimetres.iter().copied(), |job, mm| {
            job.eyes.ipd = mm as f32 * 1e-3;
            job.conditions.point = Some(f64::from(mm));
        })
    }

    fn distance(&self, sweep: Sweep, object: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let metres: &[f32] = if self.quick { &[0.5, 1.0, 3.0] } else { &[0.5, 1.0, 1.5, 2.0, 2.5, 3.0] };
        sweep.over(vec![object.name.clone()], metres.iter().copied(), |job, metres| {
            job.source = Source::Object(metres);
            job.conditions.point = Some(f64::from(metres));
        })
    }

    fn resolution(&self, sweep: Sweep) -> anyhow::Result<Vec<Job>> {
        let pixels: &[u32] = if self.quick { &[256, 512] } else { &[512, 1024, 1536, 2048] };
        sweep.over(self.varied(), pixels.iter().copied(), |job, pixels| {
            job.eyes.size = [pixels; 2];
            job.conditions.point = Some(f64::from(pixels));
            job.frames = 1;
        })
    }

    fn anti_aliasing(&self, sweep: Sweep, scenes: &[&str]) -> anyhow::Result<Vec<Job>> {
        sweep.over(self.scenes(scenes), MSAA, |job, samples| {
            job.conditions.label = Some(match samples {
                1 => "1 sample".to_owned(),
                n => format!("{n} samples"),
            });
            job.render.msaa = samples;
        })
    }

    fn reprojection(&self, sweep: Sweep) -> anyhow::Result<Vec<Job>> {
        let late = |motion| [1, 2, 3, 4].map(|frames| TargetPose::Late(motion, frames));
        let poses = [vec![TargetPose::Canted], late(Motion::Sway).into(), late(Motion::Walk).into()];
        let scenes = if self.quick { &QUICK_SCENES[..] } else { &VARIED_SCENES };
        sweep.over(self.scenes(scenes), poses.concat(), |job, displaced| {
            // Ways of showing a render take part, not methods.
            job.contenders.clear();
            job.measure = Measure::Reprojection(displaced);
            job.conditions.label = Some(match displaced {
                TargetPose::Canted => "canted eyes".to_owned(),
                TargetPose::Late(motion, frames) => format!("{}, {frames} late", motion.name()),
            });
        })
    }

    fn half_rate(&self, sweep: Sweep) -> anyhow::Result<Vec<Job>> {
        let whole = [Motion::Still, Motion::Walk, Motion::Strafe, Motion::Turn, Motion::Reach]
            .map(|motion| (motion, FoveationLevel::Off));
        let motions = whole.into_iter().chain([(Motion::Walk, FoveationLevel::Medium)]);
        let scenes = if self.quick { &MOVING_SCENES[..1] } else { &MOVING_SCENES };
        sweep.over(self.scenes(scenes), motions, |job, (motion, level)| {
            // Ways of making a frame take part, not methods.
            job.contenders.clear();
            job.measure = Measure::HalfRate(motion, level);
            job.conditions.label = Some(match level {
                FoveationLevel::Off => motion.name().to_owned(),
                level => {
                    job.eyes.fov_y = FOVEATED_DEGREES[1].to_radians();
                    format!("{}, foveation {}, {} degrees", motion.name(), level.name(), FOVEATED_DEGREES[1])
                }
            });
        })
    }

    fn foveation(&self, sweep: Sweep, scenes: &[&str]) -> anyhow::Result<Vec<Job>> {
        let scenes = if self.quick { &QUICK_SCENES[..] } else { scenes };
        sweep.over(self.scenes(scenes), FOVEATED_DEGREES, |job, degrees| {
            // Levels of two methods take part, in an order of their own.
            job.contenders.clear();
            job.eyes.fov_y = degrees.to_radians();
            job.conditions.label = Some(format!("{degrees} degrees"));
        })
    }

    fn stream(&self, sweep: Sweep) -> anyhow::Result<Vec<Job>> {
        let scenes = if self.quick { &QUICK_SCENES[..] } else { &STREAM_SCENES };
        sweep.over(self.scenes(scenes), STREAM_DELAYS, |job, late| {
            // Modes take part, not methods.
            job.contenders.clear();
            job.measure = Measure::Stream(late);
            job.conditions.label = Some(format!("{late} late"));
            job.frames = STREAM_FRAMES[usize::from(self.quick)];
        })
    }

    fn whole_frames(&self, sweep: Sweep, scenes: &[&str]) -> anyhow::Result<Vec<Job>> {
        sweep.over(self.scenes(scenes), frame::LABELS, |job, (label, bloom)| {
            job.conditions.suite = frame::SUITE.to_owned();
            job.conditions.label = Some(label.to_owned());
            job.render.bloom = bloom;
            job.contenders = frame::contenders();
        })
    }

    fn executed(&self, sweep: Sweep, scenes: &[&str]) -> anyhow::Result<Vec<Job>> {
        sweep.over(self.scenes(scenes), DEVICES, |job, device| {
            // GPUs take part, not methods.
            job.contenders.clear();
            job.measure = Measure::Executed(device);
            // Only depth matters.
            job.render = RenderSettings { bloom: false, shadow_map_size: 0, ..job.render.clone() };
            job.eyes.size = device.size;
            job.conditions.label = Some(device.name.to_owned());
        })
    }

    fn scenes(&self, own: &[&str]) -> Vec<String> {
        if self.scenes.is_empty() {
            own.iter().map(|name| (*name).to_owned()).collect()
        } else {
            self.scenes.clone()
        }
    }

    fn varied(&self) -> Vec<String> {
        self.scenes(if self.quick { &QUICK_SCENES } else { &VARIED_SCENES })
    }

    /// Returns everything that influences the figures, to be printed and compared.
    pub fn parameters(&self) -> Vec<Parameter> {
        let eyes = &self.eyes;
        let list = |names: Vec<String>| {
            if names.is_empty() { "those of the suite".to_owned() } else { names.join(", ") }
        };
        let object =
            self.object.as_ref().map_or_else(|| "built-in".into(), |path| path.display().to_string());
        let parameters = vec![
            ("size of each eye, pixels", format!("{} x {}", eyes.size[0], eyes.size[1])),
            ("vertical field of view, degrees", format!("{:.0}", eyes.fov_y.to_degrees())),
            ("IPD, metres", eyes.ipd.to_string()),
            ("near and far plane, metres", format!("{} and {}", eyes.depth.near, eyes.depth.far)),
            ("dominant eye", eyes.dominant.name().into()),
            ("rounds", self.rounds.to_string()),
            ("samples per pixel", self.render.msaa.to_string()),
            ("viewpoints per scene", self.viewpoints.to_string()),
            ("seed", self.seed.to_string()),
            ("scenes", list(self.scenes.clone())),
            ("contenders", list(self.contenders.iter().map(|c| c.name()).collect())),
            ("object", object),
            ("largest scene, triangles", self.max_triangles.to_string()),
        ];
        parameters.into_iter().map(|(name, value)| Parameter { name: name.into(), value }).collect()
    }
}

/// A suite that is about to be expanded into its settings.
struct Sweep<'a> {
    choices: &'a Choices,
    suite: Suite,
    measure: Measure,
    contenders: Vec<Contender>,
}

impl Sweep<'_> {
    /// Returns a job for each scene and point of the sweep; `vary` adapts it to the point.
    fn over<P: Clone>(
        self,
        scenes: Vec<String>,
        points: impl IntoIterator<Item = P>,
        vary: impl Fn(&mut Job, P),
    ) -> anyhow::Result<Vec<Job>> {
        let choices = self.choices;
        let mut contenders = self.contenders;
        if !choices.contenders.is_empty() {
            contenders.retain(|c| choices.contenders.contains(c));
            ensure!(
                !contenders.is_empty(),
                "none of the contenders given takes part in the suite {}: choose others, or another suite",
                self.suite.name()
            );
        }
        // Every figure is shown beside its baseline, whatever contenders were chosen.
        let quality = !matches!(self.measure, Measure::Frames { quality: false, .. });
        if quality && !contenders.contains(&Contender::MONO) {
            contenders.insert(0, Contender::MONO);
        }
        if self.measure != Measure::Patchers {
            contenders.retain(|c| *c != Contender::CONVENTIONAL);
            contenders.insert(0, Contender::CONVENTIONAL);
        }
        let rounds = match self.measure {
            Measure::Frames { cost: true, .. } | Measure::Foveation | Measure::Patchers => choices.rounds,
            _ => 1,
        };
        let points: Vec<P> = points.into_iter().collect();
        let mut jobs = Vec::new();
        for scene in scenes {
            for point in &points {
                let suite = self.suite.name().to_owned();
                let mut job = Job {
                    conditions: Conditions { suite, scene: scene_name(&scene), label: None, point: None },
                    source: Source::Named(scene.clone()),
                    style: None,
                    render: choices.render.clone(),
                    eyes: choices.eyes,
                    imbuffer: 1,
                    measure: self.measure,
                    contenders: contenders.clone(),
                    rounds,
                    frames: choices.viewpoints,
                };
                vary(&mut job, point.clone());
                jobs.push(job);
            }
        }
        Ok(jobs)
    }
}

/// Returns the name of a built-in scene, or the stem of a file's name.
fn scene_name(scene: &str) -> String {
    if BUILTINS.iter().any(|b| b.name == scene) {
        return scene.to_owned();
    }
    let stem = std::path::Path::new(scene).file_stem();
    stem.map_or_else(|| scene.to_owned(), |stem| stem.to_string_lossy().into_owned())
}
