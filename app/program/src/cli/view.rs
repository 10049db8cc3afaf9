//! `yoro view`: draws what a phone in a Cardboard-compatible viewer shows.

use std::path::PathBuf;
use std::time::Duration;

use anyhow::bail;
use glam::{EulerRot, Quat};

use crate::cli::Subcommand;
use crate::cli::args::{self, GlArgs};
use crate::cli::settings::{Lenses, Renderer, SettingOptions, SettingsArgs};
use crate::cli::terminal::progress_bar;
use yoro_files as files;
use yoro_files::interrupt;
use yoro_gl::{Destination, Filter, Format, RenderTarget};
use yoro_lenses::{Rotation, Screen};
use yoro_media::{PictureError, rgb_image};
use yoro_settings::Settings;
use yoro_viewer::{Cardboard, Event, FrameTiming, HeldHead, SceneState};

/// The refresh rate in Hz of the imagined display.
const REFRESH_HZ: f32 = 60.0;
/// The number of frames after the scene is loaded. The first one decides whether the second one is synthesized.
const FRAMES: u32 = 2;

/// Draw what a phone in a Cardboard-compatible viewer shows: both eyes behind lenses
#[derive(clap::Args, Clone, Debug)]
pub struct ViewArgs {
    /// A built-in scene (see `yoro scenes`), or an OBJ, glTF or GLB file [default: prototype]
    scene: Option<String>,
    /// File for the picture
    #[arg(long, value_name = "FILE")]
    png: PathBuf,
    #[command(flatten)]
    lenses: SettingOptions<Lenses>,
    /// The screen's size in pixels
    #[arg(long, default_value = "2340x1080", value_parser = parse_screen, value_name = "WxH")]
    screen: [u32; 2],
    /// The screen's pixels per inch
    #[arg(long, default_value_t = 420.0, value_parser = args::parse_positive)]
    dpi: f32,
    /// The head's turn to the left in degrees
    #[arg(long, default_value_t = 0.0, allow_hyphen_values = true, value_parser = args::parse_degrees, value_name = "DEGREES")]
    yaw_degrees: f32,
    /// The head's turn upwards in degrees
    #[arg(long, default_value_t = 0.0, allow_hyphen_values = true, value_parser = args::parse_degrees, value_name = "DEGREES")]
    pitch_degrees: f32,
    /// The head's tilt to the left in degrees
    #[arg(long, default_value_t = 0.0, allow_hyphen_values = true, value_parser = args::parse_degrees, value_name = "DEGREES")]
    roll_degrees: f32,
    /// Turn to the left, in degrees, between rendering and display, which timewarp corrects
    #[arg(long, default_value_t = 0.0, allow_hyphen_values = true, value_parser = args::parse_degrees, value_name = "DEGREES")]
    late_yaw_degrees: f32,
    #[command(flatten)]
    renderer: SettingOptions<Renderer>,
    #[command(flatten)]
    settings: SettingsArgs,
    /// What the user does before the picture, in order: `hold` (the menu), `tap`, `press`, `release`, `look:YAW:PITCH`
    /// in degrees, `wait:SECONDS`, `start` (the start screen), `touch:X:Y` (a finger there, 0 to 1 from the upper left)
    #[arg(long = "do", value_name = "ACTION,...", value_delimiter = ',', value_parser = parse_act, allow_hyphen_values = true)]
    acts: Vec<Act>,
    /// Draw the loading screen
    #[arg(long)]
    loading: bool,
    #[command(flatten)]
    gl: GlArgs,
}

impl ViewArgs {
    fn resolve(&self) -> anyhow::Result<Settings> {
        let scene = self.scene.iter().map(|scene| format!("scene={scene}"));
        // A single picture cannot measure which of two methods is cheaper.
        self.settings
            .resolve(Settings::measured(), scene.chain(self.lenses.pairs()).chain(self.renderer.pairs()))
    }

    /// Returns the number of frames that are drawn.
    fn frames(&self) -> u64 {
        let acts: u32 = self.acts.iter().map(|act| act.frames()).sum();
        let last = u32::from(!self.acts.is_empty());
        u64::from(if self.loading { 1 } else { FRAMES + acts + last })
    }

    fn head(&self) -> HeldHead {
        let [yaw, pitch, roll] =
            [self.yaw_degrees, self.pitch_degrees, self.roll_degrees].map(f32::to_radians);
        let rendered = Quat::from_euler(EulerRot::YXZ, yaw, pitch, roll);
        let late = Quat::from_rotation_y(self.late_yaw_degrees.to_radians());
        HeldHead { rendered, displayed: late * rendered }
    }
}

