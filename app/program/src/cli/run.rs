//! `yoro run`: compares methods on the built-in scenes, with pictures, figures and a report page.

use std::path::PathBuf;

use image::RgbImage;

use crate::cli::Subcommand;
use crate::cli::args::{self, GlArgs, list};
use crate::cli::eyes::{self, EyeArgs};
use crate::cli::machine;
use crate::cli::settings::{self, Compared, Renderer, SettingOptions};
use crate::cli::terminal::progress_bar;
use yoro::eyes::Eye;
use yoro_bench::machine::Parameter;
use yoro_bench::report::{RunReport, SceneReport};
use yoro_bench::run::{Candidate, Plan};
use yoro_files as files;
use yoro_gl::Context;
use yoro_render::RenderSettings;
use yoro_render::stereo::{Method, Pipeline};
use yoro_scenes::{self, BUILTINS};

/// Compare rendering both eyes with synthesizing one, on built-in scenes or on files: pictures, figures, a report
#[derive(clap::Args, Clone, Debug)]
pub struct RunArgs {
    /// Built-in scenes, OBJ, glTF or GLB files [default: all built-in scenes]
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
    /// Pipelines to compare
    #[arg(long, value_parser = settings::value_of::<Pipeline>("pipeline"), value_delimiter = ',', default_value = list(Pipeline::ALL.map(Pipeline::name)))]
    pipelines: Vec<Pipeline>,
    /// Seed of the built-in scenes
    #[arg(long, default_value_t = yoro_scenes::DEFAULT_SEED, value_parser = args::whole::<u64>(0..=u64::MAX), value_name = "N")]
    seed: u64,
    /// Folder for the report and the pictures
    #[arg(long, default_value = "out", value_name = "FOLDER")]
    out: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    eyes: EyeArgs,
    #[command(flatten)]
    stereo: SettingOptions<Compared>,
    #[command(flatten)]
    renderer: SettingOptions<Renderer>,
    #[command(flatten)]
    gl: GlArgs,
}

impl RunArgs {
    /// Returns the names of the scenes.
    fn names(&self) -> Vec<String> {
        match self.scenes.as_slice() {
            [] => BUILTINS.iter().map(|b| b.name.to_owned()).collect(),
            given => given.to_vec(),
        }
    }
}

impl Subcommand for RunArgs {
    /// Measures, writes the report and prints its table.
    fn run(&self) -> anyhow::Result<()> {
        self.eyes.check()?;
        let settings = self.renderer.render_settings();
        let names = self.names();
        yoro_scenes::check(&names, self.seed)?;
        files::create_folder(&self.out)?;
        let headless = self.gl.open()?;
        let gl = headless.gl();
        for method in &self.methods {
            settings.supports(*method, gl.capabilities())?;
        }
        let plan = plan(self, &settings);
        let bar = progress_bar(names.len() as u64 * plan.steps());
        // The smallest scene comes first, so that there is something to look at soon.
        let mut order: Vec<usize> = (0..names.len()).collect();
        order.sort_by_key(|&at| kilo_triangles(&names[at]));
        let mut scenes = Vec::new();
        for at in order {
            let scene = plan.measure(gl, &names[at], &bar)?;
            let picture = write_pictures(self, &scene)?;
            if scenes.is_empty() && !self.json {
                bar.suspend(|| println!("the first picture: {}", picture.display()));
            }
            scenes.push((at, scene));
        }
        scenes.sort_by_key(|(at, _)| *at);
        let scenes = scenes.into_iter().map(|(_, scene)| scene).collect();
        bar.finish_and_clear();
        let report = RunReport {
            title: "yoro: one render, two eyes".into(),
            machine: machine::describe(gl.capabilities()),
            parameters: parameters(self, &settings),
            timing_method: timing_method(self, gl),
            scenes,
        };
        let page = report.write(&self.out)?.page;
        if self.json {
            print!("{}", report.to_json()?);
        } else {
            print!("{}", report.to_text());
            println!("\npictures: {}", self.out.join("*.png").display());
            println!("report:   {}", page.display());
        }
        Ok(())
    }
}

