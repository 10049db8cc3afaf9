//! The experiments, as lists of settings to be measured.

use std::path::PathBuf;

use anyhow::ensure;

use super::bandwidth::{self, BandwidthOptions};
use super::contender::Contender;
use super::executed::{DEVICES, Device};
use super::frame;
use super::motion::Motion;
use super::record::Setting;
use super::scenes::LazyObject;
use crate::machine::Parameter;
use yoro::eyes::EyeOptions;
use yoro::synthesis::Edges;
use yoro_render::stereo::{AntiAliasing, Pipeline};
use yoro_render::{RenderSettings, RendererKind};
use yoro_scene::ShadingStyle;
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
    AntiAliasing "anti-aliasing" "Quality and frame time by what edges are made of: one sample per pixel, FXAA, MSAA with each kind of depth",
    Flicker "flicker" "Flicker of the synthesized eye from frame to frame along a camera path",
    GuardBand "guard-band" "Width, frame time and quality at the border by guard band, along a camera path",
    History "history" "Quality, flicker and frame time with what the other eye has seen, as the head moves",
    Reprojection "reprojection" "Quality of one render shown at a later pose of the head, and of canted eyes",
    Bandwidth "bandwidth" "Bit rate and quality as H.264 of one eye with depth, against both eyes, along a camera path",
    Stream "stream" "Bit rate and quality of a stream of one eye with depth, against both eyes, by quantizer and delay",
    ShaderCost "shader-cost" "Estimate of what the synthesis takes on three mobile GPUs, and with --frame whole frames on five, none of which need be here",
}

/// The kind of measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measure {
    /// Frames at viewpoints.
    Frames {
        /// Frame times, pass times, CPU time, memory.
        cost: bool,
        /// Likeness to the ground truth.
        quality: bool,
    },
    /// Flicker along a piece of the camera path.
    Flicker,
    /// Use of the guard band along a piece of the camera path.
    GuardBand,
    /// Frames of a moving head.
    History(Motion),
    /// Patchers on reprojected images.
    Patchers,
    /// One render shown at other poses.
    Reprojection(Displaced),
    /// Encoded sequences along a piece of the camera path.
    Bandwidth,
    /// A stream whose frames are shown a number of frames later, at 72 frames a second.
    Stream(usize),
    /// Instructions that `gather` executes: an estimate for a GPU that need not be here.
    Executed(Device),
    /// The same of whole frames, for several.
    WholeFrames,
}

/// The pose at which a render is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Displaced {
    /// That of the same eye a number of frames later, at 72 frames a second.
    Late(Motion, usize),
    /// That of the other one of two canted eyes.
    Canted,
}

/// The source of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A built-in scene or a file.
    Named(String),
    /// [`super::Object::swarm`].
    Swarm {
        /// Number of objects.
        copies: usize,
        /// Number of the largest swarm of the suite.
        places: usize,
    },
    /// [`super::Object::at_distance`], in metres.
    Object(f32),
}

/// One setting: all that is needed to measure it.
#[derive(Clone, Debug)]
pub struct Job {
    /// Its name in the results.
    pub setting: Setting,
    /// Its scene.
    pub source: Source,
    /// Another style than the scene's own.
    pub style: Option<ShadingStyle>,
    /// Renderer's settings.
    pub render: RenderSettings,
    /// The eyes.
    pub eyes: EyeOptions,
    /// When all contenders anti-alias; `None` leaves it to each method.
    pub anti_aliasing: Option<AntiAliasing>,
    /// Divisor of the ImBuffer's resolution.
    pub imbuffer: u32,
    /// Quantizers of encoded sequences.
    pub bandwidth: BandwidthOptions,
    /// The kind of measurement.
    pub measure: Measure,
    /// The contenders; the conventional method first where frames are measured.
    pub contenders: Vec<Contender>,
    /// Number of rounds.
    pub rounds: u32,
    /// Number of frames: viewpoints spread over the camera path, or frames along it.
    pub frames: usize,
}

