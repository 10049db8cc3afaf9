//! Errors of reading and writing scenes.

use std::io;
use std::path::{Path, PathBuf};

/// Errors of reading and writing a scene. Every message is one sentence that names the file and the remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The file does not exist.
    #[error("there is no file {path}: give the path of an .obj, .gltf or .glb file")]
    NotFound {
        /// The path given.
        path: PathBuf,
    },
    /// The path is a folder, a device or a pipe.
    #[error("{path} is not a file: give the path of the .obj, .gltf or .glb file itself")]
    NotAFile {
        /// The path given.
        path: PathBuf,
    },
    /// The file has another format.
    #[error("{path} is not a scene that can be read: convert it to .obj, .gltf or .glb")]
    UnknownFormat {
        /// The path given.
        path: PathBuf,
    },
    /// The operating system refused to read.
    #[error("{path} cannot be read ({source}): check its permissions and the disk")]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A malformed statement and its line.
    #[error("{path}, line {line}: {what}; correct the line or export the model again")]
    Statement {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// The fault.
        what: String,
    },
    /// The file is damaged, or uses something unsupported; `what` contains the remedy.
    #[error("{path}: {what}")]
    Unusable {
        /// The file.
        path: PathBuf,
        /// The fault and the remedy.
        what: String,
    },
    /// The file contains nothing to draw.
    #[error("{path} contains no triangle that can be drawn: export the model again with its faces")]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The file has more than fits into 32-bit indices and memory.
    #[error("{path} has more than {limit} {what}: split the model or reduce it")]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Largest number accepted.
        limit: usize,
        /// What is counted.
        what: &'static str,
    },
    /// A texture exists but cannot be decoded.
    #[error("the texture {path} cannot be used ({what}): replace it, or remove it to load the model without")]
    Texture {
        /// The picture's file.
        path: PathBuf,
        /// The fault.
        what: String,
    },
    /// A malformed `camera.json` or `scene.json`.
    #[error("{path} is malformed ({what}): correct it, or remove it to get defaults")]
    Sidecar {
        /// The file.
        path: PathBuf,
        /// The fault.
        what: String,
    },
}

impl SceneError {
    pub(super) fn unusable(path: &Path, what: impl Into<String>) -> SceneError {
        SceneError::Unusable { path: path.into(), what: what.into() }
    }
}

/// Maximum number of vertices, of triangle corners, and of entries of one kind in a file. Keeps every index in 32 bits
/// and bounds the memory that a damaged or hostile file can take.
pub(super) const MAX_ELEMENTS: usize = 1 << 27;

/// Distance from the origin, in a file's units, from which positions are brought to it before they are rounded to f32,
/// which distinguishes 1/128 unit there.
pub(super) const FAR: f64 = 1e5;

/// Checks that a path is a regular file and returns its size in bytes.
pub(super) fn file_size(path: &Path) -> Result<u64, SceneError> {
    let size = yoro_files::size(path).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => SceneError::NotFound { path: path.into() },
        _ => SceneError::Read { path: path.into(), source },
    })?;
    size.ok_or_else(|| SceneError::NotAFile { path: path.into() })
}
