//! The C library, and Android's libraries by name.

mod dynamic;

use std::ffi::CString;

pub use dynamic::Library;

/// Returns the time on the clock of Android's events and refreshes, in nanoseconds.
pub fn now_ns() -> i64 {
    time_ns(libc::CLOCK_MONOTONIC)
}

/// Returns the time in nanoseconds that the device has slept since its boot. The sensors' clock is ahead of [`now_ns`]
/// by this time.
pub fn slept_ns() -> i64 {
    time_ns(libc::CLOCK_BOOTTIME) - now_ns()
}

fn time_ns(clock: libc::clockid_t) -> i64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: these clocks exist on every Linux, and there is room for the result.
    unsafe { libc::clock_gettime(clock, &mut time) };
    time.tv_sec * 1_000_000_000 + time.tv_nsec
}

/// Returns the kernel's number of this thread.
pub fn thread_id() -> i32 {
    // SAFETY: `gettid` has no arguments.
    unsafe { libc::gettid() }
}

/// Returns a system property; empty if it is not set.
pub fn property(name: &str) -> Option<String> {
    let name = CString::new(name).ok()?;
    let mut value = [0u8; libc::PROP_VALUE_MAX as usize];
    // SAFETY: the name is null-terminated, and there is room for the longest value.
    let length = unsafe { libc::__system_property_get(name.as_ptr(), value.as_mut_ptr().cast()) };
    let value = value.get(..usize::try_from(length).ok()?)?;
    Some(String::from_utf8_lossy(value).into_owned())
}
