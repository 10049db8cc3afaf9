//! Streaming of one eye with its depth to a client, which makes both eyes from it at the head's newest pose.
//!
//! [`FromClient`] and [`FromServer`] are the messages, [`RateControl`] decides when a frame is due and how finely it is
//! encoded, [`ReorderBuffer`] puts frames in order, and [`DepthSpan`] maps the depth's 8 bits to distances. The server
//! (`yoro serve`) and the page use the same code. This crate must not open connections, read clocks or draw.

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
