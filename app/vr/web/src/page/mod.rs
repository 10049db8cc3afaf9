//! The interface for JavaScript: the canvas and its content. Errors are sentences for the page's message.

mod bench;
mod error;
mod phone;
mod picture_show;
mod scene_show;
mod show;
mod stream;
mod stream_show;
mod why;
mod work;
mod xr;

use std::rc::Rc;

use glam::Vec3;
use wasm_bindgen::prelude::*;
use web_sys::WebGl2RenderingContext;
use yoro::choice::{Choice, StereoPath};
use yoro::eyes::{Eye, Pose};
use yoro_assets::Scene;
use yoro_gl::{Context, RenderTarget};
use yoro_render::stereo::{Auto, MethodChoice, StereoFrame, StereoSession};
use yoro_scenes::BUILTINS;
use yoro_settings::Ipd;

use self::error::sentence;
use self::picture_show::PictureShow;
use self::scene_show::SceneShow;
use self::show::{Layout, Show};
use self::stream_show::StreamShow;
use crate::pictures::{PictureOptions, PicturePair};
use crate::psnr::psnr;
use crate::settings::{Display, Settings};
use crate::walker::Walker;
use crate::wiggle::wiggle;

/// The content of the canvas.
enum Content {
    Empty,
    Scene(Box<SceneShow>),
    Pictures(Box<PictureShow>),
    Stream(Box<StreamShow>),
}

/// Everything that lives in the canvas's context.
#[wasm_bindgen]
pub struct Page {
    context: WebGl2RenderingContext,
    gl: Rc<Context>,
    show: Show,
    settings: Settings,
    walker: Walker,
    /// True if dragging rotates what is shown instead of the head.
    orbits: bool,
    /// The centre of the scene.
    middle: Vec3,
    content: Content,
}

#[wasm_bindgen]
impl Page {
    /// Creates the page's objects in the canvas's context.
    ///
    /// # Errors
    /// A sentence, for a context that cannot render.
    #[wasm_bindgen(constructor)]
    pub fn new(context: WebGl2RenderingContext) -> Result<Page, JsError> {
        let gl = Context::new(glow::Context::from_webgl2_context(context.clone())).map_err(sentence)?;
        Ok(Page {
            context,
            show: Show::new(&gl).map_err(sentence)?,
            settings: Settings::default(),
            walker: Walker::new(Pose::IDENTITY),
            orbits: false,
            middle: Vec3::ZERO,
            content: Content::Empty,
            gl,
        })
    }

    /// Returns the GPU's name, if the browser reveals it.
    #[wasm_bindgen(getter)]
    pub fn gpu(&self) -> String {
        self.gl.capabilities().renderer.clone()
    }

    /// Returns yoro's version.
    #[wasm_bindgen(getter)]
    pub fn version(&self) -> String {
        env!("CARGO_PKG_VERSION").into()
    }

    /// Returns the browser's name for its WebGL version.
    #[wasm_bindgen(getter, js_name = glVersion)]
    pub fn gl_version(&self) -> String {
        self.gl.capabilities().version_string.clone()
    }

    /// Returns the number of the library's live GL objects, and the size of its textures in MiB: `[objects, mib]`.
    #[wasm_bindgen(getter)]
    pub fn held(&self) -> Vec<f64> {
        vec![self.gl.object_count() as f64, self.gl.texture_bytes() as f64 / f64::from(1 << 20)]
    }

    /// Returns the defaults of the choices that all programs have, and the largest distance between the eyes, as JSON:
    /// `{"method", "msaa", "holes", "dominant", "ipd", "maxIpd"}`. Distances are in millimetres.
    #[wasm_bindgen(js_name = defaultChoices)]
    pub fn default_choices() -> String {
        let Settings { method, msaa, holes, dominant, ipd, .. } = Settings::default();
        let millimetres = |ipd: Ipd| (ipd.metres() * 1e3).round();
        serde_json::json!({
            "method": method,
            "msaa": msaa,
            "holes": holes,
            "dominant": dominant,
            "ipd": millimetres(ipd),
            "maxIpd": millimetres(Ipd::MAX),
        })
        .to_string()
    }

    /// Returns the methods as JSON: `[{"name", "reason"}]`. A reason is given if the browser does not support the
    /// method.
    pub fn methods(&self) -> String {
        let reason = |choice| match choice {
            MethodChoice::Auto => None,
            MethodChoice::Named(method) => self.settings.lacks(method, self.gl.capabilities()),
        };
        let entry =
            |choice: MethodChoice| serde_json::json!({ "name": choice.name(), "reason": reason(choice) });
        serde_json::Value::from_iter(MethodChoice::ALL.map(entry)).to_string()
    }

