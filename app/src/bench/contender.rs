//! Who takes part.

use std::fmt;

use clap::ValueEnum as _;

use crate::stereo::{Method, StereoOptions};
use crate::synthesis::Pipeline;

/// What is measured against what: a stereo method, for synthesis with its pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contender {
    /// A method without synthesis pipelines.
    Method(Method),
    /// The dominant eye rendered, the other synthesized by this pipeline.
    Yoro(Pipeline),
    /// The paper's pipeline without interpolation between ImBuffer entries.
    PaperNearest,
    /// The paper's pipeline with whole source columns and one depth sample per ImBuffer pixel, as its text says.
    PaperStrict,
}

impl Contender {
    /// The ground truth of quality and the baseline of cost.
    pub const CONVENTIONAL: Contender = Contender::Method(Method::Conventional);
    /// The baseline of quality: the same image to both eyes.
    pub const MONO: Contender = Contender::Method(Method::Mono);

    /// Every contender, in the order of tables.
    pub fn all() -> Vec<Contender> {
        let methods = Method::value_variants().iter().filter(|m| **m != Method::Yoro);
        let yoro = Pipeline::ALL.map(Contender::Yoro);
        methods
            .map(|m| Contender::Method(*m))
            .chain(yoro)
            .chain([Contender::PaperNearest, Contender::PaperStrict])
            .collect()
    }

    /// The methods with their pipelines: all but the variants of one pipeline.
    pub fn methods() -> Vec<Contender> {
        let variants = [Contender::PaperNearest, Contender::PaperStrict];
        Contender::all().into_iter().filter(|c| !variants.contains(c)).collect()
    }

    /// Its name in files and on the command line, which stays: `conventional`, `mono`, `yoro-gather`,
    /// `yoro-paper-nearest`.
    pub fn name(self) -> String {
        match self {
            Contender::Method(method) => {
                method.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
            }
            Contender::Yoro(pipeline) => format!("yoro-{}", pipeline.name()),
            Contender::PaperNearest => "yoro-paper-nearest".into(),
            Contender::PaperStrict => "yoro-paper-strict".into(),
        }
    }

    /// The contender of this name.
    pub fn find(name: &str) -> Option<Contender> {
        Contender::all().into_iter().find(|contender| contender.name() == name)
    }

    /// The method that renders it.
    pub fn method(self) -> Method {
        match self {
            Contender::Method(method) => method,
            _ => Method::Yoro,
        }
    }

    /// The pipeline that synthesizes, if one does.
    pub fn pipeline(self) -> Option<Pipeline> {
        match self {
            Contender::Method(_) => None,
            Contender::Yoro(pipeline) => Some(pipeline),
            Contender::PaperNearest | Contender::PaperStrict => Some(Pipeline::Paper),
        }
    }

    /// Its options: the pipeline's own defaults, without the switch to two renders of near frames, so that what
    /// is measured is what the name says.
    pub fn options(self) -> StereoOptions {
        let mut options = StereoOptions::of_pipeline(self.pipeline().unwrap_or_default());
        options.policy = None;
        match self {
            Contender::PaperNearest => options.synthesis.paper.linear_interpolation = false,
            Contender::PaperStrict => options.synthesis.paper.strict = true,
            _ => {}
        }
        options
    }
}

/// Its [name](Contender::name).
impl fmt::Display for Contender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_again_and_stay() {
        for contender in Contender::all() {
            assert_eq!(Contender::find(&contender.name()), Some(contender));
        }
        for name in
            ["conventional", "mono", "yoro-gather", "yoro-rowgroup", "yoro-paper", "yoro-paper-strict"]
        {
            assert!(Contender::find(name).is_some(), "{name}");
        }
        assert_eq!(Contender::find("yoro"), None);
    }
}
