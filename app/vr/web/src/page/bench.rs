//! Measures the methods against one another.

use std::collections::BTreeMap;
use std::rc::Rc;

use wasm_bindgen::prelude::*;
use yoro::eyes::Eye;
use yoro_gl::{Context, PassTime, Profiling};
use yoro_render::stereo::{Method, Pipeline, StereoFrame, StereoSession};

use super::Page;
use super::error::sentence;
use crate::settings::Settings;

/// All methods that the browser supports, ready to be measured in turn. It is only valid for the page's present scene.
#[wasm_bindgen]
pub struct Bench {
    gl: Rc<Context>,
    entrants: Vec<StereoSession>,
    facts: String,
    frame: StereoFrame,
    size: [u32; 2],
    /// The choices that it was created with; the page's may change meanwhile.
    settings: Settings,
    passes: Vec<PassTime>,
    timed_frames: u32,
}

/// Returns a method's name in result files, the same as that of `yoro bench`.
fn contender(method: Method) -> String {
    match method {
        Method::Synthesized => format!("{}-{}", method.name(), Pipeline::Gather.name()),
        _ => method.name().to_owned(),
    }
}

#[wasm_bindgen]
impl Bench {
    /// Prepares the methods for images of this size.
    ///
    /// # Errors
    /// A sentence, for instance if there is not enough memory.
    #[wasm_bindgen(constructor)]
    pub fn new(page: &Page, width: u32, height: u32) -> Result<Bench, JsError> {
        let Page { gl, settings, .. } = page;
        let (mut names, mut entrants, mut unsupported) = (Vec::new(), Vec::new(), Vec::new());
        for method in Method::ALL {
            match settings.lacks(method, gl.capabilities()) {
                Some(reason) => unsupported.push((contender(method), reason)),
                None => {
                    names.push(contender(method));
                    entrants.push(settings.create_session(gl, method.into()).map_err(sentence)?);
                }
            }
        }
        // Otherwise timed passes of the picture's own frames would be counted, too.
        gl.set_profiling(Profiling::Off);
        let facts = serde_json::json!({
            "contenders": names,
            "unsupported": unsupported,
            "timerQueries": gl.capabilities().timer_queries,
        });
        Ok(Bench {
            gl: gl.clone(),
            entrants,
            facts: facts.to_string(),
            frame: StereoFrame::new(gl, [width, height]).map_err(sentence)?,
            size: [width, height],
            settings: *settings,
            passes: Vec::new(),
            timed_frames: 0,
        })
    }

    /// Returns the contenders as JSON: `{"contenders": [...], "unsupported": [[name, reason]], "timerQueries"}`.
    #[wasm_bindgen(getter)]
    pub fn facts(&self) -> String {
        self.facts.clone()
    }

    /// Renders `count` stereo frames, and waits until the GPU has finished the last one.
    pub fn frames(
        &mut self,
        page: &mut Page,
        contender: usize,
        viewpoint: usize,
        count: u32,
    ) -> Result<(), JsError> {
        for _ in 0..count {
            self.frame(page, contender, viewpoint)?;
        }
        // Browsers may ignore glFinish, but reading a pixel makes them wait.
        self.frame.eye(Eye::Left).read_rgba8(0, [0, 0], [1, 1]);
        Ok(())
    }

    /// Starts timed frames.
    #[wasm_bindgen(js_name = startPasses)]
    pub fn start_passes(&self) {
        self.gl.set_profiling(Profiling::Queries);
    }

    /// Renders one stereo frame with a timer query around each pass; the results arrive in later calls.
    #[wasm_bindgen(js_name = timedFrame)]
    pub fn timed_frame(
        &mut self,
        page: &mut Page,
        contender: usize,
        viewpoint: usize,
    ) -> Result<(), JsError> {
        self.frame(page, contender, viewpoint)?;
        self.timed_frames += u32::from(self.gl.end_timed_frame(&mut self.passes).is_some());
        Ok(())
    }

    /// Ends timed frames. Returns the GPU time of each pass in ms as JSON, the mean of the frames whose results have
    /// arrived; `{}` if there are none.
    #[wasm_bindgen(js_name = takePasses)]
    pub fn take_passes(&mut self) -> String {
        self.gl.set_profiling(Profiling::Off);
        let mut sums: BTreeMap<&str, f64> = BTreeMap::new();
        let frames = f64::from(std::mem::take(&mut self.timed_frames).max(1));
        for pass in self.passes.drain(..) {
            *sums.entry(pass.name).or_default() += pass.time.as_secs_f64() * 1e3 / frames;
        }
        serde_json::json!(sums).to_string()
    }

    /// Renders one stereo frame; does nothing for a contender or a viewpoint that does not exist.
    fn frame(&mut self, page: &mut Page, contender: usize, viewpoint: usize) -> Result<(), JsError> {
        let Some(scene) = page.scene() else { return Err(JsError::new("There is no scene to measure.")) };
        let prepared = &mut scene.prepared;
        let Some(viewpoint) = prepared.scene.viewpoints.get(viewpoint) else { return Ok(()) };
        let pair = self.settings.pair(viewpoint.pose(), self.size);
        let Some(session) = self.entrants.get_mut(contender) else { return Ok(()) };
        let targets = self.frame.fit(pair.size).map_err(sentence)?;
        session.frame(prepared, &pair.into(), targets, None).map(drop).map_err(sentence)
    }
}

impl Drop for Bench {
    fn drop(&mut self) {
        self.gl.set_profiling(Profiling::Off);
    }
}
