//! OpenXR: head-mounted displays.
//!
//! [`runtime`] finds the runtime of this machine. A [`Headset`] is a display for a [`crate::viewer::Viewer`]: it
//! takes poses, frusta and image sizes from the runtime, renders into the runtime's own images, and begins a new
//! session when one is lost.
//!
//! ```text
//! runtime::find() ──> Headset::open() ──> step()* ──> request_exit(), step()* until Step::Ended
//! ```
//!
//! A step is one frame, or nothing while the runtime wants none. All calls come from the thread on which the GL
//! context is current; that includes dropping the [`Headset`], which has framebuffers.

mod error;
mod graphics;
mod headset;
mod images;
mod input;
mod mask;
pub mod runtime;
mod session;
mod storage;

pub use error::XrError;
#[cfg(target_os = "android")]
pub use graphics::Android;
#[cfg(feature = "desktop")]
pub use graphics::HeadlessGraphics;
pub use graphics::{Binding, Graphics};
pub use headset::{Headset, Step};
pub use session::{Capture, Description, Frame, Options};
