//! glTF files written by the tests, loaded with [`load`]: what the format allows, drawn as it says.

use std::fs;
use std::path::PathBuf;

use base64::Engine as _;
use glam::{Vec2, Vec3};
use image::{Rgba, RgbaImage};
use serde_json::{Value, json};
use tempfile::TempDir;

use super::*;

/// A file with one triangle in the XY plane, of size 1 at the origin, with texture coordinates equal to its positions.
struct File {
    folder: TempDir,
    root: Value,
    data: Vec<u8>,
}

impl File {
    fn new() -> File {
        let root = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
            "materials": [{}], "bufferViews": [], "accessors": [],
        });
        let mut file = File { folder: tempfile::tempdir().unwrap(), root, data: Vec::new() };
        file.accessor("VEC3", &[0., 0., 0., 1., 0., 0., 0., 1., 0.]);
        file.accessor("VEC2", &[0., 0., 1., 0., 0., 1.]);
        file
    }

    /// Adds an accessor and returns its number.
    fn accessor(&mut self, kind: &str, values: &[f32]) -> usize {
        let width = match kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            _ => 4,
        };
        let accessors = self.root["accessors"].as_array_mut().unwrap();
        let number = accessors.len();
        accessors.push(json!({
            "bufferView": number, "componentType": 5126, "count": values.len() / width, "type": kind,
            "min": vec![0.0; width], "max": vec![1.0; width]
        }));
        let view = json!({"buffer": 0, "byteOffset": self.data.len(), "byteLength": values.len() * 4});
        self.root["bufferViews"].as_array_mut().unwrap().push(view);
        self.data.extend(values.iter().flat_map(|x| x.to_le_bytes()));
        number
    }

    /// Adds an animation that moves node 0 along X, to `to` within a second, and returns its number.
    fn animation(&mut self, name: &str, to: f32) {
        let input = self.accessor("SCALAR", &[0.0, 1.0]);
        let output = self.accessor("VEC3", &[0., 0., 0., to, 0., 0.]);
        let animation = json!({
            "name": name, "samplers": [{"input": input, "output": output}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]
        });
        match self.root["animations"].as_array_mut() {
            Some(animations) => animations.push(animation),
            None => self.root["animations"] = json!([animation]),
        }
    }

    /// Adds a picture of 8 x 8 pixels as texture 0.
    fn picture(&mut self, f: impl Fn(u32, u32) -> [u8; 4]) {
        RgbaImage::from_fn(8, 8, |x, y| Rgba(f(x, y))).save(self.folder.path().join("p.png")).unwrap();
        self.root["images"] = json!([{"uri": "p.png"}]);
        self.root["textures"] = json!([{"source": 0}]);
    }

    fn path(&self) -> PathBuf {
        let uri = base64::engine::general_purpose::STANDARD.encode(&self.data);
        let mut root = self.root.clone();
        root["buffers"] = json!([{
            "byteLength": self.data.len(), "uri": format!("data:application/octet-stream;base64,{uri}")
        }]);
        let path = self.folder.path().join("a.gltf");
        fs::write(&path, root.to_string()).unwrap();
        path
    }

    fn load(&self) -> Scene {
        load(&self.path()).unwrap()
    }

    fn refusal(&self) -> String {
        load(&self.path()).unwrap_err().to_string()
    }
}

