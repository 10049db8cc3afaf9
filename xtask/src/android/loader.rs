//! OpenXR loaders of others, carried in an APK. They precede the application's own way to the runtime, and support API
//! layers.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};

use crate::ndk::target::LOADER;

/// Copies in the folder that cargo-apk packs, with a subfolder per architecture. They are deleted when this is dropped.
pub struct Loaders(Vec<PathBuf>);

impl Loaders {
    /// Copies each file to the folder of its architecture.
    ///
    /// # Errors
    /// Fails if there are two for one architecture, or one cannot be copied.
    pub fn place(files: &[(String, &Path)], folder: &Path) -> anyhow::Result<Self> {
        let mut placed = Loaders(Vec::new());
        for (abi, file) in files {
            let copy = folder.join(abi).join(LOADER);
            if placed.0.contains(&copy) {
                bail!("{} is the second OpenXR loader for one processor: name one of them", file.display());
            }
            fs::copy(file, &copy).with_context(|| format!("{} cannot be written", copy.display()))?;
            placed.0.push(copy);
        }
        Ok(placed)
    }
}

impl Drop for Loaders {
    fn drop(&mut self) {
        for copy in &self.0 {
            fs::remove_file(copy).ok();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loader_is_there_until_the_apk_is_built() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("arm64-v8a")).unwrap();
        let file = folder.path().join("loader.so");
        fs::write(&file, "").unwrap();
        let copy = folder.path().join("arm64-v8a").join(LOADER);
        let once = ("arm64-v8a".to_owned(), file.as_path());
        let placed = Loaders::place(std::slice::from_ref(&once), folder.path()).unwrap();
        assert!(copy.is_file());
        drop(placed);
        assert!(!copy.exists());
        assert!(Loaders::place(&[once.clone(), once], folder.path()).is_err());
        assert!(!copy.exists());
    }
}
