//! OBJ files with their MTL libraries.
//!
//! The numbers of a file are read into lists; each corner of a face names a position and perhaps texture coordinates and
//! a normal, counted from the start of the file or back from the face. Faces with the same name, material and smoothing
//! become one mesh.

use std::collections::HashMap;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use glam::{DVec3, Vec2, Vec3};

use super::error::{FAR, MAX_ELEMENTS, SceneError};
use super::model::{Alpha, Material, Model, Vertex};
use super::mtl::{self, MapStatement, MtlEntry};
use super::palette::{paint, palette};
use super::polygon::Triangulator;
use super::repair::{NO_NORMAL, NO_UV, RawMesh, assemble};
use super::textures::{AlphaUse, Built, Recipe, Source, TextureSet, find_file};

/// Maximum length of a statement in bytes: a face of a million corners.
const MAX_STATEMENT: usize = 16 << 20;

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
    let parsed = Parser::new(path).read(BufReader::with_capacity(1 << 20, file))?;
    if parsed.has_curves {
        log::warn!("{}: curves and surfaces are left out; export them as polygons", path.display());
    }
    let entries = libraries(path, &parsed);
    let mut textures = TextureSet::default();
    let mut materials = Vec::new();
    let mut wanted = Vec::new();
    for name in &parsed.materials {
        let entry = entries.get(name.as_str());
        if entry.is_none() && !name.is_empty() {
            log::warn!("{}: the material {name} is not defined; a default takes its place", path.display());
        }
        let shown = if name.is_empty() { "default".to_owned() } else { name.clone() };
        materials.push(Material {
            name: shown,
            ..entry.map_or_else(mtl::obj_default, |(e, _)| e.material.clone())
        });
        wanted.push(entry.map_or_else(Wanted::default, |e| Wanted::new(path, e, &mut textures)));
    }
    let mut built = textures.build()?;
    for (material, wanted) in materials.iter_mut().zip(&wanted) {
        wanted.apply(material, &built);
    }
    let has_colors = !parsed.colors.is_empty();
    let painted: Vec<bool> = materials.iter().map(|m| has_colors && m.diffuse_map.is_none()).collect();
    let placed = |part: &Part| parsed.mesh(part, wanted[part.material].placement, painted[part.material]);
    let meshes = parsed.parts.iter().map(placed).collect();
    if painted.contains(&true) {
        for material in materials.iter_mut().zip(&painted).filter_map(|(m, p)| p.then_some(m)) {
            material.diffuse = Vec3::ONE;
            material.diffuse_map = Some(built.images.len());
        }
        built.images.push(palette());
    }
    let subtracted = parsed.subtracted.unwrap_or_default();
    drop(parsed);
    let (mut model, _) = assemble(path, meshes, materials)?;
    model.textures = built.images;
    Ok((model, subtracted))
}

