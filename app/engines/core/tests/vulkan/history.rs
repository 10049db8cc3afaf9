//! Disocclusions that are taken from a history: the same pictures as on OpenGL.

use crate::against_opengl::{Gl, RecalledScene, assert_equal, recalled_scenes};
use crate::harness::{Gpu, READ, Rendering, WRITTEN, with_gpu};
use crate::{Setup, allocations};
use yoro::synthesis::{Edges, PassSet};
use yoro::vulkan::ash::vk;
use yoro::vulkan::{
    Frame, Gather, HistoryImages, ImageState, Options, SourceImages, TargetImages, VulkanError,
};

#[test]
fn what_is_recalled_is_what_opengl_recalls() {
    let (gl, scenes) = (Gl::new(), recalled_scenes());
    let warps: Vec<_> = scenes.iter().map(|scene| scene.source.warp).collect();
    for (rendering, edges, number) in [
        (Rendering::RenderPasses, Edges::Hard, 0),
        (Rendering::Core, Edges::Hard, 1),
        (Rendering::RenderPasses, Edges::Nearest, 0),
    ] {
        with_gpu(rendering, |gpu| {
            let mut opengl = gl.recalling(edges, number);
            let options = Options { edges, history: true, ..Setup::PLAIN.options(&warps) };
            // SAFETY: the handles are valid, and all commands are executed before the pipeline is dropped.
            let mut gather =
                unsafe { Gather::with_passes(&gpu.host(), &options, PassSet::GATHER[number]).unwrap() };
            for scene in &scenes {
                let what = format!("{edges:?}, {:?}, {}", PassSet::GATHER[number], scene.what);
                let [with, without] = synthesize(gpu, &mut gather, scene);
                let [want, plain] = opengl.both(scene);
                let changed = want.chunks(4).zip(plain.chunks(4)).filter(|(a, b)| a != b).count();
                assert!(changed > 100, "{what}: {changed} pixels are recalled");
                assert_equal(&with, &want, 4, number, &what);
                assert_equal(&without, &plain, 4, number, &format!("{what}, nothing"));
            }
        });
    }
}

/// Returns the other eye with the scene's history, and that of a frame without, recorded one after the other.
fn synthesize(gpu: &Gpu, gather: &mut Gather, scene: &RecalledScene) -> [Vec<u8>; 2] {
    let warp = &scene.source.warp;
    let upload = |rgba: &[u8], depth: &[f32], depth_format, size| {
        let images = [vk::Format::R8G8B8A8_UNORM, depth_format].map(|format| gpu.image(format, size, 1));
        images[0].upload_rgba8(0, rgba, WRITTEN);
        images[1].upload_depth(0, depth, WRITTEN);
        images
    };
    let [color, depth] =
        upload(&scene.source.rgba, &scene.source.depth, vk::Format::R32_SFLOAT, warp.source_size);
    let former = upload(&scene.former.rgba, &scene.former.depth, vk::Format::D32_SFLOAT, scene.former_size);
    let targets = [0; 2].map(|_| gpu.image(vk::Format::R8G8B8A8_UNORM, warp.target_size, 1));
    let sampled = ImageState::SAMPLED;
    // SAFETY: the images live until all commands have been executed, and are in the given states.
    unsafe {
        let source = |before| {
            let [former_color, former_depth] = former.each_ref().map(|image| image.layer(0, before, sampled));
            let [color, depth] = [&color, &depth].map(|image| image.layer(0, before, sampled));
            let history = HistoryImages { color: former_color, depth: former_depth, size: scene.former_size };
            SourceImages { history: Some(history), ..SourceImages::new(color, depth, warp.source_size) }
        };
        let first = gather.register_source(&source(WRITTEN)).unwrap();
        let then = gather.register_source(&source(sampled)).unwrap();
        let none = SourceImages { history: None, ..source(sampled) };
        let none = gather.register_source(&none).unwrap();
        let ids = targets.each_ref().map(|target| {
            let color = target.layer(0, ImageState::DISCARDED, READ);
            gather.register_target(&TargetImages::new(color, warp.target_size)).unwrap()
        });
        let strips = Some(scene.strips_from_top());
        let frame = |source, target, history| Frame { history, ..Frame::new(source, target) };
        gpu.run(|commands| {
            let allocated = allocations();
            for frame in [frame(first, ids[0], strips), frame(then, ids[1], None), frame(none, ids[1], None)]
            {
                gather.record(commands, &frame, warp).unwrap();
            }
            assert_eq!(allocations(), allocated, "recording allocates");
        });
        let refused = Err(VulkanError::History);
        let with = frame(none, ids[0], strips);
        gpu.run(|commands| assert_eq!(gather.record(commands, &with, warp), refused));
        [first, then, none].into_iter().for_each(|id| gather.release_source(id));
        ids.into_iter().for_each(|id| gather.release_target(id));
    }
    targets.each_ref().map(|target| target.read_rgba8(0, READ))
}
