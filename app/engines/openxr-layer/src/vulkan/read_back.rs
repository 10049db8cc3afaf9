//! Reads images back. For tests.

use ash::vk;
use yoro::synthesis::backend::WarpKind;
use yoro::vulkan::ImageState;

use super::{FRAMES, Synthesizer, vk_format, vk_image};
use crate::geometry::Rectangle;
use crate::reason::Reason;
use crate::synthesizer::Image;

impl<W: WarpKind> Synthesizer<W> {
    /// Reads a rectangle of a colour image as red, green and blue.
    ///
    /// # Errors
    /// Fails if the format does not have four bytes per pixel, or the device fails.
    ///
    /// # Safety
    /// As for [`crate::synthesizer::Synthesizer::read`].
    pub(super) unsafe fn read_rgb(&mut self, image: Image, part: Rectangle) -> Result<Vec<u8>, String> {
        let places = match vk_format(image) {
            vk::Format::R8G8B8A8_SRGB | vk::Format::R8G8B8A8_UNORM => [0, 1, 2],
            vk::Format::B8G8R8A8_SRGB | vk::Format::B8G8R8A8_UNORM => [2, 1, 0],
            format => return Err(format!("{format:?} is no format of four bytes")),
        };
        // SAFETY: same contract.
        let bytes = unsafe { self.read_back(image, part) }.map_err(|reason| reason.to_string())?;
        Ok(bytes.chunks_exact(4).flat_map(|pixel| places.map(|place| pixel[place])).collect())
    }

    /// Copies a rectangle of an image that is in the layout of a colour attachment, and waits for the copy. Returns
    /// four bytes per pixel.
    unsafe fn read_back(&mut self, image: Image, part: Rectangle) -> Result<Vec<u8>, Reason> {
        let slot = self.slots[self.frame % FRAMES];
        let bytes = u64::from(part.size[0]) * u64::from(part.size[1]) * 4;
        // SAFETY: the image is not in use; all other objects are made here and destroyed after the commands have ended.
        unsafe {
            self.wait_for(slot)?;
            let staging = Staging::new(&self.instance, &self.device, self.binding.physical_device, bytes)?;
            self.begin(slot)?;
            let device = &self.device;
            let turn = |from: ImageState, to: ImageState| {
                let barrier = vk::ImageMemoryBarrier::default()
                    .image(vk_image(image))
                    .old_layout(from.layout)
                    .new_layout(to.layout)
                    .src_access_mask(from.access)
                    .dst_access_mask(to.access)
                    .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                    .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                    .subresource_range(vk::ImageSubresourceRange {
                        aspect_mask: vk::ImageAspectFlags::COLOR,
                        base_mip_level: 0,
                        level_count: 1,
                        base_array_layer: image.layer,
                        layer_count: 1,
                    });
                let dependencies = vk::DependencyFlags::empty();
                device.cmd_pipeline_barrier(
                    slot.commands,
                    from.stages,
                    to.stages,
                    dependencies,
                    &[],
                    &[],
                    &[barrier],
                );
            };
            let copied = ImageState {
                layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
                stages: vk::PipelineStageFlags::TRANSFER,
                access: vk::AccessFlags::TRANSFER_READ,
            };
            turn(ImageState::COLOR_ATTACHMENT, copied);
            let copy = vk::BufferImageCopy::default()
                .image_subresource(vk::ImageSubresourceLayers {
                    aspect_mask: vk::ImageAspectFlags::COLOR,
                    mip_level: 0,
                    base_array_layer: image.layer,
                    layer_count: 1,
                })
                .image_offset(vk::Offset3D { x: part.origin[0] as i32, y: part.origin[1] as i32, z: 0 })
                .image_extent(vk::Extent3D { width: part.size[0], height: part.size[1], depth: 1 });
            device.cmd_copy_image_to_buffer(
                slot.commands,
                vk_image(image),
                copied.layout,
                staging.buffer,
                &[copy],
            );
            turn(copied, ImageState::COLOR_ATTACHMENT);
            device.end_command_buffer(slot.commands).map_err(Reason::Vulkan)?;
            self.submit(slot)?;
            self.wait_for(slot)?;
            staging.bytes()
        }
    }
}

/// A buffer that the CPU reads.
struct Staging {
    device: ash::Device,
    buffer: vk::Buffer,
    memory: vk::DeviceMemory,
    size: u64,
}

impl Staging {
    unsafe fn new(
        instance: &ash::Instance,
        device: &ash::Device,
        physical_device: vk::PhysicalDevice,
        size: u64,
    ) -> Result<Staging, Reason> {
        let mut staging = Staging {
            device: device.clone(),
            buffer: vk::Buffer::null(),
            memory: vk::DeviceMemory::null(),
            size,
        };
        // SAFETY: a live device. What was created before an error is destroyed with the struct.
        unsafe {
            let info = vk::BufferCreateInfo::default().size(size).usage(vk::BufferUsageFlags::TRANSFER_DST);
            staging.buffer = device.create_buffer(&info, None).map_err(Reason::Vulkan)?;
            let needs = device.get_buffer_memory_requirements(staging.buffer);
            let wanted = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
            let types = instance.get_physical_device_memory_properties(physical_device);
            let kind = types.memory_types_as_slice().iter().enumerate().position(|(i, kind)| {
                needs.memory_type_bits & (1 << i) != 0 && kind.property_flags.contains(wanted)
            });
            let kind = kind.ok_or(Reason::Vulkan(vk::Result::ERROR_FEATURE_NOT_PRESENT))?;
            let info =
                vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(kind as u32);
            staging.memory = device.allocate_memory(&info, None).map_err(Reason::Vulkan)?;
            device.bind_buffer_memory(staging.buffer, staging.memory, 0).map_err(Reason::Vulkan)?;
        }
        Ok(staging)
    }

    unsafe fn bytes(&self) -> Result<Vec<u8>, Reason> {
        // SAFETY: host-visible memory of this size, to which nothing is writing.
        unsafe {
            let flags = vk::MemoryMapFlags::empty();
            let start = self.device.map_memory(self.memory, 0, self.size, flags).map_err(Reason::Vulkan)?;
            let bytes = std::slice::from_raw_parts(start.cast::<u8>(), self.size as usize).to_vec();
            self.device.unmap_memory(self.memory);
            Ok(bytes)
        }
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        // SAFETY: this device's objects, which no command uses.
        unsafe {
            self.device.destroy_buffer(self.buffer, None);
            self.device.free_memory(self.memory, None);
        }
    }
}
