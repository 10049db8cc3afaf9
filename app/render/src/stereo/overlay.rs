//! Near objects and transparent surfaces, drawn over both eyes after synthesis.

use std::rc::Rc;

use super::finish::EyeImage;
use super::frame::Frame;
use super::near_field::Composite;
use crate::render::{
    DeferredRenderer, DepthImage, ForwardRenderer, Fxaa, RenderSettings, Selection, ViewImages, ViewRenderer,
    ViewRequest,
};
use yoro::eyes::{Eye, SynthesisViews};
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget};

/// Anti-aliasing of the rendered eye before synthesis.
pub(super) struct Smooth {
    fxaa: Fxaa,
    pub(super) image: RenderTarget,
}

impl Smooth {
    pub(super) fn new(gl: &Rc<Context>) -> Result<Smooth, GlError> {
        let image = RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], None)?;
        Ok(Smooth { fxaa: Fxaa::new(gl)?, image })
    }

    /// Smooths an image of this object's size.
    pub(super) fn run(&self, from: &RenderTarget) {
        self.fxaa.run(from.color(0), [0, 0], &Destination::whole(&self.image));
    }
}

/// What comes over both eyes of a frame.
pub(super) struct Over {
    /// Near objects, if they are left out of the synthesis.
    pub(super) near: Option<Selection>,
    pub(super) transparent: bool,
}

impl Over {
    /// True if anything is drawn, tested against the depth of either eye.
    pub(super) fn is_any(&self) -> bool {
        self.transparent || self.near.is_some()
    }
}

/// The way a kind of renderer draws over both eyes after synthesis.
pub(super) trait Overlay: Sized {
    /// The kind of renderer.
    type Renderer: ViewRenderer;

    /// For frames with near objects or without.
    fn new(gl: &Rc<Context>, settings: &RenderSettings, near: bool) -> Result<Self, GlError>;

    /// Draws over the rendered eye, and returns its part without the guard band. With `smooth` that holds the eye's colour
    /// after anti-aliasing, as it was synthesized from.
    fn over_rendered<'a>(
        &'a mut self,
        frame: &Frame<Self::Renderer>,
        views: &SynthesisViews,
        over: &Over,
        targets: &'a <Self::Renderer as ViewRenderer>::Targets,
        smooth: Option<&'a Smooth>,
    ) -> Result<EyeImage<'a>, GlError>;

    /// Draws over the synthesized eye, which has float depth if anything is drawn or somebody wants it. What the targets of
    /// the rendered eye hold is gone afterwards.
    fn over_synthesized<'a>(
        &'a mut self,
        frame: &Frame<Self::Renderer>,
        views: &SynthesisViews,
        over: &Over,
        targets: &'a <Self::Renderer as ViewRenderer>::Targets,
        image: &'a RenderTarget,
    ) -> Result<EyeImage<'a>, GlError>;
}

/// Near objects have targets of their own, and are composited by depth; transparent surfaces are drawn over images.
pub(super) struct DeferredOverlay {
    near: Option<NearLayer>,
}

/// Targets for the near objects, and for what they are composited into.
struct NearLayer {
    targets: <DeferredRenderer as ViewRenderer>::Targets,
    composite: Composite,
    /// By [`Eye::index`].
    layers: [RenderTarget; 2],
}

impl DeferredOverlay {
    /// Draws over one eye: the part of `color` at `origin`.
    fn over<'a>(
        &'a mut self,
        frame: &Frame<DeferredRenderer>,
        view: &yoro::eyes::View,
        over: &Over,
        eye: Eye,
        mut image: EyeImage<'a>,
    ) -> Result<EyeImage<'a>, GlError> {
        let Frame { renderer, scene, pair, .. } = frame;
        if let (Some(near), Some(selection), Some(depth)) = (&mut self.near, over.near, image.depth) {
            let request = ViewRequest { selection, ..ViewRequest::default() };
            renderer.render(&mut near.targets, scene, view, &request)?;
            let layer = &mut near.layers[eye.index()];
            layer.resize(view.size)?;
            let far = (image.color.color(0), depth.texture);
            near.composite.run(far, &near.targets, pair.depth.convention, layer);
            image.color = layer;
            image.depth = Some(DepthImage { texture: layer.depth(), ..depth });
        }
        if let Some(depth) = image.depth.filter(|_| over.transparent) {
            // Depth is read in the shader, so only the colour of the layer may be attached. Nothing reads the guard band
            // from here on.
            let onto = Destination { origin: image.origin, size: pair.size, ..image.color.color_only() };
            renderer.draw_transparent(&onto, depth, scene, &pair.view(eye));
        }
        Ok(image)
    }
}

