//! The application's instances, sessions and swapchains by their handles. They are kept here and nowhere else.
//!
//! References point upwards only: a session holds its instance, a swapchain its instance and the handle of its session.
//! So an object is freed when it was removed here and its last call has ended.
//!
//! # Locks
//! A thread that holds one of these locks takes only locks further down:
//!
//! 1. [`LiveSession::frames`]: the layer's own work in xrEndFrame, and forgetting images.
//! 2. The state of a swapchain (`swapchain.rs`): which images are acquired. The runtime's acquire and release are
//!    called under it, so that both sides agree on the order.
//! 3. The registry below, `Session::offer`, `Session::begun`, `Instance::sizes` and the log's file: held for a look or
//!    a change. No other lock is taken and no function of the runtime is called under them.
//!
//! No lock is held while the runtime waits for the display or the compositor: in xrWaitFrame, in the application's
//! xrWaitSwapchainImage and in the runtime's xrEndFrame. The layer waits for its own images under the first lock, half
//! a second at most.

use std::sync::{Arc, Mutex};

use openxr_sys as sys;
use smallvec::SmallVec;

use crate::frame::Frames;
use crate::instance::Instance;
use crate::lock;
use crate::session::Session;
use crate::swapchain::Swapchain;

/// A session, and what xrEndFrame keeps from frame to frame.
pub struct LiveSession {
    pub session: Session,
    pub frames: Mutex<Frames>,
}

/// There are few objects: a list is as fast as a map.
struct Objects {
    instances: Vec<Arc<Instance>>,
    sessions: Vec<Arc<LiveSession>>,
    swapchains: Vec<Arc<Swapchain>>,
}

static OBJECTS: Mutex<Objects> =
    Mutex::new(Objects { instances: Vec::new(), sessions: Vec::new(), swapchains: Vec::new() });

/// Returns a known instance.
pub fn instance(handle: sys::Instance) -> Option<Arc<Instance>> {
    lock(&OBJECTS).instances.iter().find(|instance| instance.handle == handle).cloned()
}

/// Returns the oldest instance, for handles whose instance is not known.
pub fn any_instance() -> Option<Arc<Instance>> {
    lock(&OBJECTS).instances.first().cloned()
}

/// Returns a known session.
pub fn session(handle: sys::Session) -> Option<Arc<LiveSession>> {
    lock(&OBJECTS).sessions.iter().find(|live| live.session.handle == handle).cloned()
}

/// Returns the sessions of an instance.
pub fn sessions_of(instance: sys::Instance) -> Vec<Arc<LiveSession>> {
    let objects = lock(&OBJECTS);
    objects.sessions.iter().filter(|live| live.session.instance.handle == instance).cloned().collect()
}

/// Returns a known swapchain.
pub fn swapchain(handle: sys::Swapchain) -> Option<Arc<Swapchain>> {
    lock(&OBJECTS).swapchains.iter().find(|swapchain| swapchain.handle == handle).cloned()
}

/// Returns the swapchains of a session; up to 16 without an allocation.
pub fn swapchains_of(session: sys::Session) -> SmallVec<[Arc<Swapchain>; 16]> {
    lock(&OBJECTS).swapchains.iter().filter(|swapchain| swapchain.session == session).cloned().collect()
}

pub fn add_instance(instance: Instance) {
    lock(&OBJECTS).instances.push(Arc::new(instance));
}

pub fn add_session(session: Session) {
    lock(&OBJECTS).sessions.push(Arc::new(LiveSession { session, frames: Mutex::default() }));
}

pub fn add_swapchain(swapchain: Swapchain) {
    lock(&OBJECTS).swapchains.push(Arc::new(swapchain));
}

/// Removes an instance, whose sessions were removed before. Returns true if it was the last one.
pub fn remove_instance(handle: sys::Instance) -> bool {
    let instances = &mut lock(&OBJECTS).instances;
    instances.retain(|instance| instance.handle != handle);
    instances.is_empty()
}

/// Removes a session with its swapchains.
pub fn remove_session(handle: sys::Session) {
    let objects = &mut *lock(&OBJECTS);
    objects.swapchains.retain(|swapchain| swapchain.session != handle);
    objects.sessions.retain(|live| live.session.handle != handle);
}

/// Removes a swapchain.
pub fn remove_swapchain(handle: sys::Swapchain) {
    lock(&OBJECTS).swapchains.retain(|swapchain| swapchain.handle != handle);
}
