//! Why synthesis works, in four pictures of one frame.

use yoro::eyes::{DepthConvention, SynthesisViews};
use yoro::synthesis::SourceMapEntry;

/// A frame and everything that its synthesis used. Images have rows from the bottom.
pub struct Frame<'a> {
    /// The geometry of the frame.
    pub views: &'a SynthesisViews,
    /// The rendered view: RGBA, of the size of `views.source`.
    pub color: &'a [u8],
    /// The rendered view's window depth: 24 bits in red, green and blue, the most significant in red; of the same size.
    pub depth: &'a [u8],
    /// The synthesized eye: RGBA, of the size of `views.target`.
    pub made: &'a [u8],
    /// The synthesized eye's source map, of the same size.
    pub map: &'a [u32],
}

/// Four pictures of an eye's size: RGBA, rows from the top.
pub struct Explanation {
    /// The rendered eye.
    pub color: Vec<u8>,
    /// The rendered eye's depth; nearer is brighter.
    pub depth: Vec<u8>,
    /// The synthesized eye, coloured by how far pixels have moved, from blue to yellow; black where none landed.
    pub moved: Vec<u8>,
    /// The synthesized eye in grey, with the filled pixels in colour.
    pub filled: Vec<u8>,
    /// The largest distance in pixels that a pixel has moved, relative to infinitely far surfaces.
    pub farthest: f64,
    /// The share of filled pixels.
    pub holes: f64,
}

const LUMA: [f32; 3] = [0.299, 0.587, 0.114];
const STILL: [f32; 3] = [45.0, 90.0, 215.0];
const FAR: [f32; 3] = [255.0, 220.0, 60.0];

impl Frame<'_> {
    /// Returns the four pictures.
    pub fn explain(&self) -> Explanation {
        let SynthesisViews { source, dominant_crop: [left, bottom], warp, .. } = self.views;
        let [width, height] = self.views.target.size;
        let infinity = match warp.convention {
            DepthConvention::Standard => 1.0,
            DepthConvention::Reversed => 0.0,
        };
        let still = warp.law.displacement(infinity);
        // Pixels from the top, and their indices in the rendered and in the synthesized image.
        let pixels = || (0..height).rev().flat_map(|y| (0..width).map(move |x| (x, y)));
        let seen = |x: u32, y: u32| ((y + bottom) * source.size[0] + x + left) as usize;
        let there = |x: u32, y: u32| (y * width + x) as usize;

        let disparities: Vec<f32> = pixels()
            .map(|(x, y)| {
                let depth = &self.depth[4 * seen(x, y)..][..3];
                let window = depth.iter().fold(0u32, |sum, byte| sum << 8 | u32::from(*byte));
                let window = f64::from(window) / f64::from((1u32 << 24) - 1);
                (warp.law.displacement(window) - still).abs() as f32
            })
            .collect();
        let farthest = disparities.iter().copied().fold(f32::MIN_POSITIVE, f32::max);

        let mut out = Explanation {
            color: Vec::with_capacity(4 * disparities.len()),
            depth: disparities.iter().flat_map(|d| gray(255.0 * (d / farthest).sqrt())).collect(),
            moved: Vec::with_capacity(4 * disparities.len()),
            filled: Vec::with_capacity(4 * disparities.len()),
            farthest: f64::from(farthest),
            holes: 0.0,
        };
        let mut holes = 0u32;
        for (x, y) in pixels() {
            out.color.extend(&self.color[4 * seen(x, y)..][..3]);
            out.color.push(255);
            let made = &self.made[4 * there(x, y)..][..3];
            let luma: f32 = made.iter().zip(LUMA).map(|(value, part)| f32::from(*value) * part).sum();
            let entry = SourceMapEntry::decode(self.map[there(x, y)], x, warp);
            if entry.hole {
                holes += 1;
                out.moved.extend([0, 0, 0, 255]);
                out.filled.extend(made);
                out.filled.push(255);
            } else {
                let share = ((f64::from(entry.displacement) - still).abs() as f32 / farthest).min(1.0).sqrt();
                let shade = 0.25 + 0.75 * luma / 255.0;
                let tint = |i: usize| (shade * (STILL[i] + share * (FAR[i] - STILL[i]))) as u8;
                out.moved.extend([tint(0), tint(1), tint(2), 255]);
                out.filled.extend(gray(0.4 * luma));
            }
        }
        out.holes = f64::from(holes) / f64::from((width * height).max(1));
        out
    }
}

fn gray(value: f32) -> [u8; 4] {
    let value = value as u8;
    [value, value, value, 255]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use yoro::eyes::{EyeOptions, GuardBand, Pose};
    use yoro::synthesis::{SOURCE_MAP_FIXED, SOURCE_MAP_HOLE};

    #[test]
    fn a_row_is_explained() {
        let pair =
            EyeOptions { size: [8, 1], ..EyeOptions::default() }.pair(Pose::look_at(Vec3::ZERO, Vec3::NEG_Z));
        let views = pair.synthesis_views(GuardBand::None).unwrap();
        // A picture that is infinitely far except for one near pixel, and its other eye with one hole.
        let color: Vec<u8> = (0..8).flat_map(|x| [x * 10, 200, 7, 0]).collect();
        let depth: Vec<u8> =
            (0..8u8).flat_map(|x| if x == 2 { [0xc0, 0, 0, 0] } else { [0xff; 4] }).collect();
        let still = views.warp.law.displacement(1.0);
        let column = |x: u32| ((f64::from(x) - still) * f64::from(SOURCE_MAP_FIXED)).max(0.0) as u32;
        let map: Vec<u32> = (0..8).map(|x| column(x) | if x == 3 { SOURCE_MAP_HOLE } else { 0 }).collect();
        let frame = Frame { views: &views, color: &color, depth: &depth, made: &color, map: &map };
        let seen = frame.explain();
        assert_eq!((seen.color[0..4].to_vec(), seen.color[28]), (vec![0, 200, 7, 255], 70));
        let bright: Vec<u8> = seen.depth.iter().step_by(4).copied().collect();
        assert_eq!(bright, [0, 0, 255, 0, 0, 0, 0, 0]);
        let near = (views.warp.law.displacement(f64::from(0xc00000) / f64::from(0xffffff)) - still).abs();
        assert!((seen.farthest - near).abs() < 1e-4 * near, "{} is not {near}", seen.farthest);
        assert_eq!((seen.holes, &seen.moved[12..16]), (0.125, &[0, 0, 0, 255][..]));
        assert_eq!(seen.filled[12..16], [30, 200, 7, 255], "what is filled in keeps its colour");
        assert_eq!(seen.filled[16], seen.filled[17], "the rest is grey");
        assert!(seen.moved[18] > seen.moved[16], "what is far is blue");
    }
}
