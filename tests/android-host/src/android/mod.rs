//! libandroid.so, liblog.so, and the parts of libcamera2ndk.so and libmediandk.so that the application uses.

pub mod activity;
pub mod assets;
pub mod camera;
pub mod choreographer;
pub mod configuration;
pub mod input;
pub mod log;
pub mod looper;
pub mod sensors;
pub mod thermal;
pub mod window;
