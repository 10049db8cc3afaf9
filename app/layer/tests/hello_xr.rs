//! The layer between Khronos's hello_xr, as Debian has it, and Monado.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use tempfile::TempDir;

/// No run takes this long.
const LIMIT: Duration = Duration::from_secs(90);

/// The folder of `cargo xtask hello-xr`; None where the tests are told to do without.
fn programs() -> Option<PathBuf> {
    let programs = std::env::var_os("YORO_TEST_HELLO_XR").map(PathBuf::from);
    let without = std::env::var_os("YORO_TEST_WITHOUT_HELLO_XR").is_some();
    assert!(
        programs.is_some() || without,
        "set YORO_TEST_HELLO_XR to the folder of `cargo xtask hello-xr`, or YORO_TEST_WITHOUT_HELLO_XR=1"
    );
    programs
}

/// Killed when it is dropped.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        self.0.kill().ok();
        self.0.wait().ok();
    }
}

/// Monado's service, in a folder of its own.
struct Monado {
    programs: PathBuf,
    folder: TempDir,
    _service: Running,
}

impl Monado {
    fn start(programs: PathBuf) -> Monado {
        let folder = tempfile::tempdir().unwrap();
        let log = fs::File::create(folder.path().join("service.log")).unwrap();
        let service = Command::new(programs.join("monado-service"))
            .env("XDG_RUNTIME_DIR", folder.path())
            .stdin(Stdio::null())
            .stdout(log.try_clone().unwrap())
            .stderr(log)
            .spawn()
            .unwrap();
        let mut service = Running(service);
        let start = Instant::now();
        while !folder.path().join("monado_comp_ipc").exists() {
            assert_eq!(service.0.try_wait().unwrap(), None, "Monado's service has ended");
            assert!(start.elapsed() < LIMIT, "Monado's service does not begin");
            thread::sleep(Duration::from_millis(50));
        }
        let library = std::env::current_exe().unwrap().with_file_name("libyoro_layer.so");
        let manifest = yoro_layer::manifest(&library, false);
        fs::write(folder.path().join(yoro_layer::MANIFEST), manifest).unwrap();
        Monado { programs, folder, _service: service }
    }

    /// Runs hello_xr through the layer, at one moment of the world's, until there are pictures of both eyes in the folder,
    /// and so many frames were synthesized; its output.
    fn hello(&self, views: &str, time: &str, pictures: &Path, frames: u64) -> String {
        fs::create_dir(pictures).unwrap();
        let log = pictures.join("log");
        let file = fs::File::create(&log).unwrap();
        let child = Command::new(self.programs.join("hello_xr"))
            .args(["-g", "Vulkan2", "-vc", views])
            .env("XDG_RUNTIME_DIR", self.folder.path())
            .env("XDG_CONFIG_HOME", self.folder.path())
            .env("XR_API_LAYER_PATH", self.folder.path())
            .env("XR_ENABLE_API_LAYERS", yoro_layer::NAME)
            .env("YORO_LAYER_TIME", time)
            .env("YORO_LAYER_CAPTURE", pictures)
            // It ends with the first key that is pressed, or with the end of its input.
            .stdin(Stdio::piped())
            .stdout(file.try_clone().unwrap())
            .stderr(file)
            .spawn()
            .unwrap();
        let mut child = Running(child);
        let text = || String::from_utf8_lossy(&fs::read(&log).unwrap()).into_owned();
        let start = Instant::now();
        let done = |text: &str| {
            ["left.png", "right.png"].iter().all(|name| pictures.join(name).exists())
                && synthesized(text) >= frames
        };
        while !done(&text()) {
            assert_eq!(child.0.try_wait().unwrap(), None, "hello_xr has ended: {}", text());
            assert!(start.elapsed() < LIMIT, "hello_xr takes too long: {}", text());
            thread::sleep(Duration::from_millis(100));
        }
        drop(child.0.stdin.take());
        let start = Instant::now();
        while child.0.try_wait().unwrap().is_none() {
            assert!(start.elapsed() < LIMIT, "hello_xr does not end: {}", text());
            thread::sleep(Duration::from_millis(50));
        }
        assert!(child.0.wait().unwrap().success(), "{}", text());
        text()
    }
}

