//! Vulkan objects that are destroyed together.

use std::sync::Arc;

use ash::vk;

use super::VulkanError;

/// One of them.
#[derive(Clone, Copy)]
pub(super) enum Object {
    DescriptorPool(vk::DescriptorPool),
    DescriptorSetLayout(vk::DescriptorSetLayout),
    Framebuffer(vk::Framebuffer),
    Image(vk::Image),
    Memory(vk::DeviceMemory),
    Pipeline(vk::Pipeline),
    PipelineLayout(vk::PipelineLayout),
    QueryPool(vk::QueryPool),
    RenderPass(vk::RenderPass),
    Sampler(vk::Sampler),
    Shader(vk::ShaderModule),
    View(vk::ImageView),
}

/// Objects of one device, in the order in which they were made; dropped in reverse, also when the making fails halfway.
pub(super) struct Objects {
    device: Arc<ash::Device>,
    made: Vec<Object>,
}

impl Objects {
    pub(super) fn new(device: &Arc<ash::Device>) -> Objects {
        Objects { device: device.clone(), made: Vec::new() }
    }

    pub(super) fn device(&self) -> &ash::Device {
        &self.device
    }

    /// Owns what the Vulkan command `call` has returned.
    pub(super) fn keep<T: Copy>(
        &mut self,
        call: &'static str,
        result: Result<T, vk::Result>,
        object: impl FnOnce(T) -> Object,
    ) -> Result<T, VulkanError> {
        let handle = result.map_err(|result| VulkanError::new(call, result))?;
        self.made.push(object(handle));
        Ok(handle)
    }

    /// A view of level 0 of one layer.
    ///
    /// # Safety
    /// The image is live, is of this device and has the layer.
    pub(super) unsafe fn view(
        &mut self,
        image: vk::Image,
        format: vk::Format,
        aspects: vk::ImageAspectFlags,
        layer: u32,
    ) -> Result<vk::ImageView, VulkanError> {
        let info = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(format)
            .subresource_range(range(aspects, layer));
        // SAFETY: promised by the caller.
        let view = unsafe { self.device.create_image_view(&info, None) };
        self.keep("vkCreateImageView", view, Object::View)
    }

    /// A framebuffer of these views.
    ///
    /// # Safety
    /// The views are live and fit the render pass.
    pub(super) unsafe fn framebuffer(
        &mut self,
        render_pass: vk::RenderPass,
        views: &[vk::ImageView],
        size: [u32; 2],
    ) -> Result<vk::Framebuffer, VulkanError> {
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(render_pass)
            .attachments(views)
            .width(size[0])
            .height(size[1])
            .layers(1);
        // SAFETY: promised by the caller.
        let framebuffer = unsafe { self.device.create_framebuffer(&info, None) };
        self.keep("vkCreateFramebuffer", framebuffer, Object::Framebuffer)
    }
}

/// Level 0 of one layer.
pub(super) fn range(aspects: vk::ImageAspectFlags, layer: u32) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: aspects,
        base_mip_level: 0,
        level_count: 1,
        base_array_layer: layer,
        layer_count: 1,
    }
}

impl Drop for Objects {
    fn drop(&mut self) {
        let device = &self.device;
        for object in self.made.drain(..).rev() {
            // SAFETY: made from this device and destroyed once; nothing uses it any more, as whoever made it promises.
            unsafe {
                match object {
                    Object::DescriptorPool(pool) => device.destroy_descriptor_pool(pool, None),
                    Object::DescriptorSetLayout(layout) => device.destroy_descriptor_set_layout(layout, None),
                    Object::Framebuffer(framebuffer) => device.destroy_framebuffer(framebuffer, None),
                    Object::Image(image) => device.destroy_image(image, None),
                    Object::Memory(memory) => device.free_memory(memory, None),
                    Object::Pipeline(pipeline) => device.destroy_pipeline(pipeline, None),
                    Object::PipelineLayout(layout) => device.destroy_pipeline_layout(layout, None),
                    Object::QueryPool(pool) => device.destroy_query_pool(pool, None),
                    Object::RenderPass(render_pass) => device.destroy_render_pass(render_pass, None),
                    Object::Sampler(sampler) => device.destroy_sampler(sampler, None),
                    Object::Shader(shader) => device.destroy_shader_module(shader, None),
                    Object::View(view) => device.destroy_image_view(view, None),
                }
            }
        }
    }
}
