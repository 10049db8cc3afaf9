//! The kinds of sources: with hard and with anti-aliased edges.

/// The anti-aliasing of the source. A pixel at an edge of an anti-aliased source mixes two surfaces.
///
/// | | source | synthesized eye |
/// |---|---|---|
/// | [`Edges::Hard`] | one sample per pixel, or resolved colour and the nearest depth | one surface per pixel; silhouettes blended by where they cross it |
/// | [`Edges::Nearest`], [`Edges::Sample`] | resolved colour, one depth per pixel | anti-aliased; the share of each surface is estimated from colour and depth around |
/// | [`Edges::Multisample`] | resolved colour, depth of all samples | anti-aliased; with the samples' colours, too, nothing is estimated |
///
/// Never average depth over samples: the average belongs to no surface and causes halos at all edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Edges {
    /// One sample per pixel: every pixel shows one surface. Resolved colour with each pixel's nearest depth comes close
    /// to this, and costs an eighth of the other kinds.
    #[default]
    Hard,
    /// Resolved (anti-aliased) colour; depth of each pixel's nearest sample.
    Nearest,
    /// Resolved colour; depth of each pixel's first sample, as drivers resolve it, or of its centre.
    Sample,
    /// Depth of every sample, in a multisample texture of 2 or 4 samples in the standard pattern; resolved colour,
    /// optionally with that of every sample (`Source::samples`). Needs OpenGL ES 3.1.
    Multisample,
}

impl Edges {
    /// All kinds, starting with the default.
    pub const ALL: [Edges; 4] = [Edges::Hard, Edges::Nearest, Edges::Sample, Edges::Multisample];

    /// Returns the name in settings.
    pub fn name(self) -> &'static str {
        match self {
            Edges::Hard => "hard",
            Edges::Nearest => "nearest",
            Edges::Sample => "sample",
            Edges::Multisample => "multisample",
        }
    }
}
