//! Measures synthesis from four samples per pixel against the known true image. The samples are taken from views
//! rendered with four times the width and height.

use std::rc::Rc;

use image::{Rgb, RgbImage, imageops};
use yoro::eyes::{EyeOptions, GuardBand, Pose, Warp};
use yoro::synthesis::{self, Edges, Layers, Outputs, Source, Synthesis, SynthesisOptions};
use yoro_assets::CameraPath;
use yoro_bench::dataset::{GroupOptions, GroupRenderer, ImageGroup};
use yoro_bench::metrics::{Channels, Quality};
use yoro_context::Headless;
use yoro_gl::{Context, Destination, Filter, Format, RenderTarget, Texture};
use yoro_render::{GpuScene, RenderSettings, Renderer};
use yoro_test_support::samples::{Multisampled, STANDARD, Samples};
use yoro_tests::backends;

use super::layers::{forward, march, multisample_layers, spans};

const SIZE: u32 = 1024;
/// Samples of the standard pattern are at centres of a 4x4 grid.
const GRID: u32 = 4;
/// Width in pixels of a border at either side that only one eye sees, which is not measured.
const BORDER: u32 = 64;
const SCENES: [&str; 6] = ["atrium", "scifi-city", "stage", "street", "talk", "voxel"];

/// Renders both eyes at four times the size, at the start of the scene's camera path.
fn large(gl: &Rc<Context>, name: &str) -> anyhow::Result<ImageGroup> {
    let scene = yoro_scenes::build(name, yoro_scenes::DEFAULT_SEED)?;
    let head = CameraPath::new(&scene.viewpoints).pose(0.0);
    let settings = RenderSettings::default();
    let scene = GpuScene::upload(gl, scene)?;
    let mut renderer = Renderer::new(gl, &settings, &scene)?;
    let mut groups = GroupRenderer::new(gl, &GroupOptions::default())?;
    let eyes = EyeOptions { size: [GRID * SIZE; 2], ..EyeOptions::default() };
    Ok(groups.render(&mut renderer, &scene, &eyes.pair(head))?)
}

/// Returns the column and row, in the large picture, of sample `k` of pixel (x, y). Rows run from top to bottom.
fn place(x: u32, y: u32, k: usize) -> (u32, u32) {
    let [u, v] = STANDARD[k].map(|at| (at * f64::from(GRID)) as u32);
    (GRID * x + u, GRID * y + v)
}

/// Returns the dominant eye's samples. Rows run from bottom to top.
fn samples(group: &ImageGroup) -> Samples {
    let pixels = || (0..SIZE).rev().flat_map(|y| (0..SIZE).map(move |x| (x, y)));
    Samples {
        size: [SIZE; 2],
        rgba: std::array::from_fn(|k| {
            let color = |(x, y)| {
                let (x, y) = place(x, y, k);
                let [r, g, b] = group.color.get_pixel(x, y).0;
                [r, g, b, 255]
            };
            pixels().flat_map(color).collect()
        }),
        depth: std::array::from_fn(|k| {
            let depth = |(x, y)| {
                let (x, y) = place(x, y, k);
                group.depth.get_pixel(x, y).0[0]
            };
            pixels().map(depth).collect()
        }),
    }
}

/// Returns the mean of each pixel's four samples.
fn resolved(large: &RgbImage) -> RgbImage {
    RgbImage::from_fn(SIZE, SIZE, |x, y| {
        let all = [0, 1, 2, 3].map(|k| {
            let (x, y) = place(x, y, k);
            large.get_pixel(x, y).0
        });
        Rgb(std::array::from_fn(|c| ((all.iter().map(|p| u32::from(p[c])).sum::<u32>() + 2) / 4) as u8))
    })
}

fn synthesized(
    gl: &Rc<Context>,
    mut pipeline: Box<dyn Synthesis>,
    source: Source,
    warp: &Warp,
) -> anyhow::Result<RgbImage> {
    let target = RenderTarget::new(gl, warp.target_size, &[(Format::Rgba8, Filter::Nearest)], None)?;
    pipeline.synthesize(source, warp, &Destination::whole(&target))?;
    let rgba = target.read_rgba8(0, [0, 0], warp.target_size);
    Ok(yoro_bench::picture::rgb_image(&rgba, warp.target_size))
}

fn quality(image: &RgbImage, truth: &RgbImage) -> anyhow::Result<[f64; 2]> {
    let inside = |image: &RgbImage| imageops::crop_imm(image, BORDER, 0, SIZE - 2 * BORDER, SIZE).to_image();
    let quality = Quality::of(&inside(image), &inside(truth), Channels::Rgb)?;
    Ok([quality.psnr.0, quality.ssim_gaussian])
}

