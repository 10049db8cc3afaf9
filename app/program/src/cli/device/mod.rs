//! `yoro device`: measure on phones and headsets.

pub mod experiment;
pub mod farm;
pub mod install;
pub mod list;
pub mod logcat;
pub mod report;
pub mod run;
mod which;

use super::Subcommand;

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
    Farm(farm::FarmArgs),
    Report(report::ReportArgs),
}

impl DeviceArgs {
    fn subcommand(&self) -> &dyn Subcommand {
        match &self.command {
            Command::List(args) => args,
            Command::Install(args) => args,
            Command::Run(args) => &**args,
            Command::Logcat(args) => args,
            Command::Experiment(args) => args,
            Command::Farm(args) => args,
            Command::Report(args) => args,
        }
    }
}

impl Subcommand for DeviceArgs {
    fn run(&self) -> anyhow::Result<()> {
        self.subcommand().run()
    }
}
