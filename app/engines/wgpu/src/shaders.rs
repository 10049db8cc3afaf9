//! The shaders of the passes as WGSL, compiled in advance from the files of `yoro-shaders` by `cargo xtask maintain renew`.

use yoro::synthesis::backend::{PerKind, WarpKind};

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
}

const GATHER: Shaders = Shaders {
    tiles: include_str!("wgsl/tiles.wgsl"),
    spans: include_str!("wgsl/spans.wgsl"),
    march_vertex: include_str!("wgsl/march-vertex.wgsl"),
    march: include_str!("wgsl/march.wgsl"),
    march_depth: include_str!("wgsl/march-depth.wgsl"),
};

const MOTION: Shaders = Shaders {
    march: include_str!("wgsl/march-motion.wgsl"),
    march_depth: include_str!("wgsl/march-motion-depth.wgsl"),
    ..GATHER
};

const ANY_VIEW: Shaders = Shaders {
    tiles: include_str!("wgsl/any-view-tiles.wgsl"),
    spans: include_str!("wgsl/any-view-spans.wgsl"),
    march_vertex: SCREEN,
    march: include_str!("wgsl/any-view-march.wgsl"),
    march_depth: include_str!("wgsl/any-view-march-depth.wgsl"),
};

static SHADERS: PerKind<Shaders> = PerKind { gather: GATHER, motion: MOTION, any_view: ANY_VIEW };

impl Shaders {
    pub(crate) fn of<W: WarpKind>() -> &'static Shaders {
        W::of(&SHADERS)
    }

    /// Returns the last pass, which optionally writes depth.
    pub(crate) fn march(&self, depth: bool) -> &'static str {
        if depth { self.march_depth } else { self.march }
    }
}

#[cfg(test)]
mod tests;
