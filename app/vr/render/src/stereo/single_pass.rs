//! Draws both eyes in one set of draw calls: by instancing into double-wide targets, or by GL_OVR_multiview2 into a
//! layered g-buffer. All later passes run for each eye.

use super::finish::{EyeImage, Finish};
use super::frame::{Frame, FrameMethod, Setup};
use super::method::StereoError;
use crate::render::{
    DeferredRenderer, DepthImage, FinishTargets, ForwardRenderer, ForwardTargets, GBuffer, GpuScene, Layout,
    LightTargets, Part, RendererOfKind, Role, Seam, ViewImages,
};
use yoro::eyes::{Eye, View};
use yoro_gl::{Destination, Filter, Format, GlError, RenderTarget};

/// Culls once, and issues one draw call per visible range of triangles, for both eyes.
///
/// Compared with two renders it saves half of the CPU's draw calls and, with multiview on hardware that shares it, some
/// vertex work. Every pixel is still rasterized and shaded for each eye.
pub struct SinglePass<T> {
    targets: T,
    finish: Finish,
}

/// The images of both eyes at once, for one kind of renderer.
pub(super) trait PairTargets: Sized {
    /// The kind of renderer.
    type Renderer: RendererOfKind;

    fn new(setup: &Setup, layout: Layout) -> Result<Self, GlError>;

    /// See [`FrameMethod::compile`].
    fn compile(&self, renderer: &mut Self::Renderer, scene: &GpuScene) -> Result<(), GlError>;

    /// Draws the surfaces of both eyes.
    fn draw(&mut self, frame: &Frame<Self::Renderer>, views: &[View; 2]) -> Result<(), GlError>;

    /// Completes the image of one eye, after [`PairTargets::draw`].
    fn eye(&mut self, frame: &Frame<Self::Renderer>, view: &View, eye: Eye) -> Result<EyeImage<'_>, GlError>;
}

impl<T: PairTargets> SinglePass<T> {
    /// Makes single-pass stereo by instancing, with clip distances if the driver has them.
    pub(super) fn instanced(setup: &Setup) -> Result<SinglePass<T>, GlError> {
        let has_clip_distances = setup.gl.capabilities().clip_distances;
        let seam = if has_clip_distances { Seam::ClipDistance } else { Seam::Discard };
        SinglePass::new(setup, Layout::DoubleWide(seam))
    }

    /// Makes the targets. [`Layout::Layered`] means single-pass stereo by multiview.
    pub(super) fn new(setup: &Setup, layout: Layout) -> Result<SinglePass<T>, GlError> {
        Ok(SinglePass { targets: T::new(setup, layout)?, finish: Finish::new(setup)? })
    }
}

impl<T: PairTargets> FrameMethod for SinglePass<T> {
    type Renderer = T::Renderer;

    fn compile(&mut self, renderer: &mut T::Renderer, scene: &GpuScene) -> Result<(), GlError> {
        self.targets.compile(renderer, scene)
    }

    fn render_frame(&mut self, frame: &Frame<T::Renderer>) -> Result<(), StereoError> {
        let views = Eye::BOTH.map(|eye| frame.pair.view(eye));
        self.targets.draw(frame, &views)?;
        for eye in Eye::BOTH {
            self.finish.run(&self.targets.eye(frame, &views[eye.index()], eye)?, frame.to(eye));
        }
        Ok(())
    }
}

/// The g-buffer of both eyes.
pub(super) struct DeferredPair {
    layout: Layout,
    g_buffer: GBuffer,
    /// Light of the eye that is being lit.
    light: LightTargets,
    image: FinishTargets,
}

impl PairTargets for DeferredPair {
    type Renderer = DeferredRenderer;

    fn new(&Setup { gl, settings, .. }: &Setup, layout: Layout) -> Result<DeferredPair, GlError> {
        Ok(DeferredPair {
            layout,
            g_buffer: GBuffer::new(gl, layout)?,
            light: LightTargets::new(gl, settings)?,
            image: FinishTargets::new(gl, settings)?,
        })
    }

