//! The origin of a measurement: machine, program, parameters.

use serde::{Deserialize, Serialize};

/// The machine, program and command of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Model name of the processor.
    pub cpu: String,
    /// Logical processors in use.
    pub cores: usize,
    /// Operating system.
    pub os: String,
    /// `GL_RENDERER`.
    pub gl_renderer: String,
    /// `GL_VERSION`.
    pub gl_version: String,
    /// The version of yoro, with the commit if it is known.
    pub yoro: String,
    /// The date and time in ISO 8601.
    pub date: String,
    /// The command that repeats the run.
    pub command: String,
}

/// One parameter of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// The name, with the unit.
    pub name: String,
    /// The value.
    pub value: String,
}