/// How many frames the lines of the log say were synthesized.
fn synthesized(log: &str) -> u64 {
    let each = log.lines().filter_map(|line| {
        let (before, _) = line.strip_prefix("yoro layer: ")?.split_once(" synthesized in ")?;
        before.rsplit(' ').next()?.parse::<u64>().ok()
    });
    each.sum()
}

fn picture(folder: &Path, eye: &str) -> image::RgbImage {
    image::open(folder.join(format!("{eye}.png"))).unwrap().to_rgb8()
}

/// So often at most the two runs are made.
const TRIES: usize = 8;

/// hello_xr rendering one view, and both, at one moment of the world.
struct Run {
    /// Output.
    one: String,
    two: String,
    /// Folders of pictures.
    mono: PathBuf,
    stereo: PathBuf,
}

fn run_both(monado: &Monado, folder: &Path) -> Run {
    fs::create_dir(folder).unwrap();
    // Any moment of the monotonic clock since the service began: what CLOCK_MONOTONIC is now, from the time since boot.
    let uptime = fs::read_to_string("/proc/uptime").unwrap();
    let seconds: f64 = uptime.split(' ').next().unwrap().parse().unwrap();
    let time = format!("{}", (seconds * 1e9) as u64);
    let [mono, stereo] = ["mono", "stereo"].map(|name| folder.join(name));
    let two = monado.hello("Stereo", &time, &stereo, 0);
    let one = monado.hello("Mono", &time, &mono, 100);
    Run { one, two, mono, stereo }
}

/// An unmodified application renders one view, and the runtime gets two: the one it would have rendered itself, and
/// one that is much closer to the other one that it would have rendered than the same image for both eyes is.
#[test]
fn monado_gets_two_views_of_one_that_hello_xr_renders() {
    let Some(programs) = programs() else { return };
    let monado = Monado::start(programs);
    // hello_xr draws a cube at the origin of LOCAL space, which Monado puts where its swaying head is when a session begins:
    // around the eyes, where it is not seen, or beside them. Only runs that have it in the same place compare.
    let compare = |run: &Run| {
        let [mono_left, mono_right] = ["left", "right"].map(|eye| picture(&run.mono, eye));
        let [left, right] = ["left", "right"].map(|eye| picture(&run.stereo, eye));
        [psnr(&mono_right, &right), psnr(&mono_left, &left), psnr(&mono_right, &left)]
    };
    let agrees = |[own, made, same]: [f64; 3]| own > 35.0 && made > same + 6.0;
    let tries = (0..TRIES).map(|i| run_both(&monado, &monado.folder.path().join(i.to_string())));
    let mut compared = tries.map(|run| (compare(&run), run));
    let first = compared.next().unwrap();
    let found = if agrees(first.0) { None } else { compared.find(|(db, _)| agrees(*db)) };
    let ([own, made, same], Run { one, two, .. }) = found.unwrap_or(first);
    for log in [&one, &two] {
        assert!(log.contains("->XR_SESSION_STATE_FOCUSED"), "{log}");
        assert!(!log.contains("VUID-"), "{log}");
        assert!(!log.contains("[Error"), "{log}");
    }
    assert!(one.contains("yoro layer: HelloXR: renders one view; the left eye is synthesized"), "{one}");
    assert!(!one.contains("the same image for both eyes"), "{one}");
    let end = one.lines().find(|line| line.contains("session ended after")).unwrap();
    assert!(end.ends_with(" synthesized, 0 not"), "{end}");
    assert!(
        two.contains("yoro layer: HelloXR: passed through: it begins its session with PRIMARY_STEREO"),
        "{two}"
    );
    // The union of both frusta and the guard band beside Monado's 320 columns, not the estimate.
    assert!(one.contains("dimensions Width=331 Height=240"), "{one}");

    println!(
        "the dominant eye: {own:.2} dB; synthesized: {made:.2} dB; the same image for both eyes: {same:.2} dB"
    );
    // Angles are rounded on their way: a silhouette's pixel may fall to the other side.
    assert!(own > 35.0, "the dominant eye's image has changed: {own} dB");
    assert!(made > same + 6.0, "{made} dB, and the same image {same} dB");
}

/// In dB, over all channels. Not the metrics of yoro-lab: a layer's tests need not wait for all that comes with them.
fn psnr(a: &image::RgbImage, b: &image::RgbImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let squares = a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2));
    10.0 * (255.0f64.powi(2) * a.as_raw().len() as f64 / squares.sum::<f64>()).log10()
}
