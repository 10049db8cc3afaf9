//! The suite `bandwidth`: the bit rate of sending two eyes as H.264.
//!
//! The paper sends "a four-channel buffer (one RGB image plus depth)" instead of six channels ("Immersive Content
//! Streaming") and compares bit rates alone. This suite also measures the receiver's eyes, so that rates can be
//! compared at equal quality:
//!
//! | stream | what is encoded | the other eye |
//! |---|---|---|
//! | [`STEREO_RGB`] | both eyes side by side | as decoded |
//! | [`RGB_DEPTH`] | the dominant eye with guard band; its depth as luma of a second stream | synthesized from both |
//! | [`RGB_DEPTH_PACKED`] | the same with depth beside the colour in one picture | likewise |
//! | [`MONO_RGB`] | the dominant eye alone | the same image: the baseline |
//!
//! Colour is 4:2:0, BT.601 in full range. Depth is 8 bits, uniform in 1/z between the nearest and the farthest distance
//! in the sequence (two numbers beside the stream), so that a step is the same disparity everywhere. Pictures are
//! encoded in their final form: anti-aliased and with transparent objects.

use std::collections::BTreeMap;
use std::rc::Rc;

use anyhow::Context as _;
use image::{GrayImage, Luma, Rgb, RgbImage};

use crate::dataset::{GroupOptions, GroupRenderer};
use crate::metrics::{Channels, MetricsError, SsimWindow, psnr, ssim};
use crate::picture::{self, DepthImage};
use yoro::eyes::{DepthConvention, EyePair, SynthesisViews};
use yoro::synthesis::Edges;
use yoro_gl::Context;
use yoro_media::video::{Decoder, Encoder, Planes, VideoError};
use yoro_render::PreparedScene;
use yoro_render::stereo::{Offline, StereoOptions};

/// Both eyes, side by side.
pub const STEREO_RGB: &str = "stereo-rgb";
/// The dominant eye and its depth, in two streams.
pub const RGB_DEPTH: &str = "rgb-depth";
/// The dominant eye and its depth, side by side.
pub const RGB_DEPTH_PACKED: &str = "rgb-depth-packed";
/// The dominant eye, shown to both eyes.
pub const MONO_RGB: &str = "mono-rgb";

/// Names of the metrics. Each has one value for each quantizer: the mean over the frames.
pub mod metric {
    /// The quantizer (QP of H.264) of colour.
    pub const QP: &str = "qp";
    /// Bit rate in kbit/s (1000 bits) at [`super::FRAME_RATE`], including the first, intra frame.
    pub const KBIT_S: &str = "kbit_s";
    /// The part of the bit rate that a separate depth stream takes.
    pub const KBIT_S_DEPTH: &str = "kbit_s_depth";
    /// PSNR (RGB) of the dominant eye after decoding, in dB. Where colours are saturated and details fine, 4:2:0 limits
    /// it whatever the quantizer.
    pub const PSNR_DOMINANT: &str = "psnr_dominant";
    /// PSNR (RGB) of the other eye after decoding and, in streams with depth, synthesis, in dB.
    pub const PSNR_OTHER: &str = "psnr_other";
    /// PSNR of luma of the dominant eye, in dB: the usual measure of video encoding.
    pub const PSNR_LUMA_DOMINANT: &str = "psnr_luma_dominant";
    /// PSNR of luma of the other eye, in dB.
    pub const PSNR_LUMA_OTHER: &str = "psnr_luma_other";
    /// SSIM (gaussian, RGB) of the dominant eye, over every [`super::SSIM_EVERY`]th frame.
    pub const SSIM_DOMINANT: &str = "ssim_dominant";
    /// SSIM (gaussian, RGB) of the other eye, over the same frames.
    pub const SSIM_OTHER: &str = "ssim_other";
}

/// Frames per second.
pub const FRAME_RATE: f32 = 30.0;
/// SSIM is measured on every sixth frame only, because it takes ten times as long as PSNR.
pub const SSIM_EVERY: usize = 6;

/// The quantizers of an encoded sequence.
#[derive(Clone, Debug, PartialEq)]
pub struct BandwidthOptions {
    /// Quantizers of colour, 12 to 51; four or more for a rate-distortion curve.
    pub quantizers: Vec<u8>,
    /// Quantizer of the depth stream minus that of colour.
    pub depth_offset: i8,
}

