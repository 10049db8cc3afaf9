//! Vulkan on the application's device. An image is in an attachment layout when the application receives it, and must
//! be in that layout again when it is released.

use std::collections::HashMap;
use std::ffi::c_void;

use ash::vk;
use ash::vk::Handle as _;
use openxr_sys as sys;
use sys::Result as Code;

use super::{Graphics, Texture};
use crate::script::POISON;
use crate::world::Refusal;

/// The device that a session is bound to, and the images of its swapchains.
pub struct Vulkan {
    instance: ash::Instance,
    physical_device: vk::PhysicalDevice,
    device: ash::Device,
    queue: vk::Queue,
    pool: vk::CommandPool,
    images: HashMap<u64, Image>,
}

struct Image {
    memory: vk::DeviceMemory,
    format: vk::Format,
    aspects: vk::ImageAspectFlags,
    /// The layout between the application's uses.
    layout: vk::ImageLayout,
}

impl Vulkan {
    pub fn new(binding: &sys::GraphicsBindingVulkanKHR) -> Result<Vulkan, Refusal> {
        let raw = |handle: *const c_void| handle as u64;
        // SAFETY: the application's handles, which it keeps until the session is destroyed. The loader stays loaded,
        // because the application uses it.
        unsafe {
            let entry = ash::Entry::load().map_err(|_| Code::ERROR_RUNTIME_FAILURE)?;
            let instance = vk::Instance::from_raw(raw(binding.instance));
            let instance = ash::Instance::load(entry.static_fn(), instance);
            let device = vk::Device::from_raw(raw(binding.device));
            let device = ash::Device::load(instance.fp_v1_0(), device);
            let queue = device.get_device_queue(binding.queue_family_index, binding.queue_index);
            let info = vk::CommandPoolCreateInfo::default().queue_family_index(binding.queue_family_index);
            let pool = device.create_command_pool(&info, None).map_err(|_| Code::ERROR_RUNTIME_FAILURE)?;
            let physical_device = vk::PhysicalDevice::from_raw(raw(binding.physical_device));
            Ok(Vulkan { instance, physical_device, device, queue, pool, images: HashMap::new() })
        }
    }

    /// Runs commands on the application's queue, and waits for them.
    fn run(&self, record: impl FnOnce(&ash::Device, vk::CommandBuffer)) -> Option<()> {
        let device = &self.device;
        let info = vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
        // SAFETY: the device is live, nobody else uses the queue during the calls in which the runtime may use it, and
        // the commands have ended when they are freed.
        unsafe {
            let commands = device.allocate_command_buffers(&info).ok()?;
            device.begin_command_buffer(commands[0], &vk::CommandBufferBeginInfo::default()).ok()?;
            record(device, commands[0]);
            device.end_command_buffer(commands[0]).ok()?;
            let submit = [vk::SubmitInfo::default().command_buffers(&commands)];
            device.queue_submit(self.queue, &submit, vk::Fence::null()).ok()?;
            device.queue_wait_idle(self.queue).ok()?;
            device.free_command_buffers(self.pool, &commands);
        }
        Some(())
    }

    fn allocate(
        &self,
        needs: vk::MemoryRequirements,
        wanted: vk::MemoryPropertyFlags,
    ) -> Option<vk::DeviceMemory> {
        // SAFETY: the application's device.
        let types = unsafe { self.instance.get_physical_device_memory_properties(self.physical_device) };
        let index = types.memory_types_as_slice().iter().enumerate().position(|(i, kind)| {
            needs.memory_type_bits & (1 << i) != 0 && kind.property_flags.contains(wanted)
        })?;
        let info =
            vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(index as u32);
        // SAFETY: a valid description.
        unsafe { self.device.allocate_memory(&info, None).ok() }
    }

