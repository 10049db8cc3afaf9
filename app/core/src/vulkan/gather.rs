//! The fragment passes.

use std::ffi::CStr;
use std::sync::Arc;
use std::time::Duration;

use ash::vk;

use super::objects::{Object, Objects, range};
use super::{
    Frame, Host, ImageState, LayerImage, Options, PassTimes, SourceId, SourceImages, TargetId, TargetImages,
    VulkanError, shaders,
};
use crate::eyes::Warp;
use crate::synthesis::{Edges, Places, Uniforms, tiles};

/// Format of the intermediate maps, which every device samples and renders to.
const MAP_FORMAT: vk::Format = vk::Format::R32_UINT;
/// Bindings of the descriptor set, as `TEXTURE` in the shaders counts them: depth, colour, tile map, span map; layers and
/// colour of their backs, but for hard edges; colour of the samples, where the source has them.
const TEXTURES: usize = 7;
/// Timestamps of a frame: before the first pass, and after each of four.
const STAMPS: u32 = 5;

/// How the shaders are written for a kind of device; see [`crate::synthesis::GatherVariant`].
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GatherVariant {
    /// A CPU rasterizer.
    Software,
    /// A GPU.
    ShortWay,
}

/// Tile bounds, tile spans, march, as [`crate::synthesis::Gather`]; of anti-aliased sources the split into layers before
/// them, as [`crate::synthesis::Layers`].
///
/// Its methods are called from one thread at a time, and what it records is executed in the order of recording by
/// queues of one family, one after the other: all frames share the intermediate buffers, which barriers guard.
pub struct Gather {
    instance: ash::Instance,
    physical_device: vk::PhysicalDevice,
    device: Arc<ash::Device>,
    options: Options,
    rendering: Rendering,
    set_layout: vk::DescriptorSetLayout,
    pipeline_layout: vk::PipelineLayout,
    /// None for hard edges.
    split: Option<Split>,
    /// Whole sources and parts of them, as `PART` in the shaders.
    bounds: [vk::Pipeline; 2],
    spans: vk::Pipeline,
    march: [vk::Pipeline; 2],
    tile_map: Map,
    span_map: Map,
    timer: Option<Timer>,
    labels: Option<Labels>,
    sources: Vec<Source>,
    targets: Vec<Target>,
    /// The id that was given out last.
    last_id: u32,
    // Last: dropped after the objects of sources and targets.
    _objects: Objects,
}

/// How a pass begins and ends.
enum Rendering {
    Dynamic { begin: vk::PFN_vkCmdBeginRendering, end: vk::PFN_vkCmdEndRendering },
    Passes { map: vk::RenderPass, layers: vk::RenderPass, target: vk::RenderPass },
}

/// What a pass draws into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Into {
    /// One 32-bit integer a tile.
    Map,
    /// Two colour attachments: what each pixel of the source shows, and the colour of what is behind.
    Layers,
    Target,
}

/// The first pass of anti-aliased sources; pipelines for whole sources and parts of them.
struct Split {
    resolved: [vk::Pipeline; 2],
    /// For sources with the samples' colours.
    samples: Option<[vk::Pipeline; 2]>,
    layers: Map,
}

/// What passes draw into: views for dynamic rendering, a framebuffer of them for render passes.
#[derive(Clone, Copy)]
struct Attachments {
    /// The second one of [`Into::Layers`] alone.
    colors: [vk::ImageView; 2],
    depth: Option<vk::ImageView>,
    framebuffer: vk::Framebuffer,
}

/// What one pass leaves for the next ones.
struct Map {
    images: Vec<vk::Image>,
    attachments: Attachments,
    /// Width and height in tiles, of layers in pixels.
    size: [u32; 2],
    /// Memory that its texels take.
    bytes: u64,
}

struct Source {
    id: SourceId,
    images: SourceImages,
    set: vk::DescriptorSet,
    _objects: Objects,
}

struct Target {
    id: TargetId,
    images: TargetImages,
    attachments: Attachments,
    _objects: Objects,
}

/// A ring of timestamps.
struct Timer {
    pool: vk::QueryPool,
    frames: u32,
    recorded: u64,
    /// Nanoseconds of a tick.
    period: f64,
    /// The bits that count.
    mask: u64,
}

/// Groups of commands that debuggers show: VK_EXT_debug_utils, where the instance has it enabled.
struct Labels {
    begin: vk::PFN_vkCmdBeginDebugUtilsLabelEXT,
    end: vk::PFN_vkCmdEndDebugUtilsLabelEXT,
}

impl Gather {
    /// Makes pipelines and intermediate buffers: all that does not depend on the images.
    ///
    /// # Errors
    /// [`VulkanError::Format`], [`VulkanError::Size`], [`VulkanError::QueueFamily`] and
    /// [`VulkanError::DynamicRendering`] for what the device cannot; those of Vulkan's commands.
    ///
    /// # Safety
    /// The host's handles are valid and belong together, and the device is destroyed only after this. When this is
    /// dropped, no command that it has recorded is pending.
    pub unsafe fn new(host: &Host, options: &Options) -> Result<Gather, VulkanError> {
        // SAFETY: a valid physical device.
        let properties = unsafe { host.instance.get_physical_device_properties(host.physical_device) };
        let variant = match properties.device_type {
            vk::PhysicalDeviceType::CPU => GatherVariant::Software,
            _ => GatherVariant::ShortWay,
        };
        // SAFETY: promised by the caller.
        unsafe { Gather::with_variant(host, options, variant) }
    }

