//! Reads glTF 2.0, text and binary.
//!
//! The `gltf` crate reads and validates the JSON. Buffers, accessors and pictures are read here, with every range
//! checked, because the crate's own readers panic on damaged ones.

mod file;
mod instances;
mod material;
mod motion;
mod primitive;
mod reader;

use std::collections::{HashMap, HashSet};
use std::iter::repeat_n;
use std::path::Path;
use std::rc::Rc;

use glam::{DVec3, Mat4, Vec2, Vec3};
use gltf::Document;
use gltf::json::extensions::scene::khr_lights_punctual as khr_lights;
use gltf::json::validation::Checked;

use self::file::{buffers, check, check_extensions, compression, parse, read_file};
use self::material::MaterialTextures;
use self::motion::{Carried, Standing, place_carried};
use self::primitive::transform;
use self::reader::Reader;
use super::error::{MAX_ELEMENTS, SceneError};
use super::load::Loaded;
use super::model::{Material, PointLight, Sky, Viewpoint};
use super::motion::{Motion, MovingLight};
use super::palette::{paint, palette};
use super::repair::{RawMesh, assemble};
use super::textures::{Built, TextureSet, to_srgb};

/// Reads a `.gltf` or `.glb` file, with nodes, skins and morph targets in their state at the start of the animations.
///
/// Of several animations of the same node, the first is used, or `animation` alone, by its name or number; each repeats
/// from its end. Cameras stand still. Instances (EXT_mesh_gpu_instancing) are triangles like all others.
///
/// Metallic-roughness materials become diffuse and specular colours. If a texture says what is metal, both are computed
/// pixel by pixel, and the roughness is the texture's mean. Specular-glossiness materials are treated likewise, and
/// take precedence over the metallic-roughness that a file may contain for readers without them.
///
/// Vertex colours are drawn if the material has no texture, with one colour per triangle. They are ignored if it has
/// one, as are samplers that clamp or mirror a texture, and texture coordinates that differ from those of the base
/// colour, with a warning that names the material.
///
/// # Errors
/// [`SceneError`] for files that are damaged, incomplete or need extensions that change geometry (Draco, meshopt).
pub(crate) fn load_gltf(path: &Path, animation: Option<&str>) -> Result<Loaded, SceneError> {
    let (document, blob) = parse(path, &read_file(path)?)?;
    check_extensions(path, &document)?;
    check(path, &document)?;

    let mut reader = Reader {
        path,
        buffers: buffers(path, &document, blob)?,
        textures: TextureSet::default(),
        images: HashMap::new(),
        pictures: document.images().map(|image| picture_name(&image)).collect(),
        unknown: HashSet::new(),
        animation,
    };
    let mut materials = Vec::new();
    let mut wanted = Vec::new();
    for material in document.materials() {
        let (material, maps) = reader.material(&material)?;
        materials.push(material);
        wanted.push(maps);
    }
    // Last is the material of primitives without one.
    materials.push(Material::default());
    wanted.push(MaterialTextures::default());
    let Nodes { mut meshes, colors, cameras, lamps, sun, mut motion, carried, subtracted } =
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
    let is_masked = meshes.is_empty() && wanted.iter().any(|material| material.invisible);
    let (mut model, placed) =
        assemble(path, meshes, materials).map_err(|error| match compression(&document) {
            _ if is_masked => SceneError::unusable(
                path,
                "nothing of it can be seen: raise the opacity of its materials, or lower their alpha cutoff",
            ),
            Some(extension) => SceneError::unusable(
                path,
                format!(
                    "its triangles are compressed by {extension}, which is not supported: export the model without it"
                ),
            ),
            None => error,
        })?;
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
    Ok(Loaded { model, cameras, sky, lights, motion, subtracted })
}

/// A point or spot light.
struct Lamp {
    position: Vec3,
    /// Candela, linear RGB.
    intensity: Vec3,
    /// Metres.
    range: Option<f32>,
    /// The node of [`Motion`] that carries the light, if it moves.
    mover: Option<usize>,
}

