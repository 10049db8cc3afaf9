//! OBJ files with their MTL libraries.
//!
//! [`tobj`] reads the numbers and builds the single index. Statements reach it through a normalizer, because on its own
//! it joins materials that it does not know, lets vertices with and without normals get out of step, overflows on absurd
//! indices, and does not support continued lines, trailing comments or smoothing groups. Polygons are triangulated here:
//! tobj makes fans of them, which is wrong for concave ones.

use std::collections::HashMap;
use std::fmt::{Display, Write as _};
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use glam::{DVec3, Vec2, Vec3};

use super::error::{FAR, MAX_ELEMENTS, SceneError};
use super::model::{Alpha, Material, Model, Vertex};
use super::mtl::{self, MapStatement, MtlEntry};
use super::palette::{paint, palette};
use super::polygon::Triangulator;
use super::repair::{RawMesh, assemble};
use super::textures::{AlphaUse, Built, Recipe, Source, TextureSet, find_file};

/// Maximum size of an MTL library in bytes.
const MAX_LIBRARY: u64 = 64 << 20;

/// Reads an OBJ file with its materials and textures. One unit is one metre.
///
/// Missing libraries and textures are replaced by a default material or a plain colour, with a warning. Missing normals
/// and texture coordinates are generated. Materials are double-sided. Also returns what was subtracted from all
/// positions: not zero if the model is far from its origin.
///
/// # Errors
/// [`SceneError`] if the file cannot be read or parsed, or a texture exists but is damaged.
pub(crate) fn load_obj(path: &Path) -> Result<(Model, DVec3), SceneError> {
    let file = yoro_files::open(path).map_err(SceneError::read(path))?;
    let mut input = Normalizer::new(path, BufReader::with_capacity(1 << 20, file));
    let options = tobj::LoadOptions { single_index: true, ..Default::default() };
    // tobj does not see statements about materials: the libraries are read below.
    let parsed = tobj::load_obj_buf(&mut input, &options, |_| Ok(Default::default()));
    let models = match (parsed, input.error.take()) {
        (_, Some(error)) => return Err(error),
        (Err(error), None) => return Err(input.fault(error)),
        (Ok((models, _)), None) => models,
    };
    let mut names: Vec<&str> = Vec::new();
    let mut numbers: HashMap<&str, usize> = HashMap::new();
    for Part { material, .. } in &input.parts {
        numbers.entry(material).or_insert_with(|| {
            names.push(material);
            names.len() - 1
        });
    }
    let entries = libraries(path, &input.libraries, names.iter().any(|name| !name.is_empty()));
    let mut textures = TextureSet::default();
    let mut materials = Vec::new();
    let mut wanted = Vec::new();
    for &name in &names {
        let entry = entries.get(name);
        if entry.is_none() && !name.is_empty() {
            log::warn!("{}: the material {name} is not defined; a default takes its place", path.display());
        }
        let shown = if name.is_empty() { "default" } else { name };
        materials.push(Material {
            name: shown.to_owned(),
            ..entry.map_or_else(mtl::obj_default, |(e, _)| e.material.clone())
        });
        wanted.push(entry.map_or_else(Wanted::default, |e| Wanted::new(path, e, &mut textures)));
    }
    let mut built = textures.build()?;
    for (material, wanted) in materials.iter_mut().zip(&wanted) {
        wanted.apply(material, &built);
    }
    let coloured = models.iter().any(|model| !model.mesh.vertex_color.is_empty());
    let painted: Vec<bool> = materials.iter().map(|m| coloured && m.diffuse_map.is_none()).collect();
    // A place near the first vertex if that is far from the origin.
    let first = models.iter().find_map(|model| model.mesh.positions.first_chunk()).copied().map(DVec3::from);
    let subtracted =
        first.map(DVec3::round).filter(|p| p.is_finite() && p.length() > FAR).unwrap_or_default();
    let mesh = |model: tobj::Model| {
        // The name is the index of the part.
        let part = model.name.parse::<usize>().ok().and_then(|i| input.parts.get(i))?;
        let material = numbers[part.material.as_str()];
        let mut raw = raw_mesh(model.mesh, wanted[material].placement, subtracted, painted[material]);
        (raw.name, raw.material, raw.flat) = (part.name.clone(), material, part.flat);
        Some(raw)
    };
    let meshes = models.into_iter().filter_map(mesh).collect();
    if painted.contains(&true) {
        for material in materials.iter_mut().zip(&painted).filter_map(|(m, p)| p.then_some(m)) {
            material.diffuse = Vec3::ONE;
            material.diffuse_map = Some(built.images.len());
        }
        built.images.push(palette());
    }
    let (mut model, _) = assemble(path, meshes, materials)?;
    model.textures = built.images;
    Ok((model, subtracted))
}

