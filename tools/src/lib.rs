//! What maintainers run, and what `cargo xtask` shares with it: shader compilers for mobile GPUs, a stand-in for the Android
//! NDK, and programs for tests that come from Debian's packages.
//!
//! It takes the workspace's sources and Debian's packages, and leaves folders below `target`. It runs cargo and other
//! programs, and must never know the project's other crates.

pub mod apt;
pub mod arm64;
pub mod cargo;
pub mod folders;
pub mod hello_xr;
pub mod monado;
pub mod ndk;
pub mod packages;
pub mod rust;
pub mod shader_cost;
