//! An eye at the density that is seen: a wide view of few pixels, and an inset of all of them where the eye looks.
//!
//! Each level is a view of its own: it is rendered, and synthesized at its own density, and the eye is composed of the
//! results. An image that is composed before, or whose density varies within, has pixels at the seams and silhouettes
//! whose colour and depth belong to no surface.

mod composition;
#[cfg(test)]
mod tests;

use glam::{DVec3, Vec3};

use super::{Eye, EyePair, EyesError, Frustum, GuardBand, Pose, SynthesisViews};

pub use composition::{Composition, InsetPlace, LevelPlace};

/// How much is rendered at full density, and how the rest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Foveation {
    /// The angle in radians around the gaze that is rendered with all pixels: more than 0, less than 80 degrees.
    pub radius: f32,
    /// Pixels of the wide view for each pixel of the eye's image, along each axis: more than 0, at most 1.
    pub density: f32,
    /// The angle in radians beyond the radius over which the inset fades into the wide view. 0 for a hard seam, which
    /// loses nothing.
    pub fade: f32,
    /// The distance in metres from which on the inset of the synthesized eye is complete. The band that this needs takes
    /// 17 % of the inset's width for 0.5 m, 20 degrees and 63 mm. Where a nearer surface leaves a hole at the border, the
    /// wide view shows.
    pub nearest: f32,
}

impl Foveation {
    /// The foveation of [`FoveationLevel::Medium`].
    pub const MEDIUM: Foveation =
        Foveation { radius: 20.0 * RADIANS_PER_DEGREE, density: 0.5, fade: 0.0, nearest: 0.5 };

    fn check(&self) -> Result<(), EyesError> {
        let Foveation { radius, density, fade, nearest } = *self;
        let reach = radius + fade;
        // Written so that NaN fails, too.
        let is_possible = radius > 0.0
            && fade >= 0.0
            && reach < LARGEST_ANGLE
            && density > 0.0
            && density <= 1.0
            && nearest > 0.0
            && nearest.is_finite();
        if is_possible { Ok(()) } else { Err(EyesError::Foveation) }
    }
}

const RADIANS_PER_DEGREE: f32 = std::f32::consts::PI / 180.0;
/// No view reaches further from its axis than 80 degrees.
const LARGEST_ANGLE: f32 = 80.0 * RADIANS_PER_DEGREE;

/// The strength of foveation, as OpenXR's runtimes name it: `Low` has a larger inset than `Medium`, `High` a coarser wide
/// view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum FoveationLevel {
    /// All pixels everywhere.
    #[default]
    Off,
    /// 30 degrees, half of the pixels along each axis beyond.
    Low,
    /// 20 degrees, half of the pixels along each axis beyond.
    Medium,
    /// 20 degrees, a third of the pixels along each axis beyond.
    High,
}

impl FoveationLevel {
    /// All levels, from the one with the most pixels to the one with the fewest.
    pub const ALL: [FoveationLevel; 4] =
        [FoveationLevel::Off, FoveationLevel::Low, FoveationLevel::Medium, FoveationLevel::High];

    /// Returns the foveation, `None` for `Off`.
    pub fn foveation(self) -> Option<Foveation> {
        match self {
            FoveationLevel::Off => None,
            FoveationLevel::Low => Some(Foveation { radius: 30.0 * RADIANS_PER_DEGREE, ..Foveation::MEDIUM }),
            FoveationLevel::Medium => Some(Foveation::MEDIUM),
            FoveationLevel::High => Some(Foveation { density: 1.0 / 3.0, ..Foveation::MEDIUM }),
        }
    }

    /// Returns `off`, `low`, `medium` or `high`.
    pub fn name(self) -> &'static str {
        match self {
            FoveationLevel::Off => "off",
            FoveationLevel::Low => "low",
            FoveationLevel::Medium => "medium",
            FoveationLevel::High => "high",
        }
    }
}

/// Where the eyes look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gaze {
    /// Each along an axis of its own that stays, as a direction in the world: [`EyePair::axes`], which is fixed
    /// foveation. Of eyes that were turned by [`EyePair::rectified`], the axes from before.
    Axes([Vec3; 2]),
    /// Both in one direction in the world, as an eye tracker gives it. The inset keeps its size in pixels and tangents, so
    /// at an angle `a` from the axis it reaches `atan(tan a + tan radius) - a` outwards: 17 of 20 degrees at 15 degrees.
    /// It stays within what the two eyes see together.
    Direction(Vec3),
}

/// A layer of what both eyes see: all of it, or what lies around the gaze.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewLayer {
    /// The eyes with this layer's frusta and size.
    pub eyes: EyePair,
    /// For an inset, the distance in metres from which on the synthesized eye is complete. `None` for the layer that fills
    /// the eyes' images.
    pub nearest: Option<f32>,
}

