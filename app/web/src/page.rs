//! The canvas and what is on it.

use std::rc::Rc;

use wasm_bindgen::prelude::*;
use web_sys::WebGl2RenderingContext;
use yoro::eyes::{Eye, Pose};
use yoro::synthesis::{self, Edges, Outputs, Source, Synthesis, SynthesisOptions};
use yoro_gl::{Context, Destination, Filter, Format, GlError, Texture};
use yoro_render::stereo::{self, Method, StereoFrame, StereoMethod};
use yoro_render::{PreparedScene, Renderer};
use yoro_scene::Scene;
use yoro_scenes::BUILTINS;

use crate::bench::Bench;
use crate::phone::Phone;
use crate::pictures::{PictureOptions, PicturePair};
use crate::settings::{Display, Settings};
use crate::show::Show;
use crate::walker::Walker;
use crate::xr::Headset;

/// An error as a sentence of the page.
pub fn sentence(error: impl std::fmt::Display) -> JsError {
    let mut text = error.to_string();
    // A file keeps its name.
    let word = text.split_whitespace().next().unwrap_or_default();
    if !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_lowercase()) {
        text[..1].make_ascii_uppercase();
    }
    if !text.ends_with('.') {
        text.push('.');
    }
    JsError::new(&text)
}

/// A real render of both eyes, to hold the method's against.
struct Truth {
    method: Box<dyn StereoMethod>,
    frame: StereoFrame,
}

/// Somebody's own pictures, and the eyes that are made of them.
struct Own {
    pair: PicturePair,
    options: PictureOptions,
    pipeline: Box<dyn Synthesis>,
    color: Texture,
    depth: Texture,
}

/// Everything that lives in the canvas's context.
#[wasm_bindgen]
pub struct Page {
    pub(crate) gl: Rc<Context>,
    pub(crate) show: Show,
    pub(crate) settings: Settings,
    pub(crate) walker: Walker,
    pub(crate) scene: Option<PreparedScene>,
    pub(crate) method: Option<Box<dyn StereoMethod>>,
    frame: StereoFrame,
    truth: Option<Truth>,
    own: Option<Own>,
    pub(crate) phone: Option<Phone>,
    pub(crate) bench: Option<Bench>,
    pub(crate) headset: Option<Headset>,
}

#[wasm_bindgen]
impl Page {
    /// Takes the canvas's context.
    ///
    /// # Errors
    /// A sentence, for a context that cannot render.
    #[wasm_bindgen(constructor)]
    pub fn new(context: WebGl2RenderingContext) -> Result<Page, JsError> {
        let gl = Context::new(glow::Context::from_webgl2_context(context)).map_err(sentence)?;
        Ok(Page {
            show: Show::new(&gl).map_err(sentence)?,
            settings: Settings::default(),
            walker: Walker::new(Pose::IDENTITY),
            scene: None,
            method: None,
            frame: StereoFrame::new(&gl, [1, 1]).map_err(sentence)?,
            truth: None,
            own: None,
            phone: None,
            bench: None,
            headset: None,
            gl,
        })
    }

    /// The GPU's name, as far as the browser tells it.
    #[wasm_bindgen(getter)]
    pub fn gpu(&self) -> String {
        self.gl.capabilities().renderer.clone()
    }

    /// The version of yoro.
    #[wasm_bindgen(getter)]
    pub fn version(&self) -> String {
        env!("CARGO_PKG_VERSION").into()
    }

    /// What the browser calls its WebGL.
    #[wasm_bindgen(getter, js_name = glVersion)]
    pub fn gl_version(&self) -> String {
        self.gl.capabilities().version_string.clone()
    }

    /// Live GL objects of the library and MiB of its textures: `[objects, mib]`.
    #[wasm_bindgen(getter)]
    pub fn held(&self) -> Vec<f64> {
        vec![self.gl.object_count() as f64, self.gl.texture_bytes() as f64 / f64::from(1 << 20)]
    }

    /// The methods with the renderer of these choices, JSON as [`Page::configure`] takes it, as JSON: `[{"name",
    /// "reason"}]`, with the reason where browser or renderer cannot do it.
    ///
    /// # Errors
    /// A sentence.
    pub fn methods(&self, json: &str) -> Result<String, JsError> {
        let render = Settings::parse(json).map_err(|text| JsError::new(&text))?.render_settings();
        let entry = |method: Method| {
            let supported = render.supports(method, self.gl.capabilities());
            serde_json::json!({ "name": method.name(), "reason": supported.err().map(|error| error.to_string()) })
        };
        Ok(serde_json::Value::from_iter(Method::ALL.map(entry)).to_string())
    }

