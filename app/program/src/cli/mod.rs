//! The subcommands of the program `yoro`, and what they share.

#[macro_use]
pub mod terminal;

pub mod args;
pub mod bench;
pub mod choices;
pub mod compare;
pub mod dataset;
pub mod device;
pub mod eyes;
pub mod info;
pub mod layer;
pub mod machine;
pub mod message;
pub mod outputs;
pub mod render;
pub mod report;
pub mod run;
pub mod scenes;
#[cfg(feature = "serve")]
pub mod serve;
#[cfg(not(feature = "serve"))]
#[path = "no_server.rs"]
pub mod serve;
pub mod settings;
pub mod study;
pub mod synthesize;
pub mod video;
pub mod view;
pub mod xr;

use outputs::Files;

/// A subcommand with its arguments.
pub trait Subcommand {
    /// Returns the files that the subcommand reads and writes, as far as its arguments tell. [`run`] checks them first.
    ///
    /// # Errors
    /// If a folder of inputs cannot be read.
    fn files(&self) -> anyhow::Result<Files>;

    /// Runs the subcommand.
    ///
    /// # Errors
    /// One sentence for the user.
    fn run(&self) -> anyhow::Result<()>;
}

/// Runs a subcommand, unless one of its outputs would replace an input.
///
/// # Errors
/// Those of the check and of the subcommand.
pub fn run(subcommand: &dyn Subcommand) -> anyhow::Result<()> {
    subcommand.files()?.check()?;
    subcommand.run()
}
