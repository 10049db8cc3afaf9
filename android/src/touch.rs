//! Taps and long presses of a finger, or of a viewer's button that touches the screen.

use yoro_viewer::Event;

/// A press that lasts longer than this is a long press, in nanoseconds.
const LONG_NS: i64 = 600_000_000;
/// A finger that moves further than this many inches drags, which has no meaning here.
const SLOP_INCHES: f32 = 0.1;

/// A press in progress.
#[derive(Clone, Copy, Debug)]
struct Down {
    since_ns: i64,
    position: [f32; 2],
}

/// Recognises presses. All times are nanoseconds of one clock; positions are in pixels.
#[derive(Clone, Copy, Debug, Default)]
pub struct Touch {
    down: Option<Down>,
}

impl Touch {
    /// Records that the first finger, or a button, went down.
    pub fn down(&mut self, now_ns: i64, position: [f32; 2]) {
        self.down = Some(Down { since_ns: now_ns, position });
    }

    /// Records that the finger has moved; a drag is not a press. A `dpi` of 0 or less is unknown.
    pub fn moved(&mut self, position: [f32; 2], dpi: f32) {
        let slop = SLOP_INCHES * if dpi > 0.0 { dpi } else { 400.0 };
        let is_drag =
            |down: &Down| (down.position[0] - position[0]).hypot(down.position[1] - position[1]) > slop;
        if self.down.as_ref().is_some_and(is_drag) {
            self.down = None;
        }
    }

    /// Records that the finger went up, and returns the kind of press.
    pub fn up(&mut self, now_ns: i64) -> Option<Event> {
        let down = self.down.take()?;
        Some(if now_ns - down.since_ns >= LONG_NS { Event::LongPress } else { Event::Tap })
    }

    /// Forgets the press, because of a second finger or because the system has taken the touch over.
    pub fn cancel(&mut self) {
        self.down = None;
    }

    /// Returns a press that has become long: it counts as soon as it is long, not when it ends.
    pub fn held(&mut self, now_ns: i64) -> Option<Event> {
        let is_long = |down: &mut Down| now_ns - down.since_ns >= LONG_NS;
        self.down.take_if(is_long).map(|_| Event::LongPress)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;

    #[test]
    fn short_is_a_tap() {
        let mut press = Touch::default();
        press.down(0, [100.0, 100.0]);
        press.moved([105.0, 103.0], 400.0);
        assert_eq!(press.held(100 * MS), None);
        assert_eq!(press.up(150 * MS), Some(Event::Tap));
        assert_eq!(press.up(160 * MS), None);
    }

    #[test]
    fn long_counts_once_and_while_it_lasts() {
        let mut press = Touch::default();
        press.down(5 * MS, [0.0, 0.0]);
        assert_eq!(press.held(604 * MS), None);
        assert_eq!(press.held(606 * MS), Some(Event::LongPress));
        assert_eq!(press.held(900 * MS), None);
        assert_eq!(press.up(950 * MS), None);
        press.down(0, [0.0, 0.0]);
        assert_eq!(press.up(700 * MS), Some(Event::LongPress));
    }

    #[test]
    fn drags_and_second_fingers_are_nothing() {
        let mut press = Touch::default();
        press.down(0, [100.0, 100.0]);
        press.moved([141.0, 100.0], 400.0);
        assert_eq!(press.up(50 * MS), None);
        press.down(0, [100.0, 100.0]);
        press.cancel();
        assert_eq!((press.held(900 * MS), press.up(950 * MS)), (None, None));
        // A device that does not report its density.
        press.down(0, [0.0, 0.0]);
        press.moved([20.0, 0.0], 0.0);
        assert_eq!(press.up(50 * MS), Some(Event::Tap));
    }
}
