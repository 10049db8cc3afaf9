//! Head tracking from gyroscope and accelerometer: an extended Kalman filter with bias estimation, prediction and a
//! neck model, by the formulas of the Cardboard SDK.
//!
//! Internally the axes are the screen's (X right, Y up, Z to the viewer); samples arrive in the device's own axes. The
//! filter's state is the rotation from the world (Y up) to the screen.

use glam::{DMat3, DQuat, DVec3, Quat, Vec3};

use crate::optics::Rotation;

/// Position of the eyes relative to the neck's joint, in metres.
const NECK: Vec3 = Vec3::new(0.0, 0.075, -0.080);

/// One sample of a motion sensor, in the device's axes: with the device upright, X to the right, Y up, Z out of the
/// screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MotionSample {
    /// Angular velocity in rad/s, already corrected by the device.
    Gyroscope(Vec3),
    /// Angular velocity in rad/s as measured, and the device's own estimate of its bias.
    GyroscopeUncalibrated {
        /// The angular velocity as measured.
        rate: Vec3,
        /// The bias to subtract until a better estimate is found.
        bias: Vec3,
    },
    /// Acceleration in m/s^2; points up at rest.
    Accelerometer(Vec3),
}

/// A first-order low-pass filter for samples at uneven times.
#[derive(Clone, Copy, Debug)]
struct LowPass {
    cutoff_hz: f64,
    value: Option<DVec3>,
    weight_sum: f64,
}

impl LowPass {
    fn new(cutoff_hz: f64) -> LowPass {
        LowPass { cutoff_hz, value: None, weight_sum: 0.0 }
    }

    fn add(&mut self, sample: DVec3, seconds: f64, weight: f64) -> DVec3 {
        self.weight_sum += weight;
        let time_constant = 1.0 / (std::f64::consts::TAU * self.cutoff_hz);
        let alpha = weight * seconds / (seconds + time_constant);
        let value = self.value.map_or(sample, |old| old.lerp(sample, alpha));
        *self.value.insert(value)
    }
}

/// Estimates the gyroscope's bias while the device lies still.
#[derive(Clone, Debug)]
struct BiasEstimator {
    acceleration: LowPass,
    rate: LowPass,
    bias: LowPass,
    /// Number of consecutive frames without motion.
    still: [u32; 2],
    last_direction: Option<DVec3>,
    /// Angular velocity at which the direction of gravity moves, rad/s.
    gravity_rate: DVec3,
}

impl BiasEstimator {
    const STILL_FRAMES: u32 = 50;
    const STILL_ACCELERATION: f64 = 0.5;
    const STILL_RATE: f64 = 0.03;
    const MAX_BIAS: f64 = 0.30;
    const ENOUGH_WEIGHT: f64 = 25.0;

    fn new() -> BiasEstimator {
        BiasEstimator {
            acceleration: LowPass::new(1.0),
            rate: LowPass::new(1.0),
            bias: LowPass::new(0.15),
            still: [0; 2],
            last_direction: None,
            gravity_rate: DVec3::ZERO,
        }
    }

    fn count(&mut self, sensor: usize, is_still: bool) {
        self.still[sensor] = if is_still { (self.still[sensor] + 1).min(Self::STILL_FRAMES) } else { 0 };
    }

    fn accelerometer(&mut self, acceleration: DVec3, seconds: f64) {
        let smooth = self.acceleration.add(acceleration, seconds, 1.0);
        self.count(0, (acceleration - smooth).length() < Self::STILL_ACCELERATION);
        let Some(direction) = smooth.try_normalize() else { return };
        if let Some(last) = self.last_direction
            && seconds > 1e-6
        {
            // A direction fixed in the world turns against the device's rotation in the device's axes.
            self.gravity_rate = direction.cross(last) / seconds;
        }
        self.last_direction = Some(direction);
    }

