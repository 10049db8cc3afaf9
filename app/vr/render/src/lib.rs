//! The renderer and the stereo methods: frames to synthesize from, and every way to make two eyes of them.
//!
//! [`Renderer`] renders a view of a scene to colour and depth. A [`stereo::StereoSession`] renders both eyes of every
//! frame: by two renders, single-pass stereo, hybrid, shading reprojection, mono, or synthesis, with `yoro`'s pipeline or
//! the paper's.
//!
//! This crate must never know where a GL context comes from, what a viewer's lenses do, or how a result is measured.

#[cfg(test)]
mod fixture;
mod prepared;
pub mod stereo;
mod view;

pub use prepared::PreparedScene;
pub use view::{
    DepthCopy, DepthImage, DepthReader, DepthResolve, GpuScene, MAX_POINT_LIGHTS, MSAA, RenderSettings,
    RenderedView, Renderer, ViewReader, ViewTargets,
};
