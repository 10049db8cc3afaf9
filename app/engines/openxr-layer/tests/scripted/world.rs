//! The simulated runtime, and the results of a run: its log, its pictures, and the layer's log.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::fs::{self, File};
use std::io::{Read as _, Seek as _};
use std::os::fd::{AsRawFd as _, FromRawFd as _, OwnedFd};
use std::path::Path;
use std::process;
use std::sync::Once;

use image::RgbaImage;
use tempfile::TempDir;
use yoro_openxr_stub::log::{self, Entry, Layer, View};
use yoro_openxr_stub::script::{Fault, Pictures, Script};

use crate::harness::{self, Gpu, Rendering};

/// Counts the allocations of this thread outside the simulated runtime.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call is passed to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if !yoro_openxr_stub::is_inside() {
            ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        }
        // SAFETY: same contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: same contract.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

pub fn allocations() -> usize {
    ALLOCATIONS.get()
}

/// Runs code whose allocations are not counted.
pub fn uncounted<T>(work: impl FnOnce() -> T) -> T {
    let before = ALLOCATIONS.get();
    let result = work();
    ALLOCATIONS.set(before);
    result
}

/// The settings file, with sections named after applications.
const SETTINGS: &str = "guard_band = '16px'\n\
    [application.left]\ndominant = 'left'\n\
    [application.shrink]\nshrink = 'on'\n\
    [application.only]\noffer = 'only'\n\
    [application.last]\noffer = 'last'\n\
    [application.off]\noffer = 'off'\nshrink = 'on'\n";

/// Runs a test on a device under Vulkan's validation layer, with the tests' settings.
pub fn with_gpu(body: impl FnOnce(&Gpu)) {
    settle();
    harness::with_gpu(Rendering::RenderPasses, body);
}

/// Runs a test on a device without the validation layer.
pub fn with_unwatched_gpu(body: impl FnOnce(&Gpu)) {
    settle();
    harness::with_unwatched_gpu(Rendering::RenderPasses, body);
}

/// Puts the settings and the log into a folder of this process, so that each process begins a new log.
pub fn settle() {
    static SETTLED: Once = Once::new();
    SETTLED.call_once(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("layer-settings-{}", process::id()));
        // Left by an earlier process with the same number.
        fs::remove_dir_all(&folder).ok();
        fs::create_dir_all(folder.join("yoro")).unwrap();
        fs::write(folder.join("yoro/layer.toml"), SETTINGS).unwrap();
        // SAFETY: the drivers are not loaded yet. They start threads that may read the environment.
        unsafe {
            std::env::set_var("XDG_CONFIG_HOME", &folder);
            std::env::set_var("XDG_STATE_HOME", &folder);
        }
    });
}

/// The formats of a runtime on Vulkan: R8G8B8A8_SRGB, _UNORM, B8G8R8A8_SRGB, _UNORM, depth in 16, 32 and 32+8 bits.
const FORMATS: [i64; 7] = [43, 37, 50, 44, 124, 126, 130];

/// Returns a headset on Vulkan, with the frusta of current headsets.
pub fn script() -> Script {
    let pictures = Some(Pictures { folder: "in each run's own".into(), from: 0 });
    Script { formats: FORMATS.into(), pictures, ..Script::default() }.asymmetric()
}

/// Returns the same headset, with a function of the runtime that fails in its nth call, counted from 1.
pub fn faulty(call: &str, nth: u32, result: openxr_sys::Result) -> Script {
    let fault = Fault { call: call.into(), nth, and_later: false, result: result.into_raw() };
    Script { faults: vec![fault], ..script() }
}

/// The results of a run.
pub struct Seen {
    pub log: Vec<Entry>,
    /// The layer's log.
    pub layer_log: String,
    folder: TempDir,
}

/// Captures standard error.
struct Overheard {
    shown: OwnedFd,
    file: File,
}

impl Overheard {
    fn begin() -> Overheard {
        let file = tempfile::tempfile().unwrap();
        // SAFETY: plain calls on open descriptors. Nobody else owns the copy.
        unsafe {
            let shown = libc::dup(2);
            assert!(shown >= 0 && libc::dup2(file.as_raw_fd(), 2) == 2);
            Overheard { shown: OwnedFd::from_raw_fd(shown), file }
        }
    }

