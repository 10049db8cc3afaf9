//! `yoro compare`: how alike two images, or the images of two folders, are.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use serde::Serialize;

use crate::files;
use crate::metrics::{Comparison, PartQuality, Psnr, Quality, error_map, holes_of_mask};
use crate::picture;

/// Compare two images, or two folders of images, by PSNR, SSIM and FLIP
#[derive(clap::Args, Clone, Debug)]
pub struct CompareArgs {
    /// The image to judge, or a folder of them
    pub a: PathBuf,
    /// The reference, or a folder of references; pairs are files of the same relative path
    pub b: PathBuf,
    /// Also measure inside and outside of holes: a grey image, dark where there is a hole; or a folder of them
    #[arg(long, value_name = "FILE|FOLDER")]
    pub mask: Option<PathBuf>,
    /// The mask is bright, not dark, where there is a hole
    #[arg(long, requires = "mask")]
    pub bright_holes: bool,
    /// Write the error map, 1 - SSIM from 0 (black) to 1 (pale yellow), as PNG; a folder when folders are compared
    #[arg(long, value_name = "FILE|FOLDER")]
    pub map: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// How the figures are made, for readers of the JSON.
const SETTINGS: Settings = Settings {
    psnr: "dB, data range 255; null where both images are identical; rgb: the error over all three channels",
    ssim_gaussian: "gaussian window 11x11, sigma 1.5, population covariance (Wang et al. 2004), mean without a border of 5 pixels; rgb: mean of three channels",
    ssim_uniform: "uniform window 7x7, sample covariance (scikit-image's default), mean without a border of 3 pixels; rgb: mean of three channels",
    flip: "LDR-FLIP (Andersson et al. 2020) at 67.02 pixels per degree, mean over the image, 0 (equal) to 1",
    luma: "ITU-R BT.601, not rounded",
    mean: "mean over the pairs; identical pairs are left out of the mean PSNR",
};

#[derive(Debug, Serialize)]
struct Settings {
    psnr: &'static str,
    ssim_gaussian: &'static str,
    ssim_uniform: &'static str,
    flip: &'static str,
    luma: &'static str,
    mean: &'static str,
}

/// What was measured.
#[derive(Debug, Serialize)]
pub struct CompareReport {
    settings: &'static Settings,
    /// Each pair, sorted by name.
    pub pairs: Vec<Pair>,
    /// Means over the pairs.
    pub mean: Mean,
    /// Files of one folder that the other lacks.
    pub unmatched: Vec<PathBuf>,
}

/// Two images and their likeness.
#[derive(Debug, Serialize)]
pub struct Pair {
    /// The path inside the folders, or the first image.
    pub name: PathBuf,
    /// The figures.
    #[serde(flatten)]
    pub comparison: Comparison,
}

/// Means over all pairs.
#[derive(Debug, Serialize)]
pub struct Mean {
    /// Of red, green and blue.
    pub rgb: Quality,
    /// Of luma.
    pub luma: Quality,
    /// LDR-FLIP.
    pub flip: f64,
    /// Pairs without any difference: in the mean SSIM, not in the mean PSNR.
    pub identical_pairs: usize,
}

/// Compares and prints; error maps are written if asked for.
pub fn run(args: &CompareArgs) -> anyhow::Result<()> {
    let report = compare(args)?;
    for path in &report.unmatched {
        log::warn!("{} has no partner and is left out", path.display());
    }
    let text = if args.json { serde_json::to_string_pretty(&report)? + "\n" } else { table(&report) };
    print!("{text}");
    Ok(())
}

/// Compares without printing.
pub fn compare(args: &CompareArgs) -> anyhow::Result<CompareReport> {
    for path in [&args.a, &args.b] {
        if !path.exists() {
            bail!("{} does not exist: check the path", path.display());
        }
    }
    let (pairs, unmatched) = match (args.a.is_dir(), args.b.is_dir()) {
        (false, false) => (vec![compare_pair(args, None)?], Vec::new()),
        (true, true) => compare_folders(args)?,
        (a_is_folder, _) => {
            let (folder, file) = if a_is_folder { (&args.a, &args.b) } else { (&args.b, &args.a) };
            bail!(
                "{} is a folder and {} is a file: give two files or two folders",
                folder.display(),
                file.display()
            );
        }
    };
    let mean_of = |which: fn(&Comparison) -> &Quality| {
        Quality::mean(pairs.iter().map(|pair| which(&pair.comparison))).context("there is nothing to compare")
    };
    let mean = Mean {
        rgb: mean_of(|comparison| &comparison.rgb)?,
        luma: mean_of(|comparison| &comparison.luma)?,
        flip: pairs.iter().map(|pair| pair.comparison.flip).sum::<f64>() / pairs.len() as f64,
        identical_pairs: pairs.iter().filter(|pair| pair.comparison.identical).count(),
    };
    Ok(CompareReport { settings: &SETTINGS, pairs, mean, unmatched })
}

fn compare_folders(args: &CompareArgs) -> anyhow::Result<(Vec<Pair>, Vec<PathBuf>)> {
    let a = files::find(&args.a, &picture::EXTENSIONS)?;
    let b = files::find(&args.b, &picture::EXTENSIONS)?;
    let (names, only_a): (Vec<_>, Vec<_>) = a.into_iter().partition(|name| b.binary_search(name).is_ok());
    if names.is_empty() {
        bail!(
            "{} and {} have no images of the same name: pairs are files of the same relative path",
            args.a.display(),
            args.b.display()
        );
    }
    let only_b = b.into_iter().filter(|name| names.binary_search(name).is_err());
    let unmatched = only_a.into_iter().map(|name| args.a.join(name));
    let unmatched = unmatched.chain(only_b.map(|name| args.b.join(name))).collect();
    let bar = indicatif::ProgressBar::new(names.len() as u64);
    let mut pairs = Vec::with_capacity(names.len());
    for name in names {
        pairs.push(compare_pair(args, Some(&name))?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok((pairs, unmatched))
}

/// Compares the two files, or those called `name` in the two folders.
fn compare_pair(args: &CompareArgs, name: Option<&Path>) -> anyhow::Result<Pair> {
    let of_pair = |path: &Path| match name {
        Some(name) => path.join(name),
        None => path.to_path_buf(),
    };
    let (path_a, path_b) = (of_pair(&args.a), of_pair(&args.b));
    let both = || format!("cannot compare {} with {}", path_a.display(), path_b.display());
    let (a, b) = (picture::load_color(&path_a)?, picture::load_color(&path_b)?);
    let holes = match &args.mask {
        // One mask may serve a whole folder.
        Some(mask) => {
            let path = if mask.is_dir() { of_pair(mask) } else { mask.clone() };
            Some(holes_of_mask(&picture::load_mask(&path)?, !args.bright_holes))
        }
        None => None,
    };
    let comparison = Comparison::of(&a, &b, holes.as_deref()).with_context(both)?;
    if let Some(map) = &args.map {
        let path = if name.is_some() { of_pair(map).with_extension("png") } else { map.clone() };
        picture::save_color(&path, &error_map(&a, &b).with_context(both)?)?;
    }
    Ok(Pair { name: name.map_or(path_a, Path::to_path_buf), comparison })
}

fn table(report: &CompareReport) -> String {
    let names: Vec<String> = report.pairs.iter().map(|pair| pair.name.display().to_string()).collect();
    let mean_name = format!("mean of {}", report.pairs.len());
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
    for (name, pair) in names.iter().zip(&report.pairs) {
        row(name, &pair.comparison.rgb, &pair.comparison.luma, pair.comparison.flip);
    }
    if report.pairs.len() > 1 {
        row(&mean_name, &report.mean.rgb, &report.mean.luma, report.mean.flip);
    }
    for (what, part) in [
        ("in holes", (|c| c.holes) as fn(&Comparison) -> Option<PartQuality>),
        ("elsewhere", |c| c.elsewhere),
    ] {
        let parts: Vec<PartQuality> = report.pairs.iter().filter_map(|pair| part(&pair.comparison)).collect();
        if !parts.is_empty() {
            out += &part_line(what, &parts);
        }
    }
    match report.mean.identical_pairs {
        0 => {}
        1 if report.pairs.len() == 1 => out += "The images are identical.\n",
        n => {
            let _ =
                writeln!(out, "{n} of {} pairs are identical and not in the mean PSNR.", report.pairs.len());
        }
    }
    out
}

/// The mean over the pairs that have such pixels.
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
    use crate::metrics::tests::image;

    #[derive(clap::Parser)]
    struct Cli {
        #[command(flatten)]
        args: CompareArgs,
    }

    fn args(words: &[&Path]) -> CompareArgs {
        use clap::Parser as _;
        let words = [Path::new("compare")].into_iter().chain(words.iter().copied());
        Cli::try_parse_from(words.map(|word| word.as_os_str())).unwrap().args
    }

    /// Two folders: `same.png` and `sub/other.png` in both, one file more in each.
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
            picture::save_color(&path, &image(32, 24, seed)).unwrap();
        }
        (dir, a, b)
    }

