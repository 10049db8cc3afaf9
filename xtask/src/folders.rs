//! The folders of the workspace and of its target, and helpers for files.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::Context as _;

/// Returns the workspace's folder.
pub fn root() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.parent().unwrap_or(package).to_owned()
}

/// Returns cargo's target folder, found from this program's own path, `target/debug/xtask`.
pub fn target_folder() -> anyhow::Result<PathBuf> {
    let program = std::env::current_exe().context("this program does not know where it lies")?;
    let folder = program.ancestors().nth(2).context("this program lies in no target folder")?;
    Ok(folder.to_owned())
}

/// Makes a folder with `make`, unless it exists and was made by the same `recipe`. Removes an outdated one first.
pub fn make_once(
    folder: &Path,
    recipe: &str,
    make: impl FnOnce() -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    let stamp = folder.join("stamp");
    if fs::read_to_string(&stamp).is_ok_and(|old| old == recipe) {
        return Ok(());
    }
    remove(folder)?;
    make()?;
    write(&stamp, recipe)
}

/// Removes a folder if it exists.
pub fn remove(folder: &Path) -> anyhow::Result<()> {
    if folder.exists() {
        fs::remove_dir_all(folder)
            .with_context(|| format!("{} cannot be removed: remove it by hand", folder.display()))?;
    }
    Ok(())
}

/// Writes a file, and makes its parent folders. The file is always complete, even if several processes and threads
/// write it at the same time.
pub fn write(file: &Path, content: impl AsRef<[u8]>) -> anyhow::Result<()> {
    static WRITTEN: AtomicUsize = AtomicUsize::new(0);
    let number = WRITTEN.fetch_add(1, Ordering::Relaxed);
    let unfinished = file.with_added_extension(format!("{}-{number}.tmp", std::process::id()));
    make_parent(file)?;
    fs::write(&unfinished, content)
        .and_then(|()| fs::rename(&unfinished, file))
        .with_context(|| format!("{} cannot be written", file.display()))
}

/// Copies a file, and makes the parent folders of the copy.
pub fn copy(from: &Path, to: &Path) -> anyhow::Result<()> {
    make_parent(to)?;
    fs::copy(from, to).with_context(|| format!("{} cannot be copied to {}", from.display(), to.display()))?;
    Ok(())
}

/// Copies a folder and the folders in it.
pub fn copy_folder(from: &Path, to: &Path) -> anyhow::Result<()> {
    files(from)?.into_iter().try_for_each(|(name, path)| copy(&path, &to.join(name)))
}

/// Returns the names, relative to a folder, and the paths of all files in it and in its folders, sorted by name.
pub fn files(folder: &Path) -> anyhow::Result<Vec<(String, PathBuf)>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).with_context(|| format!("{} cannot be read", folder.display()))? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() {
            found.extend(files(&path)?.into_iter().map(|(file, path)| (format!("{name}/{file}"), path)));
        } else {
            found.push((name, path));
        }
    }
    found.sort();
    Ok(found)
}

/// Makes a folder and its parents.
pub fn make(folder: &Path) -> anyhow::Result<()> {
    fs::create_dir_all(folder).with_context(|| format!("{} cannot be made", folder.display()))
}

/// Makes the parent folders of a file.
pub fn make_parent(file: &Path) -> anyhow::Result<()> {
    file.parent().map_or(Ok(()), make)
}

/// Returns the content of a file.
pub fn read(file: &Path) -> anyhow::Result<Vec<u8>> {
    fs::read(file).with_context(|| format!("{} cannot be read", file.display()))
}

/// Returns the text in a file.
pub fn read_text(file: &Path) -> anyhow::Result<String> {
    fs::read_to_string(file).with_context(|| format!("{} cannot be read", file.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_write_the_same_file_without_a_quarrel() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| (0..200).for_each(|_| write(&file, "whole").unwrap()));
            }
        });
        assert_eq!(fs::read_to_string(&file).unwrap(), "whole");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
