//! Both eyes before a person's: a phone behind the lenses of a Cardboard-compatible viewer, or an OpenXR headset.
//!
//! [`Viewer`] is the whole application without a platform: scene, renderer, stereo method, HUD, settings, statistics.
//! [`Cardboard`] and [`openxr::Headset`] are the displays; each owns the viewer that draws for it. [`telemetry`]
//! watches from the side and makes a log line a second.
//!
//! In a browser, which has displays of its own, only the lenses, their parameters and the panel of text are here.
//!
//! This crate must never know how a frame is measured against another, a command line, or JNI: it
//! hands two opaque pointers to OpenXR, and Android answers the trait [`openxr::runtime::Broker`].

mod cardboard;
mod hud;

#[cfg(not(target_arch = "wasm32"))]
mod adaptive;
#[cfg(not(target_arch = "wasm32"))]
mod caption;
#[cfg(not(target_arch = "wasm32"))]
mod error;
#[cfg(not(target_arch = "wasm32"))]
mod event;
#[cfg(not(target_arch = "wasm32"))]
mod frame;
#[cfg(not(target_arch = "wasm32"))]
mod loading;
#[cfg(not(target_arch = "wasm32"))]
mod method_slot;
#[cfg(not(target_arch = "wasm32"))]
pub mod openxr;
#[cfg(not(target_arch = "wasm32"))]
mod questionnaire;
#[cfg(not(target_arch = "wasm32"))]
mod scene_slot;
#[cfg(not(target_arch = "wasm32"))]
mod settings;
#[cfg(not(target_arch = "wasm32"))]
mod tally;
#[cfg(not(target_arch = "wasm32"))]
pub mod telemetry;
#[cfg(not(target_arch = "wasm32"))]
mod viewer;

pub use cardboard::{
    HeadTracker, LensPass, MotionSample, Optics, ParamsError, Rotation, Screen, VerticalAlignment,
    ViewerParams, neck_offset,
};
pub use hud::{Content, Hud, Panel, Placement};

#[cfg(not(target_arch = "wasm32"))]
pub use cardboard::{Cardboard, HeldHead};
#[cfg(not(target_arch = "wasm32"))]
pub use error::ViewerError;
#[cfg(not(target_arch = "wasm32"))]
pub use event::{Action, Event};
#[cfg(not(target_arch = "wasm32"))]
pub use frame::{FrameReport, FrameTiming, SceneState};
#[cfg(not(target_arch = "wasm32"))]
pub use loading::{SceneSource, list_scenes};
#[cfg(not(target_arch = "wasm32"))]
pub use settings::{DisplayKind, KEYS, Performance, ScreenSize, Settings, SettingsError, Ssao};
#[cfg(not(target_arch = "wasm32"))]
pub use viewer::Viewer;
