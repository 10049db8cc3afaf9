//! Reading and writing files: an output is complete or absent, and an error names the file and the remedy.
//!
//! [`read`] and [`write()`] process whole files, [`write_with`] lets the caller fill a file that appears only when it
//! is complete, [`append`] opens a file that grows, and [`find`] lists the files below a folder. Loaders that read in
//! pieces use [`open`], which in a browser opens files in memory. This crate does not know what is in the files.

pub mod decoder;
pub mod http;
mod input;
pub mod interrupt;
pub mod xdg;

use std::fs;
use std::io::{self, BufWriter, Read as _, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

pub use input::*;

/// Errors of reading and writing files.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The file or folder does not exist.
    #[error("{} does not exist: check the path", .0.display())]
    Missing(PathBuf),
    /// The path is a folder, but a file is needed.
    #[error("{} is a folder: name a file", .0.display())]
    IsFolder(PathBuf),
    /// The path is a file, but a folder is needed.
    #[error("{} is not a folder: name a folder, or remove the file", .0.display())]
    NotFolder(PathBuf),
    /// The operating system refused to read.
    #[error("cannot read {}: {}", path.display(), remedy(source))]
    Read {
        /// The file asked for.
        path: PathBuf,
        /// The operating system's error.
        source: io::Error,
    },
    /// The operating system refused to write.
    #[error("cannot write {}: {}", path.display(), remedy(source))]
    Write {
        /// The file or folder to be written.
        path: PathBuf,
        /// The operating system's error.
        source: io::Error,
    },
    /// The output would replace an input.
    #[error("{} is an input of this command: name another file for the output", .0.display())]
    IsInput(PathBuf),
    /// The user has asked to stop.
    #[error(transparent)]
    Interrupted(#[from] interrupt::Interrupted),
    /// The file or folder belongs to another run, so nothing is added to it. Holds the sentence.
    #[error("{0}")]
    OtherRun(String),
    /// Another process appends to the file.
    #[error("{} is being written by another yoro: wait until that has ended, or choose another place", .0.display())]
    InUse(PathBuf),
}

/// Returns an error of the operating system as a [`FileError`] tells it: with a remedy where there is one.
pub fn remedy(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::PermissionDenied => "no permission; change its rights or choose another place".into(),
        io::ErrorKind::StorageFull => "the disk is full; free some space or choose another place".into(),
        io::ErrorKind::ReadOnlyFilesystem => "the file system is read-only; choose another place".into(),
        io::ErrorKind::NotFound => "there is no such place; check the path".into(),
        io::ErrorKind::NotADirectory => "a part of the path is a file; choose another place".into(),
        _ => {
            // The words of the operating system, without its number.
            let text = error.to_string();
            text.split(" (os error").next().unwrap_or(&text).to_owned()
        }
    }
}

/// Returns the whole content of the file `path`.
pub fn read(path: &Path) -> Result<Vec<u8>, FileError> {
    if path.is_dir() {
        return Err(FileError::IsFolder(path.into()));
    }
    let mut bytes = Vec::new();
    let read = open(path).and_then(|mut input| input.read_to_end(&mut bytes));
    read.map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => FileError::Missing(path.into()),
        _ => FileError::Read { path: path.into(), source },
    })?;
    Ok(bytes)
}

/// Creates the folder `path` and its parents if they do not exist.
pub fn create_folder(path: &Path) -> Result<(), FileError> {
    if path.as_os_str().is_empty() {
        return Ok(());
    }
    // Creates before checking, since another thread may create the same folder at the same time.
    fs::create_dir_all(path).map_err(|source| match path.exists() {
        true if !path.is_dir() => FileError::NotFolder(path.into()),
        _ => FileError::Write { path: path.into(), source },
    })
}

static INPUTS: OnceLock<Vec<PathBuf>> = OnceLock::new();

/// Names the inputs of this process, which [`write_with`] refuses to replace. Only the first call counts.
pub fn protect(inputs: impl IntoIterator<Item = PathBuf>) {
    let files =
        inputs.into_iter().filter(|input| input.is_file()).filter_map(|input| input.canonicalize().ok());
    // A second call changes nothing.
    let _ = INPUTS.set(files.collect());
}

/// Writes `bytes` to `path`, as [`write_with`] does.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    write_with(path, |out| out.write_all(bytes))
}

/// Lets `fill` write a file that appears under `path` only when it is complete: it is written under a temporary name in
/// the same folder and then renamed. A crash, a full disk or Ctrl-C leaves the old file. Missing parent folders are
/// created. A device or pipe (`/dev/stdout`) is written in place.
pub fn write_with(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<&mut fs::File>) -> io::Result<()>,
) -> Result<(), FileError> {
    let failed = |source: io::Error| match source.downcast::<interrupt::Interrupted>() {
        Ok(interrupted) => interrupted.into(),
        Err(source) => FileError::Write { path: path.into(), source },
    };
    if path.is_dir() {
        return Err(FileError::IsFolder(path.into()));
    }
    // The target of a link is replaced, not the link.
    let target = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    if INPUTS.get().is_some_and(|inputs| inputs.contains(&target)) {
        return Err(FileError::IsInput(path.into()));
    }
    if target.exists() && !target.is_file() {
        let mut file = fs::OpenOptions::new().write(true).open(&target).map_err(failed)?;
        return fill_and_flush(&mut file, fill).map_err(failed);
    }
    let folder = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    create_folder(folder)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".yoro-").suffix(".part");
    #[cfg(unix)]
    {
        // The crate's default is 0600, but an output should have the permissions of any new file.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut part = builder.tempfile_in(folder).map_err(failed)?;
    fill_and_flush(part.as_file_mut(), fill).map_err(failed)?;
    part.persist(&target).map_err(|error| failed(error.error))?;
    Ok(())
}

