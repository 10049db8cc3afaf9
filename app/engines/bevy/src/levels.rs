//! What is rendered at which density: one level with all pixels, or a wide level with few and an inset with all of them.

use bevy::prelude::*;
use yoro_wgpu::yoro::eyes::{
    self, Composition, Eye, EyePair, EyesError, Gaze, GuardBand, StereoViews, SynthesisViews, View,
    ViewLayer, Warp,
};
use yoro_wgpu::yoro::glam;

use crate::plan::Plan;
use crate::shared::Role;

/// Foveation: a wide level has fewer pixels, an inset around the gaze all of them. Each is rendered, synthesized and
/// post-processed by itself, and the eyes are composed last. Both eyes have an inset of one size.
///
/// Whatever is measured in pixels, such as the width of gizmos, is larger in the wide level. Effects that cannot be made of
/// an image's parts prevent foveation, and one line in the log says so: `AtmosphereSettings`, `AutoExposure`, `Bloom`
/// (light from beyond the inset's border, without which the border is seen), `ChromaticAberration`, `DeferredPrepass`,
/// `LensDistortion`, `MotionBlur`, `ScreenSpaceReflections` and `Vignette`.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Debug, PartialEq, Clone)]
pub struct Foveation {
    /// The angle in radians around the gaze that has all pixels: more than 0, less than 80 degrees.
    pub radius: f32,
    /// Pixels of the wide level for each pixel of the eye, along each axis: more than 0, at most 1.
    pub density: f32,
    /// The distance from which on the other eye's inset is complete, in the camera's unit. Where a nearer surface leaves a
    /// hole at the inset's border, the wide level shows in [`StereoMode::Opaque`](crate::StereoMode::Opaque).
    pub nearest: f32,
}

impl Foveation {
    /// 30 degrees with all pixels, beyond them half of the pixels along each axis.
    pub const LOW: Foveation = Foveation { radius: 30f32.to_radians(), ..Foveation::MEDIUM };
    /// 20 degrees with all pixels, beyond them half of the pixels along each axis.
    pub const MEDIUM: Foveation = Foveation { radius: 20f32.to_radians(), density: 0.5, nearest: 0.5 };
    /// 20 degrees with all pixels, beyond them a third of the pixels along each axis.
    pub const HIGH: Foveation = Foveation { density: 1.0 / 3.0, ..Foveation::MEDIUM };
}

/// The views of both eyes in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Views {
    pub(crate) dominant: Eye,
    /// Width and height of each eye's image.
    pub(crate) size: [u32; 2],
    /// The level that fills the eyes.
    pub(crate) wide: LevelViews,
    pub(crate) inset: Option<InsetViews>,
}

/// The views of a level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LevelViews {
    /// The view that is rendered: the dominant eye's, widened unless both eyes are rendered.
    pub(crate) source: View,
    /// The view of the other eye.
    pub(crate) target: View,
    /// Upper left corner, in pixels, of the dominant eye's own image in the source.
    pub(crate) crop: [u32; 2],
    /// `None` if both eyes are rendered.
    pub(crate) warp: Option<Warp>,
}

/// The views of an inset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct InsetViews {
    pub(crate) views: LevelViews,
    /// How each eye is composed of both levels.
    pub(crate) compositions: [Composition; 2],
}

impl Views {
    /// Returns the views for a plan. `guard` is the guard band of the level that fills the eyes.
    ///
    /// # Errors
    /// The reason why the other eye cannot be synthesized from these eyes.
    pub(crate) fn new(eyes: &StereoViews, plan: Plan, guard: GuardBand) -> Result<Views, EyesError> {
        if plan == Plan::Rendered {
            return Ok(Views::rendered(eyes));
        }
        let level = |layer: &ViewLayer| layer.synthesis_views(guard).map(LevelViews::from);
        let inset = eyes.inset.as_ref().map(level).transpose()?;
        Ok(Views::of_levels(eyes, level(&eyes.wide)?, inset))
    }

    /// Returns the views if both eyes are rendered.
    pub(crate) fn rendered(eyes: &StereoViews) -> Views {
        let inset = eyes.inset.as_ref().map(LevelViews::rendered);
        Views::of_levels(eyes, LevelViews::rendered(&eyes.wide), inset)
    }

    fn of_levels(eyes: &StereoViews, wide: LevelViews, inset: Option<LevelViews>) -> Views {
        let compositions = Eye::BOTH.map(|eye| eyes.composition(eye));
        let inset = inset.map(|views| InsetViews { views, compositions });
        Views { dominant: eyes.shown.dominant, size: eyes.shown.size, wide, inset }
    }

    /// Returns the view for a camera, and that of the level that fills the eye.
    pub(crate) fn of(&self, role: Role) -> Option<(&View, &View)> {
        let (wide, inset) = (&self.wide, self.inset.as_ref().map(|inset| &inset.views));
        match role {
            Role::Other => Some((&wide.target, &wide.target)),
            Role::Inset => inset.map(|inset| (&inset.source, &wide.source)),
            Role::OtherInset => inset.map(|inset| (&inset.target, &wide.target)),
        }
    }

    /// Returns the role of the camera of the other eye that has all pixels.
    pub(crate) fn detailed(&self) -> Role {
        if self.inset.is_some() { Role::OtherInset } else { Role::Other }
    }

    /// Returns the sizes of each level's source and target.
    pub(crate) fn sizes(&self) -> [Option<[[u32; 2]; 2]>; 2] {
        [Some(self.wide.sizes()), self.inset.map(|inset| inset.views.sizes())]
    }
}

impl LevelViews {
    /// Returns the views if both eyes are rendered.
    fn rendered(layer: &ViewLayer) -> LevelViews {
        let (eyes, dominant) = (&layer.eyes, layer.eyes.dominant);
        let (source, target) = (eyes.view(dominant), eyes.view(dominant.other()));
        LevelViews { source, target, crop: [0, 0], warp: None }
    }

    /// Returns the sizes of the source and the target.
    pub(crate) fn sizes(&self) -> [[u32; 2]; 2] {
        [self.source.size, self.target.size]
    }
}

impl From<SynthesisViews> for LevelViews {
    fn from(views: SynthesisViews) -> LevelViews {
        let crop = views.dominant_crop_from_top();
        LevelViews { source: views.source, target: views.target, crop, warp: Some(views.warp) }
    }
}

/// Returns the levels of two eyes. `gaze` is a direction in their axes; `None` for straight ahead.
///
/// # Errors
/// The reason why these eyes cannot be foveated so.
pub(crate) fn levels(
    pair: &EyePair,
    foveation: Option<Foveation>,
    gaze: Option<Dir3>,
) -> Result<StereoViews, EyesError> {
    let foveation = foveation.map(|Foveation { radius, density, nearest }| eyes::Foveation {
        radius,
        density,
        nearest,
        fade: 0.0,
    });
    let orientation = pair.poses[pair.dominant.index()].orientation;
    let gaze = gaze.map_or(Gaze::Axes(pair.axes()), |gaze| {
        Gaze::Direction(orientation * glam::Vec3::from_array(gaze.to_array()))
    });
    pair.stereo_views(foveation.as_ref(), gaze)
}
