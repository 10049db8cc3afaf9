//! The patchers against f64 references and OpenCV's results, and the rules that all of them obey.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use image::{GrayImage, Luma, Rgb, RgbImage, imageops};
use rand::{Rng, SeedableRng};

use super::march::{self, Rule};
use super::reference::Field;
use super::*;
use yoro::eyes::Eye;
use yoro_context::{Backend, Headless};
use yoro_media::DepthImage;

const SIZE: [u32; 2] = [93, 50];

/// Returns the patchers that this build contains.
fn built() -> impl Iterator<Item = PatcherKind> {
    PatcherKind::ALL.into_iter().filter(|kind| cfg!(feature = "neural") || *kind != PatcherKind::Neural)
}

fn with_gl(body: impl Fn(&Rc<Context>)) {
    let headless = Headless::open(Backend::Egl).expect("EGL is set up by `cargo xtask setup`");
    body(headless.gl());
    assert_eq!(headless.gl().take_errors(), None);
    assert_eq!(headless.gl().object_count(), 0, "GL objects leak");
}

fn patch(gl: &Rc<Context>, kind: PatcherKind, image: &Reprojected) -> RgbImage {
    let mut patcher = create(gl, kind, &PatcherOptions::default()).unwrap();
    patcher.patch(image).unwrap().image
}

/// Returns random colours from 30 to 220 on layers of several disparities, with holes of all kinds: thin, wide, at
/// borders, with single valid pixels in them, whole rows.
fn scattered(eye: Eye, seed: u64) -> Reprojected {
    let [w, h] = SIZE;
    let mut rng = rand_pcg::Pcg32::seed_from_u64(seed);
    let color = RgbImage::from_fn(w, h, |_, _| Rgb(std::array::from_fn(|_| rng.random_range(30..=220))));
    // The disparity is noisy: on a plane, pixels would lie exactly halfway between the nearest and the farthest.
    let mut disparity = DepthImage::from_fn(w, h, |x, y| {
        Luma([2.0 + x as f32 * 0.03 + y as f32 * 0.01 + rng.random_range(0.0..0.3)])
    });
    let mut mask = GrayImage::from_pixel(w, h, Luma([VALID]));
    let mut boxes = |count: usize, largest: [u32; 2]| -> Vec<[u32; 4]> {
        let one = |_| {
            let (x, y) = (rng.random_range(0..w), rng.random_range(0..h));
            let (bw, bh) = (rng.random_range(1..=largest[0]), rng.random_range(1..=largest[1]));
            [x, y, (x + bw).min(w), (y + bh).min(h)]
        };
        (0..count).map(one).collect()
    };
    let near = boxes(6, [20, 20]);
    let mut holes = boxes(8, [12, 20]);
    holes.extend([[0, 10, 5, 40], [w - 9, 0, w, h / 2], [30, 5, 66, 44], [0, h - 2, w, h]]);
    for (i, b) in near.iter().enumerate() {
        for (x, y) in (b[1]..b[3]).flat_map(|y| (b[0]..b[2]).map(move |x| (x, y))) {
            disparity.get_pixel_mut(x, y).0[0] += 4.0 + 1.5 * i as f32;
        }
    }
    for b in holes {
        for (x, y) in (b[1]..b[3]).flat_map(|y| (b[0]..b[2]).map(move |x| (x, y))) {
            mask.put_pixel(x, y, Luma([HOLE]));
        }
    }
    mask.put_pixel(48, 20, Luma([VALID]));
    Reprojected::new(color, mask, disparity, eye).unwrap()
}

/// Returns an image of a nearer red box in front of a blue background, whose disocclusion is on the box's left (left
/// eye) or right.
fn box_before_wall(eye: Eye) -> Reprojected {
    let [w, h] = [64u32, 48];
    let forward = |x: u32| if eye == Eye::Right { w - 1 - x } else { x };
    let front = |x: u32, y: u32| (30..50).contains(&forward(x)) && (10..40).contains(&y);
    let hole = |x: u32, y: u32| (20..30).contains(&forward(x)) && (10..40).contains(&y);
    let color = RgbImage::from_fn(w, h, |x, y| Rgb(if front(x, y) { [200, 0, 0] } else { [0, 0, 200] }));
    let disparity = DepthImage::from_fn(w, h, |x, y| Luma([if front(x, y) { 12.0 } else { 2.0 }]));
    let mask = GrayImage::from_fn(w, h, |x, y| Luma([if hole(x, y) { HOLE } else { VALID }]));
    Reprojected::new(color, mask, disparity, eye).unwrap()
}

