//! Before anything is written: whether every output has a place of its own.

use std::collections::HashMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use anyhow::bail;

/// Refuses outputs of which two would be one file, or one an input. Each output comes with what it is, for the message.
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

/// A path that only one file has, whether the file exists or not.
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
