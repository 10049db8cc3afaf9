//! Vulkan objects that are destroyed together.

use std::io::Cursor;
use std::sync::Arc;

use ash::vk;

use super::VulkanError;
use super::formats::range;

/// Objects of one device in the order of their creation. They are destroyed in reverse order, even if a later creation
/// fails.
pub(super) struct Objects {
    device: Arc<ash::Device>,
    made: Vec<Object>,
}

macro_rules! objects {
    ($($(#[doc = $doc:literal])* $create:ident($info:ty) -> $object:ident($handle:ty), $call:literal, $destroy:ident;)*) => {
        /// An object that [`Objects`] owns.
        #[derive(Clone, Copy)]
        enum Object {
            $($object($handle),)*
            Pipeline(vk::Pipeline),
        }

        impl Object {
            fn destroy(self, device: &ash::Device) {
                // SAFETY: the object was made from this device and is destroyed once. `Objects::new` asks that no
                // pending command uses it.
                unsafe {
                    match self {
                        $(Object::$object(handle) => device.$destroy(handle, None),)*
                        Object::Pipeline(pipeline) => device.destroy_pipeline(pipeline, None),
                    }
                }
            }
        }

        impl Objects {
            $($(#[doc = $doc])*
            pub(super) fn $create(&mut self, info: &$info) -> Result<$handle, VulkanError> {
                // SAFETY: `Objects::new` asks for valid descriptions that name live objects of this device.
                let made = unsafe { self.device.$create(info, None) };
                self.keep($call, made, Object::$object)
            })*
        }
    };
}

objects! {
    create_descriptor_pool(vk::DescriptorPoolCreateInfo<'_>) -> DescriptorPool(vk::DescriptorPool),
        "vkCreateDescriptorPool", destroy_descriptor_pool;
    create_descriptor_set_layout(vk::DescriptorSetLayoutCreateInfo<'_>) -> DescriptorSetLayout(vk::DescriptorSetLayout),
        "vkCreateDescriptorSetLayout", destroy_descriptor_set_layout;
    create_framebuffer(vk::FramebufferCreateInfo<'_>) -> Framebuffer(vk::Framebuffer),
        "vkCreateFramebuffer", destroy_framebuffer;
    create_image(vk::ImageCreateInfo<'_>) -> Image(vk::Image), "vkCreateImage", destroy_image;
    create_image_view(vk::ImageViewCreateInfo<'_>) -> View(vk::ImageView), "vkCreateImageView", destroy_image_view;
    allocate_memory(vk::MemoryAllocateInfo<'_>) -> Memory(vk::DeviceMemory), "vkAllocateMemory", free_memory;
    create_pipeline_layout(vk::PipelineLayoutCreateInfo<'_>) -> PipelineLayout(vk::PipelineLayout),
        "vkCreatePipelineLayout", destroy_pipeline_layout;
    create_query_pool(vk::QueryPoolCreateInfo<'_>) -> QueryPool(vk::QueryPool),
        "vkCreateQueryPool", destroy_query_pool;
    create_render_pass(vk::RenderPassCreateInfo<'_>) -> RenderPass(vk::RenderPass),
        "vkCreateRenderPass", destroy_render_pass;
    create_sampler(vk::SamplerCreateInfo<'_>) -> Sampler(vk::Sampler), "vkCreateSampler", destroy_sampler;
    create_shader_module(vk::ShaderModuleCreateInfo<'_>) -> Shader(vk::ShaderModule),
        "vkCreateShaderModule", destroy_shader_module;
}

impl Objects {
    /// Returns an empty list.
    ///
    /// # Safety
    /// Every description that is handed to its methods is valid and names only live objects of `device`. The device
    /// outlives the list, and no pending command uses an object of the list when it is dropped.
    pub(super) unsafe fn new(device: &Arc<ash::Device>) -> Objects {
        Objects { device: device.clone(), made: Vec::new() }
    }

    pub(super) fn device(&self) -> &Arc<ash::Device> {
        &self.device
    }

    /// Takes ownership of the result of the Vulkan command `call`.
    fn keep<T: Copy>(
        &mut self,
        call: &'static str,
        result: Result<T, vk::Result>,
        object: impl FnOnce(T) -> Object,
    ) -> Result<T, VulkanError> {
        let handle = result.map_err(|result| VulkanError::new(call, result))?;
        self.made.push(object(handle));
        Ok(handle)
    }

    pub(super) fn create_graphics_pipeline(
        &mut self,
        cache: vk::PipelineCache,
        info: vk::GraphicsPipelineCreateInfo,
    ) -> Result<vk::Pipeline, VulkanError> {
        // SAFETY: `Objects::new` asks for valid descriptions that name live objects of this device.
        let made = unsafe { self.device.create_graphics_pipelines(cache, &[info], None) };
        // One description creates one pipeline.
        let made = made.map(|pipelines| pipelines[0]).map_err(|(_, result)| result);
        self.keep("vkCreateGraphicsPipelines", made, Object::Pipeline)
    }

    /// Returns a module of SPIR-V code that needs no capability other than Shader.
    pub(super) fn create_shader(&mut self, spirv: &[u8]) -> Result<vk::ShaderModule, VulkanError> {
        let words = ash::util::read_spv(&mut Cursor::new(spirv))
            .map_err(|_| VulkanError::new("vkCreateShaderModule", vk::Result::ERROR_INVALID_SHADER_NV))?;
        self.create_shader_module(&vk::ShaderModuleCreateInfo::default().code(&words))
    }

    /// Returns a view of mip level 0 of one layer of an image.
    pub(super) fn create_view(
        &mut self,
        image: vk::Image,
        format: vk::Format,
        aspects: vk::ImageAspectFlags,
        layer: u32,
    ) -> Result<vk::ImageView, VulkanError> {
        self.create_image_view(
            &vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(format)
                .subresource_range(range(aspects, layer)),
        )
    }

    /// Returns a colour image with its own memory, to be rendered to and sampled.
    pub(super) fn create_color_image(
        &mut self,
        memory: &vk::PhysicalDeviceMemoryProperties,
        format: vk::Format,
        size: [u32; 2],
    ) -> Result<vk::Image, VulkanError> {
        let image = self.create_image(
            &vk::ImageCreateInfo::default()
                .image_type(vk::ImageType::TYPE_2D)
                .format(format)
                .extent(vk::Extent3D { width: size[0], height: size[1], depth: 1 })
                .mip_levels(1)
                .array_layers(1)
                .samples(vk::SampleCountFlags::TYPE_1)
                .usage(vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::SAMPLED),
        )?;
        // SAFETY: the image was just made from this device.
        let needed = unsafe { self.device.get_image_memory_requirements(image) };
        let memory = self.allocate(memory, &needed)?;
        // SAFETY: the memory is new, and was allocated with the image's size and type.
        unsafe { self.device.bind_image_memory(image, memory, 0) }
            .map_err(|result| VulkanError::new("vkBindImageMemory", result))?;
        Ok(image)
    }

    /// Allocates memory, on the device if a suitable type exists.
    fn allocate(
        &mut self,
        memory: &vk::PhysicalDeviceMemoryProperties,
        needed: &vk::MemoryRequirements,
    ) -> Result<vk::DeviceMemory, VulkanError> {
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(needed.size)
            .memory_type_index(memory_type(memory, needed.memory_type_bits));
        self.allocate_memory(&info)
    }

    /// Returns a descriptor set from a new pool for one set.
    pub(super) fn allocate_descriptor_set(
        &mut self,
        layout: vk::DescriptorSetLayout,
        sizes: &[vk::DescriptorPoolSize],
    ) -> Result<vk::DescriptorSet, VulkanError> {
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(sizes);
        let pool = self.create_descriptor_pool(&info)?;
        let layouts = [layout];
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
        let mut set = vk::DescriptorSet::null();
        // SAFETY: the new pool has room for the one set, which is written to `set`.
        let result = unsafe {
            (self.device.fp_v1_0().allocate_descriptor_sets)(self.device.handle(), &info, &mut set)
        };
        result.result().map_err(|result| VulkanError::new("vkAllocateDescriptorSets", result))?;
        Ok(set)
    }
}

/// Returns the first allowed memory type that is on the device, or else the first allowed one.
fn memory_type(memory: &vk::PhysicalDeviceMemoryProperties, allowed: u32) -> u32 {
    let local = |i: u32| {
        memory.memory_types[i as usize].property_flags.contains(vk::MemoryPropertyFlags::DEVICE_LOCAL)
    };
    let allowed = || (0..memory.memory_type_count).filter(|i| allowed >> i & 1 != 0);
    allowed().find(|&i| local(i)).or_else(|| allowed().next()).unwrap_or_default()
}

impl Drop for Objects {
    fn drop(&mut self) {
        for object in self.made.drain(..).rev() {
            object.destroy(&self.device);
        }
    }
}
