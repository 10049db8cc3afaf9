//! Errors of reading and writing scenes.

use std::fmt::Display;
use std::io;
use std::path::Path;

/// An error of reading a scene, as one sentence that names the file and the remedy.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct SceneError(pub(super) String);

impl SceneError {
    /// The operating system refused to read.
    pub(super) fn read(path: &Path) -> impl Fn(io::Error) -> SceneError {
        move |reason| {
            let path = path.display();
            SceneError(format!("{path} cannot be read ({reason}): check its permissions and the disk"))
        }
    }

    /// `what` contains the remedy.
    pub(super) fn unusable(path: &Path, what: impl Display) -> SceneError {
        SceneError(format!("{}: {what}", path.display()))
    }

    /// The file contains nothing to draw.
    pub(super) fn empty(path: &Path) -> SceneError {
        let path = path.display();
        SceneError(format!(
            "{path} contains no triangle that can be drawn: export the model again with its faces"
        ))
    }

    /// The file has more than fits into 32-bit indices and memory.
    pub(super) fn too_large(path: &Path, limit: usize, what: &str) -> SceneError {
        SceneError(format!("{} has more than {limit} {what}: split the model or reduce it", path.display()))
    }

    /// A `camera.json` or `scene.json` is malformed.
    pub(super) fn sidecar(path: &Path, what: impl Display) -> SceneError {
        SceneError(format!(
            "{} is malformed ({what}): correct it, or remove it to get defaults",
            path.display()
        ))
    }

    /// A texture exists but cannot be decoded.
    pub(super) fn texture(path: &Path, what: impl Display) -> SceneError {
        SceneError(format!(
            "the texture {} cannot be used ({what}): replace it, or remove it to load the model without",
            path.display()
        ))
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
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => SceneError(format!(
            "there is no file {}: give the path of an .obj, .gltf or .glb file",
            path.display()
        )),
        _ => SceneError::read(path)(source),
    })?;
    size.ok_or_else(|| {
        SceneError(format!(
            "{} is not a file: give the path of the .obj, .gltf or .glb file itself",
            path.display()
        ))
    })
}