/// Returns means per pixel: the fraction with two surfaces, and the fetched texels of layers and of colour.
fn counted(samples: &Samples, warp: &Warp) -> [f64; 3] {
    let (pixels, range) = forward(samples, warp);
    let layers = multisample_layers(&pixels, true);
    let [w, h] = warp.target_size.map(i64::from);
    let spans = spans(&layers, w as usize, range);
    let mut sums = [0.0; 3];
    for (x, y) in (0..h).flat_map(|y| (0..w).map(move |x| (x, y))) {
        let fetches = march(&layers, x as f64, y, spans.at(x / 16, y / 8)).2;
        sums[0] += f64::from(u8::from(layers.at(x, y).is_split()));
        sums[1] += f64::from(fetches.layers);
        sums[2] += f64::from(fetches.colors);
    }
    sums.map(|sum| sum / (w * h) as f64)
}

/// Returns PSNR and SSIM of each way to pass the samples.
fn measure(gl: &Rc<Context>, name: &str) -> anyhow::Result<Vec<(&'static str, [f64; 2])>> {
    let group = large(gl, name)?;
    let eyes = EyeOptions { size: [SIZE; 2], ..EyeOptions::default() };
    let warp = eyes.pair(Pose::IDENTITY).synthesis_views(GuardBand::None)?.warp;
    let samples = samples(&group);
    let truth = resolved(&group.truth);
    let [split, layers, colors] = counted(&samples, &warp);
    println!(
        "{name:12} {:.1} % of the pixels are split; the march fetches {layers:.2} layers and {colors:.2} colours a pixel",
        100.0 * split
    );
    let multisampled = Multisampled::new(gl, &samples)?;
    let single = |depth: &[f32]| -> anyhow::Result<Texture> {
        let texture = Texture::new(gl, [SIZE; 2], Format::R32F, Filter::Nearest)?;
        texture.upload(bytemuck::cast_slice(depth));
        Ok(texture)
    };
    let nearest = single(&samples.chosen_depth(|a, b| a < b))?;
    let first = single(&samples.depth[0])?;
    let color = multisampled.resolved().raw();
    let layers = |edges| -> anyhow::Result<Box<dyn Synthesis>> {
        Ok(Box::new(Layers::new(gl, Outputs::default(), edges)?))
    };
    let hard = synthesis::create(gl, &SynthesisOptions::default(), Outputs::default())?;
    let mut rows = vec![("same image to both eyes", quality(&resolved(&group.color), &truth)?)];
    for (label, pipeline, source) in [
        ("hard, nearest depth", hard, Source::new(color, nearest.raw())),
        ("sample", layers(Edges::Sample)?, Source::new(color, first.raw())),
        ("nearest", layers(Edges::Nearest)?, Source::new(color, nearest.raw())),
        ("multisample depth", layers(Edges::Multisample)?, multisampled.source(false)),
        ("multisample depth and colour", layers(Edges::Multisample)?, multisampled.source(true)),
    ] {
        let image = synthesized(gl, pipeline, source, &warp)?;
        if let Some(folder) = std::env::var_os("YORO_TEST_PICTURES") {
            let file = format!("{name} {label}.png").replace(' ', "-");
            image.save(std::path::Path::new(&folder).join(file))?;
        }
        rows.push((label, quality(&image, &truth)?));
    }
    Ok(rows)
}

/// The results are in docs/RESULTS.md.
#[test]
#[ignore = "measures: cargo test -p yoro-tests --test gl -- --ignored --nocapture supersampled"]
fn quality_from_known_samples() {
    let headless = Headless::open(backends()[0]).unwrap();
    let mut means: Vec<(&str, [f64; 2])> = Vec::new();
    for name in SCENES {
        let rows = measure(headless.gl(), name).unwrap();
        for (i, (label, [db, ssim])) in rows.into_iter().enumerate() {
            println!("{name:12} {label:30} {db:6.2} dB  {ssim:.4}");
            if means.len() == i {
                means.push((label, [0.0; 2]));
            }
            means[i].1 =
                [means[i].1[0] + db / SCENES.len() as f64, means[i].1[1] + ssim / SCENES.len() as f64];
        }
    }
    for (label, [db, ssim]) in &means {
        println!("{:12} {label:30} {db:6.2} dB  {ssim:.4}", "mean");
    }
    let [_, hard, sample, nearest, depth, both] = means[..] else { panic!("one mean for each way") };
    let rising = [hard, nearest, depth, both].windows(2).all(|pair| pair[0].1[0] < pair[1].1[0]);
    assert!(rising && sample.1[0] < nearest.1[0], "what the synthesis is told makes it no better: {means:?}");
}
