//! Writes scenes to files for other programs: OBJ, MTL and PNG, and separate files for what those cannot express.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::load::{MaterialNotes, SceneNotes};
use super::model::{Alpha, Material};
use super::scene::Scene;
use super::textures::unique;
use yoro_files::{FileError, create_folder, interrupt, write_with};

/// Writes `NAME.obj`, `NAME.mtl`, `textures/*.png`, `NAME.camera.json`, `NAME.scene.json` and `LICENSE.txt` into a
/// folder, which is created if necessary. [`crate::load()`] reads the same scene back. `license` is the text of the
/// licence file.
///
/// Every file is written under a temporary name and renamed, so that it is never incomplete. Returns the path of the
/// OBJ file.
///
/// # Errors
/// [`FileError`] if a file or folder cannot be written, or the user has asked to stop.
pub fn export(scene: &Scene, folder: &Path, license: &str) -> Result<PathBuf, FileError> {
    create_folder(folder)?;
    let mut taken = HashSet::new();
    let name = unique(&mut taken, scene.name.clone());
    let mut taken = HashSet::new();
    let textures: Vec<String> =
        scene.model.textures.iter().map(|t| unique(&mut taken, t.name.clone())).collect();
    for (texture, file) in scene.model.textures.iter().zip(&textures) {
        interrupt::check()?;
        let [w, h] = texture.size;
        let picture = image::RgbaImage::from_raw(w, h, texture.rgba.clone());
        write_with(&folder.join(format!("textures/{file}.png")), |out| {
            let picture = picture.ok_or_else(|| {
                io::Error::new(io::ErrorKind::InvalidData, "the picture's size does not fit its data")
            })?;
            let encoder = image::codecs::png::PngEncoder::new(out);
            let has_alpha = picture.pixels().any(|p| p[3] != 255);
            let encoded = if has_alpha {
                picture.write_with_encoder(encoder)
            } else {
                image::DynamicImage::ImageRgba8(picture).into_rgb8().write_with_encoder(encoder)
            };
            encoded.map_err(io::Error::other)
        })?;
    }
    let mut taken = HashSet::new();
    let materials: Vec<String> =
        scene.model.materials.iter().map(|m| unique(&mut taken, m.name.clone())).collect();
    write_with(&folder.join(format!("{name}.mtl")), |out| {
        for (material, name) in scene.model.materials.iter().zip(&materials) {
            write_material(out, material, name, &textures)?;
        }
        Ok(())
    })?;
    let notes = SceneNotes {
        // Stated, so that large scenes are not taken for ones in centimetres.
        scale: Some(1.0),
        style: scene.style,
        sky: Some(scene.sky),
        lights: Some(scene.lights.clone()),
        materials: scene
            .model
            .materials
            .iter()
            .zip(&materials)
            .map(|(m, name)| (name.clone(), notes(m)))
            .collect::<BTreeMap<_, _>>(),
        nearest: scene
            .model
            .textures
            .iter()
            .zip(&textures)
            .filter(|(t, _)| t.nearest)
            .map(|(_, n)| n.clone())
            .collect(),
    };
    write_with(&folder.join(format!("{name}.scene.json")), |out| {
        Ok(serde_json::to_writer_pretty(out, &notes)?)
    })?;
    write_with(&folder.join(format!("{name}.camera.json")), |out| {
        Ok(serde_json::to_writer_pretty(out, &scene.viewpoints)?)
    })?;
    write_with(&folder.join("LICENSE.txt"), |out| writeln!(out, "{}", license.trim_end()))?;
    interrupt::check()?;
    let obj = folder.join(format!("{name}.obj"));
    write_with(&obj, |out| write_obj(out, scene, &name, &materials))?;
    Ok(obj)
}

fn notes(material: &Material) -> MaterialNotes {
    MaterialNotes { alpha: material.alpha, double_sided: material.double_sided, unlit: material.unlit }
}

fn write_obj(out: &mut impl Write, scene: &Scene, name: &str, materials: &[String]) -> io::Result<()> {
    let model = &scene.model;
    writeln!(out, "# {name}: {} triangles; metres, Y up\nmtllib {name}.mtl", model.triangle_count())?;
    // OBJ indexes positions, texture coordinates and normals separately, and most vertices share two of them.
    let positions = Distinct::of(model.vertices.iter().map(|v| v.position.to_array()));
    let uvs = Distinct::of(model.vertices.iter().map(|v| v.uv.to_array()));
    let normals = Distinct::of(model.vertices.iter().map(|v| v.normal.to_array()));
    for [x, y, z] in &positions.values {
        writeln!(out, "v {x} {y} {z}")?;
    }
    for [u, v] in &uvs.values {
        writeln!(out, "vt {u} {v}")?;
    }
    for [x, y, z] in &normals.values {
        writeln!(out, "vn {x} {y} {z}")?;
    }
    for part in &model.parts {
        let group: String = part
            .name
            .chars()
            .map(|c| if c.is_control() || c == '#' || c == '\\' { '_' } else { c })
            .collect();
        writeln!(out, "g {group}\nusemtl {}", materials[part.material])?;
        interrupt::check().map_err(io::Error::other)?;
        for t in model.indices[part.indices.clone()].chunks_exact(3) {
            write!(out, "f")?;
            for i in t.iter().map(|i| *i as usize) {
                write!(out, " {}/{}/{}", positions.number[i], uvs.number[i], normals.number[i])?;
            }
            writeln!(out)?;
        }
    }
    Ok(())
}

/// The distinct values of all vertices, compared bit by bit, and for each vertex the number of its value, from 1.
struct Distinct<const N: usize> {
    values: Vec<[f32; N]>,
    number: Vec<usize>,
}

impl<const N: usize> Distinct<N> {
    fn of(all: impl Iterator<Item = [f32; N]>) -> Distinct<N> {
        let mut values = Vec::new();
        let mut numbers = HashMap::new();
        let number = all.map(|value| {
            *numbers.entry(value.map(f32::to_bits)).or_insert_with(|| {
                values.push(value);
                values.len()
            })
        });
        Distinct { number: number.collect(), values }
    }
}

fn write_material(out: &mut impl Write, m: &Material, name: &str, textures: &[String]) -> io::Result<()> {
    writeln!(out, "newmtl {name}")?;
    for (keyword, c) in [("Kd", m.diffuse), ("Ks", m.specular), ("Ke", m.emissive)] {
        writeln!(out, "{keyword} {} {} {}", c.x, c.y, c.z)?;
    }
    // Ns for programs that do not know Pr; see Material::roughness.
    let exponent = 2.0 / m.roughness.max(0.03).powi(2) - 2.0;
    writeln!(out, "Ns {exponent}\nPr {}", m.roughness)?;
    writeln!(out, "d {}\nillum 2", if let Alpha::Blend(opacity) = m.alpha { opacity } else { 1.0 })?;
    let mut map = |keyword: &str, index: Option<usize>| match index {
        Some(i) => writeln!(out, "{keyword} textures/{}.png", textures[i]),
        None => Ok(()),
    };
    map("map_Kd", m.diffuse_map)?;
    if m.alpha != Alpha::Opaque {
        map("map_d", m.diffuse_map)?;
    }
    map("map_Ks", m.specular_map)?;
    // Readers take a map with a black factor as white; here it is off.
    if m.emissive != glam::Vec3::ZERO {
        map("map_Ke", m.emissive_map)?;
    }
    map("norm", m.normal_map)?;
    writeln!(out)
}
