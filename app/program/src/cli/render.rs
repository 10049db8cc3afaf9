//! `yoro render`: stereo pictures of a scene.

use std::path::PathBuf;
use std::rc::Rc;
use std::time::Instant;

use anyhow::bail;
use clap::ValueEnum as _;
use glam::Vec3;
use image::RgbImage;
use serde::Serialize;

use crate::cli::Subcommand;
use crate::cli::args::{self, GlArgs};
use crate::cli::choices;
use crate::cli::eyes::{self, EyeArgs};
use crate::cli::message;
use crate::cli::settings::{self, Foveated, Renderer, SettingOptions, Stereo};
use crate::cli::terminal::progress_bar;
use crate::cli::video::{self, EncodingArgs};
use yoro::eyes::{Eye, Gaze, Pose};
use yoro_assets::{CameraPath, ShadingStyle};
use yoro_bench::bench::BlankFinder;
use yoro_files::interrupt;
use yoro_gl::Context;
use yoro_media::rgb_image;
use yoro_metrics::{Channels, Quality, error_map};
use yoro_render::PreparedScene;
use yoro_render::stereo::{Method, StereoFrame, StereoSession};

/// A picture made from the two eyes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Output {
    /// The left eye
    Left,
    /// The right eye
    Right,
    /// Left and right side by side
    SideBySide,
    /// Side by side with the eyes swapped, to be viewed with crossed eyes
    CrossEyed,
    /// Anaglyph for red and cyan glasses
    Anaglyph,
    /// Difference between the second eye and its rendered reference, times four
    Difference,
    /// Error map 1 - SSIM of the second eye against its rendered reference
    ErrorMap,
}

impl Output {
    fn needs_truth(self) -> bool {
        matches!(self, Output::Difference | Output::ErrorMap)
    }

    fn name(self) -> String {
        self.to_possible_value().expect("none is hidden").get_name().to_owned()
    }
}

/// Render stereo pictures of a built-in scene, or of an OBJ or glTF file
#[derive(clap::Args, Clone, Debug)]
pub struct RenderArgs {
    /// A built-in scene (see `yoro scenes`), or an OBJ, glTF or GLB file
    scene: String,
    /// The stereo method
    #[arg(long, value_parser = settings::value_of::<Method>("method"), default_value = Method::Synthesized.name())]
    method: Method,
    /// Number of the scene's viewpoint, from 0
    #[arg(long, default_value_t = 0, conflicts_with_all = ["frames", "position"], value_parser = args::whole::<usize>(0..=usize::MAX), value_name = "N")]
    pose: usize,
    /// Render N frames along the scene's camera path instead of one viewpoint
    #[arg(long, value_name = "N", conflicts_with = "position", value_parser = args::whole::<u32>(1..=100_000))]
    frames: Option<u32>,
    /// The time in seconds for what moves in the scene; with --frames, the time of the first frame
    #[arg(long, default_value_t = 0.0, value_parser = seconds, value_name = "SECONDS", allow_hyphen_values = true)]
    time: f64,
    /// The one animation of a glTF file that plays, by its name or number from 0 [default: all that move different things]
    #[arg(long, value_name = "NAME")]
    animation: Option<String>,
    /// Head position in metres, instead of a viewpoint of the scene
    #[arg(long, value_parser = eyes::parse_point, value_name = "X,Y,Z", allow_hyphen_values = true)]
    position: Option<Vec3>,
    /// The point that the head looks at
    #[arg(long, value_parser = eyes::parse_point, value_name = "X,Y,Z", requires = "position", allow_hyphen_values = true)]
    target: Option<Vec3>,
    /// Another shading style than the scene's own
    #[arg(long, value_parser = choices::style())]
    style: Option<ShadingStyle>,
    /// Seed of a built-in scene
    #[arg(long, default_value_t = yoro_scenes::DEFAULT_SEED, value_parser = args::whole::<u64>(0..=u64::MAX), value_name = "N")]
    seed: u64,
    /// Folder for the pictures
    #[arg(long, default_value = "out", value_name = "FOLDER")]
    out: PathBuf,
    /// The pictures to write
    #[arg(long, value_enum, value_delimiter = ',', default_value = "left,right,side-by-side")]
    outputs: Vec<Output>,
    /// Write the frames as an RGBD video instead of pictures, such as `--frames 120 --video a.mp4`: the rendered eye with its guard band, and its
    /// depth beside it. `yoro synthesize FILE` makes stereo of it
    #[arg(long, value_name = "FILE", requires = "frames", conflicts_with_all = ["out", "outputs", "measure", "json", "method"])]
    video: Option<PathBuf>,
    /// Frames a second, of videos and for what moves
    #[arg(long, default_value_t = 30, value_name = "HZ", value_parser = args::whole::<u32>(1..=1000))]
    frame_rate: u32,
    #[command(flatten)]
    encoding: EncodingArgs,
    /// Print PSNR and SSIM of the synthesized eye against two full renders, which no --foveation changes
    #[arg(long)]
    measure: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    eyes: EyeArgs,
    #[command(flatten)]
    stereo: SettingOptions<Stereo>,
    #[command(flatten)]
    foveated: SettingOptions<Foveated>,
    #[command(flatten)]
    renderer: SettingOptions<Renderer>,
    #[command(flatten)]
    gl: GlArgs,
}

