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

/// A subcommand with its arguments.
pub trait Subcommand {
    /// Runs the subcommand.
    ///
    /// # Errors
    /// One sentence for the user.
    fn run(&self) -> anyhow::Result<()>;
}
