//! A head that is turned and moved by hand, or moves around an object.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{EulerRot, Quat, Vec3};
use yoro::eyes::Pose;

/// The head's position and direction. It never tilts sideways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walker {
    position: Vec3,
    /// Rotation to the left of -Z, and above the horizon, in radians.
    heading: [f32; 2],
    /// The initial pose, bit for bit, until the head moves.
    start: Option<Pose>,
    /// The centre of the object that the head moves around, if any.
    object: Option<Vec3>,
}

/// The largest pitch up or down in radians: a little less than straight up, where the heading is undefined.
const STEEPEST: f32 = FRAC_PI_2 - 0.01;

impl Walker {
    /// Creates a head at a pose.
    pub fn new(pose: Pose) -> Walker {
        let ahead = pose.forward();
        let heading = [(-ahead.x).atan2(-ahead.z), ahead.y.clamp(-1.0, 1.0).asin()];
        Walker { position: pose.position, heading, start: Some(pose), object: None }
    }

    /// Creates a head at a place that [`Walker::place`] returned; `None` if the numbers are not a place.
    pub fn at(place: [f32; 5]) -> Option<Walker> {
        let [x, y, z, yaw, pitch] = place;
        place.iter().all(|n| n.is_finite() && n.abs() < 1e6).then(|| Walker {
            position: Vec3::new(x, y, z),
            heading: [yaw.rem_euclid(TAU), pitch.clamp(-STEEPEST, STEEPEST)],
            start: None,
            object: None,
        })
    }

    /// Returns the position in metres and the rotation to the left and upwards in radians; `None` until the head moves.
    pub fn place(&self) -> Option<[f32; 5]> {
        let ([x, y, z], [yaw, pitch]) = (self.position.to_array(), self.heading);
        self.start.is_none().then_some([x, y, z, yaw, pitch])
    }

    /// Moves around the object with this centre from now on; `None` walks instead.
    pub fn go_around(&mut self, object: Option<Vec3>) {
        self.object = object;
    }

    /// Turns by angles to the left and upwards, in radians. Around an object, the object seems to turn with the hand
    /// that drags it: it stays in place in the picture.
    pub fn turn(&mut self, [left, up]: [f32; 2]) {
        let seen = self.object.map(|object| self.orientation().inverse() * (object - self.position));
        let sign = if self.object.is_some() { -1.0 } else { 1.0 };
        let [yaw, pitch] = self.heading;
        self.heading = [(yaw + sign * left).rem_euclid(TAU), (pitch + sign * up).clamp(-STEEPEST, STEEPEST)];
        if let Some((object, seen)) = self.object.zip(seen) {
            self.position = object - self.orientation() * seen;
        }
        self.start = None;
    }

    /// Walks by distances to the right, upwards and ahead in metres, on level ground. Around an object, a metre ahead
    /// divides the distance to it by e, and a metre to the right or upwards shifts the head by a third of the distance.
    pub fn walk(&mut self, [right, up, ahead]: [f32; 3]) {
        match self.object {
            None => self.position += Quat::from_rotation_y(self.heading[0]) * Vec3::new(right, up, -ahead),
            Some(object) => {
                let away = self.position - object;
                let aside = self.orientation() * Vec3::new(right, up, 0.0) * away.length() / 3.0;
                self.position = object + away * (-ahead).exp() + aside;
            }
        }
        self.start = None;
    }

    fn orientation(&self) -> Quat {
        let [yaw, pitch] = self.heading;
        Quat::from_euler(EulerRot::YXZ, yaw, pitch, 0.0)
    }

    /// Returns the head's pose.
    pub fn pose(&self) -> Pose {
        self.start.unwrap_or_else(|| Pose { position: self.position, orientation: self.orientation() })
    }

    /// Returns the pose in the world of a `pose` relative to the head's position and heading: metres, Y up, -Z ahead.
    pub fn locate(&self, pose: Pose) -> Pose {
        let heading = Quat::from_rotation_y(self.heading[0]);
        Pose {
            position: self.position + heading * pose.position,
            orientation: (heading * pose.orientation).normalize(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: Vec3, b: Vec3) {
        assert!((a - b).length() < 1e-4, "{a} is not {b}");
    }

    #[test]
    fn the_first_pose_is_kept_to_the_bit() {
        let pose = Pose::look_at(Vec3::new(1.0, 1.6, 2.0), Vec3::new(-3.0, 1.0, 0.5));
        let mut walker = Walker::new(pose);
        assert_eq!((walker.pose(), walker.place()), (pose, None));
        walker.turn([0.0, 0.0]);
        close(walker.pose().forward(), pose.forward());
        close(walker.pose().right(), pose.right());
    }

    #[test]
    fn an_object_is_gone_around() {
        let object = Vec3::new(1.0, 2.0, 3.0);
        let from = object + Vec3::new(0.0, 0.3, 2.0);
        let mut walker = Walker::new(Pose::look_at(from, object));
        walker.go_around(Some(object));
        // After dragging by a quarter turn to the right, the side that was on the left is in front.
        walker.turn([FRAC_PI_2, 0.0]);
        close(walker.pose().position, object + Vec3::new(-2.0, 0.3, 0.0));
        walker.turn([0.0, 0.4]);
        close(walker.pose().forward() * 2.0_f32.hypot(0.3), object - walker.pose().position);
        assert!(walker.pose().position.y > object.y + 0.3, "dragged down, its upper side is seen");
        let distance = |walker: &Walker| (walker.pose().position - object).length();
        let before = distance(&walker);
        walker.walk([0.0, 0.0, 1.0]);
        assert!((distance(&walker) * 1f32.exp() / before - 1.0).abs() < 1e-4);
    }

    #[test]
    fn turning_and_walking() {
        let mut walker = Walker::new(Pose::IDENTITY);
        walker.turn([FRAC_PI_2, 0.3]);
        close(walker.pose().right(), Vec3::NEG_Z);
        assert!(walker.pose().forward().y > 0.29);
        walker.walk([1.0, 0.5, 2.0]);
        close(walker.pose().position, Vec3::new(-2.0, 0.5, -1.0));
        walker.turn([0.0, 9.0]);
        assert!(walker.pose().forward().y < 1.0 && walker.pose().orientation.is_normalized());
        let there = Walker::at(walker.place().unwrap()).unwrap();
        assert_eq!(there, walker);
        assert_eq!(Walker::at([f32::NAN; 5]), None);
        let seen = walker.locate(Pose { position: Vec3::NEG_Z, orientation: Quat::IDENTITY });
        close(seen.position, Vec3::new(-3.0, 0.5, -1.0));
    }
}
