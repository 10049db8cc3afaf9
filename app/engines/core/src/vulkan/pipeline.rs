//! Synthesis, recorded into the caller's command buffer.

use std::marker::PhantomData;
use std::sync::Arc;

use ash::vk;

use super::adapter::Adapter;
use super::barriers::Barriers;
use super::commands::{Commands, Labels};
use super::formats::{components, map_bytes};
use super::images::{self, Source, Target};
use super::objects::Objects;
use super::passes::{Passes, Recorder, area};
use super::pipelines::{FILTERED, Layouts};
use super::targets::Rendering;
use super::timer::{Stamp, Timer};
use super::{
    Frame, Host, ImageState, Options, PassTimes, SourceId, SourceImages, TargetId, TargetImages, Uses,
    VulkanError,
};
use crate::eyes::{MotionWarp, PoseWarp, Warp};
use crate::synthesis::backend::{Places, WarpKind, check_rectangle, check_size, map_sizes};

/// Synthesis between parallel eyes: the march goes along the source's row.
pub type Gather = Pipeline<Warp>;

/// Synthesis of a view in any pose near the source's: the march goes along a segment of any direction.
pub type AnyView = Pipeline<PoseWarp>;

/// Synthesis of motion vectors between parallel eyes, for runtimes that make frames between those that are rendered. The
/// source's colour is the vectors' image, R16G16B16A16_SFLOAT with three components in NDC
/// ([`VectorSpace`](crate::eyes::VectorSpace)), with depth of the same size: that of the vectors that a runtime
/// recommends, not that of the eye. The target receives vectors, and depth with [`Options::depth_format`]. Silhouettes
/// are not blended, and a hole has its background's vector.
pub type Motion = Pipeline<MotionWarp>;

/// The passes for a kind of warp: [`Gather`], [`AnyView`] or [`Motion`]: tile bounds, tile spans, march.
///
/// Call the methods from one thread at a time. All frames share the intermediate buffers, which are protected by
/// barriers only: the commands must be executed in the order in which they were recorded, by queues of one family, one
/// after the other.
pub struct Pipeline<W> {
    adapter: Adapter,
    device: Arc<ash::Device>,
    options: Options,
    layouts: Layouts,
    passes: Passes,
    timer: Option<Timer>,
    labels: Option<Labels>,
    sources: Vec<Source>,
    targets: Vec<Target>,
    /// The id that was assigned last.
    last_id: u32,
    warp: PhantomData<W>,
    // The last field, so that these objects are destroyed after those of sources and targets.
    _objects: Objects,
}

impl<W: WarpKind> Pipeline<W> {
    /// Creates everything that does not depend on the images: pipelines and intermediate buffers.
    ///
    /// # Errors
    /// [`VulkanError::Format`], [`VulkanError::Argument`], [`VulkanError::Holes`], [`VulkanError::QueueFamily`] and
    /// [`VulkanError::DynamicRendering`] for what the device does not support; errors of Vulkan's commands.
    ///
    /// # Safety
    /// The host's handles are valid, belong together and outlive the returned value. When the value is dropped, no
    /// command that it has recorded is pending.
    pub unsafe fn new(host: &Host, options: &Options) -> Result<Pipeline<W>, VulkanError> {
        // SAFETY: the caller's handles are valid and belong together.
        let adapter = unsafe { Adapter::new(host) };
        let family = adapter.graphics_family(host.queue_family)?;
        adapter.check_options(options)?;

        let device = Arc::new(host.device.clone());
        // SAFETY: this module describes objects by what it has made itself. The caller keeps the device alive, and has
        // waited for all commands when these objects are dropped.
        let mut objects = unsafe { Objects::new(&device) };
        // SAFETY: the caller's handles are valid and belong together.
        let rendering = unsafe { Rendering::new(host, &mut objects, options)? };
        let layouts = Layouts::new(&mut objects, size_of::<W::Uniforms>(), FILTERED)?;
        let memory = adapter.memory();
        let passes = Passes::new::<W>(&mut objects, rendering, layouts.pipeline, &memory, options)?;
        let timer = Timer::new(&mut objects, options.timed_frames, &family, &adapter.properties.limits)?;
        // SAFETY: the caller's handles are valid and belong together.
        let labels = unsafe { Labels::new(host) };
        Ok(Pipeline {
            adapter,
            device,
            options: *options,
            layouts,
            passes,
            timer,
            labels,
            sources: Vec::new(),
            targets: Vec::new(),
            last_id: 0,
            warp: PhantomData,
            _objects: objects,
        })
    }

