//! What becomes of pixels that the source does not show.

/// What becomes of the target's holes, which the source does not show, and of its silhouettes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Holes {
    /// Holes are filled from their background, and silhouettes are blended over what lies behind them.
    #[default]
    Filled,
    /// Whole pixels are left open for the host to draw its opaque scene in: holes, pixels in which a silhouette is blended
    /// over what lies behind it, and pixels that show a surface's outermost column or row, whose colour in the source is
    /// partly that of the background. They are about 1 to 5 % of an eye.
    ///
    /// The target needs a depth attachment, and a stencil attachment for [`HoleMark::Stencil`]. In the target's rectangle, a
    /// call clears depth to the far plane, and stencil to 0 if that is the mark, and then marks each pixel that it writes. The
    /// colour and the source map of open pixels are undefined.
    Open(HoleMark),
}

impl Holes {
    /// True if they are left open.
    pub fn is_open(self) -> bool {
        self != Holes::Filled
    }
}

/// How written pixels are distinguished from open ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HoleMark {
    /// Stencil is 1 where a pixel is written: the host draws its scene where it equals 0. If depth is an output, the eye
    /// occludes what is drawn later.
    Stencil,
    /// Depth is that of the near plane where a pixel is written, so that the host's scene passes the depth test in open pixels
    /// only. This is for hosts whose materials cannot have a stencil state, and excludes depth as an output.
    Depth,
}
