//! Pictures for materials: finds, decodes (in parallel) and converts them, and keeps them within a memory budget.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::io::{Cursor, Read as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use glam::Vec3;
use image::error::{DecodingError, ImageFormatHint};
use image::{ImageError, ImageReader, Rgba, RgbaImage};
use rayon::prelude::*;

use super::error::SceneError;
use super::model::TextureImage;
use yoro_files::decoder;

/// Maximum edge length of a picture that is read.
const MAX_SOURCE_EDGE: u32 = 16384;
/// Maximum number of pixels of a picture that is read: 512 MiB decoded.
const MAX_SOURCE_PIXELS: u64 = 1 << 27;
/// Maximum edge length that is kept; larger pictures are scaled down.
const MAX_EDGE: u32 = 8192;
/// Maximum number of pixels of a model's pictures (1 GiB). If they have more, the largest are scaled down.
const PIXEL_BUDGET: u64 = 1 << 28;

/// Share of the diffuse colour that metals lose. Real metals lose all of it, but would be black here without
/// reflections of their surroundings.
pub(super) const METAL_DIFFUSE_LOSS: f32 = 0.7;

/// The source of a picture.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Source {
    File(PathBuf),
    /// Index into [`TextureSet::memory`].
    Memory(usize),
}

/// How a texture is made from pictures. Numbers are stored as the bits of f32, so that equal recipes make one texture.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Recipe {
    /// The picture as it is.
    Color(Source),
    /// A colour picture (or white) with the opacity of another picture.
    Masked { color: Option<Source>, mask: Source, channel: Option<char> },
    /// A normal map. Unless `normal` is set, the picture may also be a height map, which is converted.
    Bump { source: Source, strength: u32, normal: bool },
    /// glTF: the diffuse or the specular colour from a base colour and the metalness in the blue channel of `orm`.
    Metal { base: Option<Source>, base_factor: [u32; 3], orm: Source, metallic: u32, specular: bool },
    /// glTF: the diffuse colour of a specular-glossiness material, from its two factors and two pictures.
    Gloss { diffuse: Option<Source>, diffuse_factor: [u32; 3], gloss: Source, specular_factor: [u32; 3] },
    /// glTF: the specular colour of a specular-glossiness material, with the glossiness in alpha.
    Specular(Source),
}

/// How a texture's alpha is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AlphaUse {
    Opaque,
    Mask,
    Blend,
}

/// The values that a texture's alpha has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AlphaLevels {
    /// 1 everywhere.
    Full,
    /// 0 and 1.
    Two,
    /// Others as well.
    Many,
}

/// A finished texture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Finished {
    /// Index into [`Built::images`].
    pub index: usize,
    pub alpha: AlphaUse,
    pub levels: AlphaLevels,
    /// For [`Recipe::Metal`] the mean roughness; for [`Recipe::Specular`] 1 minus the mean glossiness.
    pub roughness: f32,
}

/// All textures of a model, and the texture of each recipe; `None` if its picture is missing.
#[derive(Debug, Default)]
pub(super) struct Built {
    pub images: Vec<TextureImage>,
    pub finished: Vec<Option<Finished>>,
}

impl Built {
    pub fn get(&self, recipe: Option<usize>) -> Option<Finished> {
        recipe.and_then(|r| self.finished[r])
    }

    pub fn index(&self, recipe: Option<usize>) -> Option<usize> {
        self.get(recipe).map(|f| f.index)
    }
}

/// Collects the textures that a model's materials use.
#[derive(Debug, Default)]
pub(super) struct TextureSet {
    /// Pictures that are not files: a name for messages, and their encoded bytes.
    pub memory: Vec<(PathBuf, Vec<u8>)>,
    /// The recipes, each with true if it is not filtered when magnified.
    recipes: Vec<(Recipe, bool)>,
    known: HashMap<(Recipe, bool), usize>,
    /// Pictures that were warned of.
    left_out: Mutex<HashSet<PathBuf>>,
}

