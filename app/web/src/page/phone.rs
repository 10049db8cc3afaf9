//! A phone behind the lenses of a Cardboard-compatible viewer.

use glam::{Quat, Vec3};
use wasm_bindgen::prelude::*;
use yoro::eyes::{DepthRange, Eye, EyePair, Pose};
use yoro_gl::Destination;
use yoro_lenses::{LensPass, Optics, ViewerParams, neck_offset};
use yoro_render::stereo::StereoFrame;

use super::Page;
use super::error::sentence;
use super::scene_show::SceneShow;

/// The lenses before a screen of a size.
#[wasm_bindgen]
pub struct Phone {
    optics: Optics,
    lens: LensPass,
    frame: StereoFrame,
    /// The heading of the direction straight ahead, in radians to the left.
    ahead: f32,
    recenter: bool,
}

/// Returns how far a head looks to the left, in radians.
fn heading(head: Quat) -> f32 {
    let ahead = head * Vec3::NEG_Z;
    (-ahead.x).atan2(-ahead.z)
}

#[wasm_bindgen]
impl Phone {
    /// Puts a screen of this size in metres into a viewer: `v1`, `v2`, or the URI of a viewer's QR code. The direction
    /// that was straight ahead for the phone `before` stays it.
    ///
    /// # Errors
    /// A sentence.
    #[wasm_bindgen(constructor)]
    pub fn new(
        page: &Page,
        viewer: &str,
        width: f32,
        height: f32,
        before: Option<Phone>,
    ) -> Result<Phone, JsError> {
        let params = ViewerParams::find(viewer).map_err(sentence)?;
        if ![width, height].iter().all(|metres| (0.03..0.4).contains(metres)) {
            return Err(JsError::new("The screen must be between 3 and 40 cm wide and high."));
        }
        let optics = Optics::new(&params, [width, height]);
        Ok(Phone {
            lens: LensPass::new(&page.gl, &optics, true).map_err(sentence)?,
            frame: StereoFrame::new(&page.gl, [1, 1]).map_err(sentence)?,
            optics,
            recenter: before.is_none(),
            ahead: before.map_or(0.0, |phone| phone.ahead),
        })
    }

    /// Makes the direction straight ahead of the head in the next frame the middle of the scene.
    pub fn recenter(&mut self) {
        self.recenter = true;
    }

    /// Draws both eyes of a head through the lenses, on a canvas of this size; `head` is its orientation in the world (Y
    /// up): x, y, z, w. `scale` is a share of the full resolution.
    ///
    /// # Errors
    /// A sentence.
    pub fn draw(
        &mut self,
        page: &mut Page,
        width: u32,
        height: u32,
        head: &[f32],
        scale: f32,
    ) -> Result<(), JsError> {
        let head = <[f32; 4]>::try_from(head).map_or(Quat::IDENTITY, Quat::from_array).normalize();
        if std::mem::take(&mut self.recenter) {
            self.ahead = heading(head);
        }
        let head = Quat::from_rotation_y(-self.ahead) * head;
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
        let Some(SceneShow { prepared, method, .. }) = page.scene() else { return Ok(()) };
        method.render(&mut prepared.renderer, &prepared.scene, &pair, &mut self.frame).map_err(sentence)?;
        let window = Destination { framebuffer: None, origin: [0, 0], size: [width, height] };
        self.lens.run(&self.frame, Quat::IDENTITY, &window);
        Ok(())
    }
}