/// Reads the libraries that an OBJ file names, or else the one with its own name if it uses materials. First definitions
/// count. Returns the materials by their names, with the folders of their libraries.
fn libraries(path: &Path, named: &[String], has_materials: bool) -> HashMap<String, (MtlEntry, PathBuf)> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut files: Vec<PathBuf> = Vec::new();
    for statement in named {
        // A statement may contain several names, and names may contain blanks.
        let found: Vec<PathBuf> = match find_file(folder, statement.trim_matches('"')) {
            Some(file) => vec![file],
            None => statement.split_whitespace().filter_map(|name| find_file(folder, name)).collect(),
        };
        if found.is_empty() {
            log::warn!("{}: the material library {statement} is missing", path.display());
        }
        files.extend(found);
    }
    if files.is_empty() && has_materials {
        files.extend(
            path.with_extension("mtl").file_name().and_then(|n| find_file(folder, &n.to_string_lossy())),
        );
    }
    let mut entries = HashMap::new();
    for file in files {
        let mut bytes = Vec::new();
        match yoro_files::open(&file).and_then(|f| f.take(MAX_LIBRARY).read_to_end(&mut bytes)) {
            Ok(_) => mtl::parse(&bytes).into_iter().for_each(|e| {
                let beside = file.parent().unwrap_or(folder).to_owned();
                entries.entry(e.material.name.clone()).or_insert((e, beside));
            }),
            Err(e) => log::warn!("the material library {} cannot be read ({e})", file.display()),
        }
    }
    entries
}

/// The textures of one material, by their number in the [`TextureSet`].
#[derive(Default)]
struct Wanted {
    diffuse: Option<usize>,
    specular: Option<usize>,
    emissive: Option<usize>,
    normal: Option<usize>,
    /// Scale and offset of texture coordinates.
    placement: Option<(Vec2, Vec2)>,
}

impl Wanted {
    fn new(path: &Path, (entry, beside): &(MtlEntry, PathBuf), textures: &mut TextureSet) -> Wanted {
        let folder = path.parent().unwrap_or(Path::new(""));
        let source = |map: &Option<MapStatement>| {
            let map = map.as_ref()?;
            // Names count from the library that has them; some exporters write them as seen from the OBJ file.
            let found =
                find_file(beside, &map.file).or_else(|| find_file(folder, &map.file)).map(Source::File);
            if found.is_none() {
                log::warn!(
                    "{}: the texture {} of {} is missing",
                    path.display(),
                    map.file,
                    entry.material.name
                );
            }
            found
        };
        let diffuse = match (source(&entry.diffuse), source(&entry.alpha)) {
            (color, Some(mask)) if color.as_ref() != Some(&mask) => {
                let channel = entry.alpha.as_ref().and_then(|m| m.channel);
                Some(Recipe::Masked { color, mask, channel })
            }
            (color, _) => color.map(Recipe::Color),
        };
        let bump = |map: &Option<MapStatement>, normal| {
            let strength = map.as_ref().map_or(1.0, |m| m.bump).to_bits();
            source(map).map(|source| Recipe::Bump { source, strength, normal })
        };
        let normal = bump(&entry.normal, true).or_else(|| bump(&entry.bump, false));
        let placed =
            [&entry.diffuse, &entry.bump, &entry.normal, &entry.alpha, &entry.specular, &entry.emissive];
        let placement = placed.into_iter().flatten().next().map(|m| (m.scale, m.offset));
        let mut request = |recipe: Option<Recipe>| recipe.map(|r| textures.request(r));
        Wanted {
            diffuse: request(diffuse),
            specular: request(source(&entry.specular).map(Recipe::Color)),
            emissive: request(source(&entry.emissive).map(Recipe::Color)),
            normal: request(normal),
            placement: placement.filter(|&p| p != (Vec2::ONE, Vec2::ZERO)),
        }
    }

