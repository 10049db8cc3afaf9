//! H.264: an encoder with the decoder at the other end.

use anyhow::{Context as _, ensure};
use openh264::OpenH264API;
use openh264::decoder::Decoder;
use openh264::encoder::{
    BitRate, Complexity, Encoder, EncoderConfig, FrameRate, IntraFramePeriod, QpRange, RateControlMode,
    VuiConfig,
};
use openh264::formats::{YUVSlices, YUVSource};

use super::yuv::Planes;

/// An H.264 encoder at one quantizer, and the decoder at the other end.
pub(super) struct Coder {
    encoder: Encoder,
    decoder: Decoder,
    pub bytes: usize,
}

impl Coder {
    pub fn new(quantizer: u8, frame_rate: f32) -> anyhow::Result<Coder> {
        // Quality is what is compared, so the quantizer is held and the rate is what comes of it: of the encoder's
        // modes this one moves the quantizer within its range only, and never skips a frame for it. One thread, so
        // that a repeated run gives the same bytes.
        let config = EncoderConfig::new()
            .rate_control_mode(RateControlMode::Bufferbased)
            .qp(QpRange::new(quantizer, quantizer))
            .bitrate(BitRate::from_bps(100_000_000))
            .max_frame_rate(FrameRate::from_hz(frame_rate))
            .intra_frame_period(IntraFramePeriod::auto())
            .complexity(Complexity::Medium)
            .skip_frames(false)
            .scene_change_detect(false)
            .adaptive_quantization(false)
            .background_detection(false)
            .num_threads(1)
            .vui(VuiConfig::bt601().full_range(true));
        Ok(Coder {
            encoder: Encoder::with_api_config(OpenH264API::from_source(), config)
                .context("the H.264 encoder does not start")?,
            decoder: Decoder::new().context("the H.264 decoder does not start")?,
            bytes: 0,
        })
    }

    /// Codes the next picture and returns it as decoded.
    pub fn code(&mut self, picture: &Planes) -> anyhow::Result<Planes> {
        let [w, h] = picture.size;
        let planes = (&picture.planes[0][..], &picture.planes[1][..], &picture.planes[2][..]);
        let slices = YUVSlices::new(planes, (w, h), (w, w / 2, w / 2));
        let bits =
            self.encoder.encode(&slices).with_context(|| format!("H.264 cannot code {w}x{h} pixels"))?;
        let bytes = bits.to_vec();
        self.bytes += bytes.len();
        let decoded = self.decoder.decode(&bytes).context("H.264 cannot be decoded again")?;
        let decoded = decoded.context("the H.264 decoder holds a picture back")?;
        ensure!(decoded.dimensions() == (w, h), "H.264 gave a picture of another size");
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::{Channels, psnr};
    use image::{Rgb, RgbImage};

    #[test]
    fn every_plane_is_as_good_as_its_quantizer() {
        let frame = |t: u32| {
            RgbImage::from_fn(64, 48, |x, y| {
                let (u, v) = (f64::from(x + t) / 9.0, f64::from(y) / 7.0);
                Rgb([u.sin(), v.cos(), (u + v).sin()].map(|wave| (128.0 + 100.0 * wave) as u8))
            })
        };
        let mut coder = Coder::new(20, 30.0).unwrap();
        for t in 0..4 {
            let planes = Planes::of_rgb(&frame(t));
            let decoded = coder.code(&planes).unwrap();
            for (plane, (a, b)) in decoded.planes.iter().zip(&planes.planes).enumerate() {
                let error: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum();
                let psnr = 10.0 * (255.0f64.powi(2) * a.len() as f64 / error).log10();
                // A step of the quantizer is 6.5: 43 dB where errors are spread evenly over it.
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
            let mut coder = Coder::new(quantizer, 30.0).unwrap();
            let mut error = 0.0;
            for frame in &frames {
                let decoded = coder.code(&Planes::of_rgb(frame)).unwrap().rgb((64, 48));
                error += psnr(&decoded, frame, Channels::Rgb).unwrap().0 / 3.0;
            }
            (coder.bytes, error)
        };
        let (fine, middle, coarse) = (run(20), run(32), run(44));
        assert!(fine.0 > middle.0 && middle.0 > coarse.0, "{fine:?} {middle:?} {coarse:?}");
        assert!(fine.1 > middle.1 && middle.1 > coarse.1, "{fine:?} {middle:?} {coarse:?}");
        assert_eq!(run(32), middle);
    }
}
