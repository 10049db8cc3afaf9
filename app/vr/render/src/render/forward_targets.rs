//! The images that the forward renderer draws into.

use std::cell::Cell;
use std::rc::Rc;

use super::bloom::BloomTargets;
use super::deferred::hdr_format;
use super::g_buffer::Layout;
use super::request::DrawRequest;
use super::settings::{RenderSettings, SAMPLE_DEPTH};
use super::view::ViewImages;
use yoro::eyes::Eye;
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, MultisampleTarget, RenderTarget, Texture, TileTarget,
};

/// The images of one view, or of both eyes side by side.
///
/// A pixel costs 8 bytes for each sample that leaves the tile, 8 bytes of resolved colour and depth, and with bloom or
/// outlines 4 bytes of developed colour.
pub struct ForwardTargets {
    gl: Rc<Context>,
    layout: Layout,
    /// The samples outside tiles. `None` with one sample in each pixel.
    samples: Option<MultisampleTarget>,
    /// The samples in tiles, if the driver can keep them there.
    tile: Option<TileTarget>,
    /// True if samples stay in tiles in the current frame.
    in_tile: bool,
    /// Average colour, nearest depth.
    pub(super) resolved: RenderTarget,
    pub(super) bloom: Option<BloomTargets>,
    /// Colour of one eye with bloom and outlines, if there are any.
    pub(super) developed: Option<RenderTarget>,
    /// The request that the view in the targets was rendered for.
    pub(super) request: DrawRequest,
    /// True if the resolved depth belongs to what was drawn last.
    has_depth: Cell<bool>,
    /// One column of colour, copied into the columns beside those that are drawn.
    column: Option<RenderTarget>,
}

impl ForwardTargets {
    /// Makes targets, to be fitted to a view before they are drawn into.
    pub(crate) fn new(
        gl: &Rc<Context>,
        layout: Layout,
        settings: &RenderSettings,
    ) -> Result<ForwardTargets, GlError> {
        ForwardTargets::build(gl, layout, settings, gl.capabilities().multisample_textures)
    }

    /// Makes targets whose samples shaders can read (`readable`) or cannot.
    pub(super) fn build(
        gl: &Rc<Context>,
        layout: Layout,
        settings: &RenderSettings,
        readable: bool,
    ) -> Result<ForwardTargets, GlError> {
        settings.supported(gl.capabilities())?;
        let bloom = settings.bloom.then(|| BloomTargets::new(gl, hdr_format(gl)));
        let size = layout.texture_size([1, 1]);
        let samples = (settings.samples() > 1).then(|| {
            MultisampleTarget::new(gl, size, settings.samples(), Format::Rgba8, SAMPLE_DEPTH, readable)
        });
        let tile = (settings.samples() > 1 && gl.capabilities().tile_samples)
            .then(|| TileTarget::new(gl, settings.samples()));
        let formats = [(Format::Rgba8, Filter::Linear)];
        Ok(ForwardTargets {
            gl: gl.clone(),
            layout,
            samples: samples.transpose()?,
            tile: tile.transpose()?,
            in_tile: false,
            resolved: RenderTarget::new(gl, size, &formats, Some(settings.depth_format(readable)))?,
            bloom: bloom.transpose()?,
            developed: None,
            request: DrawRequest::default(),
            has_depth: Cell::new(false),
            column: None,
        })
    }

    /// Fits the targets to views of `size` pixels; does nothing if they already fit. `is_developed` makes room for
    /// bloom and outlines. `in_tile` says that no sample is needed after drawing, so that all may stay in tiles.
    pub fn fit(&mut self, size: [u32; 2], is_developed: bool, in_tile: bool) -> Result<(), GlError> {
        let whole = self.layout.texture_size(size);
        self.resolved.resize(whole)?;
        self.in_tile = false;
        if in_tile && let Some(tile) = &mut self.tile {
            self.in_tile = tile.fit(&self.resolved).is_ok();
        }
        if let Some(samples) = self.samples.as_mut().filter(|_| !self.in_tile) {
            samples.resize(whole)?;
        }
        self.bloom.as_mut().map_or(Ok(()), |t| t.resize(size))?;
        match &mut self.developed {
            Some(_) if !is_developed => self.developed = None,
            Some(target) => target.resize(size)?,
            None if is_developed => {
                let formats = [(Format::Rgba8, Filter::Linear)];
                self.developed = Some(RenderTarget::new(&self.gl, size, &formats, None)?);
            }
            None => {}
        }
        Ok(())
    }

