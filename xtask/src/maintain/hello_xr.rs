//! For the tests of the API layer: hello_xr, Khronos's example of an OpenXR application, its loader, and Khronos's
//! layer that validates calls.
//!
//! They come from Debian packages, which are unpacked beside [Monado](super::monado), and use Monado's libraries. The
//! Debian release with Monado has an older hello_xr that supports neither a single view nor depth, so this one comes
//! from Debian's development release.

use std::path::{Path, PathBuf};

use anyhow::bail;

use super::monado;
use crate::folders::{copy, make_once, target_folder};
use crate::packages::{PrivateApt, debian_sources, quoted, unpack, write_launcher};

const RELEASE: &str = "sid";
const PACKAGE: &str = "libopenxr-utils";
/// Tests run without it if it cannot be obtained.
const VALIDATION: &str = "openxr-layer-corevalidation";
/// The dependencies that Monado's folder does not have.
const UNPACKED: [&str; 4] = ["libopenxr-utils_", "libopenxr-loader1_", "libjsoncpp", VALIDATION];
const WITHOUT: [&str; 1] = ["./usr/share/*"];
const LOADER: &str = "libopenxr_loader.so.1";

/// Sets up hello_xr, and returns how to use it.
///
/// # Errors
/// Fails if it cannot be obtained on this machine.
pub fn usage() -> anyhow::Result<String> {
    let folder = make()?.display().to_string();
    Ok(format!(
        "export XDG_RUNTIME_DIR=$(mktemp -d)\n\
         {folder}/monado-service &\n\
         {folder}/hello_xr -g Vulkan2 -vc Mono\n"
    ))
}

/// Returns the folder with the programs `hello_xr` and `monado-service`, the launcher `run PROGRAM ...`, which is
/// [Monado's](super::monado) with the loader's libraries, and the loader `libopenxr_loader.so.1`. Fetches what is
/// missing.
///
/// # Errors
/// Fails if they cannot be obtained on this machine.
pub fn make() -> anyhow::Result<PathBuf> {
    let monado = monado::make()?;
    let folder = target_folder()?.join("hello-xr");
    let root = folder.join("root");
    make_once(&folder, &format!("{RELEASE} {PACKAGE} {VALIDATION}\n"), || {
        eprintln!("fetching hello_xr for the tests: 40 MB, once");
        let apt = PrivateApt::new(folder.join("apt"), &["amd64"], Some(&debian_sources(&[RELEASE])?))?;
        apt.update()?;
        let program = apt.download(&[PACKAGE.to_owned()])?;
        let all = apt.download(&[VALIDATION.to_owned()]).unwrap_or_else(|error| {
            eprintln!(
                "warning: OpenXR's validation layer cannot be had, so that tests do without it: {error:#}"
            );
            program
        });
        for package in all {
            let name = package.file_name().unwrap_or_default().to_string_lossy();
            if UNPACKED.iter().any(|start| name.starts_with(start)) {
                unpack(&package, &root, &[], &WITHOUT)?;
            }
        }
        apt.remove();
        Ok(())
    })?;
    write_programs(&folder, &root, &monado)?;
    Ok(folder)
}

fn write_programs(folder: &Path, root: &Path, monado: &Path) -> anyhow::Result<()> {
    let usr = root.join("usr");
    let program = usr.join("bin/hello_xr");
    if !program.is_file() {
        bail!("{} is not where Debian's packages have it", program.display());
    }
    let drivers = monado.join("root/usr/share/vulkan/icd.d/lvp_icd.json");
    let libraries = usr.join("lib/x86_64-linux-gnu");
    let linker = monado::linker(&monado.join("root"), std::slice::from_ref(&libraries));
    let manifest = monado.join("root").join(monado::MANIFEST);
    let hello = format!(
        "# Khronos's example with the libraries that Monado has, and Monado as its OpenXR runtime.\n\
         unset LD_LIBRARY_PATH\n\
         export VK_DRIVER_FILES={} XR_RUNTIME_JSON={}\n\
         exec {linker} {} \"$@\"\n",
        quoted(&drivers),
        quoted(&manifest),
        quoted(&program),
    );
    write_launcher(&folder.join("hello_xr"), &hello)?;
    write_launcher(
        &folder.join("run"),
        &monado::run(&monado.join("root"), std::slice::from_ref(&libraries)),
    )?;
    copy(&libraries.join(LOADER), &folder.join(LOADER))?;
    // Some Rust programs look for the file name without the version.
    copy(&libraries.join(LOADER), &libraries.join("libopenxr_loader.so"))?;
    let service = format!("exec {} \"$@\"\n", quoted(&monado.join("monado-service")));
    write_launcher(&folder.join("monado-service"), &service)
}
