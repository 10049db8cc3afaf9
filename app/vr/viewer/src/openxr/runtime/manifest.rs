//! Manifest files: a runtime's library and its renamed functions, as JSON.

use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::error::Failure;
use super::library::Candidate;

/// A manifest in the only format that exists. The specification allows unknown keys.
#[derive(Deserialize)]
struct Manifest {
    file_format_version: String,
    runtime: Runtime,
}

#[derive(Deserialize)]
struct Runtime {
    library_path: String,
    #[serde(default)]
    functions: HashMap<String, String>,
}

/// Returns the library that the manifest at `path` names.
pub(super) fn read(path: &Path) -> Result<Candidate, Failure> {
    let name = path.display();
    let text = fs::read(path).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => Failure::Absent(format!("{name} does not exist")),
        _ => Failure::Unusable(format!("the manifest {name} cannot be read ({error})")),
    })?;
    let manifest: Manifest = serde_json::from_slice(&text).map_err(|error| {
        Failure::Unusable(format!("{name} is not the manifest of an OpenXR runtime ({error})"))
    })?;
    let version = manifest.file_format_version;
    if version != "1.0.0" {
        let what = format!("the manifest {name} is of format {version}; only 1.0.0 is known");
        return Err(Failure::Unusable(what));
    }
    let library = locate(&manifest.runtime.library_path, path);
    Ok(Candidate { library, functions: manifest.runtime.functions })
}

/// Resolves a library's path. A plain name is left to the dynamic linker; other relative paths are relative to the
/// manifest, or to its target if it is a symbolic link.
fn locate(library: &str, manifest: &Path) -> PathBuf {
    if !library.contains('/') {
        return library.into();
    }
    let real = fs::canonicalize(manifest).unwrap_or_else(|_| manifest.into());
    real.parent().unwrap_or(Path::new("/")).join(library)
}
