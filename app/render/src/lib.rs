//! Frames to synthesize from, and every way to make two eyes of them.
//!
//! [`Renderer`] draws one view of a scene to colour and depth; [`stereo`] has the methods, a file for each
//! kind: two real renders, single-pass stereo, hybrid, shading reprojection, mono, and synthesis.
//!
//! This crate must never know where a GL context comes from, what a viewer's lenses do, or how a result is measured.

#[cfg(test)]
mod fixture;
mod prepared;
mod render;
pub mod stereo;

pub use prepared::PreparedScene;
pub use render::{
    DeferredRenderer, DepthCopy, DepthImage, ForwardRenderer, Fxaa, GpuScene, MAX_POINT_LIGHTS, MSAA,
    RenderSettings, RenderedView, Renderer, RendererKind, Selection, ViewTargets,
};
