//! `yoro run`: compares methods on the built-in scenes, with pictures, figures and a report page.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use anyhow::Context as _;

use crate::cli::Subcommand;
use crate::cli::args::{self, GlArgs};
use crate::cli::bench::header;
use crate::cli::eyes::{self, EyeArgs};
use crate::cli::settings::{self, Compared, Renderer, SettingOptions};
use crate::cli::terminal::progress_bar;
use yoro::eyes::Eye;
use yoro_bench::bench::{
    self, BenchReport, Choices, Contender, EXPERIMENTS, Inputs, Job, LazyObject, Object, Results, Runner,
    Writer, picture_folder,
};
use yoro_bench::inpaint::PatcherOptions;
use yoro_bench::machine::Parameter;
use yoro_files as files;
use yoro_gl::Context;
use yoro_render::stereo::{Method, Pipeline};
use yoro_scenes::{BUILTINS, replacements};

/// Compare rendering both eyes with synthesizing one, on built-in scenes or on files: pictures, figures, a report
#[derive(clap::Args, Clone, Debug)]
pub struct RunArgs {
    /// Built-in scenes, OBJ, glTF or GLB files [default: the eight that replace the paper's]
    scenes: Vec<String>,
    /// Viewpoints of each scene that are measured, spread over its camera path
    #[arg(long, default_value_t = 1, value_parser = args::whole::<u32>(1..=64), value_name = "N")]
    viewpoints: u32,
    /// Timed rounds; in each, every method renders one frame at each viewpoint
    #[arg(long, default_value_t = 1, value_parser = args::whole::<u32>(1..=1000), value_name = "N")]
    rounds: u32,
    /// Methods to compare with rendering both eyes; `yoro` stands for all of --pipelines
    #[arg(long = "method", value_parser = settings::value_of::<Method>("method"), value_delimiter = ',', default_value = Method::Synthesized.name(), value_name = "METHODS")]
    methods: Vec<Method>,
    /// Pipelines to compare; `paper` is that of the paper
    #[arg(long, value_parser = settings::value_of::<Pipeline>("pipeline"), value_delimiter = ',', default_value = Pipeline::Gather.name())]
    pipelines: Vec<Pipeline>,
    /// Seed of the built-in scenes
    #[arg(long, default_value_t = yoro_scenes::DEFAULT_SEED, value_parser = args::whole::<u64>(0..=u64::MAX), value_name = "N")]
    seed: u64,
    /// Folder for the report and the pictures
    #[arg(long, default_value = "out", value_name = "FOLDER")]
    out: PathBuf,
    #[command(flatten)]
    eyes: EyeArgs,
    #[command(flatten)]
    stereo: SettingOptions<Compared>,
    #[command(flatten)]
    renderer: SettingOptions<Renderer>,
    #[command(flatten)]
    gl: GlArgs,
}

impl Subcommand for RunArgs {
    /// Measures, writes the pictures and the report, and prints a short table.
    fn run(&self) -> anyhow::Result<()> {
        self.eyes.check()?;
        let choices = self.choices();
        yoro_scenes::check(&choices.scenes, self.seed)?;
        let headless = self.gl.open()?;
        let gl = headless.gl();
        for method in &self.methods {
            choices.render.supports(*method, gl.capabilities())?;
        }
        // A run that fails leaves the results of an earlier one.
        files::create_folder(&self.out)?;
        let work = tempfile::tempdir_in(&self.out)
            .with_context(|| format!("nothing can be written into {}", self.out.display()))?;
        let file = work.path().join("run.jsonl");
        let results = self.measure(&choices, gl, &file)?;
        print!("{}", bench::text(&results));
        let page = BenchReport::new(vec![results])?.write(&self.out)?.page;
        let kept = self.out.join("run.jsonl");
        std::fs::rename(&file, &kept).with_context(|| format!("cannot write {}", kept.display()))?;
        println!("\npictures: {}", self.out.join("*.png").display());
        println!("report:   {}", page.display());
        Ok(())
    }
}

