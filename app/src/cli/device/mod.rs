//! `yoro device`: measure on phones and headsets.

pub mod experiment;
pub mod install;
pub mod list;
pub mod logcat;
pub mod report;
pub mod run;
mod which;

/// Measure on phones and headsets
#[derive(clap::Args, Clone, Debug)]
pub struct DeviceArgs {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand, Clone, Debug)]
enum Command {
    List(list::ListArgs),
    Install(install::InstallArgs),
    Run(Box<run::RunArgs>),
    Logcat(logcat::LogcatArgs),
    Experiment(experiment::ExperimentArgs),
    Report(report::ReportArgs),
}

/// Runs the subcommand.
pub fn run(args: &DeviceArgs) -> anyhow::Result<()> {
    match &args.command {
        Command::List(args) => list::run(args),
        Command::Install(args) => install::run(args),
        Command::Run(args) => run::run(args),
        Command::Logcat(args) => logcat::run(args),
        Command::Experiment(args) => experiment::run(args),
        Command::Report(args) => report::run(args),
    }
}
