//! The VR viewer: Cardboard phones and OpenXR headsets.
//!
//! [`Viewer`] is the whole application without a platform: scene, renderer, stereo method, HUD, settings, statistics.
//! [`Cardboard`] and [`openxr::Headset`] are the displays; each owns the viewer that draws for it. A platform gives a
//! GL context, events and somewhere to draw, and gets frames and a log line a second.
//!
//! This crate must never know how a frame is measured against another, a command line, or JNI: it
//! hands two opaque pointers to OpenXR, and Android answers the trait [`openxr::runtime::Broker`].

mod adaptive;
mod caption;
mod cardboard;
mod error;
mod event;
mod frame;
mod loading;
mod menu;
mod method_slot;
pub mod openxr;
mod questionnaire;
mod scene_slot;
mod session_stats;
mod start;
mod stream;
mod viewer;

pub use cardboard::{Cardboard, HeldHead};
pub use error::ViewerError;
pub use event::{Action, Event};
pub use frame::{FrameReport, FrameTiming, SceneState};
pub use loading::{SceneSource, list_scenes};
pub use stream::StreamExchange;
pub use viewer::Viewer;
