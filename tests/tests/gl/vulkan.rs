//! Checks that built-in scenes look the same on Vulkan and on OpenGL.

use yoro::eyes::{DepthRange, Eye, EyePair, Frustum, MEAN_IPD};
use yoro::vulkan::ash::vk;
use yoro::vulkan::{Frame, Gather, ImageState, LayerImage, Options, SourceImages, TargetImages};
use yoro_bench::dataset::{GroupOptions, GroupRenderer, ImageGroup};
use yoro_render::{GpuScene, RenderSettings, Renderer};
use yoro_test_support::against_opengl::{Gl, Picture, flipped};
use yoro_test_support::harness::{Gpu, Image, READ, Rendering, WRITTEN, with_gpu};

const SIZE: [u32; 2] = [256, 256];

#[test]
fn vulkan_equals_opengl_on_scenes() {
    let opengl = Gl::open();
    let (gl, settings) = (opengl.headless.gl(), RenderSettings::default());
    let mut groups = GroupRenderer::new(gl, &GroupOptions::default()).unwrap();
    for name in ["talk", "stage"] {
        let scene = yoro_scenes::build(name, yoro_scenes::DEFAULT_SEED).unwrap();
        let head = scene.viewpoints[0].pose();
        let frustum = Frustum::symmetric(60f32.to_radians(), 1.0);
        let pair = EyePair::parallel(head, frustum, MEAN_IPD, DepthRange::PAPER, SIZE, Eye::Right);
        let scene = GpuScene::upload(gl, scene).unwrap();
        let mut renderer = Renderer::new(gl, &settings, &scene).unwrap();
        let group = groups.render(&mut renderer, &scene, &pair).unwrap();
        let picture = picture(&group);
        let expected = opengl.run(&picture).rgba;
        for rendering in [Rendering::RenderPasses, Rendering::Core] {
            with_gpu(rendering, |gpu| {
                let pairs = synthesize(gpu, &picture).into_iter().zip(&expected).collect::<Vec<_>>();
                let differs = |pixel: &&[(u8, &u8)]| pixel[..3].iter().any(|(a, b)| a.abs_diff(**b) > 1);
                let different = pairs.chunks_exact(4).filter(differs).count();
                // Values that are within rounding of a threshold may fall on either side of it.
                assert!(different <= 16, "{name}, {rendering:?}: {different} of 65536 pixels differ");
            });
        }
    }
}

/// Returns a group's rendered eye, with rows from the bottom.
fn picture(group: &ImageGroup) -> Picture {
    let warp = group.views.warp;
    let rgba: Vec<u8> = group.color.pixels().flat_map(|pixel| [pixel[0], pixel[1], pixel[2], 255]).collect();
    let rows = warp.source_size[1];
    Picture { warp, rgba: flipped(&rgba, rows), depth: flipped(group.depth.as_raw(), rows) }
}

/// Synthesizes a picture on Vulkan. Returns RGBA with rows from the bottom.
fn synthesize(gpu: &Gpu, picture: &Picture) -> Vec<u8> {
    let warp = &picture.warp;
    let (color_format, depth_format) = (vk::Format::R8G8B8A8_UNORM, vk::Format::D32_SFLOAT);
    let color = gpu.image(color_format, warp.source_size, 1);
    let depth = gpu.image(depth_format, warp.source_size, 1);
    let target = gpu.image(color_format, warp.target_size, 1);
    color.upload_rgba8(0, &picture.rgba, WRITTEN);
    depth.upload_depth(0, &picture.depth, WRITTEN);
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
    target.read_rgba8(0, READ)
}
