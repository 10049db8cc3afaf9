//! The fragment passes of the pipeline, in the order in which they are recorded.

use bytemuck::NoUninit;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, BufferBindingType, BufferSize, ColorTargetState,
    CommandEncoder, CompareFunction, DepthStencilState, Device, FilterMode, FragmentState, LoadOp,
    Operations, PipelineLayoutDescriptor, RenderPassColorAttachment, RenderPassDepthStencilAttachment,
    RenderPassDescriptor, RenderPipeline, RenderPipelineDescriptor, Sampler, SamplerBindingType,
    SamplerDescriptor, ShaderModule, ShaderModuleDescriptor, ShaderSource, ShaderStages, StoreOp,
    TextureFormat, TextureSampleType, TextureView, TextureViewDimension, VertexState,
};
use yoro::synthesis::LevelUniforms;
use yoro::synthesis::backend::WarpKind;

use crate::buffers::{Buffers, MAP};
use crate::shaders::{COMPOSE, SCREEN, Shaders};
use crate::uniforms::{self, UniformRing};
use crate::{Options, Source};

/// All passes.
pub(crate) struct Passes {
    tiles: Pass,
    spans: Pass,
    march: Pass,
    nearest: Sampler,
    linear: Sampler,
}

/// A pipeline, and the bindings that its shaders read.
pub(crate) struct Pass {
    pub(crate) label: &'static str,
    pub(crate) bindings: &'static [u32],
    pub(crate) layout: BindGroupLayout,
    pipeline: RenderPipeline,
}

/// The bindings; textures have the numbers of `TEXTURE` in the shaders.
const DEPTH: u32 = 0;
const COLOR: u32 = 1;
const TILE_MAP: u32 = 2;
const SPAN_MAP: u32 = 3;
const UNIFORMS: u32 = 4;
const NEAREST: u32 = 5;
const LINEAR: u32 = 6;

/// The bind groups of the passes for one source.
pub(crate) struct Groups {
    tiles: BindGroup,
    spans: BindGroup,
    march: BindGroup,
}

impl Passes {
    pub(crate) fn new<W: WarpKind>(device: &Device, options: &Options) -> Passes {
        let module = |label, text| module(device, label, text);
        let shaders = Shaders::of::<W>();
        let uniforms = uniforms::size::<W::Uniforms>();
        let screen = module("yoro screen", SCREEN);
        let march_vertex = module("yoro march", shaders.march_vertex);
        let map = |label, text, bindings| {
            let pass = PassMaker { device, uniforms, label, bindings, filtered: &[] };
            pass.make(&screen, &module(label, text), MAP, None)
        };
        let march_bindings: &[u32] = &[DEPTH, COLOR, TILE_MAP, SPAN_MAP, UNIFORMS, NEAREST, LINEAR];
        let (label, bindings) = ("yoro march", march_bindings);
        let march = PassMaker { device, uniforms, label, bindings, filtered: &[COLOR] };
        let text = shaders.march(options.depth_format.is_some());
        Passes {
            tiles: map("yoro tiles", shaders.tiles, &[DEPTH, UNIFORMS, NEAREST]),
            spans: map("yoro spans", shaders.spans, &[TILE_MAP, UNIFORMS]),
            march: march.make(
                &march_vertex,
                &module("yoro march", text),
                options.color_format,
                options.depth_format,
            ),
            nearest: sampler(device, "yoro nearest", FilterMode::Nearest),
            linear: sampler(device, "yoro linear", FilterMode::Linear),
        }
    }

    /// Creates the bind groups for a source and the buffers.
    pub(crate) fn groups(
        &self,
        device: &Device,
        source: &Source,
        buffers: &Buffers,
        uniforms: &UniformRing<impl NoUninit>,
    ) -> Groups {
        let group = |pass: &Pass| {
            let resource = |&binding: &u32| {
                let resource = match binding {
                    DEPTH => BindingResource::TextureView(source.depth),
                    COLOR => BindingResource::TextureView(source.color),
                    TILE_MAP => BindingResource::TextureView(&buffers.tiles),
                    SPAN_MAP => BindingResource::TextureView(&buffers.spans),
                    NEAREST => BindingResource::Sampler(&self.nearest),
                    LINEAR => BindingResource::Sampler(&self.linear),
                    _ => uniforms.binding(),
                };
                BindGroupEntry { binding, resource }
            };
            let entries: Vec<_> = pass.bindings.iter().map(resource).collect();
            let (label, layout) = (Some(pass.label), &pass.layout);
            device.create_bind_group(&BindGroupDescriptor { label, layout, entries: &entries })
        };
        Groups { tiles: group(&self.tiles), spans: group(&self.spans), march: group(&self.march) }
    }
}

fn module(device: &Device, label: &'static str, text: &'static str) -> ShaderModule {
    let source = ShaderSource::Wgsl(text.into());
    device.create_shader_module(ShaderModuleDescriptor { label: Some(label), source })
}

pub(crate) fn sampler(device: &Device, label: &'static str, filter: FilterMode) -> Sampler {
    device.create_sampler(&SamplerDescriptor {
        label: Some(label),
        mag_filter: filter,
        min_filter: filter,
        ..SamplerDescriptor::default()
    })
}

/// Creates the composer's pass. Its textures are the inset's depth, the wide level's colour and the inset's; its bindings
/// are in the order of the textures, uniforms, and the samplers that do not filter and that do.
pub(crate) fn compose(device: &Device, format: TextureFormat) -> Pass {
    let label = "yoro compose";
    let (uniforms, bindings) = (uniforms::size::<LevelUniforms>(), &[0, 1, 2, UNIFORMS, NEAREST, LINEAR]);
    let maker = PassMaker { device, uniforms, label, bindings, filtered: &[1, 2] };
    maker.make(&module(device, "yoro screen", SCREEN), &module(device, label, COMPOSE), format, None)
}

