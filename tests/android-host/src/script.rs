//! The script of a run as TOML: the device, and the steps that happen to the application.
//!
//! ```toml
//! name = "boot"
//!
//! [device]
//! width = 320
//! height = 180
//!
//! [device.properties]
//! "debug.yoro.scene" = "prototype"
//! ```
//!
//! followed or preceded by `steps = ["launch", { frames = 10 }, { capture = "boot.png" }, "quit"]`. Unknown keys are
//! errors.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};

/// A device and its events.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Script {
    /// Shown in the summary.
    pub name: String,
    /// Real seconds for which one step, or one callback of the activity, may stand still before the run fails; it may
    /// use 20 times as much processor time.
    #[serde(default = "default_timeout")]
    pub patience_seconds: f64,
    /// The device at power-on.
    #[serde(default)]
    pub device: Device,
    /// The steps, in order.
    pub steps: Vec<Step>,
}

fn default_timeout() -> f64 {
    60.0
}

impl Script {
    /// Reads a script and refuses one that cannot be played.
    ///
    /// # Errors
    /// The file cannot be read, is not TOML, or holds an unknown key, step or value.
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path)
            .with_context(|| format!("cannot read the script {}: check the path", path.display()))?;
        Self::parse(&text).with_context(|| format!("the script {} cannot be played", path.display()))
    }

    /// Reads a script from text.
    ///
    /// # Errors
    /// Those of [`Script::read`].
    pub fn parse(text: &str) -> Result<Self> {
        let script: Self = toml::from_str(text)?;
        let device = &script.device;
        if !(1..=8192).contains(&device.width) || !(1..=8192).contains(&device.height) {
            bail!(
                "device.width and device.height must lie between 1 and 8192, not {}x{}",
                device.width,
                device.height
            );
        }
        if !(device.refresh_hz >= 1.0 && device.refresh_hz <= 1000.0) {
            bail!("device.refresh_hz must lie between 1 and 1000, not {}", device.refresh_hz);
        }
        for path in device.files.keys() {
            if Path::new(path).components().any(|part| !matches!(part, std::path::Component::Normal(_))) {
                bail!("device.files names \"{path}\": use a relative path without `..`");
            }
        }
        Ok(script)
    }
}

/// The simulated device and its answers.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Device {
    /// Window, pixels, landscape.
    pub width: i32,
    /// Window, pixels.
    pub height: i32,
    /// Logical density (`AConfiguration_getDensity`), dots per inch.
    pub density: i32,
    /// Physical pixels per inch (`DisplayMetrics.xdpi`).
    pub xdpi: f32,
    /// Physical pixels per inch (`DisplayMetrics.ydpi`).
    pub ydpi: f32,
    /// The display's refresh rate, Hz; virtual time advances by one period per frame.
    pub refresh_hz: f64,
    /// Pixels of the display's mode if the user has chosen another size for the window; absent: those of the window.
    pub mode: Option<[i32; 2]>,
    /// Refreshes after which the choreographer's timeline says that a frame is seen.
    pub refreshes_ahead: u32,
    /// Seconds that the device has slept since its boot: CLOCK_BOOTTIME, the sensors' clock, is ahead of
    /// CLOCK_MONOTONIC by them.
    pub slept_seconds: f64,
    /// Features that the package manager says are there, with their versions.
    pub features: BTreeMap<String, i32>,
    /// True if sustained performance mode is offered.
    pub sustained_performance: bool,
    /// API level. Newer functions are not found by `dlsym`.
    pub sdk: i32,
    /// The newest OpenGL ES version that a context can have.
    pub gles: GlesVersion,
    /// Sensors that the device has.
    pub sensors: Vec<SensorKind>,
    /// Battery; absent for a device without one.
    pub battery: Option<Battery>,
    /// Thermal state.
    pub thermal: Thermal,
    /// System properties.
    pub properties: BTreeMap<String, String>,
    /// Extras of the intent that starts the activity; all are strings, as `am start --es` gives them.
    pub extras: BTreeMap<String, String>,
    /// The activity is started for a game loop, as Firebase Test Lab does.
    pub game_loop: Option<GameLoop>,
    /// Text files in the application's external folder, by relative path.
    pub files: BTreeMap<String, String>,
    /// The picture that the camera sees; absent for a device without one.
    pub camera: Option<PathBuf>,
    /// A headset: a runtime broker names the simulated OpenXR runtime. Without it no broker answers.
    pub openxr: Option<OpenXr>,
}

