//! The C interface of yoro: what `include/yoro.h` declares, and nothing else.
//!
//! No panic, no abort and no global state leaves this library: every function catches panics at its border and returns
//! a [`YoroResult`]. Structures begin with their size, so that programs and libraries of different versions agree
//! (`versioned.rs`).
//!
//! The documentation of the items is that of the header, and speaks C. The header has them in the order of these modules.

// What the caller has to see to stands in the header, at @pre.
#![allow(clippy::missing_safety_doc)]

mod result;

mod types;

mod views;

mod eyes;
mod matrices;

mod context;

mod gl;

#[cfg(feature = "vulkan")]
mod vulkan;

mod versioned;

pub use context::*;
pub use eyes::*;
pub use gl::*;
pub use matrices::*;
pub use result::*;
pub use types::*;
pub use views::*;
#[cfg(feature = "vulkan")]
pub use vulkan::*;
