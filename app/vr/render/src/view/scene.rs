//! A scene on the GPU.

use std::rc::Rc;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::{BVec3, Vec2, Vec3, Vec4, Vec4Swizzles};

use super::cluster::{self, Batch, Cluster, Culler, VERTEX_ATTRIBUTES};
use super::coverage;
use super::moving::Moving;
use super::rectangle::{Rectangle, Region};
use super::uniforms::eye_to_clip;
use yoro::eyes::{DepthRange, View};
use yoro_assets::{Alpha, Bounds, Material, PointLight, Scene, ShadingStyle, Sky, TextureImage, Viewpoint};
use yoro_gl::{Context, Filter, Format, GlError, Mesh, Pass, Program, Texture};

/// The features of a material. Each combination that a scene uses is a shader variant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Features(u8);

impl Features {
    pub const DIFFUSE_MAP: Features = Features(1);
    pub const SPECULAR_MAP: Features = Features(2);
    pub const EMISSIVE_MAP: Features = Features(4);
    pub const NORMAL_MAP: Features = Features(8);
    pub const CUTOUT: Features = Features(16);
    pub const UNLIT: Features = Features(32);
    /// Number of combinations.
    pub const COMBINATIONS: usize = 64;

    const NAMES: [(Features, &str); 6] = [
        (Features::DIFFUSE_MAP, "DIFFUSE_MAP"),
        (Features::SPECULAR_MAP, "SPECULAR_MAP"),
        (Features::EMISSIVE_MAP, "EMISSIVE_MAP"),
        (Features::NORMAL_MAP, "NORMAL_MAP"),
        (Features::CUTOUT, "CUTOUT"),
        (Features::UNLIT, "UNLIT"),
    ];

    fn of(material: &Material) -> Features {
        let present = [
            material.diffuse_map.is_some(),
            material.specular_map.is_some(),
            material.emissive_map.is_some(),
            material.normal_map.is_some(),
            matches!(material.alpha, Alpha::Cutout(_)),
            material.unlit,
        ];
        Features(Features::NAMES.iter().zip(present).fold(0, |bits, ((f, _), on)| bits | (f.0 * on as u8)))
    }

    /// Returns the index among the combinations.
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// Returns the features that both sets contain.
    pub fn and(self, other: Features) -> Features {
        Features(self.0 & other.0)
    }

    /// Returns the features that either set contains.
    pub fn or(self, other: Features) -> Features {
        Features(self.0 | other.0)
    }

    pub fn contains(self, other: Features) -> bool {
        self.0 & other.0 == other.0
    }

    /// Returns the defines of the shader variant.
    pub fn defines(self) -> Vec<(&'static str, String)> {
        let present = Features::NAMES.iter().filter(|(feature, _)| self.contains(*feature));
        present.map(|&(_, name)| (name, String::new())).collect()
    }
}

/// A material in the form that shaders take.
pub(super) struct GpuMaterial {
    pub features: Features,
    pub double_sided: bool,
    pub blended: bool,
    /// Linear colour and opacity.
    diffuse: Vec4,
    emissive: Vec3,
    /// Roughness, reflectance at normal incidence, alpha cut-off.
    gloss: Vec3,
    /// Indices of diffuse, specular, emissive and normal map.
    maps: [Option<usize>; 4],
    /// Distinguishes neighbouring materials in 8 bits.
    id: f32,
}

/// Decodes sRGB to linear.
fn linear(srgb: Vec3) -> Vec3 {
    let channel = |c: f32| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
    Vec3::new(channel(srgb.x), channel(srgb.y), channel(srgb.z))
}

/// Reflectance of a Ks of 1, which no MTL file uses for a mirror. The usual Ks of 0.2 gives about 0.01 below glass.
const REFLECTANCE_OF_WHITE: f32 = 0.35;

impl GpuMaterial {
    fn new(index: usize, material: &Material) -> GpuMaterial {
        let (opacity, cutoff) = match material.alpha {
            Alpha::Opaque => (1.0, 0.0),
            Alpha::Cutout(cutoff) => (1.0, cutoff),
            Alpha::Blend(opacity) => (opacity, 0.0),
        };
        let specular = linear(material.specular).dot(Vec3::new(0.3, 0.6, 0.1));
        let reflectance = (specular * REFLECTANCE_OF_WHITE).min(0.9);
        GpuMaterial {
            features: Features::of(material),
            double_sided: material.double_sided,
            blended: matches!(material.alpha, Alpha::Blend(_)),
            diffuse: linear(material.diffuse).extend(opacity),
            emissive: linear(material.emissive),
            gloss: Vec3::new(material.roughness.clamp(0.0, 1.0), reflectance, cutoff),
            maps: [material.diffuse_map, material.specular_map, material.emissive_map, material.normal_map],
            id: (index * 97 % 255) as f32 / 255.0,
        }
    }
}

