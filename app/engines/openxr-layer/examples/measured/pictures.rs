//! Pictures of what the runtime receives in one frame.

use std::collections::{HashMap, VecDeque};
use std::path::{Path, PathBuf};

use ash::vk;
use ash::vk::Handle as _;
use image::RgbImage;
use openxr_sys as sys;
use sys::pfn;

use super::Device;

/// The number of frames with layers before the one of which pictures are written.
const EARLIER_FRAMES: u32 = 20;

/// The swapchains of a session, and the frame that comes next.
pub struct Pictures {
    folder: PathBuf,
    frame: u32,
    swapchains: HashMap<sys::Swapchain, Swapchain>,
}

struct Swapchain {
    format: vk::Format,
    size: [u32; 2],
    images: Vec<vk::Image>,
    /// Indices of acquired images, oldest first.
    acquired: VecDeque<u32>,
    /// The image that was released in the frame of which pictures are written.
    picture: Option<RgbImage>,
}

impl Pictures {
    /// Returns `None` if no pictures are wanted.
    pub fn new() -> Option<Pictures> {
        let folder = std::env::var_os("YORO_MEASURED_PICTURES")?.into();
        Some(Pictures { folder, frame: 0, swapchains: HashMap::new() })
    }

    /// # Safety
    /// A live swapchain that was created with `info` on Vulkan.
    pub unsafe fn add_swapchain(
        &mut self,
        enumerate: pfn::EnumerateSwapchainImages,
        handle: sys::Swapchain,
        info: &sys::SwapchainCreateInfo,
    ) {
        let ty = sys::SwapchainImageVulkanKHR::TYPE;
        let mut images = [sys::SwapchainImageVulkanKHR { ty, next: std::ptr::null_mut(), image: 0 }; 8];
        let mut count = 0;
        // SAFETY: a live swapchain, and room for eight images.
        unsafe { enumerate(handle, images.len() as u32, &mut count, images.as_mut_ptr().cast()) };
        let swapchain = Swapchain {
            format: vk::Format::from_raw(info.format as i32),
            size: [info.width, info.height],
            images: images[..count as usize].iter().map(|image| vk::Image::from_raw(image.image)).collect(),
            acquired: VecDeque::new(),
            picture: None,
        };
        self.swapchains.insert(handle, swapchain);
    }

    pub fn acquire(&mut self, handle: sys::Swapchain, index: u32) {
        if let Some(swapchain) = self.swapchains.get_mut(&handle) {
            swapchain.acquired.push_back(index);
        }
    }

    /// Reads an image that is about to be released, in the frame of which pictures are written.
    ///
    /// # Safety
    /// Nobody else uses the queue, and the image is in the layout of an attachment.
    pub unsafe fn release(&mut self, device: &Device, handle: sys::Swapchain) {
        let Some(swapchain) = self.swapchains.get_mut(&handle) else { return };
        let Some(index) = swapchain.acquired.pop_front().filter(|_| self.frame == EARLIER_FRAMES) else {
            return;
        };
        let places = match swapchain.format {
            vk::Format::R8G8B8A8_SRGB | vk::Format::R8G8B8A8_UNORM => [0, 1, 2],
            vk::Format::B8G8R8A8_SRGB | vk::Format::B8G8R8A8_UNORM => [2, 1, 0],
            _ => return,
        };
        let ([width, height], image) = (swapchain.size, swapchain.images[index as usize]);
        // SAFETY: same contract.
        let bytes = unsafe { read(device, image, swapchain.size) }.expect("the image can be read");
        let bytes = bytes.chunks_exact(4).flat_map(|pixel| places.map(|place| pixel[place])).collect();
        swapchain.picture = RgbImage::from_raw(width, height, bytes);
    }

    /// Writes both eyes' pictures, and the whole image of which the right eye's is a part.
    ///
    /// # Safety
    /// The structure is that of a successful call of xrEndFrame.
    pub unsafe fn end_frame(&mut self, info: &sys::FrameEndInfo) {
        self.frame += 1;
        // SAFETY: the caller's layers, whose types tell what they are.
        let views = (0..info.layer_count as usize).find_map(|i| unsafe {
            let layer = (*info.layers.add(i)).cast::<sys::CompositionLayerProjection>();
            let is_one = (*layer).ty == sys::CompositionLayerProjection::TYPE && (*layer).view_count == 2;
            is_one.then(|| std::slice::from_raw_parts((*layer).views, 2))
        });
        let Some(views) = views else { return };
        for (view, name) in views.iter().zip(["left", "right"]) {
            let swapchain = self.swapchains.get_mut(&view.sub_image.swapchain);
            let Some(picture) = swapchain.and_then(|swapchain| swapchain.picture.take()) else { continue };
            let sys::Rect2Di { offset, extent } = view.sub_image.image_rect;
            let [x, y, width, height] = [offset.x, offset.y, extent.width, extent.height].map(|n| n as u32);
            if name == "right" {
                save(&self.folder, "rendered", &picture);
            }
            let part = image::imageops::crop_imm(&picture, x, y, width, height).to_image();
            save(&self.folder, name, &part);
        }
    }
}

