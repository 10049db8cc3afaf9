//! yoro on Android: the library that `NativeActivity` loads.
//!
//! It connects Android's window, sensors, touch input, settings and the state of battery and heat to [`yoro_viewer`],
//! which is the application itself. It must not depend on how eyes are synthesized or measured, except for
//! `measure::pictures`, which compares a driver's pictures with stored ones. What asks Android for something is in
//! `platform`; other systems build only the rest, and only for tests.

#![cfg(any(target_os = "android", test))]

mod frame_timing;
mod measure;
mod settings;
mod share;
mod touch;

#[cfg(target_os = "android")]
mod platform;
