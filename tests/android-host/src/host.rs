//! The simulated device. There is one per process, since the library calls C functions without a context argument.

use std::collections::BTreeMap;
use std::os::fd::{AsRawFd, OwnedFd};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock};
use std::time::{Duration, Instant};

use crate::android::activity::Directories;
use crate::android::camera::Camera;
use crate::android::input::InputCounts;
use crate::android::log::Log;
use crate::android::sensors::Sensors;
use crate::android::window::Window;
use crate::clock::Clock;
use crate::frames::Frames;
use crate::graphics::Graphics;
use crate::jni::Jni;
use crate::library::Library;
use crate::script::{Battery, Device, Script, Share, Thermal};
use crate::summary::{InputFacts, LABEL, Mark, Summary};
use crate::threads;

/// The simulated device: everything that the application can query.
pub struct Host {
    /// The device at power-on, as described by the script.
    pub device: Device,
    /// The battery, which steps of the script can change.
    pub battery: Mutex<Option<Battery>>,
    /// The thermal state, which steps of the script can change.
    pub thermal: Mutex<Thermal>,
    /// What another application shares with the next activity, and what it has shared with the current one.
    pub shared: [Mutex<Option<Share>>; 2],
    /// System properties.
    pub properties: Mutex<BTreeMap<String, String>>,
    /// Virtual time.
    pub clock: Clock,
    /// The gate in `eglSwapBuffers`.
    pub frames: Frames,
    /// The log (liblog).
    pub log: Log,
    /// The camera.
    pub camera: Camera,
    /// Numbers of input events.
    pub input: InputCounts,
    /// The sensors (ASensorManager).
    pub sensors: Sensors,
    /// The window (ANativeWindow).
    pub window: Window,
    /// EGL and OpenGL ES.
    pub graphics: Graphics,
    /// The Java virtual machine.
    pub jni: Jni,
    /// The application's folders.
    pub directories: Directories,
    /// The files in the APK's folder `assets`, by path.
    pub assets: BTreeMap<String, Vec<u8>>,
    /// The application's library.
    pub library: OnceLock<Library>,
    /// The library of an API layer, if the application contains one.
    pub layer: OnceLock<Library>,
    /// True if the application has called `ANativeActivity_finish`.
    pub finish_asked: AtomicBool,
    /// The kernel's number of the thread that runs `android_main`, or 0 before the first one.
    pub main_thread: AtomicI32,
    ndk_objects: Mutex<BTreeMap<&'static str, i64>>,
    requests: Mutex<BTreeMap<String, u64>>,
    violations: Mutex<Vec<String>>,
    report: Mutex<Report>,
    context: Mutex<String>,
    /// What must end in time.
    doing: Mutex<Option<(String, Instant)>>,
}

/// Facts for the summary, in addition to the live state.
pub struct Report {
    /// The script's name.
    pub script: String,
    /// The path of the summary.
    pub out: PathBuf,
    /// The paths of the libraries in the APK.
    pub libraries: Vec<String>,
    /// Imported symbols that are traps.
    pub trapped_symbols: Vec<String>,
    /// The marks so far.
    pub marks: Vec<Mark>,
    /// The real standard error, since the library redirects its own.
    pub stderr: OwnedFd,
}

static HOST: OnceLock<Host> = OnceLock::new();

/// Returns the device.
///
/// # Panics
/// Panics before [`Host::install`].
pub fn host() -> &'static Host {
    HOST.get().expect("the host is installed before the library is loaded")
}

/// The name of this machine's ABI in an APK.
pub const ABI: &str = if cfg!(target_arch = "aarch64") { "arm64-v8a" } else { "x86_64" };

/// Locks a mutex. Ignores poisoning, since the panic has already been reported.
pub fn lock<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

