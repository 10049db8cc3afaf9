//! The APK, and the AAR of an API layer. Libraries and assets are read from the built file itself.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use anyhow::{Context, Result, ensure};

/// The parts of an APK that the host uses.
pub struct Apk {
    /// Path in the APK and content of the only library for this ABI.
    pub library: (String, Vec<u8>),
    /// Assets by path, relative to `assets/`.
    pub assets: BTreeMap<String, Vec<u8>>,
}

impl Apk {
    /// Reads the library for `abi` and all assets.
    ///
    /// # Errors
    /// Fails if the file cannot be read, is not an APK, or does not contain exactly one library for the ABI.
    pub fn read(path: &Path, abi: &str) -> Result<Self> {
        let file = File::open(path)
            .with_context(|| format!("cannot open {}: build it by `cargo xtask apk`", path.display()))?;
        Self::read_from(file, &format!("lib/{abi}/"))
            .with_context(|| format!("{} is not an APK that the host can run", path.display()))
    }

    /// Reads an AAR like [`Apk::read`]: the parts that become part of the APK of an application that depends on it.
    ///
    /// # Errors
    /// Those of [`Apk::read`].
    pub fn read_aar(path: &Path, abi: &str) -> Result<Self> {
        const REMEDY: &str = "build it by `cargo xtask package --target android-layer`";
        let file = File::open(path).with_context(|| format!("cannot open {}: {REMEDY}", path.display()))?;
        let mut aar = Self::read_from(file, &format!("jni/{abi}/"))
            .with_context(|| format!("{} is not an AAR that the host can run", path.display()))?;
        aar.library.0.replace_range(..3, "lib");
        Ok(aar)
    }

    /// Reads an archive in which `folder` contains the libraries of the ABI.
    fn read_from(file: impl Read + Seek, folder: &str) -> Result<Self> {
        let mut archive = zip::ZipArchive::new(file)?;
        let mut libraries = Vec::new();
        let mut assets = BTreeMap::new();
        for index in 0..archive.len() {
            let mut entry = archive.by_index(index)?;
            let name = entry.name()?.into_owned();
            let asset = name.strip_prefix("assets/").map(str::to_owned);
            if entry.is_dir() || !(name.starts_with(folder) || asset.is_some()) {
                continue;
            }
            let mut bytes = Vec::new();
            entry.read_to_end(&mut bytes).with_context(|| format!("{name} is damaged"))?;
            match asset {
                Some(asset) => _ = assets.insert(asset, bytes),
                None => libraries.push((name, bytes)),
            }
        }
        ensure!(libraries.len() < 2, "{folder} holds several libraries, and the host loads one");
        let library = libraries.pop().with_context(|| format!("it has no library in {folder}"))?;
        Ok(Self { library, assets })
    }
}
