//! `yoro layer`: stereo for OpenXR applications that render one view.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::io::{ErrorKind, Seek as _};
use std::os::unix::ffi::OsStrExt as _;
use std::os::unix::process::ExitStatusExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use super::Subcommand;
use anyhow::{Context as _, anyhow, bail};
use yoro_files as files;
use yoro_files::xdg;
use yoro_openxr_layer::library::version;
use yoro_openxr_layer::{DISABLE, ENABLE, Kind, MANIFEST, NAME};

const LIBRARY: &str = "libyoro_openxr_layer.so";
/// The interval at which the log is checked for new lines.
const PAUSE: Duration = Duration::from_millis(200);

/// Stereo in OpenXR applications that render one view: an API layer that synthesizes the other
#[derive(clap::Args, Clone, Debug)]
pub struct LayerArgs {
    #[command(subcommand)]
    task: Task,
}

#[derive(clap::Subcommand, Clone, Debug)]
enum Task {
    /// Run a program with the layer, without installing it
    Run {
        #[command(flatten)]
        library: LibraryArgs,
        /// The program and its arguments
        #[arg(required = true, trailing_var_arg = true, allow_hyphen_values = true, value_name = "PROGRAM")]
        program: Vec<OsString>,
    },
    /// Install the layer for this user's OpenXR loaders
    Install {
        /// Enable it for every program that runs with the variable YORO_LAYER_ENABLE, set to anything, instead of those
        /// with the layer's name in XR_ENABLE_API_LAYERS
        #[arg(long)]
        implicit: bool,
        #[command(flatten)]
        library: LibraryArgs,
    },
    /// Show whether the layer is installed, and its settings
    Status,
    /// Show the layer's log of the program that was started last
    Log {
        /// Follow the log until Ctrl-C
        #[arg(long, short)]
        follow: bool,
    },
    /// Uninstall the layer
    Remove,
}

#[derive(clap::Args, Clone, Debug)]
struct LibraryArgs {
    /// The layer's library [default: libyoro_openxr_layer.so beside this program or in ../lib]
    #[arg(long, value_name = "FILE")]
    library: Option<PathBuf>,
}

impl LibraryArgs {
    /// Returns the absolute path of the layer's library.
    fn find(&self) -> anyhow::Result<PathBuf> {
        let path = self.look()?;
        version(&path)?;
        Ok(path)
    }

    fn look(&self) -> anyhow::Result<PathBuf> {
        if let Some(library) = &self.library {
            return library.canonicalize().map_err(|_| {
                anyhow!(
                    "{}: there is no such library; give that of the package yoro-openxr-layer",
                    library.display()
                )
            });
        }
        let program = env::current_exe().context("this program's own place is not known; give --library")?;
        let folder = program.parent().unwrap_or(Path::new("/"));
        // Builds for tests leave the library in `deps`.
        let places =
            [folder.join(LIBRARY), folder.join("../lib").join(LIBRARY), folder.join("deps").join(LIBRARY)];
        let found = places.iter().find_map(|place| place.canonicalize().ok());
        found.with_context(|| {
            format!(
                "{LIBRARY} is not beside {}; build it (cargo build --release -p yoro-openxr-layer), or give --library",
                program.display()
            )
        })
    }
}

/// Returns the folder of this user's data, in which loaders look for manifests.
fn data() -> anyhow::Result<PathBuf> {
    let set = env::var_os("XDG_DATA_HOME").map(PathBuf::from).unwrap_or_default();
    if !set.as_os_str().is_empty() && !set.is_absolute() {
        bail!(
            "XDG_DATA_HOME is {}: each program would look below its own working directory; set it to an absolute path",
            set.display()
        );
    }
    let data = xdg::folder("XDG_DATA_HOME", ".local/share")
        .context("neither XDG_DATA_HOME nor HOME is an absolute path; set one of them")?;
    if data.as_os_str().as_bytes().contains(&b':') {
        bail!("{}: loaders split paths at colons; set XDG_DATA_HOME to a path without one", data.display());
    }
    Ok(data)
}

/// Returns the path of the manifest as an implicit or as an explicit layer.
fn manifest_path(data: &Path, implicit: bool) -> PathBuf {
    let kind = if implicit { "implicit.d" } else { "explicit.d" };
    data.join("openxr/1/api_layers").join(kind).join(MANIFEST)
}

fn library_path(data: &Path) -> PathBuf {
    data.join("yoro").join(LIBRARY)
}

/// Removes a file if it exists. Returns whether it did.
fn remove(path: &Path) -> anyhow::Result<bool> {
    match fs::remove_file(path) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        Err(error) => {
            Err(error).with_context(|| format!("{} cannot be removed: remove it by hand", path.display()))
        }
    }
}

/// Removes the empty ones among a file's parent folders that are inside `below`.
fn remove_empty_folders(path: &Path, below: &Path) {
    let folders = path.ancestors().skip(1).take_while(|folder| folder.starts_with(below) && *folder != below);
    for folder in folders {
        if fs::remove_dir(folder).is_err() {
            return;
        }
    }
}

