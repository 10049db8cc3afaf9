//! Options of a headset's sessions, and descriptions of sessions and frames.

use crate::frame::PresentReport;
use yoro::eyes::EyePair;

/// Options of a session, in addition to the viewer's settings.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// The Java side of the application.
    #[cfg(target_os = "android")]
    pub android: Option<super::graphics::Android>,
}

/// A description of runtime, system and session.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Description {
    /// The runtime's name and version.
    pub runtime: String,
    /// The system's name.
    pub system: String,
    /// `stereo`, `mono`, or `quad`: stereo with an inset for each eye.
    pub views: String,
    /// The size in pixels that the runtime recommends for each eye.
    pub recommended: [u32; 2],
    /// The size in pixels of the images.
    pub size: [u32; 2],
    /// The size in pixels of the insets' images, if the runtime shows insets.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inset_size: Option<[u32; 2]>,
    /// Format of the images.
    pub format: String,
    /// True if eyes are drawn straight into the runtime's images.
    pub direct: bool,
    /// True if these can also be read, so that the other eye can be synthesized of what is rendered into them.
    pub readable: bool,
    /// Format of the depth that is submitted, if any.
    pub depth: Option<String>,
    /// True if the lenses hide part of the images.
    pub mask: bool,
    /// Refresh rates that the display offers, in Hz; empty if the runtime does not report them.
    pub refresh_rates: Vec<f32>,
    /// True if controllers are used.
    pub input: bool,
    /// The extension by which the runtime makes frames of motion vectors, if it is used.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub makes_frames: Option<&'static str>,
}

impl Description {
    /// Logs the description in one line.
    pub(super) fn log(&self) {
        let [w, h] = self.size;
        if let Some(extension) = self.makes_frames {
            log::info!("the runtime makes frames of motion vectors by {extension}");
        }
        let insets = self.inset_size.map_or(String::new(), |[w, h]| format!(", insets of {w}x{h}"));
        let rates: Vec<String> = self.refresh_rates.iter().map(|hz| format!("{hz:.0}")).collect();
        log::info!(
            "OpenXR: {}, system {}, {} views of {w}x{h}{insets} ({}, {}), depth {}, hidden part {}, refresh rates {}",
            self.runtime,
            self.system,
            self.views,
            self.format,
            match (self.direct, self.readable) {
                (true, true) => "rendered into",
                (true, false) => "drawn straight into",
                _ => "drawn aside and decoded",
            },
            self.depth.as_deref().unwrap_or("none"),
            if self.mask { "masked" } else { "unknown" },
            if rates.is_empty() { "unknown".to_owned() } else { format!("{} Hz", rates.join(", ")) },
        );
    }
}

/// The images of both eyes as the runtime receives them.
#[derive(Clone, Debug)]
pub struct Capture {
    /// RGBA, rows from the bottom to the top.
    pub eyes: [Vec<u8>; 2],
    /// The eyes, in the scene's coordinates.
    pub pair: EyePair,
}

/// A frame that was handed to the runtime.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The viewer's report; `None` for a frame without images, requested by the runtime while invisible.
    pub report: Option<PresentReport>,
    /// Working time of this program's thread on the frame, in milliseconds; waiting for the runtime is not included.
    pub cpu_ms: f64,
    /// The frame's images, if they were asked for.
    pub capture: Option<Box<Capture>>,
}
