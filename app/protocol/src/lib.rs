//! What a phone and the lab say to each other: [`Settings`] one way, [`telemetry`] the other.
//!
//! Settings come in as a file, as `key=value` texts or as options, and go out as typed values; frames and device states
//! come in and go out as lines of text, which are read back into the same values.
//!
//! This crate must never know how anything is rendered: it calls no graphics interface.

mod choices;
mod settings;
pub mod telemetry;

pub use choices::{
    AntiAliasing, DEFAULT_IPD, DisplayKind, ImBufferSize, MAX_IPD, MAX_POINT_LIGHTS, MSAA, Method,
    ParseImBufferSizeError, ParsePipelineError, Performance, Pipeline, RendererKind, ScreenSize, Ssao,
};
pub use settings::{KEYS, Settings, SettingsError};
