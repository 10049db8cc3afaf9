//! The page on an emulated headset.

use std::env;
use std::path::PathBuf;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use serde_json::{Value, json};
use yoro::eyes::{DepthRange, Eye, EyePair, FoveationLevel, Frustum, Gaze};
use yoro_context::{Backend, Headless};
use yoro_media::rgb_image;
use yoro_render::stereo::{Method, StereoFrame, StereoOptions, StereoSession};
use yoro_render::{PreparedScene, RenderSettings};

use super::{Page, close};

/// Returns the script of the Immersive Web Emulation Runtime. Without it, the test should end.
pub fn emulator() -> Option<String> {
    let Some(path) = env::var_os("YORO_TEST_WEBXR") else {
        let without = env::var_os("YORO_TEST_WITHOUT_WEBXR").is_some();
        assert!(without, "run `cargo xtask test web::`, or set YORO_TEST_WITHOUT_WEBXR=1");
        eprintln!("LEFT OUT: the WebXR emulator could not be fetched");
        return None;
    };
    let emulator = std::fs::read_to_string(PathBuf::from(path)).unwrap();
    Some(format!("{emulator}\n{HEADSET}"))
}

/// A Quest 3 whose eyes see farther outwards and which has its own framebuffer, as real headsets do.
const HEADSET: &str = "
    globalThis.headset = new IWER.XRDevice(IWER.metaQuest3, { stereoEnabled: true });
    headset.installRuntime({ forceInstall: true });
    // The emulator logs each request for another frame rate.
    const log = console.log;
    console.log = (text, ...more) => { if (!/frame rate updated/.test(text)) log(text, ...more); };
    const matrix = Object.getOwnPropertyDescriptor(XRView.prototype, 'projectionMatrix').get;
    Object.defineProperty(XRView.prototype, 'projectionMatrix', { get() {
        const m = Float32Array.from(matrix.call(this));
        m[8] += this.eye === 'left' ? -0.15 : 0.15;
        m[9] -= 0.125;
        return m;
    } });
    Object.defineProperty(XRWebGLLayer.prototype, 'fixedFoveation', { value: 0, writable: true });
    Object.defineProperty(XRWebGLLayer.prototype, 'framebuffer', { get() {
        if (!this.made) {
            const gl = this.context;
            this.made = gl.createFramebuffer();
            gl.bindFramebuffer(gl.FRAMEBUFFER, this.made);
            for (const [attachment, format] of [[gl.COLOR_ATTACHMENT0, gl.RGBA8], [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24]]) {
                const buffer = gl.createRenderbuffer();
                gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
                gl.renderbufferStorage(gl.RENDERBUFFER, format, this.framebufferWidth, this.framebufferHeight);
                gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
            }
            globalThis.layer = this;
        }
        return this.made;
    } });
    globalThis.readLayer = (eye) => {
        const { context: gl, made, framebufferWidth: width, framebufferHeight: height } = layer;
        gl.bindFramebuffer(gl.FRAMEBUFFER, made);
        const half = width / 2, bytes = new Uint8Array(half * height * 4);
        gl.readPixels(eye * half, 0, half, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
        let text = '';
        for (const byte of bytes) text += String.fromCharCode(byte);
        return btoa(text);
    };
";

#[test]
fn a_headset_shows_both_eyes() {
    let Some(script) = emulator() else { return };
    let Some(mut page) = Page::open("#method=conventional&display=left", Some(&script)) else { return };
    // The emulator's displays have the size of the window.
    page.browser.resize(400, 240);
    page.until("!document.getElementById('headset').disabled");
    let press = |page: &mut Page, button: &str| {
        for value in [1, 0] {
            let frames = page.evaluate("yoro.busy.frames").as_u64().unwrap();
            page.evaluate(&format!("headset.controllers.right.updateButtonValue('{button}', {value}); 0"));
            page.until(&format!("yoro.busy.frames > {}", frames + 1));
        }
    };
    page.choose("headset-rate", "120");
    for (visit, level) in ["off", "medium"].into_iter().enumerate() {
        page.choose("headset-foveation", level);
        page.evaluate("document.getElementById('headset').click()");
        page.until("yoro.busy?.frames > 1");
        assert_eq!(page.message(), None);
        assert_eq!(page.evaluate("headset.activeSession.frameRate"), json!(120));
        // Without the figures, since they change.
        press(&mut page, "thumbstick");
        let expected = if visit == 0 { "conventional" } else { "instanced" };
        assert_eq!(page.evaluate("yoro.settings.method"), expected);
        let (views, here) = seen(&mut page);
        let desktop = headset_pictures(&views, [here[0].width(), here[0].height()], level);
        for eye in Eye::BOTH {
            let name = format!("visit {visit}, {}", eye.name());
            close(&name, &here[eye.index()], &desktop[eye.index()]);
        }
        if visit == 0 {
            press(&mut page, "trigger");
            assert_eq!(page.evaluate("yoro.settings.method"), "instanced");
        }
        if visit == 1 {
            page.evaluate("document.getElementById('measure').click()");
            assert!(page.message().unwrap().contains("leave VR first"));
            page.evaluate("yoro.clear(); yoro.page.walk(0, 0, 1)");
        }
        page.evaluate("document.getElementById('headset').click()");
        page.until("yoro.busy === null && document.getElementById('headset').textContent === 'Enter VR'");
        assert_eq!(page.message(), None);
    }
    // The distance walked is stored in the link.
    page.until("location.hash.includes('at=')");
    page.browser.expect_silence();
}

/// Returns what the headset shows: its views, and both eyes' pictures.
pub fn seen(page: &mut Page) -> (Vec<f32>, [RgbImage; 2]) {
    let number = |value: &Value| value.as_f64().unwrap() as f32;
    let views = page.evaluate("[...yoro.busy.views]").as_array().unwrap().iter().map(number).collect();
    let size = page.evaluate("yoro.busy.size");
    let size = [0, 1].map(|i| size[i].as_u64().unwrap() as u32);
    let eyes = Eye::BOTH.map(|eye| {
        let bytes = page.evaluate(&format!("readLayer({})", eye.index()));
        rgb_image(&STANDARD.decode(bytes.as_str().unwrap()).unwrap(), size)
    });
    (views, eyes)
}

/// Renders a headset's views at the scene's first viewpoint on the desktop, at a level of foveation.
pub fn headset_pictures(views: &[f32], size: [u32; 2], level: &str) -> [RgbImage; 2] {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let settings = RenderSettings::default();
    let scene = yoro_scenes::build("prototype", yoro_scenes::DEFAULT_SEED).unwrap();
    let mut prepared = PreparedScene::new(gl, scene, &settings).unwrap();
    let walker = yoro_web::Walker::new(prepared.scene.viewpoints[0].pose());
    let (left, right) = views.split_at(yoro_web::VIEW_FLOATS);
    let [left, right] = [left, right].map(|view| yoro_web::view(view).unwrap());
    let outwards = |frustum: &Frustum| frustum.left + frustum.right;
    assert!(outwards(&left.1) < -0.1 && outwards(&right.1) > 0.1, "{left:?}, {right:?}");
    let pair = EyePair {
        poses: [left.0, right.0].map(|pose| walker.locate(pose)),
        frusta: [left.1, right.1],
        depth: DepthRange { near: 0.1, ..DepthRange::PAPER },
        size,
        dominant: Eye::Right,
    };
    let level = FoveationLevel::ALL.into_iter().find(|it| it.name() == level).unwrap();
    let options = StereoOptions { policy: None, ..StereoOptions::default() };
    let mut session = StereoSession::new(gl, Method::Conventional.into(), &settings, &options).unwrap();
    let views = pair.stereo_views(level.foveation().as_ref(), Gaze::Axes(pair.axes())).unwrap();
    let mut frame = StereoFrame::new(gl, size).unwrap();
    session.frame(&mut prepared, &views, frame.fit(size).unwrap(), None).unwrap();
    Eye::BOTH.map(|eye| rgb_image(&frame.eye(eye).read_rgba8(0, [0, 0], size), size))
}
