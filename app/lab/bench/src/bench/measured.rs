//! Conversion of a comparison's metrics into those of a measurement.

use super::record::{Measurement, metric};
use yoro_metrics::{Comparison, Flicker, PartQuality};

impl Measurement {
    pub(super) fn push_comparison(&mut self, comparison: &Comparison) {
        let Comparison { rgb, luma, .. } = comparison;
        self.push(metric::PSNR, rgb.psnr.0);
        self.push(metric::PSNR_LUMA, luma.psnr.0);
        self.push(metric::SSIM, rgb.ssim_gaussian);
        self.push(metric::SSIM_LUMA, luma.ssim_gaussian);
        self.push(metric::SSIM_UNIFORM, rgb.ssim_uniform);
        self.push(metric::FLIP, comparison.flip);
        if let Some(holes) = &comparison.holes {
            self.push(metric::HOLE_SHARE, holes.share);
            self.push_part([metric::HOLE_PSNR, metric::HOLE_SSIM, metric::HOLE_FLIP], holes);
        }
        if let Some(visible) = &comparison.elsewhere {
            self.push_part([metric::VISIBLE_PSNR, metric::VISIBLE_SSIM, metric::VISIBLE_FLIP], visible);
        }
    }

    fn push_part(&mut self, [psnr, ssim, flip]: [&str; 3], part: &PartQuality) {
        self.push(psnr, part.psnr.map_or(f64::NAN, |psnr| psnr.0));
        self.push(ssim, part.ssim_gaussian.unwrap_or(f64::NAN));
        self.push(flip, part.flip.unwrap_or(f64::NAN));
    }

    pub(super) fn push_flicker(&mut self, names: &[&str; 4], flicker: &Flicker) {
        let values = [Some(flicker.all), flicker.holes, flicker.edges, flicker.rest];
        for (name, value) in names.iter().zip(values) {
            self.push(*name, value.unwrap_or(f64::NAN));
        }
    }
}
