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
use bevy::render::renderer::ViewQuery;
use bevy::render::texture::ManualTextureViews;
use bevy::render::view::ExtractedView;
use bevy::render::{Render, RenderApp};
use bevy_mod_openxr::helper_traits::ToTransform;
use bevy_mod_openxr::init::should_run_frame_loop;
use bevy_mod_openxr::render::{XR_TEXTURE_INDEX, update_views, update_views_render_world};
use bevy_mod_openxr::resources::{OxrCurrentSessionConfig, OxrFrameState, OxrViews};
use bevy_mod_xr::camera::{XrCamera, XrProjection};
use bevy_mod_xr::session::{XrPreDestroySession, XrRenderSystems, XrRootTransform, XrTracker};
use yoro_wgpu::yoro::eyes::{EyePair, Frustum, Pose};
use yoro_wgpu::yoro::glam;

use crate::auto::AutoChoice;
use crate::camera::{Eyes, EyesRequest, StereoCameraParts, bevy_transform, guard_band, reversed};
use crate::levels::{Foveation, LevelViews, Views, levels};
use crate::passes::{Levels, Place, ShownEyes, Stereo};
use crate::projection::clip_from_view;
use crate::shared::{EyeCameras, Role, ShareSystems};
use crate::{Eye, Holes, StereoMode};

/// Renders stereo in the headset from this `Camera3d`. The runtime's views determine the eyes' poses and frusta. The
/// plugin controls the camera's transform, projection and render target. The camera renders while a session does.
/// Despawn the entity to end this: without this component the camera is inactive.
#[derive(Component, Clone, Debug, PartialEq, Reflect, ExtractComponent)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Camera3d, Camera { is_active: false, ..default() }, Eyes, EyeCameras, XrTracker)]
pub struct XrStereoCamera {
    /// How the other eye is produced.
    pub mode: StereoMode,
    /// The eye that is rendered.
    pub dominant: Eye,
    /// What becomes of what near objects hide from the rendered eye.
    pub holes: Holes,
    /// Fewer pixels where the eyes do not look. `None` for all pixels everywhere.
    pub foveation: Option<Foveation>,
    /// Where the eyes look, as a direction in the camera's axes: it may change in every frame, and nothing is created anew.
    /// `None`, as while a tracker has lost the eyes, keeps the last direction; before the first one, it is straight ahead.
    pub gaze: Option<Dir3>,
    /// Distance of the near plane in metres, more than 0.
    pub near: f32,
    /// Distance in metres beyond which objects are culled.
    pub far: f32,
    /// Distance in metres of the nearest object that is not cut off at the other eye's outer border. Infinity for no
    /// guard band.
    pub guard_distance: f32,
}

