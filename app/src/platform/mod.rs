//! What differs by machine: where a GL context comes from.

#[cfg(target_os = "android")]
pub mod android;
#[cfg(feature = "desktop")]
mod egl;
#[cfg(feature = "desktop")]
mod headless;
pub mod openxr;
#[cfg(feature = "desktop")]
mod osmesa;

#[cfg(feature = "desktop")]
pub use headless::{Backend, Headless, PlatformError};
