//! A phone in a Cardboard-compatible viewer: its lenses, its motion sensors, its screen.

#[cfg(not(target_arch = "wasm32"))]
mod display;
#[cfg(not(target_arch = "wasm32"))]
mod fence;
mod head;
mod lens;
mod optics;
pub(crate) mod params;

#[cfg(not(target_arch = "wasm32"))]
pub use display::{Cardboard, HeldHead};
pub use head::{HeadTracker, MotionSample, neck_offset};
pub use lens::LensPass;
pub use optics::{Optics, Rotation, Screen};
pub use params::{ParamsError, VerticalAlignment, ViewerParams};
