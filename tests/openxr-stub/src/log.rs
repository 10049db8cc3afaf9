//! The log of what the runtime observes, in JSON lines.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Write as _;
use std::path::Path;

use serde::{Deserialize, Serialize};

/// One line of the log.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "kebab-case")]
#[allow(missing_docs)]
pub enum Entry {
    /// An instance was created.
    Instance { application: String, api: String, extensions: Vec<String>, android: bool },
    /// A session was created.
    Session { binding: String },
    /// A session has begun.
    Begun { views: u32 },
    /// A frame has ended.
    Frame { frame: u32, should_render: bool, layers: Vec<Layer> },
    /// The application requested something: a display rate, a performance level, the end of the session.
    Request { what: String, value: f64 },
    /// An event of the script has happened.
    Scripted { what: String },
    /// A call failed because of the script.
    Fault { call: String, nth: u32, result: i32 },
    /// The application did something that the specification forbids.
    Violation { call: String, what: String },
    /// A session or an instance was destroyed.
    Destroyed { what: String },
    /// The number of calls of each function, at the end of an instance.
    Calls { counts: BTreeMap<String, u32> },
}

/// A submitted layer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "kebab-case")]
#[allow(missing_docs)]
pub enum Layer {
    Projection { views: Vec<View> },
    Quad { image: Image },
}

/// A submitted view.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct View {
    /// The position in the layer's space, in metres.
    pub position: [f32; 3],
    /// The orientation as a quaternion: x, y, z, w.
    pub orientation: [f32; 4],
    /// The field of view in degrees: left, right, up, down.
    pub fov_degrees: [f32; 4],
    /// The colour image.
    pub image: Image,
    /// The depth, if it was submitted.
    pub depth: Option<Depth>,
    /// What frames are made of that the application does not render, if it was submitted.
    #[serde(default)]
    pub synthesis: Option<Synthesis>,
}

/// Motion vectors of a view (XR_EXT_frame_synthesis, XR_FB_space_warp).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Synthesis {
    /// True by XR_FB_space_warp, whose vectors are in the NDC of the graphics interface. The others are in Vulkan's, but
    /// for y, which grows with the rows of the image in both.
    pub is_space_warp: bool,
    /// The vectors: NDC of this frame minus NDC of the last one, before scale and offset.
    pub vectors: Image,
    /// What the vectors are multiplied by.
    pub scale: [f32; 3],
    /// What is added to them.
    pub offset: [f32; 3],
    /// The depth that belongs to them.
    pub depth: Depth,
    /// Position and orientation of this frame's space in the last one's, as the application moved it.
    pub moved: ([f32; 3], [f32; 4]),
    /// True if the vectors have two components.
    pub is_flat: bool,
    /// True if no frame should be made of this one.
    pub is_skipped: bool,
}

/// A part of a swapchain's image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Image {
    /// The handle of the swapchain.
    pub swapchain: u64,
    /// The layer of the image's array.
    pub layer: u32,
    /// The rectangle: x, y, width, height in pixels.
    pub rect: [i32; 4],
    /// True if the rows are in the opposite order (XR_FB_composition_layer_image_layout).
    #[serde(default)]
    pub upside_down: bool,
}

/// The depth of a view.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Depth {
    /// The image.
    pub image: Image,
    /// The smallest and the largest value of the depth buffer.
    pub range: [f32; 2],
    /// The distances in metres that these values stand for. f32::MAX stands for infinity.
    pub near_far: [f32; 2],
}

/// Reads a log.
///
/// # Panics
/// If the file is not a log, which is a mistake in the test.
pub fn read(path: &Path) -> Vec<Entry> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    text.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{line}: {e}"))).collect()
}

/// The writer. Every line is written immediately, so that a crash loses none.
pub(crate) struct Log(Option<File>);

impl Log {
    pub(crate) fn open(path: Option<&Path>) -> Log {
        Log(path.map(|path| {
            File::options()
                .create(true)
                .append(true)
                .open(path)
                .unwrap_or_else(|e| panic!("{}: {e}", path.display()))
        }))
    }

    pub(crate) fn write(&mut self, entry: &Entry) {
        if let Some(file) = &mut self.0 {
            let mut line = serde_json::to_vec(entry).expect("entries are plain data");
            line.push(b'\n');
            let _ = file.write_all(&line);
        }
    }
}
