//! A simulated Android host: runs the libraries of the built APK on Linux, without a device or Google's tools.
//!
//! The host takes the library and the assets from the APK, loads the library with its own ELF loader, and provides the
//! library's imports: bionic, ALooper, ANativeActivity, input, sensors, JNI, and EGL on Mesa. A script
//! ([`script::Script`]) describes the device and the events. The result is a [`summary::Summary`].
//!
//! A clean run shows that the APK's own code starts, draws correctly, and survives Android's events. It shows nothing
//! about speed, power, drivers or the differences between manufacturers. The host must not know anything about the
//! application except its entry point.

mod android;
mod apk;
mod bionic;
mod clock;
mod crash;
mod elf;
mod exports;
mod fd;
mod frames;
mod graphics;
mod host;
mod jni;
mod library;
mod loader;
mod openxr;
mod player;
mod random;
pub mod script;
pub mod summary;
mod threads;
mod thunk;

use std::os::fd::AsFd;
use std::path::Path;

use anyhow::{Context, Result};

use crate::android::activity::OnCreate;
use crate::apk::Apk;
use crate::host::{ABI, Host, Report};
use crate::library::Library;
use crate::player::Player;
use crate::script::Script;

/// Runs `script` with the APK, writes `summary.json` and pictures to `out`, prints the summary, and ends the process.
/// The exit code is 0 for a clean run, and 1 if there was a failure, a GL error or a violation. Only returns if it
/// cannot start.
///
/// # Errors
/// Fails if the APK, the library or the output folder cannot be used, or Mesa is missing.
pub fn run(apk_path: &Path, script: &Script, out: &Path, verbose: bool) -> Result<std::convert::Infallible> {
    std::fs::create_dir_all(out).with_context(|| format!("cannot make the folder {}", out.display()))?;
    let apk = Apk::read(apk_path, ABI)?;
    let headset = script.device.openxr.as_ref();
    let layer = headset.and_then(|headset| headset.layer.as_deref());
    let layer = layer.map(|path| Apk::read_aar(path, ABI)).transpose()?;
    let report = Report {
        script: script.name.clone(),
        out: out.to_owned(),
        libraries: Vec::new(),
        trapped_symbols: Vec::new(),
        marks: Vec::new(),
        stderr: std::io::stderr().as_fd().try_clone_to_owned()?,
    };
    if let Some(headset) = headset {
        // SAFETY: the process has a single thread.
        unsafe { openxr::install(headset) }?;
    }
    let host = Host::install(script, apk.assets, verbose, report)?;
    let sdk = host.device.sdk;
    let load = |(name, bytes): &(String, Vec<u8>)| -> Result<Library> {
        let loaded = Library::load(name, bytes, |library, symbol| exports::find(library, symbol, sdk))?;
        let mut report = host.report();
        report.libraries.push(name.clone());
        report.trapped_symbols.extend(loaded.trapped);
        Ok(loaded.library)
    };
    let library = load(&apk.library)?;
    let library = host.library.get_or_init(|| library);
    if let Some(layer) = &layer {
        let library = load(&layer.library)?;
        loader::install(&layer.assets, host.layer.get_or_init(|| library))?;
    }
    crash::install();
    for library in host.libraries() {
        // SAFETY: from now on the library can reach everything it needs through the host.
        unsafe { library.initialize() };
    }
    let create = library
        .symbol("ANativeActivity_onCreate")
        .with_context(|| format!("{} does not export ANativeActivity_onCreate", apk.library.0))?;
    // SAFETY: by the NDK's contract, the symbol with this name has this type.
    let create: OnCreate = unsafe { std::mem::transmute(create) };
    let mut player = Player::new(create, out.to_owned());
    player.play(&script.steps);
    host.finish(None)
}