    #[test]
    fn folders_are_paired_by_relative_path() {
        let (dir, a, b) = folders();
        let maps = dir.path().join("maps");
        let report = compare(&args(&[&a, &b, Path::new("--map"), &maps])).unwrap();
        assert_eq!(report.unmatched, [a.join("only-a.png"), b.join("sub/only-b.png")]);
        assert_eq!(report.pairs.len(), 2);
        assert!(report.pairs[0].comparison.identical && !report.pairs[1].comparison.identical);
        assert_eq!(report.mean.identical_pairs, 1);
        assert_eq!(report.mean.rgb.psnr, report.pairs[1].comparison.rgb.psnr);
        assert_eq!(report.mean.rgb.ssim_gaussian, (1.0 + report.pairs[1].comparison.rgb.ssim_gaussian) / 2.0);
        assert_eq!(picture::load_color(&maps.join("sub/other.png")).unwrap().dimensions(), (32, 24));

        let text = table(&report);
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
        picture::save_gray(
            &mask,
            &image::GrayImage::from_fn(32, 24, |x, _| image::Luma([if x < 8 { 0 } else { 255 }])),
        )
        .unwrap();
        let (a, b) = (a.join("sub/other.png"), b.join("sub/other.png"));
        let report = compare(&args(&[&a, &b, Path::new("--mask"), &mask])).unwrap();
        assert_eq!(report.pairs[0].comparison.holes.unwrap().share, 0.25);
        assert!(table(&report).contains("in holes (25.00 % of the pixels): PSNR RGB"));
        let swapped =
            compare(&args(&[&a, &b, Path::new("--mask"), &mask, Path::new("--bright-holes")])).unwrap();
        assert_eq!(swapped.pairs[0].comparison.elsewhere, report.pairs[0].comparison.holes);
    }

    #[test]
    fn mistakes_get_a_sentence() {
        let (dir, a, b) = folders();
        let says = |words: &[&Path]| format!("{:#}", compare(&args(words)).unwrap_err());
        assert!(says(&[&a, &b.join("same.png")]).contains("give two files or two folders"));
        assert!(says(&[&a, &dir.path().join("none")]).contains("none does not exist"));
        let empty = dir.path().join("empty");
        files::create_folder(&empty).unwrap();
        assert!(says(&[&a, &empty]).contains("no images of the same name"));
        let other = dir.path().join("other.png");
        picture::save_color(&other, &image(33, 24, 1)).unwrap();
        let error = says(&[&other, &a.join("same.png")]);
        assert!(error.contains("other.png with") && error.contains("33x24 and 32x24"), "{error}");
        let tiny = dir.path().join("tiny.png");
        picture::save_color(&tiny, &image(5, 5, 1)).unwrap();
        assert!(says(&[&tiny, &tiny]).contains("at least 11x11"));
    }
}
