//! The interface for JavaScript to a stream. JavaScript has the connection and the decoder.

use js_sys::{Array, Uint8Array};
use wasm_bindgen::prelude::*;
use yoro::eyes::{Frustum, Pose};
use yoro_stream::{FromServer, FromViewer, Refusal};

use super::error::sentence;
use super::stream_show::StreamShow;
use super::{Content, Page};
use crate::walker::Walker;

#[wasm_bindgen]
impl Page {
    /// Returns the message with which a viewer begins; none for a token that is not 32 hexadecimal digits.
    #[wasm_bindgen(js_name = streamHello)]
    pub fn stream_hello(&self, token: &str) -> Option<Vec<u8>> {
        FromViewer::hello(token).map(|hello| hello.to_bytes())
    }

    /// Takes the first answer of a server, and shows its stream from now on, from the head's first pose; one that goes on
    /// after a connection was lost keeps the head where it is.
    ///
    /// # Errors
    /// Why the server refuses, as a sentence.
    #[wasm_bindgen(js_name = streamBegin)]
    pub fn stream_begin(&mut self, answer: &[u8]) -> Result<(), JsError> {
        let refused = match FromServer::read(answer) {
            Some(FromServer::Welcome(head)) => {
                if !matches!(self.content, Content::Stream(_)) {
                    self.content = Content::Empty;
                    self.content = Content::Stream(Box::new(StreamShow::new(&self.gl).map_err(sentence)?));
                    self.walker = Walker::new(head);
                    self.orbit(false);
                }
                return Ok(());
            }
            Some(FromServer::Refused(refusal)) => refusal,
            _ => Refusal::Version,
        };
        Err(JsError::new(&refused.to_string()))
    }

    /// Shows the stream as a video, whole, from where it was taken: `frusta` are the tangents of left, right, bottom and top of
    /// the left eye, then of the right one. Nothing for fewer numbers.
    #[wasm_bindgen(js_name = streamFrusta)]
    pub fn stream_frusta(&mut self, frusta: &[f32]) {
        let Content::Stream(stream) = &mut self.content else { return };
        let ([left, right], []) = frusta.as_chunks::<4>() else { return };
        let frustum = |[left, right, bottom, top]: [f32; 4]| Frustum { left, right, bottom, top };
        stream.show_whole([*left, *right].map(frustum));
        self.walker = Walker::new(Pose::IDENTITY);
    }

    /// Takes a frame, whose H.264 may be left out, with its decoded picture. Returns the message that confirms it, and six
    /// numbers: when the pose that it was rendered for was sent, by `performance.now()`; the ms to render and to encode it; its
    /// quantizer; width and height of each part.
    ///
    /// # Errors
    /// A sentence, for a frame that cannot be understood.
    #[wasm_bindgen(js_name = streamFrame)]
    pub fn stream_frame(&mut self, frame: &[u8], planes: &[u8]) -> Result<Array, JsError> {
        let Content::Stream(stream) = &mut self.content else { return Ok(Array::new()) };
        let Some(FromServer::Frame { number, header, .. }) = FromServer::read(frame) else {
            return Err(JsError::new("A frame of the stream cannot be understood."));
        };
        if !stream.eyes.take(header.content, header.size, planes).map_err(sentence)? {
            return Err(JsError::new("A picture of the stream is not what its frame tells."));
        }
        let decoded = Uint8Array::from(&FromViewer::Decoded(number).to_bytes()[..]);
        let [width, height] = header.size.map(f64::from);
        let (render, code) = (f64::from(header.render_ms), f64::from(header.encode_ms));
        let facts = [header.time, render, code, f64::from(header.quantizer), width, height];
        Ok(Array::of2(&decoded, &facts.into_iter().map(JsValue::from).collect::<Array>()))
    }

    /// Returns the message that asks for the newest eyes at a time of `performance.now()`; none before any were drawn.
    #[wasm_bindgen(js_name = streamRequest)]
    pub fn stream_request(&self, time: f64) -> Option<Vec<u8>> {
        let Content::Stream(stream) = &self.content else { return None };
        stream.eyes.request(time).map(|request| FromViewer::Request(request).to_bytes())
    }

    /// Returns the mean distance in cm and angle in degrees from the pose that a picture was rendered for to the one that it was shown
    /// at, of all that was shown since the last call; none if that is nothing.
    #[wasm_bindgen(js_name = streamCorrection)]
    pub fn stream_correction(&mut self) -> Option<Vec<f32>> {
        let Content::Stream(stream) = &mut self.content else { return None };
        let [metres, radians] = stream.eyes.take_correction()?;
        Some(vec![metres * 100.0, radians.to_degrees()])
    }
}