    /// As [`Gather::new`], as on another kind of device: for tests of what this one would not take.
    ///
    /// # Errors
    /// As [`Gather::new`].
    ///
    /// # Safety
    /// As [`Gather::new`].
    #[doc(hidden)]
    pub unsafe fn with_variant(
        host: &Host,
        options: &Options,
        variant: GatherVariant,
    ) -> Result<Gather, VulkanError> {
        let (instance, physical_device) = (host.instance, host.physical_device);
        // SAFETY: a valid physical device.
        let (properties, families) = unsafe {
            (
                instance.get_physical_device_properties(physical_device),
                instance.get_physical_device_queue_family_properties(physical_device),
            )
        };
        let family = families
            .get(host.queue_family as usize)
            .filter(|family| family.queue_flags.contains(vk::QueueFlags::GRAPHICS))
            .ok_or(VulkanError::QueueFamily(host.queue_family))?;
        let limit = [properties.limits.max_image_dimension2_d; 2];
        for (what, size) in
            [("a largest source", options.max_source_size), ("a largest target", options.max_target_size)]
        {
            check_size(what, size, limit)?;
        }
        let renders =
            |format, features, role| check_format(instance, physical_device, format, features, role);
        // Integers cannot be blended, which excludes them here.
        renders(options.color_format, vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND, "a target's colour")?;
        if let Some(format) = options.depth_format {
            renders(format, vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT, "a target's depth")?;
        }
        if options.edges == Edges::Multisample {
            check_samples(options.samples, &properties.limits)?;
        }

        let device = Arc::new(host.device.clone());
        let mut objects = Objects::new(&device);
        // SAFETY: promised by the caller.
        let rendering = unsafe { Rendering::new(host, &mut objects, options)? };
        let set_layout = set_layout(&mut objects)?;
        let pipeline_layout = pipeline_layout(&mut objects, set_layout)?;
        let mut making = Making {
            objects: &mut objects,
            // Shaders are not needed after pipelines are made of them.
            shaders: Objects::new(&device),
            rendering: &rendering,
            layout: pipeline_layout,
            options,
        };
        let depth = options.depth_format.is_some();
        let bounds = making.pipelines(shaders::tiles(options.edges), Into::Map)?;
        let spans = making.pipeline(shaders::SPANS, Into::Map, false)?;
        let march = making.pipelines(shaders::march(options.edges, variant, depth), Into::Target)?;
        let resolved =
            shaders::split(options.edges).map(|shader| making.pipelines(shader, Into::Layers)).transpose()?;
        let samples = (options.edges == Edges::Multisample)
            .then(|| making.pipelines(shaders::SPLIT_SAMPLES, Into::Layers))
            .transpose()?;
        drop(making);
        // SAFETY: a valid physical device.
        let memory = unsafe { instance.get_physical_device_memory_properties(physical_device) };
        let [source, target] = [options.max_source_size, options.max_target_size];
        let mut map = |into, size| {
            let formats = into_formats(into, options);
            Map::new(&mut objects, &rendering, &memory, into, formats.as_slice(), size)
        };
        let tile_map = map(Into::Map, tiles(source))?;
        let span_map = map(Into::Map, tiles([target[0], source[1]]))?;
        let split = match resolved {
            Some(resolved) => Some(Split { resolved, samples, layers: map(Into::Layers, source)? }),
            None => None,
        };
        let timer = Timer::new(&mut objects, options.timed_frames, family, &properties.limits)?;
        // SAFETY: promised by the caller.
        let labels = unsafe { Labels::new(host) };
        Ok(Gather {
            instance: instance.clone(),
            physical_device,
            device,
            options: *options,
            rendering,
            set_layout,
            pipeline_layout,
            split,
            bounds,
            spans,
            march,
            tile_map,
            span_map,
            timer,
            labels,
            sources: Vec::new(),
            targets: Vec::new(),
            last_id: 0,
            _objects: objects,
        })
    }

    /// Makes views and descriptors of images to read from.
    ///
    /// # Errors
    /// [`VulkanError::Format`] and [`VulkanError::Size`]; those of Vulkan's commands.
    ///
    /// # Safety
    /// The images are as [`SourceImages`] and [`LayerImage`] say, and live until this id is released or the pipeline is
    /// dropped.
    pub unsafe fn register_source(&mut self, images: &SourceImages) -> Result<SourceId, VulkanError> {
        // SAFETY: a valid physical device.
        let properties = unsafe { self.instance.get_physical_device_properties(self.physical_device) };
        check_size("a source's image", images.size, [properties.limits.max_image_dimension2_d; 2])?;
        let (color, depth) = (&images.color, &images.depth);
        let sampled = vk::FormatFeatureFlags::SAMPLED_IMAGE;
        let filtered = sampled | vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
        let check = |format, features, role| {
            check_format(&self.instance, self.physical_device, format, features, role)
        };
        check(color.format, filtered, "a source's colour")?;
        let is_depth = aspects(depth.format).contains(vk::ImageAspectFlags::DEPTH);
        if !is_depth && depth.format != vk::Format::R32_SFLOAT {
            return Err(VulkanError::Format { format: depth.format, role: "a source's depth" });
        }
        check(depth.format, sampled, "a source's depth")?;
        if images.sample_color.is_some() && self.options.edges != Edges::Multisample {
            return Err(VulkanError::SampleColors);
        }

        let mut objects = Objects::new(&self.device);
        let color_aspect = vk::ImageAspectFlags::COLOR;
        let depth_aspect = if is_depth { vk::ImageAspectFlags::DEPTH } else { color_aspect };
        // SAFETY: promised by the caller.
        let [color_view, depth_view] = unsafe {
            [
                objects.view(color.image, color.format, color_aspect, color.layer)?,
                objects.view(depth.image, depth.format, depth_aspect, depth.layer)?,
            ]
        };
        let samples = images.sample_color.as_ref();
        let sample_view = samples.map(|samples| {
            // SAFETY: promised by the caller.
            unsafe { objects.view(samples.image, samples.format, color_aspect, samples.layer) }
        });
        let sample_view = sample_view.transpose()?;
        let sizes = [vk::DescriptorPoolSize {
            ty: vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
            descriptor_count: TEXTURES as u32,
        }];
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        // SAFETY: a valid description.
        let pool = unsafe { self.device.create_descriptor_pool(&info, None) };
        let pool = objects.keep("vkCreateDescriptorPool", pool, Object::DescriptorPool)?;
        let layouts = [self.set_layout];
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
        let mut set = vk::DescriptorSet::null();
        // SAFETY: room for the one set that is asked for; the pool is new.
        let result = unsafe {
            (self.device.fp_v1_0().allocate_descriptor_sets)(self.device.handle(), &info, &mut set)
        };
        result.result().map_err(|result| VulkanError::new("vkAllocateDescriptorSets", result))?;
        let texture =
            |view, layout| [vk::DescriptorImageInfo::default().image_view(view).image_layout(layout)];
        let map = |map: &Map, i: usize| texture(map.attachments.colors[i], ImageState::SAMPLED.layout);
        let layers = |i| self.split.as_ref().map(|split| map(&split.layers, i));
        // What is not written is in no shader of these edges.
        let textures: [_; TEXTURES] = [
            Some(texture(depth_view, sampled_state(depth).layout)),
            Some(texture(color_view, sampled_state(color).layout)),
            Some(map(&self.tile_map, 0)),
            Some(map(&self.span_map, 0)),
            layers(0),
            layers(1),
            sample_view.zip(samples).map(|(view, image)| texture(view, sampled_state(image).layout)),
        ];
        let written = textures.iter().enumerate().filter_map(|(binding, texture)| {
            Some(
                vk::WriteDescriptorSet::default()
                    .dst_set(set)
                    .dst_binding(binding as u32)
                    .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
                    .image_info(texture.as_ref()?),
            )
        });
        let writes: Vec<_> = written.collect();
        // SAFETY: live views, and a set that nothing uses yet.
        unsafe { self.device.update_descriptor_sets(&writes, &[]) };
        let id = SourceId(self.next_id());
        self.sources.push(Source { id, images: *images, set, _objects: objects });
        Ok(id)
    }

