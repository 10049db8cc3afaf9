//! `yoro render` on files.

use std::fs;
use std::path::Path;

use image::{Rgb, RgbImage};

use crate::program::{run, succeed};

/// A textured wall in front of a red one. Tests write the `mtllib` and the texture if they need them.
const OBJ: &str = "mtllib room.mtl
v -1 -1 -2\nv 1 -1 -2\nv 1 1 -2\nv -1 1 -2
v -9 -9 -6\nv 9 -9 -6\nv 9 9 -6\nv -9 9 -6
vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1
usemtl picture\nf 1/1 2/2 3/3 4/4
usemtl red\nf 5/1 6/2 7/3 8/4
";
const MTL: &str = "newmtl picture\nKd 1 1 1\nmap_Kd picture.png\nnewmtl red\nKd 0.8 0.1 0.1\n";
const LOOK: &str = "--position 0,0,0 --target 0,0,-1 --size 96x64";

/// A triangle that moves from left to right within a second.
const MOVING: &str = r#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}], "samplers": [{"input": 1, "output": 2}]}],
  "buffers": [{"byteLength": 68, "uri": "data:application/octet-stream;base64,zczMvs3MzL4AAADAzczMPs3MzL4AAADAAAAAAM3MzD4AAADAAAAAAAAAgD+amRm/AAAAAAAAAACamRk/AAAAAAAAAAA="}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8}, {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
    {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR"}, {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}]}"#;

fn write_texture(dir: &Path) {
    let texture =
        RgbImage::from_fn(64, 64, |x, _| if x < 32 { Rgb([20, 220, 40]) } else { Rgb([30, 60, 230]) });
    yoro_media::save_color(&dir.join("picture.png"), &texture).unwrap();
}

fn right_eye(dir: &Path) -> RgbImage {
    yoro_media::load_color(&dir.join("out/room.right.png")).unwrap()
}

/// Returns the index of the largest channel.
fn hue(image: &RgbImage, x: u32, y: u32) -> usize {
    let pixel = image.get_pixel(x, y).0;
    (0..3).max_by_key(|&c| pixel[c]).unwrap()
}

/// Far from the origin, the positions of the eyes are rounded to f32. The library accepts this.
#[test]
fn scenes_far_from_the_origin_are_rendered() {
    let dir = tempfile::tempdir().unwrap();
    for (distance, turn) in [(1500.0f32, 0.4f32), (10_000.0, 1.1), (90_000.0, 2.3)] {
        let (sin, cos) = turn.sin_cos();
        let [x, z] = [distance * cos, distance * sin];
        let place = format!("--position {x},1.6,{z} --target {},1.2,{}", x + 4.0, z + 3.0);
        succeed(dir.path(), &format!("render prototype --size 64x64 --outputs left {place}"));
    }
    // Positions at this distance are rounded to equally large steps.
    fs::write(dir.path().join("m.obj"), "v 1500 0 0\nv 1510 0 0\nv 1500 5 1\nf 1 2 3\n").unwrap();
    let camera = |x: f32| {
        format!(
            "[{{\"position\": [{x}, 1.6, 9.3], \"target\": [1503.1, 1.1, 0]}}, {{\"position\": [1507.7, 1.7, 8.1], \"target\": [1501.3, 1.9, 0]}}]"
        )
    };
    fs::write(dir.path().join("camera.json"), camera(1502.2)).unwrap();
    let frames = succeed(dir.path(), "render m.obj --size 64x64 --outputs left --frames 9");
    assert_eq!(frames.stdout.lines().count(), 9);
    fs::write(dir.path().join("camera.json"), camera(1e38)).unwrap();
    run(dir.path(), "render m.obj --size 64x64").refuses(&["camera.json", "viewpoint 1", "100000 m at most"]);
}

#[test]
fn materials_and_textures_of_an_obj_file() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("room.obj"), OBJ).unwrap();
    fs::write(dir.path().join("room.mtl"), MTL).unwrap();
    write_texture(dir.path());
    let run = succeed(dir.path(), &format!("render room.obj {LOOK}"));
    assert_eq!(run.stderr, "");
    assert_eq!(run.stdout, "out/room.left.png\nout/room.right.png\nout/room.side-by-side.png\n");
    let image = right_eye(dir.path());
    assert_eq!(image.dimensions(), (96, 64));
    // The right eye is 31.5 mm to the right, so the near wall's centre is slightly to the left of the image's centre.
    assert_eq!([hue(&image, 40, 32), hue(&image, 56, 32), hue(&image, 5, 32)], [1, 2, 0]);
    let both = yoro_media::load_color(&dir.path().join("out/room.side-by-side.png")).unwrap();
    assert_eq!(both.dimensions(), (192, 64));
}

