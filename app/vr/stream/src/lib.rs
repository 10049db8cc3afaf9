//! Streaming of one eye with its depth to a client, which makes both eyes from it at the head's newest pose.
//!
//! [`FromClient`] and [`FromServer`] are the messages, [`RateControl`] decides when a frame is due and how finely it is
//! encoded (Google Congestion Control), and [`DepthSpan`] maps the depth's 8 bits to distances. The server (`yoro serve`) and the page
//! use the same code. This crate must not open connections or read clocks.
//!
//! With the feature `gl`, `FrameRenderer` makes the pictures that a server sends of a scene, and `StreamedEyes` both
//! eyes from a decoded one.

mod control;
#[cfg(feature = "gl")]
mod eyes;
mod messages;
#[cfg(feature = "gl")]
mod pictures;
mod span;

pub use control::RateControl;
#[cfg(feature = "gl")]
pub use eyes::{Correction, DecodedPicture, StreamedEyes};
pub use messages::{
    Arrival, Content, EyeSource, EyeView, FrameHeader, FromClient, FromServer, Refusal, Report, Token,
    VERSION, ViewRequest,
};
#[cfg(feature = "gl")]
pub use pictures::{FrameRenderer, Mode, Picture, StreamError};
pub use span::DepthSpan;
