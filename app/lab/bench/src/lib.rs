//! Measures how good a synthesized eye is, and what it costs.
//!
//! The crate turns images, scenes and stereo methods into figures, image groups and reports. [`compare`]
//! compares files and folders of images; [`inpaint`] has patchers that fill holes by methods of other papers; [`dataset`]
//! renders image groups; [`mod@bench`] compares every method with every other, and makes a page of the results.
//! [`streaming`] makes eyes from a stream's pictures, like its page.
//!
//! The feature `neural` includes the weights of a network and a runtime for it.
//!
//! This crate must never know the command line; nothing that runs on a phone or in a headset depends on it.

pub mod bench;
pub mod compare;
pub mod dataset;
pub mod inpaint;
pub mod machine;
pub mod streaming;
