//! Foveation beside each other setting that meets it in the last pass: refused in a sentence, or a picture like that of two
//! renders.

use std::path::Path;
use std::rc::Rc;
use std::time::Duration;

use glam::{Quat, Vec3};
use serde_json::json;

use super::{Cardboard, HeldHead};
use crate::frame::{FrameTiming, SceneState};
use yoro_context::{Backend, Headless};
use yoro_gl::{Context, Destination, Filter, Format, RenderTarget};
use yoro_lenses::{Rotation, Screen};
use yoro_settings::Settings;

const WINDOW: [u32; 2] = [780, 360];

/// A phone's screen, on which letters are as large as they are read.
const PHONE: [u32; 2] = [2340, 1080];

/// A setting beside foveation.
struct Pair {
    what: &'static str,
    settings: &'static [&'static str],
    /// Degrees by which the head turns after rendering.
    late: f32,
    expected: Expected,
}

enum Expected {
    /// The least PSNR in dB of the synthesized eye's half of the screen against two renders with the same settings.
    Like(f64),
    /// What the sentence says.
    Refused(&'static str),
}

const PAIRS: [Pair; 8] = [
    Pair { what: "near boards, glass", settings: &[], late: 0.0, expected: Expected::Like(31.5) },
    Pair { what: "the other eye", settings: &["dominant=left"], late: 0.0, expected: Expected::Like(32.5) },
    Pair { what: "high", settings: &["foveation=high"], late: 0.0, expected: Expected::Like(30.5) },
    Pair { what: "lenses", settings: &["viewer=v2"], late: 0.0, expected: Expected::Like(30.5) },
    Pair { what: "timewarp", settings: &["timewarp=rotation"], late: 3.0, expected: Expected::Like(31.5) },
    Pair {
        what: "positional timewarp",
        settings: &["timewarp=position"],
        late: 3.0,
        expected: Expected::Refused("foveation=medium and timewarp=position do not go together"),
    },
    // A phone has no runtime that makes frames, so it renders them all.
    Pair { what: "half rate", settings: &["frame-rate=half"], late: 0.0, expected: Expected::Like(31.5) },
    Pair {
        what: "half rate without vectors",
        settings: &["frame-rate=half", "method=mono"],
        late: 0.0,
        expected: Expected::Refused("frame-rate=half and method=mono do not go together"),
    },
];

/// Two checkered boards at 30 cm, one across each border of the inset, before a checkered wall, and a pane of glass between.
fn write_scene(folder: &Path) {
    let mut data: Vec<u8> = Vec::new();
    let (mut views, mut accessors, mut primitives) = (Vec::new(), Vec::new(), Vec::new());
    let mut put = |material: usize, quads: &[(Vec3, f32)]| {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let places: Vec<Vec3> = quads
            .iter()
            .flat_map(|(at, edge)| corners.map(|[x, y]| *at + Vec3::new(x, y, 0.0) * *edge))
            .collect();
        let bounds = |pick: fn(Vec3, Vec3) -> Vec3| places.iter().copied().reduce(pick).unwrap().to_array();
        let bytes: Vec<u8> = places.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes).collect();
        primitives.push(json!({"attributes": {"POSITION": accessors.len()}, "material": material}));
        accessors.push(json!({
            "bufferView": views.len(), "componentType": 5126, "count": places.len(), "type": "VEC3",
            "min": bounds(Vec3::min), "max": bounds(Vec3::max),
        }));
        views.push(json!({"buffer": 0, "byteOffset": data.len(), "byteLength": bytes.len()}));
        data.extend(bytes);
    };
    let squares = |center: Vec3, edge: f32, count: u32, which: u32| -> Vec<(Vec3, f32)> {
        let size = edge / count as f32;
        let corner = center - Vec3::new(edge, edge, 0.0) / 2.0;
        let at = |i: u32| (corner + Vec3::new((i % count) as f32, (i / count) as f32, 0.0) * size, size);
        (0..count * count).filter(|i| (i % count + i / count) % 2 == which).map(at).collect()
    };
    for which in 0..2 {
        for side in [-1.0, 1.0] {
            let center = Vec3::new(side * 0.4, side * 0.05 + 0.1, -1.0) * 0.3;
            put(which as usize, &squares(center, 0.1, 4, which));
        }
        put(2 + which as usize, &squares(Vec3::new(0.0, 0.0, -4.0), 16.0, 24, which));
    }
    put(4, &[(Vec3::new(-0.5, -0.4, -1.5), 0.9)]);
    let paint = |rgba: [f32; 4]| {
        json!({
            "pbrMetallicRoughness": {"baseColorFactor": rgba}, "doubleSided": true,
            "alphaMode": if rgba[3] < 1.0 { "BLEND" } else { "OPAQUE" }, "extensions": {"KHR_materials_unlit": {}},
        })
    };
    let grey = |shade: f32| paint([shade, shade, shade, 1.0]);
    let scene = json!({
        "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_unlit"],
        "scene": 0, "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {"camera": 0}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1.5, "znear": 0.1}}],
        "meshes": [{"primitives": primitives}], "accessors": accessors, "bufferViews": views,
        "materials": [grey(0.8), grey(0.02), grey(0.3), grey(0.15), paint([0.1, 0.5, 0.2, 0.4])],
        "buffers": [{"uri": "boards.bin", "byteLength": data.len()}],
    });
    std::fs::write(folder.join("boards.bin"), data).unwrap();
    std::fs::write(folder.join("boards.gltf"), scene.to_string()).unwrap();
}

