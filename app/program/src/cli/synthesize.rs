//! `yoro synthesize`: makes the other eye from a colour and a depth image, or from a video.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow, bail, ensure};
use image::{GrayImage, Luma};

use crate::cli::Subcommand;
use crate::cli::args::{GlArgs, PatcherArgs, parse_far, parse_finite, parse_fov, parse_positive};
use crate::cli::settings::{SettingOptions, Synthesis};
use crate::cli::terminal::progress_bar;
use crate::cli::video::{self, EncodingArgs};
use yoro::eyes::{DepthConvention, DepthRange, Eye, Warp};
use yoro::synthesis::SourceMapEntry;
use yoro_bench::inpaint::{Patcher, Reprojected};
use yoro_files as files;
use yoro_files::interrupt;
use yoro_media::video::Reader;
use yoro_media::{
    self, DepthImage, DepthSamples, Nearness, PictureError, StoredDepth, StoredDepthError, rgb_image,
};
use yoro_render::stereo::{Offline, SynthesizedImage};
use yoro_settings::Ipd;

/// The meaning of a depth image's values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum DepthEncoding {
    /// Depth buffer, 0 near to 1 far; needs --near and --far
    StandardZ,
    /// Depth buffer, 1 near to 0 far; needs --near and --far
    ReversedZ,
    /// Distance along the viewing axis in metres (PNG: times --metres-at-white)
    Metres,
    /// Disparity in pixels: --disparity-offset + --disparity-scale * value
    Disparity,
}

/// The eye that the images show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum SourceEye {
    /// The left eye: the right one is synthesized
    Left,
    /// The right eye: the left one is synthesized
    Right,
    /// A camera between the eyes: both are synthesized, to OUT.left.png and OUT.right.png
    Center,
}

/// Synthesize the other eye from a colour image and a depth image, from folders of them, or of an RGBD video
#[derive(clap::Args, Clone, Debug)]
pub struct SynthesizeArgs {
    /// An RGBD video from `yoro render --video`; --out is then a video of both eyes side by side
    #[arg(conflicts_with_all = ["color", "depth", "dominant", "depth_encoding", "depth_gamma", "near", "far", "metres_at_white",
        "disparity_offset", "disparity_scale", "fov_y", "ipd", "mask_out", "disparity_out", "source_out", "patcher"])]
    video: Option<PathBuf>,
    /// Colour image of the rendered eye, or a folder
    #[arg(long, required_unless_present = "video", value_name = "FILE|FOLDER")]
    color: Option<PathBuf>,
    /// Depth image of the same size: 8 or 16-bit PNG, or EXR; or a folder with files of the same names
    #[arg(long, required_unless_present = "video", value_name = "FILE|FOLDER")]
    depth: Option<PathBuf>,
    /// File for the synthesized eye (.png, for a video .mp4), or a folder
    #[arg(long, value_name = "FILE|FOLDER")]
    out: PathBuf,
    /// The eye that the images show
    #[arg(long, value_enum, default_value_t = SourceEye::Right)]
    dominant: SourceEye,
    /// Meaning of the depth values
    #[arg(long, value_enum, default_value_t = DepthEncoding::StandardZ)]
    depth_encoding: DepthEncoding,
    /// The stored value is raised to this power first
    #[arg(long, default_value_t = 1.0, value_parser = parse_positive, allow_negative_numbers = true)]
    depth_gamma: f32,
    /// Near plane in metres
    #[arg(long, default_value_t = DepthRange::PAPER.near, value_parser = parse_positive, allow_negative_numbers = true)]
    near: f32,
    /// Far plane in metres; `inf` for none
    #[arg(long, default_value_t = DepthRange::PAPER.far, value_parser = parse_far, allow_negative_numbers = true)]
    far: f32,
    /// metres: distance of the largest value of an integer PNG
    #[arg(long, default_value_t = 1.0, value_parser = parse_positive, allow_negative_numbers = true)]
    metres_at_white: f32,
    /// disparity: pixels at value 0
    #[arg(long, default_value_t = 0.0, value_parser = parse_finite, allow_negative_numbers = true)]
    disparity_offset: f32,
    /// disparity: pixels per unit (a PNG's largest value is 1)
    #[arg(long, default_value_t = 1.0, value_parser = parse_finite, allow_negative_numbers = true)]
    disparity_scale: f32,
    /// Vertical field of view of the images in degrees
    #[arg(long = "fov-y-degrees", default_value = "60", value_parser = parse_fov, allow_negative_numbers = true)]
    fov_y: f32,
    /// Distance between the eyes in metres
    #[arg(long, default_value_t = Ipd::DEFAULT, allow_negative_numbers = true)]
    ipd: Ipd,
    /// Also write the mask of holes as PNG: black where nothing of the source is seen
    #[arg(long, value_name = "FILE|FOLDER")]
    mask_out: Option<PathBuf>,
    /// Also write the disparity in pixels, as EXR
    #[arg(long, value_name = "FILE|FOLDER")]
    disparity_out: Option<PathBuf>,
    /// Also write the column in the colour image that each pixel comes from, as EXR
    #[arg(long, value_name = "FILE|FOLDER")]
    source_out: Option<PathBuf>,
    #[command(flatten)]
    encoding: EncodingArgs,
    #[command(flatten)]
    synthesis: SettingOptions<Synthesis>,
    #[command(flatten)]
    patcher: PatcherArgs,
    #[command(flatten)]
    gl: GlArgs,
}

