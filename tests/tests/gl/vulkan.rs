//! Checks that built-in scenes look the same on Vulkan and on OpenGL.

use image::RgbImage;
use yoro::eyes::{DepthRange, Eye, EyePair, Frustum};
use yoro::vulkan::ash::vk;
use yoro::vulkan::{Frame, Gather, ImageState, LayerImage, Options, SourceImages, TargetImages};
use yoro_bench::dataset::{GroupOptions, GroupRenderer, ImageGroup};
use yoro_context::Headless;
use yoro_render::{GpuScene, RenderSettings, Renderer};
use yoro_test_support::harness::{Gpu, Image, READ, Rendering, WRITTEN, flipped, with_gpu};
use yoro_tests::backends;

const SIZE: [u32; 2] = [256, 256];

#[test]
fn vulkan_equals_opengl_on_scenes() {
    let headless = Headless::open(backends()[0]).unwrap();
    let (gl, settings) = (headless.gl(), RenderSettings::default());
    let mut groups = GroupRenderer::new(gl, &GroupOptions::default()).unwrap();
    for name in ["talk", "stage"] {
        let scene = yoro_scenes::build(name, yoro_scenes::DEFAULT_SEED).unwrap();
        let head = scene.viewpoints[0].pose();
        let frustum = Frustum::symmetric(60f32.to_radians(), 1.0);
        let pair = EyePair::parallel(head, frustum, 0.063, DepthRange::PAPER, SIZE, Eye::Right);
        let scene = GpuScene::upload(gl, scene).unwrap();
        let mut renderer = Renderer::new(gl, &settings, &scene).unwrap();
        let group = groups.render(&mut renderer, &scene, &pair).unwrap();
        for rendering in [Rendering::RenderPasses, Rendering::Core] {
            with_gpu(rendering, |gpu| {
                let picture = synthesize(gpu, &group);
                let pairs = picture.pixels().zip(group.synthesized.pixels());
                let differs = |(a, b): &(&image::Rgb<u8>, &image::Rgb<u8>)| {
                    a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 1)
                };
                let different = pairs.filter(differs).count();
                // Values that are within rounding of a threshold may fall on either side of it.
                assert!(different <= 16, "{name}, {rendering:?}: {different} of 65536 pixels differ");
            });
        }
    }
}

/// Synthesizes a group on Vulkan that OpenGL has synthesized before.
fn synthesize(gpu: &Gpu, group: &ImageGroup) -> RgbImage {
    let warp = &group.views.warp;
    let (color_format, depth_format) = (vk::Format::R8G8B8A8_UNORM, vk::Format::D32_SFLOAT);
    let color = gpu.image(color_format, warp.source_size, 1);
    let depth = gpu.image(depth_format, warp.source_size, 1);
    let target = gpu.image(color_format, warp.target_size, 1);
    let rgba: Vec<u8> = group.color.pixels().flat_map(|pixel| [pixel[0], pixel[1], pixel[2], 255]).collect();
    let width = warp.source_size[0] as usize;
    color.upload_rgba8(0, &flipped(&rgba, width * 4), WRITTEN);
    let rows = group.depth.as_raw().chunks_exact(width).rev();
    depth.upload_depth(0, &rows.flatten().copied().collect::<Vec<f32>>(), WRITTEN);
    let image = |image: &Image, before, after| -> LayerImage { image.layer(0, before, after) };
    let options = Options {
        color_format,
        max_source_size: warp.source_size,
        max_target_size: warp.target_size,
        ..Options::default()
    };
    // SAFETY: the images live until everything is executed, and are in the declared states.
    unsafe {
        let mut gather = Gather::new(&gpu.host(), &options).unwrap();
        let source = gather
            .register_source(&SourceImages {
                color: image(&color, WRITTEN, ImageState::SAMPLED),
                depth: image(&depth, WRITTEN, ImageState::SAMPLED),
                size: warp.source_size,
            })
            .unwrap();
        let written = gather
            .register_target(&TargetImages {
                color: image(&target, ImageState::DISCARDED, READ),
                depth: None,
                size: warp.target_size,
            })
            .unwrap();
        let frame = Frame { source, source_origin: [0, 0], target: written, target_origin: [0, 0] };
        gpu.run(|commands| gather.record(commands, &frame, warp).unwrap());
    }
    let [w, h] = warp.target_size;
    let rgba = flipped(&target.read_rgba8(0, READ), w as usize * 4);
    RgbImage::from_fn(w, h, |x, y| {
        let i = ((y * w + x) * 4) as usize;
        image::Rgb([rgba[i], rgba[i + 1], rgba[i + 2]])
    })
}
