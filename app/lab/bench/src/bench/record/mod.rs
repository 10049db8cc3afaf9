//! The result format of `yoro bench`: JSON lines, one file per run, appended to and never rewritten.
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
//! The first line is the [`Header`]. It is followed by rounds: all records of a round, closed by a [`RoundEnd`], are
//! written at once. Records after the last [`RoundEnd`] belong to a round that was cut off; readers ignore them, and a
//! resumed run removes them. Each record names its setting (`suite`, `scene`, and in some suites `label` or `point`).
//! The facts about a setting ([`SceneFacts`]), its [`Unsupported`] contenders, and values that do not change between
//! rounds (quality, memory) are written with its first round.
//!
//! In `values` each metric has one number for each of the setting's frames, in the order of [`SceneFacts::frames`]. It
//! is `null` if there is no finite number, as for the PSNR of identical images and the quality of holes where there are
//! none. [`metric`] has the names and units.

mod file;
pub mod metric;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::machine::{Machine, Parameter};
use yoro_assets::ShadingStyle;

pub use file::{Results, Writer};

/// The version of the format, increased when old readers would misread a new file.
pub const VERSION: u32 = 1;

/// The clock that measures passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PassClock {
    /// Timer queries of the GPU.
    TimerQueries,
    /// The wall clock with glFinish around each pass, for CPU rasterizers, whose timer queries are unusable.
    Finish,
    /// No clock, in browsers that hide timer queries. There are no pass times.
    None,
}

/// The first line of a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// The [`VERSION`] of the format.
    pub yoro_bench: u32,
    /// The suites, in the order in which they run.
    pub suites: Vec<String>,
    /// True for the short form (`--quick`).
    pub quick: bool,
    /// The machine, driver, date and command.
    pub machine: Machine,
    /// The clock that measures passes.
    pub pass_clock: PassClock,
    /// Everything that influences the figures, with defaults filled in. A run with other parameters cannot continue the
    /// file.
    pub parameters: Vec<Parameter>,
}

/// The conditions that stay fixed while the contenders take turns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// Name of the suite.
    pub suite: String,
    /// Name of the scene.
    pub scene: String,
    /// The point of a sweep that has no number, such as the name of a shading style.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// The value of the swept variable, if any, in the unit of the suite (triangles, mm, m, ImBuffer divisor, pixels).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<f64>,
}

/// Writes the setting in the form `ipd, atrium, 65`.
impl fmt::Display for Conditions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}", self.suite, self.scene)?;
        self.label.iter().try_for_each(|label| write!(f, ", {label}"))?;
        self.point.iter().try_for_each(|point| write!(f, ", {point}"))
    }
}

/// Facts about a setting's scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneFacts {
    /// The conditions.
    #[serde(flatten)]
    pub conditions: Conditions,
    /// The paper's scene that it corresponds to, or empty.
    pub stands_for: String,
    /// The shading style in use.
    pub style: ShadingStyle,
    /// Triangles of the whole scene.
    pub triangles: u64,
    /// The largest number of point lights in use.
    pub lights: u64,
    /// The names of the measured frames, in the order of the values.
    pub frames: Vec<String>,
}

/// The measurement of a contender in one round.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// The conditions.
    #[serde(flatten)]
    pub conditions: Conditions,
    /// The [name](crate::bench::Contender::name) of the contender.
    pub contender: String,
    /// The number of the round, counted from 0.
    pub round: u32,
    /// Values by metric: one number per frame, `None` if it is not finite.
    pub values: BTreeMap<String, Vec<Option<f64>>>,
}

impl Measurement {
    /// Returns the finite values of a metric; empty if it was not measured.
    pub fn finite(&self, metric: &str) -> impl Iterator<Item = f64> + '_ {
        self.values.get(metric).into_iter().flatten().filter_map(|value| *value)
    }

    /// Adds the next frame's value of a metric. A value that is not finite becomes `None`.
    pub fn push(&mut self, metric: impl Into<String>, value: f64) {
        self.values.entry(metric.into()).or_default().push(value.is_finite().then_some(value));
    }
}

/// A contender that cannot take part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unsupported {
    /// The conditions.
    #[serde(flatten)]
    pub conditions: Conditions,
    /// The [name](crate::bench::Contender::name) of the contender.
    pub contender: String,
    /// The reason, as a sentence or a clause.
    pub reason: String,
}

/// The end of a round, all of whose records are in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoundEnd {
    /// The conditions.
    #[serde(flatten)]
    pub conditions: Conditions,
    /// The number of the round, counted from 0.
    pub round: u32,
}

/// One line of a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "record", rename_all = "kebab-case")]
pub enum Record {
    /// The first line.
    Header(Header),
    /// Facts about a setting.
    Scene(SceneFacts),
    /// The measurement of a contender.
    Measurement(Measurement),
    /// A contender that cannot take part.
    Unsupported(Unsupported),
    /// The end of a round.
    Round(RoundEnd),
}
