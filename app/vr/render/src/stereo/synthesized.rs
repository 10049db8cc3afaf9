//! Renders the dominant eye and synthesizes the other.

use std::rc::Rc;

use super::frame::Frame;
use super::method::{StereoError, StereoMethod};
use super::motion::SynthesizedMotion;
use super::options::{Pipeline, PipelineOptions, StereoOptions};
use super::overlay::{OverlayPass, depth_part};
use super::pipeline::Synthesis;
use crate::view::{DepthResolve, GpuScene, Layout, RenderedDepth, Renderer, Targets};
use yoro::eyes::Eye;
use yoro::opengl::{Bloom, Gather, GuessedDepth, Options, Outputs, Source};
use yoro_gl::{Context, Destination, GlError};

/// One render with a guard band and one synthesis.
///
/// Bloom is added where an eye is written last: by the synthesis, and where the rendered eye is composited.
/// Transparent surfaces are drawn over both in the same passes.
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
    synthesizers: Synthesizers,
    /// Makes more of the depth of one sample, where a driver gives no more.
    guess: Option<GuessedDepth>,
}

/// Pipelines without and with depth of the synthesized eye, each made when first needed.
struct Synthesizers {
    gl: Rc<Context>,
    options: PipelineOptions,
    /// True if the source's depth is that of two samples.
    pairs: bool,
    /// True if the source lacks its bloom.
    bloom: bool,
    made: [Option<Box<dyn Synthesis>>; 2],
}

impl Synthesizers {
    /// Returns the pipeline with or without depth, and makes it on the first call.
    fn get(&mut self, depth: bool) -> Result<&mut Box<dyn Synthesis>, GlError> {
        let slot = &mut self.made[usize::from(depth)];
        if let Some(made) = slot {
            return Ok(made);
        }
        let outputs = Outputs { depth, ..Outputs::default() };
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
        renderer.prepare_over(scene)?;
        let pairs = renderer.depth_resolve == DepthResolve::InColor;
        let is_first = renderer.depth_resolve == DepthResolve::SingleSample;
        let made = match &mut self.made {
            Some(made) => made,
            slot => slot.insert(Made {
                guess: is_first.then(|| GuessedDepth::new(&self.gl, &Options::default())).transpose()?,
                targets: renderer.targets(Layout::Single)?,
                over: OverlayPass::new(renderer)?,
                synthesizers: Synthesizers {
                    gl: self.gl.clone(),
                    options: self.options.synthesis,
                    pairs,
                    bloom: renderer.has_composite(),
                    made: [None, None],
                },
            }),
        };
        if self.motion.is_none() && self.options.motion_vectors {
            self.motion = Some(SynthesizedMotion::new(&self.gl, pairs)?);
        }
        for depth in [false, true].into_iter().take(1 + usize::from(scene.has_transparent())) {
            made.synthesizers.get(depth)?;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<bool, StereoError> {
        let pair = &frame.pair;
        let renderer = frame.renderer;
        let [dominant, other] = [pair.dominant, pair.dominant.other()];
        let views = frame.synthesis_views(self.options.guard_band)?;
        let transparent = [&views.source, &views.target].iter().any(|v| frame.scene.is_transparent_in(v));
        let composites_first = self.composites_first();
        let Some(Made { targets, over, synthesizers, guess }) = &mut self.made else { return Ok(false) };
        renderer.draw_source(targets, &frame.scene, &views.source)?;
        let is_composited = composites_first && renderer.has_composite();
        if is_composited {
            let to = Destination::whole(targets.picture(views.source.size)?);
            renderer.composite(targets, &views.source, Eye::Left, [0, 0], &to, None);
        }
        let picture = targets.composited.as_ref().filter(|_| is_composited).unwrap_or(targets.color());
        let depth = targets.depth(views.source.size, Eye::Left, [0, 0]);
        let mut source = Source::new(picture.color(0).raw(), depth.texture.raw());
        if let Some(guess) = guess {
            source = guess.guess(source, &views.warp)?;
        }
        // The other eye first: both are finished in the same samples.
        let (to, has_depth) = over.begin(frame, other, transparent)?;
        let synthesis = synthesizers.get(has_depth)?;
        source.bloom = targets
            .bloom
            .as_ref()
            .filter(|_| !is_composited)
            .map(|bloom| Bloom { texture: bloom.result().raw(), strength: renderer.bloom_strength() });
        synthesis.synthesize(source, &views.warp, &to)?;
        over.finish(frame, other, transparent);
        frame.measure_depth(&targets.depth(views.source.size, Eye::Left, views.dominant_crop))?;
        let (to, has_depth) = over.begin(frame, dominant, transparent)?;
        let part = depth_part(frame, dominant, transparent).filter(|_| has_depth);
        renderer.composite(targets, &views.source, Eye::Left, views.dominant_crop, &to, part);
        over.finish(frame, dominant, transparent);
        let Some(motion) = &mut self.motion else { return Ok(false) };
        let depth = targets.depth(views.source.size, Eye::Left, [0, 0]);
        let rendered = RenderedDepth { depth: &depth, view: &views.source };
        motion.write(frame, rendered, self.options.guard_band)
    }
}
