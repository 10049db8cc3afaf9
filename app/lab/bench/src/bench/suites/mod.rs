//! The experiments, one file each.

mod anti_aliasing;
mod complexity;
mod distance;
mod flicker;
mod foveation;
mod half_rate;
mod imbuffer;
mod ipd;
mod lights;
mod patchers;
mod reprojection;
mod resolution;
mod scenes;
mod stream;
mod styles;

use super::Experiment;

/// All experiments, in the order in which `all` runs them.
pub const EXPERIMENTS: [&dyn Experiment; 15] = [
    &scenes::Scenes,
    &complexity::Complexity,
    &styles::Styles,
    &ipd::Ipd,
    &distance::Distance,
    &patchers::Patchers,
    &imbuffer::Imbuffer,
    &lights::Lights,
    &resolution::Resolution,
    &anti_aliasing::AntiAliasing,
    &flicker::Flicker,
    &reprojection::Reprojection,
    &half_rate::HalfRate,
    &foveation::Foveated,
    &stream::Stream,
];
