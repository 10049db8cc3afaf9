//! Stereo in a headset, using bevy_mod_openxr: one camera is rendered, and fills both layers of the projection.
//!
//! Let [`XrStereoCamera`] replace bevy_mod_openxr's cameras:
//!
//! ```no_run
//! use bevy::prelude::*;
//! use bevy_mod_openxr::{add_xr_plugins, render::OxrRenderPlugin};
//! use bevy_yoro::{YoroPlugin, openxr::XrStereoCamera};
//!
//! fn main() {
//!     let xr = OxrRenderPlugin { spawn_cameras: false, ..default() };
//!     App::new()
//!         .add_plugins((add_xr_plugins(DefaultPlugins).set(xr), YoroPlugin))
//!         .add_systems(Startup, |mut commands: Commands| {
//!             commands.spawn(XrStereoCamera::default());
//!         })
//!         .run();
//! }
//! ```

use bevy::camera::{CameraUpdateSystems, ManualTextureViewHandle, RenderTarget};
use bevy::core_pipeline::{Core3d, Core3dSystems, upscaling::upscaling};
use bevy::prelude::*;
use bevy::render::extract_component::{ExtractComponent, ExtractComponentPlugin};
use bevy::render::render_asset::RenderAssets;
use bevy::render::renderer::ViewQuery;
use bevy::render::texture::{GpuImage, ManualTextureViews};
use bevy::render::view::{ExtractedView, ViewDepthTexture};
use bevy::render::{Render, RenderApp};
use bevy_mod_openxr::helper_traits::ToTransform;
use bevy_mod_openxr::init::should_run_frame_loop;
use bevy_mod_openxr::render::{XR_TEXTURE_INDEX, update_views, update_views_render_world};
use bevy_mod_openxr::resources::{OxrCurrentSessionConfig, OxrFrameState, OxrViews};
use bevy_mod_xr::camera::{XrCamera, XrProjection};
use bevy_mod_xr::session::{XrPreDestroySession, XrRenderSystems, XrRootTransform, XrTracker};
use yoro_wgpu::Target;
use yoro_wgpu::yoro::eyes::{self, EyePair, Frustum, Pose};
use yoro_wgpu::yoro::glam;

use crate::camera::{Eyes, EyesRequest, StereoCameraParts, Views, bevy_transform, guard_band, reversed};
use crate::passes::{Stereo, Synthesis};
use crate::projection::clip_from_view;
use crate::shared::{OtherCamera, ShareSystems};
use crate::{Eye, StereoMode};

/// Renders stereo in the headset from this `Camera3d`. The runtime's views determine the eyes' poses and frusta. The
/// plugin controls the camera's transform, projection and render target. The camera renders while a session does.
/// Despawn the entity to end this: without this component the camera is inactive.
#[derive(Component, Clone, Debug, PartialEq, Reflect, ExtractComponent)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Camera3d, Camera { is_active: false, ..default() }, Eyes, XrTracker)]
pub struct XrStereoCamera {
    /// How the other eye is produced.
    pub mode: StereoMode,
    /// The eye that is rendered.
    pub dominant: Eye,
    /// Distance of the near plane in metres, more than 0.
    pub near: f32,
    /// Distance in metres beyond which objects are culled.
    pub far: f32,
    /// Distance in metres of the nearest object that is not cut off at the other eye's outer border. Infinity for no
    /// guard band.
    pub guard_distance: f32,
}

impl Default for XrStereoCamera {
    /// Synthesizes opaque surfaces, renders the right eye, and uses planes at 0.1 m and 1000 m and a guard band for
    /// objects at 1 m or farther.
    fn default() -> XrStereoCamera {
        XrStereoCamera {
            mode: StereoMode::default(),
            dominant: Eye::default(),
            near: 0.1,
            far: 1000.0,
            guard_distance: 1.0,
        }
    }
}

impl XrStereoCamera {
    /// Returns the eyes in the space of the tracking root, or `None` while the runtime has none.
    fn pair(&self, views: &OxrViews, config: &OxrCurrentSessionConfig) -> Option<EyePair> {
        let [left, right] = views.as_slice() else { return None };
        let poses = [left, right].map(|view| eye_pose(&view.pose.to_transform()));
        Some(EyePair {
            poses,
            frusta: [left.fov, right.fov]
                .map(|fov| Frustum::from_fov(fov.angle_left, fov.angle_right, fov.angle_up, fov.angle_down)),
            depth: reversed(self.near),
            size: config.resolution.to_array(),
            dominant: self.dominant.into(),
        })
    }
}

fn eye_pose(transform: &Transform) -> Pose {
    Pose {
        position: transform.translation.to_array().into(),
        orientation: glam::Quat::from_array(transform.rotation.to_array()),
    }
}

