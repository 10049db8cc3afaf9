//! The result of a run, as JSON for tests and as text for people.

use std::collections::BTreeMap;
use std::fmt;

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
    /// The ABI: `x86_64` or `arm64-v8a`.
    pub abi: String,
    /// The path in the APK of the application's library, followed by that of an API layer's.
    pub libraries: Vec<String>,
    /// The reason why the run ended early. `None` if the script was played to its end.
    pub failure: Option<String>,
    /// Number of frames shown.
    pub frames: u64,
    /// Duration in virtual seconds.
    pub seconds: f64,
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
    /// Lines with the tags `YORO` (the application) and `yoro` (the API layer), and all of priority error and above.
    pub log: Vec<LogLine>,
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

/// What went wrong; everything else is in the JSON.
impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{LABEL}: {} ({}), {} frames", self.script, self.abi, self.frames)?;
        for error in &self.gl.errors {
            writeln!(f, "  GL        {error}")?;
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
