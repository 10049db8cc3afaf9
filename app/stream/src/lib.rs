//! Streaming one eye with its depth to a client that makes both eyes of it at the head's newest pose.
//!
//! [`FromClient`] and [`FromServer`] are the messages, [`RateControl`] says when a frame is due and how finely it is
//! encoded, [`ReorderBuffer`] puts frames into their order, and [`DepthSpan`] says what the depth's 8 bits stand for.
//! The server (`yoro serve`) and the page use the same code. This crate must never open a connection, read a clock or
//! draw.

mod control;
mod messages;
mod reorder;
mod span;

pub use control::RateControl;
pub use messages::{
    Content, EyeView, FrameHeader, FromClient, FromServer, Refusal, Token, VERSION, ViewRequest,
};
pub use reorder::ReorderBuffer;
pub use span::DepthSpan;