#[test]
fn instances_stand_where_they_are_put() {
    let mut file = File::new();
    let places = file.accessor("VEC3", &[0., 0., 0., 10., 0., 0., 0., 20., 0.]);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turns = file.accessor("VEC4", &[0., 0., 0., 1., 0., 0., half, half, 0., 0., 0., 1.]);
    let sizes = file.accessor("VEC3", &[1., 1., 1., 2., 2., 2., 1., 1., 1.]);
    let attributes = json!({"TRANSLATION": places, "ROTATION": turns, "SCALE": sizes});
    file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = json!({"attributes": attributes});
    file.root["nodes"][0]["translation"] = json!([0, 0, -5]);
    file.root["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
    file.root["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    let corners = |scene: &Scene| {
        let model = &scene.model;
        let mut all: Vec<Vec3> =
            model.indices.iter().map(|&i| model.vertices[i as usize].position.round()).collect();
        all.sort_by_key(|p| (p.x as i32, p.y as i32));
        all.into_iter().map(|p| [p.x, p.y, p.z]).collect::<Vec<_>>()
    };
    let still = file.load();
    assert_eq!(
        corners(&still),
        [[0., 0.], [0., 1.], [0., 20.], [0., 21.], [1., 0.], [1., 20.], [8., 0.], [10., 0.], [10., 2.]]
            .map(|[x, y]| [x, y, -5.0])
    );
    assert!(still.model.vertices.iter().all(|v| (v.normal - Vec3::Z).length() < 1e-6));
    // A node that moves carries its instances.
    file.animation("walk", 100.0);
    let moving = file.load();
    assert_eq!(moving.motion.meshes.len(), 3);
    assert_eq!(corners(&moving.at(0.5))[8], [60.0, 2.0, 0.0]);
    file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = json!(0);
    file.root["accessors"][0]["count"] = json!(2);
    assert!(file.refusal().contains("instances of node 0 have attributes of different length"));
}

#[test]
fn an_unlit_material_is_its_base_colour() {
    let mut file = File::new();
    file.picture(|_, _| [10, 20, 30, 255]);
    file.root["materials"] = json!([{
        "extensions": {"KHR_materials_unlit": {}}, "emissiveFactor": [1, 1, 1],
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1], "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}}
    }]);
    let scene = file.load();
    let material = &scene.model.materials[0];
    assert!(material.unlit && material.diffuse.distance(Vec3::X) < 1e-6);
    assert_eq!((material.specular, material.emissive), (Vec3::ZERO, Vec3::ZERO));
    assert_eq!(scene.model.textures[material.diffuse_map.unwrap()].rgba[..4], [10, 20, 30, 255]);
    assert_eq!(scene.model.textures.len(), 1);
    assert!(scene.lights.is_empty(), "what is unlit lights nothing");
}

#[test]
fn what_the_format_lets_out_may_be_left_out() {
    let mut file = File::new();
    file.animation("walk", 1.0);
    let other = json!({"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/x"}}}});
    file.root["animations"][0]["channels"].as_array_mut().unwrap().insert(0, other);
    file.root["extensionsUsed"] = json!(["KHR_animation_pointer"]);
    assert_eq!(file.load().motion.meshes.len(), 1);
    let mut empty = File::new();
    empty.root["scenes"] = json!([{"name": "nothing"}]);
    assert!(empty.refusal().contains("no triangle"));
    empty.root["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    assert!(empty.refusal().contains("compressed by KHR_draco_mesh_compression"));
    for root in [json!([]), json!({"scenes": 3, "animations": [1, {"channels": [2]}]}), json!({"meshes": {}})]
    {
        let file = File { root, ..File::new() };
        fs::write(file.folder.path().join("b.gltf"), file.root.to_string()).unwrap();
        let message = load(&file.folder.path().join("b.gltf")).unwrap_err().to_string();
        assert!(message.contains("not valid glTF 2.0"), "{message}");
    }
}

#[test]
fn alpha_is_used_as_the_file_says() {
    let ramp: fn(u32) -> u8 = |x| if x < 5 { x as u8 } else { 255 };
    let steps: fn(u32) -> u8 = |x| if x < 5 { 0 } else { 255 };
    let full: fn(u32) -> u8 = |_| 255;
    let alpha = |mode: &str, opacity: f32, map: Option<fn(u32) -> u8>| {
        let mut file = File::new();
        let material = json!({
            "alphaMode": mode, "alphaCutoff": 0.25, "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, opacity]}
        });
        file.root["materials"] = json!([material]);
        if let Some(map) = map {
            file.picture(|x, _| [255, 255, 255, map(x)]);
            file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 0});
        }
        load(&file.path()).map(|scene| scene.model.materials[0].alpha).ok()
    };
    assert_eq!(alpha("BLEND", 1.0, Some(ramp)), Some(Alpha::Blend(1.0)));
    assert_eq!(alpha("BLEND", 0.5, Some(full)), Some(Alpha::Blend(0.5)));
    assert_eq!(alpha("BLEND", 0.5, None), Some(Alpha::Blend(0.5)));
    // These look the same without blending.
    assert_eq!(alpha("BLEND", 1.0, Some(full)), Some(Alpha::Opaque));
    assert_eq!(alpha("BLEND", 1.0, Some(steps)), Some(Alpha::Cutout(0.5)));
    assert_eq!(alpha("BLEND", 1.0, None), Some(Alpha::Opaque));
    assert_eq!(alpha("OPAQUE", 0.1, Some(ramp)), Some(Alpha::Opaque));
    // The factor counts before the cut-off.
    assert_eq!(alpha("MASK", 1.0, Some(ramp)), Some(Alpha::Cutout(0.25)));
    assert_eq!(alpha("MASK", 0.5, Some(ramp)), Some(Alpha::Cutout(0.5)));
    assert_eq!(alpha("MASK", 0.3, None), Some(Alpha::Opaque));
    assert_eq!(alpha("MASK", 0.2, Some(full)), None, "nothing is left");
    assert_eq!(alpha("MASK", 0.2, None), None, "nothing is left");
}

