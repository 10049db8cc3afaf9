//! Rendered holes: what the rendered eye does not show stays open, and the other eye's camera draws its opaque objects there.
//!
//! Materials are as they are: written pixels have the nearest depth while opaque objects are drawn, and get their own
//! depth afterwards, for transparent objects.

use bevy::core_pipeline::core_3d::CORE_3D_DEPTH_FORMAT;
use bevy::prelude::*;
use bevy::render::camera::ExtractedCamera;
use bevy::render::renderer::{RenderContext, RenderDevice, ViewQuery};
use bevy::render::view::ViewDepthTexture;
use yoro_wgpu::wgpu;

/// The format of the depth that is synthesized, with the marks of written pixels.
pub(crate) const MARKED_DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32FloatStencil8;

/// Marks the camera of a synthesized eye in the render world that draws opaque objects where the eye is open.
#[derive(Component)]
pub(crate) struct RendersHoles;

/// The depth and the marks of such an eye.
#[derive(Component)]
pub(crate) struct MarkedDepth {
    size: UVec2,
    pub(crate) view: wgpu::TextureView,
    group: wgpu::BindGroup,
}

/// The passes around the second draw.
#[derive(Resource)]
pub(crate) struct HolePasses {
    layout: wgpu::BindGroupLayout,
    module: wgpu::ShaderModule,
    restore: wgpu::RenderPipeline,
    /// For each format of targets.
    open: Vec<(wgpu::TextureFormat, wgpu::RenderPipeline)>,
}

/// Makes the depth of eyes that are new or have another size.
pub(crate) fn prepare_holes(
    mut commands: Commands,
    device: Res<RenderDevice>,
    passes: Res<HolePasses>,
    cameras: Query<(Entity, &ExtractedCamera, Option<&MarkedDepth>), With<RendersHoles>>,
) {
    for (entity, camera, old) in &cameras {
        let Some(size) = camera.physical_target_size else { continue };
        if old.is_none_or(|old| old.size != size) {
            commands.entity(entity).insert(passes.marked_depth(device.wgpu_device(), size));
        }
    }
}

/// Gives written pixels their depth, once opaque objects are drawn.
pub(crate) fn restore_depth(
    view: ViewQuery<(&MarkedDepth, &ViewDepthTexture), With<RendersHoles>>,
    passes: Res<HolePasses>,
    mut context: RenderContext,
) {
    let (marked, depth) = view.into_inner();
    draw(context.command_encoder(), &passes.restore, marked, None, (depth.view(), wgpu::LoadOp::Load));
}

impl FromWorld for HolePasses {
    fn from_world(world: &mut World) -> HolePasses {
        let device = world.resource::<RenderDevice>().wgpu_device();
        let module = device.create_shader_module(wgpu::include_wgsl!("holes.wgsl"));
        let entry = |binding, sample_type| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type,
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("yoro holes"),
            entries: &[
                entry(0, wgpu::TextureSampleType::Float { filterable: false }),
                entry(1, wgpu::TextureSampleType::Uint),
            ],
        });
        let restore = pipeline(device, &layout, &module, "restore", &[]);
        HolePasses { layout, module, restore, open: Vec::new() }
    }
}

impl HolePasses {
    /// True if the device has the format of marked depth.
    pub(crate) fn are_supported(device: &RenderDevice) -> bool {
        let supported = device.features().contains(wgpu::Features::DEPTH32FLOAT_STENCIL8);
        if !supported {
            warn_once!("holes are filled: the device has no {MARKED_DEPTH:?}");
        }
        supported
    }

    fn marked_depth(&self, device: &wgpu::Device, size: UVec2) -> MarkedDepth {
        let label = Some("yoro holes");
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label,
            size: wgpu::Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: MARKED_DEPTH,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let aspect = |aspect| texture.create_view(&wgpu::TextureViewDescriptor { aspect, ..default() });
        let [depth, marks] = [wgpu::TextureAspect::DepthOnly, wgpu::TextureAspect::StencilOnly].map(aspect);
        let entry = |binding, view| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::TextureView(view),
        };
        let entries = [entry(0, &depth), entry(1, &marks)];
        let descriptor = wgpu::BindGroupDescriptor { label, layout: &self.layout, entries: &entries };
        let group = device.create_bind_group(&descriptor);
        MarkedDepth { size, view: aspect(wgpu::TextureAspect::All), group }
    }

    /// Opens the pixels that have no mark, and closes all others to opaque objects.
    pub(crate) fn open(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        marked: &MarkedDepth,
        background: wgpu::Color,
        [color, depth]: [&wgpu::TextureView; 2],
    ) {
        let format = color.texture().format();
        let known = self.open.iter().position(|(other, _)| *other == format);
        let index = known.unwrap_or_else(|| {
            let constant = wgpu::BlendComponent {
                src_factor: wgpu::BlendFactor::Constant,
                dst_factor: wgpu::BlendFactor::Zero,
                operation: wgpu::BlendOperation::Add,
            };
            let blend = Some(wgpu::BlendState { color: constant, alpha: constant });
            let target = wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL };
            let made = pipeline(device, &self.layout, &self.module, "open", &[Some(target)]);
            self.open.push((format, made));
            self.open.len() - 1
        });
        let nearest = (depth, wgpu::LoadOp::Clear(1.0));
        draw(encoder, &self.open[index].1, marked, Some((color, background)), nearest);
    }
}

fn pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    module: &wgpu::ShaderModule,
    fragment: &str,
    targets: &[Option<wgpu::ColorTargetState>],
) -> wgpu::RenderPipeline {
    let label = Some("yoro holes");
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label,
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    let compilation_options = wgpu::PipelineCompilationOptions::default();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("screen"),
            compilation_options: compilation_options.clone(),
            buffers: &[],
        },
        primitive: default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: CORE_3D_DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: default(),
            bias: default(),
        }),
        multisample: default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options,
            targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn draw(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::RenderPipeline,
    marked: &MarkedDepth,
    color: Option<(&wgpu::TextureView, wgpu::Color)>,
    (depth, load): (&wgpu::TextureView, wgpu::LoadOp<f32>),
) {
    let attachment = color.map(|(view, _)| {
        let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
        Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
    });
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("yoro holes"),
        color_attachments: attachment.as_slice(),
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &marked.group, &[]);
    pass.set_blend_constant(color.map_or(wgpu::Color::TRANSPARENT, |(_, background)| background));
    pass.draw(0..3, 0..1);
}
