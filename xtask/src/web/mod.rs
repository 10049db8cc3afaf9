//! The page: `app/vr/web` compiled for browsers and its other files, for any static host.

mod npm;
mod serve;
mod site;
mod three;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use anyhow::{Context as _, bail, ensure};

use crate::apt::Need;
use crate::folders::{copy, remove, root, target_folder, write};
use crate::rust::{Panic, Rust, anonymous_paths, build_std, source};
use crate::{apt, cargo, console, notices};

pub use npm::{check_types, emulator, npm, three as three_modules};
pub use serve::serve;
pub use site::publish;

/// Rust's name for the target.
pub const TRIPLE: &str = "wasm32-unknown-unknown";
/// The example of yoro-wgpu.
const EXAMPLE: &str = "offscreen";
/// Cargo's profile of what is published.
const PUBLISHED: &str = "web";
/// The profile of what is built for tests, in two thirds of the time.
pub const TESTED: &str = "web-test";
/// Maximum number of bytes transferred by a first visit, since phones load the page over mobile networks.
const BUDGET: u64 = 1_200_000;

/// Returns the folder of the page or, with `wgpu`, of the example of yoro-wgpu. Builds it unless it is taken `as_built`.
pub fn folder(wgpu: bool, as_built: bool) -> anyhow::Result<PathBuf> {
    if !as_built {
        return if wgpu { build_example(PUBLISHED) } else { build() };
    }
    let folder = target_folder()?.join(if wgpu { "web-wgpu" } else { "web" });
    ensure!(folder.join("index.html").is_file(), "{} has no page: build it", folder.display());
    Ok(folder)
}

/// Builds the example of yoro-wgpu for browsers with WebGPU, and returns its folder, `target/web-wgpu`.
pub fn build_example(profile: &str) -> anyhow::Result<PathBuf> {
    let start = Instant::now();
    let what = ["--package", "yoro-wgpu", "--example", EXAMPLE];
    let module = compile(&what, &format!("examples/{EXAMPLE}"), profile)?;
    let page = root().join("app/engines/wgpu/examples").join(EXAMPLE);
    let folder = target_folder()?.join("web-wgpu");
    remove(&folder)?;
    let Sizes { transferred, .. } = bind(&module, &folder, &page)?;
    for name in ["page.js", "index.html"] {
        copy(&page.join(name), &folder.join(name))?;
    }
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "{}: the module has {transferred} bytes as transferred (brotli), in {seconds:.0} s",
        folder.display()
    );
    Ok(folder)
}

/// Builds the page, and returns its folder, `target/web`. Without npm, it lacks the example for three.js.
pub fn build() -> anyhow::Result<PathBuf> {
    build_with(PUBLISHED, leave_out_example)
}

/// Builds the page for tests.
pub fn page_for_tests() -> anyhow::Result<PathBuf> {
    build_with(TESTED, leave_out_example)
}

fn leave_out_example(error: anyhow::Error) -> anyhow::Result<String> {
    println!("the example for three.js was left out: {error:#}");
    Ok(String::new())
}

/// Builds the page. `without` decides what happens if the example for three.js cannot be made.
fn build_with(
    profile: &str,
    without: fn(anyhow::Error) -> anyhow::Result<String>,
) -> anyhow::Result<PathBuf> {
    let start = Instant::now();
    let target = target_folder()?;
    let module = compile(&["--package", "yoro-web"], "yoro_web", profile)?;
    let (folder, unfinished) = (target.join("web"), target.join("web.part"));
    remove(&unfinished)?;
    let Sizes { module, transferred, visit } =
        bind(&module, &unfinished.join(site::VERSION), &site::sources())?;
    // After the sizes have been measured, since a first visit does not load this module. It has the other one's name.
    let video = ["--package", "yoro-web", "--no-default-features", "--features", "video"];
    let video = compile(&video, "yoro_web", profile)?;
    let renamed = video.with_file_name("yoro_web_video.wasm");
    copy(&video, &renamed)?;
    bind(&renamed, &unfinished.join(site::VERSION), &site::sources())?;
    site::assemble(&unfinished)?;
    let mut notices = notices::text("yoro-web", TRIPLE, &["--all-features"])?;
    notices.push_str(&three::example(&unfinished.join("three")).or_else(without)?);
    write(&unfinished.join(notices::FILE), notices)?;
    remove(&folder)?;
    fs::rename(&unfinished, &folder).with_context(|| format!("{} cannot be written", folder.display()))?;
    println!(
        "{}: the module has {module} bytes, {transferred} as transferred (brotli), {visit} with the page around it, \
         in {:.0} s",
        folder.display(),
        start.elapsed().as_secs_f64()
    );
    if visit > BUDGET && profile == PUBLISHED {
        bail!("{visit} bytes are more than the {BUDGET} that a phone is to load: leave something out");
    }
    Ok(folder)
}

