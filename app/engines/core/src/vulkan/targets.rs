//! The render targets of the passes, with dynamic rendering or render passes.

use ash::{khr, vk};

use super::commands::{Commands, has_command};
use super::formats;
use super::objects::Objects;
use super::{Host, ImageState, Options, VulkanError};
use crate::synthesis::backend::{HoleMarks, WHOLE_DEPTH};
use crate::synthesis::{HoleMark, Holes};

/// The kinds of attachments that passes draw into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PassKind {
    /// Four 32-bit integers for each tile.
    Map,
    /// The caller's target.
    Target,
}

impl PassKind {
    /// Returns the format of the colour attachment.
    pub(super) fn format(self, options: &Options) -> vk::Format {
        match self {
            PassKind::Map => formats::MAP,
            PassKind::Target => options.color_format,
        }
    }

    /// Returns the format of the depth attachment.
    pub(super) fn depth_format(self, options: &Options) -> Option<vk::Format> {
        options.depth_format.filter(|_| self == PassKind::Target)
    }
}

/// How passes begin and end.
pub(super) enum Rendering {
    Dynamic { begin: vk::PFN_vkCmdBeginRendering, end: vk::PFN_vkCmdEndRendering },
    Passes(RenderPasses),
}

/// A render pass for each [`PassKind`].
pub(super) struct RenderPasses {
    map: vk::RenderPass,
    target: vk::RenderPass,
}

/// The views that a pass draws into, with a framebuffer of them for render passes.
#[derive(Clone, Copy)]
pub(super) struct Attachments {
    kind: PassKind,
    pub(super) color: vk::ImageView,
    depth: Option<vk::ImageView>,
    framebuffer: vk::Framebuffer,
}

/// Returns the values that the attachments are cleared to. That of colour is not used.
fn clear_values(marks: HoleMarks) -> [vk::ClearValue; 2] {
    let depth_stencil = vk::ClearDepthStencilValue { depth: marks.planes[1], stencil: 0 };
    [vk::ClearValue::default(), vk::ClearValue { depth_stencil }]
}

/// The result of a pass that later passes read.
pub(super) struct Intermediate {
    pub(super) image: vk::Image,
    pub(super) attachments: Attachments,
    /// Width and height in texels.
    pub(super) size: [u32; 2],
}

impl Rendering {
    /// # Safety
    /// The host's handles are valid and belong together.
    pub(super) unsafe fn new(
        host: &Host,
        objects: &mut Objects,
        options: &Options,
    ) -> Result<Rendering, VulkanError> {
        if host.dynamic_rendering {
            // SAFETY: the caller's handles are valid.
            return unsafe { Rendering::dynamic(host) };
        }
        let mut pass = |kind| render_pass(objects, kind, options);
        Ok(Rendering::Passes(RenderPasses { map: pass(PassKind::Map)?, target: pass(PassKind::Target)? }))
    }

    /// Loads the commands of VK_KHR_dynamic_rendering, or those of Vulkan 1.3.
    ///
    /// # Safety
    /// Those of [`Rendering::new`].
    unsafe fn dynamic(host: &Host) -> Result<Rendering, VulkanError> {
        // SAFETY: the caller's handles are valid.
        let has = |name| unsafe { has_command(host, name) };
        if has(c"vkCmdBeginRenderingKHR") && has(c"vkCmdEndRenderingKHR") {
            let extension = khr::dynamic_rendering::Device::new(host.instance, host.device);
            let (begin, end) = (extension.fp().cmd_begin_rendering_khr, extension.fp().cmd_end_rendering_khr);
            Ok(Rendering::Dynamic { begin, end })
        } else if has(c"vkCmdBeginRendering") && has(c"vkCmdEndRendering") {
            let core = host.device.fp_v1_3();
            Ok(Rendering::Dynamic { begin: core.cmd_begin_rendering, end: core.cmd_end_rendering })
        } else {
            Err(VulkanError::DynamicRendering)
        }
    }

    /// Returns the render pass of a kind; a null handle for dynamic rendering.
    pub(super) fn render_pass(&self, kind: PassKind) -> vk::RenderPass {
        let Rendering::Passes(passes) = self else { return vk::RenderPass::null() };
        match kind {
            PassKind::Map => passes.map,
            PassKind::Target => passes.target,
        }
    }

    /// Returns attachments of views, which must have the formats of the kind.
    pub(super) fn attachments(
        &self,
        objects: &mut Objects,
        kind: PassKind,
        color: vk::ImageView,
        depth: Option<vk::ImageView>,
        size: [u32; 2],
    ) -> Result<Attachments, VulkanError> {
        let framebuffer = match self {
            Rendering::Dynamic { .. } => vk::Framebuffer::null(),
            Rendering::Passes { .. } => {
                let views: Vec<_> = [color].into_iter().chain(depth).collect();
                objects.create_framebuffer(
                    &vk::FramebufferCreateInfo::default()
                        .render_pass(self.render_pass(kind))
                        .attachments(&views)
                        .width(size[0])
                        .height(size[1])
                        .layers(1),
                )?
            }
        };
        Ok(Attachments { kind, color, depth, framebuffer })
    }

