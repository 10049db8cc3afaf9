//! The composer on Vulkan: its f64 reference, under the validation layer.

use crate::allocations;
use crate::harness::{READ, Rendering, WRITTEN, with_gpu};
use yoro::vulkan::ash::vk;
use yoro::vulkan::{
    ComposedFrame, Composer, ImageState, InsetImage, LevelImage, LevelImages, TargetImages, VulkanError,
};
use yoro_test_support::composed::{LevelPicture, cases};
use yoro_test_support::table::cut;

#[test]
fn a_composed_eye_is_its_reference() {
    for rendering in [Rendering::RenderPasses, Rendering::Core] {
        with_gpu(rendering, |gpu| {
            let format = vk::Format::R8G8B8A8_UNORM;
            // SAFETY: the device outlives the composer, and all commands are executed before it is dropped.
            let mut composer =
                unsafe { Composer::new(&gpu.host(), format, vk::PipelineCache::null()).unwrap() };
            for case in cases() {
                let level = |picture: &LevelPicture| {
                    let image = gpu.image(format, picture.image_size, 1);
                    image.upload_rgba8(0, &picture.rgba, WRITTEN);
                    image
                };
                let (wide, inset) = (level(&case.wide), case.inset.as_ref().map(level));
                let depth = case.depth.as_ref().zip(case.inset.as_ref()).map(|(values, picture)| {
                    let image = gpu.image(vk::Format::D32_SFLOAT, picture.image_size, 1);
                    image.upload_depth(0, values, WRITTEN);
                    image
                });
                let size = case.levels.shown.size;
                let image_size = size.map(|n| n + 9);
                let target = gpu.image(format, image_size, 1);
                let registered = |image: &crate::Image, picture: &LevelPicture| LevelImage {
                    color: image.layer(0, WRITTEN, ImageState::SAMPLED),
                    size: picture.image_size,
                };
                let images = LevelImages {
                    wide: registered(&wide, &case.wide),
                    inset: inset.as_ref().zip(case.inset.as_ref()).map(|(image, picture)| InsetImage {
                        image: registered(image, picture),
                        depth: depth.as_ref().map(|depth| depth.layer(0, WRITTEN, ImageState::SAMPLED)),
                    }),
                };
                // SAFETY: the images live until all commands have been executed, and are in the given states.
                unsafe {
                    let levels = composer.register_levels(&images).unwrap();
                    let written = target.layer(0, ImageState::DISCARDED, READ);
                    let to = composer.register_target(&TargetImages::new(written, image_size)).unwrap();
                    let frame = ComposedFrame {
                        wide_origin: case.wide.origin_from_top(),
                        inset_origin: case.inset.as_ref().map_or([0, 0], LevelPicture::origin_from_top),
                        target_origin: [7, 2],
                        ..ComposedFrame::new(levels, to)
                    };
                    let composition = case.composition();
                    gpu.run(|commands| {
                        let before = allocations();
                        composer.record(commands, &frame, &composition).unwrap();
                        assert_eq!(allocations(), before, "recording allocates");
                    });
                    composer.release_levels(levels);
                    let released = gpu.run(|commands| composer.record(commands, &frame, &composition));
                    assert_eq!(released, Err(VulkanError::NotRegistered));
                    composer.release_target(to);
                }
                let all = target.read_rgba8(0, READ);
                let got = cut(&all, image_size, [7, 2], size, 4);
                case.check(&got, &format!("{rendering:?}"));
            }
        });
    }
}
