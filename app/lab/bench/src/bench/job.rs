//! Jobs: what is measured under one set of conditions.

use std::path::PathBuf;
use std::rc::Rc;

use anyhow::ensure;

use super::Experiment;
use super::contender::Contender;
use super::record::Conditions;
use crate::machine::Parameter;
use yoro::eyes::EyeOptions;
use yoro_assets::ShadingStyle;
use yoro_render::RenderSettings;
use yoro_render::stereo::{Pipeline, StereoOptions};
use yoro_scenes::{BUILTINS, replacements};

/// The user's choices for all suites.
#[derive(Clone)]
pub struct Choices {
    /// True for the short form.
    pub quick: bool,
    /// True to time passes as well, in frames of their own.
    pub times_passes: bool,
    /// The eyes, except where a suite varies them.
    pub eyes: EyeOptions,
    /// The renderer's settings, except where a suite varies them.
    pub render: RenderSettings,
    /// Returns the options of methods with a pipeline. Near frames are not rendered twice in place of what is measured.
    pub options: Rc<dyn Fn(Pipeline) -> StereoOptions>,
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

/// The source of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A built-in scene or a file.
    Named(String),
    /// The scene of [`super::Object::swarm`].
    Swarm {
        /// The number of objects.
        copies: usize,
        /// The number of objects in the largest swarm of the suite.
        places: usize,
    },
    /// The scene of [`super::Object::at_distance`], with the distance in metres.
    Object(f32),
}

/// One setting with everything that is needed to measure it.
#[derive(Clone)]
pub struct Job {
    /// The experiment that measures it.
    pub experiment: &'static dyn Experiment,
    /// The name in the results.
    pub conditions: Conditions,
    /// The source of the scene.
    pub source: Source,
    /// A style that replaces the scene's own.
    pub style: Option<ShadingStyle>,
    /// The renderer's settings.
    pub render: RenderSettings,
    /// The eyes.
    pub eyes: EyeOptions,
    /// The index among the points of a sweep.
    pub point: usize,
    /// The contenders; none if the experiment has its own. If frames are timed, the conventional method is the first.
    pub contenders: Vec<Contender>,
    /// The number of rounds.
    pub rounds: u32,
    /// The number of frames: viewpoints spread over the camera path, or frames along it.
    pub frames: usize,
}

/// The scenes of suites that vary something else: one for each shading style.
pub(super) const VARIED_SCENES: [&str; 5] = ["atrium", "voxel", "prototype", "talk", "stage"];
/// The one scene of these suites in the short form.
pub(super) const QUICK_SCENES: [&str; 1] = ["prototype"];

impl Choices {
    /// Returns the user's scenes or, if there are none, these.
    pub(super) fn scenes<'a>(&self, own: impl IntoIterator<Item = &'a str>) -> Vec<String> {
        if self.scenes.is_empty() {
            own.into_iter().map(str::to_owned).collect()
        } else {
            self.scenes.clone()
        }
    }

    /// Returns the scenes of a suite on all scenes that replace the paper's.
    pub(super) fn all_scenes(&self) -> Vec<String> {
        self.scenes(replacements().map(|builtin| builtin.name))
    }

    /// Returns the scenes of a suite that varies something else than the scene.
    pub(super) fn varied_scenes(&self) -> Vec<String> {
        if self.quick { self.scenes(QUICK_SCENES) } else { self.scenes(VARIED_SCENES) }
    }

    /// Returns one of two values: that of the long form, or that of the short one.
    pub(super) fn long_or_quick<T>(&self, long: T, quick: T) -> T {
        if self.quick { quick } else { long }
    }

    /// Returns a suite's contenders, or those of them that the user has chosen, and always the baselines beside which
    /// every figure is shown.
    ///
    /// # Errors
    /// One sentence if none of the chosen contenders takes part.
    pub(super) fn contenders(
        &self,
        suite: &str,
        own: Vec<Contender>,
        baselines: &[Contender],
    ) -> anyhow::Result<Vec<Contender>> {
        let mut contenders = own;
        if !self.contenders.is_empty() {
            contenders.retain(|contender| self.contenders.contains(contender));
            ensure!(
                !contenders.is_empty(),
                "none of the contenders given takes part in the suite {suite}: choose others, or another suite"
            );
        }
        if baselines.contains(&Contender::MONO) && !contenders.contains(&Contender::MONO) {
            contenders.insert(0, Contender::MONO);
        }
        if baselines.contains(&Contender::CONVENTIONAL) {
            contenders.retain(|contender| *contender != Contender::CONVENTIONAL);
            contenders.insert(0, Contender::CONVENTIONAL);
        }
        Ok(contenders)
    }

    /// Returns a job of one round for each scene and point of a sweep; `vary` adapts it to the point.
    pub(super) fn sweep<P: Clone>(
        &self,
        experiment: &'static dyn Experiment,
        scenes: Vec<String>,
        points: impl IntoIterator<Item = P>,
        vary: impl Fn(&mut Job, P),
    ) -> Vec<Job> {
        let points: Vec<P> = points.into_iter().collect();
        let mut jobs = Vec::new();
        for scene in scenes {
            for (i, point) in points.iter().enumerate() {
                let suite = experiment.name().to_owned();
                let mut job = Job {
                    experiment,
                    conditions: Conditions { suite, scene: scene_name(&scene), label: None, point: None },
                    source: Source::Named(scene.clone()),
                    style: None,
                    render: self.render.clone(),
                    eyes: self.eyes,
                    point: i,
                    contenders: Vec::new(),
                    rounds: 1,
                    frames: self.viewpoints,
                };
                vary(&mut job, point.clone());
                jobs.push(job);
            }
        }
        jobs
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

/// Returns the name of a built-in scene, or the stem of a file's name.
fn scene_name(scene: &str) -> String {
    if BUILTINS.iter().any(|b| b.name == scene) {
        return scene.to_owned();
    }
    let stem = std::path::Path::new(scene).file_stem();
    stem.map_or_else(|| scene.to_owned(), |stem| stem.to_string_lossy().into_owned())
}
