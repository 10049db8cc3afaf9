//! The layer between Debian's build of Khronos's hello_xr and Monado, alone and with Khronos's validation layer.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use tempfile::TempDir;
use xtask::maintain::monado::{self, Running};

/// The longest duration of a run. Large images can take seconds at times.
const LIMIT: Duration = Duration::from_secs(300);

/// Returns the folder of `cargo xtask maintain hello-xr`, or `None` if the tests are told to skip it.
fn programs() -> Option<PathBuf> {
    let programs = std::env::var_os("YORO_TEST_HELLO_XR").map(PathBuf::from);
    let without = std::env::var_os("YORO_TEST_WITHOUT_HELLO_XR").is_some();
    assert!(
        programs.is_some() || without,
        "set YORO_TEST_HELLO_XR to the folder of `cargo xtask maintain hello-xr`, or YORO_TEST_WITHOUT_HELLO_XR=1"
    );
    programs
}

/// Khronos's layer that checks the calls of applications and other layers.
const VALIDATION: &str = "XR_APILAYER_LUNARG_core_validation";
/// This package's layer that observes the other from below.
const MEASURED: &str = "XR_APILAYER_YORO_measured";

/// Monado's service, in its own folder.
struct Monado {
    programs: PathBuf,
    folder: TempDir,
    _service: Running,
}

impl Monado {
    fn start(programs: PathBuf) -> Monado {
        let folder = tempfile::tempdir().unwrap();
        let service = monado::start(&programs.join("monado-service"), folder.path()).unwrap();
        let monado = Monado { programs, folder, _service: service };
        let folder = std::env::current_exe().unwrap().parent().unwrap().to_owned();
        let layer = folder.join("libyoro_openxr_layer.so");
        let manifest = yoro_openxr_layer::manifest(&layer, yoro_openxr_layer::Kind::Explicit);
        fs::write(monado.folder.path().join(yoro_openxr_layer::MANIFEST), manifest).unwrap();
        monado.add(MEASURED, &folder.join("../examples/libmeasured.so"));
        monado.add(VALIDATION, &monado.validation());
        monado
    }

    /// Returns the path of the validation layer's library, which may not exist.
    fn validation(&self) -> PathBuf {
        let libraries = self.programs.join("root/usr/lib/x86_64-linux-gnu");
        libraries.join("openxr/1/api_layers/libXrApiLayer_core_validation.so")
    }

    /// Adds another layer where the loader finds it.
    fn add(&self, name: &str, library: &Path) {
        let manifest = serde_json::json!({ "file_format_version": "1.0.0", "api_layer": {
            "name": name, "library_path": library, "api_version": "1.1", "implementation_version": "1",
            "description": name,
        }});
        fs::write(self.folder.path().join(format!("{name}.json")), manifest.to_string()).unwrap();
    }

    /// Runs hello_xr until it is `done`, judged by its output and the files in the folder. Returns its output.
    fn hello(&self, run: &Hello, folder: &Path, done: impl Fn(&str) -> bool) -> String {
        fs::create_dir(folder).unwrap();
        let mut child = self.start_hello(run, folder, done);
        let text = || output(folder);
        drop(child.0.stdin.take());
        let start = Instant::now();
        while child.0.try_wait().unwrap().is_none() {
            assert!(start.elapsed() < LIMIT, "hello_xr does not end: {}", text());
            thread::sleep(Duration::from_millis(50));
        }
        assert!(child.0.wait().unwrap().success(), "{}", text());
        text()
    }

    /// Starts hello_xr, and waits until it is `done`.
    fn start_hello(&self, run: &Hello, folder: &Path, done: impl Fn(&str) -> bool) -> Running {
        let file = fs::File::create(folder.join("log")).unwrap();
        let child = Command::new(self.programs.join("hello_xr"))
            .args(["-g", "Vulkan2", "-vc", run.views])
            .env("XDG_RUNTIME_DIR", self.folder.path())
            .env("XDG_CONFIG_HOME", self.folder.path())
            .env("XDG_STATE_HOME", self.folder.path())
            .env("XR_API_LAYER_PATH", self.folder.path())
            .env("XR_ENABLE_API_LAYERS", run.layers.join(":"))
            .env("XR_CORE_VALIDATION_EXPORT_TYPE", "text")
            .env("XR_CORE_VALIDATION_FILE_NAME", folder.join("validation"))
            .envs(run.environment.iter().map(|(name, value)| (*name, value)))
            // It ends when a key is pressed or its input ends.
            .stdin(Stdio::piped())
            .stdout(file.try_clone().unwrap())
            .stderr(file)
            .spawn()
            .unwrap();
        let mut child = Running(child);
        let text = || output(folder);
        let start = Instant::now();
        while !done(&text()) {
            assert_eq!(child.0.try_wait().unwrap(), None, "hello_xr has ended: {}", text());
            assert!(start.elapsed() < LIMIT, "hello_xr takes too long: {}", text());
            thread::sleep(Duration::from_millis(100));
        }
        child
    }
}

