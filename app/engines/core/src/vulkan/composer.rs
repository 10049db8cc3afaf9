//! An eye made of its levels, recorded into the caller's command buffer.

use std::sync::Arc;

use ash::vk;

use super::adapter::Adapter;
use super::barriers::Barriers;
use super::commands::{Commands, Labels};
use super::formats::sampled_state;
use super::images::{self, Target};
use super::objects::Objects;
use super::passes::area;
use super::pipelines::{Layouts, PipelineFactory};
use super::targets::{PassKind, Rendering};
use super::{Host, ImageState, LayerImage, LevelsId, Options, TargetId, TargetImages, VulkanError, shaders};
use crate::eyes::Composition;
use crate::synthesis::backend::check_rectangle;
use crate::synthesis::{LevelPlaces, LevelUniforms};

/// The bindings that are filtered: the wide level's colour, and the inset's.
const FILTERED: &[usize] = &[1, 2];

/// The image of a level: colour in any format that can be filtered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LevelImage {
    /// Colour.
    pub color: LayerImage,
    /// Width and height of the image in pixels; the level may be a part of it.
    pub size: [u32; 2],
}

/// The images of an inset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InsetImage {
    /// Colour.
    pub image: LevelImage,
    /// The depth of a synthesized inset, which shows where it has holes at its border, in an image of the same size.
    pub depth: Option<LayerImage>,
}

/// The images of an eye's levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LevelImages {
    /// The wide level.
    pub wide: LevelImage,
    /// The inset, for a [`Composition`] that has one.
    pub inset: Option<InsetImage>,
}

/// The images of one call, and the places of the levels and of the eye in them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ComposedFrame {
    /// The levels.
    pub levels: LevelsId,
    /// Upper left corner of the wide level in its image, in pixels.
    pub wide_origin: [u32; 2],
    /// Upper left corner of the inset in its image.
    pub inset_origin: [u32; 2],
    /// Where to draw.
    pub target: TargetId,
    /// Upper left corner of the rectangle to write. Pixels outside of it are not changed.
    pub target_origin: [u32; 2],
}

impl ComposedFrame {
    /// Returns a frame at the upper left corners of all images.
    pub fn new(levels: LevelsId, target: TargetId) -> ComposedFrame {
        let origin = [0, 0];
        ComposedFrame { levels, wide_origin: origin, inset_origin: origin, target, target_origin: origin }
    }
}

/// Registered levels: their images' views and descriptors.
struct Registered {
    id: LevelsId,
    images: LevelImages,
    textures: vk::DescriptorSet,
    _objects: Objects,
}

impl Registered {
    /// Returns the images and the states in which they are read.
    fn images(&self) -> impl Iterator<Item = (LayerImage, ImageState)> {
        let inset = self.images.inset;
        let all = [Some(self.images.wide.color), inset.map(|i| i.image.color), inset.and_then(|i| i.depth)];
        all.into_iter().flatten().map(|image| (image, sampled_state(&image)))
    }
}

/// A pass that makes an eye from its levels: the inset where it covers the eye and has no hole at the border of what was
/// rendered, else the wide view, bilinearly.
///
/// Call the methods from one thread at a time. [`Composer::record`] only records, as that of a
/// [`Pipeline`](super::Pipeline) does.
pub struct Composer {
    adapter: Adapter,
    device: Arc<ash::Device>,
    options: Options,
    layouts: Layouts,
    rendering: Rendering,
    pipeline: vk::Pipeline,
    labels: Option<Labels>,
    levels: Vec<Registered>,
    targets: Vec<Target>,
    /// The id that was assigned last.
    last_id: u32,
    // The last field, so that these objects are destroyed after those of levels and targets.
    _objects: Objects,
}

