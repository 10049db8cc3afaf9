//! The result of a run, as JSON for tests and as text for people.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// Part of every output, so that no figure is mistaken for that of a device.
pub const LABEL: &str = "simulated Android host";

/// The result of a run.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Summary {
    /// Always [`LABEL`].
    pub host: String,
    /// The script's name.
    pub script: String,
    /// The path of the APK.
    pub apk: PathBuf,
    /// The ABI: `x86_64` or `arm64-v8a`.
    pub abi: String,
    /// The application's library as loaded, followed by that of an API layer.
    pub libraries: Vec<LibraryFacts>,
    /// The reason why the run ended early. `None` if the script was played to its end.
    pub failure: Option<String>,
    /// Number of frames shown.
    pub frames: u64,
    /// Duration in virtual seconds.
    pub seconds: f64,
    /// Duration in real seconds. It depends on this machine and its CPU rasterizer, and does not apply to a phone.
    pub real_seconds: f64,
    /// Duration of the longest callback on the main thread, in real milliseconds.
    pub longest_callback_ms: f64,
    /// Facts about OpenGL ES.
    pub gl: GlFacts,
    /// Resources in use at the marks. The last mark is the end of the run.
    pub marks: Vec<Mark>,
    /// Numbers of input events.
    pub input: InputFacts,
    /// Things the application did that Android forbids or penalises.
    pub violations: Vec<String>,
    /// Unknown JNI calls, which returned a new object of the type, zero or false.
    pub jni_invented: BTreeMap<String, u64>,
    /// Requests about the device's performance, with the number of times each was made.
    pub requests: BTreeMap<String, u64>,
    /// Symbols that the libraries import and that are traps.
    pub trapped_symbols: Vec<String>,
    /// Files written by `capture` steps.
    pub captures: Vec<PathBuf>,
    /// Number of lines per tag, counting errors separately.
    pub log_counts: BTreeMap<String, u64>,
    /// Lines with the tags `YORO` (the application) and `yoro` (the API layer), and all of priority error and above.
    pub log: Vec<LogLine>,
}

/// A library in the APK.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct LibraryFacts {
    /// The path in the APK.
    pub name: String,
    /// Size in bytes.
    pub size: u64,
    /// The libraries that it needs.
    pub needed: Vec<String>,
    /// Number of imported symbols that were bound.
    pub symbols: usize,
    /// Number of applied relocations.
    pub relocations: usize,
    /// Smallest alignment of a LOAD segment in bytes.
    pub alignment: u64,
}

/// Facts about OpenGL ES.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct GlFacts {
    /// `GL_VERSION` of the last context.
    pub version: String,
    /// `GL_RENDERER` of the last context.
    pub renderer: String,
    /// Number of contexts created.
    pub contexts: u64,
    /// Number of times that the application waited for a fence.
    pub waits: u64,
    /// The first fifty errors in the driver's words, with the number of the frame.
    pub errors: Vec<String>,
    /// Number of all errors.
    pub error_count: u64,
}

/// Numbers of input events.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct InputFacts {
    /// Sent to the application.
    pub sent: u64,
    /// Finished by the application.
    pub finished: u64,
    /// Finished as handled.
    pub handled: u64,
}

/// The resources in use at some point of the run.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
pub struct Mark {
    /// The mark's name.
    pub name: String,
    /// Number of frames shown so far.
    pub frames: u64,
    /// Virtual seconds since the start of the run.
    pub seconds: f64,
    /// Number of live GL objects by kind.
    pub gl_objects: BTreeMap<String, u64>,
    /// Number of EGL contexts that have not been destroyed.
    pub egl_contexts: u64,
    /// Number of EGL surfaces that have not been destroyed.
    pub egl_surfaces: u64,
    /// Number of references held to native windows.
    pub window_references: i64,
    /// Number of loopers, sensor queues and other NDK objects that have not been released.
    pub ndk_objects: BTreeMap<String, i64>,
    /// Number of JNI references of all kinds.
    pub jni_references: u64,
    /// Number of open file descriptors of the process.
    pub file_descriptors: u64,
    /// Number of threads of the process, including Mesa's.
    pub threads: u64,
    /// Resident memory of the process in KiB, including Mesa's.
    pub resident_kib: u64,
}

impl Mark {
    /// Returns one line of text with everything except memory that must not grow from cycle to cycle.
    pub fn objects(&self) -> String {
        format!(
            "GL {:?}, EGL contexts {} surfaces {}, windows {}, NDK {:?}, JNI {}, fds {}, threads {}",
            self.gl_objects,
            self.egl_contexts,
            self.egl_surfaces,
            self.window_references,
            self.ndk_objects,
            self.jni_references,
            self.file_descriptors,
            self.threads
        )
    }
}

/// A line of the log.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct LogLine {
    /// Time in virtual seconds.
    pub seconds: f64,
    /// Number of frames shown so far.
    pub frame: u64,
    /// Priority: `V`, `D`, `I`, `W`, `E` or `F`.
    pub priority: char,
    /// Tag.
    pub tag: String,
    /// Text, without the line end.
    pub text: String,
}

impl Summary {
    /// True if the script was played to its end without a GL error or a violation.
    pub fn is_clean(&self) -> bool {
        self.failure.is_none() && self.gl.error_count == 0 && self.violations.is_empty()
    }

    /// Returns the mark of this name.
    pub fn mark(&self, name: &str) -> Option<&Mark> {
        self.marks.iter().find(|mark| mark.name == name)
    }

    /// Returns the texts of one tag's lines.
    pub fn log_of<'a>(&'a self, tag: &'a str) -> impl Iterator<Item = &'a str> {
        self.log.iter().filter(move |line| line.tag == tag).map(|line| line.text.as_str())
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{LABEL}: {} ({}, {})", self.script, self.apk.display(), self.abi)?;
        for library in &self.libraries {
            writeln!(
                f,
                "  library   {}: {} KiB, {} symbols, {} relocations, aligned to {} KiB, needs {}",
                library.name,
                library.size / 1024,
                library.symbols,
                library.relocations,
                library.alignment / 1024,
                library.needed.join(" ")
            )?;
        }
        writeln!(
            f,
            "  frames    {} in {:.2} virtual seconds ({:.1} s here)",
            self.frames, self.seconds, self.real_seconds
        )?;
        writeln!(
            f,
            "  GL        {} on {}, {} contexts, {} errors",
            self.gl.version, self.gl.renderer, self.gl.contexts, self.gl.error_count
        )?;
        for error in &self.gl.errors {
            writeln!(f, "            {error}")?;
        }
        writeln!(
            f,
            "  input     {} sent, {} finished, {} handled",
            self.input.sent, self.input.finished, self.input.handled
        )?;
        writeln!(f, "  callbacks longest {:.1} ms here", self.longest_callback_ms)?;
        for mark in &self.marks {
            writeln!(
                f,
                "  at {:<6} frame {}: {}, {} MiB",
                mark.name,
                mark.frames,
                mark.objects(),
                mark.resident_kib / 1024
            )?;
        }
        for path in &self.captures {
            writeln!(f, "  picture   {}", path.display())?;
        }
        if !self.trapped_symbols.is_empty() {
            writeln!(f, "  traps     {}", self.trapped_symbols.join(" "))?;
        }
        for (call, times) in &self.jni_invented {
            writeln!(f, "  invented  {call} ({times}x)")?;
        }
        for violation in &self.violations {
            writeln!(f, "  VIOLATION {violation}")?;
        }
        match &self.failure {
            Some(failure) => writeln!(f, "  FAILED    {failure}"),
            None => writeln!(f, "  completed"),
        }
    }
}