    /// Makes views, and a framebuffer where render passes are used, of images to write.
    ///
    /// # Errors
    /// [`VulkanError::OtherFormat`] and [`VulkanError::Size`]; those of Vulkan's commands.
    ///
    /// # Safety
    /// The images are as [`TargetImages`] and [`LayerImage`] say, and live until this id is released or the pipeline is
    /// dropped.
    pub unsafe fn register_target(&mut self, images: &TargetImages) -> Result<TargetId, VulkanError> {
        let format = |depth: Option<vk::Format>| depth.unwrap_or(vk::Format::UNDEFINED);
        for (expected, found) in [
            (self.options.color_format, images.color.format),
            (format(self.options.depth_format), format(images.depth.map(|depth| depth.format))),
        ] {
            if expected != found {
                return Err(VulkanError::OtherFormat { expected, found });
            }
        }
        // SAFETY: a valid physical device.
        let properties = unsafe { self.instance.get_physical_device_properties(self.physical_device) };
        check_size("a target's image", images.size, [properties.limits.max_image_dimension2_d; 2])?;
        let mut objects = Objects::new(&self.device);
        let mut view = |image: &LayerImage| {
            // SAFETY: promised by the caller.
            unsafe { objects.view(image.image, image.format, aspects(image.format), image.layer) }
        };
        let color = view(&images.color)?;
        let depth = images.depth.as_ref().map(view).transpose()?;
        // SAFETY: live views of the formats that the render pass has.
        let attachments =
            unsafe { self.rendering.attachments(&mut objects, Into::Target, &[color], depth, images.size)? };
        let id = TargetId(self.next_id());
        self.targets.push(Target { id, images: *images, attachments, _objects: objects });
        Ok(id)
    }

    fn next_id(&mut self) -> u32 {
        self.last_id = self.last_id.checked_add(1).unwrap_or(1);
        self.last_id
    }

    /// Forgets images. An id that is not registered is ignored.
    ///
    /// # Safety
    /// No command that was recorded with it is pending.
    pub unsafe fn release_source(&mut self, id: SourceId) {
        self.sources.retain(|source| source.id != id);
    }

    /// As [`Gather::release_source`].
    ///
    /// # Safety
    /// As there.
    pub unsafe fn release_target(&mut self, id: TargetId) {
        self.targets.retain(|target| target.id != id);
    }

