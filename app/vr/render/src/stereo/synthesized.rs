//! Renders the dominant eye and synthesizes the other.

use std::rc::Rc;

use super::frame::Frame;
use super::method::{StereoError, StereoMethod};
use super::motion::SynthesizedMotion;
use super::options::{HoleMethod, Pipeline, PipelineOptions, StereoOptions};
use super::overlay::{OverlayPass, OverlaySurfaces};
use super::pipeline::Synthesis;
use crate::view::{
    DepthResolve, GpuScene, HoleSource, InkedHoles, Known, Layout, Rectangle, RenderedDepth, Renderer,
    Targets,
};
use yoro::eyes::{Eye, SynthesisViews, ViewLayer};
use yoro::opengl::{Bloom, Gather, GuessedDepth, Options, Outputs, Part, Source};
use yoro::synthesis::{HoleMark, Holes};
use yoro_gl::{Context, Destination, Format, GlError, RenderTarget};

/// One render with a guard band and one synthesis.
///
/// With [`HoleMethod::Rendered`], the synthesis leaves holes open, and opaque surfaces are drawn there, with the bloom that they
/// have in the rendered eye.
///
/// Bloom is added where an eye is written last: by the synthesis, and where the rendered eye is composited. Transparent
/// surfaces are drawn over both in the same passes. Where nothing follows the surfaces, the view is rendered where the
/// rendered eye is shown, if its target has room for it, and transparent surfaces are drawn over it there.
pub struct Synthesized {
    gl: Rc<Context>,
    options: StereoOptions,
    made: Option<Made>,
    /// Made if a runtime makes frames of motion vectors.
    motion: Option<SynthesizedMotion>,
}

/// What depends on the renderer.
struct Made {
    targets: Targets,
    over: OverlayPass,
    /// Where holes are rendered that have outlines.
    inked: Option<InkedHoles>,
    synthesizers: Synthesizers,
    /// Makes more of the depth of one sample, where a driver gives no more.
    guess: Option<GuessedDepth>,
}

/// Pipelines by [`Kind`], each made when first needed.
struct Synthesizers {
    gl: Rc<Context>,
    options: PipelineOptions,
    /// True if the source's depth is that of two samples.
    pairs: bool,
    /// True if the source lacks its bloom.
    bloom: bool,
    made: [Option<Box<dyn Synthesis>>; 3],
}

/// What a pipeline makes of the other eye.
#[derive(Clone, Copy)]
enum Kind {
    Color,
    ColorDepth,
    /// Colour and depth, except in holes.
    OpenHoles,
}

impl Synthesizers {
    /// Returns the pipeline of a kind, and makes it on the first call.
    fn get(&mut self, kind: Kind) -> Result<&mut Box<dyn Synthesis>, GlError> {
        let slot = &mut self.made[kind as usize];
        if let Some(made) = slot {
            return Ok(made);
        }
        let outputs = match kind {
            Kind::Color => Outputs::default(),
            Kind::ColorDepth => Outputs { depth: true, ..Outputs::default() },
            Kind::OpenHoles => {
                Outputs { depth: true, holes: Holes::Open(HoleMark::Stencil), ..Outputs::default() }
            }
        };
        let synthesis: Box<dyn Synthesis> = match self.options.pipeline {
            Pipeline::Gather => {
                let options = Options { depth_pairs: self.pairs, bloom: self.bloom, ..Options::default() };
                Box::new(Gather::new(&self.gl, &options, outputs)?)
            }
            Pipeline::Paper => self.options.create(&self.gl, outputs)?,
        };
        Ok(slot.insert(synthesis))
    }
}

impl Synthesized {
    /// Makes the method without what depends on the renderer.
    pub(super) fn new(gl: &Rc<Context>, options: &StereoOptions) -> Synthesized {
        Synthesized { gl: gl.clone(), options: *options, made: None, motion: None }
    }

    /// True if the picture is complete before the synthesis, as in the paper, instead of being composited after it.
    fn composites_first(&self) -> bool {
        self.options.synthesis.pipeline == Pipeline::Paper
    }
}

