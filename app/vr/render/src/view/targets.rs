//! The images that a renderer draws into.

use std::rc::Rc;

use super::bloom::BloomTargets;
use super::depth::{DepthImage, DepthResolve};
use super::layout::Layout;
use super::rectangle::Rectangle;
use super::settings::{RenderSettings, SAMPLE_DEPTH};
use crate::stereo::EyeTarget;
use yoro::eyes::{DepthConvention, Eye, View};
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, Image, MultisampleTarget, Pass, RenderTarget, Texture,
    TileTarget,
};

/// The format of pictures.
const PICTURE: (Format, Filter) = (Format::Rgba8, Filter::Linear);

/// What is needed of a view besides its colour.
#[derive(Clone, Copy, Debug, Default)]
pub struct Needs {
    /// The nearest depth of each pixel.
    pub depth: bool,
    /// True if samples are read after drawing, for outlines.
    pub samples: bool,
    /// True if the nearest depth may be stored in half floats, as it is where depth is reversed.
    pub half_depth: bool,
    /// The part that bloom is computed of; the whole view if `None`.
    pub bloom: Option<Rectangle>,
}

/// The framebuffer of the current view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Onto {
    /// The resolved picture and its depth buffer: one sample in each pixel.
    Resolved,
    /// Samples in memory, unless they are discarded before a tile is written.
    Samples,
    /// Samples in tiles.
    Tile,
}

/// The images of one view, or of both eyes at once.
///
/// A pixel costs 4 bytes of resolved colour and 2 or 4 of depth, 8 to 12 for each sample that is not kept in tiles, and
/// 4 of a complete picture where somebody reads it as a texture.
pub struct Targets {
    gl: Rc<Context>,
    /// Which views the targets hold.
    pub layout: Layout,
    /// The number of samples in each pixel of what is drawn.
    pub samples: u32,
    depth_resolve: DepthResolve,
    /// Samples outside tiles, and whether they carry depth.
    multisample: Option<(MultisampleTarget, bool)>,
    /// Samples in tiles; `None` if the driver cannot keep them there.
    pub tile: Option<TileTarget>,
    /// Samples in tiles, for what is drawn over a picture elsewhere; made when first needed.
    over: Option<TileTarget>,
    /// One sample for a picture elsewhere, and its depth.
    one: TileTarget,
    /// The texture that has the picture of the current view in place of `resolved`.
    elsewhere: Option<(glow::Texture, Image)>,
    /// The framebuffer of the current view.
    pub onto: Onto,
    /// True if the current view carries depth in a second colour.
    pub carries: bool,
    needs: Needs,
    /// Average colour and, depending on the depth_resolve, nearest depth.
    pub resolved: RenderTarget,
    /// Reversed depth in half floats, of two samples or the nearest of all; made when first needed.
    pub halves: Option<RenderTarget>,
    /// True if the current view's depth is in `halves`.
    has_halves: bool,
    /// The picture with outlines, where they are drawn beside the resolved one.
    pub inked: Option<RenderTarget>,
    pub bloom: Option<BloomTargets>,
    /// The complete picture of a view, made when first needed.
    pub composited: Option<RenderTarget>,
    /// The [detail](super::lit::LitScene::detail) of the view in the targets.
    pub detail: f32,
    /// The depth convention of the view in the targets.
    pub convention: DepthConvention,
    /// True if the current depth belongs to what was drawn last.
    pub has_depth: bool,
}

