//! The components of the rendered camera that the other eye's camera has, too.

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

/// On a stereo camera: the camera of its other eye.
#[derive(Component, Clone, Copy)]
pub(crate) struct OtherCamera {
    pub(crate) entity: Entity,
    /// False if it draws only what is not synthesized.
    pub(crate) rendered: bool,
}

/// Components that both eyes' cameras have.
pub trait ShareComponent {
    /// Gives the other eye's camera this component of the rendered camera, whenever it changes: for post-processing of
    /// your own. Bevy's own components need no call.
    fn share_with_other_eye<C: Component + Clone>(&mut self) -> &mut Self;
}

impl ShareComponent for App {
    fn share_with_other_eye<C: Component + Clone>(&mut self) -> &mut Self {
        self.add_systems(PostUpdate, share::<C, true>.in_set(ShareSystems))
    }
}

/// Before Bevy looks at its cameras, and after those of the other eyes are there.
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
        // What draws opaque surfaces, or needs passes that do (and brings them along).
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

/// `SYNTHESIZED` is false for components that the camera of a synthesized eye must not have.
fn share<C: Component + Clone, const SYNTHESIZED: bool>(
    mut commands: Commands,
    changed: Query<(&OtherCamera, &C), Or<(Changed<C>, Changed<OtherCamera>)>>,
    mut removed: RemovedComponents<C>,
    others: Query<&OtherCamera, Without<C>>,
) {
    for (other, component) in &changed {
        if SYNTHESIZED || other.rendered {
            commands.entity(other.entity).try_insert(component.clone());
        }
    }
    for other in removed.read().filter_map(|camera| others.get(camera).ok()) {
        commands.entity(other.entity).try_remove::<C>();
    }
}