    fn gyroscope(&mut self, rate: DVec3, seconds: f64) {
        let smooth = self.rate.add(rate, seconds, 1.0);
        self.count(1, (rate - smooth).length() < Self::STILL_RATE);
        let speed = smooth.length();
        if self.still != [Self::STILL_FRAMES; 2] || speed >= Self::MAX_BIAS {
            return;
        }
        // The faster it seems to turn, the more likely it really does.
        let weight = (1.0 - speed / Self::MAX_BIAS).powi(2);
        self.bias.add(smooth - self.gravity_rate, seconds, weight);
    }

    fn bias(&self) -> Option<DVec3> {
        self.bias.value.filter(|_| self.bias.weight_sum > Self::ENOUGH_WEIGHT)
    }
}

/// Seconds between gyroscope samples. The usual interval replaces gaps.
#[derive(Clone, Copy, Debug, Default)]
struct SampleInterval {
    seconds: f64,
    samples: u32,
}

impl SampleInterval {
    const LONGEST: f64 = 0.040;
    const DEFAULT: f64 = 0.010;

    fn next(&mut self, seconds: f64) -> f64 {
        if !(0.0..=Self::LONGEST).contains(&seconds) {
            return if self.samples > 10 { self.seconds } else { Self::DEFAULT };
        }
        self.seconds = if self.samples == 0 { seconds } else { 0.95 * self.seconds + 0.05 * seconds };
        self.samples = (self.samples + 1).min(1000);
        seconds
    }
}

/// Returns the rotation about a vector by its length in radians.
fn rotation_of(vector: DVec3) -> DQuat {
    DQuat::from_scaled_axis(vector)
}

/// Returns the rotation vector that turns `from` into `to`.
fn rotation_between(from: DVec3, to: DVec3) -> DVec3 {
    match (from.try_normalize(), to.try_normalize()) {
        (Some(from), Some(to)) => DQuat::from_rotation_arc(from, to).to_scaled_axis(),
        _ => DVec3::ZERO,
    }
}

/// The head's orientation, computed from motion sensors.
#[derive(Clone, Debug)]
pub struct HeadTracker {
    rotation: Rotation,
    /// Rotation from world to screen. `None` until the first accelerometer sample; without an accelerometer, until more
    /// than 100 gyroscope samples have arrived.
    screen_from_world: Option<DQuat>,
    covariance: DMat3,
    /// Angular velocity in rad/s, smoothed for prediction.
    velocity: LowPass,
    bias: BiasEstimator,
    interval: SampleInterval,
    gyroscope_ns: Option<i64>,
    accelerometer_ns: Option<i64>,
    acceleration_norm: Option<f64>,
    norm_change: f64,
    newest_ns: i64,
}

impl HeadTracker {
    const START_COVARIANCE: f64 = 25.0;
    const SIGMA: [f64; 2] = [0.75, 7.0];
    const MAX_NORM_CHANGE: f64 = 0.15;
    const MAX_PREDICTION: f64 = 0.1;

    /// Returns a tracker that has received no samples.
    pub fn new(rotation: Rotation) -> HeadTracker {
        HeadTracker {
            rotation,
            screen_from_world: None,
            covariance: DMat3::from_diagonal(DVec3::splat(Self::START_COVARIANCE)),
            velocity: LowPass::new(6.0),
            bias: BiasEstimator::new(),
            interval: SampleInterval::default(),
            gyroscope_ns: None,
            accelerometer_ns: None,
            acceleration_norm: None,
            norm_change: 0.0,
            newest_ns: 0,
        }
    }

    /// Sets the rotation of the screen's content. Starts over if it has changed.
    pub fn set_rotation(&mut self, rotation: Rotation) {
        if rotation != self.rotation {
            *self = HeadTracker::new(rotation);
        }
    }

    /// Starts over: straight ahead becomes where the head points at the next accelerometer sample. Keeps the estimate
    /// of the gyroscope's bias.
    pub fn recenter(&mut self) {
        let (bias, interval) = (self.bias.clone(), self.interval);
        *self = HeadTracker { bias, interval, ..HeadTracker::new(self.rotation) };
    }

