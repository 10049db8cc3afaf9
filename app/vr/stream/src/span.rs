//! The range of distances that a stream's 8 bits of depth cover.

/// The range of distances that the 8 bits of depth cover. It changes only at intra frames, since a change alters all
/// values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthSpan(Option<[f32; 2]>);

/// The factor by which the span extends beyond the visible surfaces at its near end. At its far end, where a step is
/// long, it is the square of this.
const SPAN_MARGIN: f32 = 1.25;
/// A span is renewed if the nearest surface is farther than when the span was chosen by more than this factor, since
/// steps are wasted then.
const RENEWAL_FACTOR: f32 = 3.0;

impl DepthSpan {
    /// Returns the span in metres for a frame that shows surfaces from `nearest` to `farthest` metres, and true if the
    /// span is new, so that the frame must be an intra frame. A frame without surfaces keeps the span.
    pub fn fit(&mut self, nearest: f32, farthest: f32) -> ([f32; 2], bool) {
        let [near, far] = self.0.unwrap_or([f32::INFINITY, 0.0]);
        let seen = nearest <= farthest;
        // Surfaces beyond the far end are shown at the far end. If that is far enough, their parallax is invisible.
        let fits = near <= nearest && nearest <= near * RENEWAL_FACTOR * SPAN_MARGIN && farthest <= far * 2.0;
        if self.0.is_some() && (fits || !seen) {
            return ([near, far], false);
        }
        let new = if seen {
            [nearest / SPAN_MARGIN, (farthest * SPAN_MARGIN * SPAN_MARGIN).max(nearest * 2.0)]
        } else {
            [1.0, 100.0]
        };
        self.0 = Some(new);
        (new, true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_span_changes_when_something_comes_near_or_all_goes_far() {
        let mut span = DepthSpan::default();
        let (first, new) = span.fit(1.0, 20.0);
        assert!(new && first[0] < 1.0 && first[1] > 20.0);
        for (nearest, farthest) in [(0.9, 20.0), (1.1, 25.0), (2.5, 3.0), (f32::INFINITY, 0.0)] {
            assert_eq!(span.fit(nearest, farthest), (first, false));
        }
        let (nearer, new) = span.fit(0.5, 20.0);
        assert!(new && nearer[0] < 0.5);
        assert!(span.fit(5.0, 20.0).1, "steps are not wasted on what is not there");
        assert!(span.fit(5.0, 90.0).1);
    }
}
