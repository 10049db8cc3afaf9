//! OBJ files with their MTL libraries.
//!
//! [`tobj`] reads the numbers and builds the single index. Statements reach it through a normalizer, because on its own
//! it has no line numbers, joins materials that it does not know, lets vertices with and without normals get out of
//! step, overflows on absurd indices, and does not support continued lines, trailing comments or smoothing groups.
//! Polygons are triangulated here: tobj makes fans of them, which is wrong for concave ones.

use std::collections::HashMap;
use std::io::{self, BufRead, BufReader, Read, Write as _};
use std::path::{Path, PathBuf};

use glam::{DVec3, Vec2, Vec3};

use super::error::{FAR, MAX_ELEMENTS, SceneError};
use super::model::{Alpha, Material, Model, Vertex};
use super::mtl::{self, MapStatement, MtlEntry};
use super::palette::{paint, palette};
use super::polygon::Triangulator;
use super::repair::{RawMesh, assemble};
use super::textures::{AlphaUse, Built, Recipe, Source, TextureSet, find_file};

/// Maximum length of a statement in bytes: a face of a million corners.
const MAX_STATEMENT: usize = 16 << 20;

/// Maximum size of an MTL library in bytes.
const MAX_LIBRARY: u64 = 64 << 20;

/// Number of faces after which a new tobj model begins, to keep tobj's tables small.
const FACES_PER_MODEL: usize = 1 << 16;

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
    if let Some(error) = input.error.take() {
        return Err(error);
    }
    let models = match parsed {
        Ok((models, _)) => models,
        Err(e) => {
            let unknown = || SceneError::unusable(path, format!("{e}; export the model again"));
            return Err(input.beyond.take().unwrap_or_else(unknown));
        }
    };
    if input.curves {
        log::warn!("{}: curves and surfaces are left out; export them as polygons", path.display());
    }
    let entries = libraries(path, &input);
    let mut textures = TextureSet::default();
    let mut materials = Vec::new();
    let mut wanted = Vec::new();
    for name in &input.materials.names {
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
    let coloured = input.coloured;
    let painted: Vec<bool> = materials.iter().map(|m| coloured && m.diffuse_map.is_none()).collect();
    let meshes = models
        .into_iter()
        .filter_map(|model| {
            // The name is the index of the part.
            let part = model.name.parse::<usize>().ok().and_then(|i| input.parts.get(i))?;
            let name = input.names.names[part.name].clone();
            let placement = wanted[part.material].placement;
            Some(raw_mesh(model.mesh, part, name, placement, painted[part.material]))
        })
        .collect();
    if painted.contains(&true) {
        for material in materials.iter_mut().zip(&painted).filter_map(|(m, p)| p.then_some(m)) {
            material.diffuse = Vec3::ONE;
            material.diffuse_map = Some(built.images.len());
        }
        built.images.push(palette());
    }
    let subtracted = input.subtracted.unwrap_or_default();
    drop(input);
    let (mut model, _) = assemble(path, meshes, materials)?;
    model.textures = built.images;
    Ok((model, subtracted))
}

