//! What the simulated headset does: a JSON file, named by the environment variable [`VARIABLE`].

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// The environment variable that names the script's file. Without it the headset is that of [`Script::default`].
pub const VARIABLE: &str = "YORO_OPENXR_STUB";

/// A headset, and what happens to it. Frames are counted from 0 by `xrWaitFrame`, over all sessions of the process, and from
/// the first whose left view is not of one colour: until then it is frame 0, however long a scene takes to load.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Script {
    /// Where the log goes, as JSON lines; it is appended to.
    pub log: Option<PathBuf>,
    /// Extensions that are not offered, of all those that the stub knows.
    pub missing_extensions: Vec<String>,
    /// No headset is connected: `xrGetSystem` says so this many times.
    pub unavailable: u32,
    /// Formats of swapchains as GL or Vulkan numbers, the preferred one first.
    pub formats: Vec<i64>,
    /// `PRIMARY_STEREO` is offered.
    pub stereo: bool,
    /// `PRIMARY_MONO` is offered.
    pub mono: bool,
    /// Left, right. A mono configuration has the left one, without its offset.
    pub eyes: [Eye; 2],
    /// Distance of the eyes in metres, each from a frame on.
    pub ipd: Vec<(u32, f32)>,
    /// The head's position above the floor's centre, in metres.
    pub position: [f32; 3],
    /// How far the head is turned to the left, in degrees.
    pub yaw_degrees: f32,
    /// How far it turns in each frame.
    pub yaw_per_frame_degrees: f32,
    /// Frames in which the head's pose is not known.
    pub untracked: Vec<u32>,
    /// Frames in which the views' quaternions are not of unit length but of this one, although they are said to be valid.
    pub quaternion_lengths: Vec<(u32, f32)>,
    /// Asked with an instance for a function that needs none, `xrGetInstanceProcAddr` succeeds and gives none.
    pub no_globals: bool,
    /// The first frame that is to be rendered in a session, counted from its first.
    pub should_render_from: u32,
    /// Rates of the display in hertz; the first is the one it begins with.
    pub refresh_rates: Vec<f32>,
    /// Events and losses.
    pub events: Vec<Event>,
    /// Results instead of calls.
    pub faults: Vec<Fault>,
    /// The controllers' profile; none: no controllers.
    pub profile: Option<String>,
    /// What the controllers' parts are set to, each from a frame on: a path such as
    /// `/user/hand/right/input/a/click`, and its one or two numbers.
    pub inputs: Vec<Input>,
    /// Triangles that hide the corners of the left and the mirrored right view are offered as visibility mask.
    pub visibility_mask: bool,
    /// Some runtimes leave another context current, or none: after every call that may, none is.
    pub unbind_context: bool,
    /// The application may have images for later frames while it submits one; if not, one that it has is one that it has
    /// forgotten to release.
    pub acquires_ahead: bool,
    /// Images are filled with [`POISON`] when they are acquired, so that what was not drawn is seen.
    pub poison: bool,
    /// Pictures of the submitted views are written as PNG.
    pub pictures: Option<Pictures>,
}

/// Magenta: the colour of pixels that were not drawn. No scene has it.
pub const POISON: [u8; 4] = [255, 0, 255, 255];

/// One view.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Eye {
    /// Recommended width and height in pixels.
    pub size: [u32; 2],
    /// Left, right, up, down, as OpenXR has them: left and down are usually negative.
    pub fov_degrees: [f32; 4],
    /// How far the view is turned outwards.
    pub cant_degrees: f32,
}

/// Something happens.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Event {
    /// When.
    pub at: At,
    /// What.
    pub what: What,
}

/// When something happens; once only.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum At {
    /// When this frame is waited for.
    Frame(u32),
    /// When the application has been told of this state.
    State(State),
    /// When the application has asked for events this often while nothing was to be told.
    Poll(u32),
}

/// `XrSessionState`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs)]
pub enum State {
    Idle,
    Ready,
    Synchronized,
    Visible,
    Focused,
    Stopping,
    LossPending,
    Exiting,
}

