//! A phone in a viewer: its orientation, and the viewer's parameters.

use std::f32::consts::FRAC_PI_2;

use glam::{EulerRot, Quat, Vec3};
use yoro_lenses::{ParamsError, ViewerParams};

/// Returns the head's orientation, in a world with Y up, for the angles alpha, beta and gamma of a `deviceorientation`
/// event and the screen's rotation `screen`, all in degrees.
pub fn orientation(angles: [f32; 3], screen: f32) -> Quat {
    let [alpha, beta, gamma] = angles.map(f32::to_radians);
    // Rotations about the Earth's axes Z, X and Y, with Z up; then the screen relative to the device.
    let device = Quat::from_euler(EulerRot::ZXY, alpha, beta, gamma);
    Quat::from_rotation_x(-FRAC_PI_2) * device * Quat::from_rotation_z(-screen.to_radians())
}

/// Returns the angle by which a head looks to the left of -Z, in radians.
fn heading(head: Quat) -> f32 {
    let ahead = head * Vec3::NEG_Z;
    (-ahead.x).atan2(-ahead.z)
}

/// The head of a user who turns a phone, relative to the straight-ahead direction.
#[derive(Clone, Copy, Debug, Default)]
pub struct Head {
    /// The head's orientation in the world; `None` until the sensors report it.
    world: Option<Quat>,
    /// The heading that is straight ahead, in radians to the left; `None` until there is an orientation.
    ahead: Option<f32>,
}

impl Head {
    /// Sets the orientation in the world. The heading of the first one is straight ahead.
    pub fn turn(&mut self, world: Quat) {
        self.world = Some(world);
        self.ahead.get_or_insert(heading(world));
    }

    /// Makes the present heading straight ahead; before the first orientation, the first one's.
    pub fn recenter(&mut self) {
        self.ahead = self.world.map(heading);
    }

    /// Returns the orientation in a world in which straight ahead is -Z.
    pub fn orientation(&self) -> Quat {
        Quat::from_rotation_y(-self.ahead.unwrap_or_default()) * self.world.unwrap_or(Quat::IDENTITY)
    }
}

/// Finds a viewer by `v1`, `v2`, or the text of its QR code; there are no parameter files in browsers.
///
/// # Errors
/// A sentence with the remedy.
pub fn find_viewer(text: &str) -> Result<ViewerParams, String> {
    ViewerParams::find(text).map_err(|error| match error {
        ParamsError::File(_) if text.contains("goo.gl") => {
            "This address is shortened: open it, and copy the address that it leads to.".into()
        }
        ParamsError::File(_) => "This is no viewer: write v1, v2, or the text of the viewer's QR code \
             (https://google.com/cardboard/cfg?p=...)."
            .into(),
        ParamsError::Uri(sentence) => sentence,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phone_looks_where_its_back_points() {
        // Held upright it looks ahead, lying on a table down, and on its side ahead again.
        for (angles, screen, ahead) in [
            ([0.0, 90.0, 0.0], 0.0, Vec3::NEG_Z),
            ([0.0, 0.0, 0.0], 0.0, Vec3::NEG_Y),
            ([90.0, 90.0, 0.0], 0.0, Vec3::NEG_X),
            ([0.0, 0.0, -90.0], 90.0, Vec3::X),
        ] {
            let looks = orientation(angles, screen) * Vec3::NEG_Z;
            assert!((looks - ahead).length() < 1e-5, "{angles:?}: {looks}");
        }
    }

    #[test]
    fn a_head_begins_straight_ahead_however_late_the_sensors_are() {
        let mut head = Head::default();
        assert_eq!(head.orientation(), Quat::IDENTITY);
        // A tap before the sensors report anything.
        head.recenter();
        let looks = |head: &Head| head.orientation() * Vec3::NEG_Z;
        head.turn(orientation([150.0, 0.0, -90.0], 90.0));
        assert!((looks(&head) - Vec3::NEG_Z).length() < 1e-5, "{}", looks(&head));
        head.turn(orientation([240.0, 0.0, -90.0], 90.0));
        assert!((looks(&head) - Vec3::NEG_X).length() < 1e-5, "{}", looks(&head));
        head.recenter();
        assert!((looks(&head) - Vec3::NEG_Z).length() < 1e-5, "{}", looks(&head));
    }

    #[test]
    fn a_viewer_fault_says_what_to_write() {
        for viewer in ["v1", " v2 ", "https://g.co/cardboard"] {
            assert!(find_viewer(viewer).is_ok(), "{viewer}");
        }
        for viewer in ["", "V1", "nonsense", "https://goo.gl/abc", "https://google.com/cardboard/cfg?p=!"] {
            let fault = find_viewer(viewer).unwrap_err();
            assert!(!fault.contains("file") && !fault.contains("platform"), "{viewer}: {fault}");
        }
    }
}