impl TextureSet {
    /// Requests a texture, and returns its number in [`Built`].
    pub fn request(&mut self, recipe: Recipe) -> usize {
        self.request_sampled(recipe, false)
    }

    /// Like [`TextureSet::request`]. With `nearest`, the texture is not filtered when magnified.
    pub fn request_sampled(&mut self, recipe: Recipe, nearest: bool) -> usize {
        let next = self.recipes.len();
        *self.known.entry((recipe.clone(), nearest)).or_insert_with(|| {
            self.recipes.push((recipe, nearest));
            next
        })
    }

    /// Decodes and converts all requested textures.
    ///
    /// # Errors
    /// If a picture is damaged or too large. A picture in an unknown format is left out with a warning.
    pub fn build(&self) -> Result<Built, SceneError> {
        let sizes =
            self.recipes.par_iter().map(|(r, _)| self.size(r.main())).collect::<Result<Vec<_>, _>>()?;
        let mut edge = MAX_EDGE;
        let pixels = |edge: u32| {
            sizes.iter().flatten().map(|&s| fitted(s, edge)).map(|[w, h]| w as u64 * h as u64).sum::<u64>()
        };
        while edge > 64 && pixels(edge) > PIXEL_BUDGET {
            edge /= 2;
        }
        if sizes.iter().flatten().any(|s| s[0].max(s[1]) > edge) {
            log::info!("textures larger than {edge} pixels are scaled down to keep them in memory");
        }
        let made = self
            .recipes
            .par_iter()
            .zip(&sizes)
            .map(|((recipe, _), size)| if size.is_some() { self.make(recipe, edge) } else { Ok(None) })
            .collect::<Result<Vec<_>, _>>()?;
        let mut built = Built::default();
        let mut names = HashSet::new();
        for ((recipe, nearest), made) in self.recipes.iter().zip(made) {
            let finished = made.map(|(image, roughness)| {
                let (alpha, levels) = (alpha_use(&image), alpha_levels(&image));
                let suffix = match recipe {
                    Recipe::Metal { specular: true, .. } | Recipe::Specular(_) => "-specular",
                    Recipe::Metal { .. } | Recipe::Gloss { .. } => "-diffuse",
                    _ => "",
                };
                let stem = self.path(recipe.main()).file_stem().unwrap_or_default().to_string_lossy();
                built.images.push(TextureImage {
                    name: unique(&mut names, format!("{stem}{suffix}")),
                    size: image.dimensions().into(),
                    rgba: image.into_raw(),
                    srgb: !matches!(recipe, Recipe::Bump { .. }),
                    nearest: *nearest,
                });
                Finished { index: built.images.len() - 1, alpha, levels, roughness }
            });
            built.finished.push(finished);
        }
        Ok(built)
    }

    fn make(&self, recipe: &Recipe, edge: u32) -> Result<Option<(RgbaImage, f32)>, SceneError> {
        let plain = |image: RgbaImage| (image, 1.0);
        Ok(match recipe {
            Recipe::Color(source) => self.decode(source, edge)?.map(plain),
            Recipe::Masked { color, mask, channel } => {
                let color = color.as_ref().map_or(Ok(None), |c| self.decode(c, edge))?;
                match (color, self.decode(mask, edge)?) {
                    (color, Some(mask)) => Some(plain(masked(color, &mask, *channel))),
                    (color, None) => color.map(plain),
                }
            }
            Recipe::Bump { source, strength, normal } => self
                .decode(source, edge)?
                .map(|image| plain(normal_map(image, f32::from_bits(*strength), *normal))),
            Recipe::Metal { base, base_factor, orm, metallic, specular } => {
                let base = base.as_ref().map_or(Ok(None), |b| self.decode(b, edge))?;
                let factor = Vec3::from(base_factor.map(f32::from_bits));
                self.decode(orm, edge)?
                    .map(|orm| metal(base, factor, &orm, f32::from_bits(*metallic), *specular))
            }
            Recipe::Gloss { diffuse, diffuse_factor, gloss, specular_factor } => {
                let diffuse = diffuse.as_ref().map_or(Ok(None), |d| self.decode(d, edge))?;
                let factors = [diffuse_factor, specular_factor].map(|f| Vec3::from(f.map(f32::from_bits)));
                self.decode(gloss, edge)?.map(|gloss| plain(gloss_diffuse(diffuse, &gloss, factors)))
            }
            Recipe::Specular(source) => self.decode(source, edge)?.map(gloss_specular),
        })
    }