/// What both eyes see in a frame: one layer with all pixels, or a wide layer of few pixels and an inset of all of them
/// where the eyes look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StereoViews {
    /// The eyes as they are shown.
    pub shown: EyePair,
    /// The layer that fills the eyes' images.
    pub wide: ViewLayer,
    /// The layer where the eyes look; `None` if the wide one has all pixels.
    pub inset: Option<ViewLayer>,
    /// Columns and rows of the inset over which it fades into the wide layer; 0 for a hard seam.
    pub fade: [f32; 2],
}

impl ViewLayer {
    /// Returns the view to render for this layer, and how its pixels move to the other eye. `guard` is the guard band of the
    /// wide layer; an inset has the band that it needs.
    ///
    /// # Errors
    /// Those of [`EyePair::synthesis_views`].
    pub fn synthesis_views(&self, guard: GuardBand) -> Result<SynthesisViews, EyesError> {
        match self.nearest {
            Some(nearest) => self.eyes.inset_views(nearest),
            None => self.eyes.synthesis_views(guard),
        }
    }
}

impl From<EyePair> for StereoViews {
    /// Returns the one layer that has all pixels.
    fn from(shown: EyePair) -> StereoViews {
        StereoViews { shown, wide: ViewLayer { eyes: shown, nearest: None }, inset: None, fade: [0.0; 2] }
    }
}

impl StereoViews {
    /// Returns the layers, the wide one first.
    pub fn layers(&self) -> impl Iterator<Item = &ViewLayer> {
        [Some(&self.wide), self.inset.as_ref()].into_iter().flatten()
    }
}

/// A rectangle of pixels in an eye's image: its lower left corner, which may lie outside, and its size.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rectangle {
    corner: [i64; 2],
    size: [u32; 2],
}

impl EyePair {
    /// Returns the direction of each eye's axis in the world.
    pub fn axes(&self) -> [Vec3; 2] {
        self.poses.map(|pose| pose.forward())
    }

    /// Returns what these eyes see: a wide layer with fewer pixels, and an inset with all of them where the eyes look. One
    /// layer without a foveation, and with one that would save no pixels.
    ///
    /// Sizes do not depend on a [`Gaze::Direction`]. The pixels of the inset are pixels of the eye's image.
    ///
    /// # Errors
    /// [`EyesError::Foveation`]; [`EyesError`] for a view that cannot be rendered.
    pub fn stereo_views(&self, foveation: Option<&Foveation>, gaze: Gaze) -> Result<StereoViews, EyesError> {
        let Some(foveation) = foveation else { return Ok((*self).into()) };
        foveation.check()?;
        Eye::BOTH.iter().try_for_each(|&eye| self.view(eye).check())?;
        let insets = self.insets(foveation, gaze);
        let wide = self.coarse(foveation.density);
        let pixels = |size: [u32; 2]| u64::from(size[0]) * u64::from(size[1]);
        if pixels(wide.size) + pixels(insets[0].size) >= pixels(self.size) {
            return Ok((*self).into());
        }
        let inset = EyePair {
            frusta: Eye::BOTH.map(|eye| self.frustum_of(eye, &insets[eye.index()])),
            size: insets[0].size,
            ..*self
        };
        let beyond = f64::from((foveation.radius + foveation.fade).tan() - foveation.radius.tan());
        Ok(StereoViews {
            shown: *self,
            wide: ViewLayer { eyes: wide, nearest: None },
            inset: Some(ViewLayer { eyes: inset, nearest: Some(foveation.nearest) }),
            fade: self.density(self.dominant).map(|tangents| (beyond / tangents) as f32),
        })
    }

    /// Returns the eyes with fewer pixels. The rows of both are aligned in any case.
    fn coarse(&self, density: f32) -> EyePair {
        let even = self.row_aligned();
        let frustum = even.frusta[self.dominant.index()];
        let [x, y] = self.density(self.dominant);
        let pixels = [f64::from(frustum.width()) / x, f64::from(frustum.height()) / y];
        let size = pixels.map(|pixels| (pixels * f64::from(density) - 1e-3).ceil().max(1.0) as u32);
        EyePair { size, ..even }
    }

    /// Returns the tangents that a pixel of an eye covers, along X and Y.
    fn density(&self, eye: Eye) -> [f64; 2] {
        self.tangents_per_pixel(eye).map(f64::from)
    }

    /// Returns the places of the insets in the eyes' images. Both have one size.
    fn insets(&self, foveation: &Foveation, gaze: Gaze) -> [Rectangle; 2] {
        match gaze {
            Gaze::Axes(axes) => self.fixed_insets(foveation.radius + foveation.fade, axes),
            Gaze::Direction(direction) => self.moving_insets(foveation.radius + foveation.fade, direction),
        }
    }