    /// Applies the page's choices, as JSON.
    ///
    /// # Errors
    /// A sentence; the choices then stay unchanged.
    pub fn configure(&mut self, json: &str) -> Result<(), JsError> {
        let settings = Settings::parse(json).map_err(sentence)?;
        match &mut self.content {
            Content::Scene(scene) if !settings.makes_same(&self.settings) => {
                scene.configure(&self.gl, &settings, &self.settings).map_err(sentence)?;
            }
            Content::Pictures(pictures) if settings.ipd != self.settings.ipd => {
                pictures.synthesize(&self.show, settings.ipd.metres())?;
            }
            _ => {}
        }
        self.settings = settings;
        Ok(())
    }

    /// Shows a scene in the form in which [`work`] packs it, from its first viewpoint. Returns facts about it as JSON:
    /// `{"name", "standsFor", "style", "triangles", "lights", "viewpoints", "object", "moves"}`. `object` is true for a
    /// scene that is seen from outside; the head then moves around it.
    ///
    /// # Errors
    /// A sentence, if the GPU cannot hold it; nothing is shown then.
    #[wasm_bindgen(js_name = setScene)]
    pub fn set_scene(&mut self, packed: &[u8]) -> Result<String, JsError> {
        // Frees the old content before the new scene allocates memory.
        self.content = Content::Empty;
        let scene: Scene = postcard::from_bytes(packed).map_err(sentence)?;
        let facts = serde_json::json!({
            "name": scene.name,
            "standsFor": BUILTINS.iter().find(|builtin| builtin.name == scene.name).map_or("", |b| b.stands_for),
            "style": scene.style.name(),
            "triangles": scene.model.triangle_count(),
            "lights": scene.lights.len(),
            "viewpoints": scene.viewpoints.len(),
            "object": is_object(&scene),
            "moves": !scene.motion.is_still(),
        });
        (self.orbits, self.middle) = (is_object(&scene), scene.model.bounds().center());
        let scene = SceneShow::new(&self.gl, &self.settings, scene).map_err(sentence)?;
        self.content = Content::Scene(Box::new(scene));
        self.go_to(0);
        Ok(facts.to_string())
    }

