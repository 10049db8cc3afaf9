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
use yoro::synthesis::{Edges, PassSet, Strips};

use crate::buffers::{Buffers, layer_formats, map_format};
use crate::shaders;
use crate::uniforms::{self, UniformRing};
use crate::{Options, Source};

/// All passes.
pub(crate) struct Passes {
    /// `None` for hard edges.
    split: Option<Pass>,
    /// For sources with multisampled colour.
    split_samples: Option<Pass>,
    tiles: Pass,
    spans: Pass,
    march: Pass,
    nearest: Sampler,
    linear: Sampler,
}

/// A pipeline, and the bindings that its shaders read.
struct Pass {
    label: &'static str,
    bindings: Vec<u32>,
    layout: BindGroupLayout,
    pipeline: RenderPipeline,
}

/// The bindings, with the numbers that `TEXTURE` has in the shaders.
const DEPTH: u32 = 0;
const COLOR: u32 = 1;
const TILE_MAP: u32 = 2;
const SPAN_MAP: u32 = 3;
const LAYERS: u32 = 4;
const BACKGROUND: u32 = 5;
const SAMPLE_COLOR: u32 = 6;
const UNIFORMS: u32 = 7;
const NEAREST: u32 = 8;
const LINEAR: u32 = 9;
const HISTORY_DEPTH: u32 = 10;
const HISTORY_COLOR: u32 = 11;
const STRIPS: u32 = 12;

/// The bind groups of the passes for one source.
pub(crate) struct Groups {
    split: Option<BindGroup>,
    tiles: BindGroup,
    spans: BindGroup,
    march: BindGroup,
    with_samples: bool,
}

