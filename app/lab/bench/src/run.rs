//! The measurement of `yoro run`: methods compared with rendering both eyes, in one scene.

use std::rc::Rc;

use anyhow::Context as _;
use image::RgbImage;
use indicatif::ProgressBar;

use crate::bench::{BlankFinder, Subject, spread};
use crate::report::{Cost, MethodCost, PassTime, SceneReport, Viewpoint};
use yoro::eyes::{Eye, EyeOptions, EyePair};
use yoro_files::interrupt;
use yoro_gl::Context;
use yoro_media::rgb_image;
use yoro_render::stereo::{Method, StereoFrame, StereoOptions};
use yoro_render::{PreparedScene, RenderSettings};
use yoro_report::stats::{Summary, median};
use yoro_scenes::BUILTINS;

/// The measurements to be made in each scene.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The eyes.
    pub eyes: EyeOptions,
    /// The renderer's settings.
    pub render: RenderSettings,
    /// The options of the conventional method, which the others are compared with.
    pub conventional: StereoOptions,
    /// The other methods.
    pub candidates: Vec<Candidate>,
    /// The number of viewpoints, spread over the camera path.
    pub viewpoints: usize,
    /// The number of timed rounds. In each, every method renders one frame at each viewpoint.
    pub rounds: u32,
    /// Seed of the built-in scenes.
    pub seed: u64,
}

/// A method that is compared with the conventional one.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// The name in the report, different for each candidate.
    pub name: &'static str,
    /// The stereo method.
    pub method: Method,
    /// Its options.
    pub options: StereoOptions,
}

impl Plan {
    /// Returns the number of steps of progress per scene: preparation, a warm-up, the viewpoints of each round, the
    /// passes.
    pub fn steps(&self) -> u64 {
        3 + self.viewpoints as u64 * u64::from(self.rounds)
    }

    /// Measures a scene, which is a built-in one by name or a file.
    ///
    /// # Errors
    /// [`interrupt::Interrupted`], and one sentence if the scene cannot be loaded or GL refuses.
    pub fn measure(&self, gl: &Rc<Context>, scene: &str, bar: &ProgressBar) -> anyhow::Result<SceneReport> {
        let mut field = Field::new(self, gl, scene, bar)?;
        field.warm_up()?;
        let mut viewpoints = Vec::new();
        for round in 0..self.rounds {
            viewpoints.extend(field.round(round)?);
        }
        field.time_passes()?;
        field.report(viewpoints)
    }
}

/// A method under measurement.
struct Timed {
    name: &'static str,
    contender: Subject,
    milliseconds: Vec<f64>,
    /// The samples of each pass, in the order of the first frame.
    passes: Vec<(&'static str, Vec<f64>)>,
}

impl Timed {
    /// Adds the pass times of one frame.
    fn add_passes(&mut self, times: Vec<(&'static str, f64)>) {
        for (name, milliseconds) in times {
            match self.passes.iter_mut().find(|(n, _)| *n == name) {
                Some((_, samples)) => samples.push(milliseconds),
                None => self.passes.push((name, vec![milliseconds])),
            }
        }
    }

    fn cost(self) -> anyhow::Result<MethodCost> {
        let frame_ms = Summary::of(&self.milliseconds).context("at least one frame was timed")?;
        let pass = |(name, samples): (&str, Vec<f64>)| PassTime {
            name: name.into(),
            ms: median(&samples).unwrap_or(0.0),
        };
        let passes = self.passes.into_iter().map(pass).collect();
        Ok(MethodCost { method: self.name.into(), cost: Cost { frame_ms, passes } })
    }
}

/// A scene with all methods that render it, the conventional method first.
struct Field<'a> {
    plan: &'a Plan,
    scene: &'a str,
    bar: &'a ProgressBar,
    prepared: PreparedScene,
    /// Indices of the viewpoints.
    keys: Vec<usize>,
    pairs: Vec<EyePair>,
    contenders: Vec<Timed>,
    frame: StereoFrame,
}

impl<'a> Field<'a> {
    fn new(
        plan: &'a Plan,
        gl: &Rc<Context>,
        scene: &'a str,
        bar: &'a ProgressBar,
    ) -> anyhow::Result<Field<'a>> {
        bar.set_message(format!("{scene}: preparing"));
        interrupt::check()?;
        let settings = &plan.render;
        let loaded = yoro_scenes::load(scene, plan.seed, None)?;
        loaded.warn_of_made_up_viewpoints();
        let keys = spread(loaded.viewpoints.len(), plan.viewpoints);
        let pairs: Vec<EyePair> = keys.iter().map(|&k| plan.eyes.pair(loaded.viewpoints[k].pose())).collect();
        let mut prepared = PreparedScene::new(gl, loaded, settings)?;
        let names = keys.iter().map(|key| format!("viewpoint {key}"));
        BlankFinder::new(gl)?.refuse_blank(&mut prepared, names.zip(&pairs))?;
        let conventional = Candidate {
            name: Method::Conventional.name(),
            method: Method::Conventional,
            options: plan.conventional,
        };
        let mut contenders = Vec::new();
        for candidate in [conventional].iter().chain(&plan.candidates) {
            let contender = Subject::new(gl, candidate.method, settings, &candidate.options)?;
            contenders.push(Timed {
                name: candidate.name,
                contender,
                milliseconds: Vec::new(),
                passes: Vec::new(),
            });
        }
        let frame = StereoFrame::new(gl, plan.eyes.size)?;
        bar.inc(1);
        Ok(Field { plan, scene, bar, prepared, keys, pairs, contenders, frame })
    }

