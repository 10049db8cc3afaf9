//! What becomes of pixels that the source does not show.

/// What becomes of the target's holes, which the source does not show, and of its silhouettes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Holes {
    /// Holes are filled from their background, and silhouettes are blended over what lies behind them.
    #[default]
    Filled,
    /// Whole pixels are left open for the host, which draws its opaque scene there: holes, pixels in which a silhouette is
    /// blended over what lies behind it, and those whose colour is a silhouette's outermost pixel, in which the source shows
    /// something of its background, too. They are about 1 to 5 % of an eye.
    ///
    /// The target has a depth attachment, and for [`HoleMark::Stencil`] stencil. In its rectangle a call clears depth to the
    /// farthest, and stencil to 0 if that is the mark, and then marks all pixels that it writes. Colour and source map of open pixels are undefined.
    Open(HoleMark),
}

impl Holes {
    /// True if they are left open.
    pub fn is_open(self) -> bool {
        self != Holes::Filled
    }
}

/// How pixels that are written are told from those that are left open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HoleMark {
    /// By stencil, which is 1 where a pixel is written. The host draws its scene where stencil equals 0. With depth among the
    /// outputs, what it draws afterwards is hidden by all of the eye.
    Stencil,
    /// By depth, for hosts whose materials cannot have a stencil state: it is the nearest where a pixel is written, so that the
    /// host's scene passes the depth test in open pixels alone. It excludes depth among the outputs.
    Depth,
}
