//! RGBD videos: `yoro render --video` writes them, `yoro synthesize VIDEO` makes stereo videos of them.

use std::path::Path;
use std::rc::Rc;

use anyhow::{Context as _, bail, ensure};
use image::imageops;

use crate::cli::args;
use crate::cli::eyes::EyeArgs;
use crate::cli::terminal::progress_bar;
use yoro::eyes::{Eye, GuardBand, Pose, SynthesisViews};
use yoro_files::interrupt;
use yoro_gl::Context;
use yoro_media::video::{FINEST_QUANTIZER, Format, Planes, Reader, Rgbd, fits};
use yoro_media::{depth_image, rgb_image, side_by_side};
use yoro_render::stereo::{Offline, PipelineOptions, StereoOptions};
use yoro_render::{PreparedScene, ViewReader};

/// How videos are encoded.
#[derive(clap::Args, Clone, Copy, Debug)]
pub struct EncodingArgs {
    /// Videos: H.264's quantizer, 12 (best) to 51
    #[arg(long, default_value_t = 20, value_name = "QP", value_parser = args::whole::<u8>(FINEST_QUANTIZER..=51))]
    pub quantizer: u8,
}

/// Refuses a file whose name does not say that it is a video.
pub fn check_name(path: &Path) -> anyhow::Result<()> {
    let extension = path.extension().unwrap_or_default();
    ensure!(
        extension.eq_ignore_ascii_case("mp4"),
        "{} is to be a video, which is written as MP4: end its name in .mp4",
        path.display()
    );
    Ok(())
}

/// Refuses eyes whose RGBD video would have more pixels than can be encoded.
pub fn check_size(eyes: &EyeArgs, guard_band: GuardBand) -> anyhow::Result<()> {
    let views = eyes.pair(Pose::IDENTITY).synthesis_views(guard_band)?;
    // A video has two pictures side by side, each with an even number of pixels a side.
    let [width, height] = views.source.size.map(|side| (side as usize).next_multiple_of(2));
    ensure!(
        fits([2 * width, height]),
        "the video would have {}x{height} pixels, more than can be encoded: give a smaller --size",
        2 * width
    );
    Ok(())
}

/// Renders the dominant eye at each of the poses `heads`, with its guard band, and writes an RGBD video.
pub fn render(
    gl: &Rc<Context>,
    file: &Path,
    prepared: PreparedScene,
    (heads, time): (&[Pose], f64),
    (eyes, stereo): (&EyeArgs, &StereoOptions),
    (frame_rate, encoding): (u32, EncodingArgs),
) -> anyhow::Result<()> {
    let PreparedScene { mut scene, mut renderer } = prepared;
    let seconds = |frame: usize| time + frame as f64 / f64::from(frame_rate);
    let mut reader = ViewReader::new(gl)?;
    // Everything is rendered twice: the 8 bits of depth cover the distances of all frames, which must be known first.
    let bar = progress_bar(2 * heads.len() as u64);
    bar.set_message("distances");
    let [mut nearest, mut farthest] = [f32::INFINITY, 0.0];
    let mut columns = [0, 0];
    for (i, &head) in heads.iter().enumerate() {
        interrupt::check()?;
        renderer.set_time(&mut scene, seconds(i))?;
        let SynthesisViews { source: view, dominant_crop: [left, _], .. } =
            eyes.pair(head).synthesis_views(stereo.guard_band)?;
        // The same for every frame.
        columns = [left, view.size[0] - eyes.size[0] - left];
        reader.color(&mut renderer, &scene, &view)?;
        let distances = reader.depth().into_iter().map(|depth| view.depth.distance(depth));
        for distance in distances.filter(|distance| distance.is_finite()) {
            [nearest, farthest] = [nearest.min(distance), farthest.max(distance)];
        }
        bar.inc(1);
    }
    if nearest >= farthest {
        bail!("every pixel of the video is equally far: choose another place or scene");
    }
    let options = eyes.options();
    let [guard_columns, outer_columns] = match options.dominant {
        Eye::Left => [columns[1], columns[0]],
        Eye::Right => columns,
    };
    let rgbd = Rgbd {
        size: options.size,
        eye: options.dominant,
        guard_columns,
        outer_columns,
        fov_y: options.fov_y,
        outer_inner: options.outer_inner,
        mirrored: true,
        ipd: options.ipd,
        nearest,
        farthest,
    };
    let format = Format {
        frame_rate,
        quantizer: encoding.quantizer,
        durations: None,
        frames: heads.len(),
        rgbd: Some(rgbd),
    };
    bar.set_message("video");
    let mut rest = heads.iter().enumerate();
    let bytes = yoro_media::video::write(file, &format, || -> anyhow::Result<Option<Planes>> {
        interrupt::check()?;
        let Some((i, &head)) = rest.next() else { return Ok(None) };
        renderer.set_time(&mut scene, seconds(i))?;
        let view = eyes.pair(head).synthesis_views(stereo.guard_band)?.source;
        let color = reader.color(&mut renderer, &scene, &view)?;
        let depth = depth_image(&reader.depth(), view.size);
        bar.inc(1);
        let distance = |x, y| view.depth.distance(depth.get_pixel(x, y).0[0]);
        Ok(Some(rgbd.pack(&rgb_image(&color, view.size), distance)))
    })?;
    bar.finish_and_clear();
    println!(
        "{}: {} frames, {:.0} kbit/s, depth from {nearest:.2} to {farthest:.2} m",
        file.display(),
        heads.len(),
        bytes as f64 * 8e-3 * f64::from(frame_rate) / heads.len().max(1) as f64
    );
    Ok(())
}