/// Writes a file that appears under its name only when it is complete, since a test waits for it.
fn save(folder: &Path, name: &str, picture: &RgbImage) {
    let unfinished = folder.join(format!("{name}.part"));
    picture.save_with_format(&unfinished, image::ImageFormat::Png).expect("the folder can be written to");
    std::fs::rename(unfinished, folder.join(format!("{name}.png"))).expect("as above");
}

/// Returns the four bytes of each pixel of an image's first layer.
///
/// # Safety
/// Nobody else uses the queue, and the image is in the layout of an attachment.
unsafe fn read(device: &Device, image: vk::Image, [width, height]: [u32; 2]) -> Result<Vec<u8>, vk::Result> {
    let Device { instance, physical_device, device, queue_family, queue } = device;
    let size = u64::from(width) * u64::from(height) * 4;
    let attachment = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
    let copied = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
    // SAFETY: same contract. What is created here is destroyed after the commands have ended.
    unsafe {
        let info = vk::BufferCreateInfo::default().size(size).usage(vk::BufferUsageFlags::TRANSFER_DST);
        let buffer = device.create_buffer(&info, None)?;
        let needs = device.get_buffer_memory_requirements(buffer);
        let wanted = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        let types = instance.get_physical_device_memory_properties(*physical_device);
        let fits = |(i, kind): (usize, &vk::MemoryType)| {
            needs.memory_type_bits & (1 << i) != 0 && kind.property_flags.contains(wanted)
        };
        let kind = types.memory_types_as_slice().iter().enumerate().position(fits);
        let kind = kind.ok_or(vk::Result::ERROR_FEATURE_NOT_PRESENT)? as u32;
        let info = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(kind);
        let memory = device.allocate_memory(&info, None)?;
        device.bind_buffer_memory(buffer, memory, 0)?;

        let info = vk::CommandPoolCreateInfo::default().queue_family_index(*queue_family);
        let pool = device.create_command_pool(&info, None)?;
        let info = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
        let commands = device.allocate_command_buffers(&info)?;
        device.begin_command_buffer(commands[0], &vk::CommandBufferBeginInfo::default())?;
        let turn = |from: vk::ImageLayout, to: vk::ImageLayout| {
            let all = vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE;
            let barrier = vk::ImageMemoryBarrier::default()
                .image(image)
                .old_layout(from)
                .new_layout(to)
                .src_access_mask(all)
                .dst_access_mask(all)
                .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .subresource_range(vk::ImageSubresourceRange {
                    aspect_mask: vk::ImageAspectFlags::COLOR,
                    level_count: 1,
                    layer_count: 1,
                    ..Default::default()
                });
            let (stages, none) = (vk::PipelineStageFlags::ALL_COMMANDS, vk::DependencyFlags::empty());
            device.cmd_pipeline_barrier(commands[0], stages, stages, none, &[], &[], &[barrier]);
        };
        turn(attachment, copied);
        let region = vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                layer_count: 1,
                ..Default::default()
            })
            .image_extent(vk::Extent3D { width, height, depth: 1 });
        device.cmd_copy_image_to_buffer(commands[0], image, copied, buffer, &[region]);
        turn(copied, attachment);
        device.end_command_buffer(commands[0])?;
        let submits = [vk::SubmitInfo::default().command_buffers(&commands)];
        device.queue_submit(*queue, &submits, vk::Fence::null())?;
        device.queue_wait_idle(*queue)?;

        let start = device.map_memory(memory, 0, size, vk::MemoryMapFlags::empty())?;
        let bytes = std::slice::from_raw_parts(start.cast::<u8>(), size as usize).to_vec();
        device.destroy_command_pool(pool, None);
        device.destroy_buffer(buffer, None);
        device.free_memory(memory, None);
        Ok(bytes)
    }
}
