//! Which compiled passes serve a kind of warp on a device.

use super::WarpKind;

/// The compiled passes of a pipeline on Vulkan or wgpu.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PassSet {
    /// Between parallel eyes, written for CPU rasterizers.
    GatherOnCpu,
    /// Between parallel eyes, written for GPUs.
    GatherOnGpu,
    /// To any view, for both.
    AnyView,
}

impl PassSet {
    /// The passes between parallel eyes.
    pub const GATHER: [PassSet; 2] = [PassSet::GatherOnCpu, PassSet::GatherOnGpu];

    /// Returns the passes for a kind of warp on a device, which is a CPU rasterizer if `on_cpu`.
    pub fn of<W: WarpKind>(on_cpu: bool) -> PassSet {
        match (W::ANY_VIEW, on_cpu) {
            (true, _) => PassSet::AnyView,
            (false, true) => PassSet::GatherOnCpu,
            (false, false) => PassSet::GatherOnGpu,
        }
    }
}