impl Default for BandwidthOptions {
    fn default() -> BandwidthOptions {
        // Depth gets the quantizer of colour, as when both are in one picture.
        BandwidthOptions { quantizers: vec![20, 26, 32, 38, 44], depth_offset: 0 }
    }
}

/// Values by metric, as in a [measurement](super::Measurement).
pub type Values = BTreeMap<String, Vec<Option<f64>>>;

/// Renders a sequence, encodes and decodes it as every stream at every quantizer, and measures both eyes. `pairs` are
/// the eyes of consecutive frames. `step` is called after each frame of work; an error from it ends the run. Returns
/// the values by name of the stream.
///
/// # Errors
/// One sentence if the eyes cannot be synthesized, or GL or the encoder refuses.
pub fn run(
    gl: &Rc<Context>,
    prepared: &mut PreparedScene,
    pairs: &[EyePair],
    options: &BandwidthOptions,
    step: &mut dyn FnMut() -> anyhow::Result<()>,
) -> anyhow::Result<Vec<(&'static str, Values)>> {
    let sequence = Sequence::render(gl, prepared, pairs, step)?;
    let mut receiver = Offline::new(gl, &StereoOptions::default().synthesis, Edges::Hard)?;
    let mut streams: Vec<(&'static str, Values)> =
        [STEREO_RGB, RGB_DEPTH, RGB_DEPTH_PACKED, MONO_RGB].map(|name| (name, Values::new())).to_vec();
    for &quantizer in &options.quantizers {
        for layout in [Layout::Stereo, Layout::TwoStreams, Layout::Packed] {
            let encoded = sequence.encode(layout, quantizer, options.depth_offset, &mut receiver, step)?;
            for (name, stats) in encoded {
                let stream = streams.iter_mut().find(|(stream, _)| *stream == name);
                stats.push_into(&mut stream.context("every stream has its values")?.1, quantizer);
            }
        }
    }
    Ok(streams)
}

/// Returns the number of steps that [`run`] takes for a number of frames.
pub fn steps(frames: usize, options: &BandwidthOptions) -> u64 {
    (frames * (1 + 3 * options.quantizers.len())) as u64
}

/// The layout of a stream's pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layout {
    Stereo,
    TwoStreams,
    Packed,
}

/// An encoder with the decoder at the receiving end.
struct Codec {
    encoder: Encoder,
    decoder: Decoder,
    bytes: usize,
}

impl Codec {
    fn new(quantizer: u8) -> Result<Codec, VideoError> {
        Ok(Codec { encoder: Encoder::new(quantizer, FRAME_RATE)?, decoder: Decoder::new()?, bytes: 0 })
    }

    /// Encodes the next picture and returns it as decoded.
    fn encode(&mut self, picture: &Planes) -> Result<Planes, VideoError> {
        let encoded = self.encoder.encode(picture)?;
        self.bytes += encoded.len();
        self.decoder.decode(&encoded)
    }
}

/// A rendered sequence, ready to be encoded.
struct Sequence {
    frames: Vec<Frame>,
    /// The nearness (0 far plane, 1 near plane) of the smallest and of the largest depth sample.
    range: [f32; 2],
}

struct Frame {
    views: SynthesisViews,
    /// The dominant eye with its guard band.
    color: RgbImage,
    depth: GrayImage,
    /// Dominant and other eye, uncompressed.
    eyes: [RgbImage; 2],
}

impl Sequence {
    fn render(
        gl: &Rc<Context>,
        prepared: &mut PreparedScene,
        pairs: &[EyePair],
        step: &mut dyn FnMut() -> anyhow::Result<()>,
    ) -> anyhow::Result<Sequence> {
        let defaults = StereoOptions::default();
        let options = GroupOptions {
            synthesis: defaults.synthesis,
            guard_band: defaults.guard_band,
            anti_aliasing: true,
        };
        let mut renderer = GroupRenderer::new(gl, &options)?;
        let mut rendered = Vec::new();
        for pair in pairs {
            let group = renderer.render(&mut prepared.renderer, &prepared.scene, pair)?;
            let views = group.views;
            let dominant = crop(&group.color, views.dominant_crop, pair.size);
            let nearness = nearness(&group.depth, views.warp.convention);
            rendered.push((views, group.color, nearness, [dominant, group.truth]));
            step()?;
        }
        let all = rendered.iter().flat_map(|(_, _, nearness, _)| nearness.iter().copied());
        let range = all.fold([f32::INFINITY, f32::NEG_INFINITY], |[l, h], n| [l.min(n), h.max(n)]);
        let frame =
            |(views, color, nearness, eyes): (SynthesisViews, RgbImage, DepthImage, [RgbImage; 2])| {
                let depth = GrayImage::from_fn(nearness.width(), nearness.height(), |x, y| {
                    Luma([quantize(nearness.get_pixel(x, y).0[0], range)])
                });
                Frame { views, color, depth, eyes }
            };
        Ok(Sequence { frames: rendered.into_iter().map(frame).collect(), range })
    }

