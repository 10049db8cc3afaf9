//! The result format of `yoro bench`: JSON lines, one file a run, appended to and never rewritten.
//!
//! ```text
//! {"record":"header","yoro_bench":1,"suites":["scenes"],"quick":false,"machine":{...},"pass_clock":"finish","parameters":[...]}
//! {"record":"scene","suite":"scenes","scene":"atrium","stands_for":"Sponza","style":"realistic","triangles":365211,"lights":12,"frames":["viewpoint 0",...]}
//! {"record":"unsupported","suite":"scenes","scene":"atrium","contender":"multiview","reason":"..."}
//! {"record":"measurement","suite":"scenes","scene":"atrium","contender":"yoro-gather","round":0,"values":{"frame_ms":[530.1,...],"psnr":[34.1,...]}}
//! ...
//! {"record":"round","suite":"scenes","scene":"atrium","round":0}
//! ```
//!
//! The first line is the [`Header`]. What follows comes in rounds: all records of a round, closed by a
//! [`RoundEnd`], in one write. Records after the last [`RoundEnd`] belong to a round that was cut off; readers
//! leave them out, and a resumed run removes them. A setting (`suite`, `scene`, and where the suite has them
//! `label` and `point`) stands in each record; its facts ([`SceneFacts`]) and [`Unsupported`] contenders come
//! with its first round, and so do values that are equal in each round (quality, memory).
//!
//! In `values` each metric has one number for each of the setting's frames, in the order of
//! [`SceneFacts::frames`]; `null` where there is no finite number: the PSNR of identical images, the quality of
//! holes where there are none. [`metric`] has the names and units.

mod file;
pub mod metric;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::machine::{Machine, Parameter};
use yoro_scene::ShadingStyle;

pub use file::{RecordError, Results, Writer};

/// Version of the format; raised when old readers would misread a new file.
pub const VERSION: u32 = 1;

/// The clock of pass times.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PassClock {
    /// Timer queries of a GPU.
    TimerQueries,
    /// The wall clock with glFinish around each pass: a CPU rasterizer, whose timer queries are unusable.
    Finish,
    /// No clock: a browser that hides timer queries. There are no pass times.
    None,
}

/// The first line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// [`VERSION`] of the format.
    pub yoro_bench: u32,
    /// The suites, in their order.
    pub suites: Vec<String>,
    /// True for the short form (`--quick`).
    pub quick: bool,
    /// Machine, driver, date and command.
    pub machine: Machine,
    /// Clock of pass times.
    pub pass_clock: PassClock,
    /// Everything that has an influence on the figures, as resolved; a run with others cannot go on with the
    /// file.
    pub parameters: Vec<Parameter>,
}

/// The conditions that are held fixed while the contenders take turns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// Name of the suite.
    pub suite: String,
    /// Name of the scene.
    pub scene: String,
    /// The point of a sweep over what has no number: the name of a shading style.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// Value of the swept variable, if there is one, in the unit of the suite (triangles, mm, m, ImBuffer divisor,
    /// pixels).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<f64>,
}

/// `ipd, atrium, 65`.
impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}", self.suite, self.scene)?;
        self.label.iter().try_for_each(|label| write!(f, ", {label}"))?;
        self.point.iter().try_for_each(|point| write!(f, ", {point}"))
    }
}

/// Facts about a setting's scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneFacts {
    /// The setting.
    #[serde(flatten)]
    pub setting: Setting,
    /// The scene of the paper that it stands for; empty if for none.
    pub stands_for: String,
    /// Shading style in use.
    pub style: ShadingStyle,
    /// Triangles of the whole scene.
    pub triangles: u64,
    /// Point lights in use, at most.
    pub lights: u64,
    /// Names of the frames that are measured, in the order of the values.
    pub frames: Vec<String>,
}

/// A contender in one round.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// The setting.
    #[serde(flatten)]
    pub setting: Setting,
    /// [`crate::bench::Contender::name`].
    pub contender: String,
    /// Counted from 0.
    pub round: u32,
    /// Values by metric: a number for each frame, `None` if it is not finite.
    pub values: BTreeMap<String, Vec<Option<f64>>>,
}

impl Measurement {
    /// Returns the finite values of a metric; empty when it was not measured.
    pub fn finite(&self, metric: &str) -> impl Iterator<Item = f64> + '_ {
        self.values.get(metric).into_iter().flatten().filter_map(|value| *value)
    }

    /// Adds the next frame's value of a metric; what is not finite becomes none.
    pub fn push(&mut self, metric: impl Into<String>, value: f64) {
        self.values.entry(metric.into()).or_default().push(value.is_finite().then_some(value));
    }
}

/// A contender that cannot take part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unsupported {
    /// The setting.
    #[serde(flatten)]
    pub setting: Setting,
    /// [`crate::bench::Contender::name`].
    pub contender: String,
    /// The reason, as a sentence or clause.
    pub reason: String,
}

/// All of a round is in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoundEnd {
    /// The setting.
    #[serde(flatten)]
    pub setting: Setting,
    /// Counted from 0.
    pub round: u32,
}

/// One line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "record", rename_all = "kebab-case")]
pub enum Record {
    /// The first line.
    Header(Header),
    /// Facts of a setting.
    Scene(SceneFacts),
    /// Figures of a contender.
    Measurement(Measurement),
    /// A contender that cannot take part.
    Unsupported(Unsupported),
    /// Closes a round.
    Round(RoundEnd),
}
