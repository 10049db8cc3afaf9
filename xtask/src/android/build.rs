//! Building the APK by cargo-apk.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context as _, bail};

use super::keystore::{self, Keystore};
use super::loader::Loaders;
use super::stand_in::StandIn;
use super::toolchain::{self, Rust, Surroundings, Toolchain};
use super::{PAGE, check, target_folder};
use crate::cargo::Equipped;

const CARGO_APK: &str = "0.10.0";
/// `apk_name` of android/Cargo.toml.
const NAME: &str = "yoro";

/// How to build.
#[derive(Clone, Debug)]
pub struct Options {
    /// Small and fast, by the profile `android`, instead of debuggable.
    pub release: bool,
    /// Install missing packages without asking.
    pub yes: bool,
    /// OpenXR loaders that the APK is to carry: at most one for each processor.
    pub openxr_loaders: Vec<PathBuf>,
}

/// Builds, signs and checks the APK; where it is.
///
/// # Errors
/// When something is missing or fails, or the result is not as it should be.
pub fn apk(options: &Options) -> anyhow::Result<PathBuf> {
    let start = Instant::now();
    let surroundings = Surroundings::here();
    let _loaders = Loaders::place(&options.openxr_loaders, &root().join("android/runtime-libs"))?;
    let (toolchain, against) = Toolchain::choose(&surroundings);
    eprintln!("building with {toolchain}");
    if surroundings.names_google() && !against.is_empty() {
        eprintln!("warning: Google's SDK and NDK are not used: {}", against.join("; "));
    }
    toolchain::ensure(&toolchain, &surroundings, options.yes)?;
    let target = target_folder()?;
    let cargo_apk = cargo_apk(&target.join("tools"))?;
    let keystore = Keystore::choose(options.release)?;

    let (profile, name) = if options.release { ("android", "ANDROID") } else { ("dev", "DEV") };
    let mut command = Command::new(cargo_apk);
    command
        .args(["apk", "build", "--package", "yoro-android", "--lib", "--profile", profile])
        .current_dir(root())
        .env("CARGO_TARGET_DIR", target.join("android/build"))
        .env(format!("CARGO_APK_{name}_KEYSTORE"), &keystore.path)
        .env(format!("CARGO_APK_{name}_KEYSTORE_PASSWORD"), &keystore.password)
        // std from source cannot unwind: the stand-in NDK has no unwinder.
        .env("CARGO_PROFILE_DEV_PANIC", "abort")
        // Flags for the desktop's processor are of no use here.
        .env_remove("RUSTFLAGS");
    let mut flags = link_flags();
    let rust = match &toolchain {
        Toolchain::Google { .. } => surroundings.rust(),
        Toolchain::StandIn => {
            let stand_in = StandIn::make(&target.join("android/stand-in"))?;
            flags.extend(stand_in.link_arguments().map(|argument| format!("-Clink-arg={argument}")));
            command.env("ANDROID_HOME", &stand_in.sdk).env("ANDROID_NDK_ROOT", &stand_in.ndk);
            build_std(&mut command);
            Rust::with_source(&surroundings)
        }
    };
    let rust = rust.context("no Rust can be found: put cargo and rustc into PATH")?;
    use_rust(&mut command, &rust)?;
    command.env("CARGO_ENCODED_RUSTFLAGS", flags.join("\u{1f}"));
    run(&mut command)?;

    let folder = if options.release { "android" } else { "debug" };
    let built = target.join("android/build").join(folder).join("apk").join(format!("{NAME}.apk"));
    let apk = target.join("apk").join(format!("{NAME}{}.apk", if options.release { "" } else { "-debug" }));
    publish(&built, &apk)?;

    let report = check::check(&apk)?;
    print!("{report}");
    if options.release && keystore.debug {
        println!(
            "signed with this machine's debug key, because CARGO_APK_RELEASE_KEYSTORE is not set: good for \
             `adb install`, not for a store"
        );
    }
    if !report.passed() {
        bail!("{} is not as it should be: see FAIL above", apk.display());
    }
    println!("{} in {:.0} s", apk.display(), start.elapsed().as_secs_f64());
    Ok(apk)
}

/// The release APK for the tests. What it needs is installed without asking, as for all tests.
///
/// # Errors
/// When it cannot be built although everything is there.
pub fn for_tests() -> anyhow::Result<Equipped> {
    let surroundings = Surroundings::here();
    let (toolchain, _) = Toolchain::choose(&surroundings);
    if let Err(error) = toolchain::ensure(&toolchain, &surroundings, true) {
        eprintln!("warning: the APK cannot be built here, so that its tests are left out: {error:#}");
        return Ok(Equipped::Missing);
    }
    Ok(Equipped::At(apk(&Options { release: true, yes: true, openxr_loaders: Vec::new() })?))
}

