//! `yoro synthesize` on pictures whose other eye is known exactly.

use std::fs;
use std::path::Path;

use image::RgbImage;
use yoro_metrics::{Channels, Psnr, psnr};

use crate::pair::{self, FOV_Y_DEGREES, IPD, RANGE};
use crate::program::{folder, run, succeed};

fn eyes() -> String {
    format!("--fov-y-degrees {FOV_Y_DEGREES} --ipd {IPD}")
}

/// Returns the PSNR in dB against an eye's true image. Disocclusions, a few percent here, can only be guessed.
fn quality(image: &RgbImage, eye: f32) -> f64 {
    let Psnr(db) = psnr(image, &pair::color(eye), Channels::Rgb).unwrap();
    db
}

fn load(path: &Path) -> RgbImage {
    yoro_media::load_color(path).unwrap()
}

/// Writes the right eye's colour, and its depth by each group of options. Returns the options that decode each.
fn write_encodings(dir: &Path) -> Vec<(&'static str, String)> {
    yoro_media::save_color(&dir.join("color.png"), &pair::color(0.5)).unwrap();
    let save = |name: &str, image| yoro_media::save_depth(&dir.join(name), &image).unwrap();
    save("metres.exr", pair::metres(0.5));
    save("gamma.png", pair::reversed(0.5, 2.5));
    pair::save_metres_16(&dir.join("metres.png"), 0.5);
    pair::save_disparity_8(&dir.join("disparity.png"), 0.5);
    let range = format!("--near {} --far {}", RANGE.near, RANGE.far);
    let disparity = format!("--depth-encoding disparity --disparity-scale {}", pair::DISPARITY_AT_WHITE);
    vec![
        ("metres.exr", "--depth-encoding metres".into()),
        ("gamma.png", format!("--depth-encoding reversed-z --depth-gamma 2.5 {range}")),
        ("metres.png", "--depth-encoding metres --metres-at-white 20".into()),
        ("disparity.png", disparity),
    ]
}

#[test]
fn every_depth_encoding_gives_the_same_eye() {
    let dir = tempfile::tempdir().unwrap();
    let encodings = write_encodings(dir.path());
    let mut first: Option<RgbImage> = None;
    for (depth, options) in encodings {
        let line = format!(
            "synthesize --color color.png --depth {depth} --out {depth}.out.png {options} {}",
            eyes()
        );
        let run = succeed(dir.path(), &line);
        assert_eq!(run.stdout, format!("{depth}.out.png\n"));
        let image = load(&dir.path().join(format!("{depth}.out.png")));
        let db = quality(&image, -0.5);
        assert!(db > 30.0, "{depth}: {db:.2} dB");
        assert!(
            db > quality(&pair::color(0.5), -0.5) + 10.0,
            "{depth}: {db:.2} dB is hardly better than no shift"
        );
        let first = first.get_or_insert_with(|| image.clone());
        // 16 bits are slightly coarser than float, which moves edges by less than 1/50 of a pixel.
        let Psnr(likeness) = psnr(&image, first, Channels::Rgb).unwrap();
        assert!(likeness > 45.0, "{depth} differs: {likeness:.2} dB");
    }
}

#[test]
fn every_pipeline_and_either_eye() {
    let dir = tempfile::tempdir().unwrap();
    for (dominant, source, target) in [("right", 0.5, -0.5), ("left", -0.5, 0.5)] {
        yoro_media::save_color(&dir.path().join("color.png"), &pair::color(source)).unwrap();
        yoro_media::save_depth(&dir.path().join("depth.exr"), &pair::metres(source)).unwrap();
        for pipeline in ["gather", "paper", "paper --imbuffer 2", "paper --strict", "gather --gl osmesa"] {
            if pipeline.ends_with("osmesa") && std::env::var_os("YORO_TEST_WITHOUT_OSMESA").is_some() {
                continue;
            }
            let line = format!(
                "synthesize --color color.png --depth depth.exr --depth-encoding metres --out out.png --dominant {dominant} --pipeline {pipeline} {}",
                eyes()
            );
            succeed(dir.path(), &line);
            let (db, unshifted) =
                (quality(&load(&dir.path().join("out.png")), target), quality(&pair::color(source), target));
            assert!(db > unshifted + 6.0, "{dominant}, {pipeline}: {db:.2} dB, unshifted {unshifted:.2} dB");
        }
    }
}

