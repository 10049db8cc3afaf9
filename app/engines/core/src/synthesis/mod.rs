//! Draws the other eye from the colour and depth of one eye: what all graphics interfaces share.
//!
//! `yoro::opengl`, `yoro::vulkan` and the crate `yoro-wgpu` each have three pipelines, which consist of three fragment
//! passes: the bounds of each tile of the source, the span of each tile of the target, and the march.
//!
//! | pipeline | draws | the march follows |
//! |---|---|---|
//! | `Gather` | a parallel eye, from a [`Warp`](crate::eyes::Warp) | the source's row |
//! | `AnyView` | a view in any pose nearby, from a [`PoseWarp`](crate::eyes::PoseWarp) | a segment of any direction |
//! | `Motion` | a parallel eye's motion vectors, from a [`MotionWarp`](crate::eyes::MotionWarp) | the source's row |
//!
//! A `Composer` combines the layers of [`StereoViews`](crate::eyes::StereoViews) into the eye that is shown, in one pass.

pub mod backend;
mod error;
mod forward;
mod holes;
mod levels;
mod source_map;
mod uniforms;

pub use error::ArgumentError;
pub use holes::{HoleMark, Holes};
pub use levels::LevelPlaces;
pub use source_map::{SOURCE_MAP_FIXED, SOURCE_MAP_HOLE, SourceMapEntry};
pub use uniforms::{LevelUniforms, PoseUniforms, Uniforms};