impl Composer {
    /// Creates the pipeline for targets of this colour format. `cache` may be a null handle.
    ///
    /// # Errors
    /// [`VulkanError::Format`], [`VulkanError::QueueFamily`] and [`VulkanError::DynamicRendering`] for what the device
    /// does not support; errors of Vulkan's commands.
    ///
    /// # Safety
    /// Those of [`Pipeline::new`](super::Pipeline::new).
    pub unsafe fn new(
        host: &Host,
        color_format: vk::Format,
        cache: vk::PipelineCache,
    ) -> Result<Composer, VulkanError> {
        let options = Options {
            color_format,
            pipeline_cache: cache,
            max_source_size: [1; 2],
            max_target_size: [1; 2],
            ..Options::default()
        };
        // SAFETY: the caller's handles are valid and belong together.
        let adapter = unsafe { Adapter::new(host) };
        adapter.graphics_family(host.queue_family).map(drop)?;
        adapter.check_options(&options)?;
        let device = Arc::new(host.device.clone());
        // SAFETY: this module describes objects by what it has made itself. The caller keeps the device alive, and has
        // waited for all commands when these objects are dropped.
        let (mut objects, modules) = unsafe { (Objects::new(&device), Objects::new(&device)) };
        // SAFETY: the caller's handles are valid and belong together.
        let rendering = unsafe { Rendering::new(host, &mut objects, &options)? };
        let layouts = Layouts::new(&mut objects, size_of::<LevelUniforms>(), FILTERED)?;
        let mut factory = PipelineFactory {
            objects: &mut objects,
            modules,
            rendering: &rendering,
            layout: layouts.pipeline,
            options: &options,
            march_vertex: shaders::SCREEN,
        };
        let pipeline = factory.pipeline(shaders::COMPOSE, PassKind::Target, false)?;
        drop(factory);
        // SAFETY: the caller's handles are valid and belong together.
        let labels = unsafe { Labels::new(host) };
        Ok(Composer {
            adapter,
            device,
            options,
            layouts,
            rendering,
            pipeline,
            labels,
            levels: Vec::new(),
            targets: Vec::new(),
            last_id: 0,
            _objects: objects,
        })
    }

    fn next_id(&self) -> u32 {
        self.last_id.checked_add(1).unwrap_or(1)
    }

    /// Creates views and descriptors of an eye's levels.
    ///
    /// # Errors
    /// [`VulkanError::Format`] and [`VulkanError::Argument`]; errors of Vulkan's commands.
    ///
    /// # Safety
    /// The images are as [`LevelImages`] and [`LayerImage`] describe, and live until the id is released or the composer
    /// is dropped.
    pub unsafe fn register_levels(&mut self, images: &LevelImages) -> Result<LevelsId, VulkanError> {
        let colors = [Some(images.wide), images.inset.map(|inset| inset.image)];
        for image in colors.into_iter().flatten() {
            self.adapter.check_image_size("a level's image", image.size)?;
            images::check_color(&self.adapter, image.color.format, "a level's colour")?;
        }
        let depth = images.inset.and_then(|inset| inset.depth);
        if let Some(depth) = depth {
            images::check_depth(&self.adapter, depth.format, "an inset's depth")?;
        }
        // SAFETY: the caller's images are live, and outlive the objects, which are destroyed when the id is released.
        let mut objects = unsafe { Objects::new(&self.device) };
        let wide = images::sampled(&mut objects, &images.wide.color)?;
        // Every binding needs a texture, even one that is not sampled.
        let inset = match images.inset {
            Some(inset) => images::sampled(&mut objects, &inset.image.color)?,
            None => wide,
        };
        let depth = match depth {
            Some(depth) => images::sampled(&mut objects, &depth)?,
            None => wide,
        };
        let textures = images::texture_set(&mut objects, self.layouts.textures, &[depth, wide, inset])?;
        let id = LevelsId(self.next_id());
        self.last_id = id.0;
        self.levels.push(Registered { id, images: *images, textures, _objects: objects });
        Ok(id)
    }

