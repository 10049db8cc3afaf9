//! AInputQueue and the events in it.

#![allow(non_snake_case)]

use std::collections::VecDeque;
use std::ffi::{c_int, c_void};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, OnceLock};

use crate::android::looper::{ALooper, Callback};
use crate::exports::{Export, System, exports};
use crate::fd::EventFd;
use crate::host::{host, lock};

/// Numbers of events for the summary.
#[derive(Default)]
pub struct InputCounts {
    /// Sent to the application.
    pub sent: AtomicU64,
    /// Finished by the application.
    pub finished: AtomicU64,
    /// Finished as handled.
    pub handled: AtomicU64,
}

/// A touch or a key. `repr(C)` is not needed, since the application only passes it back.
#[derive(Clone, Debug)]
pub enum AInputEvent {
    /// One finger on the touch screen.
    Motion {
        /// `AMOTION_EVENT_ACTION_*`.
        action: MotionAction,
        /// Pixels from the left edge.
        x: f32,
        /// Pixels from the top edge.
        y: f32,
        /// Time in nanoseconds.
        time: u64,
    },
    /// A button.
    Key {
        /// True if the key is pressed, false if it is released.
        down: bool,
        /// `AKEYCODE_*`.
        code: c_int,
        /// Time in nanoseconds.
        time: u64,
    },
}

/// What a finger does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionAction {
    /// `AMOTION_EVENT_ACTION_DOWN`.
    Down = 0,
    /// `AMOTION_EVENT_ACTION_UP`.
    Up = 1,
}

/// A queue that the system passes to the activity.
pub struct AInputQueue {
    event: EventFd,
    state: Mutex<QueueState>,
}

#[derive(Default)]
struct QueueState {
    events: VecDeque<AInputEvent>,
    looper: Option<&'static ALooper>,
}

impl AInputQueue {
    /// Empties and returns the only queue of the process. One is enough, since activities follow one another. It is
    /// never freed, since an application may keep the pointer slightly too long.
    pub fn fresh() -> &'static Self {
        static QUEUE: OnceLock<AInputQueue> = OnceLock::new();
        let queue = QUEUE.get_or_init(|| Self { event: EventFd::new(), state: Mutex::default() });
        lock(&queue.state).events.clear();
        queue.event.clear();
        queue
    }

    /// Sends an event.
    pub fn push(&self, event: AInputEvent) {
        host().input.sent.fetch_add(1, Ordering::Relaxed);
        lock(&self.state).events.push_back(event);
        self.event.signal();
    }

    /// True if the queue is still attached to a looper, which must not be the case when it is destroyed.
    pub fn is_attached(&self) -> bool {
        lock(&self.state).looper.is_some()
    }
}

/// Returns the functions of this module that libandroid.so exports.
pub fn exports() -> Vec<Export> {
    exports![
        System::Android, 1: [
            AInputQueue_attachLooper, AInputQueue_detachLooper, AInputQueue_finishEvent, AInputQueue_getEvent,
            AInputQueue_preDispatchEvent, AInputEvent_getSource, AInputEvent_getType, AKeyEvent_getAction,
            AKeyEvent_getEventTime, AKeyEvent_getKeyCode, AKeyEvent_getRepeatCount, AMotionEvent_getAction,
            AMotionEvent_getAxisValue, AMotionEvent_getEventTime, AMotionEvent_getPointerCount,
        ];
    ]
}

extern "C" fn AInputQueue_attachLooper(
    queue: &AInputQueue,
    looper: &'static ALooper,
    ident: c_int,
    callback: Option<Callback>,
    data: *mut c_void,
) {
    lock(&queue.state).looper = Some(looper);
    looper.add(queue.event.raw(), ident, 1, callback, data);
}

extern "C" fn AInputQueue_detachLooper(queue: &AInputQueue) {
    if let Some(looper) = lock(&queue.state).looper.take() {
        looper.remove(queue.event.raw());
    }
}

