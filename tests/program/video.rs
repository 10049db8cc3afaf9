//! RGBD videos: `yoro render --video`, and `yoro synthesize` of them.

use std::fs;

use image::{RgbImage, imageops};
use yoro_media::video::{Reader, VideoError};
use yoro_metrics::{Channels, psnr};

use crate::program::{folder, run, succeed};

#[test]
fn both_eyes_come_out_of_an_rgbd_video() {
    let at = &folder();
    let scene = "render prototype --frames 4 --size 128x96";
    let said = succeed(at, &format!("{scene} --video rgbd.mp4 --frame-rate 24 --quantizer 16")).stdout;
    assert!(said.starts_with("rgbd.mp4: 4 frames, ") && said.contains("kbit/s, depth from "), "{said}");
    let said = succeed(at, "synthesize rgbd.mp4 --out stereo.mp4 --quantizer 16").stdout;
    assert!(said.starts_with("stereo.mp4: 4 frames, "), "{said}");
    succeed(at, &format!("{scene} --method conventional --outputs left,right --out truth"));
    succeed(at, &format!("{scene} --outputs left --out pictures"));

    let mut stereo = Reader::open(&at.join("stereo.mp4")).unwrap();
    assert_eq!((stereo.frames(), stereo.frame_rate()), (4, 24));
    assert!(matches!(stereo.rgbd(), Err(VideoError::NoDepth(_))));
    for frame in 0..4 {
        let both = stereo.read().unwrap().unwrap().rgb((256, 96));
        let shown = |x: u32| -> RgbImage { imageops::crop_imm(&both, x, 0, 128, 96).to_image() };
        let load = |folder: &str, eye: &str| {
            yoro_media::load_color(&at.join(format!("{folder}/prototype-{frame:04}.{eye}.png"))).unwrap()
        };
        let [left, right] = ["left", "right"].map(|eye| load("truth", eye));
        let picture_left = load("pictures", "left");
        let db = |a: &RgbImage, b: &RgbImage| psnr(a, b, Channels::Luma).unwrap().0;
        let (synthesized, rendered) = (db(&shown(0), &left), db(&shown(128), &right));
        let [same_image, uncoded] = [&right, &picture_left].map(|image| db(image, &left));
        assert!(rendered > 34.0, "frame {frame}: {rendered:.1} dB");
        assert!(synthesized > same_image + 2.0, "frame {frame}: {synthesized:.1} dB, {same_image:.1} dB");
        assert!(synthesized > uncoded - 1.0, "frame {frame}: {synthesized:.1} dB, {uncoded:.1} dB");
    }
}

/// One eye sees farther outwards, or inwards, than the other.
#[test]
fn eyes_with_asymmetric_frusta_come_out_of_an_rgbd_video() {
    let at = &folder();
    for (name, eyes) in
        [("wide", "--half-angles-degrees 52,42"), ("narrow", "--half-angles-degrees 35,47 --dominant left")]
    {
        let scene = format!("render prototype --frames 1 --size 96x64 {eyes}");
        succeed(at, &format!("{scene} --video {name}.mp4 --quantizer 12"));
        succeed(at, &format!("synthesize {name}.mp4 --out {name}.stereo.mp4 --quantizer 12"));
        succeed(at, &format!("{scene} --method conventional --outputs left,right --out {name}"));
        let mut stereo = Reader::open(&at.join(format!("{name}.stereo.mp4"))).unwrap();
        let both = stereo.read().unwrap().unwrap().rgb((192, 64));
        let shown = |x: u32| imageops::crop_imm(&both, x, 0, 96, 64).to_image();
        let [left, right] = ["left", "right"]
            .map(|eye| yoro_media::load_color(&at.join(format!("{name}/prototype.{eye}.png"))).unwrap());
        let db = |a: &RgbImage, b: &RgbImage| psnr(a, b, Channels::Luma).unwrap().0;
        let (of_left, of_right, same) = (db(&shown(0), &left), db(&shown(96), &right), db(&left, &right));
        println!("{name}: left {of_left:.1} dB, right {of_right:.1} dB, the same image {same:.1} dB");
        assert!(of_left.min(of_right) > 24.0 && of_left.min(of_right) > same + 5.0, "{name}");
        assert!(of_left.max(of_right) > 34.0, "{name}");
    }
}

#[test]
fn mistakes() {
    let at = &folder();
    fs::write(at.join("a.mp4"), "no video").unwrap();
    run(at, "synthesize none.mp4 --out o.mp4").refuses(&["none.mp4 does not exist"]);
    run(at, "synthesize a.mp4 --out o.mp4").refuses(&["a.mp4 cannot be read as a video", "H.264"]);
    run(at, "synthesize a.mp4 --color c.png --out o.mp4").refuses(&["--color"]);
    run(at, "synthesize --out o.png").refuses(&["--color", "--depth"]);
    run(at, "render prototype --video v.mp4").refuses(&["--frames"]);
    run(at, "render prototype --frames 2 --video v.mp4 --measure").refuses(&["--measure"]);
    run(at, "render prototype --frames 2 --video v.mp4 --quantizer 52").refuses(&["--quantizer"]);
    run(at, "render prototype --frames 2 --video v.mp4 --quantizer 11").refuses(&["--quantizer"]);
    run(at, "render prototype --frames 2 --video v.avi").refuses(&["v.avi", ".mp4"]);
    run(at, "synthesize a.mp4 --out s.png").refuses(&["s.png", ".mp4"]);
    run(at, "render prototype --frames 2 --video v.mp4 --size 2048x2048")
        .refuses(&["more than can be encoded", "--size"]);
    assert_eq!(fs::read(at.join("a.mp4")).unwrap(), b"no video");
}
