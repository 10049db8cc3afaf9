//! Programs that run together for a limited time: a virtual display, a runtime, Godot.

use std::fs::{self, File};
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context as _, bail};

use crate::apt;
use crate::maintain::godot;
use crate::maintain::monado::{self, Running};

/// A virtual display.
pub struct Screen {
    /// The value of DISPLAY.
    pub display: String,
    _server: Running,
}

impl Screen {
    /// Starts the display. Installs its server if it is missing.
    pub fn start() -> anyhow::Result<Self> {
        if apt::find_program("Xvfb").is_none() {
            apt::install(&[&["xvfb"]])?;
        }
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1280x1024x24", "-nolisten", "tcp", "-noreset"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .context("Xvfb cannot be started")?;
        let output = server.stdout.take();
        let server = Running(server);
        let mut number = String::new();
        BufReader::new(output.context("Xvfb says nothing")?).read_line(&mut number)?;
        if number.trim().is_empty() {
            bail!("Xvfb gives no display");
        }
        Ok(Self { display: format!(":{}", number.trim()), _server: server })
    }
}

/// Godot and Monado, with a virtual display.
pub struct Session {
    godot: PathBuf,
    screen: Screen,
}

impl Session {
    /// Sets up what is missing, and starts the display.
    pub fn begin() -> anyhow::Result<Self> {
        Ok(Self { godot: godot::make()?, screen: Screen::start()? })
    }

    /// Returns the path of Godot.
    pub fn program(&self) -> PathBuf {
        self.godot.join("godot")
    }

    /// Runs Godot with these arguments, and returns its output. Godot writes its log to `folder`, and finds the runtime
    /// there. Its exit status is ignored.
    pub fn godot(&self, arguments: &[&str], folder: &Path, limit: Duration) -> anyhow::Result<String> {
        let log = folder.join("log");
        let file = File::create(&log).with_context(|| format!("{} cannot be written", log.display()))?;
        let child = Command::new(self.program())
            .args(arguments)
            .env("DISPLAY", &self.screen.display)
            .env("XDG_RUNTIME_DIR", folder)
            // All runs share the cache of compiled shaders.
            .envs(
                ["XDG_DATA_HOME", "XDG_CONFIG_HOME", "XDG_CACHE_HOME"]
                    .map(|it| (it, folder.with_file_name("cache"))),
            )
            // Lavapipe must not optimize shaders: most draw only a few frames, which would save less than it takes.
            .env("GALLIVM_PERF", "nopt")
            .stdin(Stdio::null())
            .stdout(file.try_clone()?)
            .stderr(file)
            .spawn()
            .context("Godot cannot be started")?;
        let mut running = Running(child);
        let start = Instant::now();
        while running.0.try_wait().context("Godot is gone")?.is_none() {
            if start.elapsed() > limit {
                bail!("Godot took longer than {} s: {}", limit.as_secs(), log.display());
            }
            thread::sleep(Duration::from_millis(50));
        }
        Ok(String::from_utf8_lossy(&fs::read(&log)?).into_owned())
    }

    /// Starts the runtime. Programs with the same folder find it.
    pub fn runtime(&self, folder: &Path) -> anyhow::Result<Running> {
        monado::start(&self.godot.join("monado-service"), folder)
    }
}