/// What starts a game loop.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct GameLoop {
    /// The extra `scenario`.
    pub scenario: i32,
    /// The file that the intent's data names; absent: it names none.
    pub results: Option<PathBuf>,
}

/// A headset's OpenXR runtime, the library of `tests/openxr-stub`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct OpenXr {
    /// The runtime's own script, in JSON.
    pub script: PathBuf,
    /// The broker that names it is the system's, not one that a user has installed.
    #[serde(default)]
    pub system: bool,
    /// An API layer that the application carries, by its AAR, with a loader that puts it between.
    #[serde(default)]
    pub layer: Option<PathBuf>,
}

impl Default for Device {
    fn default() -> Self {
        Self {
            width: 320,
            height: 180,
            // A phone's screen, 110 mm wide, with few pixels.
            density: 160,
            xdpi: 74.0,
            ydpi: 74.0,
            refresh_hz: 60.0,
            mode: None,
            refreshes_ahead: 2,
            slept_seconds: 0.0,
            features: BTreeMap::new(),
            sustained_performance: true,
            sdk: 36,
            gles: GlesVersion::Es32,
            sensors: vec![
                SensorKind::GyroscopeUncalibrated,
                SensorKind::Gyroscope,
                SensorKind::Accelerometer,
            ],
            battery: Some(Battery::default()),
            thermal: Thermal::default(),
            properties: BTreeMap::new(),
            extras: BTreeMap::new(),
            game_loop: None,
            files: BTreeMap::new(),
            camera: None,
            openxr: None,
        }
    }
}

/// Newest version of OpenGL ES.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
pub enum GlesVersion {
    /// 2.0.
    #[serde(rename = "2.0")]
    Es20,
    /// 3.0: no compute shaders.
    #[serde(rename = "3.0")]
    Es30,
    /// 3.1.
    #[serde(rename = "3.1")]
    Es31,
    /// 3.2, Mesa's own version.
    #[serde(rename = "3.2")]
    Es32,
}

impl GlesVersion {
    /// Major and minor number.
    pub fn numbers(self) -> (i32, i32) {
        match self {
            Self::Es20 => (2, 0),
            Self::Es30 => (3, 0),
            Self::Es31 => (3, 1),
            Self::Es32 => (3, 2),
        }
    }
}

/// A sensor that can be scripted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SensorKind {
    /// Type 1.
    Accelerometer,
    /// Type 4.
    Gyroscope,
    /// Type 16.
    GyroscopeUncalibrated,
}

/// Answers of `BatteryManager` and of the sticky intent `ACTION_BATTERY_CHANGED`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Battery {
    /// Percent.
    pub level: i32,
    /// Millivolts.
    pub millivolts: i32,
    /// Tenths of a degree Celsius.
    pub decidegrees: i32,
    /// `EXTRA_PLUGGED`: 0 on battery, 1 AC, 2 USB, 4 wireless.
    pub plugged: i32,
    /// `EXTRA_STATUS`: 2 charging, 3 discharging, 4 not charging, 5 full.
    pub status: i32,
    /// `BATTERY_PROPERTY_CURRENT_NOW`, microamperes by specification, negative when discharging; absent: unsupported.
    pub current_now: Option<i32>,
    /// `BATTERY_PROPERTY_CURRENT_AVERAGE`, microamperes; absent: unsupported.
    pub current_average: Option<i32>,
    /// `BATTERY_PROPERTY_CHARGE_COUNTER`, microampere-hours; absent: unsupported.
    pub charge_counter: Option<i32>,
    /// `BATTERY_PROPERTY_ENERGY_COUNTER`, nanowatt-hours; absent: unsupported.
    pub energy_counter: Option<i64>,
}