fn mirrored(image: &Reprojected) -> Reprojected {
    let flip = |i: &RgbImage| imageops::flip_horizontal(i);
    let (mask, disparity) =
        (imageops::flip_horizontal(&image.mask), imageops::flip_horizontal(&image.disparity));
    Reprojected::new(flip(&image.color), mask, disparity, image.eye.other()).unwrap()
}

#[test]
fn shaders_agree_with_their_references() {
    with_gl(|gl| {
        type Reference = fn(&Field) -> Field;
        let references: [(PatcherKind, Reference); 4] = [
            (PatcherKind::Paper, Field::paper),
            (PatcherKind::Gather, Field::gather),
            (PatcherKind::Median, Field::median),
            (PatcherKind::Xiao, Field::xiao),
        ];
        for (kind, reference) in references {
            for (eye, seed) in [(Eye::Left, 1), (Eye::Right, 2), (Eye::Left, 3)] {
                let image = scattered(eye, seed);
                let want = reference(&Field::new(&image));
                let got = patch(gl, kind, &image);
                let mut different = 0;
                for (x, y, got) in got.enumerate_pixels() {
                    let want = want.color(&image, x, y).expect("the reference leaves no hole");
                    let error = (0..3).map(|c| (f64::from(got.0[c]) - want[c]).abs()).fold(0.0, f64::max);
                    // The median is exact. A mean may round either way, and a mean of means once more.
                    let tolerance = if kind == PatcherKind::Median { 0.0 } else { 1.01 };
                    different += usize::from(error > tolerance);
                }
                assert_eq!(different, 0, "{kind:?}, case {seed}: pixels that differ");
            }
        }
    });
}

#[test]
fn every_hole_is_filled_and_nothing_else_changes() {
    with_gl(|gl| {
        for kind in built() {
            for image in [scattered(Eye::Left, 4), scattered(Eye::Right, 5), box_before_wall(Eye::Left)] {
                let patched = patch(gl, kind, &image);
                for (x, y, pixel) in patched.enumerate_pixels() {
                    if image.is_hole(x, y) {
                        // Holes are black, and no valid pixel is.
                        assert_ne!(pixel.0, [0; 3], "{kind:?}: a hole is left at {x}, {y}");
                    } else {
                        assert_eq!(pixel, image.color.get_pixel(x, y), "{kind:?} at {x}, {y}");
                    }
                }
                assert_eq!(patched, patch(gl, kind, &image), "{kind:?} differs from run to run");
                // Fast marching goes from hole to hole in the order of rows and columns.
                if !matches!(kind, PatcherKind::Telea | PatcherKind::NavierStokes) {
                    let mirrored = imageops::flip_horizontal(&patch(gl, kind, &mirrored(&image)));
                    let error = mirrored.iter().zip(patched.iter()).map(|(a, b)| a.abs_diff(*b)).max();
                    assert!(error <= Some(1), "{kind:?} differs from eye to eye: {error:?}");
                }
            }
        }
    });
}

#[test]
fn a_flat_colour_is_continued_into_holes() {
    with_gl(|gl| {
        let holes = scattered(Eye::Left, 7);
        let color = RgbImage::from_pixel(SIZE[0], SIZE[1], Rgb([180, 90, 40]));
        let image = Reprojected::new(color, holes.mask, holes.disparity, Eye::Left).unwrap();
        for kind in built() {
            let tolerance = if kind == PatcherKind::Neural { 40 } else { 1 };
            for pixel in patch(gl, kind, &image).pixels() {
                let error = pixel.0.iter().zip([180u8, 90, 40]).map(|(a, b)| a.abs_diff(b)).max().unwrap();
                assert!(error <= tolerance, "{kind:?}: {pixel:?}");
            }
        }
    });
}