    /// Encodes and decodes all frames, and measures both eyes of each resulting stream.
    fn encode(
        &self,
        layout: Layout,
        quantizer: u8,
        depth_offset: i8,
        receiver: &mut Offline,
        step: &mut dyn FnMut() -> anyhow::Result<()>,
    ) -> anyhow::Result<Vec<(&'static str, StreamStats)>> {
        let depth_quantizer = quantizer.saturating_add_signed(depth_offset).min(51);
        let mut main = Codec::new(quantizer)?;
        let mut second = Codec::new(depth_quantizer)?;
        let names: &[&'static str] = match layout {
            Layout::Stereo => &[STEREO_RGB],
            Layout::TwoStreams => &[RGB_DEPTH, MONO_RGB],
            Layout::Packed => &[RGB_DEPTH_PACKED],
        };
        let mut stats: Vec<(&'static str, StreamStats)> =
            names.iter().map(|name| (*name, StreamStats::default())).collect();
        for (i, frame) in self.frames.iter().enumerate() {
            let ([width, height], crop_origin) = (frame.views.target.size, frame.views.dominant_crop);
            let color_size = frame.color.dimensions();
            let mut eyes = Vec::new();
            match layout {
                Layout::Stereo => {
                    let [left, right] = &frame.eyes;
                    let decoded = main.encode(&Planes::of_rgb(left).beside(&Planes::of_rgb(right)))?;
                    let [left, right] = decoded.halves();
                    eyes.push([left.rgb((width, height)), right.rgb((width, height))]);
                }
                Layout::TwoStreams => {
                    let color = main.encode(&Planes::of_rgb(&frame.color))?.rgb(color_size);
                    let depth = second.encode(&Planes::of_gray(&frame.depth))?.gray(color_size);
                    let synthesized = self.synthesize(&frame.views, &color, &depth, receiver)?;
                    let dominant = crop(&color, crop_origin, [width, height]);
                    eyes.push([dominant.clone(), synthesized]);
                    eyes.push([dominant.clone(), dominant]);
                }
                Layout::Packed => {
                    let planes = Planes::of_rgb(&frame.color).beside(&Planes::of_gray(&frame.depth));
                    let [color, depth] = main.encode(&planes)?.halves();
                    let (color, depth) = (color.rgb(color_size), depth.gray(color_size));
                    let synthesized = self.synthesize(&frame.views, &color, &depth, receiver)?;
                    eyes.push([crop(&color, crop_origin, [width, height]), synthesized]);
                }
            }
            for ((_, stats), eyes) in stats.iter_mut().zip(&eyes) {
                stats.measure(i, eyes, &frame.eyes)?;
            }
            step()?;
        }
        for (name, stats) in &mut stats {
            stats.bytes = main.bytes;
            if *name == RGB_DEPTH {
                stats.bytes += second.bytes;
                stats.depth_bytes = Some(second.bytes);
            }
        }
        Ok(stats)
    }

    /// Synthesizes the other eye from a decoded picture, as a receiver would.
    fn synthesize(
        &self,
        views: &SynthesisViews,
        color: &RgbImage,
        depth: &GrayImage,
        receiver: &mut Offline,
    ) -> anyhow::Result<RgbImage> {
        let width = color.width() as usize;
        let from_bottom = |y: u32| color.height() - 1 - y;
        let mut rgba = Vec::with_capacity(width * color.height() as usize * 4);
        let mut values = Vec::with_capacity(width * color.height() as usize);
        for y in (0..color.height()).map(from_bottom) {
            for x in 0..color.width() {
                let Rgb([r, g, b]) = *color.get_pixel(x, y);
                rgba.extend([r, g, b, 255]);
                let nearness = dequantize(depth.get_pixel(x, y).0[0], self.range);
                values.push(match views.warp.convention {
                    DepthConvention::Standard => 1.0 - nearness,
                    DepthConvention::Reversed => nearness,
                });
            }
        }
        let result = receiver.run(&rgba, &values, &views.warp)?;
        Ok(picture::rgb_image(&result.rgba, views.target.size))
    }
}

/// Returns the part of a source image that the dominant eye shows. `origin` counts rows from the bottom.
fn crop(image: &RgbImage, origin: [u32; 2], [width, height]: [u32; 2]) -> RgbImage {
    let top = image.height() - origin[1] - height;
    image::imageops::crop_imm(image, origin[0], top, width, height).to_image()
}

/// Returns nearness: 0 at the far plane, 1 at the near plane. It is affine in 1/z and therefore in disparity.
fn nearness(depth: &DepthImage, convention: DepthConvention) -> DepthImage {
    DepthImage::from_fn(depth.width(), depth.height(), |x, y| {
        let value = depth.get_pixel(x, y).0[0];
        Luma([match convention {
            DepthConvention::Standard => 1.0 - value,
            DepthConvention::Reversed => value,
        }])
    })
}

fn quantize(nearness: f32, [low, high]: [f32; 2]) -> u8 {
    let share = if high > low { (nearness - low) / (high - low) } else { 0.0 };
    (share * 255.0).round().clamp(0.0, 255.0) as u8
}

fn dequantize(sample: u8, [low, high]: [f32; 2]) -> f32 {
    low + (high - low) * f32::from(sample) / 255.0
}

/// Sums over the frames of a stream.
#[derive(Clone, Debug, Default)]
struct StreamStats {
    bytes: usize,
    depth_bytes: Option<usize>,
    frames: usize,
    /// Dominant and other eye: one value for each frame that differs from its reference.
    psnr: [Vec<f64>; 2],
    psnr_luma: [Vec<f64>; 2],
    ssim: [Vec<f64>; 2],
}

impl StreamStats {
    fn measure(
        &mut self,
        index: usize,
        eyes: &[RgbImage; 2],
        references: &[RgbImage; 2],
    ) -> anyhow::Result<()> {
        self.frames += 1;
        for (eye, (image, reference)) in eyes.iter().zip(references).enumerate() {
            let finite = |channels| {
                Ok::<_, MetricsError>(Some(psnr(image, reference, channels)?.0).filter(|v| v.is_finite()))
            };
            self.psnr[eye].extend(finite(Channels::Rgb)?);
            self.psnr_luma[eye].extend(finite(Channels::Luma)?);
            if index.is_multiple_of(SSIM_EVERY) {
                self.ssim[eye].push(ssim(image, reference, SsimWindow::Gaussian11, Channels::Rgb)?);
            }
        }
        Ok(())
    }

