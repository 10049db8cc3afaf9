//! The eyes that a viewer makes from a stream's pictures, as images.

use std::rc::Rc;

use image::RgbImage;

use yoro::eyes::{Eye, EyePair};
use yoro_gl::{Context, Destination, GlError};
use yoro_media::rgb_image;
use yoro_media::video::Planes;
use yoro_render::stereo::StereoFrame;
use yoro_stream::{Content, DecodedPicture, StreamedEyes};

/// Makes eyes from a stream's pictures, like the page.
pub struct Receiver {
    streamed: StreamedEyes,
    frame: StereoFrame,
}

impl Receiver {
    /// Compiles the programs.
    ///
    /// # Errors
    /// [`GlError`] if the driver refuses.
    pub fn new(gl: &Rc<Context>) -> Result<Receiver, GlError> {
        Ok(Receiver { streamed: StreamedEyes::new(gl)?, frame: StereoFrame::new(gl, [1, 1])? })
    }

    /// Returns both eyes of a pair, made from a decoded picture. They are black where the picture shows nothing.
    ///
    /// # Errors
    /// [`GlError`] if the driver has no memory.
    pub fn eyes(
        &mut self,
        planes: &Planes,
        content: &Content,
        size: [u16; 2],
        pair: &EyePair,
    ) -> Result<[RgbImage; 2], GlError> {
        let picture = planes.planes.concat();
        let taken = self.streamed.take(*content, size, &DecodedPicture::Planes(&picture))?;
        assert!(taken, "a picture of another size");
        self.frame.resize(pair.size)?;
        let to = Eye::BOTH.map(|eye| Destination::whole(self.frame.eye(eye)));
        self.streamed.render(pair, &to)?;
        Ok(Eye::BOTH.map(|eye| rgb_image(&self.frame.eye(eye).read_rgba8(0, [0, 0], pair.size), pair.size)))
    }
}