impl Passes {
    /// `uniforms` is the size of the passes' uniform block.
    pub(crate) fn new(device: &Device, options: &Options, set: PassSet, uniforms: BufferSize) -> Passes {
        let Options { color_format, depth_format, edges, samples, history } = *options;
        let module = |label, text: &'static str| {
            let source = ShaderSource::Wgsl(text.into());
            device.create_shader_module(ShaderModuleDescriptor { label: Some(label), source })
        };
        let screen = module("yoro screen", shaders::SCREEN);
        let march_vertex = module("yoro march", shaders::march_vertex(set));
        let hard = edges == Edges::Hard;
        let make = |label, text, bindings: &[u32], formats: &[TextureFormat]| {
            let bindings = bindings.to_vec();
            let pass = PassMaker { device, options, uniforms, label, bindings };
            pass.make(&screen, &module(label, text), formats, None)
        };
        let map = [map_format(edges)];
        let layers = layer_formats(color_format);
        let tile_bindings: &[u32] = if hard { &[DEPTH, UNIFORMS, NEAREST] } else { &[LAYERS, UNIFORMS] };
        let march_bindings: &[u32] = match (hard, set) {
            (_, PassSet::AnyView) => &[DEPTH, COLOR, TILE_MAP, SPAN_MAP, UNIFORMS, LINEAR],
            (true, PassSet::GatherOnGpu) => &[DEPTH, COLOR, TILE_MAP, SPAN_MAP, UNIFORMS, NEAREST, LINEAR],
            (true, _) => &[DEPTH, COLOR, SPAN_MAP, UNIFORMS, LINEAR],
            (false, _) => &[COLOR, SPAN_MAP, LAYERS, BACKGROUND, UNIFORMS, LINEAR],
        };
        let recall: &[u32] = if history { &[HISTORY_DEPTH, HISTORY_COLOR, STRIPS] } else { &[] };
        let sampler = |label, filter| {
            device.create_sampler(&SamplerDescriptor {
                label: Some(label),
                mag_filter: filter,
                min_filter: filter,
                ..SamplerDescriptor::default()
            })
        };
        Passes {
            split: shaders::split(edges, samples)
                .map(|text| make("yoro split", text, &[DEPTH, COLOR, UNIFORMS], &layers)),
            split_samples: (edges == Edges::Multisample).then(|| {
                let bindings = [DEPTH, SAMPLE_COLOR, UNIFORMS];
                make("yoro split", shaders::split_samples(samples), &bindings, &layers)
            }),
            tiles: make("yoro tiles", shaders::tiles(edges, set), tile_bindings, &map),
            spans: make("yoro spans", shaders::spans(edges, set), &[TILE_MAP, UNIFORMS], &map),
            march: {
                let text = shaders::march(edges, set, depth_format.is_some(), history);
                let bindings = [march_bindings, recall].concat();
                let pass = PassMaker { device, options, uniforms, label: "yoro march", bindings };
                pass.make(&march_vertex, &module("yoro march", text), &[color_format], depth_format)
            },
            nearest: sampler("yoro nearest", FilterMode::Nearest),
            linear: sampler("yoro linear", FilterMode::Linear),
        }
    }

    /// Creates the bind groups for a source and the buffers.
    pub(crate) fn groups(
        &self,
        device: &Device,
        source: &Source,
        buffers: &Buffers,
        uniforms: &UniformRing<impl NoUninit>,
        strips: Option<&UniformRing<Strips>>,
    ) -> Groups {
        let group = |pass: &Pass| {
            let resource = |&binding: &u32| {
                let layer = |i: usize| buffers.layers.as_ref().map(|layers| &layers[i]);
                let texture = match binding {
                    DEPTH => Some(source.depth),
                    COLOR => Some(source.color),
                    TILE_MAP => Some(&buffers.tiles),
                    SPAN_MAP => Some(&buffers.spans),
                    LAYERS => layer(0),
                    BACKGROUND => layer(1),
                    SAMPLE_COLOR => source.sample_color,
                    // Without a history these bindings are not read.
                    HISTORY_DEPTH => source.history.map_or(Some(source.color), |history| Some(history.depth)),
                    HISTORY_COLOR => source.history.map_or(Some(source.color), |history| Some(history.color)),
                    _ => None,
                };
                let resource = match (binding, texture) {
                    (_, Some(view)) => BindingResource::TextureView(view),
                    (NEAREST, _) => BindingResource::Sampler(&self.nearest),
                    (LINEAR, _) => BindingResource::Sampler(&self.linear),
                    (STRIPS, _) => strips.map_or(uniforms.binding(), UniformRing::binding),
                    _ => uniforms.binding(),
                };
                BindGroupEntry { binding, resource }
            };
            let entries: Vec<_> = pass.bindings.iter().map(resource).collect();
            let (label, layout) = (Some(pass.label), &pass.layout);
            device.create_bind_group(&BindGroupDescriptor { label, layout, entries: &entries })
        };
        let with_samples = source.sample_color.is_some();
        Groups {
            split: self.split(with_samples).map(group),
            tiles: group(&self.tiles),
            spans: group(&self.spans),
            march: group(&self.march),
            with_samples,
        }
    }

    /// Returns the first pass for a source with or without multisampled colour.
    fn split(&self, with_samples: bool) -> Option<&Pass> {
        self.split_samples.as_ref().filter(|_| with_samples).or(self.split.as_ref())
    }
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
    /// Records all passes for a source of this size in pixels. The sizes of the maps are in tiles. `uniforms` and
    /// `strips` are offsets in their buffers.
    pub(crate) fn record(
        &self,
        encoder: &mut CommandEncoder,
        groups: &Groups,
        buffers: &Buffers,
        [source_size, tile_size, span_size]: [[u32; 2]; 3],
        (uniforms, strips): (u32, Option<u32>),
        target: &Drawn,
    ) {
        let all = |[width, height]: [u32; 2]| [0, 0, width, height];
        let split = self.split(groups.with_samples).zip(groups.split.as_ref());
        if let (Some((pass, group)), Some(layers)) = (split, &buffers.layers) {
            let colors = layers.each_ref().map(|view| Some(color(view, true)));
            pass.record(encoder, group, &[uniforms], &colors, None, all(source_size));
        }
        let tiles = [Some(color(&buffers.tiles, true))];
        self.tiles.record(encoder, &groups.tiles, &[uniforms], &tiles, None, all(tile_size));
        let spans = [Some(color(&buffers.spans, true))];
        self.spans.record(encoder, &groups.spans, &[uniforms], &spans, None, all(span_size));
        let colors = [Some(color(target.color, target.whole))];
        let depth = target.depth.map(|view| depth(view, target.whole));
        let places = [uniforms, strips.unwrap_or(0)];
        let places = &places[..1 + usize::from(strips.is_some())];
        self.march.record(encoder, &groups.march, places, &colors, depth, target.area);
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
    fn record(
        &self,
        encoder: &mut CommandEncoder,
        group: &BindGroup,
        // Offsets of the uniform blocks in their buffers.
        places: &[u32],
        colors: &[Option<RenderPassColorAttachment>],
        depth: Option<RenderPassDepthStencilAttachment>,
        [x, y, width, height]: [u32; 4],
    ) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some(self.label),
            color_attachments: colors,
            depth_stencil_attachment: depth,
            ..RenderPassDescriptor::default()
        });
        pass.set_viewport(x as f32, y as f32, width as f32, height as f32, 0.0, 1.0);
        pass.set_scissor_rect(x, y, width, height);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, places);
        pass.draw(0..3, 0..1);
    }
}