    /// Shows a colour and a depth picture, each with its file's name, and the eyes synthesized from them; `options` is
    /// JSON. Returns width and height in pixels.
    ///
    /// # Errors
    /// A sentence; the previous content stays.
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
        let pictures = PictureShow::new(&self.gl, &self.show, pair, options, self.settings.ipd.metres())?;
        let size = pictures.pair.size.to_vec();
        self.content = Content::Pictures(Box::new(pictures));
        Ok(size)
    }

    /// Shows the pictures with other options, as JSON.
    ///
    /// # Errors
    /// A sentence; the options then stay unchanged.
    #[wasm_bindgen(js_name = setPictureOptions)]
    pub fn set_picture_options(&mut self, options: &str) -> Result<(), JsError> {
        let options = parse_options(options)?;
        match &mut self.content {
            Content::Pictures(pictures) => {
                pictures.set_options(&self.show, options, self.settings.ipd.metres())
            }
            _ => Ok(()),
        }
    }

    /// Moves everything in the scene to its place at a time in seconds; does nothing in a static scene.
    #[wasm_bindgen(js_name = setTime)]
    pub fn set_time(&mut self, seconds: f64) -> Result<(), JsError> {
        self.scene().map_or(Ok(()), |scene| scene.prepared.set_time(seconds)).map_err(sentence)
    }

    /// Goes to a viewpoint of the scene, or to the position from which a video was taken.
    #[wasm_bindgen(js_name = goTo)]
    pub fn go_to(&mut self, viewpoint: usize) {
        if let Content::Scene(scene) = &mut self.content
            && let Some(viewpoint) = scene.prepared.scene.viewpoints.get(viewpoint)
        {
            self.walker = Walker::new(viewpoint.pose());
            self.orbit(self.orbits);
            self.measure_again();
        }
        if let Content::Stream(stream) = &self.content
            && stream.frusta.is_some()
        {
            self.walker = Walker::new(Pose::IDENTITY);
            self.orbit(self.orbits);
        }
    }

    /// Switches between moving around what is shown (true) and walking in it.
    pub fn orbit(&mut self, on: bool) {
        self.orbits = on;
        self.walker.go_around(on.then_some(self.middle));
    }

    /// Goes to a place that [`Page::place`] returned; returns false if the numbers are not a place.
    #[wasm_bindgen(js_name = putAt)]
    pub fn put_at(&mut self, place: &[f32]) -> bool {
        let walker = place.try_into().ok().and_then(Walker::at);
        self.walker = walker.unwrap_or(self.walker);
        self.orbit(self.orbits);
        self.measure_again();
        walker.is_some()
    }

    /// Returns the head's position in metres, and its rotation to the left and upwards in radians; none at a viewpoint.
    #[wasm_bindgen(getter)]
    pub fn place(&self) -> Option<Vec<f32>> {
        Some(self.walker.place()?.to_vec())
    }

    /// Turns the head by angles to the left and upwards, in radians.
    pub fn turn(&mut self, left: f32, up: f32) {
        self.walker.turn([left, up]);
    }

    /// Walks by distances to the right, upwards and ahead, in metres.
    pub fn walk(&mut self, right: f32, up: f32, ahead: f32) {
        self.walker.walk([right, up, ahead]);
    }

    /// Renders for a canvas of this size, and shows the result there as [`Page::show`] does.
    pub fn draw(&mut self, width: u32, height: u32, divider: f32) -> Result<(), JsError> {
        if let Content::Scene(scene) = &mut self.content {
            let size = self.settings.display.part([width, height]);
            scene.render(&self.gl, &self.settings, self.walker.pose(), size).map_err(sentence)?;
        }
        if let Content::Stream(stream) = &mut self.content {
            let part = self.settings.display.part([width, height]);
            let (_, pair) = stream.place(&self.settings, self.walker.pose(), part);
            stream.draw(&pair).map_err(sentence)?;
        }
        self.show(width, height, divider);
        Ok(())
    }

    /// Ends a frame that was handed to the display at `now_ms` of the page's clock. `refresh_hz` is the display's
    /// refresh rate, 0 if unknown.
    #[wasm_bindgen(js_name = endFrame)]
    pub fn end_frame(&mut self, now_ms: f64, refresh_hz: f32) {
        if let Content::Scene(scene) = &mut self.content {
            scene.end(&self.gl, now_ms, refresh_hz);
        }
    }

    /// True while `auto` measures which method is cheaper, for which it needs frames.
    #[wasm_bindgen(getter, js_name = isMeasuring)]
    pub fn is_measuring(&self) -> bool {
        self.auto().is_some_and(Auto::is_measuring)
    }

    /// Returns the name of the method in use; with `auto`, the one chosen last.
    #[wasm_bindgen(getter, js_name = methodInUse)]
    pub fn method_in_use(&self) -> String {
        let session = match &self.content {
            Content::Scene(scene) => Some(&scene.session),
            _ => None,
        };
        session.map_or(self.settings.choice().first(), StereoSession::method).name().into()
    }

    /// Returns the reason for `auto`'s method, as in the viewer's log line; none if the method was chosen by name.
    #[wasm_bindgen(getter)]
    pub fn reason(&self) -> Option<String> {
        Some(self.auto()?.to_string())
    }

    /// Returns the frame times in ms that `auto` has compared, of two renders and of synthesis, if there are any. Holes are
    /// filled, unless rendered ones are in use.
    #[wasm_bindgen(getter)]
    pub fn costs(&self) -> Option<Vec<f32>> {
        let Choice { path, costs_ms, .. } = self.auto().filter(|auto| !auto.is_measuring())?.choice();
        let synthesis = match path {
            StereoPath::RenderedHoles => path,
            _ => StereoPath::Synthesis,
        };
        [StereoPath::TwoViews, synthesis].into_iter().map(|path| costs_ms[path.index()]).collect()
    }

    /// Draws as [`Page::draw`] does, but faster: without the real images that a display compares with.
    pub fn preview(&mut self, width: u32, height: u32) -> Result<(), JsError> {
        let display = self.settings.display;
        if display.needs_truth() {
            self.settings.display = Display::one_eye(self.settings.dominant.other());
        }
        let drawn = self.draw(width, height, 0.0);
        self.settings.display = display;
        drawn
    }

    /// Shows the images of the last [`Page::draw`] on the canvas, without rendering. `divider` is the share of the
    /// width in which displays with a comparison show the real image.
    pub fn show(&self, width: u32, height: u32, divider: f32) {
        let Settings { display, dominant, .. } = self.settings;
        let canvas = [width, height];
        if let Content::Scene(scene) = &self.content {
            let size = display.part(canvas);
            let divider = (size[0] as f32 * divider.clamp(0.0, 1.0)).round() as u32;
            let layout = Layout { origin: [0, 0], size, step: size[0], divider };
            self.show.eyes(display, &scene.frame, dominant, scene.real_image(&self.settings), &layout);
            return;
        }
        self.gl.bind_framebuffer(None, [0, 0], canvas);
        self.gl.clear(None);
        if let Content::Stream(stream) = &self.content {
            // A stream has no real image to compare with, so nothing is left of the divider.
            let (layout, _) = stream.place(&self.settings, self.walker.pose(), display.part(canvas));
            self.show.eyes(display, &stream.frame, dominant, None, &layout);
        }
        if let Content::Pictures(pictures) = &self.content {
            pictures.draw(&self.show, &self.settings, canvas);
        }
    }

    /// Renders the picture of the last [`Page::draw`] `count` more times, by two renders or by the method, and waits
    /// for the GPU, for timing. Does nothing unless the display needs both.
    pub fn repeat(&mut self, real: bool, count: u32) -> Result<(), JsError> {
        self.scene().map_or(Ok(()), |scene| scene.repeat(real, count)).map_err(sentence)
    }

    /// Returns two PSNRs in dB against the real image of the non-dominant eye: of the method's image, and of the
    /// dominant eye's (the same image to both eyes), all as last drawn. It is infinite for equal images; none unless
    /// the display needs the real image. Waits for the GPU.
    #[wasm_bindgen(getter)]
    pub fn psnr(&self) -> Option<Vec<f64>> {
        let Content::Scene(scene) = &self.content else { return None };
        let read = |target: &RenderTarget| target.read_rgba8(0, [0, 0], target.size());
        let real = read(scene.real_eye(&self.settings)?);
        let dominant = self.settings.dominant;
        Some([dominant.other(), dominant].map(|eye| psnr(&read(scene.frame.eye(eye)), &real)).to_vec())
    }

    /// Returns an eye's image in the last frame, 0 left and 1 right: RGBA, rows from the bottom; empty if nothing is
    /// shown. Waits for the GPU.
    #[wasm_bindgen(js_name = readEye)]
    pub fn read_eye(&self, eye: usize) -> Vec<u8> {
        let frame = match &self.content {
            Content::Empty => return Vec::new(),
            Content::Scene(scene) => &scene.frame,
            Content::Pictures(pictures) => &pictures.frame,
            Content::Stream(stream) => &stream.frame,
        };
        let target = frame.eye(Eye::BOTH[eye.min(1)]);
        target.read_rgba8(0, [0, 0], target.size())
    }

    /// Returns both eyes alternately as an animated GIF, at most `width` pixels wide. Waits for the GPU.
    ///
    /// # Errors
    /// A sentence, also if nothing is shown.
    pub fn wiggle(&mut self, width: u32) -> Result<Vec<u8>, JsError> {
        let read = |frame: &StereoFrame| {
            Eye::BOTH.map(|eye| frame.eye(eye).read_rgba8(0, [0, 0], frame.eye(eye).size()))
        };
        let (eyes, size) = match &mut self.content {
            Content::Empty => return Err(JsError::new("There is no picture to save.")),
            Content::Pictures(pictures) => (read(&pictures.frame), pictures.pair.size),
            Content::Scene(scene) => (read(&scene.frame), scene.frame.eye(Eye::Left).size()),
            Content::Stream(stream) => (read(&stream.frame), stream.frame.eye(Eye::Left).size()),
        };
        wiggle(eyes, size, width).map_err(sentence)
    }

    /// Returns GL's errors since the last call, for tests.
    #[wasm_bindgen(js_name = takeErrors)]
    pub fn take_errors(&self) -> Option<String> {
        self.gl.take_errors()
    }
}

impl Page {
    fn auto(&self) -> Option<&Auto> {
        match &self.content {
            Content::Scene(scene) => scene.session.auto(),
            _ => None,
        }
    }

    fn measure_again(&mut self) {
        if let Some(scene) = self.scene() {
            scene.session.measure_again();
        }
    }

    /// Returns the scene, if one is shown.
    fn scene(&mut self) -> Option<&mut SceneShow> {
        match &mut self.content {
            Content::Scene(scene) => Some(scene),
            _ => None,
        }
    }
}

/// True if the scene's first viewpoint is outside its bounds.
fn is_object(scene: &Scene) -> bool {
    let bounds = scene.model.bounds();
    let position = scene.viewpoints[0].position;
    position.cmplt(bounds.min).any() || position.cmpgt(bounds.max).any()
}

fn parse_options(json: &str) -> Result<PictureOptions, JsError> {
    serde_json::from_str(json).map_err(|error| sentence(format!("these settings cannot be used: {error}")))
}
