//! The places where a runtime may be, by each system's conventions.

use std::ffi::OsString;
use std::fmt;
use std::path::{Path, PathBuf};

/// The installable broker, which the user can choose, and the one that is part of the system.
const AUTHORITIES: [&str; 2] =
    ["org.khronos.openxr.runtime_broker", "org.khronos.openxr.system_runtime_broker"];
/// Configuration folders of Android's partitions, the most specific first.
const ANDROID_ETC: [&str; 5] = ["/product/etc", "/odm/etc", "/oem/etc", "/vendor/etc", "/system/etc"];
/// The name under which an Android package contains a loader.
const ANDROID_LOADER: &str = "libopenxr_loader.so";

/// A place to look for a runtime.
#[derive(Clone, Debug, PartialEq)]
pub enum RuntimeSource {
    /// A loader library, by its path or by a plain name for `dlopen` to find. The loader finds the runtime and API
    /// layers by its own rules.
    Loader(PathBuf),
    /// The runtime broker at this authority: a content provider of Android.
    Broker(String),
    /// A manifest file.
    Manifest(PathBuf),
}

impl fmt::Display for RuntimeSource {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            RuntimeSource::Loader(library) => write!(f, "loader {}", library.display()),
            RuntimeSource::Broker(authority) => write!(f, "broker {authority}"),
            RuntimeSource::Manifest(path) => write!(f, "{}", path.display()),
        }
    }
}

/// Returns Android's places: the loader in the application's own package if there is one, the brokers, and the manifest
/// files on the system's partitions.
pub fn android_places() -> Vec<RuntimeSource> {
    let mut places = vec![RuntimeSource::Loader(ANDROID_LOADER.into())];
    places.extend(AUTHORITIES.map(|authority| RuntimeSource::Broker(authority.into())));
    places.extend(ANDROID_ETC.into_iter().flat_map(|etc| manifests(Path::new(etc))));
    places
}

/// Returns Linux's places: only the manifest that `XR_RUNTIME_JSON` names, or else those of the XDG configuration
/// directories, the user's before the system's.
///
/// `environment` is asked for `XR_RUNTIME_JSON`, `XDG_CONFIG_HOME`, `XDG_CONFIG_DIRS` and `HOME`. In a program that
/// runs with more privileges than its user, it should return `None`.
pub fn linux_places(environment: impl Fn(&str) -> Option<OsString>) -> Vec<RuntimeSource> {
    let set = |name: &str| environment(name).filter(|value| !value.is_empty());
    if let Some(manifest) = set("XR_RUNTIME_JSON") {
        return vec![RuntimeSource::Manifest(manifest.into())];
    }
    let user = set("XDG_CONFIG_HOME")
        .map(PathBuf::from)
        .or_else(|| set("HOME").map(|home| Path::new(&home).join(".config")));
    let system = set("XDG_CONFIG_DIRS").unwrap_or_else(|| "/etc/xdg".into());
    let mut directories: Vec<PathBuf> = user.into_iter().collect();
    directories.extend(std::env::split_paths(&system).filter(|path| !path.as_os_str().is_empty()));
    directories.push("/etc".into());
    let mut places: Vec<RuntimeSource> = Vec::new();
    for place in directories.iter().flat_map(|directory| manifests(directory)) {
        if !places.contains(&place) {
            places.push(place);
        }
    }
    places
}

/// Returns the manifests in a configuration folder: the one for this architecture before the general one.
fn manifests(configuration: &Path) -> [RuntimeSource; 2] {
    let architecture = match std::env::consts::ARCH {
        "x86" => "i686",
        "arm" => "armv7a-vfp",
        other => other,
    };
    let folder = configuration.join("openxr/1");
    [format!("active_runtime.{architecture}.json"), "active_runtime.json".into()]
        .map(|name| RuntimeSource::Manifest(folder.join(name)))
}