    /// The renderer in a few words: `forward, 4 samples a pixel`.
    #[wasm_bindgen(getter)]
    pub fn renderer(&self) -> String {
        self.settings.render_settings().summary()
    }

    /// Takes over the page's choices, as JSON.
    ///
    /// # Errors
    /// A sentence; the choices before stay.
    pub fn configure(&mut self, json: &str) -> Result<(), JsError> {
        let settings = Settings::parse(json).map_err(|text| JsError::new(&text))?;
        let before = std::mem::replace(&mut self.settings, settings);
        let same = self.method.is_some()
            && settings.method == before.method
            && settings.stereo_options() == before.stereo_options()
            && settings.render_settings() == before.render_settings();
        let made = match (&self.scene, same) {
            (Some(_), false) => self.make().map_err(sentence),
            _ if self.own.is_some() && settings.ipd != before.ipd => self.synthesize_pictures(),
            _ => Ok(()),
        };
        made.inspect_err(|_| self.settings = before)
    }

    /// Compiles renderer and method for the scene, if there is one.
    fn make(&mut self) -> Result<(), GlError> {
        (self.method, self.truth, self.headset) = (None, None, None);
        let settings = self.settings.render_settings();
        if let Some(prepared) = &mut self.scene
            && *prepared.renderer.settings() != settings
        {
            prepared.renderer = Renderer::new(&self.gl, &settings, &prepared.scene)?;
        }
        self.method = Some(self.settings.create(&self.gl, self.settings.method)?);
        Ok(())
    }

    /// Shows a scene as [`crate::work`] packs it, from its first viewpoint; what it says of it is JSON: `{"name",
    /// "standsFor", "style", "triangles", "lights", "viewpoints"}`.
    ///
    /// # Errors
    /// A sentence, when the GPU cannot take it; nothing is shown then.
    #[wasm_bindgen(js_name = setScene)]
    pub fn set_scene(&mut self, packed: &[u8]) -> Result<String, JsError> {
        (self.scene, self.method, self.truth, self.bench, self.own) = (None, None, None, None, None);
        let scene: Scene = postcard::from_bytes(packed).map_err(sentence)?;
        let facts = serde_json::json!({
            "name": scene.name,
            "standsFor": BUILTINS.iter().find(|builtin| builtin.name == scene.name).map_or("", |b| b.stands_for),
            "style": scene.style.name(),
            "triangles": scene.model.triangle_count(),
            "lights": scene.lights.len(),
            "viewpoints": scene.viewpoints.len(),
        });
        let prepared = PreparedScene::new(&self.gl, scene, &self.settings.render_settings());
        let prepared = prepared.map_err(sentence)?;
        self.scene = Some(prepared);
        self.make().map_err(sentence)?;
        self.go_to(0);
        Ok(facts.to_string())
    }

    /// Shows a colour and a depth picture, each with its file's name, and what is made of them; `options` is JSON. The
    /// size in pixels.
    ///
    /// # Errors
    /// A sentence; what was shown before stays.
    #[wasm_bindgen(js_name = setPictures)]
    pub fn set_pictures(
        &mut self,
        color_name: &str,
        color: &[u8],
        depth_name: &str,
        depth: &[u8],
        options: &str,
    ) -> Result<Vec<u32>, JsError> {
        let options = parse_options(options)?;
        let files = [(color_name, color), (depth_name, depth)];
        yoro_files::provide(files.map(|(name, bytes)| (name.into(), bytes.to_vec())));
        let pair = PicturePair::load(color_name.as_ref(), depth_name.as_ref());
        yoro_files::provide([]);
        let pair = pair.map_err(sentence)?;
        pair.nearness(&options, self.settings.ipd).map_err(sentence)?;
        let size = pair.size;
        let texture = |format, filter| Texture::new(&self.gl, size, format, filter).map_err(sentence);
        let own = Own {
            color: texture(Format::Rgba8, Filter::Linear)?,
            depth: texture(Format::R32F, Filter::Nearest)?,
            pipeline: self.pipeline(options.edges).map_err(sentence)?,
            pair,
            options,
        };
        own.color.upload(&own.pair.rgba);
        (self.scene, self.method, self.truth, self.bench) = (None, None, None, None);
        self.own = Some(own);
        self.synthesize_pictures()?;
        Ok(size.to_vec())
    }