unsafe extern "C" fn AInputQueue_getEvent(queue: &AInputQueue, out: *mut *mut AInputEvent) -> i32 {
    let mut state = lock(&queue.state);
    let Some(event) = state.events.pop_front() else {
        queue.event.clear();
        return -libc::EAGAIN;
    };
    if state.events.is_empty() {
        queue.event.clear();
    }
    // SAFETY: the caller gives room for one pointer.
    unsafe { out.write(Box::into_raw(Box::new(event))) };
    host().count("input events", 1);
    0
}

extern "C" fn AInputQueue_preDispatchEvent(_queue: &AInputQueue, _event: &AInputEvent) -> bool {
    false
}

unsafe extern "C" fn AInputQueue_finishEvent(_queue: &AInputQueue, event: *mut AInputEvent, handled: c_int) {
    let host = host();
    host.input.finished.fetch_add(1, Ordering::Relaxed);
    host.input.handled.fetch_add(u64::from(handled != 0), Ordering::Relaxed);
    host.count("input events", -1);
    // SAFETY: made by getEvent and finished once by contract.
    drop(unsafe { Box::from_raw(event) });
}

/// Returns `AINPUT_EVENT_TYPE_KEY` (1) or `AINPUT_EVENT_TYPE_MOTION` (2).
extern "C" fn AInputEvent_getType(event: &AInputEvent) -> i32 {
    match event {
        AInputEvent::Key { .. } => 1,
        AInputEvent::Motion { .. } => 2,
    }
}

/// Returns `AINPUT_SOURCE_KEYBOARD` or `AINPUT_SOURCE_TOUCHSCREEN`.
extern "C" fn AInputEvent_getSource(event: &AInputEvent) -> i32 {
    match event {
        AInputEvent::Key { .. } => 0x101,
        AInputEvent::Motion { .. } => 0x1002,
    }
}

/// Defines getters for one kind of event. Calling one for the other kind is a violation and returns zero.
macro_rules! getters {
    ($($name:ident: $pattern:pat => $value:expr, $type:ty;)*) => {
        $(extern "C" fn $name(event: &AInputEvent) -> $type {
            #[allow(unreachable_patterns)]
            match event {
                $pattern => $value,
                _ => {
                    host().violation(concat!(stringify!($name), " of an event of another kind"));
                    <$type>::default()
                }
            }
        })*
    };
}

getters! {
    AKeyEvent_getAction: AInputEvent::Key { down, .. } => i32::from(!*down), i32;
    AKeyEvent_getKeyCode: AInputEvent::Key { code, .. } => *code, i32;
    AKeyEvent_getEventTime: AInputEvent::Key { time, .. } => *time as i64, i64;
    AKeyEvent_getRepeatCount: AInputEvent::Key { .. } => 0, i32;
    AMotionEvent_getAction: AInputEvent::Motion { action, .. } => *action as i32, i32;
    AMotionEvent_getEventTime: AInputEvent::Motion { time, .. } => *time as i64, i64;
    AMotionEvent_getPointerCount: AInputEvent::Motion { .. } => 1, usize;
}

/// Returns the value of an axis: `AMOTION_EVENT_AXIS_X` (0), `_Y` (1) or `_PRESSURE` (2), the only ones that a finger
/// has. An index other than 0 is a violation and returns zero.
extern "C" fn AMotionEvent_getAxisValue(event: &AInputEvent, axis: i32, index: usize) -> f32 {
    match (event, axis) {
        (AInputEvent::Motion { x, .. }, 0) if index == 0 => *x,
        (AInputEvent::Motion { y, .. }, 1) if index == 0 => *y,
        (AInputEvent::Motion { .. }, 2) if index == 0 => 1.0,
        (AInputEvent::Motion { .. }, _) if index == 0 => 0.0,
        _ => {
            host().violation("AMotionEvent_getAxisValue of a pointer that the event does not have");
            0.0
        }
    }
}
