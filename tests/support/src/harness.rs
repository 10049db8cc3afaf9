//! A Vulkan device without a window, under Khronos's validation layer, and pictures in its images.
//!
//! Rows of arrays run from the bottom, as everywhere; those of images run from the top, as in Vulkan.

use std::ffi::{CStr, c_char, c_void};
use std::sync::Mutex;

use crate::against_opengl::flipped;
use yoro::synthesis::backend::WarpKind;
use yoro::vulkan::ash::{self, vk};
use yoro::vulkan::{Host, ImageState, LayerImage};

const VALIDATION: &CStr = c"VK_LAYER_KHRONOS_validation";

/// How passes begin, and which features of the device are enabled for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rendering {
    /// Vulkan 1.1 without further features.
    RenderPasses,
    /// Vulkan 1.1 with VK_KHR_dynamic_rendering.
    Extension,
    /// Vulkan 1.3.
    Core,
}

impl Rendering {
    pub const ALL: [Rendering; 3] = [Rendering::RenderPasses, Rendering::Extension, Rendering::Core];
}

/// A device with its own instance. When it is dropped, the validation layer must not have reported anything.
pub struct Gpu {
    entry: ash::Entry,
    instance: ash::Instance,
    messenger: (ash::ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT),
    messages: Box<Mutex<Vec<String>>>,
    pub physical_device: vk::PhysicalDevice,
    pub device: ash::Device,
    family: u32,
    queue: vk::Queue,
    pool: vk::CommandPool,
    memory: vk::PhysicalDeviceMemoryProperties,
    rendering: Rendering,
}

unsafe extern "system" fn note(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layer's data, and the list that `Gpu` owns for longer than the messenger.
    unsafe {
        let text = CStr::from_ptr((*data).p_message).to_string_lossy().into_owned();
        let messages = &*messages.cast::<Mutex<Vec<String>>>();
        messages.lock().unwrap().push(text);
    }
    vk::FALSE
}

/// Runs a test body on a device, unless tests of Vulkan are disabled.
pub fn with_gpu(rendering: Rendering, body: impl FnOnce(&Gpu)) {
    with(rendering, true, body);
}

/// Does the same without the validation layer, which keeps memory for every submission: for tests that memory does not
/// grow.
pub fn with_unwatched_gpu(rendering: Rendering, body: impl FnOnce(&Gpu)) {
    with(rendering, false, body);
}

fn with(rendering: Rendering, watched: bool, body: impl FnOnce(&Gpu)) {
    if std::env::var_os("YORO_TEST_WITHOUT_VULKAN").is_some() {
        return println!("LEFT OUT: Vulkan by {rendering:?}");
    }
    match Gpu::open(rendering, watched) {
        Ok(gpu) => body(&gpu),
        Err(reason) => panic!("{reason}: `cargo xtask setup`, or set YORO_TEST_WITHOUT_VULKAN=1"),
    }
}

