//! libandroid.so and liblog.so.

pub mod activity;
pub mod assets;
pub mod choreographer;
pub mod configuration;
pub mod input;
pub mod log;
pub mod looper;
pub mod sensors;
pub mod thermal;
pub mod trace;
pub mod window;
