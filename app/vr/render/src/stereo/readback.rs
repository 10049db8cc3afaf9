//! Small images that the CPU reads without waiting for the GPU.

use std::rc::Rc;

use yoro_gl::{Context, Filter, Format, GlError, PixelBuffer, RenderTarget};

/// An RGBA8 image that is drawn once a frame and read two frames later. By then the GPU has finished it, if the display
/// paces the frames.
pub(super) struct Readback {
    image: RenderTarget,
    /// Each with true if it was filled since it was last read.
    buffers: [(PixelBuffer, bool); 2],
    /// Index of the buffer that was filled first.
    first: usize,
}

impl Readback {
    pub(super) fn new(gl: &Rc<Context>, size: [u32; 2]) -> Result<Readback, GlError> {
        let buffer = || PixelBuffer::new(gl, (size[0] * size[1] * 4) as usize);
        Ok(Readback {
            image: RenderTarget::new(gl, size, &[(Format::Rgba8, Filter::Nearest)], None)?,
            buffers: [(buffer()?, false), (buffer()?, false)],
            first: 0,
        })
    }

    /// Returns the image, to be drawn into before [`Readback::start`].
    pub(super) fn image(&self) -> &RenderTarget {
        &self.image
    }

    /// Starts to read what was drawn.
    pub(super) fn start(&mut self) {
        let (buffer, is_filled) = &mut self.buffers[self.first];
        self.image.read_into(buffer);
        *is_filled = true;
        self.first ^= 1;
    }

    /// Stores the texels of the last but one [`Readback::start`] in `bytes`, zeros if the driver cannot provide them.
    /// Returns false if they were read already.
    pub(super) fn take(&mut self, bytes: &mut [u8]) -> bool {
        let (buffer, is_filled) = &mut self.buffers[self.first];
        if !std::mem::take(is_filled) {
            return false;
        }
        buffer.read(bytes);
        true
    }
}
