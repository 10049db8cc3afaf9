//! OpenXR: head-mounted displays.

pub mod runtime;
