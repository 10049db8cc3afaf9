//! Samples of the motion sensors and the display's refreshes, which arrive independently of the main loop.
//!
//! Both arrive through a looper. The looper of `android_main` belongs to android-activity, which treats other sources
//! as errors, and a choreographer lives as long as its thread. So one thread serves all activities of the process; it
//! sleeps while none is in the foreground.

use std::cell::Cell;
use std::ffi::c_void;
use std::ptr::{self, NonNull};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread;

use android_activity::AndroidAppWaker;
use ndk::looper::{ForeignLooper, ThreadLooper};
use ndk_sys as ffi;
use yoro_lenses::MotionSample;

use super::sensors::Sensors;
use crate::frame_timing::{self, Refresh, Timeline};
use crate::platform::system::Library;
use crate::platform::system::{now_ns, slept_ns};

/// The most samples that are kept if the main loop takes none: more than a tenth of a second. Older ones are dropped.
const MAX_SAMPLES: usize = 256;

static MOTION_THREAD: OnceLock<Option<MotionThread>> = OnceLock::new();

/// The thread and its looper.
pub struct MotionThread {
    shared: Arc<Shared>,
    looper: ForeignLooper,
}

/// State shared by the thread and the main loop.
#[derive(Default)]
struct Shared {
    /// True while sensors and refreshes are wanted.
    is_on: AtomicBool,
    /// The newest refresh that the main loop has not taken.
    refresh: Mutex<Option<Refresh>>,
    /// True once a refresh has arrived.
    has_refreshes: AtomicBool,
    samples: Mutex<Vec<(MotionSample, i64)>>,
    waker: Mutex<Option<AndroidAppWaker>>,
}

impl MotionThread {
    /// Returns the process's thread, which the first call starts; `None` if no thread can be started.
    pub fn get() -> Option<&'static MotionThread> {
        MOTION_THREAD.get_or_init(MotionThread::start).as_ref()
    }

    fn start() -> Option<MotionThread> {
        let shared = Arc::new(Shared::default());
        let (sender, receiver) = mpsc::channel();
        let of_thread = shared.clone();
        let work = move || {
            let looper = ThreadLooper::prepare();
            let ptr = looper.as_foreign().ptr();
            if sender.send(looper.into_foreign()).is_ok() {
                run(&of_thread, ptr);
            }
        };
        if let Err(error) = thread::Builder::new().name("yoro-motion".into()).spawn(work) {
            log::error!("no thread for the sensors ({error}): the picture does not follow the head");
            return None;
        }
        Some(MotionThread { shared, looper: receiver.recv().ok()? })
    }

    /// Starts sensors and refreshes for a main loop, which is woken at each refresh.
    pub fn resume(&self, waker: AndroidAppWaker) {
        lock(&self.shared.samples).clear();
        *lock(&self.shared.waker) = Some(waker);
        *lock(&self.shared.refresh) = None;
        self.shared.is_on.store(true, Ordering::Release);
        self.looper.wake();
    }

    /// Stops sensors and refreshes, so that they do not use the battery.
    pub fn pause(&self) {
        self.shared.is_on.store(false, Ordering::Release);
        *lock(&self.shared.waker) = None;
        self.looper.wake();
    }

    /// True if this device reports refreshes.
    pub fn has_refreshes(&self) -> bool {
        self.shared.has_refreshes.load(Ordering::Acquire)
    }

    /// Returns the newest refresh since the last call.
    pub fn take_refresh(&self) -> Option<Refresh> {
        lock(&self.shared.refresh).take()
    }

    /// Calls `take` with the samples since the last call, oldest first, and their times in nanoseconds on the monotonic
    /// clock. `buffer` is memory for reuse.
    pub fn drain(&self, buffer: &mut Vec<(MotionSample, i64)>, mut take: impl FnMut(MotionSample, i64)) {
        buffer.clear();
        std::mem::swap(&mut *lock(&self.shared.samples), buffer);
        buffer.drain(..).for_each(|(sample, time)| take(sample, time));
    }
}

/// Locks a mutex; the data of a thread that has panicked are still valid.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn run(shared: &Shared, looper: NonNull<ffi::ALooper>) {
    let refresh_loop =
        RefreshLoop { shared, choreographer: Choreographer::of_thread(), is_posted: Cell::new(false) };
    match &refresh_loop.choreographer {
        None => log::info!("this device has no choreographer: eglSwapBuffers sets the pace"),
        Some(Choreographer { post: Post::Frame(_), .. }) => {
            log::info!(
                "this Android does not say when a frame is seen: at the second refresh after it begins"
            )
        }
        Some(Choreographer { post: Post::Vsync(_), .. }) => log::info!("Android says when a frame is seen"),
    }
    let (mut sensors, mut was_on, mut slept) = (None, false, 0);
    loop {
        let is_on = shared.is_on.load(Ordering::Acquire);
        if is_on != was_on {
            was_on = is_on;
            sensors = if is_on { Sensors::start(looper) } else { None };
            if is_on {
                // The device does not sleep while the activity is in the foreground.
                slept = slept_ns();
                refresh_loop.post();
            }
        }
        // SAFETY: the looper belongs to this thread, and null pointers ask for no results besides the return value.
        let result = unsafe { ffi::ALooper_pollOnce(-1, ptr::null_mut(), ptr::null_mut(), ptr::null_mut()) };
        if result == ffi::ALOOPER_POLL_ERROR {
            log::error!("the sensors' looper has failed: the picture no longer follows the head");
            return;
        }
        if let Some(sensors) = &mut sensors {
            let mut samples = lock(&shared.samples);
            let now = now_ns();
            sensors.drain(|sample, time| {
                let time = frame_timing::sample_time_ns(time, now, slept);
                if samples.len() == MAX_SAMPLES {
                    samples.remove(0);
                }
                samples.push((sample, time));
            });
        }
    }
}

