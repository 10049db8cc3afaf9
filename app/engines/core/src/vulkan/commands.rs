//! The command buffer that the passes are recorded into.

use std::ffi::CStr;

use ash::{ext, vk};
use bytemuck::NoUninit;

use super::Host;

/// The stages that read the uniforms.
pub(super) const UNIFORM_STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::VERTEX.as_raw() | vk::ShaderStageFlags::FRAGMENT.as_raw(),
);

/// The caller's command buffer, in the recording state.
#[derive(Clone, Copy)]
pub(super) struct Commands<'a> {
    pub(super) device: &'a ash::Device,
    pub(super) buffer: vk::CommandBuffer,
    labels: Option<&'a Labels>,
}

impl<'a> Commands<'a> {
    /// # Safety
    /// The buffer belongs to the device, records outside of render passes and goes to a queue with graphics. Every
    /// handle that is given to the methods belongs to the device and lives until the commands have been executed.
    pub(super) unsafe fn new(
        device: &'a ash::Device,
        buffer: vk::CommandBuffer,
        labels: Option<&'a Labels>,
    ) -> Commands<'a> {
        Commands { device, buffer, labels }
    }

    /// Records what `body` records, as a group that debuggers show.
    pub(super) fn group(&self, name: &CStr, body: impl FnOnce()) {
        let Some(Labels(functions)) = self.labels else { return body() };
        let label = vk::DebugUtilsLabelEXT::default().label_name(name);
        // SAFETY: `Commands::new` asks for a buffer that records, and each label that begins here ends here.
        unsafe { functions.cmd_begin_debug_utils_label(self.buffer, &label) };
        body();
        // SAFETY: as above.
        unsafe { functions.cmd_end_debug_utils_label(self.buffer) };
    }

    /// Binds the textures and uniforms for the following draws.
    pub(super) fn bind(
        &self,
        layout: vk::PipelineLayout,
        textures: vk::DescriptorSet,
        uniforms: &impl NoUninit,
    ) {
        let (point, stages) = (vk::PipelineBindPoint::GRAPHICS, UNIFORM_STAGES);
        // SAFETY: `Commands::new` asks for a recording buffer and live handles. The layout has one set, and as many
        // push constants as the uniforms have bytes.
        unsafe {
            self.device.cmd_bind_descriptor_sets(self.buffer, point, layout, 0, &[textures], &[]);
            self.device.cmd_push_constants(self.buffer, layout, stages, 0, bytemuck::bytes_of(uniforms));
        }
    }

    /// Draws a triangle that covers `area`. Must be called inside a render pass or dynamic rendering.
    /// `depth` is the range of depth that the viewport maps to.
    pub(super) fn draw(&self, pipeline: vk::Pipeline, area: vk::Rect2D, depth: [f32; 2]) {
        let viewport = vk::Viewport {
            x: area.offset.x as f32,
            y: area.offset.y as f32,
            width: area.extent.width as f32,
            height: area.extent.height as f32,
            min_depth: depth[0],
            max_depth: depth[1],
        };
        let (device, buffer) = (self.device, self.buffer);
        // SAFETY: `Commands::new` asks for a recording buffer and live handles.
        unsafe {
            device.cmd_set_viewport(buffer, 0, &[viewport]);
            device.cmd_set_scissor(buffer, 0, &[area]);
            device.cmd_bind_pipeline(buffer, vk::PipelineBindPoint::GRAPHICS, pipeline);
            device.cmd_draw(buffer, 3, 1, 0, 0);
        }
    }
}

/// The commands of VK_EXT_debug_utils that group other commands.
pub(super) struct Labels(ext::debug_utils::Device);

impl Labels {
    /// Returns the commands, or `None` if the extension is not enabled.
    ///
    /// # Safety
    /// The host's handles are valid.
    pub(super) unsafe fn new(host: &Host) -> Option<Labels> {
        let needed = [c"vkCmdBeginDebugUtilsLabelEXT", c"vkCmdEndDebugUtilsLabelEXT"];
        // SAFETY: the caller's handles are valid.
        let has = |name| unsafe { has_command(host, name) };
        let is_there = host.debug_utils && needed.into_iter().all(has);
        is_there.then(|| Labels(ext::debug_utils::Device::new(host.instance, host.device)))
    }
}

/// True if the device has a command. ash's functions panic if a command is missing.
///
/// # Safety
/// The host's handles are valid.
pub(super) unsafe fn has_command(host: &Host, name: &CStr) -> bool {
    // SAFETY: the caller's device is valid, and a `CStr` ends with 0.
    unsafe { host.instance.get_device_proc_addr(host.device.handle(), name.as_ptr()) }.is_some()
}
