//! ALooper. While a thread waits in its looper, virtual time advances to the next sensor event or display refresh, or
//! to the end of the wait.

#![allow(non_snake_case)]

use std::cell::RefCell;
use std::ffi::{c_int, c_void};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicI32, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use crate::android::choreographer::{self, Pending};
use crate::exports::{Export, System, exports};
use crate::fd::EventFd;
use crate::host::{fatal, host, lock};

/// `ALooper_callbackFunc`.
pub type Callback = unsafe extern "C" fn(fd: c_int, events: c_int, data: *mut c_void) -> c_int;

const POLL_WAKE: c_int = -1;
const POLL_CALLBACK: c_int = -2;
const POLL_TIMEOUT: c_int = -3;
const POLL_ERROR: c_int = -4;
/// `ALOOPER_EVENT_INPUT`, `_OUTPUT`, `_ERROR` and `_HANGUP`, and the corresponding events of poll.
const EVENTS: [(c_int, i16); 4] =
    [(1, libc::POLLIN), (2, libc::POLLOUT), (4, libc::POLLERR), (8, libc::POLLHUP)];
/// Interval in real milliseconds at which the virtual clock is checked.
const SLICE: c_int = 1;

/// The looper of a thread.
pub struct ALooper {
    references: AtomicI32,
    wake: EventFd,
    woken: AtomicBool,
    entries: Mutex<Vec<Entry>>,
    /// Callbacks for the next display refresh.
    pub choreographer: Mutex<Vec<Pending>>,
    /// Virtual time up to which the looper has handled everything.
    settled: AtomicU64,
}

/// Addresses of the existing loopers.
static LOOPERS: Mutex<Vec<usize>> = Mutex::new(Vec::new());

/// Waits until the loopers of other threads have handled everything that is due: a display refresh or sensor samples.
/// Real phones deliver these while a frame is being drawn; here they must arrive before the next frame begins. Waits at
/// most 50 ms for loopers that are busy with something else.
pub fn settle() {
    let now = host().clock.now();
    let own = current().map(|looper| std::ptr::from_ref(looper) as usize);
    let deadline = Instant::now() + Duration::from_millis(50);
    let busy = || {
        // SAFETY: a looper is removed from the locked list before it is freed.
        lock(&LOOPERS)
            .iter()
            .filter(|looper| Some(**looper) != own)
            .map(|looper| unsafe { &*(*looper as *const ALooper) })
            .any(|looper| {
                let busy = looper.settled.load(Ordering::Acquire) < now
                    && looper.next_event().is_some_and(|next| next <= now);
                if busy {
                    looper.wake.signal();
                }
                busy
            })
    };
    while busy() && Instant::now() < deadline {
        std::thread::sleep(Duration::from_micros(200));
    }
}

#[derive(Clone, Copy)]
struct Entry {
    fd: c_int,
    ident: c_int,
    events: c_int,
    callback: Option<Callback>,
    data: *mut c_void,
}

// SAFETY: `data` belongs to the application, and is only passed back to it on the looper's own thread.
unsafe impl Send for Entry {}

/// A descriptor that is ready.
struct Ready {
    fd: c_int,
    events: c_int,
    entry: Entry,
}

impl ALooper {
    fn new() -> *const Self {
        host().count("loopers", 1);
        let looper = Box::into_raw(Box::new(Self {
            references: AtomicI32::new(1),
            wake: EventFd::new(),
            woken: AtomicBool::new(false),
            entries: Mutex::default(),
            choreographer: Mutex::default(),
            settled: AtomicU64::new(0),
        }));
        lock(&LOOPERS).push(looper as usize);
        looper
    }

    /// Returns when the next sample or refresh is due on this looper.
    fn next_event(&self) -> Option<u64> {
        let samples =
            lock(&self.entries).iter().filter_map(|entry| host().sensors.next_event(entry.fd)).min();
        samples.into_iter().chain(choreographer::next(self)).min()
    }