    /// Records the passes. Barriers bring the images from their [`LayerImage::before`] to what the passes need and on
    /// to their [`LayerImage::after`]; none is recorded where no layout changes and nothing was or will be written.
    ///
    /// Afterwards pipeline, descriptor set 0, push constants, viewport and scissor of the command buffer's graphics
    /// bind point are others.
    ///
    /// # Errors
    /// [`VulkanError::NotRegistered`], [`VulkanError::Size`] and [`VulkanError::Rectangle`], before anything is
    /// recorded.
    ///
    /// # Safety
    /// The command buffer is of this device, in the recording state, outside of render passes and dynamic rendering,
    /// and is submitted to the host's queue family. Where it is executed, the images are in the state
    /// [`LayerImage::before`], and conditional rendering is not active.
    pub unsafe fn record(
        &mut self,
        commands: vk::CommandBuffer,
        frame: &Frame,
        warp: &Warp,
    ) -> Result<(), VulkanError> {
        let source = self.sources.iter().find(|source| source.id == frame.source);
        let target = self.targets.iter().find(|target| target.id == frame.target);
        let (source, target) = source.zip(target).ok_or(VulkanError::NotRegistered)?;
        check_size("a source", warp.source_size, self.options.max_source_size)?;
        check_size("a target", warp.target_size, self.options.max_target_size)?;
        check_rectangle("a source", frame.source_origin, warp.source_size, source.images.size)?;
        check_rectangle("a target", frame.target_origin, warp.target_size, target.images.size)?;

        let warp = rows_from_top(warp);
        let tile_size = tiles(warp.source_size);
        let span_size = tiles([warp.target_size[0], warp.source_size[1]]);
        let whole = warp.source_size == source.images.size
            && tile_size == self.tile_map.size
            && span_size == self.span_map.size;
        let uniforms = Uniforms::of_part(
            &warp,
            &Places {
                source_origin: frame.source_origin,
                image_size: source.images.size,
                target_origin: frame.target_origin,
                part: !whole,
            },
        );
        let device = &*self.device;
        let read =
            [Some(&source.images.color), Some(&source.images.depth), source.images.sample_color.as_ref()];
        let read = || read.into_iter().flatten();
        let split = self.split.as_ref();
        let maps = [split.map(|split| &split.layers), Some(&self.tile_map), Some(&self.span_map)];
        let drawn = [Some((&target.images.color, ImageState::COLOR_ATTACHMENT))]
            .into_iter()
            .chain([target.images.depth.as_ref().map(|depth| (depth, ImageState::DEPTH_ATTACHMENT))])
            .flatten();
        // SAFETY: the caller's command buffer, this device's objects, and images in the states that are told. Barriers
        // stand between all that writes and all that reads.
        unsafe {
            self.timer.as_ref().inspect(|timer| timer.begin(device, commands));
            let mut barriers = Barriers::new();
            for image in read() {
                barriers.image(image, image.before, sampled_state(image));
            }
            for (image, state) in drawn.clone() {
                barriers.image(image, image.before, state);
            }
            for map in maps.into_iter().flatten() {
                // The frame before has read it.
                let read = ImageState { layout: vk::ImageLayout::UNDEFINED, ..ImageState::SAMPLED };
                barriers.map(map, read, ImageState::COLOR_ATTACHMENT);
            }
            barriers.record(device, commands);

            let (point, layout) = (vk::PipelineBindPoint::GRAPHICS, self.pipeline_layout);
            device.cmd_bind_descriptor_sets(commands, point, layout, 0, &[source.set], &[]);
            let (stage, bytes) = (vk::ShaderStageFlags::FRAGMENT, bytemuck::bytes_of(&uniforms));
            device.cmd_push_constants(commands, layout, stage, 0, bytes);

            let variant = usize::from(!whole);
            let split = split.map(|split| {
                let samples = split.samples.filter(|_| source.images.sample_color.is_some());
                samples.unwrap_or(split.resolved)[variant]
            });
            let passes = [
                (c"yoro split", split, maps[0], [0, 0], warp.source_size),
                (c"yoro tiles", Some(self.bounds[variant]), maps[1], [0, 0], tile_size),
                (c"yoro spans", Some(self.spans), maps[2], [0, 0], span_size),
                (c"yoro march", Some(self.march[variant]), None, frame.target_origin, warp.target_size),
            ];
            for (i, (name, pipeline, map, origin, size)) in passes.into_iter().enumerate() {
                if let Some(pipeline) = pipeline {
                    self.labels.as_ref().inspect(|labels| labels.begin(commands, name));
                    let into = [Into::Layers, Into::Map, Into::Map, Into::Target][i];
                    let attachments = map.map_or(&target.attachments, |map| &map.attachments);
                    self.rendering.begin(device, commands, attachments, into, area(origin, size));
                    device.cmd_bind_pipeline(commands, point, pipeline);
                    device.cmd_draw(commands, 3, 1, 0, 0);
                    self.rendering.end(device, commands);
                    if let Some(map) = map {
                        let mut barriers = Barriers::new();
                        barriers.map(map, ImageState::COLOR_ATTACHMENT, ImageState::SAMPLED);
                        barriers.record(device, commands);
                    }
                    self.labels.as_ref().inspect(|labels| labels.end(commands));
                }
                self.timer.as_ref().inspect(|timer| timer.stamp(device, commands, i as u32 + 1));
            }

            let mut barriers = Barriers::new();
            for image in read() {
                barriers.image(image, sampled_state(image), image.after);
            }
            for (image, state) in drawn {
                barriers.image(image, state, image.after);
            }
            barriers.record(device, commands);
        }
        if let Some(timer) = &mut self.timer {
            timer.recorded += 1;
        }
        Ok(())
    }

    /// Bytes of the intermediate buffers.
    pub fn buffer_bytes(&self) -> u64 {
        let layers = self.split.as_ref().map_or(0, |split| split.layers.bytes);
        layers + self.tile_map.bytes + self.span_map.bytes
    }

    /// What the passes took in the frame that was recorded [`Options::timed_frames`] calls of [`Gather::record`] ago,
    /// to be asked before the next call takes its place. None before there are so many, and where the queue family or
    /// the options give no times. Does not wait.
    ///
    /// # Errors
    /// [`VulkanError::DeviceLost`] among those of vkGetQueryPoolResults.
    ///
    /// # Safety
    /// That frame's commands have been executed.
    pub unsafe fn pass_times(&self) -> Result<Option<PassTimes>, VulkanError> {
        let Some(timer) = &self.timer else { return Ok(None) };
        // SAFETY: promised by the caller.
        unsafe { timer.times(&self.device) }
    }
}

fn check_size(what: &'static str, size: [u32; 2], limit: [u32; 2]) -> Result<(), VulkanError> {
    match size[0] < 1 || size[1] < 1 || size[0] > limit[0] || size[1] > limit[1] {
        true => Err(VulkanError::Size { what, size, limit }),
        false => Ok(()),
    }
}

fn check_rectangle(
    what: &'static str,
    origin: [u32; 2],
    size: [u32; 2],
    image: [u32; 2],
) -> Result<(), VulkanError> {
    let fits = |i: usize| origin[i].checked_add(size[i]).is_some_and(|end| end <= image[i]);
    match fits(0) && fits(1) {
        true => Ok(()),
        false => Err(VulkanError::Rectangle { what, origin, size, image }),
    }
}

fn check_format(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
    format: vk::Format,
    features: vk::FormatFeatureFlags,
    role: &'static str,
) -> Result<(), VulkanError> {
    // SAFETY: a valid physical device.
    let properties = unsafe { instance.get_physical_device_format_properties(physical_device, format) };
    match properties.optimal_tiling_features.contains(features) {
        true => Ok(()),
        false => Err(VulkanError::Format { format, role }),
    }
}

fn check_samples(samples: u32, limits: &vk::PhysicalDeviceLimits) -> Result<(), VulkanError> {
    let fits = matches!(samples, 2 | 4)
        && limits.sampled_image_depth_sample_counts.contains(vk::SampleCountFlags::from_raw(samples));
    if fits { Ok(()) } else { Err(VulkanError::Samples(samples)) }
}

/// Formats of the colour attachments of a pass.
fn into_formats(into: Into, options: &Options) -> Vec<vk::Format> {
    match into {
        Into::Map => vec![MAP_FORMAT],
        Into::Layers => vec![MAP_FORMAT, back_format(options.color_format)],
        Into::Target => vec![options.color_format],
    }
}

