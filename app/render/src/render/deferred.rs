//! The deferred renderer: g-buffer, ambient occlusion, lighting, bloom, tone mapping.

use std::rc::Rc;

use super::Columns;
use super::bloom::{BloomPass, BloomTargets};
use super::cluster::Culler;
use super::g_buffer::{GBuffer, Layout};
use super::geometry::GeometryPass;
use super::lighting::LightingPass;
use super::role::{Role, RoleKind};
use super::scene::GpuScene;
use super::settings::RenderSettings;
use super::shadow::ShadowMap;
use super::ssao::{SsaoPass, SsaoTargets};
use super::tonemap::TonemapPass;
use super::uniforms::Lights;
use yoro::eyes::{DepthConvention, View};
use yoro_gl::{Context, Filter, Format, GlError, RenderTarget, Texture};

/// Scene-referred colour of one view, and what it is made with.
pub struct LightTargets {
    ssao: Option<SsaoTargets>,
    hdr: RenderTarget,
    /// Which columns are lit; all if none.
    pub columns: Option<Columns>,
}

impl LightTargets {
    pub fn new(gl: &Rc<Context>, size: [u32; 2], settings: &RenderSettings) -> Result<LightTargets, GlError> {
        Ok(LightTargets {
            ssao: settings.ssao.then(|| SsaoTargets::new(gl, size, settings.ssao_scale())).transpose()?,
            hdr: RenderTarget::new(gl, size, &[(hdr_format(gl), Filter::Linear)], None)?,
            columns: None,
        })
    }

    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        self.ssao.as_mut().map_or(Ok(()), |t| t.resize(size))?;
        self.hdr.resize(size)
    }

    /// Which columns are lit.
    fn lit_columns(&self) -> Columns {
        let all = [0, self.hdr.size()[0]];
        self.columns.unwrap_or(Columns { drawn: all, always: all })
    }

    /// Scene-referred colour, filtered linearly.
    pub fn hdr(&self) -> &Texture {
        self.hdr.color(0)
    }

    /// The framebuffer of [`LightTargets::hdr`].
    #[cfg(test)]
    pub fn target(&self) -> &RenderTarget {
        &self.hdr
    }
}

/// Display-referred colour of one view, and what it is made with.
pub struct FinishTargets {
    bloom: Option<BloomTargets>,
    color: RenderTarget,
}

impl FinishTargets {
    pub fn new(
        gl: &Rc<Context>,
        size: [u32; 2],
        settings: &RenderSettings,
    ) -> Result<FinishTargets, GlError> {
        Ok(FinishTargets {
            bloom: settings.bloom.then(|| BloomTargets::new(gl, size, hdr_format(gl))).transpose()?,
            color: RenderTarget::new(gl, size, &[(Format::Rgba8, Filter::Linear)], None)?,
        })
    }

    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        self.bloom.as_mut().map_or(Ok(()), |t| t.resize(size))?;
        self.color.resize(size)
    }

    /// Display-referred sRGB colour with luma in alpha, filtered linearly.
    pub fn color(&self) -> &RenderTarget {
        &self.color
    }
}

/// The images of one view, from g-buffer to final colour.
pub struct DeferredTargets {
    pub g_buffer: GBuffer,
    pub light: LightTargets,
    pub finish: FinishTargets,
}

impl DeferredTargets {
    pub fn new(
        gl: &Rc<Context>,
        size: [u32; 2],
        convention: DepthConvention,
        settings: &RenderSettings,
    ) -> Result<DeferredTargets, GlError> {
        Ok(DeferredTargets {
            g_buffer: GBuffer::new(gl, Layout::Single, size, convention)?,
            light: LightTargets::new(gl, size, settings)?,
            finish: FinishTargets::new(gl, size, settings)?,
        })
    }

    pub fn fit(&mut self, view: &View) -> Result<(), GlError> {
        self.g_buffer.fit(view.size, view.depth.convention)?;
        self.light.resize(view.size)?;
        self.finish.resize(view.size)
    }
}

/// EXT_color_buffer_half_float alone has half floats, but not the packed ones: the driver is asked by trying.
pub fn hdr_format(gl: &Rc<Context>) -> Format {
    if !gl.capabilities().float_render_targets {
        return Format::Rgba8;
    }
    first_renderable(gl, [Format::R11G11B10F, Format::Rgba16F])
}

