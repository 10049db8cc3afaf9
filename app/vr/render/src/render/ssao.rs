//! Screen-space ambient occlusion.

use std::f32::consts::TAU;
use std::rc::Rc;

use glam::{IVec3, Vec2, Vec4};

use super::role::{Role, RoleKind};
use super::uniforms::{pixel_rays, set_view};
use yoro::eyes::View;
use yoro_gl::{Context, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource};

/// Samples per pixel; must be even.
const SAMPLES: usize = 12;
/// Texels computed beyond the requested columns on either side.
const BESIDE: u32 = 3;
/// Turns of the spiral on which the samples lie; coprime to their number.
const TURNS: f32 = 5.0;

/// The two images of the pass.
pub struct SsaoTargets {
    raw: RenderTarget,
    blurred: RenderTarget,
    scale: u32,
}

impl SsaoTargets {
    /// Makes targets that are smaller by the factor `scale` than the views they are fitted to.
    pub fn new(gl: &Rc<Context>, scale: u32) -> Result<SsaoTargets, GlError> {
        let target = || RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Nearest)], None);
        Ok(SsaoTargets { raw: target()?, blurred: target()?, scale })
    }

    /// Fits the targets to a view of `size` pixels.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        let size = size.map(|n| n.div_ceil(self.scale));
        self.raw.resize(size)?;
        self.blurred.resize(size)
    }

    /// Returns the finished occlusion.
    pub fn result(&self) -> &RenderTarget {
        &self.blurred
    }
}

/// Computes ambient occlusion from 12 depth samples a pixel and a 4x4 blur that stays on a surface.
///
/// Reads the g-buffer's depth and normals, writes occlusion and distance (see `include/occlusion.glsl`).
pub struct SsaoPass {
    gl: Rc<Context>,
    sample: Program,
    blur: Program,
    kernel: [Vec4; SAMPLES / 2],
    radius: f32,
}

impl SsaoPass {
    /// Compiles programs for occlusion by surfaces within `radius` metres, at 1 / `scale` of the resolution (1 or 2),
    /// in views with a role.
    pub fn new(gl: &Rc<Context>, radius: f32, scale: u32, role: RoleKind) -> Result<SsaoPass, GlError> {
        let defines =
            [("SAMPLES", SAMPLES.to_string()), ("STRENGTH", "3.2".to_owned()), ("SCALE", scale.to_string())];
        let defines: Vec<_> = defines.into_iter().chain(role.define()).collect();
        let point = |i: usize| {
            let r = (i as f32 + 0.5) / SAMPLES as f32;
            let (sin, cos) = (r * TURNS * TAU).sin_cos();
            [r * cos, r * sin]
        };
        let kernel = std::array::from_fn(|i| {
            let ([ax, ay], [bx, by]) = (point(2 * i), point(2 * i + 1));
            Vec4::new(ax, ay, bx, by)
        });
        Ok(SsaoPass {
            gl: gl.clone(),
            sample: Program::new(gl, ShaderSource::Screen("render/ssao.frag"), &defines)?,
            blur: Program::new(gl, ShaderSource::Screen("render/ssao_blur.frag"), &[])?,
            kernel,
            radius,
        })
    }

    /// Computes the occlusion of the pixels that the role lights; that of other pixels is undefined. In the columns
    /// `[first, end]` that are always drawn, surfaces beside them cause no occlusion.
    pub fn run(
        &self,
        targets: &SsaoTargets,
        g_buffer: &RenderTarget,
        view: &View,
        always: [u32; 2],
        role: Role,
    ) {
        // The blur reads two texels to each side, and lighting one more.
        let columns = self.gl.columns().map(|[first, end]| {
            [(first / targets.scale).saturating_sub(BESIDE), end.div_ceil(targets.scale) + BESIDE]
        });
        let pass = || {
            self.gl.set_raster_state(&RasterState::SCREEN);
            let height = view.size[1] as f32;
            let pixels_at_1_m = self.radius * height / view.frustum.height();
            let squared = self.radius * self.radius;
            targets.raw.bind();
            self.sample
                .bind()
                .texture_of("depth_map", 0, g_buffer.depth())
                .texture_of("normal_map", 1, g_buffer.color(1))
                .set("kernel", &self.kernel[..])
                .set("bounds", IVec3::new(always[0] as i32, always[1] as i32 - 1, view.size[1] as i32 - 1))
                .set("radius", Vec2::new(pixels_at_1_m, 0.12 * height))
                .set("falloff", Vec4::new(squared, 1.0 / squared, 0.01 * squared, 0.01 * self.radius))
                .set("pixel_rays", pixel_rays(view));
            set_view(&self.sample, view);
            role.set(&self.sample, view);
            self.gl.draw_screen();
            targets.blurred.bind();
            self.blur.bind().texture("occlusion_map", 0, targets.raw.color(0).raw());
            self.gl.draw_screen();
        };
        self.gl.pass("ssao", || self.gl.within_columns(columns, pass));
    }
}
