//! The history: strips of the other eye that are rendered in addition, to fill disocclusions of this frame and of later
//! ones.

use std::rc::Rc;

use super::frame::{Frame, Setup};
use super::kinds::StereoRenderer;
use super::method::HistoryUse;
use super::readback::Readback;
use crate::render::{DepthCopy, DepthImage, Selection, ViewImages, ViewRequest};
use yoro::eyes::{Eye, EyePair, Frustum, SynthesisViews, View};
use yoro::synthesis::{History, Strips, Uniforms};
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource, Texture,
};

/// Texels of the image of counts, as in `stereo/uncovered.frag`.
const GRID: [u32; 2] = [32, 64];
/// Rows rendered beyond either end of a strip: as many as ambient occlusion reaches at half size.
const MARGIN: u32 = 8;
/// All strips are renewed once the unknown pixels have grown by this share of the uncovered ones.
const GROWTH: f32 = 0.1;
/// A strip is discarded once the head is this many metres, or this angle in radians, from where the strip was rendered.
const LEAP: f32 = 0.5;
const TURN: f32 = std::f32::consts::FRAC_PI_4;
/// A strip is discarded once the scene has moved this many times since it was rendered. While rounds follow one
/// another, every strip is renewed before that.
const MOVED: u64 = Strips::MAX as u64;

/// The history of one method.
pub(super) struct Past<R: StereoRenderer> {
    /// Pixels of the eye per pixel of the history, along each axis.
    scale: u32,
    /// The strip that is being rendered.
    targets: R::Targets,
    color: RenderTarget,
    depth: RenderTarget,
    copy: DepthCopy,
    strips: [Option<Strip>; Strips::MAX],
    eyes: Option<Eyes>,
    need: Need,
    rounds: Rounds,
    /// Number of pixels that were rendered in the last frame.
    rendered: u32,
}

/// The view that a strip shows.
#[derive(Clone, Copy)]
struct Strip {
    /// The whole eye, from where the strip was rendered.
    view: View,
    /// [`GpuScene::times_moved`](crate::GpuScene) when it was rendered.
    times_moved: u64,
}

/// What all strips have in common.
#[derive(Clone, Copy, PartialEq)]
struct Eyes {
    scene: u64,
    target: View,
    dominant: Eye,
    ipd: f32,
}

impl Eyes {
    fn new(scene: u64, pair: &EyePair, views: &SynthesisViews) -> Eyes {
        Eyes { scene, target: views.target, dominant: pair.dominant, ipd: pair.ipd() }
    }

    /// True if strips of the eyes `other` are of no use to these. Poses are ignored: each strip has its own.
    fn replaces(&self, other: &Eyes) -> bool {
        let posed = Eyes { target: View { pose: self.target.pose, ..other.target }, ipd: self.ipd, ..*other };
        // Allows for the rounding of poses.
        *self != posed || (self.ipd - other.ipd).abs() > 1e-3 * self.ipd.abs()
    }
}

/// Decides in which frames strips are rendered: a round of all strips, once the last round is of too little use.
#[derive(Debug, Default, PartialEq)]
struct Rounds {
    /// Number of strips that are still to be rendered in this round.
    left: usize,
    /// The number of the current round, from 1.
    round: u32,
    /// The fewest unknown pixels since the last round.
    least: Option<u32>,
}

impl Rounds {
    /// Takes the counts of a frame, and the round that served it. Begins a new round if that is worthwhile.
    fn measured(&mut self, round: Option<u32>, use_: &HistoryUse) {
        if self.left > 0 || round != Some(self.round) {
            return;
        }
        let least = self.least.map_or(use_.unknown, |least| least.min(use_.unknown));
        self.least = Some(least);
        // Before the first round everything is unknown.
        let known = if self.round == 0 { 0 } else { least };
        if use_.unknown as f32 > known as f32 + GROWTH * use_.uncovered as f32 {
            self.begin();
        }
    }

    fn begin(&mut self) {
        *self = Rounds { left: Strips::MAX, round: self.round + 1, least: None };
    }

    /// Notes that all strips were replaced at once.
    fn served(&mut self) {
        self.begin();
        self.left = 0;
    }

    /// Returns the number of the current round if it is complete.
    fn complete(&self) -> Option<u32> {
        (self.left == 0).then_some(self.round)
    }
}