    fn path<'a>(&'a self, source: &'a Source) -> &'a Path {
        match source {
            Source::File(path) => path,
            Source::Memory(i) => &self.memory[*i].0,
        }
    }

    /// Returns the width and height; `None`, with a warning, if the format is unknown.
    fn size(&self, source: &Source) -> Result<Option<[u32; 2]>, SceneError> {
        let path = self.path(source);
        let found = self.bytes(source).and_then(|bytes| {
            let reader = self.reader(source, &bytes)?;
            match reader.format() {
                Some(f) if f.reading_enabled() => {
                    decoder::run(|| reader.into_dimensions().map(Some), damaged)
                }
                _ => Ok(None),
            }
        });
        match found {
            Ok(Some((w, h))) if w.max(h) > MAX_SOURCE_EDGE || w as u64 * h as u64 > MAX_SOURCE_PIXELS => {
                let what = format!(
                    "{w} x {h} pixels are too many, {MAX_SOURCE_EDGE} x {} at most: scale it down",
                    MAX_SOURCE_PIXELS / MAX_SOURCE_EDGE as u64
                );
                Err(SceneError::texture(path, what))
            }
            Ok(Some((w, h))) => Ok(Some([w, h])),
            Ok(None) | Err(ImageError::Unsupported(_)) => {
                self.warn_once(path, "has an unknown format and is left out: convert it to PNG or JPEG");
                Ok(None)
            }
            Err(e) => Err(SceneError::texture(path, e)),
        }
    }

    /// Warns about a picture, once.
    fn warn_once(&self, path: &Path, what: &str) {
        let mut left_out = self.left_out.lock().unwrap_or_else(PoisonError::into_inner);
        if left_out.insert(path.into()) {
            log::warn!("the texture {} {what}", path.display());
        }
    }

    fn decode(&self, source: &Source, edge: u32) -> Result<Option<RgbaImage>, SceneError> {
        let Some(size) = self.size(source)? else { return Ok(None) };
        let decoded = self.bytes(source).and_then(|bytes| {
            let mut reader = self.reader(source, &bytes)?;
            let mut limits = image::Limits::default();
            limits.max_image_width = Some(MAX_SOURCE_EDGE);
            limits.max_image_height = Some(MAX_SOURCE_EDGE);
            // EXR has 16 bytes per pixel.
            limits.max_alloc = Some(MAX_SOURCE_PIXELS * 16);
            reader.limits(limits);
            decoder::run(|| reader.decode(), damaged)
        });
        match decoded {
            Ok(image) => {
                let image = image.into_rgba8();
                let [w, h] = fitted(size, edge);
                Ok(Some(if [w, h] == size { image } else { image::imageops::thumbnail(&image, w, h) }))
            }
            Err(ImageError::Unsupported(_)) => {
                self.warn_once(
                    self.path(source),
                    "is of an unknown kind and is left out: convert it to PNG or JPEG",
                );
                Ok(None)
            }
            Err(e) => Err(SceneError::texture(self.path(source), e)),
        }
    }