    /// Resets the velocity, so that nothing keeps moving while no samples arrive.
    pub fn pause(&mut self) {
        self.velocity = LowPass::new(self.velocity.cutoff_hz);
        self.gyroscope_ns = None;
    }

    fn to_screen(&self, device: Vec3) -> DVec3 {
        let v = device.as_dvec3();
        match self.rotation {
            Rotation::Portrait => v,
            Rotation::LandscapeLeft => DVec3::new(-v.y, v.x, v.z),
            Rotation::LandscapeRight => DVec3::new(v.y, -v.x, v.z),
        }
    }

    /// Adds a sample with its time in nanoseconds. Ignores samples out of order and values that are not finite.
    pub fn add(&mut self, sample: MotionSample, timestamp_ns: i64) {
        match sample {
            MotionSample::Gyroscope(rate) => self.gyroscope(rate, Vec3::ZERO, timestamp_ns),
            MotionSample::GyroscopeUncalibrated { rate, bias } => self.gyroscope(rate, bias, timestamp_ns),
            MotionSample::Accelerometer(acceleration) => self.accelerometer(acceleration, timestamp_ns),
        }
    }

    fn gyroscope(&mut self, rate: Vec3, device_bias: Vec3, timestamp_ns: i64) {
        if !rate.is_finite() || self.gyroscope_ns.is_some_and(|last| timestamp_ns <= last) {
            return;
        }
        let device_bias = if device_bias.is_finite() { device_bias } else { Vec3::ZERO };
        let (measured, device_bias) = (self.to_screen(rate), self.to_screen(device_bias));
        let last = self.gyroscope_ns.replace(timestamp_ns);
        self.newest_ns = self.newest_ns.max(timestamp_ns);
        let Some(last) = last else {
            self.bias.gyroscope(measured, 0.0);
            self.velocity.add(measured - self.bias.bias().unwrap_or(device_bias), 0.0, 1.0);
            return;
        };
        let seconds = self.interval.next((timestamp_ns - last) as f64 * 1e-9);
        self.bias.gyroscope(measured, seconds);
        let rate = measured - self.bias.bias().unwrap_or(device_bias);
        self.velocity.add(rate, seconds, 1.0);
        // Without an accelerometer there is no "up" to wait for.
        if self.screen_from_world.is_none() && self.accelerometer_ns.is_none() && self.interval.samples > 100
        {
            self.screen_from_world = Some(DQuat::IDENTITY);
        }
        if let Some(pose) = &mut self.screen_from_world {
            // In the device's axes the world turns the opposite way.
            let turn = rotation_of(-rate * seconds);
            *pose = (turn * *pose).normalize();
            let m = DMat3::from_quat(turn);
            self.covariance =
                m * self.covariance * m.transpose() + DMat3::from_diagonal(DVec3::splat(seconds * seconds));
        }
    }

