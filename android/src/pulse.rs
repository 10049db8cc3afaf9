//! What comes at its own times: samples of the motion sensors, and the display's refreshes.
//!
//! Both speak through a looper. That of `android_main` is android-activity's, which takes other sources for mistakes;
//! and a choreographer lives as long as its thread. So there is one thread for all activities of the process, which
//! sleeps while none is in front.

use std::cell::Cell;
use std::ffi::c_void;
use std::ptr::{self, NonNull};
use std::sync::atomic::{AtomicBool, AtomicI64, Ordering};
use std::sync::mpsc;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread;

use android_activity::AndroidAppWaker;
use ndk::looper::{ForeignLooper, ThreadLooper};
use ndk_sys as ffi;
use yoro::viewer::Sample;

use crate::dynamic::Library;
use crate::sensors::Sensors;

/// Samples that are kept for a main loop that takes none: a tenth of a second and more. Older ones are dropped.
const MAX_SAMPLES: usize = 256;

static PULSE: OnceLock<Option<Pulse>> = OnceLock::new();

/// The thread.
pub struct Pulse {
    shared: Arc<Shared>,
    looper: ForeignLooper,
}

/// What thread and main loop share.
#[derive(Default)]
struct Shared {
    /// Whether sensors and refreshes are wanted.
    is_on: AtomicBool,
    /// Time of the newest refresh that the main loop has not seen; 0 for none.
    refresh_ns: AtomicI64,
    /// Whether refreshes have ever come.
    has_refreshes: AtomicBool,
    samples: Mutex<Vec<(Sample, i64)>>,
    waker: Mutex<Option<AndroidAppWaker>>,
}

impl Pulse {
    /// The process's one, started at the first call; none if there can be no thread.
    pub fn get() -> Option<&'static Pulse> {
        PULSE.get_or_init(Pulse::start).as_ref()
    }

    fn start() -> Option<Pulse> {
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
        if let Err(error) = thread::Builder::new().name("yoro-pulse".into()).spawn(work) {
            log::error!("no thread for the sensors ({error}): the picture does not follow the head");
            return None;
        }
        Some(Pulse { shared, looper: receiver.recv().ok()? })
    }

    /// Starts sensors and refreshes for a main loop, which is woken at each refresh.
    pub fn resume(&self, waker: AndroidAppWaker) {
        lock(&self.shared.samples).clear();
        *lock(&self.shared.waker) = Some(waker);
        self.shared.refresh_ns.store(0, Ordering::Release);
        self.shared.is_on.store(true, Ordering::Release);
        self.looper.wake();
    }

    /// Stops both: nothing uses the battery any more.
    pub fn pause(&self) {
        self.shared.is_on.store(false, Ordering::Release);
        *lock(&self.shared.waker) = None;
        self.looper.wake();
    }

    /// Whether this device tells of its refreshes.
    pub fn has_refreshes(&self) -> bool {
        self.shared.has_refreshes.load(Ordering::Acquire)
    }

    /// The time of the newest refresh since the last call, in nanoseconds of the monotonic clock.
    pub fn take_refresh(&self) -> Option<i64> {
        Some(self.shared.refresh_ns.swap(0, Ordering::AcqRel)).filter(|time| *time != 0)
    }

    /// Hands on the samples that have come since the last call, oldest first. `buffer` is only there to be used
    /// again.
    pub fn drain(&self, buffer: &mut Vec<(Sample, i64)>, mut take: impl FnMut(Sample, i64)) {
        buffer.clear();
        std::mem::swap(&mut *lock(&self.shared.samples), buffer);
        buffer.drain(..).for_each(|(sample, time)| take(sample, time));
    }
}

/// What a panicking thread has left is still samples.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn run(shared: &Shared, looper: NonNull<ffi::ALooper>) {
    let beat = Beat { shared, choreographer: Choreographer::of_thread(), is_posted: Cell::new(false) };
    if beat.choreographer.is_none() {
        log::info!("this device has no choreographer: eglSwapBuffers sets the pace");
    }
    let (mut sensors, mut was_on) = (None, false);
    loop {
        let is_on = shared.is_on.load(Ordering::Acquire);
        if is_on != was_on {
            was_on = is_on;
            sensors = if is_on { Sensors::start(looper) } else { None };
            if is_on {
                beat.post();
            }
        }
        // SAFETY: the looper is this thread's; no results besides the return value are asked for.
        let result = unsafe { ffi::ALooper_pollOnce(-1, ptr::null_mut(), ptr::null_mut(), ptr::null_mut()) };
        if result == ffi::ALOOPER_POLL_ERROR {
            log::error!("the sensors' looper has failed: the picture does not follow the head any more");
            return;
        }
        if let Some(sensors) = &mut sensors {
            let mut samples = lock(&shared.samples);
            sensors.drain(|sample, time| {
                if samples.len() == MAX_SAMPLES {
                    samples.remove(0);
                }
                samples.push((sample, time));
            });
        }
    }
}

type Callback = unsafe extern "C" fn(frame_time_ns: i64, data: *mut c_void);
type GetInstance = unsafe extern "C" fn() -> *mut ffi::AChoreographer;
type PostFrameCallback = unsafe extern "C" fn(*mut ffi::AChoreographer, Callback, *mut c_void);

/// The display's refreshes, for one thread.
struct Choreographer {
    instance: NonNull<ffi::AChoreographer>,
    post: PostFrameCallback,
}

impl Choreographer {
    fn of_thread() -> Option<Choreographer> {
        let android = Library::open();
        // SAFETY: the types are those of <android/choreographer.h>; the thread has a looper.
        unsafe {
            let get: GetInstance = android.function(c"AChoreographer_getInstance")?;
            let post = android.function(c"AChoreographer_postFrameCallback64")?;
            Some(Choreographer { instance: NonNull::new(get())?, post })
        }
    }
}

/// Asks for one refresh after the other while they are wanted.
struct Beat<'a> {
    shared: &'a Shared,
    choreographer: Option<Choreographer>,
    /// A pause may end before the refresh that was asked for last: a second chain must not begin.
    is_posted: Cell<bool>,
}

impl Beat<'_> {
    fn post(&self) {
        let Some(choreographer) = &self.choreographer else { return };
        if self.is_posted.replace(true) {
            return;
        }
        let data = ptr::from_ref(self).cast_mut().cast();
        // SAFETY: this is the instance's thread. The callback runs on it too, while `run` polls and so while its
        // `Beat` is alive.
        unsafe { (choreographer.post)(choreographer.instance.as_ptr(), on_refresh, data) }
    }
}

unsafe extern "C" fn on_refresh(frame_time_ns: i64, data: *mut c_void) {
    // SAFETY: the pointer that `Beat::post` gave.
    let beat = unsafe { &*data.cast::<Beat>() };
    beat.is_posted.set(false);
    let shared = beat.shared;
    if shared.is_on.load(Ordering::Acquire) {
        shared.refresh_ns.store(frame_time_ns, Ordering::Release);
        shared.has_refreshes.store(true, Ordering::Release);
        if let Some(waker) = &*lock(&shared.waker) {
            waker.wake();
        }
        beat.post();
    }
}
