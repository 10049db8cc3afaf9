//! Compares the picture of each method with the desktop's.

use image::RgbImage;
use serde_json::{Value, json};
use yoro::eyes::{Eye, EyeOptions};
use yoro_context::{Backend, Headless};
use yoro_media::rgb_image;
use yoro_render::stereo::{self, Method, StereoFrame, StereoOptions};
use yoro_render::{PreparedScene, RenderSettings, RendererKind};

use super::{Page, close};
use crate::program::{finish, yoro};

/// WebGL on SwiftShader, which supports OVR_multiview2, as headsets' browsers do.
const MULTIVIEW: [&str; 3] = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
/// Size of the compared image of each eye in pixels.
const SIZE: [u32; 2] = [240, 160];

#[test]
fn every_method_shows_what_the_desktop_shows() {
    let Some(mut page) = Page::open("#scene=prototype&viewpoint=1&display=side-by-side", None) else {
        return;
    };
    assert_eq!(page.message(), None);
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let mut frame = StereoFrame::new(gl, SIZE).unwrap();
    for renderer in RendererKind::ALL {
        let settings = RenderSettings { renderer, ..RenderSettings::default() };
        let scene = yoro_scenes::build("prototype", yoro_scenes::DEFAULT_SEED).unwrap();
        let mut prepared = PreparedScene::new(gl, scene, &settings).unwrap();
        let pose = prepared.scene.viewpoints[1].pose();
        let pair = EyeOptions { size: SIZE, ..EyeOptions::default() }.pair(pose);
        let options = StereoOptions { policy: None, ..StereoOptions::default() };
        page.choose("renderer", renderer.name());
        assert_eq!(page.evaluate("yoro.page.renderer"), settings.summary());
        let mut compared = 0;
        for method in Method::ALL.into_iter().filter(|method| *method != Method::Multiview) {
            let name = format!("{}, {}", renderer.name(), method.name());
            let offered = format!("!document.querySelector('#method [value={}]').disabled", method.name());
            let supported = settings.supports(method, gl.capabilities()).is_ok();
            assert_eq!(page.evaluate(&offered), json!(supported), "{name}");
            if !supported {
                continue;
            }
            let mut made = stereo::create(gl, method, &settings, &options).unwrap();
            made.render(&mut prepared.renderer, &prepared.scene, &pair, &mut frame).unwrap();
            page.choose("method", method.name());
            assert_eq!(page.message(), None, "{name}");
            let eyes = page.eyes(SIZE);
            let reads_samples = renderer == RendererKind::Forward && method == Method::Synthesized;
            let without = reads_samples.then(without_readable_samples);
            for eye in Eye::BOTH {
                let desktop = match &without {
                    Some(eyes) => eyes[eye.index()].clone(),
                    None => rgb_image(&frame.eye(eye).read_rgba8(0, [0, 0], SIZE), SIZE),
                };
                close(&format!("{name}, {}", eye.name()), &eyes[eye.index()], &desktop);
            }
            assert_eq!(page.evaluate("yoro.page.takeErrors() ?? null"), Value::Null, "{name}");
            compared += 1;
        }
        assert!(compared >= 5, "{}: {compared} methods", renderer.name());
    }

    page.browser.expect_silence();
}

/// Returns both eyes as the desktop synthesizes them from the forward renderer on OpenGL ES 3.0. Like WebGL 2, it cannot
/// read samples, so that the depth of each pixel's first one counts in place of the nearest one.
fn without_readable_samples() -> [RgbImage; 2] {
    let dir = tempfile::tempdir().unwrap();
    let [width, height] = SIZE;
    let line =
        format!("render prototype --pose 1 --size {width}x{height} --renderer forward --gl egl --out es");
    let run = finish(
        yoro(line.split_whitespace()).env("MESA_GLES_VERSION_OVERRIDE", "3.0").current_dir(dir.path()),
    );
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    Eye::BOTH.map(|eye| {
        yoro_media::load_color(&dir.path().join(format!("es/prototype.{}.png", eye.name()))).unwrap()
    })
}

#[test]
fn multiview_shows_what_two_renders_show() {
    let Some(mut page) = Page::open_with(&MULTIVIEW, "#method=multiview&display=left", None) else { return };
    if page.evaluate("yoro.gl.getExtension('OVR_multiview2') !== null") != json!(true) {
        eprintln!("SKIPPED: this Chromium has no OVR_multiview2");
        return;
    }
    assert_eq!((page.message(), page.evaluate("yoro.settings.method")), (None, json!("multiview")));
    let both = page.eyes(SIZE);
    page.choose("method", "conventional");
    let expected = page.eyes(SIZE);
    for eye in Eye::BOTH {
        close(eye.name(), &both[eye.index()], &expected[eye.index()]);
    }
    assert_eq!(page.evaluate("yoro.page.takeErrors() ?? null"), Value::Null);
    page.browser.expect_silence();
}