/// A run of hello_xr.
struct Hello<'a> {
    /// `Mono` or `Stereo`.
    views: &'static str,
    /// Names of layers, beginning with the one nearest to the application.
    layers: &'a [&'a str],
    environment: Vec<(&'static str, OsString)>,
}

/// Returns the output so far.
fn output(folder: &Path) -> String {
    String::from_utf8_lossy(&fs::read(folder.join("log")).unwrap()).into_owned()
}

/// True if a folder contains pictures of both eyes.
fn has_pictures(folder: &Path) -> bool {
    ["left.png", "right.png"].iter().all(|name| folder.join(name).exists())
}

/// Returns the number of synthesized frames, from the lines of the log.
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

/// Runs of hello_xr with one view and with two, at the same moment of the world.
struct Run {
    /// Output with one view and with two.
    one: String,
    two: String,
    /// Folders of pictures.
    mono: PathBuf,
    stereo: PathBuf,
}

/// Runs hello_xr with two views and with one, at this size per eye if given.
fn run_both(monado: &Monado, folder: &Path, size: Option<&str>) -> Run {
    fs::create_dir(folder).unwrap();
    // Any moment since the service began will do. The time since boot is that of CLOCK_MONOTONIC.
    let uptime = fs::read_to_string("/proc/uptime").unwrap();
    let seconds: f64 = uptime.split(' ').next().unwrap().parse().unwrap();
    let time = format!("{}", (seconds * 1e9) as u64);
    let [mono, stereo] = ["mono", "stereo"].map(|name| folder.join(name));
    let run = |views, folder: &Path, frames| {
        let mut environment: Vec<(&'static str, OsString)> =
            vec![("YORO_MEASURED_TIME", time.clone().into()), ("YORO_MEASURED_PICTURES", folder.into())];
        environment.extend(size.map(|size| ("YORO_MEASURED_SIZE", size.into())));
        let run = Hello { views, layers: &[yoro_openxr_layer::NAME, MEASURED], environment };
        monado.hello(&run, folder, |log| has_pictures(folder) && synthesized(log) >= frames)
    };
    let (two, one) = (run("Stereo", &stereo, 0), run("Mono", &mono, if size.is_some() { 0 } else { 100 }));
    Run { one, two, mono, stereo }
}

/// Runs hello_xr with one view and with two. Returns the PSNR in dB of the dominant eye's images, of the other eye's
/// images, and of the same image shown to both eyes.
fn compared(monado: &Monado, size: Option<&str>) -> ([f64; 3], Run) {
    let run = run_both(monado, &monado.folder.path().join("compared"), size);
    let [mono_left, mono_right] = ["left", "right"].map(|eye| picture(&run.mono, eye));
    let [left, right] = ["left", "right"].map(|eye| picture(&run.stereo, eye));
    ([psnr(&mono_right, &right), psnr(&mono_left, &left), psnr(&mono_right, &left)], run)
}

/// An unmodified application renders one view, and the runtime receives two. One is as the application would have
/// rendered it. The other is much closer to what it would have rendered than the same image for both eyes.
#[test]
fn monado_gets_two_views_of_one_that_hello_xr_renders() {
    let Some(programs) = programs() else { return };
    let monado = Monado::start(programs);
    // hello_xr asks for the size before a session exists.
    let run = Hello { views: "Mono", layers: &[yoro_openxr_layer::NAME], environment: Vec::new() };
    let first = monado.hello(&run, &monado.folder.path().join("first"), |log| synthesized(log) > 0);
    assert!(first.contains("dimensions Width=400 Height=240"), "the estimate: {first}");
    let ([own, made, same], Run { one, two, .. }) = compared(&monado, None);
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
    // The second start knows the size: the union of both frusta and the guard band, beyond Monado's 320 columns.
    assert!(one.contains("dimensions Width=331 Height=240"), "{one}");

    println!(
        "the dominant eye: {own:.2} dB; synthesized: {made:.2} dB; the same image for both eyes: {same:.2} dB"
    );
    // Rounded angles may move pixels at silhouettes.
    assert!(own > 35.0, "the dominant eye's image has changed: {own} dB");
    assert!(made > same + 6.0, "{made} dB, and the same image {same} dB");
}

/// Khronos's validation layer reports nothing, neither above nor below the layer. A killed application leaves nothing
/// behind.
#[test]
fn hello_xr_is_valid_above_and_below_the_layer() {
    let Some(programs) = programs() else { return };
    let monado = Monado::start(programs);
    let folder = monado.folder.path();
    if monado.validation().exists() {
        for layers in [[VALIDATION, yoro_openxr_layer::NAME], [yoro_openxr_layer::NAME, VALIDATION]] {
            let run = Hello { views: "Mono", layers: &layers, environment: Vec::new() };
            let files = folder.join(layers[0]);
            let log = monado.hello(&run, &files, |log| synthesized(log) >= 10);
            let said = fs::read_to_string(files.join("validation")).unwrap();
            assert!(said.contains("Core Validation Layer will be destroyed"), "{said}");
            let worse = |line: &&str| line.contains("[VALID_") && !line.contains("[VALID_DEBUG");
            assert_eq!(said.lines().find(worse), None, "{layers:?}: {log}");
        }
    } else {
        println!("SKIPPED: Khronos's validation layer for OpenXR is not here");
    }

    let temporary = folder.join("temporary");
    fs::create_dir(&temporary).unwrap();
    let left = || -> BTreeSet<PathBuf> {
        let folders = [folder, &temporary].map(|folder| fs::read_dir(folder).unwrap());
        folders.into_iter().flatten().map(|entry| entry.unwrap().path()).collect()
    };
    let environment = vec![("TMPDIR", temporary.clone().into_os_string())];
    let run = Hello { views: "Mono", layers: &[yoro_openxr_layer::NAME], environment };
    let killed = folder.join("killed");
    fs::create_dir(&killed).unwrap();
    let before = left();
    let child = monado.start_hello(&run, &killed, |log| synthesized(log) >= 10);
    drop(child);
    assert_eq!(left().difference(&before).next(), None);
    monado.hello(&run, &folder.join("next"), |log| synthesized(log) >= 10);
}

/// Returns the median.
fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Returns the numbers between two texts, from each line that contains both.
fn numbers<'a>(log: &'a str, before: &'a str, after: &'a str) -> impl Iterator<Item = f64> + 'a {
    log.lines().filter_map(move |line| line.split_once(before)?.1.split_once(after)?.0.parse().ok())
}