impl Job {
    /// Returns the number of steps of progress: each contender's frames in each round, and getting ready.
    pub fn steps(&self) -> u64 {
        if self.measure == Measure::Bandwidth {
            return bandwidth::steps(self.frames, &self.bandwidth);
        }
        if let Measure::Stream(_) = self.measure {
            return (self.frames * 3 * STREAM_QUANTIZERS.len()) as u64;
        }
        if let Measure::Executed(_) | Measure::Reprojection(_) = self.measure {
            return self.frames as u64;
        }
        if self.measure == Measure::WholeFrames {
            return (self.frames * self.contenders.len()) as u64;
        }
        (u64::from(self.rounds) * self.frames as u64 + 1) * self.contenders.len() as u64
    }
}

/// The user's choices for all suites.
#[derive(Clone, Debug)]
pub struct Choices {
    /// The short form.
    pub quick: bool,
    /// The eyes, as the suites do not vary them.
    pub eyes: EyeOptions,
    /// The renderer's settings, as the suites do not vary them.
    pub render: RenderSettings,
    /// `shader-cost`: whole frames in place of the synthesis alone.
    pub whole_frames: bool,
    /// Timed rounds.
    pub rounds: u32,
    /// Viewpoints per scene.
    pub viewpoints: usize,
    /// Frames of the sequences of `bandwidth`.
    pub sequence: usize,
    /// Scenes instead of the suites' own.
    pub scenes: Vec<String>,
    /// Contenders instead of the suites' own.
    pub contenders: Vec<Contender>,
    /// Seed of the built-in scenes.
    pub seed: u64,
    /// File of the object of `distance` and `complexity`; the built-in one if none.
    pub object: Option<PathBuf>,
    /// Largest scene of `complexity`.
    pub max_triangles: usize,
}

/// Scenes of the suites that vary something else: one of each shading style.
const VARIED_SCENES: [&str; 5] = ["atrium", "voxel", "prototype", "talk", "stage"];
/// The one scene of such a suite in the short form.
const QUICK_SCENES: [&str; 1] = ["prototype"];
/// Number of sizes of the complexity suite, as in the paper, and in the short form.
const SIZES: [usize; 2] = [9, 5];
/// Lights of the suite `lights`: the paper has fewer than five.
const FEW_LIGHTS: usize = 4;
/// Settings of the suite `anti-aliasing`.
const SMOOTHING: [(&str, RendererKind, AntiAliasing); 3] = [
    ("one sample", RendererKind::Deferred, AntiAliasing::Off),
    ("FXAA", RendererKind::Deferred, AntiAliasing::After),
    ("MSAA", RendererKind::Forward, AntiAliasing::After),
];
/// Frames of the suite `flicker`.
const FLICKER_FRAMES: [usize; 2] = [12, 4];
/// Scenes of the suite `history`: those with the most to uncover, near and far.
const HISTORY_SCENES: [&str; 6] = ["talk", "street", "stage", "conference", "atrium", "voxel"];
/// Frames of the suite `history`.
const HISTORY_FRAMES: [usize; 2] = [24, 4];
/// Scenes of the suite `stream`.
const STREAM_SCENES: [&str; 3] = ["talk", "street", "atrium"];
/// Frames by which it shows frames late, at 72 a second: at rest, and after 28 and 69 ms.
const STREAM_DELAYS: [usize; 3] = [0, 2, 5];
/// H.264's quantizers in it.
pub(super) const STREAM_QUANTIZERS: [u8; 3] = [20, 26, 32];
/// Frames of the suite `stream`.
const STREAM_FRAMES: [usize; 2] = [8, 3];
/// Frames of the suite `guard-band`.
const GUARD_BAND_FRAMES: [usize; 2] = [36, 6];

