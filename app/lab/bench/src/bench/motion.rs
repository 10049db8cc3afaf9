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
}

impl Motion {
    /// Returns the name in results.
    pub fn name(self) -> &'static str {
        match self {
            Motion::Sway => "sway",
            Motion::Walk => "walk",
        }
    }

    /// Returns the pose after a time in seconds of a head that was at rest before; `None` for a walking head.
    pub(super) fn pose(self, from: Pose, seconds: f32) -> Option<Pose> {
        if self == Motion::Walk {
            return None;
        }
        let wave = (std::f32::consts::PI * seconds).sin();
        let moved = from.translated_local(Vec3::X * (0.032 * wave));
        let turn = Quat::from_rotation_y(-(9.5 * wave).to_radians());
        Some(Pose { orientation: turn * moved.orientation, ..moved })
    }
}
