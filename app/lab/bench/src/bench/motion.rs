//! The motion of the head in sequences.

use glam::{Quat, Vec3};

use yoro::eyes::Pose;

/// The motion of a head.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Sitting still: 2 mm and a third of a degree to either side, with a period of two seconds.
    Still,
    /// Swaying while seated: 3.2 cm and 9.5 degrees to either side, with a period of two seconds.
    Sway,
    /// Walking along the camera path at 1.35 m/s.
    Walk,
    /// Turning at 120 degrees per second.
    Turn,
}

impl Motion {
    /// All motions.
    pub const ALL: [Motion; 4] = [Motion::Still, Motion::Sway, Motion::Walk, Motion::Turn];

    /// Returns the name in results.
    pub fn name(self) -> &'static str {
        match self {
            Motion::Still => "still",
            Motion::Sway => "sway",
            Motion::Walk => "walk",
            Motion::Turn => "turn",
        }
    }

    /// Returns the pose after a time in seconds of a head that was at rest before; `None` for a walking head.
    pub(super) fn pose(self, from: Pose, seconds: f32) -> Option<Pose> {
        let wave = (std::f32::consts::PI * seconds).sin();
        let (aside, degrees) = match self {
            Motion::Still => (0.002 * wave, 0.33 * wave),
            Motion::Sway => (0.032 * wave, 9.5 * wave),
            Motion::Walk => return None,
            Motion::Turn => (0.0, 120.0 * seconds),
        };
        let moved = from.translated_local(Vec3::X * aside);
        let turn = Quat::from_rotation_y(-degrees.to_radians());
        Some(Pose { orientation: turn * moved.orientation, ..moved })
    }
}