    /// Shows the pictures with other options, as JSON.
    ///
    /// # Errors
    /// A sentence; the options before stay.
    #[wasm_bindgen(js_name = setPictureOptions)]
    pub fn set_picture_options(&mut self, options: &str) -> Result<(), JsError> {
        let options = parse_options(options)?;
        let edges = options.edges;
        let differs = self.own.as_ref().is_some_and(|own| own.options.edges != edges);
        let pipeline = differs.then(|| self.pipeline(edges)).transpose().map_err(sentence)?;
        let Some(own) = &mut self.own else { return Ok(()) };
        let before = std::mem::replace(&mut own.options, options);
        if let Some(pipeline) = pipeline {
            own.pipeline = pipeline;
        }
        let made = self.synthesize_pictures();
        if let (Err(_), Some(own)) = (&made, &mut self.own) {
            own.options = PictureOptions { edges, ..before };
        }
        made
    }

    /// Goes to a viewpoint of the scene.
    #[wasm_bindgen(js_name = goTo)]
    pub fn go_to(&mut self, viewpoint: usize) {
        if let Some(viewpoint) =
            self.scene.as_ref().and_then(|prepared| prepared.scene.viewpoints.get(viewpoint))
        {
            self.walker = Walker::new(viewpoint.pose());
        }
    }

    /// Goes to where [`Page::place`] was; false for what is no place.
    #[wasm_bindgen(js_name = putAt)]
    pub fn put_at(&mut self, place: &[f32]) -> bool {
        let walker = place.try_into().ok().and_then(Walker::at);
        self.walker = walker.unwrap_or(self.walker);
        walker.is_some()
    }

    /// Position in metres, radians to the left and upwards; nothing at a viewpoint.
    #[wasm_bindgen(getter)]
    pub fn place(&self) -> Option<Vec<f32>> {
        Some(self.walker.place()?.to_vec())
    }

    /// Turns the head by radians to the left and upwards.
    pub fn turn(&mut self, left: f32, up: f32) {
        self.walker.turn([left, up]);
    }

    /// Walks by metres to the right, upwards and ahead.
    pub fn walk(&mut self, right: f32, up: f32, ahead: f32) {
        self.walker.walk([right, up, ahead]);
    }

    /// Draws on a canvas of this size. `truth`: whether the display that shows two images in turn shows the real one.
    ///
    /// # Errors
    /// A sentence.
    pub fn draw(&mut self, width: u32, height: u32, truth: bool) -> Result<(), JsError> {
        self.draw_frame([width, height], truth).map_err(sentence)
    }

    /// An eye's image of the last frame, 0 left and 1 right, of the headset's while there is one: RGBA, rows from the bottom.
    /// Waits for the GPU.
    #[wasm_bindgen(js_name = readEye)]
    pub fn read_eye(&self, eye: usize) -> Vec<u8> {
        let frame = self.headset.as_ref().map_or(&self.frame, Headset::frame);
        let target = frame.eye(Eye::BOTH[eye.min(1)]);
        target.read_rgba8(0, [0, 0], target.size())
    }

    /// Errors of GL since the last call, for tests.
    #[wasm_bindgen(js_name = takeErrors)]
    pub fn take_errors(&self) -> Option<String> {
        self.gl.take_errors()
    }
}

/// The rectangle of a canvas.
fn part(origin: [u32; 2], size: [u32; 2]) -> Destination {
    Destination { framebuffer: None, origin, size }
}