    fn text(&mut self) -> String {
        let mut text = String::new();
        self.file.rewind().unwrap();
        self.file.read_to_string(&mut text).unwrap();
        text
    }
}

impl Drop for Overheard {
    fn drop(&mut self) {
        // SAFETY: both descriptors are open.
        unsafe { libc::dup2(self.shown.as_raw_fd(), 2) };
        if std::thread::panicking() {
            println!("{}", self.text());
        }
    }
}

/// Runs an application on a runtime that follows a script.
pub fn watched(mut script: Script, application: impl FnOnce()) -> Seen {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("log");
    script.log = Some(log.clone());
    if let Some(pictures) = &mut script.pictures {
        pictures.folder = folder.path().into();
    }
    yoro_openxr_stub::begin(script);
    let mut overheard = Overheard::begin();
    application();
    let layer_log = overheard.text();
    drop(overheard);
    Seen { log: log::read(&log), layer_log, folder }
}

impl Seen {
    /// Returns the submitted layers of each frame that is not empty.
    pub fn frames(&self) -> Vec<&Vec<Layer>> {
        let layers = self.log.iter().filter_map(|entry| match entry {
            Entry::Frame { layers, .. } if !layers.is_empty() => Some(layers),
            _ => None,
        });
        layers.collect()
    }

    /// Returns the views of the last frame's projection layer.
    pub fn views(&self) -> &[View] {
        let frames = self.frames();
        let layers = frames.last().expect("there are frames").iter();
        let mut views = layers.rev().filter_map(|layer| match layer {
            Layer::Projection { views } => Some(views.as_slice()),
            _ => None,
        });
        views.next().expect("there is a projection layer")
    }

    /// Returns the last picture that the runtime received for an eye, with rows from the bottom.
    pub fn picture(&self, eye: usize) -> Vec<u8> {
        let path = self.folder.path().join(format!("view-{eye}.png"));
        let picture: RgbaImage = image::open(path).unwrap().into_rgba8();
        image::imageops::flip_vertical(&picture).into_raw()
    }

    /// Returns the last depth that the runtime received for an eye, with rows from the bottom.
    pub fn depth(&self, eye: usize) -> Vec<f32> {
        let bytes = fs::read(self.folder.path().join(format!("depth-{eye}"))).unwrap();
        bytes.chunks_exact(4).map(|four| f32::from_ne_bytes([four[0], four[1], four[2], four[3]])).collect()
    }

    /// Returns the violations of the specification. Asking for functions of extensions that are not enabled does not
    /// count, because a layer has no other way to find out about them.
    pub fn violations(&self) -> Vec<&Entry> {
        let is_one = |entry: &&Entry| matches!(entry, Entry::Violation { call, .. } if call != "xrGetInstanceProcAddr");
        self.log.iter().filter(is_one).collect()
    }

    /// Returns how often each function of the runtime was called.
    pub fn calls(&self) -> std::collections::BTreeMap<String, u32> {
        let counts = self.log.iter().rev().find_map(|entry| match entry {
            Entry::Calls { counts } => Some(counts.clone()),
            _ => None,
        });
        counts.unwrap_or_default()
    }

    /// Returns the layer's counts at the end of each session: synthesized views, and others.
    pub fn counts(&self) -> Vec<[u64; 2]> {
        let ends = self.layer_log.lines().filter_map(|line| {
            let (_, counts) = line.split_once("session ended after ")?.1.split_once(" frames: ")?;
            let (synthesized, rest) = counts.split_once(" synthesized, ")?;
            Some([synthesized.parse().ok()?, rest.strip_suffix(" not")?.parse().ok()?])
        });
        ends.collect()
    }

    /// Checks that a text is in the layer's log once.
    #[track_caller]
    pub fn says_once(&self, text: &str) {
        assert_eq!(self.count_in_log(text), 1, "{text}: {}", self.layer_log);
    }

    /// Returns how often a text is in the layer's log.
    pub fn count_in_log(&self, text: &str) -> usize {
        self.layer_log.matches(text).count()
    }
}