/// The input and output files of one image group.
struct Job {
    color: PathBuf,
    depth: PathBuf,
    out: PathBuf,
    mask: Option<PathBuf>,
    disparity: Option<PathBuf>,
    source: Option<PathBuf>,
}

impl SourceEye {
    /// Returns the eyes to synthesize, with the share of the IPD that each is away from the source.
    fn targets(self) -> &'static [(Eye, f64)] {
        match self {
            SourceEye::Right => &[(Eye::Left, 1.0)],
            SourceEye::Left => &[(Eye::Right, 1.0)],
            SourceEye::Center => &[(Eye::Left, 0.5), (Eye::Right, 0.5)],
        }
    }

    /// Returns the path of an eye's file.
    fn place(self, path: &Path, eye: Eye) -> PathBuf {
        match self {
            SourceEye::Center => {
                let extension = path.extension().unwrap_or_default().to_string_lossy();
                path.with_extension(format!("{}.{extension}", eye.name()))
            }
            _ => path.to_owned(),
        }
    }
}

impl Job {
    /// Refuses outputs whose format is not one that will be written, before any is.
    fn check(&self) -> Result<(), PictureError> {
        let floats = (&["png", "exr"][..], ".png or .exr");
        let outputs = [
            (Some(&self.out), (&["png", "jpg", "jpeg"][..], ".png or .jpg")),
            (self.mask.as_ref(), (&["png"][..], ".png")),
            (self.disparity.as_ref(), floats),
            (self.source.as_ref(), floats),
        ];
        for (path, (extensions, allowed)) in outputs {
            if let Some(path) = path.filter(|path| !files::has_extension(path, extensions)) {
                return Err(PictureError::extension(path, allowed));
            }
        }
        Ok(())
    }
}

