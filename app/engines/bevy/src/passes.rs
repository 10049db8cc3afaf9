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
use bevy::render::render_resource::{StoreOp, TextureFormat, TextureView};
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::sync_world::RenderEntity;
use bevy::render::texture::GpuImage;
use bevy::render::view::{ExtractedView, ViewDepthTexture, ViewTarget};
use bevy::render::{Extract, ExtractSchedule, GpuResourceAppExt, Render, RenderApp, RenderSystems};
use yoro_wgpu::yoro::eyes::{Composition, DepthConvention, Eye, Warp};
use yoro_wgpu::yoro::synthesis::{self, HoleMark};
use yoro_wgpu::{
    Composer, Gather, InsetImage, LevelImage, LevelImages, NearestDepth, Options, Source, Target, WgpuError,
    wgpu,
};

use crate::camera::Eyes;
use crate::holes::{HolePasses, MARKED_DEPTH, MarkedDepth, RendersHoles, prepare_holes, restore_depth};
use crate::levels::{LevelViews, Views};
use crate::plan::{Holes, Plan};
use crate::shared::{EyeCameras, Role};

pub(crate) fn build(app: &mut App) {
    let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
    render
        .init_resource::<Pipelines>()
        .init_gpu_resource::<HolePasses>()
        .add_systems(ExtractSchedule, extract)
        .add_systems(
            Render,
            (leave_out_opaque, prepare_holes)
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
        .add_systems(
            Core3d,
            restore_depth
                .after(main_opaque_pass_3d)
                .before(main_transmissive_pass_3d)
                .before(main_transparent_pass_3d)
                .in_set(Core3dSystems::MainPass),
        )
        .add_systems(Core2d, show_eyes.in_set(Core2dSystems::EarlyPostProcess));
}

/// What the passes need of a level, on the camera in the render world that renders its source.
#[derive(Component, Clone)]
pub(crate) struct Stereo {
    pub(crate) plan: Plan,
    pub(crate) views: LevelViews,
    source: AssetId<Image>,
    /// The other eye's image, if it has one of its own.
    other: Option<AssetId<Image>>,
    pub(crate) other_camera: Option<Entity>,
}

/// Marks the camera of a synthesized eye in the render world. Its opaque objects are not drawn.
#[derive(Component)]
struct Synthesized;

/// The eyes that are shown, on the camera in the render world after which they are: the screen's, or in a headset the last.
#[derive(Component)]
pub(crate) struct ShownEyes {
    dominant: Eye,
    /// Width and height of each eye's image.
    size: [u32; 2],
    /// The gaze, as [`Eyes`] keeps it.
    pub(crate) gaze: Option<Dir3>,
    /// The camera of the level that fills the eyes.
    pub(crate) wide: Entity,
    pub(crate) inset: Option<ShownInset>,
}

/// An inset that is shown.
pub(crate) struct ShownInset {
    /// The camera that renders its source.
    pub(crate) camera: Entity,
    /// How each eye is composed.
    pub(crate) compositions: [Composition; 2],
}

fn extract(
    mut commands: Commands,
    cameras: Extract<Query<(RenderEntity, &Camera, &Eyes, &EyeCameras)>>,
    entities: Extract<Query<RenderEntity>>,
    device: Res<RenderDevice>,
    old: Query<Entity, Or<(With<Stereo>, With<ShownEyes>, With<RendersHoles>, With<Synthesized>)>>,
) {
    for entity in &old {
        commands.entity(entity).remove::<(Stereo, ShownEyes, RendersHoles, Synthesized)>();
    }
    for (wide, camera, eyes, belonging) in &cameras {
        let (Some(arrangement), Some(views)) = (eyes.arrangement, eyes.views) else { continue };
        if !camera.is_active {
            continue;
        }
        let plan = arrangement.plan;
        let rendered = |entity| entities.get(entity).ok();
        let camera = |role| belonging.get(role).and_then(|camera| rendered(camera.entity));
        let others = [Role::Other, Role::OtherInset].map(camera);
        for (other, role) in others.into_iter().zip([Role::Other, Role::OtherInset]) {
            let Some(other) = other.filter(|_| plan == Plan::Opaque) else { continue };
            let opens = arrangement.holes == Holes::Rendered && role == views.detailed();
            if opens && HolePasses::are_supported(&device) {
                commands.entity(other).insert(RendersHoles);
            } else {
                commands.entity(other).insert(Synthesized);
            }
        }
        let stereo = |level: usize, views: LevelViews| Stereo {
            plan,
            views,
            source: eyes.images[level].source.id(),
            other: eyes.images[level].other.as_ref().map(Handle::id),
            other_camera: others[level],
        };
        commands.entity(wide).insert(stereo(0, views.wide));
        let inset = views.inset.zip(camera(Role::Inset)).map(|(inset, camera)| {
            commands.entity(camera).insert(stereo(1, inset.views));
            ShownInset { camera, compositions: inset.compositions }
        });
        let last = inset.as_ref().map_or(wide, |inset| others[1].unwrap_or(inset.camera));
        let screen = eyes.screen.map_or(Some(last), rendered);
        if let Some(screen) = screen {
            let Views { dominant, size, .. } = views;
            commands.entity(screen).insert(ShownEyes { dominant, size, gaze: eyes.gaze, wide, inset });
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
struct Pipelines {
    /// For each format of targets.
    gathers: Vec<(Options, Option<Gather>)>,
    /// For each format of targets, to compose them of two levels.
    composers: Vec<(TextureFormat, Option<Composer>)>,
    /// For cameras with MSAA, once there is one.
    nearest: Option<Option<NearestDepth>>,
}

/// The parameters of systems that synthesize in a camera's schedule.
#[derive(SystemParam)]
struct Synthesis<'w, 's> {
    pipelines: ResMut<'w, Pipelines>,
    device: Res<'w, RenderDevice>,
    queue: Res<'w, RenderQueue>,
    context: RenderContext<'w, 's>,
}

impl Synthesis<'_, '_> {
    /// Records the passes, or logs once why this fails.
    fn record(
        &mut self,
        options: &Options,
        color: &TextureView,
        depth: &ViewDepthTexture,
        warp: &Warp,
        target: &Target,
    ) {
        let device = self.device.wgpu_device();
        let Pipelines { gathers, nearest, .. } = &mut *self.pipelines;
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

    /// Records the pass that composes an eye, or logs once why this fails.
    fn compose(&mut self, images: &LevelImages, composition: &Composition, target: &Target) {
        let (device, format) = (self.device.wgpu_device(), target.color.texture().format());
        let composers = &mut self.pipelines.composers;
        let index = composers.iter().position(|(other, _)| *other == format).unwrap_or_else(|| {
            composers.push((format, Composer::new(device, format).inspect_err(log_once).ok()));
            composers.len() - 1
        });
        let Some(composer) = &mut composers[index].1 else { return };
        let encoder = self.context.command_encoder();
        let recorded = composer.record(device, &self.queue, encoder, images, composition, target);
        recorded.unwrap_or_else(|error| log_once(&error));
    }

    /// Copies a rectangle from one texture to another, clipped to both.
    fn copy(
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
    others: Query<(&ViewTarget, &ViewDepthTexture, Option<&MarkedDepth>)>,
    mut holes: ResMut<HolePasses>,
    mut synthesis: Synthesis,
) {
    let (stereo, source_color, source_depth) = view.into_inner();
    let (Plan::Opaque, Some(warp)) = (stereo.plan, &stereo.views.warp) else { return };
    let Some((color, depth, marked)) = stereo.other_camera.and_then(|camera| others.get(camera).ok()) else {
        return;
    };
    // Requesting the attachments for the first time clears them. This must happen here, so that later passes do not
    // clear them.
    let color_attachment = color.get_unsampled_color_attachment();
    drop(depth.get_attachment(StoreOp::Store));
    let holes_left =
        if marked.is_some() { synthesis::Holes::Open(HoleMark::Stencil) } else { synthesis::Holes::Filled };
    let options = Options {
        color_format: color.main_texture_format(),
        depth_format: Some(if marked.is_some() { MARKED_DEPTH } else { CORE_3D_DEPTH_FORMAT }),
        holes: holes_left,
    };
    let view = marked.map_or(&**depth.view(), |marked| &marked.view);
    let target = Target { color: color_attachment.view, depth: Some(view), origin: [0, 0] };
    synthesis.record(&options, source_color.main_texture_view(), source_depth, warp, &target);
    if let Some(marked) = marked {
        let background = match color_attachment.ops.load {
            wgpu::LoadOp::Clear(color) => color,
            _ => wgpu::Color::TRANSPARENT,
        };
        let (device, encoder) = (synthesis.device.wgpu_device(), synthesis.context.command_encoder());
        holes.open(device, encoder, marked, background, [color_attachment.view, depth.view()]);
    }
}

/// Shows both eyes side by side.
fn show_eyes(view: ViewQuery<(&ShownEyes, &ViewTarget)>, mut levels: Levels) {
    let (shown, target) = view.into_inner();
    let view = target.main_texture_view();
    levels.show(shown, |eye| Some(Place { view, layer: 0, x: eye.index() as u32 * shown.size[0] }));
}

/// The place for an eye: in one layer of a texture, from a column of it on.
pub(crate) struct Place<'a> {
    pub(crate) view: &'a TextureView,
    pub(crate) layer: u32,
    pub(crate) x: u32,
}

impl<'a> Place<'a> {
    fn target(&self) -> Target<'a> {
        Target { color: self.view, depth: None, origin: [self.x, 0] }
    }
}

/// The parameters of systems that show eyes.
#[derive(SystemParam)]
pub(crate) struct Levels<'w, 's> {
    cameras: Query<'w, 's, (&'static Stereo, &'static ViewDepthTexture)>,
    depths: Query<'w, 's, &'static ViewDepthTexture>,
    images: Res<'w, RenderAssets<GpuImage>>,
    synthesis: Synthesis<'w, 's>,
}

impl Levels<'_, '_> {
    /// Writes both eyes to their places. An eye without a place is left out.
    pub(crate) fn show<'a>(&mut self, shown: &ShownEyes, place: impl Fn(Eye) -> Option<Place<'a>>) {
        match &shown.inset {
            Some(inset) => self.compose(shown, inset, place),
            None => self.show_whole(shown, place),
        }
    }

    /// Shows the level that fills the eyes.
    fn show_whole<'a>(&mut self, shown: &ShownEyes, place: impl Fn(Eye) -> Option<Place<'a>>) {
        let Levels { cameras, images, synthesis, .. } = self;
        let Ok((level, depth)) = cameras.get(shown.wide) else { return };
        let Some(source) = images.get(level.source) else { return };
        for eye in Eye::BOTH {
            let Some(place) = place(eye) else { continue };
            let (to, at) = (place.view.texture(), [place.x, 0, place.layer]);
            if eye == shown.dominant {
                synthesis.copy(&source.texture, level.views.crop, to, at, shown.size);
            } else if let Some(image) = level.other.and_then(|other| images.get(other)) {
                synthesis.copy(&image.texture, [0, 0], to, at, shown.size);
            } else {
                level.synthesize_finished(synthesis, &source.texture_view, depth, &place.target());
            }
        }
    }

    /// Shows eyes that are composed of two levels.
    fn compose<'a>(
        &mut self,
        shown: &ShownEyes,
        inset: &ShownInset,
        place: impl Fn(Eye) -> Option<Place<'a>>,
    ) {
        let Levels { cameras, depths, images, synthesis } = self;
        let (Ok(wide), Ok(near)) = (cameras.get(shown.wide), cameras.get(inset.camera)) else { return };
        for (level, depth) in [wide, near] {
            let other = level.other.and_then(|other| images.get(other));
            if let (Some(source), Some(other)) = (images.get(level.source), other) {
                let target = Target::new(&other.texture_view);
                level.synthesize_finished(synthesis, &source.texture_view, depth, &target);
            }
        }
        let (wide, near) = (wide.0, near.0);
        for eye in Eye::BOTH {
            let own = eye == shown.dominant;
            let image = |level: &Stereo| {
                let image = if own { level.source } else { level.other? };
                let origin = if own { level.views.crop } else { [0, 0] };
                Some(LevelImage { color: &images.get(image)?.texture_view, origin })
            };
            let (Some(place), Some(wide), Some(image)) = (place(eye), image(wide), image(near)) else {
                continue;
            };
            // Of an inset that is synthesized after post-processing, no depth is written.
            let synthesized = near.other_camera.filter(|_| !own && near.plan == Plan::Opaque);
            let depth = synthesized.and_then(|camera| depths.get(camera).ok());
            let inset_image = InsetImage { image, depth: depth.map(|depth| &**depth.view()) };
            let images = LevelImages { wide, inset: Some(inset_image) };
            synthesis.compose(&images, &inset.compositions[eye.index()], &place.target());
        }
    }
}

impl Stereo {
    /// Draws the other eye from the finished image of this eye.
    fn synthesize_finished(
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
