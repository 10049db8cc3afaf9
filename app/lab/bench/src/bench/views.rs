//! The viewpoints of a setting's frames, and the motion of the head in sequences.

use anyhow::ensure;
use glam::{Quat, Vec3};

use super::job::{Job, Source};
use super::record::SceneFacts;
use yoro::eyes::{EyePair, Pose};
use yoro_assets::{CameraPath, Viewpoint};
use yoro_render::PreparedScene;
use yoro_scenes::BUILTINS;

/// The distance in metres between the frames of a sequence: walking pace at 30 frames per second.
pub(super) const STEP: f32 = 0.045;
/// The frame rate in Hz of a sequence with [`STEP`].
pub(super) const STEP_RATE: f64 = 30.0;
/// The distance between frames at the same pace and [`HEADSET_RATE`].
pub(super) const HEADSET_STEP: f32 = 0.01875;
/// The frame rate of a headset in Hz.
pub(super) const HEADSET_RATE: f64 = 72.0;

/// The number of frames from one measured frame of a motion to the next, so that they are not alike.
pub(super) const SPREAD: usize = 9;

/// The number of frames for which a head moves before the first one.
const UNDER_WAY: usize = 12;

/// Returns `wanted` of `count` indices, evenly spread and starting from the first.
pub fn spread(count: usize, wanted: usize) -> Vec<usize> {
    let wanted = wanted.min(count);
    (0..wanted).map(|i| i * count / wanted).collect()
}

/// Returns the scene's camera path.
///
/// # Errors
/// One sentence if the scene has fewer than two viewpoints.
pub fn check_path(scene: &str, viewpoints: &[Viewpoint]) -> anyhow::Result<CameraPath> {
    let path = CameraPath::new(viewpoints);
    ensure!(
        path.keys().len() > 1,
        "{scene} has no camera path: write two or more viewpoints into {scene}.camera.json beside the model, or give another camera path"
    );
    Ok(path)
}

/// The frames of a setting.
#[derive(Clone)]
pub(super) struct Views {
    pub names: Vec<String>,
    pub pairs: Vec<EyePair>,
}

impl Views {
    /// Returns viewpoints of the scene, evenly spread and starting from the first.
    pub fn spread(job: &Job, prepared: &PreparedScene) -> anyhow::Result<Views> {
        let viewpoints = &prepared.scene.viewpoints;
        let keys = spread(viewpoints.len(), job.frames);
        Views::new(job, keys.into_iter().map(|k| (format!("viewpoint {k}"), viewpoints[k].pose())).collect())
    }

    /// Returns frames that start in the middle of the camera path and are `step` metres apart.
    pub fn along_path(job: &Job, prepared: &PreparedScene, step: f32) -> anyhow::Result<Views> {
        let path = check_path(&prepared.scene.name, &prepared.scene.viewpoints)?;
        let length: f32 = path.poses(500).windows(2).map(|w| w[0].position.distance(w[1].position)).sum();
        // A path that only turns takes twenty seconds.
        let step = if length > STEP { step / length } else { step / (600.0 * STEP) };
        let pose = |i: usize| (format!("frame {i}"), path.pose(0.5 + i as f32 * step));
        Views::new(job, (0..job.frames).map(pose).collect())
    }

    /// Returns frames of a head that moves from the middle of the camera path on.
    pub fn of_motion(job: &Job, prepared: &PreparedScene, motion: Motion) -> anyhow::Result<Views> {
        let frames = UNDER_WAY + job.frames;
        let walk = Views::along_path(&Job { frames, ..job.clone() }, prepared, HEADSET_STEP)?;
        let path = CameraPath::new(&prepared.scene.viewpoints);
        let pose = |i: usize| motion.pose(path.pose(0.5), i as f32 / HEADSET_RATE as f32);
        let heads: Option<Vec<_>> = (0..frames).map(|i| Some((format!("frame {i}"), pose(i)?))).collect();
        let views = heads.map_or(Ok(walk), |heads| Views::new(job, heads))?;
        Ok(views.last(job.frames))
    }

    /// Returns the last `count` frames.
    pub fn last(mut self, count: usize) -> Views {
        let before = self.names.len().saturating_sub(count);
        self.names.drain(..before);
        self.pairs.drain(..before);
        self
    }

    /// Returns the frames of named poses of the head.
    pub fn new(job: &Job, heads: Vec<(String, Pose)>) -> anyhow::Result<Views> {
        ensure!(!heads.is_empty(), "{} has no viewpoint: give it one or more", job.conditions.scene);
        let (names, poses): (Vec<_>, Vec<_>) = heads.into_iter().unzip();
        Ok(Views { names, pairs: poses.into_iter().map(|pose| job.eyes.pair(pose)).collect() })
    }

    /// Returns the facts that the results record about the scene and these frames.
    pub fn facts(&self, job: &Job, prepared: &PreparedScene) -> SceneFacts {
        let scene = &prepared.scene;
        let builtin = BUILTINS.iter().find(|b| matches!(&job.source, Source::Named(name) if name == b.name));
        SceneFacts {
            conditions: job.conditions.clone(),
            stands_for: builtin.map_or("", |b| b.stands_for).to_owned(),
            style: scene.style,
            triangles: scene.triangle_count() as u64,
            lights: scene.lights.len().min(job.render.point_lights) as u64,
            frames: self.names.clone(),
        }
    }
}

/// The motion of a head.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Motion {
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
    fn pose(self, from: Pose, seconds: f32) -> Option<Pose> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_move_as_far_as_their_motion_says() {
        let from = Pose::look_at(Vec3::new(1.0, 1.6, 2.0), Vec3::new(4.0, 1.2, -3.0));
        let poses: Vec<Pose> =
            (0..=144).map(|i| Motion::Sway.pose(from, i as f32 / HEADSET_RATE as f32).unwrap()).collect();
        let widest = poses.iter().map(|p| p.position.distance(poses[36].position)).fold(0.0, f32::max);
        assert!((widest - 0.064).abs() < 1e-4, "{widest} m");
        let turned: f32 = poses.windows(2).map(|p| p[0].forward().distance(p[1].forward())).sum();
        // The head turns to both sides and back.
        let expected = 2.0 * from.forward().with_y(0.0).length() * 19f32.to_radians();
        assert!((turned / expected - 1.0).abs() < 0.02, "{turned} for {expected}");
        assert_eq!(Motion::Walk.pose(from, 1.0), None);
    }
}
