//! Builds for Android, with or without Google's SDK and NDK.

pub mod sdk;
pub mod stand_in;
pub mod symbols;
pub mod target;