impl Gpu {
    fn open(rendering: Rendering, watched: bool) -> Result<Gpu, String> {
        // SAFETY: the loader is a library that does nothing when it is loaded; all handles are made here and are used
        // while they live.
        unsafe {
            let entry = ash::Entry::load().map_err(|error| format!("no Vulkan loader is here ({error})"))?;
            let layers = entry.enumerate_instance_layer_properties().unwrap();
            if !layers.iter().any(|layer| layer.layer_name_as_c_str() == Ok(VALIDATION)) {
                return Err("Vulkan's validation layer is not here".into());
            }
            let messages = Box::new(Mutex::new(Vec::new()));
            let version =
                if rendering == Rendering::Core { vk::API_VERSION_1_3 } else { vk::API_VERSION_1_1 };
            let application = vk::ApplicationInfo::default().api_version(version);
            let layers: [*const c_char; 1] = [VALIDATION.as_ptr()];
            let extensions: [*const c_char; 1] = [ash::ext::debug_utils::NAME.as_ptr()];
            let features = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
            let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&features);
            let messenger = || {
                vk::DebugUtilsMessengerCreateInfoEXT::default()
                    .message_severity(
                        vk::DebugUtilsMessageSeverityFlagsEXT::WARNING
                            | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
                    )
                    .message_type(
                        vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION
                            | vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE,
                    )
                    .pfn_user_callback(Some(note))
                    .user_data((&raw const *messages).cast_mut().cast())
            };
            // Watches the creation and destruction of the instance itself.
            let mut early = messenger();
            let info = vk::InstanceCreateInfo::default()
                .application_info(&application)
                .enabled_layer_names(if watched { &layers } else { &[] })
                .enabled_extension_names(&extensions)
                .push_next(&mut features)
                .push_next(&mut early);
            let instance =
                entry.create_instance(&info, None).map_err(|error| format!("no Vulkan here ({error:?})"))?;
            let debug = ash::ext::debug_utils::Instance::new(&entry, &instance);
            let messenger = debug.create_debug_utils_messenger(&messenger(), None).unwrap();
            let physical_devices = instance.enumerate_physical_devices().unwrap_or_default();
            // A CPU rasterizer renders the same everywhere.
            let is_cpu = |device: &&vk::PhysicalDevice| {
                instance.get_physical_device_properties(**device).device_type == vk::PhysicalDeviceType::CPU
            };
            let chosen = physical_devices.iter().find(is_cpu).or(physical_devices.first());
            let Some(&physical_device) = chosen else {
                debug.destroy_debug_utils_messenger(messenger, None);
                instance.destroy_instance(None);
                return Err("no Vulkan device is here".into());
            };
            let families = instance.get_physical_device_queue_family_properties(physical_device);
            let draws =
                |family: &vk::QueueFamilyProperties| family.queue_flags.contains(vk::QueueFlags::GRAPHICS);
            let family = families.iter().position(draws).unwrap() as u32;
            let queues =
                [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
            let extensions: [*const c_char; 4] = [
                ash::khr::dynamic_rendering::NAME.as_ptr(),
                // The preceding extension needs these in Vulkan 1.1.
                ash::khr::depth_stencil_resolve::NAME.as_ptr(),
                ash::khr::create_renderpass2::NAME.as_ptr(),
                ash::khr::get_physical_device_properties2::NAME.as_ptr(),
            ];
            let extensions = if rendering == Rendering::Extension { &extensions[..3] } else { &[] };
            let mut dynamic = vk::PhysicalDeviceDynamicRenderingFeatures::default().dynamic_rendering(true);
            let mut info = vk::DeviceCreateInfo::default()
                .queue_create_infos(&queues)
                .enabled_extension_names(extensions);
            if rendering != Rendering::RenderPasses {
                info = info.push_next(&mut dynamic);
            }
            let device = instance.create_device(physical_device, &info, None).unwrap();
            let queue = device.get_device_queue(family, 0);
            let pool = vk::CommandPoolCreateInfo::default().queue_family_index(family);
            let pool = device.create_command_pool(&pool, None).unwrap();
            let memory = instance.get_physical_device_memory_properties(physical_device);
            Ok(Gpu {
                entry,
                instance,
                messenger: (debug, messenger),
                messages,
                physical_device,
                device,
                family,
                queue,
                pool,
                memory,
                rendering,
            })
        }
    }

