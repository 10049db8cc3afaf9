//! RGBD videos: `yoro render --video`, and `yoro synthesize` of them.

use std::fs;

use image::{RgbImage, imageops};
use yoro_media::video::{Format, Planes, Reader, VideoError};
use yoro_metrics::{Channels, psnr};

use crate::program::{run, succeed};

#[test]
fn both_eyes_come_out_of_an_rgbd_video() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let scene = "render prototype --frames 4 --size 128x96";
    let said = succeed(at, &format!("{scene} --video rgbd.mp4 --frame-rate 24 --quantizer 16")).stdout;
    assert!(said.starts_with("rgbd.mp4: 4 frames, ") && said.contains("kbit/s, depth from "), "{said}");
    let said = succeed(at, "synthesize rgbd.mp4 --out stereo.mp4 --quantizer 16").stdout;
    assert!(said.starts_with("stereo.mp4: 4 frames, "), "{said}");
    succeed(at, &format!("{scene} --method conventional --outputs left,right --out truth"));
    succeed(at, &format!("{scene} --outputs left --out pictures"));

    let mut stereo = Reader::open(&at.join("stereo.mp4")).unwrap();
    assert_eq!((stereo.frames(), stereo.frame_rate()), (4, 24));
    assert!(matches!(stereo.rgbd(), Err(VideoError::NoDepth { .. })));
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
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
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

/// A file in the format of the iPhone application Record3D: depth as hue on the left, the camera in the metadata. It is
/// made from a video of this program whose eye is not widened, since no recording of a phone was available. The camera's
/// axis is not in the middle: the leftmost columns are left out.
#[test]
fn a_video_of_record3d_becomes_stereo() {
    const CUT: u32 = 20;
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let scene = "render prototype --frames 2 --size 128x96";
    succeed(at, &format!("{scene} --video rgbd.mp4 --quantizer 12 --guard-band none"));
    let mut reader = Reader::open(&at.join("rgbd.mp4")).unwrap();
    let rgbd = reader.rgbd().unwrap();
    assert_eq!(rgbd.guard_columns, 0);
    // Anything farther is stored as the farthest distance.
    const RANGE: f32 = 6.0;
    let hue = |depth: u8| {
        let share = f32::from(depth) / 255.0;
        let distance = 1.0 / (share / rgbd.nearest + (1.0 - share) / rgbd.farthest);
        let sixths = 6.0 * distance.min(0.97 * RANGE) / RANGE;
        let channel = |n: f32| {
            let k = (n + sixths) % 6.0;
            (255.0 * (1.0 - k.min(4.0 - k).clamp(0.0, 1.0))) as u8
        };
        image::Rgb([channel(5.0), channel(3.0), channel(1.0)])
    };
    let format = Format { frame_rate: 30, quantizer: 12, durations: None, frames: 2, rgbd: None };
    yoro_media::video::write(&at.join("phone.mp4"), &format, || -> Result<Option<Planes>, VideoError> {
        Ok(reader.read_rgbd()?.map(|(color, depth)| {
            let hues = RgbImage::from_fn(128, 96, |x, y| hue(depth.get_pixel(x, y).0[0]));
            let cut = |image: &RgbImage| imageops::crop_imm(image, CUT, 0, 128 - CUT, 96).to_image();
            Planes::of_rgb(&cut(&hues)).beside(&Planes::of_rgb(&cut(&color)))
        }))
    })
    .unwrap();
    let focal = 48.0 / (rgbd.fov_y / 2.0).tan();
    let file = fs::read(at.join("phone.mp4")).unwrap();
    let camera = format!(
        r#"{{"intrinsicMatrix":[{focal},0,0,0,{focal},0,{},48,1],"rangeOfEncodedDepth":[0,{RANGE}]}}"#,
        64 - CUT
    );
    let size = (camera.len() as u32 + 8).to_be_bytes();
    fs::write(at.join("phone.mp4"), [&file[..], &size, b"meta", camera.as_bytes()].concat()).unwrap();

    succeed(at, &format!("{scene} --method conventional --outputs left,right --out truth"));
    let stereo = ["phone", "rgbd"].map(|name| {
        succeed(at, &format!("synthesize {name}.mp4 --out {name}.stereo.mp4 --quantizer 12"));
        Reader::open(&at.join(format!("{name}.stereo.mp4"))).unwrap()
    });
    let [mut phone, mut own] = stereo;
    for frame in 0..2 {
        let [left, right] = ["left", "right"].map(|eye| {
            yoro_media::load_color(&at.join(format!("truth/prototype-{frame:04}.{eye}.png"))).unwrap()
        });
        // What both show of the left eye.
        let columns = 128 - CUT;
        let cut = |image: &RgbImage, from: u32| imageops::crop_imm(image, from, 0, columns, 96).to_image();
        let phone = cut(&phone.read().unwrap().unwrap().rgb((2 * columns, 96)), 0);
        let own = cut(&own.read().unwrap().unwrap().rgb((256, 96)), CUT);
        let [value, own, same] = [phone, own, cut(&right, CUT)]
            .map(|image| psnr(&image, &cut(&left, CUT), Channels::Luma).unwrap().0);
        let what =
            format!("frame {frame}: {value:.1} dB, {own:.1} dB by luma, {same:.1} dB for the same image");
        println!("{what}");
        assert!(value > same + 1.0, "{what}");
    }
}

#[test]
fn mistakes() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
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