    /// Returns the descriptors to poll: those of the entries in order, followed by the wake-up.
    fn descriptors(&self, entries: &[Entry]) -> Vec<libc::pollfd> {
        let mut fds: Vec<_> = entries
            .iter()
            .map(|entry| libc::pollfd {
                fd: entry.fd,
                events: EVENTS
                    .iter()
                    .filter(|(event, _)| entry.events & event != 0)
                    .fold(0, |bits, (_, bit)| bits | bit),
                revents: 0,
            })
            .collect();
        fds.push(libc::pollfd { fd: self.wake.raw(), events: libc::POLLIN, revents: 0 });
        fds
    }

    /// Polls in real time. `also` is a further descriptor. Returns the descriptors that are ready, or an error.
    fn poll(&self, milliseconds: c_int, also: c_int) -> Result<Vec<Ready>, ()> {
        let entries = lock(&self.entries).clone();
        let mut fds = self.descriptors(&entries);
        fds.push(libc::pollfd { fd: also, events: libc::POLLIN, revents: 0 });
        // SAFETY: pointer and length belong to one live vector.
        let result = unsafe { libc::poll(fds.as_mut_ptr(), fds.len() as _, milliseconds) };
        if result < 0 && std::io::Error::last_os_error().kind() != std::io::ErrorKind::Interrupted {
            return Err(());
        }
        if fds[entries.len()].revents != 0 {
            self.wake.clear();
        }
        Ok(entries
            .into_iter()
            .zip(&fds)
            .filter(|(_, fd)| fd.revents != 0)
            .map(|(entry, fd)| Ready {
                fd: entry.fd,
                events: EVENTS
                    .iter()
                    .filter(|(_, bit)| fd.revents & bit != 0)
                    .fold(0, |bits, (event, _)| bits | event),
                entry,
            })
            .collect())
    }

    /// Calls the callbacks of `ready`. Returns true if there were any, and the first entry with an identifier.
    fn dispatch(&self, ready: Vec<Ready>) -> (bool, Option<Ready>) {
        let mut called = false;
        let mut identified = None;
        for item in ready {
            let Some(callback) = item.entry.callback else {
                identified.get_or_insert(item);
                continue;
            };
            called = true;
            // SAFETY: the application's function gets the data that was passed with it, on the looper's thread.
            if unsafe { callback(item.fd, item.events, item.entry.data) } == 0 {
                self.remove(item.fd);
            }
        }
        (called, identified)
    }

    /// Does the looper's work, and waits at most `milliseconds` of real time for it. Used by the host's main thread,
    /// whose waits do not advance virtual time.
    pub fn pump(&self, milliseconds: c_int, also: c_int) {
        if let Ok(ready) = self.poll(milliseconds, also) {
            self.dispatch(ready);
        }
    }

    /// Removes a descriptor. Returns true if it was there.
    pub fn remove(&self, fd: c_int) -> bool {
        let mut entries = lock(&self.entries);
        let before = entries.len();
        entries.retain(|entry| entry.fd != fd);
        entries.len() < before
    }

    /// Adds or replaces a descriptor.
    pub fn add(&self, fd: c_int, ident: c_int, events: c_int, callback: Option<Callback>, data: *mut c_void) {
        self.remove(fd);
        lock(&self.entries).push(Entry {
            fd,
            ident: if callback.is_some() { POLL_CALLBACK } else { ident },
            events,
            callback,
            data,
        });
        self.wake.signal();
    }
}

/// A thread's own reference to its looper.
struct Own(*const ALooper);

impl Drop for Own {
    fn drop(&mut self) {
        // SAFETY: the thread has held this reference since `prepare`.
        unsafe { ALooper_release(self.0) };
    }
}

thread_local! {
    static CURRENT: RefCell<Option<Own>> = const { RefCell::new(None) };
}

/// Returns the calling thread's looper.
pub fn current() -> Option<&'static ALooper> {
    // SAFETY: a thread's own reference keeps its looper alive for as long as the thread runs.
    CURRENT.try_with(|own| own.borrow().as_ref().map(|own| unsafe { &*own.0 })).ok().flatten()
}

/// Returns the calling thread's looper, which is created if necessary.
pub fn prepare() -> &'static ALooper {
    CURRENT.with_borrow_mut(|own| {
        let own = own.get_or_insert_with(|| Own(ALooper::new()));
        // SAFETY: see `current`.
        unsafe { &*own.0 }
    })
}

