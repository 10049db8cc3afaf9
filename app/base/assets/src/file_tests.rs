//! Loads files of every kind, good and bad, with [`load`].

use std::path::{Path, PathBuf};
use std::{fs, time};

use base64::Engine as _;
use glam::{Vec2, Vec3};
use image::{Rgba, RgbaImage};
use proptest::prelude::*;
use tempfile::TempDir;

use super::*;

struct Folder(TempDir);

impl Folder {
    fn new() -> Folder {
        Folder(tempfile::tempdir().unwrap())
    }

    fn put(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, content).unwrap();
        path
    }

    fn picture(&self, name: &str, size: u32, f: impl Fn(u32, u32) -> [u8; 4]) -> PathBuf {
        let path = self.put(name, "");
        RgbaImage::from_fn(size, size, |x, y| Rgba(f(x, y))).save(&path).unwrap();
        path
    }
}

fn obj(text: impl AsRef<[u8]>) -> Model {
    obj_scene(text).model
}

fn obj_scene(text: impl AsRef<[u8]>) -> Scene {
    load(&Folder::new().put("t.obj", text)).unwrap()
}

fn refused(text: impl AsRef<[u8]>, words: &[&str]) {
    refused_file(&Folder::new().put("t.obj", text), &[words, &["t.obj"]].concat());
}

#[track_caller]
fn refused_file(path: &Path, words: &[&str]) {
    let message = load(path).unwrap_err().to_string();
    for word in words {
        assert!(message.contains(word), "`{message}` should mention `{word}`");
    }
    assert!(!message.contains('\n'));
}

/// Returns the sum of the triangles' area vectors.
fn area(model: &Model) -> Vec3 {
    let triangle = |t: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|k| model.vertices[t[k] as usize].position);
        (b - a).cross(c - a) * 0.5
    };
    model.indices.chunks_exact(3).map(triangle).sum()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn square(rest: &str) -> String {
    format!("{SQUARE}{rest}")
}

#[test]
fn three_vertices_and_a_face_are_a_model() {
    let model = obj(square("f 1 2 3 4"));
    assert_eq!((model.triangle_count(), model.vertices.len()), (2, 4));
    assert!(model.vertices.iter().all(|v| v.normal == Vec3::Z && v.uv == Vec2::ZERO));
    assert_eq!(model.materials, [Material { double_sided: true, ..Material::default() }]);
    assert_eq!(model.parts, [Part { name: "model".into(), material: 0, indices: 0..6 }]);
}

#[test]
fn corners_are_read_in_all_spellings() {
    let given = "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 2\nvn 1 0 0\n";
    for face in ["1/1/1 2/2/1 3/3/1", "-4/-3/-2 -3/-2/-2 -2/-1/-2", "1/1/-2 2/2/1 -2/3/-2"] {
        let model = obj(square(&format!("{given}f {face}\n")));
        assert_eq!(
            model.vertices[2],
            Vertex { position: Vec3::new(1., 1., 0.), normal: Vec3::Z, uv: Vec2::ONE },
            "{face}"
        );
    }
    let model = obj(square(&format!("{given}f 1//2 2//2 3//2\nf 1/1 3/3 4/0/0\n")));
    assert_eq!(model.vertices[0].normal, Vec3::X);
    // The second face shares no vertex with the first and gets its own normal.
    let last = model.vertices[model.indices[5] as usize];
    assert_eq!((last.position, last.normal), (Vec3::Y, Vec3::Z));
}

#[test]
fn corners_with_and_without_normals_do_not_mix_up() {
    let model = obj(square("vn 1 0 0\nvt .5 .5\nf 1 2//1 3/1\n"));
    let of = |k: usize| model.vertices[model.indices[k] as usize];
    assert_eq!([of(0).normal, of(1).normal, of(2).normal], [Vec3::Z, Vec3::X, Vec3::Z]);
    assert_eq!(of(2).uv, Vec2::splat(0.5));
}

#[test]
fn line_ends_of_every_system_are_read() {
    let unix = obj(square("f 1 2 3 4\n"));
    assert_eq!(obj(square("f 1 2 3 4\n").replace('\n', "\r\n")), unix);
    assert_eq!(obj(square("f 1 2 3 4\n").replace('\n', "\r")), unix);
    assert_eq!(obj(square("f 1 2 \\\n3 \\\r\n4 # a face")), unix);
    assert_eq!(obj(format!("\u{feff}{}", square("f 1 2 3 4"))), unix);
    assert_eq!(obj(square("\t f\t1  2\t3 4   ")), unix);
    let latin1 = [b"# caf\xe9\n".as_slice(), square("f 1 2 3 4").as_bytes()].concat();
    assert_eq!(obj(latin1), unix);
    assert_eq!(obj(square("p 1\nl 1 2 3\nf 1 2\nxyz 3\nvp 1\nf 1 2 3 4\nend")), unix);
    assert_eq!(obj(square("f 1 2 3 4\nf 1 2 2\n")).triangle_count(), 2);
}

