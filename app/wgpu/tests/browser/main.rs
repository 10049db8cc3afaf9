//! A browser's own compiler takes all modules, and its WebGPU draws OpenGL's picture with them. The page has the passes in
//! JavaScript: the module's Rust code is not in it.

#[path = "../../../core/tests/vulkan/against_opengl.rs"]
#[expect(dead_code, reason = "shared with tests that use all of it")]
mod against_opengl;
#[path = "../../../../tests/program/browser.rs"]
#[expect(dead_code, reason = "shared with the program's tests, which use all of it")]
mod browser;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::json;

use against_opengl::{Gl, Picture, assert_equal, picture, warps};
use browser::Browser;
use yoro::synthesis::{Places, Uniforms, tiles};

#[test]
fn a_browsers_webgpu_draws_opengls_picture() {
    let Some(mut browser) =
        Browser::start_with(&["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"])
    else {
        return;
    };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = fs::read_dir(folder.join("src/wgsl")).unwrap().map(|entry| entry.unwrap().path());
    let modules: BTreeMap<String, String> = files
        .filter(|path| path.extension().is_some_and(|ending| ending == "wgsl"))
        .map(|path| (path.file_stem().unwrap().display().to_string(), fs::read_to_string(&path).unwrap()))
        .collect();
    let gl = Gl::new();
    browser.open(&folder.join("tests/browser/page.html"));
    for (number, (warp, range)) in [warps()[0], warps()[5]].into_iter().enumerate() {
        // OpenGL gets the picture upside down, so that the same rows are in one tile.
        let turned = warp.rows_from_top();
        let Picture { rgba, depth, .. } = picture(&turned, range, number as u64);
        let want = gl.run(number, &Picture { warp: turned, rgba: rgba.clone(), depth: depth.clone() }).rgba;
        let places =
            Places { source_origin: [0, 0], image_size: warp.source_size, target_origin: [0, 0], part: true };
        let uniforms = Uniforms::of_part(&turned, &places);
        let given = json!({
            "modules": modules,
            "variant": (["", "-short"][number]),
            "uniforms": bytemuck::bytes_of(&uniforms),
            "color": rgba,
            "depth": depth,
            "source": warp.source_size,
            "target": warp.target_size,
            "tiles": tiles(warp.source_size),
            "spans": tiles([warp.target_size[0], warp.source_size[1]]),
        });
        let got = browser.evaluate(&format!("({})({given})", include_str!("passes.js").trim()));
        if got.is_null() {
            return println!("LEFT OUT: this browser has no WebGPU");
        }
        assert_eq!(got["says"], json!([]), "{}", got["adapter"]);
        let got: Vec<u8> = serde_json::from_value(got["rgba"].clone()).unwrap();
        assert_equal(&got, &want, 4, 0, &format!("{warp:?}"));
    }
}
