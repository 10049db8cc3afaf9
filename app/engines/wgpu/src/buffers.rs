//! The textures that one pass writes and the next ones read.

use wgpu::{
    Device, Extent3d, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView,
};
use yoro::synthesis::{Edges, span_tiles, tiles};

use crate::Options;

/// Format of the layers, and of the tile map and span map that belong to them.
const MAP: TextureFormat = TextureFormat::R32Uint;
/// Format of the tile map and span map of sources with hard edges, whose tiles have laws.
const LAW_MAP: TextureFormat = TextureFormat::Rgba32Uint;

/// Returns the format of the tile map and the span map.
pub(crate) fn map_format(edges: Edges) -> TextureFormat {
    if edges == Edges::Hard { LAW_MAP } else { MAP }
}

/// Returns the formats of two textures: the surfaces that each source pixel shows, and the colour behind them.
///
/// The colour has the encoding of the source, because unmixing must use the same colour space as the resolve. Its alpha
/// holds the share of the front surface, for which ten-bit formats have no room.
pub(crate) fn layer_formats(color: TextureFormat) -> [TextureFormat; 2] {
    let background = match color {
        TextureFormat::Rgba8UnormSrgb | TextureFormat::Bgra8UnormSrgb => TextureFormat::Rgba8UnormSrgb,
        TextureFormat::Rgba8Unorm | TextureFormat::Bgra8Unorm => TextureFormat::Rgba8Unorm,
        _ => TextureFormat::Rgba16Float,
    };
    [MAP, background]
}

/// Buffers for the largest sizes so far.
pub(crate) struct Buffers {
    source_size: [u32; 2],
    target_size: [u32; 2],
    pub(crate) tiles: TextureView,
    pub(crate) spans: TextureView,
    /// `None` for hard edges.
    pub(crate) layers: Option<[TextureView; 2]>,
}

impl Buffers {
    /// True if images of these sizes fit.
    pub(crate) fn hold(&self, source_size: [u32; 2], target_size: [u32; 2]) -> bool {
        self.grown(source_size, target_size) == (self.source_size, self.target_size)
    }

    /// Returns the sizes that are needed for both these buffers and the given images.
    pub(crate) fn grown(&self, source_size: [u32; 2], target_size: [u32; 2]) -> ([u32; 2], [u32; 2]) {
        let larger = |a: [u32; 2], b: [u32; 2]| [a[0].max(b[0]), a[1].max(b[1])];
        (larger(self.source_size, source_size), larger(self.target_size, target_size))
    }

    pub(crate) fn new(
        device: &Device,
        options: &Options,
        any_view: bool,
        (source_size, target_size): ([u32; 2], [u32; 2]),
    ) -> Buffers {
        let map = map_format(options.edges);
        let [layer, background] = layer_formats(options.color_format);
        let layers = || {
            [
                texture(device, "yoro layers", layer, source_size),
                texture(device, "yoro background", background, source_size),
            ]
        };
        Buffers {
            source_size,
            target_size,
            tiles: texture(device, "yoro tiles", map, tiles(source_size)),
            spans: texture(device, "yoro spans", map, span_tiles(any_view, source_size, target_size)),
            layers: (options.edges != Edges::Hard).then(layers),
        }
    }

    /// Returns the size of all texels in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let bytes = |view: &TextureView| {
            let (texture, texel) = (view.texture(), view.texture().format().block_copy_size(None));
            u64::from(texture.width()) * u64::from(texture.height()) * u64::from(texel.unwrap_or(0))
        };
        [&self.tiles, &self.spans].into_iter().chain(self.layers.iter().flatten()).map(bytes).sum()
    }
}

fn texture(
    device: &Device,
    label: &'static str,
    format: TextureFormat,
    [width, height]: [u32; 2],
) -> TextureView {
    let texture = device.create_texture(&TextureDescriptor {
        label: Some(label),
        size: Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}
