//! What is looked at: models with materials and lights, the files that they come from, camera paths.
//!
//! [`load()`] reads OBJ, glTF and GLB with what lies beside them; [`export()`] writes a scene as files. What is missing is
//! generated or replaced by a default, with a warning that names the file.
//!
//! This crate must never know OpenGL, or which scenes are built in.

mod defaults;
mod error;
pub mod export;
#[cfg(test)]
mod file_tests;
mod gltf;
pub mod load;
pub mod model;
mod mtl;
mod obj;
mod palette;
pub mod path;
mod polygon;
mod rays;
mod repair;
mod textures;

pub use error::SceneError;
pub use export::export;
pub use load::load;
pub use model::*;
pub use path::CameraPath;