impl Choices {
    /// The settings of a suite, in the order in which they are measured: those that share a scene follow each
    /// other. `object` is the object of `distance` and `complexity`.
    ///
    /// # Errors
    /// One sentence when the choices leave nothing to measure.
    pub fn jobs(&self, suite: Suite, object: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let time = Measure::Frames { cost: true, quality: false };
        let quality = Measure::Frames { cost: false, quality: true };
        let both = Measure::Frames { cost: true, quality: true };
        let all = Contender::methods();
        let synthesis = || [vec![Contender::MONO], Contender::pipelines()].concat();
        let every: Vec<&str> = BUILTINS.iter().map(|b| b.name).collect();
        let plan = |measure, contenders: Vec<Contender>| Plan { choices: self, suite, measure, contenders };
        match suite {
            Suite::Scenes => plan(both, all).over(self.scenes(&every), [()], |_, ()| {}),
            Suite::Complexity => self.complexity(plan(time, all), object),
            Suite::Styles => {
                plan(quality, synthesis()).over(self.varied(), ShadingStyle::ALL, |job, style| {
                    job.style = Some(style);
                    job.setting.label = Some(style.name().to_owned());
                })
            }
            Suite::Ipd => self.ipd(plan(quality, synthesis())),
            Suite::Distance => self.distance(plan(quality, synthesis()), object),
            Suite::Patchers => {
                let patchers = [vec![Contender::MONO], Contender::patchers()].concat();
                plan(Measure::Patchers, patchers).over(self.varied(), [()], |_, ()| {})
            }
            Suite::Imbuffer => {
                let contenders = vec![
                    Contender::CONVENTIONAL,
                    Contender::MONO,
                    Contender::Yoro(Pipeline::Paper),
                    Contender::PaperNearest,
                    Contender::PaperStrict,
                ];
                plan(both, contenders).over(self.varied(), [1, 2, 4, 8, 16], |job, divisor| {
                    job.imbuffer = divisor;
                    job.setting.point = Some(f64::from(divisor));
                })
            }
            Suite::Lights => plan(time, all).over(self.scenes(&every), [FEW_LIGHTS], |job, lights| {
                job.render.point_lights = lights;
                job.setting.point = Some(lights as f64);
            }),
            Suite::Resolution => self.resolution(plan(both, all)),
            Suite::AntiAliasing => {
                let baselines = vec![Contender::CONVENTIONAL, Contender::MONO];
                self.anti_aliasing(plan(both, [baselines, Contender::edges()].concat()), &every)
            }
            Suite::Flicker => {
                // With samples at the edges, flicker depends on how the synthesis reads them: one pipeline only.
                let edges = || [vec![Contender::MONO], Contender::edges()].concat();
                let contenders = if self.render.is_forward() { edges() } else { synthesis() };
                plan(Measure::Flicker, contenders).over(self.varied(), [()], |job, ()| {
                    job.frames = FLICKER_FRAMES[usize::from(self.quick)];
                })
            }
            Suite::GuardBand => {
                let contenders = [vec![Contender::MONO], Contender::bands()].concat();
                plan(Measure::GuardBand, contenders).over(self.scenes(&every), [()], |job, ()| {
                    job.frames = GUARD_BAND_FRAMES[usize::from(self.quick)];
                })
            }
            Suite::History => {
                let contenders = [vec![Contender::MONO], Contender::histories()].concat();
                self.history(plan(Measure::History(Motion::Still), contenders))
            }
            Suite::Reprojection => {
                self.reprojection(plan(Measure::Reprojection(Displaced::Canted), Vec::new()))
            }
            Suite::Bandwidth => self.bandwidth(plan(Measure::Bandwidth, Vec::new()), &every),
            Suite::Stream => self.stream(plan(Measure::Stream(0), Vec::new())),
            Suite::ShaderCost if self.whole_frames => {
                self.whole_frames(plan(Measure::WholeFrames, vec![Contender::CONVENTIONAL]), &every)
            }
            Suite::ShaderCost => self.executed(plan(Measure::Executed(DEVICES[0]), Vec::new()), &every),
            Suite::All => {
                let each = Suite::EACH.iter().map(|suite| self.jobs(*suite, object));
                Ok(each.collect::<anyhow::Result<Vec<_>>>()?.concat())
            }
        }
    }

    fn complexity(&self, plan: Plan, object: &LazyObject) -> anyhow::Result<Vec<Job>> {
        // Sizes grow in even steps, the first being one step: a slope is seen only where all else is equal.
        let sizes = SIZES[usize::from(self.quick)];
        let step = (self.max_triangles / sizes / object.triangles()).max(1);
        let places = step * sizes;
        let copies: Vec<usize> = (1..=sizes).map(|i| i * step).collect();
        plan.over(vec!["swarm".into()], copies, |job, copies| {
            job.source = Source::Swarm { copies, places };
            job.setting.point = Some(object.swarm_triangles(copies) as f64);
            job.frames = 1;
        })
    }

