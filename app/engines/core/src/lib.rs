//! Render one eye, synthesize the other: stereo from the colour and depth of a single view.
//!
//! ```text
//! both eyes ──► one view, a little wider ──► your renderer ──► colour, depth ──► your dominant eye
//!                                                                   │
//!                                       moved along rows, nearest first, holes filled ──► the other eye
//! ```
//!
//! [`eyes`] takes poses and fields of view, and returns the view to render and how its pixels move to the other eye.
//! [`synthesis`] takes the colour and depth of that view and draws the other eye: `opengl` (feature `gl`, on by default)
//! in a context that the caller lends, `vulkan` (feature `vulkan`) into the caller's command buffer.
//! [`choice`] measures whether synthesis or two renders are cheaper on this device. This crate knows no scene,
//! renderer, window, file or command line: an engine brings its own.
//!
//! # A frame
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
//! `Context::new` takes the glow context by value. An engine that goes on with its own loads a second one with
//! `glow::Context::from_loader_function`, or draws through `Context::raw`.
//!
//! With poses and fields of view from OpenXR, use [`eyes::Frustum::from_fov`] and [`eyes::EyePair`] instead of
//! [`eyes::EyeOptions`]. The table of `opengl::Pipeline` lists what a call does to the context's state.
//! `examples/engine.rs` is a complete host.
//!
//! 1. Render opaque objects, lighting and tone mapping.
//! 2. Synthesize, with the other eye's depth if anything follows.
//! 3. Draw transparent objects and interfaces into both eyes, each against its own depth: into the source with
//!    `views.source`, before its part is blitted, and into the other eye with `views.target`.
//! 4. Anti-alias each eye, unless the source was drawn with several samples: then hand over their average colour and
//!    the *nearest* of their depths, never an average of depths.
//!
//! The dominant eye's own image is the part of the source at [`eyes::SynthesisViews::dominant_crop`].
//!
//! # The guard band
//!
//! The other eye sees past one border of the rendered eye. [`eyes::GuardBand`] widens the rendered view by what is
//! needed for surfaces at a distance and farther: by 4 to 14 % for one metre. What is nearer, and what the rendered eye
//! does not see at all, is filled from its background.
//!
//! # Which interface
//!
//! | graphics interface | use | |
//! |---|---|---|
//! | OpenGL ES 3.0, OpenGL 4.5, WebGL 2 | `opengl` | feature `gl`, on by default; in a context that the caller lends |
//! | Vulkan 1.1 | `vulkan` | feature `vulkan`; records into the caller's command buffer |
//! | wgpu | the crate `yoro-wgpu` | records into the caller's command encoder |
//!
//! All run the same passes and draw the same picture. For a view in any other pose (canted eyes, a late frame) each has
//! an `AnyView`, with a [`eyes::PoseWarp`] in place of the warp.
//!
//! # When it looks wrong
//!
//! Render the other eye, too, once, and compare. Thin lines at silhouettes are correct.
//!
//! | symptom | cause |
//! |---|---|
//! | every edge is double, wider for nearer things | a wrong sign: the other eye was rendered |
//! | the whole image is shifted | wrong depth: standard for reversed, or another near plane than the projection's |
//! | near things too flat or too deep | near plane or distance between the eyes in another unit |
//! | surfaces tear, silhouettes of the other half of the picture | colour or depth upside down |
//! | one outer border smeared | no guard band, or another view than [`eyes::SynthesisViews::source`] was rendered |
//! | a little darker or brighter | only one of source and target is sRGB |
//!
//! In the source, `docs/engines.md` shows such pictures, and `docs/method.md` explains the method.

pub mod choice;
pub mod eyes;
pub use glam;
#[cfg(feature = "gl")]
pub mod opengl;
pub mod synthesis;
#[cfg(feature = "vulkan")]
pub mod vulkan;
