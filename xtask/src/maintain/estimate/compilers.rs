//! Mesa's compilers for mobile GPUs, which run without these GPUs.
//!
//! Debian builds freedreno and panfrost for arm64 only. Their packages are unpacked into a folder, and qemu's user mode
//! runs them. `mesa-drm-shim` replaces the kernel driver by one of a GPU that compiles shaders but draws nothing.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail};
use serde_json::Value;

use super::gpus::{Compiler, Gpu};
use crate::folders::{make_once, target_folder, write};
use crate::packages::{self, PrivateApt};

const RELEASE: &str = "trixie";
/// Has Mesa 26, which supports newer GPUs than Mesa 25.0 of the release itself.
const BACKPORTS: &str = "trixie-backports";
const MESA: [&str; 4] = ["mesa-drm-shim", "libegl-mesa0", "libgbm1", "libgl1-mesa-dri"];
const OTHERS: [&str; 5] = [
    "libegl1:arm64",
    "libgles2:arm64",
    "python3-minimal:arm64",
    "libpython3-stdlib:arm64",
    // Statically linked since this release.
    "qemu-user:amd64",
];
/// Files that are large and not needed.
const WITHOUT: [&str; 9] = [
    "./usr/share/doc/*",
    "./usr/share/man/*",
    "./usr/share/locale/*",
    "./usr/share/info/*",
    "./usr/share/perl*",
    "./usr/lib/*/perl*",
    "./usr/lib/*/gconv/*",
    "./var/*",
    "./etc/*",
];
const QEMU: &str = "usr/bin/qemu-aarch64";
const PYTHON: &str = "usr/bin/python3";
const LIBRARIES: &str = "usr/lib/aarch64-linux-gnu";
/// Extensions that the GPU makers' drivers have and Mesa's lack.
const CLAIMED: &str = "+GL_OVR_multiview +GL_OVR_multiview2 +GL_EXT_clip_cull_distance";

/// The results of one run for one GPU.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Mesa's version, such as `26.1.6-1~bpo13+1`.
    pub mesa: String,
    /// Results in the order of the programs; fewer if the compiler crashed.
    pub programs: Vec<DriverOutput>,
}

/// The driver's output for one program.
#[derive(Clone, Debug, PartialEq)]
pub struct DriverOutput {
    /// True if the program compiles and links.
    pub ok: bool,
    /// Errors and warnings of the compiler and the linker.
    pub log: String,
    /// Statistics, one line per compiled shader.
    pub messages: Vec<String>,
    /// The disassembled shaders.
    pub listing: String,
}

/// Mesa for arm64 and qemu, in a folder.
#[derive(Clone, Debug)]
pub struct Compilers {
    folder: PathBuf,
}

impl Compilers {
    /// Fetches and unpacks the compilers unless the folder is complete.
    ///
    /// # Errors
    /// Fails if they cannot be obtained on this machine.
    pub fn make() -> anyhow::Result<Self> {
        if !cfg!(target_arch = "x86_64") {
            bail!("they are fetched for x86_64 only");
        }
        let compilers = Self { folder: target_folder()?.join("shader-cost") };
        let folder = &compilers.folder;
        let newest = MESA.map(|name| format!("{name}:arm64/{BACKPORTS}"));
        let recipe = format!("{RELEASE} {} {} {}\n", newest.join(" "), OTHERS.join(" "), WITHOUT.join(" "));
        make_once(folder, &recipe, || {
            eprintln!("fetching Mesa's compilers for mobile GPUs: 140 MB, once");
            let sources = packages::debian_sources(&[RELEASE, BACKPORTS])?;
            let apt = PrivateApt::new(folder.join("apt"), &["amd64", "arm64"], Some(&sources))?;
            let others = OTHERS.map(str::to_owned);
            apt.unpack(&[newest.to_vec(), others.to_vec()].concat(), &compilers.root(), &WITHOUT)?;
            for file in [QEMU, PYTHON] {
                if !compilers.root().join(file).exists() {
                    bail!("{file} is not where Debian's packages have it");
                }
            }
            Ok(())
        })?;
        Ok(compilers)
    }

    /// Uses the compilers that an earlier [`make`](Self::make) has left in a folder.
    pub fn at(folder: PathBuf) -> Self {
        Self { folder }
    }