    fn bytes<'a>(&'a self, source: &Source) -> Result<Cow<'a, [u8]>, ImageError> {
        Ok(match source {
            Source::File(path) => {
                let mut bytes = Vec::new();
                yoro_files::open(path)?.read_to_end(&mut bytes)?;
                Cow::Owned(bytes)
            }
            Source::Memory(i) => Cow::Borrowed(&self.memory[*i].1),
        })
    }

    /// Returns a reader of a picture's encoded bytes. It has this one type because decoders are compiled once for each
    /// type.
    fn reader<'b>(
        &self,
        source: &Source,
        bytes: &'b [u8],
    ) -> Result<ImageReader<Cursor<&'b [u8]>>, ImageError> {
        let mut reader = ImageReader::new(Cursor::new(bytes));
        // TGA has no signature, so the extension decides if the content does not.
        if let Ok(format) = image::ImageFormat::from_path(self.path(source)) {
            reader.set_format(format);
        }
        Ok(reader.with_guessed_format()?)
    }
}

/// Wraps a decoder's message in an error.
fn damaged(reason: String) -> ImageError {
    ImageError::Decoding(DecodingError::new(ImageFormatHint::Unknown, reason))
}

impl Recipe {
    /// Returns the picture that gives the texture its size and name.
    fn main(&self) -> &Source {
        match self {
            Recipe::Color(source) | Recipe::Specular(source) | Recipe::Bump { source, .. } => source,
            Recipe::Masked { color, mask, .. } => color.as_ref().unwrap_or(mask),
            Recipe::Metal { base, orm, .. } => base.as_ref().unwrap_or(orm),
            Recipe::Gloss { diffuse, gloss, .. } => diffuse.as_ref().unwrap_or(gloss),
        }
    }
}

/// Makes a name suitable for a file, and unique by appending a number.
pub(super) fn unique(taken: &mut HashSet<String>, name: String) -> String {
    let safe: String =
        name.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect();
    let safe = if safe.trim_matches(['.', '_']).is_empty() { "unnamed".to_owned() } else { safe };
    let numbered = (2..).map(|i| format!("{safe}-{i}"));
    // Some file systems do not distinguish case.
    std::iter::once(safe.clone()).chain(numbered).find(|n| taken.insert(n.to_lowercase())).unwrap_or(safe)
}

/// Returns a size scaled down until neither edge is longer than `edge`.
fn fitted([w, h]: [u32; 2], edge: u32) -> [u32; 2] {
    let longest = w.max(h);
    if longest <= edge {
        return [w, h];
    }
    [w, h].map(|n| ((n as u64 * edge as u64 / longest as u64) as u32).max(1))
}

fn alpha_levels(image: &RgbaImage) -> AlphaLevels {
    if image.pixels().all(|p| p[3] == 255) {
        AlphaLevels::Full
    } else if image.pixels().all(|p| matches!(p[3], 0 | 255)) {
        AlphaLevels::Two
    } else {
        AlphaLevels::Many
    }
}

/// Returns how the alpha channel is used, where the file does not say it. Some hold something else, such as gloss, so transparency is assumed only if a
/// good part is clearly opaque or nearly everything is translucent.
fn alpha_use(image: &RgbaImage) -> AlphaUse {
    let total = image.pixels().len().max(1) as f32;
    let share = |range: std::ops::RangeInclusive<u8>| {
        image.pixels().filter(|p| range.contains(&p[3])).count() as f32 / total
    };
    let opaque = share(224..=255);
    if opaque > 0.998 {
        return AlphaUse::Opaque;
    }
    let clear = share(0..=31);
    let between = 1.0 - opaque - clear;
    if opaque >= 0.02 && between <= 0.4 {
        AlphaUse::Mask
    } else if clear > 0.999 {
        AlphaUse::Opaque
    } else {
        AlphaUse::Blend
    }
}

fn luminance(p: &Rgba<u8>) -> f32 {
    (0.2126 * p[0] as f32 + 0.7152 * p[1] as f32 + 0.0722 * p[2] as f32) / 255.0
}