/// The first format that the driver renders to, or the last.
pub fn first_renderable<const N: usize>(gl: &Rc<Context>, formats: [Format; N]) -> Format {
    let renders = |f: &Format| RenderTarget::new(gl, [1, 1], &[(*f, Filter::Linear)], None).is_ok();
    formats.into_iter().find(renders).unwrap_or(formats[N - 1])
}

/// The passes that light views of one role.
struct LightPasses {
    ssao: Option<SsaoPass>,
    lighting: LightingPass,
}

/// The passes, made for a scene's style and materials.
pub struct Deferred {
    gl: Rc<Context>,
    settings: RenderSettings,
    ssao_radius: f32,
    /// By [`Layout::index`].
    geometry: [Option<GeometryPass>; Layout::COUNT],
    /// By [`RoleKind::index`].
    light: [Option<LightPasses>; RoleKind::COUNT],
    bloom: Option<BloomPass>,
    tonemap: TonemapPass,
}

impl Deferred {
    /// Compiles what all views need; [`Deferred::prepare`] does the rest.
    ///
    /// # Errors
    /// As [`yoro_gl::Program::new`].
    pub fn new(gl: &Rc<Context>, settings: &RenderSettings, scene: &GpuScene) -> Result<Deferred, GlError> {
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
        Ok(Deferred {
            gl: gl.clone(),
            settings: settings.clone(),
            ssao_radius,
            geometry: [const { None }; Layout::COUNT],
            light: [const { None }; RoleKind::COUNT],
            bloom,
            tonemap: TonemapPass::new(gl, &hdr)?,
        })
    }

    /// Compiles what views of these kinds need; nothing is done for what is there already.
    ///
    /// # Errors
    /// As [`yoro_gl::Program::new`].
    pub fn prepare(&mut self, scene: &GpuScene, layout: Layout, roles: &[RoleKind]) -> Result<(), GlError> {
        let geometry = &mut self.geometry[layout.index()];
        if geometry.is_none() {
            *geometry = Some(GeometryPass::deferred(&self.gl, scene, layout)?);
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

    /// Fills a g-buffer with what the culler of its one view lets through.
    pub fn draw_selected(&self, g_buffer: &GBuffer, scene: &GpuScene, view: &View, culler: &Culler) {
        let Some(pass) = &self.geometry[Layout::Single.index()] else { return };
        self.gl.pass("g-buffer", || {
            g_buffer.target().bind();
            self.gl.clear(Some(view.depth.clear_value()));
            pass.draw_selected(scene, view, culler);
        });
    }

    /// As [`super::Renderer::draw`].
    pub fn draw(
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
        let target = g_buffer.target();
        self.gl.pass("g-buffer", || {
            target.bind();
            self.gl.clear(Some(view.depth.clear_value()));
            mark(target);
            if let Some(slice) = slice {
                target.bind();
                pass.draw(scene, views, slice);
            }
        });
    }

    /// As [`super::Renderer::light`], by these lights.
    #[allow(clippy::too_many_arguments, reason = "a pass names what it reads")]
    pub fn light(
        &self,
        targets: &LightTargets,
        g_buffer: &GBuffer,
        shadow: Option<&ShadowMap>,
        scene: &GpuScene,
        view: &View,
        lights: &Lights,
        role: Role,
    ) {
        let Some(passes) = &self.light[role.kind().index()] else { return };
        let g_buffer = g_buffer.target();
        let mut occlusion = None;
        if let (Some(pass), Some(ssao)) = (&passes.ssao, &targets.ssao) {
            pass.run(ssao, g_buffer, view, targets.lit_columns().always, role);
            occlusion = Some(ssao.result().color(0));
        }
        passes.lighting.run(&targets.hdr, g_buffer, occlusion, shadow, scene, view, lights, role);
    }

    /// As [`super::Renderer::finish`].
    pub fn finish(&self, targets: &FinishTargets, light: &LightTargets) {
        let exposure = self.settings.exposure;
        let Columns { drawn, always } = light.lit_columns();
        let mut glow = None;
        if let (Some(pass), Some(bloom)) = (&self.bloom, &targets.bloom) {
            pass.run(bloom, light.hdr(), always);
            glow = Some(bloom.result());
        }
        self.tonemap.run(&targets.color, (light.hdr(), drawn), glow, exposure);
    }
}
