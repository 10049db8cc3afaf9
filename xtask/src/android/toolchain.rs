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

/// The facts about the user's machine that decide which toolchain is used.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    android_home: Option<PathBuf>,
    ndk_root: Option<PathBuf>,
    /// The targets that the user's Rust has std for, as [`crate::ndk::target::Architecture::triple`].
    targets: Vec<&'static str>,
}

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

impl Surroundings {
    /// Reads the facts from this process's environment.
    pub fn here() -> Self {
        let rust = Rust::own();
        let has = |triple: &&str| rust.as_ref().is_some_and(|rust| rust.has_target(triple));
        Self {
            android_home: sdk::folder("ANDROID_HOME"),
            ndk_root: sdk::folder("ANDROID_NDK_ROOT"),
            targets: ARCHITECTURES.map(|architecture| architecture.triple).into_iter().filter(has).collect(),
        }
    }

    /// True if the environment names Google's SDK or NDK.
    pub fn names_google(&self) -> bool {
        self.android_home.is_some() || self.ndk_root.is_some()
    }
}

impl Toolchain {
    /// Chooses the user's own toolchain if it is complete. Also returns the reasons against it, one sentence each.
    pub fn choose(surroundings: &Surroundings) -> (Self, Vec<String>) {
        let mut against = Vec::new();
        let mut folder = |name: &str, value: &Option<PathBuf>| match value {
            None => against.push(format!("{name} is not set")),
            Some(path) if !path.is_dir() => {
                against.push(format!("{name} is {}, which is no folder", path.display()));
            }
            Some(_) => {}
        };
        folder("ANDROID_HOME", &surroundings.android_home);
        folder("ANDROID_NDK_ROOT", &surroundings.ndk_root);
        for target in ARCHITECTURES {
            if !surroundings.targets.contains(&target.triple) {
                against.push(format!("Rust has no std for {0} (rustup target add {0})", target.triple));
            }
        }
        match (&surroundings.android_home, &surroundings.ndk_root) {
            (Some(sdk), Some(ndk)) if against.is_empty() => {
                (Self::Google { sdk: sdk.clone(), ndk: ndk.clone() }, against)
            }
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
        Need::file("android.jar", Path::new(FRAMEWORK), "apt-get install android-framework-res", &["android-framework-res"]),
        source(Rust::with_source().as_ref()),
    ];
    needs.extend(check_tools());
    needs
}

/// Installs what the toolchain needs. Asks first unless `yes`.
///
/// # Errors
/// Fails if something is still missing; the error names it and the remedy.
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
    let surroundings = Surroundings::here();
    let (toolchain, against) = Toolchain::choose(&surroundings);
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
        let at = folder.path();
        let mut surroundings = Surroundings::default();
        let (toolchain, against) = Toolchain::choose(&surroundings);
        assert_eq!((toolchain, against.len()), (Toolchain::StandIn, 4), "{against:?}");

        surroundings.targets = ARCHITECTURES.map(|architecture| architecture.triple).to_vec();
        surroundings.android_home = Some(at.to_owned());
        surroundings.ndk_root = Some(at.join("nowhere"));
        let (toolchain, against) = Toolchain::choose(&surroundings);
        assert_eq!((toolchain, against.len()), (Toolchain::StandIn, 1), "{against:?}");
        assert!(against[0].starts_with("ANDROID_NDK_ROOT is ") && against[0].contains("nowhere"));

        surroundings.ndk_root = Some(at.to_owned());
        let (toolchain, against) = Toolchain::choose(&surroundings);
        assert_eq!(toolchain, Toolchain::Google { sdk: at.to_owned(), ndk: at.to_owned() });
        assert!(against.is_empty());
    }
}
