//! The required system libraries. The program needs EGL, OpenGL ES, a driver and OSMesa. Tests of Vulkan need a driver
//! without a GPU, Khronos's validation layer and glslang.

use std::collections::BTreeSet;
use std::env;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{anyhow, bail};

use crate::apt;

/// A system requirement, and the packages that contain it.
struct Need {
    /// The name in messages.
    what: &'static str,
    /// File names, any of which is sufficient. A trailing `*` matches any ending.
    any_of: &'static [&'static str],
    /// The packages of Debian and Ubuntu.
    apt: &'static [&'static str],
}

impl Need {
    fn is_in(&self, folders: &[PathBuf]) -> bool {
        self.any_of.iter().any(|name| exists(folders, name))
    }
}

const EGL: Need = Need { what: "libEGL", any_of: &["libEGL.so.1"], apt: &["libegl1"] };
const GLES: Need = Need { what: "OpenGL ES", any_of: &["libGLESv2.so.2"], apt: &["libgles2"] };
/// libEGL is a dispatcher, which needs one of the first two, or it is Mesa's own, which always has the number 1.0.0.
const VENDOR: Need = Need {
    what: "an EGL vendor library",
    any_of: &["libEGL_mesa.so.0", "libEGL_nvidia.so.0", "libEGL.so.1.0.0"],
    apt: &["libegl-mesa0"],
};
/// Mesa's rasterizer is in a DRI module or, since 24.2, in libgallium.
const DRIVER: Need = Need {
    what: "a GL driver",
    any_of: &["libgallium-*", "dri/swrast_dri.so", "libEGL_nvidia.so.0"],
    apt: &["libgl1-mesa-dri"],
};
const OSMESA: Need =
    Need { what: "OSMesa", any_of: &["libOSMesa.so.8", "libOSMesa.so.6"], apt: &["libosmesa6"] };

const VULKAN: Need = Need { what: "the Vulkan loader", any_of: &["libvulkan.so.1"], apt: &["libvulkan1"] };
const VULKAN_DRIVER: Need = Need {
    what: "a Vulkan driver without a GPU",
    any_of: &["libvulkan_lvp.so"],
    apt: &["mesa-vulkan-drivers"],
};
const VALIDATION: Need = Need {
    what: "Vulkan's validation layer",
    any_of: &["libVkLayer_khronos_validation.so"],
    apt: &["vulkan-validationlayers"],
};
const VULKAN_NEEDS: [&Need; 3] = [&VULKAN, &VULKAN_DRIVER, &VALIDATION];
/// Headers for the samples in C. Their tests are skipped if these are missing.
const HEADERS: [Need; 2] = [
    Need { what: "Vulkan's headers", any_of: &["libvulkan.so"], apt: &["libvulkan-dev"] },
    Need { what: "headers of OpenGL ES", any_of: &["libGLESv2.so"], apt: &["libgles-dev", "libegl-dev"] },
];
/// The Debian package of glslangValidator.
const GLSLANG: &[&str] = &["glslang-tools"];

/// The optional libraries, true if available after the set-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Libraries {
    /// OSMesa, which Mesa 25.1 removed, so new distributions lack it. Only `--gl osmesa` and its tests need it.
    pub osmesa: bool,
}

impl Libraries {
    /// True if no library is missing, including the optional ones.
    pub fn complete(self) -> bool {
        self.osmesa
    }
}

/// Returns the need for a C++ compiler, which builds the H.264 encoder.
pub fn cpp() -> apt::Need {
    apt::Need::program("c++", &["g++"])
}

/// Installs what is missing. Prints nothing if nothing is missing.
///
/// # Errors
/// Fails if this program cannot install it. The error says what to install.
pub fn ensure() -> anyhow::Result<Libraries> {
    if !cfg!(target_os = "linux") {
        bail!(
            "OpenGL ES without a window is supported on Linux only: use Linux, a container, or WSL on Windows"
        );
    }
    let folders = library_folders();
    let missing = missing(&folders);
    if missing.is_empty() {
        return Ok(Libraries { osmesa: true });
    }
    let names: Vec<&str> = missing.iter().map(|need| need.what).collect();
    eprintln!("missing: {}", names.join(", "));
    if apt::find_program("apt-get").is_none() {
        let release = fs::read_to_string("/etc/os-release").unwrap_or_default();
        return conclude(&missing, &format!("install it with {}", advice(&release)));
    }
    let groups: Vec<&[&str]> = missing.iter().map(|need| need.apt).collect();
    let installed = apt::install(&groups);
    let still_missing = self::missing(&library_folders());
    match installed {
        Ok(()) => conclude(
            &still_missing,
            "apt-get has nothing more to install: reinstall Mesa, or a driver of the GPU",
        ),
        Err(error) => conclude(&still_missing, &format!("{error:#}")),
    }
}

/// Returns the browser for tests of pages. Installs one if necessary and apt has one.
pub fn browser() -> Option<PathBuf> {
    let find = || ["chromium", "chromium-browser", "google-chrome"].into_iter().find_map(apt::find_program);
    find().or_else(|| {
        apt::find_program("apt-get")?;
        if let Err(error) = apt::install(&[&["chromium"]]) {
            eprintln!("warning: {error:#}");
        }
        find()
    })
}