/// Reads the libraries that an OBJ file names, or else the one with its own name. First definitions count. Returns the
/// materials by their names, with the folders of their libraries.
fn libraries(path: &Path, parsed: &Parser) -> HashMap<String, (MtlEntry, PathBuf)> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut files: Vec<PathBuf> = Vec::new();
    for statement in &parsed.libraries {
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
    if files.is_empty() && parsed.materials.iter().any(|n| !n.is_empty()) {
        files.extend(
            path.with_extension("mtl").file_name().and_then(|n| find_file(folder, &n.to_string_lossy())),
        );
    }
    let mut entries = HashMap::new();
    for file in files {
        let mut bytes = Vec::new();
        match yoro_files::open(&file).and_then(|f| f.take(MAX_LIBRARY).read_to_end(&mut bytes)) {
            Ok(_) => mtl::parse(&file, &bytes).into_iter().for_each(|e| {
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

/// Faces that share a name, a material and their smoothing.
struct Part {
    name: String,
    /// Index into [`Parser::materials`].
    material: usize,
    flat: bool,
    /// The number of corners of each face.
    arities: Vec<u32>,
    corners: Vec<Corner>,
}

/// Indices of a corner's position, texture coordinates and normal; [`MISSING`] for what it lacks.
type Corner = [u32; 3];

const MISSING: u32 = u32::MAX;

/// The names of what a [`Corner`] has, for messages.
const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// The contents of an OBJ file, and the state that its statements set for the faces that follow.
struct Parser<'a> {
    path: &'a Path,
    line: usize,
    positions: Vec<Vec3>,
    /// A colour of each position; empty unless the first vertex has one.
    colors: Vec<Vec3>,
    texture_coordinates: Vec<Vec2>,
    normals: Vec<Vec3>,
    corners: usize,
    /// What is subtracted from all positions before they are rounded to f32: a place near the first vertex if that is
    /// far from the origin.
    subtracted: Option<DVec3>,
    parts: Vec<Part>,
    /// The names of the materials, in the order of their first use.
    materials: Vec<String>,
    material_of: HashMap<String, usize>,
    libraries: Vec<String>,
    has_curves: bool,
    name: String,
    material: String,
    flat: bool,
    /// The highest index of each kind that a face named before the file had it, and the error if it never does.
    furthest: [(usize, Option<SceneError>); 3],
}

impl<'a> Parser<'a> {
    fn new(path: &'a Path) -> Parser<'a> {
        Parser {
            path,
            line: 0,
            positions: Vec::new(),
            colors: Vec::new(),
            texture_coordinates: Vec::new(),
            normals: Vec::new(),
            corners: 0,
            subtracted: None,
            parts: Vec::new(),
            materials: Vec::new(),
            material_of: HashMap::new(),
            libraries: Vec::new(),
            has_curves: false,
            name: "model".into(),
            material: String::new(),
            flat: false,
            furthest: Default::default(),
        }
    }

    /// Reads a file to its end.
    fn read(mut self, mut input: impl BufRead) -> Result<Parser<'a>, SceneError> {
        let mut statement = Vec::new();
        while self.next_statement(&mut input, &mut statement)? {
            let text = String::from_utf8_lossy(&statement);
            // Old Macintosh files end lines with CR alone.
            for line in text.trim_start_matches('\u{feff}').split('\r') {
                self.statement(mtl::without_comment(line).trim())?;
            }
        }
        let counts = self.counts();
        for ((index, error), count) in std::mem::take(&mut self.furthest).into_iter().zip(counts) {
            if let Some(error) = error.filter(|_| index > count) {
                return Err(error);
            }
        }
        Ok(self)
    }

    fn fault(&self, what: impl Into<String>) -> SceneError {
        SceneError::Unusable(format!(
            "{}, line {}: {}; correct the line or export the model again",
            self.path.display(),
            self.line,
            what.into()
        ))
    }

    fn too_large(&self, what: &'static str) -> SceneError {
        SceneError::too_large(self.path, MAX_ELEMENTS, what)
    }

    fn counts(&self) -> [usize; 3] {
        [self.positions.len(), self.texture_coordinates.len(), self.normals.len()]
    }

    /// Reads one statement and joins continued lines. False at the end of the file.
    fn next_statement(
        &mut self,
        input: &mut impl BufRead,
        statement: &mut Vec<u8>,
    ) -> Result<bool, SceneError> {
        statement.clear();
        loop {
            let start = statement.len();
            let read = input.by_ref().take((MAX_STATEMENT - start) as u64).read_until(b'\n', statement);
            let count = read.map_err(SceneError::read(self.path))?;
            if count == 0 {
                return Ok(start > 0);
            }
            self.line += 1;
            if statement.len() >= MAX_STATEMENT || statement[start..].contains(&0) {
                return Err(self.fault("the line is too long or binary; save the model as OBJ text in UTF-8"));
            }
            let length = statement.trim_ascii_end().len();
            if length > start && statement[length - 1] == b'\\' {
                statement.truncate(length - 1);
                statement.push(b' ');
            } else {
                return Ok(true);
            }
        }
    }

    fn statement(&mut self, text: &str) -> Result<(), SceneError> {
        let (keyword, rest) = text.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((text, ""));
        let rest = rest.trim();
        match keyword {
            "v" => self.vertex(rest)?,
            "vt" => {
                let (numbers, count) = self.numbers::<2>(keyword, rest, 1)?;
                let [u, v] = numbers.map(|x| x as f32);
                self.texture_coordinates.push(Vec2::new(u, if count < 2 { 0.0 } else { v }));
            }
            "vn" => {
                let (numbers, _) = self.numbers::<3>(keyword, rest, 3)?;
                self.normals.push(DVec3::from(numbers).as_vec3());
            }
            "f" | "fo" => self.face(rest)?,
            "o" | "g" => self.name = if rest.is_empty() { "model".into() } else { rest.into() },
            "usemtl" => self.material = rest.into(),
            "s" => self.flat = matches!(rest, "off" | "0"),
            "mtllib" if !rest.is_empty() && !self.libraries.iter().any(|l| l == rest) => {
                self.libraries.push(rest.into());
            }
            "curv" | "curv2" | "surf" => self.has_curves = true,
            _ => {}
        }
        Ok(())
    }

    /// Returns up to N numbers and their count, at least `needed`.
    fn numbers<const N: usize>(
        &self,
        keyword: &str,
        rest: &str,
        needed: usize,
    ) -> Result<([f64; N], usize), SceneError> {
        let (mut numbers, mut count) = ([f64::NAN; N], 0);
        for (number, word) in numbers.iter_mut().zip(rest.split_ascii_whitespace()) {
            // C libraries write values that are not numbers as `-nan(ind)` or `1.#QNAN`.
            let is_nan = || word.to_ascii_lowercase().contains("nan") || word.contains("1.#");
            *number = match word.parse() {
                Ok(number) => number,
                Err(_) if is_nan() => f64::NAN,
                Err(_) => return Err(self.fault(format!("`{}` is not a number", mtl::abridged(word)))),
            };
            count += 1;
        }
        if count < needed {
            return Err(self.fault(format!("`{keyword}` needs {needed} numbers and has {count}")));
        }
        if self.counts().into_iter().any(|count| count >= MAX_ELEMENTS) {
            return Err(self.too_large("vertices"));
        }
        Ok((numbers, count))
    }

    fn vertex(&mut self, rest: &str) -> Result<(), SceneError> {
        let ([x, y, z, r, g, b], count) = self.numbers::<6>("v", rest, 3)?;
        let position = DVec3::new(x, y, z);
        if self.positions.is_empty() {
            let place = position.round();
            self.subtracted = (place.is_finite() && place.length() > FAR).then_some(place);
        }
        if count == 6 && self.colors.len() == self.positions.len() {
            self.colors.push(DVec3::new(r, g, b).as_vec3());
        } else if !self.colors.is_empty() {
            self.colors.push(Vec3::ONE);
        }
        self.positions.push((position - self.subtracted.unwrap_or_default()).as_vec3());
        Ok(())
    }

    fn face(&mut self, rest: &str) -> Result<(), SceneError> {
        let corners: Vec<Corner> =
            rest.split_ascii_whitespace().map(|word| self.corner(word)).collect::<Result<_, _>>()?;
        // Points and lines are dropped.
        if corners.len() < 3 {
            return Ok(());
        }
        self.corners += corners.len();
        if self.corners > MAX_ELEMENTS {
            return Err(self.too_large("corners of faces"));
        }
        let material = match self.material_of.get(&self.material) {
            Some(&material) => material,
            None => {
                self.materials.push(self.material.clone());
                self.material_of.insert(self.material.clone(), self.materials.len() - 1);
                self.materials.len() - 1
            }
        };
        let goes_on =
            |part: &Part| part.material == material && part.flat == self.flat && part.name == self.name;
        if !self.parts.last().is_some_and(goes_on) {
            let (name, flat) = (self.name.clone(), self.flat);
            self.parts.push(Part { name, material, flat, arities: Vec::new(), corners: Vec::new() });
        }
        if let Some(part) = self.parts.last_mut() {
            part.arities.push(corners.len() as u32);
            part.corners.extend(corners);
        }
        Ok(())
    }

    /// Reads a corner: `v`, `v/vt`, `v//vn` or `v/vt/vn`. An index may name what comes later in the file.
    fn corner(&mut self, word: &str) -> Result<Corner, SceneError> {
        let malformed =
            |parser: &Self| parser.fault(format!("`{}` is not the corner of a face", mtl::abridged(word)));
        let mut corner = [MISSING; 3];
        let mut texts = word.split('/');
        for (kind, (slot, count)) in corner.iter_mut().zip(self.counts()).enumerate() {
            let text = texts.next().unwrap_or("");
            // Some exporters write 0 for missing indices.
            if kind > 0 && matches!(text, "" | "0") {
                continue;
            }
            let index: i64 = text.parse().map_err(|_| malformed(self))?;
            let back = usize::try_from(index.unsigned_abs()).unwrap_or(usize::MAX);
            let index = if index < 0 { (count + 1).saturating_sub(back) } else { back };
            let fault = || format!("`{}` names a {} that does not exist", mtl::abridged(word), KINDS[kind]);
            if index == 0 || index > MAX_ELEMENTS {
                return Err(self.fault(fault()));
            }
            if index > count && index > self.furthest[kind].0 {
                self.furthest[kind] = (index, Some(self.fault(fault())));
            }
            *slot = index as u32 - 1;
        }
        if texts.next().is_some() { Err(malformed(self)) } else { Ok(corner) }
    }

    /// Returns a part cut into triangles, with its texture coordinates scaled and moved.
    fn mesh(&self, part: &Part, placement: Option<(Vec2, Vec2)>, painted: bool) -> RawMesh {
        let (scale, offset) = placement.unwrap_or((Vec2::ONE, Vec2::ZERO));
        let mut known: HashMap<Corner, u32> = HashMap::new();
        let (mut vertices, mut colors): (Vec<Vertex>, Vec<Vec3>) = Default::default();
        let mut number = |corner: &Corner| {
            *known.entry(*corner).or_insert_with(|| {
                let [position, uv, normal] = corner.map(|index| index as usize);
                vertices.push(Vertex {
                    position: self.positions[position],
                    normal: self.normals.get(normal).copied().unwrap_or(NO_NORMAL),
                    uv: self.texture_coordinates.get(uv).map_or(NO_UV, |uv| *uv * scale + offset),
                });
                colors.extend(self.colors.get(position));
                vertices.len() as u32 - 1
            })
        };
        let polygons: Vec<u32> = part.corners.iter().map(&mut number).collect();
        let mut indices = Vec::with_capacity(polygons.len());
        let mut rest = polygons.as_slice();
        let mut triangulator = Triangulator::default();
        let mut points = Vec::new();
        for &arity in &part.arities {
            let (face, others) = rest.split_at(arity as usize);
            rest = others;
            points.clear();
            points.extend(face.iter().map(|&i| vertices[i as usize].position));
            indices.extend(triangulator.triangulate(&points).iter().map(|&k| face[k as usize]));
        }
        if painted {
            let color = |i: u32| colors[i as usize];
            paint(&mut vertices, &mut indices, |corners| corners.map(color).into_iter().sum::<Vec3>() / 3.0);
        }
        let Part { name, material, flat, .. } = part;
        RawMesh {
            name: name.clone(),
            material: *material,
            vertices,
            indices,
            flat: *flat,
            ..RawMesh::default()
        }
    }
}
