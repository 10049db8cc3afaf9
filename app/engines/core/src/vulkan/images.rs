//! Registered sources and targets.

use ash::vk;

use super::adapter::Adapter;
use super::formats::{aspects, is_depth, sampled_state};
use super::objects::Objects;
use super::passes::Passes;
use super::pipelines::{HISTORY, TEXTURES};
use super::targets::{Attachments, PassKind};
use super::{
    ImageState, LayerImage, Options, SourceId, SourceImages, TargetId, TargetImages, Use, Uses, VulkanError,
};
use crate::synthesis::Edges;

/// A registered source: its images' views and descriptors.
pub(super) struct Source {
    pub(super) id: SourceId,
    pub(super) images: SourceImages,
    pub(super) textures: vk::DescriptorSet,
    _objects: Objects,
}

/// A registered target: its images' views, and a framebuffer for render passes.
pub(super) struct Target {
    pub(super) id: TargetId,
    pub(super) images: TargetImages,
    pub(super) attachments: Attachments,
    _objects: Objects,
}

/// Checks that the device can sample a source's images.
pub(super) fn check_source(
    adapter: &Adapter,
    options: &Options,
    images: &SourceImages,
) -> Result<(), VulkanError> {
    adapter.check_image_size("a source's image", images.size)?;
    check_sampled(adapter, [&images.color, &images.depth], ["a source's colour", "a source's depth"])?;
    if let Some(history) = &images.history {
        if !options.history {
            return Err(VulkanError::History);
        }
        adapter.check_image_size("a history's image", history.size)?;
        let roles = ["a history's colour", "a history's depth"];
        check_sampled(adapter, [&history.color, &history.depth], roles)?;
    }
    if images.sample_color.is_some() && options.edges != Edges::Multisample {
        return Err(VulkanError::SampleColors);
    }
    Ok(())
}

