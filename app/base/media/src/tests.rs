//! Tests of the whole crate through files.

use std::path::Path;

use exr::prelude::WritableImage;

use image::{GrayImage, ImageBuffer, Luma, LumaA, Rgb, RgbImage, Rgba};
use yoro_files::{self as files, FileError};

use super::encode::encode_png;
use super::*;

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

/// True if a file was refused with these words.
fn is_refused<T>(result: Result<T, PictureError>, words: &str) -> bool {
    matches!(result, Err(PictureError::Unusable(what)) if what.contains(words))
}

fn gradient(width: u32, height: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| Rgb([(x * 7) as u8, (y * 11) as u8, (x * y) as u8]))
}

#[test]
fn colour_comes_back_and_other_layouts_are_converted() {
    let dir = folder();
    let path = dir.path().join("a.png");
    let image = gradient(31, 17);
    save_color(&path, &image).unwrap();
    assert_eq!(load_color(&path).unwrap(), image);

    let wide = ImageBuffer::from_pixel(3, 2, Rgba([65535u16, 257 * 100, 128, 0]));
    files::write(&path, &encode_png(&wide).unwrap()).unwrap();
    assert_eq!(load_color(&path).unwrap().get_pixel(2, 1).0, [255, 100, 0], "alpha 0 hides nothing");

    files::write(&path, &encode_png(&ImageBuffer::from_pixel(3, 2, LumaA([77u8, 10]))).unwrap()).unwrap();
    assert_eq!(load_color(&path).unwrap().get_pixel(0, 0).0, [77; 3]);
}

#[test]
fn linear_exr_colour_is_encoded() {
    let dir = folder();
    let path = dir.path().join("a.exr");
    image::Rgb32FImage::from_pixel(4, 4, Rgb([0.5, 0.0, 2.0])).save(&path).unwrap();
    assert_eq!(load_color(&path).unwrap().get_pixel(1, 1).0, [188, 0, 255]);
    save_depth(&path, &DepthImage::new(4, 4)).unwrap();
    let error = load_color(&path).unwrap_err().to_string();
    assert!(error.contains("is no colour picture (its channels are Z)"), "{error}");
}

#[test]
fn depth_is_read_from_every_kind_of_png() {
    let dir = folder();
    let path = dir.path().join("d.png");
    let grey8 = GrayImage::from_fn(5, 3, |x, y| Luma([(x * 50 + y) as u8]));
    save_gray(&path, &grey8).unwrap();
    let depth = load_depth(&path).unwrap();
    assert_eq!(depth.samples, DepthSamples::Normalized { bits: 8 });
    assert_eq!(depth.image.get_pixel(4, 2).0[0], 202.0 / 255.0);

    let rgb = RgbImage::from_fn(5, 3, |x, y| Rgb([grey8.get_pixel(x, y).0[0]; 3]));
    save_color(&path, &rgb).unwrap();
    assert_eq!(load_depth(&path).unwrap().image, depth.image);

    save_color(&path, &gradient(5, 3)).unwrap();
    assert!(is_refused(load_depth(&path), "is a colour image"));

    let ramp = DepthImage::from_fn(7, 2, |x, y| Luma([(x + 7 * y) as f32 / 13.0]));
    save_depth(&path, &ramp).unwrap();
    let back = load_depth(&path).unwrap();
    assert_eq!(back.samples, DepthSamples::Normalized { bits: 16 });
    for (a, b) in ramp.pixels().zip(back.image.pixels()) {
        assert!((a.0[0] - b.0[0]).abs() <= 0.5 / 65535.0 + f32::EPSILON);
    }
}

fn write_exr(path: &Path, names: &[&str], value: f32) {
    use exr::image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer};
    let list = names.iter().enumerate().map(|(i, name)| {
        AnyChannel::new(
            *name,
            FlatSamples::F32((0..6).map(|v| v as f32 * value + i as f32 * 100.0).collect()),
        )
    });
    let layer = Layer::new(
        (3, 2),
        exr::meta::header::LayerAttributes::named("layer"),
        Encoding::UNCOMPRESSED,
        AnyChannels::sort(list.collect()),
    );
    Image::from_layer(layer).write().to_file(path).unwrap();
}

