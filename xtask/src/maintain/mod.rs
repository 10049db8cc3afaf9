//! `cargo xtask maintain`: the commands that only maintainers run, and the programs that tests use.

mod compile;
pub(crate) mod godot;
pub(crate) mod hello_xr;
pub mod monado;
pub mod shader_cost;

use clap::Subcommand;

use crate::console;

#[derive(Subcommand)]
pub(crate) enum Task {
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
    /// Compile the synthesis shaders for Vulkan: app/engines/core/src/vulkan/spirv
    Spirv,
    /// Compile the synthesis shaders for wgpu: app/engines/wgpu/src/wgsl
    Wgsl,
    /// Write the synthesis shaders for three.js: app/engines/three/src/shaders.js
    Three,
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
        Task::ShaderCost { filter, gpus, bless } => {
            let compilers = shader_cost::Compilers::make()?;
            let options = shader_cost::Options { filter, gpus, bless };
            shader_cost::report(&options, &compilers, shader_cost::programs()?)?
        }
        Task::Spirv => (compile::spirv()?, true),
        Task::Wgsl => (compile::wgsl()?, true),
        Task::Three => (compile::three()?, true),
        Task::Monado => (monado::usage()?, true),
        Task::HelloXr => (hello_xr::usage()?, true),
        Task::Godot => (godot::usage()?, true),
    };
    console::print(&text);
    Ok(passed)
}
