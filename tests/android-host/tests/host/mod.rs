//! Runs the simulated Android host and reads its findings.

use std::io::{BufRead as _, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use image::RgbImage;
use yoro_android_host::summary::Summary;

/// The variable by which `cargo xtask test` names the APK.
const APK: &str = "YORO_TEST_APK";
/// The variable that names the OpenXR API layer for Android, an AAR.
const LAYER: &str = "YORO_TEST_ANDROID_LAYER";
/// The variable that names a program that runs the simulated host for arm64.
const ARM64_HOST: &str = "YORO_TEST_ARM64_HOST";

/// Steps after which the scene is in view.
pub const READY: &str = r#"{ wait-log = { text = "triangles", frames = 2000 } }, { frames = 3 }"#;

/// A finished run.
pub struct Run {
    /// The host's findings.
    pub summary: Summary,
    folder: PathBuf,
}

/// Returns a `[device]` with settings as system properties, and more of its keys.
pub fn device(settings: &[(&str, &str)], keys: &str) -> String {
    let properties: String =
        settings.iter().map(|(key, value)| format!("\"debug.yoro.{key}\" = \"{value}\"\n")).collect();
    format!("[device]\n{keys}\n[device.properties]\n{properties}")
}

/// Returns the steps of one of the scripts that come with the host.
pub fn script(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts").join(name);
    let text = std::fs::read_to_string(&path).unwrap();
    let script: toml::Table = text.parse().unwrap();
    let steps = toml::Value::Array(script["steps"].as_array().unwrap().clone()).to_string();
    steps[1..steps.len() - 1].to_owned()
}

/// Plays steps on a device; none, with a loud line, where there is no APK.
pub fn play(name: &str, device: &str, steps: &str) -> Option<Run> {
    let apk = named(APK).or_else(|| left_out(name, "there is no APK", APK, "builds one"))?;
    Some(run(Path::new(env!("CARGO_BIN_EXE_yoro-android-host")), &apk, name, device, steps))
}

/// `yoro serve` of the tests' scene, until this is dropped.
pub struct Server {
    child: Child,
    /// What it prints.
    pub link: String,
}

impl Server {
    /// Starts it; none, with a loud line, where the program was not built.
    pub fn start(name: &str, port: &str) -> Option<Server> {
        let program = Path::new(env!("CARGO_BIN_EXE_yoro-android-host")).with_file_name("yoro");
        let program = program.exists().then_some(program);
        let program =
            program.or_else(|| left_out(name, "there is no program beside the host", "yoro", "builds it"))?;
        // There is no page to be seen.
        let page = folder("page");
        std::fs::create_dir_all(&page).unwrap();
        std::fs::write(page.join("index.html"), "").unwrap();
        let mut child = Command::new(program)
            .args(["serve", "prototype", "--port", port, "--quantizer", "16", "--page"])
            .arg(page)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let first = lines.next().expect("it says where it is").unwrap();
        std::thread::spawn(move || lines.for_each(drop));
        Some(Server { child, link: first.strip_prefix("open ").expect("a link").to_owned() })
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        _ = self.child.kill();
        _ = self.child.wait();
    }
}

/// The folder of a run.
pub fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// Plays steps after the application has started and its scene is in view; then the user leaves. Nothing may go wrong.
pub fn show(name: &str, device: &str, steps: &str) -> Option<Run> {
    let run = play(name, device, &format!(r#""launch", {READY}, {steps}, "quit""#))?;
    run.assert_clean();
    Some(run)
}

/// Plays steps with the APK's arm64 library under qemu; none, with a loud line, where that is impossible.
pub fn play_arm64(name: &str, device: &str, steps: &str) -> Option<Run> {
    let apk = named(APK).or_else(|| left_out(name, "there is no APK", APK, "builds one"))?;
    let remedy = "sets one up where Debian's packages are";
    let host =
        named(ARM64_HOST).or_else(|| left_out(name, "there is no host for arm64", ARM64_HOST, remedy))?;
    Some(run(&host, &apk, name, device, steps))
}

/// The API layer's AAR for an application to carry; none, with a loud line, where there is none.
pub fn layer(name: &str) -> Option<PathBuf> {
    named(LAYER).or_else(|| left_out(name, "there is no API layer", LAYER, "builds one"))
}

/// Returns a file that the environment names.
fn named(variable: &str) -> Option<PathBuf> {
    let path = std::env::var_os(variable)?;
    // Cargo runs tests in the package's folder.
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
    /// The script was played to its end, and nothing was wrong.
    pub fn assert_clean(&self) {
        assert!(self.summary.is_clean(), "{}\n{:#?}", self.summary, self.summary.log);
        let errors: Vec<_> = self.summary.log.iter().filter(|line| line.priority == 'E').collect();
        assert!(errors.is_empty(), "{errors:#?}");
    }

    /// A picture of a `capture` step.
    pub fn picture(&self, name: &str) -> RgbImage {
        image::open(self.folder.join(name)).unwrap().into_rgb8()
    }

    /// Puts another picture beside it, to look at.
    pub fn keep(&self, name: &str, picture: &RgbImage) {
        picture.save(self.folder.join(name)).unwrap();
    }

    /// Returns the folder of the pictures.
    pub fn folder(&self) -> String {
        self.folder.display().to_string()
    }
}
