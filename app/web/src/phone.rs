//! A phone behind the lenses of a Cardboard-compatible viewer.

use glam::{Quat, Vec3};
use wasm_bindgen::prelude::*;
use yoro::eyes::{DepthRange, Eye, EyePair, Pose};
use yoro_gl::Destination;
use yoro_lenses::{LensPass, Optics, ViewerParams, neck_offset};
use yoro_render::stereo::StereoFrame;

use crate::page::{Page, sentence};

/// The lenses before a screen of a size.
pub struct Phone {
    optics: Optics,
    lens: LensPass,
    frame: StereoFrame,
    /// Heading that is straight ahead, in radians to the left.
    ahead: f32,
    recenter: bool,
}

/// Radians to the left that a head looks.
fn heading(head: Quat) -> f32 {
    let ahead = head * Vec3::NEG_Z;
    (-ahead.x).atan2(-ahead.z)
}

#[wasm_bindgen]
impl Page {
    /// Puts a screen of this size in metres into a viewer: `v1`, `v2`, or the URI of a viewer's QR code.
    ///
    /// # Errors
    /// A sentence.
    #[wasm_bindgen(js_name = phoneBegin)]
    pub fn phone_begin(&mut self, viewer: &str, width: f32, height: f32) -> Result<(), JsError> {
        let params = ViewerParams::find(viewer).map_err(sentence)?;
        if ![width, height].iter().all(|metres| (0.03..0.4).contains(metres)) {
            return Err(JsError::new("The screen must be between 3 and 40 cm wide and high."));
        }
        let optics = Optics::new(&params, [width, height]);
        let ahead = self.phone.as_ref().map(|phone| phone.ahead);
        self.phone = Some(Phone {
            lens: LensPass::new(&self.gl, &optics, true).map_err(sentence)?,
            frame: StereoFrame::new(&self.gl, [1, 1]).map_err(sentence)?,
            optics,
            ahead: ahead.unwrap_or(0.0),
            recenter: ahead.is_none(),
        });
        Ok(())
    }

    /// What is straight ahead of the head now shall be the middle of the scene.
    #[wasm_bindgen(js_name = phoneRecenter)]
    pub fn phone_recenter(&mut self) {
        if let Some(phone) = &mut self.phone {
            phone.recenter = true;
        }
    }

    /// Draws both eyes of a head through the lenses, on a canvas of this size; `head` is its orientation in the world (Y
    /// up): x, y, z, w. `scale` of the full resolution.
    ///
    /// # Errors
    /// A sentence.
    #[wasm_bindgen(js_name = phoneDraw)]
    pub fn phone_draw(&mut self, width: u32, height: u32, head: &[f32], scale: f32) -> Result<(), JsError> {
        let (Some(phone), Some(prepared), Some(method)) =
            (&mut self.phone, &mut self.scene, &mut self.method)
        else {
            return Ok(());
        };
        let head = <[f32; 4]>::try_from(head).map_or(Quat::IDENTITY, Quat::from_array).normalize();
        if std::mem::take(&mut phone.recenter) {
            phone.ahead = heading(head);
        }
        let head = Quat::from_rotation_y(-phone.ahead) * head;
        let full = phone.optics.full_size([width, height]);
        let size = full.map(|n| ((n * scale.clamp(0.1, 1.0)) as u32).clamp(16, 4096));
        let moved = neck_offset(head) - neck_offset(Quat::IDENTITY);
        let head = self.walker.locate(Pose { position: moved, orientation: head });
        let half = self.settings.ipd / 2.0;
        let pair = EyePair {
            poses: Eye::BOTH.map(|eye| head.translated_local(Vec3::X * (eye.side() * half))),
            frusta: Eye::BOTH.map(|eye| phone.optics.frustum(eye)),
            depth: DepthRange::PAPER,
            size,
            dominant: self.settings.dominant,
        };
        method.render(&mut prepared.renderer, &prepared.scene, &pair, &mut phone.frame).map_err(sentence)?;
        let window = Destination { framebuffer: None, origin: [0, 0], size: [width, height] };
        phone.lens.run(&phone.frame, Quat::IDENTITY, &window);
        Ok(())
    }

    /// The phone is out of the viewer.
    #[wasm_bindgen(js_name = phoneEnd)]
    pub fn phone_end(&mut self) {
        self.phone = None;
    }
}