fn settings(folder: &Path, pairs: &[&str]) -> Result<Settings, String> {
    let scene = format!("scene={}", folder.join("boards.gltf").display());
    let common = [&scene, "viewer=v1", "msaa=4", "switch=false", "hud=false", "foveation=medium"];
    let settings = Settings::measured().changed(None, common.iter().chain(pairs));
    settings.map_err(|error| error.to_string())
}

/// Returns the pixels of a screen of this size, 110 mm wide, with these settings.
fn picture(gl: &Rc<Context>, settings: Settings, late: f32, size: [u32; 2]) -> Vec<u8> {
    let dpi = size[0] as f32 / 110.0 * 25.4;
    let screen = Screen { size, dpi: [dpi; 2], rotation: Rotation::LandscapeLeft };
    let mut viewer = Cardboard::new(settings, screen, &[]).unwrap();
    viewer.attach(gl.clone()).unwrap();
    let displayed = Quat::from_rotation_y(late.to_radians());
    viewer.hold_head(Some(HeldHead { rendered: Quat::IDENTITY, displayed }));
    while viewer.viewer().scene_state() == SceneState::Loading {
        viewer.viewer_mut().poll_scene();
        std::thread::sleep(Duration::from_millis(2));
    }
    let window = RenderTarget::new(gl, size, &[(Format::Rgba8, Filter::Nearest)], None).unwrap();
    let timing = FrameTiming { now_ns: 1, expected_display_ns: 2, refresh_hz: 60.0 };
    viewer.frame(&Destination::whole(&window), &timing).unwrap();
    window.read_rgba8(0, [0, 0], size)
}

/// Returns the PSNR in dB of those pixels of two pictures that are chosen by their index.
fn psnr(a: &[u8], b: &[u8], is_chosen: impl Fn(usize) -> bool) -> f64 {
    let pixels = a.chunks_exact(4).zip(b.chunks_exact(4)).enumerate();
    let chosen = pixels.filter(|(i, _)| is_chosen(*i));
    let (mut sum, mut count) = (0.0, 0.0);
    for (_, (a, b)) in chosen {
        sum += (0..3).map(|c| f64::from(a[c].abs_diff(b[c])).powi(2)).sum::<f64>();
        count += 3.0;
    }
    10.0 * (255.0 * 255.0 * count / f64::max(sum, 1e-9)).log10()
}

#[test]
fn foveation_with_each_other_setting() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let folder = tempfile::tempdir().unwrap();
    write_scene(folder.path());
    for Pair { what, settings: pairs, late, expected } in PAIRS {
        let subject = settings(folder.path(), pairs);
        match (subject, expected) {
            (Err(sentence), Expected::Refused(start)) => {
                assert!(sentence.starts_with(start) && !sentence.contains('\n'), "{what}: {sentence}");
            }
            (Ok(subject), Expected::Like(least)) => {
                let is_left = subject.dominant == yoro::eyes::Eye::Right;
                let truth: Vec<_> = pairs.iter().copied().chain(["method=conventional"]).collect();
                let truth = picture(gl, settings(folder.path(), &truth).unwrap(), late, WINDOW);
                let got = picture(gl, subject, late, WINDOW);
                let width = WINDOW[0] as usize;
                let half = |i: usize| (i % width < width / 2) == is_left;
                let quality = psnr(&got, &truth, half);
                assert!(quality > least, "{what}: {quality} dB");
            }
            (subject, _) => panic!("{what}: {:?}", subject.map(|_| "is taken")),
        }
    }
    assert_eq!(gl.take_errors(), None);
}

/// Letters of the HUD, which lies below the inset, are as sharp as without foveation.
#[test]
fn the_hud_can_be_read_under_foveation() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let folder = tempfile::tempdir().unwrap();
    write_scene(folder.path());
    let with = |pairs: &[&str]| picture(gl, settings(folder.path(), pairs).unwrap(), 0.0, PHONE);
    let bare = with(&["foveation=off"]);
    let whole = with(&["foveation=off", "hud=true"]);
    let foveated = with(&["hud=true"]);
    let is_panel = |i: usize| bare[4 * i..4 * i + 3] != whole[4 * i..4 * i + 3];
    let quality = psnr(&foveated, &whole, is_panel);
    assert!(quality > 28.0, "{quality} dB");
    assert_eq!(gl.take_errors(), None);
}