    /// Creates views of an image to write to. It has no depth.
    ///
    /// # Errors
    /// [`VulkanError::OtherFormat`] and [`VulkanError::Argument`]; errors of Vulkan's commands.
    ///
    /// # Safety
    /// Those of [`Pipeline::register_target`](super::Pipeline::register_target).
    pub unsafe fn register_target(&mut self, images: &TargetImages) -> Result<TargetId, VulkanError> {
        images::check_target(&self.adapter, &self.options, images)?;
        // SAFETY: the caller's images are live, and outlive the objects, which are destroyed when the id is released.
        let objects = unsafe { Objects::new(&self.device) };
        let id = TargetId(self.next_id());
        let target = Target::new(objects, id, images, &self.rendering)?;
        self.last_id = id.0;
        self.targets.push(target);
        Ok(id)
    }

    /// Releases the objects of levels. Ignores an id that is not registered.
    ///
    /// # Safety
    /// No command that was recorded with the id is pending.
    pub unsafe fn release_levels(&mut self, id: LevelsId) {
        self.levels.retain(|levels| levels.id != id);
    }

    /// Releases the objects of a target. Ignores an id that is not registered.
    ///
    /// # Safety
    /// No command that was recorded with the id is pending.
    pub unsafe fn release_target(&mut self, id: TargetId) {
        self.targets.retain(|target| target.id != id);
    }

    /// Records the pass, with barriers as those of [`Pipeline::record`](super::Pipeline::record). Overwrites all of the
    /// target's rectangle, which has the composition's size.
    ///
    /// # Errors
    /// [`VulkanError::NotRegistered`] and [`VulkanError::Argument`]. Nothing is recorded in these cases.
    ///
    /// # Safety
    /// Those of [`Pipeline::record`](super::Pipeline::record).
    pub unsafe fn record(
        &self,
        commands: vk::CommandBuffer,
        frame: &ComposedFrame,
        composition: &Composition,
    ) -> Result<(), VulkanError> {
        let levels = self.levels.iter().find(|levels| levels.id == frame.levels);
        let target = self.targets.iter().find(|target| target.id == frame.target);
        let (levels, target) = levels.zip(target).ok_or(VulkanError::NotRegistered)?;
        let wide = levels.images.wide.size;
        check_rectangle("a wide level", frame.wide_origin, composition.wide.size, wide)?;
        check_rectangle("an eye", frame.target_origin, composition.size, target.images.size)?;
        let inset = composition.inset.zip(levels.images.inset);
        if let Some((inset, images)) = inset {
            check_rectangle("an inset", frame.inset_origin, inset.place.size, images.image.size)?;
        }
        let composition = Composition { inset: inset.map(|(inset, _)| inset), ..*composition };
        let places = LevelPlaces {
            target: frame.target_origin,
            wide: frame.wide_origin,
            wide_image: wide,
            inset: frame.inset_origin,
            inset_image: inset.map_or([1, 1], |(_, images)| images.image.size),
            depth: inset.is_some_and(|(_, images)| images.depth.is_some()),
        };

        // SAFETY: the caller's buffer records outside of render passes. The registered images and the objects of this
        // composer live until the commands have been executed, as `new` and `register_*` ask.
        let commands = unsafe { Commands::new(&self.device, commands, self.labels.as_ref()) };
        let images = || levels.images().chain(target.images(None));
        let mut barriers = Barriers::new();
        images().for_each(|(image, state)| barriers.registered(&image, image.before, state));
        barriers.record(&commands);
        let uniforms = LevelUniforms::rows_from_top(&composition, &places);
        commands.bind(self.layouts.pipeline, levels.textures, &uniforms);
        commands.group(c"yoro compose", || {
            let area = area(frame.target_origin, composition.size);
            self.rendering.draw(&commands, &target.attachments, self.pipeline, area, None);
        });
        let mut barriers = Barriers::new();
        images().for_each(|(image, state)| barriers.registered(&image, state, image.after));
        barriers.record(&commands);
        Ok(())
    }
}