impl Subcommand for ViewArgs {
    /// Draws and writes the picture.
    fn run(&self) -> anyhow::Result<()> {
        if !files::has_extension(&self.png, &["png"]) {
            return Err(PictureError::extension(&self.png, ".png").into());
        }
        let screen = Screen { size: self.screen, dpi: [self.dpi; 2], rotation: Rotation::LandscapeLeft };
        let mut viewer = Cardboard::new(self.resolve()?, screen, &[])?;
        viewer.hold_head(Some(self.head()));
        let headless = self.gl.open()?;
        let gl = headless.gl();
        viewer.attach(gl.clone())?;
        let window = RenderTarget::new(gl, self.screen, &[(Format::Rgba8, Filter::Nearest)], None)?;
        let to = Destination::whole(&window);
        let period_ns = (1e9 / REFRESH_HZ) as i64;
        let mut now_ns = 0;
        let bar = progress_bar(self.frames());
        let mut frame = |viewer: &mut Cardboard| -> anyhow::Result<()> {
            interrupt::check()?;
            bar.inc(1);
            now_ns += period_ns;
            let timing =
                FrameTiming { now_ns, expected_display_ns: now_ns + period_ns, refresh_hz: REFRESH_HZ };
            viewer.frame(&to, &timing)?;
            Ok(())
        };
        if self.loading {
            frame(&mut viewer)?;
        } else {
            wait_for_first_scene(&mut viewer)?;
            for _ in 0..FRAMES {
                frame(&mut viewer)?;
            }
            for act in &self.acts {
                bar.suspend(|| act.begin(&mut viewer, self.screen))?;
                for _ in 0..act.frames() {
                    frame(&mut viewer)?;
                }
                wait_for_other_scene(&mut viewer)?;
            }
            if let Some(kept) = viewer.viewer_mut().take_kept() {
                kept.iter().for_each(|(key, value)| println!("{key}={value}"));
            }
            if !self.acts.is_empty() {
                frame(&mut viewer)?;
            }
        }
        bar.finish_and_clear();
        if let Some(errors) = gl.take_errors() {
            bail!("the GL driver reports {errors}: please report this as a bug");
        }
        let pixels = window.read_rgba8(0, [0, 0], self.screen);
        yoro_media::save_color(&self.png, &rgb_image(&pixels, self.screen))?;
        println!("{}", self.png.display());
        Ok(())
    }
}

/// Waits until the scene is ready to be drawn.
fn wait_for_first_scene(viewer: &mut Cardboard) -> anyhow::Result<()> {
    while viewer.viewer().scene_state() != SceneState::Ready {
        poll_scene(viewer)?;
        if viewer.viewer().scene_state() == SceneState::Failed {
            bail!(viewer.viewer().failure().unwrap_or_default().to_owned());
        }
    }
    Ok(())
}

/// Waits for the scene that an action has requested, if any.
fn wait_for_other_scene(viewer: &mut Cardboard) -> anyhow::Result<()> {
    while viewer.viewer().is_loading() {
        poll_scene(viewer)?;
    }
    Ok(())
}

fn poll_scene(viewer: &mut Cardboard) -> anyhow::Result<()> {
    interrupt::check()?;
    viewer.viewer_mut().poll_scene();
    std::thread::sleep(Duration::from_millis(5));
    Ok(())
}

/// An action of the user.
#[derive(Clone, Copy, Debug)]
enum Act {
    Event(Event),
    /// Turns the head, in radians.
    Look {
        yaw: f32,
        pitch: f32,
    },
    Wait {
        seconds: f32,
    },
    StartScreen,
    /// Touches with a finger at a position from 0 to 1, measured from the upper left.
    Touch {
        x: f32,
        y: f32,
    },
}

impl Act {
    /// Returns the number of frames that the action lasts.
    fn frames(self) -> u32 {
        match self {
            Act::Wait { seconds } => (seconds * REFRESH_HZ).ceil() as u32,
            _ => 1,
        }
    }

    /// Begins the action on a screen of this size in pixels.
    fn begin(self, viewer: &mut Cardboard, screen: [u32; 2]) -> anyhow::Result<()> {
        match self {
            Act::Event(event) => println!("{}", viewer.event(event)?),
            Act::Look { yaw, pitch } => {
                let turn = Quat::from_euler(EulerRot::YXZ, yaw, pitch, 0.0);
                viewer.hold_head(Some(HeldHead { rendered: turn, displayed: turn }));
            }
            Act::StartScreen => {
                viewer.viewer_mut().offer_start_screen();
                println!("{}", viewer.viewer_mut().show_start_screen(""));
            }
            Act::Touch { x, y } => {
                let at = [x * screen[0] as f32, y * screen[1] as f32];
                if let Some(action) = viewer.touch(Some(at))? {
                    println!("{action}");
                }
            }
            Act::Wait { .. } => {}
        }
        Ok(())
    }
}

fn parse_act(text: &str) -> Result<Act, String> {
    let mut parts = text.split(':');
    let name = parts.next().unwrap_or_default();
    let numbers: Vec<f32> =
        parts.filter_map(|part| part.parse().ok().filter(|n: &f32| n.is_finite())).collect();
    match (name, numbers.as_slice()) {
        ("hold", []) => Ok(Act::Event(Event::LongPress)),
        ("tap", []) => Ok(Act::Event(Event::Tap)),
        ("press", []) => Ok(Act::Event(Event::Press)),
        ("release", []) => Ok(Act::Event(Event::Release)),
        ("look", &[yaw, pitch]) => Ok(Act::Look { yaw: yaw.to_radians(), pitch: pitch.to_radians() }),
        ("start", []) => Ok(Act::StartScreen),
        ("touch", &[x, y]) => Ok(Act::Touch { x, y }),
        ("wait", &[seconds]) if (0.0..=60.0).contains(&seconds) => Ok(Act::Wait { seconds }),
        _ => Err(
            "give hold, tap, press, release, look:YAW:PITCH, wait:SECONDS (at most 60), start or touch:X:Y"
                .into(),
        ),
    }
}

fn parse_screen(text: &str) -> Result<[u32; 2], String> {
    let number = |t: &str| t.parse::<u32>().ok().filter(|n| (64..=8192).contains(n));
    text.split_once('x')
        .and_then(|(w, h)| Some([number(w)?, number(h)?]))
        .ok_or_else(|| "give pixels from 64 to 8192, such as 2340x1080".into())
}
