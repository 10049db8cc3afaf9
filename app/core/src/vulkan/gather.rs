//! The three fragment passes.

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
use crate::synthesis::{Places, Uniforms, tiles};

/// Format of the intermediate maps, which every device samples and renders to.
const MAP_FORMAT: vk::Format = vk::Format::R32_UINT;
/// Bindings of the descriptor set, as `TEXTURE` in the shaders counts them: depth, colour, tile map, span map.
const TEXTURES: usize = 4;
/// Timestamps of a frame: before the first pass, and after each.
const STAMPS: u32 = 4;

/// How the shaders are written for a kind of device; see [`crate::synthesis::GatherVariant`].
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GatherVariant {
    /// A CPU rasterizer.
    Software,
    /// A GPU.
    ShortWay,
}

/// Tile bounds, tile spans, march, as [`crate::synthesis::Gather`].
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
    Passes { map: vk::RenderPass, target: vk::RenderPass },
}

/// What passes draw into: views for dynamic rendering, a framebuffer of them for render passes.
#[derive(Clone, Copy)]
struct Attachments {
    color: vk::ImageView,
    depth: Option<vk::ImageView>,
    framebuffer: vk::Framebuffer,
}

/// An intermediate buffer: one 32-bit integer a tile.
struct Map {
    image: vk::Image,
    attachments: Attachments,
    /// Width and height in tiles.
    size: [u32; 2],
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
        let bounds = making.pipelines(shaders::TILES, false)?;
        let spans = making.pipeline(shaders::SPANS, false, false)?;
        let march = making.pipelines(shaders::march(variant, depth), true)?;
        drop(making);
        // SAFETY: a valid physical device.
        let memory = unsafe { instance.get_physical_device_memory_properties(physical_device) };
        let [source, target] = [options.max_source_size, options.max_target_size];
        let tile_map = Map::new(&mut objects, &rendering, &memory, tiles(source))?;
        let span_map = Map::new(&mut objects, &rendering, &memory, tiles([target[0], source[1]]))?;
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
        let map = |map: &Map| texture(map.attachments.color, ImageState::SAMPLED.layout);
        let textures: [_; TEXTURES] = [
            texture(depth_view, sampled_state(depth).layout),
            texture(color_view, sampled_state(color).layout),
            map(&self.tile_map),
            map(&self.span_map),
        ];
        let writes: [_; TEXTURES] = std::array::from_fn(|binding| {
            vk::WriteDescriptorSet::default()
                .dst_set(set)
                .dst_binding(binding as u32)
                .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
                .image_info(&textures[binding])
        });
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
        let framebuffer = match self.rendering {
            Rendering::Dynamic { .. } => vk::Framebuffer::null(),
            Rendering::Passes { target, .. } => {
                let views = [color, depth.unwrap_or_default()];
                let views = if depth.is_some() { &views[..] } else { &views[..1] };
                // SAFETY: views of the formats that the render pass has.
                unsafe { objects.framebuffer(target, views, images.size)? }
            }
        };
        let attachments = Attachments { color, depth, framebuffer };
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
        let (color, depth) = (&source.images.color, &source.images.depth);
        let drawn = [Some((&target.images.color, ImageState::COLOR_ATTACHMENT))]
            .into_iter()
            .chain([target.images.depth.as_ref().map(|depth| (depth, ImageState::DEPTH_ATTACHMENT))])
            .flatten();
        // SAFETY: the caller's command buffer, this device's objects, and images in the states that are told. Barriers
        // stand between all that writes and all that reads.
        unsafe {
            self.timer.as_ref().inspect(|timer| timer.begin(device, commands));
            let mut barriers = Barriers::new();
            for image in [color, depth] {
                barriers.image(image, image.before, sampled_state(image));
            }
            for (image, state) in drawn.clone() {
                barriers.image(image, image.before, state);
            }
            for map in [&self.tile_map, &self.span_map] {
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
            let passes = [
                (c"gather tiles", self.bounds[variant], &self.tile_map.attachments, [0, 0], tile_size),
                (c"gather spans", self.spans, &self.span_map.attachments, [0, 0], span_size),
                (
                    c"gather march",
                    self.march[variant],
                    &target.attachments,
                    frame.target_origin,
                    warp.target_size,
                ),
            ];
            for (i, (name, pipeline, attachments, origin, size)) in passes.into_iter().enumerate() {
                self.labels.as_ref().inspect(|labels| labels.begin(commands, name));
                self.rendering.begin(device, commands, attachments, i == 2, area(origin, size));
                device.cmd_bind_pipeline(commands, point, pipeline);
                device.cmd_draw(commands, 3, 1, 0, 0);
                self.rendering.end(device, commands);
                if let Some(map) = [&self.tile_map, &self.span_map].get(i) {
                    let mut barriers = Barriers::new();
                    barriers.map(map, ImageState::COLOR_ATTACHMENT, ImageState::SAMPLED);
                    barriers.record(device, commands);
                }
                self.timer.as_ref().inspect(|timer| timer.stamp(device, commands, i as u32 + 1));
                self.labels.as_ref().inspect(|labels| labels.end(commands));
            }

            let mut barriers = Barriers::new();
            for image in [color, depth] {
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

/// Four textures; depth and maps are fetched as they are, colour is filtered.
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
    let samplers: [_; TEXTURES] = [&nearest, &linear, &nearest, &nearest];
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
    fn pipelines(&mut self, fragment: &[u8], to_target: bool) -> Result<[vk::Pipeline; 2], VulkanError> {
        Ok([self.pipeline(fragment, to_target, false)?, self.pipeline(fragment, to_target, true)?])
    }

    /// A pass over the whole viewport, into a map or into the target.
    fn pipeline(
        &mut self,
        fragment: &[u8],
        to_target: bool,
        part: bool,
    ) -> Result<vk::Pipeline, VulkanError> {
        let (vertex, fragment) = (self.shaders.shader(shaders::SCREEN)?, self.shaders.shader(fragment)?);
        let part = u32::from(part).to_ne_bytes();
        let entries = [vk::SpecializationMapEntry { constant_id: 0, offset: 0, size: part.len() }];
        let constants = vk::SpecializationInfo::default().map_entries(&entries).data(&part);
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
        let depth_format = self.options.depth_format.filter(|_| to_target);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(depth_format.is_some())
            .depth_write_enable(depth_format.is_some())
            .depth_compare_op(vk::CompareOp::ALWAYS);
        let blend =
            [vk::PipelineColorBlendAttachmentState::default()
                .color_write_mask(vk::ColorComponentFlags::RGBA)];
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
        let formats = [if to_target { self.options.color_format } else { MAP_FORMAT }];
        let mut attachments = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(&formats)
            .depth_attachment_format(depth_format.unwrap_or_default());
        let info = match *self.rendering {
            Rendering::Dynamic { .. } => info.push_next(&mut attachments),
            Rendering::Passes { map, target } => info.render_pass(if to_target { target } else { map }),
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
        Ok(Rendering::Passes {
            map: render_pass(objects, MAP_FORMAT, None)?,
            target: render_pass(objects, options.color_format, options.depth_format)?,
        })
    }

    /// # Safety
    /// The command buffer records; the attachments are in the layouts of attachments.
    unsafe fn begin(
        &self,
        device: &ash::Device,
        commands: vk::CommandBuffer,
        attachments: &Attachments,
        to_target: bool,
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
                    let color = [attachment(attachments.color, ImageState::COLOR_ATTACHMENT.layout)];
                    let depth = attachment(
                        attachments.depth.unwrap_or_default(),
                        ImageState::DEPTH_ATTACHMENT.layout,
                    );
                    let info = vk::RenderingInfo::default()
                        .render_area(area)
                        .layer_count(1)
                        .color_attachments(&color)
                        .depth_attachment(&depth);
                    begin(commands, &info);
                }
                Rendering::Passes { map, target } => {
                    let info = vk::RenderPassBeginInfo::default()
                        .render_pass(if to_target { target } else { map })
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
    color: vk::Format,
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
    let attachments = [attachment(color, layouts[0]), attachment(depth.unwrap_or_default(), layouts[1])];
    let color_reference = [vk::AttachmentReference { attachment: 0, layout: layouts[0] }];
    let depth_reference = vk::AttachmentReference { attachment: 1, layout: layouts[1] };
    let subpass = vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&color_reference);
    let (subpass, attachments) = match depth {
        Some(_) => (subpass.depth_stencil_attachment(&depth_reference), &attachments[..]),
        None => (subpass, &attachments[..1]),
    };
    let subpasses = [subpass];
    let info = vk::RenderPassCreateInfo::default().attachments(attachments).subpasses(&subpasses);
    // SAFETY: a valid description.
    let render_pass = unsafe { objects.device().create_render_pass(&info, None) };
    objects.keep("vkCreateRenderPass", render_pass, Object::RenderPass)
}

impl Map {
    fn new(
        objects: &mut Objects,
        rendering: &Rendering,
        memory: &vk::PhysicalDeviceMemoryProperties,
        size: [u32; 2],
    ) -> Result<Map, VulkanError> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(MAP_FORMAT)
            .extent(vk::Extent3D { width: size[0], height: size[1], depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::SAMPLED);
        // SAFETY: a valid description; R32_UINT has these uses on every device.
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
        let info =
            vk::MemoryAllocateInfo::default().allocation_size(needed.size).memory_type_index(memory_type);
        // SAFETY: a valid description.
        let memory = unsafe { objects.device().allocate_memory(&info, None) };
        let memory = objects.keep("vkAllocateMemory", memory, Object::Memory)?;
        // SAFETY: new memory of the image's size and type.
        unsafe { objects.device().bind_image_memory(image, memory, 0) }
            .map_err(|result| VulkanError::new("vkBindImageMemory", result))?;
        // SAFETY: a live image with one layer; its view fits the render pass.
        let attachments = unsafe {
            let color = objects.view(image, MAP_FORMAT, vk::ImageAspectFlags::COLOR, 0)?;
            let framebuffer = match *rendering {
                Rendering::Dynamic { .. } => vk::Framebuffer::null(),
                Rendering::Passes { map, .. } => objects.framebuffer(map, &[color], size)?,
            };
            Attachments { color, depth: None, framebuffer }
        };
        Ok(Map { image, attachments, size })
    }
}

/// Barriers that are recorded with one command: at most both source images, both target images and both maps.
struct Barriers {
    list: [vk::ImageMemoryBarrier<'static>; 6],
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
        self.add(map.image, range(vk::ImageAspectFlags::COLOR, 0), from, to);
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
        Ok(Some(PassTimes { tiles: time(0), spans: time(1), march: time(2) }))
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
