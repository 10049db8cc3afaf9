//! libc.so, libm.so and libdl.so. Most functions have the same interface in bionic and in glibc on 64-bit Linux. Those
//! in the lists below are glibc's; those that differ, or that must not see the real machine, are implemented here. All
//! others become traps: in bionic, `sigaction`, `sem_t`, `addrinfo`, `termios` and `FILE` have other layouts.

#![allow(non_snake_case)]

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_int, c_long, c_uint, c_void};
use std::sync::atomic::Ordering;
use std::time::Duration;

use crate::exports::{self, Export, System, exports};
use crate::host::{fatal, host, lock};
use crate::{loader, openxr};

/// Functions of libc.so that are those of glibc.
const SAME_C: &str = "\
    __cxa_atexit __cxa_finalize __cxa_thread_atexit_impl __errno_location accept4 aligned_alloc bind calloc chmod close \
    closedir connect copy_file_range dirfd dup dup2 dup3 environ epoll_create1 epoll_ctl epoll_wait eventfd fchmod fcntl \
    fdatasync fdopendir flock free fstat fstatat fsync ftruncate ftruncate64 futimens getauxval getcwd getegid getenv geteuid \
    getgid getpeername getpid getppid getrandom getrusage getsockname getsockopt gettid getuid ioctl isatty ldexp link linkat \
    listen lseek lseek64 lstat madvise malloc malloc_usable_size memalign memchr memcmp memcpy memmem memmove memrchr memset \
    mkdir mkdirat mmap mmap64 mprotect mremap munmap pipe pipe2 poll posix_fadvise posix_madvise posix_memalign ppoll prctl \
    pread pread64 preadv preadv64 pthread_atfork pthread_cond_broadcast pthread_cond_destroy pthread_cond_init \
    pthread_cond_signal pthread_cond_wait pthread_condattr_destroy pthread_condattr_init pthread_condattr_setclock \
    pthread_detach pthread_getspecific pthread_join pthread_key_create pthread_key_delete pthread_kill pthread_mutex_destroy \
    pthread_mutex_lock pthread_mutex_trylock pthread_mutex_unlock pthread_mutexattr_destroy pthread_mutexattr_init \
    pthread_mutexattr_settype pthread_once pthread_rwlock_destroy pthread_rwlock_rdlock pthread_rwlock_unlock \
    pthread_rwlock_wrlock pthread_self pthread_setspecific pwrite pwrite64 pwritev pwritev64 read readdir readlink readv \
    realloc realpath recv recvfrom rename renameat rewinddir rmdir sched_getaffinity sched_setaffinity sched_yield send \
    sendfile sendto setenv setpriority getpriority setsockopt shutdown socket socketpair splice stat statvfs statx strchr \
    strcmp strlen strncmp strnlen strtol strtoul strtoull symlink uname unlink unlinkat unsetenv utimensat write writev";

/// Functions of libm.so that are those of glibc.
const SAME_M: &str = "\
    acos acosf acosh acoshf asin asinf asinh asinhf atan atan2 atan2f atanf atanh atanhf cbrt cbrtf ceil ceilf copysign copysignf cos \
    cosf cosh coshf erf erfc erfcf erff exp exp2 exp2f expf expm1 expm1f fabs fabsf fdim fdimf floor floorf fma fmaf fmax fmaxf fmin \
    fminf fmod fmodf frexp frexpf hypot hypotf ldexp ldexpf lgamma_r lgammaf_r log log10 log10f log1p log1pf log2 log2f logf modf modff \
    nearbyint nearbyintf nextafter nextafterf pow powf remainder remainderf rint rintf round roundf scalbn scalbnf sin sincos sincosf sinf \
    sinh sinhf sqrt sqrtf tan tanf tanh tanhf tgamma tgammaf trunc truncf";