impl Targets {
    /// Makes targets, to be fitted to a view before they are drawn into.
    pub fn new(
        gl: &Rc<Context>,
        layout: Layout,
        settings: &RenderSettings,
        depth_resolve: DepthResolve,
    ) -> Result<Targets, GlError> {
        let samples = if layout == Layout::Layered { 1 } else { settings.msaa };
        let size = layout.texture_size([1, 1]);
        let resolved = match layout {
            Layout::Layered => RenderTarget::multiview(gl, size, &[PICTURE], Some(SAMPLE_DEPTH)),
            _ => RenderTarget::new(gl, size, &[PICTURE], Some(SAMPLE_DEPTH)),
        };
        let tile = (samples > 1 && gl.capabilities().tile_samples).then(|| TileTarget::new(gl, samples));
        Ok(Targets {
            gl: gl.clone(),
            layout,
            samples,
            depth_resolve: if samples == 1 { DepthResolve::None } else { depth_resolve },
            multisample: None,
            tile: tile.transpose()?,
            over: None,
            one: TileTarget::new(gl, 1)?,
            elsewhere: None,
            onto: Onto::Resolved,
            carries: false,
            needs: Needs::default(),
            resolved: resolved?,
            halves: None,
            has_halves: false,
            inked: None,
            bloom: settings.bloom.then(|| BloomTargets::new(gl)).transpose()?,
            composited: None,
            detail: 1.0,
            convention: DepthConvention::Reversed,
            has_depth: false,
        })
    }

    /// Fits the targets to views like this one, and chooses the framebuffer; does nothing else if they already fit.
    /// Returns true if the picture, the average of the samples, is written to the lower left part of `to` without a copy.
    pub fn fit(
        &mut self,
        view: &View,
        detail: f32,
        needs: Needs,
        to: Option<&EyeTarget>,
    ) -> Result<bool, GlError> {
        let size = view.size;
        (self.detail, self.needs) = (detail, needs);
        self.convention = view.depth.convention;
        let whole = self.layout.texture_size(size);
        self.resolved.resize(whole)?;
        let shining = needs.bloom.unwrap_or(Rectangle { origin: [0, 0], size });
        self.bloom.as_mut().map_or(Ok(()), |bloom| bloom.fit(shining))?;
        self.has_depth = false;
        let is_reversed = self.samples > 1 && view.depth.convention == DepthConvention::Reversed;
        self.carries = is_reversed && needs.depth && self.depth_resolve == DepthResolve::InColor;
        self.has_halves = self.carries || is_reversed && needs.half_depth;
        if self.has_halves {
            if self.halves.is_none() {
                let format = if self.carries { Format::Rg16F } else { Format::R16F };
                self.halves = Some(RenderTarget::new(&self.gl, whole, &[(format, Filter::Nearest)], None)?);
            }
            self.halves.as_mut().map_or(Ok(()), |halves| halves.resize(whole))?;
        }
        // OpenGL ES averages between equal rectangles only.
        let to = to.filter(|to| self.layout == Layout::Single && to.color.origin == [0, 0]);
        let texture = to.and_then(|to| to.texture);
        let is_direct = self.choose(whole, texture)? || self.onto == Onto::Samples && !needs.samples;
        self.elsewhere = texture.filter(|_| is_direct);
        Ok(is_direct && to.is_some())
    }

    /// Chooses the framebuffer. Returns true if it is that of a texture that was given.
    fn choose(&mut self, size: [u32; 2], texture: Option<(glow::Texture, Image)>) -> Result<bool, GlError> {
        self.onto = Onto::Resolved;
        if self.samples == 1 {
            return Ok(self.fit_one(texture));
        }
        if !self.needs.samples && (self.carries || !self.needs.depth) && self.fit_tile(texture) {
            self.onto = Onto::Tile;
            return Ok(texture.is_some());
        }
        self.onto = Onto::Samples;
        let readable = self.depth_resolve == DepthResolve::Samples;
        match &mut self.multisample {
            Some((samples, carried)) if *carried == self.carries => samples.resize(size)?,
            slot => {
                // The previous samples are deleted first.
                *slot = None;
                let colors = &[Format::Rgba8, Format::Rg16F][..1 + usize::from(self.carries)];
                let samples =
                    MultisampleTarget::new(&self.gl, size, self.samples, colors, SAMPLE_DEPTH, readable)?;
                *slot = Some((samples, self.carries));
            }
        }
        // A pass that reads them writes the picture and its depth.
        if self.needs.samples && self.fit_one(texture) {
            return Ok(true);
        }
        // A driver that refuses half floats beside the picture gets a depth buffer.
        let own = self.resolved.color(0).attachment();
        self.has_halves = self.has_halves && (self.carries || self.fit_one(Some(own)));
        Ok(false)
    }