/// The workspace's folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// cargo-apk of the one version that this works with, in the project's own folder.
fn cargo_apk(folder: &Path) -> anyhow::Result<PathBuf> {
    let program = folder.join("bin/cargo-apk");
    if is_cargo_apk(&program) {
        return Ok(program);
    }
    // It only starts other programs: optimising it would take longer than it saves.
    let mut install = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    install
        .args(["install", "cargo-apk", "--version", CARGO_APK, "--locked", "--debug", "--force", "--quiet"])
        .args(["--no-track", "--root"])
        .arg(folder)
        // The target folder of the workspace keeps what only the APK needs out.
        .env_remove("CARGO_TARGET_DIR");
    eprintln!("$ cargo install cargo-apk --version {CARGO_APK} --locked --root {}", folder.display());
    let status = install.status().context("cargo cannot be started")?;
    if !status.success() {
        bail!("cargo-apk {CARGO_APK} cannot be installed: see above");
    }
    Ok(program)
}

fn is_cargo_apk(program: &Path) -> bool {
    let version = Command::new(program).args(["apk", "version"]).output();
    let wanted = format!("cargo-apk {CARGO_APK}");
    version.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).trim() == wanted)
}

/// What the building brings along by itself, for people: cargo-apk and the key.
///
/// # Errors
/// When the target folder is not known.
pub fn extras() -> anyhow::Result<[(&'static str, String); 2]> {
    let program = target_folder()?.join("tools/bin/cargo-apk");
    let tool = if is_cargo_apk(&program) {
        program.display().to_string()
    } else {
        format!("version {CARGO_APK} will be installed: {}", program.display())
    };
    Ok([("cargo-apk", tool), ("release key", keystore::describe())])
}

/// What is asked of the linker with any NDK: pages of 16 KiB, and no name that a public library does not have.
fn link_flags() -> Vec<String> {
    let pages = format!("-Wl,-z,max-page-size={PAGE},-z,common-page-size={PAGE}");
    let mut flags: Vec<String> = [pages.as_str(), "-Wl,-z,defs", "-Wl,--build-id=sha1"]
        .map(|flag| format!("-Clink-arg={flag}"))
        .into();
    // Panics name source files: the builder's folders are nobody's concern.
    let cargo_home = env::var_os("CARGO_HOME")
        .map(PathBuf::from)
        .or_else(|| env::home_dir().map(|home| home.join(".cargo")));
    if let Some(home) = cargo_home {
        flags.push(format!("--remap-path-prefix={}=cargo", home.display()));
    }
    flags
}

/// Cargo's subcommands take the first cargo in PATH. What the cargo that started this program has set for its own must not
/// reach it.
///
/// # Errors
/// When PATH cannot be extended.
pub fn use_rust(command: &mut Command, rust: &Rust) -> anyhow::Result<()> {
    let mut path = OsString::from(&rust.programs);
    if let Some(rest) = env::var_os("PATH") {
        path = env::join_paths([rust.programs.clone()].into_iter().chain(env::split_paths(&rest)))
            .context("PATH holds a folder with a colon in its name")?;
    }
    command.env("PATH", path).env("RUSTC", rust.programs.join("rustc"));
    for variable in ["CARGO", "RUSTDOC", "RUSTUP_TOOLCHAIN", "LD_LIBRARY_PATH"] {
        command.env_remove(variable);
    }
    Ok(())
}

/// Has cargo compile std from its source.
pub fn build_std(command: &mut Command) {
    command
        .env("RUSTC_BOOTSTRAP", "1")
        .env("CARGO_UNSTABLE_BUILD_STD", "std,panic_abort")
        // Without backtraces: there are no symbols to show.
        .env("CARGO_UNSTABLE_BUILD_STD_FEATURES", "");
}

/// zipalign lists every file: that is shown only when something fails.
fn run(command: &mut Command) -> anyhow::Result<()> {
    eprintln!(
        "$ cargo apk {}",
        command.get_args().skip(1).map(|a| a.to_string_lossy()).collect::<Vec<_>>().join(" ")
    );
    let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn();
    let output =
        child.and_then(std::process::Child::wait_with_output).context("cargo-apk cannot be started")?;
    if !output.status.success() {
        eprint!("{}", String::from_utf8_lossy(&output.stdout));
        bail!("cargo-apk failed: see above");
    }
    Ok(())
}

/// Puts the finished file where it is looked for; what was there stays until then.
fn publish(built: &Path, apk: &Path) -> anyhow::Result<()> {
    let unfinished = apk.with_extension("apk.tmp");
    if let Some(folder) = apk.parent() {
        fs::create_dir_all(folder).with_context(|| format!("{} cannot be made", folder.display()))?;
    }
    fs::copy(built, &unfinished).with_context(|| format!("{} cannot be copied", built.display()))?;
    fs::rename(&unfinished, apk).with_context(|| format!("{} cannot be written", apk.display()))
}