pub(crate) fn build(app: &mut App) {
    app.register_type::<XrStereoCamera>()
        .add_plugins(ExtractComponentPlugin::<XrStereoCamera>::default())
        .add_systems(
            PostUpdate,
            update_cameras
                .run_if(should_run_frame_loop)
                .after(update_views)
                .before(TransformSystems::Propagate)
                .before(CameraUpdateSystems)
                .before(ShareSystems),
        )
        .add_systems(PreUpdate, pause_cameras.run_if(not(should_run_frame_loop)))
        .add_systems(XrPreDestroySession, reset_cameras)
        .add_observer(remove_other_camera);
    let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
    render
        .add_systems(
            Render,
            use_newest_views
                .run_if(should_run_frame_loop)
                .after(update_views_render_world)
                .in_set(XrRenderSystems::PreRender),
        )
        .add_systems(Core3d, fill_layers.after(Core3dSystems::PostProcess).after(upscaling));
}

fn update_cameras(
    mut commands: Commands,
    views: Res<OxrViews>,
    config: Res<OxrCurrentSessionConfig>,
    frame: Res<OxrFrameState>,
    mut images: ResMut<Assets<Image>>,
    mut cameras: Query<(&XrStereoCamera, &mut Transform, StereoCameraParts)>,
) {
    for (stereo, mut transform, mut parts) in &mut cameras {
        let pair = stereo.pair(&views, &config);
        let active = frame.should_render && pair.is_some();
        if parts.camera.is_active != active {
            parts.camera.is_active = active;
        }
        let Some(pair) = pair else { continue };
        let request = EyesRequest {
            mode: stereo.mode,
            pair: &pair,
            guard_distance: stereo.guard_distance,
            far: stereo.far,
            format: config.format,
            images: false,
        };
        let new = parts.arrange(&mut commands, &mut images, &request);
        let Some(views) = parts.eyes.views else { continue };
        *transform = bevy_transform(&views.source.pose);
        if let Some(other) = new {
            let index = pair.dominant.other().index() as u32;
            commands.entity(other).insert((
                XrCamera(index),
                Projection::custom(XrProjection { near: stereo.near, ..default() }),
                RenderTarget::TextureView(ManualTextureViewHandle(XR_TEXTURE_INDEX + index)),
                bevy_transform(&views.target.pose),
            ));
        }
    }
}

/// Deactivates the cameras, since nothing is rendered without a session.
fn pause_cameras(mut cameras: Query<&mut Camera, With<XrStereoCamera>>) {
    for mut camera in &mut cameras {
        if camera.is_active {
            camera.is_active = false;
        }
    }
}

/// Resets the cameras at the end of a session, when bevy_mod_openxr removes its own.
fn reset_cameras(mut commands: Commands, cameras: Query<Entity, With<XrStereoCamera>>) {
    for entity in &cameras {
        commands.entity(entity).remove::<OtherCamera>().insert(Eyes::default());
    }
}

/// Removes the other eye's camera.
fn remove_other_camera(
    removed: On<Remove, XrStereoCamera>,
    mut commands: Commands,
    mut cameras: Query<(&mut Camera, Option<&OtherCamera>)>,
) {
    let Ok((mut camera, other)) = cameras.get_mut(removed.entity) else { return };
    camera.is_active = false;
    if let Some(other) = other {
        commands.entity(other.entity).try_despawn();
    }
    commands.entity(removed.entity).try_remove::<(Eyes, OtherCamera)>();
}

/// Moves the rendered eye to the newest views, with which its image is submitted.
fn use_newest_views(
    views: Res<OxrViews>,
    config: Res<OxrCurrentSessionConfig>,
    root: Res<XrRootTransform>,
    mut cameras: Query<(&XrStereoCamera, &mut Stereo, &mut ExtractedView)>,
) {
    for (camera, mut stereo, mut extracted) in &mut cameras {
        let newest = camera
            .pair(&views, &config)
            .and_then(|pair| Views::new(&pair, stereo.plan, guard_band(camera.guard_distance)).ok());
        // If the sizes differ, the image has the size of the older views.
        let Some(views) = newest.filter(|views| views.source.size == stereo.views.source.size) else {
            continue;
        };
        extracted.world_from_view = root.0.mul_transform(bevy_transform(&views.source.pose));
        extracted.clip_from_view = clip_from_view(&views.source);
        extracted.clip_from_world = None;
        stereo.views = views;
    }
}

/// Fills both layers, or only the dominant eye's if the other eye has a camera.
fn fill_layers(
    view: ViewQuery<(&Stereo, &ViewDepthTexture), With<XrStereoCamera>>,
    images: Res<RenderAssets<GpuImage>>,
    layers: Res<ManualTextureViews>,
    mut synthesis: Synthesis,
) {
    let (stereo, depth) = view.into_inner();
    let Some(source) = images.get(stereo.source) else { return };
    let index = |eye: eyes::Eye| eye.index() as u32;
    let layer = |eye| layers.get(&ManualTextureViewHandle(XR_TEXTURE_INDEX + index(eye)));
    let Views { dominant, crop, target, .. } = stereo.views;
    if let Some(layer) = layer(dominant) {
        let to = layer.texture_view.texture();
        synthesis.copy(&source.texture, crop, to, [0, 0, index(dominant)], target.size);
    }
    if let Some(layer) = layer(dominant.other()) {
        stereo.synthesize_finished(
            &mut synthesis,
            &source.texture_view,
            depth,
            &Target::new(&layer.texture_view),
        );
    }
}
