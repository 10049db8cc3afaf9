//! Takes the colour and depth of one eye, and draws the other eye.
//!
//! On OpenGL (feature `gl`), [`create`] compiles a pipeline, which takes two textures, a [`Warp`](crate::eyes::Warp)
//! and a framebuffer; `examples/engine.rs` uses it in a separate engine. The same passes are in `yoro::vulkan` for
//! Vulkan, and in the crate `yoro-wgpu` for wgpu.
//!
//! | pipeline | for | passes, all fragment shaders | needs |
//! |---|---|---|---|
//! | `Gather` | [`Edges::Hard`] | tile bounds, tile spans, march | ES 3.0 |
//! | `Layers` | anti-aliased sources | split, tile bounds, tile spans, march | ES 3.0, [`Edges::Multisample`] ES 3.1 |
//!
//! `AnyView` draws a view in any other pose near the source's, from hard edges, with a
//! [`PoseWarp`](crate::eyes::PoseWarp) instead of the warp. Its passes are tile bounds, tile spans and a march along a
//! segment of any direction. It needs ES 3.0, and is in `yoro::vulkan` and `yoro-wgpu`, too.

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
/// For crates that implement the passes on other graphics interfaces.
#[doc(hidden)]
pub use pass_set::PassSet;
pub use source_map::{SOURCE_MAP_FIXED, SOURCE_MAP_HOLE, SourceMapEntry};
/// For crates that implement the passes on other graphics interfaces.
#[doc(hidden)]
pub use uniforms::{Places, WarpKind, span_tiles, tiles};
pub use uniforms::{PoseUniforms, Uniforms};