/// Installs what tests and shaders of Vulkan and tests in C need, none of which the project's programs need. Returns
/// true if the tests of Vulkan can run.
pub fn vulkan() -> bool {
    let missing = |needs: &mut dyn Iterator<Item = &'static Need>| -> Vec<&Need> {
        let folders = library_folders();
        needs.filter(|need| !need.is_in(&folders)).collect()
    };
    let all = missing(&mut VULKAN_NEEDS.into_iter().chain(&HEADERS));
    let mut absent: Vec<&str> = all.iter().map(|need| need.what).collect();
    let mut groups: Vec<&[&str]> = all.iter().map(|need| need.apt).collect();
    if glslang().is_none() {
        absent.push("glslangValidator");
        groups.push(GLSLANG);
    }
    if absent.is_empty() {
        return true;
    }
    eprintln!("missing: {}", absent.join(", "));
    let installed = match apt::find_program("apt-get") {
        Some(_) => apt::install(&groups),
        None => Err(anyhow!("install them with your package manager")),
    };
    if let Err(error) = installed {
        eprintln!("warning: tests of Vulkan need {}; {error:#}", absent.join(", "));
    }
    missing(&mut VULKAN_NEEDS.into_iter()).is_empty()
}

/// Returns the path of the compiler for Vulkan shaders.
pub fn glslang() -> Option<PathBuf> {
    apt::find_program("glslangValidator")
}

/// Fails if something is still missing that is not optional.
fn conclude(missing: &[&Need], remedy: &str) -> anyhow::Result<Libraries> {
    let required: Vec<&str> =
        missing.iter().filter(|need| need.what != OSMESA.what).map(|need| need.what).collect();
    if !required.is_empty() {
        bail!("{} missing: {remedy}", required.join(", "));
    }
    let osmesa = missing.is_empty();
    if !osmesa {
        eprintln!("warning: OSMesa is missing, so that --gl osmesa does not work here; {remedy}");
    }
    Ok(Libraries { osmesa })
}

fn missing(folders: &[PathBuf]) -> Vec<&'static Need> {
    static NEEDS: [Need; 5] = [EGL, VENDOR, GLES, DRIVER, OSMESA];
    NEEDS.iter().filter(|need| !need.is_in(folders)).collect()
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

fn exists(folders: &[PathBuf], name: &str) -> bool {
    folders.iter().any(|folder| match name.strip_suffix('*') {
        Some(start) => fs::read_dir(folder).is_ok_and(|entries| {
            entries.flatten().any(|entry| entry.file_name().to_string_lossy().starts_with(start))
        }),
        None => folder.join(name).exists(),
    })
}

/// Returns the command that installs everything on a distribution without apt, identified by its os-release file.
fn advice(release: &str) -> &'static str {
    let value = |key: &str| {
        let line = release.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix('='));
        line.unwrap_or_default().trim_matches('"').to_owned()
    };
    let ids = format!("{} {}", value("ID"), value("ID_LIKE"));
    let is = |name: &str| ids.split_whitespace().any(|id| id == name);
    if is("fedora") || is("rhel") || is("centos") {
        "`sudo dnf install libglvnd-egl libglvnd-gles mesa-libEGL mesa-dri-drivers mesa-libOSMesa`"
    } else if is("arch") {
        "`sudo pacman -S --needed libglvnd mesa`"
    } else if is("alpine") {
        "`doas apk add mesa-egl mesa-gles mesa-dri-gallium mesa-osmesa`"
    } else if is("suse") || is("opensuse") {
        "`sudo zypper install Mesa-libEGL1 Mesa-libGLESv2-2 Mesa-dri libOSMesa8`"
    } else {
        "your package manager: Mesa with EGL, OpenGL ES, llvmpipe and OSMesa"
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
        assert!(advice("ID=alpine").contains("apk"));
        assert!(advice("VERSION_ID=1\nID=slackware").contains("your package manager"));
    }

    #[test]
    fn finds_files_by_name_and_by_beginning() {
        let folder = env::temp_dir().join(format!("xtask-setup-{}", std::process::id()));
        fs::create_dir_all(folder.join("dri")).unwrap();
        for name in ["libEGL.so.1", "libgallium-24.2.so", "dri/other_dri.so"] {
            fs::write(folder.join(name), "").unwrap();
        }
        let found = missing(std::slice::from_ref(&folder));
        fs::remove_dir_all(&folder).unwrap();
        let names: Vec<&str> = found.iter().map(|need| need.what).collect();
        assert_eq!(names, [VENDOR.what, GLES.what, OSMESA.what]);
    }

    #[test]
    fn vulkan_is_a_loader_a_driver_and_a_layer() {
        let folder = env::temp_dir().join(format!("xtask-vulkan-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let here = || VULKAN_NEEDS.map(|need| need.is_in(std::slice::from_ref(&folder)));
        let before = here();
        fs::write(folder.join("libvulkan.so.1"), "").unwrap();
        fs::write(folder.join("libvulkan_lvp.so"), "").unwrap();
        let after = here();
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!((before, after), ([false; 3], [true, true, false]));
    }

    #[test]
    fn only_osmesa_is_optional() {
        assert_eq!(conclude(&[], "").unwrap(), Libraries { osmesa: true });
        assert_eq!(conclude(&[&OSMESA], "").unwrap(), Libraries { osmesa: false });
        let error = conclude(&[&EGL, &OSMESA], "do this").unwrap_err().to_string();
        assert_eq!(error, "libEGL missing: do this");
    }
}