/// Returns the functions that the three libraries export.
pub fn exports() -> Vec<Export> {
    let mut all = exports![
        System::C, 1: [
            __errno, __system_property_get, abort, android_set_abort_message, clock_gettime, clock_nanosleep, exit, open,
            opendir, pthread_attr_destroy, pthread_attr_init, pthread_attr_setstacksize, pthread_create,
            pthread_setname_np, strerror_r, syscall, sysconf,
        ];
        System::Dl, 1: [dl_iterate_phdr, dladdr, dlclose, dlerror, dlopen, dlsym];
    ];
    // Loads libm, which may not have been loaded yet. It is never unloaded. SAFETY: glibc's own library, whose
    // constructors do not affect other code.
    let math = unsafe { libc::dlopen(c"libm.so.6".as_ptr(), libc::RTLD_NOW) };
    for (library, handle, names) in [(System::C, libc::RTLD_DEFAULT, SAME_C), (System::M, math, SAME_M)] {
        for name in names.split_ascii_whitespace() {
            let symbol = CString::new(name).expect("the lists hold no NUL");
            // SAFETY: looks a symbol up in the libraries of this process, by a terminated name.
            let address = unsafe { libc::dlsym(handle, symbol.as_ptr()) };
            if !address.is_null() {
                all.push(Export { library, name, address: address as usize, since: 1 });
            }
        }
    }
    all
}

fn set_errno(error: c_int) {
    // SAFETY: glibc gives the address of this thread's errno.
    unsafe { *libc::__errno_location() = error };
}

extern "C" fn __errno() -> *mut c_int {
    // SAFETY: no arguments.
    unsafe { libc::__errno_location() }
}

unsafe extern "C" {
    fn __xpg_strerror_r(error: c_int, buffer: *mut c_char, length: usize) -> c_int;
}

/// POSIX's `strerror_r` as in bionic, whereas glibc's default is GNU's.
unsafe extern "C" fn strerror_r(error: c_int, buffer: *mut c_char, length: usize) -> c_int {
    // SAFETY: the application's arguments are passed to glibc, whose contract is the same here.
    unsafe { __xpg_strerror_r(error, buffer, length) }
}

/// `sysconf` with bionic's numbers.
extern "C" fn sysconf(name: c_int) -> c_long {
    let name = match name {
        6 => libc::_SC_CLK_TCK,
        39 | 40 => libc::_SC_PAGESIZE,
        96 => libc::_SC_NPROCESSORS_CONF,
        97 => libc::_SC_NPROCESSORS_ONLN,
        98 => libc::_SC_PHYS_PAGES,
        99 => libc::_SC_AVPHYS_PAGES,
        other => fatal(format!(
            "the application called sysconf({other}), which the host does not know: add it to the host"
        )),
    };
    // SAFETY: takes a number.
    unsafe { libc::sysconf(name) }
}

extern "C" fn abort() -> ! {
    fatal(format!("the application called abort (thread {}){}", thread_name(), host().log.abort_message()))
}

extern "C" fn exit(code: c_int) -> ! {
    fatal(format!("the application called exit({code}): an activity ends by ANativeActivity_finish"))
}

unsafe extern "C" fn android_set_abort_message(message: *const c_char) {
    // SAFETY: a terminated string by contract.
    host().log.set_abort_message(unsafe { text(message) });
}

/// Returns the name of the current thread.
pub fn thread_name() -> String {
    let mut name = [0 as c_char; 32];
    // SAFETY: the buffer is as long as said.
    unsafe { libc::pthread_getname_np(libc::pthread_self(), name.as_mut_ptr(), name.len()) };
    // SAFETY: terminated by the call, or still zero.
    unsafe { text(name.as_ptr()) }
}

/// Recognises the thread of `android_main` by the name that android-activity gives it. This must happen here, since
/// threads that it starts inherit the name.
unsafe extern "C" fn pthread_setname_np(thread: libc::pthread_t, name: *const c_char) -> c_int {
    // SAFETY: a terminated name by contract; the rest takes nothing.
    unsafe {
        if libc::pthread_equal(thread, libc::pthread_self()) != 0 && text(name) == "android_main" {
            host().main_thread.store(libc::gettid(), Ordering::Release);
        }
        libc::pthread_setname_np(thread, name)
    }
}

/// Returns a C string as text, empty for null.
///
/// # Safety
/// `string` must be null or a terminated string.
pub unsafe fn text(string: *const c_char) -> String {
    if string.is_null() {
        return String::new();
    }
    // SAFETY: it is not null, so it is a terminated string.
    unsafe { CStr::from_ptr(string) }.to_string_lossy().into_owned()
}

// Threads

/// The application reserves 56 bytes for a `pthread_attr_t`, but glibc's has 64 on arm64. The object is therefore
/// stored elsewhere, and these bytes hold its address.
type Attributes = *mut *mut libc::pthread_attr_t;

