//! Models as people download them: drawn as their files say, or with a sentence that says what is not.

use std::fs;
use std::path::Path;

use image::{Rgba, RgbaImage};
use serde_json::{Value, json};

use crate::program::{run, succeed};

/// From here, squares at a distance of 2 m are seen as far as 1.15 m to all sides.
const LOOK: &str = "--position 0,0,0 --target 0,0,-1 --size 96 --outputs right --ipd 0.05";

/// The corners of a square from -1 to 1 that faces +Z, its texture coordinates, and two triangles.
fn square() -> Vec<u8> {
    let corners = [[-1f32, -1., 0.], [1., -1., 0.], [1., 1., 0.], [-1., 1., 0.]];
    let uvs = [[0f32, 1.], [1., 1.], [1., 0.], [0., 0.]];
    let floats = corners.iter().flatten().chain(uvs.iter().flatten()).flat_map(|x| x.to_le_bytes());
    floats.chain([0, 0, 1, 0, 2, 0, 0, 0, 2, 0, 3, 0]).collect()
}

/// Writes `NAME.gltf` with squares, each with its material, at places and of a size.
fn write(dir: &Path, name: &str, materials: &Value, nodes: &[(usize, [f32; 3], f32)]) -> Value {
    fs::write(dir.join("square.bin"), square()).unwrap();
    let meshes: Vec<Value> = (0..materials.as_array().unwrap().len())
        .map(|m| {
            let attributes = json!({"POSITION": 0, "TEXCOORD_0": 1});
            json!({"primitives": [{"attributes": attributes, "indices": 2, "material": m}]})
        })
        .collect();
    let node = |(mesh, place, size): &(usize, [f32; 3], f32)| json!({"mesh": mesh, "translation": place, "scale": [size, size, size]});
    let root = json!({
        "asset": {"version": "2.0"}, "nodes": nodes.iter().map(node).collect::<Vec<_>>(), "meshes": meshes,
        "materials": materials, "textures": [{"source": 0}], "images": [{"uri": "map.png"}],
        "buffers": [{"byteLength": 92, "uri": "square.bin"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 32},
            {"buffer": 0, "byteOffset": 80, "byteLength": 12}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}]
    });
    fs::write(dir.join(format!("{name}.gltf")), root.to_string()).unwrap();
    root
}

/// Renders a file and returns the right eye.
fn draw(dir: &Path, name: &str) -> image::RgbImage {
    succeed(dir, &format!("render {name}.gltf {LOOK}"));
    yoro_media::load_color(&dir.join(format!("out/{name}.right.png"))).unwrap()
}

fn unlit(color: [f32; 4], mode: &str) -> Value {
    json!({"alphaMode": mode, "extensions": {"KHR_materials_unlit": {}}, "pbrMetallicRoughness": {"baseColorFactor": color}})
}

#[test]
fn unlit_surfaces_have_their_own_colour() {
    let dir = tempfile::tempdir().unwrap();
    let red = unlit([1., 0., 0., 1.], "OPAQUE");
    let (grey, glass) = (unlit([0.214, 0.214, 0.214, 1.], "OPAQUE"), unlit([0., 0., 1., 0.5], "BLEND"));
    let nodes = [(0, [-0.6, 0., -2.], 0.4), (1, [0.6, 0., -2.], 0.4), (2, [-0.6, 0.2, -1.9], 0.1)];
    write(dir.path(), "unlit", &json!([red, grey, glass]), &nodes);
    let image = draw(dir.path(), "unlit");
    let near = |x, y, expected: [u8; 3]| {
        let pixel = image.get_pixel(x, y).0;
        assert!((0..3).all(|c| pixel[c].abs_diff(expected[c]) <= 2), "{pixel:?} instead of {expected:?}");
    };
    near(22, 56, [255, 0, 0]);
    near(72, 48, [127, 127, 127]);
    near(22, 39, [128, 0, 128]);
}

