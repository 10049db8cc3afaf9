//! Which frames `yoro bench shader-cost --frame` records, for the estimate of their cost on GPUs that are not available
//! here.

use super::contender::Contender;
use yoro_render::RendererKind;
use yoro_render::stereo::{Method, Pipeline};

/// The suite's name in conditions.
pub const SUITE: &str = "shader-cost-frame";

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