    pub fn host(&self) -> Host<'_> {
        Host {
            instance: &self.instance,
            physical_device: self.physical_device,
            device: &self.device,
            queue_family: self.family,
            dynamic_rendering: self.rendering != Rendering::RenderPasses,
            debug_utils: true,
        }
    }

    /// Returns the instance with some of its entry points replaced.
    pub fn instance_with(&self, other: impl Fn(&CStr) -> Option<*const c_void>) -> ash::Instance {
        let handle = self.instance.handle();
        let load = |name: &CStr| {
            // SAFETY: a live instance, and a name that ends with 0.
            let own = unsafe { self.entry.get_instance_proc_addr(handle, name.as_ptr()) };
            other(name).unwrap_or(own.map_or(std::ptr::null(), |own| own as *const c_void))
        };
        // SAFETY: the instance's own entry points, or the caller's with the same signatures.
        unsafe { ash::Instance::load_with(load, handle) }
    }

    pub fn name(&self) -> String {
        // SAFETY: a valid device.
        let properties = unsafe { self.instance.get_physical_device_properties(self.physical_device) };
        properties.device_name_as_c_str().unwrap().to_string_lossy().into_owned()
    }

    /// True if images of this format have these features.
    pub fn has(&self, format: vk::Format, features: vk::FormatFeatureFlags) -> bool {
        // SAFETY: a valid device.
        let properties =
            unsafe { self.instance.get_physical_device_format_properties(self.physical_device, format) };
        properties.optimal_tiling_features.contains(features)
    }

    /// True if a render pass can resolve depth in this way.
    pub fn resolves_depth(&self, mode: vk::ResolveModeFlags) -> bool {
        let mut resolve = vk::PhysicalDeviceDepthStencilResolveProperties::default();
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut resolve);
        // SAFETY: a valid device, and structures of Vulkan 1.2.
        unsafe { self.instance.get_physical_device_properties2(self.physical_device, &mut properties) };
        resolve.supported_depth_resolve_modes.contains(mode)
    }

    /// Returns the validation layer's messages so far, and removes them.
    pub fn messages(&self) -> Vec<String> {
        std::mem::take(&mut *self.messages.lock().unwrap())
    }

    /// Records and submits commands, and waits for them.
    pub fn run<R>(&self, record: impl FnOnce(vk::CommandBuffer) -> R) -> R {
        // SAFETY: one command buffer, which has been executed when it is freed.
        unsafe {
            let info =
                vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
            let commands = self.device.allocate_command_buffers(&info).unwrap();
            let begin =
                vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            self.device.begin_command_buffer(commands[0], &begin).unwrap();
            let result = record(commands[0]);
            self.device.end_command_buffer(commands[0]).unwrap();
            let submit = [vk::SubmitInfo::default().command_buffers(&commands)];
            self.device.queue_submit(self.queue, &submit, vk::Fence::null()).unwrap();
            self.device.queue_wait_idle(self.queue).unwrap();
            self.device.free_command_buffers(self.pool, &commands);
            result
        }
    }

    fn allocate(
        &self,
        needed: vk::MemoryRequirements,
        properties: vk::MemoryPropertyFlags,
    ) -> vk::DeviceMemory {
        let types = &self.memory.memory_types[..self.memory.memory_type_count as usize];
        let fits = |i: &usize| {
            needed.memory_type_bits >> i & 1 != 0 && types[*i].property_flags.contains(properties)
        };
        let index = (0..types.len()).find(fits).unwrap() as u32;
        let info = vk::MemoryAllocateInfo::default().allocation_size(needed.size).memory_type_index(index);
        // SAFETY: a valid description.
        unsafe { self.device.allocate_memory(&info, None).unwrap() }
    }

    /// Calls `body` with a buffer of this content, and returns its content afterwards.
    fn with_buffer(&self, mut bytes: Vec<u8>, body: impl FnOnce(vk::Buffer)) -> Vec<u8> {
        let usage = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
        let info = vk::BufferCreateInfo::default().size(bytes.len() as u64).usage(usage);
        let visible = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        // SAFETY: a buffer with memory of its own, as long as `bytes`, which nothing uses after `body`.
        unsafe {
            let buffer = self.device.create_buffer(&info, None).unwrap();
            let memory = self.allocate(self.device.get_buffer_memory_requirements(buffer), visible);
            self.device.bind_buffer_memory(buffer, memory, 0).unwrap();
            let mapped =
                self.device.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty()).unwrap();
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), mapped.cast(), bytes.len());
            body(buffer);
            std::ptr::copy_nonoverlapping(mapped.cast_const().cast(), bytes.as_mut_ptr(), bytes.len());
            self.device.destroy_buffer(buffer, None);
            self.device.free_memory(memory, None);
        }
        bytes
    }

    /// Creates an image that can be rendered to, sampled and copied.
    pub fn image(&self, format: vk::Format, size: [u32; 2], layers: u32) -> Image<'_> {
        let copied = vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::TRANSFER_DST;
        self.image_of(format, size, layers, vk::SampleCountFlags::TYPE_1, copied)
    }

    /// Creates an image of four samples that can be rendered to.
    pub fn multisampled(&self, format: vk::Format, size: [u32; 2]) -> Image<'_> {
        self.image_of(format, size, 1, vk::SampleCountFlags::TYPE_4, vk::ImageUsageFlags::empty())
    }

    fn image_of(
        &self,
        format: vk::Format,
        size: [u32; 2],
        layers: u32,
        samples: vk::SampleCountFlags,
        copied: vk::ImageUsageFlags,
    ) -> Image<'_> {
        let attachment = match is_depth(format) {
            true => vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
            false if matches!(format, vk::Format::R16_UNORM | vk::Format::R32_SFLOAT) => {
                vk::ImageUsageFlags::empty()
            }
            false => vk::ImageUsageFlags::COLOR_ATTACHMENT,
        };
        let usage = attachment | vk::ImageUsageFlags::SAMPLED | copied;
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width: size[0], height: size[1], depth: 1 })
            .mip_levels(1)
            .array_layers(layers)
            .samples(samples)
            .usage(usage);
        // SAFETY: an image with memory of its own.
        unsafe {
            let raw = self.device.create_image(&info, None).unwrap();
            let needed = self.device.get_image_memory_requirements(raw);
            let memory = self.allocate(needed, vk::MemoryPropertyFlags::DEVICE_LOCAL);
            self.device.bind_image_memory(raw, memory, 0).unwrap();
            Image { gpu: self, raw, memory, format, size }
        }
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        // SAFETY: everything was executed, and no other object of the device is left.
        unsafe {
            self.device.destroy_command_pool(self.pool, None);
            self.device.destroy_device(None);
            self.messenger.0.destroy_debug_utils_messenger(self.messenger.1, None);
            self.instance.destroy_instance(None);
        }
        let messages = self.messages();
        if !std::thread::panicking() {
            assert!(messages.is_empty(), "the validation layer says:\n{}", messages.join("\n"));
        }
    }
}

