//! The interface of stereo methods: their trait, the targets of frames, errors.

use std::rc::Rc;

use super::frame::Frame;
use super::session::FrameTargets;
use crate::view::{DepthCopy, GpuScene, Renderer};
use yoro::eyes::{Composition, DepthRange, Eye, EyesError, LevelPlace, Ndc, StereoViews, View, ViewLayer};
use yoro::opengl::{LevelImage, LevelImages, Part};
use yoro_gl::{Context, Destination, Filter, Format, GlError, Image, RenderTarget};

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

/// The finished images of a frame: [`Format::Rgba8`], display-referred sRGB with luma in alpha. An eye may be a part of its
/// image.
pub struct StereoFrame {
    images: [RenderTarget; 2],
    /// Width and height of the eyes in pixels.
    size: [u32; 2],
    /// Lower left corner of each eye in its image.
    corners: [[u32; 2]; 2],
}

impl StereoFrame {
    /// Makes a frame of two images of `size` pixels.
    ///
    /// # Errors
    /// As [`RenderTarget::new`].
    pub fn new(gl: &Rc<Context>, size: [u32; 2]) -> Result<StereoFrame, GlError> {
        let image = || RenderTarget::new(gl, size, &[(Format::Rgba8, Filter::Linear)], None);
        Ok(StereoFrame { images: [image()?, image()?], size, corners: [[0, 0]; 2] })
    }

    /// Resizes the images to that of the eyes. Does nothing if they already have this size.
    ///
    /// # Errors
    /// As [`RenderTarget::resize`].
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        self.resize_around(size, None)
    }

    /// Resizes the images to that of the eyes, and one of them to the image of which the eye is a part.
    pub(super) fn resize_around(&mut self, size: [u32; 2], part: Option<(Eye, Part)>) -> Result<(), GlError> {
        self.size = size;
        for eye in Eye::BOTH {
            let own = part.filter(|(of, _)| *of == eye).map(|(_, part)| part);
            let Part { origin, image_size } = own.unwrap_or(Part { origin: [0, 0], image_size: size });
            self.corners[eye.index()] = origin;
            self.images[eye.index()].resize(image_size)?;
        }
        Ok(())
    }

    /// Resizes the images, and returns them as targets of a frame, without depth.
    ///
    /// # Errors
    /// As [`StereoFrame::resize`].
    pub fn fit(&mut self, size: [u32; 2]) -> Result<FrameTargets<'static>, GlError> {
        self.resize(size)?;
        Ok(FrameTargets::Eyes(self.targets()))
    }

    /// Returns the image of which one eye is a part, or all.
    pub fn eye(&self, eye: Eye) -> &RenderTarget {
        &self.images[eye.index()]
    }

    /// Returns the width and height of the eyes in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns one eye's pixels, 4 bytes each, rows from the bottom.
    pub fn rgba(&self, eye: Eye) -> Vec<u8> {
        self.eye(eye).read_rgba8(0, self.corners[eye.index()], self.size)
    }

    /// Returns both eyes as targets, without depth.
    pub fn targets(&self) -> [EyeTarget<'static>; 2] {
        Eye::BOTH.map(|eye| {
            let target = EyeTarget::of(self.eye(eye));
            let color = Destination { origin: self.corners[eye.index()], size: self.size, ..target.color };
            EyeTarget { color, ..target }
        })
    }

    /// Returns both eyes as destinations, by [`Eye::index`].
    pub fn colors(&self) -> [Destination; 2] {
        self.targets().map(|target| target.color)
    }

    /// Returns one eye as a level for a pass that reads it.
    pub(super) fn level(&self, eye: Eye) -> LevelImage {
        let color = self.eye(eye).color(0);
        let part = Part { origin: self.corners[eye.index()], image_size: color.size() };
        LevelImage { color: color.raw(), part: Some(part) }
    }

    /// Returns both eyes for a pass that reads them, by [`Eye::index`]: of a single level.
    pub fn levels(&self) -> [(LevelImages, Composition); 2] {
        let wide = LevelPlace { size: self.size, scale: [1.0; 2], offset: [0.0; 2] };
        let composition = Composition { size: self.size, wide, inset: None };
        Eye::BOTH.map(|eye| (LevelImages { wide: self.level(eye), inset: None }, composition))
    }
}

/// The target of one eye of a frame. Its rectangles have the size of the pair.
#[derive(Clone, Copy)]
pub struct EyeTarget<'a> {
    /// Receives display-referred sRGB with luma in alpha, and stores it as written.
    pub color: Destination,
    /// The 2-D texture whose first level has `color`, and nothing else that is needed, if it is one: samples of a tile-based
    /// GPU are then averaged into it without a copy. It must live as long as the target is used.
    ///
    /// If it has the size of the view of which the dominant eye is a part, the view is rendered into the texture where that is
    /// possible, and [`FrameReport::origin`](super::FrameReport::origin) says where in it the eye is.
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
        EyeTarget { color: target.color_only(), texture: Some(color.attachment()), depth: None, motion: None }
    }

    /// True if a view of this size can be rendered into the texture, and read there as it is stored.
    pub(super) fn takes_view(&self, size: [u32; 2], renderer: &Renderer, scene: &GpuScene) -> bool {
        let is_read = |format| format == Format::Rgba8 || renderer.reads_stored(scene);
        self.texture.is_some_and(|(_, image)| image.size == size && is_read(image.format))
    }

    /// Returns the texture as the target of a view of which the eye is this part, if the texture is as large as the view and
    /// the eye has this place in it.
    pub(super) fn around(
        &self,
        part: Part,
        renderer: &Renderer,
        scene: &GpuScene,
    ) -> Option<EyeTarget<'static>> {
        let fits = self.color.origin == part.origin && self.takes_view(part.image_size, renderer, scene);
        let texture = self.texture.filter(|_| fits)?;
        let color = Destination { origin: [0, 0], size: part.image_size, ..self.color };
        Some(EyeTarget { texture: Some(texture), ..EyeTarget::rectangle(color) })
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

    /// Returns the dominant eye's place in the view that is rendered for a layer, if that view can be rendered where the eye
    /// is shown: nothing of it is changed later but the eye's own pixels.
    fn rendered_part(&self, _: &Renderer, _: &GpuScene, _: &ViewLayer) -> Option<Part> {
        None
    }

    /// Renders both eyes of a layer into their targets. Returns true if motion vectors were written.
    ///
    /// # Errors
    /// [`StereoError`] if the method does not support the pair of eyes, or GL refuses.
    fn render(&mut self, frame: &Frame) -> Result<bool, StereoError>;
}
