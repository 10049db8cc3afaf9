//! The deferred renderer: g-buffer, ambient occlusion, lighting, bloom, tone mapping.

use std::rc::Rc;

use super::bloom::{BloomPass, BloomTargets};
use super::cluster::Culler;
use super::common::Common;
use super::g_buffer::{GBuffer, Layout};
use super::geometry::{GeometryPass, Part};
use super::lighting::LightingPass;
use super::request::{Columns, DrawRequest};
use super::role::{Role, RoleKind};
use super::scene::{FREE_UNIT, GpuScene};
use super::settings::RenderSettings;
use super::ssao::{SsaoPass, SsaoTargets};
use super::tonemap::TonemapPass;
use super::transparent::{DepthImage, Onto};
use super::view::{ViewImages, ViewRenderer};
use yoro::eyes::View;
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget, Texture};

/// Scene-referred colour of one view, and the intermediate images it is made from.
pub struct LightTargets {
    ssao: Option<SsaoTargets>,
    hdr: RenderTarget,
    /// The columns that are lit; all if `None`.
    columns: Option<Columns>,
}

impl LightTargets {
    pub fn new(gl: &Rc<Context>, settings: &RenderSettings) -> Result<LightTargets, GlError> {
        Ok(LightTargets {
            ssao: settings.ssao.then(|| SsaoTargets::new(gl, settings.ssao_scale())).transpose()?,
            hdr: RenderTarget::new(gl, [1, 1], &[(hdr_format(gl), Filter::Linear)], None)?,
            columns: None,
        })
    }

    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        self.ssao.as_mut().map_or(Ok(()), |t| t.resize(size))?;
        self.hdr.resize(size)
    }

    /// Returns the columns that are lit.
    fn lit_columns(&self) -> Columns {
        let all = [0, self.hdr.size()[0]];
        self.columns.unwrap_or(Columns { drawn: all, always: all })
    }

    /// Returns scene-referred colour, filtered linearly.
    pub fn hdr(&self) -> &Texture {
        self.hdr.color(0)
    }
}

/// Display-referred colour of one view, and the intermediate images it is made from.
pub struct FinishTargets {
    bloom: Option<BloomTargets>,
    color: RenderTarget,
}

impl FinishTargets {
    pub fn new(gl: &Rc<Context>, settings: &RenderSettings) -> Result<FinishTargets, GlError> {
        Ok(FinishTargets {
            bloom: settings.bloom.then(|| BloomTargets::new(gl, hdr_format(gl))).transpose()?,
            color: RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], None)?,
        })
    }

    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        self.bloom.as_mut().map_or(Ok(()), |t| t.resize(size))?;
        self.color.resize(size)
    }

    /// Returns display-referred sRGB colour with luma in alpha, filtered linearly.
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

impl ViewImages for DeferredTargets {
    fn color(&self) -> &RenderTarget {
        self.finish.color()
    }

    /// Has 24 bits for standard depth, and floats for reversed depth.
    fn depth(&self) -> &Texture {
        self.g_buffer.target().depth()
    }
}

/// Returns the format of scene-referred colour. EXT_color_buffer_half_float alone allows half floats but not packed
/// floats, so this asks the driver.
pub fn hdr_format(gl: &Rc<Context>) -> Format {
    if !gl.capabilities().float_render_targets {
        return Format::Rgba8;
    }
    first_renderable(gl, [Format::R11G11B10F, Format::Rgba16F])
}

/// Returns the first format that the driver can render to, or the last one if it can render to none.
pub fn first_renderable<const N: usize>(gl: &Rc<Context>, formats: [Format; N]) -> Format {
    let renders = |f: &Format| RenderTarget::new(gl, [1, 1], &[(*f, Filter::Linear)], None).is_ok();
    formats.into_iter().find(renders).unwrap_or(formats[N - 1])
}

/// The passes that light views of one role.
struct LightPasses {
    ssao: Option<SsaoPass>,
    lighting: LightingPass,
}

/// The deferred renderer of one scene: passes made for the scene's style and materials.
pub struct DeferredRenderer {
    pub(super) common: Common,
    ssao_radius: f32,
    /// Geometry passes by [`Layout::index`].
    geometry: [Option<GeometryPass>; Layout::COUNT],
    /// Light passes by [`RoleKind::index`].
    light: [Option<LightPasses>; RoleKind::COUNT],
    bloom: Option<BloomPass>,
    tonemap: TonemapPass,
}

impl DeferredRenderer {
    /// Compiles the programs for single views; [`DeferredRenderer::prepare`] compiles the others.
    pub(crate) fn new(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        scene: &GpuScene,
    ) -> Result<DeferredRenderer, GlError> {
        let mut hdr = Vec::new();
        if !gl.capabilities().float_render_targets {
            hdr.push(("NO_FLOAT_TARGETS", String::new()));
        }
        // Within half a metre of a small object lies all of it, which would darken it everywhere.
        let bounds = scene.bounds();
        let ssao_radius = settings.ssao_radius.min(0.1 * (bounds.max - bounds.min).length().max(1e-3));
        let bloom = settings.bloom.then(|| BloomPass::new(gl, &hdr)).transpose()?;
        if settings.bloom {
            hdr.push(("BLOOM", String::new()));
        }
        let mut renderer = DeferredRenderer {
            common: Common::new(gl, settings, scene)?,
            ssao_radius,
            geometry: [const { None }; Layout::COUNT],
            light: [const { None }; RoleKind::COUNT],
            bloom,
            tonemap: TonemapPass::new(gl, &hdr)?,
        };
        renderer.prepare(scene, Layout::Single, &[RoleKind::Whole])?;
        Ok(renderer)
    }

