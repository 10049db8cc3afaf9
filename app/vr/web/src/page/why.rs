//! Four pictures of the scene that explain why synthesis works.

use std::rc::Rc;

use wasm_bindgen::prelude::*;
use yoro::eyes::EyePair;
use yoro::opengl::{Gather, Options, Outputs, Source};
use yoro_gl::{Context, Destination, Filter, Format, RenderTarget};
use yoro_render::DepthCopy;
use yoro_render::stereo::{self, DepthTarget, EyeTarget, Method, StereoError, StereoFrame, StereoOptions};

use super::Page;
use super::error::sentence;
use crate::explain::{Explanation, Frame};

/// Four pictures of one frame: RGBA, rows from the top.
#[wasm_bindgen]
pub struct Why {
    size: [u32; 2],
    seen: Explanation,
}

#[wasm_bindgen]
impl Why {
    /// Renders the pictures of the scene, of this size, with objects of their own, which are freed again.
    ///
    /// # Errors
    /// A sentence, also if there is no scene, or if the eyes are not apart.
    #[wasm_bindgen(constructor)]
    pub fn new(page: &mut Page, width: u32, height: u32) -> Result<Why, JsError> {
        let size = [width, height];
        let pair = page.settings.pair(page.walker.pose(), size);
        let gl = page.gl.clone();
        let seen = explain(&gl, page, &pair).map_err(sentence)?;
        Ok(Why { size, seen: seen.ok_or_else(|| JsError::new("There is no scene to explain."))? })
    }

    /// Returns a picture: 0 colour, 1 depth, 2 distances moved, 3 filled pixels.
    pub fn picture(&self, which: usize) -> Vec<u8> {
        let Explanation { color, depth, moved, filled, .. } = &self.seen;
        [color, depth, moved, filled].get(which).map_or(Vec::new(), |bytes| bytes.to_vec())
    }

    /// Returns the width in pixels.
    #[wasm_bindgen(getter)]
    pub fn width(&self) -> u32 {
        self.size[0]
    }

    /// Returns the largest distance moved in pixels.
    #[wasm_bindgen(getter)]
    pub fn farthest(&self) -> f64 {
        self.seen.farthest
    }

    /// Returns the share of filled pixels.
    #[wasm_bindgen(getter)]
    pub fn holes(&self) -> f64 {
        self.seen.holes
    }
}

/// Renders the dominant eye, as wide as the method does, and synthesizes the other one with its source map.
fn explain(gl: &Rc<Context>, page: &mut Page, pair: &EyePair) -> Result<Option<Explanation>, StereoError> {
    let settings = page.settings;
    let options = settings.stereo_options();
    let views = pair.synthesis_views(options.guard_band)?;
    let wide = EyePair { size: views.source.size, frusta: [views.source.frustum; 2], ..*pair };
    let Content { frame, depth } = match render(gl, page, &wide, &options)? {
        Some(content) => content,
        None => return Ok(None),
    };
    let color = frame.eye(pair.dominant);
    let formats = [(Format::Rgba8, Filter::Nearest), (Format::R32Ui, Filter::Nearest)];
    let made = RenderTarget::new(gl, pair.size, &formats, None)?;
    let outputs = Outputs { source_map: true, ..Outputs::default() };
    let mut synthesis = Gather::new(gl, &Options::default(), outputs)?;
    let source = Source::new(color.color(0).raw(), depth.depth().raw());
    synthesis.synthesize(source, &views.warp, &Destination::whole(&made))?;
    let packed = RenderTarget::new(gl, wide.size, &[(Format::Rgba8, Filter::Nearest)], None)?;
    page.show.packed_depth(depth.depth(), &Destination::whole(&packed))?;
    let read = |target: &RenderTarget| target.read_rgba8(0, [0, 0], target.size());
    let (color, depth, map) = (read(color), read(&packed), made.read_u32(1, [0, 0], pair.size));
    let frame = Frame { views: &views, color: &color, depth: &depth, made: &read(&made), map: &map };
    Ok(Some(frame.explain()))
}

/// A frame, and the depth of its dominant eye.
struct Content {
    frame: StereoFrame,
    depth: RenderTarget,
}

fn render(
    gl: &Rc<Context>,
    page: &mut Page,
    pair: &EyePair,
    options: &StereoOptions,
) -> Result<Option<Content>, StereoError> {
    let settings = page.settings.render_settings();
    let Some(scene) = page.scene() else { return Ok(None) };
    let frame = StereoFrame::new(gl, pair.size)?;
    let depth = RenderTarget::new(gl, pair.size, &[], Some(Format::Depth24))?;
    let copy = DepthCopy::new(gl)?;
    let mut to: [EyeTarget; 2] = frame.targets();
    to[pair.dominant.index()].depth = Some(DepthTarget { to: Destination::whole(&depth), copy: &copy });
    let mut method = stereo::create(gl, Method::Conventional, &settings, options)?;
    let prepared = &mut scene.prepared;
    method.render_to(&mut prepared.renderer, &prepared.scene, pair, &to)?;
    Ok(Some(Content { frame, depth }))
}