    fn accelerometer(&mut self, acceleration: Vec3, timestamp_ns: i64) {
        if !acceleration.is_finite() || self.accelerometer_ns.is_some_and(|last| timestamp_ns <= last) {
            return;
        }
        let measured = self.to_screen(acceleration);
        let last = self.accelerometer_ns.replace(timestamp_ns);
        self.newest_ns = self.newest_ns.max(timestamp_ns);
        let seconds = last.map_or(0.0, |last| (timestamp_ns - last) as f64 * 1e-9).min(1.0);
        self.bias.accelerometer(measured, seconds);
        let norm = measured.length();
        let change = self.acceleration_norm.replace(norm).map_or(0.0, |last| (norm - last).abs());
        if norm < 1e-3 {
            return;
        }
        let Some(pose) = self.screen_from_world else {
            self.screen_from_world = Some(upright(measured));
            return;
        };
        // If the acceleration changes, the device is being moved, and does not measure gravity alone.
        self.norm_change = 0.5 * change + 0.5 * self.norm_change;
        let [low, high] = Self::SIGMA;
        let sigma = (low + self.norm_change / Self::MAX_NORM_CHANGE * (high - low)).min(high);
        let innovation = |pose: DQuat| rotation_between(pose * DVec3::Y, measured);
        let now = innovation(pose);
        const DELTA: f64 = 1e-7;
        let column = |axis: DVec3| (now - innovation(rotation_of(axis * DELTA) * pose)) / DELTA;
        let jacobian = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
        let noise = DMat3::from_diagonal(DVec3::splat(sigma * sigma));
        let residual = jacobian * self.covariance * jacobian.transpose() + noise;
        let gain = self.covariance * jacobian.transpose() * residual.inverse();
        let turn = rotation_of(gain * now);
        if !turn.is_finite() {
            return;
        }
        self.screen_from_world = Some((turn * pose).normalize());
        let m = DMat3::from_quat(turn);
        self.covariance = m * (self.covariance - gain * jacobian * self.covariance) * m.transpose();
    }

    /// True once samples have determined the orientation.
    pub fn is_ready(&self) -> bool {
        self.screen_from_world.is_some()
    }

    /// Returns the time of the newest sample in nanoseconds, 0 before the first.
    pub fn newest_ns(&self) -> i64 {
        self.newest_ns
    }

    /// Returns the rotation from world to head `seconds` (at most 0.1) after the newest sample, at constant angular
    /// velocity.
    pub fn head_from_world(&self, seconds: f64) -> Quat {
        let seconds = seconds.clamp(0.0, Self::MAX_PREDICTION);
        let pose = self.screen_from_world.unwrap_or(DQuat::IDENTITY);
        let velocity = self.velocity.value.unwrap_or(DVec3::ZERO);
        (rotation_of(-velocity * seconds) * pose).normalize().as_quat()
    }

    /// Returns the rotation from head to world at `target_ns`. The samples' clock may differ from that of the frames: a
    /// target shortly after the newest sample is predicted from that sample, any other from `now_ns`.
    pub fn world_from_head(&self, now_ns: i64, target_ns: i64) -> Quat {
        let since_sample = target_ns - self.newest_ns;
        let reach = (2.0 * Self::MAX_PREDICTION * 1e9) as i64;
        let ahead = if (0..=reach).contains(&since_sample) { since_sample } else { target_ns - now_ns };
        self.head_from_world(ahead as f64 * 1e-9).inverse()
    }
}

/// Returns the rotation from the world to a screen that measures `up`, heading along the viewing direction.
fn upright(up: DVec3) -> DQuat {
    let Some(up) = up.try_normalize() else { return DQuat::IDENTITY };
    // Looking straight up or down there is no heading, so the smallest rotation is used.
    match DVec3::NEG_Z.reject_from_normalized(up).try_normalize() {
        Some(forward) if DVec3::NEG_Z.dot(up).abs() < 0.99 => {
            DQuat::from_mat3(&DMat3::from_cols(forward.cross(up), up, -forward))
        }
        _ => DQuat::from_rotation_arc(DVec3::Y, up),
    }
}

