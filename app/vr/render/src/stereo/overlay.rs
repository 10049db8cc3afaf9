//! The last pass of an eye over which more is drawn: opaque surfaces in its holes, and transparent ones.

use std::rc::Rc;

use super::frame::Frame;
use crate::view::{DepthImage, MARKED_DEPTH, Region, Renderer};
use yoro::eyes::{DepthConvention, Eye};
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, MultisampleTarget, RenderTarget, Texture, TileTarget,
};

/// The format of depth, as in the samples of a view.
const DEPTH: Format = Format::Depth32F;

/// What is drawn over an eye after it is composited or synthesized.
#[derive(Clone, Copy, Default)]
pub(super) struct OverlaySurfaces {
    pub(super) transparent: bool,
    /// True if the eye's holes are left open, for opaque surfaces to be drawn there first.
    pub(super) holes: bool,
    /// True if the eye's depth is read afterwards.
    pub(super) keeps_depth: bool,
}

impl OverlaySurfaces {
    /// Returns the region of an eye in which its depth is needed: where transparent surfaces are drawn over it.
    pub(super) fn depth_region(&self, frame: &Frame, eye: Eye) -> Option<Region> {
        frame.scene.transparent_region(&frame.pair.view(eye)).filter(|_| self.transparent)
    }
}

/// The images in which an eye is finished. A picture and its depth are written, more is drawn over them, and the average
/// of the samples is the eye's image: all in one pass, which reads nothing back, and stores no sample unless somebody reads
/// the eye's depth. That is the same in all samples of a pixel, since transparent surfaces write none; where holes are
/// rendered, it is that of one of them.
pub(super) struct OverlayPass {
    gl: Rc<Context>,
    samples: u32,
    /// The format of depth.
    depth: Format,
    /// Samples outside tiles.
    multisample: Option<MultisampleTarget>,
    /// Samples in tiles, or one sample, in the eye's own texture; and the depth of one eye, which is never kept.
    tile: Option<(TileTarget, Option<Texture>)>,
    /// One sample.
    image: Option<RenderTarget>,
    target: OverlayTarget,
    /// The place of the current eye.
    place: Destination,
}

/// Where the current eye is finished.
#[derive(Clone, Copy, PartialEq, Eq)]
enum OverlayTarget {
    /// In its own target: nothing is drawn over it.
    Direct,
    Image,
    Samples,
    Tile,
}

impl OverlayPass {
    /// Makes it without images; with `holes`, for eyes whose holes may be left open.
    pub(super) fn new(renderer: &Renderer, holes: bool) -> Result<OverlayPass, GlError> {
        let (gl, samples) = (&renderer.gl, renderer.settings.msaa);
        let has_tile = samples == 1 || gl.capabilities().tile_samples;
        let tile = has_tile.then(|| TileTarget::new(gl, samples));
        Ok(OverlayPass {
            gl: gl.clone(),
            samples,
            depth: if holes { MARKED_DEPTH } else { DEPTH },
            multisample: None,
            tile: tile.transpose()?.map(|tile| (tile, None)),
            image: None,
            target: OverlayTarget::Direct,
            place: Destination { framebuffer: None, origin: [0, 0], size: [0, 0] },
        })
    }

    /// Returns the place to write an eye to, and true if depth is to be written there: something is drawn over the eye, or
    /// somebody reads its depth.
    pub(super) fn begin(
        &mut self,
        frame: &Frame,
        eye: Eye,
        over: &OverlaySurfaces,
    ) -> Result<(Destination, bool), GlError> {
        let (place, has_depth) = self.choose(frame, eye, over)?;
        self.place = place;
        Ok((place, has_depth))
    }

    fn choose(
        &mut self,
        frame: &Frame,
        eye: Eye,
        over: &OverlaySurfaces,
    ) -> Result<(Destination, bool), GlError> {
        let (to, size) = (frame.to(eye), frame.pair.size);
        let keeps_depth = over.keeps_depth;
        let is_drawn_over = over.transparent || over.holes;
        if !is_drawn_over && !keeps_depth {
            self.target = OverlayTarget::Direct;
            return Ok((to.color, false));
        }
        // Both begin in the corner of their textures.
        let is_in_corner = to.color.origin == [0, 0];
        if !keeps_depth && is_in_corner && self.fit_tile(to.texture.map(|texture| (texture, size)))? {
            self.target = OverlayTarget::Tile;
            let tile = self.tile.as_ref().map(|(tile, _)| tile.part(size));
            return Ok((tile.unwrap_or(to.color), true));
        }
        // OpenGL ES averages between equal rectangles only.
        if is_drawn_over && self.samples > 1 && is_in_corner {
            self.target = OverlayTarget::Samples;
            let samples = match &mut self.multisample {
                Some(samples) => samples,
                slot => {
                    let colors = [Format::Rgba8];
                    let made =
                        MultisampleTarget::new(&self.gl, size, self.samples, &colors, self.depth, false)?;
                    slot.insert(made)
                }
            };
            samples.resize(size)?;
            let place = samples.part(size);
            if keeps_depth {
                self.fit_image(size)?;
            }
            return Ok((place, true));
        }
        self.target = OverlayTarget::Image;
        Ok((Destination::whole(self.fit_image(size)?), true))
    }

