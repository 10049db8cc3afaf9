//! What is looked at: models, files, built-in scenes, camera paths.

pub mod builtin;
mod defaults;
mod error;
#[cfg(feature = "desktop")]
pub mod export;
#[cfg(all(test, feature = "desktop"))]
mod file_tests;
pub mod gltf;
pub mod load;
pub mod model;
mod mtl;
pub mod obj;
pub mod path;
mod polygon;
mod rays;
mod repair;
mod textures;

pub use error::SceneError;
#[cfg(feature = "desktop")]
pub use export::export;
pub use load::load;
pub use model::*;
pub use path::CameraPath;