/// Synthesizes the other eye of each picture of an RGBD video, and writes both eyes side by side.
pub fn synthesize(
    gl: &Rc<Context>,
    video: &Path,
    out: &Path,
    options: &PipelineOptions,
    encoding: EncodingArgs,
) -> anyhow::Result<()> {
    let mut reader = Reader::open(video)?;
    let rgbd = reader.rgbd()?;
    let views = rgbd.views().with_context(|| format!("cannot synthesize {}", video.display()))?;
    let mut offline = Offline::new(gl, options)?;
    let (frames, frame_rate, durations) = (reader.frames(), reader.frame_rate(), reader.durations());
    let [width, height] = rgbd.size.map(|side| side as usize);
    ensure!(
        fits([2 * width, height]),
        "{} has eyes of {width}x{height} pixels, and two side by side are more than can be encoded: render a smaller video",
        video.display()
    );
    let seconds = durations.as_ref().map_or(frames as f64 / f64::from(frame_rate), |all| all.iter().sum());
    let format = Format { frame_rate, quantizer: encoding.quantizer, durations, frames, rgbd: None };
    let bar = progress_bar(frames as u64);
    let bytes = yoro_media::video::write(out, &format, || -> anyhow::Result<Option<Planes>> {
        interrupt::check()?;
        let Some((color, depth)) = reader.read_rgbd()? else { return Ok(None) };
        let rgba: Vec<u8> = color.rows().rev().flatten().flat_map(|p| [p[0], p[1], p[2], 255]).collect();
        let depth: Vec<f32> = depth.rows().rev().flatten().map(|p| f32::from(p[0]) / 255.0).collect();
        let result = offline.run(&rgba, &depth, &views.warp)?;
        let synthesized = rgb_image(&result.rgba, views.target.size);
        let [width, height] = rgbd.size;
        let rendered = imageops::crop_imm(&color, views.dominant_crop[0], 0, width, height).to_image();
        let both = match rgbd.eye {
            Eye::Left => side_by_side(&rendered, &synthesized)?,
            Eye::Right => side_by_side(&synthesized, &rendered)?,
        };
        bar.inc(1);
        Ok(Some(Planes::of_rgb(&both)))
    })?;
    bar.finish_and_clear();
    println!("{}: {frames} frames, {:.0} kbit/s", out.display(), bytes as f64 * 8e-3 / seconds.max(1e-3));
    Ok(())
}
