//! `cargo xtask maintain`: the commands that only maintainers run, and the programs that tests use.

mod conformance;
pub(crate) mod direct3d;
pub mod estimate;
pub(crate) mod godot;
pub(crate) mod hello_xr;
pub mod monado;
mod renew;
mod results;

use std::path::PathBuf;

use clap::Subcommand;

use crate::console;

#[derive(Subcommand)]
pub(crate) enum Task {
    /// Estimate what whole stereo frames cost on mobile GPUs that are not here: slots and bytes, from frames counted here
    /// and shaders compiled by Mesa
    Estimate {
        /// Print the cost of the shaders themselves: instructions, registers, waves, fetches, spills; of all, or of
        /// those whose names contain this
        #[arg(long, value_name = "NAME", num_args = 0..=1, default_missing_value = "")]
        shaders: Option<String>,
        /// --shaders: these GPUs instead of those of shader-cost.csv
        #[arg(long = "gpu", value_name = "NAME", value_delimiter = ',', requires = "shaders")]
        gpus: Vec<estimate::Gpu>,
        /// --shaders: renew xtask/helpers/estimate/shader-cost.csv
        #[arg(long, requires = "shaders")]
        bless: bool,
        /// Scenes, --viewpoints, --fov-y-degrees: see `cargo xtask maintain estimate -- --help`
        #[arg(last = true, conflicts_with = "shaders")]
        frames: Vec<String>,
    },
    /// Measure what the documents say, in some hours, into docs/results, and write their tables
    Results {
        /// These suites of `yoro bench`, or the estimate, alone [default: all]
        suites: Vec<String>,
    },
    /// Renew everything that is generated: shaders for Vulkan, wgpu and three.js, the C library's header, the table of
    /// settings, and the costs of shaders
    Renew,
    /// Set up Monado, an OpenXR runtime with a simulated headset, below target/, and print how to use it
    Monado,
    /// Set up hello_xr, Khronos's example of an OpenXR application, below target/, and print how to use it
    HelloXr,
    /// Run the automatic cases of a built OpenXR conformance suite on Monado, alone and through the API layer, and compare
    /// them with the table in xtask/src/maintain/conformance.txt
    Conformance {
        /// The folder of the suite's conformance_cli
        #[arg(long, value_name = "DIR")]
        suite: PathBuf,
    },
    /// Set up Godot, a game engine, with Monado below target/, and print how to use it
    Godot,
}

/// Runs a task. Returns false if a shader has a fault.
pub(crate) fn perform(task: Task) -> anyhow::Result<bool> {
    let (text, passed) = match task {
        Task::Estimate { shaders: Some(filter), gpus, bless, .. } => {
            let compilers = estimate::Compilers::make()?;
            let filter = Some(filter).filter(|filter| !filter.is_empty());
            estimate::report(&estimate::Options { filter, gpus, bless }, &compilers, estimate::programs()?)?
        }
        Task::Estimate { frames, .. } => (estimate::frames(&frames)?, true),
        Task::Results { suites } => (results::measure(&suites)?, true),
        Task::Renew => renew::renew()?,
        Task::Monado => (monado::usage()?, true),
        Task::HelloXr => (hello_xr::usage()?, true),
        Task::Conformance { suite } => conformance::perform(&suite)?,
        Task::Godot => (godot::usage()?, true),
    };
    console::print(&text);
    Ok(passed)
}
