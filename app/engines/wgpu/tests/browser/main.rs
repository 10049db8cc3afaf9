//! A browser's own compiler accepts all modules, and its WebGPU draws OpenGL's picture with them. The page runs the
//! passes from JavaScript. The example is the crate itself, compiled for browsers.

#[path = "../../examples/offscreen/main.rs"]
#[expect(dead_code, reason = "the test does without what saves the picture")]
mod offscreen;

use std::collections::BTreeMap;
use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::{env, fs};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::json;

use yoro::eyes::Warp;
use yoro::synthesis::Uniforms;
use yoro::synthesis::backend::{Places, map_sizes};
use yoro_test_support::against_opengl::{Gl, Picture, assert_equal, flipped, picture, warps};
use yoro_test_support::browser::Browser;
use yoro_wgpu::wgpu;

/// Runs Chromium's WebGPU on the CPU.
const WEBGPU: [&str; 2] = ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"];

#[test]
fn a_browsers_webgpu_draws_opengls_picture() {
    let Some(mut browser) = Browser::start_with(&WEBGPU) else { return };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = fs::read_dir(folder.join("src/wgsl")).unwrap().map(|entry| entry.unwrap().path());
    let modules: BTreeMap<String, String> = files
        .filter(|path| path.extension().is_some_and(|ending| ending == "wgsl"))
        .map(|path| (path.file_stem().unwrap().display().to_string(), fs::read_to_string(&path).unwrap()))
        .collect();
    let gl = Gl::open();
    browser.open(&folder.join("tests/browser/page.html"));
    for (number, (warp, range)) in [warps()[0], warps()[5]].into_iter().enumerate() {
        let picture = picture(&warp, range, number as u64);
        let want = flipped(&gl.run(&picture).rgba, warp.target_size[1]);
        let Picture { rgba, depth, .. } = picture;
        // WebGPU has the topmost row first.
        let (rgba, depth) = (flipped(&rgba, warp.source_size[1]), flipped(&depth, warp.source_size[1]));
        let places =
            Places { source_origin: [0, 0], image_size: warp.source_size, target_origin: [0, 0], part: true };
        let uniforms = Uniforms::of_part(&warp.rows_from_top(), &places);
        let [tiles, spans] = map_sizes::<Warp>([warp.source_size, warp.target_size]);
        let given = json!({
            "modules": modules,
            "uniforms": bytemuck::bytes_of(&uniforms),
            "color": rgba,
            "depth": depth,
            "source": warp.source_size,
            "target": warp.target_size,
            "tiles": tiles,
            "spans": spans,
        });
        let got = browser.evaluate(&format!("({})({given})", include_str!("passes.js").trim()));
        if got.is_null() {
            return println!("LEFT OUT: this browser has no WebGPU");
        }
        assert_eq!(got["says"], json!([]), "{}", got["adapter"]);
        let got: Vec<u8> = serde_json::from_value(got["rgba"].clone()).unwrap();
        assert_equal(&got, &want, 4, &format!("{warp:?}"));
    }
}

/// A program that is killed when this is dropped.
struct Server(Child);

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn the_example_in_a_browser_draws_opengls_picture() {
    let Some(xtask) = env::var_os("YORO_TEST_WGPU_WEB") else {
        let without = env::var_os("YORO_TEST_WITHOUT_WGPU_WEB").is_some();
        assert!(without, "run `cargo xtask test the_example_in_a`, or set YORO_TEST_WITHOUT_WGPU_WEB=1");
        return eprintln!("LEFT OUT: the example was not built for browsers");
    };
    let Some(mut browser) = Browser::start_with(&WEBGPU) else { return };
    let mut command = Command::new(xtask);
    command.args(["web", "--wgpu", "--serve", "--as-built", "--port", "0"]);
    let mut server = Server(command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().unwrap());
    let lines = BufReader::new(server.0.stdout.take().unwrap()).lines();
    let address = lines
        .map_while(Result::ok)
        .find_map(|line| line.split_whitespace().find(|word| word.starts_with("http://")).map(str::to_owned));
    let address = address.expect("the server says where it is");
    browser.allow(&address);
    browser.go(&address);
    if browser.evaluate("(async () => !await navigator.gpu?.requestAdapter())()") == json!(true) {
        return println!("LEFT OUT: this browser has no WebGPU");
    }
    let says = browser.evaluate(
        "new Promise((done) => { const look = () => { const text = document.querySelector('p').textContent; \
         text ? done(text) : setTimeout(look, 50); }; look(); })",
    );
    let picture = browser.evaluate("document.querySelector('canvas').toDataURL('image/png').split(',')[1]");
    let png = STANDARD.decode(picture.as_str().unwrap()).unwrap();
    let got = image::load_from_memory(&png).unwrap().into_rgb8();

    let descriptor = wgpu::InstanceDescriptor {
        backends: wgpu::Backends::GL,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    };
    let want = pollster::block_on(offscreen::Stereo::draw(&wgpu::Instance::new(descriptor))).unwrap();
    // The room itself is rounded differently by the two drivers: the rendered eye differs in some pixels at edges, and
    // its depth moves edges of the synthesized eye.
    let want = want.side_by_side();
    assert_eq!(got.dimensions(), want.dimensions(), "{says}");
    let mut differ = [0, 0];
    for ((x, _, a), b) in got.enumerate_pixels().zip(want.pixels()) {
        differ[usize::from(x >= got.width() / 2)] += u32::from((0..3).any(|i| a[i].abs_diff(b[i]) > 1));
    }
    let says = format!("{says}: left and right {differ:?} pixels of {:?} differ", got.dimensions());
    println!("{says}");
    let pixels = got.width() * got.height() / 2;
    assert!(differ[0] * 1000 <= pixels && differ[1] * 4000 <= pixels, "{says}");
}
