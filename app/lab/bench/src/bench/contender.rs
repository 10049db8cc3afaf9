//! Contenders: everything that is measured against each other.

use std::fmt;

use crate::inpaint::PatcherKind;
use yoro_render::stereo::{Method, Pipeline};

/// A stereo method, synthesis with one of its pipelines, or a patcher.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contender {
    /// A method other than synthesis.
    Method(Method),
    /// Synthesis of the other eye by this pipeline.
    Synthesized(Pipeline),
    /// The pipeline gather, with rendered holes.
    RenderedHoles,
    /// A patcher, on the reprojected image that all patchers share.
    Patcher(PatcherKind),
}

impl Contender {
    /// The ground truth for quality and the baseline for cost.
    pub const CONVENTIONAL: Contender = Contender::Method(Method::Conventional);
    /// The baseline for quality: the same image for both eyes.
    pub const MONO: Contender = Contender::Method(Method::Mono);

    /// Both of these, beside which all others are shown.
    pub const BASELINES: [Contender; 2] = [Contender::CONVENTIONAL, Contender::MONO];

    /// Returns every contender in the order of tables.
    pub fn all() -> Vec<Contender> {
        [Contender::methods(), Contender::patchers()].concat()
    }

    /// Returns the stereo methods, with synthesis once for each of its pipelines, and with rendered holes.
    pub fn methods() -> Vec<Contender> {
        let others = Method::ALL.into_iter().filter(|method| *method != Method::Synthesized);
        others
            .map(Contender::Method)
            .chain(Contender::pipelines())
            .chain([Contender::RenderedHoles])
            .collect()
    }

    /// Returns synthesis with each of its pipelines.
    pub fn pipelines() -> Vec<Contender> {
        Pipeline::ALL.map(Contender::Synthesized).to_vec()
    }

    /// Returns the same after the baseline for quality.
    pub fn synthesis() -> Vec<Contender> {
        [vec![Contender::MONO], Contender::pipelines()].concat()
    }

    /// Returns the patchers.
    pub fn patchers() -> Vec<Contender> {
        PatcherKind::ALL.map(Contender::Patcher).to_vec()
    }

    /// Returns the name in files and on the command line, which never changes: `conventional`, `yoro-gather`,
    /// `patcher-telea`.
    pub fn name(self) -> String {
        match self {
            Contender::Method(method) => method.name().into(),
            Contender::Synthesized(pipeline) => format!("yoro-{}", pipeline.name()),
            Contender::RenderedHoles => "yoro-holes-rendered".into(),
            Contender::Patcher(kind) => format!("patcher-{}", kind.name()),
        }
    }

    /// Returns the contender with this name.
    pub fn find(name: &str) -> Option<Contender> {
        Contender::all().into_iter().find(|contender| contender.name() == name)
    }

    /// Returns the stereo method and its pipeline; `None` for a patcher.
    pub fn method(self) -> Option<(Method, Pipeline)> {
        match self {
            Contender::Method(method) => Some((method, Pipeline::default())),
            Contender::Synthesized(pipeline) => Some((Method::Synthesized, pipeline)),
            Contender::RenderedHoles => Some((Method::Synthesized, Pipeline::Gather)),
            Contender::Patcher(_) => None,
        }
    }
}

/// Writes the [name](Contender::name).
impl fmt::Display for Contender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contenders_are_found_by_their_stable_names() {
        for contender in Contender::all() {
            assert_eq!(Contender::find(&contender.name()), Some(contender));
        }
        for name in ["conventional", "mono", "yoro-gather", "yoro-paper", "patcher-telea"] {
            assert!(Contender::find(name).is_some(), "{name}");
        }
        assert_eq!(Contender::find("yoro"), None);
    }
}
