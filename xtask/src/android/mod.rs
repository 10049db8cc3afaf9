//! The Android application: its toolchain, its build, and the check of the result.

mod build;
mod cargo_apk;
pub mod check;
mod keystore;
mod library;
mod loader;
mod manifest;
mod pack;
mod toolchain;

pub use build::{Options, apk, ready_for_tests};
pub use library::{API as LIBRARY_API, cargo as library_cargo};
pub use toolchain::doctor;