unsafe extern "C" fn pthread_attr_init(attributes: Attributes) -> c_int {
    // SAFETY: this is plain data for which zero is valid, and the caller gives room for one pointer.
    unsafe {
        let new = Box::into_raw(Box::new(std::mem::zeroed::<libc::pthread_attr_t>()));
        attributes.write(new);
        libc::pthread_attr_init(new)
    }
}

unsafe extern "C" fn pthread_attr_destroy(attributes: Attributes) -> c_int {
    // SAFETY: made by the function above, and not destroyed before.
    unsafe {
        let result = libc::pthread_attr_destroy(*attributes);
        drop(Box::from_raw(attributes.replace(std::ptr::null_mut())));
        result
    }
}

unsafe extern "C" fn pthread_attr_setstacksize(attributes: Attributes, size: usize) -> c_int {
    // SAFETY: attributes that were made.
    unsafe { libc::pthread_attr_setstacksize(*attributes, size) }
}

unsafe extern "C" fn pthread_create(
    thread: *mut libc::pthread_t,
    attributes: Attributes,
    start: extern "C" fn(*mut c_void) -> *mut c_void,
    argument: *mut c_void,
) -> c_int {
    // SAFETY: the attributes are null or initialised; the other arguments are the caller's.
    unsafe {
        let attributes = if attributes.is_null() { std::ptr::null() } else { (*attributes).cast_const() };
        libc::pthread_create(thread, attributes, start, argument)
    }
}

// Files

/// True if applications on a phone may not read this path. The content would be that of this machine.
fn is_closed(path: *const c_char) -> bool {
    // SAFETY: `open` and similar functions get a terminated path.
    let path = unsafe { text(path) };
    [
        "/sys/class/power_supply",
        "/sys/class/thermal",
        "/sys/class/kgsl",
        "/sys/devices/system/cpu/cpu0/cpufreq",
    ]
    .iter()
    .any(|closed| path.starts_with(closed))
}

/// The variadic `mode` is in the register of a third argument on both architectures.
unsafe extern "C" fn open(path: *const c_char, flags: c_int, mode: c_uint) -> c_int {
    if is_closed(path) {
        set_errno(libc::EACCES);
        return -1;
    }
    // SAFETY: the application's arguments are passed to glibc, whose contract is the same here.
    unsafe { libc::open(path, flags, mode) }
}

unsafe extern "C" fn opendir(path: *const c_char) -> *mut libc::DIR {
    if is_closed(path) {
        set_errno(libc::EACCES);
        return std::ptr::null_mut();
    }
    // SAFETY: the application's arguments are passed to glibc, whose contract is the same here.
    unsafe { libc::opendir(path) }
}

// Time

fn nanoseconds(time: &libc::timespec) -> u64 {
    (time.tv_sec.max(0) as u64).saturating_mul(1_000_000_000).saturating_add(time.tv_nsec.max(0) as u64)
}

fn timespec(nanoseconds: u64) -> libc::timespec {
    libc::timespec { tv_sec: (nanoseconds / 1_000_000_000) as _, tv_nsec: (nanoseconds % 1_000_000_000) as _ }
}

/// Returns the virtual time of a clock, or `None` for clocks that measure CPU time, which are the machine's.
fn virtual_time(clock: c_int) -> Option<u64> {
    match clock {
        libc::CLOCK_BOOTTIME => Some(host().clock.boottime_of(host().clock.now())),
        libc::CLOCK_MONOTONIC | libc::CLOCK_MONOTONIC_RAW | libc::CLOCK_MONOTONIC_COARSE => {
            Some(host().clock.now())
        }
        libc::CLOCK_REALTIME | libc::CLOCK_REALTIME_COARSE => Some(host().clock.realtime()),
        _ => None,
    }
}

unsafe extern "C" fn clock_gettime(clock: c_int, time: *mut libc::timespec) -> c_int {
    match virtual_time(clock) {
        Some(now) => {
            // SAFETY: the caller gives room for one timespec.
            unsafe { time.write(timespec(now)) };
            0
        }
        // SAFETY: the application's arguments are passed to glibc, whose contract is the same here.
        None => unsafe { libc::clock_gettime(clock, time) },
    }
}

/// Interval in real time at which the virtual clock is checked.
const SLICE: Duration = Duration::from_millis(1);

fn sleep_until(deadline: u64) {
    let wait = host().clock.wait_for(deadline);
    while !wait.is_over() {
        std::thread::sleep(SLICE);
        wait.try_advance();
    }
}