/// The contents of a scene's nodes, in world space.
#[derive(Default)]
struct Nodes {
    meshes: Vec<RawMesh>,
    /// Vertex colours of each mesh; `None` if all vertices are white.
    colors: Vec<Option<Rc<Vec<Vec3>>>>,
    cameras: Vec<Viewpoint>,
    lamps: Vec<Lamp>,
    /// Direction and colour of the first directional light, and the node of [`Motion`] that carries it, if it moves.
    sun: Option<(Vec3, Vec3, Option<usize>)>,
    motion: Motion,
    /// What carries meshes, by [`RawMesh::moving`].
    carried: Vec<Carried>,
    /// See [`Loaded::subtracted`].
    subtracted: DVec3,
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

/// Returns the name of a picture for messages, without folders.
fn picture_name(image: &gltf::Image) -> String {
    let file = match image.source() {
        gltf::image::Source::Uri { uri, .. } if !uri.starts_with("data:") => uri.rsplit('/').next(),
        _ => None,
    };
    let name = image.name().filter(|name| !name.is_empty()).map(|name| name.replace('/', "_"));
    name.or(file.map(str::to_owned)).unwrap_or_else(|| format!("image-{}", image.index()))
}

/// Returns a node's position, and the direction of its camera or light.
fn placed(to_world: &Mat4) -> (Vec3, Vec3) {
    let forward = to_world.transform_vector3(Vec3::NEG_Z).normalize_or(Vec3::NEG_Z);
    (to_world.w_axis.truncate(), forward)
}

/// Draws vertex colours from a palette, if the material has no texture that needs the texture coordinates, and warns
/// about the others.
fn paint_meshes(
    path: &Path,
    meshes: &mut [RawMesh],
    colors: &[Option<Rc<Vec<Vec3>>>],
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
        let previous = paint(&mut mesh.vertices, &mut mesh.indices, |corners| match colors {
            Some(colors) => {
                let mean = corners.into_iter().map(|i| colors[i as usize]).sum::<Vec3>() / 3.0;
                Vec3::from(mean.to_array().map(to_srgb))
            }
            None => Vec3::ONE,
        });
        mesh.split(&previous);
    }
}

/// Returns the lights, brightest first, and adds those that move to the motion. glTF gives candela without saying how
/// bright the picture should be, and exporters disagree by orders of magnitude. So the brightest light is scaled to one
/// that lights a room, and the others in proportion.
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

/// Applies the columns of a texture transform (KHR_texture_transform), which counts rows from the top.
fn place(mesh: &mut RawMesh, placement: Option<[Vec2; 3]>) {
    let [x, y, offset] = placement.unwrap_or([Vec2::X, Vec2::Y, Vec2::ZERO]);
    for v in &mut mesh.vertices {
        let uv = x * v.uv.x + y * v.uv.y + offset;
        v.uv = Vec2::new(uv.x, 1.0 - uv.y);
    }
}

impl Reader<'_> {
    /// Returns the nodes of the default scene, or all nodes of a file without scenes. `wanted` is by material; the last
    /// entry is for primitives without one.
    fn nodes(&self, document: &Document, wanted: &mut [MaterialTextures]) -> Result<Nodes, SceneError> {
        let mut nodes = Nodes::default();
        let mut corners = 0;
        let mut moves = self.moves(document)?;
        for at in 0..moves.standing.len() {
            let Standing { node, to_world, mover } = moves.standing[at].clone();
            if let Some(mesh) = node.mesh() {
                let name = node.name().or(mesh.name()).unwrap_or("mesh");
                let instances = self.instances(document, &node)?;
                for primitive in mesh.primitives() {
                    let material = primitive.material().index().unwrap_or(wanted.len() - 1);
                    let wanted = &mut wanted[material];
                    if wanted.invisible {
                        continue;
                    }
                    let Some(mut raw) = self.primitive(&primitive, wanted.set)? else { continue };
                    let count = raw.indices.len().max(raw.vertices.len()).saturating_mul(instances.len());
                    corners = count.saturating_add(corners);
                    if corners > MAX_ELEMENTS {
                        let what = "corners of triangles";
                        return Err(SceneError::too_large(self.path, MAX_ELEMENTS, what));
                    }
                    (raw.name, raw.material) = (name.into(), material);
                    place(&mut raw, wanted.placement);
                    let within = |uv: Vec2| !uv.is_finite() || (uv - 0.5).abs().max_element() < 0.501;
                    wanted.wrapped |= wanted.unrepeated && !raw.vertices.iter().all(|v| within(v.uv));
                    let colors =
                        self.colors(&primitive)?.filter(|c| c.len() == raw.vertices.len()).map(Rc::new);
                    let carried = self.carried(&mut moves, at, &mesh, &primitive)?;
                    for (instance, mut raw) in instances.iter().zip(repeat_n(raw, instances.len())) {
                        let mirrors = instance.determinant() < 0.0;
                        match &carried {
                            // Left in the frame of what carries it, and reversed if that mirrors it.
                            Some(carried) => transform(&mut raw, *instance, mirrors != carried.mirrored),
                            None => {
                                let to_world = to_world * *instance;
                                transform(&mut raw, to_world, to_world.determinant() < 0.0);
                            }
                        }
                        if let Some(carried) = &carried {
                            raw.moving = Some(nodes.carried.len());
                            raw.sources = (0..raw.vertices.len() as u32).collect();
                            nodes.carried.push(carried.clone());
                        }
                        nodes.colors.push(colors.clone());
                        nodes.meshes.push(raw);
                    }
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
        (nodes.motion, nodes.subtracted) = (moves.motion, moves.subtracted);
        Ok(nodes)
    }
}