/// The place that the last pass draws to.
pub(crate) struct Drawn<'a> {
    pub(crate) color: &'a TextureView,
    pub(crate) depth: Option<&'a TextureView>,
    /// X and Y of the upper left corner, width and height, in pixels.
    pub(crate) area: [u32; 4],
    /// True if the area is the whole texture, so that nothing in it needs to be kept.
    pub(crate) whole: bool,
}

impl Passes {
    /// Records all passes. The sizes of the maps are in tiles. `uniforms` is the offset of the block in its buffer.
    pub(crate) fn record(
        &self,
        encoder: &mut CommandEncoder,
        groups: &Groups,
        buffers: &Buffers,
        [tile_size, span_size]: [[u32; 2]; 2],
        uniforms: u32,
        target: &Drawn,
    ) {
        let all = |[width, height]: [u32; 2]| [0, 0, width, height];
        let tiles = color(&buffers.tiles, true);
        self.tiles.record(encoder, &groups.tiles, uniforms, tiles, None, all(tile_size));
        let spans = color(&buffers.spans, true);
        self.spans.record(encoder, &groups.spans, uniforms, spans, None, all(span_size));
        let target_color = color(target.color, target.whole);
        let depth = target.depth.map(|view| depth(view, target.whole));
        self.march.record(encoder, &groups.march, uniforms, target_color, depth, target.area);
    }
}

/// Returns a colour attachment. Its contents are discarded if it is overwritten.
fn color(view: &TextureView, overwritten: bool) -> RenderPassColorAttachment<'_> {
    let load = if overwritten { LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { LoadOp::Load };
    let ops = Operations { load, store: StoreOp::Store };
    RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}

/// Returns a depth attachment. Its contents, except stencil, are discarded if it is overwritten.
fn depth(view: &TextureView, overwritten: bool) -> RenderPassDepthStencilAttachment<'_> {
    let load = if overwritten { LoadOp::Clear(0.0) } else { LoadOp::Load };
    let stencil = view.texture().format().has_stencil_aspect();
    RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(Operations { load, store: StoreOp::Store }),
        stencil_ops: stencil.then_some(Operations { load: LoadOp::Load, store: StoreOp::Store }),
    }
}

impl Pass {
    /// Records the pass into a target without depth.
    pub(crate) fn draw(
        &self,
        encoder: &mut CommandEncoder,
        group: &BindGroup,
        uniforms: u32,
        target: &Drawn,
    ) {
        self.record(encoder, group, uniforms, color(target.color, target.whole), None, target.area);
    }

    fn record(
        &self,
        encoder: &mut CommandEncoder,
        group: &BindGroup,
        uniforms: u32,
        color: RenderPassColorAttachment,
        depth: Option<RenderPassDepthStencilAttachment>,
        [x, y, width, height]: [u32; 4],
    ) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some(self.label),
            color_attachments: &[Some(color)],
            depth_stencil_attachment: depth,
            ..RenderPassDescriptor::default()
        });
        pass.set_viewport(x as f32, y as f32, width as f32, height as f32, 0.0, 1.0);
        pass.set_scissor_rect(x, y, width, height);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[uniforms]);
        pass.draw(0..3, 0..1);
    }
}

/// What all pipelines of a pass need besides their shaders and formats.
struct PassMaker<'a> {
    device: &'a Device,
    /// The size of the passes' uniform block in bytes.
    uniforms: BufferSize,
    label: &'static str,
    bindings: &'static [u32],
    /// The textures that are filtered.
    filtered: &'static [u32],
}

impl PassMaker<'_> {
    fn make(
        &self,
        vertex: &ShaderModule,
        fragment: &ShaderModule,
        format: TextureFormat,
        depth_format: Option<TextureFormat>,
    ) -> Pass {
        let PassMaker { device, label, bindings, .. } = *self;
        let entries: Vec<_> = bindings.iter().map(|&binding| self.layout_entry(binding)).collect();
        let layout = device
            .create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(label), entries: &entries });
        let pipeline_layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some(label),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some(label),
            layout: Some(&pipeline_layout),
            vertex: VertexState {
                module: vertex,
                entry_point: Some("main"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: depth_format.map(|format| DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(CompareFunction::Always),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(FragmentState {
                module: fragment,
                entry_point: Some("main"),
                compilation_options: Default::default(),
                targets: &[Some(ColorTargetState::from(format))],
            }),
            multiview_mask: None,
            cache: None,
        });
        Pass { label, bindings, layout, pipeline }
    }

    fn layout_entry(&self, binding: u32) -> BindGroupLayoutEntry {
        let texture = |sample_type| BindingType::Texture {
            sample_type,
            view_dimension: TextureViewDimension::D2,
            multisampled: false,
        };
        let ty = match binding {
            _ if self.filtered.contains(&binding) => texture(TextureSampleType::Float { filterable: true }),
            // The sample type that depth formats and float formats have in common.
            DEPTH => texture(TextureSampleType::Float { filterable: false }),
            TILE_MAP | SPAN_MAP => texture(TextureSampleType::Uint),
            NEAREST => BindingType::Sampler(SamplerBindingType::NonFiltering),
            LINEAR => BindingType::Sampler(SamplerBindingType::Filtering),
            _ => BindingType::Buffer {
                ty: BufferBindingType::Uniform,
                has_dynamic_offset: true,
                min_binding_size: Some(self.uniforms),
            },
        };
        let visibility =
            if binding == UNIFORMS { ShaderStages::VERTEX_FRAGMENT } else { ShaderStages::FRAGMENT };
        BindGroupLayoutEntry { binding, visibility, ty, count: None }
    }
}
