//! The script of a run, in TOML: the device, and the steps that happen to the application.
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
//! The key `steps = ["launch", { frames = 10 }, { capture = "boot.png" }, "quit"]` comes before the first table.
//! Unknown keys are errors.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

/// A device, and what happens to it.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Script {
    /// The name in the summary.
    pub name: String,
    /// The device at power-on.
    #[serde(default)]
    pub device: Device,
    /// The steps in order.
    pub steps: Vec<Step>,
}

impl Script {
    /// Reads a script.
    ///
    /// # Errors
    /// Fails if the file cannot be read, is not TOML, or contains an unknown key, step or value.
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path)
            .with_context(|| format!("cannot read the script {}: check the path", path.display()))?;
        toml::from_str(&text).with_context(|| format!("the script {} cannot be played", path.display()))
    }
}

/// The simulated device and the values that it reports.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Device {
    /// Width of the window in pixels, in landscape.
    pub width: i32,
    /// Height of the window in pixels.
    pub height: i32,
    /// Width and height of the display's mode in pixels, if the user has selected another size for the window. By
    /// default those of the window.
    pub mode: Option<[i32; 2]>,
    /// Number of refreshes after which a frame is visible, according to the choreographer's timeline.
    pub refreshes_ahead: u32,
    /// Seconds that the device has slept since its boot. CLOCK_BOOTTIME, the clock of the sensors, is ahead of
    /// CLOCK_MONOTONIC by this time.
    pub slept_seconds: f64,
    /// Features that the package manager reports, with their versions.
    pub features: BTreeMap<String, i32>,
    /// API level. `dlsym` does not find newer functions.
    pub sdk: i32,
    /// The newest OpenGL ES version that contexts can have.
    pub gles: GlesVersion,
    /// True if the device has two gyroscopes, one of them uncalibrated, and an accelerometer.
    pub sensors: bool,
    /// The battery, or `None` for a device without one.
    pub battery: Option<Battery>,
    /// Thermal state.
    pub thermal: Thermal,
    /// System properties.
    pub properties: BTreeMap<String, String>,
    /// Extras of the intent that starts the activity. All are strings, as given by `am start --es`.
    pub extras: BTreeMap<String, String>,
    /// Starts the activity for a game loop, as Firebase Test Lab does.
    pub game_loop: Option<GameLoop>,
    /// Text files in the application's external folder, by relative path.
    pub files: BTreeMap<String, String>,
    /// The picture that the camera sees, or `None` for a device without a camera.
    pub camera: Option<PathBuf>,
    /// A headset, whose runtime broker names the simulated OpenXR runtime. Without it, no broker answers.
    pub openxr: Option<OpenXr>,
}

/// The intent that starts a game loop.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct GameLoop {
    /// The extra `scenario`.
    pub scenario: i32,
    /// The file in the intent's data, if there is one.
    pub results: Option<PathBuf>,
}

/// A headset's OpenXR runtime, which is the library of `tests/openxr-stub`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct OpenXr {
    /// The runtime's own script, in JSON.
    pub script: PathBuf,
    /// True if the broker that names it is the system's rather than one installed by the user.
    #[serde(default)]
    pub system: bool,
    /// The AAR of an API layer that the application contains, together with a loader that inserts it.
    #[serde(default)]
    pub layer: Option<PathBuf>,
}

impl Default for Device {
    fn default() -> Self {
        Self {
            width: 320,
            height: 180,
            mode: None,
            refreshes_ahead: 2,
            slept_seconds: 0.0,
            features: BTreeMap::new(),
            sdk: 36,
            gles: GlesVersion::Es32,
            sensors: true,
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

/// A version of OpenGL ES.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
pub enum GlesVersion {
    /// 2.0.
    #[serde(rename = "2.0")]
    Es20,
    /// 3.0, which has no compute shaders.
    #[serde(rename = "3.0")]
    Es30,
    /// 3.2, the newest version of Mesa.
    #[serde(rename = "3.2")]
    Es32,
}

impl GlesVersion {
    /// Returns the major and the minor number.
    pub fn numbers(self) -> (i32, i32) {
        match self {
            Self::Es20 => (2, 0),
            Self::Es30 => (3, 0),
            Self::Es32 => (3, 2),
        }
    }
}

/// Values of `BatteryManager` and of the sticky intent `ACTION_BATTERY_CHANGED`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Battery {
    /// Level in percent.
    pub level: i32,
    /// Voltage in millivolts.
    pub millivolts: i32,
    /// Temperature in tenths of a degree Celsius.
    pub decidegrees: i32,
    /// `EXTRA_PLUGGED`: 0 on battery, 1 AC, 2 USB, 4 wireless.
    pub plugged: i32,
    /// `EXTRA_STATUS`: 2 charging, 3 discharging, 4 not charging, 5 full.
    pub status: i32,
    /// `BATTERY_PROPERTY_CURRENT_NOW` in microamperes if to specification, negative while discharging. `None` if
    /// unsupported.
    pub current_now: Option<i32>,
    /// `BATTERY_PROPERTY_CHARGE_COUNTER` in microampere-hours. `None` if unsupported.
    pub charge_counter: Option<i32>,
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
            charge_counter: Some(3_317_000),
        }
    }
}

/// Values of `AThermal` and `PowerManager`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Thermal {
    /// Thermal status from 0 (none) to 6 (shutdown).
    pub status: i32,
    /// Thermal headroom. 1.0 is severe throttling.
    pub headroom: f32,
}

