//! Image groups: one view of a scene as rendered, as reprojected, and as a real render of the other eye.
//!
//! [`GroupRenderer`] makes one group in memory; the program's command `dataset` writes them to files.

use std::rc::Rc;

use image::{Luma, RgbImage};

use crate::inpaint::Reprojected;
use yoro::eyes::{DepthConvention, EyePair, GuardBand, SynthesisViews};
use yoro_gl::{Context, GlError};
use yoro_media::{DepthImage, depth_image, rgb_image};
use yoro_render::stereo::{Offline, PipelineOptions};
use yoro_render::{GpuScene, Renderer, ViewReader};

/// Options of image groups.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct GroupOptions {
    /// The pipeline that reprojects.
    pub synthesis: PipelineOptions,
    /// The guard band by which the dominant eye is rendered wider.
    pub guard_band: GuardBand,
}

impl Default for GroupOptions {
    /// Returns options without a guard band.
    fn default() -> GroupOptions {
        GroupOptions { synthesis: PipelineOptions::default(), guard_band: GuardBand::None }
    }
}

/// One view of a scene. All images have row 0 at the top; colour is display-referred sRGB.
#[derive(Clone, Debug)]
pub struct ImageGroup {
    /// The two eyes.
    pub pair: EyePair,
    /// The rendered view, the synthesized one, and how pixels move between them.
    pub views: SynthesisViews,
    /// The rendered dominant eye, including transparent objects; as large as the source view.
    pub color: RgbImage,
    /// Its depth buffer, 0 to 1, in the convention of the pair's depth range; transparent objects are not in it.
    pub depth: DepthImage,
    /// A real render of the other eye.
    pub truth: RgbImage,
    /// The other eye as reprojected, with its holes.
    pub reprojected: Reprojected,
    /// The other eye as the pipeline makes it: equal to the reprojected image except in the holes.
    pub synthesized: RgbImage,
}

impl ImageGroup {
    /// Returns the depth of the reprojected image in the pair's convention, with the far plane's value in holes.
    pub fn reprojected_depth(&self) -> DepthImage {
        let (disparity, law) = (&self.reprojected.disparity, self.views.warp.law);
        let scale = law.scale.abs().max(f64::MIN_POSITIVE) as f32;
        DepthImage::from_fn(disparity.width(), disparity.height(), |x, y| {
            let nearness = (disparity.get_pixel(x, y).0[0] / scale).clamp(0.0, 1.0);
            Luma([match self.pair.depth.convention {
                DepthConvention::Standard => 1.0 - nearness,
                DepthConvention::Reversed => nearness,
            }])
        })
    }
}

/// Renders image groups of scenes. Everything is compiled once.
pub struct GroupRenderer {
    options: GroupOptions,
    reader: ViewReader,
    offline: Offline,
}

impl GroupRenderer {
    /// Compiles the pipeline and creates the targets.
    ///
    /// # Errors
    /// [`GlError`] if the driver cannot run the pipeline.
    pub fn new(gl: &Rc<Context>, options: &GroupOptions) -> Result<GroupRenderer, GlError> {
        Ok(GroupRenderer {
            options: *options,
            reader: ViewReader::new(gl)?,
            offline: Offline::new(gl, &options.synthesis)?,
        })
    }

    /// Renders both eyes and synthesizes the one that is not dominant.
    ///
    /// # Errors
    /// For a pair that synthesis refuses, beyond the driver's limits, and if the synthesized eye sees nothing of what
    /// the other one sees.
    pub fn render(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
    ) -> anyhow::Result<ImageGroup> {
        let views = pair.synthesis_views(self.options.guard_band)?;
        let truth = self.reader.color(renderer, scene, &views.target)?;
        let source = self.reader.color(renderer, scene, &views.source)?;
        let depth = self.reader.depth();
        let result = self.offline.run(&source, &depth, &views.warp)?;
        Ok(ImageGroup {
            pair: *pair,
            color: rgb_image(&source, views.source.size),
            depth: depth_image(&depth, views.source.size),
            truth: rgb_image(&truth, views.target.size),
            reprojected: Reprojected::from_synthesis(&result, &views.warp)?,
            synthesized: rgb_image(&result.rgba, views.target.size),
            views,
        })
    }
}
