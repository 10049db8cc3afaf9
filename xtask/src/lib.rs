//! `cargo xtask`: set-up, runs, tests, packages, and what only maintainers run ([`maintain`]).
//!
//! This is a library so that its helpers and some tests can use parts of it. The inputs are the workspace's sources and
//! Debian packages, the outputs are folders below `target`. It runs cargo and other programs, and compiles in seconds:
//! what needs larger dependencies is in `helpers`.

mod android;
mod apt;
mod arm64;
mod bevy;
pub mod cargo;
pub mod console;
pub mod folders;
mod godot;
mod kit;
mod lint;
pub mod maintain;
pub mod ndk;
mod notices;
mod package;
mod packages;
pub mod release;
mod rust;
mod setup;
mod site;
mod testing;
mod web;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// What to try after a first run.
const NEXT: &str = "
next:
  cargo xtask run model.glb    the same with a scene of yours (OBJ, glTF, GLB)
  cargo xtask web --serve      walk through the scenes in a browser, by cable on a phone or headset, too
  cargo xtask bevy run         the plugin for Bevy: a room in both eyes
";

/// Set up, run and test yoro
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Install missing system libraries with apt, or say what to install
    Setup,
    /// Set up, then run `yoro run`: renders the built-in scenes in both ways and writes pictures and a report
    Run {
        /// Passed on to `yoro run`
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    Test(testing::Options),
    Apk(android::Options),
    /// Print what builds the Android application, what is missing, and how to get it
    Doctor,
    /// Check that Android will install and start an APK, or what a store makes of a bundle
    CheckApk {
        /// The APK or the bundle
        file: PathBuf,
        /// Check that this store takes it, too
        #[arg(long, value_name = "NAME")]
        store: Option<android::check::Store>,
    },
    /// Pack the C library into target/package: with pkg-config and CMake files for Linux, as an AAR for
    /// Android; the OpenXR layer for both; the add-on for Godot; the package for three.js
    Package {
        /// Make only these packages [default: all]
        #[arg(long = "target", value_name = "NAME", value_delimiter = ',')]
        targets: Vec<package::Target>,
    },
    /// Build everything that is published, with checksums and RELEASE.md
    Release {
        /// Where to put the files
        #[arg(long, value_name = "DIR", default_value = "dist")]
        out: PathBuf,
        /// Make only these [default: all]
        #[arg(long, value_name = "NAME", value_delimiter = ',')]
        only: Vec<release::Item>,
    },
    /// Build the site into target/site: the page, the guides, rustdoc, downloads
    Site {
        /// Offer the files of a release in this folder
        #[arg(long, value_name = "DIR")]
        release: Option<PathBuf>,
    },
    /// Write the shader kit into target/kit: synthesis for engines that want no library
    Kit,
    /// The plugin for Bevy: an example, its tests
    Bevy {
        #[command(subcommand)]
        task: bevy::Task,
    },
    /// The add-on for Godot: its project, its tests
    Godot {
        #[command(subcommand)]
        task: godot::Task,
    },
    /// Build the page, which shows every method in a browser's WebGL 2, as files for any static host
    Web {
        /// Build the example of yoro-wgpu for browsers with WebGPU instead
        #[arg(long, conflicts_with = "out")]
        wgpu: bool,
        /// Then serve it to browsers on this machine and, by `adb reverse tcp:8080 tcp:8080`, on a phone or headset
        #[arg(long)]
        serve: bool,
        /// Do not build it again; after `cargo xtask test` it is the larger build for tests
        #[arg(long)]
        as_built: bool,
        /// Port to serve at; 0 for any free one
        #[arg(long, default_value_t = 8080, value_name = "NUMBER")]
        port: u16,
        /// Copy it into this folder, too, beside earlier versions, whose open tabs keep working
        #[arg(long, value_name = "FOLDER")]
        out: Option<PathBuf>,
    },
    /// What only maintainers run: costs of shaders, compiled shaders, programs to test with
    Maintain {
        #[command(subcommand)]
        task: maintain::Task,
    },
    /// Check formatting, clippy, documentation, each published library without its default features, their packages, the
    /// licences of dependencies, and the types of the page's scripts
    Lint,
}

