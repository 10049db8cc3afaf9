//! A stream on the canvas.

use std::rc::Rc;

use super::show::Layout;
use crate::settings::Settings;
use yoro::eyes::{Eye, EyePair, Frustum, Pose};
use yoro_gl::{Context, Destination, GlError};
use yoro_render::stereo::StereoFrame;
use yoro_stream::StreamedEyes;

/// Everything needed to show a stream.
pub struct StreamShow {
    pub eyes: StreamedEyes,
    /// The frusta of a video's eyes, beyond which it has nothing; `None` if the frusta are the page's.
    pub frusta: Option<[Frustum; 2]>,
    /// The eyes' images for the canvas.
    pub frame: StereoFrame,
}

impl StreamShow {
    /// Creates the objects for a stream, or for a video, which is shown whole with these frusta.
    ///
    /// # Errors
    /// The driver refuses.
    pub fn new(gl: &Rc<Context>, frusta: Option<[Frustum; 2]>) -> Result<StreamShow, GlError> {
        let (mut eyes, frame) = (StreamedEyes::new(gl)?, StereoFrame::new(gl, [1, 1])?);
        eyes.framed = frusta.is_some();
        Ok(StreamShow { eyes, frusta, frame })
    }

    /// Returns the layout of the eyes in parts of a canvas, each of size `part`, and the eyes of a head there: the
    /// page's, or a video's, whole and with black beside them.
    pub fn place(&self, settings: &Settings, head: Pose, part: [u32; 2]) -> (Layout, EyePair) {
        let Some(frusta) = self.frusta else {
            let layout = Layout { origin: [0, 0], size: part, step: part[0], divider: 0 };
            return (layout, settings.pair(head, part));
        };
        let layout = Layout::whole(part, [frusta[0].width(), frusta[0].height()]);
        let pair = EyePair { frusta, ..settings.pair(head, layout.size) };
        (layout, pair)
    }

    /// Renders both eyes for the canvas.
    ///
    /// # Errors
    /// The GPU has not enough memory.
    pub fn draw(&mut self, pair: &EyePair) -> Result<(), GlError> {
        self.frame.resize(pair.size)?;
        let to = Eye::BOTH.map(|eye| Destination::whole(self.frame.eye(eye)));
        self.eyes.render(pair, &to)
    }
}
