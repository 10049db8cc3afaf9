//! Measures the methods against each other.

use std::collections::BTreeMap;
use std::rc::Rc;

use yoro::eyes::Eye;
use yoro_gl::{Context, GlError, PassTime};
use yoro_render::PreparedScene;
use yoro_render::stereo::{Method, Pipeline, StereoError, StereoFrame, StereoMethod};

use crate::settings::Settings;

/// All methods that the browser supports, ready to take turns.
pub struct Bench {
    gl: Rc<Context>,
    entrants: Vec<Box<dyn StereoMethod>>,
    frame: StereoFrame,
    size: [u32; 2],
    passes: Vec<PassTime>,
    timed_frames: u32,
}

/// Returns the name of a method in result files, the one that `yoro bench` uses.
fn contender(method: Method) -> String {
    match method {
        Method::Yoro => format!("{}-{}", method.name(), Pipeline::Gather.name()),
        _ => method.name().to_owned(),
    }
}

impl Bench {
    /// Prepares the methods for images of this size, and returns who takes part as JSON: `{"contenders": [...],
    /// "unsupported": [[name, reason]], "timerQueries"}`.
    ///
    /// # Errors
    /// The GPU cannot do it, for instance for want of memory.
    pub fn new(gl: &Rc<Context>, settings: &Settings, size: [u32; 2]) -> Result<(Bench, String), GlError> {
        let render = settings.render_settings();
        let (mut names, mut entrants, mut unsupported) = (Vec::new(), Vec::new(), Vec::new());
        for method in Method::ALL {
            match render.supports(method, gl.capabilities()) {
                Err(reason) => unsupported.push((contender(method), reason.to_string())),
                Ok(()) => {
                    names.push(contender(method));
                    entrants.push(settings.create(gl, method)?);
                }
            }
        }
        let facts = serde_json::json!({
            "contenders": names,
            "unsupported": unsupported,
            "timerQueries": gl.capabilities().timer_queries,
        });
        let frame = StereoFrame::new(gl, size)?;
        let bench = Bench { gl: gl.clone(), entrants, frame, size, passes: Vec::new(), timed_frames: 0 };
        Ok((bench, facts.to_string()))
    }

    /// Renders one stereo frame; nothing for a contender or a viewpoint that there is not.
    ///
    /// # Errors
    /// The method's.
    pub fn frame(
        &mut self,
        settings: &Settings,
        prepared: &mut PreparedScene,
        contender: usize,
        viewpoint: usize,
    ) -> Result<(), StereoError> {
        let Some(viewpoint) = prepared.scene.viewpoints.get(viewpoint) else { return Ok(()) };
        let pair = settings.pair(viewpoint.pose(), self.size);
        let Some(method) = self.entrants.get_mut(contender) else { return Ok(()) };
        method.render(&mut prepared.renderer, &prepared.scene, &pair, &mut self.frame)
    }

    /// Waits until the GPU has done the last frame.
    pub fn wait(&self) {
        // Browsers make little of glFinish; for a pixel they have to wait.
        self.frame.eye(Eye::Left).read_rgba8(0, [0, 0], [1, 1]);
    }

    /// Ends a frame with a timer query around each pass, and collects the results that have come.
    pub fn end_timed_frame(&mut self) {
        self.timed_frames += self.gl.end_timed_frame(&mut self.passes);
    }

    /// Returns the GPU time of each pass in ms, the mean of the frames whose results have come, and begins anew.
    pub fn take_passes(&mut self) -> BTreeMap<&'static str, f64> {
        let mut sums = BTreeMap::new();
        let frames = f64::from(std::mem::take(&mut self.timed_frames).max(1));
        for pass in self.passes.drain(..) {
            *sums.entry(pass.name).or_default() += pass.time.as_secs_f64() * 1e3 / frames;
        }
        sums
    }
}