/// Runs the task that the command line names. Returns the program's exit code.
pub fn main() -> ExitCode {
    console::exit_code(perform(Arguments::parse().task))
}

/// Runs a task. Returns false if a check has failed.
fn perform(task: Task) -> anyhow::Result<bool> {
    match task {
        Task::Setup => {
            apt::install_missing(|| vec![setup::cpp()], true)?;
            if setup::ensure()? & setup::vulkan() {
                println!("everything is there");
            }
        }
        Task::Run { arguments } => {
            setup::ensure()?;
            // Without what serves streams, and with a profile of its own: two minutes less until the first picture.
            let lean = ["--package", "yoro-cli", "--bin", "yoro", "--no-default-features"];
            cargo::run(&[&["run", "--profile", "first"][..], &lean, &["--", "run"]].concat(), &arguments)?;
            if arguments.is_empty() {
                console::print(NEXT);
            }
        }
        Task::Test(options) => testing::test(&options)?,
        Task::Apk(options) => {
            android::apk(&options)?;
        }
        Task::Doctor => {
            let (text, complete) = android::doctor();
            console::print(&text);
            return Ok(complete);
        }
        Task::CheckApk { file, store } => {
            return android::check::check(&file, store, &[]);
        }
        Task::Package { targets } => {
            package::package(&targets)?;
        }
        Task::Release { out, only } => release::release(&out, &only)?,
        Task::Site { release } => {
            site::build(release.as_deref())?;
        }
        Task::Kit => {
            kit::kit()?;
        }
        Task::Bevy { task: bevy::Task::Run } => bevy::run()?,
        Task::Bevy { task: bevy::Task::Test } => bevy::test()?,
        Task::Godot { task: godot::Task::Project } => {
            godot::project()?;
        }
        Task::Godot { task: godot::Task::Test } => godot::test()?,
        Task::Web { wgpu, serve, as_built, port, out } => {
            let folder = web::folder(wgpu, as_built)?;
            if let Some(out) = out {
                web::publish(&folder, &out)?;
            }
            if serve {
                web::serve(&folder, port)?;
            }
        }
        Task::Maintain { task } => return maintain::perform(task),
        Task::Lint => lint::lint()?,
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::error::ErrorKind;
    use std::fs;
    use std::path::Path;

    /// Adds the text of all Markdown files except build results.
    fn documents(folder: &Path, found: &mut Vec<String>) {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if name.starts_with('.') || ["target", "out"].contains(&name.as_str()) {
                continue;
            }
            match path.is_dir() {
                true => documents(&path, found),
                false if name.ends_with(".md") => found.push(fs::read_to_string(&path).unwrap()),
                false => {}
            }
        }
    }

    /// Names of commands may lack their arguments, and syntax descriptions have brackets.
    #[test]
    fn every_command_in_a_document_is_one() {
        use ErrorKind::{DisplayHelpOnMissingArgumentOrSubcommand, InvalidValue, MissingRequiredArgument};
        let mut texts = Vec::new();
        documents(&folders::root(), &mut texts);
        let mut count = 0;
        for text in texts.iter().flat_map(|text| text.split('`').skip(1).step_by(2)) {
            // A block, or a command that may be wrapped.
            let lines = if text.starts_with("sh\n") { text.to_owned() } else { text.replace('\n', " ") };
            for line in lines.lines().filter_map(|line| line.strip_prefix("cargo xtask ")) {
                let command = line.split(" #").next().unwrap().split(" && ").next().unwrap();
                if command.contains('[') || command.contains("...") {
                    continue;
                }
                count += 1;
                let words = ["cargo xtask"].into_iter().chain(command.split_whitespace());
                if let Err(error) = Arguments::try_parse_from(words) {
                    let kinds =
                        [DisplayHelpOnMissingArgumentOrSubcommand, InvalidValue, MissingRequiredArgument];
                    assert!(kinds.contains(&error.kind()), "cargo xtask {command}: {error}");
                }
            }
        }
        assert!(count > 50, "the commands are gone");
    }
}