/// Builds the whole page unless this process has done so, and returns its folder.
pub fn build_once() -> anyhow::Result<PathBuf> {
    static BUILT: Mutex<Option<PathBuf>> = Mutex::new(None);
    let mut built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(folder) = &*built {
        return Ok(folder.clone());
    }
    let without = |error: anyhow::Error| Err(error.context("the example for three.js cannot be made"));
    let folder = build_with(PUBLISHED, without)?;
    *built = Some(folder.clone());
    Ok(folder)
}

/// True if Rust and a linker for WebAssembly are available.
fn can_be_built() -> bool {
    Rust::for_target(TRIPLE).is_some_and(|(rust, _)| rust.wasm_linker().is_some())
}

/// Installs what is missing to build the page.
pub fn ready_for_tests() -> anyhow::Result<PathBuf> {
    if !can_be_built() {
        let needs = || vec![source(Rust::with_source().as_ref()), Need::program("wasm-ld", &["lld"])];
        apt::install_missing(needs, true)?;
    }
    ensure!(can_be_built(), "no Rust can compile for browsers");
    Ok(PathBuf::new())
}

/// Compiles a module with one of cargo's profiles, and returns its path.
fn compile(what: &[&str], name: &str, profile: &str) -> anyhow::Result<PathBuf> {
    // A profile has the same name as the page's folder, so use a target folder of its own.
    let target = target_folder()?.join("wasm");
    let (rust, with_std) = Rust::for_target(TRIPLE).with_context(|| {
        format!(
            "no Rust can compile for browsers: rustup target add {TRIPLE}, or rustup component add rust-src, or \
             apt-get install rustc-web cargo-web rust-web-src"
        )
    })?;
    let arguments = [&["build", "--profile", profile, "--target", TRIPLE], what].concat();
    let mut command = rust.cargo()?;
    command.args(&arguments).env("CARGO_TARGET_DIR", &target);
    if with_std {
        build_std(&mut command, Panic::Abort);
    }
    let linker = rust.wasm_linker().context("there is no linker for WebAssembly: apt-get install lld")?;
    command.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker);
    command.env("CARGO_ENCODED_RUSTFLAGS", anonymous_paths().unwrap_or_default());
    cargo::perform(&mut command, "the module does not compile")?;
    Ok(target.join(TRIPLE).join(profile).join(name).with_extension("wasm"))
}

/// Sizes of the page in bytes.
struct Sizes {
    module: u64,
    /// The module as it is transferred.
    transferred: u64,
    /// Everything that a first visit transfers.
    visit: u64,
}

/// Prepares a module for browsers, into `folder`. `page` is the folder with the page's sources.
fn bind(module: &Path, folder: &Path, page: &Path) -> anyhow::Result<Sizes> {
    let text = console::run(cargo::program("yoro-web-bindgen")?.arg(module).arg(folder).arg(page))?;
    let numbers: Vec<u64> = text.split_whitespace().filter_map(|number| number.parse().ok()).collect();
    match numbers[..] {
        [module, transferred, visit] => Ok(Sizes { module, transferred, visit }),
        _ => bail!("yoro-web-bindgen says {text:?} instead of three numbers"),
    }
}
