//! Renders views of a scene to colour and depth.

mod bloom;
mod carry;
mod cluster;
mod coverage;
mod depth;
mod geometry;
mod holes;
mod layout;
mod light_tiles;
mod lights;
mod lit;
mod moving;
#[cfg(test)]
mod moving_tests;
mod passes;
#[cfg(test)]
mod picture_tests;
mod read_back;
mod rectangle;
mod renderer;
mod scene;
mod settings;
mod shadow;
mod targets;
#[cfg(test)]
mod tests;
mod transparent;
mod uniforms;
mod vectors;
#[cfg(test)]
mod vectors_tests;

pub(crate) use depth::DepthProgram;
pub use depth::{DepthCopy, DepthImage, DepthResolve};
pub(crate) use holes::{HoleSource, InkedHoles, MARKED_DEPTH};
pub(crate) use layout::{Layout, Seam};
pub(crate) use lit::LitScene;
pub(crate) use passes::{Known, Reprojection};
pub use read_back::{DepthReader, ViewReader};
pub(crate) use rectangle::{Rectangle, Region};
pub use renderer::{RenderedView, Renderer, ViewTargets};
pub use scene::GpuScene;
pub use settings::{MAX_POINT_LIGHTS, MSAA, RenderSettings};
pub(crate) use targets::Targets;
pub(crate) use vectors::{RenderedDepth, Step, VectorPass};
