//! Reads images back. For tests.

use glow::HasContext as _;
use yoro::opengl::{Destination, GlApi};
use yoro::synthesis::backend::WarpKind;

use super::{Objects, Synthesizer, bind_framebuffers, bound_framebuffers};
use crate::geometry::Rectangle;
use crate::reason::Reason;
use crate::synthesizer::Image;

impl<W: WarpKind> Synthesizer<W> {
    /// Reads a rectangle of a colour image as red, green and blue.
    ///
    /// # Errors
    /// Fails if the format does not have four bytes per pixel, or the context cannot be made current.
    ///
    /// # Safety
    /// As for [`crate::synthesizer::Synthesizer::read`].
    pub(super) unsafe fn read_rgb(&mut self, image: Image, part: Rectangle) -> Result<Vec<u8>, String> {
        // OpenGL ES reads other formats in their own type.
        let bytes = [glow::RGBA8, glow::SRGB8_ALPHA8].map(i64::from).contains(&image.format);
        if !bytes && self.objects.context.capabilities().api == GlApi::Es {
            return Err(format!("0x{:x} is no format of four bytes", image.format));
        }
        // SAFETY: same contract.
        let rows = unsafe {
            let _current = self.binding.make_current().map_err(|reason| reason.to_string())?;
            self.objects.read(image, part).map_err(|reason| reason.to_string())?
        };
        let rows = rows.chunks_exact(part.size[0] as usize * 4).rev();
        Ok(rows
            .flat_map(|row| row.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]))
            .collect())
    }
}

impl<W: WarpKind> Objects<W> {
    /// Returns four bytes per pixel, with rows from the bottom.
    unsafe fn read(&mut self, image: Image, part: Rectangle) -> Result<Vec<u8>, Reason> {
        // SAFETY: same contract.
        let framebuffer = unsafe { self.framebuffer([Some(image), None])? };
        let gl = self.context.raw();
        let before = bound_framebuffers(gl);
        // SAFETY: state of the current context, which is restored.
        unsafe {
            let buffer = gl.get_parameter_buffer(glow::PIXEL_PACK_BUFFER_BINDING);
            let stores =
                [glow::PACK_ALIGNMENT, glow::PACK_ROW_LENGTH, glow::PACK_SKIP_ROWS, glow::PACK_SKIP_PIXELS];
            let values = stores.map(|name| gl.get_parameter_i32(name));
            let from = Destination { framebuffer: Some(framebuffer), origin: part.origin, size: part.size };
            let bytes = self.context.read_rgba8(&from);
            for (name, value) in stores.into_iter().zip(values) {
                gl.pixel_store_i32(name, value);
            }
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, buffer);
            bind_framebuffers(gl, before);
            Ok(bytes)
        }
    }
}
