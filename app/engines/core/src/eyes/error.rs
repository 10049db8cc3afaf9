//! The reasons why one eye cannot be synthesized from the other.

use super::{GuardBand, Warp};

/// The reason why one eye of a pair cannot be synthesized from the other.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EyesError {
    /// The eyes' orientations differ.
    #[error(
        "the eyes are canted by {degrees:.2} degrees against each other; synthesis moves pixels along rows only: render both eyes, or give both the same orientation"
    )]
    Canted {
        /// The angle between the eyes' orientations.
        degrees: f32,
    },
    /// A view shows something too far to the side of, or behind, the other view.
    #[error(
        "a view reaches further than 80 degrees from the axis of the one to render; render a view in a pose nearer to it, or allow less motion"
    )]
    Apart,
    /// The eyes are displaced along more than their X axis.
    #[error(
        "the eyes are displaced by {off_axis:.4} m off their common X axis; synthesis moves pixels along rows only: place both eyes on one horizontal line, or turn both at right angles to the line between them"
    )]
    OffAxis {
        /// Displacement in metres perpendicular to the X axis.
        off_axis: f32,
    },
    /// The left eye is right of the right eye.
    #[error("the left eye is {distance:.4} m to the right of the right eye; swap the eyes")]
    Swapped {
        /// The distance in metres.
        distance: f32,
    },
    /// Surfaces at the near plane move further than the shaders can store ([`Warp::MAX_DISPLACEMENT`]).
    #[error(
        "surfaces at the near plane move by {pixels:.0} pixels from eye to eye, and at most {max} can be synthesized; move the near plane away, bring the eyes together, or render fewer pixels",
        max = Warp::MAX_DISPLACEMENT
    )]
    Displacement {
        /// Displacement in pixels.
        pixels: f64,
    },
    /// The two frusta have different tangents per pixel.
    #[error(
        "the eyes have different pixel densities ({left:.6} and {right:.6} tangents per pixel on one axis); give both the same size and frusta of the same width and height"
    )]
    Density {
        /// Tangents per pixel of the left eye.
        left: f32,
        /// Tangents per pixel of the right eye.
        right: f32,
    },
    /// The rows of one eye's image do not coincide with rows of the other's.
    #[error(
        "the rows of the eyes' images are {rows:.2} rows apart, and a row of one must lie on a row of the other; give both frusta the same bottom and top"
    )]
    Rows {
        /// Rows from the left eye's lower edge up to the right eye's.
        rows: f32,
    },
    /// A pose or a frustum has a value that is not finite, or an orientation is not a rotation.
    #[error("an eye's pose or frustum is invalid: need finite numbers and an orientation of length 1")]
    Invalid,
    /// An image has no pixels.
    #[error("the eyes' images have a width or height of 0; give both in pixels")]
    NoPixels,
    /// A frustum has no area.
    #[error("an eye's frustum is empty: need left < right and bottom < top")]
    Empty,
    /// The depth planes are out of order.
    #[error("the depth planes are out of order: need 0 < near < far, and a near plane that is finite")]
    Planes,
    /// Motion vectors of the two frames have no law in common.
    #[error(
        "{what} changed between the frames, so that motion vectors do not tell the other eye's: mark this frame as not to be extrapolated"
    )]
    OtherFrame {
        /// What changed.
        what: &'static str,
    },
    /// The guard band is wider than [`GuardBand::MAX_PIXELS`], or its distance is not positive and finite.
    #[error(
        "a guard band of {0} is impossible; give none, at most {max}px, or a finite distance of more than 0",
        max = GuardBand::MAX_PIXELS
    )]
    GuardBand(GuardBand),
    /// A number of the foveation is out of its range.
    #[error(
        "this foveation is impossible; give a radius between 0 and 80 degrees, a density of more than 0 and at most 1, and a finite distance of more than 0"
    )]
    Foveation,
    /// The union of both frusta and the guard band has more pixels on a side than drivers render.
    #[error(
        "the view to render would have {width:.0}x{height:.0} pixels; give the eyes fewer pixels, or frusta that overlap"
    )]
    TooLarge {
        /// Width in pixels.
        width: f64,
        /// Height in pixels.
        height: f64,
    },
}