/// Returns how far, in metres, a rotation about the neck moves the point between the eyes from the neck's axis: (0,
/// 0.075, -0.080) rotated, minus (0, 0.075, 0).
pub fn neck_offset(rotation: Quat) -> Vec3 {
    rotation * NECK - Vec3::new(0.0, NECK.y, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;

    fn close(a: Quat, b: [f32; 4]) {
        let b = Quat::from_array(b);
        assert!(a.dot(b).abs() > 1.0 - 1e-6 && (a.xyz() - b.xyz()).length() < 2e-4, "{a} is not {b}");
    }

    fn upright_tracker() -> HeadTracker {
        let mut tracker = HeadTracker::new(Rotation::LandscapeLeft);
        tracker.add(MotionSample::Accelerometer(Vec3::new(9.81, 0.0, 0.0)), 0);
        tracker
    }

    /// 0.5 rad/s about the device's X axis at 100 Hz for a second.
    fn turned_left() -> HeadTracker {
        let mut tracker = upright_tracker();
        for i in 0..=100 {
            tracker.add(MotionSample::Gyroscope(Vec3::new(0.5, 0.0, 0.0)), i * 10 * MS);
        }
        tracker
    }

    #[test]
    fn orientations_equal_the_references() {
        close(upright_tracker().head_from_world(0.0), [0.0, 0.0, 0.0, 1.0]);
        let tracker = turned_left();
        let pose = tracker.head_from_world(0.0);
        close(pose, [0.0, -0.247404, 0.0, 0.968912]);
        close(tracker.head_from_world(0.05), [0.0, -0.259496, 0.0, 0.965744]);
        let neck = neck_offset(pose);
        assert!((neck - Vec3::new(0.03835, 0.0, -0.07021)).length() < 1e-5, "{neck}");
    }

    #[test]
    fn a_head_turned_left_looks_left_with_eyes_left_of_the_neck() {
        let world_from_head = turned_left().world_from_head(1000 * MS, 1000 * MS);
        assert!((world_from_head * Vec3::NEG_Z).x < -0.4);
        assert!(neck_offset(world_from_head).x < -0.03);
    }

    #[test]
    fn prediction_goes_from_the_newest_sample_and_is_bounded() {
        let tracker = turned_left();
        let angle = |now, target| tracker.world_from_head(now * MS, target * MS).to_scaled_axis().y;
        assert!((angle(1000, 1050) - 0.525).abs() < 1e-3);
        assert!((angle(1040, 1050) - 0.525).abs() < 1e-3);
        assert!((angle(1000, 1150) - 0.55).abs() < 1e-3);
        // The samples have another clock.
        assert!((angle(500_000, 500_020) - 0.51).abs() < 1e-3);
    }

    #[test]
    fn landscape_right_is_landscape_left_upside_down() {
        let mut tracker = HeadTracker::new(Rotation::LandscapeRight);
        tracker.add(MotionSample::Accelerometer(Vec3::new(-9.81, 0.0, 0.0)), 0);
        close(tracker.head_from_world(0.0), [0.0, 0.0, 0.0, 1.0]);
    }

    #[test]
    fn gravity_gives_pitch_and_roll_and_no_heading() {
        for (pitch, roll) in [(0.7f32, 0.0f32), (-0.9, 0.4), (0.2, -1.2)] {
            let head = Quat::from_rotation_x(pitch) * Quat::from_rotation_z(roll);
            let up = head.inverse() * Vec3::Y * 9.81;
            let mut tracker = HeadTracker::new(Rotation::Portrait);
            tracker.add(MotionSample::Accelerometer(up), 0);
            let found = tracker.head_from_world(0.0).inverse();
            assert!(found.angle_between(head) < 1e-3, "{found} is not {head}");
        }
    }

    #[test]
    fn tilt_drift_is_corrected_by_gravity() {
        let mut tracker = upright_tracker();
        // The gyroscope reports that the head nods, gravity that it does not.
        for i in 1..=1000 {
            tracker.add(MotionSample::Gyroscope(Vec3::new(0.0, 0.02, 0.0)), i * 10 * MS);
            tracker.add(MotionSample::Accelerometer(Vec3::new(9.81, 0.0, 0.0)), i * 10 * MS);
        }
        let tilt = (tracker.head_from_world(0.0) * Vec3::Y).angle_between(Vec3::Y);
        assert!(tilt < 0.05, "{tilt} of 0.2 rad are left");
    }

    #[test]
    fn a_constant_bias_is_found_while_lying_still() {
        let mut tracker = upright_tracker();
        let bias = Vec3::new(0.02, -0.01, 0.015);
        let feed = |tracker: &mut HeadTracker, from: i64, to: i64| {
            for i in from..to {
                tracker.add(MotionSample::Gyroscope(bias), i * 5 * MS);
                tracker.add(MotionSample::Accelerometer(Vec3::new(9.81, 0.0, 0.0)), i * 5 * MS);
            }
        };
        feed(&mut tracker, 1, 4000);
        let before = tracker.head_from_world(0.0);
        feed(&mut tracker, 4000, 6000);
        let drift = before.angle_between(tracker.head_from_world(0.0));
        // Without correction, ten seconds would turn it by 0.2 rad.
        assert!(drift < 0.01, "{drift}");
    }

    #[test]
    fn a_turning_head_is_not_taken_for_bias() {
        let mut tracker = upright_tracker();
        for i in 1..2000i64 {
            let rate = 0.8 * (i as f32 * 0.03).sin();
            tracker.add(MotionSample::Gyroscope(Vec3::new(rate, 0.0, 0.0)), i * 5 * MS);
            tracker.add(MotionSample::Accelerometer(Vec3::new(9.81, 0.0, 0.0)), i * 5 * MS);
        }
        assert_eq!(tracker.bias.bias(), None);
    }

    #[test]
    fn the_devices_own_bias_is_used_until_one_is_estimated() {
        let mut tracker = upright_tracker();
        let bias = Vec3::new(0.1, 0.0, 0.0);
        for i in 0..=100 {
            tracker.add(MotionSample::GyroscopeUncalibrated { rate: bias, bias }, i * 10 * MS);
        }
        close(tracker.head_from_world(0.05), [0.0, 0.0, 0.0, 1.0]);
    }

    #[test]
    fn a_gap_between_samples_counts_as_the_usual_interval() {
        let mut interval = SampleInterval::default();
        assert_eq!(interval.next(5.0), 0.01);
        for _ in 0..20 {
            assert_eq!(interval.next(0.004), 0.004);
        }
        assert!((interval.next(5.0) - 0.004).abs() < 1e-9);
    }

    #[test]
    fn recentering_and_pausing() {
        let mut tracker = turned_left();
        tracker.pause();
        close(tracker.head_from_world(0.05), [0.0, -0.247404, 0.0, 0.968912]);
        tracker.recenter();
        assert!(!tracker.is_ready());
        tracker.add(MotionSample::Accelerometer(Vec3::new(9.81, 0.0, 0.0)), 2000 * MS);
        close(tracker.head_from_world(0.0), [0.0, 0.0, 0.0, 1.0]);
    }

    #[test]
    fn a_gyroscope_alone_turns_the_head_too() {
        let mut tracker = HeadTracker::new(Rotation::LandscapeLeft);
        for i in 0..=300 {
            tracker.add(MotionSample::Gyroscope(Vec3::new(0.5, 0.0, 0.0)), i * 10 * MS);
        }
        assert!(tracker.world_from_head(3000 * MS, 3000 * MS).to_scaled_axis().y > 0.9);
    }

    proptest::proptest! {
        #[test]
        fn any_samples_give_a_rotation(samples in proptest::collection::vec((0u8..3, -50f32..50.0, -50f32..50.0, -50f32..50.0, -10i64..60), 0..200)) {
            let mut tracker = HeadTracker::new(Rotation::LandscapeLeft);
            let mut time = 0;
            for (kind, x, y, z, ms) in samples {
                time += ms * MS;
                let v = Vec3::new(x, y, z);
                tracker.add(match kind {
                    0 => MotionSample::Gyroscope(v),
                    1 => MotionSample::GyroscopeUncalibrated { rate: v, bias: v * 0.1 },
                    _ => MotionSample::Accelerometer(v),
                }, time);
            }
            let q = tracker.world_from_head(time, time + 20 * MS);
            proptest::prop_assert!((q.length() - 1.0).abs() < 1e-4);
        }
    }
}
