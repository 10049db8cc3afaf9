//! Contenders: everything that is measured against each other.

use std::fmt;

use crate::inpaint::PatcherKind;
use yoro_render::stereo::{HoleMethod, Method, Pipeline, StereoOptions};

/// A stereo method, synthesis with one of its pipelines, or a patcher.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contender {
    /// A method other than synthesis.
    Method(Method),
    /// Synthesis of the other eye by this pipeline.
    Synthesized(Pipeline),
    /// The pipeline gather, with rendered holes.
    RenderedHoles,
    /// The paper's pipeline without interpolation between ImBuffer entries.
    PaperNearest,
    /// The paper's pipeline with whole source columns and one depth sample per ImBuffer pixel, as in its text.
    PaperStrict,
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
        let variants = [Contender::PaperNearest, Contender::PaperStrict];
        let synthesis = Contender::methods().into_iter().chain(variants);
        synthesis.chain(Contender::patchers()).collect()
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
    /// `yoro-paper-nearest`, `patcher-telea`.
    pub fn name(self) -> String {
        match self {
            Contender::Method(method) => method.name().into(),
            Contender::Synthesized(pipeline) => format!("yoro-{}", pipeline.name()),
            Contender::RenderedHoles => "yoro-holes-rendered".into(),
            Contender::PaperNearest => "yoro-paper-nearest".into(),
            Contender::PaperStrict => "yoro-paper-strict".into(),
            Contender::Patcher(kind) => format!("patcher-{}", kind.name()),
        }
    }

    /// Returns the contender with this name.
    pub fn find(name: &str) -> Option<Contender> {
        Contender::all().into_iter().find(|contender| contender.name() == name)
    }

    /// Returns the stereo method and its options; `None` for a patcher. The options are the pipeline's defaults, except
    /// that near frames are not rendered twice: what is measured is what the name says.
    pub fn method(self) -> Option<(Method, StereoOptions)> {
        let (method, pipeline) = match self {
            Contender::Method(method) => (method, Pipeline::default()),
            Contender::Synthesized(pipeline) => (Method::Synthesized, pipeline),
            Contender::RenderedHoles => (Method::Synthesized, Pipeline::Gather),
            Contender::PaperNearest | Contender::PaperStrict => (Method::Synthesized, Pipeline::Paper),
            Contender::Patcher(_) => return None,
        };
        let mut options = StereoOptions::of_pipeline(pipeline);
        options.policy = None;
        if self == Contender::RenderedHoles {
            options.holes = HoleMethod::Rendered;
        }
        let paper = &mut options.synthesis.paper;
        paper.linear_interpolation &= self != Contender::PaperNearest;
        paper.strict |= self == Contender::PaperStrict;
        Some((method, options))
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
        for name in
            ["conventional", "mono", "yoro-gather", "yoro-paper", "yoro-paper-strict", "patcher-telea"]
        {
            assert!(Contender::find(name).is_some(), "{name}");
        }
        assert_eq!(Contender::find("yoro"), None);
    }

    #[test]
    fn variants_differ_in_their_options_only() {
        let options = |contender: Contender| contender.method().unwrap().1;
        let paper = options(Contender::Synthesized(Pipeline::Paper));
        assert!(paper.synthesis.paper.linear_interpolation && paper.policy.is_none());
        assert!(!options(Contender::PaperNearest).synthesis.paper.linear_interpolation);
        assert!(options(Contender::PaperStrict).synthesis.paper.strict);
        assert_eq!(Contender::Patcher(PatcherKind::Telea).method(), None);
    }
}