/// Copies the opacity in `mask` to the alpha of `color`. Without a stated channel, uses the mask's alpha unless it is
/// opaque everywhere, and then its brightness.
fn masked(color: Option<RgbaImage>, mask: &RgbaImage, channel: Option<char>) -> RgbaImage {
    let from_alpha = mask.pixels().any(|p| p[3] != 255);
    let opacity = |p: &Rgba<u8>| match channel {
        Some('r') => p[0],
        Some('g') => p[1],
        Some('b') => p[2],
        Some('m') => p[3],
        None if from_alpha => p[3],
        _ => (luminance(p) * 255.0).round() as u8,
    };
    let mut image =
        color.unwrap_or_else(|| RgbaImage::from_pixel(mask.width(), mask.height(), Rgba([255; 4])));
    let (w, h) = image.dimensions();
    for (x, y, p) in image.enumerate_pixels_mut() {
        p[3] = opacity(at(mask, x, y, w, h));
    }
    image
}

/// Returns the pixel of another picture at the same place on the surface.
fn at(image: &RgbaImage, x: u32, y: u32, w: u32, h: u32) -> &Rgba<u8> {
    let scaled = |i: u32, from: u32, to: u32| (i as u64 * to as u64 / from as u64) as u32;
    image.get_pixel(scaled(x, w, image.width()), scaled(y, h, image.height()))
}

/// Converts bumps to a tangent-space normal map, green up. A picture that is mostly blue is one already.
fn normal_map(mut image: RgbaImage, strength: f32, surely: bool) -> RgbaImage {
    let n = image.pixels().len().max(1) as f32;
    let sum = image.pixels().fold(Vec3::ZERO, |s, p| s + Vec3::new(p[0] as f32, p[1] as f32, p[2] as f32));
    let mean = sum / (n * 255.0);
    let encode = |n: Vec3| {
        let n = (n.normalize_or(Vec3::Z) * 0.5 + 0.5) * 255.0;
        Rgba([n.x.round() as u8, n.y.round() as u8, n.z.round() as u8, 255])
    };
    if surely || (mean.z > 0.55 && mean.z - mean.x.max(mean.y) > 0.1) {
        if strength != 1.0 {
            for p in image.pixels_mut() {
                let n = Vec3::new(p[0] as f32, p[1] as f32, p[2] as f32) / 127.5 - 1.0;
                *p = encode(n * Vec3::new(strength, strength, 1.0));
            }
        }
        return image;
    }
    let (w, h) = image.dimensions();
    let height: Vec<f32> = image.pixels().map(luminance).collect();
    let level = |x: u32, y: u32| height[y as usize * w as usize + x as usize];
    // MTL gives no height in metres: full contrast between neighbours becomes a slope of 2 at -bm 1.
    let slope = strength * 2.0;
    for (x, y, p) in image.enumerate_pixels_mut() {
        let dx = level((x + 1) % w, y) - level((x + w - 1) % w, y);
        // Rows run down, green points up.
        let dy = level(x, (y + h - 1) % h) - level(x, (y + 1) % h);
        *p = encode(Vec3::new(-dx * slope, -dy * slope, 1.0));
    }
    image
}

