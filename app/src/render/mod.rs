//! One view of a scene: colour and depth, rendered the deferred way.
//!
//! sun shadow map (once per scene) -> g-buffer -> ambient occlusion -> lighting -> bloom -> tone mapping. What
//! belongs to the finished image of one eye comes after synthesis: [`Fxaa`] and the transparent surfaces
//! ([`Renderer::draw_transparent`]).

mod bloom;
mod cluster;
mod fxaa;
mod geometry;
mod lighting;
mod scene;
mod shadow;
mod ssao;
#[cfg(all(test, feature = "desktop"))]
mod tests;
mod tonemap;
mod transparent;
mod uniforms;

use std::rc::Rc;

use bloom::{BloomPass, BloomTargets};
pub use cluster::{Culler, Selection};
pub use fxaa::Fxaa;
use geometry::GeometryPass;
use lighting::LightingPass;
pub use scene::GpuScene;
use shadow::ShadowMap;
use ssao::{SsaoPass, SsaoTargets};
use tonemap::TonemapPass;
pub use transparent::DepthImage;
use transparent::TransparentPass;
use uniforms::Lights;

use crate::eyes::{DepthConvention, View};
pub use crate::gl::Destination;
use crate::gl::{Context, Filter, Format, GlError, RenderTarget, Texture};

/// The most point lights that light one view.
pub const MAX_POINT_LIGHTS: usize = 24;

/// What the renderer does and how well.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RenderSettings {
    /// Edge of the sun's shadow map in texels; 0 for no shadows.
    pub shadow_map_size: u32,
    /// Ambient occlusion.
    pub ssao: bool,
    /// Ambient occlusion at half the resolution: a quarter of the cost, softer at edges.
    pub ssao_half_size: bool,
    /// Radius of ambient occlusion in metres; at most a tenth of the scene's diagonal is used.
    pub ssao_radius: f32,
    /// Glow around what is brighter than white.
    pub bloom: bool,
    /// Number of point lights that light one view, at most [`MAX_POINT_LIGHTS`].
    pub point_lights: usize,
    /// Factor on scene-referred colour before the tone curve.
    pub exposure: f32,
}

impl Default for RenderSettings {
    fn default() -> RenderSettings {
        RenderSettings {
            shadow_map_size: 4096,
            ssao: true,
            ssao_half_size: false,
            ssao_radius: 0.5,
            bloom: true,
            point_lights: MAX_POINT_LIGHTS,
            exposure: 1.0,
        }
    }
}

impl RenderSettings {
    fn ssao_scale(&self) -> u32 {
        if self.ssao_half_size { 2 } else { 1 }
    }
}

/// The images of one view, from g-buffer to final colour.
pub struct ViewTargets {
    gl: Rc<Context>,
    convention: DepthConvention,
    g_buffer: RenderTarget,
    ssao: Option<SsaoTargets>,
    hdr: RenderTarget,
    bloom: Option<BloomTargets>,
    color: RenderTarget,
}

impl ViewTargets {
    /// Targets for views of `size` pixels with the given depth.
    ///
    /// # Errors
    /// As [`RenderTarget::new`].
    pub fn new(
        gl: &Rc<Context>,
        size: [u32; 2],
        convention: DepthConvention,
        settings: &RenderSettings,
    ) -> Result<ViewTargets, GlError> {
        let hdr = hdr_format(gl);
        Ok(ViewTargets {
            gl: gl.clone(),
            convention,
            g_buffer: g_buffer(gl, size, convention)?,
            ssao: settings.ssao.then(|| SsaoTargets::new(gl, size, settings.ssao_scale())).transpose()?,
            hdr: RenderTarget::new(gl, size, &[(hdr, Filter::Linear)], None)?,
            bloom: settings.bloom.then(|| BloomTargets::new(gl, size, hdr)).transpose()?,
            color: RenderTarget::new(gl, size, &[(Format::Rgba8, Filter::Linear)], None)?,
        })
    }

    /// Fits the targets to a view; nothing is done when they fit already.
    ///
    /// # Errors
    /// As [`RenderTarget::new`].
    pub fn fit(&mut self, view: &View) -> Result<(), GlError> {
        if view.depth.convention != self.convention {
            self.g_buffer = g_buffer(&self.gl, view.size, view.depth.convention)?;
            self.convention = view.depth.convention;
        }
        self.g_buffer.resize(view.size)?;
        self.ssao.as_mut().map_or(Ok(()), |t| t.resize(view.size))?;
        self.hdr.resize(view.size)?;
        self.bloom.as_mut().map_or(Ok(()), |t| t.resize(view.size))?;
        self.color.resize(view.size)
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.color.size()
    }

    /// Display-referred sRGB colour with luma in alpha, filtered linearly.
    pub fn color(&self) -> &Texture {
        self.color.color(0)
    }

    /// The framebuffer of [`ViewTargets::color`], to read it or to draw over it.
    pub fn color_target(&self) -> &RenderTarget {
        &self.color
    }

    /// Window depth in the view's convention: 24 bits for standard, float for reversed depth.
    pub fn depth(&self) -> &Texture {
        self.g_buffer.depth()
    }

    /// The g-buffer: albedo and roughness, normal and reflectance, emission and material, depth.
    pub fn g_buffer(&self) -> &RenderTarget {
        &self.g_buffer
    }
}