/// Alpha grows from left to right on a square of 1024 pixels, drawn at 80 pixels.
#[test]
fn alpha_is_drawn_as_the_file_says() {
    let dir = tempfile::tempdir().unwrap();
    let ramp = RgbaImage::from_fn(1024, 1024, |x, _| Rgba([255, 255, 255, (x / 4) as u8]));
    ramp.save(dir.path().join("map.png")).unwrap();
    let material = |mode: &str, cutoff: f32, opacity: f32| {
        let mut material = unlit([1., 1., 1., opacity], mode);
        material["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 0});
        material["alphaCutoff"] = json!(cutoff);
        material
    };
    let back = unlit([0., 0., 0., 1.], "OPAQUE");
    // Returns the brightness of the square's columns, from its left border to its right one.
    let row = |name: &str, material: Value| {
        let nodes = [(0, [0., 0., -2.], 1.0), (1, [0., 0., -3.], 9.0)];
        write(dir.path(), name, &json!([material, back]), &nodes);
        let image = draw(dir.path(), name);
        // The right eye is 25 mm to the right.
        let border = |x: f32| (x - 0.025) / (2.0 * 30f32.to_radians().tan()) * 48.0 + 48.0;
        let columns = border(-1.0).round() as u32..border(1.0).round() as u32;
        columns.map(|x| image.get_pixel(x, 48).0[0]).collect::<Vec<u8>>()
    };
    // At its borders the picture repeats.
    let cut = |row: &[u8]| (4 + row[4..].iter().position(|p| *p > 128).unwrap()) as f32 / row.len() as f32;
    for cutoff in [0.25, 0.5, 0.75] {
        let cut = cut(&row("mask", material("MASK", cutoff, 1.0)));
        assert!((cut - cutoff).abs() < 0.03, "cut at {cut} instead of {cutoff}");
    }
    // Half as opaque, the ramp reaches the cut-off at twice the alpha.
    let half = cut(&row("half", material("MASK", 0.4, 0.5)));
    assert!((half - 0.8).abs() < 0.03, "cut at {half} instead of 0.8");
    let blended = row("blend", material("BLEND", 0.5, 1.0));
    let at = |share: f32| blended[(share * blended.len() as f32) as usize];
    assert!(at(0.25).abs_diff(64) < 6 && at(0.75).abs_diff(191) < 6, "{blended:?}");
    // From behind, what is cut out of one side is not there.
    write(dir.path(), "behind", &json!([material("MASK", 0.5, 1.0)]), &[(0, [0., 0., -2.], 1.0)]);
    let line = "render behind.gltf --position 0,0,-4 --target 0,0,-2 --size 64 --outputs left";
    let output = succeed(dir.path(), line).stderr;
    assert!(output.contains("1 of 1 frames of behind show nothing"), "{output}");
    write(dir.path(), "below", &json!([material("MASK", 0.5, 0.4)]), &[(0, [0., 0., -2.], 1.0)]);
    run(dir.path(), "render below.gltf").refuses(&["below.gltf: nothing of it can be seen", "alpha cutoff"]);
    // One viewpoint is no path; another scene is not measured first.
    let camera = json!([{"position": [0, 0, 1], "target": [0, 0, -2]}]);
    fs::write(dir.path().join("behind.camera.json"), camera.to_string()).unwrap();
    let bench = "bench half-rate --quick --scene prototype --scene behind.gltf --out results.jsonl";
    run(dir.path(), bench).refuses(&["behind has no camera path"]);
    assert!(!dir.path().join("results.jsonl").exists());
}

#[test]
fn a_view_of_nothing_has_its_reason() {
    let dir = tempfile::tempdir().unwrap();
    let camera = |name: &str, distance: u32| {
        let camera = json!([{"position": [0, 0, distance], "target": [0, 0, -2]}]);
        fs::write(dir.path().join(format!("{name}.camera.json")), camera.to_string()).unwrap();
    };
    // What is blended has no depth, but is seen.
    write(dir.path(), "glass", &json!([unlit([0., 0., 1., 0.5], "BLEND")]), &[(0, [0., 0., -2.], 1.0)]);
    camera("glass", 1);
    succeed(dir.path(), "run glass.gltf --size 64 --viewpoints 1 --pipelines gather");
    write(dir.path(), "far", &json!([unlit([1., 0., 0., 1.], "OPAQUE")]), &[(0, [0., 0., -2.], 100.0)]);
    camera("far", 1600);
    let output = run(dir.path(), "run far.gltf --size 64 --viewpoints 1 --pipelines gather");
    let refused = ["viewpoint 0 of far", "the far plane of 1000 m", "--far 2000"];
    assert!(
        output.code == Some(2) && refused.iter().all(|words| output.stderr.contains(words)),
        "{}",
        output.stderr
    );
    // A model of 200 units is probably one in centimetres.
    assert!(
        output.stderr.contains("far.gltf is 200 m large") && output.stderr.contains("0.01"),
        "{}",
        output.stderr
    );
    fs::write(dir.path().join("far.scene.json"), r#"{"scale": 1}"#).unwrap();
    assert_eq!(succeed(dir.path(), "render far.gltf --size 64 --far 2000 --outputs left").stderr, "");
    let output =
        succeed(dir.path(), "render far.gltf --size 64 --far 9000 --near 2000 --outputs left").stderr;
    assert!(output.contains("the near plane of 2000 m") && output.contains("--near 0."), "{output}");
}