impl StereoMethod for Synthesized {
    fn prepare(&mut self, renderer: &mut Renderer, scene: &GpuScene) -> Result<(), StereoError> {
        let renders_holes = self.options.holes == HoleMethod::Rendered;
        renderer.prepare_over(scene)?;
        if renders_holes {
            renderer.prepare_holes(scene)?;
        }
        let pairs = renderer.depth_resolve == DepthResolve::InColor;
        let is_first = renderer.depth_resolve == DepthResolve::SingleSample;
        let made = match &mut self.made {
            Some(made) => made,
            slot => slot.insert(Made {
                guess: is_first.then(|| GuessedDepth::new(&self.gl, &Options::default())).transpose()?,
                targets: renderer.targets(Layout::Single)?,
                over: OverlayPass::new(renderer, renders_holes)?,
                inked: (renders_holes && renderer.ink).then(|| InkedHoles::new(renderer)).transpose()?,
                synthesizers: Synthesizers {
                    gl: self.gl.clone(),
                    options: self.options.synthesis,
                    pairs,
                    bloom: renderer.has_composite(),
                    made: [const { None }; 3],
                },
            }),
        };
        if self.motion.is_none() && self.options.motion_vectors {
            self.motion = Some(SynthesizedMotion::new(&self.gl, pairs)?);
        }
        // Depth is wanted of some frames: behind transparent surfaces, by displays, and around insets.
        let open = renders_holes.then_some(Kind::OpenHoles);
        for kind in [Kind::Color, Kind::ColorDepth].into_iter().chain(open) {
            made.synthesizers.get(kind)?;
        }
        Ok(())
    }

    fn rendered_part(&self, renderer: &Renderer, scene: &GpuScene, layer: &ViewLayer) -> Option<Part> {
        let is_kept = renderer.is_complete() && (renderer.loads_pictures || !scene.has_transparent());
        let views = is_kept.then(|| layer.synthesis_views(self.options.guard_band).ok()).flatten()?;
        Some(Part { origin: views.dominant_crop, image_size: views.source.size })
    }