    /// Attaches a texture beside depth of one sample; false if there is none, or the driver refuses.
    fn fit_one(&mut self, texture: Option<(glow::Texture, Image)>) -> bool {
        let halves = self.halves.as_ref().filter(|_| self.has_halves);
        texture.is_some_and(|color| attach(&mut self.one, color, halves, self.resolved.depth()))
    }

    /// Attaches what is drawn to the tiles; false if the driver has no such tiles. Colour goes to a texture if there is one.
    fn fit_tile(&mut self, texture: Option<(glow::Texture, Image)>) -> bool {
        let Some(tile) = &mut self.tile else { return false };
        let color = texture.unwrap_or(self.resolved.color(0).attachment());
        let halves = self.halves.as_ref().filter(|_| self.has_halves);
        let fits = attach(tile, color, halves, self.resolved.depth());
        if !fits {
            // The driver refuses these formats: it need not be asked again.
            self.tile = None;
        }
        fits
    }

    /// Returns the framebuffer for what is drawn over the picture elsewhere: that of its samples, whose colour and depth
    /// are lost, or one that has the picture's colour, and its depth if that has one sample.
    ///
    /// # Errors
    /// [`GlError`] if the driver refuses the texture.
    pub fn fit_over(&mut self, size: [u32; 2]) -> Result<Destination, GlError> {
        if self.onto != Onto::Tile {
            return Ok(self.destination(size));
        }
        let color = self.picture();
        let over = match &mut self.over {
            Some(over) => over,
            slot => slot.insert(TileTarget::new(&self.gl, self.samples)?),
        };
        // SAFETY: a texture of this context, by the contract of `EyeTarget`.
        unsafe { over.fit(&[color], self.resolved.depth())? };
        Ok(over.part(size))
    }

    /// Makes room for the complete picture of a view, and returns it.
    pub fn complete_picture(&mut self, size: [u32; 2]) -> Result<&RenderTarget, GlError> {
        picture(&self.gl, &mut self.composited, size)
    }

    /// Makes room for a picture with outlines beside the resolved one, and returns it.
    pub fn ink_picture(&mut self) -> Result<&RenderTarget, GlError> {
        let size = self.resolved.size();
        picture(&self.gl, &mut self.inked, size)
    }

