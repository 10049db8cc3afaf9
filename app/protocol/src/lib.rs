//! The protocol between a phone and the lab: [`Settings`] one way, [`telemetry`] the other.
//!
//! Settings come in as a file, as `key=value` texts or as options, and go out as typed values; frames and device states
//! come in and go out as lines of text, which are read back into the same values.
//!
//! This crate must never know how anything is rendered: it calls no graphics interface.

mod choices;
mod quantities;
mod setting;
mod settings;
pub mod telemetry;
mod value;

pub use choices::{
    AntiAliasing, ChoiceError, DEPTH_BITS, DisplayKind, History, MAX_KERNEL_HEIGHT, MAX_POINT_LIGHTS, MSAA,
    Method, MethodChoice, Performance, Pipeline, RendererKind, Ssao, Timewarp,
};
pub use quantities::{ImBufferSize, Ipd, IpdError, ParseImBufferSizeError, ScreenSize, ScreenSizeError};
pub use setting::{PROPERTY_PREFIX, Setting};
pub use settings::{SETTINGS, Settings, SettingsError};
pub use value::Choice;
