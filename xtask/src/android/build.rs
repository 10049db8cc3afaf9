//! Builds the APK with cargo-apk, then repacks it with the completed manifest.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context as _, bail};

use crate::folders::{copy, root, target_folder};
use crate::ndk::sdk;
use crate::ndk::stand_in::StandIn;
use crate::ndk::target::{ARCHITECTURES, LOADER, PAGE, TARGET_API};
use crate::rust::{Panic, Rust, anonymous_paths, build_std};
use crate::{cargo, notices};

use super::check::{self, Store};
use super::keystore::Keystore;
use super::pack::{Variant, pack, sign};
use super::toolchain::{self, Toolchain};

/// `apk_name` of android/Cargo.toml.
const NAME: &str = "yoro";
/// The version of cargo-apk, which builds the application.
pub const CARGO_APK: &str = "0.10.0";

/// Build, sign and check the Android application
#[derive(clap::Args, Clone, Debug, Default)]
pub struct Options {
    /// Build a small and fast release instead of a debuggable build
    #[arg(long)]
    pub release: bool,
    /// Install missing packages (apt) without asking
    #[arg(long)]
    pub yes: bool,
    /// Pack this libopenxr_loader.so into the APK; at most one for each processor
    #[arg(long = "openxr-loader", value_name = "FILE")]
    pub openxr_loaders: Vec<PathBuf>,
    /// Make an application bundle (.aab) for a store, too
    #[arg(long)]
    pub bundle: bool,
    /// Pack an APK for Meta's store, too
    #[arg(long)]
    pub quest: bool,
    /// Compile faster, for tests: the same code, but not optimized as a whole, and in another folder.
    #[arg(skip)]
    pub quick: bool,
}

/// Arguments of apksigner for a bundle, signed as a JAR. Given the API level, apksigner needs no manifest.
const JAR: &str = "--min-sdk-version 29 --v1-signing-enabled true --v2-signing-enabled false --v3-signing-enabled false \
                   --v4-signing-enabled false";

/// Builds, signs and checks the APK, and returns its path.
pub fn apk(options: &Options) -> anyhow::Result<PathBuf> {
    let start = Instant::now();
    let loaders = options.openxr_loaders.iter().map(|file| Ok((check::loader_abi(file)?, file.as_path())));
    let _loaders = Loaders::place(loaders, &root().join("android/runtime-libs"))?;
    let (toolchain, against) = Toolchain::choose();
    eprintln!("building with {toolchain}");
    let names_google = ["ANDROID_HOME", "ANDROID_NDK_ROOT"].iter().any(|name| sdk::folder(name).is_some());
    if names_google && !against.is_empty() {
        eprintln!("warning: Google's SDK and NDK are not used: {}", against.join("; "));
    }
    toolchain::ensure(&toolchain, options.yes)?;
    let target = target_folder()?;
    let cargo_apk = cargo::install("cargo-apk", CARGO_APK)?;
    let keystore = Keystore::choose(options.release)?;

    let (profile, name) = if options.release { ("android", "ANDROID") } else { ("dev", "DEV") };
    let build = target.join(if options.quick { "android/quick" } else { "android/build" });
    let mut command = Command::new(cargo_apk);
    command
        .args(["apk", "build", "--package", "yoro-android", "--lib", "--profile", profile])
        .current_dir(root())
        .env("CARGO_TARGET_DIR", &build)
        .env(format!("CARGO_APK_{name}_KEYSTORE"), &keystore.path)
        .env(format!("CARGO_APK_{name}_KEYSTORE_PASSWORD"), &keystore.password)
        // std from source is built without unwinding, since the stand-in NDK has no unwinder.
        .env("CARGO_PROFILE_DEV_PANIC", "abort")
        // These flags are for this machine's processor.
        .env_remove("RUSTFLAGS");
    if options.quick {
        command.envs([("CARGO_PROFILE_ANDROID_LTO", "off"), ("CARGO_PROFILE_ANDROID_OPT_LEVEL", "2")]);
    }
    let mut flags = link_flags();
    let (sdk_folder, rust) = match &toolchain {
        Toolchain::Google { sdk, .. } => (sdk.clone(), Rust::own()),
        Toolchain::StandIn => {
            let stand_in = StandIn::make(&target.join("android/stand-in"))?;
            flags.extend(stand_in.link_arguments().map(|argument| format!("-Clink-arg={argument}")));
            command.env("ANDROID_HOME", &stand_in.sdk).env("ANDROID_NDK_ROOT", &stand_in.ndk);
            build_std(&mut command, Panic::Abort);
            (stand_in.sdk, Rust::with_source())
        }
    };
    let rust = rust.context("no Rust can be found: put cargo and rustc into PATH")?;
    rust.use_in(&mut command)?;
    command.env("CARGO_ENCODED_RUSTFLAGS", flags.join("\u{1f}"));
    run(&mut command)?;

    let folder = if options.release { "android" } else { "debug" };
    let folder = build.join(folder).join("apk");
    let android_jar = sdk_folder.join(format!("platforms/android-{TARGET_API}/android.jar"));
    let notices = notices::text("yoro-android", ARCHITECTURES[0].triple, &[])?;
    let kind = match (options.quick, options.release) {
        (true, _) => "-quick",
        (false, true) => "",
        (false, false) => "-debug",
    };
    let packed = |variant: Variant, suffix: &str| {
        let resources = root().join("android/res");
        let built = pack(variant, &folder, NAME, &android_jar, &resources, &notices, &keystore)?;
        let apk = target.join("apk").join(format!("{NAME}{suffix}{kind}.apk"));
        copy(&built, &apk)?;
        println!("{}", apk.display());
        anyhow::Ok(apk)
    };
    let mut apart_from = Vec::new();
    if keystore.debug {
        apart_from.push("any-key");
    }
    if options.quick {
        apart_from.push("any-size");
    }
    let apart_from = &apart_from[..];
    let mut passed = true;
    if options.quest {
        passed &= check::check(&packed(Variant::Quest, "-quest")?, Some(Store::Quest), apart_from)?;
    }
    let apk = packed(Variant::All, "")?;
    passed &= check::check(&apk, None, apart_from)?;
    if options.bundle {
        let bundle = apk.with_extension("aab");
        check::bundle(&apk, &bundle)?;
        sign(&bundle, &keystore, &JAR.split_whitespace().collect::<Vec<_>>())?;
        println!("{}", bundle.display());
        passed &= check::check(&bundle, Some(Store::Play), apart_from)?;
    }
    if options.release && keystore.debug {
        println!(
            "signed with this machine's debug key, because CARGO_APK_RELEASE_KEYSTORE is not set: good for \
             `adb install`, not for a store"
        );
    }
    if !passed {
        bail!("{} is not as it should be: see FAIL above", apk.display());
    }
    println!("{} in {:.0} s", apk.display(), start.elapsed().as_secs_f64());
    Ok(apk)
}

