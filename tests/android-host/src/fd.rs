//! File descriptors owned by the host, beside those of the application.

use std::os::fd::{AsRawFd, FromRawFd, OwnedFd, RawFd};

/// An eventfd: readable after [`EventFd::signal`] until [`EventFd::clear`].
pub struct EventFd(OwnedFd);

impl EventFd {
    /// Makes one that is not readable.
    ///
    /// # Panics
    /// The process has no file descriptor left.
    pub fn new() -> Self {
        // SAFETY: eventfd takes no pointers.
        let fd = unsafe { libc::eventfd(0, libc::EFD_NONBLOCK | libc::EFD_CLOEXEC) };
        assert!(fd >= 0, "eventfd: {}", std::io::Error::last_os_error());
        // SAFETY: fd was just made and belongs to nobody else.
        Self(unsafe { OwnedFd::from_raw_fd(fd) })
    }

    /// Returns the descriptor, for `poll`.
    pub fn raw(&self) -> RawFd {
        self.0.as_raw_fd()
    }

    /// Makes it readable.
    pub fn signal(&self) {
        let one = 1u64;
        // SAFETY: eight bytes are read from a live u64. It fails only when the counter is full, and then it is
        // readable.
        unsafe { libc::write(self.raw(), (&raw const one).cast(), 8) };
    }

    /// Makes it unreadable.
    pub fn clear(&self) {
        let mut count = 0u64;
        // SAFETY: eight bytes are written to a live u64. It fails only when the counter is zero.
        unsafe { libc::read(self.raw(), (&raw mut count).cast(), 8) };
    }
}
