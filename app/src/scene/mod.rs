//! What is looked at: models, files, built-in scenes, camera paths.

pub mod builtin;
pub mod model;

pub use model::*;
