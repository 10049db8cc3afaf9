//! Measuring how good a synthesized eye is, and what it costs.
//!
//! It takes images, scenes and stereo methods, and gives figures, image groups and reports. [`metrics`] compares
//! images, [`compare`] files and folders of them, [`picture`] reads and writes them; [`inpaint`] has patchers that fill
//! holes after other papers; [`dataset`] renders image groups; [`run`] compares methods with rendering both eyes,
//! [`mod@bench`] every method with every other, and [`report`] makes pages of both. [`streaming`] has both ends of a
//! stream.
//!
//! The feature `neural` has the weights of a network and a runtime for them.
//!
//! This crate must never know the command line; nothing that runs on a phone or in a headset depends on it.

pub mod bench;
pub mod compare;
pub mod dataset;
mod depth;
pub mod inpaint;
pub mod machine;
pub mod picture;
pub mod report;
pub mod run;
pub mod streaming;

pub use yoro_metrics as metrics;
