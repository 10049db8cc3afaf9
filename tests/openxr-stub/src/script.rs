//! The script of the simulated headset: a JSON file, named by the environment variable [`VARIABLE`].

use std::path::PathBuf;

use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

/// The environment variable that names the script's file. Without it the headset is [`Script::default`].
pub const VARIABLE: &str = "YORO_OPENXR_STUB";

/// A headset and its events. Frames are counted by `xrWaitFrame`, over all sessions of the process. The count stays 0
/// until the first frame whose left view has more than one colour, however long a scene takes to load.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Script {
    /// The log file, to which JSON lines are appended.
    pub log: Option<PathBuf>,
    /// Known extensions that are not offered.
    pub missing_extensions: Vec<String>,
    /// The number of times that `xrGetSystem` reports that no headset is connected.
    pub unavailable: u32,
    /// The swapchain formats, as numbers of GL or Vulkan, in order of preference.
    pub formats: Vec<i64>,
    /// True if `PRIMARY_STEREO` is offered.
    pub stereo: bool,
    /// True if `PRIMARY_MONO` is offered.
    pub mono: bool,
    /// The inset views of `PRIMARY_STEREO_WITH_FOVEATED_INSET`, or `None` if it is not offered. Instances of OpenXR 1.0
    /// are offered it only with XR_VARJO_quad_views.
    pub insets: Option<Insets>,
    /// The size in pixels that is recommended for motion vectors and their depth.
    pub vector_size: [u32; 2],
    /// The left and the right eye. A configuration with one view has the left eye, without its offset.
    pub eyes: [Eye; 2],
    /// Distances between the eyes in metres, each with the frame from which it applies.
    pub ipd: Vec<(u32, f32)>,
    /// The head's position in metres, relative to the centre of the floor.
    pub position: [f32; 3],
    /// The head's rotation to the left.
    pub yaw_degrees: f32,
    /// The head's velocity in metres a second, from the first picture on.
    pub velocity: [f32; 3],
    /// Frames without a valid head pose.
    pub untracked: Vec<u32>,
    /// Frames in which the views' quaternions have this length instead of 1, although the poses are reported as valid.
    pub quaternion_lengths: Vec<(u32, f32)>,
    /// True if `xrGetInstanceProcAddr` with an instance succeeds but returns null for functions that need no instance.
    pub no_globals: bool,
    /// The display's refresh rates in hertz. The first is the initial one.
    pub refresh_rates: Vec<f32>,
    /// Events and losses.
    pub events: Vec<Event>,
    /// Calls that fail.
    pub faults: Vec<Fault>,
    /// The controllers' profile, or `None` without controllers.
    pub profile: Option<String>,
    /// The input of the controllers.
    pub inputs: Vec<Input>,
    /// The aim rays of the controllers. A hand without one is not tracked.
    pub aims: Vec<Aim>,
    /// True if there is a visibility mask: triangles that hide the outer upper corners of the views.
    pub visibility_mask: bool,
    /// True if no context is current after any call that may change it, as with some runtimes.
    pub unbind_context: bool,
    /// True if the application may have acquired images for later frames when it submits one. Otherwise an acquired
    /// image counts as one that it forgot to release.
    pub acquires_ahead: bool,
    /// True if images are filled with [`POISON`] when they are acquired, so that pixels that were not drawn are
    /// visible.
    pub poison: bool,
    /// Where pictures of the submitted views are written.
    pub pictures: Option<Pictures>,
}

/// Magenta, the colour of pixels that were not drawn. No scene contains it.
pub const POISON: [u8; 4] = [255, 0, 255, 255];

/// One view.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Eye {
    /// Recommended width and height in pixels.
    pub size: [u32; 2],
    /// The field of view in degrees: left, right, up, down. Left and down are usually negative.
    pub fov_degrees: [f32; 4],
    /// The view's rotation outwards.
    pub cant_degrees: f32,
}