/// A scene with its triangles and pictures on the GPU, in clusters that are culled one by one.
pub struct GpuScene {
    /// Unique in this process.
    pub(super) id: u64,
    /// Name: a built-in one, or the file's stem.
    pub name: String,
    /// Shading style.
    pub style: ShadingStyle,
    /// Sun and sky.
    pub sky: Sky,
    /// Point lights.
    pub lights: Vec<PointLight>,
    /// Camera path.
    pub viewpoints: Vec<Viewpoint>,
    bounds: Bounds,
    triangle_count: usize,
    mesh: Mesh,
    pub(super) moving: Option<Moving>,
    pub(super) materials: Vec<GpuMaterial>,
    textures: Vec<Texture>,
    pub(super) clusters: Vec<Cluster>,
    pub(super) batches: Vec<Batch>,
    /// Boxes that together contain all blended triangles that do not move.
    blended_boxes: Vec<Bounds>,
}

/// The texture units that materials use.
pub(super) const MAP_NAMES: [&str; 4] = ["diffuse_map", "specular_map", "emissive_map", "normal_map"];
/// First texture unit that no material uses.
pub(super) const FREE_UNIT: u32 = MAP_NAMES.len() as u32;

impl GpuScene {
    /// Uploads a scene in its state at time 0 and sorts its triangles into clusters. Frees the scene's memory as soon
    /// as GL has copied it.
    ///
    /// # Errors
    /// [`GlError::TooLarge`] for a picture beyond the driver's limit, [`GlError::OutOfMemory`] if memory runs out.
    pub fn upload(gl: &Rc<Context>, scene: Scene) -> Result<GpuScene, GlError> {
        static NEXT_ID: AtomicU64 = AtomicU64::new(0);
        let Scene { name, mut model, style, sky, lights, viewpoints, motion, .. } = scene;
        let (still, reached) = (model.bounds(), motion.bounds());
        let bounds =
            if reached.is_empty() { still } else { still.including(reached.min).including(reached.max) };
        let triangle_count = model.triangle_count();
        let mut moving = Moving::take(gl, &mut model, motion)?;
        let cluster::Clusters { mut clusters, mut batches, blended_boxes, indices } = cluster::build(&model);
        if let Some(moving) = &mut moving {
            moving.append(&mut clusters, &mut batches);
        }
        // Cut-out materials come last: much of them is hidden by then, and `discard` disables early depth tests.
        batches.sort_by_key(|b| matches!(model.materials[b.material].alpha, Alpha::Cutout(_)));
        model.indices = Vec::new();
        let mesh = Mesh::new(gl, &VERTEX_ATTRIBUTES, &model.vertices, &indices)?;
        model.vertices = Vec::new();
        drop(indices);
        // Textures of voxel worlds are never filtered, whatever file they come from.
        let unfiltered = style == ShadingStyle::Voxel;
        let cutoffs = coverage::split(&mut model);
        let upload = |(image, cutoff): (TextureImage, Option<f32>)| {
            upload_picture(gl, TextureImage { nearest: image.nearest || unfiltered, ..image }, cutoff)
        };
        let textures = model.textures.into_iter().zip(cutoffs).map(upload).collect::<Result<_, _>>()?;
        let materials = model.materials.iter().enumerate().map(|(i, m)| GpuMaterial::new(i, m)).collect();
        Ok(GpuScene {
            id: NEXT_ID.fetch_add(1, Ordering::Relaxed),
            name,
            style,
            sky,
            lights,
            viewpoints,
            bounds,
            triangle_count,
            mesh,
            moving,
            materials,
            textures,
            clusters,
            batches,
            blended_boxes,
        })
    }

