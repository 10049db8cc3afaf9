//! Forward columns: the order in which the shaders count columns.

use crate::eyes::{Eye, Warp};

/// [`DisparityMap`](crate::eyes::DisparityMap) in forward columns (`include/warp.glsl`). Columns are mirrored for the
/// right eye, so that a larger displacement always means nearer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ForwardLaw {
    pub offset: f64,
    pub scale: f64,
    pub mirrored: bool,
    pub far: f64,
    pub near: f64,
}

impl ForwardLaw {
    pub fn new(warp: &Warp) -> ForwardLaw {
        let mirrored = warp.target_eye == Eye::Right;
        let (offset, scale) = if mirrored {
            (warp.target_size[0] as f64 - warp.source_size[0] as f64 - warp.law.offset, -warp.law.scale)
        } else {
            (warp.law.offset, warp.law.scale)
        };
        let [far, near] = warp.forward_displacements();
        ForwardLaw { offset, scale, mirrored, far, near }
    }
}
