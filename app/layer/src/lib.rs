//! `XR_APILAYER_YORO_one_view`: an OpenXR API layer that gives stereo to applications that render one view.
//!
//! An application is offered the view configuration PRIMARY_MONO: one view at the dominant eye's pose that sees what
//! both eyes see. The layer takes colour and depth of it in xrEndFrame and submits two views to the runtime: the
//! dominant eye's is a part of the application's image, without a copy, and the other one's is synthesized. It must
//! never know a scene, a window or a renderer, and never fail a call that would succeed without it.
//!
//! It serves applications on Vulkan (XR_KHR_vulkan_enable and enable2), OpenGL (XR_KHR_opengl_enable by Xlib or EGL)
//! and OpenGL ES (XR_KHR_opengl_es_enable). For all others, and for those that begin PRIMARY_STEREO, everything passes
//! through; with the setting `shrink`, the latter are told to render one of two views tiny, and that one is replaced. A
//! frame that cannot be synthesized shows the same image to both eyes; the log gives each reason once, and counts.
//!
//! * `entry`: the functions that loader and application call.
//! * `objects`: the application's instances, sessions and swapchains, and the order of locks.
//! * `frame`: xrEndFrame.
//! * `session`, `swapchain`, `instance`: one object each. `dispatch`: the functions of the next layer or the runtime.
//! * `geometry`: the offered view, and the parts of a submitted one. `mirror`: those of flipped images.
//! * `sizes`: the offered view's size, from one start to the next.
//! * `binding`: the graphics interface of a session. `synthesizer`: the synthesis, implemented by `vulkan`, on the
//!   application's device and queue, and by `gl`, in its context.
//!
//! The feature `capture` adds what tests need: pictures of what the runtime gets, and a world that stands still.

mod binding;
mod dispatch;
mod entry;
mod frame;
mod geometry;
mod gl;
mod instance;
pub mod library;
pub mod log;
mod manifest;
mod mirror;
mod objects;
mod reason;
mod session;
pub mod settings;
pub mod sizes;
mod structures;
mod swapchain;
mod synthesizer;
mod vulkan;

use std::sync::{Mutex, MutexGuard, PoisonError};

use log::say;

pub use entry::xrNegotiateLoaderApiLayerInterface;
pub use manifest::{DISABLE, ENABLE, Kind, MANIFEST, NAME, manifest};

/// Locks a mutex, also after a panic: nothing is changed in two steps, so what a panic has left is sound.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
