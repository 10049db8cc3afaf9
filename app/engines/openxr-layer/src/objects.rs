//! The application's instances, sessions and swapchains, found by their handles. They are kept only here.
//!
//! References point upwards only: a session holds its instance, and a swapchain holds its instance and the handle of
//! its session. So an object is freed once it has been removed here and the last call that uses it has ended.
//!
//! # Locks
//! While a thread holds one of these locks it takes only locks further down the list:
//!
//! 1. [`LiveSession::frames`]: for the layer's own work in xrEndFrame, and for forgetting images.
//! 2. The state of a swapchain (`swapchain.rs`): which images are acquired. The runtime's acquire and release are
//!    called while it is held, so that both sides agree on the order.
//! 3. The registry below, `Session::offer`, `Session::begun`, `Instance::sizes` and the log's file: held only for a
//!    look or a change. While one is held, no other lock is taken and no function of the runtime is called.
//!
//! No lock is held while the runtime waits for the display or the compositor: in xrWaitFrame, in the application's
//! xrWaitSwapchainImage and in the runtime's xrEndFrame. The layer waits for its own images while holding the first
//! lock, for half a second at most.

use std::sync::{Arc, Mutex};

use openxr_sys as sys;
use smallvec::SmallVec;

use crate::frame::Frames;
use crate::instance::Instance;
use crate::lock;
use crate::session::Session;
use crate::swapchain::Swapchain;

/// A session, and the state that xrEndFrame keeps between frames.
pub struct LiveSession {
    pub session: Session,
    pub frames: Mutex<Frames>,
}

/// The objects. There are few, so a list is as fast as a map.
struct Objects {
    instances: Vec<Arc<Instance>>,
    sessions: Vec<Arc<LiveSession>>,
    swapchains: Vec<Arc<Swapchain>>,
}

static OBJECTS: Mutex<Objects> =
    Mutex::new(Objects { instances: Vec::new(), sessions: Vec::new(), swapchains: Vec::new() });

/// Returns an instance, if it is known.
pub fn instance(handle: sys::Instance) -> Option<Arc<Instance>> {
    lock(&OBJECTS).instances.iter().find(|instance| instance.handle == handle).cloned()
}

/// Returns the oldest instance, for handles whose instance is unknown.
pub fn any_instance() -> Option<Arc<Instance>> {
    lock(&OBJECTS).instances.first().cloned()
}

/// Returns a session, if it is known.
pub fn session(handle: sys::Session) -> Option<Arc<LiveSession>> {
    lock(&OBJECTS).sessions.iter().find(|live| live.session.handle == handle).cloned()
}

/// Returns the sessions of an instance.
pub fn sessions_of(instance: sys::Instance) -> Vec<Arc<LiveSession>> {
    let objects = lock(&OBJECTS);
    objects.sessions.iter().filter(|live| live.session.instance.handle == instance).cloned().collect()
}

/// Returns a swapchain, if it is known.
pub fn swapchain(handle: sys::Swapchain) -> Option<Arc<Swapchain>> {
    lock(&OBJECTS).swapchains.iter().find(|swapchain| swapchain.handle == handle).cloned()
}

/// Returns the swapchains of a session. Up to 16 need no allocation.
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

/// Removes an instance whose sessions have been removed. Returns true if it was the last one.
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
