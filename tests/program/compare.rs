//! `yoro compare`.

use image::Rgb;

use crate::pair;
use crate::program::{run, succeed};

#[test]
fn files_and_folders_are_compared() {
    let dir = tempfile::tempdir().unwrap();
    let color = pair::color(0.5);
    let mut other = color.clone();
    other.put_pixel(80, 60, Rgb([255, 0, 255]));
    for (name, image) in
        [("a/one.png", &color), ("a/two.png", &color), ("b/one.png", &color), ("b/two.png", &other)]
    {
        yoro_media::save_color(&dir.path().join(name), image).unwrap();
    }
    let same = succeed(dir.path(), "compare a/one.png b/one.png --json").json();
    assert_eq!(same["pairs"][0]["identical"], true);
    assert_eq!(same["mean"]["rgb"]["psnr"], serde_json::Value::Null);
    assert_eq!(same["mean"]["rgb"]["ssim_gaussian"], 1.0);
    let text = succeed(dir.path(), "compare a/one.png b/one.png").stdout;
    assert!(text.contains("SSIM") && text.contains("identical"), "{text}");

    let both = succeed(dir.path(), "compare a b --json --map maps").json();
    assert_eq!(both["pairs"].as_array().unwrap().len(), 2);
    assert_eq!(both["pairs"][1]["identical"], false);
    assert_eq!(both["mean"]["identical_pairs"], 1);
    let map = yoro_media::load_color(&dir.path().join("maps/two.png")).unwrap();
    assert_eq!(map.dimensions(), color.dimensions());
    assert!(map.get_pixel(80, 60).0[0] > map.get_pixel(10, 10).0[0]);

    let before = std::fs::read(dir.path().join("a/one.png")).unwrap();
    run(dir.path(), "compare a/one.png b/one.png --map a/one.png").refuses(&["a/one.png is an input"]);
    assert!(std::fs::read(dir.path().join("a/one.png")).unwrap() == before, "an input was replaced");
}