impl<R: StereoRenderer> Past<R> {
    /// Makes the targets for a history of the eye's size divided by `scale`.
    pub(super) fn new(setup: &Setup, scale: u32) -> Result<Past<R>, GlError> {
        let gl = setup.gl;
        Ok(Past {
            scale,
            targets: R::targets(gl, setup.settings)?,
            color: RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], None)?,
            depth: RenderTarget::new(gl, [1, 1], &[], Some(Format::Depth32F))?,
            copy: DepthCopy::new(gl)?,
            strips: [None; Strips::MAX],
            eyes: None,
            need: Need::new(gl)?,
            rounds: Rounds::default(),
            rendered: 0,
        })
    }

    /// Starts over if the strips belong to other eyes.
    fn fit(&mut self, frame: &Frame<R>, views: &SynthesisViews) -> Result<(), GlError> {
        let eyes = Eyes::new(frame.scene.id(), frame.pair, views);
        if self.eyes.is_none_or(|before| eyes.replaces(&before)) {
            self.strips = [None; Strips::MAX];
            self.need.readback.forget();
            self.rounds = Rounds::default();
            self.color.resize(self.size(views))?;
            self.depth.resize(self.size(views))?;
        }
        self.eyes = Some(eyes);
        Ok(())
    }

    /// True if the history can be an image of the whole other eye: its size fits, and no glass is visible in it.
    pub(super) fn takes_whole(&self, frame: &Frame<R>, views: &SynthesisViews) -> bool {
        self.scale == 1 && !frame.scene.is_transparent_in(&views.target)
    }

    /// Replaces all strips with an image of the whole other eye, which must have depth.
    pub(super) fn take_whole(
        &mut self,
        frame: &Frame<R>,
        views: &SynthesisViews,
        targets: &R::Targets,
    ) -> Result<(), GlError> {
        self.fit(frame, views)?;
        self.keep(targets, 0, 0, views.target.size);
        let strip = Strip { view: views.target, times_moved: frame.scene.times_moved() };
        self.strips = [Some(strip); Strips::MAX];
        self.rounds.served();
        Ok(())
    }

    /// Copies a rendered image, from row `from` on, to row `first` of the history.
    fn keep(&self, targets: &R::Targets, from: u32, first: u32, size: [u32; 2]) {
        let to =
            |target: &RenderTarget| Destination { origin: [0, first], size, ..Destination::whole(target) };
        targets.color().copy_color([0, from], &to(&self.color));
        let depth = DepthImage { origin: [0, from], ..DepthImage::whole(targets.depth()) };
        self.copy.run(depth, &to(&self.depth));
    }

    /// Renders a strip if one is needed, and returns the history.
    pub(super) fn history(
        &mut self,
        frame: &Frame<R>,
        views: &SynthesisViews,
        selection: Selection,
    ) -> Result<History, GlError> {
        self.fit(frame, views)?;
        let mut is_late = false;
        for slot in &mut self.strips {
            let Some(strip) = *slot else { continue };
            let (from, to) = (strip.view.pose, views.target.pose);
            let moved = frame.scene.times_moved() - strip.times_moved;
            if (from.position - to.position).length() >= LEAP
                || from.orientation.angle_between(to.orientation) >= TURN
                || moved >= MOVED
            {
                *slot = None;
            }
            is_late |= slot.is_none() || moved > 0;
        }
        if let Some((round, measured)) = self.need.take() {
            self.rounds.measured(round, &measured);
        }
        if is_late && self.rounds.left == 0 {
            self.rounds.begin();
        }
        self.rendered = 0;
        if self.rounds.left > 0 {
            self.render(frame, views, Strips::MAX - self.rounds.left, selection)?;
            self.rounds.left -= 1;
        }
        Ok(self.relation(views))
    }

    fn size(&self, views: &SynthesisViews) -> [u32; 2] {
        views.target.size.map(|n| n.div_ceil(self.scale))
    }

    fn relation(&self, views: &SynthesisViews) -> History {
        History {
            color: self.color.color(0).raw(),
            depth: self.depth.depth().raw(),
            strips: Strips::new(&views.target, &self.strips.map(|strip| strip.map(|strip| strip.view))),
        }
    }

    /// Renders a strip as a view of its own, so that nothing beside it is drawn.
    fn render(
        &mut self,
        frame: &Frame<R>,
        views: &SynthesisViews,
        strip: usize,
        selection: Selection,
    ) -> Result<(), GlError> {
        let whole = View { size: self.size(views), ..views.target };
        let [width, height] = whole.size;
        let rows = height.div_ceil(Strips::MAX as u32);
        let first = strip as u32 * rows;
        let shown = rows.min(height.saturating_sub(first));
        if shown == 0 {
            return Ok(());
        }
        let row = whole.frustum.height() / height as f32;
        let bottom = whole.frustum.bottom + (first as f32 - MARGIN as f32) * row;
        // All strips have the same height, so that the targets keep their size.
        let high = rows + 2 * MARGIN;
        let frustum = Frustum { bottom, top: bottom + high as f32 * row, ..whole.frustum };
        let view = View { frustum, size: [width, high], ..whole };
        let request = ViewRequest { selection, ..ViewRequest::default() };
        frame.renderer.render(&mut self.targets, frame.scene, &view, &request)?;
        self.keep(&self.targets, MARGIN, first, [width, shown]);
        self.strips[strip] = Some(Strip { view: whole, times_moved: frame.scene.times_moved() });
        self.rendered = width * high;
        Ok(())
    }

    /// Starts to count the pixels that this frame uncovers, from the rendered eye's depth.
    pub(super) fn measure(&mut self, depth: &Texture, views: &SynthesisViews) {
        let history = self.relation(views);
        self.need.measure(depth, views, &history, self.rounds.complete());
    }

    /// Notes a frame without synthesis.
    pub(super) fn interrupt(&mut self) {
        self.need.readback.forget();
        self.rendered = 0;
    }

    /// Returns what was rendered in the last frame, and the counts of two frames before it.
    pub(super) fn last(&self) -> HistoryUse {
        HistoryUse { rendered: self.rendered, ..self.need.last }
    }
}

