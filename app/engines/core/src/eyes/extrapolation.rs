//! How surfaces go on after a frame, from their motion vectors.

use glam::{DMat4, DQuat, DVec4, Mat4};

use super::{EyesError, Ndc, View};

/// What the extrapolation of a rendered view needs to know: its view and that of the frame to which its vectors point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extrapolation {
    /// Size of the view in pixels.
    pub size: [u32; 2],
    /// From `(x, y, 1, inverse distance)` in the former view's normalized device coordinates to the same in this view's,
    /// times a factor.
    pub from_former: Mat4,
    /// `(c, m)` of this view's `1 / distance = c + m * depth`.
    pub law: [f64; 2],
    /// The same for the former view.
    pub former_law: [f64; 2],
    /// Stored depth per unit of a vector's z.
    pub z_scale: f64,
    /// The part of the step between the frames by which surfaces go on.
    pub ahead: f64,
}

impl Extrapolation {
    /// Returns the extrapolation of a rendered view, whose vectors are in its own normalized device coordinates minus those
    /// of the former view. Surfaces go on in a straight line by `ahead` times their step: 0.5 for the middle of the next
    /// one.
    ///
    /// # Errors
    /// [`EyesError::Invalid`], [`EyesError::NoPixels`], [`EyesError::Empty`] or [`EyesError::Planes`] for an invalid view.
    pub fn new(view: &View, former: &View, ndc: Ndc, ahead: f64) -> Result<Extrapolation, EyesError> {
        view.check()?;
        former.check()?;
        // Subtract the positions first: their difference is small even where positions are large.
        let apart = former.pose.position.as_dvec3() - view.pose.position.as_dvec3();
        let turn =
            |view: &View| DQuat::from_vec4(DVec4::from(view.pose.orientation.to_array().map(f64::from)));
        let [to_view, from_former] = [turn(view).normalize().inverse(), turn(former).normalize()];
        let moved =
            DMat4::from_quat(to_view) * DMat4::from_translation(apart) * DMat4::from_quat(from_former);
        let law = |view: &View| {
            let (c, m) = view.depth.inverse_distance_law();
            [c, m]
        };
        Ok(Extrapolation {
            size: view.size,
            from_former: (to_image(view) * moved * to_image(former).inverse()).as_mat4(),
            law: law(view),
            former_law: law(former),
            z_scale: match ndc {
                Ndc::ZeroToOne => 1.0,
                Ndc::MinusOneToOne => 0.5,
            },
            ahead,
        })
    }
}

/// Returns the matrix from a place in a view's local space to normalized device coordinates and 1, each times the distance
/// along the viewing axis, and 1.
fn to_image(view: &View) -> DMat4 {
    let f = &view.frustum;
    let [left, right, bottom, top] = [f.left, f.right, f.bottom, f.top].map(f64::from);
    let (width, height) = (right - left, top - bottom);
    DMat4::from_cols(
        DVec4::new(2.0 / width, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 2.0 / height, 0.0, 0.0),
        DVec4::new((left + right) / width, (bottom + top) / height, -1.0, 0.0),
        DVec4::new(0.0, 0.0, 0.0, 1.0),
    )
}
