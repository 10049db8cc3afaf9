//! `yoro dataset`: image groups for training and measuring.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use anyhow::{Context as _, bail, ensure};
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde::Serialize;

use crate::cli::Subcommand;
use crate::cli::args::{self, GlArgs, PatcherArgs, Shard};
use crate::cli::choices;
use crate::cli::eyes::{self, EyeArgs};
use crate::cli::settings::{OneSample, SettingOptions, Synthesis};
use crate::cli::terminal::progress_bar;
use yoro::eyes::{DepthConvention, DisparityMap, Eye, Frustum, GuardBand, Pose};
use yoro_assets::{CameraPath, Scene, ShadingStyle, Viewpoint, path};
use yoro_bench::dataset::{GroupOptions, GroupRenderer, ImageGroup};
use yoro_bench::inpaint::{Patcher, PatcherKind};
use yoro_files as files;
use yoro_files::interrupt;
use yoro_gl::Context;
use yoro_render::PreparedScene;
use yoro_render::stereo::{ImBufferSize, Pipeline};
use yoro_scenes::{self, BUILTINS, replacements};

/// The kinds of pictures in a group. Each has a folder of this name.
const PICTURES: [&str; 7] = ["rgb", "depth", "truth", "reprojected", "reprojected-depth", "mask", "patched"];
/// The folder of the groups' JSON files. They are written last, so that a group that has one is finished.
const GROUPS: &str = "group";
/// The file with the options that a scene's groups were made with.
const SETTINGS: &str = "dataset.json";

/// Write image groups of scenes: both eyes, depth, the reprojected eye, its holes, and the patched eye
#[derive(clap::Args, Clone, Debug)]
pub struct DatasetArgs {
    /// Built-in scenes, OBJ, glTF or GLB files [default: the eight that replace the paper's]
    scenes: Vec<String>,
    /// Groups of each scene, at even pace along its camera path
    #[arg(long, default_value_t = 16, value_parser = args::whole::<u32>(1..=1_000_000), value_name = "N")]
    groups: u32,
    /// Only this part of all groups, for array jobs: 1/8 up to 8/8. Parts may share a folder
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// Another camera path than the scene's own: a JSON array of {position, target}
    #[arg(long, value_name = "FILE")]
    path: Option<PathBuf>,
    /// Folder for the groups; one folder for each scene is made in it. Finished groups in it are kept
    #[arg(long, default_value = "dataset", value_name = "FOLDER")]
    out: PathBuf,
    /// Another shading style than the scene's own
    #[arg(long, value_parser = choices::style())]
    style: Option<ShadingStyle>,
    /// Seed of the built-in scenes
    #[arg(long, default_value_t = yoro_scenes::DEFAULT_SEED, value_parser = args::whole::<u64>(0..=u64::MAX), value_name = "N")]
    seed: u64,
    #[command(flatten)]
    eyes: EyeArgs,
    #[command(flatten)]
    synthesis: SettingOptions<Synthesis>,
    #[command(flatten)]
    patcher: PatcherArgs,
    #[command(flatten)]
    renderer: SettingOptions<OneSample>,
    #[command(flatten)]
    gl: GlArgs,
}

/// All settings that determine the groups of a scene: the content of `dataset.json`.
#[derive(Serialize)]
struct Settings<'a> {
    scene: &'a str,
    seed: u64,
    style: Option<ShadingStyle>,
    groups: u32,
    path: Option<&'a [Viewpoint]>,
    size: [u32; 2],
    fov_y_degrees: f64,
    ipd_metres: f32,
    dominant: Eye,
    near: f32,
    /// The far plane in metres; null for infinity.
    far: f32,
    depth: DepthConvention,
    patcher: Option<PatcherKind>,
    model: Option<&'a Path>,
    msaa: u32,
    #[serde(flatten)]
    options: GroupOptions,
}