impl RunArgs {
    /// Measures the suite of all scenes, the smallest of which comes first, so that there is something to look at soon.
    fn measure(&self, choices: &Choices, gl: &Rc<Context>, file: &Path) -> anyhow::Result<Results> {
        let object = LazyObject::new(Box::new(Object::hare));
        let suites = EXPERIMENTS.into_iter().filter(|suite| suite.name() == SUITE);
        let jobs: anyhow::Result<Vec<_>> = suites.map(|suite| suite.jobs(choices, &object)).collect();
        let mut jobs = jobs?.concat();
        jobs.sort_by_key(|job| kilo_triangles(&job.conditions.scene));
        let parameters = self.parameters(choices);
        let opened = Writer::open(file, &header(vec![SUITE.into()], false, parameters, gl))?;
        let inputs =
            Inputs { choices, object: &object, path: None, patchers: PatcherOptions { model: None } };
        let bar = progress_bar(jobs.iter().map(|job| job.experiment.steps(job)).sum());
        let mut runner = Runner::new(gl, inputs, opened, bar.clone());
        for (i, job) in jobs.iter().enumerate() {
            runner.run(job)?;
            let picture = self.save_pairs(&picture_folder(file, &job.conditions), job)?;
            if i == 0 {
                bar.suspend(|| println!("the first picture: {}", picture.display()));
            }
        }
        bar.finish_and_clear();
        Results::read(file)
    }

    fn choices(&self) -> Choices {
        let builtin = || replacements().map(|builtin| builtin.name.to_owned()).collect();
        let contenders = self.methods.iter().flat_map(|&method| match method {
            Method::Synthesized => self.pipelines.iter().copied().map(Contender::Synthesized).collect(),
            other => vec![Contender::Method(other)],
        });
        let stereo = self.stereo.clone();
        Choices {
            quick: false,
            times_passes: false,
            eyes: self.eyes.options(),
            render: self.renderer.render_settings(),
            options: Rc::new(move |pipeline| stereo.options(pipeline)),
            rounds: self.rounds,
            viewpoints: self.viewpoints as usize,
            scenes: if self.scenes.is_empty() { builtin() } else { self.scenes.clone() },
            contenders: contenders.collect(),
            seed: self.seed,
            object: None,
            max_triangles: 0,
        }
    }

    fn parameters(&self, choices: &Choices) -> Vec<Parameter> {
        let mut parameters = choices.parameters();
        for &pipeline in &self.pipelines {
            let o = self.stereo.options(pipeline);
            let paper = (pipeline == Pipeline::Paper).then(|| format!(", {:?}", o.synthesis.paper));
            let value = format!("{}{}", self.eyes.distances(o.guard_band), paper.unwrap_or_default());
            parameters.push(Parameter { name: pipeline.name().into(), value });
        }
        parameters
    }

    /// Writes both eyes of a scene's first viewpoint side by side, as each method makes them. Returns the last path.
    fn save_pairs(&self, pictures: &Path, job: &Job) -> anyhow::Result<PathBuf> {
        let read = |name: &str| yoro_media::load_color(&pictures.join(format!("{name}.png")));
        let dominant = read("dominant")?;
        let mut written = PathBuf::new();
        for contender in job.contenders.iter().filter(|contender| **contender != Contender::MONO) {
            let name = if *contender == Contender::CONVENTIONAL { "truth".into() } else { contender.name() };
            let other = read(&name)?;
            let pair = match self.eyes.dominant {
                Eye::Left => yoro_media::side_by_side(&dominant, &other),
                Eye::Right => yoro_media::side_by_side(&other, &dominant),
            };
            written = eyes::picture_path(&self.out, &job.conditions.scene, &contender.name());
            yoro_media::save_color(&written, &pair?)?;
        }
        Ok(written)
    }
}

/// The suite of `yoro bench` that this command measures.
const SUITE: &str = "scenes";

/// Returns the size of a built-in scene in thousands of triangles; that of a file is not known yet.
fn kilo_triangles(scene: &str) -> u32 {
    BUILTINS.iter().find(|builtin| builtin.name == scene).map_or(0, |builtin| builtin.kilo_triangles)
}
