//! A fence: waits until the GPU has finished earlier commands.

use std::rc::Rc;
use std::time::Duration;

use glow::HasContext as _;
use yoro_gl::Context;

/// The longest wait for a frame: a slower GPU may have hung, or lost its context.
const TIMEOUT: Duration = Duration::from_millis(250);

/// A place in the stream of the GPU's commands.
pub(super) struct Fence {
    gl: Rc<Context>,
    place: Option<glow::Fence>,
}

impl Fence {
    /// Makes a fence that nothing waits for yet.
    pub fn new(gl: &Rc<Context>) -> Fence {
        Fence { gl: gl.clone(), place: None }
    }

    /// Puts the fence behind the commands so far.
    pub fn set(&mut self) {
        self.clear();
        // SAFETY: the context is current, by the contract of the viewer; the arguments are the only ones that there are.
        let place = unsafe { self.gl.raw().fence_sync(glow::SYNC_GPU_COMMANDS_COMPLETE, 0) };
        // A driver without memory gives none, and then nothing is waited for.
        self.place = place.ok().filter(|place| !place.0.is_null());
    }

    /// Makes the GPU begin with all commands so far, and waits until it has passed the fence.
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
            // SAFETY: as in `wait`; deleted once.
            unsafe { self.gl.raw().delete_sync(place) };
        }
    }
}

impl Drop for Fence {
    fn drop(&mut self) {
        self.clear();
    }
}
