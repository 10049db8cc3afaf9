//! Checks that every output has a path of its own, before anything is written.

use std::collections::HashMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use anyhow::bail;

/// Refuses two outputs with the same file, and outputs that are inputs. Each has a description for the message.
pub fn check<'a>(
    inputs: impl IntoIterator<Item = &'a Path>,
    outputs: impl IntoIterator<Item = (PathBuf, String)>,
) -> anyhow::Result<()> {
    let inputs: HashMap<PathBuf, &Path> = inputs.into_iter().map(|path| (identity(path), path)).collect();
    let mut taken: HashMap<PathBuf, String> = HashMap::new();
    for (path, what) in outputs {
        // A device takes any number of files.
        if path.exists() && !path.is_file() {
            continue;
        }
        let place = identity(&path);
        if let Some(input) = inputs.get(&place) {
            bail!("{} is read, so {what} cannot be written there: choose another place", input.display());
        }
        if let Some(other) = taken.get(&place) {
            bail!(
                "{other} and {what} would both be written to {}: choose different places, or rename one of the inputs",
                path.display()
            );
        }
        taken.insert(place, what);
    }
    Ok(())
}

/// Returns a path that identifies a file, which need not exist.
fn identity(path: &Path) -> PathBuf {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let mut rest: Vec<&OsStr> = Vec::new();
    for present in whole.ancestors() {
        if let Ok(real) = present.canonicalize() {
            return real.join(rest.iter().rev().collect::<PathBuf>());
        }
        rest.extend(present.file_name());
    }
    whole
}