impl Default for XrStereoCamera {
    /// Synthesizes opaque surfaces, renders the right eye with all pixels, and uses planes at 0.1 m and 1000 m and a guard band for
    /// objects at 1 m or farther.
    fn default() -> XrStereoCamera {
        XrStereoCamera {
            mode: StereoMode::default(),
            dominant: Eye::default(),
            holes: Holes::default(),
            foveation: None,
            gaze: None,
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

    /// Returns the newest views, unless their images would have other sizes than those that were arranged for.
    fn newest_views(
        &self,
        views: &OxrViews,
        config: &OxrCurrentSessionConfig,
        shown: &ShownEyes,
        sources: &Query<&mut Stereo>,
    ) -> Option<Views> {
        let arranged = |camera| sources.get(camera).ok();
        let wide = arranged(shown.wide)?;
        let inset = shown.inset.as_ref().and_then(|inset| arranged(inset.camera));
        let levels =
            levels(&self.pair(views, config)?, self.foveation.filter(|_| inset.is_some()), shown.gaze);
        let newest = Views::new(&levels.ok()?, wide.plan, guard_band(self.guard_distance)).ok()?;
        let sizes = [Some(wide), inset].map(|level| level.map(|level| level.views.sizes()));
        Some(newest).filter(|newest| newest.sizes() == sizes)
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
        .add_observer(remove_cameras);
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
    (mut images, mut auto): (ResMut<Assets<Image>>, ResMut<AutoChoice>),
    mut cameras: Query<(&XrStereoCamera, &mut Transform, StereoCameraParts)>,
    mut layers: Query<&mut XrCamera>,
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
            holes: stereo.holes,
            pair: &pair,
            foveation: stereo.foveation,
            gaze: stereo.gaze,
            guard_distance: stereo.guard_distance,
            far: stereo.far,
            refresh_hz: 1e9 / frame.predicted_display_period.as_nanos() as f32,
            format: config.format,
            images: false,
        };
        let new = parts.arrange(&mut commands, &mut images, &mut auto, &request);
        let Some(views) = parts.eyes.views else { continue };
        let source = views.wide.source.pose;
        (*transform, parts.eyes.origin) = (bevy_transform(&source), Some(source));
        let index = pair.dominant.other().index() as u32;
        let other = parts.cameras.get(Role::Other);
        if let Some(mut layer) = other.and_then(|other| layers.get_mut(other.entity).ok()) {
            layer.0 = index;
        }
        if let Some(other) = new {
            let projection_matrix = clip_from_view(&views.wide.target);
            commands.entity(other).insert((
                XrCamera(index),
                Projection::custom(XrProjection { projection_matrix, near: stereo.near }),
                RenderTarget::TextureView(ManualTextureViewHandle(XR_TEXTURE_INDEX + index)),
                bevy_transform(&views.wide.target.pose),
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
fn reset_cameras(
    mut commands: Commands,
    mut cameras: Query<(&mut Eyes, &mut EyeCameras), With<XrStereoCamera>>,
) {
    for (mut eyes, mut belonging) in &mut cameras {
        belonging.despawn(&mut commands);
        (*eyes, *belonging) = default();
    }
}

/// Removes the cameras that belong to a stereo camera.
fn remove_cameras(
    removed: On<Remove, XrStereoCamera>,
    mut commands: Commands,
    mut cameras: Query<(&mut Camera, &EyeCameras)>,
) {
    let Ok((mut camera, belonging)) = cameras.get_mut(removed.entity) else { return };
    camera.is_active = false;
    belonging.despawn(&mut commands);
    commands.entity(removed.entity).try_remove::<(Eyes, EyeCameras)>();
}

/// Moves the cameras to the newest views, with which the image is submitted.
fn use_newest_views(
    newest: Res<OxrViews>,
    config: Res<OxrCurrentSessionConfig>,
    root: Res<XrRootTransform>,
    mut shown: Query<&mut ShownEyes>,
    settings: Query<&XrStereoCamera>,
    mut sources: Query<&mut Stereo>,
    mut cameras: Query<(&mut ExtractedView, Has<XrCamera>)>,
) {
    for mut shown in &mut shown {
        let Ok(camera) = settings.get(shown.wide) else { continue };
        let newest = camera.newest_views(&newest, &config, &shown, &sources);
        let Some(views) = newest else { continue };
        let mut use_views = |source: Entity, views: LevelViews| {
            let Ok(mut stereo) = sources.get_mut(source) else { return };
            stereo.views = views;
            let other = stereo.other_camera.map(|other| (other, views.target));
            for (entity, view) in [Some((source, views.source)), other].into_iter().flatten() {
                // bevy_mod_openxr moves its own cameras.
                if let Ok((mut extracted, false)) = cameras.get_mut(entity) {
                    extracted.world_from_view = root.0.mul_transform(bevy_transform(&view.pose));
                    extracted.clip_from_view = clip_from_view(&view);
                    extracted.clip_from_world = None;
                }
            }
        };
        use_views(shown.wide, views.wide);
        if let (Some(shown), Some(views)) = (&mut shown.inset, views.inset) {
            use_views(shown.camera, views.views);
            shown.compositions = views.compositions;
        }
    }
}

/// Fills both layers, or only the dominant eye's if the camera of the other eye fills its own.
fn fill_layers(view: ViewQuery<&ShownEyes>, layers: Res<ManualTextureViews>, mut levels: Levels) {
    levels.show(view.into_inner(), |eye| {
        let layer = eye.index() as u32;
        let place = layers.get(&ManualTextureViewHandle(XR_TEXTURE_INDEX + layer))?;
        Some(Place { view: &place.texture_view, layer, x: 0 })
    });
}