    /// Records a barrier for all layers of an image.
    fn turn(
        &self,
        commands: vk::CommandBuffer,
        texture: Texture,
        [from, to]: [vk::ImageLayout; 2],
    ) -> Option<()> {
        let image = self.images.get(&texture.raw)?;
        let all = vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE;
        let barrier = vk::ImageMemoryBarrier::default()
            .image(vk::Image::from_raw(texture.raw))
            .old_layout(from)
            .new_layout(to)
            .src_access_mask(all)
            .dst_access_mask(all)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .subresource_range(whole(image.aspects, texture.layers));
        let (stages, none) = (vk::PipelineStageFlags::ALL_COMMANDS, vk::DependencyFlags::empty());
        // SAFETY: a live image in this layout.
        unsafe { self.device.cmd_pipeline_barrier(commands, stages, stages, none, &[], &[], &[barrier]) };
        Some(())
    }

    fn destroy(&mut self, raw: u64) {
        if let Some(image) = self.images.remove(&raw) {
            // SAFETY: created in `texture`; the work that used it has ended.
            unsafe {
                self.device.queue_wait_idle(self.queue).ok();
                self.device.destroy_image(vk::Image::from_raw(raw), None);
                self.device.free_memory(image.memory, None);
            }
        }
    }

    /// Copies a rectangle with four bytes per pixel to the host. Returns its rows from the lowest to the top one.
    fn copy(&self, texture: Texture, layer: u32, rect: [i32; 4]) -> Option<Vec<u8>> {
        let [x, y, width, height] = rect;
        let row = width as usize * 4;
        let image = self.images.get(&texture.raw)?;
        let size = row as u64 * height as u64;
        let info = vk::BufferCreateInfo::default().size(size).usage(vk::BufferUsageFlags::TRANSFER_DST);
        let visible = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        // SAFETY: a buffer with its own memory, of the size of the copy, which nothing uses afterwards.
        unsafe {
            let buffer = self.device.create_buffer(&info, None).ok()?;
            let memory = self.allocate(self.device.get_buffer_memory_requirements(buffer), visible)?;
            self.device.bind_buffer_memory(buffer, memory, 0).ok()?;
            let copied = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
            self.run(|device, commands| {
                self.turn(commands, texture, [image.layout, copied]);
                let region = vk::BufferImageCopy::default()
                    .image_subresource(vk::ImageSubresourceLayers {
                        aspect_mask: image.aspects,
                        mip_level: 0,
                        base_array_layer: layer,
                        layer_count: 1,
                    })
                    .image_offset(vk::Offset3D { x, y, z: 0 })
                    .image_extent(vk::Extent3D { width: width as u32, height: height as u32, depth: 1 });
                let source = vk::Image::from_raw(texture.raw);
                device.cmd_copy_image_to_buffer(commands, source, copied, buffer, &[region]);
                self.turn(commands, texture, [copied, image.layout]);
            })?;
            let start = self.device.map_memory(memory, 0, size, vk::MemoryMapFlags::empty()).ok()?;
            let rows = std::slice::from_raw_parts(start.cast::<u8>(), size as usize).chunks_exact(row).rev();
            let bytes = rows.flatten().copied().collect();
            self.device.destroy_buffer(buffer, None);
            self.device.free_memory(memory, None);
            Some(bytes)
        }
    }
}

fn whole(aspect_mask: vk::ImageAspectFlags, layer_count: u32) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask,
        base_mip_level: 0,
        level_count: 1,
        base_array_layer: 0,
        layer_count,
    }
}

fn aspects(format: vk::Format) -> vk::ImageAspectFlags {
    match format {
        vk::Format::D16_UNORM | vk::Format::D32_SFLOAT => vk::ImageAspectFlags::DEPTH,
        vk::Format::D24_UNORM_S8_UINT | vk::Format::D32_SFLOAT_S8_UINT => {
            vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL
        }
        _ => vk::ImageAspectFlags::COLOR,
    }
}

