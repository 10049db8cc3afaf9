//! The key that an APK is signed with.

use std::env;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context as _, bail};

/// The variable that names the release's keystore; with `_PASSWORD` at its end, the password's.
const RELEASE: &str = "CARGO_APK_RELEASE_KEYSTORE";

/// A keystore with one key, and its password.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Keystore {
    /// The file.
    pub path: PathBuf,
    /// Of the keystore and of the key.
    pub password: String,
    /// Made for development: Android accepts it, stores do not.
    pub debug: bool,
}

impl Keystore {
    /// The keystore of the environment for a release that has one there, and otherwise this machine's debug key,
    /// which is made when there is none yet.
    ///
    /// # Errors
    /// When the environment is incomplete or names no file, or keytool fails.
    pub fn choose(release: bool) -> anyhow::Result<Self> {
        let password = format!("{RELEASE}_PASSWORD");
        match (env::var_os(RELEASE), env::var(&password)) {
            (Some(path), Ok(password)) if release => Self::given(path.into(), password),
            (Some(_), Err(_)) if release => {
                bail!("{RELEASE} is set, but not {password}: set both or neither")
            }
            _ => Self::debug(),
        }
    }

    fn given(path: PathBuf, password: String) -> anyhow::Result<Self> {
        // cargo-apk and apksigner run in other folders.
        let path = path
            .canonicalize()
            .with_context(|| format!("{}, which {RELEASE} names, cannot be opened", path.display()))?;
        Ok(Self { path, password, debug: false })
    }

    /// The key that all of Android's tools share, so that an application built by any of them updates the others'.
    fn debug() -> anyhow::Result<Self> {
        let folder = match env::var_os("ANDROID_USER_HOME") {
            Some(folder) => PathBuf::from(folder),
            None => env::home_dir()
                .context("there is no home folder for the debug key: set HOME")?
                .join(".android"),
        };
        let path = folder.join("debug.keystore");
        let keystore = Self { path, password: "android".to_owned(), debug: true };
        if !keystore.path.exists() {
            std::fs::create_dir_all(&folder)
                .with_context(|| format!("{} cannot be made", folder.display()))?;
            keystore.generate()?;
        }
        Ok(keystore)
    }

    fn generate(&self) -> anyhow::Result<()> {
        eprintln!("making a debug key: {}", self.path.display());
        let output = Command::new("keytool")
            .args(["-genkeypair", "-alias", "androiddebugkey", "-keyalg", "RSA", "-keysize", "2048"])
            .args(["-validity", "10000", "-dname", "CN=Android Debug,O=Android,C=US"])
            .args(["-storepass", &self.password, "-keypass", &self.password, "-keystore"])
            .arg(&self.path)
            .output()
            .context("keytool cannot be started: install a Java runtime (default-jre-headless)")?;
        if !output.status.success() {
            bail!("keytool cannot make a debug key: {}", String::from_utf8_lossy(&output.stdout).trim());
        }
        Ok(())
    }
}