/// The content of a group's JSON file.
#[derive(Serialize)]
struct Group<'a> {
    scene: &'a str,
    index: u32,
    /// The place on the camera path, 0 to 1.
    at: f32,
    head: Pose,
    eyes: BTreeMap<&'static str, Camera>,
    dominant: Eye,
    ipd_metres: f32,
    fov_y_degrees: f64,
    size: [u32; 2],
    depth: Depth,
    /// The share of the reprojected image that is holes.
    holes: f64,
    /// The paths of the pictures by kind, relative to the scene's folder.
    pictures: BTreeMap<&'static str, String>,
    /// The command that makes the other eye from `rgb` and `depth` when run in the scene's folder.
    synthesize: String,
}

#[derive(Serialize)]
struct Camera {
    pose: Pose,
    frustum: Frustum,
}

#[derive(Serialize)]
struct Depth {
    near_metres: f32,
    /// The far plane in metres; null for infinity.
    far_metres: f32,
    encoding: &'static str,
    bits: u8,
    /// The law `x_other = x + offset + scale * value`, with values from 0 to 1.
    law: DisparityMap,
}

impl DatasetArgs {
    /// Returns the names of the scenes.
    fn names(&self) -> Vec<String> {
        match self.scenes.as_slice() {
            [] => replacements().map(|b| b.name.to_owned()).collect(),
            given => given.to_vec(),
        }
    }

    /// Returns the folder of a scene's groups.
    fn folder(&self, scene: &str) -> PathBuf {
        self.out.join(eyes::stem(scene))
    }
}

impl Subcommand for DatasetArgs {
    /// Makes the missing groups.
    fn run(&self) -> anyhow::Result<()> {
        self.eyes.check()?;
        ensure!(
            self.eyes.half_angles_degrees.is_none(),
            "--half-angles-degrees cannot be used here: `yoro synthesize` reads the groups and takes symmetric frusta; leave it out"
        );
        self.patcher.check()?;
        let path = self.path.as_deref().map(path::read).transpose()?;
        let names = self.names();
        // Names and folders are checked before hours of work.
        let groups = self.groups as usize;
        let all = 0..names.len() * groups;
        let part = self.shard.map_or(all.clone(), |shard| shard.part(all.len()));
        let jobs = names
            .iter()
            .zip(0..)
            .map(|(name, at)| {
                let within = |position: usize| position.clamp(at * groups, (at + 1) * groups) - at * groups;
                Job::new(self, name, path.as_deref(), within(part.start) as u32..within(part.end) as u32)
            })
            .collect::<anyhow::Result<Vec<Job>>>()?;
        let total = part.len() as u64;
        let missing: u64 = jobs.iter().map(|job| job.missing.len() as u64).sum();
        let bar = progress_bar(total);
        bar.set_position(total - missing);
        if missing > 0 {
            let headless = self.gl.open()?;
            let gl = headless.gl();
            let mut patcher = self.patcher.create(gl)?;
            for job in &jobs {
                job.run(self, gl, path.as_deref(), &mut patcher, &bar)?;
            }
        }
        bar.finish_and_clear();
        println!("{total} groups in {} ({missing} new)", self.out.display());
        Ok(())
    }
}

fn group_options(args: &DatasetArgs) -> GroupOptions {
    GroupOptions { synthesis: args.synthesis.options(), guard_band: GuardBand::None }
}

/// The missing groups of one scene.
struct Job<'a> {
    name: &'a str,
    folder: PathBuf,
    settings: serde_json::Value,
    missing: Vec<u32>,
}

