//! A room in both eyes, side by side in a window.
//!
//! Holding the space bar shows two rendered eyes. M changes how the other eye is produced, D which eye is rendered, F
//! foveation, and the arrow keys move the head.

mod support;

use bevy::prelude::*;
use bevy_yoro::{Eye, Foveation, StereoCamera, StereoMode, YoroPlugin};

fn main() -> AppExit {
    App::new()
        .add_plugins((DefaultPlugins, YoroPlugin))
        .add_systems(Startup, (support::room, setup))
        .add_systems(Update, (choose, walk))
        .run()
}

fn setup(mut commands: Commands) {
    commands.spawn((
        Camera3d::default(),
        support::viewpoint(),
        StereoCamera { fov_y: 75f32.to_radians(), ..default() },
    ));
}

/// Applies the keys, and shows the mode in the window's title.
fn choose(
    keys: Res<ButtonInput<KeyCode>>,
    mut chosen: Local<StereoMode>,
    mut stereo: Single<&mut StereoCamera>,
    mut window: Single<&mut Window>,
) {
    if keys.just_pressed(KeyCode::KeyM) {
        *chosen = match *chosen {
            StereoMode::Opaque => StereoMode::Finished,
            StereoMode::Finished => StereoMode::Auto,
            _ => StereoMode::Opaque,
        };
    }
    let mode = if keys.pressed(KeyCode::Space) { StereoMode::Rendered } else { *chosen };
    if stereo.mode != mode {
        stereo.mode = mode;
    }
    if keys.just_pressed(KeyCode::KeyD) {
        stereo.dominant = match stereo.dominant {
            Eye::Left => Eye::Right,
            Eye::Right => Eye::Left,
        };
    }
    if keys.just_pressed(KeyCode::KeyF) {
        stereo.foveation = if stereo.foveation.is_some() { None } else { Some(Foveation::MEDIUM) };
    }
    let level = if stereo.foveation.is_some() { ", foveated" } else { "" };
    let title = format!("{:?}, {:?} eye rendered{level}", stereo.mode, stereo.dominant);
    if window.title != title {
        window.title = title;
    }
}

fn walk(
    keys: Res<ButtonInput<KeyCode>>,
    time: Res<Time>,
    mut head: Single<&mut Transform, With<StereoCamera>>,
) {
    let axis = |less, more| f32::from(keys.pressed(more)) - f32::from(keys.pressed(less));
    let step =
        vec3(axis(KeyCode::ArrowLeft, KeyCode::ArrowRight), 0.0, axis(KeyCode::ArrowUp, KeyCode::ArrowDown));
    if step != Vec3::ZERO {
        head.translation += step * time.delta_secs();
    }
}
