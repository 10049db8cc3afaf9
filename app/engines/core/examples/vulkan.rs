//! Uses yoro in an engine on Vulkan: the engine has one eye in its own images, and yoro records the passes that write
//! the other eye into the engine's command buffer.
//!
//! `cargo run -p yoro --features vulkan --example vulkan` writes `out/vulkan.png`, with the synthesized left eye and
//! the right eye side by side, and prints how similar the left one is to a real render of it.

use std::path::Path;

use anyhow::{Context as _, Result};
use glam::Vec3;
use image::{Rgb, RgbImage};
use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, Frustum, GuardBand, MEAN_IPD, Pose, View};
use yoro::vulkan::ash::{self, vk};
use yoro::vulkan::{Frame, Gather, Host, ImageState, LayerImage, Options, SourceImages, TargetImages};

const SIZE: [u32; 2] = [768, 768];
const COLOR: vk::Format = vk::Format::R8G8B8A8_UNORM;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

fn main() -> Result<()> {
    // SAFETY: loading the library has no side effects.
    let entry = unsafe { ash::Entry::load() }.context("no Vulkan loader is here: install libvulkan1")?;
    let engine = Engine::new(&entry)?;

    // The eyes' poses, and the meaning of the depth buffer. With OpenXR, poses and frusta are those of the two views.
    let depth = DepthRange { near: 0.1, far: f32::INFINITY, convention: DepthConvention::Reversed };
    let head = Pose { position: Vec3::new(0.0, 1.6, 2.0), ..Pose::IDENTITY };
    let pair = EyePair::parallel(
        head,
        Frustum::symmetric(75f32.to_radians(), 1.0),
        MEAN_IPD,
        depth,
        SIZE,
        Eye::Right,
    );
    let views = pair.synthesis_views(GuardBand::Distance(0.7))?;

    // The engine's images: the view to render is wider than the eye, by the guard band.
    let source = Picture::new(&views.source);
    let sampled = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    let drawn = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
    let (source_size, target_size) = (views.source.size, views.target.size);
    let color = engine.image(COLOR, source_size, sampled)?;
    let depth = engine.image(DEPTH, source_size, sampled)?;
    let target = engine.image(COLOR, target_size, drawn)?;

    // Once: pipelines and buffers, then views and descriptors of the images. An engine that renders the source would
    // use `ImageState::COLOR_ATTACHMENT` and `DEPTH_ATTACHMENT`; this one uploads it.
    let uploaded = ImageState {
        layout: vk::ImageLayout::TRANSFER_DST_OPTIMAL,
        stages: vk::PipelineStageFlags::TRANSFER,
        access: vk::AccessFlags::TRANSFER_WRITE,
    };
    let downloaded = ImageState {
        layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        stages: vk::PipelineStageFlags::TRANSFER,
        access: vk::AccessFlags::TRANSFER_READ,
    };
    let options = Options {
        color_format: COLOR,
        max_source_size: source_size,
        max_target_size: target_size,
        ..Options::default()
    };
    let layer = |image: &Image, format, before, after| LayerImage {
        image: image.raw,
        format,
        layer: 0,
        before,
        after,
    };
    // SAFETY: handles of one device, and images that live until all commands have been executed.
    let (mut gather, frame) = unsafe {
        let mut gather = Gather::new(&engine.host(), &options)?;
        let color = layer(&color, COLOR, uploaded, ImageState::SAMPLED);
        let depth = layer(&depth, DEPTH, uploaded, ImageState::SAMPLED);
        let source = gather.register_source(&SourceImages::new(color, depth, source_size))?;
        let target = layer(&target, COLOR, ImageState::DISCARDED, downloaded);
        let target = gather.register_target(&TargetImages::new(target, target_size))?;
        (gather, Frame::new(source, target))
    };

    // Each frame, in the engine's own command buffer.
    let pixels = (target_size[0] * target_size[1]) as usize * 4;
    let (mut colors, mut depths) =
        (engine.buffer(source.rgba.len())?, engine.buffer(source.depth.len() * 4)?);
    colors.write(&source.rgba);
    depths.write(bytemuck::cast_slice(&source.depth));
    let result = engine.buffer(pixels)?;
    engine.submit(|commands| {
        engine.upload(commands, &colors, &color, vk::ImageAspectFlags::COLOR);
        engine.upload(commands, &depths, &depth, vk::ImageAspectFlags::DEPTH);
        // SAFETY: the buffer is recording, outside of render passes, and the images are in the registered states.
        unsafe { gather.record(commands, &frame, &views.warp) }?;
        engine.download(commands, &target, &result);
        Ok(())
    })?;
    let left = picture(&result.read(), target_size, [0, 0]);
    drop(gather);

    // The rendered eye's own image is the part of the source that starts at this corner.
    let right = picture(&source.rgba, source_size, views.dominant_crop_from_top());
    let path = Path::new("out/vulkan.png");
    let mut both = RgbImage::new(2 * SIZE[0], SIZE[1]);
    image::imageops::replace(&mut both, &left, 0, 0);
    image::imageops::replace(&mut both, &right, i64::from(SIZE[0]), 0);
    std::fs::create_dir_all("out")?;
    let unfinished = path.with_extension("tmp");
    both.save_with_format(&unfinished, image::ImageFormat::Png)?;
    std::fs::rename(unfinished, path)?;
    println!("{}: left eye synthesized on {}, right eye rendered", path.display(), engine.name);

    // Do this once in every integration: a wrong sign, a flipped row or a misread depth costs more than 10 dB.
    let truth = picture(&Picture::new(&views.target).rgba, target_size, [0, 0]);
    println!(
        "against the left eye rendered: {:.2} dB; the right eye in its place: {:.2} dB",
        psnr(&left, &truth),
        psnr(&right, &truth)
    );
    Ok(())
}

