//! The C interface of yoro: the functions and types of `include/yoro.h`, and nothing else.
//!
//! Takes pointers and handles from a C program, checks them, calls the core and returns a [`YoroResult`]. No panic and
//! no abort leaves this library, and it has no global state. It must not know anything that the core must not know, nor
//! anything that the header does not say.
//!
//! Structures begin with their size, so that programs and libraries of different versions are compatible
//! (`versioned.rs`). The doc comments of the items become the header, so they are written for C programmers. The header
//! lists the items in the order of these modules.

// The header states the caller's duties with @pre.
#![allow(clippy::missing_safety_doc)]

mod result;

mod types;

mod views;

mod eyes;
mod matrices;

mod context;

mod choice;
mod levels;
mod motion;
mod pose;

mod gl;

#[cfg(feature = "vulkan")]
mod vulkan;

mod versioned;

pub use choice::*;
pub use context::*;
pub use eyes::*;
pub use gl::*;
pub use levels::*;
pub use matrices::*;
pub use motion::*;
pub use pose::*;
pub use result::*;
pub use types::*;
pub use views::*;
#[cfg(feature = "vulkan")]
pub use vulkan::*;
