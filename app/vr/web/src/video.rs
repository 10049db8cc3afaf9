//! RGBD videos for the page: the locations of a file's pictures, and their content in the form of a stream's messages.
//! The page decodes the pictures.

use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use js_sys::{Function, Uint8Array};
use wasm_bindgen::prelude::*;
use yoro_media::video::{Index, Rgbd, VideoError};
use yoro_stream::{Content, EyeView, FrameHeader, FromServer};

/// An RGBD video file.
#[wasm_bindgen]
pub struct Video {
    index: Index,
    rgbd: Rgbd,
    header: FrameHeader,
}

/// A file whose parts JavaScript reads.
struct Pieces<'a> {
    read: &'a Function,
    position: u64,
    length: u64,
}

impl Read for Pieces<'_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let size = (to.len() as u64).min(self.length.saturating_sub(self.position));
        let piece = self.read.call2(&JsValue::NULL, &(self.position as f64).into(), &(size as f64).into());
        let piece = piece.map_err(|_| io::Error::other("the browser does not read it"))?;
        Uint8Array::new(&piece).copy_to(&mut to[..size as usize]);
        self.position += size;
        Ok(size as usize)
    }
}

impl Seek for Pieces<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let SeekFrom::Start(position) = to else { return Err(io::ErrorKind::Unsupported.into()) };
        self.position = position;
        Ok(position)
    }
}

#[wasm_bindgen]
impl Video {
    /// Reads the index of a file with this name and length in bytes. `read` returns a part of the file as a
    /// `Uint8Array`, given its offset and length in bytes.
    ///
    /// # Errors
    /// A sentence, if it is not an MP4 file, is damaged, or has no H.264 video or no depth.
    #[wasm_bindgen(constructor)]
    pub fn new(name: &str, length: f64, read: &Function) -> Result<Video, JsError> {
        let length = length as u64;
        let mut file = Pieces { read, position: 0, length };
        let index = Index::read(Path::new(name), &mut file, length).map_err(sentence)?;
        let rgbd = index.rgbd().map_err(sentence)?;
        let source = rgbd
            .views()
            .map_err(|error| JsError::new(&format!("The video cannot be shown: {error}.")))?
            .source;
        let view = EyeView { pose: source.pose, frustum: source.frustum };
        let header = FrameHeader {
            time_ms: 0.0,
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

    /// Returns the codec's name in the form that the browser's decoder takes.
    pub fn codec(&self) -> Result<String, JsError> {
        self.index.codec().map_err(sentence)
    }

    /// Returns the decoder's configuration.
    pub fn description(&self) -> Result<Vec<u8>, JsError> {
        self.index.description().map_err(sentence)
    }

    /// Returns six numbers for each picture, in decoding order: offset and length in bytes, 1 for an intra frame, decoding
    /// time and duration in seconds, and its number in the order in which pictures are shown.
    pub fn pictures(&self) -> Vec<f64> {
        let numbers = self.index.pictures.iter().map(|encoded| {
            [
                encoded.offset as f64,
                encoded.size as f64,
                f64::from(u8::from(encoded.intra)),
                encoded.time,
                encoded.duration,
                encoded.shown as f64,
            ]
        });
        numbers.flatten().collect()
    }

    /// Returns the first message of a stream.
    pub fn welcome(&self) -> Vec<u8> {
        FromServer::Video(self.rgbd.pair().frusta, self.rgbd.eye).to_bytes()
    }

    /// Returns the bytes that precede a frame's picture in a stream.
    pub fn head(&self, number: u32) -> Vec<u8> {
        FromServer::Frame { number, intra: false, header: self.header, data: &[] }.to_bytes()
    }
}

fn sentence(error: VideoError) -> JsError {
    JsError::new(&format!("{error}."))
}