#[test]
fn groups_and_materials_are_named_without_a_library() {
    let model =
        obj(square("usemtl a\no one\nf 1 2 3\nusemtl b\nf 1 3 4\ng two\nusemtl\ta\nf 2 3 4\ng one\nf 1 2 4"));
    let names: Vec<_> = model.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["a", "b"]);
    let parts: Vec<_> = model.parts.iter().map(|p| (p.name.as_str(), p.material, p.indices.len())).collect();
    assert_eq!(parts, [("one", 0, 6), ("two", 0, 3), ("one", 1, 3)]);
}

#[test]
fn smoothing_off_makes_faces_flat() {
    let roof = "v -1 0 0\nv 0 .3 0\nv 1 0 0\nv -1 0 -1\nv 0 .3 -1\nv 1 0 -1\n";
    assert_eq!(obj(format!("{roof}f 1 2 5 4\nf 2 3 6 5")).vertices.len(), 6);
    assert_eq!(obj(format!("{roof}s off\nf 1 2 5 4\nf 2 3 6 5")).vertices.len(), 8);
}

#[test]
fn vertex_colours_become_a_palette() {
    let model = obj("v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nv 1 1 0 0 1 1\nf 1 2 3\nf 2 4 4 3");
    let texture = &model.textures[model.materials[0].diffuse_map.unwrap()];
    let uv = model.vertices[model.indices[0] as usize].uv;
    let [w, h] = texture.size.map(|s| s as f32);
    let (x, y) = ((uv.x * w) as usize, ((1.0 - uv.y) * h) as usize);
    assert_eq!(texture.rgba[(y * w as usize + x) * 4..][..4], [255, 0, 0, 255]);
}

#[test]
fn absurd_files_are_refused_in_a_sentence() {
    refused("", &["no triangle", "export"]);
    refused([0x7f, b'E', b'L', b'F', 0, 0, 1], &["line 1", "binary"]);
    refused("v 1 x 3", &["line 1", "position"]);
    refused("\n\nvn 1 2", &["line 3", "normal"]);
    for corner in ["0", "-5", "1/2/3/4", "-9223372036854775808", "99999999999999999999999", "1//x"] {
        refused(square(&format!("f 1 2 {corner}")), &["line 5", corner]);
    }
    refused(square("f 1 2 5"), &["line 5", "vertex index out of bounds"]);
    refused(square("f 1/9 2/1 3/1"), &["texcoord index"]);
    refused(square("vn 0 0 1\nf 1//2 2//1 3//1"), &["normal index"]);
    refused("v 1e30 0 0\nv 0 1e30 0\nv 0 0 0\nf 1 2 3", &["scale"]);
}

#[test]
fn paths_of_other_things_are_refused_with_a_remedy() {
    let folder = Folder::new();
    refused_file(&folder.0.path().join("no.obj"), &["there is no file"]);
    refused_file(folder.0.path(), &["is not a file"]);
    refused_file(&folder.put("a.fbx", "x"), &["convert it"]);
    refused_file(&folder.put("a", "x"), &["convert it"]);
    refused_file(&folder.put("a.obj", "").join("b.obj"), &["there is no file"]);
}

#[test]
fn faces_may_refer_forward_within_their_group() {
    assert_eq!(obj(format!("f 1 2 3 4\n{SQUARE}")).triangle_count(), 2);
    refused(format!("f 1 2 3\ng x\nf 1 2 3\n{SQUARE}"), &["vertex index"]);
}

#[test]
fn libraries_are_found_and_missing_ones_replaced() {
    let folder = Folder::new();
    folder.put("Lib One.mtl", "newmtl red\nKd 1 0 0\n");
    folder.put("two.mtl", "newmtl Green\nKd 0 1 0\nnewmtl red\nKd 0 0 0");
    let text = square(
        "mtllib lib one.mtl\nmtllib TWO.MTL missing.mtl\nusemtl red\nf 1 2 3\nusemtl Green\nf 1 3 4\nusemtl none\nf 2 3 4",
    );
    let model = load(&folder.put("a.obj", text)).unwrap().model;
    let colours: Vec<_> = model.materials.iter().map(|m| m.diffuse).collect();
    assert_eq!(colours, [Vec3::X, Vec3::Y, Material::default().diffuse]);
    // If no named library exists, the one with the model's name is used.
    folder.put("b.mtl", "newmtl red\nKd 0 0 1");
    let model = load(&folder.put("b.obj", square("mtllib gone.mtl\nusemtl red\nf 1 2 3"))).unwrap().model;
    assert_eq!(model.materials[0].diffuse, Vec3::Z);
    folder.put("c.mtl", [0u8, 255, 3]);
    assert!(load(&folder.put("c.obj", square("mtllib c.mtl\nusemtl red\nf 1 2 3"))).is_ok());
}

