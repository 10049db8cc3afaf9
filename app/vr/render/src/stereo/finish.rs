//! The last step of an eye: anti-aliasing or a copy into its target.

use std::rc::Rc;

use super::frame::Setup;
use super::method::EyeTarget;
use super::options::AntiAliasing;
use crate::render::{DepthImage, Fxaa, ViewImages};
use yoro_gl::{Context, Destination, GlError, RenderTarget};

/// The image of an eye, complete except for anti-aliasing.
#[derive(Clone, Copy)]
pub(super) struct EyeImage<'a> {
    pub(super) color: &'a RenderTarget,
    /// Pixel of `color` that corresponds to the eye's lower left pixel.
    pub(super) origin: [u32; 2],
    /// Window depth, if the target has depth.
    pub(super) depth: Option<DepthImage<'a>>,
}

impl<'a> EyeImage<'a> {
    /// Returns the whole image of a rendered view, with its depth if `depth` is set.
    pub(super) fn whole(view: &'a impl ViewImages, depth: bool) -> EyeImage<'a> {
        let depth = depth.then(|| DepthImage::whole(view.depth()));
        EyeImage { color: view.color(), origin: [0, 0], depth }
    }
}

/// Writes an eye's image to its target, with anti-aliasing or as a plain copy.
pub(super) struct Finish {
    gl: Rc<Context>,
    fxaa: Option<Fxaa>,
}

impl Finish {
    /// Creates it with anti-aliasing, unless the options turn that off.
    pub(super) fn new(setup: &Setup) -> Result<Finish, GlError> {
        Finish::smoothing(setup, setup.options.anti_aliasing != AntiAliasing::Off)
    }

    /// Creates it with or without anti-aliasing. Images with several samples in each pixel have smooth edges already
    /// and are always copied.
    pub(super) fn smoothing(setup: &Setup, smooth: bool) -> Result<Finish, GlError> {
        let fxaa = smooth && setup.settings.samples() == 1;
        Ok(Finish { gl: setup.gl.clone(), fxaa: fxaa.then(|| Fxaa::new(setup.gl)).transpose()? })
    }

    /// True if an eye's colour is copied without anti-aliasing.
    pub(super) fn is_copy(&self) -> bool {
        self.fxaa.is_none()
    }

    /// Writes an eye's colour, and its depth if the target has depth.
    pub(super) fn run(&self, eye: &EyeImage, to: &EyeTarget) {
        self.color(eye.color, eye.origin, &to.color);
        Finish::depth(eye.depth, to);
    }

    /// Fills `to` from the part of `from` whose lower left corner is `origin`.
    pub(super) fn color(&self, from: &RenderTarget, origin: [u32; 2], to: &Destination) {
        match &self.fxaa {
            Some(fxaa) => fxaa.run(from.color(0), origin, to),
            None => self.gl.pass("copy", || from.copy_color(origin, to)),
        }
    }

    /// Writes an eye's depth, if the target has depth.
    pub(super) fn depth(from: Option<DepthImage>, to: &EyeTarget) {
        if let (Some(from), Some(to)) = (from, &to.depth) {
            to.copy.run(from, &to.to);
        }
    }
}
