//! The VR viewer for Cardboard phones and OpenXR headsets.
//!
//! [`Viewer`] is the whole application except for the platform: scene, renderer, stereo method, HUD, settings,
//! statistics. [`Cardboard`] and [`openxr::Headset`] are the displays; each owns the viewer that draws for it. A
//! platform provides a GL context, events and a surface to draw on, and receives frames and one log line per second.
//!
//! This crate must not depend on metrics, a command line, or JNI: it passes two opaque pointers to OpenXR, and Android
//! implements the trait [`openxr::runtime::Broker`].

mod adaptive;
mod caption;
mod cardboard;
mod error;
mod event;
mod frame;
mod loading;
pub mod openxr;
mod options;
mod questionnaire;
mod scene_slot;
mod session_stats;
mod viewer;

pub use cardboard::{Cardboard, HeldHead};
pub use error::ViewerError;
pub use event::{Action, Event};
pub use frame::{FrameTiming, PresentReport, SceneState};
pub use loading::{SceneSource, list_scenes};
pub use options::{render_settings, stereo_options};
pub use viewer::Viewer;
