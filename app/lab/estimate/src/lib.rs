//! An estimate of what stereo frames cost on mobile GPUs that are not at hand.
//!
//! A frame is rendered here and [recorded](Recorder): its passes, their images, and the number of samples that pass each
//! depth test. `costs` has what Mesa's compilers make of each shader (`shader-cost.csv`), `traffic` what a tile-based GPU
//! moves between its tiles and memory, `lamps` the number of lights that a wave computes, and [`Meter`] what the
//! synthesis executes. [`FrameModel`] adds these up.

mod costs;
mod gather;
mod gpus;
mod lamps;
pub mod metric;
mod model;
mod record;
mod traffic;
mod waves;

pub use gather::{March, Meter};
pub use gpus::{DEVICES, Device, GPUS};
pub use lamps::Lamps;
pub use model::{
    BYTES, BYTES_16, BYTES_BLIT, Frame, FrameModel, MULTIVIEW, SIZE, SYNTHESIS, VERTICES, VERTICES_ONCE,
};
pub use record::{Command, Draw, Recorder};
pub use traffic::{Assumed, Piece, Traffic, pieces};