/// Sleeps for a virtual time in seconds.
pub fn sleep(seconds: f64) {
    sleep_until(host().clock.now() + (seconds * 1e9) as u64);
}

unsafe extern "C" fn clock_nanosleep(
    clock: c_int,
    flags: c_int,
    time: *const libc::timespec,
    _rest: *mut libc::timespec,
) -> c_int {
    // SAFETY: the caller gives a timespec.
    let time = nanoseconds(unsafe { &*time });
    sleep_until(match (flags & libc::TIMER_ABSTIME != 0, clock) {
        (false, _) => host().clock.now() + time,
        (true, libc::CLOCK_REALTIME) => host().clock.monotonic_of(time),
        (true, _) => time,
    });
    0
}

/// Waits until a deadline on the virtual clock, in slices of real time. `wait` waits for a slice, and returns a result
/// if it has ended for another reason.
fn timed_wait<T>(deadline: u64, mut wait: impl FnMut(Duration) -> Option<T>) -> Option<T> {
    let waiting = host().clock.wait_for(deadline);
    loop {
        let over = waiting.is_over();
        if let Some(result) = wait(if over { Duration::ZERO } else { SLICE }) {
            return Some(result);
        }
        if over {
            return None;
        }
        waiting.try_advance();
    }
}

/// Returns the real time at which `slice` will have passed.
fn real_deadline(clock: c_int, slice: Duration) -> libc::timespec {
    let mut now = timespec(0);
    // SAFETY: room for one timespec.
    unsafe { libc::clock_gettime(clock, &raw mut now) };
    timespec(nanoseconds(&now) + slice.as_nanos() as u64)
}

/// std's mutexes, condition variables and parked threads use futexes, whose deadlines are on the virtual clock.
unsafe extern "C" fn syscall(
    number: c_long,
    a: usize,
    b: usize,
    c: usize,
    d: usize,
    e: usize,
    f: usize,
) -> c_long {
    const WAIT: usize = 0;
    const WAIT_BITSET: usize = 9;
    const REALTIME: usize = 256;
    if number == libc::SYS_futex && d != 0 && matches!(b & 127, WAIT | WAIT_BITSET) {
        // SAFETY: the fourth argument of these operations is a timespec.
        let time = nanoseconds(unsafe { &*(d as *const libc::timespec) });
        let deadline = match (b & 127, b & REALTIME != 0) {
            (WAIT, _) => host().clock.now().saturating_add(time),
            (_, true) => host().clock.monotonic_of(time),
            (_, false) => time,
        };
        let wait_bits = if b & 127 == WAIT { u32::MAX as usize } else { f };
        let private = b & 128;
        let result = timed_wait(deadline, |slice| {
            let until = real_deadline(libc::CLOCK_MONOTONIC, slice);
            // SAFETY: the caller's futex; the deadline lives during the call.
            let result =
                unsafe { libc::syscall(number, a, WAIT_BITSET | private, c, &raw const until, 0, wait_bits) };
            // SAFETY: this thread's errno.
            let timed_out = result < 0 && unsafe { *libc::__errno_location() } == libc::ETIMEDOUT;
            (!timed_out).then_some(result)
        });
        return result.unwrap_or_else(|| {
            set_errno(libc::ETIMEDOUT);
            -1
        });
    }
    // SAFETY: the application's arguments are passed on unchanged.
    unsafe { libc::syscall(number, a, b, c, d, e, f) }
}

// System properties

/// bionic's `PROP_VALUE_MAX`.
const PROPERTY_LENGTH: usize = 92;

fn property(name: &str) -> String {
    let host = host();
    lock(&host.properties).get(name).cloned().unwrap_or_else(|| match name {
        "ro.build.version.sdk" => host.device.sdk.to_string(),
        "ro.product.model" => "Simulated Android host".to_owned(),
        _ => String::new(),
    })
}

unsafe extern "C" fn __system_property_get(name: *const c_char, value: *mut c_char) -> c_int {
    // SAFETY: a terminated name.
    let found = property(&unsafe { text(name) });
    let length = found.len().min(PROPERTY_LENGTH - 1);
    // SAFETY: the caller gives PROP_VALUE_MAX bytes.
    unsafe {
        std::ptr::copy_nonoverlapping(found.as_ptr(), value.cast(), length);
        *value.add(length) = 0;
    }
    length as c_int
}

// libdl

thread_local! {
    static ERROR: RefCell<(bool, CString)> = RefCell::default();
}

