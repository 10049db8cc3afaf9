//! Procedural scenes.

pub mod paint;
