//! Synthesis, recorded into the caller's command encoder.

use wgpu::{CommandEncoder, Device, Queue, TextureView};
use yoro::eyes::{MotionWarp, PoseWarp, Warp};
use yoro::synthesis::backend::{Places, WarpKind, map_sizes};

use crate::buffers::Buffers;
use crate::checks::{Checks, made, size};
use crate::passes::{Drawn, Groups, Passes};
use crate::shaders::Shaders;
use crate::uniforms::UniformRing;
use crate::{Options, Source, Target, WgpuError};

/// The bindings of a source are dropped, and with them its textures, after this many calls without it.
pub(crate) const KEPT_CALLS: u64 = 32;

/// Synthesis between parallel eyes: the march goes along the source's row.
pub type Gather = Pipeline<Warp>;

/// Synthesis of a view in any pose near the source's: the march goes along a segment of any direction.
pub type AnyView = Pipeline<PoseWarp>;

/// Synthesis of motion vectors between parallel eyes, for runtimes that make frames between those that are rendered. The
/// source's colour is the vectors' texture, Rgba16Float with three components in NDC
/// ([`VectorSpace`](yoro::eyes::VectorSpace)), with depth of the same size: that of the vectors that a runtime recommends,
/// not that of the eye. The target receives vectors, and depth with [`Options::depth_format`]. Silhouettes are not
/// blended, and a hole has its background's vector.
pub type Motion = Pipeline<MotionWarp>;

/// The passes for one kind of warp: [`Gather`], [`AnyView`] or [`Motion`].
///
/// All calls share the intermediate buffers, so submit what they record to one queue. Up to 64 calls may be recorded
/// before the first of them is submitted.
pub struct Pipeline<W: WarpKind> {
    checks: Checks,
    passes: Passes,
    uniforms: UniformRing<W::Uniforms>,
    buffers: Option<Buffers>,
    kept: Vec<Kept>,
    calls: u64,
}

/// The objects that were created for a source.
struct Kept {
    /// Colour and depth of the source.
    views: [TextureView; 2],
    groups: Groups,
    /// The number of the last call that used them.
    used: u64,
}

impl<W: WarpKind> Pipeline<W> {
    /// Creates the pipelines, which do not depend on the textures.
    ///
    /// # Errors
    /// [`WgpuError::Format`] if the device does not support the options, [`WgpuError::Holes`] if these holes cannot be left
    /// open, and [`WgpuError::Refused`] for any other error
    /// of wgpu. In a browser such errors go to the device's handler of uncaptured errors instead.
    pub fn new(device: &Device, options: &Options) -> Result<Pipeline<W>, WgpuError> {
        let checks = Checks::new(device, options)?;
        let march = Shaders::of::<W>().march(options)?;
        let make = || (Passes::new::<W>(device, options, march), UniformRing::new(device, "yoro uniforms"));
        let (passes, uniforms) = made(device, make)?;
        Ok(Pipeline { checks, passes, uniforms, buffers: None, kept: Vec::new(), calls: 0 })
    }

    /// Creates the intermediate buffers for sources and targets up to these sizes in pixels. [`Pipeline::record`] does
    /// so when a size is larger than all before; call this first so that no frame has to.
    ///
    /// # Errors
    /// [`WgpuError::Refused`] if there is not enough memory.
    pub fn prepare(
        &mut self,
        device: &Device,
        max_source_size: [u32; 2],
        max_target_size: [u32; 2],
    ) -> Result<(), WgpuError> {
        let sizes = [max_source_size, max_target_size];
        let sizes = self.buffers.as_ref().map_or(Some(sizes), |buffers| buffers.grown(sizes));
        let Some(sizes) = sizes else { return Ok(()) };
        self.buffers = Some(made(device, || Buffers::new::<W>(device, sizes))?);
        // The bindings refer to the old buffers.
        self.kept.clear();
        Ok(())
    }

