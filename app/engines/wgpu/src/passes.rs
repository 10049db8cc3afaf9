//! The fragment passes of the pipeline, in the order in which they are recorded.

use bytemuck::NoUninit;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, BufferBindingType, BufferSize, ColorTargetState,
    CommandEncoder, CompareFunction, DepthStencilState, Device, FilterMode, FragmentState, LoadOp,
    Operations, PipelineLayoutDescriptor, RenderPassColorAttachment, RenderPassDepthStencilAttachment,
    RenderPassDescriptor, RenderPipeline, RenderPipelineDescriptor, Sampler, SamplerBindingType,
    SamplerDescriptor, ShaderModule, ShaderModuleDescriptor, ShaderSource, ShaderStages, StencilFaceState,
    StencilOperation, StencilState, StoreOp, TextureFormat, TextureSampleType, TextureView,
    TextureViewDimension, VertexState,
};
use yoro::synthesis::backend::{HoleMarks, WHOLE_DEPTH, WarpKind};
use yoro::synthesis::{HoleMark, Holes, LevelUniforms};

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
    /// Creates the passes, of which the last one runs the shader `march`.
    pub(crate) fn new<W: WarpKind>(device: &Device, options: &Options, march: &'static str) -> Passes {
        let module = |label, text| module(device, label, text);
        let shaders = Shaders::of::<W>();
        let uniforms = uniforms::size::<W::Uniforms>();
        let screen = module("yoro screen", SCREEN);
        let march_vertex = module("yoro march", shaders.march_vertex);
        let map = |label, text, bindings| {
            let pass = PassMaker { device, uniforms, label, bindings, filtered: &[] };
            pass.make(&screen, &module(label, text), MAP, None, StencilState::default())
        };
        let march_bindings: &[u32] = &[DEPTH, COLOR, TILE_MAP, SPAN_MAP, UNIFORMS, NEAREST, LINEAR];
        let (label, bindings) = ("yoro march", march_bindings);
        let maker = PassMaker { device, uniforms, label, bindings, filtered: &[COLOR] };
        Passes {
            tiles: map("yoro tiles", shaders.tiles, &[DEPTH, UNIFORMS, NEAREST]),
            spans: map("yoro spans", shaders.spans, &[TILE_MAP, UNIFORMS]),
            march: maker.make(
                &march_vertex,
                &module("yoro march", march),
                options.color_format,
                options.depth_format,
                stencil_state(options),
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
    let screen = module(device, "yoro screen", SCREEN);
    maker.make(&screen, &module(device, label, COMPOSE), format, None, StencilState::default())
}

/// The place that the last pass draws to.
pub(crate) struct Drawn<'a> {
    pub(crate) color: &'a TextureView,
    pub(crate) depth: Option<&'a TextureView>,
    /// X and Y of the upper left corner, width and height, in pixels.
    pub(crate) area: [u32; 4],
    /// True if the area is the whole texture, so that nothing in it needs to be kept.
    pub(crate) whole: bool,
    /// How written pixels are marked, if holes are left open.
    pub(crate) marks: Option<HoleMarks>,
}

/// Returns the stencil state that writes the reference in each pixel, if stencil marks what is written.
fn stencil_state(options: &Options) -> StencilState {
    if options.holes != Holes::Open(HoleMark::Stencil) {
        return StencilState::default();
    }
    let compare = CompareFunction::Always;
    let face = StencilFaceState { compare, pass_op: StencilOperation::Replace, ..StencilFaceState::IGNORE };
    StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0xff }
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
        self.tiles.record(encoder, &groups.tiles, uniforms, tiles, None, (all(tile_size), WHOLE_DEPTH));
        let spans = color(&buffers.spans, true);
        self.spans.record(encoder, &groups.spans, uniforms, spans, None, (all(span_size), WHOLE_DEPTH));
        let target_color = color(target.color, target.whole);
        let depth = target.depth.map(|view| depth(view, target.whole, target.marks));
        let area = (target.area, target.marks.map_or(WHOLE_DEPTH, HoleMarks::depths));
        self.march.record(encoder, &groups.march, uniforms, target_color, depth, area);
    }
}

/// Returns a colour attachment. Its contents are discarded if it is overwritten.
fn color(view: &TextureView, overwritten: bool) -> RenderPassColorAttachment<'_> {
    let load = if overwritten { LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { LoadOp::Load };
    let ops = Operations { load, store: StoreOp::Store };
    RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}

/// Returns a depth attachment. Its contents, except stencil, are discarded if it is overwritten; stencil is cleared
/// if it is a mark.
fn depth(
    view: &TextureView,
    overwritten: bool,
    marks: Option<HoleMarks>,
) -> RenderPassDepthStencilAttachment<'_> {
    let farthest = marks.map_or(0.0, |marks| marks.planes[1]);
    let load = if overwritten { LoadOp::Clear(farthest) } else { LoadOp::Load };
    let stencil = view.texture().format().has_stencil_aspect();
    let is_mark = marks.is_some_and(|marks| marks.mark == HoleMark::Stencil);
    let load_stencil = if is_mark { LoadOp::Clear(0) } else { LoadOp::Load };
    RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(Operations { load, store: StoreOp::Store }),
        stencil_ops: stencil.then_some(Operations { load: load_stencil, store: StoreOp::Store }),
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
        let color = color(target.color, target.whole);
        self.record(encoder, group, uniforms, color, None, (target.area, WHOLE_DEPTH));
    }

    fn record(
        &self,
        encoder: &mut CommandEncoder,
        group: &BindGroup,
        uniforms: u32,
        color: RenderPassColorAttachment,
        depth: Option<RenderPassDepthStencilAttachment>,
        ([x, y, width, height], [near, far]): ([u32; 4], [f32; 2]),
    ) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some(self.label),
            color_attachments: &[Some(color)],
            depth_stencil_attachment: depth,
            ..RenderPassDescriptor::default()
        });
        pass.set_viewport(x as f32, y as f32, width as f32, height as f32, near, far);
        // The mark, where stencil marks what is written.
        pass.set_stencil_reference(1);
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
        stencil: StencilState,
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
                stencil,
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
