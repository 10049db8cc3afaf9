//! The interface of stereo methods: their trait, the targets of frames, errors.

use std::rc::Rc;

use crate::view::{DepthCopy, GpuScene, Renderer};
use yoro::eyes::{Eye, EyePair, EyesError, GuardBand, Ndc, SynthesisViews, View};
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
    pub former: View,
    /// The range of depth in normalized device coordinates.
    pub ndc: Ndc,
}

/// What a method says about a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MethodReport {
    /// The reason why both eyes of the last frame were rendered instead of using the method, if they were.
    pub substituted: Option<Substituted>,
    /// True if the last frame's motion targets were filled. False if there were none, if the method fills none, or if the
    /// eyes changed so much since the former frame that a runtime must not extrapolate this one.
    pub has_motion: bool,
}

/// A reason for rendering both eyes.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Substituted {
    /// Most of the view is too near, as [`NearFieldPolicy`](super::NearFieldPolicy) decides.
    #[error("most of the view is too near")]
    Near,
    /// Neither eye can be synthesized from the other, as with canted eyes.
    #[error(transparent)]
    Eyes(#[from] EyesError),
}

/// The eyes that a method renders: all that is shown, or a level of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelEyes {
    /// The eyes with the frusta and the size of the images.
    pub eyes: EyePair,
    /// The eyes of which these are a level; `None` if they are all that is shown.
    pub shown: Option<EyePair>,
    /// For an inset: the distance in metres from which on its source must be complete.
    pub nearest: Option<f32>,
}

impl From<&EyePair> for LevelEyes {
    fn from(eyes: &EyePair) -> LevelEyes {
        LevelEyes { eyes: *eyes, shown: None, nearest: None }
    }
}

impl LevelEyes {
    /// Returns the view to render for both eyes. An inset has the guard band that it needs in place of `guard`.
    ///
    /// # Errors
    /// Those of [`EyePair::synthesis_views`].
    pub fn synthesis_views(&self, guard: GuardBand) -> Result<SynthesisViews, EyesError> {
        match self.nearest {
            Some(nearest) => self.eyes.inset_views(nearest),
            None => self.eyes.synthesis_views(guard),
        }
    }
}

/// A method with its own programs and targets.
pub trait StereoMethod {
    /// Compiles what the method needs for the materials of a scene, so that the first frame of that scene need not.
    ///
    /// # Errors
    /// [`StereoError`] if GL refuses.
    fn prepare(&mut self, renderer: &mut Renderer, scene: &GpuScene) -> Result<(), StereoError>;

    /// Returns what there is to say about the last frames.
    fn report(&self) -> MethodReport {
        MethodReport::default()
    }

    /// Renders both eyes of a level into their targets, by [`Eye::index`]. A method whose targets fit one level is made for
    /// each.
    ///
    /// # Errors
    /// [`StereoError`] if the method does not support the pair of eyes, or GL refuses.
    fn render_level(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        level: &LevelEyes,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError>;

    /// Renders both eyes of a frame into their targets, by [`Eye::index`].
    ///
    /// # Errors
    /// As [`StereoMethod::render_level`].
    fn render_to(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        self.render_level(renderer, scene, &pair.into(), to)
    }

    /// Renders both eyes into a frame, which is resized to the pair's size.
    ///
    /// # Errors
    /// As [`StereoMethod::render_to`].
    fn render(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        frame: &mut StereoFrame,
    ) -> Result<(), StereoError> {
        frame.resize(pair.size)?;
        self.render_to(renderer, scene, pair, &frame.targets())
    }
}
