//! Formats, aspects and layouts of images.

use ash::vk;

use super::{ImageState, LayerImage};

/// Format of the tile map and span map. Every device can sample it and render to it.
pub(super) const MAP: vk::Format = vk::Format::R32G32B32A32_UINT;

/// Returns the size in bytes of a map of this size.
pub(super) fn map_bytes([width, height]: [u32; 2]) -> u64 {
    16 * u64::from(width) * u64::from(height)
}

/// Returns all aspects of a format.
pub(super) fn aspects(format: vk::Format) -> vk::ImageAspectFlags {
    match format {
        vk::Format::D16_UNORM | vk::Format::X8_D24_UNORM_PACK32 | vk::Format::D32_SFLOAT => {
            vk::ImageAspectFlags::DEPTH
        }
        vk::Format::S8_UINT => vk::ImageAspectFlags::STENCIL,
        vk::Format::D16_UNORM_S8_UINT | vk::Format::D24_UNORM_S8_UINT | vk::Format::D32_SFLOAT_S8_UINT => {
            vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL
        }
        _ => vk::ImageAspectFlags::COLOR,
    }
}

pub(super) fn is_depth(format: vk::Format) -> bool {
    aspects(format).contains(vk::ImageAspectFlags::DEPTH)
}

/// Returns mip level 0 of one layer.
pub(super) fn range(aspects: vk::ImageAspectFlags, layer: u32) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: aspects,
        base_mip_level: 0,
        level_count: 1,
        base_array_layer: layer,
        layer_count: 1,
    }
}

/// Returns the state in which a source's image is sampled: in its current layout if that allows sampling.
pub(super) fn sampled_state(image: &LayerImage) -> ImageState {
    let layout = match image.before.layout {
        layout @ (vk::ImageLayout::GENERAL
        | vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL
        | vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL
        | vk::ImageLayout::DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL) => layout,
        _ => ImageState::SAMPLED.layout,
    };
    ImageState { layout, ..ImageState::SAMPLED }
}

/// Returns the number of components of a colour format that can be filtered, 4 if it has three or more.
pub(super) fn components(format: vk::Format) -> u32 {
    match format {
        vk::Format::R8_UNORM | vk::Format::R8_SNORM | vk::Format::R16_UNORM | vk::Format::R16_SNORM => 1,
        vk::Format::R16_SFLOAT | vk::Format::R32_SFLOAT | vk::Format::R8_SRGB => 1,
        vk::Format::R8G8_UNORM | vk::Format::R8G8_SNORM | vk::Format::R8G8_SRGB => 2,
        vk::Format::R16G16_UNORM | vk::Format::R16G16_SNORM => 2,
        vk::Format::R16G16_SFLOAT | vk::Format::R32G32_SFLOAT => 2,
        _ => 4,
    }
}
