//! Render one eye, synthesize the other: stereo from the colour and depth of a single view.
//!
//! [`eyes`] takes poses and fields of view, and returns the view to render and how its pixels move to the other eye.
//! [`synthesis`] takes the colour and depth of that view and draws the other eye: `opengl` (feature `gl`, on by default)
//! in a context that the caller lends, `vulkan` (feature `vulkan`) into the caller's command buffer.
//! [`choice`] measures whether synthesis or two renders are cheaper on this device. This crate knows no scene,
//! renderer, window, file or command line: an engine brings its own.
//!
//! An engine renders [`eyes::SynthesisViews::source`] with its own code, passes colour and depth to
//! `opengl::Gather::synthesize`, and gets the other eye in its own framebuffer:
//!
//! ```no_run
//! use yoro::eyes::{DepthRange, EyeOptions, GuardBand, Pose, View};
//! use yoro::opengl::{Context, Destination, Gather, GlState, Options, Outputs, Source};
//!
//! # fn render(_: &View) -> Source { unimplemented!() }
//! # fn example(glow_context: glow::Context, framebuffer: glow::Framebuffer) -> Result<(), Box<dyn std::error::Error>> {
//! // Once, with the engine's GL context current:
//! let gl = Context::new(glow_context)?;
//! let options = Options { gl_state: GlState::Preserve, ..Options::default() };
//! let mut gather = Gather::new(&gl, &options, Outputs::default())?;
//!
//! // Each frame: two eyes around the head, one of which the engine renders, a little wider.
//! let eyes = EyeOptions { ipd: 0.064, depth: DepthRange::PAPER, ..EyeOptions::default() }.pair(Pose::IDENTITY);
//! let views = eyes.synthesis_views(GuardBand::Distance(1.0))?;
//! let source: Source = render(&views.source);
//! let target = Destination { framebuffer: Some(framebuffer), origin: [0, 0], size: views.target.size };
//! gather.synthesize(source, &views.warp, &target)?;
//! # Ok(())
//! # }
//! ```
//!
//! With poses and fields of view from OpenXR, use [`eyes::Frustum::from_fov`] and [`eyes::EyePair`] instead of
//! [`eyes::EyeOptions`]. The table of `opengl::Pipeline` lists what a call does to the context's state.
//! `examples/engine.rs` is a complete host.

pub mod choice;
pub mod eyes;
pub use glam;
#[cfg(feature = "gl")]
pub mod opengl;
pub mod synthesis;
#[cfg(feature = "vulkan")]
pub mod vulkan;

/// Compiles the README's code with the documentation tests.
#[cfg(all(doctest, feature = "gl"))]
#[doc = include_str!("../README.md")]
struct Readme;