impl Host {
    /// Switches the device on, once per process.
    ///
    /// # Errors
    /// Fails if EGL or the folders cannot be set up.
    pub fn install(
        script: &Script,
        assets: BTreeMap<String, Vec<u8>>,
        verbose: bool,
        report: Report,
    ) -> anyhow::Result<&'static Self> {
        let device = script.device.clone();
        let host = Self {
            battery: Mutex::new(device.battery.clone()),
            thermal: Mutex::new(device.thermal.clone()),
            shared: Default::default(),
            properties: Mutex::new(device.properties.clone()),
            clock: Clock::new(device.slept_seconds),
            frames: Frames::new(),
            log: Log::new(verbose),
            camera: Camera::new(&device),
            input: InputCounts::default(),
            sensors: Sensors::new(device.sensors),
            window: Window::new(device.width, device.height),
            graphics: Graphics::new(device.gles)?,
            jni: Jni::new(),
            directories: Directories::new(&device.files)?,
            assets,
            library: OnceLock::new(),
            layer: OnceLock::new(),
            finish_asked: AtomicBool::new(false),
            main_thread: AtomicI32::new(0),
            ndk_objects: Mutex::new(BTreeMap::new()),
            requests: Mutex::default(),
            violations: Mutex::new(Vec::new()),
            report: Mutex::new(report),
            context: Mutex::default(),
            doing: Mutex::new(None),
            device,
        };
        anyhow::ensure!(HOST.set(host).is_ok(), "a process can play one device only");
        std::thread::Builder::new().name("host-watch".into()).spawn(watch)?;
        Ok(self::host())
    }

    /// Returns the libraries that Android's linker would have loaded.
    pub fn libraries(&self) -> impl Iterator<Item = &Library> {
        self.library.get().into_iter().chain(self.layer.get())
    }

    /// Writes a line to the real standard error.
    pub fn say(&self, text: &str) {
        say_to(lock(&self.report).stderr.as_raw_fd(), &format!("{text}\n"));
    }

    /// Records something that Android forbids or penalises. Each text is recorded once.
    pub fn violation(&self, text: impl Into<String>) {
        let text = text.into();
        let mut violations = lock(&self.violations);
        if !violations.contains(&text) {
            violations.push(text);
        }
    }

    /// Counts an NDK object that was created (+1) or released (-1).
    pub fn count(&self, kind: &'static str, change: i64) {
        *lock(&self.ndk_objects).entry(kind).or_default() += change;
    }

    /// Sets what the script is doing, for the text of a failure. Empty if it is nothing special.
    pub fn set_context(&self, context: String) {
        *lock(&self.context) = context;
    }

    /// Records a request of the application about the device's performance.
    pub fn request(&self, what: impl Into<String>) {
        *lock(&self.requests).entry(what.into()).or_default() += 1;
    }

    /// Returns the facts for the summary.
    pub fn report(&self) -> MutexGuard<'_, Report> {
        lock(&self.report)
    }

    /// Runs a closure that must end in time. Otherwise the run fails, and the failure contains `what`.
    pub fn watched<T>(&self, what: &str, run: impl FnOnce() -> T) -> T {
        *lock(&self.doing) = Some((what.to_owned(), Instant::now()));
        let result = run();
        *lock(&self.doing) = None;
        result
    }

    /// Returns the resources currently in use.
    pub fn mark(&self, name: &str) -> Mark {
        Mark {
            name: name.to_owned(),
            frames: self.frames.shown(),
            seconds: self.clock.seconds(),
            gl_objects: self.graphics.live_objects(),
            egl_contexts: self.graphics.live_contexts(),
            egl_surfaces: self.graphics.live_surfaces(),
            window_references: self.window.references(),
            ndk_objects: lock(&self.ndk_objects)
                .iter()
                .filter(|(_, count)| **count != 0)
                .map(|(kind, count)| ((*kind).to_owned(), *count))
                .collect(),
            jni_references: self.jni.live_references(),
            file_descriptors: held("/proc/self/fd"),
            threads: held("/proc/self/task"),
            resident_kib: resident_kib(),
        }
    }

    /// Returns the summary so far.
    pub fn summary(&self, failure: Option<String>) -> Summary {
        let end = self.mark("end");
        let report = self.report();
        let mut marks = report.marks.clone();
        marks.push(end);
        Summary {
            host: LABEL.to_owned(),
            script: report.script.clone(),
            abi: ABI.to_owned(),
            libraries: report.libraries.clone(),
            failure,
            frames: self.frames.shown(),
            seconds: self.clock.seconds(),
            gl: self.graphics.facts(),
            marks,
            input: InputFacts {
                sent: self.input.sent.load(Ordering::Relaxed),
                finished: self.input.finished.load(Ordering::Relaxed),
                handled: self.input.handled.load(Ordering::Relaxed),
            },
            violations: lock(&self.violations).clone(),
            jni_invented: self.jni.invented(),
            requests: lock(&self.requests).clone(),
            trapped_symbols: report.trapped_symbols.clone(),
            log: self.log.lines(),
        }
    }

    /// Writes and prints the summary, and ends the process without cleaning up, since threads of the application may
    /// still run. The exit code is 0 after a clean run, otherwise 1.
    pub fn finish(&self, failure: Option<String>) -> ! {
        static FINISHING: AtomicBool = AtomicBool::new(false);
        if FINISHING.swap(true, Ordering::SeqCst) {
            // Another thread is writing the summary and will end the process.
            loop {
                std::thread::sleep(Duration::from_secs(1));
            }
        }
        let context = lock(&self.context).clone();
        let summary = self.summary(
            failure
                .map(|failure| if context.is_empty() { failure } else { format!("{failure} ({context})") }),
        );
        self.directories.remove();
        let path = self.report().out.join("summary.json");
        let written = serde_json::to_vec_pretty(&summary)
            .map_err(std::io::Error::other)
            .and_then(|json| std::fs::write(&path, json));
        let mut code = i32::from(!summary.is_clean());
        let mut text = summary.to_string();
        if let Err(error) = written {
            text += &format!("cannot write {}: {error}\n", path.display());
            code = 1;
        }
        say_to(self.report().stderr.as_raw_fd(), &text);
        // SAFETY: ends the process without running destructors, whose objects the application's threads may still use.
        unsafe { libc::_exit(code) }
    }
}

