//! The shaders of the passes as WGSL, compiled in advance from the files of `yoro-shaders` by `cargo xtask maintain renew`.

use yoro::synthesis::backend::{PerKind, WarpKind};
use yoro::synthesis::{HoleMark, Holes};

use crate::{Options, WgpuError};

pub(crate) const SCREEN: &str = include_str!("wgsl/screen.wgsl");
pub(crate) const COMPOSE: &str = include_str!("wgsl/compose.wgsl");
pub(crate) const NEAREST_DEPTH: &str = include_str!("wgsl/nearest-depth.wgsl");
pub(crate) const NEAREST_DEPTH_REVERSED: &str = include_str!("wgsl/nearest-depth-reversed.wgsl");

/// The shaders of the passes for a kind of warp.
pub(crate) struct Shaders {
    /// Finds the bounds of each tile.
    pub(crate) tiles: &'static str,
    /// Finds the part of the source that each tile of the target must search.
    pub(crate) spans: &'static str,
    /// The vertex shader of the last pass.
    pub(crate) march_vertex: &'static str,
    march: &'static str,
    march_depth: &'static str,
    /// The last pass with open holes, without depth and writing depth.
    march_open: Option<[&'static str; 2]>,
}

const GATHER: Shaders = Shaders {
    tiles: include_str!("wgsl/tiles.wgsl"),
    spans: include_str!("wgsl/spans.wgsl"),
    march_vertex: include_str!("wgsl/march-vertex.wgsl"),
    march: include_str!("wgsl/march.wgsl"),
    march_depth: include_str!("wgsl/march-depth.wgsl"),
    march_open: Some([include_str!("wgsl/march-open.wgsl"), include_str!("wgsl/march-open-depth.wgsl")]),
};

const MOTION: Shaders = Shaders {
    march: include_str!("wgsl/march-motion.wgsl"),
    march_depth: include_str!("wgsl/march-motion-depth.wgsl"),
    march_open: None,
    ..GATHER
};

const ANY_VIEW: Shaders = Shaders {
    tiles: include_str!("wgsl/any-view-tiles.wgsl"),
    spans: include_str!("wgsl/any-view-spans.wgsl"),
    march_vertex: SCREEN,
    march: include_str!("wgsl/any-view-march.wgsl"),
    march_depth: include_str!("wgsl/any-view-march-depth.wgsl"),
    march_open: None,
};

static SHADERS: PerKind<Shaders> = PerKind { gather: GATHER, motion: MOTION, any_view: ANY_VIEW };

impl Shaders {
    pub(crate) fn of<W: WarpKind>() -> &'static Shaders {
        W::of(&SHADERS)
    }

    /// Returns the last pass.
    pub(crate) fn march(&self, options: &Options) -> Result<&'static str, WgpuError> {
        match options.holes {
            Holes::Filled if options.depth_format.is_some() => Ok(self.march_depth),
            Holes::Filled => Ok(self.march),
            Holes::Open(mark) => {
                let open = self.march_open.ok_or(WgpuError::Holes("only Gather can; fill them"))?;
                Ok(open[usize::from(mark == HoleMark::Stencil)])
            }
        }
    }
}

#[cfg(test)]
mod tests;