    /// Declares what a pass writes that draws a view from its beginning: its average colour, and its depth or samples as far
    /// as they are needed afterwards.
    pub fn declare<'a>(&self, pass: Pass<'a>) -> Pass<'a> {
        let [color, depth] = [self.resolved.color(0), self.resolved.depth()].map(Texture::image);
        let pair = self.halves.as_ref().filter(|_| self.carries).map(|pair| pair.color(0).image());
        match (self.onto, &self.multisample) {
            (Onto::Samples, Some((samples, _))) if self.needs.samples => pass.write(samples.images()),
            (Onto::Samples, Some((samples, _))) => pass.in_tile(samples.images()),
            (Onto::Tile, _) => pass.write([color]).write(pair).in_tile([depth]),
            _ if self.needs.depth => pass.write([color, depth]),
            _ => pass.write([color]).in_tile([depth]),
        }
    }

    /// Returns the samples outside tiles.
    pub fn multisample(&self) -> Option<&MultisampleTarget> {
        self.multisample.as_ref().map(|(samples, _)| samples)
    }

    /// Returns the lower left part, of this size, of the image that is drawn into.
    pub fn destination(&self, size: [u32; 2]) -> Destination {
        match (self.onto, &self.multisample, &self.tile) {
            (Onto::Samples, Some((samples, _)), _) => samples.part(size),
            (Onto::Tile, _, Some(tile)) => tile.part(size),
            (Onto::Resolved, ..) if self.elsewhere.is_some() => self.one.part(size),
            _ => Destination { framebuffer: Some(self.resolved.raw()), origin: [0, 0], size },
        }
    }

    /// Binds the image that is drawn into, with a viewport of `size` pixels.
    pub fn bind(&self, size: [u32; 2]) {
        if self.layout == Layout::Layered {
            // Notes that several views are drawn at once.
            self.resolved.bind();
        }
        let to = self.destination(size);
        self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
    }

    /// Returns the place of the resolved picture and its depth, for a pass that reads the samples.
    pub fn resolved_place(&self) -> Destination {
        let whole = Destination::whole(&self.resolved);
        let is_one = self.elsewhere.is_some() || self.has_halves;
        if is_one { self.one.part(whole.size) } else { whole }
    }

    /// Discards the depth of the bound framebuffer.
    pub fn discard_depth(&self) {
        self.one.discard_depth();
    }

    /// Returns the texture of the resolved picture ([`Targets::color`]), which may be somebody else's.
    pub fn picture(&self) -> (glow::Texture, Image) {
        self.elsewhere.unwrap_or(self.color().color(0).attachment())
    }

    /// Returns the resolved picture: display-referred sRGB without bloom, filtered linearly. Alpha is luma; with several
    /// samples it is undefined where a cut-out material is.
    pub fn color(&self) -> &RenderTarget {
        self.inked.as_ref().unwrap_or(&self.resolved)
    }

    /// Returns the nearest depth of each pixel of an eye, whose image starts at `offset` from the eye's own corner.
    ///
    /// # Panics
    /// If it was not requested since the last surface was drawn.
    pub fn depth(&self, size: [u32; 2], eye: Eye, offset: [u32; 2]) -> DepthImage<'_> {
        assert!(self.has_depth, "this view was rendered without its depth");
        let corner = self.layout.origin(size, eye);
        DepthImage {
            texture: self.nearest(),
            origin: [0, 1].map(|i| corner[i] + offset[i]),
            layer: self.layer(eye),
            is_pair: self.carries,
            convention: self.convention,
        }
    }

    /// Returns the texture of the nearest depth, or of the depth of two samples.
    pub fn nearest(&self) -> &Texture {
        let halves = self.halves.as_ref().filter(|_| self.has_halves);
        halves.map_or(self.resolved.depth(), |halves| halves.color(0))
    }

    /// Returns the layer of an eye's colour, if the image is an array.
    pub fn color_layer(&self, eye: Eye) -> Option<u32> {
        self.layer(eye).filter(|_| self.inked.is_none())
    }

    /// Returns the layer of an eye, if the images are arrays.
    pub fn layer(&self, eye: Eye) -> Option<u32> {
        (self.layout == Layout::Layered).then_some(eye.index() as u32)
    }
}

/// Attaches a picture, depth in half floats if it is given, and a depth buffer; false if the driver refuses.
fn attach(
    to: &mut TileTarget,
    color: (glow::Texture, Image),
    halves: Option<&RenderTarget>,
    depth: &Texture,
) -> bool {
    let halves = halves.map(|halves| halves.color(0).attachment());
    let colors = [color, halves.unwrap_or(color)];
    // SAFETY: textures of this context: our own, and the caller's by the contract of `EyeTarget`.
    unsafe { to.fit(&colors[..1 + usize::from(halves.is_some())], depth) }.is_ok()
}

/// Returns a picture of this size, made on the first call.
fn picture<'a>(
    gl: &Rc<Context>,
    slot: &'a mut Option<RenderTarget>,
    size: [u32; 2],
) -> Result<&'a RenderTarget, GlError> {
    let target = match slot.take() {
        Some(mut target) => {
            target.resize(size)?;
            target
        }
        None => RenderTarget::new(gl, size, &[PICTURE], None)?,
    };
    Ok(slot.insert(target))
}