impl Page {
    fn draw_frame(&mut self, [width, height]: [u32; 2], truth: bool) -> Result<(), stereo::StereoError> {
        let canvas = [width, height];
        let mut display = self.settings.display;
        if let Some(own) = &self.own {
            // There is no truth to hold them against.
            if display.needs_truth() {
                let synthesized = own.options.source.targets()[0].0;
                display = if synthesized == Eye::Left { Display::Left } else { Display::Right };
            }
            // Whole, with black beside it.
            let half = if display.is_split() { [(width / 2).max(1), height] } else { canvas };
            let [w, h] = own.pair.size.map(|n| n as f32);
            let factor = (half[0] as f32 / w).min(half[1] as f32 / h);
            let shown = [(w * factor) as u32, (h * factor) as u32].map(|n| n.max(1));
            self.gl.bind_framebuffer(None, [0, 0], canvas);
            self.gl.clear(None);
            self.present(
                display,
                [half[0].saturating_sub(shown[0]) / 2, (height.saturating_sub(shown[1])) / 2],
                shown,
                half[0],
                truth,
            );
            return Ok(());
        }
        let Some((prepared, method)) = self.scene.as_mut().zip(self.method.as_mut()) else {
            self.gl.bind_framebuffer(None, [0, 0], canvas);
            self.gl.clear(None);
            return Ok(());
        };
        let size = if display.is_split() { [(width / 2).max(1), height] } else { [width, height] };
        let pair = self.settings.pair(self.walker.pose(), size);
        method.render(&mut prepared.renderer, &prepared.scene, &pair, &mut self.frame)?;
        if display.needs_truth() {
            if self.truth.is_none() {
                let method = self.settings.create(&self.gl, Method::Conventional)?;
                self.truth = Some(Truth { method, frame: StereoFrame::new(&self.gl, size)? });
            }
            if let Some(real) = &mut self.truth {
                real.method.render(&mut prepared.renderer, &prepared.scene, &pair, &mut real.frame)?;
            }
        } else {
            self.truth = None;
        }
        self.present(display, [0, 0], size, size[0], truth);
        Ok(())
    }

    /// Shows both images, of `size` on the canvas: the first one, or the only one, at `origin`, the second one `step` pixels
    /// further to the right.
    fn present(&self, display: Display, origin: [u32; 2], size: [u32; 2], step: u32, truth: bool) {
        let first = part(origin, size);
        let second = part([origin[0] + step, origin[1]], size);
        let other = self.settings.dominant.other();
        let image = |eye: Eye| self.frame.eye(eye).color(0);
        let real = self.truth.as_ref().map_or(image(other), |truth| truth.frame.eye(other).color(0));
        match display {
            Display::SideBySide | Display::CrossEyed => {
                let eye = if display == Display::SideBySide { Eye::Left } else { Eye::Right };
                self.show.image(image(eye), &first);
                self.show.image(image(eye.other()), &second);
            }
            Display::Anaglyph => self.show.anaglyph(image(Eye::Left), image(Eye::Right), &first),
            Display::Left => self.show.image(image(Eye::Left), &first),
            Display::Right => self.show.image(image(Eye::Right), &first),
            Display::Difference => self.show.difference(image(other), real, &first),
            Display::Flicker => self.show.image(if truth { real } else { image(other) }, &first),
        }
    }

    /// What makes the eyes of pictures with such silhouettes.
    fn pipeline(&self, edges: Edges) -> Result<Box<dyn Synthesis>, GlError> {
        let options = SynthesisOptions { edges, ..SynthesisOptions::default() };
        synthesis::create(&self.gl, &options, Outputs::default())
    }

    /// Makes the eyes of the pictures.
    fn synthesize_pictures(&mut self) -> Result<(), JsError> {
        let Some(own) = &mut self.own else { return Ok(()) };
        let nearness = own.pair.nearness(&own.options, self.settings.ipd).map_err(sentence)?;
        let bytes: Vec<u8> = nearness.values.iter().flat_map(|v| v.to_ne_bytes()).collect();
        own.depth.upload(&bytes);
        self.frame.resize(own.pair.size).map_err(sentence)?;
        let source = Source::new(own.color.raw(), own.depth.raw());
        let targets = own.options.source.targets();
        for &(eye, share) in targets {
            let to = Destination::whole(self.frame.eye(eye));
            own.pipeline
                .synthesize(source, &nearness.warp(own.pair.size, eye, share), &to)
                .map_err(sentence)?;
        }
        for eye in Eye::BOTH.into_iter().filter(|eye| targets.iter().all(|(target, _)| target != eye)) {
            self.show.image(&own.color, &Destination::whole(self.frame.eye(eye)));
        }
        Ok(())
    }
}

fn parse_options(json: &str) -> Result<PictureOptions, JsError> {
    serde_json::from_str(json).map_err(|error| sentence(format!("these settings cannot be used: {error}")))
}
