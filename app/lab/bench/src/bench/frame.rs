//! Which frames `yoro bench shader-cost --frame` records, for the estimate of their cost on GPUs that are not available
//! here.

use super::contender::Contender;
use super::job::{Job, Measure, Source};
use yoro_assets::ShadingStyle;
use yoro_gl::Capabilities;
use yoro_render::stereo::{Method, Pipeline};
use yoro_scenes::BUILTINS;

/// The suite's name in conditions.
pub const SUITE: &str = "shader-cost-frame";

/// The labels of frames with and without bloom.
pub const LABELS: [(&str, bool); 2] = [("bloom", true), ("no bloom", false)];

/// Returns the methods that are recorded.
pub fn contenders() -> Vec<Contender> {
    vec![
        Contender::CONVENTIONAL,
        Contender::Method(Method::Instanced),
        Contender::Synthesized(Pipeline::Gather),
    ]
}

/// Takes away what phones' drivers do not need: a renderer that cannot read samples carries depth through their average,
/// as it does where they live in tiles.
pub fn limit(capabilities: &mut Capabilities) {
    capabilities.multisample_textures = false;
}

/// True if the frames of a job are recorded with [limited](limit) capabilities. Outlines need all samples, which phones
/// read by OpenGL ES 3.1.
pub fn is_limited(job: &Job) -> bool {
    let builtin = BUILTINS.iter().find(|b| matches!(&job.source, Source::Named(name) if name == b.name));
    let style = job.style.or(builtin.map(|builtin| builtin.style));
    job.measure == Measure::WholeFrames && style != Some(ShadingStyle::Anime)
}