    fn apply(&self, material: &mut Material, built: &Built) {
        material.diffuse_map = built.index(self.diffuse);
        material.specular_map = built.index(self.specular);
        material.emissive_map = built.index(self.emissive);
        material.normal_map = built.index(self.normal);
        material.alpha = match (built.get(self.diffuse).map(|f| f.alpha), material.alpha) {
            (Some(AlphaUse::Mask), Alpha::Opaque) => Alpha::Cutout(0.5),
            (Some(AlphaUse::Blend), Alpha::Opaque) => Alpha::Blend(1.0),
            (_, alpha) => alpha,
        };
    }
}

/// Returns a mesh cut into triangles, without what it is called and made of.
fn raw_mesh(
    mesh: tobj::Mesh,
    placement: Option<(Vec2, Vec2)>,
    subtracted: DVec3,
    is_painted: bool,
) -> RawMesh {
    let triple = |v: &[f64], i: usize| DVec3::new(v[i * 3], v[i * 3 + 1], v[i * 3 + 2]);
    let (scale, offset) = placement.unwrap_or((Vec2::ONE, Vec2::ZERO));
    let mut vertices: Vec<Vertex> = (0..mesh.positions.len() / 3)
        .map(|i| Vertex {
            position: (triple(&mesh.positions, i) - subtracted).as_vec3(),
            normal: triple(&mesh.normals, i).as_vec3(),
            uv: Vec2::new(mesh.texcoords[i * 2] as f32, mesh.texcoords[i * 2 + 1] as f32) * scale + offset,
        })
        .collect();
    let mut indices = mesh.indices;
    if !mesh.face_arities.is_empty() {
        let polygons = std::mem::take(&mut indices);
        let mut at = 0;
        let mut points = Vec::new();
        let mut triangulator = Triangulator::default();
        for arity in mesh.face_arities {
            let corners = &polygons[at..at + arity as usize];
            at += arity as usize;
            points.clear();
            points.extend(corners.iter().map(|&i| vertices[i as usize].position));
            let triangles = triangulator.triangulate(&points);
            indices.extend(triangles.iter().map(|&k| corners[k as usize]));
        }
    }
    if is_painted {
        // A group before the first vertex with a colour has none.
        let colours = mesh.vertex_color.as_chunks().0;
        let color = |i: u32| colours.get(i as usize).map_or(Vec3::ONE, |c| DVec3::from_array(*c).as_vec3());
        paint(&mut vertices, &mut indices, |corners| corners.into_iter().map(color).sum::<Vec3>() / 3.0);
    }
    RawMesh { vertices, indices, ..RawMesh::default() }
}

/// What all faces of one tobj model share.
#[derive(Clone, Debug, PartialEq)]
struct Part {
    name: String,
    material: String,
    flat: bool,
}

/// Reads an OBJ file and outputs it in a form that tobj reads unambiguously: one statement per line; only `v`, `vt`,
/// `vn`, `f` and `g`; every corner with all three indices, positive and limited. The first `vt` and `vn` are NaN, and stand
/// for missing ones. `g` carries the index of an entry of `parts`.
struct Normalizer<R> {
    path: PathBuf,
    input: R,
    line: usize,
    /// The output, which is consumed up to `given`.
    out: String,
    given: usize,
    /// Number of `v`, `vt` and `vn` so far.
    counts: [usize; 3],
    /// What is stated for the next face.
    next: Part,
    parts: Vec<Part>,
    libraries: Vec<String>,
    error: Option<SceneError>,
}

impl<R: BufRead> Normalizer<R> {
    fn new(path: &Path, input: R) -> Normalizer<R> {
        Normalizer {
            path: path.into(),
            input,
            line: 0,
            out: "vt nan nan\nvn nan nan nan\n".to_owned(),
            given: 0,
            counts: [0; 3],
            next: Part { name: "model".into(), material: String::new(), flat: false },
            parts: Vec::new(),
            libraries: Vec::new(),
            error: None,
        }
    }

    fn fault(&self, what: impl Display) -> SceneError {
        let what = format!("up to line {}: {what}; correct it or export the model again", self.line);
        SceneError::unusable(&self.path, what)
    }

