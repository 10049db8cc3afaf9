//! The required system libraries. The program needs EGL, OpenGL ES, a driver and OSMesa. Tests of Vulkan need a driver
//! without a GPU, Khronos's validation layer and glslang.

use std::collections::BTreeSet;
use std::env;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail};

use crate::apt::{self, Need};

/// A system library.
struct Library {
    /// The name in messages.
    what: &'static str,
    /// File names, any of which is sufficient. A trailing `*` matches any ending.
    files: &'static [&'static str],
    /// The packages of Debian and Ubuntu.
    packages: &'static [&'static str],
}

const fn need(
    what: &'static str,
    files: &'static [&'static str],
    packages: &'static [&'static str],
) -> Library {
    Library { what, files, packages }
}

/// What the project's programs need.
const NEEDS: [Library; 5] = [
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
    // Mesa 25.1 removed it, so new distributions lack it. Only `--gl osmesa` and its tests need it.
    need("OSMesa", &["libOSMesa.so.8", "libOSMesa.so.6"], &["libosmesa6"]),
];

const VULKAN: [Library; 3] = [
    need("the Vulkan loader", &["libvulkan.so.1"], &["libvulkan1"]),
    need("a Vulkan driver without a GPU", &["libvulkan_lvp.so"], &["mesa-vulkan-drivers"]),
    need("Vulkan's validation layer", &["libVkLayer_khronos_validation.so"], &["vulkan-validationlayers"]),
];
/// Headers for the samples in C. Their tests are skipped if these are missing.
const HEADERS: [Library; 2] = [
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
pub fn cpp() -> Need {
    Need::program("c++", &["g++"])
}

/// Installs what is missing. Prints nothing if nothing is missing. Returns true if OSMesa is here, which is optional.
pub fn ensure() -> anyhow::Result<bool> {
    if !cfg!(target_os = "linux") {
        bail!(
            "OpenGL ES without a window is supported on Linux only: use Linux, a container, or WSL on Windows"
        );
    }
    let Err(error) = apt::install_missing(|| needs(&NEEDS), true) else { return Ok(true) };
    if needs(&NEEDS[..4]).iter().any(|need| need.found.is_err()) {
        return Err(error);
    }
    eprintln!("warning: --gl osmesa does not work here: {error:#}");
    Ok(false)
}

/// Installs what tests and shaders of Vulkan and tests in C need, none of which the project's programs need. Returns
/// true if the tests of Vulkan can run.
pub fn vulkan() -> bool {
    let all = || {
        let glslang = Need::program("glslangValidator", &["glslang-tools"]);
        needs(&VULKAN).into_iter().chain(needs(&HEADERS)).chain([glslang]).collect()
    };
    if let Err(error) = apt::install_missing(all, true) {
        eprintln!("warning: tests of Vulkan will be left out: {error:#}");
    }
    needs(&VULKAN).iter().all(|need| need.found.is_ok())
}

/// Installs the compiler and the runtime for tests in C#, and returns the runtime.
pub fn mono() -> anyhow::Result<PathBuf> {
    let needs = || vec![Need::program("mcs", &["mono-mcs"]), Need::program("mono", &["mono-runtime"])];
    apt::install_missing(needs, true)?;
    apt::find_program("mono").context("it cannot be found")
}

/// Returns the browser for tests of pages. Installs one if necessary and apt has one.
pub fn browser() -> Option<PathBuf> {
    let find = || ["chromium", "chromium-browser", "google-chrome"].into_iter().find_map(apt::find_program);
    find().or_else(|| {
        if let Err(error) = apt::install_missing(|| vec![Need::program("chromium", &["chromium"])], true) {
            eprintln!("warning: {error:#}");
        }
        find()
    })
}

fn needs(libraries: &[Library]) -> Vec<Need> {
    let folders = library_folders();
    let is_here = |name: &&'static str| {
        folders.iter().any(|folder| match name.strip_suffix('*') {
            Some(start) => fs::read_dir(folder).is_ok_and(|entries| {
                entries.flatten().any(|entry| entry.file_name().to_string_lossy().starts_with(start))
            }),
            None => folder.join(name).exists(),
        })
    };
    let release = fs::read_to_string("/etc/os-release").unwrap_or_default();
    let need = |library: &Library| {
        let file = library.files.iter().find(|name| is_here(name));
        let found = file.map(|&name| name.to_owned()).ok_or_else(|| "not among the libraries".to_owned());
        Need {
            what: library.what,
            found,
            remedy: advice(&release, library.packages),
            packages: library.packages,
        }
    };
    libraries.iter().map(need).collect()
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

/// Returns what installs packages of Debian's or, on a distribution without apt, which its os-release file tells, everything.
fn advice(release: &str, packages: &[&str]) -> String {
    let ids = release.lines().filter(|line| line.starts_with("ID=") || line.starts_with("ID_LIKE="));
    let ids: String = ids.collect::<Vec<_>>().join(" ");
    let other = ADVICE.iter().find(|(word, _)| ids.contains(word)).map(|(_, command)| (*command).to_owned());
    other.unwrap_or_else(|| format!("apt-get install {}", packages.join(" ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_fits_the_distribution() {
        let advice = |release| advice(release, &["libegl1"]);
        assert!(advice("NAME=\"Fedora Linux\"\nID=fedora\n").contains("dnf"));
        assert!(advice("ID=\"rocky\"\nID_LIKE=\"rhel centos fedora\"\n").contains("dnf"));
        assert!(advice("ID=manjaro\nID_LIKE=arch").contains("pacman"));
        assert_eq!(advice("VERSION_ID=1\nID=debian"), "apt-get install libegl1");
    }
}
