//! Smooth camera paths through key viewpoints.

use std::path::Path;

use glam::Vec3;

use super::error::SceneError;
use super::model::Viewpoint;
use yoro::eyes::Pose;

/// Reads the key viewpoints of a camera path from a file in the format of `camera.json`.
///
/// # Errors
/// [`SceneError`], also if the file has no viewpoint.
pub fn read(file: &Path) -> Result<Vec<Viewpoint>, SceneError> {
    let malformed = |what: String| {
        SceneError(format!(
            "{} is not a camera path ({what}): give a JSON array of {{position, target}}",
            file.display()
        ))
    };
    let bytes = yoro_files::read(file).map_err(|error| SceneError(error.to_string()))?;
    let viewpoints: Vec<Viewpoint> =
        serde_json::from_slice(&bytes).map_err(|error| malformed(error.to_string()))?;
    check(&viewpoints).map_err(malformed)?;
    Ok(viewpoints)
}

/// Maximum distance from the origin in metres: f32 has steps of 8 mm there, an eighth of the distance between the eyes.
pub const FARTHEST: f32 = 1e5;

/// Checks the viewpoints of a file. The error describes the fault.
pub(super) fn check(viewpoints: &[Viewpoint]) -> Result<(), String> {
    if viewpoints.is_empty() {
        return Err("there is no viewpoint in it".into());
    }
    for (i, v) in viewpoints.iter().enumerate() {
        if !v.position.is_finite() || !v.target.is_finite() {
            return Err(format!("viewpoint {} has coordinates that are not numbers", i + 1));
        }
        let away = v.position.length().max(v.target.length());
        if away > FARTHEST {
            return Err(format!(
                "viewpoint {} is {away} m away from the origin, {FARTHEST} m at most tell the eyes apart",
                i + 1
            ));
        }
        if v.position.distance(v.target) < 1e-6 {
            return Err(format!("viewpoint {} looks at the place where it is", i + 1));
        }
    }
    Ok(())
}

/// Steps per segment of the table that maps path length to the curve parameter.
const STEPS: usize = 32;

/// A smooth path through key viewpoints: centripetal Catmull-Rom splines (no loops, no overshoot) for position and
/// target, traversed at constant speed. Where only the target moves, its path determines the time.
#[derive(Clone, Debug)]
pub struct CameraPath {
    keys: Vec<Viewpoint>,
    /// Share of the path's length up to every step of every segment, from 0 to 1, including the first and the last.
    lengths: Vec<f32>,
}

impl CameraPath {
    /// Creates a path through these viewpoints. Consecutive equal ones count once.
    ///
    /// # Panics
    /// If there is no viewpoint; a [`crate::Scene`] has at least one.
    pub fn new(viewpoints: &[Viewpoint]) -> CameraPath {
        assert!(!viewpoints.is_empty(), "a camera path needs at least one viewpoint");
        let mut keys = viewpoints.to_vec();
        keys.dedup();
        let mut path = CameraPath { keys, lengths: Vec::new() };
        let steps = (path.keys.len() - 1) * STEPS;
        let mut length = 0.0;
        let mut lengths = vec![0.0];
        let mut last = path.at(0, 0.0);
        for i in 1..=steps {
            let (segment, u) = ((i - 1) / STEPS, ((i - 1) % STEPS + 1) as f32 / STEPS as f32);
            let here = path.at(segment, u);
            // Turning by 90 degrees takes as long as walking about 0.8 m.
            let turn = last.pose().forward().distance(here.pose().forward()) * 0.5;
            length += (here.position.distance(last.position) + turn).max(1e-6);
            lengths.push(length);
            last = here;
        }
        if length > 0.0 {
            lengths.iter_mut().for_each(|l| *l /= length);
        }
        path.lengths = lengths;
        path
    }

