//! A phone behind the lenses of a Cardboard-compatible viewer.

use glam::{Quat, Vec3};
use wasm_bindgen::prelude::*;
use yoro::eyes::{DepthRange, Eye, EyePair, Pose};
use yoro_gl::Destination;
use yoro_lenses::{LensPass, Optics, neck_offset, read_qr};
use yoro_render::stereo::StereoFrame;

use super::error::sentence;
use super::{Content, Page};
use crate::sensors::{Head, find_viewer, orientation};

/// Plausible widths and heights of screens, in metres.
const SCREEN: std::ops::Range<f32> = 0.03..0.4;

/// The lenses in front of a screen of a given size.
#[wasm_bindgen]
pub struct Phone {
    optics: Optics,
    lens: LensPass,
    frame: StereoFrame,
    head: Head,
}

#[wasm_bindgen]
impl Phone {
    /// Returns the reason why a text does not name a viewer: `v1`, `v2`, or the URI of a viewer's QR code.
    #[wasm_bindgen(js_name = viewerFault)]
    pub fn viewer_fault(viewer: &str) -> Option<String> {
        find_viewer(viewer).err()
    }

    /// Returns a viewer's vendor and model; empty if the text does not name a viewer.
    #[wasm_bindgen(js_name = viewerName)]
    pub fn viewer_name(viewer: &str) -> String {
        find_viewer(viewer).map_or(String::new(), |params| format!("{} {}", params.vendor, params.model))
    }

    /// Returns the text of a QR code in a camera's picture, RGBA with rows from the top; none if there is no code.
    #[wasm_bindgen(js_name = readCode)]
    pub fn read_code(rgba: &[u8], width: usize) -> Option<String> {
        read_qr(rgba, width)
    }

    /// Combines a screen of this size in metres with a viewer: `v1`, `v2`, or the URI of a viewer's QR code. The
    /// direction that was straight ahead for the phone `before` is kept.
    #[wasm_bindgen(constructor)]
    pub fn new(
        page: &Page,
        viewer: &str,
        width: f32,
        height: f32,
        before: Option<Phone>,
    ) -> Result<Phone, JsError> {
        let params = find_viewer(viewer).map_err(sentence)?;
        if ![width, height].iter().all(|metres| SCREEN.contains(metres)) {
            return Err(JsError::new("The screen must be between 3 and 40 cm wide and high."));
        }
        let optics = Optics::new(&params, [width, height]);
        Ok(Phone {
            lens: LensPass::new(&page.gl, &optics, true).map_err(sentence)?,
            frame: StereoFrame::new(&page.gl, [1, 1]).map_err(sentence)?,
            optics,
            head: before.map(|phone| phone.head).unwrap_or_default(),
        })
    }

    /// Makes the head's present direction straight ahead in the scene.
    pub fn recenter(&mut self) {
        self.head.recenter();
    }

    /// Sets the sensors' angles as browsers report them, and the screen's rotation, all in degrees.
    pub fn turn(&mut self, alpha: f32, beta: f32, gamma: f32, screen: f32) {
        self.head.turn(orientation([alpha, beta, gamma], screen));
    }

    /// Draws both eyes of the head through the lenses, on a canvas of this size. `scale` is a factor on the full
    /// resolution.
    pub fn draw(&mut self, page: &mut Page, width: u32, height: u32, scale: f32) -> Result<(), JsError> {
        let head = self.head.orientation();
        let full = self.optics.full_size([width, height]);
        let moved = neck_offset(head) - neck_offset(Quat::IDENTITY);
        let head = page.walker.locate(Pose { position: moved, orientation: head });
        let half = page.settings.ipd.metres() / 2.0;
        let pair = EyePair {
            poses: Eye::BOTH.map(|eye| head.translated_local(Vec3::X * (eye.side() * half))),
            frusta: Eye::BOTH.map(|eye| self.optics.frustum(eye)),
            depth: DepthRange::PAPER,
            size: full.map(|n| ((n * scale.clamp(0.1, 1.0)) as u32).clamp(16, 4096)),
            dominant: page.settings.dominant,
        };
        match &mut page.content {
            Content::Scene(scene) => {
                let targets = self.frame.fit(pair.size).map_err(sentence)?;
                scene.render_to(&pair.into(), targets).map_err(sentence)?;
            }
            Content::Stream(stream) => {
                self.frame.resize(pair.size).map_err(sentence)?;
                let to = Eye::BOTH.map(|eye| Destination::whole(self.frame.eye(eye)));
                stream.eyes.render(&pair, &to).map_err(sentence)?;
            }
            _ => return Ok(()),
        }
        let window = Destination { framebuffer: None, origin: [0, 0], size: [width, height] };
        self.lens.run(&self.frame.levels(), None, Quat::IDENTITY, &window);
        Ok(())
    }
}