    fn render(&mut self, frame: &Frame) -> Result<bool, StereoError> {
        let pair = &frame.pair;
        let renderer = frame.renderer;
        let part = self.rendered_part(renderer, &frame.scene, &frame.layer);
        let shown = part.and_then(|part| frame.to(pair.dominant).around(part, renderer, &frame.scene));
        let [dominant, other] = [pair.dominant, pair.dominant.other()];
        let views = frame.synthesis_views(self.options.guard_band)?;
        let transparent = [&views.source, &views.target].iter().any(|v| frame.scene.is_transparent_in(v));
        let renders_holes = self.options.holes == HoleMethod::Rendered && !frame.fills_holes;
        let surfaces = OverlaySurfaces { transparent, ..OverlaySurfaces::default() };
        let composites_first = self.composites_first();
        let Some(Made { targets, over, inked, synthesizers, guess }) = &mut self.made else {
            return Ok(false);
        };
        // Filled holes take their colours from beyond the border, too.
        let known = if renders_holes { Known::Border(&views.warp) } else { Known::Nothing };
        let seen = Rectangle { origin: views.dominant_crop, size: pair.size };
        let is_shown =
            renderer.draw_source(targets, &frame.scene, &views.source, Some(seen), known, shown.as_ref())?;
        let is_composited = composites_first && renderer.has_composite();
        if is_composited {
            let to = Destination::whole(targets.complete_picture(views.source.size)?);
            renderer.composite(targets, &views.source, Eye::Left, [0, 0], &to, None);
        }
        let composited = targets.composited.as_ref().filter(|_| is_composited);
        let own = |picture: &RenderTarget| picture.color(0).attachment();
        let (picture, image) = composited.map_or_else(|| targets.picture(), own);
        let depth = targets.depth(views.source.size, Eye::Left, [0, 0]);
        let stored = image.format == Format::Srgb8Alpha8;
        let mut source = Source { stored, ..Source::new(picture, depth.texture.raw()) };
        if let Some(guess) = guess {
            source = guess.guess(source, &views.warp)?;
        }
        source.bloom = targets.bloom.as_ref().filter(|_| !is_composited).map(|bloom| {
            let (texture, strength) = (bloom.result().raw(), renderer.bloom_strength());
            Bloom { texture, strength, origin: bloom.part().origin, size: bloom.part().size }
        });
        // The other eye first: both are finished in the same samples.
        let vectors = renders_holes && frame.to(other).motion.is_some();
        let keeps_depth = frame.wants_depth(other) || vectors;
        let other_surfaces = OverlaySurfaces { holes: renders_holes, keeps_depth, ..surfaces };
        let (to, has_depth) = over.begin(frame, other, &other_surfaces)?;
        over.draw(|| {
            if renders_holes {
                let synthesis = synthesizers.get(Kind::OpenHoles)?;
                let rendered = Rendered { source, targets, views: &views };
                rendered.render_other(frame, synthesis.as_mut(), inked.as_mut(), (&to, over.samples()))
            } else {
                let kind = if has_depth { Kind::ColorDepth } else { Kind::Color };
                synthesizers.get(kind)?.synthesize(source, &views.warp, &to)
            }
        })?;
        over.finish(frame, other, &other_surfaces);
        let Some(Made { targets, over, .. }) = &mut self.made else { return Ok(false) };
        let rendered = targets.depth(views.source.size, Eye::Left, [0, 0]);
        let rendered = RenderedDepth { depth: &rendered, view: &views.source };
        let mut has_motion = false;
        if let (Some(motion), Some(depth)) = (&mut self.motion, over.depth().filter(|_| vectors)) {
            has_motion = motion.write_known(frame, rendered, &depth)?;
        }
        let depth = targets.depth(views.source.size, Eye::Left, views.dominant_crop);
        frame.measure_depth(&depth)?;
        frame.write_depth(dominant, &depth);
        if let Some(shown) = shown.filter(|_| is_shown) {
            renderer.draw_over_source(targets, &frame.scene, &views.source, seen, &shown)?;
        } else {
            let (to, has_depth) = over.begin(frame, dominant, &surfaces)?;
            let region = surfaces.depth_region(frame, dominant).filter(|_| has_depth);
            over.draw(|| {
                renderer.composite(targets, &views.source, Eye::Left, views.dominant_crop, &to, region);
            });
            over.finish(frame, dominant, &surfaces);
        }
        let rendered = targets.depth(views.source.size, Eye::Left, [0, 0]);
        let rendered = RenderedDepth { depth: &rendered, view: &views.source };
        let Some(motion) = self.motion.as_mut().filter(|_| !vectors) else { return Ok(has_motion) };
        motion.write(frame, rendered, self.options.guard_band)
    }
}

/// A rendered view, of which the other eye is made.
struct Rendered<'a> {
    source: Source,
    targets: &'a Targets,
    views: &'a SynthesisViews,
}

impl Rendered<'_> {
    /// Synthesizes the other eye into a place with this many samples, and renders its holes.
    fn render_other(
        &self,
        frame: &Frame,
        synthesis: &mut dyn Synthesis,
        inked: Option<&mut InkedHoles>,
        (to, samples): (&Destination, u32),
    ) -> Result<(), GlError> {
        let (renderer, warp) = (frame.renderer, &self.views.warp);
        let view = frame.pair.view(frame.pair.dominant.other());
        let source = HoleSource { targets: self.targets, warp };
        let Some(inked) = inked else {
            synthesis.synthesize(self.source, warp, to)?;
            renderer.draw_holes(&frame.scene, &view, to, samples, &source);
            return Ok(());
        };
        let place = inked.fit(view.size)?;
        synthesis.synthesize(self.source, warp, &place)?;
        inked.mark(&place);
        renderer.draw_holes(&frame.scene, &view, &place, 1, &source);
        // Nothing reads the stencil of what is stored.
        renderer.gl.discard_stencil();
        renderer.ink_holes(inked, &frame.scene, &view, (to, samples), &source);
        Ok(())
    }
}