/// Installs, without asking, what is needed to build the APK.
pub fn ready_for_tests() -> anyhow::Result<PathBuf> {
    let (toolchain, _) = Toolchain::choose();
    toolchain::ensure(&toolchain, true)?;
    Ok(PathBuf::new())
}

/// Builds the APKs for tests.
pub fn apk_for_tests() -> anyhow::Result<PathBuf> {
    apk(&Options { release: true, yes: true, quest: true, quick: true, ..Options::default() })
}

/// OpenXR loaders of others in the folder that cargo-apk packs, with a subfolder per architecture. They precede the
/// application's own way to the runtime, and support API layers. They are deleted when this is dropped.
struct Loaders(Vec<PathBuf>);

impl Loaders {
    /// Copies each file to the folder of its architecture, of which each has one at most.
    fn place<'a>(
        files: impl Iterator<Item = anyhow::Result<(String, &'a Path)>>,
        folder: &Path,
    ) -> anyhow::Result<Self> {
        let mut placed = Loaders(Vec::new());
        for file in files {
            let (abi, file) = file?;
            let place = folder.join(abi).join(LOADER);
            if placed.0.contains(&place) {
                bail!("{} is the second OpenXR loader for one processor: name one of them", file.display());
            }
            copy(file, &place)?;
            placed.0.push(place);
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

/// Returns the linker flags for any NDK: pages of 16 KiB, and an error for symbols that no public library has.
pub fn link_flags() -> Vec<String> {
    let pages = format!("-Wl,-z,max-page-size={PAGE},-z,common-page-size={PAGE}");
    let mut flags: Vec<String> = [pages.as_str(), "-Wl,-z,defs", "-Wl,--build-id=sha1"]
        .map(|flag| format!("-Clink-arg={flag}"))
        .into();
    flags.extend(anonymous_paths());
    flags
}

/// Runs cargo-apk. Shows its output only on failure, since zipalign lists every file.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loader_is_there_until_the_apk_is_built() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("loader.so");
        fs::write(&file, "").unwrap();
        let copy = folder.path().join("arm64-v8a").join(LOADER);
        let place = |count| {
            let once = (0..count).map(|_| Ok(("arm64-v8a".to_owned(), file.as_path())));
            Loaders::place(once, folder.path())
        };
        let placed = place(1).unwrap();
        assert!(copy.is_file());
        drop(placed);
        assert!(!copy.exists());
        assert!(place(2).is_err() && !copy.exists());
    }
}
