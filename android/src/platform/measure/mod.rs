//! Battery and heat, and the log with its copies.

mod device;
pub mod results;
mod thermal;

pub use device::Device;