    /// Records the passes. Each is a render pass, so call this outside render passes. The target must not be one of the
    /// source's textures. See [`Source`] and [`Target`] for what they must be.
    ///
    /// The bindings for the views of a source are kept for the next calls with the same views, until 32 calls in a row
    /// were without them. Buffers are created when sizes are larger than all before.
    ///
    /// # Errors
    /// A [`WgpuError`] if the arguments do not fit, or [`WgpuError::DeviceLost`]. Nothing is recorded then.
    pub fn record(
        &mut self,
        device: &Device,
        queue: &Queue,
        encoder: &mut CommandEncoder,
        source: &Source,
        warp: &W,
        target: &Target,
    ) -> Result<(), WgpuError> {
        let [source_size, target_size] = warp.sizes();
        self.checks.frame(source, warp.sizes(), target)?;
        W::check_components(source.color.texture().format().components().into())?;
        let places = Places {
            source_origin: source.origin,
            image_size: size(source.color),
            target_origin: target.origin,
            part: true,
        };
        let uniforms = self.uniforms.write(queue, &warp.uniforms_from_top(&places))?;
        self.prepare(device, source_size, target_size)?;
        self.calls += 1;
        let index = self.bound(device, source);
        let Some(buffers) = &self.buffers else { return Ok(()) };

        let [[x, y], [width, height]] = [target.origin, target_size];
        let drawn = Drawn {
            color: target.color,
            depth: target.depth,
            area: [x, y, width, height],
            whole: size(target.color) == target_size,
            marks: warp.marks(self.checks.options.holes),
        };
        let sizes = map_sizes::<W>([source_size, target_size]);
        self.passes.record(encoder, &self.kept[index].groups, buffers, sizes, uniforms, &drawn);
        Ok(())
    }

    /// Returns the index of a source's bindings in `kept`.
    fn bound(&mut self, device: &Device, source: &Source) -> usize {
        let calls = self.calls;
        let views = [source.color, source.depth];
        self.kept.retain(|kept| kept.used + KEPT_CALLS >= calls);
        let found = self.kept.iter().position(|kept| kept.views.each_ref() == views);
        let index = found.unwrap_or(self.kept.len());
        if let (None, Some(buffers)) = (found, &self.buffers) {
            let groups = self.passes.groups(device, source, buffers, &self.uniforms);
            self.kept.push(Kept { views: views.map(Clone::clone), groups, used: calls });
        }
        self.kept[index].used = calls;
        index
    }

    /// Returns the size of the intermediate buffers' texels in bytes; 0 before they exist.
    pub fn buffer_bytes(&self) -> u64 {
        self.buffers.as_ref().map_or(0, Buffers::bytes)
    }
}

#[cfg(test)]
mod tests {
    use wgpu::{Extent3d, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages};
    use yoro::eyes::{DepthConvention, DisparityMap, Eye};

    use super::*;

    fn view(device: &Device, format: TextureFormat, usage: TextureUsages) -> TextureView {
        let texture = device.create_texture(&TextureDescriptor {
            label: None,
            size: Extent3d { width: 64, height: 64, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        });
        texture.create_view(&Default::default())
    }

    fn warp(size: [u32; 2]) -> Warp {
        Warp {
            source_size: size,
            target_size: size,
            law: DisparityMap { offset: 0.0, scale: 5.0 },
            row_offset: 0,
            target_eye: Eye::Left,
            convention: DepthConvention::Reversed,
        }
    }

    #[test]
    fn an_engine_may_keep_it_in_any_thread() {
        fn in_any_thread<T: Send + Sync>() {}
        in_any_thread::<Gather>();
    }

    #[test]
    fn bindings_are_kept_while_the_views_are_used_and_buffers_only_grow() {
        // A device that draws nothing.
        let (device, queue) = Device::noop(&wgpu::DeviceDescriptor::default());
        let mut gather = Gather::new(&device, &Options::default()).unwrap();
        let binding = TextureUsages::TEXTURE_BINDING;
        let sources = [0, 1].map(|_| {
            [TextureFormat::Rgba8Unorm, TextureFormat::Depth32Float]
                .map(|format| view(&device, format, binding))
        });
        let target = view(&device, TextureFormat::Rgba8Unorm, TextureUsages::RENDER_ATTACHMENT);
        let record = |gather: &mut Gather, source: usize, size| {
            let [color, depth] = &sources[source];
            let mut encoder = device.create_command_encoder(&Default::default());
            let (source, target) = (Source::new(color, depth), Target::new(&target));
            gather.record(&device, &queue, &mut encoder, &source, &warp(size), &target).unwrap();
            drop(encoder.finish());
        };
        (0..100).for_each(|frame| record(&mut gather, frame % 2, [40, 40]));
        assert_eq!(gather.kept.len(), 2);
        let tiles = |gather: &Gather| gather.buffers.as_ref().map(|buffers| buffers.tiles.clone());
        let (before, bytes) = (tiles(&gather), gather.buffer_bytes());
        assert_eq!(bytes, 2 * 16 * 3 * 5);
        record(&mut gather, 0, [20, 30]);
        assert_eq!((tiles(&gather), gather.buffer_bytes()), (before.clone(), bytes));
        (0..40).for_each(|_| record(&mut gather, 1, [40, 40]));
        assert_eq!(gather.kept.len(), 1, "the textures of a source that is used no more are released");
        record(&mut gather, 1, [20, 64]);
        assert_ne!(tiles(&gather), before);
        assert_eq!(gather.buffer_bytes(), 2 * 16 * 3 * 8);
    }
}