/// Counts the pixels that a frame uncovers, and how many the history does not show. Results are two frames late.
struct Need {
    gl: Rc<Context>,
    program: Program,
    readback: Readback<Option<u32>>,
    last: HistoryUse,
}

impl Need {
    fn new(gl: &Rc<Context>) -> Result<Need, GlError> {
        let defines = [("HISTORY", String::new())];
        Ok(Need {
            gl: gl.clone(),
            program: Program::new(gl, ShaderSource::Screen("stereo/uncovered.frag"), &defines)?,
            readback: Readback::new(gl, GRID)?,
            last: HistoryUse::default(),
        })
    }

    fn measure(&mut self, depth: &Texture, views: &SynthesisViews, history: &History, round: Option<u32>) {
        let uniforms = Uniforms::new(&views.warp, [0, 0]);
        self.gl.pass("uncovered", || {
            self.gl.set_raster_state(&RasterState::SCREEN);
            self.readback.image().bind();
            let program = self.program.bind();
            program.texture("depth_map", 0, depth.raw()).texture("history_depth", 1, history.depth);
            program.texture("history_color", 2, history.color);
            uniforms.set(program);
            history.strips.set(program);
            self.gl.draw_screen();
            self.readback.start(round);
        });
    }

    /// Returns the counts of an earlier frame, and the round that served it.
    fn take(&mut self) -> Option<(Option<u32>, HistoryUse)> {
        let mut texels = [0u8; (GRID[0] * GRID[1] * 4) as usize];
        let round = self.readback.take(&mut texels)?;
        let mut counted = HistoryUse::default();
        for texel in texels.as_chunks::<4>().0 {
            // `None` if the driver could not provide the texels.
            counted.uncovered += u32::from(u16::from_le_bytes([texel[0], texel[1]]).checked_sub(1)?);
            counted.unknown += u32::from(u16::from_le_bytes([texel[2], texel[3]]));
        }
        self.last = counted;
        Some((round, counted))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(uncovered: u32, unknown: u32) -> HistoryUse {
        HistoryUse { uncovered, unknown, rendered: 0 }
    }

    #[test]
    fn rounds_begin_when_the_unknown_has_grown() {
        let mut rounds = Rounds::default();
        rounds.measured(Some(0), &counted(0, 0));
        assert_eq!(rounds, Rounds { least: Some(0), ..Rounds::default() }, "nothing is uncovered");
        rounds.measured(Some(0), &counted(500, 500));
        assert_eq!((rounds.left, rounds.round), (Strips::MAX, 1));
        // Frames during the round, and before it, must not count.
        rounds.measured(Some(0), &counted(500, 500));
        rounds.left = 0;
        rounds.measured(Some(0), &counted(500, 500));
        rounds.measured(None, &counted(500, 400));
        assert_eq!(rounds, Rounds { round: 1, ..Rounds::default() });
        // Pixels that no round can serve do not begin one.
        for unknown in [100, 140, 90, 135] {
            rounds.measured(Some(1), &counted(500, unknown));
            assert_eq!(rounds.left, 0, "{unknown}");
        }
        rounds.measured(Some(1), &counted(500, 141));
        assert_eq!((rounds.left, rounds.round), (Strips::MAX, 2));
    }
}
