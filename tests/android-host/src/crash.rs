//! Reports crashes of the application as failures, with an address that can be looked up.

use std::ffi::{c_int, c_void};

use crate::bionic::thread_name;
use crate::host::{fatal, host};

/// From now on, catches signals of crashes and panics of the host.
pub fn install() {
    std::panic::set_hook(Box::new(|panic| fatal(format!("the host itself panicked: {panic}"))));
    for signal in [libc::SIGSEGV, libc::SIGBUS, libc::SIGILL, libc::SIGFPE, libc::SIGABRT] {
        // SAFETY: the structure is plain data for which zero is valid. The handler has SA_SIGINFO's type.
        unsafe {
            let mut action: libc::sigaction = std::mem::zeroed();
            action.sa_sigaction = crashed as *const () as usize;
            action.sa_flags = libc::SA_SIGINFO | libc::SA_RESETHAND | libc::SA_ONSTACK;
            libc::sigaction(signal, &raw const action, std::ptr::null_mut());
        }
    }
}

/// Reports a crash. Some of this is not allowed in a signal handler, but the process is lost anyway, and only the
/// address matters. If the summary can no longer be written, the alarm ends the process.
extern "C" fn crashed(signal: c_int, information: *mut libc::siginfo_t, context: *mut c_void) {
    // SAFETY: takes a number. The default action of SIGALRM ends the process.
    unsafe { libc::alarm(10) };
    // SAFETY: the kernel passes both pointers to a handler installed with SA_SIGINFO.
    let (address, counter) = unsafe { ((*information).si_addr() as usize, program_counter(context)) };
    fatal(format!(
        "signal {signal} at address {address:#x} in thread {}, {}",
        thread_name(),
        in_library(counter).map_or_else(
            || format!("outside of the package's libraries (pc {counter:#x})"),
            |offset| format!("at {offset}")
        )
    ))
}

fn in_library(address: usize) -> Option<String> {
    let library = host().libraries().find(|library| library.is_code(address))?;
    let path = library.path.to_string_lossy();
    let file = path.rsplit('/').next().unwrap_or_default();
    Some(format!("{file}+{:#x}", address - library.base))
}

/// Returns the program counter.
///
/// # Safety
/// `context` must be the third argument of a signal handler.
unsafe fn program_counter(context: *mut c_void) -> usize {
    // SAFETY: the kernel passes a context of this type to signal handlers.
    let context = unsafe { &(*context.cast::<libc::ucontext_t>()).uc_mcontext };
    #[cfg(target_arch = "x86_64")]
    return context.gregs[libc::REG_RIP as usize] as usize;
    #[cfg(target_arch = "aarch64")]
    return context.pc as usize;
}