#[test]
fn patchers_that_know_depth_take_nothing_of_the_foreground() {
    with_gl(|gl| {
        for eye in Eye::BOTH {
            let image = box_before_wall(eye);
            let red_in_holes = |kind| {
                let patched = patch(gl, kind, &image);
                let holes = patched.enumerate_pixels().filter(|(x, y, _)| image.is_hole(*x, *y));
                holes.map(|(_, _, pixel)| pixel.0[0]).max().unwrap()
            };
            for kind in [PatcherKind::Paper, PatcherKind::Gather, PatcherKind::Xiao] {
                assert_eq!(red_in_holes(kind), 0, "{kind:?}, {eye:?}");
            }
            assert!(
                red_in_holes(PatcherKind::Median) > 100,
                "the law would hold for a patcher without depth"
            );
        }
    });
}

#[test]
fn without_holes_nothing_happens() {
    with_gl(|gl| {
        let some = scattered(Eye::Left, 9);
        let mask = GrayImage::from_pixel(SIZE[0], SIZE[1], Luma([7]));
        let image = Reprojected::new(some.color, mask, some.disparity, Eye::Left).unwrap();
        for kind in built() {
            assert_eq!(patch(gl, kind, &image), image.color, "{kind:?}");
        }
    });
}

#[test]
fn a_patcher_takes_images_of_any_size_one_after_the_other() {
    with_gl(|gl| {
        for kind in built() {
            let mut patcher = create(gl, kind, &PatcherOptions::default()).unwrap();
            for [w, h] in [[40, 30], [17, 61], [40, 30], [1, 3]] {
                let color = RgbImage::from_fn(w, h, |x, y| Rgb([100, 60 + x as u8, 60 + y as u8]));
                let mask = GrayImage::from_fn(w, h, |x, y| Luma([if x + y == 1 { HOLE } else { VALID }]));
                let image = Reprojected::new(color, mask, DepthImage::new(w, h), Eye::Left).unwrap();
                let patched = patcher.patch(&image).unwrap();
                assert_eq!(patched.image.dimensions(), (w, h), "{kind:?}");
                let gpu = ["paper", "gather", "median", "xiao"].contains(&kind.name());
                assert_eq!(patched.time.transfer.is_zero(), !gpu, "{kind:?}");
                assert!(!patched.time.patching.is_zero(), "{kind:?}");
            }
        }
    });
}

#[test]
fn images_that_cannot_be_patched_are_refused() {
    let color = RgbImage::new(4, 3);
    let all_holes = GrayImage::new(4, 3);
    let depth = |w| DepthImage::new(w, 3);
    let error = Reprojected::new(color.clone(), all_holes.clone(), depth(4), Eye::Left).unwrap_err();
    assert!(error.to_string().starts_with("all pixels are holes"), "{error}");
    let error = Reprojected::new(color, all_holes, depth(5), Eye::Left).unwrap_err();
    assert!(error.to_string().contains("4x3 pixels, its mask 4x3 and its disparity 5x3"), "{error}");
}

fn vector(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src/inpaint/vectors").join(name)
}

fn stored_case(name: &str) -> Reprojected {
    let color = yoro_media::load_color(&vector(&format!("{name}.png"))).unwrap();
    let mask = yoro_media::load_mask(&vector(&format!("{name}.mask.png"))).unwrap();
    let disparity = DepthImage::new(color.width(), color.height());
    Reprojected::new(color, mask, disparity, Eye::Left).unwrap()
}

/// Returns the root mean square of the differences in holes, in grey levels.
fn distance_in_holes(a: &RgbImage, b: &RgbImage, holes: &Reprojected) -> f64 {
    let squares = |x: u32, y: u32| {
        let (a, b) = (a.get_pixel(x, y).0, b.get_pixel(x, y).0);
        (0..3).map(|c| (f64::from(a[c]) - f64::from(b[c])).powi(2)).sum::<f64>()
    };
    let holes: Vec<f64> = holes
        .mask
        .enumerate_pixels()
        .filter(|(_, _, mask)| mask.0[0] == HOLE)
        .map(|(x, y, _)| squares(x, y))
        .collect();
    (holes.iter().sum::<f64>() / (3 * holes.len()) as f64).sqrt()
}

