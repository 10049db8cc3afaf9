//! Render one eye, synthesize the other: stereo in Bevy from one camera's colour and depth.
//!
//! Bevy has no multiview: two cameras run visibility, shadows and all passes twice. [`StereoCamera`] on a `Camera3d`
//! renders that camera as one eye, a little wider, and makes the other eye's image of it ([`yoro_wgpu`] has the
//! passes). Both are written side by side into the camera's render target, the left eye in its left half.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use bevy_yoro::{StereoCamera, YoroPlugin};
//!
//! fn main() {
//!     App::new()
//!         .add_plugins((DefaultPlugins, YoroPlugin))
//!         .add_systems(Startup, |mut commands: Commands| {
//!             commands.spawn((Camera3d::default(), StereoCamera::default()));
//!         })
//!         .run();
//! }
//! ```
//!
//! [`StereoMode`] says how the other eye is made, and what each way does with transparent objects, post-processing and
//! anti-aliasing. What cannot be synthesized is rendered twice, with one line in the log that says why.
//!
//! With the feature `openxr`, [`XrStereoCamera`](openxr::XrStereoCamera) does the same in a headset, by
//! bevy_mod_openxr.

mod camera;
#[cfg(feature = "openxr")]
pub mod openxr;
mod passes;
mod plan;
mod projection;
mod shared;

use bevy::prelude::*;

pub use camera::{Eye, StereoCamera};
pub use plan::StereoMode;
pub use shared::ShareComponent;
pub use yoro_wgpu;

/// Adds stereo: [`StereoCamera`], and with the feature `openxr` [`XrStereoCamera`](openxr::XrStereoCamera). Add it
/// after `DefaultPlugins`.
#[derive(Clone, Copy, Debug, Default)]
pub struct YoroPlugin;

impl Plugin for YoroPlugin {
    fn build(&self, app: &mut App) {
        camera::build(app);
        shared::build(app);
        passes::build(app);
        #[cfg(feature = "openxr")]
        openxr::build(app);
    }
}

/// The code of the README is compiled with the tests of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
