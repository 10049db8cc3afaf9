//! `yoro bench`: the experiments of the paper.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::{Duration, Instant};

use anyhow::{Context as _, bail, ensure};
use clap::builder::{PossibleValue, PossibleValuesParser};

use crate::cli::Subcommand;
use crate::cli::args::{self, GlArgs, Shard, parse_fov};
use crate::cli::eyes;
use crate::cli::machine;
use crate::cli::settings::{Renderer, SettingOptions};
use crate::cli::terminal::progress_bar;
use yoro::eyes::{Eye, EyeOptions};
use yoro_assets::load::sidecar_file;
use yoro_bench::bench::record::{Header, PassClock, VERSION};
use yoro_bench::bench::{
    self, Choices, Contender, EXPERIMENTS, Experiment, Inputs, Job, LazyObject, Object, Runner, Source,
    Writer, check_path,
};
use yoro_bench::inpaint::PatcherOptions;
use yoro_bench::machine::Parameter;
use yoro_files::interrupt::Interrupted;
use yoro_gl::Context;
use yoro_render::stereo::StereoOptions;
use yoro_scenes::BUILTINS;
use yoro_settings::Ipd;

/// Measure every method side by side: the experiments of the paper, on built-in scenes or your own
#[derive(clap::Args, Clone, Debug)]
pub struct BenchArgs {
    /// The experiments to run
    #[arg(value_parser = suite_names(), required = true, value_name = "SUITE")]
    suites: Vec<String>,
    /// The short form: smaller images, fewer scenes, points, viewpoints and rounds
    #[arg(long)]
    quick: bool,
    /// Timed rounds; in each, every contender renders every frame once [default: 5; quick: 2]
    #[arg(long, value_name = "N", value_parser = args::whole::<u32>(1..=1000))]
    rounds: Option<u32>,
    /// Viewpoints of each scene, spread over its camera path [default: 3; quick, gpu: 1]
    #[arg(long, value_name = "N", value_parser = args::whole::<u32>(1..=64))]
    viewpoints: Option<u32>,
    /// Size of each eye's image in pixels [default: 1024x1024; quick: 512x512]
    #[arg(long, value_name = "WxH", value_parser = eyes::parse_size)]
    size: Option<[u32; 2]>,
    /// Begin no further setting after so many minutes; the same command goes on [default: gpu: 8]
    #[arg(long, value_name = "N", value_parser = args::whole::<u64>(1..=100_000))]
    minutes: Option<u64>,
    /// Scenes instead of the suite's: a built-in one, or an OBJ, glTF or GLB file; more than once for several
    #[arg(long = "scene", value_name = "NAME|FILE")]
    scenes: Vec<String>,
    /// Another camera path than the scenes' own: a JSON array of {position, target}
    #[arg(long, value_name = "FILE")]
    path: Option<PathBuf>,
    /// Only this contender, such as yoro-gather; more than once for several. The baselines, conventional for cost
    /// and mono for quality, are always measured
    #[arg(long = "contender", value_name = "NAME", value_parser = parse_contender)]
    contenders: Vec<Contender>,
    /// Only this part of the settings, for array jobs: 1/8 up to 8/8. `yoro report` takes the files of all parts
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// File of results. One that an interrupted run has left is continued
    /// [default: out/bench-SUITES.jsonl; --shard: out/bench-SUITES-IofN.jsonl]
    #[arg(long, value_name = "FILE.jsonl")]
    out: Option<PathBuf>,
    /// Distance between the eyes in metres
    #[arg(long, default_value_t = Ipd::DEFAULT, allow_negative_numbers = true)]
    ipd: Ipd,
    /// Vertical field of view in degrees
    #[arg(long = "fov-y-degrees", default_value = "60", value_parser = parse_fov, allow_negative_numbers = true)]
    fov_y: f32,
    /// The eye that is rendered
    #[arg(long, value_parser = eyes::parse_eye, default_value = "right")]
    dominant: Eye,
    /// Seed of the built-in scenes
    #[arg(long, default_value_t = yoro_scenes::DEFAULT_SEED, value_parser = args::whole::<u64>(0..=u64::MAX), value_name = "N")]
    seed: u64,
    /// distance, complexity: the object, an OBJ, glTF or GLB file such as the Stanford bunny, instead of the
    /// built-in hare
    #[arg(long, value_name = "FILE")]
    object: Option<PathBuf>,
    /// complexity: triangles of the largest scene [default: 13104000, the paper's; quick: 1500000]
    #[arg(long, value_name = "N", value_parser = args::whole::<u64>(1..=200_000_000))]
    max_triangles: Option<u64>,
    /// patchers: another ONNX file than the built-in model of the neural one
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    #[command(flatten)]
    renderer: SettingOptions<Renderer>,
    #[command(flatten)]
    gl: GlArgs,
}

