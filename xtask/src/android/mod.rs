//! The Android application: what builds it, the building, and the check of the result.

mod arm64;
mod build;
mod cargo_apk;
pub mod check;
mod keystore;
mod library;
mod loader;
mod manifest;
mod pack;
mod stand_in;
mod symbols;
mod target;
mod toolchain;

pub use arm64::{Host, TRIPLE as ARM64_TRIPLE, cargo as arm64_cargo};
pub use build::{Options, Panic, anonymous_paths, apk, build_std, ready_for_tests, use_rust};
pub use library::{API as LIBRARY_API, cargo as library_cargo};
pub use target::{ARCHITECTURES, Architecture};
pub use toolchain::{Rust, Surroundings, doctor};
