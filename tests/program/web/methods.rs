//! Compares the picture of each method with the desktop's.

use serde_json::{Value, json};
use yoro::eyes::{Eye, EyeOptions};
use yoro_context::{Backend, Headless};
use yoro_gl::Capabilities;
use yoro_media::rgb_image;
use yoro_render::stereo::{Method, StereoFrame, StereoOptions, StereoSession};
use yoro_render::{PreparedScene, RenderSettings};

use super::{Page, close};

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
    let headless = Headless::open_limited(Backend::Egl, limit_to_webgl).unwrap();
    let gl = headless.gl();
    let mut frame = StereoFrame::new(gl, SIZE).unwrap();
    for msaa in [4, 1] {
        let settings = RenderSettings { msaa, ..RenderSettings::default() };
        let scene = yoro_scenes::build("prototype", yoro_scenes::DEFAULT_SEED).unwrap();
        let mut prepared = PreparedScene::new(gl, scene, &settings).unwrap();
        let pose = prepared.scene.viewpoints[1].pose();
        let pair = EyeOptions { size: SIZE, ..EyeOptions::default() }.pair(pose);
        let options = StereoOptions { policy: None, ..StereoOptions::default() };
        page.choose("msaa", &msaa.to_string());
        for method in Method::ALL.into_iter().filter(|method| *method != Method::Multiview) {
            let name = format!("{msaa} samples, {}", method.name());
            let mut session = StereoSession::new(gl, method.into(), &settings, &options).unwrap();
            session.frame(&mut prepared, &pair.into(), frame.fit(SIZE).unwrap(), None).unwrap();
            page.choose("method", method.name());
            assert_eq!(page.message(), None, "{name}");
            let eyes = page.eyes(SIZE);
            for eye in Eye::BOTH {
                let desktop = rgb_image(&frame.eye(eye).read_rgba8(0, [0, 0], SIZE), SIZE);
                close(&format!("{name}, {}", eye.name()), &eyes[eye.index()], &desktop);
            }
            assert_eq!(page.evaluate("yoro.page.takeErrors() ?? null"), Value::Null, "{name}");
        }
    }

    page.browser.expect_silence();
}

/// Leaves what WebGL 2 has: the depth of each pixel's first sample counts in place of the nearest one. Browsers draw
/// into floats, too.
fn limit_to_webgl(capabilities: &mut Capabilities) {
    let float_render_targets = capabilities.float_render_targets;
    capabilities.limit_to_es_300();
    capabilities.float_render_targets = float_render_targets;
}

#[test]
fn multiview_shows_what_two_renders_show() {
    let Some(mut page) = Page::open_with(&MULTIVIEW, "#method=multiview&display=left", None) else { return };
    if page.evaluate("yoro.gl.getExtension('OVR_multiview2') !== null") != json!(true) {
        eprintln!("SKIPPED: this Chromium has no OVR_multiview2");
        return;
    }
    assert_eq!((page.message(), page.evaluate("yoro.settings.method")), (None, json!("multiview")));
    // Layers have one sample in each pixel.
    page.choose("msaa", "1");
    let both = page.eyes(SIZE);
    page.choose("method", "conventional");
    let expected = page.eyes(SIZE);
    for eye in Eye::BOTH {
        close(eye.name(), &both[eye.index()], &expected[eye.index()]);
    }
    assert_eq!(page.evaluate("yoro.page.takeErrors() ?? null"), Value::Null);
    page.browser.expect_silence();
}
