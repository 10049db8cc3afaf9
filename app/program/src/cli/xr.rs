//! `yoro xr`: shows a scene in a headset, with any OpenXR runtime.

use std::fmt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{anyhow, bail, ensure};
use serde::Serialize;

use crate::cli::Subcommand;
use crate::cli::args::{self, GlArgs};
use crate::cli::settings::{self, HeadsetRenderer, SettingOptions, SettingsArgs};
use crate::cli::terminal::progress_bar;
use yoro::eyes::{Eye, EyePair};
use yoro_context::HeadlessGraphics;
use yoro_files as files;
use yoro_files::interrupt;
use yoro_render::stereo::MethodChoice;
use yoro_settings::Settings;
use yoro_settings::telemetry::DeviceState;
use yoro_settings::telemetry::stats::median;
use yoro_viewer::openxr::runtime::{self, NoBroker, Runtime, RuntimeSource};
use yoro_viewer::openxr::{Capture, Description, Frame, Headset, Options, Step};
use yoro_viewer::render_settings;
use yoro_viewer::{SceneState, Viewer};

/// The pause before polling a runtime again that wants no frame.
const PAUSE: Duration = Duration::from_millis(5);
/// The longest time without a frame if `--frames` is given.
const TIMEOUT: Duration = Duration::from_secs(30);

/// Show a scene in a headset, by any OpenXR runtime with XR_MNDX_egl_enable
#[derive(clap::Args, Clone, Debug)]
pub struct XrArgs {
    /// A built-in scene (see `yoro scenes`), or an OBJ, glTF or GLB file [default: prototype]
    scene: Option<String>,
    /// The runtime: its manifest (.json), or a loader library; otherwise XR_RUNTIME_JSON or the system's own
    #[arg(long, value_name = "FILE")]
    runtime: Option<PathBuf>,
    /// Stop after this many frames of the scene with each method [default: run until Ctrl-C]
    #[arg(long, value_parser = args::whole::<u32>(1..=u32::MAX), value_name = "N")]
    frames: Option<u32>,
    /// The stereo methods, one after the other with --frames [default: yoro with --frames, else auto]
    #[arg(long = "method", value_parser = settings::value_of::<MethodChoice>("method"), value_delimiter = ',', value_name = "METHODS")]
    methods: Vec<MethodChoice>,
    /// Write the last frame of each method, as the runtime gets it, to this folder
    #[arg(long, value_name = "FOLDER", requires = "frames")]
    capture: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Render one view instead of two, if the runtime or an API layer offers that (setting `one-view`)
    #[arg(long)]
    mono: bool,
    #[command(flatten)]
    renderer: SettingOptions<HeadsetRenderer>,
    #[command(flatten)]
    settings: SettingsArgs,
    #[command(flatten)]
    gl: GlArgs,
}

impl XrArgs {
    fn resolve(&self) -> anyhow::Result<Settings> {
        let scene = self.scene.as_ref().map(|scene| format!("scene={scene}"));
        let method = self.methods.first().map(|method| format!("method={}", method.name()));
        let one_view = self.mono.then(|| "one-view=true".to_owned());
        let named = scene.into_iter().chain(method).chain(one_view);
        let defaults = if self.frames.is_some() { Settings::measured() } else { Settings::default() };
        self.settings.resolve(defaults, named.chain(self.renderer.pairs()))
    }

    fn find_runtime(&self) -> anyhow::Result<Runtime> {
        let places = match &self.runtime {
            None => runtime::linux_places(|name| std::env::var_os(name)),
            Some(file) => {
                ensure!(
                    file.exists(),
                    "there is no runtime {}: give its manifest or a loader",
                    file.display()
                );
                let is_manifest = files::has_extension(file, &["json"]);
                vec![if is_manifest {
                    RuntimeSource::Manifest(file.clone())
                } else {
                    RuntimeSource::Loader(file.clone())
                }]
            }
        };
        // Where it was looked for is for those who have installed one.
        runtime::find(&places, &NoBroker, None).map_err(|error| {
            log::info!("{error}");
            match &self.runtime {
                None if error.nothing_installed() => anyhow!(
                    "no OpenXR runtime is installed here: install one (headset.md), or name its manifest or library with --runtime FILE"
                ),
                None => anyhow!("{error}; name another with --runtime FILE"),
                Some(_) => error.into(),
            }
        })
    }
}

/// The cost of a method, and its last frame.
#[derive(Clone, Debug, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
struct MethodSummary {
    method: String,
    frames: u32,
    /// Medians in milliseconds: this program's thread, and the GPU if it can be measured.
    cpu_ms: Option<f64>,
    gpu_ms: Option<f64>,
    /// Frames per second, from the times at which the runtime expects the frames to be seen.
    fps: Option<f64>,
    stale: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    capture: Option<Captured>,
}