/// Checks that the device can filter colour and fetch depth.
fn check_sampled(
    adapter: &Adapter,
    [color, depth]: [&LayerImage; 2],
    [color_role, role]: [&'static str; 2],
) -> Result<(), VulkanError> {
    let sampled = vk::FormatFeatureFlags::SAMPLED_IMAGE;
    let filtered = sampled | vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
    adapter.check_format(color.format, filtered, color_role)?;
    let format = depth.format;
    if !is_depth(format) && !matches!(format, vk::Format::R16_UNORM | vk::Format::R32_SFLOAT) {
        return Err(VulkanError::Format { format, role });
    }
    adapter.check_format(format, sampled, role)
}

/// Checks that a target has the formats of the options, and a size that the device supports.
pub(super) fn check_target(
    adapter: &Adapter,
    options: &Options,
    images: &TargetImages,
) -> Result<(), VulkanError> {
    let format = |depth: Option<vk::Format>| depth.unwrap_or(vk::Format::UNDEFINED);
    for (expected, found) in [
        (options.color_format, images.color.format),
        (format(options.depth_format), format(images.depth.map(|depth| depth.format))),
    ] {
        if expected != found {
            return Err(VulkanError::OtherFormat { expected, found });
        }
    }
    adapter.check_image_size("a target's image", images.size)
}

impl Source {
    /// Creates views and descriptors of images that passed [`check_source`].
    pub(super) fn new(
        mut objects: Objects,
        id: SourceId,
        images: &SourceImages,
        layout: vk::DescriptorSetLayout,
        passes: &Passes,
        strips: Option<vk::Buffer>,
    ) -> Result<Source, VulkanError> {
        let mut sampled = |image: &LayerImage| {
            let aspect = if is_depth(image.format) {
                vk::ImageAspectFlags::DEPTH
            } else {
                vk::ImageAspectFlags::COLOR
            };
            let view = objects.create_view(image.image, image.format, aspect, image.layer)?;
            Ok(texture(view, sampled_state(image).layout))
        };
        let color = sampled(&images.color)?;
        let depth = sampled(&images.depth)?;
        let samples = images.sample_color.as_ref().map(&mut sampled).transpose()?;
        let history = match &images.history {
            Some(history) => [sampled(&history.depth)?, sampled(&history.color)?],
            // The shaders do not read these textures.
            None => [color; 2],
        };
        let pool = |ty, count| vk::DescriptorPoolSize { ty, descriptor_count: count as u32 };
        let sizes = [
            pool(vk::DescriptorType::COMBINED_IMAGE_SAMPLER, TEXTURES + history.len()),
            pool(vk::DescriptorType::UNIFORM_BUFFER, 1),
        ];
        let set = objects.allocate_descriptor_set(layout, &sizes)?;
        let intermediate =
            |attachments: &Attachments, i| texture(attachments.color(i), ImageState::SAMPLED.layout);
        let layers = |i| passes.layers().map(|layers| intermediate(&layers.attachments, i));
        // Textures that are `None` are not read by the shaders of this pipeline's passes.
        let textures = [
            Some(depth),
            Some(color),
            Some(intermediate(&passes.tiles.map.attachments, 0)),
            Some(intermediate(&passes.spans.map.attachments, 0)),
            layers(0),
            layers(1),
            samples,
        ];
        write_textures(objects.device(), set, 0, &textures);
        if let Some(strips) = strips {
            write_textures(objects.device(), set, HISTORY, &history.map(Some));
            write_strips(objects.device(), set, HISTORY + history.len(), strips);
        }
        Ok(Source { id, images: *images, textures: set, _objects: objects })
    }

    /// Returns each image, with its uses in a call or else those of its registration, and the state in which the passes
    /// read it.
    pub(super) fn images(&self, uses: Option<&Uses>) -> impl Iterator<Item = (LayerImage, ImageState)> {
        let SourceImages { color, depth, sample_color, history, .. } = self.images;
        let uses = uses.map(|uses| {
            let Uses {
                source_color, source_depth, source_sample_color, history_color, history_depth, ..
            } = *uses;
            [source_color, source_depth, source_sample_color, history_color, history_depth].map(Some)
        });
        let [former_color, former_depth] =
            [history.map(|history| history.color), history.map(|history| history.depth)];
        [Some(color), Some(depth), sample_color, former_color, former_depth]
            .into_iter()
            .zip(uses.unwrap_or_default())
            .filter_map(|(image, other)| image.map(|image| (used(image, other), sampled_state(&image))))
    }
}

fn texture(view: vk::ImageView, layout: vk::ImageLayout) -> vk::DescriptorImageInfo {
    vk::DescriptorImageInfo::default().image_view(view).image_layout(layout)
}

/// Writes textures from binding `first` on, to a set that no command uses yet.
fn write_textures(
    device: &ash::Device,
    set: vk::DescriptorSet,
    first: usize,
    textures: &[Option<vk::DescriptorImageInfo>],
) {
    let present = textures.iter().enumerate().filter(|(_, texture)| texture.is_some());
    let writes: Vec<_> = present
        .map(|(binding, texture)| {
            vk::WriteDescriptorSet::default()
                .dst_set(set)
                .dst_binding((first + binding) as u32)
                .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
                .image_info(texture.as_slice())
        })
        .collect();
    // SAFETY: the set was just allocated from a pool of this device, and the views are live.
    unsafe { device.update_descriptor_sets(&writes, &[]) };
}

/// Writes the block of strips to a set that no command uses yet.
fn write_strips(device: &ash::Device, set: vk::DescriptorSet, binding: usize, strips: vk::Buffer) {
    let buffer = [vk::DescriptorBufferInfo::default().buffer(strips).range(vk::WHOLE_SIZE)];
    let write = vk::WriteDescriptorSet::default()
        .dst_set(set)
        .dst_binding(binding as u32)
        .descriptor_type(vk::DescriptorType::UNIFORM_BUFFER)
        .buffer_info(&buffer);
    // SAFETY: the set was just allocated from a pool of this device, and the buffer is live.
    unsafe { device.update_descriptor_sets(&[write], &[]) };
}

impl Target {
    /// Creates attachments of images that passed [`check_target`].
    pub(super) fn new(
        mut objects: Objects,
        id: TargetId,
        images: &TargetImages,
        passes: &Passes,
    ) -> Result<Target, VulkanError> {
        let mut view = |image: &LayerImage| {
            objects.create_view(image.image, image.format, aspects(image.format), image.layer)
        };
        let color = view(&images.color)?;
        let depth = images.depth.as_ref().map(view).transpose()?;
        let attachments =
            passes.rendering.attachments(&mut objects, PassKind::Target, &[color], depth, images.size)?;
        Ok(Target { id, images: *images, attachments, _objects: objects })
    }

    /// Returns each image, with its uses in a call or else those of its registration, and the state in which the last
    /// pass writes it.
    pub(super) fn images(&self, uses: Option<&Uses>) -> impl Iterator<Item = (LayerImage, ImageState)> {
        let color = used(self.images.color, uses.map(|uses| uses.target_color));
        let depth = self.images.depth.map(|depth| used(depth, uses.map(|uses| uses.target_depth)));
        let depth = depth.map(|depth| (depth, ImageState::DEPTH_ATTACHMENT));
        [Some((color, ImageState::COLOR_ATTACHMENT)), depth].into_iter().flatten()
    }
}

/// Returns the image with these uses, if given.
fn used(image: LayerImage, other: Option<Use>) -> LayerImage {
    match other {
        Some(Use { before, after }) => LayerImage { before, after, ..image },
        None => image,
    }
}
