//! A buffer for reading pixels back asynchronously.

use std::rc::Rc;

use glow::HasContext;

use crate::{Context, GlError};

/// A pixel pack buffer of fixed length.
pub struct PixelBuffer {
    gl: Rc<Context>,
    raw: glow::Buffer,
    len: usize,
}

impl PixelBuffer {
    /// Creates a buffer of `len` bytes.
    ///
    /// # Errors
    /// [`GlError::Object`] if the driver refuses.
    pub fn new(gl: &Rc<Context>, len: usize) -> Result<PixelBuffer, GlError> {
        let raw_gl = gl.raw();
        // SAFETY: the buffer is new. It is unbound at the end, since a bound buffer would redirect every readback.
        let raw = unsafe {
            let raw = raw_gl
                .create_buffer()
                .map_err(|reason| GlError::Object { what: "a pixel buffer".into(), reason })?;
            raw_gl.bind_buffer(glow::PIXEL_PACK_BUFFER, Some(raw));
            raw_gl.buffer_data_size(glow::PIXEL_PACK_BUFFER, len as i32, glow::STREAM_READ);
            raw_gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
            raw
        };
        gl.count(1);
        Ok(PixelBuffer { gl: gl.clone(), raw, len })
    }

    /// Returns the GL name.
    pub(crate) fn raw(&self) -> glow::Buffer {
        self.raw
    }

    /// Copies the beginning of the buffer into `bytes`, or zeros if the driver cannot map the buffer. Waits for the
    /// readback that fills it.
    ///
    /// # Panics
    /// If `bytes` is longer than the buffer.
    pub fn read(&self, bytes: &mut [u8]) {
        assert!(bytes.len() <= self.len, "more bytes than the buffer has");
        let gl = self.gl.raw();
        // WebGL cannot map buffers.
        #[cfg(target_arch = "wasm32")]
        // SAFETY: the buffer is as long as the slice.
        unsafe {
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, Some(self.raw));
            gl.get_buffer_sub_data(glow::PIXEL_PACK_BUFFER, 0, bytes);
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
        }
        #[cfg(not(target_arch = "wasm32"))]
        // SAFETY: the mapped range is as long as the slice, and is unmapped before anything else uses it.
        unsafe {
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, Some(self.raw));
            let mapped =
                gl.map_buffer_range(glow::PIXEL_PACK_BUFFER, 0, bytes.len() as i32, glow::MAP_READ_BIT);
            if mapped.is_null() {
                bytes.fill(0);
            } else {
                bytes.copy_from_slice(std::slice::from_raw_parts(mapped, bytes.len()));
                gl.unmap_buffer(glow::PIXEL_PACK_BUFFER);
            }
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
        }
    }
}

impl Drop for PixelBuffer {
    fn drop(&mut self) {
        // SAFETY: created in `new`, deleted once.
        unsafe { self.gl.raw().delete_buffer(self.raw) };
        self.gl.count(-1);
    }
}
