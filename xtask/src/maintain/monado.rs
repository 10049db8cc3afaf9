//! Monado, an OpenXR runtime with a simulated headset, for tests of sessions.
//!
//! It comes from Debian packages, which are only unpacked, with all dependencies down to the C library. Every machine
//! therefore runs the same Monado and the same Mesa. There are two programs: `monado-service` is the runtime's service,
//! and `run PROGRAM ...` runs one of this machine's programs with these libraries and this runtime. They find each
//! other through XDG_RUNTIME_DIR.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use anyhow::bail;

use crate::folders::{make_once, target_folder};
use crate::packages::{PrivateApt, debian_sources, quoted, unpack, write_launcher};

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
/// The runtime's manifest, relative to the root.
pub const MANIFEST: &str = "usr/share/openxr/1/openxr_monado.json";

/// Sets up Monado, and returns how to use it.
///
/// # Errors
/// Fails if it cannot be obtained on this machine.
pub fn usage() -> anyhow::Result<String> {
    let folder = make()?.display().to_string();
    Ok(format!(
        "export XDG_RUNTIME_DIR=$(mktemp -d)\n\
         {folder}/monado-service &\n\
         {folder}/run target/release/yoro xr --frames 100\n"
    ))
}

/// Returns the folder of both programs. Fetches and unpacks them unless the folder is complete.
///
/// # Errors
/// Fails if they cannot be obtained on this machine.
pub fn make() -> anyhow::Result<PathBuf> {
    /// Locked, since [`hello_xr`](crate::hello_xr) sets up Monado as well.
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    if !cfg!(target_arch = "x86_64") {
        bail!("it is fetched for x86_64 only");
    }
    let folder = target_folder()?.join("monado");
    let root = folder.join("root");
    let packages: Vec<String> = MONADO.iter().chain(&MESA).map(|&package| package.to_owned()).collect();
    make_once(&folder, &format!("{RELEASE} {}\n", packages.join(" ")), || {
        eprintln!("fetching Monado for the tests: 170 MB, once");
        unpack_with_needs(&folder, &root, RELEASE, &packages)
    })?;
    write_programs(&folder, &root)?;
    Ok(folder)
}

/// Unpacks packages of a Debian release, with all dependencies, into `root`. Downloads go to `folder` meanwhile.
///
/// # Errors
/// Fails if they cannot be obtained.
pub fn unpack_with_needs(
    folder: &Path,
    root: &Path,
    release: &str,
    packages: &[String],
) -> anyhow::Result<()> {
    let apt = PrivateApt::new(folder.join("apt"), &["amd64"], Some(&debian_sources(&[release])?))?;
    apt.update()?;
    for package in apt.download(packages)? {
        unpack(&package, root, &[], &WITHOUT)?;
    }
    apt.remove();
    Ok(())
}

/// Returns the beginning of a command line that runs a program with the libraries in `first`, then those of this root.
pub fn linker(root: &Path, first: &[PathBuf]) -> String {
    let usr = root.join("usr");
    let libraries = usr.join("lib/x86_64-linux-gnu");
    let own = [
        libraries.clone(),
        libraries.join("lapack"),
        libraries.join("blas"),
        libraries.join("pulseaudio"),
        usr.join("lib"),
    ];
    let path: Vec<String> = first.iter().chain(&own).map(|folder| folder.display().to_string()).collect();
    format!(
        "{} --library-path {}",
        quoted(&libraries.join("ld-linux-x86-64.so.2")),
        quoted(Path::new(&path.join(":")))
    )
}

/// Returns the text of a launcher that runs this machine's programs with the libraries in `first`, then those of this
/// root. The runtime is Monado unless XR_RUNTIME_JSON names another one.
pub fn run(root: &Path, first: &[PathBuf]) -> String {
    let usr = root.join("usr");
    let libraries = usr.join("lib/x86_64-linux-gnu");
    format!(
        "# A program of this machine with the libraries that Monado has, and Monado as its OpenXR runtime.\n\
         unset LD_LIBRARY_PATH\n\
         export LIBGL_ALWAYS_SOFTWARE=1 LIBGL_DRIVERS_PATH={} GBM_BACKENDS_PATH={}\n\
         export __EGL_VENDOR_LIBRARY_FILENAMES={}\n\
         export XR_RUNTIME_JSON=${{XR_RUNTIME_JSON:-{}}}\n\
         program=$(command -v \"$1\") || exit 127\n\
         shift\n\
         exec {} \"$program\" \"$@\"\n",
        quoted(&libraries.join("dri")),
        quoted(&libraries.join("gbm")),
        quoted(&usr.join("share/glvnd/egl_vendor.d/50_mesa.json")),
        quoted(&root.join(MANIFEST)),
        linker(root, first),
    )
}

fn write_programs(folder: &Path, root: &Path) -> anyhow::Result<()> {
    write_service(folder, root)?;
    write_launcher(&folder.join("run"), &run(root, &[]))
}

/// Writes the launcher `monado-service` for the runtime in this root.
///
/// # Errors
/// Fails if the runtime is missing, or the launcher cannot be written.
pub fn write_service(folder: &Path, root: &Path) -> anyhow::Result<()> {
    let usr = root.join("usr");
    let service = format!(
        "# Monado with a simulated headset, on the CPU and without a display.\n\
         export XRT_COMPOSITOR_NULL=1 SIMULATED_ENABLE=1 XRT_NO_STDIN=1 VK_DRIVER_FILES={}\n\
         exec {} {}\n",
        quoted(&usr.join("share/vulkan/icd.d/lvp_icd.json")),
        linker(root, &[]),
        quoted(&usr.join("bin/monado-service")),
    );
    for file in [usr.join("bin/monado-service"), root.join(MANIFEST)] {
        if !file.is_file() {
            bail!("{} is not where Debian's packages have it", file.display());
        }
    }
    write_launcher(&folder.join("monado-service"), &service)
}
