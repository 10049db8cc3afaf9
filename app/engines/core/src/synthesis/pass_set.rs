//! The compiled passes for a kind of warp and a device.

use super::WarpKind;

/// A pipeline's compiled passes on Vulkan or wgpu.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PassSet {
    /// Between parallel eyes, for CPU rasterizers.
    GatherOnCpu,
    /// Between parallel eyes, for GPUs.
    GatherOnGpu,
    /// To any view, for CPU rasterizers and GPUs.
    AnyView,
}

impl PassSet {
    /// The passes between parallel eyes.
    pub const GATHER: [PassSet; 2] = [PassSet::GatherOnCpu, PassSet::GatherOnGpu];

    /// Returns the passes for a kind of warp, on a CPU rasterizer or a GPU.
    pub fn of<W: WarpKind>(on_cpu: bool) -> PassSet {
        match (W::ANY_VIEW, on_cpu) {
            (true, _) => PassSet::AnyView,
            (false, true) => PassSet::GatherOnCpu,
            (false, false) => PassSet::GatherOnGpu,
        }
    }
}
