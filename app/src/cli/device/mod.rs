//! `yoro device`: measure on phones and headsets.

pub mod report;

/// Measure on phones and headsets
#[derive(clap::Args, Clone, Debug)]
pub struct DeviceArgs {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand, Clone, Debug)]
enum Command {
    Report(report::ReportArgs),
}

/// Runs the subcommand.
pub fn run(args: &DeviceArgs) -> anyhow::Result<()> {
    match &args.command {
        Command::Report(args) => report::run(args),
    }
}
