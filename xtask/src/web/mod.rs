//! The page: `app/web` compiled for browsers, and the files around it, for any static host.

mod npm;
mod serve;
mod site;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::Instant;

use anyhow::{Context as _, bail};
use yoro_tools::cargo::{self, announce};
use yoro_tools::folders::{remove, target_folder};
use yoro_tools::rust::{Panic, Rust, anonymous_paths, build_std};

pub use npm::{check_types, emulator};
pub use serve::serve;
pub use site::publish;

const TRIPLE: &str = "wasm32-unknown-unknown";
const MODULE: &str = "yoro_web";
/// The most bytes that a first visit may transfer: phones load it over the air.
const BUDGET: u64 = 1_200_000;

/// Returns the folder of the built page.
///
/// # Errors
/// When it is not built.
pub fn built() -> anyhow::Result<PathBuf> {
    let folder = target_folder()?.join("web");
    if !folder.join("index.html").is_file() {
        bail!("{} has no page: run cargo xtask web", folder.display());
    }
    Ok(folder)
}

/// Builds the page, and returns its folder, `target/web`.
///
/// # Errors
/// When something is missing or does not compile, or the module has become too large.
pub fn build() -> anyhow::Result<PathBuf> {
    let start = Instant::now();
    let target = target_folder()?;
    // Its profile has the name of the page's folder.
    let module = compile(&target.join("wasm"))?;
    let (folder, unfinished) = (target.join("web"), target.join("web.part"));
    remove(&unfinished)?;
    let Sizes { module, transferred, visit } = bind(&module, &unfinished.join(site::VERSION))?;
    site::assemble(&unfinished)?;
    remove(&folder)?;
    fs::rename(&unfinished, &folder).with_context(|| format!("{} cannot be written", folder.display()))?;
    println!(
        "{}: the module has {module} bytes, {transferred} as transferred (brotli), {visit} with the page around it, \
         in {:.0} s",
        folder.display(),
        start.elapsed().as_secs_f64()
    );
    if visit > BUDGET {
        bail!("{visit} bytes are more than the {BUDGET} that a phone is to load: leave something out");
    }
    Ok(folder)
}

/// True if there are a Rust and a linker for it.
pub fn can_be_built() -> bool {
    Rust::for_target(TRIPLE).is_some_and(|(rust, _)| rust.wasm_linker().is_some())
}

/// Compiles the module, and returns its file.
fn compile(target: &Path) -> anyhow::Result<PathBuf> {
    let (rust, with_std) = Rust::for_target(TRIPLE).with_context(|| {
        format!(
            "no Rust can compile for browsers: rustup target add {TRIPLE}, or rustup component add rust-src, or \
             apt-get install rustc-web cargo-web rust-web-src"
        )
    })?;
    let arguments = ["build", "--package", "yoro-web", "--profile", "web", "--target", TRIPLE];
    let mut command = rust.cargo()?;
    command.args(arguments).env("CARGO_TARGET_DIR", target);
    if with_std {
        build_std(&mut command, Panic::Abort);
    }
    let linker = rust.wasm_linker().context("there is no linker for WebAssembly: apt-get install lld")?;
    command.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker);
    command.env("CARGO_ENCODED_RUSTFLAGS", anonymous_paths().unwrap_or_default());
    announce(&arguments);
    if !command.status().context("cargo cannot be started")?.success() {
        bail!("the page's module does not compile: see above");
    }
    Ok(target.join(TRIPLE).join("web").join(MODULE).with_extension("wasm"))
}

/// The page's sizes in bytes.
struct Sizes {
    module: u64,
    /// The module as transferred.
    transferred: u64,
    /// All that a first visit transfers.
    visit: u64,
}

/// Makes the module ready for browsers.
fn bind(module: &Path, folder: &Path) -> anyhow::Result<Sizes> {
    let mut command = cargo::program("yoro-web-bindgen")?;
    let output = command.arg(module).arg(folder).arg(site::sources()).stderr(Stdio::inherit()).output();
    let output = output.context("yoro-web-bindgen cannot be started")?;
    if !output.status.success() {
        bail!("the module cannot be made ready for browsers: see above");
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let numbers: Vec<u64> = text.split_whitespace().filter_map(|number| number.parse().ok()).collect();
    match numbers[..] {
        [module, transferred, visit] => Ok(Sizes { module, transferred, visit }),
        _ => bail!("yoro-web-bindgen says {text:?} instead of three numbers"),
    }
}
