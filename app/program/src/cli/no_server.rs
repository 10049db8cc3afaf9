//! `yoro serve` of a program that was built without its server.

use anyhow::bail;

use crate::cli::Subcommand;

/// Stream a scene to browsers (not in this build: `cargo build --release` makes one with it)
#[derive(clap::Args, Clone, Debug)]
pub struct ServeArgs {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    arguments: Vec<String>,
}

impl Subcommand for ServeArgs {
    fn run(&self) -> anyhow::Result<()> {
        bail!("this program was built without its server: cargo build --release makes one with it")
    }
}
