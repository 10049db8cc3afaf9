//! A phone in a Cardboard-compatible viewer: its lenses, its motion sensors, its screen.

mod display;
mod fence;
#[cfg(test)]
mod pair_tests;
mod timewarp;

pub(crate) use display::FULL_RATE;
pub use display::{Cardboard, HeldHead};
