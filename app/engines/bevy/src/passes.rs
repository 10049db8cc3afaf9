//! Synthesis in the render world.

use bevy::camera::Camera;
use bevy::core_pipeline::core_3d::{
    AlphaMask3d, CORE_3D_DEPTH_FORMAT, Opaque3d, main_opaque_pass_3d, main_transparent_pass_3d,
};
use bevy::core_pipeline::{Core2d, Core2dSystems, Core3d, Core3dSystems};
use bevy::ecs::system::SystemParam;
use bevy::pbr::main_transmissive_pass_3d;
use bevy::prelude::*;
use bevy::render::render_asset::RenderAssets;
use bevy::render::render_phase::ViewBinnedRenderPhases;
use bevy::render::render_resource::{StoreOp, TextureView};
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::sync_world::RenderEntity;
use bevy::render::texture::GpuImage;
use bevy::render::view::{ExtractedView, ViewDepthTexture, ViewTarget};
use bevy::render::{Extract, ExtractSchedule, Render, RenderApp, RenderSystems};
use yoro_wgpu::yoro::eyes::{DepthConvention, Eye, Warp};
use yoro_wgpu::{Gather, NearestDepth, Options, Source, Target, WgpuError, wgpu};

use crate::camera::{Eyes, Screen, Views};
use crate::plan::Plan;
use crate::shared::OtherCamera;

pub(crate) fn build(app: &mut App) {
    let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
    render
        .init_resource::<Pipelines>()
        .add_systems(ExtractSchedule, extract)
        .add_systems(
            Render,
            leave_out_opaque
                .in_set(RenderSystems::Prepare)
                // Bevy creates the texture for transmission only for views that have all phases.
                .after(RenderSystems::PrepareResources)
                .before(RenderSystems::PrepareResourcesBatchPhases),
        )
        .add_systems(
            Core3d,
            synthesize_opaque
                .after(main_opaque_pass_3d)
                .before(main_transmissive_pass_3d)
                .before(main_transparent_pass_3d)
                .in_set(Core3dSystems::MainPass),
        )
        .add_systems(Core2d, show_eyes.in_set(Core2dSystems::EarlyPostProcess));
}

/// What the passes need of a camera's [`Eyes`] in a frame, on a stereo camera in the render world.
#[derive(Component, Clone)]
pub(crate) struct Stereo {
    pub(crate) plan: Plan,
    pub(crate) views: Views,
    pub(crate) source: AssetId<Image>,
    other: AssetId<Image>,
    other_camera: Option<Entity>,
}

/// Marks the camera of a synthesized eye in the render world. Its opaque objects are not drawn.
#[derive(Component)]
struct Synthesized;

/// The stereo camera whose eyes are shown, on the camera in the render world that shows them.
#[derive(Component)]
struct ShownEyes(Entity);

fn extract(
    mut commands: Commands,
    cameras: Extract<Query<(RenderEntity, &Camera, &Eyes, Option<&OtherCamera>)>>,
    screens: Extract<Query<(RenderEntity, &Screen)>>,
    entities: Extract<Query<RenderEntity>>,
    old: Query<Entity, With<Stereo>>,
) {
    for entity in &old {
        commands.entity(entity).remove::<Stereo>();
    }
    for (entity, camera, eyes, other) in &cameras {
        let (Some(arrangement), Some(views)) = (eyes.arrangement, eyes.views) else { continue };
        if !camera.is_active {
            continue;
        }
        let other_camera = other.and_then(|other| entities.get(other.entity).ok());
        if let (Some(other), Plan::Opaque) = (other_camera, arrangement.plan) {
            commands.entity(other).insert(Synthesized);
        }
        commands.entity(entity).insert(Stereo {
            plan: arrangement.plan,
            views,
            source: eyes.source.id(),
            other: eyes.other.id(),
            other_camera,
        });
    }
    for (entity, screen) in &screens {
        if let Ok(camera) = entities.get(screen.0) {
            commands.entity(entity).insert(ShownEyes(camera));
        }
    }
}

fn leave_out_opaque(
    views: Query<&ExtractedView, With<Synthesized>>,
    mut opaque: ResMut<ViewBinnedRenderPhases<Opaque3d>>,
    mut masked: ResMut<ViewBinnedRenderPhases<AlphaMask3d>>,
) {
    for view in &views {
        opaque.remove(&view.retained_view_entity);
        masked.remove(&view.retained_view_entity);
    }
}

/// The passes of synthesis; `None` where the device refuses them.
#[derive(Resource, Default)]
pub(crate) struct Pipelines {
    /// For each format of targets.
    gathers: Vec<(Options, Option<Gather>)>,
    /// For cameras with MSAA, once there is one.
    nearest: Option<Option<NearestDepth>>,
}

/// The parameters of systems that synthesize in a camera's schedule.
#[derive(SystemParam)]
pub(crate) struct Synthesis<'w, 's> {
    pipelines: ResMut<'w, Pipelines>,
    device: Res<'w, RenderDevice>,
    queue: Res<'w, RenderQueue>,
    pub(crate) context: RenderContext<'w, 's>,
}

