//! AChoreographer: callbacks on the thread's looper at the display's refreshes.

#![allow(non_snake_case)]

use std::ffi::c_void;

use crate::android::looper::{self, ALooper};
use crate::exports::{Export, System, exports};
use crate::host::{fatal, host, lock};

type FrameCallback = unsafe extern "C" fn(nanoseconds: i64, data: *mut c_void);
type VsyncCallback = unsafe extern "C" fn(frame: *const FrameData, data: *mut c_void);

/// A callback that waits for a refresh.
#[derive(Clone, Copy)]
pub struct Pending {
    due: u64,
    callback: Kind,
    data: *mut c_void,
}

// SAFETY: `data` belongs to the application, and is only passed back to it on the looper's own thread.
unsafe impl Send for Pending {}

#[derive(Clone, Copy)]
enum Kind {
    Frame(FrameCallback),
    Vsync(VsyncCallback),
}

/// `AChoreographerFrameCallbackData`: a single timeline. A frame is shown after the script's number of refreshes.
pub struct FrameData {
    time: u64,
    period: u64,
}

/// Calls the callbacks that are due at `now`. Returns true if there were any.
pub fn run(looper: &ALooper, now: u64) -> bool {
    let due: Vec<_> = {
        let mut pending = lock(&looper.choreographer);
        let due = pending.iter().filter(|callback| callback.due <= now).copied().collect();
        pending.retain(|callback| callback.due > now);
        due
    };
    for callback in &due {
        let period = host().clock.period;
        // SAFETY: the application's functions get the data that it passed with them, on the thread that posted them.
        unsafe {
            match callback.callback {
                Kind::Frame(function) => function(callback.due as i64, callback.data),
                Kind::Vsync(function) => function(&FrameData { time: callback.due, period }, callback.data),
            }
        }
    }
    !due.is_empty()
}

/// Returns when the next callback is due.
pub fn next(looper: &ALooper) -> Option<u64> {
    lock(&looper.choreographer).iter().map(|callback| callback.due).min()
}

fn post(choreographer: *mut ALooper, callback: Kind, data: *mut c_void) {
    let clock = &host().clock;
    let due = clock.next_refresh(clock.now());
    // SAFETY: a choreographer is its thread's looper, which lives as long as the thread.
    lock(&unsafe { &*choreographer }.choreographer).push(Pending { due, callback, data });
}

/// Returns the functions of this module that libandroid.so exports.
pub fn exports() -> Vec<Export> {
    exports![
        System::Android, 24: [AChoreographer_getInstance];
        System::Android, 29: [AChoreographer_postFrameCallback64];
        System::Android, 33: [
            AChoreographer_postVsyncCallback, AChoreographerFrameCallbackData_getFrameTimeNanos,
            AChoreographerFrameCallbackData_getPreferredFrameTimelineIndex,
            AChoreographerFrameCallbackData_getFrameTimelineExpectedPresentationTimeNanos,
            AChoreographerFrameCallbackData_getFrameTimelineDeadlineNanos,
        ];
    ]
}

extern "C" fn AChoreographer_getInstance() -> *const ALooper {
    match looper::current() {
        Some(looper) => looper,
        None => fatal("AChoreographer_getInstance on a thread without a looper"),
    }
}

extern "C" fn AChoreographer_postFrameCallback64(
    choreographer: *mut ALooper,
    callback: FrameCallback,
    data: *mut c_void,
) {
    post(choreographer, Kind::Frame(callback), data);
}

extern "C" fn AChoreographer_postVsyncCallback(
    choreographer: *mut ALooper,
    callback: VsyncCallback,
    data: *mut c_void,
) {
    post(choreographer, Kind::Vsync(callback), data);
}

extern "C" fn AChoreographerFrameCallbackData_getFrameTimeNanos(data: &FrameData) -> i64 {
    data.time as i64
}

extern "C" fn AChoreographerFrameCallbackData_getPreferredFrameTimelineIndex(_data: &FrameData) -> usize {
    0
}

extern "C" fn AChoreographerFrameCallbackData_getFrameTimelineExpectedPresentationTimeNanos(
    data: &FrameData,
    _index: usize,
) -> i64 {
    (data.time + u64::from(host().device.refreshes_ahead) * data.period) as i64
}

extern "C" fn AChoreographerFrameCallbackData_getFrameTimelineDeadlineNanos(
    data: &FrameData,
    _index: usize,
) -> i64 {
    (data.time + data.period) as i64
}
