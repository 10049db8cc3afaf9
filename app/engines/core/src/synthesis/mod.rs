//! Takes the colour and depth of one eye, and draws the other eye: what all graphics interfaces share.
//!
//! `yoro::opengl`, `yoro::vulkan` and the crate `yoro-wgpu` each have three pipelines. Each consists of three fragment passes: tile bounds, tile spans, march.
//!
//! | pipeline | from a source to | the march goes along |
//! |---|---|---|
//! | `Gather` | a parallel eye, by a [`Warp`](crate::eyes::Warp) | the source's row |
//! | `AnyView` | a view in any pose near it, by a [`PoseWarp`](crate::eyes::PoseWarp) | a segment of any direction |
//! | `Motion` | a parallel eye, by a [`MotionWarp`](crate::eyes::MotionWarp): motion vectors instead of colour | the source's row |
//!
//! A `Composer` makes an eye from the [levels](crate::eyes::StereoViews) of a foveated view, in one pass.

pub mod backend;
mod error;
mod forward;
mod levels;
mod source_map;
mod uniforms;

pub use error::ArgumentError;
pub use levels::LevelPlaces;
pub use source_map::{SOURCE_MAP_FIXED, SOURCE_MAP_HOLE, SourceMapEntry};
pub use uniforms::{LevelUniforms, PoseUniforms, Uniforms};
