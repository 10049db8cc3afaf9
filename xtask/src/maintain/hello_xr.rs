//! For the tests of the API layer: hello_xr, Khronos's example of an OpenXR application, its loader, and Khronos's
//! layer that validates calls.
//!
//! They come from Debian packages, which are unpacked beside [Monado](super::monado), and use Monado's libraries. The
//! Debian release with Monado has an older hello_xr that supports neither a single view nor depth, so this one comes
//! from Debian's development release.

use std::path::{Path, PathBuf};

use super::monado;
use crate::folders::{copy, make_once, remove, target_folder};
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
pub fn make() -> anyhow::Result<PathBuf> {
    let monado = monado::make()?;
    let folder = target_folder()?.join("hello-xr");
    let root = folder.join("root");
    make_once(&folder, &format!("{RELEASE} {PACKAGE} {VALIDATION}\n"), || {
        eprintln!("fetching hello_xr for the tests: 40 MB, once");
        let apt = PrivateApt::new(folder.join("apt"), &["amd64"], Some(&debian_sources(&[RELEASE])?))?;
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
        remove(&folder.join("apt"))
    })?;
    let libraries = root.join("usr/lib/x86_64-linux-gnu");
    let launch = |name: &str, template, program: &Path| {
        monado::write_launcher(&folder.join(name), template, &monado.join("root"), &[&libraries], program)
    };
    launch("hello_xr", monado::APPLICATION, &root.join("usr/bin/hello_xr"))?;
    launch("run", monado::RUN, Path::new(""))?;
    copy(&libraries.join(LOADER), &folder.join(LOADER))?;
    // Some Rust programs look for the file name without the version.
    copy(&libraries.join(LOADER), &libraries.join("libopenxr_loader.so"))?;
    let service = format!("exec {} \"$@\"\n", quoted(&monado.join("monado-service")));
    write_launcher(&folder.join("monado-service"), &service)?;
    Ok(folder)
}
