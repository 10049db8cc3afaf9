//! Registered sources and targets.

use ash::vk;

use super::adapter::Adapter;
use super::formats::{aspects, is_depth, sampled_state};
use super::objects::Objects;
use super::passes::Passes;
use super::pipelines::TEXTURES;
use super::targets::{Attachments, PassKind, Rendering};
use super::{
    ImageState, LayerImage, Options, SourceId, SourceImages, TargetId, TargetImages, Use, Uses, VulkanError,
};

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

/// Checks that the device can sample a source's images: filter its colour, and fetch its depth.
pub(super) fn check_source(adapter: &Adapter, images: &SourceImages) -> Result<(), VulkanError> {
    adapter.check_image_size("a source's image", images.size)?;
    check_color(adapter, images.color.format, "a source's colour")?;
    check_depth(adapter, images.depth.format, "a source's depth")
}

/// Checks that the device can filter a colour.
pub(super) fn check_color(
    adapter: &Adapter,
    format: vk::Format,
    role: &'static str,
) -> Result<(), VulkanError> {
    let filtered =
        vk::FormatFeatureFlags::SAMPLED_IMAGE | vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
    adapter.check_format(format, filtered, role)
}

/// Checks that the device can fetch a depth.
pub(super) fn check_depth(
    adapter: &Adapter,
    format: vk::Format,
    role: &'static str,
) -> Result<(), VulkanError> {
    if !is_depth(format) && !matches!(format, vk::Format::R16_UNORM | vk::Format::R32_SFLOAT) {
        return Err(VulkanError::Format { format, role });
    }
    adapter.check_format(format, vk::FormatFeatureFlags::SAMPLED_IMAGE, role)
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
    ) -> Result<Source, VulkanError> {
        let [depth, color] = [sampled(&mut objects, &images.depth)?, sampled(&mut objects, &images.color)?];
        let [tiles, spans] =
            passes.intermediates().map(|map| texture(map.attachments.color, ImageState::SAMPLED.layout));
        let set = texture_set(&mut objects, layout, &[depth, color, tiles, spans])?;
        Ok(Source { id, images: *images, textures: set, _objects: objects })
    }

    /// Returns each image, with its uses in a call or else those of its registration, and the state in which the passes
    /// read it.
    pub(super) fn images(&self, uses: Option<&Uses>) -> impl Iterator<Item = (LayerImage, ImageState)> {
        let color = (self.images.color, uses.map(|uses| uses.source_color));
        let depth = (self.images.depth, uses.map(|uses| uses.source_depth));
        [color, depth].into_iter().map(|(image, other)| (used(image, other), sampled_state(&image)))
    }
}

fn texture(view: vk::ImageView, layout: vk::ImageLayout) -> vk::DescriptorImageInfo {
    vk::DescriptorImageInfo::default().image_view(view).image_layout(layout)
}

/// Returns the texture of a registered image.
pub(super) fn sampled(
    objects: &mut Objects,
    image: &LayerImage,
) -> Result<vk::DescriptorImageInfo, VulkanError> {
    let aspect =
        if is_depth(image.format) { vk::ImageAspectFlags::DEPTH } else { vk::ImageAspectFlags::COLOR };
    let view = objects.create_view(image.image, image.format, aspect, image.layer)?;
    Ok(texture(view, sampled_state(image).layout))
}

/// Returns a new set with these textures at its first bindings.
pub(super) fn texture_set(
    objects: &mut Objects,
    layout: vk::DescriptorSetLayout,
    textures: &[vk::DescriptorImageInfo],
) -> Result<vk::DescriptorSet, VulkanError> {
    let sizes = [vk::DescriptorPoolSize {
        ty: vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
        descriptor_count: TEXTURES as u32,
    }];
    let set = objects.allocate_descriptor_set(layout, &sizes)?;
    let write = |(binding, texture)| {
        vk::WriteDescriptorSet::default()
            .dst_set(set)
            .dst_binding(binding as u32)
            .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
            .image_info(std::slice::from_ref(texture))
    };
    let writes: Vec<_> = textures.iter().enumerate().map(write).collect();
    // SAFETY: the set was just allocated from a pool of this device, no command uses it, and the views are live.
    unsafe { objects.device().update_descriptor_sets(&writes, &[]) };
    Ok(set)
}

impl Target {
    /// Creates attachments of images that passed [`check_target`].
    pub(super) fn new(
        mut objects: Objects,
        id: TargetId,
        images: &TargetImages,
        rendering: &Rendering,
    ) -> Result<Target, VulkanError> {
        let mut view = |image: &LayerImage| {
            objects.create_view(image.image, image.format, aspects(image.format), image.layer)
        };
        let color = view(&images.color)?;
        let depth = images.depth.as_ref().map(view).transpose()?;
        let attachments = rendering.attachments(&mut objects, PassKind::Target, color, depth, images.size)?;
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
