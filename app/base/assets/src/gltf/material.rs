//! Materials, and the textures that they use.

use glam::{Vec2, Vec3};
use gltf::material::{AlphaMode, PbrMetallicRoughness, PbrSpecularGlossiness};
use gltf::texture::{MagFilter, WrappingMode};

use super::file::{data_uri, external};
use super::reader::Reader;
use crate::error::SceneError;
use crate::model::{Alpha, Material};
use crate::textures::{AlphaLevels, Built, METAL_DIFFUSE_LOSS, Recipe, Source, diffuse_of_gloss, to_srgb};

/// The textures of one material, by their number in the [`TextureSet`].
#[derive(Default)]
pub(super) struct MaterialTextures {
    diffuse: Option<usize>,
    specular: Option<usize>,
    emissive: Option<usize>,
    normal: Option<usize>,
    /// The roughness at texture values 0 and 1, if it is computed as a texture's mean.
    roughness: Option<[f32; 2]>,
    /// True if nothing of the material's surfaces is drawn: its opacity is below its cut-off.
    pub(super) invisible: bool,
    /// True if a sampler clamps or mirrors one of the textures.
    pub(super) unrepeated: bool,
    /// True if texture coordinates make that visible.
    pub(super) wrapped: bool,
    /// The set of texture coordinates and their transform. Those of the base colour are used for all textures.
    pub(super) set: u32,
    pub(super) placement: Option<[Vec2; 3]>,
}

/// A set of texture coordinates and their transform, as columns.
#[derive(Clone, Copy, PartialEq)]
struct Coordinates {
    set: u32,
    placement: Option<[Vec2; 3]>,
}

impl Coordinates {
    fn of(info: &gltf::texture::Info) -> Coordinates {
        match info.texture_transform() {
            Some(t) => {
                let set = t.tex_coord().unwrap_or(info.tex_coord());
                Coordinates::placed(set, t.offset(), t.rotation(), t.scale())
            }
            None => Coordinates { set: info.tex_coord(), placement: None },
        }
    }

    fn of_normal(texture: &gltf::material::NormalTexture) -> Coordinates {
        let Some(t) = texture.extension_value("KHR_texture_transform") else {
            return Coordinates { set: texture.tex_coord(), placement: None };
        };
        let number =
            |value: &serde_json::Value, otherwise: f32| value.as_f64().map_or(otherwise, |x| x as f32);
        let pair = |key: &str, otherwise: f32| [0, 1].map(|i| number(&t[key][i], otherwise));
        let set = t["texCoord"].as_u64().and_then(|set| set.try_into().ok()).unwrap_or(texture.tex_coord());
        Coordinates::placed(set, pair("offset", 0.0), number(&t["rotation"], 0.0), pair("scale", 1.0))
    }

    fn placed(set: u32, offset: [f32; 2], rotation: f32, scale: [f32; 2]) -> Coordinates {
        let (sin, cos) = rotation.sin_cos();
        let columns = [Vec2::new(cos, -sin) * scale[0], Vec2::new(sin, cos) * scale[1], offset.into()];
        Coordinates { set, placement: Some(columns).filter(|c| *c != [Vec2::X, Vec2::Y, Vec2::ZERO]) }
    }
}

/// Returns the texture coordinates of each of a material's maps that is drawn, with the map's name. The first ones are
/// those of the vertices.
fn coordinates(m: &gltf::Material) -> Vec<(&'static str, Coordinates)> {
    let [color, surface] = surface_textures(m).map(|info| info.map(|info| Coordinates::of(&info)));
    let emissive = m.emissive_texture().map(|info| Coordinates::of(&info));
    let normal = m.normal_texture().map(|texture| Coordinates::of_normal(&texture));
    let maps = if m.unlit() {
        [("base colour", color), ("", None), ("", None), ("", None)]
    } else {
        [("base colour", color), ("metalness", surface), ("emissive", emissive), ("normal", normal)]
    };
    maps.into_iter().filter_map(|(name, coordinates)| Some((name, coordinates?))).collect()
}

impl MaterialTextures {
    pub(super) fn apply(&self, material: &mut Material, built: &Built) {
        material.diffuse_map = built.index(self.diffuse);
        material.specular_map = built.index(self.specular);
        material.emissive_map = built.index(self.emissive);
        material.normal_map = built.index(self.normal);
        if let (Some([least, most]), Some(map)) = (self.roughness, built.get(self.specular)) {
            material.roughness = (least + (most - least) * map.roughness).clamp(0.0, 1.0);
        }
        if material.alpha == Alpha::Blend(1.0) {
            // Exporters mark everything with an alpha channel as blended. What looks the same without blending has a
            // depth, for shadows and synthesis.
            material.alpha = match built.get(self.diffuse).map_or(AlphaLevels::Full, |f| f.levels) {
                AlphaLevels::Full => Alpha::Opaque,
                AlphaLevels::Two => Alpha::Cutout(0.5),
                AlphaLevels::Many => Alpha::Blend(1.0),
            };
        }
    }
}

/// A picture and how it is sampled.
struct Map {
    source: Source,
    /// True if it is not filtered when magnified.
    nearest: bool,
}

/// A surface of either material model. Colours are linear RGB, and factors of the maps if there are any.
struct Surface {
    diffuse: Vec3,
    specular: Vec3,
    roughness: f32,
    opacity: f32,
}

