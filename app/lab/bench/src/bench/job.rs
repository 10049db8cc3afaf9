//! A job: what is measured under one set of conditions.

use super::contender::Contender;
use super::motion::Motion;
use super::record::Conditions;
use super::runner::WAYS;
use yoro::eyes::{EyeOptions, FoveationLevel};
use yoro_assets::ShadingStyle;
use yoro_estimate::Device;
use yoro_render::RenderSettings;

/// H.264's quantizers in the suite `stream`.
pub(super) const STREAM_QUANTIZERS: [u8; 3] = [20, 26, 32];

/// The kind of measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measure {
    /// Frames at viewpoints.
    Frames {
        /// Frame times, pass times, CPU time and memory.
        cost: bool,
        /// The similarity to the ground truth.
        quality: bool,
    },
    /// Flicker along a part of the camera path.
    Flicker,
    /// Every level of foveation, by two renders and by synthesis.
    Foveation,
    /// Patchers on reprojected images.
    Patchers,
    /// One render shown at another pose.
    Reprojection(TargetPose),
    /// The frame between two renders, at 72 frames per second, by methods with levels or without.
    HalfRate(Motion, FoveationLevel),
    /// A stream whose frames are shown this number of frames later, at 72 frames per second.
    Stream(usize),
    /// Instructions that `gather` executes: an estimate for a GPU that is not available here.
    Executed(Device),
    /// The cost of whole frames: an estimate for several GPUs.
    WholeFrames,
}

/// The pose at which a render is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetPose {
    /// The pose of the same eye this number of frames later, at 72 frames per second.
    Late(Motion, usize),
    /// The pose of the other of two canted eyes.
    Canted,
}

/// The source of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A built-in scene or a file.
    Named(String),
    /// The scene of [`super::Object::swarm`].
    Swarm {
        /// The number of objects.
        copies: usize,
        /// The number of objects in the largest swarm of the suite.
        places: usize,
    },
    /// The scene of [`super::Object::at_distance`], with the distance in metres.
    Object(f32),
}

/// One setting with everything that is needed to measure it.
#[derive(Clone, Debug)]
pub struct Job {
    /// The name in the results.
    pub conditions: Conditions,
    /// The source of the scene.
    pub source: Source,
    /// A style that replaces the scene's own.
    pub style: Option<ShadingStyle>,
    /// The renderer's settings.
    pub render: RenderSettings,
    /// The eyes.
    pub eyes: EyeOptions,
    /// The divisor of the ImBuffer's resolution.
    pub imbuffer: u32,
    /// The kind of measurement.
    pub measure: Measure,
    /// The contenders. If frames are measured, the conventional method is the first.
    pub contenders: Vec<Contender>,
    /// The number of rounds.
    pub rounds: u32,
    /// The number of frames: viewpoints spread over the camera path, or frames along it.
    pub frames: usize,
}

impl Job {
    /// Returns the number of steps of progress: the preparation, and each contender's frames in each round.
    pub fn steps(&self) -> u64 {
        if let Measure::Stream(_) = self.measure {
            return (self.frames * 3 * STREAM_QUANTIZERS.len()) as u64;
        }
        if let Measure::Executed(_) | Measure::Reprojection(_) | Measure::HalfRate(..) = self.measure {
            return self.frames as u64;
        }
        if self.measure == Measure::Foveation {
            return u64::from(self.rounds) * (self.frames * WAYS) as u64;
        }
        if self.measure == Measure::WholeFrames {
            // And the same two with levels.
            return (self.frames * (self.contenders.len() + 2)) as u64;
        }
        (u64::from(self.rounds) * self.frames as u64 + 1) * self.contenders.len() as u64
    }
}
