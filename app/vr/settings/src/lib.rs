//! The viewer's [`Settings`], and the lines in which it reports what it measures: [`telemetry`].
//!
//! Settings are read from a file, from `key=value` texts or from options, and become typed values. Frames and device
//! states become lines of text, which are read back into the same values.
//!
//! This crate must not depend on how anything is rendered: it calls no graphics interface.

mod choices;
mod quantities;
mod setting;
mod settings;
pub mod telemetry;
mod value;

pub use choices::{
    ChoiceError, DisplayKind, FrameRate, HoleMethod, MAX_POINT_LIGHTS, MSAA, Method, MethodChoice,
    Performance, Pipeline, Timewarp,
};
pub use quantities::{ImBufferSize, Ipd, IpdError, ParseImBufferSizeError, ScreenSize, ScreenSizeError};
pub use setting::{PROPERTY_PREFIX, Setting};
pub use settings::{SETTINGS, Settings, SettingsError};
pub use value::Choice;
