//! The eyes of flipped images. A flipped image is treated as an unflipped image of the mirrored world.

use yoro::eyes::{EyePair, Frustum, Pose};

use crate::geometry::{GeometryError, Split, Submitted, split as split_plain};

/// The axes along which the world is mirrored.
#[derive(Clone, Copy)]
struct Mirror {
    x: bool,
    y: bool,
}

/// Splits a submitted view like [`geometry::split`](crate::geometry::split), but also accepts flipped fields of view,
/// whose left edge is to the right of their right edge, or whose lower edge is above their upper edge. The resulting
/// fields of view are flipped in the same way. `upside_down` is true if the rows of the image are also in the opposite
/// order.
///
/// # Errors
/// Those of [`geometry::split`](crate::geometry::split).
pub fn split(eyes: &EyePair, submitted: &Submitted, upside_down: bool) -> Result<Split, GeometryError> {
    // Orders the edges from the image's first row to its last.
    let in_rows = |frustum: Frustum| match upside_down {
        true => Frustum { bottom: frustum.top, top: frustum.bottom, ..frustum },
        false => frustum,
    };
    let whole = in_rows(submitted.frustum);
    let mirror = Mirror { x: whole.left > whole.right, y: whole.bottom > whole.top };
    if !(mirror.x || mirror.y || upside_down) {
        return split_plain(eyes, submitted);
    }
    let plain = split_plain(&mirror.eyes(eyes), &Submitted { frustum: mirror.edges(whole), ..*submitted })?;
    let (own, other) = (eyes.dominant, eyes.dominant.other());
    let mut split = plain;
    for eye in [own, other] {
        let mirrored = if mirror.x { eye.other() } else { eye };
        split.frusta[eye.index()] = in_rows(mirror.edges(plain.frusta[mirrored.index()]));
    }
    split.poses[own.index()] = submitted.pose;
    split.poses[other.index()] = submitted.pose.translated_local(between(eyes));
    Ok(split)
}

/// Returns the position of the other eye relative to the dominant one.
fn between(eyes: &EyePair) -> glam::Vec3 {
    let [own, other] = [eyes.dominant, eyes.dominant.other()].map(|eye| eyes.poses[eye.index()]);
    own.orientation.inverse() * (other.position - own.position)
}

impl Mirror {
    /// Mirrors each edge. This turns a flipped field of view into an unflipped one, and vice versa.
    fn edges(self, frustum: Frustum) -> Frustum {
        let [x, y] = [self.x, self.y].map(|mirrored| if mirrored { -1.0 } else { 1.0 });
        Frustum {
            left: x * frustum.left,
            right: x * frustum.right,
            bottom: y * frustum.bottom,
            top: y * frustum.top,
        }
    }

    /// Returns the eyes of the mirrored world. If it is mirrored sideways, the left eye is the right one there.
    fn eyes(self, eyes: &EyePair) -> EyePair {
        let frusta = eyes.frusta.map(|frustum| {
            let Frustum { left, right, bottom, top } = self.edges(frustum);
            // Turns the field of view into an unflipped one again.
            let [left, right] = if self.x { [right, left] } else { [left, right] };
            let [bottom, top] = if self.y { [top, bottom] } else { [bottom, top] };
            Frustum { left, right, bottom, top }
        });
        let (mut dominant, mut frusta) = (eyes.dominant, frusta);
        if self.x {
            dominant = dominant.other();
            frusta.reverse();
        }
        let mut poses = [Pose { position: glam::Vec3::ZERO, orientation: glam::Quat::IDENTITY }; 2];
        let signs = [self.x, self.y].map(|mirrored| if mirrored { -1.0 } else { 1.0 });
        poses[dominant.other().index()].position = between(eyes) * glam::Vec3::new(signs[0], signs[1], 1.0);
        EyePair { poses, frusta, dominant, ..*eyes }
    }
}
