//! The C interface of yoro: the functions and types of `include/yoro.h`, and nothing else.
//!
//! Takes pointers and handles of a program in C, checks them, and calls the core; returns a [`YoroResult`]. No panic
//! and no abort leaves this library, and it has no global state. It must never know what the core must not, nor
//! anything that the header does not say.
//!
//! Structures begin with their size, so that programs and libraries of different versions agree (`versioned.rs`). The
//! documentation of the items becomes the header, so it speaks C. The header has them in the order of these modules.

// The header states the caller's duties at @pre.
#![allow(clippy::missing_safety_doc)]

mod result;

mod types;

mod views;

mod eyes;
mod matrices;

mod context;

mod choice;
mod history;
mod pose;

mod gl;

#[cfg(feature = "vulkan")]
mod vulkan;

mod versioned;

pub use choice::*;
pub use context::*;
pub use eyes::*;
pub use gl::*;
pub use history::*;
pub use matrices::*;
pub use pose::*;
pub use result::*;
pub use types::*;
pub use views::*;
#[cfg(feature = "vulkan")]
pub use vulkan::*;