impl Subcommand for SynthesizeArgs {
    /// Synthesizes one image or a folder of them.
    fn run(&self) -> anyhow::Result<()> {
        ensure!(self.near < self.far, "--near {} must be less than --far {}", self.near, self.far);
        self.patcher.check()?;
        if let Some(file) = &self.video {
            video::check_name(&self.out)?;
            // A wrong file is reported before a context is opened.
            Reader::open(file)?.rgbd()?;
            let headless = self.gl.open()?;
            return video::synthesize(
                headless.gl(),
                file,
                &self.out,
                &self.synthesis.options(),
                self.encoding,
            );
        }
        let jobs = jobs(self)?;
        jobs.iter().try_for_each(Job::check)?;
        let headless = self.gl.open()?;
        let mut offline = Offline::new(headless.gl(), &self.synthesis.options())?;
        let mut patcher = self.patcher.create(headless.gl())?;
        let bar = progress_bar(jobs.len() as u64);
        let mut written = Vec::new();
        for job in &jobs {
            interrupt::check()?;
            bar.set_message(job.color.display().to_string());
            written = run_job(self, job, &mut offline, &mut patcher)?;
            bar.inc(1);
        }
        bar.finish_and_clear();
        match jobs.as_slice() {
            [_] => written.iter().for_each(|path| println!("{}", path.display())),
            _ => println!("{} images in {}", jobs.len(), self.out.display()),
        }
        Ok(())
    }
}

fn jobs(args: &SynthesizeArgs) -> anyhow::Result<Vec<Job>> {
    let (Some(color), Some(depth)) = (&args.color, &args.depth) else {
        bail!("give --color and --depth, or a video");
    };
    for path in [color, depth] {
        ensure!(path.exists(), "{} does not exist: check the path", path.display());
    }
    let (folder, file) = if color.is_dir() { (color, depth) } else { (depth, color) };
    ensure!(
        color.is_dir() == depth.is_dir(),
        "{} is a folder and {} is a file: give two files or two folders",
        folder.display(),
        file.display()
    );
    if !color.is_dir() {
        return Ok(vec![Job {
            color: color.clone(),
            depth: depth.clone(),
            out: args.out.clone(),
            mask: args.mask_out.clone(),
            disparity: args.disparity_out.clone(),
            source: args.source_out.clone(),
        }]);
    }
    let colors = files::find(color, &yoro_media::EXTENSIONS)?;
    let depths = files::find(depth, &yoro_media::EXTENSIONS)?;
    ensure!(
        !colors.is_empty(),
        "{} holds no images ({})",
        color.display(),
        yoro_media::EXTENSIONS.join(", ")
    );
    colors
        .iter()
        .map(|name| {
            let stem = name.with_extension("");
            let found = depths.iter().find(|d| d.with_extension("") == stem).with_context(|| {
                format!(
                    "{} has no depth image of that name in {}",
                    color.join(name).display(),
                    depth.display()
                )
            })?;
            let within = |folder: &Option<PathBuf>, extension: &str| {
                folder.as_ref().map(|folder| folder.join(name).with_extension(extension))
            };
            Ok(Job {
                color: color.join(name),
                depth: depth.join(found),
                out: args.out.join(name).with_extension("png"),
                mask: within(&args.mask_out, "png"),
                disparity: within(&args.disparity_out, "exr"),
                source: within(&args.source_out, "exr"),
            })
        })
        .collect()
}