    /// Returns insets that contain all directions within an angle of the axes, as far as the eyes see them.
    fn fixed_insets(&self, angle: f32, axes: [Vec3; 2]) -> [Rectangle; 2] {
        let spans = Eye::BOTH.map(|eye| {
            let (frustum, density) = (&self.frusta[eye.index()], self.density(eye));
            let bounds = cone_bounds(&self.poses[eye.index()], axes[eye.index()], f64::from(angle));
            let lows = [frustum.left, frustum.bottom];
            [0, 1].map(|axis| {
                let pixel = |tangent: f64| (tangent - f64::from(lows[axis])) / density[axis];
                let all = f64::from(self.size[axis]);
                // An axis that the eye does not see leaves an inset of one pixel at the border.
                let low = (pixel(bounds[axis][0]) + 1e-3).floor().clamp(0.0, all - 1.0);
                let high = (pixel(bounds[axis][1]) - 1e-3).ceil().clamp(low + 1.0, all);
                [low as i64, high as i64]
            })
        });
        let length = |[low, high]: [i64; 2]| high - low;
        let size = [0, 1].map(|axis| length(spans[0][axis]).max(length(spans[1][axis])));
        spans.map(|spans| {
            let corner = [0, 1].map(|axis| {
                let [low, high] = spans[axis];
                let more = size[axis] - (high - low);
                (low - more / 2).clamp(0, i64::from(self.size[axis]) - size[axis])
            });
            Rectangle { corner, size: size.map(|pixels| pixels as u32) }
        })
    }

    /// Returns insets of constant size around one direction, over the same tangents in both eyes, within what the two
    /// see together.
    fn moving_insets(&self, angle: f32, direction: Vec3) -> [Rectangle; 2] {
        let density = self.density(self.dominant);
        let center = tangents(&self.poses[self.dominant.index()], direction);
        let lows = self.frusta.map(|frustum| [frustum.left, frustum.bottom].map(f64::from));
        // Pixels of the dominant eye from the other eye's corner to its own.
        let (own, other) = (lows[self.dominant.index()], lows[self.dominant.other().index()]);
        let apart = [0, 1].map(|axis| ((own[axis] - other[axis]) / density[axis]).round() as i64);
        let place = [0, 1].map(|axis| {
            let pixels = i64::from(self.size[axis]);
            let across = 2.0 * f64::from(angle.tan()) / density[axis];
            let size = (across.ceil() as i64 + 1).min(pixels);
            let middle = (center[axis] - own[axis]) / density[axis];
            let (first, last) = ((-apart[axis]).min(0), (-apart[axis]).max(0) + pixels);
            let corner = (middle - size as f64 / 2.0).round().clamp(first as f64, (last - size) as f64);
            (corner as i64, size as u32)
        });
        let size = place.map(|(_, size)| size);
        Eye::BOTH.map(|eye| {
            let shift = if eye == self.dominant { [0, 0] } else { apart };
            Rectangle { corner: [0, 1].map(|axis| place[axis].0 + shift[axis]), size }
        })
    }

    /// Returns the frustum of a rectangle of an eye's image.
    fn frustum_of(&self, eye: Eye, rectangle: &Rectangle) -> Frustum {
        let (frustum, density) = (&self.frusta[eye.index()], self.density(eye));
        let at = |axis: usize, low: f32, pixels: i64| (f64::from(low) + pixels as f64 * density[axis]) as f32;
        let end = |axis: usize| rectangle.corner[axis] + i64::from(rectangle.size[axis]);
        Frustum {
            left: at(0, frustum.left, rectangle.corner[0]),
            right: at(0, frustum.left, end(0)),
            bottom: at(1, frustum.bottom, rectangle.corner[1]),
            top: at(1, frustum.bottom, end(1)),
        }
    }
}

/// Returns a direction in a pose's own axes, of length 1; straight ahead for what is no direction.
fn local(pose: &Pose, direction: Vec3) -> DVec3 {
    let own = pose.orientation.as_dquat().inverse() * direction.as_dvec3();
    own.try_normalize().unwrap_or(DVec3::NEG_Z)
}

/// Returns the tangents of a direction from a pose's axis, to the right and up.
fn tangents(pose: &Pose, direction: Vec3) -> [f64; 2] {
    let own = local(pose, direction);
    // Directions beside and behind the eye are far to its side.
    let ahead = (-own.z).max(1e-3);
    [own.x / ahead, own.y / ahead]
}

/// Returns the smallest and the largest tangent of the directions within an angle of one, along X and Y.
fn cone_bounds(pose: &Pose, direction: Vec3, angle: f64) -> [[f64; 2]; 2] {
    let own = local(pose, direction);
    [own.x, own.y].map(|aside| {
        // The plane through the eye that touches the cone is turned by this from the direction's own plane.
        // Without `hypot`, of which new C libraries have a version that old ones lack.
        let (middle, length) = (aside.atan2(-own.z), (aside * aside + own.z * own.z).sqrt());
        let turn = (angle.sin() / length).min(1.0).asin();
        [middle - turn, middle + turn].map(|angle| {
            let largest = f64::from(LARGEST_ANGLE);
            angle.clamp(-largest, largest).tan()
        })
    })
}