/// Returns the functions of this module that libandroid.so exports.
pub fn exports() -> Vec<Export> {
    exports![System::Android, 1: [
        ALooper_acquire, ALooper_addFd, ALooper_forThread, ALooper_pollOnce, ALooper_prepare, ALooper_release,
        ALooper_wake,
    ]]
}

extern "C" fn ALooper_forThread() -> *const ALooper {
    current().map_or(std::ptr::null(), std::ptr::from_ref)
}

extern "C" fn ALooper_prepare(_options: c_int) -> *const ALooper {
    prepare()
}

unsafe extern "C" fn ALooper_acquire(looper: *const ALooper) {
    // SAFETY: a live looper by contract.
    unsafe { &*looper }.references.fetch_add(1, Ordering::Relaxed);
}

unsafe extern "C" fn ALooper_release(looper: *const ALooper) {
    // SAFETY: a live looper by contract.
    let before = unsafe { &*looper }.references.fetch_sub(1, Ordering::AcqRel);
    if before == 1 {
        host().count("loopers", -1);
        lock(&LOOPERS).retain(|known| *known != looper as usize);
        // SAFETY: the looper was made by `ALooper::new`, and this was its last reference.
        drop(unsafe { Box::from_raw(looper.cast_mut()) });
    }
}

unsafe extern "C" fn ALooper_addFd(
    looper: *const ALooper,
    fd: c_int,
    ident: c_int,
    events: c_int,
    callback: Option<Callback>,
    data: *mut c_void,
) -> c_int {
    if callback.is_none() && ident < 0 {
        host().violation("ALooper_addFd without a callback and with a negative identifier");
        return -1;
    }
    // SAFETY: a live looper by contract.
    unsafe { &*looper }.add(fd, ident, events, callback, data);
    1
}

unsafe extern "C" fn ALooper_wake(looper: *const ALooper) {
    // SAFETY: a live looper by contract.
    let looper = unsafe { &*looper };
    looper.woken.store(true, Ordering::Release);
    looper.wake.signal();
}

unsafe extern "C" fn ALooper_pollOnce(
    timeout: c_int,
    out_fd: *mut c_int,
    out_events: *mut c_int,
    out_data: *mut *mut c_void,
) -> c_int {
    let Some(looper) = current() else { fatal("the application polled a looper on a thread that has none") };
    let host = host();
    let deadline =
        u64::try_from(timeout).ok().map(|milliseconds| host.clock.now() + milliseconds * 1_000_000);
    loop {
        let now = host.clock.now();
        host.sensors.fill(now);
        let called = choreographer::run(looper, now);
        let Ok(ready) = looper.poll(0, -1) else { return POLL_ERROR };
        let (dispatched, identified) = looper.dispatch(ready);
        if let Some(found) = identified {
            for (pointer, value) in [(out_fd, found.fd), (out_events, found.events)] {
                if !pointer.is_null() {
                    // SAFETY: not null, so the caller gives room for one int.
                    unsafe { pointer.write(value) };
                }
            }
            if !out_data.is_null() {
                // SAFETY: not null, so the caller gives room for one pointer.
                unsafe { out_data.write(found.entry.data) };
            }
            return found.entry.ident;
        }
        if called || dispatched {
            return POLL_CALLBACK;
        }
        if looper.woken.swap(false, Ordering::AcqRel) {
            return POLL_WAKE;
        }
        if deadline.is_some_and(|deadline| host.clock.now() >= deadline) {
            return POLL_TIMEOUT;
        }
        looper.settled.store(now, Ordering::Release);
        let next = [deadline, looper.next_event()].into_iter().flatten().min();
        let Some(next) = next else {
            looper.poll_only(-1);
            continue;
        };
        let wait = host.clock.wait_for(next);
        if !looper.poll_only(SLICE) && !wait.is_over() {
            wait.try_advance();
        }
    }
}

impl ALooper {
    /// Waits until something is ready, but does not handle it.
    fn poll_only(&self, milliseconds: c_int) -> bool {
        let mut fds = self.descriptors(&lock(&self.entries));
        // SAFETY: pointer and length belong to one live vector.
        unsafe { libc::poll(fds.as_mut_ptr(), fds.len() as _, milliseconds) > 0 }
    }
}
