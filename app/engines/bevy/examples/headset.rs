//! A room in an OpenXR headset: one eye is rendered, the other is synthesized.
//!
//! `cargo run --features openxr --example headset`

mod support;

use bevy::prelude::*;
use bevy_mod_openxr::{add_xr_plugins, render::OxrRenderPlugin};
use bevy_yoro::{YoroPlugin, openxr::XrStereoCamera};

fn main() -> AppExit {
    let xr = OxrRenderPlugin { spawn_cameras: false, ..default() };
    App::new()
        .add_plugins((add_xr_plugins(DefaultPlugins).set(xr), YoroPlugin))
        .add_systems(Startup, (support::room, setup))
        .run()
}

fn setup(mut commands: Commands) {
    commands.spawn(XrStereoCamera::default());
}