/// Ends the run with a failure after which nothing can be trusted.
pub fn fatal(text: impl Into<String>) -> ! {
    let text = text.into();
    match HOST.get() {
        Some(host) => host.finish(Some(text)),
        None => {
            say_to(libc::STDERR_FILENO, &format!("{LABEL}: {text}\n"));
            // SAFETY: ends the process.
            unsafe { libc::_exit(1) }
        }
    }
}

/// Writes to a file descriptor, ignoring errors.
pub fn say_to(fd: i32, text: &str) {
    let mut rest = text.as_bytes();
    while !rest.is_empty() {
        // SAFETY: pointer and length belong to one live slice.
        let written = unsafe { libc::write(fd, rest.as_ptr().cast(), rest.len()) };
        match usize::try_from(written) {
            Ok(written) if written > 0 => rest = &rest[written..],
            _ => return,
        }
    }
}

/// Real time that a step or a callback of the activity may take. On a busy machine, especially under qemu, a frame may take
/// minutes.
const PATIENCE: Duration = Duration::from_secs(600);

fn watch() {
    loop {
        std::thread::sleep(Duration::from_millis(200));
        let doing = lock(&host().doing).clone();
        if let Some((what, _)) = doing.filter(|(_, start)| start.elapsed() > PATIENCE) {
            fatal(format!("{what} takes more than ten minutes; {}", threads::list()));
        }
    }
}

/// Number of times that entries are counted again. The smallest count is used.
const LOOKS: usize = 8;

/// Returns the number of entries in a folder, without files that other threads, such as Mesa's, open only briefly.
fn held(folder: &str) -> u64 {
    let count = || std::fs::read_dir(folder).map_or(0, |entries| entries.count() as u64);
    let later = || {
        std::thread::sleep(std::time::Duration::from_millis(2));
        count()
    };
    (0..LOOKS).map(|_| later()).fold(count(), u64::min)
}

fn resident_kib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))
        .and_then(|rest| rest.trim().trim_end_matches(" kB").parse().ok())
        .unwrap_or(0)
}
