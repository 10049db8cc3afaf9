//! Checks that synthesis from anti-aliased sources gives the same pictures on Vulkan and on OpenGL.

use std::io::Cursor;
use std::path::Path;
use std::process::Command;

use yoro::eyes::{DepthConvention, Eye, GuardBand, Warp};
use yoro::synthesis::Edges;
use yoro::vulkan::ash::{self, vk};
use yoro::vulkan::{
    Frame, Gather, Host, ImageState, LayerImage, Options, SourceImages, TargetImages, VulkanError,
};
use yoro_context::Headless;
use yoro_test_support::harness::{Gpu, Image, READ, Rendering, WRITTEN, with_gpu};
use yoro_test_support::samples::{GIVEN, Samples, example, on_opengl};
use yoro_tests::backends;

const COLOR: vk::Format = vk::Format::R8G8B8A8_UNORM;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

const VERTICES: &str = "#version 450
void main() {
    gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
";
const FILL: &str = "#version 450
layout(binding = 0) uniform sampler2D colors;
layout(binding = 1) uniform sampler2D depths;
layout(location = 0) out vec4 color;
void main() {
    color = texelFetch(colors, ivec2(gl_FragCoord.xy), 0);
    gl_FragDepth = texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r;
}
";

fn compile(work: &Path, name: &str, text: &str) -> Vec<u32> {
    let (source, compiled) = (work.join(name), work.join(name).with_extension("spv"));
    std::fs::write(&source, text).unwrap();
    let output = Command::new("glslangValidator").arg("-V").arg("-o").arg(&compiled).arg(&source).output();
    let output = output.expect("glslangValidator is set up by `cargo xtask setup`");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    ash::util::read_spv(&mut Cursor::new(std::fs::read(compiled).unwrap())).unwrap()
}

/// The samples in Vulkan images: colour and depth of each sample separately, and all samples in multisample images.
struct Drawn<'a> {
    single: Vec<[Image<'a>; 2]>,
    multisample: [Image<'a>; 2],
    /// The depth of one sample per pixel, and how the render pass chose it.
    resolved: Option<(vk::ResolveModeFlags, Image<'a>)>,
}

impl<'a> Drawn<'a> {
    /// Draws each sample separately, by the sample mask, and resolves depth if requested.
    fn new(gpu: &'a Gpu, samples: &Samples, resolve: Option<vk::ResolveModeFlags>) -> Drawn<'a> {
        let size = samples.size;
        let single: Vec<_> = (0..4)
            .map(|k| {
                let (color, depth) = (gpu.image(COLOR, size, 1), gpu.image(vk::Format::R32_SFLOAT, size, 1));
                color.upload_rgba8(0, &samples.rgba[k], ImageState::SAMPLED);
                depth.upload_depth(0, &samples.depth[k], ImageState::SAMPLED);
                [color, depth]
            })
            .collect();
        let multisample = [gpu.multisampled(COLOR, size, 4), gpu.multisampled(DEPTH, size, 4)];
        let resolved = resolve.map(|mode| (mode, gpu.image(DEPTH, size, 1)));
        let drawn = Drawn { single, multisample, resolved };
        // SAFETY: valid descriptions, and objects that live until everything is executed.
        unsafe { drawn.draw(gpu, size) };
        drawn
    }

    unsafe fn draw(&self, gpu: &Gpu, [width, height]: [u32; 2]) {
        let work = tempfile::tempdir().unwrap();
        let device = &gpu.device;
        // SAFETY: the caller's promise.
        unsafe {
            let module = |name, text| {
                let words = compile(work.path(), name, text);
                device
                    .create_shader_module(&vk::ShaderModuleCreateInfo::default().code(&words), None)
                    .unwrap()
            };
            let modules = [module("fill.vert", VERTICES), module("fill.frag", FILL)];
            let sampler = device.create_sampler(&vk::SamplerCreateInfo::default(), None).unwrap();
            let ty = vk::DescriptorType::COMBINED_IMAGE_SAMPLER;
            let bindings = [0, 1].map(|binding| {
                let one = vk::DescriptorSetLayoutBinding::default().binding(binding).descriptor_count(1);
                one.descriptor_type(ty).stage_flags(vk::ShaderStageFlags::FRAGMENT)
            });
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            let set_layout = device.create_descriptor_set_layout(&info, None).unwrap();
            let sizes = [vk::DescriptorPoolSize { ty, descriptor_count: 8 }];
            let info = vk::DescriptorPoolCreateInfo::default().max_sets(4).pool_sizes(&sizes);
            let pool = device.create_descriptor_pool(&info, None).unwrap();
            let layouts = [set_layout; 4];
            let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
            let sets = device.allocate_descriptor_sets(&info).unwrap();
            let mut views = Vec::new();
            let mut view = |image: &Image, aspect| {
                let range =
                    vk::ImageSubresourceRange::default().aspect_mask(aspect).level_count(1).layer_count(1);
                let info = vk::ImageViewCreateInfo::default().image(image.raw).format(image.format);
                let info = info.view_type(vk::ImageViewType::TYPE_2D).subresource_range(range);
                views.push(device.create_image_view(&info, None).unwrap());
                views[views.len() - 1]
            };
            let color_aspect = vk::ImageAspectFlags::COLOR;
            for (set, images) in sets.iter().zip(&self.single) {
                for (binding, image) in images.iter().enumerate() {
                    let info = [vk::DescriptorImageInfo::default()
                        .sampler(sampler)
                        .image_view(view(image, color_aspect))
                        .image_layout(ImageState::SAMPLED.layout)];
                    let write = vk::WriteDescriptorSet::default().dst_set(*set).dst_binding(binding as u32);
                    device.update_descriptor_sets(&[write.descriptor_type(ty).image_info(&info)], &[]);
                }
            }
            let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts[..1]);
            let layout = device.create_pipeline_layout(&info, None).unwrap();
            let pipelines = [0, 1, 2, 3].map(|k| pipeline(device, modules, layout, 1 << k));
            let attachment = |view, layout| {
                vk::RenderingAttachmentInfo::default()
                    .image_view(view)
                    .image_layout(layout)
                    .load_op(vk::AttachmentLoadOp::DONT_CARE)
                    .store_op(vk::AttachmentStoreOp::STORE)
            };
            let [color, depth] = &self.multisample;
            let colors = [attachment(view(color, color_aspect), ImageState::COLOR_ATTACHMENT.layout)];
            let depth_view = view(depth, vk::ImageAspectFlags::DEPTH);
            let mut depths = attachment(depth_view, ImageState::DEPTH_ATTACHMENT.layout);
            if let Some((mode, image)) = &self.resolved {
                depths = depths
                    .resolve_mode(*mode)
                    .resolve_image_view(view(image, vk::ImageAspectFlags::DEPTH))
                    .resolve_image_layout(ImageState::RESOLVED_DEPTH.layout);
            }
            let area = vk::Rect2D { extent: vk::Extent2D { width, height }, ..Default::default() };
            gpu.run(|commands| {
                color.barrier(commands, 0, ImageState::DISCARDED, ImageState::COLOR_ATTACHMENT);
                depth.barrier(commands, 0, ImageState::DISCARDED, ImageState::DEPTH_ATTACHMENT);
                if let Some((_, image)) = &self.resolved {
                    image.barrier(commands, 0, ImageState::DISCARDED, ImageState::RESOLVED_DEPTH);
                }
                let info = vk::RenderingInfo::default().render_area(area).layer_count(1);
                let info = info.color_attachments(&colors).depth_attachment(&depths);
                device.cmd_begin_rendering(commands, &info);
                let (width, height) = (width as f32, height as f32);
                let viewport = vk::Viewport { width, height, max_depth: 1.0, ..Default::default() };
                device.cmd_set_viewport(commands, 0, &[viewport]);
                device.cmd_set_scissor(commands, 0, &[area]);
                for (pipeline, set) in pipelines.iter().zip(&sets) {
                    let point = vk::PipelineBindPoint::GRAPHICS;
                    device.cmd_bind_descriptor_sets(commands, point, layout, 0, &[*set], &[]);
                    device.cmd_bind_pipeline(commands, point, *pipeline);
                    device.cmd_draw(commands, 3, 1, 0, 0);
                }
                device.cmd_end_rendering(commands);
            });
            pipelines.into_iter().for_each(|pipeline| device.destroy_pipeline(pipeline, None));
            device.destroy_pipeline_layout(layout, None);
            views.into_iter().for_each(|view| device.destroy_image_view(view, None));
            device.destroy_descriptor_pool(pool, None);
            device.destroy_descriptor_set_layout(set_layout, None);
            device.destroy_sampler(sampler, None);
            modules.into_iter().for_each(|module| device.destroy_shader_module(module, None));
        }
    }
}

/// Makes a pipeline that draws into the samples of a mask.
unsafe fn pipeline(
    device: &ash::Device,
    modules: [vk::ShaderModule; 2],
    layout: vk::PipelineLayout,
    mask: u32,
) -> vk::Pipeline {
    let stages = [vk::ShaderStageFlags::VERTEX, vk::ShaderStageFlags::FRAGMENT];
    let stages = [0, 1].map(|i| {
        vk::PipelineShaderStageCreateInfo::default().stage(stages[i]).module(modules[i]).name(c"main")
    });
    let vertices = vk::PipelineVertexInputStateCreateInfo::default();
    let assembly =
        vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let rasterization = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
    let masks = [mask];
    let multisample = vk::PipelineMultisampleStateCreateInfo::default()
        .rasterization_samples(vk::SampleCountFlags::TYPE_4)
        .sample_mask(&masks);
    let depth = vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(true)
        .depth_write_enable(true)
        .depth_compare_op(vk::CompareOp::ALWAYS);
    let blend =
        [vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA)];
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blend);
    let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
    let formats = [COLOR];
    let mut attachments = vk::PipelineRenderingCreateInfo::default()
        .color_attachment_formats(&formats)
        .depth_attachment_format(DEPTH);
    let info = vk::GraphicsPipelineCreateInfo::default()
        .stages(&stages)
        .vertex_input_state(&vertices)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&rasterization)
        .multisample_state(&multisample)
        .depth_stencil_state(&depth)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout)
        .push_next(&mut attachments);
    // SAFETY: a valid description of live objects.
    unsafe { device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None).unwrap()[0] }
}

