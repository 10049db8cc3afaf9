//! The textures that one pass writes and the next ones read.

use wgpu::{
    Device, Extent3d, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView,
};
use yoro::synthesis::backend::{WarpKind, map_sizes};

/// Format of the tile map and the span map.
pub(crate) const MAP: TextureFormat = TextureFormat::Rgba32Uint;

/// Buffers for the largest sizes so far.
pub(crate) struct Buffers {
    /// The sizes of source and target.
    sizes: [[u32; 2]; 2],
    pub(crate) tiles: TextureView,
    pub(crate) spans: TextureView,
}

impl Buffers {
    /// Returns larger sizes if images of these sizes do not fit.
    pub(crate) fn grown(&self, sizes: [[u32; 2]; 2]) -> Option<[[u32; 2]; 2]> {
        let grown = [0, 1].map(|image| [0, 1].map(|i: usize| self.sizes[image][i].max(sizes[image][i])));
        Some(grown).filter(|grown| *grown != self.sizes)
    }

    pub(crate) fn new<W: WarpKind>(device: &Device, sizes: [[u32; 2]; 2]) -> Buffers {
        let [tiles, spans] = map_sizes::<W>(sizes);
        Buffers { sizes, tiles: map(device, "yoro tiles", tiles), spans: map(device, "yoro spans", spans) }
    }

    /// Returns the size of all texels in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let bytes = |view: &TextureView| {
            let (texture, texel) = (view.texture(), view.texture().format().block_copy_size(None));
            u64::from(texture.width()) * u64::from(texture.height()) * u64::from(texel.unwrap_or(0))
        };
        bytes(&self.tiles) + bytes(&self.spans)
    }
}

fn map(device: &Device, label: &'static str, [width, height]: [u32; 2]) -> TextureView {
    let texture = device.create_texture(&TextureDescriptor {
        label: Some(label),
        size: Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: MAP,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}