/// Backs are stored as colour is, since unmixing is right in the space of the resolve, with the share of the front in
/// alpha, for which ten-bit formats have no room.
fn back_format(color: vk::Format) -> vk::Format {
    match color {
        vk::Format::R8G8B8A8_SRGB | vk::Format::B8G8R8A8_SRGB | vk::Format::A8B8G8R8_SRGB_PACK32 => {
            vk::Format::R8G8B8A8_SRGB
        }
        vk::Format::R8G8B8A8_UNORM | vk::Format::B8G8R8A8_UNORM | vk::Format::A8B8G8R8_UNORM_PACK32 => {
            vk::Format::R8G8B8A8_UNORM
        }
        _ => vk::Format::R16G16B16A16_SFLOAT,
    }
}

/// All that a format has.
fn aspects(format: vk::Format) -> vk::ImageAspectFlags {
    match format {
        vk::Format::D16_UNORM | vk::Format::X8_D24_UNORM_PACK32 | vk::Format::D32_SFLOAT => {
            vk::ImageAspectFlags::DEPTH
        }
        vk::Format::D16_UNORM_S8_UINT | vk::Format::D24_UNORM_S8_UINT | vk::Format::D32_SFLOAT_S8_UINT => {
            vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL
        }
        _ => vk::ImageAspectFlags::COLOR,
    }
}

/// How a source's image is sampled: in the layout that it has already, where that can be sampled.
fn sampled_state(image: &LayerImage) -> ImageState {
    let layout = match image.before.layout {
        layout @ (vk::ImageLayout::GENERAL
        | vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL
        | vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL
        | vk::ImageLayout::DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL) => layout,
        _ => ImageState::SAMPLED.layout,
    };
    ImageState { layout, ..ImageState::SAMPLED }
}

/// The warp for images whose rows are counted from the top.
fn rows_from_top(warp: &Warp) -> Warp {
    let [source, target] = [warp.source_size[1], warp.target_size[1]].map(|rows| rows as i32);
    Warp { row_offset: (target - source).saturating_sub(warp.row_offset), ..*warp }
}

fn area([x, y]: [u32; 2], [width, height]: [u32; 2]) -> vk::Rect2D {
    vk::Rect2D { offset: vk::Offset2D { x: x as i32, y: y as i32 }, extent: vk::Extent2D { width, height } }
}

/// Depth, maps and samples are fetched as they are, colour is filtered.
fn set_layout(objects: &mut Objects) -> Result<vk::DescriptorSetLayout, VulkanError> {
    let mut sampler = |filter| {
        let edge = vk::SamplerAddressMode::CLAMP_TO_EDGE;
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(filter)
            .min_filter(filter)
            .address_mode_u(edge)
            .address_mode_v(edge)
            .address_mode_w(edge);
        // SAFETY: a valid description.
        let sampler = unsafe { objects.device().create_sampler(&info, None) };
        objects.keep("vkCreateSampler", sampler, Object::Sampler).map(|sampler| [sampler])
    };
    let (nearest, linear) = (sampler(vk::Filter::NEAREST)?, sampler(vk::Filter::LINEAR)?);
    let samplers: [_; TEXTURES] =
        std::array::from_fn(|binding| if binding == 1 { &linear } else { &nearest });
    let bindings: [_; TEXTURES] = std::array::from_fn(|binding| {
        vk::DescriptorSetLayoutBinding::default()
            .binding(binding as u32)
            .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
            .descriptor_count(1)
            .stage_flags(vk::ShaderStageFlags::FRAGMENT)
            .immutable_samplers(samplers[binding])
    });
    let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
    // SAFETY: a valid description.
    let layout = unsafe { objects.device().create_descriptor_set_layout(&info, None) };
    objects.keep("vkCreateDescriptorSetLayout", layout, Object::DescriptorSetLayout)
}

fn pipeline_layout(
    objects: &mut Objects,
    set_layout: vk::DescriptorSetLayout,
) -> Result<vk::PipelineLayout, VulkanError> {
    let layouts = [set_layout];
    let constants = [vk::PushConstantRange {
        stage_flags: vk::ShaderStageFlags::FRAGMENT,
        offset: 0,
        size: size_of::<Uniforms>() as u32,
    }];
    let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts).push_constant_ranges(&constants);
    // SAFETY: a valid description; every device has 128 bytes of push constants.
    let layout = unsafe { objects.device().create_pipeline_layout(&info, None) };
    objects.keep("vkCreatePipelineLayout", layout, Object::PipelineLayout)
}

/// What pipelines have in common.
struct Making<'a> {
    objects: &'a mut Objects,
    shaders: Objects,
    rendering: &'a Rendering,
    layout: vk::PipelineLayout,
    options: &'a Options,
}

impl Making<'_> {
    /// For whole sources and for parts of them.
    fn pipelines(&mut self, fragment: &[u8], into: Into) -> Result<[vk::Pipeline; 2], VulkanError> {
        Ok([self.pipeline(fragment, into, false)?, self.pipeline(fragment, into, true)?])
    }

    /// A pass over the whole viewport.
    fn pipeline(&mut self, fragment: &[u8], into: Into, part: bool) -> Result<vk::Pipeline, VulkanError> {
        let (vertex, fragment) = (self.shaders.shader(shaders::SCREEN)?, self.shaders.shader(fragment)?);
        // `PART`, `TWO_SAMPLES`.
        let values = [part, self.options.samples == 2].map(u32::from);
        let entries =
            [0, 1].map(|id| vk::SpecializationMapEntry { constant_id: id, offset: 4 * id, size: 4 });
        let constants =
            vk::SpecializationInfo::default().map_entries(&entries).data(bytemuck::bytes_of(&values));
        let stage = |stage, module| {
            vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(c"main")
        };
        let stages = [
            stage(vk::ShaderStageFlags::VERTEX, vertex),
            stage(vk::ShaderStageFlags::FRAGMENT, fragment).specialization_info(&constants),
        ];
        let vertices = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let multisample = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth_format = self.options.depth_format.filter(|_| into == Into::Target);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(depth_format.is_some())
            .depth_write_enable(depth_format.is_some())
            .depth_compare_op(vk::CompareOp::ALWAYS);
        let formats = into_formats(into, self.options);
        let all =
            vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA);
        let blend = vec![all; formats.len()];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blend);
        let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
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
            .layout(self.layout);
        let mut attachments = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(&formats)
            .depth_attachment_format(depth_format.unwrap_or_default());
        let info = match *self.rendering {
            Rendering::Dynamic { .. } => info.push_next(&mut attachments),
            Rendering::Passes { .. } => info.render_pass(self.rendering.render_pass(into)),
        };
        let device = self.objects.device();
        // SAFETY: a valid description of live objects.
        let pipeline =
            unsafe { device.create_graphics_pipelines(self.options.pipeline_cache, &[info], None) };
        // There is but one.
        let pipeline = pipeline.map(|made| made[0]).map_err(|(_, result)| result);
        self.objects.keep("vkCreateGraphicsPipelines", pipeline, Object::Pipeline)
    }
}

