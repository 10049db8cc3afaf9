//! The program `yoro`: its command line, with one file per subcommand. The libraries do the work.

mod cli;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory as _, FromArgMatches as _, Parser};
use cli::{Subcommand, terminal};
use yoro_files::interrupt;

/// Render one eye, synthesize the other
#[derive(Parser)]
#[command(name = "yoro", version, arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Log more (-v: what is in use, -vv: everything)
    #[arg(short, long, action = clap::ArgAction::Count, global = true)]
    verbose: u8,
}

#[derive(clap::Subcommand)]
enum Command {
    Bench(Box<cli::bench::BenchArgs>),
    Run(cli::run::RunArgs),
    Render(Box<cli::render::RenderArgs>),
    Synthesize(cli::synthesize::SynthesizeArgs),
    Report(cli::report::ReportArgs),
    Compare(cli::compare::CompareArgs),
    Dataset(cli::dataset::DatasetArgs),
    Scenes(cli::scenes::ScenesArgs),
    Device(cli::device::DeviceArgs),
    Study(cli::study::StudyArgs),
    View(cli::view::ViewArgs),
    Serve(cli::serve::ServeArgs),
    Xr(cli::xr::XrArgs),
    Layer(cli::layer::LayerArgs),
    Info(cli::info::InfoArgs),
}

impl Command {
    fn subcommand(&self) -> &dyn Subcommand {
        match self {
            Command::Bench(args) => &**args,
            Command::Run(args) => args,
            Command::Render(args) => &**args,
            Command::Synthesize(args) => args,
            Command::Report(args) => args,
            Command::Compare(args) => args,
            Command::Dataset(args) => args,
            Command::Scenes(args) => args,
            Command::Device(args) => args,
            Command::Study(args) => args,
            Command::View(args) => args,
            Command::Serve(args) => args,
            Command::Xr(args) => args,
            Command::Layer(args) => args,
            Command::Info(args) => args,
        }
    }
}

fn main() -> ExitCode {
    let matches = Arguments::command().get_matches();
    let arguments = Arguments::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    yoro_files::protect(inputs(&Arguments::command(), &matches));
    let level = match arguments.verbose {
        0 => "warn",
        1 => "info",
        _ => "debug",
    };
    terminal::log_from(level);
    terminal::quiet_decoders();
    terminal::catch_interrupt();
    match arguments.command.subcommand().run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {}", cli::message::of(&error));
            ExitCode::from(if interrupt::requested() { 130 } else { 2 })
        }
    }
}

/// Returns what the innermost subcommand is given without an option, which is its inputs.
fn inputs(command: &clap::Command, matches: &clap::ArgMatches) -> Vec<PathBuf> {
    match matches.subcommand() {
        Some((name, matches)) => {
            command.find_subcommand(name).map_or_else(Vec::new, |command| inputs(command, matches))
        }
        None => {
            let given =
                command.get_positionals().filter_map(|input| matches.get_raw(input.get_id().as_str()));
            given.flatten().map(PathBuf::from).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_defaults(command: &clap::Command) {
        for argument in command.get_arguments() {
            let values = argument.get_default_values();
            assert!(
                values.len() <= 1,
                "{} {argument}: help shows {values:?} with spaces",
                command.get_name()
            );
        }
        command.get_subcommands().for_each(check_defaults);
    }

    #[test]
    fn defaults_in_the_help_can_be_typed() {
        let command = Arguments::command();
        command.clone().debug_assert();
        check_defaults(&command);
    }
}