impl Subcommand for BenchArgs {
    /// Measures, appends to the file of results, and prints a short table.
    fn run(&self) -> anyhow::Result<()> {
        let choices = self.choices();
        yoro_scenes::check(&choices.scenes, choices.seed)?;
        let path = self.path.as_deref().map(yoro_assets::path::read).transpose()?;
        if path.is_none() {
            choices.scenes.iter().for_each(|scene| warn_without_camera(Path::new(scene)));
        }
        let object = self.object.as_deref().map(Object::load).transpose()?;
        let object = LazyObject::new(Box::new(|| object.unwrap_or_else(Object::hare)));
        let jobs = jobs(self, &choices, &object)?;
        if path.is_none() {
            check_paths(&jobs, choices.seed)?;
        }
        let out = self.out();
        let headless = self.gl.open()?;
        let gl = headless.gl();
        let header = header(self.suites.clone(), self.quick, self.parameters(&choices), gl);
        let (writer, before) = Writer::open(&out, &header)?;
        let finished = jobs.iter().filter(|job| before.rounds(&job.conditions) >= job.rounds).count();
        if finished > 0 {
            log::warn!("{}: {finished} of {} settings are measured already", out.display(), jobs.len());
        }
        let inputs = Inputs {
            choices: &choices,
            object: &object,
            path: path.as_deref(),
            patchers: PatcherOptions { model: self.model.clone() },
        };
        let (begin, limit) = (Instant::now(), self.minutes.or(self.is_gpu().then_some(GPU_MINUTES)));
        let limit = limit.map(|minutes| Duration::from_secs(60 * minutes));
        let bar = progress_bar(jobs.iter().map(|job| job.experiment.steps(job)).sum());
        let mut runner = Runner::new(gl, inputs, (writer, before), bar.clone());
        for (done, job) in jobs.iter().enumerate() {
            if limit.is_some_and(|limit| begin.elapsed() >= limit) {
                log::warn!(
                    "{} of {} settings are left: the same command goes on",
                    jobs.len() - done,
                    jobs.len()
                );
                break;
            }
            if let Err(error) = runner.run(job) {
                bar.finish_and_clear();
                if error.is::<Interrupted>() {
                    bail!(
                        "interrupted: the finished rounds are in {}; the same command with --out {} goes on",
                        out.display(),
                        out.display()
                    );
                }
                return Err(error.context(format!("cannot measure {}", job.conditions)));
            }
        }
        bar.finish_and_clear();
        print!("{}", bench::text(&bench::Results::read(&out)?));
        println!("results: {}", out.display());
        Ok(())
    }
}

impl BenchArgs {
    fn choices(&self) -> Choices {
        fn of<T>(is_quick: bool, full: T, quick: T) -> T {
            if is_quick { quick } else { full }
        }
        let eyes = EyeOptions {
            size: self.size.unwrap_or(of(self.quick, [1024; 2], [512; 2])),
            fov_y: self.fov_y,
            ipd: self.ipd.metres(),
            dominant: self.dominant,
            ..EyeOptions::default()
        };
        Choices {
            quick: self.quick,
            times_passes: true,
            eyes,
            render: self.renderer.render_settings(),
            options: Rc::new(|pipeline| StereoOptions {
                policy: None,
                ..StereoOptions::of_pipeline(pipeline)
            }),
            rounds: self.rounds.unwrap_or(of(self.quick, 5, 2)),
            viewpoints: self.viewpoints.unwrap_or(of(self.quick || self.is_gpu(), 3, 1)) as usize,
            scenes: self.scenes.clone(),
            contenders: self.contenders.clone(),
            seed: self.seed,
            object: self.object.clone(),
            max_triangles: self.max_triangles.map_or(of(self.quick, 13_104_000, 1_500_000), |n| n as usize),
        }
    }

    fn is_gpu(&self) -> bool {
        self.suites.iter().any(|name| name == GPU)
    }

