//! The nearest depth of each pixel's samples.

use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, CommandEncoder, CompareFunction, DepthStencilState,
    Device, FragmentState, LoadOp, Operations, PipelineLayoutDescriptor, RenderPassDepthStencilAttachment,
    RenderPassDescriptor, RenderPipeline, RenderPipelineDescriptor, ShaderModuleDescriptor, ShaderSource,
    ShaderStages, StoreOp, TextureDescriptor, TextureFormat, TextureSampleType, TextureUsages, TextureView,
    TextureViewDimension, VertexState,
};
use yoro::eyes::DepthConvention;

use crate::WgpuError;
use crate::checks::made;
use crate::pipeline::KEPT_CALLS;
use crate::shaders::{NEAREST_DEPTH, NEAREST_DEPTH_REVERSED, SCREEN};

/// A pass that takes the depth of each pixel's nearest sample. wgpu resolves colour, but not depth; a multisampled source
/// consists of the resolved colour and this depth. Not for wgpu's OpenGL, which cannot sample such textures.
pub struct NearestDepth {
    layout: BindGroupLayout,
    pipeline: RenderPipeline,
    kept: Vec<Kept>,
    calls: u64,
}

/// The objects that were created for a multisampled depth.
struct Kept {
    samples: TextureView,
    group: BindGroup,
    nearest: TextureView,
    /// The number of the last call that used them.
    used: u64,
}

impl NearestDepth {
    /// Creates the pipeline.
    ///
    /// # Errors
    /// [`WgpuError::Refused`] for an error of wgpu. In a browser it goes to the device's handler of uncaptured errors.
    pub fn new(device: &Device, convention: DepthConvention) -> Result<NearestDepth, WgpuError> {
        let text = match convention {
            DepthConvention::Standard => NEAREST_DEPTH,
            DepthConvention::Reversed => NEAREST_DEPTH_REVERSED,
        };
        let label = Some("yoro nearest depth");
        made(device, || {
            let module = |text: &'static str| {
                let source = ShaderSource::Wgsl(text.into());
                device.create_shader_module(ShaderModuleDescriptor { label, source })
            };
            let entry = BindGroupLayoutEntry {
                binding: 0,
                visibility: ShaderStages::FRAGMENT,
                ty: BindingType::Texture {
                    sample_type: TextureSampleType::Float { filterable: false },
                    view_dimension: TextureViewDimension::D2,
                    multisampled: true,
                },
                count: None,
            };
            let layout =
                device.create_bind_group_layout(&BindGroupLayoutDescriptor { label, entries: &[entry] });
            let pipeline_layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
                label,
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            });
            let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
                label,
                layout: Some(&pipeline_layout),
                vertex: VertexState {
                    module: &module(SCREEN),
                    entry_point: Some("main"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: Default::default(),
                depth_stencil: Some(DepthStencilState {
                    format: TextureFormat::Depth32Float,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(CompareFunction::Always),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: Some(FragmentState {
                    module: &module(text),
                    entry_point: Some("main"),
                    compilation_options: Default::default(),
                    targets: &[],
                }),
                multiview_mask: None,
                cache: None,
            });
            NearestDepth { layout, pipeline, kept: Vec::new(), calls: 0 }
        })
    }

    /// Records the pass, outside of render passes, and returns a view of the nearest depth, of the same size. `samples`
    /// shows the depth of one layer of a multisampled texture with the usage TEXTURE_BINDING. The result is kept for the
    /// next calls with the same view, until 32 calls in a row were without it.
    pub fn record(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        samples: &TextureView,
    ) -> &TextureView {
        self.calls += 1;
        let calls = self.calls;
        self.kept.retain(|kept| kept.used + KEPT_CALLS >= calls);
        let found = self.kept.iter().position(|kept| kept.samples == *samples);
        let index = found.unwrap_or_else(|| {
            self.kept.push(self.keep(device, samples));
            self.kept.len() - 1
        });
        let kept = &mut self.kept[index];
        kept.used = calls;
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("yoro nearest depth"),
            depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                view: &kept.nearest,
                depth_ops: Some(Operations { load: LoadOp::Clear(0.0), store: StoreOp::Store }),
                stencil_ops: None,
            }),
            ..RenderPassDescriptor::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &kept.group, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        &kept.nearest
    }

    fn keep(&self, device: &Device, samples: &TextureView) -> Kept {
        let label = Some("yoro nearest depth");
        let texture = device.create_texture(&TextureDescriptor {
            label,
            sample_count: 1,
            format: TextureFormat::Depth32Float,
            usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
            size: wgpu::Extent3d { depth_or_array_layers: 1, ..samples.texture().size() },
            mip_level_count: 1,
            dimension: wgpu::TextureDimension::D2,
            view_formats: &[],
        });
        let entries = [BindGroupEntry { binding: 0, resource: BindingResource::TextureView(samples) }];
        let group =
            device.create_bind_group(&BindGroupDescriptor { label, layout: &self.layout, entries: &entries });
        let nearest = texture.create_view(&Default::default());
        Kept { samples: samples.clone(), group, nearest, used: self.calls }
    }
}