/// Returns the peak signal-to-noise ratio over red, green and blue, in decibels.
fn psnr(image: &RgbImage, truth: &RgbImage) -> f64 {
    let squares = image.iter().zip(truth.iter()).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2));
    10.0 * (255f64.powi(2) * truth.len() as f64 / squares.sum::<f64>()).log10()
}

/// Returns the part of an RGBA image, with row 0 at the top, that starts at a corner.
fn picture(rgba: &[u8], size: [u32; 2], [left, top]: [u32; 2]) -> RgbImage {
    RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| {
        let i = ((y + top) * size[0] + x + left) as usize * 4;
        Rgb([rgba[i], rgba[i + 1], rgba[i + 2]])
    })
}

/// A substitute for an engine's picture: rays cast into a tiled room with balls. Row 0 is at the top, as in Vulkan.
struct Picture {
    rgba: Vec<u8>,
    depth: Vec<f32>,
}

impl Picture {
    fn new(view: &View) -> Picture {
        let [w, h] = view.size;
        let (mut rgba, mut depth) = (Vec::new(), Vec::new());
        let frustum = &view.frustum;
        for i in 0..w * h {
            let (x, y) = ((i % w) as f32 + 0.5, (i / w) as f32 + 0.5);
            let ray = Vec3::new(
                frustum.left + frustum.width() * x / w as f32,
                frustum.top - frustum.height() * y / h as f32,
                -1.0,
            );
            let (color, distance) = trace(view.pose.position, view.pose.orientation * ray);
            rgba.extend(color.to_array().map(|value| (value.clamp(0.0, 1.0) * 255.0) as u8));
            rgba.push(255);
            // The ray's length along the viewing axis is 1.
            depth.push(view.depth.depth(distance));
        }
        Picture { rgba, depth }
    }
}

/// Returns the colour that a ray hits, and its distance in lengths of the ray.
fn trace(eye: Vec3, ray: Vec3) -> (Vec3, f32) {
    let walls = (ray.signum() * Vec3::new(3.0, 3.0, 5.0) - eye) / ray;
    let mut nearest = walls.min_element();
    let on_wall = (eye + ray * nearest * 0.999) * 2.0;
    let tile = on_wall.floor().as_ivec3();
    let is_light = (tile.x + tile.y + tile.z) & 1 == 0;
    let mut color = if is_light { Vec3::new(0.75, 0.72, 0.66) } else { Vec3::new(0.32, 0.38, 0.45) };
    for i in 0..7 {
        let (angle, i) = (0.9 * i as f32, i as f32);
        let center = Vec3::new(1.5 * angle.sin(), 1.6 + 0.9 * (1.7 * angle).cos(), 0.9 - 0.8 * i);
        let (radius, to_eye) = (0.2 + 0.05 * i, eye - center);
        let (a, b) = (ray.length_squared(), to_eye.dot(ray));
        let discriminant = b * b - a * (to_eye.length_squared() - radius * radius);
        let distance = (-b - discriminant.max(0.0).sqrt()) / a;
        if discriminant > 0.0 && distance > 0.0 && distance < nearest {
            nearest = distance;
            let normal = (eye + ray * distance - center) / radius;
            let light = 0.45 + 0.55 * normal.dot(Vec3::new(0.36, 0.8, 0.48)).max(0.0);
            color = (0.5 + 0.45 * (Vec3::new(0.0, 2.1, 4.2) + i).map(f32::cos)) * light;
        }
    }
    (color, nearest)
}