    fn next_id(&self) -> u32 {
        self.last_id.checked_add(1).unwrap_or(1)
    }

    /// Creates views and descriptors of images to read from.
    ///
    /// # Errors
    /// [`VulkanError::Format`] and [`VulkanError::Argument`]; errors of Vulkan's commands.
    ///
    /// # Safety
    /// The images are as [`SourceImages`] and [`LayerImage`](super::LayerImage) describe, and live until the id is
    /// released or the pipeline is dropped.
    pub unsafe fn register_source(&mut self, images: &SourceImages) -> Result<SourceId, VulkanError> {
        images::check_source(&self.adapter, images)?;
        W::check_components(components(images.color.format))?;
        // SAFETY: the caller's images are live, and outlive the objects, which are destroyed when the id is released.
        let objects = unsafe { Objects::new(&self.device) };
        let id = SourceId(self.next_id());
        let source = Source::new(objects, id, images, self.layouts.textures, &self.passes)?;
        self.last_id = id.0;
        self.sources.push(source);
        Ok(id)
    }

    /// Creates views of images to write to, and a framebuffer if render passes are used.
    ///
    /// # Errors
    /// [`VulkanError::OtherFormat`] and [`VulkanError::Argument`]; errors of Vulkan's commands.
    ///
    /// # Safety
    /// The images are as [`TargetImages`] and [`LayerImage`](super::LayerImage) describe, and live until the id is
    /// released or the pipeline is dropped.
    pub unsafe fn register_target(&mut self, images: &TargetImages) -> Result<TargetId, VulkanError> {
        images::check_target(&self.adapter, &self.options, images)?;
        // SAFETY: the caller's images are live, and outlive the objects, which are destroyed when the id is released.
        let objects = unsafe { Objects::new(&self.device) };
        let id = TargetId(self.next_id());
        let target = Target::new(objects, id, images, &self.passes.rendering)?;
        self.last_id = id.0;
        self.targets.push(target);
        Ok(id)
    }

    /// Releases the objects of a source. Ignores an id that is not registered.
    ///
    /// # Safety
    /// No command that was recorded with the id is pending.
    pub unsafe fn release_source(&mut self, id: SourceId) {
        self.sources.retain(|source| source.id != id);
    }

    /// Releases the objects of a target. Ignores an id that is not registered.
    ///
    /// # Safety
    /// No command that was recorded with the id is pending.
    pub unsafe fn release_target(&mut self, id: TargetId) {
        self.targets.retain(|target| target.id != id);
    }

    /// Records the passes.
    ///
    /// Barriers bring the images from [`LayerImage::before`](super::LayerImage::before) to the states that the passes
    /// need, and then to [`LayerImage::after`](super::LayerImage::after). An image gets no barrier if its layout stays
    /// the same and neither side writes to it. Changes the pipeline, descriptor set 0, push constants, viewport and
    /// scissor of the command buffer's graphics bind point.
    ///
    /// # Errors
    /// [`VulkanError::NotRegistered`] and [`VulkanError::Argument`]. Nothing is recorded in these cases.
    ///
    /// # Safety
    /// The command buffer belongs to this device, is in the recording state, outside of render passes and dynamic
    /// rendering, and is submitted to the host's queue family. When it is executed, the images are in the state
    /// [`LayerImage::before`](super::LayerImage::before), and conditional rendering is inactive.
    pub unsafe fn record(
        &mut self,
        commands: vk::CommandBuffer,
        frame: &Frame,
        warp: &W,
    ) -> Result<(), VulkanError> {
        // SAFETY: the contract is the same.
        unsafe { self.record_passes(commands, frame, warp, None) }
    }

    /// Does the same as [`Pipeline::record`], for images whose uses before and after differ from frame to frame. A
    /// source is still sampled in the layout that its [`LayerImage::before`](super::LayerImage::before) leads to.
    ///
    /// # Errors
    /// Those of [`Pipeline::record`].
    ///
    /// # Safety
    /// Those of [`Pipeline::record`], with the states of `uses`.
    pub unsafe fn record_with_uses(
        &mut self,
        commands: vk::CommandBuffer,
        frame: &Frame,
        warp: &W,
        uses: &Uses,
    ) -> Result<(), VulkanError> {
        // SAFETY: the contract is the same.
        unsafe { self.record_passes(commands, frame, warp, Some(uses)) }
    }

