//! The user's own pictures on the canvas, and the eyes synthesized from them.

use std::rc::Rc;

use wasm_bindgen::JsError;
use yoro::eyes::Eye;
use yoro::opengl::{Gather, Options, Outputs, Source};
use yoro_gl::{Context, Destination, Filter, Format, Texture};
use yoro_render::stereo::StereoFrame;

use super::error::sentence;
use super::show::{Layout, Show};
use crate::pictures::{PictureOptions, PicturePair};
use crate::settings::{Display, Settings};

/// Everything needed to show a pair of pictures.
pub struct PictureShow {
    pub pair: PicturePair,
    options: PictureOptions,
    pipeline: Gather,
    color: Texture,
    depth: Texture,
    /// The images of both eyes.
    pub frame: StereoFrame,
}

impl PictureShow {
    /// Uploads the pictures and synthesizes the eyes.
    pub fn new(
        gl: &Rc<Context>,
        show: &Show,
        pair: PicturePair,
        options: PictureOptions,
        ipd: f32,
    ) -> Result<PictureShow, JsError> {
        pair.nearness(&options, ipd).map_err(sentence)?;
        let texture = |format, filter| Texture::new(gl, pair.size, format, filter).map_err(sentence);
        let mut pictures = PictureShow {
            color: texture(Format::Rgba8, Filter::Linear)?,
            depth: texture(Format::R32F, Filter::Nearest)?,
            pipeline: Gather::new(gl, &Options::default(), Outputs::default()).map_err(sentence)?,
            frame: StereoFrame::new(gl, pair.size).map_err(sentence)?,
            pair,
            options,
        };
        pictures.color.upload(&pictures.pair.rgba);
        pictures.synthesize(show, ipd)?;
        Ok(pictures)
    }

    /// Synthesizes the eyes with other options.
    ///
    /// # Errors
    /// A sentence; the options then stay unchanged.
    pub fn set_options(&mut self, show: &Show, options: PictureOptions, ipd: f32) -> Result<(), JsError> {
        let before = std::mem::replace(&mut self.options, options);
        let made = self.synthesize(show, ipd);
        if made.is_err() {
            self.options = before;
        }
        made
    }

    /// Synthesizes the eyes, `ipd` metres apart.
    pub fn synthesize(&mut self, show: &Show, ipd: f32) -> Result<(), JsError> {
        let nearness = self.pair.nearness(&self.options, ipd).map_err(sentence)?;
        let bytes: Vec<u8> = nearness.values.iter().flat_map(|v| v.to_ne_bytes()).collect();
        self.depth.upload(&bytes);
        let source = Source::new(self.color.raw(), self.depth.raw());
        let targets = self.options.source.targets();
        for &(eye, share) in targets {
            let to = Destination::whole(self.frame.eye(eye));
            self.pipeline
                .synthesize(source, &nearness.warp(self.pair.size, eye, share), &to)
                .map_err(sentence)?;
        }
        for eye in Eye::BOTH.into_iter().filter(|eye| targets.iter().all(|(target, _)| target != eye)) {
            show.image(&self.color, &Destination::whole(self.frame.eye(eye)));
        }
        Ok(())
    }

    /// Shows the whole eyes on a cleared canvas, with black beside them.
    pub fn draw(&self, show: &Show, settings: &Settings, canvas: [u32; 2]) {
        // There is no real image to compare with.
        let display = match settings.display {
            display if !display.needs_truth() => display,
            _ => Display::one_eye(self.options.source.targets()[0].0),
        };
        let layout = Layout::whole(display.part(canvas), self.pair.size.map(|n| n as f32));
        show.eyes(display, &self.frame, settings.dominant, None, &layout);
    }
}