fn dl_error(message: String) {
    ERROR.with_borrow_mut(|error| *error = (true, CString::new(message).unwrap_or_default()));
}

/// Handle of the application's own library. Handles of system libraries are their index in [`System::ALL`] plus 1.
const SELF: usize = 0x5e1f;

unsafe extern "C" fn dlopen(path: *const c_char, _flags: c_int) -> *mut c_void {
    // SAFETY: null or a terminated path.
    let name = unsafe { text(path) };
    let host = host();
    if host.library.get().is_some_and(|library| library.path.as_c_str().to_bytes() == name.as_bytes()) {
        return SELF as *mut c_void;
    }
    if let Some(library) = openxr::open(&name).or_else(|| loader::open(&name)) {
        return library;
    }
    match System::ALL.iter().position(|library| library.0 == name) {
        Some(index) => (index + 1) as *mut c_void,
        None => {
            dl_error(format!("dlopen failed: library \"{name}\" not found"));
            std::ptr::null_mut()
        }
    }
}

extern "C" fn dlclose(_handle: *mut c_void) -> c_int {
    0
}

unsafe extern "C" fn dlsym(handle: *mut c_void, name: *const c_char) -> *mut c_void {
    // SAFETY: a terminated name.
    let symbol = unsafe { CStr::from_ptr(name) };
    if let Some(address) = openxr::symbol(handle, symbol).or_else(|| loader::symbol(handle, symbol)) {
        if address.is_null() {
            dl_error("undefined symbol of the OpenXR runtime or loader".into());
        }
        return address;
    }
    // SAFETY: a terminated name.
    let name = unsafe { text(name) };
    let host = host();
    let found = match handle as usize {
        SELF => host.library.get().and_then(|library| library.symbol(&name)),
        index if (1..=System::ALL.len()).contains(&index) => {
            exports::find(System::ALL[index - 1], &name, host.device.sdk)
        }
        // RTLD_DEFAULT on 64-bit Android: the libraries that the application's needs, here all of them.
        0 => [System::C, System::M, System::Dl, System::Log, System::Android, System::Egl]
            .into_iter()
            .find_map(|library| exports::find(library, &name, host.device.sdk)),
        _ => None,
    };
    found.map_or_else(
        || {
            dl_error(format!("undefined symbol: {name}"));
            std::ptr::null_mut()
        },
        |address| address as *mut c_void,
    )
}

extern "C" fn dlerror() -> *const c_char {
    ERROR.with_borrow_mut(
        |error| if std::mem::take(&mut error.0) { error.1.as_ptr() } else { std::ptr::null() },
    )
}

unsafe extern "C" fn dladdr(address: *const c_void, info: *mut libc::Dl_info) -> c_int {
    match host().libraries().find(|library| library.contains(address as usize)) {
        Some(library) => {
            // SAFETY: the caller gives room for one Dl_info; the path lives as long as the process.
            unsafe {
                info.write(libc::Dl_info {
                    dli_fname: library.path.as_ptr(),
                    dli_fbase: library.base as *mut c_void,
                    dli_sname: std::ptr::null(),
                    dli_saddr: std::ptr::null_mut(),
                });
            }
            1
        }
        // SAFETY: the application's arguments are passed to glibc, whose contract is the same here.
        None => unsafe { libc::dladdr(address, info) },
    }
}

type VisitLibrary = unsafe extern "C" fn(*mut libc::dl_phdr_info, usize, *mut c_void) -> c_int;

unsafe extern "C" fn dl_iterate_phdr(visit: VisitLibrary, data: *mut c_void) -> c_int {
    for library in host().libraries() {
        // SAFETY: the structure is plain data for which zero is valid.
        let mut info: libc::dl_phdr_info = unsafe { std::mem::zeroed() };
        info.dlpi_addr = library.base as _;
        info.dlpi_name = library.path.as_ptr();
        info.dlpi_phdr = library.program_headers.as_ptr().cast();
        info.dlpi_phnum = (library.program_headers.len() / 56) as _;
        // SAFETY: the caller's function, with a structure that lives during the call.
        let result = unsafe { visit(&raw mut info, size_of_val(&info), data) };
        if result != 0 {
            return result;
        }
    }
    // SAFETY: the application's arguments are passed to glibc, whose contract is the same here.
    unsafe { libc::dl_iterate_phdr(Some(visit), data) }
}
