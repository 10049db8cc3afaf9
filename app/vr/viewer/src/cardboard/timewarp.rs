//! Positional timewarp: moves the finished eyes to the head's pose at the time of display.

use std::rc::Rc;

use yoro::eyes::{Eye, EyePair, EyesError, PoseWarp};
use yoro::opengl::{AnyView, Options, Outputs, Source};
use yoro_gl::{Context, Destination, Format, GlError, RenderTarget};
use yoro_render::DepthCopy;
use yoro_render::stereo::{DepthTarget, EyeTarget, StereoError, StereoFrame};

/// Both finished eyes with their depth, and the pass that moves them. Each eye is synthesized from its own image; what that
/// image does not contain is filled like any disocclusion.
pub(super) struct PositionalTimewarp {
    frame: StereoFrame,
    depths: [RenderTarget; 2],
    copy: DepthCopy,
    any_view: AnyView,
    moved: StereoFrame,
}

impl PositionalTimewarp {
    /// Compiles the passes for eyes of `size` pixels.
    pub(super) fn new(gl: &Rc<Context>, size: [u32; 2]) -> Result<PositionalTimewarp, GlError> {
        let depth = || RenderTarget::new(gl, size, &[], Some(Format::Depth32F));
        Ok(PositionalTimewarp {
            frame: StereoFrame::new(gl, size)?,
            depths: [depth()?, depth()?],
            copy: DepthCopy::new(gl)?,
            any_view: AnyView::new(gl, &Options::default(), Outputs::default())?,
            moved: StereoFrame::new(gl, size)?,
        })
    }

    /// Resizes the images, if the size differs.
    pub(super) fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        self.frame.resize(size)?;
        self.depths.iter_mut().try_for_each(|depth| depth.resize(size))?;
        self.moved.resize(size)
    }

    /// Returns the eyes as they were rendered.
    pub(super) fn frame(&self) -> &StereoFrame {
        &self.frame
    }

    /// Returns the targets of a frame, with the depth that moving it needs.
    pub(super) fn targets(&self) -> [EyeTarget<'_>; 2] {
        let colors = self.frame.targets();
        Eye::BOTH.map(|eye| {
            let to = Destination::whole(&self.depths[eye.index()]);
            EyeTarget { depth: Some(DepthTarget { to, copy: &self.copy }), ..colors[eye.index()] }
        })
    }

    /// Moves both eyes from where they were rendered to where they are now. Returns `None` if the head has turned so far that
    /// the frame shows nothing of the present view.
    pub(super) fn run(
        &mut self,
        rendered: &EyePair,
        now: &EyePair,
    ) -> Result<Option<&StereoFrame>, StereoError> {
        let targets = self.moved.targets();
        for eye in Eye::BOTH {
            let warp = match PoseWarp::new(&rendered.view(eye), &now.view(eye)) {
                Err(EyesError::Apart) => return Ok(None),
                warp => warp?,
            };
            let [color, depth] = [self.frame.eye(eye).color(0), self.depths[eye.index()].depth()];
            let source = Source::new(color.raw(), depth.raw());
            self.any_view.synthesize(source, &warp, &targets[eye.index()].color)?;
        }
        Ok(Some(&self.moved))
    }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use yoro::eyes::{DepthRange, Frustum, Pose};
    use yoro_context::{Backend, Headless};

    use super::*;

    const SIZE: [u32; 2] = [64, 64];

    fn eyes(head: Pose) -> EyePair {
        EyePair::parallel(
            head,
            Frustum::symmetric(1.570_796_4, 1.0),
            0.06,
            DepthRange::PAPER,
            SIZE,
            Eye::Right,
        )
    }

    /// Returns the columns of an eye's image that show a red bar in front of a blue wall.
    fn red(frame: &StereoFrame, eye: Eye) -> Vec<usize> {
        let row = frame.eye(eye).read_rgba8(0, [0, 32], [SIZE[0], 1]);
        (0..SIZE[0] as usize).filter(|&x| row[4 * x] > 200).collect()
    }

    #[test]
    fn near_things_move_more_than_far_ones() {
        let headless = Headless::open(Backend::Egl).unwrap();
        let gl = headless.gl();
        let mut timewarp = PositionalTimewarp::new(gl, SIZE).unwrap();
        let before = eyes(Pose { position: Vec3::ZERO, orientation: Quat::IDENTITY });
        // A bar of eight columns a metre away, a wall 50 m away.
        for target in timewarp.targets() {
            let depth = target.depth.unwrap().to;
            gl.bind_framebuffer(depth.framebuffer, depth.origin, depth.size);
            gl.clear_rectangle([0, 0], SIZE, Some(before.depth.depth(50.0)));
            gl.clear_rectangle([28, 0], [8, SIZE[1]], Some(before.depth.depth(1.0)));
            gl.bind_framebuffer(target.color.framebuffer, [0, 0], SIZE);
            gl.fill([0, 0], SIZE, [0.0, 0.0, 1.0, 1.0]);
            gl.fill([28, 0], [8, SIZE[1]], [1.0, 0.0, 0.0, 1.0]);
        }
        // 25 cm to the right. A tangent is 32 pixels, so a point 1 m away moves by 8 pixels.
        let now = eyes(Pose { position: Vec3::X * 0.25, orientation: Quat::IDENTITY });
        for eye in Eye::BOTH {
            assert_eq!(red(timewarp.frame(), eye), (28..36).collect::<Vec<_>>());
            let moved = timewarp.run(&before, &now).unwrap().unwrap();
            assert_eq!(red(moved, eye), (20..28).collect::<Vec<_>>());
        }
        let away = eyes(Pose { position: Vec3::ZERO, orientation: Quat::from_rotation_y(2.0) });
        assert!(timewarp.run(&before, &away).unwrap().is_none());
        assert_eq!(gl.take_errors(), None);
    }
}
