//! RGBD videos for the page: where the pictures of a file are, and what they show, in a stream's messages. The page decodes them.

#![cfg(target_arch = "wasm32")]

use std::path::Path;

use wasm_bindgen::prelude::*;
use yoro::eyes::{Eye, Pose};
use yoro_stream::{Content, EyeView, FrameHeader, FromServer};
use yoro_video::{Index, Indexer, Rgbd, VideoError};

/// A file whose content is being found.
#[wasm_bindgen]
pub struct VideoFile(Indexer);

/// A file's content.
#[wasm_bindgen]
pub struct Video {
    index: Index,
    rgbd: Rgbd,
    header: FrameHeader,
}

#[wasm_bindgen]
impl VideoFile {
    /// Begins with a file of this name and length in bytes.
    #[wasm_bindgen(constructor)]
    pub fn new(name: &str, length: f64) -> VideoFile {
        VideoFile(Indexer::new(Path::new(name), length as u64))
    }

    /// Returns place and length in bytes of the piece that is needed next; none if nothing is.
    ///
    /// # Errors
    /// A sentence, for what is no MP4 file.
    pub fn needed(&self) -> Result<Option<Vec<f64>>, JsError> {
        let needed = self.0.needed().map_err(sentence)?;
        Ok(needed.map(|(position, size)| vec![position as f64, size as f64]))
    }

    /// Takes a piece.
    pub fn take(&mut self, position: f64, piece: &[u8]) {
        self.0.take(position as u64, piece);
    }

    /// Returns what is in the file, once nothing is needed.
    ///
    /// # Errors
    /// A sentence, for a file that is damaged, or has no H.264 or no depth.
    pub fn finish(self) -> Result<Video, JsError> {
        let index = self.0.finish().map_err(sentence)?;
        let rgbd = index.rgbd().map_err(sentence)?;
        let source = rgbd
            .views()
            .map_err(|error| JsError::new(&format!("The video cannot be shown: {error}.")))?
            .source;
        let view = EyeView { pose: source.pose, frustum: source.frustum };
        let header = FrameHeader {
            time: 0.0,
            content: Content::Depth(view, [rgbd.nearest, rgbd.farthest]),
            size: source.size.map(|n| n.try_into().unwrap_or(u16::MAX)),
            render_ms: 0.0,
            encode_ms: 0.0,
            quantizer: 0,
        };
        let video = Video { index, rgbd, header };
        if FromServer::read(&video.head(0)).is_none() {
            return Err(JsError::new(
                "The video cannot be shown: it has more than 4096 pixels a side, or no eye's angles.",
            ));
        }
        Ok(video)
    }
}

#[wasm_bindgen]
impl Video {
    /// Returns the codec's name, as the browser's decoder takes it.
    ///
    /// # Errors
    /// A sentence.
    pub fn codec(&self) -> Result<String, JsError> {
        self.index.codec().map_err(sentence)
    }

    /// Returns the decoder's configuration.
    ///
    /// # Errors
    /// A sentence.
    pub fn description(&self) -> Result<Vec<u8>, JsError> {
        self.index.description().map_err(sentence)
    }

    /// Returns five numbers for each picture: place and length in bytes, 1 for an intra frame, time and duration in seconds.
    pub fn pictures(&self) -> Vec<f64> {
        let numbers = self.index.pictures.iter().map(|encoded| {
            [
                encoded.offset as f64,
                encoded.size as f64,
                f64::from(u8::from(encoded.intra)),
                encoded.time,
                encoded.duration,
            ]
        });
        numbers.flatten().collect()
    }

    /// Returns the message with which a stream begins.
    pub fn welcome(&self) -> Vec<u8> {
        FromServer::Welcome(Pose::IDENTITY).to_bytes()
    }

    /// Returns what stands before a frame's picture in a stream.
    pub fn head(&self, number: u32) -> Vec<u8> {
        FromServer::Frame { number, intra: false, header: self.header, data: &[] }.to_bytes()
    }

    /// Returns the tangents of both eyes' sides: left, right, bottom and top of the left eye, then of the right one.
    pub fn frusta(&self) -> Vec<f32> {
        let frusta = self.rgbd.pair().frusta;
        frusta.iter().flat_map(|f| [f.left, f.right, f.bottom, f.top]).collect()
    }

    /// True if the right eye is the rendered one.
    #[wasm_bindgen(js_name = isRight)]
    pub fn is_right(&self) -> bool {
        self.rgbd.eye == Eye::Right
    }
}

fn sentence(error: VideoError) -> JsError {
    JsError::new(&format!("{error}."))
}