/// Measures hello_xr's frame time with two views, and with one view and the layer, alternately, and writes a picture:
/// `cargo test --release -p yoro-openxr-layer hello_xr_measured -- --ignored --nocapture`.
#[test]
#[ignore = "measures for some minutes"]
fn hello_xr_measured() {
    const ROUNDS: usize = 5;
    let Some(programs) = programs() else { return };
    let monado = Monado::start(programs);
    for (size, seconds) in [("320x240", 5), ("1680x1760", 20)] {
        let (mut times, mut synthesis) = ([vec![], vec![]], vec![]);
        for round in 0..ROUNDS {
            let both = [("Stereo", &[MEASURED][..]), ("Mono", &[yoro_openxr_layer::NAME, MEASURED])];
            for (i, (views, layers)) in both.into_iter().enumerate() {
                let environment =
                    vec![("YORO_MEASURED_SIZE", size.into()), ("VK_LOADER_LAYERS_DISABLE", "~all~".into())];
                let (run, start) = (Hello { views, layers, environment }, Instant::now());
                let files = monado.folder.path().join(format!("{size}-{round}-{i}"));
                let log = monado.hello(&run, &files, |_| start.elapsed() > Duration::from_secs(seconds));
                times[i].push(numbers(&log, "measured: ", " ms").next().unwrap_or_else(|| panic!("{log}")));
                synthesis.extend(numbers(&log, " synthesized in ", " ms of GPU time"));
            }
        }
        println!("{size}, two views, one and the layer: {times:.2?}");
        let [two, one] = times.map(|mut times| median(&mut times));
        let synthesis = median(&mut synthesis);
        println!("{size}: {two:.2} ms, {one:.2} ms (synthesis {synthesis:.2} ms), ratio {:.2}", one / two);
    }
    let (db, run) = compared(&monado, Some("1680x1760"));
    println!("the dominant eye, synthesized, the same image for both: {db:.2?} dB");
    let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hello-xr");
    fs::create_dir_all(&place).unwrap();
    let [rendered, left, right] = ["rendered", "left", "right"].map(|name| picture(&run.mono, name));
    let [own_left, own_right] = ["left", "right"].map(|name| picture(&run.stereo, name));
    let mut error = left.clone();
    for (error, own) in error.iter_mut().zip(own_left.iter()) {
        *error = error.abs_diff(*own).saturating_mul(8);
    }
    let all = [
        ("rendered", &rendered),
        ("left", &left),
        ("right", &right),
        ("own-left", &own_left),
        ("own-right", &own_right),
        ("error", &error),
    ];
    for (name, picture) in all {
        picture.save(place.join(format!("{name}.png"))).unwrap();
    }
    // The rendered view, both eyes and the error, in a row.
    const HEIGHT: u32 = 440;
    let small = [&rendered, &left, &right, &error].map(|picture| {
        let width = picture.width() * HEIGHT / picture.height();
        image::imageops::resize(picture, width, HEIGHT, image::imageops::FilterType::Triangle)
    });
    let width = small.iter().map(|picture| picture.width() + 8).sum::<u32>() - 8;
    let mut row = image::RgbImage::from_pixel(width, HEIGHT, image::Rgb([255; 3]));
    let mut x = 0;
    for picture in &small {
        image::imageops::replace(&mut row, picture, x, 0);
        x += i64::from(picture.width()) + 8;
    }
    row.save(place.join("row.png")).unwrap();
    println!("{}", place.display());
}

/// Returns the PSNR in dB over all channels. With the lab's metrics these tests would have to compile that crate.
fn psnr(a: &image::RgbImage, b: &image::RgbImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let squares = a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2));
    10.0 * (255.0f64.powi(2) * a.as_raw().len() as f64 / squares.sum::<f64>()).log10()
}
