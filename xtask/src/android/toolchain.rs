//! What the APK is built with: Google's SDK and NDK with rustup's targets, or what stands in for them.

use std::env;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{anyhow, bail};

use super::cargo_apk;
use super::stand_in::FRAMEWORK;
use super::target::{ARCHITECTURES, MIN_API, TARGET_API};
use crate::apt::{self, find_program};

/// What the user has, as far as it decides.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    android_home: Option<PathBuf>,
    ndk_root: Option<PathBuf>,
    /// The user's own Rust.
    rust: Option<Rust>,
}

/// A cargo and its rustc.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rust {
    /// The folder of the programs.
    pub programs: PathBuf,
    sysroot: PathBuf,
    /// Major and minor.
    version: (u32, u32),
}

/// Which of the two ways.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Toolchain {
    /// The user's own SDK, NDK and rustup targets.
    Google {
        /// ANDROID_HOME.
        sdk: PathBuf,
        /// ANDROID_NDK_ROOT.
        ndk: PathBuf,
    },
    /// Debian's packages, and std from source.
    StandIn,
}

/// One thing that is needed, and where it is or how to get it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Need {
    what: &'static str,
    /// Where it is, or what is wrong.
    found: Result<String, String>,
    /// What to do when it is missing.
    remedy: String,
    /// Debian's packages that bring it.
    packages: &'static [&'static str],
}

impl Surroundings {
    /// Of this process.
    pub fn here() -> Self {
        let folder = |name| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        // Cargo names itself to what it runs; behind rustup's proxy that is the real one.
        let cargo = env::var_os("CARGO").map(PathBuf::from).or_else(|| find_program("cargo"));
        let programs = cargo.and_then(|cargo| Some(cargo.parent()?.to_owned()));
        Self {
            android_home: folder("ANDROID_HOME"),
            ndk_root: folder("ANDROID_NDK_ROOT"),
            rust: programs.and_then(Rust::at),
        }
    }

    /// The user wants Google's way.
    pub fn names_google(&self) -> bool {
        self.android_home.is_some() || self.ndk_root.is_some()
    }

    /// The user's NDK.
    pub fn ndk(&self) -> Option<&Path> {
        self.ndk_root.as_deref()
    }

    /// The user's own Rust.
    pub fn rust(&self) -> Option<Rust> {
        self.rust.clone()
    }
}

impl Rust {
    fn at(programs: PathBuf) -> Option<Self> {
        if !programs.join("cargo").is_file() {
            return None;
        }
        let ask = |arguments: &[&str]| {
            let output = Command::new(programs.join("rustc")).args(arguments).output().ok()?;
            output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
        };
        let version = version(&ask(&["--version"])?)?;
        let sysroot = PathBuf::from(ask(&["--print", "sysroot"])?);
        Some(Self { programs, sysroot, version })
    }

    fn has_target(&self, triple: &str) -> bool {
        self.sysroot.join("lib/rustlib").join(triple).join("lib").is_dir()
    }

    fn has_source(&self) -> bool {
        self.sysroot.join("lib/rustlib/src/rust/library/std/Cargo.toml").is_file()
    }

    fn is_new_enough(&self) -> bool {
        version(env!("CARGO_PKG_RUST_VERSION")).is_some_and(|minimum| self.version >= minimum)
    }

    /// A Rust that can compile for `triple`, and whether it has to compile std, too.
    pub fn for_target(surroundings: &Surroundings, triple: &str) -> Option<(Self, bool)> {
        let prebuilt = surroundings.rust.clone().filter(|rust| rust.has_target(triple));
        let prebuilt = prebuilt.map(|rust| (rust, false));
        prebuilt.or_else(|| Some((Self::with_source(surroundings)?, true)))
    }

    /// LLVM's linker for WebAssembly: the one that comes with this Rust or with the user's, else the system's. Debian's
    /// Rust has none of its own.
    pub fn wasm_linker(&self, surroundings: &Surroundings) -> Option<PathBuf> {
        let own = [Some(self), surroundings.rust.as_ref()].into_iter().flatten().find_map(Self::rust_lld);
        own.or_else(|| find_program("wasm-ld"))
    }