/// A minimal engine. [`Engine::submit`] returns when everything has been executed, so that no object is in use when it
/// is destroyed.
struct Engine {
    name: String,
    instance: ash::Instance,
    physical_device: vk::PhysicalDevice,
    device: ash::Device,
    family: u32,
    queue: vk::Queue,
    pool: vk::CommandPool,
    memory: vk::PhysicalDeviceMemoryProperties,
}

struct Image<'a> {
    engine: &'a Engine,
    raw: vk::Image,
    memory: vk::DeviceMemory,
    size: [u32; 2],
}

/// Memory that both the CPU and the GPU access.
struct Buffer<'a> {
    engine: &'a Engine,
    raw: vk::Buffer,
    memory: vk::DeviceMemory,
    mapped: *mut u8,
    size: usize,
}

impl Engine {
    fn new(entry: &ash::Entry) -> Result<Engine> {
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_1);
        let info = vk::InstanceCreateInfo::default().application_info(&application);
        // SAFETY: the descriptions are valid, and handles are used only while they live.
        unsafe {
            let instance = entry.create_instance(&info, None).context("no Vulkan instance")?;
            let devices = instance.enumerate_physical_devices()?;
            let physical_device = *devices.first().context("no Vulkan device: install a driver")?;
            let families = instance.get_physical_device_queue_family_properties(physical_device);
            let draws =
                |family: &vk::QueueFamilyProperties| family.queue_flags.contains(vk::QueueFlags::GRAPHICS);
            let family = families.iter().position(draws).context("the device draws nothing")? as u32;
            let queues =
                [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
            let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues);
            let device = instance.create_device(physical_device, &info, None)?;
            let pool = vk::CommandPoolCreateInfo::default().queue_family_index(family);
            let properties = instance.get_physical_device_properties(physical_device);
            Ok(Engine {
                name: properties.device_name_as_c_str()?.to_string_lossy().into_owned(),
                queue: device.get_device_queue(family, 0),
                pool: device.create_command_pool(&pool, None)?,
                memory: instance.get_physical_device_memory_properties(physical_device),
                instance,
                physical_device,
                device,
                family,
            })
        }
    }

    fn host(&self) -> Host<'_> {
        Host {
            instance: &self.instance,
            physical_device: self.physical_device,
            device: &self.device,
            queue_family: self.family,
            dynamic_rendering: false,
            debug_utils: false,
        }
    }

    fn allocate(
        &self,
        needed: vk::MemoryRequirements,
        properties: vk::MemoryPropertyFlags,
    ) -> Result<vk::DeviceMemory> {
        let types = &self.memory.memory_types[..self.memory.memory_type_count as usize];
        let fits = |i: &usize| {
            needed.memory_type_bits >> i & 1 != 0 && types[*i].property_flags.contains(properties)
        };
        let index = (0..types.len()).find(fits).context("no such memory")? as u32;
        let info = vk::MemoryAllocateInfo::default().allocation_size(needed.size).memory_type_index(index);
        // SAFETY: a valid description.
        Ok(unsafe { self.device.allocate_memory(&info, None)? })
    }

    fn image(&self, format: vk::Format, size: [u32; 2], usage: vk::ImageUsageFlags) -> Result<Image<'_>> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width: size[0], height: size[1], depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(usage);
        // SAFETY: a valid description, and newly allocated memory.
        unsafe {
            let raw = self.device.create_image(&info, None)?;
            let needed = self.device.get_image_memory_requirements(raw);
            let memory = self.allocate(needed, vk::MemoryPropertyFlags::DEVICE_LOCAL)?;
            self.device.bind_image_memory(raw, memory, 0)?;
            Ok(Image { engine: self, raw, memory, size })
        }
    }

    fn buffer(&self, size: usize) -> Result<Buffer<'_>> {
        let usage = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
        let info = vk::BufferCreateInfo::default().size(size as u64).usage(usage);
        let visible = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        // SAFETY: a valid description, and newly allocated memory.
        unsafe {
            let raw = self.device.create_buffer(&info, None)?;
            let memory = self.allocate(self.device.get_buffer_memory_requirements(raw), visible)?;
            self.device.bind_buffer_memory(raw, memory, 0)?;
            let mapped = self.device.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())?;
            Ok(Buffer { engine: self, raw, memory, mapped: mapped.cast(), size })
        }
    }

    /// Records and submits commands, and waits for them.
    fn submit(&self, record: impl FnOnce(vk::CommandBuffer) -> Result<()>) -> Result<()> {
        let info = vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: one command buffer, which is executed when this returns.
        unsafe {
            let commands = self.device.allocate_command_buffers(&info)?;
            self.device.begin_command_buffer(commands[0], &begin)?;
            record(commands[0])?;
            self.device.end_command_buffer(commands[0])?;
            let submit = [vk::SubmitInfo::default().command_buffers(&commands)];
            self.device.queue_submit(self.queue, &submit, vk::Fence::null())?;
            Ok(self.device.queue_wait_idle(self.queue)?)
        }
    }

    /// Fills an image, and leaves it in TRANSFER_DST_OPTIMAL.
    fn upload(
        &self,
        commands: vk::CommandBuffer,
        buffer: &Buffer,
        image: &Image,
        aspect_mask: vk::ImageAspectFlags,
    ) {
        let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        let range =
            vk::ImageSubresourceRange { aspect_mask, level_count: 1, layer_count: 1, ..Default::default() };
        let barrier = [vk::ImageMemoryBarrier::default()
            .dst_access_mask(vk::AccessFlags::TRANSFER_WRITE)
            .new_layout(layout)
            .image(image.raw)
            .subresource_range(range)];
        let (before, after) = (vk::PipelineStageFlags::TOP_OF_PIPE, vk::PipelineStageFlags::TRANSFER);
        let none = vk::DependencyFlags::empty();
        let copy = [image.copy(aspect_mask)];
        // SAFETY: live objects; the buffer is as long as the image.
        unsafe {
            self.device.cmd_pipeline_barrier(commands, before, after, none, &[], &[], &barrier);
            self.device.cmd_copy_buffer_to_image(commands, buffer.raw, image.raw, layout, &copy);
        }
    }

    /// Reads an image that is in TRANSFER_SRC_OPTIMAL.
    fn download(&self, commands: vk::CommandBuffer, image: &Image, buffer: &Buffer) {
        let (layout, copy) =
            (vk::ImageLayout::TRANSFER_SRC_OPTIMAL, [image.copy(vk::ImageAspectFlags::COLOR)]);
        let barrier = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
            .dst_access_mask(vk::AccessFlags::HOST_READ)];
        let (before, after) = (vk::PipelineStageFlags::TRANSFER, vk::PipelineStageFlags::HOST);
        let none = vk::DependencyFlags::empty();
        // SAFETY: live objects; the buffer is as long as the image.
        unsafe {
            self.device.cmd_copy_image_to_buffer(commands, image.raw, layout, buffer.raw, &copy);
            self.device.cmd_pipeline_barrier(commands, before, after, none, &barrier, &[], &[]);
        }
    }
}