    fn ipd(&self, plan: Plan) -> anyhow::Result<Vec<Job>> {
        let millimetres: &[u32] = if self.quick { &[50, 63, 75] } else { &[50, 55, 60, 65, 70, 75] };
        plan.over(self.varied(), millimetres.iter().copied(), |job, mm| {
            job.eyes.ipd = mm as f32 * 1e-3;
            job.setting.point = Some(f64::from(mm));
        })
    }

    fn distance(&self, plan: Plan, object: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let metres: &[f32] = if self.quick { &[0.5, 1.0, 3.0] } else { &[0.5, 1.0, 1.5, 2.0, 2.5, 3.0] };
        plan.over(vec![object.name.clone()], metres.iter().copied(), |job, metres| {
            job.source = Source::Object(metres);
            job.setting.point = Some(f64::from(metres));
        })
    }

    fn resolution(&self, plan: Plan) -> anyhow::Result<Vec<Job>> {
        let pixels: &[u32] = if self.quick { &[256, 512] } else { &[512, 1024, 1536, 2048] };
        plan.over(self.varied(), pixels.iter().copied(), |job, pixels| {
            job.eyes.size = [pixels; 2];
            job.setting.point = Some(f64::from(pixels));
            job.frames = 1;
        })
    }

    fn anti_aliasing(&self, plan: Plan, scenes: &[&str]) -> anyhow::Result<Vec<Job>> {
        plan.over(self.scenes(scenes), SMOOTHING, |job, (label, renderer, anti_aliasing)| {
            job.setting.label = Some(label.to_owned());
            job.render.renderer = renderer;
            job.anti_aliasing = Some(anti_aliasing);
            // Without samples there is one thing to say of edges.
            let says_more = |c: &Contender| matches!(c, Contender::Edges(edges) if *edges != Edges::Hard);
            job.contenders.retain(|c| renderer == RendererKind::Forward || !says_more(c));
        })
    }

    fn history(&self, plan: Plan) -> anyhow::Result<Vec<Job>> {
        let scenes = if self.quick { &QUICK_SCENES[..] } else { &HISTORY_SCENES };
        plan.over(self.scenes(scenes), Motion::ALL, |job, motion| {
            job.measure = Measure::History(motion);
            job.setting.label = Some(motion.name().to_owned());
            job.frames = HISTORY_FRAMES[usize::from(self.quick)];
        })
    }

    fn reprojection(&self, plan: Plan) -> anyhow::Result<Vec<Job>> {
        let late = |motion| [1, 2, 3, 4].map(|frames| Displaced::Late(motion, frames));
        let poses = [vec![Displaced::Canted], late(Motion::Sway).into(), late(Motion::Walk).into()];
        let scenes = if self.quick { &QUICK_SCENES[..] } else { &VARIED_SCENES };
        plan.over(self.scenes(scenes), poses.concat(), |job, displaced| {
            // Ways to show a render take part, not methods.
            job.contenders.clear();
            job.measure = Measure::Reprojection(displaced);
            job.setting.label = Some(match displaced {
                Displaced::Canted => "canted eyes".to_owned(),
                Displaced::Late(motion, frames) => format!("{}, {frames} late", motion.name()),
            });
        })
    }

    fn bandwidth(&self, plan: Plan, scenes: &[&str]) -> anyhow::Result<Vec<Job>> {
        plan.over(self.scenes(scenes), [()], |job, ()| {
            // Streams take part, not methods.
            job.contenders.clear();
            job.frames = self.sequence;
            if self.quick {
                job.bandwidth.quantizers = vec![22, 28, 34, 40];
            }
        })
    }

    fn stream(&self, plan: Plan) -> anyhow::Result<Vec<Job>> {
        let scenes = if self.quick { &QUICK_SCENES[..] } else { &STREAM_SCENES };
        plan.over(self.scenes(scenes), STREAM_DELAYS, |job, late| {
            // Modes take part, not methods.
            job.contenders.clear();
            job.measure = Measure::Stream(late);
            job.setting.label = Some(format!("{late} late"));
            job.frames = STREAM_FRAMES[usize::from(self.quick)];
        })
    }

