//! One view of a scene: colour and depth, rendered the deferred way.
//!
//! sun shadow map (once per scene) -> g-buffer -> ambient occlusion -> lighting -> bloom -> tone mapping. What
//! belongs to the finished image of one eye comes after synthesis: [`Fxaa`] and the transparent surfaces
//! ([`Renderer::draw_transparent`]).

mod bloom;
mod cluster;
mod depth_copy;
mod fxaa;
mod g_buffer;
mod geometry;
mod lighting;
mod role;
mod scene;
mod settings;
mod shadow;
mod ssao;
#[cfg(test)]
mod tests;
mod tonemap;
mod transparent;
mod uniforms;

use std::rc::Rc;

use bloom::{BloomPass, BloomTargets};
use cluster::Culler;
pub use cluster::Selection;
pub use depth_copy::DepthCopy;
pub use fxaa::Fxaa;
pub(crate) use g_buffer::{GBuffer, Layout, Seam};
use geometry::GeometryPass;
use lighting::LightingPass;
pub(crate) use role::{Reprojection, Role, RoleKind};
pub use scene::GpuScene;
pub use settings::{MAX_POINT_LIGHTS, RenderSettings};
use shadow::ShadowMap;
use ssao::{SsaoPass, SsaoTargets};
use tonemap::TonemapPass;
pub use transparent::DepthImage;
use transparent::TransparentPass;
use uniforms::Lights;
pub(crate) use uniforms::depth_test;

use yoro::eyes::{DepthConvention, DepthRange, View};
use yoro::gl::{Context, Destination, Filter, Format, GlError, RenderTarget, Texture};

/// Scene-referred colour of one view, and what it is made with.
pub(crate) struct LightTargets {
    ssao: Option<SsaoTargets>,
    hdr: RenderTarget,
}

impl LightTargets {
    pub(crate) fn new(
        gl: &Rc<Context>,
        size: [u32; 2],
        settings: &RenderSettings,
    ) -> Result<LightTargets, GlError> {
        Ok(LightTargets {
            ssao: settings.ssao.then(|| SsaoTargets::new(gl, size, settings.ssao_scale())).transpose()?,
            hdr: RenderTarget::new(gl, size, &[(hdr_format(gl), Filter::Linear)], None)?,
        })
    }

    pub(crate) fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        self.ssao.as_mut().map_or(Ok(()), |t| t.resize(size))?;
        self.hdr.resize(size)
    }

    /// Scene-referred colour, filtered linearly.
    pub(crate) fn hdr(&self) -> &Texture {
        self.hdr.color(0)
    }
}

/// Display-referred colour of one view, and what it is made with.
pub(crate) struct FinishTargets {
    bloom: Option<BloomTargets>,
    color: RenderTarget,
}

impl FinishTargets {
    pub(crate) fn new(
        gl: &Rc<Context>,
        size: [u32; 2],
        settings: &RenderSettings,
    ) -> Result<FinishTargets, GlError> {
        Ok(FinishTargets {
            bloom: settings.bloom.then(|| BloomTargets::new(gl, size, hdr_format(gl))).transpose()?,
            color: RenderTarget::new(gl, size, &[(Format::Rgba8, Filter::Linear)], None)?,
        })
    }

    pub(crate) fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        self.bloom.as_mut().map_or(Ok(()), |t| t.resize(size))?;
        self.color.resize(size)
    }

    /// Display-referred sRGB colour with luma in alpha, filtered linearly.
    pub(crate) fn color(&self) -> &RenderTarget {
        &self.color
    }
}