/// What all pipelines of a pass need besides their shaders and formats.
struct PassMaker<'a> {
    device: &'a Device,
    options: &'a Options,
    /// The size of the passes' uniform block in bytes.
    uniforms: BufferSize,
    label: &'static str,
    bindings: Vec<u32>,
}

impl PassMaker<'_> {
    fn make(
        &self,
        vertex: &ShaderModule,
        fragment: &ShaderModule,
        formats: &[TextureFormat],
        depth_format: Option<TextureFormat>,
    ) -> Pass {
        let PassMaker { device, label, ref bindings, .. } = *self;
        let entries: Vec<_> = bindings.iter().map(|&binding| self.layout_entry(binding)).collect();
        let layout = device
            .create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(label), entries: &entries });
        let pipeline_layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some(label),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let targets: Vec<_> = formats.iter().map(|&format| Some(ColorTargetState::from(format))).collect();
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
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        });
        Pass { label, bindings: bindings.clone(), layout, pipeline }
    }

    fn layout_entry(&self, binding: u32) -> BindGroupLayoutEntry {
        let multisampled =
            self.options.edges == Edges::Multisample && matches!(binding, DEPTH | SAMPLE_COLOR);
        let texture = |sample_type| BindingType::Texture {
            sample_type,
            view_dimension: TextureViewDimension::D2,
            multisampled,
        };
        let ty = match binding {
            // The sample type that depth formats and float formats have in common.
            DEPTH | SAMPLE_COLOR | BACKGROUND | HISTORY_DEPTH => {
                texture(TextureSampleType::Float { filterable: false })
            }
            COLOR | HISTORY_COLOR => texture(TextureSampleType::Float { filterable: true }),
            TILE_MAP | SPAN_MAP | LAYERS => texture(TextureSampleType::Uint),
            NEAREST => BindingType::Sampler(SamplerBindingType::NonFiltering),
            LINEAR => BindingType::Sampler(SamplerBindingType::Filtering),
            _ => BindingType::Buffer {
                ty: BufferBindingType::Uniform,
                has_dynamic_offset: true,
                min_binding_size: Some(match binding {
                    STRIPS => uniforms::size::<Strips>(),
                    _ => self.uniforms,
                }),
            },
        };
        let visibility =
            if binding == UNIFORMS { ShaderStages::VERTEX_FRAGMENT } else { ShaderStages::FRAGMENT };
        BindGroupLayoutEntry { binding, visibility, ty, count: None }
    }
}
