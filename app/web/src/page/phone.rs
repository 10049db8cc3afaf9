//! A phone behind the lenses of a Cardboard-compatible viewer.

use std::rc::Rc;

use glam::{Quat, Vec3};
use wasm_bindgen::JsError;
use yoro::eyes::{DepthRange, Eye, EyePair, Pose};
use yoro_gl::{Context, Destination};
use yoro_lenses::{LensPass, Optics, ViewerParams, neck_offset};
use yoro_render::PreparedScene;
use yoro_render::stereo::{StereoError, StereoFrame};

use super::error::sentence;
use super::scene_show::SceneShow;
use crate::settings::Settings;
use crate::walker::Walker;

/// The lenses before a screen of a size.
pub struct Phone {
    optics: Optics,
    lens: LensPass,
    frame: StereoFrame,
    /// Heading that is straight ahead, in radians to the left.
    ahead: f32,
    recenter: bool,
}

/// Returns how far a head looks to the left, in radians.
fn heading(head: Quat) -> f32 {
    let ahead = head * Vec3::NEG_Z;
    (-ahead.x).atan2(-ahead.z)
}

impl Phone {
    /// Puts a screen of this width and height in metres into a viewer: `v1`, `v2`, or the URI of a viewer's QR code. What
    /// was straight ahead `before` stays it.
    ///
    /// # Errors
    /// A sentence.
    pub fn new(
        gl: &Rc<Context>,
        viewer: &str,
        screen: [f32; 2],
        before: Option<&Phone>,
    ) -> Result<Phone, JsError> {
        let params = ViewerParams::find(viewer).map_err(sentence)?;
        if !screen.iter().all(|metres| (0.03..0.4).contains(metres)) {
            return Err(JsError::new("The screen must be between 3 and 40 cm wide and high."));
        }
        let optics = Optics::new(&params, screen);
        Ok(Phone {
            lens: LensPass::new(gl, &optics, true).map_err(sentence)?,
            frame: StereoFrame::new(gl, [1, 1]).map_err(sentence)?,
            optics,
            ahead: before.map_or(0.0, |phone| phone.ahead),
            recenter: before.is_none(),
        })
    }

    /// Makes what is straight ahead of the head in the next frame the middle of the scene.
    pub fn recenter(&mut self) {
        self.recenter = true;
    }

    /// Returns the eyes of a head that is turned so in the world (Y up), on a canvas of this size. `scale` is a share of
    /// the full resolution.
    fn eyes(
        &mut self,
        settings: &Settings,
        walker: &Walker,
        canvas: [u32; 2],
        head: Quat,
        scale: f32,
    ) -> EyePair {
        if std::mem::take(&mut self.recenter) {
            self.ahead = heading(head);
        }
        let head = Quat::from_rotation_y(-self.ahead) * head;
        let full = self.optics.full_size(canvas);
        let moved = neck_offset(head) - neck_offset(Quat::IDENTITY);
        let head = walker.locate(Pose { position: moved, orientation: head });
        let half = settings.ipd.metres() / 2.0;
        EyePair {
            poses: Eye::BOTH.map(|eye| head.translated_local(Vec3::X * (eye.side() * half))),
            frusta: Eye::BOTH.map(|eye| self.optics.frustum(eye)),
            depth: DepthRange::PAPER,
            size: full.map(|n| ((n * scale.clamp(0.1, 1.0)) as u32).clamp(16, 4096)),
            dominant: settings.dominant,
        }
    }

    /// Draws both eyes of a head through the lenses, on a canvas of this size; `head` is its orientation in the world (Y
    /// up): x, y, z, w. `scale` is a share of the full resolution.
    ///
    /// # Errors
    /// The method's.
    pub fn draw(
        &mut self,
        settings: &Settings,
        walker: &Walker,
        scene: &mut SceneShow,
        canvas: [u32; 2],
        head: &[f32],
        scale: f32,
    ) -> Result<(), StereoError> {
        let head = <[f32; 4]>::try_from(head).map_or(Quat::IDENTITY, Quat::from_array).normalize();
        let pair = self.eyes(settings, walker, canvas, head, scale);
        let PreparedScene { renderer, scene: content, .. } = &mut scene.prepared;
        scene.method.render(renderer, content, &pair, &mut self.frame)?;
        let window = Destination { framebuffer: None, origin: [0, 0], size: canvas };
        self.lens.run(&self.frame, Quat::IDENTITY, &window);
        Ok(())
    }
}
