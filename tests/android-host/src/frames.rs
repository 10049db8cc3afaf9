//! The gate in `eglSwapBuffers`. The script decides how many frames pass, so that events between two frames happen at
//! the same point in every run.

use std::sync::{Condvar, Mutex, MutexGuard};
use std::time::{Duration, Instant};

use image::RgbaImage;

use crate::android::looper;
use crate::fd::EventFd;
use crate::host::host;

/// The real time that a frame waits at the open gate.
const OPEN_FRAME: Duration = Duration::from_millis(3);

/// State of the gate.
pub struct Frames {
    state: Mutex<State>,
    changed: Condvar,
    /// Readable after each change. The main thread waits for it in its looper.
    pub event: EventFd,
}

#[derive(Default)]
struct State {
    open: bool,
    wanted: bool,
    granted: u64,
    waiting: bool,
    shown: u64,
    /// The time at which the previous frame is on the display.
    displayed: u64,
    capture: bool,
    captured: Option<Result<RgbaImage, String>>,
}

impl Frames {
    /// Creates a closed gate.
    pub fn new() -> Self {
        Self { state: Mutex::new(State::default()), changed: Condvar::new(), event: EventFd::new() }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    fn notify(&self) {
        self.changed.notify_all();
        self.event.signal();
    }

    /// Waits until the frame may be shown. Called by the thread that swaps. `read` returns the frame's picture.
    pub fn present(&self, mut read: impl FnMut() -> Result<RgbaImage, String>) {
        let mut state = self.state();
        state.waiting = true;
        self.notify();
        let arrived = Instant::now();
        while state.granted == 0 {
            if state.open {
                // Most callbacks that open the gate end soon. One that does not waits for this frame, so let it pass.
                let left = OPEN_FRAME.saturating_sub(arrived.elapsed());
                if left.is_zero() {
                    break;
                }
                state =
                    self.changed.wait_timeout(state, left).unwrap_or_else(|poisoned| poisoned.into_inner()).0;
                continue;
            }
            if std::mem::take(&mut state.capture) {
                state.captured = Some(read());
                self.notify();
                continue;
            }
            state = self.changed.wait(state).unwrap_or_else(|poisoned| poisoned.into_inner());
        }
        state.granted = state.granted.saturating_sub(1);
        state.waiting = false;
        state.shown += 1;
        // Double buffering: this frame can be submitted once the previous one is on the display.
        let clock = &host().clock;
        clock.advance_to(state.displayed);
        state.displayed = clock.next_refresh(clock.now());
        drop(state);
        looper::settle();
        self.notify();
    }

    /// Lets time pass until a frame waits at the gate, or stops that.
    pub fn set_wanted(&self, wanted: bool) {
        self.state().wanted = wanted;
    }

    /// Opens or closes the gate. It is open during callbacks that the application may answer from its frame loop.
    pub fn set_open(&self, open: bool) {
        self.state().open = open;
        self.notify();
    }

    /// Lets this many more frames pass.
    pub fn grant(&self, frames: u64) {
        self.state().granted += frames;
        self.notify();
    }

    /// True if all granted frames have passed and another one waits at the gate.
    pub fn is_waiting(&self) -> bool {
        let state = self.state();
        state.waiting && state.granted == 0
    }

    /// True if virtual time may pass without a frame, because the script waits for something.
    pub fn time_may_pass(&self) -> bool {
        let state = self.state();
        state.open || state.granted > 0 || state.wanted && !state.waiting
    }

    /// Returns the number of frames shown since the start.
    pub fn shown(&self) -> u64 {
        self.state().shown
    }

    /// Requests the picture of the waiting frame, which [`Frames::captured`] then returns.
    pub fn request_capture(&self) {
        let mut state = self.state();
        state.captured = None;
        state.capture = true;
        drop(state);
        self.notify();
    }

    /// Returns the requested picture once it is available.
    pub fn captured(&self) -> Option<Result<RgbaImage, String>> {
        self.state().captured.take()
    }
}
