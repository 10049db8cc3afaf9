//! H.264 encoders and a decoder, by openh264.

use openh264::OpenH264API;
use openh264::encoder::{
    BitRate, Complexity, EncoderConfig, FrameRate, IntraFramePeriod, QpRange, RateControlMode, VuiConfig,
};
use openh264::formats::{YUVSlices, YUVSource};
use openh264_sys2::{ENCODER_OPTION_SVC_ENCODE_PARAM_EXT, SEncParamExt};

use super::{Planes, VideoError};

/// The finest quantizer of [`Encoder`]: below it, openh264 takes another one.
pub const FINEST_QUANTIZER: u8 = 12;
/// The longer and the shorter side of the largest picture that openh264 encodes, in pixels.
const LARGEST: [usize; 2] = [3840, 2160];

/// True if a picture of this size in pixels can be encoded.
pub fn fits(size: [usize; 2]) -> bool {
    size.iter().max() <= Some(&LARGEST[0]) && size.iter().min() <= Some(&LARGEST[1])
}

/// An H.264 encoder with a constant quantizer.
pub struct Encoder(openh264::encoder::Encoder);

impl Encoder {
    /// Starts with `quantizer` (QP, [`FINEST_QUANTIZER`] to 51), for `frame_rate` pictures/s. The first picture is an intra frame.
    ///
    /// # Errors
    /// [`VideoError::Codec`].
    pub fn new(quantizer: u8, frame_rate: f32) -> Result<Encoder, VideoError> {
        // A constant quality is wanted, so the quantizer is fixed and the bit rate follows. Of the encoder's modes,
        // this is the one that keeps the quantizer within its range and never skips a frame.
        let config = config(RateControlMode::Bufferbased, frame_rate).qp(QpRange::new(quantizer, quantizer));
        Ok(Encoder(start(config)?))
    }

    /// Makes the next picture an intra frame, at which players can start.
    pub fn force_intra_frame(&mut self) {
        self.0.force_intra_frame();
    }

    /// Encodes the next picture, in the format of Annex B.
    ///
    /// # Errors
    /// [`VideoError::Codec`] if the picture is too large, or of another size than the previous one.
    pub fn encode(&mut self, picture: &Planes) -> Result<Vec<u8>, VideoError> {
        encode(&mut self.0, picture)
    }
}

/// A picture of a live stream.
#[derive(Clone, Debug, PartialEq)]
pub struct LivePicture {
    /// The picture in the format of Annex B.
    pub data: Vec<u8>,
    /// True if it is an intra frame.
    pub is_intra: bool,
}

/// An H.264 encoder whose quantizer and size may change from picture to picture.
pub struct LiveEncoder {
    encoder: openh264::encoder::Encoder,
    quantizer: u8,
    size: [usize; 2],
}

impl LiveEncoder {
    /// Starts an encoder for at most `frame_rate` pictures per second.
    ///
    /// # Errors
    /// [`VideoError::Codec`].
    pub fn new(frame_rate: f32) -> Result<LiveEncoder, VideoError> {
        let encoder = start(config(RateControlMode::Off, frame_rate))?;
        Ok(LiveEncoder { encoder, quantizer: 0, size: [0, 0] })
    }

    /// Encodes the next picture with `quantizer` (QP, 0 to 51); an intra frame if `intra` is set or its size has changed.
    ///
    /// # Errors
    /// [`VideoError::Codec`] if the picture is too large.
    pub fn encode(
        &mut self,
        picture: &Planes,
        quantizer: u8,
        intra: bool,
    ) -> Result<LivePicture, VideoError> {
        let resized = self.size != picture.size;
        if resized {
            // The quantizer can be set only once the encoder has a size, which it gets from the first picture.
            encode(&mut self.encoder, picture)?;
        }
        if resized || self.quantizer != quantizer {
            self.set_quantizer(quantizer)?;
        }
        if resized || intra {
            self.encoder.force_intra_frame();
        }
        (self.size, self.quantizer) = (picture.size, quantizer);
        Ok(LivePicture { data: encode(&mut self.encoder, picture)?, is_intra: resized || intra })
    }