    /// Returns the smallest box around all vertices at all times.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Returns the number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangle_count
    }

    /// True if anything in the scene moves.
    pub fn moves(&self) -> bool {
        self.moving.is_some()
    }

    /// Moves everything to its place at a time in seconds. False if it is there already; otherwise the renderer's
    /// shadow map must be redrawn.
    pub(super) fn set_time(&mut self, seconds: f64) -> bool {
        let Some(moving) = &mut self.moving else { return false };
        let moved = moving.set_time(seconds, &mut self.clusters);
        if moved {
            moving.moment.light(&moving.motion, &mut self.lights, &mut self.sky);
        }
        moved
    }

    /// True if a moving triangle may be visible in a view.
    pub(crate) fn is_moving_in(&self, view: &View) -> bool {
        let culler = Culler::of_view(view);
        self.moving.as_ref().is_some_and(|m| m.of(&self.clusters).iter().any(|c| culler.sees(&c.bounds)))
    }

    /// Binds the mesh of a batch, unless it is `bound` already, and returns it.
    pub(super) fn bind_mesh(&self, moves: bool, bound: &mut Option<bool>) -> &Mesh {
        let mesh = self.moving.as_ref().filter(|_| moves).map_or(&self.mesh, |moving| &moving.mesh);
        if bound.replace(moves) != Some(moves) {
            mesh.bind();
        }
        mesh
    }

    /// True if the scene has a sun.
    pub fn has_sun(&self) -> bool {
        self.sky.sun_color.max_element() > 0.0
    }

    /// True if any surface is lit. What is unlit shines no brighter than white, so a scene without has no bloom.
    pub(super) fn is_lit(&self) -> bool {
        self.materials.iter().any(|material| !material.features.contains(Features::UNLIT))
    }

    /// True if any surface is blended.
    pub fn has_transparent(&self) -> bool {
        self.blended().next().is_some()
    }

    /// True if a blended surface may be visible in a view.
    pub fn is_transparent_in(&self, view: &View) -> bool {
        let culler = Culler::of_view(view);
        self.blended().flat_map(|b| &self.clusters[b.clusters.clone()]).any(|c| culler.sees(&c.bounds))
    }

    /// Returns a region of a view around all blended surfaces that may be visible; `None` if there are none.
    pub(crate) fn transparent_region(&self, view: &View) -> Option<Region> {
        let (culler, to_clip, eye) = (Culler::of_view(view), eye_to_clip(view), view.pose.position);
        let (size, near) = (Vec2::from(view.size.map(|n| n as f32)), view.depth.near);
        let moving =
            self.blended().filter(|batch| batch.moves).flat_map(|b| &self.clusters[b.clusters.clone()]);
        let boxes = self.blended_boxes.iter().chain(moving.map(|cluster| &cluster.bounds));
        let mut region = Region::none(view.size);
        for &Bounds { min, max } in boxes.filter(|bounds| culler.sees(bounds)) {
            let corners: [Vec4; 8] = std::array::from_fn(|i| {
                let corner = Vec3::select(BVec3::new(i & 1 != 0, i & 2 != 0, i & 4 != 0), max, min);
                to_clip * (corner - eye).extend(1.0)
            });
            let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
            let edges = (0..8).flat_map(|i| [1, 2, 4].map(|axis| [corners[i], corners[i | axis]]));
            for [a, b] in edges {
                // The part of the edge in front of the near plane.
                let clipped = |a: Vec4, b: Vec4| {
                    if a.w < near { a.lerp(b, ((near - a.w) / (b.w - a.w)).min(1.0)) } else { a }
                };
                for clip in [clipped(a, b), clipped(b, a)].into_iter().filter(|_| a.w.max(b.w) >= near) {
                    let pixel = (clip.xy() / near.max(clip.w) * 0.5 + 0.5) * size;
                    (low, high) = (low.min(pixel), high.max(pixel));
                }
            }
            // One pixel more on each side, since a GPU rounds in another way.
            let first = (low - 1.0).floor().clamp(Vec2::ZERO, size).as_uvec2();
            let end = (high + 1.0).ceil().clamp(Vec2::ZERO, size).as_uvec2();
            if first.cmplt(end).all() {
                region.add(Rectangle { origin: first.to_array(), size: (end - first).to_array() });
            }
        }
        region.rectangles().next().is_some().then_some(region)
    }

    /// Returns the batches of blended triangles.
    pub(super) fn blended(&self) -> impl Iterator<Item = &Batch> {
        self.batches.iter().filter(|batch| self.materials[batch.material].blended)
    }

    /// True if an opaque surface may be visible in a slice of a view (near and far plane in metres).
    pub(crate) fn is_seen(&self, view: &View, [near, far]: [f32; 2]) -> bool {
        let culler = Culler::of_view(&View { depth: DepthRange { near, far, ..view.depth }, ..*view });
        self.opaque().any(|(_, _, clusters)| clusters.iter().any(|c| culler.sees(&c.bounds)))
    }

    /// Returns the defines of the scene's shading style.
    pub(super) fn style_defines(&self) -> Vec<(&'static str, String)> {
        let name = match self.style {
            ShadingStyle::Realistic => "STYLE_REALISTIC",
            ShadingStyle::Cartoon => "STYLE_CARTOON",
            ShadingStyle::LowPoly => "STYLE_LOW_POLY",
            ShadingStyle::Voxel => "STYLE_VOXEL",
            ShadingStyle::Anime => "STYLE_ANIME",
        };
        let mut defines = vec![(name, String::new())];
        if matches!(self.style, ShadingStyle::LowPoly | ShadingStyle::Voxel) {
            defines.push(("FACE_NORMALS", String::new()));
        }
        defines
    }

    /// Returns the batches of opaque triangles: their material, whether they move, and their clusters.
    pub(super) fn opaque(&self) -> impl Iterator<Item = (&GpuMaterial, bool, &[Cluster])> {
        self.batches.iter().filter_map(|batch| {
            let material = &self.materials[batch.material];
            (!material.blended).then(|| (material, batch.moves, &self.clusters[batch.clusters.clone()]))
        })
    }

    /// Declares that a pass samples the materials' maps: of each kind the first one.
    pub(super) fn declare<'a>(&self, mut pass: Pass<'a>, kinds: usize) -> Pass<'a> {
        for (kind, name) in MAP_NAMES.into_iter().enumerate().take(kinds) {
            let first = self.materials.iter().find_map(|material| self.textures.get(material.maps[kind]?));
            if let Some(map) = first {
                pass = pass.read(name, map);
            }
        }
        pass
    }

    /// Sets a material's uniforms and maps for the current program.
    pub(super) fn set_material(&self, program: &Program, material: &GpuMaterial) {
        program
            .set("diffuse", material.diffuse)
            .set("emissive", material.emissive)
            .set("gloss", material.gloss)
            .set("material_id", material.id);
        for (unit, (name, map)) in MAP_NAMES.iter().zip(material.maps).enumerate() {
            if let Some(texture) = map.and_then(|i| self.textures.get(i)) {
                program.texture(name, unit as u32, texture.raw());
            }
        }
    }
}

