//! Turns touch and keys into the viewer's events.

use android_activity::input::{InputEvent, KeyAction, KeyEvent, Keycode, MotionAction, MotionEvent};
use android_activity::{AndroidApp, InputStatus};
use yoro_viewer::Event;

use crate::touch::Touch;

/// The user's input by touch screen, buttons and keys.
#[derive(Default)]
pub struct Input {
    touch: Touch,
    trigger: Touch,
    /// Events that have not been handled yet.
    pub events: Vec<Event>,
    /// The position of the finger that pressed last, in pixels from the upper left corner; `None` if it was a key.
    pub touched: Option<[f32; 2]>,
    /// True if Android has events to read.
    pub is_available: bool,
}

impl Input {
    /// Reads Android's events, if there are any, and appends the resulting events. Keys that the application does not
    /// use, such as the back key, are left to Android.
    pub fn collect(&mut self, app: &AndroidApp, dpi: f32) {
        if !std::mem::take(&mut self.is_available) {
            return;
        }
        let mut iterator = match app.input_events_iter() {
            Ok(iterator) => iterator,
            Err(error) => {
                log::warn!("touch and keys cannot be read: {error}");
                return;
            }
        };
        while iterator.next(|event| match event {
            InputEvent::MotionEvent(motion) => self.motion(motion, dpi),
            InputEvent::KeyEvent(key) => self.key(key),
            _ => InputStatus::Unhandled,
        }) {}
    }

    /// Appends a press that has become long. `now_ns` is on the clock of the events, which is the monotonic one.
    pub fn hold(&mut self, now_ns: i64) {
        self.events.extend(self.touch.held(now_ns).or_else(|| self.trigger.held(now_ns)));
    }

    /// Forgets presses in progress, since the window is gone.
    pub fn cancel(&mut self) {
        (self.touch, self.trigger) = (Touch::default(), Touch::default());
    }

    fn motion(&mut self, motion: &MotionEvent, dpi: f32) -> InputStatus {
        if !motion.source().is_pointer_class() || motion.pointer_count() == 0 {
            return InputStatus::Unhandled;
        }
        let pointer = motion.pointer_at_index(0);
        let position = [pointer.x(), pointer.y()];
        match motion.action() {
            MotionAction::Down => {
                self.touch.down(motion.event_time(), position);
                self.touched = Some(position);
                self.events.push(Event::Press);
            }
            MotionAction::Move => self.touch.moved(position, dpi),
            MotionAction::Up => {
                self.events.push(Event::Release);
                self.events.extend(self.touch.up(motion.event_time()));
            }
            MotionAction::PointerDown | MotionAction::Cancel => {
                self.events.push(Event::Release);
                self.touch.cancel();
            }
            _ => {}
        }
        InputStatus::Handled
    }

    fn key(&mut self, key: &KeyEvent) -> InputStatus {
        let is_down = key.action() == KeyAction::Down;
        match key.key_code() {
            Keycode::VolumeUp if is_down => self.events.push(Event::IpdUp),
            Keycode::VolumeDown if is_down => self.events.push(Event::IpdDown),
            Keycode::VolumeUp | Keycode::VolumeDown => {}
            // The buttons of headphones, game pads and keyboards.
            Keycode::Enter
            | Keycode::Space
            | Keycode::DpadCenter
            | Keycode::Headsethook
            | Keycode::MediaPlayPause
            | Keycode::ButtonA
            | Keycode::ButtonL1
            | Keycode::ButtonR1
            | Keycode::ButtonL2
            | Keycode::ButtonR2 => match key.action() {
                // Ignores repeats of a key that is held.
                KeyAction::Down if key.repeat_count() == 0 => {
                    self.trigger.down(key.event_time(), [0.0; 2]);
                    self.touched = None;
                    self.events.push(Event::Press);
                }
                KeyAction::Up => {
                    self.events.push(Event::Release);
                    self.events.extend(self.trigger.up(key.event_time()));
                }
                _ => {}
            },
            Keycode::H | Keycode::ButtonX if is_down => self.events.push(Event::ToggleHud),
            Keycode::N | Keycode::ButtonY if is_down => self.events.push(Event::NextViewpoint),
            Keycode::S if is_down => self.events.push(Event::NextScene),
            _ => return InputStatus::Unhandled,
        }
        InputStatus::Handled
    }
}