impl Overlay for DeferredOverlay {
    type Renderer = DeferredRenderer;

    fn new(gl: &Rc<Context>, settings: &RenderSettings, near: bool) -> Result<DeferredOverlay, GlError> {
        let formats = [(Format::Rgba8, Filter::Linear)];
        let layer = || RenderTarget::new(gl, [1, 1], &formats, Some(Format::Depth32F));
        let near = near.then(|| -> Result<_, GlError> {
            let (targets, composite) = (DeferredRenderer::targets(gl, settings)?, Composite::new(gl)?);
            Ok(NearLayer { targets, composite, layers: [layer()?, layer()?] })
        });
        Ok(DeferredOverlay { near: near.transpose()? })
    }

    fn over_rendered<'a>(
        &'a mut self,
        frame: &Frame<DeferredRenderer>,
        views: &SynthesisViews,
        over: &Over,
        targets: &'a <DeferredRenderer as ViewRenderer>::Targets,
        smooth: Option<&'a Smooth>,
    ) -> Result<EyeImage<'a>, GlError> {
        let (color, origin) = (smooth.map_or(targets.color(), |smooth| &smooth.image), views.dominant_crop);
        let depth = Some(DepthImage { origin, ..DepthImage::whole(targets.depth()) });
        let image = EyeImage { color, origin, depth };
        self.over(frame, &views.source, over, frame.pair.dominant, image)
    }

    fn over_synthesized<'a>(
        &'a mut self,
        frame: &Frame<DeferredRenderer>,
        views: &SynthesisViews,
        over: &Over,
        _targets: &'a <DeferredRenderer as ViewRenderer>::Targets,
        image: &'a RenderTarget,
    ) -> Result<EyeImage<'a>, GlError> {
        let eye = frame.pair.dominant.other();
        let has_depth = over.is_any() || frame.wants_depth(eye);
        let depth = has_depth.then(|| DepthImage::whole(image.depth()));
        self.over(frame, &views.target, over, eye, EyeImage { color: image, origin: [0, 0], depth })
    }
}

/// Drawing resumes in the samples of the rendered eye, then in those of the other eye, which begins as it was synthesized.
pub(super) struct ForwardOverlay;

impl Overlay for ForwardOverlay {
    type Renderer = ForwardRenderer;

    fn new(_: &Rc<Context>, _: &RenderSettings, _near: bool) -> Result<ForwardOverlay, GlError> {
        Ok(ForwardOverlay)
    }

    fn over_rendered<'a>(
        &'a mut self,
        frame: &Frame<ForwardRenderer>,
        views: &SynthesisViews,
        over: &Over,
        targets: &'a <ForwardRenderer as ViewRenderer>::Targets,
        smooth: Option<&'a Smooth>,
    ) -> Result<EyeImage<'a>, GlError> {
        let wants_depth = frame.wants_depth(frame.pair.dominant);
        if over.is_any() {
            let depth = over.near.is_some() && wants_depth;
            frame.renderer.resume_samples(targets, frame.scene, &views.source, over.near, depth);
            // The eye is rendered once more, so that it is smoothed again.
            if let Some(smooth) = smooth {
                smooth.run(targets.color());
            }
        }
        let (color, origin) = (smooth.map_or(targets.color(), |smooth| &smooth.image), views.dominant_crop);
        let depth = wants_depth.then(|| DepthImage { origin, ..DepthImage::whole(targets.depth()) });
        Ok(EyeImage { color, origin, depth })
    }

    fn over_synthesized<'a>(
        &'a mut self,
        frame: &Frame<ForwardRenderer>,
        views: &SynthesisViews,
        over: &Over,
        targets: &'a <ForwardRenderer as ViewRenderer>::Targets,
        image: &'a RenderTarget,
    ) -> Result<EyeImage<'a>, GlError> {
        let wants_depth = frame.wants_depth(frame.pair.dominant.other());
        if over.is_any() {
            let depth = over.near.is_some() && wants_depth;
            frame.renderer.resume_samples_with(targets, image, frame.scene, &views.target, over.near, depth);
        }
        let depth = wants_depth.then(|| DepthImage::whole(image.depth()));
        Ok(EyeImage { color: image, origin: [0, 0], depth })
    }
}
