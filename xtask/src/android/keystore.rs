//! The key that signs an APK.

use std::env;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context as _, bail};

use crate::console;
use crate::folders::make;

/// The variable with the path of the release keystore. Its password is in the variable with `_PASSWORD` appended.
const RELEASE: &str = "CARGO_APK_RELEASE_KEYSTORE";

/// Describes the key that would sign a release.
pub fn describe() -> String {
    match env::var_os(RELEASE) {
        Some(path) => format!("{} ({RELEASE})", PathBuf::from(path).display()),
        None => format!("this machine's debug key: {RELEASE} is not set"),
    }
}

/// A keystore with one key, and its password.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Keystore {
    /// The file.
    pub path: PathBuf,
    /// The password of both the keystore and the key.
    pub password: String,
    /// True if the key was made for development. Android accepts it, stores do not.
    pub debug: bool,
}

impl Keystore {
    /// Returns the keystore in the environment if this is a release and there is one. Otherwise returns this machine's
    /// debug keystore, which is made if it does not exist.
    pub fn choose(release: bool) -> anyhow::Result<Self> {
        if !release {
            return Self::debug();
        }
        let Some(path) = env::var_os(RELEASE).map(PathBuf::from) else { return Self::debug() };
        let Ok(password) = env::var(format!("{RELEASE}_PASSWORD")) else {
            bail!("{RELEASE} is set, but not {RELEASE}_PASSWORD: set both or neither");
        };
        // cargo-apk and apksigner run in other folders.
        let path = path
            .canonicalize()
            .with_context(|| format!("{}, which {RELEASE} names, cannot be opened", path.display()))?;
        Ok(Self { path, password, debug: false })
    }

    /// Returns the keystore that all Android tools share, so that one's application can be updated by another's.
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
            make(&folder)?;
            keystore.generate()?;
        }
        Ok(keystore)
    }

    fn generate(&self) -> anyhow::Result<()> {
        eprintln!("making a debug key: {}", self.path.display());
        let mut keytool = Command::new("keytool");
        keytool
            .args(["-genkeypair", "-alias", "androiddebugkey", "-keyalg", "RSA", "-keysize", "2048"])
            .args(["-validity", "10000", "-dname", "CN=Android Debug,O=Android,C=US"])
            .args(["-storepass", &self.password, "-keypass", &self.password, "-keystore"])
            .arg(&self.path);
        console::run(&mut keytool).map(drop)
    }
}
