//! `cargo tools`: the commands that only maintainers run.

mod compile;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use yoro_tools::{console, godot, hello_xr, monado, shader_cost};

/// Commands for maintainers of yoro
#[derive(Parser)]
#[command(name = "cargo tools", bin_name = "cargo tools", arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Print the cost of the shader programs on mobile GPUs, by Mesa's compilers: instructions, registers, waves,
    /// fetches, spills
    ShaderCost {
        /// Only programs whose names contain this
        filter: Option<String>,
        /// These GPUs instead of those of docs/shader-cost.csv
        #[arg(long = "gpu", value_name = "NAME", value_delimiter = ',')]
        gpus: Vec<shader_cost::Gpu>,
        /// Renew docs/shader-cost.csv
        #[arg(long)]
        bless: bool,
    },
    /// Compile the synthesis shaders for Vulkan: app/engines/core/src/vulkan/spirv
    Spirv,
    /// Compile the synthesis shaders for wgpu: app/engines/wgpu/src/wgsl
    Wgsl,
    /// Set up Monado, an OpenXR runtime with a simulated headset, below target/, and print how to use it
    Monado,
    /// Set up hello_xr, Khronos's example of an OpenXR application, below target/, and print how to use it
    HelloXr,
    /// Set up Godot, a game engine, with Monado below target/, and print how to use it
    Godot,
}

fn main() -> ExitCode {
    console::exit_code(perform(Arguments::parse().task))
}

/// Runs a task. Returns false if a shader has a fault.
fn perform(task: Task) -> anyhow::Result<bool> {
    let (text, passed) = match task {
        Task::ShaderCost { filter, gpus, bless } => {
            let compilers = shader_cost::Compilers::make()?;
            let options = shader_cost::Options { filter, gpus, bless };
            shader_cost::report(&options, &compilers, shader_cost::programs()?)?
        }
        Task::Spirv => (compile::spirv()?, true),
        Task::Wgsl => (compile::wgsl()?, true),
        Task::Monado => (monado::usage()?, true),
        Task::HelloXr => (hello_xr::usage()?, true),
        Task::Godot => (godot::usage()?, true),
    };
    console::print(&text);
    Ok(passed)
}