pub fn is_depth(format: vk::Format) -> bool {
    matches!(
        format,
        vk::Format::D16_UNORM
            | vk::Format::D24_UNORM_S8_UINT
            | vk::Format::D32_SFLOAT
            | vk::Format::D32_SFLOAT_S8_UINT
    )
}

/// True if the images here know how to copy this format.
pub fn is_copied(format: vk::Format) -> bool {
    format != vk::Format::X8_D24_UNORM_PACK32
}

fn is_rgba8(format: vk::Format) -> bool {
    matches!(format, vk::Format::R8G8B8A8_UNORM | vk::Format::R8G8B8A8_SRGB)
}

/// A 2-D image, or an array of them.
pub struct Image<'a> {
    gpu: &'a Gpu,
    pub raw: vk::Image,
    memory: vk::DeviceMemory,
    pub format: vk::Format,
    pub size: [u32; 2],
}

impl Image<'_> {
    pub fn pixels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// Returns a layer, with its uses before and after a call.
    pub fn layer(&self, layer: u32, before: ImageState, after: ImageState) -> LayerImage {
        LayerImage { image: self.raw, format: self.format, layer, before, after }
    }

    /// Returns all aspects of the format.
    fn aspects(&self) -> vk::ImageAspectFlags {
        let stencil = matches!(self.format, vk::Format::D24_UNORM_S8_UINT | vk::Format::D32_SFLOAT_S8_UINT);
        match (is_depth(self.format), stencil) {
            (true, true) => vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL,
            (true, false) => vk::ImageAspectFlags::DEPTH,
            _ => vk::ImageAspectFlags::COLOR,
        }
    }

    /// Returns the aspect to copy: colour, or depth alone.
    fn copied(&self, layer: u32) -> vk::ImageSubresourceLayers {
        let aspect_mask =
            if is_depth(self.format) { vk::ImageAspectFlags::DEPTH } else { vk::ImageAspectFlags::COLOR };
        vk::ImageSubresourceLayers { aspect_mask, mip_level: 0, base_array_layer: layer, layer_count: 1 }
    }

    /// Describes the copy of a whole layer to or from a buffer.
    fn whole(&self, layer: u32) -> [vk::BufferImageCopy; 1] {
        let [width, height] = self.size;
        let extent = vk::Extent3D { width, height, depth: 1 };
        [vk::BufferImageCopy::default().image_subresource(self.copied(layer)).image_extent(extent)]
    }

    /// Records a barrier between two uses.
    pub fn barrier(&self, commands: vk::CommandBuffer, layer: u32, from: ImageState, to: ImageState) {
        let range = vk::ImageSubresourceRange {
            aspect_mask: self.aspects(),
            base_mip_level: 0,
            level_count: 1,
            base_array_layer: layer,
            layer_count: 1,
        };
        let barrier = [vk::ImageMemoryBarrier::default()
            .src_access_mask(from.access)
            .dst_access_mask(to.access)
            .old_layout(from.layout)
            .new_layout(to.layout)
            .image(self.raw)
            .subresource_range(range)];
        let (from, to, none) = (from.stages, to.stages, vk::DependencyFlags::empty());
        // SAFETY: a live image in the state that the caller gives.
        unsafe { self.gpu.device.cmd_pipeline_barrier(commands, from, to, none, &[], &[], &barrier) };
    }

    /// Writes a whole layer, in the format's own encoding, and leaves it ready for `after`.
    pub fn upload(&self, layer: u32, bytes: &[u8], after: ImageState) {
        self.gpu.with_buffer(bytes.to_vec(), |buffer| {
            self.gpu.run(|commands| {
                self.barrier(commands, layer, ImageState::DISCARDED, WRITTEN);
                let (layout, copy) = (WRITTEN.layout, self.whole(layer));
                // SAFETY: buffer and image of one size, in the layout that the barrier makes.
                unsafe {
                    self.gpu.device.cmd_copy_buffer_to_image(commands, buffer, self.raw, layout, &copy);
                }
                self.barrier(commands, layer, WRITTEN, after);
            });
        });
    }

    /// Reads a whole layer, in the format's own encoding, and restores its state.
    pub fn read(&self, layer: u32, state: ImageState, bytes_per_pixel: usize) -> Vec<u8> {
        self.read_aspect(self.copied(layer), state, bytes_per_pixel)
    }

    /// Reads the stencil of a layer, with rows from the bottom.
    pub fn read_stencil(&self, layer: u32, state: ImageState) -> Vec<u8> {
        let stencil = vk::ImageAspectFlags::STENCIL;
        let part = vk::ImageSubresourceLayers { aspect_mask: stencil, ..self.copied(layer) };
        flipped(&self.read_aspect(part, state, 1), self.size[1])
    }

    fn read_aspect(
        &self,
        part: vk::ImageSubresourceLayers,
        state: ImageState,
        bytes_per_pixel: usize,
    ) -> Vec<u8> {
        let layer = part.base_array_layer;
        self.gpu.with_buffer(vec![0; self.pixels() * bytes_per_pixel], |buffer| {
            self.gpu.run(|commands| {
                self.barrier(commands, layer, state, READ);
                let [whole] = self.whole(layer);
                let (layout, copy) = (READ.layout, [whole.image_subresource(part)]);
                // SAFETY: as in `upload`.
                unsafe {
                    self.gpu.device.cmd_copy_image_to_buffer(commands, self.raw, layout, buffer, &copy);
                }
                self.barrier(commands, layer, READ, state);
            });
        })
    }

    /// Copies a layer of another image, converting between formats.
    fn blit_from(&self, layer: u32, from: &Image, from_layer: u32, [before, after]: [ImageState; 2]) {
        self.gpu.run(|commands| {
            from.barrier(commands, from_layer, before, READ);
            self.barrier(commands, layer, ImageState::DISCARDED, WRITTEN);
            let [x, y] = self.size.map(|n| n as i32);
            let corners = [vk::Offset3D::default(), vk::Offset3D { x, y, z: 1 }];
            let blit = [vk::ImageBlit {
                src_subresource: from.copied(from_layer),
                src_offsets: corners,
                dst_subresource: self.copied(layer),
                dst_offsets: corners,
            }];
            let (read, written) = (READ.layout, WRITTEN.layout);
            // SAFETY: live images of one size in these layouts.
            unsafe {
                self.gpu.device.cmd_blit_image(
                    commands,
                    from.raw,
                    read,
                    self.raw,
                    written,
                    &blit,
                    vk::Filter::NEAREST,
                );
            }
            from.barrier(commands, from_layer, READ, before);
            self.barrier(commands, layer, WRITTEN, after);
        });
    }

    /// Fills a colour layer with RGBA bytes, with rows from the bottom. sRGB images store them unchanged.
    pub fn upload_rgba8(&self, layer: u32, rgba: &[u8], after: ImageState) {
        let bytes = flipped(rgba, self.size[1]);
        if is_rgba8(self.format) {
            return self.upload(layer, &bytes, after);
        }
        let plain = self.gpu.image(vk::Format::R8G8B8A8_UNORM, self.size, 1);
        plain.upload(0, &bytes, READ);
        self.blit_from(layer, &plain, 0, [READ, after]);
    }

    /// Reads a colour layer as RGBA bytes, with rows from the bottom.
    pub fn read_rgba8(&self, layer: u32, state: ImageState) -> Vec<u8> {
        if is_rgba8(self.format) {
            return flipped(&self.read(layer, state, 4), self.size[1]);
        }
        let plain = self.gpu.image(vk::Format::R8G8B8A8_UNORM, self.size, 1);
        plain.blit_from(0, self, layer, [state, READ]);
        flipped(&plain.read(0, READ, 4), self.size[1])
    }

    /// Fills a depth layer, with rows from the bottom.
    pub fn upload_depth(&self, layer: u32, depth: &[f32], after: ImageState) {
        let texel = |depth: &f32| -> Vec<u8> {
            match self.format {
                vk::Format::D16_UNORM | vk::Format::R16_UNORM => {
                    ((depth * 65535.0).round() as u16).to_ne_bytes().to_vec()
                }
                vk::Format::D24_UNORM_S8_UINT => {
                    ((f64::from(*depth) * 16_777_215.0).round() as u32).to_ne_bytes().to_vec()
                }
                _ => depth.to_ne_bytes().to_vec(),
            }
        };
        let bytes: Vec<u8> = depth.iter().flat_map(texel).collect();
        self.upload(layer, &flipped(&bytes, self.size[1]), after);
    }

    /// Reads a depth layer, with rows from the bottom.
    pub fn read_depth(&self, layer: u32, state: ImageState) -> Vec<f32> {
        let size = if self.format == vk::Format::D16_UNORM { 2 } else { 4 };
        let bytes = flipped(&self.read(layer, state, size), self.size[1]);
        let value = |texel: &[u8]| match self.format {
            vk::Format::D16_UNORM => f32::from(u16::from_ne_bytes(texel.try_into().unwrap())) / 65535.0,
            vk::Format::D24_UNORM_S8_UINT => {
                (u32::from_ne_bytes(texel.try_into().unwrap()) & 0x00ff_ffff) as f32 / 16_777_215.0
            }
            _ => f32::from_ne_bytes(texel.try_into().unwrap()),
        };
        bytes.chunks_exact(size).map(value).collect()
    }
}

impl Drop for Image<'_> {
    fn drop(&mut self) {
        // SAFETY: everything was executed.
        unsafe {
            self.gpu.device.destroy_image(self.raw, None);
            self.gpu.device.free_memory(self.memory, None);
        }
    }
}

pub const WRITTEN: ImageState = ImageState {
    layout: vk::ImageLayout::TRANSFER_DST_OPTIMAL,
    stages: vk::PipelineStageFlags::TRANSFER,
    access: vk::AccessFlags::TRANSFER_WRITE,
};
pub const READ: ImageState = ImageState {
    layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
    stages: vk::PipelineStageFlags::TRANSFER,
    access: vk::AccessFlags::TRANSFER_READ,
};

/// Returns the largest source and target sizes of several warps.
pub fn largest(warps: &[impl WarpKind]) -> [[u32; 2]; 2] {
    let most =
        |image: usize| [0, 1].map(|i| warps.iter().map(|warp| warp.sizes()[image][i]).max().unwrap_or(1));
    [0, 1].map(most)
}
