//! The lighting pass.

use std::rc::Rc;

use super::lights::Lights;
use super::role::{Role, RoleKind};
use super::scene::GpuScene;
use super::settings::{MAX_POINT_LIGHTS, RenderSettings};
use super::shadow::ShadowMap;
use super::uniforms::set_view;
use yoro::eyes::View;
use yoro_gl::{Context, GlError, Program, RasterState, RenderTarget, ShaderSource, Texture};

/// Lights each pixel once.
///
/// Reads the g-buffer (16 bytes a pixel), ambient occlusion and the shadow map; writes scene-referred colour.
pub struct LightingPass {
    gl: Rc<Context>,
    program: Program,
}

/// Returns the defines of `include/shade.glsl` and `include/hdr.glsl` for a scene.
pub fn shading_defines(
    gl: &Context,
    scene: &GpuScene,
    settings: &RenderSettings,
) -> Vec<(&'static str, String)> {
    let mut defines = scene.style_defines();
    let mut define = |on: bool, name| {
        if on {
            defines.push((name, String::new()));
        }
    };
    define(scene.has_sun(), "SUN");
    define(scene.has_sun() && settings.shadow_map_size > 0, "SHADOWS");
    define(settings.ssao, "SSAO");
    define(!gl.capabilities().float_render_targets, "NO_FLOAT_TARGETS");
    defines.push(("SSAO_SCALE", settings.ssao_scale().to_string()));
    defines.push(("MAX_POINT_LIGHTS", MAX_POINT_LIGHTS.to_string()));
    defines
}

/// Returns the width of ink outlines in pixels.
pub fn line_width(view: &View) -> i32 {
    (view.size[1] as f32 / 900.0).round().max(1.0) as i32
}

impl LightingPass {
    /// Compiles the variant for the scene's style and light, and views of a role.
    pub fn new(
        gl: &Rc<Context>,
        scene: &GpuScene,
        settings: &RenderSettings,
        role: RoleKind,
    ) -> Result<LightingPass, GlError> {
        let mut defines = shading_defines(gl, scene, settings);
        defines.extend(role.define());
        let program = Program::new(gl, ShaderSource::Screen("render/lighting.frag"), &defines)?;
        Ok(LightingPass { gl: gl.clone(), program })
    }

    /// Lights a view of a g-buffer into `target`, as its role says.
    #[allow(clippy::too_many_arguments, reason = "a pass names what it reads")]
    pub fn run(
        &self,
        target: &RenderTarget,
        g_buffer: &RenderTarget,
        occlusion: Option<&Texture>,
        shadow: Option<&ShadowMap>,
        scene: &GpuScene,
        view: &View,
        lights: &Lights,
        role: Role,
    ) {
        self.gl.pass("lighting", || {
            self.gl.set_raster_state(&RasterState::SCREEN);
            target.bind();
            let program = self.program.bind();
            program
                .texture_of("depth_map", 0, g_buffer.depth())
                .texture_of("albedo_map", 1, g_buffer.color(0))
                .texture_of("normal_map", 2, g_buffer.color(1))
                .texture_of("emissive_map", 3, g_buffer.color(2))
                .set("line_width", line_width(view));
            if let Some(occlusion) = occlusion {
                program.texture("occlusion_map", 4, occlusion.raw());
            }
            if let Some(shadow) = shadow {
                shadow.set(program, 5, view.pose.position);
            }
            set_view(program, view);
            lights.set(program, &scene.sky);
            role.set(program, view);
            self.gl.draw_screen();
        });
    }
}
