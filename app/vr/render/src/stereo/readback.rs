//! Small images that the CPU reads without waiting for the GPU.

use std::rc::Rc;

use yoro_gl::{Context, Filter, Format, GlError, PixelBuffer, RenderTarget};

/// An RGBA8 image that is drawn once a frame and read two frames later. By then the GPU has finished it, if the display
/// paces the frames. A `T` describes what was drawn.
pub(super) struct Readback<T> {
    image: RenderTarget,
    buffers: [(PixelBuffer, Option<T>); 2],
    /// Index of the buffer that was filled first.
    first: usize,
}

impl<T> Readback<T> {
    pub(super) fn new(gl: &Rc<Context>, size: [u32; 2]) -> Result<Readback<T>, GlError> {
        let buffer = || PixelBuffer::new(gl, (size[0] * size[1] * 4) as usize);
        Ok(Readback {
            image: RenderTarget::new(gl, size, &[(Format::Rgba8, Filter::Nearest)], None)?,
            buffers: [(buffer()?, None), (buffer()?, None)],
            first: 0,
        })
    }

    /// Returns the image, to be drawn into before [`Readback::start`].
    pub(super) fn image(&self) -> &RenderTarget {
        &self.image
    }

    /// Starts to read what was drawn, described by `drawn`.
    pub(super) fn start(&mut self, drawn: T) {
        let (buffer, kept) = &mut self.buffers[self.first];
        self.image.read_into(buffer);
        *kept = Some(drawn);
        self.first ^= 1;
    }

    /// Returns the description of what was drawn at the last but one [`Readback::start`], once, and stores its texels
    /// in `bytes`: zeros if the driver cannot provide them.
    pub(super) fn take(&mut self, bytes: &mut [u8]) -> Option<T> {
        let (buffer, kept) = &mut self.buffers[self.first];
        let drawn = kept.take()?;
        buffer.read(bytes);
        Some(drawn)
    }

    /// Forgets what was drawn so far.
    pub(super) fn forget(&mut self) {
        self.buffers.iter_mut().for_each(|(_, kept)| *kept = None);
    }
}
