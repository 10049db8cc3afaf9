//! The page's modules: every method in a browser's WebGL 2, and RGBD videos.
//!
//! The feature `page` is the page. It takes a canvas's context, packed scenes, pictures and choices as JSON, and draws.
//! The page's own JavaScript (`app/vr/web/page`) handles the elements, the sensors and WebXR. A worker generates scenes
//! and decodes files with the functions of `work`; `Page` draws on the canvas. Every error that JavaScript receives is a
//! sentence for the page.
//!
//! The feature `video` alone is a second, small module, which the page loads when a video is dropped: `Video` says where
//! its pictures are and what they show.
//!
//! The modules must not depend on HTML or request anything from a server.

#[cfg(feature = "page")]
mod explain;
#[cfg(all(feature = "page", target_arch = "wasm32"))]
mod page;
#[cfg(feature = "page")]
mod pictures;
#[cfg(feature = "page")]
mod psnr;
#[cfg(feature = "page")]
mod sensors;
#[cfg(feature = "page")]
mod settings;
#[cfg(all(feature = "video", target_arch = "wasm32"))]
mod video;
#[cfg(feature = "page")]
mod views;
#[cfg(feature = "page")]
mod walker;
#[cfg(feature = "page")]
mod wiggle;

#[cfg(all(feature = "page", target_arch = "wasm32"))]
pub use page::Page;
#[cfg(all(feature = "video", target_arch = "wasm32"))]
pub use video::Video;
#[cfg(feature = "page")]
pub use {
    explain::{Explanation, Frame},
    pictures::{Encoding, PictureError, PictureOptions, PicturePair, SourceEye},
    psnr::psnr,
    sensors::{Head, find_viewer, orientation},
    settings::{Display, Settings},
    views::{VIEW_FLOATS, view},
    walker::Walker,
    wiggle::wiggle,
};
