//! Runs Monado beside a test.

use std::fs::File;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context as _, bail};

/// A process that is killed when this is dropped.
pub struct Running(pub Child);

impl Drop for Running {
    fn drop(&mut self) {
        self.0.kill().ok();
        self.0.wait().ok();
    }
}

/// Starts the runtime. Programs with `folder` as XDG_RUNTIME_DIR find it. Its log is written there, too.
///
/// # Errors
/// Fails if the runtime does not start.
pub fn start(service: &Path, folder: &Path) -> anyhow::Result<Running> {
    let log = File::create(folder.join("runtime.log"))?;
    let child = Command::new(service)
        .env("XDG_RUNTIME_DIR", folder)
        .stdin(Stdio::null())
        .stdout(log.try_clone()?)
        .stderr(log)
        .spawn()
        .context("Monado cannot be started")?;
    let running = Running(child);
    let start = Instant::now();
    while !folder.join("monado_comp_ipc").exists() {
        if start.elapsed() > Duration::from_secs(20) {
            bail!("Monado does not start: {}", folder.join("runtime.log").display());
        }
        thread::sleep(Duration::from_millis(50));
    }
    Ok(running)
}
