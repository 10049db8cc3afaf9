//! `yoro view`: the picture behind the lenses.

use std::path::Path;

use image::RgbImage;

use crate::program::{run, succeed};

/// A screen of 110 x 62 mm with few pixels, and cheap rendering.
const SMALL: &str = "--screen 384x216 --dpi 88 --viewer v1 --set shadow-map=0 --set msaa=1 --set bloom=false";

fn view(folder: &Path, line: &str) -> RgbImage {
    let run = succeed(folder, &format!("view --png view.png {SMALL} {line}"));
    assert_eq!((run.stdout.as_str(), run.stderr.as_str()), ("view.png\n", ""));
    yoro_media::load_color(&folder.join("view.png")).unwrap()
}

/// Returns the mean difference of two pictures in a square around the left lens's centre, in grey levels.
fn difference(a: &RgbImage, b: &RgbImage) -> f64 {
    let (x, y) = ((0.025 / 0.110 * 384.0) as u32, 216 - (0.032 / 0.062 * 216.0) as u32);
    let mut sum = 0;
    for (dx, dy) in (0..60).flat_map(|dx| (0..60).map(move |dy| (dx, dy))) {
        let (a, b) = (a.get_pixel(x - 30 + dx, y - 30 + dy), b.get_pixel(x - 30 + dx, y - 30 + dy));
        sum += (0..3).map(|c| a[c].abs_diff(b[c]) as u32).sum::<u32>();
    }
    sum as f64 / (60.0 * 60.0 * 3.0)
}

#[test]
fn both_eyes_behind_their_lenses() {
    let dir = tempfile::tempdir().unwrap();
    let image = view(dir.path(), "prototype --no-hud");
    assert_eq!(image.dimensions(), (384, 216));
    for (x, y) in [(0, 0), (383, 0), (0, 215), (383, 215)] {
        assert_eq!(image.get_pixel(x, y).0, [0; 3], "no lens shows the corner");
    }
    for y in [0, 100, 215] {
        assert_eq!(image.get_pixel(192, y).0, [89; 3], "the alignment line");
    }
    let with_hud = view(dir.path(), "prototype");
    assert!(with_hud != image);
    // The left eye is the synthesized one.
    let real = view(dir.path(), "prototype --no-hud --method conventional");
    let mono = view(dir.path(), "prototype --no-hud --method mono");
    let (synthesized, same) = (difference(&image, &real), difference(&mono, &real));
    // About 5.5 and 9.0 grey levels, since most of the view is far away.
    assert!(synthesized < 0.7 * same, "{synthesized} synthesized, {same} without stereo");
}

/// The lenses' pass composes the levels: what it shows around each axis is as it is without.
#[test]
fn the_border_is_coarser_and_the_middle_is_not() {
    let dir = tempfile::tempdir().unwrap();
    let [all, foveated] =
        ["off", "medium"].map(|level| view(dir.path(), &format!("prototype --no-hud --foveation {level}")));
    let middle = difference(&all, &foveated);
    assert!(middle < 0.5, "{middle} grey levels in the middle");
    let around = |image: &RgbImage| image.pixels().map(|pixel| u64::from(pixel.0[1])).sum::<u64>();
    assert!(all != foveated);
    // The same scene around it: as bright, but for less than 3 %.
    let [all, foveated] = [&all, &foveated].map(|image| around(image) as f64);
    assert!((all - foveated).abs() < 0.03 * all, "{all} {foveated}");
}

/// Regression test: the program ended with a segmentation fault, because objects were deleted after their context.
#[test]
fn objects_keep_their_context() {
    if std::env::var_os("YORO_TEST_WITHOUT_OSMESA").is_some() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(view(dir.path(), "--loading --gl osmesa").dimensions(), (384, 216));
}

#[test]
fn timewarp_makes_up_for_a_late_turn() {
    let dir = tempfile::tempdir().unwrap();
    let turned = view(dir.path(), "--no-hud --yaw-degrees 4");
    let late = |timewarp| {
        let late = view(dir.path(), &format!("--no-hud --late-yaw-degrees 4 --set timewarp={timewarp}"));
        difference(&turned, &late)
    };
    let [never, rotation, position] = ["off", "rotation", "position"].map(late);
    assert!(rotation < 0.5 * never, "{rotation} by rotation, {never} without");
    assert!(position < 0.5 * never, "{position} by position, {never} without");
}

#[test]
fn mistakes() {
    let dir = tempfile::tempdir().unwrap();
    for (line, naming) in [
        ("view palace --png a.png", ["palace", "prototype"]),
        ("view --png a.png --viewer nothing.params", ["nothing.params", "v2"]),
        ("view --png a.png --set speed=1", ["speed", "render-scale"]),
        ("view --png a.png --set method=fast", ["fast", "conventional"]),
        ("view --png a.png --settings no.toml", ["no.toml", "path"]),
        ("view --png a.png --screen 3x3", ["--screen", "2340x1080"]),
        ("view --png a.bmp.txt --set shadow-map=0", ["a.bmp.txt", "png"]),
    ] {
        run(dir.path(), line).refuses(&naming);
    }
    std::fs::write(dir.path().join("broken.obj"), "f 1 2 3\n").unwrap();
    run(dir.path(), "view broken.obj --png a.png").refuses(&["broken.obj"]);
    assert!(!dir.path().join("a.png").exists());
}