/// Uploads a picture with its mip levels. With a cut-off, these keep as much of it as the picture has.
fn upload_picture(
    gl: &Rc<Context>,
    mut image: TextureImage,
    cutoff: Option<f32>,
) -> Result<Texture, GlError> {
    let format = if image.srgb { Format::Srgb8Alpha8 } else { Format::Rgba8 };
    let filter = if image.nearest { Filter::MaterialNearest } else { Filter::Material };
    let texture = Texture::new(gl, image.size, format, filter)?;
    flip_rows(&mut image.rgba, image.size[0] as usize * 4);
    texture.upload(&image.rgba);
    match cutoff {
        Some(cutoff) => {
            let levels = coverage::levels(image.rgba, image.size, image.srgb, cutoff);
            (1..).zip(levels).for_each(|(level, rgba)| texture.upload_level(level, &rgba));
        }
        None => texture.generate_mipmaps(),
    }
    Ok(texture)
}

/// Reverses the order of the rows: pictures start at the top, GL textures at the bottom.
fn flip_rows(bytes: &mut [u8], row: usize) {
    let (mut low, mut high) = (0, bytes.len() / row.max(1));
    while low + 1 < high {
        high -= 1;
        let (head, tail) = bytes.split_at_mut(high * row);
        head[low * row..(low + 1) * row].swap_with_slice(&mut tail[..row]);
        low += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flipping_reverses_the_rows() {
        let mut bytes = [1, 2, 3, 4, 5, 6];
        flip_rows(&mut bytes, 2);
        assert_eq!(bytes, [5, 6, 3, 4, 1, 2]);
        flip_rows(&mut bytes, 3);
        assert_eq!(bytes, [4, 1, 2, 5, 6, 3]);
        flip_rows(&mut bytes, 6);
        assert_eq!(bytes, [4, 1, 2, 5, 6, 3]);
    }

    #[test]
    fn srgb_decodes_to_linear() {
        assert_eq!(linear(Vec3::new(0.0, 1.0, 0.04045)).x, 0.0);
        assert!((linear(Vec3::ONE) - Vec3::ONE).length() < 1e-6);
        assert!((linear(Vec3::splat(0.5)).x - 0.21404).abs() < 1e-4);
    }
}
