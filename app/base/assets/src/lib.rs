//! Scenes: models with materials and lights, their files, and camera paths.
//!
//! [`load()`] reads OBJ, glTF and GLB files with their textures and sidecar files. [`export()`] writes a scene as
//! files. Missing parts are generated or replaced by defaults, with a warning that names the file. This crate must
//! never know OpenGL, or which scenes are built in.

mod defaults;
mod error;
pub mod export;
#[cfg(test)]
mod file_tests;
mod gltf;
#[cfg(test)]
mod gltf_tests;
pub mod load;
pub mod model;
pub mod motion;
#[cfg(test)]
mod motion_tests;
mod mtl;
mod obj;
mod palette;
pub mod path;
mod polygon;
mod rays;
mod repair;
mod scene;
mod textures;

pub use error::SceneError;
pub use export::export;
pub use load::{load, load_animated};
pub use model::*;
pub use motion::{Jumps, Moment, Motion};
pub use path::CameraPath;
pub use scene::Scene;