/// The views that show where the wearer looks. They stay inside those of the eyes.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Insets {
    /// Recommended width and height in pixels.
    pub size: [u32; 2],
    /// The angle from the middle to each edge. The size in tangents stays, wherever the inset is.
    pub radius_degrees: f32,
    /// The gaze in degrees to the right and up, relative to the head, each with the frame at which it is reached. It
    /// moves evenly in between.
    pub gaze: Vec<(u32, [f32; 2])>,
}

/// An event.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Event {
    /// The moment.
    pub at: At,
    /// The kind of event.
    pub what: What,
}

/// The moment of an event. Every event happens once.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum At {
    /// `xrWaitFrame` for this frame.
    Frame(u32),
    /// The application receives the event of this state.
    State(State),
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

/// The kind of event.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum What {
    /// The session is lost: its event is sent, and from now on every call reports the loss.
    LoseSession,
    /// The event is sent that the session will be lost. Calls still succeed.
    SessionLossPending,
    /// The instance is lost: its event is sent, and from now on every call reports the loss.
    LoseInstance,
    /// The user ends the application: `STOPPING`, then `EXITING`.
    Exit,
    /// The user takes the headset off: `STOPPING`, and `READY` again after this many polls that return no event.
    TakeOff(u32),
    /// The highest state of the session: `synchronized`, `visible` or `focused`.
    Level(State),
    /// The user recentres: the local space rotates to the left by this many degrees.
    Recenter(f32),
    /// The system changes the display's rate, in hertz.
    RefreshRate(f32),
    /// The user picks up other controllers, or none.
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
    /// The name of the function, such as `xrWaitFrame`.
    pub call: String,
    /// The number of the call, counted from 1.
    pub nth: u32,
    /// True if all later calls fail too.
    #[serde(default)]
    pub and_later: bool,
    /// The number of the result, such as -2 for `XR_ERROR_RUNTIME_FAILURE`.
    pub result: i32,
}

/// The value of a controller's part, from a frame on.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Input {
    /// The first frame.
    pub frame: u32,
    /// The part's path, such as `/user/hand/right/input/a/click`.
    pub path: String,
    /// The value. Buttons are pressed at 0.5 or more. Only thumbsticks have a second number.
    pub value: [f32; 2],
}

/// The direction of a controller from a frame on, relative to the head. The hand is held next to the head and below it.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Aim {
    /// The first frame.
    pub frame: u32,
    /// True for the left hand.
    pub is_left: bool,
    /// The rotation to the left.
    pub yaw_degrees: f32,
    /// The rotation upwards.
    pub pitch_degrees: f32,
}

/// Where pictures are written. `view-0.png` is the left eye's last image, `view-2.png` that of its inset, and
/// `quad-0.png` that of the first quad layer, with alpha. `between-0.png` is the left eye's last frame that was made of
/// motion vectors, for half the time until the next one.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Pictures {
    /// The folder, which must exist.
    pub folder: PathBuf,
    /// The first frame.
    pub from: u32,
}

/// GL_SRGB8_ALPHA8, GL_RGBA8, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT16, GL_RGBA16F.
const FORMATS: [i64; 6] = [0x8C43, 0x8058, 0x8CAC, 0x81A6, 0x81A5, 0x881A];

