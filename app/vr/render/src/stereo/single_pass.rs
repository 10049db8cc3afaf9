//! Draws both eyes in one set of draw calls: by instancing, side by side, or by GL_OVR_multiview2 into layers. Bloom runs
//! for each eye.

use super::frame::Frame;
use super::method::{StereoError, StereoMethod};
use crate::view::{GpuScene, Layout, Renderer, Seam, Targets};
use yoro::eyes::Eye;
use yoro_gl::Context;

/// Culls once, and issues one draw call per visible range of triangles, for both eyes.
///
/// Compared with two renders it saves half of the CPU's draw calls and, with multiview on hardware that shares it, some
/// vertex work. Every pixel is still rasterized and shaded for each eye. Layers have one sample in each pixel.
pub struct SinglePass {
    layout: Layout,
    targets: Option<Targets>,
}

impl SinglePass {
    /// Makes single-pass stereo by instancing, with clip distances if the driver has them.
    pub(super) fn instanced(gl: &Context) -> SinglePass {
        let has_clip_distances = gl.capabilities().clip_distances;
        let seam = if has_clip_distances { Seam::ClipDistance } else { Seam::Discard };
        SinglePass::new(Layout::DoubleWide(seam))
    }

    /// Makes single-pass stereo with a layout of both eyes. [`Layout::Layered`] means multiview.
    pub(super) fn new(layout: Layout) -> SinglePass {
        SinglePass { layout, targets: None }
    }
}

impl StereoMethod for SinglePass {
    fn prepare(&mut self, renderer: &mut Renderer, scene: &GpuScene) -> Result<(), StereoError> {
        renderer.prepare(scene, self.layout)?;
        if self.targets.is_none() {
            self.targets = Some(renderer.targets(self.layout)?);
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<bool, StereoError> {
        let Some(targets) = &mut self.targets else { return Ok(false) };
        let views = Eye::BOTH.map(|eye| frame.pair.view(eye));
        let wants_depth = Eye::BOTH.iter().any(|eye| frame.wants_depth(*eye));
        frame.renderer.draw_all(targets, &frame.scene, &views, wants_depth, None)?;
        for eye in Eye::BOTH {
            let view = &views[eye.index()];
            frame.renderer.ink_layer(targets, view, eye)?;
            frame.renderer.render_bloom(targets, view, eye);
            frame.renderer.composite(targets, view, eye, [0, 0], &frame.to(eye).color, None);
            if frame.wants_depth(eye) {
                frame.write_depth(eye, &targets.depth(view.size, eye, [0, 0]));
            }
        }
        Ok(false)
    }
}
