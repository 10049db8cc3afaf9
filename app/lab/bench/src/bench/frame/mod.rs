//! The cost of whole stereo frames on mobile GPUs that are not available here: `yoro bench shader-cost --frame`.
//!
//! A frame is rendered here and [recorded](yoro_gl::Context::record): its passes, their images, and the number of
//! samples that pass each depth test. `costs` has what Mesa's compilers make of each shader, `traffic` what a
//! tile-based GPU moves between its tiles and memory, `lamps` the number of lights that a wave computes, and the module
//! `executed` what the synthesis executes. `model` adds these up.

mod lamps;
mod model;
mod pass_table;
mod traffic;

use super::contender::Contender;
use super::executed::Device;
use yoro_render::RendererKind;
use yoro_render::stereo::{Method, Pipeline};

pub use lamps::Lamps;
pub use model::{FrameModel, SYNTHESIS, VERTICES, VERTICES_ONCE};
pub use pass_table::pass_table;
pub use traffic::{Piece, Traffic, pieces};

/// The suite's name in settings.
pub const SUITE: &str = "shader-cost-frame";
/// The size of an eye in pixels, as on a Quest 3.
pub const SIZE: [u32; 2] = [1680, 1760];
/// The contender derived from the record of [`Method::Instanced`], which draws the same pixels and differs only in
/// vertices.
pub const MULTIVIEW: &str = "multiview";

/// The GPUs. Their rates are assumptions from public figures.
pub const GPUS: [Device; 5] = [
    super::executed::DEVICES[0],
    super::executed::DEVICES[1],
    // Two cores with 24 lanes each at 0.85 GHz, and 32-bit LPDDR4X.
    Device { name: "mali-g52", gpu: "g52", size: [1200, 1080], slots: 0.041e12, fetches: 3.4e9, bytes: 13e9 },
    super::executed::DEVICES[2],
    // Six cores with 64 lanes each at 0.86 GHz, and 64-bit LPDDR5.
    Device { name: "mali-g610", gpu: "g610", size: [1200, 1080], slots: 0.33e12, fetches: 41e9, bytes: 51e9 },
];

/// Returns the methods that are recorded.
pub fn contenders(renderer: RendererKind) -> Vec<Contender> {
    let mut contenders = vec![
        Contender::CONVENTIONAL,
        Contender::Method(Method::Instanced),
        Contender::Method(Method::Hybrid),
    ];
    // Only the deferred renderer has it.
    if renderer == RendererKind::Deferred {
        contenders.push(Contender::Method(Method::ShadingReprojection));
    }
    contenders.extend([Contender::MONO, Contender::Synthesized(Pipeline::Gather)]);
    contenders
}
