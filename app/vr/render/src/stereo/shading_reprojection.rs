//! Reprojects the dominant eye's shading to the other eye's own geometry, and shades only what that eye does not see.
//!
//! After Oculus, "Introducing Stereo Shading Reprojection for Unity" (2017): the second eye's geometry is drawn again, so
//! the depth of its fragments is known, and with it their places in the dominant eye's image. Depths are compared there
//! (`include/reprojection.glsl`); what the dominant eye does not see is shaded. The extra cost over synthesis is the
//! second eye's geometry and the maps of its materials.

use super::frame::Frame;
use super::method::{StereoError, StereoMethod};
use super::overlay::{OverlayPass, OverlaySurfaces};
use crate::view::{GpuScene, Layout, Renderer, Reprojection, Targets};
use yoro::eyes::{DisparityMap, Eye, GuardBand};

/// Draws geometry twice, and shades once, and again where the dominant eye does not see a surface. Colours are taken
/// before bloom, which runs for each eye.
#[derive(Default)]
pub struct ShadingReprojection {
    made: Option<Made>,
}

struct Made {
    dominant: Targets,
    second: Targets,
    over: OverlayPass,
}

impl StereoMethod for ShadingReprojection {
    fn prepare(&mut self, renderer: &mut Renderer, scene: &GpuScene) -> Result<(), StereoError> {
        renderer.prepare_over(scene)?;
        renderer.prepare_raw()?;
        renderer.prepare_reprojected(scene)?;
        if self.made.is_none() {
            let targets = || renderer.targets(Layout::Single);
            self.made = Some(Made {
                dominant: targets()?,
                second: targets()?,
                over: OverlayPass::new(renderer, false)?,
            });
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<bool, StereoError> {
        let Some(Made { dominant, second, over }) = &mut self.made else { return Ok(false) };
        let (pair, renderer) = (&frame.pair, frame.renderer);
        // The law for the dominant eye's own image instead of one with both frusta: pixels outside of it are shaded.
        let views = pair.synthesis_views(GuardBand::None)?;
        let [left, bottom] = views.dominant_crop;
        let law = DisparityMap { offset: views.warp.law.offset + f64::from(left), ..views.warp.law };
        let row_offset = views.warp.row_offset + bottom as i32;
        let disparity_at_1_m = (pair.focal_length_pixels() * pair.ipd()).abs();
        let [eye, other] = [pair.dominant, pair.dominant.other()];
        let (view, other_view) = (pair.view(eye), pair.view(other));
        renderer.draw_plain(dominant, &frame.scene, &view, None)?;
        renderer.ink_beside(dominant, &view)?;
        renderer.render_bloom(dominant, &view, Eye::Left);
        let from = Reprojection {
            color: dominant.resolved.color(0),
            depth: dominant.depth(view.size, Eye::Left, [0, 0]).texture,
            law,
            row_offset,
            half_pixel: 0.5 / disparity_at_1_m.max(1e-6),
        };
        let wants_depth = frame.wants_depth(other);
        renderer.draw_reprojected(second, &frame.scene, &other_view, &from, wants_depth)?;
        renderer.composite(second, &other_view, Eye::Left, [0, 0], &frame.to(other).color, None);
        if wants_depth {
            frame.write_depth(other, &second.depth(view.size, Eye::Left, [0, 0]));
        }
        let transparent = frame.scene.is_transparent_in(&view);
        let surfaces = OverlaySurfaces { transparent, ..OverlaySurfaces::default() };
        let (place, has_depth) = over.begin(frame, eye, &surfaces)?;
        let region = surfaces.depth_region(frame, eye).filter(|_| has_depth);
        over.draw(|| renderer.composite(dominant, &view, Eye::Left, [0, 0], &place, region));
        over.finish(frame, eye, &surfaces);
        if frame.wants_depth(eye) {
            frame.write_depth(eye, &dominant.depth(view.size, Eye::Left, [0, 0]));
        }
        Ok(false)
    }
}