impl Default for Battery {
    fn default() -> Self {
        Self {
            level: 83,
            millivolts: 3921,
            decidegrees: 314,
            plugged: 0,
            status: 3,
            current_now: Some(-512_000),
            current_average: None,
            charge_counter: Some(3_317_000),
            energy_counter: None,
        }
    }
}

/// Answers of `AThermal` and `PowerManager`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Thermal {
    /// 0 none to 6 shutdown.
    pub status: i32,
    /// 1.0 is severe.
    pub headroom: f32,
}

impl Default for Thermal {
    fn default() -> Self {
        Self { status: 0, headroom: 0.42 }
    }
}

/// One step of the script.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Step {
    /// `create`, `start`, `resume`, `input-queue`, `window` and `focus`, as the system starts an activity.
    Launch,
    /// The steps of the system when the user leaves for good: `unfocus`, `pause`, `window-lost`, `stop`, `destroy`.
    Quit,
    /// `ANativeActivity_onCreate`, with the state that the last `save-state` gave.
    Create,
    /// `onStart`.
    Start,
    /// `onResume`.
    Resume,
    /// `onInputQueueCreated`.
    InputQueue,
    /// `onNativeWindowCreated`, then `onContentRectChanged` and `onNativeWindowRedrawNeeded`.
    Window,
    /// `onNativeWindowDestroyed`.
    WindowLost,
    /// The window changes its size, with `onNativeWindowResized` and `onContentRectChanged`.
    Resize {
        /// Pixels.
        width: i32,
        /// Pixels.
        height: i32,
    },
    /// `onWindowFocusChanged(1)`.
    Focus,
    /// `onWindowFocusChanged(0)`.
    Unfocus,
    /// `onPause`.
    Pause,
    /// `onSaveInstanceState`.
    SaveState,
    /// `onStop`.
    Stop,
    /// `onDestroy`; the end of `android_main` is awaited.
    Destroy,
    /// `onLowMemory`.
    LowMemory,
    /// `onConfigurationChanged`.
    ConfigurationChanged,
    /// Shows that many frames.
    Frames(u64),
    /// Shows frames for that many virtual seconds.
    Seconds(f64),
    /// Frames are shown until a log line contains the text, one after the line that such a step waited for before.
    WaitLog {
        /// A part of the line.
        text: String,
        /// Frames after which the run fails.
        frames: u64,
    },
    /// Frames are shown until the application asks for its end.
    WaitFinish {
        /// Frames after which the run fails.
        frames: u64,
    },
    /// The application shows nothing (no window, paused): virtual time passes all the same.
    Idle(f64),
    /// A finger touches and leaves after 80 ms.
    Tap {
        /// The position from the left, 0 to 1.
        #[serde(default = "half")]
        x: f32,
        /// The position from the top, 0 to 1.
        #[serde(default = "half")]
        y: f32,
    },
    /// A finger stays for a time.
    LongPress {
        /// The position from the left, 0 to 1.
        #[serde(default = "half")]
        x: f32,
        /// The position from the top, 0 to 1.
        #[serde(default = "half")]
        y: f32,
        /// Virtual seconds.
        #[serde(default = "long_press_seconds")]
        seconds: f64,
    },
    /// A key goes down and up.
    Key(Key),
    /// The head turns to an orientation, relative to the start: yaw to the left, then pitch up, then roll to the left.
    Head {
        /// Degrees.
        #[serde(default)]
        yaw: f32,
        /// Degrees.
        #[serde(default)]
        pitch: f32,
        /// Degrees.
        #[serde(default)]
        roll: f32,
        /// Virtual seconds that the movement takes; frames are shown meanwhile.
        seconds: f64,
        /// The next steps come while the head moves.
        #[serde(default)]
        go_on: bool,
    },
    /// The battery answers differently from now on.
    Battery(Battery),
    /// The battery is gone.
    BatteryMissing,
    /// The thermal state is another; listeners are called.
    Thermal(Thermal),
    /// The camera sees another picture.
    Camera(PathBuf),
    /// Another application takes the camera, which is open.
    CameraLost,
    /// The user answers the question whether the application may use the camera.
    Permission(bool),
    /// Another application shares something: the intent of the next `create`.
    Share(Share),
    /// A system property has a new value.
    Property {
        /// Its name.
        name: String,
        /// Its new value; empty removes it.
        value: String,
    },
    /// The current EGL context is lost at the next swap.
    ContextLoss,
    /// The frame that is about to be shown becomes a PNG of this name in the output folder.
    Capture(PathBuf),
    /// Resources in use are noted under this name.
    Mark(String),
    /// Steps several times.
    Repeat {
        /// The number of times.
        times: u32,
        /// The steps.
        steps: Vec<Step>,
    },
    /// Random sequences of valid events. Each begins in the state in which the one before ended.
    Random {
        /// Same seed, same events.
        seed: u64,
        /// The number of sequences.
        sequences: u32,
        /// Events in each, at most.
        events: u32,
    },
}

