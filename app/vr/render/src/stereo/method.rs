//! The interface of stereo methods: their trait, the targets of frames, errors.

use std::rc::Rc;

use super::frame::Frame;
use super::session::FrameTargets;
use crate::view::{DepthCopy, GpuScene, Renderer};
use yoro::eyes::{DepthRange, Eye, EyesError, Ndc, StereoViews, View};
use yoro_gl::{Context, Destination, Filter, Format, GlError, Image, RenderTarget, Texture};

/// The reason why a stereo frame could not be rendered.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StereoError {
    /// The pair of eyes does not fit the method.
    #[error(transparent)]
    Eyes(#[from] EyesError),
    /// GL reported an error.
    #[error(transparent)]
    Gl(#[from] GlError),
}

/// The finished images of a frame: [`Format::Rgba8`], display-referred sRGB with luma in alpha.
pub struct StereoFrame {
    eyes: [RenderTarget; 2],
}

impl StereoFrame {
    /// Makes a frame of two images of `size` pixels.
    ///
    /// # Errors
    /// As [`RenderTarget::new`].
    pub fn new(gl: &Rc<Context>, size: [u32; 2]) -> Result<StereoFrame, GlError> {
        let eye = || RenderTarget::new(gl, size, &[(Format::Rgba8, Filter::Linear)], None);
        Ok(StereoFrame { eyes: [eye()?, eye()?] })
    }

    /// Resizes the images. Does nothing if they already have this size.
    ///
    /// # Errors
    /// As [`RenderTarget::resize`].
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        self.eyes.iter_mut().try_for_each(|eye| eye.resize(size))
    }

    /// Resizes the images, and returns them as targets of a frame, without depth.
    ///
    /// # Errors
    /// As [`StereoFrame::resize`].
    pub fn fit(&mut self, size: [u32; 2]) -> Result<FrameTargets<'static>, GlError> {
        self.resize(size)?;
        Ok(FrameTargets::Eyes(self.targets()))
    }

    /// Returns one eye's image.
    pub fn eye(&self, eye: Eye) -> &RenderTarget {
        &self.eyes[eye.index()]
    }

    /// Returns the width and height of the images in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.eyes[0].size()
    }

    /// Returns one eye's pixels, 4 bytes each, rows from the bottom.
    pub fn rgba(&self, eye: Eye) -> Vec<u8> {
        self.eye(eye).read_rgba8(0, [0, 0], self.size())
    }

    /// Returns both images, left and right.
    pub fn images(&self) -> [&Texture; 2] {
        self.eyes.each_ref().map(|eye| eye.color(0))
    }

    /// Returns both images as targets, without depth.
    pub fn targets(&self) -> [EyeTarget<'static>; 2] {
        Eye::BOTH.map(|eye| EyeTarget::of(self.eye(eye)))
    }

    /// Returns both images as destinations, by [`Eye::index`].
    pub fn colors(&self) -> [Destination; 2] {
        self.targets().map(|target| target.color)
    }
}

/// The target of one eye of a frame. Its rectangles have the size of the pair.
#[derive(Clone, Copy)]
pub struct EyeTarget<'a> {
    /// Receives display-referred sRGB with luma in alpha, and stores it as written.
    pub color: Destination,
    /// The 2-D texture of which `color` is the first level, if it is one: samples of a tile-based GPU are then averaged
    /// into it without a copy. It must live as long as the target is used.
    pub texture: Option<(glow::Texture, Image)>,
    /// Receives the eye's window depth; `None` if it is not needed.
    pub depth: Option<DepthTarget<'a>>,
    /// Receives motion vectors, with depth of their size; `None` if they are not needed. Both eyes have one, or none has.
    pub motion: Option<MotionTarget>,
}

impl EyeTarget<'_> {
    /// Returns the colour of a render target, without depth.
    pub fn of(target: &RenderTarget) -> EyeTarget<'static> {
        let color = target.color(0);
        EyeTarget {
            color: target.color_only(),
            texture: Some((color.raw(), color.image())),
            depth: None,
            motion: None,
        }
    }

    /// Clears the depth to the farthest of a range, if the target has depth.
    pub(super) fn clear_depth(&self, gl: &Context, range: DepthRange) {
        if let Some(DepthTarget { to, .. }) = &self.depth {
            gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
            gl.clear_rectangle(to.origin, to.size, Some(range.clear_value()));
        }
    }

    /// Returns the target of depth if that of the wide layer of views fits into it.
    pub(super) fn depth_of_wide(&self, views: &StereoViews) -> Option<DepthTarget<'_>> {
        let eyes = &views.wide.eyes;
        let is_fitting =
            |depth: &DepthTarget| depth.to.size == eyes.size && eyes.has_same_frusta(&views.shown);
        self.depth.filter(is_fitting)
    }

    /// Returns a rectangle of a framebuffer, without depth.
    pub fn rectangle(color: Destination) -> EyeTarget<'static> {
        EyeTarget { color, texture: None, depth: None, motion: None }
    }
}

/// The target of an eye's window depth.
#[derive(Clone, Copy)]
pub struct DepthTarget<'a> {
    /// Framebuffer with only a depth attachment.
    pub to: Destination,
    /// The pass that writes it.
    pub copy: &'a DepthCopy,
}

/// The target of an eye's motion vectors, of any size, which must be that of the other eye's, too.
#[derive(Clone, Copy, Debug)]
pub struct MotionTarget {
    /// Framebuffer with an RGBA16F colour and a depth attachment. Receives vectors in the eye's normalized device
    /// coordinates (X, Y, Z; alpha is 1 on moving surfaces), and window depth in the pair's convention.
    pub to: Destination,
    /// The eye in the frame that vectors point to, the one that was rendered before the scene's time last changed. Its size
    /// does not matter.
    pub previous: View,
    /// The range of depth in normalized device coordinates.
    pub ndc: Ndc,
}

/// A method with its own programs and targets, which fit one layer of a frame.
pub(super) trait StereoMethod {
    /// Compiles what the method needs for the materials of a scene, unless it is compiled already.
    ///
    /// # Errors
    /// [`StereoError`] if GL refuses.
    fn prepare(&mut self, renderer: &mut Renderer, scene: &GpuScene) -> Result<(), StereoError>;

    /// Renders both eyes of a layer into their targets. Returns true if motion vectors were written.
    ///
    /// # Errors
    /// [`StereoError`] if the method does not support the pair of eyes, or GL refuses.
    fn render(&mut self, frame: &Frame) -> Result<bool, StereoError>;
}
