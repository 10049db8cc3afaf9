//! The page's module: every method in a browser's WebGL 2.
//!
//! It takes a canvas's context, packed scenes, pictures and choices as JSON, and draws. The page's own JavaScript
//! (`app/vr/web/page`) handles the elements, the sensors and WebXR. A worker generates scenes and decodes files with the
//! functions of `work`; `Page` draws on the canvas. Every error that JavaScript receives is a sentence for the page.
//!
//! The module must not depend on HTML or request anything from a server.

mod explain;
#[cfg(target_arch = "wasm32")]
mod page;
mod pictures;
mod psnr;
mod sensors;
mod settings;
mod views;
mod walker;
mod wiggle;

pub use explain::{Explanation, Frame};
#[cfg(target_arch = "wasm32")]
pub use page::Page;
pub use pictures::{Encoding, PictureError, PictureOptions, PicturePair, SourceEye};
pub use psnr::psnr;
pub use sensors::{Head, find_viewer, orientation};
pub use settings::{Display, Settings};
pub use views::{VIEW_FLOATS, view};
pub use walker::Walker;
pub use wiggle::wiggle;
