//! Which frames `yoro bench shader-cost --frame` records, for the estimate of their cost on GPUs that are not available
//! here.

use super::contender::Contender;
use yoro_render::stereo::{Method, Pipeline};

/// The suite's name in conditions.
pub const SUITE: &str = "shader-cost-frame";

/// Returns the methods that are recorded.
pub fn contenders() -> Vec<Contender> {
    vec![
        Contender::CONVENTIONAL,
        Contender::Method(Method::Instanced),
        Contender::Method(Method::Hybrid),
        Contender::Method(Method::ShadingReprojection),
        Contender::MONO,
        Contender::Synthesized(Pipeline::Gather),
    ]
}