impl<'a> Job<'a> {
    /// Returns the job for those of a scene's groups `indices` that are missing.
    fn new(
        args: &DatasetArgs,
        name: &'a str,
        path: Option<&[Viewpoint]>,
        indices: Range<u32>,
    ) -> anyhow::Result<Job<'a>> {
        let is_file = !BUILTINS.iter().any(|b| b.name == name);
        if is_file && !Path::new(name).exists() {
            yoro_scenes::load(name, args.seed, None)?;
        }
        let folder = args.folder(name);
        let settings = serde_json::to_value(Settings {
            scene: name,
            seed: args.seed,
            style: args.style,
            groups: args.groups,
            path,
            size: args.eyes.size,
            fov_y_degrees: fov_y_degrees(args),
            ipd_metres: args.eyes.ipd.metres(),
            dominant: args.eyes.dominant,
            near: args.eyes.near,
            far: args.eyes.far,
            depth: args.eyes.pair(Pose::IDENTITY).depth.convention,
            patcher: args.patcher.patcher,
            model: args.patcher.model.as_deref(),
            msaa: args.renderer.render_settings().msaa,
            options: group_options(args),
        })?;
        check_settings(&folder, &settings)?;
        let missing = indices.filter(|&index| !is_finished(&folder, index)).collect();
        Ok(Job { name, folder, settings, missing })
    }

    fn run(
        &self,
        args: &DatasetArgs,
        gl: &Rc<Context>,
        path: Option<&[Viewpoint]>,
        patcher: &mut Option<Box<dyn Patcher>>,
        bar: &ProgressBar,
    ) -> anyhow::Result<()> {
        if self.missing.is_empty() {
            return Ok(());
        }
        bar.set_message(format!("{}: preparing", self.name));
        stop(args)?;
        files::write(&self.folder.join(SETTINGS), format!("{:#}\n", self.settings).as_bytes())?;
        let settings = args.renderer.render_settings();
        let scene: Scene = yoro_scenes::load(self.name, args.seed, args.style)?;
        let path = CameraPath::new(path.unwrap_or(&scene.viewpoints));
        let PreparedScene { scene, mut renderer } = PreparedScene::new(gl, scene, &settings)?;
        let mut groups = GroupRenderer::new(gl, &group_options(args))?;
        bar.set_message(self.name.to_owned());
        for &index in &self.missing {
            stop(args)?;
            let at = index as f32 / (args.groups.max(2) - 1) as f32;
            let head = path.pose(at);
            let group = groups.render(&mut renderer, &scene, &args.eyes.pair(head))?;
            let patched = match patcher {
                Some(patcher) => patcher.patch(&group.reprojected)?.image,
                None => group.synthesized.clone(),
            };
            self.save(args, index, at, head, &group, &patched)?;
            bar.inc(1);
        }
        Ok(())
    }

    fn save(
        &self,
        args: &DatasetArgs,
        index: u32,
        at: f32,
        head: Pose,
        group: &ImageGroup,
        patched: &image::RgbImage,
    ) -> anyhow::Result<()> {
        PICTURES.par_iter().try_for_each(|&kind| {
            let file = self.folder.join(picture_name(kind, index));
            match kind {
                "rgb" => yoro_media::save_color(&file, &group.color),
                "depth" => yoro_media::save_depth(&file, &group.depth),
                "truth" => yoro_media::save_color(&file, &group.truth),
                "reprojected" => yoro_media::save_color(&file, group.reprojected.color()),
                "reprojected-depth" => yoro_media::save_depth(&file, &group.reprojected_depth()),
                "mask" => yoro_media::save_gray(&file, group.reprojected.mask()),
                _ => yoro_media::save_color(&file, patched),
            }
        })?;
        let (pair, depth) = (&group.pair, group.pair.depth);
        let camera = |eye: Eye| Camera { pose: pair.poses[eye.index()], frustum: pair.frusta[eye.index()] };
        let record = Group {
            scene: self.name,
            index,
            at,
            head,
            eyes: Eye::BOTH.into_iter().map(|eye| (eye.name(), camera(eye))).collect(),
            dominant: pair.dominant,
            ipd_metres: args.eyes.ipd.metres(),
            fov_y_degrees: fov_y_degrees(args),
            size: pair.size,
            depth: Depth {
                near_metres: depth.near,
                far_metres: depth.far,
                encoding: encoding(depth.convention),
                bits: 16,
                law: group.views.warp.law,
            },
            holes: group.reprojected.hole_share(),
            pictures: PICTURES.into_iter().map(|kind| (kind, picture_name(kind, index))).collect(),
            synthesize: synthesize_command(args, index),
        };
        let json = serde_json::to_string_pretty(&record)?;
        Ok(files::write(&self.folder.join(group_name(index)), format!("{json}\n").as_bytes())?)
    }
}