    /// Translates a statement, which may continue over several lines. False at the end of the file.
    fn translate(&mut self) -> Result<bool, SceneError> {
        let mut statement = Vec::new();
        loop {
            let start = statement.len();
            let read = self.input.read_until(b'\n', &mut statement).map_err(SceneError::read(&self.path))?;
            if read == 0 && start == 0 {
                return Ok(false);
            }
            self.line += 1;
            statement.truncate(statement.trim_ascii_end().len().max(start));
            match statement[start..].last() {
                Some(b'\\') => *statement.last_mut().expect("it has this letter") = b' ',
                _ => break,
            }
        }
        if statement.contains(&0) {
            return Err(self.fault("there are zero bytes, so this is a binary or UTF-16 file"));
        }
        let text = String::from_utf8_lossy(&statement);
        // Old Macintosh files end lines with CR alone.
        for line in text.trim_start_matches('\u{feff}').split('\r') {
            self.translate_line(mtl::without_comment(line).trim())?;
        }
        Ok(true)
    }

    fn translate_line(&mut self, text: &str) -> Result<(), SceneError> {
        let (keyword, rest) = text.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((text, ""));
        let rest = rest.trim();
        match keyword {
            "f" | "fo" => return self.face(rest),
            "o" | "g" => self.next.name = if rest.is_empty() { "model".into() } else { rest.into() },
            "usemtl" => self.next.material = rest.into(),
            "s" => self.next.flat = matches!(rest, "off" | "0"),
            "mtllib" if !rest.is_empty() => {
                if !self.libraries.iter().any(|library| library == rest) && self.libraries.len() < 1000 {
                    self.libraries.push(rest.to_owned());
                }
            }
            _ => {
                if let Some(kind) = ["v", "vt", "vn"].iter().position(|kind| *kind == keyword) {
                    self.counts[kind] += 1;
                    // Passed on as written: formatting the numbers again takes longer than everything else.
                    self.out.extend([text, "\n"]);
                }
            }
        }
        Ok(())
    }

    fn face(&mut self, rest: &str) -> Result<(), SceneError> {
        let mut face = String::from("f");
        let mut corners = 0;
        for word in rest.split_ascii_whitespace() {
            let [v, vt, vn] = self.corner(word).ok_or_else(|| {
                self.fault(format!("`{}` is not the corner of a face", mtl::abridged(word)))
            })?;
            // Writing to a string cannot fail.
            let _ = write!(face, " {v}/{vt}/{vn}");
            corners += 1;
        }
        // Points and lines are dropped.
        if corners >= 3 {
            if self.parts.last() != Some(&self.next) {
                let _ = writeln!(self.out, "g {}", self.parts.len());
                self.parts.push(self.next.clone());
            }
            self.out.extend([face.as_str(), "\n"]);
        }
        Ok(())
    }

    /// Returns the indices of a corner, counted from 1, those that are left out being 1.
    fn corner(&self, word: &str) -> Option<[usize; 3]> {
        let mut corner = [0, 1, 1];
        let mut parts = word.split('/');
        for (kind, slot) in corner.iter_mut().enumerate() {
            match parts.next().unwrap_or("") {
                // Some exporters write 0 for missing indices.
                "" | "0" if kind > 0 => {}
                text => {
                    let index: i64 = text.parse().ok()?;
                    let back = if index < 0 { self.counts[kind] as i64 + 1 } else { 0 };
                    let index = usize::try_from(index + back).ok();
                    // The first vt and vn stand for missing ones, so the file's own come after them.
                    *slot = index.filter(|i| (1..=MAX_ELEMENTS).contains(i))? + usize::from(kind > 0);
                }
            }
        }
        parts.next().is_none().then_some(corner)
    }
}

impl<R: BufRead> BufRead for Normalizer<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.given == self.out.len() {
            self.out.clear();
            self.given = 0;
            while self.out.is_empty() {
                match self.translate() {
                    Ok(true) => {}
                    Ok(false) => break,
                    Err(error) => {
                        self.error = Some(error);
                        return Err(io::ErrorKind::InvalidData.into());
                    }
                }
            }
        }
        Ok(&self.out.as_bytes()[self.given..])
    }

    fn consume(&mut self, amount: usize) {
        self.given += amount;
    }
}

impl<R: BufRead> Read for Normalizer<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(buffer)?;
        self.consume(count);
        Ok(count)
    }
}
