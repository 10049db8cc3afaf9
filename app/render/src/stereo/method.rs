//! The interface of stereo methods: their trait, the targets of frames, errors.

use std::rc::Rc;

use crate::render::{DepthCopy, GpuScene, Renderer};
use yoro::eyes::{Eye, EyePair, EyesError};
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget, Texture};

/// The reason why a stereo frame could not be rendered.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StereoError {
    /// The pair of eyes does not fit the method.
    #[error(transparent)]
    Eyes(#[from] EyesError),
    /// GL refused.
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

    /// Resizes the images; nothing happens at the same size.
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

    /// Returns both images, left and right.
    pub fn images(&self) -> [&Texture; 2] {
        self.eyes.each_ref().map(|eye| eye.color(0))
    }

    /// Returns both images as targets, without depth.
    pub fn targets(&self) -> [EyeTarget<'static>; 2] {
        Eye::BOTH.map(|eye| EyeTarget { color: Destination::whole(self.eye(eye)), depth: None })
    }
}

/// The target of one eye of a frame. The rectangles have the pair's size.
#[derive(Clone, Copy)]
pub struct EyeTarget<'a> {
    /// Takes display-referred sRGB with luma in alpha, and stores it as it is written.
    pub color: Destination,
    /// Takes the eye's window depth; `None` if it is not needed.
    pub depth: Option<DepthTarget<'a>>,
}

/// The target of an eye's window depth.
#[derive(Clone, Copy)]
pub struct DepthTarget<'a> {
    /// Framebuffer with a depth attachment and nothing else.
    pub to: Destination,
    /// The pass that writes it.
    pub copy: &'a DepthCopy,
}

/// The part of its guard band that a method with [`yoro::eyes::GuardBand::Auto`] drew in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GuardBandUse {
    /// Columns that were drawn.
    pub columns: u32,
    /// Columns of the whole band.
    pub most: u32,
    /// Pixels at the other eye's border that were filled because their surfaces lie in the part of the band that was
    /// not drawn: an estimate from the outermost column that was drawn.
    pub undrawn: u32,
}

/// What a method with [`super::StereoOptions::history`] rendered of the other eye, and what that was for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HistoryUse {
    /// Pixels of the other eye that were rendered besides in the last frame.
    pub rendered: u32,
    /// Pixels that were uncovered two frames before, in the rows that are looked at: an estimate from the rendered eye.
    pub uncovered: u32,
    /// Those of them that the history did not show.
    pub unknown: u32,
}

/// A method with its own programs and targets.
pub trait StereoMethod {
    /// Compiles what the method needs for the materials of a scene, so that its first frame of that scene does not
    /// have to.
    ///
    /// # Errors
    /// [`StereoError`] when GL refuses.
    fn prepare(&mut self, _renderer: &mut Renderer, _scene: &GpuScene) -> Result<(), StereoError> {
        Ok(())
    }

    /// Returns the use of the guard band two frames before the last one, which is measured by now. `None` for methods
    /// and settings that always draw all of it, and before anything was measured.
    fn guard_band(&self) -> Option<GuardBandUse> {
        None
    }

    /// Returns the use of the history. `None` for methods and settings without one.
    fn history(&self) -> Option<HistoryUse> {
        None
    }

    /// True if both eyes of the last frame were rendered in place of the method, as [`NearFieldPolicy`] says.
    ///
    /// [`NearFieldPolicy`]: super::NearFieldPolicy
    fn is_substituted(&self) -> bool {
        false
    }

    /// Renders both eyes of a frame into their targets, by [`Eye::index`].
    ///
    /// # Errors
    /// [`StereoError`] for a pair of eyes that the method cannot do, or when GL refuses.
    fn render_to(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError>;

    /// Shows the last frame's render once more, at the poses that the eyes have now. Returns false, with nothing drawn,
    /// if the method cannot, or if the last render does not reach as far: render a frame then.
    ///
    /// # Errors
    /// As [`StereoMethod::render_to`].
    fn show_again(&mut self, _pair: &EyePair, _to: &[EyeTarget; 2]) -> Result<bool, StereoError> {
        Ok(false)
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