impl Default for Thermal {
    fn default() -> Self {
        Self { status: 0, headroom: 0.42 }
    }
}

/// A step of the script.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Step {
    /// The steps by which the system starts an activity: `create`, `start`, `resume`, `input-queue`, `window`, `focus`.
    Launch,
    /// The steps by which the system ends an activity: `unfocus`, `pause`, `window-lost`, `stop`, `destroy`.
    Quit,
    /// `ANativeActivity_onCreate`, with the state returned by the last `save-state`.
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
    /// Changes the window's size, with `onNativeWindowResized` and `onContentRectChanged`.
    Resize {
        /// Width in pixels.
        width: i32,
        /// Height in pixels.
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
    /// `onDestroy`. Waits for the end of `android_main`.
    Destroy,
    /// `onLowMemory`.
    LowMemory,
    /// `onConfigurationChanged`.
    ConfigurationChanged,
    /// Shows this many frames.
    Frames(u64),
    /// Shows frames for this many virtual seconds.
    Seconds(f64),
    /// Shows frames until a log line contains the text, starting behind the line that the previous such step found.
    WaitLog {
        /// The text.
        text: String,
        /// Number of frames after which the run fails.
        frames: u64,
    },
    /// Shows frames until the application asks to be finished.
    WaitFinish {
        /// Number of frames after which the run fails.
        frames: u64,
    },
    /// Lets this many virtual seconds pass while the application shows nothing, because it is paused or has no window.
    Idle(f64),
    /// A finger touches the screen for 80 ms.
    Tap {
        /// Horizontal position, from 0 at the left to 1 at the right.
        #[serde(default = "half")]
        x: f32,
        /// Vertical position, from 0 at the top to 1 at the bottom.
        #[serde(default = "half")]
        y: f32,
    },
    /// A finger touches the screen for a longer time.
    LongPress {
        /// Horizontal position, from 0 at the left to 1 at the right.
        #[serde(default = "half")]
        x: f32,
        /// Vertical position, from 0 at the top to 1 at the bottom.
        #[serde(default = "half")]
        y: f32,
        /// Time that the finger stays, in virtual seconds.
        #[serde(default = "long_press_seconds")]
        seconds: f64,
    },
    /// Presses and releases a key.
    Key(Key),
    /// Turns the head to an orientation relative to the start. The angles are applied in the order yaw, pitch, roll.
    Head {
        /// Yaw in degrees, positive to the left.
        #[serde(default)]
        yaw: f32,
        /// Pitch in degrees, positive upwards.
        #[serde(default)]
        pitch: f32,
        /// Roll in degrees, positive to the left.
        #[serde(default)]
        roll: f32,
        /// Duration of the movement in virtual seconds. Frames are shown meanwhile.
        seconds: f64,
        /// True if the next steps happen while the head moves.
        #[serde(default)]
        go_on: bool,
    },
    /// Changes the battery's values.
    Battery(Battery),
    /// Removes the battery.
    BatteryMissing,
    /// Changes the thermal state, and calls its listeners.
    Thermal(Thermal),
    /// Makes the camera see another picture.
    Camera(PathBuf),
    /// Lets another application take the camera, which must be open.
    CameraLost,
    /// Answers whether the application may use the camera, as the user.
    Permission(bool),
    /// Shares something from another application, in the intent of the next `create`.
    Share(Share),
    /// Sets a system property.
    Property {
        /// The property's name.
        name: String,
        /// The new value. An empty one removes the property.
        value: String,
    },
    /// Makes the current EGL context lost at the next swap.
    ContextLoss,
    /// Writes the frame that is about to be shown as a PNG with this name in the output folder.
    Capture(PathBuf),
    /// Records the resources in use under this name.
    Mark(String),
    /// Repeats steps.
    Repeat {
        /// The number of times.
        times: u32,
        /// The steps.
        steps: Vec<Step>,
    },
    /// Random sequences of valid events. Each starts in the state in which the previous one has ended.
    Random {
        /// Seed of the events.
        seed: u64,
        /// The number of sequences.
        sequences: u32,
        /// Maximum number of events in each sequence.
        events: u32,
    },
}

fn half() -> f32 {
    0.5
}

fn long_press_seconds() -> f64 {
    0.8
}

/// Something that is shared: either a text or a file.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Share {
    /// The extra `android.intent.extra.TEXT`.
    pub text: Option<String>,
    /// The file that the content resolver opens.
    pub file: Option<PathBuf>,
    /// Virtual seconds that the file's owner takes to open it.
    pub after: f64,
    /// True to share by `ACTION_VIEW` and the intent's data, false to share by `ACTION_SEND` and its extras.
    pub view: bool,
}

/// A key of a phone or a headset, with its `AKEYCODE_*` constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Key {
    /// KEYCODE_VOLUME_UP.
    VolumeUp = 24,
    /// KEYCODE_VOLUME_DOWN.
    VolumeDown = 25,
    /// KEYCODE_HEADSETHOOK, the button of wired remote controls.
    Headset = 79,
    /// KEYCODE_DPAD_CENTER, the trigger of some VR viewers.
    DpadCenter = 23,
    /// KEYCODE_ENTER.
    Enter = 66,
    /// KEYCODE_MENU.
    Menu = 82,
    /// KEYCODE_BUTTON_A.
    ButtonA = 96,
}