#[test]
fn textures_are_found_in_all_spellings_of_their_path() {
    let folder = Folder::new();
    folder.picture("Textures/My Wood.PNG", 4, |_, _| [200, 100, 50, 255]);
    for name in [
        "Textures/My Wood.PNG",
        "textures\\my wood.png",
        "C:\\art\\maps\\my wood.png",
        "/home/x/Textures/My Wood.PNG",
        "my wood.png",
        "-s 2 2 -o 0.5 0 textures/my wood.png",
    ] {
        folder.put("a.mtl", format!("newmtl m\nmap_Kd {name}\n"));
        let model = load(
            &folder.put("a.obj", square("mtllib a.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl m\nf 1/1 2/2 3/3")),
        )
        .unwrap()
        .model;
        assert_eq!(model.materials[0].diffuse_map, Some(0), "{name}");
        assert_eq!(
            (model.textures[0].size, &model.textures[0].rgba[..4]),
            ([4, 4], [200, 100, 50, 255].as_slice())
        );
        let moved = name.starts_with("-s");
        assert_eq!(model.vertices[2].uv, if moved { Vec2::new(2.5, 2.0) } else { Vec2::ONE });
    }
    // Names count from the library, then from the OBJ file.
    folder.picture("mats/tex/wood.png", 4, |_, _| [1, 2, 3, 255]);
    folder.picture("tex/wood.png", 4, |_, _| [9, 9, 9, 255]);
    folder.put("mats/b.mtl", "newmtl m\nmap_Kd tex/wood.png\nnewmtl n\nmap_Kd Textures/my wood.png\n");
    let text = square("mtllib mats/b.mtl\nusemtl m\nf 1 2 3\nusemtl n\nf 1 2 4");
    let model = load(&folder.put("b.obj", text)).unwrap().model;
    let colour = |i: usize| model.textures[model.materials[i].diffuse_map.unwrap()].rgba[..3].to_vec();
    assert_eq!([colour(0), colour(1)], [[1, 2, 3], [200, 100, 50]]);
    for name in ["gone.png", "a.obj"] {
        folder.put("a.mtl", format!("newmtl m\nKd .5 .5 .5\nmap_Kd {name}\n"));
        let model = load(&folder.0.path().join("a.obj")).unwrap().model;
        assert_eq!((model.materials[0].diffuse_map, model.textures.len()), (None, 0));
    }
}

#[test]
fn every_kind_of_map_becomes_a_texture() {
    let folder = Folder::new();
    folder.picture("leaf.png", 8, |x, _| [0, 200, 0, if x < 4 { 0 } else { 255 }]);
    folder.picture("mask.png", 8, |x, _| if x < 4 { [0, 0, 0, 255] } else { [255; 4] });
    folder.picture("glass.png", 8, |_, _| [0, 0, 255, 100]);
    folder.picture("plain.png", 8, |x, _| [x as u8 * 30, 0, 0, 255]);
    folder.picture("bumps.png", 8, |x, _| [(x * 30) as u8; 4].map(|v| v.max(1)));
    folder.picture("normals.png", 8, |_, _| [128, 128, 255, 255]);
    folder.put("a.mtl", "newmtl leaf\nmap_Kd leaf.png\nnewmtl masked\nmap_Kd plain.png\nmap_d mask.png\nnewmtl only\nKd 0 1 0\nmap_d mask.png\n\
        newmtl glass\nd .5\nmap_Kd glass.png\nnewmtl rest\nmap_Kd plain.png\nmap_Ks plain.png\nmap_Ke plain.png\nmap_Bump -bm 2 bumps.png\nnewmtl n\nbump normals.png -bm 1\n");
    let mut text = square("mtllib a.mtl\n");
    for m in ["leaf", "masked", "only", "glass", "rest", "n"] {
        text += &format!("usemtl {m}\nf 1 2 3\n");
    }
    let model = load(&folder.put("a.obj", text)).unwrap().model;
    let [leaf, masked, only, glass, rest, n] = model.materials.as_slice() else { panic!() };
    let texture = |i: Option<usize>| &model.textures[i.unwrap()];
    assert_eq!([leaf.alpha, masked.alpha, only.alpha], [Alpha::Cutout(0.5); 3]);
    assert_eq!(glass.alpha, Alpha::Blend(0.5));
    assert_eq!(rest.alpha, Alpha::Opaque);
    assert_eq!(texture(masked.diffuse_map).rgba[..4], [0, 0, 0, 0]);
    assert_eq!(texture(masked.diffuse_map).rgba[28..32], [210, 0, 0, 255]);
    assert_eq!(texture(only.diffuse_map).rgba[28..32], [255; 4]);
    assert_eq!(rest.diffuse_map, rest.specular_map);
    assert_eq!(rest.emissive_map, rest.diffuse_map);
    let normals = texture(rest.normal_map);
    assert!(!normals.srgb && normals.rgba[4 * 3] < 128 && normals.rgba[4 * 3 + 2] > 128);
    assert_eq!(texture(n.normal_map).rgba[..4], [128, 128, 255, 255]);
    // Texture coordinates are generated, since there are maps.
    assert!(model.vertices.iter().any(|v| v.uv == Vec2::ONE));
}

#[test]
fn bad_pictures_are_named() {
    let folder = Folder::new();
    folder.put("a.mtl", "newmtl m\nmap_Kd p.png");
    let scene = folder.put("a.obj", square("mtllib a.mtl\nusemtl m\nf 1 2 3"));
    let mut png =
        fs::read(folder.picture("p.png", 64, |x, y| [x as u8, y as u8, (x * y) as u8, 255])).unwrap();
    png.truncate(png.len() / 2);
    folder.put("p.png", &png);
    refused_file(&scene, &["p.png", "replace"]);
    // A header that claims 30000 x 30000 pixels.
    let mut huge = b"BM".to_vec();
    huge.extend([0, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40, 0, 0, 0]);
    huge.extend(30_000i32.to_le_bytes());
    huge.extend(30_000i32.to_le_bytes());
    huge.extend([1, 0, 24, 0]);
    huge.extend([0; 24]);
    folder.put("p.png", &huge);
    refused_file(&scene, &["p.png", "scale it down"]);
}

