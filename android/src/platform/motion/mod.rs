//! The head's motion and the display's refreshes.

mod motion_thread;
mod sensors;

pub use motion_thread::MotionThread;