/// Parses a finite time in seconds.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| seconds.is_finite());
    seconds.ok_or_else(|| "give a number of seconds".into())
}

#[derive(Serialize)]
struct FrameReport {
    frame: usize,
    milliseconds: f64,
    pictures: Vec<PathBuf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    quality: Option<Quality>,
    /// The baseline: the same image for both eyes.
    #[serde(skip_serializing_if = "Option::is_none")]
    same_image: Option<Quality>,
}

impl Subcommand for RenderArgs {
    /// Renders and writes the pictures.
    fn run(&self) -> anyhow::Result<()> {
        self.eyes.check()?;
        self.video.as_deref().map(video::check_name).transpose()?;
        let settings = self.renderer.render_settings();
        let scene =
            yoro_scenes::load_animated(&self.scene, self.seed, self.style, self.animation.as_deref())?;
        if self.position.is_none() {
            scene.warn_of_made_up_viewpoints();
        }
        let path = CameraPath::new(&scene.viewpoints);
        let heads = match (eyes::viewpoint(self.position, self.target), self.frames) {
            (Some(viewpoint), _) => vec![viewpoint.pose()],
            (None, Some(n)) => path.poses(n as usize),
            (None, None) => vec![eyes::scene_pose(&scene, self.pose)?],
        };
        let foveation = self.foveated.foveation();
        let options = self.stereo.options();
        if self.video.is_some() {
            video::check_size(&self.eyes, options.guard_band)?;
        }
        log::info!("{}", self.stereo.summary());
        log::info!("{}", self.eyes.distances(options.guard_band));
        let headless = self.gl.open()?;
        let gl = headless.gl();
        settings.supports(self.method, gl.capabilities())?;
        if self.video.is_none() {
            // A folder that cannot be is found out before anything is rendered.
            yoro_files::create_folder(&self.out)?;
        }
        let mut prepared = PreparedScene::new(gl, scene, &settings)?;
        prepared.set_time(self.time)?;
        warn_of_blank(gl, self, &mut prepared, &heads)?;
        if let Some(file) = &self.video {
            let encoding = (self.frame_rate, self.encoding);
            return video::render(gl, file, prepared, (&heads, self.time), (&self.eyes, &options), encoding);
        }
        let mut session = StereoSession::new(gl, self.method.into(), &settings, &options)?;
        let measured = self.measure || self.outputs.iter().any(|o| o.needs_truth());
        let mut truth = measured
            .then(|| StereoSession::new(gl, Method::Conventional.into(), &settings, &options))
            .transpose()?;
        session.prepare(&mut prepared, foveation.is_some())?;
        let mut frame = StereoFrame::new(gl, self.eyes.size)?;
        let mut reports = Vec::new();
        let bar = progress_bar(heads.len() as u64);
        for (i, &head) in heads.iter().enumerate() {
            if interrupt::requested() {
                bail!("interrupted: {i} of {} frames are in {}", heads.len(), self.out.display());
            }
            let pair = self.eyes.pair(head);
            let start = Instant::now();
            prepared.set_time(self.time + i as f64 / f64::from(self.frame_rate))?;
            let views = pair.stereo_views(foveation.as_ref(), Gaze::Axes(pair.axes()))?;
            session.frame(&mut prepared, &views, frame.fit(pair.size)?, None)?;
            gl.finish();
            let milliseconds = start.elapsed().as_secs_f64() * 1e3;
            let eyes = Eye::BOTH.map(|eye| rgb_image(&frame.rgba(eye), frame.size()));
            let second = pair.dominant.other();
            let mut quality = None;
            let mut truth_image = None;
            if let Some(truth) = &mut truth {
                truth.frame(&mut prepared, &pair.into(), frame.fit(pair.size)?, None)?;
                let real = rgb_image(&frame.rgba(second), frame.size());
                quality = Some([
                    Quality::of(&eyes[second.index()], &real, Channels::Rgb)?,
                    Quality::of(&eyes[pair.dominant.index()], &real, Channels::Rgb)?,
                ]);
                truth_image = Some(real);
            }
            let scene = &prepared.scene.name;
            let stem = if heads.len() > 1 { format!("{scene}-{i:04}") } else { scene.clone() };
            let mut pictures = Vec::new();
            for &output in &self.outputs {
                let path = eyes::picture_path(&self.out, &stem, &output.name());
                yoro_media::save_color(&path, &compose(output, &eyes, second, truth_image.as_ref())?)?;
                pictures.push(path);
            }
            let [quality, same_image] = quality.map_or([None, None], |q| q.map(Some));
            reports.push(FrameReport { frame: i, milliseconds, pictures, quality, same_image });
            bar.inc(1);
        }
        bar.finish_and_clear();
        print(self, &reports)
    }
}

