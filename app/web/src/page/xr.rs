//! Both eyes of a headset, in WebXR's terms.

use wasm_bindgen::prelude::*;
use yoro::eyes::{DepthRange, Eye, EyePair};
use yoro_gl::{Destination, Format, RenderTarget};
use yoro_lenses::{Content, Hud, Placement};
use yoro_render::DepthCopy;
use yoro_render::stereo::{Chosen, DepthTarget, EyeTarget, StereoFrame, StereoMethod, Substitute};

use super::Page;
use super::error::sentence;
use super::scene_show::SceneShow;
use crate::settings::Settings;
use crate::views::{VIEW_FLOATS, view};
use crate::walker::Walker;

/// Near and far plane of a WebXR session.
const DEPTH: DepthRange = DepthRange { near: 0.1, ..DepthRange::PAPER };

/// The images of a headset, and the renderer for them.
#[wasm_bindgen]
pub struct Headset {
    frame: StereoFrame,
    depth: [RenderTarget; 2],
    copy: DepthCopy,
    hud: Hud,
    /// Renders both eyes where neither can be synthesized from the other.
    substitute: Substitute,
    /// The choices that the substitute is made for.
    settings: Settings,
}

#[wasm_bindgen]
impl Headset {
    /// Returns near and far plane in metres, for the session.
    pub fn planes() -> Vec<f32> {
        vec![DEPTH.near, DEPTH.far]
    }

    /// Makes the images of a session.
    ///
    /// # Errors
    /// A sentence.
    #[wasm_bindgen(constructor)]
    pub fn new(page: &Page) -> Result<Headset, JsError> {
        let depth = || RenderTarget::new(&page.gl, [1, 1], &[], Some(Format::Depth24)).map_err(sentence);
        Ok(Headset {
            frame: StereoFrame::new(&page.gl, [1, 1]).map_err(sentence)?,
            depth: [depth()?, depth()?],
            copy: DepthCopy::new(&page.gl).map_err(sentence)?,
            hud: Hud::new(&page.gl).map_err(sentence)?,
            substitute: Substitute::default(),
            settings: page.settings,
        })
    }

    /// Renders both eyes into images of this size: `views` has 23 floats for each, the left one first: position,
    /// orientation (x, y, z, w) and projection matrix. `text` hangs before the eyes, four lines at most. False when both
    /// were rendered because neither can be synthesized from the other.
    ///
    /// # Errors
    /// A sentence.
    pub fn draw(
        &mut self,
        page: &mut Page,
        views: &[f32],
        width: u32,
        height: u32,
        text: &str,
    ) -> Result<bool, JsError> {
        let size = [width, height];
        let Some(pair) = eyes(views, &page.settings, &page.walker, size) else {
            return Err(JsError::new("The headset's views cannot be understood."));
        };
        let (gl, settings) = (page.gl.clone(), page.settings);
        let Some(SceneShow { prepared, method, .. }) = page.scene() else { return Ok(true) };
        if !settings.makes_same(&self.settings) {
            (self.substitute, self.settings) = (Substitute::default(), settings);
        }
        let Headset { frame, depth, copy, hud, substitute, .. } = self;
        frame.resize(size).map_err(sentence)?;
        depth.iter_mut().try_for_each(|depth| depth.resize(size)).map_err(sentence)?;
        let fits = Substitute::reason(settings.choice().first(), &pair).is_none();
        let method: &mut dyn StereoMethod = match method {
            // It renders both eyes by itself.
            Chosen::Auto(auto) => auto.as_mut(),
            Chosen::Named(method) if fits => method.as_mut(),
            Chosen::Named(_) => substitute.get(|method| settings.create(&gl, method)).map_err(sentence)?,
        };
        let colors = frame.targets();
        let to = [0, 1].map(|i| EyeTarget {
            depth: Some(DepthTarget { to: Destination::whole(&depth[i]), copy }),
            ..colors[i]
        });
        method.render_to(&mut prepared.renderer, &prepared.scene, &pair, &to).map_err(sentence)?;
        if !text.is_empty() {
            let panel = hud.set(Content { text, progress: None }, Placement::Below);
            panel.draw_into_eyes(&pair, &colors.map(|target| target.color));
        }
        Ok(fits)
    }

    /// Draws an eye's image and depth, 0 left and 1 right, into the framebuffer that is bound, whose viewport is set to
    /// this.
    pub fn show(&self, page: &Page, eye: usize, x: u32, y: u32, width: u32, height: u32) {
        let eye = Eye::BOTH[eye.min(1)];
        let (image, depth) = (self.frame.eye(eye).color(0), &self.depth[eye.index()]);
        debug_assert_eq!(self.frame.eye(eye).size(), depth.size());
        page.show.with_depth(image, depth.depth(), [x, y], [width, height]);
    }
}

/// Reads both eyes as WebXR describes them, the left one first; none for anything else.
fn eyes(views: &[f32], settings: &Settings, walker: &Walker, size: [u32; 2]) -> Option<EyePair> {
    let (left, right) = views.split_at_checked(VIEW_FLOATS)?;
    let (left, right) = (view(left)?, view(right)?);
    Some(EyePair {
        poses: [left.0, right.0].map(|pose| walker.locate(pose)),
        frusta: [left.1, right.1],
        depth: DEPTH,
        size,
        dominant: settings.dominant,
    })
}
