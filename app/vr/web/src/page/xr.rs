//! Both eyes of a headset, through WebXR.

use wasm_bindgen::prelude::*;
use yoro::eyes::{DepthRange, EyePair};
use yoro_gl::{Destination, Filter, Format, RenderTarget};
use yoro_lenses::{Content as HudContent, Hud, Placement};
use yoro_render::DepthCopy;
use yoro_render::stereo::{DepthTarget, EyeTarget, FallbackReason, FrameTargets};

use super::error::sentence;
use super::{Content, Page};
use crate::settings::Settings;
use crate::views::{VIEW_FLOATS, view};
use crate::walker::Walker;

/// Near and far plane of a WebXR session.
const DEPTH: DepthRange = DepthRange { near: 0.1, ..DepthRange::PAPER };

/// A headset's images, and the objects that render them.
#[wasm_bindgen]
pub struct Headset {
    /// Colour and depth of each eye.
    eyes: [RenderTarget; 2],
    copy: DepthCopy,
    hud: Hud,
}

#[wasm_bindgen]
impl Headset {
    /// Returns near and far plane in metres, for the session.
    pub fn planes() -> Vec<f32> {
        vec![DEPTH.near, DEPTH.far]
    }

    /// Creates a session's images.
    #[wasm_bindgen(constructor)]
    pub fn new(page: &Page) -> Result<Headset, JsError> {
        let eye = || {
            let color = [(Format::Rgba8, Filter::Linear)];
            RenderTarget::new(&page.gl, [1, 1], &color, Some(Format::Depth24)).map_err(sentence)
        };
        Ok(Headset {
            eyes: [eye()?, eye()?],
            copy: DepthCopy::new(&page.gl).map_err(sentence)?,
            hud: Hud::new(&page.gl).map_err(sentence)?,
        })
    }

    /// Renders both eyes into images of this size. `views` has 23 floats per eye, the left one first: position,
    /// orientation (x, y, z, w) and projection matrix. `text`, of at most four lines, is shown in front of the eyes.
    /// Returns false if both eyes were rendered because neither can be synthesized from the other.
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
        let Headset { eyes: images, copy, hud } = self;
        images.iter_mut().try_for_each(|image| image.resize(size)).map_err(sentence)?;
        let mut fits = true;
        match &mut page.content {
            Content::Scene(scene) => {
                let to = [0, 1].map(|i| EyeTarget {
                    depth: Some(DepthTarget { to: images[i].depth_only(), copy }),
                    ..EyeTarget::of(&images[i])
                });
                // Composed eyes have no depth: the browser moves them as if all were far away.
                let views = page.settings.stereo_views(&pair);
                let report = scene.render_to(&views, FrameTargets::Eyes(to)).map_err(sentence)?;
                fits = !matches!(report.fallback, Some(FallbackReason::Eyes(_)));
            }
            Content::Stream(stream) => {
                stream
                    .eyes
                    .render(&pair, &[0, 1].map(|i| Destination::whole(&images[i])))
                    .map_err(sentence)?;
            }
            _ => return Ok(true),
        }
        if !text.is_empty() {
            let panel = hud.set(HudContent { text, progress: None }, Placement::Below);
            panel.draw_into_eyes(&pair, &[0, 1].map(|i| images[i].color_only()));
        }
        Ok(fits)
    }

    /// Draws an eye's image and depth, 0 left and 1 right, into the bound framebuffer, with this viewport.
    pub fn show(&self, page: &Page, eye: usize, x: u32, y: u32, width: u32, height: u32) {
        let image = &self.eyes[eye.min(1)];
        page.show.with_depth(image.color(0), image.depth(), [x, y], [width, height]);
    }
}

/// Reads both eyes in WebXR's form, the left one first; `None` for anything else.
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