    fn whole_frames(&self, plan: Plan, scenes: &[&str]) -> anyhow::Result<Vec<Job>> {
        plan.over(self.scenes(scenes), RendererKind::ALL, |job, renderer| {
            job.setting.suite = frame::SUITE.to_owned();
            job.setting.label = Some(renderer.name().to_owned());
            job.render.renderer = renderer;
            job.contenders = frame::contenders(renderer);
        })
    }

    fn executed(&self, plan: Plan, scenes: &[&str]) -> anyhow::Result<Vec<Job>> {
        plan.over(self.scenes(scenes), DEVICES, |job, device| {
            // GPUs take part, not methods.
            job.contenders.clear();
            job.measure = Measure::Executed(device);
            // Depth is all that counts.
            job.render =
                RenderSettings { ssao: false, bloom: false, shadow_map_size: 0, ..job.render.clone() };
            job.eyes.size = device.size;
            job.setting.label = Some(device.name.to_owned());
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

    /// Returns everything that has an influence on the figures, to be printed and compared.
    pub fn parameters(&self) -> Vec<Parameter> {
        let eyes = &self.eyes;
        let list = |names: Vec<String>| {
            if names.is_empty() { "those of the suite".to_owned() } else { names.join(", ") }
        };
        let object =
            self.object.as_ref().map_or_else(|| "built-in".into(), |path| path.display().to_string());
        let mut parameters = vec![
            ("size of each eye, pixels", format!("{} x {}", eyes.size[0], eyes.size[1])),
            ("vertical field of view, degrees", format!("{:.0}", eyes.fov_y.to_degrees())),
            ("IPD, metres", eyes.ipd.to_string()),
            ("near and far plane, metres", format!("{} and {}", eyes.depth.near, eyes.depth.far)),
            ("dominant eye", eyes.dominant.name().into()),
            ("rounds", self.rounds.to_string()),
            ("viewpoints per scene", self.viewpoints.to_string()),
            ("frames of encoded sequences", self.sequence.to_string()),
            ("seed", self.seed.to_string()),
            ("scenes", list(self.scenes.clone())),
            ("contenders", list(self.contenders.iter().map(|c| c.name()).collect())),
            ("object", object),
            ("largest scene, triangles", self.max_triangles.to_string()),
        ];
        if self.render.is_forward() {
            parameters.push(("renderer", self.render.summary()));
        }
        parameters.into_iter().map(|(name, value)| Parameter { name: name.into(), value }).collect()
    }
}

/// A suite about to be unfolded into its settings.
struct Plan<'a> {
    choices: &'a Choices,
    suite: Suite,
    measure: Measure,
    contenders: Vec<Contender>,
}

impl Plan<'_> {
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
        // Every figure stands beside its baseline, whoever was chosen.
        let quality = !matches!(self.measure, Measure::Frames { quality: false, .. });
        if quality && !contenders.contains(&Contender::MONO) {
            contenders.insert(0, Contender::MONO);
        }
        if self.measure != Measure::Patchers {
            contenders.retain(|c| *c != Contender::CONVENTIONAL);
            contenders.insert(0, Contender::CONVENTIONAL);
        }
        let rounds = match self.measure {
            Measure::Frames { cost: true, .. } | Measure::Patchers => choices.rounds,
            _ => 1,
        };
        let points: Vec<P> = points.into_iter().collect();
        let mut jobs = Vec::new();
        for scene in scenes {
            for point in &points {
                let suite = self.suite.name().to_owned();
                let mut job = Job {
                    setting: Setting { suite, scene: scene_name(&scene), label: None, point: None },
                    source: Source::Named(scene.clone()),
                    style: None,
                    render: choices.render.clone(),
                    eyes: choices.eyes,
                    anti_aliasing: None,
                    imbuffer: 1,
                    bandwidth: BandwidthOptions::default(),
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

/// Returns a built-in scene's name, or a file's stem.
fn scene_name(scene: &str) -> String {
    if BUILTINS.iter().any(|b| b.name == scene) {
        return scene.to_owned();
    }
    let stem = std::path::Path::new(scene).file_stem();
    stem.map_or_else(|| scene.to_owned(), |stem| stem.to_string_lossy().into_owned())
}
