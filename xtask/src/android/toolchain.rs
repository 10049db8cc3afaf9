//! The toolchain for the APK: Google's SDK and NDK with rustup's targets, or the stand-in.

use std::fmt;
use std::path::{Path, PathBuf};

use anyhow::anyhow;

use crate::apt::{self, Need};
use crate::ndk::sdk;
use crate::ndk::stand_in::FRAMEWORK;
use crate::ndk::target::{ARCHITECTURES, MIN_API, TARGET_API};
use crate::rust::{Rust, source};

use super::build::CARGO_APK;
use super::keystore;

/// The toolchain for the APK.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Toolchain {
    /// The user's own SDK, NDK and rustup targets.
    Google {
        /// The value of ANDROID_HOME.
        sdk: PathBuf,
        /// The value of ANDROID_NDK_ROOT.
        ndk: PathBuf,
    },
    /// Debian packages, and std compiled from source.
    StandIn,
}

impl Toolchain {
    /// Returns the user's own toolchain if it is complete. Also returns the reasons against it, one sentence each.
    pub fn choose() -> (Self, Vec<String>) {
        let rust = Rust::own();
        let has_std = |triple: &str| rust.as_ref().is_some_and(|rust| rust.has_target(triple));
        Self::of(sdk::folder("ANDROID_HOME"), sdk::folder("ANDROID_NDK_ROOT"), has_std)
    }

    fn of(sdk: Option<PathBuf>, ndk: Option<PathBuf>, has_std: impl Fn(&str) -> bool) -> (Self, Vec<String>) {
        let mut against = Vec::new();
        for (name, value) in [("ANDROID_HOME", &sdk), ("ANDROID_NDK_ROOT", &ndk)] {
            match value {
                None => against.push(format!("{name} is not set")),
                Some(path) if path.is_dir() => {}
                Some(path) => against.push(format!("{name} is {}, which is no folder", path.display())),
            }
        }
        for triple in ARCHITECTURES.map(|target| target.triple).iter().filter(|triple| !has_std(triple)) {
            against.push(format!("Rust has no std for {triple} (rustup target add {triple})"));
        }
        match (sdk, ndk) {
            (Some(sdk), Some(ndk)) if against.is_empty() => (Self::Google { sdk, ndk }, against),
            _ => (Self::StandIn, against),
        }
    }

    /// Returns what this toolchain needs.
    pub fn needs(&self) -> Vec<Need> {
        match self {
            Self::Google { sdk, ndk } => google(sdk, ndk),
            Self::StandIn => stand_in(),
        }
    }
}

impl fmt::Display for Toolchain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Google { .. } => "Google's SDK and NDK",
            Self::StandIn => "the stand-in SDK and NDK made of Debian's packages, and std from source",
        })
    }
}

fn google(sdk: &Path, ndk: &Path) -> Vec<Need> {
    let platform = format!("platforms/android-{TARGET_API}/android.jar");
    let mut needs = vec![
        Need::file(
            "platform",
            &sdk.join(platform),
            &format!("sdkmanager \"platforms;android-{TARGET_API}\""),
            &[],
        ),
        Need::file("NDK", &ndk.join("source.properties"), "sdkmanager --install \"ndk;27.2.12479018\"", &[]),
    ];
    needs.extend(check_tools());
    needs
}

/// Returns the tools that pack, sign and check an APK.
pub fn check_tools() -> Vec<Need> {
    let tool = |name: &'static str, packages: &'static [&'static str]| {
        let mut need = Need::program(name, packages);
        if let Ok(path) = sdk::build_tool(name) {
            need.found = Ok(path.display().to_string());
        }
        need.remedy = format!("{}, or sdkmanager \"build-tools;34.0.0\"", need.remedy);
        need
    };
    vec![
        tool("aapt", &["aapt"]),
        tool("aapt2", &["aapt"]),
        tool("zipalign", &["zipalign"]),
        tool("apksigner", &["apksigner"]),
        Need::program("keytool", &["default-jre-headless"]),
    ]
}

fn stand_in() -> Vec<Need> {
    let mut needs = vec![
        Need::program("clang", &["clang"]),
        Need::program("ld.lld", &["lld"]),
        Need::program("llvm-ar", &["llvm"]),
        Need::file(
            "android.jar",
            Path::new(FRAMEWORK),
            "apt-get install android-framework-res",
            &["android-framework-res"],
        ),
        source(Rust::with_source().as_ref()),
    ];
    needs.extend(check_tools());
    needs
}

/// Installs what the toolchain needs. Asks first unless `yes`.
pub fn ensure(toolchain: &Toolchain, yes: bool) -> anyhow::Result<()> {
    apt::install_missing(|| toolchain.needs(), yes).map_err(|error| match toolchain {
        Toolchain::Google { .. } => error,
        Toolchain::StandIn => anyhow!(
            "{error}; or set ANDROID_HOME and ANDROID_NDK_ROOT to Google's SDK and NDK and add rustup's android targets"
        ),
    })
}

/// Describes the toolchain of `cargo xtask apk` and what it lacks. Returns the text, and true if nothing is missing.
pub fn doctor() -> (String, bool) {
    let (toolchain, against) = Toolchain::choose();
    let mut lines = vec![format!("cargo xtask apk uses {toolchain}")];
    if !against.is_empty() {
        lines.push(format!("  not Google's SDK and NDK, because {}", against.join("; ")));
    }
    lines.push(String::new());
    let needs = toolchain.needs();
    for need in &needs {
        lines.push(match &need.found {
            Ok(path) => format!("  ok       {:14}{path}", need.what),
            Err(problem) => format!("  MISSING  {:14}{problem}: {}", need.what, need.remedy),
        });
    }
    lines.push(format!("  ok       cargo-apk     {CARGO_APK}, installed by the first build"));
    lines.push(format!("  ok       release key   {}", keystore::describe()));
    let complete = needs.iter().all(|need| need.found.is_ok());
    lines.push(if complete {
        format!(
            "\neverything is there: cargo xtask apk --release (Android of API level {MIN_API} and later)\n"
        )
    } else {
        "\ncargo xtask apk asks before it installs what is missing (--yes: without asking)\n".to_owned()
    });
    (lines.join("\n"), complete)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn googles_way_needs_all_three() {
        let folder = tempfile::tempdir().unwrap();
        let at = || Some(folder.path().to_owned());
        let (toolchain, against) = Toolchain::of(None, None, |_| false);
        assert_eq!((toolchain, against.len()), (Toolchain::StandIn, 4), "{against:?}");
        let (toolchain, against) = Toolchain::of(at(), Some(folder.path().join("nowhere")), |_| true);
        assert_eq!((toolchain, against.len()), (Toolchain::StandIn, 1), "{against:?}");
        assert!(against[0].starts_with("ANDROID_NDK_ROOT is ") && against[0].contains("nowhere"));
        let (toolchain, against) = Toolchain::of(at(), at(), |_| true);
        assert!(matches!(toolchain, Toolchain::Google { .. }) && against.is_empty());
    }
}