/// Reads the libraries that an OBJ file names, or else the one with its own name. First definitions count. Returns the
/// materials by their names, with the folders of their libraries.
fn libraries(path: &Path, input: &Normalizer<impl BufRead>) -> HashMap<String, (MtlEntry, PathBuf)> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut files: Vec<PathBuf> = Vec::new();
    for statement in &input.libraries {
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
    if files.is_empty() && input.materials.names.iter().any(|n| !n.is_empty()) {
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

/// Returns a mesh cut into triangles.
fn raw_mesh(
    mesh: tobj::Mesh,
    part: &PartKey,
    name: String,
    placement: Option<(Vec2, Vec2)>,
    painted: bool,
) -> RawMesh {
    let triple = |v: &[f32], i: usize| Vec3::new(v[i * 3], v[i * 3 + 1], v[i * 3 + 2]);
    let (scale, offset) = placement.unwrap_or((Vec2::ONE, Vec2::ZERO));
    let mut vertices: Vec<Vertex> = (0..mesh.positions.len() / 3)
        .map(|i| Vertex {
            position: triple(&mesh.positions, i),
            normal: triple(&mesh.normals, i),
            uv: Vec2::new(mesh.texcoords[i * 2], mesh.texcoords[i * 2 + 1]) * scale + offset,
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
    if painted {
        let color = |i: u32| triple(&mesh.vertex_color, i as usize);
        paint(&mut vertices, &mut indices, |corners| corners.into_iter().map(color).sum::<Vec3>() / 3.0);
    }
    RawMesh { name, material: part.material, vertices, indices, flat: part.flat, ..RawMesh::default() }
}

/// Numbers names in the order of first use.
#[derive(Default)]
struct Names {
    names: Vec<String>,
    known: HashMap<String, usize>,
}

impl Names {
    fn number(&mut self, name: &str) -> usize {
        if let Some(&i) = self.known.get(name) {
            return i;
        }
        self.names.push(name.to_owned());
        self.known.insert(name.to_owned(), self.names.len() - 1);
        self.names.len() - 1
    }
}

/// The properties that all faces of one tobj model share.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PartKey {
    name: usize,
    material: usize,
    flat: bool,
}

/// Reads an OBJ file and outputs it in a form that tobj reads unambiguously: one statement per line; only `v`, `vt`,
/// `vn`, `f` and `g`; every corner with all three indices, absolute and within the file. The first `vt` and `vn` are
/// NaN, and stand for missing ones. `g` carries the index of an entry of [`Normalizer::parts`].
struct Normalizer<R> {
    path: PathBuf,
    input: R,
    line: usize,
    /// The statement as read, and the output, which is consumed up to `given`.
    statement: Vec<u8>,
    out: Vec<u8>,
    given: usize,
    /// Number of `v`, `vt` and `vn` so far.
    counts: [usize; 3],
    corners: usize,
    /// True if the first vertex had a colour; then all of them get one.
    coloured: bool,
    /// What is subtracted from all vertices, which tobj reads as f32: a place near the first vertex if that is far from
    /// the origin.
    subtracted: Option<DVec3>,
    name: String,
    material: String,
    flat: bool,
    /// True if a name, material or smoothing group was stated since the last face.
    restated: bool,
    faces_in_part: usize,
    names: Names,
    materials: Names,
    parts: Vec<PartKey>,
    libraries: Vec<String>,
    curves: bool,
    error: Option<SceneError>,
    /// The first face that refers to a later vertex. This is valid only if the vertex comes before the faces of the
    /// next group.
    beyond: Option<SceneError>,
}

impl<R: BufRead> Normalizer<R> {
    fn new(path: &Path, input: R) -> Normalizer<R> {
        Normalizer {
            path: path.into(),
            input,
            line: 0,
            statement: Vec::new(),
            out: b"vt nan nan\nvn nan nan nan\n".to_vec(),
            given: 0,
            counts: [0; 3],
            corners: 0,
            coloured: false,
            subtracted: None,
            name: "model".into(),
            material: String::new(),
            flat: false,
            restated: true,
            faces_in_part: 0,
            names: Names::default(),
            materials: Names::default(),
            parts: Vec::new(),
            libraries: Vec::new(),
            curves: false,
            error: None,
            beyond: None,
        }
    }

    fn fault(&self, what: impl Into<String>) -> SceneError {
        SceneError::Unusable(format!(
            "{}, line {}: {}; correct the line or export the model again",
            self.path.display(),
            self.line,
            what.into()
        ))
    }

    /// Reads one statement and joins continued lines. False at the end of the file.
    fn next_statement(&mut self) -> Result<bool, SceneError> {
        self.statement.clear();
        loop {
            let start = self.statement.len();
            let room = (MAX_STATEMENT - start) as u64;
            let read = self.input.by_ref().take(room).read_until(b'\n', &mut self.statement);
            let n = read.map_err(|source| SceneError::Read { path: self.path.clone(), source })?;
            if n == 0 && start == 0 {
                return Ok(false);
            }
            self.line += 1;
            if self.statement.len() >= MAX_STATEMENT {
                return Err(self.fault("the line is too long for a model; is this an OBJ file?"));
            }
            if self.statement[start..].contains(&0) {
                return Err(self.fault(
                    "there are zero bytes, so this is a binary or UTF-16 file; save it as OBJ text in UTF-8",
                ));
            }
            while self.statement.last().is_some_and(|b| b.is_ascii_whitespace())
                && self.statement.len() > start
            {
                self.statement.pop();
            }
            if n > 0 && self.statement.len() > start && self.statement.last() == Some(&b'\\') {
                self.statement.pop();
                self.statement.push(b' ');
            } else {
                return Ok(true);
            }
        }
    }

    /// Translates the statement into `out`, which stays empty if tobj need not see it.
    fn translate(&mut self) -> Result<(), SceneError> {
        let taken = std::mem::take(&mut self.statement);
        let text = String::from_utf8_lossy(&taken);
        let text = if self.line == 1 { text.trim_start_matches('\u{feff}') } else { &text };
        // Old Macintosh files end lines with CR alone.
        let result =
            text.split('\r').try_for_each(|line| self.translate_line(mtl::without_comment(line).trim()));
        self.statement = taken;
        result
    }

    fn translate_line(&mut self, text: &str) -> Result<(), SceneError> {
        let (keyword, rest) = text.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((text, ""));
        match keyword {
            "v" | "vt" | "vn" => return self.vector(keyword, rest),
            "f" | "fo" => return self.face(rest),
            "o" | "g" => {
                let name = rest.trim();
                self.name = if name.is_empty() { "model".into() } else { name.into() };
                self.restated = true;
            }
            "usemtl" => {
                self.material = rest.trim().into();
                self.restated = true;
            }
            "s" => {
                self.flat = matches!(rest.trim(), "off" | "0");
                self.restated = true;
            }
            "mtllib" if !rest.trim().is_empty() => {
                let library = rest.trim().to_owned();
                if !self.libraries.contains(&library) && self.libraries.len() < 1000 {
                    self.libraries.push(library);
                }
            }
            "curv" | "curv2" | "surf" => self.curves = true,
            _ => {}
        }
        Ok(())
    }

    fn vector(&mut self, keyword: &str, rest: &str) -> Result<(), SceneError> {
        // Passed on as written: formatting the numbers again takes longer than everything else.
        let mut words = [""; 7];
        let mut n = 0;
        for word in rest.split_ascii_whitespace().take(7) {
            words[n] = match number(word) {
                Some(x) if x.is_nan() => "nan",
                Some(_) => word,
                None => {
                    let hint = if word.contains(',') { " (decimals need a point)" } else { "" };
                    return Err(self.fault(format!("`{}` is not a number{hint}", mtl::abridged(word))));
                }
            };
            n += 1;
        }
        let (kind, needed) = match keyword {
            "v" => (0, 3),
            "vt" => (1, 1),
            _ => (2, 3),
        };
        if n < needed {
            return Err(self.fault(format!("`{keyword}` needs {needed} numbers and has {n}")));
        }
        if kind == 0 && self.counts[0] == 0 {
            self.coloured = n >= 6;
            let first = DVec3::from([0, 1, 2].map(|i| words[i].parse().unwrap_or(f64::NAN))).round();
            self.subtracted = (first.is_finite() && first.length() > FAR).then_some(first);
        }
        self.counts[kind] += 1;
        if self.counts[kind] > MAX_ELEMENTS {
            return Err(SceneError::too_large(&self.path, MAX_ELEMENTS, "vertices"));
        }
        let mut near = [const { String::new() }; 3];
        if let Some(subtracted) = self.subtracted.filter(|_| kind == 0) {
            for ((near, word), subtracted) in near.iter_mut().zip(&mut words).zip(subtracted.to_array()) {
                // What is not a number stays one.
                *near = (word.parse().unwrap_or(f64::NAN) - subtracted).to_string();
                *word = near;
            }
        }
        let [a, b, c, colour @ ..] = words;
        let written = match kind {
            0 if self.coloured => {
                let [r, g, b2] = if n >= 6 { [colour[0], colour[1], colour[2]] } else { ["1"; 3] };
                writeln!(self.out, "v {a} {b} {c} {r} {g} {b2}")
            }
            0 => writeln!(self.out, "v {a} {b} {c}"),
            1 => writeln!(self.out, "vt {a} {}", if n < 2 { "0" } else { b }),
            _ => writeln!(self.out, "vn {a} {b} {c}"),
        };
        written.map_err(|source| SceneError::Read { path: self.path.clone(), source })
    }

    fn face(&mut self, rest: &str) -> Result<(), SceneError> {
        if self.restated || self.faces_in_part >= FACES_PER_MODEL {
            self.begin_part();
        }
        let began = self.out.len();
        self.out.push(b'f');
        let mut corners = 0;
        for word in rest.split_ascii_whitespace() {
            let mut indices = [0usize, 1, 1];
            let mut parts = word.split('/');
            for (kind, slot) in indices.iter_mut().enumerate() {
                let part = parts.next().unwrap_or("");
                if let Some(index) = self.index(part, kind, word)? {
                    // The first vt and vn stand for missing ones, so the file's own come after them.
                    *slot = if kind == 0 { index } else { index + 1 };
                }
            }
            if parts.next().is_some() || indices[0] == 0 {
                return Err(self.fault(format!("`{}` is not the corner of a face", mtl::abridged(word))));
            }
            let [v, vt, vn] = indices;
            let written = write!(self.out, " {v}/{vt}/{vn}");
            written.map_err(|source| SceneError::Read { path: self.path.clone(), source })?;
            corners += 1;
        }
        self.corners += corners;
        if self.corners > MAX_ELEMENTS {
            return Err(SceneError::too_large(&self.path, MAX_ELEMENTS, "corners of faces"));
        }
        if corners < 3 {
            // Points and lines are dropped; the part that was begun for them stays open.
            self.out.truncate(began);
        } else {
            self.out.push(b'\n');
            self.faces_in_part += 1;
        }
        Ok(())
    }

    fn begin_part(&mut self) {
        self.restated = false;
        let key = PartKey {
            name: self.names.number(&self.name),
            material: self.materials.number(&self.material),
            flat: self.flat,
        };
        if self.parts.last() == Some(&key) && self.faces_in_part < FACES_PER_MODEL {
            return;
        }
        self.faces_in_part = 0;
        self.out.extend_from_slice(format!("g {}\n", self.parts.len()).as_bytes());
        self.parts.push(key);
    }

    /// Returns an index of a corner, counted from 1; `None` if it is left out.
    fn index(&mut self, text: &str, kind: usize, corner: &str) -> Result<Option<usize>, SceneError> {
        let what = ["vertex", "texture coordinate", "normal"][kind];
        if text.is_empty() {
            return Ok(None);
        }
        let corner = || mtl::abridged(corner);
        let index: i64 =
            text.parse().map_err(|_| self.fault(format!("`{}` is not the corner of a face", corner())))?;
        let count = self.counts[kind];
        match index {
            // Some exporters write 0 for missing indices.
            0 if kind > 0 => Ok(None),
            0 => Err(self.fault(format!("`{}` names {what} 0, but they are counted from 1", corner()))),
            i if i < 0 => match usize::try_from(i.unsigned_abs()).ok().filter(|&back| back <= count) {
                Some(back) => Ok(Some(count - back + 1)),
                None => Err(self.fault(format!(
                    "`{}` refers {} back, but there are only {count} before",
                    corner(),
                    i.unsigned_abs()
                ))),
            },
            i => {
                let fault = |s: &Self| {
                    s.fault(format!("`{}` names {what} {i}, but there are only {count}", corner()))
                };
                let i = usize::try_from(i).unwrap_or(usize::MAX);
                if i > MAX_ELEMENTS {
                    return Err(fault(self));
                }
                if i > count && self.beyond.is_none() {
                    self.beyond = Some(fault(self));
                }
                Ok(Some(i))
            }
        }
    }
}

/// Returns a number. Accepts the spellings of C libraries for values that are not numbers.
fn number(word: &str) -> Option<f32> {
    let none = || {
        let w = word.trim_start_matches(['-', '+']).to_ascii_lowercase();
        (w.starts_with("nan") || w.starts_with("1.#") || w.starts_with("inf")).then_some(f32::NAN)
    };
    word.parse().ok().or_else(none)
}

impl<R: BufRead> BufRead for Normalizer<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.given >= self.out.len() {
            self.out.clear();
            self.given = 0;
            // Many statements at once, because tobj asks line by line.
            while self.out.len() < 1 << 16 {
                match self
                    .next_statement()
                    .and_then(|more| if more { self.translate().map(|()| true) } else { Ok(false) })
                {
                    Ok(true) => {}
                    Ok(false) => break,
                    Err(error) => {
                        self.error = Some(error);
                        return Err(io::ErrorKind::InvalidData.into());
                    }
                }
            }
        }
        Ok(&self.out[self.given..])
    }

    fn consume(&mut self, amount: usize) {
        self.given += amount;
    }
}

impl<R: BufRead> Read for Normalizer<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let available = self.fill_buf()?;
        let n = available.len().min(buffer.len());
        buffer[..n].copy_from_slice(&available[..n]);
        self.consume(n);
        Ok(n)
    }
}