    /// Does what writes the current eye into the place that [`OverlayPass::begin`] returned.
    pub(super) fn draw<R>(&self, body: impl FnOnce() -> R) -> R {
        match self.target {
            OverlayTarget::Samples | OverlayTarget::Tile => self.gl.within_tile(body),
            OverlayTarget::Direct | OverlayTarget::Image => body(),
        }
    }

    /// Returns the image of one sample, with this size.
    fn fit_image(&mut self, size: [u32; 2]) -> Result<&RenderTarget, GlError> {
        let image = match &mut self.image {
            Some(image) => image,
            slot => {
                let color = (Format::Rgba8, Filter::Linear);
                slot.insert(RenderTarget::new(&self.gl, size, &[color], Some(self.depth))?)
            }
        };
        image.resize(size)?;
        Ok(image)
    }

    /// Returns the number of samples in a pixel of the current eye.
    pub(super) fn samples(&self) -> u32 {
        if self.target == OverlayTarget::Image { 1 } else { self.samples }
    }

    /// Returns the image of depth, which is that of the eye finished last if that eye's depth is kept.
    pub(super) fn depth(&self) -> Option<DepthImage<'_>> {
        let convention = DepthConvention::Reversed;
        let image = |texture| DepthImage { texture, origin: [0, 0], layer: None, is_pair: false, convention };
        self.image.as_ref().map(|made| image(made.depth()))
    }

    /// Attaches an eye's texture; false if there is none, or the driver has no samples in tiles.
    fn fit_tile(&mut self, to: Option<((glow::Texture, yoro_gl::Image), [u32; 2])>) -> Result<bool, GlError> {
        let (Some((tile, depth)), Some((color, size))) = (&mut self.tile, to) else { return Ok(false) };
        if (0..2).any(|i| color.1.size[i] < size[i]) {
            return Ok(false);
        }
        let depth = match depth.take().filter(|depth| depth.size() == size) {
            Some(made) => depth.insert(made),
            None => depth.insert(Texture::new(&self.gl, size, self.depth, Filter::Nearest)?),
        };
        // SAFETY: the caller's texture, by the contract of `EyeTarget`.
        let fits = unsafe { tile.fit(&[color], depth) }.is_ok();
        if !fits {
            // The driver need not be asked again.
            self.tile = None;
        }
        Ok(fits)
    }

    /// Draws over the eye that was written to the place that [`OverlayPass::begin`] returned, and completes its target.
    pub(super) fn finish(&self, frame: &Frame, eye: Eye, over: &OverlaySurfaces) {
        if self.target == OverlayTarget::Direct {
            return;
        }
        let view = frame.pair.view(eye);
        if over.transparent {
            let place = &self.place;
            self.gl.bind_framebuffer(place.framebuffer, place.origin, place.size);
            frame.renderer.draw_over(&frame.scene, &view, self.samples());
        }
        match (self.target, &self.multisample, &self.tile, &self.image) {
            (OverlayTarget::Samples, Some(samples), ..) => {
                let pass = self.gl.pass("resolve").in_tile(samples.images());
                let depth = self.image.as_ref().filter(|_| over.keeps_depth);
                let pass = pass.write(depth.map(|image| image.depth().image()));
                pass.write([frame.to(eye).color.image(Format::Rgba8)]).run(|| {
                    samples.average(0, &frame.to(eye).color);
                    if let Some(image) = depth {
                        samples.copy_depth(image);
                    }
                    samples.discard(true, true);
                });
                if let Some(depth) = self.depth().filter(|_| depth.is_some()) {
                    frame.write_depth(eye, &depth);
                }
            }
            (OverlayTarget::Tile, _, Some((tile, _)), _) => {
                let pass = self.gl.pass("resolve").write([frame.to(eye).color.image(Format::Rgba8)]);
                pass.run(|| tile.discard_depth());
            }
            (OverlayTarget::Image, .., Some(image)) => {
                let to = &frame.to(eye).color;
                let pass = self.gl.pass("copy").read("copied", image.color(0));
                pass.write([to.image(Format::Rgba8)]).run(|| image.copy_color([0, 0], to));
                if let Some(depth) = self.depth().filter(|_| over.keeps_depth) {
                    frame.write_depth(eye, &depth);
                }
            }
            _ => {}
        }
    }
}
