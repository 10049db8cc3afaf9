//! `yoro run`: the main job on the built-in scenes, with pictures, figures and a report page.

use std::path::PathBuf;
use std::rc::Rc;

use anyhow::Context as _;
use image::RgbImage;
use indicatif::ProgressBar;

use crate::bench::Entrant;
use crate::cli::stage::{self, EyeArgs, Stage, StereoArgs};
use crate::cli::{GlArgs, machine, progress_bar, stop_if_interrupted};
use crate::eyes::{Eye, EyePair};
use crate::files;
use crate::gl::Context;
use crate::metrics::stats::{Summary, median};
use crate::picture;
use crate::render::RenderSettings;
use crate::report::{Cost, MethodCost, Parameter, PassTime, RunReport, SceneReport, Viewpoint};
use crate::scene::builtin::{self, BUILTINS};
use crate::stereo::{Method, StereoFrame};
use crate::synthesis::Pipeline;

/// Pictures of the report and of the output folder come from this many viewpoints of each scene.
const PICTURED: usize = 1;

/// Compare rendering both eyes with synthesizing one, on built-in scenes or on files: pictures, figures, a report
#[derive(clap::Args, Clone, Debug)]
pub struct RunArgs {
    /// Built-in scenes, OBJ, glTF or GLB files [default: all built-in scenes]
    scenes: Vec<String>,
    /// Viewpoints of each scene that are measured, spread over its camera path
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=64), value_name = "N")]
    viewpoints: u32,
    /// Timed rounds; in each, every method renders one frame at each viewpoint
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000), value_name = "N")]
    rounds: u32,
    /// Methods to compare with rendering both eyes; `yoro` stands for all of --pipelines
    #[arg(long = "method", value_enum, value_delimiter = ',', default_values_t = [Method::Yoro], value_name = "METHODS")]
    methods: Vec<Method>,
    /// Pipelines to compare
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = Pipeline::ALL)]
    pipelines: Vec<Pipeline>,
    /// Seed of the built-in scenes
    #[arg(long, default_value_t = builtin::DEFAULT_SEED)]
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
    stereo: StereoArgs,
    #[command(flatten)]
    gl: GlArgs,
}

/// A method under measurement.
struct Measured {
    name: &'static str,
    entrant: Entrant,
    milliseconds: Vec<f64>,
    /// Samples of each pass, in the order of the first frame.
    passes: Vec<(&'static str, Vec<f64>)>,
}

/// Measures, writes the report and prints its table.
pub fn run(args: &RunArgs) -> anyhow::Result<()> {
    args.eyes.check()?;
    let names: Vec<String> = match args.scenes.as_slice() {
        [] => BUILTINS.iter().map(|b| b.name.to_owned()).collect(),
        given => given.to_vec(),
    };
    stage::check_scenes(&names, args.seed)?;
    files::create_folder(&args.out)?;
    let headless = args.gl.open()?;
    let gl = headless.gl();
    for method in &args.methods {
        method.supported(gl.capabilities())?;
    }
    // Per scene: preparing, a warm-up, the timed rounds, the passes.
    let steps = names.len() as u64 * (3 + u64::from(args.viewpoints) * u64::from(args.rounds));
    let bar = progress_bar(steps);
    let mut scenes = Vec::new();
    for name in &names {
        scenes.push(measure_scene(args, gl, name, &bar)?);
    }
    bar.finish_and_clear();
    let report = RunReport {
        title: "yoro: one render, two eyes".into(),
        machine: machine::describe(gl.capabilities()),
        parameters: parameters(args),
        timing_method: timing_method(args, gl),
        scenes,
    };
    write_pictures(args, &report)?;
    let page = report.write(&args.out)?;
    if args.json {
        print!("{}", report.to_json()?);
    } else {
        print!("{}", report.to_text());
        println!("\npictures: {}", args.out.join("*.png").display());
        println!("report:   {}", page.display());
    }
    Ok(())
}

fn measure_scene(
    args: &RunArgs,
    gl: &Rc<Context>,
    name: &str,
    bar: &ProgressBar,
) -> anyhow::Result<SceneReport> {
    bar.set_message(format!("{name}: preparing"));
    stop_if_interrupted()?;
    let settings = RenderSettings::default();
    let scene = stage::load_scene(name, args.seed, None)?;
    let keys: Vec<usize> = stage::spread(scene.viewpoints.len(), args.viewpoints as usize);
    let pairs: Vec<EyePair> = keys.iter().map(|&k| args.eyes.pair(scene.viewpoints[k].pose())).collect();
    let mut stage = Stage::new(gl, scene, &settings)?;
    let options = |pipeline| args.stereo.options_of(pipeline);
    let truth_options = options(Pipeline::default());
    let entrant = |name: &'static str, method, options: &_| -> anyhow::Result<Measured> {
        Ok(Measured::new(name, Entrant::new(gl, method, &settings, options)?))
    };
    let mut entrants = vec![entrant(Method::Conventional.name(), Method::Conventional, &truth_options)?];
    for (i, &method) in args.methods.iter().enumerate() {
        match method {
            _ if args.methods[..i].contains(&method) => {}
            // Always there, as the reference.
            Method::Conventional => {}
            Method::Yoro => {
                for &pipeline in &args.pipelines {
                    entrants.push(entrant(pipeline.name(), Method::Yoro, &options(pipeline))?);
                }
            }
            _ => entrants.push(entrant(method.name(), method, &truth_options)?),
        }
    }
    let mut frame = StereoFrame::new(gl, args.eyes.size)?;
    bar.inc(1);

