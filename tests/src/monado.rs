//! Monado's service beside a test. Test programs of several crates, and xtask, include this file by its path.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// The longest wait for the service, which other processes may slow down.
const TIMEOUT: Duration = Duration::from_secs(60);

/// A process that is killed when this is dropped.
pub struct Running(pub Child);

impl Drop for Running {
    fn drop(&mut self) {
        self.0.kill().ok();
        self.0.wait().ok();
    }
}

/// Starts the service. Programs with `folder` as XDG_RUNTIME_DIR find it. Its log is `service.log` in that folder.
///
/// # Errors
/// Fails with one sentence and the log if the service does not start.
pub fn start(service: &Path, folder: &Path) -> Result<Running, String> {
    let name = service.display();
    let path = folder.join("service.log");
    let spawn = || {
        let log = File::create(&path)?;
        let mut command = Command::new(service);
        command.env("XDG_RUNTIME_DIR", folder).stdin(Stdio::null());
        command.stdout(log.try_clone()?).stderr(log).spawn()
    };
    let mut running = Running(spawn().map_err(|error| format!("{name} cannot be started: {error}"))?);
    let start = Instant::now();
    while !folder.join("monado_comp_ipc").exists() {
        let has_ended = running.0.try_wait().is_ok_and(|status| status.is_some());
        if has_ended || start.elapsed() > TIMEOUT {
            return Err(format!("{name} does not start: {}", fs::read_to_string(&path).unwrap_or_default()));
        }
        thread::sleep(Duration::from_millis(50));
    }
    Ok(running)
}
