//! What is ready to be measured: a stereo method, and a synthesis alone.

use std::rc::Rc;
use std::time::{Duration, Instant};

use super::process;
use yoro::eyes::EyePair;
use yoro_gl::{Context, GlError, Profiling};
use yoro_render::stereo::{
    self, Method, StereoError, StereoFrame, StereoMethod, StereoOptions,
};
use yoro_render::{PreparedScene, RenderSettings};

/// A stereo method with its programs and targets, ready to be measured.
pub struct PreparedContender {
    gl: Rc<Context>,
    method: Box<dyn StereoMethod>,
    /// The number of frames that the method needs to settle at a new place.
    unsettled: u32,
}

/// The time that one frame took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTime {
    /// Wall-clock time up to glFinish.
    pub wall: Duration,
    /// CPU time of all threads of the process.
    pub cpu: Duration,
}

impl PreparedContender {
    /// Compiles the method's programs.
    pub fn new(
        gl: &Rc<Context>,
        method: Method,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<PreparedContender, GlError> {
        // The third frame is the first to use the result of the first: that all is near.
        let unsettled = if method == Method::Synthesized && options.policy.is_some() { 2 } else { 0 };
        Ok(PreparedContender {
            gl: gl.clone(),
            method: stereo::create(gl, method, settings, options)?,
            unsettled,
        })
    }

    /// Renders a frame at a new place after the method has settled there, and waits for it.
    pub fn render_settled(
        &mut self,
        prepared: &mut PreparedScene,
        pair: &EyePair,
        frame: &mut StereoFrame,
    ) -> Result<FrameTime, StereoError> {
        self.settle(prepared, pair, frame)?;
        self.render(prepared, pair, frame)
    }

    fn settle(
        &mut self,
        prepared: &mut PreparedScene,
        pair: &EyePair,
        frame: &mut StereoFrame,
    ) -> Result<(), StereoError> {
        for _ in 0..self.unsettled {
            self.render(prepared, pair, frame)?;
        }
        Ok(())
    }

    /// Renders a frame and waits for it.
    pub fn render(
        &mut self,
        prepared: &mut PreparedScene,
        pair: &EyePair,
        frame: &mut StereoFrame,
    ) -> Result<FrameTime, StereoError> {
        let (start, cpu) = (Instant::now(), process::cpu_time());
        self.method.render(&mut prepared.renderer, &prepared.scene, pair, frame)?;
        self.gl.finish();
        Ok(FrameTime { wall: start.elapsed(), cpu: process::cpu_time().saturating_sub(cpu) })
    }

    /// Renders a frame after settling, with a timer around each pass. Returns the passes' names in the order of their
    /// first run, and milliseconds. The runs of a pass within a frame are added up. Empty if the driver cannot measure
    /// passes ([`Context::take_pass_times`]).
    pub fn pass_times(
        &mut self,
        prepared: &mut PreparedScene,
        pair: &EyePair,
        frame: &mut StereoFrame,
    ) -> Result<Vec<(&'static str, f64)>, StereoError> {
        self.settle(prepared, pair, frame)?;
        self.gl.set_profiling(Profiling::Auto);
        let rendered = self.method.render(&mut prepared.renderer, &prepared.scene, pair, frame);
        let passes = self.gl.take_pass_times();
        self.gl.set_profiling(Profiling::Off);
        rendered?;
        let mut times: Vec<(&'static str, f64)> = Vec::new();
        for pass in passes {
            let milliseconds = pass.time.as_secs_f64() * 1e3;
            match times.iter_mut().find(|(name, _)| *name == pass.name) {
                Some((_, time)) => *time += milliseconds,
                None => times.push((pass.name, milliseconds)),
            }
        }
        Ok(times)
    }
}