#[test]
fn viewpoints_are_read_from_camera_json() {
    let folder = Folder::new();
    let scene = folder.put("a.obj", square("f 1 2 3"));
    assert_eq!(load(&scene).unwrap().viewpoints.len(), 8);
    folder.put("camera.json", r#"[{"position": [1, 2, 3], "target": [0, 0, 0]}]"#);
    assert_eq!(
        load(&scene).unwrap().viewpoints,
        [Viewpoint { position: Vec3::new(1., 2., 3.), target: Vec3::ZERO }]
    );
    for (text, word) in [
        ("[]", "no viewpoint"),
        (r#"[{"position": [1, 2], "target": [0, 0, 0]}]"#, "line 1"),
        (r#"[{"position": [1, 2, 3], "target": [1, 2, 3]}]"#, "looks at"),
        (r#"[{"position": [1e39, 2, 3], "target": [1, 2, 3]}]"#, ""),
    ] {
        folder.put("a.camera.json", text);
        refused_file(&scene, &["a.camera.json", word, "remove it"]);
    }
}

#[test]
fn light_style_and_scale_are_read_from_scene_json() {
    let folder = Folder::new();
    let scene = folder.put("a.obj", square("f 1 2 3"));
    folder.put("scene.json", r#"{"style": "anime", "scale": 2, "lights": []}"#);
    let s = load(&scene).unwrap();
    assert_eq!(
        (s.style, s.model.bounds().max, s.lights.len()),
        (ShadingStyle::Anime, Vec3::new(2., 2., 0.), 0)
    );
    for (text, word) in [
        (r#"{"colour": 1}"#, "unknown field"),
        (r#"{"scale": 0}"#, "greater than 0"),
        (r#"{"lights": [{"position": [0,0,0], "color": [1,1,1], "range": 0}]}"#, "range"),
    ] {
        folder.put("scene.json", text);
        refused_file(&scene, &["scene.json", word]);
    }
}

/// Returns a box, to be seen from inside or outside, given by its corners.
fn box_obj(min: [f32; 3], max: [f32; 3]) -> String {
    let mut text = String::new();
    for i in 0..8 {
        let at = |k: usize| if i >> k & 1 == 0 { min[k] } else { max[k] };
        text += &format!("v {} {} {}\n", at(0), at(1), at(2));
    }
    text + "f -8 -6 -5 -7\nf -4 -3 -1 -2\nf -8 -7 -3 -4\nf -6 -2 -1 -5\nf -8 -4 -2 -6\nf -7 -5 -1 -3\n"
}

#[test]
fn small_things_are_circled_and_stay_in_view() {
    let s = obj_scene(box_obj([-0.1, 0.0, -0.1], [0.1, 0.3, 0.1]));
    assert_eq!(s.viewpoints.len(), 8);
    for v in &s.viewpoints {
        let away = v.position.distance(Vec3::new(0.0, 0.15, 0.0));
        assert!((0.25..1.0).contains(&away));
        assert!(v.pose().forward().dot((Vec3::new(0.0, 0.15, 0.0) - v.position).normalize()) > 0.99);
    }
    assert_eq!((s.sky, s.lights.len()), (Sky::default(), 0));
}

#[test]
fn rooms_are_walked_and_have_even_light() {
    // A room with a table.
    let room = box_obj([-4.0, 0.0, -3.0], [4.0, 3.0, 3.0]) + &box_obj([-1.0, 0.0, -0.5], [1.0, 0.8, 0.5]);
    let s = obj_scene(room);
    assert_eq!(s.viewpoints.len(), 8);
    for v in &s.viewpoints {
        assert!((1.5..2.5).contains(&v.position.y), "{}", v.position);
        assert!(v.position.x.abs() < 3.6 && v.position.z.abs() < 2.6);
    }
    assert!(s.lights.is_empty() && s.sky.sun_color == Vec3::ZERO && s.sky.zenith.min_element() > 0.3);
}

#[test]
fn streets_are_walked_on_the_ground() {
    let mut city = "v -50 0 -50\nv 50 0 -50\nv 50 0 50\nv -50 0 50\nf -1 -2 -3 -4\n".to_owned();
    for (x, z) in (0..16).map(|i| ((i % 4) as f32, (i / 4) as f32)) {
        city += &box_obj([x * 24.0 - 44.0, 0.0, z * 24.0 - 44.0], [x * 24.0 - 28.0, 20.0, z * 24.0 - 28.0]);
    }
    let s = obj_scene(city);
    assert_eq!(s.viewpoints.len(), 8);
    let inside = |p: f32| (p + 44.0).rem_euclid(24.0) < 16.0 && p.abs() < 44.0;
    for v in &s.viewpoints {
        assert!((v.position.y - 1.6).abs() < 0.1, "{}", v.position);
        assert!(!(inside(v.position.x) && inside(v.position.z)), "{} is in a house", v.position);
    }
    assert_eq!(s.sky, Sky::default());
}

/// Large enough to walk through, but with no place to walk: two cubes, a figure of blocks, and a wall with a ledge on
/// top.
#[test]
fn large_things_without_a_floor_are_circled() {
    let cubes = box_obj([-2.5, -1.0, -1.0], [-0.5, 1.0, 1.0]) + &box_obj([0.5, -1.0, -1.0], [2.5, 1.0, 1.0]);
    let figure = box_obj([-2.0, 0.0, -1.0], [-0.5, 6.0, 1.0])
        + &box_obj([0.5, 0.0, -1.0], [2.0, 6.0, 1.0])
        + &box_obj([-3.0, 6.0, -1.0], [3.0, 14.0, 1.0])
        + &box_obj([-1.5, 14.0, -1.0], [1.5, 18.0, 1.0]);
    let wall = box_obj([-10.0, 0.0, -0.5], [10.0, 8.0, 0.5]);
    // A closed block, whose inner walls cannot be seen from inside.
    let block = box_obj([-4.0, 0.0, -4.0], [4.0, 4.0, 4.0]);
    for (name, text) in [("cubes", cubes), ("figure", figure), ("wall", wall), ("block", block)] {
        let mut model = obj(text);
        model.materials.iter_mut().for_each(|m| m.double_sided = false);
        let (viewpoints, _) = defaults::viewpoints(&model, &rays::Rays::new(&model));
        let bounds = model.bounds();
        assert_eq!(viewpoints.len(), 8);
        for v in &viewpoints {
            assert_eq!(v.target, bounds.center(), "{name}");
            assert!(bounds.distance(v.position) > 0.0, "{name}: {}", v.position);
        }
    }
}

/// Solid bodies whose faces are drawn from both sides, as those of OBJ files are.
#[test]
fn no_viewpoint_is_inside_a_body() {
    let block = box_obj([-4.0, 0.0, -4.0], [4.0, 4.0, 4.0]);
    let blocks: String = (0..9)
        .map(|i| [(i % 3) as f32 * 10.0, (i / 3) as f32 * 10.0])
        .map(|[x, z]| box_obj([x, 0.0, z], [x + 5.0, 5.0, z + 5.0]))
        .collect();
    for text in [block, blocks] {
        let s = obj_scene(text);
        let rays = rays::Rays::new(&s.model);
        for v in &s.viewpoints {
            assert!(rays.cast(v.position, v.pose().forward(), 1e3).is_none_or(|h| !h.is_behind), "{v:?}");
        }
    }
}

/// A plane that faces down, drawn from its front only.
#[test]
fn what_faces_down_is_seen_from_below() {
    let mut model = obj("v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3");
    model.materials[0].double_sided = false;
    let (viewpoints, _) = defaults::viewpoints(&model, &rays::Rays::new(&model));
    assert!(viewpoints.iter().all(|v| v.position.y < 0.0), "{viewpoints:?}");
}

/// Ten metres, five thousand kilometres away, with steps of a centimetre.
#[test]
fn a_far_model_is_brought_to_the_origin() {
    let folder = Folder::new();
    let far = "v 500000.01 5219000.02 410\nv 500010.01 5219000.02 410\nv 500010.01 5219005.03 410.5\nf 1 2 3";
    let s = load(&folder.put("a.obj", far)).unwrap();
    let bounds = s.model.bounds();
    assert!(bounds.center().length() < 10.0, "{bounds:?}");
    assert!((bounds.max - bounds.min - Vec3::new(10.0, 5.01, 0.5)).abs().max_element() < 1e-4, "{bounds:?}");
    // A small unit brings a model nearer without bringing its details nearer.
    folder.put("scene.json", r#"{"scale": 0.01}"#);
    let scaled = load(&folder.0.path().join("a.obj")).unwrap().model.bounds();
    assert!((scaled.max - scaled.min - Vec3::new(0.1, 0.0501, 0.005)).abs().max_element() < 1e-6);
    fs::remove_file(folder.0.path().join("scene.json")).unwrap();
    // What is large stays where it is, even if it begins far away.
    let large = "v 200000 0 0\nv -200000 0 0\nv 0 0 -50\nf 1 2 3";
    let bounds = load(&folder.put("b.obj", large)).unwrap().model.bounds();
    assert_eq!((bounds.min, bounds.max), (Vec3::new(-2e5, 0.0, -50.0), Vec3::new(2e5, 0.0, 0.0)));
}

/// A terrace with a small house has ground to walk on, but no viewpoint may see only sky.
#[test]
fn a_walk_shows_the_model() {
    let terrace = "v -15 0 -15\nv 15 0 -15\nv 15 0 15\nv -15 0 15\nf -1 -2 -3 -4\n".to_owned()
        + &box_obj([-3.0, 0.0, -3.0], [3.0, 4.0, 3.0]);
    let s = obj_scene(terrace);
    let rays = rays::Rays::new(&s.model);
    for v in &s.viewpoints {
        assert!((v.position.y - 1.6).abs() < 0.1, "{}", v.position);
        let ahead = v.pose().forward();
        let side = ahead.cross(Vec3::Y) * 0.3;
        let shown = |d: &Vec3| rays.cast(v.position, *d, 1e3).is_some_and(|h| h.distance < 20.0);
        let rays = [-0.5, -0.35, -0.2f32].map(|y| [-1.0, 0.0, 1.0].map(|x| ahead + side * x + Vec3::Y * y));
        let count = rays.iter().flatten().filter(|d| shown(d)).count();
        assert!(count >= 5, "{v:?} sees {count} of 9");
    }
}

/// A scene with everything that a file must preserve: a glTF file's, and more materials.
fn rich_scene(folder: &Folder) -> Scene {
    let (text, _) = gltf_text(folder, true);
    let mut scene = load(&folder.put("rich.gltf", text)).unwrap();
    let texture = |name: &str, srgb, nearest, f: fn(u32) -> [u8; 4]| TextureImage {
        name: name.into(),
        size: [8, 4],
        rgba: (0..32).flat_map(f).collect(),
        srgb,
        nearest,
    };
    let model = &mut scene.model;
    model.textures.extend([
        texture("bricks", true, false, |i| [i as u8, 40, 90, 255]),
        texture("leaves", true, true, |i| [10, 200, 0, if i % 3 == 0 { 0 } else { 255 }]),
        texture("bumps", false, false, |_| [140, 128, 250, 255]),
        texture("screen", true, false, |i| [0, i as u8 * 8, 255, 255]),
    ]);
    let [bricks, leaves, bumps, screen] = [1, 2, 3, 4].map(Some);
    let material = |name: &str| Material { name: name.into(), ..Material::default() };
    let wall = Material { diffuse_map: bricks, specular_map: bricks, normal_map: bumps, ..material("wall") };
    let leaf = Material { alpha: Alpha::Cutout(0.3), diffuse_map: leaves, ..material("leaf") };
    model.materials.extend([
        Material { diffuse: Vec3::new(0.1, 0.25, 0.7), roughness: 0.123, ..wall },
        Material { diffuse: Vec3::ONE, double_sided: true, ..leaf },
        Material { alpha: Alpha::Blend(0.4), ..material("glass") },
        Material { emissive: Vec3::new(2.0, 1.5, 0.1), emissive_map: screen, ..material("tv") },
        Material { diffuse_map: leaves, ..material("opaque_leaf") },
    ]);
    for (i, part) in ["wall", "tree", "window", "screen", "sign"].into_iter().enumerate() {
        let start = model.indices.len();
        model.indices.extend([0, 1, 2]);
        model.parts.push(Part { name: part.into(), material: i + 1, indices: start..start + 3 });
    }
    scene.style = ShadingStyle::LowPoly;
    scene.sky.sun_color = Vec3::new(1.0, 0.3, 0.1);
    scene
}

#[test]
fn an_exported_scene_loads_as_it_was() {
    let folder = Folder::new();
    let scene = rich_scene(&folder);
    let target = folder.0.path().join("new/folder");
    let path = export(&scene, &target, "MIT OR Apache-2.0").unwrap();
    let again = load(&path).unwrap();
    assert_eq!((again.name, again.style, again.viewpoints), (scene.name, scene.style, scene.viewpoints));
    assert_eq!((again.sky, again.lights), (scene.sky, scene.lights));
    assert_eq!(again.model.parts, scene.model.parts);
    for (a, b) in again.model.indices.iter().zip(&scene.model.indices) {
        let (a, b) = (again.model.vertices[*a as usize], scene.model.vertices[*b as usize]);
        assert_eq!((a.position, a.uv), (b.position, b.uv));
        assert!(a.normal.distance(b.normal) < 1e-6);
    }
    assert_eq!(again.model.indices.len(), scene.model.indices.len());
    let texture = |m: &Model, i: Option<usize>| i.map(|i| m.textures[i].clone());
    for (a, b) in again.model.materials.iter().zip(&scene.model.materials) {
        assert_eq!(texture(&again.model, a.diffuse_map), texture(&scene.model, b.diffuse_map));
        assert_eq!(texture(&again.model, a.specular_map), texture(&scene.model, b.specular_map));
        assert_eq!(texture(&again.model, a.emissive_map), texture(&scene.model, b.emissive_map));
        assert_eq!(texture(&again.model, a.normal_map), texture(&scene.model, b.normal_map));
        let without = |m: &Material| Material {
            diffuse_map: None,
            specular_map: None,
            emissive_map: None,
            normal_map: None,
            ..m.clone()
        };
        assert_eq!(without(a), without(b));
    }
    let mut files: Vec<_> =
        fs::read_dir(&target).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    files.sort();
    assert_eq!(
        files,
        ["LICENSE.txt", "rich.camera.json", "rich.mtl", "rich.obj", "rich.scene.json", "textures"]
    );
    assert_eq!(fs::read_to_string(target.join("LICENSE.txt")).unwrap(), "MIT OR Apache-2.0\n");
}

/// Returns glTF with a triangle with normals and texture coordinates, an indexed triangle, and a picture.
fn gltf_text(folder: &Folder, embedded: bool) -> (String, Vec<u8>) {
    let floats = |v: &[f32]| v.iter().flat_map(|f| f.to_le_bytes()).collect::<Vec<u8>>();
    let mut data = floats(&[0., 0., 0., 1., 0., 0., 0., 1., 0.]);
    data.extend(floats(&[0., 0., 1., 0., 0., 1., 0., 0., 1.]));
    data.extend(floats(&[0., 0., 1., 0., 0., 1.]));
    data.extend([0, 0, 1, 0, 2, 0, 0, 0]);
    let picture = fs::read(folder.picture("pic.png", 4, |_, _| [90, 80, 70, 255])).unwrap();
    let uri = |bytes: &[u8], kind: &str| {
        format!("data:{kind};base64,{}", base64::engine::general_purpose::STANDARD.encode(bytes))
    };
    let (buffer, image) = if embedded {
        (uri(&data, "application/octet-stream"), uri(&picture, "image/png"))
    } else {
        folder.put("my data.bin", &data);
        ("my%20data.bin".into(), "pic.png".into())
    };
    let text = format!(
        r#"{{
        "asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0, 2, 3]}}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {{"KHR_lights_punctual": {{"lights": [{{"type": "point", "intensity": 40, "color": [1, 0.5, 0]}}]}}}},
        "nodes": [{{"children": [1], "translation": [10, 0, 0]}}, {{"mesh": 0, "name": "tri", "scale": [-2, 2, 2]}},
                  {{"camera": 0, "translation": [0, 1, 5]}}, {{"translation": [0, 3, 0], "extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}}],
        "cameras": [{{"type": "perspective", "perspective": {{"yfov": 1, "znear": 0.1}}}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}, "indices": 3, "material": 0}}]}}],
        "materials": [{{"name": "m", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.25, "emissiveFactor": [1, 0, 0],
            "pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0}}, "metallicFactor": 0, "roughnessFactor": 0.5}}}}],
        "textures": [{{"source": 0}}], "images": [{{"uri": "{image}"}}],
        "buffers": [{{"byteLength": {}, "uri": "{buffer}"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": 36}},
            {{"buffer": 0, "byteOffset": 72, "byteLength": 24}}, {{"buffer": 0, "byteOffset": 96, "byteLength": 6}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0,0,0], "max": [1,1,0]}},
            {{"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"}},
            {{"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC2"}},
            {{"bufferView": 3, "componentType": 5123, "count": 3, "type": "SCALAR"}}]
    }}"#,
        data.len()
    );
    (text, data)
}

fn check_gltf(scene: &Scene) {
    let m = &scene.model;
    assert_eq!(m.triangle_count(), 1);
    // The mesh is mirrored, so its triangles are reversed.
    assert!(area(m).z > 0.0);
    let corner = m.vertices.iter().find(|v| v.position == Vec3::new(8., 0., 0.)).unwrap();
    assert_eq!((corner.normal, corner.uv), (Vec3::Z, Vec2::ONE));
    let material = &m.materials[0];
    assert_eq!((material.alpha, material.double_sided, material.roughness), (Alpha::Cutout(0.25), true, 0.5));
    assert!(material.diffuse.distance(Vec3::ONE) < 1e-6 && material.emissive.distance(Vec3::X) < 1e-6);
    assert_eq!(m.textures[material.diffuse_map.unwrap()].rgba[..4], [90, 80, 70, 255]);
    assert_eq!(
        scene.viewpoints,
        [Viewpoint { position: Vec3::new(0., 1., 5.), target: Vec3::new(0., 1., 1.) }]
    );
    assert_eq!((scene.lights[0].position, scene.lights[0].color.x), (Vec3::new(0., 3., 0.), 8.0));
}

#[test]
fn gltf_is_read_in_every_packing() {
    let folder = Folder::new();
    for embedded in [true, false] {
        let (text, _) = gltf_text(&folder, embedded);
        check_gltf(&load(&folder.put("a.gltf", text)).unwrap());
    }
    let (text, data) = gltf_text(&folder, true);
    check_gltf(&load(&folder.put("a.glb", glb(&text, &data))).unwrap());
}

fn glb(text: &str, data: &[u8]) -> Vec<u8> {
    // Cuts out the embedded buffer: without a URI it is the binary chunk.
    let start = text.find(r#", "uri": "data:application"#).unwrap();
    let end = start + text[start..].find('}').unwrap();
    let mut json = format!("{}{}", &text[..start], &text[end..]).into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut out = b"glTF".to_vec();
    out.extend(2u32.to_le_bytes());
    out.extend((28 + json.len() as u32 + data.len() as u32).to_le_bytes());
    out.extend((json.len() as u32).to_le_bytes());
    out.extend(b"JSON");
    out.extend(json);
    out.extend((data.len() as u32).to_le_bytes());
    out.extend(b"BIN\0");
    out.extend(data);
    out
}

#[test]
fn damaged_gltf_is_refused_in_a_sentence() {
    let folder = Folder::new();
    let (good, _) = gltf_text(&folder, true);
    let changed = |from: &str, to: &str, word: &str| {
        assert!(good.contains(from), "{from}");
        refused_file(&folder.put("a.gltf", good.replacen(from, to, 1)), &["a.gltf", word]);
    };
    changed("\"count\": 3", "\"count\": 18446744073709551615", "accessor 0");
    changed("data:application/octet-stream;base64,", "gone.bin?", "gone.bin");
    changed("\"scene\": 0", "\"extensionsRequired\": [\"KHR_draco_mesh_compression\"]", "KHR_draco");
    let without_bounds = good.replacen(r#", "min": [0,0,0], "max": [1,1,0]"#, "", 1);
    assert!(without_bounds.len() < good.len() && load(&folder.put("a.gltf", without_bounds)).is_ok());
    // A cycle of nodes ends.
    let circle = good.replacen("\"mesh\": 0,", "\"mesh\": 0, \"children\": [0],", 1);
    assert!(load(&folder.put("a.gltf", circle)).is_ok());
}

/// Unusual files that the specification allows.
#[test]
fn unusual_but_valid_gltf_is_read() {
    let folder = Folder::new();
    let (good, _) = gltf_text(&folder, true);
    for (from, to) in [
        ("\"POSITION\": 0", "\"POSITION\": 0, \"_FEATURE_ID_0\": 3"),
        ("\"name\": \"tri\"", "\"name\": \"tri\", \"extras\": 5"),
        ("\"doubleSided\": true", "\"doubleSided\": true, \"extras\": [\"a\", null]"),
        ("{\"mesh\": 0", "{\"extras\": \"text\", \"mesh\": 0"),
    ] {
        assert!(good.contains(from), "{from}");
        let text = good.replacen(from, to, 1);
        check_gltf(&load(&folder.put("a.gltf", text)).unwrap());
    }
}

#[test]
fn sparse_accessors_replace_their_values() {
    let folder = Folder::new();
    let (good, _) = gltf_text(&folder, true);
    // The corner at (1, 0, 0) moves to (0, 0, 1), the value that the normals have, by the index in bytes 100 and 101.
    let sparse = |base: &str, offset: u32| {
        let sparse = format!(
            r#"{{{base}"sparse": {{"count": 1, "indices": {{"bufferView": 3, "byteOffset": {offset}, "componentType": 5123}}, "values": {{"bufferView": 1}}}}, "#
        );
        good.replacen("{\"bufferView\": 0, ", &sparse, 1)
    };
    let corners = |text: String| -> Vec<Vec3> {
        let model = load(&folder.put("a.gltf", text)).unwrap().model;
        // In the file's frame: the node scales by two, mirrors, and moves 10 m to the side.
        model.vertices.iter().map(|v| (v.position - Vec3::X * 10.0) / Vec3::new(-2., 2., 2.)).collect()
    };
    let mut moved = corners(sparse("\"bufferView\": 0, ", 2));
    moved.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).unwrap());
    assert_eq!(moved, [Vec3::ZERO, Vec3::Z, Vec3::Y]);
    // All other positions are zero, so nothing is left to draw.
    refused_file(&folder.put("a.gltf", sparse("", 2)), &["no triangle"]);
    let beyond = sparse("\"bufferView\": 0, ", 2).replacen("\"byteOffset\": 2,", "\"byteOffset\": 6,", 1);
    refused_file(&folder.put("a.gltf", beyond), &["accessor 0 reaches beyond"]);
}

#[test]
fn samplers_without_magnification_filter_are_kept() {
    let folder = Folder::new();
    let (good, _) = gltf_text(&folder, true);
    let text = good.replacen(
        "\"textures\": [{\"source\": 0}]",
        "\"samplers\": [{\"magFilter\": 9728, \"wrapS\": 33071}], \"textures\": [{\"source\": 0, \"sampler\": 0}]",
        1,
    );
    assert!(text != good && load(&folder.put("a.gltf", text)).unwrap().model.textures[0].nearest);
    assert!(!load(&folder.put("a.gltf", good)).unwrap().model.textures[0].nearest);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_statements_are_no_model_or_one(words in proptest::collection::vec(
        prop_oneof![
            4 => "(v|vt|vn|f|f|f|o|g|s|usemtl|mtllib|l)",
            8 => "-?[0-9]{1,2}(/-?[0-9]{0,2}){0,2}",
            4 => "-?[0-9]\\.[0-9]",
            1 => "(nan|inf|-1e38|#|/|//|off|a\\.mtl|\\\\)",
            6 => Just("\n".to_owned()),
        ], 0..250)) {
        let folder = Folder::new();
        let start = time::Instant::now();
        // A beginning that makes faces likely to be valid.
        let text = format!("{SQUARE}vt 0 0\nvn 0 1 0\n{}\nf 1 2 3 4", words.join(" "));
        let _ = load(&folder.put("a.obj", text));
        prop_assert!(start.elapsed().as_secs() < 20);
    }

    #[test]
    fn damaged_gltf_never_panics(cuts in proptest::collection::vec((0usize..4000, any::<u8>(), any::<bool>()), 1..4), binary in any::<bool>()) {
        let folder = Folder::new();
        let (text, data) = gltf_text(&folder, true);
        let mut bytes = if binary { glb(&text, &data) } else { text.into_bytes() };
        for (at, byte, digit) in cuts {
            let at = at % bytes.len();
            bytes[at] = if digit { b'0' + byte % 10 } else { byte };
        }
        let _ = load(&folder.put(if binary { "a.glb" } else { "a.gltf" }, &bytes));
    }
}
