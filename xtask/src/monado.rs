//! Monado, an OpenXR runtime with a simulated headset, for the tests of sessions.
//!
//! It comes from Debian's packages, which are only unpacked, with all that they need down to the C library: so it is the same
//! Monado, and the same Mesa below it, on every machine. Two programs are left: `monado-service` is the runtime's own one, and
//! `run PROGRAM ...` runs a program of this machine with those libraries and that runtime. Both meet in XDG_RUNTIME_DIR.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail};

use crate::android::target_folder;
use crate::cargo::Equipped;
use crate::packages::{PrivateApt, quoted, unpack, write_launcher};

/// Debian's release that has them.
const RELEASE: &str = "trixie";
/// Monado; the version is fixed, so that every machine tests with the same one.
const MONADO: [&str; 2] = ["monado-service=25.0.0+dfsg-2", "libopenxr1-monado=25.0.0+dfsg-2"];
/// What it draws with: lavapipe, and EGL for the application.
const MESA: [&str; 5] = ["mesa-vulkan-drivers", "libegl1", "libegl-mesa0", "libgles2", "libgl1-mesa-dri"];
/// Needed by nothing here, and large.
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
const MANIFEST: &str = "usr/share/openxr/1/openxr_monado.json";

/// The folder with both programs, for the tests. What it needs is fetched without asking, as for all tests.
pub fn for_tests() -> Equipped {
    match make() {
        Ok(folder) => Equipped::At(folder),
        Err(error) => {
            eprintln!("warning: Monado cannot be set up here, so that its tests are left out: {error:#}");
            Equipped::Missing
        }
    }
}

/// Sets it up; how it is used.
///
/// # Errors
/// When it cannot be had on this machine.
pub fn usage() -> anyhow::Result<String> {
    let folder = make()?.display().to_string();
    Ok(format!(
        "export XDG_RUNTIME_DIR=$(mktemp -d)\n\
         {folder}/monado-service &\n\
         {folder}/run target/release/yoro xr --frames 100\n"
    ))
}

/// Fetches and unpacks it, unless what is there is complete.
fn make() -> anyhow::Result<PathBuf> {
    if !cfg!(target_arch = "x86_64") {
        bail!("it is fetched for x86_64 only");
    }
    let folder = target_folder()?.join("monado");
    let (root, stamp) = (folder.join("root"), folder.join("stamp"));
    let packages: Vec<String> = MONADO.iter().chain(&MESA).map(|&package| package.to_owned()).collect();
    let recipe = format!("{RELEASE} {}\n", packages.join(" "));
    if !fs::read_to_string(&stamp).is_ok_and(|old| old == recipe) {
        if folder.exists() {
            fs::remove_dir_all(&folder)
                .with_context(|| format!("{} cannot be removed: remove it by hand", folder.display()))?;
        }
        eprintln!("fetching Monado for the tests: 170 MB, once");
        let apt = PrivateApt::new(folder.join("apt"), &["amd64"], Some(&sources()?))?;
        apt.update()?;
        for package in apt.download(&packages)? {
            unpack(&package, &root, &[], &WITHOUT)?;
        }
        apt.remove();
    }
    write_programs(&folder, &root)?;
    fs::write(&stamp, recipe).with_context(|| format!("{} cannot be written", stamp.display()))?;
    Ok(folder)
}

/// The release at the place that this machine has its own Debian from.
fn sources() -> anyhow::Result<String> {
    let targets = Command::new("apt-get")
        .args(["indextargets", "--format", "$(REPO_URI) $(COMPONENT)", "Created-By: Packages"])
        .output()
        .context("apt-get cannot be started")?
        .stdout;
    let targets = String::from_utf8_lossy(&targets).into_owned();
    let place = debian(&targets).context("this machine has no source of Debian's packages")?;
    Ok(format!("deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] {place} {RELEASE} main\n"))
}

/// Of `place component` lines, the place of Debian itself: not that of its security updates, nor somebody else's.
fn debian(targets: &str) -> Option<&str> {
    let mut places = targets.lines().filter_map(|line| line.split_once(' '));
    let is_debian = |place: &str| place.trim_end_matches('/').ends_with("/debian");
    places.find(|(place, component)| *component == "main" && is_debian(place)).map(|(place, _)| place)
}

fn write_programs(folder: &Path, root: &Path) -> anyhow::Result<()> {
    let usr = root.join("usr");
    let libraries = usr.join("lib/x86_64-linux-gnu");
    let path: Vec<String> = [
        libraries.clone(),
        libraries.join("lapack"),
        libraries.join("blas"),
        libraries.join("pulseaudio"),
        usr.join("lib"),
    ]
    .iter()
    .map(|folder| folder.display().to_string())
    .collect();
    let linker = format!(
        "{} --library-path {}",
        quoted(&libraries.join("ld-linux-x86-64.so.2")),
        quoted(Path::new(&path.join(":")))
    );
    let service = format!(
        "# Monado with a simulated headset, on the CPU and without a display.\n\
         export XRT_COMPOSITOR_NULL=1 SIMULATED_ENABLE=1 XRT_NO_STDIN=1 VK_DRIVER_FILES={}\n\
         exec {linker} {}\n",
        quoted(&usr.join("share/vulkan/icd.d/lvp_icd.json")),
        quoted(&usr.join("bin/monado-service")),
    );
    let run = format!(
        "# A program of this machine with the libraries that Monado has, and Monado as its OpenXR runtime.\n\
         unset LD_LIBRARY_PATH\n\
         export LIBGL_ALWAYS_SOFTWARE=1 LIBGL_DRIVERS_PATH={} GBM_BACKENDS_PATH={}\n\
         export __EGL_VENDOR_LIBRARY_FILENAMES={} XR_RUNTIME_JSON={}\n\
         program=$(command -v \"$1\") || exit 127\n\
         shift\n\
         exec {linker} \"$program\" \"$@\"\n",
        quoted(&libraries.join("dri")),
        quoted(&libraries.join("gbm")),
        quoted(&usr.join("share/glvnd/egl_vendor.d/50_mesa.json")),
        quoted(&root.join(MANIFEST)),
    );
    for file in [usr.join("bin/monado-service"), root.join(MANIFEST)] {
        if !file.is_file() {
            bail!("{} is not where Debian's packages have it", file.display());
        }
    }
    write_launcher(&folder.join("monado-service"), &service)?;
    write_launcher(&folder.join("run"), &run)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn debian_itself_is_found_among_the_sources() {
        let targets = "https://example.org/apt main\nhttp://example.com/debian-security/ main\n\
                       http://example.com/debian/ contrib\nhttp://example.com/debian/ main\n";
        assert_eq!(debian(targets), Some("http://example.com/debian/"));
        assert_eq!(debian("http://example.com/ubuntu/ main\n"), None);
    }
}
