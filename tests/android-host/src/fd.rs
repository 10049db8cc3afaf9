//! File descriptors that belong to the host rather than to the application.

use std::os::fd::{AsRawFd, FromRawFd, OwnedFd, RawFd};

/// An eventfd, which is readable between [`EventFd::signal`] and [`EventFd::clear`].
pub struct EventFd(OwnedFd);

impl EventFd {
    /// Creates an eventfd that is not readable.
    ///
    /// # Panics
    /// Panics if the process has no file descriptors left.
    pub fn new() -> Self {
        // SAFETY: eventfd takes no pointers.
        let fd = unsafe { libc::eventfd(0, libc::EFD_NONBLOCK | libc::EFD_CLOEXEC) };
        assert!(fd >= 0, "eventfd: {}", std::io::Error::last_os_error());
        // SAFETY: the descriptor was just created and has no other owner.
        Self(unsafe { OwnedFd::from_raw_fd(fd) })
    }

    /// Returns the descriptor, for `poll`.
    pub fn raw(&self) -> RawFd {
        self.0.as_raw_fd()
    }

    /// Makes it readable.
    pub fn signal(&self) {
        let one = 1u64;
        // SAFETY: reads eight bytes from a live u64. Only fails if the counter is full, and then it is readable anyway.
        unsafe { libc::write(self.raw(), (&raw const one).cast(), 8) };
    }

    /// Makes it unreadable.
    pub fn clear(&self) {
        let mut count = 0u64;
        // SAFETY: writes eight bytes to a live u64. Only fails if the counter is zero.
        unsafe { libc::read(self.raw(), (&raw mut count).cast(), 8) };
    }
}