/// The images of one view, from g-buffer to final colour.
pub struct ViewTargets {
    g_buffer: GBuffer,
    light: LightTargets,
    finish: FinishTargets,
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
        Ok(ViewTargets {
            g_buffer: GBuffer::new(gl, Layout::Single, size, convention)?,
            light: LightTargets::new(gl, size, settings)?,
            finish: FinishTargets::new(gl, size, settings)?,
        })
    }

    /// Fits the targets to a view; nothing is done when they fit already.
    ///
    /// # Errors
    /// As [`RenderTarget::new`].
    pub fn fit(&mut self, view: &View) -> Result<(), GlError> {
        self.g_buffer.fit(view.size, view.depth.convention)?;
        self.light.resize(view.size)?;
        self.finish.resize(view.size)
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.finish.color.size()
    }

    /// Display-referred sRGB colour with luma in alpha, filtered linearly.
    pub fn color(&self) -> &Texture {
        self.finish.color.color(0)
    }

    /// The framebuffer of [`ViewTargets::color`], to read it or to draw over it.
    pub fn color_target(&self) -> &RenderTarget {
        &self.finish.color
    }

    /// Window depth in the view's convention: 24 bits for standard, float for reversed depth.
    pub fn depth(&self) -> &Texture {
        self.g_buffer.target().depth()
    }

    /// The g-buffer: albedo and roughness, normal and reflectance, emission and material, depth.
    pub fn g_buffer(&self) -> &RenderTarget {
        self.g_buffer.target()
    }
}

/// EXT_color_buffer_half_float alone has half floats, but not the packed ones: the driver is asked by trying.
fn hdr_format(gl: &Rc<Context>) -> Format {
    if !gl.capabilities().float_render_targets {
        return Format::Rgba8;
    }
    first_renderable(gl, [Format::R11G11B10F, Format::Rgba16F])
}

/// The first format that the driver renders to, or the last.
fn first_renderable<const N: usize>(gl: &Rc<Context>, formats: [Format; N]) -> Format {
    let renders = |f: &Format| RenderTarget::new(gl, [1, 1], &[(*f, Filter::Linear)], None).is_ok();
    formats.into_iter().find(renders).unwrap_or(formats[N - 1])
}

/// The passes that light views of one role.
struct LightPasses {
    ssao: Option<SsaoPass>,
    lighting: LightingPass,
}

/// Renders views of one scene: its programs, made for the scene's style and materials, and the scene's shadow
/// map. Single views are ready after [`Renderer::new`]; what a stereo method needs besides is compiled once, with
/// its first frame of the scene or when [`crate::stereo::StereoMethod::prepare`] asks for it. Nothing is compiled
/// or allocated after that.
pub struct Renderer {
    gl: Rc<Context>,
    settings: RenderSettings,
    scene_id: u64,
    ssao_radius: f32,
    shadow: Option<ShadowMap>,
    /// By [`Layout::index`].
    geometry: [Option<GeometryPass>; Layout::COUNT],
    /// By [`RoleKind::index`].
    light: [Option<LightPasses>; RoleKind::COUNT],
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
        let mut renderer = Renderer {
            gl: gl.clone(),
            settings: settings.clone(),
            scene_id: scene.id,
            ssao_radius,
            shadow,
            geometry: [const { None }; Layout::COUNT],
            light: [const { None }; RoleKind::COUNT],
            bloom,
            tonemap: TonemapPass::new(gl, &hdr)?,
            transparent: TransparentPass::new(gl, scene, settings)?,
        };
        renderer.prepare(scene, Layout::Single, &[RoleKind::Whole])?;
        Ok(renderer)
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

    /// Compiles what views of these kinds need; nothing is done for what is there already.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for another scene than the renderer was made for; as [`Program::new`].
    pub(crate) fn prepare(
        &mut self,
        scene: &GpuScene,
        layout: Layout,
        roles: &[RoleKind],
    ) -> Result<(), GlError> {
        self.belongs_to(scene)?;
        let geometry = &mut self.geometry[layout.index()];
        if geometry.is_none() {
            *geometry = Some(GeometryPass::new(&self.gl, scene, layout)?);
        }
        if layout == Layout::Layered {
            self.transparent.prepare_layered(scene, &self.settings)?;
        }
        for &role in roles {
            let light = &mut self.light[role.index()];
            if light.is_none() {
                let (radius, scale) = (self.ssao_radius, self.settings.ssao_scale());
                let ssao = self.settings.ssao.then(|| SsaoPass::new(&self.gl, radius, scale, role));
                let lighting = LightingPass::new(&self.gl, scene, &self.settings, role)?;
                *light = Some(LightPasses { ssao: ssao.transpose()?, lighting });
            }
        }
        Ok(())
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
        let g_buffer = targets.g_buffer.target();
        if let Some(pass) = &self.geometry[Layout::Single.index()] {
            self.gl.pass("g-buffer", || {
                pass.clear(g_buffer, view);
                pass.draw_selected(g_buffer, scene, view, &culler);
            });
        }
        self.light(&targets.light, &targets.g_buffer, scene, view, Role::Whole);
        self.finish(&targets.finish, &targets.light);
        Ok(())
    }