    fn rust_lld(&self) -> Option<PathBuf> {
        let hosts = fs::read_dir(self.sysroot.join("lib/rustlib")).ok()?;
        hosts.flatten().map(|host| host.path().join("bin/rust-lld")).find(|file| file.is_file())
    }

    /// A Rust that can compile std for Android: the user's own, where it has std's source, or Debian's.
    pub fn with_source(surroundings: &Surroundings) -> Option<Self> {
        let debian = || Self::at("/usr/bin".into());
        let fits = |rust: &Self| rust.is_new_enough() && rust.has_source();
        surroundings.rust.clone().filter(fits).or_else(|| debian().filter(fits))
    }
}

/// `1.96` of `rustc 1.96.0 (ac68faa20 2026-05-25)`.
fn version(text: &str) -> Option<(u32, u32)> {
    let number = text.split_whitespace().find(|word| word.starts_with(|c: char| c.is_ascii_digit()))?;
    let mut parts = number.split('.');
    Some((parts.next()?.parse().ok()?, parts.next()?.parse().ok()?))
}

impl Toolchain {
    /// The user's own where it is complete. With it the reasons against the other way, one sentence each.
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
            if !surroundings.rust.as_ref().is_some_and(|rust| rust.has_target(target.triple)) {
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

    /// Everything that this way needs.
    pub fn needs(&self, surroundings: &Surroundings) -> Vec<Need> {
        match self {
            Self::Google { sdk, ndk } => google(sdk, ndk),
            Self::StandIn => stand_in(surroundings),
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

fn program(name: &'static str, packages: &'static [&'static str]) -> Need {
    let found = find_program(name).map(|path| path.display().to_string());
    Need {
        what: name,
        found: found.ok_or_else(|| "not in PATH".to_owned()),
        remedy: format!("apt-get install {}", packages.join(" ")),
        packages,
    }
}

fn file(what: &'static str, path: &Path, remedy: &str, packages: &'static [&'static str]) -> Need {
    let shown = path.display();
    Need {
        what,
        found: if path.exists() { Ok(shown.to_string()) } else { Err(format!("{shown} is missing")) },
        remedy: remedy.to_owned(),
        packages,
    }
}

fn google(sdk: &Path, ndk: &Path) -> Vec<Need> {
    let platform = format!("platforms/android-{TARGET_API}/android.jar");
    let mut needs = vec![
        file("platform", &sdk.join(platform), &format!("sdkmanager \"platforms;android-{TARGET_API}\""), &[]),
        file("NDK", &ndk.join("source.properties"), "sdkmanager --install \"ndk;27.2.12479018\"", &[]),
    ];
    for tool in ["aapt", "zipalign", "apksigner"] {
        let path = build_tools(sdk).unwrap_or_else(|| sdk.join("build-tools")).join(tool);
        needs.push(file(tool, &path, "sdkmanager \"build-tools;34.0.0\"", &[]));
    }
    needs.push(program("keytool", &["default-jre-headless"]));
    needs
}

fn stand_in(surroundings: &Surroundings) -> Vec<Need> {
    vec![
        program("clang", &["clang"]),
        program("ld.lld", &["lld"]),
        program("llvm-ar", &["llvm"]),
        program("aapt", &["aapt"]),
        program("zipalign", &["zipalign"]),
        program("apksigner", &["apksigner"]),
        program("keytool", &["default-jre-headless"]),
        file(
            "android.jar",
            Path::new(FRAMEWORK),
            "apt-get install android-framework-res",
            &["android-framework-res"],
        ),
        source(Rust::with_source(surroundings).as_ref()),
    ]
}

/// std's source, which `rust` has.
fn source(rust: Option<&Rust>) -> Need {
    let minimum = env!("CARGO_PKG_RUST_VERSION");
    let found = rust.map(|rust| {
        let (major, minor) = rust.version;
        format!("{} ({major}.{minor})", rust.programs.join("rustc").display())
    });
    Need {
        what: "std's source",
        found: found.ok_or_else(|| format!("no Rust since {minimum} has it")),
        remedy: "apt-get install rustc-web cargo-web rust-web-src (Debian 12 with its security updates), \
                 or rustup component add rust-src"
            .to_owned(),
        packages: &["rustc-web", "cargo-web", "rust-web-src"],
    }
}

/// What a program for another Linux is compiled and linked with.
fn cross(surroundings: &Surroundings, triple: &str) -> Vec<Need> {
    let rust = Rust::for_target(surroundings, triple).map(|(rust, _)| rust);
    vec![program("clang", &["clang"]), program("ld.lld", &["lld"]), source(rust.as_ref())]
}

/// The newest build tools of an SDK, as cargo-apk chooses them.
fn build_tools(sdk: &Path) -> Option<PathBuf> {
    let entries = fs::read_dir(sdk.join("build-tools")).ok()?;
    let names = entries.flatten().filter_map(|entry| entry.file_name().into_string().ok());
    let newest = names.filter(|name| name.starts_with(|c: char| c.is_ascii_digit())).max()?;
    Some(sdk.join("build-tools").join(newest))
}

/// One of the SDK's tools: of the user's SDK, or of the system.
///
/// # Errors
/// When it is nowhere; the remedy is in it.
pub fn build_tool(name: &str) -> anyhow::Result<PathBuf> {
    let sdk = Surroundings::here().android_home;
    let own = sdk.and_then(|sdk| build_tools(&sdk)).map(|tools| tools.join(name));
    match own.filter(|tool| tool.is_file()).or_else(|| find_program(name)) {
        Some(tool) => Ok(tool),
        None => bail!("{name} is missing: `cargo xtask doctor` says how to get it"),
    }
}

/// Installs what the way lacks, after asking unless `yes`.
///
/// # Errors
/// When something is still missing: what, and the remedy.
pub fn ensure(toolchain: &Toolchain, surroundings: &Surroundings, yes: bool) -> anyhow::Result<()> {
    provide(|| toolchain.needs(surroundings), yes).map_err(|error| match toolchain {
        Toolchain::Google { .. } => error,
        Toolchain::StandIn => anyhow!(
            "{error}; or set ANDROID_HOME and ANDROID_NDK_ROOT to Google's SDK and NDK and add rustup's android targets"
        ),
    })
}

/// Installs, without asking, what compiling for another Linux lacks.
///
/// # Errors
/// When something is still missing: what, and the remedy.
pub fn ensure_cross(surroundings: &Surroundings, triple: &str) -> anyhow::Result<()> {
    provide(|| cross(surroundings, triple), true)
}

fn provide(needs: impl Fn() -> Vec<Need>, yes: bool) -> anyhow::Result<()> {
    let missing = || needs().into_iter().filter(|need| need.found.is_err()).collect::<Vec<_>>();
    let at_first = missing();
    let groups: Vec<&[&str]> =
        at_first.iter().map(|need| need.packages).filter(|packages| !packages.is_empty()).collect();
    if !groups.is_empty() && apt::find_program("apt-get").is_some() {
        apt::consent(&groups.concat(), yes)?;
        if let Err(error) = apt::install(&groups) {
            eprintln!("warning: {error:#}");
        }
    }
    let still = missing();
    if still.is_empty() {
        return Ok(());
    }
    let sentences: Vec<String> =
        still.iter().map(|need| format!("{} is missing ({})", need.what, need.remedy)).collect();
    bail!("{}", sentences.join(", "))
}

/// Which way `cargo xtask apk` would go, and what it lacks, as a text; and whether nothing is missing.
///
/// # Errors
/// When the target folder is not known.
pub fn doctor() -> anyhow::Result<(String, bool)> {
    let surroundings = Surroundings::here();
    let (toolchain, against) = Toolchain::choose(&surroundings);
    let mut lines = vec![format!("cargo xtask apk uses {toolchain}")];
    if !against.is_empty() {
        lines.push(format!("  not Google's SDK and NDK, because {}", against.join("; ")));
    }
    lines.push(String::new());
    let needs = toolchain.needs(&surroundings);
    for need in &needs {
        lines.push(match &need.found {
            Ok(path) => format!("  ok       {:14}{path}", need.what),
            Err(problem) => format!("  MISSING  {:14}{problem}: {}", need.what, need.remedy),
        });
    }
    for (what, state) in cargo_apk::extras()? {
        lines.push(format!("  ok       {what:14}{state}"));
    }
    let complete = needs.iter().all(|need| need.found.is_ok());
    lines.push(if complete {
        format!(
            "\neverything is there: cargo xtask apk --release (Android of API level {MIN_API} and later)\n"
        )
    } else {
        "\ncargo xtask apk asks before it installs what is missing (--yes: without asking)\n".to_owned()
    });
    Ok((lines.join("\n"), complete))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rust(sysroot: &Path, version: (u32, u32)) -> Rust {
        Rust { programs: sysroot.join("bin"), sysroot: sysroot.to_owned(), version }
    }

    #[test]
    fn versions_are_read() {
        assert_eq!(
            version("rustc 1.96.0 (ac68faa20 2026-05-25) (built from a source tarball)"),
            Some((1, 96))
        );
        assert_eq!(version("1.95"), Some((1, 95)));
        assert_eq!(version("rustc unknown"), None);
    }

    #[test]
    fn googles_way_needs_all_three() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        let mut surroundings =
            Surroundings { android_home: None, ndk_root: None, rust: Some(rust(at, (1, 95))) };
        let (toolchain, against) = Toolchain::choose(&surroundings);
        assert_eq!(toolchain, Toolchain::StandIn);
        assert_eq!(against.len(), 4, "{against:?}");

        surroundings.android_home = Some(at.to_owned());
        surroundings.ndk_root = Some(at.join("nowhere"));
        for target in ARCHITECTURES {
            fs::create_dir_all(at.join("lib/rustlib").join(target.triple).join("lib")).unwrap();
        }
        let (toolchain, against) = Toolchain::choose(&surroundings);
        assert_eq!(toolchain, Toolchain::StandIn);
        assert_eq!(against.len(), 1, "{against:?}");
        assert!(against[0].starts_with("ANDROID_NDK_ROOT is ") && against[0].contains("nowhere"));

        surroundings.ndk_root = Some(at.to_owned());
        let (toolchain, against) = Toolchain::choose(&surroundings);
        assert_eq!(toolchain, Toolchain::Google { sdk: at.to_owned(), ndk: at.to_owned() });
        assert!(against.is_empty());
    }

    #[test]
    fn an_empty_sdk_lacks_everything_with_its_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        fs::create_dir_all(at.join("build-tools/9.0.0")).unwrap();
        fs::write(at.join("build-tools/9.0.0/aapt"), "").unwrap();
        let needs = google(at, at);
        let state = |what: &str| needs.iter().find(|need| need.what == what).unwrap().found.is_ok();
        assert!(state("aapt"));
        assert!(!state("zipalign") && !state("platform") && !state("NDK"));
        assert!(needs.iter().all(|need| !need.remedy.is_empty()));
    }

    #[test]
    fn std_needs_a_source_and_a_new_rust() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        assert!(!rust(at, (9, 0)).has_source());
        fs::create_dir_all(at.join("lib/rustlib/src/rust/library/std")).unwrap();
        fs::write(at.join("lib/rustlib/src/rust/library/std/Cargo.toml"), "").unwrap();
        assert!(rust(at, (9, 0)).has_source());
        assert!(rust(at, (1, 95)).is_new_enough() && rust(at, (2, 0)).is_new_enough());
        assert!(!rust(at, (1, 85)).is_new_enough());
    }
}
