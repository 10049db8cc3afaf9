//! Colour and depth of one eye in, the other eye out.
//!
//! On OpenGL (feature `gl`) [`create`] compiles a pipeline, which takes two textures, a [`Warp`](crate::eyes::Warp) and
//! a framebuffer; `examples/engine.rs` shows it in a foreign engine. On Vulkan the same passes are in `yoro::vulkan`,
//! on wgpu in the crate `yoro-wgpu`.
//!
//! | pipeline | for | passes, all fragment shaders | needs |
//! |---|---|---|---|
//! | `Gather` | [`Edges::Hard`] | tile bounds, tile spans, march | ES 3.0 |
//! | `Layers` | anti-aliased sources | split, tile bounds, tile spans, march | ES 3.0, [`Edges::Multisample`] ES 3.1 |
//!
//! `AnyView` draws a view in any other pose near the source's, from hard edges: tile bounds, tile spans and a march
//! along a segment of any direction, with a [`PoseWarp`](crate::eyes::PoseWarp) in place of the warp. It needs ES 3.0.
//! `yoro::vulkan` and `yoro-wgpu` have it, too.

mod edges;
mod forward;
mod history;
#[cfg(feature = "gl")]
mod opengl;
mod pass_set;
mod source_map;
mod uniforms;

pub use edges::Edges;
pub use history::Strips;
#[cfg(feature = "gl")]
pub use opengl::*;
/// For crates that have the passes on another graphics interface.
#[doc(hidden)]
pub use pass_set::PassSet;
pub use source_map::{SOURCE_MAP_FIXED, SOURCE_MAP_HOLE, SourceMapEntry};
/// For crates that have the passes on another graphics interface.
#[doc(hidden)]
pub use uniforms::{Places, WarpKind, span_tiles, tiles};
pub use uniforms::{PoseUniforms, Uniforms};
