//! The device's H.264 decoder, through AMediaCodec with buffers in memory.

use std::time::Duration;

use ndk::media::media_codec::{
    DequeuedInputBufferResult, DequeuedOutputBufferInfoResult, MediaCodec, MediaCodecDirection,
};
use ndk::media::media_format::MediaFormat;
use ndk::media_error::MediaError;

use crate::stream::Layout;

/// The longest wait for a decoder to accept the next frame.
const INPUT_TIMEOUT: Duration = Duration::from_millis(500);

/// A decoder of pictures of one size.
pub struct Decoder {
    codec: MediaCodec,
    size: [usize; 2],
    /// The layout of the decoded pictures.
    layout: Layout,
}

impl Decoder {
    /// Starts a decoder for pictures of this size in pixels, both even.
    ///
    /// # Errors
    /// The device's reason.
    pub fn new(size: [usize; 2]) -> Result<Decoder, String> {
        let mut format = MediaFormat::new();
        format.set_str("mime", "video/avc");
        for (key, value) in ["width", "height"].into_iter().zip(size) {
            format.set_i32(key, value as i32);
        }
        // The stream has no B-frames; from Android 11 on, decoders can be asked not to delay frames either.
        format.set_i32("low-latency", 1);
        let codec =
            MediaCodec::from_decoder_type("video/avc").ok_or("this device has no decoder of H.264.")?;
        codec.configure(&format, None, MediaCodecDirection::Decoder).map_err(failed)?;
        codec.start().map_err(failed)?;
        Ok(Decoder { codec, size, layout: Layout::default() })
    }

    /// Returns the size in pixels.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Passes a frame in the format of Annex B to the decoder.
    ///
    /// # Errors
    /// The device's reason, or that the decoder accepts no frame.
    pub fn decode(&self, number: u32, data: &[u8]) -> Result<(), String> {
        let DequeuedInputBufferResult::Buffer(mut buffer) =
            self.codec.dequeue_input_buffer(INPUT_TIMEOUT).map_err(failed)?
        else {
            return Err("the decoder stands still.".into());
        };
        let room =
            buffer.buffer_mut().get_mut(..data.len()).ok_or("a frame is larger than the decoder takes.")?;
        room.write_copy_of_slice(data);
        self.codec.queue_input_buffer(buffer, 0, data.len(), u64::from(number), 0).map_err(failed)
    }

    /// Copies the next decoded picture into three planes and returns its number; `None` if there is none yet.
    ///
    /// # Errors
    /// The device's reason, or an unknown format.
    pub fn next(&mut self, planes: &mut Vec<u8>) -> Result<Option<u32>, String> {
        loop {
            match self.codec.dequeue_output_buffer(Duration::ZERO).map_err(failed)? {
                DequeuedOutputBufferInfoResult::TryAgainLater => return Ok(None),
                DequeuedOutputBufferInfoResult::OutputBuffersChanged => {}
                // Arrives before the first picture.
                DequeuedOutputBufferInfoResult::OutputFormatChanged => {
                    let format = self.codec.output_format();
                    log::info!("stream: decoded as {format}");
                    let number =
                        |key| format.i32(key).and_then(|n| usize::try_from(n).ok()).unwrap_or_default();
                    let color = format.i32("color-format").unwrap_or_default();
                    self.layout = Layout { color, stride: number("stride"), rows: number("slice-height") };
                }
                DequeuedOutputBufferInfoResult::Buffer(buffer) => {
                    let start = usize::try_from(buffer.info().offset()).unwrap_or_default();
                    let bytes = buffer.buffer().get(start..).unwrap_or_default();
                    self.layout.pack(bytes, self.size, planes)?;
                    let number = buffer.info().presentation_time_us() as u32;
                    self.codec.release_output_buffer(buffer, false).map_err(failed)?;
                    return Ok(Some(number));
                }
            }
        }
    }
}

fn failed(error: MediaError) -> String {
    format!("the decoder reports {error}.")
}
