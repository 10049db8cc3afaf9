//! Monado, an OpenXR runtime with a simulated headset, for tests of sessions.
//!
//! It comes from Debian packages, which are only unpacked, with all dependencies down to the C library. Every machine
//! therefore runs the same Monado and the same Mesa. There are two programs: `monado-service` is the runtime's service,
//! and `run PROGRAM ...` runs one of this machine's programs with these libraries and this runtime. They find each
//! other through XDG_RUNTIME_DIR.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context as _, bail};

use crate::folders::{make_once, target_folder};
use crate::packages::{PrivateApt, debian_sources, fill_launcher, quoted};

/// The Debian release with these packages.
const RELEASE: &str = "trixie";
/// Monado in a fixed version, so that tests use the same one everywhere.
const MONADO: [&str; 2] = ["monado-service=25.0.0+dfsg-2", "libopenxr1-monado=25.0.0+dfsg-2"];
/// Monado's drivers: lavapipe, and EGL for the application.
const MESA: [&str; 5] = ["mesa-vulkan-drivers", "libegl1", "libegl-mesa0", "libgles2", "libgl1-mesa-dri"];
/// Files that are large and not needed.
const WITHOUT: [&str; 12] = [
    "./usr/share/doc/*",
    "./usr/share/man/*",
    "./usr/share/locale/*",
    "./usr/share/fonts/*",
    "./usr/share/iso-codes/*",
    "./usr/share/proj/*",
    "./usr/share/perl*",
    "./usr/lib/*/perl*",
    "./usr/lib/*/gconv/*",
    "./usr/lib/*/libvulkan_[!l]*",
    "./var/*",
    "./etc/*",
];
/// The launcher of this machine's programs. The runtime is Monado unless XR_RUNTIME_JSON names another one.
pub(crate) const RUN: &str = include_str!("launchers/run.sh");
/// The launcher of a program in a root.
pub(crate) const APPLICATION: &str = include_str!("launchers/application.sh");

/// The longest wait for the service, which other processes may slow down.
const TIMEOUT: Duration = Duration::from_secs(60);

/// Sets up Monado, and returns how to use it.
pub(crate) fn usage() -> anyhow::Result<String> {
    let folder = make()?.display().to_string();
    Ok(format!(
        "export XDG_RUNTIME_DIR=$(mktemp -d)\n\
         {folder}/monado-service &\n\
         {folder}/run target/release/yoro xr --frames 100\n"
    ))
}

/// Returns the folder of both programs. Fetches and unpacks them unless the folder is complete.
pub(crate) fn make() -> anyhow::Result<PathBuf> {
    /// Locked, since [`hello_xr`](super::hello_xr) sets up Monado as well.
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let packages = [&MONADO[..], &MESA].concat();
    let (folder, root) = fetch("monado", RELEASE, &packages, "Monado for the tests: 170 MB")?;
    write_service(&folder, &root)?;
    write_launcher(&folder.join("run"), RUN, &root, &[], Path::new(""))?;
    Ok(folder)
}

/// Unpacks packages of a Debian release, with all dependencies, unless they have been. Returns the folder of this name for
/// what is made of them, and their root in it.
pub(crate) fn fetch(
    name: &str,
    release: &str,
    packages: &[&str],
    what: &str,
) -> anyhow::Result<(PathBuf, PathBuf)> {
    if !cfg!(target_arch = "x86_64") {
        bail!("it is fetched for x86_64 only");
    }
    let folder = target_folder()?.join(name);
    let root = folder.join("root");
    make_once(&folder, &format!("{release} {}\n", packages.join(" ")), || {
        eprintln!("fetching {what}, once");
        let apt = PrivateApt::new(folder.join("apt"), &["amd64"], Some(&debian_sources(&[release])?))?;
        apt.unpack(&packages.iter().map(|package| package.to_string()).collect::<Vec<_>>(), &root, &WITHOUT)
    })?;
    Ok((folder, root))
}

/// Writes a launcher from its template. It runs a program with the libraries in `first`, then those of this root, which has
/// the runtime.
pub(crate) fn write_launcher(
    launcher: &Path,
    template: &str,
    root: &Path,
    first: &[&Path],
    program: &Path,
) -> anyhow::Result<()> {
    let usr = root.join("usr");
    let libraries = usr.join("lib/x86_64-linux-gnu");
    let own = ["", "lapack", "blas", "pulseaudio", "../../lib"].map(|name| libraries.join(name));
    let path = first.iter().copied().chain(own.iter().map(PathBuf::as_path));
    let path = path.map(|folder| folder.display().to_string()).collect::<Vec<_>>().join(":");
    let linker = quoted(&libraries.join("ld-linux-x86-64.so.2"));
    let linker = format!("{linker} --library-path {}", quoted(Path::new(&path)));
    let values = [("USR", &*quoted(&usr)), ("LINKER", &linker), ("PROGRAM", &quoted(program))];
    fill_launcher(launcher, template, &values)
}

/// Writes the launcher `monado-service` for the runtime in this root.
pub(crate) fn write_service(folder: &Path, root: &Path) -> anyhow::Result<()> {
    let service = include_str!("launchers/service.sh");
    write_launcher(&folder.join("monado-service"), service, root, &[], Path::new(""))
}

/// A process that is killed when this is dropped.
pub struct Running(pub Child);

impl Drop for Running {
    fn drop(&mut self) {
        self.0.kill().ok();
        self.0.wait().ok();
    }
}

/// Starts the service. Programs with `folder` as XDG_RUNTIME_DIR find it. Its log is `service.log` in that folder.
pub fn start(service: &Path, folder: &Path) -> anyhow::Result<Running> {
    let name = service.display();
    let path = folder.join("service.log");
    let spawn = || {
        let log = File::create(&path)?;
        let mut command = Command::new(service);
        command.env("XDG_RUNTIME_DIR", folder).stdin(Stdio::null());
        command.stdout(log.try_clone()?).stderr(log).spawn()
    };
    let mut running = Running(spawn().with_context(|| format!("{name} cannot be started"))?);
    let start = Instant::now();
    while !folder.join("monado_comp_ipc").exists() {
        let has_ended = running.0.try_wait().is_ok_and(|status| status.is_some());
        if has_ended || start.elapsed() > TIMEOUT {
            bail!("{name} does not start: {}", fs::read_to_string(&path).unwrap_or_default());
        }
        thread::sleep(Duration::from_millis(50));
    }
    Ok(running)
}