/// Synthesizes one of the cases [`GIVEN`], with images for sources and targets up to the size `largest`.
fn on_vulkan(
    gpu: &Gpu,
    host: &Host,
    samples: &Samples,
    (edges, colors): (Edges, bool),
    warp: &Warp,
    largest: [u32; 2],
) -> Vec<u8> {
    let drawn = Drawn::new(gpu, samples, None);
    let single = gpu.image(vk::Format::R32_SFLOAT, samples.size, 1);
    single.upload_depth(0, &samples.one_depth(edges, warp.convention), WRITTEN);
    let [sample_color, sample_depth] = &drawn.multisample;
    let depth = match edges {
        Edges::Multisample => {
            sample_depth.layer(0, ImageState::DEPTH_ATTACHMENT, ImageState::DEPTH_ATTACHMENT)
        }
        _ => single.layer(0, WRITTEN, ImageState::SAMPLED),
    };
    let drawn_color = sample_color.layer(0, ImageState::COLOR_ATTACHMENT, ImageState::COLOR_ATTACHMENT);
    synthesize(gpu, host, samples, edges, (depth, colors.then_some(drawn_color)), warp, largest)
}

/// Synthesizes from the mean colour of the samples and whatever else is given.
fn synthesize(
    gpu: &Gpu,
    host: &Host,
    samples: &Samples,
    edges: Edges,
    (depth, sample_color): (LayerImage, Option<LayerImage>),
    warp: &Warp,
    largest: [u32; 2],
) -> Vec<u8> {
    let resolved = gpu.image(COLOR, samples.size, 1);
    resolved.upload_rgba8(0, &samples.resolved(), WRITTEN);
    let target = gpu.image(COLOR, warp.target_size, 1);
    let options = Options {
        color_format: COLOR,
        max_source_size: largest,
        max_target_size: largest,
        edges,
        timed_frames: 1,
        ..Options::default()
    };
    // SAFETY: the images live until everything is executed, and are in the declared states.
    unsafe {
        let mut gather = Gather::new(host, &options).unwrap();
        let color = resolved.layer(0, WRITTEN, ImageState::SAMPLED);
        let images = SourceImages { color, depth, sample_color, size: samples.size, history: None };
        let source = gather.register_source(&images).unwrap();
        let images = TargetImages {
            color: target.layer(0, ImageState::DISCARDED, READ),
            depth: None,
            size: warp.target_size,
        };
        let written = gather.register_target(&images).unwrap();
        let frame =
            Frame { source, source_origin: [0, 0], target: written, target_origin: [0, 0], history: None };
        gpu.run(|commands| gather.record(commands, &frame, warp).unwrap());
        let times = gather.pass_times().unwrap().expect("one frame was recorded and is done");
        assert!(times.split.is_zero() == (edges == Edges::Hard) && !times.march.is_zero(), "{times:?}");
    }
    target.read_rgba8(0, READ)
}