    /// # Safety
    /// Those of [`Pipeline::record_with_uses`], or of [`Pipeline::record`].
    unsafe fn record_passes(
        &mut self,
        commands: vk::CommandBuffer,
        frame: &Frame,
        warp: &W,
        uses: Option<&Uses>,
    ) -> Result<(), VulkanError> {
        let (source, target) = self.registered(frame)?;
        let [source_size, target_size] = warp.sizes();
        self.check_frame(frame, warp.sizes(), source, target)?;

        let [tile_size, span_size] = map_sizes::<W>([source_size, target_size]);
        let part = source_size != source.images.size
            || tile_size != self.passes.tiles.map.size
            || span_size != self.passes.spans.map.size;
        let places = Places {
            source_origin: frame.source_origin,
            image_size: source.images.size,
            target_origin: frame.target_origin,
            part,
        };
        // SAFETY: the caller's buffer records outside of render passes. The registered images and the objects of this
        // pipeline live until the commands have been executed, as the constructors and `register_*` ask.
        let commands = unsafe { Commands::new(&self.device, commands, self.labels.as_ref()) };
        let (passes, timer) = (&self.passes, self.timer.as_ref());
        let recorder = Recorder { commands, rendering: &passes.rendering, timer, part };

        if let Some(timer) = timer {
            timer.begin(&commands);
        }
        self.acquire_images(&commands, source, target, uses);
        commands.bind(self.layouts.pipeline, source.textures, &warp.uniforms_from_top(&places));
        passes.tiles.record(&recorder, tile_size);
        recorder.stamp(Stamp::Tiles);
        passes.spans.record(&recorder, span_size);
        recorder.stamp(Stamp::Spans);
        let marks = warp.marks(self.options.holes);
        let area = area(frame.target_origin, target_size);
        passes.march.record(&recorder, &target.attachments, area, marks);
        recorder.stamp(Stamp::March);
        release_images(&commands, source, target, uses);

        if let Some(timer) = &mut self.timer {
            timer.end();
        }
        Ok(())
    }

    fn registered(&self, frame: &Frame) -> Result<(&Source, &Target), VulkanError> {
        let source = self.sources.iter().find(|source| source.id == frame.source);
        let target = self.targets.iter().find(|target| target.id == frame.target);
        source.zip(target).ok_or(VulkanError::NotRegistered)
    }

    fn check_frame(
        &self,
        frame: &Frame,
        [source_size, target_size]: [[u32; 2]; 2],
        source: &Source,
        target: &Target,
    ) -> Result<(), VulkanError> {
        check_size("a source", source_size, self.options.max_source_size)?;
        check_size("a target", target_size, self.options.max_target_size)?;
        check_rectangle("a source", frame.source_origin, source_size, source.images.size)?;
        check_rectangle("a target", frame.target_origin, target_size, target.images.size)?;
        Ok(())
    }

    /// Brings all images to the states that the passes need.
    fn acquire_images(&self, commands: &Commands, source: &Source, target: &Target, uses: Option<&Uses>) {
        let mut barriers = Barriers::new();
        for (image, state) in source.images(uses).chain(target.images(uses)) {
            barriers.registered(&image, image.before, state);
        }
        // The previous frame has read the intermediate buffers; their contents are not needed.
        let read = ImageState { layout: vk::ImageLayout::UNDEFINED, ..ImageState::SAMPLED };
        for map in self.passes.intermediates() {
            barriers.intermediate(map.image, read, ImageState::COLOR_ATTACHMENT);
        }
        barriers.record(commands);
    }

    /// Returns the size of the intermediate buffers in bytes.
    pub fn buffer_bytes(&self) -> u64 {
        self.passes.intermediates().map(|map| map_bytes(map.size)).iter().sum()
    }

    /// Returns the times of the passes in the frame that was recorded [`Options::timed_frames`] calls of
    /// [`Pipeline::record`] ago. Call it before recording the next frame, which reuses its queries. Does not wait.
    ///
    /// Returns `None` if fewer frames have been recorded, or if the queue family or the options provide no times.
    ///
    /// # Errors
    /// Those of vkGetQueryPoolResults, such as [`VulkanError::DeviceLost`].
    ///
    /// # Safety
    /// The commands of that frame have been executed.
    pub unsafe fn pass_times(&self) -> Result<Option<PassTimes>, VulkanError> {
        let Some(timer) = &self.timer else { return Ok(None) };
        // SAFETY: the caller says that the frame's commands have been executed.
        unsafe { timer.times(&self.device) }
    }
}

/// Brings the caller's images to the states they need afterwards.
fn release_images(commands: &Commands, source: &Source, target: &Target, uses: Option<&Uses>) {
    let mut barriers = Barriers::new();
    for (image, state) in source.images(uses).chain(target.images(uses)) {
        barriers.registered(&image, state, image.after);
    }
    barriers.record(commands);
}
