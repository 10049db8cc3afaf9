//! What the tests of several crates share: pictures, pipelines on OpenGL to compare with, laws that every pipeline keeps,
//! a Vulkan device, a record of GPU commands, a browser, a model, and the shaders that are compiled in advance.
//!
//! No crate of the product may depend on it.

#![allow(missing_docs, reason = "read beside the tests that use it")]

pub mod against_opengl;
pub mod browser;
pub mod compiled;
pub mod composed;
pub mod glb;
pub mod harness;
pub mod in_memory;
pub mod laws;
pub mod modules;
pub mod posed;
pub mod record;
pub mod table;
