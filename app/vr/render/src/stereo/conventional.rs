//! The ground truth: renders both eyes, one after the other.

use super::frame::Frame;
use super::method::{EyeTarget, LevelEyes, MethodReport, StereoError, StereoMethod};
use super::motion::write_rendered;
use super::options::StereoOptions;
use crate::view::{DepthImage, DepthResolve, GpuScene, Layout, Renderer, Targets, VectorPass};
use yoro::eyes::Eye;
use yoro_gl::GlError;

/// Two full renders.
#[derive(Default)]
pub struct Conventional {
    targets: Option<Targets>,
    /// True if a runtime makes frames of its motion vectors.
    has_vectors: bool,
    vectors: Option<VectorPass>,
    /// True if the last frame's vectors were written.
    has_motion: bool,
}

impl Conventional {
    /// Makes the method without what depends on the renderer.
    pub(super) fn new(options: &StereoOptions) -> Conventional {
        Conventional { has_vectors: options.motion_vectors, ..Conventional::default() }
    }

    /// Renders both eyes, the dominant one last. Calls `rendered` after each that `reads_depth`, with its depth.
    pub(super) fn render_eyes(
        &mut self,
        frame: &Frame,
        reads_depth: impl Fn(Eye) -> bool,
        mut rendered: impl FnMut(&DepthImage) -> Result<(), GlError>,
    ) -> Result<(), GlError> {
        let Some(targets) = &mut self.targets else { return Ok(()) };
        self.has_motion = false;
        let dominant = frame.pair.dominant;
        for eye in [dominant.other(), dominant] {
            let (view, to) = (frame.pair.view(eye), frame.to(eye));
            let depth = frame.wants_depth(eye) || frame.to(eye).motion.is_some() || reads_depth(eye);
            let views = std::slice::from_ref(&view);
            let is_complete = frame.renderer.draw_all(targets, &frame.scene, views, depth, Some(to))?;
            if !is_complete {
                frame.renderer.develop(targets, &view, Eye::Left, [0, 0], &to.color, None);
            }
            if depth {
                let depth = targets.depth(view.size, Eye::Left, [0, 0]);
                frame.write_depth(eye, &depth);
                if let Some(pass) = self.vectors.as_mut().filter(|_| frame.to(eye).motion.is_some()) {
                    self.has_motion = write_rendered(pass, frame, eye, &depth)?;
                }
                if reads_depth(eye) {
                    rendered(&depth)?;
                }
            }
        }
        Ok(())
    }

    /// True if the last frame's motion targets were filled.
    pub(super) fn has_motion(&self) -> bool {
        self.has_motion
    }

    /// Makes targets and passes, unless they are made already.
    pub(super) fn make(&mut self, renderer: &Renderer) -> Result<(), GlError> {
        if self.targets.is_none() {
            self.targets = Some(renderer.targets(Layout::Single)?);
            let is_pair = renderer.nearest_depth() == DepthResolve::InColor;
            self.vectors = self.has_vectors.then(|| VectorPass::new(&renderer.gl, is_pair)).transpose()?;
        }
        Ok(())
    }
}

impl StereoMethod for Conventional {
    fn prepare(&mut self, renderer: &mut Renderer, _: &GpuScene) -> Result<(), StereoError> {
        Ok(self.make(renderer)?)
    }

    fn report(&self) -> MethodReport {
        MethodReport { has_motion: self.has_motion, ..MethodReport::default() }
    }

    fn render_level(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        level: &LevelEyes,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        self.prepare(renderer, scene)?;
        Ok(self.render_eyes(&Frame::new(renderer, scene, level, to)?, |_| false, |_| Ok(()))?)
    }
}
