//! `yoro compare`: the similarity of two images, or of the images of two folders.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use indicatif::ProgressBar;
use serde::Serialize;

use yoro_files::{self as files, FileError, interrupt};
use yoro_metrics::{Comparison, PartQuality, Psnr, Quality, error_map, holes_of_mask};

/// The files that are compared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inputs {
    /// The image to judge, or a folder of them.
    pub a: PathBuf,
    /// The reference, or a folder of references; pairs are files of the same relative path.
    pub b: PathBuf,
    /// A grey image that marks holes, or a folder of them; one image may serve a whole folder.
    pub mask: Option<PathBuf>,
    /// True if the mask is bright where there is a hole, and false if it is dark there.
    pub bright_holes: bool,
    /// The file for the error map, as PNG, or a folder if folders are compared.
    pub map: Option<PathBuf>,
}

/// An explanation of the figures for readers of the JSON.
const SETTINGS: [(&str, &str); 6] = [
    (
        "psnr",
        "dB, data range 255; null where both images are identical; rgb: the error over all three channels",
    ),
    (
        "ssim_gaussian",
        "gaussian window 11x11, sigma 1.5, population covariance (Wang et al. 2004), mean without a border of 5 pixels; rgb: mean of three channels",
    ),
    (
        "ssim_uniform",
        "uniform window 7x7, sample covariance (scikit-image's default), mean without a border of 3 pixels; rgb: mean of three channels",
    ),
    (
        "flip",
        "LDR-FLIP (Andersson et al. 2020) at 67.02 pixels per degree, mean over the image, 0 (equal) to 1",
    ),
    ("luma", "ITU-R BT.601, not rounded"),
    ("mean", "mean over the pairs; identical pairs are left out of the mean PSNR"),
];

/// The results of a comparison.
#[derive(Debug, Serialize)]
pub struct CompareReport {
    settings: BTreeMap<&'static str, &'static str>,
    /// The pairs, sorted by name.
    pub pairs: Vec<Pair>,
    /// Means over the pairs.
    pub mean: Mean,
    /// Files in one folder that the other lacks.
    pub unmatched: Vec<PathBuf>,
}

/// Two images and their similarity.
#[derive(Debug, Serialize)]
pub struct Pair {
    /// The path inside the folders, or the first image.
    pub name: PathBuf,
    /// The similarity of the two images.
    #[serde(flatten)]
    pub comparison: Comparison,
}

/// Means over all pairs.
#[derive(Debug, Serialize)]
pub struct Mean {
    /// The similarity of red, green and blue.
    pub rgb: Quality,
    /// The similarity of luma.
    pub luma: Quality,
    /// LDR-FLIP.
    pub flip: f64,
    /// The number of pairs without any difference, which count in the mean SSIM but not in the mean PSNR.
    pub identical_pairs: usize,
}

/// The files of a pair, named by the path inside the folders or the first image.
struct PairFiles {
    name: PathBuf,
    a: PathBuf,
    b: PathBuf,
    mask: Option<PathBuf>,
    map: Option<PathBuf>,
}

impl Inputs {
    /// Returns the files of each pair, sorted by name, and the files in one folder that the other lacks.
    ///
    /// # Errors
    /// One with the remedy if there is no pair.
    fn pairs(&self) -> anyhow::Result<(Vec<PairFiles>, Vec<PathBuf>)> {
        let Inputs { a, b, .. } = self;
        for path in [a, b] {
            if !path.exists() {
                return Err(FileError::Missing(path.clone()).into());
            }
        }
        match (a.is_dir(), b.is_dir()) {
            (false, false) => {
                let (a, b, mask, map) = (a.clone(), b.clone(), self.mask.clone(), self.map.clone());
                Ok((vec![PairFiles { name: a.clone(), a, b, mask, map }], Vec::new()))
            }
            (true, true) => self.pairs_of_folders(),
            (a_is_folder, _) => {
                let (folder, file) = if a_is_folder { (a, b) } else { (b, a) };
                let (folder, file) = (folder.display(), file.display());
                bail!("{folder} is a folder and {file} is a file: give two files or two folders")
            }
        }
    }

    fn pairs_of_folders(&self) -> anyhow::Result<(Vec<PairFiles>, Vec<PathBuf>)> {
        let a = files::find(&self.a, &yoro_media::EXTENSIONS)?;
        let b = files::find(&self.b, &yoro_media::EXTENSIONS)?;
        let (names, only_a): (Vec<_>, Vec<_>) = a.into_iter().partition(|name| b.binary_search(name).is_ok());
        if names.is_empty() {
            bail!(
                "{} and {} have no images of the same name: pairs are files of the same relative path",
                self.a.display(),
                self.b.display()
            );
        }
        let only_b = b.into_iter().filter(|name| names.binary_search(name).is_err());
        let unmatched = only_a.into_iter().map(|name| self.a.join(name));
        let unmatched = unmatched.chain(only_b.map(|name| self.b.join(name))).collect();
        // One mask may serve a whole folder.
        let mask = |name: &Path| {
            self.mask.as_ref().map(|mask| if mask.is_dir() { mask.join(name) } else { mask.clone() })
        };
        let map = |name: &Path| self.map.as_ref().map(|map| map.join(name).with_extension("png"));
        let pair = |name: PathBuf| PairFiles {
            a: self.a.join(&name),
            b: self.b.join(&name),
            mask: mask(&name),
            map: map(&name),
            name,
        };
        Ok((names.into_iter().map(pair).collect(), unmatched))
    }
}