/// The last frame of a method.
#[derive(Clone, Debug, Serialize)]
struct Captured {
    left: PathBuf,
    right: PathBuf,
    /// The poses and frusta of the eyes in the scene.
    eyes: EyePair,
}

#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
struct XrSummary {
    found: String,
    #[serde(flatten)]
    description: Description,
    scene: String,
    states: Vec<String>,
    restarts: u32,
    /// Frames without images, which the runtime requests while the headset is not worn.
    empty_frames: u32,
    methods: Vec<MethodSummary>,
}

/// The measured frames of one method.
#[derive(Default)]
struct Collected {
    frames: u32,
    cpu_ms: Vec<f64>,
    gpu_ms: Vec<f64>,
    /// The display times of the first and the last frame, in nanoseconds.
    shown_ns: Option<[i64; 2]>,
    stale: u32,
    captured: Option<Captured>,
}

impl Collected {
    fn add(&mut self, frame: &Frame, now_ns: i64) {
        self.frames += 1;
        // This many samples are enough for any median. The limit keeps sessions of hours from using ever more memory.
        if self.cpu_ms.len() < 10_000 {
            self.cpu_ms.push(frame.cpu_ms);
            self.gpu_ms.extend(frame.report.and_then(|report| report.gpu_ms).map(f64::from));
        }
        self.shown_ns = Some([self.shown_ns.map_or(now_ns, |[first, _]| first), now_ns]);
        self.stale += frame.report.map_or(0, |report| report.late_refreshes);
    }

    fn summary(self, method: MethodChoice) -> MethodSummary {
        let seconds = self.shown_ns.map_or(0.0, |[first, last]| (last - first) as f64 * 1e-9);
        MethodSummary {
            method: method.name().into(),
            frames: self.frames,
            cpu_ms: median(&self.cpu_ms),
            gpu_ms: median(&self.gpu_ms),
            fps: (seconds > 0.0).then(|| f64::from(self.frames - 1) / seconds),
            stale: self.stale,
            capture: self.captured,
        }
    }
}

impl Subcommand for XrArgs {
    /// Shows the scene until the user, the runtime or `--frames` ends it.
    fn run(&self) -> anyhow::Result<()> {
        let settings = self.resolve()?;
        let runtime = self.find_runtime()?;
        let found = runtime.found().to_string();
        log::info!("{found}");
        if let Some(folder) = &self.capture {
            files::create_folder(folder)?;
        }
        let headless = self.gl.open()?;
        let gl = headless.gl();
        for method in &self.methods {
            render_settings(&settings, None).supports(method.first(), gl.capabilities())?;
        }
        let mut viewer = Viewer::new(settings, &[])?;
        viewer.attach(gl.clone())?;
        let graphics = HeadlessGraphics::new(&headless)?;
        let mut headset = Headset::open(runtime, &graphics, gl, viewer, Options::default())?;
        let run = show(self, &graphics, &mut headset);
        let summary = run.map(|(methods, empty_frames)| XrSummary {
            found,
            description: headset.description().clone(),
            scene: headset.viewer().scene_name().to_owned(),
            states: headset.states().to_vec(),
            restarts: headset.restarts(),
            empty_frames,
            methods,
        });
        // Framebuffers are deleted while the context is still current.
        drop(headset);
        let summary = summary?;
        if let Some(errors) = gl.take_errors() {
            bail!("the GL driver reports {errors}: please report this as a bug");
        }
        if self.json {
            println!("{}", serde_json::to_string_pretty(&summary)?);
        } else {
            print!("{summary}");
        }
        Ok(())
    }
}