    fn warm_up(&mut self) -> anyhow::Result<()> {
        self.bar.set_message(format!("{}: warming up", self.scene));
        for timed in &mut self.contenders {
            interrupt::check()?;
            timed.contender.render(&mut self.prepared, &self.pairs[0], &mut self.frame)?;
        }
        self.bar.inc(1);
        Ok(())
    }

    /// Times one frame of every method at every viewpoint, rotating the order so that each is first, second, ...
    /// equally often. The first round also measures the images.
    fn round(&mut self, round: u32) -> anyhow::Result<Vec<Viewpoint>> {
        self.bar.set_message(format!("{}: round {} of {}", self.scene, round + 1, self.plan.rounds));
        let count = self.contenders.len();
        let mut viewpoints = Vec::new();
        for (i, pair) in self.pairs.iter().enumerate() {
            let mut images = vec![<[RgbImage; 2]>::default(); count];
            for turn in 0..count {
                interrupt::check()?;
                let at = (turn + i + round as usize) % count;
                let timed = &mut self.contenders[at];
                let time = timed.contender.render_settled(&mut self.prepared, pair, &mut self.frame)?;
                timed.milliseconds.push(time.wall.as_secs_f64() * 1e3);
                if round == 0 {
                    images[at] = Eye::BOTH.map(|eye| rgb_image(&self.frame.rgba(eye), self.frame.size()));
                }
            }
            if round == 0 {
                viewpoints.push(self.viewpoint(self.keys[i], images)?);
            }
            self.bar.inc(1);
        }
        Ok(viewpoints)
    }

    /// Measures the images of one viewpoint, which are in the order of the methods.
    fn viewpoint(&self, key: usize, images: Vec<[RgbImage; 2]>) -> anyhow::Result<Viewpoint> {
        let dominant = self.plan.eyes.dominant;
        let in_order = |[left, right]: [RgbImage; 2]| match dominant {
            Eye::Left => [left, right],
            Eye::Right => [right, left],
        };
        let mut images = images.into_iter().map(in_order);
        let [rendered, truth] = images.next().context("the conventional method comes first")?;
        let names = self.contenders.iter().skip(1).map(|timed| timed.name.to_owned());
        let others = names.zip(images.map(|[_, other]| other)).collect();
        Ok(Viewpoint::measure(format!("viewpoint {key}"), dominant, rendered, truth, others)?)
    }

    fn time_passes(&mut self) -> anyhow::Result<()> {
        self.bar.set_message(format!("{}: timing passes", self.scene));
        for _ in 0..self.plan.rounds {
            for timed in &mut self.contenders {
                interrupt::check()?;
                let costs =
                    timed.contender.pass_costs(&mut self.prepared, &self.pairs[0], &mut self.frame)?;
                timed.add_passes(costs.times);
            }
        }
        self.bar.inc(1);
        Ok(())
    }

    fn report(self, viewpoints: Vec<Viewpoint>) -> anyhow::Result<SceneReport> {
        let costs: Vec<MethodCost> =
            self.contenders.into_iter().map(Timed::cost).collect::<Result<_, _>>()?;
        let mut costs = costs.into_iter();
        let conventional = costs.next().context("the conventional method comes first")?.cost;
        let scene = &self.prepared.scene;
        Ok(SceneReport {
            name: scene.name.clone(),
            stands_for: BUILTINS.iter().find(|b| b.name == self.scene).map_or("", |b| b.stands_for).into(),
            triangles: scene.triangle_count() as u64,
            conventional,
            methods: costs.collect(),
            viewpoints,
        })
    }
}