#[test]
fn the_only_map_has_its_own_coordinates() {
    let mut file = File::new();
    file.picture(|_, _| [255; 4]);
    let second = file.accessor("VEC2", &[0.5, 0.5, 0.5, 0.5, 0.5, 0.5]);
    file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(second);
    let transform = json!({"KHR_texture_transform": {"scale": [2, 2], "offset": [0.25, 0]}});
    let mut maximum = |material: Value| {
        file.root["materials"] = json!([material]);
        file.load().model.vertices.iter().map(|v| v.uv.x).fold(0.0, f32::max)
    };
    let of_first = json!({"index": 0, "extensions": transform});
    assert_eq!(maximum(json!({"emissiveTexture": of_first})), 2.25);
    assert_eq!(maximum(json!({"normalTexture": of_first})), 2.25);
    let of_second = json!({"index": 0, "texCoord": 1});
    assert_eq!(maximum(json!({"emissiveTexture": of_second})), 0.5);
    // Of two, the base colour's are used.
    let colour = json!({"baseColorTexture": {"index": 0}});
    assert_eq!(maximum(json!({"emissiveTexture": of_second, "pbrMetallicRoughness": colour})), 1.0);
}

#[test]
fn an_animation_is_chosen_by_name_or_number() {
    let mut file = File::new();
    file.animation("walk", 1.0);
    file.animation("run", 10.0);
    let path = file.path();
    let reach =
        |animation: Option<&str>| load_animated(&path, animation).unwrap().at(0.999).model.bounds().max.x;
    assert_eq!([None, Some("walk"), Some("run"), Some("1")].map(|a| reach(a).round()), [2., 2., 11., 11.]);
    let message = load_animated(&path, Some("fly")).unwrap_err().to_string();
    assert!(message.contains("has no animation fly: choose one of walk, run"), "{message}");
    let none = load_animated(&File::new().path(), Some("0")).unwrap_err().to_string();
    assert!(none.contains("it has none"), "{none}");
}

/// Nodes in the frame of the Earth, with details of millimetres in their own.
#[test]
fn a_far_node_is_brought_to_the_origin_with_its_details() {
    let mut file = File::new();
    file.root["nodes"][0] =
        json!({"mesh": 0, "translation": [5_219_000.5, 0.25, 3_000_000], "scale": [0.01, 0.01, 0.01]});
    let scene = file.load();
    let bounds = scene.model.bounds();
    assert!((bounds.max - bounds.min - Vec3::new(0.01, 0.01, 0.0)).abs().max_element() < 1e-6, "{bounds:?}");
    assert!(bounds.center().length() < 1.0);
    assert!(scene.viewpoints.iter().all(|v| v.position.length() < 2.0));
    let uv: Vec<Vec2> = scene.model.vertices.iter().map(|v| v.uv).collect();
    assert_eq!(uv.len(), 3);
}