    fn compile(&self, renderer: &mut DeferredRenderer, scene: &GpuScene) -> Result<(), GlError> {
        let role = Role::of_eye(self.layout, [1, 1], Eye::Left).kind();
        renderer.prepare(scene, self.layout, &[role])
    }

    fn draw(&mut self, frame: &Frame<DeferredRenderer>, views: &[View; 2]) -> Result<(), GlError> {
        let pair = frame.pair;
        self.g_buffer.fit(pair.size, pair.depth.convention)?;
        self.light.resize(pair.size)?;
        self.image.resize(pair.size)?;
        let all = Some(Part::Slice([pair.depth.near, pair.depth.far]));
        frame.renderer.draw(&self.g_buffer, frame.scene, views, all, |_| {});
        Ok(())
    }

    fn eye(
        &mut self,
        frame: &Frame<DeferredRenderer>,
        view: &View,
        eye: Eye,
    ) -> Result<EyeImage<'_>, GlError> {
        let (renderer, scene) = (frame.renderer, frame.scene);
        let role = Role::of_eye(self.layout, view.size, eye);
        renderer.light(&self.light, &self.g_buffer, scene, view, role);
        renderer.finish(&self.image, &self.light);
        let depth = DepthImage {
            texture: self.g_buffer.target().depth(),
            origin: self.layout.origin(view.size, eye),
            layer: (self.layout == Layout::Layered).then_some(eye.index() as u32),
        };
        let color = self.image.color();
        renderer.draw_transparent(&Destination::whole(color), depth, scene, view);
        Ok(EyeImage { color, origin: [0, 0], depth: Some(depth) })
    }
}

/// The samples of both eyes.
pub(super) struct ForwardPair {
    targets: ForwardTargets,
    /// A copy of one eye, for anti-aliasing that reads beyond its border.
    alone: Option<RenderTarget>,
}

impl PairTargets for ForwardPair {
    type Renderer = ForwardRenderer;

    fn new(&Setup { gl, settings, .. }: &Setup, layout: Layout) -> Result<ForwardPair, GlError> {
        let formats = [(Format::Rgba8, Filter::Linear)];
        let alone = (settings.samples() == 1).then(|| RenderTarget::new(gl, [1, 1], &formats, None));
        let targets = ForwardTargets::new(gl, layout, settings)?;
        Ok(ForwardPair { targets, alone: alone.transpose()? })
    }

    fn compile(&self, renderer: &mut ForwardRenderer, scene: &GpuScene) -> Result<(), GlError> {
        renderer.prepare(scene, self.targets.layout())
    }

    fn draw(&mut self, frame: &Frame<ForwardRenderer>, views: &[View; 2]) -> Result<(), GlError> {
        let wants_depth = Eye::BOTH.iter().any(|eye| frame.wants_depth(*eye));
        frame.renderer.render_both(&mut self.targets, frame.scene, views, wants_depth)
    }

    fn eye(
        &mut self,
        frame: &Frame<ForwardRenderer>,
        view: &View,
        eye: Eye,
    ) -> Result<EyeImage<'_>, GlError> {
        frame.renderer.develop(&self.targets, view, eye, false);
        let mut color = self.targets.color();
        let mut origin = self.targets.origin(view.size, eye);
        if let Some(alone) = &mut self.alone {
            alone.resize(view.size)?;
            color.copy_color(origin, &Destination::whole(alone));
            (color, origin) = (alone, [0, 0]);
        }
        let depth = frame.wants_depth(eye).then(|| {
            let origin = self.targets.layout().origin(view.size, eye);
            DepthImage { origin, ..DepthImage::whole(self.targets.depth()) }
        });
        Ok(EyeImage { color, origin, depth })
    }
}