/// Opens a file for appending, and prevents other processes from doing the same until it is closed. Creates the file
/// and missing parent folders.
pub fn append(path: &Path) -> Result<fs::File, FileError> {
    if path.is_dir() {
        return Err(FileError::IsFolder(path.into()));
    }
    create_folder(path.parent().unwrap_or(Path::new("")))?;
    let failed = |source| FileError::Write { path: path.into(), source };
    let file = fs::OpenOptions::new().append(true).create(true).open(path).map_err(failed)?;
    match file.try_lock() {
        Err(fs::TryLockError::WouldBlock) => Err(FileError::InUse(path.into())),
        // Not every file system has locks.
        Ok(()) | Err(fs::TryLockError::Error(_)) => Ok(file),
    }
}

fn fill_and_flush(
    file: &mut fs::File,
    fill: impl FnOnce(&mut BufWriter<&mut fs::File>) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::new(file);
    fill(&mut out)?;
    out.flush()
}

/// Returns all files below `folder` with one of the `extensions` (lower case, without a dot), as sorted paths relative
/// to it. Links to folders are not followed; hidden files and folders are left out.
pub fn find(folder: &Path, extensions: &[&str]) -> Result<Vec<PathBuf>, FileError> {
    find_wanted(folder, |path| has_extension(path, extensions))
}

/// Returns all files below `folder` whose relative paths are wanted, like [`find`].
pub fn find_wanted(folder: &Path, is_wanted: impl Fn(&Path) -> bool) -> Result<Vec<PathBuf>, FileError> {
    if !folder.exists() {
        return Err(FileError::Missing(folder.into()));
    }
    if !folder.is_dir() {
        return Err(FileError::NotFolder(folder.into()));
    }
    let mut found = Vec::new();
    let mut waiting = vec![PathBuf::new()];
    while let Some(relative) = waiting.pop() {
        let here = folder.join(&relative);
        let failed = |source| FileError::Read { path: here.clone(), source };
        for entry in fs::read_dir(&here).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let name = entry.file_name();
            if name.to_string_lossy().starts_with('.') {
                continue;
            }
            let path = relative.join(&name);
            if entry.file_type().map_err(failed)?.is_dir() {
                waiting.push(path);
            } else if is_wanted(&path) && entry.path().is_file() {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

/// True if the extension of `path`, ignoring case, is one of `extensions` (lower case, without a dot).
pub fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    extension.is_some_and(|e| extensions.contains(&e.as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_no_litter() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("new/out.txt");
        write(&path, b"first").unwrap();
        let error = write_with(&path, |out| {
            out.write_all(b"half")?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        })
        .unwrap_err();
        assert!(
            error.to_string().contains("out.txt") && error.to_string().contains("disk is full"),
            "{error}"
        );
        assert_eq!(read(&path).unwrap(), b"first");
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    #[test]
    fn two_cannot_append_to_one_file() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("new/results.jsonl");
        let mut first = append(&path).unwrap();
        first.write_all(b"1").unwrap();
        assert!(matches!(append(&path), Err(FileError::InUse(_))));
        drop(first);
        append(&path).unwrap().write_all(b"2").unwrap();
        assert_eq!(read(&path).unwrap(), b"12");
        assert!(matches!(append(dir.path()), Err(FileError::IsFolder(_))));
    }

    #[test]
    fn folders_and_missing_files_are_named() {
        let dir = tempfile::tempdir().unwrap();
        assert!(matches!(read(dir.path()), Err(FileError::IsFolder(_))));
        assert!(matches!(write(dir.path(), b""), Err(FileError::IsFolder(_))));
        let missing = dir.path().join("nothing.png");
        assert_eq!(
            read(&missing).unwrap_err().to_string(),
            format!("{} does not exist: check the path", missing.display())
        );
        let file = dir.path().join("file");
        write(&file, b"x").unwrap();
        assert!(matches!(create_folder(&file), Err(FileError::NotFolder(_))));
        assert!(matches!(write(&file.join("below"), b""), Err(FileError::NotFolder(_))));
    }

    #[test]
    fn many_threads_may_create_one_folder() {
        let dir = tempfile::tempdir().unwrap();
        for round in 0..200 {
            let folder = dir.path().join(format!("{round}/a/b"));
            let start = std::sync::Barrier::new(4);
            std::thread::scope(|scope| {
                for _ in 0..4 {
                    scope.spawn(|| {
                        start.wait();
                        create_folder(&folder).unwrap();
                    });
                }
            });
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_devices_stay_and_others_may_read() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let dir = tempfile::tempdir().unwrap();
        let (file, link) = (dir.path().join("file"), dir.path().join("link"));
        write(&file, b"1").unwrap();
        assert_ne!(fs::metadata(&file).unwrap().permissions().mode() & 0o077, 0, "others may read");
        symlink(&file, &link).unwrap();
        write(&link, b"2").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(read(&file).unwrap(), b"2");
        write(Path::new("/dev/null"), b"gone").unwrap();
        assert!(!Path::new("/dev/null").is_file());
    }

    #[test]
    fn finds_by_extension_below_a_folder() {
        let dir = tempfile::tempdir().unwrap();
        for name in ["b.PNG", "a/c.png", "a/d.txt", ".hidden.png"] {
            write(&dir.path().join(name), b"").unwrap();
        }
        let found = find(dir.path(), &["png"]).unwrap();
        assert_eq!(found, [PathBuf::from("a/c.png"), PathBuf::from("b.PNG")]);
        assert!(matches!(find(&dir.path().join("none"), &["png"]), Err(FileError::Missing(_))));
    }
}