    /// Returns the viewpoint at `t`, 0 at the first key and 1 at the last; clamped outside. Exact at the keys.
    pub fn viewpoint(&self, t: f32) -> Viewpoint {
        let steps = self.lengths.len() - 1;
        if steps == 0 {
            return self.keys[0];
        }
        let t = if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) };
        let i = self.lengths.partition_point(|&l| l <= t).clamp(1, steps) - 1;
        let (a, b) = (self.lengths[i], self.lengths[i + 1]);
        let f = if b > a { ((t - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
        self.at(i / STEPS, ((i % STEPS) as f32 + f) / STEPS as f32)
    }

    /// Returns the head's pose at `t`, 0 at the first key and 1 at the last.
    pub fn pose(&self, t: f32) -> Pose {
        self.viewpoint(t).pose()
    }

    /// Returns `n` evenly spaced poses from the first key to the last, inclusive; the first key for `n` = 1.
    pub fn poses(&self, n: usize) -> Vec<Pose> {
        (0..n).map(|i| self.pose(i as f32 / (n.max(2) - 1) as f32)).collect()
    }

    /// Returns the key viewpoints that the path goes through.
    pub fn keys(&self) -> &[Viewpoint] {
        &self.keys
    }

    fn at(&self, segment: usize, u: f32) -> Viewpoint {
        let last = self.keys.len() - 1;
        let key = |i: usize| self.keys[i.min(last)];
        if u <= 0.0 || segment >= last {
            return key(segment);
        }
        if u >= 1.0 {
            return key(segment + 1);
        }
        let curve = |get: fn(&Viewpoint) -> Vec3| {
            let (p1, p2) = (get(&key(segment)), get(&key(segment + 1)));
            // The end segments continue straight.
            let p0 = if segment == 0 { p1 * 2.0 - p2 } else { get(&key(segment - 1)) };
            let p3 = if segment + 2 > last { p2 * 2.0 - p1 } else { get(&key(segment + 2)) };
            centripetal(p0, p1, p2, p3, u)
        };
        let (position, target) = (curve(|v| v.position), curve(|v| v.target));
        // A target that passes through the position would turn the head arbitrarily.
        if position.distance_squared(target) < 1e-8 {
            return Viewpoint { position, target: position + key(segment).pose().forward() };
        }
        Viewpoint { position, target }
    }
}

/// Evaluates centripetal Catmull-Rom between `p1` and `p2` (the pyramid of Barry and Goldman, 1988).
fn centripetal(p0: Vec3, p1: Vec3, p2: Vec3, p3: Vec3, u: f32) -> Vec3 {
    let interval = |a: Vec3, b: Vec3| a.distance(b).sqrt();
    let middle = interval(p1, p2);
    if middle < 1e-6 {
        return p1.lerp(p2, u);
    }
    // A neighbour that coincides has no interval of its own.
    let or_middle = |d: f32| if d < 1e-6 { middle } else { d };
    let t1 = or_middle(interval(p0, p1));
    let t2 = t1 + middle;
    let t3 = t2 + or_middle(interval(p2, p3));
    let t = t1 + u * middle;
    let mix = |a: Vec3, b: Vec3, ta: f32, tb: f32| a.lerp(b, (t - ta) / (tb - ta));
    let (a1, a2, a3) = (mix(p0, p1, 0.0, t1), mix(p1, p2, t1, t2), mix(p2, p3, t2, t3));
    let (b1, b2) = (mix(a1, a2, 0.0, t2), mix(a2, a3, t1, t3));
    mix(b1, b2, t1, t2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn view(p: [f32; 3], t: [f32; 3]) -> Viewpoint {
        Viewpoint { position: p.into(), target: t.into() }
    }

    #[test]
    fn a_path_of_one_viewpoint_does_not_move() {
        let v = view([1.0, 2.0, 3.0], [0.0, 0.0, 0.0]);
        let path = CameraPath::new(&[v, v]);
        for t in [-1.0, 0.0, 0.3, 1.0, f32::NAN] {
            assert_eq!(path.viewpoint(t), v);
        }
        assert_eq!(path.poses(3), vec![v.pose(); 3]);
    }

    #[test]
    fn a_path_of_two_viewpoints_is_straight_and_even() {
        let path = CameraPath::new(&[
            view([0.0, 0.0, 0.0], [0.0, 0.0, -5.0]),
            view([4.0, 0.0, 0.0], [4.0, 0.0, -5.0]),
        ]);
        for i in 0..=10 {
            let t = i as f32 / 10.0;
            let v = path.viewpoint(t);
            assert!((v.position - Vec3::new(4.0 * t, 0.0, 0.0)).length() < 1e-3, "{t}: {}", v.position);
        }
    }

    proptest! {
        #[test]
        fn exact_at_keys_continuous_and_even(points in proptest::collection::vec((-20f32..20.0, 0f32..3.0, -20f32..20.0, 0f32..6.2), 2..9)) {
            let keys: Vec<Viewpoint> = points.iter().map(|&(x, y, z, a)| {
                let p = Vec3::new(x, y, z);
                Viewpoint { position: p, target: p + Vec3::new(a.cos(), -0.1, a.sin()) * 4.0 }
            }).collect();
            let path = CameraPath::new(&keys);
            for (i, key) in path.keys().iter().enumerate() {
                let v = path.viewpoint(path.lengths[i * STEPS]);
                prop_assert!(v.position.distance(key.position) < 1e-3 && v.target.distance(key.target) < 1e-3);
            }
            prop_assert_eq!(path.viewpoint(0.0), keys[0]);
            prop_assert_eq!(path.viewpoint(1.0), keys[keys.len() - 1]);
            let n = 2000;
            let poses = path.poses(n);
            let total: f32 = poses.windows(2).map(|w| w[0].position.distance(w[1].position)).sum();
            for w in poses.windows(2) {
                let step = w[0].position.distance(w[1].position);
                prop_assert!(step.is_finite() && step < 4.0 * (total + 40.0) / n as f32, "a jump of {step} of {total}");
            }
        }
    }
}