#[test]
fn vulkan_equals_opengl_for_anti_aliased_sources() {
    let headless = Headless::open(backends()[0]).unwrap();
    for dynamic_rendering in [true, false] {
        with_gpu(Rendering::Core, |gpu| {
            let host = Host { dynamic_rendering, ..gpu.host() };
            for (i, given) in GIVEN.into_iter().enumerate() {
                for dominant in Eye::BOTH {
                    let convention = [DepthConvention::Standard, DepthConvention::Reversed][i % 2];
                    let (warp, samples) = example(dominant, convention, GuardBand::Pixels(21));
                    let (want, _) = on_opengl(headless.gl(), &samples, given, &warp);
                    // Images that just hold the source, and larger ones.
                    for largest in [warp.source_size, warp.source_size.map(|n| n + 40)] {
                        let got = on_vulkan(gpu, &host, &samples, given, &warp, largest);
                        let pixels = got.chunks_exact(4).zip(want.chunks_exact(4));
                        let differs =
                            |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 1);
                        let different = pixels.filter(differs).count();
                        assert!(
                            different * 1000 <= got.len() / 4,
                            "{dynamic_rendering}, {given:?}, {dominant:?}, {largest:?}: {different} of {} pixels differ",
                            got.len() / 4
                        );
                    }
                }
            }
        });
    }
}