    /// Whether anything opaque may be seen in a slice of a view (near and far plane in metres).
    pub(crate) fn sees_any(&self, scene: &GpuScene, view: &View, [near, far]: [f32; 2]) -> bool {
        let view = View { depth: DepthRange { near, far, ..view.depth }, ..*view };
        let culler = Culler::new(view.pose.position, &uniforms::eye_to_clip(&view), Selection::All);
        scene.opaque().any(|(_, clusters)| clusters.iter().any(|c| culler.sees(&c.bounds)))
    }

    /// Clears a g-buffer and draws one view, or both eyes, into it. Only what lies in `slice` (metres) is drawn;
    /// `mark` may mark pixels before that. The g-buffer fits the views, and its layout is prepared.
    pub(crate) fn draw(
        &self,
        g_buffer: &GBuffer,
        scene: &GpuScene,
        views: &[View],
        slice: Option<[f32; 2]>,
        mark: impl FnOnce(&RenderTarget),
    ) {
        let (Some(pass), Some(view)) = (&self.geometry[g_buffer.layout().index()], views.first()) else {
            return;
        };
        self.gl.pass("g-buffer", || {
            pass.clear(g_buffer.target(), view);
            mark(g_buffer.target());
            if let Some(slice) = slice {
                pass.draw(g_buffer.target(), scene, views, slice);
            }
        });
    }

    /// Lights a view of a g-buffer: ambient occlusion and scene-referred colour. The targets fit the view, and its
    /// role is prepared.
    pub(crate) fn light(
        &self,
        targets: &LightTargets,
        g_buffer: &GBuffer,
        scene: &GpuScene,
        view: &View,
        role: Role,
    ) {
        let Some(passes) = &self.light[role.kind().index()] else { return };
        let g_buffer = g_buffer.target();
        let mut occlusion = None;
        if let (Some(pass), Some(ssao)) = (&passes.ssao, &targets.ssao) {
            pass.run(ssao, g_buffer, view, role);
            occlusion = Some(ssao.result().color(0));
        }
        let (lights, shadow) = (self.lights(scene, view), self.shadow.as_ref());
        passes.lighting.run(&targets.hdr, g_buffer, occlusion, shadow, scene, view, &lights, role);
    }

    /// Bloom and tone mapping: scene-referred to display-referred colour.
    pub(crate) fn finish(&self, targets: &FinishTargets, light: &LightTargets) {
        let mut glow = None;
        if let (Some(pass), Some(bloom)) = (&self.bloom, &targets.bloom) {
            pass.run(bloom, light.hdr());
            glow = Some(bloom.result());
        }
        self.tonemap.run(&targets.color, light.hdr(), glow, self.settings.exposure);
    }

    fn lights(&self, scene: &GpuScene, view: &View) -> Lights {
        let culler = Culler::new(view.pose.position, &uniforms::eye_to_clip(view), Selection::All);
        Lights::choose(&scene.lights, view.pose.position, &culler, self.settings.point_lights)
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
        let lights = self.lights(scene, view);
        let shadow = self.shadow.as_ref();
        let exposure = self.settings.exposure;
        self.transparent.run(to, depth, shadow, scene, view, &culler, &lights, exposure);
        Ok(())
    }
}
