//! Image groups: one view of a scene as rendered, as reprojected, and as a real render of the other eye.
//!
//! [`GroupRenderer`] makes one group in memory; the program's command `dataset` writes them to files.

use std::rc::Rc;

use image::{Luma, RgbImage};

use crate::depth::DepthReader;
use crate::inpaint::{InpaintError, Reprojected};
use yoro::eyes::{DepthConvention, DepthRange, EyePair, EyesError, GuardBand, SynthesisViews, View};
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget};
use yoro_media::DepthImage;
use yoro_render::stereo::{Offline, PipelineOptions};
use yoro_render::{Fxaa, GpuScene, PreparedScene, Renderer, ViewTargets};

/// The error when an image group cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GroupError {
    /// The other eye cannot be synthesized.
    #[error(transparent)]
    Eyes(#[from] EyesError),
    /// GL refused.
    #[error(transparent)]
    Gl(#[from] GlError),
    /// The other eye sees nothing of the rendered eye's image.
    #[error(transparent)]
    Inpaint(#[from] InpaintError),
}

/// Options of image groups.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct GroupOptions {
    /// The pipeline that reprojects.
    pub synthesis: PipelineOptions,
    /// The guard band by which the dominant eye is rendered wider.
    pub guard_band: GuardBand,
    /// Applies FXAA to both rendered images. As in the paper, the reprojected image then moves blended edge pixels with
    /// one of their surfaces.
    pub anti_aliasing: bool,
}

impl Default for GroupOptions {
    /// Returns options without a guard band and without anti-aliasing, so that every pixel belongs to one surface.
    fn default() -> GroupOptions {
        GroupOptions {
            synthesis: PipelineOptions::default(),
            guard_band: GuardBand::None,
            anti_aliasing: false,
        }
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
        let (disparity, law) = (self.reprojected.disparity(), self.views.warp.law);
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

/// The rendered eye of a view. Both images have row 0 at the top.
#[derive(Clone, Debug)]
pub struct SourceImage {
    /// The rendered view, the synthesized one, and how pixels move between them.
    pub views: SynthesisViews,
    /// The rendered dominant eye, including transparent objects; as large as the source view.
    pub color: RgbImage,
    /// Its depth buffer; transparent objects are not in it.
    pub depth: DepthImage,
    /// The meaning of the depth.
    pub depth_range: DepthRange,
}

/// Renders image groups of scenes. Everything is compiled once.
pub struct GroupRenderer {
    options: GroupOptions,
    targets: ViewTargets,
    fxaa: Option<Fxaa>,
    smooth: RenderTarget,
    depth: DepthReader,
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
            targets: ViewTargets::default(),
            fxaa: options.anti_aliasing.then(|| Fxaa::new(gl)).transpose()?,
            smooth: RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], None)?,
            depth: DepthReader::new(gl)?,
            offline: Offline::new(gl, &options.synthesis)?,
        })
    }

    /// Renders both eyes and synthesizes the one that is not dominant.
    ///
    /// # Errors
    /// [`GroupError::Eyes`] for a pair that synthesis refuses, [`GroupError::Gl`] beyond the driver's limits, and
    /// [`GroupError::Inpaint`] if the synthesized eye sees nothing of what the other one sees.
    pub fn render(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
    ) -> Result<ImageGroup, GroupError> {
        let views = pair.synthesis_views(self.options.guard_band)?;
        let truth = self.render_view(renderer, scene, &views.target)?;
        let source = self.render_view(renderer, scene, &views.source)?;
        let depth = self.depth.read();
        let result = self.offline.run(&source, &depth, &views.warp)?;
        Ok(ImageGroup {
            pair: *pair,
            color: yoro_media::rgb_image(&source, views.source.size),
            depth: depth_image(&depth, views.source.size),
            truth: yoro_media::rgb_image(&truth, views.target.size),
            reprojected: Reprojected::from_synthesis(&result, &views.warp)?,
            synthesized: yoro_media::rgb_image(&result.rgba, views.target.size),
            views,
        })
    }

    /// Renders the dominant eye alone.
    ///
    /// # Errors
    /// [`GroupError::Eyes`] and [`GroupError::Gl`], as [`GroupRenderer::render`].
    pub fn render_source(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
    ) -> Result<SourceImage, GroupError> {
        let views = pair.synthesis_views(self.options.guard_band)?;
        let (color, depth) = self.images(renderer, scene, &views.source)?;
        Ok(SourceImage { views, color, depth, depth_range: pair.depth })
    }

    /// Renders any view, and returns its colour and its depth.
    ///
    /// # Errors
    /// [`GlError`] beyond the driver's limits.
    pub fn render_one(
        &mut self,
        prepared: &mut PreparedScene,
        view: &View,
    ) -> Result<(RgbImage, DepthImage), GlError> {
        self.images(&mut prepared.renderer, &prepared.scene, view)
    }

    fn images(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        view: &View,
    ) -> Result<(RgbImage, DepthImage), GlError> {
        let color = self.render_view(renderer, scene, view)?;
        Ok((yoro_media::rgb_image(&color, view.size), depth_image(&self.depth.read(), view.size)))
    }

    /// Returns the RGBA of a view, rows from the bottom, and leaves its depth in `self.depth`.
    fn render_view(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        view: &View,
    ) -> Result<Vec<u8>, GlError> {
        let rendered = renderer.render_all(&mut self.targets, scene, view)?;
        self.depth.copy(rendered.depth, view.size)?;
        let mut color = rendered.color;
        if let Some(fxaa) = &self.fxaa {
            self.smooth.resize(view.size)?;
            fxaa.run(color.color(0), [0, 0], &Destination::whole(&self.smooth));
            color = &self.smooth;
        }
        Ok(color.read_rgba8(0, [0, 0], view.size))
    }
}

/// Returns an image of depth that was read back, and whose rows run from the bottom.
fn depth_image(depth: &[f32], [width, height]: [u32; 2]) -> DepthImage {
    let flipped = depth.chunks_exact(width as usize).rev().flatten().copied().collect();
    DepthImage::from_raw(width, height, flipped).expect("one value for each pixel")
}
