//! What a method is: a trait, where its frames go, and why it may fail.

use std::rc::Rc;

use crate::render::{DepthCopy, GpuScene, Renderer};
use yoro::eyes::{Eye, EyePair, EyesError};
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget};

/// Why a stereo frame could not be rendered.
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
    /// A frame of two images of `size` pixels.
    ///
    /// # Errors
    /// As [`RenderTarget::new`].
    pub fn new(gl: &Rc<Context>, size: [u32; 2]) -> Result<StereoFrame, GlError> {
        let eye = || RenderTarget::new(gl, size, &[(Format::Rgba8, Filter::Linear)], None);
        Ok(StereoFrame { eyes: [eye()?, eye()?] })
    }

    /// Gives the images another size; nothing happens at the same size.
    ///
    /// # Errors
    /// As [`RenderTarget::resize`].
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        self.eyes.iter_mut().try_for_each(|eye| eye.resize(size))
    }

    /// One eye's image.
    pub fn eye(&self, eye: Eye) -> &RenderTarget {
        &self.eyes[eye.index()]
    }

    /// Both images as targets, without depth.
    pub fn targets(&self) -> [EyeTarget<'static>; 2] {
        Eye::BOTH.map(|eye| EyeTarget { color: Destination::whole(self.eye(eye)), depth: None })
    }
}

/// Where one eye of a frame goes. The rectangles have the pair's size.
#[derive(Clone, Copy)]
pub struct EyeTarget<'a> {
    /// Takes display-referred sRGB with luma in alpha, and stores it as it is written.
    pub color: Destination,
    /// Takes the eye's window depth, if somebody wants it.
    pub depth: Option<DepthTarget<'a>>,
}

/// Where the window depth of an eye goes.
#[derive(Clone, Copy)]
pub struct DepthTarget<'a> {
    /// Framebuffer with a depth attachment and nothing else.
    pub to: Destination,
    /// The pass that writes it.
    pub copy: &'a DepthCopy,
}

/// How much of its guard band a method with [`yoro::eyes::GuardBand::Auto`] drew in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GuardBandUse {
    /// Columns that were drawn.
    pub columns: u32,
    /// Columns that the band has at most.
    pub most: u32,
    /// Pixels at the other eye's border that were filled, since what they show lies in the band and was not drawn: as far as
    /// the outermost column that was drawn tells.
    pub undrawn: u32,
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

    /// The use of the guard band two frames before the last one that was rendered, which is measured by now. None for methods
    /// and settings that always draw all of it, and before anything was measured.
    fn guard_band(&self) -> Option<GuardBandUse> {
        None
    }

    /// Renders both eyes of a frame to wherever they are wanted, by [`Eye::index`].
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