impl Image<'_> {
    fn copy(&self, aspect_mask: vk::ImageAspectFlags) -> vk::BufferImageCopy {
        let [width, height] = self.size;
        let whole = vk::ImageSubresourceLayers { aspect_mask, layer_count: 1, ..Default::default() };
        let extent = vk::Extent3D { width, height, depth: 1 };
        vk::BufferImageCopy::default().image_subresource(whole).image_extent(extent)
    }
}

impl Buffer<'_> {
    fn write(&mut self, bytes: &[u8]) {
        assert_eq!(bytes.len(), self.size);
        // SAFETY: mapped memory of this length, which no pending command uses.
        unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), self.mapped, self.size) }
    }

    fn read(&self) -> Vec<u8> {
        // SAFETY: mapped memory of this length, which no pending command writes.
        unsafe { std::slice::from_raw_parts(self.mapped, self.size).to_vec() }
    }
}

impl Drop for Image<'_> {
    fn drop(&mut self) {
        // SAFETY: created once, and not in use.
        unsafe {
            self.engine.device.destroy_image(self.raw, None);
            self.engine.device.free_memory(self.memory, None);
        }
    }
}

impl Drop for Buffer<'_> {
    fn drop(&mut self) {
        // SAFETY: created once, and not in use.
        unsafe {
            self.engine.device.destroy_buffer(self.raw, None);
            self.engine.device.free_memory(self.memory, None);
        }
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        // SAFETY: images, buffers and pipelines have been destroyed before.
        unsafe {
            self.device.destroy_command_pool(self.pool, None);
            self.device.destroy_device(None);
            self.instance.destroy_instance(None);
        }
    }
}