/// Returns a factor clamped to 0..1, or 1 if it is not finite.
pub(super) fn unit(v: f32) -> f32 {
    if v.is_finite() { v.clamp(0.0, 1.0) } else { 1.0 }
}

/// Returns the textures of a material's colour, and of its metalness and roughness or its gloss.
pub(super) fn surface_textures<'a>(m: &gltf::Material<'a>) -> [Option<gltf::texture::Info<'a>>; 2] {
    match m.pbr_specular_glossiness() {
        Some(gloss) => [gloss.diffuse_texture(), gloss.specular_glossiness_texture()],
        None => {
            let pbr = m.pbr_metallic_roughness();
            [pbr.base_color_texture(), pbr.metallic_roughness_texture()]
        }
    }
}

/// Returns how a material's alpha is used, with its opacity, 0 to 1. The opacity is a factor of the map's alpha, also
/// before a cut-off.
fn alpha(m: &gltf::Material, opacity: f32, wanted: &mut MaterialTextures) -> Alpha {
    match m.alpha_mode() {
        AlphaMode::Opaque => Alpha::Opaque,
        AlphaMode::Blend => Alpha::Blend(opacity),
        AlphaMode::Mask => {
            let cutoff = m.alpha_cutoff().filter(|c| c.is_finite()).unwrap_or(0.5).max(0.0);
            wanted.invisible = opacity < cutoff;
            if wanted.invisible || cutoff == 0.0 || wanted.diffuse.is_none() {
                Alpha::Opaque
            } else {
                Alpha::Cutout(cutoff / opacity)
            }
        }
    }
}

impl Reader<'_> {
    /// Returns the name of the picture of a texture whose formats are all in extensions.
    fn picture_name(&self, texture: &gltf::Texture) -> String {
        let mut stated = texture.extensions().into_iter().flat_map(|extensions| extensions.values());
        let image = stated.find_map(|e| self.pictures.get(usize::try_from(e["source"].as_u64()?).ok()?));
        image.cloned().unwrap_or_else(|| texture.index().to_string())
    }

    fn source(&mut self, texture: gltf::Texture) -> Result<Option<Source>, SceneError> {
        let Some(image) = texture.source() else {
            if self.unknown.insert(texture.index()) {
                log::warn!(
                    "{}: the texture {} has an unknown format and is left out: convert it to PNG or JPEG",
                    self.path.display(),
                    self.picture_name(&texture)
                );
            }
            return Ok(None);
        };
        if let Some(known) = self.images.get(&image.index()) {
            return Ok(known.clone());
        }
        let name = self.pictures[image.index()].clone();
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

    /// Returns the picture of a texture with its sampler.
    fn map(
        &mut self,
        texture: gltf::Texture,
        wanted: &mut MaterialTextures,
    ) -> Result<Option<Map>, SceneError> {
        let sampler = texture.sampler();
        wanted.unrepeated |= [sampler.wrap_s(), sampler.wrap_t()].iter().any(|w| *w != WrappingMode::Repeat);
        let nearest = sampler.mag_filter() == Some(MagFilter::Nearest);
        Ok(self.source(texture)?.map(|source| Map { source, nearest }))
    }

    fn request(&mut self, map: Option<Map>, recipe: impl FnOnce(Source) -> Recipe) -> Option<usize> {
        map.map(|map| self.textures.request_sampled(recipe(map.source), map.nearest))
    }

    /// Returns a material, and the textures that it uses.
    pub(super) fn material(
        &mut self,
        m: &gltf::Material,
    ) -> Result<(Material, MaterialTextures), SceneError> {
        let srgb = |v: Vec3| Vec3::from(v.to_array().map(to_srgb));
        let mut wanted = MaterialTextures::default();
        let name = m.name().map_or_else(|| format!("material-{}", m.index().unwrap_or(0)), str::to_owned);
        let maps = coordinates(m);
        if let Some((main, of_vertices)) = maps.first() {
            (wanted.set, wanted.placement) = (of_vertices.set, of_vertices.placement);
            let others = maps.iter().filter(|(_, c)| c != of_vertices).map(|(name, _)| *name);
            let others = others.collect::<Vec<_>>().join(", ");
            if !others.is_empty() {
                log::warn!(
                    "{}: maps of the material {name} have texture coordinates of their own, and those of the {main} map are used: {others}",
                    self.path.display()
                );
            }
        }
        let [color_info, surface_info] = surface_textures(m);
        if m.unlit() {
            let color = color_info.map_or(Ok(None), |i| self.map(i.texture(), &mut wanted))?;
            wanted.diffuse = self.request(color, Recipe::Color);
            let [r, g, b, opacity] = m.pbr_metallic_roughness().base_color_factor().map(unit);
            let material = Material {
                name,
                diffuse: srgb(Vec3::new(r, g, b)),
                specular: Vec3::ZERO,
                roughness: 1.0,
                alpha: alpha(m, opacity, &mut wanted),
                double_sided: m.double_sided(),
                unlit: true,
                ..Material::default()
            };
            return Ok((material, wanted));
        }
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
        let material = Material {
            name,
            diffuse: srgb(diffuse),
            specular: srgb(specular),
            emissive: if glow.is_finite() { srgb(glow.max(Vec3::ZERO)) } else { Vec3::ZERO },
            roughness,
            alpha: alpha(m, opacity, &mut wanted),
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
        wanted: &mut MaterialTextures,
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
        wanted: &mut MaterialTextures,
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
}