/// Largest number of frames, spread over all, that [`warn_of_blank`] tries.
const TRIED: usize = 20;

/// Warns if pictures would show nothing of the scene, by trying some of them.
fn warn_of_blank(
    gl: &Rc<Context>,
    args: &RenderArgs,
    prepared: &mut PreparedScene,
    heads: &[Pose],
) -> anyhow::Result<()> {
    let mut finder = BlankFinder::new(gl)?;
    let mut blanks = Vec::new();
    let tried: Vec<Pose> = heads.iter().copied().step_by(heads.len().div_ceil(TRIED).max(1)).collect();
    for &head in &tried {
        interrupt::check()?;
        blanks.extend(finder.blank(prepared, &args.eyes.pair(head))?);
    }
    if let Some(first) = blanks.first() {
        let option = message::plane(*first).map_or_else(String::new, |option| format!(" ({option})"));
        log::warn!(
            "{} of {} frames of {} show nothing of it: {}{option}",
            blanks.len(),
            tried.len(),
            prepared.scene.name,
            first.remedy(&prepared.scene.name)
        );
    }
    Ok(())
}

fn compose(
    output: Output,
    eyes: &[RgbImage; 2],
    second: Eye,
    truth: Option<&RgbImage>,
) -> anyhow::Result<RgbImage> {
    let [left, right] = eyes;
    let against = |f: fn(&RgbImage, &RgbImage) -> anyhow::Result<RgbImage>| {
        f(&eyes[second.index()], truth.unwrap_or(&eyes[second.index()]))
    };
    Ok(match output {
        Output::Left => left.clone(),
        Output::Right => right.clone(),
        Output::SideBySide => yoro_media::side_by_side(left, right)?,
        Output::CrossEyed => yoro_media::cross_eyed(left, right)?,
        Output::Anaglyph => yoro_media::anaglyph(left, right)?,
        Output::Difference => against(|a, b| Ok(yoro_media::difference(a, b)?))?,
        Output::ErrorMap => against(|a, b| Ok(error_map(a, b)?))?,
    })
}

fn print(args: &RenderArgs, reports: &[FrameReport]) -> anyhow::Result<()> {
    if args.json {
        println!("{}", serde_json::to_string_pretty(reports)?);
        return Ok(());
    }
    for report in reports {
        for picture in &report.pictures {
            println!("{}", picture.display());
        }
        if let (Some(q), Some(s)) = (report.quality, report.same_image) {
            println!(
                "frame {}: {:.2} dB, SSIM {:.4} (same image to both eyes: {:.2} dB, {:.4})",
                report.frame, q.psnr.0, q.ssim_gaussian, s.psnr.0, s.ssim_gaussian
            );
        }
    }
    Ok(())
}
