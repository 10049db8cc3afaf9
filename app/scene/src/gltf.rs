//! glTF 2.0, text and binary.
//!
//! The `gltf` crate reads and validates the JSON; buffers, accessors and pictures are read here, every range
//! checked: its own readers panic on damaged ones.

use std::borrow::Cow;
use std::collections::HashMap;
use std::io::Read;
use std::path::Path;

use base64::Engine as _;
use glam::{Mat3, Mat4, Vec2, Vec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::json::extensions::scene::khr_lights_punctual as khr_lights;
use gltf::json::validation::{Checked, Error as Fault, Validate as _};
use gltf::material::{PbrMetallicRoughness, PbrSpecularGlossiness};
use gltf::mesh::Mode;
use gltf::texture::{MagFilter, WrappingMode};
use gltf::{Document, Primitive, Semantic};

use super::error::{MAX_ELEMENTS, SceneError, file_size};
use super::gltf_motion::{Carried, Standing, place_carried};
use super::model::{Alpha, Material, Model, PointLight, Sky, Vertex, Viewpoint};
use super::motion::{Motion, MovingLight};
use super::palette::{paint, palette};
use super::repair::{NO_NORMAL, NO_UV, RawMesh, assemble};
use super::textures::{
    AlphaUse, Built, METAL_DIFFUSE_LOSS, Recipe, Source, TextureSet, diffuse_of_gloss, find_file, to_srgb,
};

/// Largest buffer, in bytes.
const MAX_BUFFER: u64 = 4 << 30;

/// The contents of a glTF file; sky and lights only if it states some.
#[derive(Debug)]
pub struct GltfScene {
    /// Triangles, materials and pictures.
    pub model: Model,
    /// The cameras of the scene.
    pub cameras: Vec<Viewpoint>,
    /// Its directional light as the sun.
    pub sky: Option<Sky>,
    /// Its point and spot lights, without their cones.
    pub lights: Option<Vec<PointLight>>,
    /// What moves. The rest is as it stands at time 0.
    pub motion: Motion,
}

/// Reads a `.gltf` or `.glb` file, with nodes, skins and morph targets as its animations begin.
///
/// Of several animations of the same node the first is taken, and each starts over where it ends. Cameras stand still.
///
/// Metallic-roughness materials become diffuse and specular colours; where a texture says what is metal, both are
/// computed pixel by pixel, and the roughness is its mean. So do specular-glossiness materials, which go before the
/// metallic-roughness that a file may state for readers that do not know them.
///
/// The colours of vertices are drawn where the material has no texture, one colour a triangle. They are left out where
/// it has one, as are samplers that clamp or mirror a texture: with a warning that names the material.
///
/// # Errors
/// [`SceneError`] for files that are damaged, incomplete or need extensions that change geometry (Draco, meshopt).
pub(crate) fn load_gltf(path: &Path) -> Result<GltfScene, SceneError> {
    let unusable = |what: String| SceneError::unusable(path, what);
    let damaged = |what: &str| unusable(format!("{what}; export the model again"));
    let bytes = read_file(path)?;
    // The crate subtracts the header's size from this length unseen.
    if bytes.starts_with(b"glTF")
        && bytes.get(8..12).is_none_or(|l| u32::from_le_bytes([l[0], l[1], l[2], l[3]]) < 20)
    {
        return Err(damaged("the binary header is cut off"));
    }
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice_without_validation(&bytes)
        .map_err(|e| damaged(&format!("this is not valid glTF 2.0 ({e})")))?;
    drop(bytes);
    check_extensions(path, &document)?;
    check(path, &document)?;

    let mut reader = Reader {
        path,
        buffers: buffers(path, &document, blob)?,
        textures: TextureSet::default(),
        images: HashMap::new(),
    };
    let mut materials = Vec::new();
    let mut wanted = Vec::new();
    for material in document.materials() {
        let (material, maps) = reader.material(&material)?;
        materials.push(material);
        wanted.push(maps);
    }
    // Behind the others: the one of primitives without.
    materials.push(Material::default());
    wanted.push(Wanted::default());
    let Nodes { mut meshes, colors, cameras, lamps, sun, mut motion, carried } =
        reader.nodes(&document, &mut wanted)?;
    let mut built = reader.textures.build()?;
    for (material, wanted) in materials.iter_mut().zip(&wanted) {
        wanted.apply(material, &built);
        if wanted.wrapped {
            log::warn!(
                "{}: the sampler of a texture of the material {} clamps or mirrors it; it is repeated instead",
                path.display(),
                material.name
            );
        }
    }
    paint_meshes(path, &mut meshes, &colors, &mut materials, &mut built);
    drop(colors);
    if !meshes.iter().any(|m| m.material == materials.len() - 1) {
        materials.pop();
    }
    let (mut model, placed) = assemble(path, meshes, materials)?;
    model.textures = built.images;
    place_carried(&carried, placed, &mut motion, &mut model);
    motion.sun = sun.and_then(|(_, _, mover)| mover);
    let sky = sun.map(|(forward, color, _)| Sky {
        sun_direction: -forward,
        sun_color: Sky::default().sun_color.max_element() * color / color.max_element().max(1e-6),
        ..Sky::default()
    });
    let lights = (!lamps.is_empty()).then(|| lights(lamps, &mut motion));
    if motion.is_still() {
        motion = Motion::default();
    }
    Ok(GltfScene { model, cameras, sky, lights, motion })
}

/// A point or spot light.
struct Lamp {
    position: Vec3,
    /// Candela, linear RGB.
    intensity: Vec3,
    /// Metres.
    range: Option<f32>,
    /// The node of [`Motion`] that carries it, if it moves.
    mover: Option<usize>,
}

/// The contents of a scene's nodes, in world space.
#[derive(Default)]
struct Nodes {
    meshes: Vec<RawMesh>,
    /// Vertex colours of each mesh; None if all vertices are white.
    colors: Vec<Option<Vec<Vec3>>>,
    cameras: Vec<Viewpoint>,
    lamps: Vec<Lamp>,
    /// Direction and colour of the first directional light, and the node of [`Motion`] that carries it, if it moves.
    sun: Option<(Vec3, Vec3, Option<usize>)>,
    motion: Motion,
    /// By [`RawMesh::moving`].
    carried: Vec<Carried>,
}

impl Nodes {
    fn add_light(
        &mut self,
        document: &Document,
        light: &gltf::khr_lights_punctual::Light,
        to_world: &Mat4,
        mover: Option<usize>,
    ) {
        let (position, forward) = placed(to_world);
        let stated = document.as_json().extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        let directional = stated
            .and_then(|l| l.lights.get(light.index()))
            .is_some_and(|l| matches!(l.type_, Checked::Valid(khr_lights::Type::Directional)));
        let color = Vec3::from(light.color()).max(Vec3::ZERO);
        if directional {
            self.sun = self.sun.or(Some((forward, color, mover)));
        } else if position.is_finite() && light.intensity() > 0.0 && color.is_finite() {
            let intensity = color * light.intensity();
            self.lamps.push(Lamp { position, intensity, range: light.range(), mover });
        }
    }
}

/// A node's position, and the direction of its camera or light.
fn placed(to_world: &Mat4) -> (Vec3, Vec3) {
    let forward = to_world.transform_vector3(Vec3::NEG_Z).normalize_or(Vec3::NEG_Z);
    (to_world.w_axis.truncate(), forward)
}

/// Draws the colours of vertices as those of a palette, where materials have no texture that needs the texture
/// coordinates, and warns of the others.
fn paint_meshes(
    path: &Path,
    meshes: &mut [RawMesh],
    colors: &[Option<Vec<Vec3>>],
    materials: &mut [Material],
    built: &mut Built,
) {
    let mut painted = vec![false; materials.len()];
    for (mesh, _) in meshes.iter().zip(colors).filter(|(_, colors)| colors.is_some()) {
        painted[mesh.material] = true;
    }
    for (material, painted) in materials.iter_mut().zip(&mut painted).filter(|(_, painted)| **painted) {
        let maps = [material.diffuse_map, material.specular_map, material.emissive_map, material.normal_map];
        if maps.iter().any(Option::is_some) {
            *painted = false;
            log::warn!(
                "{}: the colours of vertices are left out where the material is {}, which has textures",
                path.display(),
                material.name
            );
        } else {
            material.diffuse_map = Some(built.images.len());
        }
    }
    if !painted.contains(&true) {
        return;
    }
    built.images.push(palette());
    for (mesh, colors) in meshes.iter_mut().zip(colors).filter(|(mesh, _)| painted[mesh.material]) {
        let former = paint(&mut mesh.vertices, &mut mesh.indices, |corners| match colors {
            Some(colors) => {
                let mean = corners.into_iter().map(|i| colors[i as usize]).sum::<Vec3>() / 3.0;
                Vec3::from(mean.to_array().map(to_srgb))
            }
            None => Vec3::ONE,
        });
        mesh.split(&former);
    }
}

/// glTF states candela without saying how bright the picture is to be, and exporters disagree by orders of
/// magnitude: the brightest light is made one that lights a room, the others in proportion. Brightest first; those
/// that move go into the motion.
fn lights(mut lamps: Vec<Lamp>, motion: &mut Motion) -> Vec<PointLight> {
    let brightest = lamps.iter().map(|l| l.intensity.max_element()).fold(1e-6, f32::max);
    lamps.sort_by(|a, b| b.intensity.max_element().total_cmp(&a.intensity.max_element()));
    motion.lights = (0..)
        .zip(&lamps)
        .filter_map(|(light, lamp)| Some(MovingLight { light, node: lamp.mover?, position: Vec3::ZERO }))
        .collect();
    lamps
        .into_iter()
        .map(|Lamp { position, intensity, range, .. }| {
            let color = intensity * (8.0 / brightest);
            let fades = (color.max_element() / 0.01).sqrt().max(1.0);
            PointLight {
                position,
                color,
                range: range.filter(|r| r.is_finite() && *r > 0.0).map_or(fades, |r| r.min(fades)),
            }
        })
        .collect()
}

fn read_file(path: &Path) -> Result<Vec<u8>, SceneError> {
    let size = file_size(path)?;
    if size > MAX_BUFFER {
        return Err(SceneError::unusable(
            path,
            format!("it has {size} bytes, at most {MAX_BUFFER} can be read: split the model"),
        ));
    }
    let read = |source| SceneError::Read { path: path.into(), source };
    let mut bytes = Vec::new();
    yoro_files::open(path).map_err(read)?.take(MAX_BUFFER).read_to_end(&mut bytes).map_err(read)?;
    Ok(bytes)
}

/// Refuses what cannot be read. Before everything else: what such an extension leaves out may look like a mistake.
fn check_extensions(path: &Path, document: &Document) -> Result<(), SceneError> {
    let root = document.as_json();
    // Materials look plainer without their extensions; geometry cannot be read.
    let readable = |e: &str| {
        e.starts_with("KHR_materials_")
            || [
                "KHR_texture_transform",
                "KHR_lights_punctual",
                "KHR_mesh_quantization",
                "EXT_texture_webp",
                "KHR_texture_basisu",
            ]
            .contains(&e)
    };
    match root.extensions_required.iter().find(|e| !readable(e)) {
        Some(e) => Err(SceneError::unusable(
            path,
            format!("it needs the extension {e}, which is not supported: export the model without it"),
        )),
        None => Ok(()),
    }
}

/// The crate's validation, except for extensions, and what it does not check but relies on.
fn check(path: &Path, document: &Document) -> Result<(), SceneError> {
    let root = document.as_json();
    let mut fault = None;
    // The validation itself indexes with these unseen.
    let primitives =
        root.meshes.iter().enumerate().flat_map(|(i, m)| m.primitives.iter().map(move |p| (i, p)));
    for (i, p) in primitives {
        if p.attributes.values().any(|a| a.value() >= root.accessors.len()) {
            return Err(SceneError::unusable(
                path,
                format!("mesh {i} names an accessor that does not exist; export the model again"),
            ));
        }
    }
    root.validate(root, gltf::json::Path::new, &mut |at, error| {
        let at = at().to_string();
        // Bounds of positions, and positions themselves, may be left out: nothing here needs them. An accessor
        // without a buffer view is all zeros.
        let needless = error == Fault::Missing
            && ([".min", ".max", "[\"POSITION\"]"].iter().any(|e| at.ends_with(e))
                || at.starts_with("accessors[") && at.ends_with(".bufferView"));
        if error != Fault::Unsupported && !needless && fault.is_none() {
            fault = Some(format!("{at}: {error}"));
        }
    });
    for (i, image) in root.images.iter().enumerate() {
        if image.uri.is_none() && (image.buffer_view.is_none() || image.mime_type.is_none()) {
            fault = fault.or(Some(format!("images[{i}] has no data or no type")));
        }
    }
    // The validation leaves out the targets of animations.
    for (i, animation) in root.animations.iter().enumerate() {
        for (k, target) in animation.channels.iter().map(|channel| &channel.target).enumerate() {
            if target.node.value() >= root.nodes.len() {
                fault =
                    fault.or(Some(format!("channel {k} of animation {i} moves a node that does not exist")));
            }
            if target.path == Checked::Invalid {
                fault = fault.or(Some(format!("channel {k} of animation {i} has an unknown path")));
            }
        }
    }
    if let Some(fault) = fault {
        return Err(SceneError::unusable(
            path,
            format!("this is no valid glTF 2.0 ({fault}); export the model again"),
        ));
    }
    Ok(())
}

/// The bytes of all buffers.
fn buffers(path: &Path, document: &Document, mut blob: Option<Vec<u8>>) -> Result<Vec<Vec<u8>>, SceneError> {
    document
        .buffers()
        .map(|buffer| {
            let data = match buffer.source() {
                gltf::buffer::Source::Bin => blob.take().ok_or_else(|| {
                    SceneError::unusable(path, "its binary part is missing; export the model again")
                })?,
                gltf::buffer::Source::Uri(uri) => match data_uri(uri) {
                    Some(data) => data.ok_or_else(|| {
                        SceneError::unusable(path, "an embedded buffer is damaged; export the model again")
                    })?,
                    None => read_file(&external(path, uri).ok_or_else(|| {
                        SceneError::unusable(
                            path,
                            format!("its buffer {uri} is missing: put it beside the file"),
                        )
                    })?)?,
                },
            };
            if data.len() < buffer.length() {
                let what = format!(
                    "buffer {} has {} bytes instead of {}; copy or export it again",
                    buffer.index(),
                    data.len(),
                    buffer.length()
                );
                return Err(SceneError::unusable(path, what));
            }
            Ok(data)
        })
        .collect()
}

/// The bytes of a `data:` URI, none inside if they are damaged; none for other URIs.
fn data_uri(uri: &str) -> Option<Option<Vec<u8>>> {
    let (head, data) = uri.strip_prefix("data:")?.split_once(',')?;
    Some(if head.ends_with(";base64") {
        base64::engine::general_purpose::STANDARD.decode(data.trim()).ok()
    } else {
        Some(percent_decoded(data))
    })
}

fn percent_decoded(text: &str) -> Vec<u8> {
    let bytes = text.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut i = 0;
    while i < bytes.len() {
        let code = (bytes[i] == b'%').then(|| bytes.get(i + 1..i + 3)).flatten();
        let byte =
            code.and_then(|c| std::str::from_utf8(c).ok()).and_then(|c| u8::from_str_radix(c, 16).ok());
        out.push(byte.unwrap_or(bytes[i]));
        i += if byte.is_some() { 3 } else { 1 };
    }
    out
}

fn external(path: &Path, uri: &str) -> Option<std::path::PathBuf> {
    let folder = path.parent().unwrap_or(Path::new(""));
    find_file(folder, &String::from_utf8_lossy(&percent_decoded(uri))).or_else(|| find_file(folder, uri))
}

/// The textures of one material, by their number in the [`TextureSet`].
#[derive(Default)]
struct Wanted {
    diffuse: Option<usize>,
    specular: Option<usize>,
    emissive: Option<usize>,
    normal: Option<usize>,
    /// The roughness at texture values 0 and 1, if the roughness is the mean of a texture.
    roughness: Option<[f32; 2]>,
    blended: bool,
    /// A sampler clamps or mirrors one of the textures.
    unrepeated: bool,
    /// And texture coordinates show it.
    wrapped: bool,
    /// Set of texture coordinates and their transform; those of the base colour for all.
    set: u32,
    placement: Option<[Vec2; 3]>,
}

impl Wanted {
    /// Takes the texture coordinates of the material's main map, or those of the first other map that it has.
    fn take_coordinates(&mut self, material: &gltf::Material, main: Option<&gltf::texture::Info>) {
        let Some(info) = main else {
            let emissive = material.emissive_texture().map(|i| i.tex_coord());
            let normal = || material.normal_texture().map(|n| n.tex_coord());
            self.set = emissive.or_else(normal).unwrap_or(0);
            return;
        };
        self.set = info.tex_coord();
        if let Some(t) = info.texture_transform() {
            self.set = t.tex_coord().unwrap_or(self.set);
            let (sin, cos) = t.rotation().sin_cos();
            let scale = t.scale();
            self.placement =
                Some([Vec2::new(cos, -sin) * scale[0], Vec2::new(sin, cos) * scale[1], t.offset().into()]);
        }
    }

    fn apply(&self, material: &mut Material, built: &Built) {
        material.diffuse_map = built.index(self.diffuse);
        material.specular_map = built.index(self.specular);
        material.emissive_map = built.index(self.emissive);
        material.normal_map = built.index(self.normal);
        if let (Some([least, most]), Some(map)) = (self.roughness, built.get(self.specular)) {
            material.roughness = (least + (most - least) * map.roughness).clamp(0.0, 1.0);
        }
        if let (true, Alpha::Blend(opacity)) = (self.blended && self.diffuse.is_some(), material.alpha) {
            // Exporters mark as blended whatever has an alpha channel; leaves are better cut out.
            material.alpha = match built.get(self.diffuse).map(|f| f.alpha) {
                Some(AlphaUse::Mask) if opacity >= 1.0 => Alpha::Cutout(0.5),
                Some(AlphaUse::Opaque) | None if opacity >= 1.0 => Alpha::Opaque,
                _ => Alpha::Blend(opacity),
            };
        }
    }
}

/// Applies the columns of a texture transform (KHR_texture_transform), which counts rows from the top.
fn place(mesh: &mut RawMesh, placement: Option<[Vec2; 3]>) {
    let [x, y, offset] = placement.unwrap_or([Vec2::X, Vec2::Y, Vec2::ZERO]);
    for v in &mut mesh.vertices {
        let uv = x * v.uv.x + y * v.uv.y + offset;
        v.uv = Vec2::new(uv.x, 1.0 - uv.y);
    }
}

/// A picture and how it is sampled.
struct Map {
    source: Source,
    /// Unfiltered when magnified.
    nearest: bool,
}

/// A surface of either material model: colours in linear RGB, which are factors of the maps if there are any.
struct Surface {
    diffuse: Vec3,
    specular: Vec3,
    roughness: f32,
    opacity: f32,
}

/// A factor from 0 to 1; 1 if it is no number.
fn unit(v: f32) -> f32 {
    if v.is_finite() { v.clamp(0.0, 1.0) } else { 1.0 }
}

/// The textures of a material's colour, and of metalness and roughness or gloss.
fn surface_textures<'a>(m: &gltf::Material<'a>) -> [Option<gltf::texture::Info<'a>>; 2] {
    match m.pbr_specular_glossiness() {
        Some(gloss) => [gloss.diffuse_texture(), gloss.specular_glossiness_texture()],
        None => {
            let pbr = m.pbr_metallic_roughness();
            [pbr.base_color_texture(), pbr.metallic_roughness_texture()]
        }
    }
}