/// Opaque `AChoreographerFrameCallbackData`.
#[repr(C)]
struct FrameData {
    _private: [u8; 0],
}

type FrameCallback = unsafe extern "C" fn(frame_time_ns: i64, data: *mut c_void);
type VsyncCallback = unsafe extern "C" fn(frame: *const FrameData, data: *mut c_void);
type GetInstance = unsafe extern "C" fn() -> *mut ffi::AChoreographer;
type PostFrameCallback = unsafe extern "C" fn(*mut ffi::AChoreographer, FrameCallback, *mut c_void);
type PostVsyncCallback = unsafe extern "C" fn(*mut ffi::AChoreographer, VsyncCallback, *mut c_void);
type GetTime = unsafe extern "C" fn(*const FrameData) -> i64;
type GetIndex = unsafe extern "C" fn(*const FrameData) -> usize;
type GetTimeOf = unsafe extern "C" fn(*const FrameData, usize) -> i64;

/// The choreographer of one thread, which reports the display's refreshes.
struct Choreographer {
    instance: NonNull<ffi::AChoreographer>,
    post: Post,
}

/// The function that requests a refresh.
enum Post {
    /// Reports only times.
    Frame(PostFrameCallback),
    /// Reports the timeline of a frame, from API 33 on.
    Vsync(Vsync),
}

/// The functions for `AChoreographer_postVsyncCallback`.
struct Vsync {
    post: PostVsyncCallback,
    begin: GetTime,
    preferred: GetIndex,
    deadline: GetTimeOf,
    display: GetTimeOf,
}

impl Choreographer {
    fn of_thread() -> Option<Choreographer> {
        let android = Library::android();
        // SAFETY: the types are those of <android/choreographer.h>, and the thread has a looper.
        unsafe {
            let get: GetInstance = android.function(c"AChoreographer_getInstance")?;
            let post = match Vsync::of(&android) {
                Some(vsync) => Post::Vsync(vsync),
                None => Post::Frame(android.function(c"AChoreographer_postFrameCallback64")?),
            };
            Some(Choreographer { instance: NonNull::new(get())?, post })
        }
    }
}

impl Vsync {
    fn of(android: &Library) -> Option<Vsync> {
        // SAFETY: the types are those of <android/choreographer.h>.
        unsafe {
            Some(Vsync {
                post: android.function(c"AChoreographer_postVsyncCallback")?,
                begin: android.function(c"AChoreographerFrameCallbackData_getFrameTimeNanos")?,
                preferred: android
                    .function(c"AChoreographerFrameCallbackData_getPreferredFrameTimelineIndex")?,
                deadline: android
                    .function(c"AChoreographerFrameCallbackData_getFrameTimelineDeadlineNanos")?,
                display: android.function(
                    c"AChoreographerFrameCallbackData_getFrameTimelineExpectedPresentationTimeNanos",
                )?,
            })
        }
    }

    /// # Safety
    /// `data` must be that of a callback that has not returned yet.
    unsafe fn refresh(&self, data: *const FrameData) -> Refresh {
        // SAFETY: the caller guarantees that the data are valid, and the preferred timeline always exists.
        unsafe {
            let index = (self.preferred)(data);
            let (deadline_ns, display_ns) = ((self.deadline)(data, index), (self.display)(data, index));
            Refresh { begin_ns: (self.begin)(data), timeline: Some(Timeline { deadline_ns, display_ns }) }
        }
    }
}

/// Requests one refresh after another while they are wanted.
struct RefreshLoop<'a> {
    shared: &'a Shared,
    choreographer: Option<Choreographer>,
    /// True while a requested refresh is pending. A pause may end before it arrives, and must not start a second chain.
    is_posted: Cell<bool>,
}

impl RefreshLoop<'_> {
    fn post(&self) {
        let Some(choreographer) = &self.choreographer else { return };
        if self.is_posted.replace(true) {
            return;
        }
        let (instance, data) = (choreographer.instance.as_ptr(), ptr::from_ref(self).cast_mut().cast());
        // SAFETY: this is the choreographer's thread. The callback runs on the same thread, while `run` polls and so
        // while its `RefreshLoop` is alive.
        unsafe {
            match &choreographer.post {
                Post::Frame(post) => post(instance, on_frame, data),
                Post::Vsync(vsync) => (vsync.post)(instance, on_vsync, data),
            }
        }
    }

    fn on_refresh(&self, refresh: Refresh) {
        self.is_posted.set(false);
        let shared = self.shared;
        if shared.is_on.load(Ordering::Acquire) {
            *lock(&shared.refresh) = Some(refresh);
            shared.has_refreshes.store(true, Ordering::Release);
            if let Some(waker) = &*lock(&shared.waker) {
                waker.wake();
            }
            self.post();
        }
    }
}

unsafe extern "C" fn on_frame(frame_time_ns: i64, data: *mut c_void) {
    // SAFETY: the pointer is the one that `RefreshLoop::post` passed.
    let refresh_loop = unsafe { &*data.cast::<RefreshLoop>() };
    refresh_loop.on_refresh(Refresh { begin_ns: frame_time_ns, timeline: None });
}

unsafe extern "C" fn on_vsync(frame: *const FrameData, data: *mut c_void) {
    // SAFETY: the pointer is the one that `RefreshLoop::post` passed.
    let refresh_loop = unsafe { &*data.cast::<RefreshLoop>() };
    if let Some(Choreographer { post: Post::Vsync(vsync), .. }) = &refresh_loop.choreographer {
        // SAFETY: the data belong to this callback.
        refresh_loop.on_refresh(unsafe { vsync.refresh(frame) });
    }
}