impl CompareReport {
    /// Compares two images, or each pair of two folders, and writes error maps if requested.
    pub fn of(inputs: &Inputs) -> anyhow::Result<CompareReport> {
        let (files, unmatched) = inputs.pairs()?;
        let bar = ProgressBar::new(files.len() as u64);
        let mut pairs = Vec::with_capacity(files.len());
        for files in files {
            interrupt::check()?;
            pairs.push(compare_pair(files, inputs.bright_holes)?);
            bar.inc(1);
        }
        bar.finish_and_clear();
        let mean_of = |which: fn(&Comparison) -> &Quality| {
            Quality::mean(pairs.iter().map(|pair| which(&pair.comparison))).expect("there is a pair")
        };
        let mean = Mean {
            rgb: mean_of(|comparison| &comparison.rgb),
            luma: mean_of(|comparison| &comparison.luma),
            flip: pairs.iter().map(|pair| pair.comparison.flip).sum::<f64>() / pairs.len() as f64,
            identical_pairs: pairs.iter().filter(|pair| pair.comparison.identical).count(),
        };
        Ok(CompareReport { settings: SETTINGS.into(), pairs, mean, unmatched })
    }

    /// Returns a table for a terminal.
    pub fn to_text(&self) -> String {
        let names: Vec<String> = self.pairs.iter().map(|pair| pair.name.display().to_string()).collect();
        let mean_name = format!("mean of {}", self.pairs.len());
        let width = names.iter().chain([&mean_name]).map(|name| name.chars().count()).max().unwrap_or(0);
        let mut out = format!(
            "{:width$}   PSNR, dB        SSIM gaussian 11x11   SSIM uniform 7x7   FLIP\n{:width$}   RGB    luma     RGB      luma         RGB\n",
            "", ""
        );
        let mut row = |name: &str, rgb: &Quality, luma: &Quality, flip: f64| {
            let _ = writeln!(
                out,
                "{name:width$}   {:<6} {:<8} {:<8.5} {:<12.5} {:<18.5} {flip:.5}",
                rgb.psnr, luma.psnr, rgb.ssim_gaussian, luma.ssim_gaussian, rgb.ssim_uniform
            );
        };
        for (name, pair) in names.iter().zip(&self.pairs) {
            row(name, &pair.comparison.rgb, &pair.comparison.luma, pair.comparison.flip);
        }
        if self.pairs.len() > 1 {
            row(&mean_name, &self.mean.rgb, &self.mean.luma, self.mean.flip);
        }
        for (what, part) in [
            ("in holes", (|c| c.holes) as fn(&Comparison) -> Option<PartQuality>),
            ("elsewhere", |c| c.elsewhere),
        ] {
            let parts: Vec<PartQuality> =
                self.pairs.iter().filter_map(|pair| part(&pair.comparison)).collect();
            if !parts.is_empty() {
                out += &part_line(what, &parts);
            }
        }
        match self.mean.identical_pairs {
            0 => {}
            1 if self.pairs.len() == 1 => out += "The images are identical.\n",
            n => {
                let _ = writeln!(
                    out,
                    "{n} of {} pairs are identical and not in the mean PSNR.",
                    self.pairs.len()
                );
            }
        }
        out
    }
}

fn compare_pair(files: PairFiles, bright_holes: bool) -> anyhow::Result<Pair> {
    let both = || format!("cannot compare {} with {}", files.a.display(), files.b.display());
    let (a, b) = (yoro_media::load_color(&files.a)?, yoro_media::load_color(&files.b)?);
    let mask = files.mask.as_deref().map(yoro_media::load_mask).transpose()?;
    let holes = mask.map(|mask| holes_of_mask(&mask, !bright_holes));
    let comparison = Comparison::of(&a, &b, holes.as_deref()).with_context(both)?;
    if let Some(map) = &files.map {
        yoro_media::save_color(map, &error_map(&a, &b).with_context(both)?)?;
    }
    Ok(Pair { name: files.name, comparison })
}