pub(super) struct Reader<'a> {
    pub(super) path: &'a Path,
    buffers: Vec<Vec<u8>>,
    textures: TextureSet,
    /// Sources of pictures by their number.
    images: HashMap<usize, Option<Source>>,
}

impl Reader<'_> {
    pub(super) fn damaged(&self, what: String) -> SceneError {
        SceneError::unusable(self.path, format!("{what}; export the model again"))
    }

    fn view(&self, view: &gltf::buffer::View) -> Result<&[u8], SceneError> {
        let end = view.offset().checked_add(view.length());
        let range = end.and_then(|end| self.buffers.get(view.buffer().index())?.get(view.offset()..end));
        range.ok_or_else(|| self.damaged(format!("buffer view {} reaches beyond its buffer", view.index())))
    }

    fn source(&mut self, texture: gltf::Texture) -> Result<Option<Source>, SceneError> {
        let Some(image) = texture.source() else {
            log::warn!(
                "{}: texture {} is in a format that is not supported; it is left out",
                self.path.display(),
                texture.index()
            );
            return Ok(None);
        };
        if let Some(known) = self.images.get(&image.index()) {
            return Ok(known.clone());
        }
        let name = image
            .name()
            .filter(|n| !n.is_empty())
            .map_or_else(|| format!("image-{}", image.index()), |n| n.replace('/', "_"));
        let embedded = match image.source() {
            gltf::image::Source::View { view, .. } => Some(self.view(&view)?.to_vec()),
            gltf::image::Source::Uri { uri, .. } => match data_uri(uri) {
                Some(data) => {
                    Some(data.ok_or_else(|| self.damaged(format!("the embedded picture {name} is damaged")))?)
                }
                None => None,
            },
        };
        let source = match (embedded, image.source()) {
            (Some(bytes), _) => {
                self.textures.memory.push((self.path.join(name), bytes));
                Some(Source::Memory(self.textures.memory.len() - 1))
            }
            (None, gltf::image::Source::Uri { uri, .. }) => {
                let found = external(self.path, uri).map(Source::File);
                if found.is_none() {
                    log::warn!("{}: the texture {uri} is missing", self.path.display());
                }
                found
            }
            (None, gltf::image::Source::View { .. }) => None,
        };
        self.images.insert(image.index(), source.clone());
        Ok(source)
    }

    /// The default scene's nodes, or all of a file without scenes. `wanted` is by material, last that of primitives
    /// without one.
    fn nodes(&self, document: &Document, wanted: &mut [Wanted]) -> Result<Nodes, SceneError> {
        let mut nodes = Nodes::default();
        let mut corners = 0;
        let mut moves = self.moves(document)?;
        for at in 0..moves.standing.len() {
            let Standing { node, to_world, mover } = moves.standing[at].clone();
            if let Some(mesh) = node.mesh() {
                let name = node.name().or(mesh.name()).unwrap_or("mesh");
                for primitive in mesh.primitives() {
                    let carried = self.carried(&mut moves, at, &mesh, &primitive)?;
                    let standing = match &carried {
                        // Left in the frame of what carries it, and turned round if that mirrors it.
                        Some(carried) => (Mat4::IDENTITY, carried.mirrored),
                        None => (to_world, to_world.determinant() < 0.0),
                    };
                    let Some(mut raw) = self.primitive(&primitive, standing)? else { continue };
                    corners += raw.indices.len().max(raw.vertices.len());
                    if corners > MAX_ELEMENTS {
                        return Err(SceneError::TooLarge {
                            path: self.path.into(),
                            limit: MAX_ELEMENTS,
                            what: "corners of triangles",
                        });
                    }
                    if let Some(carried) = carried {
                        raw.moving = Some(nodes.carried.len());
                        raw.sources = (0..raw.vertices.len() as u32).collect();
                        nodes.carried.push(carried);
                    }
                    raw.name = name.into();
                    raw.material = primitive.material().index().unwrap_or(wanted.len() - 1);
                    let wanted = &mut wanted[raw.material];
                    place(&mut raw, wanted.placement);
                    let within = |uv: Vec2| !uv.is_finite() || (uv - 0.5).abs().max_element() < 0.501;
                    wanted.wrapped |= wanted.unrepeated && !raw.vertices.iter().all(|v| within(v.uv));
                    nodes.colors.push(self.colors(&primitive)?.filter(|c| c.len() == raw.vertices.len()));
                    nodes.meshes.push(raw);
                }
            }
            let (position, forward) = placed(&to_world);
            if node.camera().is_some() && position.is_finite() {
                nodes.cameras.push(Viewpoint { position, target: position + forward * 4.0 });
            }
            if let Some(light) = node.light() {
                nodes.add_light(document, &light, &to_world, mover);
            }
        }
        nodes.motion = moves.motion;
        Ok(nodes)
    }

    /// The picture of a texture with its sampler.
    fn map(&mut self, texture: gltf::Texture, wanted: &mut Wanted) -> Result<Option<Map>, SceneError> {
        let sampler = texture.sampler();
        wanted.unrepeated |= [sampler.wrap_s(), sampler.wrap_t()].iter().any(|w| *w != WrappingMode::Repeat);
        let nearest = sampler.mag_filter() == Some(MagFilter::Nearest);
        Ok(self.source(texture)?.map(|source| Map { source, nearest }))
    }

    fn request(&mut self, map: Option<Map>, recipe: impl FnOnce(Source) -> Recipe) -> Option<usize> {
        map.map(|map| self.textures.request_sampled(recipe(map.source), map.nearest))
    }

    fn material(&mut self, m: &gltf::Material) -> Result<(Material, Wanted), SceneError> {
        let srgb = |v: Vec3| Vec3::from(v.to_array().map(to_srgb));
        let mut wanted = Wanted::default();

        let [color_info, surface_info] = surface_textures(m);
        wanted.take_coordinates(m, color_info.as_ref().or(surface_info.as_ref()));
        let color = color_info.map_or(Ok(None), |i| self.map(i.texture(), &mut wanted))?;
        let surface = surface_info.map_or(Ok(None), |i| self.map(i.texture(), &mut wanted))?;
        let normal = m.normal_texture().map_or(Ok(None), |n| self.map(n.texture(), &mut wanted))?;
        let emissive_map = m.emissive_texture().map_or(Ok(None), |i| self.map(i.texture(), &mut wanted))?;

        let Surface { diffuse, specular, roughness, opacity } = match m.pbr_specular_glossiness() {
            Some(gloss) => self.gloss(&gloss, color, surface, &mut wanted),
            None => self.metal(&m.pbr_metallic_roughness(), color, surface, &mut wanted),
        };
        let strength = m.normal_texture().map_or(1.0, |n| n.scale());
        wanted.normal = self.request(normal, |source| Recipe::Bump {
            source,
            strength: strength.to_bits(),
            normal: true,
        });
        wanted.emissive = self.request(emissive_map, Recipe::Color);
        let glow = Vec3::from(m.emissive_factor()) * m.emissive_strength().unwrap_or(1.0);
        let alpha = match m.alpha_mode() {
            gltf::material::AlphaMode::Opaque => Alpha::Opaque,
            gltf::material::AlphaMode::Mask => Alpha::Cutout(unit(m.alpha_cutoff().unwrap_or(0.5))),
            gltf::material::AlphaMode::Blend => {
                wanted.blended = true;
                if opacity >= 1.0 && wanted.diffuse.is_none() { Alpha::Opaque } else { Alpha::Blend(opacity) }
            }
        };
        let material = Material {
            name: m.name().map_or_else(|| format!("material-{}", m.index().unwrap_or(0)), str::to_owned),
            diffuse: srgb(diffuse),
            specular: srgb(specular),
            emissive: if glow.is_finite() { srgb(glow.max(Vec3::ZERO)) } else { Vec3::ZERO },
            roughness,
            alpha,
            double_sided: m.double_sided(),
            ..Material::default()
        };
        Ok((material, wanted))
    }

    fn metal(
        &mut self,
        pbr: &PbrMetallicRoughness,
        base_map: Option<Map>,
        orm: Option<Map>,
        wanted: &mut Wanted,
    ) -> Surface {
        let [r, g, b, opacity] = pbr.base_color_factor().map(unit);
        let base = Vec3::new(r, g, b);
        let (metallic, roughness) = (unit(pbr.metallic_factor()), unit(pbr.roughness_factor()));
        match orm {
            Some(orm) if metallic > 0.0 => {
                let nearest = base_map.as_ref().unwrap_or(&orm).nearest;
                let recipe = |specular| Recipe::Metal {
                    base: base_map.as_ref().map(|m| m.source.clone()),
                    base_factor: base.to_array().map(f32::to_bits),
                    orm: orm.source.clone(),
                    metallic: metallic.to_bits(),
                    specular,
                };
                wanted.diffuse = Some(self.textures.request_sampled(recipe(false), nearest));
                wanted.specular = Some(self.textures.request_sampled(recipe(true), nearest));
                wanted.roughness = Some([0.0, roughness]);
                Surface { diffuse: base, specular: Vec3::ONE, roughness, opacity }
            }
            _ => {
                wanted.diffuse = self.request(base_map, Recipe::Color);
                let diffuse = base * (1.0 - METAL_DIFFUSE_LOSS * metallic);
                Surface { diffuse, specular: Vec3::splat(0.04).lerp(base, metallic), roughness, opacity }
            }
        }
    }

    fn gloss(
        &mut self,
        pbr: &PbrSpecularGlossiness,
        diffuse_map: Option<Map>,
        gloss: Option<Map>,
        wanted: &mut Wanted,
    ) -> Surface {
        let [r, g, b, opacity] = pbr.diffuse_factor().map(unit);
        let factors = [Vec3::new(r, g, b), Vec3::from(pbr.specular_factor().map(unit))];
        let roughness = 1.0 - unit(pbr.glossiness_factor());
        let diffuse = match gloss {
            Some(gloss) => {
                let [diffuse_factor, specular_factor] = factors.map(|f| f.to_array().map(f32::to_bits));
                let recipe = Recipe::Gloss {
                    diffuse: diffuse_map.as_ref().map(|m| m.source.clone()),
                    diffuse_factor,
                    gloss: gloss.source.clone(),
                    specular_factor,
                };
                let nearest = diffuse_map.as_ref().unwrap_or(&gloss).nearest;
                wanted.diffuse = Some(self.textures.request_sampled(recipe, nearest));
                wanted.specular = self.request(Some(gloss), Recipe::Specular);
                wanted.roughness = Some([roughness, 1.0]);
                Vec3::ONE
            }
            None => {
                wanted.diffuse = self.request(diffuse_map, Recipe::Color);
                diffuse_of_gloss(factors[0], factors[1])
            }
        };
        Surface { diffuse, specular: factors[1], roughness, opacity }
    }

    /// The triangles of a primitive, transformed, and turned round to show their other sides if `turned`.
    fn primitive(
        &self,
        primitive: &Primitive,
        (to_world, turned): (Mat4, bool),
    ) -> Result<Option<RawMesh>, SceneError> {
        let Some(positions) = primitive.get(&Semantic::Positions) else { return Ok(None) };
        let positions = self.floats::<3>(&positions, &[Dimensions::Vec3])?;
        let normals = primitive
            .get(&Semantic::Normals)
            .map(|a| self.floats::<3>(&a, &[Dimensions::Vec3]))
            .transpose()?
            .unwrap_or_default();
        let set = self.texture_set(primitive);
        let uvs = primitive
            .get(&Semantic::TexCoords(set))
            .map(|a| self.floats::<2>(&a, &[Dimensions::Vec2]))
            .transpose()?
            .unwrap_or_default();
        let linear = Mat3::from_mat4(to_world);
        // Normals turn with the inverse transpose; the cofactors are that without the division.
        let normal_matrix = Mat3::from_cols(
            linear.y_axis.cross(linear.z_axis),
            linear.z_axis.cross(linear.x_axis),
            linear.x_axis.cross(linear.y_axis),
        ) * if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
        let vertices: Vec<Vertex> = positions
            .iter()
            .enumerate()
            .map(|(i, p)| Vertex {
                position: to_world.transform_point3((*p).into()),
                normal: normals.get(i).map_or(NO_NORMAL, |n| normal_matrix * Vec3::from(*n)),
                uv: uvs.get(i).map_or(NO_UV, |t| (*t).into()),
            })
            .collect();
        let list = match primitive.indices() {
            Some(accessor) => self.indices(&accessor, vertices.len())?,
            None => (0..vertices.len() as u32).collect(),
        };
        let mut indices = match primitive.mode() {
            Mode::Triangles => list,
            Mode::TriangleStrip => {
                let odd_turned = |(i, t): (usize, &[u32])| {
                    if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] }
                };
                list.windows(3).enumerate().flat_map(odd_turned).collect()
            }
            Mode::TriangleFan => match list.split_first() {
                Some((&center, rim)) => rim.windows(2).flat_map(|t| [center, t[0], t[1]]).collect(),
                None => Vec::new(),
            },
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => return Ok(None),
        };
        indices.truncate(indices.len() / 3 * 3);
        if turned {
            indices.chunks_exact_mut(3).for_each(|t| t.swap(1, 2));
        }
        // The specification wants flat normals where none are given.
        Ok(Some(RawMesh { vertices, indices, flat: true, ..RawMesh::default() }))
    }

    fn texture_set(&self, primitive: &Primitive) -> u32 {
        let [color, surface] = surface_textures(&primitive.material());
        color
            .or(surface)
            .map_or(0, |i| i.texture_transform().and_then(|t| t.tex_coord()).unwrap_or(i.tex_coord()))
    }

    /// The colours of a primitive's vertices, linear RGB; none if there are none, or if all are white.
    fn colors(&self, primitive: &Primitive) -> Result<Option<Vec<Vec3>>, SceneError> {
        let Some(accessor) = primitive.get(&Semantic::Colors(0)) else { return Ok(None) };
        let colors = self.floats::<3>(&accessor, &[Dimensions::Vec3, Dimensions::Vec4])?;
        let colors: Vec<Vec3> = colors.into_iter().map(|c| Vec3::from(c.map(unit))).collect();
        Ok(colors.iter().any(|c| *c != Vec3::ONE).then_some(colors))
    }

    /// The bytes of `count` elements from `offset` in a view, with `stride` between their starts.
    fn stored(
        &self,
        accessor: &gltf::Accessor,
        view: &gltf::buffer::View,
        [offset, count, size]: [usize; 3],
    ) -> Result<(&[u8], usize), SceneError> {
        let stride = view.stride().unwrap_or(size);
        let length = count.checked_sub(1).map_or(Some(0), |n| n.checked_mul(stride)?.checked_add(size));
        let end = length.and_then(|n| n.checked_add(offset));
        let data = end.and_then(|end| self.view(view).ok()?.get(offset..end));
        match data {
            Some(data) if stride >= size => Ok((data, stride)),
            _ => Err(self.damaged(format!("accessor {} reaches beyond its buffer", accessor.index()))),
        }
    }

    /// The bytes of an accessor's elements, one after the other with `stride` between their starts. Without a buffer
    /// view all are zero; those of a sparse accessor are put in their places.
    fn elements(&self, accessor: &gltf::Accessor) -> Result<(Cow<'_, [u8]>, usize), SceneError> {
        let (count, size) = (accessor.count(), accessor.size());
        let base = accessor
            .view()
            .map(|view| self.stored(accessor, &view, [accessor.offset(), count, size]))
            .transpose()?;
        if let (Some((data, stride)), None) = (base, accessor.sparse()) {
            return Ok((Cow::Borrowed(data), stride));
        }
        if count > MAX_ELEMENTS {
            return Err(SceneError::TooLarge {
                path: self.path.into(),
                limit: MAX_ELEMENTS,
                what: "elements in an accessor",
            });
        }
        let mut elements = match base {
            Some((data, stride)) => {
                (0..count).flat_map(|i| &data[i * stride..i * stride + size]).copied().collect()
            }
            None => vec![0; count * size],
        };
        let Some(sparse) = accessor.sparse() else { return Ok((elements.into(), size)) };
        let (indices, values) = (sparse.indices(), sparse.values());
        let width = indices.index_type().size();
        let (places, places_stride) =
            self.stored(accessor, &indices.view(), [indices.offset(), sparse.count(), width])?;
        let (data, stride) =
            self.stored(accessor, &values.view(), [values.offset(), sparse.count(), size])?;
        for i in 0..sparse.count() {
            let place = &places[i * places_stride..][..width];
            let place = place.iter().rev().fold(0, |place, &byte| place << 8 | usize::from(byte));
            let Some(element) = elements.chunks_exact_mut(size).nth(place) else {
                let what = format!("accessor {} replaces elements that do not exist", accessor.index());
                return Err(self.damaged(what));
            };
            element.copy_from_slice(&data[i * stride..i * stride + size]);
        }
        Ok((elements.into(), size))
    }

    /// The first N components of vectors of one of the `wanted` kinds.
    pub(super) fn floats<const N: usize>(
        &self,
        accessor: &gltf::Accessor,
        wanted: &[Dimensions],
    ) -> Result<Vec<[f32; N]>, SceneError> {
        if !wanted.contains(&accessor.dimensions()) {
            return Err(self.damaged(format!("accessor {} has the wrong type", accessor.index())));
        }
        let (data, stride) = self.elements(accessor)?;
        let kind = accessor.data_type();
        let width = kind.size();
        let scale = if accessor.normalized() {
            match kind {
                DataType::I8 => 1.0 / 127.0,
                DataType::U8 => 1.0 / 255.0,
                DataType::I16 => 1.0 / 32767.0,
                DataType::U16 => 1.0 / 65535.0,
                DataType::U32 | DataType::F32 => 1.0,
            }
        } else {
            1.0
        };
        let value = |b: &[u8]| match kind {
            DataType::I8 => b[0] as i8 as f32,
            DataType::U8 => b[0] as f32,
            DataType::I16 => i16::from_le_bytes([b[0], b[1]]) as f32,
            DataType::U16 => u16::from_le_bytes([b[0], b[1]]) as f32,
            DataType::U32 => u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32,
            DataType::F32 => f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        };
        Ok((0..accessor.count())
            .map(|i| std::array::from_fn(|k| value(&data[i * stride + k * width..]) * scale))
            .collect())
    }

    fn indices(&self, accessor: &gltf::Accessor, vertices: usize) -> Result<Vec<u32>, SceneError> {
        let (data, stride) = self.elements(accessor)?;
        let at = |i: usize| {
            let b = &data[i * stride..];
            Some(match (accessor.dimensions(), accessor.data_type()) {
                (Dimensions::Scalar, DataType::U8) => b[0] as u32,
                (Dimensions::Scalar, DataType::U16) => u16::from_le_bytes([b[0], b[1]]) as u32,
                (Dimensions::Scalar, DataType::U32) => u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
                _ => return None,
            })
        };
        let list: Option<Vec<u32>> =
            (0..accessor.count()).map(at).map(|i| i.filter(|&i| (i as usize) < vertices)).collect();
        list.ok_or_else(|| {
            self.damaged(format!("accessor {} names vertices that do not exist", accessor.index()))
        })
    }
}
