//! The components of the rendered camera that are shared with the other eye's camera.

use bevy::anti_alias::contrast_adaptive_sharpening::ContrastAdaptiveSharpening;
use bevy::anti_alias::{fxaa::Fxaa, smaa::Smaa, taa::TemporalAntiAliasing};
use bevy::camera::visibility::RenderLayers;
use bevy::camera::{CompositingSpace, Exposure, Hdr};
use bevy::core_pipeline::Skybox;
use bevy::core_pipeline::oit::OrderIndependentTransparencySettings;
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::light::{AmbientLight, EnvironmentMapLight, ShadowFilteringMethod, VolumetricFog};
use bevy::pbr::{DistanceFog, ScreenSpaceAmbientOcclusion, ScreenSpaceTransmission};
use bevy::post_process::bloom::Bloom;
use bevy::post_process::dof::DepthOfField;
use bevy::post_process::effect_stack::{ChromaticAberration, LensDistortion, Vignette};
use bevy::prelude::*;
use bevy::render::camera::MipBias;
use bevy::render::view::ColorGrading;

/// The cameras that belong to a stereo camera, which itself renders the wide level: by [`Role`].
#[derive(Component, Clone, Copy, Default)]
pub(crate) struct EyeCameras(pub(crate) [Option<EyeCamera>; 3]);

/// What a camera that belongs to a stereo camera draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// The other eye's wide level.
    Other,
    /// The inset that the other eye's is synthesized from.
    Inset,
    /// The other eye's inset.
    OtherInset,
}

impl Role {
    pub(crate) const ALL: [Role; 3] = [Role::Other, Role::Inset, Role::OtherInset];
}

/// A camera that belongs to a stereo camera.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EyeCamera {
    pub(crate) entity: Entity,
    /// False if the camera draws only what is not synthesized.
    pub(crate) opaque: bool,
    /// False if its target and projection are bevy_mod_openxr's.
    pub(crate) owned: bool,
}

impl EyeCameras {
    pub(crate) fn get(&self, role: Role) -> Option<EyeCamera> {
        self.0[role as usize]
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &EyeCamera> {
        self.0.iter().flatten()
    }

    /// Despawns them all.
    pub(crate) fn despawn(&self, commands: &mut Commands) {
        self.iter().for_each(|camera| commands.entity(camera.entity).try_despawn());
    }
}

/// Shares components between both eyes' cameras.
pub trait ShareComponent {
    /// Copies this component of the rendered camera to the cameras of the other eye and of the inset whenever it changes.
    /// Use it for your own post-processing; Bevy's components are already shared.
    fn share_with_other_eye<C: Component + Clone>(&mut self) -> &mut Self;
}

impl ShareComponent for App {
    fn share_with_other_eye<C: Component + Clone>(&mut self) -> &mut Self {
        self.add_systems(PostUpdate, share::<C, true>.in_set(ShareSystems))
    }
}

/// Runs before Bevy updates its cameras, and after the other eyes' cameras have been spawned.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ShareSystems;

pub(crate) fn build(app: &mut App) {
    app.share_with_other_eye::<AmbientLight>()
        .share_with_other_eye::<Bloom>()
        .share_with_other_eye::<ChromaticAberration>()
        .share_with_other_eye::<ColorGrading>()
        .share_with_other_eye::<CompositingSpace>()
        .share_with_other_eye::<ContrastAdaptiveSharpening>()
        .share_with_other_eye::<DebandDither>()
        .share_with_other_eye::<DepthOfField>()
        .share_with_other_eye::<DistanceFog>()
        .share_with_other_eye::<EnvironmentMapLight>()
        .share_with_other_eye::<Exposure>()
        .share_with_other_eye::<Fxaa>()
        .share_with_other_eye::<Hdr>()
        .share_with_other_eye::<LensDistortion>()
        .share_with_other_eye::<MipBias>()
        .share_with_other_eye::<OrderIndependentTransparencySettings>()
        .share_with_other_eye::<RenderLayers>()
        .share_with_other_eye::<ScreenSpaceTransmission>()
        .share_with_other_eye::<ShadowFilteringMethod>()
        .share_with_other_eye::<Smaa>()
        .share_with_other_eye::<Tonemapping>()
        .share_with_other_eye::<Vignette>()
        .share_with_other_eye::<VolumetricFog>()
        // Those with `false` draw opaque surfaces, or need passes which do and add their components.
        .add_systems(
            PostUpdate,
            (
                share::<ScreenSpaceAmbientOcclusion, false>,
                share::<Skybox, false>,
                share::<TemporalAntiAliasing, false>,
            )
                .in_set(ShareSystems),
        );
}

/// Copies a component to the cameras that belong to a stereo camera. `SYNTHESIZED` is false for components that the camera
/// of a synthesized eye must not have.
fn share<C: Component + Clone, const SYNTHESIZED: bool>(
    mut commands: Commands,
    changed: Query<(&EyeCameras, &C), Or<(Changed<C>, Changed<EyeCameras>)>>,
    mut removed: RemovedComponents<C>,
    others: Query<&EyeCameras, Without<C>>,
) {
    for (cameras, component) in &changed {
        for camera in cameras.iter().filter(|camera| SYNTHESIZED || camera.opaque) {
            commands.entity(camera.entity).try_insert(component.clone());
        }
    }
    for cameras in removed.read().filter_map(|camera| others.get(camera).ok()) {
        for camera in cameras.iter() {
            commands.entity(camera.entity).try_remove::<C>();
        }
    }
}