/// The first entry point of these names that the device has.
///
/// # Safety
/// The host's handles are valid.
unsafe fn entry_point(host: &Host, names: &[&CStr]) -> Option<unsafe extern "system" fn()> {
    names.iter().find_map(|name| {
        // SAFETY: a valid device, and a name that ends with 0.
        unsafe { host.instance.get_device_proc_addr(host.device.handle(), name.as_ptr()) }
    })
}

impl Rendering {
    /// # Safety
    /// The host's handles are valid.
    unsafe fn new(host: &Host, objects: &mut Objects, options: &Options) -> Result<Rendering, VulkanError> {
        if host.dynamic_rendering {
            // SAFETY: promised by the caller; entry points of these names have these signatures.
            return unsafe {
                let begin = entry_point(host, &[c"vkCmdBeginRenderingKHR", c"vkCmdBeginRendering"]);
                let end = entry_point(host, &[c"vkCmdEndRenderingKHR", c"vkCmdEndRendering"]);
                let (begin, end) = begin.zip(end).ok_or(VulkanError::DynamicRendering)?;
                Ok(Rendering::Dynamic {
                    begin: std::mem::transmute::<unsafe extern "system" fn(), vk::PFN_vkCmdBeginRendering>(
                        begin,
                    ),
                    end: std::mem::transmute::<unsafe extern "system" fn(), vk::PFN_vkCmdEndRendering>(end),
                })
            };
        }
        let mut pass = |into, depth| render_pass(objects, &into_formats(into, options), depth);
        Ok(Rendering::Passes {
            map: pass(Into::Map, None)?,
            layers: match options.edges {
                Edges::Hard => vk::RenderPass::null(),
                _ => pass(Into::Layers, None)?,
            },
            target: pass(Into::Target, options.depth_format)?,
        })
    }

    /// Null for dynamic rendering, and that of the layers for hard edges, which have none.
    fn render_pass(&self, into: Into) -> vk::RenderPass {
        match (self, into) {
            (Rendering::Dynamic { .. }, _) => vk::RenderPass::null(),
            (Rendering::Passes { map, .. }, Into::Map) => *map,
            (Rendering::Passes { layers, .. }, Into::Layers) => *layers,
            (Rendering::Passes { target, .. }, Into::Target) => *target,
        }
    }

    /// Views as something to draw into.
    ///
    /// # Safety
    /// They are live and of the pass's formats.
    unsafe fn attachments(
        &self,
        objects: &mut Objects,
        into: Into,
        colors: &[vk::ImageView],
        depth: Option<vk::ImageView>,
        size: [u32; 2],
    ) -> Result<Attachments, VulkanError> {
        let framebuffer = match self {
            Rendering::Dynamic { .. } => vk::Framebuffer::null(),
            Rendering::Passes { .. } => {
                let views: Vec<_> = colors.iter().copied().chain(depth).collect();
                // SAFETY: promised by the caller.
                unsafe { objects.framebuffer(self.render_pass(into), &views, size)? }
            }
        };
        let color = |i: usize| colors.get(i).copied().unwrap_or_default();
        Ok(Attachments { colors: [color(0), color(1)], depth, framebuffer })
    }

    /// # Safety
    /// The command buffer records; the attachments are in the layouts of attachments.
    unsafe fn begin(
        &self,
        device: &ash::Device,
        commands: vk::CommandBuffer,
        attachments: &Attachments,
        into: Into,
        area: vk::Rect2D,
    ) {
        // SAFETY: promised by the caller; no attachment is cleared, so that no clear values are given.
        unsafe {
            match *self {
                Rendering::Dynamic { begin, .. } => {
                    let attachment = |view, layout| {
                        vk::RenderingAttachmentInfo::default()
                            .image_view(view)
                            .image_layout(layout)
                            .load_op(vk::AttachmentLoadOp::DONT_CARE)
                            .store_op(vk::AttachmentStoreOp::STORE)
                    };
                    let colors =
                        attachments.colors.map(|view| attachment(view, ImageState::COLOR_ATTACHMENT.layout));
                    let count = if into == Into::Layers { 2 } else { 1 };
                    let depth = attachment(
                        attachments.depth.unwrap_or_default(),
                        ImageState::DEPTH_ATTACHMENT.layout,
                    );
                    let info = vk::RenderingInfo::default()
                        .render_area(area)
                        .layer_count(1)
                        .color_attachments(&colors[..count])
                        .depth_attachment(&depth);
                    begin(commands, &info);
                }
                Rendering::Passes { .. } => {
                    let info = vk::RenderPassBeginInfo::default()
                        .render_pass(self.render_pass(into))
                        .framebuffer(attachments.framebuffer)
                        .render_area(area);
                    device.cmd_begin_render_pass(commands, &info, vk::SubpassContents::INLINE);
                }
            }
            let viewport = vk::Viewport {
                x: area.offset.x as f32,
                y: area.offset.y as f32,
                width: area.extent.width as f32,
                height: area.extent.height as f32,
                min_depth: 0.0,
                max_depth: 1.0,
            };
            device.cmd_set_viewport(commands, 0, &[viewport]);
            device.cmd_set_scissor(commands, 0, &[area]);
        }
    }

    /// # Safety
    /// After [`Rendering::begin`].
    unsafe fn end(&self, device: &ash::Device, commands: vk::CommandBuffer) {
        // SAFETY: promised by the caller.
        unsafe {
            match self {
                Rendering::Dynamic { end, .. } => end(commands),
                Rendering::Passes { .. } => device.cmd_end_render_pass(commands),
            }
        }
    }
}

