//! The synthesis of one session, independent of the graphics interface.

use std::time::Duration;

use yoro::eyes::Warp;

use crate::geometry::Rectangle;
use crate::reason::Reason;

/// The longest wait for an image from the runtime or for the GPU.
pub const TIMEOUT: Duration = Duration::from_millis(500);

/// One layer of a swapchain's image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Image {
    /// A VkImage, or the name of a texture.
    pub image: u64,
    /// A VkFormat or an internal format of OpenGL, as in XrSwapchainCreateInfo.
    pub format: i64,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The index of the layer in the image's array.
    pub layer: u32,
    /// The number of layers in the array. In OpenGL an image with one layer is not an array.
    pub layers: u32,
}

/// The synthesis of one image. Rectangles count from row 0 of the image: the top in Vulkan, the bottom in OpenGL.
pub struct Job<'a> {
    pub color: Image,
    pub depth: Image,
    /// The part of both images that is read.
    pub source: Rectangle,
    pub warp: &'a Warp,
    /// The image that is drawn to, beginning at its first column and row.
    pub target: Image,
    /// Its depth, stored like the source's.
    pub target_depth: Option<Image>,
}

/// A synthesis pipeline of a session, and everything that it needs.
pub trait Synthesizer: Send {
    /// Submits the synthesis of one frame to the GPU, after the application's own work, without waiting for it. Returns
    /// the GPU time of an earlier frame once it is known.
    ///
    /// # Errors
    /// The reason why nothing was submitted.
    ///
    /// # Safety
    /// The images belong to the session, and the runtime does not own them at the moment. In Vulkan the source's images
    /// are in attachment layouts, and the target's are left in them. No other thread uses the queue or the context.
    unsafe fn synthesize(&mut self, job: &Job) -> Result<Option<Duration>, Reason>;

    /// Forgets the images of a swapchain, which are about to be destroyed.
    fn forget(&mut self, images: &[u64]);
}