    /// Draws over an area of the attachments, whose images must be in attachment layouts.
    pub(super) fn draw(
        &self,
        commands: &Commands,
        attachments: &Attachments,
        pipeline: vk::Pipeline,
        area: vk::Rect2D,
        marks: Option<HoleMarks>,
    ) {
        let depths = marks.map_or(WHOLE_DEPTH, HoleMarks::depths);
        let clear = marks.map(clear_values);
        // SAFETY: `Commands::new` asks for a buffer that records outside of render passes, and for live handles. What
        // begins here ends here. A pass that clears has clear values.
        unsafe {
            match *self {
                Rendering::Dynamic { begin, end } => {
                    attachments.begin_dynamic(begin, commands.buffer, area, marks);
                    commands.draw(pipeline, area, depths);
                    end(commands.buffer);
                }
                Rendering::Passes { .. } => {
                    let info = vk::RenderPassBeginInfo::default()
                        .render_pass(self.render_pass(attachments.kind))
                        .framebuffer(attachments.framebuffer)
                        .render_area(area)
                        .clear_values(clear.as_ref().map_or(&[], |values| &values[..]));
                    let contents = vk::SubpassContents::INLINE;
                    commands.device.cmd_begin_render_pass(commands.buffer, &info, contents);
                    commands.draw(pipeline, area, depths);
                    commands.device.cmd_end_render_pass(commands.buffer);
                }
            }
        }
    }
}

impl Attachments {
    /// # Safety
    /// The buffer records outside of render passes, and `begin` is a command of its device.
    unsafe fn begin_dynamic(
        &self,
        begin: vk::PFN_vkCmdBeginRendering,
        buffer: vk::CommandBuffer,
        area: vk::Rect2D,
        marks: Option<HoleMarks>,
    ) {
        let attachment = |view, state: ImageState| {
            vk::RenderingAttachmentInfo::default()
                .image_view(view)
                .image_layout(state.layout)
                .load_op(vk::AttachmentLoadOp::DONT_CARE)
                .store_op(vk::AttachmentStoreOp::STORE)
        };
        let colors = [attachment(self.color, ImageState::COLOR_ATTACHMENT)];
        let mut depth = attachment(self.depth.unwrap_or_default(), ImageState::DEPTH_ATTACHMENT);
        if let Some([_, clear]) = marks.map(clear_values) {
            depth = depth.load_op(vk::AttachmentLoadOp::CLEAR).clear_value(clear);
        }
        let info = vk::RenderingInfo::default()
            .render_area(area)
            .layer_count(1)
            .color_attachments(&colors)
            .depth_attachment(&depth);
        let stencils = marks.is_some_and(|marks| marks.mark == HoleMark::Stencil);
        let info = if stencils { info.stencil_attachment(&depth) } else { info };
        // SAFETY: the caller's buffer and command; the description names live views.
        unsafe { begin(buffer, &info) };
    }
}

/// Returns a render pass that changes no layouts and keeps the stencil contents, or clears depth, and stencil if it is a
/// mark.
fn render_pass(
    objects: &mut Objects,
    kind: PassKind,
    options: &Options,
) -> Result<vk::RenderPass, VulkanError> {
    let attachment = |format, state: ImageState| {
        vk::AttachmentDescription::default()
            .format(format)
            .samples(vk::SampleCountFlags::TYPE_1)
            .load_op(vk::AttachmentLoadOp::DONT_CARE)
            .store_op(vk::AttachmentStoreOp::STORE)
            .stencil_load_op(vk::AttachmentLoadOp::LOAD)
            .stencil_store_op(vk::AttachmentStoreOp::STORE)
            .initial_layout(state.layout)
            .final_layout(state.layout)
    };
    let color = attachment(kind.format(options), ImageState::COLOR_ATTACHMENT);
    let depth = kind.depth_format(options).map(|format| {
        let depth = attachment(format, ImageState::DEPTH_ATTACHMENT);
        let clear = vk::AttachmentLoadOp::CLEAR;
        match options.holes {
            Holes::Filled => depth,
            Holes::Open(HoleMark::Depth) => depth.load_op(clear),
            Holes::Open(HoleMark::Stencil) => depth.load_op(clear).stencil_load_op(clear),
        }
    });
    let attachments: Vec<_> = [color].into_iter().chain(depth).collect();
    let reference =
        |attachment, state: ImageState| vk::AttachmentReference { attachment, layout: state.layout };
    let color_references = [reference(0, ImageState::COLOR_ATTACHMENT)];
    let depth_reference = reference(1, ImageState::DEPTH_ATTACHMENT);
    let mut subpass = vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&color_references);
    if depth.is_some() {
        subpass = subpass.depth_stencil_attachment(&depth_reference);
    }
    let subpasses = [subpass];
    objects.create_render_pass(
        &vk::RenderPassCreateInfo::default().attachments(&attachments).subpasses(&subpasses),
    )
}

impl Intermediate {
    pub(super) fn new(
        objects: &mut Objects,
        rendering: &Rendering,
        memory: &vk::PhysicalDeviceMemoryProperties,
        size: [u32; 2],
    ) -> Result<Intermediate, VulkanError> {
        let image = objects.create_color_image(memory, formats::MAP, size)?;
        let view = objects.create_view(image, formats::MAP, vk::ImageAspectFlags::COLOR, 0)?;
        let attachments = rendering.attachments(objects, PassKind::Map, view, None, size)?;
        Ok(Intermediate { image, attachments, size })
    }
}