/// A render pass that changes no layouts and keeps stencil.
fn render_pass(
    objects: &mut Objects,
    colors: &[vk::Format],
    depth: Option<vk::Format>,
) -> Result<vk::RenderPass, VulkanError> {
    let attachment = |format, layout| {
        vk::AttachmentDescription::default()
            .format(format)
            .samples(vk::SampleCountFlags::TYPE_1)
            .load_op(vk::AttachmentLoadOp::DONT_CARE)
            .store_op(vk::AttachmentStoreOp::STORE)
            .stencil_load_op(vk::AttachmentLoadOp::LOAD)
            .stencil_store_op(vk::AttachmentStoreOp::STORE)
            .initial_layout(layout)
            .final_layout(layout)
    };
    let layouts = [ImageState::COLOR_ATTACHMENT.layout, ImageState::DEPTH_ATTACHMENT.layout];
    let color_attachments = colors.iter().map(|format| attachment(*format, layouts[0]));
    let attachments: Vec<_> =
        color_attachments.chain(depth.map(|format| attachment(format, layouts[1]))).collect();
    let reference =
        |attachment: usize, layout| vk::AttachmentReference { attachment: attachment as u32, layout };
    let color_references: Vec<_> = (0..colors.len()).map(|i| reference(i, layouts[0])).collect();
    let depth_reference = reference(colors.len(), layouts[1]);
    let mut subpass = vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&color_references);
    if depth.is_some() {
        subpass = subpass.depth_stencil_attachment(&depth_reference);
    }
    let subpasses = [subpass];
    let info = vk::RenderPassCreateInfo::default().attachments(&attachments).subpasses(&subpasses);
    // SAFETY: a valid description.
    let render_pass = unsafe { objects.device().create_render_pass(&info, None) };
    objects.keep("vkCreateRenderPass", render_pass, Object::RenderPass)
}

impl Map {
    fn new(
        objects: &mut Objects,
        rendering: &Rendering,
        memory: &vk::PhysicalDeviceMemoryProperties,
        into: Into,
        formats: &[vk::Format],
        size: [u32; 2],
    ) -> Result<Map, VulkanError> {
        let (mut images, mut views) = (Vec::new(), Vec::new());
        for &format in formats {
            let image = image(objects, memory, format, size)?;
            images.push(image);
            // SAFETY: a live image with one layer.
            views.push(unsafe { objects.view(image, format, vk::ImageAspectFlags::COLOR, 0)? });
        }
        // SAFETY: live views of the pass's formats.
        let attachments = unsafe { rendering.attachments(objects, into, &views, None, size)? };
        let texel = |format: &vk::Format| if *format == vk::Format::R16G16B16A16_SFLOAT { 8 } else { 4 };
        let texels = u64::from(size[0]) * u64::from(size[1]);
        Ok(Map { images, attachments, size, bytes: texels * formats.iter().map(texel).sum::<u64>() })
    }
}

/// A colour image with memory of its own, to be rendered to and sampled.
fn image(
    objects: &mut Objects,
    memory: &vk::PhysicalDeviceMemoryProperties,
    format: vk::Format,
    size: [u32; 2],
) -> Result<vk::Image, VulkanError> {
    let info = vk::ImageCreateInfo::default()
        .image_type(vk::ImageType::TYPE_2D)
        .format(format)
        .extent(vk::Extent3D { width: size[0], height: size[1], depth: 1 })
        .mip_levels(1)
        .array_layers(1)
        .samples(vk::SampleCountFlags::TYPE_1)
        .usage(vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::SAMPLED);
    // SAFETY: a valid description; the formats of maps have these uses on every device.
    let image = unsafe { objects.device().create_image(&info, None) };
    let image = objects.keep("vkCreateImage", image, Object::Image)?;
    // SAFETY: a live image.
    let needed = unsafe { objects.device().get_image_memory_requirements(image) };
    let usable = |i: &u32| needed.memory_type_bits >> i & 1 != 0;
    let local = |i: &u32| {
        memory.memory_types[*i as usize].property_flags.contains(vk::MemoryPropertyFlags::DEVICE_LOCAL)
    };
    let types = || (0..memory.memory_type_count).filter(usable);
    let memory_type = types().find(local).or_else(|| types().next()).unwrap_or_default();
    let info = vk::MemoryAllocateInfo::default().allocation_size(needed.size).memory_type_index(memory_type);
    // SAFETY: a valid description.
    let memory = unsafe { objects.device().allocate_memory(&info, None) };
    let memory = objects.keep("vkAllocateMemory", memory, Object::Memory)?;
    // SAFETY: new memory of the image's size and type.
    unsafe { objects.device().bind_image_memory(image, memory, 0) }
        .map_err(|result| VulkanError::new("vkBindImageMemory", result))?;
    Ok(image)
}

/// Barriers that are recorded with one command: at most three source images, both target images, and four of maps.
struct Barriers {
    list: [vk::ImageMemoryBarrier<'static>; 9],
    count: usize,
    before: vk::PipelineStageFlags,
    after: vk::PipelineStageFlags,
}

impl Barriers {
    fn new() -> Barriers {
        let (before, after) = (vk::PipelineStageFlags::empty(), vk::PipelineStageFlags::empty());
        Barriers { list: Default::default(), count: 0, before, after }
    }

    fn image(&mut self, image: &LayerImage, from: ImageState, to: ImageState) {
        self.add(image.image, range(aspects(image.format), image.layer), from, to);
    }

    fn map(&mut self, map: &Map, from: ImageState, to: ImageState) {
        for &image in &map.images {
            self.add(image, range(vk::ImageAspectFlags::COLOR, 0), from, to);
        }
    }

    fn add(&mut self, image: vk::Image, range: vk::ImageSubresourceRange, from: ImageState, to: ImageState) {
        if from.layout == to.layout && !writes(from.access) && !writes(to.access) {
            return;
        }
        self.list[self.count] = vk::ImageMemoryBarrier::default()
            .src_access_mask(from.access)
            .dst_access_mask(to.access)
            .old_layout(from.layout)
            .new_layout(to.layout)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(image)
            .subresource_range(range);
        self.count += 1;
        self.before |= from.stages;
        self.after |= to.stages;
    }