/// Returns the plan with each chosen method once.
fn plan(args: &RunArgs, settings: &RenderSettings) -> Plan {
    let mut candidates = Vec::new();
    for (i, &method) in args.methods.iter().enumerate() {
        match method {
            _ if args.methods[..i].contains(&method) => {}
            // The reference is always measured.
            Method::Conventional => {}
            Method::Synthesized => candidates.extend(args.pipelines.iter().map(|&pipeline| Candidate {
                name: pipeline.name(),
                method,
                options: args.stereo.options(pipeline),
            })),
            _ => {
                let options = args.stereo.options(Pipeline::default());
                candidates.push(Candidate { name: method.name(), method, options });
            }
        }
    }
    Plan {
        eyes: args.eyes.options(),
        render: settings.clone(),
        conventional: args.stereo.options(Pipeline::default()),
        candidates,
        viewpoints: args.viewpoints as usize,
        rounds: args.rounds,
        seed: args.seed,
    }
}

/// Returns the size of a built-in scene in thousands of triangles; that of a file is not known yet.
fn kilo_triangles(scene: &str) -> u32 {
    BUILTINS.iter().find(|builtin| builtin.name == scene).map_or(0, |builtin| builtin.kilo_triangles)
}

/// Writes the pictures of a scene's first viewpoint, and returns the path of the last method's.
fn write_pictures(args: &RunArgs, scene: &SceneReport) -> anyhow::Result<PathBuf> {
    let path = |kind: &str| eyes::picture_path(&args.out, &scene.name, kind);
    let mut shown = path(Method::Conventional.name());
    let Some(viewpoint) = scene.viewpoints.first() else { return Ok(shown) };
    let pair = |other: &RgbImage| match args.eyes.dominant {
        Eye::Left => yoro_media::side_by_side(&viewpoint.dominant, other),
        Eye::Right => yoro_media::side_by_side(other, &viewpoint.dominant),
    };
    yoro_media::save_color(&shown, &pair(&viewpoint.ground_truth)?)?;
    for view in &viewpoint.views {
        shown = path(&view.method);
        yoro_media::save_color(&shown, &pair(&view.eye)?)?;
        yoro_media::save_color(&path(&format!("{}.error-map", view.method)), &view.error)?;
    }
    Ok(shown)
}

fn parameters(args: &RunArgs, settings: &RenderSettings) -> Vec<Parameter> {
    let eyes = &args.eyes;
    let mut parameters = vec![
        ("size of each eye, pixels", format!("{} x {}", eyes.size[0], eyes.size[1])),
        ("vertical field of view, degrees", format!("{:.0}", eyes.fov_y.to_degrees())),
        ("IPD, metres", format!("{}", eyes.ipd)),
        ("near and far plane, metres", format!("{} and {}", eyes.near, eyes.far)),
        ("depth", if eyes.reversed_z { "reversed" } else { "standard" }.into()),
        ("dominant eye", eyes.dominant.name().into()),
        ("samples per pixel", settings.msaa.to_string()),
        ("viewpoints per scene", args.viewpoints.to_string()),
        ("seed", args.seed.to_string()),
    ];
    for &pipeline in &args.pipelines {
        let o = args.stereo.options(pipeline);
        let mut text = format!("guard band {:?}", o.guard_band);
        if pipeline == Pipeline::Paper {
            text += &format!(", {:?}", o.synthesis.paper);
        }
        parameters.push((pipeline.name(), text));
        parameters.push(("near objects", eyes.distances(o.guard_band)));
    }
    parameters.into_iter().map(|(name, value)| Parameter { name: name.into(), value }).collect()
}

fn timing_method(args: &RunArgs, gl: &Context) -> String {
    let passes = if gl.capabilities().timer_queries {
        "Pass times are GPU times by timer queries"
    } else {
        "Pass times are wall-clock times with glFinish before and after each pass (timer queries of a CPU rasterizer are wrong)"
    };
    let count = |n: u32, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    format!(
        "Frame times: wall clock of a whole stereo frame up to glFinish, both eyes finished; one warm-up frame per method, then {} over {}, the order of the methods rotated; medians. {passes}, medians over frames of their own at the first viewpoint.",
        count(args.rounds, "interleaved round"),
        count(args.viewpoints, "viewpoint")
    )
}
