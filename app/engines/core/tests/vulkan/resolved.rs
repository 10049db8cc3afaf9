//! Depth that a render pass has resolved from samples is a source in the state in which the render pass leaves it.

use crate::against_opengl::{Gl, assert_equal, picture, warps};
use crate::harness::{Gpu, Image, READ, Rendering, WRITTEN, with_gpu};
use crate::{Setup, options};
use yoro::synthesis::backend::WarpKind as _;
use yoro::vulkan::ash::vk;
use yoro::vulkan::{Frame, Gather, ImageState, SourceImages, TargetImages};

const FORMAT: vk::Format = vk::Format::D32_SFLOAT;

#[test]
fn resolved_depth_is_taken() {
    let gl = Gl::open();
    with_gpu(Rendering::Core, |gpu| {
        let (warp, range) = warps()[0];
        if !gpu.resolves_depth(vk::ResolveModeFlags::MIN) {
            return println!("SKIPPED: this device does not resolve the nearest depth");
        }
        let mut picture = picture(&warp, range, 4);
        // A box before a wall.
        let [w, h] = warp.source_size;
        let in_box = |x: u32, y: u32| (w / 3..w / 2).contains(&x) && (h / 4..3 * h / 4).contains(&y);
        let [wall, front] = [6.0, 1.2].map(|metres| range.depth(metres));
        let depths = (0..w * h).map(|i| if in_box(i % w, i / w) { front } else { wall });
        picture.depth = depths.collect();
        // Rows run from the bottom, and the box is not in the middle.
        let top = h - 3 * h / 4;
        let rectangle = vk::Rect2D {
            offset: vk::Offset2D { x: (w / 3) as i32, y: top as i32 },
            extent: vk::Extent2D { width: w / 2 - w / 3, height: 3 * h / 4 - h / 4 },
        };
        let color = gpu.image(Setup::PLAIN.color, warp.source_size, 1);
        color.upload_rgba8(0, &picture.rgba, WRITTEN);
        let (samples, depth) = (gpu.multisampled(FORMAT, [w, h]), gpu.image(FORMAT, [w, h], 1));
        let target = gpu.image(Setup::PLAIN.target, warp.target_size, 1);
        // SAFETY: the images live until all commands have been executed, and are in the given states.
        unsafe {
            resolve(gpu, [&samples, &depth], wall, (front, rectangle));
            let mut gather = Gather::new(&gpu.host(), &options(&Setup::PLAIN, warp.sizes())).unwrap();
            let source = SourceImages::new(
                color.layer(0, WRITTEN, ImageState::SAMPLED),
                depth.layer(0, ImageState::RESOLVED_DEPTH, ImageState::SAMPLED),
                warp.source_size,
            );
            let into = TargetImages::new(target.layer(0, ImageState::DISCARDED, READ), warp.target_size);
            let source = gather.register_source(&source).unwrap();
            let frame = Frame::new(source, gather.register_target(&into).unwrap());
            gpu.run(|commands| gather.record(commands, &frame, &warp).unwrap());
        }
        assert_equal(&target.read_rgba8(0, READ), &gl.run(&picture).rgba, 4, "resolved depth");
    });
}

/// Clears a multisampled depth and a rectangle of it, and resolves the smallest depths.
///
/// # Safety
/// The images live until all commands have been executed.
unsafe fn resolve(gpu: &Gpu, images: [&Image; 2], all: f32, (part, rectangle): (f32, vk::Rect2D)) {
    let depth = |depth| vk::ClearDepthStencilValue { depth, stencil: 0 };
    // SAFETY: valid descriptions, and views that live until the commands have been executed.
    unsafe {
        let views = images.map(|image| {
            let range = vk::ImageSubresourceRange::default()
                .aspect_mask(vk::ImageAspectFlags::DEPTH)
                .level_count(1)
                .layer_count(1);
            let info = vk::ImageViewCreateInfo::default()
                .image(image.raw)
                .format(FORMAT)
                .view_type(vk::ImageViewType::TYPE_2D)
                .subresource_range(range);
            gpu.device.create_image_view(&info, None).unwrap()
        });
        let [width, height] = images[0].size;
        gpu.run(|commands| {
            images[0].barrier(commands, 0, ImageState::DISCARDED, ImageState::DEPTH_ATTACHMENT);
            images[1].barrier(commands, 0, ImageState::DISCARDED, ImageState::RESOLVED_DEPTH);
            let attachment = vk::RenderingAttachmentInfo::default()
                .image_view(views[0])
                .image_layout(ImageState::DEPTH_ATTACHMENT.layout)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::DONT_CARE)
                .clear_value(vk::ClearValue { depth_stencil: depth(all) })
                .resolve_mode(vk::ResolveModeFlags::MIN)
                .resolve_image_view(views[1])
                .resolve_image_layout(ImageState::RESOLVED_DEPTH.layout);
            let info = vk::RenderingInfo::default()
                .render_area(vk::Rect2D { extent: vk::Extent2D { width, height }, ..Default::default() })
                .layer_count(1)
                .depth_attachment(&attachment);
            gpu.device.cmd_begin_rendering(commands, &info);
            let clear = vk::ClearAttachment {
                aspect_mask: vk::ImageAspectFlags::DEPTH,
                clear_value: vk::ClearValue { depth_stencil: depth(part) },
                ..Default::default()
            };
            let rectangle = vk::ClearRect { rect: rectangle, base_array_layer: 0, layer_count: 1 };
            gpu.device.cmd_clear_attachments(commands, &[clear], &[rectangle]);
            gpu.device.cmd_end_rendering(commands);
        });
        views.into_iter().for_each(|view| gpu.device.destroy_image_view(view, None));
    }
}
