//! A GPU fence: waits until the GPU has finished earlier commands.

use std::rc::Rc;
use std::time::Duration;

use glow::HasContext as _;
use yoro_gl::Context;

/// The longest wait for a frame. A GPU that is slower may have hung or lost its context.
const TIMEOUT: Duration = Duration::from_millis(250);

/// A point in the GPU's command stream.
pub(super) struct Fence {
    gl: Rc<Context>,
    place: Option<glow::Fence>,
}

impl Fence {
    /// Creates a fence that is not set: waiting for it returns at once.
    pub fn new(gl: &Rc<Context>) -> Fence {
        Fence { gl: gl.clone(), place: None }
    }

    /// Sets the fence after all commands issued so far.
    pub fn set(&mut self) {
        self.clear();
        // SAFETY: the viewer requires the context to be current; the arguments are the only valid ones.
        let place = unsafe { self.gl.raw().fence_sync(glow::SYNC_GPU_COMMANDS_COMPLETE, 0) };
        // A driver that is out of memory returns no fence, and then there is nothing to wait for.
        self.place = place.ok().filter(|place| !place.0.is_null());
    }

    /// Flushes all commands issued so far and waits until the GPU has passed the fence.
    pub fn wait(&mut self) {
        if let Some(place) = self.place {
            // SAFETY: the context is current, and the fence was made in it and not deleted.
            let _ = unsafe {
                self.gl.raw().client_wait_sync(
                    place,
                    glow::SYNC_FLUSH_COMMANDS_BIT,
                    TIMEOUT.as_nanos() as i32,
                )
            };
            self.clear();
        }
    }

    fn clear(&mut self) {
        if let Some(place) = self.place.take() {
            // SAFETY: as in `wait`; the fence is deleted only once.
            unsafe { self.gl.raw().delete_sync(place) };
        }
    }
}

impl Drop for Fence {
    fn drop(&mut self) {
        self.clear();
    }
}