    fn push_into(&self, values: &mut Values, quantizer: u8) {
        let mean = |samples: &[f64]| {
            (!samples.is_empty()).then(|| samples.iter().sum::<f64>() / samples.len() as f64)
        };
        let kbit_s = |bytes: usize| {
            Some(bytes as f64 * 8e-3 * f64::from(FRAME_RATE) / self.frames as f64)
                .filter(|rate| rate.is_finite())
        };
        let mut push =
            |name: &str, value: Option<f64>| values.entry(name.to_owned()).or_default().push(value);
        push(metric::QP, Some(f64::from(quantizer)));
        push(metric::KBIT_S, kbit_s(self.bytes));
        if let Some(bytes) = self.depth_bytes {
            push(metric::KBIT_S_DEPTH, kbit_s(bytes));
        }
        push(metric::PSNR_DOMINANT, mean(&self.psnr[0]));
        push(metric::PSNR_OTHER, mean(&self.psnr[1]));
        push(metric::PSNR_LUMA_DOMINANT, mean(&self.psnr_luma[0]));
        push(metric::PSNR_LUMA_OTHER, mean(&self.psnr_luma[1]));
        push(metric::SSIM_DOMINANT, mean(&self.ssim[0]));
        push(metric::SSIM_OTHER, mean(&self.ssim[1]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_steps_are_even_and_the_range_is_exact() {
        let range = [0.01, 0.9];
        assert_eq!([0.01, 0.9].map(|n| quantize(n, range)), [0, 255]);
        for sample in 0..=255 {
            assert_eq!(quantize(dequantize(sample, range), range), sample);
        }
        assert_eq!(quantize(0.5, [0.5, 0.5]), 0);
        assert_eq!(dequantize(0, [0.5, 0.5]), 0.5);
    }
}
