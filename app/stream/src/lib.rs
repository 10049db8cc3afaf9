//! Streaming one eye with its depth to a viewer that makes both eyes of it at the head's newest pose.
//!
//! [`FromViewer`] and [`FromServer`] are the messages, [`RateControl`] says when a frame is due and how fine it is encoded, and
//! [`DepthSpan`] what the depth's 8 bits stand for. The server (`yoro serve`) and the page use the same code. This crate must
//! never open a connection, read a clock or draw.

mod control;
mod messages;
mod span;

pub use control::RateControl;
pub use messages::{
    Content, EyeView, FrameHeader, FromServer, FromViewer, Refusal, Token, VERSION, ViewRequest,
};
pub use span::DepthSpan;
