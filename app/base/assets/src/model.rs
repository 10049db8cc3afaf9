//! The parts of a scene in memory, before any GL.

use std::ops::Range;

use glam::{Vec2, Vec3};

use yoro::eyes::Pose;

/// One vertex: 32 bytes, uploaded as is.
#[repr(C)]
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    bytemuck::Pod,
    bytemuck::Zeroable,
    serde::Serialize,
    serde::Deserialize,
)]
pub struct Vertex {
    /// Position in metres, world space.
    pub position: Vec3,
    /// Unit normal, world space.
    pub normal: Vec3,
    /// Texture coordinates; (0, 0) is the lower left corner of the picture.
    pub uv: Vec2,
}

/// A named run of triangles with one material.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Part {
    /// Name of the object it belongs to.
    pub name: String,
    /// Index into [`Model::materials`].
    pub material: usize,
    /// Range of [`Model::indices`]; its length is a multiple of three.
    pub indices: Range<usize>,
}

/// How the diffuse map's alpha is used. In a file: `"opaque"`, `{"cutout": 0.5}` or `{"blend": 0.3}`.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Alpha {
    /// Ignored.
    #[default]
    Opaque,
    /// Fragments with alpha below this are discarded: leaves, fences, grilles.
    Cutout(f32),
    /// Blended after the opaque surfaces, with this opacity times the map's alpha.
    Blend(f32),
}

/// A material in the terms of MTL. Colours are display-referred (sRGB), 0 to 1.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Material {
    /// Name, unique in the model.
    pub name: String,
    /// Diffuse colour (Kd), multiplied with the diffuse map.
    pub diffuse: Vec3,
    /// Specular colour (Ks).
    pub specular: Vec3,
    /// Emitted colour (Ke); may exceed 1.
    pub emissive: Vec3,
    /// GGX roughness, 0 to 1; from Pr, or from the Blinn-Phong exponent Ns by `sqrt(2 / (Ns + 2))`.
    pub roughness: f32,
    /// Opacity and cut-out.
    pub alpha: Alpha,
    /// Drawn from both sides; normals face the eye.
    pub double_sided: bool,
    /// Shown in its diffuse colour whatever the light, without tone mapping: scans that contain their light.
    pub unlit: bool,
    /// Diffuse colour map; as all maps, an index into [`Model::textures`].
    pub diffuse_map: Option<usize>,
    /// Specular colour map.
    pub specular_map: Option<usize>,
    /// Emissive colour map.
    pub emissive_map: Option<usize>,
    /// Tangent-space normal map, OpenGL convention (green up).
    pub normal_map: Option<usize>,
}

impl Default for Material {
    fn default() -> Material {
        Material {
            name: "default".into(),
            diffuse: Vec3::splat(0.7),
            specular: Vec3::splat(0.2),
            emissive: Vec3::ZERO,
            roughness: 0.7,
            alpha: Alpha::Opaque,
            double_sided: false,
            unlit: false,
            diffuse_map: None,
            specular_map: None,
            emissive_map: None,
            normal_map: None,
        }
    }
}

/// A picture in memory: 8-bit RGBA, row 0 at the top, not premultiplied.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TextureImage {
    /// Name, unique in the model; the file name without extension on export.
    pub name: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// `width * height * 4` bytes.
    pub rgba: Vec<u8>,
    /// True for colour (sRGB), false for data (normal maps).
    pub srgb: bool,
    /// True to not filter between texels when magnified (pixel art, voxel scenes).
    pub nearest: bool,
}

/// Triangles, materials and pictures.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Model {
    /// All vertices.
    pub vertices: Vec<Vertex>,
    /// Triangle list.
    pub indices: Vec<u32>,
    /// The triangles of each material.
    pub parts: Vec<Part>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Pictures.
    pub textures: Vec<TextureImage>,
}

impl Model {
    /// Returns the number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// Returns the smallest box around all vertices; empty (min > max) for an empty model.
    pub fn bounds(&self) -> Bounds {
        self.vertices.iter().fold(Bounds::EMPTY, |b, v| b.including(v.position))
    }
}

/// An axis-aligned box in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest corner.
    pub min: Vec3,
    /// Largest corner.
    pub max: Vec3,
}

impl Bounds {
    /// Contains nothing.
    pub const EMPTY: Bounds = Bounds { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// Returns the box enlarged to contain a point.
    pub fn including(self, p: Vec3) -> Bounds {
        Bounds { min: self.min.min(p), max: self.max.max(p) }
    }

    /// Returns the centre.
    pub fn center(&self) -> Vec3 {
        (self.min + self.max) * 0.5
    }

    /// True if the box contains nothing.
    pub fn is_empty(&self) -> bool {
        self.min.x > self.max.x
    }

    /// Returns the distance in metres from a point to the box; 0 inside.
    pub fn distance(&self, p: Vec3) -> f32 {
        (self.min - p).max(p - self.max).max(Vec3::ZERO).length()
    }
}

/// How shading turns light into colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ShadingStyle {
    /// GGX, smooth normals.
    #[default]
    Realistic,
    /// Few bands of light, saturated colours, no outlines.
    Cartoon,
    /// One normal per triangle.
    LowPoly,
    /// One normal per face, unfiltered textures, ambient occlusion in the foreground.
    Voxel,
    /// Toon ramp with a tinted shadow side, rim light and ink outlines.
    Anime,
}

impl ShadingStyle {
    /// All styles.
    pub const ALL: [ShadingStyle; 5] = [
        ShadingStyle::Realistic,
        ShadingStyle::Cartoon,
        ShadingStyle::LowPoly,
        ShadingStyle::Voxel,
        ShadingStyle::Anime,
    ];

    /// Returns its name in files and settings.
    pub fn name(self) -> &'static str {
        match self {
            ShadingStyle::Realistic => "realistic",
            ShadingStyle::Cartoon => "cartoon",
            ShadingStyle::LowPoly => "low-poly",
            ShadingStyle::Voxel => "voxel",
            ShadingStyle::Anime => "anime",
        }
    }
}

/// A point light with a limited range.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PointLight {
    /// Position in metres.
    pub position: Vec3,
    /// Linear RGB intensity at one metre (the sun's noon value is about 3).
    pub color: Vec3,
    /// Distance in metres at which the light has faded to zero.
    pub range: f32,
}

/// The sun and the sky.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sky {
    /// Unit vector towards the sun.
    pub sun_direction: Vec3,
    /// Linear RGB irradiance of the sun; zero for no sun, which also skips the shadow map.
    pub sun_color: Vec3,
    /// Linear RGB of the sky overhead: background and ambient light from above.
    pub zenith: Vec3,
    /// Linear RGB of the sky at the horizon; the background fades between the two.
    pub horizon: Vec3,
    /// Linear RGB of the ambient light from below.
    pub ground: Vec3,
}

impl Default for Sky {
    fn default() -> Sky {
        Sky {
            sun_direction: Vec3::new(0.35, 0.8, 0.48).normalize(),
            sun_color: Vec3::new(3.0, 2.85, 2.6),
            zenith: Vec3::new(0.22, 0.38, 0.75),
            horizon: Vec3::new(0.6, 0.7, 0.8),
            ground: Vec3::new(0.22, 0.2, 0.18),
        }
    }
}

/// A viewpoint: a position and what it looks at. An array of these is the format of `camera.json`.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Viewpoint {
    /// Position of the head in metres.
    pub position: Vec3,
    /// The point that the head looks at.
    pub target: Vec3,
}

impl Viewpoint {
    /// Returns the head's pose.
    pub fn pose(&self) -> Pose {
        Pose::look_at(self.position, self.target)
    }
}
