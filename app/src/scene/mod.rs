//! What is looked at: models, files, built-in scenes, camera paths.

pub mod model;

pub use model::*;