#[test]
fn both_eyes_from_a_centre_view_with_all_outputs() {
    let dir = tempfile::tempdir().unwrap();
    yoro_media::save_color(&dir.path().join("color.png"), &pair::color(0.0)).unwrap();
    yoro_media::save_depth(&dir.path().join("depth.exr"), &pair::metres(0.0)).unwrap();
    let line = format!(
        "synthesize --color color.png --depth depth.exr --depth-encoding metres --dominant center --out made/eye.png --mask-out made/mask.png --disparity-out made/disparity.exr --source-out made/source.exr {}",
        eyes()
    );
    succeed(dir.path(), &line);
    let made = dir.path().join("made");
    for (name, eye) in [("left", -0.5), ("right", 0.5)] {
        let image = load(&made.join(format!("eye.{name}.png")));
        let db = quality(&image, eye);
        assert!(db > 30.0, "{name}: {db:.2} dB");
        let mask = yoro_media::load_mask(&made.join(format!("mask.{name}.png"))).unwrap();
        let holes = mask.pixels().filter(|p| p.0[0] == 0).count();
        assert!((50..2000).contains(&holes), "{name}: {holes} holes");
        let disparity = yoro_media::load_depth(&made.join(format!("disparity.{name}.exr"))).unwrap().image;
        let largest = disparity.pixels().map(|p| p.0[0].abs()).fold(0.0, f32::max);
        let expected = 170.0 / 255.0 * pair::DISPARITY_AT_WHITE / 2.0;
        assert!((largest - expected).abs() < 0.05, "{name}: {largest} pixels, not {expected}");
        assert!(made.join(format!("source.{name}.exr")).exists());
    }
    assert_eq!(fs::read_dir(&made).unwrap().count(), 8);
}

#[test]
fn folders() {
    let dir = tempfile::tempdir().unwrap();
    for (name, eye) in [("a", 0.5), ("sub/b", 0.3), ("c", 0.1)] {
        yoro_media::save_color(&dir.path().join(format!("color/{name}.png")), &pair::color(eye)).unwrap();
        yoro_media::save_depth(&dir.path().join(format!("depth/{name}.exr")), &pair::metres(eye)).unwrap();
    }
    let line = format!("synthesize --color color --depth depth --depth-encoding metres --out out {}", eyes());
    let batch = succeed(dir.path(), &line);
    assert_eq!(batch.stdout, "3 images in out\n");
    for (name, eye) in [("a", -0.5), ("sub/b", -0.7), ("c", -0.9)] {
        let db = quality(&load(&dir.path().join(format!("out/{name}.png"))), eye);
        assert!(db > 30.0, "{name}: {db:.2} dB");
    }
    fs::remove_file(dir.path().join("depth/c.exr")).unwrap();
    run(dir.path(), &line).refuses(&["c.png has no depth image of that name in depth"]);
}

#[test]
fn depth_without_meaning_is_refused() {
    let at = &folder();
    yoro_media::save_color(&at.join("color.png"), &pair::color(0.5)).unwrap();
    let mut depth = pair::reversed(0.5, 1.0);
    yoro_media::save_depth(&at.join("depth.exr"), &depth).unwrap();
    depth.put_pixel(7, 9, image::Luma([-0.25]));
    yoro_media::save_depth(&at.join("negative.exr"), &depth).unwrap();
    let synthesize =
        |options: &str| run(at, &format!("synthesize --color color.png --out out.png {options}"));
    for encoding in ["reversed-z", "metres", "disparity"] {
        synthesize(&format!("--depth negative.exr --depth-encoding {encoding} --depth-gamma 2.2"))
            .refuses(&["negative.exr has negative values", "--depth-gamma"]);
    }
    let disparity = "--depth depth.exr --depth-encoding disparity";
    for (options, naming) in [
        ("--disparity-offset nan", &["--disparity-offset", "finite"][..]),
        ("--disparity-scale inf", &["--disparity-scale", "finite"]),
        ("--disparity-scale -1", &["--disparity-scale -1 is negative", "invert"]),
        // Everything is shifted out of the picture.
        ("--disparity-offset 5000 --patcher telea", &["color.png", "all pixels are holes"]),
    ] {
        synthesize(&format!("{disparity} {options}")).refuses(naming);
    }
    assert!(!at.join("out.png").exists());
}