fn g_buffer(gl: &Rc<Context>, size: [u32; 2], convention: DepthConvention) -> Result<RenderTarget, GlError> {
    let depth = match convention {
        DepthConvention::Standard => Format::Depth24,
        DepthConvention::Reversed => Format::Depth32F,
    };
    RenderTarget::new(gl, size, &geometry::FORMATS, Some(depth))
}

fn hdr_format(gl: &Context) -> Format {
    if gl.capabilities().float_render_targets { Format::R11G11B10F } else { Format::Rgba8 }
}

/// Renders views of one scene: its programs, made for the scene's style and materials, and the scene's shadow
/// map. Nothing is compiled or allocated after [`Renderer::new`].
pub struct Renderer {
    settings: RenderSettings,
    scene_id: u64,
    shadow: Option<ShadowMap>,
    geometry: GeometryPass,
    ssao: Option<SsaoPass>,
    lighting: LightingPass,
    bloom: Option<BloomPass>,
    tonemap: TonemapPass,
    transparent: TransparentPass,
}

impl Renderer {
    /// Compiles the programs for a scene and draws its shadow map.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a program or a target.
    pub fn new(gl: &Rc<Context>, settings: &RenderSettings, scene: &GpuScene) -> Result<Renderer, GlError> {
        let shadow = (scene.has_sun() && settings.shadow_map_size > 0)
            .then(|| ShadowMap::new(gl, scene, settings.shadow_map_size))
            .transpose()?;
        let mut hdr = Vec::new();
        if !gl.capabilities().float_render_targets {
            hdr.push(("NO_FLOAT_TARGETS", String::new()));
        }
        // Half a metre around a small object would darken all of it.
        let bounds = scene.bounds();
        let ssao_radius = settings.ssao_radius.min(0.1 * (bounds.max - bounds.min).length().max(1e-3));
        let bloom = settings.bloom.then(|| BloomPass::new(gl, &hdr)).transpose()?;
        if settings.bloom {
            hdr.push(("BLOOM", String::new()));
        }
        Ok(Renderer {
            settings: settings.clone(),
            scene_id: scene.id,
            shadow,
            geometry: GeometryPass::new(gl, scene)?,
            ssao: settings.ssao.then(|| SsaoPass::new(gl, ssao_radius, settings.ssao_scale())).transpose()?,
            lighting: LightingPass::new(gl, scene, settings)?,
            bloom,
            tonemap: TonemapPass::new(gl, &hdr)?,
            transparent: TransparentPass::new(gl, scene, settings)?,
        })
    }

    /// The settings it was made with.
    pub fn settings(&self) -> &RenderSettings {
        &self.settings
    }

    fn belongs_to(&self, scene: &GpuScene) -> Result<(), GlError> {
        if scene.id == self.scene_id {
            return Ok(());
        }
        Err(GlError::Unsupported(format!(
            "this renderer was made for another scene than {}; make one for each scene",
            scene.name
        )))
    }

    /// Renders the opaque part of a scene: colour and depth in `targets`, which are fitted to the view. Where
    /// nothing is drawn, depth keeps its far value and colour is the sky.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for another scene than the renderer was made for; as [`RenderTarget::new`]
    /// when the targets have to change their size.
    pub fn render(
        &mut self,
        targets: &mut ViewTargets,
        scene: &GpuScene,
        view: &View,
        selection: Selection,
    ) -> Result<(), GlError> {
        self.belongs_to(scene)?;
        targets.fit(view)?;
        let culler = Culler::new(view.pose.position, &uniforms::eye_to_clip(view), selection);
        let lights = Lights::choose(&scene.lights, view.pose.position, &culler, self.settings.point_lights);
        self.geometry.run(&targets.g_buffer, scene, view, &culler);
        let mut occlusion = None;
        if let (Some(pass), Some(ssao)) = (&self.ssao, &targets.ssao) {
            pass.run(ssao, &targets.g_buffer, view);
            occlusion = Some(ssao.result().color(0));
        }
        let shadow = self.shadow.as_ref();
        self.lighting.run(&targets.hdr, &targets.g_buffer, occlusion, shadow, scene, view, &lights);
        let hdr = targets.hdr.color(0);
        let mut glow = None;
        if let (Some(pass), Some(bloom)) = (&self.bloom, &targets.bloom) {
            pass.run(bloom, hdr);
            glow = Some(bloom.result());
        }
        self.tonemap.run(&targets.color, hdr, glow, self.settings.exposure);
        Ok(())
    }

    /// Draws the transparent part of a scene over a finished image of `view`, whose window depth is `depth`.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for another scene than the renderer was made for.
    pub fn draw_transparent(
        &mut self,
        to: &Destination,
        depth: DepthImage,
        scene: &GpuScene,
        view: &View,
    ) -> Result<(), GlError> {
        self.belongs_to(scene)?;
        let culler = Culler::new(view.pose.position, &uniforms::eye_to_clip(view), Selection::All);
        let lights = Lights::choose(&scene.lights, view.pose.position, &culler, self.settings.point_lights);
        let shadow = self.shadow.as_ref();
        let exposure = self.settings.exposure;
        self.transparent.run(to, depth, shadow, scene, view, &culler, &lights, exposure);
        Ok(())
    }
}
