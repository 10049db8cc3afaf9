//! The result of a run, as JSON for tests and as text for people.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// A part of every output, so that no figure is taken for a device's.
pub const LABEL: &str = "simulated Android host";

/// Result of a run.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Summary {
    /// Always [`LABEL`].
    pub host: String,
    /// The script's name.
    pub script: String,
    /// The APK.
    pub apk: PathBuf,
    /// `x86_64` or `arm64-v8a`.
    pub abi: String,
    /// The application's library, as loaded, and after it an API layer's.
    pub libraries: Vec<LibraryFacts>,
    /// The reason why the run ended early; absent if the script was played to its end.
    pub failure: Option<String>,
    /// Frames shown.
    pub frames: u64,
    /// Virtual seconds.
    pub seconds: f64,
    /// Real seconds. They measure this machine and its CPU rasterizer, not a phone.
    pub real_seconds: f64,
    /// Real milliseconds of the longest callback on the main thread.
    pub longest_callback_ms: f64,
    /// OpenGL ES.
    pub gl: GlFacts,
    /// Resources in use at the marks, the last one at the end of the run.
    pub marks: Vec<Mark>,
    /// Input events.
    pub input: InputFacts,
    /// Things that Android forbids or punishes and that the application did.
    pub violations: Vec<String>,
    /// Unknown JNI calls, answered by a new object of the type, zero or false.
    pub jni_invented: BTreeMap<String, u64>,
    /// Requests for the device's performance, with the number of times each was made.
    pub requests: BTreeMap<String, u64>,
    /// Symbols that the libraries import and that are answered by a trap.
    pub trapped_symbols: Vec<String>,
    /// Files written by `capture`.
    pub captures: Vec<PathBuf>,
    /// The number of lines that each tag logged, errors apart.
    pub log_counts: BTreeMap<String, u64>,
    /// Lines of the tags `YORO`, the application's, and `yoro`, the API layer's, and every line of priority error and
    /// above.
    pub log: Vec<LogLine>,
}

/// A library in the APK.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct LibraryFacts {
    /// Path in the APK.
    pub name: String,
    /// Bytes.
    pub size: u64,
    /// Libraries it names.
    pub needed: Vec<String>,
    /// Imported symbols that were bound.
    pub symbols: usize,
    /// Relocations applied.
    pub relocations: usize,
    /// Smallest alignment of a LOAD segment.
    pub alignment: u64,
}

/// OpenGL ES.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct GlFacts {
    /// `GL_VERSION` of the last context.
    pub version: String,
    /// `GL_RENDERER` of the last context.
    pub renderer: String,
    /// Contexts made.
    pub contexts: u64,
    /// Times that the application waited for a fence.
    pub waits: u64,
    /// Errors as the driver words them, with the frame; the first fifty.
    pub errors: Vec<String>,
    /// All errors.
    pub error_count: u64,
}

/// Input events.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct InputFacts {
    /// Sent.
    pub sent: u64,
    /// Finished by the application.
    pub finished: u64,
    /// Finished as handled.
    pub handled: u64,
}

/// Resources in use.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
pub struct Mark {
    /// The mark's name.
    pub name: String,
    /// Frames shown so far.
    pub frames: u64,
    /// Virtual seconds.
    pub seconds: f64,
    /// Live GL objects by kind.
    pub gl_objects: BTreeMap<String, u64>,
    /// EGL contexts not destroyed.
    pub egl_contexts: u64,
    /// EGL surfaces not destroyed.
    pub egl_surfaces: u64,
    /// References to native windows held.
    pub window_references: i64,
    /// Loopers, sensor queues and other NDK objects not released.
    pub ndk_objects: BTreeMap<String, i64>,
    /// JNI references of all kinds.
    pub jni_references: u64,
    /// Open file descriptors of the process.
    pub file_descriptors: u64,
    /// Threads of the process, Mesa's included.
    pub threads: u64,
    /// Resident memory of the process, KiB, Mesa included.
    pub resident_kib: u64,
}

impl Mark {
    /// Returns everything that must not grow from cycle to cycle, memory apart, as one line of text.
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
    /// Virtual seconds.
    pub seconds: f64,
    /// Frames shown so far.
    pub frame: u64,
    /// `V`, `D`, `I`, `W`, `E`, `F`.
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
