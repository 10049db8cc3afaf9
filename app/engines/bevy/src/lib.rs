//! Renders one eye and synthesizes the other: stereo in Bevy from one camera's colour and depth.
//!
//! Bevy has no multiview, so two cameras run visibility, shadows and all passes twice. [`StereoCamera`] on a `Camera3d`
//! renders that camera as one eye, a little wider, and synthesizes the other eye's image from it ([`yoro_wgpu`]
//! contains the passes). Both images are written side by side to the camera's render target, the left eye's into its
//! left half.
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
//! [`StereoMode`] selects how the other eye is produced. It documents how each mode treats transparent objects,
//! post-processing and anti-aliasing. If the other eye cannot be synthesized both eyes are rendered, and one line in
//! the log gives the reason.
//!
//! With a [`Foveation`], each eye has fewer pixels where it does not look, and one line in the log says if a component
//! prevents this.
//!
//! With the feature `openxr`, [`XrStereoCamera`](openxr::XrStereoCamera) does the same in a headset, using
//! bevy_mod_openxr.

mod auto;
mod camera;
mod holes;
mod levels;
#[cfg(feature = "openxr")]
pub mod openxr;
mod passes;
mod plan;
mod projection;
mod shared;

use bevy::prelude::*;

pub use auto::AutoChoice;
pub use camera::{Eye, StereoCamera};
pub use levels::Foveation;
pub use plan::{Holes, StereoMode};
pub use shared::ShareComponent;
pub use yoro_wgpu;

/// Adds stereo cameras: [`StereoCamera`] and, with the feature `openxr`, [`XrStereoCamera`](openxr::XrStereoCamera).
/// Add it after `DefaultPlugins`.
#[derive(Clone, Copy, Debug, Default)]
pub struct YoroPlugin;

impl Plugin for YoroPlugin {
    fn build(&self, app: &mut App) {
        auto::build(app);
        camera::build(app);
        shared::build(app);
        passes::build(app);
        #[cfg(feature = "openxr")]
        openxr::build(app);
    }
}

/// Compiles the README's code with the documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