    /// Compiles the programs for views of these kinds, unless they are compiled already.
    pub(crate) fn prepare(
        &mut self,
        scene: &GpuScene,
        layout: Layout,
        roles: &[RoleKind],
    ) -> Result<(), GlError> {
        let Common { gl, settings, transparent, .. } = &mut self.common;
        if layout == Layout::Layered {
            transparent.prepare_layered(scene, settings)?;
        }
        let geometry = &mut self.geometry[layout.index()];
        if geometry.is_none() {
            *geometry = Some(GeometryPass::deferred(gl, scene, layout)?);
        }
        for &role in roles {
            let light = &mut self.light[role.index()];
            if light.is_none() {
                let scale = settings.ssao_scale();
                let ssao = settings.ssao.then(|| SsaoPass::new(gl, self.ssao_radius, scale, role));
                let lighting = LightingPass::new(gl, scene, settings, role)?;
                *light = Some(LightPasses { ssao: ssao.transpose()?, lighting });
            }
        }
        Ok(())
    }

    /// Clears a g-buffer and draws a part of the scene into it, for one view or both eyes. `mark` may mark pixels
    /// between the two. The g-buffer must fit the views, and its layout must be prepared.
    pub(crate) fn draw(
        &self,
        g_buffer: &GBuffer,
        scene: &GpuScene,
        views: &[View],
        part: Option<Part>,
        mark: impl FnOnce(&RenderTarget),
    ) {
        let (Some(pass), Some(view)) = (&self.geometry[g_buffer.layout().index()], views.first()) else {
            return;
        };
        let (gl, target) = (&self.common.gl, g_buffer.target());
        gl.pass("g-buffer", || {
            target.bind();
            gl.clear(Some(view.depth.clear_value()));
            mark(target);
            if let Some(part) = &part {
                target.bind();
                pass.draw(scene, views, part);
            }
        });
    }

    /// Lights a view of a g-buffer: computes ambient occlusion and scene-referred colour. The targets must fit the
    /// view, and its role must be prepared.
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
            pass.run(ssao, g_buffer, view, targets.lit_columns().always, role);
            occlusion = Some(ssao.result().color(0));
        }
        let (lights, shadow) = (self.common.lights(scene, &[*view]), self.common.shadow.as_ref());
        passes.lighting.run(&targets.hdr, g_buffer, occlusion, shadow, scene, view, &lights, role);
    }

    /// Turns scene-referred colour into display-referred colour, by bloom and tone mapping.
    pub(crate) fn finish(&self, targets: &FinishTargets, light: &LightTargets) {
        let Columns { drawn, always } = light.lit_columns();
        let mut glow = None;
        if let (Some(pass), Some(bloom)) = (&self.bloom, &targets.bloom) {
            pass.run(bloom, light.hdr(), always);
            glow = Some(bloom.result());
        }
        self.tonemap.run(&targets.color, (light.hdr(), drawn), glow, self.common.settings.exposure);
    }

    /// Draws the transparent surfaces of a scene, if it has any, over a finished image of `view`, which may be rendered
    /// or synthesized. `depth` is the image's window depth.
    pub(crate) fn draw_transparent(
        &self,
        to: &Destination,
        depth: DepthImage,
        scene: &GpuScene,
        view: &View,
    ) {
        if !scene.has_transparent() {
            return;
        }
        let lights = self.common.lights(scene, &[*view]);
        self.common.transparent.run(Onto::Image(to, depth), scene, view, &Culler::of_view(view), |program| {
            program.set("exposure", self.common.settings.exposure);
            if let Some(shadow) = &self.common.shadow {
                shadow.set(program, FREE_UNIT + 1, view.pose.position);
            }
            lights.set(program, &scene.sky);
        });
    }
}

impl ViewRenderer for DeferredRenderer {
    type Targets = DeferredTargets;

    fn common(&self) -> &Common {
        &self.common
    }

    fn targets(gl: &Rc<Context>, settings: &RenderSettings) -> Result<DeferredTargets, GlError> {
        Ok(DeferredTargets {
            g_buffer: GBuffer::new(gl, Layout::Single)?,
            light: LightTargets::new(gl, settings)?,
            finish: FinishTargets::new(gl, settings)?,
        })
    }

    fn render(
        &self,
        targets: &mut DeferredTargets,
        scene: &GpuScene,
        view: &View,
        request: &DrawRequest,
    ) -> Result<(), GlError> {
        targets.g_buffer.fit(view.size, view.depth.convention)?;
        targets.light.resize(view.size)?;
        targets.finish.resize(view.size)?;
        targets.light.columns = request.columns;
        let drawn = request.bounds(view);
        let culler = request.culler(view);
        self.common.gl.within_columns(drawn, || {
            let part = Some(Part::Selected(&culler));
            self.draw(&targets.g_buffer, scene, &[*view], part, |_| {});
            self.light(&targets.light, &targets.g_buffer, scene, view, Role::Whole);
        });
        self.finish(&targets.finish, &targets.light);
        Ok(())
    }

    fn render_all(
        &self,
        targets: &mut DeferredTargets,
        scene: &GpuScene,
        view: &View,
        _depth: bool,
    ) -> Result<(), GlError> {
        self.render(targets, scene, view, &DrawRequest::default())?;
        let (to, depth) = (Destination::whole(targets.color()), DepthImage::whole(targets.depth()));
        self.draw_transparent(&to, depth, scene, view);
        Ok(())
    }
}
