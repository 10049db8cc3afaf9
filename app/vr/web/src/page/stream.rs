//! The interface of a stream for JavaScript, which owns the connection and the decoder.

use js_sys::Uint8Array;
use wasm_bindgen::prelude::*;
use yoro::eyes::Pose;
use yoro_stream::{Correction, DecodedPicture, FromClient, FromServer, Refusal, Report};

use super::error::sentence;
use super::stream_show::StreamShow;
use super::{Content, Page};
use crate::walker::Walker;

#[wasm_bindgen]
extern "C" {
    /// A WebGL 2 context that uploads a decoded video frame, which web-sys supports only in its unstable interfaces.
    type VideoContext;
    #[wasm_bindgen(method, js_name = texSubImage2D)]
    fn upload(
        this: &VideoContext,
        to: u32,
        level: i32,
        x: i32,
        y: i32,
        format: u32,
        kind: u32,
        frame: &JsValue,
    );
}

#[wasm_bindgen]
impl Page {
    /// Returns the client's first message; none if the token is not 32 hexadecimal digits.
    #[wasm_bindgen(js_name = streamHello)]
    pub fn stream_hello(&self, token: &str) -> Option<Vec<u8>> {
        FromClient::hello(token).map(|hello| hello.to_bytes())
    }

    /// Handles a server's first answer, and shows its stream from now on, starting at the server's initial pose. A
    /// stream that continues after a lost connection keeps the head where it is. A video is shown whole. Returns a
    /// video's dominant eye, `left` or `right`; none for a stream, which is rendered for the page's.
    ///
    /// # Errors
    /// The reason why the server refuses, as a sentence.
    #[wasm_bindgen(js_name = streamBegin)]
    pub fn stream_begin(&mut self, answer: &[u8]) -> Result<Option<String>, JsError> {
        let (head, video) = match FromServer::read(answer) {
            Some(FromServer::Welcome(head)) => (head, None),
            Some(FromServer::Video(frusta, eye)) => (Pose::IDENTITY, Some((frusta, eye))),
            Some(FromServer::Refused(refusal)) => return Err(JsError::new(&refusal.to_string())),
            _ => return Err(JsError::new(&Refusal::Version.to_string())),
        };
        let frusta = video.map(|(frusta, _)| frusta);
        if !matches!(&self.content, Content::Stream(stream) if stream.frusta == frusta) {
            self.content = Content::Empty;
            let stream = StreamShow::new(&self.gl, frusta).map_err(sentence)?;
            self.content = Content::Stream(Box::new(stream));
            self.walker = Walker::new(head);
            self.orbit(false);
        }
        Ok(video.map(|(_, eye)| eye.name().into()))
    }

    /// Takes a frame, whose H.264 data may be omitted, with its decoded picture: a `Uint8Array` of its planes, or a
    /// `VideoFrame` of this size in pixels. Returns six numbers: the `performance.now()` at which its pose was sent; the
    /// ms for rendering and for encoding it; its quantizer; width and height of each part. None if no stream is shown.
    ///
    /// # Errors
    /// A sentence, for a frame that cannot be understood.
    #[wasm_bindgen(js_name = streamFrame)]
    pub fn stream_frame(
        &mut self,
        frame: &[u8],
        picture: &JsValue,
        width: u32,
        height: u32,
    ) -> Result<Vec<f64>, JsError> {
        let Content::Stream(stream) = &mut self.content else { return Ok(Vec::new()) };
        let Some(FromServer::Frame { header, .. }) = FromServer::read(frame) else {
            return Err(JsError::new("A frame of the stream cannot be understood."));
        };
        let context: &VideoContext = self.context.unchecked_ref();
        let upload = || context.upload(glow::TEXTURE_2D, 0, 0, 0, glow::RGBA, glow::UNSIGNED_BYTE, picture);
        let planes = picture.dyn_ref().map(Uint8Array::to_vec);
        let picture = match &planes {
            Some(planes) => DecodedPicture::Planes(planes),
            None => DecodedPicture::Upload([width, height], &upload),
        };
        if !stream.eyes.take(header.content, header.size, &picture).map_err(sentence)? {
            return Err(JsError::new("A picture of the stream is not what its frame tells."));
        }
        // An emulated headset clears the bound framebuffer before each frame: it must not be the one just drawn.
        self.gl.bind_framebuffer(None, [0, 0], [1, 1]);
        let [width, height] = header.size.map(f64::from);
        let (render, code) = (f64::from(header.render_ms), f64::from(header.encode_ms));
        Ok(vec![header.time_ms, render, code, f64::from(header.quantizer), width, height])
    }

    /// Returns the request for the newest eyes at a time of `performance.now()`; none before any were drawn.
    #[wasm_bindgen(js_name = streamRequest)]
    pub fn stream_request(&self, time: f64) -> Option<Vec<u8>> {
        let Content::Stream(stream) = &self.content else { return None };
        stream.eyes.request(time).map(|request| FromClient::Request(request).to_bytes())
    }

    /// Returns the mean distance in cm and angle in degrees between the poses for which pictures were rendered and
    /// those at which they were shown, since the last call; none if nothing was shown.
    #[wasm_bindgen(js_name = streamCorrection)]
    pub fn stream_correction(&mut self) -> Option<Vec<f32>> {
        let Content::Stream(stream) = &mut self.content else { return None };
        let Correction { metres, radians } = stream.eyes.take_correction()?;
        Some(vec![metres * 100.0, radians.to_degrees()])
    }
}

/// Reports what has become of a connection's frames.
#[wasm_bindgen]
#[derive(Default)]
pub struct StreamReport(Report);

#[wasm_bindgen]
impl StreamReport {
    /// Creates the report of a new connection.
    #[wasm_bindgen(constructor)]
    pub fn new() -> StreamReport {
        StreamReport::default()
    }

    /// Notes that a frame has arrived at `time` in ms.
    pub fn arrived(&mut self, number: u32, time: f64) {
        self.0.arrived(number, time);
    }

    /// Notes that a frame was decoded.
    pub fn decoded(&mut self, number: u32) {
        self.0.decoded = self.0.decoded.max(Some(number));
    }

    /// Returns the message.
    pub fn message(&self) -> Vec<u8> {
        FromClient::Report(self.0).to_bytes()
    }
}