/// Synthesizes one image group, and returns the paths of the synthesized images.
fn run_job(
    args: &SynthesizeArgs,
    job: &Job,
    offline: &mut Offline,
    patcher: &mut Option<Box<dyn Patcher>>,
) -> anyhow::Result<Vec<PathBuf>> {
    let color = yoro_media::load_color(&job.color)?;
    let depth = yoro_media::load_depth(&job.depth)?;
    if color.dimensions() != depth.image.dimensions() {
        let ((cw, ch), (dw, dh)) = (color.dimensions(), depth.image.dimensions());
        bail!(
            "{} is {cw}x{ch} pixels and {} is {dw}x{dh}: colour and depth must have one size",
            job.color.display(),
            job.depth.display()
        );
    }
    let nearness = decode_depth(args, &depth.image, depth.samples, &job.depth)?;
    let rgba: Vec<u8> = color.rows().rev().flatten().flat_map(|p| [p[0], p[1], p[2], 255]).collect();
    let size = [color.width(), color.height()];
    let mut written = Vec::new();
    for &(eye, share) in args.dominant.targets() {
        let warp = nearness.warp(size, eye, share);
        let result = offline.run(&rgba, &nearness.values, &warp)?;
        let named = |path: &Path| args.dominant.place(path, eye);
        let entries = entries(&result, &warp);
        let map = |value: fn(&SourceMapEntry) -> f32| {
            DepthImage::from_fn(size[0], size[1], |x, y| Luma([value(&entries[(y * size[0] + x) as usize])]))
        };
        written.push(named(&job.out));
        let image = match patcher {
            Some(patcher) => {
                let patched = Reprojected::from_synthesis(&result, &warp).and_then(|r| patcher.patch(&r));
                patched.with_context(|| format!("cannot patch {}", job.color.display()))?.image
            }
            None => rgb_image(&result.rgba, size),
        };
        yoro_media::save_color(&named(&job.out), &image)?;
        if let Some(path) = &job.mask {
            let holes = GrayImage::from_fn(size[0], size[1], |x, y| {
                Luma([if entries[(y * size[0] + x) as usize].hole { 0 } else { 255 }])
            });
            yoro_media::save_gray(&named(path), &holes)?;
        }
        if let Some(path) = &job.disparity {
            yoro_media::save_depth(&named(path), &map(|e| e.displacement))?;
        }
        if let Some(path) = &job.source {
            yoro_media::save_depth(&named(path), &map(|e| e.column))?;
        }
    }
    Ok(written)
}

/// Returns the source map's entries, rows from the top.
fn entries(result: &SynthesizedImage, warp: &Warp) -> Vec<SourceMapEntry> {
    let rows = result.source_map.chunks_exact(warp.target_size[0] as usize).rev();
    rows.flat_map(|row| (0u32..).zip(row).map(|(x, &entry)| SourceMapEntry::decode(entry, x, warp))).collect()
}

/// Decodes the values of a depth image, with rows from the bottom.
fn decode_depth(
    args: &SynthesizeArgs,
    image: &DepthImage,
    samples: DepthSamples,
    path: &Path,
) -> anyhow::Result<Nearness> {
    let focal_length = 0.5 * image.height() as f64 / (0.5 * args.fov_y as f64).tan();
    let reach = focal_length * f64::from(args.ipd.metres());
    let stored: Vec<f32> = image.rows().rev().flatten().map(|p| p.0[0].powf(args.depth_gamma)).collect();
    ensure!(
        !stored.iter().any(|v| v.is_nan()),
        "{} has negative values, of which no power can be taken: leave --depth-gamma out",
        path.display()
    );
    let range = |convention| DepthRange { near: args.near, far: args.far, convention };
    let encoding = match args.depth_encoding {
        DepthEncoding::StandardZ => StoredDepth::Window(range(DepthConvention::Standard)),
        DepthEncoding::ReversedZ => StoredDepth::Window(range(DepthConvention::Reversed)),
        DepthEncoding::Metres => StoredDepth::Distance {
            unit: match samples {
                DepthSamples::Normalized { .. } => args.metres_at_white,
                DepthSamples::Float => 1.0,
            },
        },
        DepthEncoding::Disparity => {
            let (offset, scale) = (args.disparity_offset as f64, args.disparity_scale as f64);
            ensure!(
                scale >= 0.0,
                "--disparity-scale {scale} is negative: larger values must be nearer; invert the depth image"
            );
            StoredDepth::Disparity { offset, scale }
        }
    };
    encoding.decode(stored.into_iter(), reach).map_err(|error| match error {
        StoredDepthError::Range { smallest, largest } => anyhow!(
            "{} has values outside of what its encoding allows ({smallest} to {largest}): check --depth-encoding and --depth-gamma",
            path.display()
        ),
        error => anyhow!("{}: {error}: check --depth-encoding and --depth-gamma", path.display()),
    })
}