/// What happens.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum What {
    /// From now on every call says that the session is lost; the event of it comes too.
    LoseSession,
    /// The application is told that the session will be lost; calls go on to succeed.
    SessionLossPending,
    /// From now on every call says that the instance is lost; the event of it comes too.
    LoseInstance,
    /// The user ends the application: `STOPPING`, then `EXITING`.
    Exit,
    /// The user takes the headset off: `STOPPING`, and `READY` again after this many calls for events in vain.
    TakeOff(u32),
    /// How far the session may get: `synchronized`, `visible` or `focused`.
    Level(State),
    /// The local space is set anew: turned to the left by this many degrees.
    Recenter(f32),
    /// The system changes the rate of the display.
    RefreshRate(f32),
    /// Other controllers, or none.
    Profile(Option<String>),
    /// The visibility mask has changed.
    MaskChanged,
    /// Events were lost.
    EventsLost,
}

/// A call that fails.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Fault {
    /// Its name, `xrWaitFrame` for instance.
    pub call: String,
    /// Which of its calls, from 1.
    pub nth: u32,
    /// All later ones, too.
    #[serde(default)]
    pub and_later: bool,
    /// The number of the result, `-2` for `XR_ERROR_RUNTIME_FAILURE` for instance.
    pub result: i32,
}

/// A part of a controller has a value from a frame on.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Input {
    /// From this frame on.
    pub frame: u32,
    /// The part.
    pub path: String,
    /// Its value; buttons are pressed from 0.5 on, and only thumbsticks have a second number.
    pub value: [f32; 2],
}

/// Where pictures are written: `view-0.png` is what was last submitted for the left eye, `quad-0.png` what the first quad layer
/// showed, with alpha.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Pictures {
    /// The folder, which must exist.
    pub folder: PathBuf,
    /// From this frame on.
    pub from: u32,
}

/// GL_SRGB8_ALPHA8, GL_RGBA8, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT16.
const FORMATS: [i64; 5] = [0x8C43, 0x8058, 0x8CAC, 0x81A6, 0x81A5];

impl Default for Script {
    fn default() -> Script {
        Script {
            log: None,
            missing_extensions: Vec::new(),
            unavailable: 0,
            formats: FORMATS.into(),
            stereo: true,
            mono: true,
            eyes: [Eye::default(); 2],
            ipd: vec![(0, 0.063)],
            position: [0.0, 1.6, 0.0],
            yaw_degrees: 0.0,
            yaw_per_frame_degrees: 0.0,
            untracked: Vec::new(),
            quaternion_lengths: Vec::new(),
            no_globals: false,
            should_render_from: 1,
            refresh_rates: vec![72.0, 80.0, 90.0, 120.0],
            events: Vec::new(),
            faults: Vec::new(),
            profile: Some("/interaction_profiles/oculus/touch_controller".into()),
            inputs: Vec::new(),
            visibility_mask: false,
            unbind_context: false,
            acquires_ahead: false,
            poison: false,
            pictures: None,
        }
    }
}

impl Default for Eye {
    fn default() -> Eye {
        Eye { size: [128, 128], fov_degrees: [-45.0, 45.0, 45.0, -45.0], cant_degrees: 0.0 }
    }
}

impl Script {
    /// The frusta of current headsets: 52 degrees outwards, 42 inwards.
    #[must_use]
    pub fn asymmetric(mut self) -> Script {
        self.eyes[0].fov_degrees = [-52.0, 42.0, 47.0, -50.0];
        self.eyes[1].fov_degrees = [-42.0, 52.0, 47.0, -50.0];
        self
    }

    /// The script that [`VARIABLE`] names.
    ///
    /// # Panics
    /// When it cannot be read: a test is mistaken.
    pub(crate) fn load() -> Script {
        let Some(path) = std::env::var_os(VARIABLE) else { return Script::default() };
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    }

    /// The eyes' distance in a frame.
    pub(crate) fn ipd(&self, frame: u32) -> f32 {
        let past = self.ipd.iter().filter(|(from, _)| *from <= frame);
        past.max_by_key(|(from, _)| *from).map_or(0.063, |(_, ipd)| *ipd)
    }

    /// The length of the views' quaternions in a frame.
    pub(crate) fn quaternion_length(&self, frame: u32) -> f32 {
        self.quaternion_lengths.iter().find(|(odd, _)| *odd == frame).map_or(1.0, |(_, length)| *length)
    }

    /// The value of a controller's part in a frame.
    pub(crate) fn input(&self, path: &str, frame: u32) -> [f32; 2] {
        let past = self.inputs.iter().filter(|input| input.path == path && input.frame <= frame);
        past.max_by_key(|input| input.frame).map_or([0.0; 2], |input| input.value)
    }
}
