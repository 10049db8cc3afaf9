//! Near objects and transparent surfaces, drawn over both eyes after synthesis.

use std::rc::Rc;

use super::finish::EyeImage;
use super::frame::{Frame, Setup};
use crate::render::{
    DeferredRenderer, DepthImage, DrawRequest, ForwardRenderer, Fxaa, RendererOfKind, Selection, ViewImages,
    ViewRenderer,
};
use yoro::eyes::{DepthConvention, SynthesisViews};
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource, Texture,
};

/// Anti-aliasing of the rendered eye before synthesis.
pub(super) struct SmoothedEye {
    fxaa: Fxaa,
    pub(super) image: RenderTarget,
}

impl SmoothedEye {
    pub(super) fn new(gl: &Rc<Context>) -> Result<SmoothedEye, GlError> {
        let image = RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], None)?;
        Ok(SmoothedEye { fxaa: Fxaa::new(gl)?, image })
    }

    /// Smooths an image of the same size into `image`.
    pub(super) fn run(&self, from: &RenderTarget) {
        self.fxaa.run(from.color(0), [0, 0], &Destination::whole(&self.image));
    }
}

/// What is drawn over both eyes of a frame.
pub(super) struct OverlaySurfaces {
    /// The near objects, if they are left out of the synthesis.
    pub(super) near: Option<Selection>,
    pub(super) transparent: bool,
}

impl OverlaySurfaces {
    /// True if anything is drawn. It is then tested against the depth of either eye.
    pub(super) fn is_any(&self) -> bool {
        self.transparent || self.near.is_some()
    }
}

/// An eye to draw over.
#[derive(Clone, Copy)]
pub(super) enum EyeSource<'a> {
    /// The rendered eye: the contents of its targets, or the smoothed copy that the other eye was synthesized from.
    Rendered(Option<&'a SmoothedEye>),
    /// The synthesized eye, with float depth if anything is drawn or its target has depth.
    Synthesized(&'a RenderTarget),
}

/// How a kind of renderer draws over both eyes after synthesis.
pub(super) trait Overlay: Sized {
    /// The kind of renderer.
    type Renderer: RendererOfKind;

    fn new(setup: &Setup) -> Result<Self, GlError>;

    /// Draws over one eye and returns its part without the guard band. `targets` are those of the rendered eye, which
    /// must be drawn first: drawing over the synthesized eye may overwrite them.
    fn draw<'a>(
        &'a mut self,
        frame: &Frame<Self::Renderer>,
        views: &SynthesisViews,
        over: &OverlaySurfaces,
        targets: &'a <Self::Renderer as ViewRenderer>::Targets,
        eye: EyeSource<'a>,
    ) -> Result<EyeImage<'a>, GlError>;
}

/// Draws near objects into targets of their own and composites them by depth. Draws transparent surfaces over images.
pub(super) struct DeferredOverlay {
    near: Option<NearLayer>,
}

/// Targets for near objects, and for the composited images.
struct NearLayer {
    targets: <DeferredRenderer as ViewRenderer>::Targets,
    composite: Composite,
    /// Layers by [`yoro::eyes::Eye::index`].
    layers: [RenderTarget; 2],
}

impl Overlay for DeferredOverlay {
    type Renderer = DeferredRenderer;

    fn new(&Setup { gl, settings, options }: &Setup) -> Result<DeferredOverlay, GlError> {
        let formats = [(Format::Rgba8, Filter::Linear)];
        let layer = || RenderTarget::new(gl, [1, 1], &formats, Some(Format::Depth32F));
        let near = options.near_field.map(|_| -> Result<_, GlError> {
            let (targets, composite) = (DeferredRenderer::targets(gl, settings)?, Composite::new(gl)?);
            Ok(NearLayer { targets, composite, layers: [layer()?, layer()?] })
        });
        Ok(DeferredOverlay { near: near.transpose()? })
    }