    /// # Safety
    /// The command buffer records, outside of render passes; the images are in the states that are told.
    unsafe fn record(&self, device: &ash::Device, commands: vk::CommandBuffer) {
        let (list, none) = (&self.list[..self.count], vk::DependencyFlags::empty());
        if !list.is_empty() {
            // SAFETY: promised by the caller.
            unsafe {
                device.cmd_pipeline_barrier(commands, self.before, self.after, none, &[], &[], list);
            }
        }
    }
}

fn writes(access: vk::AccessFlags) -> bool {
    access.intersects(
        vk::AccessFlags::SHADER_WRITE
            | vk::AccessFlags::COLOR_ATTACHMENT_WRITE
            | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE
            | vk::AccessFlags::TRANSFER_WRITE
            | vk::AccessFlags::HOST_WRITE
            | vk::AccessFlags::MEMORY_WRITE,
    )
}

impl Timer {
    /// None where nobody asks for times, or the queue family has none.
    fn new(
        objects: &mut Objects,
        frames: u32,
        family: &vk::QueueFamilyProperties,
        limits: &vk::PhysicalDeviceLimits,
    ) -> Result<Option<Timer>, VulkanError> {
        if frames == 0 || family.timestamp_valid_bits == 0 {
            return Ok(None);
        }
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::TIMESTAMP)
            .query_count(frames.saturating_mul(STAMPS));
        // SAFETY: a valid description.
        let pool = unsafe { objects.device().create_query_pool(&info, None) };
        let pool = objects.keep("vkCreateQueryPool", pool, Object::QueryPool)?;
        let mask = u64::MAX >> (64 - family.timestamp_valid_bits.min(64));
        let period = f64::from(limits.timestamp_period);
        Ok(Some(Timer { pool, frames, recorded: 0, period, mask }))
    }

    /// Of the frame that is recorded now, which was that of the frame a round ago.
    fn first_query(&self) -> u32 {
        (self.recorded % u64::from(self.frames)) as u32 * STAMPS
    }

    /// # Safety
    /// The command buffer records, outside of render passes.
    unsafe fn begin(&self, device: &ash::Device, commands: vk::CommandBuffer) {
        // SAFETY: promised by the caller; the queries are in the pool.
        unsafe {
            device.cmd_reset_query_pool(commands, self.pool, self.first_query(), STAMPS);
            self.stamp(device, commands, 0);
        }
    }

    /// When everything before is done: what came before the passes does not count as theirs.
    ///
    /// # Safety
    /// The command buffer records.
    unsafe fn stamp(&self, device: &ash::Device, commands: vk::CommandBuffer, number: u32) {
        let (stage, query) = (vk::PipelineStageFlags::BOTTOM_OF_PIPE, self.first_query() + number);
        // SAFETY: promised by the caller; the query is in the pool and was reset.
        unsafe { device.cmd_write_timestamp(commands, stage, self.pool, query) };
    }

    /// # Safety
    /// The commands of the frame a round ago have been executed.
    unsafe fn times(&self, device: &ash::Device) -> Result<Option<PassTimes>, VulkanError> {
        if self.recorded < self.frames.into() {
            return Ok(None);
        }
        let mut stamps = [0u64; STAMPS as usize];
        let flags = vk::QueryResultFlags::TYPE_64;
        // SAFETY: as many queries as results; they were reset and written by commands that have been executed.
        match unsafe { device.get_query_pool_results(self.pool, self.first_query(), &mut stamps, flags) } {
            Ok(()) => {}
            Err(vk::Result::NOT_READY) => return Ok(None),
            Err(result) => return Err(VulkanError::new("vkGetQueryPoolResults", result)),
        }
        let time = |pass: usize| {
            let ticks = stamps[pass + 1].wrapping_sub(stamps[pass]) & self.mask;
            Duration::from_nanos((ticks as f64 * self.period) as u64)
        };
        Ok(Some(PassTimes { split: time(0), tiles: time(1), spans: time(2), march: time(3) }))
    }
}

impl Labels {
    /// # Safety
    /// The host's handles are valid.
    unsafe fn new(host: &Host) -> Option<Labels> {
        // SAFETY: promised by the caller; entry points of these names have these signatures.
        unsafe {
            let begin = entry_point(host, &[c"vkCmdBeginDebugUtilsLabelEXT"])?;
            let end = entry_point(host, &[c"vkCmdEndDebugUtilsLabelEXT"])?;
            Some(Labels {
                begin: std::mem::transmute::<unsafe extern "system" fn(), vk::PFN_vkCmdBeginDebugUtilsLabelEXT>(
                    begin,
                ),
                end: std::mem::transmute::<unsafe extern "system" fn(), vk::PFN_vkCmdEndDebugUtilsLabelEXT>(
                    end,
                ),
            })
        }
    }

    /// # Safety
    /// The command buffer records.
    unsafe fn begin(&self, commands: vk::CommandBuffer, name: &CStr) {
        let label = vk::DebugUtilsLabelEXT::default().label_name(name);
        // SAFETY: promised by the caller.
        unsafe { (self.begin)(commands, &label) }
    }

    /// # Safety
    /// After [`Labels::begin`].
    unsafe fn end(&self, commands: vk::CommandBuffer) {
        // SAFETY: promised by the caller.
        unsafe { (self.end)(commands) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eyes::{DepthConvention, DisparityLaw, Eye};

    #[test]
    fn rows_from_the_top_lead_to_the_same_rows() {
        let warp = Warp {
            source_size: [8, 13],
            target_size: [8, 10],
            law: DisparityLaw { offset: 0.0, scale: 1.0 },
            row_offset: -2,
            target_eye: Eye::Left,
            convention: DepthConvention::Standard,
        };
        let turned = rows_from_top(&warp);
        for source_row in 0..13 {
            let target_row = source_row + warp.row_offset;
            let (source_from_top, target_from_top) = (12 - source_row, 9 - target_row);
            assert_eq!(source_from_top + turned.row_offset, target_from_top);
        }
        assert_eq!(rows_from_top(&turned), warp);
    }
}
