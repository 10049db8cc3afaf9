//! GL contexts: without a window by EGL or OSMesa, or on the window of an Android activity.
//!
//! A context is current on the thread that opened it until it and all objects in it are dropped. Platform differences
//! end here. This crate does not know what is drawn.

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
