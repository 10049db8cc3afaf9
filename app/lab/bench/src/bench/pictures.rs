//! The pictures of a run: the folders in which it saves them, and how the report shows them.

use std::path::{Path, PathBuf};

use image::RgbImage;

use super::record::Conditions;
use yoro::eyes::Eye;
use yoro_metrics::{Channels, MetricsError, Quality, error_map};
use yoro_report::text::slug;
use yoro_report::{OtherEye, Picture, Pictures};

/// Explains how quality is measured; printed wherever it is shown.
pub(super) const QUALITY_METHOD: &str = "PSNR in dB over red, green and blue, data range 255. SSIM as the mean of red, \
green and blue: gaussian window 11x11, sigma 1.5 (Wang et al. 2004), and uniform window 7x7 (scikit-image's \
default). The reference is the same eye, really rendered. Error maps show 1 - SSIM (gaussian) from 0, black, to \
1, pale yellow.";

/// Returns the folder for all pictures of a run, beside its file of `results`.
pub fn pictures_beside(results: &Path) -> PathBuf {
    results.with_extension("pictures")
}

/// Returns the folder for the pictures of a setting, beside the file `results`: `RUN.pictures/SUITE/SCENE`, with
/// `.LABEL` or `.POINT` appended. It contains `dominant.png`, `truth.png` and `CONTENDER.png`.
pub fn picture_folder(results: &Path, conditions: &Conditions) -> PathBuf {
    let mut name = slug(&conditions.scene);
    if let Some(label) = &conditions.label {
        name += &format!(".{}", slug(label));
    }
    if let Some(point) = conditions.point {
        name += &format!(".{point}");
    }
    pictures_beside(results).join(slug(&conditions.suite)).join(name)
}

/// The pictures of one pose, all of one size.
pub(super) struct Viewpoint {
    /// The eye that is rendered.
    pub dominant_eye: Eye,
    pub dominant: RgbImage,
    /// A real render of the other eye.
    pub truth: RgbImage,
    /// The other eye as each contender makes it, by its name.
    pub views: Vec<(String, RgbImage)>,
}

impl Viewpoint {
    /// Returns what the page shows in turn: the truth, each contender's eye, the same image, and the error maps of these.
    ///
    /// # Errors
    /// [`MetricsError`] if the pictures differ in size or are too small.
    pub fn shown(self, title: String, note: String) -> Result<Pictures, MetricsError> {
        let (dominant, other) = (self.dominant_eye.name(), self.dominant_eye.other().name());
        let picture = |label: String, caption: String, image: RgbImage, is_map: bool| Picture {
            label,
            caption,
            image,
            is_map,
        };
        let mut maps = Vec::new();
        let mut measured = |name: &str, image: &RgbImage| {
            let quality = Quality::of(image, &self.truth, Channels::Rgb)?;
            let figures = format!(
                "PSNR {} dB, SSIM {:.4} (uniform 7x7: {:.4}).",
                quality.psnr, quality.ssim_gaussian, quality.ssim_uniform
            );
            let caption = format!("1 - SSIM, black = 0, pale yellow = 1. {figures}");
            maps.push(picture(format!("error: {name}"), caption, error_map(image, &self.truth)?, true));
            Ok::<_, MetricsError>(figures)
        };
        let mut eyes = Vec::new();
        for (name, eye) in self.views {
            let figures = measured(&name, &eye)?;
            let caption = format!("The {other} eye, synthesized from the {dominant} one. {figures}");
            eyes.push(picture(name, caption, eye, false));
        }
        let figures = measured("same image", &self.dominant)?;
        let caption =
            format!("The {dominant} (dominant) eye's image, shown to both eyes: the baseline. {figures}");
        eyes.push(picture("same image".into(), caption, self.dominant, false));
        let other_eye = OtherEye { picture: eyes.len(), is_left: self.dominant_eye == Eye::Left };
        let caption = format!("The {other} eye, really rendered: the reference.");
        let truth = picture("really rendered".into(), caption, self.truth, false);
        let pictures = [truth].into_iter().chain(eyes).chain(maps).collect();
        Ok(Pictures { title, note, pictures, other_eye: Some(other_eye) })
    }
}
