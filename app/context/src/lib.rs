//! GL contexts: of EGL without a window, of OSMesa, or on the window of an Android activity.
//!
//! Opens a context, which is current on the opening thread until it and all objects in it are dropped. Platform
//! differences end here. This crate must never know what is drawn.

#[cfg(target_os = "android")]
pub mod android;
#[cfg(not(target_os = "android"))]
mod egl;
mod graphics;
#[cfg(not(target_os = "android"))]
mod headless;
#[cfg(not(target_os = "android"))]
mod osmesa;

pub use graphics::{Binding, Graphics};
#[cfg(not(target_os = "android"))]
pub use headless::{Backend, ContextError, Headless, HeadlessGraphics};
