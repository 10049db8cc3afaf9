//! Motion vectors of both eyes, for runtimes that make frames between those that are rendered.

use std::rc::Rc;

use super::frame::Frame;
use super::method::{MotionTarget, StereoError};
use crate::view::{DepthImage, RenderedDepth, Step, VectorPass};
use yoro::eyes::{Eye, EyePair, EyesError, GuardBand, VectorSpace, VectorsOf, View, ViewLayer};
use yoro::opengl::{Motion, Options, Outputs, Source};
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget};

/// The targets of both eyes' vectors, with the pairs of eyes of both frames at the vectors' size.
pub(super) struct MotionFrame<'a> {
    targets: [&'a MotionTarget; 2],
    now: EyePair,
    then: EyePair,
}

impl<'a> MotionFrame<'a> {
    /// Returns what a frame asks for; `None` unless both eyes have targets.
    pub(super) fn new(frame: &'a Frame) -> Option<MotionFrame<'a>> {
        let [left, right] = Eye::BOTH.map(|eye| frame.to(eye).motion.as_ref());
        let targets = [left?, right?];
        let previous = targets.map(|target| target.previous);
        let depth = frame.written(frame.pair.depth);
        let now = EyePair { size: targets[0].to.size, depth, ..frame.pair };
        let then = EyePair {
            poses: previous.map(|view| view.pose),
            frusta: previous.map(|view| view.frustum),
            depth: frame.written(previous[0].depth),
            ..now
        };
        Some(MotionFrame { targets, now, then })
    }

    /// Returns the step of a view of an eye.
    fn step(&self, eye: Eye, view: View) -> Step {
        let ndc = self.targets[eye.index()].ndc;
        Step { view, now: self.now.view(eye), then: self.then.view(eye), ndc }
    }
}

/// Writes the vectors of an eye whose depth is known.
pub(super) fn write_rendered(
    pass: &mut VectorPass,
    frame: &Frame,
    eye: Eye,
    rendered: RenderedDepth,
) -> Result<bool, GlError> {
    let Some(motion) = MotionFrame::new(frame) else { return Ok(false) };
    let step = motion.step(eye, motion.now.view(eye));
    pass.draw_moving(&frame.scene, &step)?;
    pass.write(rendered, &step, [0, 0], &motion.targets[eye.index()].to)?;
    Ok(true)
}

/// Writes the vectors of a rendered eye, and makes the other eye's of them.
pub(super) struct SynthesizedMotion {
    pass: VectorPass,
    source: RenderTarget,
    motion: Motion,
}

impl SynthesizedMotion {
    /// Makes it for views with one depth a pixel, or with a pair.
    pub(super) fn new(gl: &Rc<Context>, is_pair: bool) -> Result<SynthesizedMotion, GlError> {
        let formats = [(Format::Rgba16F, Filter::Nearest)];
        let outputs = Outputs { depth: true, ..Outputs::default() };
        Ok(SynthesizedMotion {
            pass: VectorPass::new(gl, is_pair)?,
            source: RenderTarget::new(gl, [1, 1], &formats, Some(Format::Depth32F))?,
            motion: Motion::new(gl, &Options::default(), outputs)?,
        })
    }

    /// Writes what a frame asks for, from the depths of the rendered view and of all of the other eye.
    pub(super) fn write_known(
        &mut self,
        frame: &Frame,
        rendered: RenderedDepth,
        other: &DepthImage,
    ) -> Result<bool, StereoError> {
        let eye = frame.pair.dominant;
        let other = RenderedDepth { depth: other, view: &frame.pair.view(eye.other()) };
        let pass = &mut self.pass;
        Ok(write_rendered(pass, frame, eye.other(), other)? && write_rendered(pass, frame, eye, rendered)?)
    }

    /// Writes what a frame asks for, from the depth of the rendered view. Returns false if it asks for nothing, or if the
    /// frames have no law in common.
    pub(super) fn write(
        &mut self,
        frame: &Frame,
        rendered: RenderedDepth,
        guard_band: GuardBand,
    ) -> Result<bool, StereoError> {
        let Some(motion) = MotionFrame::new(frame) else { return Ok(false) };
        let dominant = frame.pair.dominant;
        let guard_band = match guard_band {
            // As wide as in the image, or wider by a part of a column.
            GuardBand::Pixels(n) => {
                GuardBand::Pixels((n * motion.now.size[0]).div_ceil(frame.pair.size[0].max(1)))
            }
            other => other,
        };
        let views = [motion.now, motion.then]
            .map(|eyes| ViewLayer { eyes, ..frame.layer }.synthesis_views(guard_band));
        let [Ok(now), Ok(then)] = views else { return Ok(false) };
        let ndc = motion.targets[dominant.other().index()].ndc;
        let warp = match now.motion(&then, VectorSpace { ndc, of: VectorsOf::Eye }) {
            Err(EyesError::OtherFrame { .. }) => return Ok(false),
            warp => warp?,
        };
        let step = motion.step(dominant, now.source);
        self.source.resize(now.source.size)?;
        self.pass.draw_moving(&frame.scene, &step)?;
        self.pass.write(rendered, &step, [0, 0], &Destination::whole(&self.source))?;
        let own = &motion.targets[dominant.index()].to;
        self.pass.write(rendered, &step, now.dominant_crop, own)?;
        let source = Source::new(self.source.color(0).raw(), self.source.depth().raw());
        self.motion.synthesize(source, &warp, &motion.targets[dominant.other().index()].to)?;
        Ok(true)
    }
}
