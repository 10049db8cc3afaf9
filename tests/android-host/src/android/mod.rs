//! libandroid.so, liblog.so, and what there is of libcamera2ndk.so and libmediandk.so.

pub mod activity;
pub mod camera;
pub mod choreographer;
pub mod codec;
pub mod configuration;
pub mod input;
pub mod log;
pub mod looper;
pub mod sensors;
pub mod thermal;
pub mod window;