impl Default for Script {
    fn default() -> Script {
        Script {
            log: None,
            missing_extensions: Vec::new(),
            unavailable: 0,
            formats: FORMATS.into(),
            stereo: true,
            mono: true,
            insets: None,
            vector_size: [32, 32],
            eyes: [Eye::default(); 2],
            ipd: vec![(0, 0.063)],
            position: [0.0, 1.6, 0.0],
            yaw_degrees: 0.0,
            velocity: [0.0; 3],
            untracked: Vec::new(),
            quaternion_lengths: Vec::new(),
            no_globals: false,
            refresh_rates: vec![72.0, 80.0, 90.0, 120.0],
            events: Vec::new(),
            faults: Vec::new(),
            profile: Some("/interaction_profiles/oculus/touch_controller".into()),
            inputs: Vec::new(),
            aims: Vec::new(),
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
    /// Sets the frusta of current headsets: 52 degrees outwards, 42 degrees inwards.
    #[must_use]
    pub fn asymmetric(mut self) -> Script {
        self.eyes[0].fov_degrees = [-52.0, 42.0, 47.0, -50.0];
        self.eyes[1].fov_degrees = [-42.0, 52.0, 47.0, -50.0];
        self
    }

    /// Loads the script that [`VARIABLE`] names.
    ///
    /// # Panics
    /// If it cannot be read, which is a mistake in the test.
    pub(crate) fn load() -> Script {
        let Some(path) = std::env::var_os(VARIABLE) else { return Script::default() };
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    }

    /// Returns the gaze in a frame, in degrees to the right and up.
    pub(crate) fn gaze(&self, frame: u32) -> [f32; 2] {
        let Some(insets) = &self.insets else { return [0.0; 2] };
        let reached = |is_past: bool| insets.gaze.iter().filter(move |(at, _)| (*at <= frame) == is_past);
        let before = reached(true).max_by_key(|(at, _)| *at);
        let after = reached(false).min_by_key(|(at, _)| *at);
        match (before, after) {
            (Some((from, a)), Some((to, b))) => {
                let part = (frame - from) as f32 / (to - from) as f32;
                [0, 1].map(|i| a[i] + part * (b[i] - a[i]))
            }
            (Some((_, gaze)), None) | (None, Some((_, gaze))) => *gaze,
            (None, None) => [0.0; 2],
        }
    }

    /// Returns the tangents of an inset's edges in a frame: left, right, up, down. It lies inside those of the eye.
    pub(crate) fn inset(&self, eye: usize, cant_radians: f32, frame: u32) -> Option<[f32; 4]> {
        let insets = self.insets.as_ref()?;
        let [right, up] = self.gaze(frame).map(f32::to_radians);
        let gaze = Quat::from_rotation_y(-right) * Quat::from_rotation_x(up) * Vec3::NEG_Z;
        let gaze = Quat::from_rotation_y(-cant_radians) * gaze;
        let half = insets.radius_degrees.to_radians().tan();
        let wide = self.eyes[eye].fov_degrees.map(|angle| angle.to_radians().tan());
        let within = |middle: f32, low: f32, high: f32| {
            let half = half.min((high - low) / 2.0);
            // An inset as large as the eye has no room, and by rounding even less.
            let middle = middle.max(low + half).min(high - half);
            [middle - half, middle + half]
        };
        let [left, right] = within(gaze.x / -gaze.z, wide[0], wide[1]);
        let [down, up] = within(gaze.y / -gaze.z, wide[3], wide[2]);
        Some([left, right, up, down])
    }

    /// Returns the distance between the eyes in a frame, in metres.
    pub(crate) fn ipd(&self, frame: u32) -> f32 {
        let past = self.ipd.iter().filter(|(from, _)| *from <= frame);
        past.max_by_key(|(from, _)| *from).map_or(0.063, |(_, ipd)| *ipd)
    }

    /// Returns the length of the views' quaternions in a frame.
    pub(crate) fn quaternion_length(&self, frame: u32) -> f32 {
        self.quaternion_lengths.iter().find(|(odd, _)| *odd == frame).map_or(1.0, |(_, length)| *length)
    }

    /// Returns the aim ray of a hand in a frame.
    pub(crate) fn aim(&self, is_left: bool, frame: u32) -> Option<&Aim> {
        let past = self.aims.iter().filter(|aim| aim.is_left == is_left && aim.frame <= frame);
        past.max_by_key(|aim| aim.frame)
    }

    /// Returns the value of a controller's part in a frame.
    pub(crate) fn input(&self, path: &str, frame: u32) -> [f32; 2] {
        let past = self.inputs.iter().filter(|input| input.path == path && input.frame <= frame);
        past.max_by_key(|input| input.frame).map_or([0.0; 2], |input| input.value)
    }
}