    /// Returns the compilers' folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    fn root(&self) -> PathBuf {
        self.folder.join("root")
    }

    /// Compiles programs, which are JSON as written by tests/src/programs.rs.
    ///
    /// # Errors
    /// Fails if the compilers do not start, or their output cannot be parsed.
    pub fn run(&self, gpu: &Gpu, programs: &Path) -> anyhow::Result<Run> {
        let guest = self.folder.join("guest.py");
        write(&guest, include_str!("guest.py"))?;
        let root = self.root();
        let id = match gpu.compiler {
            Compiler::Ir3 => "FD_GPU_ID",
            Compiler::Bifrost | Compiler::Valhall => "PAN_GPU_ID",
        };
        let mut preload = std::ffi::OsString::from("LD_PRELOAD=");
        preload.push(self.stand_in(gpu)?);
        let mut command = Command::new(root.join(QEMU));
        command.arg("-L").arg(&root);
        // Passed through qemu, so that no native process of this machine loads it.
        command.arg("-E").arg(preload);
        command.arg(root.join(PYTHON)).args([&guest, programs]).stdin(Stdio::null());
        command
            // Variables such as LIBGL_ALWAYS_SOFTWARE would select another driver.
            .env_clear()
            .env(id, gpu.id)
            .env("PYTHONHOME", root.join("usr"))
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .env("FD_MESA_DEBUG", "shaderdb")
            .env("IR3_SHADER_DEBUG", "vs,fs,cs,disasm")
            .env("BIFROST_MESA_DEBUG", "shaderdb,shaders")
            .env("PAN_MESA_DEBUG", "precompile")
            .env("MESA_EXTENSION_OVERRIDE", CLAIMED)
            .env("MESA_SHADER_CACHE_DISABLE", "true")
            .env("GALLIUM_THREAD", "0")
            .env("__EGL_VENDOR_LIBRARY_FILENAMES", root.join("usr/share/glvnd/egl_vendor.d/50_mesa.json"));
        let output = command.output().context("qemu cannot be started")?;
        let listing = String::from_utf8_lossy(&output.stderr);
        let run = read(&String::from_utf8_lossy(&output.stdout), &listing);
        run.with_context(|| {
            let end: Vec<&str> = listing.lines().rev().take(3).collect();
            format!("Mesa's compiler for {} does not work here: {}", gpu.title, end.join("; "))
        })
    }

    /// Returns the library that replaces the kernel driver, changed for the GPU if it does not know it.
    fn stand_in(&self, gpu: &Gpu) -> anyhow::Result<PathBuf> {
        let name = format!("lib{}_noop_drm_shim.so", gpu.compiler.driver());
        let library = self.root().join(LIBRARIES).join(&name);
        let Some(replacement) = gpu.replaces else { return Ok(library) };
        let mut bytes =
            fs::read(&library).with_context(|| format!("{} cannot be read", library.display()))?;
        let replaced = replacement.apply(&mut bytes);
        replaced.with_context(|| {
            format!(
                "Mesa's table of GPUs has no {} any more to be replaced by {}",
                replacement.old_gpu, gpu.title
            )
        })?;
        let own = self.folder.join(format!("{}-{name}", gpu.name));
        write(&own, bytes)?;
        Ok(own)
    }
}

/// Parses the guest's output. Returns `None` if no driver of a mobile GPU has answered.
fn read(lines: &str, listings: &str) -> Option<Run> {
    let mut values = lines.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let driver = values.next()?;
    if driver["renderer"].as_str()?.contains("llvmpipe") {
        return None;
    }
    let mesa = driver["version"].as_str()?.split_once("Mesa ")?.1.to_owned();
    let mut listings = listings.split("# program ").skip(1);
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let programs = values.map(|value| DriverOutput {
        ok: value["ok"] == true,
        log: text(&value["log"]),
        messages: value["messages"].as_array().into_iter().flatten().map(text).collect(),
        listing: listings.next().unwrap_or_default().to_owned(),
    });
    Some(Run { mesa, programs: programs.collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn listings_are_given_to_their_programs() {
        let lines = "{\"renderer\":\"FD650\",\"version\":\"OpenGL ES 3.2 Mesa 26.1.6-1\"}\n\
                     {\"ok\":true,\"log\":\"\",\"messages\":[\"FRAG shader: 1 inst\"]}\n\
                     {\"ok\":false,\"log\":\"0:1: no\",\"messages\":[]}\n";
        let run = read(lines, "noise\n# program 0\nadd\n# program 1\n").unwrap();
        assert_eq!(run.mesa, "26.1.6-1");
        assert_eq!(run.programs.len(), 2);
        assert!(run.programs[0].ok && run.programs[0].listing.contains("add"));
        assert_eq!((run.programs[1].ok, run.programs[1].log.as_str()), (false, "0:1: no"));
        assert_eq!(read(&lines.replace("FD650", "llvmpipe"), ""), None);
        assert_eq!(read("", "Segmentation fault"), None);
    }
}