    fn set_quantizer(&mut self, quantizer: u8) -> Result<(), VideoError> {
        let mut parameters = SEncParamExt::default();
        let pointer = &raw mut parameters;
        // SAFETY: the encoder has been initialized by a picture. This option reads and writes one `SEncParamExt`, of
        // which only the layer's quantizer is changed, and no other part of the wrapper relies on that.
        let failed = unsafe {
            let api = self.encoder.raw_api();
            let got = api.get_option(ENCODER_OPTION_SVC_ENCODE_PARAM_EXT, pointer.cast());
            (*pointer).sSpatialLayers[0].iDLayerQp = quantizer.into();
            got != 0 || api.set_option(ENCODER_OPTION_SVC_ENCODE_PARAM_EXT, pointer.cast()) != 0
        };
        if failed { Err(VideoError::Codec("the encoder refuses a quantizer".into())) } else { Ok(()) }
    }
}

fn config(mode: RateControlMode, frame_rate: f32) -> EncoderConfig {
    // One thread, so that repeated runs give the same bytes.
    EncoderConfig::new()
        .rate_control_mode(mode)
        .bitrate(BitRate::from_bps(100_000_000))
        .max_frame_rate(FrameRate::from_hz(frame_rate))
        .intra_frame_period(IntraFramePeriod::auto())
        .complexity(Complexity::Medium)
        .skip_frames(false)
        .scene_change_detect(false)
        .adaptive_quantization(false)
        .background_detection(false)
        .num_threads(1)
        .vui(VuiConfig::bt601().full_range(true))
}

fn start(config: EncoderConfig) -> Result<openh264::encoder::Encoder, VideoError> {
    let encoder = openh264::encoder::Encoder::with_api_config(OpenH264API::from_source(), config);
    encoder.map_err(|error| codec_error("the encoder does not start", &error))
}

fn encode(encoder: &mut openh264::encoder::Encoder, picture: &Planes) -> Result<Vec<u8>, VideoError> {
    let [w, h] = picture.size;
    if !fits(picture.size) {
        let [longer, shorter] = LARGEST;
        return Err(VideoError::Codec(format!(
            "{w}x{h} pixels are more than the {longer}x{shorter} that are encoded"
        )));
    }
    let planes = (&picture.planes[0][..], &picture.planes[1][..], &picture.planes[2][..]);
    let slices = YUVSlices::new(planes, (w, h), (w, w / 2, w / 2));
    let bits = encoder
        .encode(&slices)
        .map_err(|error| codec_error(&format!("{w}x{h} pixels cannot be encoded"), &error))?;
    Ok(bits.to_vec())
}

/// An H.264 decoder.
pub struct Decoder(openh264::decoder::Decoder);

impl Decoder {
    /// Starts a decoder.
    ///
    /// # Errors
    /// [`VideoError::Codec`].
    pub fn new() -> Result<Decoder, VideoError> {
        let decoder = openh264::decoder::Decoder::new();
        Ok(Decoder(decoder.map_err(|error| codec_error("the decoder does not start", &error))?))
    }

    /// Decodes the next picture, in the format of Annex B.
    ///
    /// # Errors
    /// [`VideoError::Codec`] for damaged bytes, and for streams that openh264 does not read. B-frames come in decoding
    /// order.
    pub fn decode(&mut self, bytes: &[u8]) -> Result<Planes, VideoError> {
        let decoded = self.0.decode(bytes).map_err(|_| VideoError::Codec(UNDECODABLE.into()))?;
        let decoded = decoded.ok_or_else(|| VideoError::Codec("the decoder holds a picture back".into()))?;
        let (w, h) = decoded.dimensions();
        if w % 2 != 0 || h % 2 != 0 {
            return Err(VideoError::Codec(format!("{w}x{h} pixels are no even size")));
        }
        let (sy, su, sv) = decoded.strides();
        let plane = |data: &[u8], stride: usize, width: usize, height: usize| -> Vec<u8> {
            data.chunks(stride).take(height).flat_map(|row| &row[..width]).copied().collect()
        };
        Ok(Planes {
            size: [w, h],
            planes: [
                plane(decoded.y(), sy, w, h),
                plane(decoded.u(), su, w / 2, h / 2),
                plane(decoded.v(), sv, w / 2, h / 2),
            ],
        })
    }
}