    /// Fills the resolved colour to the left of columns `[first, end]` with the first of them, and to the right with
    /// the last.
    pub fn repeat_columns(&mut self, [first, end]: [u32; 2]) -> Result<(), GlError> {
        let [width, height] = self.resolved.size();
        if self.column.is_none() {
            let formats = [(Format::Rgba8, Filter::Nearest)];
            self.column = Some(RenderTarget::new(&self.gl, [1, height], &formats, None)?);
        }
        let Some(column) = &mut self.column else { return Ok(()) };
        column.resize([1, height])?;
        let column = Destination::whole(column);
        let part = |x: u32, width: u32| Destination {
            origin: [x, 0],
            size: [width, height],
            ..Destination::whole(&self.resolved)
        };
        self.gl.pass("repeat", || {
            for (from, to, columns) in [(first, 0, first), (end - 1, end, width - end)] {
                if columns > 0 {
                    // OpenGL ES cannot copy within one image.
                    self.gl.copy(&part(from, 1), &column);
                    self.gl.copy(&column, &part(to, columns));
                }
            }
        });
        Ok(())
    }

    /// Returns which views the targets hold.
    pub(crate) fn layout(&self) -> Layout {
        self.layout
    }

    /// Returns the lower left corner of an eye of `size` pixels in [`ViewImages::color`].
    pub(crate) fn origin(&self, size: [u32; 2], eye: Eye) -> [u32; 2] {
        if self.developed.is_some() { [0, 0] } else { self.layout.origin(size, eye) }
    }

    /// Returns the samples in tiles, if they stay there in the current frame.
    pub(super) fn tile(&self) -> Option<&TileTarget> {
        self.tile.as_ref().filter(|_| self.in_tile)
    }

    /// Returns the samples outside tiles, if a pixel has several.
    pub(super) fn samples(&self) -> Option<&MultisampleTarget> {
        self.samples.as_ref()
    }

    /// True if shaders can read each sample.
    pub(super) fn is_readable(&self) -> bool {
        self.samples.as_ref().is_some_and(|samples| samples.depth().is_some())
    }

    /// Notes that something is drawn. With several samples, the resolved depth is out of date until the next resolve.
    pub(super) fn draws_depth(&self) {
        self.has_depth.set(self.samples.is_none());
    }

    /// Notes that the resolved depth is up to date.
    pub(super) fn has_resolved_depth(&self) {
        self.has_depth.set(true);
    }

    /// Binds the image that is drawn into, with a viewport of `size` pixels.
    pub(super) fn bind(&self, size: [u32; 2]) {
        match (&self.samples, self.tile()) {
            (_, Some(tile)) => tile.bind(size),
            (Some(samples), _) => samples.bind(size),
            (None, _) => self.gl.bind_framebuffer(Some(self.resolved.raw()), [0, 0], size),
        }
    }
}

impl ViewImages for ForwardTargets {
    /// Returns display-referred sRGB, filtered linearly. Alpha is luma; with several samples it is undefined where a
    /// cut-out material is.
    fn color(&self) -> &RenderTarget {
        self.developed.as_ref().unwrap_or(&self.resolved)
    }

    /// Returns the nearest depth of each pixel's samples; without multisample textures (OpenGL ES 3.0) that of one.
    ///
    /// # Panics
    /// If it was not requested since the last surface was drawn.
    fn depth(&self) -> &Texture {
        assert!(self.has_depth.get(), "this view was rendered without its depth");
        self.resolved.depth()
    }
}
