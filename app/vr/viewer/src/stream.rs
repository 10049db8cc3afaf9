//! A stream shown instead of a scene. Its frames come from a thread of the platform, which owns the connection and the
//! decoder.

use std::rc::Rc;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use yoro::eyes::{EyePair, Pose};
use yoro_gl::{Context, GlError};
use yoro_render::stereo::EyeTarget;
use yoro_settings::telemetry::StreamFigures;
use yoro_stream::{DecodedPicture, FrameHeader, StreamedEyes, ViewRequest};

/// Passes data between the platform's thread and the viewer. Only the newest value of each kind is kept.
#[derive(Default)]
pub struct StreamExchange {
    newest: Mutex<Newest>,
    asked: Condvar,
}

#[derive(Default)]
struct Newest {
    home: Option<Pose>,
    frame: Option<FrameHeader>,
    planes: Vec<u8>,
    sentence: Option<String>,
    request: Option<ViewRequest>,
}

impl StreamExchange {
    fn newest(&self) -> MutexGuard<'_, Newest> {
        self.newest.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sets the head's initial pose.
    pub fn welcome(&self, home: Pose) {
        self.newest().home = Some(home);
    }

    /// Passes on a decoded frame, its three planes one after another, tightly packed. `planes` receives a buffer for
    /// reuse.
    pub fn put(&self, header: FrameHeader, planes: &mut Vec<u8>) {
        let mut newest = self.newest();
        newest.frame = Some(header);
        std::mem::swap(&mut newest.planes, planes);
    }

    /// Sets a sentence that is shown to the user until the next frame arrives.
    pub fn say(&self, sentence: &str) {
        self.newest().sentence = Some(sentence.into());
    }

    /// Takes the newest request, waiting for up to `wait`. No requests are made while nothing is drawn.
    pub fn take_request(&self, wait: Duration) -> Option<ViewRequest> {
        let mut newest = self.newest();
        if newest.request.is_none() && !wait.is_zero() {
            newest = self.asked.wait_timeout(newest, wait).unwrap_or_else(PoisonError::into_inner).0;
        }
        newest.request.take()
    }
}

/// The stream that is shown.
pub(crate) struct Stream {
    exchange: Arc<StreamExchange>,
    /// `None` without a GL context.
    eyes: Option<StreamedEyes>,
    planes: Vec<u8>,
    has_frame: bool,
    sentence: String,
    pub figures: StreamFigures,
}

impl Stream {
    pub fn new(exchange: Arc<StreamExchange>) -> Stream {
        let sentence = String::new();
        Stream {
            exchange,
            eyes: None,
            planes: Vec::new(),
            has_frame: false,
            sentence,
            figures: StreamFigures::default(),
        }
    }

    /// Compiles the passes that show the stream.
    pub fn attach(&mut self, gl: &Rc<Context>) -> Result<(), GlError> {
        self.eyes = Some(StreamedEyes::new(gl)?);
        Ok(())
    }

    /// Drops the objects on the GPU, and the frame with them.
    pub fn detach(&mut self) {
        (self.eyes, self.has_frame) = (None, false);
    }

    /// True if there is a frame to show.
    pub fn is_shown(&self) -> bool {
        self.has_frame
    }

    /// Returns the sentence for the user, if there is one.
    pub fn sentence(&self) -> Option<&str> {
        Some(self.sentence.as_str()).filter(|sentence| !sentence.is_empty())
    }

    /// Takes what has arrived. Returns the head's initial pose if it is new.
    pub fn take(&mut self, now_ns: i64) -> Result<Option<Pose>, GlError> {
        let mut newest = self.exchange.newest();
        let home = newest.home.take();
        if let Some(sentence) = newest.sentence.take() {
            self.sentence = sentence;
        }
        let Some(header) = newest.frame.take() else { return Ok(home) };
        std::mem::swap(&mut newest.planes, &mut self.planes);
        drop(newest);
        let Some(eyes) = &mut self.eyes else { return Ok(home) };
        if !eyes.take(header.content, header.size, &DecodedPicture::Planes(&self.planes))? {
            self.sentence = "A picture of the stream is not what its frame tells.".into();
            return Ok(home);
        }
        if !std::mem::replace(&mut self.has_frame, true) {
            log::info!("stream: the first frame, {} x {}", header.size[0], header.size[1]);
        }
        self.sentence.clear();
        self.figures.frames += 1;
        self.figures.latency_ms += milliseconds(now_ns) - header.time_ms;
        Ok(home)
    }

    /// Draws both eyes and requests a frame for them. Depth targets, if any, are cleared to the far plane.
    pub fn render(
        &mut self,
        gl: &Context,
        pair: &EyePair,
        to: &[EyeTarget; 2],
        now_ns: i64,
    ) -> Result<(), GlError> {
        let Some(eyes) = &mut self.eyes else { return Ok(()) };
        for depth in to.iter().filter_map(|eye| eye.depth) {
            gl.bind_framebuffer(depth.to.framebuffer, depth.to.origin, depth.to.size);
            gl.clear(Some(pair.depth.clear_value()));
        }
        eyes.render(pair, &to.map(|eye| eye.color))?;
        self.exchange.newest().request = eyes.request(milliseconds(now_ns));
        self.exchange.asked.notify_one();
        Ok(())
    }
}

fn milliseconds(now_ns: i64) -> f64 {
    now_ns as f64 * 1e-6
}
