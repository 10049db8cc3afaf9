//! `XR_APILAYER_YORO_one_view`: an OpenXR API layer between an application that renders one view and a runtime that shows
//! two.
//!
//! The application is offered the view configuration PRIMARY_MONO: one view, at the dominant eye's pose, that sees what
//! both eyes see. What it submits in xrEndFrame, colour with depth (XR_KHR_composition_layer_depth), is cropped for the
//! dominant eye, without a copy, and synthesized for the other one. Applications on Vulkan (XR_KHR_vulkan_enable and
//! enable2), OpenGL (XR_KHR_opengl_enable by Xlib or EGL) and OpenGL ES (XR_KHR_opengl_es_enable); for all others, and for
//! those that begin PRIMARY_STEREO, everything passes through; unless the setting `shrink` has them render one of two views
//! tiny, which is replaced.
//!
//! Whatever fails here does not fail the application: such a frame shows the same image to both eyes, the log says why
//! once, and counts.
//!
//! * `entry`: the functions that loader and application call; no panic leaves them.
//! * `dispatch`: those of the next layer or of the runtime.
//! * `instance`, `session`, `swapchain`: what is known of the application's objects.
//! * `frame`: xrEndFrame.
//! * `geometry`: the offered view, and the parts of a submitted one.
//! * `graphics`: synthesis, whatever the application draws with: `vulkan`, on its device and queue, and `gl`, in its
//!   context.

mod capture;
mod dispatch;
mod entry;
mod frame;
mod geometry;
mod gl;
mod graphics;
mod instance;
pub mod log;
mod manifest;
mod reason;
mod session;
pub mod settings;
mod swapchain;
mod vulkan;
pub mod xdg;

use std::sync::{Mutex, MutexGuard, PoisonError};

use log::say;

pub use entry::xrNegotiateLoaderApiLayerInterface;
pub use manifest::{DISABLE, ENABLE, Kind, MANIFEST, NAME, manifest};

/// What a panic elsewhere has left is as good as before: nothing is changed in two steps.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
