//! hello_xr, Khronos's example of an OpenXR application, the loader that it comes with, and Khronos's layer that
//! validates what is called, for the tests of the API layer.
//!
//! It comes from Debian's packages, unpacked beside [Monado](crate::monado), and runs with Monado's libraries. Debian's
//! release that has Monado has an older hello_xr, which knows neither one view nor depth, so this one is that of
//! Debian's development.

use std::path::{Path, PathBuf};

use anyhow::bail;

use crate::folders::{copy, make_once, target_folder};
use crate::monado;
use crate::packages::{PrivateApt, debian_sources, quoted, unpack, write_launcher};

const RELEASE: &str = "sid";
const PACKAGE: &str = "libopenxr-utils";
/// Tests do without it where it cannot be had.
const VALIDATION: &str = "openxr-layer-corevalidation";
/// Those of their dependencies that Monado's folder does not have.
const UNPACKED: [&str; 4] = ["libopenxr-utils_", "libopenxr-loader1_", "libjsoncpp", VALIDATION];
const WITHOUT: [&str; 1] = ["./usr/share/*"];
const LOADER: &str = "libopenxr_loader.so.1";

/// Sets it up, and returns how to use it.
///
/// # Errors
/// When it cannot be had on this machine.
pub fn usage() -> anyhow::Result<String> {
    let folder = make()?.display().to_string();
    Ok(format!(
        "export XDG_RUNTIME_DIR=$(mktemp -d)\n\
         {folder}/monado-service &\n\
         {folder}/hello_xr -g Vulkan2 -vc Mono\n"
    ))
}

/// The folder with the programs `hello_xr` and `monado-service`, with `run PROGRAM ...`, which is
/// [Monado's](crate::monado) with the loader's libraries, and the loader itself, `libopenxr_loader.so.1`: fetches and
/// unpacks what is missing.
///
/// # Errors
/// When it cannot be had on this machine.
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
    // Some programs written in Rust look for it without the version.
    copy(&libraries.join(LOADER), &libraries.join("libopenxr_loader.so"))?;
    let service = format!("exec {} \"$@\"\n", quoted(&monado.join("monado-service")));
    write_launcher(&folder.join("monado-service"), &service)
}
