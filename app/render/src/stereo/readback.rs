//! Small images that the CPU reads without waiting for the GPU.

use std::rc::Rc;

use yoro_gl::{Context, Filter, Format, GlError, PixelBuffer, RenderTarget};

/// An RGBA8 image that is drawn once a frame and read two frames later. By then the GPU is done with it, where the
/// display paces it. A `T` says what was drawn.
pub(super) struct Readback<T> {
    image: RenderTarget,
    buffers: [(PixelBuffer, Option<T>); 2],
    /// The buffer that was filled first.
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

    /// The image to draw into before [`Readback::start`].
    pub(super) fn image(&self) -> &RenderTarget {
        &self.image
    }

    /// Starts to read what was drawn.
    pub(super) fn start(&mut self, drawn: T) {
        let (buffer, kept) = &mut self.buffers[self.first];
        self.image.read_into(buffer);
        *kept = Some(drawn);
        self.first ^= 1;
    }

    /// Returns what was drawn two [`Readback::start`]s ago, once. Its texels come in `bytes`: zeros if the driver
    /// cannot give them.
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
