//! The Android application: its toolchain, its build, and the check of the result.

mod build;
pub mod check;
mod keystore;
mod library;
mod manifest;
mod pack;
mod toolchain;

pub use build::{Options, apk, apk_for_tests, ready_for_tests};
pub use library::{API as LIBRARY_API, cargo as library_cargo};
pub use toolchain::doctor;
