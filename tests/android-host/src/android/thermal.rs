//! AThermal and APerformanceHint, which applications look up with `dlsym`.

#![allow(non_snake_case)]

use std::ffi::{c_int, c_void};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::exports::{Export, System, exports};
use crate::host::{host, lock};

/// The time of the last query of the headroom in nanoseconds. Android only answers again after a second.
static LAST_HEADROOM: AtomicU64 = AtomicU64::new(0);

/// Returns the functions of this module that libandroid.so exports.
pub fn exports() -> Vec<Export> {
    exports![
        System::Android, 30: [
            AThermal_acquireManager, AThermal_getCurrentThermalStatus, AThermal_releaseManager,
        ];
        System::Android, 31: [AThermal_getThermalHeadroom];
        System::Android, 33: [
            APerformanceHint_closeSession, APerformanceHint_createSession, APerformanceHint_getManager,
            APerformanceHint_reportActualWorkDuration,
        ];
    ]
}

extern "C" fn AThermal_acquireManager() -> *mut c_void {
    host().count("thermal managers", 1);
    std::ptr::dangling_mut()
}

extern "C" fn AThermal_releaseManager(_manager: *mut c_void) {
    host().count("thermal managers", -1);
}

extern "C" fn AThermal_getCurrentThermalStatus(_manager: *mut c_void) -> c_int {
    lock(&host().thermal).status
}

/// Returns the thermal headroom, or NaN if it was queried within the last second, as on Android.
extern "C" fn AThermal_getThermalHeadroom(_manager: *mut c_void, _forecast_seconds: c_int) -> f32 {
    let now = host().clock.now();
    let last = LAST_HEADROOM.load(Ordering::Relaxed);
    if last != 0 && now.saturating_sub(last) < 1_000_000_000 {
        return f32::NAN;
    }
    LAST_HEADROOM.store(now, Ordering::Relaxed);
    lock(&host().thermal).headroom
}

extern "C" fn APerformanceHint_getManager() -> *mut c_void {
    std::ptr::dangling_mut()
}

extern "C" fn APerformanceHint_createSession(
    _manager: *mut c_void,
    threads: *const i32,
    count: usize,
    target: i64,
) -> *mut c_void {
    if threads.is_null() || count == 0 || target <= 0 {
        return std::ptr::null_mut();
    }
    host().count("performance hint sessions", 1);
    host().request(format!("hints for {count} thread, {:.1} ms", target as f64 * 1e-6));
    std::ptr::dangling_mut()
}

extern "C" fn APerformanceHint_closeSession(_session: *mut c_void) {
    host().count("performance hint sessions", -1);
}

extern "C" fn APerformanceHint_reportActualWorkDuration(_session: *mut c_void, nanoseconds: i64) -> c_int {
    host().request("work duration");
    if nanoseconds > 0 { 0 } else { libc::EINVAL }
}
