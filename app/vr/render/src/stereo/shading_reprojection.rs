//! Reprojects the dominant eye's shading to the other eye's own geometry, and shades only the disocclusions.
//!
//! After Oculus, "Introducing Stereo Shading Reprojection for Unity" (2017): the second eye's geometry is drawn again,
//! so the depth of its pixels is known, and with it their places in the dominant eye's image. Depths are compared
//! there; pixels that the dominant eye does not see are shaded. The extra cost over synthesis is the second g-buffer.

use std::rc::Rc;

use glam::Vec2;

use super::finish::{EyeImage, Finish};
use super::frame::{Frame, FrameMethod, Setup};
use super::method::StereoError;
use crate::render::{
    DeferredRenderer, DepthImage, FinishTargets, GBuffer, GpuScene, Layout, LightTargets, Part, Reprojection,
    Role, RoleKind,
};
use yoro::eyes::{DisparityLaw, EyePair, GuardBand};
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource,
};

/// Draws two g-buffers, and runs ambient occlusion and lighting once, and again for disocclusions.
///
/// Colours are taken before bloom and tone mapping, which run for each eye. Disocclusions are a mask that ambient
/// occlusion and lighting look up, not a stencil: these passes have different framebuffers, ambient occlusion also
/// needs the mask's surroundings, and skipped pixels return after one texel.
pub struct ShadingReprojection {
    gl: Rc<Context>,
    /// Dominant, second.
    g_buffers: [GBuffer; 2],
    /// Dominant, second.
    light: [LightTargets; 2],
    image: FinishTargets,
    disocclusion: RenderTarget,
    find: Program,
    finish: Finish,
}

impl ShadingReprojection {
    /// Makes the targets.
    pub(super) fn new(setup: &Setup) -> Result<ShadingReprojection, GlError> {
        let Setup { gl, settings, .. } = *setup;
        let g_buffer = || GBuffer::new(gl, Layout::Single);
        let light = || LightTargets::new(gl, settings);
        Ok(ShadingReprojection {
            gl: gl.clone(),
            g_buffers: [g_buffer()?, g_buffer()?],
            light: [light()?, light()?],
            image: FinishTargets::new(gl, settings)?,
            disocclusion: RenderTarget::new(gl, [1, 1], &[(Format::Rg8, Filter::Linear)], None)?,
            find: Program::new(gl, ShaderSource::Screen("stereo/disocclusion.frag"), &[])?,
            finish: Finish::new(setup)?,
        })
    }

    /// Finds the second eye's pixels that the dominant eye does not see.
    fn find_disocclusions(&self, pair: &EyePair, reprojection: &Reprojection) {
        let (c, m) = pair.depth.inverse_distance_law();
        let disparity_at_1_m = (pair.focal_length_pixels() * pair.ipd()).abs();
        self.gl.pass("disocclusion", || {
            self.gl.set_raster_state(&RasterState::SCREEN);
            self.disocclusion.bind();
            self.find
                .bind()
                .texture_of("depth_map", 0, self.g_buffers[1].target().depth())
                .texture_of("dominant_depth", 1, self.g_buffers[0].target().depth())
                .set("inverse_distance", Vec2::new(c as f32, m as f32))
                .set("half_pixel", 0.5 / disparity_at_1_m.max(1e-6))
                .set("far_depth", pair.depth.clear_value());
            reprojection.set_law(&self.find);
            self.gl.draw_screen();
        });
    }

    /// Returns the second eye's disocclusions in the last frame: 1 in the red channel.
    #[cfg(test)]
    pub(super) fn disocclusion(&self) -> &RenderTarget {
        &self.disocclusion
    }
}

impl FrameMethod for ShadingReprojection {
    type Renderer = DeferredRenderer;

    fn compile(&mut self, renderer: &mut DeferredRenderer, scene: &GpuScene) -> Result<(), GlError> {
        renderer.prepare(scene, Layout::Single, &[RoleKind::Whole, RoleKind::Reprojected])
    }

    fn render_frame(&mut self, frame: &Frame<DeferredRenderer>) -> Result<(), StereoError> {
        let Frame { renderer, scene, pair, .. } = frame;
        // The law for the dominant eye's own image instead of one with both frusta: pixels outside of it are shaded.
        let views = pair.synthesis_views(GuardBand::None)?;
        let [left, bottom] = views.dominant_crop;
        let law = DisparityLaw { offset: views.warp.law.offset + f64::from(left), ..views.warp.law };
        let row_offset = views.warp.row_offset + bottom as i32;
        for g_buffer in &mut self.g_buffers {
            g_buffer.fit(pair.size, pair.depth.convention)?;
        }
        for light in &mut self.light {
            light.resize(pair.size)?;
        }
        self.image.resize(pair.size)?;
        self.disocclusion.resize(pair.size)?;
        for (i, eye) in [pair.dominant, pair.dominant.other()].into_iter().enumerate() {
            let (view, g_buffer) = (pair.view(eye), &self.g_buffers[i]);
            renderer.draw(
                g_buffer,
                scene,
                &[view],
                Some(Part::Slice([pair.depth.near, pair.depth.far])),
                |_| {},
            );
            let mut role = Role::Whole;
            if eye != pair.dominant {
                let reprojection = Reprojection {
                    color: self.light[0].hdr(),
                    disocclusion: self.disocclusion.color(0),
                    law,
                    row_offset,
                };
                self.find_disocclusions(pair, &reprojection);
                role = Role::Reprojected(reprojection);
            }
            renderer.light(&self.light[i], g_buffer, scene, &view, role);
            renderer.finish(&self.image, &self.light[i]);
            let (color, depth) = (self.image.color(), DepthImage::whole(g_buffer.target().depth()));
            renderer.draw_transparent(&Destination::whole(color), depth, scene, &view);
            self.finish.run(&EyeImage { color, origin: [0, 0], depth: Some(depth) }, frame.to(eye));
        }
        Ok(())
    }
}
