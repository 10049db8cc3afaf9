//! Files to read: those of the file system or, in a browser, those that were [provided](provide).

#[cfg(not(target_arch = "wasm32"))]
mod source {
    use std::ffi::OsString;
    use std::fs;
    use std::io;
    use std::path::Path;

    /// A file that can be read.
    pub type Input = fs::File;

    /// Opens a file.
    ///
    /// # Errors
    /// The operating system's errors.
    pub fn open(path: &Path) -> io::Result<Input> {
        fs::File::open(path)
    }

    /// Returns the size of a file in bytes; `None` if the path exists but is not a file.
    ///
    /// # Errors
    /// The operating system's errors.
    pub fn size(path: &Path) -> io::Result<Option<u64>> {
        let meta = fs::metadata(path)?;
        Ok(meta.is_file().then_some(meta.len()))
    }

    /// Returns the names in a folder, in no particular order. An empty path means `.`.
    ///
    /// # Errors
    /// The operating system's errors.
    pub fn names(folder: &Path) -> io::Result<Vec<OsString>> {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        fs::read_dir(folder)?.map(|entry| Ok(entry?.file_name())).collect()
    }

    /// True if a file or folder exists.
    pub fn exists(path: &Path) -> bool {
        path.exists()
    }
}

/// Files in memory, by their paths.
#[cfg(any(test, target_arch = "wasm32"))]
mod memory {
    use std::collections::BTreeMap;
    use std::ffi::OsString;
    use std::io::{self, Cursor};
    use std::path::{Component, Path, PathBuf};
    use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard};

    /// A file that can be read.
    pub type Input = Cursor<Arc<[u8]>>;

    type Files = BTreeMap<PathBuf, Arc<[u8]>>;

    static FILES: RwLock<Files> = RwLock::new(Files::new());

    /// Replaces the files that can be read.
    pub fn provide(files: impl IntoIterator<Item = (PathBuf, Vec<u8>)>) {
        *FILES.write().unwrap_or_else(PoisonError::into_inner) =
            files.into_iter().map(|(path, bytes)| (plain(&path), bytes.into())).collect();
    }

    fn files() -> RwLockReadGuard<'static, Files> {
        FILES.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// Opens a file.
    ///
    /// # Errors
    /// `NotFound` for a file that was not provided.
    pub fn open(path: &Path) -> io::Result<Input> {
        let bytes = files().get(&plain(path)).cloned().ok_or(io::ErrorKind::NotFound)?;
        Ok(Cursor::new(bytes))
    }

    /// Returns the size of a file in bytes; `None` if the path is a folder.
    ///
    /// # Errors
    /// Those of [`open`].
    pub fn size(path: &Path) -> io::Result<Option<u64>> {
        match files().get(&plain(path)) {
            Some(bytes) => Ok(Some(bytes.len() as u64)),
            None if exists(path) => Ok(None),
            None => Err(io::ErrorKind::NotFound.into()),
        }
    }

    /// Returns the names in a folder.
    ///
    /// # Errors
    /// None: the names of an unknown folder are empty.
    pub fn names(folder: &Path) -> io::Result<Vec<OsString>> {
        let (files, folder) = (files(), plain(folder));
        let below = files.keys().filter_map(|path| path.strip_prefix(&folder).ok());
        let mut names: Vec<_> =
            below.filter_map(|path| Some(path.components().next()?.as_os_str().to_owned())).collect();
        names.dedup();
        Ok(names)
    }

    /// True if a file or folder exists.
    pub fn exists(path: &Path) -> bool {
        let path = plain(path);
        files().keys().any(|known| known.starts_with(&path))
    }

    /// Resolves `.` and `..`.
    fn plain(path: &Path) -> PathBuf {
        let mut out = PathBuf::new();
        for component in path.components() {
            match component {
                Component::ParentDir => {
                    out.pop();
                }
                Component::Normal(name) => out.push(name),
                _ => {}
            }
        }
        out
    }
}

#[cfg(target_arch = "wasm32")]
pub use memory::*;
#[cfg(not(target_arch = "wasm32"))]
pub use source::*;

use std::path::Path;

/// True if `path` is a file.
pub fn is_file(path: &Path) -> bool {
    matches!(size(path), Ok(Some(_)))
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;
    use std::path::Path;

    use super::memory;

    #[test]
    fn files_in_memory_are_found_as_in_folders() {
        memory::provide([
            ("model.obj".into(), b"v".to_vec()),
            ("textures/a.png".into(), b"png".to_vec()),
            ("./textures/b.png".into(), Vec::new()),
        ]);
        let mut text = String::new();
        memory::open(Path::new("textures/../textures/a.png")).unwrap().read_to_string(&mut text).unwrap();
        assert_eq!(text, "png");
        assert_eq!(memory::size(Path::new("textures/b.png")).unwrap(), Some(0));
        assert_eq!(memory::size(Path::new("textures")).unwrap(), None);
        assert_eq!(memory::size(Path::new("tex")).unwrap_err().kind(), std::io::ErrorKind::NotFound);
        assert_eq!(memory::names(Path::new("")).unwrap(), ["model.obj", "textures"]);
        assert_eq!(memory::names(Path::new("textures")).unwrap(), ["a.png", "b.png"]);
        assert!(memory::exists(Path::new("textures")) && !memory::exists(Path::new("textures/c.png")));
    }
}