/// Depth resolved by the host's render pass gives the same source as depth chosen from the samples by a separate pass.
/// Lavapipe only supports the first sample's depth, not MIN and MAX.
#[test]
fn depth_that_a_render_pass_resolved_gives_the_same_picture() {
    use vk::ResolveModeFlags as Mode;
    with_gpu(Rendering::Core, |gpu| {
        for (mode, edges, convention) in [
            (Mode::SAMPLE_ZERO, Edges::Sample, DepthConvention::Standard),
            (Mode::MIN, Edges::Hard, DepthConvention::Standard),
            (Mode::MAX, Edges::Hard, DepthConvention::Reversed),
        ] {
            if !gpu.resolves_depth(mode) {
                println!("LEFT OUT: {} does not resolve depth by {mode:?}", gpu.name());
                continue;
            }
            let (warp, samples) = example(Eye::Right, convention, GuardBand::Pixels(21));
            let drawn = Drawn::new(gpu, &samples, Some(mode));
            let (_, resolved) = drawn.resolved.as_ref().unwrap();
            let resolved = resolved.layer(0, ImageState::RESOLVED_DEPTH, ImageState::SAMPLED);
            let chosen = gpu.image(vk::Format::R32_SFLOAT, samples.size, 1);
            chosen.upload_depth(0, &samples.one_depth(edges, warp.convention), WRITTEN);
            let chosen = chosen.layer(0, WRITTEN, ImageState::SAMPLED);
            let [got, want] = [resolved, chosen].map(|depth| {
                synthesize(gpu, &gpu.host(), &samples, edges, (depth, None), &warp, warp.source_size)
            });
            assert!(got == want, "{mode:?}");
        }
    });
}

#[test]
fn samples_that_vulkan_does_not_have_are_refused() {
    with_gpu(Rendering::Core, |gpu| {
        for samples in [0, 1, 3, 8, 64] {
            let options = Options { edges: Edges::Multisample, samples, ..Options::default() };
            // SAFETY: the handles are valid, and nothing is created.
            let refused = unsafe { Gather::new(&gpu.host(), &options) }.err();
            assert_eq!(refused, Some(VulkanError::Samples(samples)));
        }
        let size = [8, 8];
        let color = gpu.image(COLOR, size, 1);
        let depth = gpu.image(vk::Format::R32_SFLOAT, size, 1);
        let sampled = |image: &Image| image.layer(0, ImageState::SAMPLED, ImageState::SAMPLED);
        // SAFETY: live images that are not used.
        unsafe {
            let options = Options { edges: Edges::Nearest, ..Options::default() };
            let mut gather = Gather::new(&gpu.host(), &options).unwrap();
            let images = SourceImages {
                color: sampled(&color),
                depth: sampled(&depth),
                sample_color: Some(sampled(&color)),
                size,
                history: None,
            };
            assert_eq!(gather.register_source(&images), Err(VulkanError::SampleColors));
        }
    });
}
