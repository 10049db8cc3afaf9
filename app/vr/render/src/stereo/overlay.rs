//! The last pass of an eye over which transparent surfaces are drawn.

use std::rc::Rc;

use super::frame::Frame;
use crate::view::{DepthImage, Rectangle, Renderer};
use yoro::eyes::{DepthConvention, Eye};
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, MultisampleTarget, RenderTarget, Texture, TileTarget,
};

/// The format of depth, as in the samples of a view.
const DEPTH: Format = Format::Depth32F;

/// Returns the part of an eye in which its depth is needed: where transparent surfaces are drawn over it, or all of it if
/// its depth is wanted.
pub(super) fn depth_part(frame: &Frame, eye: Eye, transparent: bool) -> Option<Rectangle> {
    if frame.wants_depth(eye) {
        return Some(Rectangle::whole(frame.pair.size));
    }
    frame.scene.transparent_part(&frame.pair.view(eye)).filter(|_| transparent)
}

/// The images in which an eye is finished. A picture and its depth are written, more is drawn over them, and the average
/// of the samples is the eye's image: all in one pass, which reads nothing back, and stores no sample unless somebody reads
/// the eye's depth. That is the same in all samples of a pixel, since transparent surfaces write none.
pub(super) struct OverlayPass {
    gl: Rc<Context>,
    samples: u32,
    /// Samples outside tiles.
    multisample: Option<MultisampleTarget>,
    /// Samples in tiles, and the depth of one eye, which is never written.
    tile: Option<(TileTarget, Option<Texture>)>,
    /// One sample, or the depth of several.
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
    /// Makes it without images.
    pub(super) fn new(renderer: &Renderer) -> Result<OverlayPass, GlError> {
        let (gl, samples) = (&renderer.gl, renderer.settings.msaa);
        let tile = (samples > 1 && gl.capabilities().tile_samples).then(|| TileTarget::new(gl, samples));
        Ok(OverlayPass {
            gl: gl.clone(),
            samples,
            multisample: None,
            tile: tile.transpose()?.map(|tile| (tile, None)),
            image: None,
            target: OverlayTarget::Direct,
            place: Destination { framebuffer: None, origin: [0, 0], size: [0, 0] },
        })
    }

    /// Returns the place to write an eye to, with depth if transparent surfaces are drawn over it or its depth is wanted.
    pub(super) fn begin(
        &mut self,
        frame: &Frame,
        eye: Eye,
        transparent: bool,
    ) -> Result<(Destination, bool), GlError> {
        let (place, has_depth) = self.choose(frame, eye, transparent)?;
        self.place = place;
        Ok((place, has_depth))
    }

    fn choose(&mut self, frame: &Frame, eye: Eye, transparent: bool) -> Result<(Destination, bool), GlError> {
        let (to, size) = (frame.to(eye), frame.pair.size);
        let wants_depth = frame.wants_depth(eye);
        if !transparent && !wants_depth {
            self.target = OverlayTarget::Direct;
            return Ok((to.color, false));
        }
        if !wants_depth && self.fit_tile(to.texture.map(|texture| (texture, size)))? {
            self.target = OverlayTarget::Tile;
            let tile = self.tile.as_ref().map(|(tile, _)| tile.part(size));
            return Ok((tile.unwrap_or(to.color), true));
        }
        // OpenGL ES averages between equal rectangles only.
        let is_sampled = transparent && self.samples > 1 && to.color.origin == [0, 0];
        if wants_depth || !is_sampled {
            let image = match &mut self.image {
                Some(image) => image,
                slot => slot.insert(RenderTarget::new(
                    &self.gl,
                    size,
                    &[(Format::Rgba8, Filter::Linear)],
                    Some(DEPTH),
                )?),
            };
            image.resize(size)?;
            if !is_sampled {
                self.target = OverlayTarget::Image;
                return Ok((Destination::whole(image), true));
            }
        }
        self.target = OverlayTarget::Samples;
        let samples = match &mut self.multisample {
            Some(samples) => samples,
            slot => {
                let colors = [Format::Rgba8];
                let made = MultisampleTarget::new(&self.gl, size, self.samples, &colors, DEPTH, false)?;
                slot.insert(made)
            }
        };
        samples.resize(size)?;
        Ok((samples.part(size), true))
    }

    /// Attaches an eye's texture to the tiles; false if there are no such tiles, or no texture.
    fn fit_tile(&mut self, to: Option<((glow::Texture, yoro_gl::Image), [u32; 2])>) -> Result<bool, GlError> {
        let (Some((tile, depth)), Some((color, size))) = (&mut self.tile, to) else { return Ok(false) };
        if color.1.size != size {
            return Ok(false);
        }
        let depth = match depth.take().filter(|depth| depth.size() == size) {
            Some(made) => depth.insert(made),
            None => depth.insert(Texture::new(&self.gl, size, DEPTH, Filter::Nearest)?),
        };
        // SAFETY: the caller's texture, by the contract of `EyeTarget`.
        Ok(unsafe { tile.fit(&[color], depth) }.is_ok())
    }

    /// Draws over the eye that was written to the place that [`OverlayPass::begin`] returned, and completes its target.
    pub(super) fn finish(&self, frame: &Frame, eye: Eye, transparent: bool) {
        if self.target == OverlayTarget::Direct {
            return;
        }
        let view = frame.pair.view(eye);
        let samples = if self.target == OverlayTarget::Image { 1 } else { self.samples };
        if transparent {
            let place = &self.place;
            self.gl.bind_framebuffer(place.framebuffer, place.origin, place.size);
            frame.renderer.draw_over(&frame.scene, &view, samples);
        }
        let depth_read = self.image.as_ref().filter(|_| frame.wants_depth(eye));
        match (self.target, &self.multisample, &self.tile, &self.image) {
            (OverlayTarget::Samples, Some(samples), ..) => {
                let pass = self.gl.pass("resolve").in_tile(samples.images());
                let pass = pass.write(depth_read.map(|image| image.depth().image()));
                pass.write([frame.to(eye).color.image(Format::Rgba8)]).run(|| {
                    samples.average(0, &frame.to(eye).color);
                    if let Some(image) = depth_read {
                        samples.copy_depth(image);
                    }
                    samples.discard(true, true);
                });
            }
            (OverlayTarget::Tile, _, Some((tile, _)), _) => tile.discard_depth(),
            (OverlayTarget::Image, .., Some(image)) => {
                let to = &frame.to(eye).color;
                let pass = self.gl.pass("copy").read("copied", image.color(0));
                pass.write([to.image(Format::Rgba8)]).run(|| image.copy_color([0, 0], to));
            }
            _ => {}
        }
        if let Some(image) = depth_read {
            let depth = DepthImage {
                texture: image.depth(),
                origin: [0, 0],
                layer: None,
                is_pair: false,
                convention: DepthConvention::Reversed,
            };
            frame.write_depth(eye, &depth);
        }
    }
}
