//! The ground truth: renders both eyes, one after the other.

use super::frame::Frame;
use super::method::{StereoError, StereoMethod};
use super::motion::write_rendered;
use super::options::StereoOptions;
use crate::view::{DepthResolve, GpuScene, Layout, RenderedDepth, Renderer, Targets, VectorPass};
use yoro::eyes::Eye;
use yoro_gl::GlError;

/// Two full renders.
#[derive(Default)]
pub struct Conventional {
    targets: Option<Targets>,
    /// True if a runtime makes frames of its motion vectors.
    has_vectors: bool,
    vectors: Option<VectorPass>,
}

impl Conventional {
    /// Makes the method without what depends on the renderer.
    pub(super) fn new(options: &StereoOptions) -> Conventional {
        Conventional { has_vectors: options.motion_vectors, ..Conventional::default() }
    }

    /// Makes targets and passes, unless they are made already.
    fn make(&mut self, renderer: &Renderer) -> Result<(), GlError> {
        if self.targets.is_none() {
            self.targets = Some(renderer.targets(Layout::Single)?);
            let is_pair = renderer.depth_resolve == DepthResolve::InColor;
            self.vectors = self.has_vectors.then(|| VectorPass::new(&renderer.gl, is_pair)).transpose()?;
        }
        Ok(())
    }
}

impl StereoMethod for Conventional {
    fn prepare(&mut self, renderer: &mut Renderer, _: &GpuScene) -> Result<(), StereoError> {
        Ok(self.make(renderer)?)
    }

    /// Renders both eyes, the dominant one last.
    fn render(&mut self, frame: &Frame) -> Result<bool, StereoError> {
        let Some(targets) = &mut self.targets else { return Ok(false) };
        let mut has_motion = false;
        let dominant = frame.pair.dominant;
        for eye in [dominant.other(), dominant] {
            let (view, to) = (frame.pair.view(eye), frame.to(eye));
            let is_measured = eye == dominant && frame.measures_depth();
            let depth = frame.wants_depth(eye) || to.motion.is_some() || is_measured;
            let views = std::slice::from_ref(&view);
            let is_complete = frame.renderer.draw_all(targets, &frame.scene, views, depth, Some(to))?;
            if !is_complete {
                frame.renderer.composite(targets, &view, Eye::Left, [0, 0], &to.color, None);
            }
            if depth {
                let depth = targets.depth(view.size, Eye::Left, [0, 0]);
                frame.write_depth(eye, &depth);
                if let Some(pass) = self.vectors.as_mut().filter(|_| to.motion.is_some()) {
                    let rendered = RenderedDepth { depth: &depth, view: &view };
                    has_motion = write_rendered(pass, frame, eye, rendered)?;
                }
                if is_measured {
                    frame.measure_depth(&depth)?;
                }
            }
        }
        Ok(has_motion)
    }
}
