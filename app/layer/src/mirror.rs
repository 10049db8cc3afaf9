//! The eyes of a flipped image: it shows what a plain image of the mirrored world would show.

use yoro::eyes::{EyePair, Frustum, Pose};

use crate::geometry::{GeometryError, Split, Submitted, split as split_plain};

/// The axes along which the world is mirrored.
#[derive(Clone, Copy)]
struct Mirror {
    x: bool,
    y: bool,
}

/// Splits a submitted view as [`geometry::split`](crate::geometry::split) does, also if its field of view flips it:
/// with its left edge to the right of its right one, or its lower edge above its upper one. The results' fields of view
/// flip theirs. `upside_down` is true if the rows of the image are in the opposite order besides.
///
/// # Errors
/// Those of [`geometry::split`](crate::geometry::split).
pub fn split(eyes: &EyePair, submitted: &Submitted, upside_down: bool) -> Result<Split, GeometryError> {
    // From the image's first row to its last one.
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

/// Returns the other eye's place beside the dominant one's.
fn between(eyes: &EyePair) -> glam::Vec3 {
    let [own, other] = [eyes.dominant, eyes.dominant.other()].map(|eye| eyes.poses[eye.index()]);
    own.orientation.inverse() * (other.position - own.position)
}

impl Mirror {
    /// Mirrors each edge, which makes a flipped field of view a plain one, and the other way round.
    fn edges(self, frustum: Frustum) -> Frustum {
        let [x, y] = [self.x, self.y].map(|mirrored| if mirrored { -1.0 } else { 1.0 });
        Frustum {
            left: x * frustum.left,
            right: x * frustum.right,
            bottom: y * frustum.bottom,
            top: y * frustum.top,
        }
    }

    /// Returns the eyes of the mirrored world: to the sides, the left one is the right one there.
    fn eyes(self, eyes: &EyePair) -> EyePair {
        let frusta = eyes.frusta.map(|frustum| {
            let Frustum { left, right, bottom, top } = self.edges(frustum);
            // A plain field of view again.
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
