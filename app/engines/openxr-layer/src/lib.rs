//! `XR_APILAYER_YORO_one_view`: an OpenXR API layer that gives stereo to applications that render one view.
//!
//! The layer offers applications the view configuration PRIMARY_MONO: one view at the dominant eye's pose that contains
//! what both eyes see. In xrEndFrame it reads this view's colour and depth, and submits two views to the runtime: the
//! dominant eye's view is a part of the application's image, without a copy, and the other is synthesized. The layer
//! must not depend on a scene, a window or a renderer, and must not fail a call that would succeed without it.
//!
//! It serves applications on Vulkan (XR_KHR_vulkan_enable and enable2), OpenGL (XR_KHR_opengl_enable with Xlib or EGL)
//! and OpenGL ES (XR_KHR_opengl_es_enable). It passes on the calls of all others, and of those that begin their session
//! with PRIMARY_STEREO. With the setting `shrink`, it recommends a tiny size to the latter for one of the two views and
//! replaces that view; of four views with a foveated inset for each eye, it replaces both of one eye. When a frame cannot
//! be synthesized, both eyes see the same image. The log gives each reason once, and counts such frames.
//!
//! * `entry`: the functions that the loader and the application call.
//! * `objects`: the application's instances, sessions and swapchains, and the order of locks.
//! * `frame`: xrEndFrame.
//! * `session`, `swapchain`, `instance`: one object each. `dispatch`: the functions of the next layer or the runtime.
//! * `geometry`: the offered view, and how a submitted view is split. `mirror`: the same for flipped images.
//! * `sizes`: the offered view's size, remembered from one start to the next.
//! * `binding`: the graphics interface of a session. `synthesizer`: the synthesis, implemented by `vulkan`, on the
//!   application's device and queue, and by `gl`, in its context.

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
mod xdg;

use std::sync::{Mutex, MutexGuard, PoisonError};

use log::log_line;

pub use entry::xrNegotiateLoaderApiLayerInterface;
pub use manifest::{DISABLE, ENABLE, Kind, MANIFEST, NAME, manifest};

/// Locks a mutex, even after a panic: no change takes more than one step, so the data is valid after a panic.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