    /// Returns the chosen experiments.
    fn experiments(&self) -> impl Iterator<Item = &'static dyn Experiment> {
        self.suites.iter().flat_map(|name| {
            EXPERIMENTS.into_iter().filter(move |experiment| match &**name {
                ALL => true,
                GPU => GPU_SUITES.contains(&experiment.name()),
                name => name == experiment.name(),
            })
        })
    }

    fn parameters(&self, choices: &Choices) -> Vec<Parameter> {
        let mut parameters = choices.parameters();
        for (name, path) in [("camera path", &self.path), ("model", &self.model)] {
            let value = path.as_ref().map_or_else(|| "none".to_owned(), |path| path.display().to_string());
            parameters.push(Parameter { name: name.into(), value });
        }
        parameters
    }

    fn out(&self) -> PathBuf {
        let quick = if self.quick { "-quick" } else { "" };
        let shard = self.shard.map(|shard| format!("-{shard}").replace('/', "of")).unwrap_or_default();
        let suites = self.suites.join("-");
        let default = || Path::new("out").join(format!("bench-{suites}{quick}{shard}.jsonl"));
        self.out.clone().unwrap_or_else(default)
    }
}

/// Warns about an OBJ file without a camera path: its viewpoints are generated and mean little.
fn warn_without_camera(scene: &Path) {
    let is_obj = scene.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj"));
    if is_obj && sidecar_file(scene, "camera.json").is_none() {
        log::warn!(
            "{} has no camera.json beside it, so its viewpoints are made up: write one, or give --path FILE",
            scene.display()
        );
    }
}

/// Refuses files without a camera path where the head moves along it, before any other scene is measured.
fn check_paths(jobs: &[Job], seed: u64) -> anyhow::Result<()> {
    let mut checked = HashSet::new();
    for job in jobs.iter().filter(|job| job.experiment.moves(job)) {
        if let Source::Named(name) = &job.source
            && BUILTINS.iter().all(|builtin| builtin.name != name)
            && checked.insert(name)
        {
            let scene = yoro_scenes::load(name, seed, None)?;
            check_path(&scene.name, &scene.viewpoints)
                .with_context(|| format!("cannot measure {}", job.conditions))?;
        }
    }
    Ok(())
}

/// Returns the settings of all suites, each once.
fn jobs(args: &BenchArgs, choices: &Choices, object: &LazyObject) -> anyhow::Result<Vec<Job>> {
    let mut jobs: Vec<Job> = Vec::new();
    for experiment in args.experiments() {
        for job in experiment.jobs(choices, object)? {
            let twin = jobs.iter().find(|other| other.conditions == job.conditions);
            ensure!(
                twin.is_none(),
                "{} would be measured twice: give each suite once, and scenes of different names",
                job.conditions
            );
            jobs.push(job);
        }
    }
    if let Some(shard) = args.shard {
        let part = shard.part(jobs.len());
        ensure!(!part.is_empty(), "{shard} is empty: there are {} settings, so give fewer parts", jobs.len());
        jobs = jobs.drain(part).collect();
    }
    Ok(jobs)
}

/// Returns the head of a file of results.
pub(super) fn header(suites: Vec<String>, quick: bool, parameters: Vec<Parameter>, gl: &Context) -> Header {
    let capabilities = gl.capabilities();
    let pass_clock = if capabilities.timer_queries { PassClock::TimerQueries } else { PassClock::Finish };
    let machine = machine::describe(capabilities);
    Header { yoro_bench: VERSION, suites, quick, machine, pass_clock, parameters }
}

/// The name of all suites together.
const ALL: &str = "all";
/// The name of those that tell what a GPU gains, the most telling first, and the minutes that they may take.
const GPU: &str = "gpu";
const GPU_SUITES: [&str; 5] = ["scenes", "complexity", "reprojection", "half-rate", "foveation"];
const GPU_MINUTES: u64 = 8;

/// Accepts the names of suites, with a line of help for each.
fn suite_names() -> PossibleValuesParser {
    let each = EXPERIMENTS.into_iter().map(|each| PossibleValue::new(each.name()).help(each.about()));
    let gpu =
        PossibleValue::new(GPU).help("What a GPU gains, in eight minutes: most of them, from one viewpoint");
    let all = PossibleValue::new(ALL).help("All of them, one after the other");
    PossibleValuesParser::new(each.chain([gpu, all]))
}

fn parse_contender(text: &str) -> Result<Contender, String> {
    let names = || Contender::all().iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    Contender::find(text).ok_or_else(|| format!("there is none of this name; choose of {}", names()))
}
