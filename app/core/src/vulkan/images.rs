//! Registered sources and targets.

use ash::vk;

use super::adapter::Adapter;
use super::formats::{aspects, is_depth, sampled_state};
use super::objects::Objects;
use super::passes::Passes;
use super::pipelines::TEXTURES;
use super::targets::{Attachments, PassKind};
use super::{
    ImageState, LayerImage, Options, SourceId, SourceImages, TargetId, TargetImages, Use, Uses, VulkanError,
};
use crate::synthesis::Edges;

/// A registered source: views and descriptors of its images.
pub(super) struct Source {
    pub(super) id: SourceId,
    pub(super) images: SourceImages,
    pub(super) textures: vk::DescriptorSet,
    _objects: Objects,
}

/// A registered target: views of its images, and a framebuffer for render passes.
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
    let sampled = vk::FormatFeatureFlags::SAMPLED_IMAGE;
    let filtered = sampled | vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
    adapter.check_format(images.color.format, filtered, "a source's colour")?;
    let depth = images.depth.format;
    if !is_depth(depth) && !matches!(depth, vk::Format::R16_UNORM | vk::Format::R32_SFLOAT) {
        return Err(VulkanError::Format { format: depth, role: "a source's depth" });
    }
    adapter.check_format(depth, sampled, "a source's depth")?;
    if images.sample_color.is_some() && options.edges != Edges::Multisample {
        return Err(VulkanError::SampleColors);
    }
    Ok(())
}

/// Checks that a target has the formats of the options and a size that the device can draw.
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
    /// Makes views and descriptors of images that [`check_source`] allows.
    pub(super) fn new(
        mut objects: Objects,
        id: SourceId,
        images: &SourceImages,
        layout: vk::DescriptorSetLayout,
        passes: &Passes,
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
        let samples = images.sample_color.as_ref().map(sampled).transpose()?;
        let sizes = [vk::DescriptorPoolSize {
            ty: vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
            descriptor_count: TEXTURES as u32,
        }];
        let set = objects.allocate_descriptor_set(layout, &sizes)?;
        let intermediate =
            |attachments: &Attachments, i| texture(attachments.color(i), ImageState::SAMPLED.layout);
        let layers = |i| passes.layers().map(|layers| intermediate(&layers.attachments, i));
        // The shaders of these edges read none of those that are None.
        let textures = [
            Some(depth),
            Some(color),
            Some(intermediate(&passes.tiles.map.attachments, 0)),
            Some(intermediate(&passes.spans.map.attachments, 0)),
            layers(0),
            layers(1),
            samples,
        ];
        write_textures(objects.device(), set, &textures);
        Ok(Source { id, images: *images, textures: set, _objects: objects })
    }

    /// The images in a call with these uses, or those of their registration, and the states in which the passes read them.
    pub(super) fn images(&self, uses: Option<&Uses>) -> impl Iterator<Item = (LayerImage, ImageState)> {
        let SourceImages { color, depth, sample_color, .. } = self.images;
        let uses =
            uses.map(|uses| [uses.source_color, uses.source_depth, uses.source_sample_color].map(Some));
        [Some(color), Some(depth), sample_color]
            .into_iter()
            .zip(uses.unwrap_or_default())
            .filter_map(|(image, other)| image.map(|image| (used(image, other), sampled_state(&image))))
    }
}

fn texture(view: vk::ImageView, layout: vk::ImageLayout) -> vk::DescriptorImageInfo {
    vk::DescriptorImageInfo::default().image_view(view).image_layout(layout)
}

/// Writes the textures of a set that no command uses yet.
fn write_textures(
    device: &ash::Device,
    set: vk::DescriptorSet,
    textures: &[Option<vk::DescriptorImageInfo>; TEXTURES],
) {
    let present = textures.iter().enumerate().filter(|(_, texture)| texture.is_some());
    let writes: Vec<_> = present
        .map(|(binding, texture)| {
            vk::WriteDescriptorSet::default()
                .dst_set(set)
                .dst_binding(binding as u32)
                .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
                .image_info(texture.as_slice())
        })
        .collect();
    // SAFETY: the set was just allocated from a pool of this device, and the views are live.
    unsafe { device.update_descriptor_sets(&writes, &[]) };
}

impl Target {
    /// Makes attachments of images that [`check_target`] allows.
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

    /// The images in a call with these uses, or those of their registration, and the states in which the last pass writes
    /// them.
    pub(super) fn images(&self, uses: Option<&Uses>) -> impl Iterator<Item = (LayerImage, ImageState)> {
        let color = used(self.images.color, uses.map(|uses| uses.target_color));
        let depth = self.images.depth.map(|depth| used(depth, uses.map(|uses| uses.target_depth)));
        let depth = depth.map(|depth| (depth, ImageState::DEPTH_ATTACHMENT));
        [Some((color, ImageState::COLOR_ATTACHMENT)), depth].into_iter().flatten()
    }
}

/// An image with other uses, if there are any.
fn used(image: LayerImage, other: Option<Use>) -> LayerImage {
    match other {
        Some(Use { before, after }) => LayerImage { before, after, ..image },
        None => image,
    }
}
