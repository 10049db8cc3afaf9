//! Renders one view of a scene to colour and depth, deferred or forward.
//!
//! Deferred: sun shadow map (once per scene, or whenever something moves) -> g-buffer -> ambient occlusion -> lighting
//! -> bloom -> tone mapping. [`Fxaa`] and transparent surfaces ([`DeferredRenderer::draw_transparent`]) are applied to
//! the finished image of each eye, after synthesis.
//!
//! Forward, with several samples in each pixel: sun shadow map -> lit surfaces -> average of the samples -> bloom and
//! outlines. After synthesis, drawing resumes in the same samples ([`ForwardRenderer::resume_samples`]).

mod bloom;
mod cluster;
mod common;
mod deferred;
mod depth_copy;
mod forward;
mod forward_passes;
mod forward_targets;
#[cfg(test)]
mod forward_tests;
mod fxaa;
mod g_buffer;
mod geometry;
mod light_tiles;
mod lighting;
mod lights;
mod moving;
#[cfg(test)]
mod moving_tests;
mod read_back;
mod renderer;
mod request;
mod role;
mod scene;
mod settings;
mod shadow;
mod ssao;
#[cfg(test)]
mod tests;
mod tonemap;
mod transparent;
mod uniforms;
mod view;

pub use cluster::Selection;
pub use deferred::DeferredRenderer;
pub(crate) use deferred::{FinishTargets, LightTargets};
pub use depth_copy::DepthCopy;
pub use forward::ForwardRenderer;
pub(crate) use forward_targets::ForwardTargets;
pub use fxaa::Fxaa;
pub(crate) use g_buffer::{GBuffer, Layout, Seam};
pub(crate) use geometry::Part;
pub use read_back::{DepthReader, ViewReader};
pub(crate) use renderer::RendererOfKind;
pub use renderer::{RenderedView, Renderer, ViewTargets};
pub(crate) use request::{Columns, DrawRequest, of_columns};
pub(crate) use role::{Reprojection, Role, RoleKind};
pub use scene::GpuScene;
pub use settings::{MAX_POINT_LIGHTS, MSAA, RenderSettings, RendererKind};
pub use transparent::DepthImage;
pub(crate) use uniforms::depth_test;
pub(crate) use view::{ViewImages, ViewRenderer};
