//! Reasons why no runtime was found.

use std::fmt;
use std::io;
use std::path::PathBuf;

use openxr::sys;

use super::places::RuntimeSource;

/// No place led to a runtime. `Display` writes all failures in one line.
#[derive(Debug)]
pub struct NotFound {
    /// The places in the order in which they were tried. A broker that offers several runtimes appears once for each.
    pub attempts: Vec<(RuntimeSource, Failure)>,
}

impl NotFound {
    /// True if no place names a library, as on a phone: nothing is installed. Otherwise a runtime is installed but does
    /// not work.
    pub fn nothing_installed(&self) -> bool {
        self.attempts.iter().all(|(place, failure)| {
            matches!(
                (place, failure),
                (_, Failure::NoManifest { .. } | Failure::NoBroker { .. } | Failure::NoActiveRuntime { .. })
                    | (RuntimeSource::Loader(_), Failure::Open { .. })
            )
        })
    }
}

impl fmt::Display for NotFound {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "no OpenXR runtime was found")?;
        for (i, (_, failure)) in self.attempts.iter().enumerate() {
            write!(f, "{} {failure}", if i == 0 { ":" } else { ";" })?;
        }
        Ok(())
    }
}

impl std::error::Error for NotFound {}

/// A failure at one place. Each names the failed step, and the file, library or broker.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Failure {
    /// No manifest exists at this path.
    #[error("{} does not exist", path.display())]
    NoManifest {
        /// The manifest.
        path: PathBuf,
    },
    /// The manifest cannot be read.
    #[error("the manifest {} cannot be read ({source})", path.display())]
    ReadManifest {
        /// The manifest.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The manifest is not JSON, or not a runtime's manifest.
    #[error("{} is not the manifest of an OpenXR runtime ({source})", path.display())]
    Manifest {
        /// The manifest.
        path: PathBuf,
        /// The mistake and its position.
        source: serde_json::Error,
    },
    /// The manifest has an unknown format version.
    #[error("the manifest {} is of format {version}; only 1.0.0 is known", path.display())]
    ManifestVersion {
        /// The manifest.
        path: PathBuf,
        /// Its `file_format_version`.
        version: String,
    },
    /// No content provider answers at the authority.
    #[error("no broker at {authority}")]
    NoBroker {
        /// The authority asked.
        authority: String,
    },
    /// The broker could not be queried.
    #[error("the broker {authority} cannot be asked ({reason})")]
    Broker {
        /// The authority asked.
        authority: String,
        /// The system's message.
        reason: String,
    },
    /// The broker has no active runtime for this architecture.
    #[error("the broker {authority} has no active runtime")]
    NoActiveRuntime {
        /// The authority asked.
        authority: String,
    },
    /// A column is missing from the broker's answer.
    #[error("the broker {authority} names a runtime without {column}")]
    BrokerRow {
        /// The authority asked.
        authority: String,
        /// The column that is missing or empty.
        column: &'static str,
    },
    /// The broker says that functions are renamed, but does not list their names.
    #[error("the broker {authority} does not tell the function names of {package}")]
    BrokerFunctions {
        /// The authority asked.
        authority: String,
        /// The runtime's package.
        package: String,
    },
    /// The library cannot be loaded.
    #[error("{} cannot be loaded ({reason})", library.display())]
    Open {
        /// The library.
        library: PathBuf,
        /// The dynamic linker's message.
        reason: String,
    },
    /// The library lacks a function.
    #[error("{} has no function {symbol}: it is not an OpenXR {kind}", library.display())]
    Symbol {
        /// The library.
        library: PathBuf,
        /// The function's name, after renaming.
        symbol: String,
        /// `runtime` or `loader`.
        kind: &'static str,
    },
    /// `xrInitializeLoaderKHR` failed.
    #[error("{} refuses to be initialised with xrInitializeLoaderKHR ({result})", library.display())]
    Initialize {
        /// The library.
        library: PathBuf,
        /// The result that it returned.
        result: sys::Result,
    },
    /// `xrNegotiateLoaderRuntimeInterface` failed.
    #[error("{} refuses loader interface 1 with OpenXR 1 ({result})", library.display())]
    Refused {
        /// The library.
        library: PathBuf,
        /// The result that it returned.
        result: sys::Result,
    },
    /// The runtime negotiated another version.
    #[error(
        "{} negotiates loader interface {interface} and OpenXR {}.{}; needed are interface 1 and OpenXR 1",
        library.display(), api.major(), api.minor()
    )]
    Version {
        /// The library.
        library: PathBuf,
        /// The version of the interface between loader and runtime.
        interface: u32,
        /// The version of the API.
        api: sys::Version,
    },
    /// The negotiation succeeded without an entry point.
    #[error("{} negotiates well and gives no xrGetInstanceProcAddr", library.display())]
    NoEntryPoint {
        /// The library.
        library: PathBuf,
    },
}