/// Writes a file. If there is a symbolic link at `path`, it is replaced and its target stays unchanged.
fn write(path: &Path, content: &[u8]) -> anyhow::Result<()> {
    if path.is_symlink() {
        remove(path)?;
    }
    if let Some(folder) = path.parent() {
        files::create_folder(folder)?;
    }
    Ok(files::write(path, content)?)
}

impl Subcommand for LayerArgs {
    fn run(&self) -> anyhow::Result<()> {
        match &self.task {
            Task::Run { library, program } => run_program(&library.find()?, program),
            Task::Install { implicit, library } => install(*implicit, &library.find()?),
            Task::Status => status(),
            Task::Log { follow } => show_log(*follow),
            Task::Remove => {
                let data = data()?;
                let all = [manifest_path(&data, false), manifest_path(&data, true), library_path(&data)];
                let mut any = false;
                for path in all {
                    if remove(&path)? {
                        println!("removed {}", path.display());
                        remove_empty_folders(&path, &data);
                        any = true;
                    }
                }
                if !any {
                    println!("{NAME} is not installed");
                }
                Ok(())
            }
        }
    }
}

fn install(implicit: bool, library: &Path) -> anyhow::Result<()> {
    let data = data()?;
    let (manifest, own) = (manifest_path(&data, implicit), library_path(&data));
    let kind = if implicit { Kind::Implicit } else { Kind::Explicit };
    write(&own, &files::read(library)?)?;
    write(&manifest, yoro_openxr_layer::manifest(&own, kind).as_bytes())?;
    // Only one of the two manifests may exist, or loaders would find the layer twice.
    remove(&manifest_path(&data, !implicit))?;
    println!("{}\n{}", own.display(), manifest.display());
    if implicit {
        println!("on in programs that run with {ENABLE} set, to anything; off with {DISABLE} set");
    } else {
        println!("on in programs that run with XR_ENABLE_API_LAYERS={NAME}");
    }
    Ok(())
}

fn status() -> anyhow::Result<()> {
    let (data, mut installed) = (data()?, false);
    for (implicit, how) in [(false, "explicit"), (true, "implicit")] {
        let manifest = manifest_path(&data, implicit);
        if manifest.is_file() {
            println!("{how}: {}", manifest.display());
            installed = true;
        } else {
            println!("{how}: not installed");
        }
    }
    if installed {
        let library = library_path(&data);
        if !library.is_file() {
            bail!("{} is missing; run `yoro layer install`", library.display());
        }
        println!("library: {}, version {}", library.display(), version(&library)?);
    }
    if let Some(path) = yoro_openxr_layer::log::path().filter(|path| path.is_file()) {
        println!("log: {}", path.display());
    }
    if let Some(path) = yoro_openxr_layer::settings::path() {
        let there = if path.exists() { "" } else { " (not there)" };
        println!("settings: {}{there}", path.display());
    }
    match yoro_openxr_layer::settings::mistakes().into_iter().next() {
        Some(error) => Err(error.into()),
        None => Ok(()),
    }
}

fn show_log(follow: bool) -> anyhow::Result<()> {
    let path = yoro_openxr_layer::log::path();
    let path = path.context("neither XDG_STATE_HOME nor HOME is an absolute path; set one of them")?;
    let mut file = fs::File::open(&path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => {
            anyhow!("{}: no program has run with the layer yet; see `yoro layer run`", path.display())
        }
        _ => anyhow!("{} cannot be read ({error}): check its permissions", path.display()),
    })?;
    if !file.metadata()?.is_file() {
        bail!("{} is no file; remove it, so that the layer can write its log there", path.display());
    }
    let mut out = std::io::stdout().lock();
    loop {
        std::io::copy(&mut file, &mut out)?;
        if !follow {
            return Ok(());
        }
        std::thread::sleep(PAUSE);
        // The file has shrunk: another program has started it anew.
        if file.metadata()?.len() < file.stream_position()? {
            file.rewind()?;
        }
    }
}

fn run_program(library: &Path, program: &[OsString]) -> anyhow::Result<()> {
    let folder = tempfile::tempdir()
        .context("no folder for the layer's manifest; set TMPDIR to one that can be written")?;
    write(&folder.path().join(MANIFEST), yoro_openxr_layer::manifest(library, Kind::Explicit).as_bytes())?;
    let join = |first: OsString, variable: &str| {
        let rest = env::var_os(variable).filter(|rest| !rest.is_empty());
        rest.map_or(first.clone(), |rest| [first, rest].join(std::ffi::OsStr::new(":")))
    };
    let status = Command::new(&program[0])
        .args(&program[1..])
        .env("XR_API_LAYER_PATH", join(folder.path().into(), "XR_API_LAYER_PATH"))
        .env("XR_ENABLE_API_LAYERS", join(NAME.into(), "XR_ENABLE_API_LAYERS"))
        .status()
        .with_context(|| format!("cannot start {}", program[0].display()))?;
    drop(folder);
    match status.code().or(status.signal().map(|signal| 128 + signal)) {
        Some(0) => Ok(()),
        code => std::process::exit(code.unwrap_or(1)),
    }
}
