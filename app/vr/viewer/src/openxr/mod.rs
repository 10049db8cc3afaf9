//! OpenXR: head-mounted displays.
//!
//! [`runtime`] finds the runtime of this machine. A [`Headset`] is the display of the [`Viewer`](crate::Viewer) that it
//! owns: it takes poses, frusta and image sizes from the runtime, lets the viewer render into the runtime's own images,
//! and starts a new session when one is lost.
//!
//! ```text
//! runtime::find() ──> Headset::open() ──> step()* ──> request_exit(), step()* until Step::Ended
//! ```
//!
//! A step is one frame, or nothing while the runtime wants none. All calls, including the drop of the [`Headset`],
//! which owns framebuffers, must come from the thread on which the GL context is current.

mod description;
mod error;
mod fixed_foveation;
mod graphics;
mod headset;
mod images;
mod input;
mod mask;
mod motion;
pub mod runtime;
mod session;
mod storage;

pub use description::{Capture, Description, Frame, Options};
pub use error::XrError;
#[cfg(target_os = "android")]
pub use graphics::Android;
pub use headset::{Headset, Step};
