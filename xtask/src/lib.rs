//! Maintainers' tools, and code shared with `cargo xtask`: shader compilers for mobile GPUs, a stand-in for the Android
//! NDK, and test programs from Debian packages.
//!
//! The inputs are the workspace's sources and Debian packages, the outputs are folders below `target`. This crate runs
//! cargo and other programs, and must not depend on the project's other crates.

pub mod apt;
pub mod arm64;
pub mod cargo;
pub mod compiled;
pub mod console;
pub mod folders;
pub mod godot;
pub mod hello_xr;
pub mod monado;
pub mod ndk;
pub mod packages;
pub mod rust;
pub mod shader_cost;
