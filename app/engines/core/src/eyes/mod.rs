//! Geometry of the eyes: poses, frusta, depth ranges, and the law that moves a pixel from one eye to the other.
//!
//! Units are metres and radians. A world in other units works as well, if all lengths are in that unit. Pixels have
//! their centre at +0.5. The world is right-handed with Y up, and an eye looks along its own -Z with X to the right.

mod depth;
mod error;
mod foveation;
mod guard_band;
mod motion;
mod pair;
mod pose_warp;
mod view;
mod warp;

pub use depth::{DepthConvention, DepthRange};
pub use error::EyesError;
pub use foveation::{
    Composition, Foveation, FoveationLevel, Gaze, InsetPlace, LevelPlace, StereoViews, ViewLayer,
};
pub use guard_band::{GuardBand, ParseGuardBandError};
pub use motion::{MotionMap, MotionWarp, Ndc, VectorSpace, VectorsOf};
pub use pair::{EyeOptions, EyePair, SynthesisViews};
pub use pose_warp::{GuardedView, HeadMotion, PoseWarp};
pub use view::{Frustum, Pose, View};
pub use warp::{DisparityMap, Warp, full_overlap_distance, minimum_object_distance};

/// The mean distance of people's eyes in metres, for when it was not measured.
pub const MEAN_IPD: f32 = 0.063;

/// One of the two eyes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Eye {
    /// The left eye.
    Left,
    /// The right eye.
    Right,
}

impl Eye {
    /// Both eyes, left first.
    pub const BOTH: [Eye; 2] = [Eye::Left, Eye::Right];

    /// Returns the other eye.
    pub fn other(self) -> Eye {
        match self {
            Eye::Left => Eye::Right,
            Eye::Right => Eye::Left,
        }
    }

    /// Returns the eye's index in arrays of two: 0 for left, 1 for right.
    pub fn index(self) -> usize {
        self as usize
    }

    /// Returns the eye's side along the head's X axis: -1 for left, +1 for right.
    pub fn side(self) -> f32 {
        match self {
            Eye::Left => -1.0,
            Eye::Right => 1.0,
        }
    }

    /// Returns `left` or `right`.
    pub fn name(self) -> &'static str {
        match self {
            Eye::Left => "left",
            Eye::Right => "right",
        }
    }
}