/// Returns a line with the means over the pairs that have such pixels.
fn part_line(what: &str, parts: &[PartQuality]) -> String {
    let share = 100.0 * parts.iter().map(|part| part.share).sum::<f64>() / parts.len() as f64;
    let psnr: Vec<Psnr> = parts.iter().filter_map(|part| part.psnr).collect();
    let ssim: Vec<f64> = parts.iter().filter_map(|part| part.ssim_gaussian).collect();
    let mut line = format!("{what} ({share:.2} % of the pixels): ");
    if psnr.is_empty() {
        line += "none";
    } else {
        let _ = write!(line, "PSNR RGB {}", Psnr::mean(psnr));
    }
    if !ssim.is_empty() {
        let _ = write!(line, ", SSIM gaussian RGB {:.5}", ssim.iter().sum::<f64>() / ssim.len() as f64);
    }
    line + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a picture that differs for every seed.
    fn image(width: u32, height: u32, seed: u32) -> image::RgbImage {
        image::RgbImage::from_fn(width, height, |x, y| {
            image::Rgb([x * 5 + y, y * 7 + x * y / 3, x * y + 90 * seed].map(|value| value as u8))
        })
    }

    fn inputs(a: &Path, b: &Path) -> Inputs {
        Inputs { a: a.into(), b: b.into(), mask: None, bright_holes: false, map: None }
    }

    /// Creates two folders with `same.png` and `sub/other.png` in both, and one more file in each.
    fn folders() -> (tempfile::TempDir, PathBuf, PathBuf) {
        let dir = tempfile::tempdir().unwrap();
        let (a, b) = (dir.path().join("a"), dir.path().join("b"));
        for (path, seed) in [
            (a.join("same.png"), 1),
            (b.join("same.png"), 1),
            (a.join("sub/other.png"), 1),
            (b.join("sub/other.png"), 2),
            (a.join("only-a.png"), 1),
            (b.join("sub/only-b.png"), 1),
        ] {
            yoro_media::save_color(&path, &image(32, 24, seed)).unwrap();
        }
        (dir, a, b)
    }

    #[test]
    fn folders_are_paired_by_relative_path() {
        let (dir, a, b) = folders();
        let maps = dir.path().join("maps");
        let report = CompareReport::of(&Inputs { map: Some(maps.clone()), ..inputs(&a, &b) }).unwrap();
        assert_eq!(report.unmatched, [a.join("only-a.png"), b.join("sub/only-b.png")]);
        assert_eq!(report.pairs.len(), 2);
        assert!(report.pairs[0].comparison.identical && !report.pairs[1].comparison.identical);
        assert_eq!(report.mean.identical_pairs, 1);
        assert_eq!(report.mean.rgb.psnr, report.pairs[1].comparison.rgb.psnr);
        assert_eq!(report.mean.rgb.ssim_gaussian, (1.0 + report.pairs[1].comparison.rgb.ssim_gaussian) / 2.0);
        assert_eq!(yoro_media::load_color(&maps.join("sub/other.png")).unwrap().dimensions(), (32, 24));

        let text = report.to_text();
        assert!(
            text.contains("mean of 2") && text.contains("sub/other.png") && text.contains("inf"),
            "{text}"
        );
        let json: serde_json::Value = serde_json::to_value(&report).unwrap();
        assert!(json["pairs"][0]["rgb"]["psnr"].is_null() && json["pairs"][0]["identical"] == true);
        assert!(json["mean"]["rgb"]["psnr"].is_f64());
    }

    #[test]
    fn two_files_with_a_mask() {
        let (dir, a, b) = folders();
        let mask = dir.path().join("mask.png");
        yoro_media::save_gray(
            &mask,
            &image::GrayImage::from_fn(32, 24, |x, _| image::Luma([if x < 8 { 0 } else { 255 }])),
        )
        .unwrap();
        let (a, b) = (a.join("sub/other.png"), b.join("sub/other.png"));
        let masked = Inputs { mask: Some(mask), ..inputs(&a, &b) };
        let report = CompareReport::of(&masked).unwrap();
        assert_eq!(report.pairs[0].comparison.holes.unwrap().share, 0.25);
        assert!(report.to_text().contains("in holes (25.00 % of the pixels): PSNR RGB"));
        let swapped = CompareReport::of(&Inputs { bright_holes: true, ..masked }).unwrap();
        assert_eq!(swapped.pairs[0].comparison.elsewhere, report.pairs[0].comparison.holes);
    }

    #[test]
    fn each_mistake_is_one_sentence() {
        let (dir, a, b) = folders();
        let says = |a: &Path, b: &Path| format!("{:#}", CompareReport::of(&inputs(a, b)).unwrap_err());
        assert!(says(&a, &b.join("same.png")).contains("give two files or two folders"));
        assert!(says(&a, &dir.path().join("none")).contains("none does not exist"));
        let empty = dir.path().join("empty");
        files::create_folder(&empty).unwrap();
        assert!(says(&a, &empty).contains("no images of the same name"));
        let other = dir.path().join("other.png");
        yoro_media::save_color(&other, &image(33, 24, 1)).unwrap();
        let error = says(&other, &a.join("same.png"));
        assert!(error.contains("other.png with") && error.contains("33x24 and 32x24"), "{error}");
        let tiny = dir.path().join("tiny.png");
        yoro_media::save_color(&tiny, &image(5, 5, 1)).unwrap();
        assert!(says(&tiny, &tiny).contains("at least 11x11"));
    }
}
