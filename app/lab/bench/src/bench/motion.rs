//! The motion of the head in sequences.

use glam::{Quat, Vec3};

use yoro::eyes::Pose;

/// The motion of a head.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Swaying while seated: 3.2 cm and 9.5 degrees to either side, with a period of two seconds.
    Sway,
    /// Walking along the camera path at 1.35 m/s.
    Walk,
    /// Not moving.
    Still,
    /// Stepping aside, to the right, at 1 m/s.
    Strafe,
    /// Turning to the left at 60 degrees per second, about a neck 10 cm behind the eyes.
    Turn,
    /// Leaning forwards and back by 20 cm, with a period of 1.5 seconds: up to 0.84 m/s.
    Reach,
}

impl Motion {
    /// Returns the name in results.
    pub fn name(self) -> &'static str {
        match self {
            Motion::Sway => "sway",
            Motion::Walk => "walk",
            Motion::Still => "still",
            Motion::Strafe => "strafe",
            Motion::Turn => "turn",
            Motion::Reach => "reach",
        }
    }

    /// Returns the pose after a time in seconds of a head that was at rest before; `None` for a walking head.
    pub(super) fn pose(self, from: Pose, seconds: f32) -> Option<Pose> {
        use std::f32::consts::{PI, TAU};
        match self {
            Motion::Walk => None,
            Motion::Still => Some(from),
            Motion::Sway => {
                let wave = (PI * seconds).sin();
                let moved = from.translated_local(Vec3::X * (0.032 * wave));
                let turn = Quat::from_rotation_y(-(9.5 * wave).to_radians());
                Some(Pose { orientation: turn * moved.orientation, ..moved })
            }
            Motion::Strafe => Some(from.translated_local(Vec3::X * seconds)),
            Motion::Turn => {
                let neck = from.translated_local(Vec3::Z * 0.1);
                let turn = Quat::from_rotation_y((60.0 * seconds - 20.0).to_radians());
                let turned = Pose { orientation: turn * neck.orientation, ..neck };
                Some(turned.translated_local(Vec3::NEG_Z * 0.1))
            }
            Motion::Reach => Some(from.translated_local(Vec3::NEG_Z * (0.2 * (TAU * seconds / 1.5).sin()))),
        }
    }
}
