//! Finds, loads and negotiates with the OpenXR runtime of this machine, in pure Rust.
//!
//! Usually the Khronos loader does this. It is C++, which an Android library without C++ cannot carry, and what it does
//! to reach the one active runtime is little:
//!
//! 1. find the runtime: on Android a content provider (the *runtime broker*) names a library, or a manifest file on one
//!    of the system's partitions does; on Linux a manifest file that `XR_RUNTIME_JSON` or the XDG directories lead to;
//! 2. `dlopen` the library and call its `xrNegotiateLoaderRuntimeInterface`;
//! 3. use the `xrGetInstanceProcAddr` that this returns.
//!
//! A loader library, where one is packaged or named, wins over all of it: see [`Place::Loader`].
//!
//! # What is bypassed
//! API layers are the loader's work. Without it neither implicit nor explicit layers are found, so tools such as
//! validation, capture and toolkit layers do not see the application. A runtime need not even know the functions that
//! list layers: do not call `openxr::Entry::enumerate_layers` or `enumerate_layer_extensions`, which abort where it
//! does not. Use a loader library to get layers back.
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
//! The module uses nothing of the rest of this crate, only `openxr`, `libloading`, `serde`, `serde_json` and
//! `thiserror`. Sources: OpenXR specification, "Loader Runtime Interaction", and the Khronos loader's documented
//! search.

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
pub use places::{Place, android_places, linux_places};

use library::Candidate;

/// The runtime that is in use: a library that has been loaded and has agreed to talk.
///
/// The library stays loaded until the process ends: runtimes keep threads, and functions that were asked for may be
/// called at any time. Finding the runtime again, after an instance loss for instance, gives the same library.
#[derive(Clone, Debug)]
pub struct Runtime {
    get_instance_proc_addr: openxr::sys::pfn::GetInstanceProcAddr,
    found: Found,
}

/// The runtime that was found, and its place; `Display` writes the one line for the log.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The place that led to the library.
    pub place: Place,
    /// The library as it was given to `dlopen`.
    pub library: PathBuf,
    /// The newest OpenXR version that the runtime offers; none where a loader stands between.
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
    /// `xrGetInstanceProcAddr` of the runtime, or of the loader in front of it.
    pub fn get_instance_proc_addr(&self) -> openxr::sys::pfn::GetInstanceProcAddr {
        self.get_instance_proc_addr
    }

    /// The runtime that was found, and its place.
    pub fn found(&self) -> &Found {
        &self.found
    }

    /// The entry to the API, as the crate `openxr` has it. On Android nothing is left to initialise: instances are
    /// created with `openxr::AndroidPlatformInfo`. Of several runtimes in one process, instances go to the one whose
    /// entry was asked for last.
    pub fn entry(&self) -> openxr::Result<openxr::Entry> {
        // SAFETY: the function is what the runtime itself offers as xrGetInstanceProcAddr, and its library is never
        // unloaded.
        unsafe { entry::open(self.get_instance_proc_addr) }
    }
}

/// The first of `places` that leads to a runtime which can be loaded and agrees on OpenXR 1.
///
/// `broker` answers for [`Place::Broker`]; [`NoBroker`] where there is none. `java` is needed on Android, where
/// loaders and some runtimes want `xrInitializeLoaderKHR` to be called before anything else.
///
/// This runs code of the library that it finds. Nothing is ever tested with `stat`: a library may lie within an APK.
///
/// # Errors
/// [`NotFound`] with the failure of every place.
pub fn find(places: &[Place], broker: &dyn Broker, java: Option<&JavaContext>) -> Result<Runtime, NotFound> {
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

fn load(place: &Place, candidate: &Candidate, java: Option<&JavaContext>) -> Result<Runtime, Failure> {
    let (get_instance_proc_addr, api_version) = match place {
        Place::Loader(_) => (candidate.open_loader(java)?, None),
        Place::Broker(_) | Place::Manifest(_) => {
            let (function, version) = candidate.negotiate(java)?;
            (function, Some((version.major(), version.minor(), version.patch())))
        }
    };
    let found = Found { place: place.clone(), library: candidate.library.clone(), api_version };
    Ok(Runtime { get_instance_proc_addr, found })
}

/// The libraries that a place names, in the order in which they are to be tried.
fn candidates(place: &Place, broker: &dyn Broker) -> Result<Vec<Result<Candidate, Failure>>, Failure> {
    match place {
        Place::Loader(library) => {
            Ok(vec![Ok(Candidate { library: library.clone(), functions: Default::default() })])
        }
        Place::Broker(authority) => broker::ask(broker, authority),
        Place::Manifest(path) => Ok(vec![Ok(manifest::read(path)?)]),
    }
}
