//! The program `yoro`: its command line, one file per subcommand. The libraries do the work of the subcommands.

mod cli;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use yoro_files::interrupt;

/// Render one eye, synthesize the other
#[derive(Parser)]
#[command(version, arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Log more (-v: what is in use, -vv: everything)
    #[arg(short, long, action = clap::ArgAction::Count, global = true)]
    verbose: u8,
}

#[derive(Subcommand)]
enum Command {
    Bench(Box<cli::bench::BenchArgs>),
    Run(cli::run::RunArgs),
    Render(cli::render::RenderArgs),
    Synthesize(cli::synthesize::SynthesizeArgs),
    Report(cli::report::ReportArgs),
    Compare(cli::compare::CompareArgs),
    Dataset(cli::dataset::DatasetArgs),
    Scenes(cli::scenes::ScenesArgs),
    Device(cli::device::DeviceArgs),
    Study(cli::study::StudyArgs),
    View(cli::view::ViewArgs),
    Xr(cli::xr::XrArgs),
    Layer(cli::layer::LayerArgs),
    Info(cli::info::InfoArgs),
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let level = match arguments.verbose {
        0 => "warn",
        1 => "info",
        _ => "debug",
    };
    env_logger::Builder::from_env(env_logger::Env::default().default_filter_or(level))
        .format_timestamp(None)
        .format_target(false)
        .init();
    cli::terminal::end_with_reader();
    cli::terminal::catch_interrupt();
    let result = match &arguments.command {
        Command::Bench(args) => cli::bench::run(args),
        Command::Run(args) => cli::run::run(args),
        Command::Render(args) => cli::render::run(args),
        Command::Synthesize(args) => cli::synthesize::run(args),
        Command::Report(args) => cli::report::run(args),
        Command::Compare(args) => cli::compare::run(args),
        Command::Dataset(args) => cli::dataset::run(args),
        Command::Scenes(args) => cli::scenes::run(args),
        Command::Device(args) => cli::device::run(args),
        Command::Study(args) => cli::study::run(args),
        Command::View(args) => cli::view::run(args),
        Command::Xr(args) => cli::xr::run(args),
        Command::Layer(args) => cli::layer::run(args),
        Command::Info(args) => cli::info::run(args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {}", cli::message::of(&error));
            ExitCode::from(if interrupt::requested() { 130 } else { 2 })
        }
    }
}