    bar.set_message(format!("{name}: warming up"));
    for entrant in &mut entrants {
        stop_if_interrupted()?;
        entrant.entrant.render(&mut stage, &pairs[0], &mut frame)?;
    }
    bar.inc(1);

    let mut viewpoints = Vec::new();
    for round in 0..args.rounds {
        bar.set_message(format!("{name}: round {} of {}", round + 1, args.rounds));
        for (i, pair) in pairs.iter().enumerate() {
            let mut images: Vec<(String, [RgbImage; 2])> = Vec::new();
            for e in 0..entrants.len() {
                stop_if_interrupted()?;
                // Every method comes first, second, ... equally often.
                let turn = (e + i + round as usize) % entrants.len();
                let entrant = &mut entrants[turn];
                let time = entrant.entrant.render(&mut stage, pair, &mut frame)?;
                entrant.milliseconds.push(time.wall.as_secs_f64() * 1e3);
                if round == 0 {
                    images.push((entrant.name.into(), Eye::BOTH.map(|eye| stage::eye_image(&frame, eye))));
                }
            }
            if round == 0 {
                viewpoints.push(measure_viewpoint(
                    format!("viewpoint {}", keys[i]),
                    args,
                    images,
                    &entrants,
                )?);
            }
            bar.inc(1);
        }
    }

    bar.set_message(format!("{name}: timing passes"));
    for _ in 0..args.rounds {
        for entrant in &mut entrants {
            stop_if_interrupted()?;
            let times = entrant.entrant.pass_times(&mut stage, &pairs[0], &mut frame)?;
            entrant.add_passes(times);
        }
    }
    bar.inc(1);

    let mut costs = entrants.into_iter().map(Measured::cost).collect::<anyhow::Result<Vec<_>>>()?.into_iter();
    let conventional = costs.next().context("there is always the conventional method")?.cost;
    Ok(SceneReport {
        name: stage.scene.name.clone(),
        stands_for: BUILTINS.iter().find(|b| b.name == name).map_or("", |b| b.stands_for).into(),
        triangles: stage.scene.triangle_count() as u64,
        conventional,
        methods: costs.collect(),
        viewpoints,
    })
}

impl Measured {
    fn new(name: &'static str, entrant: Entrant) -> Measured {
        Measured { name, entrant, milliseconds: Vec::new(), passes: Vec::new() }
    }

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

/// Puts the images of one viewpoint into the order of the entrants and measures them.
fn measure_viewpoint(
    name: String,
    args: &RunArgs,
    mut images: Vec<(String, [RgbImage; 2])>,
    entrants: &[Measured],
) -> anyhow::Result<Viewpoint> {
    let other = args.eyes.dominant.other();
    let position = |name: &str| entrants.iter().position(|e| e.name == name);
    images.sort_by_key(|(name, _)| position(name));
    let mut images = images.into_iter();
    let (_, [left, right]) = images.next().context("the conventional method comes first")?;
    let (dominant, truth) = match args.eyes.dominant {
        Eye::Left => (left, right),
        Eye::Right => (right, left),
    };
    let synthesized =
        images.map(|(name, [left, right])| (name, if other == Eye::Left { left } else { right })).collect();
    Ok(Viewpoint::measure(name, args.eyes.dominant, dominant, truth, synthesized)?)
}

fn write_pictures(args: &RunArgs, report: &RunReport) -> anyhow::Result<()> {
    let dominant = args.eyes.dominant;
    for scene in &report.scenes {
        for viewpoint in scene.viewpoints.iter().take(PICTURED) {
            let save = |kind: &str, image: &RgbImage| {
                picture::save_color(&stage::picture_path(&args.out, &scene.name, kind), image)
            };
            let pair = |other: &RgbImage| match dominant {
                Eye::Left => picture::side_by_side(&viewpoint.dominant, other),
                Eye::Right => picture::side_by_side(other, &viewpoint.dominant),
            };
            save("conventional", &pair(&viewpoint.ground_truth)?)?;
            for view in &viewpoint.views {
                save(&view.method, &pair(&view.eye)?)?;
                save(&format!("{}.error-map", view.method), &view.error)?;
            }
        }
    }
    Ok(())
}

fn parameters(args: &RunArgs) -> Vec<Parameter> {
    let eyes = &args.eyes;
    let mut parameters = vec![
        ("size of each eye, pixels", format!("{} x {}", eyes.size[0], eyes.size[1])),
        ("vertical field of view, degrees", format!("{:.0}", eyes.fov_y.to_degrees())),
        ("IPD, metres", format!("{}", eyes.ipd)),
        ("near and far plane, metres", format!("{} and {}", eyes.near, eyes.far)),
        ("depth", if eyes.reversed_z { "reversed" } else { "standard" }.into()),
        ("dominant eye", eyes.dominant.name().into()),
        ("viewpoints per scene", args.viewpoints.to_string()),
        ("seed", args.seed.to_string()),
    ];
    for &pipeline in &args.pipelines {
        let o = args.stereo.options_of(pipeline);
        let mut text = format!("guard band {:?}, anti-aliasing {:?}", o.guard_band, o.anti_aliasing);
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
    format!(
        "Frame times: wall clock of a whole stereo frame up to glFinish, both eyes finished and anti-aliased; one warm-up frame per method, then {} interleaved rounds over {} viewpoints, the order of the methods rotated; medians. {passes}, medians over frames of their own at the first viewpoint.",
        args.rounds, args.viewpoints
    )
}