    fn draw<'a>(
        &'a mut self,
        frame: &Frame<DeferredRenderer>,
        views: &SynthesisViews,
        over: &OverlaySurfaces,
        targets: &'a <DeferredRenderer as ViewRenderer>::Targets,
        eye: EyeSource<'a>,
    ) -> Result<EyeImage<'a>, GlError> {
        let Frame { renderer, scene, pair, .. } = frame;
        let (eye, view, mut color, mut depth, origin) = match eye {
            EyeSource::Rendered(smooth) => {
                let color = smooth.map_or(targets.color(), |smooth| &smooth.image);
                (pair.dominant, &views.source, color, Some(targets.depth()), views.dominant_crop)
            }
            EyeSource::Synthesized(image) => {
                let eye = pair.dominant.other();
                let has_depth = over.is_any() || frame.wants_depth(eye);
                (eye, &views.target, image, has_depth.then(|| image.depth()), [0, 0])
            }
        };
        if let (Some(near), Some(selection), Some(far)) = (&mut self.near, over.near, depth) {
            let request = DrawRequest { selection, ..DrawRequest::default() };
            renderer.render(&mut near.targets, scene, view, &request)?;
            let layer = &mut near.layers[eye.index()];
            layer.resize(view.size)?;
            near.composite.run((color.color(0), far), &near.targets, pair.depth.convention, layer);
            color = &near.layers[eye.index()];
            depth = Some(color.depth());
        }
        let depth = depth.map(|depth| DepthImage { origin, ..DepthImage::whole(depth) });
        if let Some(depth) = depth.filter(|_| over.transparent) {
            // Depth is read in the shader, so only the layer's colour may be attached. Nothing reads the guard band
            // after this.
            let onto = Destination { origin, size: pair.size, ..color.color_only() };
            renderer.draw_transparent(&onto, depth, scene, &pair.view(eye));
        }
        Ok(EyeImage { color, origin, depth })
    }
}

/// Composites a near layer over a far one by depth.
struct Composite {
    gl: Rc<Context>,
    program: Program,
}

impl Composite {
    fn new(gl: &Rc<Context>) -> Result<Composite, GlError> {
        let program = Program::new(gl, ShaderSource::Screen("stereo/composite.frag"), &[])?;
        Ok(Composite { gl: gl.clone(), program })
    }

    /// Writes colour and depth of the nearer layer. All images have the size of `to`.
    fn run(
        &self,
        (far_color, far_depth): (&Texture, &Texture),
        near: &impl ViewImages,
        convention: DepthConvention,
        to: &RenderTarget,
    ) {
        self.gl.pass("composite", || {
            self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
            to.bind();
            self.program
                .bind()
                .texture("far_color", 0, far_color.raw())
                .texture("far_depth", 1, far_depth.raw())
                .texture("near_color", 2, near.color().color(0).raw())
                .texture("near_depth", 3, near.depth().raw())
                .set("reversed", convention == DepthConvention::Reversed);
            self.gl.draw_screen();
            self.gl.set_raster_state(&RasterState::SCREEN);
        });
    }
}

/// Resumes drawing in the samples of the rendered eye, then in those of the other eye, starting from its synthesized
/// image.
pub(super) struct ForwardOverlay;

impl Overlay for ForwardOverlay {
    type Renderer = ForwardRenderer;

    fn new(_: &Setup) -> Result<ForwardOverlay, GlError> {
        Ok(ForwardOverlay)
    }

    fn draw<'a>(
        &'a mut self,
        frame: &Frame<ForwardRenderer>,
        views: &SynthesisViews,
        over: &OverlaySurfaces,
        targets: &'a <ForwardRenderer as ViewRenderer>::Targets,
        eye: EyeSource<'a>,
    ) -> Result<EyeImage<'a>, GlError> {
        let Frame { renderer, scene, pair, .. } = frame;
        match eye {
            EyeSource::Rendered(smooth) => {
                let wants_depth = frame.wants_depth(pair.dominant);
                if over.is_any() {
                    let depth = over.near.is_some() && wants_depth;
                    renderer.resume_samples(targets, scene, &views.source, over.near, depth);
                    // The eye has been drawn again, so it must be smoothed again.
                    if let Some(smooth) = smooth {
                        smooth.run(targets.color());
                    }
                }
                let color = smooth.map_or(targets.color(), |smooth| &smooth.image);
                let origin = views.dominant_crop;
                let depth = wants_depth.then(|| DepthImage { origin, ..DepthImage::whole(targets.depth()) });
                Ok(EyeImage { color, origin, depth })
            }
            EyeSource::Synthesized(image) => {
                let wants_depth = frame.wants_depth(pair.dominant.other());
                if over.is_any() {
                    let depth = over.near.is_some() && wants_depth;
                    renderer.resume_samples_with(targets, image, scene, &views.target, over.near, depth);
                }
                let depth = wants_depth.then(|| DepthImage::whole(image.depth()));
                Ok(EyeImage { color: image, origin: [0, 0], depth })
            }
        }
    }
}