#[test]
fn missing_materials_and_textures_give_warnings() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("room.obj"), OBJ).unwrap();
    let run = succeed(dir.path(), &format!("render room.obj {LOOK}"));
    assert!(run.stderr.contains("WARN") && run.stderr.contains("room.mtl"), "{}", run.stderr);
    fs::write(dir.path().join("room.mtl"), MTL).unwrap();
    let run = succeed(dir.path(), &format!("render room.obj {LOOK}"));
    assert!(run.stderr.contains("WARN") && run.stderr.contains("picture.png"), "{}", run.stderr);
    assert_eq!(hue(&right_eye(dir.path()), 5, 32), 0, "the material that is there is used");
}

#[test]
fn every_output_and_measure() {
    let dir = tempfile::tempdir().unwrap();
    let outputs = ["left", "right", "side-by-side", "cross-eyed", "anaglyph", "difference", "error-map"];
    let line = format!("render prototype --size 96x96 --measure --json --outputs {}", outputs.join(","));
    let json = succeed(dir.path(), &line).json();
    let (quality, baseline) = (&json[0]["quality"], &json[0]["same_image"]);
    let ssim = |quality: &serde_json::Value| quality["ssim_gaussian"].as_f64().unwrap();
    assert!(ssim(quality) > ssim(baseline) + 0.05, "{json:#}");
    for output in outputs {
        let image = yoro_media::load_color(&dir.path().join(format!("out/prototype.{output}.png"))).unwrap();
        let width = if output.contains("side") || output.contains("cross") { 192 } else { 96 };
        assert_eq!(image.dimensions(), (width, 96), "{output}");
        let first = image.get_pixel(0, 0);
        assert!(image.pixels().any(|p| p != first), "{output} is one colour");
    }
    let json =
        succeed(dir.path(), "render prototype --size 96x96 --measure --json --method conventional").json();
    assert_eq!(ssim(&json[0]["quality"]), 1.0, "{json:#}");
}

/// Features of a glTF file that the renderer does not support are reported once per material.
#[test]
fn features_left_out_of_a_gltf_file_are_reported() {
    let dir = tempfile::tempdir().unwrap();
    yoro_media::save_color(&dir.path().join("pic.png"), &RgbImage::new(4, 4)).unwrap();
    let corners = [[0f32, 0., 0.], [1., 0., 0.], [0., 1., 0.]];
    let (uvs, colors) = ([[0f32, 0.], [2., 0.], [0., 2.]], [[1f32, 0., 0.]; 3]);
    let floats = corners.iter().flatten().chain(uvs.iter().flatten()).chain(colors.iter().flatten());
    fs::write(dir.path().join("data.bin"), floats.flat_map(|f| f.to_le_bytes()).collect::<Vec<u8>>())
        .unwrap();
    let text = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2}, "material": 0}]}],
        "materials": [{"name": "paint", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "samplers": [{"wrapT": 33071}], "textures": [{"source": 0, "sampler": 0}], "images": [{"uri": "pic.png"}],
        "buffers": [{"byteLength": 96, "uri": "data.bin"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24},
            {"buffer": 0, "byteOffset": 60, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC3"}]}"#;
    fs::write(dir.path().join("a.gltf"), text).unwrap();
    let output = succeed(dir.path(), "render a.gltf --size 64 --outputs left").stderr;
    for words in ["clamps or mirrors", "colours of vertices"] {
        let lines: Vec<_> = output.lines().filter(|line| line.contains(words)).collect();
        assert!(lines.len() == 1 && lines[0].contains("paint"), "{output}");
    }
}

#[test]
fn what_moves_is_rendered_at_a_time() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("m.gltf"), MOVING).unwrap();
    let viewpoint = |x: f32| format!("{{\"position\": [{x}, 0, 1], \"target\": [0, 0, -2]}}");
    let camera = format!("[{}, {}]", viewpoint(0.0), viewpoint(0.4));
    fs::write(dir.path().join("camera.json"), camera).unwrap();
    let render = |options: &str, name: &str| {
        succeed(dir.path(), &format!("render m.gltf --size 96x64 --outputs right {options}"));
        yoro_media::load_color(&dir.path().join(format!("out/{name}.right.png"))).unwrap()
    };
    let [start, half] = ["", "--time 0.5"].map(|options| render(options, "m"));
    assert!(start != half);
    // The animation repeats, also before its start.
    for (options, expected) in [("--time 0", &start), ("--time 3", &start), ("--time -1.5", &half)] {
        assert!(render(options, "m") == *expected, "{options}");
    }
    // The fourth frame is a tenth of a second after the first.
    let last = render("--frames 4 --time 0.4", "m-0003");
    assert!(last == render("--pose 1 --time 0.5", "m") && last != render("--pose 1 --time 0.4", "m"));
    run(dir.path(), "render m.gltf --time soon").refuses(&["--time", "seconds"]);
}