#[test]
fn vertex_colours_multiply_the_material() {
    let mut file = File::new();
    let red = file.accessor("VEC4", &[1.0, 0.0, 0.0, 1.0].repeat(3));
    let white = file.accessor("VEC4", &[1.0; 12]);
    file.root["materials"] =
        json!([{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 1, 1], "metallicFactor": 0}}]);
    // The second mesh has no colours.
    file.root["nodes"] = json!([{"mesh": 0, "children": [1]}, {"mesh": 1}]);
    let mesh = json!({"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]});
    file.root["meshes"].as_array_mut().unwrap().push(mesh);
    file.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(red);
    let model = file.load().model;
    let m = &model.materials[0];
    assert!((m.diffuse - Vec3::new(0.7354, 1.0, 1.0)).abs().max_element() < 1e-3, "{}", m.diffuse);
    let texture = &model.textures[m.diffuse_map.unwrap()];
    let [w, h] = texture.size.map(|s| s as f32);
    let texel = |uv: Vec2| (((1.0 - uv.y) * h) as usize * w as usize + (uv.x * w) as usize) * 4;
    let shown =
        model.vertices.iter().map(|v| <[u8; 4]>::try_from(&texture.rgba[texel(v.uv)..][..4]).unwrap());
    assert_eq!(Vec::from_iter(std::collections::BTreeSet::from_iter(shown)), [[255, 0, 0, 255], [255; 4]]);
    // White vertex colours are ignored. If there is a texture, it is drawn instead.
    file.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(white);
    let model = file.load().model;
    assert_eq!((model.textures.len(), model.materials[0].diffuse_map), (0, None));
    file.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(red);
    file.picture(|_, _| [90, 80, 70, 255]);
    file.root["materials"] = json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]);
    let model = file.load().model;
    assert_eq!((model.textures.len(), model.textures[0].size), (1, [8, 8]));
}

#[test]
fn specular_glossiness_is_a_material() {
    let material = |inside: Value| {
        let mut file = File::new();
        file.picture(|_, _| [188, 188, 188, 255]);
        let gloss = RgbaImage::from_pixel(4, 4, Rgba([255, 188, 0, 51]));
        gloss.save(file.folder.path().join("gloss.png")).unwrap();
        file.root["images"] = json!([{"uri": "p.png"}, {"uri": "gloss.png"}]);
        file.root["textures"] = json!([{"source": 0}, {"source": 1}]);
        file.root["extensionsUsed"] = json!(["KHR_materials_pbrSpecularGlossiness"]);
        file.root["materials"] = json!([{"extensions": {"KHR_materials_pbrSpecularGlossiness": inside}}]);
        let model = file.load().model;
        (model.materials[0].clone(), model.textures)
    };
    let srgb = |v: Vec3| Vec3::from(v.to_array().map(textures::to_srgb));
    // A dielectric: nothing is treated as metal.
    let (m, _) = material(
        json!({"diffuseFactor": [1, 0.5, 0, 1], "specularFactor": [0.04, 0.04, 0.04], "glossinessFactor": 0.75}),
    );
    assert!(m.diffuse.distance(srgb(Vec3::new(0.96, 0.48, 0.0))) < 1e-5, "{}", m.diffuse);
    assert!(m.specular.distance(srgb(Vec3::splat(0.04))) < 1e-5 && m.roughness == 0.25);
    // A metal looks the same as in the metallic-roughness model.
    let (m, _) = material(json!({"diffuseFactor": [0, 0, 0, 1], "specularFactor": [1, 0.8, 0.3]}));
    assert!(m.diffuse.distance(srgb(Vec3::new(0.3, 0.24, 0.09))) < 0.03, "{}", m.diffuse);
    assert_eq!((m.specular, m.roughness), (srgb(Vec3::new(1.0, 0.8, 0.3)), 0.0));
    let (m, images) = material(json!({
        "diffuseTexture": {"index": 0}, "specularGlossinessTexture": {"index": 1}, "glossinessFactor": 0.5
    }));
    assert!((m.roughness - 0.9).abs() < 1e-3, "{}", m.roughness);
    let [diffuse, specular] = [m.diffuse_map, m.specular_map].map(|i| &images[i.unwrap()]);
    assert_eq!(specular.rgba[..4], [255, 188, 0, 255]);
    // The specular colour leaves nothing of the diffuse one; a metal keeps a share of its own colour.
    let level = |v: f32| (textures::to_srgb(v) * 255.0).round() as u8;
    let green = level(0.3 * (textures::to_linear(188.0 / 255.0) - 0.04));
    assert_eq!(diffuse.rgba[..4], [level(0.288), green, 0, 255]);
}