/// Converts one channel from sRGB to linear, both 0 to 1.
pub(super) fn to_linear(c: f32) -> f32 {
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// Converts one channel from linear to sRGB; also defined above 1.
pub(super) fn to_srgb(c: f32) -> f32 {
    if c <= 0.0031308 { c * 12.92 } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// Returns the diffuse or specular colour of glTF's metallic-roughness model (its appendix B.3: dielectrics reflect 4
/// %), and the mean of the roughness in the green channel of `orm`.
fn metal(
    base: Option<RgbaImage>,
    factor: Vec3,
    orm: &RgbaImage,
    metallic: f32,
    specular: bool,
) -> (RgbaImage, f32) {
    let roughness =
        orm.pixels().map(|p| p[1] as f64).sum::<f64>() / (orm.pixels().len().max(1) as f64 * 255.0);
    let mut image = base.unwrap_or_else(|| RgbaImage::from_pixel(orm.width(), orm.height(), Rgba([255; 4])));
    let (w, h) = image.dimensions();
    let linear: Vec<f32> = (0..256).map(|c| to_linear(c as f32 / 255.0)).collect();
    for (x, y, p) in image.enumerate_pixels_mut() {
        let m = at(orm, x, y, w, h)[2] as f32 / 255.0 * metallic;
        for c in 0..3 {
            let color = linear[p[c] as usize];
            let mixed = if specular {
                0.04 + (color * factor[c] - 0.04) * m
            } else {
                color * (1.0 - METAL_DIFFUSE_LOSS * m)
            };
            p[c] = (to_srgb(mixed.clamp(0.0, 1.0)) * 255.0).round() as u8;
        }
        if specular {
            p[3] = 255;
        }
    }
    (image, roughness as f32)
}

/// Returns the diffuse colour (linear) of glTF's specular-glossiness model: what the specular colour leaves of it, and
/// for metals, whose diffuse colour is black, what [`METAL_DIFFUSE_LOSS`] leaves of the specular colour.
pub(super) fn diffuse_of_gloss(diffuse: Vec3, specular: Vec3) -> Vec3 {
    let metal = (specular - 0.04).max(Vec3::ZERO) * (1.0 - METAL_DIFFUSE_LOSS);
    diffuse * (1.0 - specular.max_element()) + metal
}

/// Returns the diffuse colour of a specular-glossiness material, pixel by pixel, with the factors of both colours.
fn gloss_diffuse(
    diffuse: Option<RgbaImage>,
    gloss: &RgbaImage,
    [diffuse_factor, specular_factor]: [Vec3; 2],
) -> RgbaImage {
    let mut image =
        diffuse.unwrap_or_else(|| RgbaImage::from_pixel(gloss.width(), gloss.height(), Rgba([255; 4])));
    let (w, h) = image.dimensions();
    let levels: Vec<f32> = (0..256).map(|c| to_linear(c as f32 / 255.0)).collect();
    let linear =
        |p: &Rgba<u8>| Vec3::new(levels[p[0] as usize], levels[p[1] as usize], levels[p[2] as usize]);
    for (x, y, p) in image.enumerate_pixels_mut() {
        let color =
            diffuse_of_gloss(linear(p) * diffuse_factor, linear(at(gloss, x, y, w, h)) * specular_factor);
        for c in 0..3 {
            p[c] = (to_srgb(color[c].clamp(0.0, 1.0)) * 255.0).round() as u8;
        }
    }
    image
}

/// Returns the specular colour of a specular-glossiness picture, made opaque, and 1 minus the mean of its glossiness.
fn gloss_specular(mut image: RgbaImage) -> (RgbaImage, f32) {
    let gloss =
        image.pixels().map(|p| p[3] as f64).sum::<f64>() / (image.pixels().len().max(1) as f64 * 255.0);
    image.pixels_mut().for_each(|p| p[3] = 255);
    (image, 1.0 - gloss as f32)
}

/// Finds a file that a model refers to. Allows for backslashes, different case, absolute paths of another machine, and
/// the usual folders for textures. `None` if it is not found.
pub(super) fn find_file(folder: &Path, name: &str) -> Option<PathBuf> {
    let exact = folder.join(name);
    if yoro_files::is_file(&exact) {
        return Some(exact);
    }
    let name = name.replace('\\', "/");
    let names: Vec<&str> =
        name.split('/').filter(|n| !n.is_empty() && *n != "." && !n.ends_with(':')).collect();
    let last = *names.last()?;
    let shorter = (0..names.len()).map(|i| names[i..].to_vec());
    let usual = ["textures", "texture", "tex", "maps", "images", "../textures"]
        .map(|f| f.split('/').chain([last]).collect());
    shorter.chain(usual).find_map(|names| descend(folder, &names)).filter(|p| yoro_files::is_file(p))
}

fn descend(folder: &Path, names: &[&str]) -> Option<PathBuf> {
    let mut path = folder.to_path_buf();
    for name in names {
        let next = path.join(name);
        path = if yoro_files::exists(&next) {
            next
        } else {
            let wanted = name.to_lowercase();
            // Sorted, since the choice between `A.png` and `a.PNG` must not depend on the file system.
            let mut found = yoro_files::names(&path).ok()?;
            found.retain(|n| n.to_string_lossy().to_lowercase() == wanted);
            path.join(found.into_iter().min()?)
        };
    }
    Some(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(w: u32, h: u32, f: impl Fn(u32, u32) -> [u8; 4]) -> RgbaImage {
        RgbaImage::from_fn(w, h, |x, y| Rgba(f(x, y)))
    }

    #[test]
    fn alpha_is_classified() {
        let with = |f: fn(u32) -> u8| alpha_use(&picture(100, 1, |x, _| [9, 9, 9, f(x)]));
        assert_eq!(with(|_| 255), AlphaUse::Opaque);
        assert_eq!(with(|_| 0), AlphaUse::Opaque);
        assert_eq!(with(|x| if x < 60 { 0 } else { 255 }), AlphaUse::Mask);
        let mostly = |x| match x {
            0..20 => 128,
            20..60 => 0,
            _ => 255,
        };
        assert_eq!(with(mostly), AlphaUse::Mask);
        assert_eq!(with(|_| 128), AlphaUse::Blend);
        assert_eq!(with(|x| (x * 2) as u8), AlphaUse::Blend);
        let levels = |f: fn(u32) -> u8| alpha_levels(&picture(100, 1, |x, _| [9, 9, 9, f(x)]));
        assert_eq!(levels(|_| 255), AlphaLevels::Full);
        assert_eq!(levels(|x| (x % 2) as u8 * 255), AlphaLevels::Two);
        assert_eq!(levels(|x| if x == 50 { 254 } else { 255 }), AlphaLevels::Many);
    }

    #[test]
    fn heights_become_normals_and_normals_stay() {
        // Rising to the right and upwards in the picture.
        let level = |x, y| (x * 8 + (15 - y) * 4) as u8;
        let ramp = picture(16, 16, |x, y| [level(x, y), level(x, y), level(x, y), 255]);
        let n = normal_map(ramp.clone(), 1.0, false);
        let p = n.get_pixel(8, 8);
        assert!(p[0] < 120 && p[1] < 126 && p[0] < p[1] && p[2] > 200, "{p:?}");
        let flat = picture(4, 4, |_, _| [128, 128, 255, 255]);
        assert_eq!(normal_map(flat.clone(), 1.0, false), flat);
        assert_eq!(normal_map(ramp.clone(), 1.0, true), ramp);
        let tilted = picture(4, 4, |_, _| [160, 128, 250, 255]);
        assert!(normal_map(tilted, 2.0, false).get_pixel(0, 0)[0] > 180);
    }

    #[test]
    fn metals_reflect_their_colour() {
        let base = picture(2, 1, |_, _| [200, 100, 50, 255]);
        let orm = picture(2, 1, |x, _| [0, 128, x as u8 * 255, 255]);
        let (diffuse, roughness) = metal(Some(base.clone()), Vec3::ONE, &orm, 1.0, false);
        assert_eq!(
            (diffuse.get_pixel(0, 0).0, diffuse.get_pixel(1, 0).0),
            ([200, 100, 50, 255], [116, 55, 25, 255])
        );
        assert!((roughness - 0.5).abs() < 0.01);
        let (specular, _) = metal(Some(base), Vec3::ONE, &orm, 1.0, true);
        assert_eq!(
            (specular.get_pixel(0, 0).0, specular.get_pixel(1, 0).0),
            ([56, 56, 56, 255], [200, 100, 50, 255])
        );
    }

    #[test]
    fn pictures_are_scaled_to_the_longest_edge() {
        assert_eq!(fitted([100, 50], 100), [100, 50]);
        assert_eq!(fitted([16384, 1], 1024), [1024, 1]);
    }

    #[test]
    fn names_are_unique_and_safe() {
        let mut taken = HashSet::new();
        let names = ["a b", "A b", "..", "", "ü/x"].map(|n| unique(&mut taken, n.into()));
        assert_eq!(names, ["a_b", "A_b-2", "unnamed", "unnamed-2", "ü_x"]);
    }
}
