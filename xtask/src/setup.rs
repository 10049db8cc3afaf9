//! The required system libraries. The program needs EGL, OpenGL ES, a driver and OSMesa. Tests of Vulkan need a driver
//! without a GPU, Khronos's validation layer and glslang.

use std::collections::BTreeSet;
use std::env;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{anyhow, bail};

use crate::apt;

/// A system requirement.
#[derive(Clone, Copy)]
struct Need {
    /// The name in messages.
    what: &'static str,
    /// File names, any of which is sufficient. A trailing `*` matches any ending.
    files: &'static [&'static str],
    /// The packages of Debian and Ubuntu.
    packages: &'static [&'static str],
}

const fn need(what: &'static str, files: &'static [&'static str], packages: &'static [&'static str]) -> Need {
    Need { what, files, packages }
}

/// What the project's programs need.
const NEEDS: [Need; 5] = [
    need("libEGL", &["libEGL.so.1"], &["libegl1"]),
    need("OpenGL ES", &["libGLESv2.so.2"], &["libgles2"]),
    // libEGL is a dispatcher, which needs one of the first two, or it is Mesa's own, which always has the number 1.0.0.
    need(
        "an EGL vendor library",
        &["libEGL_mesa.so.0", "libEGL_nvidia.so.0", "libEGL.so.1.0.0"],
        &["libegl-mesa0"],
    ),
    // Mesa's rasterizer is in a DRI module or, since 24.2, in libgallium.
    need("a GL driver", &["libgallium-*", "dri/swrast_dri.so", "libEGL_nvidia.so.0"], &["libgl1-mesa-dri"]),
    need(OSMESA, &["libOSMesa.so.8", "libOSMesa.so.6"], &["libosmesa6"]),
];
/// Mesa 25.1 removed it, so new distributions lack it. Only `--gl osmesa` and its tests need it.
const OSMESA: &str = "OSMesa";

const VULKAN: [Need; 3] = [
    need("the Vulkan loader", &["libvulkan.so.1"], &["libvulkan1"]),
    need("a Vulkan driver without a GPU", &["libvulkan_lvp.so"], &["mesa-vulkan-drivers"]),
    need("Vulkan's validation layer", &["libVkLayer_khronos_validation.so"], &["vulkan-validationlayers"]),
];
/// Headers for the samples in C. Their tests are skipped if these are missing.
const HEADERS: [Need; 2] = [
    need("Vulkan's headers", &["libvulkan.so"], &["libvulkan-dev"]),
    need("headers of OpenGL ES", &["libGLESv2.so"], &["libgles-dev", "libegl-dev"]),
];

/// Commands that install everything on distributions without apt, by a word in their os-release file.
const ADVICE: [(&str, &str); 5] = [
    ("fedora", "dnf install libglvnd-egl libglvnd-gles mesa-libEGL mesa-dri-drivers mesa-libOSMesa"),
    ("rhel", "dnf install libglvnd-egl libglvnd-gles mesa-libEGL mesa-dri-drivers mesa-libOSMesa"),
    ("arch", "pacman -S --needed libglvnd mesa"),
    ("alpine", "apk add mesa-egl mesa-gles mesa-dri-gallium mesa-osmesa"),
    ("suse", "zypper install Mesa-libEGL1 Mesa-libGLESv2-2 Mesa-dri libOSMesa8"),
];

/// Returns the need for a C++ compiler, which builds the H.264 encoder.
pub fn cpp() -> apt::Need {
    apt::Need::program("c++", &["g++"])
}

/// Installs what is missing. Prints nothing if nothing is missing. Returns true if OSMesa is here, which is optional.
pub fn ensure() -> anyhow::Result<bool> {
    if !cfg!(target_os = "linux") {
        bail!(
            "OpenGL ES without a window is supported on Linux only: use Linux, a container, or WSL on Windows"
        );
    }
    let remedy = match install(missing(&NEEDS)) {
        Ok(()) => "apt-get has nothing more to install: reinstall Mesa, or a driver of the GPU".to_owned(),
        Err(error) => format!("{error:#}"),
    };
    conclude(&missing(&NEEDS), &remedy)
}

/// Installs what tests and shaders of Vulkan and tests in C need, none of which the project's programs need. Returns
/// true if the tests of Vulkan can run.
pub fn vulkan() -> bool {
    let mut needs = missing(&VULKAN);
    needs.extend(missing(&HEADERS));
    if glslang().is_none() {
        needs.push(need("glslangValidator", &[], &["glslang-tools"]));
    }
    if let Err(error) = install(needs) {
        eprintln!("warning: tests of Vulkan will be left out: {error:#}");
    }
    missing(&VULKAN).is_empty()
}

/// Returns the browser for tests of pages. Installs one if necessary and apt has one.
pub fn browser() -> Option<PathBuf> {
    let find = || ["chromium", "chromium-browser", "google-chrome"].into_iter().find_map(apt::find_program);
    find().or_else(|| {
        if let Err(error) = install(vec![need("a browser", &[], &["chromium"])]) {
            eprintln!("warning: {error:#}");
        }
        find()
    })
}

/// Returns the path of the compiler for Vulkan shaders.
pub fn glslang() -> Option<PathBuf> {
    apt::find_program("glslangValidator")
}

fn install(missing: Vec<Need>) -> anyhow::Result<()> {
    if missing.is_empty() {
        return Ok(());
    }
    eprintln!("missing: {}", names(&missing));
    if apt::find_program("apt-get").is_none() {
        let release = fs::read_to_string("/etc/os-release").unwrap_or_default();
        return Err(anyhow!("install it with {}", advice(&release)));
    }
    apt::install(&missing.iter().map(|need| need.packages).collect::<Vec<_>>())
}

fn names(needs: &[Need]) -> String {
    needs.iter().map(|need| need.what).collect::<Vec<_>>().join(", ")
}

/// Fails if something is still missing that is not optional.
fn conclude(missing: &[Need], remedy: &str) -> anyhow::Result<bool> {
    let required: Vec<Need> = missing.iter().copied().filter(|need| need.what != OSMESA).collect();
    if !required.is_empty() {
        bail!("{} missing: {remedy}", names(&required));
    }
    if !missing.is_empty() {
        eprintln!("warning: OSMesa is missing, so that --gl osmesa does not work here; {remedy}");
    }
    Ok(missing.is_empty())
}

fn missing(needs: &[Need]) -> Vec<Need> {
    missing_in(&library_folders(), needs)
}

fn missing_in(folders: &[PathBuf], needs: &[Need]) -> Vec<Need> {
    let is_here = |name: &&'static str| {
        folders.iter().any(|folder| match name.strip_suffix('*') {
            Some(start) => fs::read_dir(folder).is_ok_and(|entries| {
                entries.flatten().any(|entry| entry.file_name().to_string_lossy().starts_with(start))
            }),
            None => folder.join(name).exists(),
        })
    };
    needs.iter().copied().filter(|need| !need.files.iter().any(is_here)).collect()
}

/// Returns the folders that the dynamic linker searches, as far as they can be determined.
fn library_folders() -> Vec<PathBuf> {
    let mut folders: BTreeSet<PathBuf> = BTreeSet::new();
    if let Some(path) = env::var_os("LD_LIBRARY_PATH") {
        folders.extend(env::split_paths(&path).filter(|folder| folder.is_absolute()));
    }
    // Each line of the cache ends with ` => /path/to/library`. Some users have no sbin in their PATH.
    let cache = ["ldconfig", "/sbin/ldconfig"].into_iter().find_map(|program| {
        let output = Command::new(program).arg("-p").stderr(Stdio::null()).output().ok()?;
        output.status.success().then_some(output.stdout)
    });
    let cache = String::from_utf8_lossy(cache.as_deref().unwrap_or_default()).into_owned();
    let native = env::consts::ARCH != "x86_64";
    for line in cache.lines().filter(|line| native || line.contains("x86-64")) {
        let library = line.rsplit_once(" => ").map(|(_, path)| PathBuf::from(path.trim()));
        folders.extend(library.as_deref().and_then(|path| path.parent()).map(PathBuf::from));
    }
    let multiarch = format!("/usr/lib/{}-linux-gnu", env::consts::ARCH);
    folders.extend([multiarch.as_str(), "/usr/lib64", "/usr/lib", "/usr/local/lib"].map(PathBuf::from));
    folders.into_iter().collect()
}

/// Returns what installs everything on a distribution without apt, identified by its os-release file.
fn advice(release: &str) -> String {
    let ids = release.lines().filter(|line| line.starts_with("ID=") || line.starts_with("ID_LIKE="));
    let ids: String = ids.collect::<Vec<_>>().join(" ");
    match ADVICE.iter().find(|(word, _)| ids.contains(word)) {
        Some((_, command)) => format!("`{command}` as root"),
        None => "your package manager: Mesa with EGL, OpenGL ES, llvmpipe and OSMesa".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_fits_the_distribution() {
        assert!(advice("NAME=\"Fedora Linux\"\nID=fedora\n").contains("dnf"));
        assert!(advice("ID=\"rocky\"\nID_LIKE=\"rhel centos fedora\"\n").contains("dnf"));
        assert!(advice("ID=manjaro\nID_LIKE=arch").contains("pacman"));
        assert!(advice("VERSION_ID=1\nID=slackware").contains("your package manager"));
    }

    #[test]
    fn finds_files_by_name_and_by_beginning() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir_all(folder.path().join("dri")).unwrap();
        for name in
            ["libEGL.so.1", "libgallium-24.2.so", "dri/other_dri.so", "libvulkan.so.1", "libvulkan_lvp.so"]
        {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let missing = |needs: &[Need]| names(&missing_in(&[folder.path().to_owned()], needs));
        assert_eq!(missing(&NEEDS), "OpenGL ES, an EGL vendor library, OSMesa");
        assert_eq!(missing(&VULKAN), "Vulkan's validation layer");
    }

    #[test]
    fn only_osmesa_is_optional() {
        assert!(conclude(&[], "").unwrap() && !conclude(&NEEDS[4..], "").unwrap());
        let error = conclude(&[NEEDS[0], NEEDS[4]], "do this").unwrap_err().to_string();
        assert_eq!(error, "libEGL missing: do this");
    }
}