#[test]
fn exr_depth_is_unchanged_and_the_channel_is_found() {
    let dir = folder();
    let path = dir.path().join("d.exr");
    let metres = DepthImage::from_fn(9, 4, |x, y| Luma([x as f32 * 123.456 + y as f32]));
    save_depth(&path, &metres).unwrap();
    let back = load_depth(&path).unwrap();
    assert_eq!((back.image, back.samples), (metres, DepthSamples::Float));

    for (names, first) in [
        (&["R", "G", "B", "Z"][..], 300.0),
        (&["ViewLayer.Depth.Z", "ViewLayer.Combined.R"], 0.0),
        (&["Depth"], 0.0),
        (&["Y"], 0.0),
        (&["R"], 0.0),
        (&["anything"], 0.0),
    ] {
        write_exr(&path, names, 2.0);
        let depth = load_depth(&path).unwrap().image;
        assert_eq!(
            (depth.get_pixel(0, 0).0[0], depth.get_pixel(2, 1).0[0]),
            (first, first + 10.0),
            "{names:?}"
        );
    }
    write_exr(&path, &["R", "G", "B"], 1.0);
    let error = load_depth(&path).unwrap_err().to_string();
    assert!(error.contains("d.exr has no depth channel") && error.contains("B, G, R"), "{error}");
    write_exr(&path, &["Z"], f32::NAN);
    assert!(is_refused(load_depth(&path), "column 0, row 0"));
}

#[test]
fn bad_files_are_refused_with_a_remedy() {
    let dir = folder();
    let path = dir.path().join("a.png");
    assert!(matches!(load_color(&path), Err(PictureError::File(FileError::Missing(_)))));
    assert!(matches!(load_color(dir.path()), Err(PictureError::File(FileError::IsFolder(_)))));

    let whole = encode_png(&gradient(40, 40)).unwrap();
    for cut in [20, whole.len() / 2, whole.len() - 20] {
        files::write(&path, &whole[..cut]).unwrap();
        assert!(is_refused(load_color(&path), "is damaged"), "cut at {cut}");
        assert!(is_refused(load_depth(&path), "is damaged"), "cut at {cut}");
    }
    files::write(&dir.path().join("a.txt"), b"no picture").unwrap();
    assert!(is_refused(load_color(&dir.path().join("a.txt")), "is not a picture"));

    let mut huge = whole.clone();
    huge[16..20].copy_from_slice(&100_000u32.to_be_bytes());
    let crc = crc32(&huge[12..29]);
    huge[29..33].copy_from_slice(&crc.to_be_bytes());
    files::write(&path, &huge).unwrap();
    assert!(is_refused(load_color(&path), "100000x40 pixels"));

    let exr = dir.path().join("d.exr");
    write_exr(&exr, &["Z"], 1.0);
    let bytes = files::read(&exr).unwrap();
    files::write(&exr, &bytes[..bytes.len() - 9]).unwrap();
    assert!(is_refused(load_depth(&exr), "is damaged"));
    assert!(is_refused(save_color(&dir.path().join("a.gif"), &gradient(2, 2)), "a.gif: use the extension"));
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| (c >> 1) ^ (0xEDB8_8320 & (c & 1).wrapping_neg()))
    })
}

#[test]
fn both_eyes_are_composed_into_one_picture() {
    let (left, right) = (gradient(8, 5), RgbImage::from_pixel(8, 5, Rgb([10, 20, 30])));
    let both = side_by_side(&left, &right).unwrap();
    assert_eq!(
        (both.dimensions(), both.get_pixel(3, 2), both.get_pixel(8, 2)),
        ((16, 5), left.get_pixel(3, 2), right.get_pixel(0, 2))
    );
    assert_eq!(cross_eyed(&left, &right).unwrap(), side_by_side(&right, &left).unwrap());
    assert_eq!(
        difference(
            &RgbImage::from_pixel(1, 1, Rgb([10, 200, 90])),
            &RgbImage::from_pixel(1, 1, Rgb([15, 100, 90]))
        )
        .unwrap()
        .get_pixel(0, 0)
        .0,
        [20, 255, 0]
    );
    assert!(is_refused(difference(&left, &gradient(9, 5)), "differ in size (8x5 and 9x5)"));

    // The rows of both matrices together sum to 1 within the rounding of the published coefficients (green and blue
    // preserve white, red loses .001). So grey in both eyes stays grey, and each eye keeps its own colours.
    let grey = RgbImage::from_pixel(1, 1, Rgb([128; 3]));
    let black = RgbImage::new(1, 1);
    let neutral = anaglyph(&grey, &grey).unwrap().get_pixel(0, 0).0;
    assert!(neutral.iter().all(|v| v.abs_diff(128) <= 1), "{neutral:?}");
    let [r, g, b] = anaglyph(&grey, &black).unwrap().get_pixel(0, 0).0;
    assert!(r > 120 && g == 0 && b == 0);
    let [r, g, b] = anaglyph(&black, &grey).unwrap().get_pixel(0, 0).0;
    assert!(r == 0 && g > 120 && b > 120);
}
