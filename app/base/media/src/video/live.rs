//! H.264 encoders for live streams.

use image::GrayImage;

use super::ffmpeg::{Ffmpeg, FfmpegEncoder};
use super::openh264::LiveOpenH264;
use super::{Planes, VideoError};

/// The encoder of a live stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LiveEncoderKind {
    /// The graphics card's encoder through ffmpeg, if it works; otherwise openh264.
    Auto,
    /// openh264, on one core.
    OpenH264,
    /// One of ffmpeg's encoders.
    Ffmpeg(FfmpegEncoder),
}

/// A picture of a live stream.
#[derive(Clone, Debug, PartialEq)]
pub struct LivePicture {
    /// The picture in the format of Annex B.
    pub data: Vec<u8>,
    /// True if it is an intra frame.
    pub is_intra: bool,
    /// The quantizer that it was encoded with.
    pub quantizer: u8,
}

/// An H.264 encoder whose quantizer and size may change from picture to picture.
pub enum LiveEncoder {
    /// openh264.
    OpenH264(Box<LiveOpenH264>),
    /// An ffmpeg process, which is restarted for another size or quantizer.
    Ffmpeg(FfmpegEncoder, Option<Ffmpeg>),
}

impl LiveEncoder {
    /// Starts an encoder for at most `frame_rate` pictures per second.
    ///
    /// # Errors
    /// [`VideoError::Codec`] for an encoder that is missing or does not work.
    pub fn new(kind: LiveEncoderKind, frame_rate: f32) -> Result<LiveEncoder, VideoError> {
        let ffmpeg = |encoder| {
            // Whether a graphics card can encode is known only after a picture.
            let gray = Planes::of_gray(&GrayImage::new(256, 256));
            Ffmpeg::start(encoder, gray.size, 24)?.encode(&gray, true)?;
            Ok(LiveEncoder::Ffmpeg(encoder, None))
        };
        match kind {
            LiveEncoderKind::Auto => {
                let card = ffmpeg(FfmpegEncoder::Nvenc).or_else(|_: VideoError| ffmpeg(FfmpegEncoder::Vaapi));
                card.or_else(|_| LiveEncoder::new(LiveEncoderKind::OpenH264, frame_rate))
            }
            LiveEncoderKind::OpenH264 => Ok(LiveEncoder::OpenH264(Box::new(LiveOpenH264::new(frame_rate)?))),
            LiveEncoderKind::Ffmpeg(encoder) => ffmpeg(encoder),
        }
    }

    /// Returns the encoder's name.
    pub fn name(&self) -> &'static str {
        match self {
            LiveEncoder::OpenH264(_) => "openh264",
            LiveEncoder::Ffmpeg(encoder, _) => encoder.name(),
        }
    }

    /// True if the quantizer may be another one for each picture, without a new encoder.
    pub fn changes_freely(&self) -> bool {
        matches!(self, LiveEncoder::OpenH264(_))
    }

    /// Encodes the next picture with `quantizer` (QP, 0 to 51) or up to three steps coarser. It is an intra frame if
    /// `intra` is set, if its size has changed, or if the encoder had to be restarted.
    ///
    /// # Errors
    /// [`VideoError::Codec`] if the picture is too large or the encoder has ended.
    pub fn encode(
        &mut self,
        picture: &Planes,
        quantizer: u8,
        intra: bool,
    ) -> Result<LivePicture, VideoError> {
        match self {
            LiveEncoder::OpenH264(encoder) => encoder.encode(picture, quantizer, intra),
            LiveEncoder::Ffmpeg(encoder, running) => {
                let running = match running.take() {
                    Some(ffmpeg) if ffmpeg.suits(picture.size, quantizer) => running.insert(ffmpeg),
                    // It shall do for somewhat coarser and finer ones, too.
                    Some(_) => {
                        running.insert(Ffmpeg::start(*encoder, picture.size, (quantizer + 2).min(51))?)
                    }
                    None => running.insert(Ffmpeg::start(*encoder, picture.size, quantizer)?),
                };
                running.encode(picture, intra)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::video::Decoder;
    use crate::video::openh264::tests::psnr;
    use image::{Rgb, RgbImage};

    /// Checks bits, quality and intra frames while size and quantizer change.
    fn check_live_encoder(kind: LiveEncoderKind) {
        let picture = |size: u32, t: u32| {
            let noise = |x: u32, y: u32| ((x * 7 + t) ^ (y * 13)) as u8;
            Planes::of_rgb(&RgbImage::from_fn(size, size, |x, y| Rgb([noise(x, y), noise(y, x), 90])))
        };
        let (mut encoder, mut decoder) = (LiveEncoder::new(kind, 30.0).unwrap(), Decoder::new().unwrap());
        let mut run = |size, quantizer, intra| {
            let mut sums = (0, 0.0, false);
            for t in 0..4 {
                let planes = picture(size, t);
                let LivePicture { data, is_intra, .. } =
                    encoder.encode(&planes, quantizer, intra && t == 0).unwrap();
                let decoded = decoder.decode(&data).unwrap();
                assert_eq!(decoded.size, planes.size);
                sums.0 += data.len();
                sums.1 += psnr(&decoded.planes[0], &planes.planes[0]) / 4.0;
                // Each intra frame begins with the sequence's parameter set.
                assert_eq!(data[4] & 31 == 7, is_intra);
                sums.2 |= is_intra;
            }
            sums
        };
        let (fine, coarse, again) = (run(64, 16, false), run(64, 40, false), run(64, 16, false));
        assert!(fine.0 > 2 * coarse.0 && again.0 > 2 * coarse.0, "{fine:?} {coarse:?} {again:?}");
        assert!(fine.1 > coarse.1 + 6.0 && again.1 > coarse.1 + 6.0, "{fine:?} {coarse:?} {again:?}");
        let restarted = kind != LiveEncoderKind::OpenH264;
        assert_eq!(
            [fine.2, coarse.2, again.2],
            [true, restarted, restarted],
            "intra frames by new quantizers"
        );
        assert!(run(64, 16, true).2 && run(48, 16, false).2);
        assert!(!run(48, 16, false).2, "no intra frame that nobody asked for");
    }

    #[test]
    fn quantizer_and_size_change_while_it_runs() {
        check_live_encoder(LiveEncoderKind::OpenH264);
    }

    #[test]
    #[ignore = "needs an ffmpeg with libx264 in PATH"]
    fn quantizer_and_size_change_by_ffmpeg() {
        check_live_encoder(LiveEncoderKind::Ffmpeg(FfmpegEncoder::X264));
    }
}