fn show(
    args: &XrArgs,
    graphics: &HeadlessGraphics,
    headset: &mut Headset,
) -> anyhow::Result<(Vec<MethodSummary>, u32)> {
    let mut methods =
        if args.methods.is_empty() { vec![headset.viewer().method()] } else { args.methods.clone() };
    if args.frames.is_none() {
        methods.truncate(1);
    }
    let mut waiting = methods.clone().into_iter();
    let mut method = waiting.next().unwrap_or(headset.viewer().method());
    let bar = args.frames.map(|frames| progress_bar(u64::from(frames) * methods.len() as u64));
    let (mut summaries, mut empty_frames) = (Vec::new(), 0);
    let mut collected = Collected::default();
    let (mut is_over, mut last_frame) = (false, Instant::now());
    loop {
        if (interrupt::requested() || is_over) && !headset.is_exiting() {
            headset.request_exit();
        }
        let frame = match headset.step(graphics)? {
            Step::Ended => break,
            Step::Idle => {
                pause(last_frame, args.frames.is_some() && !is_over)?;
                continue;
            }
            Step::Frame(frame) => frame,
        };
        last_frame = Instant::now();
        let viewer = headset.viewer_mut();
        let Some(report) = frame.report else {
            empty_frames += 1;
            continue;
        };
        if report.scene == SceneState::Failed {
            bail!(viewer.failure().unwrap_or_default().to_owned());
        }
        if report.telemetry_due {
            log::info!("{}", viewer.telemetry(viewer.now_ns(), &DeviceState::default()));
        }
        is_over |= report.session_over;
        if is_over || report.scene != SceneState::Ready {
            continue;
        }
        if args.frames.is_none() && viewer.method() != method {
            // The method was changed with a controller.
            summaries.push(std::mem::take(&mut collected).summary(method));
            method = viewer.method();
        }
        collected.add(&frame, viewer.now_ns());
        if let Some(bar) = &bar {
            bar.inc(1);
        }
        if let (Some(folder), Some(capture)) = (&args.capture, &frame.capture) {
            collected.captured = Some(write(folder, method, capture)?);
        }
        let Some(wanted) = args.frames else { continue };
        let is_captured = args.capture.is_none() || collected.captured.is_some();
        if collected.frames + 1 >= wanted && !is_captured {
            headset.capture();
        }
        if collected.frames < wanted || !is_captured {
            continue;
        }
        summaries.push(std::mem::take(&mut collected).summary(method));
        match waiting.next() {
            Some(next) => {
                method = next;
                let viewer = headset.viewer_mut();
                viewer.configure(Settings { method, ..viewer.settings().clone() }, &[])?;
            }
            None => is_over = true,
        }
    }
    if let Some(bar) = bar {
        bar.finish_and_clear();
    }
    if collected.frames > 0 {
        summaries.push(collected.summary(method));
    }
    check_end(args.frames, methods.len(), &summaries)?;
    Ok((summaries, empty_frames))
}

/// Pauses when a runtime wants no frame, and fails after [`TIMEOUT`] if frames are `wanted`.
fn pause(last_frame: Instant, wanted: bool) -> anyhow::Result<()> {
    ensure!(
        !wanted || last_frame.elapsed() <= TIMEOUT,
        "the OpenXR runtime has wanted no frame for {} s: put the headset on, or look into its log",
        TIMEOUT.as_secs()
    );
    std::thread::sleep(PAUSE);
    Ok(())
}

/// Refuses a session that ended before each of `methods` methods had its frames.
fn check_end(frames: Option<u32>, methods: usize, summaries: &[MethodSummary]) -> anyhow::Result<()> {
    let Some(frames) = frames else { return Ok(()) };
    if summaries.len() == methods && summaries.iter().all(|s| s.frames >= frames) {
        return Ok(());
    }
    if interrupt::requested() {
        bail!("interrupted before the last frame")
    } else {
        bail!("the OpenXR runtime has ended the session before the last frame")
    }
}

fn write(folder: &Path, method: MethodChoice, capture: &Capture) -> anyhow::Result<Captured> {
    let path = |eye: Eye| folder.join(format!("{}.{}.png", method.name(), eye.name()));
    for (eye, pixels) in Eye::BOTH.into_iter().zip(&capture.eyes) {
        yoro_media::save_color(&path(eye), &yoro_media::rgb_image(pixels, capture.pair.size))?;
    }
    Ok(Captured { left: path(Eye::Left), right: path(Eye::Right), eyes: capture.pair })
}

impl fmt::Display for XrSummary {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let d = &self.description;
        let [w, h] = d.size;
        writeln!(f, "runtime   {} ({})", d.runtime, self.found)?;
        writeln!(f, "system    {}", d.system)?;
        writeln!(
            f,
            "views     {}, {w}x{h} pixels each, {}, depth {}",
            d.views,
            d.format,
            d.depth.as_deref().unwrap_or("none")
        )?;
        writeln!(f, "states    {}", self.states.join(" "))?;
        if self.restarts > 0 {
            writeln!(f, "sessions  {}", self.restarts + 1)?;
        }
        writeln!(f, "scene     {}", self.scene)?;
        writeln!(
            f,
            "\n{:<22}{:>8}{:>10}{:>10}{:>8}{:>8}",
            "method", "frames", "CPU ms", "GPU ms", "FPS", "stale"
        )?;
        let number = |value: Option<f64>| value.map_or("na".to_owned(), |value| format!("{value:.2}"));
        for m in &self.methods {
            writeln!(
                f,
                "{:<22}{:>8}{:>10}{:>10}{:>8}{:>8}",
                m.method,
                m.frames,
                number(m.cpu_ms),
                number(m.gpu_ms),
                number(m.fps),
                m.stale
            )?;
        }
        for captured in self.methods.iter().filter_map(|m| m.capture.as_ref()) {
            writeln!(f, "{}\n{}", captured.left.display(), captured.right.display())?;
        }
        Ok(())
    }
}
