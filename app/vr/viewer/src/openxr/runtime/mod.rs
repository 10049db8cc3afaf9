//! Finds, loads and negotiates with the OpenXR runtime of this machine, in pure Rust.
//!
//! Usually the Khronos loader does this. It is written in C++, which an Android library without C++ cannot include, and
//! little is needed to reach the one active runtime:
//!
//! 1. Find the runtime. On Android, a content provider (the *runtime broker*) names a library, or a manifest file on
//!    one of the system's partitions does; on Linux, a manifest file by `XR_RUNTIME_JSON` or the XDG directories.
//! 2. `dlopen` the library and call its `xrNegotiateLoaderRuntimeInterface`.
//! 3. Use the `xrGetInstanceProcAddr` that this returns.
//!
//! A loader library, if one is packaged or named, takes precedence: see [`RuntimeSource::Loader`].
//!
//! # What is bypassed
//! API layers are the loader's job. Without it neither implicit nor explicit layers are found, so tools such as
//! validation, capture and toolkit layers do not see the application. A runtime need not even implement the functions
//! that list layers: do not call `openxr::Entry::enumerate_layers` or `enumerate_layer_extensions`, which abort in that
//! case. Use a loader library to get layers back.
//!
//! # Use
//! ```no_run
//! use yoro_viewer::openxr::runtime;
//!
//! let places = runtime::linux_places(|name| std::env::var_os(name));
//! let runtime = runtime::find(&places, &runtime::NoBroker, None).unwrap_or_else(|error| panic!("{error}"));
//! println!("{}", runtime.found()); // "OpenXR 1.1.36 runtime libopenxr_monado.so by /etc/xdg/openxr/1/..."
//! let entry = runtime.entry().expect("a runtime has xrCreateInstance");
//! println!("{:?}", entry.enumerate_extensions());
//! ```
//!
//! The module uses nothing else of this crate, only `openxr`, `libloading`, `serde`, `serde_json` and `thiserror`.
//! Sources: OpenXR specification, "Loader Runtime Interaction", and the Khronos loader's documented search.

mod broker;
mod entry;
mod error;
mod library;
mod manifest;
mod places;
#[cfg(all(test, target_os = "linux"))]
mod tests;

use std::fmt;
use std::path::PathBuf;

pub use broker::{Broker, NoBroker, Rows};
pub use error::{Failure, NotFound};
pub use library::JavaContext;
pub use openxr;
pub use places::{RuntimeSource, android_places, linux_places};

use library::Candidate;

/// The runtime in use: a library that was loaded and has accepted the versions offered.
///
/// The library stays loaded until the process ends: runtimes have threads, and functions obtained from them may be
/// called at any time. Finding the runtime again, for instance after the loss of an instance, returns the same library.
#[derive(Clone, Debug)]
pub struct Runtime {
    get_instance_proc_addr: openxr::sys::pfn::GetInstanceProcAddr,
    found: Found,
}

/// A description of the runtime that was found; `Display` writes it in one line for the log.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The place that led to the library.
    pub place: RuntimeSource,
    /// The library as it was passed to `dlopen`.
    pub library: PathBuf,
    /// The newest OpenXR version that the runtime offers; `None` behind a loader.
    pub api_version: Option<(u16, u16, u32)>,
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.api_version {
            Some((major, minor, patch)) => {
                write!(
                    f,
                    "OpenXR {major}.{minor}.{patch} runtime {} by {}",
                    self.library.display(),
                    self.place
                )
            }
            None => write!(f, "OpenXR by the {}", self.place),
        }
    }
}

impl Runtime {
    /// Returns the `xrGetInstanceProcAddr` of the runtime, or of the loader in front of it.
    pub fn get_instance_proc_addr(&self) -> openxr::sys::pfn::GetInstanceProcAddr {
        self.get_instance_proc_addr
    }

    /// Returns a description of the runtime and its place.
    pub fn found(&self) -> &Found {
        &self.found
    }

    /// Returns the entry to the API for the crate `openxr`. On Android nothing else needs to be initialised: instances
    /// are created with `openxr::AndroidPlatformInfo`. If a process has several runtimes, instances go to the one whose
    /// `entry` was called last.
    pub fn entry(&self) -> openxr::Result<openxr::Entry> {
        // SAFETY: the function is the xrGetInstanceProcAddr that the runtime or loader provides, and its library is
        // never unloaded.
        unsafe { entry::open(self.get_instance_proc_addr) }
    }
}

/// Returns the first runtime that `places` lead to, that can be loaded and that accepts OpenXR 1.
///
/// `broker` answers for [`RuntimeSource::Broker`]; pass [`NoBroker`] where there is none. `java` is needed on Android, where
/// loaders and some runtimes require `xrInitializeLoaderKHR` before any other call.
///
/// This runs code of the libraries found. Nothing is tested with `stat`, since a library may be inside an APK.
///
/// # Errors
/// [`NotFound`] with the failure at every place.
pub fn find(
    places: &[RuntimeSource],
    broker: &dyn Broker,
    java: Option<&JavaContext>,
) -> Result<Runtime, NotFound> {
    let mut attempts = Vec::new();
    for place in places {
        let candidates = match candidates(place, broker) {
            Ok(candidates) => candidates,
            Err(failure) => {
                attempts.push((place.clone(), failure));
                continue;
            }
        };
        for candidate in candidates {
            match candidate.and_then(|candidate| load(place, &candidate, java)) {
                Ok(runtime) => return Ok(runtime),
                Err(failure) => attempts.push((place.clone(), failure)),
            }
        }
    }
    Err(NotFound { attempts })
}

fn load(
    place: &RuntimeSource,
    candidate: &Candidate,
    java: Option<&JavaContext>,
) -> Result<Runtime, Failure> {
    let (get_instance_proc_addr, api_version) = match place {
        RuntimeSource::Loader(_) => (candidate.open_loader(java)?, None),
        RuntimeSource::Broker(_) | RuntimeSource::Manifest(_) => {
            let (function, version) = candidate.negotiate(java)?;
            (function, Some((version.major(), version.minor(), version.patch())))
        }
    };
    let found = Found { place: place.clone(), library: candidate.library.clone(), api_version };
    Ok(Runtime { get_instance_proc_addr, found })
}

/// Returns the libraries that a place names, in the order in which to try them.
fn candidates(
    place: &RuntimeSource,
    broker: &dyn Broker,
) -> Result<Vec<Result<Candidate, Failure>>, Failure> {
    match place {
        RuntimeSource::Loader(library) => {
            Ok(vec![Ok(Candidate { library: library.clone(), functions: Default::default() })])
        }
        RuntimeSource::Broker(authority) => broker::ask(broker, authority),
        RuntimeSource::Manifest(path) => Ok(vec![Ok(manifest::read(path)?)]),
    }
}
