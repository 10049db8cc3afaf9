//! Runs the simulated Android host, and reads its results.

use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::Command;

use image::RgbImage;
use yoro_android_host::summary::Summary;

/// The variable in which `cargo xtask test` passes the APK.
const APK: &str = "YORO_TEST_APK";
/// The variable with the AAR of the OpenXR API layer for Android.
const LAYER: &str = "YORO_TEST_ANDROID_LAYER";
/// The variable with a program that runs the simulated host for arm64.
const ARM64_HOST: &str = "YORO_TEST_ARM64_HOST";

/// Steps after which the scene is visible.
pub const READY: &str = r#"{ wait-log = { text = "triangles", frames = 2000 } }, { frames = 3 }"#;

/// A finished run.
pub struct Run {
    /// The host's summary.
    pub summary: Summary,
    folder: PathBuf,
}

/// Returns a `[device]` with settings as system properties, and with further keys.
pub fn device(settings: &[(&str, &str)], keys: &str) -> String {
    let properties: String =
        settings.iter().map(|(key, value)| format!("\"debug.yoro.{key}\" = \"{value}\"\n")).collect();
    format!("[device]\n{keys}\n[device.properties]\n{properties}")
}

/// Returns the steps of one of the scripts supplied with the host.
pub fn script(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts").join(name);
    let text = std::fs::read_to_string(&path).unwrap();
    let script: toml::Table = text.parse().unwrap();
    let steps = toml::Value::Array(script["steps"].as_array().unwrap().clone()).to_string();
    steps[1..steps.len() - 1].to_owned()
}

/// Plays steps on a device. Prints a message and returns `None` if there is no APK.
pub fn play(name: &str, device: &str, steps: &str) -> Option<Run> {
    let apk = named(APK).or_else(|| left_out(name, "there is no APK", APK, "builds one"))?;
    Some(run(Path::new(env!("CARGO_BIN_EXE_yoro-android-host")), &apk, name, device, steps))
}

/// Returns a file of the APK's assets. Prints a message and returns `None` if there is no APK.
pub fn asset(test: &str, name: &str) -> Option<String> {
    let apk = named(APK).or_else(|| left_out(test, "there is no APK", APK, "builds one"))?;
    let mut archive = zip::ZipArchive::new(std::fs::File::open(apk).unwrap()).unwrap();
    let mut text = String::new();
    archive.by_name(&format!("assets/{name}")).unwrap().read_to_string(&mut text).unwrap();
    Some(text)
}

/// Returns the folder of a run.
fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// Starts the application, plays steps once the scene is visible, and leaves. The run must be clean.
pub fn show(name: &str, device: &str, steps: &str) -> Option<Run> {
    let run = play(name, device, &format!(r#""launch", {READY}, {steps}, "quit""#))?;
    run.assert_clean();
    Some(run)
}

/// Plays steps with the APK's arm64 library under qemu. Prints a message and returns `None` if this is not possible.
pub fn play_arm64(name: &str, device: &str, steps: &str) -> Option<Run> {
    let apk = named(APK).or_else(|| left_out(name, "there is no APK", APK, "builds one"))?;
    let remedy = "sets one up where Debian's packages are";
    let host =
        named(ARM64_HOST).or_else(|| left_out(name, "there is no host for arm64", ARM64_HOST, remedy))?;
    Some(run(&host, &apk, name, device, steps))
}

/// Returns the AAR of the API layer for an application. Prints a message and returns `None` if there is none.
pub fn layer(name: &str) -> Option<PathBuf> {
    named(LAYER).or_else(|| left_out(name, "there is no API layer", LAYER, "builds one"))
}

/// Returns the path of a file in an environment variable.
fn named(variable: &str) -> Option<PathBuf> {
    let path = std::env::var_os(variable)?;
    // Cargo runs tests in the package's folder, so the path is relative to the workspace.
    Some(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path))
}

fn left_out<T>(name: &str, reason: &str, variable: &str, remedy: &str) -> Option<T> {
    // Not eprintln!, which the test harness captures.
    let line = format!("LEFT OUT: {name}: {reason} ({variable} is not set); `cargo xtask test` {remedy}\n");
    _ = std::io::stderr().write_all(line.as_bytes());
    None
}

fn run(host: &Path, apk: &Path, name: &str, device: &str, steps: &str) -> Run {
    let folder = folder(name);
    _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let script = folder.join("script.toml");
    std::fs::write(&script, format!("name = \"{name}\"\nsteps = [{steps}]\n{device}")).unwrap();
    let output = Command::new(host).arg(apk).arg(&script).arg("--out").arg(&folder).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    let summary = std::fs::read(folder.join("summary.json"))
        .unwrap_or_else(|error| panic!("{name}: no summary ({error}): {text}"));
    Run { summary: serde_json::from_slice(&summary).unwrap(), folder }
}

impl Run {
    /// Checks that the script was played to its end without any errors.
    pub fn assert_clean(&self) {
        assert!(self.summary.is_clean(), "{}\n{:#?}", self.summary, self.summary.log);
        let errors: Vec<_> = self.summary.log.iter().filter(|line| line.priority == 'E').collect();
        assert!(errors.is_empty(), "{errors:#?}");
    }

    /// Returns the picture of a `capture` step.
    pub fn picture(&self, name: &str) -> RgbImage {
        image::open(self.folder.join(name)).unwrap().into_rgb8()
    }

    /// Saves another picture in the same folder, to look at.
    pub fn keep(&self, name: &str, picture: &RgbImage) {
        picture.save(self.folder.join(name)).unwrap();
    }

    /// Returns the folder of the pictures.
    pub fn folder(&self) -> String {
        self.folder.display().to_string()
    }
}