/// Returns the application's usage, plus the flags that the runtime needs to fill and read images.
fn usage(asked: sys::SwapchainUsageFlags) -> vk::ImageUsageFlags {
    use sys::SwapchainUsageFlags as Asked;
    use vk::ImageUsageFlags as Usage;
    let pairs = [
        (Asked::COLOR_ATTACHMENT, Usage::COLOR_ATTACHMENT),
        (Asked::DEPTH_STENCIL_ATTACHMENT, Usage::DEPTH_STENCIL_ATTACHMENT),
        (Asked::SAMPLED, Usage::SAMPLED),
    ];
    let asked = pairs.into_iter().filter(|(flag, _)| asked.contains(*flag)).map(|(_, usage)| usage);
    asked.fold(Usage::TRANSFER_SRC | Usage::TRANSFER_DST, |all, usage| all | usage)
}

impl Graphics for Vulkan {
    fn is_current(&self) -> bool {
        true
    }

    fn unbind(&self) {}

    fn image_type(&self) -> sys::StructureType {
        sys::SwapchainImageVulkanKHR::TYPE
    }

    fn texture(&mut self, info: &sys::SwapchainCreateInfo) -> Option<Texture> {
        let format = vk::Format::from_raw(info.format as i32);
        let (aspects, layers) = (aspects(format), info.array_size);
        let layout = match aspects {
            vk::ImageAspectFlags::COLOR => vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
            _ => vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        };
        let description = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width: info.width, height: info.height, depth: 1 })
            .mip_levels(1)
            .array_layers(layers)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(usage(info.usage_flags));
        // SAFETY: an image with its own memory.
        unsafe {
            let image = self.device.create_image(&description, None).ok()?;
            let needs = self.device.get_image_memory_requirements(image);
            let memory = self.allocate(needs, vk::MemoryPropertyFlags::DEVICE_LOCAL)?;
            self.device.bind_image_memory(image, memory, 0).ok()?;
            let texture = Texture { raw: image.as_raw(), layers };
            self.images.insert(texture.raw, Image { memory, format, aspects, layout });
            self.run(|_, commands| {
                self.turn(commands, texture, [vk::ImageLayout::UNDEFINED, layout]);
            })?;
            Some(texture)
        }
    }

    fn delete(&mut self, textures: &[Texture]) {
        for texture in textures {
            self.destroy(texture.raw);
        }
    }

    fn poison(&mut self, texture: Texture) {
        let Some(image) = self.images.get(&texture.raw) else { return };
        let cleared = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        self.run(|device, commands| {
            let color = vk::ClearColorValue { float32: POISON.map(|c| f32::from(c) / 255.0) };
            let range = [whole(image.aspects, texture.layers)];
            self.turn(commands, texture, [image.layout, cleared]);
            // SAFETY: a live image in this layout.
            unsafe {
                let image = vk::Image::from_raw(texture.raw);
                device.cmd_clear_color_image(commands, image, cleared, &color, &range);
            }
            self.turn(commands, texture, [cleared, image.layout]);
        });
    }

    fn read(&mut self, texture: Texture, layer: u32, rect: [i32; 4]) -> Option<Vec<u8>> {
        let format = self.images.get(&texture.raw)?.format;
        let swapped = match format {
            vk::Format::R8G8B8A8_UNORM | vk::Format::R8G8B8A8_SRGB | vk::Format::D32_SFLOAT => false,
            vk::Format::B8G8R8A8_UNORM | vk::Format::B8G8R8A8_SRGB => true,
            _ => return None,
        };
        let mut pixels = self.copy(texture, layer, rect)?;
        if swapped {
            pixels.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
        }
        Some(pixels)
    }
}

impl Drop for Vulkan {
    fn drop(&mut self) {
        let left: Vec<u64> = self.images.keys().copied().collect();
        for raw in left {
            self.destroy(raw);
        }
        // SAFETY: the application keeps its device until the session is destroyed.
        unsafe { self.device.destroy_command_pool(self.pool, None) };
    }
}
