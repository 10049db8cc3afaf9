//! Requests steady performance from a phone: a constant refresh rate, clock rates that can be sustained, and hints
//! about frame durations. Each is requested only if Android and the device offer it.

use std::ffi::c_void;
use std::fmt;
use std::ptr::NonNull;
use std::time::Duration;

use ndk::native_window::NativeWindow;
use yoro_settings::{Performance as Level, Settings};

use crate::platform::java::Java;
use crate::platform::system::Library;
use crate::platform::system::thread_id;

/// `ANATIVEWINDOW_FRAME_RATE_COMPATIBILITY_DEFAULT`: the frames are suitable for any rate.
const ANY_RATE: i8 = 0;

type SetFrameRate = unsafe extern "C" fn(*mut ndk_sys::ANativeWindow, f32, i8) -> i32;

/// The requests made so far.
pub struct Performance {
    android: Library,
    /// The display's rate in Hz when it was first known. It is kept unless the settings name another.
    first_hz: Option<f32>,
    /// The rate in Hz that was requested with the present window.
    rate_hz: Option<f32>,
    /// The request for sustained performance mode: whether it is on, and whether the device has the mode.
    sustained: Option<(bool, bool)>,
    hints: Option<Hints>,
}

impl Performance {
    /// Creates a value that has requested nothing yet.
    pub fn new() -> Performance {
        Performance {
            android: Library::android(),
            first_hz: None,
            rate_hz: None,
            sustained: None,
            hints: None,
        }
    }

    /// Forgets the request that was made with the previous window.
    pub fn forget_window(&mut self) {
        self.rate_hz = None;
    }

    /// Requests the settings' performance unless that has been done already, and logs the outcome in one line.
    /// `refresh_hz` is the display's present rate, 0 if unknown.
    pub fn ask(&mut self, settings: &Settings, window: &NativeWindow, refresh_hz: f32, java: &Java) {
        let known = Some(refresh_hz).filter(|hz| *hz > 0.0);
        self.first_hz = self.first_hz.or(known);
        let rate_hz = settings.refresh_rate.or(self.first_hz);
        let is_sustained = matches!(settings.performance, Level::SustainedLow | Level::SustainedHigh);
        let is_rate_new = rate_hz.is_some() && rate_hz != self.rate_hz;
        let is_level_new = self.sustained.is_none_or(|(asked, _)| asked != is_sustained);
        if !is_rate_new && !is_level_new {
            return;
        }
        if let Some(hz) = rate_hz.filter(|_| is_rate_new) {
            self.rate_hz = rate_hz;
            self.set_frame_rate(window, hz);
            self.hints = Hints::new(&self.android, Duration::from_secs_f32(1.0 / hz));
        }
        if is_level_new {
            self.sustained = Some((is_sustained, java.sustain_performance(is_sustained)));
        }
        log::info!("performance: {self}");
    }

    fn set_frame_rate(&self, window: &NativeWindow, hz: f32) {
        // SAFETY: the type is that of <android/native_window.h>; the function exists from API 30 on.
        let Some(set) = (unsafe { self.android.function::<SetFrameRate>(c"ANativeWindow_setFrameRate") })
        else {
            return;
        };
        // SAFETY: the borrowed window is live.
        let status = unsafe { set(window.ptr().as_ptr(), hz, ANY_RATE) };
        if status != 0 {
            log::warn!("Android does not take a refresh rate of {hz} Hz (status {status})");
        }
    }

    /// Returns the modes in effect by name, for the [`DeviceState`](yoro_settings::telemetry::DeviceState).
    pub fn name(&self) -> &'static str {
        match (self.sustained == Some((true, true)), self.hints.is_some()) {
            (true, true) => "sustained/hints",
            (true, false) => "sustained",
            (false, true) => "hints",
            (false, false) => "none",
        }
    }

    /// Reports this thread's working time on a frame.
    pub fn worked(&self, time: Duration) {
        if let Some(hints) = &self.hints {
            hints.worked(time);
        }
    }
}

/// A line for the log.
impl fmt::Display for Performance {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.rate_hz {
            Some(hz) => write!(f, "{hz:.0} Hz asked for")?,
            None => write!(f, "no refresh rate asked for")?,
        }
        f.write_str(match self.sustained {
            Some((true, true)) => ", sustained performance mode",
            Some((true, false)) => ", this device has no sustained performance mode",
            _ => ", no sustained performance mode",
        })?;
        f.write_str(if self.hints.is_some() { ", performance hints" } else { ", no performance hints" })
    }
}

/// Opaque `APerformanceHintManager` and `APerformanceHintSession`.
type Manager = c_void;
type Session = c_void;
type GetManager = unsafe extern "C" fn() -> *mut Manager;
type CreateSession = unsafe extern "C" fn(*mut Manager, *const i32, usize, i64) -> *mut Session;
type Report = unsafe extern "C" fn(*mut Session, i64) -> i32;
type Close = unsafe extern "C" fn(*mut Session);

/// Reports this thread's working time per frame, and its target, to the scheduler, from API 33 on
/// (<https://developer.android.com/games/optimize/adpf>).
struct Hints {
    session: NonNull<Session>,
    report: Report,
    close: Close,
}

impl Hints {
    /// Starts a session for this thread, whose frames may take `period`; `None` if this device takes no hints.
    fn new(android: &Library, period: Duration) -> Option<Hints> {
        // SAFETY: the types are those of <android/performance_hint.h>; a manager that is not null lives as long as the
        // process, and the list of threads outlives the call.
        unsafe {
            let manager: GetManager = android.function(c"APerformanceHint_getManager")?;
            let create: CreateSession = android.function(c"APerformanceHint_createSession")?;
            let report = android.function(c"APerformanceHint_reportActualWorkDuration")?;
            let close = android.function(c"APerformanceHint_closeSession")?;
            let (manager, threads) = (NonNull::new(manager())?, [thread_id()]);
            let session = create(manager.as_ptr(), threads.as_ptr(), threads.len(), period.as_nanos() as i64);
            Some(Hints { session: NonNull::new(session)?, report, close })
        }
    }

    fn worked(&self, time: Duration) {
        // SAFETY: the session is live. The number must be positive. A hint that is refused has no effect.
        let _ = unsafe { (self.report)(self.session.as_ptr(), time.as_nanos().max(1) as i64) };
    }
}

impl Drop for Hints {
    fn drop(&mut self) {
        // SAFETY: the session was created once and is closed only once.
        unsafe { (self.close)(self.session.as_ptr()) }
    }
}
