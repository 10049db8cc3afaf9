//! Formats, aspects and layouts of images.

use ash::vk;

use super::{ImageState, LayerImage};

/// Format of the layers, and of their tile map and span map. Every device can sample it and render to it.
pub(super) const MAP: vk::Format = vk::Format::R32_UINT;
/// Format of the tile map and span map of sources with hard edges. Every device can sample it and render to it.
pub(super) const LAW_MAP: vk::Format = vk::Format::R32G32B32A32_UINT;

/// Returns the format that stores the colour behind a source's edges.
///
/// It has the encoding of the source's colour, because unmixing must happen in the colour space of the resolve. Its
/// alpha holds the share of the front surface, for which ten-bit formats lack precision.
pub(super) fn background(color: vk::Format) -> vk::Format {
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

/// Returns the size in bytes of a texel of [`MAP`], [`LAW_MAP`] or a [`background`] format.
pub(super) fn texel_bytes(format: vk::Format) -> u64 {
    match format {
        LAW_MAP => 16,
        vk::Format::R16G16B16A16_SFLOAT => 8,
        _ => 4,
    }
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
