//! Both eyes of a headset, as WebXR has them.

use wasm_bindgen::prelude::*;
use yoro::eyes::{DepthRange, EyePair, GuardBand};
use yoro_gl::{Destination, Format, GlError, RenderTarget};
use yoro_lenses::{Content, Hud, Placement};
use yoro_render::DepthCopy;
use yoro_render::stereo::{DepthTarget, EyeTarget, Method, StereoFrame, StereoMethod};

use crate::page::{Page, sentence};
use crate::views::{VIEW_FLOATS, view};

/// Near and far plane that WebXR is told.
pub const DEPTH: DepthRange = DepthRange { near: 0.1, ..DepthRange::PAPER };

/// What only a headset needs.
pub struct Headset {
    frame: StereoFrame,
    depth: [RenderTarget; 2],
    copy: DepthCopy,
    hud: Hud,
    /// Renders both eyes where neither can be synthesized from the other.
    substitute: Option<Box<dyn StereoMethod>>,
}

impl Headset {
    /// The images of the last frame.
    pub fn frame(&self) -> &StereoFrame {
        &self.frame
    }
}

#[wasm_bindgen]
impl Page {
    /// Near and far plane in metres, for the session.
    #[wasm_bindgen(js_name = xrPlanes)]
    pub fn xr_planes() -> Vec<f32> {
        vec![DEPTH.near, DEPTH.far]
    }

    /// Renders both eyes into images of this size: `views` has 23 floats for each, the left one first: position, orientation
    /// (x, y, z, w) and projection matrix. `text` hangs before the eyes, four lines at most. False when both were rendered because neither can be synthesized from the other.
    ///
    /// # Errors
    /// A sentence.
    #[wasm_bindgen(js_name = xrFrame)]
    pub fn xr_frame(&mut self, views: &[f32], width: u32, height: u32, text: &str) -> Result<bool, JsError> {
        let (left, right) = views.split_at_checked(VIEW_FLOATS).unwrap_or_default();
        let Some((left, right)) = view(left).zip(view(right)) else {
            return Err(JsError::new("The headset's views cannot be understood."));
        };
        let size = [width, height];
        self.make_headset(size).map_err(sentence)?;
        let pair = EyePair {
            poses: [left.0, right.0].map(|pose| self.walker.locate(pose)),
            frusta: [left.1, right.1],
            depth: DEPTH,
            size,
            dominant: self.settings.dominant,
        };
        let fits = !self.settings.method.needs_aligned_eyes() || pair.synthesis(GuardBand::None).is_ok();
        if !fits && self.headset.as_ref().is_some_and(|headset| headset.substitute.is_none()) {
            let made = self.settings.create(&self.gl, Method::Conventional).map_err(sentence)?;
            if let Some(headset) = &mut self.headset {
                headset.substitute = Some(made);
            }
        }
        let (Some(headset), Some(prepared)) = (&mut self.headset, &mut self.scene) else { return Ok(true) };
        let Headset { frame, depth, copy, hud, substitute } = headset;
        let method = if fits { &mut self.method } else { substitute };
        let Some(method) = method else { return Ok(true) };
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

    /// Draws an eye's image and depth, 0 left and 1 right, into the framebuffer that is bound, whose viewport is set to this.
    #[wasm_bindgen(js_name = xrShow)]
    pub fn xr_show(&self, eye: usize, x: u32, y: u32, width: u32, height: u32) {
        let Some(headset) = &self.headset else { return };
        let (color, depth) = (headset.frame.targets()[eye.min(1)].color, &headset.depth[eye.min(1)]);
        debug_assert_eq!(color.size, depth.size());
        let image = headset.frame.eye(yoro::eyes::Eye::BOTH[eye.min(1)]).color(0);
        self.show.with_depth(image, depth.depth(), [x, y], [width, height]);
    }

    /// The session has ended: lets go of its images.
    #[wasm_bindgen(js_name = xrEnd)]
    pub fn xr_end(&mut self) {
        self.headset = None;
    }
}

impl Page {
    fn make_headset(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        if let Some(headset) = &mut self.headset {
            headset.frame.resize(size)?;
            return headset.depth.iter_mut().try_for_each(|depth| depth.resize(size));
        }
        let depth = || RenderTarget::new(&self.gl, size, &[], Some(Format::Depth24));
        self.headset = Some(Headset {
            frame: StereoFrame::new(&self.gl, size)?,
            depth: [depth()?, depth()?],
            copy: DepthCopy::new(&self.gl)?,
            hud: Hud::new(&self.gl)?,
            substitute: None,
        });
        Ok(())
    }
}