/// Returns the field of view in rounded degrees: 60 degrees, stored as radians in f32, would be 60.000004.
fn fov_y_degrees(args: &DatasetArgs) -> f64 {
    (f64::from(args.eyes.fov_y).to_degrees() * 1e4).round() / 1e4
}

fn stop(args: &DatasetArgs) -> anyhow::Result<()> {
    ensure!(
        !interrupt::requested(),
        "interrupted: the groups in {} are complete; the same command makes the rest",
        args.out.display()
    );
    Ok(())
}

fn picture_name(kind: &str, index: u32) -> String {
    format!("{kind}/{index:06}.png")
}

fn group_name(index: u32) -> String {
    format!("{GROUPS}/{index:06}.json")
}

/// Returns the name of a depth convention in the options of `yoro synthesize`.
fn encoding(convention: DepthConvention) -> &'static str {
    match convention {
        DepthConvention::Standard => "standard-z",
        DepthConvention::Reversed => "reversed-z",
    }
}

/// Returns the command line that makes `patched` again from `rgb` and `depth`.
fn synthesize_command(args: &DatasetArgs, index: u32) -> String {
    let eyes = &args.eyes;
    let mut command = format!(
        "yoro synthesize --color {} --depth {} --depth-encoding {} --near {} --far {} --fov-y-degrees {} --ipd {} --dominant {} --pipeline {}",
        picture_name("rgb", index),
        picture_name("depth", index),
        encoding(eyes.pair(Pose::IDENTITY).depth.convention),
        eyes.near,
        eyes.far,
        fov_y_degrees(args),
        eyes.ipd,
        eyes.dominant.name(),
        args.synthesis.settings().pipeline.name(),
    );
    let mut add = |option: String| command.extend([" --", option.as_str()]);
    if args.synthesis.settings().pipeline == Pipeline::Paper {
        let paper = args.synthesis.options().paper;
        add(match paper.imbuffer {
            ImBufferSize::Divisor(n) => format!("imbuffer {n}"),
            ImBufferSize::Fixed([w, h]) => format!("imbuffer {w}x{h}"),
        });
        if !paper.linear_interpolation {
            add("no-linear-interpolation".into());
        }
        if paper.strict {
            add("strict".into());
        }
    }
    if let Some(kind) = args.patcher.patcher {
        add(format!("patcher {}", kind.name()));
    }
    if let Some(model) = &args.patcher.model {
        let model = std::path::absolute(model).unwrap_or_else(|_| model.clone());
        add(format!("model {}", model.display()));
    }
    add(format!("out {}", picture_name("synthesized", index)));
    command
}

/// True if a group is finished: its JSON file, which is written last, and all pictures exist.
fn is_finished(folder: &Path, index: u32) -> bool {
    folder.join(group_name(index)).is_file()
        && PICTURES.iter().all(|kind| folder.join(picture_name(kind, index)).is_file())
}

/// Refuses to mix groups with different settings in one folder.
fn check_settings(folder: &Path, settings: &serde_json::Value) -> anyhow::Result<()> {
    let file = folder.join(SETTINGS);
    if !file.exists() {
        return Ok(());
    }
    let old: serde_json::Value = serde_json::from_slice(&files::read(&file)?).with_context(|| {
        format!("{} is damaged: remove the folder, or choose another with --out", file.display())
    })?;
    let different = |key: &&String| old.get(key) != settings.get(key);
    if let Some(key) = settings.as_object().and_then(|object| object.keys().find(different)) {
        let value =
            |settings: &serde_json::Value| settings.get(key).unwrap_or(&serde_json::Value::Null).to_string();
        bail!(
            "{} holds groups of other settings ({key} {} instead of {}): give the same ones, or choose another folder with --out",
            folder.display(),
            value(&old),
            value(settings)
        );
    }
    Ok(())
}
