//! Render one eye, synthesize the other.
//!
//! The heart is [`synthesis`]: colour and depth of one eye in, the other eye out, with nothing known of scenes
//! or windows. [`eyes`] says where the eyes are and how pixels move between them. [`scene`], [`render`] and
//! [`stereo`] make frames to test it on, [`metrics`] measures them. [`viewer`] brings them before a person's eyes,
//! and [`telemetry`] watches.

#[cfg(feature = "desktop")]
pub mod bench;
#[cfg(feature = "desktop")]
pub mod cli;
#[cfg(feature = "desktop")]
pub mod dataset;
#[cfg(feature = "desktop")]
pub mod device;
pub mod eyes;
#[cfg(feature = "desktop")]
pub mod files;
pub mod gl;
#[cfg(feature = "desktop")]
pub mod inpaint;
pub mod metrics;
#[cfg(feature = "desktop")]
pub mod picture;
#[cfg(any(feature = "desktop", target_os = "android"))]
pub mod platform;
pub mod render;
#[cfg(feature = "desktop")]
pub mod report;
pub mod scene;
pub mod stereo;
#[cfg(feature = "desktop")]
pub mod study;
pub mod synthesis;
pub mod telemetry;
pub mod viewer;