/// The library says no more than numbers.
const UNDECODABLE: &str =
    "a picture is damaged, or is not progressive with 8 bits in 4:2:0, as all can be that are read";

fn codec_error(what: &str, error: &openh264::Error) -> VideoError {
    VideoError::Codec(format!("{what} ({error})"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{Rgb, RgbImage};

    fn psnr(a: &[u8], b: &[u8]) -> f64 {
        let error: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum();
        10.0 * (255.0f64.powi(2) * a.len() as f64 / error).log10()
    }

    #[test]
    fn every_plane_is_as_good_as_its_quantizer() {
        let frame = |t: u32| {
            RgbImage::from_fn(64, 48, |x, y| {
                let (u, v) = (f64::from(x + t) / 9.0, f64::from(y) / 7.0);
                Rgb([u.sin(), v.cos(), (u + v).sin()].map(|wave| (128.0 + 100.0 * wave) as u8))
            })
        };
        let (mut encoder, mut decoder) = (Encoder::new(20, 30.0).unwrap(), Decoder::new().unwrap());
        for t in 0..4 {
            let planes = Planes::of_rgb(&frame(t));
            let decoded = decoder.decode(&encoder.encode(&planes).unwrap()).unwrap();
            for (plane, (a, b)) in decoded.planes.iter().zip(&planes.planes).enumerate() {
                let psnr = psnr(a, b);
                // A quantizer step is 6.5, which gives 43 dB if errors are uniformly distributed over it.
                assert!(psnr > 40.0, "frame {t}, plane {plane}: {psnr:.1} dB");
            }
        }
    }

    #[test]
    fn finer_quantizers_cost_more_bits_look_better_and_are_deterministic() {
        let frames: Vec<RgbImage> = (0..3)
            .map(|t| {
                RgbImage::from_fn(64, 48, |x, y| {
                    Rgb([(x * 3 + t) as u8, (y * 5) as u8, ((x * y + t) % 256) as u8])
                })
            })
            .collect();
        let run = |quantizer: u8| {
            let (mut encoder, mut decoder) =
                (Encoder::new(quantizer, 30.0).unwrap(), Decoder::new().unwrap());
            let (mut bytes, mut quality) = (0, 0.0);
            for frame in &frames {
                let encoded = encoder.encode(&Planes::of_rgb(frame)).unwrap();
                let decoded = decoder.decode(&encoded).unwrap().rgb((64, 48));
                bytes += encoded.len();
                quality += psnr(&decoded, frame) / 3.0;
            }
            (bytes, quality)
        };
        let (fine, middle, coarse) = (run(20), run(32), run(44));
        assert!(fine.0 > middle.0 && middle.0 > coarse.0, "{fine:?} {middle:?} {coarse:?}");
        assert!(fine.1 > middle.1 && middle.1 > coarse.1, "{fine:?} {middle:?} {coarse:?}");
        assert_eq!(run(32), middle);
    }

    #[test]
    fn quantizer_and_size_change_while_it_runs() {
        let picture = |size: u32, t: u32| {
            let noise = |x: u32, y: u32| ((x * 7 + t) ^ (y * 13)) as u8;
            Planes::of_rgb(&RgbImage::from_fn(size, size, |x, y| Rgb([noise(x, y), noise(y, x), 90])))
        };
        let (mut encoder, mut decoder) = (LiveEncoder::new(30.0).unwrap(), Decoder::new().unwrap());
        let mut run = |size, quantizer, intra| {
            let mut sums = (0, 0.0, false);
            for t in 0..4 {
                let planes = picture(size, t);
                let LivePicture { data, is_intra } =
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
        assert_eq!([fine.2, coarse.2, again.2], [true, false, false], "intra frames by new quantizers");
        assert!(run(64, 16, true).2 && run(48, 16, false).2);
        assert!(!run(48, 16, false).2, "no intra frame that nobody asked for");
    }
}
