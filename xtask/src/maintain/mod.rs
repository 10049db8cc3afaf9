//! `cargo xtask maintain`: the commands that only maintainers run, and the programs that tests use.

pub(crate) mod godot;
pub(crate) mod hello_xr;
pub mod monado;
mod renew;
pub mod shader_cost;

use clap::Subcommand;

use crate::console;

#[derive(Subcommand)]
pub(crate) enum Task {
    /// Renew everything that is generated: shaders for Vulkan, wgpu and three.js, the C library's header, the table of
    /// settings, and the costs of shaders
    Renew,
    /// Print the cost of the shader programs on mobile GPUs, by Mesa's compilers: instructions, registers, waves,
    /// fetches, spills
    ShaderCost {
        /// Only programs whose names contain this
        filter: Option<String>,
        /// These GPUs instead of those of app/lab/estimate/shader-cost.csv
        #[arg(long = "gpu", value_name = "NAME", value_delimiter = ',')]
        gpus: Vec<shader_cost::Gpu>,
        /// Renew app/lab/estimate/shader-cost.csv
        #[arg(long)]
        bless: bool,
    },
    /// Set up Monado, an OpenXR runtime with a simulated headset, below target/, and print how to use it
    Monado,
    /// Set up hello_xr, Khronos's example of an OpenXR application, below target/, and print how to use it
    HelloXr,
    /// Set up Godot, a game engine, with Monado below target/, and print how to use it
    Godot,
}

/// Runs a task. Returns false if a shader has a fault.
pub(crate) fn perform(task: Task) -> anyhow::Result<bool> {
    let (text, passed) = match task {
        Task::Renew => renew::renew()?,
        Task::ShaderCost { filter, gpus, bless } => {
            let compilers = shader_cost::Compilers::make()?;
            let options = shader_cost::Options { filter, gpus, bless };
            shader_cost::report(&options, &compilers, shader_cost::programs()?)?
        }
        Task::Monado => (monado::usage()?, true),
        Task::HelloXr => (hello_xr::usage()?, true),
        Task::Godot => (godot::usage()?, true),
    };
    console::print(&text);
    Ok(passed)
}
