//! The methods measured against each other.

use std::collections::BTreeMap;

use wasm_bindgen::prelude::*;
use yoro::eyes::Eye;
use yoro_gl::{PassTime, Profiling};
use yoro_render::stereo::{Method, Pipeline, StereoFrame, StereoMethod};

use crate::page::{Page, sentence};

/// All methods that the browser can do, ready to take turns.
pub struct Bench {
    entrants: Vec<Box<dyn StereoMethod>>,
    frame: StereoFrame,
    size: [u32; 2],
    passes: Vec<PassTime>,
    timed_frames: u32,
}

/// The name in result files, as `yoro bench` has it.
fn contender(method: Method) -> String {
    match method {
        Method::Yoro => format!("{}-{}", method.name(), Pipeline::Gather.name()),
        _ => method.name().to_owned(),
    }
}

#[wasm_bindgen]
impl Page {
    /// Prepares the scene's methods for images of this size; who takes part is JSON: `{"contenders": [...], "unsupported":
    /// [[name, reason]], "timerQueries"}`.
    ///
    /// # Errors
    /// A sentence, for instance without memory.
    #[wasm_bindgen(js_name = benchBegin)]
    pub fn bench_begin(&mut self, width: u32, height: u32) -> Result<String, JsError> {
        self.bench = None;
        let size = [width, height];
        let frame = StereoFrame::new(&self.gl, size).map_err(sentence)?;
        let render = self.settings.render_settings();
        let (mut names, mut entrants, mut unsupported) = (Vec::new(), Vec::new(), Vec::new());
        for method in Method::ALL {
            match render.supports(method, self.gl.capabilities()) {
                Err(reason) => unsupported.push((contender(method), reason.to_string())),
                Ok(()) => {
                    names.push(contender(method));
                    entrants.push(self.settings.create(&self.gl, method).map_err(sentence)?);
                }
            }
        }
        let capabilities = self.gl.capabilities();
        let facts = serde_json::json!({
            "contenders": names,
            "unsupported": unsupported,
            "timerQueries": capabilities.timer_queries,
        });
        self.bench = Some(Bench { entrants, frame, size, passes: Vec::new(), timed_frames: 0 });
        Ok(facts.to_string())
    }

    /// Renders stereo frames, and waits until the GPU has done the last one.
    ///
    /// # Errors
    /// A sentence.
    #[wasm_bindgen(js_name = benchFrames)]
    pub fn bench_frames(&mut self, contender: usize, viewpoint: usize, count: u32) -> Result<(), JsError> {
        for _ in 0..count {
            self.bench_frame(contender, viewpoint)?;
        }
        if let Some(bench) = &self.bench {
            // Browsers make little of glFinish; for a pixel they have to wait.
            bench.frame.eye(Eye::Left).read_rgba8(0, [0, 0], [1, 1]);
        }
        Ok(())
    }

    /// Begins timed frames.
    #[wasm_bindgen(js_name = benchStartPasses)]
    pub fn bench_start_passes(&mut self) {
        self.gl.set_profiling(Profiling::Queries);
    }

    /// Renders one stereo frame with a timer query around each pass; results come with later calls.
    ///
    /// # Errors
    /// A sentence.
    #[wasm_bindgen(js_name = benchTimedFrame)]
    pub fn bench_timed_frame(&mut self, contender: usize, viewpoint: usize) -> Result<(), JsError> {
        self.bench_frame(contender, viewpoint)?;
        if let Some(bench) = &mut self.bench {
            bench.timed_frames += self.gl.end_timed_frame(&mut bench.passes);
        }
        Ok(())
    }

    /// Ends timed frames: GPU time of each pass in ms, mean of the frames whose results have come, as JSON; `{}` for none.
    #[wasm_bindgen(js_name = benchTakePasses)]
    pub fn bench_take_passes(&mut self) -> String {
        self.gl.set_profiling(Profiling::Off);
        let mut sums: BTreeMap<&str, f64> = BTreeMap::new();
        if let Some(bench) = &mut self.bench {
            let frames = f64::from(std::mem::take(&mut bench.timed_frames).max(1));
            for pass in bench.passes.drain(..) {
                *sums.entry(pass.name).or_default() += pass.time.as_secs_f64() * 1e3 / frames;
            }
        }
        serde_json::json!(sums).to_string()
    }

    /// Lets go of what was prepared.
    #[wasm_bindgen(js_name = benchEnd)]
    pub fn bench_end(&mut self) {
        self.gl.set_profiling(Profiling::Off);
        self.bench = None;
    }

    fn bench_frame(&mut self, contender: usize, viewpoint: usize) -> Result<(), JsError> {
        let Some((bench, prepared)) = self.bench.as_mut().zip(self.scene.as_mut()) else {
            return Err(JsError::new("There is no scene to measure."));
        };
        let Some(viewpoint) = prepared.scene.viewpoints.get(viewpoint) else { return Ok(()) };
        let pair = self.settings.pair(viewpoint.pose(), bench.size);
        let Some(method) = bench.entrants.get_mut(contender) else { return Ok(()) };
        method.render(&mut prepared.renderer, &prepared.scene, &pair, &mut bench.frame).map_err(sentence)
    }
}
