//! One session: from xrCreateInstance to the last frame.

mod events;
mod eyes;
mod frame;
mod open;
mod state;
mod step;

pub(super) use eyes::to_pose;
pub(super) use state::{Progress, Session};