fn half() -> f32 {
    0.5
}

fn long_press_seconds() -> f64 {
    0.8
}

/// Something shared: either a text or a file.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Share {
    /// The extra `android.intent.extra.TEXT`.
    pub text: Option<String>,
    /// The file that the content resolver opens.
    pub file: Option<PathBuf>,
    /// Virtual seconds that its owner takes to open it.
    pub after: f64,
    /// By `ACTION_VIEW` and the intent's data; otherwise by `ACTION_SEND` and its extras.
    pub view: bool,
}

/// A key of a phone or a headset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Key {
    /// KEYCODE_BACK.
    Back,
    /// KEYCODE_VOLUME_UP.
    VolumeUp,
    /// KEYCODE_VOLUME_DOWN.
    VolumeDown,
    /// KEYCODE_HEADSETHOOK, the button of wired remotes.
    Headset,
    /// KEYCODE_DPAD_CENTER, the trigger of some viewers.
    DpadCenter,
    /// KEYCODE_ENTER.
    Enter,
    /// KEYCODE_MENU.
    Menu,
    /// KEYCODE_BUTTON_A.
    ButtonA,
}

impl Key {
    /// `AKEYCODE_*`.
    pub fn code(self) -> i32 {
        match self {
            Self::Back => 4,
            Self::VolumeUp => 24,
            Self::VolumeDown => 25,
            Self::Headset => 79,
            Self::DpadCenter => 23,
            Self::Enter => 66,
            Self::Menu => 82,
            Self::ButtonA => 96,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_script_is_read() {
        let script = Script::parse(
            r#"
            name = "x"
            steps = ["launch", { frames = 3 }, { tap = {} }, { key = "volume-up" }, { head = { yaw = 30, seconds = 0.5 } },
                { repeat = { times = 2, steps = ["pause", "resume"] } }, { capture = "a.png" }, "quit"]
            [device]
            width = 64
            gles = "3.0"
            sensors = ["accelerometer"]
            [device.battery]
            level = 5
            [device.properties]
            "debug.yoro.scene" = "talk"
            "#,
        )
        .unwrap();
        assert_eq!(script.device.width, 64);
        assert_eq!(script.device.gles, GlesVersion::Es30);
        assert_eq!(script.device.battery.unwrap().level, 5);
        assert!(matches!(script.steps[1], Step::Frames(3)));
        assert!(matches!(script.steps[2], Step::Tap { x: 0.5, .. }));
        assert!(matches!(&script.steps[5], Step::Repeat { times: 2, steps } if steps.len() == 2));
    }

    #[test]
    fn mistakes_are_named() {
        let refused = |text: &str| format!("{:#}", Script::parse(text).unwrap_err());
        assert!(refused("name='x'\nsteps=['fly']").contains("fly"));
        assert!(refused("name='x'\nsteps=[]\n[device]\nwidht=3").contains("widht"));
        assert!(refused("name='x'\nsteps=[]\n[device]\nwidth=0").contains("between 1 and 8192"));
        assert!(refused("name='x'\nsteps=[]\n[device.files]\n'../x'='y'").contains("relative"));
    }
}