impl Synthesis<'_, '_> {
    /// Records the passes, or logs once why this fails.
    pub(crate) fn record(
        &mut self,
        options: &Options,
        color: &TextureView,
        depth: &ViewDepthTexture,
        warp: &Warp,
        target: &Target,
    ) {
        let device = self.device.wgpu_device();
        let Pipelines { gathers, nearest } = &mut *self.pipelines;
        let known = gathers.iter().position(|(other, _)| other == options);
        let index = known.unwrap_or_else(|| {
            let gather = Gather::new(device, options).inspect_err(log_once).ok();
            gathers.push((*options, gather));
            gathers.len() - 1
        });
        let Some(gather) = &mut gathers[index].1 else { return };
        let encoder = self.context.command_encoder();
        let mut depth: &wgpu::TextureView = depth.view();
        if depth.texture().sample_count() > 1 {
            let make = || NearestDepth::new(device, DepthConvention::Reversed).inspect_err(log_once).ok();
            let Some(nearest) = nearest.get_or_insert_with(make) else { return };
            depth = nearest.record(device, encoder, depth);
        }
        let source = Source::new(color, depth);
        let recorded = gather.record(device, &self.queue, encoder, &source, warp, target);
        recorded.unwrap_or_else(|error| log_once(&error));
    }

    /// Copies a rectangle from one texture to another, clipped to both.
    pub(crate) fn copy(
        &mut self,
        from: &wgpu::Texture,
        [x, y]: [u32; 2],
        to: &wgpu::Texture,
        at: [u32; 3],
        size: [u32; 2],
    ) {
        if from.format().remove_srgb_suffix() != to.format().remove_srgb_suffix() {
            error_once!("an eye of {:?} cannot be copied into {:?}", from.format(), to.format());
            return;
        }
        let width = size[0].min(from.width().saturating_sub(x)).min(to.width().saturating_sub(at[0]));
        let height = size[1].min(from.height().saturating_sub(y)).min(to.height().saturating_sub(at[1]));
        let place = |texture, [x, y, z]: [u32; 3]| wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: 0,
            origin: wgpu::Origin3d { x, y, z },
            aspect: wgpu::TextureAspect::All,
        };
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let encoder = self.context.command_encoder();
        encoder.copy_texture_to_texture(place(from, [x, y, 0]), place(to, at), size);
    }
}

fn log_once(error: &WgpuError) {
    error_once!("the other eye cannot be synthesized: {error}");
}

/// Draws the opaque surfaces of the other eye, which its own camera leaves out.
fn synthesize_opaque(
    view: ViewQuery<(&Stereo, &ViewTarget, &ViewDepthTexture)>,
    others: Query<(&ViewTarget, &ViewDepthTexture)>,
    mut synthesis: Synthesis,
) {
    let (stereo, source_color, source_depth) = view.into_inner();
    let (Plan::Opaque, Some(warp)) = (stereo.plan, &stereo.views.warp) else { return };
    let Some((color, depth)) = stereo.other_camera.and_then(|camera| others.get(camera).ok()) else {
        return;
    };
    // Requesting the attachments for the first time clears them. This must happen here, so that later passes do not
    // clear them.
    let color_attachment = color.get_unsampled_color_attachment();
    drop(depth.get_attachment(StoreOp::Store));
    let options = Options {
        color_format: color.main_texture_format(),
        depth_format: Some(CORE_3D_DEPTH_FORMAT),
        ..Options::default()
    };
    let target = Target { color: color_attachment.view, depth: Some(depth.view()), origin: [0, 0] };
    synthesis.record(&options, source_color.main_texture_view(), source_depth, warp, &target);
}

/// Shows both eyes side by side.
fn show_eyes(
    view: ViewQuery<(&ShownEyes, &ViewTarget)>,
    cameras: Query<(&Stereo, &ViewDepthTexture)>,
    images: Res<RenderAssets<GpuImage>>,
    mut synthesis: Synthesis,
) {
    let (shown, target) = view.into_inner();
    let Ok((stereo, depth)) = cameras.get(shown.0) else { return };
    let Some(source) = images.get(stereo.source) else { return };
    let Views { target: other, crop, dominant, .. } = stereo.views;
    let place = |eye: Eye| [eye.index() as u32 * other.size[0], 0];
    let [x, y] = place(dominant);
    synthesis.copy(&source.texture, crop, target.main_texture(), [x, y, 0], other.size);
    let [x, y] = place(dominant.other());
    if stereo.plan == Plan::Finished {
        let target = Target { color: target.main_texture_view(), depth: None, origin: [x, y] };
        stereo.synthesize_finished(&mut synthesis, &source.texture_view, depth, &target);
    } else if let Some(image) = images.get(stereo.other) {
        synthesis.copy(&image.texture, [0, 0], target.main_texture(), [x, y, 0], other.size);
    }
}

impl Stereo {
    /// Draws the other eye from the finished image of this eye.
    pub(crate) fn synthesize_finished(
        &self,
        synthesis: &mut Synthesis,
        color: &TextureView,
        depth: &ViewDepthTexture,
        target: &Target,
    ) {
        let (Plan::Finished, Some(warp)) = (self.plan, &self.views.warp) else { return };
        let options = Options { color_format: target.color.texture().format(), ..Options::default() };
        synthesis.record(&options, color, depth, warp, target);
    }
}