#[test]
fn telea_and_navier_stokes_are_near_opencv() {
    for name in ["shapes", "talk"] {
        let image = stored_case(name);
        let truth = yoro_media::load_color(&vector(&format!("{name}.png"))).unwrap();
        for (rule, file) in [(Rule::Telea, "telea"), (Rule::NavierStokes, "navier-stokes")] {
            let theirs = yoro_media::load_color(&vector(&format!("{name}.{file}.png"))).unwrap();
            let ours = march::March::new(rule).patch(&image).unwrap().image;
            let apart = distance_in_holes(&ours, &theirs, &image);
            let (our_error, their_error) =
                (distance_in_holes(&ours, &truth, &image), distance_in_holes(&theirs, &truth, &image));
            // The limit is half a level above the measured value: the methods define neither the order of pixels that
            // the front reaches at the same time, nor the derivative where neighbours are missing.
            let limit = match (name, rule) {
                ("talk", Rule::NavierStokes) => 6.1,
                _ => 2.4,
            };
            assert!(apart < limit, "{name}, {rule:?}: {apart:.2} levels apart");
            assert!(
                our_error < their_error + 0.5,
                "{name}, {rule:?}: {our_error:.2}, OpenCV {their_error:.2}"
            );
        }
    }
}

#[test]
fn regions_in_parallel_are_the_whole_in_one_piece() {
    // Two rows of holes. The upper one has a gap just wide enough for separate filling, and one a column too narrow.
    let apart = scattered(Eye::Left, 10);
    let hole = |x: u32, y: u32| match y {
        10..13 => !(30..39).contains(&x) && !(60..68).contains(&x),
        35..39 => true,
        _ => false,
    };
    let mask = GrayImage::from_fn(SIZE[0], SIZE[1], |x, y| Luma([if hole(x, y) { HOLE } else { VALID }]));
    let apart = Reprojected::new(apart.color, mask, apart.disparity, Eye::Left).unwrap();
    let mut counts = Vec::new();
    for image in [apart, scattered(Eye::Left, 11), stored_case("shapes"), stored_case("talk")] {
        let regions = march::regions(&image);
        counts.push(regions.len());
        let mut all: Vec<[u32; 2]> = regions.iter().flatten().copied().collect();
        all.sort_unstable_by_key(|&[x, y]| (y, x));
        for rule in [Rule::Telea, Rule::NavierStokes] {
            let parallel = march::March::new(rule).patch(&image).unwrap().image;
            for (&[x, y], color) in all.iter().zip(march::fill(&image, &all, rule)) {
                assert_eq!(*parallel.get_pixel(x, y), color, "{rule:?} at {x}, {y}");
            }
        }
    }
    assert_eq!(counts[0], 3, "regions of two lines with one gap that is wide enough");
}

#[cfg(feature = "neural")]
#[test]
fn models_that_do_not_fit_are_refused_with_a_reason() {
    with_gl(|gl| {
        let folder = tempfile::tempdir().unwrap();
        let noise = folder.path().join("noise.onnx");
        yoro_files::write(&noise, b"this is not a model").unwrap();
        for (file, reason) in [
            (noise, "noise.onnx"),
            (folder.path().join("missing.onnx"), "missing.onnx does not exist"),
            (vector("three-channels.onnx"), "its input is [1, 3, height, width], not [1, 5, height, width]"),
            (vector("fixed-size.onnx"), "its input is [1, 5, 64, 64], not [1, 5, height, width]"),
            (vector("wrong-output.onnx"), "its output is [1, 5, 16, 32], not [1, 3, 16, 32]"),
        ] {
            let options = PatcherOptions { model: Some(file) };
            let message = create(gl, PatcherKind::Neural, &options).err().expect("refused").to_string();
            assert!(message.contains(reason), "{message}");
            assert!(!message.contains('\n'), "{message}");
        }
    });
}
